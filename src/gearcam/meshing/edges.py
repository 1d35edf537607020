"""The edges of halves of teeth: the part of them that belongs to the outline, as it rises.

An edge goes on over its neighbours' lands, so that what touches there is seen (see `staircase`).
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from gearcam.gears.track import Plane
from gearcam.meshing.staircase import Edges

Array = NDArray[np.float64]

_THINNED = 24.0
"""Deviation of thinned edges over the chord error: a quarter of the vertices."""

_FORWARD = 0.7
"""Cosine of the largest angle to its direction at which an edge goes on over its neighbours."""

_COVER = np.radians(22.5)
"""Angle of the cover to the direction of an edge: between level and the line of the tips."""

_COVERED = 3
"""Number of neighbours that the cover reaches over."""


class Edge(NamedTuple):
    """The edge of a half, as it rises; see `Edges`."""

    points: Plane
    ends: tuple[complex, complex]
    along: complex
    hand: float


def rising(wheel: int, chain: list[Plane], under: complex, low: complex) -> Edge:
    """Return the edge of a half.

    Parameters
    ----------
    wheel : {1, 2}
        Whose.
    chain : list of complex arrays, mm
        Vertices from tip to root: of the land before the half, its own, of the land after it.
    under, low : complex, mm
        Points below the middles of its tip and of its root.

    Returns
    -------
    Edge
    """
    before, own, after = chain
    down = (under - own[0]) / abs(under - own[0])
    hand = 1.0 if ((low - under) / down).imag > 0.0 else -1.0
    along = down * (1.0 + 1j * hand) / np.sqrt(2.0)
    if wheel == 1:
        # the driver's is seen from its mate: it rises from the root
        more = _forward(np.append(own[0], before[::-1]), -along)[1:]
        return Edge(np.concatenate([own[::-1], more]), (own[-1], own[0]), -along, hand)
    ends = own[0], own[-1]
    more = _forward(np.append(own[-1], after), along)[1:]
    less = _forward(np.append(own[0], before[::-1]), -along)[:0:-1]
    return Edge(np.concatenate([less, own, more]), ends, along, hand)


def _forward(points: Plane, along: complex) -> Plane:
    """Return the first points as long as they go forward."""
    step = np.diff(points) / along
    back = np.flatnonzero(step.real < _FORWARD * np.abs(step))
    return points[: back[0] + 1] if back.size else points


def covered(half: int, edges: list[Edge], closed: bool) -> Edge:
    """Return a driven half's edge led on, from its tip's far corner over its neighbours' tips.

    Parameters
    ----------
    half : int
        Place of the half.
    edges : list of Edge
        All edges of the wheel.
    closed : bool
        Whether the last half has the first one beside it.

    Returns
    -------
    Edge
        All neighbours stay below the line, or it is left as it is.
    """
    edge = edges[half]
    corner = edge.points[0]
    line = edge.along * np.exp(1j * edge.hand * _COVER)
    # the halves before a front, or behind a back
    at = half - int(edge.hand) * np.arange(1, 2 * _COVERED + 1)
    at = at % len(edges) if closed else at[(at >= 0) & (at < len(edges))]
    if not at.size:
        return edge
    others = [edges[k].points for k in at.tolist()]
    seen = (np.concatenate(others) - corner) / line
    if np.any(edge.hand * seen.imag[seen.real < 0.0] > 0.0):
        return edge
    far = corner - abs(others[-1][0] - corner) * line
    return edge._replace(points=np.append(far, edge.points))


def joined(edges: list[Edge]) -> Edges:
    """Return the edges of all halves, one after another."""
    points = np.concatenate([edge.points for edge in edges])
    return Edges(
        points=points,
        starts=np.concatenate([[0], np.cumsum([len(edge.points) for edge in edges])]),
        whole=np.arange(len(points)),
        ends=np.array([edge.ends for edge in edges]).T,
        along=np.array([edge.along for edge in edges]),
        hand=np.array([edge.hand for edge in edges]),
    )


def thinned(edges: Edges, chord_error: float) -> Edges:
    """Return `edges` with fewer vertices; none moves by more than some of its `chord_error`, mm."""
    deviation = _THINNED * chord_error
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
