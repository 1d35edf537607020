"""Extents of outlines: sizes of the true curve, not of its chords.

Depends on numeric and parts' shapes.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Plane
from gearcam.numeric.contour import Contour
from gearcam.numeric.hermite import on_cubics
from gearcam.parts.shapes import Circle

_BETWEEN: Final = 129
"""Points on the cubic between two dense points."""


def true_points(edges: Iterable[Contour | Circle]) -> Plane:
    """Return points on true edges, complex, mm: dense, and much denser at extreme points.

    Extremes along x and y and of the distance from the origin are exact to 1e-8 mm: between dense
    points the curve is a cubic with the tangents at its ends. For circles only the extremes along x
    and y are returned.
    """
    return np.concatenate([_points(edge) for edge in edges])


def _points(edge: Contour | Circle) -> Plane:
    if isinstance(edge, Circle):
        radius = 0.5 * edge.diameter
        return np.array([edge.center + way * radius for way in (1.0, 1j, -1.0, -1j)])
    runs = edge.runs
    points = np.concatenate([run.points for run in runs])
    tangents = np.concatenate([run.tangents for run in runs])
    extremes = {
        int(pick(values))
        for values in (points.real, points.imag, np.abs(points))
        for pick in (np.argmin, np.argmax)
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
    between, _ = on_cubics(points, tangents, np.repeat(firsts, _BETWEEN), share)
    return np.concatenate([points, between])


def extremes(points: Plane) -> tuple[complex, complex, complex, complex]:
    """Return the leftmost, lowest, rightmost and highest of some points, complex, mm."""
    x, y = points.real, points.imag
    left, low, right, high = points[[x.argmin(), y.argmin(), x.argmax(), y.argmax()]].tolist()
    return left, low, right, high
