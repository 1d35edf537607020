"""Overlap of facing halves, by numpy alone: two staircases, one above the other.

Seen at 45 degrees, halfway between down the tooth and across to the space, the edge of half a
tooth is a staircase that rises all the way: land, flank, land. So is the edge of the half that
faces it, and their overlap is where one graph is above the other: an integral of straight pieces,
exact as the outlines are, without any polygon. A first look at thinned edges leaves out the halves
that cannot touch.

What a graph cannot say is left to the polygons and only marked here: an edge that turns back, an
overlap that goes beyond the middle of a tip or root, a half that stands beside its mate. To see
these, edges go on over the other half of the tip, the driven wheel's also of the root, and a cover
is laid over the tips of its teeth behind. What stands beyond the root's end belongs to the other
half of its tooth, whose edge goes on over it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gearcam.gears.contact import Ints
from gearcam.gears.guide import Guide

Array = NDArray[np.float64]
Plane = NDArray[np.complex128]
Bools = NDArray[np.bool_]

_STEEPEST = 5.0
"""Slope that an edge may have in its graph, else it is left to the polygons."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Edges:
    """Edges of the halves of a wheel.

    Parameters
    ----------
    points : (n,) complex array, mm
        Vertices in the wheel's frame, edge after edge: the driven wheel's from tip to root, the
        driver's from root to tip.
    starts : (2z + 1,) int array
        Where each edge begins, and the end.
    whole : (n,) int array
        Index of each vertex in the edges that these were thinned from; their own otherwise.
    ends : (2, 2z) complex array, mm
        First and last vertex of the half itself, where an edge goes on over its neighbours.
    along : (2z,) complex array
        Unit vectors in which the edges rise.
    hand : (2z,) array
        +1 or -1: the driven wheel is on the right or on the left of `along`.
    deviation : float, mm
        Largest distance of the unthinned edges from these.
    """

    points: Plane
    starts: Ints
    whole: Ints
    ends: Plane
    along: Plane
    hand: Array
    deviation: float = 0.0


@dataclass(frozen=True, eq=False, kw_only=True)
class Facing:
    """Halves of the driver and the driven halves that face them, n of them.

    Parameters
    ----------
    one, two : (n,) int arrays
        Halves.
    turn, shift : (n,) complex arrays, 1 and mm
        What takes the driver's points into the driven wheel's frame.
    guide : Guide
        What guides the driven wheel: says the heights of points there.
    reach : (n,) array, mm
        Largest height of the driven wheel near these halves.
    """

    one: Ints
    two: Ints
    turn: Plane
    shift: Plane
    guide: Guide
    reach: Array

    def take(self, some: Ints) -> Facing:
        """Return `some` of the halves."""
        return Facing(
            one=self.one[some],
            two=self.two[some],
            turn=self.turn[some],
            shift=self.shift[some],
            guide=self.guide,
            reach=self.reach[some],
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class Steps:
    """Overlaps of facing halves, one entry each, or 0 where there is none.

    Parameters
    ----------
    area, length : (n,) arrays, mm^2 and mm
        Area, and diagonal of its box.
    radius : (2, n) array, mm
        Smallest and largest distance of its corners from the driver's axis.
    beyond : (n,) bool array
        Where only polygons can tell.
    """

    area: Array
    length: Array
    radius: Array
    beyond: Bools


@dataclass(frozen=True, eq=False)
class _Graph:
    """Graphs end to end: v over u, and which of `count` each vertex belongs to."""

    u: Array
    v: Array
    owner: Ints
    index: Ints

    @property
    def first(self) -> Ints:
        return np.flatnonzero(np.append(True, np.diff(self.owner) > 0))


def overlap(one: tuple[Edges, Edges], two: tuple[Edges, Edges], facing: Facing) -> Steps:
    """Overlap facing halves.

    Parameters
    ----------
    one, two : (Edges, Edges)
        Edges of driver and driven wheel, whole and thinned.
    facing : Facing
        Who faces whom, and how they stand.

    Returns
    -------
    Steps
    """
    count = len(facing.one)
    area, length, radius = np.zeros(count), np.zeros(count), np.zeros((2, count))
    beyond = np.zeros(count, dtype=bool)
    if not count:
        return Steps(area=area, length=length, radius=radius, beyond=beyond)
    near, windows, beyond = _look(one[1], two[1], facing)
    if near.size:
        part = facing.take(near)
        frame = _frame(one[0], two[0], part)
        first = _cut(one[0], windows[0], frame, (part.turn, part.shift))
        second = _cut(two[0], windows[1], frame)
        merged = _merge(first, second)
        core = _core(one[0], two[0], part, frame[0])
        area[near], length[near], radius[:, near], odd = _measure(merged, frame, part.shift, core)
        for graph in (first, second):
            odd[graph.owner[_wrong(graph)]] = True
        beyond[near] |= odd
    return Steps(area=area, length=length, radius=radius, beyond=beyond)


def _frame(one: Edges, two: Edges, facing: Facing) -> tuple[Plane, Array]:
    """Direction of u, halfway between those of both edges, and the sign of v."""
    along = two.along[facing.two] + one.along[facing.one] * facing.turn
    return along / np.abs(along), two.hand[facing.two]


def _cut(
    edges: Edges,
    window: tuple[Ints, Ints],
    frame: tuple[Plane, Array],
    pose: tuple[Plane, Plane] | None = None,
) -> _Graph:
    """Graphs of the vertices from `window[0]` to `window[1]` inclusive."""
    sizes = window[1] - window[0] + 1
    owner = np.repeat(np.arange(len(sizes)), sizes)
    index = np.arange(len(owner)) + (window[0] - np.cumsum(sizes) + sizes)[owner]
    along, hand = np.conj(frame[0]), frame[1]
    points = edges.points[index]
    if pose is None:
        points = points * along[owner]
    else:
        points = points * (pose[0] * along)[owner] + (pose[1] * along)[owner]
    return _Graph(points.real, hand[owner] * points.imag, owner, index)


def _core(one: Edges, two: Edges, facing: Facing, along: Plane) -> Array:
    """Where along u both halves are, first and last."""
    driver = one.ends[:, facing.one] * facing.turn + facing.shift
    first, last = (driver / along).real, (two.ends[:, facing.two] / along).real
    return np.stack([np.maximum(first[0], last[0]), np.minimum(first[1], last[1])])


def _look(one: Edges, two: Edges, facing: Facing) -> tuple[Ints, list[tuple[Ints, Ints]], Bools]:
    """Find halves that come so near that thinning may hide their touch.

    Returns them, the stretches of the whole edges that hold all places so near, and the halves
    of which the graphs are not to be trusted.
    """
    count = len(facing.one)
    frame = _frame(one, two, facing)
    full = [(e.starts[h], e.starts[h + 1] - 1) for e, h in ((one, facing.one), (two, facing.two))]
    first = _within(_cut(one, full[0], frame, (facing.turn, facing.shift)), frame, facing)
    second = _cut(two, full[1], frame)
    (over, after), (under, before) = _across(first, second)
    beyond = np.zeros(count, dtype=bool)
    beyond[first.owner[after == second.first[first.owner]]] = True
    beyond[first.owner[_wrong(first, _STEEPEST)]] = True
    wrong = _wrong(second, _STEEPEST)
    # where the driver is, or between two vertices of its mate
    there = ~np.isnan(under[wrong - 1] + under[wrong]) | (before[wrong] > before[wrong - 1])
    beyond[second.owner[wrong[there]]] = True
    near = -np.hypot(1.0, _STEEPEST) * (one.deviation + two.deviation)
    hot = [np.flatnonzero(over - first.v > near), np.flatnonzero(second.v - under > near)]
    touched = np.zeros(count, dtype=bool)
    for graph, some in zip((first, second), hot, strict=True):
        touched[graph.owner[some]] = True
    touched &= ~beyond
    windows = []
    for edges, graph, own, other, at in (
        (one, first, hot[0], second.owner[hot[1]], before[hot[1]]),
        (two, second, hot[1], first.owner[hot[0]], after[hot[0]]),
    ):
        owner = np.concatenate([graph.owner[own], other])
        low, high = np.full(count, len(graph.u)), np.full(count, -1)
        np.minimum.at(low, owner, np.concatenate([own, at]) - 1)
        np.maximum.at(high, owner, np.concatenate([own + 1, at]))
        ends = np.searchsorted(graph.owner, np.arange(count + 1))
        low, high = np.maximum(low, ends[:-1])[touched], np.minimum(high, ends[1:] - 1)[touched]
        windows.append((edges.whole[graph.index[low]], edges.whole[graph.index[high]]))
    return np.flatnonzero(touched), windows, beyond


def _within(graph: _Graph, frame: tuple[Plane, Array], facing: Facing) -> _Graph:
    """Leave out the roots of the driver that the mate cannot reach, up to the last vertex."""
    at, owner = np.arange(len(graph.u)), graph.owner
    points = (graph.u + 1j * frame[1][owner] * graph.v) * frame[0][owner]
    inside = facing.guide.height(points) <= facing.reach[owner]
    begins = np.minimum.reduceat(np.where(inside, at, len(at)), graph.first) - 1
    keep = at >= np.repeat(begins, np.diff(np.append(graph.first, len(at))))
    return _Graph(graph.u[keep], graph.v[keep], graph.owner[keep], graph.index[keep])


def _wrong(graph: _Graph, steepest: float = np.inf) -> Ints:
    """Vertices up to which an edge turns back, or is steeper than allowed."""
    step = np.diff(graph.u)
    wrong = (step <= 0.0) | (np.abs(np.diff(graph.v)) > steepest * step)
    return np.flatnonzero(wrong & (graph.owner[1:] == graph.owner[:-1])) + 1


def _across(first: _Graph, second: _Graph) -> tuple[tuple[Array, Ints], tuple[Array, Ints]]:
    """For both graphs: the other's height at its vertices, and the other's vertex that follows.

    The height is NaN where the other is not.
    """
    low = min(first.u.min(), second.u.min())
    span = max(first.u.max(), second.u.max()) - low + 1.0
    after = np.searchsorted(*(g.owner * span + (g.u - low) for g in (second, first)))
    # a vertex comes before all that come after it
    before = np.cumsum(np.bincount(after, minlength=len(second.u) + 1))[:-1]
    return (_height(second, after, first.u), after), (_height(first, before, second.u), before)


def _height(graph: _Graph, following: Ints, u: Array) -> Array:
    """Height of a graph at u, before the vertices that follow; NaN between two graphs."""
    slope = np.full(len(graph.u) + 1, np.nan)
    level = slope.copy()
    inner = slope[1:-1]
    with np.errstate(divide="ignore", invalid="ignore"):  # an edge that turns back is left out
        np.divide(np.diff(graph.v), np.diff(graph.u), out=inner)
    inner[graph.owner[1:] != graph.owner[:-1]] = np.nan
    level[1:-1] = graph.v[1:] - inner * graph.u[1:]
    return level[following] + slope[following] * u


@dataclass(frozen=True, eq=False)
class _Merged:
    """Both graphs at the vertices of both where both are: v of the driver, height of the other."""

    u: Array
    v: Array
    height: Array
    owner: Ints


def _merge(first: _Graph, second: _Graph) -> _Merged:
    (over, after), (under, before) = _across(first, second)
    size = len(first.u) + len(second.u)
    u, v, height, owner = np.empty(size), np.empty(size), np.empty(size), np.empty(size, np.int64)
    # a vertex comes after as many of the other graph as lie before it
    for graph, at, low, high in (
        (first, np.arange(len(first.u)) + after, first.v, over),
        (second, np.arange(len(second.u)) + before, under, second.v),
    ):
        u[at], v[at], height[at], owner[at] = graph.u, low, high - low, graph.owner
    both = ~np.isnan(height)
    return _Merged(u[both], v[both], height[both], owner[both])


def _measure(
    merged: _Merged, frame: tuple[Plane, Array], shift: Plane, core: Array
) -> tuple[Array, Array, Array, Bools]:
    """Area, length and radii of the overlaps, and where they go beyond their halves."""
    count = len(shift)
    owner = merged.owner
    new = np.flatnonzero(np.append(True, np.diff(owner) > 0))
    ends = np.concatenate([new, np.append(new[1:], len(owner)) - 1])
    odd = np.bincount(owner[ends], merged.height[ends] > 0.0, minlength=count) > 0
    before, after = merged.height[:-1], merged.height[1:]
    k = np.flatnonzero(((before > 0.0) | (after > 0.0)) & (owner[1:] == owner[:-1]))
    before, after, owner = before[k], after[k], owner[k]
    step, rise = merged.u[k + 1] - merged.u[k], merged.v[k + 1] - merged.v[k]
    # where the graphs cross, heights are 0: shares of the step at which overlap begins and ends
    cross = np.clip(before / np.where(before == after, 1.0, before - after), 0.0, 1.0)
    begin, end = np.where(before > 0.0, 0.0, cross), np.where(after > 0.0, 1.0, cross)
    high = np.maximum(before, 0.0), np.maximum(after, 0.0)
    pieces = 0.5 * (high[0] + high[1]) * (end - begin) * step
    area = np.zeros(count)
    np.add.at(area, owner, pieces)
    u = np.stack([merged.u[k] + share * step for share in (begin, end)])
    v = np.stack([merged.v[k] + share * rise for share in (begin, end)])
    top = v + np.stack(high)
    here = np.flatnonzero(np.append(True, np.diff(owner) > 0)) if len(owner) else owner
    some = owner[here]
    odd[some[np.minimum.reduceat(u[0], here) < core[0, some]]] = True
    odd[some[np.maximum.reduceat(u[1], here) > core[1, some]]] = True
    length, radius = np.zeros(count), np.zeros((2, count))
    corners = np.stack([u + 1j * frame[1][owner] * side for side in (v, top)]) * frame[0][owner]
    corners = corners.reshape(4, -1)
    spans = [
        np.maximum.reduceat(x.max(axis=0), here) - np.minimum.reduceat(x.min(axis=0), here)
        for x in (corners.real, corners.imag)
    ]
    length[some] = np.hypot(*spans)
    seen = np.abs(corners - shift[owner])
    radius[0, some] = np.minimum.reduceat(seen.min(axis=0), here)
    radius[1, some] = np.maximum.reduceat(seen.max(axis=0), here)
    return area, length, radius, odd
