"""What is drawn of a globoidal cam: charts over the cam angle, its sheet, its scene.

The sheet is the globoid through the middle of the rollers, unrolled, seen from outside. From left
to right the azimuth in the cam's frame rises from 0 to 360 deg, as lengths on the least circle of
this globoid; upwards is the direction from the turret's axis, as lengths on the circle about it. Of
a cam that turns counter-clockwise the cam angle therefore runs from right to left. In the scene the
sheet is at rest and the rollers run along it; the solids move in space: the cam turns, and the
turret with it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.findings import limit_of
from gearcam.kinds.globoidal_cam.result import TURRET
from gearcam.kinds.gridded_drawn import (
    drawn_steps,
    filled,
    motion_chart,
    pressure_chart,
    spread_chart,
    unrolled_scene,
)
from gearcam.laws.phases_of_lift import TURN
from gearcam.numeric.pose import Pose
from gearcam.parts.shapes import Circle
from gearcam.pictures.charts import Chart, Charts
from gearcam.pictures.drawings import (
    BLANK,
    FOLLOWER,
    GROOVE,
    PITCH,
    Drawing,
    Feature,
    Path,
    chained,
    place,
)
from gearcam.pictures.scenes import PLACES, MovingBody, Scene
from gearcam.spatial.globoidal_checks import KIND
from gearcam.spatial.globoidal_surface import polar

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.result import GloboidalCamResult
    from gearcam.numeric.arrays import Array, Plane
    from gearcam.sheets.sheet import Sheet
    from gearcam.spatial.globoidal import GloboidalCam, GloboidalWall


def _pressure(result: GloboidalCamResult) -> Chart:
    labels = {"top": "at the tops of the ribs", "mean": "in the middle", "end": "at its end"}
    limit = limit_of(KIND, "pressure-angle", result.design.limits)
    title = "Pressure angle of the roller nearest to the middle"
    return pressure_chart(result, title, labels, limit)


def _spread(result: GloboidalCamResult) -> Chart:
    places = {"end of the roller": result.cam.reach, "top of the rib": result.cam.top}
    title = "Margin of the walls against undercut at the roller nearest to the middle"
    return spread_chart(result, title, places)


CHARTS: Final[Charts] = {
    "turret": partial(motion_chart, name="turret", title="Angle of the turret", called="angle"),
    "pressure_angle": _pressure,
    "spread": _spread,
    **{
        name: partial(motion_chart, name=name, title=f"{name.capitalize()} of the turret")
        for name in ("velocity", "acceleration", "jerk")
    },
}
"""Charts by name; the report leads with the first three."""


_STEPS: Final = 1440
"""Cam angles of a turn at which curves are drawn."""


def across(cam: GloboidalCam) -> float:
    """Return the least radius of the globoid that is drawn, mm."""
    return cam.distance - cam.middle


def half_height(cam: GloboidalCam) -> float:
    """Return half the height of the sheet, mm: the arc from the middle to a face."""
    return cam.middle * math.asin(cam.half_length / cam.middle)


def center(cam: GloboidalCam, theta: Array) -> Plane:
    """Return the centre of the roller that is followed, on the sheet, mm.

    Parameters
    ----------
    cam : GloboidalCam
        The cam.
    theta : (n,) array, rad
        Cam angles within a turn.
    """
    along = across(cam) * (theta if cam.clockwise else TURN - theta)
    return along + 1j * cam.middle * cam.angle(theta)


def picture(result: GloboidalCamResult) -> Drawing:
    """Return the sheet with the grooves, and the rollers at the angle of the design."""
    theta = np.array([result.design.output.pose % TURN])
    shown = place(rollers(result.cam), Pose(0.0, complex(center(result.cam, theta)[0])))
    features = (sheet(result.cam), *grooves(result.cam), *paths(result.cam), *shown)
    return Drawing(name="cam", features=features)


def sheet(cam: GloboidalCam) -> Feature:
    """Return the sheet."""
    width, half = TURN * across(cam), 1j * half_height(cam)
    return filled(BLANK, np.array([-half, width - half, width + half, half]))


def grooves(cam: GloboidalCam, steps: int = _STEPS) -> tuple[Feature, ...]:
    """Return the grooves between the windings of the rib, cut where the sheet begins and ends.

    Parameters
    ----------
    cam : GloboidalCam
        The cam.
    steps : int
        Number of cam angles in a turn.
    """
    upper, lower = (dict(_windings(cam, wall, steps)) for wall in cam.walls)
    half = half_height(cam)
    found = []
    for turn in sorted(upper.keys() & lower.keys()):
        edges = (one[turn] for one in (lower, upper))
        low, high = (line.real + 1j * np.clip(line.imag, -half, half) for line in edges)
        if (high.imag > low.imag).any():
            found.append(filled(GROOVE, np.concatenate([low, high[::-1]])))
    return tuple(found)


def paths(cam: GloboidalCam, steps: int = _STEPS) -> tuple[Feature, ...]:
    """Return the path of the rollers' axes between the faces.

    Parameters
    ----------
    cam, steps
        As of `grooves`.
    """
    theta, limit = np.linspace(0.0, TURN, steps + 1), half_height(cam)
    once = center(cam, theta)
    found = []
    for k in range(-_around(cam), _around(cam) + 1):
        path = once + 1j * k * cam.middle * cam.pitch
        on = np.abs(path.imag) <= limit
        if on.sum() > 1:
            found.append(Feature(layer=PITCH, shape=Path(points=path[on], closed=False)))
    return tuple(found)


def rollers(cam: GloboidalCam) -> tuple[Feature, ...]:
    """Return the rollers about that which is followed, as circles."""
    step, size = 1j * cam.middle * cam.pitch, 2.0 * cam.roller.radius
    return tuple(
        Feature(layer=FOLLOWER, shape=Circle(center=k * step, diameter=size))
        for k in range(-_around(cam), _around(cam) + 1)
    )


def _around(cam: GloboidalCam) -> int:
    """Return how many rollers to each side of the middle may be on the cam."""
    return math.ceil(half_height(cam) / (cam.middle * cam.pitch))


def _windings(cam: GloboidalCam, wall: GloboidalWall, steps: int) -> Iterator[tuple[int, Plane]]:
    """Yield the edge of a wall on the sheet, from left to right, by the number of its winding."""
    start, end = cam.span
    first, last = math.floor(start / TURN) - 1, math.ceil(end / TURN) + 1
    theta = np.linspace(first * TURN, last * TURN, (last - first) * steps + 1)
    points = wall.contact(theta, wall.place(theta, cam.middle)[:, None]).points
    _, direction, ahead = polar(cam, points, theta)[:, 0].T
    # the azimuth falls with the cam angle, and is nearest to minus this
    azimuth, height = (ahead - theta) * cam.hand, cam.middle * direction
    order = np.argsort(azimuth)
    azimuth, height = azimuth[order], height[order]
    for turn in range(first + 1, last - 1):
        low = TURN * (turn if cam.clockwise else -turn - 1)
        within = (azimuth > low) & (azimuth < low + TURN)
        ends = np.interp([low, low + TURN], azimuth, height)
        along = np.concatenate([[low], azimuth[within], [low + TURN]]) - low
        up = np.concatenate([ends[:1], height[within], ends[1:]])
        yield turn, across(cam) * along + 1j * up


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
    steps = drawn_steps(_STEPS, places)
    sheet_of = (sheet(cam), *grooves(cam, steps), *paths(cam, steps))
    # the end of the turn, at which the next roller is where this one began
    moving = Pose(np.zeros(len(theta)), center(cam, theta))
    turret = MovingBody(name=TURRET, called="rollers", features=rollers(cam), pose=moving)
    return unrolled_scene(result, theta, sheet_of, turret, _EYE)


SHEET_ROWS: Final = (
    "indexer.stops", "indexer.index_deg", "indexer.dwell_deg", "indexer.step_deg",
    "indexer.backlash_deg", "cam.rotation", "cam.center_distance_mm", "cam.core_radius_mm",
    "cam.top_mm", "cam.floor_mm", "cam.roller_radius_mm",
    "cam.pressure_angle_deg.max", "solid.mass_kg",
)  # fmt: skip
"""Facts in the table of the workshop drawing."""


def sheets(result: GloboidalCamResult) -> tuple[Sheet, ...]:
    """Return the workshop drawing of a `result`."""
    from gearcam.kinds.gridded_sheet import cam_sheet
    from gearcam.sheets.wheel import GrooveSizes

    cam = result.cam
    drawing = Drawing(name="cam", features=chained(sheet(cam), *grooves(cam), *paths(cam)))
    tabled = "turret", "deg", lambda at: np.degrees(result.program.derivatives(at, 0)[0])
    texts = (
        "globoid unrolled",
        "Unrolled: through the rollers' middle, not true.",
    )
    groove = GrooveSizes(
        width=2.0 * cam.tool.radius,
        depth=cam.floor - cam.top,
        floor=cam.distance - cam.floor,
        clearance=cam.clearance,
    )
    return (cam_sheet(result, max(result.rims), drawing, SHEET_ROWS, tabled, texts, groove),)
