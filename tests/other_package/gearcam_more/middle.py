"""The table ``[[middle]]``: the point halfway between two joints."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from gearcam.base.display import ShortRepr
from gearcam.kinds.mechanism.keys import Sort, named
from gearcam.kinds.mechanism.parts.part import MachinePart, Setting
from gearcam.linkages.elements import Element
from gearcam.linkages.known import Known


@dataclass(frozen=True)
class Middle(ShortRepr, Element):
    """The point halfway between two joints."""

    needing = ("first", "second")

    name: str
    first: str
    second: str

    def solve(self, known: Known) -> None:
        """Add the point to what is `known`."""
        known.given[self.name] = 0.5 * (known.jet(self.first) + known.jet(self.second))


@dataclass(frozen=True, kw_only=True)
class MiddleSpec(MachinePart):
    """The point halfway between two joints."""

    name: str = named(gives=Sort.JOINT, doc="its name", example="M")
    first: str = named(needs=Sort.JOINT, doc="one joint", example="B")
    second: str = named(needs=Sort.JOINT, doc="the other joint", example="C")

    def elements(self, setting: Setting, where: str) -> Iterator[Middle]:  # noqa: ARG002
        """Yield the point."""
        yield Middle(self.name, self.first, self.second)

    def usual(self, *, last: bool) -> Iterator[tuple[int, str]]:  # noqa: ARG002
        """Yield the point."""
        yield 0, self.name
