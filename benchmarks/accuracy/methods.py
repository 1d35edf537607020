"""Methods for the same task at several resolutions: error, median run time, order."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from gearcam.pictures.charts import Chart, Line

SECONDS = "run time, s"
SLOW, FEW = 0.2, 3
"""Levels that take longer than `SLOW` s are timed `FEW` times."""
FITTED = 4
"""Number of rungs to which an order is fitted: the finest above rounding."""
EVEN = 0.8
"""An error counts as smaller below this part of another."""
ABOVE = 300.0
"""Factor on rounding above which an error shows its order."""


@dataclass(frozen=True)
class Method:
    """A method with its levels and its computation."""

    name: str
    refined: str
    levels: Sequence[float]
    make: Callable[[Any], Any]
    order: float | None = None
    """Theoretical order in the level, negative for tolerances; None if there is none."""
    error: Callable[[Any], float] | None = None
    """The error of the result, if it has another form than those of the other methods."""
    size: Callable[[Any], float] | None = None
    """The size of the result, to report instead of the run time."""


@dataclass(frozen=True)
class Rung:
    """One level of a method, measured."""

    level: float
    error: float
    cost: float
    """Median run time, s; or a size."""


@dataclass(frozen=True)
class Case:
    """A task for several methods; the names of those of gearcam begin with `own`."""

    name: str
    title: str
    what: str
    unit: str
    methods: Sequence[Method]
    own: str
    error: Callable[[Any], float]
    rounding: float
    """The rounding error."""
    note: str
    cost: str = SECONDS


@dataclass
class Found:
    """The measurements of a case, by method."""

    case: Case
    rungs: Mapping[str, list[Rung]] = field(default_factory=dict)

    def order(self, method: Method) -> float | None:
        """Return the order: the slope of the error against the level, above rounding."""
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
        """The rungs that no other surpasses in both error and cost."""
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
        """Whether the method of gearcam is the most accurate one of the front."""
        return self.front[-1][0].startswith(self.case.own)

    @property
    def chart(self) -> Chart:
        """Error against cost, for logarithmic axes."""
        lines = []
        for name, rungs in self.rungs.items():
            cost = np.array([one.cost for one in rungs])
            error = np.array([max(one.error, self.case.rounding / 4) for one in rungs])
            lines.append(Line(label=name, x=cost, y=error))
        what = f"error of {self.case.what}, {self.case.unit}"
        return Chart(title=self.case.title, x=self.case.cost, y=what, lines=tuple(lines), log="xy")

    def rows(self) -> list[str]:
        """Return a table with a row for each method: order, coarsest and finest rung."""
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
    """Time every level of every method, alternately, and measure errors once."""
    rungs = [(method, level) for method in case.methods for level in method.levels]
    errors, sizes = [], []
    for method, level in rungs:
        made = method.make(level)  # not timed
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
