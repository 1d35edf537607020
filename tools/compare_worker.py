"""Builds designs with the gearcam on the path of Python, by its public interface only.

It reads lines of JSON from stdin, ``{"file": ..., "out": ...}``, and answers each with one line:
outcome, findings and CPU time. ``compare.py`` runs one for each side.
"""

from __future__ import annotations

import faulthandler
import inspect
import json
import resource
import signal
import sys
import time
from pathlib import Path
from types import FrameType
from typing import Any, Final

import gearcam

MEMORY: Final = 6 << 30
"""Memory allowed for a design, bytes, so that none exhausts the machine."""

STUCK: Final = 15.0
"""Limit of the elapsed time as a multiple of the CPU time: a library that is stuck lets no signal
reach Python, so the process is ended."""

_FINDING: Final = ("code", "severity", "value", "limit", "unit", "message")
_REFUSAL: Final = ("what", "value", "limit", "unit", "nearest")
_PROBLEM: Final = ("message", "allowed", "hint")


class OutOfTimeError(BaseException):
    """A design exceeds its time; not an ``Exception``, so that no handler catches it."""


def _stop(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
    raise OutOfTimeError


def build(file: str, out: str) -> dict[str, Any]:
    """Build and write a design, and its meshing study if it has one; return the outcome."""
    told: dict[str, Any] = {"end": "built"}
    try:
        result: Any = gearcam.build(gearcam.load(file))
        told["findings"] = [_finding(one) for one in result.write(out).findings]
        if "\n[meshing]\n" in Path(file).read_text(encoding="utf-8"):
            told["findings"] = [_finding(one) for one in _meshed(result, out).findings]
    except OutOfTimeError:
        told["end"] = "out of time"
    except Exception as error:
        told |= {"end": type(error).__name__, "text": str(error), "refusal": _refusal(error)}
    return told


def _meshed(result: Any, out: str) -> Any:
    """Run and write the meshing study, with the interface of older versions too."""
    if "directory" in inspect.signature(result.mesh).parameters:
        return result.mesh(out)
    return result.mesh().write(out)


def _finding(found: Any) -> dict[str, Any]:
    return {**_taken(found, _FINDING), "where": _where(found)}


def _where(found: Any) -> str:
    return getattr(found, "where", None) or getattr(found, "place", None) or ""


def _refusal(error: Exception) -> list[dict[str, Any]]:
    """Return an error as a list: one entry, or one for each problem of a design file."""
    problems = getattr(error, "problems", None)
    if problems is None:
        return [{**_taken(error, _REFUSAL), "where": _where(error)}]
    return [{**_taken(one, _PROBLEM), "where": one.key, "line": one.line} for one in problems]


def _taken(owner: Any, names: tuple[str, ...]) -> dict[str, Any]:
    found = {name: getattr(owner, name, None) for name in names}
    return {name: value for name, value in found.items() if value not in (None, "")}


def main() -> None:
    """Build the designs from stdin, each within the CPU time given as argument."""
    limit = float(sys.argv[1])
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    signal.signal(signal.SIGPROF, _stop)
    print(json.dumps({"end": "ready", "gearcam": str(gearcam.__file__)}), flush=True)
    for line in sys.stdin:
        start = time.process_time()
        try:
            # repeated each second, since an exception may be lost inside a callback
            signal.setitimer(signal.ITIMER_PROF, limit, 1.0)
            faulthandler.dump_traceback_later(STUCK * limit, exit=True)
            told: dict[str, Any] = build(**json.loads(line))
            signal.setitimer(signal.ITIMER_PROF, 0.0)
        except OutOfTimeError:
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            told = {"end": "out of time"}
        faulthandler.cancel_dump_traceback_later()
        told["seconds"] = time.process_time() - start
        print(json.dumps(told, default=float), flush=True)


if __name__ == "__main__":
    main()
