"""Registries: entries by name, each registered by the module that defines it.

That module is imported when its entry is first used: a design with one law loads that law only.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from types import MappingProxyType
from typing import Any, Generic, Protocol, TypeVar


class Named(Protocol):
    """The protocol of entries."""

    @property
    def name(self) -> str:
        """The name in a design file."""
        ...


E = TypeVar("E", bound=Named)


class Registry(Mapping[str, E], Generic[E]):
    """Entries by name, loaded on demand.

    Parameters
    ----------
    what : str
        Word for an entry in messages, such as ``law``.
    homes : mapping of str to tuple of str
        The names that each module registers, by module.
    """

    def __init__(self, what: str, homes: Mapping[str, tuple[str, ...]]) -> None:
        self._what = what
        self._homes = {name: module for module, names in homes.items() for name in names}
        self._entries: dict[str, E] = {}

    def __repr__(self) -> str:
        return f"<Registry, each entry {self._what}>"

    def register(self, *entries: E) -> None:
        """Add entries.

        Parameters
        ----------
        *entries : Named
            The entries.

        Raises
        ------
        ValueError
            If a name is already registered.
        """
        for entry in entries:
            if entry.name in self._entries:
                raise ValueError(f"{self._what} {entry.name!r} is registered twice")
            self._entries[entry.name] = entry

    @property
    def loaded(self) -> tuple[E, ...]:
        """The entries whose modules have been imported."""
        return tuple(self._entries.values())

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


def deferred(place: str) -> Callable[..., Any]:
    """Return a function that imports the one at a `place`, ``package.module:name``, to call it."""
    return partial(_call, place)


def _call(place: str, /, *arguments: Any, **named: Any) -> Any:
    return _imported(place)(*arguments, **named)


class DeferredMapping(Mapping[str, Any]):
    """The mapping at a `place`, ``package.module:name``, imported when it is first used."""

    def __init__(self, place: str) -> None:
        self._place = place

    def __repr__(self) -> str:
        return f"<{self._place}>"

    def __getitem__(self, name: str) -> Any:
        return _imported(self._place)[name]

    def __iter__(self) -> Iterator[str]:
        return iter(_imported(self._place))

    def __len__(self) -> int:
        return len(_imported(self._place))


def _imported(place: str) -> Any:
    module, _, name = place.partition(":")
    return getattr(importlib.import_module(module), name)


def name_of(registry: Registry[Any], part: object) -> str:
    """Return the name of the entry in `registry` whose parameters `part` is; else an empty text."""
    # the class of the object was imported, so its entry is registered
    return next((one.name for one in registry.loaded if one.parameters is type(part)), "")


def classes_in(registry: Registry[Any]) -> dict[str, type]:
    """Return the parameter classes of all entries of a `registry` by class name."""
    return {one.parameters.__name__: one.parameters for one in registry.values()}


def lazy_names(
    lacks: str,
    classes: Callable[[], Mapping[str, type]],
    homes: Mapping[str, tuple[str, ...]] = MappingProxyType({}),
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return ``__getattr__`` and ``__dir__`` of a package whose names are loaded on demand.

    Parameters
    ----------
    lacks : str
        First words of the message for an unknown name: ``there is no law``.
    classes : callable
        Returns classes by name; called only for names with a capital letter.
    homes : mapping of str to tuple of str
        Other names, by the module that has them or is called so.

    Returns
    -------
    getattr, dir : callable
    """
    modules = {name: module for module, names in homes.items() for name in names}

    def names() -> list[str]:
        return sorted({*modules, *classes()})

    def find(name: str) -> Any:
        if name == "__all__":
            return names()
        if name in modules:
            module = importlib.import_module(modules[name])
            return getattr(module, name, module)
        known = classes() if name[:1].isupper() else {}
        if name not in known:
            raise AttributeError(f"{lacks} {name}; dir() lists all names")
        from gearcam.base.quantities import described

        return described(known[name])

    return find, names
