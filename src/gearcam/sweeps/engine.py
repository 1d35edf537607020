"""What builds the variants of a sweep: the interface of engines, and what they build."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.designs.design import Design
from gearcam.sweeps.kept import RowStore
from gearcam.sweeps.plan import Plan
from gearcam.sweeps.rows import Built, Measure, measured

Job = tuple[int, dict[str, Any]]
"""Number and values of a variant."""

Build = Callable[[Iterable[Job]], Iterator[Built]]
"""``build(jobs)`` yields the rows of a lot of variants in any order, each exactly once.

Jobs are read as they are needed.
"""

SECONDS: Final = 300.0
"""Default limit of a variant's time, s."""

MEMORY: Final = 4 << 30
"""Default limit of a process's memory, bytes."""


@dataclass(frozen=True, kw_only=True)
class Engine(ABC, ShortRepr):
    """What builds variants.

    Parameters
    ----------
    seconds : float, s
        Largest time of a variant.
    memory : int
        Largest memory of a process, bytes.
    measure : callable
        ``measure(base, number, values)`` returns the row of a variant; a function of a module.
    """

    seconds: float = SECONDS
    memory: int = MEMORY
    measure: Measure = measured

    @property
    @abstractmethod
    def name(self) -> str:
        """In words, for messages."""

    @abstractmethod
    def session(self, base: Design) -> AbstractContextManager[Build]:
        """Return a context with what builds variants, lot by lot, by the same processes.

        Parameters
        ----------
        base : Design
            The design whose keys get other values.
        """

    def run(self, base: Design, jobs: Iterable[Job]) -> Iterator[Built]:
        """Yield the rows of one lot of variants (see `session`)."""
        with self.session(base) as build:
            yield from build(jobs)


def missing_rows(plan: Plan, there: RowStore, engine: Engine) -> Iterator[Built]:
    """Build what is missing; yield rows as they come, each when it is kept.

    Parameters
    ----------
    plan : Plan
        The variants.
    there : RowStore
        Rows of this sweep that are there; new ones are kept with them.
    engine : Engine
        What builds them.

    Yields
    ------
    Built
    """

    def missing() -> Iterator[Job]:
        for number in range(plan.count):
            if number not in there:
                yield number, plan.values(number)

    for row in engine.run(plan.base, missing()):
        there.append(row)
        yield row
