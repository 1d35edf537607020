"""The rows that are there, in memory: a log (`gearcam.sweeps.log`) without a file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from gearcam.sweeps.rows import Built


class RowStore(Protocol):
    """Where rows are kept: in a file or in memory."""

    def __contains__(self, number: int) -> bool:
        """Return whether the row of a number is there."""
        ...

    def __len__(self) -> int:
        """Return how many there are."""
        ...

    def append(self, row: Built) -> None:
        """Keep a row."""
        ...

    def row(self, number: int) -> Built:
        """Return the row of a number that is there."""
        ...

    def rows(self) -> Iterator[Built]:
        """Yield all rows by their numbers."""
        ...

    def close(self) -> None:
        """Close its file."""
        ...


class Kept:
    """Rows in memory (see `RowStore`)."""

    def __init__(self) -> None:
        self._rows: dict[int, Built] = {}

    def __contains__(self, number: int) -> bool:
        return number in self._rows

    def __len__(self) -> int:
        return len(self._rows)

    def append(self, row: Built) -> None:
        """Keep a row (see `RowStore.append`)."""
        self._rows[row.number] = row

    def row(self, number: int) -> Built:
        """Return the row of a number that is there (see `RowStore.row`)."""
        return self._rows[number]

    def rows(self) -> Iterator[Built]:
        """Yield all rows by their numbers (see `RowStore.rows`)."""
        for number in sorted(self._rows):
            yield self._rows[number]

    def close(self) -> None:
        """Do nothing (see `RowStore.close`)."""
