"""What the walls of all cams in space have alike, and the cams that have them.

A wall is what one side of a roller makes (see `envelope`). A groove is wider than the roller by the
*clearance*: its walls are made by the *tool*, a roller of half the clearance more. Each form of a
cam says how its roller moves, and which part of a wall is on the cam.

Depends on envelope, extremes and laws; numpy only.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array
from gearcam.numeric.roots import bracketed_root
from gearcam.spatial.envelope import Roller, RollerAxis, RollerContact, touched
from gearcam.spatial.extremes import Spot
from gearcam.spatial.loaded import ContactLine, RollerFollower, RollerMotion, RollerTouch

if TYPE_CHECKING:
    from gearcam.spatial.guides import RollerGuide

ROOT: Final = 1e-15
"""Width of the bracket of a place or a radius, over the size of the cam."""

_FALLS: Final = 60
"""Largest number of places that are looked at for the largest cone; five are many."""

_STEADY: Final = 1e-8
"""Fall of the largest cone, as a share, after which it falls by rounding: by its square."""

_SOUGHT: Final = 0.999
"""Share of the largest radius that is looked for, at and above which none was found."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RollerCam(ABC, ShortRepr):
    """A cam in space whose walls are made by a roller.

    Parameters
    ----------
    program : Program
        The motion of the roller over a turn.
    roller : Roller
        Its shape.
    clearance : float, mm
        Width of a groove less the diameter of the roller.
    clockwise : bool
        Whether the cam turns clockwise: then it is the mirror image of what is computed.
    """

    program: Program
    roller: Roller
    clearance: float = 0.0
    clockwise: bool = False

    @property
    @abstractmethod
    def widest(self) -> float:
        """Largest radius of a roller that is looked for, mm."""

    @cached_property
    @abstractmethod
    def walls(self) -> Sequence[RollerWall]:
        """The walls, the upper one first."""

    @abstractmethod
    def axis(self, theta: Array, side: int = 1) -> RollerAxis:
        """Return the axis of the roller that makes a wall, in the frame of the cam.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        side : {1, -1}
            The wall.
        """

    if TYPE_CHECKING:  # a field of some forms, which cannot be abstract

        @property
        def guide(self) -> RollerGuide:
            """What carries the roller."""
            ...

    @property
    @abstractmethod
    def middle(self) -> float:
        """The middle of the part of a roller that presses, mm along its axis."""

    @property
    def motions(self) -> tuple[RollerMotion]:
        """The motion of its follower."""
        guide = self.guide
        follower = RollerFollower(guide=guide, radius=self.roller.radius_at(self.middle))
        return (RollerMotion(program=self.program, follower=follower, hand=self.hand),)

    @cached_property
    def touches(self) -> tuple[RollerTouch, ...]:
        """Where it can press on its follower: on each wall."""
        return tuple(
            RollerTouch(
                key=wall.key,
                guide=self.guide,
                roller=self.roller,
                middle=self.middle,
                line=wall.contact_line,
                above=wall.key == "upper",
            )
            for wall in self.walls
        )

    @property
    def undercut(self) -> bool:
        """Whether the roller cuts away a part of a wall at another angle."""
        return any(wall.undercut for wall in self.walls)

    @property
    def hand(self) -> float:
        """What azimuths and y are multiplied by: -1 of a cam that turns clockwise, else 1."""
        return -1.0 if self.clockwise else 1.0

    @property
    def tool(self) -> Roller:
        """What makes the walls: the roller, wider by the clearance."""
        return replace(self.roller, radius=self.roller.radius + 0.5 * self.clearance)

    @cached_property
    def largest_roller(self) -> Spot:
        """Largest radius of a tool that makes all walls without undercut, mm, where it is `at`.

        Infinite if there is none up to the `widest`.
        """
        return min((wall.largest_roller for wall in self.walls), key=lambda spot: spot.value)

    def contact(self, theta: Array, x: Array, side: int) -> RollerContact:
        """Return where the tool touches a wall.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        x : (n, k) array, mm
            Distances along the axis of the roller.
        side : {1, -1}
            The wall.
        """
        return touched(self.axis(theta, side), self.tool, x, side)


@dataclass(frozen=True, eq=False, kw_only=True)
class RollerWall(ABC, ShortRepr):
    """A wall of a cam in space.

    Parameters
    ----------
    cam : RollerCam
        The cam.
    side : {1, -1}
        The side of the roller that makes it.
    """

    cam: Any
    side: int

    @property
    @abstractmethod
    def key(self) -> str:
        """Name in files and facts: ``upper`` or ``lower``."""

    @abstractmethod
    def least(self, measure: Callable[[RollerContact], Array]) -> Spot:
        """Return the least value of a measure of its points, on the cam.

        Parameters
        ----------
        measure : callable
            Gives values, (n, k), of a contact.
        """

    @abstractmethod
    def contact_line(self, theta: Array) -> ContactLine:
        """Return where rollers can press on it at cam angles (n,), rad."""

    def contact(self, theta: Array, x: Array) -> RollerContact:
        """Return where the tool touches it (see `RollerCam.contact`)."""
        return self.cam.contact(theta, x, self.side)

    @property
    def undercut(self) -> bool:
        """Whether the roller cuts away a part of it at another angle."""
        return self.spread.value <= 0.0

    @cached_property
    def spread(self) -> Spot:
        """The least spread, mm (see `gearcam.spatial.envelope`); below 0 the wall is undercut."""
        return self.least(lambda contact: contact.spread)

    @cached_property
    def largest_roller(self) -> Spot:
        """Largest radius of a tool that makes it without undercut, mm, where it is `at`.

        Infinite if there is none up to the `widest`. Only places that are on the cam now count.
        """
        spot = self._largest_cone if self.cam.roller.half_angle else self.least(self._critical)
        return spot if spot.value < _SOUGHT * self.cam.widest else replace(spot, value=math.inf)

    @property
    def allowed_radius(self) -> float:
        """Largest radius of the roller itself, mm; infinite or below 0 if there is none."""
        return self.largest_roller.value - 0.5 * self.cam.clearance

    def _critical(self, contact: RollerContact) -> Array:
        """Return radii of cylinders with which the spread of points vanishes, (n, k), mm."""
        return np.minimum(contact.vanishing, self.cam.widest)

    @property
    def _largest_cone(self) -> Spot:
        """The largest radius of a cone, mm, where it is `at`; that searched for if there is none.

        The radius with which the spread vanishes at one place is too large for those where it is
        negative then. The radius of the worst of them is smaller, and so on down to that of the
        worst place of all: as fast as Newton's method, and from any place.
        """
        best = spot = self.spread
        found = math.inf
        for _ in range(_FALLS):
            radius = self._radius_at(spot) if math.isfinite(spot.value) else self.cam.widest
            if radius < found:
                best = replace(spot, value=radius)
            if radius >= (1.0 - _STEADY) * found:
                break
            found = radius
            spot = self.least(lambda contact, radius=found: self._of_radius(contact, radius).spread)
        return best

    def _of_radius(self, contact: RollerContact, radius: Array | float) -> RollerContact:
        """Return the contact of a tool of another radius, mm, where it is `at`."""
        shape = self.cam.roller
        own = radius + (contact.x - shape.at) * math.tan(shape.half_angle)
        return replace(contact, radius=np.maximum(own, 0.0))

    def _radius_at(self, spot: Spot) -> float:
        """Return the radius of a tool, mm, where it is `at`, with which the spread vanishes."""
        shape, widest = self.cam.roller, self.cam.widest
        contact = self.contact(np.array([spot.theta]), np.array([[spot.x]]))
        least = np.maximum((shape.at - contact.x) * math.tan(shape.half_angle), 0.0)
        found = bracketed_root(
            lambda radius: self._of_radius(contact, radius).spread, least, widest, ROOT * widest
        )
        return float(found[0, 0])
