"""Loads, friction and materials of random pairs, their motors, and settings of their stress."""

from __future__ import annotations

from typing import Any

from random_designs.draw import Draw, short
from random_designs.motors import moved


def loaded(d: Draw, made: dict[str, Any], module: float, travel: float | None) -> None:
    """Give loads to a few pairs, and ask for their forces; their stress would take seconds.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    made : dict
        The design, which is changed.
    module : float, mm
        Its module, roughly.
    travel : float or None, deg
        How far an open driver turns, at least; None of one that turns for ever.
    """
    if not d.chance(0.2):
        return
    rack = made["law"]["type"] == "rack"
    made["load"] = [_load(d, "wheel1" if rack else d.pick(["wheel1", "wheel2"]), module, travel)]
    if d.chance(0.6):
        one = short(module * d.log(0.5, 8))
        made["friction"] = {
            "joint": d.even(0.01, 0.2),
            "journal_radius_mm": [one, one if rack else short(module * d.log(0.5, 8))],
            "flank": d.even(0, 0.2),
            "rolling_mm": short(1e-3 * module * d.log(0.1, 10)),
        }
    if d.chance(0.5):
        made["material"] = {"name": [d.pick(["steel", "bronze", "pom"])]}
        if d.chance(0.5):
            made["material"] |= {"yield_mpa": short(d.log(50, 1000)), "density_kg_m3": 7800}
        if d.chance(0.3):
            made["material"] |= {"young_modulus_mpa": 2e5, "poisson": d.even(0.2, 0.4)}
    made["forces"] = {"steps": d.whole(12, 60)}
    if d.chance(0.3):
        made["output"]["studies"] = ["forces"]
    if d.chance(0.5) and "steps" not in made:
        made["stress"] = _stress(d, made["pair"]["teeth"], module)
    if not rack and d.chance(0.3):
        _moved(d, made, module, opened=travel is not None)


def _moved(d: Draw, made: dict[str, Any], module: float, *, opened: bool) -> None:
    """Give a motor, and elastic teeth to some; elements would take seconds."""
    load = made["load"][0]
    if d.chance(0.9):
        load["on"] = "wheel2"
    rpm = made.setdefault("drive", {}).setdefault("speed_rpm", short(d.log(10, 1000)))
    size = 1e-3 * module**3
    if d.chance(0.3):
        made["load"] = [{"on": "wheel2", "formula": f"{short(size / rpm)}*(omega2 + 3)"}]
    inertia = moved(d, made, short(size * d.log(0.1, 100)), rpm, opened)
    dynamics = made["dynamics"]
    if d.chance(0.9):
        dynamics["inertia_kg_m2"] = [inertia, short(inertia * d.log(0.1, 10))]
    if d.chance(0.3):
        dynamics |= {"stiffness_n_mm_um": short(d.log(1, 30)), "damping_ratio": d.even(0.02, 0.3)}
        dynamics |= {"turns": 1, "method": d.pick(["auto", "radau", "bdf", "lsoda", "dop853"])}
        dynamics["rigid"] = d.chance(0.2)
    elif d.chance(0.1):
        dynamics |= {"finite_elements": True, "rigid": d.chance(0.9)}


def _load(d: Draw, on: str, module: float, travel: float | None) -> dict[str, Any]:
    size, end = short(d.sign() * 1e-3 * module**3 * d.log(0.1, 100)), travel or 360.0
    how = d.pick(["torque", "torque", "formula", "table"])
    load: dict[str, Any] = {"on": on}
    if how == "torque":
        load["torque_nm"] = size
    elif how == "formula":
        load["formula"] = f"{size}*(1 + 0.3*cos(phi1))"
    else:
        load |= {"table": [size, short(0.5 * size), size], "at_deg": [0, short(0.4 * end), end]}
    if how == "torque" and d.chance(0.3):
        load |= {"from_deg": 0, "to_deg": short(end * d.even(0.2, 0.8))}
    return load


def _stress(d: Draw, z: list[int], module: float) -> dict[str, Any]:
    stress: dict[str, Any] = {
        "plane": d.pick(["strain", "stress"]),
        "phases": d.whole(12, 100),
        "tolerance": d.even(0.005, 0.05),
        "edges": d.chance(0.7),
        "alone": d.chance(0.2),
    }
    if d.chance(0.3):
        stress["held_diameter_mm"] = short(0.3 * module * min(z))
    if d.chance(0.3):
        stress |= {"wheel": d.whole(1, 2), "teeth": [d.whole(1, min(z))]}
    if d.chance(0.3):
        stress["phi1_deg"] = d.even(0, 40)
    return stress
