"""Sections: what a plane cuts of a part of layers, exactly, or of a mesh.

The plane is parallel to y and to the axis, at some x, seen towards +x: to the right is z, upwards
y. *Slabs* lie between two heights at which layers or pockets begin or end; along y each has *metal*
between pairs of lines, which rise where an edge has a chamfer. Behind the plane the outlines of the
layers are seen.

Depends on parts and numeric, numpy only.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import compress, pairwise
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Mask, Plane, complex_of
from gearcam.numeric.mesh import Mesh
from gearcam.parts.body import Bevel, Edge, Layer
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
    def slabs(self) -> list[tuple[Array, Array, Array]]:
        """Ends along y of the metal of each slab, and of what is seen behind the plane; tips.

        In two rows, (2, n): at the lower and at the upper height.
        """
        return [self._slab(low, high) for low, high in pairwise(self.heights)]

    def _slab(self, low: float, high: float) -> tuple[Array, Array, Array]:
        middle = 0.5 * (low + high)
        layers, pockets = (
            [one for one in several if one.low < middle < one.high]
            for several in (self.layers, self.pockets)
        )
        bevels = [one for one in pockets if isinstance(one, Bevel)]
        pockets = [one for one in pockets if not isinstance(one, Bevel)]

        # how much chamfers take at both heights, which are all of one size
        share = np.zeros(2)
        for bevel in bevels[:1]:
            share = (np.array([low, high]) - bevel.low) / bevel.height
            share = share if bevel.up else 1.0 - share
        cut = share * bevels[0].height if bevels else share

        def ends(edge: Edge, of: Callable[[Edge], Array]) -> Array:
            """Return what is found `of` an edge at both heights, between it and its chamfer."""
            found = np.tile(of(edge), (2, 1))
            faces = [of(bevel.face) for bevel in bevels if bevel.cuts(edge)]
            if faces and len(faces[0]) == found.shape[1]:
                found = found + share[:, None] * (faces[0] - found)
            return found

        def crossed(edge: Edge) -> Array:
            return crossings(edge, self.x, self.tolerance)

        cuts = {id(edge): ends(edge, crossed) for one in (*layers, *pockets) for edge in one.edges}
        nothing = np.empty((2, 0))
        means = {name: cut.mean(axis=0) for name, cut in cuts.items()}
        every, index = np.unique(np.concatenate([*means.values(), _NONE]), return_index=True)
        both = np.concatenate([*cuts.values(), nothing], axis=1)[:, index]
        places = 0.5 * (every[1:] + every[:-1])

        def within(several: list[Layer]) -> Mask:
            found = np.zeros(len(places), dtype=bool)
            for one in several:
                edge, *islands = (_inside(means[id(each)], places) for each in one.edges)
                found |= edge & ~np.any(islands, axis=0)
            return found

        def seen(edge: Edge) -> Array:
            points = edge.polyline(self.tolerance)
            behind = points.imag[points.real >= self.x]
            return np.array([behind.min(), behind.max()]) if len(behind) else _NONE

        outer = np.concatenate([nothing, *(ends(one.edge, seen) for one in layers)], axis=1)
        metal, tips = both[:, _runs(within(layers) & ~within(pockets))], nothing
        for root, tip in self.teeth:
            of_tooth = np.abs(metal - 0.5 * (root + tip)).max(axis=0) < _PAST_ROOT * abs(root - tip)
            if of_tooth.any():
                inwards = math.copysign(1.0, root - tip) * cut[:, None]
                metal = np.where(of_tooth, root + inwards, metal)
                tips = np.concatenate([tips, tip + inwards], axis=1)
        pairs = metal.reshape(2, -1, 2)
        metal = pairs[:, (pairs[..., 1] > pairs[..., 0]).all(axis=0)].reshape(2, -1)
        outer = np.concatenate([outer, tips], axis=1)
        extent = np.stack([outer.min(axis=1), outer.max(axis=1)], axis=1) if outer.size else outer
        return metal, extent, tips

    @property
    def metal(self) -> list[Plane]:
        """The cut metal as closed loops."""
        return [
            np.array([low + 1j * y[0], high + 1j * y[1], high + 1j * top[1], low + 1j * top[0]])
            for (low, high), (ends, _, _) in zip(pairwise(self.heights), self.slabs, strict=True)
            for y, top in ends.T.reshape(-1, 2, 2)
        ]

    @property
    def lines(self) -> Iterator[tuple[complex, complex]]:
        """All visible edges, from point to point, z and y, mm."""
        for (low, high), slab in zip(pairwise(self.heights), self.slabs, strict=True):
            for y, top in np.unique(np.concatenate(slab, axis=1), axis=1).T.tolist():
                yield low + 1j * y, high + 1j * top
        faces = [[(ends[k], extent[k]) for ends, extent, _ in self.slabs] for k in (0, 1)]
        nothing = [(_NONE, _NONE)]
        pairs = zip(nothing + faces[1], faces[0] + nothing, strict=True)
        for height, (below, above) in zip(self.heights, pairs, strict=True):
            for y, top in _differing(*below, *above):
                yield height + 1j * y, height + 1j * top


def _inside(ends: Array, places: Array) -> Mask:
    return np.searchsorted(ends, places) % 2 == 1


def _runs(shown: Mask) -> Ints:
    """Return the numbers of the cuts at both ends of each run of places that are shown."""
    return np.flatnonzero(np.diff(np.concatenate([[False], shown, [False]]).astype(int)))


def _differing(ends: Array, extent: Array, others: Array, over: Array) -> Array:
    """Return where the face between two slabs is seen, (n, 2): metal or extents differ there."""
    cuts = np.unique(np.concatenate([ends, others, extent, over]))
    places = 0.5 * (cuts[1:] + cuts[:-1])
    one, two = _inside(ends, places), _inside(others, places)
    shown = (one != two) | (~one & ~two & (_inside(extent, places) != _inside(over, places)))
    return cuts[_runs(shown)].reshape(-1, 2)


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
