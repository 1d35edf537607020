"""What a registry knows of a law: of the ratio of a pair, or of a follower's rise."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

TYPED: Final = 1e-9
"""Miss, in rad or in parts, that digits typed or printed may leave: it is taken out."""

NO_JUMPS: Final = "what changes within some arc seconds counts as a jump"
"""What is told with a function that is not smooth: it may be one that is only steep."""


@dataclass(frozen=True, kw_only=True)
class LawEntry:
    """A law in a registry.

    Parameters
    ----------
    name : str
        As in a design file.
    example : object
        Parameters of the law that show how a design file gives them: a dataclass with a ``build``
        method.
    doc, continuity, source : str
        One line each, for people.
    """

    name: str
    example: Any
    doc: str
    continuity: str
    source: str

    @property
    def parameters(self) -> type[Any]:
        """The class of its parameters."""
        return type(self.example)
