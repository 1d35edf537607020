"""Registries: entries by name, each defined in a module of a package.

The module is imported when its entry is first used: a design with one law loads that law only.
Other installed packages may bring more (`gearcam.base.brought`).
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Collection, Mapping
from functools import partial
from types import MappingProxyType
from typing import Any, Generic, Protocol, TypeVar

from gearcam.base.brought import Extensible, brought, load_brought
from gearcam.base.display import cut


class Named(Protocol):
    """The protocol of entries."""

    @property
    def name(self) -> str:
        """The name in a design file."""
        ...


E = TypeVar("E", bound=Named)
V = TypeVar("V")


class Registry(Extensible, Mapping[str, E], Generic[E]):
    """Entries by name, loaded on demand.

    Parameters
    ----------
    what : str
        Word for an entry, such as ``law``.
    package : str
        The package whose modules have the entries, each in its tuple ``ENTRIES``.
    homes : mapping of str to tuple of str
        The names of the entries of each module, by module.
    group : str
        Group of the entries that packages bring; empty if they cannot.
    """

    def __init__(
        self, what: str, package: str, homes: Mapping[str, tuple[str, ...]], group: str = ""
    ) -> None:
        self._what = what
        self._group = group
        self._homes = {name: f"{package}.{home}" for home, names in homes.items() for name in names}
        self._entries: dict[str, E] = {}

    def __repr__(self) -> str:
        return f"<Registry, each entry {self._what}>"

    def __getitem__(self, name: str) -> E:
        if name not in self._entries and name in self._homes:
            entries = importlib.import_module(self._homes[name]).ENTRIES
            self._entries |= {one.name: one for one in entries}
        elif name not in self._entries:
            self._entries[name] = load_brought(self._group, name)
        return self._entries[name]

    def _known(self) -> Collection[str]:
        return self._homes

    def name_of(self, part: object) -> str:
        """Return the name of the entry whose parameters a `part` is; empty if there is none."""
        own, home = type(part), type(part).__module__
        names = [name for name, module in self._homes.items() if module == home]
        names = names or list(brought(self._group))
        every: dict[str, Any] = {name: self[name] for name in names}
        return next((name for name, one in every.items() if one.parameters is own), "")


def deferred(place: str) -> Callable[..., Any]:
    """Return a function that imports the one at a `place`, ``package.module:name``, to call it."""
    return partial(_call, place)


def _call(place: str, /, *arguments: Any, **named: Any) -> Any:
    return _imported(place)(*arguments, **named)


class ExtensibleMapping(Extensible, Mapping[str, V], Generic[V]):
    """A mapping to which other packages may add.

    Parameters
    ----------
    own : mapping of str to object
        What is known here, by name.
    group : str
        Group of what packages bring besides; empty if they cannot.
    """

    def __init__(self, own: Mapping[str, V] = MappingProxyType({}), group: str = "") -> None:
        self.own = own
        self._group = group

    def __repr__(self) -> str:
        return cut(f"<{type(self).__name__} {', '.join(self._known())}>")

    def __getitem__(self, name: str) -> V:
        known = self._known()
        return known[name] if name in known else load_brought(self._group, name)

    def _known(self) -> Mapping[str, V]:
        return self.own


class DeferredMapping(ExtensibleMapping[Any]):
    """The mapping at a `place`, ``package.module:name``, imported when it is first used.

    Parameters
    ----------
    place : str
        Where it is.
    group : str
        Group of what packages bring besides; empty if they cannot.
    """

    def __init__(self, place: str, group: str = "") -> None:
        super().__init__(group=group)
        self._place = place

    def __repr__(self) -> str:
        return f"<{self._place}>"

    def _known(self) -> Mapping[str, Any]:
        return _imported(self._place)


def _imported(place: str) -> Any:
    module, _, name = place.partition(":")
    return getattr(importlib.import_module(module), name)


def classes_in(registry: Registry[Any]) -> dict[str, type]:
    """Return the parameter classes of all entries of a `registry` by class name."""
    return {one.parameters.__name__: one.parameters for one in registry.values()}


def lazy_names(
    lacks: str,
    classes: Callable[[], Mapping[str, type]],
    homes: Mapping[str, tuple[str, ...]] = MappingProxyType({}),
    sources: Callable[[], Mapping[type, str]] = dict,
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
    sources : callable
        Returns where classes come from, for their docstrings.

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

        return described(known[name], sources().get(known[name], ""))

    return find, names
