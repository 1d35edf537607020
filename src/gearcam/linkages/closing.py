"""Where a linkage closes: the range of the driver, change points, and the nearest lengths.

What a dyad needs to close is a smooth function of the driver's angle between knots. Its extremes
are roots of its slope, its zeros are bracketed by them: nothing depends on a step.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.dyads import number_of, rtr_distance
from gearcam.linkages.elements import BRANCH, REACH, Dyad, Element
from gearcam.linkages.known import Known
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.narrow import NARROWEST, Narrow, narrow_places, with_narrow_places
from gearcam.numeric.arrays import Array, apart, distinct, opposite, snapped
from gearcam.numeric.piecewise import extremes_of_each
from gearcam.numeric.roots import bracketed_root

_FOUND: Final = 1e-14
"""Accuracy of a limit, rad."""

_SAME: Final = 1e-7
"""Change points closer than this are one, rad."""

_NEARLY: Final = 1e-6
"""Share from which no extreme can be one of 0, however its place is rounded."""

_ON_KNOT: Final = 1e-11
"""Distance of a change point from a knot by rounding, rad."""

_SPARE: Final = 1e-3
"""Share by which a length that is offered is off its limit, where the linkage is singular."""

_MEETING: Final = 2
"""Number of what is left of an RRR dyad before its outer joints meet."""

_WIDER: Final = 1.05
"""Factor by which what is left is larger than resolved, where a length is offered."""

_MET: Final = 1e-6
"""Least distance of joints, as a share of their largest one, that rods of two lengths can span."""


@dataclass(frozen=True)
class Closing(ShortRepr):
    """Where one part of a linkage closes.

    Parameters
    ----------
    element : Element
        The part.
    leasts : tuple of float
        The smallest value of each of its shares; negative: it does not close everywhere; 0: it is
        singular there, but for rounding.
    place : float, rad
        The driver's angle of the smallest of them.
    ranges : tuple of (float, float), rad
        The driver's angles over which it closes; a range over the end of a turn begins below 0.
    changes : tuple of float, rad
        Change points.
    narrow : tuple of Narrow
        Where it is nearly singular.
    """

    element: Element
    leasts: tuple[float, ...]
    place: float
    ranges: tuple[tuple[float, float], ...]
    changes: tuple[float, ...]
    narrow: tuple[Narrow, ...]

    @property
    def unresolved(self) -> Narrow | None:
        """Where it moves too fast for double precision, if anywhere."""
        found = [one for one in self.narrow if one.passed and one.width < NARROWEST]
        # folded rods whose ends meet: the latter says it better
        return min(found, key=lambda one: (one.width, -one.number), default=None)

    @property
    def meets(self) -> bool:
        """Whether it is singular, or nearly, because the outer joints of an RRR dyad meet."""
        if self.unresolved:
            return self.unresolved.number == _MEETING
        return self.leasts[_MEETING:] == (0.0,)

    @property
    def least(self) -> float:
        """The smallest share that is left before it opens."""
        return min(self.leasts)


class NotClosingError(ValueError):
    """A linkage does not close over the driver's whole range.

    Parameters
    ----------
    closing : Closing
        Where its first part closes that does not close everywhere.
    nearest : tuple of dict of int to float
        Lengths that would make the part close, by their number, mm; the nearest first.
    resolved : (float, float), mm, or rad for TRT; optional
        Of a dyad that is too nearly singular for double precision: how far from that it is, and
        how far it must be.
    """

    def __init__(
        self,
        closing: Closing,
        nearest: tuple[dict[int, float], ...],
        resolved: tuple[float, float] | None = None,
    ) -> None:
        self.closing, self.nearest, self.resolved = closing, nearest, resolved
        super().__init__(f"{closing.element.gives[0]} does not close over the whole range")


def settled(linkage: Linkage) -> Linkage:
    """Return a linkage with the change points of its dyads, and knots where it moves fast.

    Parameters
    ----------
    linkage : Linkage
        As described.

    Returns
    -------
    Linkage

    Raises
    ------
    NotClosingError
        If a part does not close over the whole range, or is singular where it cannot be passed.
    """
    for number, element in enumerate(linkage.elements):
        outcome = closing(linkage, element)
        if outcome is None:
            continue
        stuck = bool(outcome.changes) and _stuck(outcome)
        if isinstance(element, Dyad) and outcome.least >= 0.0 and outcome.unresolved:
            raise NotClosingError(outcome, (), _resolved(linkage, element, outcome.unresolved))
        if not outcome.least >= 0.0 or stuck:
            nearest = _nearest(element, outcome.leasts) if isinstance(element, Dyad) else []
            raise NotClosingError(outcome, tuple(nearest))
        knots = with_narrow_places(outcome.narrow, linkage.knots, closed=linkage.closed)
        linkage = replace(linkage, knots=knots)
        if outcome.changes and isinstance(element, Dyad):
            linkage = _passing(linkage, number, element, outcome.changes)
    return linkage


def _resolved(linkage: Linkage, dyad: Dyad, narrow: Narrow) -> tuple[float, float]:
    """Return how far from singular a dyad is, and how far it must be to be resolved."""
    solved = dyad.solution(linkage.at(np.array([narrow.place]), 0, dyad))
    left, square = (number_of(one[narrow.number]).item() for one in (solved.left, solved.squares))
    rest, wider = max(square - left, 0.0), _WIDER * (NARROWEST / narrow.width) ** 2
    own, least = (one / (math.sqrt(rest + one) + math.sqrt(rest)) for one in (left, wider * left))
    return own, least


def _stuck(found: Closing) -> bool:
    """Return whether a part jams or loses its place at one of its change points."""
    element = found.element
    if not isinstance(element, Dyad) or not element.kind.passable:
        return True
    # outer joints in one place: its rods, equally long, may have any direction
    return found.meets


def _passing(linkage: Linkage, number: int, dyad: Dyad, changes: tuple[float, ...]) -> Linkage:
    """Return a linkage of which a dyad knows its change points."""
    parts, knots, (low, high) = list(linkage.elements), linkage.knots, linkage.span
    period = high - low if linkage.closed else None
    reach = min([REACH, *_gaps(changes, (*knots.tolist(), *changes), period)])
    parts[number] = replace(dyad, changes=changes, period=period, reach=reach)
    if dyad.keeps == BRANCH:  # which has a corner there
        knots = distinct(knots, [one for one in changes if knots[0] < one < knots[-1]])
    return replace(linkage, elements=tuple(parts), knots=knots)


def _gaps(
    changes: tuple[float, ...], others: tuple[float, ...], period: float | None
) -> Iterator[float]:
    """Yield half the distances of change points from other angles that are not the same, rad."""
    for one, other in product(changes, others):
        gap = abs(one - other)
        gap = min(gap, abs(period - gap)) if period else gap
        if gap > _SAME:
            yield 0.5 * gap


def closing(linkage: Linkage, element: Element) -> Closing | None:
    """Return where a part of a linkage closes.

    Parameters
    ----------
    linkage : Linkage
        In which all parts before this one close.
    element : Element
        The part.

    Returns
    -------
    Closing, or None if it always closes
    """
    if not element.room(linkage.at(linkage.knots[:1], 0, element)):
        return None

    def rooms(q: Array) -> Array:
        shares = element.room(linkage.at(q, 1, element))
        return np.stack([one.derivatives()[:2] for one in shares], axis=1)

    def left(q: Array) -> Array:
        found = element.left(linkage.at(q, 2, element))
        return np.stack([one.derivatives()[:3] for one in found], axis=1)

    extremes = [
        _polished(linkage, element, number, places)
        if np.abs(values).min() < _NEARLY
        else (places, values)
        for number, (places, values) in enumerate(extremes_of_each(rooms, linkage.knots))
    ]
    lowest, shares = min(extremes, key=lambda one: one[1].min())
    ranges = (linkage.span,)
    if shares.min() < 0.0:
        crossed = [
            _crossings(lambda q, k=k: rooms(q)[0, k], *one) for k, one in enumerate(extremes)
        ]
        ranges = _ranges(linkage, element, np.concatenate(crossed))
    touching = np.concatenate([places[values == 0.0] for places, values in extremes])
    return Closing(
        element,
        tuple(float(values.min()) for _, values in extremes),
        float(lowest[shares.argmin()]),
        ranges,
        _apart(touching, linkage),
        narrow_places(left, [_minima(*one) for one in extremes], linkage.knots),
    )


def _shares(element: Element, known: Known) -> list[Array]:
    """Return the shares of a part, of which those that are rounding are 0."""
    pairs = zip(element.room(known), element.rounding(known), strict=True)
    values = ((np.asarray(share.c[0]), least) for share, least in pairs)
    return [np.where(np.abs(share) <= least, 0.0, share) for share, least in values]


def _minima(places: Array, values: Array) -> Array:
    """Return where a share is smallest, but for change points, from its extremes."""
    places, own = np.unique(places, return_index=True)  # a knot is there from both sides
    values = values[own]
    beside = np.minimum(np.append(values[1:], np.inf), np.append(np.inf, values[:-1]))
    return places[(values <= beside) & (values > 0.0)]


def _polished(
    linkage: Linkage, element: Element, number: int, places: Array
) -> tuple[Array, Array]:
    """Return places of the extremes of a share to rounding, and the values there.

    A place is a root of its slope, or a knot that is one.
    """
    q = places
    for _ in range(2):
        _, slope, bend = element.room(linkage.at(q, 2, element))[number].derivatives()[:3]
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            step = slope / bend
        q = np.where(np.abs(q - step - places) < _SAME, q - step, places)
    q = snapped(np.clip(q, *linkage.span), linkage.knots, _ON_KNOT)
    return q, _shares(element, linkage.at(q, 0, element))[number]


def _crossings(room: Callable[[Array], Array], places: Array, values: Array) -> Array:
    """Return the simple zeros of a function between its extremes."""
    (cells,) = np.nonzero(opposite(values[:-1], values[1:]))
    ends = values[cells], values[cells + 1]
    return bracketed_root(room, places[cells], places[cells + 1], _FOUND, ends)


def _ranges(linkage: Linkage, element: Element, zeros: Array) -> tuple[tuple[float, float], ...]:
    """Return the ranges between zeros over which all shares are positive."""
    low, high = linkage.span
    edges = distinct(zeros, [low, high])
    middles = 0.5 * (edges[1:] + edges[:-1])
    known = linkage.at(middles, 0, element)
    open_ = np.all([share >= 0.0 for share in _shares(element, known)], axis=0)
    ranges: list[tuple[float, float]] = []
    for begin, end in zip(edges[:-1][open_], edges[1:][open_], strict=True):
        if ranges and ranges[-1][1] == begin:
            begin = ranges.pop()[0]
        ranges.append((float(begin), float(end)))
    if linkage.closed and len(ranges) > 1 and (ranges[0][0], ranges[-1][1]) == (low, high):
        ranges[0] = ranges.pop()[0] - (high - low), ranges[0][1]
    return tuple(ranges)


def _apart(touching: Array, linkage: Linkage) -> tuple[float, ...]:
    """Return change points without those found twice, at both sides of a knot or of a turn."""
    low, high = linkage.span
    if linkage.closed:
        touching = np.where(high - touching < _SAME, low, touching)
    return tuple(apart(np.sort(touching), _SAME).tolist())


def _nearest(dyad: Dyad, leasts: Sequence[float]) -> list[dict[int, float]]:
    """Return lengths that make a dyad close, mm, by their numbers, from its least shares."""
    if dyad.driven is not None or dyad.type == "TRT":
        return []
    sizes = np.array(dyad.lengths[:2], dtype=float)
    if dyad.type == "RRR":
        outer, inner, _ = leasts
        whole, folded = sizes.sum() ** 2, (sizes[0] - sizes[1]) ** 2
        least, most = max(inner * whole + folded, 0.0), (1.0 - outer) * whole
        return _nearest_rods(sizes, math.sqrt(least), math.sqrt(most))
    (share,) = leasts
    if dyad.type in ("RRT", "TRR"):  # as long as the farthest that it has to reach across
        number = ("RRT", "TRR").index(dyad.type)
        return [{number: float(sizes[number]) * math.sqrt(1.0 - share) * (1.0 + _SPARE)}]
    number, turned = ("RTR2", "RTR1").index(dyad.type), abs(math.sin(dyad.lengths.beta))
    least = rtr_distance(float(sizes[number]) * turned, share)
    return [{number: least / turned * (1.0 - _SPARE)}] if turned > 0.0 and least > 0.0 else []


def _nearest_rods(own: Array, least: float, most: float) -> list[dict[int, float]]:
    """Return lengths with which two rods reach all distances of their ends, nearest first."""
    if least <= _MET * most:  # only rods of one length reach it, and lose their place there
        return []
    changes: list[dict[int, float]] = []
    for number in (0, 1):
        other = own[1 - number]
        low, high = max(most - other, other - least) * (1.0 + _SPARE), other + least
        if low < high * (1.0 - _SPARE):
            changes.append({number: min(max(own[number], low), high * (1.0 - _SPARE))})
    if not changes:  # both: as long as the distance asks for, with the difference they have
        half = 0.5 * most * (1.0 + _SPARE)
        skew = np.clip(0.5 * (own[0] - own[1]), *(0.5 * least * (1.0 - _SPARE) * np.array([-1, 1])))
        changes.append({0: float(half + skew), 1: float(half - skew)})
    return sorted(changes, key=lambda one: max(abs(v - own[k]) for k, v in one.items()))
