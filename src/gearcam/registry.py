"""Registries: entries by name, each registered by the module that is its home.

A home is imported when its entry is asked for: a design with one law loads that law.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from typing import Generic, Protocol, TypeVar


class Named(Protocol):
    """What a registry can hold."""

    @property
    def name(self) -> str:
        """As in a design file."""
        ...


E = TypeVar("E", bound=Named)


class Registry(Mapping[str, E], Generic[E]):
    """Entries by name.

    Parameters
    ----------
    what : str
        What an entry is, for messages.
    homes : mapping of str to tuple of str
        The names that modules register when they are imported, by module.
    """

    def __init__(self, what: str, homes: Mapping[str, tuple[str, ...]]) -> None:
        self._what = what
        self._homes = {name: module for module, names in homes.items() for name in names}
        self._entries: dict[str, E] = {}

    def register(self, *entries: E) -> None:
        """Take entries in.

        Parameters
        ----------
        *entries : Named
            One or more.

        Raises
        ------
        ValueError
            If a name is taken.
        """
        for entry in entries:
            if entry.name in self._entries:
                raise ValueError(f"{self._what} {entry.name!r} is registered twice")
            self._entries[entry.name] = entry

    def __getitem__(self, name: str) -> E:
        if name not in self._entries and name in self._homes:
            importlib.import_module(self._homes[name])
        return self._entries[name]

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys((*self._homes, *self._entries)))

    def __len__(self) -> int:
        return len(self._homes.keys() | self._entries.keys())

    def __contains__(self, name: object) -> bool:
        return name in self._homes or name in self._entries
