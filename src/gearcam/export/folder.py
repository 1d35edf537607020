"""Output folders: created if missing, and locked for one writer at a time.

Everything is first written under a *spare* name. Such files of a writer that was killed are removed
by the next writer that locks the folder.

Refused: impossible names, a folder that is a file or a broken link, and waiting too long for
another writer.

Depends on errors and numerals only.
"""

from __future__ import annotations

import errno
import os
import re
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from gearcam.base.errors import WriteError
from gearcam.base.numerals import shown

_TEMPORARY: Final = ".gearcam-"
"""Beginning of temporary names."""

_LEFT_OVER: Final = re.compile(re.escape(_TEMPORARY) + r"[0-9a-f]{32}\.tmp")
"""A spare name."""

_PATIENCE: Final = 30.0
"""Seconds to wait while another build writes to the folder: moving files takes a few."""

_PAUSE: Final = 0.05
"""Seconds between two tries to lock the folder."""


def demand_name(path: str | os.PathLike[str]) -> None:
    """Refuse an impossible path.

    Parameters
    ----------
    path : path
        Of a file or a folder.

    Raises
    ------
    WriteError
        If it holds a character that is not allowed in names, or that the system cannot encode.
    """
    with suppress(ValueError):
        if b"\0" not in os.fsencode(path):
            return
    raise WriteError(f"cannot write to {os.fspath(path)!r}: this is not a possible name")


@contextmanager
def held(folder: Path) -> Iterator[None]:
    """Create and lock a folder; new folders are removed again if anything fails.

    Parameters
    ----------
    folder : Path
        Created with its parents.

    Yields
    ------
    None

    Raises
    ------
    FileNotFoundError, NotADirectoryError, OSError
        If a link is broken, if it is a file, or if another writer does not finish.
    """
    for place in (folder, *folder.parents):
        if place.is_symlink() and not place.exists():
            raise FileNotFoundError(errno.ENOENT, "it is a broken link", str(place))
    if folder.exists() and not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "it is a file, not a folder", str(folder))
    new = [place for place in (folder, *folder.parents) if not place.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with lock(folder) as alone:
            if alone:
                _sweep(folder)
            yield
    except BaseException:
        for empty in new:
            with suppress(OSError):
                empty.rmdir()
        raise


@contextmanager
def lock(folder: Path) -> Iterator[bool]:
    """Lock a folder, waiting until nobody else holds it.

    Parameters
    ----------
    folder : Path
        An existing one.

    Yields
    ------
    bool
        Whether it is locked: some systems and file systems have no locks.

    Raises
    ------
    OSError
        If another writer does not finish.
    """
    try:
        import fcntl

        handle = os.open(folder, os.O_RDONLY)
    except (
        ImportError,
        PermissionError,
    ):  # on Windows, and in folders that may be written but not read
        yield False
        return
    try:
        end, locked = time.monotonic() + _PATIENCE, False
        while not locked:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                locked = True
            except BlockingIOError as error:
                if time.monotonic() > end:
                    words = f"another gearcam has been writing to it for {shown(_PATIENCE)} s"
                    raise OSError(errno.EBUSY, words, str(folder)) from error
                time.sleep(_PAUSE)
            except OSError:  # a network file system may have no locks
                break
        yield locked
    finally:
        os.close(handle)


def _sweep(folder: Path) -> None:
    """Remove temporary files of writers that were killed."""
    for place in folder.iterdir():
        if _LEFT_OVER.fullmatch(place.name):
            with suppress(OSError):
                place.unlink()


def spare(folder: Path) -> Path:
    """Return a temporary name in a `folder`."""
    return folder / f"{_TEMPORARY}{os.urandom(16).hex()}.tmp"
