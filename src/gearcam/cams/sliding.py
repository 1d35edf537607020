"""A translating cam: a plate that slides past its follower, with one wall or with a groove.

The rotation of a disc cam is a translation here (see `mechanism`). A wall is open and is closed by
its plate: beyond its ends the outline continues level, then down (or up) to the straight edge of
the metal. The groove is closed at both ends by the roller's circle, so that the plate stays in one
piece.

Frame: output is the mirror image, as for a cam that turns clockwise: the cam moves by u along
``+x``, a follower's centre is at ``(-u, s)`` in the cam's frame.

Refused: arms that get perpendicular to the travel, plates that are too small for their walls.

Depends on cam, lost_motion, sliding_wall, wall and mechanism.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcam.base.display import Brief, renderer
from gearcam.base.errors import InfeasibleError, Way
from gearcam.cams.cam import Cam
from gearcam.cams.lost_motion import Rest, largest_lost_motion
from gearcam.cams.measures import Extreme
from gearcam.cams.mechanism import Mechanism
from gearcam.cams.sliding_wall import Plate, SlidingWall, arc, joined, straight
from gearcam.cams.wall import CHORD_TOLERANCE, PitchMotion
from gearcam.laws.program import Program
from gearcam.numeric.bulges import as_complex
from gearcam.numeric.contour import Contour

_UPRIGHT = 0.5 * math.pi
"""Largest angle of an arm over a sliding cam, rad: its roller must move along the cam."""

_FAR = 3.0
"""Size of a plate in remedies, over the least: bolts need space next to the groove."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SlidingCam(Brief, Cam):
    """A translating cam.

    Parameters
    ----------
    motion : PitchMotion
        Motion of its follower.
    lower : SlidingWall
        The wall below the follower.
    upper : SlidingWall or None
        For a groove: the wall above it.
    """

    title = "translating cam"

    motion: PitchMotion
    lower: SlidingWall
    upper: SlidingWall | None = None

    @property
    def walls(self) -> tuple[SlidingWall, ...]:
        """The wall below the follower, and for a groove also that above it."""
        return (self.lower,) if self.upper is None else (self.lower, self.upper)

    @property
    def motions(self) -> tuple[PitchMotion, ...]:
        """The motion of the follower."""
        return (self.motion,)

    @property
    def way(self) -> float:
        """Travel, mm."""
        return self.motion.mechanism.driver.turn

    @property
    def width(self) -> float:
        """Width of the groove, mm."""
        return 2.0 * self.lower.mechanism.radius

    @property
    def plate(self) -> Plate:
        """The plate from which it is cut."""
        return self.lower.plate

    @cached_property
    def lost_motion(self) -> Extreme | None:
        """Largest lost motion in a groove, mm or rad."""
        if self.upper is None:
            return None
        radius = self.motion.mechanism.radius
        lower, upper = (Rest(wall=wall, radius=radius) for wall in self.walls)
        return largest_lost_motion(lower, upper)

    @cached_property
    def edge(self) -> Contour:
        """The plate's outline, including the wall of a cam with one wall."""
        plate = self.plate
        if self.upper is None:
            return self.lower.contour
        corners = [(plate.left, plate.low), (plate.right, plate.low), (plate.right, plate.high)]
        return joined(
            [straight(np.array([*corners, (plate.left, plate.high), corners[0]]))], self.lower
        )

    @cached_property
    def groove(self) -> Contour | None:
        """The outline of the groove, with half-round ends; None for a cam with one wall."""
        lower, upper = self.lower, self.upper
        if upper is None:
            return None
        right, left = as_complex(lower.pitch_line[[0, -1]]).tolist()
        start, end = complex(*lower.line[0]), complex(*upper.line[-1])
        stretches = [
            lower.stretch(reverse=True), arc(lower, right, start, math.pi),
            upper.stretch(), arc(lower, left, end, math.pi),
        ]  # fmt: skip
        return joined(stretches, lower)

    def picture(self) -> str:
        """Return a drawing of plate, groove and pitch curve, SVG, in the cam's frame."""
        groove = [] if self.groove is None else [self.groove.vertices]
        pitch = [self.lower.pitch_line]
        return renderer().outlines(self.facts.headline, [self.edge.vertices, *groove], pitch)


def make_sliding(
    program: Program,
    mechanism: Mechanism,
    *,
    height: float,
    length: float | None = None,
    groove: bool = False,
    clearance: float = 0.0,
    tolerance: float = CHORD_TOLERANCE,
) -> SlidingCam:
    """Return a translating cam, verified for its follower and its plate.

    Parameters
    ----------
    program : Program
        The lift, open.
    mechanism : Mechanism
        The follower of a cam that slides.
    height : float, mm
        Height of the plate; for a cam with one wall at the highest lift.
    length : float, mm, optional
        Length of the plate; by default that of its wall, or of the groove and half its width beyond
        both ends.
    groove : bool
        Whether a second wall holds the roller from above.
    clearance : float, mm
        Width of the groove less the roller's diameter.
    tolerance : float, mm
        Chord error of its contours.

    Returns
    -------
    SlidingCam

    Raises
    ------
    InfeasibleError
        If one of them is impossible.
    """
    if mechanism.oscillating:
        _demand_swing(program, mechanism)
    common = {"program": program, "clockwise": True, "tolerance": tolerance}
    wide = replace(mechanism, radius=mechanism.radius + (0.5 * clearance if groove else 0.0))
    plate = _plate(program, wide, height, length, groove)

    motion = PitchMotion(mechanism=mechanism, **common)

    def wall(side: int, key: str, called: str) -> SlidingWall:
        told = {"side": side, "of": motion, "key": key, "called": called}
        return SlidingWall(mechanism=wide, plate=plate, **told, **common)

    if not groove:
        return SlidingCam(motion=motion, lower=wall(1, "", "profile"))
    lower, upper = (
        wall(*told) for told in ((1, "lower", "lower wall"), (-1, "upper", "upper wall"))
    )
    return SlidingCam(motion=motion, lower=lower, upper=upper)


def _demand_swing(program: Program, mechanism: Mechanism) -> None:
    """Refuse an arm that gets perpendicular to the travel, or nearly so."""
    low, high = (mechanism.start + lift for lift in program.range)
    if not -_UPRIGHT < low <= high < _UPRIGHT:
        past = low if low <= -_UPRIGHT else high
        raise InfeasibleError(
            "the arm swings too far: it gets perpendicular to the cam's travel",
            where="motion",
            value=math.degrees(past - mechanism.start),
            limit=math.degrees(math.copysign(_UPRIGHT, past) - mechanism.start),
            unit="deg",
            nearest="value and limit are lifts",
        )


def _plate(
    program: Program, mechanism: Mechanism, height: float, length: float | None, groove: bool
) -> Plate:
    """Return the plate of a cam; the mechanism's radius is half the groove's width."""
    radius, sides = mechanism.radius, (1.0, -1.0) if groove else (1.0,)
    theta = np.array([0.0, 2.0 * math.pi])
    s, ds = program.derivatives(theta, 1)
    curve = PitchMotion(program=program, mechanism=mechanism).curve
    drawn = [-curve.trace(theta, s, ds, side * radius)[0].real for side in sides]
    if groove:  # its ends are round
        middle = -curve.pitch(theta, s).real
        drawn += [middle - 2.0 * radius, middle + 2.0 * radius]
    left, right = float(np.min(drawn)) + 0.0, float(np.max(drawn)) + 0.0
    bare = right - left - (2.0 * radius if groove else 0.0)
    if length is not None:
        if not (length > bare if groove else length >= bare):
            raise _too_small("length_mm", "long", length, bare)
        left, right = (0.5 * (left + right + way) for way in (-length, length))
    positions = np.array(program.range) + mechanism.start
    bottom, top = mechanism.centred.centre(positions).imag.tolist()
    least = top - bottom + (2.0 * radius if groove else 0.0)
    if not height > least:
        raise _too_small("height_mm", "high", height, least)
    high = 0.5 * (top + bottom + height) if groove else top - radius
    return Plate(left=left, right=right, low=high - height, high=high)


def _too_small(key: str, word: str, value: float, limit: float) -> InfeasibleError:
    where = f"blank.{key}"
    return InfeasibleError(
        f"the plate is not {word} enough for the cam",
        where=where,
        value=value,
        limit=limit,
        unit="mm",
        nearest="at the limit no metal is left there",
        ways=(Way(near={where: limit}, far={where: _FAR * limit}),),
    )
