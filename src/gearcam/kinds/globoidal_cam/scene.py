"""The scene of a globoidal cam: its globoid, unrolled, and the rollers that run along it.

The solids move in space: the cam turns, and the turret with it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.kinds.globoidal_cam.build import CAM, TURRET
from gearcam.kinds.globoidal_cam.drawn import center, grooves, paths, rollers, sheet
from gearcam.kinds.gridded_charts import DRIVER
from gearcam.laws.phases_of_lift import TURN
from gearcam.numeric.pose import Pose, SpacePose
from gearcam.pictures.scenes import PLACES, MovingBody, Scene

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.build import GloboidalCamResult
    from gearcam.numeric.arrays import Array

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
    theta, made = np.linspace(0.0, TURN, places + 1), result.cam
    zero = np.zeros(len(theta))
    features = (sheet(made), *grooves(made), *paths(made))
    still = Pose(zero, np.zeros(len(theta), dtype=np.complex128))
    cam = MovingBody(name=CAM, called="cam, unrolled", features=features, pose=still)
    # the end of the turn, at which the next roller is where this one began
    moving = Pose(zero, center(made, theta))
    turret = MovingBody(name=TURRET, called="rollers", features=rollers(made), pose=moving)
    return Scene(
        title=result.design.name,
        driver=DRIVER,
        places=np.degrees(theta),
        closed=True,
        start=math.degrees(result.design.output.pose % TURN),
        bodies=(cam, turret),
        in_space=in_space(result, theta),
        eye=_EYE,
        up=(0.0, 0.0, 1.0),
    )


def in_space(result: GloboidalCamResult, theta: Array) -> dict[str, SpacePose]:
    """Return the poses of the solids.

    Parameters
    ----------
    result : GloboidalCamResult
        The cam.
    theta : (n,) array, rad
        Cam angles.

    Returns
    -------
    dict of str to SpacePose
        Of the cam and of the turret, by name.
    """
    cam = result.cam
    poses = {
        CAM: SpacePose((0.0, 0.0, 1.0), theta, np.zeros((len(theta), 3))),
        TURRET: cam.guide.pose(cam.program.derivatives(theta, 0)[0]),
    }
    return {name: one.mirrored if cam.clockwise else one for name, one in poses.items()}
