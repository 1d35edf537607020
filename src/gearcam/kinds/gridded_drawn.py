"""What is drawn of cams in space alike: charts, the unrolled cam and what runs along it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.kinds.gridded import STEM
from gearcam.kinds.over_driver import over_driver
from gearcam.numeric.contour import Contour
from gearcam.numeric.pose import Pose
from gearcam.pictures.charts import Chart, Limit, Line
from gearcam.pictures.drawings import Feature
from gearcam.pictures.scenes import PLACES, MovingBody, Scene

if TYPE_CHECKING:
    from gearcam.kinds.gridded import GriddedCam
    from gearcam.numeric.arrays import Array, Plane


def motion_chart(result: GriddedCam, name: str, title: str, called: str = "") -> Chart:
    """Return the chart of a column of the motion.

    Parameters
    ----------
    result : GriddedCam
        The cam.
    name : str
        Beginning of the column's name.
    title : str
        Title.
    called : str
        What stands on the axis, if not the name.
    """
    table = result.motion()
    column = next(one for one in table if one.startswith(name))
    unit = column.removeprefix(f"{name}_").replace("_per_", "/")
    return over_driver(result)(
        title=title,
        y=f"{called or name}, {unit}",
        lines=(Line(label=name, x=table["theta_deg"], y=table[column]),),
    )


def pressure_chart(
    result: GriddedCam, title: str, labels: Mapping[str, str], limit: float
) -> Chart:
    """Return the chart of the pressure angle at places along the roller.

    Parameters
    ----------
    result : GriddedCam
        The cam.
    title : str
        Title.
    labels : mapping of str to str
        What the places are called, by their names in columns.
    limit : float, rad
        The largest that is allowed.
    """
    table = result.motion()
    return over_driver(result)(
        title=title,
        y="pressure angle, deg",
        lines=tuple(
            Line(label=label, x=table["theta_deg"], y=table[f"pressure_angle_{word}_deg"])
            for word, label in labels.items()
        ),
        limits=(Limit(label="limit", value=math.degrees(limit)),),
    )


def spread_chart(result: GriddedCam, title: str, places: Mapping[str, float]) -> Chart:
    """Return the chart of the walls' margin against undercut: how much they spread.

    Parameters
    ----------
    result : GriddedCam
        The cam.
    title : str
        Title.
    places : mapping of str to float, mm
        Places along the roller by what they are called.
    """
    theta = result.angles
    lines = []
    for wall in result.cam.walls:
        for label, x in places.items():
            spread = wall.contact(theta, np.full((len(theta), 1), x)).spread[:, 0]
            lines.append(Line(label=f"{wall.key} wall, {label}", x=np.degrees(theta), y=spread))
    return over_driver(result)(
        title=title,
        y="margin, mm",
        lines=tuple(lines),
        limits=(Limit(label="undercut", value=0.0),),
    )


_DRAFTED: Final = 480
"""Cam angles of a turn at which the curves of a draft are drawn: to some 0.01 mm."""


def drawn_steps(most: int, places: int) -> int:
    """Return at how many cam angles of a turn the curves of a scene are drawn.

    Parameters
    ----------
    most : int
        In a picture.
    places : int
        Steps of the cam angle in the scene; that of a draft has few.
    """
    return most if places >= PLACES else min(most, _DRAFTED)


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
        driver=result.driver.label,
        places=np.degrees(theta),
        closed=True,
        start=math.degrees(result.design.output.pose % (2.0 * math.pi)),
        bodies=(cam, follower),
        in_space=result.in_space(theta),
        eye=eye,
        up=(0.0, 0.0, 1.0),
    )
