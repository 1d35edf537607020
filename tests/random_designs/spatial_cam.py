"""Random cams in space: all motion laws, followers that slide and swing, cylinders and cones.

Lifts and sizes are drawn in radii of the cylinder, so that the radius is arbitrary.
"""

from __future__ import annotations

import math
from typing import Any, Final

from gearcam.designs.outputs import MESHES
from gearcam.laws.motion import MOTION_LAWS
from random_designs.blank import classes, marks
from random_designs.cam import motion_by_phases, motion_of_turn
from random_designs.draw import Draw, short
from random_designs.goals import seek
from random_designs.output import drawn, drive, forces_in_space, studies

_LAWS: Final = tuple(
    name
    for name, entry in MOTION_LAWS.items()
    if entry.continuity.startswith(("C1:", "C2:", "C3", "at least"))
)
"""Laws without jumps of the velocity, which are refused."""

_KEPT: Final = ("type", "angle_deg", "lift_mm", "lift_deg")
"""Keys of a phase with any law."""

_SHARES: Final = {
    "svg": 0.5, "dxf": 0.2, **dict.fromkeys(MESHES, 0.06), "report": 0.03, "caliper": 0.1,
}  # fmt: skip
"""Share of cams with each kind of file, by its cost."""


def design(d: Draw, index: int) -> dict[str, Any]:
    """Return a random cam in space as the tables of its file.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    index : int
        Number of the design: laws take turns.
    """
    size, law = d.log(10, 200), _LAWS[index % len(_LAWS)]
    swings, depth = d.chance(0.4), size * d.even(0.1, 0.4)
    height = size * d.log(0.05, 0.8)
    arm = size * d.even(1.0, 3.0)
    lift = short(math.degrees(height / arm) if swings else height)
    unit = "deg" if swings else "mm"
    by_turn = d.chance(0.2)
    motion = motion_of_turn(d, lift, unit) if by_turn else motion_by_phases(d, law, lift, unit)
    if not by_turn and d.chance(0.9):
        _soften(motion)
    radius = short(size * d.log(0.04, 0.25))
    follower = {"roller_radius_mm": radius, **_shape(d, radius, depth), **_guided(d, depth)}
    if swings:
        follower |= _arm(d, arm, lift)
    given = _cylinder(d, size, depth, height, radius)
    if not swings and d.chance(0.15):
        given |= {"walls": "rib", "rib_mm": short(size * d.even(0.1, 0.5))}
    made = {"motion": motion, "follower": follower, "cam": given, "output": _output(d)}
    if d.chance(0.4):
        made["blank"] = {"bore_diameter_mm": short(2 * (size - depth) * d.even(0.1, 0.8))}
        classes(d, made["blank"])
        if d.chance(0.5):
            made["blank"]["density_kg_m3"] = 7850
    if d.chance(0.2):
        made["developed"] = {"steps": d.whole(12, 60), "radii": d.whole(2, 5)}
        made["output"]["studies"] = ["developed"]
    studies(d, made, "solid")
    _milled(made, index, radius)
    if index % 13 == 7:  # by number: others draw the same as before
        given["outer_diameter_mm"] = "solve"
    drive(d, made)
    forces_in_space(d, made, swings)
    seek(made, index, "cam.pressure_angle_deg.max", "cam.outer_diameter_mm")
    marks(d, made, 0.2 * radius, "zero_mark")
    drawn(d, made)
    return made


def _guided(d: Draw, depth: float) -> dict[str, Any]:
    found: dict[str, Any] = {"type": "roller"} if d.chance(0.2) else {}
    if d.chance(0.2):
        found["roller_length_mm"] = short(depth * d.even(0.5, 1))
    return found


def _arm(d: Draw, arm: float, lift: float) -> dict[str, Any]:
    found: dict[str, Any] = {"motion": "oscillating", "arm_mm": short(arm)}
    if d.chance(0.2):
        found["pivot_distance_mm"] = short(arm * d.even(0.97, 1.0))
    if d.chance(0.2):
        found["start_deg"] = short(-lift * d.even(0.3, 0.7))
    return found


def _milled(made: dict[str, Any], index: int, radius: float) -> None:
    """Give some designs a tool and its paths, few a STEP file; by number, so that it draws none."""
    files, follower = made["output"]["files"], made["follower"]
    files += [word for word, k in (("tool-path", 3), ("gcode", 11)) if index % 17 == k]
    files += ["step"] if index % 101 == 50 else []
    if index % 17 in (3, 11):
        made["output"]["path_tolerance_mm"] = short(2e-3 * radius)
        made["tool"] = {"feed_mm_min": 100 + index, "spindle_rpm": 6000, "depth_mm": short(radius)}
        if index % 2:
            made["tool"] |= {"diameter_mm": short(1.6 * radius), "clearance_height_mm": 3}
            made["tool"]["rotary"] = "wrapped"
        if index % 3 == 0 and follower.get("cone_deg") != "apex":
            made["tool"]["cone_deg"] = follower.get("cone_deg", 0)


def _soften(motion: Any) -> None:
    """Take jumps of the velocity, which are refused, from phases."""
    for phase in motion:
        if phase.get("law") not in (None, *_LAWS):
            kept = {
                key: phase[key] for key in phase if key in ("type", "angle_deg") or "lift" in key
            }
            phase.clear()
            phase.update(kept | {"law": "cycloidal"})
        for key in [key for key in phase if key.startswith("end_velocity")]:
            del phase[key]


def _shape(d: Draw, radius: float, depth: float) -> dict[str, Any]:
    """Return the cone of a roller that is thinner inside, in some designs."""
    if d.chance(0.4):
        return {}
    if d.chance(0.4):
        return {"cone_deg": "apex"}
    return {"cone_deg": short(math.degrees(math.atan(radius / depth * d.even(0.05, 0.4))))}


def _cylinder(d: Draw, size: float, depth: float, height: float, radius: float) -> dict[str, Any]:
    margin = size * d.even(0.05, 0.5)
    given: dict[str, Any] = {
        "form": "cylinder",
        "outer_diameter_mm": short(2 * size),
        "lowest_mm": short(radius + margin),
        "length_mm": short(height + 2.2 * (radius + margin)),
        "groove_depth_mm": short(depth),
    }
    clearance = short(radius * d.log(1e-3, 0.05)) if d.chance(0.5) else 0.0
    if d.chance(0.5):
        given["floor_clearance_mm"] = short(depth * d.even(0.0, 0.1))
    if d.chance(0.3):
        given["walls"] = d.pick(["upper", "lower", "both"])
    if clearance and given.get("walls", "both") == "both":
        given["roller_clearance_mm"] = clearance
    if d.chance(0.3):
        given["rotation"] = d.pick(["cw", "ccw"])
    return given


def _output(d: Draw) -> dict[str, Any]:
    output: dict[str, Any] = {"files": ["csv", *(one for one, p in _SHARES.items() if d.chance(p))]}
    output |= {"wall_step_deg": short(d.log(2, 5)), "wall_points": d.whole(2, 7)}
    if d.chance(0.3):
        output["motion_step_deg"] = short(d.log(0.5, 10))
    if d.chance(0.3):
        output["theta_deg"] = short(d.even(-400, 400))
    if d.chance(0.1):
        output["caliper_step_deg"] = short(d.log(1, 40))
    return output
