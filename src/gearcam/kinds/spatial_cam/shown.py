"""What is shown of a cam in space: its facts, and its files, one function a format."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.facts import Fact, Facts, Tree, extent
from gearcam.kinds.gridded_shown import (
    SOLIDS,
    largest_roller,
    peak_facts,
    picture_files,
    solid_facts,
    spread_facts,
    wall_bytes,
)
from gearcam.kinds.shared import steps_of_turn
from gearcam.kinds.spatial_cam.milled import MILLED
from gearcam.report.file import report_files
from gearcam.spatial import checks
from gearcam.spatial.developed import largest_in_plane
from gearcam.spatial.guides import SwingArm
from gearcam.spatial.trimmed import lost_lift

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.result import SpatialCamResult
    from gearcam.results.kind import Files
    from gearcam.spatial.cam import SpatialWall


def facts(result: SpatialCamResult) -> Facts:
    """Return the facts of a cam in space, its `result`."""
    design = result.design
    tree: Tree = {
        "motion": _motion(result),
        "cam": _cam(result),
        "solution": None
        if result.solution is None
        else {
            "outer_diameter_mm": Fact(
                result.solution.diameter, "cam.outer_diameter_mm, solved", shown=True
            ),
            "decided_by": Fact(result.solution.decided_by, "decided by", shown=True),
        },
        "solid": solid_facts(result),
        "tool_path": _tool_path(result),
    }
    headline = ("motion.total_lift", "cam.outer_diameter_mm")
    return Facts(tree, headline, f"{design.cam.form} cam for {design.follower.named}")


def _motion(result: SpatialCamResult) -> Tree:
    """Return lift and the peaks of its derivatives that are finite."""
    program, (scale, unit) = result.program, result.lift_unit
    low, high = program.range
    return {
        "unit": unit,
        "lift": Fact(extent(low, high, scale), "lift", unit=unit),
        "total_lift": Fact(scale * (high - low), "lift", unit=unit, shown=True),
    } | peak_facts(result, scale, unit)


def _cam(result: SpatialCamResult) -> Tree:
    """Return sizes, pressure angles, and how much the walls spread."""
    cam, given, follower = result.cam, result.solved.cam, result.design.follower
    tool = cam.tool
    return {
        "form": given.form,
        "rotation": Fact(given.rotation, "cam turns"),
        "outer_diameter_mm": Fact(given.outer_diameter, "outer diameter", shown=True),
        "length_mm": given.length,
        "floor_radius_mm": cam.floor,
        "roller_radius_mm": follower.roller_radius,
        "cone_deg": math.degrees(cam.roller.half_angle) or None,
        "arm_mm": follower.arm,
        "groove_width_mm": {
            "outer": Fact(2.0 * tool.radius_at(cam.outer_radius), "groove width, outside"),
            "floor": Fact(2.0 * tool.radius_at(cam.floor), "groove width at the floor"),
        }
        if len(cam.sides) > 1 and not cam.apart
        else None,
        "rib_mm": given.rib,
        "least_rib_mm": None
        if cam.least_rib is None
        else Fact(cam.least_rib.value, "least thickness of the rib", place=cam.least_rib.place),
        "pressure_angle_deg": _pressure(result),
        "lost_motion_mm": None if cam.lost_motion is None else cam.lost_motion.value,
        "largest_roller_mm": {
            "in_space": largest_roller(cam),
            "in_developed_plane": largest_in_plane(cam, cam.floor) - 0.5 * cam.clearance,
        },
        "walls": {wall.key: _wall(wall) for wall in cam.walls},
    }


def _wall(wall: SpatialWall) -> Tree:
    """Return how much a wall spreads, and what undercut costs."""
    tree = spread_facts(wall)
    if not wall.undercut:
        return tree
    loss, guide = lost_lift(wall), wall.cam.guide
    swings = isinstance(guide, SwingArm)
    place = loss.way.place
    return tree | {
        "undercut_mm": Fact(
            loss.depth.value, f"most taken off the {wall.key} wall", place=loss.depth.place
        ),
        "lost_lift_deg": Fact(math.degrees(loss.way.value), "lost lift", place=place)
        if swings
        else None,
        "lost_lift_mm": None if swings else Fact(loss.way.value, "lost lift", place=place),
        "lost_lift_error": math.degrees(loss.error) if swings else loss.error,
    }


def _pressure(result: SpatialCamResult) -> Tree:
    """Return the largest pressure angles: anywhere, on rises and returns, at the mean radius."""
    cam = result.cam
    limit = checks.allowed_pressure(cam, result.design.limits)

    def largest(meaning: str, x: float | None = None, kind: str = "") -> Fact | None:
        spot = cam.pressure(x, kind)
        if spot is None:
            return None
        angle, most = math.degrees(spot.value), math.degrees(limit)
        whole = x is None
        return Fact(
            angle,
            meaning,
            at_most=most if whole else None,
            place=spot.place,
            unit="deg",
            shown=not kind,
        )

    return {
        "max": largest("largest pressure angle"),
        "rise_max": largest("largest pressure angle, rise", kind="rise"),
        "return_max": largest("largest pressure angle, return", kind="return"),
        "at_mean_radius": largest("largest pressure angle at the mean radius", cam.middle),
    }


def _tool_path(result: SpatialCamResult) -> Tree | None:
    """Return tool, passes and what they leave, where a file asks for the path."""
    if not result.path_asked:
        return None
    path = result.rotary
    times = path.times(result.design.tool)
    end, outside = path.tool
    return {
        "axes": Fact("X Y Z A" if path.crosswise else "X Z A", "axes of the machine", unit=""),
        "tool_diameter_mm": {"end": 2.0 * end, "outside": 2.0 * outside},
        "passes_in_depth": path.layers,
        "turns": path.turns,
        "moves": len(path.moves),
        "left_mm": Fact(path.left, "most that is left on a wall", shown=True),
        "cut_mm": Fact(path.cut, "most that is cut into a wall", shown=True),
        "rest_mm": Fact(path.rest, "left by a tool smaller than the roller on its path"),
        "chord_mm": Fact(path.chord, "distance of the moves from the path"),
        "cutting_time_s": float(times.sum()),
    }


def _tables(result: SpatialCamResult, _: Any) -> Files:
    """Return the walls and the motion as tables.

    Files: walls.csv, motion.csv.

    Points of the walls in the cam's frame over cam angle and place along the roller: x_mm is the
    distance along the roller's axis, X, Y, Z the point in mm, nx, ny, nz the normal into the metal;
    with the pressure angle. Lift, its derivatives and pressure angles over the cam angle.
    """
    from gearcam.export.table import motion_bytes

    theta, count = result.wall_angles, result.design.output.wall_points
    all_of = np.ones((len(theta), count), dtype=bool)
    angles = {"theta_deg": np.degrees(theta)}
    parts = [(wall, angles, wall.grid(theta, count), all_of) for wall in result.cam.walls]
    walls = wall_bytes(parts, result.cam.hand)
    return {"walls.csv": walls, "motion.csv": motion_bytes(result.motion())}


def _caliper(result: SpatialCamResult, _: Any) -> Files:
    """Return the heights of the walls on the outside of the cam.

    Files: caliper.csv.

    Heights above its lower end at which each wall meets the outside, at equal steps of the azimuth,
    counter-clockwise from the x axis of its frame.
    """
    from gearcam.export.table import table_bytes

    result.demand_whole()
    angles = steps_of_turn(result.design.output.caliper_step)
    heights = {
        f"height_{wall.key}_mm": np.round(wall.heights_at(result.cam.hand * angles), 9)
        for wall in result.cam.walls
    }
    return {"caliper.csv": table_bytes({"angle_deg": np.degrees(angles), **heights})}


def _step(result: SpatialCamResult, _: Any) -> Files:
    """Return the solid for CAD.

    Files: cam.step.

    The cam as a solid for CAD and CAM: planes and cylinders are exact, walls are B-splines through
    exact points; the report states their error. Needs `pip install "gearcam[step]"`.
    """
    from gearcam.export.step import step_bytes
    from gearcam.numeric.pose import UNMOVED

    body = result.bands
    return {f"{body.name}.step": step_bytes([(body, UNMOVED)], body.name, body.error)}


def _dxf(result: SpatialCamResult, _: Any) -> Files:
    """Return the outside of the cam, unrolled, as DXF.

    Files: developed.dxf.

    The cylinder of the outer diameter, unrolled from the cam angle 0 to 360 deg, 1:1 in mm: the
    edges of the true groove on UPPER and LOWER, the centre line on PITCH, the sheet on BLANK. To
    wrap round the cylinder, as a template or to check; walls cut along it radially are not true.
    """
    from gearcam.export.dxf import DxfStyle, dxf_bytes
    from gearcam.kinds.spatial_cam.drawn import developed_drawing

    style = DxfStyle(tolerance=1e-3, curves="lines", version="R2010")
    return {"developed.dxf": dxf_bytes(developed_drawing(result), style)}


def _svg(result: SpatialCamResult, _: Any) -> Files:
    """Return a picture of the unrolled cam.

    Files: cam.svg.

    The outside of the cam, unrolled, with its roller; not for cutting.
    """
    from gearcam.kinds.spatial_cam.drawn import picture

    return picture_files(result, picture(result))


FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "csv": _tables,
    "dxf": _dxf,
    "svg": _svg,
    **SOLIDS,
    "step": _step,
    "report": report_files,
    **MILLED,
    "caliper": _caliper,
}
"""What makes the files of each format: contents by name."""
