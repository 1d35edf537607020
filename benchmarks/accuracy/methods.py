"""Methods that do the same thing, each at a ladder of resolutions: error, median time, order."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from gearcam.charts import Chart, Line

SECONDS = "run time, s"
SLOW, FEW = 0.2, 3
"""What takes longer than so many seconds is timed so often."""
FITTED = 4
"""Rungs to which an order is fitted: the finest that are above rounding."""
EVEN = 0.8
"""Part of an error below which another is better, not as good."""
ABOVE = 300.0
"""How far above rounding an error shows its order: sums of many samples round more than one."""


@dataclass(frozen=True)
class Method:
    """A way to do it: what a level is, the levels, and the work."""

    name: str
    refined: str
    levels: Sequence[float]
    make: Callable[[Any], Any]
    order: float | None = None
    """In theory, by the level; negative where a level is a tolerance; None where there is none."""
    error: Callable[[Any], float] | None = None
    """Where what is made is of another form than what the others make."""
    size: Callable[[Any], float] | None = None
    """What is told instead of the run time."""


@dataclass(frozen=True)
class Rung:
    """One level of a method, measured."""

    level: float
    error: float
    cost: float
    """Median run time, s; or a size."""


@dataclass(frozen=True)
class Case:
    """Something that several methods do; `own` is how names of the program's methods begin."""

    name: str
    title: str
    what: str
    unit: str
    methods: Sequence[Method]
    own: str
    error: Callable[[Any], float]
    rounding: float
    """Error that is rounding."""
    note: str
    cost: str = SECONDS


@dataclass
class Found:
    """What was measured of a case, by method."""

    case: Case
    rungs: Mapping[str, list[Rung]] = field(default_factory=dict)

    def order(self, method: Method) -> float | None:
        """Slope of the error over the level, above rounding."""
        rungs = self.rungs[method.name]
        best = min(range(len(rungs)), key=lambda k: rungs[k].error)
        kept = [one for one in rungs[: best + 1] if one.error > ABOVE * self.case.rounding]
        kept = kept[-FITTED:]
        if len(kept) < 2:
            return None
        level, error = np.log([(one.level, one.error) for one in kept]).T
        return -float(np.polyfit(level, error, 1)[0])

    @property
    def front(self) -> list[tuple[str, Rung]]:
        """The rungs that no other beats: none is as exact at less cost."""
        every = [(name, rung) for name, rungs in self.rungs.items() for rung in rungs]
        every.sort(key=lambda one: (one[1].cost, one[1].error))
        front, best = [], np.inf
        for name, rung in every:
            if max(rung.error, self.case.rounding) < EVEN * best:
                best = max(rung.error, self.case.rounding)
                front.append((name, rung))
        return front

    @property
    def on_front(self) -> bool:
        """Whether the program's own method is the most exact one of the front."""
        return self.front[-1][0].startswith(self.case.own)

    @property
    def chart(self) -> Chart:
        """Error over cost, both for logarithmic axes."""
        lines = []
        for name, rungs in self.rungs.items():
            cost = np.array([one.cost for one in rungs])
            error = np.array([max(one.error, self.case.rounding / 4) for one in rungs])
            lines.append(Line(label=name, x=cost, y=error))
        what = f"error of {self.case.what}, {self.case.unit}"
        return Chart(title=self.case.title, x=self.case.cost, y=what, lines=tuple(lines))

    def rows(self) -> list[str]:
        """A table: one row a method, its coarsest and finest rung, its order."""
        bytes_ = self.case.cost != SECONDS
        cost = "size" if bytes_ else "time"
        made = [
            f"| method | refined | levels | order (theory) | coarsest: error, {cost} | finest |",
            "|---|---|---|---|---|---|",
        ]
        for method in self.case.methods:
            rungs = self.rungs[method.name]
            order = self.order(method)
            theory = "" if method.order is None else f" ({method.order:g})"
            told = "rounding" if order is None else f"{order:.2f}{theory}"
            ends = (f"{one.error:.1e} {self.case.unit}, {_cost(one.cost, bytes_)}" for one in rungs)
            first, *_, last = [text for text in ends for _ in (0, 1)]
            name = f"**{method.name}**" if method.name.startswith(self.case.own) else method.name
            levels = f"{rungs[0].level:g} to {rungs[-1].level:g}" if len(rungs) > 1 else ""
            made.append(f"| {name} | {method.refined} | {levels} | {told} | {first} | {last} |")
        return made


def _cost(value: float, size: bool) -> str:
    if size:
        return f"{value / 1e3:.1f} kB"
    return f"{1e3 * value:.3g} ms"


def climb(case: Case, repeats: int) -> Found:
    """Make every level of every method, in turns, and measure errors once."""
    rungs = [(method, level) for method in case.methods for level in method.levels]
    errors, sizes = [], []
    for method, level in rungs:
        made = method.make(level)  # does not count
        errors.append((method.error or case.error)(made))
        sizes.append(None if method.size is None else method.size(made))
    samples: list[list[float]] = [[] for _ in rungs]
    if case.cost != SECONDS:
        repeats = 0
    for number in range(repeats):
        cut = number * 7 % len(rungs)
        for k in (*range(cut, len(rungs)), *range(cut)):
            if number >= FEW and samples[k][0] > SLOW:
                continue
            method, level = rungs[k]
            start = time.perf_counter()
            method.make(level)
            samples[k].append(time.perf_counter() - start)
    found: dict[str, list[Rung]] = {}
    for (method, level), error, size, taken in zip(rungs, errors, sizes, samples, strict=True):
        cost = statistics.median(taken) if size is None else size
        found.setdefault(method.name, []).append(Rung(level, error, cost))
    return Found(case, found)
