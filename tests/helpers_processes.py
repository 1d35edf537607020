"""Other processes: the environment that they need, and functions that they load from a module."""

from __future__ import annotations

import math
import os
import time
from pathlib import Path

from arch import rules
from fuzz.outcome import BUILT, FAILED, Failure, Outcome, Task
from fuzz.pool import MEMORY

ENVIRONMENT = {**os.environ, "PYTHONPATH": str(rules.SOURCE.parent)}
"""In which a process loads the sources beside these tests."""


def text_of(task: Task) -> str:
    return next(iter(task.files.values()))


def odd(task: Task, folder: Path) -> Outcome:
    """Do what the text of the design says."""
    assert not [*folder.iterdir()]
    text = text_of(task)
    while text == "run for ever":
        pass
    if text == "sleep":
        time.sleep(1e3)
    if text == "die":
        os._exit(7)
    if text == "eat":
        try:
            bytearray(2 * MEMORY)
        except MemoryError:
            return Outcome(end=FAILED, failure=Failure(kind="memory", words="none left"))
    return Outcome(end=BUILT, reason=text)


def dislikes_cycloids(task: Task, folder: Path) -> Outcome:  # noqa: ARG001
    """Fail at cycloidal rises, wherever they stand."""
    text = text_of(task)
    if '"cycloidal"' not in text:
        return Outcome(end=BUILT, seconds=1.0)
    words = f"no way\nwith {len(text)} letters\a"
    return Outcome(end=FAILED, failure=Failure(kind="crash", words=words, place="x"))


def late_at_first(task: Task, folder: Path) -> Outcome:  # noqa: ARG001
    """Take for ever, but only the first time in the folder of all trials."""
    mark = folder.parent / "tried"
    if not mark.exists():
        mark.touch()
        time.sleep(1e3)
    return Outcome(end=BUILT)


def swing(phi1: float) -> float:
    return phi1 - 0.6 * math.sin(phi1)


class Bent:
    """A function with a number that can be pickled."""

    def __init__(self, share: float) -> None:
        self.share = share

    def __call__(self, phi1: float) -> float:
        return phi1 - self.share * math.sin(phi1)
