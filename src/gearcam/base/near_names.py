"""The names that are nearest to one that does not exist, and the error that lists them."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import Final

_LISTED: Final = 3
"""Largest number of names that are listed for one that does not exist."""

_LEAST: Final = 0.5
"""Least similarity of names."""


def near_names(name: str, names: Iterable[str]) -> list[str]:
    """Return those of some dotted names that begin with a name, or the most similar ones."""
    known = list(names)
    inside = [one for one in known if one.startswith(f"{name}.")][:_LISTED]
    return inside or difflib.get_close_matches(name, known, n=_LISTED, cutoff=_LEAST)


class UnknownNameError(KeyError):
    """A name that does not exist, with the nearest ones; these are sought when it is printed.

    Parameters
    ----------
    name : str
        The name.
    names : iterable of str
        Those that exist.
    reason : str
        Why there are no others, if that is known.
    """

    def __init__(self, name: object, names: Iterable[str] = (), reason: str = "") -> None:
        super().__init__(name)
        self.names, self.reason = names, reason

    def __reduce__(self) -> tuple[type, tuple[object, list[str], str]]:
        return type(self), (self.args[0], list(self.names), self.reason)

    def __str__(self) -> str:
        name = self.args[0]
        near = near_names(name, self.names) if isinstance(name, str) else []
        words = [self.reason] if self.reason else []
        words += [f"did you mean {' or '.join(near)}?"] if near else []
        return f"{name!r} is not there" + "".join(f": {one}" for one in words)
