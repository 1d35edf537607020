"""What is drawn of a cam in space: charts over the cam angle, its sheet, its scene.

The sheet is the outside of the cam, unrolled, seen from outside, and wraps round the cylinder as it
is: from left to right the azimuth in the cam's frame rises from 0 to 360 deg. Of a cam that turns
counter-clockwise the cam angle therefore runs from right to left. In the scene the sheet is at rest
and the roller runs along it; the solids move in space: the cam turns, the roller is lifted.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.kinds.gridded_drawn import (
    drawn_steps,
    filled,
    motion_chart,
    pressure_chart,
    spread_chart,
    unrolled_scene,
)
from gearcam.kinds.over_driver import lift_handles
from gearcam.kinds.spatial_cam.result import ROLLER
from gearcam.numeric.pose import Pose
from gearcam.parts.shapes import Circle
from gearcam.pictures.charts import Chart, Charts
from gearcam.pictures.drawings import BLANK, FOLLOWER, GROOVE, PITCH, Drawing, Feature, Path, place
from gearcam.pictures.scenes import PLACES, MovingBody, Scene
from gearcam.spatial import checks

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.result import SpatialCamResult
    from gearcam.numeric.arrays import Array, Plane
    from gearcam.sheets.sheet import Sheet
    from gearcam.spatial.cam import SpatialWall


def _pressure(result: SpatialCamResult) -> Chart:
    labels = {"inner": "at the roller's inner end", "mean": "in the middle", "outer": "outside"}
    limit = checks.allowed_pressure(result.cam, result.design.limits)
    return pressure_chart(result, "Pressure angle", labels, limit)


def _spread(result: SpatialCamResult) -> Chart:
    places = {"floor": result.cam.floor, "outside": result.cam.outer_radius}
    return spread_chart(result, "Margin of the walls against undercut", places)


_MOTION: Final[Charts] = {
    name: partial(motion_chart, name=name, title=f"{name.capitalize()} of the follower")
    for name in ("lift", "velocity", "acceleration", "jerk")
}


def _lift(result: SpatialCamResult) -> Chart:
    handles = lift_handles(result.driver, result.lift_unit, result.design.motion)
    return replace(_MOTION["lift"](result), handles=(*handles,))


CHARTS: Final[Charts] = {
    "lift": _lift,
    "pressure_angle": _pressure,
    "spread": _spread,
    **{name: one for name, one in _MOTION.items() if name != "lift"},
}
"""Charts by name; the report leads with the first three."""


_STEPS: Final = 3600
"""Cam angles of drawn curves."""


def centers(result: SpatialCamResult, theta: Array) -> Plane:
    """Return the centre of the roller on the sheet.

    Parameters
    ----------
    result : SpatialCamResult
        The cam.
    theta : (n,) array, rad
        Cam angles.

    Returns
    -------
    (n,) complex array, mm
    """
    cam = result.cam
    point, _ = cam.guide.placed(result.program.derivatives(theta, 0)[0])
    along = cam.outer_radius * (theta if cam.clockwise else 2.0 * math.pi - theta)
    return along + cam.hand * point[0, :, 1] + 1j * point[0, :, 2]


def edge(result: SpatialCamResult, wall: SpatialWall, steps: int = _STEPS) -> Plane:
    """Return the edge of a wall on the sheet.

    Parameters
    ----------
    result : SpatialCamResult
        The cam.
    wall : SpatialWall
        One of its walls.
    steps : int
        Number of cam angles.

    Returns
    -------
    (n,) complex array, mm
        From the left to the right end.
    """
    radius, turn = result.cam.outer_radius, 2.0 * math.pi
    theta = np.linspace(0.0, turn, steps, endpoint=False)
    points = wall.contact(theta, wall.edge(theta)[:, None]).points[:, 0]
    azimuth = np.arctan2(points[:, 1], points[:, 0]) * result.cam.hand
    order = np.argsort(azimuth % turn)
    x, z = azimuth[order] % turn, points[order, 2]
    at_ends = np.interp(0.0, [x[-1] - turn, x[0]], [z[-1], z[0]])
    x = np.concatenate([[0.0], x, [turn]])
    return radius * x + 1j * np.concatenate([[at_ends], z, [at_ends]])


def _corners(result: SpatialCamResult) -> Plane:
    """Return the corners of the sheet, from the lower left one, counter-clockwise."""
    width, height = 2.0 * math.pi * result.cam.outer_radius, result.design.cam.length
    return np.array([0.0, width, width + 1j * height, 1j * height])


def _path(result: SpatialCamResult, steps: int = _STEPS) -> Feature:
    """Return the path of the roller's centre."""
    theta = np.linspace(0.0, 2.0 * math.pi, steps + 1)
    return Feature(layer=PITCH, shape=Path(points=centers(result, theta), closed=False))


def developed_drawing(result: SpatialCamResult) -> Drawing:
    """Return the sheet with the edges of the walls and the path of the roller's centre."""
    edges = [
        Feature(layer=wall.key.upper(), shape=Path(points=edge(result, wall), closed=False))
        for wall in result.cam.walls
    ]
    sheet = Feature(layer=BLANK, shape=Path(points=_corners(result)))
    return Drawing(name="developed", features=(sheet, *edges, _path(result)))


def cut_away(result: SpatialCamResult, steps: int = _STEPS) -> tuple[Feature, ...]:
    """Return what is cut away of the sheet: the groove, or all beside a wall or a rib.

    Parameters
    ----------
    result : SpatialCamResult
        The cam.
    steps : int
        Number of cam angles.
    """
    corners = _corners(result)
    bottom, top = corners[:2], corners[:1:-1]
    lines = {wall.side: edge(result, wall, steps) for wall in result.cam.walls}
    if result.cam.apart:
        between = (lines[-1], top), (bottom, lines[1])
    else:
        between = ((lines.get(-1, bottom), lines.get(1, top)),)
    return tuple(filled(GROOVE, np.concatenate([low, high[::-1]])) for low, high in between)


def rollers(result: SpatialCamResult) -> tuple[Feature, ...]:
    """Return the roller about the origin, or two above and below it, as they are at the outside."""
    size, apart = 2.0 * result.design.follower.roller_radius, 0.5j * result.cam.apart
    places = (apart, -apart) if apart else (0j,)
    return tuple(
        Feature(layer=FOLLOWER, shape=Circle(center=place, diameter=size)) for place in places
    )


def picture(result: SpatialCamResult) -> Drawing:
    """Return the sheet with what is cut away and the roller at the angle of the design."""
    theta = np.array([result.design.output.pose % (2.0 * math.pi)])
    pose = Pose(0.0, complex(centers(result, theta)[0]))
    shown = place(rollers(result), pose)
    return Drawing(name="cam", features=(*_sheet(result), *shown))


def _sheet(result: SpatialCamResult, steps: int = _STEPS) -> tuple[Feature, ...]:
    """Return the sheet with what is cut away and the path of the roller's centre."""
    sheet = filled(BLANK, _corners(result))
    return (sheet, *cut_away(result, steps), _path(result, steps))


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
    sheet = _sheet(result, drawn_steps(_STEPS, places))
    moving = Pose(np.zeros(len(theta)), centers(result, theta))
    follower = MovingBody(name="follower", called=ROLLER, features=rollers(result), pose=moving)
    return unrolled_scene(result, theta, sheet, follower, _EYE)


SHEET_ROWS: Final = (
    "motion.total_lift", "cam.rotation", "cam.roller_radius_mm", "cam.cone_deg",
    "cam.groove_width_mm.floor", "cam.rib_mm",
    "cam.pressure_angle_deg.max", "cam.lost_motion_mm", "solid.mass_kg",
)  # fmt: skip
"""Facts in the table of the workshop drawing."""


def sheets(result: SpatialCamResult) -> tuple[Sheet, ...]:
    """Return the workshop drawing of a `result`."""
    from gearcam.kinds.gridded_sheet import cam_sheet
    from gearcam.sheets.wheel import GrooveSizes

    cam, (scale, unit) = result.cam, result.lift_unit
    tabled = "lift", unit, lambda at: scale * result.program.derivatives(at, 0)[0]
    if not result.design.follower.oscillating:
        tabled = "z", "mm", lambda at: centers(result, at).imag
    radius, outside = cam.outer_radius, developed_drawing(result)
    wide = 2.0 * cam.tool.radius_at(radius) if len(cam.sides) > 1 and not cam.apart else 0.0
    groove = GrooveSizes(
        width=wide, depth=radius - cam.floor, floor=cam.floor, clearance=cam.clearance
    )
    texts = (
        "outside unrolled",
        "Chain line: roller's middle; z from the back.",
    )
    rows = [one for one in SHEET_ROWS if cam.roller.half_angle or not one.endswith("floor")]
    return (cam_sheet(result, radius, outside, rows, tabled, texts, groove),)
