"""Stepwise overlap against the intersection of the whole outlines, and graphs against polygons."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from gearcam.jobs.gear_pair import GearPairJob
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.meshing.halves import Halves, halve
from gearcam.meshing.overlap import Turning
from helpers_pairs import job, profile

Array = NDArray[np.float64]

ADVANCE = math.radians(0.005)
TURN = np.radians(np.arange(360.0))


@cache
def halves_of(made: GearPairJob) -> tuple[Halves, Halves]:
    return halve(made.gear1.profile), halve(made.gear2.profile)


def turning_of(made: GearPairJob, shift: float = 0.0) -> Turning:
    first, second = halves_of(made)
    distance = made.pair.center_distance + shift
    return Turning(rolling=made.pair.rolling, driver=first, driven=second, distance=distance)


def whole_areas(made: GearPairJob, distance: float, angles: Array, lead: float) -> list[float]:
    """Overlap of the whole outlines."""
    areas = []
    for phi in angles:
        turned = (
            made.gear1.outline @ [1, 1j] * np.exp(-1j * (phi + ADVANCE)),
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
def overlapping(name: str) -> GearPairJob:
    return OVERLAPPING[name]()


@pytest.mark.parametrize("name", OVERLAPPING)
@pytest.mark.parametrize("shift", [0.0, 0.03, -0.03, 0.4])
def test_all_overlap_is_that_of_the_whole_outlines(name: str, shift: float) -> None:
    """In its place, mounted close and wide (in modules), and turned by up to half a tooth."""
    made = overlapping(name)
    module = made.pair.module
    turning = turning_of(made, shift * module)
    angles = np.radians(np.linspace(0.0, 360.0, 9) + 0.3)
    for lead in np.array([0.0, 0.01, -0.01, 0.2, -0.4]) * module / turning.distance:
        found = turning.overlaps(angles, ADVANCE, lead)
        areas = np.bincount(found.step, found.area, minlength=len(angles))
        expected = whole_areas(made, turning.distance, angles, lead)
        assert areas == pytest.approx(expected, rel=1e-9, abs=1e-12 * module**2)


@pytest.mark.parametrize(("lead", "share"), [(0.0, 0.0), (2e-4, 0.0), (-0.03, 1.0)])
def test_polygons_are_asked_where_a_graph_cannot_tell(lead: float, share: float) -> None:
    """Half a tooth off, tips stand in roots; in place, nothing goes beyond its half."""
    turning = turning_of(profile("nail_machine_two_phase"))
    asked: list[int] = []
    cut = turning._cut
    turning.__dict__["_cut"] = lambda step, facing: asked.extend(step) or cut(step, facing)
    turning.overlaps(TURN, ADVANCE, lead)
    assert len(set(asked)) == pytest.approx(share * len(TURN), abs=8)


@pytest.mark.parametrize("name", OVERLAPPING)
@pytest.mark.parametrize(
    ("shift", "lead"), [(0.0, 0.0), (0.1, 0.3), (0.0, -1.5), (-0.3, 0.0), (-0.4, 0.02), (-0.5, 0.4)]
)
def test_graphs_and_polygons_find_the_same_pieces(name: str, shift: float, lead: float) -> None:
    """Shift and lead in modules: tips in roots, and flanks through flanks."""
    made = overlapping(name)
    turning = turning_of(made, shift * made.pair.module)
    angle = lead * made.pair.module / turning.distance
    angles = TURN[::5]
    graphs = turning.overlaps(angles, ADVANCE, angle)
    turn, shifts = turning.pose(angles, ADVANCE, angle)
    polygons = turning._cut(*turning._near(angles, turn, shifts))
    keys = [
        (found.step * turning.driver.count + found.half[0]) * turning.driven.count + found.half[1]
        for found in (graphs, polygons)
    ]
    a, b = (np.argsort(key) for key in keys)
    assert np.array_equal(keys[0][a], keys[1][b])
    assert np.array_equal(graphs.facing[a], polygons.facing[b])
    assert graphs.area[a] == pytest.approx(polygons.area[b], rel=1e-8, abs=1e-13)
    assert graphs.radius[:, a] == pytest.approx(polygons.radius[:, b], rel=1e-4)
    assert graphs.length[a] == pytest.approx(polygons.length[b], rel=1e-9, abs=1e-9)
