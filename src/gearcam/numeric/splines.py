"""Cubic B-splines through sampled curves: for files that hold curves instead of chords.

A piece of curve becomes a chain of cubics, each as long as the tolerance allows, joined with a
common tangent: a B-spline of degree 3 with double knots, so that its control points are the inner
ones of the cubics. Each cubic has the true points and tangents at its ends and arms of a third of
its length; its error falls with the fourth power of that length.

Refused: tolerances that are not positive.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.bulges import as_pairs
from gearcam.numeric.contour import Run
from gearcam.numeric.fitting import longest_pieces, points_to_fit
from gearcam.numeric.hermite import hermite_arms, hermite_cubic

DEGREE: Final = 3

_NEAR: Final = 0.05
"""The search stops where the longest fitting piece is known to this part of its length."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Spline:
    """A cubic B-spline, clamped, its inner knots double.

    Parameters
    ----------
    poles : (2k + 2, 2) array, mm
        Control points of k cubics.
    breaks : (k + 1,) array, mm
        Its different knots: about the arc length.
    """

    poles: Array
    breaks: Array

    @property
    def knots(self) -> Array:
        """All knots, with repetitions."""
        inner = np.repeat(self.breaks[1:-1], 2)
        return np.concatenate(
            [np.repeat(self.breaks[:1], 4), inner, np.repeat(self.breaks[-1:], 4)]
        )


def fit_spline(run: Run, tolerance: float) -> Spline:
    """Fit a cubic B-spline to a smooth piece of curve.

    Parameters
    ----------
    run : Run
        Dense points and tangents.
    tolerance : float, mm
        Largest distance of the points from it.

    Returns
    -------
    Spline
        Through both ends, with the tangents there.

    Raises
    ------
    ValueError
        If the tolerance is not positive, or the run is not finite or has fewer than two different
        points.
    """
    p, t = points_to_fit(run, tolerance)
    way = np.concatenate([[0.0], np.cumsum(hermite_arms(p, t))])
    last = len(p) - 1

    def miss(start: int, end: int) -> tuple[float, None]:
        return _error(p, t, way, start, end), None

    pieces = longest_pieces(miss, lambda _: last, last, tolerance, 4, _NEAR)
    index = np.array([0, *(end for end, _ in pieces)])
    arms = np.diff(way[index]) / 3.0
    out, into = p[index[:-1]] + arms * t[index[:-1]], p[index[1:]] - arms * t[index[1:]]
    poles = np.concatenate([p[:1], np.stack([out, into], axis=1).ravel(), p[-1:]])
    return Spline(poles=as_pairs(poles), breaks=way[index])


def _error(p: Plane, t: Plane, way: Array, start: int, end: int) -> float:
    """Return the largest distance of inner points from the cubic that joins two of them."""
    inner = slice(start + 1, end)
    length = way[end] - way[start]
    if end - start < 2:
        return 0.0
    u = (way[inner] - way[start]) / length
    way, _ = hermite_cubic(p[end] - p[start], length * t[start], length * t[end], u)
    miss = p[start] + way - p[inner]
    # across the curve; what is along it only shifts the parameter, and counts by its square
    bend = abs(np.angle(t[end] * np.conj(t[start]))) / length
    across = np.abs((miss * np.conj(t[inner])).imag)
    return float((across + 0.5 * bend * np.abs(miss) ** 2).max())
