"""Motion tables: the lift of a follower over a turn of the cam, by rows of angle and lift.

`gearcam.laws.rows_of_lift` makes a curve through the rows or a smoothed one. Refused by reading:
angles that do not rise or do not fill the turn, a lift that does not repeat or is constant.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Final

import numpy as np

from gearcam.base.numerals import formatted
from gearcam.base.quantities import ANGLE, FINEST, LENGTH, LONGEST, TEXT, Param, Row, param
from gearcam.base.rules import Breach
from gearcam.base.tolerances import Tolerances
from gearcam.laws.columns import (
    NARROWEST_STEP,
    ColumnsError,
    FromFile,
    close_angles,
    degrees,
    demand,
)
from gearcam.laws.entry import TYPED
from gearcam.laws.phases_of_lift import TURN
from gearcam.laws.program import Program
from gearcam.laws.rows_of_lift import program_of_rows
from gearcam.numeric.arrays import Array

_FEWEST: Final = 6
_MOST: Final = 3600
"""Fewest and most rows: quintics need a few; rows closer than a tenth of a degree leave smoothing
too few digits (see `gearcam.numeric.least_jerk.smoothed_ring`)."""

_OPEN: Final = 1.5
"""Gap at the end of the turn over the widest step above which rows are missing: a last row that is
left out leaves one step."""

_DEG: Final = math.radians(1.0)


@dataclass(frozen=True, kw_only=True)
class MotionTable(FromFile):
    """The lift over a whole turn as rows in a CSV file or in the design itself.

    Lifts and their tolerance are in mm, or in rad if the follower oscillates. The last row may
    repeat the first one after a turn, or be left out.

    Examples
    --------
    >>> import gearcam as gc
    >>> import numpy as np
    >>> theta = np.radians(np.arange(0.0, 360.0, 10.0))
    >>> gc.MotionTable(theta=theta, lift=5.0 - 5.0 * np.cos(theta), smoothing_tolerance=0.01)
    MotionTable(theta=array(36,), lift=array(36,), smoothing_tolerance=0.01)
    """

    file: str | None = param(
        TEXT,
        default=None,
        example="motion.csv",
        doc="CSV file, up to 3600 rows: theta_deg and lift_mm or lift_deg",
    )
    theta: Row | None = param(
        ANGLE, default=None, ge=0, le=360, min_length=_FEWEST, doc="cam angles, without a file"
    )
    lift: Row | None = param(
        LENGTH,
        default=None,
        ge=-LONGEST,
        le=LONGEST,
        min_length=_FEWEST,
        doc="lifts at theta (translating follower)",
        when=("translating",),
        other=Param(
            ANGLE, gt=-180, lt=180, min_length=_FEWEST, doc="lifts at theta (oscillating follower)"
        ),
    )
    smoothing_tolerance: float | None = param(
        LENGTH,
        default=None,
        ge=FINEST,
        example=0.01,
        doc="largest distance from a row; 0 if left out (translating follower)",
        when=("translating",),
        other=Param(ANGLE, gt=0, doc="largest distance from a row (oscillating follower)"),
    )

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        rule = "file, or theta_deg with lift_mm or lift_deg"
        if self.file is not None:
            if self.theta is not None or self.lift is not None:
                yield "file", None, "the rows are given twice", rule
        elif self.theta is None or self.lift is None:
            missing = "theta" if self.theta is None else "lift"
            yield missing, None, "is missing: a table has both columns, or a file", rule

    def turn_problems(self, *, oscillating: bool) -> Iterator[Breach]:
        """Yield the first fault of the rows for a follower: field, index, message, allowed.

        Parameters
        ----------
        oscillating : bool
            Whether lifts are angles.

        Yields
        ------
        tuple
            Only the first fault, since others may follow from it.
        """

        def check(theta: Array, lift: Array) -> Iterator[Breach]:
            yield from _angle_problems(theta)
            yield from self._lift_problems(theta, lift, oscillating)

        needed = " and ".join(_columns(oscillating))
        problems = self.row_problems(
            ("theta", "lift"), lambda: self._rows(oscillating), check, needed
        )
        yield from islice(problems, 1)

    def _rows(self, oscillating: bool) -> tuple[Array, Array, list[int]]:
        """Return angles, rad, lifts, mm or rad, and their lines in the file, if there is one."""
        if self.rows is None:
            return np.array(self.theta, dtype=float), np.array(self.lift, dtype=float), []
        columns, wrong = _columns(oscillating), _columns(not oscillating)[1]
        if wrong in self.rows.cells[0] and columns[1] not in self.rows.cells[0]:
            kind = "an oscillating" if oscillating else "a translating"
            message = f"{wrong} is of the wrong kind for {kind} follower"
            raise ColumnsError(f"line {self.rows.lines[0]}: {message}")
        points, lines = self.rows.columns(columns)
        theta, lift = points.T * [[_DEG], [_DEG if oscillating else 1.0]]
        return theta, lift, lines

    def _lift_problems(self, theta: Array, lift: Array, oscillating: bool) -> Iterator[Breach]:
        scale, unit = (_DEG, "deg") if oscillating else (1.0, "mm")

        def text(value: float) -> str:
            return f"{formatted(value / scale, 10)} {unit}"

        largest = math.pi if oscillating else LONGEST
        for row in np.flatnonzero(np.abs(lift) > largest).tolist():
            yield "lift", row, f"the lift is {text(lift[row])}", f"at most {text(largest)}"
        extent, tolerance = float(np.ptp(lift)), self.smoothing_tolerance or 0.0
        if extent <= TYPED * float(np.abs(lift).max()):
            yield "lift", None, "the follower never moves", "at least two different lifts"
        if tolerance >= 0.5 * extent:
            rule = f"below {text(0.5 * extent)}, half of the total lift"
            yield "smoothing_tolerance", None, "leaves no lift", rule
        jump = float(lift[-1] - lift[0])
        if _repeats(theta) and abs(jump) > max(tolerance, TYPED * extent):
            state = f"the lift after the turn is {text(lift[-1])}: it jumps by {text(abs(jump))}"
            yield "lift", len(lift) - 1, state, f"that of the first row, {text(lift[0])}"

    def program(self, tolerances: Tolerances, *, oscillating: bool = False) -> Program:  # noqa: ARG002  (a spline is in closed form)
        """Return the program of the rows.

        Parameters
        ----------
        tolerances : Tolerances
            Accuracy of expansions; not used here.
        oscillating : bool
            Whether lifts are angles.

        Returns
        -------
        Program
            See `gearcam.laws.rows_of_lift.program_of_rows`.

        Raises
        ------
        InfeasibleError
            If the file was changed and is not a valid table any more.
        """
        demand(self.turn_problems(oscillating=oscillating), "motion")
        (theta, lift, _), spread = self._rows(oscillating), 0.0
        if _repeats(theta):
            spread = 0.5 * abs(float(lift[-1] - lift[0]))
            lift[0] = 0.5 * (lift[0] + lift[-1])
            theta, lift = theta[:-1], lift[:-1]
        return program_of_rows(theta, lift, self.smoothing_tolerance or 0.0, spread)


def _columns(oscillating: bool) -> tuple[str, str]:
    return "theta_deg", "lift_deg" if oscillating else "lift_mm"


def _repeats(theta: Array) -> bool:
    """Whether the last row repeats the first one after a turn."""
    return TURN - float(theta[-1] - theta[0]) < NARROWEST_STEP


def _angle_problems(theta: Array) -> Iterator[Breach]:
    if not _FEWEST <= len(theta) <= _MOST:
        yield "theta", None, f"has {len(theta)} rows", f"{_FEWEST} to {_MOST} rows"
    for row in np.flatnonzero((theta < 0.0) | (theta > TURN + TYPED)).tolist():
        yield "theta", row, f"the angle is {degrees(theta[row])}", "0 to 360 deg"
    for row, state, rule in close_angles(theta):
        yield "theta", row, state, rule
    steps = np.diff(theta)
    if TURN - float(theta[-1] - theta[0]) > _OPEN * steps.max() + TYPED:
        state = f"the rows go from {degrees(theta[0])} to {degrees(theta[-1])}"
        rule = "rows over the whole turn; the last one, at 360 deg, may be left out"
        yield "theta", None, state, rule
