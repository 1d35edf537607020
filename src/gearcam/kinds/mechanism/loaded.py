"""From the tables of loads, masses, springs and gravity to the efforts on a mechanism."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.kinds.mechanism.drives import way_of
from gearcam.kinds.mechanism.load_names import pushed_in, sorts_of, unturned
from gearcam.kinds.mechanism.load_tables import OUTER
from gearcam.kinds.mechanism.name_keys import MEMBER, SHAFT, WAY
from gearcam.kinds.mechanism.names import moves, parts_of
from gearcam.kinds.mechanism.wheel_masses import wheel_masses
from gearcam.linkages.coordinates import (
    Acting,
    JointDistance,
    MemberTurn,
    NamedCoordinate,
    PointWay,
    WorkCoordinate,
    WorkState,
)
from gearcam.linkages.dwells import WHOLE, ShortRangeError, last_travels
from gearcam.linkages.efforts import (
    GRAVITY,
    SPRINGS,
    ActiveRanges,
    AppliedForce,
    Effort,
    ForceLaw,
    InertiaForce,
    force_on,
)
from gearcam.linkages.elements import GROUND, Element, MemberPoint
from gearcam.linkages.measures import TrackMeasures
from gearcam.linkages.work import VirtualWork
from gearcam.numeric.arrays import Array, away
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import places_between

if TYPE_CHECKING:
    from gearcam.base.quantities import Row
    from gearcam.kinds.mechanism.design import MechanismDesign
    from gearcam.kinds.mechanism.drives import PlacedDrive
    from gearcam.kinds.mechanism.load_tables import MachineLoad, MachineSpring
    from gearcam.linkages.linkage import Linkage

_TURN: Final = 2.0 * math.pi
_SLACK: Final = 1e-9
"""How much a table may be short of the range, rad; distance of joints that meet, as a share."""

_KILO: Final = 1e3
"""N mm of a N m."""


def work_of(
    design: MechanismDesign, linkage: Linkage, drives: Sequence[PlacedDrive]
) -> VirtualWork:
    """Return what acts on a mechanism.

    Parameters
    ----------
    design : MechanismDesign
        The design.
    linkage : Linkage
        Its linkage.
    drives : sequence of PlacedDrive
        Its drives; pairs whose designs give a density have masses.

    Returns
    -------
    VirtualWork

    Raises
    ------
    InfeasibleError
        If a load begins before the slide's whole travel, or its table does not reach over the
        master's range.
    """
    return _Efforts(design, linkage, drives).work


class _Efforts:
    """The efforts on a mechanism, and where they are not smooth."""

    def __init__(
        self, design: MechanismDesign, linkage: Linkage, drives: Sequence[PlacedDrive]
    ) -> None:
        self.design, self.speed = design, design.drive[0].speed
        self.parts = parts_of(design)
        self.sorts = sorts_of(self.parts)
        self.centers = self._centers()
        points: list[Element] = [
            MemberPoint(self.centers[number], complex(*mass.at), mass.of)
            for number, mass in enumerate(design.mass)
            if mass.at is not None
        ]
        self.wheels = list(wheel_masses(drives))
        points += [one.element for one in self.wheels]
        self.linkage = replace(linkage, elements=(*linkage.elements, *points))
        self.knots: list[float] = []

    def _centers(self) -> list[str]:
        """Return the joint in the centre of each mass; empty for none."""
        still = unturned(self.parts)
        return [
            "" if mass.mass is None
            else mass.center or (f"{mass.of}.center{number}" if mass.at else still[mass.of])
            for number, mass in enumerate(self.design.mass)
        ]  # fmt: skip

    @property
    def work(self) -> VirtualWork:
        """What acts on the mechanism."""
        efforts = [*self._loads(), *self._masses(), *self._springs()]
        return VirtualWork(self.linkage, efforts, self.speed, tuple(self.knots))

    def coordinate(self, name: str, direction: float | None = None) -> WorkCoordinate:
        """Return on what a load on something named does work."""
        if direction is not None:
            return PointWay(self._joint(name), GROUND, cmath.exp(1j * direction))
        sort = self.sorts[name]
        if sort == MEMBER:
            return MemberTurn(name)
        return self._way(name) if sort == WAY else NamedCoordinate(name)

    def _joint(self, name: str) -> str:
        pushed = {one.name: one.joint for one in pushed_in(self.parts)}
        return pushed.get(name, name)

    def _way(self, name: str) -> WorkCoordinate:
        for dyad in self.design.dyad:
            if dyad.joint == name:
                place = moves(dyad)
                guide = dyad.last if place.endswith("2") else dyad.first
                return PointWay(name, guide, slide=place)
        for one in self.design.slide:
            if name in (one.name, one.joint):
                return PointWay(one.joint, way_of(one.on), slide=one.on)
        for one in self.design.hoist:
            if name in (one.name, one.joint):
                return PointWay(one.joint, f"{one.name}.guide", slide=f"{one.name}.way")
        return NamedCoordinate(name)

    def _loads(self) -> Iterator[Effort]:
        for number, load in enumerate(self.design.load):
            active = self._active(load, number)
            if load.force is not None and len(load.force) == 2:
                yield force_on(self._joint(load.on), complex(*load.force), active=active)
                continue
            on = self.coordinate(load.on, load.direction)
            law = self._law(load, on, number)
            if load.against:
                self.knots += self._still(on)
                law = _opposing(law)
            yield AppliedForce(on, law, active=active)

    def _active(self, load: MachineLoad, number: int) -> ActiveRanges | None:
        low, high = self.linkage.span
        if load.travel is not None:
            return ActiveRanges(self._travels(load, load.travel, number), high - low)
        if load.start is None or load.end is None:
            return None
        period = _TURN if self.linkage.closed else math.inf
        if load.end - load.start > period + _SLACK:
            what = "the load acts for more than a turn of the master, with which it repeats"
            note = "without from_deg and to_deg it acts everywhere, by a table in some turns only"
            value, most = math.degrees(load.end), math.degrees(load.start + period)
            raise beyond_limit(what, f"load[{number}].to_deg", value, most, note, near=most)
        return ActiveRanges([(load.start, load.end)], _TURN if self.linkage.closed else None)

    def _travels(
        self, load: MachineLoad, travel: float, number: int
    ) -> tuple[tuple[float, float], ...]:
        measures = self._measures(self._way(load.on))
        where = f"load[{number}].travel_mm"
        if travel > measures.stroke * WHOLE:
            what = f"{load.on} has not so much travel"
            raise beyond_limit(what, where, travel, measures.stroke, unit="mm")
        try:
            return last_travels(measures, travel, outer=load.before == OUTER)
        except ShortRangeError as error:
            what = f"{load.on} has not so much travel before its {load.before} dead centre"
            note = "from_deg and to_deg, or the other dead centre"
            raise beyond_limit(what, where, travel, error.travel, note, unit="mm") from None

    def _still(self, on: WorkCoordinate) -> list[float]:
        """Return the driver's angles at which something loaded reverses."""
        return away(self._measures(on).extremes[0][0], self.linkage.knots, _SLACK).tolist()

    def _law(self, load: MachineLoad, on: WorkCoordinate, number: int) -> ForceLaw:
        """Return a load's size, N or N mm."""
        per = _KILO if self.sorts[load.on] in (MEMBER, SHAFT) else 1.0
        if load.formula is not None:
            return self._formula(load, load.formula, per)
        if load.table is not None:
            return self._rows(load, load.table, on, number, per)
        size = load.torque if load.force is None else load.force[0]
        return lambda _: size or 0.0

    def _formula(self, load: MachineLoad, text: str, per: float) -> ForceLaw:
        variable, made = load.read(text)
        name = {"q": "angle", "x": "place", "v": "velocity"}[variable]
        return lambda acting: made.evaluate(getattr(acting, name)) * per

    def _rows(
        self, load: MachineLoad, table: Row, on: WorkCoordinate, number: int, per: float
    ) -> ForceLaw:
        place = load.place
        if place is None:
            way = load.way or (0.0,)
            self.knots += [q for one in way for q in self._measures(on).places_of(one).tolist()]
            return lambda acting: _between(acting.place, way, table) * per
        turns = self._turns(place, number)
        places = np.add.outer(_TURN * np.array(turns), place)
        places[:-1, -1] = places[1:, 0]  # but for rounding
        at, rows = places.ravel(), np.tile(table, len(turns))
        self.knots += at.tolist()
        return lambda acting: _between(acting.angle, at, rows) * per

    def _turns(self, place: Row, number: int) -> range:
        """Return the turns of the master over which a table goes; raise if it ends too early."""
        low, high = self.linkage.span
        first, last = place[0], place[-1]
        if self.linkage.closed and math.isclose(last - first, _TURN, rel_tol=1e-12):
            return range(math.floor((low - last) / _TURN), math.ceil((high - first) / _TURN) + 1)
        for index, short, limit in ((0, first - low, low), (-1, high - last, high)):
            if short > _SLACK:
                where = f"load[{number}].at_deg[{index % len(place)}]"
                what = "the table does not reach over the master's range"
                value, most = math.degrees(place[index]), math.degrees(limit)
                raise beyond_limit(what, where, value, most, unit="deg")
        return range(1)

    def _measures(self, on: WorkCoordinate) -> TrackMeasures:
        """Return measures of the place of something loaded."""

        def track(q: Array, order: int) -> Jet:
            found = on.place(WorkState(self.linkage, q, order, self.speed))
            return Jet([one + np.zeros(q.shape) for one in found.c])  # where it rests, too

        return TrackMeasures(track, self.linkage.knots, self.linkage.closed, highest=0)

    def _masses(self) -> Iterator[Effort]:
        pull = self.design.gravity.pull
        for mass, center in zip(self.design.mass, self.centers, strict=True):
            if mass.inertia:
                turn = (NamedCoordinate if self.sorts[mass.of] == SHAFT else MemberTurn)(mass.of)
                yield InertiaForce.of_turn(turn, mass.inertia, mass.of)
            if mass.mass:
                yield InertiaForce.of_mass(center, mass.mass, mass.of)
            if mass.mass and pull:
                yield force_on(center, mass.mass * pull, GRAVITY)
        for wheel in self.wheels:
            yield wheel.effort
            if pull:
                yield force_on(wheel.center, wheel.mass * pull, GRAVITY)

    def _springs(self) -> Iterator[Effort]:
        low, high = self.linkage.span
        start = WorkState(self.linkage, np.array([min(max(0.0, low), high)]), 0, self.speed)
        for number, spring in enumerate(self.design.spring):
            on = self._joined(spring)
            self._demand_apart(on, number)
            at = float(np.asarray(on.place(start).c[0])[0])
            yield AppliedForce(on, _spring_law(spring, at), SPRINGS)

    def _demand_apart(self, on: WorkCoordinate, number: int) -> None:
        """Refuse a spring whose ends meet: it has no direction there."""
        if not isinstance(on, JointDistance):
            return
        q = places_between(self.linkage.knots).ravel()
        known = self.linkage.at(q, 0)
        first, second = (np.asarray(known.jet(one).c[0]) for one in (on.first, on.second))
        apart = np.abs(second - first)
        if apart.min() <= _SLACK * max(1.0, float(np.abs(first).max())):
            place = formatted(math.degrees(float(q[int(apart.argmin())])), 6)
            what = f"{on.first} and {on.second} are in one place at {place} deg of the master"
            raise InfeasibleError(what, where=f"spring[{number}].between")

    def _joined(self, spring: MachineSpring) -> WorkCoordinate:
        if spring.between is None:
            on = self.coordinate(spring.on or "")
            # between the slide and its guide, which may move
            return NamedCoordinate(on.slide) if isinstance(on, PointWay) else on
        first, second = spring.between
        if self.sorts[first] == MEMBER:
            return MemberTurn(second, first)
        return JointDistance(self._joint(first), self._joint(second))


def _between(x: Jet, places: Row | Array, values: Row | Array) -> Jet:
    """Return the values on straight lines between places; beyond them those at their ends."""
    at, rows = np.asarray(places, dtype=float), np.asarray(values, dtype=float)
    width, rise = np.diff(at), np.diff(rows)
    slopes = np.divide(rise, width, out=np.zeros_like(rise), where=width > 0.0)
    cell = np.searchsorted(at, np.asarray(x.c[0]), side="right")
    slopes = np.concatenate([[0.0], slopes, [0.0]])[cell]
    from_row = np.clip(cell - 1, 0, len(at) - 1)
    return (x - at[from_row]) * slopes + rows[from_row]


def _opposing(law: ForceLaw) -> ForceLaw:
    """Return the law of a load of the same size that opposes the motion."""

    def opposed(acting: Acting) -> Jet:
        size = acting.angle * 0.0 + law(acting)
        return size * -(np.sign(acting.rate.c[0]) * np.sign(size.c[0]))

    return opposed


def _spring_law(spring: MachineSpring, start: float) -> ForceLaw:
    """Return the force or torque of a spring; `start` is its length or angle at the zero."""
    if spring.angular:
        rate, preload, damping, free = spring.torsion, spring.moment, spring.swing_damping, start
    else:
        rate, preload, damping = spring.stiffness, spring.preload, spring.damping
        free = start if spring.length is None else spring.length

    def law(acting: Acting) -> Jet:
        pull = (acting.place - free) * rate + preload
        return -(pull + acting.velocity * damping)

    return law
