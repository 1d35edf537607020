"""A campaign: the designs to try, and the statistics of their outcomes."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

from fuzz.outcome import BUILT, FAILED, LATE, REFUSED, WRONG, Failure, Outcome, Task
from fuzz.pool import Pool
from fuzz.shrink import Files, shrunk
from gearcam.base.facts import lined_up
from random_designs.designs import Drawn, design
from random_designs.draw import Draw

DOUBTED: Final = 0.1
"""Share of designs whose results are compared with those of other methods."""

FOLLOWED: Final = 0.2
"""Share of the designs refused or with errors whose remedies are searched and built."""

MOST_REFUSED: Final = 0.2
"""Largest share of refusals among the designs that are meant to be buildable."""

PATIENCE: Final = 120.0
"""Time limit for shrinking a failing design, s."""

_REASONS: Final = 12
"""Number of reasons for refusals that are listed."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """A random design, identified by its `kind`, the `seed` and its number, `index`."""

    kind: str
    seed: int
    index: int

    @property
    def name(self) -> str:
        """Name of the design."""
        return f"{self.kind}-{self.seed}-{self.index}"

    @property
    def command(self) -> str:
        """The command that tries this design alone."""
        words = f"--kind {self.kind} --seed {self.seed} --only {self.index}"
        return f"make fuzz MORE='{words}'"

    @cached_property
    def drawn(self) -> Drawn:
        """The design."""
        return design(self.kind, self.seed, self.index)

    @property
    def meant(self) -> str:
        """What the design is meant to be."""
        return _BROKEN if self.drawn.broken else _WHOLE

    def task(self, files: Files | None = None) -> Task:
        """Return the task for the design, or for other `files` with the same settings."""
        d = Draw(f"trial of {self.name}")
        return Task(
            files=self.drawn.files if files is None else files,
            doubt=d.chance(DOUBTED),
            follow=d.chance(FOLLOWED),
        )


@dataclass(kw_only=True)
class Catch:
    """A `failure`, its `case`, and the `files` of the smallest design that fails in this way."""

    case: Case
    failure: Failure
    files: Files


@dataclass(kw_only=True)
class Campaign:
    """Trials of many designs.

    Parameters
    ----------
    cases : sequence of Case
        The designs to try.
    pool : Pool
        The processes that try them.
    counts : mapping of (str, str, str) to int
        Numbers of designs by kind, by buildable or with an error, and by outcome.
    reasons : mapping of str to int
        Reasons for refusals of designs meant to be buildable.
    found : list of Catch
        Failures.
    slowest : (float, str)
        The longest processor time, s, and the name of that design.
    seconds, clock : float, s
        Processor time of all trials, and elapsed time.
    doubted, followed : int
        Numbers of designs checked by other methods and of remedies built.
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
        """Try all designs and yield failures as they are found; report to `progress`."""
        start = time.monotonic()
        try:
            for done, (number, outcome) in enumerate(self._outcomes(), start=1):
                case = self.cases[number]
                self._take(case, outcome)
                if progress is not None:
                    progress(f"{len(self.found)} failures", done, len(self.cases))
                if outcome.failure is not None:
                    files = case.drawn.files
                    self.found.append(Catch(case=case, failure=outcome.failure, files=files))
                    yield self.found[-1]
        finally:
            self.clock = time.monotonic() - start

    def _outcomes(self) -> Iterator[tuple[int, Outcome]]:
        """Yield the outcomes; a design that took too long is tried once more."""
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
        self.counts[case.kind, case.meant, outcome.end] += 1
        self.seconds += outcome.seconds
        self.doubted += outcome.doubted
        self.followed += outcome.followed
        self.slowest = max(self.slowest, (outcome.seconds, case.name))
        if outcome.end in (REFUSED, WRONG) and not case.drawn.broken:
            self.reasons[outcome.reason] += 1

    def shrink(self, found: Catch) -> None:
        """Reduce the design of a failure."""

        def fails(files: Files) -> bool:
            return found.failure.same(self.pool.one(found.case.task(files)).failure)

        found.files = shrunk(found.files, fails, PATIENCE)

    @property
    def refused(self) -> float:
        """Share of refusals among the designs meant to be buildable."""
        ends: Counter[str] = Counter()
        for (_, drawn, end), count in self.counts.items():
            ends[end] += count if drawn == _WHOLE else 0
        return (ends[REFUSED] + ends[WRONG]) / max(ends.total(), 1)

    @property
    def good(self) -> bool:
        """Whether nothing failed and the share of refusals is small enough."""
        return not self.found and self.refused <= MOST_REFUSED

    def lines(self) -> Iterator[str]:
        """Yield the lines of the printed statistics."""
        ends = (BUILT, REFUSED, WRONG, FAILED)
        rows: list[tuple[str, ...]] = [("", "designs", *ends)]
        for kind, drawn in sorted({key[:2] for key in self.counts}):
            counts = [self.counts[kind, drawn, end] for end in ends]
            rows.append((f"{kind}, {drawn}", *map(str, (sum(counts), *counts))))
        yield from lined_up(rows)
        shares = (f"{100 * share:.1f} %" for share in (self.refused, MOST_REFUSED))
        yield f"refused among the {_WHOLE} ones: {', limit '.join(shares)}"
        for reason, count in self.reasons.most_common(_REASONS):
            yield f"  {count:>6}  {reason}"
        yield f"checked by other methods: {self.doubted}, remedies built: {self.followed}"
        count = self.counts.total()
        each = self.seconds / max(count, 1)
        yield (
            f"processor time {self.seconds:.1f} s, {1 / each if each else 0:.1f} designs a second "
            f"per process; elapsed {self.clock:.1f} s"
        )
        yield f"slowest: {self.slowest[1]}, {self.slowest[0]:.1f} s"
        kinds = Counter(f"{one.failure.kind} {one.failure.place}" for one in self.found)
        yield f"failures: {len(self.found)}"
        yield from (f"  {count:>6}  {kind}" for kind, count in kinds.most_common())


_WHOLE: Final = "buildable"
_BROKEN: Final = "with an error"
