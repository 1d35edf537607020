"""What cuts an undercut wall: the roller at many cam angles, as points with their convex hulls.

Between two of them a scallop remains, a ridge of metal. The points at the ends of a roller lie
where it touches its walls at even places, so that the edges of its hull are lines of the walls'
contact. Without the other wall the roller reaches beyond the face of the blank.

Depends on cam and surface; numpy only.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.spatial.cam import SpatialCam, SpatialWall
from gearcam.spatial.envelope import Roller, RollerAxis
from gearcam.spatial.surface import Cylinder

_COARSE: Final = 24
"""Points all around the roller, where it touches nothing."""

_OUTSIDE: Final = 1.05
"""End of the roller outside the cam, over the radius of the cam."""


def roller_corners(cam: SpatialCam, blank: Cylinder, steps: int, places: int) -> Array:
    """Return the corners of the roller at even cam angles, (steps or more, n, 3), mm.

    Parameters
    ----------
    cam : SpatialCam
        The cam.
    blank : Cylinder
        What it is made from.
    steps : int
        Number of even cam angles.
    places : int
        Places along the roller at which its walls are touched, and on the rim of its end from
        the floor to the foot of a wall.
    """
    theta = np.linspace(0.0, 2.0 * math.pi, steps, endpoint=False)
    if len(cam.sides) > 1 and not cam.apart:
        angles = np.concatenate([_touching(wall, theta, places) for wall in cam.walls], axis=1)
        return _corners(cam, theta, angles, 1)
    made = []
    for wall in cam.walls:
        near = _corners(cam, theta, _touching(wall, theta, places), wall.side)
        far = near - [0.0, 0.0, 2.0 * wall.side * blank.length]
        made.append(np.concatenate([near, far], axis=1))
    return np.concatenate(made)


def scallop(cam: SpatialCam, steps: int, places: int) -> float:
    """Return the largest height of the metal left between two positions of the roller, mm.

    With the chord error of its hull; measured at the middles of the steps.

    Parameters
    ----------
    cam, steps, places
        As of `roller_corners`.
    """
    step = 2.0 * math.pi / steps
    theta, worst = step * np.arange(float(steps)), 0.0
    for wall in cam.walls:
        x = np.tile(_along(cam, places), (steps, 1))
        points = wall.contact(theta + 0.5 * step, x).points
        heights = [
            beyond_roller(cam.axis(near, wall.side), cam.tool, points)
            for near in (theta, theta + step)
        ]
        angle = np.abs(np.diff(_touching(wall, theta, places)[:, :places], axis=1)).max()
        chord = cam.tool.radius_at(cam.outer_radius) * (1.0 - math.cos(0.5 * float(angle)))
        worst = max(worst, float(np.minimum(*heights).max()) + chord)
    return worst


def beyond_roller(axis: RollerAxis, roller: Roller, points: Array) -> Array:
    """Return how far points are outside a roller, (n, k), mm; below 0 they are inside.

    Parameters
    ----------
    axis : RollerAxis
        Its axis at n cam angles.
    roller : Roller
        Its shape.
    points : (n, k, 3) array, mm
        Points for each of these, in the frame of the cam.
    """
    beside = points - axis.point[0][:, None, :]
    at = np.einsum("nki,ni->nk", beside, axis.direction[0])
    far = np.linalg.norm(beside - at[..., None] * axis.direction[0][:, None, :], axis=-1)
    return math.cos(roller.half_angle) * (far - roller.radii(at))


def _along(cam: SpatialCam, places: int) -> Array:
    return np.linspace(cam.floor, cam.outer_radius, places)


def _touching(wall: SpatialWall, theta: Array, places: int) -> Array:
    """Return the directions around the roller, rad, in which it touches a wall and the ramp.

    From the cam's axis upwards towards the tangent of its turning.
    """
    axis = wall.cam.axis(theta, wall.side)
    contact = wall.contact(theta, np.tile(_along(wall.cam, places), (len(theta), 1)))
    across = np.cross([0.0, 0.0, 1.0], axis.direction[0])
    beside = np.einsum("nki,ni->nk", contact.radial, across)
    angles = np.arctan2(beside, wall.side * contact.radial[..., 2])
    foot = angles[:, :1] * np.linspace(0.0, 1.0, places, endpoint=False)
    both = np.concatenate([angles, foot], axis=1)
    return both if wall.side > 0 else math.pi - both


def _corners(cam: SpatialCam, theta: Array, angles: Array, side: int) -> Array:
    around = np.linspace(0.0, 2.0 * math.pi, _COARSE, endpoint=False)
    every = np.concatenate([angles, np.tile(around, (len(theta), 1))], axis=1)
    axis = cam.axis(theta, side)
    point, direction = axis.point[0][:, None, :], axis.direction[0][:, None, :]
    up = np.array([0.0, 0.0, 1.0])
    way = np.sin(every)[..., None] * np.cross(up, direction) + np.cos(every)[..., None] * up
    ends = cam.floor, _OUTSIDE * cam.outer_radius
    return np.concatenate(
        [point + x * direction + cam.tool.radius_at(x) * way for x in ends], axis=1
    )
