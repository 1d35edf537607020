"""Where flanks end at the top: at the addendum curve, at the mate's reach, or at a cusp."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gearcam.gears.flank import Toothing
from gearcam.gears.track import Plane
from gearcam.numeric.roots import newton_in_bracket

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_MISS = 1e-12
"""Distance at which flank and addendum curve meet, in addenda."""

_ANGLE = 2e-15
"""Tolerance of roll angles, in periods: 1e-14 rad is 1e-12 mm at a radius of 100 mm."""


@dataclass(frozen=True, eq=False, kw_only=True)
class TipEnds:
    """Where flanks end at the top: one entry a flank.

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


def find_tips(toothing: Toothing, sf: Array, sigma: Array, highest: Array) -> TipEnds:
    """Find where flanks meet the addendum curve, the parallel of the centrode at the addendum.

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
        By distance from the centrode, never by rack height: the two differ where it is curved.

    Notes
    -----
    Newton's method on the two curves is tried first and kept where its root is one, inside the
    allowed reach; the others are searched in their bracket.
    """
    addendum = toothing.cutter.addendum
    phi, foot, height = _quick(toothing, sf, sigma)
    reach = sigma * (sf - toothing.track.arc_length(phi))
    full = np.isfinite(height) & (reach > 0.0) & (reach <= highest)
    rest = np.flatnonzero(~full)
    if rest.size:
        ends = _search(toothing, sf[rest], sigma[rest], highest[rest])
        phi[rest], foot[rest], height[rest], full[rest] = ends
    height[full] = addendum
    return TipEnds(phi=phi, foot=foot, height=height, full=full)


def _quick(toothing: Toothing, sf: Array, sigma: Array) -> tuple[Array, Array, Array]:
    """Driver angles of the crossings with the addendum curve, and of their feet; height nan if none."""
    addendum, alpha, w = toothing.cutter.addendum, toothing.cutter.alpha, toothing.turn
    reach = 0.85 * addendum / (np.sin(alpha) * np.cos(alpha))
    phi, foot = toothing.track.angle(
        np.stack([sf - sigma * reach, sf - sigma * reach * np.sin(alpha) ** 2])
    )
    miss = np.full(sf.shape, np.inf, dtype=complex)
    for _ in range(8):
        both = toothing.frames(np.stack([phi, foot]))
        roll, base = both.take(0), both.take(1)
        miss = toothing.flank_points(roll, sf, sigma) - base.p - addendum * w * base.t
        if float(np.abs(miss).max()) <= _MISS * addendum:
            break
        move = toothing.flank_motion(roll, sf, sigma)
        slide = -base.speed * (1.0 + base.kappa * addendum) * base.t
        with np.errstate(divide="ignore", invalid="ignore"):
            phi = phi - np.imag(np.conj(slide) * miss) / np.imag(np.conj(slide) * move)
            foot = foot - np.imag(np.conj(move) * miss) / np.imag(np.conj(move) * slide)
        bad = ~(np.isfinite(phi) & np.isfinite(foot))
        phi[bad] = foot[bad] = 0.0
    return phi, foot, np.where(np.abs(miss) <= _MISS * addendum, addendum, np.nan)


def _search(
    toothing: Toothing, sf: Array, sigma: Array, highest: Array
) -> tuple[Array, Array, Array, Mask]:
    """Search tip ends in their bracket: driver angles, feet, heights, whether they are full."""
    track, addendum, w = toothing.track, toothing.cutter.addendum, toothing.turn
    around = 3.0 * toothing.cutter.half_space + addendum
    near = sf - sigma * highest * np.sin(toothing.cutter.alpha) ** 2
    start, end, low, high, guess = track.angle(
        np.stack([sf, sf - sigma * highest, sf - around, sf + around, near])
    )

    def distance(phi: Array, at: NDArray[np.int64] | slice) -> tuple[Array, Array, Array]:
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
        tolerance = _ANGLE * track.arc.period
        phi[at] = newton_in_bracket(over, start[at], end[at], first, tolerance)
        height[at], _, foot[at] = distance(phi[at], at)
    return phi, foot, height, full


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
    return newton_in_bracket(miss, low, high, inside, _ANGLE * toothing.track.arc.period)
