"""Lift programs of two opposite half turns: ``s(theta) + s(theta + pi)`` is the same all around.

What holds a cam between two faces or rollers moves both by the same lift, one up, one down, half a
turn apart. Half the program decides the other half, which begins where the first one ends and takes
its velocities and accelerations with changed signs.

Source: 000 section 3.1 (cams of constant breadth and diameter).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gearcam.display import Brief
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
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet, Value
from gearcam.numeric.piecewise import Piece, extremes, piecewise

HALF: Final = 0.5 * TURN
"""Half a turn of the cam, rad."""

_TURNED: Final = {"rise": "return", "return": "rise", "dwell": "dwell"}
"""What the opposite of a phase is."""


@dataclass(frozen=True)
class _Opposite(Brief):
    """What follows half a turn after a `function`: a sum less its value then."""

    function: Callable[..., Jet]

    def __call__(self, x: Jet, total: Value, *parameters: Value) -> Jet:
        return total - self.function(x - HALF, *parameters)


def completed(half: Program) -> Program:
    """Return the program that a half and its opposite make.

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
    later = (
        PlacedPhase(kind=_TURNED[one.kind], start=one.start + HALF, end=one.end + HALF)
        for one in half.stretches
    )
    lift = piecewise(knots, [*half.lift.pieces, *opposite])
    return replace(
        half,
        lift=lift,
        stretches=(*half.stretches, *later),
        cuts=np.union1d(knots, np.append(half.cuts, half.cuts[1:-1] + HALF)),
    )


def miss(program: Program) -> Deviation:
    """Return how far two half turns of a program are from being opposite, at worst.

    Parameters
    ----------
    program : Program
        Of a turn.

    Returns
    -------
    Deviation
        Of ``s(theta) + s(theta + pi)`` from the lowest and the highest lift together, mm or rad,
        with its angle in the second half: the lift there is too high by that.
    """
    total = sum(program.range)

    def off(theta: Array) -> list[Array]:
        near, far = (program.derivatives(theta + shift, 1) for shift in (0.0, HALF))
        return [near[0] + far[0] - total, near[1] + far[1]]

    cuts = program.cuts
    within = np.append(cuts[cuts < HALF], cuts[cuts >= HALF] - HALF)
    places, values = extremes(off, np.union1d([0.0, HALF], within))
    worst = int(np.abs(values).argmax())
    return Deviation(theta=float(places[worst]) + HALF, value=float(values[worst]))


def agreeing(phases: Sequence[Phase]) -> tuple[Phase, ...]:
    """Return phases of half a turn that agree with those of a turn for as long as they can.

    Parameters
    ----------
    phases : sequence of Phase
        Of a turn.

    Returns
    -------
    tuple of Phase
        Those that end within the first half; then the lift stays, or, where there is none yet, the
        next phase ends with the half turn. Empty where nothing then moves.
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
