"""What cuts an undercut wall of a cylinder cam: the roller at many cam angles, by its corners.

Without the other wall the roller reaches beyond the face of the blank.

Depends on hulls, cam and surface; numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.spatial.cam import SpatialCam, SpatialWall
from gearcam.spatial.hulls import RollerHulls, left_between, round_hulls
from gearcam.spatial.surface import Cylinder

_COARSE: Final = 24
"""Corners all around the roller, where it touches nothing."""

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
    theta, made = _even(steps)[:-1], []
    for walls in _made_together(cam):
        corners = _hulls(walls, theta, places).corners
        if len(walls) == 1:
            far = corners - [0.0, 0.0, 2.0 * walls[0].side * blank.length]
            corners = np.concatenate([corners, far], axis=1)
        made.append(corners)
    return np.concatenate(made)


def scallop(cam: SpatialCam, steps: int, places: int) -> float:
    """Return the largest height of the metal left between two positions of the roller, mm.

    Measured at the middles of the steps.

    Parameters
    ----------
    cam, steps, places
        As of `roller_corners`.
    """
    theta, worst = _even(steps), 0.0
    middle, x = 0.5 * (theta[:-1] + theta[1:]), _along(cam, 2 * places - 1)
    for walls in _made_together(cam):
        before, after = (_hulls(walls, at, places) for at in (theta[:-1], theta[1:]))
        for wall in walls:
            touched = wall.contact(middle, np.tile(x, (steps, 1)))
            worst = max(worst, float(left_between(before, after, touched).max()))
    return worst


def _even(steps: int) -> Array:
    return np.linspace(0.0, 2.0 * math.pi, steps + 1)


def _along(cam: SpatialCam, places: int) -> Array:
    return np.linspace(cam.floor, cam.outer_radius, places)


def _made_together(cam: SpatialCam) -> list[tuple[SpatialWall, ...]]:
    """Return the walls that one roller makes; those of a rib are made by two."""
    return [(wall,) for wall in cam.walls] if cam.apart else [cam.walls]


def _hulls(walls: Sequence[SpatialWall], theta: Array, places: int) -> RollerHulls:
    """Return the roller, with corners that follow its walls and the ramps below their feet."""
    cam, x, step = walls[0].cam, _along(walls[0].cam, places), theta[1] - theta[0]
    ends = cam.floor, _OUTSIDE * cam.outer_radius
    made = round_hulls(cam, walls[0].side, theta, ends, _COARSE)
    angles = []
    for wall in walls:
        touching = made.touching(wall, x, step)
        # from the direction along the cam, in which it cuts the floor, to the foot of the wall
        along = math.pi if wall.side > 0 else 0.0
        turned = np.mod(touching[:, :1] - along + math.pi, 2.0 * math.pi) - math.pi
        angles += [touching, along + turned * np.linspace(0.0, 1.0, places, endpoint=False)]
    return made.more(*angles)
