"""Fans cut off dense edges: with what they leave they cover a region once."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.fans import Fans, fans


def wavy(count: int, waves: int, height: float) -> Plane:
    """A loop with hollow and round places."""
    angle = 2.0 * math.pi * np.arange(count) / count
    return np.asarray((1.0 + height * np.cos(waves * angle)) * np.exp(1j * angle), complex)


def dense(corners: list[complex], each: int) -> Plane:
    """A polygon whose sides have many vertices."""
    share = np.arange(each) / each
    sides = zip(corners, corners[1:] + corners[:1], strict=True)
    return np.concatenate([np.asarray(a + (b - a) * share, complex) for a, b in sides])


def doubled_areas(points: Plane, made: Fans) -> Array:
    a, b, c = np.append(points, made.apexes)[made.triangles].T
    return (np.conj(b - a) * (c - a)).imag


def demand_cover(points: Plane, made: Fans) -> None:
    """All triangles stand upright, what is left is a polygon, and nothing is missing."""
    places = np.append(points, made.apexes)
    left = places[made.loop]
    polygon = shapely.Polygon(np.column_stack([left.real, left.imag]))
    areas = doubled_areas(points, made)
    assert np.all(areas > 0.0)
    assert polygon.is_valid
    whole = float((np.conj(points) * np.roll(points, -1)).imag.sum())
    ring = float((np.conj(left) * np.roll(left, -1)).imag.sum())
    assert areas.sum() + ring == pytest.approx(whole, rel=1e-12)
    chords = np.sort(made.triangles[:, 0])
    assert len(np.unique(chords)) == len(chords)
    assert len(made.loop) + len(chords) == len(points) + 2 * len(made.apexes)


@given(
    count=st.integers(20, 3000),
    waves=st.integers(0, 9),
    height=st.floats(0.0, 0.3),
    turned=st.floats(0.0, 6.0),
    inside=st.booleans(),
)
def test_random_loops_are_covered_once(
    count: int, waves: int, height: float, turned: float, inside: bool
) -> None:
    loop = wavy(count, waves, height) * cmath.exp(1j * turned)
    demand_cover(loop, fans(loop))
    if inside:
        # the edge of a hole runs the other way: its fans lie beyond it
        made = fans(loop[::-1])
        assert np.all(doubled_areas(loop[::-1], made) > 0.0)


def test_hardly_anything_of_a_smooth_loop_is_left() -> None:
    loop = wavy(20000, 5, 0.2)
    assert len(fans(loop).loop) < len(loop) / 25


@pytest.mark.parametrize("opening", [20.0, 60.0, 120.0])
def test_fans_of_both_sides_of_a_corner_do_not_meet(opening: float) -> None:
    tip = math.radians(opening)
    loop = dense([0.0, 1.0, cmath.exp(1j * tip)], 500)
    demand_cover(loop, fans(loop))


def test_few_chords_have_no_fans() -> None:
    square = np.array([0.0, 1.0, 1.0 + 1.0j, 1.0j])
    made = fans(square)
    assert len(made.apexes) == len(made.triangles) == 0
    assert sorted(made.loop.tolist()) == [0, 1, 2, 3]
