"""The study of errors of mounting and making: each alone, all together, and random assemblies."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache, partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact, Tree, extent
from gearcam.base.findings import in_order, limit_of, run_checks
from gearcam.base.numerals import formatted
from gearcam.base.quantities import ARCSEC
from gearcam.kinds.gear_pair import trial_checks  # noqa: F401  (its checks register themselves)
from gearcam.kinds.gear_pair.error_trials import AssemblyTrials, Outcome, tried
from gearcam.meshing.assembly import Assembly, alone, demand, given
from gearcam.meshing.error_checks import TRANSMISSION
from gearcam.meshing.errors import Running, Runs, cycle, largest, of_error
from gearcam.meshing.settings import ERRORS, TRIALS
from gearcam.numeric.arrays import as_complex
from gearcam.numeric.bulges import flatten_bulges
from gearcam.pictures.charts import Chart, Line
from gearcam.results.outline_file import read_closed
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.result import GearPairResult
    from gearcam.meshing.half_teeth import HalfTeeth
    from gearcam.numeric.arrays import Array
    from gearcam.results.study import Progress

Run = Callable[[Assembly], Running]

_SIZES: Final[Mapping[str, tuple[str, str, Callable[[Assembly], float]]]] = {
    "center": ("change of the centre distance", "mm", lambda one: one.center),
    "eccentricity1": ("eccentricity of wheel 1", "mm", lambda one: abs(one.eccentric[0])),
    "eccentricity2": ("eccentricity of wheel 2", "mm", lambda one: abs(one.eccentric[1])),
    "pitch1": ("pitch of wheel 1", "mm", lambda one: _most(one.pitch[0])),
    "pitch2": ("pitch of wheel 2", "mm", lambda one: _most(one.pitch[1])),
    "tilt": ("tilt", "deg", lambda one: math.degrees(abs(one.tilt))),
}
_OUTLINES: Final = {
    "outline1": "measured outline of wheel 1",
    "outline2": "measured outline of wheel 2",
}
_WORDS: Final = {name: words for name, (words, _, _) in _SIZES.items()} | _OUTLINES
"""Words, unit and size of each error."""

_HARMONICS: Final = 5

_WHOLE: Final = 1e-9
"""Rounding of a whole number."""

_SAGITTA: Final = 0.01
"""Chord error of flattened arcs of a measured outline, in chord tolerances of the design."""


def study_errors(result: GearPairResult, progress: Progress, jobs: int = 1) -> StudyResult:
    """Return the study of the errors of a pair (see `gearcam.meshing.assembly`).

    Parameters
    ----------
    result : GearPairResult
        The pair.
    progress : Progress
        Called with what is computed, the number done and their total.
    jobs : int
        Number of processes of the random assemblies.

    Returns
    -------
    StudyResult
        With the random assemblies done, if it was interrupted.

    Raises
    ------
    InfeasibleError
        If the pair has no such tooth or shaft, or the wheels do not reach each other.
    """
    design, gears, steps = result.design, result.gears, result.steps
    spec, width, limits = design.errors, design.pair.face_width, design.limits
    demand(gears, given(spec), spec)
    every, off = _with_outlines(result, given(spec))
    each = alone(every)
    count = 2 + len(each) + spec.assemblies

    def report(done: int) -> None:
        progress("errors", done, count)

    with result.stage("errors"):
        phi1 = cycle(gears, spec.steps, alike=every.alike and spec.alike)
        runs = Runs(steps=steps, width=width, phi1=phi1)
        assembled = runs.of
        report(0)
        without, together = assembled(Assembly()), assembled(every)
        limit = limit_of(ERRORS, TRANSMISSION, limits) if not result.pair.on_rack else math.inf
        running, sizes = {}, {}
        for number, (name, one) in enumerate(each.items(), start=2):
            report(number)
            running[name] = assembled(one)
            if name in _SIZES:
                sizes[name] = _largest(assembled, name, one, limit)
            else:
                sizes[name] = off[name]
        done: list[tuple[Assembly, Outcome]] = []
        try:
            for one in tried(result, runs, every, jobs, lambda at: report(2 + len(each) + at)):
                done.append(one)  # noqa: PERF402 - an interruption leaves those that are done
        except KeyboardInterrupt:
            pass
        trials = AssemblyTrials(
            assemblies=[one for one, _ in done],
            outcomes=[outcome for _, outcome in done],
            unit=without.unit,
            measured=every.measured,
        )
    group = {
        **_facts(together, gears, "all errors together"),
        "without": _facts(without, gears, "without errors"),
        "alone": {
            name: _facts(one, gears, f"{_WORDS[name]} alone") | sizes[name]
            for name, one in running.items()
        },
        "trials": trials.facts(spec.percentiles) if trials.done else None,
    }
    lines = {"all together": together, "without": without}
    lines |= {_WORDS[name]: one for name, one in running.items()}
    return StudyResult(
        result=result,
        study=result.kind.studies["errors"],
        file="errors.csv",
        table=_columns(phi1, without, together, running),
        group=group,
        study_findings=in_order(
            [
                *(() if every.none else run_checks(ERRORS, together, limits)),
                *run_checks(TRIALS, trials, limits),
            ]
        ),
        further={"trials": trials.table} if trials.done else {},
        drawn=partial(_charts, lines, trials, without.unit),
        interrupted=""
        if trials.done == spec.assemblies
        else f"{trials.done} of {spec.assemblies} trials",
    )


def _with_outlines(result: GearPairResult, every: Assembly) -> tuple[Assembly, dict[str, Tree]]:
    """Return an assembly with the measured outlines of a design, and facts of them."""
    spec = result.design.errors
    outlines: list[HalfTeeth | None] = []
    off: dict[str, Tree] = {}
    for key, file, gear in zip(
        _OUTLINES, (spec.outline1, spec.outline2), result.gears, strict=True
    ):
        if file is None:
            outlines.append(None)
            continue
        if len(result.steps) > 1:
            raise InfeasibleError(
                "a measured outline is that of one step, but the wheels are stepped",
                where=f"errors.{key}",
                nearest="study a design with steps.count = 1",
            )
        from gearcam.meshing.half_teeth import half_teeth
        from gearcam.meshing.measured import as_half_teeth, chord_error, demand_near

        points, bulges = read_closed(file, what="an outline")
        outline = flatten_bulges(points, bulges, _SAGITTA * gear.profile.tolerance)
        own, module = as_complex(gear.outline), result.pair.module
        off[key] = {"size_mm": demand_near(outline, own, module, f"errors.{key}")}
        chords = chord_error(outline, own)
        off[key]["chord_error_mm"] = Fact(chords, f"{_OUTLINES[key]}, chord error", shown=True)
        outlines.append(as_half_teeth(outline, half_teeth(gear.profile), chords))
    return replace(every, outlines=(outlines[0], outlines[1])), off


def _most(errors: Mapping[int, float]) -> float:
    return max(map(abs, errors.values()), default=0.0)


def _largest(assembled: Run, name: str, one: Assembly, limit: float) -> Tree:
    """Return the size of an error, and its largest size that keeps each limit, as facts."""
    words, unit, size = _SIZES[name]

    @cache
    def running(factor: float) -> Running | None:
        try:
            return assembled(one.times(factor))
        except InfeasibleError:
            return None

    asked = {"free_running": ("that runs free", _not_free)}
    if math.isfinite(limit):
        arcsec = f"{formatted(limit / ARCSEC.factor)} arcsec"
        asked["transmission"] = (  # of a pair that jams the error says nothing
            f"within {arcsec}",
            lambda found: max(found.peak_to_peak / limit - 1.0, _not_free(found)),
        )
    facts: Tree = {f"size_{unit}": size(one)}
    for key, (why, excess) in asked.items():
        factor = _largest_factor(running, excess)
        if factor is not None and math.isfinite(factor):
            label = f"{words}, largest {why}"
            facts[f"largest_{key}_{unit}"] = Fact(_kept(factor * size(one)), label, shown=True)
    return facts


def _kept(value: float) -> float:
    """Return a value known to a thousandth, in so many digits, not rounded up."""
    if value == 0.0:
        return 0.0
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - 2)
    return float(formatted(math.copysign(math.floor(abs(value) / unit + _WHOLE) * unit, value), 3))


def _largest_factor(
    running: Callable[[float], Running | None], excess: Callable[[Running], float]
) -> float | None:
    """Return the largest factor of an error (see `largest`), also for tips in roots."""

    def of(factor: float, *, whole: bool = False) -> float:
        found = running(factor)
        return 1.0 if found is None or (whole and found.interference) else excess(found)

    factor = largest(of)  # of flanks; whole outlines take much longer
    if factor is not None and math.isfinite(factor) and of(factor, whole=True) >= 0.0:
        return largest(partial(of, whole=True))
    return factor


def _not_free(found: Running) -> float:
    """Return a number below 0 if flanks touch everywhere, with backlash and without a gap."""
    if not np.isfinite(found.lead).all():
        return 1.0
    ratio = found.contact_ratio
    apart = -1.0 if ratio is None else 1.0 - ratio
    return max(-found.least_backlash - found.noise, apart)


def _facts(found: Running, gears: Any, how: str) -> Tree:
    error: Tree = {"known_to": Fact(found.known_to, f"{how}, known to", unit=found.unit)}
    if math.isfinite(found.peak_to_peak):
        place = ""
        if found.measured or not found.peak_to_peak:
            place = f"known to {formatted(found.known_to, 1)} {found.unit}"
        elif found.unit == "rad":
            place = f"{formatted(found.peak_to_peak / ARCSEC.factor, 4)} arcsec"
        error["peak_to_peak"] = Fact(
            found.peak_to_peak,
            f"transmission error, {how}",
            unit=found.unit,
            place=place,
            shown=True,
            error=found.known_to,
        )
        parts = of_error(found, gears)
        if isinstance(parts, str):
            error["no_harmonics"] = parts
        else:
            error["harmonics"] = parts[:_HARMONICS] or None
    some = found.backlash[np.isfinite(found.backlash)]
    return {
        f"transmission_error_{found.unit}": error,
        "backlash_mm": extent(float(some.min()), float(some.max())) if some.size else None,
        "contact_ratio": None
        if found.contact_ratio is None
        else Fact(found.contact_ratio, f"contact ratio, {how}", shown=True),
    }


def _columns(
    phi1: Array, without: Running, together: Running, each: Mapping[str, Running]
) -> dict[str, Array]:
    """Return the columns of ``errors.csv``: lags behind the nominal position, and backlash."""
    unit = without.unit
    lags = {"without": without, "together": together, **each}
    return {
        "phi1_deg": np.degrees(phi1),
        **{
            f"lag_{name}_{unit}": np.ma.masked_invalid(0.0 - one.lead) for name, one in lags.items()
        },
        "backlash_mm": np.ma.masked_invalid(together.backlash),
    }


def _charts(lines: Mapping[str, Running], trials: AssemblyTrials, unit: str) -> dict[str, Chart]:
    """Return transmission errors with and without errors, and the histogram of the trials."""
    from gearcam.kinds.gear_pair.drawn import DRIVER

    charts = {
        "transmission_error": Chart(
            title="Transmission error with errors of mounting and making (lag minus its mean)",
            x=DRIVER,
            y=f"lag, {unit}",
            lines=tuple(
                Line(label=label, x=np.degrees(one.phi1), y=one.error)
                for label, one in lines.items()
            ),
        )
    }
    return charts | trials.charts
