"""What a worker of another machine, or of an executor, does: it builds chunks of variants.

A *chunk* is one task. A worker builds it by a process for each of its threads, so that limits of
time and memory hold there too.

Refused: workers with another version of Python or of a package that rows depend on.
"""

from __future__ import annotations

import pickle
import sys
import threading
import uuid
from collections.abc import Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from multiprocessing import current_process
from pathlib import Path
from socket import gethostname
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError
from gearcam.designs.design import Design, design, document_of
from gearcam.designs.reader import find_tables
from gearcam.sweeps.pool import Crew
from gearcam.sweeps.rows import Measure

LARGEST: Final = 256
"""Largest number of variants in a chunk."""

LATELY: Final = 100
"""Number of variants whose mean time decides how many are a chunk."""

_CHUNK_S: Final = 1.0
"""Time that a chunk should take, s: a task costs a scheduler about a millisecond."""

_SAME: Final = ("python", "gearcam", "dask", "distributed", "numpy")
"""What has the same version on all machines."""


def from_root(base: Design) -> Design:
    """Return a design that names CSV files from the root: workers run in other folders."""
    document = document_of(base)
    find_tables(document, Path.cwd())
    return design(document, base.source)


@dataclass(frozen=True, kw_only=True)
class Order(ShortRepr):
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


def order_for(base: Design, measure: Measure, seconds: float, memory: int) -> Order:
    """Return the order of the variants of a design.

    Parameters
    ----------
    base : Design
        The design whose keys get other values.
    measure : callable
        Makes the row of a variant.
    seconds : float, s
        Largest time of a variant.
    memory : int
        Largest memory of a process, bytes.
    """
    return Order(
        token=uuid.uuid4().hex,
        task=pickle.dumps((from_root(base), measure)),
        seconds=seconds,
        memory=memory,
        versions=versions_here(),
    )


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
            demand_same(order.versions, {f"the worker at {gethostname()}": versions_here()})
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


def versions_here() -> dict[str, str]:
    """Return the versions of Python and packages here; empty for what is not installed."""
    versions = {"python": sys.version}
    for name in _SAME[1:]:
        with suppress(PackageNotFoundError):
            versions[name] = version(name)
    return told_versions(versions)


def told_versions(versions: Mapping[str, Any]) -> dict[str, str]:
    """Return the versions that have to be the same; of Python without its last number."""
    found = {name: str(versions.get(name) or "") for name in _SAME}
    return found | {"python": ".".join(found["python"].split(".")[:2])}


def demand_same(
    here: Mapping[str, str], others: Mapping[str, Mapping[str, str]], key: str = "--scheduler"
) -> None:
    """Refuse machines whose versions differ.

    Parameters
    ----------
    here : mapping of str to str
        The versions of this process.
    others : mapping of str to mapping
        Those of others, by their names.
    key : str
        What was given, for messages.
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
            raise DesignError.of(message, key=key, allowed=allowed)
