"""Internal pairs for tests: a law that is not symmetric, and one whose ring has a waist."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import shapely

import gearcam
from gearcam.gears.spec import PairSpec
from gearcam.kinds.gear_pair.build import GearPairResult
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.laws.ratio.formula import Formula
from gearcam.laws.ratio.phases import Phases

UNEVEN = Phases(knots=(0.0, math.radians(130.0), 2.0 * math.pi), ratios=(0.6, 0.4, 0.6))
"""Not symmetric: the ring is not its own mirror image."""

WAIST = Formula(ratio="1 + 0.3*cos(phi1)")
"""The ring's centrode bends towards its shaft twice."""


def ring_design(law: Any = UNEVEN, pair: Any = None, **tables: Any) -> GearPairDesign:
    """Return the design of an internal pair, 24 : 48 of module 2 where nothing else is said."""
    sizes = {"type": "internal", "teeth": (24, 48), "module": 2.0} | (pair or {})
    return GearPairDesign(name="ring", law=law, pair=PairSpec(**sizes), **tables)


def ring_job(law: Any = UNEVEN, pair: Any = None, **tables: Any) -> GearPairResult:
    return gearcam.build(ring_design(law, pair, **tables))


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
