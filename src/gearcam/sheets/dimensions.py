"""Dimensions as they are drawn: lines, arrow heads and a text (ISO 129-1).

Depends on sheets only.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Plane
from gearcam.parts.shapes import Circle
from gearcam.sheets.sheet import GAP, HEIGHT, SheetDimension, Text, length_text, text_width

ARROW: Final = 3.0
"""Length of an arrow head, mm of paper."""

TAIL: Final = 5.0
"""Length of the line behind an arrow that points inwards, mm of paper."""

LEAST_GAP: Final = 1.0
PAST: Final = 1.5
"""Gap from the part to an extension line, and its overrun past the dimension line, mm of paper."""

ARROW_ROOM: Final = 2 * ARROW + GAP
"""Length of dimension lines, mm of paper, below which arrows are outside."""

UPRIGHT: Final = 1e-9
"""How far a leader to the right goes to the right at least, mm of paper."""

SHELF: Final = HEIGHT + GAP
"""Height of a text with the line below it, mm of paper."""


@dataclass(frozen=True, eq=False)
class Measure:
    """A length along x or y, from `first` to `second`, complex, mm.

    Without a `text` it says the number; an `aside` one follows from others, in parentheses.
    """

    first: complex
    second: complex
    text: str = ""
    aside: bool = False

    def ends(self, vertical: bool) -> tuple[float, float]:
        """Return the coordinates of both points along y if `vertical`, else along x, mm."""
        first, second = self.first, self.second
        return (first.imag, second.imag) if vertical else (first.real, second.real)

    def length(self, vertical: bool) -> float:
        """Return its length along y if `vertical`, else along x, mm."""
        first, second = self.ends(vertical)
        return abs(second - first)


def diameter_text(diameter: float) -> str:
    """Return a `diameter`, mm, as the text of a dimension."""
    return f"Ø{length_text(diameter)}"


def arrow_head(tip: complex, way: complex, unit: float) -> Plane:
    """Return an arrow head.

    Parameters
    ----------
    tip : complex, mm
        Point of the arrow.
    way : complex
        Unit vector of its direction.
    unit : float
        Millimetres of the part in a millimetre of paper.

    Returns
    -------
    (3,) complex array, mm
        Tip and back corners.
    """
    back = tip - ARROW * unit * way
    side = ARROW * unit / 6.0 * 1j * way
    return np.array([tip, back + side, back - side])


def linear(
    one: Measure, at: float, unit: float, beyond: float, *, vertical: bool
) -> SheetDimension:
    """Return a dimension along x or y.

    Parameters
    ----------
    one : Measure
        What it measures.
    at : float, mm
        y of the dimension line, x of a vertical one.
    unit : float
        Millimetres of the part in a millimetre of paper.
    beyond : float, mm
        Where a text that is too wide begins, if this is behind the second point.
    vertical : bool
        Whether it is measured along y.
    """
    way, level = (1j, at) if vertical else (1.0, 1j * at)
    ends = one.ends(vertical)
    low, high = sorted(ends)
    words = one.text or length_text(high - low)
    label = f"({words})" if one.aside else words
    lines = []
    for point, end in zip((one.first, one.second), ends, strict=True):
        foot = level + end * way
        if abs(foot - point) > LEAST_GAP * unit:
            away = (foot - point) / abs(foot - point) * unit
            lines.append(np.array([point + LEAST_GAP * away, foot + PAST * away]))
    wide, inwards = text_width(label) * unit, high - low < ARROW_ROOM * unit
    tail = TAIL * unit if inwards else 0.0
    start, end, middle = low - tail, high + tail, 0.5 * (low + high)
    if wide + 2.0 * GAP * unit > high - low:
        begin = max(end, beyond) + 2 * GAP * unit
        middle, end = begin + 0.5 * wide, begin + wide
    lines.append(level + np.array([start, end]) * way)
    out = -way if inwards else way
    place = level + middle * way + GAP * unit * 1j * way
    return SheetDimension(
        kind="vertical" if vertical else "linear",
        value=high - low,
        points=(level + high * way, one.first, one.second),
        lines=tuple(lines),
        heads=(
            arrow_head(level + low * way, -out, unit),
            arrow_head(level + high * way, out, unit),
        ),
        text=Text(text=label, place=place, anchor="middle", upright=vertical),
    )


def shelf(label: str) -> float:
    """Return the length of the line below a text with a leader, mm of paper."""
    return text_width(label) + GAP


def leader(
    circle: Circle, angle: float, knee: float, label: str, kind: str, unit: float
) -> SheetDimension:
    """Return a diameter, a radius or a label with a leader and its text on a shelf.

    Parameters
    ----------
    circle : Circle
        What it points to.
    angle : float, rad
        Direction from the centre to the arrow.
    knee : float, mm
        Distance from the centre where the leader bends into the line under the text.
    label, kind : str
        Its text, and of what kind it is (see `SheetDimension`).
    unit : float
        Millimetres of the part in a millimetre of paper.
    """
    center, radius, spoke = circle.center, 0.5 * circle.diameter, cmath.rect(1.0, angle)
    edge, bend = center + radius * spoke, center + knee * spoke
    wide = shelf(label) * unit
    end = bend + (-wide if (knee - radius) / unit * spoke.real <= UPRIGHT else wide)
    across = kind == "diameter"
    return SheetDimension(
        kind=kind,
        value=circle.diameter if across else radius,
        points=(center - radius * spoke if across else center, edge),
        lines=(np.array([edge, bend, end]),),
        heads=(arrow_head(edge, -spoke if knee > radius else spoke, unit),),
        text=Text(text=label, place=0.5 * (bend + end) + 1j * GAP * unit, anchor="middle"),
    )
