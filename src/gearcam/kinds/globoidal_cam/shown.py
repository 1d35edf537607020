"""What is shown of a globoidal cam: its facts, and its files, one function a format."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.facts import Fact, Facts, Tree
from gearcam.base.findings import limit_of
from gearcam.kinds.gridded_shown import (
    SOLIDS,
    largest_roller,
    peak_facts,
    picture_files,
    solid_facts,
    spread_facts,
    wall_bytes,
)
from gearcam.laws.phases_of_lift import TURN
from gearcam.report.file import report_files
from gearcam.results.ladders import Ladders, grid_ladder
from gearcam.spatial.globoidal_checks import KIND
from gearcam.spatial.globoidal_surface import outer_radius

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.result import GloboidalCamResult
    from gearcam.results.kind import Files


def facts(result: GloboidalCamResult) -> Facts:
    """Return the facts of a globoidal cam, its `result`."""
    tree: Tree = {
        "indexer": _indexer(result),
        "motion": {"unit": "deg"} | peak_facts(result, math.degrees(1.0), "deg", " of the turret"),
        "cam": _cam(result),
        "solid": solid_facts(result),
    }
    headline = ("indexer.stops", "indexer.index_deg", "cam.center_distance_mm")
    return Facts(tree, headline, "globoidal indexing cam")


def _indexer(result: GloboidalCamResult) -> Tree:
    """Return stops, and the cam angles of motion and rest."""
    cam, index, turret = result.cam, result.design.index, result.design.turret
    moving = math.degrees(index.angle)
    return {
        "stops": Fact(turret.stops, "stops", shown=True),
        "index_deg": Fact(moving, "index angle", shown=True),
        "dwell_deg": Fact(360.0 - moving, "dwell angle"),
        "step_deg": Fact(math.degrees(turret.pitch), "angle from stop to stop"),
        "backlash_deg": Fact(
            math.degrees(cam.clearance / cam.reach), "backlash of the turret at rest"
        ),
    }


def _cam(result: GloboidalCamResult) -> Tree:
    """Return sizes, the pressure angle, and how much the walls spread."""
    cam, given, turret = result.cam, result.design.cam, result.design.turret
    least, rib = cam.least_length, cam.least_rib
    return {
        "form": given.form,
        "rotation": Fact(given.rotation, "cam turns"),
        "center_distance_mm": Fact(given.center_distance, "centre distance", shown=True),
        "length_mm": Fact(cam.length, "length", shown=True),
        "least_length_mm": Fact(least, "least length that holds the turret at all angles"),
        "outer_diameter_mm": Fact(2.0 * outer_radius(cam), "largest diameter, at the faces"),
        "core_radius_mm": Fact(cam.distance - cam.floor, "least radius of the core"),
        "top_mm": Fact(cam.top, "radius of the tops of the ribs about the turret's axis"),
        "floor_mm": Fact(cam.floor, "radius of the core about the turret's axis"),
        "roller_radius_mm": turret.roller_radius,
        "groove_width_mm": 2.0 * cam.tool.radius,
        "least_rib_mm": Fact(rib.value, "least thickness of the rib, about", place=rib.place),
        "pressure_angle_deg": {"max": _pressure(result)},
        "lost_motion_mm": Fact(cam.lost_motion.value, "lost motion of a roller"),
        "largest_roller_mm": largest_roller(cam),
        "walls": {wall.key: spread_facts(wall) for wall in cam.walls},
    }


def _pressure(result: GloboidalCamResult) -> Fact:
    """Return the largest pressure angle."""
    spot = result.cam.pressure
    limit = math.degrees(limit_of(KIND, "pressure-angle", result.design.limits))
    angle = math.degrees(spot.value)
    meaning = "largest pressure angle"
    return Fact(angle, meaning, at_most=limit, place=spot.place, unit="deg", shown=True)


def _tables(result: GloboidalCamResult, _: Any) -> Files:
    """Return the walls and the motion as tables.

    Files: walls.csv, motion.csv.

    Points of the rib's walls between its faces, in the cam's frame, over cam angle and place along
    the roller: `roller` counts upwards from the one that is half a stop below the middle at
    theta_deg = 0, x_mm is the distance from the turret's axis, X, Y, Z the point in mm, nx, ny, nz
    the normal into the metal; with the pressure angle. The turret's angle, its derivatives and
    pressure angles over the cam angle: also the path of a mill as wide as the groove, whose axis is
    that of a roller.
    """
    from gearcam.export.table import table_bytes
    from gearcam.spatial.globoidal_surface import rib_angles

    cam, parts = result.cam, []
    for k, wall in enumerate(cam.walls):
        theta = rib_angles(cam, result.steps) + TURN * k
        grid = wall.grid(theta, result.design.output.wall_points)
        turns = np.floor(theta / TURN)
        angles = {"roller": turns.astype(int), "theta_deg": np.degrees(theta - TURN * turns)}
        parts.append((wall, angles, grid, cam.between_faces(grid.points)))
    walls = wall_bytes(parts, cam.hand)
    return {"walls.csv": walls, "motion.csv": table_bytes(result.motion())}


def _svg(result: GloboidalCamResult, _: Any) -> Files:
    """Return a picture of the unrolled cam.

    Files: cam.svg.

    The globoid through the middle of the rollers, unrolled, with the rollers; not for cutting.
    """
    from gearcam.kinds.globoidal_cam.drawn import picture

    return picture_files(result, picture(result))


FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "csv": _tables,
    "svg": _svg,
    **SOLIDS,
    "report": report_files,
}
"""What makes the files of each format: contents by name."""


LADDERS: Final[Ladders] = {"solid": partial(grid_ladder, least=72, finer=False)}
"""What `gearcam accuracy` can measure: the solid, from 72 cam angles on."""
