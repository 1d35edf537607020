"""The result of a mechanism: its drives, its linkage, and the motion of what is asked for."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from copy import copy
from dataclasses import replace
from functools import cached_property, partial
from itertools import chain
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.errors import ABOVE, DesignError, InfeasibleError, beyond_limit
from gearcam.base.findings import Finding, in_order, run_checks
from gearcam.base.numerals import FEW, formatted, in_range
from gearcam.kinds.mechanism.asked import DEG, RATES, TABLES, Amount, Output
from gearcam.kinds.mechanism.design import MechanismDesign
from gearcam.kinds.mechanism.linkage import make_linkage
from gearcam.kinds.mechanism.names import OutputNames, paths_asked, tables_of
from gearcam.kinds.mechanism.placed import PlacedDrive, placed
from gearcam.linkages.checks import KIND, CheckedMachine
from gearcam.linkages.linkage import Linkage
from gearcam.linkages.measures import HIGHEST, Peak, TrackMeasures, TracksTogether
from gearcam.linkages.transmission import Transmission, transmissions
from gearcam.numeric.arguments import angles
from gearcam.numeric.arrays import Array
from gearcam.numeric.columns import Columns
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import with_both_sides
from gearcam.results.kind import kind_of
from gearcam.results.nested import nested_result, within
from gearcam.results.nested import placed as findings_of
from gearcam.results.result import Result
from gearcam.results.study_help import with_studies

if TYPE_CHECKING:
    from gearcam.base.facts import Tree
    from gearcam.designs.design import Design
    from gearcam.linkages.dwells import DriverRange
    from gearcam.linkages.path_fits import CircleFit, LineFit
    from gearcam.linkages.paths import PointPath

_MOST_STEPS: Final = 1e6
"""Largest number of steps of a table."""

_COARSE: Final = 180
"""Steps of a turn of the master in the charts of a draft."""

_WITNESSES: Final = 1000
"""Master's angles at which lengths are compared."""

_ENDS: Final = 1e-9
"""How far an angle may be beyond an open range by rounding, rad."""

_TURNING: Final = ("direction", "angular_velocity", "angular_acceleration")
"""Charts that lead where an angle is asked for first."""

_DRIVERS: Final = {
    "pair": ("phi1", "driver angle phi1"),
    "cam": ("theta", "cam angle theta"),
    "even": ("theta", "crank angle theta"),
}
"""Symbol and name of the master's angle, by the key of the drive."""


Row = dict[str, Any]


@with_studies("mechanism")
class MechanismResult(Result):
    """Result of the design of a mechanism, computed on demand.

    Parameters
    ----------
    design : MechanismDesign
        The design.
    tolerances : Tolerances
        Internal accuracy.

    Examples
    --------
    >>> import gearcam as gc
    >>> result = gc.build(gc.load("profiles/four_bar.toml"))
    >>> [one.name for one in result.outputs]
    ['P', 'P', 'rocker.angle']
    """

    for_users = ("compared", "comparison", "interval_table", "motion", "output", "outputs")

    design: MechanismDesign
    stages: ClassVar[Mapping[str, str]] = {
        "drives": "drives",
        "linkage": "linkage",
        "checks": "checked",
    }
    before_studies = ("drives", "linkage")

    chart_steps = 720
    """Steps of a turn of the master in a chart."""

    _given: tuple[PlacedDrive, ...] = ()
    """Drives in the place of those of the design."""

    @cached_property
    def drives(self) -> tuple[PlacedDrive, ...]:
        """The drives with their laws, the master first."""
        with self.stage("drives"):
            return self._given or tuple(
                self._placed(f"drive[{number}]", spec)
                for number, spec in enumerate(self.design.drive)
            )

    def _placed(self, at: str, spec: Any) -> PlacedDrive:
        def build(nested: Design) -> Any:
            with within(f"{at}.{spec.key}"):
                result = nested_result(nested, self.tolerances)
                _ = result.pair if spec.pair is not None else result.cam
                return result

        return placed(spec, build)

    def coarse(self) -> Self:
        """Return the mechanism with fewer places in its charts (see `Staged`)."""
        made = copy(self)
        made.chart_steps = _COARSE
        return made

    @cached_property
    def linkage(self) -> Linkage:
        """The linkage over a cycle of the master."""
        drives = self.drives
        with self.stage("linkage"):
            return make_linkage(tables_of(self.design), drives)

    @property
    def driver(self) -> tuple[str, str]:
        """Symbol of the master's angle in columns, and what it is called."""
        return _DRIVERS[self.design.drive[0].key]

    @property
    def axis(self) -> str:
        """The master's angle as the axis of charts."""
        return f"{self.driver[1]}, deg"

    @cached_property
    def outputs(self) -> tuple[Output, ...]:
        """What is asked for, in order.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/nail_machine_slide.toml"))
        >>> [(one.name, one.angle) for one in result.outputs]
        [('slide', False), ('rod.angle', True)]
        """
        return self.output_names.asked(self.design.output.outputs)

    @cached_property
    def output_names(self) -> OutputNames:
        """What may be asked for, by name."""
        return OutputNames(tables_of(self.design))

    def degrees(self, q: float) -> str:
        """Return an angle of the master, rad, in degrees as text: a turn's end is its begin."""
        low, high = (DEG * end for end in self.linkage.span)
        place = DEG * q
        return in_range(place, low, high) if self.linkage.closed else formatted(place, FEW)

    def place(self, q: float) -> str:
        """Return an angle of the master, rad, with its name, as ``theta = 90 deg``."""
        return f"{self.driver[0]} = {self.degrees(q)} deg"

    def at(self, peak: Peak) -> str:
        """Return the place of a `peak` in words."""
        return f"at {self.degrees(peak.place)} deg"

    @property
    def angles(self) -> Array:
        """The master's angles of the motion's table, rad, in steps of the design, both ends."""
        (low, high), step = self.linkage.span, self.design.output.step
        least = (high - low) / _MOST_STEPS
        if step < least:
            what = f"the table would have more than {_MOST_STEPS:.0f} rows"
            value, limit = DEG * step, DEG * least
            raise beyond_limit(
                what, "output.step_deg", value, limit, near=ABOVE * limit, unit="deg"
            )
        return np.linspace(low, high, max(2, round((high - low) / step) + 1))

    def motion(self, q: ArrayLike | None = None) -> Columns:
        """Return the motion of all outputs.

        Parameters
        ----------
        q : (n,) array, rad, optional
            The master's angles; by default those of ``motion.csv``.

        Returns
        -------
        Columns
            The master's angle, ``phi1_deg`` behind a pair, else ``theta_deg``; for each output its
            value, ``NAME_mm`` or ``NAME_deg``, and its first three derivatives by the master's
            angle, ``NAME_mm_per_rad``, ``NAME_rad_per_rad``; with a speed also those by time,
            ``NAME_mm_s``, ``NAME_rad_s``. A point has ``NAME_x`` and ``NAME_y``. At a knot the
            values after it are returned.

        Raises
        ------
        DesignError
            If `q` is not an array of finite numbers.
        InfeasibleError
            If the mechanism does not close.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/nail_machine_slide.toml"))
        >>> columns = result.motion([0.0, 1.0])  # angles of the master, rad
        >>> columns["slide_mm"].round(3)
        array([600.   , 721.549])
        """
        return self._motion_of(self.outputs, q)

    def output(self, name: str, q: ArrayLike | None = None) -> Columns:
        """Return the motion of one output.

        Parameters
        ----------
        name : str
            A joint, a point, a slide, ``member.angle``, or a shaft such as ``pair.wheel2``.
        q : (n,) array, rad, optional
            The master's angles; by default those of ``motion.csv``.

        Returns
        -------
        Columns
            As for `motion`.

        Raises
        ------
        DesignError
            If nothing moves by this name, or `q` is not an array of finite numbers.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/nail_machine_slide.toml"))
        >>> result.output("pair.wheel2", [0.0, 1.0])["pair_wheel2_deg"].round(3)
        array([ 0.   , 84.867])
        """
        if name not in self.output_names.known:
            raise DesignError([self.output_names.unknown(("name",), name).problem("")])
        return self._motion_of(self.output_names.known[name], q)

    def _motion_of(self, outputs: Iterable[Output], q: ArrayLike | None) -> Columns:
        where = self.angles if q is None else self._within_range(q)
        columns = {f"{self.driver[0]}_deg": DEG * where}
        orders, speed = range(1, len(RATES) + 1), self.speed
        for one in outputs:
            values, (scale, unit) = self.track(one)(where, len(RATES)).derivatives(), one.unit
            keys = {order: one.rate_keys(order) for order in orders}
            columns[f"{one.stem}_{unit}"] = scale * values[0]
            columns |= {f"{one.stem}_{keys[k][0]}": values[k] for k in orders}
            if speed is not None:
                columns |= {f"{one.stem}_{keys[k][1]}": values[k] * speed**k for k in orders}
        return Columns(columns)

    def track(self, one: Output) -> Callable[[Array, int], Jet]:
        """Return an output as a function: ``track(q, order)`` of the master's angles (n,), rad."""
        return partial(self.linkage.real_track, one.quantity)

    @cached_property
    def compared(self) -> dict[str, MechanismResult]:
        """The same mechanism behind the drives to compare, by their names.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/nail_machine_slide.toml"))
        >>> list(result.compared)
        ['three_phases', 'without_a_pair']
        """
        return {
            one.name: self._behind(f"compare[{number}]", pair=one.pair, cam=one.cam, even=one.even)
            for number, one in enumerate(self.design.compare)
        }

    @property
    def machines(self) -> dict[str, MechanismResult]:
        """The mechanism behind its first drive, and behind those to compare, by their names."""
        return {self.design.drive[0].name: self, **self.compared}

    @property
    def speed(self) -> float | None:
        """Speed of the master, rad/s; None if the design does not say."""
        return self.design.drive[0].speed

    def _in_order(self, names: Iterable[str]) -> Sequence[str]:
        """Return names of charts, first those of what is asked for first."""
        first = _TURNING if self.outputs[0].angle else ()
        return sorted(names, key=lambda name: name not in first)

    @cached_property
    def checked(self) -> tuple[Finding, ...]:
        """Findings of the drives and of the mechanism, errors first."""
        below: list[Finding] = []
        for number, drive in enumerate(self.drives):
            if drive.result is not None:
                key = f"drive[{number}].{drive.spec.key}"
                nested = drive.result.design
                own = kind_of(nested).titles if nested.source == self.design.source else ()
                with within(key):
                    below += findings_of(key, drive.result.checked, own)
        _ = self.compared
        even = self.without_pair if self.linkage.closed else None
        # of one that is not compared only the accelerations are looked at
        beside = {} if even is None else even.measures if self.design.compare else even.measured(2)
        machine = CheckedMachine(
            self.linkage,
            self.measures,
            {one.stem: one.rate_unit for one in self.outputs},
            self.transmissions,
            beside,
        )
        with self.stage("checks"):
            subjects = {KIND: machine, TABLES: self}
            own = [run_checks(kind, one, self.design.limits) for kind, one in subjects.items()]
            return in_order(chain(below, *own))

    @cached_property
    def without_pair(self) -> MechanismResult | None:
        """The same mechanism behind an even shaft; None if no pair drives it, or it cannot move."""
        for other in self.design.compare:
            if other.even:
                return self.compared[other.name]
        if self.drives[0].spec.pair is None:
            return None
        with suppress(InfeasibleError):
            return self._behind("drive[0]", pair=None, cam=None, even=True)
        return None

    def _behind(self, at: str, **drive: Any) -> MechanismResult:
        """Return the same mechanism with what stands at a key in the place of its first drive."""
        first = self.drives[0]
        master = self._placed(at, replace(first.spec, span=None, **drive)).instead_of(first)
        made = type(self)(replace(self.design, compare=(), examined=True), self.tolerances)
        made._given, made.chart_steps = (master, *self.drives[1:]), self.chart_steps
        with within(at):
            _ = made.linkage
        return made

    @cached_property
    def measures(self) -> dict[str, TrackMeasures]:
        """Extremes, dead centres and the like of each output, by the beginning of its columns."""
        return self.measured(HIGHEST)

    def measured(self, highest: int) -> dict[str, TrackMeasures]:
        """Return the `measures` with extremes of derivatives up to the `highest` only."""
        linkage, outputs = self.linkage, self.outputs
        tracks = partial(linkage.real_tracks, [one.quantity for one in outputs])
        together = TracksTogether(tracks, linkage.knots, highest)
        return {
            one.stem: TrackMeasures(
                self.track(one), linkage.knots, linkage.closed, highest, (together, number)
            )
            for number, one in enumerate(outputs)
        }

    @cached_property
    def curves(self) -> tuple[Array, list[list[Array]]]:
        """The master's angles of charts, with both sides of knots, and each output there.

        Values and derivatives up to the `HIGHEST`.
        """
        low, high = self.linkage.span
        steps = self.chart_steps * max(1, round((high - low) / math.tau))
        q = with_both_sides(np.linspace(low, high, steps + 1), self.linkage.knots)
        tracks = self.linkage.real_tracks([one.quantity for one in self.outputs], q, HIGHEST)
        return q, [one.derivatives() for one in tracks]

    @cached_property
    def accuracy(self) -> Tree:
        """The largest difference of a member's length from the one it has (see `Staged`)."""
        how = "largest difference of a length of a member from the one it has"
        miss = self.linkage.miss(np.linspace(*self.linkage.span, _WITNESSES))
        return {"lengths_mm": miss, "how": {"lengths_mm": how}}

    @cached_property
    def transmissions(self) -> tuple[Transmission, ...]:
        """The worst pressure angle of each dyad, or the least distance of a swinging guide."""
        return transmissions(self.linkage)

    @cached_property
    def paths(self) -> dict[str, PointPath]:
        """The paths of the points that are asked for, by name."""
        names, linkage = paths_asked(self.outputs), self.linkage
        if not names:
            return {}
        from gearcam.linkages.paths import PointPath

        return {
            name: PointPath(partial(linkage.track, name), linkage.knots, linkage.closed)
            for name in names
        }

    @cached_property
    def intervals(self) -> tuple[DriverRange, ...]:
        """The master's ranges over the last bits of travel that the design asks for.

        Raises
        ------
        InfeasibleError
            If an output does not travel as far.
        """
        return tuple(
            one.last_bit(output, self.measures_of(output), f"interval[{number}]")
            for number, one in enumerate(self.design.interval)
            for output in [self.output_of(one)]
        )

    @cached_property
    def interval_velocities(self) -> tuple[float, ...]:
        """Velocities at the beginning of the `intervals`, mm/rad or rad/rad."""
        return tuple(
            float(self.track(self.output_of(one))(np.array([found.begin]), 1).derivatives()[1][0])
            for one, found in zip(self.design.interval, self.intervals, strict=True)
        )

    def comparison(self) -> Columns:
        """Return what the drives to compare make of each output.

        Returns
        -------
        Columns
            A row for each drive and output: ``drive``, the master's range ``range_deg``,
            ``output``, ``unit``, ``stroke``, the largest sizes of the derivatives by the master's
            angle with the places, ``velocity`` and ``velocity_at_deg`` and so on, in the unit or
            rad; with a speed those by time, ``velocity_per_s``, and the range's time, ``range_s``.
            Places of what stands still are masked.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/nail_machine_slide.toml"))
        >>> columns = result.comparison()
        >>> columns["drive"][::2].tolist(), columns["stroke"][::2].round(2)
        (['pair', 'three_phases', 'without_a_pair'], array([300., 300., 300.]))
        """
        return Columns(self.masked_comparison())

    def masked_comparison(self) -> Mapping[str, ArrayLike]:
        """Return the `comparison` for files: without numbers that are masked."""
        return _tabled([row for one in self.machines.items() for row in _of_outputs(*one)])

    def interval_table(self) -> Columns:
        """Return the intervals that the design asks for, behind each drive.

        Returns
        -------
        Columns
            A row for each drive and interval: ``drive``, ``on``, ``before``, the master's angles
            ``from_deg``, ``to_deg``, ``angle_deg``, the velocity at the beginning by the master's
            angle; with a speed the time, ``time_s``, and the velocity by time.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/nail_machine_slide.toml"))
        >>> columns = result.interval_table()
        >>> columns["drive"].tolist(), columns["angle_deg"].round(2)
        (['pair', 'three_phases', 'without_a_pair'], array([49.63, 47.16, 22.  ]))
        """
        rows = [row for one in self.machines.items() for row in _of_intervals(*one)]
        return Columns(_tabled(rows))

    @cached_property
    def stretches(self) -> tuple[LineFit | CircleFit, ...]:
        """The lines and circles nearest to stretches of paths that the design asks for.

        Raises
        ------
        DesignError
            If a stretch is beyond the master's range.
        InfeasibleError
            If it is straight and a circle is asked for.
        """
        found: list[LineFit | CircleFit] = []
        for number, one in enumerate(self.design.stretch):
            where = f"stretch[{number}]"
            if not self.linkage.closed:
                one.demand_within(self.linkage.span, self.design.source, where)
            found.append(one.fit(self.paths[one.on], where))
        return tuple(found)

    def _within_range(self, q: ArrayLike) -> Array:
        """Return angles of the master; DesignError for one beyond an open range."""
        where, (low, high) = angles("q", q), self.linkage.span
        beyond = where[(where < low - _ENDS) | (where > high + _ENDS)]
        if beyond.size and not self.linkage.closed:
            allowed = f"{formatted(low, 8)} to {formatted(high, 8)} rad"
            what = "is beyond the master's range"
            raise DesignError.of(what, key="q", value=float(beyond[0]), allowed=allowed)
        return where

    @cached_property
    def dwells(self) -> tuple[DriverRange, ...]:
        """The longest ranges in which outputs stay within what the design asks for."""
        return tuple(
            one.longest(output, self.measures_of(output))
            for one in self.design.dwell
            for output in [self.output_of(one)]
        )

    def measures_of(self, one: Output) -> TrackMeasures:
        """Return the extremes and the like of any output."""
        knots, closed = self.linkage.knots, self.linkage.closed
        return self.measures.get(one.stem) or TrackMeasures(self.track(one), knots, closed)

    def output_of(self, asked: Amount) -> Output:
        """Return the one output that a table is about, `asked` for."""
        (found,) = self.output_names.known[asked.on]
        return found


# --- rows of tables -------------------------------------------------------------------------------


def _tabled(rows: Sequence[Row]) -> dict[str, ArrayLike]:
    return {key: _column([row[key] for row in rows]) for key in rows[0]}


def _column(values: list[Any]) -> ArrayLike:
    """Return the values of a column, those that are None masked."""
    missing = [one is None for one in values]
    if not any(missing):
        return np.array(values)
    there = [0.0 if one is None else one for one in values]
    return np.ma.MaskedArray(there, mask=missing)


def _of_outputs(name: str, machine: MechanismResult) -> Iterator[Row]:
    speed, (low, high) = machine.speed, machine.linkage.span
    for one in machine.outputs:
        measures, (scale, unit) = machine.measures[one.stem], one.unit
        row: Row = {
            "drive": name,
            "range_deg": DEG * (high - low),
            "output": one.stem,
            "unit": unit,
            "stroke": scale * measures.stroke,
        }
        if speed is not None:
            row["range_s"] = (high - low) / speed
        for order, word in enumerate(RATES, start=1):
            peak = measures.size(order)
            place = None if measures.still else DEG * peak.place
            row |= {word: peak.value, f"{word}_at_deg": place}
            if speed is not None:
                row[f"{word}_per_s"] = peak.value * speed**order
        yield row


def _of_intervals(name: str, machine: MechanismResult) -> Iterator[Row]:
    speed = machine.speed
    for asked, interval, rate in zip(
        machine.design.interval, machine.intervals, machine.interval_velocities, strict=True
    ):
        row = {
            "drive": name,
            "on": asked.on,
            "before": asked.before,
            "from_deg": DEG * interval.begin,
            "to_deg": DEG * interval.end,
            "angle_deg": DEG * interval.length,
            "velocity": rate,
        }
        if speed is not None:
            row |= {"time_s": interval.length / speed, "velocity_per_s": rate * speed}
        yield row
