"""Shape-preserving curves through points: smooth, and rising wherever the points rise.

Between two points the curve is a quintic with given slopes and curvatures at both, so that it is
C2. Slopes and curvatures come from quartics through five neighbours, and are reduced where the
quintic's derivative could change its sign between points that rise (or fall): it is sufficient that
its Bernstein coefficients on the interval have one sign.
"""

from __future__ import annotations

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.numeric.hermite import hermite_quintics

_STENCIL = 5

_BEND = 8.0
"""Largest curvature next to an extreme, in slopes there over the interval: four times that of a
parabola, far below the curvature from a much nearer neighbour's slopes."""


def quintics(x: Array, y: Array, rise: float | None) -> Array:
    """Return the quintics through points.

    Parameters
    ----------
    x : (n + 1,) array
        Rising, n at least 4.
    y : (n + 1,) array
        Values.
    rise : float or None
        For a periodic curve: its rise over a period, equal to ``y[-1] - y[0]``; None for a curve
        that is not periodic.

    Returns
    -------
    (n, 6) array
        Coefficients of the powers of ``x - x[k]`` on interval k.
    """
    h, secant = np.diff(x), np.diff(y) / np.diff(x)
    slope, bend = _estimates(x, y, rise)
    slope = _limited_slopes(slope, secant, rise is not None)
    bend = _limited_bends(slope, bend, secant, h, rise is not None)
    return hermite_quintics(x, y, slope, bend)


def _estimates(x: Array, y: Array, rise: float | None) -> tuple[Array, Array]:
    """Slopes and curvatures at the points, from the quartic through five of them."""
    count = len(x)
    if rise is None:
        first = np.clip(np.arange(count) - _STENCIL // 2, 0, count - _STENCIL)
        index = first[:, None] + np.arange(_STENCIL)
        xs, ys = x[index], y[index]
    else:
        n = count - 1
        index = np.arange(count)[:, None] + np.arange(_STENCIL) - _STENCIL // 2
        turns, rest = np.divmod(index, n)
        xs, ys = x[rest] + turns * (x[-1] - x[0]), y[rest] + turns * rise
    scale = np.abs(xs - x[:, None]).max(axis=1)
    t = (xs - x[:, None]) / scale[:, None]
    powers = np.linalg.solve(t[:, :, None] ** np.arange(_STENCIL), (ys - y[:, None])[..., None])
    return powers[:, 1, 0] / scale, 2.0 * powers[:, 2, 0] / scale**2


def _sides(secant: Array, repeats: bool) -> tuple[Array, Array]:
    """Secants before and after each point; at an end both are that of the other side."""
    ends = (secant[-1], secant[0]) if repeats else (secant[0], secant[-1])
    return np.append(ends[0], secant), np.append(secant, ends[1])


def _limited_slopes(slope: Array, secant: Array, repeats: bool) -> Array:
    """Return slopes limited so that a monotonic quintic exists: d0 + d1 at most 2.5 secants."""
    before, after = _sides(secant, repeats)
    rising = before * after > 0.0
    slope = np.where(rising & (slope * before < 0.0), 0.0, slope)
    total = np.abs(slope[:-1]) + np.abs(slope[1:])
    allowed = 2.5 * np.abs(secant)
    larger = np.maximum(total, allowed)
    share = np.divide(allowed, larger, out=np.ones_like(total), where=larger > 0.0)
    return slope * np.minimum(*_sides(share, repeats))


def _limited_bends(slope: Array, bend: Array, secant: Array, h: Array, repeats: bool) -> Array:
    """Return curvatures limited so that no Bernstein coefficient of the derivative changes sign.

    Those are ``d0, d0 + h*s0/4, 5*secant - 2*d0 - 2*d1 - h*(s0 - s1)/4, d1 - h*s1/4, d1``.
    """
    sign = np.where(secant < 0.0, -1.0, 1.0)
    d0, d1 = sign * slope[:-1], sign * slope[1:]
    spare = np.maximum(5.0 * np.abs(secant) - 2.0 * (d0 + d1), 0.0)
    # bounds of s0 and s1 from their interval, in its rising direction
    low0, high0 = -4.0 * np.maximum(d0, 0.0) / h, 2.0 * spare / h
    low1, high1 = -2.0 * spare / h, 4.0 * np.maximum(d1, 0.0) / h
    low0, high0 = np.where(sign > 0, low0, -high0), np.where(sign > 0, high0, -low0)
    low1, high1 = np.where(sign > 0, low1, -high1), np.where(sign > 0, high1, -low1)
    # an interval with end slopes against its rise has an extreme anyway
    free = (d0 < 0.0) | (d1 < 0.0)
    most = _BEND * (np.abs(d0) + np.abs(d1) + np.abs(secant)) / h
    low0, low1 = (np.where(free, -most, v) for v in (low0, low1))
    high0, high1 = (np.where(free, most, v) for v in (high0, high1))
    none = (low1[-1], high1[-1], low0[0], high0[0]) if repeats else (-np.inf, np.inf) * 2
    low = np.maximum(np.append(low0, none[2]), np.append(none[0], low1))
    high = np.minimum(np.append(high0, none[3]), np.append(none[1], high1))
    return np.clip(bend, low, np.maximum(low, high))
