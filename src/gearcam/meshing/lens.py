"""The overlap that the exact flanks predict for a driver turned ahead: a lens on each pair.

Seen from the driven axis both flanks are curves angle(rho), so the area between them is
``integral of depth*rho d(rho)`` with the depth in rad, over the stretch on which it is positive.
That holds also where an end of a flank or a knot of the law clips the lens; only what lies beyond
the end of a flank, on a fillet or a tip, is left out. Inside smooth flanks the lens has the closed
form ``(4/3)*delta*sqrt(2*delta/kr)`` with ``delta = advance*lever`` and the relative curvature kr.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcam.meshing.contact import FlankPairs, Ints, contacts
from gearcam.meshing.gap import Facing, touches
from gearcam.numeric.roots import bracketed_root

Array = NDArray[np.float64]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


@dataclass(frozen=True, eq=False, kw_only=True)
class Lenses:
    """Predicted overlaps, one entry each.

    Parameters
    ----------
    step, pair : (n,) int arrays
        Index of the phase; j.
    area : (n,) array, mm^2
        By integrating the gap.
    closed : (n,) array, mm^2
        By the closed form; nan where the lens is clipped, holds a knot or lies near a cusp.
    depth : (n,) array, mm
        Largest penetration, across the force.
    radius : (2, n) array, mm
        Distances of the lens's ends from the driver's axis: towards its root, towards its tip.
    edge : (n,) bool array
        Whether an end of a flank lies inside the lens.
    """

    step: Ints
    pair: Ints
    area: Array
    closed: Array
    depth: Array
    radius: Array
    edge: NDArray[np.bool_]


def lenses(
    pairs: FlankPairs,
    phi1: ArrayLike,
    advance: float,
    distance: float | None = None,
    lead: ArrayLike = 0.0,
) -> Lenses:
    """Predict the overlaps of a side.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.
    advance : float, rad
        How far the driver is ahead of them.
    distance : float, mm, optional
        Distance of the shafts as mounted; as designed if left out.
    lead : (n,) array or float, rad
        How far the driven wheel is ahead.

    Returns
    -------
    Lenses
        Only pairs that overlap.
    """
    phi1 = np.atleast_1d(np.asarray(phi1, dtype=float))
    found = touches(pairs, phi1, advance=advance, distance=distance)
    lead = np.broadcast_to(lead, phi1.shape)
    over = -pairs.side * (found.turn - lead[found.step]) > 0.0
    some, middle = found.facing.select(over), found.angle[over]
    root, tip = some.end(2, tip=False), some.end(2, tip=True)
    ahead = lead[some.step]

    def depth(angle: Array) -> Array:
        return -pairs.side * (some.compare(angle, root, tip)[0] - ahead)

    ends, clipped = [], []
    for limit in (found.low[over], found.high[over]):
        inside = depth(limit) > 0.0
        # a bracket without a sign change is never asked for: its two ends are one
        ends.append(bracketed_root(depth, middle, np.where(inside, middle, limit), 1e-12))
        ends[-1][inside] = limit[inside]
        clipped.append(inside)
    low, high = ends
    area = _areas(some, low, high, root, tip, ahead)
    edge = clipped[0] | clipped[1]
    axis, guide = some.distance, some.guide
    radius = np.stack([np.abs(some.flank(1, v, moving=False)[0] + axis) for v in (low, high)])
    point, _ = some.flank(1, middle, moving=False)
    toothing = pairs.toothings[0]
    alpha = toothing.cutter.alpha
    tangent = toothing.frames(middle).t * np.exp(-1j * (some.phi1 + advance))
    normal = tangent * (np.cos(alpha) + pairs.side * np.sin(alpha) * toothing.turn)
    lever = np.abs(guide.lever(point, normal))
    closed = np.where(edge, np.nan, _closed(pairs, phi1, advance, some.step, some.pair))
    if some.distance != toothing.rolling.shift:
        closed[:] = np.nan
    closed[_uneven(pairs, low, high)] = np.nan
    return Lenses(
        step=some.step,
        pair=some.pair,
        area=area,
        closed=closed,
        depth=-pairs.side * (found.turn[over] - ahead) * lever,
        radius=radius,
        edge=edge,
    )


def _areas(some: Facing, low: Array, high: Array, root: Array, tip: Array, ahead: Array) -> Array:
    """Integrate the gaps between driver angles `low` and `high`, mm^2."""
    n, count = len(_NODES), len(low)
    many = some.select(np.repeat(np.arange(count), n))
    half = 0.5 * (high - low)
    angle = (low[:, None] + half[:, None] * (1.0 + _NODES)).ravel()
    point, motion = many.flank(1, angle, moving=True)
    turn = many.compare(angle, np.repeat(root, n), np.repeat(tip, n))[0] - np.repeat(ahead, n)
    # a turn sweeps what the flank's pieces give way along their normals
    values = (turn * many.guide.lever(point, -1j * motion)).reshape(count, n)
    return np.abs(values @ _WEIGHTS * half)


def _closed(pairs: FlankPairs, phi1: Array, advance: float, step: Ints, pair: Ints) -> Array:
    """Return closed forms, mm^2; nan for pairs that do not touch without the advance."""
    exact = contacts(pairs, phi1)
    delta = abs(advance) * exact.lever[0]
    with np.errstate(invalid="ignore"):
        area = (4.0 / 3.0) * delta * np.sqrt(2.0 * delta / exact.curvature)
    known = dict(zip(zip(exact.step.tolist(), exact.pair.tolist(), strict=True), area, strict=True))
    return np.array(
        [known.get(key, np.nan) for key in zip(step.tolist(), pair.tolist(), strict=True)],
        dtype=float,
    )


def _uneven(pairs: FlankPairs, low: Array, high: Array) -> NDArray[np.bool_]:
    """Whether stretches of flank, by driver angle, hold a knot of the law."""
    law = pairs.toothings[0].rolling.law
    start, end = np.minimum(low, high), np.maximum(low, high)
    # a smooth law has no knots but the ends of its lobe
    knots = law.knots[:-1] if len(law.knots) > 2 else law.knots[:0]
    first = np.floor((start[:, None] - knots) / law.lobes.period)
    return np.any(np.floor((end[:, None] - knots) / law.lobes.period) > first, axis=1)
