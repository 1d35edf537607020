"""Curvature from three neighbouring points, and how far it can be trusted.

The circle through three points of a curve has approximately the curve's curvature at the middle
point: the error falls with the square of the spacing where curvature and spacing change smoothly,
with the spacing itself where it is uneven, and not at all next to a jump of the curvature.

Refused: fewer than three points, equal neighbours.

Source: 004 section 8, which takes the circle's radius and centre; the curvature of the same circle
here is a cross product over three sides, with no division by zero on straight parts.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import Array, Ints, Plane


@dataclass(frozen=True, eq=False, kw_only=True)
class CurvatureStudy:
    """Error of the curvature from three points against the spacing of the points.

    Parameters
    ----------
    count : (k,) int array
        Numbers of points.
    spacing : (k,) array, mm
        Largest distance of neighbours.
    largest, rms : (k,) arrays, 1/mm
        Largest error, and root of the mean square, over all points.
    """

    count: Ints
    spacing: Array
    largest: Array
    rms: Array


def three_point_curvature(points: Plane, closed: bool = True) -> Array:
    """Return the curvature of the circle through each point and its two neighbours.

    Parameters
    ----------
    points : (n,) complex array, mm
        Points of a curve in order.
    closed : bool
        Whether the last point is followed by the first, which is not repeated.

    Returns
    -------
    (n,) array, 1/mm
        Positive where the curve turns left: convex, if it runs counter-clockwise. For an open curve
        (n - 2,), without its ends.

    Raises
    ------
    InfeasibleError
        If there are fewer than three points, or equal neighbours.
    """
    z = points
    if len(z) < 3:
        raise InfeasibleError("too few points for a circle", value=len(z), limit=3, unit="points")
    if closed:
        z = np.concatenate([z[-1:], z, z[:1]])
    step = np.diff(z)
    before, after = step[:-1], step[1:]
    sides = np.abs(before) * np.abs(after) * np.abs(before + after)
    if not np.all(sides > 0.0):
        what = "a point and its neighbours are not three different points"
        raise InfeasibleError(what, where=f"point {int(np.argmin(sides > 0.0)) + int(not closed)}")
    # before x after = before x (after - before): the product of similar steps loses no digits
    return 2.0 * (np.conj(before) * (after - before)).imag / sides


def curvature_study(
    curve: Callable[[Array], Plane],
    exact: Callable[[Array], Array],
    counts: Sequence[int],
    period: float = 2.0 * math.pi,
    closed: bool = True,
) -> CurvatureStudy:
    """Return errors of the curvature from three points, for rising numbers of points.

    Parameters
    ----------
    curve : callable
        ``curve(u) -> (n,) complex array``, mm: a curve.
    exact : callable
        ``exact(u) -> (n,) array``, 1/mm: its curvature, positive where it turns left.
    counts : sequence of int
        Numbers of points, at even steps of u from 0.
    period : float
        Range of u.
    closed : bool
        Whether it ends where it begins; the ends of an open curve have no curvature.

    Returns
    -------
    CurvatureStudy
    """
    rows = []
    for count in counts:
        u = np.linspace(0.0, period, count, endpoint=not closed)
        points = curve(u)
        error = three_point_curvature(points, closed) - exact(u if closed else u[1:-1])
        spacing = np.abs(np.diff(points, append=points[:1] if closed else points[-1:])).max()
        rows.append((spacing, np.abs(error).max(), math.sqrt(np.mean(error**2))))
    spacing, largest, rms = np.array(rows).T
    return CurvatureStudy(count=np.array(counts), spacing=spacing, largest=largest, rms=rms)
