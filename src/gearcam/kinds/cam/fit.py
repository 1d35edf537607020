"""A measured lift, understood: the design whose follower moves as on a profile or in a table."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import DesignError, Problem
from gearcam.base.facts import Fact
from gearcam.base.findings import Finding, run_checks
from gearcam.base.inches import INCH, unit_in
from gearcam.base.numerals import FEW, formatted
from gearcam.cams.checks import FittedMotion
from gearcam.cams.spec import FITTED
from gearcam.designs.writing import least_document, toml_text
from gearcam.kinds.cam.tables import FollowSpec
from gearcam.laws.columns import ColumnsError, read_rows
from gearcam.laws.lift_fit import FittedLift, fit_lift
from gearcam.laws.lift_model import number_of
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.motion_table import MotionTable, rows_of_turn
from gearcam.laws.row_checks import stray_in
from gearcam.numeric.arrays import Array, distinct
from gearcam.pictures.charts import Chart, Limit, Line, MarkedPlace

if TYPE_CHECKING:
    from gearcam.cams.wall import Wall
    from gearcam.kinds.cam.design import CamDesign
    from gearcam.kinds.cam.result import CamResult
    from gearcam.results.study import StudyResult

_FORMS: Final = ("disc", "groove", "conjugate")
"""Forms of cams whose phases fill a turn."""

_SIZED: Final = ("disc", "groove")
"""Forms whose prime or base radius alone places the lift."""

_ANGLES: Final = ("theta_deg", "angle_deg")
"""Names of the column of angles."""

FILE: Final = "fitted.toml"

_ERROR_DIGITS: Final = 2
"""Digits of errors as people read them."""


def read_lift(file: Any, wall: Wall) -> tuple[Array, Array] | None:
    """Return the rows of a lift in a CSV file, None if it is something else, or cannot be read.

    Parameters
    ----------
    file : path or anything else
        A CSV file with the columns theta_deg (or angle_deg) and lift_mm (lift_deg of an oscillating
        follower); other columns are ignored.
    wall : Wall
        The wall of the follower.

    Returns
    -------
    theta : (n,) array, rad
        Of a turn; a last row that repeats the first is left out.
    lift : (n,) array, mm or rad

    Raises
    ------
    DesignError
        If it is a lift, but not of a whole turn, or its rows are wrong.
    """
    if not isinstance(file, str | os.PathLike) or not os.fspath(file).lower().endswith(".csv"):
        return None
    name, (scale, unit) = os.fspath(file), wall.follower.lift_unit
    needed = f"rows of theta_deg and lift_{unit} over a whole turn"
    try:
        rows = read_rows(name)
    except ColumnsError:
        return None
    if not rows.spelt("lift_mm") and not rows.spelt("lift_deg"):
        return None
    try:
        angle = next((one for one in _ANGLES if rows.spelt(one)), _ANGLES[0])
        points, lines = rows.columns((angle, f"lift_{unit}"))
    except ColumnsError as error:
        raise DesignError([Problem(f"not a lift: {error}", file=name, allowed=needed)]) from error
    theta, lift = np.radians(points[:, 0]), points[:, 1] / scale
    table = MotionTable(theta=theta, lift=lift)
    for _, row, message, rule in table.turn_problems(oscillating=wall.follower.angular):
        place = f"line {lines[row]}: " if row is not None else ""
        raise DesignError([Problem(f"not a lift: {place}{message}", file=name, allowed=rule)])
    for one in stray_in(table.given(oscillating=wall.follower.angular)):
        message = f"line {lines[one.row]}: the {one.text}"
        raise DesignError([Problem(message, file=name, allowed=needed)])
    theta, lift = rows_of_turn(theta, lift)
    return theta, lift


def of_turn(study: StudyResult) -> dict[str, Array]:
    """Return the columns of a followed profile without the last row if it repeats the first."""
    columns = {name: np.asarray(values) for name, values in study.table.items()}
    theta = columns["theta_deg"]
    last = -1 if theta[-1] - theta[0] > 360.0 - 1e-6 else None
    return {name: values[:last] for name, values in columns.items()}


def demand_fit(design: CamDesign) -> None:
    """Refuse designs whose phases do not fill a turn.

    Raises
    ------
    DesignError
    """
    if design.form not in _FORMS:
        message = f"the phases of a {design.form} cam do not fill a turn: none are fitted"
        allowed = " or ".join(f'"{one}"' for one in _FORMS)
        problem = Problem(message, file=design.source, key="cam.form", allowed=allowed)
        raise DesignError([problem])


@dataclass(frozen=True, eq=False, kw_only=True)
class FittedDesign:
    """A program found in a lift, and the design that has it.

    Parameters
    ----------
    result : CamResult
        Of the given design.
    wall : Wall
        The wall whose lift it is.
    fitted : FittedLift
        The program.
    of_profile : bool
        Whether the lift is that of a profile, whose size is known.
    source : str
        What was measured.
    """

    result: CamResult
    wall: Wall
    fitted: FittedLift
    of_profile: bool
    source: str

    @property
    def _low(self) -> float:
        """The lowest level, mm or rad, above that of the design."""
        return float(self.fitted.model.levels.min())

    @cached_property
    def design(self) -> CamDesign:
        """The given design with the phases and sizes that were found."""
        given = self.result.design
        studies = tuple(one for one in given.output.studies if one != "follow")
        sizes = given.cam
        if self.of_profile and self._low and given.form in _SIZED:
            follower, unit = self.wall.follower, INCH if given.units == "inch" else 1.0
            key, radius = "prime_radius", follower.distance(follower.start + self._low)
            if sizes.prime_radius is None:
                key, radius = "base_radius", radius - self.result.follower.radius
            sizes = replace(sizes, **{key: unit * round(radius / unit, 6)})
        return replace(
            given,
            name=f"{given.name}_fitted",
            motion=self.fitted.phases(),
            cam=sizes,
            output=replace(given.output, studies=studies),
            follow=FollowSpec(),
        )

    @cached_property
    def named_as_given(self) -> CamResult:
        """The result of the fitted design, with name and hash of the given one.

        Its files stand beside those of the given one, and are made from it.
        """
        design = replace(self.design, name=self.result.design.name)
        made = type(self.result)(design, self.result.tolerances)
        vars(made)["design_hash"] = self.result.design_hash
        return made

    @cached_property
    def columns(self) -> dict[str, Array]:
        """The lift of the written design at the rows, and by what the rows are above it."""
        scale, rows = self.wall.follower.lift_unit[0], self.fitted.rows
        program = type(self.result)(self.design).program
        theta = rows.theta - self.fitted.begin[1]
        lift = program.derivatives(theta, 0)[0] + self._low
        return {"s_fitted": scale * lift, "missed": scale * (rows.lift - lift)}

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """Findings of the checks."""
        subject = FittedMotion(self.wall, self.fitted, self.of_profile)
        return run_checks(FITTED, subject, self.result.design.limits)

    @cached_property
    def facts(self) -> dict[str, Any]:
        """The facts of the fit."""
        (scale, unit), driver = self.wall.follower.lift_unit, self.wall.carrier.driver
        missed, rows = self.columns["missed"], self.fitted.rows
        worst = int(np.abs(missed).argmax())
        error = partial(_error, unit=unit)
        return {
            "noise": error(scale * rows.noise, "noise of the rows (rms)"),
            "rms": error(float(np.sqrt(np.mean(missed**2))), "residual of the fit (rms)"),
            "largest": error(
                float(missed[worst]),
                "largest residual",
                place=driver.place(float(rows.theta[worst])),
            ),
            "begins_deg": math.degrees(self.fitted.begin[1]) % 360.0,
            "lowest": scale * self._low,
            "phases": [self._phase(k) for k in self._order],
        }

    @property
    def _order(self) -> list[int]:
        """The moves, from the beginning of the program on."""
        first, count = self.fitted.begin[0], len(self.fitted.model.laws)
        return [(first + number) % count for number in range(count)]

    def _phase(self, k: int) -> dict[str, Any]:
        """Return the facts of a rise or return."""
        fitted, scale = self.fitted, self.wall.follower.lift_unit[0]
        model, zero = fitted.model, fitted.begin[1]
        start, end = (math.degrees(float(one[k]) - zero) for one in (model.starts, model.ends))
        turns = 360.0 * math.floor(start / 360.0 + 1e-9)
        missed = self.columns["missed"][fitted.on(k)]
        word, law = "return" if model.falling(k) else "rise", model.laws[k]
        start, end = round(start - turns, 9) + 0.0, round(end - turns, 9)
        others = [law_text(one.law) for one in fitted.alike[k]]
        facts: dict[str, Any] = {
            "type": word,
            "law": Fact(
                MOTION_LAWS.name_of(law),
                f"{word}, {formatted(start, FEW)} to {formatted(end, FEW)} deg",
                shown=True,
                text=law_text(law) + (" (or " + ", ".join(others) + ")" if others else ""),
            ),
            "start_deg": start,
            "end_deg": end,
            "start_error_deg": _error(
                math.degrees(fitted.error(("start", k))), f"error of its start, {word}"
            ),
            "end_error_deg": _error(
                math.degrees(fitted.error(("end", k))), f"error of its end, {word}"
            ),
            "lift": scale * abs(float(model.after[k] - model.levels[k])),
            "rms": float(np.sqrt(np.mean(missed**2))),
            "largest": float(np.abs(missed).max()),
        }
        return facts | {"alike": [MOTION_LAWS.name_of(one.law) for one in fitted.alike[k]]}

    @property
    def page(self) -> bytes:
        """The design as a file."""
        return toml_text(least_document(self.design), list(self._comments())).encode()

    def _comments(self) -> Iterator[str]:
        facts, unit = self.facts, self.wall.follower.lift_unit[1]
        noise, rms, most = (
            formatted(abs(facts[one].value), _ERROR_DIGITS) for one in ("noise", "rms", "largest")
        )
        yield f"fitted to {self.source}"
        yield f"residual {rms} {unit} (rms), {most} {unit} at most; noise {noise} {unit}"
        if facts["begins_deg"]:
            begins = formatted(facts["begins_deg"], FEW)
            yield f"its cam angle 0 is at {begins} deg of what was measured"
        for phase in facts["phases"]:
            if phase["alike"]:
                other = ", ".join(phase["alike"])
                yield f"{phase['law'].meaning}: cannot be distinguished from {other}"

    def charts(self) -> Mapping[str, Chart]:
        """Return the charts of both lifts and of the residual."""
        (scale, unit), driver = self.wall.follower.lift_unit, self.wall.carrier.driver
        rows, model = self.fitted.rows, self.fitted.model
        x = driver.scale * rows.theta
        ends = np.degrees(np.concatenate([model.starts, model.ends])) % 360.0
        marks = tuple(MarkedPlace(label="phases", value=one) for one in distinct(ends).tolist())
        chart = partial(Chart, x=driver.label, marks=marks)
        noise = 2.0 * scale * rows.noise
        fitted = Line(label="fitted design", x=x, y=self.columns["s_fitted"])
        return {
            "fitted_lift": chart(
                title="Lift that was measured, and that of the fitted design",
                y=f"lift, {unit}",
                lines=(Line(label="measured", x=x, y=scale * rows.lift, dots=True), fitted),
            ),
            "fitted_residual": chart(
                title="Measured lift less that of the fitted design",
                y=f"residual, {unit}",
                lines=(Line(label="residual", x=x, y=self.columns["missed"]),),
                limits=(
                    Limit(label="twice the noise", value=noise),
                    Limit(label="twice the noise", value=-noise),
                ),
            ),
        }


def _error(value: float, meaning: str, **more: Any) -> Fact:
    """Return the fact of an error, which is known to a digit or two."""
    return Fact(value, meaning, shown=True, text=formatted(value, _ERROR_DIGITS), **more)


def law_text(law: Any) -> str:
    """Return the name of a motion law, with its number if it has one that is not the default."""
    name, known = MOTION_LAWS.name_of(law), number_of(law)
    if known is None or law == type(law)():
        return name
    return f"{name} with {known[0]} = {formatted(getattr(law, known[0]), 4)}"


def fit(
    result: CamResult,
    wall: Wall,
    theta: Array,
    lift: Array,
    *,
    error: float | None,
    source: str | Path | Any,
) -> FittedDesign:
    """Return the design that moves as rows say.

    Parameters
    ----------
    result : CamResult
        Of the given design.
    wall : Wall
        The wall whose lift it is.
    theta : (n,) array, rad
        Cam angles of a turn.
    lift : (n,) array, mm or rad
        Lifts.
    error : float or None, mm or rad
        Error of the lifts from the chords of a profile; None for a lift that was given.
    source : path, or anything else
        What was measured.

    Returns
    -------
    FittedDesign

    Raises
    ------
    InfeasibleError
        If no phases can be found.
    """
    scale, unit = wall.follower.lift_unit
    unit, factor = unit_in(unit) if result.design.units == "inch" else (unit, 1.0)
    found = fit_lift(theta, lift, (scale * factor, unit), error or 0.0)
    name = Path(source).name if isinstance(source, str | os.PathLike) else "points"
    return FittedDesign(
        result=result, wall=wall, fitted=found, of_profile=error is not None, source=str(name)
    )
