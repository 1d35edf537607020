"""Random cams: all motion laws and followers, segments, whole turns, both directions, blanks.

Lifts and sizes are drawn in radii of the cam, so that the radius is arbitrary.
"""

from __future__ import annotations

import math
from typing import Any, Final

from gearcam.designs.outputs import MESHES
from gearcam.kinds.cam.tables import GOALS
from gearcam.laws.motion import MOTION_LAWS
from random_designs.blank import blank, marks
from random_designs.draw import Draw, short
from random_designs.goals import seek
from random_designs.laws import random_motion_law
from random_designs.output import asked, drawn, drive, dynamics, forces, studies

FOLLOWERS: Final = ("knife-edge", "roller", "flat", "domed", "point", "roller", "flat", "domed")
"""Followers, which take turns; a point is a knife edge."""

_SOLVABLE: Final = ("offset_mm", "pivot_distance_mm", "arm_mm", "roller_radius_mm")
"""Sizes of a follower that may be solved for."""

_DEGREES: Final = 40
"""Angle drawn instead of a lift or a travel of one radius, deg."""

_SHARES: Final = {
    "svg": 0.8, "dxf": 0.3, "inspection": 0.3, "cut-svg": 0.2, "drawing-svg": 0.2,
    "drawing-dxf": 0.05, **dict.fromkeys(MESHES, 0.06), "step": 0.01,
    "tool-path": 0.2, "curvature": 0.3, "caliper": 0.2, "report": 0.06,
}  # fmt: skip
"""Share of cams with each kind of file, by its cost."""


def in_turn(index: int, laws: int) -> tuple[int, int]:
    """Return the numbers of the law, of so many `laws`, and of the follower of a design.

    Every law meets every follower, also where the two counts have a common divisor.
    """
    return index % laws, sum(divmod(index, laws)) % len(FOLLOWERS)


def _moved(d: Draw, kind: str, law: str) -> dict[str, Any]:
    return {"type": kind, **random_motion_law(d, law)}


def motion_by_phases(d: Draw, law: str, lift: float, unit: str) -> list[dict[str, Any]]:
    """Return phases over a turn; `lift` in `unit`, which is mm or deg."""
    back = law if law == "3-4-5-6" or d.chance(0.3) else d.pick([*MOTION_LAWS])
    back = law if back == "3-4-5-6" else back
    up = {**_moved(d, "rise", law), f"lift_{unit}": lift}
    if law != "3-4-5-6" and d.chance(0.2):
        first = short(lift * d.even(0.3, 0.7))
        second = {**_moved(d, "rise", d.pick(["cycloidal", "3-4-5"])), f"lift_{unit}": lift}
        second[f"lift_{unit}"] = short(lift - first)
        phases = [{**up, f"lift_{unit}": first}, {"type": "dwell"}, second]
    elif d.chance(0.2):
        phases = [_segment(d, lift, unit), _segment(d, short(lift * d.even(0.6, 0.9)), unit)]
    else:
        phases = [up]
    if law != "3-4-5-6" and d.chance(0.6):
        phases.append({"type": "dwell"})
    down = {"type": "segment", f"to_{unit}": 0} if d.chance(0.15) else _moved(d, "return", back)
    phases.append(down)
    if d.chance(0.7):
        phases.append({"type": "dwell"})
    shares = d.shares(len(phases))
    angles = [short(360 * share) for share in shares[:-1]]
    for phase, angle in zip(phases, [*angles, 360 - sum(angles)], strict=True):
        phase["angle_deg"] = angle
    return phases


def motion_of_turn(d: Draw, lift: float, unit: str) -> dict[str, Any]:
    """Return a motion of the whole turn: a power of half a wave, by rows or by a formula."""
    power = d.whole(1, 3)
    if d.chance(0.3):
        height = math.radians(lift) if unit == "deg" else lift
        return {"lift": f"{height!r}*((1 - cos(theta))/2)**{power}"}
    count = d.whole(12, 72)
    theta = [short(360 * k / count) for k in range(count)]
    waves = [(0.5 - 0.5 * math.cos(math.radians(angle))) ** power for angle in theta]
    motion: dict[str, Any] = {
        "theta_deg": theta,
        f"lift_{unit}": [short(lift * wave) for wave in waves],
    }
    if d.chance(0.4):
        motion[f"smoothing_tolerance_{unit}"] = short(lift * d.log(1e-5, 1e-2))
    return motion


def _measured(d: Draw, design: dict[str, Any]) -> None:
    """Change a few discs to their radii, of a convex profile that any follower reaches."""
    cam, follower = design["cam"], design["follower"]
    solved = "solve" in [*cam.values(), *follower.values()]
    if not d.chance(0.06) or solved or cam.get("form", "disc") != "disc":
        return
    if design.get("drive", {}).get("polydyne"):
        return
    end = follower.get("roller_radius_mm", 0) + follower.get("dome_radius_mm", 0)
    base = cam.get("base_radius_mm") or cam["prime_radius_mm"] - end
    lift, count = 0.1 * base, d.whole(24, 72)
    angles = [short(360 * k / count) for k in range(count)]
    waves = [0.5 - 0.5 * math.cos(math.radians(angle)) for angle in angles]
    design["motion"] = {
        "angle_deg": angles, "radius_mm": [round(base + lift * wave, 9) for wave in waves]
    }  # fmt: skip
    if d.chance(0.4):
        design["motion"]["radius_tolerance_mm"] = short(lift * d.log(1e-5, 1e-2))


def _ground(d: Draw, design: dict[str, Any], size: float) -> None:
    """Ask for the tables of calipers and wheels of a few cams, in other steps."""
    output, slides = design["output"], design["cam"].get("form") == "translating"
    if d.chance(0.1):
        output["caliper_step_mm" if slides else "caliper_step_deg"] = short(d.log(1, 40))
    pointed = design["follower"]["type"] in ("knife-edge", "point")  # it makes inner corners
    if slides or pointed or not d.chance(0.15):
        return
    output["files"] = [*output["files"], "grinding"]
    if d.chance(0.5):
        output["grinding_wheel_radius_mm"] = short(size * d.log(0.01, 0.1))
    elif design["follower"]["type"] == "flat" and d.chance(0.5):
        output["grinding_wheel_radius_mm"] = "flat"


def _segment(d: Draw, to: float, unit: str) -> dict[str, Any]:
    segment = {"type": "segment", f"to_{unit}": to}
    if d.chance(0.5):
        segment[f"end_velocity_{unit}_per_rad"] = short(to * d.even(-0.3, 0.3))
    if d.chance(0.2):
        segment[f"end_acceleration_{unit}_per_rad2"] = short(to * d.even(-0.5, 0.5))
    return segment


def _mechanism(d: Draw, kind: str, swings: bool, size: float) -> tuple[dict[str, Any], ...]:
    """Return follower and cam with a base circle of `size`, mm."""
    follower: dict[str, Any] = {"type": kind}
    radius = 0.0
    if kind == "roller":
        radius = follower["roller_radius_mm"] = short(size * d.log(0.02, 1))
    elif kind == "domed":
        radius = follower["dome_radius_mm"] = short(size * d.log(0.2, 3))
    prime = short(size + radius)
    if swings:
        pivot = follower["pivot_distance_mm"] = short(prime * d.even(1.4, 3))
        follower["motion"] = "oscillating"
        if kind == "flat":
            follower["face_offset_mm"] = short(size * d.even(-0.3, 0.3))
        else:
            follower["arm_mm"] = short(pivot + prime * d.even(-0.5, 0.3))
    elif kind != "flat" and d.chance(0.5):
        follower["offset_mm"] = short(size * d.even(-0.4, 0.4))
    based = kind == "flat" or d.chance(0.4)
    cam = {"base_radius_mm": short(size)} if based else {"prime_radius_mm": prime}
    cam["thickness_mm"] = short(size * d.log(0.05, 1))
    return follower, cam


def _held(d: Draw, design: dict[str, Any], lift: float) -> None:
    """Change a design whose follower can be driven both ways to conjugate cams or a yoke."""
    follower, wheel = design["follower"], design["cam"]
    kind, swings = follower["type"], "motion" in follower
    if kind == "roller" and d.chance(0.7):
        radius = follower["roller_radius_mm"]
        prime = wheel.get("prime_radius_mm") or wheel["base_radius_mm"] + radius
        wheel["form"] = "conjugate"
        wheel["gap_mm"] = short(radius * d.even(0, 1))
        follower["roller2_radius_mm"] = short(radius * d.even(0.7, 1.3))
        if d.chance(0.5):
            follower["preload_mm"] = short(min(10.0, radius * d.log(1e-4, 1e-2)))
        if swings:
            follower["arm2_mm"] = follower["arm_mm"]
        if d.chance(0.5):
            wheel["prime_radius2_mm"] = short(prime * d.even(0.9, 1.2))
        elif swings:
            arm, pivot = follower["arm_mm"], follower["pivot_distance_mm"]
            cosine = (arm**2 + pivot**2 - prime**2) / (2 * arm * pivot)
            start = math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
            follower["arms_angle_deg"] = short(lift + start * d.even(1.9, 2.2))
        else:
            follower["roller_distance_mm"] = short(lift + prime * d.even(1.9, 2.2))
    elif not swings and not follower.get("offset_mm") and isinstance(design["motion"], list):
        wheel["form"] = "yoke"
        share = d.even(0.4, 0.9)
        rise = {"type": "rise", "law": d.pick(["cycloidal", "3-4-5", "modified-sine"])}
        rise |= {"angle_deg": short(180 * share), "lift_mm": lift}
        design["motion"] = [rise, {"type": "dwell", "angle_deg": "rest"}]


def _groove(d: Draw, design: dict[str, Any], size: float, lift: float) -> None:
    """Change a design to a groove cam."""
    given, follower = design["cam"], design["follower"]
    radius = follower["roller_radius_mm"]
    reach = size + 2 * radius + lift * math.radians(follower.get("arm_mm", math.degrees(1.0)))
    given |= {
        "form": "groove",
        "outer_diameter_mm": short(2 * reach * d.even(1.05, 1.6)),
        "groove_depth_mm": short(given["thickness_mm"] * d.even(0.2, 0.9)),
    }
    if d.chance(0.6):
        given["roller_clearance_mm"] = short(radius * d.log(1e-3, 0.05))
    if d.chance(0.5):
        given["side"] = d.pick(["front", "back"])
    if d.chance(0.3):
        follower["roller2_radius_mm"] = short(radius * d.even(0.6, 1.5))


def _bar(d: Draw, size: float) -> dict[str, Any]:
    """Return the blank of a translating cam."""
    blank: dict[str, Any] = {"height_mm": short(size * d.even(2, 6))}
    if d.chance(0.5):
        blank["length_mm"] = short(size * d.even(9, 20))
    if d.chance(0.3):
        blank |= {
            "bolts": 2,
            "bolt_diameter_mm": short(0.1 * size),
            "bolt_spacing_mm": short(size * d.even(2, 6)),
            "bolt_height_mm": short(size * d.even(0.2, 0.6)),
        }
    return blank


def _slide(d: Draw, design: dict[str, Any], size: float) -> None:
    """Change a design to a translating cam, with travels instead of angles."""
    follower = design["follower"]
    for phase in design["motion"]:
        phase["travel_mm"] = short(phase.pop("angle_deg") / _DEGREES * size)
    follower.pop("offset_mm", None)
    if "arm_mm" in follower:
        follower["pivot_height_mm"] = short(follower["arm_mm"] * d.even(-0.5, 0.5))
    elif d.chance(0.5):
        follower["axis_deg"] = d.even(-30, 30)
    given = {"form": "translating", "thickness_mm": design["cam"]["thickness_mm"]}
    for key in ("run_in_mm", "run_out_mm"):
        if d.chance(0.7):
            given[key] = short(size * d.even(0.1, 1))
    if follower["type"] == "roller" and d.chance(0.5):
        given["walls"] = "both"
        if d.chance(0.5):
            given["roller_clearance_mm"] = short(size * d.log(1e-4, 1e-2))
    design["cam"] = given
    design["blank"] = _bar(d, size)
    output = design["output"]
    for key, own in (("theta_deg", "travel_mm"), ("motion_step_deg", "travel_step_mm")):
        if key in output:
            output[own] = short(abs(output.pop(key)) / _DEGREES * size)


def _form(d: Draw, design: dict[str, Any], size: float, lift: float) -> None:
    """Change the form of some designs, if their follower and motion allow it."""
    motion, kind = design["motion"], design["follower"]["type"]
    told = isinstance(motion, list) and all(phase["angle_deg"] != "rest" for phase in motion)
    if d.chance(0.3):
        _held(d, design, lift)
    elif kind == "roller" and d.chance(0.3):
        _groove(d, design, size, lift)
        design.pop("blank", None)
    elif kind != "flat" and told and d.chance(0.2):
        _slide(d, design, size)


def _precision(d: Draw, design: dict[str, Any], size: float) -> dict[str, Any]:
    """Return tolerances of some sizes that the mechanism has, and a wanted error."""
    follower, form = design["follower"], design["cam"].get("form", "disc")
    swings, kind = "motion" in follower, follower["type"]
    angles = ["arms_angle"] if swings else ["axis"]
    lengths = ["profile", *(["pivot_distance", "pivot_height"] if swings else ["offset"])]
    if form == "translating":
        lengths.append("travel")
    else:
        angles.append("cam_angle")
    if kind in ("roller", "domed"):
        lengths.append("radius")
    if swings:
        lengths.append("face_offset" if kind == "flat" else "arm")
    elif kind == "flat":
        angles.append("face_angle")
    if form != "conjugate":
        angles = [name for name in angles if name != "arms_angle"]
    elif not swings:
        lengths.append("roller_distance")
    made: dict[str, Any] = {
        f"{name}_tolerance_mm": short(size * d.log(1e-6, 1e-3)) for name in lengths if d.chance(0.6)
    }
    made |= {f"{name}_tolerance_deg": d.log(1e-4, 0.5) for name in angles if d.chance(0.6)}
    if d.chance(0.7):
        key, scale = ("lift_error_deg", 1.0) if swings else ("lift_error_mm", size)
        made[key] = max(1e-6, short(scale * d.log(1e-5, 1e-3)))
        if d.chance(0.3):
            made["combined"] = d.pick(["worst-case", "root-of-squares"])
    return made


def _solved(d: Draw, design: dict[str, Any], size: float) -> None:
    """Ask for sizes of a disc cam, sometimes with a goal and ranges."""
    follower, cam = design["follower"], design["cam"]
    key = "base_radius_mm" if "base_radius_mm" in cam else "prime_radius_mm"
    keys = [(cam, key), *((follower, one) for one in follower if one in _SOLVABLE)]
    for table, one in keys:
        if one == key or d.chance(0.4):
            table[one] = "solve"
    if d.chance(0.3):
        design["goal"] = {d.pick(["minimize", "maximize"]): d.pick([*GOALS])}
    if d.chance(0.3):
        design["bounds"] = {
            one: [short(size * d.even(0.1, 1)), short(size * d.even(2, 5))]
            for table, one in keys
            if table[one] == "solve"
        }
    elif follower.get("offset_mm") == "solve":
        design["bounds"] = {"offset_mm": [short(-size), short(size)]}


def _studies(d: Draw, design: dict[str, Any], size: float) -> None:
    studies(d, design, "cam", d.pick(["accuracy", "precision"]))
    if d.chance(0.15):
        design["precision"] = _precision(d, design, size)
    if d.chance(0.03):
        wall = d.pick(["1", "inner", "outer"])
        design["follow"] = {"file": "measured.csv", "wall": wall, "fit": True}


def design(d: Draw, index: int) -> dict[str, Any]:
    """Return a random cam; motion laws and followers take turns.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    index : int
        Number of the design.
    """
    at, follower_at = in_turn(index, len(MOTION_LAWS))
    law, kind = [*MOTION_LAWS][at], FOLLOWERS[follower_at]
    swings = d.chance(0.4)
    size = d.pick([d.log(0.1, 1e5), d.log(10, 100)])
    follower, wheel = _mechanism(d, kind, swings, size)
    share = d.log(0.002, 0.15 if kind == "flat" else 0.7)
    lift = short(share * _DEGREES) if swings else short(share * size)
    if d.chance(0.5):
        wheel["rotation"] = d.pick(["ccw", "cw"])
    unit = "deg" if swings else "mm"
    program = motion_by_phases(d, law, lift, unit)
    output: dict[str, Any] = {"chord_tolerance_mm": min(1.0, short(size * d.log(1e-5, 1e-3)))}
    made: dict[str, Any] = {"motion": program, "follower": follower, "cam": wheel}
    if d.chance(0.5):
        made["blank"] = blank(d, 0.8 * size, 0.05 * size, both=False)
    made["output"] = output
    if 10 < size < 100 and d.chance(0.3):
        del output["chord_tolerance_mm"]
    if d.chance(0.3):
        output["motion_step_deg"] = d.log(0.2, 20)
    if d.chance(0.2):
        output["theta_deg"] = d.even(-400, 400)
    if kind in ("flat", "knife-edge", "point") or d.chance(0.3):
        output["tool_radius_mm"] = short(size * d.log(0.02, 0.3))
    if d.chance(0.1):
        made["motion"] = motion_of_turn(d, lift, unit)
    elif d.chance(0.1):
        d.pick(program)["angle_deg"] = "rest"
    _form(d, made, size, lift)
    made["output"] |= asked(d, _SHARES)
    drive(d, made, "speed_mm_s" if made["cam"].get("form") == "translating" else "speed_rpm")
    forces(d, made, swings)
    dynamics(d, made, swings)
    if made["cam"].get("form", "disc") == "disc" and d.chance(0.06):
        _solved(d, made, size)
    _measured(d, made)
    _ground(d, made, size)
    _studies(d, made, size)
    disc = made["cam"].get("form", "disc") == "disc"
    seek(made, index, *(GOALS if disc else ("cam.pressure_angle_deg.max", "motion.peak_jerk")))
    marks(d, made, 0.05 * size, "zero_mark")
    drawn(d, made, "print-pdf")
    return made
