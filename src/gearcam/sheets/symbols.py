"""Symbols beside dimensions: line of a section, datum, and tolerance frames (ISO 1101, 5459).

Depends on sheets only.
"""

from __future__ import annotations

import cmath
import math
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array
from gearcam.parts.shapes import Circle
from gearcam.sheets.board import Board
from gearcam.sheets.dimensions import UPRIGHT
from gearcam.sheets.sheet import CENTERLINE, CUT, DIMENSION, HEIGHT, Text, text_width

FRAME: Final = 2.0 * HEIGHT
"""Height of a tolerance frame, mm of paper."""

DATUM: Final = "B"
"""Letter of the datum: A is the section."""


def section_line(board: Board, x: float, low: float, high: float) -> None:
    """Draw on a `board` the line of the section A-A at `x` through a view, `low` to `high`, mm."""
    unit = board.unit
    board.line(CENTERLINE, complex(x, low - 2.0 * unit), complex(x, high + 2.0 * unit))
    for end, way in ((low, -1.0), (high, 1.0)):
        near, far = (complex(x, end + way * unit * away) for away in (2.0, 8.0))
        board.line(CUT, near, far)
        at = far - 1j * way * unit
        board.line(DIMENSION, at, at + 6.0 * unit)
        board.arrow(at + 6.0 * unit, 1.0)


def section_letters(board: Board, x: float, low: float, high: float) -> None:
    """Write on a `board` the letters of a line at `x` from `low` to `high` where there is space."""
    for end, way in ((low, -1.0), (high, 1.0)):
        far = complex(x, end + way * 7.0 * board.unit) - 1.75j * board.unit
        board.first_free(
            Text(text="A", place=far + away * board.unit, height=3.5, anchor="middle")
            for away in (9.0, -2.8, 8.5 + 4.0j * way, -2.5 + 4.0j * way, 14.0, -8.0)
        )


def _box(board: Board, low: complex, *cells: str) -> None:
    """Draw cells of a frame with a text each, from their lower left corner, mm."""
    unit = board.unit
    for text in cells:
        wide = max(FRAME, text_width(text) + 2.0) if text else FRAME
        corners = (low + unit * at for at in (0.0, wide, complex(wide, FRAME), 1j * FRAME))
        board.line(DIMENSION, *corners, closed=True)
        board.take(low, low + unit * complex(wide, FRAME))
        if text:
            place = low + complex(0.5 * wide, 0.5 * (FRAME - HEIGHT)) * unit
            board.write(Text(text=text, place=place, anchor="middle"))
        low += wide * unit


def datum(board: Board, point: complex, way: complex) -> None:
    """Draw on a `board` the datum at a `point`, mm, on the side of the unit vector `way`."""
    unit = board.unit
    side, back = 1.5j * way * unit, point + 2.6 * way * unit
    board.fills.append(np.array([point + side, point - side, back]))
    stem = back + 3.0 * way * unit
    board.line(DIMENSION, back, stem)
    middle = stem + 0.5 * FRAME * way * unit
    _box(board, middle - 0.5 * FRAME * unit * (1.0 + 1j), DATUM)


def frame(
    board: Board, point: complex, kind: str, *cells: str, angles: Array | None = None
) -> None:
    """Draw a tolerance frame with a leader to a `point`; the table says it if there is no space.

    Parameters
    ----------
    board : Board
        The sheet.
    point : complex, mm
        On the edge that it is about.
    kind : {"runout", "profile"}
        Circular run-out, or the profile of a line.
    *cells : str
        The tolerance, and the datum if it has one.
    angles : (n,) array, rad, optional
        Allowed directions of the leader from the point; any by default.
    """
    unit = board.unit
    wide = FRAME + sum(max(FRAME, text_width(one) + 2.0) for one in cells)
    spot = Circle(center=point, diameter=0.02 * unit)
    found = board.place(spot, complex(wide, FRAME), angles)
    if found is None:
        name = {"runout": "circular run-out", "profile": "profile of the outline"}[kind]
        board.rows.append((name, " ".join(cells)))
        return
    angle, knee = found
    spoke = cmath.rect(1.0, angle)
    bend = point + knee * spoke
    low = bend - (wide * unit if spoke.real <= UPRIGHT else 0.0)
    board.line(DIMENSION, point, bend)
    board.arrow(point, -spoke)
    _box(board, low, "", *cells)
    middle = low + 0.5 * FRAME * unit * (1.0 + 1j)
    if kind == "profile":
        arc = 1.4 * unit * np.exp(1j * np.linspace(0.0, math.pi, 19))
        board.line(DIMENSION, *(middle - 0.7j * unit + arc).tolist(), closed=True)
    else:
        rise = cmath.rect(1.7 * unit, math.radians(50.0))
        board.line(DIMENSION, middle - rise, middle + rise)
        board.arrow(middle + rise, rise / abs(rise), 0.6)
