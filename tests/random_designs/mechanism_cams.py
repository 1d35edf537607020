"""Cams in space and plates that drive random mechanisms, and roughly how they move."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Any, Final

from random_designs.draw import Draw, short
from random_designs.mechanism_parts import TURN

if TYPE_CHECKING:
    from random_designs.mechanism import Machine, Placed

IN_SPACE: Final = ("lifting drum", "swinging drum", "globoid")
"""Cams in space, which may be masters."""

_LAWS: Final = ("cycloidal", "3-4-5", "modified-sine", "modified-trapezoid")


def drum_design(d: Draw, size: float, *, swings: bool) -> dict[str, Any]:
    """Return a cylinder cam of a size, mm, by its tables."""
    arm, lift = short(size * d.even(1.5, 2.0)), short(size * d.even(0.1, 0.4))
    radius = short(0.12 * size)
    follower: dict[str, Any] = {"roller_radius_mm": radius}
    rise: dict[str, Any] = {"lift_mm": lift}
    if swings:
        rise = {"lift_deg": short(math.degrees(2.0 * math.asin(0.5 * lift / arm)))}
        follower |= {"motion": "oscillating", "arm_mm": arm}
    motion = [
        {"type": "rise", "law": d.pick(_LAWS), "angle_deg": d.even(100, 150), **rise},
        {"type": "dwell", "angle_deg": d.even(10, 40)},
        {"type": "return", "law": d.pick(_LAWS), "angle_deg": d.even(100, 140)},
        {"type": "dwell", "angle_deg": "rest"},
    ]
    margin = short(size * d.even(0.05, 0.2))
    cam = {
        "form": "cylinder", "outer_diameter_mm": short(2.0 * size),
        "length_mm": short(lift + 2.1 * (radius + margin)), "lowest_mm": short(radius + margin),
        "groove_depth_mm": short(0.15 * size),
    }  # fmt: skip
    if d.chance(0.3):
        cam["walls"] = d.pick(["upper", "lower", "both"])
    if d.chance(0.4):
        cam["rotation"] = "cw"
    return {"kind": "cam", "name": "drum", "motion": motion, "follower": follower, "cam": cam}


def globoid_design(d: Draw, size: float) -> dict[str, Any]:
    """Return a globoidal cam of few stops, by its tables."""
    stops = d.whole(5, 7)
    reach, long = short(0.5 * size), short(0.1 * size)
    radius = short(0.4 * (reach - long) * math.sin(math.pi / stops))
    turret = {"stops": stops, "roller_length_mm": long, "reach_mm": reach,
              "roller_radius_mm": radius}  # fmt: skip
    cam: dict[str, Any] = {"form": "globoidal", "center_distance_mm": short(size)}
    if d.chance(0.4):
        cam["rotation"] = "cw"
    index = {"law": d.pick(_LAWS[:3]), "angle_deg": d.even(100, 200)}
    return {"kind": "cam", "name": "globoid", "index": index, "turret": turret, "cam": cam}


def plate_design(d: Draw, size: float, *, swings: bool) -> dict[str, Any]:
    """Return a plate of the size of a machine, mm, by its tables."""
    lift = short(size * d.even(0.05, 0.2))
    rise: dict[str, Any] = {"lift_mm": lift}
    follower: dict[str, Any] = {"type": "roller", "roller_radius_mm": short(0.05 * size)}
    if swings:
        arm = short(size * d.even(0.8, 1.2))
        rise = {"lift_deg": short(math.degrees(lift / arm))}
        follower |= {"motion": "oscillating", "arm_mm": arm}
        follower["pivot_distance_mm"] = short(arm * d.even(0.8, 1.2))
        if d.chance(0.5):
            follower["pivot_height_mm"] = short(arm * d.even(0.0, 0.1))
    elif d.chance(0.3):
        follower["axis_deg"] = d.even(-15, 15)
    motion: list[dict[str, Any]] = [
        {"type": "rise", "law": d.pick(_LAWS), "travel_mm": short(size * d.even(0.5, 1.0)), **rise},
        {"type": "dwell", "travel_mm": short(size * d.even(0.1, 0.3))},
    ]
    if d.chance(0.6):
        law, travel = d.pick(_LAWS), short(size * d.even(0.5, 1.0))
        motion.append({"type": "return", "law": law, "travel_mm": travel})
    cam: dict[str, Any] = {"form": "translating"}
    if d.chance(0.4):
        cam["walls"] = "both"
    return {
        "kind": "cam", "name": "plate", "motion": motion, "follower": follower, "cam": cam,
        "blank": {"height_mm": short(size)},
    }  # fmt: skip


def driven_in_space(m: Machine, q: list[float], drive: dict[str, Any], on: Placed) -> None:
    """Note what a cam in space moves."""
    name, cam = drive["name"], drive["cam"]
    if "turret" in cam:
        pitch, index = TURN / cam["turret"]["stops"], math.radians(cam["index"]["angle_deg"])
        turns = [pitch * (one // TURN + min(1.0, one % TURN / index)) for one in q]
        center = on.machine(complex(cam["cam"]["center_distance_mm"]))
        m.shafts[f"{name}.turret"] = [-on.side * one for one in turns], center, name
        return
    share, lowest = [0.5 - 0.5 * math.cos(one) for one in q], 1j * cam["cam"]["lowest_mm"]
    rise, follower = cam["motion"][0], cam["follower"]
    if "arm_mm" not in follower:
        places = [rise["lift_mm"] * one for one in share]
        m.ways[f"{name}.follower"] = places, on.machine(lowest), on.vector(1j)
        return
    side, lift = -1.0 if cam["cam"].get("rotation") == "cw" else 1.0, math.radians(rise["lift_deg"])
    arm = follower["arm_mm"] * cmath.exp(-0.5j * lift)
    arm, middle = (complex(side * one.real, one.imag) for one in (arm, complex(arm.real, 0)))
    pivot = lowest - complex(middle.real, arm.imag)
    turns = [side * on.side * lift * one for one in share]
    m.shafts[f"{name}.follower"] = turns, on.machine(pivot), name
    m.arms[f"{name}.follower"] = cmath.phase(on.vector(arm))


def driven_by_plate(m: Machine, q: list[float], drive: dict[str, Any], on: Placed) -> None:
    """Give a plate its formula, and note what it moves."""
    name, plate, own = drive["name"], drive["cam"], m.d.whole(1, 2)
    half = short(0.4999 * sum(one["travel_mm"] for one in plate["motion"]))
    drive["slide"] = f"{half}*(1 - cos({own}*q))"
    u = [half * (1.0 - math.cos(own * one)) for one in q]
    m.ways[f"{name}.plate"] = u, on.at, on.vector(1 + 0j)
    rise, follower = plate["motion"][0], plate["follower"]
    share = [min(1.0, one / rise["travel_mm"]) for one in u]
    if len(plate["motion"]) > 2:
        back = plate["motion"][2]["travel_mm"]
        share = [
            min(s, max(0.0, (2.0 * half - one) / back)) for s, one in zip(share, u, strict=True)
        ]
    if "arm_mm" not in follower:
        way = cmath.exp(1j * math.radians(90.0 - follower.get("axis_deg", 0.0)))
        places = [rise["lift_mm"] * one for one in share]
        m.ways[f"{name}.follower"] = places, on.at, on.vector(way)
        return
    up = follower.get("pivot_height_mm", 0.0)
    pivot = complex(follower["pivot_distance_mm"], up)
    lift, first = math.radians(rise["lift_deg"]), math.asin(-up / follower["arm_mm"])
    m.shafts[f"{name}.follower"] = [-on.side * lift * one for one in share], on.machine(pivot), name
    m.arms[f"{name}.follower"] = cmath.phase(on.vector(-cmath.exp(-1j * first)))
