"""Trials in processes of their own, each with so much time and memory; whoever dies is replaced.

Time is that of the processor where the system counts it for a process, so that a busy machine
makes no failures; by the clock a process has a few times more, and elsewhere just as much.
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

from gearcam.console import quieten
from gearcam.fuzz.outcome import FAILED, LATE, Failure, Outcome, Task

SECONDS: Final = 30.0
"""Processor time of a trial."""

MEMORY: Final = 4 << 30
"""Bytes that a process may take: a design that would take all must not end other programs."""

_COUNTED: Final = hasattr(signal, "setitimer")
"""Whether the system ends a process that has had its time."""

_CLOCK: Final = 5.0 if _COUNTED else 1.0
"""Time by the clock after which a process is ended, in processor times."""


Work = Callable[[Task, Path], Outcome]
"""What processes do: try a design in an empty folder."""


def _serve(channel: connection.Connection, work: Work, seconds: float, folder: Path) -> None:
    """Answer tasks until there are no more; each has a folder within the given one."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    quieten()
    _limit_memory()
    with contextlib.suppress(EOFError, OSError):
        while True:
            task = channel.recv()
            channel.send(None)  # its time begins
            own = Path(tempfile.mkdtemp(dir=folder))
            if _COUNTED:
                signal.setitimer(signal.ITIMER_PROF, seconds)  # whose signal ends a process
            outcome = work(task, own)
            if _COUNTED:
                signal.setitimer(signal.ITIMER_PROF, 0.0)
            channel.send(outcome)
            shutil.rmtree(own, ignore_errors=True)


def _limit_memory() -> None:
    with contextlib.suppress(ImportError, ValueError, OSError):  # which not every system has
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


class _Worker:
    """A process, and the number of the task that it has."""

    def __init__(self, work: Work, seconds: float, folder: Path) -> None:
        context = multiprocessing.get_context("spawn")
        self.channel, theirs = context.Pipe()
        self.process = context.Process(
            target=_serve, args=(theirs, work, seconds, folder), daemon=True
        )
        self.process.start()
        theirs.close()  # so that its death is heard
        self.seconds = seconds
        self.number: int | None = None
        self.until = math.inf

    def give(self, number: int, task: Task) -> None:
        self.number = number
        with contextlib.suppress(OSError):  # its death is told when it is asked
            self.channel.send(task)

    def answer(self) -> Outcome | None:
        """Return how its task ended, by its death too; None where it has only begun."""
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
    """Processes that try designs.

    Parameters
    ----------
    work : callable
        What they do; it pickles.
    processes : int
        How many.
    seconds : float, s
        Processor time that a trial may take.
    """

    def __init__(self, work: Work, processes: int, seconds: float = SECONDS) -> None:
        self.work, self.processes, self.seconds = work, processes, seconds
        self._workers: list[_Worker] = []
        # not within a process: one that is ended leaves its folder behind
        self._folder = tempfile.TemporaryDirectory(prefix="fuzz-", ignore_cleanup_errors=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for worker in self._workers:
            worker.end()
        self._workers.clear()
        self._folder.cleanup()

    def one(self, task: Task) -> Outcome:
        """Return how the trial of one `task` ended."""
        return next(outcome for _, outcome in self.each([(0, task)]))

    def each(self, tasks: Iterable[tuple[int, Task]]) -> Iterator[tuple[int, Outcome]]:
        """Yield how each trial ended, as they end.

        Parameters
        ----------
        tasks : iterable of (int, Task)
            Numbered.

        Yields
        ------
        int, Outcome
            The task's number, how it ended.
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
        """Give tasks to processes that have none; whether any has one then."""
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
        """Wait until a process says something, dies, or has had its time, and return all such."""
        soonest = min(one.until for one in self._workers)
        channels = [one.channel for one in self._workers if one.number is not None]
        wait = max(0.0, soonest - time.monotonic())
        heard = connection.wait(channels, None if math.isinf(wait) else wait)
        now = time.monotonic()
        return [one for one in self._workers if one.channel in heard or now > one.until]
