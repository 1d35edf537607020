"""The paths of points as chains of chords within a tolerance.

The distance of a path from its chord is measured at three angles inside the chord. It falls with
the square of the step: this gives the number of chords that one is divided into.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import Array, Plane, divided

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
    q, counts = knots, np.full(len(knots) - 1, _BETWEEN)
    while counts.sum() <= _MOST:
        q = divided(q, counts)
        points = place(q)
        inner = q[:-1] + np.outer(_INSIDE, np.diff(q))
        seen = place(inner.ravel()).reshape(inner.shape)
        off = distances(seen, points[:-1], points[1:]).max(axis=0)
        counts = np.maximum(np.ceil(np.sqrt(off / (_MARGIN * tolerance))), 1.0).astype(np.int64)
        if counts.max() == 1:
            return q, points
    raise InfeasibleError(
        f"a path would have more than {_MOST} chords",
        where="output.chord_tolerance_mm",
        value=tolerance,
        unit="mm",
        nearest="a larger one",
    )


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
