"""Paper: size and scale of a sheet, its frame, parameter table, title block and notes.

A4 or A3 landscape with a binding margin, scales of ISO 5455 (1, 2 and 5 times powers of ten). The
table is on the right, the title block below it, notes beside that; the rest is the *area* of the
views. The smaller paper is used if it shows the part at full size or larger, or at the same scale
as the larger paper.

Depends on drawings, facts and sheets.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Facts, NamedFact
from gearcam.base.numerals import formatted
from gearcam.pictures.drawings import Path
from gearcam.sheets.board import Board
from gearcam.sheets.sheet import FRAME, GLYPH, HEIGHT, Box, Sheet, Text

PAPERS: Final = {"A4": (297.0, 210.0), "A3": (420.0, 297.0)}
"""Width and height, mm."""

BINDING: Final = 20.0
MARGIN: Final = 10.0
"""Margins of the frame from the paper's left edge, and from the other edges, mm."""

TABLE: Final = 86.0
LABELS: Final = 45.0
ROW: Final = 5.0
"""Width of the table and of its labels, and height of a row, mm."""

BLOCK: Final = (150.0, 24.0)
"""Width and height of the title block, mm."""

PAD: Final = 3.0
"""Gap around the views, mm."""

INSET: Final = 1.5
"""Distance of a cell's text from its edge, mm."""

SMALL: Final = 1.6
"""Height of the labels in the title block, mm."""

SCALES: Final = tuple(base * 10.0**power for power in range(2, -7, -1) for base in (5.0, 2.0, 1.0))[
    2:
]
"""100:1 and smaller."""

_FEW: Final = 4
"""Digits of numbers in rows with several numbers."""

PROJECTION: Final = "first angle"
"""The view from the left is placed on the right."""


def scale_words(scale: float) -> str:
    """Return a `scale` as text, such as 1:2."""
    return f"{formatted(scale)}:1" if scale >= 1.0 else f"1:{formatted(1.0 / scale)}"


def area_of(paper: str) -> Box:
    """Return the corners of the views' area on a `paper`, mm of paper."""
    wide, tall = PAPERS[paper]
    low = complex(BINDING + PAD, MARGIN + BLOCK[1] + PAD)
    return low, complex(wide - MARGIN - TABLE - PAD, tall - MARGIN - PAD)


def choose(size: complex, room: complex, rows: int) -> tuple[str, float]:
    """Return paper and scale.

    Parameters
    ----------
    size : complex, mm
        Width and height of all views together.
    room : complex, mm of paper
        Space for dimensions and gaps besides the views, across and up.
    rows : int
        Number of rows of the table.

    Returns
    -------
    str, float
        The paper, and millimetres of paper over millimetres of the part.

    Raises
    ------
    InfeasibleError
        If the views are too large for the smallest scale.
    """
    fitting = []
    for paper, (_, tall) in PAPERS.items():
        low, high = area_of(paper)
        free = high - low - room
        fits = [
            scale
            for scale in SCALES
            if scale * size.real <= free.real and scale * size.imag <= free.imag
        ]
        long = (rows + 1) * ROW > tall - 2 * MARGIN - BLOCK[1]
        if fits and not (long and paper == "A4"):
            fitting.append((paper, fits[0]))
    if not fitting:
        what = f"views of {formatted(size.real)} x {formatted(size.imag)} mm do not fit on a sheet"
        note = f"the smallest scale is 1 : {formatted(1.0 / min(SCALES))}"
        raise InfeasibleError(what, where="output.files", nearest=note)
    return max(fitting, key=lambda one: min(one[1], 1.0))


def sheet_rows(facts: Facts, names: Sequence[str]) -> dict[str, str]:
    """Return the rows of a drawing's table: the quantities `names` that exist in `facts`."""
    by_name = {one.name: one for one in facts.quantities()}
    named = [by_name[name] for name in names if name in by_name]
    return {one.meaning: _row_text(one) for one in named}


def _row_text(fact: NamedFact) -> str:
    """Return a fact as a text for a drawing, which keeps the unit of its name."""
    value, unit = fact.value, fact.unit
    if isinstance(value, list):
        return f"{' : '.join(formatted(part, _FEW) for part in value)} {unit}".rstrip()
    if isinstance(value, Mapping):
        ends = [formatted(end) for end in value.values()]
        return f"{' to '.join(dict.fromkeys(ends))} {unit}".rstrip()
    return f"{formatted(value)} {unit}".rstrip() if isinstance(value, float) else fact.text


def begin(size: complex, room: Box, low: complex, rows: int) -> Board:
    """Return an empty sheet with the views centred in their area.

    Parameters
    ----------
    size : complex, mm
        Width and height of all views together.
    room : complex, complex, mm of paper
        Space for dimensions to the left and below, and to the right and above.
    low : complex, mm
        Lower left corner of the views.
    rows : int
        Number of rows of the table.

    Returns
    -------
    Board
        Empty, with paper and scale.

    Raises
    ------
    InfeasibleError
        If the views are too large for the smallest scale.
    """
    paper, scale = choose(size, room[0] + room[1], rows)
    first, last = area_of(paper)
    idle = last - first - room[0] - room[1] - scale * size
    corner = low - (first + room[0] + 0.5 * idle) / scale
    area = corner + first / scale, corner + last / scale
    return Board(scale=scale, area=area, paper=paper, corner=corner)


def finish(
    board: Board, *, name: str, title: str, facts: Mapping[str, str], notes: Sequence[str]
) -> Sheet:
    """Return the finished sheet, with frame, table, title block and notes around the views.

    Parameters
    ----------
    board : Board
        With its views.
    name, title : str
        Name and title of the sheet.
    facts : mapping of str to str
        First rows of the table; those of the board follow.
    notes : sequence of str
        Notes beside the title block.

    Returns
    -------
    Sheet
    """
    size, rows = PAPERS[board.paper], (*facts.items(), *board.rows)
    left, right, top = BINDING, size[0] - MARGIN, size[1] - MARGIN
    frame = complex(left, MARGIN), complex(right, MARGIN), complex(right, top), complex(left, top)
    _chain(board, frame, closed=True)
    _table(board, rows, complex(right - TABLE, top))
    _block(board, (name, title), complex(right - BLOCK[0], MARGIN))
    high = MARGIN + BLOCK[1]
    wide = right - BLOCK[0] - left - 2 * INSET
    height = min(HEIGHT, wide / (GLYPH * max(len(note) for note in notes)))
    for number, note in enumerate(notes, start=1):
        place = complex(left + INSET, high - 1.8 * HEIGHT * number)
        _write(board, note, place, wide, height)
    return Sheet(
        name=name,
        title=title,
        paper=board.paper,
        size=size,
        scale=board.scale,
        corner=board.corner,
        features=tuple(board.features),
        dimensions=tuple(board.dimensions),
        texts=tuple(board.texts),
        rows=rows,
    )


def _chain(board: Board, points: Sequence[complex], *, closed: bool = False) -> None:
    """Draw lines of the frame, mm of paper."""
    placed = np.array([board.corner + board.unit * point for point in points])
    board.draw(FRAME, Path(points=placed, closed=closed))


def _write(board: Board, text: str, place: complex, wide: float, height: float = HEIGHT) -> None:
    """Write a line, smaller if it is longer than its space; line breaks become blanks."""
    text = " ".join(text.split())
    if text:
        height = min(height, wide / (GLYPH * len(text)))
        at = board.corner + board.unit * place
        board.write(Text(text=text, place=at, height=height))


def _table(board: Board, rows: Sequence[tuple[str, str]], corner: complex) -> None:
    """Draw the table downwards from its upper left corner; long tables have lower rows."""
    if not rows:
        return
    row = min(ROW, (corner.imag - MARGIN - BLOCK[1]) / len(rows))
    low = corner - 1j * row * len(rows)
    _chain(board, [corner, low, low + TABLE])
    _chain(board, [corner + LABELS, low + LABELS])
    for number, (label, value) in enumerate(rows, start=1):
        base = corner - 1j * row * number
        if number < len(rows):
            _chain(board, [base, base + TABLE])
        height, place = min(HEIGHT, 0.5 * row), base + INSET + 0.27j * row
        _write(board, label, place, LABELS - 2 * INSET, height)
        _write(board, value, place + LABELS, TABLE - LABELS - 2 * INSET, height)


def _block(board: Board, words: tuple[str, str], corner: complex) -> None:
    """Draw the title block upwards from its lower left corner."""
    row, (name, title) = BLOCK[1] / 3.0, words
    cells = [
        (0.0, 2, BLOCK[0], "title", title, 4.0),
        (0.0, 1, 100.0, "drawing", name, 3.0),
        (100.0, 1, 50.0, "scale", scale_words(board.scale), 3.0),
        (0.0, 0, 50.0, "units", "mm, deg", 3.0),
        (50.0, 0, 50.0, "projection", PROJECTION, 3.0),
        (100.0, 0, 50.0, "paper", board.paper, 3.0),
    ]
    for across, up, wide, label, value, height in cells:
        low = corner + across + 1j * row * up
        top = low + 1j * row
        _chain(board, [low, top, top + wide])
        _write(board, label, top + INSET - 1j * (SMALL + 0.8), wide - 2 * INSET, SMALL)
        indent = 15.0
        _write(board, value, low + indent + 0.28j * row, wide - indent - INSET, height)
