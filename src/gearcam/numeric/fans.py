"""Fans of triangles along the dense edges of a region, which leave few vertices to triangulate.

The time of a general triangulation grows with the square of the vertices. A short, slightly curved
stretch of an edge is visible as a whole from a point a little inside, its *apex*: its chords and
the apex form a *fan* of triangles, and of the stretch only its ends and the apex remain.

Fans of different stretches may overlap where a region is narrow. The caller has to check the signs
of all triangles: if none is reversed, they cover the region once.

Depends on numpy alone.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Plane

_MOST: Final = 64
"""Largest number of chords of a stretch."""

_LEAST: Final = 4
"""Least number of chords: smaller fans gain nothing."""

_TURN: Final = 0.25
"""Largest angle of a stretch, rad."""

_DEEP: Final = 0.15
"""Depth of an apex below the chord of its stretch, in lengths of that chord: twice the depth at
which the end tangents of a concave stretch meet."""

_SHARP: Final = 1.9
"""Angle of a corner, rad, next to which there are no fans: those of both sides might overlap."""


class Fans(NamedTuple):
    """A loop reduced by fans, and the fans.

    Parameters
    ----------
    loop : (m,) int array
        Numbers of remaining vertices, in order; those from n on are apexes.
    apexes : (k,) complex array
        Points, the first of which has the number n.
    triangles : (t, 3) int array
        The fans, by vertex numbers; counter-clockwise for a counter-clockwise loop.
    """

    loop: Ints
    apexes: Plane
    triangles: Ints


def fans(points: Plane) -> Fans:
    """Return a loop reduced by fans.

    Parameters
    ----------
    points : (n,) complex array
        Its vertices, with the region on their left; the first is not repeated.

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
    """Return the first and last vertices of stretches; the very last is the first again."""
    turned, count = np.append(np.cumsum(turns), np.inf), len(turns)
    starts = [0]
    while starts[-1] < count:
        start = starts[-1]
        end = int(np.searchsorted(turned, turned[start] + _TURN, side="right"))
        starts.append(min(max(end, start + 1), start + _MOST, count))
    return np.array(starts[:-1]), np.array(starts[1:])
