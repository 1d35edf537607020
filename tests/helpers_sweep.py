"""Variants of a sweep that do not build anything, for other processes."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import gearcam as gc
from gearcam.sweeps.rows import Built

BASE = gc.load(Path(__file__).parent.parent / "profiles" / "ellipse.toml")


def odd(base: gc.Design, number: int, values: Mapping[str, Any]) -> Built:  # noqa: ARG001
    """Do what the value says; once only where it names a file that is made before."""
    deed, _, once = str(values["deed"]).partition(" ")
    if once:
        if Path(once).exists():
            return Built(number=number, values=values, facts={"pid": 0.0})
        Path(once).touch()
    if deed == "hang":
        time.sleep(1e3)
    if deed == "nap":
        time.sleep(0.1)
    if deed == "eat":
        try:
            bytearray(1 << 40)
        except MemoryError:
            return Built(number=number, values=values, refusal="too large")
    if deed == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    if deed == "end-worker":
        os.kill(os.getppid(), signal.SIGKILL)
        time.sleep(1e3)
    if deed == "print":
        print("a library says something")
    return Built(number=number, values=values, facts={"pid": float(os.getpid())})


@dataclass(frozen=True)
class Loads:
    """What another process that loads it does instead."""

    deed: Callable[[Any], Any]
    word: Any

    def __reduce__(self) -> tuple[Any, tuple[Any]]:
        return self.deed, (self.word,)

    def __call__(self, *_: Any) -> Any:
        raise AssertionError("it was loaded")


def wavy(phi: Any) -> Any:
    return 1.0 + 0.1 * np.cos(phi)
