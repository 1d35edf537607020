"""What is drawn of a cam in space: its outside, unrolled.

The sheet is seen from outside and wraps round the cylinder as it is: from left to right the azimuth
in the cam's frame rises from 0 to 360 deg. Of a cam that turns counter-clockwise the cam angle
therefore runs from right to left.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.kinds.gridded_scene import filled
from gearcam.numeric.pose import Pose
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import BLANK, FOLLOWER, GROOVE, PITCH, Drawing, Feature, Path, place

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.build import SpatialCamResult
    from gearcam.numeric.arrays import Array, Plane
    from gearcam.spatial.cam import SpatialWall

_STEPS: Final = 3600
"""Cam angles of drawn curves."""


def centers(result: SpatialCamResult, theta: Array) -> Plane:
    """Return the centre of the roller on the sheet.

    Parameters
    ----------
    result : SpatialCamResult
        The cam.
    theta : (n,) array, rad
        Cam angles.

    Returns
    -------
    (n,) complex array, mm
    """
    cam = result.cam
    point, _ = cam.guide.placed(result.program.derivatives(theta, 0)[0])
    along = cam.outer_radius * (theta if cam.clockwise else 2.0 * math.pi - theta)
    return along + cam.hand * point[0, :, 1] + 1j * point[0, :, 2]


def edge(result: SpatialCamResult, wall: SpatialWall) -> Plane:
    """Return the edge of a wall on the sheet.

    Parameters
    ----------
    result : SpatialCamResult
        The cam.
    wall : SpatialWall
        One of its walls.

    Returns
    -------
    (n,) complex array, mm
        From the left to the right end.
    """
    radius, turn = result.cam.outer_radius, 2.0 * math.pi
    theta = np.linspace(0.0, turn, _STEPS, endpoint=False)
    points = wall.contact(theta, wall.edge(theta)[:, None]).points[:, 0]
    azimuth = np.arctan2(points[:, 1], points[:, 0]) * result.cam.hand
    order = np.argsort(azimuth % turn)
    x, z = azimuth[order] % turn, points[order, 2]
    at_ends = np.interp(0.0, [x[-1] - turn, x[0]], [z[-1], z[0]])
    x = np.concatenate([[0.0], x, [turn]])
    return radius * x + 1j * np.concatenate([[at_ends], z, [at_ends]])


def _corners(result: SpatialCamResult) -> Plane:
    """Return the corners of the sheet, from the lower left one, counter-clockwise."""
    width, height = 2.0 * math.pi * result.cam.outer_radius, result.design.cam.length
    return np.array([0.0, width, width + 1j * height, 1j * height])


def _path(result: SpatialCamResult) -> Feature:
    """Return the path of the roller's centre."""
    theta = np.linspace(0.0, 2.0 * math.pi, _STEPS + 1)
    return Feature(layer=PITCH, shape=Path(points=centers(result, theta), closed=False))


def developed_drawing(result: SpatialCamResult) -> Drawing:
    """Return the sheet with the edges of the walls and the path of the roller's centre."""
    edges = [
        Feature(layer=wall.key.upper(), shape=Path(points=edge(result, wall), closed=False))
        for wall in result.cam.walls
    ]
    sheet = Feature(layer=BLANK, shape=Path(points=_corners(result)))
    return Drawing(name="developed", features=(sheet, *edges, _path(result)))


def cut_away(result: SpatialCamResult) -> tuple[Feature, ...]:
    """Return what is cut away of the sheet: the groove, or all beside a wall or a rib."""
    corners = _corners(result)
    bottom, top = corners[:2], corners[:1:-1]
    lines = {wall.side: edge(result, wall) for wall in result.cam.walls}
    if result.cam.apart:
        between = (lines[-1], top), (bottom, lines[1])
    else:
        between = ((lines.get(-1, bottom), lines.get(1, top)),)
    return tuple(filled(GROOVE, np.concatenate([low, high[::-1]])) for low, high in between)


def rollers(result: SpatialCamResult) -> tuple[Feature, ...]:
    """Return the roller about the origin, or two above and below it, as they are at the outside."""
    size, apart = 2.0 * result.design.follower.roller_radius, 0.5j * result.cam.apart
    places = (apart, -apart) if apart else (0j,)
    return tuple(
        Feature(layer=FOLLOWER, shape=Circle(center=place, diameter=size)) for place in places
    )


def picture(result: SpatialCamResult) -> Drawing:
    """Return the sheet with what is cut away and the roller at the angle of the design."""
    theta = np.array([result.design.output.pose % (2.0 * math.pi)])
    pose = Pose(0.0, complex(centers(result, theta)[0]))
    shown = place(rollers(result), pose)
    sheet = filled(BLANK, _corners(result))
    return Drawing(name="cam", features=(sheet, *cut_away(result), _path(result), *shown))
