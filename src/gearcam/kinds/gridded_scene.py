"""What is drawn of cams in space alike: a sheet, the unrolled cam, and what runs along it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.kinds.gridded import STEM
from gearcam.kinds.gridded_charts import DRIVER
from gearcam.numeric.contour import Contour
from gearcam.numeric.pose import Pose
from gearcam.pictures.drawings import Feature
from gearcam.pictures.scenes import MovingBody, Scene

if TYPE_CHECKING:
    from gearcam.kinds.gridded import GriddedCam
    from gearcam.numeric.arrays import Array, Plane

_TOLERANCE: Final = 1e-3
"""Chord tolerance that the points of drawn curves stand for, mm."""


def filled(layer: str, points: Plane) -> Feature:
    """Return an area on the sheet.

    Parameters
    ----------
    layer : str
        Its layer.
    points : (n,) complex array, mm
        Its outline.
    """
    shape = Contour(dense=tuple, points=points, tolerance=_TOLERANCE, chord_error=0.0)
    return Feature(layer=layer, shape=shape)


def unrolled_scene(
    result: GriddedCam,
    theta: Array,
    sheet: Iterable[Feature],
    follower: MovingBody,
    eye: tuple[float, float, float],
) -> Scene:
    """Return the unrolled cam at rest and what runs along it.

    Parameters
    ----------
    result : GriddedCam
        The cam.
    theta : (n,) array, rad
        Cam angles of a turn with both ends.
    sheet : iterable of Feature
        The unrolled cam.
    follower : MovingBody
        What runs along it.
    eye : (float, float, float)
        Where the solids are seen from.

    Returns
    -------
    Scene
    """
    still = Pose(np.zeros(len(theta)), np.zeros(len(theta), dtype=np.complex128))
    cam = MovingBody(name=STEM, called="cam, unrolled", features=tuple(sheet), pose=still)
    return Scene(
        title=result.design.name,
        driver=DRIVER,
        places=np.degrees(theta),
        closed=True,
        start=math.degrees(result.design.output.pose % (2.0 * math.pi)),
        bodies=(cam, follower),
        in_space=result.in_space(theta),
        eye=eye,
        up=(0.0, 0.0, 1.0),
    )
