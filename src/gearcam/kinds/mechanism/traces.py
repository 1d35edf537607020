"""The paths of points as chains of chords within a tolerance, and at rising resolution.

The distance of a path from its chord is measured at three angles inside the chord. It falls with
the square of the step: this gives the number of chords that one is divided into.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import Array, Plane, divided
from gearcam.results.ladders import (
    CHORD_ORDER,
    ROUNDING,
    SHARES,
    Ladder,
    Ladders,
    tolerances_around,
)

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.result import MechanismResult

CHORDS: Final = 0.01
"""Chord tolerance of paths if the design has none, mm."""

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


def _path(result: MechanismResult) -> Ladder:
    """Return the distance of the path of the first point from its chords, over their tolerance."""
    path = next(iter(result.paths.values()), None)
    if path is None:
        raise InfeasibleError(
            "no point is asked for: there is no path",
            where="output.outputs",
            nearest="ask for a joint or a point that draws one",
        )

    def place(q: Array) -> Plane:
        return np.asarray(path.track(q, 0).c[0], dtype=np.complex128)

    def make(tolerance: float) -> tuple[Array, Plane]:
        return path_within(place, path.knots, tolerance)

    def measure(made: tuple[Array, Plane]) -> tuple[float, int]:
        q, points = made
        inner = place((q[:-1] + np.outer(SHARES, np.diff(q))).ravel()).reshape(len(SHARES), -1)
        return float(distances(inner, points[:-1], points[1:]).max()), len(q)

    own = result.design.output.chord_tolerance or CHORDS
    return Ladder(
        refined="chord tolerance, mm",
        measured="chords of the path",
        unit="mm",
        levels=tolerances_around(own),
        own=own,
        order=CHORD_ORDER,
        rounding=ROUNDING * path.length.value,
        make=make,
        measure=measure,
    )


LADDERS: Final[Ladders] = {"path": _path}
"""What `gearcam accuracy` can measure."""
