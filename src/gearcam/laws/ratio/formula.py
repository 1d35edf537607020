"""Laws given by a formula in phi1 of the driven angle, the ratio, or the driver centrode."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.base.quantities import TEXT, Solve, param
from gearcam.base.rules import Breach, exactly_one, needs
from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import TYPED, Axis, LawEntry
from gearcam.laws.formula import (
    AxisFunction,
    Given,
    derivative,
    formula_problems,
    function_of,
    values_of,
)
from gearcam.laws.ratio.base import RatioLaw, make_law
from gearcam.laws.ratio.driver import demand_positive, law_of_centrode
from gearcam.laws.ratio.span import (
    NO_DWELL,
    PLACES,
    RING,
    TRAVELS,
    Lobes,
    RackTravel,
    Span,
    angle_text,
    demand_smooth,
    open_travel,
    own_travel,
    span_of,
)
from gearcam.numeric.chebyshev import expand
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import Piece, integrate

_NAMES = ("phi2", "ratio", "r1")

_PLACES_OF_LOBE = 257
"""Number of places at which each lobe is compared with the first."""


@dataclass(frozen=True, kw_only=True)
class Formula(ShortRepr):
    """Exactly one of three formulas; derivatives are exact, by Taylor arithmetic.

    In Python each may be a function of phi1, rad, or a tuple of a function and its first
    derivatives. With `driver_travel` and `driven_travel` the pair is open; phi2 itself gives the
    latter, which then may be left out.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.Formula(phi2="phi1 - 0.08*sin(2*phi1)")
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="formula", law=law, pair=pair))
    >>> result.motion([0.0, 1.0])["ratio"].round(4)
    array([0.84  , 1.0666])
    """

    phi2: Given | None = param(
        TEXT, default=None, function=True, doc="driven angle, rad, over phi1; must close"
    )
    ratio: Given | None = param(
        TEXT, default=None, function=True, doc="ratio over phi1, scaled so that it closes"
    )
    r1: Given | None = param(
        TEXT, default=None, function=True, doc="driver's radius over phi1, at any scale"
    )
    driver_travel: float | None = open_travel("driver")
    driven_travel: float | Solve | None = open_travel("driven wheel", "phi2, also if left out")

    rules = (
        exactly_one(*_NAMES),
        needs("driver_travel", "driven_travel", "phi2", one=True, allowed=TRAVELS),
        needs("driven_travel", "driver_travel", allowed=TRAVELS),
    )

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        for name in _NAMES:
            yield from formula_problems(name, getattr(self, name))

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If the formula is not finite, smooth, monotonic or periodic, or does not close.
        """
        if self.phi2 is not None:
            axis = axis_of("phi2", self.driver_travel or lobes.period)
            phi2 = function_of(self.phi2, axis, tolerances.expansion)
            travel = self.driven_travel
            if self.driver_travel is not None:
                start, end = values_of(phi2)(np.array([0.0, self.driver_travel]))
                travel = own_travel(travel, float(end - start), tolerances.refusal)
            span = span_of(lobes, self.driver_travel, travel)
            law = from_phi2(phi2, span, tolerances)
            return replace(law, function_errors=phi2.errors)
        span = span_of(lobes, self.driver_travel, self.driven_travel)
        name = "ratio" if self.ratio is not None else "r1"
        axis = axis_of(name, span.n1 * span.period)
        function = function_of(getattr(self, name), axis, tolerances.expansion)
        demand_positive(values_of(function), name, span.period)
        _demand_repeats(function, name, span)
        if self.ratio is None:
            law = law_of_centrode([Piece(function)], [0.0, span.period], span, tolerances)
            # di = (1 + w*i)^2/c*dr, from i = r/(c - w*r)
            ratio = law.ratio(np.linspace(0.0, span.period, _PLACES_OF_LOBE))
            rate = float(((1.0 + law.mate * ratio) ** 2).mean())
            rate /= law.solved["center_distance_over_scale"]
            return _of_ratio(law, rate, function)
        with demand_smooth(name):
            total = expand(values_of(function), [0.0, span.period], tolerances.expansion)
        factor = span.advance / total.antiderivative().last
        piece = Piece(lambda x: factor * function(x))
        solved = {"ratio_factor": factor}
        law = make_law(span, [0.0, span.period], [piece], tolerances, solved)
        return _of_ratio(law, factor, function)


def _of_ratio(law: RatioLaw, factor: float, function: AxisFunction) -> RatioLaw:
    """Return a law with the errors of the function to which its ratio is proportional."""
    errors = tuple(factor * each for each in function.errors[:3])
    return replace(law, function_errors=(law.period * errors[0], *errors))


def axis_of(name: str, high: float) -> Axis:
    """Return the axis of a formula `name` in phi1 from 0 to `high`."""
    remedy = 'for such values use the law "table", whose curve has no corners'
    return Axis(name=name, high=high, place=angle_text, remedy=remedy)


def _demand_repeats(function: Callable[[Jet], Jet], name: str, lobes: Span) -> None:
    """Refuse a formula that does not repeat in every lobe of the driver."""
    x = np.linspace(0.0, lobes.period, _PLACES_OF_LOBE)
    first = values_of(function)(x)
    for lobe in range(1, lobes.n1):
        other = values_of(function)(x + lobe * lobes.period)
        bad = ~(np.abs(other - first) <= TYPED * np.abs(first).max())
        if bad.any():
            place, wrong, right = (float(v[bad][0]) for v in (x, other, first))
            what = (
                f"{name} is not periodic: it must repeat every "
                f"{formatted(math.degrees(lobes.period))} deg for these tooth counts"
            )
            note = f"the limit is the value one lobe before; use functions of {lobes.n1}*phi1"
            raise beyond_limit(what, angle_text(place + lobe * lobes.period), wrong, right, note)


def from_phi2(
    phi2: Callable[[Jet], Jet],
    lobes: Span,
    tolerances: Tolerances,
    solved: dict[str, float] | None = None,
) -> RatioLaw:
    """Return the law of a given phi2; its derivative is the ratio.

    Parameters
    ----------
    phi2 : callable
        ``phi2(jet) -> jet``, rad, any constant.
    lobes : Lobes or Travel
        Lobes, or travels of an open pair.
    tolerances : Tolerances
        Accuracy.
    solved : dict, optional
        Values that were solved already, by name.

    Returns
    -------
    RatioLaw

    Raises
    ------
    InfeasibleError
        If phi2 is not finite, smooth or rising, or does not close.
    """
    ratio = derivative(phi2)
    x = np.linspace(0.0, lobes.period, PLACES)
    values, slopes = phi2(Jet.variable(x, 1)).derivatives()
    bad = ~np.isfinite(values) | ~np.isfinite(slopes)
    if bad.any():
        raise InfeasibleError("phi2 is not finite", where=angle_text(x[bad][0]))
    if (slopes <= 0).any():
        place = int(np.argmax(slopes <= 0))
        what = "phi2 is not monotonic: the driven wheel would stand still or turn back"
        note = f"this is the ratio, which must be positive; {NO_DWELL}"
        raise beyond_limit(what, angle_text(x[place]), float(slopes[place]), 0.0, note)
    with demand_smooth("phi2"):
        expand(values_of(ratio), [0.0, lobes.period], tolerances.expansion)
    return make_law(lobes, [0.0, lobes.period], [Piece(ratio, phi2)], tolerances, solved)


@dataclass(frozen=True, kw_only=True)
class RackLaw(ShortRepr):
    """The centrode of the driver or the travel of the rack over a turn, at any scale.

    In Python either may be a function of phi1, rad, or a tuple with its first derivatives.
    The rack moves by ``dy = r1*dphi1``, so that ``r1 = y'``; its centrode is the curve ``(r1, y)``,
    straight only for a circular wheel. The ratio of the law is r1, its phi2 is y.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.RackLaw(r1="1 + 0.2*cos(phi1)")
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="rack", law=law, pair=pair))
    >>> result.motion([0.0, 1.0])["velocity_mm_per_rad"].round(4)
    array([35.6427, 32.9119])
    """

    r1: Given | None = param(
        TEXT, default=None, function=True, doc="wheel's radius over phi1, at any scale"
    )
    travel: Given | None = param(
        TEXT, default=None, function=True, doc="or its travel over phi1, at any scale"
    )

    rules = (exactly_one("r1", "travel"),)

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        for name in ("r1", "travel"):
            yield from formula_problems(name, getattr(self, name))

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law to `tolerances`; the rack may have any number of teeth.

        Raises
        ------
        InfeasibleError
            If the radius is not finite, smooth, positive or periodic, or for an internal pair.
        """
        if lobes.mate == RING:
            what = "a rack cannot be an internal pair"
            raise beyond_limit(what, "pair.type", None, None, near="external")
        turn = 2.0 * math.pi
        name = "r1" if self.travel is None else "travel"
        axis = Axis(name=name, high=turn, place=angle_text)
        function = function_of(getattr(self, name), axis, tolerances.expansion)
        piece = (
            Piece(derivative(function), function) if self.travel is not None else Piece(function)
        )
        demand_positive(values_of(piece.function), "r1", turn)
        with demand_smooth("r1"):
            advance = integrate([0.0, turn], [piece], tolerances.expansion).last
        law = make_law(RackTravel(turn, advance), [0.0, turn], [piece], tolerances)
        if self.travel is None:
            return _of_ratio(law, 1.0, function)
        return replace(law, function_errors=function.errors)


ENTRIES: Final = (
    LawEntry(
        name="formula",
        example=Formula(phi2="phi1 - 0.08*sin(2*phi1)"),
        doc="a formula in phi1 (rad) of exactly one of phi2, the ratio and r1",
        continuity="analytic if the formula is",
        source="Niculescu, Table 1.1, the three hypotheses",
    ),
    LawEntry(
        name="rack",
        example=RackLaw(r1="1 + 0.2*cos(phi1)"),
        doc="a wheel that drives a rack, given by its centrode or by the rack's travel",
        continuity="analytic if the formula is",
        source="Niculescu, fig. 1.8",
    ),
)
