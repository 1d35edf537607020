"""What tables and numbers of a design file are called beside their sliders.

By the names that the file gives, such as ``crank "pin"``; items without a name by their number,
such as ``phase 2 of 4: rise`` and ``knot 2 of 5``.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from typing import Any, Final

from gearcam.designs.lines import Path
from gearcam.designs.table import Key

_ITEMS: Final[Mapping[str, str]] = {"motion": "phase"}
"""What items of a list of tables are called, where it is not as their table."""

_SINGULAR: Final[Mapping[str, str]] = {"radii": "radius"}

_OWN: Final = ("name", "joint")
"""Keys with the name of an item, the first one that says more than the table."""

_OTHERS: Final = ("on", "of")
"""Keys with the name of what an item belongs to."""


def title_of(document: Mapping[str, Any], path: Path) -> str:
    """Return what a table is called.

    Parameters
    ----------
    document : mapping
        Content of a design file.
    path : tuple of str and int
        Path of the table in it; may be empty.

    Returns
    -------
    str
        As ``law``, ``crank "pin"``, ``drive "drum", phase 2 of 4: rise``.
    """
    words: list[str] = []
    for at, step in enumerate(path):
        if isinstance(step, int):
            words[-1] = _item(words[-1], _at(document, path[:at]), step)
        elif _plain(step) not in words[-1:]:  # a cam has a table of its own name
            words.append(_plain(step))
    return ", ".join(words)


def label_of(document: Mapping[str, Any], path: Path, entry: Key, also: Collection[Path]) -> str:
    """Return what a number is called within its table.

    Parameters
    ----------
    document : mapping
        Content of a design file.
    path : tuple of str and int
        Path of the number in it.
    entry : Key
        Its key.
    also : collection of paths
        Numbers of the same list that are always equal to it.

    Returns
    -------
    str
        As ``center distance``, ``knot 2 of 5``, ``teeth, wheel 1 and wheel 2``, ``length of rod``.
    """
    word = _plain(entry.key.removesuffix(entry.param.quantity.suffix))
    if not isinstance(path[-1], int):
        return word
    count = len(_at(document, path[:-1]))
    table, called = _at(document, path[:-2]), entry.param.called
    members = table.get("members") if isinstance(table, Mapping) else None
    places = sorted({path[-1], *(int(one[-1]) for one in also)})
    one = word if len(places) > 1 else _SINGULAR.get(word, word.removesuffix("s"))
    if isinstance(members, list) and len(members) == count:
        return f"{one} of {' and '.join(str(members[k]) for k in places)}"
    if len(called) == count:
        return f"{word}, {' and '.join(called[k] for k in places)}"
    return word if count == 1 else f"{one} {' and '.join(str(k + 1) for k in places)} of {count}"


def _item(word: str, items: Sequence[Mapping[str, Any]], number: int) -> str:
    """Return what an item of a list of tables is called, of the `word` for the list."""
    names = [_name(word, item) for item in items]
    same = [k for k, name in enumerate(names) if name == names[number]]
    if not names[number]:
        word = _ITEMS.get(word, word)
        sort = items[number].get("type", "")
        counted = f"{word} {number + 1} of {len(items)}" if len(items) > 1 else word
        return f"{counted}: {sort}" if sort else counted
    more = f" ({same.index(number) + 1} of {len(same)})" if len(same) > 1 else ""
    return f"{word}{names[number]}{more}"


def _name(word: str, item: Mapping[str, Any]) -> str:
    """Return what follows the `word` for an item with a name; empty without one."""
    own = [item[key] for key in _OWN if key in item]
    if telling := [name for name in own if name != word] or own:
        return f' "{telling[0]}"'
    return next((f' {key} "{item[key]}"' for key in _OTHERS if key in item), "")


def _at(document: Mapping[str, Any], path: Path) -> Any:
    part: Any = document
    for step in path:
        part = part[step]
    return part


def _plain(word: str) -> str:
    """Return a word of a file as a reader writes it."""
    apart = re.sub(r"(?<=[a-z]{3})(?=\d$)", " ", word)  # prime_radius2
    return apart.replace("_", " ").replace("center", "centre")
