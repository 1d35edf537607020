"""A disc cam: one wall, inside the pitch curve (see `wall`).

A *yoke cam* is a disc between two flat faces, or two rollers, of one follower. Both touch it at
every angle if lifts half a turn apart have a constant sum (see `gearcam.laws.half_turns`): then the
cam has a constant *breadth* between faces, or its pitch curve a constant *diameter* through the
axis, the distance of the rollers. It touches the second face half a turn later.

Refused: lifts that bring the follower onto the cam's axis or its arm over the line of centres,
flat followers that swing down faster than the cam turns.

Depends on cam, wall and mechanism.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import rounded_down
from gearcam.cams.cam import Cam
from gearcam.cams.followers import swing
from gearcam.cams.mechanism import Mechanism
from gearcam.cams.wall import CHORD_TOLERANCE, Wall
from gearcam.laws.program import Program

_STANDSTILL = 1e-7
"""Least relative difference of a face's downward speed from the cam's: below it the contact is a
million pivot distances away, or stays at one point."""


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
        radius, back = self.face_radius, (one.after < one.before for one in self.program.hard)
        if radius is None or self.mechanism.oscillating or any(back):
            return None
        return self.mechanism.start - radius.low.value


@dataclass(frozen=True, eq=False, kw_only=True)
class YokeCam(DiscCam):
    """A disc cam whose follower encloses it (see the module)."""

    @property
    def breadth(self) -> float:
        """Distance of both faces, or of the rollers' centres, mm."""
        return 2.0 * self.mechanism.start + sum(self.program.range)

    @property
    def face_width(self) -> float | None:
        """Least width of a flat face, mm, without margin: twice the contact's largest offset."""
        place = self.contact_place
        return None if place is None else 2.0 * place.largest


def make_cam(
    program: Program,
    mechanism: Mechanism,
    *,
    clockwise: bool = False,
    tolerance: float = CHORD_TOLERANCE,
) -> DiscCam:
    """Return a disc cam, verified for all positions of its follower.

    Parameters
    ----------
    program : Program
        The lift.
    mechanism : Mechanism
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
    demand_standing(program, mechanism)
    return DiscCam(program=program, mechanism=mechanism, clockwise=clockwise, tolerance=tolerance)


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
        mechanism=cam.mechanism,
        clockwise=cam.clockwise,
        tolerance=cam.tolerance,
    )


def demand_standing(program: Program, mechanism: Mechanism) -> None:
    """Refuse a follower with an impossible position.

    Parameters
    ----------
    program : Program
        The lift.
    mechanism : Mechanism
        The follower.

    Raises
    ------
    InfeasibleError
        If a position is impossible.
    """
    low, high = program.range
    if mechanism.oscillating:
        _demand_swing(program, mechanism, mechanism.start + low, mechanism.start + high)
    if not clears_axis(program, mechanism):
        scale, unit = mechanism.outward
        raise InfeasibleError(
            "the lowest lift brings the follower onto the cam's axis",
            where="motion",
            value=scale * low,
            limit=scale * (_on_axis(mechanism) - mechanism.start),
            unit=unit,
            nearest="the lowest lift must be above the limit",
        )


def clears_axis(program: Program, mechanism: Mechanism) -> bool:
    """Return whether a follower clears the cam's axis at the lowest lift.

    Parameters
    ----------
    program : Program
        The lift.
    mechanism : Mechanism
        The follower.
    """
    low = mechanism.start + program.range[0]
    clear = mechanism.follower.distance(low) > mechanism.radius
    return clear and (mechanism.oscillating or low > 0.0)


def _on_axis(mechanism: Mechanism) -> float:
    """Return the position, mm or rad, at which a follower touches the cam's axis."""
    m = mechanism
    if not m.oscillating:
        return math.sqrt(max((m.radius - m.offset) * (m.radius + m.offset), 0.0))
    if m.flat:
        return math.asin(max(m.face_offset / m.pivot, -1.0))
    return float(swing(m.pivot, m.arm, max(m.radius, abs(m.pivot - m.arm))))


def _demand_swing(program: Program, mechanism: Mechanism, low: float, high: float) -> None:
    """Refuse an arm that passes the line of centres, and a face that loses its contact."""
    least, most = (-0.5 * math.pi, 0.5 * math.pi) if mechanism.flat else (0.0, math.pi)
    if not (low > least and high < most):
        what = "is perpendicular to" if mechanism.flat else "passes"
        raise InfeasibleError(
            f"the arm swings too far: it {what} the line of centres",
            where="motion",
            value=math.degrees((low if low <= least else high) - mechanism.start),
            limit=math.degrees((least if low <= least else most) - mechanism.start),
            unit="deg",
            nearest="value and limit are lifts; stay within the limit",
        )
    if mechanism.flat and not (slowest := program.range_of(1)[0]) > -1.0 + _STANDSTILL:
        raise InfeasibleError(
            "the face swings down faster than the cam turns: no profile can support it",
            where="motion",
            value=slowest,
            limit=-1.0,
            nearest="value and limit are rad of swing per rad of the cam; lifts of less than "
            f"{rounded_down(-100.0 * (1.0 - 2.0 * _STANDSTILL) / slowest, 4)} % of these work",
        )
