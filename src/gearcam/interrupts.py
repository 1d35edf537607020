"""Interrupts: signals that end the program, and stretches that they do not break.

Ctrl-C (SIGINT), SIGTERM and SIGHUP end the command in the same way: where it is, by
`KeyboardInterrupt`, so that whatever has been begun is taken back. What must not be left half done,
such as moving files into place, is *unbroken*: a signal that comes meanwhile counts after it.

Depends on nothing.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import Final

SIGNALS: Final = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
"""What ends the program: Ctrl-C, whoever asks it to, a terminal that is closed."""

_OWN: Final = (signal.SIG_DFL, signal.default_int_handler)
"""Handlers that nobody has chosen; others, such as that of ``nohup``, stay."""

_BASE: Final = 128
"""By the rule of shells an exit code is this and the signal's number."""


@dataclass
class Ended:
    """Which signal has ended the program.

    Parameters
    ----------
    number : int or None
        None where none has.
    """

    number: int | None = None

    def code(self, code: int) -> int:
        """Return the exit code: that of the signal, or `code`, which knows of Ctrl-C itself."""
        if self.number is None or self.number == signal.SIGINT:
            return code
        return _BASE + self.number


@contextmanager
def interruptible() -> Iterator[Ended]:
    """Let every signal that ends the program raise `KeyboardInterrupt`; yield which one did."""
    ended = Ended()

    def end(number: int, _: FrameType | None) -> None:
        ended.number = number
        raise KeyboardInterrupt

    before = {number: signal.getsignal(number) for number in SIGNALS} if _is_main() else {}
    before = {number: handler for number, handler in before.items() if handler in _OWN}
    try:
        for number in before:
            signal.signal(number, end)
        yield ended
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def unbroken() -> Iterator[None]:
    """Have signals that end the program wait until what is done within is done.

    Threads and processes that begin within answer none of them.

    Yields
    ------
    None
    """
    came: list[int] = []
    before = {number: signal.getsignal(number) for number in SIGNALS} if _is_main() else {}
    waiting = {number: one for number, one in before.items() if one not in (signal.SIG_IGN, None)}
    try:
        for number in waiting:  # one may come by another thread, which no mask keeps back
            signal.signal(number, lambda number, _: came.append(number))
        with _masked():
            yield
    finally:
        for number, handler in waiting.items():
            signal.signal(number, handler)
        for number in came:
            signal.raise_signal(number)


@contextmanager
def _masked() -> Iterator[None]:
    """Keep signals back from this thread, and from what it begins, where systems can."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _is_main() -> bool:
    """Return whether this is the thread that signals come to."""
    return threading.current_thread() is threading.main_thread()
