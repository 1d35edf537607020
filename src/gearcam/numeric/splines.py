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
from gearcam.numeric.bulges import as_complex, as_pairs
from gearcam.numeric.contour import Run
from gearcam.numeric.hermite import hermite_arms, hermite_cubic

DEGREE: Final = 3

_AIM: Final = 0.97
"""Part of the predicted length that the search tries: a little short, so that most succeed."""

_LEAST_ERROR: Final = 1e-4
"""Error in tolerances below which a length says nothing: the search grows tenfold at most."""

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
        If the tolerance is not positive or the run has fewer than two different points.
    """
    if not tolerance > 0:
        raise ValueError(f"the tolerance must be positive, not {tolerance}")
    p, t = as_complex(run.points), as_complex(run.tangents)
    kept = np.concatenate([[True], np.diff(p) != 0.0])
    p, t = p[kept], t[kept]
    if len(p) < 2:
        raise ValueError("a run needs at least two different points")
    way = np.concatenate([[0.0], np.cumsum(hermite_arms(p, t))])
    last = len(p) - 1
    ends, start, guess = [0], 0, last
    while start < last:
        end = _longest(p, t, way, start, guess, tolerance)
        ends.append(end)
        start, guess = end, end - start
    index = np.array(ends)
    arms = np.diff(way[index]) / 3.0
    out, into = p[index[:-1]] + arms * t[index[:-1]], p[index[1:]] - arms * t[index[1:]]
    poles = np.concatenate([p[:1], np.stack([out, into], axis=1).ravel(), p[-1:]])
    return Spline(poles=as_pairs(poles), breaks=way[index])


def _longest(p: Plane, t: Plane, way: Array, start: int, guess: int, tolerance: float) -> int:
    """Return the last point to which one cubic from `start` stays within the tolerance."""
    low, high, rounds = start + 1, len(p) - 1, 0
    trial = min(start + guess, high)
    while high - low > _NEAR * (low - start):
        rounds += 1
        trial = min(max(trial, low + 1), high)
        error = _error(p, t, way, start, trial)
        if error <= tolerance:
            low = trial
        else:
            high = trial - 1
        growth = _AIM * (tolerance / max(error, _LEAST_ERROR * tolerance)) ** 0.25
        trial = start + round(growth * (trial - start)) if rounds % 3 else (low + high + 1) // 2
    return low


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
