"""Measure how time and memory grow with the size of designs; write benchmarks/results/growth.md.

Arguments select the series whose names contain one of the words; then no page is written.
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
from gearcam.numeric.arrays import keep_freed_memory
from measuring import ROOT, environment, show

PAGE = ROOT / "benchmarks" / "results" / "growth.md"
HEAD = """# Growth

Written by `make growth`: processor time and peak memory of one build; short builds are measured
twice, and the faster one counts. Each series runs in a separate process, on one processor if the
system allows it. `build` is everything from reading to checks and facts; each kind of file
and the meshing study of 120 steps are additional costs. The first exponent of n fits the time by
least squares; the others are those of time and memory from the last size but one, mostly a decade.
Only costs that grow by at least 0.1 s are judged.
"""
SLOPE, LAST, SEEN = 1.1, 1.2, 0.1
"""Largest exponents overall and of the last step, and least growth in s that is judged."""

AGAIN = 2.0
"""Time below which a build is measured twice, s."""


@dataclass
class Row:
    """The cost of a stage against size; `bytes` for the last two sizes."""

    name: str
    stage: str
    sizes: list[float]
    seconds: list[float]
    bytes: list[float]

    @property
    def slopes(self) -> tuple[float, float, float]:
        """Exponents of the time overall, of its last step, and of the memory."""
        x = np.log(self.sizes)
        time, memory = np.log(np.maximum(self.seconds, 1e-6)), np.log(np.maximum(self.bytes, 1.0))
        step = x[-1] - x[-2]
        whole = float(np.polyfit(x, time, 1)[0])
        return whole, float((time[-1] - time[-2]) / step), float((memory[-1] - memory[-2]) / step)

    @property
    def passed(self) -> bool:
        """Whether it grows at most linearly."""
        whole, last, _ = self.slopes
        grown = self.seconds[-1] - self.seconds[0] > SEEN
        return not grown or (whole <= SLOPE and last <= LAST)

    @property
    def given_up(self) -> str:
        """The reason for faster growth, if known."""
        return next((why for names, why in growth_cases.GIVEN_UP.items() if self.fits(names)), "")

    def fits(self, names: tuple[str, str]) -> bool:
        """Return whether a word occurs in the name of the series, and the stage is this one."""
        return names[0] in self.name and names[1] == self.stage

    def line(self) -> str:
        """Return a row of the table."""
        whole, last, memory = self.slopes
        verdict = "" if self.passed else "not met" if self.given_up else "**fail**"
        low, high = (f"{size:g}" for size in (self.sizes[0], self.sizes[-1]))
        return (
            f"| {self.name} | {self.stage} | {low} to {high} | {show(self.seconds[0])} "
            f"| {show(self.seconds[-1])} | {whole:.2f} | {last:.2f} "
            f"| {self.bytes[-1] / 2**20:.1f} MiB | {memory:.2f} | {verdict} |"
        )


def once(text: str, stages: dict[str, Callable[[Any], object]], traced: bool) -> tuple[Any, Any]:
    """Return the result and the cost of each stage: seconds, or bytes if traced."""
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
    """Return the rows of a series, measured in a new process."""
    with ProcessPoolExecutor(1, get_context("spawn")) as process:
        return process.submit(measured, number).result()


def measured(number: int) -> list[Row]:
    """Return the rows of a series, measured in this process."""
    keep_freed_memory()  # as the command line does
    series = growth_cases.all_series()[number]
    sizes: list[float] = []
    seconds: list[dict[str, float]] = []
    peaks: list[dict[str, float]] = []
    once(series.text(series.sizes[0]), series.stages, traced=False)  # imports the modules
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
    """Return the page as text; `missing` is the number of series not yet measured."""
    stopped = f"The run was stopped before {missing} more series.\n"
    lines = [
        HEAD,
        *([stopped] if missing else []),
        *environment(("gearcam", "numpy", "shapely")),
        "",
    ]
    lines += ["| what grows | cost of | size | first | last | n^ | last n^ | memory | last n^ | |"]
    lines += ["|---|---|---|---|---|---|---|---|---|---|", *(row.line() for row in rows), ""]
    for row in rows:
        if not row.passed and row.given_up:
            lines.append(f"- {row.name}, {row.stage}: {row.given_up}")
    return "\n".join(lines) + "\n"


def main() -> int:
    """Measure all series, or those selected by the arguments."""
    if sys.platform == "linux":  # inherited by child processes, before they import numpy
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
