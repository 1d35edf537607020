"""Facts of a cam in space: what the console, the report and ``summary.json`` show."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from gearcam.base.facts import Fact, Facts, extent
from gearcam.kinds.gridded import solid_facts
from gearcam.spatial import checks
from gearcam.spatial.developed import largest_in_plane
from gearcam.spatial.guides import SwingArm
from gearcam.spatial.trimmed import lost_lift

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.build import SpatialCamResult
    from gearcam.spatial.cam import SpatialWall
    from gearcam.spatial.extremes import Spot

Tree = dict[str, Any]


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
        "accuracy": _accuracy(result),
    }
    headline = ("motion.total_lift", "cam.outer_diameter_mm")
    return Facts(tree, headline, f"{design.cam.form} cam for {design.follower.named}")


def _motion(result: SpatialCamResult) -> Tree:
    """Return lift and the peaks of its derivatives that are finite."""
    program, (scale, unit) = result.program, result.lift_unit
    low, high = program.range
    tree: Tree = {
        "unit": unit,
        "lift": Fact(extent(low, high, scale), "lift", unit=unit),
        "total_lift": Fact(scale * (high - low), "lift", unit=unit, shown=True),
        "continuity": Fact(program.continuity, "continuity of the motion", unit=""),
    }
    speed, named = result.design.drive.speed, result.design.drive.named
    names = ("velocity", "acceleration", "jerk")
    for order, name in enumerate(names[: program.continuity + 1], start=1):
        peak, power = program.peaks[order - 1], order if order > 1 else ""
        tree[f"peak_{name}"] = Fact(scale * peak, f"largest {name}", unit=f"{unit}/rad{power}")
        if speed is not None:
            value = scale * peak * speed**order
            label = f"largest {name}"
            tree[f"peak_{name}_{unit}_s{power}"] = Fact(value, label, place=f"at {named}")
    return tree


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
            "outer": 2.0 * tool.radius_at(cam.outer_radius),
            "floor": 2.0 * tool.radius_at(cam.floor),
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
            "in_space": _largest(cam.largest_roller, 0.5 * cam.clearance),
            "in_developed_plane": largest_in_plane(cam, cam.floor) - 0.5 * cam.clearance,
        },
        "walls": {wall.key: _wall(wall) for wall in cam.walls},
    }


def _wall(wall: SpatialWall) -> Tree:
    """Return how much a wall spreads, and what undercut costs."""
    tree: Tree = {
        "least_spread_mm": Fact(
            wall.spread.value, "least spread of the wall", place=wall.spread.place
        )
    }
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


def _largest(spot: Spot, off: float) -> Fact | None:
    """Return the largest roller without undercut."""
    if math.isinf(spot.value):
        return None
    return Fact(spot.value - off, "largest roller radius without undercut", place=spot.place)


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
            angle, meaning, at_most=most if whole else None, place=spot.place, shown=not kind
        )

    return {
        "max": largest("largest pressure angle"),
        "rise_max": largest("largest pressure angle, rise", kind="rise"),
        "return_max": largest("largest pressure angle, return", kind="return"),
        "at_mean_radius": largest("largest pressure angle at the mean radius", cam.mean_radius),
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
        "rest_mm": Fact(path.rest, "most that is left on a wall", shown=True),
        "chord_mm": Fact(path.chord, "distance of the moves from the path"),
        "cutting_time_s": float(times.sum()),
    }


def _accuracy(result: SpatialCamResult) -> Tree | None:
    if not result.solid_asked:
        return None
    exact = "step" in result.design.output.files
    how = "distance of exact points from the B-splines, half-way between those interpolated"
    return {
        "chord_mm": result.chord_error,
        "step_mm": result.bands.error if exact else None,
        "volume_mm3": result.volume[1],
        "how": {
            "chord_mm": "height of the scallops between the positions of the roller that cuts it"
            if result.carved
            else "distance of the walls from the middles of all edges of the mesh",
            "step_mm": how if exact else None,
            "volume_mm3": "a third of the change from a mesh of half the steps",
        },
    }
