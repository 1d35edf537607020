"""Triangles that fill a region, small where they are asked to be.

The size of triangles is ``h(x) = min(largest, min_j(h_j + 0.3*|x - x_j|))`` for *sources* x_j of
size h_j. Boundary vertices are placed by the integral of 1/h along each curve, corners always.
Inside, points of hexagonal lattices of spacing ``largest/2^k`` are joined by Delaunay's
triangulation; centres of circles around bad triangles are added, and the points are smoothed. A
boundary edge that the triangulation has not is halved, and the triangles are made anew.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, as_pairs, bounds, divided
from gearcam.stress.region import BoundaryCurve, Region
from gearcam.stress.size_field import SizeField, mesh_corners, shape_sources

_SLOPE: Final = cmath.exp(1j * math.pi / 3.0)
"""Second direction of a hexagonal lattice, the first being 1."""

_FEWEST: Final = 4
"""Fewest vertices of a curve."""

_FINE: Final = 0.5
"""Largest step in integrating 1/h, over h."""

_THIN: Final = 0.72
"""Least distance of a new point from others, over h."""

_BAND: Final = 1.2
"""Largest spacing of a lattice over h."""

_SPLIT: Final = 1.1
"""Size over a lattice's spacing below which parts of the cell may need the next lattice."""

_WIDE: Final = 0.78
"""Circumradius over h above which a triangle is too large."""

_SLIM: Final = 1.25
"""Circumradius over the shortest edge above which a triangle is bad, its smallest angle being below
24 degrees."""

_SMALL: Final = 0.35
"""Circumradius over h up to which a triangle is not divided."""

_COMPARED: Final = 8
"""New points among which the nearest ones are compared."""

_INSERTIONS: Final = 3
"""Largest number of rounds in which circumcentres are added."""

_SMOOTHINGS: Final = 12
"""Rounds of smoothing."""

_ANEW: Final = 3
"""Rounds of smoothing after which points are joined anew."""

_MORE: Final = 4
"""Largest factor by which the halving of dropped edges may increase the boundary vertices."""

_AREA: Final = 1e-9
"""Relative difference of the area of the triangles from that of the polygon: rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class TriangleMesh(ShortRepr):
    """Triangles that fill the polygon of points on the boundary of a region.

    Parameters
    ----------
    region : Region
        What is meshed.
    points : (n,) complex array, mm
        Vertices: those on the boundary first, in order along each curve.
    triangles : (m, 3) int array
        Vertices of each triangle, counter-clockwise.
    curve : (b,) int array
        Number, in ``region.curves``, of the curve of each boundary vertex.
    start, end : (b,) arrays, mm
        The edge from each boundary vertex to the next along its curve: s at both ends. The start is
        below the curve's length, the end may be beyond it.
    follows : (b,) int array
        The next boundary vertex.
    """

    region: Region
    points: Plane
    triangles: Ints
    curve: Ints
    start: Array
    end: Array
    follows: Ints

    @property
    def edges(self) -> Ints:
        """Vertices of the boundary edges, (b, 2), the metal to their left."""
        return np.column_stack([np.arange(len(self.follows)), self.follows])


def graded(region: Region, points: Plane, sizes: Array, largest: float) -> TriangleMesh:
    """Return triangles that fill a region.

    Parameters
    ----------
    region : Region
        What is meshed.
    points : (n,) complex array, mm
        Sources of the size of triangles, none or more: anywhere.
    sizes : (n,) array, mm
        Sizes there, above 0.
    largest : float, mm
        Largest size.

    Returns
    -------
    TriangleMesh

    Raises
    ------
    RuntimeError
        If the triangles do not fill the polygon of the boundary: a bug.
    """
    shape = shape_sources(region, largest)
    field = SizeField(
        points=np.concatenate([points, shape[0]]),
        sizes=np.concatenate([sizes, shape[1]]),
        largest=largest,
    )
    border = _bordered(region, field)
    wanted = _candidates(field, border.points)
    most = _MORE * len(border.points)
    while len(border.points) <= most:
        made = _filled(border, *wanted)
        if not made.dropped.any():
            return _proven(region, border, made)
        border = border.halved(region, made.dropped)
    raise RuntimeError("boundary edges are dropped however short they are: do curves cross?")


@dataclass(frozen=True, eq=False, kw_only=True)
class _Border:
    """Boundary edges, each from a vertex to the next; fields as of `TriangleMesh`."""

    points: Plane
    curve: Ints
    start: Array
    end: Array

    @cached_property
    def follows(self) -> Ints:
        last = np.append(np.diff(self.curve) != 0, True)
        made = np.arange(1, len(self.curve) + 1)
        first = np.flatnonzero(np.append(True, last[:-1]))
        made[last] = first
        return made

    @cached_property
    def before(self) -> Ints:
        made = np.empty_like(self.follows)
        made[self.follows] = np.arange(len(made))
        return made

    @cached_property
    def tree(self) -> Any:
        from scipy.spatial import KDTree

        return KDTree(as_pairs(self.points))

    def halved(self, region: Region, some: Mask) -> _Border:
        """Return the border with `some` of its edges halved."""
        middles = 0.5 * (self.start + self.end)
        parts = np.repeat(np.arange(len(some)), 1 + some)
        second = np.append(False, parts[1:] == parts[:-1])
        first = np.append(second[1:], False)
        start = np.where(second, middles[parts], self.start[parts])
        end = np.where(first, middles[parts], self.end[parts])
        return _border(region, self.curve[parts], start, end)

    def away(self, points: Plane) -> Array:
        """Return the distances of points, (k,), to the nearest vertex."""
        made: Array = self.tree.query(as_pairs(points))[0]
        return made

    def clear(self, points: Plane) -> Mask:
        """Return whether points, (k,), are in the metal, outside the circles on boundary edges.

        It is enough to look at the two edges of the nearest vertex: no edge is much longer than its
        neighbours.
        """
        _, nearest = self.tree.query(as_pairs(points))
        on = self.points[nearest]
        back, ahead = self.points[self.before[nearest]], self.points[self.follows[nearest]]
        left = [(np.conj(edge) * (points - on)).imag > 0.0 for edge in (on - back, ahead - on)]
        convex = (np.conj(on - back) * (ahead - on)).imag > 0.0
        inside = np.where(convex, left[0] & left[1], left[0] | left[1])
        for end in (back, ahead):
            inside &= np.abs(points - 0.5 * (on + end)) > 0.5 * np.abs(end - on)
        return inside


def _border(region: Region, curve: Ints, start: Array, end: Array) -> _Border:
    points = np.empty(len(curve), dtype=np.complex128)
    turns = np.floor(start / np.array([one.length for one in region.curves])[curve])
    for number, one in enumerate(region.curves):
        here = curve == number
        points[here] = one.at(start[here])[0]
        turns[here] *= one.length
    return _Border(points=points, curve=curve, start=start - turns, end=end - turns)


def _bordered(region: Region, field: SizeField) -> _Border:
    """Return the border with vertices by the integral of 1/h."""
    places = [_places(curve, field) for curve in region.curves]
    curve = np.repeat(np.arange(len(places)), [len(s) - 1 for s in places])
    start = np.concatenate([s[:-1] for s in places])
    end = np.concatenate([s[1:] for s in places])
    return _border(region, curve, start, end)


def _places(curve: BoundaryCurve, field: SizeField) -> Array:
    """Return s of the vertices of a curve, the first repeated a turn later."""
    corners = mesh_corners(curve, field.largest)
    first = corners if len(corners) else np.zeros(1)
    ends = np.append(first, first[0] + curve.length)
    s = divided(ends, np.ceil(np.diff(ends) / field.largest).astype(np.int64))
    h = field.at(curve.at(s)[0])
    while True:
        long = np.flatnonzero(np.diff(s) > _FINE * np.minimum(h[1:], h[:-1]))
        if not len(long):
            break
        middles = 0.5 * (s[long] + s[long + 1])
        h = np.insert(h, long + 1, field.at(curve.at(middles)[0]))
        s = np.insert(s, long + 1, middles)
    steps = 0.5 * np.diff(s) * (1.0 / h[1:] + 1.0 / h[:-1])
    density = np.append(0.0, np.cumsum(steps))
    at_ends = np.interp(ends, s, density)
    counts = np.ceil(np.diff(at_ends)).astype(np.int64)
    counts *= math.ceil(_FEWEST / counts.sum())
    made = np.interp(divided(at_ends, counts), density, s)
    made[np.cumsum(np.append(0, counts))] = ends
    return made


def _candidates(field: SizeField, around: Plane) -> tuple[list[Plane], list[Array]]:
    """Return lattice points by level, the finest first, with their sizes, of a box of points."""
    low, high = bounds(around)
    step = field.largest
    size = high - low
    rows = np.arange(math.ceil(size.imag / (step * _SLOPE.imag)) + 1)
    columns = np.arange(-1, math.ceil(size.real / step) + 1)  # cells lean to the right
    points = (
        low + step * (columns + (rows % 2)[:, None] / 2 + 1j * _SLOPE.imag * rows[:, None])
    ).ravel()
    h = field.at(points)
    found, sizes = [], []
    while len(points):
        here = (h >= step / _BAND) & (h < 2.0 * step / _BAND)
        found.append(points[here])
        sizes.append(h[here])
        parts = h < _SPLIT * step
        points, h = points[parts], h[parts]
        step *= 0.5
        new = (points[:, None] + step * np.array([1.0, _SLOPE, 1.0 + _SLOPE])).ravel()
        points, h = np.concatenate([points, new]), np.concatenate([h, field.at(new)])
    return found[::-1], sizes[::-1]


@dataclass(frozen=True, eq=False, kw_only=True)
class _Joined:
    """Points joined to triangles, those of the metal, and which boundary edges they have not."""

    points: Plane
    triangles: Ints
    dropped: Mask


def _joined(border: _Border, inner: Plane) -> _Joined:
    """Return the triangles of Delaunay between the boundary vertices and others."""
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import Delaunay

    points = np.concatenate([border.points, inner])
    made = Delaunay(as_pairs(points))
    triangles, n, b = made.simplices.astype(np.int64), len(points), np.arange(len(border.follows))
    sides = (triangles[:, [1, 2, 0]] * n + triangles[:, [2, 0, 1]]).ravel()
    order = np.argsort(sides)

    def side(start: Ints, end: Ints) -> tuple[Ints, Mask]:
        place = order[np.minimum(np.searchsorted(sides[order], start * n + end), len(order) - 1)]
        return place, sides[place] == start * n + end

    (left, there), (right, beyond) = side(b, border.follows), side(border.follows, b)
    if not there.all():
        return _Joined(points=points, triangles=triangles, dropped=~there)
    neighbours = made.neighbors.ravel().copy()
    neighbours[left] = -1
    neighbours[right[beyond]] = -1
    linked = np.flatnonzero(neighbours >= 0)
    m = len(triangles)
    graph = csr_matrix((np.ones(len(linked)), (linked // 3, neighbours[linked])), shape=(m, m))
    _, label = connected_components(graph, directed=False)
    metal = np.isin(label, label[left // 3])
    return _Joined(points=points, triangles=triangles[metal], dropped=~there)


def _filled(border: _Border, wanted: list[Plane], sizes: list[Array]) -> _Joined:
    """Return the triangles of a border with points inside, or which edges they drop."""
    made = _joined(border, np.empty(0, dtype=np.complex128))
    if made.dropped.any():
        return made
    inner, h = _thinned(border, wanted, sizes)
    edge = np.abs(border.points[border.follows] - border.points)
    on = 0.5 * (edge + edge[border.before])
    for _ in range(_INSERTIONS):
        made = _joined(border, inner)
        if made.dropped.any():
            return made
        new, size = _centers(border, made, np.concatenate([on, h]))
        if not len(new):
            break
        inner, h = np.concatenate([inner, new]), np.concatenate([h, size])
    for turn in range(_SMOOTHINGS):
        if turn and turn % _ANEW == 0:
            made = _joined(border, inner)
            if made.dropped.any():
                return made
        points = np.concatenate([border.points, inner])
        inner = _smoothed(made.triangles, points, np.concatenate([on, h]))[len(on) :]
    return _joined(border, inner)


def _thinned(border: _Border, wanted: list[Plane], sizes: list[Array]) -> tuple[Plane, Array]:
    """Return the points of lattices, with their sizes, that are inside and not too near others."""
    from scipy.spatial import KDTree

    inner, size = np.empty(0, dtype=np.complex128), np.empty(0)
    for points, h in zip(wanted, sizes, strict=True):
        kept = border.clear(points) & (border.away(points) > _THIN * h)
        points, h = points[kept], h[kept]
        if len(inner) and len(points):
            away, _ = KDTree(as_pairs(inner)).query(as_pairs(points))
            points, h = points[away > _THIN * h], h[away > _THIN * h]
        inner, size = np.concatenate([inner, points]), np.concatenate([size, h])
    return inner, size


def _centers(border: _Border, made: _Joined, h: Array) -> tuple[Plane, Array]:
    """Return circumcentres of bad triangles, with sizes there, that are not near each other."""
    from scipy.spatial import KDTree

    corners = made.points[made.triangles]
    size = h[made.triangles].mean(axis=1)
    one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    twice = (np.conj(one) * other).imag
    away = one * other * np.conj(one - other) / (2j * np.maximum(twice, np.finfo(float).tiny))
    shortest = np.abs(corners - np.roll(corners, 1, axis=1)).min(axis=1)
    radius = np.abs(away)
    bad = (radius > _WIDE * size) | ((radius > _SLIM * shortest) & (radius > _SMALL * size))
    points, radius, size = corners[bad, 0] + away[bad], radius[bad], size[bad]
    kept = border.clear(points)
    points, radius, size = points[kept], radius[kept], size[kept]
    if len(points) < 2:
        return points, size
    # of those near each other the one in the largest circle, that is farthest from all points
    near, which = KDTree(as_pairs(points)).query(as_pairs(points), k=min(_COMPARED, len(points)))
    rank = np.argsort(np.argsort(radius, kind="stable"), kind="stable")
    beaten = (near < _THIN * size[:, None]) & (rank[which] > rank[:, None])
    kept = ~beaten.any(axis=1)
    return points[kept], size[kept]


def _smoothed(triangles: Ints, points: Plane, h: Array) -> Plane:
    """Return points moved to the mean of the centres of their triangles, weighted by number."""
    corners = points[triangles]
    area = 0.5 * (np.conj(corners[:, 1] - corners[:, 0]) * (corners[:, 2] - corners[:, 0])).imag
    weight = np.maximum(area, 0.0) / h[triangles].mean(axis=1) ** 2
    center = weight * corners.mean(axis=1)
    at, n = triangles.ravel(), len(points)
    total = np.bincount(at, np.repeat(weight, 3), n)
    x, y = (np.bincount(at, np.repeat(part, 3), n) for part in (center.real, center.imag))
    made = points.copy()
    used = total > 0.0
    made[used] = (x[used] + 1j * y[used]) / total[used]
    return made


def _proven(region: Region, border: _Border, made: _Joined) -> TriangleMesh:
    """Return the mesh, after its area was held against that of the polygon of its boundary."""
    count = len(border.follows)
    used = np.zeros(len(made.points), dtype=bool)
    used[made.triangles] = True
    used[:count] = True
    number = np.cumsum(used) - 1
    corners = made.points[made.triangles]
    twice = (np.conj(corners[:, 1] - corners[:, 0]) * (corners[:, 2] - corners[:, 0])).imag
    edge = border.points[border.follows]
    polygon = float((np.conj(border.points) * edge).imag.sum())
    if twice.min() <= 0.0 or abs(twice.sum() - polygon) > _AREA * polygon:
        raise RuntimeError("triangles do not fill the region that they were made for")
    return TriangleMesh(
        region=region,
        points=made.points[used],
        triangles=number[made.triangles],
        curve=border.curve,
        start=border.start,
        end=border.end,
        follows=border.follows,
    )
