"""A translating cam: a plate that slides past its follower, with one wall or with a groove.

The rotation of a disc cam is a translation here (see `carriers`). A wall is open and is closed by
its plate: beyond its ends the outline continues level, then down (or up) to the straight edge of
the metal. The groove is closed at both ends by the roller's circle, so that the plate stays in one
piece.

Frame: output is the mirror image, as for a cam that turns clockwise: the cam moves by u along
``+x``, a follower's centre is at ``(-u, s)`` in the cam's frame.

Refused: arms that get perpendicular to the travel, plates that are too small for their walls.

Depends on cam, followers, lost_motion, sliding_wall and wall.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcam.base.display import ShortRepr, renderer
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.cams.cam import Cam
from gearcam.cams.carriers import Sliding
from gearcam.cams.followers import Round
from gearcam.cams.lost_motion import Rest, largest_lost_motion
from gearcam.cams.measures import Extreme
from gearcam.cams.sliding_wall import Plate, SlidingWall, arc, joined, straight
from gearcam.cams.wall import CHORD_TOLERANCE, PitchMotion
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array
from gearcam.numeric.bulges import as_complex
from gearcam.numeric.contour import Contour

_FAR = 3.0
"""Size of a plate in remedies, over the least: bolts need space next to the groove."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SlidingCam(ShortRepr, Cam):
    """A translating cam.

    Parameters
    ----------
    motion : PitchMotion
        Motion of its follower.
    roller : Round
        That follower.
    lower : SlidingWall
        The wall below the follower.
    upper : SlidingWall or None
        For a groove: the wall above it.
    """

    title = "translating cam"

    motion: PitchMotion
    roller: Round
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
        return self.motion.program.period

    @property
    def width(self) -> float:
        """Width of the groove, mm."""
        return 2.0 * self.lower.follower.radius

    @property
    def plate(self) -> Plate:
        """The plate from which it is cut."""
        return self.lower.plate

    @cached_property
    def lost_motion(self) -> Extreme | None:
        """Largest lost motion in a groove, mm or rad."""
        if self.upper is None:
            return None
        lower, upper = (Rest(wall=wall, roller=self.roller) for wall in self.walls)
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
    follower: Round,
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
    follower : Round
        The follower.
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
    follower.demand(program)
    carrier = Sliding(program.period)
    common = {"program": program, "carrier": carrier, "clockwise": True, "tolerance": tolerance}
    motion = PitchMotion(follower=follower, **common)
    wide = replace(follower, radius=follower.radius + (0.5 * clearance if groove else 0.0))
    plate = _plate(motion, wide, height, length, groove)

    def wall(side: int, key: str, called: str) -> SlidingWall:
        told = {"side": side, "of": motion, "key": key, "called": called}
        return SlidingWall(follower=wide, plate=plate, **told, **common)

    if not groove:
        return SlidingCam(motion=motion, roller=follower, lower=wall(1, "", "profile"))
    lower, upper = wall(1, "lower", "lower wall"), wall(-1, "upper", "upper wall")
    return SlidingCam(motion=motion, roller=follower, lower=lower, upper=upper)


def _plate(
    motion: PitchMotion, wide: Round, height: float, length: float | None, groove: bool
) -> Plate:
    """Return the plate of a cam, with a follower as `wide` as its groove."""
    radius, program = wide.radius, motion.program
    theta = np.array([0.0, program.period])
    s, ds = program.derivatives(theta, 1)

    def ends(inset: float) -> Array:
        return -replace(motion.pitch_curve, inset=inset).trace(theta, s, ds)[0].real

    drawn = [ends(radius)]
    if groove:  # its ends are round
        drawn += [ends(-radius), ends(0.0) - 2.0 * radius, ends(0.0) + 2.0 * radius]
    left, right = float(np.min(drawn)) + 0.0, float(np.max(drawn)) + 0.0
    bare = right - left - (2.0 * radius if groove else 0.0)
    if length is not None:
        if not (length > bare if groove else length >= bare):
            raise _too_small("length_mm", "long", length, bare)
        left, right = (0.5 * (left + right + way) for way in (-length, length))
    positions = np.array(program.range) + wide.start
    bottom, top = wide.centre(positions).imag.tolist()
    least = top - bottom + (2.0 * radius if groove else 0.0)
    if not height > least:
        raise _too_small("height_mm", "high", height, least)
    high = 0.5 * (top + bottom + height) if groove else top - radius
    return Plate(left=left, right=right, low=high - height, high=high)


def _too_small(key: str, word: str, value: float, limit: float) -> InfeasibleError:
    what, rule = (
        f"the plate is not {word} enough for the cam",
        "at the limit no metal is left there",
    )
    return beyond_limit(what, f"blank.{key}", value, limit, rule, far=_FAR * limit)
