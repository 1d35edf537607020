"""The scene of a globoidal cam: its globoid, unrolled, and the rollers that run along it.

The solids move in space: the cam turns, and the turret with it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.kinds.globoidal_cam.build import TURRET
from gearcam.kinds.globoidal_cam.drawn import center, grooves, paths, rollers, sheet
from gearcam.kinds.gridded_scene import unrolled_scene
from gearcam.laws.phases_of_lift import TURN
from gearcam.numeric.pose import Pose
from gearcam.pictures.scenes import PLACES, MovingBody, Scene

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.build import GloboidalCamResult

_EYE: Final = (0.45, -1.0, 0.55)
"""Cam and turret are beside each other then, and rollers between the ribs are seen."""


def scene(result: GloboidalCamResult, places: int = PLACES) -> Scene:
    """Return the unrolled cam at rest and the rollers along it.

    Parameters
    ----------
    result : GloboidalCamResult
        The cam.
    places : int
        Steps of the cam angle.

    Returns
    -------
    Scene
    """
    theta, cam = np.linspace(0.0, TURN, places + 1), result.cam
    sheet_of = (sheet(cam), *grooves(cam), *paths(cam))
    # the end of the turn, at which the next roller is where this one began
    moving = Pose(np.zeros(len(theta)), center(cam, theta))
    turret = MovingBody(name=TURRET, called="rollers", features=rollers(cam), pose=moving)
    return unrolled_scene(result, theta, sheet_of, turret, _EYE)
