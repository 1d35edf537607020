"""Random blanks of wheels and cams."""

from __future__ import annotations

import math
from typing import Any

from gearcam.parts.shafts import MOTOR_SHAFTS, keyway_of
from random_designs.draw import Draw, short


def blank(d: Draw, radius: float, unit: float, both: bool) -> dict[str, Any]:
    """Return a blank for a wheel or cam.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    radius : float, mm
        Radius within which its openings lie.
    unit : float, mm
        Size of the details of its edges: the module.
    both : bool
        Whether it is for two wheels, which may differ.
    """
    made: dict[str, Any] = {}
    reach = _shaft(d, radius, both, made) if d.chance(0.8) else 0.0
    holds = reach > 0.0
    if d.chance(0.3):
        made["hub_diameter_mm"] = short(1.1 * reach + radius * d.even(0.05, 0.3))
        reach = made["hub_diameter_mm"]
        made[d.pick(["hub_front_mm", "hub_back_mm"])] = short(unit * d.log(0.5, 10))
    if d.chance(0.25):
        bolt = short(radius * d.log(0.02, 0.1))
        count = d.whole(1, 8)
        circle = short(1.2 * max(reach + bolt, bolt * count / 2))
        made |= {"bolts": count, "bolt_diameter_mm": bolt, "bolt_circle_mm": circle}
        made["bolt_angle_deg"] = d.even(-180, 180)
    if d.chance(0.25):
        made["lightening_holes"] = d.whole(1, 8)
        made |= {key: short(unit * d.even(1, 3)) for key in ("rim_mm", "web_mm") if d.chance(0.4)}
    if d.chance(0.5):
        made["density_kg_m3"] = d.log(100, 20000)
    if d.chance(0.2):
        made["clearance_mm"] = short(unit * d.log(1e-3, 0.05))
        if holds or "bolts" in made:
            made["clearance_bores"] = d.chance(0.5)
    if not made.get("clearance_bores"):
        classes(d, made)
    if both:
        _edges(d, unit, made)
    return made


def without_openings(made: dict[str, Any]) -> None:
    """Ask openings and hub of wheel 1 alone: wheel 2 is a rack."""
    for key in ("bore_diameter_mm", "shaft", "hub_diameter_mm", "bolts", "lightening_holes"):
        value = made.get(key, 0)
        if value:
            first = value[0] if isinstance(value, list) else value
            made[key] = [first, "none" if key == "shaft" else 0]


def _shaft(d: Draw, radius: float, both: bool, made: dict[str, Any]) -> float:
    """Add a bore, or a motor's; return the diameter that it needs."""
    motors = {name: one["bore_diameter"] for name, one in MOTOR_SHAFTS.items()}
    if d.chance(0.15) and (names := [name for name, size in motors.items() if size < radius]):
        made["shaft"] = d.pick(names)
        return motors[made["shaft"]]
    bore = short(radius * d.log(0.2, 0.9))
    made["bore_diameter_mm"] = bore
    reach = _bore(d, bore, made)
    if both and d.chance(0.3):
        made["bore_diameter_mm"] = [bore, short(bore * d.even(1, 1.05))]
    return reach


def _bore(d: Draw, bore: float, made: dict[str, Any]) -> float:
    """Add a keyway or a flat to a bore at random; return the diameter that it needs."""
    if d.chance(0.3):
        width, depth = short(bore * d.even(0.1, 0.4)), short(bore * d.even(0.05, 0.2))
        angle = d.even(-180, 180)
        made |= {"keyway_width_mm": width, "keyway_depth_mm": depth, "keyway_angle_deg": angle}
        return 2.0 * math.hypot(0.5 * bore + depth, 0.5 * width)
    if (key := keyway_of(bore)) and d.chance(0.25):
        made["keyway"] = "DIN 6885"
        return 2.0 * math.hypot(0.5 * bore + key.hub_depth, 0.5 * key.width)
    if d.chance(0.2):
        made["bore_flat_mm"] = short(bore * d.even(0.6, 0.95))
    elif d.chance(0.25):
        made["bore_across_flats_mm"] = short(bore * d.even(0.3, 0.95))
    return bore


def classes(d: Draw, made: dict[str, Any]) -> None:
    """Give some sizes a tolerance class."""
    for key in ("bore_diameter_mm", "keyway_width_mm", "bolt_diameter_mm"):
        size = made.get(key)
        if isinstance(size, float | int) and 1.0 <= size <= 500.0 and d.chance(0.3):
            made[key] = f"{size} {d.pick(['H7', 'F8', 'JS9', 'P9', 'D10'])}"


def _edges(d: Draw, unit: float, made: dict[str, Any]) -> None:
    if d.chance(0.2):
        radius = short(unit * d.log(0.01, 0.15))
        made["tip_rounding_mm"] = d.pick([radius, [radius, 0], [0, radius]])
    if d.chance(0.2):
        made["timing_marks"] = d.chance(0.3)
    if made.get("timing_marks", True) and d.chance(0.2):
        made["mark_diameter_mm"] = short(unit * d.even(0.2, 0.6))


def marks(d: Draw, design: dict[str, Any], unit: float, mark: str = "") -> None:
    """Ask for chamfers, an arrow, a mark and a set screw in a few designs.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    design : dict
        The design, which is changed.
    unit : float, mm
        Size of the details of its edges.
    mark : str
        The key of a mark that is not there unless it is asked for.
    """
    if not d.chance(0.12):
        return
    made: dict[str, Any] = design.setdefault("blank", {})
    if d.chance(0.5):
        made["chamfer_mm"] = short(unit * d.log(0.01, 0.1))
    if d.chance(0.5):
        made["rotation_arrow"] = True
        design["output"]["process"] = d.pick(["printing", "laser", "wire", "milling"])
    if mark and d.chance(0.5):
        made[mark] = True
    if isinstance(made.get("bore_diameter_mm"), float | int) and "hub_diameter_mm" in made:
        made["set_screw"] = d.pick(["M2", "M3", "M4", "M8", "#6-32"])
        made["set_screw_angle_deg"] = d.even(-90, 90)
