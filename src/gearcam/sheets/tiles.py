"""Prints at full size: a drawing on as many A4 pages as it needs, to be glued together.

Neighbouring pages show a strip twice; in its middle are cross marks at the corners of each page.
Below are the row and the column of the page and a ruler of 100 mm or 4 in, to check the printer by.

Depends on drawings and sheets.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from gearcam.base.inches import file_unit
from gearcam.pictures.drawings import Cross, Drawing, Feature, Path, box
from gearcam.sheets.sheet import CENTERLINE, DIMENSION, RULE, Box, Sheet, Text, text_width

PAGE: Final = (210.0, 297.0)
"""A4, mm."""

WINDOW: Final[Box] = (10.0 + 20.0j, 200.0 + 287.0j)
"""Where the drawing is on a page, mm from its lower left corner; below are texts and ruler."""

OVERLAP: Final = 10.0
"""Width of what neighbouring pages both show, mm."""

RULERS: Final = {"mm": (100, 10, 50), "in": (4, 0.25, 1)}
"""Length of the ruler, and from one of its ticks, and long ticks, to the next, by the unit."""

_LINE: Final = 78.0
"""Width of the text beside the ruler, mm."""

PITCH: Final = WINDOW[1] - WINDOW[0] - OVERLAP * (1.0 + 1j)
"""From page to page, across and up, mm."""


def tiles(drawing: Drawing, title: str) -> Iterator[Sheet]:
    """Yield the pages of a drawing, from the upper left one on, by rows.

    Parameters
    ----------
    drawing : Drawing
        What is printed.
    title : str
        Title of the pages.
    """
    low, high = box(drawing.features)
    size = high - low
    across = max(1, math.ceil(size.real / PITCH.real - 1e-9))
    up = max(1, math.ceil(size.imag / PITCH.imag - 1e-9))
    start = 0.5 * (low + high) - 0.5 * complex(across * PITCH.real, up * PITCH.imag)
    marks = tuple(
        Feature(layer=DIMENSION, shape=Cross(center=start + complex(x, y), size=OVERLAP))
        for x in PITCH.real * np.arange(across + 1)
        for y in PITCH.imag * np.arange(up + 1)
    )
    if low.real < 0.0 < high.real and low.imag < 0.0 < high.imag:
        marks += (Feature(layer=CENTERLINE, shape=Cross(center=0j, size=20.0)),)
    for row, column in np.ndindex(up, across):
        here = start + complex(column * PITCH.real, (up - 1 - row) * PITCH.imag)
        corner = here - 0.5 * OVERLAP * (1.0 + 1j) - WINDOW[0]
        place = f"row {row + 1} of {up}, column {column + 1} of {across}"
        words = f"{title}, {drawing.name}, 1:1, {place}"
        squeeze = min(1.0, _LINE / text_width(words))
        length, ruler = _ruler(corner + 10.0 + 11.0j)
        yield Sheet(
            name=drawing.name,
            title=title,
            paper="A4",
            size=PAGE,
            scale=1.0,
            corner=corner,
            features=[*drawing.features, *marks, *ruler],
            texts=[
                Text(text=words, place=corner + 122.0 + 11.0j, squeeze=squeeze),
                Text(text=length, place=corner + 60.0 + 15.0j, anchor="middle"),
            ],
        )


def _ruler(start: complex) -> tuple[str, list[Feature]]:
    """Return the length of a ruler as text, and its lines."""
    unit = file_unit()
    length, step, long = RULERS[unit.name]
    places = [start + unit.size * at for at in np.arange(0.0, length + 0.5 * step, step)]
    each = round(long / step)
    ticks = [(at, at + (2.0j if number % each else 3.0j)) for number, at in enumerate(places)]
    return f"{length} {unit.name}", [
        Feature(layer=RULE, shape=Path(points=np.array(line), closed=False))
        for line in ((start, places[-1]), *ticks)
    ]
