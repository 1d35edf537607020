"""The study of forces of a pair: teeth, bearings, contact pressure, losses."""

from __future__ import annotations

import math
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import DesignError, Problem
from gearcam.base.facts import Fact, Tree
from gearcam.base.findings import limit_of, run_checks
from gearcam.base.numerals import FEW, formatted
from gearcam.base.quantities import TORQUE
from gearcam.gears.contact import COAST, DRIVE, flank_pairs
from gearcam.kinds.gear_pair.drawn import DRIVER
from gearcam.kinds.shared import range_fact
from gearcam.laws.columns import demand as demand_rows
from gearcam.laws.ratio.span import angle_text
from gearcam.mechanics.hertz import half_width, line_pressure, yield_pressure
from gearcam.meshing.force_checks import LoadedPair
from gearcam.meshing.forces import tooth_forces
from gearcam.meshing.settings import FORCES
from gearcam.numeric import narrowing
from gearcam.numeric.arrays import distinct
from gearcam.numeric.piecewise import with_both_sides
from gearcam.pictures.charts import Chart, Limit, Line, knot_marks
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from gearcam.gears.contact import FlankPairs
    from gearcam.kinds.gear_pair.result import GearPairResult
    from gearcam.mechanics.wheel_load import WheelLoadSpec
    from gearcam.meshing.forces import ToothForces
    from gearcam.numeric.arrays import Array, Ints
    from gearcam.pictures.scenes import ColouredCurve
    from gearcam.results.study import Progress

_TURN: Final = 2.0 * math.pi

_ROUNDING: Final = 1e-12
"""Part of a travel by which a table may be short of it."""

_NARROW: Final = 1e-9
"""Width, over the turn or travel, to which an extreme is narrowed."""

PRESSURE: Final = "contact pressure, MPa"
"""Axis of charts, and what flanks are coloured by."""


def demand(design: Any) -> None:
    """Refuse a design without a load, or without a speed on which one depends.

    Parameters
    ----------
    design : GearPairDesign
        The design.

    Raises
    ------
    DesignError
        If nothing acts on the pair, or the speed is missing.
    """
    if not design.load:
        what, near = "nothing acts on the pair", 'a table [[load]] with on = "wheel2" and torque_nm'
        raise DesignError([Problem(what, file=design.source, key="load", allowed=near)])
    fast = [number for number, one in enumerate(design.load) if one.of_speed]
    if fast and design.drive.speed is None:
        what, key = f"is missing: load[{fast[0]}] depends on the speed", "drive.speed_rpm"
        problem = Problem(what, file=design.source, key=key, allowed="a speed above 0")
        raise DesignError([problem])


class PairUnderLoad:
    """A pair under its loads.

    Parameters
    ----------
    result : GearPairResult
        The pair.
    loads : sequence of WheelLoadSpec, optional
        In place of those of its design.

    Raises
    ------
    DesignError
        If a load does not fit its travel.
    """

    def __init__(
        self, result: GearPairResult, loads: Sequence[WheelLoadSpec] | None = None
    ) -> None:
        self.result = result
        self.loads = tuple(result.design.load if loads is None else loads)
        self.turns = bool(result.pair.closed)
        self.travel = _TURN if self.turns else float(result.turn(1)[-1])
        for number, load in enumerate(self.loads):
            if load.file is not None:  # it may have been changed
                demand_rows(load.problems(), f"load[{number}]")
            _demand_fit(load, number, self.travel, result, whole=self.turns)

    @cached_property
    def sides(self) -> list[tuple[FlankPairs, FlankPairs]]:
        """Coast and driving flanks of each step."""
        more = self.result.steps[1:]
        moved = [(flank_pairs(one, COAST), flank_pairs(one, DRIVE)) for one in more]
        return [self.result.subject.sides, *moved]

    @property
    def on_driver(self) -> bool:
        """Whether the driver's torque is given."""
        return bool(self.loads) and self.loads[0].on == "wheel1"

    @property
    def effort(self) -> tuple[str, str, float]:
        """What acts on the driven element: end of its names, unit, and that over N mm or N."""
        return ("n", "N", 1.0) if self.result.pair.on_rack else ("nm", "N m", 1.0 / TORQUE.factor)

    @property
    def width(self) -> float:
        """Width of the teeth that meet, mm: of one step of stepped wheels."""
        design = self.result.design
        return float(design.pair.face_width / design.steps.count)

    def _given(self, phi1: Array) -> Array:
        """Return the load at driver angles, rad, (n,), N mm or N; refused if it is not finite."""
        return self.given(phi1, self.result.design.drive.speed)

    def given(self, phi1: Array, speed: float | None) -> Array:
        """Return the load as it is given.

        Parameters
        ----------
        phi1 : (n,) array, rad
            Driver angles.
        speed : float or None, rad/s
            Of the driver, for loads that depend on it.

        Returns
        -------
        (n,) array, N mm or N
            On the driven element, against its motion, or the torque of the driver.

        Raises
        ------
        DesignError
            If it is not finite.
        """
        x = np.mod(phi1, _TURN) if self.turns else phi1
        phi2, ratio = self.result.pair.rolling.guide.motion(phi1)
        per = 1.0 if self.result.pair.on_rack and not self.on_driver else TORQUE.factor
        omega2 = None if speed is None else speed * ratio
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            found = [one.at(x, phi2, omega2, per=per) for one in self.loads]
        for number, values in enumerate(found):
            wrong = np.flatnonzero(~np.isfinite(values))
            if wrong.size:
                what = f"is not finite at {angle_text(float(phi1[wrong[0]]))}"
                key, source = f"load[{number}].formula", self.result.design.source
                raise DesignError([Problem(what, file=source, key=key, allowed="finite values")])
        return np.sum(found, axis=0) if found else np.zeros(np.shape(phi1))

    def without_friction(self, phi1: Array) -> Array:
        """Return the load on the driven element at driver angles, rad, (n,), if nothing rubs."""
        given = self._given(phi1)
        _, ratio = self.result.pair.rolling.guide.motion(phi1)
        return given / ratio if self.on_driver else given

    def loaded(self, phi1: Array) -> LoadedPair:
        """Return the forces at driver angles, rad, (n,)."""
        design = self.result.design
        forces = self.forces(phi1, self._given(phi1))
        per_width = forces.of_teeth / self.width
        return LoadedPair(
            forces=forces,
            pressure=line_pressure(per_width, forces.teeth.points.curvature, design.material),
            half_width=half_width(per_width, forces.teeth.points.curvature, design.material),
            yielding=yield_pressure(design.material),
        )

    def forces(self, phi1: Array, given: Array) -> ToothForces:
        """Return the forces of the teeth under a load (see `tooth_forces`).

        Parameters
        ----------
        phi1 : (n,) array, rad
            Driver angles.
        given : (n,) array, N mm or N
            See `given`.
        """
        friction = self.result.design.friction
        return tooth_forces(self.sides, phi1, given, on_driver=self.on_driver, friction=friction)

    def places(self) -> Array:
        """Return the driver angles that are studied, rad; they rise.

        Beside even steps these are both sides of knots of the ratio and of the loads, and of where
        teeth begin and cease to touch; and where forces, pressure and losses are largest.
        """
        even = np.linspace(0.0, self.travel, self.result.design.forces.steps + 1)
        back = self._given(even) < 0.0
        knots = self.knots(back=bool(back.any()), forth=not back.all())
        x = distinct(even, knots, np.nextafter(knots, -np.inf))
        return distinct(x, self._extremes(with_both_sides(x, knots)))

    def knots(self, *, back: bool, forth: bool) -> Array:
        """Return where ratio, load or what carries jumps or bends, rad, within the travel.

        Parameters
        ----------
        back, forth : bool
            Whether coast flanks carry, and whether driving flanks do.
        """
        sides = [
            pairs
            for both in self.sides
            for pairs, carries in zip(both, (back, forth), strict=True)
            if carries
        ]
        ends = [pairs.arcs.stretches[0] for pairs in sides]
        # at the pitch point the sliding changes its direction, and so does friction
        ends += [pairs.track.angle(pairs.wheels[0].place(pairs.numbers)) for pairs in sides]
        knots = np.concatenate([self.result.knots, *(one.knots for one in self.loads), *ends])
        return distinct(knots[(knots > 0.0) & (knots < self.travel)])

    def _extremes(self, x: Array) -> Array:
        """Return where the quantities of the facts are largest, or least, near angles `x`.

        Between them these change little, but for where teeth begin or cease to touch.
        """

        def sought(places: Array) -> Array:
            return _sought(self.loaded(places))

        ends, width = narrowing.neighbours(x), _NARROW * self.travel
        which, places, values = narrowing.summits(sought, sought(x), *ends, width)
        largest = [np.flatnonzero(which == number) for number in distinct(which)]
        return places[[rows[np.argmax(values[rows])] for rows in largest]]


def _sought(loaded: LoadedPair) -> Array:
    """Return what is sought at n phases, (q, n): -inf where it is not known."""
    forces = loaded.forces
    bearing = np.abs(forces.bearing)
    rows = [-forces.efficiency]
    for sign in (-1.0, 1.0):
        rows += [sign * one for one in (forces.load, forces.torque, forces.force, bearing)]
        rows += [forces.largest(sign * one) for one in (forces.of_teeth, loaded.pressure)]
    found = np.stack(rows)
    return np.where(np.isnan(found), -np.inf, found)


def _demand_fit(
    load: WheelLoadSpec, number: int, travel: float, result: GearPairResult, *, whole: bool
) -> None:
    """Refuse a load whose places lie beyond the turn or travel, or whose table ends before it."""
    places = {"at": load.ends[-1:], "from": _one(load.start), "to": _one(load.end)}
    words = "the turn" if whole else "the travel"
    for word, values in places.items():
        short = word == "at" and values and values[-1] < travel * (1.0 - _ROUNDING)
        if not short and all(one <= travel * (1.0 + _ROUNDING) for one in values):
            continue
        what = f"{formatted(math.degrees(values[-1]), FEW)}: " + (
            f"the table ends inside {words}" if short else f"it lies beyond {words}"
        )
        end = f"{formatted(math.degrees(travel), FEW)} deg"
        allowed = f"{end} or more as the last" if short and not whole else f"up to {end}"
        named = "file" if word == "at" and load.file is not None else f"{word}_deg"
        key = f"load[{number}].{named}"
        raise DesignError([Problem(what, file=result.design.source, key=key, allowed=allowed)])


def _one(value: float | None) -> tuple[float, ...]:
    return () if value is None else (value,)


def study_forces(result: GearPairResult, progress: Progress) -> StudyResult:
    """Return the study of the forces of a pair (see `gearcam.meshing.forces`).

    Parameters
    ----------
    result : GearPairResult
        The pair.
    progress : Progress
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult
        Its rows are those of ``forces.csv``.

    Raises
    ------
    DesignError
        If nothing acts on it, or a load does not fit its travel.
    InfeasibleError
        If the wheels are impossible.
    """
    progress("forces", 0, 1)
    under = PairUnderLoad(result)
    _ = under.sides  # timed separately
    with result.stage("forces"):
        loaded = under.loaded(under.places())
        findings = run_checks(FORCES, loaded, result.design.limits)
    return StudyResult(
        result=result,
        study=result.kind.studies["forces"],
        file="forces.csv",
        table=_columns(under, loaded),
        group=_facts(under, loaded),
        study_findings=findings,
        drawn=partial(_charts, under, loaded),
        coloured=partial(_pressed, under, loaded),
    )


def _columns(under: PairUnderLoad, loaded: LoadedPair) -> dict[str, Any]:
    """Return the columns of ``forces.csv``: a row for each phase and pair of teeth in contact."""
    forces, points = loaded.forces, loaded.forces.teeth.points
    # phases in which no flanks touch have one row without teeth
    apart = np.flatnonzero(~forces.driven)
    row = np.concatenate([points.step, apart])
    order = np.argsort(row, kind="stable")
    row = row[order]
    end, _, scale = under.effort

    def tooth(values: Any) -> Any:
        """Return a column of contacts, masked where there is none."""
        padded = np.concatenate([values, np.zeros(len(apart), dtype=values.dtype)])
        none = np.concatenate([np.zeros(len(values), bool), np.ones(len(apart), bool)])
        return np.ma.masked_array(padded, none | ~np.isfinite(padded))[order]

    def phase(values: Array) -> Any:
        return np.ma.masked_invalid(values[row])

    teeth = forces.teeth
    pushed = forces.force[points.step] * teeth.share * teeth.push
    driver = 1.0 / TORQUE.factor
    columns = {
        "phase": row + 1,
        "phi1_deg": phase(np.degrees(forces.phi1)),
        **_driven_place(under, phase(forces.phi2)),
        **({"step": tooth(teeth.level + 1)} if len(under.sides) > 1 else {}),
        "tooth1": tooth(teeth.teeth[0]),
        "tooth2": tooth(teeth.teeth[1]),
        "side": np.where(forces.back, 1, -1)[row],
        "pairs": np.bincount(points.step, minlength=len(forces.phi1))[row],
        "share": tooth(teeth.share),
        "normal_n": tooth(forces.of_teeth),
        "force_x_n": tooth(pushed.real),
        "force_y_n": tooth(pushed.imag),
        "x_mm": tooth(points.point.real),
        "y_mm": tooth(points.point.imag),
        "sliding_mm_per_rad": tooth(points.sliding),
        "pressure_mpa": tooth(loaded.pressure),
        "half_width_mm": tooth(loaded.half_width),
        f"load_{end}": phase(scale * forces.load),
        "torque_nm": phase(driver * forces.torque),
        "bearing_x_n": phase(forces.bearing.real),
        "bearing_y_n": phase(forces.bearing.imag),
        "bearing_n": phase(np.abs(forces.bearing)),
        "efficiency": phase(forces.efficiency),
    }
    speed = under.result.design.drive.speed
    if speed is not None:
        columns["power_w"] = phase(1e-3 * speed * forces.torque)
        columns["losses_w"] = phase(1e-3 * speed * forces.lost)
    return columns


def _driven_place(under: PairUnderLoad, place: Any) -> dict[str, Any]:
    on_rack = under.result.pair.on_rack
    return {"travel_mm": place} if on_rack else {"phi2_deg": np.degrees(place)}


def _facts(under: PairUnderLoad, loaded: LoadedPair) -> Tree:
    """Return the facts of the study."""
    forces, design = loaded.forces, under.result.design
    end, unit, scale = under.effort
    driver = 1.0 / TORQUE.factor
    without, row = design.friction.left_out, forces.teeth.points.step
    if under.result.pair.on_rack:
        without.append("guide of the rack")

    def fact(values: Array, label: str, unit: str, rows: Ints | None = None) -> Fact | None:
        return extreme_fact(loaded, values, label, unit, rows)

    return {
        f"load_{end}": fact(scale * forces.load, "load on the driven element", unit),
        "torque_nm": fact(driver * forces.torque, "torque of the driver", "N m"),
        "normal_n": fact(forces.of_teeth, "normal force of a tooth", "N", row),
        "bearing_n": fact(np.abs(forces.bearing), "force on either bearing", "N"),
        "pressure_mpa": fact(loaded.pressure, "contact pressure (Hertz)", "MPa", row),
        "efficiency": _efficiency(loaded),
        "shares": Fact("equal", "load on teeth that carry together", shown=True),
        "friction": Fact(", ".join(without), "friction left out", shown=True) if without else None,
        "locked": bool(forces.locked.any()),
        "power_balance": Fact(forces.balance, "powers balance to", unit=""),
    }


def extreme_fact(
    loaded: LoadedPair, values: Array, label: str, unit: str, rows: Ints | None = None
) -> Fact | None:
    """Return the range of some values, with the place of the largest, as a fact.

    Parameters
    ----------
    loaded : LoadedPair
        The forces.
    values : (n,) or (k,) array
        Of phases, or of contacts.
    label, unit : str
        Of the fact.
    rows : (k,) int array, optional
        Phases of the contacts.

    Returns
    -------
    Fact or None
        None if no value is known.
    """
    return range_fact(
        values, label, unit, lambda k: f"at {loaded.at(k if rows is None else int(rows[k]))}"
    )


def _efficiency(loaded: LoadedPair) -> Tree | None:
    """Return the overall efficiency, of the work of a turn or travel, and the least one."""
    forces = loaded.forces
    if np.isnan(forces.efficiency).all() or not np.nanmax(forces.lost):
        return None
    least = int(np.nanargmin(forces.efficiency))
    value, place = float(forces.efficiency[least]), f"at {loaded.at(least)}"
    tree: Tree = {"least": Fact(value, "least efficiency", place=place, unit="")}
    if np.isfinite(forces.force).all() and not forces.back.any():
        got, put = (_integral(forces.phi1, one) for one in (forces.out, forces.torque))
        tree = {"overall": Fact(got / put, "efficiency", unit="", shown=True), **tree}
    return tree


def _integral(x: Array, y: Array) -> float:
    return float(np.sum(0.5 * (y[1:] + y[:-1]) * np.diff(x)))


def _charts(under: PairUnderLoad, loaded: LoadedPair) -> dict[str, Chart]:
    """Return charts over the driver's angle, of the bearings, and along the flanks."""
    forces, result = loaded.forces, under.result
    phi1, teeth = np.degrees(forces.phi1), loaded.forces.teeth
    driver = 1.0 / TORQUE.factor
    given = result.design.limits
    limits = {
        "torque": limit_of(FORCES, "drive-torque", given) / TORQUE.factor,
        "pressure": limit_of(FORCES, "contact-pressure", given),
    }
    knots = knot_marks(np.degrees(result.knots), 0.0, math.degrees(under.travel))

    def over(name: str, title: str, y: str, lines: dict[str, Array]) -> None:
        most = limits.get(name)
        charts[name] = Chart(
            title=title,
            x=DRIVER,
            y=y,
            lines=tuple(Line(label=label, x=phi1, y=values) for label, values in lines.items()),
            limits=(Limit(label="limit", value=most),) if most else (),
            marks=knots,
        )

    charts: dict[str, Chart] = {}
    torque = {"driver": driver * forces.torque}
    if not result.pair.on_rack:
        torque["driven wheel"] = driver * forces.load
    over("torque", "Torques", "torque, N m", torque)
    over(
        "teeth",
        "Normal forces of the teeth",
        "force, N",
        {"all together": forces.force, "most loaded tooth": forces.largest(forces.of_teeth)},
    )
    over(
        "pressure",
        "Contact pressure (Hertz)",
        PRESSURE,
        {"most loaded tooth": forces.largest(loaded.pressure)},
    )
    if np.isfinite(forces.efficiency).any():
        over("efficiency", "Efficiency", "efficiency", {"efficiency": forces.efficiency})
    charts["bearing"] = Chart(
        title="Force of the frame on the driver's shaft, over its direction",
        x="along the line of centres, N",
        y="across the line of centres, N",
        equal=True,
        lines=(Line(label="over the turn", x=forces.bearing.real, y=forces.bearing.imag),),
    )
    charts["flank_pressure"] = Chart(
        title="Contact pressure along the flanks",
        x="from the wheel's own axis, mm",
        y=PRESSURE,
        lines=tuple(
            Line(label=label, x=np.abs(teeth.points.point - axis), y=loaded.pressure, dots=True)
            for label, axis in _axes(under)
        ),
    )
    return charts


def _axes(under: PairUnderLoad) -> Iterator[tuple[str, complex]]:
    """Yield the elements that turn, with the places of their axes."""
    yield "driver", 0j
    if not under.result.pair.on_rack:
        yield "driven wheel", complex(under.sides[0][0].distance)


def _pressed(under: PairUnderLoad, loaded: LoadedPair) -> Iterator[ColouredCurve]:
    """Yield the flanks of both elements with their contact pressure; of the lowest step."""
    from gearcam.pictures.scenes import ColouredCurve

    forces, result, teeth = loaded.forces, under.result, loaded.forces.teeth
    if np.isnan(loaded.pressure).all():
        return
    step, point = teeth.points.step, teeth.points.point
    phi1 = forces.phi1[step]
    origins, turns = under.sides[0][0].frames(phi1, forces.phi2[step])
    own = (point - origins) * turns
    for part, number, points in zip(result.parts, teeth.teeth, own, strict=True):
        order = np.lexsort((step, number))
        order = order[teeth.level[order] == 0]
        # a flank ends where the tooth changes, and where it meets the next one a turn later
        apart = np.diff(number[order]) != 0
        apart |= np.diff(phi1[order]) > 0.5 * _TURN
        cuts = np.flatnonzero(apart) + 1
        yield ColouredCurve(
            body=part.name,
            places=np.insert(np.degrees(phi1[order]), cuts, np.nan),
            points=np.insert(points[order], cuts, np.nan),
            values={PRESSURE: np.insert(loaded.pressure[order], cuts, np.nan)},
        )
