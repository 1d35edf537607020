"""The paths of points as chains of chords within a tolerance.

The distance of a path from its chord is measured at three angles inside the chord. It falls with
the square of the step: this gives the number of chords that one is divided into.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, divided

_BETWEEN: Final = 12
"""Chords between knots at first."""

_INSIDE: Final = np.array([0.25, 0.5, 0.75])
"""Shares of a chord at which the distance is measured."""

_MARGIN: Final = 0.9
"""Allowed measured distance, as a share of the tolerance: between the angles it may be larger."""

_MOST: Final = 1_000_000
"""Largest number of chords of a path."""


def path_within(
    place: Callable[[Array], Plane], knots: Array, tolerance: float
) -> tuple[Array, Plane]:
    """Return points of a path, no chord between them farther from it than a tolerance.

    Parameters
    ----------
    place : callable
        ``place(q)`` returns the point at angles (n,) of the master, complex, mm.
    knots : (k,) array, rad
        The master's angles from the first to the last one; between them the path is smooth.
    tolerance : float, mm
        Largest distance.

    Returns
    -------
    q : (n,) array, rad
        The master's angles, with both ends and all knots.
    points : (n,) complex array, mm

    Raises
    ------
    InfeasibleError
        If the tolerance needs too many chords.
    """
    parts = np.linspace(knots[:-1], knots[1:], _BETWEEN, endpoint=False)
    q = np.append(parts.T.ravel(), knots[-1])
    points = place(q)
    fresh = np.ones(len(q) - 1, dtype=bool)
    while fresh.any():
        (own,) = np.nonzero(fresh)
        counts = _counts(place, (q, points), own, _MARGIN * tolerance)
        if counts.sum() + len(q) > _MOST:
            raise InfeasibleError(
                f"a path would have more than {_MOST} chords",
                where="output.chord_tolerance_mm",
                value=tolerance,
                unit="mm",
                nearest="a larger one",
            )
        whole = np.ones(len(q) - 1, dtype=np.int64)
        whole[own] = counts
        q, points, fresh = _divided(place, q, points, whole)
    return q, points


def _counts(
    place: Callable[[Array], Plane], known: tuple[Array, Plane], own: Ints, allowed: float
) -> Ints:
    """Return into how many chords each of some chords is to be divided."""
    q, points = known
    inner = q[own] + np.outer(_INSIDE, np.diff(q)[own])
    found = place(inner.ravel()).reshape(inner.shape)
    off = distances(found, points[own], points[own + 1]).max(axis=0)
    return np.where(off > allowed, np.ceil(np.sqrt(off / allowed)), 1.0).astype(np.int64)


def distances(points: Plane, start: Plane, end: Plane) -> Array:
    """Return distances of points from chords.

    Parameters
    ----------
    points : (m, n) complex array, mm
        Points that belong to n chords.
    start, end : (n,) complex arrays, mm
        The ends of the chords.

    Returns
    -------
    (m, n) array, mm
    """
    chord = end - start
    square = np.abs(chord) ** 2
    share = ((points - start) * chord.conj()).real / np.where(square > 0.0, square, 1.0)
    return np.abs(points - start - np.clip(share, 0.0, 1.0) * chord)


def _divided(
    place: Callable[[Array], Plane], q: Array, points: Plane, counts: Ints
) -> tuple[Array, Plane, Mask]:
    """Return angles and points with chords divided, and which chords are new."""
    angles, known = divided(q, counts), np.append(0, np.cumsum(counts))
    moved, new = np.empty(len(angles), dtype=np.complex128), np.ones(len(angles), dtype=bool)
    moved[known], new[known] = points, False
    moved[new] = place(angles[new])
    return angles, moved, np.repeat(counts > 1, counts)
