"""Undercut: where a flank turns back on itself, for each tooth and side.

A flank is regular where ``sigma*g = sin(alpha) + w*kappa*cos(alpha)`` is positive, with the
curvature at the rolling point. On a convex centrode it can vanish below the pitch curve, on a
concave one above; at a knot the curvature, and so g, may jump.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.gears.flank import Toothing
from gearcam.numeric.arrays import Array, Ints
from gearcam.numeric.roots import bracketed_root

_STEPS = 33
"""Points along a flank in the search for a change of sign, besides the knots."""

_BESIDE = 1e-9
"""Distance from a knot at which its two sides are evaluated, over the length of the flank."""

_NEAR = 0.05
"""Regularity below which a minimum is refined: it may hide two changes of sign."""

_SECTIONS = 45
"""Golden-section steps of a minimum: exact to rounding."""

_ANGLE = 1e-14
"""Tolerance of a cusp's driver angle, in periods: rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Undercut(ShortRepr):
    """Cusps at which flanks turn back on themselves, one entry per flank.

    Parameters
    ----------
    dedendum, addendum : (n,) arrays, mm
        Reach w at the first cusp below (negative) and above the pitch curve; -inf and +inf without
        one.
    """

    dedendum: Array
    addendum: Array


def find_cusps(
    toothing: Toothing, sf: Array, sigma: Array, lowest: float, highest: float
) -> Undercut:
    """Return the first cusp of every flank on both sides of the pitch curve.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    sf, sigma : (n,) arrays
        Flanks.
    lowest, highest : float, mm
        Range of reach: down to the form point, up to the tip.

    Returns
    -------
    Undercut
        A cusp is a sign change of g, at a root or at a jump of the curvature.
    """
    sine, cosine = np.sin(toothing.cutter.alpha), np.cos(toothing.cutter.alpha)
    kappa = toothing.track.curvature_extremes[1]
    sides = []
    for reach, worst in ((lowest, kappa.max()), (highest, kappa.min())):
        cusp = np.full(sf.shape, np.copysign(np.inf, reach))
        if sine + reach * cosine * worst <= 0.0:
            cusp = _first_cusp(toothing, sf, sigma, reach)
        sides.append(cusp)
    return Undercut(dedendum=sides[0], addendum=sides[1])


def _first_cusp(toothing: Toothing, sf: Array, sigma: Array, reach: float) -> Array:
    """First zero of the regularity from w = 0 to `reach`, or infinity of the sign of `reach`."""

    def regularity(phi: Array, at: Ints) -> Array:
        return toothing.regularity(toothing.frames(phi), sf[at], sigma[at])

    grid = _cusp_grid(toothing, sf, sigma, reach)
    at = np.broadcast_to(np.arange(len(sf))[:, None], grid.shape)
    values = regularity(grid.ravel(), at.ravel()).reshape(grid.shape)
    grid, values = _refine_minima(grid, values, regularity)
    negative = values <= 0.0
    first = np.argmax(negative, axis=1)
    hit = np.flatnonzero(negative.any(axis=1))
    result = np.full(sf.shape, np.copysign(np.inf, reach))
    before, after = (hit, np.maximum(first[hit] - 1, 0)), (hit, first[hit])
    phi = bracketed_root(
        lambda x: regularity(x, hit),
        grid[before],
        grid[after],
        _ANGLE * toothing.track.arc.period,
        (values[before], values[after]),
    )
    result[hit] = sigma[hit] * (sf[hit] - toothing.track.arc_length(phi))
    return result


def _cusp_grid(toothing: Toothing, sf: Array, sigma: Array, reach: float) -> Array:
    """Driver angles from w = 0 to `reach`, one row per flank, with both sides of every knot."""
    start, end = toothing.track.angle(np.stack([sf, sf - sigma * reach]))
    span = end - start
    flank, knots = toothing.track.knots_between(np.minimum(start, end), np.maximum(start, end))
    rank = np.arange(len(flank)) - np.searchsorted(flank, flank)
    sides = np.zeros((len(sf), rank.max(initial=-1) + 1, 2))
    share = ((knots - start[flank]) / span[flank])[:, None]
    sides[flank, rank] = np.clip(share + np.array([-_BESIDE, _BESIDE]), 0.0, 1.0)
    even = np.broadcast_to(np.linspace(0.0, 1.0, _STEPS), (len(sf), _STEPS))
    shares = np.sort(np.concatenate([even, sides.reshape(len(sf), -1)], axis=1), axis=1)
    return start[:, None] + span[:, None] * shares


def _refine_minima(
    grid: Array, values: Array, function: Callable[[Array, Ints], Array]
) -> tuple[Array, Array]:
    """Replace samples at positive local minima near zero by the true minimum (golden section)."""
    low = values[:, 1:-1]
    dip = (low > 0.0) & (low < _NEAR) & (low <= values[:, :-2]) & (low <= values[:, 2:])
    rows, cols = np.nonzero(dip)
    if rows.size == 0:
        return grid, values
    a, b = grid[rows, cols], grid[rows, cols + 2]
    ratio = 0.5 * (np.sqrt(5.0) - 1.0)
    for _ in range(_SECTIONS):
        c, d = b - ratio * (b - a), a + ratio * (b - a)
        left = function(c, rows) < function(d, rows)
        a, b = np.where(left, a, c), np.where(left, d, b)
    grid, values = grid.copy(), values.copy()
    grid[rows, cols + 1] = 0.5 * (a + b)
    values[rows, cols + 1] = function(0.5 * (a + b), rows)
    return grid, values
