"""A disc cam: one wall, inside the pitch curve (see `wall`).

A *yoke cam* is a disc between two flat faces, or two rollers, of one follower. Both touch it at
every angle if lifts half a turn apart have a constant sum (see `gearcam.laws.half_turns`): then the
cam has a constant *breadth* between faces, or its pitch curve a constant *diameter* through the
axis, the distance of the rollers. It touches the second face half a turn later.

Refused: lifts that bring the follower onto the cam's axis, or to positions that it cannot take.

Depends on cam, followers and wall.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.base.errors import beyond_limit
from gearcam.cams.cam import Cam
from gearcam.cams.followers import Follower
from gearcam.cams.touch import WallTouch
from gearcam.cams.wall import CHORD_TOLERANCE, Wall
from gearcam.laws.program import Program


@dataclass(frozen=True, eq=False, kw_only=True)
class DiscCam(Wall, Cam):
    """A disc cam, which is also its only wall (see `gearcam.cams.wall.PitchMotion`)."""

    title = "disc cam"

    @property
    def walls(self) -> tuple[Wall, ...]:
        """The walls to be cut: the disc cam itself, its only profile."""
        return (self,)

    @property
    def least_base_radius(self) -> float | None:
        """Least base radius, mm, that is not undercut below a translating flat face."""
        radius, jumps = self.face_radius, self.program.hard
        back = any(jump.after < jump.before and not jump.slight for jump in jumps)
        if radius is None or self.follower.angular or back:
            return None
        return self.follower.start - radius.low.value


@dataclass(frozen=True, eq=False, kw_only=True)
class YokeCam(DiscCam):
    """A disc cam whose follower encloses it (see the module)."""

    @property
    def touches(self) -> tuple[WallTouch, ...]:
        """On both sides of the axis (see `Cam.touches`)."""
        first, second = (
            WallTouch(wall=self, end=self.follower, key=key, across=across)
            for key, across in (("near", 0.0), ("far", math.pi))
        )
        return first, second

    @property
    def breadth(self) -> float:
        """Distance of both faces, or of the rollers' centres, mm."""
        return 2.0 * self.follower.start + sum(self.program.range)

    @property
    def face_width(self) -> float | None:
        """Least width of a flat face, mm, without margin: twice the contact's largest offset."""
        place = self.contact_place
        return None if place is None else 2.0 * place.largest


def make_cam(
    program: Program,
    follower: Follower,
    *,
    clockwise: bool = False,
    tolerance: float = CHORD_TOLERANCE,
) -> DiscCam:
    """Return a disc cam, verified for all positions of its follower.

    Parameters
    ----------
    program : Program
        The lift.
    follower : Follower
        The follower.
    clockwise : bool
        Whether the cam turns clockwise.
    tolerance : float, mm
        Chord error of its contours.

    Returns
    -------
    DiscCam

    Raises
    ------
    InfeasibleError
        If a position is impossible.
    """
    demand_standing(program, follower)
    return DiscCam(program=program, follower=follower, clockwise=clockwise, tolerance=tolerance)


def make_yoke(cam: DiscCam) -> YokeCam:
    """Return a yoke cam from a disc cam.

    Parameters
    ----------
    cam : DiscCam
        With a lift of two opposite half turns, and a translating follower without offset.

    Returns
    -------
    YokeCam
    """
    return YokeCam(
        program=cam.program,
        follower=cam.follower,
        clockwise=cam.clockwise,
        tolerance=cam.tolerance,
    )


def demand_standing(program: Program, follower: Follower) -> None:
    """Refuse a follower with an impossible position on a cam that turns.

    Parameters
    ----------
    program : Program
        The lift.
    follower : Follower
        The follower.

    Raises
    ------
    InfeasibleError
        If a position is impossible.
    """
    follower.demand(program)
    if not clears_axis(program, follower):
        (scale, unit), low = follower.lift_unit, program.range[0]
        what = "the lowest lift brings the follower onto the cam's axis"
        limit, rule = follower.on_axis - follower.start, "the lowest lift must be above the limit"
        raise beyond_limit(what, "motion", scale * low, scale * limit, rule, unit=unit)


def clears_axis(program: Program, follower: Follower) -> bool:
    """Return whether a follower clears the cam's axis at the lowest lift.

    Parameters
    ----------
    program : Program
        The lift.
    follower : Follower
        The follower.
    """
    return follower.start + program.range[0] > follower.on_axis
