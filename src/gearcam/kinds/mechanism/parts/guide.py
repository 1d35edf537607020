"""The table ``[[guide]]``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gearcam.base.rules import Breach
from gearcam.kinds.mechanism.keys import STANDING, Sort, angle_param, named, point_param
from gearcam.kinds.mechanism.parts.part import MachinePart, Setting
from gearcam.linkages.elements import GuideLine
from gearcam.linkages.known import GROUND

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.picture import Picture


@dataclass(frozen=True, kw_only=True)
class GuideSpec(MachinePart):
    """A straight guide on the ground or on a member.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.GuideSpec(name="bed", at=(180.0, 0.0))
    GuideSpec(name='bed', at=(180, 0))
    """

    name: str = named(gives=Sort.GUIDE, doc="its name", example="bed")
    on: str = named(needs=Sort.MEMBER, doc="the member that carries it", default="ground")
    at: tuple[float, float] = point_param(
        doc="a point of it, from which places count, in the member's frame", default=(0.0, 0.0)
    )
    through: str | None = named(
        needs=STANDING,
        doc="a joint that stands still, or a shaft, from which at_mm counts",
        default=None,
        example="pair.wheel2",
    )
    direction: float = angle_param(doc="its direction in the member's frame", default=0.0)

    def problems(self) -> Iterator[Breach]:
        """Yield a joint of the ground for a guide on a member."""
        if self.through is not None and self.on != GROUND:
            yield "through", None, f"is given beside on = {self.on!r}", "a guide on the ground"

    def elements(self, setting: Setting, where: str) -> Iterator[GuideLine]:
        """Yield the guide through its point, or through what stands still (see `MachinePart`)."""
        at = complex(*self.at) + (0j if self.through is None else setting.place(self.through))
        yield GuideLine(self.name, at, self.direction, self.on)

    def draw(self, picture: Picture) -> None:
        """Draw it on its member, and what joins it to the member's origin."""
        if self.on == GROUND:
            return
        own = picture.pose(self.on)[0].inverse @ picture.pose(self.name)[0]
        ends, way, at = picture.ends(self.name), complex(own.rotation), complex(own.shift)
        if ends is not None:
            low, high = picture.reach(*ends)
            picture.bars[self.on].append((at + low * way, at + high * way))
        if at:
            picture.bars[self.on].append((0j, at))

    def stand(self, picture: Picture) -> None:
        """Draw it on the ground."""
        if self.on == GROUND:
            picture.way(self.name)
