"""Fans that cut the dense edges of a region off, so that a few vertices are left to triangulate.

General triangulations of curved edges grow with the square of their vertices. A short, hardly bent
stretch of an edge is seen whole from a place a little inside of it, its *apex*: its chords with
that place are a *fan* of triangles, and of the stretch only its ends and the apex are left.

Fans of different stretches may overlap where a region is narrow. Whoever uses them looks at the
signs of all triangles: where none is turned over, they cover the region once.

Depends on numpy alone.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Plane

_MOST: Final = 64
"""Chords of a stretch at most."""

_LEAST: Final = 4
"""And at least: fans of fewer gain nothing."""

_TURN: Final = 0.25
"""What a stretch turns at most, rad."""

_DEEP: Final = 0.15
"""Depth of an apex below the chord of its stretch, in that chord's length: twice as far in as the
tangents at the ends of a hollow one meet."""

_SHARP: Final = 1.9
"""Turn at a corner, rad, beside which there are no fans: those of both sides might overlap."""


class Fans(NamedTuple):
    """What fans leave of a loop, and themselves.

    Parameters
    ----------
    loop : (m,) int array
        Numbers of vertices that are left, in order; those from n on are apexes.
    apexes : (k,) complex array
        Places, the first of which has the number n.
    triangles : (t, 3) int array
        The fans, of numbers like those; of a counter-clockwise loop counter-clockwise.
    """

    loop: Ints
    apexes: Plane
    triangles: Ints


def fans(points: Plane) -> Fans:
    """Cut fans off a loop.

    Parameters
    ----------
    points : (n,) complex array
        Its vertices, the region on their left; the first is not repeated.

    Returns
    -------
    Fans
    """
    count = len(points)
    chords = np.roll(points, -1) - points
    turns = np.abs(np.angle(chords * np.conj(np.roll(chords, 1))))
    order = np.roll(np.arange(count), -int(turns.argmax()))
    first, last = _stretches(turns[order])
    ends = order[np.append(np.arange(count), 0)]
    p = points[ends]
    apexes = p[first] + (0.5 + 1j * _DEEP) * (p[last] - p[first])
    stretch = np.repeat(np.arange(len(first)), last - first)
    area = (np.conj(np.diff(p)) * (apexes[stretch] - p[:-1])).imag
    cut = (last - first >= _LEAST) & (np.minimum.reduceat(area, first) > 0.0)
    sharp = turns[ends] > _SHARP
    cut &= ~sharp[first] & ~sharp[last]
    number = count - 1 + np.cumsum(cut)
    stays = ~cut[stretch]
    stays[first] = True
    (left,) = np.nonzero(stays)
    (covered,) = np.nonzero(cut[stretch])
    return Fans(
        np.insert(order[left], np.searchsorted(left, first[cut]) + 1, number[cut]),
        apexes[cut],
        np.stack([ends[covered], ends[covered + 1], number[stretch[covered]]], axis=1),
    )


def _stretches(turns: Array) -> tuple[Ints, Ints]:
    """Return the first and last vertices of stretches; the last of all is the first again."""
    turned, count = np.append(np.cumsum(turns), np.inf), len(turns)
    starts = [0]
    while starts[-1] < count:
        start = starts[-1]
        end = int(np.searchsorted(turned, turned[start] + _TURN, side="right"))
        starts.append(min(max(end, start + 1), start + _MOST, count))
    return np.array(starts[:-1]), np.array(starts[1:])
