"""Which files in the folder of a design are gearcam's, and what becomes of each.

The summary lists each file with the hash of the design that it was made from, and with a hash of
its content. A file with this content is gearcam's: it is replaced, and removed if it is *outdated*,
that is, listed and no longer made, so that nobody cuts it. Any other file may have been edited and
is its user's: it is never removed, and gets a new name before another takes its place. This holds
for links, and for files listed by earlier versions of gearcam, whose summaries have no hashes of
contents. A design file that nobody edited is replaced, but not removed.

Depends on reading and `gearcam.export.write` only.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any, Final

from gearcam.base.reading import read
from gearcam.export.write import SUMMARY, is_plain

DESIGN: Final = ".toml"
"""End of the names of design files."""

_LARGEST: Final = 10_000_000
"""Largest size of a summary, bytes: a thousand times the usual size."""

_DIGITS: Final = 16
"""Hexadecimal digits of a hash of a content."""


@dataclass(frozen=True, kw_only=True)
class Listing:
    """The existing files that the summary in a folder lists, by plain name.

    Parameters
    ----------
    made : dict of str to str
        Hashes of the designs that they were made from, current and outdated; without the summary.
    contents : dict of str to str
        Hashes of their contents as they were written.
    studied : frozenset of str
        Those that commands of studies have written.
    """

    made: dict[str, str]
    contents: dict[str, str]
    studied: frozenset[str]


@dataclass(frozen=True, kw_only=True)
class Replacement:
    """What becomes of the files in a folder when others are written.

    Parameters
    ----------
    about : dict
        Entries of the new summary about files.
    removed : tuple of str
        Outdated files that are removed.
    kept : tuple of str
        Outdated files that are kept, and listed no more.
    renamed : dict of str to str
        New names of files that are replaced and kept, by the names that they have.
    """

    about: dict[str, Any]
    removed: tuple[str, ...]
    kept: tuple[str, ...]
    renamed: dict[str, str]


def planned(folder: Path, files: Mapping[str, bytes], version: str, *, keep: bool) -> Replacement:
    """Decide what becomes of the files in a folder when others are written.

    Parameters
    ----------
    folder : Path
        The folder of the design.
    files : mapping of str to bytes
        What is written, without the summary.
    version : str
        Hash of the design.
    keep : bool
        Whether the other files stay, as for a study. A build keeps only what commands of studies
        have written for the same design.

    Returns
    -------
    Replacement

    Raises
    ------
    OSError
        If a file cannot be read.
    """
    old = listing(folder)
    stay = {
        name: made
        for name, made in old.made.items()
        if keep or (made == version and name in old.studied)
    }
    made = {**stay, **dict.fromkeys(files, version)}
    studied = (old.studied & stay.keys()) - files.keys() | (files.keys() if keep else set())
    contents = {name: old.contents[name] for name in stay if name in old.contents}
    contents |= {name: _hash(content) for name, content in files.items()}
    about: dict[str, Any] = {"files": {one: by for one, by in made.items() if by == version}}
    more = {
        "outdated": {one: by for one, by in made.items() if by != version},
        "studied": sorted(studied),
        "contents": contents,
    }
    about |= {key: value for key, value in more.items() if value}
    outdated = [name for name in old.made if name not in made]
    removed = [
        name
        for name in outdated
        if not name.lower().endswith(DESIGN)
        and _is_regular(folder / name)
        and _hash((folder / name).read_bytes()) == old.contents.get(name)
    ]
    new = {one: aside(folder / one, files[one], old.contents.get(one, "")) for one in files}
    return Replacement(
        about=about,
        removed=tuple(removed),
        kept=tuple(name for name in outdated if name not in removed),
        renamed={name: free.name for name, free in new.items() if free is not None},
    )


def aside(path: Path, content: bytes, written: str = "") -> Path | None:
    """Return where a file that a user may have edited must go before it is replaced.

    Parameters
    ----------
    path : Path
        The file.
    content : bytes
        What takes its place.
    written : str
        Hash of the content that gearcam wrote last; empty if unknown.

    Returns
    -------
    Path or None
        A free name; None if no file must be moved: there is none, its content is the new one, or
        gearcam wrote it and nobody has changed it since.

    Raises
    ------
    OSError
        If the file cannot be read.
    """
    if not os.path.lexists(path):
        return None
    if _is_regular(path):
        now = path.read_bytes()
        if now == content or _hash(now) == written:
            return None
    names = (path.with_stem(f"{path.stem}.{number}") for number in count(1))
    return next(name for name in names if not os.path.lexists(name))


def listing(folder: str | os.PathLike[str]) -> Listing:
    """Return the existing files that the summary in a folder lists.

    Parameters
    ----------
    folder : path
        A folder of an earlier build.

    Returns
    -------
    Listing
        Empty where there is no summary that can be read, or it is not one of gearcam's.
    """
    place = Path(folder)
    content = _summary(place)
    made = {
        name: by
        for key in ("files", "outdated")
        for name, by in _texts(content.get(key)).items()
        if is_plain(name) and name != SUMMARY and _is_there(place / name)
    }
    studied = content.get("studied")
    given = studied if isinstance(studied, list) else ()
    return Listing(
        made=made,
        contents=_texts(content.get("contents")),
        studied=frozenset(name for name in given if isinstance(name, str)),
    )


def _summary(folder: Path) -> dict[str, Any]:
    """Return the summary in a folder; empty if there is none that can be read, or not gearcam's."""
    try:
        content = json.loads(read(folder / SUMMARY, _LARGEST))
    except (OSError, ValueError, RecursionError):
        return {}
    own = isinstance(content, dict) and isinstance(content.get("format"), int)
    return content if own else {}


def _texts(value: Any) -> dict[str, str]:
    """Return the items of a mapping whose values are texts."""
    items = value.items() if isinstance(value, dict) else ()
    return {key: item for key, item in items if isinstance(item, str)}


def _is_there(place: Path) -> bool:
    """Return whether a listed name is a file or a link; False for impossible names."""
    try:
        return place.is_symlink() or place.is_file()
    except OSError:
        return False


def _is_regular(place: Path) -> bool:
    """Return whether this is a file, not a link, folder or pipe."""
    return place.is_file() and not place.is_symlink()


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:_DIGITS]
