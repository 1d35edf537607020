"""A groove cam: a disc with a groove that holds a roller from both sides.

Both walls are parallels of one pitch curve, each trimmed separately: the groove is the union of all
discs along it. Without clearance a roller fills the groove; the clearance is the groove's width
less the roller's diameter. Two rollers on one pin, one above the other, may each touch one wall:
the first the inner, the second the outer wall; then each wall has its own half width, and at the
height of the larger roller the wall that it must not touch is set back by the smaller one's
clearance.

Refused: as for disc cams, with the widest roller, and blanks whose edge the groove would open.

Depends on cam, disc, followers, lost_motion and wall.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.cams.cam import Cam
from gearcam.cams.disc import clears_axis, demand_standing
from gearcam.cams.followers import Follower, Round
from gearcam.cams.lost_motion import Rest, largest_lost_motion
from gearcam.cams.measures import Extreme
from gearcam.cams.touch import WallTouch
from gearcam.cams.wall import CHORD_TOLERANCE, PitchMotion, Wall
from gearcam.laws.program import Program


@dataclass(frozen=True, eq=False, kw_only=True)
class GrooveCam(ShortRepr, Cam):
    """A groove cam.

    Parameters
    ----------
    motion : PitchMotion
        Motion of the roller that touches the inner wall.
    inner, outer : Wall
        Inside and outside the pitch curve; their followers are as wide as the groove.
    rollers : (Round, Round)
        The rollers that touch the inner and the outer wall, one and the same if there is one.
    relief : Wall or None
        Wall set back at the height of the larger of two rollers, which must not touch it.
    """

    title = "groove cam"

    motion: PitchMotion
    inner: Wall
    outer: Wall
    rollers: tuple[Round, Round]
    relief: Wall | None = None

    @property
    def walls(self) -> tuple[Wall, ...]:
        """The inner and the outer wall."""
        return self.inner, self.outer

    @property
    def touches(self) -> tuple[WallTouch, ...]:
        """Its inner and outer wall; a relief carries nothing (see `Cam.touches`)."""
        walls = zip((self.inner, self.outer), self.rollers, strict=True)
        return tuple(WallTouch(wall=wall, end=end, key=wall.key) for wall, end in walls)

    @property
    def motions(self) -> tuple[PitchMotion, ...]:
        """The motion of both walls."""
        return (self.motion,)

    @property
    def width(self) -> float:
        """Width of the groove, mm: the smaller one if it has two."""
        return self.inner.follower.radius + self.outer.follower.radius

    @property
    def clearance(self) -> float | None:
        """Width of the groove less the roller's diameter, mm; None with two rollers."""
        return self.width - 2.0 * self.rollers[0].radius if self.relief is None else None

    @property
    def reach(self) -> float:
        """Largest distance of the groove from the axis, mm."""
        walls = (self.outer, self.relief or self.outer)
        radius = max(wall.follower.radius for wall in walls if wall.side < 0)
        follower, (_, high) = self.motion.follower, self.motion.program.range
        return follower.distance(follower.start + high) + radius

    @cached_property
    def lost_motion(self) -> Extreme:
        """Largest lost motion, mm or rad: free travel of the follower while the cam is at rest."""
        inner, outer = self.rollers
        return largest_lost_motion(
            Rest(wall=self.inner, roller=inner), Rest(wall=self.outer, roller=outer)
        )


def make_groove(
    program: Program,
    roller: Round,
    *,
    clearance: float = 0.0,
    radius2: float | None = None,
    diameter: float = math.inf,
    clockwise: bool = False,
    tolerance: float = CHORD_TOLERANCE,
) -> GrooveCam:
    """Return a groove cam, verified for all positions of its follower.

    Parameters
    ----------
    program : Program
        The lift.
    roller : Round
        The follower with its roller, of two that on the inner wall.
    clearance : float, mm
        Width of the groove less the roller's diameter; half of it at each of two rollers.
    radius2 : float, mm, optional
        Radius of a second roller, on the outer wall.
    diameter : float, mm
        Diameter of the blank.
    clockwise : bool
        Whether the cam turns clockwise.
    tolerance : float, mm
        Chord error of its contours.

    Returns
    -------
    GrooveCam

    Raises
    ------
    InfeasibleError
        If a position is impossible, or the groove would open the edge of the blank.
    """
    common = {"program": program, "clockwise": clockwise, "tolerance": tolerance}
    motion = PitchMotion(follower=roller, **common)
    radius, second = roller.radius, roller.radius if radius2 is None else radius2

    def wall(size: float, side: int, key: str) -> Wall:
        wide, called = replace(roller, radius=size + 0.5 * clearance), f"{key} wall"
        return Wall(follower=wide, side=side, of=motion, key=key, called=called, **common)

    relief = None
    if second != radius:
        side, far = (1 if second > radius else -1), 2.0 * max(radius, second) - min(radius, second)
        relief = wall(far, side, "relief")
    inner, outer = wall(radius, 1, "inner"), wall(second, -1, "outer")
    deepest = relief if relief is not None and relief.side > 0 else inner
    demand_standing(program, roller)
    if not clears_axis(program, deepest.follower):
        raise _too_wide(program, deepest.follower)
    rollers = roller, replace(roller, radius=second)
    cam = GrooveCam(motion=motion, inner=inner, outer=outer, rollers=rollers, relief=relief)
    least = 2.0 * cam.reach
    if not diameter > least:
        what, key = "the groove opens the edge of the blank", "cam.outer_diameter_mm"
        rule = "it must exceed twice the groove's largest distance from the axis, the limit"
        raise beyond_limit(what, key, diameter, least, rule, far=1.5 * least)
    return cam


def _too_wide(program: Program, deepest: Follower) -> InfeasibleError:
    """Return the error for a groove that contains the axis."""
    nearest = deepest.distance(deepest.start + program.range[0])
    what = "the groove is so wide that it reaches the cam's axis"
    note = "the value is the distance from the middle of the groove to its inner wall, the limit "
    note += "its least distance from the axis"
    return beyond_limit(what, "[cam]", deepest.radius, nearest, note, unit="mm")
