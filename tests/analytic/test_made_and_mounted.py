"""Circular wheels as made and as mounted: contact ratio, lag and play by involute theory.

A wheel that is smaller all around by c has flanks of the same base circle and a tip circle of
``ra - c``. A tip rounded with r ends the flank where its normal, a tangent of the base circle, is
``sqrt((ra - c - r)^2 - rb^2) + r`` long: the arc's centre lies on that normal, r before its end.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.constant import Constant
from gearcam.meshing.contact import contacts
from gearcam.meshing.numbers import numbers
from gearcam.meshing.study import study
from gearcam.parts.blank import Blank
from helpers_built import built
from helpers_pairs import job
from helpers_sampling import few

ALPHA = math.radians(20.0)


def inv(angle: float) -> float:
    return math.tan(angle) - angle


class Wheels:
    """Two circular wheels by the textbook: module, teeth, shift, play, clearance and rounding."""

    def __init__(
        self,
        teeth: tuple[int, int],
        *,
        module: float = 2.0,
        x: float = 0.0,
        backlash: float = 0.0,
        clearance: tuple[float, float] = (0.0, 0.0),
        rounding: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        self.teeth, self.module = teeth, module
        self.radii = [0.5 * module * z for z in teeth]
        self.base = [r * math.cos(ALPHA) for r in self.radii]
        self.designed = sum(self.radii)
        shifts = (x, -x)
        self.normals = [
            math.sqrt((r + (1.0 + e) * module - c - q) ** 2 - b * b) + q
            for r, b, e, c, q in zip(
                self.radii, self.base, shifts, clearance, rounding, strict=True
            )
        ]
        # along the pitch circle, and so along both base circles over cos(alpha)
        self.play = backlash + 2.0 * sum(clearance) / math.cos(ALPHA)
        made = job(Constant(), teeth, module=module, x=x, backlash=backlash)
        blank = Blank(clearance=clearance, tip_rounding=rounding)
        self.job: GearPairResult = built(replace(made.design, blank=blank))

    def operating(self, distance: float) -> float:
        """Pressure angle at which the wheels run."""
        return math.acos(sum(self.base) / distance)

    def contact_ratio(self, distance: float) -> float:
        length = sum(self.normals) - distance * math.sin(self.operating(distance))
        return length / (math.pi * self.module * math.cos(ALPHA))

    def lag(self, distance: float) -> float:
        """Turn of the driven wheel to the middle of its play, rad."""
        opened = 2.0 * sum(self.base) * (inv(self.operating(distance)) - inv(ALPHA))
        return 0.5 * (opened + self.play * math.cos(ALPHA)) / self.base[1]


CASES = [
    {"teeth": (20, 20)},
    {"teeth": (20, 20), "backlash": 0.1},
    {"teeth": (24, 36), "backlash": 0.02, "x": 0.2},
    {"teeth": (25, 40), "clearance": (0.05, 0.05)},
    {"teeth": (20, 20), "rounding": (0.3, 0.1)},
    {"teeth": (30, 20), "x": -0.15, "backlash": 0.03, "clearance": (0.02, 0.06),
     "rounding": (0.2, 0.4)},
]  # fmt: skip


@pytest.mark.parametrize("case", few(CASES))
@pytest.mark.parametrize("more", few([-0.1, 0.0, 0.1, 0.5, 1.0, 1.5, 2.0]))
@pytest.mark.parametrize("side", [DRIVE, COAST])
def test_contact_ratio_and_lag_at_any_distance(case: dict, more: float, side: int) -> None:
    truth = Wheels(**case)
    distance = truth.designed + more
    pairs = flank_pairs(truth.job.gears, side, distance)
    assert pairs.arcs.ratios == pytest.approx(truth.contact_ratio(distance), rel=1e-9)
    found = contacts(pairs, np.linspace(0.0, 1.0, 61))
    assert found.step.size > 30
    assert found.lead == pytest.approx(side * truth.lag(distance), abs=1e-9)
    # the force is tangent to both base circles, at the operating pressure angle
    assert found.pressure_angle == pytest.approx(truth.operating(distance), abs=1e-9)
    for lever, base in zip(found.lever, truth.base, strict=True):
        assert lever == pytest.approx(base, rel=1e-9)


@pytest.mark.parametrize(
    ("distance", "ratio"), [(40.0, 1.5568), (41.0, 1.1004), (41.5, 0.8947), (42.0, 0.7001)]
)
def test_the_ladder_of_distances_is_told(distance: float, ratio: float) -> None:
    """20 : 20, m = 2: what a person reads after ``mesh --center``."""
    made = Wheels((20, 20)).job
    spec = replace(made.design.meshing, center_distance=distance, steps=40)
    found = numbers(study(made.gears, spec))["contact_ratio"]
    assert found["min"] == pytest.approx(ratio, abs=5e-5)
    assert found["max"] == pytest.approx(ratio, abs=5e-5)


@pytest.mark.parametrize("case", few(CASES, 3))
def test_play_of_the_parts_is_what_the_study_and_the_note_say(case: dict) -> None:
    truth = Wheels(**case)
    made = truth.job
    found = numbers(study(made.gears, replace(made.design.meshing, steps=36)))
    assert found["backlash_mm"]["min"] == pytest.approx(
        2.0 * truth.lag(truth.designed) * truth.radii[1], abs=1e-9
    )
    assert found["lag_mm"]["max"] == pytest.approx(
        truth.lag(truth.designed) * truth.radii[1], abs=1e-9
    )
    assert found["transmission_error"]["peak_to_peak"] < 1e-12
    # the lag is taken up first: the outlines overlap, whatever the play
    assert found["pairs_in_contact"]["min"] >= 1
    assert found["interference_steps"] == 0
    notes = [one for one in made.findings if one.code == "no-backlash"]
    assert bool(notes) == (truth.play < 0.01)


def test_a_distance_or_a_clearance_that_is_not_counted_would_be_seen() -> None:
    truth = Wheels((20, 20), clearance=(0.05, 0.05))
    nominal = Wheels((20, 20)).contact_ratio(40.0)
    assert abs(truth.contact_ratio(40.0) - nominal) > 1e-2
    assert abs(truth.contact_ratio(40.1) - truth.contact_ratio(40.0)) > 1e-2
