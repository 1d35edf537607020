"""Writing the files of a build, all or none.

The folder is created if it is missing, and locked: a second build waits. All files are first
written into a temporary folder in it; then old files are moved there and new ones into place, the
summary last. If a move fails, all are undone; an interruption waits until the end. Which old files
are removed, and which get another name, is decided elsewhere (`gearcam.export.listing`). Temporary
folders of writers that were killed are removed by the next writer. Files are not forced to the disk
(fsync, which would double the time of writing, 40 ms for eleven files), so a power failure may lose
them.

A user's design file is *rewritten* in the same way, and keeps its permissions; links are followed.

Refused: names with a path, impossible names, a folder that is a file or a broken link, a design's
folder that is a link, waiting too long for another writer, and whatever the system refuses.

Depends on errors, interrupts and numerals only.
"""

from __future__ import annotations

import errno
import os
import re
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Final

from gearcam.base.errors import WriteError
from gearcam.base.interrupts import unbroken
from gearcam.base.numerals import formatted

SUMMARY: Final = "summary.json"
"""The file that lists the others; replaced last."""

_PREFIX: Final = ".gearcam-"
_SUFFIX: Final = ".tmp"
"""Beginning and end of the names of temporary folders."""

_LEFT_OVER: Final = re.compile(re.escape(_PREFIX) + r"[a-z0-9_]{8}" + re.escape(_SUFFIX))
"""Names of temporary folders, as `tempfile` makes them."""

_PATIENCE: Final = 30.0
"""Seconds to wait while another build writes to the folder: moving files takes a few."""

_PAUSE: Final = 0.05
"""Seconds between two tries to lock the folder."""

Replace = Callable[..., None]
"""``replace(files, removed, renamed)`` replaces files of a folder, see `writing`."""


@contextmanager
def writing(directory: str | os.PathLike[str], name: str = "") -> Iterator[Replace]:
    """Lock a folder, so that its files can be looked at and then replaced, all or none.

    Parameters
    ----------
    directory : path
        The folder; created if it does not exist.
    name : str
        Name of a folder in it for the files; it must not be a link.

    Yields
    ------
    callable
        ``replace(files, removed=(), renamed={})``: contents by plain name; names of old files that
        are removed; new names, by those that they have, of old files that are replaced and kept.

    Raises
    ------
    WriteError
        If the folder or a file cannot be written. Nothing is changed then, as far as the system
        allows.
    ValueError
        If a name is not plain.
    """
    folder = Path(directory) / name
    _demand_possible(folder)
    if name and folder.is_symlink():
        words = "it is a link: remove it, or choose another folder"
        raise WriteError(f"cannot write to {folder}: {words}")
    try:
        with _stage(folder) as stage:
            yield partial(_replace, stage, folder)
    except OSError as error:
        place = error.filename or folder
        raise WriteError(f"cannot write to {place}: {error.strerror or error}") from error


def is_plain(name: str) -> bool:
    """Return whether a name is one of a file in the folder: no path, not hidden, not empty."""
    return bool(name) and not name.startswith(".") and not set(name) & set("/\\:\0")


def _demand_possible(path: str | os.PathLike[str]) -> None:
    """Refuse a path with a character that names cannot have or that the system cannot encode."""
    with suppress(ValueError):
        if b"\0" not in os.fsencode(path):
            return
    raise WriteError(f"cannot write to {os.fspath(path)!r}: this is not a possible name")


@contextmanager
def _stage(folder: Path) -> Iterator[Path]:
    """Create and lock a folder and yield a temporary folder in it, which is removed at the end.

    New folders are removed again if anything fails.
    """
    for place in (folder, *folder.parents):
        if place.is_symlink() and not place.exists():
            raise FileNotFoundError(errno.ENOENT, "it is a broken link", str(place))
    if folder.exists() and not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "it is a file, not a folder", str(folder))
    new = [place for place in (folder, *folder.parents) if not place.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with _lock(folder) as locked:
            for place in folder.iterdir() if locked else ():
                if _LEFT_OVER.fullmatch(place.name):
                    shutil.rmtree(place, ignore_errors=True)
            with _naming(folder):
                stage = Path(tempfile.mkdtemp(_SUFFIX, _PREFIX, folder))
            try:
                yield stage
            finally:
                with unbroken():
                    shutil.rmtree(stage, ignore_errors=True)
    except BaseException:
        for empty in new:
            with suppress(OSError):
                empty.rmdir()
        raise


@contextmanager
def _lock(folder: Path) -> Iterator[bool]:
    """Lock a folder, waiting until nobody else holds it; yield whether the system has locks."""
    try:
        import fcntl

        handle = os.open(folder, os.O_RDONLY)
    except (ImportError, PermissionError):  # Windows; folders that may be written but not read
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
                    words = f"another gearcam has been writing to it for {formatted(_PATIENCE)} s"
                    raise OSError(errno.EBUSY, words, str(folder)) from error
                time.sleep(_PAUSE)
            except OSError:  # a network file system may have no locks
                break
        yield locked
    finally:
        os.close(handle)


@contextmanager
def _naming(place: Path) -> Iterator[None]:
    """Make errors of the system name the file or folder that is written, not a temporary one."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(place)) from error


def _replace(
    stage: Path,
    folder: Path,
    files: Mapping[str, bytes],
    removed: Sequence[str] = (),
    renamed: Mapping[str, str] = MappingProxyType({}),
) -> None:
    """Replace the files of a folder; see `writing`."""
    wrong = [name for name in files if not is_plain(name)]
    if wrong:
        raise ValueError(f"not plain file names: {wrong}")
    for name, content in files.items():
        target = folder / name
        if target.is_dir() and not target.is_symlink():
            raise IsADirectoryError(errno.EISDIR, "there is a folder of this name", str(target))
        with _naming(target):
            (stage / name).write_bytes(content)
    with unbroken():
        _move(stage, folder, sorted(files, key=SUMMARY.__eq__), removed, renamed)


def _move(
    stage: Path,
    folder: Path,
    files: Sequence[str],
    removed: Sequence[str],
    renamed: Mapping[str, str],
) -> None:
    """Move old files away and new ones into place, or undo all if that fails."""
    old = stage / ".old"
    moves: list[tuple[Path, Path]] = []

    def move(source: Path, target: Path) -> None:
        moves.append((source, target))
        with _naming(folder / source.name):
            source.replace(target)

    try:
        old.mkdir()
        # if case does not matter, one that is removed may have the name of a new one: it goes first
        for name in (*removed, *files):
            if os.path.lexists(folder / name):
                move(folder / name, folder / renamed[name] if name in renamed else old / name)
            if name in files:
                move(stage / name, folder / name)
    except BaseException:
        for source, target in reversed(moves):
            with suppress(OSError):
                target.replace(source)
        raise


def write_new(path: str | os.PathLike[str], text: str) -> None:
    """Write a new file.

    Parameters
    ----------
    path : path
        Where.
    text : str
        Its content.

    Raises
    ------
    WriteError
        If it exists already, or cannot be written; nothing is left then.
    """
    _demand_possible(path)
    try:
        with unbroken(), Path(path).open("x", encoding="utf-8", newline="\n") as stream:
            try:
                stream.write(text)
                stream.flush()
            except OSError:
                with suppress(OSError):
                    Path(path).unlink()
                raise
    except FileExistsError as error:
        raise WriteError(f"{path}: exists already and is not overwritten") from error
    except OSError as error:
        raise WriteError(f"{path}: cannot be written: {error.strerror or error}") from error


def rewrite(file: str | os.PathLike[str], content: bytes) -> None:
    """Replace the content of an existing file.

    Parameters
    ----------
    file : path
        Its name.
    content : bytes
        The new content.

    Raises
    ------
    WriteError
        If it cannot be written; the file is unchanged then.
    """
    target = Path(file).resolve()
    try:
        with _stage(target.parent) as stage, unbroken():
            fresh = stage / target.name
            fresh.write_bytes(content)
            shutil.copymode(target, fresh)
            fresh.replace(target)
    except OSError as error:
        raise WriteError(f"cannot write to {file}: {error.strerror or error}") from error
