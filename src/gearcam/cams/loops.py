"""Small loops of an undercut profile, closed on the curve itself.

A profile that is only just undercut turns back for a stretch far below the tolerance of its chords.
Polygons cannot show such a loop, and differences of its points are rounding. Its closure is found
from the way instead: the integral of the velocity, taken from a place before the stretch to one
behind it, vanishes; the integral of small numbers is a small number with all its digits.

Depends on curve, measures, trim and numeric; numpy only.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from gearcam.cams.curve import Array, Strokes
from gearcam.cams.measures import over_the_end
from gearcam.cams.trim import Corner, cut_out
from gearcam.numeric.crossings import Place, Span, rows_between
from gearcam.numeric.roots import bracketed_root

SMALL = 1e-4
"""Length of the way back, in sizes of the cam, up to which a loop is closed here: longer ones show
well in polygons."""

_GAUSS = 24
_STEPS = 30
_NOTHING = 1e-11
"""Length of the way back, in sizes of the cam, that is cut out where rounding hides how it closes.
"""

_CLOSED = 1e-10
_NOISE = 32.0 * np.finfo(float).eps
"""Parts of the way back, and of the size, by which a closed loop may miss: angles are rounded."""

_WIDTH = 1e-15
"""Width of a root's bracket, rad."""


def without_small_loops(
    strokes: Strokes, undercut: Sequence[tuple[float, float]], size: float
) -> tuple[Strokes, tuple[Corner, ...], list[tuple[float, float]]]:
    """Close the small loops of a profile.

    Parameters
    ----------
    strokes : Strokes
        The whole profile, in order from the beginning of the turn.
    undercut : sequence of (float, float)
        Cam angles between which it runs backwards, rad.
    size : float, mm
        Of the cam.

    Returns
    -------
    strokes : Strokes
        Without the loops that were closed.
    corners : tuple of Corner
        Where they were.
    left : list of (float, float)
        The stretches that are undercut still.
    """
    closed: list[tuple[Place, Place]] = []
    left: list[tuple[float, float]] = []
    for parts in over_the_end(undercut):
        # of two parts, one on each side of the turn's end, the later one begins
        found = _closed(strokes, (parts[-1][0], parts[0][1]), size)
        if found is None:
            left += parts
        else:
            closed.append(found)
    if not closed:
        return strokes, (), left
    pairs = zip(closed, [*closed[1:], closed[0]], strict=True)
    kept, corners = cut_out(strokes, [Span(one[1], two[0]) for one, two in pairs])
    return kept, corners, left


def _closed(
    strokes: Strokes, stretch: tuple[float, float], size: float
) -> tuple[Place, Place] | None:
    """Return the places where a loop about a stretch closes; None if it is not a small one."""
    begin, end = _span(strokes, *stretch)
    back = abs(_way(strokes, begin, end))
    if back > SMALL * size:
        return None
    for one, two in product(_beside(strokes, begin, -1), _beside(strokes, end, 1)):
        found = _searched(strokes, one, two, back, size)
        if found is not None:
            return found
    return (begin, end) if back <= _NOTHING * size else None


def _span(strokes: Strokes, low: float, high: float) -> tuple[Place, Place]:
    """Return the places between which a stretch runs backwards, with jumps at its ends."""
    count, back = len(strokes.start), strokes.jump & (strokes.end < strokes.start)
    if low == high:
        theta = strokes.curve.program.knots[strokes.piece]
        k = int(np.flatnonzero(back & (theta == low))[0])
        return Place(k, float(strokes.start[k])), Place(k, float(strokes.end[k]))
    sweep = ~strokes.jump
    first = int(np.flatnonzero(sweep & (strokes.start <= low) & (low < strokes.end))[0])
    last = int(np.flatnonzero(sweep & (strokes.start < high) & (high <= strokes.end))[0])
    begin, end = Place(first, low), Place(last, high)
    if low == strokes.start[first] and back[first - 1]:
        begin = Place((first - 1) % count, float(strokes.start[first - 1]))
    after = (last + 1) % count
    if high == strokes.end[last] and back[after]:
        end = Place(after, float(strokes.end[after]))
    return begin, end


def _beside(strokes: Strokes, place: Place, side: int) -> list[Place]:
    """Return the ends of the two strokes that come before (-1) or behind (+1) a place."""
    far, near = (strokes.end, strokes.start) if side > 0 else (strokes.start, strokes.end)
    k, count = place[0], len(strokes.start)
    found = [place] if not strokes.jump[k] and place[1] != far[k] else []
    for step in (1, 2)[: 2 - len(found)]:
        other = (k + side * step) % count
        found.append(Place(other, float(near[other])))
    return found


def _searched(
    strokes: Strokes, begin: Place, end: Place, back: float, size: float
) -> tuple[Place, Place] | None:
    """Return where a loop closes on the strokes of two places beside it, if it does there."""
    ways = (_ahead(strokes, begin, -1, 0.5 * back), _ahead(strokes, end, 1, 0.5 * back))
    if ways[0] is None or ways[1] is None:
        return None
    room = begin.parameter, end.parameter
    found = _close(strokes, Place(begin.curve, ways[0]), Place(end.curve, ways[1]), room)
    if found is None:
        return None
    fits = abs(_way(strokes, *found)) <= _CLOSED * back + _NOISE * size
    return found if fits else None


def _ahead(strokes: Strokes, place: Place, side: int, length: float) -> float | None:
    """Return where a sweep is a length of way before (-1) or behind (+1) a place."""
    k = place.curve
    limit = float(strokes.end[k] if side > 0 else strokes.start[k])

    def miss(parameter: Array) -> Array:
        ends = [(place, Place(k, float(p)))[::side] for p in parameter]
        return np.array([abs(_way(strokes, *pair)) - length for pair in ends])

    if miss(np.array([limit]))[0] < 0.0:
        return None
    return float(bracketed_root(miss, [place.parameter], [limit], _WIDTH)[0])


def _close(
    strokes: Strokes, one: Place, two: Place, room: tuple[float, float]
) -> tuple[Place, Place] | None:
    """Move two places, one before and one behind a stretch, until the way between them closes."""
    (first, a), (last, b) = one, two
    for _ in range(_STEPS):
        way = _way(strokes, Place(first, a), Place(last, b))
        index, places = np.array([first, last]), np.array([a, b])
        slopes = strokes.moving(index, places)[1]
        # way - slopes[0]*da + slopes[1]*db = 0
        cross = (np.conj(slopes[0]) * slopes[1]).imag
        if cross == 0.0:
            return None
        da = (np.conj(slopes[1]) * way).imag / (np.conj(slopes[1]) * slopes[0]).imag
        db = -(np.conj(slopes[0]) * way).imag / cross
        a, b = a + float(da), b + float(db)
        if not (strokes.start[first] <= a <= room[0] and room[1] <= b <= strokes.end[last]):
            return None
        if abs(da) + abs(db) <= _WIDTH:
            break
    return Place(first, a), Place(last, b)


def _way(strokes: Strokes, begin: Place, end: Place) -> complex:
    """Return the way from one place of the curve to another, along its strokes."""
    k, low, high, _ = rows_between(strokes, [Span(begin, end)])
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    places = (middle[:, None] + half[:, None] * nodes).ravel()
    slopes = strokes.moving(np.repeat(k, _GAUSS), places)[1].reshape(-1, _GAUSS)
    return complex((half * (slopes @ weights)).sum())
