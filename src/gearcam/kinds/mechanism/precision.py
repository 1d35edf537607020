"""The study of a mechanism's precision: which dimension matters, and random machines."""

from __future__ import annotations

from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import DesignError, InfeasibleError, Problem
from gearcam.base.facts import Fact, Tree
from gearcam.base.findings import run_checks
from gearcam.designs.slips import did_you_mean
from gearcam.kinds.mechanism.asked import DEG
from gearcam.kinds.mechanism.forces import demand_no_change_points, joint_names
from gearcam.kinds.mechanism.keys import center_of
from gearcam.kinds.mechanism.precision_checks import CHECKS, Deviations
from gearcam.linkages.coordinates import GROUND, MemberTurn, NamedCoordinate, PointWay
from gearcam.linkages.deviations import (
    apart,
    clearance,
    deviated,
    dimensions_of,
    places,
    sensitivities,
)
from gearcam.numeric import narrowing
from gearcam.numeric.piecewise import with_both_sides
from gearcam.pictures.charts import Chart, Line
from gearcam.results.study import StudyResult

if TYPE_CHECKING:
    from collections.abc import Iterator

    from gearcam.kinds.mechanism.asked import Output
    from gearcam.kinds.mechanism.result import MechanismResult
    from gearcam.kinds.mechanism.tolerances import ToleranceSpec
    from gearcam.linkages.coordinates import WorkCoordinate
    from gearcam.linkages.elements import Dimension
    from gearcam.numeric.arrays import Array
    from gearcam.results.study import Progress

_NARROW: Final = 1e-7
"""Width, over the range, to which an extreme is narrowed."""

_NOTHING: Final = 1e-12
"""Sensitivity that is rounding only."""

_SHOWN: Final = 3
"""Dimensions of each output that are shown: those with the largest deviations."""

_DRAWN: Final = 6
"""Dimensions of each output that are drawn."""

_TOLERANCES: Final = "length_tolerance_mm in [precision], or a table [[tolerance]]"
"""What gives tolerances."""

_PERCENT: Final = (50, 90, 99)
"""Percentiles of random machines."""


Errors = dict[str, dict[str, "Array"]]
"""Sensitivities at n angles, by outputs, then by dimensions: mm or rad, per mm or rad."""


class Tolerated:
    """A mechanism with the tolerances of its dimensions.

    Parameters
    ----------
    result : MechanismResult
        The mechanism.

    Raises
    ------
    DesignError
        If a tolerance is of no dimension, or has the unit of another.
    """

    def __init__(self, result: MechanismResult) -> None:
        demand_no_change_points(result, "deviations are")
        self.result, self.spec = result, result.design.precision
        self.linkage = result.linkage
        self.outputs = {one.stem: one for one in result.outputs}
        dimensions = {_name(one): one for one in dimensions_of(self.linkage)}
        self.dimensions: dict[str, Dimension] = dimensions
        self.loose = {f"{name}.clearance": one for one, name in joint_names(self.linkage).items()}
        self.tolerances = dict.fromkeys(self.loose, self.spec.clearance) | {
            name: self.spec.angle_tolerance if one.angle else self.spec.length_tolerance
            for name, one in dimensions.items()
        }
        problems, seen = list[Problem](), set[str]()
        for number, spec in enumerate(result.design.tolerance):
            found = self._problem(number, spec, again=spec.of in seen)
            seen.add(spec.of)
            if found is None:
                self.tolerances[spec.of] = float(spec.length or spec.angle or 0.0)
            else:
                problems.append(found)
        if not problems and not self.given:
            problems += self._needing_tolerances()
        if problems:
            raise DesignError(problems)

    def angle(self, name: str) -> bool:
        """Return whether a dimension is an angle."""
        return name in self.dimensions and self.dimensions[name].angle

    def _problem(self, number: int, spec: ToleranceSpec, *, again: bool) -> Problem | None:
        """Return what is wrong with a tolerance: of no dimension, twice, or of another unit."""
        source, key = self.result.design.source, f"tolerance[{number}].of"
        if spec.of not in self.tolerances:
            what, near = f"{spec.of} is no dimension", ", ".join(self.tolerances)
            hint = did_you_mean(spec.of, list(self.tolerances))
            return Problem(what, file=source, key=key, allowed=near, hint=hint)
        if again:
            what = f"{spec.of} has a tolerance before"
            return Problem(what, file=source, key=key, allowed="one for each dimension")
        angle = self.angle(spec.of)
        if (spec.angle if angle else spec.length) is None:
            what = f"{spec.of} is {'an angle' if angle else 'a length'}"
            near = "tolerance_deg" if angle else "tolerance_mm"
            return Problem(what, file=source, key=key, allowed=near)
        return None

    def _needing_tolerances(self) -> Iterator[Problem]:
        """Yield what is asked for in vain where there are no tolerances."""
        design = self.result.design
        if self.spec.trials:
            what, key = "has no tolerances to try", "precision.trials"
            yield Problem(what, file=design.source, key=key, allowed=_TOLERANCES)
        if design.limits.get("deviation"):
            what, key = "has no tolerances to judge", "limits.deviation_mm"
            yield Problem(what, file=design.source, key=key, allowed=_TOLERANCES)

    @cached_property
    def given(self) -> bool:
        """Whether there is any tolerance or clearance."""
        return any(self.tolerances.values())

    def at(self, q: Array) -> Errors:
        """Return the sensitivities at the master's angles, (n,), rad."""
        names = [one.quantity for one in self.outputs.values()]
        found = sensitivities(self.linkage, names, q)
        errors: Errors = {}
        for stem, one in self.outputs.items():
            moved = clearance(self.linkage, _coordinate(one), q)
            errors[stem] = {
                name: found[own.name][one.quantity] for name, own in self.dimensions.items()
            } | {name: moved[bond] for name, bond in self.loose.items()}
        return errors

    def parts(self, found: Errors, stem: str) -> dict[str, Array]:
        """Return the parts of the deviation of an output `stem` that are `found`, by names."""
        return {name: self.tolerances[name] * one for name, one in found[stem].items()}

    def worst(self, found: Errors, stem: str) -> Array:
        """Return the deviations of an output `stem` in the worst case, (n,), of those `found`."""
        return np.sum([np.abs(one) for one in self.parts(found, stem).values()], axis=0)

    def rooted(self, found: Errors, stem: str) -> Array:
        """Return the roots of squares of deviations of an output `stem`, (n,), that are `found`."""
        return np.sqrt(np.sum([one**2 for one in self.parts(found, stem).values()], axis=0))


def _name(dimension: Dimension) -> str:
    """Return the name of a dimension in the design: of a shaft's place that of the shaft."""
    base, _, rest = dimension.name.rpartition(".")
    return f"{base.removesuffix(center_of(''))}.{rest}"


def _coordinate(one: Output) -> WorkCoordinate:
    """Return the coordinate of an output, on which a force acts."""
    owner, _, what = one.quantity.rpartition(".")
    if what in ("angle", "turn"):
        return MemberTurn(owner)
    if what in ("x", "y"):
        return PointWay(owner, GROUND, 1.0 + 0j if what == "x" else 1j)
    return NamedCoordinate(one.quantity)


def study_precision(result: MechanismResult, progress: Progress) -> StudyResult:
    """Return the study of the precision of a mechanism (see `gearcam.linkages.deviations`).

    Parameters
    ----------
    result : MechanismResult
        The mechanism.
    progress : callable
        Called with what is computed, the number done and their total.

    Returns
    -------
    StudyResult
        Its rows are those of ``precision.csv``.

    Raises
    ------
    DesignError
        If a tolerance is of no dimension.
    InfeasibleError
        If it has change points, or just closes somewhere.
    """
    with result.stage("precision"):
        progress("precision", 0, 1)
        machine = Tolerated(result)
        even = machine.linkage.even_places(machine.spec.steps)
        q = with_both_sides(even, machine.linkage.knots)
        found = machine.at(q)
        for stem, by in found.items():
            if not np.isfinite([*by.values()]).all():
                what = f"deviations of {stem} have no limit where it just closes"
                raise InfeasibleError(what, where="dyad", nearest="a smaller range_deg")
        peaks = _peaks(machine, q, found)
        trials = _trials(machine, even, progress)
    worst = {
        stem: (value, result.place(place), _largest_part(machine, stem, place))
        for stem, (value, place) in peaks["worst_case"].items()
        if not machine.outputs[stem].angle
    }
    findings = run_checks(CHECKS, Deviations(worst=worst), result.design.limits)
    return StudyResult(
        result=result,
        study=result.kind.studies["precision"],
        file="precision.csv",
        table=_columns(machine, q, found),
        group=_facts(machine, peaks, q, found, trials),
        study_findings=findings,
        drawn=partial(_charts, machine, q, found),
    )


Peaks = dict[str, dict[str, tuple[float, float]]]
"""Largest deviations and their places, by how errors add up, then by outputs."""


def _peaks(machine: Tolerated, q: Array, found: Errors) -> Peaks:
    """Return the largest deviations, between the rows too."""
    names = [(how, stem) for how in ("worst_case", "root_of_squares") for stem in machine.outputs]

    def rows(errors: Errors) -> Array:
        each = {"worst_case": machine.worst, "root_of_squares": machine.rooted}
        return np.stack([each[how](errors, stem) for how, stem in names])

    width = _NARROW * (q[-1] - q[0])
    which, places_, values = narrowing.summits(
        lambda x: rows(machine.at(x)), rows(found), *narrowing.neighbours(q), width
    )
    peaks: Peaks = {"worst_case": {}, "root_of_squares": {}}
    for number, (how, stem) in enumerate(names):
        own = np.flatnonzero(which == number)
        best = own[np.argmax(values[own])] if own.size else None
        peaks[how][stem] = (
            (0.0, float(q[0])) if best is None else (float(values[best]), float(places_[best]))
        )
    return peaks


def _largest_part(machine: Tolerated, stem: str, place: float) -> str:
    """Return the dimension with the largest part of a deviation at a place."""
    parts = machine.parts(machine.at(np.array([place])), stem)
    return max(parts, key=lambda name: abs(float(parts[name][0])), default="")


def _trials(machine: Tolerated, q: Array, progress: Progress) -> Array | None:
    """Return the largest deviation of each output of random machines, (trials, k); nan if open.

    Each dimension lies anywhere within its tolerance, each joint is displaced within its clearance.
    """
    spec, outputs = machine.spec, [*machine.outputs.values()]
    if not spec.trials:
        return None
    rng, found = np.random.default_rng(spec.seed), np.full((spec.trials, len(outputs)), np.nan)
    names, angles = [one.quantity for one in outputs], np.array([one.angle for one in outputs])
    nominal = places(machine.linkage, names, q)
    nearby = machine.at(q)
    for number in range(spec.trials):
        progress("random machines", number, spec.trials)
        made = machine.linkage
        for name, own in machine.dimensions.items():
            made = deviated(made, own, machine.tolerances[name] * float(rng.uniform(-1.0, 1.0)))
        with np.errstate(invalid="ignore"):
            off = apart(places(made, names, q), nominal, angles)
        shares = {name: machine.tolerances[name] * rng.uniform(-1.0, 1.0) for name in machine.loose}
        for name, share in shares.items():
            off += share * np.stack([nearby[stem][name] for stem in machine.outputs])
        found[number] = np.abs(off).max(axis=1)
    return found


def _columns(machine: Tolerated, q: Array, found: Errors) -> dict[str, Any]:
    """Return the columns of ``precision.csv``."""
    columns: dict[str, Any] = {f"{machine.result.driver[0]}_deg": DEG * q}
    for stem, one in machine.outputs.items():
        scale, unit = one.unit
        for name, values in found[stem].items():
            if np.abs(values).max() > _NOTHING:
                factor, per = (1.0 / DEG, "deg") if machine.angle(name) else (1.0, "mm")
                key = f"{stem}_by_{name.replace('.', '_')}_{unit}_per_{per}"
                columns[key] = scale * factor * values
        if machine.given:
            columns[f"{stem}_worst_case_{unit}"] = scale * machine.worst(found, stem)
            columns[f"{stem}_root_of_squares_{unit}"] = scale * machine.rooted(found, stem)
    return columns


def _facts(machine: Tolerated, peaks: Peaks, q: Array, found: Errors, trials: Array | None) -> Tree:
    """Return the facts of the study."""
    tree: Tree = {"outputs": {}}
    for number, (stem, one) in enumerate(machine.outputs.items()):
        scale, unit = one.unit
        own: Tree = {}
        for how, places_ in peaks.items() if machine.given else ():
            value, place = places_[stem]
            label = f"largest deviation of {stem}, {how.replace('_', ' ')}"
            at = f"at {machine.result.place(place)}"
            own[f"{how}_{unit}"] = Fact(scale * value, label, place=at, unit=unit, shown=True)
        own["dimensions"] = _dimension_facts(machine, stem, q, found)
        if trials is not None:
            own |= _trial_facts(stem, scale * trials[:, number], unit)
        tree["outputs"][stem] = own
    if trials is not None:
        count = int(np.isnan(trials).any(axis=1).sum())
        label = "random machines that do not close; they are left out"
        tree["trials"] = {
            "count": len(trials),
            "open": Fact(count, label, unit="", shown=count > 0),
        }
    return tree


def _dimension_facts(machine: Tolerated, stem: str, q: Array, found: Errors) -> Tree:
    """Return the facts of all dimensions that move an output, the largest deviation first."""
    (scale, unit), tree = machine.outputs[stem].unit, Tree()
    largest = {name: float(np.abs(one).max()) for name, one in found[stem].items()}

    def weight(name: str) -> float:
        return largest[name] * (machine.tolerances[name] if machine.given else 1.0)

    ranks = {True: 0, False: 0}  # of angles and of lengths, where they cannot be compared
    for name in sorted(largest, key=weight, reverse=True):
        if largest[name] <= _NOTHING:
            continue
        sort = machine.angle(name) and not machine.given
        rank, ranks[sort] = ranks[sort], ranks[sort] + 1
        factor, per = (1.0 / DEG, "deg") if machine.angle(name) else (1.0, "mm")
        place = float(q[np.abs(found[stem][name]).argmax()])
        value = scale * factor * largest[name]
        at = f"at {machine.result.place(place)}"
        tree[name.replace(".", "_")] = {
            f"sensitivity_{unit}_per_{per}": Fact(
                value,
                f"largest sensitivity of {stem} to {name}",
                place=at,
                unit=f"{unit}/{per}",
                shown=rank < _SHOWN and not machine.given,
            ),
            f"deviation_{unit}": Fact(
                scale * largest[name] * machine.tolerances[name],
                f"deviation of {stem} by {name}",
                place=at,
                unit=unit,
                shown=rank < _SHOWN and machine.tolerances[name] > 0.0,
            ),
        }
    return tree


def _trial_facts(stem: str, found: Array, unit: str) -> Tree:
    """Return the percentiles of the largest deviations of random machines."""
    closed = found[np.isfinite(found)]
    if not closed.size:
        return {}
    return {
        f"p{one}_{unit}": Fact(
            float(np.percentile(closed, one)),
            f"deviation of {stem} that {one} % of random machines keep",
            unit=unit,
            shown=True,
        )
        for one in _PERCENT
    }


def _leading(machine: Tolerated, stem: str, found: Errors) -> dict[str, Array]:
    """Return the largest parts of the deviation of an output, or sensitivities to lengths."""
    parts = machine.parts(found, stem) if machine.given else found[stem]
    sizes = {
        name: float(np.abs(one).max())
        for name, one in parts.items()
        if machine.given or not machine.angle(name)
    }
    names = sorted(sizes, key=lambda name: -sizes[name])[:_DRAWN]
    return {name: parts[name] for name in names if sizes[name] > _NOTHING}


def _charts(machine: Tolerated, q: Array, found: Errors) -> dict[str, Chart]:
    """Return a chart of each output: parts of its deviation, or its sensitivities to lengths."""
    charts, x = {}, DEG * q
    for stem, one in machine.outputs.items():
        (scale, unit), lines = one.unit, []
        for name, values in _leading(machine, stem, found).items():
            lines.append(Line(label=name, x=x, y=scale * values))
        if machine.given:
            for label, sums in (("worst case", machine.worst), ("root of squares", machine.rooted)):
                lines.append(Line(label=label, x=x, y=scale * sums(found, stem)))
        title = f"Deviation of {stem}" if machine.given else f"Sensitivity of {stem} to lengths"
        y = f"deviation, {unit}" if machine.given else f"{unit}/mm"
        if lines:
            charts[f"precision_{stem}"] = Chart(
                title=title, x=machine.result.axis, y=y, lines=tuple(lines)
            )
    return charts
