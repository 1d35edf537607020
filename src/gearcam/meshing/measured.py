"""Measured outlines: how far wheels turn each other whose teeth were measured.

A measured outline is a closed polygon in the wheel's frame, read from a file of points. It is cut
into half-teeth where the wheel's own are (see `gearcam.meshing.half_teeth`), at the points nearest
to their ends, and so its teeth have their numbers.

With the driver held at a phase, vertices of its half-teeth are compared with edges of the mate at
equal heights relative to the guide of the driven wheel, and the mate's vertices with the driver's
edges: polygons touch first with a vertex of one of them. The extreme of the turns between them is
the driven wheel's lead, as `gearcam.meshing.edges` finds it for flanks; it is exact for the
polygons.

Refused: an outline that crosses itself, or that is not near the wheel's own everywhere, with the
likely cause: its unit, origin, rotation, number of teeth, or a part that is missing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Final

import numpy as np
import shapely

from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted
from gearcam.gears.contact import FlankPairs
from gearcam.gears.rolling import Guide
from gearcam.meshing.edges import of_leading_pair
from gearcam.meshing.half_teeth import HalfTeeth
from gearcam.meshing.overlap import Turning
from gearcam.numeric.arrays import Array, Ints, Plane, as_complex, as_pairs, lengths_along

_NEAR: Final = 0.4
"""Largest distance between the measured outline and the wheel's own, in modules: a flank that is
further away belongs to another tooth."""

_OPENED: Final = 1.25
"""Radius, in modules, of the disc that fits into a wheel but into none of its teeth."""

_COARSE: Final = 0.02
"""Tolerance, in modules, with which teeth are counted."""

_TOOTH: Final = 0.3
"""Least area of a tooth, in squared modules."""

_INCH: Final = 25.4
_SCALED: Final = 0.03
"""Difference of sizes, as a share, that no error of making explains."""

_ANGLES: Final = 1 << 19
"""Least number of rotations that are tried to find out by how much an outline is turned."""

_AS_NEAR: Final = 0.01
"""Difference of radii, in modules, with which rotations fit equally well."""

_SMALL: Final = 0.1
"""Distance, in modules, that is too small to be a cause."""

_CHORDS: Final = 0.9
"""Share of the chords whose error is not exceeded."""

_STEPS: Final = 3
"""Newton's steps to the place of a height on an edge; the error is squared in each."""


def demand_near(outline: Plane, own: Plane, module: float, key: str) -> float:
    """Refuse a measured outline that cannot be that of the wheel.

    Parameters
    ----------
    outline : (n,) complex array, mm
        The measured outline.
    own : (m,) complex array, mm
        The wheel's own.
    module : float, mm
        The module.
    key : str
        The key of its file.

    Returns
    -------
    float, mm
        Largest distance of its points from the wheel's own outline.

    Raises
    ------
    InfeasibleError
        With the likely cause.
    """
    shape = _polygon(outline, key)
    edge, limit = shapely.Polygon(as_pairs(own)).exterior, _NEAR * module
    off = _distances(outline, edge)
    missing = _distances(own, shape.exterior)
    if max(off.max(), missing.max()) <= limit:
        return float(off.max())
    found = _cause(outline, own, module) if off.max() > limit else _gap(outline, own, missing)
    raise InfeasibleError(
        f"the measured outline {found}",
        where=key,
        value=float(max(off.max(), missing.max())),
        limit=limit,
        unit="mm",
        nearest="its points are in mm, in the wheel's own coordinates, as in its CSV file",
    )


def _polygon(outline: Plane, key: str) -> Any:
    """Return an outline as a polygon; refuse one that crosses itself."""
    if len(outline) < 3:
        raise InfeasibleError("the measured outline has fewer than three points", where=key)
    shape = shapely.Polygon(as_pairs(outline))
    if not shape.is_valid:
        reason = shapely.is_valid_reason(shape).replace("[", " at (").replace("]", ")")
        raise InfeasibleError(
            f"the measured outline crosses itself: {reason}",
            where=key,
            nearest="a closed outline, its points in order",
        )
    return shape


def _distances(points: Plane, edge: Any) -> Array:
    """Return the distances of points from an outline."""
    shapely.prepare(edge)
    found: Array = shapely.distance(shapely.points(points.real, points.imag), edge)
    return found


def _gap(outline: Plane, own: Plane, missing: Array) -> str:
    """Return what is said of an outline of which a part is missing."""
    worst = own[int(missing.argmax())]
    ends = outline[[-1, 0]]
    closing = shapely.LineString(as_pairs(ends))
    others = shapely.LineString(as_pairs(outline))
    point = shapely.Point(worst.real, worst.imag)
    if closing.distance(point) < others.distance(point):
        return (
            f"is open: its last point is {formatted(abs(ends[1] - ends[0]), 3)} mm from its first"
        )
    return f"lacks a part near x = {formatted(worst.real, 4)}, y = {formatted(worst.imag, 4)} mm"


def _cause(outline: Plane, own: Plane, module: float) -> str:
    """Return what is said of an outline that is far from the wheel's own."""
    sizes = [shapely.Polygon(as_pairs(one)).area ** 0.5 for one in (outline, own)]
    scale = sizes[0] / sizes[1]
    if abs(scale * _INCH - 1.0) <= _SCALED:
        return f"is in inches: it is {formatted(scale, 3)} times as large as the wheel"
    teeth = _teeth(outline / scale, module), _teeth(own, module)
    if teeth[0] != teeth[1]:
        return f"has {teeth[0]} teeth; that of the wheel has {teeth[1]}"
    if abs(scale - 1.0) > _SCALED:
        return f"is {formatted(scale, 3)} times as large as the wheel"
    return _misplaced(outline, own, module, teeth[1])


def _teeth(outline: Plane, module: float) -> int:
    """Return the number of teeth of an outline: what a disc does not reach from inside."""
    whole = shapely.Polygon(as_pairs(outline)).simplify(_COARSE * module)
    radius = _OPENED * module
    rest = whole - whole.buffer(-radius).buffer(1.001 * radius)
    return int(np.sum(shapely.area(shapely.get_parts(rest)) > _TOOTH * module**2))


def _misplaced(outline: Plane, own: Plane, module: float, teeth: int) -> str:
    """Return by how much an outline is off centre and turned, if that brings it to the wheel."""
    middles = [shapely.Polygon(as_pairs(each)).centroid for each in (outline, own)]
    middles = [complex(middle.x, middle.y) for middle in middles]
    centred, wanted = outline - middles[0], own - middles[1]
    edge = shapely.LinearRing(as_pairs(wanted))
    small, limit = _SMALL * module, _NEAR * module
    turns = _best_turns(centred, wanted, module, teeth)
    # the likely cause: the least offset, and then the least angle
    offsets = np.abs(middles[0] - middles[1] * np.exp(-1j * turns)) // small
    best = float(turns[np.lexsort([np.abs(turns), offsets])[0]])
    off = float(_distances(centred * np.exp(1j * best), edge).max())
    if off > small:  # a symmetric wheel fits as well from the other side
        flipped = _best_turns(centred.conj(), wanted, module, teeth)[0]
        mirrored = float(_distances(centred.conj() * np.exp(1j * flipped), edge).max())
        if mirrored <= min(limit, off - small):
            return "is mirrored: it is that of the wheel seen from the other side"
    if off > limit:
        worst = outline[int(_distances(centred, edge).argmax())]
        place = f"x = {formatted(worst.real, 4)}, y = {formatted(worst.imag, 4)} mm"
        return f"is not that of this wheel, at {place} above all"
    turned = -math.remainder(best, 2.0 * math.pi)
    offset = middles[0] - middles[1] * np.exp(1j * turned)
    causes = []
    if abs(offset) > small:
        causes.append(
            f"off centre by x = {formatted(offset.real, 3)}, y = {formatted(offset.imag, 3)} mm"
        )
    if abs(turned) * np.abs(own).max() > small:
        causes.append(f"turned by {formatted(math.degrees(turned), 3)} deg")
    return "is " + " and ".join(causes or ["too far from that of the wheel"])


def _best_turns(outline: Plane, own: Plane, module: float, teeth: int) -> Array:
    """Return the angles, rad, that turn an outline nearest to another: the best, and its like."""
    count = teeth * math.ceil(_ANGLES / teeth)
    angles = 2.0 * math.pi * np.arange(count) / count
    radii, wanted = (
        np.interp(angles, np.angle(points), np.abs(points), period=2.0 * math.pi)
        for points in (outline, own)
    )
    # root mean squares of the differences of radii after each turn, by Fourier transforms
    product = np.fft.irfft(np.fft.rfft(wanted) * np.fft.rfft(radii).conj(), count)
    square = np.mean(radii**2 + wanted**2) - 2.0 * product / count
    misfit = np.sqrt(np.maximum(square, 0.0))
    # a round wheel fits after each tooth, one with lobes after each of them
    like = (misfit.argmin() + count // teeth * np.arange(teeth)) % count
    turns = angles[like[misfit[like] <= misfit.min() + _AS_NEAR * module]]
    return np.where(turns > math.pi, turns - 2.0 * math.pi, turns)


def chord_error(outline: Plane, own: Plane) -> float:
    """Return how far the true outline may lie beside the chords of a measured one.

    Parameters
    ----------
    outline : (n,) complex array, mm
        The measured outline.
    own : (m,) complex array, mm
        The wheel's own.

    Returns
    -------
    float, mm
        How much further from the wheel's own outline the middle of a chord is than its ends, for
        nine chords in ten: at corners of the tips chords say nothing of the flanks.
    """
    shape = shapely.Polygon(as_pairs(own))
    edge = shape.exterior

    def beside(points: Plane) -> Array:
        inside = shapely.contains_xy(shape, points.real, points.imag)
        return np.where(inside, -1.0, 1.0) * _distances(points, edge)

    ends, following = beside(outline), np.roll(outline, -1)
    sagitta = beside(0.5 * (outline + following)) - 0.5 * (ends + np.roll(ends, -1))
    return float(np.quantile(np.abs(sagitta), _CHORDS))


def as_half_teeth(outline: Plane, own: HalfTeeth, chord_error: float) -> HalfTeeth:
    """Return a measured outline as half-teeth.

    Parameters
    ----------
    outline : (n,) complex array, mm
        A closed outline near the wheel's own.
    own : HalfTeeth
        The wheel's own.
    chord_error : float, mm
        See `chord_error`.

    Returns
    -------
    HalfTeeth
    """
    ring: Any = shapely.LinearRing(as_pairs(outline))
    corners = as_complex(ring.coords)
    way = lengths_along(corners)
    parts = []
    for start, end in zip(own.starts[:-1], own.starts[1:], strict=True):
        if len(parts) == own.count:  # the body of an open wheel
            parts.append(own.points[start:end])
            continue
        tip, root = (
            float(ring.project(shapely.Point(point.real, point.imag)))
            for point in own.points[[start, end - 3]]
        )
        parts.append(np.concatenate([_between(corners, way, tip, root), own.points[end - 2 : end]]))
    return replace(
        own,
        points=np.concatenate(parts),
        starts=np.cumsum([0, *map(len, parts)]),
        tips=np.array([part[0] for part in parts[: own.count]]),
        chord_error=chord_error,
    )


def _between(corners: Plane, way: Array, first: float, last: float) -> Plane:
    """Return the points of a closed line from one place on it to another, the shorter way."""
    whole = way[-1]
    ahead = (last - first) % whole
    if ahead > 0.5 * whole:
        return _between(corners, way, last, first)[::-1]
    end = first + ahead
    along = np.concatenate([way[:-1], way[:-1] + whole])
    inside = np.flatnonzero((along > first) & (along < end))
    places = np.concatenate([[first], along[inside], [end]]) % whole
    return np.interp(places, way, corners)


def outline_leads(turning: Turning, pairs: FlankPairs, phi1: Array) -> Array:
    """Return the driven wheel's lead at first contact of outlines.

    Parameters
    ----------
    turning : Turning
        The half-teeth of both wheels.
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.

    Returns
    -------
    (n,) array, rad, for a rack mm
        Infinite where nothing touches (see `gearcam.meshing.edges.first_touch`).
    """
    step, pair = pairs.beside(phi1)
    half = 2 * pair - (pairs.side < 0)
    one, two = turning.driver.index(half), turning.driven.index(half)
    real = (one >= 0) & (two >= 0)
    step, one, two = step[real], one[real], two[real]
    pose, guide = turning.pose(phi1, 0.0), pairs.guide
    steps, turns = [np.empty(0, dtype=np.int64)], [np.empty(0)]
    for first, second in np.unique(np.stack([one, two], axis=1), axis=0).tolist():
        phases = step[(one == first) & (two == second)]
        mine = pose[phases][:, None].apply(_line(turning.driver, first))
        for row, turn in _comparisons(guide, mine, _line(turning.driven, second)):
            steps.append(phases[row])
            turns.append(turn)
    outward = of_leading_pair(pairs.side, len(phi1), np.concatenate(steps), np.concatenate(turns))
    return -pairs.side * outward


def _line(wheel: HalfTeeth, number: int) -> Plane:
    """Return the outline of a half-tooth, without the points below it."""
    return wheel.points[wheel.starts[number] : wheel.starts[number + 1] - 2]


def _comparisons(guide: Guide, mine: Plane, mate: Plane) -> Iterator[tuple[Ints, Array]]:
    """Yield rows of a driver's line, (m, n), and the turns that bring the mate's line to it.

    From the driver's vertices to the mate's edges, and from the driver's edges to its vertices.
    """
    mates = np.broadcast_to(mate, (len(mine), len(mate)))
    row, vertex, edge = _facing(guide, mine, mates, 1)
    yield row, guide.turn(mine[row, vertex], _at_height(guide, mates, row, edge, mine[row, vertex]))
    row, vertex, edge = _facing(guide, mates, mine, -1)
    yield row, guide.turn(_at_height(guide, mine, row, edge, mate[vertex]), mate[vertex])


def _facing(guide: Guide, vertices: Plane, line: Plane, rises: int) -> tuple[Ints, Ints, Ints]:
    """Return rows, vertices and edges of lines such that an edge has the height of the vertex.

    From tip to root the heights of the driver's line rise (`rises` is 1 for its vertices), and
    those of the mate's fall. Where they do the opposite, as on lands that are oblique to the circle
    about the driven shaft, the metal is on the other side, and nothing touches.
    """
    height, ends = guide.height(vertices), guide.height(line)
    flank = np.pad(rises * np.diff(height) > 0.0, ((0, 0), (1, 1)))
    outer = (flank[:, 1:] | flank[:, :-1])[:, :, None]
    low, high = (ends[:, 1:], ends[:, :-1])[::rises]
    low, high, height = low[:, None], high[:, None], height[:, :, None]
    row, vertex, edge = np.nonzero(outer & (low <= height) & (height <= high) & (low < high))
    return row, vertex, edge


def _at_height(guide: Guide, line: Plane, row: Ints, edge: Ints, points: Plane) -> Plane:
    """Return the points of edges at the heights of others."""
    start, along = line[row, edge], line[row, edge + 1] - line[row, edge]
    height = guide.height(points)
    low, high = guide.height(start), guide.height(start + along)
    place = (height - low) / (high - low)
    for _ in range(_STEPS):
        at = start + place * along
        slope = guide.rates(at, along)[0]
        step = (height - guide.height(at)) / np.where(slope == 0.0, np.inf, slope)
        place = np.clip(place + step, 0.0, 1.0)
    return start + place * along
