"""Names of parts for engraving, in single-stroke letters: laser programs ignore fonts.

Capitals and digits on a grid of 4 by 6, as polylines. A name is placed where its part has most
space, or below it.

Depends on drawings; shapely inside the functions.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any, Final

import numpy as np

from gearcam.numeric.arrays import Array, Plane, as_pairs
from gearcam.pictures.drawings import LABEL, MARK, OUTER, THROUGH, Drawing, Feature, Path, box

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
    made = []
    for number, sign in enumerate(text):
        for stroke in filter(None, _STROKES[sign].split(", ")):
            places = np.array([complex(int(x), int(y)) for x, y in stroke.split()])
            made.append((places + number * _ADVANCE) * (height / _TALL) + corner)
    return made
