"""How large triangles are: sources of sizes, and the field that they make.

The size is ``h(x) = min(largest, min_j(h_j + 0.3*|x - x_j|))`` for *sources* x_j of size h_j. The
shape of a region has sources of its own: bends, short pieces between corners, and metal between
two curves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Plane, apart, as_pairs, distinct
from gearcam.stress.region import BoundaryCurve, Region

GROWTH: Final = 0.3
"""Increase of the size of triangles over the distance from a source."""

LARGEST: Final = 2.5
"""Usual size of triangles far inside, in modules."""

FILLET: Final = 0.14
"""Usual size in the fillets of a loaded tooth, in modules."""

OUTLINE: Final = 0.6
"""Usual size on the rest of the outline, in modules."""

CONCAVE: Final = 4.0
"""Radius, in modules, below which a concave place of the outline belongs to a fillet."""

_PER_CURVATURE: Final = 0.9
"""Largest turn of a boundary edge, rad."""

_PER_GAP: Final = 0.7
"""Largest size over the distance to another curve."""

_LEAST: Final = 0.008
"""Least size that the shape asks for, over the largest: tighter bends are meshed as corners, and
corners nearer to each other as one."""

_SHARP: Final = 0.1
"""Least turn of a tight bend that is meshed as a corner, rad."""

_GAPS: Final = 1000
"""Places of each curve whose distance to other curves is looked at."""

_GRAIN: Final = 0.25
"""Distance between sources at bends, over their size."""

_APART: Final = 0.5
"""Distance between sources on the outline, over their size."""

_BIN: Final = 1.12
"""Ratio of sizes of sources that are searched together."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SizeField(ShortRepr):
    """Sizes of triangles.

    Parameters
    ----------
    points : (n,) complex array, mm
        Sources.
    sizes : (n,) array, mm
        Sizes there, above 0; each is taken up to an eighth smaller.
    largest : float, mm
        Largest size.
    """

    points: Plane
    sizes: Array
    largest: float

    @cached_property
    def _bins(self) -> list[tuple[float, Any]]:
        """Size and tree of the sources of each bin, from the smallest; none without effect."""
        from scipy.spatial import KDTree

        step = np.floor(np.log(self.sizes / self.largest) / math.log(_BIN)).astype(np.int64)
        made: list[tuple[float, Any]] = []
        for number in distinct(step[step < 0]):
            size, points = self.largest * _BIN ** float(number), self.points[step == number]
            points = points[_field(made, points, self.largest) > size]
            if len(points):
                made.append((size, KDTree(as_pairs(points))))
        return made

    def at(self, points: Plane) -> Array:
        """Return the sizes, (k,), mm, at points, (k,), complex, mm."""
        return _field(self._bins, points, self.largest)


def _field(bins: list[tuple[float, Any]], points: Plane, largest: float) -> Array:
    found, pairs = np.full(len(points), largest), as_pairs(points)
    for size, tree in bins:
        larger = np.flatnonzero(found > size)
        if len(larger):
            reach = (float(found[larger].max()) - size) / GROWTH
            away, _ = tree.query(pairs[larger], distance_upper_bound=reach)
            found[larger] = np.minimum(found[larger], size + GROWTH * away)
    return found


def mesh_corners(curve: BoundaryCurve, largest: float) -> Array:
    """Return s of corners, and of ends of held runs, which are vertices of every mesh, rising, mm.

    Parameters
    ----------
    curve : BoundaryCurve
        The curve.
    largest : float, mm
        Largest size of triangles: bends that are very tight beside it are corners too.
    """
    least, (ends, bends) = _LEAST * largest, curve.steps
    tight = np.abs(bends) * least > _PER_CURVATURE
    edges = np.flatnonzero(np.diff(tight, prepend=False, append=False))
    turned = np.append(0.0, np.cumsum(bends * np.diff(ends)))
    first, last = edges[::2], edges[1::2]
    sharp = 0.5 * (ends[first] + ends[last])[np.abs(turned[last] - turned[first]) > _SHARP]
    corners = apart(np.sort(np.concatenate([curve.corners, curve.held_ends, sharp])), least)
    wrapped = len(corners) > 1 and corners[0] + curve.length - corners[-1] <= least
    return corners[:-1] if wrapped else corners


def shape_sources(region: Region, largest: float) -> tuple[Plane, Array]:
    """Return the sources that the shape of a region has.

    Parameters
    ----------
    region : Region
        What is meshed.
    largest : float, mm
        Largest size of triangles.

    Returns
    -------
    points, sizes : (n,) arrays, complex and real, mm
    """
    made = [_bends(curve, largest) for curve in region.curves]
    made += [_short_pieces(curve, largest) for curve in region.curves]
    made += _gaps(region, largest)
    return np.concatenate([one[0] for one in made]), np.concatenate([one[1] for one in made])


def _bends(curve: BoundaryCurve, largest: float) -> tuple[Plane, Array]:
    s = curve.places
    bend = np.abs(curve.curvature(s))
    size = _PER_CURVATURE / np.maximum(bend, _PER_CURVATURE / largest)
    kept = (size < largest) & (size > _LEAST * largest)
    s, size = s[kept], size[kept]
    if not len(s):
        return np.empty(0, dtype=np.complex128), size
    way = np.append(0.0, np.cumsum(np.diff(s) / size[1:])) / _GRAIN
    starts = np.unique(np.floor(way), return_index=True)[1]
    return curve.at(s[starts])[0], np.minimum.reduceat(size, starts)


def _short_pieces(curve: BoundaryCurve, largest: float) -> tuple[Plane, Array]:
    corners = mesh_corners(curve, largest)
    lengths = np.diff(corners, append=corners[:1] + curve.length)
    short = lengths < largest
    return curve.at(corners[short] + 0.5 * lengths[short])[0], lengths[short]


def _gaps(region: Region, largest: float) -> list[tuple[Plane, Array]]:
    from scipy.spatial import KDTree

    made = []
    for curve in region.curves:
        others = [other.at(other.places)[0] for other in region.curves if other is not curve]
        if not others:
            break
        points = curve.at(np.linspace(0.0, curve.length, _GAPS, endpoint=False))[0]
        away, _ = KDTree(as_pairs(np.concatenate(others))).query(as_pairs(points))
        near = _PER_GAP * away < largest
        made.append((points[near], np.maximum(_PER_GAP * away[near], _LEAST * largest)))
    return made


def outline_sizes(
    region: Region,
    module: float,
    spans: Array,
    *,
    fillet: float = FILLET,
    flank: float = OUTLINE,
) -> tuple[Plane, Array]:
    """Return the sources of sizes on the outline of a wheel.

    Parameters
    ----------
    region : Region
        The wheel.
    module : float, mm
        Its module.
    spans : (k, 2) array, mm
        First and last s, on the curve with the teeth, of those that are looked at.
    fillet : float
        Size in their fillets, in modules.
    flank : float
        Size on the rest of them, in modules; elsewhere on the outline it is `OUTLINE`.

    Returns
    -------
    points, sizes : (n,) arrays, complex and real, mm
    """
    curve = region.teeth
    rest = _spread(np.array([[0.0, curve.length]]), OUTLINE * module)
    flanks, fillets = _spread(spans, flank * module), _spread(spans, fillet * module)
    fillets = fillets[curve.curvature(fillets) * CONCAVE * module < -1.0]
    s = (rest, flanks, fillets)
    sizes = [
        np.full(len(one), size * module)
        for one, size in zip(s, (OUTLINE, flank, fillet), strict=True)
    ]
    return curve.at(np.concatenate(s))[0], np.concatenate(sizes)


def _spread(spans: Array, size: float) -> Array:
    """Return places on spans, (k, 2), at distances that suit a size."""
    lines = [np.arange(low, high, _APART * size) for low, high in spans]
    return np.concatenate([*lines, np.empty(0)])
