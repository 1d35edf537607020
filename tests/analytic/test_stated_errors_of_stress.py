"""Stated errors of certified stresses against true ones, at a hundred places of ten designs."""

from __future__ import annotations

import numpy as np
import pytest

from gearcam.gears.contact import DRIVE, flank_pairs
from gearcam.mechanics.material import MaterialSpec
from gearcam.meshing.contact import contacts
from gearcam.stress.certify import certified
from gearcam.stress.hertz_load import hertz_load
from gearcam.stress.region import region_of
from helpers_elastic import STEEL
from helpers_pairs import profile

DESIGNS = (
    "askew_pair", "bspline", "ellipse", "formula", "limacon", "lobed", "nail_machine_two_phase",
    "nail_machine_three_phase", "shop_order", "two_speeds",
)  # fmt: skip
PLACES = 10

EXACT = {"tolerance": 1e-3, "most": 150_000}
"""A mesh that is so much finer that its own error hardly counts."""

OWN = 1e-4
"""That error: true ones below twice this are not known well."""


def judged(name: str) -> list[tuple[float, float]]:
    """Stated and true errors of tension and compression at places of both wheels."""
    result = profile(name)
    pairs = flank_pairs(result.gears, DRIVE)
    rng = np.random.default_rng(len(name))
    phi1 = rng.uniform(0.0, result.turn(1)[-1], PLACES)
    found, rows = contacts(pairs, phi1), []
    for place in range(PLACES):
        k = int(rng.choice(np.flatnonzero(found.step == place)))
        wheel, module = place % 2, result.pair.module
        pose = pairs.guide.pose(pairs.guide.nominal(phi1[place : place + 1]) + found.lead[k])
        points = (
            found.point[k] * np.exp(1j * phi1[place]),
            (found.point[k] - pairs.distance - pose.shift[0]) * np.conj(pose.rotation[0]),
        )
        ways = (
            -found.force[k] * np.exp(1j * phi1[place]),
            found.force[k] * np.conj(pose.rotation[0]),
        )
        region = region_of(result.parts[wheel])
        load = hertz_load(
            region, complex(points[wheel]), complex(ways[wheel]), 40.0 * module,
            curvature=float(found.curvature[k]), material=MaterialSpec(),
        )  # fmt: skip
        made = certified(region, module, load, STEEL)
        true = certified(region, module, load, STEEL, **EXACT)  # type: ignore[arg-type]
        off = max(
            abs(getattr(made, sort).stress / getattr(true, sort).stress - 1.0)
            for sort in ("tension", "compression")
        )
        rows.append((made.error, off))
    return rows


@pytest.mark.slow
@pytest.mark.parametrize("name", DESIGNS)
def test_stated_errors_are_above_the_true_ones(name: str) -> None:
    """Nearly always; never below a third of them, nor thirty times as large where they matter."""
    stated, true = np.array(judged(name)).T
    assert (stated <= 0.01).all()
    assert np.count_nonzero(stated < true) <= 1
    assert (stated > true / 3.0).all()
    assert (stated <= 30.0 * (true + OWN))[true > 2.0 * OWN].all()
