"""What the drives of a mechanism move: shafts and slides as functions of the master's angle.

A pair stands as assembled: wheel 1 turns by -phi1 about the origin, wheel 2 by phi2 about (A, 0); a
ring turns by -phi2. A rack moves along -y. A cam turns counter-clockwise by theta about the origin,
or clockwise; its follower is lifted along its guide, or turns about its pivot.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.tolerances import DEFAULT
from gearcam.kinds.mechanism.keys import center_of, way_of
from gearcam.linkages.elements import GivenMotion, GuideLine, Law, MemberPoint
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.drives import MachineDrive
    from gearcam.laws.displacement import Displacement
    from gearcam.linkages.elements import Element

_TURN: Final = 2.0 * math.pi

_SIDE: Final = 4.0 * float(np.finfo(float).eps)
"""Distance beside a knot, as a share of the angle, that rounding does not take away."""

_ROUNDED: Final = 1e-12
"""How far from a knot rounding may leave an angle, rad."""

_CELLS: Final = 16
"""Cells of a turn of an even shaft: what turns with it has few harmonics."""

_NAMES: Final = ("the place", "its velocity", "its acceleration", "its jerk")
"""What a formula of a slide gives, for messages."""


@dataclass(frozen=True)
class Moved(ShortRepr):
    """One thing that a drive moves, in the drive's frame.

    Parameters
    ----------
    law : callable
        ``law(x, order) -> Jet`` over the drive's own angle: its turn, rad, or its place, mm.
    at : complex, mm
        Where its shaft stands, or the zero of its places.
    along : complex
        Direction of its way; 0 for a shaft.
    arm : float, rad
        Direction of the arm of an oscillating follower at zero lift; nan if there is none.
    """

    law: Law
    at: complex = 0j
    along: complex = 0j
    arm: float = math.nan


def linear(factor: float, constant: float = 0.0) -> Law:
    """Return the law ``factor*x + constant``."""

    def law(x: Array, order: int) -> Jet:
        return Jet.variable(x, order) * factor + constant

    return law


def displaced(by: Displacement, factor: float, constant: float = 0.0) -> Law:
    """Return the law ``factor*y(x) + constant`` of a displacement y.

    Parameters
    ----------
    by : Displacement
        A ratio law or a program of lift.
    factor, constant : float
        In the units of its values.
    """

    def law(x: Array, order: int) -> Jet:
        found = by.derivatives(x, order)
        scaled = [factor * value / math.factorial(k) for k, value in enumerate(found)]
        return Jet([scaled[0] + constant, *scaled[1:]])

    return law


def moved_by(drive: MachineDrive, result: Any) -> dict[str, Moved]:
    """Return what a drive moves.

    Parameters
    ----------
    drive : MachineDrive
        Its table.
    result : GearPairResult, CamResult or None
        Of the pair or the cam.

    Returns
    -------
    dict of str to Moved
        By the words of `MachineDrive.shafts`.
    """
    if drive.pair is not None:
        return _of_pair(result)
    if drive.cam is not None:
        return _of_cam(result)
    if drive.slide is not None:
        return {"slide": Moved(_formula(drive.slide), 0j, 1 + 0j)}
    return {"shaft": Moved(linear(1.0))}


def _of_pair(result: Any) -> dict[str, Moved]:
    pair = result.pair
    law, distance = pair.law, pair.center_distance
    driver = Moved(linear(-1.0))
    if pair.on_rack:  # its law is the travel over the size that the module gives
        return {"wheel1": driver, "rack": Moved(displaced(law, -distance), 0j, 1j)}
    inside = result.design.pair.type == "internal"
    side, center = (-1.0, -distance) if inside else (1.0, distance)
    return {"wheel1": driver, "wheel2": Moved(displaced(law, side), complex(center))}


def _of_cam(result: Any) -> dict[str, Moved]:
    follower = result.cam.motions[0].follower
    program, side = result.program, -1.0 if result.design.cam.rotation == "cw" else 1.0
    shaft = Moved(linear(side))
    turn, shift = (
        float(one[0].real) + 1j * float(one[0].imag) for one in follower.moved(np.ones(1))
    )
    seen = (lambda z: z) if side > 0.0 else (lambda z: -z.conjugate())
    if not follower.angular:
        end = complex(follower.centre(np.array([follower.start]))[0]) if follower.has_centre else 0j
        return {"shaft": shaft, "follower": Moved(displaced(program, 1.0), seen(end), seen(shift))}
    spin = turn.real
    pivot = shift / (1.0 - cmath.exp(1j * spin))
    arm = math.nan
    if follower.has_centre:
        arm = cmath.phase(seen(complex(follower.centre(np.array([follower.start]))[0]) - pivot))
    return {
        "shaft": shaft,
        "follower": Moved(displaced(program, side * spin), seen(pivot), arm=arm),
    }


def _formula(text: str) -> Law:
    from gearcam.laws.formula_syntax import parse

    made = parse(text, "q")

    def law(x: Array, order: int) -> Jet:
        found = made.evaluate(Jet.variable(x, order))
        return found if isinstance(found, Jet) else Jet.variable(x, order) * 0.0 + found

    return law


def _formula_cells(text: str, low: float, high: float) -> Array:
    """Return the cells in which an expansion of the jerk of a slide resolves it."""
    from gearcam.laws.entry import Axis
    from gearcam.laws.formula import AxisFunction
    from gearcam.laws.formula_syntax import parse

    axis = Axis(
        name="the place",
        low=low,
        high=high,
        place=lambda q: f"{formatted(math.degrees(q), 6)} deg",
        variable="q",
    )
    function = AxisFunction(axis, parse(text, "q").evaluate, DEFAULT.expansion)
    return function.demand_smooth(_NAMES)


@dataclass(frozen=True)
class PlacedDrive(ShortRepr):
    """A drive in the machine.

    Parameters
    ----------
    spec : MachineDrive
        Its table.
    moved : dict of str to Moved
        What it moves.
    knots : (k,) array, rad
        Places at which its laws are not smooth, over its own angle.
    cells : (n,) array, rad
        Ends of the cells in which expansions resolve its laws, over its own angle; those of a
        formula of a slide depend on the range (see `cells_in`).
    period : float, rad
        After which they repeat; of an open one the end of its range.
    closed : bool
        Whether it turns all the way.
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

    def machine(self, point: complex) -> complex:
        """Return a `point` of the drive's frame in the machine, mm."""
        return complex(*self.spec.at) + self.vector(point)

    def vector(self, way: complex) -> complex:
        """Return a direction of the drive's frame in the machine."""
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
            law = self.moved[word].law if word in self.moved else _evenly(one.law, other)
            moved[word] = replace(one, law=law)
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
        """Return its own angles, rad.

        Parameters
        ----------
        q : (n,) array, rad
            The master's angles.
        """
        return self.spec.rate * q + self.spec.phase

    def _over_master(self, law: Law, factor: float, master: bool) -> Law:
        ratio = self.spec.rate

        def over(q: Array, order: int) -> Jet:
            x = q if master else self._beside_knots(self.own(q), ratio)
            found = law(x, order)
            return Jet([factor * value * ratio**k for k, value in enumerate(found.c)])

        if self.spec.slide is not None:  # its formula is one of the master's angle
            return law
        return over

    def _beside_knots(self, x: Array, ratio: float) -> Array:
        """Return own angles with those at knots, but for rounding, on the side that comes later."""
        if self.result is None or not self.closed:
            return x
        within = x % self.period
        nearest = np.abs(within[..., None] - self.knots).argmin(axis=-1)
        at = x - within + self.knots[nearest]
        late = at + math.copysign(_SIDE, ratio) * (np.abs(at) + self.period)
        return np.where(np.abs(within - self.knots[nearest]) <= _ROUNDED, late, x)

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
        if self.spec.slide is not None:
            return _formula_cells(self.spec.slide, low, high)
        return np.concatenate([[low], self._within(self.cells, low, high), [high]])

    @cached_property
    def places(self) -> Array:
        """The master's angles in a turn that show all that its laws do."""
        return self.places_in(0.0, _TURN)

    def places_in(self, low: float, high: float) -> Array:
        """Return the same in a range (see `cells_in`)."""
        ends = self.cells_in(low, high)
        return np.union1d(ends, 0.5 * (ends[1:] + ends[:-1]))

    def _within(self, places: Array, low: float, high: float) -> Array:
        """Return where places of its own angle are in a range of the master's."""
        ends = sorted(self.own(np.array([low, high])))
        turns = range(math.floor(ends[0] / self.period), math.ceil(ends[1] / self.period) + 1)
        every = [places + k * self.period for k in turns] if self.closed else [places]
        found = (np.concatenate(every) - self.spec.phase) / self.spec.rate
        return np.unique(found[(found > low) & (found < high)])


def placed(spec: MachineDrive, build: Callable[[Any], Any]) -> PlacedDrive:
    """Return a drive with the laws of its pair or cam.

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
    if nested is None:
        low, high = spec.span or (0.0, _TURN)
        ends = np.array([low, high])
        cells = _even_cells(high - low) + low
        return PlacedDrive(spec, moved_by(spec, None), ends, cells, high - low, spec.span is None)
    result = build(nested)
    by = result.pair.law if spec.pair is not None else result.program
    cells = np.union1d(by.knots, by.driven.knots if spec.pair is not None else by.cuts)
    knots, cells = (one[(one >= 0.0) & (one <= by.period)] for one in (by.knots, cells))
    moved, end, closed = moved_by(spec, result), float(by.period), by.closed
    if spec.pair is not None and result.pair.on_rack:  # the wheel turns as far as it has teeth
        end, closed = float(result.centrode_angles(2)[-1]), False
        turns = by.period * np.arange(math.ceil(end / by.period))
        every = (np.add.outer(turns, one).ravel() for one in (knots, cells))
        knots, cells = (np.union1d(one[one < end], [0.0, end]) for one in every)
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
