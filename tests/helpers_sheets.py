"""Sheets of parts, and a lint of drawings: what a reader of a sheet would trip over."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from gearcam.numeric.arrays import Plane, bounds, lengths_along
from gearcam.parts.body import Part
from gearcam.sheets.paper import BINDING, MARGIN, Heading, area_of
from gearcam.sheets.part import part_sheet
from gearcam.sheets.sheet import DIMENSION, FRAME, SERIES, Sheet, Text
from gearcam.sheets.spec import DrawingSpec

STEP = 0.1
"""Distance of the points of lines that are looked at, mm of paper."""

EDGE = 0.05
"""How far a line may reach into the box of a text, mm of paper."""

INWARDS = np.array([1.0, 1.0, -1.0, -1.0])
"""From the sides of a box, left, low, right and high, into it."""

APART, LOW = 2.3, 1.0
"""Least gap between texts beside each other, and how far these reach past each other, mm of paper.
"""


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


def corners(points: Plane) -> list[float]:
    """Left, low, right and high end of points on paper, mm."""
    low, high = bounds(points)
    return [low.real, low.imag, high.real, high.imag]


def is_box(points: Plane) -> bool:
    """Whether four corners have edges along x and y."""
    ways = np.roll(points, -1) - points
    return len(points) == 4 and bool((np.abs(ways.real * ways.imag) < 1e-6).all())


def inside(along: np.ndarray, boxes: np.ndarray) -> np.ndarray:
    """Which points, complex, are in which boxes, (n, 4)."""
    x, y = np.real(along)[:, None], np.imag(along)[:, None]
    left, low, right, high = boxes.T
    return (x > left) & (y > low) & (x < right) & (y < high)


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
    low, right = area_of(sheet.paper)[0].imag, area_of(sheet.paper)[1].real  # of the views
    for (one, a), (two, b) in combinations(boxes.values(), 2):
        gap = np.maximum(a[:2], b[:2]) - np.minimum(a[2:], b[2:])
        if max(gap) < 0.0:
            yield f"{one!r} lies on {two!r}"
        elif gap[0] < APART and gap[1] < -LOW and min(a[1], b[1]) > low and max(a[2], b[2]) < right:
            yield f"{one!r} reads on as {two!r}"
    yield from on_lines(sheet, boxes, limits)
    yield from twice(sheet)


def on_lines(
    sheet: Sheet, boxes: dict[int, tuple[str, np.ndarray]], limits: np.ndarray
) -> Iterator[str]:
    """Lines outside the frame, on the boxes of texts, and on tolerance frames."""
    every = np.array([corners for _, corners in boxes.values()]) + EDGE * INWARDS
    closed = [one.points for one in sheet.drawn_lines if one.layer == DIMENSION and one.closed]
    cells = np.array([corners(one) for one in closed if is_box(one)] or [4 * [np.nan]])
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
        within = inside(along, every - 0.5 * line.width * INWARDS).any(axis=0)
        yield from (f"a line of {line.layer} on {names[k]!r}" for k in np.flatnonzero(within))
        # the cells of a frame are drawn as such, and have whole symbols in them
        found = inside(along, cells + EDGE * INWARDS)
        if (found.any(axis=0) & ~found.all(axis=0)).any():
            yield f"a line of {line.layer} on a tolerance frame"


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
