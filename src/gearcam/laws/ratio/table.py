"""Measured or computed laws: a table of driver angles with ratios, driven angles or radii."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.quantities import ANGLE, NUMBER, TEXT, Row, Solve, param
from gearcam.base.rules import Breach, exactly_one
from gearcam.base.tolerances import Tolerances
from gearcam.laws.columns import (
    MOST_ROWS,
    ColumnsError,
    FromFile,
    Given,
    close_angles,
    degrees,
    demand,
    spans,
)
from gearcam.laws.entry import TYPED, LawEntry
from gearcam.laws.ratio.base import RatioLaw, make_law
from gearcam.laws.ratio.driver import demand_radii, law_of_centrode
from gearcam.laws.ratio.span import (
    NO_DWELL,
    Lobes,
    Span,
    angle_text,
    open_travel,
    own_travel,
    span_of,
)
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet, polynomial, primitive, slope
from gearcam.numeric.piecewise import Piece, integrate
from gearcam.numeric.shape_keeping import quintics

_ANGLE: Final = "phi1_deg"
_VALUES: Final = {"ratio": "ratio", "phi2": "phi2_deg", "r1": "r1"}
"""Kinds of values, with their columns in a file."""

_CALLED: Final = {"ratio": "ratio", "phi2": "driven angle", "r1": "driver's radius"}

_FEWEST: Final = 6
"""Fewest rows of a table."""


@dataclass(frozen=True, kw_only=True)
class TableLaw(FromFile):
    """Points of a law, in a CSV file or in the design itself.

    The curve through the points is C2 and monotonic wherever they are. A ratio is scaled so that it
    closes, a driven angle must close, and a radius (at any scale) gives the centre distance.
    With `driven_travel` the pair is open; driven angles themselves give it.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.TableLaw(
    ...     phi1=(0.0, 1.0, 2.0, 3.0, 4.3, 5.3, 6.2831853),
    ...     ratio=(1.2, 1.1, 0.9, 0.8, 0.9, 1.1, 1.2),
    ... )
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="table", law=law, pair=pair))
    >>> result.motion([0.0, 1.0])["ratio"].round(4)
    array([1.2114, 1.1105])
    """

    file: str | None = param(
        TEXT, default=None, doc="CSV file, up to 20000 rows: phi1_deg and ratio, phi2_deg or r1"
    )
    phi1: Row | None = param(
        ANGLE,
        default=None,
        ge=-360,
        le=720,
        min_length=_FEWEST,
        doc="driver angles of one lobe, without a file; of an open pair from 0",
    )
    ratio: Row | None = param(
        NUMBER,
        default=None,
        gt=0,
        min_length=_FEWEST,
        at_zero=NO_DWELL,
        doc="i21 at phi1, scaled so that it closes",
    )
    phi2: Row | None = param(
        ANGLE, default=None, min_length=_FEWEST, doc="driven angles at phi1; must close"
    )
    r1: Row | None = param(
        NUMBER, default=None, gt=0, min_length=_FEWEST, doc="driver's radii at phi1, at any scale"
    )
    driven_travel: float | Solve | None = open_travel("driven wheel", "phi2")

    rules = (exactly_one("file", "phi1"), exactly_one("file", *_VALUES))

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        needed = f"the columns {_ANGLE} and one of {', '.join(_VALUES.values())}"
        yield from self.row_problems(("phi1", *_VALUES), lambda: self.points, _problems, needed)

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If the file was changed and is not valid any more, spans no lobe, or gives no law.
        """
        demand(self.problems(), "law")
        kind, angles, values, _ = self.points
        rise = float(values[-1] - values[0])
        travel = self.driven_travel
        if kind == "phi2" and travel is not None:
            travel = own_travel(travel, rise, tolerances.refusal)
        span = self._span(angles, lobes, travel)
        if kind == "phi2" and span.closed and spans(values, span.advance):
            values, rise = values * (span.advance / rise), span.advance
        if kind != "phi2":
            self._demand_ratio(kind, angles, values, span)
            rise = 0.0
        first = 0.0 if abs(angles[0]) <= TYPED else float(angles[0])
        knots = np.array([first, *angles[1:-1], first + span.period])
        powers = quintics(knots, values, rise if span.closed else None)
        starts, powers = _from_zero(knots, powers) if span.closed else (knots[:-1], powers)
        knots = np.array([0.0, *starts[1:], span.period])
        if kind == "r1":
            return law_of_centrode(_pieces(starts, powers), knots, span, tolerances)
        if kind == "phi2":
            return make_law(span, knots, _pieces(starts, powers, slope, polynomial), tolerances)
        factor = span.advance / integrate(knots, _pieces(starts, powers), 0.0).last
        pieces = _pieces(starts, factor * powers)
        return make_law(span, knots, pieces, tolerances, {"ratio_factor": factor})

    @cached_property
    def points(self) -> tuple[str, Array, Array, list[int]]:
        """What the values are, driver angles, rad, values, and the lines in the file.

        The values are ``ratio``, ``phi2`` or ``r1``. Raises `ColumnsError` with the line.
        """
        if self.rows is None:
            kind = next(name for name in _VALUES if getattr(self, name) is not None)
            return kind, np.array(self.phi1), np.array(getattr(self, kind)), []
        names = [name for name, column in _VALUES.items() if self.rows.spelt(column)]
        if len(names) > 1:
            given = " and ".join(self.rows.spelt(_VALUES[name]) for name in names)
            raise ColumnsError(f"line {self.rows.lines[0]}: {given}: leave one of them")
        columns = [_ANGLE, _VALUES[names[0]]] if names else []
        points, lines = self.rows.columns(columns)
        factor = math.pi / 180.0 if names[0] == "phi2" else 1.0
        return names[0], np.radians(points[:, 0]), points[:, 1] * factor, lines

    def given(self, *, oscillating: bool) -> Given:  # noqa: ARG002  (lifts only)
        """Return the rows (see `FromFile.given`)."""
        kind, angles, values, lines = self.points
        values = np.degrees(values) if kind == "phi2" else values
        closed = self.driven_travel is None
        own = slice(-1 if closed else None)  # the last row is the first of the next lobe
        return Given(
            key=kind,
            called=_CALLED[kind],
            x=angles[own],
            y=values[own],
            lines=lines,
            place=angle_text,
            period=float(angles[-1] - angles[0]) if closed else None,
            rise=float(values[-1] - values[0]) if closed else 0.0,
            unit="deg" if kind == "phi2" else "",
        )

    def _span(self, angles: Array, lobes: Lobes, travel: float | Solve | None) -> Span:
        if travel is not None and abs(angles[0]) > TYPED:
            what, off = "the table of an open pair does not begin at phi1 = 0", degrees(angles[0])
            raise self._miss(what, _ANGLE, 0, angles[0], 0.0, f"subtract {off} from all its angles")
        if travel is None and not spans(angles, lobes.period):
            what = "the table must span one lobe of the tooth counts"
            note = "the limit is where the last row must be; an open pair needs driven_travel_deg"
            raise self._miss(what, _ANGLE, -1, angles[-1], angles[0] + lobes.period, note)
        return span_of(lobes, float(angles[-1]), travel)

    def _demand_ratio(self, kind: str, angles: Array, values: Array, span: Span) -> None:
        """Refuse values that do not repeat or are not positive."""
        if span.closed and abs(values[-1] - values[0]) > TYPED * abs(values[0]):
            what = "the last value of the table differs from the first"
            note = "the next lobe starts with the last value"
            raise self._miss(what, kind, -1, values[-1], values[0], note)
        demand_radii(kind, angles, values, f"{self._place(kind)}, ")

    def _place(self, column: str) -> str:
        return f"law.{column}" if self.rows is None else "law.file"

    def _miss(
        self, what: str, column: str, row: int, value: float, limit: float, nearest: str = ""
    ) -> InfeasibleError:
        """Return the refusal of a first or last `value` that must be `limit`, rad or 1."""
        unit, place = "deg" if column == _ANGLE else "", self._place(column)
        if unit:
            value, limit = math.degrees(value), math.degrees(limit)
        if self.rows is not None:
            where = f"{place}, {'last' if row else 'first'} {column}"
            return beyond_limit(what, where, value, limit, nearest, unit=unit)
        where = f"{place}[{row % len(self.points[1])}]"
        return beyond_limit(what, where, value, limit, nearest, near=limit, unit=unit)


def _problems(_: str, angles: Array, __: Array) -> Iterator[Breach]:
    if not _FEWEST <= len(angles) <= MOST_ROWS:
        yield "phi1", None, f"has {len(angles)} rows", f"{_FEWEST} to {MOST_ROWS} rows"
    for row, state, rule in islice(close_angles(angles), 1):
        yield "phi1", row, state, rule


def _from_zero(knots: Array, powers: Array) -> tuple[Array, Array]:
    """Return the pieces of a period from 0 on: where their polynomials begin, and their powers.

    A piece across 0 is there twice: its polynomial begins before 0, and before the period.

    Parameters
    ----------
    knots : (n + 1,) array, rad
        Over a period, from any angle.
    powers : (n, k) array
        Of the distances from the knots before.
    """
    period = float(knots[-1] - knots[0])
    starts = knots[:-1] % period
    starts[starts > period - TYPED] = 0.0
    first = int(np.argmin(starts))
    starts, powers = np.roll(starts, -first), np.roll(powers, -first, axis=0)
    if starts[0] <= TYPED:
        return starts, powers
    return np.array([starts[-1] - period, *starts]), np.concatenate([powers[-1:], powers])


def _pieces(
    starts: Array,
    powers: Array,
    function: Callable[..., Jet] = polynomial,
    integral: Callable[..., Jet] = primitive,
) -> list[Piece]:
    """Return pieces of polynomials from rows of `powers` of the distance from their `starts`."""
    rows = np.column_stack([starts, powers]).tolist()
    return [Piece(function, integral, tuple(row)) for row in rows]


ENTRIES: Final = (
    LawEntry(
        name="table",
        example=TableLaw(phi1=tuple(math.pi * k / 4 for k in range(9)), ratio=(3.0,) * 9),
        doc="points of the ratio, the driven angle or the driver's radius, as lists or a CSV file",
        continuity="C2 in the given values; the ratio is C1 if phi2 is given",
        source="quintics that keep the shape of the points",
    ),
)
