"""The table ``[[geneva]]``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gearcam.base.quantities import COUNT, REQUIRED, param, positive_length
from gearcam.kinds.mechanism.asked import Output
from gearcam.kinds.mechanism.keys import Sort, angle_param, center_of, named
from gearcam.kinds.mechanism.parts.part import MachinePart, Setting
from gearcam.linkages.geneva import SLOTS, GenevaWheel

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.picture import Picture


@dataclass(frozen=True, kw_only=True)
class GenevaSpec(MachinePart):
    """A Geneva wheel: the pin of a crank turns it by one slot, then it rests.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.GenevaSpec(name="wheel", on="motor", slots=6, length=60.0)
    GenevaSpec(name='wheel', on='motor', slots=6, length=60)
    """

    name: str = named(gives=Sort.MEMBER, doc="name of the wheel", example="wheel")
    on: str = named(needs=Sort.SHAFT, doc="the crank's shaft", example="motor")
    at: str | None = named(
        needs=Sort.JOINT,
        doc="joint in which the shaft stands, if not that of the drive",
        default=None,
        example="A",
    )
    slots: int = param(COUNT, ge=SLOTS[0], le=SLOTS[1], doc="number of slots", example=6)
    length: float = positive_length(default=REQUIRED, example=60, doc="from the shaft to the pin")
    angle: float = angle_param(doc="the crank's direction at the drive's zero", default=0.0)
    direction: float = angle_param(doc="from the crank's shaft to the wheel's", default=0.0)
    internal: bool = param(default=False, doc="whether the wheel surrounds the crank")

    def elements(self, setting: Setting, where: str) -> Iterator[GenevaWheel]:
        """Yield the wheel (see `MachinePart`)."""
        center = self.at or center_of(self.on)
        yield GenevaWheel(
            self.name,
            self.on,
            center,
            self.length,
            self.slots,
            self.direction,
            self.angle,
            self.internal,
        )

    def period(self) -> int:
        """Return how many turns of the crank lead round."""
        return self.slots

    def outputs(self) -> Mapping[str, tuple[Output, ...]]:
        """Return its turn."""
        turn = f"{self.name}.turn"
        return {turn: (Output(turn, self.name, turn, True),)}

    def draw(self, picture: Picture) -> None:
        """Draw the wheel and its crank."""
        from gearcam.numeric.pose import Pose
        from gearcam.pictures.geneva import geneva_crank, geneva_wheel

        wheel = geneva_wheel(self.length, self.slots, internal=self.internal)
        picture.below(self.name, self.name, wheel, picture.pose(self.name))
        crank = geneva_crank(self.length, self.slots, internal=self.internal)
        pose = Pose(
            picture.turn(self.on) + self.angle, picture.place(self.at or center_of(self.on))
        )
        picture.below(f"{self.name}_crank", "crank", crank, pose)
