"""What acts on a mechanism: what is asked of each load, mass and spring, and what it may ask.

Each is a table of the file and one class. Forces are positive in the direction in which the place
of a slide counts, torques counter-clockwise as seen in the machine.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.findings import Remark, check
from gearcam.kinds.mechanism.asked import TABLES
from gearcam.kinds.mechanism.keys import Sort, WithNames
from gearcam.linkages.coordinates import (
    MemberTurn,
    NamedCoordinate,
    PointWay,
    WorkCoordinate,
    WorkState,
)
from gearcam.linkages.elements import Element
from gearcam.linkages.known import GROUND
from gearcam.linkages.measures import TrackMeasures
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet

if TYPE_CHECKING:
    from gearcam.designs.faults import Fault
    from gearcam.linkages.efforts import Effort
    from gearcam.linkages.linkage import Linkage
    from gearcam.mechanics.mass import GravitySpec

MOST: Final = 1e9
"""Largest force, N, torque, N m, and the like."""

MOVING: Final = f"{Sort.JOINT} or {Sort.MEMBER} or {Sort.SHAFT} or {Sort.WAY}"
"""What may be loaded."""


@dataclass(frozen=True, kw_only=True)
class Acted(ShortRepr):
    """What loads may act on, by the names in a mechanism.

    Parameters
    ----------
    sorts : mapping of str to str
        What each name is to a load: a joint, a member, a shaft, or a slide. This is a joint that
        slides along a guide, a member that is pushed or lifted, or what pushes it.
    ways : mapping of str to PointWay
        The ways of those that have one along a guide.
    unturned : mapping of str to str
        Members that keep their direction, each with a joint that has its way.
    still : set of str
        What stands still.
    """

    sorts: Mapping[str, str]
    ways: Mapping[str, PointWay]
    unturned: Mapping[str, str]
    still: frozenset[str]

    def turns(self, name: str) -> bool:
        """Return whether a torque acts on what has a `name`."""
        return self.sorts[name] in (Sort.MEMBER, Sort.SHAFT)

    def joint(self, name: str) -> str:
        """Return the joint of what is pushed, by its `name`, or that is a joint itself."""
        return self.ways[name].point if name in self.ways else name

    def coordinate(self, name: str, direction: float | None = None) -> WorkCoordinate:
        """Return on what a load on something named does work.

        Parameters
        ----------
        name : str
            The name.
        direction : float, rad, optional
            Of a force on a joint, in the machine.
        """
        if direction is not None:
            return PointWay(self.joint(name), GROUND, cmath.exp(1j * direction))
        if self.sorts[name] == Sort.MEMBER:
            return MemberTurn(name)
        return self.ways.get(name) or NamedCoordinate(name)


@dataclass
class LoadedLinkage:
    """A linkage on which something acts.

    Parameters
    ----------
    linkage : Linkage
        With the centres of all masses.
    acted : Acted
        What its names are.
    speed : float, rad/s, optional
        Of the master.
    pull : complex, m/s2
        Of gravity; 0 without.
    knots : list of float, rad
        Where efforts are not smooth, besides the ends of where they act; they add them.
    """

    linkage: Linkage
    acted: Acted
    speed: float | None
    pull: complex
    knots: list[float] = field(default_factory=list)

    def measures(self, on: WorkCoordinate) -> TrackMeasures:
        """Return the measures of the place of something loaded."""

        def track(q: Array, order: int) -> Jet:
            found = on.place(WorkState(self.linkage, q, order, self.speed))
            return Jet([one + np.zeros(q.shape) for one in found.c])  # where it rests, too

        return TrackMeasures(track, self.linkage.knots, self.linkage.closed, highest=0)


class MachineAction(WithNames):
    """What acts on a mechanism: a load, a mass or a spring; the table of its file is the thing."""

    moved: ClassVar[str] = ""
    """Its key with the name of what must move; empty without."""

    def unfit(self, acted: Acted) -> Iterator[Fault]:
        """Yield keys that do not suit what it acts on, with their places in its table."""
        raise NotImplementedError

    def points(self, acted: Acted, number: int) -> Iterator[Element]:
        """Yield the joints that it needs in the linkage.

        Parameters
        ----------
        acted : Acted
            What the names in the mechanism are.
        number : int
            Of its table, from 0.
        """
        return iter(())

    def efforts(self, on: LoadedLinkage, number: int) -> Iterator[Effort]:
        """Yield what acts on a linkage.

        Parameters
        ----------
        on : LoadedLinkage
            The linkage.
        number : int
            Of its table, from 0.

        Raises
        ------
        InfeasibleError
            If it does not suit the motion.
        """
        raise NotImplementedError

    def needs_speed(self, gravity: GravitySpec) -> str:
        """Return why it needs the master's speed; empty if it does not."""
        return ""

    @property
    def damped(self) -> bool:
        """Whether it takes energy from what it stores."""
        return False


@check("loads-unused", kind=TABLES, severity="note")
def loads_unused(result: Any, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note loads, masses, springs and friction that nothing uses.

    Looks at: whether a study that uses them is asked for.
    """
    several = {title: one for title, one in vars(result.design).items() if isinstance(one, tuple)}
    given = [title for title, one in several.items() if one and isinstance(one[0], MachineAction)]
    if given and not {"torque", "forces", "balance"} & {*result.design.output.studies}:
        yield Remark(
            "Only the studies torque, forces and balance use loads, masses and springs: "
            'gearcam torque FILE, or studies = ["torque"] in [output].',
            ", ".join(given),
        )
    if result.design.rotor and "balance" not in result.design.output.studies:
        yield Remark(
            "Only the study of balance has rotors: gearcam balance FILE, or "
            'studies = ["balance"] in [output].',
            "rotor",
        )
    rubs = result.design.bearing or result.design.friction != type(result.design.friction)()
    if rubs and "forces" not in result.design.output.studies:
        yield Remark(
            'Only the study of forces has friction: gearcam forces FILE, or studies = ["forces"].',
            "bearing" if result.design.bearing else "friction",
        )
