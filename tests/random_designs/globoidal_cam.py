"""Random globoidal cams: all motion laws, few and many stops.

Sizes are drawn in centre distances, so that this is arbitrary.
"""

from __future__ import annotations

import math
from typing import Any, Final

from gearcam.designs.outputs import MESHES
from gearcam.laws.motion import MOTION_LAWS
from random_designs.blank import classes, marks
from random_designs.draw import Draw, short
from random_designs.goals import seek
from random_designs.laws import random_motion_law
from random_designs.output import drawn, drive, studies, turret_forces

_LAWS: Final = tuple(
    name
    for name, entry in MOTION_LAWS.items()
    if entry.continuity.startswith(("C1:", "C2:", "C3", "at least"))
)
"""Laws without jumps of the velocity, which are refused."""

_SHARES: Final = {"svg": 0.5, **dict.fromkeys(MESHES, 0.07), "report": 0.03}
"""Share of cams with each kind of file, by its cost."""


def design(d: Draw, index: int) -> dict[str, Any]:
    """Return a random globoidal cam as the tables of its file.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    index : int
        Number of the design: laws take turns.
    """
    size, law = d.log(20, 300), _LAWS[index % len(_LAWS)]
    stops = d.whole(5, 12)
    pitch = 2.0 * math.pi / stops
    reach = size * d.even(0.45, 0.62)
    length = reach * d.even(0.15, 0.3)
    radius = (reach - length) * math.sin(0.5 * pitch) * d.even(0.3, 0.6)
    cam: dict[str, Any] = {"form": "globoidal", "center_distance_mm": short(size)}
    if d.chance(0.4):
        cam["length_mm"] = short(reach * d.even(0.7, 1.3))
    if d.chance(0.5):
        cam["roller_clearance_mm"] = short(radius * d.log(1e-4, 0.02))
    if d.chance(0.5):
        cam["floor_clearance_mm"] = short(length * d.even(0.0, 0.1))
    if d.chance(0.3):
        cam["rotation"] = d.pick(["cw", "ccw"])
    output: dict[str, Any] = {"files": ["csv", *(one for one, p in _SHARES.items() if d.chance(p))]}
    output |= {"wall_step_deg": short(d.log(2, 5)), "wall_points": d.whole(2, 7)}
    if d.chance(0.3):
        output["motion_step_deg"] = short(d.log(0.5, 10))
    if d.chance(0.3):
        output["theta_deg"] = short(d.even(-400, 400))
    made: dict[str, Any] = {
        "index": {**random_motion_law(d, law), "angle_deg": short(d.even(90, 270))},
        "turret": {
            "stops": stops,
            "roller_radius_mm": short(radius),
            "roller_length_mm": short(length),
            "reach_mm": short(reach),
        },
        "cam": cam,
        "output": output,
    }
    if d.chance(0.4):
        made["blank"] = {"bore_diameter_mm": short((size - reach) * d.even(0.2, 1.2))}
        classes(d, made["blank"])
        if d.chance(0.5):
            made["blank"]["density_kg_m3"] = 7850
    studies(d, made, "solid")
    drive(d, made)
    turret_forces(d, made)
    seek(made, index, "cam.pressure_angle_deg.max", "cam.length_mm")
    marks(d, made, 0.2 * radius, "zero_mark")
    drawn(d, made)
    return made
