"""The best of a family: variants that have least or most of some facts, and break no limit.

A *trial* is a variant that a method asks for. What the log has already is not built again: methods
ask for the same trials again, so that a search that was ended goes on.

Refused: searches in which no variant can be taken.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import Array
from gearcam.sweeps.engine import Build
from gearcam.sweeps.kept import RowStore
from gearcam.sweeps.methods import NONE, Spent
from gearcam.sweeps.plan import Plan
from gearcam.sweeps.rows import Built

_REFUSED: Final = 1e6
"""Violation of variants that cannot be made: above that of any finding."""

FRONT: Final = 20
"""Largest number of designs that are written of several goals."""


@dataclass(eq=False, kw_only=True)
class Trials(ShortRepr):
    """The trials of a search.

    Parameters
    ----------
    plan : Plan
        What is varied.
    signs : mapping of str to float
        1 of facts that are to be least, -1 of those that are to be largest.
    warnings : bool
        Whether the best must not have warnings either.
    most : int
        Largest number of trials.
    log : RowStore
        Rows that are there, and new ones.
    build : callable
        ``build(jobs)`` yields the rows of variants.
    progress : callable, optional
        Called with the trials so far, their largest number, and the best in words.
    rows : list of Built
        The trials so far.
    """

    plan: Plan
    signs: Mapping[str, float]
    warnings: bool
    most: int
    log: RowStore
    build: Build
    progress: Callable[[int, int], Any] | None = None
    rows: list[Built] = field(default_factory=list)

    def evaluate(self, points: Array) -> tuple[Array, Array]:
        """Return goals, (n, m), and violations, (n,), of points of the unit cube, (n, d).

        Raises
        ------
        Spent
            If all trials are used.
        """
        if len(self.rows) >= self.most:
            raise Spent
        new = self._rows_of(points[: self.most - len(self.rows)])
        goals = np.full((len(points), len(self.signs)), NONE)
        broken = np.full(len(points), _REFUSED)
        for place, row in enumerate(new):
            if row.made:
                goals[place], broken[place] = self.goals(row), self.broken(row)
        return goals, broken

    def _rows_of(self, points: Array) -> list[Built]:
        """Return the rows of points: from the log, or built and appended to it."""
        first = len(self.rows)
        numbers = range(first, first + len(points))
        jobs = list(zip(numbers, map(self.plan.at, points), strict=True))
        known = {
            number: row
            for number, one in jobs
            if number in self.log and (row := self.log.row(number)).values == one
        }
        try:
            for row in self.build([job for job in jobs if job[0] not in known]):
                self.log.append(row)
                known[row.number] = row
                if self.progress is not None:
                    self.progress(first + len(known), self.most)
        finally:  # an interruption leaves those that are built
            self.rows += [known[number] for number in numbers if number in known]
        return self.rows[first:]

    def broken(self, row: Built) -> float:
        """Return by how much a trial breaks what must not be broken; 0 if it may be taken."""
        if not row.made:
            return _REFUSED
        count = row.errors + (row.warnings if self.warnings else 0)
        return row.excess if count else 0.0

    @property
    def good(self) -> list[Built]:
        """The trials that may be taken and have all goals."""
        return [
            row
            for row in self.rows
            if self.broken(row) == 0.0 and all(_fact(row, name) < NONE for name in self.signs)
        ]

    def goals(self, row: Built) -> tuple[float, ...]:
        """Return the goals of a trial, which are to be least."""
        return tuple(sign * _fact(row, name) for name, sign in self.signs.items())

    def best(self) -> list[Built]:
        """Return the trials that no other one surpasses, by their first goal; one of one goal.

        Raises
        ------
        InfeasibleError
            If none may be taken.
        """
        good = {self.goals(row): row for row in reversed(self.good)}  # the first of equal ones
        if not good:
            raise self._refusal()
        front: list[tuple[float, ...]] = []
        for one in sorted(good):
            if not any(all(a <= b for a, b in zip(other, one, strict=True)) for other in front):
                front.append(one)
        return [good[one] for one in front]

    @property
    def unchanged(self) -> list[str]:
        """The goals that are the same in all variants, of two or more."""
        made = [self.goals(row) for row in self.rows if row.made]
        columns = zip(self.signs, zip(*made, strict=True), strict=True) if len(made) > 1 else ()
        return [name for name, values in columns if len(set(values)) == 1]

    def _refusal(self) -> InfeasibleError:
        """Return the refusal of a search without a variant that may be taken."""
        if not self.rows:
            return InfeasibleError("no variant was built", where="sweep")
        reasons = Counter(row.refusal or ", ".join(row.findings) for row in self.rows)
        why, count = reasons.most_common(1)[0]
        return InfeasibleError(
            f"none of {len(self.rows)} variants can be taken; {count} of them: {why}",
            where="sweep",
            nearest="other ranges, or more trials",
        )


def _fact(row: Built, name: str) -> float:
    value = row.facts.get(name, NONE)
    return float(value) if isinstance(value, int | float) else NONE
