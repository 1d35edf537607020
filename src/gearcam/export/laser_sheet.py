"""Sheets for laser cutters: parts side by side, with their names in single-stroke letters.

Parts are placed in rows, the tallest first, with the row width that gives the sheet the shortest
perimeter. Within a row each part is moved to the left until its hull is a gap away from its
neighbours' hulls: then outlines are apart too. Parts are shifted, but not turned or mirrored.

Laser programs ignore fonts: letters are capitals and digits on a grid of 4 by 6, as polylines. A
name is placed where its part has most space, or below it.

Depends on drawings; shapely inside the functions.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.numerals import NOISE
from gearcam.numeric.arrays import Array, Plane, as_pairs
from gearcam.numeric.pose import Pose
from gearcam.pictures.drawings import (
    LABEL,
    MARK,
    OUTER,
    THROUGH,
    Drawing,
    Feature,
    Path,
    box,
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


_TALL: Final = 6
_ADVANCE: Final = 6
"""Height and pitch of letters, in steps of the grid."""

_STROKES: Final = {
    " ": "",
    "A": "00 03 26 43 40, 02 42",
    "C": "45 36 16 05 01 10 30 41",
    "E": "46 06 00 40, 03 33",
    "G": "45 36 16 05 01 10 30 41 43 23",
    "M": "00 06 23 46 40",
    "P": "00 06 36 45 44 33 03",
    "R": "00 06 36 45 44 33 03, 23 40",
    "S": "45 36 16 05 04 13 33 42 41 30 10 01",
    "T": "06 46, 26 20",
    "0": "10 30 41 45 36 16 05 01 10",
    "1": "15 26 20, 10 30",
    "2": "05 16 36 45 44 00 40",
    "3": "05 16 36 45 44 33 13, 33 42 41 30 10 01",
    "4": "30 36 02 42",
    "5": "46 06 03 33 42 41 30 10 01",
    "6": "45 36 16 05 01 10 30 41 42 33 13 02",
    "7": "06 46 10",
    "8": "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33",
    "9": "44 33 13 04 05 16 36 45 41 30 10 01",
}
"""Points of each stroke, x and y in steps of the grid."""

_HIGHEST: Final = 5.0
_LOWEST: Final = 1.5
"""Heights of letters, mm: as the space allows, or below the part if that is too low."""

_BELOW: Final = 3.0
"""Distance of a name below its part, mm."""

_FREE: Final = 1.0
"""Least distance of a name from every edge, mm."""

_COARSE: Final = 0.05
"""Tolerance of the space for a name, mm."""

_SAGITTA: Final = 0.01
"""Chord error of openings, mm."""


def labelled(drawing: Drawing) -> Drawing:
    """Return the `drawing` of a part with its name in single strokes."""
    words = re.sub(r"(\d+)", r" \1", drawing.name.replace("_", " ")).upper()
    wide = text_width(words)
    middle, room = _roomiest(drawing)
    height = min(_HIGHEST, 2.0 * (room - _FREE) / math.hypot(wide, 1.0))
    corner = middle - 0.5 * height * complex(wide, 1.0)
    if height < _LOWEST:
        height = _LOWEST
        low, high = box(drawing.features)
        left = 0.5 * (low.real + high.real - wide * height)
        corner = complex(left, low.imag - _BELOW - height)
    lines = strokes(words, height, corner)
    names = (Feature(layer=LABEL, shape=Path(points=line, closed=False)) for line in lines)
    return replace(drawing, features=(*drawing.features, *names))


def _roomiest(drawing: Drawing) -> tuple[complex, float]:
    """Return the centre and the radius of the largest free circle."""
    from shapely import Polygon, maximum_inscribed_circle

    def points(feature: Feature) -> Array:
        shape: Any = feature.shape
        return as_pairs(shape.polyline(_SAGITTA))

    (outer,) = (points(one) for one in drawing.features if one.kind in OUTER)
    inner = [points(one) for one in drawing.features if one.kind in (*THROUGH, MARK)]
    free: Any = Polygon(outer, inner).simplify(_COARSE)
    spoke: Any = maximum_inscribed_circle(free, tolerance=_COARSE)
    return complex(*spoke.coords[0]), float(spoke.length) - _COARSE


def text_width(text: str) -> float:
    """Return the width of a `text` over its height."""
    return (_ADVANCE * len(text) - 2) / _TALL


def strokes(text: str, height: float, corner: complex) -> list[Plane]:
    """Return the strokes of a text.

    Parameters
    ----------
    text : str
        Capitals and digits.
    height : float, mm
        Height of the letters.
    corner : complex, mm
        Its lower left corner.

    Returns
    -------
    list of (n,) complex array, mm
        Open chains of points.

    Raises
    ------
    KeyError
        If there is no such letter.
    """
    lines = []
    for number, sign in enumerate(text):
        for stroke in filter(None, _STROKES[sign].split(", ")):
            places = np.array([complex(int(x), int(y)) for x, y in stroke.split()])
            lines.append((places + number * _ADVANCE) * (height / _TALL) + corner)
    return lines
