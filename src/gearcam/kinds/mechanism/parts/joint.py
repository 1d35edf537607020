"""The table ``[[joint]]``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gearcam.kinds.mechanism.keys import Sort, named, point_param
from gearcam.kinds.mechanism.parts.part import MachinePart, Setting
from gearcam.linkages.elements import MemberPoint

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.picture import Picture


@dataclass(frozen=True, kw_only=True)
class JointSpec(MachinePart):
    """A joint that stands still.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.JointSpec(name="D", at=(110.0, 0.0))
    JointSpec(name='D', at=(110, 0))
    """

    name: str = named(gives=Sort.JOINT, still=True, doc="its name", example="D")
    at: tuple[float, float] = point_param(doc="where it stands", example=[110, 0])

    def elements(self, setting: Setting, where: str) -> Iterator[MemberPoint]:
        """Yield the joint (see `MachinePart`)."""
        yield MemberPoint(self.name, complex(*self.at))

    def standing(self) -> Mapping[str, complex]:
        """Return where it stands."""
        return {self.name: complex(*self.at)}

    def stand(self, picture: Picture) -> None:
        """Draw its pivot."""
        picture.pivot(complex(*self.at))
