"""Closed polygons: whether one is simple, how far from a place and how often around it.

A polygon is an array of complex points, the first one not repeated. All is of O(n) or O(n*log(n))
for polygons along curves.

A polygon falls into *chains* that run in one quadrant, such as to the right and up. A chain is
simple, and its box is that of its ends. Neighbours that share one of both directions, such as up,
are on two sides of their common point, so that they meet nowhere else. What is left are chains
whose boxes overlap though they are no neighbours, which are few along teeth, and of these the
chords within both boxes. Decisions about such chords hold in exact arithmetic: a product that
rounding may have given its sign decides nothing (a bound as in Shewchuk, Discrete Comput. Geom. 18,
1997).

Depends on numpy.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Mask, Plane, distinct, in_groups
from gearcam.numeric.crossings import near_chords

_ROUNDING: Final = 4.0 * float(np.finfo(float).eps)
"""Largest error of a difference of products of differences, over the sum of both products."""


def is_simple(points: Plane) -> bool:
    """Return whether a polygon certainly neither crosses nor touches itself.

    Parameters
    ----------
    points : (n,) complex array

    Returns
    -------
    bool
        False also where points repeat, and where rounding leaves a doubt; then ask shapely, which
        also tells where.
    """
    step = np.roll(points, -1) - points
    length = np.abs(step)
    if not (length.min() > 0.0 and length.max() < np.inf):
        return False
    right, up = step.real >= 0.0, step.imag >= 0.0
    first = np.flatnonzero((right != np.roll(right, 1)) | (up != np.roll(up, 1)))
    before, after = step[first - 1], step[first]
    to_and_fro = ((before.real == 0.0) & (after.real == 0.0)) | (
        (before.imag == 0.0) & (after.imag == 0.0)
    )
    if to_and_fro.any():
        return False
    chord = _doubtful(points, first, right, up)
    return chord.size == 0 or _are_apart(points, chord)


def _doubtful(points: Plane, first: Ints, right: Mask, up: Mask) -> Ints:
    """Return the chords that may meet those of other chains, rising.

    The chains begin with the chords `first`, and run to the `right` and `up` if their chords do.
    """
    begin = points[first]
    end = np.roll(begin, -1)
    one, two = near_chords(begin, end)
    gap = two - one
    alike = (right[first[one]] == right[first[two]]) | (up[first[one]] == up[first[two]])
    beside = (gap == 0) | (((gap == 1) | (gap == len(first) - 1)) & alike)
    chain, other = np.stack([(one, two), (two, one)], axis=1)[:, :, ~beside].reshape(2, -1)
    group, place = in_groups(np.diff(first, append=first[0] + len(points))[chain])
    chord = (first[chain][group] + place) % len(points)
    to = points[(chord + 1) % len(points)]
    return distinct(chord[_boxes_meet(points[chord], to, begin[other][group], end[other][group])])


def _boxes_meet(a: Plane, b: Plane, c: Plane, d: Plane) -> Mask:
    """Return where the boxes with the corners a and b, and c and d, have a common point."""
    meet = np.ones(a.shape, dtype=np.bool_)
    for low, high, other, end in (
        (a.real, b.real, c.real, d.real),
        (a.imag, b.imag, c.imag, d.imag),
    ):
        meet &= np.minimum(low, high) <= np.maximum(other, end)
        meet &= np.minimum(other, end) <= np.maximum(low, high)
    return meet


def _are_apart(points: Plane, chord: Ints) -> bool:
    """Return whether no two of the chords certainly meet but at the common point of neighbours."""
    start, end = points[chord], points[(chord + 1) % len(points)]
    i, j = near_chords(start, end)
    gap = chord[j] - chord[i]
    around = gap == len(points) - 1
    # two that follow each other, in their order
    k, after = np.concatenate([np.stack([i, j])[:, gap == 1], np.stack([j, i])[:, around]], axis=1)
    folded = (_side(start[k], end[k], end[after]) == 0.0) & _turned_back(
        start[k], end[k], end[after]
    )
    if folded.any():
        return False
    i, j = np.stack([i, j])[:, (gap > 1) & ~around]
    a, b, c, d = start[i], end[i], start[j], end[j]
    one = _side(a, b, c) * _side(a, b, d) > 0.0
    return bool(np.all(one | (_side(c, d, a) * _side(c, d, b) > 0.0)))


def _turned_back(a: Plane, b: Plane, c: Plane) -> Mask:
    """Return where the way from a to b and on to c turns by a quarter turn at least."""
    return (np.conj(b - a) * (c - b)).real <= 0.0


def _side(a: Plane, b: Plane, c: Plane) -> Array:
    """Return 1 where c is certainly to the left of the way from a to b, -1 to the right, or 0."""
    along, away = b - a, c - a
    left, right = along.real * away.imag, along.imag * away.real
    area = left - right
    return np.where(np.abs(area) > _ROUNDING * (np.abs(left) + np.abs(right)), np.sign(area), 0.0)


def nearest(points: Plane, place: complex = 0j) -> float:
    """Return the distance of a polygon's boundary from a place.

    Parameters
    ----------
    points : (n,) complex array
    place : complex

    Returns
    -------
    float
    """
    away = points - place
    step = np.roll(away, -1) - away
    square = step.real**2 + step.imag**2
    # a chord without length is its first point
    share = -(away.real * step.real + away.imag * step.imag) / np.where(square > 0.0, square, 1.0)
    return float(np.abs(away + np.clip(share, 0.0, 1.0) * step).min())


def room_around(place: complex, within: Sequence[Plane], holes: Sequence[Plane] = ()) -> float:
    """Return how far a place is from the boundary of a region.

    Parameters
    ----------
    place : complex
    within : sequence of (n,) complex array
        Simple polygons, counter-clockwise: the region is what all of them have in common.
    holes : sequence of (n,) complex array
        Polygons that are not part of it.

    Returns
    -------
    float
        0 if the place is not inside.
    """
    if not all(turns_around(edge, place) == 1 for edge in within):
        return 0.0
    if any(turns_around(edge, place) for edge in holes):
        return 0.0
    return min(nearest(edge, place) for edge in (*within, *holes))


def turns_around(points: Plane, place: complex = 0j) -> int:
    """Return how often a polygon runs around a place, its winding number.

    Parameters
    ----------
    points : (n,) complex array
    place : complex
        Not on the boundary: within rounding of it the number may be that of either side.

    Returns
    -------
    int
        Counter-clockwise positive; 0 outside.
    """
    away = points - place
    above = away.imag > 0.0
    rises = np.roll(above, -1).astype(int) - above  # chords that pass the height of the place
    at = np.flatnonzero(rises)
    start, end = away[at], away[(at + 1) % len(away)]
    left = start.real * end.imag - start.imag * end.real  # the place is to the left of the chord
    return int(rises[at][left * rises[at] > 0.0].sum())
