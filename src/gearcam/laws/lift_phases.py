"""Rises, returns and dwells in the rows of a lift: where they are, roughly.

The *noise* is read from the sixth divided differences of the rows, in which a smooth lift vanishes;
of their sizes the smaller three quarters count, as corners make large ones. The lift *stands still*
where its slope, a line through as few rows as tell a twentieth of the mean slope from noise, is
within four standard deviations of zero. Between such stretches, and where the slope changes its
sign, lie rises and returns. `gearcam.laws.lift_model` refines the boundaries.

Source: derived anew.
"""

from __future__ import annotations

import math
from itertools import groupby
from typing import Final

import numpy as np

from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import formatted
from gearcam.laws.lift_model import LiftModel, LiftRows, place_of
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.laws.phases_of_lift import TURN
from gearcam.numeric.arrays import Array, Ints

FEWEST: Final = 36
"""Fewest rows of a turn."""

FEWEST_OF_MOVE: Final = 3
"""Fewest rows on a rise or return, without its flat ends: the law and its boundaries need them."""

_FLAT: Final = 0.02
"""Share of a move that belongs to its flat ends."""

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

_LOUD: Final = 25.0
"""Total lift over the noise below which no law could be found."""


_DIGITS: Final = 8
"""Digits after the point to which values may be rounded."""

_WHOLE: Final = 1e-12
"""Distance from whole numbers, over the largest value, that is none."""


def noise_of(theta: Array, lift: Array, scale: float = 1.0) -> float:
    """Return the standard deviation of the noise of a closed lift in rows.

    That of their scatter, or of the rounding of their digits, which a dwell does not show.

    Parameters
    ----------
    theta : (n,) array, rad
        Rising, within a turn.
    lift : (n,) array, mm or rad
        Lifts.
    scale : float
        Factor to the unit in which they were written.

    Returns
    -------
    float, mm or rad
        At least rounding.
    """
    index, turns = _windows(len(theta), _ORDER + 1)
    places, values = theta[index] + turns * TURN, lift[index]
    apart = places[:, :, None] - places[:, None, :] + np.eye(_ORDER + 1)
    weights = 1.0 / (apart / apart.max()).prod(axis=2)
    weights /= np.linalg.norm(weights, axis=1, keepdims=True)
    sizes = np.sort(np.abs((weights * values).sum(axis=1)))
    smaller = sizes[: max(1, int(_SMALLER * len(sizes)))]
    return max(
        float(np.sqrt((smaller**2).mean())) / _TRIMMED,
        _FLOOR * float(np.ptp(lift)),
        step_of(scale * lift) / scale / math.sqrt(12.0),
    )


def step_of(values: Array) -> float:
    """Return the power of ten of which all values (n,) are multiples; 0 if there is none."""
    for digits in range(_DIGITS + 1):
        whole = values * 10.0**digits
        if np.abs(whole - np.round(whole)).max() < _WHOLE * max(1.0, float(np.abs(whole).max())):
            return 10.0**-digits
    return 0.0


def _windows(count: int, width: int) -> tuple[Ints, Ints]:
    """Return the numbers of rows around each row, and the turns by which they are away."""
    index = np.arange(count)[:, None] + np.arange(width) - width // 2
    return index % count, index // count


def first_model(rows: LiftRows, unit: tuple[float, str]) -> LiftModel:
    """Return a model of the moves that rows show, all with the law 3-4-5.

    Parameters
    ----------
    rows : LiftRows
        The rows.
    unit : (float, str)
        Factor from lifts to their unit in output, and that unit, for messages.

    Returns
    -------
    LiftModel

    Raises
    ------
    InfeasibleError
        If there are too few rows, the lift is lost in noise, or a move takes too few rows.
    """
    if len(rows.theta) < FEWEST:
        raise beyond_limit("the lift has too few rows", "", len(rows.theta), FEWEST, unit="rows")
    scale, name = unit
    extent = float(np.ptp(rows.lift))
    if extent < _LOUD * rows.noise:
        what = f"the lift is lost in its noise, {formatted(scale * rows.noise, 3)} {name}"
        rule = f"a total lift of at least {_LOUD:g} times the noise; measure again, or average"
        raise beyond_limit(what, "", scale * extent, scale * _LOUD * rows.noise, rule, unit=name)
    runs = _runs(rows)
    moves = [number for number, (sign, _) in enumerate(runs) if sign]
    starts, ends, levels, tied = [], [], [], []
    for number in moves:
        low, high = (_bound(rows, runs, number, end) for end in (0, 1))
        levels.append(low[1])
        start, end = _stretch(rows, runs[number][1], low, high)
        starts.append(start)
        ends.append(end)
        tied.append(runs[(number + 1) % len(runs)][0] != 0)
    return _ring(np.array(starts), np.array(ends), np.array(levels), tuple(tied))


def _ring(starts: Array, ends: Array, levels: Array, tied: tuple[bool, ...]) -> LiftModel:
    """Return a model; angles are made to rise, and boundaries without a dwell one."""
    count = len(starts)
    for k in range(1, count):
        starts[k] += TURN * math.ceil((starts[k - 1] - starts[k]) / TURN)
    ends = starts + (ends - starts) % TURN
    following = np.append(starts[1:], starts[0] + TURN)
    middle = 0.5 * (ends + following)
    over = np.array(tied) | (ends > following)
    ends = np.where(over, middle, ends)
    starts = starts.copy()
    for k in np.flatnonzero(over).tolist():
        starts[(k + 1) % count] = middle[k] - (TURN if k == count - 1 else 0.0)
    law = MOTION_LAWS["3-4-5"].example
    return LiftModel(laws=(law,) * count, starts=starts, ends=ends, levels=levels, tied=tied)


def _slopes(rows: LiftRows) -> tuple[Array, Array]:
    """Return the slopes at rows, and from which size on they are no noise."""
    mean, count = 2.0 * float(np.ptp(rows.lift)) / TURN, len(rows.theta)
    slope, width = np.zeros(count), 5
    least = np.full(count, math.inf)
    while True:
        index, turns = _windows(count, width)
        places, values = rows.theta[index] + turns * TURN, rows.lift[index]
        places = places - places.mean(axis=1, keepdims=True)
        square = (places**2).sum(axis=1)
        slope = (places * values).sum(axis=1) / square
        least = _SURE * rows.noise / np.sqrt(square)
        if float(np.median(least)) <= _CREEP * mean or width + 2 > count // 12:
            return slope, np.maximum(least, _STILL * mean)
        width += 2


def _runs(rows: LiftRows) -> list[tuple[int, Ints]]:
    """Return what the lift does, 1, -1 or 0, and the rows of it, in a ring."""
    slope, least = _slopes(rows)
    signs = np.where(np.abs(slope) <= least, 0, np.sign(slope)).astype(int)
    for sign, run in _groups(signs):
        if sign and _blip(run, rows):
            signs[run] = 0
    for sign, run in _groups(signs):
        before, after = signs[run[0] - 1], signs[(run[-1] + 1) % len(signs)]
        if not sign and len(run) < 3 and before != after:  # it turns
            signs[run] = before
    return [part for sign, run in _groups(signs) for part in _cut(sign, run, slope, least)]


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


def _blip(run: Ints, rows: LiftRows) -> bool:
    """Whether a move is noise."""
    change = abs(float(rows.lift[run[-1]] - rows.lift[run[0]]))
    return change < 2.0 * _SURE * rows.noise


def _groups(signs: Ints) -> list[tuple[int, Ints]]:
    """Return the runs of equal signs in a ring."""
    begin = int(np.argmax(signs != np.roll(signs, 1)))
    order = np.roll(np.arange(len(signs)), -begin)
    return [
        (int(sign), np.array(list(group)))
        for sign, group in groupby(order.tolist(), key=signs.__getitem__)
    ]


def _bound(
    rows: LiftRows, runs: list[tuple[int, Ints]], number: int, end: int
) -> tuple[float, float]:
    """Return how far a move may go, rad, and its level there: at its start, 0, or end, 1."""
    sign, run = runs[(number + (1 if end else -1)) % len(runs)]
    if sign == 0:
        far = int(run[len(run) // 4 if end else -1 - len(run) // 4])  # half a dwell is left
        return float(rows.theta[far]), float(np.mean(rows.lift[run]))
    row = int(runs[number][1][-1 if end else 0])
    return float(rows.theta[row]), float(rows.lift[row])


def _stretch(
    rows: LiftRows, run: Ints, low: tuple[float, float], high: tuple[float, float]
) -> tuple[float, float]:
    """Return start and end of a move, rad, of which rows cross a fifth and four fifths.

    Refused are moves of too few rows.
    """
    done = (rows.lift[run] - low[1]) / (high[1] - low[1])
    inside = int(((done > _FLAT) & (done < 1.0 - _FLAT)).sum())
    if inside < FEWEST_OF_MOVE:
        word = "rise" if high[1] > low[1] else "return"
        where = " to ".join(f"{math.degrees(float(rows.theta[one])):.6g}" for one in run[[0, -1]])
        note = f"at {where} deg; measure at smaller steps there; a jump has no law"
        what, least = f"a {word} takes too few rows", FEWEST_OF_MOVE
        raise beyond_limit(what, "", inside, least, note, unit="rows")
    theta = np.unwrap(rows.theta[run], period=TURN)
    first = theta[0] - (theta[0] - low[0]) % TURN
    last = theta[-1] + (high[0] - theta[-1]) % TURN
    places = np.interp([0.2, 0.8], np.maximum.accumulate(done), theta)
    law, falling = MOTION_LAWS["3-4-5"].example, bool(high[1] < low[1])
    shares = [place_of(law, part, falling=falling) for part in (0.2, 0.8)]
    width = (places[1] - places[0]) / (shares[1] - shares[0])
    start = float(places[0] - width * shares[0])
    return max(start, float(first)), min(start + float(width), float(last))
