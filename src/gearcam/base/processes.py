"""A function of many items, in other processes.

Each process makes what the items have in common once, so that only items and answers are sent.
Answers come in the order of the items. Processes end with the one that started them, and do not see
its interruptions: it ends them.

Refused: a function or something common that cannot be sent, and scripts that start processes while
the processes read them: what such a script does has to stand under ``if __name__ == "__main__":``.
"""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor
from multiprocessing import current_process, get_context
from typing import Any, Final, TypeVar

from gearcam.base.errors import DesignError
from gearcam.base.interrupts import follow_parent

Item = TypeVar("Item")
Answer = TypeVar("Answer")
Common = TypeVar("Common")

_LOT: Final = 16
"""Largest number of items that are sent together: few, so that an interruption waits for few."""

_EACH: Final = 4
"""Lots of each process, at least."""

UNGUARDED: Final = 'a script, in a file, that starts processes under `if __name__ == "__main__":`'
"""What scripts have to look like that start processes."""


def end_if_unguarded() -> None:
    """End a process that reads the script of its parent, which starts processes in passing.

    The parent tells of it: each of its processes would print the same.

    Raises
    ------
    SystemExit
        In such a process.
    """
    if getattr(current_process(), "_inheriting", False):
        raise SystemExit(1)


def in_order(
    make: Callable[[Common], Callable[[Item], Answer]],
    common: Common,
    items: Sequence[Item],
    jobs: int,
) -> Iterator[Answer]:
    """Yield the answer for each item, in their order.

    Parameters
    ----------
    make : callable
        ``make(common)`` returns a function that answers an item; a function of a module.
    common : object
        What all items have in common.
    items : sequence
        The items.
    jobs : int
        Number of processes; 1 is this one.

    Yields
    ------
    object
        An answer.

    Raises
    ------
    DesignError
        If something cannot be sent, or the processes end.
    """
    jobs = min(jobs, len(items))
    if jobs <= 1:
        yield from map(make(common), items)
        return
    end_if_unguarded()
    size = max(1, min(_LOT, len(items) // (jobs * _EACH)))
    lots = (items[first : first + size] for first in range(0, len(items), size))
    context = get_context("spawn")  # threads of this process do not survive a fork
    task = _sent((make, common))
    pool = ProcessPoolExecutor(jobs, mp_context=context, initializer=_begin, initargs=(task,))
    try:
        waiting = list[Future[list[Answer]]]()
        for lot in lots:
            waiting.append(pool.submit(_answered, lot))
            if len(waiting) > _EACH * jobs:
                yield from waiting.pop(0).result()
        for one in waiting:
            yield from one.result()
    except BrokenExecutor as error:
        raise DesignError.of("the processes have ended", key="jobs", allowed=UNGUARDED) from error
    finally:
        pool.shutdown(cancel_futures=True)


def _sent(one: Any) -> bytes:
    try:
        return pickle.dumps(one)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        message = f"the design cannot be sent to other processes: {error}"
        allowed = "functions that are defined with def in a module, or jobs=1"
        raise DesignError.of(message, key="jobs", allowed=allowed) from error


_kept: Final[dict[str, Any]] = {}
"""Of this process: ``task``, pickled, and the ``function`` made of it."""


def _begin(task: bytes) -> None:
    follow_parent()
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # read when numpy is imported
    _kept["task"] = task


def _answered(lot: Sequence[Any]) -> list[Any]:
    """Return the answers for some items, in a process."""
    if "function" not in _kept:
        make, common = pickle.loads(_kept["task"])
        _kept["function"] = make(common)
    return [_kept["function"](one) for one in lot]
