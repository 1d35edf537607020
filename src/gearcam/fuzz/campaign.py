"""A campaign: which designs are tried, and what is counted."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

from gearcam.draws.designs import Drawn, design
from gearcam.draws.draw import Draw
from gearcam.facts import lined_up
from gearcam.fuzz.outcome import BUILT, FAILED, LATE, REFUSED, WRONG, Failure, Outcome, Task
from gearcam.fuzz.pool import Pool
from gearcam.fuzz.shrink import Files, shrunk

DOUBTED: Final = 0.1
"""Share of designs that a study by other means is held against."""

FOLLOWED: Final = 0.2
"""Share of designs whose remedies are searched and built, where they are refused or have errors."""

MOST_REFUSED: Final = 0.2
"""Share of the designs drawn to be built that may be refused."""

PATIENCE: Final = 120.0
"""Time for making a failing design small, s."""

_REASONS: Final = 12
"""Reasons of refusals that are told."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """A random design, told by its `kind`, the `seed` and its number, `index`."""

    kind: str
    seed: int
    index: int

    @property
    def name(self) -> str:
        """Its name."""
        return f"{self.kind}-{self.seed}-{self.index}"

    @property
    def command(self) -> str:
        """What tries it alone."""
        return f"gearcam fuzz --kind {self.kind} --seed {self.seed} --only {self.index}"

    @cached_property
    def drawn(self) -> Drawn:
        """The design."""
        return design(self.kind, self.seed, self.index)

    def task(self, files: Files | None = None) -> Task:
        """Return what is to be tried: the design, or other `files` in the same way."""
        d = Draw(f"trial of {self.name}")
        return Task(
            files=self.drawn.files if files is None else files,
            doubt=d.chance(DOUBTED),
            follow=d.chance(FOLLOWED),
        )


@dataclass(kw_only=True)
class Catch:
    """A `failure`, its `case`, and the `files` of the smallest design that fails so."""

    case: Case
    failure: Failure
    files: Files


@dataclass(kw_only=True)
class Campaign:
    """Trials of many designs.

    Parameters
    ----------
    cases : sequence of Case
        Which.
    pool : Pool
        Where they are tried.
    counts : mapping of (str, str, str) to int
        Ends by kind and by whether the design is broken.
    reasons : mapping of str to int
        Why designs that were drawn to be built are refused.
    found : list of Catch
        Failures.
    slowest : (float, str)
        The longest processor time, s, and the design that took it.
    seconds, clock : float, s
        Processor time of all trials; time by the clock.
    doubted, followed : int
        Designs that were studied by other means, suggestions that were built.
    """

    cases: Sequence[Case]
    pool: Pool
    counts: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    reasons: Counter[str] = field(default_factory=Counter)
    found: list[Catch] = field(default_factory=list)
    slowest: tuple[float, str] = (0.0, "")
    seconds: float = 0.0
    doubted: int = 0
    followed: int = 0
    clock: float = 0.0

    def run(self, progress: Callable[[str, int, int], None] | None) -> Iterator[Catch]:
        """Try all and yield failures as they are found, `progress` told."""
        start = time.monotonic()
        for done, (number, outcome) in enumerate(self._outcomes(), start=1):
            self._take(self.cases[number], outcome)
            if progress is not None:
                progress(f"{len(self.found)} failures", done, len(self.cases))
            if outcome.failure is not None:
                case = self.cases[number]
                self.found.append(Catch(case=case, failure=outcome.failure, files=case.drawn.files))
                yield self.found[-1]
        self.clock = time.monotonic() - start

    def _outcomes(self) -> Iterator[tuple[int, Outcome]]:
        """Yield how trials ended; what took too long is tried once more, as machines may pause."""
        late: list[int] = []
        for number, outcome in self.pool.each(self._tasks(range(len(self.cases)))):
            if outcome.failure is not None and outcome.failure.kind == LATE:
                late.append(number)
            else:
                yield number, outcome
        yield from self.pool.each(self._tasks(late))

    def _tasks(self, numbers: Iterable[int]) -> Iterator[tuple[int, Task]]:
        return ((number, self.cases[number].task()) for number in numbers)

    def _take(self, case: Case, outcome: Outcome) -> None:
        drawn = _BROKEN if case.drawn.broken else _WHOLE
        self.counts[case.kind, drawn, outcome.end] += 1
        self.seconds += outcome.seconds
        self.doubted += outcome.doubted
        self.followed += outcome.followed
        self.slowest = max(self.slowest, (outcome.seconds, case.name))
        if outcome.end in (REFUSED, WRONG) and not case.drawn.broken:
            self.reasons[outcome.reason] += 1

    def shrink(self, found: Catch) -> None:
        """Make the design of a failure small."""

        def fails(files: Files) -> bool:
            return found.failure.same(self.pool.one(found.case.task(files)).failure)

        found.files = shrunk(found.files, fails, PATIENCE)

    @property
    def refused(self) -> float:
        """Share of the designs drawn to be built that were refused."""
        whole = {end: n for (_, drawn, end), n in self._by_end() if drawn == _WHOLE}
        return (whole.get(REFUSED, 0) + whole.get(WRONG, 0)) / max(sum(whole.values()), 1)

    def _by_end(self) -> Iterator[tuple[tuple[str, str, str], int]]:
        summed: Counter[tuple[str, str, str]] = Counter()
        for (_, drawn, end), count in self.counts.items():
            summed["", drawn, end] += count
        yield from summed.items()

    @property
    def good(self) -> bool:
        """Whether nothing failed, and not too much was refused."""
        return not self.found and self.refused <= MOST_REFUSED

    def lines(self) -> Iterator[str]:
        """Yield the tables of what was tried."""
        ends = (BUILT, REFUSED, WRONG, FAILED)
        rows: list[tuple[str, ...]] = [("", "designs", *ends)]
        for kind, drawn in sorted({key[:2] for key in self.counts}):
            counts = [self.counts[kind, drawn, end] for end in ends]
            rows.append((f"{kind}, {drawn}", *map(str, (sum(counts), *counts))))
        yield from lined_up(rows)
        yield f"refused of those {_WHOLE}: {100 * self.refused:.1f} %"
        for reason, count in self.reasons.most_common(_REASONS):
            yield f"  {count:>6}  {reason}"
        yield f"studied by other means: {self.doubted}, suggestions built: {self.followed}"
        count = len(self.cases)
        each = self.seconds / max(count, 1)
        yield (
            f"processor time {self.seconds:.1f} s, {1 / each if each else 0:.1f} designs a second "
            f"for each process; {self.clock:.1f} s by the clock"
        )
        yield f"slowest: {self.slowest[1]}, {self.slowest[0]:.1f} s"
        kinds = Counter(f"{one.failure.kind} {one.failure.place}" for one in self.found)
        yield f"failures: {len(self.found)}"
        yield from (f"  {count:>6}  {kind}" for kind, count in kinds.most_common())


_WHOLE: Final = "drawn to be built"
_BROKEN: Final = "with something broken"
