"""The paths of a mechanism at rising resolution (see `gearcam.results.ladders`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.kinds.mechanism.drawn import CHORDS
from gearcam.kinds.mechanism.traces import distances, path_within
from gearcam.results.ladders import (
    CHORD_ORDER,
    ROUNDING,
    SHARES,
    Ladder,
    Ladders,
    tolerances_around,
)

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult
    from gearcam.numeric.arrays import Array, Plane


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
