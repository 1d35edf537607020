"""The rows that are there: a file with a line for each, appended as they come.

Its first line says which sweep it is of. A line that was cut off when the program was ended is
dropped. Rows stand in the order in which they were finished; places of lines are kept in memory,
rows are not.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import AbstractContextManager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any, BinaryIO, Final

from gearcam.base.errors import DesignError, WriteError
from gearcam.sweeps.rows import Built

LOG: Final = "sweep.log"
"""Name of the file."""


class Log(AbstractContextManager["Log"]):
    """The log of a sweep.

    Parameters
    ----------
    folder : path
        Folder of the file; created if it is missing.
    head : dict
        What tells the sweep from others.
    name : str
        Name of the file.

    Raises
    ------
    DesignError
        If the folder has the log of another sweep.
    WriteError
        If the file cannot be written.
    """

    def __init__(
        self, folder: str | os.PathLike[str], head: dict[str, Any], name: str = LOG
    ) -> None:
        self.path = Path(folder) / name
        self.head = head
        self._places: dict[int, int] = {}
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._file: BinaryIO = self.path.open("a+b")
        except OSError as error:
            place = error.filename or self.path
            raise WriteError(f"{place}: {error.strerror or error}") from error
        try:
            self._read()
        except BaseException:
            self._file.close()
            raise

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __contains__(self, number: int) -> bool:
        return number in self._places

    def __len__(self) -> int:
        return len(self._places)

    def _read(self) -> None:
        """Read places of rows; cut off what is no whole line."""
        self._file.seek(0)
        first = self._file.readline()
        if not first.endswith(b"\n"):  # a new file, or one ended at once
            self._file.truncate(0)
            self._write(json.dumps(self.head))
            return
        self._demand_same(first)
        end = self._file.tell()
        for line in self._file:
            number = _number_of(line)
            if number is None:
                break
            self._places[number] = end
            end += len(line)
        self._file.truncate(end)

    def _demand_same(self, line: bytes) -> None:
        head: Any = None
        with suppress(ValueError):
            head = json.loads(line)
        if head != self.head:
            message = f"{self.path} is the log of another sweep{self._differing(head)}"
            allowed = "another folder (-o), or the same design and settings to go on"
            raise DesignError.of(message, allowed=allowed)

    def _differing(self, found: Any) -> str:
        """Return in words what the head of the file has instead of this one."""
        if not isinstance(found, dict):
            return ""
        there = {
            key: found[key] for key, one in self.head.items() if key in found and found[key] != one
        }
        there.pop("sweep", None)
        words = [
            f"{key}: {', '.join(one) if isinstance(one, list) else one}"
            for key, one in there.items()
        ]
        return f" ({'; '.join(words) or 'another design or seed'})"

    def _write(self, text: str) -> None:
        self._file.write(text.encode() + b"\n")
        self._file.flush()

    def append(self, row: Built) -> None:
        """Append a row.

        Raises
        ------
        WriteError
            If it cannot be written.
        """
        try:
            self._file.seek(0, os.SEEK_END)
            place = self._file.tell()
            self._write(json.dumps(asdict(row)))
        except OSError as error:
            raise WriteError(f"{self.path}: {error.strerror or error}") from error
        self._places[row.number] = place

    def row(self, number: int) -> Built:
        """Return the row of a number that is there."""
        self._file.seek(self._places[number])
        content = json.loads(self._file.readline())
        return Built(**content | {"findings": tuple(content["findings"])})

    def rows(self) -> Iterator[Built]:
        """Yield all rows by their numbers."""
        for number in sorted(self._places):
            yield self.row(number)


def _number_of(line: bytes) -> int | None:
    """Return the number of the row in a line; None of a line that was cut off."""
    if not line.endswith(b"\n"):
        return None
    try:
        return int(json.loads(line)["number"])
    except (ValueError, KeyError, TypeError):
        return None
