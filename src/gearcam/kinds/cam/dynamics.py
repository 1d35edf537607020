"""The study of the dynamics of a cam: its follower in motion on an elastic train."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.facts import Fact, Tree
from gearcam.base.findings import limit_of, run_checks
from gearcam.base.numerals import formatted
from gearcam.base.readable import number
from gearcam.dynamics.follower_checks import MOVING, MovingFollower
from gearcam.dynamics.periodic import Periodic
from gearcam.dynamics.residual import residual
from gearcam.kinds.cam.fit import law_text
from gearcam.kinds.cam.moving import MovingCam
from gearcam.kinds.follower_forces import solved_springs
from gearcam.kinds.over_driver import over_driver
from gearcam.kinds.shared import NOISE, range_fact
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.phases_of_lift import RisePhase
from gearcam.pictures.charts import Chart, Limit, Line
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from gearcam.kinds.cam.moving import Moment
    from gearcam.kinds.cam.result import CamResult
    from gearcam.numeric.arrays import Array
    from gearcam.results.study import Progress

_SHOWN: Final = ("harmonic", "cycloidal", "constant-acceleration", "3-4-5", "modified-sine")
"""Laws in the chart of residual vibrations, beside those of the design."""

_SPECTRUM: Final = 4096
"""Even places of the turn for the spectrum."""

_RATIOS: Final = 601
"""Places in the chart of residual vibrations."""

_SPEEDS: Final = 61
"""Speeds in the chart of vibrations over the speed."""

_INSIDE: Final = 100
"""Places of a dwell at which vibrations are looked at there."""

_FARTHEST: Final = 100.0
"""Largest time of a rise over the natural period in that chart: beyond hardly anything is left."""

_FLOOR: Final = 1e-4
"""Where that chart ends, unless a phase of the design is below: laws have zeros."""

_HARMONICS: Final = 1e-6
"""Least harmonic that is shown, over the largest."""


def study_dynamics(result: CamResult, progress: Progress) -> StudyResult:
    """Return the study of the dynamics of a cam (see `gearcam.dynamics.follower`).

    Parameters
    ----------
    result : CamResult
        The cam.
    progress : Progress
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult
        Its rows are those of ``dynamics.csv``.

    Raises
    ------
    DesignError, InfeasibleError
        If the dynamics of the design are not known, or it is impossible.
    """
    progress("motion", 0, 2)
    with result.stage("dynamics"):
        moving = MovingCam(result)
        moment = moving.at(moving.places)
        progress("jump", 1, 2)
        if moving.elastic:
            findings = run_checks(MOVING, _checked(moment), result.design.limits)
        else:  # of a rigid follower the forces tell where it leaves its cam
            found = result.study("forces").study_findings
            findings = tuple(one for one in found if one.code == "lift-off")
        facts = _facts(moment)
    return StudyResult(
        result=result,
        study=result.kind.studies["dynamics"],
        file="dynamics.csv",
        table=_columns(moving.at(moving.rows)),
        group=facts,
        study_findings=findings,
        drawn=partial(_charts, moment),
    )


def _columns(moment: Moment) -> dict[str, Any]:
    """Return the columns of ``dynamics.csv``."""
    moving, result = moment.moving, moment.moving.result
    (scale, unit), (load_scale, _, suffix) = moving.lift_unit, result.follower.load_unit
    velocity, acceleration = list(moving.timed.items())[:2]
    effort, per = result.design.drive.effort
    columns = {
        "t_s": moment.x / moving.speed,
        result.driver.column: result.driver.scale * moment.x,
        f"lift_{unit}": scale * moment.rigid.s,
        **{f"x{k}_{unit}": scale * one.s for k, one in enumerate(moment.motions, 1)},
        velocity[0]: velocity[1] * moment.motions[-1].ds,
        acceleration[0]: acceleration[1] * moment.motions[-1].d2s,
        f"load_{suffix}": load_scale * moment.statics.against,
        "contact_n": moment.normal,
        "contact": moment.contact.astype(int),
        effort: per * moment.torque,
        "pressure_mpa": moment.pressure,
    }
    return {
        name: values if values.dtype.kind == "i" else np.ma.masked_invalid(values)
        for name, values in columns.items()
    }


def _acceleration(moving: MovingCam) -> tuple[str, float]:
    """Return the unit of accelerations in time, and that over those by the angle."""
    _, (name, per), *_ = moving.timed.items()
    return name.removeprefix("acceleration_").replace("_", "/"), per


def _checked(moment: Moment) -> MovingFollower:
    """Return what is checked."""
    moving, turn, driver = moment.moving, moment.moving.turn, moment.moving.result.driver
    (scale, unit), least = moving.lift_unit, math.nan
    force = moving.follower.side * turn.contact_force(moment.x)
    if not moving.held:
        mean = np.trapezoid(force, moment.x) / moving.result.program.period
        least = float(force.min() / mean)
    worst = max(moment.dwells, key=lambda one: one[2], default=(0.0, 0.0, 0.0))
    arcs = [[formatted(math.degrees(x), 5) for x in (one.start, one.end)] for one in turn.flights]
    impacts = [scale * one.impact for one in turn.flights if not math.isnan(one.impact)]
    return MovingFollower(
        flights=[f"{driver.symbol} = {low} to {high} deg" for low, high in arcs],
        impact=max(impacts, default=None),
        unit=f"{unit}/s",
        stays=moving.result.design.drive.words(moving.jump) if moving.jump else "",
        least=least,
        least_at=moment.place(int(np.argmin(force))),
        residual=worst[2] / moving.rise,
        residual_at=f"dwell from {driver.text(worst[0])} to {driver.text(worst[1])}",
        restless=0 if turn.repeats else turn.turns,
        energy_residue=turn.energy_residue,
        tolerance=turn.tolerance,
    )


def _facts(moment: Moment) -> Tree:
    """Return the facts of the study."""
    moving = moment.moving
    effort, scale = moving.result.design.drive.effort
    pressure = np.where(moment.contact, moment.pressure, np.nan)
    acceleration, per = _acceleration(moving)
    peak, rigid = (float(np.abs(one.d2s).max()) for one in (moment.motions[-1], moment.rigid))
    tree: Tree = {
        "contact_force_n": range_fact(
            moment.normal, "normal force between cam and follower", "N", moment.place
        ),
        "jump_rpm": _jumps(moving),
        "acceleration": {
            f"peak_{acceleration.replace('/', '_')}": Fact(
                per * peak, "largest acceleration of the moving follower", shown=True
            ),
            "over_rigid": Fact(peak / rigid, "over that of a rigid follower", unit=""),
        },
        "pressure_mpa": range_fact(pressure, "contact pressure", "MPa", moment.place),
        effort: range_fact(scale * moment.torque, "torque of the cam", "N m", moment.place),
        "spring": solved_springs(moving.loads, moving.solved) or None,
    }
    return tree | _elastic_facts(moment) if moving.elastic else tree


def _elastic_facts(moment: Moment) -> Tree:
    """Return the facts of an elastic follower: vibrations, flights, how exact all is."""
    moving, turn, follower = moment.moving, moment.moving.turn, moment.moving.result.follower
    (scale, unit), (load_scale, load_unit, suffix) = moving.lift_unit, follower.load_unit
    bend, per_unit = ("nm_rad", 1e-3) if follower.angular else ("n_mm", 1.0)
    share = limit_of(MOVING, "residual-vibration", moving.result.design.limits)
    most, label = share * scale * moving.rise, "vibration in the dwell"
    force_error, place_error = turn.error
    hertz = (moving.follower.frequencies / (2.0 * math.pi)).tolist()
    contact = moving.contact_stiffness
    return {
        "natural_frequency_hz": Fact(
            hertz,
            "natural frequencies",
            text=" and ".join(number(one, "Hz") for one in hertz) + " Hz",
            shown=True,
        ),
        f"contact_stiffness_{bend}": None
        if contact is None
        else Fact(per_unit * contact, "stiffness of the contact along the lift"),
        "lost": [
            _ends(one.start, one.end)
            | {f"impact_{unit}_s": None if math.isnan(one.impact) else scale * one.impact}
            for one in turn.flights
        ]
        or None,
        "residual": [
            _ends(low, high)
            | {f"residual_{unit}": Fact(scale * swing, label, at_most=most, unit=unit)}
            for low, high, swing in moment.dwells
        ]
        or None,
        "method": turn.method,
        "turns": turn.turns,
        "repeats": turn.repeats,
        "energy_residue": Fact(turn.energy_residue, "energies balance to", unit="", shown=True),
        f"error_{suffix}": Fact(
            load_scale * force_error, "error of the contact force along the lift", unit=load_unit
        ),
        f"error_{unit}": Fact(scale * place_error, "error of the follower's place", unit=unit),
    }


def _ends(low: float, high: float) -> Tree:
    return {"from_deg": math.degrees(low), "to_deg": math.degrees(high)}


def _jumps(moving: MovingCam) -> Tree | None:
    """Return the speeds at which the follower leaves its cam, rpm."""
    if moving.held:
        return None
    found: Tree = {}
    release, factor = moving.loads.release, moving.result.design.drive.quantity.factor
    if release is not None:
        label = "a rigid follower jumps at"
        found["rigid"] = Fact(release[0] / factor, label, unit="rpm", shown=not moving.elastic)
    if moving.elastic and moving.jump is not None:
        text = "" if moving.jump else "all low speeds"
        label, unit = "the elastic follower jumps at", "rpm" if moving.jump else ""
        found["elastic"] = Fact(moving.jump / factor, label, unit=unit, text=text, shown=True)
    return found


def _charts(moment: Moment) -> dict[str, Chart]:
    """Return the charts of the study."""
    moving = moment.moving
    chart, x = over_driver(moving.result), moving.result.driver.scale * moment.x
    (scale, unit), (acceleration, per) = moving.lift_unit, _acceleration(moving)
    rigid = moving.under.statics(moment.x, np.ones_like(moment.x))

    def lines(of_moving: Array, of_rigid: Array) -> tuple[Line, ...]:
        names = ("moving", "rigid") if moving.elastic else ("rigid",)
        pairs = zip(names, (of_moving, of_rigid), strict=False)
        return tuple(Line(label=f"{name} follower", x=x, y=y) for name, y in pairs)

    charts = {
        "contact": chart(
            title="Normal force between cam and follower",
            y="normal force, N",
            lines=lines(moment.normal, np.where(rigid.lifted, 0.0, rigid.force)),
        ),
        "acceleration": chart(
            title="Acceleration of the moving follower",
            y=f"acceleration, {acceleration}",
            lines=lines(per * moment.motions[-1].d2s, per * moment.rigid.d2s),
        ),
    }
    if moving.elastic:
        charts["lag"] = chart(
            title="Follower's place less the lift",
            y=f"difference, {unit}",
            lines=tuple(
                Line(label=f"mass {k}", x=x, y=scale * (one.s - moment.rigid.s))
                for k, one in enumerate(moment.motions, 1)
            ),
        )
        charts["spectrum"] = _spectrum(moving)
        charts["residual"] = _residuals(moving)
        if moment.dwells:
            charts["speed"] = _over_speed(moment)
    return charts


def _over_speed(moment: Moment) -> Chart:
    """Return the vibration in the dwells of this cam at other speeds, while contact is kept."""
    moving = moment.moving
    (scale, unit), quantity = moving.lift_unit, moving.result.design.drive.quantity
    x = np.concatenate([np.linspace(low, high, _INSIDE + 1)[:-1] for low, high, _ in moment.dwells])
    speeds, found = moving.speed * np.linspace(0.5, 1.5, _SPEEDS), []
    for speed in speeds.tolist():
        follower = replace(moving.follower, speed=speed)
        lag = Periodic(follower).at(x)[follower.last]
        found.append(float(np.abs(lag - follower.rest(x)[-1]).max()))
    return Chart(
        title="Largest vibration in a dwell over the speed, in contact",
        x=f"speed of this cam, {quantity.unit}",
        y=f"amplitude, {unit}",
        lines=(Line(label="follower", x=speeds / quantity.factor, y=scale * np.array(found)),),
    )


def _spectrum(moving: MovingCam) -> Chart:
    """Return the harmonics of the accelerations over the turn, without those that are nothing."""
    even = moving.result.program.period * np.arange(_SPECTRUM) / _SPECTRUM
    moment, (unit, per) = moving.at(even), _acceleration(moving)
    most = int(min(1.5 * moving.follower.periods + 10.0, _SPECTRUM // 4))
    order = np.arange(1.0, most + 1.0)
    both = np.array([moment.motions[-1].d2s, moment.rigid.d2s])
    sizes = 2.0 / _SPECTRUM * np.abs(np.fft.rfft(per * both))[:, 1 : most + 1]
    seen = sizes > _HARMONICS * sizes.max()
    return Chart(
        title="Harmonics of the acceleration",
        x="harmonic of the turn",
        y=f"amplitude, {unit}",
        log="y",
        lines=tuple(
            Line(label=f"{label} follower", x=order[own], y=size[own], dots=True)
            for label, size, own in zip(("moving", "rigid"), sizes, seen, strict=True)
        ),
    )


def _residuals(moving: MovingCam) -> Chart:
    """Return the residual vibrations of laws over the time of a rise, and of the design's own."""
    result, follower = moving.result, moving.follower
    frequency = float(follower.frequencies[0]) / (2.0 * math.pi * follower.speed)
    motion = result.design.motion
    phases = motion if isinstance(motion, tuple) else ()
    own = [
        (one.law, frequency * (placed.end - placed.start))
        for one, placed in zip(phases, result.program.stretches, strict=False)
        if isinstance(one, RisePhase)
    ]
    own = [(law, ratio) for law, ratio in own if ratio <= _FARTHEST]

    def vibration(law: Any, ratios: ArrayLike) -> Array:
        return residual(law.build(result.tolerances).function, ratios)

    shown = [MOTION_LAWS[name].example for name in _SHOWN]
    laws = {law_text(law): law for law in [*shown, *(law for law, _ in own)]}
    of_phases = np.array([vibration(law, [ratio])[0] for law, ratio in own])
    ratios = np.linspace(0.0, max([6.0, *(1.2 * ratio for _, ratio in own)]), _RATIOS)
    of_phases[of_phases < NOISE] = np.nan  # the zero of a law
    floor = min([_FLOOR, *of_phases[np.isfinite(of_phases)]])
    lines = [
        Line(label=name, x=ratios, y=np.where(y >= floor, y, np.nan))
        for name, law in laws.items()
        for y in [vibration(law, ratios)]
    ]
    if own:
        polydyne = getattr(result.design.drive, "polydyne", False)
        label = "phases of this cam" + (", not corrected" if polydyne else "")
        places = np.array([ratio for _, ratio in own])
        lines.append(Line(label=label, x=places, y=of_phases, dots=True))
    limit = limit_of(MOVING, "residual-vibration", result.design.limits)
    return Chart(
        title="Vibration after a rise without damping, over its height",
        x="time of the rise over the natural period",
        y="amplitude over height",
        log="y",
        lines=tuple(lines),
        limits=(Limit(label="limit", value=limit),) if limit else (),
    )
