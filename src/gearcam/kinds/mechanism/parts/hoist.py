"""The table ``[[hoist]]``."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.findings import Remark, check
from gearcam.base.numerals import formatted
from gearcam.base.quantities import REQUIRED, TEXT, param, positive_length
from gearcam.kinds.mechanism.asked import TABLES
from gearcam.kinds.mechanism.keys import Sort, angle_param, center_of, named, point_param
from gearcam.kinds.mechanism.parts.chain import NEAR, WoundPart, numbers, shaft_place
from gearcam.kinds.mechanism.parts.part import Setting
from gearcam.kinds.mechanism.parts.slide import PushedPart
from gearcam.linkages.elements import Element, GuideLine, PushedSlide, WoundWay

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.picture import Picture

_BESIDE: Final = 1e-3
"""How far its chain may pass beside its wheel, relative to the radius, to be drawn straight."""


@dataclass(frozen=True, kw_only=True)
class HoistSpec(PushedPart, WoundPart):
    """What a wheel lifts by a chain or a rope, straight along a guide.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.HoistSpec(name="door", on="pair.wheel2", joint="hook", radius=100.0)
    HoistSpec(name='door', on='pair.wheel2', joint='hook', radius=100)
    """

    name: str = named(gives=Sort.MEMBER, doc="name of what is lifted", example="door")
    on: str = named(needs=Sort.SHAFT, doc="the wheel's shaft", example="pair.wheel2")
    joint: str = named(
        gives=Sort.JOINT, doc="name of its joint, where the chain ends", example="hook"
    )
    radius: float = positive_length(
        default=REQUIRED, example=100, doc="of the wheel, to the chain's middle"
    )
    wind: str = param(
        TEXT, default="ccw", choices=("ccw", "cw"), doc="turn of the wheel that winds the chain up"
    )
    at: tuple[float, float] = point_param(
        doc="the joint where the wheel's turn is 0", default=(0.0, 0.0)
    )
    direction: float = angle_param(doc="in which it is lifted", default=math.radians(90.0))

    @property
    def way(self) -> str:
        """Name of the quantity that is its place on its guide."""
        return f"{self.name}.way"

    def elements(self, setting: Setting, where: str) -> Iterator[Element]:
        """Yield what is wound up, its guide, and what is lifted (see `MachinePart`)."""
        yield WoundWay(self.way, self.on, self.side * self.radius)
        yield GuideLine(self.guide, complex(*self.at), self.direction)
        yield PushedSlide(self.name, self.way, self.guide, self.joint)

    def draw(self, picture: Picture) -> None:
        """Draw it, its chain, and the wheel on its shaft."""
        picture.member(self.name, 0j, blocks=((0j, 0.0),))
        end, along = picture.place(self.joint), cmath.exp(1j * self.direction)
        shaft = complex(picture.place(center_of(self.on))[0])
        # where the chain, which leads straight to the joint, is level with the shaft
        foot = complex(end[0] + along * ((shaft - end[0]) * along.conjugate()).real)
        picture.chain_wheel(self.on, shaft, self.radius)
        beside = abs(foot - shaft)
        if beside > (1.0 + _BESIDE) * self.radius:  # something must guide it to the wheel
            picture.guided(shaft + self.radius * (foot - shaft) / beside, foot)
        picture.chain(np.full(end.shape, foot), end)

    def stand(self, picture: Picture) -> None:
        """Draw its guide."""
        picture.way(self.guide)


@check("guided-chain", kind=TABLES, severity="note", unit="mm")
def guided_chain(result: Any, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note the chain of a hoist that does not lead straight to its wheel.

    Looks at: how far it passes beside the shaft, and the radius of the wheel.
    """
    for number, hoist in enumerate(result.design.hoist):
        shaft, at = shaft_place(result, hoist.on), complex(*hoist.at)
        # the chain is wound up on this side of the wheel
        side = -1j * cmath.exp(1j * hoist.direction) * hoist.side
        beside = ((at - shaft) * side.conjugate()).real
        if abs(beside - hoist.radius) > NEAR * hoist.radius:
            straight = at + side * (hoist.radius - beside)
            yield Remark(
                f"The chain does not lead straight to its wheel on the shaft {hoist.on}, at "
                f"({numbers(shaft)}) mm: this is how far it passes beside the shaft, on the side "
                f"where it is wound up, not the radius of {formatted(hoist.radius)} mm. It is "
                f"taken to be guided; it is straight with at_mm = [{numbers(straight)}].",
                f"hoist[{number}].at_mm",
                beside,
            )
