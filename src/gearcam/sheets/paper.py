"""Paper: size and scale of a sheet, its frame, tables, title block and notes.

A4 or A3 landscape with a binding margin, scales of ISO 5455 (1, 2 and 5 times powers of ten). The
tables are on the right, the title block of ISO 7200 below them, notes beside that; the rest is the
*area* of the views. The smaller paper is used if it shows the part at full size or larger, or at
the same scale as the larger paper; A2 only where the tables need it.

Depends on drawings, facts and sheets.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Final

from gearcam.base import readable
from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Facts, NamedFact
from gearcam.base.inches import file_unit
from gearcam.base.numerals import decimal, formatted
from gearcam.parts.shapes import Circle
from gearcam.sheets.board import Board
from gearcam.sheets.sheet import DIMENSION, FRAME, HEIGHT, RULE, SERIES, Sheet, Text, text_width
from gearcam.sheets.spec import DrawingNotes

PAPERS: Final = {"A4": (297.0, 210.0), "A3": (420.0, 297.0), "A2": (594.0, 420.0)}
"""Width and height, mm."""

BINDING: Final = 20.0
MARGIN: Final = 10.0
"""Margins of the frame from the paper's left edge, and from the other edges, mm."""

TABLE: Final = 86.0
LABELS: Final = 47.0
ROW: Final = 5.0
LEAST_ROW: Final = 2.9
"""Width of the tables and of labels, and usual and least height of a row, mm."""

CELLS: Final = 8.0
BLOCK: Final = (180.0, 4 * CELLS)
"""Height of a cell of the title block, its width and height, mm."""

PAD: Final = 3.0
"""Gap around the views, mm."""

INSET: Final = 1.5
"""Distance of a cell's text from its edge, mm."""

ROOMY: Final = 1.1
"""Width of letters over those of Helvetica for which cells have space: fonts of programs differ."""

SCALES: Final = tuple(b * 10.0**power for power in range(2, -7, -1) for b in (5.0, 2.0, 1.0))[2:]
"""100:1 and smaller."""

ALONE: Final = 36.0
"""Space for dimensions beside a view that stands below the others, mm."""

_NONE: Final = 1e-9
"""Lengths and angles that are 0 but for rounding."""

COLUMNS: Final = 6
"""Largest number of columns of a table of values."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Heading:
    """What the title block says.

    Parameters
    ----------
    title : str
        Title.
    notes : DrawingNotes
        Of the design.
    number : int or None
        Which of the parts, from 0; None for all together.
    of : int
        How many parts there are.
    """

    title: str
    notes: DrawingNotes
    number: int | None = 0
    of: int = 1

    @property
    def part_number(self) -> str:
        """The identification number; empty without one."""
        found = self.notes.of("part_number", self.number)
        same = self.number is not None and found == self.notes.of("part_number", None)
        return f"{found}-{(self.number or 0) + 1}" if found and same and self.of > 1 else found


@dataclass(frozen=True, eq=False, kw_only=True)
class Values:
    """A table of values: the `title` of each column, and rows of as many texts."""

    title: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]

    @property
    def across(self) -> int:
        """How often its columns stand beside each other."""
        return COLUMNS // len(self.title)

    @property
    def tall(self) -> int:
        """Its number of rows on paper, with the title and a gap."""
        return math.ceil(len(self.rows) / self.across) + 2 if self.rows else 0


NO_VALUES: Final = Values(title=("", ""), rows=())


def scale_words(scale: float) -> str:
    """Return a `scale` as text, such as 1:2."""
    return f"{formatted(scale)}:1" if scale >= 1.0 else f"1:{formatted(1.0 / scale)}"


def area_of(paper: str) -> tuple[complex, complex]:
    """Return the corners of the views' area on a `paper`, mm of paper."""
    wide, tall = PAPERS[paper]
    low = complex(BINDING + PAD, MARGIN + BLOCK[1] + PAD)
    return low, complex(wide - MARGIN - TABLE - PAD, tall - MARGIN - PAD)


def choose(size: complex, room: complex, rows: int, wide: float = 0.0) -> tuple[str, float]:
    """Return paper and scale.

    Parameters
    ----------
    size : complex, mm
        Width and height of all views together.
    room : complex, mm of paper
        Space for dimensions and gaps besides the views, across and up.
    rows : int
        Number of rows of the tables.
    wide : float, mm
        Width of a view that stands below the others.

    Returns
    -------
    str, float
        The paper, and millimetres of paper over millimetres of the part.

    Raises
    ------
    InfeasibleError
        If the views are too large for the smallest scale, or the tables for the largest paper.
    """
    fitting: list[tuple[str, float]] = []
    fits: list[float] = []
    for paper, (_, tall) in PAPERS.items():
        low, high = area_of(paper)
        free = high - low - room
        fits = [
            scale
            for scale in SCALES
            if scale * size.real <= free.real and scale * size.imag <= free.imag
            if scale * wide <= (high - low).real - ALONE
        ]
        row = ROW if paper == "A4" else LEAST_ROW
        long = (rows + 1) * row > tall - 2 * MARGIN - BLOCK[1]
        if fits and not long and not (paper == "A2" and fitting):
            fitting.append((paper, fits[0]))
    if not fitting:
        what = f"views of {formatted(size.real)} x {formatted(size.imag)} mm do not fit on a sheet"
        what += f" with {rows} rows of data" if fits else ""
        note = f"the smallest scale is 1 : {formatted(1.0 / min(SCALES))}"
        raise InfeasibleError(what, where="output.files", nearest=note)
    return max(fitting, key=lambda one: min(one[1], 1.0))


def sheet_rows(facts: Facts, names: Sequence[str]) -> dict[str, str]:
    """Return the rows of a drawing's table: the quantities `names` that exist in `facts`."""
    unit = file_unit()
    by_name = {one.name: one for one in unit.told(facts).quantities()}
    named = [by_name[name] for name, _ in map(unit.column, names) if name in by_name]
    return {one.meaning: _row_text(one) for one in named}


def _row_text(fact: NamedFact) -> str:
    """Return a fact as a text for a drawing, which keeps the unit of its name."""
    value, unit = fact.value, fact.unit
    if isinstance(value, list):
        return f"{' : '.join(_number(part, unit) for part in value)} {unit}".rstrip()
    if isinstance(value, Mapping):
        ends = [_number(end, unit) for end in value.values()]
        return f"{' to '.join(dict.fromkeys(ends))} {unit}".rstrip()
    return f"{_number(value, unit)} {unit}".rstrip() if isinstance(value, float) else fact.text


def _number(value: float, unit: str) -> str:
    """Return a number of a table: lengths and angles as they are dimensioned, unless they are 0."""
    if isinstance(value, int):
        return str(value)
    lengths = file_unit()
    decimals = {"deg": 3, lengths.name: lengths.decimals}.get(unit)
    if decimals is None or _NONE <= abs(value) < 0.5 * 10.0**-decimals:
        return readable.number(value, unit)
    return decimal(value, decimals)


def begin(
    name: str,
    size: complex,
    room: tuple[complex, complex],
    low: complex,
    rows: int,
    wide: float = 0,
) -> Board:
    """Return an empty sheet with the views centred in their area.

    Parameters
    ----------
    name : str
        Name of the sheet.
    size : complex, mm
        Width and height of all views together.
    room : complex, complex, mm of paper
        Space for dimensions to the left and below, and to the right and above.
    low : complex, mm
        Lower left corner of the views.
    rows : int
        Number of rows of the tables.
    wide : float, mm
        Width of a view that stands below the others; 0 without one.

    Returns
    -------
    Board
        Empty, with paper and scale.

    Raises
    ------
    InfeasibleError
        If the views are too large for the smallest scale.
    """
    paper, scale = choose(size, room[0] + room[1], rows, wide)
    first, last = area_of(paper)
    idle = last - first - room[0] - room[1] - scale * size
    if wide:
        idle = complex(min(idle.real, (last - first).real - ALONE - scale * wide), idle.imag)
    corner = low - (first + room[0] + 0.5 * idle) / scale
    area = corner + first / scale, corner + last / scale
    return Board(name=name, scale=scale, area=area, paper=paper, size=PAPERS[paper], corner=corner)


def finish(
    board: Board, heading: Heading, facts: Mapping[str, str], notes: Sequence[str], values: Values
) -> Sheet:
    """Return the finished sheet, with frame, tables, title block and notes around the views.

    Parameters
    ----------
    board : Board
        With its views.
    heading : Heading
        What the title block says.
    facts : mapping of str to str
        First rows of the table of data; those of the board follow.
    notes : sequence of str
        Notes beside the title block.
    values : Values
        A second table.

    Returns
    -------
    Sheet
    """
    size, more = board.size, Counter(board.rows)
    alike = ((f"{n} x {label}" if n > 1 else label, text) for (label, text), n in more.items())
    rows = [*facts.items(), *alike]
    left, right, top = BINDING, size[0] - MARGIN, size[1] - MARGIN
    frame = complex(left, MARGIN), complex(right, MARGIN), complex(right, top), complex(left, top)
    _chain(board, FRAME, *frame, closed=True)
    free = top - MARGIN - BLOCK[1]
    row = min(ROW, free / (len(rows) + values.tall or 1))
    corner = complex(right - TABLE, top)
    _table(board, rows, corner, row)
    if values.rows:
        _values(board, values, corner - 1j * row * (len(rows) + 1), row)
    _block(board, heading, complex(right - BLOCK[0], MARGIN))
    wide = right - BLOCK[0] - left - 2 * INSET
    for height in (HEIGHT, SERIES[0]):
        lines = [line for note in notes for line in _wrapped(note, wide / ROOMY, height)]
        pitch = 1.6 * height
        if (len(lines) + 0.5) * pitch <= BLOCK[1]:
            break
    for number, line in enumerate(lines, start=1):
        place = complex(left + INSET, MARGIN + BLOCK[1] - pitch * number)
        _write(board, line, place, wide, height)
    drawn = {one.name: getattr(board, one.name) for one in fields(Sheet)}
    return Sheet(**drawn | {"title": heading.title, "rows": rows})


def _wrapped(note: str, wide: float, height: float) -> list[str]:
    """Return a note as lines of a `height` that are not wider than `wide`, mm."""
    lines = [""]
    for word in note.split():
        longer = f"{lines[-1]} {word}".strip()
        lines = [*lines[:-1], longer] if text_width(longer, height) <= wide else [*lines, word]
    return lines


def _chain(board: Board, layer: str, *points: complex, closed: bool = False) -> None:
    """Draw lines between points, mm of paper."""
    board.line(layer, *(board.corner + board.unit * point for point in points), closed=closed)


def _least(height: float) -> float:
    """Return the largest height of the series that is not above `height`, or the least one."""
    return max((one for one in SERIES if one <= height + 1e-9), default=SERIES[0])


def _write(board: Board, text: str, place: complex, wide: float, height: float = HEIGHT) -> None:
    """Write a line, lower and then narrower if it is longer than its space."""
    text = " ".join(text.split())
    if text:
        wide /= ROOMY
        height = _least(height * min(1.0, wide / text_width(text, height)))
        squeeze = min(1.0, wide / text_width(text, height))
        at = board.corner + board.unit * place
        board.write(Text(text=text, place=at, height=height, squeeze=squeeze))


def _table(board: Board, rows: Sequence[tuple[str, str]], corner: complex, row: float) -> None:
    """Draw the table of data downwards from its upper left corner."""
    if not rows:
        return
    low = corner - 1j * row * len(rows)
    _chain(board, RULE, corner, low, low + TABLE)
    _chain(board, RULE, corner + LABELS, low + LABELS)
    for number, (label, value) in enumerate(rows, start=1):
        base = corner - 1j * row * number
        if number < len(rows):
            _chain(board, RULE, base, base + TABLE)
        height, place = _least(0.55 * row), base + INSET + 0.27j * row
        _write(board, label, place, LABELS - 2 * INSET, height)
        _write(board, value, place + LABELS, TABLE - LABELS - 2 * INSET, height)


def _values(board: Board, values: Values, corner: complex, row: float) -> None:
    """Draw a table of values downwards from its upper left corner, by columns."""
    tall, count = values.tall - 2, len(values.title)
    wide = TABLE / (values.across * count)
    _chain(board, RULE, corner + TABLE, corner, corner - 1j * row * (tall + 1))
    for part in range(values.across):
        shown = [values.title, *values.rows[part * tall : (part + 1) * tall]]
        for number, texts in enumerate(shown if len(shown) > 1 else (), start=1):
            for place, text in enumerate(texts):
                at = corner + (count * part + place) * wide - 1j * row * number
                _write(board, text, at + 0.8 + 0.27j * row, wide - 1.6, _least(0.5 * row))
                _chain(board, RULE, at, at + wide, at + wide + 1j * row)


def _block(board: Board, heading: Heading, corner: complex) -> None:
    """Draw the title block of ISO 7200 upwards from its lower left corner."""
    notes, number = heading.notes, heading.number
    rows = [
        [("part number", heading.part_number or board.name, 62.0),
         ("revision", notes.revision, 18.0), ("date of issue", notes.date, 30.0),
         ("approved by", notes.approved_by, 40.0), ("language", "en", 14.0),
         ("sheet", "1/1", 16.0)],
        [("title", heading.title, 80.0), ("created by", notes.author, 40.0),
         ("legal owner", notes.owner, 60.0)],
        [("scale", scale_words(board.scale), 18.0), ("projection", "", 24.0),
         ("units", f"{board.units.units}, deg", 20.0), ("paper", board.paper, 18.0),
         ("general tolerances", notes.general_tolerances, 40.0),
         ("document type", f"{'assembly' if number is None else 'part'} drawing", 60.0)],
        [("material", notes.of("material", number), 80.0),
         ("heat treatment", notes.of("heat_treatment", number), 64.0),
         ("surface texture", "", 36.0)],
    ]  # fmt: skip
    for up, cells in enumerate(rows):
        low = corner + 1j * CELLS * up
        for label, value, wide in cells:
            top = low + 1j * CELLS
            _chain(board, RULE, low, top, top + wide)
            _write(board, label, top + INSET - 2.5j, wide - 2 * INSET, SERIES[0])
            tall = 3.5 if label in ("title", "part number") else HEIGHT
            _write(board, value or "", low + INSET + 1.4j, wide - 2 * INSET, tall)
            if label == "projection":
                _first_angle(board, low + 4.0 + 2.6j)
            if label == "surface texture" and notes.surface:
                _surface(board, low + 20.0 + 0.6j, notes.surface)
            low += wide


def _first_angle(board: Board, low: complex) -> None:
    """Draw the symbol of the first angle projection (ISO 5456-2) about the left of its axis."""
    sizes = (-0.75, 0.75, 1.5, -1.5)
    cone = (low + complex(5.0 * (abs(y) > 1.0), y) for y in sizes)
    _chain(board, DIMENSION, *cone, closed=True)
    for diameter in (1.5, 3.0):
        center = board.corner + board.unit * (low + 11.0)
        board.draw(DIMENSION, Circle(center=center, diameter=diameter * board.unit))


def _surface(board: Board, low: complex, texture: str) -> None:
    """Draw the symbol of a surface texture (ISO 21920-1) from its lowest point."""
    bend, high = low, low + 2.9 + 5.0j
    _chain(board, DIMENSION, bend - 1.45 + 2.5j, bend, high, high + 1.0 + text_width(texture))
    _write(board, texture, low + 3.4 + 5.0j - 1j * (HEIGHT + 0.7), 30.0)
