"""Sheets of parts, and a lint of drawings: what a reader of a sheet would trip over."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from gearcam.numeric.arrays import lengths_along
from gearcam.parts.body import Part
from gearcam.sheets.paper import BINDING, MARGIN, Heading
from gearcam.sheets.part import part_sheet
from gearcam.sheets.sheet import FRAME, SERIES, Sheet, Text
from gearcam.sheets.spec import DrawingSpec

STEP = 0.1
"""Distance of the points of lines that are looked at, mm of paper."""

EDGE = 0.05
"""How far a line may reach into the box of a text, mm of paper."""


def heading(title: str = "t", **notes: str | float) -> Heading:
    return Heading(title=title, notes=DrawingSpec(**notes))  # type: ignore[arg-type]


def sheet_of(part: Part, facts: dict[str, str] | None = None, title: str = "t") -> Sheet:
    return part_sheet(part, facts or {}, heading(title))


def box(sheet: Sheet, text: Text) -> np.ndarray:
    """Left, low, right and high end of a text on paper, mm."""
    low, high = sheet.on_paper(np.array(text.box(sheet.unit)))
    return np.array([low.real, low.imag, high.real, high.imag])


def points(chain: np.ndarray) -> np.ndarray:
    ways = lengths_along(chain)
    count = max(2, int(ways[-1] / STEP) + 1)
    return np.interp(np.linspace(0.0, ways[-1], count), ways, chain)


def faults(sheet: Sheet) -> Iterator[str]:
    """What is wrong with a sheet, in words."""
    boxes = {id(text): (text.text, box(sheet, text)) for text in sheet.words}
    wide, tall = sheet.size
    limits = np.array([BINDING, MARGIN, wide - MARGIN, tall - MARGIN])
    for text in sheet.words:
        if text.height not in SERIES:
            yield f"height {text.height} of {text.text!r}"
        if text.squeeze < 0.5:
            yield f"{text.text!r} is squeezed to {text.squeeze:.2f}"
    for words, (left, low, right, high) in boxes.values():
        if left < limits[0] or low < limits[1] or right > limits[2] or high > limits[3]:
            yield f"{words!r} is outside the frame"
    for (one, a), (two, b) in combinations(boxes.values(), 2):
        if min(a[2], b[2]) > max(a[0], b[0]) and min(a[3], b[3]) > max(a[1], b[1]):
            yield f"{one!r} lies on {two!r}"
    inwards = np.array([EDGE, EDGE, -EDGE, -EDGE])
    every = np.array([corners for _, corners in boxes.values()]) + inwards
    names = [words for words, _ in boxes.values()]
    for line in sheet.drawn_lines:
        chain = np.append(line.points, line.points[:1]) if line.closed else line.points
        along = points(chain)
        x, y = np.real(along), np.imag(along)
        if line.layer != FRAME and (
            min(x.min() - limits[0], y.min() - limits[1]) < -1e-6
            or min(limits[2] - x.max(), limits[3] - y.max()) < -1e-6
        ):
            yield f"a line of {line.layer} is outside the frame"
        within = (
            (x[:, None] > every[:, 0])
            & (y[:, None] > every[:, 1])
            & (x[:, None] < every[:, 2])
            & (y[:, None] < every[:, 3])
        ).any(axis=0)
        yield from (f"a line of {line.layer} on {names[k]!r}" for k in np.flatnonzero(within))
    yield from twice(sheet)


def twice(sheet: Sheet) -> Iterator[str]:
    """What is dimensioned twice: the same length between the same places, or the same circle."""
    seen: set[tuple[str, tuple[float, ...]]] = set()
    for one in sheet.dimensions:
        if one.kind == "label":
            continue
        ends = one.points[1:] if len(one.points) == 3 else one.points
        key = [end.imag if one.kind == "vertical" else end.real for end in ends]
        if len(one.points) == 2:
            middle = one.points[0] if one.kind == "radius" else 0.5 * sum(one.points)
            key = [middle.real, middle.imag, one.value]
        name = one.kind, tuple(np.round(sorted(key) if len(one.points) == 3 else key, 6).tolist())
        if name in seen:
            yield f"{one.label!r} is dimensioned twice"
        seen.add(name)
