"""The circle nearest to points: the one whose largest distance from any of them is the least.

Round a centre, distances of the points are nearly linear in its moves. The best move is a linear
problem of three unknowns, which exchange solves: a circle is as far from four points, inside or
outside of each; one of these gives way to the farthest point until none is farther (Stiefel;
Cheney, Introduction to Approximation Theory, chapter 2). The four need not be in turn inside and
outside along a path that turns back. Such moves end at a circle that is the best one next to it.
Centres all over the plane are compared first, since there may be several of these.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Plane

_EVEN: Final = 1e-13
"""Gain of deviation that is none, as a share of the radius."""

_STRAIGHT: Final = 1e-9
"""Height over length of points that are too straight for a circle."""

_FAR: Final = 1e6
"""Farthest centre in sizes of the points: an arc of them is as straight as rounding lets tell."""

_RINGS, _RAYS = 16, 32
"""Centres that are compared at first: distances from the points, and directions."""

_STARTS: Final = 2
"""Best ones of these from which the nearest circle is searched."""

_MOVES: Final = 40
"""Largest number of moves of a centre."""

_EXCHANGES: Final = 200
"""Largest number of points that give way in each."""

_HALVED: Final = 14
"""How often a move is halved that is no gain, since distances are not linear in it."""


class StraightError(ValueError):
    """A stretch to which no circle is nearest."""


def nearest_center(points: Plane) -> complex:
    """Return the centre of the circle nearest to points.

    Parameters
    ----------
    points : (n,) array of complex, mm
        At least four.

    Returns
    -------
    complex, mm
        At most a million times as far as the points are apart: of points that bend both ways a
        straight line may be nearer than any circle.

    Raises
    ------
    StraightError
        If the points are one, or in a straight line.
    """
    middle, size = points.mean(), _size(points)
    if size <= 10.0 * _EVEN * abs(middle):
        raise StraightError("the stretch is a point: no circle is nearest to it; take a line")
    away = (points - middle) / size
    starts = [_least_squares(away), *_compared(away)]
    found = [moved_center(away, one) for one in starts]
    return complex(middle + size * min(found, key=lambda one: one[1])[0])


def moved_center(points: Plane, center: complex) -> tuple[complex, float]:
    """Return the centre next to another one that is best for points.

    Parameters
    ----------
    points : (n,) array of complex, mm
        At least four.
    center : complex, mm
        Where the search starts.

    Returns
    -------
    center : complex, mm
    deviation : float, mm
        Largest distance of the points from its circle.
    """
    middle, farthest = points.mean(), _FAR * _size(points)
    deviation = _deviation(points, center)
    even = _EVEN * float(np.abs(points - center).max())
    for _ in range(_MOVES):
        before = deviation
        center, deviation = _moved(points, center, deviation)
        if before - deviation <= even or abs(center - middle) > farthest:
            break
    return center, deviation


def _moved(points: Plane, center: complex, deviation: float) -> tuple[complex, float]:
    """Return a centre after the best move, or the largest part of it that is a gain."""
    move = _best_move(points, center)
    for halved in range(_HALVED):
        tried = center + move * 0.5**halved
        found = _deviation(points, tried)
        if found < deviation:
            return tried, found
    return center, deviation


def _size(points: Plane) -> float:
    return float(np.abs(points - points.mean()).max())


def _deviation(points: Plane, center: complex) -> float:
    return 0.5 * float(np.ptp(np.abs(points - center)))


def _least_squares(away: Plane) -> complex:
    """Return the centre of the circle with the least squares of powers of points about 0."""
    spread = np.linalg.svd(np.stack([away.real, away.imag]), compute_uv=False)
    if spread[1] <= _STRAIGHT * spread[0]:
        raise StraightError("the stretch is straight: no circle is nearest to it; take a line")
    matrix = np.stack([2.0 * away.real, 2.0 * away.imag, np.ones(away.size)], axis=1)
    x, y, _ = np.linalg.lstsq(matrix, np.abs(away) ** 2, rcond=None)[0]
    return complex(x, y)


def _compared(away: Plane) -> list[complex]:
    """Return the best of some centres near and far from points about 0, of size 1."""
    rings = np.tan(0.5 * math.pi * (np.arange(_RINGS) + 0.5) / _RINGS)
    rays = np.exp(2j * math.pi * np.arange(_RAYS) / _RAYS)
    centers = (rings[:, None] * rays).ravel()
    deviations = np.ptp(np.abs(away - centers[:, None]), axis=1)
    return [complex(one) for one in centers[deviations.argsort()[:_STARTS]]]


def _best_move(points: Plane, center: complex) -> complex:
    """Return the move of a centre that is best if distances were linear in it."""
    away = points - center
    distance = np.abs(away)
    toward = away / np.where(distance > 0.0, distance, 1.0)  # the centre may be a point
    rows = np.stack([np.ones(away.size), toward.real, toward.imag], axis=1)
    even, scales = np.linalg.qr(rows)  # of a far circle the directions hardly differ
    if np.abs(np.diag(scales)).min() <= _EVEN * abs(scales[0, 0]):
        return 0j
    _, x, y = np.linalg.solve(scales, _leveled(even, distance))
    return complex(x, y)


def _leveled(rows: Array, values: Array) -> Array:
    """Return the three unknowns with the least largest difference of rows times them from values.

    Parameters
    ----------
    rows : (n, 3) array
        With orthonormal columns.
    values : (n,) array
        Wanted.

    Returns
    -------
    (3,) array
    """
    four = np.linspace(0, values.size - 1, 4).round().astype(int)
    solution = np.zeros(4)
    for _ in range(_EXCHANGES):
        weights = np.linalg.svd(rows[four].T)[2][-1]  # times the rows they make 0
        signs = np.where(weights * (weights @ values[four]) >= 0.0, 1.0, -1.0)
        solution = np.linalg.lstsq(np.c_[rows[four], signs], values[four], rcond=None)[0]
        off = values - rows @ solution[:3]
        worst = int(np.abs(off).argmax())
        if abs(off[worst]) <= abs(solution[3]) + _EVEN * values.max() or worst in four:
            break
        # the one that leaves weights above 0 with the new point among the four
        known = np.r_[(rows[four] * signs[:, None]).T, np.ones((1, 4))]
        new = np.append(np.sign(off[worst]) * rows[worst], 1.0)
        shares = np.linalg.lstsq(known, new, rcond=None)[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            left = np.where(shares > _EVEN, np.abs(weights) / shares, np.inf)
        four[left.argmin()] = worst
    return solution[:3]
