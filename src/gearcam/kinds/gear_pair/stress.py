"""The study of stress of a pair: roots of all teeth, load sharing, lag, stiffness."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import DesignError, InfeasibleError, MissingExtraError, Problem
from gearcam.base.facts import Fact, Tree, extent
from gearcam.base.findings import limit_of, run_checks
from gearcam.base.numerals import FEW, formatted
from gearcam.base.quantities import ARCSEC
from gearcam.export.table import table_bytes
from gearcam.gears.track import WHEELS
from gearcam.kinds.gear_pair import forces as loads
from gearcam.kinds.gear_pair.drawn import DRIVER
from gearcam.kinds.gear_pair.elastic_pair import ROOTS, ElasticPair, Entries
from gearcam.laws.ratio.span import angle_text
from gearcam.mechanics.hertz import line_pressure, yield_pressure
from gearcam.meshing.settings import STRESS
from gearcam.numeric import narrowing
from gearcam.numeric.arrays import distinct, indices_among
from gearcam.pictures.charts import Chart, Line, knot_marks
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from collections.abc import Iterator

    from gearcam.gears.pair import Gear
    from gearcam.kinds.gear_pair.result import GearPairResult
    from gearcam.numeric.arrays import Array
    from gearcam.pictures.scenes import ColouredCurve
    from gearcam.results.study import Progress
    from gearcam.stress.checks import CertifiedRoot, StressedPair
    from gearcam.stress.region import Region

_NARROW: Final = 1e-3
"""Width, over that of a step, to which an extreme is narrowed."""

_PER_TOOTH: Final = 10
"""Phases for each tooth of the driver unless given."""

WORST: Final = "worst root of the tooth over the turn, MPa"
"""What wheels are coloured by."""


def demand(design: Any) -> None:
    """Refuse a design whose stress is not computed, and a missing extra.

    Parameters
    ----------
    design : GearPairDesign
        The design.

    Raises
    ------
    DesignError
        If nothing acts on the pair, or its wheels are stepped.
    MissingExtraError
        If scipy or scikit-fem are not installed.
    """
    loads.demand(design)
    if design.steps.count > 1:
        what, near = "stress of stepped wheels is not computed", "1"
        raise DesignError([Problem(what, file=design.source, key="steps.count", allowed=near)])
    MissingExtraError.unless("scipy", "skfem", what="stresses", extra="stress")


def study_stress(result: GearPairResult, progress: Progress) -> StudyResult:
    """Return the study of the stress of a pair (see `gearcam.stress`).

    Parameters
    ----------
    result : GearPairResult
        The pair.
    progress : Progress
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult
        Its rows are those of ``stress.csv``; without some certified stresses if it was interrupted.

    Raises
    ------
    DesignError
        If a load does not fit.
    InfeasibleError
        If the wheels are impossible, or cannot be held so.
    """
    pair = ElasticPair(result, progress)
    with result.stage("shares"):
        even = _phases(pair)
        entries = pair.entries(even)
        entries = pair.entries(distinct(even, extremes(pair, even, entries)))
    certified: list[CertifiedRoot] = []
    interrupted = ""
    with result.stage("certificates"):
        try:
            chosen = _chosen(pair, entries)
            for number, (own, wheel, tooth, entry) in enumerate(chosen):
                progress("certified roots", number, len(chosen))
                certified.append(pair.certified(own, wheel, tooth, entry))
        except KeyboardInterrupt:
            interrupted = f"{len(certified)} certified stresses"
    stressed = _stressed(pair, even, entries, tuple(certified))
    return StudyResult(
        result=result,
        study=result.kind.studies["stress"],
        file="stress.csv",
        table=_columns(pair, entries, stressed),
        group=_facts(pair, entries, stressed, complete=not interrupted),
        study_findings=run_checks(STRESS, stressed, result.design.limits),
        drawn=partial(_charts, pair, entries),
        coloured=partial(_stressed_teeth, pair, entries),
        pages={
            "stiffness.csv": table_bytes(_stiffness(pair, entries)),
            **_pictures(pair, certified),
        },
        interrupted=interrupted,
    )


def _phases(pair: ElasticPair) -> Array:
    """Return the driver angles that are studied at first, rad: middles of even parts of a turn."""
    count = pair.spec.phases or _PER_TOOTH * pair.result.pair.teeth[0]
    return pair.under.travel * (np.arange(count) + 0.5) / count


def _sought(entries: Entries, phi1: Array) -> Array:
    """Return the worst root of either wheel, and the lag, both ways, at rising driver angles.

    (4, n), -inf where nothing carries.
    """
    found = np.full((4, len(phi1)), -np.inf)
    at = np.searchsorted(phi1, entries.phi1)
    rows = (*(one.max(axis=1) for one in entries.worst), entries.lag, -entries.lag)
    for number, values in enumerate(rows):
        np.maximum.at(found[number], at, values)
    return found


def extremes(pair: ElasticPair, even: Array, entries: Entries) -> Array:
    """Return where roots are stressed most, and the lag is most and least, between phases.

    Parameters
    ----------
    pair : ElasticPair
        The pair.
    even : (n,) array, rad
        Evenly spaced driver angles.
    entries : Entries
        The pair at them.

    Returns
    -------
    (k,) array, rad
    """

    def sought(places: Array) -> Array:
        try:
            return _sought(pair.entries(places), places)
        except InfeasibleError:
            return np.full((4, len(places)), -np.inf)

    step, travel = pair.under.travel / len(even), pair.under.travel
    known = _sought(entries, even)
    _, at, _ = narrowing.summits(sought, known, even - step, even + step, _NARROW * step)
    return np.mod(at, travel) if pair.under.turns else at.clip(0.0, travel)


Chosen = tuple[Entries, int, int, int]
"""Entries, wheel, tooth and number of the entry whose stress is certified."""


def _chosen(pair: ElasticPair, entries: Entries) -> list[Chosen]:
    """Return what is certified: the worst root of each wheel, or those that are asked for."""
    spec = pair.spec
    wheels = WHEELS if spec.wheel is None else (spec.wheel,)
    if spec.teeth is not None and spec.wheel is None:
        wheels = (1,)
    if spec.phi1 is not None:
        entries = _at(pair, entries, spec.phi1)
    found = []
    for wheel in wheels:
        worst, numbers = entries.worst[wheel - 1], entries.numbers[wheel - 1]
        for teeth in [[tooth] for tooth in spec.teeth or ()] or [numbers]:
            columns = np.flatnonzero(np.isin(numbers, teeth))
            at = int(worst[:, columns].argmax())
            entry, column = divmod(at, len(columns))
            found.append((entries, wheel, int(numbers[columns[column]]), entry))
    return found


def _at(pair: ElasticPair, entries: Entries, phi1: float) -> Entries:
    """Return the pair at the phase that is asked for."""
    try:
        return pair.entries(np.array([phi1]))
    except InfeasibleError as error:
        near = float(entries.phi1[np.abs(entries.phi1 - phi1).argmin()])
        what, key = f"no teeth carry at {angle_text(phi1)}", "stress.phi1_deg"
        nearest = f"they do at {formatted(math.degrees(near), FEW)} deg"
        raise InfeasibleError(what, where=key, nearest=nearest) from error


def _stressed(
    pair: ElasticPair, even: Array, entries: Entries, certified: tuple[CertifiedRoot, ...]
) -> StressedPair:
    """Return the input of the checks."""
    from gearcam.stress.checks import StressedPair

    material = pair.result.design.material
    carries = entries.force > 0.0
    pressure = line_pressure(entries.force, entries.curvature, material)
    edge_share = np.zeros(len(entries.phi1))
    np.add.at(edge_share, entries.step, np.where(entries.edge, entries.share, 0.0))
    blanks = (pair.result.design.blank.wheel(gear.wheel) for gear in _on_shafts(pair))
    unheld = not (pair.spec.held_diameter or all(one.bore for one in blanks))
    loaded = np.abs(pair.under.without_friction(even)) > 0.0
    unstated = loaded & ~np.isin(even, entries.phi1)
    return StressedPair(
        unstated=even[unstated],
        phi1=entries.phi1,
        lag=entries.lag,
        step=entries.step,
        pressure=np.where(carries & ~entries.edge, pressure, np.nan),
        edge_share=edge_share,
        certified=certified,
        yielding=yield_pressure(material),
        held=_held_on(pair) if unheld else "",
    )


def _columns(pair: ElasticPair, entries: Entries, stressed: StressedPair) -> dict[str, Any]:
    """Return the columns of ``stress.csv``: a row for each phase and pair of teeth that carries."""
    rows = np.flatnonzero(entries.force > 0.0)
    step = entries.step[rows]
    columns: dict[str, Any] = {
        "phi1_deg": np.degrees(entries.phi1)[step],
        "tooth1": entries.teeth[0, rows],
        "tooth2": entries.teeth[1, rows],
        "pairs": entries.pairs[step],
        "force_n": pair.width * entries.force[rows],
        "share": entries.share[rows],
        "half_width_mm": np.ma.masked_where(entries.edge[rows], entries.half_width[rows]),
        "pressure_mpa": np.ma.masked_invalid(stressed.pressure[rows]),
        "edge": entries.edge[rows].astype(int),
    }
    for wheel in (0, 1):
        column = indices_among(entries.teeth[wheel, rows], entries.numbers[wheel])
        for name, values in zip(ROOTS, entries.roots[wheel], strict=True):
            columns[f"{name}{wheel + 1}_mpa"] = values[step, column]
    return columns


def _pictures(pair: ElasticPair, certified: list[CertifiedRoot]) -> dict[str, bytes]:
    """Return pictures of the certified stresses by file name."""
    from gearcam.kinds.gear_pair.stress_picture import stress_field

    made = {}
    for one in certified:
        field = stress_field(one.certificate, pair.result.pair.module)
        place = f"wheel {one.wheel}, tooth {one.tooth}, {angle_text(one.phi1)}"
        under = f"{formatted(one.force, FEW)} N on {formatted(pair.width, 4)} mm"
        lines = (
            f"{pair.result.design.name}: {place}",
            f"{under}; bands: stress along the edge, red tension, blue compression",
        )
        made[f"stress_wheel{one.wheel}_tooth{one.tooth}.svg"] = field.svg(lines)
    return made


def _stiffness(pair: ElasticPair, entries: Entries) -> dict[str, Any]:
    """Return the columns of ``stiffness.csv``: a row for each phase."""
    on_rack = pair.result.pair.on_rack
    nominal = pair.result.pair.rolling.guide.nominal(entries.phi1)
    place = {"travel_mm": nominal} if on_rack else {"phi2_deg": np.degrees(nominal)}
    per, unit = ("n_mm", "mm") if on_rack else ("nmm_rad", "rad")
    return {
        "phi1_deg": np.degrees(entries.phi1),
        **place,
        "pairs": entries.pairs,
        f"lag_{unit}": entries.lag,
        f"elastic_lag_{unit}": np.sign(entries.load) * entries.bent,
        f"stiffness_{per}": pair.width * entries.stiffness,
        f"secant_{per}": np.abs(entries.load) / entries.bent,
    }


def _facts(pair: ElasticPair, entries: Entries, stressed: StressedPair, *, complete: bool) -> Tree:
    """Return the facts of the study."""
    on_rack = pair.result.pair.on_rack
    lag, unit = (entries.lag, "mm") if on_rack else (entries.lag / ARCSEC.factor, "arcsec")
    per = "n_mm" if on_rack else "nmm_rad"
    stiffness = pair.width * entries.stiffness
    carrying = entries.pairs[entries.step] == 2
    twice = entries.share[carrying & (entries.share >= 0.5)]
    low, high = (formatted(float(one), 4) for one in (lag.min(), lag.max()))
    held = [one for one in map(_held, pair.regions) if one is not None]
    return elasticity(pair) | {
        "alone": Fact("yes", "each pair of teeth has the whole load", shown=True)
        if pair.spec.alone
        else None,
        "plane": pair.spec.plane,
        "phases": len(distinct(entries.phi1)),
        "held_diameter_mm": held or None,
        "gears": [_of_wheel(pair, entries, stressed, wheel) for wheel in WHEELS],
        f"lag_{unit}": {
            **extent(float(lag.min()), float(lag.max())),
            "peak_to_peak": Fact(
                float(np.ptp(lag)),
                "lag of the driven wheel under load, peak to peak",
                place=f"{low} to {high} {unit}",
                unit=unit,
                shown=True,
            ),
        },
        f"stiffness_{per}": {
            **extent(float(stiffness.min()), float(stiffness.max())),
            "mean": Fact(float(stiffness.mean()), "mean stiffness of the mesh", unit=""),
        },
        "share": Fact(
            extent(float(twice.min()), float(twice.max())),
            "larger share of two pairs of teeth",
            unit="",
            shown=True,
        )
        if twice.size
        else None,
        "complete": complete,
    }


def elasticity(pair: ElasticPair) -> Tree:
    """Return as facts what the wheels are made of, and on what they are held."""
    (first, one), (second, other) = pair.result.design.material.elasticity
    material = f"E {formatted(first, FEW)} and {formatted(second, FEW)} MPa, "
    material += f"nu {formatted(one, FEW)} and {formatted(other, FEW)}, plane {pair.spec.plane}"
    return {
        "held": Fact(_held_on(pair), "wheels are held on", shown=True),
        "material": Fact(material, "elasticity of the wheels", shown=True),
    }


def _held(region: Region) -> float | None:
    """Return the diameter of the circle on which a wheel is held, mm; None if it is no circle."""
    for hole in region.holes:
        points = hole.at(hole.places)[0]
        if hole.held(hole.places).all() and np.ptp(np.abs(points)) < 1e-6 * np.abs(points[0]):
            return 2.0 * float(np.abs(points[0]))
    return None


def _on_shafts(pair: ElasticPair) -> list[Gear]:
    """Return the wheels that a shaft holds: neither a ring nor a rack."""
    gears = pair.result.gears
    return [gears[0]] if gears[1].ring or pair.result.pair.on_rack else [*gears]


def _held_on(pair: ElasticPair) -> str:
    """Return on what the wheels are held, in words."""
    inside = "the outside of the ring" if pair.result.gears[1].ring else "the back of the rack"
    words = ["the bore", "the bore" if len(_on_shafts(pair)) == 2 else inside]
    for number, diameter in enumerate(map(_held, pair.regions)):
        if diameter is not None:
            words[number] = f"a circle of {formatted(diameter, FEW)} mm"
    return " and ".join(words)


def _of_wheel(pair: ElasticPair, entries: Entries, stressed: StressedPair, wheel: int) -> Tree:
    """Return the facts of a wheel: the most of the cycle, and what is certified."""
    tension, compression = entries.roots[wheel - 1]
    found = [one for one in stressed.certified if one.wheel == wheel]
    first = max(found, key=lambda one: one.largest, default=None)
    least = limit_of(STRESS, "root-stress", pair.result.design.limits)
    return {
        "screen": {
            "tension_mpa": float(tension.max()),
            "compression_mpa": float(compression.min()),
        },
        "root": None if first is None else _of_root(first, least),
        "roots": [_of_root(one, least) for one in found] if len(found) > 1 else None,
    }


def _of_root(one: CertifiedRoot, least: float) -> Tree:
    """Return the facts of a certified stress."""
    made, mpa = one.certificate, {"unit": "MPa", "shown": True}
    share, tension, pressed = made.error, made.tension.stress, made.compression.stress
    error = f"within {formatted(100.0 * made.error, 2)} %, {angle_text(one.phi1)}"
    name = f"root of wheel {one.wheel}, tooth {one.tooth}"
    return {
        "tension_mpa": Fact(
            tension, f"tension at the {name}", place=error, error=share * abs(tension), **mpa
        ),
        "compression_mpa": Fact(
            pressed, f"compression at the {name}", error=share * abs(pressed), **mpa
        ),
        "von_mises_mpa": Fact(made.von_mises, error=share * made.von_mises),
        "error": made.error,
        "tooth": one.tooth,
        "tension_at_mm": [made.tension.point.real, made.tension.point.imag],
        "compression_at_mm": [made.compression.point.real, made.compression.point.imag],
        "phi1_deg": math.degrees(one.phi1),
        "force_n": one.force,
        "share": one.share,
        "moved_mm": made.loads[0].moved or None,
        "safety": one.safety
        and Fact(one.safety, f"safety of the {name}", at_least=least, unit="", shown=True),
        "unknowns": made.unknowns,
        "loops": made.loops,
    }


def _charts(pair: ElasticPair, entries: Entries) -> dict[str, Chart]:
    """Return charts over the driver's angle, and of the roots of all teeth."""
    result, phi1 = pair.result, np.degrees(entries.phi1)
    end = math.degrees(pair.under.travel)
    knots = knot_marks(np.degrees(result.knots), 0.0, end)
    on_rack = result.pair.on_rack
    lag = entries.lag if on_rack else entries.lag / ARCSEC.factor

    def over(title: str, y: str, lines: dict[str, Array]) -> Chart:
        made = tuple(Line(label=label, x=phi1, y=values) for label, values in lines.items())
        return Chart(title=title, x=DRIVER, y=y, lines=made, marks=knots)

    larger = np.zeros(len(phi1))
    np.maximum.at(larger, entries.step, entries.share)
    roots = dict(zip(("driver", "driven wheel"), entries.worst, strict=True))
    teeth = tuple(
        Line(
            label=f"{name}, {sort}",
            x=entries.numbers[wheel].astype(float),
            y=np.abs(values).max(axis=0),
            dots=True,
        )
        for wheel, name in enumerate(roots)
        for sort, values in zip(ROOTS, entries.roots[wheel], strict=True)
    )
    rooted = Chart(
        title="Largest stress in the root of each tooth over the turn",
        x="tooth",
        y="stress along the edge, MPa",
        lines=teeth,
    )
    lagging = over(
        "Lag of the driven wheel under load",
        "lag, mm" if on_rack else "lag, arcsec",
        {"lag": lag},
    )
    per, part = ("N/mm", 1.0) if on_rack else ("kN m/rad", 1e-6)
    return {
        "roots": over(
            "Largest stress in the roots of either wheel",
            "stress along the edge, MPa",
            {name: worst.max(axis=1) for name, worst in roots.items()},
        ),
        "roots_of_teeth": rooted,
        "lag": lagging,
        "stiffness": over(
            "Stiffness of the mesh",
            f"stiffness, {per}",
            {"stiffness": part * pair.width * entries.stiffness},
        ),
        "shares": over("Larger share of the load", "share", {"largest of all pairs": larger}),
    }


def _stressed_teeth(pair: ElasticPair, entries: Entries) -> Iterator[ColouredCurve]:
    """Yield the outlines of both wheels, each tooth in the colour of its worst root."""
    from gearcam.pictures.scenes import ColouredCurve

    phi1 = np.degrees(entries.phi1)
    for part, region, (_, spans), worst in zip(
        pair.result.parts, pair.regions, pair.spans, entries.worst, strict=True
    ):
        curve, s = region.teeth, region.teeth.places
        past = (s[:, None] - spans[:, 0]) % curve.length
        tooth = past.argmin(axis=1)
        inside = past[np.arange(len(s)), tooth] <= spans[tooth, 1] - spans[tooth, 0]
        points = np.where(inside, curve.at(s)[0], np.nan)
        values = np.where(inside, worst.max(axis=0)[tooth], np.nan)
        yield ColouredCurve(
            body=part.name,
            places=phi1[worst.argmax(axis=0)[tooth]],
            points=points,
            values={WORST: values},
        )
