"""The tables of what is asked of outputs: the last bits of their travel, dwells, and paths."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Final, NamedTuple

from gearcam.base.errors import ABOVE, DesignError, InfeasibleError, Problem, beyond_limit
from gearcam.base.findings import Remark, check
from gearcam.base.numerals import formatted
from gearcam.base.quantities import TEXT, param, positive_length
from gearcam.base.rules import Breach, exactly_one
from gearcam.kinds.mechanism.keys import (
    WithNames,
    angle_param,
    later,
    named,
    point_param,
    sweep_param,
)

if TYPE_CHECKING:
    from gearcam.linkages.dwells import DriverRange
    from gearcam.linkages.measures import TrackMeasures
    from gearcam.linkages.path_fits import CircleFit, LineFit
    from gearcam.linkages.paths import PointPath

DEG: Final = math.degrees(1.0)
"""Degrees of a radian."""

RATES: Final = ("velocity", "acceleration", "jerk")
"""Names of the derivatives, those in tables."""

TABLES: Final = "tables of mechanisms"
"""The group of the checks of what the tables of a mechanism ask for, and of its chains."""

_ROUNDED: Final = 1e-9
"""Stroke of what stands still but for rounding, mm or rad."""

_LEAST_TRAVEL: Final = 2e-3
"""Travel up to which none is offered that is smaller, mm or deg."""


class Output(NamedTuple):
    """A quantity whose motion is asked for.

    Attributes
    ----------
    name : str
        As in ``output.outputs``.
    stem : str
        Beginning of its columns.
    quantity : str
        Its name in the linkage (see `Linkage.track`).
    angle : bool
        Whether it is an angle; else a length.
    """

    name: str
    stem: str
    quantity: str
    angle: bool

    @property
    def unit(self) -> tuple[float, str]:
        """Factor to its unit in output, and that unit."""
        return (DEG, "deg") if self.angle else (1.0, "mm")

    @property
    def rate_unit(self) -> str:
        """Unit of its velocity but for the time."""
        return "rad" if self.angle else "mm"

    def rate_keys(self, order: int) -> tuple[str, str]:
        """Return the units of a derivative as in keys: by the master's angle, and by time."""
        power = order if order > 1 else ""
        return f"{self.rate_unit}_per_rad{power}", f"{self.rate_unit}_s{power}"


def coordinates(joint: str) -> tuple[Output, ...]:
    """Return the two coordinates of a joint."""
    return tuple(Output(joint, f"{joint}_{part}", f"{joint}.{part}", False) for part in "xy")


@dataclass(frozen=True, kw_only=True)
class StretchSpec(WithNames):
    """A stretch of a point's path that is to be straight or round.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.StretchSpec(on="P", start=1.0, end=2.0, shape="line")
    StretchSpec(on='P', start=1, end=2, shape='line')
    """

    on: str = named(doc="the point", example="P")
    start: float = angle_param(doc="the master's angle where it begins", word="from", example=100)
    end: float = angle_param(
        doc="the master's angle where it ends, above 360 over the end of a turn",
        word="to",
        example=260,
    )
    shape: str = param(
        TEXT,
        choices=("line", "circle"),
        example="line",
        doc="what is fitted to it, by the least deviation",
    )

    center: tuple[float, float] | None = point_param(
        word="",
        default=None,
        example=[300, 827],
        doc="a point whose distances from the stretch are wanted too",
    )

    def problems(self) -> Iterator[Breach]:
        """Yield an end that is not above the start."""
        if self.end <= self.start:
            yield "end", None, "is not above from_deg", later(self.start, self.end)

    def fit(self, path: PointPath, where: str) -> LineFit | CircleFit:
        """Return the line or circle that is nearest to it.

        Parameters
        ----------
        path : PointPath
            Of its point.
        where : str
            Place of its table.

        Raises
        ------
        InfeasibleError
            If it is straight and a circle is asked for.
        """
        from gearcam.linkages.nearest_circle import StraightError
        from gearcam.linkages.path_fits import best_circle, best_line

        fit = best_line if self.shape == "line" else best_circle
        try:
            return fit(path, self.start, self.end)
        except StraightError as error:
            near = 'shape = "line"'
            raise InfeasibleError(str(error), where=f"{where}.shape", nearest=near) from None

    def demand_within(self, span: tuple[float, float], source: str, where: str) -> None:
        """Refuse a stretch that a range of the master does not hold.

        Parameters
        ----------
        span : (float, float), rad
            The range.
        source, where : str
            The design file, and the place of its table.

        Raises
        ------
        DesignError
            If one of its ends is beyond the range.
        """
        low, high = span
        for key, value in (("from_deg", self.start), ("to_deg", self.end)):
            if not low <= value <= high:
                what = f"{formatted(DEG * value, 8)} is beyond the master's range"
                allowed = f"{formatted(DEG * low, 8)} to {formatted(DEG * high, 8)}"
                place = f"{where}.{key}"
                raise DesignError([Problem(what, source, None, place, DEG * value, allowed)])


class Amount(WithNames):
    """What is asked of one output, by an amount of it: a length, or an angle.

    Parameters
    ----------
    on : str
        The output.
    """

    word: ClassVar[str]
    """The word of its keys with the amount, and the field of a length."""

    on: str

    def amount(self, *, angle: bool) -> float:
        """Return the amount of an output that is an angle, rad, or a length, mm."""
        return getattr(self, f"{self.word}_angle" if angle else self.word)

    @property
    def told(self) -> str:
        """The amount as text."""
        length = getattr(self, self.word)
        if length is not None:
            return f"{formatted(length)} mm"
        return f"{formatted(DEG * (self.amount(angle=True) or 0.0))} deg"


@dataclass(frozen=True, kw_only=True)
class IntervalSpec(Amount):
    """The last bit of an output's travel before a dead centre: when it begins, and how fast.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.IntervalSpec(on="slide", travel=4.0)
    IntervalSpec(on='slide', travel=4)
    """

    word = "travel"

    on: str = named(doc="the output", example="slide")
    travel: float | None = positive_length(example=4, doc="travel before the dead centre")
    travel_angle: float | None = sweep_param(
        default=None, word="travel", example=22, doc="the same of an angle"
    )
    before: str = param(
        TEXT,
        default="outer",
        choices=("inner", "outer"),
        doc="the dead centre with the smallest or the largest value",
    )

    rules = (exactly_one("travel", "travel_angle"),)

    def last_bit(self, output: Output, measures: TrackMeasures, where: str) -> DriverRange:
        """Return the master's range over the last bit of travel.

        Parameters
        ----------
        output : Output
            What it is about.
        measures : TrackMeasures
            Of that.
        where : str
            Place of its table.

        Raises
        ------
        InfeasibleError
            If the output does not travel as far.
        """
        from gearcam.linkages.dwells import WHOLE, ShortRangeError, last_travels

        travel = self.amount(angle=output.angle)
        what, most = f"{self.on} does not travel as far", measures.stroke
        if measures.rise:
            raise InfeasibleError(f"{self.on} turns on and has no dead centre", where=f"{where}.on")
        if travel <= most * WHOLE:
            try:
                return last_travels(measures, travel, outer=self.before == "outer")[0]
            except ShortRangeError as error:
                what = f"{self.on} does not travel as far before its {self.before} dead centre"
                most = error.travel
        if measures.stroke <= _ROUNDED:
            what, most = f"{self.on} does not move", 0.0
        scale, unit = output.unit
        near = scale * most / ABOVE if scale * most > _LEAST_TRAVEL else None
        key = f"{where}.travel_{unit}"
        raise beyond_limit(what, key, scale * travel, scale * most, near=near, unit=unit)


@dataclass(frozen=True, kw_only=True)
class DwellSpec(Amount):
    """A dwell that an output is to have: the longest range in which it hardly moves.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.DwellSpec(on="slide", within=0.1)
    DwellSpec(on='slide', within=0.1)
    """

    word = "within"

    on: str = named(doc="the output", example="slide")
    within: float | None = positive_length(example=0.1, doc="how much it may move")
    within_angle: float | None = sweep_param(
        default=None, word="within", example=0.5, doc="the same of an angle"
    )
    least: float = sweep_param(
        default=math.radians(10.0), doc="the master's angle over which it must last"
    )

    rules = (exactly_one("within", "within_angle"),)

    def longest(self, output: Output, measures: TrackMeasures) -> DriverRange:
        """Return the longest range in which an `output` with `measures` is within the amount."""
        from gearcam.linkages.dwells import longest_dwell

        return longest_dwell(measures, self.amount(angle=output.angle))


@check("no-dwell", kind=TABLES, relation="at least", unit="deg")
def no_dwell(result: Any, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Warn of a dwell that is asked for and not long enough.

    Looks at: the longest range of the master in which the output stays within the amount.
    """
    for number, (one, found) in enumerate(zip(result.design.dwell, result.dwells, strict=True)):
        if found.length < one.least:
            yield Remark(
                f"{one.on} has no dwell as long as that: this is the longest.",
                f"dwell[{number}], from {formatted(DEG * found.begin)} deg",
                DEG * found.length,
                limit=DEG * one.least,
            )


@check("second-dead-center", kind=TABLES, severity="note")
def second_center(result: Any, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note an interval before a dead centre that is reached more than once.

    Looks at: the dead centres of the output with the same value.
    """
    for number, (asked, interval) in enumerate(
        zip(result.design.interval, result.intervals, strict=True)
    ):
        measures = result.measures_of(result.output_of(asked))
        outer = asked.before == "outer"
        top = (measures.largest() if outer else measures.least()).value
        same = [
            center.place
            for center in measures.dead_centers
            if center.outer == outer and math.isclose(center.value, top, rel_tol=1e-9)
        ]
        if len(same) > 1:
            places = ", ".join(f"{formatted(DEG * place)} deg" for place in same)
            yield Remark(
                f"{asked.on} reaches this dead centre more than once in a cycle, at {places}: the "
                "interval is before the first of them.",
                f"interval[{number}], to {formatted(DEG * interval.end)} deg",
            )
