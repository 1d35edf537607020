"""Facts of a globoidal cam: what the console, the report and ``summary.json`` show."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from gearcam.base.facts import Fact, Facts
from gearcam.base.findings import limit_of
from gearcam.kinds.gridded import solid_facts
from gearcam.spatial.globoidal_checks import KIND
from gearcam.spatial.globoidal_surface import outer_radius

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.build import GloboidalCamResult
    from gearcam.spatial.globoidal import GloboidalCam

Tree = dict[str, Any]


def facts(result: GloboidalCamResult) -> Facts:
    """Return the facts of a globoidal cam, its `result`."""
    tree: Tree = {
        "indexer": _indexer(result),
        "motion": _motion(result),
        "cam": _cam(result),
        "solid": solid_facts(result),
        "accuracy": _accuracy(result),
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


def _motion(result: GloboidalCamResult) -> Tree:
    """Return the peaks of the turret's derivatives that are finite, by cam angle and by time."""
    program, speed = result.program, result.design.drive.speed
    tree: Tree = {
        "unit": "deg",
        "continuity": Fact(program.continuity, "continuity of the motion", unit=""),
    }
    names = ("velocity", "acceleration", "jerk")
    for order, name in enumerate(names[: program.continuity + 1], start=1):
        peak, power = math.degrees(program.peaks[order - 1]), order if order > 1 else ""
        label = f"largest {name} of the turret"
        tree[f"peak_{name}"] = Fact(peak, label, unit=f"deg/rad{power}")
        if speed is not None:
            place = f"at {result.design.drive.named}"
            tree[f"peak_{name}_deg_s{power}"] = Fact(peak * speed**order, label, place=place)
    return tree


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
        "largest_roller_mm": _largest(cam),
        "walls": {
            wall.key: {
                "least_spread_mm": Fact(
                    wall.spread.value, "least spread of the wall", place=wall.spread.place
                )
            }
            for wall in cam.walls
        },
    }


def _pressure(result: GloboidalCamResult) -> Fact:
    """Return the largest pressure angle."""
    spot = result.cam.pressure
    limit = math.degrees(limit_of(KIND, "pressure-angle", result.design.limits))
    angle = math.degrees(spot.value)
    return Fact(angle, "largest pressure angle", at_most=limit, place=spot.place, shown=True)


def _largest(cam: GloboidalCam) -> Fact | None:
    """Return the largest roller without undercut."""
    spot = min((wall.largest_roller for wall in cam.walls), key=lambda one: one.value)
    if math.isinf(spot.value):
        return None
    value = spot.value - 0.5 * cam.clearance
    return Fact(value, "largest roller radius without undercut", place=spot.place)


def _accuracy(result: GloboidalCamResult) -> Tree | None:
    if not result.solid_asked:
        return None
    return {
        "chord_mm": result.chord_error,
        "volume_mm3": result.volume[1],
        "how": {
            "chord_mm": "height of the scallops between the positions of the rollers that cut it"
            if result.carved
            else "distance of the walls from the middles of all edges of the mesh",
            "volume_mm3": "a third of the change from a mesh of half the steps",
        },
    }
