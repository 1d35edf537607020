"""Registry entries of laws: ratio laws of pairs and motion laws of followers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

TYPED: Final = 1e-9
"""Error, in rad or relative, of a number typed with few digits: it is corrected silently."""

NO_JUMPS: Final = "a change within a few arc seconds counts as a jump"
"""Note in messages about functions that are not smooth but may only be steep."""


@dataclass(frozen=True, kw_only=True)
class LawEntry:
    """A law in a registry.

    Parameters
    ----------
    name : str
        Name in design files.
    example : object
        Example parameters of the law: a dataclass with a ``build`` method.
    doc, continuity, source : str
        Description, order of continuity and citation, one line each.
    """

    name: str
    example: Any
    doc: str
    continuity: str
    source: str

    @property
    def parameters(self) -> type[Any]:
        """The class of the parameters."""
        return type(self.example)
