"""Cubic B-splines through sampled curves: for files with curves instead of chords.

A piece of curve becomes a chain of cubics, each as long as the tolerance allows, joined with a
common tangent: a B-spline of degree 3 with double knots, so that its control points are the inner
ones of the cubics. Each cubic has the true points and tangents at its ends, and handles of a third
of its length; its error falls with the fourth power of that length.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.contour import Run
from gearcam.numeric.fitting import (
    Checks,
    RunPoints,
    checks_of,
    largest,
    longest_pieces,
    points_to_fit,
)
from gearcam.numeric.hermite import hermite_arms, hermite_cubic

DEGREE: Final = 3

_NEAR: Final = 0.05
"""Relative tolerance of the length of the longest piece that fits."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Spline:
    """A clamped cubic B-spline with double inner knots.

    Parameters
    ----------
    poles : (2k + 2,) complex array, mm
        Control points of k cubics.
    breaks : (k + 1,) array, mm
        Its distinct knots: approximately the arc length.
    """

    poles: Plane
    breaks: Array

    @property
    def knots(self) -> Array:
        """All knots, with repetitions."""
        inner = np.repeat(self.breaks[1:-1], 2)
        return np.concatenate(
            [np.repeat(self.breaks[:1], 4), inner, np.repeat(self.breaks[-1:], 4)]
        )


def fit_splines(runs: Sequence[Run], tolerance: float) -> list[Spline]:
    """Return a cubic B-spline for each of some smooth pieces of curve.

    Parameters
    ----------
    runs : sequence of Run
        Dense points and tangents.
    tolerance : float, mm
        Largest distance of the points from the spline.

    Returns
    -------
    list of Spline
        Each through both ends of its run, with the tangents there.

    Raises
    ------
    ValueError
        If the tolerance is not positive, or a run is not finite or has fewer than two different
        points.
    """
    rows = points_to_fit(runs, tolerance)
    p, t, first, last = rows
    way = np.append(0.0, np.cumsum(hermite_arms(p, t)))
    checks = checks_of(rows, tolerance, even=False)
    gone = np.interp(np.arange(len(checks.points)), checks.place, way)  # steps are divided evenly
    errors = partial(_errors, rows, way, checks, gone)
    start, end = longest_pieces(errors, rows, tolerance, 4, _NEAR)
    arms = (way[end] - way[start]) / 3.0
    inner = np.stack([p[start] + arms * t[start], p[end] - arms * t[end]], axis=1)
    made = []
    for low, high in zip(first, last, strict=True):
        own = slice(*np.searchsorted(start, (low, high)))
        poles = np.concatenate([p[[low]], inner[own].ravel(), p[[high]]])
        breaks = np.append(way[start[own]], way[high]) - way[low]
        made.append(Spline(poles=poles, breaks=breaks))
    return made


def _errors(
    rows: RunPoints, way: Array, checks: Checks, gone: Array, start: Ints, end: Ints
) -> Array:
    """Return the largest distances of check points from the cubics between their points."""
    p, t = rows.points, rows.tangents
    length = way[end] - way[start]
    chord, first, second = p[end] - p[start], length * t[start], length * t[end]
    bend = np.abs(np.angle(t[end] * np.conj(t[start]))) / length

    def away(index: Ints, of: Ints) -> Array:
        begin = start[of]
        u = (gone[index] - way[begin]) / length[of]
        cubic = p[begin] + hermite_cubic(chord[of], first[of], second[of], u)[0]
        miss = cubic - checks.points[index]
        # across the curve; a distance along it only shifts the parameter, and enters squared
        across = np.abs((miss * np.conj(checks.tangents[index])).imag)
        return across + 0.5 * bend[of] * np.abs(miss) ** 2

    return largest(away, checks.place[start] + 1, checks.place[end])
