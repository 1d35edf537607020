"""Motors and runs of random machines: pairs and mechanisms."""

from __future__ import annotations

import math
from typing import Any, Final

from random_designs.draw import Draw, short

_TYPES: Final = ("linear", "constant", "asynchronous", "table", "speed", "spring", "none")
"""Types of motors."""


def moved(d: Draw, made: dict[str, Any], torque: float, rpm: float, opened: bool) -> float:
    """Give a machine a motor and a run, and ask for its dynamics.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    made : dict
        The design, which is changed.
    torque : float, N m
        Size of its loads at the driver, roughly.
    rpm : float
        Mean speed of the driver.
    opened : bool
        Whether the driver has a travel.

    Returns
    -------
    float
        A moment of inertia that suits them, kg m2.
    """
    omega = rpm * math.pi / 30.0
    inertia = torque * 2.0 * math.pi / omega**2 * d.log(0.3, 100)
    kind = d.pick(_TYPES)
    motor: dict[str, Any] = {"type": kind, **_torque(d, kind, torque, rpm)}
    runs = {"none": ("coast",), "spring": ("start", "turns"), "speed": ("regime",)}
    run = d.pick(runs.get(kind, ("start", "turns") if opened else ("regime", "start", "turns")))
    if kind == "constant" and run == "regime":
        del motor["torque_nm"]
    dynamics: dict[str, Any] = {"run": run, "steps": d.whole(12, 100)}
    if run != "regime":
        dynamics |= {} if opened else {"turns": d.whole(1, 4)}
    if d.chance(0.3):
        dynamics["tolerance"] = d.log(1e-8, 1e-4)
    if d.chance(0.5):
        motor["irregularity"] = d.log(0.01, 0.5)
    if d.chance(0.8):
        solved = run == "regime" and kind != "speed" and d.chance(0.4)
        motor["flywheel_kg_m2"] = short(inertia * d.log(0.1, 10))
        if solved and "irregularity" in motor:
            motor["flywheel_kg_m2"] = "solve"
    made |= {"motor": motor, "dynamics": dynamics}
    made["output"]["studies"] = [*made["output"].get("studies", ()), "dynamics"]
    return short(inertia)


def _torque(d: Draw, kind: str, torque: float, rpm: float) -> dict[str, Any]:
    """Return the torques and speeds of a type of motor."""
    start = short(torque * d.log(1, 20))
    match kind:
        case "constant":
            return {"torque_nm": start}
        case "spring":
            return {"torque_nm": start, "stiffness_nm_rad": short(start * d.log(0.01, 0.1))}
        case "linear":
            return {"start_torque_nm": start, "idle_rpm": short(rpm * d.even(1.02, 1.5))}
        case "asynchronous":
            return {
                "breakdown_torque_nm": start,
                "breakdown_slip": d.even(0.05, 0.4),
                "synchronous_rpm": short(rpm * d.even(1.02, 1.3)),
            }
        case "table":
            torques = [start, short(start * d.even(0.8, 1.2)), 0.0]
            first = short(rpm * d.pick((0, 0, 0.3)))
            return {"torque_nm": torques, "rpm": [first, short(0.8 * rpm), short(1.3 * rpm)]}
    return {}
