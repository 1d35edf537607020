"""Motion laws given by points: B-splines of control values, and splines through tables."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.base.numerals import formatted
from gearcam.base.quantities import COUNT, NUMBER, TEXT, Row, param
from gearcam.base.rules import Breach, exactly_one
from gearcam.base.tolerances import Tolerances
from gearcam.laws.columns import FromFile, Given, demand
from gearcam.laws.entry import TYPED, LawEntry
from gearcam.laws.motion.base import ClosedForm, MotionFunction
from gearcam.laws.motion.pieces import about, spline
from gearcam.numeric.arrays import Array
from gearcam.numeric.least_jerk import chain_slopes, coefficients
from gearcam.numeric.piecewise import Piecewise

_CLOSEST: Final = 1e-6
"""Smallest step of x in a table: a second of arc of a full turn."""

_FEWEST: Final = 3
_MOST: Final = 2000
"""Most rows of a table: one every fifth of a degree of a full turn."""

_MOST_VALUES: Final = 500
"""Most control values of a B-spline."""


@dataclass(frozen=True, kw_only=True)
class BSplineRise(ClosedForm):
    """A B-spline of S with clamped, evenly spaced knots.

    Each control value acts on S over a few knots; k equal values (zeros or ones) at an end make the
    first k - 1 derivatives zero there.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.BSplineRise(control=(0.0, 0.0, 0.0, 1.0, 1.0, 1.0))
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.0938, 1.0, 6.0]
    """

    control: Row = param(
        NUMBER, ge=-100, le=100, min_length=4, doc="control values of S, from 0 to 1"
    )
    degree: int = param(
        COUNT, default=4, ge=3, le=5, doc="degree of the pieces; C2 to C4 (degree - 1)"
    )

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        count = len(self.control)
        if not self.degree < count <= _MOST_VALUES:
            rule = f"{self.degree + 1} to {_MOST_VALUES} control values for degree {self.degree}"
            yield "control", None, f"{count} control values are given", rule
            return
        for index, place, corner in ((0, "first", 0.0), (count - 1, "last", 1.0)):
            if self.control[index] != corner:
                message = f"the {place} control value is not {formatted(corner)}"
                yield "control", index, message, f"{formatted(corner)}"

    def function(self) -> Piecewise:
        """S over phi, exact polynomials between the knots."""
        p = self.degree
        spans = len(self.control) - p
        grid = [number / spans for number in range(spans + 1)]
        values = [Fraction(value) for value in self.control]
        left = [_span(values[n : n + p + 1], n, spans) for n in range(spans)]
        both = (
            [[float(value * spans**k) for k, value in enumerate(powers)] for powers in rows]
            for rows in (left, [about(powers, 1) for powers in left])
        )
        return spline(grid, *both)


def _span(control: list[Fraction], number: int, spans: int) -> list[Fraction]:
    """Return a B-spline between two knots as powers of the distance from the first, in knots.

    Exact, by de Boor's recursion with polynomials in place of numbers; knots are 0, 1, ... `spans`.
    """
    p = len(control) - 1
    # the p knots before and after the two; knots beyond the ends are moved to the ends
    knots = [min(max(number - p + 1 + k, 0), spans) for k in range(2 * p)]
    rows = np.full((p + 1, p + 1), Fraction(0))
    rows[:, 0] = control
    for r in range(1, p + 1):
        for i in range(p, r - 1, -1):
            low, high = knots[i - 1], knots[i + p - r]
            step = (rows[i] - rows[i - 1]) / (high - low)
            rows[i] = rows[i - 1] + (number - low) * step + np.roll(step, 1)
    return rows[p].tolist()


@dataclass(frozen=True, kw_only=True)
class TableRise(FromFile):
    """A quintic spline through points, C4.

    Of all curves through the points with the given end conditions it has the least integral of the
    squared jerk. Velocity and acceleration can be given at both ends, so that it meets dwells
    without a jump of acceleration; a cubic spline could not.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.motion_laws.TableRise(x=(0.0, 0.5, 1.0), y=(0.0, 0.5, 1.0))
    >>> lift = law.build(gc.Tolerances()).function
    >>> [round(float(one), 4) for one in lift.derivatives(0.25, 2)]  # S, S', S'' at phi = 0.25
    [0.1035, 1.0547, 5.625]
    """

    file: str | None = param(TEXT, default=None, doc="CSV file with the columns x and y")
    x: Row | None = param(
        NUMBER, default=None, ge=0, le=1, min_length=_FEWEST, doc="share of the angle"
    )
    y: Row | None = param(
        NUMBER, default=None, ge=-100, le=100, min_length=_FEWEST, doc="share of the lift there"
    )
    start: tuple[float, float] = param(
        NUMBER,
        default=(0.0, 0.0),
        ge=-1e6,
        le=1e6,
        doc="S' and S'' at the start; zero meets a dwell",
    )
    end: tuple[float, float] = param(
        NUMBER, default=(0.0, 0.0), ge=-1e6, le=1e6, doc="S' and S'' at the end; zero meets a dwell"
    )

    rules = (exactly_one("file", "x"), exactly_one("file", "y"))

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        yield from self.row_problems("xy", lambda: self.points, _problems, "the columns x and y")

    @cached_property
    def points(self) -> tuple[Array, list[int]]:
        """Rows of x and y, and their lines in the file; it raises `ColumnsError`."""
        if self.rows is not None:
            return self.rows.columns(("x", "y"))
        return np.array([self.x, self.y], dtype=float).T, []

    def given(self, *, oscillating: bool) -> Given:  # noqa: ARG002  (shares of a lift)
        """Return the rows (see `FromFile.given`)."""
        points, lines = self.points
        x, y = points.T
        return Given(
            key="y", called="y", x=x, y=y, lines=lines, place=lambda at: f"x = {formatted(at)}"
        )

    def build(self, tolerances: Tolerances) -> MotionFunction:  # noqa: ARG002  (a spline is in closed form)
        """Return the rise.

        Raises
        ------
        InfeasibleError
            If the file was changed and is not a valid table any more.
        """
        demand(self.problems(), "motion")
        points = self.points[0].copy()
        points[0], points[-1] = (0.0, 0.0), (1.0, 1.0)
        ends = self.start, self.end
        return MotionFunction(function=_through(points, *ends), errors=_errors(points, *ends))


def _problems(points: Array) -> Iterator[Breach]:
    if not _FEWEST <= len(points) <= _MOST:
        yield "x", None, f"has {len(points)} points", f"{_FEWEST} to {_MOST} points"
        return
    for column, name in enumerate("xy"):
        for row, place, corner in ((0, "first", 0.0), (len(points) - 1, "last", 1.0)):
            value = float(points[row, column])
            if abs(value - corner) > TYPED:
                message = f"the {place} {name} is {formatted(value, 10)}, not {formatted(corner)}"
                yield name, row, message, "x and y from 0 to 1: shares of the angle and of the lift"
    for row in np.flatnonzero(np.diff(points[:, 0]) < _CLOSEST)[:1]:
        rule = f"each x at least {formatted(_CLOSEST)} above the one before"
        yield "x", int(row) + 1, "x does not rise", rule


def _through(points: Array, start: tuple[float, float], end: tuple[float, float]) -> Piecewise:
    """Return the quintic spline through points with given S' and S'' at its ends."""
    x, y = points.T
    return spline(x, *coefficients(x, y, chain_slopes(x, y, start, end), ring=False))


def _errors(
    points: Array, start: tuple[float, float], end: tuple[float, float]
) -> tuple[float, ...]:
    """Return the effect of rounding on the spline and its derivatives.

    The equations are solved again with values changed by their rounding, in several patterns.
    """
    x, y = points.T
    places = (x[:-1] + np.diff(x) * np.array([[0.0], [0.25], [0.5], [0.75]])).ravel(order="F")
    exact = np.array(_through(points, start, end).derivatives(places, 3))
    changes = []
    for step in (1, 2):
        sign = (-1.0) ** (np.arange(len(y)) // step)
        rounded = np.column_stack([x, y * (1.0 + 24.0 * np.finfo(float).eps * sign)])
        values = np.array(_through(rounded, start, end).derivatives(places, 3))
        changes.append(np.abs(values - exact).max(axis=1))
    return tuple(np.max(changes, axis=0).tolist())


ENTRIES: Final = (
    LawEntry(
        name="b-spline",
        example=BSplineRise(control=(0.0, 0.0, 0.0, 1.0, 1.0, 1.0), degree=5),
        doc="a motion shaped by control values, each of which acts near its own place",
        continuity="C2 to C4 inside (degree - 1); at the ends by the number of zeros and ones",
        source="de Boor",
    ),
    LawEntry(
        name="table",
        example=TableRise(
            x=(0.0, 0.1, 0.3, 0.35, 0.7, 1.0), y=(0.0, 0.00856, 0.16308, 0.235169, 0.83692, 1.0)
        ),
        doc="measured or computed points joined with the least jerk: copies an existing motion",
        continuity="C4 inside; C2 between dwells, where the jerk jumps at both ends",
        source="de Boor; end conditions from the least jerk",
    ),
)
