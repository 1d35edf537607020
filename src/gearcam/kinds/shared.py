"""What several kinds have alike: tables over a turn, output in space, accuracy, goals."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import ABOVE, beyond_limit
from gearcam.base.facts import Fact, extent
from gearcam.base.quantities import ANGLE, COUNT, TEXT, fixed, param
from gearcam.base.rules import Breach, distinct
from gearcam.base.two_names import fact_of
from gearcam.designs.outputs import OutputSpec, pose_param

if TYPE_CHECKING:
    from gearcam.designs.design import Design
    from gearcam.laws.program import Program
    from gearcam.numeric.arrays import Array
    from gearcam.results.result import Result
    from gearcam.results.study import Progress, StudyResult

TABLE: Final = "accuracy.csv"
PAGE: Final = "accuracy.html"

NOISE: Final = 1e-9
"""Share of the largest value below which a value is 0."""


def range_fact(values: Array, label: str, unit: str, at: Callable[[int], str]) -> Fact | None:
    """Return the range of some values, with the place of the largest, as a fact.

    Parameters
    ----------
    values : (n,) array
        NaN or infinite where they are not known.
    label, unit : str
        Of the fact.
    at : callable
        ``at(index)`` returns the place of a value in words.

    Returns
    -------
    Fact or None
        None if no value is known.
    """
    values = np.where(np.isfinite(values), values, np.nan)
    if np.isnan(values).all():
        return None
    ends = extent(float(np.nanmin(values)), float(np.nanmax(values)))
    place = f"largest {at(int(np.nanargmax(values)))}"
    noise = NOISE * float(np.nanmax(np.abs(values)))
    return Fact(ends, label, place=place, unit=unit, shown=True, noise=noise)


@dataclass(frozen=True, kw_only=True)
class AccuracySpec(ShortRepr):
    """Stages to measure, and the number of runs of each level.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml").with_({"accuracy.repeat": 1})
    >>> design.accuracy == gc.AccuracySpec(repeat=1)
    True
    """

    stage: tuple[str, ...] | None = param(
        TEXT,
        default=None,
        min_length=1,
        example=["outline"],
        doc="stages to measure: law, centrode, flank, outline, solid, contact, cam, path; all by "
        "default",
    )
    repeat: int = param(
        COUNT, default=5, ge=1, le=1000, doc="number of runs; the median time is reported"
    )


METHODS: Final = ("random", "nsga2", "tpe", "scipy")
"""How `gearcam optimize` may search."""


@dataclass(frozen=True, kw_only=True)
class ForcesSpec(ShortRepr):
    """Places at which the study ``forces`` computes the forces.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.ForcesSpec(steps=360)
    ForcesSpec(steps=360)
    """

    steps: int = param(
        COUNT,
        default=720,
        ge=12,
        le=100000,
        doc="number of even steps of the turn or travel; both sides of knots and of changes of "
        "what carries, and places of extremes, are added",
    )


@dataclass(frozen=True, kw_only=True)
class GoalSpec(ShortRepr):
    """What is to be least or largest: of a cam's sizes that are "solve", and of variants.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.GoalSpec(minimize=("pair.center_distance_mm",), trials=300)
    GoalSpec(minimize=('pair.center_distance_mm',), trials=300)
    """

    minimize: tuple[str, ...] | None = param(
        TEXT,
        default=None,
        min_length=1,
        alone=True,
        doc="fact that is to be least, by its name in summary.json",
    )
    maximize: tuple[str, ...] | None = param(
        TEXT,
        default=None,
        min_length=1,
        alone=True,
        doc="fact that is to be largest",
    )
    method: str | None = param(
        TEXT,
        default=None,
        choices=METHODS,
        example="scipy",
        doc="how `gearcam optimize` searches; by goals and variables if left out",
    )
    trials: int = param(
        COUNT, default=200, ge=1, le=1_000_000, doc="largest number of variants that it builds"
    )
    seed: int = param(COUNT, default=1, ge=0, le=10**9, doc="of its random numbers")
    findings: str = param(
        TEXT,
        default="error",
        choices=("error", "warning"),
        doc="findings that the best must not have: errors, or warnings too",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield facts with two goals: field, index, message, allowed."""
        for number, name in enumerate(self.maximize or ()):
            if name in (self.minimize or ()):
                yield "maximize", number, "it is to be least too", "one goal for a fact"

    def named(self, keys: Mapping[str, str]) -> GoalSpec:
        """Return the goals by the names of facts, where given as `keys` that these repeat."""
        least, largest = (
            names and tuple(fact_of(keys, one) for one in names)
            for names in (self.minimize, self.maximize)
        )
        return replace(self, minimize=least, maximize=largest)

    @property
    def signs(self) -> dict[str, float]:
        """1 of facts that are to be least, -1 of those that are to be largest, by name."""
        return dict.fromkeys(self.minimize or (), 1.0) | dict.fromkeys(self.maximize or (), -1.0)


_TURN: Final = 2.0 * math.pi

_MOST_STEPS: Final = 1e6
"""Largest number of steps of a table."""


def peak_of(program: Program, name: str, order: int) -> tuple[str, str]:
    """Return the key and the label of the largest value of a derivative of a lift.

    Where a lower derivative jumps it is infinite there, and its largest value between jumps has a
    key of its own; jumps that are too small to matter are left out of it.

    Parameters
    ----------
    program : Program
        The lift.
    name : str
        Name of the derivative.
    order : int
        Its order.
    """
    below = [jump for jump in program.jumps if jump.order < order]
    if any(not jump.slight for jump in below):
        return f"peak_{name}_between_jumps", f"largest {name}, between jumps"
    aside = ", slight jumps aside" if below else ""
    return f"peak_{name}", f"largest {name}{aside}"


def turn_in_steps(step: float) -> Array:
    """Return the cam angles of the table of a motion, rad: a turn with both ends.

    Parameters
    ----------
    step : float, rad
        The step of the design, ``output.motion_step_deg``.

    Raises
    ------
    InfeasibleError
        If there would be more than a million.
    """
    least = _TURN / _MOST_STEPS
    if step < least:
        what = f"the table would have more than {_MOST_STEPS:.0f} rows"
        value, limit = math.degrees(step), math.degrees(least)
        raise beyond_limit(
            what, "output.motion_step_deg", value, limit, near=ABOVE * limit, unit="deg"
        )
    return np.linspace(0.0, _TURN, max(2, round(_TURN / step) + 1))


_NAMED: Final = 90
"""Characters of a name that leave room for a word behind it."""


def solved_file(design: Design) -> dict[str, bytes]:
    """Return a design with its solved sizes as a file.

    Parameters
    ----------
    design : Design
        With the sizes; its name gets a word more.

    Returns
    -------
    dict of str to bytes
        Its content by the name of the file.
    """
    from gearcam.designs.writing import least_document, toml_text

    named = replace(design, name=f"{design.name[:_NAMED]}_solved", examined=True)
    text = toml_text(least_document(named), [f"{design.name} with its solved sizes"])
    return {"solved.toml": text.encode()}


@cache
def demand_stages(design: Design) -> None:
    """Refuse stages that the kind of a `design` does not have.

    Raises
    ------
    DesignError
        With those that it has.
    """
    from gearcam.results.accuracy import stages_of

    stages_of(design, design.accuracy.stage)  # pyright: ignore[reportAttributeAccessIssue]


def study_accuracy(result: Result, progress: Progress) -> StudyResult:
    """Return error against run time of a result's stages (see `gearcam.results.accuracy`).

    Parameters
    ----------
    result : Result
        The result.
    progress : callable
        Told of the levels done and their number.

    Returns
    -------
    StudyResult

    Raises
    ------
    InfeasibleError
        If a stage cannot be made.
    """
    from gearcam.report.page import charts_page
    from gearcam.results.accuracy import accuracy
    from gearcam.results.study import StudyResult

    settings: AccuracySpec = result.design.accuracy
    outcome = accuracy(result, settings.stage, settings.repeat, progress)
    lines = tuple(outcome.lines())
    title = f"{result.design.name}, error against run time"
    return StudyResult(
        result=result,
        study=result.kind.studies["accuracy"],
        file=TABLE,
        table=outcome.columns,
        group=outcome.facts,
        drawn=lambda: {chart.title: chart for chart in outcome.charts},
        pages={PAGE: charts_page(title, outcome.charts, "\n".join(lines))},
        lines=lines,
    )


def steps_of_turn(step: float) -> Array:
    """Return angles from 0 to below a turn in steps, rad."""
    return step * np.arange(float(math.ceil(2.0 * math.pi / step - 1e-9)))


@dataclass(frozen=True, kw_only=True)
class GriddedOutput(OutputSpec):
    """Which files and studies of a cam in space are written, and how fine (see `OutputSpec`).

    Parameters
    ----------
    pose : float, rad
        Cam angle of the drawing.
    chord_tolerance, kerf, dxf_curves, dxf_version
        Its surfaces have steps instead, and what is drawn is not for cutting out.
    """

    wall_step: float = param(
        ANGLE,
        default=math.radians(0.5),
        ge=0.01,
        le=5,
        doc="step of the cam angle in walls.csv and in solids",
    )
    wall_points: int = param(
        COUNT, default=13, ge=2, le=500, doc="places along the roller in walls.csv and in solids"
    )
    motion_step: float = param(
        ANGLE, default=math.radians(1), gt=0, le=90, doc="step of the cam angle in motion.csv"
    )
    pose: float = pose_param("theta", "cam angle of the drawing")

    chord_tolerance: float | None = fixed(None)
    kerf: float = fixed(0.0)
    dxf_curves: str = fixed("lines")
    dxf_version: str | None = fixed(None)

    rules = (distinct("files", "format"), distinct("studies", "study"))
