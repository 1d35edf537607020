"""How straight, or how round, a stretch of a path is.

Lines and circles are those with the smallest largest deviation. A line is the middle of the
narrowest strip round the stretch: where the strip's width is least, its change with the strip's
direction, the way between the points that touch both sides, goes through 0. A circle is the one
nearest to points of the stretch; the points farthest from it are added until none is farther.
Deviations are extremes, not samples.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np

from gearcam.linkages.measures import Extremes, Peak, extremes_of, least_and_largest
from gearcam.linkages.nearest_circle import moved_center, nearest_center
from gearcam.linkages.paths import PointPath
from gearcam.linkages.plane import imaginary, square
from gearcam.numeric.arrays import Array, Plane, distinct
from gearcam.numeric.jets import Jet
from gearcam.numeric.roots import bracketed_root

_PLACES: Final = 256
"""Points of a stretch from which a fit starts."""

_DIRECTIONS: Final = 720
"""Directions of strips that are compared at first, over half a turn."""

_STRIPS: Final = 3
"""Of the narrowest ones, how many are compared exactly: between points one may be wider."""

_FOUND: Final = 1e-15
"""Accuracy of a direction, rad."""

_ROUNDS: Final = 40
"""Largest number of times that a circle is mended at the points farthest from it."""

_EVEN: Final = 1e-12
"""Difference of deviations that is none, as a share of the radius."""


class LineFit(NamedTuple):
    """The straight line nearest to a stretch.

    Attributes
    ----------
    point : complex, mm
        Its middle, beside the middle of the stretch.
    direction : float, rad
        From -pi/2 to pi/2.
    deviation : float, mm
        Largest distance of the stretch from it: half the width of the strip.
    length : float, mm
        Of the stretch, along the line.
    """

    point: complex
    direction: float
    deviation: float
    length: float


class CircleFit(NamedTuple):
    """The circle nearest to a stretch.

    Attributes
    ----------
    center : complex, mm
        Its centre.
    radius : float, mm
        Middle of the smallest and the largest distance from it.
    deviation : float, mm
        Largest distance of the stretch from the circle.
    angle : float, rad
        Of the arc, as the driver turns: positive counter-clockwise.
    """

    center: complex
    radius: float
    deviation: float
    angle: float


def best_line(path: PointPath, begin: float, end: float) -> LineFit:
    """Return the straight line nearest to a stretch of a path.

    Parameters
    ----------
    path : PointPath
        The path.
    begin, end : float, rad
        The driver's angles; past the end of a turn if it is closed.

    Returns
    -------
    LineFit

    Raises
    ------
    ValueError
        If the end is not behind the begin, or the stretch is not in the path's range.
    """
    knots = _knots(path, begin, end)
    strips = [_strip(path, knots, one) for one in _narrow(_samples(path, knots))]
    near, low, high = min(strips, key=lambda one: one[2].value - one[1].value)
    along = _sides(path, knots, near - 0.5 * np.pi)  # by the height over a line across
    middle = 0.5 * (along[0].value + along[1].value) + 0.5j * (low.value + high.value)
    direction = math.remainder(near, math.pi)
    return LineFit(
        complex(middle * np.exp(1j * near)),
        direction,
        0.5 * (high.value - low.value),
        along[1].value - along[0].value,
    )


def _narrow(points: Plane) -> Array:
    """Return directions next to which a strip round points is narrowest, the best first."""
    turned = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _DIRECTIONS, endpoint=False)
    widths = np.array([np.ptp((points * np.exp(-1j * one)).imag) for one in turned])
    least = widths <= np.minimum(np.roll(widths, 1), np.roll(widths, -1))
    return turned[least][widths[least].argsort()][:_STRIPS]


def _strip(path: PointPath, knots: Array, near: float) -> tuple[float, Peak, Peak]:
    """Return the direction of the narrowest strip next to one, and the points at its sides."""

    def change(direction: Array) -> Array:
        """Return the slope of the strip's width."""
        found = []
        for one in direction:
            low, high = _sides(path, knots, float(one))
            ends = np.asarray(path.at(np.array([low.place, high.place]), 0).c[0])
            found.append(((ends[0] - ends[1]) * np.exp(-1j * one)).real)
        return np.array(found)

    step = np.pi / _DIRECTIONS
    edges = np.array([near - step]), np.array([near + step])
    slopes = change(edges[0]), change(edges[1])
    if slopes[0][0] < 0.0 < slopes[1][0]:
        near = float(bracketed_root(change, *edges, _FOUND, slopes)[0])
    return near, *_sides(path, knots, near)


def best_circle(path: PointPath, begin: float, end: float) -> CircleFit:
    """Return the circle nearest to a stretch of a path.

    Parameters
    ----------
    path : PointPath
        The path.
    begin, end : float, rad
        The driver's angles; past the end of a turn if it is closed.

    Returns
    -------
    CircleFit

    Raises
    ------
    ValueError
        If the end is not behind the begin, the stretch is not in the path's range, or it is
        straight.
    """
    knots = _knots(path, begin, end)
    points = known = _samples(path, knots)
    center = nearest_center(points)
    best = (math.inf, center)
    for _ in range(_ROUNDS):
        places, values = _distances(path, knots, center)
        best = min(best, (0.5 * float(np.ptp(values)), center), key=lambda one: one[0])
        known = np.concatenate([known, np.asarray(path.at(places, 0).c[0])])
        center, least = moved_center(known, center)
        if best[0] - least <= _EVEN * values.max():
            break
    _, center = best
    low, high = least_and_largest(_distances(path, knots, center))
    spokes = points - center
    turned = float(np.angle(spokes[1:] / spokes[:-1]).sum())
    return CircleFit(center, 0.5 * (low.value + high.value), 0.5 * (high.value - low.value), turned)


def distances_from(path: PointPath, center: complex, begin: float, end: float) -> tuple[Peak, Peak]:
    """Return the smallest and the largest distance of a stretch of a path from a point.

    Parameters
    ----------
    path : PointPath
        The path.
    center : complex, mm
        The point.
    begin, end : float, rad
        The driver's angles; past the end of a turn if it is closed.

    Returns
    -------
    two Peak
        Distances, mm, and the driver's angles.

    Raises
    ------
    ValueError
        If the end is not behind the begin, or the stretch is not in the path's range.
    """
    return least_and_largest(_distances(path, _knots(path, begin, end), center))


def _knots(path: PointPath, begin: float, end: float) -> Array:
    """Return the ends of a stretch and the path's knots between them."""
    low, high = path.span
    if not begin < end:
        raise ValueError(f"stretch {begin:g} to {end:g} rad: its end must be behind its begin")
    if not path.closed and not low <= begin < end <= high:
        raise ValueError(
            f"stretch {begin:g} to {end:g} rad: must be within {low:g} and {high:g} rad"
        )
    turn = high - low
    turns = range(math.floor((begin - low) / turn), math.floor((end - low) / turn) + 1)
    knots = np.concatenate([np.asarray(path.knots) + k * turn for k in turns])
    return distinct(knots[(begin < knots) & (knots < end)], [begin, end])


def _samples(path: PointPath, knots: Array) -> Plane:
    return np.asarray(path.at(np.linspace(knots[0], knots[-1], _PLACES), 0).c[0])


def _extremes(path: PointPath, knots: Array, of: Callable[[Jet], Jet]) -> Extremes:
    return extremes_of(lambda q, order: of(path.at(q, order)), knots, 0)[0]


def _sides(path: PointPath, knots: Array, direction: float) -> tuple[Peak, Peak]:
    """Return the lowest and the highest point over a direction."""
    turn = np.exp(-1j * direction)
    return least_and_largest(_extremes(path, knots, lambda point: imaginary(point * turn)))


def _distances(path: PointPath, knots: Array, center: complex) -> Extremes:
    """Return extremes of the distance from a point."""
    places, _ = _extremes(path, knots, lambda point: square(point - center))
    return places, np.abs(np.asarray(path.at(places, 0).c[0]) - center)
