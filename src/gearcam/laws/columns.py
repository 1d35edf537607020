"""Columns of numbers in CSV files, read once for each set of parameters that names a file."""

from __future__ import annotations

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
_SHOWN: Final = 40
_HINT: Final = "; use a decimal point"


LARGEST: Final = 16_000_000
"""Largest size of a file, bytes: twenty times that of the longest table."""

NARROWEST_STEP: Final = 2e-6 * math.pi
"""Smallest step of the angle between rows, rad: a second of arc."""


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
    """

    file: str
    lines: tuple[int, ...]
    cells: tuple[list[str], ...]
    note: str = ""

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
            If a column is missing or in an unknown unit, or a row is incomplete or not numeric,
            with its line.
        """
        head, *rows = self.cells
        found = [self._found(name) for name in names]
        wrong = [name for name, _ in found if head.count(name) != 1]
        if wrong or not names:
            units = {f"_{unit}" for name in wrong for unit in like(name.rpartition("_")[2])}
            hint = f"; units that are read: {', '.join(sorted(units))}" if units else ""
            raise ColumnsError(f"line {self.lines[0]}: the columns are {', '.join(head)}{hint}")
        places = [head.index(name) for name, _ in found]
        lines = list(self.lines[1:])
        for line, row in zip(lines, rows, strict=True):
            if any(row[len(head) :]):
                state = f"line {line}: {len(row)} values for {len(head)} columns"
                raise ColumnsError(state + _HINT)
        numbers = [_numbers(row, places, line) for line, row in zip(lines, rows, strict=True)]
        units = [unit for _, unit in found]
        return np.array(numbers).reshape(-1, len(names)) * units, lines

    def spelt(self, name: str) -> str:
        """Return how the file names a column, in the unit of `name` or another; empty if nohow."""
        found = self._found(name)[0]
        return found if found in self.cells[0] else ""

    def _found(self, name: str) -> tuple[str, float]:
        """Return the name of a column in the file, and the factor to the unit of its `name`.

        The name itself comes first, then the only one with another unit.
        """
        stem, _, unit = name.rpartition("_")
        units = {f"{stem}_{other}": other for other in like(unit)}
        there = [cell for cell in self.cells[0] if cell in units]
        if name in there or len(there) != 1:
            return name, 1.0
        return there[0], factor(units[there[0]], unit) or 1.0


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

    Cells are separated by commas, or by semicolons if the line of names has semicolons and no
    comma. With semicolons numbers may have decimal commas, unless some have decimal points.

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
        text = read(file, LARGEST).decode("utf-8-sig").splitlines()
    except UnreadableError as error:
        raise ColumnsError(f"cannot be read: {error}") from error
    except UnicodeDecodeError as error:
        raise ColumnsError("cannot be read: it is not a text file in UTF-8") from error
    rows = [(k, row) for k, row in enumerate(text, start=1) if row.strip() and row[0] != "#"]
    if not rows:
        raise ColumnsError("is empty")
    if len(rows) > MOST_ROWS + 1:
        raise ColumnsError(f"has {len(rows) - 1} rows; up to {MOST_ROWS} are read")
    semicolons = ";" in rows[0][1] and "," not in rows[0][1]
    cells = []
    for line, row in rows:
        try:
            row_cells = next(csv.reader([row], delimiter=";" if semicolons else ","))
        except csv.Error as error:
            raise ColumnsError(f"line {line}: no row of a table: {error}") from error
        cells.append([cell.strip() for cell in row_cells])
    table = CsvRows(file=file, lines=tuple(line for line, _ in rows), cells=tuple(cells))
    return _with_points(table) if semicolons else table


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


def degrees(angle: float) -> str:
    """Return an angle, rad, as text in degrees."""
    return f"{formatted(math.degrees(angle), 10)} deg"


def _with_points(rows: CsvRows) -> CsvRows:
    """Return the rows of a file with semicolons, decimal commas replaced by points."""
    cells = [cell for row in rows.cells[1:] for cell in row]
    commas = any(_COMMA_NUMBER.fullmatch(cell) for cell in cells)
    if not commas or any(_POINT_NUMBER.fullmatch(cell) for cell in cells):
        return replace(rows, note="read with semicolons between columns")
    with_points = tuple(
        [cell.replace(",", ".") if _COMMA_NUMBER.fullmatch(cell) else cell for cell in row]
        for row in rows.cells
    )
    return replace(rows, cells=with_points, note="read with semicolons and decimal commas")


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
