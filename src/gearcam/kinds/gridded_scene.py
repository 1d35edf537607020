"""What is drawn and moved of cams in space alike: a sheet, the unrolled cam, and what runs on it.

The solids move in space: the cam turns, and its follower moves with it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.kinds.gridded import STEM
from gearcam.kinds.gridded_charts import DRIVER
from gearcam.numeric.contour import Contour
from gearcam.numeric.pose import Pose, SpacePose
from gearcam.pictures.drawings import Feature
from gearcam.pictures.scenes import MovingBody, Scene

if TYPE_CHECKING:
    from gearcam.kinds.gridded import GriddedCam
    from gearcam.numeric.arrays import Array, Plane
    from gearcam.spatial.walls import RollerCam

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
    in_space: Mapping[str, SpacePose],
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
    in_space : mapping of str to SpacePose
        Poses of the solids.
    eye : (float, float, float)
        Where they are seen from.

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
        in_space=in_space,
        eye=eye,
        up=(0.0, 0.0, 1.0),
    )


def turning(cam: RollerCam, theta: Array, others: Mapping[str, SpacePose]) -> dict[str, SpacePose]:
    """Return the poses of the solids of a cam that turns.

    Parameters
    ----------
    cam : RollerCam
        The cam.
    theta : (n,) array, rad
        Cam angles.
    others : mapping of str to SpacePose
        Poses of the other solids by name, beside a cam that turns counter-clockwise.

    Returns
    -------
    dict of str to SpacePose
        Of the cam and of the others.
    """
    turned = SpacePose((0.0, 0.0, 1.0), theta, np.zeros((len(theta), 3)))
    poses = {STEM: turned, **others}
    return {name: one.mirrored if cam.clockwise else one for name, one in poses.items()}
