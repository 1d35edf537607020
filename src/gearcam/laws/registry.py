"""What the registries of laws have in common: entries with claims, each name once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

C = TypeVar("C")
E = TypeVar("E", bound="Entry[Any]")


@dataclass(frozen=True, kw_only=True)
class Entry(Generic[C]):
    """A law in a registry.

    Parameters
    ----------
    name : str
        As in a design file.
    parameters : type
        Dataclass with a ``build`` method.
    doc, continuity, source : str
        One line each, for people.
    claims : callable
        Returns examples with what they must give.
    """

    name: str
    parameters: type[Any]
    doc: str
    continuity: str
    source: str
    claims: Callable[[], tuple[C, ...]]


def hang(registry: dict[str, E], entry: E, what: str) -> None:
    """Hang an entry in a registry.

    Parameters
    ----------
    registry : dict of str to Entry
        By name.
    entry : Entry
        The law.
    what : str
        What the registry holds, for the message.

    Raises
    ------
    ValueError
        If its name is taken.
    """
    if entry.name in registry:
        raise ValueError(f"{what} {entry.name!r} is registered twice")
    registry[entry.name] = entry
