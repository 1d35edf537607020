"""Lift programs of two opposite half turns: ``s(theta) + s(theta + pi)`` is constant.

A follower with two faces or rollers on opposite sides of the cam moves both by the same lift, one
up and one down, half a turn apart. The first half of the program therefore defines the second: it
begins where the first one ends, with the opposite velocities and accelerations.

Source: 000 section 3.1 (cams of constant breadth and diameter).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.laws.displacement import Deviation
from gearcam.laws.phases_of_lift import (
    TURN,
    TURN_MISS,
    DwellPhase,
    Phase,
    PlacedPhase,
    angles_of,
    levels,
)
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array, distinct
from gearcam.numeric.jets import Jet, Value
from gearcam.numeric.piecewise import Piece, extremes, piecewise

HALF: Final = 0.5 * TURN
"""Half a turn of the cam, rad."""


@dataclass(frozen=True)
class _Opposite(ShortRepr):
    """The lift half a turn after that of a `function`: a total less its value."""

    function: Callable[..., Jet]

    def __call__(self, x: Jet, total: Value, *parameters: Value) -> Jet:
        return total - self.function(x - HALF, *parameters)


def completed(half: Program) -> Program:
    """Return the program of the whole turn: a half and its opposite.

    Parameters
    ----------
    half : Program
        With knots from 0 to pi.

    Returns
    -------
    Program
        Of the whole turn.
    """
    total = half.lift.last
    opposite = [
        Piece(_Opposite(piece.function), parameters=(total, *piece.parameters))
        for piece in half.lift.pieces
    ]
    knots = np.append(half.knots, half.knots[1:] + HALF)
    knots[-1] = TURN
    opposites = {"rise": "return", "return": "rise", "dwell": "dwell"}
    later = (
        PlacedPhase(kind=opposites[phase.kind], start=phase.start + HALF, end=phase.end + HALF)
        for phase in half.stretches
    )
    lift = piecewise(knots, [*half.lift.pieces, *opposite])
    return replace(
        half,
        lift=lift,
        stretches=(*half.stretches, *later),
        cuts=distinct(knots, half.cuts, half.cuts[1:-1] + HALF),
    )


def miss(program: Program) -> Deviation:
    """Return the largest deviation of the second half turn from the opposite of the first.

    Parameters
    ----------
    program : Program
        Of a turn.

    Returns
    -------
    Deviation
        Deviation of ``s(theta) + s(theta + pi)`` from the sum of lowest and highest lift, mm or
        rad, and its angle in the second half, where the lift is too high by as much.
    """
    total = sum(program.range)

    def off(theta: Array) -> list[Array]:
        near, far = (program.derivatives(theta + shift, 1) for shift in (0.0, HALF))
        return [near[0] + far[0] - total, near[1] + far[1]]

    cuts = program.cuts
    within = np.append(cuts[cuts < HALF], cuts[cuts >= HALF] - HALF)
    places, values = extremes(off, distinct(within, [0.0, HALF]))
    worst = int(np.abs(values).argmax())
    return Deviation(theta=float(places[worst]) + HALF, value=float(values[worst]))


def agreeing(phases: Sequence[Phase]) -> tuple[Phase, ...]:
    """Return phases of half a turn that agree with the first half of a turn as far as possible.

    Parameters
    ----------
    phases : sequence of Phase
        Of a turn.

    Returns
    -------
    tuple of Phase
        Phases that end within the first half, then a dwell; if there is no lift yet, the next phase
        up to the half turn. Empty if the follower would not move.
    """
    angles = angles_of(phases)
    count = int(np.count_nonzero(np.cumsum(angles) <= HALF + TURN_MISS))
    kept = [
        replace(phase, angle=angle) for phase, angle in zip(phases[:count], angles, strict=False)
    ]
    lifted = bool(levels(kept)[-1])
    if lifted and isinstance(kept[-1], DwellPhase):
        kept.pop()
    left = HALF - sum(angles[: len(kept)])
    if left > TURN_MISS:
        last = DwellPhase(angle=left) if lifted else replace(phases[count], angle=left)
        kept.append(last)
    return tuple(kept) if levels(kept)[-1] else ()
