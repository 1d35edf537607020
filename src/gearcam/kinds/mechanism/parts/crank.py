"""The table ``[[crank]]``."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gearcam.base.errors import InfeasibleError
from gearcam.base.quantities import REQUIRED, positive_length
from gearcam.base.rules import Breach
from gearcam.kinds.mechanism.keys import Sort, angle_param, center_of, named
from gearcam.kinds.mechanism.parts.part import MachinePart, Setting
from gearcam.linkages.elements import Crank

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.picture import Picture


@dataclass(frozen=True, kw_only=True)
class CrankSpec(MachinePart):
    """A member on a shaft that turns.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CrankSpec(name="crank", on="motor", joint="B", length=40.0)
    CrankSpec(name='crank', on='motor', joint='B', length=40)
    """

    name: str = named(gives=Sort.MEMBER, turns=True, doc="its name", example="crank")
    on: str = named(
        needs=Sort.SHAFT,
        doc="the shaft: the name of an even drive, pair.wheel2, cam.follower, cam.turret",
        example="motor",
    )
    joint: str = named(gives=Sort.JOINT, doc="name of its joint", example="B")
    length: float = positive_length(default=REQUIRED, example=40, doc="from the shaft to the joint")
    angle: float | None = angle_param(
        doc="its direction at the drive's zero; 0 if left out", default=None, example=0
    )
    arm_angle: float | None = angle_param(
        doc="its direction at the drive's zero, from the arm of an oscillating follower",
        default=None,
        example=90,
    )
    at: str | None = named(
        needs=Sort.JOINT,
        doc="joint in which the shaft stands, if not that of the drive",
        default=None,
        example="A",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield two directions: field, index, message, what is allowed."""
        if self.angle is not None and self.arm_angle is not None:
            yield "arm_angle", None, "is given beside angle_deg", "angle_deg or arm_angle_deg"

    def elements(self, setting: Setting, where: str) -> Iterator[Crank]:
        """Yield the crank (see `MachinePart`)."""
        center, start = self.at or center_of(self.on), self._start(setting, where)
        yield Crank(self.name, self.on, center, self.joint, self.length, start)

    def _start(self, setting: Setting, where: str) -> float:
        """Return its direction at the drive's zero, rad."""
        if self.arm_angle is None:
            return self.angle or 0.0
        mover = setting.movers.get(self.on)
        if mover is None or math.isnan(mover.moved.arm):
            raise InfeasibleError(
                f"{self.on} has no arm from which it could count",
                where=f"{where}.arm_angle_deg",
                nearest="angle_deg instead",
            )
        turn = -self.arm_angle if mover.drive.spec.mirror else self.arm_angle
        return cmath.phase(mover.drive.vector(cmath.exp(1j * mover.moved.arm))) + turn

    def usual(self, *, last: bool) -> Iterator[tuple[int, str]]:
        """Yield the direction of the last crank, if there are no other members."""
        if last:
            yield 2, f"{self.name}.angle"

    def sizes(self) -> tuple[float, ...]:
        """Return its length."""
        return (self.length,)

    def draw(self, picture: Picture) -> None:
        """Draw its link."""
        picture.member(self.name, 0j, complex(self.length))

    def stand(self, picture: Picture) -> None:
        """Draw the pivot of its shaft, unless a wheel or a cam is on it."""
        if self.at is None and picture.setting.drawn(self.on) in ("", "follower"):
            picture.pivot(complex(picture.place(center_of(self.on))[0]))
