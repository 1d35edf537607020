"""The engine of a cluster: the workers of a scheduler of dask.distributed.

A chunk of variants is one task. A worker builds it by a process for each of its threads, so that
limits of time and memory hold there too. Chunks of a worker that ends are built by others.
"""

from __future__ import annotations

import asyncio
import logging
import math
import pickle
import time
import warnings
from collections import Counter, deque
from collections.abc import Iterable, Iterator, Sized
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from itertools import islice
from typing import Any, Final

from gearcam.base.errors import DesignError, MissingExtraError
from gearcam.base.interrupts import unbroken
from gearcam.designs.design import Design
from gearcam.sweeps.engine import Build, Engine, Job
from gearcam.sweeps.rows import Built
from gearcam.sweeps.tasks import (
    LARGEST,
    LATELY,
    Order,
    build_chunk,
    chunk_size,
    demand_same,
    dismiss,
    identical,
    order_for,
    told_versions,
    versions_here,
)

_AHEAD: Final = 2
"""Chunks that wait or are built, for each thread of a worker."""

_ANSWER_S: Final = 5.0
"""Time in which a scheduler answers, s."""

_LOOK_S: Final = 2.0
"""Time between looks for workers that came or went, s."""

_LOGGERS: Final = ("distributed", "tornado", "asyncio")

_KILLS: Final = "its worker ended twice while it was built alone"


@dataclass(frozen=True, kw_only=True)
class Cluster(Engine):
    """The workers of a scheduler of dask (see `Engine`); each thread of a worker has a process.

    Parameters
    ----------
    address : str
        Of the scheduler, such as ``tcp://host:8786``.
    client : dask.distributed.Client, optional
        A client of the scheduler, which is used and left open, instead of its address.

    Raises
    ------
    DesignError
        If nothing answers at the address, other versions are there, or the client is one for
        asynchronous programs.
    MissingExtraError
        If dask is not installed.
    """

    address: str = ""
    client: Any = None

    def __post_init__(self) -> None:
        if getattr(self.client, "asynchronous", False):
            allowed = "a client made without asynchronous=True"
            raise DesignError.of("is for asynchronous programs", key="client", allowed=allowed)
        versions = (
            _answered(self.address)
            if self.client is None
            else self.client.get_versions(packages=["gearcam"])
        )
        there = {f"the worker {name}": known for name, known in versions["workers"].items()}
        there["the scheduler"] = versions["scheduler"]
        told = {name: told_versions(one["packages"]) for name, one in there.items()}
        key = "--scheduler" if self.client is None else "client"
        demand_same(versions_here(), told, key)

    @property
    def name(self) -> str:
        """In words."""
        return f"dask at {self._place}"

    @property
    def _place(self) -> str:
        return self.address or str(self.client.scheduler.address)

    @contextmanager
    def session(self, base: Design) -> Iterator[Build]:
        """Yield what builds variants (see `Engine.session`)."""
        order = order_for(base, self.measure, self.seconds, self.memory)
        given = nullcontext(self.client)
        with given if self.client is not None else _connected(self.address) as client:
            chunks = _Chunks(client, self._place, order)
            try:
                yield chunks.rows
            finally:
                with unbroken():
                    chunks.end()


class _Chunks:
    """Chunks of variants that are built by the workers of a cluster."""

    def __init__(self, client: Any, address: str, order: Order) -> None:
        from distributed import as_completed

        self._client, self._address = client, address
        self._token, self._jobs = order.token, iter(list[Job]())
        self._times = deque[float](maxlen=LATELY)
        self._order = client.submit(identical, order, pure=False)
        self._waiting: dict[Any, list[Job]] = {}
        self._done = as_completed(with_results=True, raise_errors=False, loop=client.loop)
        self._largest, self._threads, self._look = LARGEST, 1, 0.0
        self._suspects: deque[Job] = deque()
        self._alone: Any = None
        self._killed: Counter[int] = Counter()

    def rows(self, jobs: Iterable[Job]) -> Iterator[Built]:
        """Yield a row for each job; all workers build a part of a lot whose size is known."""
        self._count()
        if isinstance(jobs, Sized):
            self._largest = min(LARGEST, math.ceil(len(jobs) / self._threads))
        self._jobs = iter(jobs)
        self._fill()
        while self._waiting:
            future, result = next(self._done)
            chunk, alone = self._waiting.pop(future), future is self._alone
            if alone:
                self._alone = None
            if isinstance(result, bytes):  # its status may be another one since
                rows = pickle.loads(result)
                self._times.extend(row.time_s for row in rows)
            else:
                error = result[1] if isinstance(result, tuple) else result
                rows = self._failed(chunk, error, alone=alone)
            self._fill()
            yield from rows

    def end(self) -> None:
        """Cancel what is not built and end the processes of the workers."""
        with suppress(Exception):
            self._client.cancel([*self._waiting, self._order])
            self._client.sync(
                self._client.run,
                dismiss,
                self._token,
                on_error="ignore",
                callback_timeout=_ANSWER_S,
            )

    def _fill(self) -> None:
        """Submit as many chunks as the workers need; of suspects one, and nothing else with it."""
        self._count()
        if self._suspects and not self._waiting:
            self._alone = self._submit([self._suspects.popleft()])
        if self._suspects or self._alone is not None:
            return
        while len(self._waiting) < self._threads * _AHEAD:
            chunk = list(islice(self._jobs, chunk_size(self._times, self._largest)))
            if not chunk:
                break
            self._submit(chunk)

    def _count(self) -> None:
        """Count the threads of the workers, now and then."""
        now = time.monotonic()
        if now >= self._look:
            self._threads = max(1, sum(self._client.nthreads().values()))
            self._look = now + _LOOK_S

    def _submit(self, chunk: list[Job]) -> Any:
        future = self._client.submit(build_chunk, self._order, pickle.dumps(chunk), pure=False)
        self._waiting[future] = chunk
        self._done.add(future)
        return future

    def _failed(self, jobs: list[Job], error: BaseException, *, alone: bool) -> list[Built]:
        """Return the rows of a chunk that failed: of a variant that ended its worker twice.

        A worker that ends takes all that it has with it. So the variants of chunks with which
        workers end are built again one by one, with nothing else on any worker.
        """
        from distributed import CancelledError, KilledWorker

        if isinstance(error, CancelledError):
            raise _gone(self._address)
        if isinstance(error, ModuleNotFoundError):
            message = f"a worker has no module {error.name}"
            allowed = "gearcam, and the modules of a design's functions, on all workers"
            raise DesignError.of(message, key="--scheduler", allowed=allowed)
        if not isinstance(error, KilledWorker):
            raise error
        if not alone:
            self._suspects.extend(jobs)
            return []
        number, values = jobs[0]
        self._killed[number] += error.allowed_failures + 1
        if self._killed[number] < 2:
            self._suspects.append(jobs[0])
            return []
        return [Built(number=number, values=values, refusal=_KILLS)]


@contextmanager
def _connected(address: str) -> Iterator[Any]:
    """Yield a client of a scheduler that has answered, without what dask logs."""
    from distributed import Client

    with _silent():
        try:
            client = Client(address, timeout=_ANSWER_S, set_as_default=False)
        except OSError as error:
            raise _gone(address) from error
        try:
            yield client
        finally:
            with unbroken(), suppress(Exception):
                client.close(timeout=_ANSWER_S)


def _answered(address: str) -> dict[str, Any]:
    """Return the versions of packages of scheduler and workers.

    Raises
    ------
    DesignError
        If nothing answers.
    MissingExtraError
        If dask is not installed.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise MissingExtraError("clusters", "sweep") from error

    async def ask() -> dict[str, Any]:
        async with Client(
            address, asynchronous=True, timeout=_ANSWER_S, set_as_default=False
        ) as client:
            asked: Any = client.get_versions(packages=["gearcam"])
            return await asked

    with _silent():
        try:
            # dask waits for ever for what answers to nothing
            return asyncio.run(asyncio.wait_for(ask(), 1.5 * _ANSWER_S))
        except (ValueError, TypeError) as error:
            why = str(error)
        except Exception:
            why = "no scheduler of dask answers"
    allowed = (
        "the address of a running scheduler, such as tcp://HOST:8786 (`dask scheduler` starts one)"
    )
    raise DesignError.of(f"{address}: {why}", key="--scheduler", allowed=allowed)


def _gone(address: str) -> DesignError:
    message = f"{address}: the scheduler does not answer any more"
    allowed = "the same command, which goes on, when it runs again"
    return DesignError.of(message, key="--scheduler", allowed=allowed)


@contextmanager
def _silent() -> Iterator[None]:
    """Keep what dask logs and warns of from the terminal."""
    names = [name for name in logging.root.manager.loggerDict if name.split(".")[0] in _LOGGERS]
    loggers = [logging.getLogger(name) for name in names]
    before = [one.level for one in loggers]
    try:
        for one in loggers:
            one.setLevel(logging.CRITICAL + 1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        for one, level in zip(loggers, before, strict=True):
            one.setLevel(level)
