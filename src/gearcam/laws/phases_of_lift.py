"""Phases of a lift program: what a design says of each stretch of a cam's turn.

The *lift* is a length for translating followers and an angle for oscillating ones; a file gives the
one or the other (``lift_mm``, ``lift_deg``). A *rise* goes up by its lift after a law on the unit
square, a *return* comes down after one (by all that was risen, if it gives no lift), a *dwell*
stands still, and a *segment* goes from the state in which the phase before it ends to a lift with
a velocity and an acceleration, so that phases join without a dwell.

Refused by reading: phases that do not fill a turn, programs that end at another lift than they
begin with, lifts of the wrong kind.

Depends on quantities only.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

from gearcam.display import Brief
from gearcam.numerals import shown
from gearcam.quantities import (
    ANGLE,
    ANGLE_PER_RAD,
    ANGLE_PER_RAD2,
    LENGTH,
    LENGTH_PER_RAD,
    LENGTH_PER_RAD2,
    Quantity,
    param,
)

TURN_MISS: Final = 1e-6
"""Largest miss of the phases' sum from a turn that is spread over them, rad: typed digits."""

_LIFT_MISS: Final = 1e-9
"""Largest miss of the lift after a turn, in largest lifts: rounding."""

Problem = tuple[int | None, str, str, str]
"""Number of the phase, field, what is wrong, what is allowed."""


@dataclass(frozen=True, kw_only=True)
class DwellPhase:
    """The follower stands still."""

    angle: float = param(ANGLE, gt=0, le=360, doc="cam angle that it takes")


@dataclass(frozen=True, kw_only=True)
class RisePhase(Brief):
    """The follower rises by a law.

    The law's parameters stand in `shape`, made by its entry in `gearcam.laws.rises.base.RISES`.
    """

    angle: float = param(ANGLE, gt=0, le=360, doc="cam angle that it takes")
    law: str
    shape: Any
    length: float | None = param(
        LENGTH, default=None, gt=0, le=1e6, word="lift", doc="how far (translating follower)"
    )
    swing: float | None = param(
        ANGLE, default=None, gt=0, lt=180, word="lift", doc="how far (oscillating follower)"
    )

    @property
    def lift(self) -> float | None:
        """How far, mm or rad; None where the file does not say."""
        return self.length if self.length is not None else self.swing


@dataclass(frozen=True, kw_only=True)
class ReturnPhase(RisePhase):
    """The follower comes down by a law, to lift zero where no lift is given."""


def _rate(quantity: Quantity, word: str, sign: str) -> Any:
    doc = f"{sign} at its end; 0 if left out"
    return param(quantity, default=None, word=f"end_{word}", doc=doc)


@dataclass(frozen=True, kw_only=True)
class SegmentPhase(Brief):
    """The follower goes to a lift and has a velocity and an acceleration there.

    These are `velocity_length` and `acceleration_length` of a translating follower,
    `velocity_swing` and `acceleration_swing` of an oscillating one.
    """

    angle: float = param(ANGLE, gt=0, le=360, doc="cam angle that it takes")
    to_length: float | None = param(
        LENGTH, default=None, ge=-1e6, le=1e6, word="to", doc="lift at its end (translating)"
    )
    to_swing: float | None = param(
        ANGLE, default=None, gt=-180, lt=180, word="to", doc="lift at its end (oscillating)"
    )
    velocity_length: float | None = _rate(LENGTH_PER_RAD, "velocity", "ds/dtheta")
    velocity_swing: float | None = _rate(ANGLE_PER_RAD, "velocity", "ds/dtheta")
    acceleration_length: float | None = _rate(LENGTH_PER_RAD2, "acceleration", "d2s/dtheta2")
    acceleration_swing: float | None = _rate(ANGLE_PER_RAD2, "acceleration", "d2s/dtheta2")

    @property
    def end(self) -> tuple[float, float, float]:
        """Lift, velocity and acceleration at its end, mm or rad, per rad and per rad^2."""
        return (
            (self.to_length or 0.0) + (self.to_swing or 0.0),
            (self.velocity_length or 0.0) + (self.velocity_swing or 0.0),
            (self.acceleration_length or 0.0) + (self.acceleration_swing or 0.0),
        )


Phase = DwellPhase | RisePhase | ReturnPhase | SegmentPhase

PHASES: Final[dict[str, type]] = {
    "rise": RisePhase,
    "dwell": DwellPhase,
    "return": ReturnPhase,
    "segment": SegmentPhase,
}
"""The phases, by their names in files."""

_OF_LENGTH: Final = ("length", "to_length", "velocity_length", "acceleration_length")
_OF_SWING: Final = ("swing", "to_swing", "velocity_swing", "acceleration_swing")


def levels(phases: Sequence[Phase]) -> list[float]:
    """Return the lift at the beginning of each phase and at the end of the last, mm or rad.

    Parameters
    ----------
    phases : sequence of Phase
        Of a turn.

    Returns
    -------
    list of float
        Beginning with 0.
    """
    found = [0.0]
    for phase in phases:
        match phase:
            case DwellPhase():
                found.append(found[-1])
            case SegmentPhase():
                found.append(phase.end[0])
            case ReturnPhase():
                found.append(0.0 if phase.lift is None else found[-1] - phase.lift)
            case RisePhase():
                found.append(found[-1] + (phase.lift or 0.0))
    return found


def program_problems(phases: Sequence[Phase], *, oscillating: bool) -> Iterator[Problem]:
    """Yield what is wrong with a program by reading.

    Parameters
    ----------
    phases : sequence of Phase
        Of a turn.
    oscillating : bool
        Whether lifts are angles.

    Yields
    ------
    tuple
        Number of the phase (None for the program), field, message, allowed.
    """
    wrong = _OF_LENGTH if oscillating else _OF_SWING
    right = _OF_SWING if oscillating else _OF_LENGTH
    kind, unit = ("an oscillating", "_deg") if oscillating else ("a translating", "_mm")
    clean = True
    for number, phase in enumerate(phases):
        for name in wrong:
            if getattr(phase, name, None) is not None:
                clean = False
                message = f"is of the wrong kind for {kind} follower"
                yield number, name, message, f"the key in {unit}"
        asked = {SegmentPhase: right[1], RisePhase: right[0]}.get(type(phase))
        if asked and getattr(phase, asked) is None:
            clean = False
            yield number, asked, "is missing", f"a lift in {unit.lstrip('_')}"
    if clean:
        yield from _closure_problems(phases, right[0])


def _closure_problems(phases: Sequence[Phase], lift: str) -> Iterator[Problem]:
    total = sum(phase.angle for phase in phases)
    if abs(total - 2.0 * math.pi) > TURN_MISS:
        last = math.degrees(2.0 * math.pi - total + phases[-1].angle)
        hint = f"; the last phase would take {shown(last, 10)} deg" if last > 0 else ""
        message = f"the phases take {shown(math.degrees(total), 10)} deg"
        yield None, "", message, f"360 deg in all{hint}"
    found = levels(phases)
    for number, phase in enumerate(phases):
        if isinstance(phase, ReturnPhase) and phase.lift is None and not found[number] > 0.0:
            yield number, lift, "there is no lift to return from", "a rise before it, or a lift"
    largest = max(map(abs, found))
    if largest == 0.0:
        yield None, "", "the follower never moves", "at least one rise"
    elif abs(found[-1]) > _LIFT_MISS * largest:
        end, unit = (found[-1], "mm") if lift == "length" else (math.degrees(found[-1]), "deg")
        rule = "the lift at the end of the turn is that at its beginning, 0"
        yield None, "", f"the program ends at a lift of {shown(end, 10)} {unit}", rule
