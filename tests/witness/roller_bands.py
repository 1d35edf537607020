"""A groove once more: all rollers along a pitch curve, each a polygon, and what they leave.

The pitch curve is a row of centres, as a witness of the follower gives them; a cutter as wide as
the groove stands at every one of them. The walls are the edges of what they have covered together.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

Region = Any


def band(centers: Any, radius: float, quarter: int = 256) -> Region:
    """What discs of a radius cover whose middles run along a closed chain of points, mm."""
    ring = shapely.LinearRing(np.column_stack([centers.real, centers.imag]))
    return ring.buffer(radius, quad_segs=quarter)


def island(region: Region) -> Region:
    """What is left within a band about the origin; nothing where the axis is covered."""
    axis = shapely.Point(0.0, 0.0)
    found = [shapely.Polygon(hole) for hole in region.interiors]
    return next((one for one in found if one.contains(axis)), shapely.Polygon())


def lift(edge: Any, theta: float, radius: float, offset: float, *, outwards: bool) -> float:
    """Height of a translating roller's centre that is pressed onto a dense row of points, mm."""
    points = edge * np.exp(1j * theta)
    aside = points.real - offset
    near = (np.abs(aside) < radius) & (points.imag > 0.0)
    half = np.sqrt(radius**2 - aside[near] ** 2)
    heights = points.imag[near]
    return float((heights - half).min() if outwards else (heights + half).max())
