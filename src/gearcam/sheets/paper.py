"""Paper: size and scale of a sheet, its frame, parameter table, title block and notes.

A4 or A3 landscape with a binding margin, scales of ISO 5455 (1, 2 and 5 times powers of ten). The
table stands on the right, the title block below it, notes beside that; the rest is the *area* of
the views. The smaller paper is taken where it shows the part at its true size or larger, or no
smaller than the larger paper would.

Depends on drawings and sheets.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.drawings import Feature, Path
from gearcam.numerals import shown
from gearcam.numeric.arrays import Array
from gearcam.sheets.board import Board
from gearcam.sheets.sheet import FRAME, GLYPH, HEIGHT, Box, Sheet, Text

PAPERS: Final = {"A4": (297.0, 210.0), "A3": (420.0, 297.0)}
"""Width and height, mm."""

BINDING: Final = 20.0
MARGIN: Final = 10.0
"""From the paper's left edge, and from the others, to the frame, mm."""

TABLE: Final = 80.0
LABELS: Final = 38.0
ROW: Final = 5.0
"""Width of the table and of its labels, and height of a row, mm."""

BLOCK: Final = (150.0, 24.0)
"""Width and height of the title block, mm."""

PAD: Final = 3.0
"""Between the views and what stands around them, mm."""

INSET: Final = 1.5
"""From a cell's edge to its text, mm."""

SMALL: Final = 1.6
"""Height of the labels in the title block, mm."""

SCALES: Final = tuple(base * 10.0**power for power in range(2, -7, -1) for base in (5.0, 2.0, 1.0))[
    2:
]
"""100:1 and smaller."""

PROJECTION: Final = "first angle"
"""The view from the left stands on the right."""


@dataclass(frozen=True, kw_only=True)
class Format:
    """A `paper` and a `scale`, millimetres of paper over millimetres of the part."""

    paper: str
    scale: float

    @property
    def words(self) -> str:
        """The scale as it is written, such as 1:2."""
        if self.scale >= 1.0:
            return f"{shown(self.scale)}:1"
        return f"1:{shown(1.0 / self.scale)}"


def area_of(paper: str) -> Box:
    """Return the corners of the views' area on a `paper`, (2,) each, mm of paper."""
    wide, tall = PAPERS[paper]
    low = np.array([BINDING + PAD, MARGIN + BLOCK[1] + PAD])
    return low, np.array([wide - MARGIN - TABLE - PAD, tall - MARGIN - PAD])


def choose(size: tuple[float, float], room: tuple[float, float], rows: int) -> Format:
    """Choose paper and scale.

    Parameters
    ----------
    size : (float, float), mm
        Width and height of all views together.
    room : (float, float), mm of paper
        What dimensions and gaps take beside them.
    rows : int
        Of the table.

    Returns
    -------
    Format

    Raises
    ------
    ValueError
        If the views are too large for the smallest scale.
    """
    found = []
    for paper, (_, tall) in PAPERS.items():
        low, high = area_of(paper)
        free = high - low - np.array(room)
        fits = [scale for scale in SCALES if (scale * np.array(size) <= free).all()]
        long = (rows + 1) * ROW > tall - 2 * MARGIN - BLOCK[1]
        if fits and not (long and paper == "A4"):
            found.append(Format(paper=paper, scale=fits[0]))
    if not found:
        raise ValueError(f"views of {shown(size[0])} x {shown(size[1])} mm fit on no sheet")
    true = [one for one in found if one.scale >= 1.0]
    return true[0] if true else max(found, key=lambda one: one.scale)


def begin(size: tuple[float, float], room: Box, low: Array, rows: int) -> Board:
    """Begin a sheet: the views in the middle of their area.

    Parameters
    ----------
    size : (float, float), mm
        Width and height of all views together.
    room : (2,) array, (2,) array, mm of paper
        What dimensions take to the left and below, and to the right and above.
    low : (2,) array, mm
        Lower left corner of the views.
    rows : int
        Of the table.

    Returns
    -------
    Board
        Empty, on the paper that is chosen.

    Raises
    ------
    ValueError
        If the views are too large for the smallest scale.
    """
    wide, tall = (room[0] + room[1]).tolist()
    form = choose(size, (wide, tall), rows)
    first, last = area_of(form.paper)
    idle = last - first - room[0] - room[1] - form.scale * np.array(size)
    corner = low - (first + room[0] + 0.5 * idle) / form.scale
    area = corner + first / form.scale, corner + last / form.scale
    return Board(scale=form.scale, area=area, paper=form.paper, corner=corner)


def finish(
    board: Board, *, name: str, title: str, facts: Mapping[str, str], notes: Sequence[str]
) -> Sheet:
    """Draw frame, table, title block and notes around the views.

    Parameters
    ----------
    board : Board
        With its views.
    name, title : str
        Of the sheet.
    facts : mapping of str to str
        First rows of the table; those of the board follow.
    notes : sequence of str
        Beside the title block.

    Returns
    -------
    Sheet
    """
    size, corner = PAPERS[board.paper], board.corner
    form = Format(paper=board.paper, scale=board.scale)
    rows = (*facts.items(), *board.rows)
    pen = _Pen(corner=corner, unit=board.unit, lines=[], texts=[])
    left, right, top = BINDING, size[0] - MARGIN, size[1] - MARGIN
    pen.chain([(left, MARGIN), (right, MARGIN), (right, top), (left, top)], closed=True)
    _table(pen, rows, (right - TABLE, top))
    _block(pen, form, (name, title), (right - BLOCK[0], MARGIN))
    high = MARGIN + BLOCK[1]
    wide = right - BLOCK[0] - left - 2 * INSET
    height = min([HEIGHT, *(wide / (GLYPH * len(note)) for note in notes if note)])
    for number, note in enumerate(notes, start=1):
        pen.write(note, (left + INSET, high - 1.8 * HEIGHT * number), wide, height)
    return Sheet(
        name=name,
        title=title,
        paper=form.paper,
        size=size,
        scale=form.scale,
        corner=corner,
        features=(*board.features, *pen.lines),
        dimensions=tuple(board.dimensions),
        texts=(*board.texts, *pen.texts),
        rows=rows,
        notes=tuple(notes),
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class _Pen:
    """Writes in millimetres of paper."""

    corner: Array
    unit: float
    lines: list[Feature]
    texts: list[Text]

    def chain(self, points: Sequence[tuple[float, float]], *, closed: bool = False) -> None:
        placed = self.corner + self.unit * np.array(points)
        self.lines.append(Feature(layer=FRAME, shape=Path(points=placed, closed=closed)))

    def write(
        self, text: str, place: tuple[float, float], wide: float, height: float = HEIGHT
    ) -> None:
        """Write a line, smaller if it is longer than its room; line breaks become blanks."""
        text = " ".join(text.split())
        if text:
            height = min(height, wide / (GLYPH * len(text)))
            at = self.corner + self.unit * np.array(place)
            self.texts.append(Text(text=text, place=at, height=height))


def _table(pen: _Pen, rows: Sequence[tuple[str, str]], corner: tuple[float, float]) -> None:
    """Draw the table down from its upper left corner; long ones have lower rows."""
    (left, top), right = corner, corner[0] + TABLE
    if not rows:
        return
    row = min(ROW, (top - MARGIN - BLOCK[1]) / len(rows))
    low = top - row * len(rows)
    pen.chain([(left, top), (left, low), (right, low)])
    pen.chain([(left + LABELS, top), (left + LABELS, low)])
    for number, (label, value) in enumerate(rows, start=1):
        base = top - row * number
        if number < len(rows):
            pen.chain([(left, base), (right, base)])
        height, up = min(HEIGHT, 0.5 * row), base + 0.27 * row
        pen.write(label, (left + INSET, up), LABELS - 2 * INSET, height)
        pen.write(value, (left + LABELS + INSET, up), TABLE - LABELS - 2 * INSET, height)


def _block(pen: _Pen, form: Format, words: tuple[str, str], corner: tuple[float, float]) -> None:
    """Draw the title block up from its lower left corner."""
    (left, low), row = corner, BLOCK[1] / 3.0
    name, title = words
    cells = [
        (0.0, 2, BLOCK[0], "title", title, 4.0),
        (0.0, 1, 100.0, "drawing", name, 3.0),
        (100.0, 1, 50.0, "scale", form.words, 3.0),
        (0.0, 0, 50.0, "units", "mm, deg", 3.0),
        (50.0, 0, 50.0, "projection", PROJECTION, 3.0),
        (100.0, 0, 50.0, "paper", form.paper, 3.0),
    ]
    for across, up, wide, label, value, height in cells:
        x, y = left + across, low + row * up
        pen.chain([(x, y), (x, y + row), (x + wide, y + row)])
        pen.write(label, (x + INSET, y + row - SMALL - 0.8), wide - 2 * INSET, SMALL)
        indent = 15.0
        pen.write(value, (x + indent, y + 0.28 * row), wide - indent - INSET, height)
