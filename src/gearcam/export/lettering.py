"""Single-stroke letters for engraving: laser programs ignore fonts.

Capitals and digits on a grid of 4 by 6, as polylines.

Depends on numpy only.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array

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


def text_width(text: str) -> float:
    """Return the width of a `text` over its height."""
    return (_ADVANCE * len(text) - 2) / _TALL


def strokes(text: str, height: float, left: float, base: float) -> list[Array]:
    """Return the strokes of a text.

    Parameters
    ----------
    text : str
        Capitals and digits.
    height : float, mm
        Height of the letters.
    left, base : float, mm
        Its lower left corner.

    Returns
    -------
    list of (n, 2) array, mm
        Open chains of points.

    Raises
    ------
    KeyError
        If there is no such letter.
    """
    made = []
    for number, sign in enumerate(text):
        for stroke in filter(None, _STROKES[sign].split(", ")):
            places = np.array([[int(x), int(y)] for x, y in stroke.split()], dtype=np.float64)
            places[:, 0] += number * _ADVANCE
            made.append(places * (height / _TALL) + [left, base])
    return made
