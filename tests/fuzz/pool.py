"""Trials in separate processes with limited time and memory; crashed processes are restarted.

Processor time is limited where the system counts it, so that a busy machine causes no failures; the
limit of elapsed time is then a few times larger, elsewhere the same.
"""

from __future__ import annotations

import contextlib
import itertools
import math
import multiprocessing
import shutil
import signal
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from multiprocessing import connection
from pathlib import Path
from typing import Final, Self

from fuzz.outcome import FAILED, LATE, Failure, Outcome, Task
from gearcam.console import quieten

SECONDS: Final = 30.0
"""Processor time allowed for a trial, s."""

MEMORY: Final = 4 << 30
"""Memory allowed for a process, bytes: a design must not exhaust the machine."""

_COUNTED: Final = hasattr(signal, "setitimer")
"""Whether the system can limit the processor time of a process."""

_CLOCK: Final = 5.0 if _COUNTED else 1.0
"""Limit of the elapsed time, as a multiple of the processor time."""


Work = Callable[[Task, Path], Outcome]
"""The work of a process: ``work(task, folder)`` tries a design in an empty folder."""


def _serve(channel: connection.Connection, work: Work, seconds: float, folder: Path) -> None:
    """Serve tasks until the channel is closed, each in its own subfolder."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    quieten()
    _limit_memory()
    with contextlib.suppress(EOFError, OSError):
        while True:
            task = channel.recv()
            channel.send(None)  # the timer of this task starts
            own = Path(tempfile.mkdtemp(dir=folder))
            if _COUNTED:
                signal.setitimer(signal.ITIMER_PROF, seconds)  # its signal kills the process
            outcome = work(task, own)
            if _COUNTED:
                signal.setitimer(signal.ITIMER_PROF, 0.0)
            channel.send(outcome)
            shutil.rmtree(own, ignore_errors=True)


def _limit_memory() -> None:
    with contextlib.suppress(ImportError, ValueError, OSError):  # not available on every system
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


class _Worker:
    """A process, and the number of its current task."""

    def __init__(self, work: Work, seconds: float, folder: Path) -> None:
        context = multiprocessing.get_context("spawn")
        self.channel, theirs = context.Pipe()
        self.process = context.Process(
            target=_serve, args=(theirs, work, seconds, folder), daemon=True
        )
        self.process.start()
        theirs.close()  # so that the end of the process closes the channel
        self.seconds = seconds
        self.number: int | None = None
        self.until = math.inf

    def give(self, number: int, task: Task) -> None:
        self.number = number
        with contextlib.suppress(OSError):  # answer() reports a dead process
            self.channel.send(task)

    def answer(self) -> Outcome | None:
        """Return the outcome of its task, a crash included; None if the task has just started."""
        outcome: Outcome | None = _TOO_LONG
        if self.channel.poll():
            try:
                outcome = self.channel.recv()
            except (EOFError, OSError):
                self.process.join()
                outcome = _death(self.process.exitcode)
        self.until = time.monotonic() + _CLOCK * self.seconds if outcome is None else math.inf
        return outcome

    def end(self) -> None:
        self.process.kill()
        self.process.join()
        self.channel.close()


_TOO_LONG: Final = Outcome(end=FAILED, failure=Failure(kind=LATE, words="it took too long"))


def _death(code: int | None) -> Outcome:
    if _COUNTED and code == -signal.SIGPROF:
        return _TOO_LONG
    words = f"the process ended with {code}"
    return Outcome(end=FAILED, failure=Failure(kind="crash", words=words, place=str(code)))


class Pool:
    """A pool of processes that try designs.

    Parameters
    ----------
    work : callable
        The work of each process; it must be picklable.
    processes : int
        Number of processes.
    seconds : float, s
        Processor time allowed for a trial.
    """

    def __init__(self, work: Work, processes: int, seconds: float = SECONDS) -> None:
        self.work, self.processes, self.seconds = work, processes, seconds
        self._workers: list[_Worker] = []
        # owned by the parent: a process that is killed cannot clean up
        self._folder = tempfile.TemporaryDirectory(prefix="fuzz-", ignore_cleanup_errors=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for worker in self._workers:
            worker.end()
        self._workers.clear()
        self._folder.cleanup()

    def one(self, task: Task) -> Outcome:
        """Return the outcome of one `task`."""
        return next(outcome for _, outcome in self.each([(0, task)]))

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
        waiting = iter(tasks)
        while self._give(waiting):
            for worker in self._heard():
                number, outcome = worker.number, worker.answer()
                if outcome is None or number is None:
                    continue
                worker.number = None
                if outcome is _TOO_LONG or worker.process.exitcode is not None:
                    worker.end()
                    self._workers.remove(worker)
                yield number, outcome

    def _give(self, waiting: Iterator[tuple[int, Task]]) -> bool:
        """Assign tasks to free processes; return whether any process has a task."""
        free = [one for one in self._workers if one.number is None]
        for number, task in itertools.islice(
            waiting, self.processes - len(self._workers) + len(free)
        ):
            if not free:
                free.append(_Worker(self.work, self.seconds, Path(self._folder.name)))
                self._workers.append(free[-1])
            free.pop().give(number, task)
        return any(one.number is not None for one in self._workers)

    def _heard(self) -> list[_Worker]:
        """Wait for processes that answer, end or exceed their time, and return them."""
        soonest = min(one.until for one in self._workers)
        channels = [one.channel for one in self._workers if one.number is not None]
        wait = max(0.0, soonest - time.monotonic())
        heard = connection.wait(channels, None if math.isinf(wait) else wait)
        now = time.monotonic()
        return [one for one in self._workers if one.channel in heard or now > one.until]
