"""The engine of this machine: processes that build variants within limits of time and memory.

A process that ends is replaced, and the variant that it had is built once more; a variant with
which it ends twice is refused. So is one that takes longer than its limit.
"""

from __future__ import annotations

import os
import pickle
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import wait
from typing import Any, Final

from gearcam.base.errors import DesignError
from gearcam.base.interrupts import unbroken
from gearcam.base.processes import UNGUARDED
from gearcam.designs.design import Design
from gearcam.sweeps.engine import Build, Engine, Job
from gearcam.sweeps.rows import Built
from gearcam.sweeps.worker import READY, main

_SPAWN: Final = get_context("spawn")  # threads of this process do not survive a fork

_BEGINNING: Final = 60.0
"""Least limit of the time in which a process begins, s."""

_LOOK: Final = 0.5
"""Seconds after which a wait for rows looks for interruptions."""

_MOST: Final = 60 if sys.platform == "win32" else sys.maxsize
"""Largest number of processes: Windows waits for 63 things at a time."""

_TWICE: Final = "its process ended twice while it was built"


@dataclass(frozen=True, kw_only=True)
class Processes(Engine):
    """Processes of this machine (see `Engine`).

    Parameters
    ----------
    jobs : int
        Number of processes.
    """

    jobs: int

    @property
    def name(self) -> str:
        """In words."""
        return f"{self.jobs} process{'es' if self.jobs > 1 else ''}"

    @contextmanager
    def session(self, base: Design) -> Iterator[Build]:
        """Yield what builds variants (see `Engine.session`)."""
        task = pickle.dumps((base, self.measure))
        crew = Crew(task, self.seconds, self.memory, min(self.jobs, _MOST))
        try:
            yield crew.rows
        finally:
            crew.stop()


class Crew:
    """Processes that build variants; they live from lot to lot.

    Parameters
    ----------
    task : bytes
        The design, and the function that makes the row of a variant, pickled.
    seconds : float, s
        Largest time of a variant.
    memory : int
        Largest memory of a process, bytes.
    count : int
        Number of processes.
    """

    def __init__(self, task: bytes, seconds: float, memory: int, count: int = 1) -> None:
        self._members = [_Process(task, seconds, memory) for _ in range(count)]

    def rows(self, jobs: Iterable[Job]) -> Iterator[Built]:
        """Yield a row for each job as it comes; not of those that are stopped.

        Parameters
        ----------
        jobs : iterable of (int, dict)
            Numbers and values of variants; read as they are needed.

        Raises
        ------
        DesignError
            If a process cannot begin.
        """
        source, rows = iter(jobs), list[Built | None]()
        while True:
            for one in self._members:
                if one.job is None and (job := next(source, None)) is not None:
                    one.build(job)
            yield from filter(None, rows)  # while the next ones are built
            busy: dict[Any, _Process] = {one.link: one for one in self._members if one.job}
            if not busy:
                return
            due = min(one.due for one in busy.values())
            ready = wait(busy, max(0.0, min(_LOOK, due - time.monotonic())))
            rows = [busy[link].answer() for link in ready]
            now = time.monotonic()
            rows += [one.lost(late=True) for one in busy.values() if one.job and one.due <= now]

    def stop(self) -> None:
        """End the processes at once and for good; any thread may."""
        for one in self._members:
            one.stop()


class _Process:
    """A process and the variant that it has; it begins with the first one."""

    def __init__(self, task: bytes, seconds: float, memory: int) -> None:
        self.link: Any = None
        self.job: Job | None = None
        self.due = 0.0
        self._given, self._seconds = (task, memory), seconds
        self._process: Any = None
        self._begun = self._again = self._stopped = False
        self._lock = threading.Lock()

    def build(self, job: Job, *, again: bool = False) -> None:
        """Let the process build a variant; nothing once it is stopped."""
        if self._process is not None and not self._process.is_alive():
            self._end()  # it had nothing to do for long
        if self._process is None:
            self._begin()
        if not self._stopped:
            self.job, self._again = job, again
            self.due = time.monotonic() + max(self._seconds, 0.0 if self._begun else _BEGINNING)
            with suppress(OSError):  # it has ended, which is its answer
                self.link.send(job)

    def answer(self) -> Built | None:
        """Return the row of its variant; None if it has begun, or begins again."""
        try:
            said = self.link.recv()
        except (EOFError, OSError, pickle.UnpicklingError):
            return self.lost()
        if self._begun:
            self.job = None
            return said
        if said != READY:
            return self.lost(f": {said}")
        self._begun, self.due = True, time.monotonic() + self._seconds
        return None

    def lost(self, why: str = "", *, late: bool = False) -> Built | None:
        """End the process; return the row of its variant, or None if that is built once more."""
        job, self.job = self.job, None
        self._end()
        if self._stopped or job is None:
            return None
        if not self._begun:
            message = f"a process of the sweep cannot begin{why}"
            allowed = "functions of modules that it can import" if why else UNGUARDED
            raise DesignError.of(message, allowed=allowed) from None
        if not late and not self._again:
            self.build(job, again=True)
            return None
        number, values = job
        if late:
            why, taken = f"it takes longer than {self._seconds:g} s", self._seconds
        else:
            why, taken = _TWICE, 0.0
        return Built(number=number, values=values, refusal=why, time_s=taken)

    def stop(self) -> None:
        """End the process for good."""
        with self._lock:
            self._stopped = True
            if self._process is not None:
                self._process.kill()
                self._process.join()

    def _begin(self) -> None:
        self.link, there = _SPAWN.Pipe()
        process = _SPAWN.Process(target=main, args=(there, *self._given), daemon=True)
        with self._lock, unbroken():
            if not self._stopped:
                self._begun = False
                process.start()
                self._process = process
        there.close()

    def _end(self) -> None:
        self._process.kill()
        self._process.join()
        self._process = None
        self.link.close()


def default_jobs() -> int:
    """Return the number of cores that this process may use."""
    count: Any = getattr(os, "sched_getaffinity", None)
    return len(count(0)) if count else os.cpu_count() or 1
