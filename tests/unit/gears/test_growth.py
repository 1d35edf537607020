"""What grows with the square of a design's size does not: counted in places, not in seconds."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any
from unittest import mock

import numpy as np
import pytest
import shapely

from gearcam.gears.corners import RadialCurve
from gearcam.gears.tip_pass import RollStates, SpaceIntervals, find_stays, tip_pass
from gearcam.laws.ratio.centrodes import LogSpiral
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.meshing.half_teeth import half_teeth
from gearcam.numeric import arcs
from gearcam.numeric.arrays import Plane
from gearcam.numeric.contour import Run
from gearcam.numeric.jets import Jet, sin
from gearcam.numeric.piecewise import Piece, Piecewise
from gearcam.numeric.sampling import Sampler
from helpers_built import fresh
from helpers_pairs import job
from helpers_rings import ring

ELLIPSE = {"type": "ellipse", "eccentricity": 0.3}
OPEN = {"type": "log-spiral", "ratios": [0.5, 0.6], "driven_travel_deg": 90}


def counted(owner: Any, name: str, size: Callable[..., int]) -> tuple[Any, list[int]]:
    """A patch that counts what a function is asked for, and the counts."""
    original, counts = getattr(owner, name), []

    def told(*given: Any, **options: Any) -> Any:
        counts.append(size(*given))
        return original(*given, **options)

    return mock.patch.object(owner, name, told), counts


# Vertices


@pytest.mark.parametrize("tolerance", np.geomspace(1e-2, 4e-2, 10).tolist())
def test_vertices_are_spread_a_few_times(tolerance: float) -> None:
    """With few chords between corners it went to and fro, for 120 places a vertex."""
    for law in (Constant(), Ellipse(eccentricity=0.3)):
        made = fresh(job(law, (20, 20), module=2.0, tolerance=tolerance))
        sampler = made.gear1.profile.sampler
        _ = sampler.density
        patch, places = counted(Sampler, "at", lambda _, j: np.size(j))
        with patch:
            _, points, error = Sampler.chords.func(sampler)  # type: ignore[attr-defined]
        assert error <= tolerance
        assert len(points) <= sum(places) <= 30 * len(points)


def test_vertices_spread_anew_are_not_fewer_than_curvature_asks_for() -> None:
    """With fewer of them a third of the chords was off by too much, and was halved."""
    sampler = job(Constant(), (40, 40), module=2.0, tolerance=0.0247).gear1.profile.sampler
    runs = np.diff(np.append(sampler.corners, sampler.least))
    assert len(sampler.chords[1]) <= 1.02 * np.ceil(runs / 0.955).sum()


# Corners in a ring


def every_roll(
    rolls: RollStates, points: np.ndarray, first: np.ndarray, count: int, edge: RadialCurve
) -> SpaceIntervals:
    """Stays by looking at all corners at all rolls."""
    found = []
    for corner, point in enumerate(points):
        k = first[corner] + np.arange(count)
        depth = edge.beyond(rolls.shift[k] + rolls.turn[k] * point)
        inside = np.flatnonzero(depth > 0.0)
        for stay in np.split(inside, np.flatnonzero(np.diff(inside) > 1) + 1):
            if stay.size:
                ends = [max(stay[0] - 2, 0)] if stay[0] else []
                ends += [min(stay[-1] + 2, count - 1)] if stay[-1] < count - 1 else []
                deep = stay[depth[stay].argmax()]
                found += [(corner, deep, end) for end in ends or [stay[depth[stay].argmin()]]]
    corner, deep, end = np.array(found).T
    return SpaceIntervals(corner, rolls.phi[first[corner] + deep], rolls.phi[first[corner] + end])


@pytest.mark.parametrize(
    ("law", "teeth"),
    [
        (ELLIPSE, (24, 48)),
        (ELLIPSE | {"eccentricity": 0.6}, (40, 80)),
        ({"type": "formula", "ratio": "1 + 0.05*cos(4*phi1) + 0.1*cos(2*phi1)"}, (30, 60)),
        ({"type": "constant"}, (28, 33)),
        (OPEN, (24, 24)),
    ],
)
def test_corners_are_seen_wherever_they_come_into_a_ring(
    law: dict[str, Any], teeth: tuple[int, int]
) -> None:
    from gearcam.gears import tip_pass as room

    def compared(*given: Any) -> SpaceIntervals:
        found, all_of_them = find_stays(*given), every_roll(*given)
        for one, other in zip(found, all_of_them, strict=True):
            np.testing.assert_array_equal(one, other)
        return found

    profiles = [gear.profile for gear in fresh(ring(law, teeth)).gears]
    few_at_once = mock.patch.object(room, "_BLOCK", 1000)
    with few_at_once, mock.patch.object(room, "find_stays", compared):
        assert math.isfinite(tip_pass(*profiles).margin)


# A meshing study


@pytest.mark.parametrize(
    "law", [Constant(), LogSpiral(ratios=(0.5, 2.0), driven_travel=math.radians(200))]
)
def test_half_teeth_are_as_far_as_their_union(law: Any) -> None:
    halves = half_teeth(job(law, (20, 20), module=2.0, tolerance=0.01).gear1.profile)
    low, _, high, _ = shapely.total_bounds(halves.polygons)
    grid = np.linspace(low, high, 23)
    points = (grid + 1j * grid[:, None]).ravel()
    union = shapely.MultiPolygon(halves.polygons.tolist())
    away = shapely.distance(union, shapely.points(points.real, points.imag))
    assert (away == 0.0).any()
    np.testing.assert_allclose(halves.distance(points), away, rtol=1e-14, atol=1e-13)


# Long runs and many places


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_long_run_is_not_looked_through_for_every_arc(sense: float) -> None:
    """Twice around a circle in one run: each point is measured some 15 times, at any length."""
    for count in (2000, 32000):
        t = np.linspace(0.0, 4.0 * math.pi, count)
        spokes: Plane = np.exp(1j * t)[:: int(sense)]
        run = Run(points=spokes * 30.0, tangents=spokes * (sense * 1j))
        patch, ranges = counted(
            arcs, "largest", lambda _, low, high: int(np.maximum(high - low, 0).sum())
        )
        with patch:
            ((_, bulges),) = arcs.fit_arcs([run], 1e-3)
        assert sum(ranges) < 25 * count
        # as few arcs as may turn by a quarter of a circle each, a point less where none is there
        turns = sense * 4.0 * np.arctan(bulges)
        assert np.all(turns <= arcs.MAX_TURN * (1.0 + 1e-9))
        assert len(turns) in (8, 9)
        assert turns.sum() == pytest.approx(4.0 * math.pi, abs=1e-3)


def test_many_places_are_evaluated_in_blocks() -> None:
    seen: list[int] = []

    def wave(x: Jet, factor: Any) -> Jet:
        seen.append(np.size(x.c[0]))
        return factor * sin(x)

    pieces = tuple(Piece(wave, parameters=(k,)) for k in (1.0, 2.0))
    made = Piecewise(knots=np.array([0.0, 1.0, 3.0]), pieces=pieces, offsets=np.zeros(2))
    x = np.linspace(0.0, 3.0, 200_000)
    found = made.derivatives(x, 2)
    assert max(seen) <= 1 << 15
    factor = np.where(x < 1.0, 1.0, 2.0)
    np.testing.assert_array_equal(found[1], factor * np.cos(x))
