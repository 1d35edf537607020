"""Variants of a sweep that do not build anything, for other processes."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gearcam as gc
from gearcam.sweep.rows import Row

BASE = gc.load(Path(__file__).parent.parent / "profiles" / "ellipse.toml")


def odd(base: gc.Design, number: int, values: Mapping[str, Any]) -> Row:  # noqa: ARG001
    """Do what the value says; once only where it names a file that is made before."""
    deed, _, once = str(values["deed"]).partition(" ")
    if once:
        if Path(once).exists():
            return Row(number=number, values=values, facts={"pid": 0.0})
        Path(once).touch()
    if deed == "hang":
        time.sleep(1e3)
    if deed == "eat":
        try:
            bytearray(1 << 40)
        except MemoryError:
            return Row(number=number, values=values, refusal="too large")
    if deed == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    if deed == "print":
        print("a library says something")
    return Row(number=number, values=values, facts={"pid": float(os.getpid())})
