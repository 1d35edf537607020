"""Measurement of run times: all samples are kept, medians decide."""

from __future__ import annotations

import gc
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tools"))

from commit import ROOT, commit

_UNCOMPILED = "PYTHONDONTWRITEBYTECODE"
PACKAGES = (
    "gearcam", "numpy", "shapely", "ncgears", "pylinkage", "numba", "opentorsion", "exudyn",
    "scipy", "sympy",
)  # fmt: skip


@dataclass(frozen=True)
class Timing:
    """Run times of one case, s."""

    name: str
    samples: tuple[float, ...]

    @property
    def median(self) -> float:
        """The median of the samples."""
        return statistics.median(self.samples)

    def over(self, other: Timing) -> float:
        """Return the median ratio to the samples of another case, measured alternately."""
        pairs = zip(self.samples, other.samples, strict=True)
        return statistics.median(mine / theirs for mine, theirs in pairs)

    def line(self) -> str:
        """Return a row of a table: name, median, all samples."""
        raw = ", ".join(show(sample) for sample in self.samples)
        return f"| {self.name} | {show(self.median)} | {raw} |"


@dataclass(frozen=True)
class Result:
    """A target with the measured result, the text that shows it, and why it is not met."""

    title: str
    asked: str
    found: str
    passed: bool
    body: list[str] = field(default_factory=list)
    given_up: str = ""

    @property
    def verdict(self) -> str:
        """``pass``, ``not met`` with a known reason, or ``fail``."""
        return "pass" if self.passed else "not met" if self.given_up else "fail"


def show(seconds: float) -> str:
    """Return a time with a suitable unit."""
    if seconds < 1e-3:
        return f"{1e6 * seconds:.0f} us"
    return f"{1e3 * seconds:.2f} ms" if seconds < 1 else f"{seconds:.2f} s"


def measure(name: str, function: Callable[[], object], count: int, *, warm: bool = True) -> Timing:
    """Time `count` calls of a function, after one that is not timed."""
    if warm:
        function()
    samples = []
    for _ in range(count):
        start = time.perf_counter()
        function()
        samples.append(time.perf_counter() - start)
    return Timing(name, tuple(samples))


def in_turns(functions: dict[str, Callable[[], object]], count: int) -> list[Timing]:
    """Time `count` calls of each function, alternately, so that load affects all alike.

    Existing objects, most of them from other benchmarks, are exempt from garbage collection.
    """
    samples: dict[str, list[float]] = {name: [] for name in functions}
    for function in functions.values():
        function()
    gc.collect()
    gc.freeze()
    for _ in range(count):
        for name, function in functions.items():
            start = time.perf_counter()
            function()
            samples[name].append(time.perf_counter() - start)
    gc.unfreeze()
    return [Timing(name, tuple(values)) for name, values in samples.items()]


def commands(cases: dict[str, Sequence[str]], count: int) -> list[Timing]:
    """Time whole processes, alternately, so that load affects all alike.

    The first round is not timed: it compiles the modules, as an installation does. All have one
    thread of linear algebra, as the command itself: idle threads would slow the references down.
    """
    environment = {key: value for key, value in os.environ.items() if key != _UNCOMPILED}
    environment["OPENBLAS_NUM_THREADS"] = "1"
    samples: dict[str, list[float]] = {name: [] for name in cases}
    for round_number in range(count + 1):
        for name, command in cases.items():
            start = time.perf_counter()
            subprocess.run(command, cwd=ROOT, env=environment, check=True, capture_output=True)
            if round_number:
                samples[name].append(time.perf_counter() - start)
    return [Timing(name, tuple(values)) for name, values in samples.items()]


def table(timings: Sequence[Timing]) -> list[str]:
    """Return a table of timings with all samples."""
    return ["| case | median | samples |", "|---|---|---|", *(timing.line() for timing in timings)]


def environment(named: Sequence[str] = PACKAGES) -> list[str]:
    """Return machine, versions of packages, commit and date, as lines of a list."""
    packages = ", ".join(f"{name} {version(name)}" for name in named)
    system = f"{platform.system()} {platform.machine()}"
    return [
        f"- machine: {_processor()}, {os.cpu_count()} cores, {system}",
        f"- Python {sys.version.split()[0]}; {packages}",
        f"- commit {commit()}",
        f"- {datetime.now(UTC):%Y-%m-%d %H:%M} UTC",
    ]


def _processor() -> str:
    information = Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
