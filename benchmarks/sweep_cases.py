"""Sweeps: the gain of a second worker, the overhead of engines, ten thousand pairs."""

from __future__ import annotations

import itertools
import os
import statistics
import tempfile
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import gearcam
from gearcam.designs.design import Design
from gearcam.sweeps.axes import axes_of
from gearcam.sweeps.cluster import Cluster
from gearcam.sweeps.engine import Engine, missing_rows
from gearcam.sweeps.log import Log
from gearcam.sweeps.plan import Plan
from gearcam.sweeps.pool import Processes
from gearcam.sweeps.rows import Built, measured
from gearcam.sweeps.tables import write_tables
from measuring import ROOT, Result, Timing, show, table

PAIR = ROOT / "profiles" / "ellipse.toml"
KEY = "law.eccentricity"
PAUSE_S = 0.02
"""Time of a design in measurements of overhead, s."""

PAIRS = 10_000
WORKERS = 64

_NOTE_GAIN = """\
Ellipses of the profile `ellipse.toml` with other eccentricities, {count} a run, from the start of
the processes to the last line of the log, in turns. Two processes of {cores} cores; at the same
time two loops of plain Python are {loops:.2f} times as fast as one of them."""
_NOTE_OVERHEAD = """\
Every design waits for 20 ms and gives the row of a real ellipse, which is written to the log. The
difference of runs of {short} and {long} designs by one worker, so that its start does not count."""
_NOTE_PAIRS = """\
Random eccentricities, two processes. Memory is the largest resident size until then: of the process
that writes, and of the larger of the two that build.

| rows | time | writes | builds |
|---|---|---|---|
{rows}

The log has {log:.0f} bytes a row, the table {csv:.0f}; the table is written in {tables}."""
_NOTE_MILLION = """\
A million on {workers} workers of a cluster, on paper: a design takes {design}, so the workers need
{build:.1f} min. Scheduler and the process that writes need {client} a row together, {write:.1f} min
in all, at the same time: {first} The log takes {log:.1f} GB, the table {csv:.1f} GB and
{tables:.1f} min; memory grows by {memory:.2f} GB. As workers are added, scheduler and writer limit
first, from {breaks:.0f} workers on."""


def of_sweeps() -> list[Result]:
    """(u), (v), (w) Two workers, overhead, ten thousand pairs."""
    shares, own = _overhead()
    return [_gain(), shares, _pairs(own)]


def _gain(count: int = 300, tries: int = 5) -> Result:
    """(u) Designs per second of two processes against one."""
    samples: dict[int, list[float]] = {1: [], 2: []}
    for _, jobs in itertools.product(range(tries), samples):
        samples[jobs].append(_timed(Processes(jobs=jobs), count))
    one, two = (Timing(f"{jobs} worker", tuple(found)) for jobs, found in samples.items())
    gain, loops = one.over(two), _loops()
    why = (
        f"two loops of plain Python, at the same time, are {loops:.2f} times as fast as one: the "
        "cores of this machine are not whole ones"
    )
    return Result(
        title="(u) A sweep by two workers against one",
        asked="at least 1.8 times the designs per second",
        found=f"{gain:.2f} times; {count / two.median:.0f} designs per second",
        passed=gain >= 1.8,
        body=[
            *table([one, two]),
            "",
            _NOTE_GAIN.format(count=count, cores=os.cpu_count(), loops=loops),
        ],
        given_up=why if gain < 1.8 and gain > 0.95 * loops else "",
    )


def _overhead(short: int = 100, long: int = 500, tries: int = 5) -> tuple[Result, float]:
    """(v) Overhead of each engine; and the time of scheduler and client for a row of dask, s."""
    samples: dict[str, list[float]] = {"processes": [], "dask": []}
    own = []
    with _local() as address:
        engines: dict[str, Engine] = {
            "processes": Processes(jobs=1, measure=waiting),
            "dask": Cluster(address=address, measure=waiting),
        }
        for _, (name, engine) in itertools.product(range(tries), engines.items()):
            begin = _timed(engine, short)
            samples[name].append((_timed(engine, long) - begin) / (long - short))
        quick = Cluster(address=address, measure=at_once)
        for _ in range(tries):
            before = time.process_time()
            _timed(quick, 10 * long)
            own.append((time.process_time() - before) / (10 * long))
    timings = [Timing(f"a design by {name}", tuple(found)) for name, found in samples.items()]
    by_processes, by_dask = (timing.median / PAUSE_S - 1.0 for timing in timings)
    result = Result(
        title="(v) Overhead of a sweep at 20 ms a design",
        asked="processes at most 3 %, dask at most 10 %",
        found=f"processes {100 * by_processes:.1f} %, dask {100 * by_dask:.1f} %",
        passed=by_processes <= 0.03 and by_dask <= 0.10,
        body=[*table(timings), "", _NOTE_OVERHEAD.format(short=short, long=long)],
    )
    return result, statistics.median(own)


def _pairs(own: float) -> Result:
    """(w) Ten thousand pairs; a million on paper."""
    plan = _plan(PAIRS)
    marks: list[_Mark] = []
    start = time.perf_counter()

    def progress(done: int, total: int) -> None:
        if done in (total // 2, total):
            marks.append(_Mark(done, time.perf_counter() - start, watched.own, watched.child))

    with tempfile.TemporaryDirectory() as folder, Log(folder, plan.head) as log:
        with _watched() as watched:
            for _ in missing_rows(plan, log, Processes(jobs=2)):
                progress(len(log), plan.count)
        begin = time.perf_counter()
        write_tables(log, Path(folder))
        tables = time.perf_counter() - begin
        design = statistics.mean(row.time_s for row in log.rows())
        log_size, csv_size = (
            (Path(folder) / name).stat().st_size / PAIRS for name in ("sweep.log", "sweep.csv")
        )
    early, late = marks
    growth = {"writes": late.own - early.own, "builds": late.child - early.child}
    rows = "\n".join(mark.line() for mark in marks)
    million = 1e6 / PAIRS
    build, write = 1e6 * design / WORKERS / 60.0, 1e6 * own / 60.0
    paper = _NOTE_MILLION.format(
        workers=WORKERS,
        design=show(design),
        build=build,
        client=show(own),
        write=write,
        first="they keep up." if write < build else "the workers wait for them.",
        log=1e6 * log_size / 1e9,
        csv=1e6 * csv_size / 1e9,
        tables=million * tables / 60.0,
        memory=million / 0.5 * growth["writes"] / 1024.0,
        breaks=design / own,
    )
    return Result(
        title="(w) Ten thousand pairs in one sweep",
        asked="memory flat: from row 5000 on at most 5 MB more, in each process",
        found=f"{PAIRS / late.time:.0f} designs per second, "
        + ", ".join(f"{grown:+.1f} MB where it {what}" for what, grown in growth.items()),
        passed=max(growth.values()) <= 5.0,
        body=[
            _NOTE_PAIRS.format(rows=rows, log=log_size, csv=csv_size, tables=show(tables)),
            "",
            paper,
        ],
    )


def waiting(base: Design, number: int, values: Mapping[str, Any]) -> Built:
    """Return a row after a while; a function for workers."""
    row = at_once(base, number, values)
    time.sleep(PAUSE_S)
    return replace(row, time_s=PAUSE_S)


def at_once(base: Design, number: int, values: Mapping[str, Any]) -> Built:
    """Return a real row, of another design; a function for workers."""
    if not _sample:
        _sample.append(measured(base, number, values))
    return replace(_sample[0], number=number, values=values, time_s=1e-4)


_sample: list[Built] = []


@dataclass(frozen=True)
class _Mark:
    """State of a sweep: rows, time in s, memory in MB."""

    rows: int
    time: float
    own: float
    child: float

    def line(self) -> str:
        return f"| {self.rows} | {show(self.time)} | {self.own:.1f} MB | {self.child:.1f} MB |"


@dataclass
class _Watched:
    """Largest resident memory so far of this process and of a child of it, MB."""

    own: float = 0.0
    child: float = 0.0

    def look(self) -> None:
        self.own = max(self.own, _resident(os.getpid()))
        children = Path(f"/proc/{os.getpid()}/task").glob("*/children")
        for pid in {int(one) for path in children for one in path.read_text().split()}:
            self.child = max(self.child, _resident(pid))


@contextmanager
def _watched(every: float = 0.2) -> Iterator[_Watched]:
    """Look at the memory from time to time."""
    found, ended = _Watched(), threading.Event()

    def watch() -> None:
        while not ended.wait(every):
            found.look()

    thread = threading.Thread(target=watch, daemon=True)
    thread.start()
    try:
        yield found
    finally:
        ended.set()
        thread.join()


def _resident(pid: int) -> float:
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except (OSError, IndexError):
        return 0.0
    return pages * os.sysconf("SC_PAGE_SIZE") / 1024.0**2


def _plan(count: int) -> Plan:
    axes = axes_of({KEY: "0.05:0.55"})
    return Plan(base=gearcam.load(PAIR), axes=axes, sampling="random", samples=count)


def _timed(engine: Engine, count: int) -> float:
    """Return the time of a run with its log, s."""
    plan = _plan(count)
    with tempfile.TemporaryDirectory() as folder, Log(folder, plan.head) as log:
        start = time.perf_counter()
        for _ in missing_rows(plan, log, engine):
            pass
        return time.perf_counter() - start


@contextmanager
def _local() -> Iterator[str]:
    """Yield the address of a scheduler with one worker on this machine."""
    from distributed import LocalCluster

    with LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address=None, host="127.0.0.1"
    ) as made:
        yield made.scheduler_address


def _loops() -> float:
    """Return how much more plain Python two processes do at the same time than one."""
    import multiprocessing

    def timed(count: int) -> float:
        with multiprocessing.get_context("spawn").Pool(count) as pool:
            pool.map(_loop, [1] * count, chunksize=1)
            start = time.perf_counter()
            pool.map(_loop, [2_000_000] * 4, chunksize=1)
            return time.perf_counter() - start

    return statistics.median(timed(1) / timed(2) for _ in range(3))


def _loop(count: int) -> int:
    total = 0
    for k in range(count):
        total += k * k % 7
    return total
