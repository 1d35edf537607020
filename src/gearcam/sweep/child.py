"""A process that builds variants, each within limits of time and memory.

A process that ends is replaced, and the variant that it had is built once more; a variant with
which it ends twice is refused. So is one that takes longer than its limit.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from gearcam.sweep.engine import Job
from gearcam.sweep.rows import Built
from gearcam.sweep.worker import READY, Briefing

SECONDS: Final = 300.0
"""Default limit of a variant's time, s."""

MEMORY: Final = 4 << 30
"""Default limit of a process's memory, bytes."""

_BEGIN: Final = (
    "import sys; sys.path.insert(0, sys.argv[1]); from gearcam.sweep.worker import main; main()"
)
"""What a process runs, given the folder of the package."""

_BEGINNING: Final = 60.0
"""Least limit of the time in which a process begins, s."""

_TWICE: Final = "its process ended twice while it was built"


class Child:
    """A process that builds variants; it lives from chunk to chunk.

    Parameters
    ----------
    task : bytes
        The design, and the function that makes the row of a variant, pickled.
    seconds : float, s
        Largest time of a variant.
    memory : int
        Largest memory of the process, bytes.
    """

    def __init__(self, task: bytes, seconds: float, memory: int) -> None:
        self._task, self._seconds, self._memory = task, seconds, memory
        self._process: subprocess.Popen[bytes] | None = None
        self._lock = threading.Lock()
        self._stopped = threading.Event()
        self._due: float | None = None
        self._late = False
        self._watcher = threading.Thread(target=self._watch, daemon=True)

    def stop(self) -> None:
        """End the process at once and for good."""
        self._stopped.set()
        self._end()
        if self._watcher.ident is not None:
            self._watcher.join()

    @property
    def stopped(self) -> bool:
        """Whether it was ended for good."""
        return self._stopped.is_set()

    def rows(self, chunk: Sequence[Job]) -> Iterator[Built]:
        """Yield a row for each job, whatever becomes of the process; fewer once it is stopped.

        Parameters
        ----------
        chunk : sequence of (int, dict)
            Numbers and values of variants.
        """
        left, again = deque(chunk), False
        while left and not self.stopped:
            process = self._running()
            with suppress(OSError):
                pickle.dump([left[0]] if again else list(left), process.stdin)  # pyright: ignore
                process.stdin.flush()  # pyright: ignore
            answered = 1 if again else len(left)
            for _ in range(answered):
                row = self._answer(process, self._seconds)
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
                again = False
                if not self.stopped:
                    yield Built(number=number, values=values, refusal=why, time_s=time_s)
            else:
                again = True
        if self.stopped:
            self._end()  # it may have been replaced meanwhile

    def _answer(self, process: subprocess.Popen[bytes], seconds: float) -> Any:
        """Return the next answer of a process; None if it ended, or was ended since it is late."""
        self._late = False
        self._due = time.monotonic() + seconds
        try:
            return pickle.load(process.stdout)  # pyright: ignore
        except (EOFError, OSError, pickle.UnpicklingError):
            return None
        finally:
            self._due = None

    def _watch(self) -> None:
        """End a process whose answer is late, and one that begins when it is stopped.

        A thread for each answer would cost more. While nothing is due, the next answer cannot be
        late before a whole limit has passed.
        """
        while not self.stopped:
            due, now = self._due, time.monotonic()
            if due is not None and due <= now:
                self._late, self._due = True, None
                self._kill()
            else:
                wait = self._seconds if due is None else due - now
                self._stopped.wait(min(wait, threading.TIMEOUT_MAX))
        self._kill()

    def _kill(self) -> None:
        process = self._process
        if process is not None:
            process.kill()

    def _running(self) -> subprocess.Popen[bytes]:
        """Return a process that waits for jobs."""
        with self._lock:
            if self._process is not None and self._process.poll() is not None:
                self._close(self._process)  # it ended since it had nothing to do for long
            if self._process is None:
                if self._watcher.ident is None:
                    self._watcher.start()
                self._process = self._begin()
                self._greet(self._process)
            return self._process

    def _begin(self) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, "-c", _BEGIN, str(Path(__file__).parents[2])],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
        )

    def _greet(self, process: subprocess.Popen[bytes]) -> None:
        """Give a process what it needs, and wait until it can have jobs."""
        path = [str(Path(one).absolute()) for one in sys.path]
        setup = Briefing(path=path, memory=self._memory, task=self._task)
        with suppress(OSError):
            pickle.dump(setup, process.stdin)  # pyright: ignore
            process.stdin.flush()  # pyright: ignore
        answer = self._answer(process, max(self._seconds, _BEGINNING))
        if answer != READY and not self.stopped:
            why = f": {answer}" if answer else ""
            raise RuntimeError(f"a process of the sweep cannot begin{why}")

    def _end(self) -> None:
        with self._lock:
            if self._process is not None:
                self._process.kill()
                self._close(self._process)

    def _close(self, process: subprocess.Popen[bytes]) -> None:
        for stream in (process.stdin, process.stdout):
            with suppress(OSError, ValueError):
                stream.close()  # pyright: ignore
        process.wait()
        self._process = None
