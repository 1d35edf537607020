"""The largest cutter or wire that can make an outline from outside.

A round tool reaches every place of an outline if its radius is below the smallest *inner radius*
(0 at an inner corner) and it passes the narrowest *slot*: the largest disc that fits between two
walls that face each other.

A chamber whose mouth is two sharp edges has no walls that face each other there: its mouth is not
seen.

Depends on numeric; shapely inside the functions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.bulges import as_complex
from gearcam.numeric.contour import Contour
from gearcam.numeric.hermite import on_cubics

_FACING: Final = -0.5
"""Cosine of the angle between outward normals below which walls face each other: 120 degrees."""

_CORNER: Final = 1e-6
"""Turn of the tangent between runs, rad, above which there is a corner."""

_GRAIN: Final = 1e-9
"""Steps shorter than this part of the outline's size say nothing of curvature."""

_PER_RUN: Final = 30
_LEAST: Final = 1500
"""First search: points per run, and points at least."""

_COARSE: Final = 4
_WINDOW: Final = 40
"""Before it: one of so many points, and how many neighbours each is compared with. Any slot found
bounds the distance within which the narrowest one is sought."""

_ALL: Final = 8000
"""Most points of which each is compared with every other where no slot was found nearby."""

_FINER: Final = np.linspace(-1.5, 1.5, 121)
"""Places, in steps of the first search, at which the narrowest slot is then refined."""


@dataclass(frozen=True, kw_only=True)
class ToolLimits:
    """What limits a round tool.

    Parameters
    ----------
    inner_radius : float, mm
        Smallest radius of a concave place; 0 at an inner corner, inf without concave places.
    inner_place : (float, float) or None, mm
        Where.
    slot : float, mm
        Width of the narrowest slot; inf without one.
    slot_place : (float, float) or None, mm
        Its middle.
    """

    inner_radius: float
    inner_place: tuple[float, float] | None
    slot: float
    slot_place: tuple[float, float] | None

    @property
    def diameter(self) -> float:
        """Diameter of the largest tool that reaches every place, mm."""
        return min(2.0 * self.inner_radius, self.slot)

    def as_dict(self) -> dict[str, Any]:
        """Return the limits for JSON: what does not exist is left out."""
        made: dict[str, Any] = {}
        if self.inner_place is not None:
            made |= {"inner_radius_mm": self.inner_radius, "at_mm": list(self.inner_place)}
        if self.slot_place is not None:
            made |= {"slot_mm": self.slot, "slot_at_mm": list(self.slot_place)}
        if made:
            made = {"largest_diameter_mm": self.diameter, **made}
        return made


def tool_limits(contour: Contour) -> ToolLimits:
    """Return what limits a round tool that cuts an outline from outside.

    Parameters
    ----------
    contour : Contour
        The outline as it is made.

    Returns
    -------
    ToolLimits
        Radii from the tangents of the dense points, widths between dense points.
    """
    radius, place = _inner(contour)
    slot, middle = _slot(contour)
    return ToolLimits(
        inner_radius=radius,
        inner_place=None if place is None else (place.real, place.imag),
        slot=slot,
        slot_place=None if middle is None else (middle.real, middle.imag),
    )


def _inner(contour: Contour) -> tuple[float, complex | None]:
    """Find the smallest concave radius and its place."""
    size = float(np.ptp(contour.vertices, axis=0).max())
    sharpest, place = 0.0, None
    ends = [as_complex(run.tangents)[[0, -1]] for run in contour.runs]
    for run, own, after in zip(contour.runs, ends, [*ends[1:], ends[0]], strict=True):
        if float(np.angle(after[0] / own[1])) < -_CORNER:
            return 0.0, complex(*run.points[-1])
        p, t = as_complex(run.points), as_complex(run.tangents)
        length = np.abs(np.diff(p))
        bend = -np.angle(t[1:] * np.conj(t[:-1]))
        real = length > _GRAIN * size
        bend = np.divide(bend, length, out=np.zeros_like(bend), where=real)
        k = int(bend.argmax())
        if bend[k] * size > _GRAIN and bend[k] > sharpest:
            sharpest, place = float(bend[k]), complex(0.5 * (p[k] + p[k + 1]))
    return (1.0 / sharpest if sharpest else math.inf), place


def _slot(contour: Contour) -> tuple[float, complex | None]:
    """Width and middle of the narrowest slot."""
    runs = contour.runs
    points = np.concatenate([as_complex(run.points) for run in runs])
    tangents = np.concatenate([as_complex(run.tangents) for run in runs])
    last = np.cumsum([len(run.points) for run in runs]) - 1
    first = np.append(0, last[:-1] + 1)
    steps = np.abs(np.diff(points, prepend=points[0]))
    steps[first] = 0.0  # a run begins where the one before it ends
    way = np.cumsum(steps)

    def at(run: Ints, along: Array) -> tuple[Plane, Plane]:
        """Points and outward normals at ways along the outline, none beyond its run's ends."""
        along = np.clip(along, way[first[run]], way[last[run]])
        step = np.clip(np.searchsorted(way, along, side="right") - 1, first[run], last[run] - 1)
        share = (along - way[step]) / (way[step + 1] - way[step])
        made, directions = on_cubics(points, tangents, step, share)
        return made, -1j * directions

    length = np.diff(way[first], append=way[-1])
    step = way[-1] / max(_LEAST, _PER_RUN * len(length))
    counts = np.ceil(length / step).astype(int) + 1
    number = np.repeat(np.arange(len(counts)), counts)
    share = np.concatenate([np.linspace(0.0, 1.0, count) for count in counts.tolist()])
    along = way[first[number]] + share * length[number]
    best, pair = _narrowest(*at(number, along))
    if math.isinf(best):
        return best, None
    (p, n), (q, m) = (at(number[[k]], along[k] + step * _FINER) for k in pair)
    width = _width(p[:, None], n[:, None], q[None], m[None])
    a = int(width.min(axis=1).argmin())
    best = float(width[a].min())
    return best, complex(p[a] + 0.5 * best * n[a])


def _narrowest(p: Plane, n: Plane) -> tuple[float, tuple[int, int]]:
    """Find the least width of any pair, and the pair: of those that lie near enough."""
    from shapely import STRtree, points

    best, pair = _of_neighbours(p, n, _COARSE, _WINDOW)
    if math.isinf(best):
        best, pair = _of_neighbours(p, n, 1, len(p) if len(p) <= _ALL else _COARSE * _WINDOW)
    if math.isinf(best):
        return best, pair
    made: Any = points(p.real, p.imag)
    i, j = STRtree(made).query(made, predicate="dwithin", distance=best)
    width = _width(p[i], n[i], p[j], n[j])
    k = int(width.argmin())
    return (float(width[k]), (int(i[k]), int(j[k]))) if width[k] < best else (best, pair)


def _of_neighbours(p: Plane, n: Plane, of: int, most: int) -> tuple[float, tuple[int, int]]:
    """Find the least width of pairs up to `most` apart among one `of` so many points."""
    p, n = p[::of], n[::of]
    best, pair, size = math.inf, (0, 0), len(p)
    for apart in range(1, min(most, size - 1) + 1):
        for way in (apart, -apart):
            width = _width(p, n, np.roll(p, way), np.roll(n, way))
            k = int(width.argmin())
            if width[k] < best:
                best, pair = float(width[k]), (of * k, of * ((k - way) % size))
    return best, pair


def _width(p: Plane, n: Plane, q: Plane, m: Plane) -> Array:
    """Diameter of the disc that touches p along its normal n and passes q; inf if none faces it."""
    way = q - p
    ahead = (way * np.conj(n)).real
    # what touches at p and at q lies on the outer side of both
    facing = ((n * np.conj(m)).real < _FACING) & (ahead > 0.0) & ((way * np.conj(m)).real < 0.0)
    square = way.real**2 + way.imag**2
    return np.divide(square, ahead, out=np.full(np.shape(square), math.inf), where=facing)
