"""Closed contours made of smooth runs, and the polygon that stands for them.

A *run* is a smooth piece of a true curve between two corners, sampled densely with its tangents. A
*contour* is the closed chain of runs, with the adaptive polygon drawn from it: vertices on the true
curve, no chord farther from it than the tolerance.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from shapely import Polygon

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, kw_only=True)
class Run:
    """A smooth piece of a curve between two corners.

    Parameters
    ----------
    points : (n, 2) array, mm
        Points on the true curve, dense: chord error at most 1/32 of the contour's tolerance.
    tangents : (n, 2) array
        Unit tangents, forward along the contour.
    """

    points: Array
    tangents: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class Contour:
    """A closed, counter-clockwise curve.

    Parameters
    ----------
    runs : tuple of Run
        In order; each begins where the one before ends.
    vertices : (k, 2) array, mm
        The adaptive polygon, first point not repeated.
    tolerance : float, mm
        The chord error that was allowed.
    chord_error : float, mm
        The chord error measured against the dense runs.
    """

    runs: tuple[Run, ...]
    vertices: Array
    tolerance: float
    chord_error: float

    @cached_property
    def area(self) -> float:
        """Area of the polygon, mm^2."""
        return polygon_area(self.vertices)

    @cached_property
    def polygon(self) -> Polygon:
        """The polygon as a shapely region."""
        from shapely import Polygon

        return Polygon(self.vertices)


def polygon_area(vertices: Array) -> float:
    """Return the signed area of a polygon, counter-clockwise positive.

    Parameters
    ----------
    vertices : (n, 2) array, mm
        First point not repeated.

    Returns
    -------
    float, mm^2
        By the shoelace formula about the first vertex.
    """
    x, y = (vertices - vertices[0]).T
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))
