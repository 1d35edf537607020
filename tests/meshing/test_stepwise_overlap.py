"""Stepwise overlap against the intersection of the whole outlines, and of every two halves."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.meshing.half_teeth import HalfTeeth, half_teeth
from gearcam.meshing.overlap import Turning
from helpers_pairs import OVERCLOSURE, job, profile
from helpers_sampling import few

Array = NDArray[np.float64]

TURN = np.radians(np.arange(360.0))


@cache
def halves_of(made: GearPairResult) -> tuple[HalfTeeth, HalfTeeth]:
    return half_teeth(made.gear1.profile), half_teeth(made.gear2.profile)


def turning_of(made: GearPairResult, shift: float = 0.0) -> Turning:
    first, second = halves_of(made)
    distance = made.pair.center_distance + shift
    return Turning(rolling=made.pair.rolling, driver=first, driven=second, distance=distance)


def whole_areas(made: GearPairResult, distance: complex, angles: Array, lead: float) -> list[float]:
    """Overlap of the whole outlines."""
    areas = []
    for phi in angles:
        turned = (
            made.gear1.outline @ [1, 1j] * np.exp(-1j * (phi + OVERCLOSURE)),
            made.gear2.outline @ [1, 1j] * np.exp(1j * (made.law.phi2(phi) + lead)) + distance,
        )
        one, two = (shapely.Polygon(np.stack([z.real, z.imag], axis=1)) for z in turned)
        areas.append(one.intersection(two).area)
    return areas


OVERLAPPING = {
    "nail machine": lambda: profile("nail_machine_two_phase"),
    "three phases": lambda: profile("nail_machine_three_phase"),
    "few teeth": lambda: job(Ellipse(eccentricity=0.2), (12, 12), module=2.0),
    "fine teeth": lambda: job(Ellipse(eccentricity=0.3), (160, 160), module=1.0),
    "strong": lambda: job(Ellipse(eccentricity=0.5), (40, 40), module=2.0),
}


@cache
def overlapping(name: str) -> GearPairResult:
    return OVERLAPPING[name]()


@pytest.mark.parametrize("name", OVERLAPPING)
@pytest.mark.parametrize("shift", few([-0.03, 0.0, 0.4, 0.03]))
@pytest.mark.parametrize("count", few([3, 9]))
def test_all_overlap_is_that_of_the_whole_outlines(name: str, shift: float, count: int) -> None:
    """In its place, mounted close and wide (in modules), and turned by up to half a tooth."""
    made = overlapping(name)
    module = made.pair.module
    turning = turning_of(made, shift * module)
    angles = np.radians(np.arange(count) * 360.0 / count + 0.3)
    for lead in np.array([0.0, 0.01, -0.01, 0.2, -0.4]) * module / made.pair.center_distance:
        found = turning.overlaps(angles, OVERCLOSURE, lead)
        areas = np.bincount(found.step, found.area, minlength=len(angles))
        expected = whole_areas(made, turning.distance, angles, lead)
        assert areas == pytest.approx(expected, rel=1e-9, abs=1e-12 * module**2)


@pytest.mark.parametrize("name", few(OVERLAPPING))
@pytest.mark.parametrize(
    ("shift", "lead"),
    few([(0.0, 0.0), (0.1, 0.3), (-0.5, 0.4), (0.0, -1.5), (-0.4, 0.02), (-0.3, 0.0)]),
)
def test_pieces_are_those_of_every_two_halves(name: str, shift: float, lead: float) -> None:
    """Shift and lead in modules: tips in roots, and flanks through flanks."""
    made = overlapping(name)
    turning = turning_of(made, shift * made.pair.module)
    angle = lead * made.pair.module / made.pair.center_distance
    angles = TURN[::40]
    found = turning.overlaps(angles, OVERCLOSURE, angle)
    for step, phi in enumerate(angles):
        back = np.exp(-1j * (made.law.phi2(phi) + angle))
        seen = np.exp(-1j * (phi + OVERCLOSURE)) * back, -turning.distance * back
        one = placed(turning.driver, *seen)
        tree = shapely.STRtree(placed(turning.driven, 1.0, 0.0))
        pairs = tree.query(one)
        pairs = pairs[:, np.lexsort(pairs[::-1])]
        shared = shapely.intersection(one[pairs[0]], tree.geometries[pairs[1]])
        some = shapely.area(shared) > 0.0
        mine = np.flatnonzero(found.step == step)
        mine = mine[np.lexsort(found.half[::-1, mine])]
        assert np.array_equal(found.half[:, mine], pairs[:, some])
        corners = [shapely.get_coordinates(piece) @ [1, 1j] - seen[1] for piece in shared[some]]
        spans = [np.hypot(np.ptp(piece.real), np.ptp(piece.imag)) for piece in corners]
        ends = [[f(np.abs(piece)) for piece in corners] for f in (np.min, np.max)]
        areas = shapely.area(shared[some])
        assert found.area[mine] == pytest.approx(areas, rel=1e-8, abs=1e-13)
        assert found.length[mine] == pytest.approx(spans, rel=1e-9, abs=1e-9)
        assert found.radius[:, mine] == pytest.approx(np.array(ends), rel=1e-4)


def placed(halves: HalfTeeth, turn: Any, shift: Any) -> Any:
    """All halves of a closed wheel, turned and shifted."""
    parts: Any = np.split(halves.points * turn + shift, halves.starts[1:-1])
    return np.array([shapely.Polygon(np.stack([z.real, z.imag], axis=1)) for z in parts])
