"""Writing: all files of a build, each whole or not at all.

Every file is first written beside its place under a temporary name. Only when all are on the disk
are they moved into place; files that the *previous summary* lists and this build no longer writes
are *stale* and removed, so that nobody cuts one; the new summary comes last. What stood there
before is kept until then and put back if anything fails; an interruption waits until all is in
place. The folder is *held* meanwhile: a second build waits for its turn. What the system still
holds in memory when the power fails may be lost: nothing asks the disk to have stored a file
(fsync), which takes as long again as all of the writing, 40 ms for eleven files.

One file of the user's is *rewritten* in the same way: beside it, then into its place, with its
permissions; of a link the file that it leads to is rewritten.

Refused: names that are not plain, a folder that is a file, a folder of a design that is a link, and
whatever the disk refuses.

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
"""Size of a summary, bytes: a thousand times that of one."""

Make = Callable[[Mapping[str, str]], Mapping[str, bytes]]
"""Returns contents by name, given the `previous_files` of the folder."""


def write_all(
    directory: str | os.PathLike[str], make: Make, *, name: str = "", keep: bool = False
) -> tuple[str, ...]:
    """Write files into a folder, whole or not at all, and remove stale ones.

    Parameters
    ----------
    directory : path
        The folder; made where it does not exist.
    make : callable
        Returns plain file names and contents. ``summary.json`` among them lists the others.
    name : str
        Of a folder in it that they are written to instead; it may be no link.
    keep : bool
        Keep the stale files: what is written is no build, only a summary.

    Returns
    -------
    tuple of str
        The stale files that were removed.

    Raises
    ------
    WriteError
        If the folder or a file cannot be written. Nothing is changed then, as far as the disk
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
        words = "it is a link, and may lead elsewhere: remove it, or choose another folder"
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
    """Return whether a name means a file right in a folder: no path, not hidden, not empty."""
    return bool(name) and not name.startswith(".") and not set(name) & set("/\\:\0")


def previous_files(folder: str | os.PathLike[str]) -> dict[str, str]:
    """Return the files that the summary in a folder lists, current and stale, if they are there.

    Parameters
    ----------
    folder : path
        A folder that an earlier build has written.

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
    """Return whether a listed name is a file or a link; one that no disk can hold is none."""
    try:
        return place.is_symlink() or place.is_file()
    except OSError:
        return False


@dataclass
class _Change:
    """What has been done to a folder so far, and how to take it back."""

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
            raise IsADirectoryError(errno.EISDIR, "a folder is in the way", str(target))
        self.staged[name] = self._spare()
        try:
            self.staged[name].write_bytes(content)
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(target)) from error

    def commit(self, stale: list[str]) -> None:
        """Move all staged files into place, put stale ones aside; all, or none if that fails."""
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
        """Move a staged file into place and keep what was there."""
        target = self.folder / name
        if os.path.lexists(target):
            kept = self._spare()
            _copy(target, kept)
            self.kept[name] = kept
        else:
            self.fresh.append(name)
        self.staged[name].replace(target)

    def _remove(self, names: list[str]) -> None:
        """Put stale files aside; links are removed, never followed, and folders are left alone."""
        written = [self.folder / name for name in self.staged]
        for name in names:
            target = self.folder / name
            # Where case does not matter, an old name may be a new file.
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
        """Remove every temporary file that is left."""
        for path in self.temporary:
            with suppress(OSError):
                path.unlink()


def _copy(source: Path, target: Path) -> None:
    """Give a file a second name; copy it where the disk knows no such names."""
    try:
        os.link(source, target, follow_symlinks=False)
    except (OSError, NotImplementedError):
        shutil.copy2(source, target, follow_symlinks=False)


def write_new(path: str | os.PathLike[str], text: str) -> None:
    """Write a file that is not there yet.

    Parameters
    ----------
    path : path
        Where.
    text : str
        Its content.

    Raises
    ------
    WriteError
        If there is one already, or the disk refuses; nothing is left there then.
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
        raise WriteError(f"{path}: exists, and is not overwritten") from error
    except OSError as error:
        raise WriteError(f"{path}: cannot be written: {error.strerror or error}") from error


def rewrite(file: str | os.PathLike[str], content: bytes) -> None:
    """Give an existing file another content.

    Parameters
    ----------
    file : path
        Its name.
    content : bytes
        What it shall hold.

    Raises
    ------
    WriteError
        If the disk refuses; the file is as it was then.
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
