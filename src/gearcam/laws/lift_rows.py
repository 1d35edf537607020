"""A lift in rows: its noise, and where its rises, returns and dwells are, roughly.

The *noise* is read from the sixth divided differences of the rows, in which a smooth lift vanishes;
of their sizes the smaller three quarters count, as corners make large ones. The lift *stands still*
where its slope, a line through as few rows as tell a twentieth of the mean slope from noise, is
within four standard deviations of zero, and where it changes by less than a hundredth of the total
lift. Between such stretches, and where the slope changes its sign, lie rises and returns.

Source: derived anew.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.laws.phases_of_lift import TURN
from gearcam.numeric.arrays import Array, Ints

LAG: Final = 20
"""Largest distance of rows, as a part of all, over which errors are correlated."""

_ORDER: Final = 6
_SMALLER: Final = 0.75
_TRIMMED: Final = 0.6073
"""Root mean square of the smaller three quarters of normal numbers, over their deviation."""

_FLOOR: Final = 1e-9
"""Least noise over the total lift: rounding."""

_SURE: Final = 4.0
"""Standard deviations that are no chance."""

_CREEP: Final = 0.05
"""Slope, over the mean one, that the window must be able to tell from noise."""

_STILL: Final = 1e-3
"""Slope, over the mean one, below which the lift stands still without any noise."""

_SLIGHT: Final = 0.01
"""Change of the lift, over the total one, that is no move."""

_DIGITS: Final = 8
"""Digits after the point to which values may be rounded."""

_WHOLE: Final = 1e-12
"""Distance from whole numbers, over the largest value, that is none."""


@dataclass(frozen=True, eq=False, kw_only=True)
class LiftRows:
    """A lift in rows.

    Parameters
    ----------
    theta : (n,) array, rad
        Cam angles, rising, within a turn.
    lift : (n,) array, mm or rad
        Lifts.
    noise : float, mm or rad
        Standard deviation of their noise, above 0.
    error : float, mm or rad
        The part of it that neighbouring rows share.
    """

    theta: Array
    lift: Array
    noise: float
    error: float = 0.0

    @cached_property
    def step(self) -> float:
        """Usual step of the angle, rad."""
        return float(np.median(np.diff(self.theta)))

    @cached_property
    def variance(self) -> float:
        """Variance of the noise; a shared error counts as alike over a twentieth of the turn."""
        return self.noise**2 + self.error**2 * len(self.theta) / LAG

    @cached_property
    def total(self) -> float:
        """Total lift, mm or rad."""
        return float(np.ptp(self.lift))

    def around(self, width: int) -> tuple[Array, Array]:
        """Return angles and lifts of the rows around each row, (n, width), angles over the end."""
        index = np.arange(len(self.theta))[:, None] + np.arange(width) - width // 2
        turns, row = np.divmod(index, len(self.theta))
        return self.theta[row] + TURN * turns, self.lift[row]


def noise_of(rows: LiftRows, scale: float = 1.0) -> float:
    """Return the standard deviation of the noise of a closed lift in rows.

    That of their scatter, or of the rounding of their digits, which a dwell does not show.

    Parameters
    ----------
    rows : LiftRows
        The rows, whose noise is not known.
    scale : float
        Factor to the unit in which they were written.

    Returns
    -------
    float, mm or rad
        At least rounding.
    """
    places, values = rows.around(_ORDER + 1)
    apart = places[:, :, None] - places[:, None, :] + np.eye(_ORDER + 1)
    weights = 1.0 / (apart / apart.max()).prod(axis=2)
    weights /= np.linalg.norm(weights, axis=1, keepdims=True)
    sizes = np.sort(np.abs((weights * values).sum(axis=1)))
    smaller = sizes[: int(_SMALLER * len(sizes))]
    scatter = float(np.sqrt((smaller**2).mean())) / _TRIMMED
    digits = _step_of(scale * rows.lift) / scale / math.sqrt(12.0)
    return max(scatter, _FLOOR * rows.total, digits)


def _step_of(values: Array) -> float:
    """Return the power of ten of which all values (n,) are multiples; 0 if there is none."""
    for digits in range(_DIGITS + 1):
        whole = values * 10.0**digits
        if np.abs(whole - np.round(whole)).max() < _WHOLE * max(1.0, float(np.abs(whole).max())):
            return 10.0**-digits
    return 0.0


def runs_of(rows: LiftRows) -> list[tuple[int, Ints]]:
    """Return what the lift does, 1, -1 or 0, and the rows of it, in a ring.

    Parameters
    ----------
    rows : LiftRows
        The rows.

    Returns
    -------
    list of (int, (m,) int array)
        A rise, a return, or a dwell, and the numbers of its rows.
    """
    slope, least = _slopes(rows)
    signs = np.where(np.abs(slope) <= least, 0, np.sign(slope)).astype(int)
    for sign, run in _groups(signs):
        change = abs(float(rows.lift[run[-1]] - rows.lift[run[0]]))
        if sign and change < max(2.0 * _SURE * rows.noise, _SLIGHT * rows.total):
            signs[run] = 0
    for sign, run in _groups(signs):
        before, after = signs[run[0] - 1], signs[(run[-1] + 1) % len(signs)]
        if not sign and len(run) < 3 and before != after:  # it turns
            signs[run] = before
    return [part for sign, run in _groups(signs) for part in _cut(sign, run, slope, least)]


def _slopes(rows: LiftRows) -> tuple[Array, Array]:
    """Return the slopes at rows, and from which size on they are no noise."""
    mean, width = 2.0 * rows.total / TURN, 5
    while True:
        places, values = rows.around(width)
        places = places - places.mean(axis=1, keepdims=True)
        square = (places**2).sum(axis=1)
        least = _SURE * rows.noise / np.sqrt(square)
        width += 2
        if float(np.median(least)) <= _CREEP * mean or width > len(rows.theta) // 12:
            slope = (places * values).sum(axis=1) / square
            return slope, np.maximum(least, _STILL * mean)


def _cut(sign: int, run: Ints, slope: Array, least: Array) -> list[tuple[int, Ints]]:
    """Return a move, cut where it nearly stops: every law has one peak of velocity."""
    speed = np.abs(slope[run])
    peaks = np.minimum(np.maximum.accumulate(speed), np.maximum.accumulate(speed[::-1])[::-1])
    row = int(np.argmax(peaks - speed))
    depth = float(peaks[row] - speed[row])
    if not sign or depth < max(0.5 * peaks[row], 2.0 * float(least[run[row]])):
        return [(sign, run)]
    parts = (run[:row], run[row:])
    return [one for part in parts for one in _cut(sign, part, slope, least)]


def _groups(signs: Ints) -> list[tuple[int, Ints]]:
    """Return the runs of equal signs in a ring."""
    first = np.flatnonzero(signs != np.roll(signs, 1))
    if not len(first):
        return [(int(signs[0]), np.arange(len(signs)))]
    order = np.roll(np.arange(len(signs)), -first[0])
    return [(int(signs[run[0]]), run) for run in np.split(order, first[1:] - first[0])]
