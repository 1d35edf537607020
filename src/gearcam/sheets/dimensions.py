"""Dimensions as they are drawn: lines, arrow heads and a text (ISO 129-1).

Depends on sheets only.
"""

from __future__ import annotations

import cmath
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Plane
from gearcam.sheets.sheet import GAP, HEIGHT, SheetDimension, Text, text_width

ARROW: Final = 3.0
"""Length of an arrow head, mm of paper."""

TAIL: Final = 5.0
"""Length of the line behind an arrow that points inwards, mm of paper."""

LEAST_GAP: Final = 1.0
PAST: Final = 1.5
"""Gap from the part to an extension line, and its overrun past the dimension line, mm of paper."""

ARROW_ROOM: Final = 2 * ARROW + GAP
"""Length of dimension lines, mm of paper, below which arrows are outside."""


def along(point: complex, vertical: bool) -> float:
    """Return a coordinate of a `point`: y if `vertical`, else x."""
    return point.imag if vertical else point.real


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
    first: complex,
    second: complex,
    at: float,
    label: str,
    unit: float,
    *,
    vertical: bool = False,
    beyond: float | None = None,
) -> SheetDimension:
    """Return a dimension along x or y.

    Parameters
    ----------
    first, second : complex, mm
        The points.
    at : float, mm
        y of the dimension line, x of a vertical one.
    label : str
        Its text.
    unit : float
        Millimetres of the part in a millimetre of paper.
    vertical : bool
        Whether it is measured along y.
    beyond : float, mm, optional
        Where a text that is too wide begins, if this is behind the second point.
    """
    way, level = (1j, at) if vertical else (1.0, 1j * at)
    low, high = sorted((along(first, vertical), along(second, vertical)))
    lines = []
    for point in (first, second):
        foot = level + along(point, vertical) * way
        if abs(foot - point) > LEAST_GAP * unit:
            away = (foot - point) / abs(foot - point) * unit
            lines.append(np.array([point + LEAST_GAP * away, foot + PAST * away]))
    wide = text_width(label) * unit
    inwards = high - low < ARROW_ROOM * unit
    start, end, middle = low, high, 0.5 * (low + high)
    if inwards:
        start, end = low - TAIL * unit, high + TAIL * unit
    if wide + 2.0 * GAP * unit > high - low:
        begin = max(end if inwards else high, high if beyond is None else beyond) + 2 * GAP * unit
        middle, end = begin + 0.5 * wide, begin + wide
    lines.append(level + np.array([start, end]) * way)
    turn = -1.0 if inwards else 1.0
    place = level + middle * way + GAP * unit * 1j * way
    return SheetDimension(
        kind="vertical" if vertical else "linear",
        value=high - low,
        points=(level + high * way, first, second),
        lines=tuple(lines),
        heads=tuple(
            arrow_head(level + stop * way, outwards * way, unit)
            for stop, outwards in ((low, -turn), (high, turn))
        ),
        text=Text(text=label, place=place, anchor="middle", upright=vertical),
    )


def leader(
    center: complex, radius: float, angle: float, knee: float, label: str, kind: str, unit: float
) -> SheetDimension:
    """Return a diameter, a radius or a label with a leader and its text on a shelf.

    Parameters
    ----------
    center : complex, mm
        Centre of the circle.
    radius : float, mm
        Its radius.
    angle : float, rad
        Direction from the centre to the arrow.
    knee : float, mm
        Distance from the centre where the leader bends into the line under the text.
    label, kind : str
        Its text, and of what kind it is (see `SheetDimension`).
    unit : float
        Millimetres of the part in a millimetre of paper.
    """
    spoke = cmath.rect(1.0, angle)
    edge, bend = center + radius * spoke, center + knee * spoke
    wide = text_width(label) * unit
    left = (knee - radius) / unit * spoke.real <= UPRIGHT
    end = bend + (-wide if left else wide)
    return SheetDimension(
        kind=kind,
        value=2.0 * radius if kind == "diameter" else radius,
        points=(center - radius * spoke if kind == "diameter" else center, edge),
        lines=(np.array([edge, bend, end]),),
        heads=(arrow_head(edge, -spoke if knee > radius else spoke, unit),),
        text=Text(text=label, place=0.5 * (bend + end) + 1j * GAP * unit, anchor="middle"),
    )


UPRIGHT: Final = 1e-9
"""How far a leader to the right goes to the right at least, mm of paper."""

SHELF: Final = HEIGHT + GAP
"""Height of a text with the line below it, mm of paper."""
