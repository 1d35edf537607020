"""Columns of numbers in CSV files, read once for each set of parameters that names a file."""

from __future__ import annotations

import codecs
import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.base.numerals import formatted
from gearcam.base.reading import UnreadableError, read
from gearcam.base.rules import Breach
from gearcam.base.units import factor, like
from gearcam.numeric.arrays import Array

MOST_ROWS: Final = 20000
"""Largest number of rows of a table."""

_COMMA_NUMBER: Final = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
_POINT_NUMBER: Final = re.compile(r"[+-]?\d*\.\d*([eE][+-]?\d+)?")
_BETWEEN: Final = {",": "commas", ";": "semicolons", "\t": "tabs"}
"""What separates cells; the first one in the line of names does."""

_SEPARATOR: Final = re.compile(r"\"?sep=([,;\t])\"?\s*", re.IGNORECASE)
"""The line before the names of the columns with which spreadsheets say what separates cells."""

_SHOWN: Final = 40
_HINT: Final = "; use a decimal point"


LARGEST: Final = 16_000_000
"""Largest size of a file, bytes: twenty times that of the longest table."""

NARROWEST_STEP: Final = 2e-6 * math.pi
"""Smallest step of the angle between rows, rad: a second of arc."""

_LITTLE: Final = 0.1
"""Largest error of a printed period, in steps of the rows."""

_ROUNDING: Final = 1e-6
"""Rounding of an angle in units of its last digit of ten."""


class ColumnsError(ValueError):
    """A CSV file without the needed columns; the message gives line and reason."""


@dataclass(frozen=True, kw_only=True)
class CsvRows(ShortRepr):
    """The rows of a CSV file, without comments and empty lines.

    Parameters
    ----------
    file : str
        Its name.
    lines : tuple of n int
        Number of each row in the file.
    cells : tuple of n lists of str
        Text of each cell without spaces around it; the first row has the names of the columns.
    note : str
        How separators and decimal commas were read, if not as usual; else empty.
    separator : str
        What separates the cells.
    """

    file: str
    lines: tuple[int, ...]
    cells: tuple[list[str], ...]
    note: str = ""
    separator: str = ","

    def columns(self, names: Sequence[str]) -> tuple[Array, list[int]]:
        """Return columns of numbers by their names.

        Parameters
        ----------
        names : sequence of k str
            Names of the columns; others are ignored. A column may be in another unit than its
            name ends with, such as ``lift_in`` for ``lift_mm``, and is converted.

        Returns
        -------
        columns : (n, k) array
            In the order of `names`.
        lines : list of n int
            Line number of each row in the file.

        Raises
        ------
        ColumnsError
            If a column is missing, misspelt, given twice or in an unknown unit, or a row is
            incomplete or not numeric, with its line.
        """
        head, *rows = self.cells
        if wrong := self._header_fault(names):
            raise ColumnsError(f"line {self.lines[0]}: {wrong}")
        places = [self._places(name)[0] for name in names]
        units = [factor(_unit(head[k]), _unit(name)) for k, name in zip(places, names, strict=True)]
        lines = list(self.lines[1:])
        for line, row in zip(lines, rows, strict=True):
            if any(row[len(head) :]):
                state = f"line {line}: {len(row)} values for {len(head)} columns"
                raise ColumnsError(state + _HINT)
        numbers = [_numbers(row, places, line) for line, row in zip(lines, rows, strict=True)]
        scales = [1.0 if unit is None else unit for unit in units]
        return np.array(numbers).reshape(-1, len(names)) * scales, lines

    def spelt(self, name: str) -> str:
        """Return how the file names a column, in the unit of `name` or another; empty if nohow."""
        places = self._places(name)
        return self.cells[0][places[0]] if places else ""

    def _places(self, name: str) -> list[int]:
        """Return the places of the columns that are a quantity, however they are written."""
        return [k for k, cell in enumerate(self.cells[0]) if _meant(cell, name)]

    def _header_fault(self, names: Sequence[str]) -> str:
        """Return what is wrong with the names of the columns; empty if nothing is."""
        head, missing, unsaid = self.cells[0], list[str](), list[str]()
        mended = list(head)
        for name in names:
            places = self._places(name)
            bare = [k for k, cell in enumerate(head) if _letters(cell) == _letters(_stem(name))]
            if len(places) > 1:
                return _same([head[k] for k in places])
            if places:
                mended[places[0]] = _meant(head[places[0]], name)
            elif len(bare) == 1:
                mended[bare[0]] = name
                unsaid.append(f"{head[bare[0]]} is in {_unit(name)}")
            else:
                missing.append(name)
        if names and mended == head and not missing:
            return ""
        fault = f"the columns are {', '.join(head)}"
        if names and not missing:
            condition = f", if {' and '.join(unsaid)}" if unsaid else ""
            return f"{fault}; write {self.separator.join(mended)}{condition}"
        if len(head) == 1:
            return f"{fault}; commas, semicolons or tabs separate them"
        fault = f"{fault}: none is {' or '.join(missing)}" if missing else fault
        units = {unit for name in missing for unit in like(_unit(name))}
        return f"{fault}; names may end in {', '.join(sorted(units))}" if units else fault


def _unit(name: str) -> str:
    """Return the unit with which the name of a column ends."""
    return name.rpartition("_")[2]


def _stem(name: str) -> str:
    """Return the name of a column without its unit."""
    return name.rpartition("_")[0] if like(_unit(name)) else name


def _letters(cell: str) -> str:
    """Return letters and digits of a cell, as in the name of a column."""
    small = cell.lower().replace("\N{DEGREE SIGN}", "deg")
    return re.sub(r"[^a-z0-9]", "", re.sub("[\u00b5\u03bc]", "u", small))


def _meant(cell: str, name: str) -> str:
    """Return the name of a column that a cell means: `name`, in its unit or another; or empty."""
    stem = _stem(name)
    names = [name, *(f"{stem}_{unit}" for unit in like(_unit(name)))]
    return next((one for one in names if _letters(one) == _letters(cell)), "")


def _same(cells: Sequence[str]) -> str:
    """Return the fault of columns of one quantity."""
    if len(set(cells)) == 1:
        return f"{cells[0]} is given {len(cells)} times"
    return f"{' and '.join(cells)} are the same quantity: leave one of them"


@dataclass(frozen=True, eq=False, kw_only=True)
class Given(ShortRepr):
    """The rows of a table as they were given, which should lie on a curve.

    Parameters
    ----------
    key, called : str
        Key of the values in a design, without its unit, and what they are in words.
    x : (n,) array
        Places, rising.
    y : (n,) array
        Values, in the unit in which they are given.
    lines : list of n int
        Their lines in the file; empty without one.
    place : callable
        ``place(x)`` returns a place as text.
    period : float or None
        After which the values repeat, in the unit of `x`; None if the table has ends.
    rise : float
        What the values rise in a period.
    unit : str
        Of the values.
    """

    key: str
    called: str
    x: Array
    y: Array
    lines: list[int]
    place: Callable[[float], str]
    period: float | None = None
    rise: float = 0.0
    unit: str = ""


class FromFile(ShortRepr):
    """Parameters of a table, in the design itself or in a CSV file, which is read once."""

    file: str | None

    def given(self, *, oscillating: bool) -> Given | None:  # noqa: ARG002  (the same for all)
        """Return the rows, if they should lie on a curve.

        Parameters
        ----------
        oscillating : bool
            Whether lifts are angles.
        """
        return None

    @cached_property
    def rows(self) -> CsvRows | None:
        """Rows of the file; None without a file. Raises `ColumnsError` (see `read_rows`)."""
        return None if self.file is None else read_rows(self.file)

    def row_problems(
        self,
        columns: Sequence[str],
        read: Callable[[], tuple[Any, ...]],
        check: Callable[..., Iterator[Breach]],
        needed: str,
    ) -> Iterator[Breach]:
        """Yield the faults of the rows; those of a file with its line.

        Parameters
        ----------
        columns : sequence of str
            The fields of the columns, of which a design has two.
        read : callable
            Returns the columns, and the line of each row in the file.
        check : callable
            ``check(*columns)`` yields faults: field, row, message, allowed.
        needed : str
            What a file must have, for messages.

        Yields
        ------
        tuple
            Field, index, message, allowed.
        """
        if self.file is None:
            given = [name for name in columns if getattr(self, name) is not None]
            if len(given) != 2:
                return  # a broken rule
            first, second = (len(getattr(self, name)) for name in given)
            if first != second:
                message = f"{second} values, but {given[0]} has {first}"
                yield given[1], None, message, f"one value for each {given[0]}"
                return
        try:
            *values, lines = read()
        except ColumnsError as error:
            yield "file", None, str(error), f"a CSV file with {needed}"
            return
        for name, row, message, rule in check(*values):
            if self.file is None or name not in columns:
                yield name, row, message, rule
            else:
                place = "" if row is None else f"line {lines[row]}: "
                yield "file", None, place + message, rule


def demand(problems: Iterator[Breach], table: str) -> None:
    """Refuse the first of the faults of a `table` of a design: its file may have been changed.

    Parameters
    ----------
    problems : iterator of tuple
        Field, index, message, allowed.
    table : str
        Name of the table.

    Raises
    ------
    InfeasibleError
        If there is a fault.
    """
    for name, index, message, rule in problems:
        where = f"{table}.{name}" + ("" if index is None else f"[{index}]")
        raise InfeasibleError(message, where=where, nearest=rule)


def tables_in(part: Any) -> Iterator[FromFile]:
    """Yield the tables of parameters.

    Parameters
    ----------
    part : object
        Parameters, or a dataclass or tuple that contains them at any depth.
    """
    if isinstance(part, FromFile):
        yield part
    elif is_dataclass(part):
        part = tuple(getattr(part, field.name) for field in fields(part))
    for item in part if isinstance(part, tuple) else ():
        yield from tables_in(item)


def files_in(part: Any) -> Iterator[CsvRows]:
    """Yield the rows of all CSV files of parameters.

    Parameters
    ----------
    part : object
        As of `tables_in`.

    Raises
    ------
    ColumnsError
        If a file cannot be read.
    """
    for table in tables_in(part):
        if table.rows is not None:
            yield table.rows


def read_rows(file: str) -> CsvRows:
    """Read a CSV file.

    Cells are separated by commas, or by semicolons or tabs if the line of names has these and no
    comma, or by what a line ``sep=;`` before it says. Unless commas separate the cells, numbers may
    have decimal commas, if none has a decimal point.

    Parameters
    ----------
    file : str
        Path of a file in UTF-8: a line of names, then lines of numbers. Lines that begin with #
        are comments.

    Returns
    -------
    CsvRows
        One row or more.

    Raises
    ------
    ColumnsError
        If the file cannot be read or is empty.
    """
    import csv

    try:
        content = read(file, LARGEST)
    except UnreadableError as error:
        raise ColumnsError(f"cannot be read: {error}") from error
    try:
        text = content.decode("utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
        found = "it is in UTF-16: save it in UTF-8" if wide else "it is not a text file in UTF-8"
        raise ColumnsError(f"cannot be read: {found}") from error
    rows = [(k, row) for k, row in enumerate(text, start=1) if row.strip() and row[0] != "#"]
    said = _SEPARATOR.fullmatch(rows[0][1]) if rows else None
    rows = rows[1:] if said else rows
    if not rows:
        raise ColumnsError("is empty")
    if len(rows) > MOST_ROWS + 1:
        raise ColumnsError(f"has {len(rows) - 1} rows; up to {MOST_ROWS} are read")
    separator = said[1] if said else next((one for one in _BETWEEN if one in rows[0][1]), ",")
    cells = []
    for line, row in rows:
        try:
            row_cells = next(csv.reader([row], delimiter=separator))
        except csv.Error as error:
            raise ColumnsError(f"line {line}: no row of a table: {error}") from error
        cells.append([cell.strip() for cell in row_cells])
    lines = tuple(line for line, _ in rows)
    table = CsvRows(file=file, lines=lines, cells=tuple(cells), separator=separator)
    return table if separator == "," else _with_points(table)


def close_angles(angles: Array) -> Iterator[tuple[int, str, str]]:
    """Yield the rows whose angle is not at least a second of arc above the one before.

    Parameters
    ----------
    angles : (n,) array, rad
        Of the rows.

    Yields
    ------
    tuple
        Number of the row, message, allowed values.
    """
    steps = np.diff(angles)
    rule = f"each angle at least {degrees(NARROWEST_STEP)} above the one before"
    for row in np.flatnonzero(~(steps >= NARROWEST_STEP)).tolist():
        before, here = degrees(float(angles[row])), degrees(float(angles[row + 1]))
        state = f"{here} is given twice" if steps[row] == 0.0 else f"{here} follows {before}"
        yield row + 1, state, rule


def spans(angles: Array, period: float) -> bool:
    """Return whether rows end a period behind their first angle, to the last digit as printed.

    The period may be rounded or cut off in rad or in degrees, such as 6.2832 for a turn, if that is
    little beside the steps of the rows.

    Parameters
    ----------
    angles : (n,) array, rad
        Of the rows, rising.
    period : float, rad
        The period.
    """
    span = float(angles[-1] - angles[0])
    missed = abs(span - period)
    if missed < NARROWEST_STEP or missed > _LITTLE * float(np.diff(angles).min()):
        return missed < NARROWEST_STEP
    for scale in (1.0, math.degrees(1.0)):
        decimals = f"{scale * span:.10g}".partition(".")[2]
        if scale * missed < 10.0 ** -len(decimals) * (1.0 - _ROUNDING):
            return True
    return False


def degrees(angle: float) -> str:
    """Return an angle, rad, as text in degrees."""
    return f"{formatted(math.degrees(angle), 10)} deg"


def _with_points(rows: CsvRows) -> CsvRows:
    """Return the rows of a file without commas between cells, points for decimal commas."""
    cells = [cell for row in rows.cells[1:] for cell in row]
    commas = any(_COMMA_NUMBER.fullmatch(cell) for cell in cells)
    if not commas or any(_POINT_NUMBER.fullmatch(cell) for cell in cells):
        return replace(rows, note=f"read with {_BETWEEN[rows.separator]} between columns")
    with_points = tuple(
        [cell.replace(",", ".") if _COMMA_NUMBER.fullmatch(cell) else cell for cell in row]
        for row in rows.cells
    )
    note = f"read with {_BETWEEN[rows.separator]} and decimal commas"
    return replace(rows, cells=with_points, note=note)


def _numbers(cells: Sequence[str], places: Sequence[int], line: int) -> list[float]:
    numbers = []
    for place in places:
        text = cells[place] if place < len(cells) else ""
        written = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
        try:
            if "_" in text or not text.isascii():  # which are numbers to Python
                raise ValueError(text)
            numbers.append(float(text))
        except ValueError:
            hint = _HINT if _COMMA_NUMBER.fullmatch(text) else ""
            raise ColumnsError(f"line {line}: {written!r} is not a number{hint}") from None
        if not math.isfinite(numbers[-1]):
            raise ColumnsError(f"line {line}: {written!r} is not finite")
    return numbers
