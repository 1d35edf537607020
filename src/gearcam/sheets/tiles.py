"""Prints at full size: a drawing on as many A4 pages as it needs, to be glued together.

Neighbouring pages show a strip twice; in its middle are cross marks at the corners of each page.
Below are the row and the column of the page and a ruler of 100 mm, to check the printer by.

Depends on drawings and sheets.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from gearcam.pictures.drawings import Cross, Drawing, Feature, Path, box
from gearcam.sheets.sheet import CENTERLINE, DIMENSION, RULE, Box, Sheet, Text, text_width

PAGE: Final = (210.0, 297.0)
"""A4, mm."""

WINDOW: Final[Box] = (10.0 + 20.0j, 200.0 + 287.0j)
"""Where the drawing is on a page, mm from its lower left corner; below are texts and ruler."""

OVERLAP: Final = 10.0
"""Width of what neighbouring pages both show, mm."""

RULER: Final = 100.0
"""Length of the ruler, mm."""

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
        yield Sheet(
            name=drawing.name,
            title=title,
            paper="A4",
            size=PAGE,
            scale=1.0,
            corner=corner,
            features=[*drawing.features, *marks, *_ruler(corner + 10.0 + 11.0j)],
            texts=[
                Text(text=words, place=corner + 122.0 + 11.0j, squeeze=squeeze),
                Text(text="100 mm", place=corner + 60.0 + 15.0j, anchor="middle"),
            ],
        )


def _ruler(start: complex) -> tuple[Feature, ...]:
    """Return a ruler with a tick for each 10 mm."""
    ticks = [
        (start + 10.0 * k, start + 10.0 * k + (3.0j if k % 5 == 0 else 2.0j)) for k in range(11)
    ]
    return tuple(
        Feature(layer=RULE, shape=Path(points=np.array(line), closed=False))
        for line in ((start, start + RULER), *ticks)
    )
