"""Writing the files of a build, all or none.

The folder is created if it is missing, and locked: a second build waits. All files are first
written into a temporary folder in it; then old files are moved there and new ones into place, the
summary last. If a move fails, all are undone; an interruption waits until the end. Files that the
*previous summary* lists and the new one does not are *outdated* and removed, so that nobody cuts
one. A design file is its user's, who may have edited it: none is removed, and one with another
content gets a new name before it is replaced. Temporary folders of writers that were killed are
removed by the next writer. Files are not forced to the disk (fsync, which would double the time of
writing, 40 ms for eleven files), so a power failure may lose them.

A user's design file is *rewritten* in the same way, and keeps its permissions; links are followed.

Refused: names with a path, impossible names, a folder that is a file or a broken link, a design's
folder that is a link, waiting too long for another writer, and whatever the system refuses.

Depends on errors, interrupts, numerals and reading only.
"""

from __future__ import annotations

import errno
import json
import os
import re
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from typing import Any, Final

from gearcam.base.errors import WriteError
from gearcam.base.interrupts import unbroken
from gearcam.base.numerals import formatted
from gearcam.base.reading import read

SUMMARY: Final = "summary.json"
"""The file that lists the others; replaced last."""

DESIGN: Final = ".toml"
"""End of the names of design files."""

_LARGEST: Final = 10_000_000
"""Largest size of a summary, bytes: a thousand times the usual size."""

_PREFIX: Final = ".gearcam-"
_SUFFIX: Final = ".tmp"
"""Beginning and end of the names of temporary folders."""

_LEFT_OVER: Final = re.compile(re.escape(_PREFIX) + r"[a-z0-9_]{8}" + re.escape(_SUFFIX))
"""Names of temporary folders, as `tempfile` makes them."""

_PATIENCE: Final = 30.0
"""Seconds to wait while another build writes to the folder: moving files takes a few."""

_PAUSE: Final = 0.05
"""Seconds between two tries to lock the folder."""

Make = Callable[[Mapping[str, str]], Mapping[str, bytes]]
"""Returns contents by name, given the `previous_files` of the folder."""


def write_all(
    directory: str | os.PathLike[str], make: Make, *, name: str = "", keep: bool = False
) -> tuple[str, ...]:
    """Write files into a folder, all or none, and remove outdated ones.

    Parameters
    ----------
    directory : path
        The folder; created if it does not exist.
    make : callable
        Returns plain file names and contents. ``summary.json`` among them lists the others.
    name : str
        Name of a folder in it for the files; it must not be a link.
    keep : bool
        Whether outdated files stay, as for a summary without a build.

    Returns
    -------
    tuple of str
        The outdated files that were removed.

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
            before = previous_files(folder)
            files = make(before)
            _fill(stage, folder, files)
            listed = _listed(files.get(SUMMARY, b""))
            stay = before if keep else {**files, **listed}
            outdated = [old for old in before if old not in stay]
            with unbroken():
                _move(stage, folder, files, outdated)
    except OSError as error:
        place = error.filename or folder
        raise WriteError(f"cannot write to {place}: {error.strerror or error}") from error
    return tuple(outdated)


def is_plain(name: str) -> bool:
    """Return whether a name is one of a file in the folder: no path, not hidden, not empty."""
    return bool(name) and not name.startswith(".") and not set(name) & set("/\\:\0")


def previous_files(folder: str | os.PathLike[str]) -> dict[str, str]:
    """Return the existing files that the summary in a folder lists, current and outdated.

    Parameters
    ----------
    folder : path
        A folder of an earlier build.

    Returns
    -------
    dict of str to str
        By plain name the hash of the design that a file was made from; without the summary itself
        and design files. Empty where there is no summary that can be read, or it is not one of
        gearcam's.
    """
    place = Path(folder)
    return {
        name: made
        for name, made in _listed(_summary(place)).items()
        if isinstance(made, str) and is_plain(name) and name != SUMMARY and _is_there(place / name)
        if not name.lower().endswith(DESIGN)
    }


def studied_files(folder: str | os.PathLike[str]) -> frozenset[str]:
    """Return the names in a folder's summary of what commands of studies have written."""
    content = _content(_summary(Path(folder)))
    names = content.get("studied")
    given = names if isinstance(names, list) else ()
    return frozenset(name for name in given if isinstance(name, str))


def _summary(folder: Path) -> bytes:
    """Return the summary in a folder; empty if there is none that can be read."""
    try:
        return read(folder / SUMMARY, _LARGEST)
    except OSError:
        return b""


def _content(summary: bytes) -> dict[str, Any]:
    """Return the content of a summary; empty if it is not one of gearcam's."""
    try:
        content = json.loads(summary)
    except (ValueError, RecursionError):
        return {}
    own = isinstance(content, dict) and isinstance(content.get("format"), int)
    return content if own else {}


def _listed(summary: bytes) -> dict[str, Any]:
    """Return the files that a summary lists, current and outdated."""
    content, found = _content(summary), dict[str, Any]()
    for key in ("files", "outdated"):
        listed = content.get(key)
        found |= listed if isinstance(listed, dict) else {}
    return found


def _is_there(place: Path) -> bool:
    """Return whether a listed name is a file or a link; False for impossible names."""
    try:
        return place.is_symlink() or place.is_file()
    except OSError:
        return False


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


def _fill(stage: Path, folder: Path, files: Mapping[str, bytes]) -> None:
    """Write all files into the temporary folder."""
    wrong = [name for name in files if not is_plain(name)]
    if wrong:
        raise ValueError(f"not plain file names: {wrong}")
    for name, content in files.items():
        target = folder / name
        if target.is_dir() and not target.is_symlink():
            raise IsADirectoryError(errno.EISDIR, "there is a folder of this name", str(target))
        with _naming(target):
            (stage / name).write_bytes(content)


def _move(stage: Path, folder: Path, files: Mapping[str, bytes], outdated: Sequence[str]) -> None:
    """Move outdated and old files away and new ones into place, or undo all if that fails."""
    old = stage / ".old"
    moves: list[tuple[Path, Path]] = []

    def move(source: Path, target: Path) -> None:
        moves.append((source, target))
        with _naming(folder / source.name):
            source.replace(target)

    try:
        old.mkdir()
        # if case does not matter, a outdated name may be that of a new file: outdated ones go first
        for name in (*outdated, *sorted(files, key=SUMMARY.__eq__)):
            if os.path.lexists(folder / name):
                kept = aside(folder / name, files[name]) if name in files else None
                move(folder / name, kept or old / name)
            if name in files:
                move(stage / name, folder / name)
    except BaseException:
        for source, target in reversed(moves):
            with suppress(OSError):
                target.replace(source)
        raise


def aside(path: Path, content: bytes) -> Path | None:
    """Return where an existing design file must go before it is replaced.

    Parameters
    ----------
    path : Path
        The file.
    content : bytes
        What takes its place.

    Returns
    -------
    Path or None
        None if it is no design file, is not there, or has this content.
    """
    if path.suffix.lower() != DESIGN or not path.exists() or path.read_bytes() == content:
        return None
    names = (path.with_stem(f"{path.stem}.{number}") for number in count(1))
    return next(name for name in names if not os.path.lexists(name))


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
