"""A cam in space: its walls over a turn, and their measures.

A *wall* is what one side of the roller makes: `upper` above it, `lower` below. Each is a surface
over the cam angle theta and the distance x along the roller's axis, from the roller's inner end to
the *edge*, where it meets the outside of the blank. A groove has both walls, made by a roller that
is wider than the true one by the clearance.

Depends on envelope, extremes, guides and laws; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array
from gearcam.numeric.roots import bracketed_root
from gearcam.spatial.envelope import Roller, RollerAxis, RollerContact, touched
from gearcam.spatial.extremes import Spot, boxes_between, lowest
from gearcam.spatial.guides import RollerGuide, carried

_ROOT: Final = 1e-15
"""Width of the bracket of a place or a radius, over the radius of the blank."""

_WIDEST: Final = 4.0
"""Largest radius of a roller that is looked for, over the radius of the blank."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SpatialCam(ShortRepr):
    """A cam whose walls are made by a roller.

    Parameters
    ----------
    program : Program
        The lift over a turn.
    guide : RollerGuide
        What carries the roller.
    roller : Roller
        Its shape.
    inner : float, mm
        Distance of its inner end along its axis: between this and the outside it presses.
    floor : float, mm
        Distance up to which the walls are cut; not above `inner`.
    outer_radius : float, mm
        Radius of the blank, a cylinder.
    clearance : float, mm
        Width of the groove less the diameter of the roller.
    sides : tuple of int
        The sides of the walls, of `gearcam.spatial.envelope.SIDES`.
    clockwise : bool
        Whether the cam turns clockwise: then it is the mirror image of what is computed.
    apart : float, mm
        Of a rib: distance of the axes of the two rollers that embrace it; each makes the wall on
        its side of the rib. 0: one roller makes all walls.
    """

    program: Program
    guide: RollerGuide
    roller: Roller
    inner: float
    floor: float
    outer_radius: float
    clearance: float = 0.0
    sides: tuple[int, ...] = (1, -1)
    clockwise: bool = False
    apart: float = 0.0

    @cached_property
    def walls(self) -> tuple[SpatialWall, ...]:
        """The walls, the upper one first."""
        return tuple(SpatialWall(cam=self, side=side) for side in self.sides)

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

    @property
    def mean_radius(self) -> float:
        """Radius in the middle between the roller's inner end and the outside, mm."""
        return 0.5 * (self.inner + self.outer_radius)

    def axis(self, theta: Array, side: int) -> RollerAxis:
        """Return the axis of the roller that makes a wall, in the frame of the cam.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        side : {1, -1}
            The wall.
        """
        axis = carried(self.guide, theta, *self.program.derivatives(theta, 2))
        if not self.apart:
            return axis
        point = axis.point.copy()
        point[0, :, 2] -= 0.5 * side * self.apart  # the upper wall is made by the lower roller
        return replace(axis, point=point)

    def contact(
        self, theta: Array, x: Array, side: int, roller: Roller | None = None
    ) -> RollerContact:
        """Return where the roller touches a wall.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        x : (n, k) array, mm
            Distances along the axis of the roller.
        side : {1, -1}
            The wall.
        roller : Roller, optional
            By default the `tool`.
        """
        return touched(self.axis(theta, side), roller or self.tool, x, side)

    def pressure(self, x: float | None = None, kind: str = "") -> Spot | None:
        """Return the largest pressure angle, rad, of either wall.

        Parameters
        ----------
        x : float, mm, optional
            A distance along the axis of the roller; by default the worst.
        kind : str
            Phases that count, such as ``rise``; by default all.

        Returns
        -------
        Spot or None
            None if there is no such phase.
        """
        low, high = (self.inner, self.outer_radius) if x is None else (x, x)
        stretches = self.program.phases(kind) if kind else self._turn
        return self._steepest(low, high, stretches) if stretches else None

    @property
    def _turn(self) -> list[tuple[float, float]]:
        return [(0.0, self.program.period)]

    def _steepest(self, low: float, high: float, stretches: Sequence[tuple[float, float]]) -> Spot:
        """Return the largest pressure angle of either wall between two places on the roller."""

        def gentle(theta: Array, x: Array) -> Array:
            return -np.max([self.contact(theta, x, side).pressure for side in self.sides], axis=0)

        worst = self.least(gentle, (low, high), stretches)
        return replace(worst, value=-worst.value)

    @cached_property
    def largest_roller(self) -> Spot:
        """Largest radius of a roller that makes all walls without undercut, mm, where it is `at`.

        Infinite if there is none up to four times the radius of the blank.
        """
        return min((wall.largest_roller for wall in self.walls), key=lambda spot: spot.value)

    @cached_property
    def lost_motion(self) -> Spot | None:
        """Largest distance, mm, by which the follower can move between two walls.

        None with one wall. To first order: the clearance over the cosine of the pressure angle at
        the outside, where the roller touches first.
        """
        if len(self.sides) < 2:
            return None
        steepest = self._steepest(self.outer_radius, self.outer_radius, self._turn)
        return replace(steepest, value=self.clearance / math.cos(steepest.value))

    @cached_property
    def least_rib(self) -> Spot | None:
        """Least thickness of a rib along its normal, mm; None without one.

        To first order: the distance of the rollers' axes across the walls, less both radii.
        """
        if not self.apart:
            return None

        def thickness(theta: Array, x: Array) -> Array:
            contact = self.contact(theta, x, 1)
            return self.apart * np.cos(contact.pressure) - 2.0 * contact.radius

        return self.least(thickness, (self.inner, self.outer_radius))

    @cached_property
    def heights(self) -> tuple[float, float]:
        """Lowest and highest place of the roller's axis, mm."""
        point, _ = self.guide.placed(np.array(self.program.range))
        low, high = sorted(point[0, :, 2].tolist())
        return low, high

    def least(
        self,
        function: Callable[[Array, Array], Array],
        ends: tuple[float, float],
        stretches: Sequence[tuple[float, float]] | None = None,
    ) -> Spot:
        """Return the least value of a function of cam angle and place on the roller.

        Parameters
        ----------
        function : callable
            ``function(theta, x)``, of arrays (n,) and (n, k).
        ends : (float, float), mm
            The places that count.
        stretches : sequence of (float, float), rad, optional
            The cam angles that count; the whole turn if left out.
        """
        boxes = [
            box
            for start, end in stretches or self._turn
            for box in boxes_between(self.program.cuts_between(start, end), ends)
        ]
        return lowest(function, boxes)


@dataclass(frozen=True, eq=False, kw_only=True)
class SpatialWall(ShortRepr):
    """A wall of a cam.

    Parameters
    ----------
    cam : SpatialCam
        The cam.
    side : {1, -1}
        The side of the roller.
    """

    cam: SpatialCam
    side: int

    @property
    def key(self) -> str:
        """Name in files and facts: ``upper`` or ``lower``."""
        return "upper" if self.side > 0 else "lower"

    def contact(self, theta: Array, x: Array) -> RollerContact:
        """Return where the roller touches it (see `SpatialCam.contact`)."""
        return self.cam.contact(theta, x, self.side)

    def edge(self, theta: Array) -> Array:
        """Return the places on the roller at which it meets the outside of the blank.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.

        Returns
        -------
        (n,) array, mm
        """
        axis, radius = self.cam.axis(theta, self.side), self.cam.outer_radius

        def outside(x: Array) -> Array:
            contact = touched(axis, self.cam.tool, x[:, None], self.side)
            return np.hypot(*contact.points[:, 0, :2].T) - radius

        low = np.full(len(theta), self.cam.floor)
        return bracketed_root(outside, low, np.full(len(theta), radius), _ROOT * radius)

    def grid(self, theta: Array, count: int) -> RollerContact:
        """Return the wall as a grid, from its foot to its edge.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        count : int
            Number of even places along the roller.
        """
        share = np.linspace(0.0, 1.0, count)
        low = self.cam.floor
        return self.contact(theta, low + share * (self.edge(theta)[:, None] - low))

    @property
    def undercut(self) -> bool:
        """Whether the roller cuts away a part of it at another angle."""
        return self.spread.value <= 0.0

    @cached_property
    def spread(self) -> Spot:
        """The least spread, mm (see `gearcam.spatial.envelope`); below 0 the wall is undercut."""
        ends = (self.cam.floor, self.cam.outer_radius)
        return self.cam.least(lambda theta, x: self.contact(theta, x).spread, ends)

    @cached_property
    def largest_roller(self) -> Spot:
        """Largest radius of a roller that makes it without undercut, mm, where it is `at`."""
        return self.largest_roller_at(self.cam.floor, self.cam.outer_radius)

    def largest_roller_at(self, low: float, high: float) -> Spot:
        """Return the largest radius of a roller without undercut, mm, where it is `at`.

        Parameters
        ----------
        low, high : float, mm
            Places along the roller that count.
        """
        cam, shape = self.cam, self.cam.roller
        widest = _WIDEST * cam.outer_radius

        def critical(theta: Array, x: Array) -> Array:
            axis = cam.axis(theta, self.side)
            narrower = (shape.at - x) * math.tan(shape.half_angle)

            def spread(radius: Array) -> Array:
                return RollerContact(
                    axis=axis,
                    x=x,
                    radius=radius - narrower,
                    half_angle=shape.half_angle,
                    side=self.side,
                ).spread

            least = np.maximum(narrower, 0.0)
            return bracketed_root(spread, least, np.full(x.shape, widest), _ROOT * widest)

        spot = cam.least(critical, (low, high))
        return spot if spot.value < 0.999 * widest else replace(spot, value=math.inf)
