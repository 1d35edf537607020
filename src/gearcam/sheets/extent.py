"""Extents of outlines: sizes of the true curve, not of its chords.

Depends on numeric and parts' shapes.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.numeric.bulges import as_complex, as_pairs
from gearcam.numeric.contour import Contour
from gearcam.numeric.hermite import on_cubics
from gearcam.parts.shapes import Circle

_BETWEEN: Final = 129
"""Points on the cubic between two dense points."""

_WAYS: Final = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
"""Right, up, left, down."""


def true_points(edges: Iterable[Contour | Circle]) -> Array:
    """Return points on true edges, (n, 2), mm: dense, and much denser at extreme points.

    Extremes along x and y and of the distance from the origin are exact to 1e-8 mm: between dense
    points the curve is a cubic with the tangents at its ends. For circles only the extremes along x
    and y are returned.
    """
    return np.vstack([_points(edge) for edge in edges])


def _points(edge: Contour | Circle) -> Array:
    if isinstance(edge, Circle):
        return edge.center + 0.5 * edge.diameter * _WAYS
    runs = edge.runs
    points = np.vstack([run.points for run in runs])
    tangents = as_complex(np.vstack([run.tangents for run in runs]))
    reach = np.hypot(*points.T)
    extremes = {
        int(pick(values)) for values in (*points.T, reach) for pick in (np.argmin, np.argmax)
    }
    starts = np.cumsum([0, *(len(run.points) for run in runs)])
    # no curve between the last point of a run and the first of the next
    firsts = [
        first
        for place in sorted(extremes)
        for first in (place - 1, place)
        if first >= 0 and first + 1 not in starts
    ]
    share = np.tile(np.linspace(0.0, 1.0, _BETWEEN), len(firsts))
    between, _ = on_cubics(as_complex(points), tangents, np.repeat(firsts, _BETWEEN), share)
    return np.vstack([points, as_pairs(between)])
