"""Simple polygons, distances and turns around places, against shapely and angles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely

from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.polygons import is_simple, nearest, turns_around


def seen(points: Any) -> bool:
    """What shapely says, but for points that repeat, which it leaves out."""
    ring = shapely.LinearRing(as_pairs(points))
    return bool(ring.is_simple) and bool(np.all(np.roll(points, -1) != points))


def scattered(random: np.random.Generator, count: int, most: int) -> Any:
    x, y = random.integers(0, most, (2, count)).astype(float)
    return x + 1j * y


def wavy(random: np.random.Generator, count: int) -> Any:
    """A closed curve of a few waves, with loops or without."""
    angle = 2.0 * np.pi * np.arange(count) / count
    orders = np.arange(-4, 7)
    sizes = random.normal(size=(11, 2)) @ [1.0, 1j] / (1.0 + 3.0 * (orders - 1.0) ** 2)
    return np.exp(1j * np.outer(angle, orders)) @ sizes


def toothed(teeth: int, lean: float, count: int = 3000) -> Any:
    """A wheel whose teeth lean over: from some lean on they cross their roots."""
    angle = 2.0 * np.pi * np.arange(count) / count
    radius = 1.0 + np.sin(teeth * angle) / teeth
    turned = angle + lean * np.sin(2 * teeth * angle) / teeth
    return 30.0 * radius * np.exp(1j * turned)


def test_among_whole_numbers_the_decision_is_exact() -> None:
    """Few places, so that points repeat, lie on chords, and chords on each other."""
    random = np.random.default_rng(8)
    found = []
    for _ in range(6000):
        points = scattered(random, int(random.integers(1, 9)), int(random.integers(2, 6)))
        if len(points) > 2:
            found.append(is_simple(points))
            assert found[-1] == seen(points), points
        else:
            assert not is_simple(points)
    assert 500 < sum(found) < len(found) - 500


@pytest.mark.parametrize("count", [20, 150, 1000])
def test_curves_with_loops_and_without(count: int) -> None:
    random = np.random.default_rng(count)
    found = []
    for _ in range(150):
        points = wavy(random, count) * 10.0 ** random.uniform(-3, 3) + 5.0 - 3.0j
        found.append(is_simple(points))
        assert found[-1] == is_simple(points[::-1]) == seen(points)
    assert 20 < sum(found) < 130


@pytest.mark.parametrize("teeth", [9, 40])
def test_teeth_that_lean_over(teeth: int) -> None:
    leans = np.linspace(0.0, 3.0, 61)
    found = [is_simple(toothed(teeth, lean)) for lean in leans]
    assert found == [seen(toothed(teeth, lean)) for lean in leans]
    assert found[0]
    assert not found[-1]


def test_what_touches_itself_is_never_simple() -> None:
    """However it is turned: rounding may move the point to either side of the chord."""
    notched = np.array([0.0, 4.0, 4.0 + 4.0j, 2.0 + 0.0j, 4.0j])  # with its tip on the base
    folded = np.array([0.0, 3.0, 2.0, 2.0 + 2.0j])
    doubled = np.array([0.0, 2.0, 2.0 + 1.0j, 2.0 + 1.0j, 1.0j])
    for turn in np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 200)):
        for points in (notched, folded, doubled):
            assert not is_simple(points * turn)
    notched[3] += 1e-12j
    assert is_simple(notched)


def test_what_is_no_number_is_not_simple() -> None:
    square = np.array([0.0, 1.0, 1.0 + 1.0j, 1.0j])
    assert is_simple(square)
    for wrong in (np.nan, np.inf):
        assert not is_simple(np.append(square, wrong))
        assert not is_simple(np.array([0.0, wrong, 1.0j]))


def test_distances_and_turns_are_those_of_shapely_and_of_angles() -> None:
    random = np.random.default_rng(4)
    turns = set()
    for count in (3, 4, 7, 12, 40, 300):
        for _ in range(60):
            points = wavy(random, count) if count > 12 else scattered(random, count, 5)
            place = complex(*random.uniform(-2.0, 5.0 if count < 13 else 2.0, 2))
            ring = shapely.LinearRing(as_pairs(points))
            wanted = ring.distance(shapely.Point(place.real, place.imag))
            assert nearest(points, place) == pytest.approx(wanted, rel=1e-13, abs=1e-14)
            away = points - place
            angle = float(np.angle(np.roll(away, -1) * np.conj(away)).sum())
            turns.add(turns_around(points, place))
            assert turns_around(points, place) == pytest.approx(angle / (2.0 * np.pi), abs=1e-9)
    assert {-1, 0, 1} <= turns


def test_places_at_the_height_of_corners_and_chords() -> None:
    cross = np.array([1, 1 + 1j, -1 + 1j, -1, -1 - 1j, 1 - 1j])
    assert [turns_around(cross, place) for place in (0j, 0.5, -0.5, 2.0, -2.0)] == [1, 1, 1, 0, 0]
    assert turns_around(cross[::-1]) == -1
    assert turns_around(np.tile(cross, 2)) == 2
    assert nearest(cross) == 1.0
    assert nearest(np.array([2.0, 2.0, 2.0 + 1.0j])) == 2.0  # a point that repeats
