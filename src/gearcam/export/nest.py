"""Nesting: parts side by side on a sheet.

Parts are placed in rows, the tallest first, with the row width that gives the sheet the shortest
perimeter. Within a row each part is moved to the left until its hull is a gap away from its
neighbours' hulls: then outlines are apart too. Parts are shifted, but not turned or mirrored.

Depends on drawings; shapely inside the functions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.numerals import NOISE
from gearcam.numeric.arrays import Array, as_pairs
from gearcam.numeric.pose import Pose
from gearcam.pictures.drawings import (
    LABEL,
    OUTER,
    Drawing,
    place,
    reach,
)

if TYPE_CHECKING:
    from shapely import Polygon


GAP: Final = 3.0
"""Least distance between the cuts of two parts, mm."""

_NEAR: Final = 1e-3
"""Tolerance of the gap, mm."""


def nested(drawings: Sequence[Drawing]) -> tuple[Drawing, ...]:
    """Return `drawings` of parts shifted so that they are side by side, in order."""
    hulls = [_hull(one) for one in drawings]
    sizes = np.array([np.subtract(hull.bounds[2:], hull.bounds[:2]) for hull in hulls])
    order = np.argsort(-np.round(sizes[:, 1]), kind="stable").tolist()
    widths = accumulate(float(sizes[k, 0]) + GAP for k in order)
    rows = min(
        (_rows(order, sizes, width) for width in widths), key=lambda it: _half_perimeter(it, sizes)
    )
    poses: dict[int, Pose] = {}
    base = 0.0
    for row in rows:
        poses |= _pushed(row, hulls, base)
        base -= max(float(sizes[k, 1]) for k in row) + GAP
    return tuple(
        replace(one, features=place(one.features, poses[k])) for k, one in enumerate(drawings)
    )


def _hull(drawing: Drawing) -> Polygon:
    from shapely import MultiPoint

    kinds = (*OUTER, LABEL)
    corners = [reach(one.shape) for one in drawing.features if one.kind in kinds]
    hull: Any = MultiPoint(as_pairs(np.concatenate(corners))).convex_hull
    return hull


def _rows(order: Sequence[int], sizes: Array, width: float) -> list[list[int]]:
    """Return rows of a given width, filled with the parts in order."""
    rows: list[list[int]] = []
    left = 0.0
    for k in order:
        wide = float(sizes[k, 0]) + GAP
        if not rows or wide > left * (1.0 + NOISE):
            rows.append([])
            left = width
        rows[-1].append(k)
        left -= wide
    return rows


def _half_perimeter(rows: Sequence[Sequence[int]], sizes: Array) -> float:
    """Return half the perimeter of the bounding box of rows, mm."""
    wide = max(float((sizes[row, 0] + GAP).sum()) for row in rows)
    return wide + sum(float(sizes[row, 1].max()) + GAP for row in rows)


def _pushed(row: Sequence[int], hulls: Sequence[Any], base: float) -> dict[int, Pose]:
    """Return the poses of hulls on a line below y = `base`, each as far left as gaps allow."""
    from shapely import distance
    from shapely.affinity import translate

    foot = base - max(hulls[k].bounds[3] - hulls[k].bounds[1] for k in row)
    pushed: list[Any] = []
    poses: dict[int, Pose] = {}
    for k in row:
        left, low, _, _ = hulls[k].bounds
        x = max((one.bounds[2] + GAP for one in pushed), default=0.0)
        while x > 0.0 and pushed:
            # distances decrease by at most the movement
            there = translate(hulls[k], x - left, foot - low)
            free = float(distance(there, np.array(pushed, dtype=object)).min()) - GAP
            if free < _NEAR:
                break
            x = max(0.0, x - free)
        poses[k] = Pose(shift=complex(x - left, foot - low))
        pushed.append(translate(hulls[k], x - left, foot - low))
    return poses
