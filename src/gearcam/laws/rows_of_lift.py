"""From rows of angle and lift to a lift program.

Without a tolerance the lift is the closed curve through the rows with the least integral of the
squared jerk: quintics between rows, C4 everywhere, whose error falls with the sixth power of the
step for a smooth motion. Measured rows are noisy, and the jerk of a curve through them is that of
the noise. With a tolerance the lift is the smoothing spline, which balances the same jerk against
the distances from the rows. Its cutoff is the lowest at which no row is farther away than the
tolerance, so that noise is averaged by one rule over the whole turn. (The curve of least jerk
within the tolerance would be smoother, but runs along the tolerance and flattens every peak.)

Rows of equal lift are a dwell; between dwells the lift rises and returns and changes direction
where the curve does.

Source: C. de Boor, A Practical Guide to Splines, chapter XIV (the smoothing spline).
"""

from __future__ import annotations

import math
from itertools import groupby
from typing import Final

import numpy as np

from gearcam.laws.displacement import Deviation
from gearcam.laws.entry import TYPED
from gearcam.laws.motion.pieces import from_both_ends, spline
from gearcam.laws.phases_of_lift import TURN, PlacedPhase
from gearcam.laws.program import Program
from gearcam.numeric.arrays import Array
from gearcam.numeric.least_jerk import coefficients, ring_slopes, smoothed_ring
from gearcam.numeric.piecewise import Piecewise, extremes, piecewise

_NEAR: Final = 0.01
"""Relative accuracy of the cutoff."""

_PER_WAVE: Final = 6
"""Rows of a smoothed lift that are kept for each wave at the cutoff: the error of the curve through
them is below a hundredth of the tolerance and included in the estimates."""

_KINDS: Final = {1: "rise", -1: "return", 0: "dwell"}

_DWELL: Final = 2
"""Fewest steps without a change that are a dwell; one step is an extreme between two rows."""

_SAME: Final = 1e-9
"""Distance, rad, below which an extreme is at a row: extremes are known to half the digits."""

_ORDER: Final = 6
"""Order of convergence of a smooth lift with the step."""

_SHARES: Final = np.array([0.0, 0.25, 0.5, 0.75])
"""Places in a step at which derivatives are compared."""

_BESIDE: Final = np.array([2.0, 4.0, 4.0, 4.0])
"""Safety factor: errors are measured midway between rows and may be twice as large near a row where
a derivative jumps; derivatives are compared with a curve that has errors too."""


def program_of_rows(theta: Array, lift: Array, tolerance: float, spread: float) -> Program:
    """Return the program of rows of angle and lift.

    Parameters
    ----------
    theta : (n,) array, rad
        Rising, within a turn.
    lift : (n,) array, mm or rad
        Lifts there.
    tolerance : float, mm or rad
        Largest distance from a row; 0 for a curve through the rows.
    spread : float, mm or rad
        Half the difference of first and last row, whose mean is the lift at the start.

    Returns
    -------
    Program
        Knots are the ends of the turn and the rows; of a smoothed lift only as many rows as needed.
    """
    values, cutoff, deviation, step = lift, 0.5 * len(theta), None, 1
    if tolerance:
        apart = np.append(spread, np.zeros(len(theta) - 1))
        values, cutoff = _smoothed(theta, lift, apart, tolerance)
        step = _step(theta, cutoff)
        off = values - lift
        far = int(np.argmax(np.abs(off) + apart))
        value = math.copysign(abs(off[far]) + apart[far], off[far])
        deviation = Deviation(theta=float(theta[far]), value=value)
    curve = _curve(theta[::step], values[::step])
    level = max(tolerance, TYPED * float(np.ptp(lift)))
    errors, fall = _errors(theta[::step], values[::step])
    return Program(
        lift=curve,
        stretches=stretches_of(curve, theta, values, level, cutoff),
        cuts=curve.knots,
        errors=errors,
        fall=fall,
        deviation=deviation,
        given=np.column_stack([theta, lift]) if tolerance else None,
    )


def _smoothed(theta: Array, lift: Array, apart: Array, tolerance: float) -> tuple[Array, float]:
    """Return the smoothest lifts within a tolerance, and their cutoff, 1/rad."""
    low, high = 1.0, 2.0 * len(theta)  # one wave per turn; a quarter of a step
    found, cutoff = lift, high
    while high > low * (1.0 + _NEAR):
        middle = math.sqrt(low * high)
        values, step = smoothed_ring(theta, lift, TURN, middle), _step(theta, middle)
        if step > 1:
            values = _between(theta[::step], values[::step], theta)
        if float((np.abs(values - lift) + apart).max()) <= tolerance:
            found, cutoff, high = values, middle, middle
        else:
            low = middle
    return found, cutoff


def _step(theta: Array, cutoff: float) -> int:
    """Return of how many rows one is enough to tell waves at a cutoff."""
    return max(1, int(len(theta) / (_PER_WAVE * cutoff)))


def _quintics(theta: Array, lift: Array) -> tuple[Array, tuple[Array, Array]]:
    """Return the knots of the closed curve through rows, the last a turn on, and its coefficients.

    These are of the distance from the knots before, and from those behind (see `coefficients`).
    """
    x, y = np.append(theta, theta[0] + TURN), np.append(lift, lift[0])
    slopes = ring_slopes(theta, lift, TURN)
    return x, coefficients(x, y, np.concatenate([slopes, slopes[:1]]), ring=True)


def _between(theta: Array, lift: Array, places: Array, order: int = 0) -> Array:
    """Return the closed curve through rows at places, at most a turn behind the first row.

    With its derivatives up to an order it is an (order + 1, n) array, else (n,).
    """
    x, (left, _) = _quintics(theta, lift)
    index = np.searchsorted(theta, places, side="right") - 1
    distance, powers = (places - x[index])[:, None], left[index]
    found = []
    for _ in range(order + 1):
        count = np.arange(powers.shape[1])
        found.append((powers * distance**count).sum(axis=1))
        powers = (powers * count)[:, 1:]
    return np.array(found) if order else found[0]


def _curve(theta: Array, lift: Array) -> Piecewise:
    """Return the closed curve of quintics through rows, cut at the ends of the turn."""
    x, both = _quintics(theta, lift)
    curve = spline(x, *both)
    if theta[0] == 0.0:
        return curve
    left, right = (side[-1].tolist() for side in both)
    over = from_both_ends(left, right, float(x[-2]) - TURN, float(x[-1]) - TURN)
    return piecewise(np.concatenate([[0.0], theta, [TURN]]), [over, *curve.pieces])


def _errors(theta: Array, lift: Array) -> tuple[tuple[float, ...], float]:
    """Estimate errors of the curve between rows, and of its derivatives, by curves through fewer.

    Curves through every second row miss the rows between by so much, those through every fourth by
    more. By what it falls between these, which the smoothness of the motion decides, it is taken to
    fall again. The worst of all choices of rows counts, as a jump of a derivative may lie anywhere.
    Of derivatives, which rows do not tell, the curve through all of them takes their place: what
    curves through fewer miss of it is seen between the rows as well.

    Returns the errors, and by what that of the lift falls from rows twice as far apart.
    """
    two, four = (
        np.max([_missed(theta, lift, step, first) for first in range(step)], axis=0)
        for step in (2, 4)
    )
    narrowest = float(np.diff(theta, append=theta[0] + TURN).min())
    rounding = 4.0 * np.finfo(float).eps * float(np.abs(lift).max()) / narrowest ** np.arange(4)
    falls = np.clip(four / np.maximum(two, rounding), 1.0, 2.0 ** (_ORDER - np.arange(4)))
    return tuple((_BESIDE * two / falls + rounding).tolist()), float(falls[0])


def _missed(theta: Array, lift: Array, step: int, first: int) -> Array:
    """Return by how much a curve through every `step`-th row misses lift and derivatives.

    The lift in the middle rows between, derivatives of the curve through all rows everywhere.
    """
    own, values = np.roll(theta, -first), np.roll(lift, -first)
    own = own[0] + (own - own[0]) % TURN
    middle = slice(step // 2, None, step)
    lifts = _between(own[::step], values[::step], own[middle]) - values[middle]
    widths = np.diff(own, append=own[0] + TURN)
    places = (own[:, None] + widths[:, None] * _SHARES).ravel()
    fewer, all_rows = (_between(own[::k], values[::k], places, 3) for k in (step, 1))
    missed = np.abs(fewer - all_rows).max(axis=1)
    missed[0] = np.abs(lifts).max()
    return missed


def stretches_of(
    lift: Piecewise, theta: Array, values: Array, level: float, cutoff: float
) -> tuple[PlacedPhase, ...]:
    """Return rises, returns and dwells; one that goes on over the end of the turn is cut there.

    Parameters
    ----------
    lift : Piecewise
        The curve.
    theta, values : (n,) arrays
        Places of it, rad, and lifts there.
    level : float, mm or rad
        What a lift may change by in a dwell.
    cutoff : float, 1/rad
        Wave number above which the curve has none.

    Returns
    -------
    tuple of PlacedPhase
    """
    runs = _runs(theta, values, level, cutoff)
    turns = [
        _turning(lift, theta, (first, row), sign) if sign * before else float(theta[row])
        for (before, first), (sign, row) in zip([runs[-1], *runs], runs, strict=False)
    ]
    kinds, first = [_KINDS[sign] for sign, _ in runs], int(np.argmin(turns))
    kinds, turns = kinds[first:] + kinds[:first], turns[first:] + turns[:first]
    bounds = zip([kinds[-1], *kinds], [0.0, *turns], [*turns, TURN], strict=True)
    return tuple(
        PlacedPhase(kind=kind, start=start, end=end) for kind, start, end in bounds if end > start
    )


def _runs(theta: Array, values: Array, level: float, cutoff: float) -> list[tuple[int, int]]:
    """Return what the lift does, 1, -1 or 0, and from which row on, in a ring.

    It stands still where it changes by less than the level in a phase of 1 of waves at the cutoff,
    over half such a wave and two steps at least, and by no more than twice the level in all.
    """
    steps, widths = np.diff(values, append=values[0]), np.diff(theta, append=theta[0] + TURN)
    still = np.abs(steps) <= level * np.minimum(cutoff * widths, 1.0)
    signs = np.where(still & (not still.all()), 0.0, np.sign(steps)).astype(int)
    begin = int(np.flatnonzero(signs * (signs - np.roll(signs, 1)))[0])
    runs: list[tuple[int, int]] = []
    for sign, group in groupby(np.roll(np.arange(len(steps)), -begin), key=signs.__getitem__):
        own = np.array(list(group))
        change = np.cumsum(steps[own])
        short = len(own) < _DWELL or widths[own].sum() < math.pi / cutoff
        if sign == 0 and short:
            continue  # it turns, or goes on
        if sign == 0 and np.abs(change).max() > 2.0 * level:
            sign = int(np.sign(change[-1]))
        if not runs or runs[-1][0] != sign:
            runs.append((int(sign), int(own[0])))
    if runs[0][0] == runs[-1][0]:
        return runs[1:]
    return runs


def _turning(lift: Piecewise, theta: Array, rows: tuple[int, int], sign: int) -> float:
    """Return where a lift is extreme, rad, that comes from one row and goes from another."""
    first, last = rows
    row = theta[np.arange(first - 1, last + 2 + len(theta) * (last < first)) % len(theta)]
    near = np.unwrap(row, period=TURN)

    def function(x: Array) -> list[Array]:
        return lift.derivatives(x % TURN, 1)

    places, found = extremes(function, near)
    place = float(places[np.argmin(sign * found)])
    nearest = float(near[np.abs(near - place).argmin()])
    return (nearest if abs(nearest - place) < _SAME else place) % TURN
