"""What builds the variants of a sweep: the interface of engines."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from gearcam.base.display import ShortRepr
from gearcam.designs.design import Design
from gearcam.sweep.rows import Row

Job = tuple[int, dict[str, Any]]
"""Number and values of a variant."""

CHUNK_S = 0.25
"""Time that a chunk of variants should take, s."""

MOST = 256
"""Largest number of variants in a chunk."""


class Engine(ABC, ShortRepr):
    """What builds variants."""

    @property
    @abstractmethod
    def name(self) -> str:
        """In words, for messages."""

    @abstractmethod
    def run(self, base: Design, jobs: Iterable[Job]) -> Iterator[Row]:
        """Yield the rows of variants as they come, in any order; each exactly once.

        Parameters
        ----------
        base : Design
            The design whose keys get other values.
        jobs : iterable of (int, dict)
            Numbers and values of variants; read as they are needed.
        """

    @contextmanager
    def session(self, base: Design) -> Iterator[Callable[[Sequence[Job]], Iterator[Row]]]:
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
