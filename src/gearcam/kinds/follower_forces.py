"""The study of forces of a cam: statics of its follower, contact pressure, springs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.facts import Fact, Tree
from gearcam.base.findings import limit_of, run_checks
from gearcam.base.numerals import formatted, shortened
from gearcam.base.quantities import TORQUE
from gearcam.kinds.over_driver import over_driver
from gearcam.kinds.shared import NOISE, range_fact
from gearcam.kinds.under_load import UnderLoad, efficiency_away_from_rest
from gearcam.mechanics.follower_loads import Loads
from gearcam.mechanics.force_checks import Loaded, on_way
from gearcam.mechanics.hertz import half_width, yield_pressure
from gearcam.mechanics.load import FORCES
from gearcam.pictures.charts import Chart, Limit, Line
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from gearcam.base.findings import Finding
    from gearcam.kinds.loaded_cam import LoadedCam
    from gearcam.mechanics.statics import Statics
    from gearcam.numeric.arrays import Array, Ints
    from gearcam.results.study import Progress


@dataclass(frozen=True)
class MoreOfForces:
    """What a kind of cam adds to the study of its forces.

    Parameters
    ----------
    findings : callable
        Returns findings as they are shown, from those of the checks.
    charts : callable
        ``charts(loaded, columns)`` returns further charts.
    columns : callable
        Returns further columns.
    facts : callable
        Returns further facts.
    """

    findings: Callable[[Iterable[Finding]], tuple[Finding, ...]]
    charts: Callable[[Loaded, Mapping[str, Any]], dict[str, Chart]]
    columns: Callable[[Loaded], dict[str, Any]] = lambda _: {}
    facts: Callable[[Loaded], Tree] = lambda _: {}


def forces_of(result: LoadedCam, progress: Progress, more: MoreOfForces) -> StudyResult:
    """Return the study of the forces of a cam (see `gearcam.mechanics.statics`).

    Parameters
    ----------
    result : LoadedCam
        The cam.
    progress : Progress
        Called with what is computed, the number done and their total.
    more : MoreOfForces
        What its kind adds.

    Returns
    -------
    StudyResult
        Its rows are those of ``forces.csv``.

    Raises
    ------
    InfeasibleError
        If the cam is impossible, or no stiffness keeps the follower on it.
    """
    progress("forces", 0, 1)
    design = result.design
    with result.stage("forces"):
        under = UnderLoad(result)
        loads, (x, way) = under.loads, under.to_and_fro(result.places_under_load)
        statics = under.statics(x, way)
        pressure = under.pressure(statics)
        half = half_width(statics.force / statics.width, statics.curvature, design.material)
        width = np.where(np.isinf(pressure), np.nan, half)
        only_presses = len(result.touches) == 1
        release = loads.release if only_presses else None
        _, scale = design.drive.effort
        turns = scale != 1.0
        loaded = Loaded(
            x=x,
            driver=result.driver,
            statics=statics,
            pressure=pressure,
            pointed=math.isinf(result.follower.bend),
            yielding=yield_pressure(design.material),
            torque=scale * statics.torque if turns else np.full(x.shape, np.nan),
            way=way if len(loads.ways) > 1 else None,
            release=design.drive.words(release[0]) if release and release[0] else "",
            loose=_place(result, loads, release) if release and not release[0] else "",
            holding=_holding(loads),
            above=loads.side < 0.0,
        )
        found = more.findings(run_checks(FORCES, loaded, design.limits))
    columns = _columns(result, loaded, width, more)
    return StudyResult(
        result=result,
        study=result.kind.studies["forces"],
        file="forces.csv",
        table=columns,
        group=_facts(result, loads, loaded, release) | more.facts(loaded),
        study_findings=found,
        drawn=partial(_charts, result, loaded, columns, more),
    )


def _holding(loads: Loads) -> str:
    """Return what holds the follower on the cam, in words; empty without a spring."""
    lack = loads.lack
    if not loads.springs or lack <= 0.0:
        return ""
    scale, _, suffix = loads.follower.load_unit
    force = loads.springs[0].force
    given = loads.solved.get("preload", 0.0) if force == "solve" else float(force)
    least = shortened(scale * (given + lack), scale * lack, 3)
    return f"spring[0].preload_{suffix} = {formatted(least)}"


def _columns(
    result: LoadedCam, loaded: Loaded, width: Array, more: MoreOfForces
) -> dict[str, Array]:
    """Return the columns of ``forces.csv``."""
    x, statics, pressure = loaded.x, loaded.statics, loaded.pressure
    driver, drive, motion = result.driver, result.design.drive, result.cam.motions[0]
    mirrored = motion.follower.held(result.design.friction, 0.0).mirrored
    (load_scale, _, suffix), (effort, scale) = result.follower.load_unit, drive.effort
    columns = {
        driver.column: driver.scale * x,
        **({} if loaded.way is None else {"direction": loaded.way.astype(int)}),
        f"load_{suffix}": load_scale * statics.against,
        "normal_n": statics.force,
        "wall": statics.carrying + 1,
        **{
            name: (motion.hand if name in mirrored else 1.0) * values
            for name, values in statics.reactions.items()
        },
        "bearing_n": np.abs(statics.bearing),
        effort: scale * statics.torque,
        "efficiency": statics.efficiency,
        "reserve": statics.reserve,
        "pressure_mpa": np.where(loaded.on_edge, np.nan, pressure),
        "half_width_mm": width,
        **more.columns(loaded),
    }
    if drive.speed is not None:
        watts = 1e-3 * drive.speed
        columns["power_w"] = watts * statics.torque
        columns["losses_w"] = watts * sum(statics.lost.values())
    return {
        name: values if values.dtype.kind == "i" else np.ma.masked_invalid(values)
        for name, values in columns.items()
    }


def _facts(
    result: LoadedCam, loads: Loads, loaded: Loaded, release: tuple[float, float, float] | None
) -> Tree:
    """Return the facts of the study."""
    statics, design = loaded.statics, result.design
    effort, scale = design.drive.effort
    without = result.follower_spec.without_friction(design.friction)
    walls = statics.carrying[statics.carrying >= 0]
    tree: Tree = {
        "normal_n": range_fact(
            np.where(statics.lifted, 0.0, statics.force), "normal force", "N", loaded.at
        ),
        effort: range_fact(
            scale * statics.torque,
            "torque of the cam" if scale != 1.0 else "force of the drive",
            "N m" if scale != 1.0 else "N",
            loaded.at,
        ),
        "efficiency": _efficiency(loaded),
        "reserve": _least(loaded, statics.reserve, "share that friction leaves"),
        **_largest_pressure(loaded, design.limits),
        "largest": {
            name: _largest(loaded, values, BEARINGS[name])
            for name, values in _bearings(loaded).items()
        },
        "locked": _locked(statics),
        "lifted": bool(statics.lifted.any()),
        "reversals": int(np.count_nonzero(np.diff(walls))) or None,
        "spring": solved_springs(loads, loads.solved) or None,
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


def _place(result: LoadedCam, loads: Loads, release: tuple[float, float, float]) -> str:
    """Return where a follower lifts off, in words."""
    _, where, way = release
    return result.driver.place(where) + (on_way(way) if len(loads.ways) > 1 else "")


def _least(loaded: Loaded, values: Array, label: str) -> Fact | None:
    if np.isnan(values).all():
        return None
    index = int(np.nanargmin(values))
    return Fact(float(values[index]), label, place=loaded.at(index), unit="")


def _locked(statics: Statics) -> Fact | bool:
    """Return whether friction locks the follower; then there are forces elsewhere only."""
    if not statics.locked.any():
        return False
    text = "yes: the forces are those of other places"
    return Fact(True, "friction locks the follower", text=text, shown=True)


def _bearings(loaded: Loaded) -> dict[str, Array]:
    """Return what bearings and guides exert that is shown, by columns."""
    found = {"bearing_n": np.abs(loaded.statics.bearing), **loaded.statics.reactions}
    return {name: values for name, values in found.items() if name in BEARINGS}


def _largest(loaded: Loaded, values: Array, label: str) -> Fact | None:
    """Return the largest size of what a bearing exerts."""
    if np.isnan(values).all():
        return None
    index = int(np.nanargmax(np.abs(values)))
    size = float(np.abs(values[index]))
    noise = NOISE * float(np.nanmax(loaded.statics.force, initial=0.0))
    return Fact(size, f"largest {label}", place=loaded.at(index), shown=True, noise=noise)


def _largest_pressure(loaded: Loaded, limits: Mapping[str, float]) -> Tree:
    """Return the largest contact pressure; off the edges of a profile, where it has any."""
    values = np.where(loaded.on_edge, np.nan, loaded.pressure)
    if np.isnan(values).all():
        return {}
    name, off = (
        ("pressure_off_edges_mpa", ", off edges") if loaded.on_edge.any() else ("pressure_mpa", "")
    )
    index = int(np.nanargmax(values))
    most = limit_of(FORCES, "contact-pressure", limits) or loaded.yielding
    return {
        name: Fact(
            float(values[index]),
            f"largest contact pressure{off}",
            at_most=most if math.isfinite(most) else None,
            place=loaded.at(index),
            unit="MPa",
            shown=True,
        )
    }


def _efficiency(loaded: Loaded) -> Tree | None:
    """Return the overall efficiency, of the work against loads, and the least one."""
    statics = loaded.statics
    driven = statics.driven
    if not driven.any():
        return None
    got = _integral(loaded.x, np.where(driven, statics.useful, 0.0))
    put = _integral(loaded.x, np.where(driven, statics.torque, 0.0))
    least = efficiency_away_from_rest(statics)
    return {
        "overall": Fact(got / put, "efficiency against the loads", unit="", shown=True),
        "least": _least(loaded, least, "least efficiency"),
    }


def _integral(x: Array, y: Array) -> float:
    return float(np.sum(0.5 * (y[1:] + y[:-1]) * np.abs(np.diff(x))))


def solved_springs(loads: Loads, solved: Mapping[str, float]) -> Tree:
    """Return what springs among `loads` are `solved` for, N or N mm and so on, as facts."""
    scale, _, suffix = loads.follower.load_unit
    per = "rad" if loads.follower.angular else "mm"
    names = {"preload": f"preload_{suffix}", "stiffness": f"stiffness_{suffix}_{per}"}
    return {
        names[what]: Fact(scale * value, f"least {what} of the spring", shown=True)
        for what, value in solved.items()
    }


TITLES: Final = {
    "normal_n": ("Normal force between cam and follower", "normal force, N"),
    "torque_nm": ("Torque of the cam", "torque, N m"),
    "drive_n": ("Force that drives the cam", "force, N"),
    "pressure_mpa": ("Contact pressure (Hertz)", "contact pressure, MPa"),
    "efficiency": ("Efficiency", "efficiency"),
}
"""Titles and axes of charts by columns."""

BEARINGS: Final = {
    "bearing_n": "force of the cam's bearing",
    "bearing_thrust_n": "thrust of the cam's bearing",
    "guide_low_n": "force of the guide's lower end",
    "guide_high_n": "force of the guide's upper end",
    "pivot_n": "force of the pivot",
    "pivot_thrust_n": "thrust of the pivot",
    "pivot_moment_nmm": "couple of the pivot",
}
"""What bearings and guides exert that is shown, by columns."""

COLOURS: Final = ("normal_n", "pressure_mpa")
"""Columns that the profile can be coloured by."""


def on_each_way(loaded: Loaded) -> Iterator[tuple[str, Ints]]:
    """Yield the name of each way, to follow a label, and its rows by rising positions."""
    rows = np.arange(len(loaded.x))
    if loaded.way is None:
        yield "", rows
    else:
        yield ", forward", rows[loaded.way > 0.0]
        yield ", back", rows[loaded.way < 0.0][::-1]


def _charts(
    result: LoadedCam, loaded: Loaded, columns: Mapping[str, Any], more: MoreOfForces
) -> dict[str, Chart]:
    """Return charts of forces over the driver, and those that the kind adds."""
    chart, column = over_driver(result), result.driver.column
    given = result.design.limits
    limits = {
        "pressure_mpa": limit_of(FORCES, "contact-pressure", given),
        "torque_nm": limit_of(FORCES, "drive-torque", given) / TORQUE.factor,
    }

    def lines(name: str, label: str) -> tuple[Line, ...]:
        x, y = np.asarray(columns[column]), np.ma.filled(columns[name], np.nan)
        return tuple(
            Line(label=label + way, x=x[rows], y=y[rows]) for way, rows in on_each_way(loaded)
        )

    charts = {}
    for name, (title, axis) in TITLES.items():
        if name not in columns or not np.isfinite(np.ma.filled(columns[name], np.nan)).any():
            continue
        most = limits.get(name)
        charts[name.partition("_")[0]] = chart(
            title=title,
            y=axis,
            lines=lines(name, axis.partition(",")[0]),
            limits=(Limit(label="limit", value=most),) if most else (),
        )
    forces = [name for name in _bearings(loaded) if name.endswith("_n")]
    charts["bearings"] = chart(
        title="Forces of bearings and guides",
        y="force, N",
        lines=tuple(line for name in forces for line in lines(name, BEARINGS[name])),
    )
    return charts | more.charts(loaded, columns)
