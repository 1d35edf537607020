"""Measures of one quantity over the driver: extremes of all orders, dead centres, stroke, ratio.

All are roots of derivatives, polished to rounding, and one-sided values at knots. The quantity is a
function of the driver's angle, as `Linkage.real_track` gives it: an angle of a
member without jumps by whole turns.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.elements import Law
from gearcam.linkages.linkage import in_cycle
from gearcam.numeric.arrays import Array, Ints, distinct, opposite, snapped
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import extremes_of_each
from gearcam.numeric.roots import bracketed_root

HIGHEST: Final = 3
"""Highest derivative of which extremes are wanted: the jerk over the driver's angle."""

STILL: Final = 1e-9
"""Difference of two values, mm or rad, that counts as none: what rounding makes of a rest."""

_EQUAL: Final = 1e-14
"""Difference of values, as a share of the largest, below which they are equally large."""

_NEAR: Final = 1e-11
"""Distance from a knot, as a share of the interval, at which a place is the knot."""

_ROUGH: Final = 4e-8
"""Distance within which extremes are found at first, as a share of the smallest interval."""

_FOUND: Final = 1e-15
"""Accuracy of a place, as a share of the whole range."""

_SHORT: Final = 1e-6
"""A rest shorter than this, rad, is a place."""

Extremes = tuple[Array, Array]
"""Places and values of candidates for the largest and the smallest value, by rising place."""


class Peak(NamedTuple):
    """A smallest or a largest value, and where it is.

    Attributes
    ----------
    value : float
        In the unit of the quantity, per rad for each derivative.
    place : float, rad
        The driver's angle: the first, where several have it.
    """

    value: float
    place: float


def least_and_largest(extremes: Extremes) -> tuple[Peak, Peak]:
    """Return the smallest and the largest of `extremes`."""
    places, values = extremes
    low, high = (
        Peak(float(values[k]), float(places[k])) for k in (values.argmin(), values.argmax())
    )
    return low, high


class DeadCenter(NamedTuple):
    """Where a motion reverses.

    Attributes
    ----------
    value : float
        Of the quantity, mm or rad.
    place : float, rad
        The driver's angle at which the motion ends; below the range's begin if it rests over the
        end of a turn.
    until : float, rad
        Where it sets in again: the same place if there is no rest.
    outer : bool
        Whether the value is larger than those on both sides.
    """

    value: float
    place: float
    until: float
    outer: bool


class TimeRatio(NamedTuple):
    """How long an even driver moves its output one way and back, rests at the ends not counted.

    Attributes
    ----------
    forward, back : float, rad
        The driver's angle from the smallest to the largest value, and back.
    """

    forward: float
    back: float

    @property
    def ratio(self) -> float:
        """The forward over the return angle."""
        return self.forward / self.back

    @property
    def least(self) -> float:
        """The shorter over the longer angle, ``(pi - theta)/(pi + theta) <= 1`` (000, 2.148)."""
        return min(self) / max(self)


def extremes_of(track: Law, knots: Array, highest: int = HIGHEST) -> tuple[Extremes, ...]:
    """Return all extremes of a quantity and of its derivatives.

    Parameters
    ----------
    track : callable
        ``track(q, order) -> Jet``, real.
    knots : (k,) array, rad
        Between them it is smooth.
    highest : int
        Highest derivative of which extremes are wanted: the track is asked for one more.

    Returns
    -------
    tuple of (places, values)
        For each order roots of the next derivative, and both sides of each knot.
    """
    return extremes_of_several(lambda q, order: [track(q, order)], knots, highest)[0]


def extremes_of_several(
    tracks: Callable[[Array, int], Sequence[Jet]], knots: Array, highest: int = HIGHEST
) -> list[tuple[Extremes, ...]]:
    """Return the extremes of several quantities, found at once (see `extremes_of`).

    Parameters
    ----------
    tracks : callable
        ``tracks(q, order)`` returns a Jet for each, real.
    knots, highest
        As of `extremes_of`.

    Returns
    -------
    list of tuple of (places, values)
    """
    grid = np.asarray(knots, dtype=float)

    def derivatives(q: Array) -> Array:
        return np.array([one.derivatives() for one in tracks(q, highest + 1)])

    def both(q: Array) -> Array:
        found = derivatives(q)
        return np.stack([found[:, :-1], found[:, 1:]]).reshape(2, -1, q.size)

    rough = extremes_of_each(both, grid)
    which = np.concatenate([np.full(len(one[0]), k) for k, one in enumerate(rough)])
    places = np.concatenate([one[0] for one in rough])
    values = np.concatenate([one[1] for one in rough])
    cell = np.clip(np.searchsorted(grid, places), 1, len(grid) - 1)
    places = snapped(places, grid, _NEAR * np.diff(grid)[cell - 1])
    free = np.flatnonzero(grid[np.searchsorted(grid[:-1], places)] != places)  # on no knot
    if free.size:
        number, order = np.divmod(which[free], highest + 1)
        places[free], values[free] = _polished(derivatives, grid, (number, order), places[free])
    each = [(places[which == k], values[which == k]) for k in range(len(rough))]
    return [tuple(each[k : k + highest + 1]) for k in range(0, len(each), highest + 1)]


def _polished(
    derivatives: Callable[[Array], Array], grid: Array, which: tuple[Ints, Ints], places: Array
) -> Extremes:
    """Return the extremes of given quantities and orders next to places."""
    number, order = which
    cell = np.clip(np.searchsorted(grid, places), 1, len(grid) - 1)
    reach = _ROUGH * np.diff(grid).min()
    low = np.maximum(places - reach, grid[cell - 1])
    high = np.minimum(places + reach, grid[cell])
    own = np.arange(places.size)

    def at(q: Array) -> tuple[Array, Array]:
        found = derivatives(q)
        return found[number, order, own], found[number, order + 1, own]

    (_, before), (_, after) = at(low), at(high)
    crossed = opposite(before, after)
    # so near to each other they are joined by a straight line: one more step leaves rounding
    with np.errstate(invalid="ignore", divide="ignore"):  # both are one place next to a knot
        slope = np.where(crossed, (after - before) / (high - low), np.inf)
    found = np.where(crossed, low - before / slope, places)
    values, rest = at(found)
    return np.clip(found - rest / slope, low, high), values


@dataclass(frozen=True, eq=False)
class TracksTogether(ShortRepr):
    """Quantities of which the extremes are found at once, when the first ones are asked for.

    Parameters
    ----------
    tracks : callable
        ``tracks(q, order)`` returns a Jet for each.
    knots : (k,) array, rad
        Between them they are smooth.
    highest : int
        Highest derivative of which extremes are wanted.
    """

    tracks: Callable[[Array, int], Sequence[Jet]]
    knots: Array
    highest: int

    @cached_property
    def extremes(self) -> list[tuple[Extremes, ...]]:
        """Extremes of each (see `extremes_of_several`)."""
        return extremes_of_several(self.tracks, self.knots, self.highest)


@dataclass(frozen=True, eq=False)
class TrackMeasures(ShortRepr):
    """What is to be said about one quantity over the driver.

    Parameters
    ----------
    track : callable
        ``track(q, order) -> Jet``: its value, mm or rad, and derivatives by the driver's angle.
    knots : (k,) array, rad
        The driver's angles from the first to the last one; between them it is smooth.
    closed : bool
        Whether the motion repeats after the last knot; the value may have risen by then.
    highest : int
        Highest derivative of which extremes are wanted.
    among : (TracksTogether, int), optional
        Others of which the extremes are found with its own, and its place among them.
    """

    track: Law
    knots: Array
    closed: bool = True
    highest: int = HIGHEST
    among: tuple[TracksTogether, int] | None = None

    @property
    def span(self) -> tuple[float, float]:
        """First and last angle of the driver, rad."""
        return float(self.knots[0]), float(self.knots[-1])

    @cached_property
    def extremes(self) -> tuple[Extremes, ...]:
        """Extremes of each order (see `extremes_of`); of what stands still 0 from order 1 on."""
        if self.among is None:
            first, *others = extremes_of(self.track, self.knots, self.highest)
        else:
            together, number = self.among
            first, *others = together.extremes[number]
        if np.ptp(first[1]) > STILL:
            return (first, *others)
        return (first, *((places, np.zeros_like(values)) for places, values in others))

    def least(self, order: int = 0) -> Peak:
        """Return the smallest value of a derivative of given `order`."""
        top = self._top(order, -1.0)
        return Peak(-top.value, top.place)

    def largest(self, order: int = 0) -> Peak:
        """Return the largest value of a derivative of given `order`."""
        return self._top(order, 1.0)

    def size(self, order: int = 0) -> Peak:
        """Return the value of a derivative of given `order` that is furthest from 0."""
        return max(self.largest(order), self.least(order), key=lambda peak: abs(peak.value))

    def _top(self, order: int, side: float) -> Peak:
        places, values = self.extremes[order]
        top = float((side * values).max())
        first = int((side * values >= top - _EQUAL * np.abs(values).max()).argmax())
        place = float(places[first])
        low, high = self.span
        return Peak(top, low if self.closed and place == high else place)

    @cached_property
    def stroke(self) -> float:
        """The largest less the smallest value, mm or rad."""
        return 0.0 if self.still else self.largest().value - self.least().value

    @cached_property
    def still(self) -> bool:
        """Whether it does not move, but for rounding."""
        return bool(np.ptp(self.extremes[0][1]) <= STILL)

    @cached_property
    def rise(self) -> float:
        """What a turn of the driver adds to the value; 0 for an output that goes back and forth."""
        values = self.extremes[0][1]
        rise = float(values[-1] - values[0]) if self.closed else 0.0
        return rise if abs(rise) > STILL else 0.0

    def at(self, q: Array, order: int) -> Jet:
        """Return the quantity at any angle of the driver, past the end of a turn too.

        Parameters
        ----------
        q : (n,) array, rad
            Within the range if the motion does not repeat.
        order : int
            Highest derivative.

        Returns
        -------
        Jet
        """
        if not self.closed:
            return self.track(q, order)
        turns, within = in_cycle(q, self.span)
        found = self.track(within, order)
        return Jet([found.c[0] + turns * self.rise, *found.c[1:]])

    @cached_property
    def nodes(self) -> Extremes:
        """Places between which the value is monotonic, in order, and values there.

        Over the turn before, the turn itself and the turn after where the motion repeats.
        """
        places, values = self.extremes[0]
        if not self.closed:
            return places, values
        turn, rise = self.span[1] - self.span[0], self.rise
        return (
            np.concatenate([places + k * turn for k in (-1, 0, 1)]),
            np.concatenate([values + k * rise for k in (-1, 0, 1)]),
        )

    def places_of(self, value: float) -> Array:
        """Return the driver's angles at which the quantity has a value.

        Parameters
        ----------
        value : float, mm or rad
            Wanted.

        Returns
        -------
        (n,) array, rad
            Rising; none if the value is not reached.
        """
        places, values = self.extremes[0]
        off = values - value
        cells = np.flatnonzero(opposite(off[:-1], off[1:]))
        roots = self.root_of(
            np.full(cells.size, value),
            (places[cells], places[cells + 1]),
            (values[cells], values[cells + 1]),
        )
        return distinct(places[off == 0.0], roots)

    def root_of(
        self,
        value: Array,
        between: tuple[Array, Array],
        ends: tuple[Array, Array] | None = None,
    ) -> Array:
        """Return where the quantity has values, each in its own monotonic stretch.

        Parameters
        ----------
        value : (n,) array, mm or rad
            Wanted.
        between : two (n,) arrays, rad
            The ends of the stretches, with values on both sides of those wanted.
        ends : two (n,) arrays, mm or rad, optional
            The values there: computed again they may be on the other side by rounding.

        Returns
        -------
        (n,) array, rad
        """
        low, high = self.span
        tolerance = _FOUND * (high - low)
        off = None if ends is None else (ends[0] - value, ends[1] - value)
        return bracketed_root(
            lambda q: np.asarray(self.at(q, 0).c[0]) - value, *between, tolerance, off
        )

    @cached_property
    def dead_centers(self) -> tuple[DeadCenter, ...]:
        """Where the motion reverses, and ends of an open range where it stands still, in order."""
        rests = _rests(*self.nodes)
        low, high = self.span
        near = _NEAR * (high - low)
        centers = []
        for before, own, after in zip([None, *rests], rests, [*rests[1:], None], strict=False):
            into = own.value - before.value if before else self._resting(0, after, own)
            out = after.value - own.value if after else self._resting(-1, own, before)
            if into * out < 0.0 and low - near <= own.end < high + near * (
                -1 if self.closed else 1
            ):
                place = low if abs(own.begin - low) <= near else own.begin
                centers.append(DeadCenter(own.value, place, max(own.end, place), into > 0.0))
        return tuple(centers)

    def _resting(self, end: int, later: _Rest | None, earlier: _Rest | None) -> float:
        """Return how an open range would go on beyond an end: back, if it stands still there."""
        if self.closed or later is None or earlier is None:
            return 0.0
        slope = self.track(np.array([self.span[end]]), 1).derivatives()[1]
        if abs(float(slope[0])) > STILL:
            return 0.0
        return earlier.value - later.value

    @cached_property
    def time_ratio(self) -> TimeRatio | None:
        """How long it moves one way and back; none unless it reverses twice in a turn."""
        if not self.closed or len(self.dead_centers) != 2:
            return None
        inner, outer = sorted(self.dead_centers, key=lambda one: one.outer)
        turn = self.span[1] - self.span[0]
        return TimeRatio((outer.place - inner.until) % turn, (inner.place - outer.until) % turn)


class _Rest(NamedTuple):
    """A place or a stretch of equal values: value, begin and end of the stretch."""

    value: float
    begin: float
    end: float


def _rests(places: Array, values: Array) -> list[_Rest]:
    """Return extremes with those joined that differ by rounding only."""
    groups = np.split(np.arange(places.size), np.flatnonzero(_apart(values)) + 1)
    grain = _EQUAL * float(np.abs(values).max())
    rests = []
    for number, own in enumerate(groups):
        beside = groups[number - 1 if number else min(1, len(groups) - 1)]
        side = 1.0 if values[own].mean() >= values[beside].mean() else -1.0
        top = float((side * values[own]).max())
        equal = places[own[side * values[own] >= top - grain]]
        begin, end = float(equal[0]), float(equal[-1])
        if end - begin < _SHORT:  # a knot just beside an extreme
            begin = end = float(places[own[(side * values[own]).argmax()]])
        rests.append(_Rest(side * top, begin, end))
    return rests


def _apart(values: Array) -> Array:
    """Return whether each value differs from the first of those before that are equal to it."""
    apart, first = np.zeros(values.size - 1, dtype=bool), values[0]
    for number, value in enumerate(values[1:]):
        if abs(value - first) > STILL:
            apart[number], first = True, value
    return apart
