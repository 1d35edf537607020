"""A translating cam: a plate that slides past its follower, with one wall or with a groove.

Everything that turns for a disc cam slides here (see `mechanism`). A wall is open; its plate closes
it: beyond its ends it goes on level, down (or up) to the straight edge of the metal. The groove is
closed at both ends by the roller's circle, so that the plate stays in one piece.

Frame: people see the mirror image, as of a cam that turns clockwise: the cam moves by u along
``+x``, a follower's centre stands at ``(-u, s)`` in the cam's frame.

Refused: arms that stand upright, plates that do not hold their walls.

Depends on cam, lost_motion, sliding_wall, wall and mechanism.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcam.cams.cam import Cam
from gearcam.cams.lost_motion import Rest, largest_lost_motion
from gearcam.cams.measures import Extreme
from gearcam.cams.mechanism import Mechanism
from gearcam.cams.sliding_wall import Plate, SlidingWall, arc, joined, straight
from gearcam.cams.wall import CHORD_TOLERANCE, PitchMotion
from gearcam.display import Brief
from gearcam.errors import InfeasibleError, Way
from gearcam.facts import Fact, Facts
from gearcam.laws.program import Program
from gearcam.numeric.bulges import as_complex
from gearcam.numeric.contour import Contour

_UPRIGHT = 0.5 * math.pi
"""Angle of an arm over a sliding cam, rad, at which its roller no longer goes along the cam."""

_FAR = 3.0
"""How large a plate is tried, over the least: bolts stand beside what is cut into it."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SlidingCam(Brief, Cam):
    """A translating cam.

    Parameters
    ----------
    motion : PitchMotion
        Of its follower.
    lower : SlidingWall
        The wall below the follower.
    upper : SlidingWall or None
        That above it, of a groove.
    """

    motion: PitchMotion
    lower: SlidingWall
    upper: SlidingWall | None = None

    @property
    def walls(self) -> tuple[SlidingWall, ...]:
        """The wall below the follower, of a groove also that above it."""
        return (self.lower,) if self.upper is None else (self.lower, self.upper)

    @property
    def motions(self) -> tuple[PitchMotion, ...]:
        """The motion of the follower."""
        return (self.motion,)

    @property
    def way(self) -> float:
        """How far it slides, mm."""
        return self.motion.mechanism.driver.turn

    @property
    def width(self) -> float:
        """Of the groove, mm."""
        return 2.0 * self.lower.mechanism.radius

    @property
    def plate(self) -> Plate:
        """What it is cut from."""
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
        """The plate's edge, of a cam with one wall with that wall."""
        plate = self.plate
        if self.upper is None:
            return self.lower.contour
        corners = [(plate.left, plate.low), (plate.right, plate.low), (plate.right, plate.high)]
        return joined(
            [straight(np.array([*corners, (plate.left, plate.high), corners[0]]))], self.lower
        )

    @cached_property
    def groove(self) -> Contour | None:
        """The edge of the groove, its ends half circles; None of a cam with one wall."""
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
        """Return a picture of plate, groove and pitch curve, SVG, in the cam's frame."""
        from gearcam.markup import outlines

        groove = [] if self.groove is None else [self.groove.vertices]
        pitch = [self.lower.pitch_line]
        return outlines(self.facts.headline, [self.edge.vertices, *groove], pitch)

    @cached_property
    def facts(self) -> Facts:
        """What the cam knows of itself; the facts of its result tell more."""
        tree = {
            "total_lift": self.motion.total_lift,
            "way_mm": Fact(self.way, "way"),
            "area_mm2": self.edge.moments.area,
        }
        return Facts(tree, ("total_lift", "way_mm"), "translating cam")


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
    """Return a translating cam after proving that its follower and its plate can be.

    Parameters
    ----------
    program : Program
        The lift, open.
    mechanism : Mechanism
        The follower of a cam that slides.
    height : float, mm
        Of the plate; that of a cam with one wall is highest where the lift is.
    length : float, mm, optional
        Of the plate; where left out as long as its wall, or with half the groove's width beyond
        the groove at both ends.
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
        If they cannot.
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
    """Refuse an arm that stands upright, or nearly so."""
    low, high = (mechanism.start + lift for lift in program.range)
    if not -_UPRIGHT < low <= high < _UPRIGHT:
        past = low if low <= -_UPRIGHT else high
        raise InfeasibleError(
            "the arm swings too far: it stands upright on the cam",
            where="motion",
            value=math.degrees(past - mechanism.start),
            limit=math.degrees(math.copysign(_UPRIGHT, past) - mechanism.start),
            unit="deg",
            nearest="these are lifts",
        )


def _plate(
    program: Program, mechanism: Mechanism, height: float, length: float | None, groove: bool
) -> Plate:
    """Return the plate of a cam, of a mechanism with half the groove's width."""
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
    bottom, top = mechanism.sliding_centre(positions).imag.tolist()
    least = top - bottom + (2.0 * radius if groove else 0.0)
    if not height > least:
        raise _too_small("height_mm", "high", height, least)
    high = 0.5 * (top + bottom + height) if groove else top - radius
    return Plate(left=left, right=right, low=high - height, high=high)


def _too_small(key: str, word: str, value: float, limit: float) -> InfeasibleError:
    where = f"blank.{key}"
    return InfeasibleError(
        f"the plate is not {word} enough for what is cut into it",
        where=where,
        value=value,
        limit=limit,
        unit="mm",
        nearest="a plate just above the limit has no metal left there",
        ways=(Way(near={where: limit}, far={where: _FAR * limit}),),
    )
