"""Ranges of the driver: the longest in which an output stays, and the last bit of its travel.

Both begin and end where the output has a certain value, in a monotonic stretch that is known.

The longest range in which the output stays within an amount is one of two sorts. Either an extreme
inside it is the least or the largest value of the range: then the range ends where the output has
left that extreme by the amount, or comes back to it. Or the output passes through, in on one side
and out on the other: then its slope is the same at both ends, or the range could be moved to become
longer. All ranges of both sorts are computed, and the longest is taken.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from gearcam.linkages.measures import TrackMeasures
from gearcam.numeric.arrays import Array, Ints, opposite
from gearcam.numeric.roots import bracketed_root

WHOLE: Final = 1.0 + 1e-9
"""Factor on a travel up to which a longer one is the same: as it is printed."""

_TOUCHING: Final = 1e-9
"""Share of the amount by which an extreme may exceed it: rounding of equal extremes."""

_ROUNDING: Final = 1e-12
"""Share of a turn by which a range that begins with it may begin before it."""

_DIGITS: Final = 9
"""Digits, of rad, in which the beginnings of two ranges that are one agree."""

_PLACES: Final = 33
"""Values at which the slopes at both ends of a passage are compared."""

_ACCURATE: Final = 1e-14
"""Accuracy of the value at which slopes are equal, as a share of the stretch's values."""


class DriverRange(NamedTuple):
    """A range of the driver.

    Attributes
    ----------
    begin, end : float, rad
        The driver's angles. A range begins within the turn; one over its end ends above it.
    """

    begin: float
    end: float

    @property
    def length(self) -> float:
        """The driver's angle from begin to end, rad."""
        return self.end - self.begin


class _Passage(NamedTuple):
    """Two stretches with values between which an output passes through a band.

    Attributes
    ----------
    first, last : int
        Numbers of the nodes at which the stretches begin.
    low, high : float
        Values in the first stretch.
    way : float
        The signed amount between both ends.
    """

    first: int
    last: int
    low: float
    high: float
    way: float


class ShortRangeError(ValueError):
    """The driver's range begins within the last bit of travel that is asked for.

    Parameters
    ----------
    asked, travel : float, mm or rad
        The travel that is asked for, and what the range holds before the dead centre.
    """

    def __init__(self, asked: float, travel: float) -> None:
        self.travel = travel
        super().__init__(f"travel {asked:g}: the range has {travel:g} of it before the dead centre")


def longest_dwell(measures: TrackMeasures, amount: float) -> DriverRange:
    """Return the longest range of the driver in which an output stays within an amount.

    Parameters
    ----------
    measures : TrackMeasures
        Of the output.
    amount : float, mm or rad
        The largest less the smallest value in the range, above 0.

    Returns
    -------
    DriverRange
        Over the end of a turn too if the motion repeats; the whole turn if the output stays.

    Raises
    ------
    ValueError
        If the amount is not above 0.
    """
    if not amount > 0.0:
        raise ValueError(f"amount {amount:g}: must be above 0")
    low, high = measures.span
    if measures.stroke <= amount:
        return DriverRange(low, high)
    values = measures.nodes[1]
    ends: list[tuple[float, float]] = []
    for node in _own(measures):
        for bottom in (values[node], values[node] - amount):
            band = bottom, bottom + amount
            ends.append((_leaves(measures, node, -1, band), _leaves(measures, node, 1, band)))
    ends += _passages(measures, amount)
    return _in_turn(measures, *max(ends, key=lambda one: one[1] - one[0]))


def last_travels(
    measures: TrackMeasures, travel: float, *, outer: bool = True
) -> tuple[DriverRange, ...]:
    """Return the ranges of the driver over the last bit of travel before a dead centre.

    Parameters
    ----------
    measures : TrackMeasures
        Of the output.
    travel : float, mm or rad
        Above 0, up to all of its travel.
    outer : bool
        Before the largest value; otherwise before the smallest one.

    Returns
    -------
    tuple of DriverRange
        One for each time that the output arrives at the dead centre, where the range ends.

    Raises
    ------
    ValueError
        If the travel is not between 0 and all of it.
    ShortRangeError
        If the driver's range begins within each of them.
    """
    if not 0.0 < travel <= measures.stroke * WHOLE:
        raise ValueError(f"travel {travel:g}: must be between 0 and {measures.stroke:g}")
    travel = min(travel, measures.stroke / WHOLE)
    top = measures.largest() if outer else measures.least()
    places, values = measures.nodes
    level = top.value - travel if outer else top.value + travel
    band = (level, np.inf) if outer else (-np.inf, level)
    there = np.abs(values - top.value) <= _TOUCHING * measures.stroke
    nodes, ranges = [node for node in _own(measures) if there[node]], dict[float, DriverRange]()
    for node in nodes:
        begin = _leaves(measures, node, -1, band)
        if begin == places[0] and abs(values[0] - level) > (WHOLE - 1.0) * measures.stroke:
            continue
        one = _in_turn(measures, begin, float(places[node]))
        # where it rests, and at both ends of a turn, it has arrived before
        known = ranges.setdefault(round(one.begin, _DIGITS), one)
        ranges[round(one.begin, _DIGITS)] = min(known, one, key=lambda two: two.end)
    if not ranges:
        raise ShortRangeError(travel, float(np.abs(values[: nodes[-1] + 1] - top.value).max()))
    return tuple(ranges.values())


def _in_turn(measures: TrackMeasures, begin: float, end: float) -> DriverRange:
    """Return a range that begins within the turn, but for rounding, if the motion repeats."""
    low, high = measures.span
    turns = np.floor((begin - low) / (high - low) + _ROUNDING) if measures.closed else 0.0
    begin, end = (float(one - turns * (high - low)) for one in (begin, end))
    return DriverRange(begin, end)


def _own(measures: TrackMeasures) -> range:
    """Return the numbers of the nodes of the turn itself."""
    count = len(measures.extremes[0][0])
    return range(count, 2 * count) if measures.closed else range(count)


def _leaves(measures: TrackMeasures, node: int, step: int, band: tuple[float, float]) -> float:
    """Return where an output leaves a band, from a node in it in one direction."""
    places, values = measures.nodes
    low, high = band
    loose = _TOUCHING * (high - low) if np.isfinite(high - low) else 0.0
    while 0 <= node + step < len(places):
        value = values[node + step]
        if not low - loose <= value <= high + loose:
            level = high if value > high else low
            return _crossing(measures, node, node + step, level)
        node += step
    return float(places[node])


def _crossing(measures: TrackMeasures, inside: int, outside: int, level: float) -> float:
    places, values = measures.nodes
    if (values[inside] - level) * (values[outside] - level) >= 0.0:  # it leaves at once
        return float(places[inside])
    ends = places[[inside]], places[[outside]]
    known = values[[inside]], values[[outside]]
    return float(measures.root_of(np.array([level]), ends, known)[0])


def _passages(measures: TrackMeasures, amount: float) -> list[tuple[float, float]]:
    """Return the ranges at both ends of which an output has the same slope."""
    pairs = list(_pairs(measures, amount))
    if not pairs:
        return []
    places = measures.nodes[0]
    first, last = (np.array([getattr(one, name) for one in pairs]) for name in ("first", "last"))
    low, high, way = (np.array([one[k] for one in pairs]) for k in (2, 3, 4))

    def at(value: Array, own: Ints) -> tuple[Array, Array]:
        begins = measures.root_of(value, (places[first[own]], places[first[own] + 1]))
        ends = measures.root_of(value + way[own], (places[last[own]], places[last[own] + 1]))
        return begins, ends

    def unequal(value: Array, own: Ints) -> Array:
        slopes = [measures.at(q, 1).derivatives()[1] for q in at(value, own)]
        return slopes[1] - slopes[0]

    share = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, _PLACES + 2)[1:-1])
    tried = low[:, None] + (high - low)[:, None] * share
    every = np.repeat(np.arange(len(pairs)), _PLACES)
    apart = unequal(tried.ravel(), every).reshape(tried.shape)
    # a symmetric motion has its root at one of the values
    apart[apart == 0.0] = np.finfo(float).tiny
    own, cell = np.nonzero(opposite(apart[:, :-1], apart[:, 1:]))
    if not own.size:
        return []
    known = apart[own, cell], apart[own, cell + 1]
    found = bracketed_root(
        lambda value: unequal(value, own),
        tried[own, cell],
        tried[own, cell + 1],
        _ACCURATE * float((high - low)[own].min()),
        known,
    )
    return list(zip(*(one.tolist() for one in at(found, own)), strict=True))


def _pairs(measures: TrackMeasures, amount: float) -> Iterator[_Passage]:
    """Yield pairs of stretches between which an output may pass through a band of an amount."""
    values = measures.nodes[1]
    for first in _own(measures)[:-1]:
        rises = float(np.sign(values[first + 1] - values[first]))
        inner: list[float] = []
        for last in range(first, len(values) - 1):
            if last > first:
                inner.append(float(values[last]))
            if inner and max(inner) - min(inner) > amount:
                break
            if rises and np.sign(values[last + 1] - values[last]) == rises:
                way = rises * amount
                low, high = _common(values, first, last, way, inner)
                if low < high:
                    yield _Passage(first, last, low, high, way)


def _common(
    values: Array, first: int, last: int, way: float, inner: list[float]
) -> tuple[float, float]:
    """Return values at the begin of a range that have one at its end, with all inside between."""
    one = np.sort(values[first : first + 2])
    two = np.sort(values[last : last + 2]) - way
    low, high = max(one[0], two[0]), min(one[1], two[1])
    if inner:
        bottom, top = (max(inner) - way, min(inner)) if way > 0 else (max(inner), min(inner) - way)
        low, high = max(low, bottom), min(high, top)
    return float(low), float(high)
