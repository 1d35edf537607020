"""The watch: detects that a design file, or a file that it reads, was saved."""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from gearcam.base.errors import DesignError
from gearcam.base.quantities import FILE_KEYS
from gearcam.base.reading import UnreadableError, read
from gearcam.designs import reader
from gearcam.designs.examine import MOST_NESTED, nested_in
from gearcam.designs.reader import decoded, document_in
from gearcam.laws import columns
from gearcam.view.numbers import leaves

PAUSE: Final = 0.1
"""Time between two looks, s."""

_FRESH: Final = 2.0
"""Age below which a file may have changed again without a new time stamp, s."""

_GONE: Final = 5
"""Number of looks for which a file may be empty or missing while a program saves it."""

_Mark = tuple[int, int, str]


class Watch:
    """Watches a design file and the tables that it reads.

    Parameters
    ----------
    file : str
        The design file.
    """

    def __init__(self, file: str) -> None:
        self.file = file
        self._marks: dict[str, _Mark | None] = {}
        self._tables: list[str] = []
        self._gone = 0

    def look(self) -> tuple[bool, bytes | None]:
        """Return whether a file has changed since the last look, and the content of the design.

        Returns
        -------
        changed : bool
        content : bytes or None
            None if it cannot be read.
        """
        # marks come first: what is saved before the content is read is seen again in the next look
        marks = {name: self._mark(name) for name in (self.file, *self._tables)}
        content = _content(self.file, reader.LARGEST)
        if not content and self._gone < _GONE:
            self._gone += 1
            return False, content
        self._gone = 0 if content else _GONE
        if _digests(marks) == _digests(self._marks):
            self._marks = marks
            return False, content
        if content:
            self._tables = tables(content, self.file, self._tables)
        names = (self.file, *self._tables)
        self._marks = {name: marks[name] if name in marks else self._mark(name) for name in names}
        return True, content

    def _mark(self, name: str) -> _Mark | None:
        """Return time, size and hash of a file; the hash anew only if it may have changed."""
        try:
            status = Path(name).stat()
        except (OSError, ValueError):
            return None
        before = self._marks.get(name)
        same = before is not None and before[:2] == (status.st_mtime_ns, status.st_size)
        if before is not None and same and time.time() - status.st_mtime > _FRESH:
            return before
        digest = hashlib.sha256(_content(name, columns.LARGEST) or b"").hexdigest()
        return status.st_mtime_ns, status.st_size, digest


def _digests(marks: Mapping[str, _Mark | None]) -> dict[str, str | None]:
    return {name: mark and mark[2] for name, mark in marks.items()}


def tables(content: bytes, file: str, before: list[str], outer: tuple[str, ...] = ()) -> list[str]:
    """Return the CSV files and the nested designs that a design file names, with their files.

    Parameters
    ----------
    content : bytes
        Content of the design file.
    file : str
        Its name.
    before : list of str
        Returned if the content cannot be read.
    outer : tuple of str
        The files that nest it.

    Returns
    -------
    list of str
    """
    try:
        document = document_in(decoded(content, file), file)
    except DesignError:
        return before
    files = [value for path, value in leaves(document) if path[-1] in FILE_KEYS]
    names = [os.fspath(Path(file).parent / one) for one in files if isinstance(one, str) and one]
    around = (*outer, file)
    inner = (value for _, _, value in nested_in(document) if isinstance(value, str) and value)
    for name in (os.fspath(Path(file).parent / one) for one in inner):
        names.append(name)
        below = _content(name, reader.LARGEST) if len(around) <= MOST_NESTED else None
        if below and name not in around:
            names += tables(below, name, [], around)
    return list(dict.fromkeys(names))


def _content(name: str, most: int) -> bytes | None:
    try:
        return read(name, most)
    except UnreadableError:
        return None
