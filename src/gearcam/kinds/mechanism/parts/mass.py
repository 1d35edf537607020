"""The table ``[[mass]]``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gearcam.base.quantities import INERTIA, MASS, param
from gearcam.base.rules import Breach
from gearcam.designs.faults import Fault
from gearcam.kinds.mechanism.keys import Sort, named, point_param
from gearcam.kinds.mechanism.parts.acted import Acted, LoadedLinkage
from gearcam.kinds.mechanism.parts.action import MachineAction
from gearcam.linkages.coordinates import MemberTurn, NamedCoordinate
from gearcam.linkages.efforts import GRAVITY, Effort, InertiaForce, force_on
from gearcam.linkages.elements import Element, MemberPoint

if TYPE_CHECKING:
    from gearcam.mechanics.gravity import GravitySpec


@dataclass(frozen=True, kw_only=True)
class MemberMass(MachineAction):
    """The mass of a member; its weight where there is gravity, its inertia at a speed.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MemberMass(of="rod", mass=45.0, at=(260.0, 0.0), inertia=2.8)
    MemberMass(of='rod', mass=45, at=(260, 0), inertia=2.8)
    """

    moved = "of"

    of: str = named(
        needs=f"{Sort.MEMBER} or {Sort.SHAFT}", example="rod", doc="the member, or a shaft"
    )
    mass: float | None = param(MASS, default=None, gt=0, le=1e9, example=0.35, doc="its mass")
    center: str | None = named(
        needs=Sort.JOINT, default=None, example="G", doc="joint or point in its centre of mass"
    )
    at: tuple[float, float] | None = point_param(
        default=None,
        example=[60, 0],
        doc="the centre of mass in the member's frame, instead of center",
    )
    inertia: float = param(
        INERTIA, default=0.0, ge=0, le=1e9, doc="moment of inertia about the centre of mass"
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        placed = [name for name in ("center", "at") if getattr(self, name) is not None]
        if self.mass is None and not self.inertia:
            yield "mass", None, "is missing", "mass_kg, or inertia_kg_m2"
        if self.mass is None and placed:
            yield "mass", None, "is missing for a centre of mass", "mass_kg"
        if len(placed) > 1:
            yield "at", None, "is given beside center", "center or at_mm"

    def unfit(self, acted: Acted) -> Iterator[Fault]:
        """Yield a mass of a shaft, and one without a centre of mass."""
        placed = self.center is not None or self.at is not None
        if acted.sorts[self.of] == Sort.SHAFT and self.mass is not None:
            what = "does not count for a shaft: its centre stands still"
            yield Fault(("mass_kg",), what, allowed="inertia_kg_m2")
        elif self.mass is not None and not placed and self.of not in acted.unturned:
            what = f"{self.of} turns, and its centre of mass is not given"
            yield Fault((), what, allowed="center or at_mm beside mass_kg")

    def needs_speed(self, gravity: GravitySpec) -> str:
        """Return that it acts by its inertia, if not by its weight."""
        return "" if gravity.given else "a mass acts by its inertia, which depends on the speed"

    def _center(self, acted: Acted, number: int) -> str:
        """Return the joint in its centre of mass."""
        if self.center is not None:
            return self.center
        return f"{self.of}.center{number}" if self.at else acted.unturned[self.of]

    def points(self, acted: Acted, number: int) -> Iterator[Element]:
        """Yield its centre of mass, if no joint is there (see `MachineAction`)."""
        if self.at is not None:
            yield MemberPoint(self._center(acted, number), complex(*self.at), self.of)

    def efforts(self, on: LoadedLinkage, number: int) -> Iterator[Effort]:
        """Yield its inertia and its weight (see `MachineAction`)."""
        if self.inertia:
            turns = NamedCoordinate if on.acted.sorts[self.of] == Sort.SHAFT else MemberTurn
            yield InertiaForce.of_turn(turns(self.of), self.inertia, self.of)
        if self.mass:
            center = self._center(on.acted, number)
            yield InertiaForce.of_mass(center, self.mass, self.of)
            if on.pull:
                yield force_on(center, self.mass * on.pull, GRAVITY, member=self.of)
