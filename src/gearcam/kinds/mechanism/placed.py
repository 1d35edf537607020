"""The drives of a mechanism in the machine: what they move as functions of the master's angle.

The *place* of a drive is the angle of its driver, which is in proportion to the master's; of a
plate or a slide it is given by a formula in the master's angle.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import FEW, formatted
from gearcam.base.tolerances import DEFAULT
from gearcam.kinds.mechanism.keys import center_of, way_of
from gearcam.kinds.mechanism.moved import Moved, linear, moved_by
from gearcam.linkages.elements import GivenMotion, GuideLine, Law, MemberPoint
from gearcam.numeric.arrays import Array, Plane, distinct
from gearcam.numeric.jets import Jet, composed
from gearcam.numeric.piecewise import extremes
from gearcam.numeric.roots import bracketed_root

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.drives import MachineDrive
    from gearcam.linkages.elements import Element

_Points = TypeVar("_Points", complex, Plane)

_TURN: Final = 2.0 * math.pi

_SIDE: Final = 4.0 * float(np.finfo(float).eps)
"""Distance beside a knot, as a share of the angle, that rounding does not take away."""

_ROUNDED: Final = 1e-12
"""How far from a knot rounding may leave an angle, rad; of a travel as its share of a turn."""

_FORMULAS: Final = 32
"""Formulas, and ranges of them, of which laws and cells are kept."""

_CELLS: Final = 16
"""Cells of a turn of an even shaft: what turns with it has few harmonics."""

_NAMES: Final = ("the place", "its velocity", "its acceleration", "its jerk")
"""What a formula of a slide gives, for messages."""


@lru_cache(_FORMULAS)
def _formula(text: str) -> Law:
    from gearcam.laws.formula_syntax import parse

    made = parse(text, "q")

    def law(x: Array, order: int) -> Jet:
        found = made.evaluate(Jet.variable(x, order))
        return found if isinstance(found, Jet) else Jet.variable(x, order) * 0.0 + found

    return law


@lru_cache(_FORMULAS)
def _formula_cells(text: str, low: float, high: float) -> Array:
    """Return the cells in which an expansion of the jerk of a slide resolves it."""
    from gearcam.laws.entry import Axis
    from gearcam.laws.formula import AxisFunction
    from gearcam.laws.formula_syntax import parse

    axis = Axis(
        name="the place",
        low=low,
        high=high,
        place=lambda q: f"{formatted(math.degrees(q), FEW)} deg",
        variable="q",
    )
    function = AxisFunction(axis, parse(text, "q").evaluate, DEFAULT.expansion)
    return function.demand_smooth(_NAMES)


@dataclass(frozen=True, eq=False)
class PlacedDrive(ShortRepr):
    """A drive in the machine.

    Parameters
    ----------
    spec : MachineDrive
        Its table.
    moved : dict of str to Moved
        What it moves.
    knots : (k,) array, rad or mm
        Its places at which its laws are not smooth.
    cells : (n,) array, rad or mm
        Ends of the cells in which expansions resolve its laws, at its own places; those of a
        formula of a slide depend on the range (see `cells_in`).
    period : float, rad or mm
        After which they repeat; of an open one the end of its range, of a plate its travel.
    closed : bool
        Whether it moves on with a master that turns all the way.
    result : Result, optional
        Of the pair or the cam.
    """

    spec: MachineDrive
    moved: dict[str, Moved]
    knots: Array
    cells: Array
    period: float
    closed: bool
    result: Any = None

    def machine(self, point: _Points) -> _Points:
        """Return a point of the drive's frame in the machine, mm, or points (n,)."""
        return complex(*self.spec.at) + self.vector(point)

    def vector(self, way: _Points) -> _Points:
        """Return a direction of the drive's frame in the machine, or directions (n,)."""
        seen = way.conjugate() if self.spec.mirror else way
        return seen * cmath.exp(1j * self.spec.turn)

    def instead_of(self, other: PlacedDrive) -> PlacedDrive:
        """Return the drive standing where another one stands, with its shafts.

        Parameters
        ----------
        other : PlacedDrive
            A drive of the same sort, or any if this one is even: then all shafts turn evenly, at
            the mean ratio of a closed pair or a rack, as fast as the driver in the place of an open
            one.
        """
        moved = {}
        for word, one in other.moved.items():
            own = self.moved.get(word)
            law = own.law if own else _evenly(one.law, other)
            moved[word] = replace(one, law=law, sense=own.sense if own else one.sense)
        if self.result is not None:
            return replace(self, spec=other.spec, moved=moved)
        high = other.period if _steady(other) else _furthest(other)
        ends = np.array([0.0, high])
        return PlacedDrive(other.spec, moved, ends, _even_cells(high), high, other.closed)

    def elements(self, master: bool) -> Iterator[Element]:
        """Yield its shafts, where they stand, and the guides of its slides.

        Parameters
        ----------
        master : bool
            Whether the master's angle is its own.
        """
        side = -1.0 if self.spec.mirror else 1.0
        for word, moved in self.moved.items():
            for name in self.spec.names_of(word):
                factor = 1.0 if moved.along else side
                yield GivenMotion(name, self._over_master(moved.law, factor, master))
                if moved.along:
                    direction = cmath.phase(self.vector(moved.along))
                    yield GuideLine(way_of(name), self.machine(moved.at), direction)
                else:
                    yield MemberPoint(center_of(name), self.machine(moved.at))

    def own(self, q: Array) -> Array:
        """Return its own places, rad or mm.

        Parameters
        ----------
        q : (n,) array, rad
            The master's angles.
        """
        return np.asarray(self.place(q, 0).c[0])

    def place(self, q: Array, order: int) -> Jet:
        """Return its own places, rad or mm, with derivatives (see `own`)."""
        if self.spec.slide is not None:
            return _formula(self.spec.slide)(q, order)
        return Jet.variable(q, order) * self.spec.rate + self.spec.phase

    def _over_master(self, law: Law, factor: float, master: bool) -> Law:
        def over(q: Array, order: int) -> Jet:
            place = self.place(q, order)
            x = place.c[0] if master else self._beside_knots(place)
            return composed(place, law(np.asarray(x), order).c) * factor

        return over

    def _beside_knots(self, place: Jet) -> Array:
        """Return own places with those at knots, but for rounding, on the side that comes later."""
        x = np.asarray(place.c[0])
        if self.result is None or not (self.closed and self.knots.size and place.order):
            return x
        within = x % self.period
        nearest = np.abs(within[..., None] - self.knots).argmin(axis=-1)
        at = x - within + self.knots[nearest]
        late = at + np.copysign(_SIDE, place.c[1]) * (np.abs(at) + self.period)
        rounded = _ROUNDED * self.period / _TURN
        return np.where(np.abs(within - self.knots[nearest]) <= rounded, late, x)

    def knots_in(self, low: float, high: float) -> Array:
        """Return where its laws are not smooth.

        Parameters
        ----------
        low, high : float, rad
            The master's angles between which they are looked for.

        Returns
        -------
        (k,) array, rad
            The master's angles.
        """
        return self._within(self.knots, low, high)

    def cells_in(self, low: float, high: float) -> Array:
        """Return the ends of the cells in which expansions resolve its laws.

        Parameters
        ----------
        low, high : float, rad
            The master's angles between which they are looked for.

        Returns
        -------
        (k,) array, rad
            The master's angles, `low` and `high` among them.

        Raises
        ------
        InfeasibleError
            If a formula is not smooth, or not finite, between them.
        """
        cells = np.array([low, high])
        if self.spec.slide is not None:
            cells = _formula_cells(self.spec.slide, low, high)
        return distinct(cells, self._within(self.cells, low, high))

    @cached_property
    def places(self) -> Array:
        """The master's angles in a turn that show all that its laws do."""
        return self.places_in(0.0, _TURN)

    def places_in(self, low: float, high: float) -> Array:
        """Return the same in a range (see `cells_in`)."""
        ends = self.cells_in(low, high)
        return distinct(ends, 0.5 * (ends[1:] + ends[:-1]))

    def turns_in(self, low: float, high: float) -> tuple[Array, Array]:
        """Return where a slide or a plate turns back, and the ends (see `cells_in`).

        Returns
        -------
        q, places : (n,) arrays, rad and mm
            The master's angles, rising, and the places there; between them it goes one way.
        """

        def function(q: Array) -> list[Array]:
            return self.place(q, 1).derivatives()

        return extremes(function, _formula_cells(self.spec.slide or "", low, high), cells=True)

    def _within(self, places: Array, low: float, high: float) -> Array:
        """Return where places of its own are in a range of the master's, inside it."""
        if self.spec.slide is not None:
            found = self._passed(places, low, high)
        else:
            ends = sorted(self.own(np.array([low, high])))
            turns = range(math.floor(ends[0] / self.period), math.ceil(ends[1] / self.period) + 1)
            every = [places + k * self.period for k in turns] if self.closed else [places]
            found = (np.concatenate(every) - self.spec.phase) / self.spec.rate
        return distinct(found[(found > low) & (found < high)])

    def _passed(self, places: Array, low: float, high: float) -> Array:
        """Return where a plate passes places of its own, or turns back at them."""
        if not places.size:
            return places
        q, values = self.turns_in(low, high)
        off = values[:, None] - places
        off[np.abs(off) <= _ROUNDED * self.period / _TURN] = 0.0
        row, which = np.nonzero(off[:-1] * off[1:] < 0.0)

        def beyond(x: Array) -> Array:
            return self.own(x) - places[which]

        ends = q[row], q[row + 1]
        roots = bracketed_root(beyond, *ends, _SIDE * max(abs(low), abs(high)))
        return np.append(q[(off == 0.0).any(axis=1)], roots)


def placed(spec: MachineDrive, build: Callable[[Any], Any]) -> PlacedDrive:
    """Return a drive with the laws of its pair or its cam.

    Parameters
    ----------
    spec : MachineDrive
        Its table.
    build : callable
        ``build(design)`` returns the result of the pair or the cam.

    Returns
    -------
    PlacedDrive

    Raises
    ------
    InfeasibleError
        If the pair or the cam is impossible.
    """
    nested = spec.pair or spec.cam
    if nested is None and spec.slide is not None:
        none = np.array([])
        return PlacedDrive(spec, moved_by(spec, None), none, none, _TURN, closed=True)
    if nested is None:
        low, high = spec.span or (0.0, _TURN)
        ends = np.array([low, high])
        cells = _even_cells(high - low) + low
        return PlacedDrive(spec, moved_by(spec, None), ends, cells, high - low, spec.span is None)
    result = build(nested)
    by = result.pair.law if spec.pair is not None else result.program
    cells = distinct(by.knots, by.driven.knots if spec.pair is not None else by.cuts)
    knots, cells = (one[(one >= 0.0) & (one <= by.period)] for one in (by.knots, cells))
    moved, end = moved_by(spec, result), float(by.period)
    closed = by.closed
    if spec.slide is not None:  # it may turn back at the ends of the plate, but not pass them
        knots, cells, closed = knots[1:-1], cells[1:-1], True
    if spec.pair is not None and result.pair.on_rack:  # the wheel turns as far as it has teeth
        end, closed = float(result.centrode_angles(2)[-1]), False
        turns = by.period * np.arange(math.ceil(end / by.period))
        every = (np.add.outer(turns, one).ravel() for one in (knots, cells))
        knots, cells = (distinct(one[one < end], [0.0, end]) for one in every)
    return PlacedDrive(spec, moved, knots, cells, end, closed, result)


def _even_cells(period: float) -> Array:
    """Return cells in which searches see all that follows from a law that is even."""
    return np.linspace(0.0, period, 1 + math.ceil(_CELLS * period / _TURN))


def _steady(drive: PlacedDrive) -> bool:
    """Return whether its mean ratio is that of what stands in its place: not of an open pair."""
    return drive.closed or any(one.along for one in drive.moved.values())


def _travel(law: Law, drive: PlacedDrive) -> tuple[float, float]:
    """Return where a law of a drive begins, and how far it gets over its range."""
    first, last = np.asarray(law(np.array([0.0, drive.period]), 0).c[0])
    return float(first), float(last - first)


def _furthest(drive: PlacedDrive) -> float:
    """Return how far what is driven gets, or the driver if nothing is."""
    driven = [one for word, one in drive.moved.items() if word not in ("wheel1", "shaft")]
    return max(abs(_travel(one.law, drive)[1]) for one in driven or drive.moved.values())


def _evenly(law: Law, drive: PlacedDrive) -> Law:
    """Return the even law in the place of another one."""
    first, way = _travel(law, drive)
    return linear(way / drive.period if _steady(drive) else math.copysign(1.0, way), first)
