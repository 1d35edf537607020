"""Rollers at many cam angles as convex hulls, which cut undercut walls, and what they leave.

A hull has corners on the rims of both ends of the roller. They lie in the directions in which the
roller touches its walls at even places, so that edges of the hull are lines of contact. A wall's
points half a step away are beside these lines. Where the lines are parallel, as in a dwell, no
other corner is near: the hull gets corners in the directions of the first and last of such points
too, or it would leave a face on either side that slopes away from the wall.

Between two positions a *scallop* remains, a ridge of metal. It is highest near the middle of a
step: there it is as high as it is far from the wall, along its normal, to the nearer hull.

Depends on walls; numpy only.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array
from gearcam.spatial.envelope import Roller, RollerAxis, RollerContact
from gearcam.spatial.walls import RollerCam, RollerWall


@dataclass(frozen=True, eq=False, kw_only=True)
class RollerHulls(ShortRepr):
    """A roller at n cam angles, each time as the convex hull of corners on both its rims.

    Parameters
    ----------
    theta : (n,) array, rad
        The cam angles.
    axis : RollerAxis
        Its axis there.
    roller : Roller
        Its shape.
    angles : (n, m) array, rad
        Directions of the corners across its axis, from that at right angles to the way round the
        cam towards this way.
    ends : (float, float), mm
        Its ends.
    """

    theta: Array
    axis: RollerAxis
    roller: Roller
    angles: Array
    ends: tuple[float, float]

    @cached_property
    def _across(self) -> tuple[Array, Array]:
        """Two unit directions across the axis, (n, 3); the second is the way round the cam."""
        second = np.stack([np.sin(self.theta), np.cos(self.theta), np.zeros_like(self.theta)], 1)
        first = np.asarray(np.cross(second, self.axis.direction[0]), dtype=np.float64)
        return first, second

    @property
    def corners(self) -> Array:
        """The corners, (n, 2*m, 3), mm."""
        first, second = (one[:, None, :] for one in self._across)
        angle = self.angles[..., None]
        way = np.cos(angle) * first + np.sin(angle) * second
        point, direction = self.axis.point[0][:, None, :], self.axis.direction[0][:, None, :]
        return np.concatenate(
            [point + x * direction + self.roller.radius_at(x) * way for x in self.ends], axis=1
        )

    def seen(self, points: Array) -> tuple[Array, Array, Array]:
        """Return where points are: along the axis and from it, mm, and in which direction, rad.

        Parameters
        ----------
        points : (n, k, 3) array, mm
            Points for each cam angle, in the frame of the cam.

        Returns
        -------
        along, far, angle : (n, k) arrays
        """
        beside = points - self.axis.point[0][:, None, :]
        along, x, y = (
            np.einsum("nki,ni->nk", beside, way) for way in (self.axis.direction[0], *self._across)
        )
        return along, np.hypot(x, y), np.arctan2(y, x)

    def touching(self, wall: RollerWall, x: Array, step: float) -> Array:
        """Return the directions in which corners follow a wall, (n, k + 4), rad.

        Parameters
        ----------
        wall : RollerWall
            The wall.
        x : (k,) array, mm
            Places along the roller.
        step : float, rad
            From one cam angle to the next; about that half of it before and after counts.

        Returns
        -------
        (n, k + 4) array
            At the places in their order, then beside the first and last one.
        """
        ends = x[[0, -1]]
        seen = [
            self.seen(wall.contact(self.theta + off, np.tile(at, (len(self.theta), 1))).points)
            for off, at in ((0.0, x), (-0.5 * step, ends), (0.5 * step, ends))
        ]
        return np.concatenate([angle for _, _, angle in seen], axis=1)

    def more(self, *angles: Array) -> RollerHulls:
        """Return the hulls with corners in more directions, (n, k) arrays, rad."""
        return replace(self, angles=np.concatenate([self.angles, *angles], axis=1))

    def faces(self, points: Array) -> tuple[Array, Array]:
        """Return the faces of the hulls in whose sectors of directions points are.

        Parameters
        ----------
        points : (n, k, 3) array, mm
            As of `seen`.

        Returns
        -------
        off : (n, k) array, mm
            How far the points are outside their planes.
        normals : (n, k, 3) array
            Their unit normals outwards.
        """
        along, far, angle = self.seen(points)
        around = np.sort(self.angles % (2.0 * math.pi), axis=1)
        after = (around[:, None, :] <= (angle % (2.0 * math.pi))[..., None]).sum(axis=-1)
        rows = np.arange(len(around))[:, None]
        low, high = (around[rows, k % around.shape[1]] for k in (after - 1, after))
        half = 0.5 * ((high - low) % (2.0 * math.pi))
        middle = low + half
        first, second = (one[:, None, :] for one in self._across)
        direction = self.axis.direction[0][:, None, :]
        # a face of a cone leans by its slope
        slope = math.tan(self.roller.half_angle) * np.cos(half)
        size = np.hypot(1.0, slope)
        off = far * np.cos(angle - middle) - self.roller.radii(along) * np.cos(half)
        c, s = np.cos(middle)[..., None], np.sin(middle)[..., None]
        normals = c * first + s * second - slope[..., None] * direction
        return off / size, normals / size[..., None]

    def left_on(self, wall: RollerContact) -> Array:
        """Return how much these hulls leave on a wall along its normal, (n, k), mm.

        Parameters
        ----------
        wall : RollerContact
            Points of the wall, at other cam angles.
        """
        off, normals = self.faces(wall.points)
        return off / (normals * wall.normals).sum(axis=-1)


def round_hulls(
    cam: RollerCam, side: int, theta: Array, ends: tuple[float, float], count: int
) -> RollerHulls:
    """Return the hulls of a cam's tool with corners in even directions.

    Parameters
    ----------
    cam : RollerCam
        The cam.
    side : {1, -1}
        The wall that it makes.
    theta : (n,) array, rad
        Cam angles.
    ends : (float, float), mm
        Ends of the roller.
    count : int
        Number of the directions.
    """
    even = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    angles = np.tile(even, (len(theta), 1))
    axis = cam.axis(theta, side)
    return RollerHulls(theta=theta, axis=axis, roller=cam.tool, angles=angles, ends=ends)


def left_between(before: RollerHulls, after: RollerHulls, wall: RollerContact) -> Array:
    """Return the heights of what two positions of a roller leave on a wall, (n, k), mm.

    Parameters
    ----------
    before, after : RollerHulls
        The roller at n cam angles, and one step later.
    wall : RollerContact
        Points of the wall between them.
    """
    return np.minimum(before.left_on(wall), after.left_on(wall))
