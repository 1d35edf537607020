"""The scene of a cam in space: its outside, unrolled, and the roller that runs along it.

The solids move in space: the cam turns, the roller is lifted.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.kinds.gridded_scene import turning, unrolled_scene
from gearcam.kinds.spatial_cam.drawn import centers, picture, rollers
from gearcam.numeric.pose import Pose
from gearcam.pictures.drawings import FOLLOWER
from gearcam.pictures.scenes import PLACES, MovingBody, Scene

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.build import SpatialCamResult
    from gearcam.numeric.arrays import Array
    from gearcam.numeric.pose import SpacePose

ROLLER: Final = "roller"
"""Name of its solid; of two, those at a rib, the beginning of their names."""

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
    return unrolled_scene(result, theta, sheet, follower, in_space(result, theta), _EYE)


def in_space(result: SpatialCamResult, theta: Array) -> dict[str, SpacePose]:
    """Return the poses of the solids of a cam in space.

    Parameters
    ----------
    result : SpatialCamResult
        The cam.
    theta : (n,) array, rad
        Cam angles.

    Returns
    -------
    dict of str to SpacePose
        Of the cam and of the roller or rollers, by name.
    """
    carried = result.cam.guide.pose(result.program.derivatives(theta, 0)[0])
    up = np.array([0.0, 0.0, 0.5 * result.cam.apart])
    beside = {f"{ROLLER}_upper": up, f"{ROLLER}_lower": -up} if up.any() else {ROLLER: up}
    poses = {name: replace(carried, shift=carried.shift + way) for name, way in beside.items()}
    return turning(result.cam, theta, poses)
