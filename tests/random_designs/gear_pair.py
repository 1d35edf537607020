"""Random gear pairs: all laws, closed and open, racks, rings, stepped gears, blanks, studies.

Parameters of laws are drawn so that most designs can be built. Sizes are drawn in modules, so that
the module is arbitrary.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

from random_designs.blank import blank
from random_designs.draw import Draw, short
from random_designs.output import asked, studies

Law = dict[str, Any]
Counts = tuple[int, int]

MOST_TEETH: Final = 120
"""Largest number of teeth: the time is proportional to it."""


_SHARES: Final = {
    "svg": 0.7, "dxf": 0.1, "inspection": 0.15, "cut-svg": 0.06, "drawing-svg": 0.08,
    "drawing-dxf": 0.02, "stl": 0.05, "3mf": 0.02, "glb": 0.03, "step": 0.01, "report": 0.04,
}  # fmt: skip
"""Share of pairs with each kind of file, by its cost."""

_AFFORDABLE: Final = 1200.0
"""Number of vertices above which other files are drawn less often."""

# --- tooth counts -----------------------------------------------------------------------------


def _equal(d: Draw, low: int = 8) -> Counts:
    """Return equal numbers of teeth."""
    z = d.whole(low, MOST_TEETH)
    return z, z


def _lobed(d: Draw, low: int = 8) -> Counts:
    """Return numbers of teeth for few lobes."""
    n1, n2 = d.pick([(1, 1), (1, 1), (1, 2), (2, 1), (2, 3), (3, 2), (1, 3), (3, 1)])
    each = d.whole(math.ceil(low / min(n1, n2)), MOST_TEETH // max(n1, n2))
    return n1 * each, n2 * each


def _one_lobe(d: Draw, low: int = 8) -> Counts:
    """Return numbers of teeth for one lobe of the driver and one to three of the driven wheel."""
    n = d.whole(1, 3)
    z = d.whole(low, MOST_TEETH // n)
    return z, n * z


def _period(z: Counts) -> float:
    """Return the angle of a lobe of the driver, deg."""
    return 360.0 * math.gcd(*z) / z[0]


# --- laws -------------------------------------------------------------------------------------


def _rising(d: Draw, count: int, end: float) -> list[float]:
    """Return knots from 0 to `end`, deg."""
    knots = [0.0]
    for share in d.shares(count):
        knots.append(knots[-1] + share * end)
    return [*map(short, knots[:-1]), end]


def _phases(d: Draw) -> tuple[Law, Counts]:
    if d.chance(0.35):
        return _open_phases(d)
    z = _lobed(d, 16)
    count = d.whole(2, 5)
    swing = d.log(0.02, 0.4)
    ratios: list[Any] = [short(z[0] / z[1] * d.even(1 - swing, 1 + swing)) for _ in range(count)]
    ratios.append(ratios[0])
    ratios[d.whole(1, count - 1)] = "solve"
    shape = d.pick(["cosine", "cubic", "quintic"])
    return {"shape": shape, "knots_deg": _rising(d, count, _period(z)), "ratios": ratios}, z


def _open_phases(d: Draw) -> tuple[Law, Counts]:
    low, high = d.even(0.7, 1.0), d.even(1.0, 1.8)
    travel, z = d.even(120, 300), _equal(d, 16)
    if d.chance(0.4):
        law: Law = {"shape": "sine", "knots_deg": [0, d.even(50, 90), "solve"]}
        return law | {"ratios": [1, high, high], "driven_travel_deg": travel}, z
    shape = d.pick(["cosine", "cubic", "quintic"])
    knots = [0, d.even(5, 20), d.even(60, 90), "solve"]
    ratios = [low, low, high, high]
    if d.chance(0.3):
        knots[3], ratios[2:] = short(travel / d.even(0.9, 1.2)), ["solve", high]
    return {
        "shape": shape, "knots_deg": knots, "ratios": ratios, "driven_travel_deg": travel,
    }, z  # fmt: skip


def _three_phases(d: Draw) -> tuple[Law, Counts]:
    z = _lobed(d, 20)
    shares = (d.even(0.3, 0.5), d.even(0.65, 0.8))
    knots = [0, *(short(share * _period(z)) for share in shares), _period(z)]
    return {"knots_deg": knots, "lowest": short(z[0] / z[1] * d.even(0.4, 0.95))}, z


def _multispeed(d: Draw) -> tuple[Law, Counts]:
    law: Law = {"shape": d.pick(["cosine", "cubic", "quintic"])}
    if d.chance(0.3):
        angles = [d.even(30, 100), d.even(30, 100)]
        law |= {"angles_deg": angles, "transition_deg": d.even(20, 60)}
        travel = short((sum(angles) + law["transition_deg"]) * d.even(0.9, 1.3))
        return law | {"ratios": [d.even(0.8, 1.2), "solve"], "driven_travel_deg": travel}, _equal(d)
    z, count = _lobed(d, 20), d.whole(2, 3)
    each = short(_period(z) * d.even(0.12, 0.25))
    rest = _period(z) - count * each
    angles = [short(share * rest) for share in d.shares(count)]
    angles[-1] = rest - sum(angles[:-1])
    ratios: list[Any] = [short(z[0] / z[1] * d.even(0.7, 1.3)) for _ in range(count)]
    ratios[d.whole(1, count) - 1] = "solve"
    return law | {"angles_deg": angles, "transition_deg": each, "ratios": ratios}, z


def _fourier(d: Draw) -> tuple[Law, Counts]:
    z, of = _lobed(d, 12), d.pick(["ratio", "phi2"])
    waves = [[d.sign() * d.log(1e-3, 0.2) / k for k in range(1, d.whole(1, 4) + 1)] for _ in "ab"]
    # degrees of phi2: a share of the ratio over k*n1
    n = z[0] // math.gcd(*z)
    unit = [1.0 if of == "ratio" else 57.0 / (n * k) for k in range(1, 5)]
    cosines, sines = ([short(a * u) for a, u in zip(wave, unit, strict=False)] for wave in waves)
    return {"of": of, "cosines": cosines, "sines": sines}, z


def _constant(d: Draw) -> tuple[Law, Counts]:
    return {}, (d.whole(8, MOST_TEETH), d.whole(8, MOST_TEETH))


def _with_lobes(most: float) -> Callable[[Draw], tuple[Law, Counts]]:
    def draw(d: Draw) -> tuple[Law, Counts]:
        z = _lobed(d, 12)
        law: Law = {"eccentricity": d.log(1e-3, most)}
        common = math.gcd(*z)
        if d.chance(0.4):
            parts = [n for n in (1, 2, 3) if common % n == 0 and common // n >= 8]
            common //= d.pick(parts or [1])
            law["lobes"] = [z[0] // common, z[1] // common]
        return law, z

    return draw


def _excentric(most: float) -> Callable[[Draw], tuple[Law, Counts]]:
    return lambda d: ({"eccentricity": d.log(1e-3, most)}, _one_lobe(d, 12))


def _bspline(d: Draw) -> tuple[Law, Counts]:
    swing = d.log(1e-3, 0.15)
    return {"radii": [d.even(1 - swing, 1 + swing) for _ in range(d.whole(4, 8))]}, _lobed(d, 16)


def _polygon(d: Draw) -> tuple[Law, Counts]:
    return {"corners": d.whole(3, 6), "corner_radius": d.even(0.16, 0.4)}, _equal(d, 24)


def _spiral(d: Draw) -> tuple[Law, Counts]:
    if d.chance(0.3):
        ratios = [d.even(1.05, 1.6), "solve"]
        return {"ratios": ratios[:: d.sign()], "return_deg": d.even(90, 170)}, _equal(d, 30)
    first, growth = d.even(0.5, 1.2), d.log(1.05, 3)
    ratios = [first, short(first * growth)]
    return {"ratios": ratios[:: d.sign()], "driven_travel_deg": d.even(60, 220)}, _equal(d)


def _formula(d: Draw) -> tuple[Law, Counts]:
    a, b = d.sign() * d.log(1e-3, 0.35), d.sign() * d.log(1e-3, 0.12)
    if d.chance(0.25):
        travel = d.even(90, 250)
        law: Law = {d.pick(["ratio", "r1"]): f"1 + {short(0.5 * a)}*sin(phi1/2) + {b}*phi1"}
        return law | {"driver_travel_deg": travel, "driven_travel_deg": travel}, _equal(d, 12)
    z, kind, more = _lobed(d, 16), d.pick(["ratio", "r1", "phi2"]), d.whole(1, 3)
    n, shift = z[0] // math.gcd(*z), d.even(0, 6)
    if kind == "phi2":
        a, b, mean = short(a / n * z[0] / z[1]), short(b / more / n * z[0] / z[1]), f"{z[0]}/{z[1]}"
        return {kind: f"phi1*{mean} + {a}*cos({n}*phi1 + {shift}) + {b}*sin({more * n}*phi1)"}, z
    half = 0.5 if kind == "r1" else 1.0
    waves = f"{short(half * a)}*cos({n}*phi1 + {shift}) + {short(half * b)}*sin({more * n}*phi1)"
    return {kind: f"1 + {waves}"}, z


def _table(d: Draw) -> tuple[Law, Counts]:
    z, count, kind = _lobed(d, 16), d.whole(12, 40), d.pick(["ratio", "phi2_deg", "r1"])
    a, shift, mean = d.sign() * d.log(1e-2, 0.3), d.even(0, 6), z[0] / z[1]
    turns = [2 * math.pi * k / count for k in range(count + 1)]
    angles = [_period(z) * k / count for k in range(count + 1)]
    wave = [math.cos(t + shift) for t in turns[:-1]]
    wave.append(wave[0])
    if kind == "phi2_deg":
        unit = _period(z) / (2 * math.pi)
        rise = [math.sin(t + shift) - math.sin(shift) for t in turns[:-1]] + [0.0]
        values = [mean * (x + a * unit * w) for x, w in zip(angles, rise, strict=True)]
    else:
        values = [(1 + (a if kind == "ratio" else 0.5 * a) * w) for w in wave]
    if z[0] == z[1] and kind != "phi2_deg" and d.chance(0.3):
        angles = [short(0.8 * x) for x in angles]
        return {"phi1_deg": angles, kind: values, "driven_travel_deg": d.even(240, 300)}, z
    return {"phi1_deg": angles, kind: values}, z


def _motion(d: Draw) -> tuple[Law, Counts]:
    a, travel = d.log(1e-3, 0.4), d.even(90, 270)
    if d.chance(0.5):
        turned, rod = f"(phi1 + {a}*sin(phi1))", d.even(2, 8)
        sine = f"(sin{turned}/{rod})**2"
        return {"slide": f"1 - cos{turned} + {rod}*(1 - sqrt(1 - {sine}))", "rod": rod}, _equal(d)
    law: Law = {"y": f"x + {a}*x**2", "x_from": 0, "x_to": d.even(0.5, 2)}
    return law | {"driver_travel_deg": travel, "driven_travel_deg": travel}, _equal(d)


def _rack(d: Draw) -> tuple[Law, Counts]:
    a, n = d.sign() * d.log(1e-3, 0.2), d.whole(1, 3)
    shape = {"r1": f"1 + {a}*cos({n}*phi1)"}
    if d.chance(0.5):
        shape = {"travel": f"3*phi1 + {short(a / n)}*sin({n}*phi1)"}
    return shape, (d.whole(14, MOST_TEETH), d.whole(6, MOST_TEETH))


LAWS: Final[dict[str, Callable[[Draw], tuple[Law, Counts]]]] = {
    "phases": _phases,
    "three-phase-polynomial": _three_phases,
    "multispeed": _multispeed,
    "fourier": _fourier,
    "constant": _constant,
    "ellipse": _with_lobes(0.9),
    "eccentric-circle": _excentric(0.7),
    "limacon": _excentric(0.6),
    "lobed": _with_lobes(0.15),
    "bspline": _bspline,
    "rounded-polygon": _polygon,
    "log-spiral": _spiral,
    "formula": _formula,
    "table": _table,
    "motion": _motion,
    "rack": _rack,
}


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
    law = [*LAWS][index % len(LAWS)]
    given, z = LAWS[law](d)
    module = d.pick([d.log(0.05, 1000), d.log(0.5, 10)])
    opened, closed = "driven_travel_deg" in given, law != "rack"
    made: dict[str, Any] = {
        "law": {"type": law, **given},
        "pair": _pair(d, z, module, not closed),
    }
    if d.chance(0.4):
        made["rack"] = _cutter(d)
    if d.chance(0.5):
        made["blank"] = blank(d, 0.3 * module * min(z), module, closed)
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
    studies(d, made, "law", "mesh")
    return made
