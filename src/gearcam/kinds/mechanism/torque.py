"""The study of a mechanism's torque: what its driver and the shafts of its drives exert."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, InfeasibleError, Problem
from gearcam.base.facts import Fact, extent
from gearcam.base.findings import Remark, check, limit_of, run_checks
from gearcam.base.numerals import formatted
from gearcam.base.quantities import TORQUE as NEWTON_METRES
from gearcam.base.quantities import Param
from gearcam.base.readable import readable
from gearcam.kinds.mechanism.asked import DEG
from gearcam.kinds.mechanism.loaded import BODY, work_of
from gearcam.kinds.mechanism.names import acting, several, tables_of
from gearcam.kinds.mechanism.parts import ACTIONS
from gearcam.kinds.mechanism.parts.action import MachineAction
from gearcam.linkages.efforts import GRAVITY, PARTS, SPRINGS, InertiaForce
from gearcam.linkages.measures import Peak
from gearcam.numeric.piecewise import with_both_sides
from gearcam.pictures.charts import Chart, Limit, Line
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.placed import PlacedDrive
    from gearcam.kinds.mechanism.result import MechanismResult
    from gearcam.linkages.work import VirtualWork
    from gearcam.numeric.arrays import Array
    from gearcam.results.study import Progress

Tree = dict[str, Any]

Ends = tuple[Peak, Peak]
"""The least and the largest value of a quantity."""

_NM: Final = 1e-3
"""N m of a N mm."""

_NOISE: Final = 1e-9
"""Share of the moment's integral below which its work is rounding."""

_NOTHING: Final = 1e-6
"""Work, N mm, that is none: what rounding makes of forces that do no work."""

_BESIDE: Final = np.linspace(-1.0, 1.0, 33)
"""Places beside a largest value, in steps, at which a larger one is looked for."""

_ROUNDS: Final = 4
"""How often, each time more closely."""

CHECKS: Final = "torque of a mechanism"
"""Name of the subject of its checks."""

_LESS: Final = 0.99
"""Share of the driver's moment that is less than it."""

_ONE_SIDED: Final = {"disc": 1.0, "lower": 1.0, "upper": -1.0}
"""The side to which cams with one wall push, by their form or their wall: 1 in the lift."""

EVEN: Final = "even_shaft"
"""What a mechanism behind a pair is compared with if the design does not say."""


def demand(design: Any) -> None:
    """Refuse a design on which nothing acts, or in which a speed is missing.

    Parameters
    ----------
    design : MechanismDesign
        The design.

    Raises
    ------
    DesignError
        If it is so.
    """
    tables = tables_of(design)
    every = [one for *_, one in several(tables) if isinstance(one, MachineAction)]
    if not every:
        *words, last = (f"[[{title}]]" for title in tables if title in ACTIONS)
        problem = Problem(
            "nothing acts on the mechanism",
            file=design.source,
            key="load",
            allowed=f"a table {', '.join(words)} or {last}",
        )
        raise DesignError([problem])
    reasons = (one.needs_speed(design.gravity) for one in every)
    why = next((one for one in reasons if one), "")
    if why and design.drive[0].speed is None:
        what, near = f"is missing: {why}", "a speed above 0"
        problem = Problem(what, file=design.source, key="drive[0].speed_rpm", allowed=near)
        raise DesignError([problem])


class ShaftLoad(NamedTuple):
    """What a shaft or a slide of a drive exerts on the linkage.

    Attributes
    ----------
    column : str
        Its name in the table.
    values : (n,) array
        N m, or N.
    meaning : str
        In words.
    loose : float
        Of a cam with one wall, off which its follower can be lifted, the side to which it pushes;
        0 of others.
    drive : str
        Name of the drive.
    """

    column: str
    values: Array
    meaning: str
    loose: float = 0.0
    drive: str = ""

    def of(self, drive: str) -> ShaftLoad:
        """Return the same with the name of its drive: one of several."""
        return self._replace(column=f"{drive}_{self.column}", meaning=f"{drive}: {self.meaning}")


class Pull(NamedTuple):
    """The most with which a mechanism pulls a follower off a cam that does not hold it.

    Attributes
    ----------
    cam : str
        Where the cam is in the design.
    size : float
        Of the pull, above 0.
    unit : str
        N, or N m of an oscillating follower.
    place : str
        Where it is, in words.
    """

    cam: str
    size: float
    unit: str
    place: str


@dataclass(frozen=True, kw_only=True)
class DriverEffort(ShortRepr):
    """The largest moment that the driver of a mechanism exerts, and those behind other drives.

    Parameters
    ----------
    peak : float, N m
        The largest size of the moment.
    place : str
        Where it is, in words.
    others : mapping of str to float, N m
        The same behind other drives, by their names.
    gain : str
        How a pair multiplies the moment there, as a sentence; empty without one.
    pulls : tuple of Pull
        Of followers that the mechanism pulls off their cams.
    """

    peak: float
    place: str
    others: Mapping[str, float]
    gain: str = ""
    pulls: tuple[Pull, ...] = ()


_LIMIT: Final = (
    "drive_torque",
    Param(NEWTON_METRES, ge=0, le=1e9, doc="largest torque of the mechanism's drive; 0: no limit"),
    0.0,
)


@check(
    "drive-torque",
    kind=CHECKS,
    limit=_LIMIT,
    relation="at most",
    severity=("note", "warning"),
    unit="N m",
)
def drive_torque(effort: DriverEffort, limit: float) -> Iterator[Remark]:
    """Warn if the mechanism needs more torque than its drive has; tell if another drive needs less.

    Looks at: the largest moment of the driver, and of each drive that is compared; behind a pair
    that of an even shaft, if none is.
    """
    if limit and effort.peak > limit / NEWTON_METRES.factor:
        what = "The mechanism needs more torque than its drive has."
        yield Remark(what, effort.place, effort.peak, "warning")
    for name, other in effort.others.items():
        if other < _LESS * effort.peak:
            times = formatted(effort.peak / other, 3) if other > 0.0 else "many"
            message = (
                f"The driver exerts up to {readable(effort.peak, 'N m')}, {times} times the "
                f"{readable(other, 'N m')} of the same mechanism behind {name!r}."
                f"{effort.gain}"
            )
            yield Remark(message, effort.place, effort.peak, limit=math.inf)


@check("lift-off", kind=CHECKS, severity="note")
def lift_off(effort: DriverEffort, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Tell where a mechanism pulls a follower off its cam, which must be held there.

    Looks at: what each follower exerts in its lift, of cams with one wall, without the springs and
    loads of the cam's own design.
    """
    for pull in effort.pulls:
        message = (
            f"The machine pulls the follower off its cam, with up to {formatted(pull.size, 5)} "
            f"{pull.unit}. A spring in the cam's own design must hold it, or a groove or conjugate "
            "cams."
        )
        yield Remark(message, f"{pull.cam}, {pull.place}", pull.size, unit=pull.unit)


def study_torque(result: MechanismResult, progress: Progress | None) -> StudyResult:
    """Return the study of the driver's moment (see `gearcam.linkages.work`).

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    progress : callable, optional
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult
        Its rows are those of ``torque.csv``.

    Raises
    ------
    InfeasibleError
        If the mechanism does not close, or a load is not finite.
    """
    demand(result.design)
    even = None if result.design.compare else result.without_pair
    others = result.compared if even is None else {EVEN: even}
    if progress is not None:
        progress("torque", 0, 1 + len(others))
    with result.stage("torque"):
        work = work_of(result.design, result.linkage, result.drives)
        q = _places(result, work)
        columns = _columns(result, work, q)
        beside = {
            name: work_of(other.design, other.linkage, other.drives)
            for name, other in others.items()
        }
        shafts = list(shaft_loads(result, work, q))
        columns |= {one.column: one.values for one in shafts}
        ends = _ends(result, work, shafts, q)
        top = _largest(work)
        effort = DriverEffort(
            peak=_NM * abs(top.value),
            place=result.place(top.place),
            others={name: _NM * abs(_largest(one).value) for name, one in beside.items()},
            gain=_gain(result.drives[0], work, top.place),
            pulls=tuple(_pulls(result, shafts, ends)),
        )
        found = run_checks(CHECKS, effort, result.design.limits)
    if result.speed is not None:
        columns["power_w"] = columns["torque_nm"] * result.speed
    return StudyResult(
        result=result,
        study=result.kind.studies["torque"],
        file="torque.csv",
        table=columns,
        group=_facts(result, work, beside, shafts, ends),
        study_findings=found,
        drawn=partial(_charts, result, columns, beside),
    )


def _places(result: MechanismResult, work: VirtualWork) -> Array:
    """Return the master's angles of the table, with both sides of knots."""
    return with_both_sides(work.linkage.even_places(result.design.torque.steps), work.knots)


def _columns(result: MechanismResult, work: VirtualWork, q: Array) -> dict[str, Array]:
    """Return the driver's angle and moment, whole and in parts."""
    parts = {part: _NM * np.asarray(one.c[0]) for part, one in work.parts(q).items()}
    total = sum(parts.values(), start=np.zeros(q.shape))
    if not np.isfinite(total).all():
        where = result.place(float(q[~np.isfinite(total)][0]))
        raise InfeasibleError(f"a load or spring is not finite at {where}", where="load")
    columns = {f"{result.driver[0]}_deg": DEG * q, "torque_nm": total}
    return columns | {f"{part}_nm": values for part, values in parts.items()}


def shaft_loads(result: MechanismResult, work: VirtualWork, q: Array) -> Iterator[ShaftLoad]:
    """Yield what the wheels of pairs and the followers of cams exert.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    work : VirtualWork
        What acts on it.
    q : (n,) array, rad
        The master's angles.
    """
    drives = [one for one in result.drives if one.spec.pair is not None or one.spec.cam is not None]
    for drive in drives:
        one = _of_pair if drive.spec.pair else _of_cam
        for found in one(drive, work, q):
            load = found._replace(drive=drive.spec.name)
            yield load if len(drives) == 1 else load.of(drive.spec.name)


def _of_pair(drive: PlacedDrive, work: VirtualWork, q: Array) -> Iterator[ShaftLoad]:
    driven = "rack" if "rack" in drive.moved else "wheel2"
    rates = {
        word: np.asarray(work.linkage.track(f"{drive.spec.name}.{word}", q, 1).derivatives()[1])
        for word in ("wheel1", driven)
    }
    side = float(np.sign(rates[driven].mean()))
    own = work.on({f"{drive.spec.name}.{driven}": side}, q)
    ratio = np.abs(rates[driven] / rates["wheel1"])
    yield ShaftLoad(
        "wheel1_torque_nm", _NM * own * ratio, "moment that the pair takes from wheel 1"
    )
    if driven == "rack":
        yield ShaftLoad("rack_force_n", own, "force of the rack")
    else:
        yield ShaftLoad("wheel2_torque_nm", _NM * own, "moment on wheel 2")


def _of_cam(drive: PlacedDrive, work: VirtualWork, q: Array) -> Iterator[ShaftLoad]:
    word, moved = next(reversed(drive.moved.items()))
    side = -1.0 if drive.spec.mirror and not moved.along else 1.0
    own = work.on({f"{drive.spec.name}.{word}": side * moved.sense}, q)
    cam = drive.result.design.cam
    loose = _ONE_SIDED.get(getattr(cam, "walls", cam.form), 0.0)
    if moved.along:
        yield ShaftLoad("follower_force_n", own, "force of the follower in its lift", loose)
    else:
        meaning = f"torque of the {word} in its {'index' if word == 'turret' else 'lift'}"
        yield ShaftLoad(f"{word}_torque_nm", _NM * own, meaning, loose)


def _ends(
    result: MechanismResult, work: VirtualWork, shafts: list[ShaftLoad], q: Array
) -> dict[str, Ends]:
    """Return the least and the largest of what each shaft exerts, between the rows too."""
    peaks = {}
    for load, side in product(shafts, (-1.0, 1.0)):
        top = int((side * load.values).argmax())
        peaks[load.column, side] = Peak(side * float(load.values[top]), float(q[top]))
    step = float(q[-1] - q[0]) / result.design.torque.steps
    for _ in range(_ROUNDS):
        near = np.clip([peak.place + step * _BESIDE for peak in peaks.values()], q[0], q[-1])
        again = {one.column: one.values for one in shaft_loads(result, work, near.ravel())}
        for number, ((column, side), peak) in enumerate(list(peaks.items())):
            values = side * again[column].reshape(near.shape)[number]
            top = int(values.argmax())
            closer = Peak(float(values[top]), float(near[number, top]))
            peaks[column, side] = max(peak, closer, key=lambda one: one.value)
        step *= 2.0 / (_BESIDE.size - 1)
    return {
        one.column: (
            peaks[one.column, -1.0]._replace(value=-peaks[one.column, -1.0].value),
            peaks[one.column, 1.0],
        )
        for one in shafts
    }


def _pulls(
    result: MechanismResult, shafts: list[ShaftLoad], ends: Mapping[str, Ends]
) -> Iterator[Pull]:
    """Yield the most with which the mechanism pulls each loose follower off its cam."""
    names = [one.name for one in result.design.drive]
    for one in shafts:
        off, on = ends[one.column] if one.loose > 0.0 else reversed(ends[one.column])
        pull = -one.loose * off.value
        if pull > _NOISE * abs(on.value):
            unit = "N" if one.column.endswith("_n") else "N m"
            cam = f"drive[{names.index(one.drive)}].cam"
            yield Pull(cam, pull, unit, result.place(off.place))


def _largest(work: VirtualWork) -> Peak:
    """Return the moment of the largest size."""
    return max(work.largest, work.least, key=lambda one: abs(one.value))


def _gain(drive: PlacedDrive, work: VirtualWork, place: float) -> str:
    """Return how the pair of the master multiplies the moment on wheel 2, in words."""
    if "wheel2" not in drive.moved:
        return ""
    track = work.linkage.track(f"{drive.spec.name}.wheel2", np.array([place]), 1)
    ratio = abs(float(track.derivatives()[1][0]))
    return f" There the pair multiplies the moment on wheel 2 by its ratio {formatted(ratio, 4)}."


def _facts(
    result: MechanismResult,
    work: VirtualWork,
    beside: Mapping[str, VirtualWork],
    shafts: list[ShaftLoad],
    ends: Mapping[str, Ends],
) -> Tree:
    """Return the facts of the study."""
    speed = result.speed
    per = "cycle" if work.linkage.closed else "range"
    low, high = work.linkage.span
    # of what keeps its energy rounding is left over
    noise = _NM * _NOISE * sum(size for _, size in work.works.values())
    least = noise / (high - low)
    tree: Tree = {
        **_range(result, work, "moment of the driver"),
        "mean_nm": Fact(_NM * work.mean, "mean moment of the driver", shown=True, noise=least),
        "work_j": Fact(
            _NM * work.work, f"work of the driver in a {per}", unit="J", shown=True, noise=noise
        ),
        "works_j": {
            part: Fact(_NM * own, unit="J", noise=_NM * _NOISE * size)
            for part, (own, size) in work.works.items()
        },
    }
    if speed is not None:
        power = _NM * work.mean * speed
        tree["mean_power_w"] = Fact(power, "mean power", unit="W", shown=True, noise=least * speed)
    tree |= {one.column: _extent(result, ends[one.column], one.meaning, 1.0) for one in shafts}
    if beside:
        tree["compared"] = {
            name: _range(result, other, f"moment of the driver: {name}")
            for name, other in beside.items()
        }
    error = _error(result, work)
    if error is not None:
        tree["error"] = Fact(error, "work left over in a cycle, as a share", unit="")
    return tree | {"assumptions": Fact(_assumptions(result, work), "assumed", shown=True)}


def _range(result: MechanismResult, work: VirtualWork, meaning: str) -> Tree:
    """Return the least and the largest moment of the driver, and where they are."""
    least, largest = work.least, work.largest
    fact = _extent(result, (least, largest), meaning, _NM)
    at = {"min": math.degrees(least.place), "max": math.degrees(largest.place)}
    return {"torque_nm": fact, "torque_at_deg": at}


def _extent(result: MechanismResult, ends: Ends, meaning: str, scale: float) -> Fact:
    """Return the least and the largest of what is exerted, times a scale, as a fact."""
    (least, low), (largest, high) = ((scale * end.value, result.place(end.place)) for end in ends)
    noise = _NOISE * max(abs(least), abs(largest))
    place = f"least {low}, largest {high}" if largest - least > noise else ""
    return Fact(extent(least, largest), meaning, place=place, shown=True, noise=noise)


def _error(result: MechanismResult, work: VirtualWork) -> float | None:
    """Return the work of what keeps its energy over a cycle, as a share; it should be 0."""
    damped = any(one.damped for _, one in acting(tables_of(result.design)))
    kept = [part for part in work.kept if not (damped and part == SPRINGS)]
    found = [work.works[part] for part in kept if part in work.works]
    whole = sum(size for _, size in work.works.values())
    if not work.linkage.closed or not found or whole < _NOTHING:
        return None
    return sum(abs(own) for own, _ in found) / whole


def _assumptions(result: MechanismResult, work: VirtualWork) -> str:
    heavy = (one.member for one in work.efforts if isinstance(one, InertiaForce))
    names = ", ".join(name.removesuffix(BODY) for name in dict.fromkeys(heavy))
    words = [
        "no friction",
        "the driver turns evenly" if result.speed else "at rest, without inertia",
        f"masses of {names}" if names else "no masses",
        "gravity" if any(one.part == GRAVITY for one in work.efforts) else "no gravity",
    ]
    return ", ".join(words)


def _charts(
    result: MechanismResult, columns: Mapping[str, Array], beside: Mapping[str, VirtualWork]
) -> dict[str, Chart]:
    """Return charts of the driver's moment, its parts, and those behind other drives."""
    angle, design = next(iter(columns.values())), result.design

    def chart(title: str, lines: list[Line], *limits: Limit) -> Chart:
        y = "moment, N m"
        return Chart(title=title, x=result.axis, y=y, lines=tuple(lines), limits=limits)

    lines = [Line(label=design.drive[0].name, x=angle, y=columns["torque_nm"])]
    for name, work in beside.items():
        q = _places(result, work)
        lines.append(Line(label=name, x=DEG * q, y=_NM * np.asarray(work.moment(q).c[0])))
    most = limit_of(CHECKS, "drive-torque", design.limits) / NEWTON_METRES.factor
    limits = [Limit(label="limit", value=most)] if most else []
    charts = {"torque": chart("Moment of the driver", lines, *limits)}
    own = [name for name in PARTS if f"{name}_nm" in columns]
    parts = [Line(label=name, x=angle, y=columns[f"{name}_nm"]) for name in own]
    if len(parts) > 1:
        charts["torque_parts"] = chart("What the driver's moment is made of", parts)
    return charts
