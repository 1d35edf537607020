"""Small loops of an undercut profile, closed on the curve itself.

A profile that is only just undercut turns back over a stretch far below its chord tolerance.
Polygons cannot resolve such a loop, and differences of its points are rounding. Instead the loop is
closed by the condition that the integral of the velocity, from a point before the stretch to one
after it, vanishes; the integral of small numbers keeps all digits.

Depends on curve, measures, trim and numeric; numpy only.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from gearcam.cams.curve import ProfileSegments
from gearcam.cams.measures import over_the_end
from gearcam.cams.trim import Corner, cut_out
from gearcam.numeric.arrays import Array
from gearcam.numeric.crossings import Branch, CurvePoint, rows_between
from gearcam.numeric.roots import bracketed_root

SMALL = 1e-4
"""Largest length of the backward stretch, in sizes of the cam, of loops closed here: polygons
resolve longer ones."""

_GAUSS = 24
"""Gauss points per segment: exact to rounding, since loops are short."""

_STEPS = 30
"""Largest number of Newton steps."""

_NOTHING = 1e-11
"""Length of the backward stretch, in sizes of the cam, below which it is cut out: rounding hides
how it closes."""

_CLOSED = 1e-10
_NOISE = 32.0 * np.finfo(float).eps
"""Allowed residual of a closed loop, as shares of backward stretch and of size: rounding."""

_WIDTH = 1e-15
"""Width of a root's bracket, rad."""


def without_small_loops(
    segments: ProfileSegments, undercut: Sequence[tuple[float, float]], size: float
) -> tuple[ProfileSegments, tuple[Corner, ...], list[tuple[float, float]]]:
    """Return a profile without its small loops.

    Parameters
    ----------
    segments : ProfileSegments
        The whole profile, in order from the beginning of the turn.
    undercut : sequence of (float, float)
        Cam angles between which it runs backwards, rad.
    size : float, mm
        Of the cam.

    Returns
    -------
    segments : ProfileSegments
        Without the closed loops.
    corners : tuple of Corner
        Their corners.
    left : list of (float, float)
        The remaining undercut stretches.
    """
    closed: list[tuple[CurvePoint, CurvePoint]] = []
    left: list[tuple[float, float]] = []
    closes = segments.curve.program.closed
    for parts in over_the_end(undercut, closes):
        # a stretch in two parts, on both sides of the turn's end, begins with the later part; a
        # jump at that end is no stretch after it
        found = _closed(segments, (parts[-1][0], parts[0][1] or parts[-1][1]), size)
        if found is None:
            left += parts
        else:
            closed.append(found)
    if not closed:
        return segments, (), left
    ends = [*closed[1:], closed[0]] if closes else [*closed, (segments.last, segments.last)]
    begins = closed if closes else [(segments.first, segments.first), *closed]
    pairs = zip(begins, ends, strict=True)
    kept, corners = cut_out(segments, [Branch(one[1], two[0]) for one, two in pairs])
    return kept, corners, left


def _closed(
    segments: ProfileSegments, stretch: tuple[float, float], size: float
) -> tuple[CurvePoint, CurvePoint] | None:
    """Return the two points where the loop of a stretch closes; None if it is not small."""
    begin, end = _span(segments, *stretch)
    back = abs(_way(segments, begin, end))
    if back > SMALL * size:
        return None
    for one, two in product(_beside(segments, begin, -1), _beside(segments, end, 1)):
        found = _searched(segments, one, two, back, size)
        if found is not None:
            return found
    return (begin, end) if back <= _NOTHING * size else None


def _span(segments: ProfileSegments, low: float, high: float) -> tuple[CurvePoint, CurvePoint]:
    """Return the points between which a stretch runs backwards, with jumps at its ends."""
    count, back = len(segments.start), segments.backward
    if low == high:
        theta = segments.curve.program.knots[segments.piece]
        k = int(np.flatnonzero(back & (theta == low))[0])
        return CurvePoint(k, float(segments.start[k])), CurvePoint(k, float(segments.end[k]))
    sweep = ~segments.jump
    first = int(np.flatnonzero(sweep & (segments.start <= low) & (low < segments.end))[0])
    last = int(np.flatnonzero(sweep & (segments.start < high) & (high <= segments.end))[0])
    begin, end = CurvePoint(first, low), CurvePoint(last, high)
    if low == segments.start[first] and back[first - 1]:
        begin = CurvePoint((first - 1) % count, float(segments.start[first - 1]))
    after = (last + 1) % count
    if high == segments.end[last] and back[after]:
        end = CurvePoint(after, float(segments.end[after]))
    return begin, end


def _beside(segments: ProfileSegments, place: CurvePoint, side: int) -> list[CurvePoint]:
    """Return the ends of the two segments before (-1) or after (+1) a point."""
    far, near = (segments.end, segments.start) if side > 0 else (segments.start, segments.end)
    k, count = place[0], len(segments.start)
    found = [place] if not segments.jump[k] and place[1] != far[k] else []
    for step in (1, 2)[: 2 - len(found)]:
        other = (k + side * step) % count
        if segments.curve.program.open and other != k + side * step:
            break
        found.append(CurvePoint(other, float(near[other])))
    return found


def _searched(
    segments: ProfileSegments, begin: CurvePoint, end: CurvePoint, back: float, size: float
) -> tuple[CurvePoint, CurvePoint] | None:
    """Return where a loop closes on the segments of two points next to it, or None."""
    ways = (_ahead(segments, begin, -1, 0.5 * back), _ahead(segments, end, 1, 0.5 * back))
    if ways[0] is None or ways[1] is None:
        return None
    room = begin.parameter, end.parameter
    found = _close(segments, CurvePoint(begin.curve, ways[0]), CurvePoint(end.curve, ways[1]), room)
    if found is None:
        return None
    fits = abs(_way(segments, *found)) <= _CLOSED * back + _NOISE * size
    return found if fits else None


def _ahead(segments: ProfileSegments, place: CurvePoint, side: int, length: float) -> float | None:
    """Return the point of a sweep at an arc length before (-1) or after (+1) a point."""
    k = place.curve
    limit = float(segments.end[k] if side > 0 else segments.start[k])

    def miss(parameter: Array) -> Array:
        ends = [(place, CurvePoint(k, float(p)))[::side] for p in parameter]
        return np.array([abs(_way(segments, *pair)) - length for pair in ends])

    if miss(np.array([limit]))[0] < 0.0:
        return None
    return float(bracketed_root(miss, [place.parameter], [limit], _WIDTH)[0])


def _close(
    segments: ProfileSegments, one: CurvePoint, two: CurvePoint, room: tuple[float, float]
) -> tuple[CurvePoint, CurvePoint] | None:
    """Return two points, one before and one after a stretch, between which the loop closes."""
    (first, a), (last, b) = one, two
    for _ in range(_STEPS):
        way = _way(segments, CurvePoint(first, a), CurvePoint(last, b))
        index, places = np.array([first, last]), np.array([a, b])
        slopes = segments.moving(index, places)[1]
        # way - slopes[0]*da + slopes[1]*db = 0
        cross = (np.conj(slopes[0]) * slopes[1]).imag
        if cross == 0.0:
            return None
        da = (np.conj(slopes[1]) * way).imag / (np.conj(slopes[1]) * slopes[0]).imag
        db = -(np.conj(slopes[0]) * way).imag / cross
        a, b = a + float(da), b + float(db)
        if not (segments.start[first] <= a <= room[0] and room[1] <= b <= segments.end[last]):
            return None
        if abs(da) + abs(db) <= _WIDTH:
            break
    return CurvePoint(first, a), CurvePoint(last, b)


def _way(segments: ProfileSegments, begin: CurvePoint, end: CurvePoint) -> complex:
    """Return the vector between two points of the curve, by integration along its segments."""
    k, low, high, _ = rows_between(segments, [Branch(begin, end)])
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    places = (middle[:, None] + half[:, None] * nodes).ravel()
    slopes = segments.moving(np.repeat(k, _GAUSS), places)[1].reshape(-1, _GAUSS)
    return complex((half * (slopes @ weights)).sum())
