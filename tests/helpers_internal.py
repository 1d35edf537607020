"""Wheels within rings, on their shafts: made for tests of the mesh.

The ring's shaft stands at -A; wheel 1 is turned by -phi1 and the ring by -phi2.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

import gearcam as gc
from gearcam.kinds.gear_pair.build import GearPairResult
from helpers_pairs import job

Array = NDArray[np.float64]
Plane = NDArray[np.complex128]

ALPHA = math.radians(20.0)
OVERCLOSURE = math.radians(0.005)
DEEP = gc.Rack(dedendum=1.5, tip_radius=0.0)
"""Straight flanks so deep that the tips of the rings below keep their full height."""

FOCUS = "22.3517355864508/(22.3517355864508 + 22.87542426332165*(1 + 0.3*cos(phi1)))"
TWO_LOBES = "37.668247881141/(37.668247881141 + 18.96124240457442*(1 + 0.2*cos(2*phi1)))"
ROUND = gc.laws.Constant()
LAWS = {
    "circular": (ROUND, (28, 40), 1.0, DEEP),
    "one lobe": (gc.laws.Formula(ratio=FOCUS), (24, 48), 2.0, gc.Rack()),
    "two lobes": (gc.laws.Formula(ratio=TWO_LOBES), (40, 60), 2.0, gc.Rack()),
    "asymmetric": (
        gc.laws.Formula(ratio="1 + 0.2*cos(phi1) + 0.04*sin(2*phi1)"), (30, 60), 2.0, gc.Rack(),
    ),
}  # fmt: skip
CLEAN = ["circular", "one lobe", "asymmetric"]
"""The tips of the two lobes meet outside the mesh."""


def pair_of(law: object, teeth: tuple[int, int], module: float, rack: gc.Rack) -> GearPairResult:
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
