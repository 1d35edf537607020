"""A cam in space: its walls over a turn, and their measures.

A *wall* is what one side of the roller makes: `upper` above it, `lower` below. Each is a surface
over the cam angle theta and the distance x along the roller's axis, from the roller's inner end to
the *edge*, where it meets the outside of the blank. A groove has both walls, made by a roller that
is wider than the true one by the clearance.

Depends on walls, envelope, extremes and guides; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.numeric.roots import bracketed_root
from gearcam.spatial.envelope import RollerAxis, RollerContact, touched
from gearcam.spatial.extremes import Spot, boxes_between, lowest
from gearcam.spatial.guides import AcrossGuide, carried
from gearcam.spatial.loaded import ContactLine
from gearcam.spatial.walls import ROOT, RollerCam, RollerWall

_CELLS: Final = 1440
"""Cells of the cam angle in which an azimuth is looked for."""

_WIDEST: Final = 4.0
"""Largest radius of a roller that is looked for, over the radius of the blank."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SpatialCam(RollerCam):
    """A cylinder cam (see `RollerCam`); its program is the lift over a turn.

    Parameters
    ----------
    guide : AcrossGuide
        What carries the roller.
    inner : float, mm
        Distance of its inner end along its axis: between this and the outside it presses.
    floor : float, mm
        Distance up to which the walls are cut; not above `inner`.
    outer_radius : float, mm
        Radius of the blank, a cylinder.
    sides : tuple of int
        The sides of the walls, of `gearcam.spatial.envelope.SIDES`.
    apart : float, mm
        Of a rib: distance of the axes of the two rollers that embrace it; each makes the wall on
        its side of the rib. 0: one roller makes all walls.
    """

    guide: AcrossGuide  # pyright: ignore[reportIncompatibleMethodOverride]
    inner: float
    floor: float
    outer_radius: float
    sides: tuple[int, ...] = (1, -1)
    apart: float = 0.0

    @cached_property
    def walls(self) -> tuple[SpatialWall, ...]:
        """The walls, the upper one first."""
        return tuple(SpatialWall(cam=self, side=side) for side in self.sides)

    @property
    def widest(self) -> float:
        """Largest radius of a roller that is looked for, mm."""
        return _WIDEST * self.outer_radius

    @property
    def middle(self) -> float:
        """Radius in the middle between the roller's inner end and the outside, mm."""
        return 0.5 * (self.inner + self.outer_radius)

    def axis(self, theta: Array, side: int = 1) -> RollerAxis:
        """Return the axis of the roller that makes a wall (see `RollerCam.axis`)."""
        axis = carried(self.guide, theta, *self.program.derivatives(theta, 2))
        if not self.apart:
            return axis
        point = axis.point.copy()
        point[0, :, 2] -= 0.5 * side * self.apart  # the upper wall is made by the lower roller
        return replace(axis, point=point)

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
            axis = self.axis(theta)  # where a point of it is does not matter
            both = [touched(axis, self.tool, x, side).pressure for side in self.sides]
            return -np.max(both, axis=0)

        worst = self.least(gentle, (low, high), stretches)
        return replace(worst, value=-worst.value)

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
    def depth_of_contact(self) -> Spot:
        """How far the end of the roller is inside the blank where it touches a wall, mm: the least.

        Below 0 the roller leaves the cam there: the point of contact is beside the roller's axis.
        """

        def inside(theta: Array, x: Array) -> Array:
            points = [self.contact(theta, x, side).points for side in self.sides]
            return self.outer_radius - np.max([np.hypot(*p[..., :2].T).T for p in points], axis=0)

        return self.least(inside, (self.inner, self.inner))

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
class SpatialWall(RollerWall):
    """A wall of a cylinder cam (see `RollerWall`)."""

    cam: SpatialCam

    @property
    def key(self) -> str:
        """Name in files and facts: ``upper`` or ``lower``."""
        return "upper" if self.side > 0 else "lower"

    def least(
        self,
        measure: Callable[[RollerContact], Array],
        ends: tuple[float, float] | None = None,
    ) -> Spot:
        """Return the least value of a measure of its points (see `RollerWall.least`).

        Parameters
        ----------
        measure : callable
            Gives values, (n, k), of a contact.
        ends : (float, float), mm, optional
            The places on the roller that count; from the floor to the outside if left out.
        """
        cam = self.cam
        places = ends or (cam.floor, cam.outer_radius)
        return cam.least(lambda theta, x: measure(self.contact(theta, x)), places)

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
        return bracketed_root(outside, low, np.full(len(theta), radius), ROOT * radius)

    def heights_at(self, angles: Array) -> Array:
        """Return the heights at which it meets the outside of the blank.

        Parameters
        ----------
        angles : (n,) array, rad
            Azimuths in the frame of a cam that turns counter-clockwise.

        Returns
        -------
        (n,) array, mm
            Of a wall that is not undercut, whose azimuth falls with the cam angle.
        """
        theta = np.linspace(0.0, self.cam.program.period, _CELLS + 1)

        def meets(theta: Array) -> Array:
            return self.contact(theta, self.edge(theta)[:, None]).points[:, 0]

        x, y, _ = meets(theta).T
        azimuth = np.unwrap(np.arctan2(y, x))
        turned = azimuth[0] - (azimuth[0] - angles) % (2.0 * math.pi)
        cell = np.clip(np.searchsorted(-azimuth, -turned), 1, _CELLS)

        def beside(theta: Array) -> Array:
            x, y, _ = meets(theta).T
            return y * np.cos(turned) - x * np.sin(turned)

        return meets(bracketed_root(beside, theta[cell - 1], theta[cell], ROOT))[:, 2]

    def contact_line(self, theta: Array) -> ContactLine:
        """Return where the roller presses, from its end to the edge (see `RollerWall`)."""
        low = np.full(len(theta), self.cam.inner)
        return ContactLine.between(low, self.edge(theta), 1, partial(self.contact, theta))

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
