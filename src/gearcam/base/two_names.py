"""Facts that repeat a key of the design under another name: either name is understood.

``pair.rack.addendum`` among the facts of a gear pair is the key ``rack.addendum`` of its file. A
kind of design gives the keys by the facts; a name may stand for all that begin with it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Final

_PLACE: Final = re.compile(r"\[(\d+)\]")
"""The place in a list in brackets, as in keys: ``gears[0].size_mm``."""


def key_of(keys: Mapping[str, str], name: str) -> str:
    """Return the key that the fact `name` repeats, of `keys` by facts; else the name itself."""
    for fact, key in keys.items():
        if name == fact or name.startswith(f"{fact}."):
            return key + name[len(fact) :]
    return name


def fact_of(keys: Mapping[str, str], name: str) -> str:
    """Return the fact that repeats the key `name`, of `keys` by facts; else the name itself."""
    return key_of({key: fact for fact, key in keys.items()}, name)


def spellings(keys: Mapping[str, str], name: str) -> Iterator[str]:
    """Yield other names of what a name names: the fact, the key, and places without brackets.

    Parameters
    ----------
    keys : mapping of str to str
        Keys by the facts that repeat them.
    name : str
        The name.

    Yields
    ------
    str
    """
    plain = _PLACE.sub(r".\1", name)
    for one in (name, plain):
        yield from (fact_of(keys, one), key_of(keys, one))
    yield plain
