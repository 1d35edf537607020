"""Trimming: what is left of a profile when the follower's own passing has cut it.

An undercut profile crosses itself: between two crossings it lies where the follower passes at
another angle. No part of the curve reaches into the metal that is left, so the cam is the face of
the curve's arrangement that holds the axis, and its corners are crossings of the curve with itself.
The arrangement is made of chords; each crossing is then found on the true curves.

Refused: crossings that cannot be told apart.

Depends on curve and numeric; shapely inside the functions.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gearcam.cams.curve import Array, Index, Plane, Strokes
from gearcam.errors import InfeasibleError

_PROBES = 33
"""Places on each stroke at which its chords are counted."""

_AROUND = 97
"""Places in and beside every undercut stretch: its loop is seen at its own size."""

_BESIDE = 3.0
"""How far beside, in widths of the stretch: the loop closes within twice of it."""

_ROUNDS = 8
"""Times that chords are made four times finer where crossings are not told apart."""

_OVERLAP = 1e-12
"""Angle, rad, by which an undercut stretch may reach into what is left: rounding."""

_STEPS = 60
_MISS = 1e-12
_ANGLE = 4e-15
"""Distance of two curves at their crossing, in sizes of the cam, and in their speeds: rounding."""


@dataclass(frozen=True, kw_only=True)
class Corner:
    """A corner where trimming has cut.

    Parameters
    ----------
    point : complex, mm
        In the cam's frame.
    before, after : float, rad
        Cam angles at which its two sides are drawn; between them the follower rests on it.
    """

    point: complex
    before: float
    after: float


Place = tuple[int, float]
"""A stroke's number and its parameter."""

Row = tuple[int, float, float, bool]
"""Number of a stroke, where a part of it begins and ends, and whether that begins at a corner."""


@dataclass(frozen=True, eq=False, kw_only=True)
class _Chords:
    """The curve as a polygon: the stroke of each chord, and its parameters at both ends."""

    stroke: Index
    low: Array
    high: Array
    points: Plane


def star_shaped(points: Plane, tangents: Plane) -> bool:
    """Return whether a curve is seen whole from the axis: it then cannot cross itself.

    Parameters
    ----------
    points, tangents : complex arrays, mm and 1
        All along the curve, which is drawn forward everywhere.
    """
    side = np.imag(np.conj(points) * tangents)
    return bool(np.all(side > 0.0) or np.all(side < 0.0))


def trimmed(
    strokes: Strokes, undercut: Sequence[tuple[float, float]], tolerance: float
) -> tuple[Strokes, tuple[Corner, ...]]:
    """Return what is left of a profile, with its corners.

    Parameters
    ----------
    strokes : Strokes
        The whole profile.
    undercut : sequence of (float, float)
        Cam angles between which it runs backwards, rad.
    tolerance : float, mm
        Chord error of the polygons in which crossings are sought.

    Returns
    -------
    strokes : Strokes
        Those that are left, beginning at a corner if there is one.
    corners : tuple of Corner
        In the order of drawing.

    Raises
    ------
    InfeasibleError
        If the crossings cannot be told apart.
    """
    for number in range(_ROUNDS):
        chords = _chords(strokes, undercut, tolerance * 0.25**number)
        chains = _chains(chords)
        if chains is None:
            continue
        whole = len(chains) == 1 and chains[0][1] - chains[0][0] == len(chords.points)
        made = (strokes, ()) if whole else _cut(strokes, chords, chains)
        # chords that are too long may have missed a loop
        if made is not None and not _backwards(made[0], undercut):
            return made
    raise InfeasibleError(
        "the profile crosses itself so often that what is left cannot be told",
        where="[cam]",
        nearest="no piece of it has a place in the order of the others",
    )


def _backwards(strokes: Strokes, undercut: Sequence[tuple[float, float]]) -> bool:
    """Return whether anything is left that runs backwards."""
    if np.any(strokes.jump & (strokes.end < strokes.start)):
        return True
    start, end = strokes.start[~strokes.jump], strokes.end[~strokes.jump]
    return any(
        bool(np.any(np.minimum(end, high) - np.maximum(start, low) > _OVERLAP))
        for low, high in undercut
    )


def _chords(strokes: Strokes, undercut: Sequence[tuple[float, float]], tolerance: float) -> _Chords:
    """Cut every stroke into chords, finely around undercut stretches."""
    number, low, high = [], [], []
    for k in range(len(strokes.start)):
        start, end = float(strokes.start[k]), float(strokes.end[k])
        probes = np.linspace(start, end, _PROBES)
        if not strokes.jump[k]:
            probes = np.union1d(probes, strokes.curve.program.cuts_between(start, end))
        points, tangents = strokes.at(np.full(len(probes), k), probes)
        turning = np.abs(np.angle(tangents[1:] * np.conj(tangents[:-1])))
        # the square root of a chord's error adds up along the curve
        effort = np.sqrt(turning * np.abs(np.diff(points)) / (8.0 * tolerance)) + 1e-6
        total = np.concatenate([[0.0], np.cumsum(effort)])
        count = max(8, math.ceil(float(total[-1])))
        places = np.interp(np.linspace(0.0, float(total[-1]), count + 1), total, probes)
        places[-1] = end
        if not strokes.jump[k]:
            extra = [_beside(pair, start, end) for pair in undercut]
            places = np.unique(np.concatenate([places, *extra]))
        number.append(np.full(len(places) - 1, k))
        low.append(places[:-1])
        high.append(places[1:])
    stroke, lows = np.concatenate(number), np.concatenate(low)
    return _Chords(
        stroke=stroke, low=lows, high=np.concatenate(high), points=strokes.at(stroke, lows)[0]
    )


def _beside(stretch: tuple[float, float], start: float, end: float) -> Array:
    """Return places in and beside an undercut stretch that lie within a sweep."""
    low, high = stretch
    more = _BESIDE * (high - low)
    places = np.linspace(low - more, high + more, _AROUND)
    turns = 2.0 * math.pi * np.array([-1.0, 0.0, 1.0])
    shifted = (places + turns[:, None]).ravel()
    return shifted[(shifted > start) & (shifted < end)]


def _chains(chords: _Chords) -> list[tuple[int, int]] | None:
    """Return the vertices, from first to past last, of each piece of the face about the axis.

    None where a piece between two crossings has no vertex of its own: chords are too long.
    """
    from shapely import LinearRing, Point, get_parts, polygonize, unary_union

    points, count = chords.points, len(chords.points)
    ring = LinearRing(np.column_stack([points.real, points.imag]))
    if ring.is_simple:
        return [(0, count)]
    faces = get_parts(polygonize(get_parts(unary_union(ring))))
    axis = Point(0.0, 0.0)
    face = next((face for face in faces if face.contains(axis)), None)
    if face is None:
        return None
    edge = np.asarray(face.exterior.coords)[:-1] @ [1.0, 1j]
    places = {complex(point): k for k, point in enumerate(points)}
    numbers = [places.get(complex(point), -1) for point in edge]
    steps = [
        b - a for a, b in zip(numbers, [*numbers[1:], numbers[0]], strict=True) if min(a, b) >= 0
    ]
    if sum(step == 1 for step in steps) < sum(step == -1 for step in steps):
        numbers.reverse()
    return _runs(numbers, count)


def _runs(numbers: list[int], count: int) -> list[tuple[int, int]] | None:
    """Return runs of consecutive vertices in a ring; -1 stands for a crossing."""
    before = [numbers[-1], *numbers[:-1]]
    pairs = list(zip(before, numbers, strict=True))
    if any(max(pair) < 0 for pair in pairs):
        return None
    starts = [k for k, (a, b) in enumerate(pairs) if b >= 0 and (a < 0 or b != (a + 1) % count)]
    if not starts:
        return [(0, count)]
    runs = []
    for start, stop in zip(starts, [*starts[1:], starts[0] + len(numbers)], strict=True):
        crossing = numbers[(stop - 1) % len(numbers)] < 0
        runs.append((numbers[start], numbers[start] + stop - start - crossing))
    return runs


def _cut(
    strokes: Strokes, chords: _Chords, chains: list[tuple[int, int]]
) -> tuple[Strokes, tuple[Corner, ...]] | None:
    """Find the crossings on the true curves and return the strokes between them."""
    count, size = len(chords.points), float(np.abs(chords.points).max())
    cuts = []
    for (_, stop), (begin, _) in zip(chains, [*chains[1:], chains[0]], strict=True):
        leave, enter = (stop - 1) % count, (begin - 1) % count
        found = _crossing(strokes, chords, leave, enter, _MISS * size)
        if found is None:
            return None
        cuts.append(found)
    return cut_out(strokes, cuts)


def cut_out(
    strokes: Strokes, cuts: Sequence[tuple[Place, Place]]
) -> tuple[Strokes, tuple[Corner, ...]]:
    """Return what is left of a curve without the stretches between pairs of places.

    Parameters
    ----------
    strokes : Strokes
        The whole curve.
    cuts : sequence of (Place, Place)
        Places that are one point, in the order of drawing: what is between them is left out.

    Returns
    -------
    strokes : Strokes
        What is left, beginning at a corner.
    corners : tuple of Corner
        In the order of `cuts`.
    """
    corners = []
    for pair in cuts:
        index, places = np.array([k for k, _ in pair]), np.array([place for _, place in pair])
        before, after = strokes.states(index, places)[0].tolist()
        point = complex(strokes.at(index, places)[0][0])
        corners.append(Corner(point=point, before=before, after=after))
    rows: list[Row] = []
    for (_, begin), (end, _) in zip([cuts[-1], *cuts[:-1]], cuts, strict=True):
        rows += between(strokes, begin, end)
    order, start, end, corner = zip(*rows, strict=True)
    index = np.array(order)
    kept = replace(
        strokes,
        piece=strokes.piece[index],
        start=np.array(start),
        end=np.array(end),
        jump=strokes.jump[index],
        corner=np.array(corner),
    )
    return kept, tuple(corners)


def between(strokes: Strokes, begin: Place, end: Place) -> list[Row]:
    """Return the strokes from one place to another, in the order of drawing.

    Parameters
    ----------
    strokes : Strokes
        A closed curve.
    begin, end : Place
        Where they begin and end.

    Returns
    -------
    list of Row
    """
    rows: list[Row] = []
    k, start, first = begin[0], begin[1], True
    while not (k == end[0] and (not first or end[1] >= start)):
        rows.append((k, start, float(strokes.end[k]), first or bool(strokes.corner[k])))
        k, first = (k + 1) % len(strokes.start), False
        start = float(strokes.start[k])
    rows.append((k, start, end[1], first or bool(strokes.corner[k])))
    return rows


def _crossing(
    strokes: Strokes, chords: _Chords, leave: int, enter: int, miss: float
) -> tuple[Place, Place] | None:
    """Find where two chords' curves cross, by Newton steps that stay near the chords."""
    index = chords.stroke[[leave, enter]]
    low, high = chords.low[[leave, enter]], chords.high[[leave, enter]]
    room = 2.0 * (high - low)
    least, most = np.minimum(low, high) - np.abs(room), np.maximum(low, high) + np.abs(room)
    ends = np.sort([strokes.start[index], strokes.end[index]], axis=0)
    least, most = np.maximum(least, ends[0]), np.minimum(most, ends[1])
    place = 0.5 * (low + high)
    best, gap = place, math.inf
    for _ in range(_STEPS):
        points, slopes = strokes.moving(index, place)
        apart = complex(points[1] - points[0])
        if abs(apart) < gap:
            best, gap = place, abs(apart)
        # points[0] + a*slopes[0] = points[1] + b*slopes[1]
        cross = (np.conj(slopes[0]) * slopes[1]).imag
        if cross == 0.0:
            break
        a = (np.conj(apart) * slopes[1]).imag / cross
        b = (np.conj(apart) * slopes[0]).imag / cross
        new = np.clip(place + np.array([a, b]), least, most)
        if np.all(new == place):
            break
        place = new
    # angles are rounded too
    if gap > miss + _ANGLE * float(np.abs(strokes.moving(index, best)[1]).max()):
        return None
    first, second = ((int(k), float(p)) for k, p in zip(index, best, strict=True))
    return first, second
