"""Internal pairs: as parts, in mesh, at random, and whether a whole wheel fits into its ring.

In mesh, the ring's shaft stands at -A; wheel 1 is turned by -phi1 and the ring by -phi2.
"""

from __future__ import annotations

import math
import random
from functools import cache
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.affinity import affine_transform

import gearcam
from gearcam.gears.outline import Outline
from gearcam.gears.spec import PairSpec
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases
from gearcam.numeric.arrays import as_pairs
from helpers_built import built
from helpers_pairs import job

# --- as parts ------------------------------------------------------------------------------

UNEVEN = Phases(knots=(0.0, math.radians(130.0), 2.0 * math.pi), ratios=(0.6, 0.4, 0.6))
"""Not symmetric: the ring is not its own mirror image."""

WAIST = Formula(ratio="1 + 0.3*cos(phi1)")
"""The ring's centrode bends towards its shaft twice."""


def ring_design(law: Any = UNEVEN, pair: Any = None, **tables: Any) -> GearPairDesign:
    """Return the design of an internal pair, 24 : 48 of module 2 where nothing else is said."""
    sizes = {"type": "internal", "teeth": (24, 48), "module": 2.0} | (pair or {})
    return GearPairDesign(name="ring", law=law, pair=PairSpec(**sizes), **tables)


def ring_job(law: Any = UNEVEN, pair: Any = None, **tables: Any) -> GearPairResult:
    return built(ring_design(law, pair, **tables))


@cache
def plain(law: Any = UNEVEN) -> GearPairResult:
    """Return a result that nothing is ordered of beyond its teeth."""
    return ring_job(law)


def centrode(made: GearPairResult, count: int = 20001) -> np.ndarray:
    """Return dense points of the ring's centrode, (n, 2), mm, in its own frame."""
    end = made.gear2.toothing.track.around
    return made.gear2.centrode(np.linspace(0.0, end, count)[:-1])


def turned(points: np.ndarray, angle: float, shift: float) -> shapely.Polygon:
    """Return a polygon turned about the origin, then shifted along x."""
    z = (points @ [1.0, 1.0j]) * np.exp(1j * angle) + shift
    return shapely.Polygon(np.column_stack([z.real, z.imag]))


# --- in mesh -------------------------------------------------------------------------------

Array = NDArray[np.float64]
Plane = NDArray[np.complex128]

ALPHA = math.radians(20.0)
DEEP = gearcam.Rack(dedendum=1.5, tip_radius=0.0)
"""Straight flanks so deep that the tips of the rings below keep their full height."""

FOCUS = "22.3517355864508/(22.3517355864508 + 22.87542426332165*(1 + 0.3*cos(phi1)))"
TWO_LOBES = "37.668247881141/(37.668247881141 + 18.96124240457442*(1 + 0.2*cos(2*phi1)))"
ROUND = gearcam.laws.Constant()
LAWS = {
    "circular": (ROUND, (28, 40), 1.0, DEEP),
    "one lobe": (gearcam.laws.Formula(ratio=FOCUS), (24, 48), 2.0, gearcam.Rack()),
    "two lobes": (gearcam.laws.Formula(ratio=TWO_LOBES), (40, 60), 2.0, gearcam.Rack()),
    "asymmetric": (
        gearcam.laws.Formula(ratio="1 + 0.2*cos(phi1) + 0.04*sin(2*phi1)"),
        (30, 60),
        2.0,
        gearcam.Rack(),
    ),
}
CLEAN = ["circular", "one lobe", "asymmetric"]
"""The tips of the two lobes meet outside the mesh."""


def pair_of(
    law: object, teeth: tuple[int, int], module: float, rack: gearcam.Rack
) -> GearPairResult:
    return job(law, teeth, module=module, rack=rack, internal=True)


@cache
def made(name: str) -> GearPairResult:
    return pair_of(*LAWS[name])


def phases(count: int = 41) -> Array:
    """Driver angles of a turn, clear of knots."""
    return np.linspace(0.05, 2.0 * math.pi + 0.01, count)


def driven_angles(name: str, phi1: Array) -> Array:
    """The driven angle by Gauss-Legendre quadrature of the ratio."""
    nodes, weights = np.polynomial.legendre.leggauss(96)
    law = made(name).law
    half = 0.5 * phi1[:, None]
    return (
        (law.derivatives((half * (1.0 + nodes)).ravel(), 1)[1].reshape(half.size, -1))
        @ (weights)
        * half.ravel()
    )


# --- at random -----------------------------------------------------------------------------

LOBES = [(1, 2), (1, 3), (2, 3), (3, 4), (3, 5), (2, 5), (4, 5), (5, 6)]
MODULES = [0.1, 0.5, 1.0, 2.0, 5.0, 20.0]
ANGLES = 24

CHORDS = 1e-4
"""Chord tolerance of the outlines, in modules."""

TOUCH = 3.0
"""Chord errors by which the wheel is made smaller: flanks that touch overlap by one of each
outline, and a corner that touches a root by as much again."""

BESIDE = np.linspace(-0.5, 0.5, 21)
"""Pitches beside an angle at which tips are said to collide."""


def ring(law: dict[str, Any], teeth: tuple[int, int], **tables: Any) -> GearPairResult:
    """The result of an internal pair of module 1, of a coarse outline unless it is told."""
    pair = {"type": "internal", "module_mm": 1.0, "teeth": list(teeth)} | tables.pop("pair", {})
    output = {"files": ["csv"], "chord_tolerance_mm": 0.01 * pair["module_mm"]}
    output |= tables.pop("output", {})
    document = {"kind": "gear-pair", "name": "r", "law": law, "pair": pair, "output": output}
    return built(gearcam.design(document | tables))


def driver(e: float, n1: int, n2: int) -> dict[str, Any]:
    """The ratio of ``r1 = 1 + e*cos(n1*phi1)`` in a ring, with its centre distance in closed form.

    Source: the mean of ``r1/(r1 + A)`` over a turn.
    """
    q = 1.0 - n1 / n2
    a = q * (q + math.sqrt(q * q + (1.0 - q * q) * (1.0 - e * e))) / (1.0 - q * q)
    r1 = f"(1 + {e}*cos({n1}*phi1))"
    return {"type": "formula", "ratio": f"{r1}/({a!r} + {r1})"}


def passed_on_circles(
    z1: int, z2: int, addendum: float = 1.0, of_ring: float | None = None
) -> float:
    """Trochoidal interference of a circular pair, module 1, mm along the ring.

    Source: 000 section 4.2.2; the angles by the law of cosines at both shafts.
    """
    r1, r2, alpha = 0.5 * z1, 0.5 * z2, math.radians(20)
    a, tip1 = r2 - r1, r1 + addendum
    tip2 = r2 - (addendum if of_ring is None else of_ring)
    at1, at2 = (math.acos(r * math.cos(alpha) / tip) for r, tip in ((r1, tip1), (r2, tip2)))
    turn1 = math.acos((tip2**2 - tip1**2 - a * a) / (2.0 * tip1 * a))
    turn2 = math.acos((tip2**2 + a * a - tip1**2) / (2.0 * tip2 * a))
    theta1 = turn1 + involute(at1) - involute(alpha)
    return r2 * (theta1 * z1 / z2 + involute(alpha) - involute(at2) - turn2)


def involute(angle: float) -> float:
    return math.tan(angle) - angle


def highest_on_circles(z1: int, z2: int) -> float:
    """The addendum, in modules, at which tips of circles just pass."""
    low, high = 0.3, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        passes = passed_on_circles(z1, z2, middle) >= 0.0
        low, high = (middle, high) if passes else (low, middle)
    return low


def mild_law(r: random.Random, n: int) -> dict[str, Any]:
    """A law of n lobes whose swing leaves rings that mostly fit: a formula, or harmonics."""
    e = r.choice([0.0, 1.0, 1.0, 1.0, 1.0]) * r.uniform(0.0, 0.25) / n**1.7
    kind = r.choice(["cosine", "asymmetric", "harmonics", "harmonics"])
    if kind == "cosine":
        return {"type": "formula", "ratio": f"1 + {e:.5f}*cos({n}*phi1)"}
    second = r.uniform(-0.4, 0.4) * e
    if kind == "asymmetric":
        wave = f"{e:.5f}*sin({n}*phi1) + ({second:.5f})*cos({2 * n}*phi1 + 0.7)"
        return {"type": "formula", "ratio": f"1 + {wave}"}
    return {"type": "fourier", "cosines": [round(e, 5)], "sines": [0.0, round(second, 5)]}


def random_ring(seed: int) -> GearPairResult:
    """An internal pair at random."""
    r = random.Random(seed)
    n1, n2 = r.choice(LOBES)
    t = r.randint(max(2, math.ceil(12 / n1)), max(3, 48 // n1))
    module, addendum = r.choice(MODULES), r.choice([1.0, 1.0, 0.9, 0.8, 0.6])
    angle = r.choice([14.5, 20, 20] if addendum < 0.8 else [14.5, 20, 20, 20, 25, 28])
    rack: dict[str, float] = {"pressure_angle_deg": angle, "addendum": addendum}
    if addendum >= 0.8 and r.random() < 0.3:  # sharp cutters that leave little room in the roots
        rack["dedendum"] = addendum + r.choice([0.02, 0.1, 0.25])
        rack["tip_radius"] = r.choice([0.0, 0.1, 0.2])
    pair = {
        "module_mm": module,
        "x": r.choice([0.0, 0.0, round(r.uniform(-0.4, 0.4), 3)]),
        "backlash_mm": r.choice([0.0, 0.0, 0.05 * module]),
    }
    tables: dict[str, Any] = {"pair": pair, "rack": rack}
    if r.random() < 0.2:
        edge = r.choice([{"clearance_mm": 0.02 * module}, {"tip_rounding_mm": 0.05 * module}])
        tables["blank"] = edge | {"timing_marks": False}
    if angle <= 20 and r.random() < 0.2:
        tables["ring"] = {"cutter_teeth": r.choice([12.0, 16.0, 24.0])}
    output = {"chord_tolerance_mm": CHORDS * module}
    return ring(mild_law(r, n1), (n1 * t, n2 * t), output=output, **tables)


def overlap(
    result: GearPairResult,
    around: float | None = None,
    outlines: tuple[Outline, Outline] | None = None,
) -> float:
    """The largest area, in square modules, that the wheel has in common with the ring's metal.

    At `ANGLES` over all turns that differ or, where an angle is told, beside it; of the whole
    outlines, by polygons; those of the pair, or others.
    """
    both = outlines or (result.gear1.profile, result.gear2.profile)
    wheel, hole = (shapely.Polygon(as_pairs(outline.points)) for outline in both)
    error = max(outline.chord_error for outline in both)
    wheel = wheel.buffer(-TOUCH * error)
    z1, z2 = result.pair.teeth
    if around is None:
        turns = math.lcm(z1, z2) // z1
        angles = 2.0 * math.pi * turns * (np.arange(ANGLES) + 0.137) / ANGLES
    else:
        angles = around + 2.0 * math.pi / z1 * BESIDE
    moved = np.radians(result.motion(angles)["phi2_deg"])
    worst = 0.0
    for phi1, phi2 in zip(angles, moved, strict=True):
        placed = _placed(hole, -phi2, -result.pair.center_distance)
        worst = max(worst, _placed(wheel, -phi1, 0.0).difference(placed).area)
    return worst / result.pair.module**2


def _placed(shape: Any, angle: float, x: float) -> Any:
    c, s = math.cos(angle), math.sin(angle)
    return affine_transform(shape, [c, -s, s, c, x, 0.0])
