"""Where flanks end: at the addendum curve, at the limit set by the mate, or at a cusp.

A flank is regular where ``sigma*g = sin(alpha) + w*kappa*cos(alpha)`` is positive, with the
curvature at the rolling point; at a *cusp* it turns back on itself: undercut. On a convex centrode
g can vanish below the pitch curve, on a concave one above; at a knot the curvature, and so g, may
jump.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass
from functools import partial

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.gears.flank import Toothing
from gearcam.gears.track import Frames
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.roots import bracketed_root, newton_in_bracket

_MISS = 1e-12
"""Distance, in pitches, at which curves count as crossing."""

_ROUNDING = 2e-14
"""The same in lengths of the centrode: the rounding of points where the driver's radius grows
fastest, on an ellipse of eccentricity 0.99."""

ROUGH = 1e3
"""Multiple of that distance that is accepted where Newton's method gets no nearer."""

_STEPS, _QUICK = 25, 8
"""Steps of Newton's method, and fewer where another method can follow; curves that cross need four
or five."""

_SHORT = 0.9
"""Largest step, as a share of the distance to the end of the curve."""

_ANGLE = 2e-15
"""Tolerance of roll angles, in periods: 1e-14 rad is 1e-12 mm at a radius of 100 mm."""

_Motion = Callable[[Array, Frames], tuple[Plane, Plane]]


@dataclass(frozen=True, eq=False, kw_only=True)
class TipEnds(ShortRepr):
    """Upper ends of flanks, one entry per flank.

    Parameters
    ----------
    phi : (n,) array, rad
        Driver angle of the flank's last point.
    foot : (n,) array, rad
        Driver angle of that point's foot on the centrode.
    height : (n,) array, mm
        Its distance from the centrode.
    full : (n,) bool array
        Whether it reaches the addendum curve.
    """

    phi: Array
    foot: Array
    height: Array
    full: Mask

    def replaced(self, which: Ints, ends: TipEnds) -> TipEnds:
        """Return these with the ends of flanks `which` replaced by `ends`."""
        tips = deepcopy(self)
        tips.phi[which], tips.foot[which] = ends.phi, ends.foot
        tips.height[which], tips.full[which] = ends.height, ends.full
        return tips


def find_tips(toothing: Toothing, sf: Array, sigma: Array, highest: Array) -> TipEnds:
    """Return where flanks meet the addendum curve, the parallel of the centrode at the addendum.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    sf, sigma : (n,) arrays
        Flanks.
    highest : (n,) array, mm
        Largest reach allowed: that of the mate's form point, or of a cusp.

    Returns
    -------
    TipEnds
        Height is the distance from the centrode, not rack height: they differ where it is curved.

    Notes
    -----
    Newton's method on the two curves is tried first and kept where it converges inside the allowed
    reach; the others are bracketed.
    """
    addendum = toothing.cutter.addendum
    phi, foot, height = _quick(toothing, sf, sigma)
    reach = sigma * (sf - toothing.track.arc_length(phi))
    full = np.isfinite(height) & (reach > 0.0) & (reach <= highest)
    full &= np.abs(toothing.track.arc_length(foot) - sf) <= _around(toothing)
    rest = np.flatnonzero(~full)
    if rest.size:
        ends = _search(toothing, sf[rest], sigma[rest], highest[rest])
        phi[rest], foot[rest], height[rest], full[rest] = ends
    height[full] = addendum
    return TipEnds(phi=phi, foot=foot, height=height, full=full)


def _quick(toothing: Toothing, sf: Array, sigma: Array) -> tuple[Array, Array, Array]:
    """Driver angles of crossings with the addendum curve, and feet; height is nan without one."""
    addendum, alpha, w = toothing.cutter.addendum, toothing.cutter.alpha, toothing.turn
    reach = 0.85 * addendum / (np.sin(alpha) * np.cos(alpha))
    guess = np.stack([sf - sigma * reach, sf - sigma * reach * np.sin(alpha) ** 2])

    def curve(_: Array, base: Frames) -> tuple[Plane, Plane]:
        slide = base.speed * (1.0 + base.kappa * addendum) * base.t
        return base.p + addendum * w * base.t, slide

    flank = partial(flank_at, toothing, sf, sigma)
    phi, foot, miss = cross(toothing, flank, curve, toothing.track.angle(guess), most=_QUICK)
    return phi, foot, np.where(miss <= near(toothing), addendum, np.nan)


def near(toothing: Toothing) -> float:
    """Return the distance, mm, at which curves of a wheel count as crossing: rounding."""
    return max(_MISS * toothing.pitch, _ROUNDING * toothing.track.length)


def flank_at(
    toothing: Toothing, sf: Array, sigma: Array, _: Array, frames: Frames
) -> tuple[Plane, Plane]:
    """Return points of flanks (`sf`, `sigma`) of `toothing` at `frames`, and their derivatives."""
    return toothing.flank_points(frames, sf, sigma), toothing.flank_motion(frames, sf, sigma)


def cross(
    toothing: Toothing,
    one: _Motion,
    two: _Motion,
    phi: Array,
    limits: tuple[Array, Array] | None = None,
    most: int = _STEPS,
) -> tuple[Array, Array, Array]:
    """Return crossings of curves of a toothing, n pairs at once, by Newton's method.

    A step that gets no nearer is halved: where curvatures jump, full steps may oscillate.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    one, two : callable
        ``one(phi, frames)`` returns points, mm, and their derivatives by the driver angle.
    phi : (2, n) array, rad
        First guesses on both curves: not at a cusp, where the derivative is 0.
    limits : two (2, n) arrays, rad, optional
        Lower and upper ends of the curves: steps beyond a cusp would not return.
    most : int
        Steps at most.

    Returns
    -------
    x, y : (n,) arrays, rad
        Driver angles on both curves.
    miss : (n,) array, mm
        Distance of their points, before a last step that is no longer than the one before it.
    """
    place, step, last = phi, np.zeros_like(phi), np.zeros_like(phi)
    miss, nearer = np.full(phi.shape[1:], np.inf), np.zeros(phi.shape[1:], dtype=bool)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(most):
            frames = toothing.frames(phi)
            (p, move), (q, slide) = one(phi[0], frames.some(0)), two(phi[1], frames.some(1))
            gap = p - q
            # both steps share one determinant, the cross product of the curves' directions
            ahead = np.imag(np.conj(np.stack([-slide, move])) * gap)
            ahead = ahead / np.imag(np.conj(np.stack([slide, move])) * np.stack([move, slide]))
            ahead = np.where(np.isfinite(ahead).all(axis=0), ahead, 0.0)
            if limits is not None:
                room = np.where(ahead > 0.0, limits[1] - phi, limits[0] - phi) / ahead
                ahead = ahead * np.fmin(1.0, _SHORT * np.fmin(*room))
            nearer = np.abs(gap) < miss
            place, miss = np.where(nearer, phi, place), np.where(nearer, np.abs(gap), miss)
            last, step = step, np.where(nearer, ahead, 0.5 * step)
            if not np.any(miss > near(toothing)):
                break
            phi = place + step
    shorter = nearer & (np.abs(step) <= np.abs(last)).all(axis=0)
    x, y = place + np.where(shorter, step, 0.0)
    return x, y, miss


def flank_crossings(
    toothing: Toothing, sf: Array, sigma: Array, foot: Array, end: Array
) -> tuple[Array, Mask]:
    """Return where two flanks of teeth cross.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    sf, sigma : (2, n) arrays, mm and 1
        The flanks, both of a tooth on one turn.
    foot, end : (2, n) arrays, rad
        Driver angles that bound the crossing: at the pitch curve, and at the upper ends.

    Returns
    -------
    phi : (2, n) array, rad
        Driver angles of the crossing on both flanks.
    met : (n,) bool array
        Whether they cross.
    """
    one, two = (partial(flank_at, toothing, sf[k], sigma[k]) for k in (0, 1))
    limits = np.minimum(foot, end), np.maximum(foot, end)
    first, second, miss = cross(toothing, one, two, 0.5 * (foot + end), limits)
    return np.stack([first, second]), miss <= ROUGH * near(toothing)


def _search(
    toothing: Toothing, sf: Array, sigma: Array, highest: Array
) -> tuple[Array, Array, Array, Mask]:
    """Return driver angles, feet, heights and the `full` mask of tip ends, by bracketing."""
    track, addendum, w = toothing.track, toothing.cutter.addendum, toothing.turn
    around = _around(toothing)
    below = sf - sigma * highest * np.sin(toothing.cutter.alpha) ** 2
    start, end, low, high, guess = track.angle(
        np.stack([sf, sf - sigma * highest, sf - around, sf + around, below])
    )

    def distance(phi: Array, at: Ints | slice) -> tuple[Array, Array, Array]:
        frames = toothing.frames(phi)
        points = toothing.flank_points(frames, sf[at], sigma[at])
        foot = feet(toothing, points, low[at], high[at], guess[at])
        base = toothing.frames(foot)
        outward = base.t * w
        slope = np.real(np.conj(outward) * toothing.flank_motion(frames, sf[at], sigma[at]))
        return np.real(np.conj(outward) * (points - base.p)), slope, foot

    height, _, foot = distance(end, slice(None))
    full = height > addendum
    phi = end.copy()
    at = np.flatnonzero(full)
    if at.size:

        def over(x: Array) -> tuple[Array, Array]:
            value, slope, _ = distance(x, at)
            return value - addendum, slope

        first = start[at] + (end - start)[at] * np.clip(addendum / height[at], 0.0, 1.0)
        tolerance, noise = _ANGLE * track.arc.period, _ROUNDING * track.length
        phi[at] = newton_in_bracket(over, start[at], end[at], first, tolerance, noise)
        height[at], _, foot[at] = distance(phi[at], at)
    return phi, foot, height, full


def _around(toothing: Toothing) -> float:
    """Largest distance along the centrode between flanks and the feet of their points, mm."""
    return 3.0 * toothing.cutter.half_space + toothing.cutter.addendum


def feet(toothing: Toothing, points: Plane, low: Array, high: Array, start: Array) -> Array:
    """Return the feet of points on the centrode.

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    points : (n,) complex array, mm
        Points near its centrode.
    low, high, start : (n,) arrays, rad
        Driver angles between which the feet lie, and a first guess.

    Returns
    -------
    (n,) array, rad
        Driver angles of the feet.
    """

    def miss(phi: Array) -> tuple[Array, Array]:
        frames = toothing.frames(phi)
        along = np.real(np.conj(frames.t) * (frames.p - points))
        out = np.real(np.conj(frames.t * toothing.turn) * (points - frames.p))
        return along, frames.speed * (1.0 + frames.kappa * out)

    inside = np.clip(start, np.minimum(low, high), np.maximum(low, high))
    tolerance, noise = _ANGLE * toothing.track.arc.period, _ROUNDING * toothing.track.length
    return newton_in_bracket(miss, low, high, inside, tolerance, noise)


_CUSP_STEPS = 33
"""Points along a flank in the search for a change of sign, besides the knots."""

_BESIDE = 1e-9
"""Distance from a knot at which its two sides are evaluated, over the length of the flank."""

_NEAR = 0.05
"""Regularity below which a minimum is refined: it may hide two changes of sign."""

_SECTIONS = 45
"""Golden-section steps of a minimum: exact to rounding."""

_CUSP_ANGLE = 1e-14
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
        _CUSP_ANGLE * toothing.track.arc.period,
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
    even = np.broadcast_to(np.linspace(0.0, 1.0, _CUSP_STEPS), (len(sf), _CUSP_STEPS))
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
