"""What cuts the undercut walls of a globoidal cam: rollers at many cam angles, by their corners.

As `carving` does for cylinder cams: the points at the ends of a roller lie where it touches its
walls at even places, and between two positions a scallop remains.

Depends on carving, globoidal and its surface; numpy only.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.spatial.carving import beyond_roller
from gearcam.spatial.globoidal import GloboidalCam
from gearcam.spatial.globoidal_surface import MARGIN, blank_surface, rib_angles
from gearcam.spatial.surface import Surface

_AROUND: Final = 64
"""Points all around the roller: near a line of contact their chords are closer than a scallop."""


def roller_corners(cam: GloboidalCam, steps: int, places: int) -> Array:
    """Return the corners of the rollers over the whole cam, (n, m, 3), mm.

    Parameters
    ----------
    cam : GloboidalCam
        The cam.
    steps : int
        Number of even cam angles in a turn.
    places : int
        Places along the roller at which its walls are touched.
    """
    theta = rib_angles(cam, steps)
    axis, (first, second) = cam.axis(theta), _across(cam, theta)
    x = np.tile(np.linspace(*cam.places, places), (len(theta), 1))
    around = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    every = [np.tile(around, (len(theta), 1))]
    for wall in cam.walls:
        radial = wall.contact(theta, x).radial
        every.append(
            np.arctan2(
                np.einsum("nki,ni->nk", radial, second), np.einsum("nki,ni->nk", radial, first)
            )
        )
    angle = np.concatenate(every, axis=1)[..., None]
    way = np.cos(angle) * first[:, None, :] + np.sin(angle) * second[:, None, :]
    point, direction = axis.point[0][:, None, :], axis.direction[0][:, None, :]
    # from outside of all that is cut to below the floor
    outside = (1.0 - 2.0 * MARGIN) * cam.top
    ends = math.sqrt(max(0.0, outside**2 - cam.tool.radius**2)), cam.places[1]
    return np.concatenate([point + end * direction + cam.tool.radius * way for end in ends], axis=1)


def uncut_surface(cam: GloboidalCam, steps: int) -> Surface:
    """Return the surface of what the rollers cut: a little more than the cam, without a bore.

    Parameters
    ----------
    cam : GloboidalCam
        The cam.
    steps : int
        Number of chords around it.

    Returns
    -------
    Surface
    """
    margin = MARGIN * (cam.top - cam.half_length)
    return blank_surface(cam, 0.0, steps, margin)


def scallop(cam: GloboidalCam, steps: int, places: int) -> float:
    """Return the largest height of the metal left between two positions of a roller, mm.

    With the chord error of its hull; measured at the middles of the steps.

    Parameters
    ----------
    cam, steps, places
        As of `roller_corners`.
    """
    theta = rib_angles(cam, steps)
    middle = 0.5 * (theta[:-1] + theta[1:])
    x = np.tile(np.linspace(*cam.places, places), (len(middle), 1))
    worst = 0.0
    for wall in cam.walls:
        points = wall.contact(middle, x).points
        heights = [
            beyond_roller(cam.axis(near), cam.tool, points) for near in (theta[:-1], theta[1:])
        ]
        height = np.minimum(*heights)[cam.inside(points)].max()
        # half the chord between neighbouring directions of contact
        half = 0.5 * np.linalg.norm(np.diff(wall.contact(middle, x).radial, axis=1), axis=-1).max()
        chord = cam.tool.radius * (1.0 - math.sqrt(1.0 - float(half) ** 2))
        worst = max(worst, float(height) + chord)
    return worst


def _across(cam: GloboidalCam, theta: Array) -> tuple[Array, Array]:
    """Return two unit directions across the roller: along the turret's axis is the second."""
    zero = np.zeros_like(theta)
    second = np.stack([np.sin(theta), np.cos(theta), zero], axis=1)
    first = np.asarray(np.cross(second, cam.axis(theta).direction[0]), dtype=np.float64)
    return first, second
