"""The table ``[[load]]``."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from gearcam.base.errors import beyond_limit
from gearcam.base.quantities import FORCE, LENGTH, LONGEST, TEXT, TORQUE, Row, param
from gearcam.base.rules import Breach, exactly_one, needs
from gearcam.designs.faults import Fault
from gearcam.kinds.mechanism.keys import Sort, angle_param, later, named
from gearcam.kinds.mechanism.parts.acted import Acted, LoadedLinkage
from gearcam.kinds.mechanism.parts.action import MOST, MOVING, MachineAction
from gearcam.linkages.coordinates import WorkCoordinate
from gearcam.linkages.dwells import WHOLE, ShortRangeError, last_travels
from gearcam.linkages.efforts import ActiveRanges, AppliedForce, Effort, ForceLaw, force_on
from gearcam.mechanics.load import WrittenLoad
from gearcam.numeric.arrays import Array, away
from gearcam.numeric.jets import Jet

if TYPE_CHECKING:
    from gearcam.linkages.coordinates import Acting
    from gearcam.mechanics.gravity import GravitySpec

INNER, OUTER = "inner", "outer"
"""Dead centres, where a slide's place is least, and where it is largest."""

_TURN: Final = 2.0 * math.pi

_SLACK: Final = 1e-9
"""How much a table may be short of the range, rad."""

_KILO: Final = 1e3
"""N mm of a N m."""


@dataclass(frozen=True, kw_only=True)
class MachineLoad(MachineAction, WrittenLoad):
    """A load on a mechanism: a force on a point or a slide, or a torque on a member.

    It may be constant, a formula in the master's angle q, rad, in the place x of the slide or
    member, mm or rad, or in its velocity v, mm/s or rad/s, or rows that are joined by straight
    lines.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MachineLoad(on="slide", force=(-35435.0,), travel=4.0, before="outer")
    MachineLoad(on='slide', force=(-35435,), travel=4, before='outer')
    """

    moved = "on"

    _variables: ClassVar[Mapping[str, str]] = {"q": "q", "x": "the place x", "v": "the velocity v"}
    _from: ClassVar[float] = math.inf

    on: str = named(
        needs=MOVING,
        example="slide",
        doc="what is loaded: a joint, a point, a slide, a member, or a shaft such as pair.wheel2",
    )
    force: Row | None = param(
        FORCE,
        default=None,
        ge=-MOST,
        le=MOST,
        min_length=1,
        alone=True,
        example=-500,
        doc="force: of a slide along its guide; of a point in direction_deg, or two values, x and "
        "y in the machine's frame",
    )
    torque: float | None = param(
        TORQUE, default=None, ge=-MOST, le=MOST, example=-2, doc="torque on a member or a shaft"
    )
    formula: str | None = param(
        TEXT,
        default=None,
        example="-200 - 3*x",
        doc="force, N, or torque, N m, as a formula in the master's angle q, rad, in the place x, "
        "mm or rad, or in the velocity v, mm/s or rad/s",
    )
    table: Row | None = param(
        default=None,
        ge=-MOST,
        le=MOST,
        min_length=2,
        example=[0, -250, 0],
        doc="forces, N, or torques, N m, at the places of `at`, with straight lines between",
    )
    place: Row | None = angle_param(
        default=None,
        min_length=2,
        word="at",
        example=[0, 180, 360],
        doc="the master's angles of the table; over 360 deg they repeat with each turn",
    )
    way: Row | None = param(
        LENGTH,
        default=None,
        ge=-LONGEST,
        le=LONGEST,
        min_length=2,
        word="at",
        example=[600, 750, 900],
        doc="places of a slide instead; beyond them the table keeps its end values",
    )
    direction: float | None = angle_param(
        default=None, doc="direction of the force on a point, in the machine", example=-90
    )
    start: float | None = angle_param(
        default=None,
        doc="the master's angle at which the load begins, in each turn",
        word="from",
        example=150,
    )
    end: float | None = angle_param(default=None, doc="where it ends", word="to", example=200)
    travel: float | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LONGEST,
        example=4,
        doc="the load acts over this last bit of a slide's travel, each time that it arrives",
    )
    before: str | None = param(
        TEXT,
        default=None,
        choices=(INNER, OUTER),
        example=OUTER,
        doc="before which dead centre: that of its least, or of its largest place",
    )
    against: bool = param(default=False, doc="whether the load always opposes the motion")

    rules = (
        exactly_one("force", "torque", "formula", "table"),
        needs("table", "place", "way", one=True),
        needs("place", "table"),
        needs("way", "table"),
        needs("start", "end"),
        needs("end", "start"),
        needs("travel", "before"),
        needs("before", "travel"),
    )

    def problems(self) -> Iterator[Breach]:
        """Yield contradictions: field, index, message, what is allowed."""
        yield from super().problems()
        if self.table is not None and self.way is not None:
            if self.place is not None:
                yield "way", None, "is given beside at_deg", "at_deg or at_mm"
            yield from self._row_problems("way", self.table, self.way)
        if self.travel is not None and self.start is not None:
            yield "travel", None, "is given beside from_deg", "from_deg and to_deg, or travel_mm"
        if self.start is not None and self.end is not None and self.start >= self.end:
            yield "end", None, "is not above from_deg", later(self.start, self.end)
        if self.force is not None:
            yield from self._force_problems(self.force)

    def _force_problems(self, force: Row) -> Iterator[Breach]:
        if len(force) > 2:
            yield "force", None, f"has {len(force)} values", "one value, or two: x and y"
        if len(force) == 2 and self.direction is not None:
            yield "direction", None, "is given beside a force of two values", "one of both"
        if len(force) == 2 and self.against:
            yield "against", None, "is given with a force of two values", "a force of one value"

    @property
    def key(self) -> str:
        """Key of its size in files."""
        for name in ("force", "torque", "formula"):
            if getattr(self, name) is not None:
                return {"force": "force_n", "torque": "torque_nm"}.get(name, name)
        return "table"

    @property
    def has_direction(self) -> bool:
        """Whether it says where it points: two values, or an angle."""
        return self.direction is not None or (self.force is not None and len(self.force) == 2)

    def unfit(self, acted: Acted) -> Iterator[Fault]:
        """Yield keys that do not suit what is loaded."""
        sort = acted.sorts[self.on]
        driven = sort == Sort.WAY and self.on not in acted.ways
        if driven and self.has_direction:
            what = f"acts on {self.on}, which moves along its own way only"
            allowed = "force_n of one value, or a joint or point"
            yield Fault(("on",), what, self.on, allowed)
        if acted.turns(self.on):
            keys = (("force", "force_n"), ("direction", "direction_deg"), ("way", "at_mm"))
            for name, key in keys:
                if getattr(self, name) is not None:
                    what = f"acts on {self.on}, which is a {sort}"
                    yield Fault((key,), what, allowed="torque_nm, or a joint, point or slide")
        elif self.torque is not None:
            what = f"acts on {self.on}, which is a {sort}"
            yield Fault(("torque_nm",), what, allowed="force_n, or a member or shaft")
        elif sort == Sort.JOINT and not self.has_direction:
            what = f"has no direction, and {self.on} slides along no guide"
            yield Fault((self.key,), what, allowed="direction_deg, or force_n = [x, y]")
        if sort != Sort.WAY and self.travel is not None:
            what = f"is of {self.on}, which slides along no guide"
            yield Fault(("travel_mm",), what, self.travel, "from_deg and to_deg")

    def needs_speed(self, gravity: GravitySpec) -> str:
        """Return that it is a formula in the velocity, if it is."""
        moving = self.formula is not None and self.read(self.formula)[0] == "v"
        return "a load depends on the velocity" if moving else ""

    def efforts(self, on: LoadedLinkage, number: int) -> Iterator[Effort]:
        """Yield its force or torque (see `MachineAction`)."""
        active = self._active(on, f"load[{number}]")
        if self.force is not None and len(self.force) == 2:
            yield force_on(on.acted.joint(self.on), complex(*self.force), active=active)
            return
        coordinate = on.acted.coordinate(self.on, self.direction)
        law = self._law(on, coordinate, f"load[{number}]")
        if self.against:
            reversals = on.measures(coordinate).extremes[0][0]
            on.knots += away(reversals, on.linkage.knots, _SLACK).tolist()
            law = _opposing(law)
        yield AppliedForce(coordinate, law, active=active)

    def _active(self, on: LoadedLinkage, where: str) -> ActiveRanges | None:
        low, high = on.linkage.span
        if self.travel is not None:
            return ActiveRanges(self._travels(on, self.travel, where), high - low)
        if self.start is None or self.end is None:
            return None
        period = _TURN if on.linkage.closed else math.inf
        if self.end - self.start > period + _SLACK:
            what = "the load acts for more than a turn of the master, with which it repeats"
            note = "without from_deg and to_deg it acts everywhere, by a table in some turns only"
            value, most = math.degrees(self.end), math.degrees(self.start + period)
            raise beyond_limit(what, f"{where}.to_deg", value, most, note, near=most)
        return ActiveRanges([(self.start, self.end)], _TURN if on.linkage.closed else None)

    def _travels(
        self, on: LoadedLinkage, travel: float, where: str
    ) -> tuple[tuple[float, float], ...]:
        measures, where = on.measures(on.acted.coordinate(self.on)), f"{where}.travel_mm"
        if travel > measures.stroke * WHOLE:
            what = f"{self.on} has not so much travel"
            raise beyond_limit(what, where, travel, measures.stroke, unit="mm")
        try:
            return last_travels(measures, travel, outer=self.before == OUTER)
        except ShortRangeError as error:
            what = f"{self.on} has not so much travel before its {self.before} dead centre"
            note = "from_deg and to_deg, or the other dead centre"
            raise beyond_limit(what, where, travel, error.travel, note, unit="mm") from None

    def _law(self, on: LoadedLinkage, coordinate: WorkCoordinate, where: str) -> ForceLaw:
        """Return its size, N or N mm."""
        per = _KILO if on.acted.turns(self.on) else 1.0
        if self.formula is not None:
            variable, made = self.read(self.formula)
            name = {"q": "angle", "x": "place", "v": "velocity"}[variable]
            return lambda acting: made.evaluate(getattr(acting, name)) * per
        if self.table is not None:
            return self._rows(on, self.table, coordinate, where, per)
        size = self.torque if self.force is None else self.force[0]
        return lambda _: size or 0.0

    def _rows(
        self, on: LoadedLinkage, table: Row, coordinate: WorkCoordinate, where: str, per: float
    ) -> ForceLaw:
        if self.place is None:
            way = self.way or (0.0,)
            measures = on.measures(coordinate)
            on.knots += [q for one in way for q in measures.places_of(one).tolist()]
            return lambda acting: _between(acting.place, way, table) * per
        turns = self._turns(self.place, on.linkage.span, on.linkage.closed, where)
        places = np.add.outer(_TURN * np.array(turns), self.place)
        places[:-1, -1] = places[1:, 0]  # but for rounding
        at, rows = places.ravel(), np.tile(table, len(turns))
        on.knots += at.tolist()
        return lambda acting: _between(acting.angle, at, rows) * per

    def _turns(self, place: Row, span: tuple[float, float], closed: bool, where: str) -> range:
        """Return the turns of the master over which a table goes; raise if it ends too early."""
        (low, high), first, last = span, place[0], place[-1]
        if closed and math.isclose(last - first, _TURN, rel_tol=1e-12):
            return range(math.floor((low - last) / _TURN), math.ceil((high - first) / _TURN) + 1)
        for index, short, limit in ((0, first - low, low), (-1, high - last, high)):
            if short > _SLACK:
                where = f"{where}.at_deg[{index % len(place)}]"
                what = "the table does not reach over the master's range"
                value, most = math.degrees(place[index]), math.degrees(limit)
                raise beyond_limit(what, where, value, most, unit="deg")
        return range(1)


def _between(x: Jet, places: Row | Array, values: Row | Array) -> Jet:
    """Return the values on straight lines between places; beyond them those at their ends."""
    at, rows = np.asarray(places, dtype=float), np.asarray(values, dtype=float)
    width, rise = np.diff(at), np.diff(rows)
    slopes = np.divide(rise, width, out=np.zeros_like(rise), where=width > 0.0)
    cell = np.searchsorted(at, np.asarray(x.c[0]), side="right")
    slopes = np.concatenate([[0.0], slopes, [0.0]])[cell]
    from_row = np.clip(cell - 1, 0, len(at) - 1)
    return (x - at[from_row]) * slopes + rows[from_row]


def _opposing(law: ForceLaw) -> ForceLaw:
    """Return the law of a load of the same size that opposes the motion."""

    def opposed(acting: Acting) -> Jet:
        size = acting.angle * 0.0 + law(acting)
        return size * -(acting.sense * np.sign(size.c[0]))

    return opposed
