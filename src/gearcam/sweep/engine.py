"""What builds the variants of a sweep: the interface of engines."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.designs.design import Design
from gearcam.sweep.rows import Built

Job = tuple[int, dict[str, Any]]
"""Number and values of a variant."""

CHUNK_S = 0.25
"""Time that a chunk of variants should take, s."""

MOST = 256
"""Largest number of variants in a chunk."""

_LATELY: Final = 100
"""Number of variants whose mean decides."""


class Engine(ABC, ShortRepr):
    """What builds variants."""

    @property
    @abstractmethod
    def name(self) -> str:
        """In words, for messages."""

    @abstractmethod
    def run(self, base: Design, jobs: Iterable[Job]) -> Iterator[Built]:
        """Yield the rows of variants as they come, in any order; each exactly once.

        Parameters
        ----------
        base : Design
            The design whose keys get other values.
        jobs : iterable of (int, dict)
            Numbers and values of variants; read as they are needed.
        """

    @contextmanager
    def session(self, base: Design) -> Iterator[Callable[[Sequence[Job]], Iterator[Built]]]:
        """Yield a function that yields the rows of some variants, for several lots of them.

        Parameters
        ----------
        base : Design
            The design whose keys get other values.
        """
        yield lambda jobs: self.run(base, jobs)


def chunk_size(mean: float, most: int = MOST, seconds: float = CHUNK_S) -> int:
    """Return the number of variants of a chunk.

    Parameters
    ----------
    mean : float, s
        Mean time of one; 0 if it is unknown: then one is enough.
    most : int
        Largest number.
    seconds : float, s
        Time of a chunk.
    """
    return max(1, min(most, int(seconds / mean))) if mean > 0.0 else 1


class Pace:
    """The mean time of variants, of late; 0 while it is unknown."""

    def __init__(self) -> None:
        self.mean, self._count = 0.0, 0

    def add(self, time_s: float) -> None:
        """Count a variant that took this time."""
        self._count += 1
        self.mean += (time_s - self.mean) / min(self._count, _LATELY)

    def chunk(self, seconds: float) -> int:
        """Return the number of variants of a chunk that takes this time, s."""
        return chunk_size(self.mean, seconds=seconds)
