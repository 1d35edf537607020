"""The parts of a linkage: each is solved from those before, and gives joints and frames by name.

Names are those of joints (points), of frames (members and guides) and of quantities (the turn of a
shaft, rad; the way of a slide, mm). ``ground`` is a frame that every linkage has. A slide's place
on its guide has the name of its dyad's joint with a word behind: see `Dyad`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.dyads import DYADS, DyadType, Lengths, Passage, Sign, Solved
from gearcam.linkages.known import GROUND, Known
from gearcam.linkages.plane import Frame, towards, turned
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet

if TYPE_CHECKING:
    from gearcam.linkages.bonds import Bond

Law = Callable[[Array, int], Jet]
"""``law(q, order)``: turn of a shaft, rad, or way of a slide, mm, over the driver's angle."""

Carriers = Mapping[str, str]
"""Members by the names of the joints, frames and members that are fixed to them."""


class Dimension(NamedTuple):
    """A length or an angle of a part.

    Attributes
    ----------
    name : str
        As in ``rod.length``.
    field : str
        Of the part.
    angle : bool
        Whether it is an angle, rad; else a length, mm.
    unit : complex
        What one of it adds to the field: 1j of the y of a point.
    """

    name: str
    field: str
    angle: bool = False
    unit: complex = 1.0


def _of_point(name: str) -> Iterator[Dimension]:
    """Yield the coordinates of a point."""
    yield Dimension(f"{name}.x", "at")
    yield Dimension(f"{name}.y", "at", unit=1j)


class Element(ABC):
    """A part of a linkage."""

    needing: ClassVar[tuple[str, ...]] = ()
    giving: ClassVar[tuple[str, ...]] = ("name",)
    """Its fields with the names that it needs, and with those that it adds."""

    @property
    def needs(self) -> tuple[str, ...]:
        """Names that it needs."""
        return tuple(getattr(self, field) for field in self.needing)

    @property
    def gives(self) -> tuple[str, ...]:
        """Names that it adds."""
        return tuple(getattr(self, field) for field in self.giving)

    @abstractmethod
    def solve(self, known: Known) -> None:
        """Add what it gives to what is `known`."""

    def carried(self, carriers: Carriers) -> Carriers:
        """Return on which members the joints and frames are that it gives.

        Parameters
        ----------
        carriers : mapping of str to str
            The same of what it needs.
        """
        del carriers
        return {}

    def dimensions(self) -> Iterator[Dimension]:
        """Yield its lengths and angles, which may deviate."""
        yield from ()

    def deviated(self, dimension: Dimension, by: Jet | float) -> Element:
        """Return it with a deviation of one of its dimensions.

        Parameters
        ----------
        dimension : Dimension
            One of `dimensions`.
        by : Jet or float, mm or rad
            How much it is larger.
        """
        value = getattr(self, dimension.field)
        return replace(self, **{dimension.field: value + by * dimension.unit})  # pyright: ignore[reportArgumentType]

    def bonds(self, carriers: Carriers) -> Iterator[Bond]:
        """Yield what joins its members to others, and drives them.

        Parameters
        ----------
        carriers : mapping of str to str
            Members of the joints and frames that it needs and gives.
        """
        del carriers
        yield from ()

    def knots_with(self, track: Callable[[str, Array, int], Jet], knots: Array) -> Array:
        """Return the knots of its linkage with its own: where its motion is not smooth.

        Parameters
        ----------
        track : callable
            ``track(name, q, order) -> Jet``: a quantity over the driver's angle.
        knots : (k,) array, rad
            Of the linkage: the driver's angles from the first to the last one.
        """
        del track
        return knots

    def room(self, known: Known) -> tuple[Jet, ...]:
        """Return shares that are 0 or more where it closes; none if it always does."""
        del known
        return ()

    def left(self, known: Known) -> tuple[Jet, ...]:
        """Return what is left before it is singular, of which these are shares."""
        return self.room(known)

    def rounding(self, known: Known) -> tuple[Array, ...]:
        """Return which of these shares are none but for rounding."""
        return tuple(np.full(known.q.shape, _ROUNDING) for _ in self.room(known))


@dataclass(frozen=True, eq=False)
class GivenMotion(ShortRepr, Element):
    """A shaft that turns, or a slide's way: a quantity that is given.

    Parameters
    ----------
    name : str
        Of the quantity.
    law : callable
        ``law(q, order) -> Jet``.
    """

    name: str
    law: Law

    def solve(self, known: Known) -> None:
        """Add the quantity."""
        known.given[self.name] = self.law(known.q, known.order)


@dataclass(frozen=True, eq=False)
class MemberPoint(ShortRepr, Element):
    """A point of a member, or a joint that stands still.

    Parameters
    ----------
    name : str
        Of the point.
    on : str
        Frame of the member; the ground if it stands still.
    at : complex, mm
        The point in that frame.
    """

    needing = ("on",)

    name: str
    at: complex
    on: str = GROUND

    def solve(self, known: Known) -> None:
        """Add the point."""
        known.given[self.name] = known.frame(self.on).at(self.at)

    def carried(self, carriers: Carriers) -> Carriers:
        """Return its member (see `Element`)."""
        return {self.name: carriers[self.on]}

    def dimensions(self) -> Iterator[Dimension]:
        """Yield its coordinates."""
        yield from _of_point(self.name)


@dataclass(frozen=True, eq=False)
class GuideLine(ShortRepr, Element):
    """A straight guide on a member or on the ground.

    Parameters
    ----------
    name : str
        Of its frame: the origin from which places on it count, and its direction.
    at : complex, mm
        Its origin, in the frame of `on`.
    direction : float, rad
        From the x axis of `on`.
    on : str
        Frame of the member that carries it.
    """

    needing = ("on",)

    name: str
    at: complex
    direction: float
    on: str = GROUND

    def solve(self, known: Known) -> None:
        """Add its frame."""
        carrier = known.frame(self.on)
        direction = carrier.direction * turned(self.direction)
        known.given[self.name] = Frame(carrier.at(self.at), direction)

    def carried(self, carriers: Carriers) -> Carriers:
        """Return its member (see `Element`)."""
        return {self.name: carriers[self.on]}

    def dimensions(self) -> Iterator[Dimension]:
        """Yield the coordinates of its origin, and its direction."""
        yield from _of_point(self.name)
        yield Dimension(f"{self.name}.direction", "direction", angle=True)


@dataclass(frozen=True, eq=False)
class Crank(ShortRepr, Element):
    """A member that a shaft turns.

    Parameters
    ----------
    name : str
        Of the member: its frame begins in the shaft, x runs towards its joint.
    shaft : str
        Quantity: the shaft's turn, rad.
    center : str
        Joint in which the shaft stands.
    joint : str
        Name of its joint.
    length : float, mm
        From the shaft to the joint.
    start : float, rad
        Its direction where the shaft's turn is 0.
    """

    needing = ("shaft", "center")
    giving = ("name", "joint")

    name: str
    shaft: str
    center: str
    joint: str
    length: float
    start: float = 0.0

    def solve(self, known: Known) -> None:
        """Add the member and its joint."""
        direction = towards(known.jet(self.shaft) + self.start)
        frame = Frame(known.jet(self.center), direction)
        known.given[self.name] = frame
        known.given[self.joint] = frame.at(self.length)

    def carried(self, carriers: Carriers) -> Carriers:
        """Return itself (see `Element`)."""
        del carriers
        return {self.name: self.name, self.joint: self.name}

    def bonds(self, carriers: Carriers) -> Iterator[Bond]:
        """Yield its bearing and its shaft (see `Element`)."""
        from gearcam.linkages.bonds import Hinge, ShaftDrive  # motion needs none

        ends = {"on": self.name, "by": carriers[self.center]}
        yield Hinge(name=self.center, place=self.center, **ends)
        # turns are those in the machine: a drive on a member is held by the frame
        yield ShaftDrive(name=self.shaft, shaft=self.shaft, on=self.name, by=GROUND)

    def dimensions(self) -> Iterator[Dimension]:
        """Yield its length, and its angle on the shaft."""
        yield Dimension(f"{self.name}.length", "length")
        yield Dimension(f"{self.name}.angle", "start", angle=True)


@dataclass(frozen=True, eq=False)
class WoundWay(ShortRepr, Element):
    """The way of what a wheel pulls by a chain or a rope, or a pinion by a rack.

    Parameters
    ----------
    name : str
        Of the quantity, mm.
    shaft : str
        Quantity: the wheel's turn, rad.
    radius : float, mm
        Of the wheel, to the chain's middle; negative if turning clockwise winds up.
    """

    needing = ("shaft",)

    name: str
    shaft: str
    radius: float

    def solve(self, known: Known) -> None:
        """Add the way."""
        known.given[self.name] = known.jet(self.shaft) * self.radius

    def dimensions(self) -> Iterator[Dimension]:
        """Yield the wheel's radius; larger is away from 0."""
        yield Dimension(f"{self.name}.radius", "radius", unit=math.copysign(1.0, self.radius))


@dataclass(frozen=True, eq=False)
class PushedSlide(ShortRepr, Element):
    """A member that is pushed along a guide.

    Parameters
    ----------
    name : str
        Of the member: its frame begins in its place on the guide, x is along the guide.
    way : str
        Quantity: its place on the guide, mm.
    guide : str
        Frame of the guide.
    joint : str
        Name of its joint: the frame's origin.
    """

    needing = ("way", "guide")
    giving = ("name", "joint")

    name: str
    way: str
    guide: str
    joint: str

    def solve(self, known: Known) -> None:
        """Add the member and its joint."""
        guide = known.frame(self.guide)
        place = guide.origin + guide.direction * known.jet(self.way)
        known.given[self.name] = Frame(place, guide.direction)
        known.given[self.joint] = place

    def carried(self, carriers: Carriers) -> Carriers:
        """Return itself (see `Element`)."""
        del carriers
        return {self.name: self.name, self.joint: self.name}

    def bonds(self, carriers: Carriers) -> Iterator[Bond]:
        """Yield its guide and what pushes it (see `Element`)."""
        from gearcam.linkages.bonds import PushDrive, SlidingJoint

        ends = {"on": self.name, "by": carriers[self.guide], "place": self.joint}
        yield SlidingJoint(name=self.guide, guide=self.guide, slide=self.way, **ends)
        yield PushDrive(name=self.way, guide=self.guide, way=self.way, **ends)


_ROUNDING: Final = 1e-12
"""Share of what a part needs to close that is rounding, where the part does not tell it."""

REACH: Final = 0.1
"""Largest angle from a change point up to which a dyad may be solved from there, rad."""

_AT: Final = 1e-12
"""Distance by rounding of an angle from a change point, rad."""

BRANCH, MOTION = "branch", "motion"
"""What a dyad keeps at a change point, where both of its positions meet."""


@dataclass(frozen=True, eq=False)
class Dyad(ShortRepr, Element):
    """Two members and three joints that close a loop (see `gearcam.linkages.dyads`).

    Parameters
    ----------
    type : str
        RRR, RRT, TRR, RTR1, RTR2, TRT, RTT or TTR.
    first, second : str
        The joint or guide at which member 1, and member 2 begins.
    joint : str
        Name of the joint between its members. The places of its slides have this name and
        ``.guide1``, ``.guide2``, ``.member1`` or ``.member2`` behind it.
    members : two str
        Names of its members.
    lengths : Lengths
        Its sizes.
    sign : float
        +1 or -1: which of its positions.
    driven : str, optional
        Quantity that is added to the first length, mm: a cylinder between the outer joints of RRR.
    keeps : str
        ``branch`` or ``motion``: what stays at a change point.
    changes : tuple of float, rad
        Its change points, rising, as `gearcam.linkages.closing` finds them.
    period : float, rad, optional
        After which these repeat.
    reach : float, rad
        How far from them the motion is smooth at either side.
    """

    type: str
    first: str
    second: str
    joint: str
    members: tuple[str, str]
    lengths: Lengths
    sign: float = 1.0
    driven: str | None = None
    keeps: str = BRANCH
    changes: tuple[float, ...] = ()
    period: float | None = None
    reach: float = REACH

    @property
    def kind(self) -> DyadType:
        """What its type begins at and how it is solved."""
        return DYADS[self.type]

    @property
    def needs(self) -> tuple[str, ...]:
        """What its members begin at, and the quantity that drives a length."""
        return (self.first, self.second, *([self.driven] if self.driven else []))

    @property
    def gives(self) -> tuple[str, ...]:
        """Its joint, its members and the places of its slides."""
        return (self.joint, *self.members, *(f"{self.joint}.{one}" for one in self.kind.slides))

    def solution(self, known: Known) -> Solved:
        """Return its position from what is `known`."""
        ends = (
            known.frame(name) if guided else known.jet(name)
            for name, guided in zip((self.first, self.second), self.kind.guides, strict=True)
        )
        return self.kind.solve(*ends, self.sizes(known), self.signs(known.q))

    def sizes(self, known: Known) -> Lengths:
        """Return its sizes; a length that is driven is a jet."""
        if self.driven is None:
            return self.lengths
        return self.lengths._replace(first=known.jet(self.driven) + self.lengths.first)

    def signs(self, q: Array) -> Sign:
        """Return its sign at angles of the driver `q`, rad."""
        if not self.changes:
            return self.sign
        own = np.array(self.changes)
        turns, rest = (0.0, q) if self.period is None else np.divmod(q, self.period)
        around = self.period or np.inf
        edges = np.concatenate([[own[-1] - around], own, [own[0] + around]])
        passed = np.searchsorted(own, rest, "right")
        before, behind = rest - edges[passed], rest - edges[passed + 1]
        near = np.minimum(before, -behind) <= self.reach
        past = np.where(near, np.where(before <= -behind, before, behind), np.nan)
        if self.keeps == BRANCH:
            # an angle of another turn has rounding; one of this turn is before or behind, exactly
            at = np.where(turns == 0.0, 0.0, _AT)
            return Passage(np.where(past < -at, -self.sign, self.sign), past)
        # next to a change point the sign behind it, also before it, where the root is negative
        count = turns * own.size + passed + (past < 0.0) - np.searchsorted(own, _AT, "right")
        return Passage(np.where(count % 2, -self.sign, self.sign), past)

    def room(self, known: Known) -> tuple[Jet, ...]:
        """Return what is 0 or more where it closes (see `Solved`)."""
        return self.solution(known).room

    def left(self, known: Known) -> tuple[Jet, ...]:
        """Return what is left before it is singular (see `Solved`), mm2."""
        return self.solution(known).left

    def rounding(self, known: Known) -> tuple[Array, ...]:
        """Return which shares are none but for rounding (see `Solved`)."""
        return self.solution(known).rounding

    def solve(self, known: Known) -> None:
        """Add its joint, its members and the places of its slides."""
        solved = self.solution(known)
        known.solved[self.joint] = solved
        known.given[self.joint] = solved.joint
        known.given |= dict(zip(self.members, solved.frames, strict=True))
        known.given |= {f"{self.joint}.{name}": one for name, one in solved.slides.items()}

    def dimensions(self) -> Iterator[Dimension]:
        """Yield its lengths, and the angles between its members and guides; not those that are 0.

        A length that is 0 is none: what slides has its joint on the guide.
        """
        sizes = self.lengths
        for member, field in zip(self.members, ("first", "second"), strict=True):
            if getattr(sizes, field) != 0.0:
                yield Dimension(f"{member}.length", field)
        for field in ("beta", "gamma1", "gamma2"):
            if getattr(sizes, field) != 0.0:
                yield Dimension(f"{self.joint}.{field}", field, angle=True)

    def deviated(self, dimension: Dimension, by: Jet | float) -> Dyad:
        """Return it with a `dimension` that is larger `by` some (see `Element`)."""
        value = getattr(self.lengths, dimension.field)
        return replace(self, lengths=self.lengths._replace(**{dimension.field: value + by}))

    def carried(self, carriers: Carriers) -> Carriers:
        """Return its members; the joint between is on the first one, or on what slides.

        It is on the second one, too, if a cylinder is the first: it is not fixed to that.
        """
        del carriers
        slides = self.kind.guides == (False, True) and self.kind.guiding is None
        last = self.kind.guiding == 0 or slides or self.driven is not None
        own = self.members[1 if last else 0]
        return {self.joint: own, **{one: one for one in self.members}}

    def bonds(self, carriers: Carriers) -> Iterator[Bond]:
        """Yield its three joints (see `Element`)."""
        from gearcam.linkages.bonds import Hinge, SlidingJoint

        ends = zip(self.members, (self.first, self.second), self.kind.guides, strict=True)
        for number, (member, end, guided) in enumerate(ends, start=1):
            own = {"name": end, "on": member, "by": carriers[end]}
            if guided:
                slide = f"{self.joint}.guide{number}"
                yield SlidingJoint(guide=end, place=member, slide=slide, **own)
            else:
                yield Hinge(place=end, **own)
        (first, second), guiding = self.members, self.kind.guiding
        if guiding is None:
            own = {"name": self.joint, "place": self.joint}
            yield Hinge(on=second, by=first, driven=self.driven or "", **own)
        else:
            guide, slider = self.members[guiding], self.members[1 - guiding]
            own = {"name": self.joint, "place": self.joint, "on": slider, "by": guide}
            yield SlidingJoint(guide=guide, slide=f"{self.joint}.member{guiding + 1}", **own)
