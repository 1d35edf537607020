"""The engine of this machine: processes of the standard library.

Each process is led by a thread, which waits for its rows.
"""

from __future__ import annotations

import os
import pickle
import queue
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Any, Final

from gearcam.designs.design import Design
from gearcam.sweep.child import MEMORY, SECONDS, Child
from gearcam.sweep.engine import CHUNK_S, Engine, Job, Pace
from gearcam.sweep.rows import Built, Measure, measured

_LOT: Final = 4
"""Jobs of a lot that one process takes at once: others wait for the end of the lot."""

_LOOK: Final = 0.5
"""Seconds after which a wait for rows looks for interruptions."""


@dataclass(frozen=True, kw_only=True)
class Processes(Engine):
    """Processes of this machine.

    Parameters
    ----------
    jobs : int
        Number of processes.
    seconds : float, s
        Largest time of a variant.
    memory : int
        Largest memory of a process, bytes.
    measure : callable
        ``measure(base, number, values)`` returns the row of a variant; a function of a module.
    """

    jobs: int
    seconds: float = SECONDS
    memory: int = MEMORY
    measure: Measure = measured

    @property
    def name(self) -> str:
        """In words."""
        return f"{self.jobs} process{'es' if self.jobs > 1 else ''}"

    def run(self, base: Design, jobs: Iterable[Job]) -> Iterator[Built]:
        """Yield the rows of variants (see `Engine.run`)."""
        task = pickle.dumps((base, self.measure))
        source = jobs if isinstance(jobs, _Lots) else _Source(iter(jobs))
        found: queue.SimpleQueue[Built | BaseException | None] = queue.SimpleQueue()
        leaders = [
            _Leader(source, found, Child(task, self.seconds, self.memory)) for _ in range(self.jobs)
        ]
        for one in leaders:
            one.thread.start()
        running = len(leaders)
        try:
            while running:
                with suppress(queue.Empty):
                    item = found.get(timeout=_LOOK)
                    if isinstance(item, BaseException):
                        raise item
                    if item is None:
                        running -= 1
                    else:
                        yield item
        finally:
            source.end()
            for one in leaders:
                one.stop()
            for one in leaders:
                one.thread.join()

    @contextmanager
    def session(self, base: Design) -> Iterator[Callable[[Sequence[Job]], Iterator[Built]]]:
        """Yield a function for several lots, built by the same processes (see `Engine`)."""
        lots = _Lots()
        rows = self.run(base, lots)

        def built(jobs: Sequence[Job]) -> Iterator[Built]:
            lots.put(jobs)
            for _ in jobs:
                yield next(rows)

        try:
            yield built
        finally:
            lots.end()
            rows.close()  # pyright: ignore


class _Lots(Iterable[Job]):
    """Jobs that come in lots; it is empty between them, and at its end."""

    def __init__(self) -> None:
        self._jobs: deque[Job] = deque()
        self._more, self._ended = threading.Condition(), False

    def __iter__(self) -> Iterator[Job]:
        while chunk := self.take(1):
            yield from chunk

    def put(self, jobs: Sequence[Job]) -> None:
        """Give jobs."""
        with self._more:
            self._jobs.extend(jobs)
            self._more.notify_all()

    def end(self) -> None:
        """Let nobody wait for more jobs."""
        with self._more:
            self._ended = True
            self._more.notify_all()

    def take(self, count: int) -> list[Job]:
        with self._more:
            self._more.wait_for(lambda: self._jobs or self._ended)
            return [self._jobs.popleft() for _ in range(min(count, _LOT, len(self._jobs)))]


class _Source:
    """Jobs for several threads."""

    def __init__(self, jobs: Iterator[Job]) -> None:
        self._jobs, self._lock = jobs, threading.Lock()

    def take(self, count: int) -> list[Job]:
        with self._lock:
            return [job for _, job in zip(range(count), self._jobs, strict=False)]

    def end(self) -> None:
        """Nobody waits for jobs."""


class _Leader:
    """A thread that leads a process."""

    def __init__(
        self,
        source: _Source | _Lots,
        found: queue.SimpleQueue[Built | BaseException | None],
        child: Child,
    ) -> None:
        self.thread = threading.Thread(target=self._lead, daemon=True)
        self._source, self._found, self._child = source, found, child

    def _lead(self) -> None:
        """Build variants until there are no more."""
        pace, child = Pace(), self._child
        try:
            while not child.stopped and (chunk := self._source.take(pace.chunk(CHUNK_S))):
                for row in child.rows(chunk):
                    pace.add(row.time_s)
                    self._found.put(row)
        except BaseException as error:
            if not child.stopped:
                self._found.put(error)
        finally:
            child.stop()
            self._found.put(None)

    def stop(self) -> None:
        """End the process at once."""
        self._child.stop()


def default_jobs() -> int:
    """Return the number of cores that this process may use."""
    count: Any = getattr(os, "sched_getaffinity", None)
    return len(count(0)) if count else os.cpu_count() or 1
