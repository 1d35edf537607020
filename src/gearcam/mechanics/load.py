"""The table ``[[load]]``: what a mechanism works against."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import formatted
from gearcam.base.quantities import ANGLE, FORCE, LENGTH, LONGEST, TEXT, TORQUE, Row, param
from gearcam.base.rules import Breach, exactly_one, needs
from gearcam.numeric.arrays import Array

if TYPE_CHECKING:
    from gearcam.laws.formula_syntax import Expression

FORCES: Final = "forces"
"""The checks of a study of forces of a cam."""

OF_LIFT: Final = "s"
"""Variable of formulas over the lift, mm or rad."""

MOST: Final = 1e9
"""Largest force or torque, N or N m."""


class WrittenLoad:
    """How the size of a load is written: a formula in one of some variables, or rows of a table."""

    _variables: ClassVar[Mapping[str, str]]
    """What a formula may be of, by its name: in words."""
    _from: ClassVar[float] = 0.0
    """Where a table must begin, rad or mm, at the latest."""
    _whole: ClassVar[float] = 0.0
    """Where it must end, at the earliest."""
    _unit: ClassVar[tuple[float, str]] = (math.degrees(1.0), "deg")

    formula: str | None
    table: Row | None
    place: Row | None

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        if self.formula is not None:
            yield from self._formula_problems(self.formula)
        if self.table is not None and self.place is not None:
            yield from self._row_problems("place", self.table, self.place)

    def _formula_problems(self, text: str) -> Iterator[Breach]:
        from gearcam.laws.formula_syntax import FormulaError

        try:
            self.read(text)
        except FormulaError as error:
            yield error.breach("formula")

    def _row_problems(self, name: str, table: Row, place: Row) -> Iterator[Breach]:
        if len(table) != len(place):
            what = f"{len(place)} values, but table has {len(table)}"
            yield name, None, what, "one for each value of the table"
            return
        back = np.flatnonzero(np.diff(place) < 0.0)
        if back.size:
            yield name, int(back[0]) + 1, "is below the value before it", "rising values"
        elif place[0] > self._from:
            yield name, 0, "the table begins inside the turn", "0 as the first value"
        elif self._whole and place[-1] < self._whole * (1.0 - 1e-12):
            scale, unit = self._unit
            last = f"{formatted(scale * self._whole)} {unit}"
            yield name, len(place) - 1, "the table ends inside the turn", f"{last} as the last"

    def read(self, text: str) -> tuple[str, Expression]:
        """Return the variable of a formula, and the formula.

        Parameters
        ----------
        text : str
            In one of the variables.

        Raises
        ------
        FormulaError
            If it cannot be read.
        """
        from gearcam.laws.formula_syntax import FormulaError, parse

        found = {*re.findall(r"[A-Za-z]\w*", text)}
        own = [name for name in self._variables if name in found]
        if len(own) > 1:
            what = f"{' and '.join(own[::-1])} cannot be mixed"
            allowed = f"a formula of {', or one of '.join(self._variables.values())}"
            raise FormulaError(what, allowed=allowed)
        variable = own[0] if own else next(iter(self._variables))
        try:
            return variable, parse(text, variable)
        except FormulaError as error:
            words = " or ".join(self._variables.values())
            allowed = re.sub(rf"^{variable}\b", words, error.allowed)
            raise type(error)(
                error.what, column=error.column, allowed=allowed, hint=error.hint
            ) from None


class PlacedLoad(WrittenLoad):
    """A load that acts at all positions of a driver, or from one to another of them."""

    start: float | None
    end: float | None

    @property
    def knots(self) -> tuple[float, ...]:
        """Where it jumps or bends, rad or mm: the first numbers of what comes after."""
        ends = () if self.start is None or self.end is None else (self.start, self.end)
        # the end belongs to the load
        return (*(self.place or ()), *ends[:1], *np.nextafter(ends[1:], np.inf).tolist())

    def _sizes(self, x: Array, other: Array, given: float | None, per: float) -> Array:
        """Return its values, N or N mm.

        Parameters
        ----------
        x, other : (n,) arrays
            Positions of the driver, and what formulas in the other variable are of.
        given : float or None, N or N mm
            The size if it is constant.
        per : float
            Unit of formula and table in those inside: 1 of N, 1000 of N m.
        """
        if self.formula is not None:
            value = per * self._formula_at(self.formula, x, other)
        elif self.table is not None:
            value = per * np.interp(x, np.asarray(self.place), np.asarray(self.table))
        else:
            value = np.full(x.shape, given)
        return self._within(x, value)

    def _within(self, x: Array, value: Array) -> Array:
        """Return values, 0 where the load does not act."""
        if self.start is None or self.end is None:
            return value
        inside = (self.start <= x) & (x <= self.end)
        around = (self.start <= x) | (x <= self.end)  # across the end of the turn
        return np.where(inside if self.start <= self.end else around, value, 0.0)

    def _formula_at(self, text: str, x: Array, other: Array) -> Array:
        from gearcam.numeric.jets import Jet

        variable, made = self.read(text)
        first = next(iter(self._variables))
        found = made.evaluate(Jet([x if variable == first else other]))
        return np.asarray(found.c[0] if isinstance(found, Jet) else found) + np.zeros_like(x)


@dataclass(frozen=True, kw_only=True)
class LoadSpec(ShortRepr, PlacedLoad):
    """A load on the follower: a force, of an oscillating follower a torque.

    It is positive where it presses the follower onto the cam, or, with `against`, always opposes
    the motion. It may be constant, a formula in the cam angle theta, rad, or in the lift s, mm or
    rad, or rows that are joined by straight lines.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.LoadSpec(force=120.0, start=1.0, end=2.0).at([0.5, 1.5], [0.0, 0.0], [1.0, 1.0])
    array([  0., 120.])
    """

    _variables: ClassVar[Mapping[str, str]] = {"theta": "theta", OF_LIFT: f"the lift {OF_LIFT}"}
    _whole: ClassVar[float] = 2.0 * math.pi

    on: str = param(TEXT, default="follower", choices=("follower",), doc="member that is loaded")
    force: float | None = param(
        FORCE, default=None, ge=-MOST, le=MOST, example=100, doc="constant force"
    )
    torque: float | None = param(
        TORQUE, default=None, ge=-MOST, le=MOST, example=2, doc="constant torque"
    )
    formula: str | None = param(
        TEXT,
        default=None,
        example="50 + 20*cos(theta)",
        doc="force, N, or torque, N m, as a formula in the cam angle theta, rad (of a translating "
        "cam the travel u, mm), or in the lift s, mm or rad",
    )
    table: Row | None = param(
        default=None,
        ge=-MOST,
        le=MOST,
        min_length=2,
        example=[100, 250, 100],
        doc="forces, N, or torques, N m, at the places of `at`, with straight lines between",
    )
    place: Row | None = param(
        ANGLE,
        default=None,
        ge=0,
        le=360,
        min_length=2,
        word="at",
        example=[0, 180, 360],
        doc="cam angles of the table, from 0 to 360",
    )
    start: float | None = param(
        ANGLE, default=None, ge=0, le=360, word="from", example=90, doc="where the load begins"
    )
    end: float | None = param(
        ANGLE, default=None, ge=0, le=360, word="to", example=180, doc="where the load ends"
    )
    against: bool = param(default=False, doc="whether the load always opposes the motion")

    rules = (
        exactly_one("force", "torque", "formula", "table"),
        needs("table", "place"),
        needs("place", "table"),
        needs("start", "end"),
        needs("end", "start"),
    )

    def allowed_on(self, *, oscillating: bool) -> Iterator[Breach]:
        """Yield a force on a follower that swings, or a torque on one that does not."""
        if oscillating and self.force is not None:
            yield "force", None, "acts on a follower that swings", "torque_nm about its pivot"
        if not oscillating and self.torque is not None:
            yield "torque", None, "acts on a follower that does not swing", "force_n along its axis"

    def at(self, x: Any, s: Any, ds: Any, *, per: float = 1.0) -> Array:
        """Return the load against a rise.

        Parameters
        ----------
        x : (n,) array, rad or mm
            Cam angles in the turn, or travels.
        s, ds : (n,) array
            Lifts and their derivatives.
        per : float
            Unit of formula and table in those inside: 1 of N, 1000 of N m.

        Returns
        -------
        (n,) array, N or N mm
        """
        given = self.torque if self.force is None else self.force
        value = self._sizes(np.asarray(x, dtype=float), np.asarray(s, dtype=float), given, per)
        return np.abs(value) * np.sign(ds) if self.against else value


@dataclass(frozen=True, kw_only=True)
class SlideLoadSpec(LoadSpec):
    """A load on the follower of a translating cam, over its travel.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.SlideLoadSpec(formula="10 + u").at([0.0, 5.0], [0.0, 0.0], [1.0, 1.0])
    array([10., 15.])
    """

    _variables: ClassVar[Mapping[str, str]] = {"u": "u", OF_LIFT: f"the lift {OF_LIFT}"}
    _whole: ClassVar[float] = 0.0

    place: Row | None = param(
        LENGTH,
        default=None,
        ge=0,
        le=LONGEST,
        min_length=2,
        word="at",
        example=[0, 60],
        doc="travels of the table, from 0",
    )
    start: float | None = param(
        LENGTH, default=None, ge=0, le=LONGEST, word="from", example=20, doc="where the load begins"
    )
    end: float | None = param(
        LENGTH, default=None, ge=0, le=LONGEST, word="to", example=40, doc="where the load ends"
    )
