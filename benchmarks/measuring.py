"""Time and memory, measured plainly: every sample is kept, medians decide."""

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

ROOT = Path(__file__).resolve().parents[1]
_UNCOMPILED = "PYTHONDONTWRITEBYTECODE"
PACKAGES = ("gearcam", "numpy", "shapely", "ncgears", "scipy", "sympy")


@dataclass(frozen=True)
class Timing:
    """Samples of one thing, in seconds."""

    name: str
    samples: tuple[float, ...]

    @property
    def median(self) -> float:
        """The middle sample."""
        return statistics.median(self.samples)

    def over(self, other: Timing) -> float:
        """The middle of the ratios to samples of another that were taken in turns with these."""
        pairs = zip(self.samples, other.samples, strict=True)
        return statistics.median(mine / theirs for mine, theirs in pairs)

    def line(self) -> str:
        """One row of a table: name, median, all samples."""
        raw = ", ".join(show(sample) for sample in self.samples)
        return f"| {self.name} | {show(self.median)} | {raw} |"


@dataclass(frozen=True)
class Result:
    """One target: what was asked, what was found, the text that shows it, why it is given up."""

    title: str
    asked: str
    found: str
    passed: bool
    body: list[str] = field(default_factory=list)
    given_up: str = ""

    @property
    def verdict(self) -> str:
        """What became of it: one that is given up stays, with the reason measured."""
        return "pass" if self.passed else "given up" if self.given_up else "fail"


def show(seconds: float) -> str:
    """Seconds in a unit that fits."""
    if seconds < 1e-3:
        return f"{1e6 * seconds:.0f} us"
    return f"{1e3 * seconds:.2f} ms" if seconds < 1 else f"{seconds:.2f} s"


def measure(name: str, function: Callable[[], object], count: int, *, warm: bool = True) -> Timing:
    """Call a function `count` times, after one call that does not count."""
    if warm:
        function()
    samples = []
    for _ in range(count):
        start = time.perf_counter()
        function()
        samples.append(time.perf_counter() - start)
    return Timing(name, tuple(samples))


def in_turns(functions: dict[str, Callable[[], object]], count: int) -> list[Timing]:
    """Call functions `count` times, in turns: a busy moment hits them alike.

    Objects that were there before, most of them of other benchmarks, are not searched for garbage.
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
    """Whole processes, in turns: a busy moment hits them alike. The first round does not count.

    It leaves compiled modules behind, as an installed program has them.
    """
    environment = {key: value for key, value in os.environ.items() if key != _UNCOMPILED}
    samples: dict[str, list[float]] = {name: [] for name in cases}
    for round_number in range(count + 1):
        for name, command in cases.items():
            start = time.perf_counter()
            subprocess.run(command, cwd=ROOT, env=environment, check=True, capture_output=True)
            if round_number:
                samples[name].append(time.perf_counter() - start)
    return [Timing(name, tuple(values)) for name, values in samples.items()]


def table(timings: Sequence[Timing]) -> list[str]:
    """A table of timings with every sample."""
    return ["| what | median | samples |", "|---|---|---|", *(timing.line() for timing in timings)]


def environment(named: Sequence[str] = PACKAGES) -> list[str]:
    """What a reader needs to judge the numbers: machine, versions of packages, commit, date."""
    packages = ", ".join(f"{name} {version(name)}" for name in named)
    system = f"{platform.system()} {platform.machine()}"
    return [
        f"- machine: {_processor()}, {os.cpu_count()} cores, {system}",
        f"- Python {sys.version.split()[0]}; {packages}",
        f"- commit {_commit()}",
        f"- {datetime.now(UTC):%Y-%m-%d %H:%M} UTC",
    ]


def _processor() -> str:
    information = Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def _commit() -> str:
    def git(*arguments: str) -> str:
        done = subprocess.run(
            ["git", *arguments], cwd=ROOT, check=False, capture_output=True, text=True
        )
        return done.stdout.strip() if done.returncode == 0 else ""

    changed = " with changes not yet committed" if git("status", "--porcelain", "src") else ""
    return (git("rev-parse", "--short=12", "HEAD") or "none yet") + changed
