"""Ways and angles on which forces and moments do work, at angles of a linkage's driver."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.bonds import SlidingJoint, Wrench
from gearcam.linkages.elements import Carriers
from gearcam.linkages.known import GROUND, Known
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.plane import dot, square, turning
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.jets import Jet


class WorkState:
    """A linkage at some angles of its driver, at an even speed, and a displacement from there.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    q : (n,) array, rad
        The driver's angles.
    order : int
        Highest derivative of forces; 0 with another displacement.
    speed : float, rad/s, optional
        Of the driver.
    displaced : Linkage, optional
        One with the same places, in which the displacement goes on; the linkage itself if None.
    """

    def __init__(
        self,
        linkage: Linkage,
        q: Array,
        order: int,
        speed: float | None,
        displaced: Linkage | None = None,
    ) -> None:
        self.linkage, self.order, self.speed = linkage, order, speed
        self.q = np.asarray(q, dtype=float)
        self.known = linkage.at(self.q, order + 2)
        self.displaced = self.known if displaced is None else displaced.at(self.q, order + 1)

    @property
    def angle(self) -> Jet:
        """The driver's angle itself, rad."""
        return Jet.variable(self.q, self.order)


class WorkCoordinate(ABC):
    """A way or an angle on which a force or a moment does work."""

    @abstractmethod
    def place(self, state: WorkState) -> Jet:
        """Return the way, mm, or the angle, rad."""

    @abstractmethod
    def rate(self, known: Known, order: int) -> Jet:
        """Return its derivative by the driver's angle.

        Parameters
        ----------
        known : Known
            The solved linkage.
        order : int
            Highest derivative of the derivative.
        """

    @abstractmethod
    def wrenches(self, held: HeldMembers, force: Plane) -> Iterator[tuple[str, Wrench]]:
        """Yield what a force on it exerts on members, by their names.

        Parameters
        ----------
        held : HeldMembers
            The members.
        force : (n,) array, N or N mm
            As of an effort on this coordinate; complex on a point's place.
        """


class HeldMembers:
    """The members of a solved linkage, for forces on them.

    Parameters
    ----------
    known : Known
        What is solved.
    carriers : mapping of str to str
        The members on which joints and frames are, by names.
    slides : mapping of str to SlidingJoint
        The guides by the quantities that are places on them.
    """

    def __init__(
        self, known: Known, carriers: Carriers, slides: Mapping[str, SlidingJoint]
    ) -> None:
        self.known, self.carriers, self.slides = known, carriers, slides

    def force(self, joint: str, force: Plane, member: str = "") -> Iterator[tuple[str, Wrench]]:
        """Yield a `force` at a `joint`, (n,), N, on a `member`, or on that which carries it."""
        yield member or self.carriers[joint], Wrench.at(self.known.place(joint), force)


@dataclass(frozen=True)
class NamedCoordinate(ShortRepr, WorkCoordinate):
    """The place of a joint, on which a force of any direction does work, or a quantity.

    Parameters
    ----------
    name : str
        A joint, a shaft, or the way of a slide.
    member : str
        Of several in a joint that on which forces act; that which carries the joint if empty.
    """

    name: str
    member: str = ""

    def place(self, state: WorkState) -> Jet:
        """Return the place, complex, mm, the turn, rad, or the way, mm."""
        return state.known.jet(self.name).upto(state.order)

    def rate(self, known: Known, order: int) -> Jet:
        """Return its derivative, of what is `known`, to an `order`."""
        return known.jet(self.name).upto(order + 1).differentiated()

    def wrenches(self, held: HeldMembers, force: Plane) -> Iterator[tuple[str, Wrench]]:
        """Yield a `force` at a joint `held`, or along a guide; a drive's own part is no member."""
        if self.name in held.carriers:
            yield from held.force(self.name, force, self.member)
        elif self.name in held.slides:
            guide = held.slides[self.name]
            unit = guide.along(held.known)
            yield guide.on, unit.times(force.real)
            yield guide.by, unit.times(-force.real)


@dataclass(frozen=True)
class PointWay(ShortRepr, WorkCoordinate):
    """The way of a point in one direction.

    Parameters
    ----------
    point : str
        A joint.
    guide : str
        Frame from whose origin the way counts, and from whose x axis the direction does.
    direction : complex
        Of size 1, in that frame.
    slide : str
        Quantity that is the place; empty for the point's own.
    """

    point: str
    guide: str = GROUND
    direction: complex = 1 + 0j
    slide: str = ""

    def place(self, state: WorkState) -> Jet:
        """Return the place from the guide's origin, mm."""
        if self.slide:
            return state.known.jet(self.slide).upto(state.order)
        guide = state.known.frame(self.guide)
        way = state.known.jet(self.point) - guide.origin
        return dot(guide.direction * self.direction, way).upto(state.order)

    def rate(self, known: Known, order: int) -> Jet:
        """Return the point's derivative along the guide, of what is `known`, to an `order`."""
        along = known.frame(self.guide).direction.upto(order) * self.direction
        return dot(along, NamedCoordinate(self.point).rate(known, order))

    def wrenches(self, held: HeldMembers, force: Plane) -> Iterator[tuple[str, Wrench]]:
        """Yield the `force` at the point of a member that is `held`."""
        along = held.known.direction(self.guide) * self.direction
        slides = held.slides[self.slide].on if self.slide in held.slides else ""
        yield from held.force(self.point, force * along, slides)


@dataclass(frozen=True)
class MemberTurn(ShortRepr, WorkCoordinate):
    """The angle of a member, against another one.

    Parameters
    ----------
    member : str
        Its frame.
    base : str
        Frame of the member from which it counts.
    """

    member: str
    base: str = GROUND

    def place(self, state: WorkState) -> Jet:
        """Return the angle without jumps, rad."""

        def angle(name: str) -> Jet:
            return state.linkage.real_track(f"{name}.angle", state.q, state.order)

        return angle(self.member) if self.base == GROUND else angle(self.member) - angle(self.base)

    def rate(self, known: Known, order: int) -> Jet:
        """Return the derivative of the angle, of what is `known`, to an `order`."""

        def turn(name: str) -> Jet:
            return turning(known.frame(name).direction.upto(order + 1))

        return turn(self.member) if self.base == GROUND else turn(self.member) - turn(self.base)

    def wrenches(self, held: HeldMembers, force: Plane) -> Iterator[tuple[str, Wrench]]:
        """Yield the moment, `force`, on both members that are `held`."""
        yield held.carriers[self.member], Wrench.couple(force.real)
        yield held.carriers[self.base], Wrench.couple(-force.real)


@dataclass(frozen=True)
class JointDistance(ShortRepr, WorkCoordinate):
    """The distance of two joints.

    Parameters
    ----------
    first, second : str
        The joints.
    """

    first: str
    second: str

    def _distance(self, known: Known, order: int) -> Jet:
        way = known.jet(self.second) - known.jet(self.first)
        return jets.sqrt(square(way.upto(order)))

    def place(self, state: WorkState) -> Jet:
        """Return the distance, mm."""
        return self._distance(state.known, state.order)

    def rate(self, known: Known, order: int) -> Jet:
        """Return its derivative, of what is `known`, to an `order`."""
        return self._distance(known, order + 1).differentiated()

    def wrenches(self, held: HeldMembers, force: Plane) -> Iterator[tuple[str, Wrench]]:
        """Yield the `force` at both joints `held`, which it pushes apart."""
        way = held.known.place(self.second) - held.known.place(self.first)
        along = force * way / np.abs(way)
        yield from held.force(self.second, along)
        yield from held.force(self.first, -along)


class Acting:
    """A coordinate at some angles of the driver, for laws of forces.

    Parameters
    ----------
    state : WorkState
        The linkage there.
    coordinate : WorkCoordinate
        On which the force does work.
    """

    def __init__(self, state: WorkState, coordinate: WorkCoordinate) -> None:
        self._state, self._coordinate = state, coordinate

    @property
    def angle(self) -> Jet:
        """The driver's angle, rad."""
        return self._state.angle

    @property
    def place(self) -> Jet:
        """The way, mm, or the angle, rad."""
        return self._coordinate.place(self._state)

    @property
    def rate(self) -> Jet:
        """Its derivative by the driver's angle."""
        found = self._coordinate.rate(self._state.known, self._state.order)
        return found + np.zeros(self._state.q.shape)  # where it is a constant, too

    @property
    def sense(self) -> Array:
        """Its direction of motion, 1 or -1; where it reverses that behind."""
        state = self._state
        found = self._coordinate.rate(state.known, 1)
        rate, bend = (np.asarray(one) + np.zeros(state.q.shape) for one in found.c[:2])
        return np.sign(np.where(rate == 0.0, bend, rate))

    @property
    def velocity(self) -> Jet:
        """Its velocity, mm/s or rad/s; 0 if the driver has no speed."""
        return self.rate * (self._state.speed or 0.0)
