"""Ratio laws: what they give, and how they are made.

A law gives ``i21 = dphi2/dphi1 > 0`` and its integral ``phi2`` over one *period* of the driver:
the driver has `n1` equal lobes, the driven wheel `n2`, so that one period turns the driver by
``2*pi/n1`` and the driven wheel by ``2*pi/n2``. A law is made from its *parameters*, a frozen
dataclass with the method ``build(lobes, tolerances)``; its module has it among its ``ENTRIES``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.adjustments import Adjustment
from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.base.quantities import params_of
from gearcam.base.tolerances import Tolerances
from gearcam.laws.displacement import Displacement, Jump
from gearcam.laws.ratio.span import (
    NO_DWELL,
    RING,
    Span,
    angle_text,
    continued,
    demand_below_one,
    demand_smooth,
    demand_travels,
    is_open,
)
from gearcam.numeric.arrays import Array, Ints
from gearcam.numeric.chebyshev import Expansion, expand, missed
from gearcam.numeric.piecewise import Piece, Piecewise, integrate, piecewise

_SWING: Final = 1e6
"""Largest quotient of largest and smallest ratio."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RatioLaw(ShortRepr, Displacement):
    """The ratio over one lobe or the travel of an open pair, and phi2, its integral.

    Parameters
    ----------
    name : str
        Its name in design files; empty if it has none.
    lobes : Lobes or Travel
        Periods of driver and driven wheel, or the travels of an open pair.
    ratio : Piecewise
        i21 over ``[0, lobes.period]``; of an open pair also beyond both ends; of a rack r1.
    driven : Piecewise or Expansion
        phi2 over the same interval, rad, zero at zero; of a rack its travel.
    solved : mapping of str to float
        Values that the program solved, by name.
    function_errors : (4,) tuple of float
        Errors from the expansion of a Python function: of phi2, rad, of the ratio, of its slope,
        1/rad, and of its second derivative.
    """

    name: str = ""
    lobes: Span
    ratio: Piecewise
    driven: Piecewise | Expansion
    solved: Mapping[str, float] = field(default_factory=dict)
    function_errors: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)

    @property
    def mate(self) -> int:
        """Type of the mate; for a rack the ratio is r1, and phi2 the travel of the rack."""
        return self.lobes.mate

    @property
    def knots(self) -> Array:
        """Knots over one lobe or the travel of an open pair, rad, ends included."""
        knots = self.ratio.knots
        return knots if self.lobes.closed else knots[1:-1]

    @property
    def period(self) -> float:
        """Driver's angle of one lobe, or of the travel of an open pair, rad."""
        return self.lobes.period

    @property
    def advance(self) -> float:
        """Driven angle over the period, rad; of a rack its travel in a turn."""
        return self.lobes.advance

    @property
    def closed(self) -> bool:
        """Whether the pair can turn without end."""
        return self.lobes.closed

    @cached_property
    def jumps(self) -> tuple[Jump, ...]:
        """Knots at which the ratio or one of its derivatives up to the third jumps."""
        last, jumps = len(self.ratio.knots) - 1, []
        for knot, continuity in enumerate(self.ratio.continuity, start=1):
            inner = knot < last if self.closed else 1 < knot < last - 1
            if continuity < 3 and (inner or (self.closed and knot == last)):
                order = continuity + 1
                before = self.ratio.side(knot, -1, order)[order]
                after = self.ratio.side(knot % last, 1, order)[order]
                place = float(self.ratio.knots[knot % last])
                jumps.append(Jump(theta=place, order=order + 1, before=before, after=after))
        return tuple(jumps)

    def knots_between(self, low: Array, high: Array) -> tuple[Ints, Array]:
        """Return the knots in intervals of the driver angle.

        Both ends of a lobe are one knot; the two ends of an open pair are two.

        Parameters
        ----------
        low, high : (n,) arrays, rad
            Ends of the intervals; the lower end is included, the upper one excluded.

        Returns
        -------
        number, place : (k,) int array, (k,) array, rad
            Index of the interval and angle of the knot, for each knot.
        """
        closed, period = self.lobes.closed, self.lobes.period
        knots = self.knots[:-1] if closed else self.knots

        def before(phi: Array) -> Ints:
            turns = np.floor(phi / period) if closed else np.zeros(phi.shape)
            inside = np.searchsorted(knots, phi - turns * period)
            return turns.astype(np.int64) * len(knots) + inside

        first = before(low) - 1  # and one more at the end: turns are rounded
        count = before(high) + 1 - first
        stretch = np.repeat(np.arange(len(count)), count)
        number = np.arange(len(stretch)) + np.repeat(first - np.cumsum(count) + count, count)
        turn, knot = np.divmod(number, len(knots))
        place = knots[knot] + period * turn
        kept = (place >= low[stretch]) & (place < high[stretch]) & (closed | (turn == 0))
        return stretch[kept], place[kept]

    def in_period(self, x: Array, order: int) -> list[Array]:
        """Return ``[phi2, i, i', ...]`` (see `Displacement.in_period`)."""
        return [self.driven(x), *(self.ratio.derivatives(x, order - 1) if order else ())]

    def phi2(self, phi1: ArrayLike) -> Array:
        """Return the driven angle, rad, at any driver angles, rad, over several turns too."""
        return self.derivatives(phi1, 0)[0]

    @property
    def travelled(self) -> float:
        """Driven angle over a lobe, or over the travel of an open pair, rad."""
        return self.driven.last if self.closed else float(self.driven(self.period))

    @property
    def closure_error(self) -> float:
        """Closure error of the driven angle over a lobe, rad."""
        return self.travelled - self.lobes.advance

    @cached_property
    def ratio_range(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Smallest and largest ratio, each as (driver angle in rad, value)."""
        knots, cells = self.knots, self.driven.knots
        inside = cells[(cells > knots[0]) & (cells < knots[-1])]
        return self.ratio.extremes_over(np.concatenate([knots[:1], inside, knots[-1:]]))

    @property
    def function_error(self) -> float:
        """Error of phi2, rad, that comes from the expansion of a Python function."""
        return self.function_errors[0]

    @cached_property
    def error(self) -> float:
        """Estimated error of phi2, rad, or of a rack's travel, at an exact driver angle.

        Twice the difference from a quadrature of the ratio, since both are rounded, plus the
        closure error of a solved law, the expansion error of a Python function, and rounding.
        """
        expanded = isinstance(self.driven, Expansion)
        grid = self.driven.knots if expanded else expand(self.ratio, self.knots, 0.0).knots
        inside = grid[(grid >= 0.0) & (grid <= self.period)]
        measured = 2.0 * missed(self.driven, self.ratio, inside) + abs(float(self.driven(0.0)))
        solved = abs(self.closure_error) if self.solved else 0.0
        rounding = 4.0 * float(np.finfo(float).eps) * self.advance
        return measured + solved + self.function_error + rounding


def milder(parameters: Any, mean: float) -> Iterator[Adjustment]:
    """Yield adjustments to a law whose ratio swings less.

    A law says it in its own method ``milder(mean)``, or parameters by their value of `constant_at`.

    Parameters
    ----------
    parameters : dataclass
        Parameters of a ratio law.
    mean : float
        Its mean ratio.

    Yields
    ------
    Adjustment
        A change of the law's keys.
    """
    if hasattr(parameters, "milder"):
        yield from parameters.milder(mean)
    far = {
        f"law.{given.key(name)}": mean if given.constant_at == "mean" else given.constant_at
        for name, given in params_of(type(parameters)).items()
        if given.constant_at is not None
    }
    if far and not is_open(parameters):
        yield Adjustment(far=far)


def make_law(
    lobes: Span,
    knots: ArrayLike,
    pieces: list[Piece],
    tolerances: Tolerances,
    solved: Mapping[str, float] | None = None,
) -> RatioLaw:
    """Return a law made from its pieces, after checking that wheels can realise it.

    Parameters
    ----------
    lobes : Lobes or Travel
        Periods, or how far an open pair turns.
    knots : (n + 1,) array, rad
        From 0 to ``lobes.period``.
    pieces : list of n Piece
        i21 between the knots.
    tolerances : Tolerances
        Accuracy of expansions and closure.
    solved : mapping of str to float, optional
        Values that the program solved, by name.

    Returns
    -------
    RatioLaw
        The ratio is positive, at least C1 and closed; an open one is continued beyond its ends.

    Raises
    ------
    InfeasibleError
        If the ratio is not finite, smooth, positive or periodic, does not close, or is not below 1
        for an internal pair.
    """
    demand_travels(lobes)
    with demand_smooth("the ratio"):
        driven = integrate(knots, pieces, tolerances.expansion)
        ratio = piecewise(knots, pieces)
        _demand_positive(ratio, driven.knots)
        if lobes.mate == RING:
            _, (place, largest) = ratio.extremes_over(driven.knots)
            demand_below_one(largest, angle_text(place), lobes.advance / lobes.period)
        if not lobes.closed:
            longer, more = continued(ratio, pieces, lobes.mate)
            ratio, driven = piecewise(longer, more), integrate(longer, more, tolerances.expansion)
            driven = driven.shifted(-float(driven(0.0)))
    law = RatioLaw(lobes=lobes, ratio=ratio, driven=driven, solved=dict(solved or {}))
    _demand_c1(law)
    if abs(law.closure_error) > tolerances.refusal:
        asks = "the tooth counts ask" if lobes.closed else "driven_travel_deg asks"
        travelled = math.degrees(law.travelled)
        what = (
            "the law does not close" if lobes.closed else "the law misses the driven wheel's travel"
        )
        limit = math.degrees(lobes.advance)
        note = (
            f"over {formatted(math.degrees(lobes.period), 10)} deg of the driver the driven "
            f"wheel turns by the value; {asks} for the limit"
        )
        near = None if lobes.closed else {"law.driven_travel_deg": travelled}
        raise beyond_limit(what, "", travelled, limit, note, near=near, unit="deg")
    return law


def _demand_positive(ratio: Piecewise, cells: Array) -> None:
    (place, smallest), (top, largest) = ratio.extremes_over(cells)
    if not smallest > 0.0:
        what = "the ratio must stay positive: the driven wheel would stand still or turn back"
        raise beyond_limit(what, angle_text(place), smallest, 0.0, NO_DWELL)
    if not largest <= _SWING * smallest:
        what = f"the ratio swings between {formatted(smallest)} and {formatted(largest)}"
        note = "the largest is at most a million times the smallest"
        raise beyond_limit(what, angle_text(top), largest / smallest, _SWING, note)


def _demand_c1(law: RatioLaw) -> None:
    for jump in law.jumps:
        if jump.order <= 2:
            name = "ratio" if jump.order == 1 else "slope of the ratio"
            ends = jump.theta == 0.0
            place = angle_text(jump.theta or law.period)
            if not math.isfinite(jump.before + jump.after):
                raise InfeasibleError(f"the {name} has no value", where=place)
            what = (
                f"the {name} {'is not periodic' if ends else 'jumps'}: it is "
                f"{formatted(jump.before)} before {place} and {formatted(jump.after)} "
                f"{'at 0 deg' if ends else 'after it'}"
            )
            raise InfeasibleError(what, where=place)
