"""Facts of a globoidal cam: what the console, the report and ``summary.json`` show."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from gearcam.base.facts import Fact, Facts
from gearcam.base.findings import limit_of
from gearcam.kinds.gridded_facts import (
    accuracy_facts,
    largest_roller,
    peak_facts,
    solid_facts,
    spread_facts,
)
from gearcam.spatial.globoidal_checks import KIND
from gearcam.spatial.globoidal_surface import outer_radius

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.build import GloboidalCamResult

Tree = dict[str, Any]


def facts(result: GloboidalCamResult) -> Facts:
    """Return the facts of a globoidal cam, its `result`."""
    tree: Tree = {
        "indexer": _indexer(result),
        "motion": _motion(result),
        "cam": _cam(result),
        "solid": solid_facts(result),
        "accuracy": accuracy_facts(result, "rollers that cut it", {}),
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
    return {"unit": "deg"} | peak_facts(result, math.degrees(1.0), "deg", " of the turret")


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
    return Fact(angle, "largest pressure angle", at_most=limit, place=spot.place, shown=True)
