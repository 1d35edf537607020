"""Measure how time and memory grow with the size of designs; write benchmarks/results/growth.md.

Words as arguments choose the series whose names hold one of them; then nothing is written.
"""

from __future__ import annotations

import gc
import os
import sys
import time
import tracemalloc
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from typing import Any

import numpy as np

import gearcam
import growth_cases
from gearcam.numeric.memory import keep_freed_memory
from measuring import ROOT, environment, show

PAGE = ROOT / "benchmarks" / "results" / "growth.md"
HEAD = """# Growth

Written by `make growth`: processor time and peak memory of one build, of short ones the better of
two, each series in a process of its own, where a system can be asked for it on one processor:
threads that wait take time of theirs. `build` is everything from reading to checks and facts; each
kind of file and the meshing study of 120 steps are what they take beyond it. Exponents are those of
the time by least squares, of its last step, mostly a decade, and of the memory by its last step. A
cost that does not grow by a tenth of a second is not judged.
"""
SLOPE, LAST, SEEN = 1.1, 1.2, 0.1
"""Largest exponents over all and of the last step, and growth in s that is judged."""

AGAIN = 2.0
"""Seconds below which it is measured twice."""


@dataclass
class Row:
    """What one thing costs over sizes: the memory of the last two."""

    name: str
    stage: str
    sizes: list[float]
    seconds: list[float]
    bytes: list[float]

    @property
    def slopes(self) -> tuple[float, float, float]:
        """Exponents: of time over all, of its last step, of the memory's."""
        x = np.log(self.sizes)
        time, memory = np.log(np.maximum(self.seconds, 1e-6)), np.log(np.maximum(self.bytes, 1.0))
        step = x[-1] - x[-2]
        whole = float(np.polyfit(x, time, 1)[0])
        return whole, float((time[-1] - time[-2]) / step), float((memory[-1] - memory[-2]) / step)

    @property
    def passed(self) -> bool:
        """Whether it grows no worse than linearly."""
        whole, last, _ = self.slopes
        grown = self.seconds[-1] - self.seconds[0] > SEEN
        return not grown or (whole <= SLOPE and last <= LAST)

    @property
    def given_up(self) -> str:
        """Why it grows faster, where that is known."""
        return next((why for names, why in growth_cases.GIVEN_UP.items() if self.fits(names)), "")

    def fits(self, names: tuple[str, str]) -> bool:
        """Whether it is what a reason is given for: words of the series, and a stage."""
        return names[0] in self.name and names[1] == self.stage

    def line(self) -> str:
        """One row of the table."""
        whole, last, memory = self.slopes
        verdict = "" if self.passed else "given up" if self.given_up else "**fail**"
        low, high = (f"{size:g}" for size in (self.sizes[0], self.sizes[-1]))
        return (
            f"| {self.name} | {self.stage} | {low} to {high} | {show(self.seconds[0])} "
            f"| {show(self.seconds[-1])} | {whole:.2f} | {last:.2f} "
            f"| {self.bytes[-1] / 2**20:.1f} MiB | {memory:.2f} | {verdict} |"
        )


def once(text: str, stages: dict[str, Callable[[Any], object]], traced: bool) -> tuple[Any, Any]:
    """The result, and what each stage costs: seconds, or bytes if traced."""
    costs: dict[str, float] = {}
    job: Any = None
    for name, stage in {"build": growth_cases.build, **stages}.items():
        gc.collect()
        if traced:
            tracemalloc.start()
        start = time.process_time()
        if job is None:
            job = gearcam.build(gearcam.loads(text))
        stage(job)
        costs[name] = time.process_time() - start
        if traced:
            costs[name] = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
    return job, costs


def alone(number: int) -> list[Row]:
    """The rows of a series, measured in a new process."""
    with ProcessPoolExecutor(1, get_context("spawn")) as process:
        return process.submit(measured, number).result()


def measured(number: int) -> list[Row]:
    """The rows of a series, measured here."""
    keep_freed_memory()  # as the command line does
    series = growth_cases.all_series()[number]
    sizes: list[float] = []
    seconds: list[dict[str, float]] = []
    peaks: list[dict[str, float]] = []
    once(series.text(series.sizes[0]), series.stages, traced=False)  # loads what it needs
    for size in series.sizes:
        text = series.text(size)
        job, costs = once(text, series.stages, traced=False)
        if sum(costs.values()) < AGAIN:
            again = once(text, series.stages, traced=False)[1]
            costs = {name: min(costs[name], again[name]) for name in costs}
        seconds.append(costs)
        if size in series.sizes[-2:]:
            peaks.append(once(text, series.stages, traced=True)[1])
        sizes.append(growth_cases.points(job) if series.by_points else size)
    return [
        Row(series.name, name, sizes, [one[name] for one in seconds], [one[name] for one in peaks])
        for name in seconds[0]
    ]


def page(rows: list[Row], missing: int) -> str:
    """The page as text, and how many series are still missing."""
    stopped = f"The run was stopped before {missing} more series.\n"
    lines = [
        HEAD,
        *([stopped] if missing else []),
        *environment(("gearcam", "numpy", "shapely")),
        "",
    ]
    lines += ["| what grows | cost of | size | least | most | n^ | last n^ | memory | last n^ | |"]
    lines += ["|---|---|---|---|---|---|---|---|---|---|", *(row.line() for row in rows), ""]
    for row in rows:
        if not row.passed and row.given_up:
            lines.append(f"- {row.name}, {row.stage}: {row.given_up}")
    return "\n".join(lines) + "\n"


def main() -> int:
    """Measure all series, or those whose names hold a word."""
    if sys.platform == "linux":  # processes it starts take it over, and load numpy only then
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    words, rows, every = sys.argv[1:], [], growth_cases.all_series()
    for number, series in enumerate(every):
        if not words or any(word in series.name for word in words):
            found = alone(number)
            rows += found
            print("\n".join(row.line() for row in found), flush=True)
            if not words:
                PAGE.write_text(page(rows, len(every) - number - 1), encoding="utf-8")
    return 0 if all(row.passed or row.given_up for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
