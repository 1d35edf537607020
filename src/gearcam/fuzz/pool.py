"""Trials in processes of their own, each with so much time and memory; whoever dies is replaced.

Time is that of the processor where the system counts it for a process, so that a busy machine
makes no hangs; by the clock a process has a few times more, and elsewhere just as much.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import signal
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from multiprocessing import connection
from pathlib import Path
from typing import Any, Final, Self

from gearcam.console import quieten
from gearcam.fuzz.outcome import FAILED, Failure, Outcome

SECONDS: Final = 30.0
"""Processor time of a trial."""

MEMORY: Final = 4 << 30
"""Bytes that a process may take: a design that would take all must not end other programs."""

_COUNTED: Final = hasattr(signal, "setitimer")
"""Whether the system ends a process that has had its time."""

_CLOCK: Final = 5.0 if _COUNTED else 1.0
"""Time by the clock after which a process is ended, in processor times."""


@dataclass(frozen=True, kw_only=True)
class Task:
    """A design that is to be tried: its `files`, and what is done beside building it.

    Parameters
    ----------
    files : mapping of str to str
        Texts by file name: the design file first.
    doubt, follow : bool
        See `gearcam.fuzz.trial.Trial`.
    """

    files: Mapping[str, str]
    doubt: bool = False
    follow: bool = False


def _serve(channel: connection.Connection, seconds: float) -> None:
    """Answer tasks until there are no more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    quieten()
    _limit_memory()
    from gearcam.fuzz.trial import Trial

    with contextlib.suppress(EOFError, OSError), tempfile.TemporaryDirectory() as folder:
        channel.send(None)
        for number in range(sys.maxsize):
            task = channel.recv()
            own = Path(folder) / str(number)
            own.mkdir()
            if _COUNTED:
                signal.setitimer(signal.ITIMER_PROF, seconds)  # whose signal ends a process
            outcome = Trial(task.files, own, doubt=task.doubt, follow=task.follow).run()
            if _COUNTED:
                signal.setitimer(signal.ITIMER_PROF, 0.0)
            channel.send(outcome)
            _empty(own)


def _empty(folder: Path) -> None:
    import shutil

    shutil.rmtree(folder, ignore_errors=True)


def _limit_memory() -> None:
    with contextlib.suppress(ImportError, ValueError, OSError):  # which not every system has
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


class _Worker:
    """A process, and the task that it has."""

    def __init__(self, seconds: float) -> None:
        context = multiprocessing.get_context("spawn")
        self.channel, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, seconds), daemon=True)
        self.process.start()
        theirs.close()
        self.ready = False
        self.number: int | None = None
        self.until = float("inf")

    def give(self, number: int, task: Task, seconds: float) -> None:
        self.number, self.until = number, time.monotonic() + _CLOCK * seconds
        with contextlib.suppress(OSError):  # told when its answer is taken
            self.channel.send(task)

    def taken(self) -> Outcome | None:
        """Return its answer, or how it died; None where it has only said that it is ready."""
        try:
            outcome = self.channel.recv()
        except (EOFError, OSError):
            self.process.join()
            outcome = _death(self.process.exitcode)
        self.ready = True
        return outcome

    def end(self) -> None:
        self.process.kill()
        self.process.join()
        self.channel.close()


def _death(code: int | None) -> Outcome:
    if _COUNTED and code == -signal.SIGPROF:
        return _hang()
    words = f"the process ended with {code}"
    return Outcome(end=FAILED, failure=Failure(kind="crash", words=words, place=str(code)))


def _hang() -> Outcome:
    return Outcome(end=FAILED, failure=Failure(kind="hang", words="it took too long"))


class Pool:
    """Processes that try designs.

    Parameters
    ----------
    jobs : int
        How many.
    seconds : float, s
        Processor time that a trial may take.
    """

    def __init__(self, jobs: int, seconds: float = SECONDS) -> None:
        self.jobs, self.seconds = jobs, seconds
        self._workers: list[_Worker] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for worker in self._workers:
            worker.end()
        self._workers.clear()

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
        following: Any = next(waiting, None)
        while following is not None or any(one.number is not None for one in self._workers):
            while len(self._workers) < self.jobs and following is not None:
                self._workers.append(_Worker(self.seconds))
            for worker in self._workers:
                if worker.ready and worker.number is None and following is not None:
                    worker.give(*following, self.seconds)
                    following = next(waiting, None)
            for worker in self._heard():
                number, outcome = worker.number, worker.taken()
                if outcome is not None:
                    if not worker.process.is_alive():
                        self._end(worker)
                    if number is None:
                        raise RuntimeError("a process that tries designs does not start")
                    worker.number, worker.until = None, float("inf")
                    yield number, outcome
            for worker in [one for one in self._workers if time.monotonic() > one.until]:
                number = worker.number
                self._end(worker)
                if number is not None:
                    yield number, _hang()

    def _heard(self) -> list[_Worker]:
        """Return the processes that have said something or died, after a while at most."""
        soonest = min((one.until for one in self._workers), default=float("inf"))
        wait = max(0.0, min(1.0, soonest - time.monotonic()))
        found = connection.wait([one.channel for one in self._workers], wait)
        return [one for one in self._workers if one.channel in found]

    def _end(self, worker: _Worker) -> None:
        worker.end()
        self._workers.remove(worker)
