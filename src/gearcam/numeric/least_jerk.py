"""Curves through points, or near them, with the least integral of the squared third derivative.

Between points the curve is a quintic; derivatives up to the fourth are continuous. A periodic curve
is a *ring*, one with two ends a *chain*. Slopes and second derivatives at the points, and the
values of a smoothed ring, minimise a quadratic form: its system is symmetric, positive definite,
and couples neighbours only. Every second point is eliminated at once, repeatedly, so that n points
take log2(n) steps.

Source: C. de Boor, A Practical Guide to Splines (smoothing and interpolating splines); the
coefficients are integrals over one quintic.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.numeric.hermite import hermite_quintics

_SAME: Final = np.array([[720.0, 360.0, 60.0], [360.0, 192.0, 36.0], [60.0, 36.0, 9.0]])
"""Integral of the squared third derivative over an interval of length 1: quadratic form of value,
slope and second derivative at its left end. At the right end entries of odd order change sign."""

_OTHER: Final = np.array([[-720.0, 360.0, -60.0], [-360.0, 168.0, -24.0], [-60.0, 24.0, -3.0]])
"""Cross terms of the left end (rows) with the right end (columns)."""

_ORDER: Final[Array] = np.add.outer(np.arange(3.0), np.arange(3.0))

_FEW: Final = 3
"""Number of points up to which a ring is solved directly, as points are their own neighbours."""


def ring_slopes(x: Array, y: Array, period: float) -> Array:
    """Return slope and second derivative at the points of a ring.

    Parameters
    ----------
    x : (n,) array
        Rising, within a period.
    y : (n,) array
        Values.
    period : float
        Period.

    Returns
    -------
    (n, 2) array
    """
    left, right, beside = _forms(_widths(x, period))
    rise = (np.roll(y, -1) - y)[:, None]
    wanted = left[:, 1:, 0] * rise - np.roll(right[:, 1:, 0] * rise, 1, axis=0)
    diagonal = left + np.roll(right, 1, axis=0)
    return _solved(diagonal[:, 1:, 1:], beside[:, 1:, 1:], wanted[..., None])[..., 0]


def chain_slopes(x: Array, y: Array, start: tuple[float, float], end: tuple[float, float]) -> Array:
    """Return slope and second derivative at the points of a chain.

    Parameters
    ----------
    x : (n,) array
        Rising, three points at least.
    y : (n,) array
        Values.
    start, end : (float, float)
        Slope and second derivative at the ends.

    Returns
    -------
    (n, 2) array
    """
    left, right, beside = (form[:, 1:] for form in _forms(np.diff(x)))
    rise = np.diff(y)[:, None]
    wanted = left[1:, :, 0] * rise[1:] - right[:-1, :, 0] * rise[:-1]
    inner = beside[..., 1:]
    wanted[0] -= inner[0].T @ start
    wanted[-1] -= inner[-1] @ end
    coupled = np.concatenate([inner[1:-1], np.zeros((1, 2, 2))])
    found = _solved(left[1:, :, 1:] + right[:-1, :, 1:], coupled, wanted[..., None])[..., 0]
    return np.concatenate([[start], found, [end]])


def smoothed_ring(x: Array, y: Array, period: float, cutoff: float) -> Array:
    """Return the values of a smoothing ring at its points.

    It minimises the integral of the squared third derivative plus the sum of squared distances from
    the points times a weight, ``cutoff**6`` times their mean spacing.

    Parameters
    ----------
    x : (n,) array
        Rising, within a period.
    y : (n,) array
        Values.
    period : float
        Period.
    cutoff : float
        Wave number (phase per unit of x) at which waves of evenly spaced points keep half their
        height; in general they keep ``1/(1 + (number/cutoff)**6)``.

    Returns
    -------
    (n,) array
        Rounding grows with the sixth power of the points per wave at the cutoff; it is smooth, as
        if by a slightly different smoothing, and below 1e-17*(n/cutoff)**6 of the largest value.
    """
    left, right, beside = _forms(_widths(x, period))
    diagonal, mean = left + np.roll(right, 1, axis=0), y.mean()
    weight = cutoff**6 * period / len(x)
    diagonal[:, 0, 0] += weight
    wanted = np.zeros((len(x), 3, 1))
    wanted[:, 0, 0] = weight * (y - mean)  # subtracting a constant preserves digits
    return mean + _solved(diagonal, beside, wanted)[:, 0, 0]


def coefficients(x: Array, y: Array, slopes: Array, *, ring: bool) -> tuple[Array, Array]:
    """Return the quintics through points with known derivatives, from both ends of each interval.

    Parameters
    ----------
    x, y : (n + 1,) arrays
        Points; the last of a ring is the first one, a period later.
    slopes : (n + 1, 2) array
        Slopes and second derivatives there.
    ring : bool
        Whether the curve is a ring.

    Returns
    -------
    left, right : (n, 6) arrays
        Coefficients of rising powers of the distance from the point before, and from the point
        after. At a point the third derivative is the same number on both sides, without rounding.
    """
    h = np.diff(x)
    left = hermite_quintics(x, y, *slopes.T).T
    cubic, quartic, quintic = left[3:]
    jerk = cubic + h * (4.0 * quartic + 10.0 * h * quintic)
    slope, bend = slopes[1:].T
    right = np.array([y[1:], slope, 0.5 * bend, jerk, quartic + 5.0 * h * quintic, quintic])
    right[3] = np.append(left[3, 1:], left[3, 0] if ring else right[3, -1])
    return left.T, right.T


def _widths(x: Array, period: float) -> Array:
    return np.diff(np.append(x, x[0] + period))


def _forms(h: Array) -> tuple[Array, Array, Array]:
    """Return the quadratic forms of intervals: left ends, right ends, and cross terms."""
    scale = h[:, None, None] ** (_ORDER - 5.0)
    left = _SAME * scale
    return left, left * (-1.0) ** _ORDER, _OTHER * scale


def _solved(diagonal: Array, beside: Array, wanted: Array) -> Array:
    """Return the solution of a symmetric cyclic system of n blocks, (n, b, 1).

    Row k has the block ``diagonal[k]``, and ``beside[k]`` in the next column.
    """
    count, size = diagonal.shape[:2]
    if count <= _FEW:
        matrix = np.zeros((count, size, count, size))
        for k in range(count):
            after = (k + 1) % count
            matrix[k, :, k] += diagonal[k]
            matrix[k, :, after] += beside[k]
            matrix[after, :, k] += beside[k].T
        flat = matrix.reshape(count * size, -1)
        solution = np.linalg.solve(flat, wanted.ravel()).reshape(wanted.shape)
        return np.asarray(solution, dtype=float)
    odd = np.arange(1, count, 2) if count % 2 == 0 else np.arange(1, count - 1, 2)
    before, after = beside[odd - 1], beside[odd].transpose(0, 2, 1)
    known = np.concatenate([before.transpose(0, 2, 1), beside[odd], wanted[odd]], axis=2)
    back, on, own = np.split(np.linalg.solve(diagonal[odd], known), [size, 2 * size], axis=2)
    rest, here = diagonal[::2].copy(), slice(len(odd))
    following = (np.arange(len(odd)) + 1) % len(rest)
    left = wanted[::2].copy()
    rest[here] -= before @ back
    left[here] -= before @ own
    rest[following] -= after @ on
    left[following] -= after @ own
    coupled = np.concatenate([-before @ on, beside[count - count % 2 :]])
    even = _solved(rest, coupled, left)
    solution = np.empty_like(wanted)
    solution[::2] = even
    solution[odd] = own - back @ even[here] - on @ even[following]
    return solution
