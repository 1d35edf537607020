"""Facts of one wheel."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from gearcam.base.facts import Fact
from gearcam.gears.bends import bends_of

if TYPE_CHECKING:
    from gearcam.gears.pair import Gear


def gear_tree(gear: Gear) -> dict[str, Any]:
    """Return the facts of a wheel as a nested dict (see `gearcam.base.facts.Facts`)."""
    cutter, bends = gear.toothing.cutter, bends_of(gear.pair.rolling.tracks[gear.wheel - 1])
    pinion = cutter.kind == "pinion"
    return {
        "name": gear.name,
        "internal": True if gear.ring else None,
        "teeth": gear.toothing.teeth,
        "centrode": {
            "length_mm": Fact(gear.toothing.length, "centrode length"),
            "min_convex_radius_mm": bends.radius if bends.radius < math.inf else None,
            "max_concave_curvature_per_mm": bends.concave,
            "closed": gear.toothing.closed,
        },
        "cutter": cutter.kind,
        "cutter_pitch_radius_mm": 1.0 / cutter.kc if pinion else None,
        "cutter_teeth": cutter.teeth if pinion else None,
        "cutter_tip_radius_mm": cutter.tip_radius,
        "undercut_teeth": list(gear.profile.undercut_teeth),
        "tip_thickness_min_mm": float(gear.profile.tip_thickness.min()),
        "root_radius_min_mm": None if gear.ring else gear.least_radius,
        "root_radius_max_mm": gear.largest_radius if gear.ring else None,
        "outline": {
            "vertices": len(gear.outline),
            "least_vertices": gear.profile.sampler.least,
            "area_mm2": gear.profile.contour.area,
            "chord_error_mm": gear.profile.chord_error,
        },
    }
