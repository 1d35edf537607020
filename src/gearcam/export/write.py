"""Writing: all files of a build, each whole or not at all.

Every file is first written beside its place under a temporary name. Only when all are on the disk
are they moved into place; files that the *previous summary* lists and this build no longer writes
are *stale* and removed, so that nobody cuts one; the new summary comes last. What stood there
before is kept until then and put back if anything fails, an interruption included.

One file of the user's is *rewritten* in the same way: beside it, then into its place, with its
permissions; of a link the file that it leads to is rewritten.

Refused: names that are not plain, a folder that is a file, and whatever the disk refuses.

Depends on errors only.
"""

from __future__ import annotations

import errno
import json
import os
import shutil
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from gearcam.errors import WriteError

SUMMARY: Final = "summary.json"
"""The file that lists the others; replaced last."""

TEMPORARY: Final = ".gearcam-"
"""Beginning of temporary names."""


def write_all(
    directory: str | os.PathLike[str], files: Mapping[str, bytes], *, keep: bool = False
) -> tuple[str, ...]:
    """Write files into a folder, whole or not at all, and remove stale ones.

    Parameters
    ----------
    directory : path
        The folder; made where it does not exist.
    files : mapping of str to bytes
        Plain file names and contents. ``summary.json`` among them lists the others.
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
    folder = Path(directory)
    wrong = [name for name in files if not is_plain(name)]
    if wrong:
        raise ValueError(f"not plain file names: {wrong}")
    try:
        return _write(folder, files, keep)
    except OSError as error:
        place = error.filename2 or error.filename or folder
        raise WriteError(f"cannot write to {place}: {error.strerror or error}") from error


def _write(folder: Path, files: Mapping[str, bytes], keep: bool) -> tuple[str, ...]:
    made = _make(folder)
    change = _Change(folder)
    try:
        before = {} if keep else previous_files(folder)
        stale = [name for name in before if name not in files]
        for name, content in files.items():
            change.stage(name, content)
        for name in [name for name in files if name != SUMMARY]:
            change.replace(name)
        change.remove(stale)
        if SUMMARY in files:
            change.replace(SUMMARY)
    except BaseException:
        change.undo()
        for empty in reversed(made):
            with suppress(OSError):
                empty.rmdir()
        raise
    try:
        change.finish()
    except BaseException:
        change.finish()
        raise
    return tuple(change.removed)


def _make(folder: Path) -> list[Path]:
    """Make a folder and those above it; return the new ones, outermost first."""
    if folder.exists() and not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "it is a file, not a folder", str(folder))
    new = [place for place in (folder, *folder.parents) if not place.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    return new[::-1]


def is_plain(name: str) -> bool:
    """Return whether a name means a file right in a folder: no path, not hidden, not empty."""
    return bool(name) and not name.startswith(".") and not set(name) & set("/\\:\0")


def previous_files(folder: str | os.PathLike[str]) -> dict[str, str | None]:
    """Return the files that the summary in a folder lists, current and stale, if they are there.

    Parameters
    ----------
    folder : path
        A folder that an earlier build has written.

    Returns
    -------
    dict of str to str or None
        By plain name the hash of the design that a file was made from, None where the summary does
        not tell it; without the summary itself. Empty where there is no summary that can be read.
    """
    place = Path(folder)
    try:
        content = json.loads((place / SUMMARY).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    found: dict[str, str | None] = {}
    for key in ("files", "stale") if isinstance(content, dict) else ():
        found |= _listed(content.get(key))
    return {
        name: made
        for name, made in found.items()
        if is_plain(name) and name != SUMMARY and _is_there(place / name)
    }


def _listed(entries: Any) -> dict[str, str | None]:
    """Return names with hashes; the first layout listed names only."""
    if isinstance(entries, list):
        return {name: None for name in entries if isinstance(name, str)}
    known = entries.items() if isinstance(entries, dict) else ()
    return {name: made for name, made in known if made is None or isinstance(made, str)}


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
        self.temporary.append(self.folder / f"{TEMPORARY}{os.urandom(16).hex()}.tmp")
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

    def replace(self, name: str) -> None:
        """Move a staged file into place and keep what was there."""
        target = self.folder / name
        if os.path.lexists(target):
            spare = self._spare()
            _copy(target, spare)
            self.kept[name] = spare
        else:
            self.fresh.append(name)
        self.staged[name].replace(target)

    def remove(self, names: list[str]) -> None:
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

    def undo(self) -> None:
        """Put everything back."""
        for name in self.fresh:
            with suppress(OSError):
                (self.folder / name).unlink()
        for name, spare in self.kept.items():
            with suppress(OSError):
                spare.replace(self.folder / name)
        self.finish()

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
        If there is one already, or the disk refuses.
    """
    try:
        with Path(path).open("x", encoding="utf-8", newline="\n") as stream:
            stream.write(text)
    except FileExistsError as error:
        raise WriteError(f"{path}: exists, and is not overwritten") from error
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise WriteError(f"{path}: cannot be written: {reason}") from error


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
    spare = target.with_name(f"{TEMPORARY}{os.urandom(16).hex()}.tmp")
    try:
        spare.write_bytes(content)
        shutil.copymode(target, spare)
        spare.replace(target)
    except OSError as error:
        raise WriteError(f"cannot write to {file}: {error.strerror or error}") from error
    finally:
        with suppress(OSError):
            spare.unlink()
