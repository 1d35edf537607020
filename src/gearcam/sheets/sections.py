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
from itertools import pairwise
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Mask, Plane
from gearcam.numeric.mesh import Mesh
from gearcam.parts.body import Edge, Layer
from gearcam.parts.shapes import Circle

_NONE: Final = np.empty(0)

Line = tuple[complex, complex]
"""Two points of a section, z and y, mm."""


def crossings(edge: Edge, x: float, tolerance: float) -> Array:
    """Return where an `edge`, with chords within a `tolerance`, crosses the plane at `x`: y, mm."""
    if isinstance(edge, Circle):
        square = 0.25 * edge.diameter**2 - (x - edge.center.real) ** 2
        return edge.center.imag + math.sqrt(square) * np.array([-1.0, 1.0]) if square > 0 else _NONE
    points = edge.polyline(tolerance)
    ends = np.roll(points, -1)
    over = (points.real > x) != (ends.real > x)
    first, last = points[over], ends[over]
    share = (x - first.real) / (last.real - first.real)
    return np.sort(first.imag + share * (last.imag - first.imag))


@dataclass(frozen=True, eq=False, kw_only=True)
class Section:
    """The section of layers less pockets with the plane at `x`, mm, to a chord `tolerance`."""

    layers: Sequence[Layer]
    pockets: Sequence[Layer]
    x: float
    tolerance: float

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

        def within(layer: Layer) -> Mask:
            edge, *islands = (
                np.searchsorted(cuts[id(one)], places) % 2 == 1 for one in layer.edges
            )
            return edge & ~np.logical_or.reduce(islands) if islands else edge

        metal = np.zeros(len(places), dtype=bool)
        for layer in layers:
            metal |= within(layer)
        for pocket in pockets:
            metal &= ~within(pocket)
        changed = np.flatnonzero(np.diff(np.concatenate([[False], metal, [False]]).astype(int)))
        behind = [points.imag[points.real >= self.x] for points in self._outlines(layers)]
        seen = np.concatenate([*behind, _NONE])
        extent = np.array([seen.min(), seen.max()]) if len(seen) else _NONE
        return ends[changed], extent

    def _outlines(self, layers: Sequence[Layer]) -> Iterator[Plane]:
        for layer in layers:
            yield layer.edge.polyline(self.tolerance)

    @property
    def metal(self) -> list[Plane]:
        """The cut metal as closed loops."""
        return [
            np.array([low + 1j * y, high + 1j * y, high + 1j * top, low + 1j * top])
            for (low, high), (ends, _) in zip(pairwise(self.heights), self.slabs, strict=True)
            for y, top in ends.reshape(-1, 2)
        ]

    @property
    def lines(self) -> Iterator[Line]:
        """All visible edges."""
        for (low, high), (ends, extent) in zip(pairwise(self.heights), self.slabs, strict=True):
            for y in np.union1d(ends, extent).tolist():
                yield low + 1j * y, high + 1j * y
        nothing = _NONE, _NONE
        slabs = [nothing, *self.slabs, nothing]
        for height, ((ends, extent), (others, over)) in zip(
            self.heights, pairwise(slabs), strict=True
        ):
            for y, top in _differing(ends, others, extent, over):
                yield height + 1j * y, height + 1j * top


def _inside(ends: Array, places: Array) -> Mask:
    return np.searchsorted(ends, places) % 2 == 1


def _differing(ends: Array, others: Array, extent: Array, over: Array) -> Array:
    """Return where the face between two slabs is seen, (n, 2): metal or extents differ there."""
    cuts = np.unique(np.concatenate([ends, others, extent, over]))
    places = 0.5 * (cuts[1:] + cuts[:-1])
    one, two = _inside(ends, places), _inside(others, places)
    shown = (one != two) | (~one & ~two & (_inside(extent, places) != _inside(over, places)))
    rise = np.flatnonzero(np.diff(np.concatenate([[False], shown, [False]]).astype(int)))
    return cuts[rise].reshape(-1, 2)


def mesh_loops(mesh: Mesh) -> list[Plane]:
    """Return the closed loops in which the plane at x = 0 cuts a mesh: z and y, mm."""
    corners = mesh.vertices[mesh.triangles]
    above = corners[:, :, 0] > 0.0
    cut = corners[above.any(axis=1) & ~above.all(axis=1)]
    numbers = mesh.triangles[above.any(axis=1) & ~above.all(axis=1)]
    following: dict[tuple[int, int], tuple[int, int]] = {}
    points: dict[tuple[int, int], complex] = {}
    for places, names in zip(cut, numbers.tolist(), strict=True):
        ways = []
        for k, m in ((0, 1), (1, 2), (2, 0)):
            one, two = places[k], places[m]
            if (one[0] > 0.0) != (two[0] > 0.0):
                share = one[0] / (one[0] - two[0])
                at = one + share * (two - one)
                edge = (min(names[k], names[m]), max(names[k], names[m]))
                points[edge] = complex(at[2], at[1])
                ways.append((one[0] > 0.0, edge))
        ways.sort()
        following[ways[0][1]] = ways[1][1]
    loops = []
    while following:
        start, here = following.popitem()
        loop = [points[start]]
        while here != start and here in following:
            loop.append(points[here])
            here = following.pop(here)
        loops.append(np.array(loop))
    return loops
