"""The error of walls that are constructed in the developed plane, or drawn round the cylinder.

The usual construction unrolls the cylinder of the mean radius Rm: the centre of the roller runs
along the curve (-Rm*theta + y, z), y and z those of its axis in the fixed frame, and the walls are
the parallels of this curve at the radius of the roller; of a cone at its radius at each depth. The
plane is wrapped back, and the wall of a cylinder is the same at all depths, cut in the radial
direction. The truth is another surface: the error at a point of that wall is its distance from the
nearest position of the roller, less the radius of the roller. Where it is positive the roller has
a *gap*, where it is negative it *jams*.

Source: 000 section 3.4.5, eqs. (3.49)-(3.51), whose condition of undercut lacks a term. Depends on
cam; numpy only.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array
from gearcam.numeric.roots import bracketed_root
from gearcam.spatial.cam import SpatialCam, SpatialWall

_CLOSE: Final = 1e-13
"""Width of the bracket of the nearest position of the roller, rad."""

_SEARCH: Final = 24
"""Positions of the roller to either side that are looked at before."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Developed(ShortRepr):
    """Points of a wall that was constructed in the developed plane, n cam angles by k radii.

    Parameters
    ----------
    theta : (n,) array, rad
        Cam angles.
    radius : (k,) array, mm
        Distances from the cam's axis.
    azimuth, height : (n, k) arrays, rad and mm
        Where the points are, in the frame of the cam.
    error : (n, k) array, mm
        Distance from the true wall along its normal: a gap is positive.
    """

    theta: Array
    radius: Array
    azimuth: Array
    height: Array
    error: Array


def developed(wall: SpatialWall, theta: Array, count: int) -> Developed:
    """Return a wall of the developed plane with its errors.

    Parameters
    ----------
    wall : SpatialWall
        The true wall, of a roller whose axis is parallel to x.
    theta : (n,) array, rad
        Cam angles.
    count : int
        Number of radii, from the roller's inner end to the outside.

    Returns
    -------
    Developed
    """
    cam = wall.cam
    mean = cam.middle
    y, z, y1, z1 = _centers(cam, theta)
    along = mean - y1
    size = np.hypot(along, z1)
    radius = np.linspace(cam.inner, cam.outer_radius, count)
    half = wall.side * cam.tool.radii(radius)
    azimuth = (-theta + y / mean)[:, None] + half * (z1 / size / mean)[:, None]
    height = z[:, None] + half * (along / size)[:, None]
    gap = _gaps(cam, theta[:, None], radius, azimuth, height)
    height -= 0.5 * wall.side * cam.apart
    return Developed(theta=theta, radius=radius, azimuth=azimuth, height=height, error=gap)


def largest_in_plane(cam: SpatialCam, x: float) -> float:
    """Return the largest radius of a roller without undercut in a developed plane, mm.

    Parameters
    ----------
    cam : SpatialCam
        The cam.
    x : float, mm
        Radius of the cylinder that is developed.
    """

    def radius(theta: Array, place: Array) -> Array:
        s, s1, s2 = cam.program.derivatives(theta, 2)
        point, _ = cam.guide.placed(s)
        first = point[1, :, 1:] * s1[:, None]
        second = point[2, :, 1:] * s1[:, None] ** 2 + point[1, :, 1:] * s2[:, None]
        along, up = place[:, 0] - first[:, 0], first[:, 1]
        turning = np.abs(along * second[:, 1] + up * second[:, 0])
        with np.errstate(divide="ignore"):
            return (np.hypot(along, up) ** 3 / turning)[:, None]

    return cam.least(radius, (x, x)).value


def _centers(cam: SpatialCam, theta: Array) -> tuple[Array, Array, Array, Array]:
    """Return y and z of the roller's axis in the fixed frame, and their derivatives."""
    s, s1 = cam.program.derivatives(theta.ravel(), 1)
    point, _ = cam.guide.placed(s)
    found = [*point[0, :, 1:].T, *(point[1, :, 1:] * s1[:, None]).T]
    y, z, y1, z1 = (one.reshape(theta.shape) for one in found)
    return y, z, y1, z1


def _gaps(cam: SpatialCam, theta: Array, radius: Array, azimuth: Array, height: Array) -> Array:
    """Return the distance of points from the nearest roller.

    Parameters
    ----------
    cam : SpatialCam
        The cam.
    theta : (n, 1) array, rad
        Cam angles at which the roller is near.
    radius : (k,) array, mm
        Distances from the axis.
    azimuth, height : (n, k) arrays, rad and mm
        Of the points.
    """
    tool, tangent = cam.tool, math.tan(cam.tool.half_angle)
    cosine = math.cos(cam.tool.half_angle)

    def distance(at: Array) -> tuple[Array, Array]:
        """Return the distance from the roller at cam angles, and its slope."""
        y, z, y1, z1 = _centers(cam, at)
        turn = at + azimuth
        x = radius * np.cos(turn)
        aside, up = radius * np.sin(turn) - y, height - z
        size = np.hypot(aside, up)
        slope = (aside * (x - y1) - up * z1) / size + tangent * radius * np.sin(turn)
        return cosine * (size - tool.radii(x)), cosine * slope

    reach = 1.5 * (tool.radii(radius) / radius)
    shares = np.linspace(-1.0, 1.0, 2 * _SEARCH + 1)
    around = theta[..., None] + reach[:, None] * shares
    looked = np.stack([distance(around[..., j])[0] for j in range(len(shares))], axis=-1)
    best = np.clip(np.argmin(looked, axis=-1), 1, len(shares) - 2)
    low, high = (
        np.take_along_axis(around, (best + step)[..., None], axis=-1)[..., 0] for step in (-1, 1)
    )
    nearest = bracketed_root(lambda at: distance(at)[1], low, high, _CLOSE)
    return distance(nearest)[0]
