"""Sections: what a plane cuts of a part of layers, exactly, or of a mesh.

The plane is parallel to y and to the axis, at some x, seen towards +x: to the right is z, upwards
y. *Slabs* lie between two heights at which layers or pockets begin or end; along y each has *metal*
between pairs of heights. Behind the plane the outlines of the layers are seen.

Depends on parts and numeric, numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import compress, pairwise
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Mask, Plane, complex_of
from gearcam.numeric.mesh import Mesh
from gearcam.parts.body import Edge, Layer
from gearcam.parts.shapes import Circle

_NONE: Final = np.empty(0)

_PAST_ROOT: Final = 0.6
"""Distance from the middle of a tooth up to which metal ends at it, in heights of the tooth."""


def crossings(edge: Edge, x: float, tolerance: float) -> Array:
    """Return where an `edge`, with chords within a `tolerance`, crosses the plane at `x`: y, mm."""
    if isinstance(edge, Circle):
        square = 0.25 * edge.diameter**2 - (x - edge.center.real) ** 2
        return edge.center.imag + math.sqrt(square) * np.array([-1.0, 1.0]) if square > 0 else _NONE
    points = edge.polyline(tolerance)
    return chain_crossings(np.append(points, points[:1]), x)


def chain_crossings(points: Plane, x: float) -> Array:
    """Return where a chain of `points` crosses the plane at `x`: y, mm."""
    over = np.flatnonzero(np.diff(points.real > x))
    first, last = points[over], points[over + 1]
    share = (x - first.real) / (last.real - first.real)
    return np.sort(first.imag + share * (last.imag - first.imag))


@dataclass(frozen=True, eq=False, kw_only=True)
class Section:
    """The section of layers less pockets with the plane at `x`, mm, to a chord `tolerance`.

    Of `teeth` it has the roots and the tips there, y, mm: they are shown whole (ISO 2203).
    """

    layers: Sequence[Layer]
    pockets: Sequence[Layer]
    x: float
    tolerance: float
    teeth: Sequence[tuple[float, float]] = ()

    @cached_property
    def heights(self) -> list[float]:
        """The heights between slabs, mm."""
        every = (*self.layers, *self.pockets)
        return sorted({height for one in every for height in (one.low, one.high)})

    @cached_property
    def slabs(self) -> list[tuple[Array, Array]]:
        """Metal of each slab, and the extents that are seen behind the plane: ends along y."""
        return [self._slab(low, high) for low, high in pairwise(self.heights)]

    def _slab(self, low: float, high: float) -> tuple[Array, Array]:
        middle = 0.5 * (low + high)
        layers, pockets = (
            [one for one in several if one.low < middle < one.high]
            for several in (self.layers, self.pockets)
        )
        cuts = {
            id(edge): crossings(edge, self.x, self.tolerance)
            for one in (*layers, *pockets)
            for edge in one.edges
        }
        ends = np.unique(np.concatenate([*cuts.values(), _NONE]))
        places = 0.5 * (ends[1:] + ends[:-1])

        def within(several: list[Layer]) -> Mask:
            found = np.zeros(len(places), dtype=bool)
            for one in several:
                edge, *islands = (_inside(cuts[id(each)], places) for each in one.edges)
                found |= edge & ~np.any(islands, axis=0)
            return found

        outlines = [one.edge.polyline(self.tolerance) for one in layers]
        seen = np.concatenate([*(one.imag[one.real >= self.x] for one in outlines), _NONE])
        metal = _ends_of(within(layers) & ~within(pockets), ends)
        for root, tip in self.teeth:
            of_tooth = np.abs(metal - 0.5 * (root + tip)) < _PAST_ROOT * abs(root - tip)
            metal = np.where(of_tooth, root, metal)
            seen = np.append(seen, tip if of_tooth.any() else [])
        metal = metal.reshape(-1, 2)[np.diff(metal)[::2] > 0.0].ravel()
        return metal, np.array([seen.min(), seen.max()]) if len(seen) else _NONE

    @property
    def metal(self) -> list[Plane]:
        """The cut metal as closed loops."""
        return [
            np.array([low + 1j * y, high + 1j * y, high + 1j * top, low + 1j * top])
            for (low, high), (ends, _) in zip(pairwise(self.heights), self.slabs, strict=True)
            for y, top in ends.reshape(-1, 2)
        ]

    @property
    def lines(self) -> Iterator[tuple[complex, complex]]:
        """All visible edges, from point to point, z and y, mm."""
        for (low, high), (ends, extent) in zip(pairwise(self.heights), self.slabs, strict=True):
            tips = [tip for root, tip in self.teeth if root in ends]
            for y in np.unique([*ends, *extent, *tips]).tolist():
                yield low + 1j * y, high + 1j * y
        nothing = _NONE, _NONE
        pairs = pairwise([nothing, *self.slabs, nothing])
        for height, (below, above) in zip(self.heights, pairs, strict=True):
            for y, top in _differing(*below, *above):
                yield height + 1j * y, height + 1j * top


def _inside(ends: Array, places: Array) -> Mask:
    return np.searchsorted(ends, places) % 2 == 1


def _ends_of(shown: Mask, cuts: Array) -> Array:
    """Return both ends of each run of places between `cuts` that are shown."""
    return cuts[np.flatnonzero(np.diff(np.concatenate([[False], shown, [False]]).astype(int)))]


def _differing(ends: Array, extent: Array, others: Array, over: Array) -> Array:
    """Return where the face between two slabs is seen, (n, 2): metal or extents differ there."""
    cuts = np.unique(np.concatenate([ends, others, extent, over]))
    places = 0.5 * (cuts[1:] + cuts[:-1])
    one, two = _inside(ends, places), _inside(others, places)
    shown = (one != two) | (~one & ~two & (_inside(extent, places) != _inside(over, places)))
    return _ends_of(shown, cuts).reshape(-1, 2)


def mesh_loops(mesh: Mesh) -> list[Plane]:
    """Return the closed loops in which the plane at x = 0 cuts a mesh: z and y, mm."""
    above = mesh.vertices[mesh.triangles, 0] > 0.0
    rows, start = np.nonzero(above != np.roll(above, -1, axis=1))
    # of each triangle that is cut, an edge that rises to x > 0 and one that falls from it
    names = mesh.triangles[rows[:, None], np.column_stack([start, (start + 1) % 3])]
    first, last = mesh.vertices[names[:, 0]], mesh.vertices[names[:, 1]]
    at = first + first[:, :1] / (first[:, :1] - last[:, :1]) * (last - first)
    edges = [(low, high) for low, high in np.sort(names, axis=1).tolist()]
    points = dict(zip(edges, complex_of(at[:, 2], at[:, 1]).tolist(), strict=True))
    falls = first[:, 0] > 0.0
    following = dict(zip(compress(edges, ~falls), compress(edges, falls), strict=True))
    loops = []
    while following:
        start, here = following.popitem()
        loop = [points[start]]
        while here != start and here in following:
            loop.append(points[here])
            here = following.pop(here)
        loops.append(np.array(loop))
    return loops
