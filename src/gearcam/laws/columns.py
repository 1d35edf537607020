"""Columns of numbers in CSV files."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray


class ColumnsError(ValueError):
    """A file that does not hold the columns; the message says where and why."""


Names = Sequence[str] | Callable[[list[str]], Sequence[str]]


def read_columns(file: str, names: Names) -> tuple[NDArray[np.float64], list[int]]:
    """Read columns of numbers by their names.

    Parameters
    ----------
    file : str
        Path of a CSV file in UTF-8: a line of names, then lines of numbers. Lines that begin with
        # are comments; other columns are left aside.
    names : sequence of k str, or callable
        The columns; or what chooses them from all that the file has, and gives none if these are
        not enough.

    Returns
    -------
    columns : (n, k) array
        In the order of `names`.
    lines : list of n int
        The number of each row in the file.

    Raises
    ------
    ColumnsError
        With the line that is wrong.
    """
    rows = read_rows(file)
    first, head = rows[0]
    names = names(head) if callable(names) else names
    if not names or any(head.count(name) != 1 for name in names):
        raise ColumnsError(f"line {first}: the columns are {', '.join(head)}")
    places = [head.index(name) for name in names]
    found = [_numbers(row, places, line) for line, row in rows[1:]]
    return np.array(found).reshape(-1, len(names)), [line for line, _ in rows[1:]]


def read_rows(file: str) -> list[tuple[int, list[str]]]:
    """Read the rows of a CSV file, without comments and empty lines.

    Parameters
    ----------
    file : str
        Path of a CSV file in UTF-8.

    Returns
    -------
    list of (int, list of str)
        One row or more: its number in the file, and its cells without the spaces around them.

    Raises
    ------
    ColumnsError
        If the file cannot be read or is empty.
    """
    try:
        text = Path(file).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is not a text file in UTF-8"
        raise ColumnsError(f"cannot be read: {reason}") from error
    rows = [(k, row) for k, row in enumerate(text, start=1) if row.strip() and row[0] != "#"]
    if not rows:
        raise ColumnsError("is empty")
    return [(line, [cell.strip() for cell in next(csv.reader([row]))]) for line, row in rows]


def _numbers(cells: Sequence[str], places: Sequence[int], line: int) -> list[float]:
    found = []
    for place in places:
        text = cells[place] if place < len(cells) else ""
        try:
            found.append(float(text))
        except ValueError:
            raise ColumnsError(f"line {line}: {text!r} is not a number") from None
        if not math.isfinite(found[-1]):
            raise ColumnsError(f"line {line}: {text!r} is not finite")
    return found
