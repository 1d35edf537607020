"""A globoidal indexing cam: ribs that lead the rollers of a turret, and their measures.

The turret's axis is perpendicular to the cam's, z, at the *centre distance*; parallel to y. Its
rollers are radial, as many as it has stops. In each turn of the cam it moves by one *pitch*, the
angle between two rollers, and rests for the remainder of the turn. Then the cam's rib lies between
two rollers, at half a pitch below and above the middle plane of the cam.

The roller that stands half a pitch below it as the turn begins is followed over all turns, by the
cam angle Theta from below 0 to beyond a turn: at the cam angle theta the other rollers stand where
it stands at theta + 2*pi*k. What it makes over Theta is therefore the whole cam: one *rib* that
winds over all its length, between the `upper` wall, which is above this roller, and the `lower`
wall of the next roller, which is below that one.

The *place* x along a roller is the distance from the turret's axis. Ribs end at two circles about
this axis in each plane through the cam's axis: the *top*, outside the turret's body, and the
*floor*, up to which the core of the cam is turned so that the ends of the rollers are clear.

Source: 000 section 3.4.1; the walls are derived in `envelope`. Depends on walls, envelope,
extremes, guides and laws; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Final

import numpy as np

from gearcam.laws.indexing import IndexProgram
from gearcam.laws.phases_of_lift import TURN
from gearcam.numeric.arrays import Array, Mask, distinct
from gearcam.numeric.roots import bracketed_root
from gearcam.spatial.envelope import RollerAxis, RollerContact, touched
from gearcam.spatial.extremes import Box, OfPlaces, Spot, boxes_between, lowest
from gearcam.spatial.guides import Turret, carried
from gearcam.spatial.loaded import ContactLine
from gearcam.spatial.walls import ROOT, RollerCam, RollerWall

WORDS: Final = {-1: "upper", 1: "lower"}
"""Words for walls, by the side of the roller that makes them: where they are, seen from it."""

_SCAN: Final = 720
"""Cam angles of a turn at which the beginning and end of the rib are looked for."""

_ALONG: Final = 9
"""Places along a roller at which it is looked whether it is on the cam."""

_AT_EDGE: Final = 0.02
"""Distance from the top or the foot of the rib, as a share of its height, that counts as none when
an extreme has been looked for."""

_TURRET: Final = "axis of the turret"


@dataclass(frozen=True, eq=False, kw_only=True)
class GloboidalCam(RollerCam):
    """A cam that moves a turret by one pitch in each turn (see `RollerCam`).

    Its program is the angle of the turret, its roller a cylinder.

    Parameters
    ----------
    distance : float, mm
        From the cam's axis to that of the turret.
    stops : int
        Number of stops, and of rollers.
    top, reach, floor : float, mm
        Distances from the turret's axis: of the tops of the ribs, where the roller begins to press;
        of the ends of the rollers; of the core.
    length : float, mm
        Of the cam, half of it to each side of the turret's axis.
    hub : float, mm
        Radius of the turret's body, where its rollers begin.
    """

    program: IndexProgram
    distance: float
    stops: int
    top: float
    reach: float
    floor: float
    length: float
    hub: float = 0.0

    @property
    def widest(self) -> float:
        """Largest radius of a roller that is looked for, mm."""
        return self.distance

    @property
    def pitch(self) -> float:
        """Angle between two rollers, rad."""
        return TURN / self.stops

    @property
    def half_length(self) -> float:
        """Height of the upper face, mm."""
        return 0.5 * self.length

    @property
    def middle(self) -> float:
        """The middle of the part of a roller that presses, mm from the turret's axis."""
        return 0.5 * (self.top + self.reach)

    @property
    def guide(self) -> Turret:
        """The turret, with the roller that is followed."""
        return Turret(distance=self.distance, start=-0.5 * self.pitch)

    @cached_property
    def walls(self) -> tuple[GloboidalWall, ...]:
        """The walls, the upper one first."""
        return tuple(GloboidalWall(cam=self, side=side) for side in WORDS)

    def angle(self, theta: Array) -> Array:
        """Return the angle of the roller from the common perpendicular, rad, at cam angles."""
        return self.program.derivatives(theta, 0)[0] - 0.5 * self.pitch

    def axis(self, theta: Array, side: int = 1) -> RollerAxis:  # noqa: ARG002
        """Return the axis of the roller, which makes both walls (see `RollerCam.axis`)."""
        return carried(self.guide, theta, *self.program.derivatives(theta, 2))

    def depth(self, points: Array) -> Array:
        """Return distances from the turret's axis in planes through the cam's axis, mm.

        Parameters
        ----------
        points : (..., 3) array, mm
            Points in the frame of the cam.
        """
        radius = np.hypot(points[..., 0], points[..., 1])
        return np.hypot(self.distance - radius, points[..., 2])

    def inside(self, points: Array) -> Mask:
        """Return which points are in the ring between top and floor, and between the faces.

        Parameters
        ----------
        points : (..., 3) array, mm
            Points in the frame of the cam.
        """
        depth = self.depth(points)
        return (depth >= self.top) & (depth <= self.floor) & self.between_faces(points)

    def between_faces(self, points: Array) -> Mask:
        """Return which points are between the faces, on the cam's side of the turret's axis.

        Parameters
        ----------
        points : (..., 3) array, mm
            Points in the frame of the cam.
        """
        near = np.hypot(points[..., 0], points[..., 1]) < self.distance
        return near & (np.abs(points[..., 2]) <= self.half_length)

    @cached_property
    def span(self) -> tuple[float, float]:
        """Cam angles, rad, before and after which all of the rib is beyond the faces."""
        beyond = self.half_length + 0.1 * (self.top - self.half_length)
        last = math.asin(beyond / self.top)
        turns = 1 + math.ceil((last + self.pitch) / self.pitch)
        theta = TURN * np.linspace(-turns, turns, 2 * turns * _SCAN + 1)
        angle = self.angle(theta)
        on = np.flatnonzero((angle + self.pitch > -last) & (angle < last))
        return float(theta[max(0, on[0] - 1)]), float(theta[min(len(theta) - 1, on[-1] + 1)])

    @property
    def places(self) -> tuple[float, float]:
        """The first and last place along a roller that may be in the ring of the ribs, mm."""
        radius = self.tool.radius
        low = math.sqrt(max(0.0, self.top**2 - radius**2))
        return low, self.floor + radius**2 / (self.distance - self.floor)

    def boxes(self, *, turn: bool = False) -> list[Box]:
        """Return where extremes are looked for: over the whole rib.

        Parameters
        ----------
        turn : bool
            Over one turn and the part of the roller that presses instead. In this turn it goes from
            half a pitch below the middle to half a pitch above it.
        """
        if turn:
            return boxes_between(self.program.cuts, (self.top, self.reach))
        start, end = self.span
        turns = range(math.floor(start / TURN), math.ceil(end / TURN))
        cuts = distinct(*(TURN * k + self.program.cuts for k in turns))
        within = cuts[(cuts > start) & (cuts < end)]
        return boxes_between(np.array([start, *within, end]), self.places)

    @cached_property
    def pressure(self) -> Spot:
        """The largest pressure angle, rad: of the roller that is nearest to the middle."""

        def gentle(theta: Array, x: Array) -> Array:
            return -self.contact(theta, x, 1).pressure  # of both sides alike

        return _placed(lowest(gentle, self.boxes(turn=True)), -1.0)

    @cached_property
    def lost_motion(self) -> Spot:
        """The largest distance by which a roller can move between two walls, mm.

        To first order: the clearance over the cosine of the pressure angle.
        """
        return replace(self.pressure, value=self.clearance / math.cos(self.pressure.value))

    @cached_property
    def least_rib(self) -> Spot:
        """Least thickness of the rib along its normal, mm.

        To first order: the distance of the rollers' axes across the walls, less both radii.
        """
        apart = 2.0 * math.sin(0.5 * self.pitch)

        def thickness(theta: Array, x: Array) -> Array:
            pressure = self.contact(theta, x, 1).pressure
            return apart * x * np.cos(pressure) - 2.0 * self.tool.radius

        return _placed(lowest(thickness, self.boxes(turn=True)))

    @cached_property
    def least_length(self) -> float:
        """Least length, mm, of a cam that holds the turret in both directions at all times.

        Then there is always a roller that presses along its whole length on an upper wall, and one
        on a lower wall.
        """
        return -2.0 * lowest(self._short_of(np.max), self._of_turn).value

    @property
    def grip(self) -> float:
        """Half the length, mm, less the farthest place at which the turret is held at a point.

        Below 0 it is free at some angle.
        """
        return self.half_length + lowest(self._short_of(np.min), self._of_turn).value

    @property
    def _of_turn(self) -> list[Box]:
        return boxes_between(self.program.cuts, (0.0, 0.0))

    def _short_of(self, which: Callable[..., Array]) -> OfPlaces:
        """Return minus how far from the middle the turret is held, by one of its two walls.

        `which` takes from the places along a roller the one that counts.
        """
        turns = TURN * np.arange(-2.0, 3.0)
        x = np.linspace(self.top, self.reach, _ALONG)

        def short(theta: Array, _: Array) -> Array:
            worst = np.zeros(len(theta))
            for side in WORDS:
                every = (theta[:, None] + turns).ravel()
                points = self.contact(every, np.tile(x, (len(every), 1)), side).points
                far = which(np.abs(points[..., 2]), axis=1)
                far[np.abs(self.angle(every)) > 0.5 * math.pi] = math.inf  # behind the turret
                far = far.reshape(len(theta), -1)
                worst = np.maximum(worst, far.min(axis=1))
            return -worst[:, None]

        return short


@dataclass(frozen=True, eq=False, kw_only=True)
class GloboidalWall(RollerWall):
    """A wall of the rib of a cam (see `RollerWall`)."""

    cam: GloboidalCam

    @property
    def key(self) -> str:
        """Name in files and facts: ``upper`` or ``lower``, seen from the roller."""
        return WORDS[self.side]

    def least(self, measure: Callable[[RollerContact], Array]) -> Spot:
        """Return the least value of a measure of its points (see `RollerWall.least`)."""
        cam = self.cam

        def on_rib(theta: Array, x: Array) -> Array:
            contact = self.contact(theta, x)
            return np.where(cam.inside(contact.points), measure(contact), math.inf)

        spot = lowest(on_rib, cam.boxes())
        ends = (self._least_along(depth, measure, spot) for depth in (cam.top, cam.floor))
        return _placed(min(spot, *ends, key=lambda one: one.value))

    def _least_along(
        self, depth: float, measure: Callable[[RollerContact], Array], near: Spot
    ) -> Spot:
        """Return the least value along the top of the rib or its foot, if it is `near` there.

        A grid of cam angles and places does not resolve a value that falls along this edge: its
        points come as near to the edge as they happen to.
        """
        cam, at = self.cam, (np.array([near.theta]), np.array([[near.x]]))
        off = float(cam.depth(self.contact(*at).points)[0, 0]) - depth
        if not (math.isfinite(near.value) and abs(off) < _AT_EDGE * (cam.floor - cam.top)):
            return near

        def on_edge(theta: Array, _: Array) -> Array:
            contact = self.contact(theta, self.place(theta, depth)[:, None])
            on = cam.between_faces(contact.points)
            return np.where(on, measure(contact), math.inf)

        boxes = (box for box in cam.boxes() if box[0] <= near.theta <= box[1])
        found = lowest(on_edge, [(start, end, 0.0, 0.0) for start, end, *_ in boxes])
        x = float(self.place(np.array([found.theta]), depth)[0])
        return min(near, replace(found, x=x), key=lambda one: one.value)

    def place(self, theta: Array, depth: float) -> Array:
        """Return the places along the roller at which it is at a distance from the turret's axis.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        depth : float, mm
            The distance, in planes through the cam's axis.

        Returns
        -------
        (n,) array, mm
        """
        cam, axis = self.cam, self.cam.axis(theta, self.side)

        def beyond(x: Array) -> Array:
            points = touched(axis, cam.tool, x[:, None], self.side).points
            return cam.depth(points[:, 0]) - depth

        ends = np.full(len(theta), 0.0), np.full(len(theta), cam.distance)
        return bracketed_root(beyond, *ends, ROOT * cam.distance)

    def _beyond_face(self, theta: Array, x: Array) -> Array:
        """Return how far places on rollers are beyond the nearer face, mm, (n,)."""
        return np.abs(self.contact(theta, x[:, None]).points[:, 0, 2]) - self.cam.half_length

    def contact_line(self, theta: Array) -> ContactLine:
        """Return where rollers press, from the tops of ribs to their ends (see `RollerWall`).

        A roller that passes a face presses up to this face only.
        """
        cam = self.cam
        # beyond this angle all of a roller is beyond the faces
        last = math.asin(cam.half_length / cam.top) + math.asin(min(1.0, cam.tool.radius / cam.top))
        first = np.ceil((-last - cam.angle(theta)) / cam.pitch)
        turns = np.arange(math.floor(2.0 * last / cam.pitch) + 1.0)
        every = (theta[:, None] + TURN * (first[:, None] + turns)).ravel()
        low = np.maximum(self.place(every, cam.top), cam.hub)
        high = np.full(len(every), cam.reach)
        # along a roller the distance from the middle of the cam only rises
        off = self._beyond_face(every, low) > 0.0
        cut = np.flatnonzero((self._beyond_face(every, high) > 0.0) & ~off)
        at_face = partial(self._beyond_face, every[cut])
        high[cut] = bracketed_root(at_face, low[cut], high[cut], ROOT * cam.distance)
        high = np.where(off, low, high)
        return ContactLine.between(low, high, len(turns), partial(self.contact, every))

    def grid(self, theta: Array, count: int, beyond: float = 0.0) -> RollerContact:
        """Return the wall as a grid, from the top of the rib to the floor.

        Parameters
        ----------
        theta : (n,) array, rad
            Cam angles.
        count : int
            Number of even places along the roller.
        beyond : float, mm
            How far it goes on beyond both.
        """
        cam, share = self.cam, np.linspace(0.0, 1.0, count)
        first = self.place(theta, cam.top - beyond)[:, None]
        last = self.place(theta, cam.floor + beyond)[:, None]
        return self.contact(theta, first + share * (last - first))


def _placed(spot: Spot, factor: float = 1.0) -> Spot:
    """Return an extreme at a cam angle within a turn, measured from the turret's axis."""
    return Spot(theta=spot.theta % TURN, x=spot.x, value=factor * spot.value, start=_TURRET)
