"""Writing the files of a build, all or none.

Every file is first written under a temporary name in the same folder. When all are complete they
are renamed; files that the *previous summary* lists and this build no longer writes are *stale* and
removed, so that nobody cuts one; the new summary comes last. The old files are kept until then and
restored if anything fails; an interruption waits until the end. The folder is locked meanwhile: a
second build waits. Files are not forced to the disk (fsync, which would double the time of writing,
40 ms for eleven files), so a power failure may lose them.

A user's design file is *rewritten* in the same way, and keeps its permissions; links are followed.

Refused: names with a path, a folder that is a file, a design's folder that is a link, and
whatever the system refuses.

Depends on folder, errors, interrupts and reading only.
"""

from __future__ import annotations

import errno
import json
import os
import shutil
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from gearcam.errors import WriteError
from gearcam.export.folder import demand_name, held, lock, spare
from gearcam.interrupts import unbroken
from gearcam.reading import read

SUMMARY: Final = "summary.json"
"""The file that lists the others; replaced last."""

_LARGEST: Final = 10_000_000
"""Largest size of a summary, bytes: a thousand times the usual size."""

Make = Callable[[Mapping[str, str]], Mapping[str, bytes]]
"""Returns contents by name, given the `previous_files` of the folder."""


def write_all(
    directory: str | os.PathLike[str], make: Make, *, name: str = "", keep: bool = False
) -> tuple[str, ...]:
    """Write files into a folder, all or none, and remove stale ones.

    Parameters
    ----------
    directory : path
        The folder; created if it does not exist.
    make : callable
        Returns plain file names and contents. ``summary.json`` among them lists the others.
    name : str
        Name of a folder in it for the files; it must not be a link.
    keep : bool
        Whether stale files stay, as for a summary without a build.

    Returns
    -------
    tuple of str
        The stale files that were removed.

    Raises
    ------
    WriteError
        If the folder or a file cannot be written. Nothing is changed then, as far as the system
        allows.
    ValueError
        If a name is not plain.
    """
    folder = Path(directory) / name
    demand_name(folder)
    try:
        if name:
            _demand_no_link(folder)
        return _write(folder, make, keep)
    except OSError as error:
        place = error.filename2 or error.filename or folder
        raise WriteError(f"cannot write to {place}: {error.strerror or error}") from error


def _demand_no_link(folder: Path) -> None:
    if folder.is_symlink():
        words = "it is a link: remove it, or choose another folder"
        raise OSError(errno.ELOOP, words, str(folder))


def _write(folder: Path, make: Make, keep: bool) -> tuple[str, ...]:
    change = _Change(folder)
    with held(folder):
        before = previous_files(folder)
        files = make(before)
        wrong = [name for name in files if not is_plain(name)]
        if wrong:
            raise ValueError(f"not plain file names: {wrong}")
        try:
            for name, content in files.items():
                change.stage(name, content)
        except BaseException:
            with unbroken():
                change.finish()
            raise
        with unbroken():
            change.commit([] if keep else [name for name in before if name not in files])
    return tuple(change.removed)


def is_plain(name: str) -> bool:
    """Return whether a name is one of a file in the folder: no path, not hidden, not empty."""
    return bool(name) and not name.startswith(".") and not set(name) & set("/\\:\0")


def previous_files(folder: str | os.PathLike[str]) -> dict[str, str]:
    """Return the existing files that the summary in a folder lists, current and stale.

    Parameters
    ----------
    folder : path
        A folder of an earlier build.

    Returns
    -------
    dict of str to str
        By plain name the hash of the design that a file was made from; without the summary itself.
        Empty where there is no summary that can be read, or it is not one of gearcam's.
    """
    place = Path(folder)
    try:
        content = json.loads(read(place / SUMMARY, _LARGEST))
    except (OSError, ValueError, RecursionError):
        return {}
    found: dict[str, Any] = {}
    own = isinstance(content, dict) and isinstance(content.get("format"), int)
    for key in ("files", "stale") if own else ():
        listed = content.get(key)
        found |= listed if isinstance(listed, dict) else {}
    return {
        name: made
        for name, made in found.items()
        if isinstance(made, str) and is_plain(name) and name != SUMMARY and _is_there(place / name)
    }


def _is_there(place: Path) -> bool:
    """Return whether a listed name is a file or a link; False for impossible names."""
    try:
        return place.is_symlink() or place.is_file()
    except OSError:
        return False


@dataclass
class _Change:
    """The changes of a folder so far, and how to undo them."""

    folder: Path
    staged: dict[str, Path] = field(default_factory=dict)
    kept: dict[str, Path] = field(default_factory=dict)
    fresh: list[str] = field(default_factory=list)
    removed: list[str] = field(default_factory=list)
    temporary: list[Path] = field(default_factory=list)

    def _spare(self) -> Path:
        self.temporary.append(spare(self.folder))
        return self.temporary[-1]

    def stage(self, name: str, content: bytes) -> None:
        """Write a file under a temporary name."""
        target = self.folder / name
        if target.is_dir() and not target.is_symlink():
            raise IsADirectoryError(errno.EISDIR, "there is a folder of this name", str(target))
        self.staged[name] = self._spare()
        try:
            self.staged[name].write_bytes(content)
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(target)) from error

    def commit(self, stale: list[str]) -> None:
        """Move staged files into place and stale ones away, or undo all if that fails."""
        try:
            for name in [name for name in self.staged if name != SUMMARY]:
                self._replace(name)
            self._remove(stale)
            if SUMMARY in self.staged:
                self._replace(SUMMARY)
        except BaseException:
            self._undo()
            raise
        finally:
            self.finish()

    def _replace(self, name: str) -> None:
        """Move a staged file into place and keep the old one."""
        target = self.folder / name
        if os.path.lexists(target):
            kept = self._spare()
            _copy(target, kept)
            self.kept[name] = kept
        else:
            self.fresh.append(name)
        self.staged[name].replace(target)

    def _remove(self, names: list[str]) -> None:
        """Move stale files away; links are removed, not followed, and folders are left alone."""
        written = [self.folder / name for name in self.staged]
        for name in names:
            target = self.folder / name
            # if case does not matter, an old name may be that of a new file
            if not target.is_symlink() and any(
                path.exists() and path.samefile(target) for path in written
            ):
                continue
            self.kept[name] = self._spare()
            target.replace(self.kept[name])
            self.removed.append(name)

    def _undo(self) -> None:
        """Put everything back."""
        for name in self.fresh:
            with suppress(OSError):
                (self.folder / name).unlink()
        for name, kept in self.kept.items():
            with suppress(OSError):
                kept.replace(self.folder / name)

    def finish(self) -> None:
        """Remove all temporary files."""
        for path in self.temporary:
            with suppress(OSError):
                path.unlink()


def _copy(source: Path, target: Path) -> None:
    """Link a file to a second name, or copy it if the file system has no hard links."""
    try:
        os.link(source, target, follow_symlinks=False)
    except (OSError, NotImplementedError):
        shutil.copy2(source, target, follow_symlinks=False)


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
    demand_name(path)
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
    fresh = spare(target.parent)
    try:
        with lock(target.parent), unbroken():
            try:
                fresh.write_bytes(content)
                shutil.copymode(target, fresh)
                fresh.replace(target)
            finally:
                with suppress(OSError):
                    fresh.unlink()
    except OSError as error:
        raise WriteError(f"cannot write to {file}: {error.strerror or error}") from error
