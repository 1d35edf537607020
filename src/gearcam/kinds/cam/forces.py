"""The study of forces of a cam: statics of its follower, contact pressure, springs."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import DesignError, InfeasibleError, Problem, beyond_limit
from gearcam.base.facts import Fact, extent
from gearcam.base.findings import limit_of, run_checks
from gearcam.base.numerals import formatted, shortened
from gearcam.base.quantities import TORQUE
from gearcam.cams.burdens import Loads
from gearcam.cams.force_checks import Loaded, on_way
from gearcam.cams.spec import FORCES
from gearcam.cams.statics import Statics, solve
from gearcam.kinds.cam.charts import knots_of, places_of
from gearcam.kinds.cam.hints import enlarged
from gearcam.mechanics.hertz import half_width, line_pressure
from gearcam.numeric import narrowing
from gearcam.numeric.piecewise import with_both_sides
from gearcam.pictures.charts import Chart, Limit, Line
from gearcam.results.result import StudyResult

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from gearcam.kinds.cam.build import CamResult
    from gearcam.numeric.arrays import Array, Ints, Mask
    from gearcam.results.kind import Study
    from gearcam.results.result import Progress

Tree = dict[str, Any]

_MIRRORED: Final = (
    "guide_n", "guide_moment_nmm", "guide_low_n", "guide_high_n", "pivot_x_n",
)  # fmt: skip
"""Reactions that change their sign in the mirror image, which a cam that turns clockwise is."""

_TOLD: Final = 0.1
"""Work over the largest, per step, above which an efficiency is told: near rest it is always 0."""

_NOISE: Final = 1e-9
"""Share of the largest force that is 0: where another wall begins to carry little is left."""

_CLOSE: Final = 1e-12
"""Distance of both sides of a change of what carries, over the turn or travel."""

_NARROW: Final = 1e-9
"""Width, over the turn or travel, to which an extreme is narrowed."""

_PEAKS: Final = 4
"""How many of the highest peaks among the samples are narrowed, for each quantity."""

_SCALES: Final = 2
"""Number of positions that give the scale of what is rounding, before those asked for."""

_ROUNDING: Final = 1e-12
"""Share of a sampled extreme by which a narrowed one is larger, or they are one."""


def demand(design: Any) -> None:
    """Refuse a design whose masses or springs need a speed that is missing.

    Raises
    ------
    DesignError
        If it is missing.
    """
    if design.drive.speed is not None:
        return
    key = "drive." + design.drive.key
    solved = any(one.solved for one in design.spring)
    if design.mass and (solved or not design.gravity.given):
        what = "is missing: a mass acts by its inertia, which depends on the speed"
        near = "a speed above 0, or [gravity] for the weight alone"
        if solved:
            what, near = "is missing: a spring is solved for a speed", "a speed above 0"
        problem = Problem(what, file=design.source, key=key, allowed=near)
        raise DesignError([problem])


def loads_of(result: CamResult) -> Loads:
    """Return what acts on the follower of a cam, its `result`, beside the cam.

    Raises
    ------
    InfeasibleError
        If no stiffness of a spring keeps the follower on the cam.
    """
    design, motion = result.design, result.cam.motions[0]
    pull = design.gravity.pull
    follower, highest = motion.follower, motion.program.range[1]
    loads = Loads(
        program=motion.program,
        follower=follower,
        support=follower.held(design.friction, highest),
        speed=design.drive.speed,
        springs=design.spring,
        given=design.load,
        masses=design.mass,
        pull=-pull.conjugate() if motion.clockwise else pull,
        friction=design.friction,
    )
    if math.isinf(loads.solved.get("stiffness", 0.0)):
        raise _no_stiffness(loads)
    return loads


def _no_stiffness(loads: Loads) -> InfeasibleError:
    """Return the error for a spring that has no force where it is needed, at zero lift."""
    number = next(k for k, one in enumerate(loads.springs) if one.rate == "solve")
    spring = loads.springs[number]
    given = spring.force if isinstance(spring.force, float) else 0.0
    name, unit, scale = "preload_n", "N", 1.0
    if loads.follower.angular:
        name, unit, scale = "preload_nm", "N m", 1e-3
    what = "no stiffness keeps the follower on the cam: at zero lift only a preload does"
    needed = scale * (given + loads.preload_at_rest)
    where, rule = f"spring[{number}].{name}", "the limit is the least preload"
    return beyond_limit(what, where, scale * given, needed, rule, unit=unit)


def places(result: CamResult) -> Array:
    """Return the positions of the driver that are studied; they rise.

    Beside even steps these are both sides of knots of the lift and of the loads, and of places
    where another wall or an edge begins to carry, or the follower begins to lift off or is locked;
    and where forces and contact pressure are largest and least. A cam that slides comes back
    through them.
    """
    period, count = result.program.period, result.design.forces.steps
    even = period * np.arange(count + 1.0) / count
    even[-1] = np.nextafter(period, 0.0)
    knots = [result.program.knots, *(one.knots for one in result.design.load)]
    knots += [touch.edges for touch in result.cam.touches]
    x = with_both_sides(even, np.concatenate(knots))
    loads = loads_of(result)
    for sought in (_changes, _extremes):  # in this order: extremes may lie beside changes
        x = np.union1d(x, sought(result, loads, x))
    return x


def _changes(result: CamResult, loads: Loads, x: Array) -> Array:
    """Return both sides of where something else carries, between positions `x`."""
    x, way = _to_and_fro(loads, x)

    def states(statics: Statics) -> Array:
        on_edge = np.isinf(_pressure(result, statics))
        return 4.0 * statics.carrying + 2.0 * statics.locked + on_edge

    sampled = _statics(result, loads, x, way)
    at = np.flatnonzero((np.diff(states(sampled)) != 0.0) & (np.diff(way) == 0.0))
    beside = _beside(result, loads, (x, way, sampled), at)

    def function(places: Array, rows: Ints) -> Array:
        return states(beside(places, rows))[_SCALES:].reshape(places.shape)

    tolerance = _CLOSE * result.program.period
    return np.concatenate(narrowing.changes(function, x[at], x[at + 1], tolerance))


def _extremes(result: CamResult, loads: Loads, x: Array) -> Array:
    """Return where the quantities of the facts are largest, or least, near positions `x`."""
    x, way = _to_and_fro(loads, x)

    def sought(statics: Statics) -> Array:
        pressure, force = _pressure(result, statics), statics.force
        least = (force, statics.torque, statics.reserve, _driving(statics))
        most = (force, statics.torque, np.where(np.isinf(pressure), np.nan, pressure))
        found = np.stack([*(-one for one in least), *most])
        return np.where(np.isnan(found), -np.inf, found)

    sampled = _statics(result, loads, x, way)
    found = sought(sampled)
    which, at = _peaks(found, np.flatnonzero(np.diff(way, prepend=0.0, append=0.0)))
    beside = _beside(result, loads, (x, way, sampled), at)

    def function(places: Array, rows: Ints) -> Array:
        values = sought(beside(places, rows))[:, _SCALES:].reshape(-1, *places.shape)
        return values[which[rows], np.arange(len(rows))]

    ends = x[np.maximum(at - 1, 0)], x[np.minimum(at + 1, len(x) - 1)]
    found_at, values = narrowing.peaks(function, *ends, _NARROW * result.program.period)
    kept = []
    for number, largest in enumerate(found.max(axis=1)):
        own = np.flatnonzero(which == number)
        best = max(own, key=values.__getitem__, default=None)
        if best is not None and values[best] > largest + _ROUNDING * abs(largest):
            kept.append(found_at[best])
    return np.array(kept)


def _beside(
    result: CamResult, loads: Loads, known: tuple[Array, Array, Statics], at: Ints
) -> Callable[[Array, Ints], Statics]:
    """Return the forces at places in brackets, each on the way of the known position in `at`.

    Before them are those of the largest load, and of the most work: what is rounding, and what is
    near rest, is told by their share of these.

    Parameters
    ----------
    result : CamResult
        The cam.
    loads : Loads
        Its loads.
    known : tuple
        Positions, ways, and the forces there.
    at : (n,) int array
        A position of each bracket.

    Returns
    -------
    callable
        ``function(places, rows)`` of (m, k) places, in each bracket's row.
    """
    x, way, sampled = known
    scales = [int(np.argmax(np.abs(one))) for one in (sampled.against, sampled.useful)]

    def function(places: Array, rows: Ints) -> Statics:
        ways = np.repeat(way[at[rows]], places.shape[1])
        more = np.concatenate([x[scales], places.ravel()])
        return _statics(result, loads, more, np.concatenate([way[scales], ways]))

    return function


def _peaks(values: Array, cuts: Ints) -> tuple[Ints, Ints]:
    """Return rows and columns of the highest peaks in each row of values, (q, n).

    Rows are continuous between `cuts`, the first and the last end included.
    """
    apart = np.insert(values, cuts, -np.inf, axis=1)
    columns = np.insert(np.arange(values.shape[1]), cuts, -1)[1:-1]
    middle = apart[:, 1:-1]
    peak = (middle > apart[:, :-2]) & (middle >= apart[:, 2:])
    heights = np.where(peak, middle, -np.inf)
    best = np.argsort(-heights, axis=1, kind="stable")[:, :_PEAKS]
    row, rank = np.nonzero(np.isfinite(np.take_along_axis(heights, best, axis=1)))
    return row, columns[best[row, rank]]


def _to_and_fro(loads: Loads, x: Array) -> tuple[Array, Array]:
    """Return positions in the order of the motion, and the way of each."""
    way = np.repeat(loads.ways, len(x))
    return np.concatenate([x[:: int(one)] for one in loads.ways]), way


def _statics(result: CamResult, loads: Loads, x: Array, way: Array) -> Statics:
    """Return the forces of a cam at positions of the driver, and ways."""
    design, motion = result.design, loads.motion(x, way)
    return solve(
        result.cam.touches,
        loads.support,
        x,
        motion.ds,
        loads.burden(motion),
        design.friction,
        partial(design.follower.dragged, design.friction),
        way,
    )


def _under_load(result: CamResult) -> tuple[Loads, Array, Array, Statics]:
    """Return the loads of a cam, the positions and ways that are studied, and the forces there."""
    demand(result.design)
    loads = loads_of(result)
    x, way = _to_and_fro(loads, result.places_under_load)
    return loads, x, way, _statics(result, loads, x, way)


def _pressure(result: CamResult, statics: Statics) -> Array:
    """Return the contact pressure, MPa; infinite where an edge of cam or follower carries."""
    per_width = statics.force / result.form.contact_width
    return line_pressure(per_width, statics.curvature, result.design.material)


def largest_pressure(result: CamResult) -> float:
    """Return the largest contact pressure of a cam, MPa; 0 without any contact under load.

    It is infinite where an edge of the cam or the follower carries.

    Parameters
    ----------
    result : CamResult
        The cam.

    Raises
    ------
    DesignError, InfeasibleError
        As those of the study.
    """
    *_, statics = _under_load(result)
    return float(np.nanmax(_pressure(result, statics), initial=0.0))


def study_forces(result: CamResult, study: Study, progress: Progress | None) -> StudyResult:
    """Return the study of the forces of a cam (see `gearcam.cams.statics`).

    Parameters
    ----------
    result : CamResult
        The cam.
    study : Study
        The entry of the study.
    progress : callable, optional
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult
        Its rows are those of ``forces.csv``.

    Raises
    ------
    InfeasibleError
        If the cam is impossible, or no stiffness keeps the follower on it.
    """
    if progress is not None:
        progress("forces", 0, 1)
    design, cam = result.design, result.cam
    with result.stage("forces"):
        loads, x, way, statics = _under_load(result)
        pressure = _pressure(result, statics)
        per_width = statics.force / result.form.contact_width
        half = half_width(per_width, statics.curvature, design.material)
        width = np.where(np.isinf(pressure), np.nan, half)
        only_presses = len(cam.touches) == 1
        release = loads.release if only_presses else None
        _, scale = design.drive.effort
        turns = scale != 1.0
        loaded = Loaded(
            x=x,
            driver=result.driver,
            statics=statics,
            pressure=pressure,
            pointed=math.isinf(result.follower.bend),
            yields=design.material.weakest,
            torque=scale * statics.torque if turns else np.full(x.shape, np.nan),
            way=way if len(loads.ways) > 1 else None,
            release=design.drive.words(release[0]) if release and release[0] else "",
            loose=_place(result, loads, release) if release and not release[0] else "",
            holding=_holding(loads),
        )
        found = enlarged(result, run_checks(FORCES, loaded, design.limits))
    columns = _columns(result, loaded, width)
    return StudyResult(
        result=result,
        study=study,
        file="forces.csv",
        table=columns,
        group=_facts(result, loads, loaded, release),
        study_findings=found,
        drawn=partial(_charts, result, loaded, columns),
    )


def _holding(loads: Loads) -> str:
    """Return what holds the follower on the cam, in words; empty without a spring."""
    lack = loads.lack
    if not loads.springs or lack <= 0.0:
        return ""
    key, scale = ("preload_nm", 1e-3) if loads.follower.angular else ("preload_n", 1.0)
    force = loads.springs[0].force
    given = loads.solved.get("preload", 0.0) if force == "solve" else float(force)
    least = shortened(scale * (given + lack), scale * lack, 3)
    return f"spring[0].{key} = {formatted(least)}"


def _effort(result: CamResult) -> tuple[str, float]:
    """Return name and factor of the column of loads."""
    return ("load_nm", 1e-3) if result.follower.angular else ("load_n", 1.0)


def _columns(result: CamResult, loaded: Loaded, width: Array) -> dict[str, Array]:
    """Return the columns of ``forces.csv``."""
    x, statics, pressure = loaded.x, loaded.statics, loaded.pressure
    driver, drive, motion = result.driver, result.design.drive, result.cam.motions[0]
    (load, load_scale), (effort, scale) = _effort(result), drive.effort
    sign = -1.0 if motion.clockwise else 1.0
    columns = {
        driver.column: driver.scale * x,
        **({} if loaded.way is None else {"direction": loaded.way.astype(int)}),
        load: load_scale * statics.against,
        "normal_n": statics.force,
        "wall": statics.carrying + 1,
        **{
            name: (sign if name in _MIRRORED else 1.0) * values
            for name, values in statics.reactions.items()
        },
        "bearing_n": np.abs(statics.bearing),
        effort: scale * statics.torque,
        "efficiency": statics.efficiency,
        "reserve": statics.reserve,
        "pressure_mpa": np.where(loaded.on_edge, np.nan, pressure),
        "half_width_mm": width,
    }
    if drive.speed is not None:
        watts = 1e-3 * drive.speed
        columns["power_w"] = watts * statics.torque
        columns["losses_w"] = watts * sum(statics.lost.values())
    return {
        name: values if values.dtype.kind == "i" else np.ma.masked_invalid(values)
        for name, values in columns.items()
    }


def _extreme(loaded: Loaded, values: Array, label: str, unit: str) -> Fact | None:
    """Return the range of some values, with the place of the largest, as a fact."""
    if np.isnan(values).all():
        return None
    ends = extent(float(np.nanmin(values)), float(np.nanmax(values)))
    place = f"largest {loaded.at(int(np.nanargmax(values)))}"
    noise = _NOISE * float(np.nanmax(np.abs(values)))
    return Fact(ends, label, place=place, unit=unit, shown=True, noise=noise)


def _facts(
    result: CamResult, loads: Loads, loaded: Loaded, release: tuple[float, float, float] | None
) -> Tree:
    """Return the facts of the study."""
    statics, design = loaded.statics, result.design
    effort, scale = design.drive.effort
    without = design.follower.without_friction(design.friction)
    tree: Tree = {
        "normal_n": _extreme(
            loaded, np.where(statics.lifted, 0.0, statics.force), "normal force", "N"
        ),
        effort: _extreme(
            loaded,
            scale * statics.torque,
            "torque of the cam" if scale != 1.0 else "force of the drive",
            "N m" if scale != 1.0 else "N",
        ),
        "efficiency": _efficiency(loaded),
        "reserve": _least(loaded, statics.reserve, "share that friction leaves"),
        **_largest_pressure(loaded),
        "locked": bool(statics.locked.any()),
        "lifted": bool(statics.lifted.any()),
        "reversals": _reversals(statics),
        "spring": _spring(loads) or None,
        "friction": Fact(", ".join(without), "friction left out", shown=True) if without else None,
    }
    if release is not None and not release[0]:
        label, place = "lifts off at the lowest speeds", _place(result, loads, release)
        tree["lifted_at_rest"] = Fact(True, label, place=place, text="yes", shown=True)
    elif release is not None:
        quantity = design.drive.quantity
        tree[f"release_speed{quantity.suffix}"] = Fact(
            release[0] / quantity.factor,
            "speed at which the follower lifts off",
            place=_place(result, loads, release),
            unit=quantity.unit,
            shown=True,
        )
    return tree


def _place(result: CamResult, loads: Loads, release: tuple[float, float, float]) -> str:
    """Return where a follower lifts off, in words."""
    _, where, way = release
    return result.driver.place(where) + (on_way(way) if len(loads.ways) > 1 else "")


def _least(loaded: Loaded, values: Array, label: str) -> Fact | None:
    if np.isnan(values).all():
        return None
    index = int(np.nanargmin(values))
    return Fact(float(values[index]), label, place=loaded.at(index), unit="")


def _largest_pressure(loaded: Loaded) -> Tree:
    """Return the largest contact pressure; off the edges of a profile, where it has any."""
    values = np.where(loaded.on_edge, np.nan, loaded.pressure)
    if np.isnan(values).all():
        return {}
    name, off = (
        ("pressure_off_edges_mpa", ", off edges") if loaded.on_edge.any() else ("pressure_mpa", "")
    )
    index = int(np.nanargmax(values))
    label = f"largest contact pressure{off}"
    return {name: Fact(float(values[index]), label, place=loaded.at(index), unit="MPa", shown=True)}


def _efficiency(loaded: Loaded) -> Tree | None:
    """Return the overall efficiency, of the work against loads, and the least one."""
    statics = loaded.statics
    driven = _driven(statics)
    if not driven.any():
        return None
    got = _integral(loaded.x, np.where(driven, statics.useful, 0.0))
    put = _integral(loaded.x, np.where(driven, statics.torque, 0.0))
    return {
        "overall": Fact(got / put, "efficiency against the loads", unit="", shown=True),
        "least": _least(loaded, _driving(statics), "least efficiency"),
    }


def _driven(statics: Statics) -> Mask:
    """Return where the cam drives, and moves a load."""
    return (statics.useful > 0.0) & (statics.torque > 0.0)


def _driving(statics: Statics) -> Array:
    """Return the efficiency where the cam drives, away from rest; else nan."""
    strong = statics.useful > _TOLD * np.nanmax(np.abs(statics.useful), initial=0.0)
    return np.where(_driven(statics) & strong, statics.efficiency, np.nan)


def _integral(x: Array, y: Array) -> float:
    return float(np.sum(0.5 * (y[1:] + y[:-1]) * np.abs(np.diff(x))))


def _reversals(statics: Statics) -> int | None:
    """Return how often the follower changes walls; None with one wall."""
    walls = statics.carrying[statics.carrying >= 0]
    changes = int(np.count_nonzero(np.diff(walls)))
    return changes or None


def _spring(loads: Loads) -> Tree:
    """Return the solved values of springs as facts."""
    swings, made = loads.follower.angular, {}
    names = {"preload": "preload_nm", "stiffness": "stiffness_nm_rad"}
    scale = 1e-3
    if not swings:
        names, scale = {"preload": "preload_n", "stiffness": "stiffness_n_mm"}, 1.0
    for what, value in loads.solved.items():
        label = f"least {what} of the spring"
        made[names[what]] = Fact(scale * value, label, shown=True)
    return made


TITLES: Final = {
    "normal_n": ("Normal force between cam and follower", "normal force, N"),
    "torque_nm": ("Torque of the cam", "torque, N m"),
    "drive_n": ("Force that drives the cam", "force, N"),
    "pressure_mpa": ("Contact pressure (Hertz)", "contact pressure, MPa"),
    "efficiency": ("Efficiency", "efficiency"),
}
"""Titles and axes of charts by columns."""

COLOURS: Final = ("normal_n", "pressure_mpa")
"""Columns that the profile can be coloured by."""


def _on_each_way(loaded: Loaded) -> Iterator[tuple[str, Ints]]:
    """Yield the name of each way, to follow a label, and its rows by rising positions."""
    rows = np.arange(len(loaded.x))
    if loaded.way is None:
        yield "", rows
    else:
        yield ", forward", rows[loaded.way > 0.0]
        yield ", back", rows[loaded.way < 0.0][::-1]


def _along(result: CamResult, loaded: Loaded, columns: Mapping[str, Any]) -> Chart | None:
    """Return the chart of the contact pressure along each wall."""
    pressure = np.ma.filled(columns["pressure_mpa"], np.nan)
    if not np.isfinite(pressure).any():
        return None
    lines = tuple(
        Line(
            label=(f"{touch.key} wall" if touch.key else "profile") + way,
            x=touch.along(loaded.x[rows]),
            y=np.where(columns["wall"] == number, pressure, np.nan)[rows],
        )
        for number, touch in enumerate(result.cam.touches, start=1)
        for way, rows in _on_each_way(loaded)
    )
    where, title = "from the contact at the start, mm", "Contact pressure along the profile"
    return Chart(title=title, x=f"arc length {where}", y="contact pressure, MPa", lines=lines)


def _charts(result: CamResult, loaded: Loaded, columns: Mapping[str, Any]) -> dict[str, Chart]:
    """Return charts of forces over the driver, and of the pressure along the profile."""
    column, label = places_of(result)
    given = result.design.limits
    limits = {
        "pressure_mpa": limit_of(FORCES, "contact-pressure", given),
        "torque_nm": limit_of(FORCES, "drive-torque", given) / TORQUE.factor,
    }
    charts = {}
    for name, (title, axis) in TITLES.items():
        values = np.ma.filled(columns[name], np.nan) if name in columns else None
        if values is None or not np.isfinite(values).any():
            continue
        most = limits.get(name)
        charts[name.partition("_")[0]] = Chart(
            title=title,
            x=label,
            y=axis,
            lines=tuple(
                Line(
                    label=axis.partition(",")[0] + way,
                    x=np.asarray(columns[column])[rows],
                    y=values[rows],
                )
                for way, rows in _on_each_way(loaded)
            ),
            limits=(Limit(label="limit", value=most),) if most else (),
            marks=knots_of(result),
        )
    along = _along(result, loaded, columns)
    return charts if along is None else charts | {"profile_pressure": along}
