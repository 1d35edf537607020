"""The engine of a cluster: the workers of a scheduler of dask.distributed.

A chunk of variants is one task. A worker builds it by a process for each of its threads, so that
limits of time and memory hold there too. Chunks of a worker that ends are built by others.
"""

from __future__ import annotations

import asyncio
import logging
import math
import pickle
import sys
import threading
import time
import uuid
import warnings
from collections import Counter, deque
from collections.abc import Collection, Iterable, Iterator, Mapping, Sized
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from itertools import islice
from multiprocessing import current_process
from pathlib import Path
from socket import gethostname
from typing import Any, Final

from gearcam.base.errors import DesignError, MissingExtraError
from gearcam.base.interrupts import unbroken
from gearcam.designs.design import Design, design, document_of
from gearcam.designs.reader import find_tables
from gearcam.sweep.engine import Build, Engine, Job
from gearcam.sweep.pool import Crew
from gearcam.sweep.rows import Built

_CHUNK_S: Final = 1.0
"""Time that a chunk should take, s: a task costs the scheduler about a millisecond."""

_MOST: Final = 256
"""Largest number of variants in a chunk."""

_LATELY: Final = 100
"""Number of variants whose mean time decides how many are a chunk."""

_AHEAD: Final = 2
"""Chunks that wait or are built, for each thread of a worker."""

_ANSWER_S: Final = 5.0
"""Time in which a scheduler answers, s."""

_LOOK_S: Final = 2.0
"""Time between looks for workers that came or went, s."""

_SAME: Final = ("python", "gearcam", "dask", "distributed", "numpy")
"""What has the same version on all machines."""

_LOGGERS: Final = ("distributed", "tornado", "asyncio")

_KILLS: Final = "its worker ended twice while it was built alone"


@dataclass(frozen=True, kw_only=True)
class Cluster(Engine):
    """The workers of a scheduler of dask (see `Engine`); each thread of a worker has a process.

    Parameters
    ----------
    address : str
        Of the scheduler, such as ``tcp://host:8786``.

    Raises
    ------
    DesignError
        If nothing answers at the address, or other versions are there.
    MissingExtraError
        If dask is not installed.
    """

    address: str

    def __post_init__(self) -> None:
        versions = _answered(self.address)
        there = {f"the worker {name}": known for name, known in versions["workers"].items()}
        there["the scheduler"] = versions["scheduler"]
        _demand_same(_versions(), {name: _told(known["packages"]) for name, known in there.items()})

    @property
    def name(self) -> str:
        """In words."""
        return f"dask at {self.address}"

    @contextmanager
    def session(self, base: Design) -> Iterator[Build]:
        """Yield what builds variants (see `Engine.session`)."""
        order = Order(
            token=uuid.uuid4().hex,
            task=pickle.dumps((_from_root(base), self.measure)),
            seconds=self.seconds,
            memory=self.memory,
            versions=_versions(),
        )
        with _connected(self.address) as client:
            chunks = _Chunks(client, self.address, order)
            try:
                yield chunks.rows
            finally:
                with unbroken():
                    chunks.end()


def _from_root(base: Design) -> Design:
    """Return a design that names CSV files from the root: workers run in other folders."""
    document = document_of(base)
    find_tables(document, Path.cwd())
    return design(document, base.source)


@dataclass(frozen=True, kw_only=True)
class Order:
    """What workers need to build variants of a sweep; each gets it once.

    Parameters
    ----------
    token : str
        Tells the sweep from others.
    task : bytes
        The design, and the function that makes the row of a variant, pickled.
    seconds : float, s
        Largest time of a variant.
    memory : int
        Largest memory of a process, bytes.
    versions : mapping of str to str
        Of Python and packages, where the sweep was started.
    """

    token: str
    task: bytes
    seconds: float
    memory: int
    versions: Mapping[str, str]


def identical(order: Order) -> Order:
    """Return an order: as the result of a task it is made again when its workers end."""
    return order


_crews: Final[dict[tuple[str, int], Crew]] = {}
"""Processes of this worker by sweep and thread."""

_lock: Final = threading.Lock()


def build_chunk(order: Order, chunk: bytes) -> bytes:
    """Return the rows of a chunk of variants, for a thread of a worker; both are pickled.

    Parameters
    ----------
    order : Order
        Of the sweep.
    chunk : bytes
        Numbers and values of variants.
    """
    key = order.token, threading.get_ident()
    with _lock:
        if key not in _crews:
            _demand_same(order.versions, {f"the worker at {gethostname()}": _versions()})
            # dask makes its workers daemons, which may have no processes; ours end with theirs
            current_process().daemon = False
            _crews[key] = Crew(order.task, order.seconds, order.memory)
        crew = _crews[key]
    return pickle.dumps(list(crew.rows(pickle.loads(chunk))))


def dismiss(token: str) -> None:
    """End the processes of a sweep on this worker."""
    with _lock:
        ended = [_crews.pop(key) for key in list(_crews) if key[0] == token]
    for crew in ended:
        crew.stop()


def chunk_size(times: Collection[float], most: int) -> int:
    """Return the number of variants of a chunk: one while nobody knows how long they take.

    Parameters
    ----------
    times : collection of float, s
        Of variants, of late.
    most : int
        Largest number.
    """
    taken = sum(times)
    return max(1, int(min(most, _CHUNK_S * len(times) / taken))) if taken > 0.0 else 1


class _Chunks:
    """Chunks of variants that are built by the workers of a cluster."""

    def __init__(self, client: Any, address: str, order: Order) -> None:
        from distributed import as_completed

        self._client, self._address = client, address
        self._token, self._jobs = order.token, iter(list[Job]())
        self._times = deque[float](maxlen=_LATELY)
        self._order = client.submit(identical, order, pure=False)
        self._waiting: dict[Any, list[Job]] = {}
        self._done = as_completed(with_results=True, raise_errors=False, loop=client.loop)
        self._largest, self._threads, self._look = _MOST, 1, 0.0
        self._suspects: deque[Job] = deque()
        self._alone: Any = None
        self._killed: Counter[int] = Counter()

    def rows(self, jobs: Iterable[Job]) -> Iterator[Built]:
        """Yield a row for each job; all workers build a part of a lot whose size is known."""
        self._count()
        if isinstance(jobs, Sized):
            self._largest = min(_MOST, math.ceil(len(jobs) / self._threads))
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


def _versions() -> dict[str, str]:
    """Return the versions of Python and packages here; empty for what is not installed."""
    versions = {"python": sys.version}
    for name in _SAME[1:]:
        with suppress(PackageNotFoundError):
            versions[name] = version(name)
    return _told(versions)


def _told(versions: Mapping[str, Any]) -> dict[str, str]:
    """Return the versions that have to be the same; of Python without its last number."""
    found = {name: str(versions.get(name) or "") for name in _SAME}
    return found | {"python": ".".join(found["python"].split(".")[:2])}


def _demand_same(here: Mapping[str, str], others: Mapping[str, Mapping[str, str]]) -> None:
    """Refuse machines whose versions differ.

    Parameters
    ----------
    here : mapping of str to str
        The versions of this process.
    others : mapping of str to mapping
        Those of others, by their names.
    """
    for whose, there in others.items():
        wrong = [
            f"{name} {there[name]} instead of {here[name]}" if there[name] else f"no {name}"
            for name in _SAME
            if there[name] != here[name]
        ]
        if wrong:
            wanted = ", ".join(f"{name} {one}" for name, one in here.items() if one)
            message = f"{whose} has {', '.join(wrong)}"
            allowed = f"the same on scheduler and workers: {wanted}"
            raise DesignError.of(message, key="--scheduler", allowed=allowed)


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
