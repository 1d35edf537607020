"""The scene of a cam in space: its outside, unrolled, and the roller that runs along it.

The solids move in space: the cam turns, the roller is lifted.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.kinds.gridded_scene import unrolled_scene
from gearcam.kinds.spatial_cam.build import ROLLER
from gearcam.kinds.spatial_cam.drawn import centers, picture, rollers
from gearcam.numeric.pose import Pose
from gearcam.pictures.drawings import FOLLOWER
from gearcam.pictures.scenes import PLACES, MovingBody, Scene

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.build import SpatialCamResult

_EYE: Final = (1.0, -0.8, 0.6)
"""The roller, at the azimuth 0, is in front then."""


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
    sheet = (one for one in picture(result).features if one.kind != FOLLOWER)
    moving = Pose(np.zeros(len(theta)), centers(result, theta))
    follower = MovingBody(name="follower", called=ROLLER, features=rollers(result), pose=moving)
    return unrolled_scene(result, theta, sheet, follower, _EYE)
