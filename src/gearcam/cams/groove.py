"""A groove cam: a disc with a groove that holds a roller from both sides.

Both walls are parallels of one pitch curve, each trimmed separately: the groove is the union of all
discs along it. Without clearance a roller fills the groove; the clearance is the groove's width
less the roller's diameter. Two rollers on one pin, one above the other, may each touch one wall:
the first the inner, the second the outer wall; then each wall has its own half width, and at the
height of the larger roller the wall that it must not touch is set back by the smaller one's
clearance.

Refused: as for disc cams, with the widest roller, and blanks whose edge the groove would open.

Depends on cam, disc, lost_motion, wall and mechanism.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

from gearcam.base.display import Brief
from gearcam.base.errors import InfeasibleError, Way
from gearcam.cams.cam import Cam
from gearcam.cams.disc import clears_axis, demand_standing
from gearcam.cams.lost_motion import Rest, largest_lost_motion
from gearcam.cams.measures import Extreme
from gearcam.cams.mechanism import Mechanism
from gearcam.cams.wall import CHORD_TOLERANCE, PitchMotion, Wall
from gearcam.laws.program import Program


@dataclass(frozen=True, eq=False, kw_only=True)
class GrooveCam(Brief, Cam):
    """A groove cam.

    Parameters
    ----------
    motion : PitchMotion
        Motion of the roller that touches the inner wall.
    inner, outer : Wall
        Inside and outside the pitch curve; their followers are as wide as the groove.
    radius2 : float, mm
        Radius of the roller that touches the outer wall.
    relief : Wall or None
        Wall set back at the height of the larger of two rollers, which must not touch it.
    """

    title = "groove cam"

    motion: PitchMotion
    inner: Wall
    outer: Wall
    radius2: float
    relief: Wall | None = None

    @property
    def walls(self) -> tuple[Wall, ...]:
        """The inner and the outer wall."""
        return self.inner, self.outer

    @property
    def motions(self) -> tuple[PitchMotion, ...]:
        """The motion of both walls."""
        return (self.motion,)

    @property
    def width(self) -> float:
        """Width of the groove, mm: the smaller one if it has two."""
        return self.inner.mechanism.radius + self.outer.mechanism.radius

    @property
    def reach(self) -> float:
        """Largest distance of the groove from the axis, mm."""
        walls = (self.outer, self.relief or self.outer)
        radius = max(wall.mechanism.radius for wall in walls if wall.side < 0)
        return _farthest(self.motion) + radius

    @cached_property
    def lost_motion(self) -> Extreme:
        """Largest lost motion, mm or rad: free travel of the follower while the cam is at rest."""
        return largest_lost_motion(
            Rest(wall=self.inner, radius=self.motion.mechanism.radius),
            Rest(wall=self.outer, radius=self.radius2),
        )


def _farthest(motion: PitchMotion) -> float:
    """Return the largest distance of the roller's centre from the axis, mm."""
    m = motion.mechanism
    return m.follower.distance(m.start + motion.program.range[1])


def make_groove(
    program: Program,
    mechanism: Mechanism,
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
    mechanism : Mechanism
        The follower, with the radius of the roller (of two, that on the inner wall).
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
    motion = PitchMotion(mechanism=mechanism, **common)
    radius, second = mechanism.radius, mechanism.radius if radius2 is None else radius2

    def wall(size: float, side: int, key: str) -> Wall:
        wide = replace(mechanism, radius=size + 0.5 * clearance)
        called = f"{key} wall"
        return Wall(mechanism=wide, side=side, of=motion, key=key, called=called, **common)

    relief = None
    if second != radius:
        side, far = (1 if second > radius else -1), 2.0 * max(radius, second) - min(radius, second)
        relief = wall(far, side, "relief")
    inner, outer = wall(radius, 1, "inner"), wall(second, -1, "outer")
    deepest = relief if relief is not None and relief.side > 0 else inner
    demand_standing(program, mechanism)
    if not clears_axis(program, deepest.mechanism):
        raise _too_wide(program, deepest.mechanism)
    made = GrooveCam(
        motion=motion,
        inner=inner,
        outer=outer,
        radius2=second,
        relief=relief,
    )
    least = 2.0 * made.reach
    if not diameter > least:
        raise InfeasibleError(
            "the groove opens the edge of the blank",
            where="cam.outer_diameter_mm",
            value=diameter,
            limit=least,
            unit="mm",
            nearest="it must exceed twice the groove's largest distance from the axis, the limit",
            ways=(
                Way(
                    near={"cam.outer_diameter_mm": least},
                    far={"cam.outer_diameter_mm": 1.5 * least},
                ),
            ),
        )
    return made


def _too_wide(program: Program, deepest: Mechanism) -> InfeasibleError:
    """Return the error for a groove that contains the axis."""
    nearest = deepest.follower.distance(deepest.start + program.range[0])
    return InfeasibleError(
        "the groove is so wide that it reaches the cam's axis",
        where="[cam]",
        value=deepest.radius,
        limit=nearest,
        unit="mm",
        nearest="the value is the distance from the middle of the groove to its inner wall, the "
        "limit its least distance from the axis",
    )
