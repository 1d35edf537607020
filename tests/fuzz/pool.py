"""Trials in the processes of sweeps, within limits of time and memory."""

from __future__ import annotations

import pickle
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, Final, Self

from fuzz.outcome import FAILED, LATE, Failure, Outcome, Task
from gearcam.sweeps.pool import Crew
from gearcam.sweeps.rows import Built

SECONDS: Final = 90.0
"""Time allowed for a trial, s: far more than one takes, so that a busy machine is no failure."""

MEMORY: Final = 4 << 30
"""Memory allowed for a process, bytes: a design must not exhaust the machine."""

Work = Callable[[Task, Path], Outcome]
"""The work of a process: ``work(task, folder)`` tries a design in an empty folder."""


def _tried(work: Work, home: str, number: int, task: Task) -> tuple[int, Outcome]:
    """Return the number of a task and its outcome, in a folder of its own."""
    folder = Path(tempfile.mkdtemp(dir=home))
    try:
        return number, work(task, folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


class Pool:
    """Processes that try designs.

    Parameters
    ----------
    work : callable
        The work of each process; it must be picklable.
    processes : int
        Number of processes.
    seconds : float, s
        Time allowed for a trial.
    """

    def __init__(self, work: Work, processes: int, seconds: float = SECONDS) -> None:
        # owned by the parent: a process that is killed cannot clean up
        self._folder = tempfile.TemporaryDirectory(prefix="fuzz-", ignore_cleanup_errors=True)
        task = pickle.dumps((self._folder.name, partial(_tried, work)))
        self._crew = Crew(task, seconds, MEMORY, processes)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._crew.stop()
        self._folder.cleanup()

    def one(self, task: Task) -> Outcome:
        """Return the outcome of one `task`."""
        ((_, outcome),) = self.each([(0, task)])
        return outcome

    def each(self, tasks: Iterable[tuple[int, Task]]) -> Iterator[tuple[int, Outcome]]:
        """Yield the outcomes of tasks as they finish.

        Parameters
        ----------
        tasks : iterable of (int, Task)
            Numbered tasks.

        Yields
        ------
        int, Outcome
            Number of the task, and its outcome.
        """
        jobs: Any = tasks
        for row in self._crew.rows(jobs):
            yield (row.number, _lost(row)) if isinstance(row, Built) else row


def _lost(row: Built) -> Outcome:
    """Return the outcome of a task whose process has ended, or was ended after its time."""
    kind = LATE if row.time_s else "crash"
    return Outcome(end=FAILED, failure=Failure(kind=kind, words=row.refusal))
