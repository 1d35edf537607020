"""Random gear pairs: all laws, closed and open, racks, rings, stepped gears, blanks, studies.

Sizes are drawn in modules, so that the module is arbitrary.
"""

from __future__ import annotations

import math
from typing import Any, Final

from gearcam.designs.outputs import MESHES
from gearcam.laws.ratio import LAWS
from random_designs.blank import blank, marks, without_openings
from random_designs.draw import Draw, short
from random_designs.goals import seek
from random_designs.law_draw import Counts, LawDraw
from random_designs.laws import random_law
from random_designs.output import asked, drawn, drive, studies
from random_designs.pair_loads import loaded

_SHARES: Final = {
    "svg": 0.7, "dxf": 0.1, "inspection": 0.15, "cut-svg": 0.06, "drawing-svg": 0.08,
    "drawing-dxf": 0.02, **dict.fromkeys(MESHES, 0.03), "step": 0.01, "report": 0.04,
}  # fmt: skip
"""Share of pairs with each kind of file, by its cost."""

_AFFORDABLE: Final = 1200.0
"""Number of vertices above which other files are drawn less often."""

# --- the other tables -------------------------------------------------------------------------


def _pair(d: Draw, z: Counts, module: float, rack: bool) -> dict[str, Any]:
    size: dict[str, Any] = {"module_mm": module}
    if d.chance(0.4) and not rack:
        size = {"center_distance_mm": short(module * sum(z) / 2 * d.even(0.95, 1.05))}
    size |= {"teeth": list(z), "face_width_mm": short(module * d.log(1, 30))}
    if d.chance(0.3):
        size["x"] = d.even(-0.5, 0.5)
    if d.chance(0.4):
        size["backlash_mm"] = short(module * d.log(1e-3, 0.1))
    return size


def _cutter(d: Draw) -> dict[str, Any]:
    rack: dict[str, Any] = {}
    if d.chance(0.6):
        rack["pressure_angle_deg"] = d.pick([14.5, 20, 25, d.even(12, 30)])
    if d.chance(0.6):
        rack["addendum"] = d.even(0.6, 1.15)
        rack["dedendum"] = short(rack["addendum"] + d.even(0.15, 0.35))
    if d.chance(0.4):
        rack["tip_radius"] = d.even(0, 0.3)
    return rack


def _steps(d: Draw, module: float) -> dict[str, Any]:
    steps: dict[str, Any] = {"count": d.whole(2, 5)}
    if d.chance(0.4):
        steps["offset_mm"] = short(d.sign() * module * d.log(0.1, 3))
    return steps


def _ring(d: Draw, design: dict[str, Any], module: float) -> None:
    """Change a design to an internal pair: no bore of the ring, a smaller centre distance."""
    pair = design["pair"]
    z1, z2 = pair["teeth"]
    pair["type"] = "internal"
    if "center_distance_mm" in pair:
        pair["center_distance_mm"] = short(module * (z2 - z1) / 2 * d.even(0.95, 1.05))
    ring: dict[str, Any] = {"outer": d.pick(["round", "follow"])}
    if d.chance(0.5):
        ring["rim_mm"] = short(module * d.log(1, 8))
    elif ring["outer"] == "round":
        ring["outer_diameter_mm"] = short(module * (z2 + 2.5 + d.log(2, 30)))
    if d.chance(0.3):
        ring["cutter_teeth"] = short(z1 * d.even(0.6, 1.2))
    design["ring"] = ring
    for key in ("blank", "meshing"):
        design.pop(key, None)


def _study(d: Draw, design: dict[str, Any]) -> dict[str, Any]:
    study: dict[str, Any] = {"steps": d.whole(8, 60)}
    if d.chance(0.4):
        study["overclosure_deg"] = d.sign() * d.log(1e-3, 0.02)
    if d.chance(0.3):
        ends = design["law"]["type"] == "rack" or "driven_travel_deg" in design["law"]
        start = d.even(0, 20) if ends else d.even(-90, 200)
        study |= {"from_deg": start, "to_deg": short(start + d.even(20, 60 if ends else 360))}
    elif d.chance(0.2):
        z = design["pair"]["teeth"][0]
        study |= {"steps": 4 * z, "teeth": [d.whole(1, z), d.whole(1, z)]}
    distance = design["pair"].get("center_distance_mm")
    if distance and d.chance(0.6):
        study["center_distance_mm"] = short(distance * (1 + d.even(-1e-3, 4e-3)))
    if "steps" in design:
        study["step"] = d.whole(1, design["steps"]["count"])
    return study


def _errors(d: Draw, design: dict[str, Any], module: float) -> dict[str, Any]:
    """Return errors of mounting and making, of up to a hundredth of the module."""

    def size() -> float:
        return short(module * d.log(1e-4, 1e-2))

    rack = design["law"]["type"] == "rack"
    errors: dict[str, Any] = {"steps": d.whole(8, 60)}
    if d.chance(0.5):
        errors["center_mm"] = size()
    if d.chance(0.5):
        errors["eccentricity_mm"] = [size(), 0 if rack else size()]
        errors["eccentricity_deg"] = [d.even(-180, 180), 0 if rack else d.even(-180, 180)]
    if d.chance(0.3):
        errors["tilt_deg"] = [d.even(-0.1, 0.1), d.even(-0.1, 0.1)]
    if d.chance(0.15):
        errors["file"] = "pitch.csv"
    if d.chance(0.1):
        errors[d.pick(["outline1", "outline2"])] = "outline.csv"
    if d.chance(0.4):
        errors |= {
            "center_tolerance_mm": size(),
            "eccentricity_tolerance_mm": [size(), 0 if rack else size()],
            "tilt_tolerance_deg": [d.even(0, 0.1), d.even(0, 0.1)],
            "pitch_tolerance_mm": size(),
            "distribution": d.pick(["uniform", "normal"]),
            "trials": d.whole(1, 3),
            "percentiles": [50.0, 97.5],
            "seed": d.whole(0, 9),
        }
    return errors


def _studies(d: Draw, design: dict[str, Any], module: float) -> None:
    studies(d, design, "law", d.pick(["mesh", "errors"]))
    if "meshing" in design and d.chance(0.2):
        design["meshing"]["solids"] = True
    if d.chance(0.1):
        design["errors"] = _errors(d, design, module)


def _pins(d: Draw, module: float) -> dict[str, Any]:
    """Return pins for both wheels, near the usual size, in a few designs."""
    pins = [short(module * d.even(1.55, 1.9)) for _ in range(2)]
    return {"pin_diameter_mm": d.pick([pins, pins[0]])} if d.chance(0.1) else {}


def _vertices(document: dict[str, Any]) -> float:
    """Return the approximate number of vertices of a pair, to which the time is proportional."""
    pair, steps = document["pair"], document.get("steps", {}).get("count", 1)
    module = pair.get("module_mm") or 2.0 * pair["center_distance_mm"] / sum(pair["teeth"])
    tolerance = document["output"].get("chord_tolerance_mm", min(1e-3, 1e-3 * module))
    return 1.7 * sum(pair["teeth"]) * steps * math.sqrt(module / tolerance)


def design(d: Draw, index: int) -> dict[str, Any]:
    """Return a random gear pair; the laws take turns.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    index : int
        Number of the design.
    """
    given, z = random_law(LawDraw(str(d.random.random())), [*LAWS][index % len(LAWS)])
    module = d.pick([d.log(0.05, 1000), d.log(0.5, 10)])
    opened, closed = "driven_travel_deg" in given, given["type"] != "rack"
    made: dict[str, Any] = {
        "law": given,
        "pair": _pair(d, z, module, not closed),
    }
    if d.chance(0.4):
        made["rack"] = _cutter(d)
    if d.chance(0.5):
        made["blank"] = blank(d, 0.3 * module * min(z), module, both=True)
        if not closed:
            without_openings(made["blank"])
        if opened and d.chance(0.3):
            made["blank"]["stop_pin_mm"] = short(module * d.log(0.5, 2))
    if closed and not opened and d.chance(0.12):
        made["steps"] = _steps(d, module)
    if d.chance(0.15):
        made["meshing"] = _study(d, made)
    made["output"] = {"chord_tolerance_mm": short(module * d.log(1e-3, 2e-2))}
    if 0.5 < module < 10 and d.chance(0.1):
        del made["output"]["chord_tolerance_mm"]
    if d.chance(0.2):
        made["output"]["phi1_deg"] = d.even(0, 50) if opened else d.even(-400, 400)
    if closed and not opened and z[1] > z[0] and d.chance(0.3):
        _ring(d, made, module)
    made["output"] |= asked(d, _SHARES, min(1.0, _AFFORDABLE / _vertices(made)))
    made["output"] |= _pins(d, module)
    _studies(d, made, module)
    drive(d, made)
    seek(made, index, "pair.center_distance_mm", "mesh.acceleration_max")
    loaded(d, made, module, None if closed and not opened else 10.0)
    marks(d, made, module)
    drawn(d, made, "print-pdf")
    return made | ({"bar": _bar(d, module)} if not closed else {})


def _bar(d: Draw, module: float) -> dict[str, Any]:
    """Return the bar of a rack."""
    bar: dict[str, Any] = {"height_mm": short(module * d.even(4, 30))}
    if d.chance(0.5):
        bar["ends"] = d.pick(["tooth", "gap"])
    if d.chance(0.5):
        bar |= {
            "bolts": 2,
            "bolt_diameter_mm": short(module * d.even(0.2, 1)),
            "bolt_spacing_mm": short(module * d.even(3, 9)),
            "bolt_height_mm": short(module * d.even(0.7, 2)),
        }
    return bar
