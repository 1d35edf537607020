"""Motion tables: the lift of a follower over a turn of the cam, by rows of angle and lift.

Instead of the lift a file may have the radius of a profile over its polar angle, as measured with a
caliper. The same curve is then laid through the radii, and `gearcam.cams.measured` puts the
follower on it.

Refused by reading: angles that do not rise or do not fill the turn, a lift that does not repeat or
is constant; radii that are not above 0, or too far apart.

Without a tolerance the lift is the closed curve through the rows with the least integral of the
squared jerk: quintics between rows, C4 everywhere, whose error falls with the sixth power of the
step for a smooth motion. Measured rows are noisy, and the jerk of a curve through them is that of
the noise. With a tolerance the lift is the smoothing spline, which balances the same jerk against
the distances from the rows. Its cutoff is the lowest at which no row is farther away than the
tolerance, so that noise is averaged by one rule over the whole turn. (The curve of least jerk
within the tolerance would be smoother, but runs along the tolerance and flattens every peak.)

Source: C. de Boor, A Practical Guide to Splines, chapter XIV (the smoothing spline).
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
    ColumnsError,
    FromFile,
    Given,
    close_angles,
    degrees,
    demand,
    spans,
)
from gearcam.laws.displacement import Deviation
from gearcam.laws.entry import TYPED
from gearcam.laws.motion.pieces import from_both_ends, spline
from gearcam.laws.phases_of_lift import TURN
from gearcam.laws.program import Program, stretches_of
from gearcam.numeric.arrays import Array
from gearcam.numeric.least_jerk import coefficients, ring_slopes, smoothed_ring
from gearcam.numeric.piecewise import Piecewise, piecewise

_FEWEST: Final = 6
_MOST: Final = 3600
"""Fewest and most rows: quintics need a few; rows closer than a tenth of a degree leave smoothing
too few digits (see `gearcam.numeric.least_jerk.smoothed_ring`)."""

_OPEN: Final = 1.5
"""Gap at the end of the turn over the widest step above which rows are missing: a last row that is
left out leaves one step."""

_APART: Final = math.radians(15.0)
"""Largest step between measured radii: a rise of 60 deg has four then."""

_DEG: Final = math.radians(1.0)

_PER_WAVE: Final = 6
"""Rows of a smoothed lift that are kept for each wave at the cutoff: the error of the curve through
them is below a hundredth of the tolerance and included in the estimates."""

_BESIDE: Final = np.array([2.0, 4.0, 4.0, 4.0])
"""Safety factor: errors are measured midway between rows and may be twice as large near a row where
a derivative jumps; derivatives are compared with a curve that has errors too."""


@dataclass(frozen=True, kw_only=True)
class MotionTable(FromFile):
    """The lift over a whole turn as rows in a CSV file or in the design itself.

    Lifts and their tolerance are in mm, or in rad if the follower oscillates. The rows may begin at
    any angle; the last one may repeat the first after a turn, or be left out. A file may have the
    radii of a profile over the polar angle in the cam's frame instead.

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
        doc="CSV file, up to 3600 rows: theta_deg and lift_mm or lift_deg; of a measured profile "
        "angle_deg and radius_mm",
    )
    theta: Row | None = param(
        ANGLE,
        default=None,
        ge=-360,
        le=720,
        min_length=_FEWEST,
        doc="cam angles of a turn, without a file",
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
    radius_tolerance: float | None = param(
        LENGTH,
        default=None,
        ge=FINEST,
        example=0.02,
        doc="largest distance from a measured radius, of a file that has radii; 0 if left out",
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

    @property
    def of_radii(self) -> bool:
        """Whether the rows are radii of a profile: they have no lift."""
        try:
            head = self.rows.cells[0] if self.rows else []
        except ColumnsError:
            return False
        starts = [cell.lower()[:4] for cell in head]
        return "radi" in starts and "lift" not in starts

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
            yield from self._radius_problems(theta, lift) if self.of_radii else ()
            yield from self._value_problems(theta, lift, oscillating)

        needed = " and ".join(self._columns(oscillating))
        if not self.of_radii:
            needed += ", or with angle_deg and radius_mm of a measured profile"
        problems = self.row_problems(
            ("theta", "lift"), lambda: self._rows(oscillating), check, needed
        )
        yield from islice(problems, 1)

    def _rows(self, oscillating: bool) -> tuple[Array, Array, list[int]]:
        """Return angles, rad, lifts, mm or rad, and their lines in the file, if there is one."""
        if self.rows is None:
            return np.array(self.theta, dtype=float), np.array(self.lift, dtype=float), []
        columns, other = self._columns(oscillating), self._columns(not oscillating)
        wrong = columns != other and self.rows.spelt(other[1])
        if wrong and not self.rows.spelt(columns[1]):
            kind = "an oscillating" if oscillating else "a translating"
            message = f"{wrong} is of the wrong kind for {kind} follower"
            raise ColumnsError(f"line {self.rows.lines[0]}: {message}")
        points, lines = self.rows.columns(columns)
        theta, lift = points.T * [[_DEG], [self._unit(oscillating)[0]]]
        return theta, lift, lines

    def _columns(self, oscillating: bool) -> tuple[str, str]:
        if self.of_radii:
            return "angle_deg", "radius_mm"
        return "theta_deg", "lift_deg" if oscillating else "lift_mm"

    def _unit(self, oscillating: bool) -> tuple[float, str]:
        """Return the unit of the rows in a file, in mm or rad, and its name."""
        return (_DEG, "deg") if oscillating and not self.of_radii else (1.0, "mm")

    def _radius_problems(self, theta: Array, radius: Array) -> Iterator[Breach]:
        for row in np.flatnonzero(~((radius > 0.0) & (radius <= LONGEST))).tolist():
            state = f"the radius is {formatted(radius[row], 10)} mm"
            yield "lift", row, state, f"above 0, at most {formatted(LONGEST)} mm"
        steps = np.diff(theta)
        for row in np.flatnonzero(steps > _APART + TYPED).tolist():
            state = f"the radius before is {degrees(float(steps[row]))} away"
            yield "lift", row + 1, state, f"radii at most {degrees(_APART)} apart"

    def _value_problems(self, theta: Array, values: Array, oscillating: bool) -> Iterator[Breach]:
        """Yield the faults of lifts, or of radii."""
        scale, unit = self._unit(oscillating)
        word, every, whole = "lift", "lifts", "the total lift"
        name, other = "smoothing_tolerance", "radius_tolerance"
        if self.of_radii:
            word, every, whole = "radius", "radii", "the difference of the radii"
            name, other = other, name

        def text(value: float) -> str:
            return f"{formatted(value / scale, 10)} {unit}"

        largest = math.pi if unit == "deg" else LONGEST
        for row in np.flatnonzero(np.abs(values) > largest).tolist():
            yield "lift", row, f"the {word} is {text(values[row])}", f"at most {text(largest)}"
        extent, tolerance = float(np.ptp(values)), getattr(self, name) or 0.0
        if extent <= TYPED * float(np.abs(values).max()):
            yield "lift", None, "the follower never moves", f"at least two different {every}"
        if tolerance >= 0.5 * extent:
            yield name, None, "leaves no lift", f"below {text(0.5 * extent)}, half of {whole}"
        if getattr(self, other) is not None:
            others = "lifts" if self.of_radii else "radii"
            yield other, None, f"is of {others}, but the rows are {every}", f"{name}_{unit}"
        jump = abs(float(values[-1] - values[0]))
        if spans(theta, TURN) and jump > max(tolerance, TYPED * extent):
            state = f"the {word} after the turn is {text(values[-1])}: it jumps by {text(jump)}"
            yield "lift", len(values) - 1, state, f"that of the first row, {text(values[0])}"

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
            Knots are the ends of the turn and the rows; of a smoothed lift only as many rows as
            needed. Of radii the radius over the polar angle.

        Raises
        ------
        InfeasibleError
            If the file was changed and is not a valid table any more.
        """
        demand(self.turn_problems(oscillating=oscillating), "motion")
        theta, lift, _ = self._rows(oscillating)
        apart = np.zeros(len(theta))
        if spans(theta, TURN):
            apart[0] = 0.5 * abs(float(lift[-1] - lift[0]))
            lift[0] = 0.5 * (lift[0] + lift[-1])
        theta, lift, apart = rows_of_turn(theta, lift, apart)
        tolerance = self.radius_tolerance if self.of_radii else self.smoothing_tolerance
        return program_of_rows(theta, lift, apart, tolerance or 0.0)

    def given(self, *, oscillating: bool) -> Given:
        """Return the rows (see `FromFile.given`)."""
        theta, lift, lines = self._rows(oscillating)
        count = len(theta) - 1 if spans(theta, TURN) else len(theta)
        scale, unit = self._unit(oscillating)
        word = "radius" if self.of_radii else "lift"
        return Given(
            key=word,
            called=word,
            x=theta[:count],
            y=lift[:count] / scale,
            lines=lines,
            place=lambda angle: f"at {degrees(angle)}",
            period=TURN,
            unit=unit,
        )


def rows_of_turn(theta: Array, *columns: Array) -> tuple[Array, ...]:
    """Return the rows of a table from angle 0 on, without a last one that repeats the first.

    Parameters
    ----------
    theta : (n,) array, rad
        Angles of rows over a turn, rising from any angle.
    *columns : (n,) array
        Values of the rows.

    Returns
    -------
    tuple of (m,) array
        The angles, from 0 to below a turn, and the columns.
    """
    count = len(theta) - 1 if spans(theta, TURN) else len(theta)
    angles = theta[:count] % TURN
    angles[angles > TURN - TYPED] = 0.0
    first = int(np.argmin(angles))
    return tuple(np.roll(one, -first) for one in (angles, *(one[:count] for one in columns)))


def _angle_problems(theta: Array) -> Iterator[Breach]:
    if not _FEWEST <= len(theta) <= _MOST:
        yield "theta", None, f"has {len(theta)} rows", f"{_FEWEST} to {_MOST} rows"
    for row in np.flatnonzero((theta < -TURN - TYPED) | (theta > 2.0 * TURN + TYPED)).tolist():
        yield "theta", row, f"the angle is {degrees(theta[row])}", "-360 to 720 deg"
    for row, state, rule in close_angles(theta):
        yield "theta", row, state, rule
    left = TURN - float(theta[-1] - theta[0])
    state = f"the rows go from {degrees(theta[0])} to {degrees(theta[-1])}"
    end = degrees(theta[0] + TURN)
    if left < 0.0 and not spans(theta, TURN):
        yield "theta", len(theta) - 1, state, f"rows over one turn: up to {end}"
    if left > _OPEN * np.diff(theta).max() + TYPED:
        rule = f"rows over the whole turn; the last one, at {end}, may be left out"
        yield "theta", None, state, rule


def program_of_rows(theta: Array, lift: Array, apart: Array, tolerance: float) -> Program:
    """Return the program of rows in a turn.

    Parameters
    ----------
    theta, lift : (n,) arrays
        Angles from 0 to below a turn, rad, and lifts.
    apart : (n,) array
        By how much rows that were given twice are apart from their mean, the lift.
    tolerance : float
        Largest distance from a row; 0 for a curve through them.
    """
    values, cutoff, deviation, step = lift, 0.5 * len(theta), None, 1
    if tolerance:
        values, cutoff = _smoothed(theta, lift, apart, tolerance)
        step = _step(theta, cutoff)
        off = values - lift
        far = int(np.argmax(np.abs(off) + apart))
        value = math.copysign(abs(off[far]) + apart[far], off[far])
        deviation = Deviation(theta=float(theta[far]), value=value)
    curve = _curve(theta[::step], values[::step])
    level = max(tolerance, TYPED * float(np.ptp(lift)))
    errors, fall = _errors(theta[::step], values[::step])
    return Program(
        lift=curve,
        stretches=stretches_of(curve, theta, values, level, cutoff),
        cuts=curve.knots,
        errors=errors,
        fall=fall,
        deviation=deviation,
        given=np.column_stack([theta, lift]) if tolerance else None,
    )


def _smoothed(theta: Array, lift: Array, apart: Array, tolerance: float) -> tuple[Array, float]:
    """Return the smoothest lifts within a tolerance, and their cutoff, 1/rad."""
    low, high = 1.0, 2.0 * len(theta)  # one wave per turn; a quarter of a step
    smoothest, cutoff = lift, high
    while high > low * 1.01:
        middle = math.sqrt(low * high)
        values, step = smoothed_ring(theta, lift, TURN, middle), _step(theta, middle)
        if step > 1:
            values = _between(theta[::step], values[::step], theta)
        if float((np.abs(values - lift) + apart).max()) <= tolerance:
            smoothest, cutoff, high = values, middle, middle
        else:
            low = middle
    return smoothest, cutoff


def _step(theta: Array, cutoff: float) -> int:
    """Return of how many rows one is enough to tell waves at a cutoff."""
    return max(1, int(len(theta) / (_PER_WAVE * cutoff)))


def _quintics(theta: Array, lift: Array) -> tuple[Array, tuple[Array, Array]]:
    """Return the knots of the closed curve through rows, the last a turn on, and its coefficients.

    These are of the distance from the knots before, and from those behind (see `coefficients`).
    """
    x, y = np.append(theta, theta[0] + TURN), np.append(lift, lift[0])
    slopes = ring_slopes(theta, lift, TURN)
    return x, coefficients(x, y, np.concatenate([slopes, slopes[:1]]), ring=True)


def _between(theta: Array, lift: Array, places: Array, order: int = 0) -> Array:
    """Return the closed curve through rows at places, at most a turn behind the first row.

    With its derivatives up to an order it is an (order + 1, n) array, else (n,).
    """
    x, (left, _) = _quintics(theta, lift)
    index = np.searchsorted(theta, places, side="right") - 1
    distance, powers = (places - x[index])[:, None], left[index]
    derivatives = []
    for _ in range(order + 1):
        count = np.arange(powers.shape[1])
        derivatives.append((powers * distance**count).sum(axis=1))
        powers = (powers * count)[:, 1:]
    return np.array(derivatives) if order else derivatives[0]


def _curve(theta: Array, lift: Array) -> Piecewise:
    """Return the closed curve of quintics through rows, cut at the ends of the turn."""
    x, both = _quintics(theta, lift)
    curve = spline(x, *both)
    if theta[0] == 0.0:
        return curve
    left, right = (side[-1].tolist() for side in both)
    over = from_both_ends(left, right, float(x[-2]) - TURN, float(x[-1]) - TURN)
    return piecewise(np.concatenate([[0.0], theta, [TURN]]), [over, *curve.pieces])


def _errors(theta: Array, lift: Array) -> tuple[tuple[float, ...], float]:
    """Estimate errors of the curve between rows, and of its derivatives, by curves through fewer.

    Curves through every second row miss the rows between by so much, those through every fourth by
    more. By what it falls between these, which the smoothness of the motion decides, it is taken to
    fall again. The worst of all choices of rows counts, as a jump of a derivative may lie anywhere.
    Of derivatives, which rows do not tell, the curve through all of them takes their place: what
    curves through fewer miss of it is seen between the rows as well.

    Returns the errors, and by what that of the lift falls from rows twice as far apart.
    """
    two, four = (
        np.max([_missed(theta, lift, step, first) for first in range(step)], axis=0)
        for step in (2, 4)
    )
    narrowest = float(np.diff(theta, append=theta[0] + TURN).min())
    rounding = 4.0 * np.finfo(float).eps * float(np.abs(lift).max()) / narrowest ** np.arange(4)
    falls = np.clip(four / np.maximum(two, rounding), 1.0, 2.0 ** (6 - np.arange(4)))
    return tuple((_BESIDE * two / falls + rounding).tolist()), float(falls[0])


def _missed(theta: Array, lift: Array, step: int, first: int) -> Array:
    """Return by how much a curve through every `step`-th row misses lift and derivatives.

    The lift in the middle rows between, derivatives of the curve through all rows everywhere.
    """
    angles, values = np.roll(theta, -first), np.roll(lift, -first)
    angles = angles[0] + (angles - angles[0]) % TURN
    middle = slice(step // 2, None, step)
    lifts = _between(angles[::step], values[::step], angles[middle]) - values[middle]
    widths = np.diff(angles, append=angles[0] + TURN)
    places = (angles[:, None] + widths[:, None] * [0.0, 0.25, 0.5, 0.75]).ravel()
    fewer, all_rows = (_between(angles[::k], values[::k], places, 3) for k in (step, 1))
    missed = np.abs(fewer - all_rows).max(axis=1)
    missed[0] = np.abs(lifts).max()
    return missed
