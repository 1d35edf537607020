"""The scene of a cam in space: its outside, unrolled, and the roller that runs along it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from gearcam.kinds.spatial_cam.charts import DRIVER
from gearcam.kinds.spatial_cam.drawn import centers, picture, rollers
from gearcam.numeric.pose import Pose
from gearcam.pictures.drawings import FOLLOWER
from gearcam.pictures.scenes import PLACES, MovingBody, Scene

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.build import SpatialCamResult


def scene(result: SpatialCamResult, places: int = PLACES) -> Scene:
    """Return the unrolled cam at rest and the roller along it.

    Parameters
    ----------
    result : SpatialCamResult
        The cam.
    places : int
        Steps of the cam angle.

    Returns
    -------
    Scene
    """
    theta = np.linspace(0.0, 2.0 * math.pi, places + 1)
    still = Pose(np.zeros(len(theta)), np.zeros(len(theta), dtype=np.complex128))
    sheet = tuple(one for one in picture(result).features if one.kind != FOLLOWER)
    cam = MovingBody(name="cam", called="cam, unrolled", features=sheet, pose=still)
    moving = Pose(np.zeros(len(theta)), centers(result, theta))
    follower = MovingBody(name="follower", called="roller", features=rollers(result), pose=moving)
    return Scene(
        title=result.design.name,
        driver=DRIVER,
        places=np.degrees(theta),
        closed=True,
        start=math.degrees(result.design.output.pose % (2.0 * math.pi)),
        bodies=(cam, follower),
    )
