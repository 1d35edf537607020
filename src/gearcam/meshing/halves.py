"""Halves of teeth: the outlines as the stepwise overlap cuts them.

Each wheel is divided into *halves* of teeth, from the middle of a tip to the middle of a root and
a little below; h counts them from tooth 1's +s half as 0, wheel 2 from the half that faces it.
Half h of the driver faces half h of the driven wheel. The edge of a half is the part of it that
belongs to the outline; for a first look it is thinned.
"""

from __future__ import annotations

from collections.abc import Sequence, Sized
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from gearcam.gears.contact import Ints
from gearcam.gears.flank import Kind
from gearcam.gears.outline import Outline
from gearcam.gears.rolling import Plane
from gearcam.meshing.staircase import Edges

Array = NDArray[np.float64]

_BELOW = 0.5
"""Depth of the halves below the root, in dedendums: more than any overlap that is worth a name."""

_THINNED = 24.0
"""Deviation of thinned edges over the chord error: a quarter of the vertices."""

_FORWARD = 0.7
"""Cosine of the largest angle to its direction at which an edge goes on over its neighbours."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Halves:
    """The halves of a wheel's teeth.

    Parameters
    ----------
    points : complex array, mm
        Vertices of all halves in the wheel's frame, one half after another: each from the middle
        of the tip to the middle of the root, below that, and below the tip.
    starts : (2z + 1,) int array
        Where each half begins, and the end.
    chord_error : float, mm
        Largest distance of the curve from its chords.
    edges : Edges
        What the halves have of the outline.
    tips : (2z,) complex array, mm
        Middle of the tip of each half's tooth.
    width : (2z,) array, mm
        Largest distance of its corners from there.
    """

    points: Plane
    starts: Ints
    chord_error: float
    edges: Edges
    tips: Plane
    width: Array

    @property
    def count(self) -> int:
        """Number of halves, 2z."""
        return len(self.starts) - 1

    @cached_property
    def polygons(self) -> Any:
        """The halves as shapely polygons, prepared, (2z,)."""
        polygons = as_polygons(self.points, np.diff(self.starts))
        shapely.prepare(polygons)
        return polygons

    @property
    def sound(self) -> bool:
        """Whether no half crosses itself, as those of very few, deep teeth may."""
        return bool(np.all(shapely.is_valid(self.polygons)))

    def distance(self, points: Plane) -> Array:
        """Return the distances of points from the halves, mm; 0 inside."""
        union = shapely.MultiPolygon(self.polygons.tolist())
        return np.asarray(shapely.distance(union, shapely.points(points.real, points.imag)))

    @cached_property
    def thinned(self) -> Edges:
        """The edges with fewer vertices."""
        return _thin(self.edges, _THINNED * self.chord_error)

    @cached_property
    def outmost(self) -> Array:
        """Largest distance of each half from the axis, mm, (2z,)."""
        return np.asarray(np.maximum.reduceat(np.abs(self.points), self.starts[:-1]))

    def gather(self, halves: Ints) -> tuple[Ints, Ints]:
        """Return the indices into `points` of some `halves`, and which of these each belongs to."""
        sizes = self.starts[halves + 1] - self.starts[halves]
        owner = np.repeat(np.arange(len(halves)), sizes)
        first = np.cumsum(sizes) - sizes
        return np.arange(len(owner)) - first[owner] + self.starts[halves][owner], owner


def halve(outline: Outline) -> Halves:
    """Divide a wheel into the halves of its teeth.

    Parameters
    ----------
    outline : Outline
        The wheel at the tolerance of the study.

    Returns
    -------
    Halves
        In the order of rising s from the middle of tooth 1 (wheel 1) or from the middle of the
        space before tooth 1 (wheel 2).
    """
    toothing = outline.toothing
    points, chains = _chains(outline)
    depth = -(1.0 + _BELOW) * toothing.cutter.dedendum
    places = toothing.tooth_places
    deep = _below(outline, toothing.rolling.angle(places), depth)
    low = _below(outline, toothing.rolling.angle(places + 0.5 * toothing.pitch), depth)
    halves: list[Plane] = []
    edges: list[_Edge] = []
    tips: list[tuple[complex, float]] = []
    for k, chain in enumerate(chains):
        tooth, side = divmod(k, 2)
        own, under = points[chain[1]], deep[(tooth + side) % toothing.teeth]
        halves.append(np.concatenate([own, [low[tooth], under]]))
        edges.append(_edge(toothing.wheel, [points[part] for part in chain], under, low[tooth]))
        tips.append((own[0], np.abs(points[chain[0]] - own[0]).max(initial=0.0)))
    if toothing.wheel == 2:
        halves, tips = halves[-1:] + halves[:-1], tips[-1:] + tips[:-1]
        edges = edges[-1:] + edges[:-1]
        edges = [_covered(k, edges) for k in range(len(edges))]
    return Halves(
        points=np.concatenate(halves),
        starts=_starts(halves),
        chord_error=outline.sampler.chords[2],
        edges=_join(edges),
        tips=np.array([tip for tip, _ in tips]),
        width=np.array([width for _, width in tips]),
    )


def _starts(parts: Sequence[Sized]) -> Ints:
    return np.concatenate([[0], np.cumsum([len(part) for part in parts])])


class _Middles:
    """The middles of lands between the vertices `begin` and `end`, themselves vertices or between.

    A middle between two vertices has a number of its own, from `extra` on.
    """

    def __init__(self, begin: Ints, end: Ints, size: int, extra: int) -> None:
        self.low, self.high = (begin + end) // 2, (begin + end + 1) // 2
        self.at = np.where(self.low == self.high, self.low % size, extra + np.arange(len(begin)))


def _chains(outline: Outline) -> tuple[Plane, list[tuple[Ints, Ints, Ints]]]:
    """Vertices of each half from tip to root: its own, between those of its neighbours' lands.

    Half 0 is the front of the first tooth, half 1 the back of the second, which ends in the same
    root, and so on. Returns the outline's vertices and the middles after them.
    """
    points = outline.sampler.chords[1]
    size, z = len(points), outline.toothing.teeth
    (front, front_end), (back, back_end) = _flanks(outline)
    following = np.append(front[1:], size)
    tips, roots = (
        _Middles(back_end, following, size, size),
        _Middles(front_end, back, size, size + z),
    )
    chains: list[tuple[Ints, Ints, Ints]] = []
    for k in range(z):
        last = size if k == 0 else 0
        tip, root, after = (
            tips.at[[k - 1, k]],
            roots.at[k],
            np.arange(roots.low[k] + 1, back[k] + 1),
        )
        own = np.arange(tips.low[k - 1] + 1 - last, roots.high[k]) % size
        before = np.arange(back_end[k - 1] - last, tips.high[k - 1] - last)
        chains.append((before % size, np.concatenate([tip[:1], own, [root]]), after))
        own = np.arange(tips.high[k] - 1, roots.low[k], -1)
        after = np.arange(roots.high[k] - 1, front_end[k] - 1, -1)
        before = np.arange(following[k], tips.low[k], -1)
        chains.append((before % size, np.concatenate([tip[1:], own, [root]]), after))
    middles = [0.5 * (points[land.low % size] + points[land.high % size]) for land in (tips, roots)]
    return np.concatenate([points, *middles]), chains


def _flanks(outline: Outline) -> Ints:
    """Vertices at which the front of each space begins and ends, and the back, (2, 2, z).

    A space begins with the + flank of its tooth and ends with the - flank of the next one.
    """
    rows, z = outline.rows, outline.toothing.teeth
    row = outline.sampler.curve_of(outline.sampler.chords[0][:-1])
    flank = np.flatnonzero(rows.kind == Kind.FLANK)
    space = np.where(rows.sigma[flank] > 0.0, rows.tooth[flank], rows.tooth[flank] - 1) % z
    ends = np.zeros((2, 2, z), dtype=np.int64)
    for side, mine in enumerate((rows.sigma[flank] > 0.0, rows.sigma[flank] < 0.0)):
        first, last = np.full(z, len(rows.kind)), np.full(z, -1)
        np.minimum.at(first, space[mine], flank[mine])
        np.maximum.at(last, space[mine], flank[mine])
        ends[side] = np.searchsorted(row, first), np.searchsorted(row, last + 1)
    # space 1 follows tooth 1 and comes first; space z, counted as 0, comes last
    return np.roll(ends, -1, axis=2)


def _below(outline: Outline, angle: Array, height: float) -> Plane:
    frames = outline.toothing.frames(angle, curved=False)
    return frames.p + height * outline.toothing.turn * frames.t


_COVER = np.radians(22.5)
"""Angle of the cover to the direction of an edge: between level and the line of the tips."""

_COVERED = 3
"""Number of neighbours that the cover reaches over."""


class _Edge(NamedTuple):
    """The edge of a half, as it rises, see `Edges`."""

    points: Plane
    ends: tuple[complex, complex]
    along: complex
    hand: float


def _edge(wheel: int, chain: list[Plane], under: complex, low: complex) -> _Edge:
    """Return the edge of a half from what is before it, its own and what is after it."""
    before, own, after = chain
    down = (under - own[0]) / abs(under - own[0])
    hand = 1.0 if ((low - under) / down).imag > 0.0 else -1.0
    along = down * (1.0 + 1j * hand) / np.sqrt(2.0)
    if wheel == 1:
        # the driver's is seen from its mate: it rises from the root
        more = _forward(np.append(own[0], before[::-1]), -along)[1:]
        return _Edge(np.concatenate([own[::-1], more]), (own[-1], own[0]), -along, hand)
    ends = own[0], own[-1]
    more = _forward(np.append(own[-1], after), along)[1:]
    less = _forward(np.append(own[0], before[::-1]), -along)[:0:-1]
    return _Edge(np.concatenate([less, own, more]), ends, along, hand)


def _forward(points: Plane, along: complex) -> Plane:
    """Return the first points as long as they go forward."""
    step = np.diff(points) / along
    back = np.flatnonzero(step.real < _FORWARD * np.abs(step))
    return points[: back[0] + 1] if back.size else points


def _covered(half: int, edges: list[_Edge]) -> _Edge:
    """Lead the edge of a driven half on, from the far corner of its tip over its neighbours' tips.

    All of them stay below the line, or the edge is left as it is.
    """
    edge = edges[half]
    corner = edge.points[0]
    line = edge.along * np.exp(1j * edge.hand * _COVER)
    way = 1 if edges[half - 1].ends[0] == edge.ends[0] else -1
    others = [edges[(half - way * k) % len(edges)].points for k in range(1, 2 * _COVERED + 1)]
    seen = (np.concatenate(others) - corner) / line
    if np.any(edge.hand * seen.imag[seen.real < 0.0] > 0.0):
        return edge
    far = corner - abs(others[-1][0] - corner) * line
    return edge._replace(points=np.append(far, edge.points))


def _join(edges: list[_Edge]) -> Edges:
    points = np.concatenate([edge.points for edge in edges])
    return Edges(
        points=points,
        starts=_starts([edge.points for edge in edges]),
        whole=np.arange(len(points)),
        ends=np.array([edge.ends for edge in edges]).T,
        along=np.array([edge.along for edge in edges]),
        hand=np.array([edge.hand for edge in edges]),
    )


def _thin(edges: Edges, deviation: float) -> Edges:
    """Leave out vertices as long as no edge moves by more than a deviation."""
    owner = np.repeat(np.arange(len(edges.along)), np.diff(edges.starts))
    # the third coordinate says which vertices are left
    vertices = np.stack([edges.points.real, edges.points.imag, np.arange(len(owner))], axis=1)
    lines = shapely.linestrings(vertices, indices=owner)
    fewer = shapely.simplify(lines, deviation, preserve_topology=False)
    left = shapely.get_coordinates(fewer, include_z=True)[:, 2].astype(np.int64)
    return replace(
        edges,
        points=edges.points[left],
        starts=np.searchsorted(left, edges.starts),
        whole=left,
        deviation=deviation,
    )


def as_polygons(points: Plane, sizes: Ints) -> Any:
    """Return polygons of `sizes` vertices each, whose `points` stand one after another."""
    coordinates = np.stack([points.real, points.imag], axis=1)
    owner = np.repeat(np.arange(len(sizes)), sizes)
    return shapely.polygons(shapely.linearrings(coordinates, indices=owner))
