"""A process that builds variants: it reads jobs from its input and writes rows to its output.

Both are pickled. The first input is a `Briefing`, answered by `READY`; each further one is a list
of jobs, answered by a row each. What a library prints goes to the error stream. The process ends
with its input, whatever it does then, and when it has had no jobs for a while.
"""

from __future__ import annotations

import os
import pickle
import queue
import signal
import sys
import threading
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, BinaryIO, Final

from gearcam.base.interrupts import SIGNALS

READY = "ready"
"""First output: jobs may come. Otherwise it is the reason why they may not."""

_IDLE: Final = 60.0
"""Time without jobs after which the process ends, s."""


@dataclass(frozen=True, kw_only=True)
class Briefing:
    """What a worker needs before its first job.

    Parameters
    ----------
    path : list of str
        Folders of modules, which a design's functions may come from.
    memory : int
        Largest memory of the process, bytes.
    task : bytes
        The design, and the function that makes the row of a variant, pickled.
    """

    path: list[str]
    memory: int
    task: bytes


def main() -> None:
    """Build variants until the input ends."""
    for number in SIGNALS:  # the sweep ends its workers
        signal.signal(number, signal.SIG_IGN)
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    with suppress(BrokenPipeError, queue.Empty):
        _serve(sys.stdin.buffer, answers)
    os._exit(0)  # nothing is left to write


def _serve(jobs: BinaryIO, answers: BinaryIO) -> None:
    setup: Briefing = pickle.load(jobs)
    sys.path[:] = setup.path
    from gearcam.console import quieten
    from gearcam.numeric.arrays import keep_freed_memory

    quieten()
    keep_freed_memory()
    _limit(setup.memory)

    def answer(content: Any) -> None:
        pickle.dump(content, answers)
        answers.flush()

    try:
        base, measure = pickle.loads(setup.task)
    except Exception as error:  # such as a module that is not there
        answer(f"{type(error).__name__}: {error}")
        return
    answer(READY)
    chunks: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_feed, args=(jobs, chunks), daemon=True).start()
    while True:
        for number, values in chunks.get(timeout=_IDLE):
            answer(measure(base, number, values))


def _feed(jobs: BinaryIO, chunks: queue.SimpleQueue[Any]) -> None:
    """Read chunks; end the process with its input, also while it builds a variant."""
    try:
        while True:
            chunks.put(pickle.load(jobs))
    finally:
        os._exit(0)


def _limit(memory: int) -> None:
    """Limit the memory of this process, where the system can."""
    with suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
