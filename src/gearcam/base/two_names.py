"""Facts that repeat a key of the design under another name: either name is understood.

``pair.rack.addendum`` among the facts of a gear pair is the key ``rack.addendum`` of its file. A
kind of design gives the keys by the facts; a name may stand for all that begin with it.
"""

from __future__ import annotations

from collections.abc import Mapping


def key_of(keys: Mapping[str, str], name: str) -> str:
    """Return the key that the fact `name` repeats, of `keys` by facts; else the name itself."""
    for fact, key in keys.items():
        if name == fact or name.startswith(f"{fact}."):
            return key + name[len(fact) :]
    return name


def fact_of(keys: Mapping[str, str], name: str) -> str:
    """Return the fact that repeats the key `name`, of `keys` by facts; else the name itself."""
    return key_of({key: fact for fact, key in keys.items()}, name)
