"""The largest cutter or wire that can make an edge: an outline from outside, a ring from inside.

A round tool reaches every point of an outline if its radius is below the smallest *inner radius*
(0 at an inner corner) and it passes the narrowest *slot*: the smallest disc that touches two
facing walls.

Not detected: the mouth of a chamber between two sharp edges, since no walls face each other there.

Depends on numeric.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Ints, Plane, in_groups
from gearcam.numeric.contour import Contour
from gearcam.numeric.hermite import on_cubics

_FACING: Final = -0.5
"""Cosine of the angle between outward normals below which walls face each other: 120 degrees."""

_CORNER: Final = 1e-6
"""Change of the tangent between runs, rad, above which there is a corner."""

_GRAIN: Final = 1e-9
"""Steps shorter than this share of the outline's size are ignored in curvatures."""

_PER_RUN: Final = 30
_LEAST: Final = 1500
"""First search: points per run, and least number of points."""

_COARSE: Final = 4
_WINDOW: Final = 40
"""Search before it: stride over points, and number of neighbours compared. Any slot found bounds
the distance within which the narrowest is searched."""

_ALL: Final = 8000
"""Largest number of points compared all with all if no slot was found nearby."""

_BLOCK: Final = 1 << 16
"""Pairs of points processed at once: as many as the cache holds."""

_FINER: Final = np.linspace(-1.5, 1.5, 121)
"""Positions, in steps of the first search, at which the narrowest slot is refined."""


@dataclass(frozen=True, kw_only=True)
class ToolLimits(ShortRepr):
    """Limits of a round tool.

    Parameters
    ----------
    inner_radius : float, mm
        Smallest concave radius; 0 at an inner corner, inf without concave parts.
    inner_place : complex or None, mm
        Its position.
    slot : float, mm
        Width of the narrowest slot; inf without one.
    slot_place : complex or None, mm
        Its middle.
    """

    inner_radius: float
    inner_place: complex | None
    slot: float
    slot_place: complex | None

    @property
    def diameter(self) -> float:
        """Diameter of the largest tool that reaches every point, mm."""
        return min(2.0 * self.inner_radius, self.slot)

    def as_dict(self) -> dict[str, Any]:
        """Return the limits as JSON data, without those that do not exist."""
        made: dict[str, Any] = {}
        for size, width, at, place in (
            ("inner_radius_mm", self.inner_radius, "at_mm", self.inner_place),
            ("slot_mm", self.slot, "slot_at_mm", self.slot_place),
        ):
            if place is not None:
                made |= {size: width, at: [place.real, place.imag]}
        if made:
            made = {"largest_diameter_mm": self.diameter, **made}
        return made


UNLIMITED: Final = ToolLimits(
    inner_radius=math.inf, inner_place=None, slot=math.inf, slot_place=None
)
"""Those of a convex outline, or of one that nobody has looked at."""


def tool_limits(contour: Contour, *, hollow: bool = False) -> ToolLimits:
    """Return the limits of a round tool that cuts an edge from the side without metal.

    Parameters
    ----------
    contour : Contour
        The finished edge.
    hollow : bool
        Whether the metal is outside it.

    Returns
    -------
    ToolLimits
        Radii from the tangents of the dense points, widths between dense points.
    """
    runs = [run.reversed for run in reversed(contour.runs)] if hollow else contour.runs
    ends = np.cumsum([len(run.points) for run in runs])
    points = np.concatenate([run.points for run in runs])
    tangents = np.concatenate([run.tangents for run in runs])
    size = float(max(np.ptp(contour.points.real), np.ptp(contour.points.imag)))
    radius, place = _inner(points, tangents, ends, size)
    # no parts of a convex outline face each other
    slot, middle = (math.inf, None) if place is None else _slot(points, tangents, ends)
    return ToolLimits(
        inner_radius=radius,
        inner_place=place,
        slot=slot,
        slot_place=middle,
    )


def _inner(points: Plane, tangents: Plane, ends: Ints, size: float) -> tuple[float, complex | None]:
    """Return the smallest concave radius and its position; `ends` are the indices after runs."""
    turn = -np.angle(np.append(tangents[1:], tangents[0]) * np.conj(tangents))
    corners = np.flatnonzero(turn[ends - 1] > _CORNER)
    if corners.size:
        return 0.0, complex(points[ends[corners[0]] - 1])
    # for an arc the chord is shorter by the sinc of half the angle
    length = np.abs(np.diff(points)) * (1.0 + turn[:-1] ** 2 / 24.0)
    length[ends[:-1] - 1] = 0.0  # a run begins where the one before it ends
    real = length > _GRAIN * size
    bend = np.divide(turn[:-1], length, out=np.zeros_like(length), where=real)
    k = int(bend.argmax())
    if bend[k] * size <= _GRAIN:
        return math.inf, None
    return 1.0 / float(bend[k]), complex(0.5 * (points[k] + points[k + 1]))


def _slot(points: Plane, tangents: Plane, ends: Ints) -> tuple[float, complex | None]:
    """Return the width of the narrowest slot and its middle."""
    last = ends - 1
    first = np.append(0, ends[:-1])
    steps = np.abs(np.diff(points, prepend=points[0]))
    steps[first] = 0.0
    way = np.cumsum(steps)

    def at(run: Ints, along: Array) -> tuple[Plane, Plane]:
        """Points and outward normals at positions along the outline, kept within their runs."""
        along = np.clip(along, way[first[run]], way[last[run]])
        step = np.clip(np.searchsorted(way, along, side="right") - 1, first[run], last[run] - 1)
        share = (along - way[step]) / (way[step + 1] - way[step])
        made, directions = on_cubics(points, tangents, step, share)
        return made, -1j * directions

    length = np.diff(way[first], append=way[-1])
    step = way[-1] / max(_LEAST, _PER_RUN * len(length))
    counts = np.ceil(length / step).astype(int)
    number, place = in_groups(counts + 1)
    share = np.where(place < counts[number], place * (1.0 / counts)[number], 1.0)
    along = way[first[number]] + share * length[number]
    best, pair = _narrowest(*at(number, along))
    if math.isinf(best):
        return best, None
    (p, n), (q, m) = (at(number[[k]], along[k] + step * _FINER) for k in pair)
    width = _width(p[:, None], n[:, None], q[None], m[None])
    least = width.min(axis=1)
    a = int(least.argmin())
    best = float(least[a])
    return best, complex(p[a] + 0.5 * best * n[a])


def _narrowest(p: Plane, n: Plane) -> tuple[float, tuple[int, int]]:
    """Return the least width of the pairs that are near enough, and that pair."""
    best, (a, b) = _least(p[::_COARSE], n[::_COARSE], _neighbours(n[::_COARSE], _WINDOW))
    if math.isfinite(best):
        pair = _COARSE * a, _COARSE * b
    else:
        most = len(p) if len(p) <= _ALL else _COARSE * _WINDOW
        best, pair = _least(p, n, _neighbours(n, most))
    if math.isinf(best):
        return best, pair
    width, nearer = _least(p, n, _in_discs(p, p + 0.5 * best * n, 0.5 * best))
    return (width, nearer) if width < best else (best, pair)


def _neighbours(n: Plane, most: int) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of facing points up to `most` apart, the nearest first, in blocks."""
    size = len(n)
    apart = np.arange(1, min(most, size // 2) + 1)
    ways = np.stack([apart, -apart], axis=1).ravel()
    turned = sliding_window_view(np.tile(n, 2), size)
    for block in np.array_split(ways, math.ceil(len(ways) * size / _BLOCK)):
        other = turned[-block % size]
        way, i = np.nonzero(n.real * other.real + n.imag * other.imag < _FACING)
        yield i, (i - block[way]) % size


def _in_discs(p: Plane, centers: Plane, radius: float) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of discs and points in them, in blocks, by a grid of squares, 3 by 3 around each."""
    radius *= 1.0 + _GRAIN
    corner = complex(p.real.min(), p.imag.min())
    (x, y), (u, v) = (
        np.floor([z.real, z.imag]).astype(int)
        for z in ((p - corner) / radius, (centers - corner) / radius)
    )
    column = int(y.max()) + 5  # centres lie up to one square outside
    square = x * column + y
    order = np.argsort(square, kind="stable")
    middle = ((u * column + v)[:, None] + column * np.arange(-1, 2)).ravel()
    first, last = np.searchsorted(square[order], [middle - 1, middle + 2])
    counts = last - first
    cuts = np.searchsorted(np.cumsum(counts), np.arange(_BLOCK, counts.sum(), _BLOCK))
    for k in np.split(np.arange(len(counts)), cuts):
        row, place = in_groups(counts[k])
        disc, inner = k[row] // 3, order[first[k][row] + place]
        gap = p[inner] - centers[disc]
        inside = gap.real**2 + gap.imag**2 <= radius**2
        yield disc[inside], inner[inside]


def _least(p: Plane, n: Plane, pairs: Iterable[tuple[Ints, Ints]]) -> tuple[float, tuple[int, int]]:
    """Return the least width of some pairs, given in blocks, and that pair."""
    best, pair = math.inf, (0, 0)
    for i, j in pairs:
        width = _width(p[i], n[i], p[j], n[j])
        if width.size and width.min() < best:
            k = int(width.argmin())
            best, pair = float(width[k]), (int(i[k]), int(j[k]))
    return best, pair


def _width(p: Plane, n: Plane, q: Plane, m: Plane) -> Array:
    """Diameter of the disc that touches p along its normal n and passes q; inf if not facing."""
    way = q - p
    ahead = (way * np.conj(n)).real
    # a disc that touches at p and at q lies on the outer side of both
    facing = ((n * np.conj(m)).real < _FACING) & (ahead > 0.0) & ((way * np.conj(m)).real < 0.0)
    square = way.real**2 + way.imag**2
    return np.divide(square, ahead, out=np.full(np.shape(square), math.inf), where=facing)
