"""Phases of a lift program: rises, dwells, returns and segments of a turn of the cam.

The *lift* is a length for translating followers and an angle for oscillating ones (``lift_mm``,
``lift_deg``). A phase covers an angle of a cam that turns or a length, its *travel*, of one that
slides (``angle_deg``, ``travel_mm``). A *rise* goes up by its lift with a motion law, a *return*
comes down with one (to lift zero if no lift is given), in a *dwell* the follower rests, and a
*segment* goes from the end state of the phase before it to a given lift, velocity and acceleration,
so that phases join without a dwell. The angle of one phase may be ``"rest"``: the remainder of the
turn. For some cams the phases may fill *half a turn*; the second half is then the opposite of the
first.

Refused when the design is read: phases that do not fill a turn, a rest without an angle, programs
that end at another lift than they begin with. The program of a cam that slides is *open*: its
phases may have any total travel.

Depends on quantities only.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.quantities import (
    ANGLE,
    ANGLE_PER_RAD,
    ANGLE_PER_RAD2,
    LENGTH,
    LENGTH_PER_RAD,
    LENGTH_PER_RAD2,
    LONGEST,
    NARROWEST_DEG,
    Param,
    Quantity,
    param,
)

TURN_MISS: Final = 1e-6
"""Largest error of the sum of the angles, rad, that is spread over the phases: typed digits."""

_LIFT_MISS: Final = 1e-9
"""Largest error of the lift after a turn over the largest lift: rounding."""

Problem = tuple[int | None, str, str, str]
"""Number of the phase, field, message, allowed values."""

TURN: Final = 2.0 * math.pi
"""A turn of the cam, rad."""

_SPAN: Final[dict[str, Any]] = {
    "ge": NARROWEST_DEG,
    "le": 360,
    "example": 60,
    "doc": "cam angle of the phase, or the rest of the turn",
    "when": ("turning",),
    "other": Param(
        LENGTH, word="travel", gt=0, le=LONGEST, example=60, doc="travel of a translating cam"
    ),
}
"""Parameter for the angle, or the travel, of a phase."""


@dataclass(frozen=True, kw_only=True)
class DwellPhase:
    """The follower rests at its lift.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.DwellPhase(angle="rest")
    DwellPhase(angle='rest')
    """

    angle: float | Literal["rest"] = param(ANGLE, **_SPAN)


@dataclass(frozen=True, kw_only=True)
class RisePhase(ShortRepr):
    """The follower rises with a motion law.

    Parameters
    ----------
    law : object
        Parameters of a motion law, such as `gearcam.motion_laws.Cycloidal`.
    angle : float or "rest"
        Cam angle, rad; of a cam that slides its travel, mm.
    lift : float or None
        In mm, or in rad if the follower oscillates.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.RisePhase(angle=2.0, law=gc.motion_laws.Cycloidal(), lift=10.0)
    RisePhase(angle=2, lift=10, law=Cycloidal)
    """

    angle: float | Literal["rest"] = param(ANGLE, **_SPAN)
    law: Any
    lift: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LONGEST,
        example=10,
        doc="lift of the phase (translating follower)",
        when=("translating",),
        other=Param(
            ANGLE, gt=0, lt=180, example=20, doc="lift of the phase (oscillating follower)"
        ),
    )


@dataclass(frozen=True, kw_only=True)
class ReturnPhase(RisePhase):
    """The follower comes down with a motion law, to lift zero if no lift is given.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.ReturnPhase(angle=2.0, law=gc.motion_laws.Polynomial345())
    ReturnPhase(angle=2, law=Polynomial345)
    """


def _rate(
    length: Quantity, angle: Quantity, word: str, sign: str, examples: tuple[float, float]
) -> Any:
    said: Any = {"word": f"end_{word}", "doc": f"{sign} at its end; 0 if left out"}
    # segments of a cam that slides end at rest
    angular, when = Param(angle, example=examples[1], **said), ("translating", "turning")
    return param(length, default=None, example=examples[0], when=when, other=angular, **said)


@dataclass(frozen=True, kw_only=True)
class SegmentPhase(ShortRepr):
    """The follower goes to a lift, with given velocity and acceleration at its end.

    In mm, mm/rad and mm/rad^2, or, if the follower oscillates, in rad, rad/rad and rad/rad^2.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.SegmentPhase(angle=1.0, to=4.0, velocity=-2.0)
    SegmentPhase(angle=1, to=4, velocity=-2)
    """

    angle: float | Literal["rest"] = param(ANGLE, **_SPAN)
    to: float | None = param(
        LENGTH,
        default=None,
        ge=-LONGEST,
        le=LONGEST,
        example=4,
        doc="lift at its end (translating follower)",
        when=("translating",),
        other=Param(
            ANGLE, gt=-180, lt=180, example=8, doc="lift at its end (oscillating follower)"
        ),
    )
    velocity: float | None = _rate(LENGTH_PER_RAD, ANGLE_PER_RAD, "velocity", "ds/dtheta", (5, 10))
    acceleration: float | None = _rate(
        LENGTH_PER_RAD2, ANGLE_PER_RAD2, "acceleration", "d2s/dtheta2", (0, 0)
    )

    @property
    def end(self) -> tuple[float, float, float]:
        """Lift, velocity and acceleration at its end, mm or rad, per rad and per rad^2."""
        return self.to or 0.0, self.velocity or 0.0, self.acceleration or 0.0


Phase = DwellPhase | RisePhase | ReturnPhase | SegmentPhase

PHASES: Final[dict[str, type]] = {
    "rise": RisePhase,
    "dwell": DwellPhase,
    "return": ReturnPhase,
    "segment": SegmentPhase,
}
"""The phases, by their names in files."""


def angles_of(phases: Sequence[Phase], turn: float = TURN) -> list[float]:
    """Return the cam angle of each phase, rad; ``"rest"`` is replaced by the remainder.

    Parameters
    ----------
    phases : sequence of Phase
        Phases of a turn, or half of it; at most one has the angle ``"rest"``.
    turn : float, rad
        Total angle.

    Returns
    -------
    list of float
        The remainder is 0 or less if the other phases leave nothing.
    """
    rest = turn - math.fsum(phase.angle for phase in phases if phase.angle != "rest")
    return [rest if phase.angle == "rest" else phase.angle for phase in phases]


@dataclass(frozen=True, kw_only=True)
class PlacedPhase:
    """A phase with its `kind` (rise, return or dwell), `start` and `end` in rad."""

    kind: str
    start: float
    end: float


def levels(phases: Sequence[Phase]) -> list[float]:
    """Return the lift at the start of each phase and at the end of the last, mm or rad.

    Parameters
    ----------
    phases : sequence of Phase
        Of a turn.

    Returns
    -------
    list of float
        The first is 0.
    """
    lifts = [0.0]
    for phase in phases:
        match phase:
            case DwellPhase():
                lifts.append(lifts[-1])
            case SegmentPhase():
                lifts.append(phase.end[0])
            case ReturnPhase():
                lifts.append(0.0 if phase.lift is None else lifts[-1] - phase.lift)
            case RisePhase():
                lifts.append(lifts[-1] + (phase.lift or 0.0))
    return lifts


def fill_half(phases: Sequence[Phase]) -> bool:
    """Return whether phases are meant to fill half a turn, by their angles or their lift.

    Parameters
    ----------
    phases : sequence of Phase
        If they fill neither half a turn nor a whole one, or one of them takes the rest, they are
        taken as half a turn if they do not return to the first lift.
    """
    angles = [phase.angle for phase in phases if phase.angle != "rest"]
    if len(angles) == len(phases):
        for turn in (0.5 * TURN, TURN):
            if abs(math.fsum(angles) - turn) <= TURN_MISS:
                return turn < TURN
    lifts = levels(phases)
    return abs(lifts[-1]) > _LIFT_MISS * max(map(abs, lifts))


def program_problems(
    phases: Sequence[Phase], *, oscillating: bool, closed: bool = True, half: bool = False
) -> Iterator[Problem]:
    """Yield the faults of a program.

    Parameters
    ----------
    phases : sequence of Phase
        Of a turn, or half of it.
    oscillating : bool
        Whether lifts are angles.
    closed : bool
        Whether they fill a turn and end at the first lift.
    half : bool
        Whether they fill half a turn.

    Yields
    ------
    tuple
        Number of the phase (None for the program), field, message, allowed.
    """
    unit = "deg" if oscillating else "mm"
    clean = True
    for number, phase in enumerate(phases):
        required = {RisePhase: "lift", SegmentPhase: "to"}.get(type(phase))
        if required and getattr(phase, required) is None:
            clean = False
            yield number, required, "is missing", f"a lift in {unit}"
    if clean:
        if closed:
            yield from _turn_problems(phases, 0.5 * TURN if half else TURN)
        else:
            yield from _travel_problems(phases)
        yield from _closure_problems(phases, unit, closed=closed, half=half)


def _turn_problems(phases: Sequence[Phase], turn: float) -> Iterator[Problem]:
    angles, whole = angles_of(phases, turn), formatted(math.degrees(turn))
    miss = turn - sum(angles)
    rests = [number for number, phase in enumerate(phases) if phase.angle == "rest"]
    for number in rests[1:]:
        rule = f"an angle: motion[{rests[0]}] already takes the rest"
        yield number, "angle", "only one phase can take the rest", rule
    if rests:
        left = angles[rests[0]]
        if left <= TURN_MISS:
            others = formatted(math.degrees(turn - left), 10)
            message = f"the other phases take {others} deg, which leaves nothing"
            yield rests[0], "angle", message, f"less than {whole} deg in the others"
    elif abs(miss) > TURN_MISS:
        last = math.degrees(miss + angles[-1])
        hint = f"; the last phase would take {formatted(last, 10)} deg" if last > 0 else ""
        message = f"the phases take {formatted(math.degrees(turn - miss), 10)} deg"
        yield None, "", message, f'{whole} deg in all, or "rest" for one of them{hint}'


def _travel_problems(phases: Sequence[Phase]) -> Iterator[Problem]:
    spans = {k: phase.angle for k, phase in enumerate(phases) if phase.angle != "rest"}
    for number in range(len(phases)):
        if number not in spans:
            message = "a cam that slides has no whole turn, and so no rest of it"
            yield number, "angle", message, "a length above 0"
    whole = sum(spans.values())
    least = whole * 1e-6
    for number, span in spans.items():
        if span < least:
            rule = f"at least {formatted(least)} mm of {formatted(whole)} mm"
            yield number, "angle", "the phase is too short: it would be a jump", rule


def _closure_problems(
    phases: Sequence[Phase], unit: str, *, closed: bool, half: bool
) -> Iterator[Problem]:
    lifts = levels(phases)
    for number, phase in enumerate(phases):
        if isinstance(phase, ReturnPhase) and phase.lift is None and not lifts[number] > 0.0:
            message = "the follower is at lift 0 or below: nothing to return from"
            yield number, "lift", message, "a rise before it, or a given lift"
    largest = max(map(abs, lifts))
    if largest == 0.0:
        yield None, "", "the follower never moves", "at least one rise"
    elif half:
        if abs(lifts[-1]) <= _LIFT_MISS * largest:
            rule = "another lift at its end, or phases of a whole turn, 360 deg"
            yield None, "", "the half turn ends at the lift with which it begins", rule
    elif closed and abs(lifts[-1]) > _LIFT_MISS * largest:
        end = math.degrees(lifts[-1]) if unit == "deg" else lifts[-1]
        rule = "the lift 0, as at the start of the turn"
        yield None, "", f"the program ends at a lift of {formatted(end, 10)} {unit}", rule
