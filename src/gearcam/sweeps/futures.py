"""The engine of an executor: whatever has ``submit`` and returns futures.

Such as `concurrent.futures.ProcessPoolExecutor`, the pools of loky and of mpi4py, or an executor of
one's own. Of it only ``submit(function, *arguments)`` is used, of a future ``add_done_callback``,
``result`` and ``cancel``: the interface of `concurrent.futures`. It is left open.

A chunk of variants is one task (see `gearcam.sweeps.tasks`).

Refused: executors that have ended, and tasks that fail, since rows would be missing.
"""

from __future__ import annotations

import math
import pickle
from collections import deque
from collections.abc import Iterable, Iterator, Sized
from concurrent.futures import CancelledError
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from queue import Empty, SimpleQueue
from typing import Any, Final

from gearcam.base.errors import DesignError
from gearcam.designs.design import Design
from gearcam.sweeps.engine import Build, Engine, Job
from gearcam.sweeps.rows import Built
from gearcam.sweeps.tasks import (
    LARGEST,
    LATELY,
    Order,
    build_chunk,
    chunk_size,
    dismiss,
    order_for,
)

_AHEAD: Final = 64
"""Chunks that wait or are built: nobody tells how many workers there are."""

_LOOK: Final = 0.5
"""Seconds after which a wait looks for interruptions."""


@dataclass(frozen=True, kw_only=True)
class Futures(Engine):
    """The workers of an executor (see `Engine`); each thread of a worker has a process.

    Parameters
    ----------
    executor : object
        With ``submit``.
    """

    executor: Any

    @property
    def name(self) -> str:
        """In words."""
        return f"the {type(self.executor).__name__} given"

    @contextmanager
    def session(self, base: Design) -> Iterator[Build]:
        """Yield what builds variants (see `Engine.session`)."""
        order = order_for(base, self.measure, self.seconds, self.memory)
        chunks = _Sent(self.executor, order)
        try:
            yield chunks.rows
        finally:
            chunks.end()
            dismiss(order.token)  # of threads of this process; others end by themselves


class _Sent:
    """Chunks that the workers of an executor build."""

    def __init__(self, executor: Any, order: Order) -> None:
        self._executor, self._order = executor, order
        self._done = SimpleQueue[Any]()
        self._waiting: dict[int, Any] = {}
        self._times = deque[float](maxlen=LATELY)

    def rows(self, jobs: Iterable[Job]) -> Iterator[Built]:
        """Yield a row for each job."""
        largest = LARGEST
        if isinstance(jobs, Sized):
            largest = min(LARGEST, math.ceil(len(jobs) / _AHEAD))
        source = iter(jobs)
        while True:
            while len(self._waiting) < _AHEAD:
                chunk = list(islice(source, chunk_size(self._times, largest)))
                if not chunk:
                    break
                self._submit(chunk)
            if not self._waiting:
                return
            rows = self._next()
            self._times.extend(row.time_s for row in rows)
            yield from rows

    def end(self) -> None:
        """Cancel what is not built."""
        for future in self._waiting.values():
            future.cancel()
        self._waiting.clear()

    def _submit(self, chunk: list[Job]) -> None:
        try:
            future = self._executor.submit(build_chunk, self._order, pickle.dumps(chunk))
        except RuntimeError as error:  # it has ended
            raise _failed(error) from error
        self._waiting[id(future)] = future
        future.add_done_callback(self._done.put)

    def _next(self) -> list[Built]:
        while True:
            try:
                future = self._done.get(timeout=_LOOK)
            except Empty:
                continue
            if self._waiting.pop(id(future), None) is not None:  # else of an earlier lot
                break
        try:
            return pickle.loads(future.result())
        except DesignError:
            raise
        except (Exception, CancelledError) as error:
            raise _failed(error) from error


def _failed(error: BaseException) -> DesignError:
    message = f"a task of the executor failed: {type(error).__name__}: {error}"
    allowed = "an executor whose workers have gearcam, and the modules of a design's functions"
    return DesignError.of(" ".join(message.split()), key="client", allowed=allowed)
