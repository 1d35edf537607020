"""The engine of this machine: processes of the standard library.

A variant has limits of time and memory. A process that ends is replaced, and the variant that it
had is built once more; a variant with which it ends twice is refused. So is one that takes longer
than its limit. Each process is led by a thread, which waits for its rows.
"""

from __future__ import annotations

import os
import pickle
import queue
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from gearcam.designs.design import Design
from gearcam.sweep.engine import Engine, Job, chunk_size
from gearcam.sweep.rows import Measure, Row, measured
from gearcam.sweep.worker import READY, Setup

SECONDS: Final = 300.0
"""Default limit of a variant's time, s."""

MEMORY: Final = 4 << 30
"""Default limit of a process's memory, bytes."""

_BEGIN: Final = (
    "import sys; sys.path.insert(0, sys.argv[1]); from gearcam.sweep.worker import main; main()"
)
"""What a process runs, given the folder of the package."""

_LOT: Final = 4
"""Jobs of a lot that one process takes at once: others wait for the end of the lot."""

_LOOK: Final = 0.5
"""Seconds after which a wait for rows looks for interruptions."""

_TWICE: Final = "its process ended twice while it was built"


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

    def run(self, base: Design, jobs: Iterable[Job]) -> Iterator[Row]:
        """Yield the rows of variants (see `Engine.run`)."""
        setup = pickle.dumps(
            Setup(
                path=[str(Path(one).absolute()) for one in sys.path],
                memory=self.memory,
                task=pickle.dumps((base, self.measure)),
            )
        )
        source = jobs if isinstance(jobs, _Lots) else _Source(iter(jobs))
        found: queue.SimpleQueue[Row | BaseException | None] = queue.SimpleQueue()
        leaders = [_Leader(source, found, setup, self.seconds) for _ in range(self.jobs)]
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
            for one in leaders:
                one.stop()
            for one in leaders:
                one.thread.join()

    @contextmanager
    def session(self, base: Design) -> Iterator[Callable[[Sequence[Job]], Iterator[Row]]]:
        """Yield a function for several lots, built by the same processes (see `Engine`)."""
        lots = _Lots()
        rows = self.run(base, lots)

        def built(jobs: Sequence[Job]) -> Iterator[Row]:
            lots.put(jobs)
            for _ in jobs:
                yield next(rows)

        try:
            yield built
        finally:
            lots.put(None)
            rows.close()  # pyright: ignore


class _Lots(Iterable[Job]):
    """Jobs that come in lots; it is empty between them, and at its end."""

    def __init__(self) -> None:
        self._jobs: deque[Job] = deque()
        self._more, self._ended = threading.Condition(), False

    def __iter__(self) -> Iterator[Job]:
        while chunk := self.take(1):
            yield from chunk

    def put(self, jobs: Sequence[Job] | None) -> None:
        """Give jobs; None: there are no more."""
        with self._more:
            self._jobs.extend(jobs or ())
            self._ended |= jobs is None
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


class _Leader:
    """A thread that leads a process."""

    def __init__(
        self,
        source: _Source | _Lots,
        found: queue.SimpleQueue[Row | BaseException | None],
        setup: bytes,
        seconds: float,
    ) -> None:
        self.thread = threading.Thread(target=self._lead, daemon=True)
        self._source, self._found = source, found
        self._setup, self._seconds = setup, seconds
        self._process: subprocess.Popen[bytes] | None = None
        self._lock = threading.Lock()
        self._stopped = False
        self._late = False

    def _lead(self) -> None:
        """Build variants until there are no more."""
        mean, count = 0.0, 0
        try:
            while not self._stopped and (chunk := self._source.take(chunk_size(mean))):
                for row in self._rows(chunk):
                    count += 1
                    mean += (row.time_s - mean) / min(count, 100)
                    self._found.put(row)
        except BaseException as error:
            if not self._stopped:
                self._found.put(error)
        finally:
            self._end()
            self._found.put(None)

    def stop(self) -> None:
        """End the process at once."""
        self._stopped = True
        self._end()

    def _rows(self, chunk: list[Job]) -> Iterator[Row]:
        """Yield a row for each job, whatever becomes of the process."""
        left, again = deque(chunk), False
        while left and not self._stopped:
            process = self._child()
            with suppress(OSError):
                pickle.dump([left[0]] if again else list(left), process.stdin)  # pyright: ignore
                process.stdin.flush()  # pyright: ignore
            answered = 1 if again else len(left)
            for _ in range(answered):
                row = self._answer(process)
                if row is None:
                    break
                left.popleft()
                again = False
                yield row
            else:
                continue
            self._end()
            if self._late or again:
                number, values = left.popleft()
                why = f"it takes longer than {self._seconds:g} s" if self._late else _TWICE
                time_s = self._seconds if self._late else 0.0
                again = self._late = False
                if not self._stopped:
                    yield Row(number=number, values=values, refusal=why, time_s=time_s)
            else:
                again = True

    def _answer(self, process: subprocess.Popen[bytes]) -> Any:
        """Return the next answer of a process; None if it ended, or was ended since it is late."""

        def end() -> None:
            self._late = True
            process.kill()

        clock = threading.Timer(self._seconds, end)
        clock.daemon = True
        clock.start()
        try:
            return pickle.load(process.stdout)  # pyright: ignore
        except (EOFError, OSError, pickle.UnpicklingError):
            return None
        finally:
            clock.cancel()

    def _child(self) -> subprocess.Popen[bytes]:
        with self._lock:
            if self._process is None:
                self._process = subprocess.Popen(
                    [sys.executable, "-c", _BEGIN, str(Path(__file__).parents[2])],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
                )
                with suppress(OSError):
                    self._process.stdin.write(self._setup)  # pyright: ignore
                    self._process.stdin.flush()  # pyright: ignore
                if self._answer(self._process) != READY and not self._stopped:
                    raise RuntimeError("a process of the sweep cannot begin")
            return self._process

    def _end(self) -> None:
        with self._lock:
            if self._process is not None:
                self._process.kill()
                for stream in (self._process.stdin, self._process.stdout):
                    with suppress(OSError, ValueError):
                        stream.close()  # pyright: ignore
                self._process.wait()
                self._process = None


def default_jobs() -> int:
    """Return the number of cores that this process may use."""
    count: Any = getattr(os, "sched_getaffinity", None)
    return len(count(0)) if count else os.cpu_count() or 1
