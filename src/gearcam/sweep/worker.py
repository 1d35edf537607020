"""A process that builds variants: it reads jobs from its input and writes rows to its output.

Both are pickled. The first input is a `Setup`, answered by `READY`; each further one is a list of
jobs, answered by a row each. What a library prints goes to the error stream. The process ends with
its input.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
from contextlib import suppress
from dataclasses import dataclass
from typing import BinaryIO

from gearcam.base.interrupts import SIGNALS

READY = "ready"
"""First output: jobs may come."""


@dataclass(frozen=True, kw_only=True)
class Setup:
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
    try:
        _serve(sys.stdin.buffer, answers)
    except (EOFError, BrokenPipeError):
        os._exit(0)  # nothing is left to write


def _serve(jobs: BinaryIO, answers: BinaryIO) -> None:
    setup: Setup = pickle.load(jobs)
    sys.path[:] = setup.path
    from gearcam.console import quieten
    from gearcam.numeric.arrays import keep_freed_memory

    quieten()
    keep_freed_memory()
    _limit(setup.memory)
    base, measure = pickle.loads(setup.task)
    pickle.dump(READY, answers)
    answers.flush()
    while True:
        for number, values in pickle.load(jobs):
            pickle.dump(measure(base, number, values), answers)
            answers.flush()


def _limit(memory: int) -> None:
    """Limit the memory of this process, where the system can."""
    with suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
