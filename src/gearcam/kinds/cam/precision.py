"""The study of precision: deviations of the lift by tolerances, and tolerances for a wanted one."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.facts import Fact, Tree
from gearcam.base.findings import Finding, run_checks
from gearcam.base.quantities import ANGLE
from gearcam.cams.precision import (
    COMBINED,
    Largest,
    LiftError,
    added,
    largest,
    rooted,
    sensitivities,
)
from gearcam.cams.spec import PRECISION
from gearcam.kinds.cam.tables import SIZES, PrecisionSpec
from gearcam.kinds.over_driver import over_driver
from gearcam.numeric.piecewise import with_both_sides
from gearcam.pictures.charts import Chart, Limit, Line
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from gearcam.cams.cam import Cam
    from gearcam.cams.wall import Wall
    from gearcam.kinds.cam.result import CamResult
    from gearcam.numeric.arrays import Array
    from gearcam.results.study import Progress

_COMBINATIONS: Final = {"worst_case": added, "root_of_squares": rooted}

_NO_INFLUENCE: Final = 1e-12
"""Sensitivity, mm per mm or rad per rad, that is rounding only."""


def study_precision(result: CamResult, progress: Progress) -> StudyResult:
    """Return the study of the precision of a cam (see `gearcam.cams.precision`).

    Parameters
    ----------
    result : CamResult
        The cam.
    progress : Progress
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult
    """
    spec, cam, theta = result.design.precision, result.cam, result.angles
    with result.stage("precision"):
        values = _values(cam, theta)
        most: dict[str, Largest] = {}
        sizes = dict.fromkeys(size for _, by_size in values for size in by_size)
        for number, size in enumerate(sizes):
            progress("precision", number, len(sizes))
            found = largest(cam, lambda by_size, size=size: _of(by_size, size))
            if found is not None:
                most[size] = found
        facts = _facts(cam, spec, most)
        findings = _findings(cam, spec)
    columns = {result.driver.column: result.driver.scale * theta}
    for wall, by_size in values:
        columns |= _columns(wall, by_size, spec)
    return StudyResult(
        result=result,
        study=result.kind.studies["precision"],
        file="precision.csv",
        table=columns,
        group=facts,
        study_findings=findings,
        drawn=partial(_charts, result),
    )


def _values(cam: Cam, theta: Array) -> list[tuple[Wall, dict[str, Array]]]:
    """Return the sensitivities on each wall, by size."""
    return [(wall, sensitivities(wall, cam.linked(wall), theta)) for wall in cam.walls]


def _of(by_size: Mapping[str, Array], size: str) -> Array:
    """Return the sensitivities (n,) to a size; 0 where a wall's follower has no such size."""
    return by_size.get(size, 0.0 * next(iter(by_size.values())))


def _known(by_size: Mapping[str, Array], errors: Mapping[str, float]) -> dict[str, float]:
    """Return the errors of the sizes that a wall's follower has."""
    return {size: error for size, error in errors.items() if size in by_size}


def _combined(cam: Cam, how: Any, errors: Mapping[str, float]) -> Largest | None:
    """Return the largest deviation by errors of sizes."""
    return largest(cam, lambda by_size: how(by_size, _known(by_size, errors)))


def _facts(cam: Cam, spec: PrecisionSpec, most: Mapping[str, Largest]) -> Tree:
    scale, unit = cam.motions[0].follower.lift_unit
    tolerances, wanted, tree = spec.tolerances, spec.wanted, Tree()
    if tolerances:
        for name, how in _COMBINATIONS.items():
            found = _combined(cam, how, tolerances)
            if found is not None:
                label = f"largest deviation of the lift, {name.replace('_', ' ')}"
                value = scale * found.value
                tree[f"{name}_{unit}"] = Fact(value, label, place=found.place, shown=True)
    tree[f"wanted_{unit}"] = None if wanted is None else scale * wanted
    allowed = {} if wanted is None else _allowed(cam, spec, most, wanted)
    tree["sizes"] = {
        size: _size_facts(size, one, tolerances.get(size, 0.0), allowed, (scale, unit))
        for size, one in most.items()
    }
    return tree


def _allowed(
    cam: Cam, spec: PrecisionSpec, most: Mapping[str, Largest], wanted: float
) -> dict[str, tuple[float, float]]:
    """Return the tolerances that the wanted error allows: of a size alone, and of all together.

    Together each has an equal share: alone all would make the same largest deviation. Sizes are
    those with tolerances, or all if none has one.
    """
    alone = {size: wanted / one.value for size, one in most.items() if one.value > _NO_INFLUENCE}
    shared = {size: alone[size] for size in spec.tolerances or alone if size in alone}
    found = _combined(cam, COMBINED[spec.combined], shared) if shared else None
    share = 0.0 if found is None else wanted / found.value
    return {size: (value, share * value * (size in shared)) for size, value in alone.items()}


def _size_facts(
    size: str,
    found: Largest,
    tolerance: float,
    allowed: Mapping[str, tuple[float, float]],
    lift_unit: tuple[float, str],
) -> Tree:
    (scale, unit), quantity = lift_unit, SIZES[size].quantity
    words, suffix = size.replace("_", " "), quantity.suffix
    per = f"sensitivity_{unit}_per{suffix}"
    value = scale * found.value * quantity.factor
    tree: Tree = {
        f"tolerance{suffix}": tolerance / quantity.factor,
        per: Fact(
            value,
            f"largest sensitivity to {words}",
            place=found.place,
            unit=f"{unit}/{quantity.unit}",
            shown=not tolerance and not allowed,
        ),
        f"deviation_{unit}": scale * found.value * tolerance,
    }
    if size in allowed:
        alone, together = (tolerance / quantity.factor for tolerance in allowed[size])
        tree[f"allowed_alone{suffix}"] = Fact(alone, f"tolerance of {words} allowed, alone")
        if together:
            label = f"tolerance of {words} allowed, with equal shares"
            tree[f"allowed_together{suffix}"] = Fact(together, label, shown=True)
    return tree


def _findings(cam: Cam, spec: PrecisionSpec) -> tuple[Finding, ...]:
    if spec.wanted is None or not spec.tolerances:
        return ()
    found = _combined(cam, COMBINED[spec.combined], spec.tolerances)
    if found is None:
        return ()
    return run_checks(PRECISION, LiftError(found, spec.wanted, spec.combined), {})


def _columns(wall: Wall, by_size: Mapping[str, Array], spec: PrecisionSpec) -> dict[str, Array]:
    """Return the columns of ``precision.csv`` for a wall."""
    (scale, unit), key, columns = wall.follower.lift_unit, wall.ending, {}
    for size, each in by_size.items():
        quantity = SIZES[size].quantity
        columns[f"by_{size}{key}_{unit}_per{quantity.suffix}"] = scale * quantity.factor * each
    errors = _known(by_size, spec.tolerances)
    for name, how in _COMBINATIONS.items() if errors else ():
        columns[f"{name}{key}_{unit}"] = scale * how(by_size, errors)
    return {name: np.ma.masked_invalid(column) for name, column in columns.items()}


def _charts(result: CamResult) -> dict[str, Chart]:
    """Return deviations by the tolerances, and sensitivities to lengths and to angles."""
    spec, driver, program = result.design.precision, result.driver, result.program
    turn = with_both_sides(result.angles, program.knots)
    turn[-1] = np.nextafter(program.period, 0.0)
    scale, unit = result.follower.lift_unit
    x, groups = driver.scale * turn, {"mm": [], "deg": []}
    deviations: list[Line] = []
    for wall, by_size in _values(result.cam, turn):
        on = f", {wall.key}" if wall.key else ""
        for size, each in by_size.items():
            quantity, label = SIZES[size].quantity, f"{size.replace('_', ' ')}{on}"
            if np.nanmax(np.abs(each), initial=0.0) > _NO_INFLUENCE:
                values = scale * quantity.factor * each
                groups[quantity.unit].append(Line(label=label, x=x, y=values))
                if size in spec.tolerances:
                    values = scale * each * spec.tolerances[size]
                    deviations.append(Line(label=label, x=x, y=values))
        errors = _known(by_size, spec.tolerances)
        for name, how in _COMBINATIONS.items() if errors else ():
            label = f"{name.replace('_', ' ')}{on}"
            deviations.append(Line(label=label, x=x, y=scale * how(by_size, errors)))
    chart, charts = over_driver(result), {}
    if deviations:
        ends = () if spec.wanted is None else (scale * spec.wanted, -scale * spec.wanted)
        charts["precision"] = chart(
            title="Deviation of the lift by the tolerances",
            y=f"deviation, {unit}",
            lines=tuple(deviations),
            limits=tuple(Limit(label="wanted", value=end) for end in ends),
        )
    for per, lines in groups.items():
        if lines:
            charts[f"sensitivity_{per}"] = chart(
                title=f"Sensitivity of the lift to {'angles' if per == ANGLE.unit else 'lengths'}",
                y=f"lift per error, {unit}/{per}",
                lines=tuple(lines),
            )
    return charts
