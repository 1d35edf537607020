"""What the entries of laws and of rises have in common."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

C = TypeVar("C")


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
