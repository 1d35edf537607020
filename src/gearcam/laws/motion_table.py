"""Motion tables: the lift of a follower over a turn of the cam, by rows of angle and lift.

What comes of the rows, through them or smoothed, `gearcam.laws.rows_of_lift` says. Refused by
reading: rows that do not rise in angle, fill the turn, repeat after it or move.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, islice
from typing import Final

import numpy as np

from gearcam.errors import InfeasibleError
from gearcam.laws.columns import ColumnsError, FromFile
from gearcam.laws.entry import TYPED
from gearcam.laws.phases_of_lift import TURN
from gearcam.laws.program import Program
from gearcam.laws.rows_of_lift import program_of_rows
from gearcam.numerals import shown
from gearcam.numeric.arrays import Array
from gearcam.quantities import ANGLE, LENGTH, TEXT, param
from gearcam.tolerances import Tolerances

Problem = tuple[str, int | None, str, str]

_ANGLE: Final = "theta_deg"
_LIFTS: Final = {"length": "lift_mm", "swing": "lift_deg"}
"""What the lift may be, with its column in a file."""

_FEWEST: Final = 6
_MOST: Final = 2000
"""Rows: fewer make no curve of quintics, more are finer than a fifth of a degree, where rounding
leaves smoothing no digits."""

_NARROWEST: Final = 1e-6 * TURN
"""Least step of the angle, rad: a second of arc; the place of a row in it is known to 1e-10."""

_OPEN: Final = 1.5
"""Gap over the end of the turn, in widest steps, above which rows are missing: a last row that is
left out leaves a step."""

_LONGEST: Final = 1e6
"""Largest lift, mm, as of phases."""

_DEG: Final = math.radians(1.0)


@dataclass(frozen=True, kw_only=True)
class MotionTable(FromFile):
    """The lift over a whole turn, by rows in a CSV file or in the design itself.

    The last row may repeat the first one, 360 degrees on, or be left out. Smoothing is of
    `smoothing_length` for a lift in mm, of `smoothing_swing` for an angle.
    """

    file: str | None = param(
        TEXT, default=None, doc="CSV file with the columns theta_deg and lift_mm or lift_deg"
    )
    theta: tuple[float, ...] | None = param(
        ANGLE, default=None, ge=0, le=360, min_length=_FEWEST, doc="cam angles, without a file"
    )
    length: tuple[float, ...] | None = param(
        LENGTH,
        default=None,
        ge=-_LONGEST,
        le=_LONGEST,
        min_length=_FEWEST,
        word="lift",
        doc="lifts at theta (translating follower)",
    )
    swing: tuple[float, ...] | None = param(
        ANGLE,
        default=None,
        gt=-180,
        lt=180,
        min_length=_FEWEST,
        word="lift",
        doc="lifts at theta (oscillating follower)",
    )
    smoothing_length: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        word="smoothing_tolerance",
        doc="largest distance from the rows; 0 if left out (translating)",
    )
    smoothing_swing: float | None = param(
        ANGLE,
        default=None,
        gt=0,
        word="smoothing_tolerance",
        doc="largest distance from the rows; 0 if left out (oscillating)",
    )

    @property
    def tolerance(self) -> float:
        """Largest distance from the rows that smoothing may make, mm or rad."""
        return self.smoothing_length or self.smoothing_swing or 0.0

    def problems(self) -> Iterator[Problem]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        inline = [name for name in _LIFTS if getattr(self, name) is not None]
        rule = "file, or theta_deg with lift_mm or lift_deg"
        if self.file is not None:
            if inline or self.theta is not None:
                yield "file", None, "the rows are given twice", rule
                return
            try:
                _, lines = self.table
            except ColumnsError as error:
                columns = "a CSV file with the columns theta_deg and lift_mm or lift_deg"
                yield "file", None, str(error), columns
                return
            for _, row, message, allowed in islice(self._row_problems(), 1):
                place = f"line {lines[row]}: " if row is not None else ""
                yield "file", None, place + message, allowed
        elif self.theta is None:
            yield "theta", None, "no rows are given", rule
        elif len(inline) != 1:
            yield "length", None, f"{' and '.join(inline) or 'no lift is'} given", rule
        elif len(getattr(self, inline[0])) != len(self.theta):
            message = f"{len(getattr(self, inline[0]))} lifts for {len(self.theta)} angles"
            yield inline[0], None, message, "one lift for each angle"
        else:
            yield from islice(self._row_problems(), 1)

    def kind_problems(self, *, oscillating: bool) -> Iterator[Problem]:
        """Yield what is of the wrong kind for a follower: lengths for one that oscillates, say.

        Parameters
        ----------
        oscillating : bool
            Whether lifts are angles.

        Yields
        ------
        tuple
            Field, None, what is wrong, what is allowed.
        """
        kind, unit = ("an oscillating", "_deg") if oscillating else ("a translating", "_mm")
        wrong, right = ("length", "swing") if oscillating else ("swing", "length")
        message = f"of the wrong kind for {kind} follower"
        for name in (wrong, f"smoothing_{wrong}"):
            if getattr(self, name) is not None:
                yield name, None, f"is {message}", f"the key in {unit}"
        if self.rows is not None and _LIFTS[wrong] in self.rows.cells[0]:
            rule = f"the column {_LIFTS[right]}"
            yield "file", None, f"line {self.rows.lines[0]}: {_LIFTS[wrong]} is {message}", rule

    @cached_property
    def table(self) -> tuple[Array, list[int]]:
        """Rows of angle, rad, and lift, mm or rad, (n, 2); and their lines in the file, if any.

        It raises `ColumnsError` with the line of the file that is wrong.
        """
        if self.rows is None:
            lifts = self.length if self.length is not None else self.swing
            return np.array([self.theta, lifts], dtype=float).T, []
        known = [name for name, column in _LIFTS.items() if column in self.rows.cells[0]]
        names = [_ANGLE, _LIFTS[known[0]]] if len(known) == 1 else []
        points, lines = self.rows.columns(names)
        return points * (_DEG, _DEG if known == ["swing"] else 1.0), lines

    @property
    def swings(self) -> bool:
        """Whether lifts are angles."""
        return self.swing is not None or (
            self.rows is not None and _LIFTS["swing"] in self.rows.cells[0]
        )

    def _row_problems(self) -> Iterator[Problem]:
        """Yield what is wrong with the rows: column, row, message, allowed.

        The first is meant: what comes after it takes it for granted.
        """
        theta, lift = self.table[0].T
        if not _FEWEST <= len(theta) <= _MOST:
            yield "theta", None, f"has {len(theta)} rows", f"{_FEWEST} to {_MOST} rows"
        for row in np.flatnonzero((theta < 0.0) | (theta > TURN + TYPED)).tolist():
            yield "theta", row, f"the angle is {_degrees(theta[row])}", "0 to 360 deg"
        steps = np.diff(theta)
        for row in np.flatnonzero(steps < _NARROWEST).tolist():
            before, here = _degrees(theta[row]), _degrees(theta[row + 1])
            state = f"{here} stands twice" if steps[row] == 0.0 else f"{here} follows {before}"
            rule = f"each angle at least {_degrees(_NARROWEST)} above the one before"
            yield "theta", row + 1, state, rule
        gap = TURN - float(theta[-1] - theta[0])
        if gap > _OPEN * steps.max() + TYPED:
            state = f"the rows go from {_degrees(theta[0])} to {_degrees(theta[-1])}"
            rule = "rows over the whole turn; the last one, at 360 deg, may be left out"
            yield "theta", None, state, rule
        yield from self._lift_problems(lift, repeated=gap < _NARROWEST)

    def _lift_problems(self, lift: Array, *, repeated: bool) -> Iterator[Problem]:
        """Yield what is wrong with lifts of which the last may be the first one, `repeated`."""
        column, scale, unit = ("swing", _DEG, "deg") if self.swings else ("length", 1.0, "mm")

        def told(value: float) -> str:
            return f"{shown(value / scale, 10)} {unit}"

        largest = math.pi if self.swings else _LONGEST
        for row in np.flatnonzero(np.abs(lift) > largest).tolist():
            yield column, row, f"the lift is {told(lift[row])}", f"at most {told(largest)}"
        extent = float(np.ptp(lift))
        if extent <= TYPED * float(np.abs(lift).max()):
            yield column, None, "the follower never moves", "lifts that differ"
        if self.tolerance >= 0.5 * extent:
            rule = f"below {told(0.5 * extent)}, half of what the lifts differ by"
            yield f"smoothing_{column}", None, "leaves no lift", rule
        jump = float(lift[-1] - lift[0])
        if repeated and abs(jump) > max(self.tolerance, TYPED * extent):
            state = f"the lift after the turn is {told(lift[-1])}: it jumps by {told(abs(jump))}"
            yield column, len(lift) - 1, state, f"that of the first row, {told(lift[0])}"

    def program(self, tolerances: Tolerances, *, oscillating: bool = False) -> Program:  # noqa: ARG002  (a spline is in closed form)
        """Return the program that the rows make.

        Parameters
        ----------
        tolerances : Tolerances
            Accuracy of what is expanded; here nothing is.
        oscillating : bool
            Whether lifts are angles.

        Returns
        -------
        Program
            See `gearcam.laws.rows_of_lift.program_of_rows`.

        Raises
        ------
        InfeasibleError
            If the file is not such a table any more, or lifts are of the wrong kind.
        """
        told = chain(self.problems(), self.kind_problems(oscillating=oscillating))
        for name, index, message, rule in told:
            where = f"motion.{name}" + ("" if index is None else f"[{index}]")
            raise InfeasibleError(message, where=where, nearest=rule)
        (theta, lift), spread = self.table[0].T.copy(), 0.0
        if TURN - (theta[-1] - theta[0]) < _NARROWEST:  # the last row is the first one again
            first, last = lift[0], lift[-1]
            lift[0], spread = 0.5 * (first + last), 0.5 * abs(float(last - first))
            theta, lift = theta[:-1], lift[:-1]
        return program_of_rows(theta, lift, self.tolerance, spread)


def _degrees(angle: float) -> str:
    return f"{shown(math.degrees(angle), 10)} deg"
