"""Wheels with concave parts against a swept pinion cutter: within a tenth of a micrometre.

The drivers of the nail machine. Spaces on convex parts, at the knots, and in the concave part,
where the tips are shortened to the mate's reach; flanks, fillets and root lands.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gearcam.gears.flank import trace
from helpers_sampling import few
from helpers_witnessed import cut_points, kinematics, outline, toothings
from witness import shaper, sweep

ALLOWED = 1e-4
STEPS = 8000


def cut_and_points(name: str, k: int) -> tuple[Any, np.ndarray]:
    rolling, basic = kinematics(name)
    curvature = toothings(name)[0].cutter.kc
    cut = shaper.cut_space(rolling, 1, k, basic, STEPS, curvature=curvature, flank_points=600)
    return cut, sweep.inside(cut_points(name, 1), rolling, 1, k, basic)


@pytest.mark.parametrize("name", few(["three phases", "two phases"]))
def test_the_cutter_is_a_pinion_that_fits_the_concave_part(name: str) -> None:
    concave = -float(toothings(name)[0].track.curvature_extremes[1].min())
    assert toothings(name)[0].cutter.kind == "pinion"
    assert toothings(name)[0].cutter.kc > concave
    assert toothings(name)[1].cutter.kind == "rack"
    basic = kinematics(name)[1]
    assert shaper.cutter_error(basic, toothings(name)[0].cutter.kc, 600, 200) < 1e-5


@pytest.mark.parametrize(
    ("name", "k"),
    few(
        ((name, k) for name in ("two phases", "three phases") for k in (1, 9, 15, 16, 17, 18, 24)),
        7,
    ),
)
def test_flanks_and_fillets_agree(name: str, k: int) -> None:
    cut, points = cut_and_points(name, k)
    assert len(points) > 150
    assert sweep.farthest(points, cut) < ALLOWED


def test_a_wheel_off_by_a_micrometre_is_seen() -> None:
    cut, points = cut_and_points("three phases", 16)
    assert sweep.farthest(points + np.array([1e-3, 0.0]), cut) > 5e-4


def test_a_rack_would_not_do() -> None:
    """The control of the choice of cutter: a rolled rack erases flank in the concave part."""
    rolling, basic = kinematics("three phases")
    worst = 0.0
    for k in (16, 17):
        points = sweep.inside(cut_points("three phases", 1), rolling, 1, k, basic)
        cut = sweep.cut_space(rolling, 1, k, basic, 2000)
        worst = max(worst, sweep.farthest(points, cut))
    assert worst > 0.1


@pytest.mark.parametrize("name", ["ellipse", "two phases", "three phases"])
@pytest.mark.parametrize("wheel", [1, 2])
def test_curves_meet_where_they_join(name: str, wheel: Any) -> None:
    """Where no corner is drawn, each curve begins where the one before ends, in its direction."""
    made = outline(name, wheel)
    after = np.flatnonzero(~made.rows.corner)
    assert len(after) > 100
    first, to_first = trace(made.toothing, made.rows, after - 1, made.rows.end[after - 1])
    second, to_second = trace(made.toothing, made.rows, after, made.rows.start[after])
    assert np.abs(first - second).max() < 1e-10
    assert np.abs(to_first - to_second).max() < 1e-7


def test_the_outlines_are_the_ones_that_are_built() -> None:
    assert outline("two phases", 1).chord_error <= 1e-4
