"""Error against run time: the stages of a design, measured at increasing resolution."""

from __future__ import annotations

import itertools
import math
import statistics
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, GearcamError, Problem
from gearcam.base.facts import Fact, lined_up
from gearcam.base.numerals import formatted
from gearcam.designs.design import Design
from gearcam.designs.faults import show
from gearcam.designs.slips import did_you_mean
from gearcam.numeric.arguments import whole
from gearcam.pictures.charts import Chart, Line
from gearcam.results.kind import KINDS
from gearcam.results.ladders import Ladder, suits
from gearcam.results.result import Result
from gearcam.results.study import Progress, silent

REPEATS: Final = 5
"""Default number of runs of each level."""

_Run = tuple[str, float]
"""Name of a method, and a level."""

_FITTED: Final = 3
"""Number of rungs to which the order is fitted: the finest above rounding."""


@dataclass(frozen=True, kw_only=True)
class Rung(ShortRepr):
    """One level of a stage, measured.

    Parameters
    ----------
    stage : str
        Name of the stage.
    by : str
        Name of the method, if several are compared.
    level : float
        The resolution: intervals, points on a flank, or a chord tolerance in mm.
    own : bool
        Whether the program uses this level.
    error : float
        In the unit of the ladder.
    order : float or None
        Order of convergence in the number of points, from the rung before to this one; None for
        the first rung, without more points, below rounding, and where none is expected.
    seconds : float
        Median run time.
    points : int
        Number of points.
    """

    stage: str
    by: str
    level: float
    own: bool
    error: float
    order: float | None
    seconds: float
    points: int


@dataclass(frozen=True, eq=False, kw_only=True)
class Accuracy(ShortRepr):
    """The accuracy of a result, measured.

    Parameters
    ----------
    result : Result
        The result measured.
    ladders : mapping of str to Ladder
        By stage.
    rungs : tuple of Rung
        By stage, from coarse to fine.
    refused : mapping of (str, float) to str
        Reasons by stages and levels that cannot be computed; the level is NaN for a whole stage.
    repeat : int
        Number of runs of each level.
    """

    result: Result
    ladders: Mapping[str, Ladder]
    rungs: tuple[Rung, ...]
    refused: Mapping[tuple[str, float], str]
    repeat: int

    def of(self, stage: str, by: str | None = None) -> tuple[Rung, ...]:
        """Return the rungs of a stage, from coarse to fine.

        Parameters
        ----------
        stage : str
            Name of the stage.
        by : str, optional
            A method, if several are compared; that of gearcam by default.

        Returns
        -------
        tuple of Rung
        """
        by = self.ladders[stage].by if by is None else by
        return tuple(rung for rung in self.rungs if (rung.stage, rung.by) == (stage, by))

    def order(self, stage: str) -> float | None:
        """Return the order of convergence of a `stage`, fitted to its finest rungs above rounding.

        None if none is expected, or fewer than two rungs are above rounding or have different
        numbers of points.
        """
        ladder = self.ladders[stage]
        if ladder.order is None:
            return None
        rungs = [rung for rung in self.of(stage) if rung.error > ladder.rounding]
        points, errors = np.log(
            [(float(rung.points), rung.error) for rung in rungs[-_FITTED:]] or [(1.0, 1.0)]
        ).T
        if np.ptp(points) == 0.0:
            return None
        return -float(np.polyfit(points, errors, 1)[0])

    def lines(self) -> Iterator[str]:
        """Yield the lines of the printed table: a heading for each stage, its rungs below."""
        runs = f"median of {self.repeat} run{'s' * (self.repeat > 1)}"
        yield f"error against run time, {runs}; * as used by gearcam"
        for stage, ladder in self.ladders.items():
            slope = ""
            if ladder.order is not None:
                order = self.order(stage)
                slope = "; rounding" if order is None else f"; order {order:.2f}"
                slope += f", expected {formatted(ladder.order)}"
            yield f"{stage}: error of {ladder.measured}{slope}"
            yield from (f"  {row}" for row in lined_up(_right([*self._cells(stage)])))
            for (whose, level), why in self.refused.items():
                if whose == stage:
                    yield f"  {formatted(level)}: left out: {why}"
        for (whose, _), why in self.refused.items():
            if whose not in self.ladders:
                yield f"{whose}: left out: {why}"

    def _cells(self, stage: str) -> Iterator[tuple[str, ...]]:
        """Yield the rows of the table of a stage, its head first."""
        ladder = self.ladders[stage]
        several, ordered = bool(ladder.others), ladder.order is not None
        order = ("order",) * ordered
        yield ("method",) * several + (ladder.refined, "", "error", *order, "time", "points")
        for rung in (one for by in ladder.methods for one in self.of(stage, by)):
            error = f"{rung.error:.2e} {ladder.unit}".rstrip()
            fell = ("" if rung.order is None else f"{rung.order:.2f}",) * ordered
            mark, times = "*" if rung.own else "", f"{1e3 * rung.seconds:.3f} ms"
            cells = (formatted(rung.level), mark, error, *fell, times, str(rung.points))
            yield (rung.by,) * several + cells

    @cached_property
    def columns(self) -> dict[str, Any]:
        """The columns of ``accuracy.csv``: a row for each rung; no order is missing."""
        rows = [(self.ladders[rung.stage], rung) for rung in self.rungs]
        orders = [math.nan if rung.order is None else rung.order for _, rung in rows]
        return {
            "stage": [rung.stage for _, rung in rows],
            "measured": [ladder.measured for ladder, _ in rows],
            "method": [rung.by for _, rung in rows],
            "refined": [ladder.refined for ladder, _ in rows],
            "level": [rung.level for _, rung in rows],
            "own": [int(rung.own) for _, rung in rows],
            "error": [rung.error for _, rung in rows],
            "unit": [ladder.unit for ladder, _ in rows],
            "rounding": [ladder.rounding for ladder, _ in rows],
            "order": np.ma.masked_invalid(orders),
            "order_expected": np.ma.masked_invalid(
                [math.nan if ladder.order is None else ladder.order for ladder, _ in rows]
            ),
            "time_s": [rung.seconds for _, rung in rows],
            "points": [rung.points for _, rung in rows],
        }

    @property
    def facts(self) -> dict[str, Any]:
        """Order, and error and time of the level in use, by stage."""
        return {
            stage: {
                "order": self.order(stage),
                "error": Fact(used.error, f"{stage}: error of {ladder.measured}", unit=ladder.unit),
                "time_s": used.seconds,
            }
            for stage, ladder in self.ladders.items()
            for used in self.of(stage)
            if used.own
        }

    @cached_property
    def charts(self) -> tuple[Chart, ...]:
        """A chart for each stage: errors over run times, both logarithmic, and the level used."""
        return tuple(self._chart(stage) for stage in self.ladders)

    def _chart(self, stage: str) -> Chart:
        ladder, rungs = self.ladders[stage], self.of(stage)
        used = [rung for rung in rungs if rung.own]
        label = ladder.by or "error"

        def line(label: str, some: Sequence[Rung], dots: bool) -> Line:
            x, y = np.array([(rung.seconds, rung.error) for rung in some]).T
            return Line(label=label, x=x, y=y, dots=dots)

        lines = [line(label, rungs, False), line(f"levels: {ladder.refined}", rungs, True)]
        lines += [line(by, self.of(stage, by), False) for by in ladder.others]
        lines += [line("as used by gearcam", used, True)] if used else []
        what = f"error of {ladder.measured}, {ladder.unit}".removesuffix(", ")
        return Chart(title=stage, x="run time, s", y=what, lines=tuple(lines), log="xy")


def stages_of(design: Design, asked: Sequence[str] | None = None) -> tuple[str, ...]:
    """Return the stages of a design that can be measured, or the requested ones of them.

    Parameters
    ----------
    design : Design
        Of any kind.
    asked : sequence of str, optional
        Names of stages; all by default.

    Returns
    -------
    tuple of str

    Raises
    ------
    DesignError
        If the kind has no such stage; the message lists those that it has.
    """
    every_stage = KINDS[design.kind].ladders.items()
    stages = tuple(name for name, make in every_stage if suits(make, design))
    if asked is None and stages:
        return stages
    problems = []
    every = {name for kind in KINDS.values() for name in kind.ladders}
    for name in dict.fromkeys(asked or ("",)):
        if name not in stages:
            what = f" of designs of kind {design.kind}" if name in every else ""
            message = f"{show(name)} is not a stage{what}" if name else "no stage is listed"
            hint = "" if name in every else did_you_mean(name, stages)
            allowed = ", ".join(stages) or f"none of designs of kind {design.kind}"
            problems.append(Problem(message, key="accuracy.stage", allowed=allowed, hint=hint))
    if problems:
        raise DesignError(problems)
    return tuple(name for name in stages if name in (asked or ()))


def accuracy(
    result: Result,
    stages: Sequence[str] | None = None,
    repeat: int = REPEATS,
    progress: Progress | None = None,
) -> Accuracy:
    """Measure the error and run time of the stages of a result at increasing resolution.

    Parameters
    ----------
    result : Result
        The result of a design whose kind has ladders.
    stages : sequence of str, optional
        Names of stages; all by default.
    repeat : int
        Number of runs of each level, at least 1, after one that is not timed. Levels take turns,
        so that a load on the machine affects all alike.
    progress : callable, optional
        Called with the name of a stage, the rounds done and their total.

    Returns
    -------
    Accuracy

    Raises
    ------
    DesignError
        If there is no such stage, or `repeat` is less than 1.
    InfeasibleError
        If the design, its first stage, or all levels of a stage cannot be made.

    Examples
    --------
    >>> import gearcam as gc
    >>> from gearcam.results.accuracy import accuracy
    >>> found = accuracy(gc.build(gc.load("profiles/ellipse.toml")), ["flank"], repeat=1)
    >>> round(found.order("flank"), 1)
    2.0
    """
    count, names = whole("repeat", repeat, 1), stages_of(result.design, stages)
    tell = progress or silent
    makers = result.kind.ladders
    refused: dict[tuple[str, float], str] = {}
    ladders: dict[str, Ladder] = {}
    for name in names:
        try:
            ladders[name] = makers[name](result)
        except GearcamError as error:
            if len(names) == 1 or not ladders:
                raise
            refused[name, math.nan] = str(error)
    total, done = (count + 1) * len(ladders), itertools.count()
    first: dict[str, dict[_Run, tuple[float, int]]] = {}
    for name, ladder in ladders.items():
        tell(name, next(done), total)
        first[name] = _first_round(name, ladder, refused)
    samples = {name: {run: list[float]() for run in runs} for name, runs in first.items()}
    for number in range(count):
        for name, ladder in ladders.items():
            tell(name, next(done), total)
            runs, methods = [*first[name]], ladder.methods
            # rotate them: the first one meets cold caches
            cut = number % len(runs)
            for by, level in runs[cut:] + runs[:cut]:
                start = time.perf_counter()
                methods[by](level)
                samples[name][by, level].append(time.perf_counter() - start)
    return Accuracy(
        result=result,
        ladders=ladders,
        rungs=tuple(
            rung
            for name, ladder in ladders.items()
            for rung in _rungs(name, ladder, first[name], samples[name])
        ),
        refused=refused,
        repeat=count,
    )


def _first_round(
    name: str, ladder: Ladder, refused: dict[tuple[str, float], str]
) -> dict[_Run, tuple[float, int]]:
    """Return error and points of every run of a ladder; record those that fail in `refused`."""
    found, reason = dict[_Run, tuple[float, int]](), None
    for by, make in ladder.methods.items():
        for level in ladder.levels:
            try:
                found[by, level] = ladder.measure(make(level))
            except GearcamError as error:
                refused[name, level], reason = str(error), error
    if reason is not None and not found:
        raise reason
    return found


def _rungs(
    name: str,
    ladder: Ladder,
    found: Mapping[_Run, tuple[float, int]],
    samples: Mapping[_Run, Sequence[float]],
) -> Iterator[Rung]:
    """Yield the rungs of a ladder, from errors and points, and run times, by run."""
    before: dict[str, tuple[float, int]] = {}
    for (by, level), (error, points) in found.items():
        order = None
        if by in before and ladder.order is not None:
            coarser, fewer = before[by]
            if points > fewer and min(error, coarser) > ladder.rounding:
                order = math.log(coarser / error) / math.log(points / fewer)
        before[by] = error, points
        yield Rung(
            stage=name,
            by=by,
            level=level,
            own=by == ladder.by and level == ladder.own,
            error=error,
            order=order,
            seconds=statistics.median(samples[by, level]),
            points=points,
        )


def _right(rows: Sequence[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Return rows with right-aligned cells."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        tuple(f"{cell:>{width}}" for cell, width in zip(row, widths, strict=True)) for row in rows
    ]
