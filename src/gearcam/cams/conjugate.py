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

Depends on cam, disc, followers and wall.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.cams.cam import Cam
from gearcam.cams.disc import demand_standing
from gearcam.cams.followers import Round
from gearcam.cams.wall import CHORD_TOLERANCE, Wall
from gearcam.laws.program import Program

_PRIME2 = "cam.prime_radius2_mm"


@dataclass(frozen=True, kw_only=True)
class SecondRoller:
    """The second roller of a follower.

    Parameters
    ----------
    radius : float, mm
        Of the roller.
    arm : float, mm
        Of an oscillating follower; 0 if that of the first.
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


@dataclass(frozen=True, eq=False, kw_only=True)
class ConjugateCam(ShortRepr, Cam):
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

    def linked(self, wall: Wall) -> dict[str, float]:
        """Return 1 for the distance of the rollers, or the angle between the arms."""
        name = "arms_angle" if self.first.follower.angular else "roller_distance"
        return {name: 1.0} if wall is self.second else {}

    @property
    def apart(self) -> float:
        """Distance of the rollers, mm, or angle between the arms, rad: on the follower."""
        squeeze = self.roller.preload / self.second.follower.lever
        return self.first.follower.start - self.second.follower.start - squeeze

    @cached_property
    def prime2(self) -> float:
        """From the axis to the second roller's centre at the highest lift, mm."""
        follower = self.second.follower
        return follower.distance(follower.start + self.second.program.range[1])


def make_conjugate(
    program: Program,
    follower: Round,
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
    follower : Round
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
    demand_standing(program, follower)
    common = {"program": program, "clockwise": clockwise, "tolerance": tolerance}
    second = follower.with_end(roller.radius, roller.arm)
    across = _across(follower, second, roller, program.range)
    second = replace(second, start=-across - program.range[1])

    def wall(touching: Round, key: str) -> Wall:
        return Wall(follower=touching, key=key, called=f"profile of cam {key}", **common)

    return ConjugateCam(first=wall(follower, "1"), second=wall(second, "2"), roller=roller)


def _across(first: Round, second: Round, given: SecondRoller, lifts: tuple[float, float]) -> float:
    """Return the position of the second roller at the highest lift, across the axis, mm or rad."""
    low, high = lifts
    near = max(second.nearest, second.radius)
    if near >= second.farthest:
        raise _out_of_place("follower.roller2_radius_mm", second.radius, 0.0, second.farthest)
    least, most = float(second.on_circle(near)), second.highest - (high - low)
    if given.prime is not None:
        far = second.distance(max(most, least))
        if not near < given.prime < far:
            raise _out_of_place(_PRIME2, given.prime, near, far)
        return float(second.on_circle(given.prime))
    shift = first.start + high - given.preload / second.lever
    across = (given.apart or 0.0) - shift
    if not least < across < most:
        (scale, unit), apart = first.lift_unit, given.apart or 0.0
        key = f"follower.{'arms_angle' if first.angular else 'roller_distance'}_{unit}"
        limits = least + shift, max(most, least) + shift
        raise _out_of_place(key, scale * apart, *(scale * limit for limit in limits))
    return across


def _out_of_place(key: str, value: float, near: float, far: float) -> InfeasibleError:
    """Return the error for a second roller that is not across the axis at every lift."""
    what = "the second roller reaches the cam's axis at the highest lift"
    if math.isinf(far):
        rule, change = "the value must exceed the limit", near + 2.0 * max(near, value)
        return beyond_limit(what, key, value, near, rule, far=change)
    what = "the second roller reaches the cam's axis, or its arm passes the line of centres"
    limit = near if value <= near else far
    if not near < far:
        rule = "no value is possible: the arm swings too far"
        return beyond_limit(what, key, value, limit, rule)
    rule = f"it must be between {formatted(near)} and {formatted(far)} {key.rpartition('_')[2]}"
    return beyond_limit(what, key, value, limit, rule, far=0.5 * (near + far))
