"""Names of a class that are for users: what ``dir``, ``help`` and the tabulator list.

A class names them in its tuple ``for_users``, beside those of its bases; each has an example.
Other public names are what parts of the program ask of each other. They work, but are not listed.
"""

from __future__ import annotations

from abc import ABCMeta
from collections.abc import Iterable, Sequence
from typing import ClassVar


def _listed(owner: type, every: Iterable[str]) -> list[str]:
    """Return what users see of `every` name: all, if no class names what is for them."""
    named = {name for one in owner.__mro__ for name in vars(one).get("for_users", ())}
    return [one for one in every if one.startswith("_")] + sorted(named) if named else [*every]


class ListsNames(ABCMeta):
    """The type of classes that list what is for users."""

    def __dir__(cls) -> Iterable[str]:
        return _listed(cls, super().__dir__())


class ForUsers(metaclass=ListsNames):
    """Base of objects that list what is for users."""

    for_users: ClassVar[Sequence[str]] = ()
    """Names of this class that are for users."""

    def __dir__(self) -> Iterable[str]:
        return _listed(type(self), super().__dir__())
