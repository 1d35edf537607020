"""Self-crossings of chains of parametric curves, and the boundaries left without their loops.

A closed chain of curves that crosses itself divides the plane into faces; each has a *winding
number*, the number of turns of the chain around it, counter-clockwise. A cutter or a follower
leaves the region of positive winding number: loops that were swept away have -1 or 0. Its boundary
consists of stretches of the chain with the winding number 0 on their right, joined at crossings.

The chain is given as chords. Crossings of chords are found first; along the chain the winding
number on the right falls by one where another branch crosses from right to left, and rises by one
where it crosses from left to right, so that a cumulative sum gives the stretches that remain. The
crossings at their ends are then refined on the true curves.

Points are complex numbers. Source: winding numbers of raw parallels after Chen and McMains (Proc.
ASME IDETC 2005, 85513); derived anew.

Depends on numpy.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.contour import polygon_area
from gearcam.numeric.sampling import Curves

_TOUCH = 1e-9
"""Length of a loop, over that of its chain, below which it is ignored: neighbours of a curve
without length touch."""

_APART = 1e-15
"""Distance, in sizes of the chain, by which equal points are separated: rounding."""

_REAL = 8.0
"""Length of a chord, in these distances, above which it is more than a point."""

_GOLDEN = 2.399963229728653
"""The golden angle, rad: directions in which points are separated never coincide."""

_CELLS = 16
_DEPTH = 6
_LEVELS = 10
"""Levels of refinement. Each narrows a crossing 8 times and interpolates; six reach rounding. The
rest are for crossings that were first searched next to their place."""


class CurvePoint(NamedTuple):
    """A point of a chain: the number of a curve and its parameter."""

    curve: int
    parameter: float


class Branch(NamedTuple):
    """A stretch of a chain between two points, over whole curves between them."""

    begin: CurvePoint
    end: CurvePoint


def rows_between(curves: Curves, branches: Iterable[Branch]) -> tuple[Ints, Array, Array, Mask]:
    """Return the curves along branches.

    Parameters
    ----------
    curves : Curves
        In order; the first follows the last.
    branches : iterable of Branch
        In order.

    Returns
    -------
    index : (n,) int array
        Numbers of the curves.
    start, end : (n,) arrays
        Parameters at which their remaining parts begin and end.
    corner : (n,) bool array
        Whether a corner precedes them: the curve's own, or the beginning of a branch.
    """
    rows: list[tuple[int, float, float, bool]] = []
    for begin, end in branches:
        k, start, first = begin.curve, begin.parameter, True
        while k != end.curve or (first and _behind(curves, begin, end)):
            rows.append((k, start, float(curves.end[k]), first or bool(curves.corner[k])))
            k, first = (k + 1) % len(curves.start), False
            start = float(curves.start[k])
        rows.append((k, start, end.parameter, first or bool(curves.corner[k])))
    index, starts, ends, corner = zip(*rows, strict=True)
    return np.array(index), np.array(starts), np.array(ends), np.array(corner)


def _behind(curves: Curves, begin: CurvePoint, end: CurvePoint) -> bool:
    """Return whether an end on the same curve lies before the beginning, after a full circuit."""
    forward = np.sign(curves.end[begin.curve] - curves.start[begin.curve]) or 1.0
    return bool((end.parameter - begin.parameter) * forward < 0.0)


@dataclass(frozen=True, eq=False, kw_only=True)
class Chain:
    """The chords of curves, in order.

    Parameters
    ----------
    curve : (n,) int array
        Number of the curve of each chord.
    low, high : (n,) arrays
        Parameters at which each chord begins and ends on it.
    points : (n,) or (n + 1,) complex array
        Start of each chord; for an open chain also the end of the last.
    """

    curve: Ints
    low: Array
    high: Array
    points: Plane

    @property
    def open(self) -> bool:
        """Whether it is open; the winding number to its right is then 0."""
        return len(self.points) > len(self.curve)


@dataclass(frozen=True, eq=False, kw_only=True)
class Ring:
    """A closed part of the boundary, or the only part of an open chain.

    Parameters
    ----------
    branches : tuple of Branch
        In order; each ends at a crossing, where the next one begins. Without crossings the only
        branch is the whole chain.
    crossed : bool
        Whether there are crossings.
    polygon : (n,) complex array
        Its chords: counter-clockwise around the remaining region, clockwise around a hole.
    gap : float
        Largest distance of the curves at its crossings.
    """

    branches: tuple[Branch, ...]
    crossed: bool
    polygon: Plane
    gap: float

    @property
    def area(self) -> float:
        """Signed area of its polygon."""
        return polygon_area(self.polygon)


def remaining(curves: Curves, chains: Sequence[Chain]) -> list[list[Ring]]:
    """Return the boundaries of the remaining regions of chains.

    Parameters
    ----------
    curves : Curves
        The true curves.
    chains : sequence of Chain
        Chains, treated one by one.

    Returns
    -------
    list of list of Ring
        The boundary of each chain's region of positive winding number, in any order; of an open
        chain only the part from its beginning to its end. Where the chords do not determine it,
        nothing; for an open chain all of it.
    """
    if not chains:
        return []
    tangles = [_tangle(chain) for chain in chains]
    rings = [_rings(tangle) for tangle in tangles]
    brackets = [tangle.brackets for tangle in tangles]
    index, low, high = (np.concatenate(column, axis=1) for column in zip(*brackets, strict=True))
    used = np.concatenate([_used(*pair) for pair in zip(tangles, rings, strict=True)])
    parameter, gap = low, np.zeros(len(used))
    if used.any():
        narrow = _refined(curves, index[:, used], low[:, used], high[:, used])
        parameter[:, used], gap[used] = narrow
    cuts = np.cumsum([tangle.share.shape[1] for tangle in tangles])[:-1]
    return [
        [_ring(tangle, stays, places, gaps) for stays in left]
        for tangle, left, places, gaps in zip(
            tangles, rings, np.split(parameter, cuts, axis=1), np.split(gap, cuts), strict=True
        )
    ]


@dataclass(frozen=True, eq=False, kw_only=True)
class _Tangle:
    """The crossings of a chain's chords.

    An *event* is a point where a chord crosses another: crossing k of m is event k on the earlier
    of its branches and event ``k + m`` on the later one. -1 denotes the ends of the chain.

    Parameters
    ----------
    chain : Chain
        The chain.
    chord : (2, m) int array
        Numbers of the chords that cross, the earlier one first.
    share : (2, m) array
        Positions of the crossings as shares of the chords.
    turn : (m,) int array
        1 if the later branch crosses from right to left, -1 if from left to right.
    """

    chain: Chain
    chord: Ints
    share: Array
    turn: Ints

    @property
    def brackets(self) -> tuple[Ints, Array, Array]:
        """Curves that cross, and parameters that bracket their crossings, (2, m) each."""
        low, high = self.chain.low[self.chord], self.chain.high[self.chord]
        middle = low + self.share * (high - low)
        quarter = 0.25 * (high - low)
        return self.chain.curve[self.chord], middle - quarter, middle + quarter


_Stays = list[tuple[int, int]]
"""Pairs of events between which the chain is part of the boundary."""

_WHOLE = (-1, -1)


def _tangle(chain: Chain) -> _Tangle:
    """Return the crossings of chords of a chain that are not neighbours."""
    count = len(chain.points)
    nudge = _APART * float(np.abs(chain.points).max())
    p = chain.points + nudge * np.exp(1j * _GOLDEN * np.arange(count))
    step = np.roll(p, -1) - p
    number = np.flatnonzero(np.abs(step) > _REAL * nudge)
    number = number[number < len(chain.curve)]
    one, two = near_chords(p[number], (p + step)[number])
    apart = two - one > 1
    if not chain.open:
        apart &= two - one < len(number) - 1
    i, j = number[one[apart]], number[two[apart]]
    shares, area = chord_shares(p[i], p[i] + step[i], p[j], p[j] + step[j])
    along = np.concatenate([[0.0], np.cumsum(np.abs(step))])
    loop = along[j] - along[i + 1]
    touch = _TOUCH * along[len(chain.curve)]
    hit = _within(shares) & (loop > touch)
    if not chain.open:
        hit &= along[-1] - along[j + 1] + along[i] > touch
    return _Tangle(
        chain=chain,
        chord=np.stack([i, j])[:, hit],
        share=shares[:, hit],
        turn=np.sign(area[hit]).astype(np.int64),
    )


def _rings(tangle: _Tangle) -> list[_Stays]:
    """Return the remaining boundaries of a chain."""
    count = len(tangle.turn)
    if not count:
        return [[_WHOLE]]
    at, change = _events(tangle)
    order = np.argsort(at)
    right = _right_of_start(tangle.chain, at, change) + np.cumsum(change[order])
    kept = np.flatnonzero(right == 0)
    ends = dict(zip(order[kept].tolist(), np.roll(order, -1)[kept].tolist(), strict=True))
    seam, rings = int(order[-1]), []
    while ends:
        start = event = seam if seam in ends else next(iter(ends))
        stays: _Stays = []
        while event in ends:
            stays.append((event, ends.pop(event)))
            event = (stays[-1][1] + count) % (2 * count)
        if event == start:  # otherwise chords are too near each other
            rings.append(stays[1:] + stays[:1])
    if not tangle.chain.open:
        return rings
    if not rings or rings[0][-1][0] != seam:
        return [[_WHOLE]]
    *others, (begin, end) = rings[0]
    return [[(-1, end), *others, (begin, -1)]]


def _used(tangle: _Tangle, rings: list[_Stays]) -> Mask:
    """Return which crossings of a chain are ends of remaining stretches."""
    events = np.array([end for stays in rings for pair in stays for end in pair], dtype=np.int64)
    used = np.zeros(len(tangle.turn), dtype=bool)
    used[events[events >= 0] % max(len(used), 1)] = True
    return used


def _events(tangle: _Tangle) -> tuple[Array, Ints]:
    """Return positions of events, in chords, and changes of the winding number to the right."""
    return (tangle.chord + tangle.share).ravel(), np.concatenate([-tangle.turn, tangle.turn])


def _right_of_start(chain: Chain, at: Array, change: Ints) -> int:
    """Return the winding number to the right of a chain's beginning."""
    if chain.open:
        return 0
    p = chain.points
    k = int(np.abs(p - p.mean()).argmax())
    # beyond the outermost point is the outside: to the right, or to the left
    away = np.roll(p, -k) - p[k]
    away = away[np.abs(away) > _REAL * _APART * np.abs(p).max()]
    turns_left = (np.conj(away[-1]) * away[0]).imag < 0.0
    return (0 if turns_left else -1) - int(change[at < k].sum())


def _ring(tangle: _Tangle, stays: _Stays, parameter: Array, gap: Array) -> Ring:
    """Return the ring of remaining stretches, from parameters (2, m) and gaps (m,) of crossings."""
    chain, at, count = tangle.chain, _events(tangle)[0], len(tangle.turn)
    total, curve = len(chain.points), chain.curve[tangle.chord]
    # the ends of the chain come last, at index -1
    low, high = (np.append(parameter, end) for end in (chain.low[0], chain.high[-1]))
    one, two = (np.append(curve, chain.curve[end]) for end in (0, -1))
    branches, ways = [], []
    for begin, end in stays:
        start = CurvePoint(int(one[begin]), float(low[begin]))
        branches.append(Branch(start, CurvePoint(int(two[end]), float(high[end]))))
        first, last = np.append(at, 0.0)[begin], np.append(at, len(chain.curve))[end]
        last += total if last < first else 0
        ways.append(np.append(first, np.arange(int(first) + 1, last)))
    way = np.concatenate(ways)
    number = way.astype(np.int64)
    p, q = (chain.points[(number + k) % total] for k in (0, 1))
    crossings = [end % count for _, end in stays if end >= 0]
    return Ring(
        branches=tuple(branches),
        crossed=bool(crossings),
        polygon=p + (way - number) * (q - p),
        gap=float(gap[np.array(crossings, dtype=np.int64)].max(initial=0.0)),
    )


def _within(shares: Array) -> Mask:
    """Return whether shares (2, ...) lie within the chords."""
    return np.all((shares >= 0.0) & (shares <= 1.0), axis=0)


def _refined(curves: Curves, index: Ints, low: Array, high: Array) -> tuple[Array, Array]:
    """Return refined crossings of curves `index` in brackets `low` to `high`, (2, m), and gaps.

    The cell in which chords cross is kept with its neighbours, since the curves may cross just
    outside it; if they do not cross at all inside, the brackets are widened again.
    """
    ends = np.sort([curves.start[index], curves.end[index]], axis=0)[..., None]

    def at(parameter: Array) -> Plane:
        which = np.broadcast_to(index[..., None], parameter.shape)
        return curves.at(which.ravel(), parameter.ravel())[0].reshape(parameter.shape)

    middle, depth = 0.5 * (low + high), np.zeros(index.shape[1])
    for _ in range(_LEVELS):
        step = (high - low) / _CELLS
        grid = np.clip(
            low[..., None] + step[..., None] * np.arange(-1, _CELLS + 2), ends[0], ends[1]
        )
        one, two = at(grid)
        shares, _ = chord_shares(
            one[:, :-1, None], one[:, 1:, None], two[:, None, :-1], two[:, None, 1:]
        )
        hit = _within(shares).reshape(len(one), -1)
        best = hit.argmax(axis=1)
        cell = np.stack(np.divmod(best, grid.shape[2] - 1))[..., None]
        near = np.take_along_axis(grid, cell, axis=2)[..., 0]
        far = np.take_along_axis(grid, cell + 1, axis=2)[..., 0]
        share = np.take_along_axis(shares.reshape(2, len(one), -1), best[None, :, None], axis=2)
        found = hit.any(axis=1)
        middle = np.where(found, near + np.where(found, share[..., 0], 0.0) * (far - near), middle)
        depth = np.where(found, depth + 1, 0)
        if depth.min() >= _DEPTH:
            break
        low = np.where(found, near - 0.5 * step, low - 4.0 * step)
        high = np.where(found, far + 0.5 * step, high + 4.0 * step)
    one, two = at(middle[..., None])[..., 0]
    return middle, np.abs(one - two)


_TOGETHER = 64
"""Number of boxes compared all with all: faster than halving so few."""


@lru_cache
def _all_pairs(count: int) -> tuple[Ints, Ints]:
    """Return the numbers of all pairs of so many, each with itself too."""
    return np.triu_indices(count)


def near_chords(starts: Plane, ends: Plane) -> tuple[Ints, Ints]:
    """Return the pairs of chords whose bounding boxes overlap, by repeated halving.

    Parameters
    ----------
    starts, ends : (n,) complex arrays
        Ends of the chords, in order along the curve.

    Returns
    -------
    one, two : (k,) int arrays
        Numbers of the chords, ``one <= two``.
    """
    size = 1 << (len(starts) - 1).bit_length()
    low, high = np.full((2, size), np.inf), np.full((2, size), -np.inf)
    for axis, corners in enumerate(((starts.real, ends.real), (starts.imag, ends.imag))):
        np.minimum(*corners, out=low[axis, : len(starts)])
        np.maximum(*corners, out=high[axis, : len(starts)])
    levels = [(low, high)]
    while low.shape[1] > _TOGETHER:
        low, high = np.minimum(low[:, ::2], low[:, 1::2]), np.maximum(high[:, ::2], high[:, 1::2])
        levels.append((low, high))
    one, two = _all_pairs(low.shape[1])
    for number, (low, high) in enumerate(reversed(levels)):
        if number:  # each in two
            one = (2 * one[:, None] + [0, 0, 1, 1]).ravel()
            two = (2 * two[:, None] + [0, 1, 0, 1]).ravel()
            once = one <= two
            one, two = one[once], two[once]
        near = np.ones(one.shape, dtype=np.bool_)
        for least, most in zip(low, high, strict=True):  # by axis: faster than reducing pairs
            near &= (least[one] <= most[two]) & (least[two] <= most[one])
        one, two = one[near], two[near]
    return one, two


def chord_shares(a: Plane, b: Plane, c: Plane, d: Plane) -> tuple[Array, Array]:
    """Return where the lines of chords cross.

    Parameters
    ----------
    a, b, c, d : complex arrays
        The chords a-b and c-d.

    Returns
    -------
    shares : (2, ...) array
        Position on both chords as shares; not finite for parallels.
    area : array
        Positive where c-d crosses from right to left.
    """
    area = (np.conj(b - a) * (d - c)).imag
    with np.errstate(divide="ignore", invalid="ignore"):
        first = (np.conj(c - a) * (d - c)).imag / area
        second = (np.conj(c - a) * (b - a)).imag / area
    return np.stack([first, second]), area
