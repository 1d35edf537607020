"""Shrinking a failing design: parts are left out as long as it fails in the same way."""

from __future__ import annotations

import copy
import time
import tomllib
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

from gearcam.designs.writing import toml_text

Files = Mapping[str, str]

_DIGITS: Final = (1, 2, 3)
"""Numbers of digits to which values are shortened, fewest first."""

_KEPT: Final = ("kind", "name")


def shrunk(files: Files, fails: Callable[[Files], bool], patience: float) -> dict[str, str]:
    """Return a smaller design that fails in the same way.

    Parameters
    ----------
    files : mapping of str to str
        Texts by file name, the design file first.
    fails : callable
        ``fails(files)`` returns whether other files fail in the same way.
    patience : float, s
        Time limit.

    Returns
    -------
    dict of str to str
    """
    until = time.monotonic() + patience
    best = dict(files)
    name = next(iter(best))
    smaller = _documents if _document(best[name]) is not None else _texts
    again = True
    while again:
        again = False
        for text in smaller(best[name]):
            if time.monotonic() > until:
                return best
            other = {name: text, **{key: best[key] for key in best if key != name and key in text}}
            if fails(other):
                best, again = other, True
                break
    return best


def _document(text: str) -> dict[str, Any] | None:
    try:
        document = tomllib.loads(text)
        return document if tomllib.loads(toml_text(document)) == document else None
    except (ValueError, RecursionError):
        return None


def _texts(text: str) -> Iterator[str]:
    """Yield copies of the text with some lines removed."""
    lines = text.splitlines(keepends=True)
    size = len(lines) // 2
    while size:
        for first in range(0, len(lines), size):
            yield "".join(lines[:first] + lines[first + size :])
        size //= 2


def _documents(text: str) -> Iterator[str]:
    """Yield designs with one table, key or item removed, or one number shortened."""
    document = _document(text) or {}
    for path in _paths(document):
        made = copy.deepcopy(document)
        owner, last = _owner(made, path)
        del owner[last]
        if toml_text(made) != text:
            yield toml_text(made)
    for path in _paths(document):
        made = copy.deepcopy(document)
        owner, last = _owner(made, path)
        value = owner[last]
        if not isinstance(value, float):
            continue
        for digits in _DIGITS:
            owner[last] = float(f"{value:.{digits}g}")
            if owner[last] == value:
                break
            yield toml_text(made)


def _paths(node: Any, at: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the paths of all items of a document, tables before their keys."""
    items = list(node.items() if isinstance(node, dict) else enumerate(node))
    found: list[tuple[Any, ...]] = []
    for key, item in reversed(items):
        if key not in _KEPT:
            found.append((*at, key))
            if isinstance(item, dict | list):
                found += _paths(item, (*at, key))
    return sorted(found, key=len) if not at else found


def _owner(document: Any, path: tuple[Any, ...]) -> tuple[Any, Any]:
    for key in path[:-1]:
        document = document[key]
    return document, path[-1]
