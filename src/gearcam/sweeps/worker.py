"""A process that builds variants: it answers each job by a row.

Its first answer is `READY`, or the reason why it cannot begin. What a library prints goes to the
error stream. It ends with its parent, and when it has had no jobs for a while.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Final

from gearcam.base.interrupts import follow_parent

READY: Final = "ready"

_IDLE: Final = 60.0
"""Time without jobs after which the process ends, s."""


def main(link: Connection, task: bytes, memory: int) -> None:
    """Build variants until nobody wants any more.

    Parameters
    ----------
    link : Connection
        Jobs come by it, rows go by it.
    task : bytes
        The design, and the function that makes the row of a variant, pickled.
    memory : int
        Largest memory of the process, bytes.
    """
    follow_parent()
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # how a parent that exits ends its processes
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGTERM])
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # read when numpy is imported
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    from gearcam.console import quieten
    from gearcam.numeric.arrays import keep_freed_memory

    quieten()
    keep_freed_memory()
    _limit(memory)
    try:
        base, measure = pickle.loads(task)
    except Exception as error:  # such as a module that is not there
        link.send(f"{type(error).__name__}: {error}")
        return
    link.send(READY)
    with suppress(EOFError, OSError):
        while link.poll(_IDLE):
            link.send(measure(base, *link.recv()))


def _limit(memory: int) -> None:
    """Limit the memory of this process, where the system can."""
    with suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
