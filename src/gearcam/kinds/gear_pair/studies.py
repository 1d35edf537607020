"""Studies of gear pairs: the meshing step by step, and stages at rising resolution."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.facts import Fact, Tree
from gearcam.base.findings import run_checks
from gearcam.base.numerals import formatted
from gearcam.gears.pair import COARSEST, FINEST, FLANK_POINTS, make_gear
from gearcam.gears.track import WHEELS
from gearcam.kinds.gear_pair.method_ladders import METHOD_LADDERS
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.piecewise import Piecewise
from gearcam.numeric.sampling import Sampler
from gearcam.results.ladders import (
    CHORD_ORDER,
    COARSER,
    ROUNDING,
    Ladder,
    Ladders,
    integral_ladder,
    limit_ladder,
    outline_ladder,
    solid_ladder,
    tolerances_around,
)
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.design import GearPairDesign
    from gearcam.kinds.gear_pair.result import GearPairResult
    from gearcam.meshing.study import Condition, Meshing
    from gearcam.numeric.arrays import Ints
    from gearcam.pictures.charts import Chart
    from gearcam.pictures.scenes import ContactPoints, Scene
    from gearcam.results.study import Progress

_CLOSE: Final = 1e-9
"""Driver angles closer than this, degrees, are the same."""


_NOISE: Final = 1e-9
"""Smaller lengths in a study, mm, are rounding."""

_STUDIED: Final = {
    "center_distance_mm": "centre distance as mounted",
    "overclosure_deg": "driver turned ahead by",
    "contact_ratio": "contact ratio",
    "pairs_in_contact": "pairs in contact",
    "interference_steps": "phases with interference",
    "backlash_mm": "backlash along the pitch curve",
    "lag_mm": "lag of the driven wheel, backlash taken up",
    "penetration_mm": "penetration of flanks",
    "chord_error_mm": "chord error of outlines",
    "overlap_max_mm3": "largest overlap of two teeth",
    "overlap_sum_mm3": "overlaps of all phases together",
    "bearing_length_mm": "length over which a tooth bears",
}
"""Labels of the numbers of a study that are always shown."""


def study_mesh(result: GearPairResult, progress: Progress) -> StudyResult:
    """Return the meshing of a pair as mounted; incomplete if it was interrupted.

    Parameters
    ----------
    result : GearPairResult
        The pair.
    progress : callable
        Told of the steps done and their number.

    Returns
    -------
    StudyResult

    Raises
    ------
    InfeasibleError
        If the wheels, or their meshing, are impossible.
    """
    from gearcam.meshing.checks import KIND
    from gearcam.meshing.numbers import numbers
    from gearcam.meshing.study import study

    design = result.design
    gears = result.steps[design.meshing.step - 1]
    with result.stage("meshing"):
        designed = result.subject.sides if gears is result.steps[0] else ()
        meshing = study(gears, design.meshing, progress, designed, _condition(design))
    if not meshing.blocks:
        raise KeyboardInterrupt
    with result.stage("checks"):
        findings = run_checks(KIND, meshing, design.limits)
    done = f"{len(meshing.phi1)} of {meshing.asked} steps"
    return StudyResult(
        result=result,
        study=result.kind.studies["mesh"],
        file="meshing.csv",
        table=meshing.columns,
        group=_facts(numbers(meshing)),
        study_findings=findings,
        drawn=partial(_charts, result, meshing),
        overlay=_contacts(meshing),
        interrupted="" if meshing.complete else done,
    )


def _facts(numbers: Mapping[str, Any]) -> Tree:
    """Return the numbers of the study as facts."""
    first = {name: numbers[name] for name in ("steps_done", *_STUDIED) if name in numbers}
    tree: Tree = {**first, **numbers}
    done, asked = numbers["steps_done"], numbers["steps"]
    place = "" if numbers["complete"] else f"of {asked}"
    tree["steps_done"] = Fact(done, "phases studied", place=place, shown=True)
    for name, meaning in _STUDIED.items():
        if name in numbers:
            tree[name] = Fact(numbers[name], meaning, shown=True, noise=_NOISE)
    error = numbers.get("transmission_error")
    if error is not None:
        unit, least = error["unit"], error["known_to"]
        peak = Fact(
            error["peak_to_peak"],
            "transmission error, peak to peak",
            unit=unit,
            shown=True,
            error=least,
        )
        if not peak.value:
            peak = replace(peak, place=f"known to {formatted(least, 1)} {unit}")
        least_error = Fact(least, "transmission error, known to", unit=unit)
        tree["transmission_error"] = error | {"known_to": least_error, "peak_to_peak": peak}
        if "no_harmonics" in error:
            missing = Fact(error["no_harmonics"], "no harmonics, because of", shown=True)
            tree["transmission_error"]["no_harmonics"] = missing
        elif error["harmonics"]:
            largest = max(error["harmonics"], key=lambda one: one["amplitude"])
            words = f"largest harmonic, {largest['order']} per turn"
            harmonic = Fact(largest["amplitude"], words, unit=unit, shown=True, error=least)
            tree["transmission_error"]["largest_harmonic"] = harmonic
    return tree


def _condition(design: GearPairDesign) -> Condition:
    """Return the errors of a design, and how to make its solids, if it asks for them."""
    from gearcam.meshing.assembly import given
    from gearcam.meshing.study import Condition

    spec, width, count = design.meshing, design.pair.face_width, design.steps.count
    errors = given(design.errors)
    low = width * ((spec.step - 1) / count - 0.5)
    if not (spec.solids or errors.tilt):
        return Condition(errors=errors)
    from gearcam.parts.solids import Prisms

    return Condition(errors=errors, prisms=Prisms, low=low, high=low + width / count)


def _charts(result: GearPairResult, meshing: Meshing) -> dict[str, Chart]:
    """Return transmission error and contact patches of the pair as mounted."""
    from gearcam.kinds.gear_pair.drawn import DRIVER, transmission_chart
    from gearcam.pictures.charts import Chart, Line

    lead, rows = meshing.every("lead"), meshing.columns
    charts = {}
    if np.isfinite(lead).any():
        setup = meshing.setup
        charts["transmission_error"] = transmission_chart(
            result, "as mounted", meshing.phi1, [(setup.pairs[setup.side], lead)]
        )
    rows_of_side = np.flatnonzero(meshing.on_side)
    rows_of_side = rows_of_side[np.argsort(rows["phi1_deg"][rows_of_side], kind="stable")]
    table = {"area_mm2": "overlap of the outlines", "predicted_mm2": "from the exact flanks"}
    charts["contact_patch"] = Chart(
        title="Contact patches of pairs of teeth, as mounted",
        x=DRIVER,
        y="area of overlap, mm2",
        lines=tuple(
            Line(
                label=label,
                x=np.asarray(rows["phi1_deg"])[rows_of_side],
                y=np.ma.filled(rows[name], np.nan)[rows_of_side],
                dots=True,
            )
            for name, label in table.items()
        ),
    )
    if meshing.setup.bodies is not None:
        charts["patch_over_width"] = _patch_over_width(meshing)
    return {name: chart for name, chart in charts.items() if chart is not None}


def _patch_over_width(meshing: Meshing) -> Chart | None:
    """Return the patches on the driver's flank, of the two half-teeth with the largest overlap."""
    from gearcam.pictures.charts import Chart, Line

    rows = [
        (solids.volume[k], tuple(solids.half[:, k]), solids, k)
        for solids in (block.solids for block in meshing.blocks)
        if solids is not None
        for k in range(len(solids.volume))
    ]
    if not rows:
        return None
    _, pair, _, _ = max(rows, key=lambda row: row[0])
    outlines = [solids.outline(k) for _, half, solids, k in rows if half == pair]
    x, y = np.concatenate(outlines, axis=1)
    order = np.argsort(x, kind="stable")
    turning = meshing.setup.turning
    one, two = (
        int(wheel.tooth(np.array([half]))[0])
        for wheel, half in zip((turning.driver, turning.driven), pair, strict=True)
    )
    return Chart(
        title=f"Patches of driver tooth {one} on tooth {two}, phase by phase",
        x="over the middle of the face width, mm",
        y="from the driver's axis, mm",
        lines=(Line(label="outlines of the patches", x=x[order], y=y[order], dots=True),),
    )


def _contacts(meshing: Meshing) -> Callable[[Scene], dict[str, ContactPoints]]:
    """Return the function that gives the points of contact as mounted at the places of a scene."""
    contacts = [block.contacts for block in meshing.blocks]
    step = [block.first + one.step for block, one in zip(meshing.blocks, contacts, strict=True)]
    columns = (step, *([getattr(one, name) for one in contacts] for name in ("point", "force")))
    return partial(_at_places, np.degrees(meshing.phi1), *map(np.concatenate, columns))


def _at_places(
    phi1: Array, step: Ints, point: Plane, force: Plane, scene: Scene
) -> dict[str, ContactPoints]:
    """Return for each place of a scene the points of the nearest phase, if there is one."""
    from gearcam.pictures.scenes import ContactPoints

    places, order = scene.places, np.arange(len(phi1))
    at = phi1
    if scene.closed:  # the last phase comes before the first of the next turn
        turn = places[-1]
        at, places = phi1 % turn, places % turn
        order = np.argsort(at)
        order = np.concatenate([order[-1:], order, order[:1]])
        at = at[order]
        at[0] -= turn
        at[-1] += turn
    right = np.searchsorted(at, places).clip(0, len(at) - 1)
    left = np.maximum(right - 1, 0)
    nearest = np.where(np.abs(places - at[left]) <= np.abs(at[right] - places), left, right)
    half = 0.5 * float(np.diff(phi1).min(initial=0.0 if len(phi1) < 2 else np.inf))
    near = np.abs(places - at[nearest]) <= half + _CLOSE
    phase = order[nearest]
    first, end = (np.searchsorted(step, phase, side) for side in ("left", "right"))
    rows = [np.arange(a, b if there else a) for a, b, there in zip(first, end, near, strict=True)]
    chosen = np.concatenate(rows).astype(int)
    start = np.cumsum([0, *map(len, rows)])
    return {"as mounted": ContactPoints(start=start, point=point[chosen], force=force[chosen])}


_FLANKS: Final = (2, 3, 5, 9, FLANK_POINTS, 33, 65, 129)
"""Points on a flank: each number includes the points of the one before."""

_PHASES: Final = 24
"""Number of phases at which outlines are intersected."""


def _law(result: GearPairResult) -> Ladder:
    law = result.law
    return integral_ladder(
        law.ratio,
        law.ratio.knots,
        law.driven if isinstance(law.driven, Piecewise) else None,
        size=1.0,
        measured="rack travel" if result.pair.on_rack else "driven angle",
        unit="" if result.pair.on_rack else "rad",
    )


def _centrode(result: GearPairResult) -> Ladder:
    arc = result.pair.rolling.arc
    return integral_ladder(
        arc.speed,
        result.law.ratio.knots,
        None,
        size=arc.size,
        measured="arc length",
        unit="mm",
    )


def _flank(result: GearPairResult) -> Ladder:
    """Return the chord errors of polygons through points on the exact flanks, by their number."""
    gears = result.gears

    def points(count: float) -> list[Plane]:
        tables = [gear.flank_points(int(count)) for gear in gears]
        return [(one["x_mm"] + 1j * one["y_mm"]).reshape(-1, int(count)) for one in tables]

    fine = points(2 * _FLANKS[-1] - 1)

    def measure(coarse: list[Plane]) -> tuple[float, int]:
        largest = 0.0
        for ends, exact in zip(coarse, fine, strict=True):
            skip = (exact.shape[1] - 1) // (ends.shape[1] - 1)
            middles = exact[:, skip // 2 :: skip]
            chord = np.diff(ends, axis=1)
            offset = (middles - ends[:, :-1]) * np.conj(chord)
            largest = max(largest, float((np.abs(offset.imag) / np.abs(chord)).max()))
        return largest, sum(one.size for one in coarse)

    return Ladder(
        refined="points on a flank",
        measured="chords of flanks",
        unit="mm",
        levels=_FLANKS,
        own=FLANK_POINTS,
        order=CHORD_ORDER,
        rounding=ROUNDING * max(gear.largest_radius for gear in gears),
        make=points,
        measure=measure,
    )


def _outline(result: GearPairResult) -> Ladder:
    pair, back, inner = result.pair, result.design.back, result.tolerances

    def samplers(tolerance: float) -> list[Sampler]:
        gears = [make_gear(pair, wheel, tolerance, inner, back) for wheel in WHEELS]
        for gear in gears:
            _ = gear.outline  # computed on demand
        return [gear.profile.sampler for gear in gears]

    reach = max(gear.largest_radius for gear in result.gears)
    used, levels = _tolerances(result)
    return outline_ladder(used, levels, samplers, measured="chords of outlines", reach=reach)


def _solid(result: GearPairResult) -> Ladder:
    used, levels = _tolerances(result)
    return solid_ladder(result, used, levels[:-1])


def _contact(result: GearPairResult) -> Ladder:
    """Return areas of overlap of the outlines pressed together, by phase, as in a meshing study."""
    from gearcam.meshing.half_teeth import half_teeth
    from gearcam.meshing.study import SHARE, mount, run

    gears, chords = result.gears, result.pair.chord_tolerance(None)
    setup = mount(gears, replace(result.design.meshing, steps=_PHASES))
    used = min(SHARE * setup.penetration, chords)

    def make(tolerance: float) -> tuple[Array, int]:
        profiles = [replace(gear.profile, tolerance=tolerance) for gear in gears]
        driver, driven = map(half_teeth, profiles)
        turning = replace(setup.turning, driver=driver, driven=driven)
        meshing = run(replace(setup, turning=turning))
        rows = meshing.columns
        phase = np.asarray(rows["step"], dtype=np.int64)
        areas = np.bincount(phase, np.ma.filled(rows["area_mm2"], 0.0), len(meshing.phi1))
        return areas.astype(np.float64), sum(len(profile.points) for profile in profiles)

    return limit_ladder(
        used,
        make,
        levels=[part * used for part in COARSER[:4]],
        measured="overlap of a phase",
        unit="mm2",
        beyond=1.0 / 16.0,
    )


def _tolerances(result: GearPairResult) -> tuple[float, list[float]]:
    """Return the chord tolerance of the design, mm, and those of a ladder around it."""
    pair = result.pair
    used = pair.chord_tolerance(result.design.output.chord_tolerance)
    return used, tolerances_around(used, FINEST * pair.module / 64.0, COARSEST * pair.module)


LADDERS: Final[Ladders] = {
    "law": _law,
    "centrode": _centrode,
    "flank": _flank,
    "outline": _outline,
    "solid": _solid,
    "contact": _contact,
    **METHOD_LADDERS,
}
