"""The driver's moment by virtual work: what loads, weights, springs and masses ask of a shaft.

An *effort* is a force with the point, the way or the angle on which it does work. With the driver's
angle q the moment that balances it is ``-F*x'``, x' the derivative of that way by q: exact, since
the linkage gives its derivatives exactly, and without any reaction in a joint. A moving mass has
the force ``-m*a`` and the moment ``-J*alpha''``, at an even speed of the driver ``a = P''*w^2``.

The moment on any other shaft is found in the same way, from the displacement in which this shaft
alone turns: forces and accelerations are those of the true motion.

Nothing is lost to friction.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.linkages.elements import GROUND, Dyad, Element, GivenMotion, Known, Law
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.measures import Extremes, Peak
from gearcam.linkages.plane import cross, dot, square
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array
from gearcam.numeric.chebyshev import FIRST_CUTS, NotSmoothError, expand
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import extremes

LOADS, INERTIA, GRAVITY, SPRINGS = "loads", "inertia", "gravity", "springs"
PARTS: Final = (LOADS, INERTIA, GRAVITY, SPRINGS)
"""What efforts come from."""

_MILLI: Final = 1e-3
"""N over kg mm/s2."""

_KILO: Final = 1e3
"""N mm over kg m2/s2."""

_BESIDE: Final = 1e-7
"""Distance from a knot at which its sides are compared, as a share of the range."""

_JUMP: Final = 1e-4
"""Difference there, as a share of the largest reduced inertia, that is a jump."""

_CLOSE: Final = 1e-4
"""Distance from a change point within which a displacement is read from a series, rad."""

_NOTHING: Final = 1e-6
"""Moment that is rounding only, N mm."""

_PROBES: Final = 193
"""The driver's angles at which it is looked for."""

_AT_KNOT: Final = 1e-9
"""Distance from a knot, rad, within which a place is called by it."""

_BACK: Final = 1e-7
"""Change of a place or an angle over a cycle, as a share, up to which it is as before."""

_NODES: Final = 16
"""Points of Gauss' rule in each cell of an integral."""

_RESOLVED: Final = 1e-7
"""Error of polynomials of degree 8 on cells, over the largest moment."""


class WorkState:
    """A linkage at some angles of its driver, at an even speed.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    q : (n,) array, rad
        The driver's angles.
    order : int
        Highest derivative of forces.
    speed : float, rad/s, optional
        Of the driver.
    """

    def __init__(self, linkage: Linkage, q: Array, order: int, speed: float | None) -> None:
        self.linkage, self.order, self.speed = linkage, order, speed
        self.q = np.asarray(q, dtype=float)
        self.known = linkage.at(self.q, order + 2)

    @property
    def angle(self) -> Jet:
        """The driver's angle itself, rad."""
        return Jet.variable(self.q, self.order)


def rate(x: Jet, order: int) -> Jet:
    """Return the derivative of `x`, with its own derivatives to an `order`."""
    return Jet(x.c[: order + 2]).differentiated()


def turning(known: Known, member: str, order: int) -> Jet:
    """Return the derivative of the angle of a `member`, with its derivatives to an `order`.

    Parameters
    ----------
    known : Known
        The solved linkage.
    member : str
        Its frame.
    order : int
        Highest derivative.
    """
    direction = Jet(known.frame(member).direction.c[: order + 2])
    return cross(direction.shortened(), direction.differentiated())


@dataclass(frozen=True)
class ActiveRanges(ShortRepr):
    """Ranges of the driver in which a load acts.

    Parameters
    ----------
    ranges : sequence of (float, float), rad
        Begin and end of each, begin not above end.
    period : float, rad, optional
        After which they repeat.
    """

    ranges: Sequence[tuple[float, float]]
    period: float | None = None

    def at(self, q: Array) -> Array:
        """Return 1 at angles `q` at which it acts, else 0; ends belong to what follows them."""
        found = np.zeros(np.shape(q), dtype=bool)
        for begin, end in self.ranges:
            if self.period is None:
                found |= (begin <= q) & (q < end)
            else:
                # angles are compared as they are: a remainder would blur the ends
                first = np.floor((q - begin) / self.period)
                for turn in (first - 1, first, first + 1):
                    shift = turn * self.period
                    found |= (begin + shift <= q) & (q < end + shift)
        return found.astype(float)

    def ends(self, low: float, high: float) -> Array:
        """Return where it begins and ends between the angles `low` and `high`, rad."""
        ends = np.array([end for one in self.ranges for end in one])
        if self.period is not None:
            turns = range(
                math.floor((low - ends.max()) / self.period),
                math.ceil((high - ends.min()) / self.period) + 1,
            )
            ends = np.concatenate([ends + turn * self.period for turn in turns])
        return ends[(ends > low) & (ends < high)]


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
            return Jet(state.known.jet(self.slide).c[: state.order + 1])
        guide = state.known.frame(self.guide)
        way = state.known.jet(self.point) - guide.origin
        return Jet(dot(guide.direction * self.direction, way).c[: state.order + 1])

    def rate(self, known: Known, order: int) -> Jet:
        """Return the point's derivative along the guide, of what is `known`, to an `order`."""
        along = Jet(known.frame(self.guide).direction.c[: order + 1]) * self.direction
        return dot(along, rate(known.jet(self.point), order))


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
        own = turning(known, self.member, order)
        return own if self.base == GROUND else own - turning(known, self.base, order)


@dataclass(frozen=True)
class ShaftTurn(ShortRepr, WorkCoordinate):
    """The turn of a shaft, or the way of a slide that is given.

    Parameters
    ----------
    shaft : str
        The quantity.
    """

    shaft: str

    def place(self, state: WorkState) -> Jet:
        """Return the turn, rad, or the way, mm."""
        return Jet(state.known.jet(self.shaft).c[: state.order + 1])

    def rate(self, known: Known, order: int) -> Jet:
        """Return its derivative, of what is `known`, to an `order`."""
        return rate(known.jet(self.shaft), order)


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
        return jets.sqrt(square(Jet(way.c[: order + 1])))

    def place(self, state: WorkState) -> Jet:
        """Return the distance, mm."""
        return self._distance(state.known, state.order)

    def rate(self, known: Known, order: int) -> Jet:
        """Return its derivative, of what is `known`, to an `order`."""
        return self._distance(known, order + 1).differentiated()


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
    def velocity(self) -> Jet:
        """Its velocity, mm/s or rad/s; 0 if the driver has no speed."""
        return self.rate * (self._state.speed or 0.0)


ForceLaw = Callable[[Acting], "Jet | float"]
"""``law(acting)``: force, N, or moment, N mm, in the coordinate's positive direction."""


class Effort(ABC):
    """Forces and moments with the ways on which they do work."""

    part: str
    """What it comes from, of `PARTS`."""
    active: ActiveRanges | None = None
    """Where it acts; everywhere if None."""

    @abstractmethod
    def forces(self, state: WorkState) -> tuple[Jet, ...]:
        """Return forces, N, real or complex, and moments, N mm."""

    @abstractmethod
    def rates(self, known: Known, order: int) -> tuple[Jet, ...]:
        """Return the derivatives of their ways by the driver's angle.

        Parameters
        ----------
        known : Known
            The solved linkage.
        order : int
            Highest derivative of the derivatives.

        Returns
        -------
        tuple of Jet
            One for each of the forces, in their order.
        """


@dataclass(frozen=True)
class VectorForce(ShortRepr, Effort):
    """A force of constant size and direction at a point.

    Parameters
    ----------
    point : str
        The joint.
    force : complex, N
        In the machine's frame.
    part : str
        Of `PARTS`.
    active : ActiveRanges, optional
        Where it acts.
    """

    point: str
    force: complex
    part: str = LOADS
    active: ActiveRanges | None = None

    def forces(self, state: WorkState) -> tuple[Jet, ...]:
        """Return the force."""
        return (Jet([np.full(state.q.shape, self.force), *[0.0] * state.order]),)

    def rates(self, known: Known, order: int) -> tuple[Jet, ...]:
        """Return the point's derivative, of what is `known`, to an `order`."""
        return (rate(known.jet(self.point), order),)


@dataclass(frozen=True)
class VaryingForce(ShortRepr, Effort):
    """A force along a way, or a moment about an angle, that follows a law.

    Parameters
    ----------
    coordinate : WorkCoordinate
        On which it does work.
    law : callable
        ``law(acting)`` (see `ForceLaw`).
    part : str
        Of `PARTS`.
    active : ActiveRanges, optional
        Where it acts.
    """

    coordinate: WorkCoordinate
    law: ForceLaw
    part: str = LOADS
    active: ActiveRanges | None = None

    def forces(self, state: WorkState) -> tuple[Jet, ...]:
        """Return the force or moment."""
        found = self.law(Acting(state, self.coordinate))
        return (found if isinstance(found, Jet) else state.angle * 0.0 + found,)

    def rates(self, known: Known, order: int) -> tuple[Jet, ...]:
        """Return the derivative of the coordinate, of what is `known`, to an `order`."""
        return (self.coordinate.rate(known, order),)


@dataclass(frozen=True)
class MovedMass(ShortRepr, Effort):
    """The inertia of a member.

    Parameters
    ----------
    member : str
        Its frame, or the shaft with which it turns.
    mass : float, kg
        Its mass.
    center : str
        Joint in its centre of mass; empty if that stands still.
    inertia : float, kg m2
        Moment of inertia about its centre of mass.
    """

    member: str
    mass: float
    center: str
    inertia: float = 0.0

    part = INERTIA

    def _turn(self, known: Known, order: int) -> Jet:
        if self.member in known.given and isinstance(known.given[self.member], Jet):
            return rate(known.jet(self.member), order)
        return turning(known, self.member, order)

    def rates(self, known: Known, order: int) -> tuple[Jet, ...]:
        """Return those of angle and centre, of what is `known`, to an `order`."""
        turn = self._turn(known, order)
        return (turn, rate(known.jet(self.center), order)) if self.center else (turn,)

    def forces(self, state: WorkState) -> tuple[Jet, ...]:
        """Return ``-J*alpha''*w^2`` and ``-m*P''*w^2``; 0 without a speed."""
        square_of_speed = (state.speed or 0.0) ** 2
        factors = (-_KILO * self.inertia, -_MILLI * self.mass)
        rates = self.rates(state.known, state.order + 1)
        return tuple(
            one.differentiated() * (factor * square_of_speed)
            for one, factor in zip(rates, factors, strict=False)
        )

    def reduced(self, known: Known, order: int) -> Jet:
        """Return its moment of inertia at the driver, ``J*alpha'^2 + m*|P'|^2``, kg m2.

        Parameters
        ----------
        known : Known
            The solved linkage.
        order : int
            Highest derivative.
        """
        turn, *ways = self.rates(known, order)
        whole = turn * turn * self.inertia
        for way in ways:
            whole = whole + square(way) * (self.mass * _MILLI**2)
        return whole


def balance(effort: Effort, state: WorkState, displacement: Known | None = None) -> Jet:
    """Return the moment that balances an effort, N mm.

    Parameters
    ----------
    effort : Effort
        The effort.
    state : WorkState
        The true motion.
    displacement : Known, optional
        The displacement on which it does work; that of the driver if None. Then only values are
        found, no derivatives.

    Returns
    -------
    Jet
        Against the driver's angle; positive if the driver must drive.
    """
    order = state.order if displacement is None else 0
    rates = effort.rates(state.known if displacement is None else displacement, order)
    total = state.angle * 0.0 if displacement is None else Jet([np.zeros(state.q.shape)])
    for force, way in zip(effort.forces(state), rates, strict=True):
        total = total - dot(Jet(force.c[: order + 1]), way)
    return total if effort.active is None else total * effort.active.at(state.q)


@dataclass(frozen=True, eq=False)
class VirtualWork(ShortRepr):
    """The driver's moment, and those on other shafts.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    efforts : sequence of Effort
        What acts on it.
    speed : float, rad/s, optional
        Of the driver, even; without it masses have their weight only.
    more_knots : sequence of float, rad
        Where efforts are not smooth, besides the ends of where they act.
    """

    linkage: Linkage
    efforts: Sequence[Effort]
    speed: float | None = None
    more_knots: Sequence[float] = ()

    @cached_property
    def knots(self) -> Array:
        """The driver's angles between which the moment is smooth, rad."""
        low, high = self.linkage.span
        more = np.asarray(self.more_knots, dtype=float)
        ends = [one.active.ends(low, high) for one in self.efforts if one.active is not None]
        inner = more[(more > low) & (more < high)]
        return np.unique(np.concatenate([self.linkage.knots, inner, *ends]))

    def parts(self, q: Array, order: int = 0) -> dict[str, Jet]:
        """Return the driver's moment for each sort of effort, N mm.

        Parameters
        ----------
        q : (n,) array, rad
            The driver's angles.
        order : int
            Highest derivative by them.

        Returns
        -------
        dict of str to Jet
            By those of `PARTS` that there are.
        """
        state, found = WorkState(self.linkage, q, order, self.speed), {}
        for effort in self.efforts:
            own = balance(effort, state)
            found[effort.part] = found[effort.part] + own if effort.part in found else own
        return {part: found[part] for part in PARTS if part in found}

    def moment(self, q: Array, order: int = 0) -> Jet:
        """Return the driver's moment, N mm (see `parts`); positive where it must drive."""
        nothing = Jet.variable(q, order) * 0.0
        return sum(self.parts(q, order).values(), start=nothing)

    def on(self, shafts: Mapping[str, float], q: Array) -> Array:
        """Return what a shaft, or a slide, exerts on the linkage.

        Parameters
        ----------
        shafts : mapping of str to float
            Quantities that move in the displacement, and how far each does: the names of one shaft,
            and +1 or -1 for its positive direction.
        q : (n,) array, rad
            The driver's angles.

        Returns
        -------
        (n,) array, N mm or N
            Moment on a shaft, force on a slide, also where it stands still.
        """
        state = WorkState(self.linkage, q, 0, self.speed)
        displacement = displaced_by(self.linkage, shafts).at(q, 1)
        nothing = np.zeros(np.shape(q))
        found = (balance(effort, state, displacement).c[0] for effort in self.efforts)
        return sum((np.asarray(one) for one in found), start=nothing)

    def reduced_inertia(self, q: Array, order: int = 0) -> Jet:
        """Return the moment of inertia of all masses at the driver, kg m2 (000, 5.1.1).

        Parameters
        ----------
        q : (n,) array, rad
            The driver's angles.
        order : int
            Highest derivative by them.
        """
        known, whole = self.linkage.at(q, order + 1), Jet.variable(q, order) * 0.0
        for effort in self.efforts:
            if isinstance(effort, MovedMass):
                whole = whole + effort.reduced(known, order)
        return whole

    @cached_property
    def cells(self) -> Array:
        """The driver's angles, knots among them, between which few points tell all, rad.

        Next to places where members are nearly in line the moment has narrow peaks.
        """
        probes = np.linspace(*self.linkage.span, _PROBES)
        if np.abs(np.asarray(self.moment(probes).c[0])).max() < _NOTHING:  # rounding is not smooth
            return self.knots
        try:
            return expand(lambda q: np.asarray(self.moment(q).c[0]), self.knots, _RESOLVED).knots
        except NotSmoothError:
            return np.union1d(np.linspace(*self.linkage.span, FIRST_CUTS + 1), self.knots)

    @cached_property
    def _extremes(self) -> Extremes:
        places, values = extremes(lambda q: self.moment(q, 1).derivatives(), self.cells, cells=True)
        knot = self.knots[np.abs(places[:, None] - self.knots).argmin(axis=1)]
        return np.where(np.abs(places - knot) <= _AT_KNOT, knot, places), values

    @property
    def largest(self) -> Peak:
        """The largest moment, N mm, and its place: a root of the derivative, or a knot's side."""
        places, values = self._extremes
        top = int(values.argmax())
        return Peak(float(values[top]), float(places[top]))

    @property
    def least(self) -> Peak:
        """The least moment, N mm (see `largest`)."""
        places, values = self._extremes
        bottom = int(values.argmin())
        return Peak(float(values[bottom]), float(places[bottom]))

    @cached_property
    def _gauss(self) -> tuple[Array, Array]:
        """Places and weights of an integral over the driver's whole range."""
        points, weights = np.polynomial.legendre.leggauss(_NODES)
        begin, width = self.cells[:-1], np.diff(self.cells)
        q = begin[:, None] + width[:, None] * (0.5 + 0.5 * points)
        return q.ravel(), (0.5 * width[:, None] * weights).ravel()

    @cached_property
    def works(self) -> dict[str, tuple[float, float]]:
        """Work of the driver over its whole range for each sort of effort, N mm.

        Each with the integral of the moment's size, to which an error compares. Over a whole cycle
        weights, springs without dampers, and inertia do no work: what is found is an error.
        """
        q, weights = self._gauss
        found = {part: np.asarray(one.c[0]) for part, one in self.parts(q).items()}
        return {
            part: (float(weights @ values), float(weights @ np.abs(values)))
            for part, values in found.items()
        }

    @cached_property
    def kept(self) -> tuple[str, ...]:
        """What does no work over the whole range: what is there as at the beginning.

        A weight that a turn lifts, or a spring that a turn winds up, does work, and so do masses
        whose velocity jumps; dampers are not looked at.
        """
        state = WorkState(self.linkage, np.array(self.linkage.span), 0, self.speed)
        found = {INERTIA: not self._jolted, GRAVITY: True, SPRINGS: True}
        for effort in self.efforts:
            if isinstance(effort, VectorForce):
                place = state.known.jet(effort.point)
            elif isinstance(effort, VaryingForce):
                place = effort.coordinate.place(state)
            else:
                continue
            ends = np.asarray(place.c[0]) * np.ones(2)
            near = abs(ends[1] - ends[0]) <= _BACK * (1.0 + np.abs(ends).max())
            found[effort.part] = found.get(effort.part, True) and bool(near)
        return tuple(part for part, back in found.items() if back and part != LOADS)

    @cached_property
    def _jolted(self) -> bool:
        """Whether the velocity of a mass jumps at a knot, as at a change point."""
        near = _BESIDE * (self.knots[-1] - self.knots[0])
        before, after = self.knots[1:] - near, self.knots[:-1] + near
        places = np.concatenate([before, np.roll(after, -1)])
        sides = np.asarray(self.reduced_inertia(places).c[0]) * np.ones(places.size)
        apart = np.abs(np.diff(sides.reshape(2, -1), axis=0))
        return bool(apart.max() > _JUMP * np.abs(sides).max())

    @property
    def work(self) -> float:
        """Work of the driver over its whole range, N mm."""
        return sum(one for one, _ in self.works.values())

    @property
    def mean(self) -> float:
        """Mean moment of the driver, N mm."""
        low, high = self.linkage.span
        return self.work / (high - low)


def displaced_by(linkage: Linkage, shafts: Mapping[str, float]) -> Linkage:
    """Return a linkage in which some given motions alone go on from each place, at a constant rate.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    shafts : mapping of str to float
        Names of given motions, and their derivative by the driver's angle; that of others is 0.

    Returns
    -------
    Linkage
        With the same places at each angle of the driver.
    """

    def held(law: Law, factor: float) -> Law:
        def one(q: Array, order: int) -> Jet:
            return Jet([law(q, 0).c[0], *[factor, *[0.0] * order][:order]])

        return one

    def displaced(one: Element) -> Element:
        if isinstance(one, GivenMotion):
            return replace(one, law=held(one.law, shafts.get(one.name, 0.0)))
        # series about change points would need the derivatives that are held at 0
        return replace(one, reach=min(one.reach, _CLOSE)) if isinstance(one, Dyad) else one

    return replace(linkage, elements=tuple(map(displaced, linkage.elements)))
