"""What loads, masses and springs find in the mechanism on which they act."""

from __future__ import annotations

import cmath
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.kinds.mechanism.keys import Sort
from gearcam.linkages.coordinates import (
    MemberTurn,
    NamedCoordinate,
    PointWay,
    WorkCoordinate,
    WorkState,
)
from gearcam.linkages.known import GROUND
from gearcam.linkages.measures import TrackMeasures
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet

if TYPE_CHECKING:
    from gearcam.linkages.linkage import Linkage


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
