"""Measured or computed laws: a table of driver angles with ratios, driven angles or radii."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError, Way, beyond_limit
from gearcam.base.quantities import ANGLE, NUMBER, TEXT, Row, param
from gearcam.base.rules import Breach, exactly_one
from gearcam.base.tolerances import Tolerances
from gearcam.laws.columns import MOST_ROWS, ColumnsError, CsvRows, FromFile, close_angles
from gearcam.laws.entry import TYPED, LawEntry
from gearcam.laws.ratio.base import LAWS, RatioLaw, make_law
from gearcam.laws.ratio.driver import demand_radii, law_of_centrode
from gearcam.laws.ratio.span import Lobes, Span, Travel, demand_equal, open_travel
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet, polynomial, primitive, slope
from gearcam.numeric.piecewise import Piece, integrate
from gearcam.numeric.shape_keeping import quintics

_ANGLE: Final = "phi1_deg"
_VALUES: Final = {"ratio": "ratio", "phi2": "phi2_deg", "r1": "r1"}
"""Kinds of values, with their columns in a file."""

_FEWEST: Final = 6
"""Fewest rows of a table."""


@dataclass(frozen=True, kw_only=True)
class TableLaw(FromFile):
    """Points of a law, in a CSV file or in the design itself.

    The curve through the points is C2 and monotonic wherever they are. A ratio is scaled so that it
    closes, a driven angle must close, and a radius (at any scale) gives the centre distance.
    With `driven_travel` the pair is open.
    """

    file: str | None = param(
        TEXT, default=None, doc="CSV file, up to 20000 rows: phi1_deg and ratio, phi2_deg or r1"
    )
    phi1: Row | None = param(
        ANGLE, default=None, ge=0, le=360, min_length=_FEWEST, doc="driver angles, without a file"
    )
    ratio: Row | None = param(
        NUMBER, default=None, gt=0, min_length=_FEWEST, doc="i21 at phi1, scaled so that it closes"
    )
    phi2: Row | None = param(
        ANGLE, default=None, min_length=_FEWEST, doc="driven angles at phi1; must close"
    )
    r1: Row | None = param(
        NUMBER, default=None, gt=0, min_length=_FEWEST, doc="driver's radii at phi1, at any scale"
    )
    driven_travel: float | None = open_travel("driven wheel")

    rules = (exactly_one("file", "phi1"), exactly_one("file", *_VALUES))

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        inline = [values for name in _VALUES if (values := getattr(self, name)) is not None]
        if self.file is not None:
            try:
                _ = self.points
            except ColumnsError as error:
                columns = (
                    f"a CSV file with the columns {_ANGLE} and one of {', '.join(_VALUES.values())}"
                )
                yield "file", None, str(error), columns
        elif self.phi1 is not None and len(inline) == 1:
            if len(inline[0]) != len(self.phi1):
                name = next(name for name in _VALUES if getattr(self, name) is not None)
                message = f"{len(inline[0])} values for {len(self.phi1)} angles"
                yield name, None, message, "one value for each angle"
                return
            for row, state, rule in islice(close_angles(np.array(self.phi1)), 1):
                yield "phi1", row, state, rule

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If the file was changed and is not valid any more, spans no lobe, or gives no law.
        """
        try:
            kind, angles, values = self.points
        except ColumnsError as error:
            raise InfeasibleError(str(error), where="law.file") from error
        span = self._span(angles, lobes)
        knots = np.array([0.0, *angles[1:-1], span.period])
        rise = float(values[-1] - values[0])
        if kind != "phi2":
            self._demand_ratio(kind, angles, values, span)
            rise = 0.0
        powers = quintics(knots, values, rise if span.closed else None)
        if kind == "r1":
            return law_of_centrode(_pieces(knots, powers), knots, span, tolerances)
        if kind == "phi2":
            return make_law(span, knots, _pieces(knots, powers, slope, polynomial), tolerances)
        factor = span.advance / integrate(knots, _pieces(knots, powers), 0.0).last
        pieces = _pieces(knots, factor * powers)
        return make_law(span, knots, pieces, tolerances, {"ratio_factor": factor})

    @cached_property
    def points(self) -> tuple[str, Array, Array]:
        """The kind of values (``ratio``, ``phi2`` or ``r1``), driver angles, rad, and values.

        Raises `ColumnsError` with the line of the file.
        """
        if self.rows is not None:
            return _points(self.rows)
        kind = next(name for name in _VALUES if getattr(self, name) is not None)
        return kind, np.array(self.phi1), np.array(getattr(self, kind))

    def _span(self, angles: Array, lobes: Lobes) -> Span:
        if abs(angles[0]) > TYPED:
            raise self._miss("the table does not begin at phi1 = 0", _ANGLE, 0, angles[0], 0.0)
        if self.driven_travel is not None:
            demand_equal(lobes)
            return Travel(float(angles[-1]), self.driven_travel, lobes.mate)
        if abs(angles[-1] - lobes.period) > TYPED:
            raise self._miss(
                "the table must span one lobe of the tooth counts",
                _ANGLE,
                -1,
                angles[-1],
                lobes.period,
                "the limit is where the last row must be; an open pair needs driven_travel_deg",
            )
        return lobes

    def _demand_ratio(self, kind: str, angles: Array, values: Array, span: Span) -> None:
        """Refuse values that do not repeat or are not positive."""
        if span.closed and abs(values[-1] - values[0]) > TYPED * abs(values[0]):
            raise self._miss(
                "the last value of the table differs from the first",
                kind,
                -1,
                values[-1],
                values[0],
                "the next lobe starts with the last value",
            )
        demand_radii(kind, angles, values, f"{self._place(kind)}, ")

    def _place(self, column: str) -> str:
        return f"law.{column}" if self.rows is None else "law.file"

    def _miss(
        self, what: str, column: str, row: int, value: float, limit: float, nearest: str = ""
    ) -> InfeasibleError:
        """Return the refusal of a first or last `value` that must be `limit`, rad or 1."""
        unit, place = "deg" if column == _ANGLE else "", self._place(column)
        value, limit = ((math.degrees if unit else float)(one) for one in (value, limit))
        if self.rows is not None:
            where, ways = f"{place}, {'last' if row else 'first'} {column}", ()
        else:
            where = f"{place}[{row % len(self.points[1])}]"
            ways = (Way(near={where: limit}),)
        return beyond_limit(what, where, value, limit, nearest, ways=ways, unit=unit)


def _points(rows: CsvRows) -> tuple[str, Array, Array]:
    kinds = [kind for kind, column in _VALUES.items() if column in rows.cells[0]]
    points, lines = rows.columns([_ANGLE, _VALUES[kinds[0]]] if len(kinds) == 1 else [])
    if len(points) < _FEWEST:
        raise ColumnsError(f"has {len(points)} rows; {_FEWEST} to {MOST_ROWS} are read")
    angles = np.radians(points[:, 0])
    for row, state, rule in islice(close_angles(angles), 1):
        raise ColumnsError(f"line {lines[row]}: {state}; {rule}")
    factor = math.pi / 180.0 if kinds[0] == "phi2" else 1.0
    return kinds[0], angles, points[:, 1] * factor


def _pieces(
    knots: Array,
    powers: Array,
    function: Callable[..., Jet] = polynomial,
    integral: Callable[..., Jet] = primitive,
) -> list[Piece]:
    """Return pieces of polynomials from rows of `powers` of the distance from the knot before."""
    rows = np.column_stack([knots[:-1], powers]).tolist()
    return [Piece(function, integral, tuple(row)) for row in rows]


LAWS.register(
    LawEntry(
        name="table",
        example=TableLaw(phi1=tuple(math.pi * k / 4 for k in range(9)), ratio=(3.0,) * 9),
        doc="points of the ratio, the driven angle or the driver's radius, as lists or a CSV file",
        continuity="C2 in the given values; the ratio is C1 if phi2 is given",
        source="quintics that keep the shape of the points",
    )
)
