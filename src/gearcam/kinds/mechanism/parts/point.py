"""The table ``[[point]]``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gearcam.kinds.mechanism.keys import Sort, named, point_param
from gearcam.kinds.mechanism.parts.part import MachinePart, Setting
from gearcam.linkages.elements import MemberPoint
from gearcam.linkages.known import GROUND

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.picture import Picture


@dataclass(frozen=True, kw_only=True)
class PointSpec(MachinePart):
    """A point of a member, whose path is wanted or to which others are joined.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.PointSpec(name="P", on="coupler", at=(50.0, 35.0))
    PointSpec(name='P', on='coupler', at=(50, 35))
    """

    name: str = named(gives=Sort.JOINT, doc="its name", example="P")
    on: str = named(needs=Sort.MEMBER, doc="the member", example="coupler")
    at: tuple[float, float] = point_param(doc="the point in its frame", example=[50, 35])

    def elements(self, setting: Setting, where: str) -> Iterator[MemberPoint]:
        """Yield the point (see `MachinePart`)."""
        yield MemberPoint(self.name, complex(*self.at), self.on)

    def usual(self, *, last: bool) -> Iterator[tuple[int, str]]:
        """Yield the point."""
        yield 0, self.name

    def traced(self) -> tuple[str, ...]:
        """Return itself, if it moves."""
        return () if self.on == GROUND else (self.name,)

    def draw(self, picture: Picture) -> None:
        """Draw its pin, through which the member's link goes."""
        picture.pins[self.on].append(complex(*self.at))
