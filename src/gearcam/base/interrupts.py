"""Interrupts: signals that end the program, and blocks of code that they must not interrupt.

Ctrl-C (SIGINT), SIGTERM and SIGHUP raise `KeyboardInterrupt`, so that unfinished work is undone.
Steps that must not be left half done, such as moving files into place, run inside `unbroken`, which
delays signals until its end.

Depends on nothing.
"""

from __future__ import annotations

import os
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
"""Signals that end the program: Ctrl-C, a request to terminate, a closed terminal."""

_OWN: Final = (signal.SIG_DFL, signal.default_int_handler)
"""Default handlers; others, such as that of ``nohup``, are kept."""

_BASE: Final = 128
"""Exit code of shells for signal n: this plus n."""


@dataclass
class Ended:
    """The signal that has ended the program.

    Parameters
    ----------
    number : int or None
        Number of the signal; None for none.
    """

    number: int | None = None

    def code(self, code: int) -> int:
        """Return the exit code of the signal; `code` for Ctrl-C or no signal."""
        if self.number is None or self.number == signal.SIGINT:
            return code
        return _BASE + self.number


@contextmanager
def interruptible() -> Iterator[Ended]:
    """Make signals that end the program raise `KeyboardInterrupt`; yield which one came."""
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
    """Delay signals that end the program until the block has ended.

    Threads and processes started in the block ignore these signals.

    Yields
    ------
    None
    """
    came: list[int] = []
    before = {number: signal.getsignal(number) for number in SIGNALS} if _is_main() else {}
    waiting = {number: one for number, one in before.items() if one not in (signal.SIG_IGN, None)}
    try:
        for number in waiting:  # another thread, which the mask does not cover, may receive one
            signal.signal(number, lambda number, _: came.append(number))
        with _masked():
            yield
    finally:
        for number, handler in waiting.items():
            signal.signal(number, handler)
        for number in came:
            signal.raise_signal(number)


def follow_parent() -> None:
    """Make a process that was started by `multiprocessing` end with its parent.

    It ignores the signals that end the program: its parent, which gets them too, ends it.
    """
    from multiprocessing import connection, parent_process

    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    parent = parent_process()

    def end(sentinel: int) -> None:
        connection.wait([sentinel])
        os._exit(0)

    if parent is not None:
        threading.Thread(target=end, args=(parent.sentinel,), daemon=True).start()


@contextmanager
def _masked() -> Iterator[None]:
    """Block signals in this thread and its children, if the system supports it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _is_main() -> bool:
    """Return whether this is the main thread, which handles signals."""
    return threading.current_thread() is threading.main_thread()
