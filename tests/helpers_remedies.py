"""Designs that are refused, have errors or warnings, and how a person follows their remedies."""

from __future__ import annotations

import copy
import re
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

from gearcam.designs.writing import toml_text
from helpers_built import built

ELLIPSE = {"type": "ellipse", "eccentricity": 0.2}
CIRCLE = {"type": "constant"}
RING = {"type": "internal"}
DOOR = {
    "type": "phases",
    "knots_deg": [0, 60, "solve"],
    "ratios": [1, 1.4, 1.4],
    "driven_travel_deg": 200,
}


def pair(law: Mapping[str, Any], teeth: list[int], **tables: Any) -> dict[str, Any]:
    """A pair that is cut as it is, coarse enough to be quick."""
    sizes = {"module_mm": 2, "teeth": teeth} | tables.pop("pair", {})
    output = {"files": ["csv"], "chord_tolerance_mm": 0.01} | tables.pop("output", {})
    return {
        "kind": "gear-pair", "name": "p", "law": dict(law), "pair": sizes, "output": output,
        **tables,
    }  # fmt: skip


def by_distance(law: Mapping[str, Any], teeth: list[int], distance: float) -> dict[str, Any]:
    made = pair(law, teeth)
    del made["pair"]["module_mm"]
    made["pair"]["center_distance_mm"] = distance
    return made


def cam(follower: dict[str, Any], size: dict[str, Any], lift: float = 10, **more: Any) -> Any:
    """A cam that rises, rests and returns."""
    unit = "deg" if follower.get("motion") == "oscillating" else "mm"
    angles = more.pop("angles", [90, 90, 90, 90])
    phases = [
        {"type": kind, "angle_deg": angle}
        for kind, angle in zip(["rise", "dwell", "return", "dwell"], angles, strict=True)
    ]
    for phase in phases:
        if phase["type"] != "dwell":
            phase |= {"law": "3-4-5", f"lift_{unit}": lift}
    output = {"files": ["csv"]}
    return {
        "kind": "cam", "name": "c", "motion": phases, "follower": follower, "cam": size,
        "output": output, **more,
    }  # fmt: skip


ROLLER = {"type": "roller", "roller_radius_mm": 6}
ARM = {"type": "roller", "roller_radius_mm": 6, "motion": "oscillating", "arm_mm": 60}
ARM["pivot_distance_mm"] = 80
FACE = {"type": "flat", "motion": "oscillating", "pivot_distance_mm": 80}

BOLTED = {"bolts": [0, 6], "bolt_circle_mm": [0, 126], "bolt_diameter_mm": [0, 5.5]}

PLATE = {"height_mm": 60, "bolts": 2, "bolt_diameter_mm": 6.6, "bolt_spacing_mm": 160,
         "bolt_height_mm": 8}  # fmt: skip


def plate(**blank: float) -> dict[str, Any]:
    """A translating cam whose plate is bolted down, with other sizes of its blank."""
    made = cam(ROLLER, {"form": "translating", "thickness_mm": 12, "walls": "both",
                        "run_in_mm": 20, "run_out_mm": 20}, lift=15)  # fmt: skip
    for phase, way in zip(made["motion"], (60, 30, 40, 10), strict=True):
        del phase["angle_deg"]
        phase["travel_mm"] = way
    return made | {"blank": PLATE | blank}


REFUSED: dict[str, tuple[dict[str, Any], set[str]]] = {
    "concave part too tight": (
        pair({"type": "limacon", "eccentricity": 0.7}, [20, 20]),
        {"pair.teeth", "law.eccentricity", "pair.module_mm"},
    ),
    "the same at a centre distance": (
        by_distance({"type": "limacon", "eccentricity": 0.7}, [20, 20], 60),
        {"pair.teeth", "law.eccentricity"},
    ),
    "teeth cut off": (
        pair(
            {"type": "ellipse", "eccentricity": 0.8},
            [8, 8],
            rack={"dedendum": 1.9, "tip_radius": 0},
        ),
        {"pair.teeth", "pair.module_mm"},
    ),
    "bore": (
        pair(CIRCLE, [20, 20], blank={"bore_diameter_mm": 38}, output={"files": ["stl"]}),
        {"blank.bore_diameter_mm"},
    ),
    "hub": (
        pair(CIRCLE, [20, 20], blank={"bore_diameter_mm": 10, "hub_diameter_mm": 36,
             "hub_front_mm": 5, "timing_marks": False}),
        {"blank.hub_diameter_mm"},
    ),
    "no room for marks": (
        # between the root where the mark would be and that which the hub may not reach
        pair({"type": "ellipse", "eccentricity": 0.3}, [21, 21], blank={"bore_diameter_mm": 10,
             "hub_diameter_mm": [25.15, 20], "hub_front_mm": 5}),
        {"blank.timing_marks"},
    ),
    "large marks": (
        pair(CIRCLE, [20, 20], blank={"bore_diameter_mm": 10, "mark_diameter_mm": 9}),
        {"blank.mark_diameter_mm", "blank.timing_marks"},
    ),
    "mark meets a bolt": (
        pair(CIRCLE, [40, 40], blank={"bolts": 4, "bolt_circle_mm": 70, "bolt_diameter_mm": 4}),
        {"blank.timing_marks"},
    ),
    "bolts meet the outline": (
        pair(CIRCLE, [40, 40], blank={"bolts": 4, "bolt_circle_mm": 74, "bolt_diameter_mm": 6,
             "timing_marks": False}),
        {"blank.bolt_diameter_mm", "blank.bolt_circle_mm"},
    ),
    "bolts of a ring, but not of its pinion": (
        pair({"type": "ellipse", "eccentricity": 0.1}, [24, 48], pair={"type": "internal"},
             blank={"bolts": 6, "bolt_circle_mm": 110, "bolt_diameter_mm": 4}),
        {"blank.bolts[0]"},
    ),
    "many lightening holes": (
        pair(CIRCLE, [40, 40], blank={"lightening_holes": 36, "rim_mm": 12}),
        {"blank.lightening_holes[0]", "blank.lightening_holes"},
    ),
    "lightening holes": (
        pair(CIRCLE, [40, 40], blank={"lightening_holes": 5, "rim_mm": 40}),
        {"blank.lightening_holes"},
    ),
    "stop pin of a closed pair": (
        pair(CIRCLE, [20, 20], blank={"stop_pin_mm": [3, 0]}),
        {"blank.stop_pin_mm[0]"},
    ),
    "wide stop pin": (
        pair(DOOR, [30, 30], blank={"stop_pin_mm": [40, 0], "timing_marks": False}),
        {"blank.stop_pin_mm[0]"},
    ),
    "coarse": (
        by_distance(CIRCLE, [40, 40], 40) | {"output": {"chord_tolerance_mm": 0.1}},
        {"output.chord_tolerance_mm"},
    ),
    "play": (pair(CIRCLE, [20, 20], pair={"backlash_mm": 4}), {"pair.backlash_mm"}),
    "shift": (
        pair(CIRCLE, [40, 40], pair={"x": 0.9}, rack={"addendum": 0.8}), {"pair.x"}
    ),
    "shallow": (
        pair(CIRCLE, [40, 40], rack={"addendum": 1.2, "dedendum": 1}),
        {"rack.dedendum", "rack.addendum"},
    ),
    "pointed rack": (pair(CIRCLE, [40, 40], rack={"dedendum": 2.4}), {"rack.dedendum"}),
    "tip radius": (
        pair(CIRCLE, [40, 40], rack={"tip_radius": 0.5, "dedendum": 1.25}), {"rack.tip_radius"}
    ),
    "ratios that do not close": (
        pair({"type": "phases", "knots_deg": [0, 120, 240, 360], "ratios": [1.2, 0.8, 1.1, 1.2]},
             [40, 40]),
        {"law.ratios[0]", "law.ratios[1]", "law.ratios[2]", "law.ratios[3]"},
    ),
    "knots that miss a lobe": (
        pair({"type": "phases", "knots_deg": [0, 160, 350], "ratios": [1.2, 0.8, 1.2]}, [40, 40]),
        {"law.knots_deg"},
    ),
    "knots of three phases": (
        pair({"type": "three-phase-polynomial", "knots_deg": [0, 160, 270, 350], "lowest": 0.8},
             [40, 40]),
        {"law.knots_deg[3]"},
    ),
    "lowest ratio": (
        pair({"type": "three-phase-polynomial", "knots_deg": [0, 160, 270, 360], "lowest": 1.2},
             [40, 40]),
        {"law.lowest"},
    ),
    "harmonics": (
        pair({"type": "fourier", "cosines": [0.9, -0.4], "sines": [0.3]}, [40, 40]),
        {"law.cosines", "law.sines"},
    ),
    "corner radius": (
        pair({"type": "rounded-polygon", "corners": 4, "corner_radius": 0.6}, [60, 60]),
        {"law.corner_radius"},
    ),
    "corners": (
        pair({"type": "rounded-polygon", "corners": 3, "corner_radius": 0.25}, [80, 40]),
        {"law.corners"},
    ),
    "lobes": (
        pair({"type": "lobed", "eccentricity": 0.1, "lobes": [3, 2]}, [40, 40]), {"law.lobes"}
    ),
    "one lobe": (pair({"type": "limacon", "eccentricity": 0.1}, [40, 60]), {"pair.teeth"}),
    "a crank's teeth": (
        pair({"type": "motion", "slide": "1 - cos(phi1)", "rod": 4}, [40, 60]), {"pair.teeth"}
    ),
    "the ring first": (
        pair({"type": "ellipse", "eccentricity": 0.1}, [60, 30], pair=RING), {"pair.teeth"}
    ),
    "an equal ring": (
        pair({"type": "ellipse", "eccentricity": 0.1}, [30, 30], pair=RING),
        {"pair.teeth", "pair.type"},
    ),
    "one lobe in a ring": (
        pair({"type": "limacon", "eccentricity": 0.1}, [50, 60], pair=RING), {"pair.teeth"}
    ),
    "a rack's ring": (pair({"type": "rack", "r1": "1"}, [40, 60], pair=RING), {"pair.type"}),
    "harmonics of a ring": (
        pair({"type": "fourier", "cosines": [0.6]}, [40, 60], pair=RING), {"law.cosines"}
    ),
    "phases of a ring": (
        pair({"type": "phases", "knots_deg": [0, 60, 300, 360], "ratios": [1.1, 0.38, 0.38, 1.1]},
             [60, 120], pair=RING),
        {"law.ratios"},
    ),
    "lobes that fit when swapped": (
        pair({"type": "lobed", "eccentricity": 0.1, "lobes": [4, 2]}, [20, 40]), {"law.lobes"}
    ),
    "an outside within the roots, and bolts": (
        pair(CIRCLE, [24, 48], pair=RING, ring={"outer_diameter_mm": 90}, blank=BOLTED),
        {"ring.outer_diameter_mm"},
    ),
    "a rim too thin for its bolts": (
        pair(CIRCLE, [24, 48], pair=RING, ring={"rim_mm": 6}, blank=BOLTED), {"ring.rim_mm"}
    ),
    "bolts within the teeth of a thin rim": (
        pair(CIRCLE, [24, 48], pair=RING, ring={"rim_mm": 6},
             blank=BOLTED | {"bolt_circle_mm": [0, 100]}),
        {"ring.rim_mm"},
    ),
    "a rim that follows, too thin for its bolts": (
        pair({"type": "ellipse", "eccentricity": 0.3}, [24, 48], pair=RING,
             ring={"rim_mm": 6, "outer": "follow"}, blank=BOLTED),
        {"ring.rim_mm"},
    ),
    "a table that does not repeat": (
        pair({"type": "table", "phi1_deg": [0, 60, 120, 180, 240, 300, 360],
              "ratio": [1.2, 1.1, 0.9, 0.8, 0.9, 1.1, 1.3]}, [40, 40]),
        {"law.ratio[6]"},
    ),
    "a table that begins late": (
        pair({"type": "table", "phi1_deg": [1, 60, 120, 180, 240, 300, 360],
              "ratio": [1.2, 1.1, 0.9, 0.8, 0.9, 1.1, 1.2]}, [40, 40]),
        {"law.phi1_deg[6]"},
    ),
    "a table that ends early": (
        pair({"type": "table", "phi1_deg": [0, 60, 120, 180, 240, 300, 350],
              "ratio": [1.2, 1.1, 0.9, 0.8, 0.9, 1.1, 1.2]}, [40, 40]),
        {"law.phi1_deg[6]"},
    ),
    "a travel that a formula misses": (
        pair({"type": "formula", "phi2": "phi1 + 0.2*sin(phi1)", "driver_travel_deg": 300,
              "driven_travel_deg": 250}, [30, 30]),
        {"law.driven_travel_deg"},
    ),
    "ends of a spiral that meet": (
        pair({"type": "log-spiral", "ratios": [0.3, 3], "driven_travel_deg": 350}, [40, 40]),
        {"law.driven_travel_deg"},
    ),
    "ratios of a closed spiral": (
        pair({"type": "log-spiral", "ratios": [0.5, 2.2], "return_deg": 90}, [48, 48]),
        {"law.ratios[0]", "law.ratios[1]"},
    ),
    "teeth of a closed spiral": (
        pair({"type": "log-spiral", "ratios": [0.8, "solve"], "return_deg": 90}, [40, 60]),
        {"pair.teeth"},
    ),
    "a concave return": (
        pair({"type": "log-spiral", "ratios": [2, 0.5], "return_deg": 40}, [36, 36]),
        {"law.ratios", "law.return_deg", "pair.teeth"},
    ),
    "teeth of an open pair": (pair(DOOR, [30, 36]), {"pair.teeth"}),
    "a long way": (pair(DOOR | {"driven_travel_deg": 300, "ratios": [1, 0.6, 0.6]}, [40, 40]),
                   {"law.driven_travel_deg"}),
    "steps of an open pair": (pair(DOOR, [30, 30], steps={"count": 3}), {"steps.count"}),
    "follower's offset": (cam(ROLLER | {"offset_mm": 35}, {"prime_radius_mm": 30}),
                          {"follower.offset_mm", "cam.prime_radius_mm"}),
    "lift below the axis": (
        cam(ROLLER, {"prime_radius_mm": 20}) | {"motion": [
            {"type": "segment", "angle_deg": 180, "to_mm": -25},
            {"type": "segment", "angle_deg": 180, "to_mm": 0},
        ]},
        {"cam.prime_radius_mm", "motion[0].to_mm"},
    ),
    "drawn beyond a plate's way": (
        plate() | {"output": {"files": ["svg"], "travel_mm": 5000}}, {"output.travel_mm"}
    ),
    "drawn beyond a travel": (
        pair(DOOR, [30, 30], output={"files": ["svg"], "phi1_deg": -20}), {"output.phi1_deg"}
    ),
    "bolts beyond a plate": (plate(bolt_spacing_mm=230), {"blank.bolt_spacing_mm"}),
    "bolts on the edge of a plate": (plate(bolt_height_mm=2), {"blank.bolt_height_mm"}),
    "bolts in each other": (plate(bolt_spacing_mm=5), {"blank.bolt_spacing_mm"}),
    "arm": (cam(ARM, {"prime_radius_mm": 15}), {"cam.prime_radius_mm"}),
    "arm's swing": (
        cam(ARM, {"prime_radius_mm": 60}, lift=150), {"motion[0].lift_deg", "motion[2].lift_deg"}
    ),
    "face": (cam(FACE, {"base_radius_mm": 90}), {"cam.base_radius_mm"}),
    "face's swing": (
        cam(FACE, {"base_radius_mm": 40}, lift=25, angles=[90, 90, 40, 140]),
        {"motion[0].lift_deg", "motion[2].lift_deg"},
    ),
}  # fmt: skip
"""Design files that are refused, and keys of which some must be in a remedy."""

ERRORS: dict[str, tuple[dict[str, Any], set[str], set[str]]] = {
    "undercut that leaves nothing to drive": (
        pair({"type": "ellipse", "eccentricity": 0.6}, [12, 12]),
        {"contact-ratio", "undercut"},
        {"pair.teeth", "pair.module_mm"},
    ),
    "unequal lobes": (
        pair({"type": "ellipse", "eccentricity": 0.3}, [16, 8]),
        {"contact-ratio", "undercut"},
        {"pair.teeth", "pair.module_mm"},
    ),
    "short teeth": (
        pair(CIRCLE, [40, 40], rack={"addendum": 0.5}),
        {"contact-ratio"},
        {"rack.addendum"},
    ),
    "rounded tips": (
        pair(
            CIRCLE,
            [12, 12],
            rack={"pressure_angle_deg": 28},
            blank={"tip_rounding_mm": 1},
        ),
        {"contact-ratio"},
        {"blank.tip_rounding_mm"},
    ),
    "a steep return": (
        pair({"type": "log-spiral", "ratios": [0.5, 2], "return_deg": 60}, [30, 30]),
        {"contact-ratio", "undercut"},
        {"law.ratios", "law.return_deg", "pair.teeth"},
    ),
    "a kerf too wide for flanks": (
        pair(CIRCLE, [18, 18], output={"kerf_mm": 2.9}, blank={"bore_diameter_mm": 8}),
        {"wide-kerf"},
        {"output.kerf_mm"},
    ),
    "undercut cam": (
        cam(
            ROLLER | {"roller_radius_mm": 20}, {"prime_radius_mm": 30}, 20, angles=[60, 60, 60, 180]
        ),
        {"undercut"},
        {"cam.prime_radius_mm", "follower.roller_radius_mm"},
    ),
}
"""Design files that build with errors, those, and keys of which some must be in a remedy."""

UNDER = pair({"type": "ellipse", "eccentricity": 0.3}, [30, 15])
NAIL = by_distance(
    {"type": "phases", "knots_deg": [0, 160, 360], "ratios": [1.6, 0.4, 1.6]}, [36, 36], 180
)
WARNED = {
    "undercut": (UNDER, "undercut"),
    "undercut at a centre distance": (NAIL, "undercut"),
    "undercut of a shifted wheel": (
        pair({"type": "ellipse", "eccentricity": 0.2}, [20, 20], pair={"x": -0.3}), "undercut"
    ),
    "undercut above and below": (
        pair({"type": "formula", "r1": "1 + 0.3*cos(2*phi1)"}, [40, 40]), "undercut"
    ),
    "sharp": (
        pair({"type": "ellipse", "eccentricity": 0.4}, [40, 20], limits={"convex_radius": 9}),
        "sharp",
    ),
    "wide": (
        pair({"type": "formula", "r1": "1 + 0.3*cos(2*phi1)"}, [40, 40],
             limits={"cutter_teeth": 50}),
        "concave-teeth",
    ),
}  # fmt: skip
"""Design files with warnings that name tooth counts."""


def followed(document: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """A document with other values at dotted keys; a value for both wheels becomes two."""
    made = copy.deepcopy(dict(document))
    for key, value in changes.items():
        steps: list[Any] = [int(s) if s.isdigit() else s for s in re.findall(r"[^.\[\]]+", key)]
        place: Any = made
        for step, after in pairwise(steps):
            if isinstance(after, int) and not isinstance(place.get(step), list):
                place[step] = [place.get(step, 0)] * 2
            place = place.setdefault(step, {}) if isinstance(place, dict) else place[step]
        place[steps[-1]] = value
    return made


def job_of(document: Mapping[str, Any], folder: Path) -> Any:
    """The shared result of a design that is read from its file."""
    file = folder / "design.toml"
    file.write_text(toml_text(document), encoding="utf-8")
    return built(file)
