"""What cuts the undercut walls of a globoidal cam: rollers at many cam angles, by their corners.

Depends on hulls, globoidal and its surface; numpy only.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gearcam.laws.phases_of_lift import TURN
from gearcam.numeric.arrays import Array
from gearcam.numeric.mesh import Mesh
from gearcam.spatial.globoidal import GloboidalCam
from gearcam.spatial.globoidal_surface import MARGIN, blank_surface, rib_angles
from gearcam.spatial.hulls import RollerHulls, left_between, round_hulls

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
    return _hulls(cam, rib_angles(cam, steps), steps, places).corners


def uncut_surface(cam: GloboidalCam, steps: int) -> Mesh:
    """Return the surface of what the rollers cut: a little more than the cam, without a bore.

    Parameters
    ----------
    cam : GloboidalCam
        The cam.
    steps : int
        Number of chords around it.

    Returns
    -------
    Mesh
    """
    margin = MARGIN * (cam.top - cam.half_length)
    return blank_surface(cam, 0.0, steps, margin)


def scallop(cam: GloboidalCam, steps: int, places: int) -> float:
    """Return the largest height of the metal left between two positions of a roller, mm.

    Measured at the middles of the steps.

    Parameters
    ----------
    cam, steps, places
        As of `roller_corners`.
    """
    theta = rib_angles(cam, steps)
    before, after = (_hulls(cam, at, steps, places) for at in (theta[:-1], theta[1:]))
    middle = 0.5 * (theta[:-1] + theta[1:])
    x = np.tile(np.linspace(*cam.places, 2 * places - 1), (len(middle), 1))
    worst = 0.0
    for wall in cam.walls:
        touched = wall.contact(middle, x)
        height = left_between(before, after, touched)[cam.inside(touched.points)]
        worst = max(worst, float(height.max()))
    return worst


def _hulls(cam: GloboidalCam, theta: Array, steps: int, places: int) -> RollerHulls:
    """Return the roller that is followed, from outside of all that is cut to below the floor."""
    outside = (1.0 - 2.0 * MARGIN) * cam.top
    first = math.sqrt(max(0.0, outside**2 - cam.tool.radius**2))
    made = round_hulls(cam, 1, theta, (first, cam.places[1]), _AROUND)
    x = np.linspace(*cam.places, places)
    return made.more(*(made.touching(wall, x, TURN / steps) for wall in cam.walls))
