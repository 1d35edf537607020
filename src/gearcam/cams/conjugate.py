"""Conjugate cams: two discs on one shaft; one follower has a roller on each of them.

The first is a disc cam. The second roller is on the opposite side of the shaft: on a translating
follower at a fixed distance below the first, on an oscillating one on a second arm at a fixed angle
from the first. Its position is that of the first less the distance, or less the angle between the
arms: negative, and the formulas of a disc cam are valid for it unchanged, in the same frame:

==================== =====================================================
translating          ``s0 + s - Dist``
oscillating          ``Psi0 + s - gamma``
==================== =====================================================

The second cam is smallest at the highest lift, where its prime radius is defined.

Refused: as for disc cams, for either cam; a second roller on the shaft, arms across the line of
centres.

Depends on cam, disc, wall and mechanism.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

from gearcam.base.display import Brief
from gearcam.base.errors import InfeasibleError, Way
from gearcam.base.numerals import shown
from gearcam.cams.cam import Cam
from gearcam.cams.disc import demand_standing
from gearcam.cams.followers import swing
from gearcam.cams.mechanism import Mechanism
from gearcam.cams.wall import CHORD_TOLERANCE, Wall
from gearcam.laws.program import Program

_PRIME2 = "cam.prime_radius2_mm"
_DISTANCE = "follower.roller_distance_mm"
_ANGLE = "follower.arms_angle_deg"


@dataclass(frozen=True, kw_only=True)
class SecondRoller:
    """The second roller of a follower.

    Parameters
    ----------
    radius : float, mm
        Of the roller.
    arm : float, mm
        Of an oscillating follower.
    prime : float or None, mm
        From the axis to its centre at the highest lift; None if `apart` is given.
    apart : float or None, mm or rad
        Distance of the rollers of a translating follower, angle between the arms of an oscillating
        one, before preload.
    preload : float, mm
        Interference: the rollers of the follower are closer by it than the cams hold them; for an
        oscillating follower along the second roller's arc.
    """

    radius: float
    arm: float = 0.0
    prime: float | None = None
    apart: float | None = None
    preload: float = 0.0

    @property
    def squeeze(self) -> float:
        """The preload in the unit of `apart`, mm or rad."""
        return self.preload / self.arm if self.arm else self.preload


@dataclass(frozen=True, eq=False, kw_only=True)
class ConjugateCam(Brief, Cam):
    """Conjugate cams, in one frame.

    Parameters
    ----------
    first, second : Wall
        Their profiles; both have the follower's lift.
    roller : SecondRoller
        As given.
    """

    title = "conjugate cams"

    first: Wall
    second: Wall
    roller: SecondRoller

    @property
    def walls(self) -> tuple[Wall, ...]:
        """Both profiles; each has a motion of its own."""
        return self.first, self.second

    @property
    def apart(self) -> float:
        """Distance of the rollers, mm, or angle between the arms, rad: on the follower."""
        return self.first.mechanism.start - self.second.mechanism.start - self.roller.squeeze

    @cached_property
    def prime2(self) -> float:
        """From the axis to the second roller's centre at the highest lift, mm."""
        m = self.second.mechanism
        return m.follower.distance(m.start + self.second.program.range[1])


def make_conjugate(
    program: Program,
    mechanism: Mechanism,
    roller: SecondRoller,
    *,
    clockwise: bool = False,
    tolerance: float = CHORD_TOLERANCE,
) -> ConjugateCam:
    """Return conjugate cams, verified for all positions of their follower.

    Parameters
    ----------
    program : Program
        The lift.
    mechanism : Mechanism
        The follower on the first cam.
    roller : SecondRoller
        Its second roller.
    clockwise : bool
        Whether the cams turn clockwise.
    tolerance : float, mm
        Chord error of their contours.

    Returns
    -------
    ConjugateCam

    Raises
    ------
    InfeasibleError
        If a position is impossible.
    """
    demand_standing(program, mechanism)
    common = {"program": program, "clockwise": clockwise, "tolerance": tolerance}
    lowest, highest = (mechanism.start + lift for lift in program.range)
    place = _swinging if mechanism.oscillating else _sliding
    apart = highest + place(mechanism, roller, lowest, highest)
    other = replace(mechanism, start=mechanism.start - apart, radius=roller.radius, arm=roller.arm)

    def wall(own: Mechanism, key: str) -> Wall:
        return Wall(mechanism=own, key=key, called=f"profile of cam {key}", **common)

    return ConjugateCam(first=wall(mechanism, "1"), second=wall(other, "2"), roller=roller)


def _sliding(mechanism: Mechanism, roller: SecondRoller, _: float, highest: float) -> float:
    """Return the distance of the second roller below the axis at the highest lift, mm."""
    aside = abs(mechanism.offset)
    least = max(aside, roller.radius)
    if roller.prime is not None:
        if not roller.prime > least:
            raise _on_shaft(_PRIME2, roller.prime, least)
        return math.sqrt((roller.prime - aside) * (roller.prime + aside))
    below = (roller.apart or 0.0) + roller.squeeze - highest
    room = math.sqrt((least - aside) * (least + aside))
    if not below > room:
        raise _on_shaft(_DISTANCE, roller.apart or 0.0, highest + room - roller.squeeze)
    return below


def _on_shaft(key: str, value: float, limit: float) -> InfeasibleError:
    return InfeasibleError(
        "the second roller reaches the cam's axis at the highest lift",
        where=key,
        value=value,
        limit=limit,
        unit="mm",
        nearest="the value must exceed the limit",
        ways=(Way(near={key: limit}, far={key: limit + 2.0 * max(limit, value)}),),
    )


def _swinging(mechanism: Mechanism, roller: SecondRoller, lowest: float, highest: float) -> float:
    """Return the angle of the second arm from the line of centres at the highest lift, rad."""
    pivot, arm = mechanism.pivot, roller.arm
    near = max(abs(pivot - arm), roller.radius)
    if near >= pivot + arm:
        raise _out_of_place("follower.roller2_radius_mm", roller.radius, 0.0, pivot + arm, "mm")
    low, high = float(swing(pivot, arm, near)), math.pi - (highest - lowest)
    if roller.prime is not None:
        far = replace(mechanism, arm=arm).follower.distance(max(high, low))
        if not near < roller.prime < far:
            raise _out_of_place(_PRIME2, roller.prime, near, far, "mm")
        return float(swing(pivot, arm, roller.prime))
    below = (roller.apart or 0.0) + roller.squeeze - highest
    if not low < below < high:
        shift = highest - roller.squeeze
        given = (roller.apart or 0.0, low + shift, max(high, low) + shift)
        value, near, far = map(math.degrees, given)
        raise _out_of_place(_ANGLE, value, near, far, "deg")
    return below


def _out_of_place(key: str, value: float, near: float, far: float, unit: str) -> InfeasibleError:
    """Return the error for a second arm that is not across the axis at every lift."""
    ways: tuple[Way, ...] = ()
    nearest = "no value is possible: the arm swings too far"
    if near < far:
        ways = (Way(near={key: near if value <= near else far}, far={key: 0.5 * (near + far)}),)
        nearest = f"it must be between {shown(near)} and {shown(far)} {unit}"
    return InfeasibleError(
        "the second roller reaches the cam's axis, or its arm passes the line of centres",
        where=key,
        value=value,
        limit=near if value <= near else far,
        unit=unit,
        nearest=nearest,
        ways=ways,
    )
