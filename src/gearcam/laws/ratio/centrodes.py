"""Laws given by a formula for the radius of the driver: circles, limacons, lobes, spirals.

The radius is given at any scale; closure gives the centre distance in that scale.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, TypeVar

from gearcam.base.adjustments import Adjustment
from gearcam.base.display import ShortRepr
from gearcam.base.errors import beyond_limit
from gearcam.base.quantities import ANGLE, COUNT, NUMBER, WHEELS, Solve, param
from gearcam.base.rules import Breach, exactly_one
from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import TYPED, LawEntry
from gearcam.laws.ratio.base import RatioLaw, make_law
from gearcam.laws.ratio.driver import law_of_centrode
from gearcam.laws.ratio.span import (
    LOBES,
    NO_DWELL,
    ONE_LOBE,
    RING,
    WHEEL,
    Lobes,
    Travel,
    demand_below_one,
    demand_equal,
    demand_lobes,
    open_travel,
    spiral,
)
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet, atan, cos, sin, sqrt
from gearcam.numeric.piecewise import Piece
from gearcam.numeric.roots import newton_in_bracket

T = TypeVar("T", Array, Jet)

_TO_AND_FRO: Final = "with a return the pair turns without end, with a travel to and fro"


@dataclass(frozen=True, kw_only=True)
class EccentricCircle:
    """A circle of radius 1 with its shaft `eccentricity` beside its centre; far side at phi1 = 0.

    ``r1 = e*cos(phi1) + sqrt(1 - (e*sin(phi1))^2)``.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.EccentricCircle(eccentricity=0.3)
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="eccentric", law=law, pair=pair))
    >>> result.motion([0.0, 3.141592653589793])["ratio"].round(4)
    array([1.7478, 0.5209])
    """

    eccentricity: float = param(
        NUMBER, ge=0, lt=1, constant_at=0, doc="distance of shaft and circle centre, in radii"
    )

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            Unless the driver has one lobe.
        """
        e = self.eccentricity
        _demand_one_lobe(lobes, "an eccentric circle")

        def radius(x: Jet) -> Jet:
            across = e * sin(x)
            return e * cos(x) + sqrt(1.0 - across * across)

        return law_of_centrode([Piece(radius)], [0.0, lobes.period], lobes, tolerances)


@dataclass(frozen=True, kw_only=True)
class Limacon:
    """Pascal's limacon, ``r1 = 1 + e*cos(phi1)``.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.Limacon(eccentricity=0.3)
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="limacon", law=law, pair=pair))
    >>> result.motion([0.0, 3.141592653589793])["ratio"].round(4)
    array([1.6568, 0.5056])
    """

    eccentricity: float = param(
        NUMBER, ge=0, lt=1, constant_at=0, doc="amplitude of the radius over its mean"
    )

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            Unless the driver has one lobe.
        """
        _demand_one_lobe(lobes, "a limacon")
        return _lobed(self.eccentricity, 1, lobes, tolerances)


@dataclass(frozen=True, kw_only=True)
class Lobed:
    """``r1 = 1 + e*cos(n1*phi1)`` with n1 lobes.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.Lobed(eccentricity=0.1)
    >>> pair = gc.PairSpec(teeth=(20, 40), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="lobed", law=law, pair=pair))
    >>> result.motion([0.0, 3.141592653589793])["ratio"].round(4)
    array([0.5767, 0.4271])
    """

    eccentricity: float = param(
        NUMBER, ge=0, lt=1, constant_at=0, doc="amplitude of the radius over its mean"
    )
    lobes: tuple[int, int] | None = param(
        COUNT, default=None, ge=1, le=100, order=WHEELS, doc=LOBES
    )

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If the lobes are not in the ratio of the tooth counts.
        """
        return _lobed(self.eccentricity, demand_lobes(self.lobes, lobes), lobes, tolerances)


def _lobed(e: float, count: int, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
    """``i = r/(c - w*r)`` with closed forms for centre distance and driven angle.

    With ``b = c - w`` and ``f = w*e`` the ratio is ``w*(c/(b - f*cos(n*phi1)) - 1)``, whose
    integral over a lobe gives ``c = k*sqrt(b^2 - e^2)``, k = 1 + w*n1/n2, and so ``b``.
    """
    w = lobes.mate
    k, f = 1.0 + w * lobes.n1 / lobes.n2, w * e
    # (b + w)^2 = k^2*(b^2 - e^2): the larger root; the smaller one gives a negative c
    square = k * k - 1.0
    b = w * (1.0 + k * math.sqrt(1.0 + square * e * e)) / square
    c, root = b + w, math.sqrt(b * b - e * e)

    def ratio(x: Jet) -> Jet:
        return w * (c / (b - f * cos(count * x)) - 1.0)

    def phi2(x: Jet) -> Jet:
        # 2*atan(tan(x/2)*sqrt((b + f)/(b - f))) without its poles
        turn = 2.0 * atan(f * sin(count * x) / (b + root - f * cos(count * x)))
        return w * ((c / root) * (x + turn / count) - x)

    piece = Piece(ratio, phi2)
    solved = {"center_distance_over_scale": c}
    return make_law(lobes, [0.0, lobes.period], [piece], tolerances, solved)


@dataclass(frozen=True, kw_only=True)
class LogSpiral(ShortRepr):
    """``r1 = r1(0)*exp(c*phi1)``; the centrode of the mate is a spiral of the same c.

    While the radius of the driver grows, that of an external mate shrinks, that of a ring grows.

    *Open pair*, with `driven_travel`: with ``u = r1/A = i/(1 + w*i)`` at both ends (w = 1 for a
    wheel as mate, -1 for a ring), the driven wheel turns by ``w*ln((1 - w*u0)/(1 - w*u1))/c`` and
    the driver by ``ln(u1/u0)/c``, so that its travel gives c.

    *Closed pair*, with `return_angle`: two external wheels with equal centrodes. From phi1 = 0 the
    ratio rises from 1/k to k on the spiral; over the last `return_angle` it returns, C2 at both
    joints. With t from the middle of the return both angles are ``t + h(t)`` and ``t - h(t)``. An
    even h makes both centrodes equal: ``i = (1 - h')/(1 + h')`` at -t is 1/i at t. On the spiral,
    as long on both wheels, ``h' = -tanh(c*(t - pi))``, ``c = ln(k)/(2*pi - return_angle)``; on the
    return h' is the odd polynomial of degree 5 that continues it up to its second derivative.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.LogSpiral(ratios=(0.5, 2.0), driven_travel=2.0)
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="spiral", law=law, pair=pair))
    >>> result.motion([0.0, 1.0])["ratio"].round(4)
    array([0.5   , 0.8918])
    """

    ratios: tuple[float | Solve, float | Solve] = param(
        NUMBER,
        ge=1e-3,
        le=1e3,
        at_zero=NO_DWELL,
        doc="i21 at the start and at the end of the spiral; of a closed pair k and 1/k, of which "
        'one may be "solve"',
    )
    driven_travel: float | None = open_travel("driven wheel")
    return_angle: float | None = param(
        ANGLE,
        default=None,
        ge=1,
        le=180,
        word="return",
        doc="closed pair: driver angle of the smooth return to the first ratio; during it the "
        "ratio goes a little beyond both",
    )

    rules = (exactly_one("return_angle", "driven_travel", note=_TO_AND_FRO),)

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        closed = self.return_angle is not None
        for index, ratio in enumerate(self.ratios):
            if ratio == "solve" and (not closed or (index and self.ratios[0] == "solve")):
                rule = "a number; one of the two ratios of a closed pair is solved at most"
                yield "ratios", index, '"solve" is not possible here', rule

    def milder(self, mean: float) -> Iterator[Adjustment]:  # noqa: ARG002  (same signature for all)
        """Yield adjustments to a closed spiral with a smaller swing; it has no constant ratio."""
        if self.return_angle is not None:
            first, last = self.ratios
            start = 1.0 / float(last) if first == "solve" else first
            far = {"law.ratios": [start**0.05, "solve"]}  # 1 itself is no spiral
            yield Adjustment(near={"law.ratios": [start, "solve"]}, far=far)
            yield Adjustment(far={"law.return_deg": 180.0})

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            For unequal tooth counts or equal ratios, or ratios of a ring that are not below 1; for
            a closed pair in a ring, or whose ratios are not 1/k and k.
        """
        first, last = self.ratios
        start = 1.0 / float(last) if first == "solve" else first
        end = 1.0 / start if last == "solve" else last
        if start == end:
            what = "the ratio of a spiral changes from start to end"
            raise beyond_limit(
                what, "law.ratios", end, start, 'a constant ratio is the law "constant"'
            )
        if self.return_angle is not None:
            return _closed(start, end, self.return_angle, lobes, tolerances)
        demand_equal(lobes)
        driven = self.driven_travel or 0.0  # given where no return is
        w = lobes.mate
        if w == RING:
            key = f"law.ratios[{int(end > start)}]"
            demand_below_one(max(start, end), key, far=min(start, end))
        first, rise = start / (1.0 + w * start), end - start
        # logarithms of (1 + w*u)'s and of u's quotient, exact for nearly equal ratios too
        growth = w * math.log1p(w * rise / (1.0 + w * start)) / driven
        travel = math.log1p(rise / (start * (1.0 + w * end))) / growth

        solved = {"growth_per_rad": growth, "driver_travel_deg": math.degrees(travel)}
        span = Travel(travel, driven, w)
        return make_law(span, [0.0, travel], [spiral(first, growth, w)], tolerances, solved)


def _closed(
    start: float, end: float, turn: float, lobes: Lobes, tolerances: Tolerances
) -> RatioLaw:
    """Return the law of two equal centrodes; `turn` is the driver angle of the return, rad."""
    if lobes != ONE_LOBE:
        what = "a closed spiral needs an external pair with equal tooth counts"
        raise beyond_limit(
            what, "pair.teeth", lobes.n1 / lobes.n2, 1.0, "this is the ratio of the tooth counts"
        )
    if abs(start * end - 1.0) > TYPED:
        what = "a closed spiral has equal centrodes: its ratios are k and 1/k"
        note, product = "this is the product of both ratios", start * end
        near, other = {"law.ratios[0]": 1.0 / end}, Adjustment(near={"law.ratios[1]": 1.0 / start})
        raise beyond_limit(what, "law.ratios", product, 1.0, note, near=near, adjustments=(other,))
    half, joint = 0.5 * turn, 2.0 * math.pi - turn
    k = math.sqrt(end / start)
    growth = math.log(k) / joint
    pieces = [spiral(1.0 / (1.0 + k), growth, WHEEL), _return(k, growth, half)]
    solved = {"growth_per_rad": growth}
    return make_law(lobes, [0.0, joint, 2.0 * math.pi], pieces, tolerances, solved)


def _return(k: float, growth: float, half: float) -> Piece:
    """Return the ratio over the last two times `half` of a turn, from k back to 1/k."""
    # h' at s = t/half is p1*s + p3*s^3 + p5*s^5, at s = 1 with the spiral's derivatives by s
    value = (k - 1.0) / (k + 1.0)
    slope = -growth * half * (1.0 - value) * (1.0 + value)
    p5 = (2.0 * growth * half * value * slope - 3.0 * (slope - value)) / 8.0
    p3 = 0.5 * (slope - value) - 2.0 * p5
    p1 = value - p3 - p5
    middle = 2.0 * math.pi - half * (1.0 + 0.5 * p1 + p3 / 4.0 + p5 / 6.0)

    def h(t: T) -> T:
        q = (t / half) * (t / half)
        return (half * q) * (p1 / 2.0 + q * (p3 / 4.0 + q * (p5 / 6.0)))

    def rate(t: T) -> T:
        s = t / half
        return s * (p1 + s * s * (p3 + s * s * p5))

    def place(x: Jet) -> Jet:
        """Return t, the solution of ``phi1 = middle + t + h(t)``."""
        goal = x.c[0] - middle
        value = newton_in_bracket(
            lambda t: (t + h(t) - goal, 1.0 + rate(t)), -half, half, 0.0 * goal, 1e-15
        )
        over = 1.0 + rate(value)
        t = Jet([value, *[0.0] * x.order])
        for _ in range(x.order):  # each step makes one more derivative exact
            t = t - (t + h(t) - (x - middle)) / over
        return t

    def ratio(x: Jet) -> Jet:
        slope = rate(place(x))
        return (1.0 - slope) / (1.0 + slope)

    return Piece(ratio, lambda x: x - 2.0 * h(place(x)))


def _demand_one_lobe(lobes: Lobes, name: str) -> None:
    if lobes.n1 != 1:
        note = "the driven wheel needs the tooth count of the driver or a multiple of it"
        raise beyond_limit(f"{name} has one lobe", "pair.teeth", float(lobes.n1), 1.0, note)


ENTRIES: Final = (
    LawEntry(
        name="eccentric-circle",
        example=EccentricCircle(eccentricity=0.3),
        doc="a circle turning about a point beside its centre; largest radius at phi1 = 0",
        continuity="analytic",
        source="Litvin, Fuentes, chapter 12; centre distance by closure",
    ),
    LawEntry(
        name="limacon",
        example=Limacon(eccentricity=0.4),
        doc="Pascal's limacon r1 = 1 + e*cos(phi1); largest radius at phi1 = 0",
        continuity="analytic",
        source="classical; centre distance in closed form",
    ),
    LawEntry(
        name="lobed",
        example=Lobed(eccentricity=0.2),
        doc="r1 = 1 + e*cos(n1*phi1): wheels with any numbers of lobes",
        continuity="analytic",
        source="classical; centre distance in closed form",
    ),
    LawEntry(
        name="log-spiral",
        example=LogSpiral(ratios=(0.5, 2.0), driven_travel=2.0),
        doc="logarithmic spirals: an open pair, or a closed one with equal centrodes (nautilus)",
        continuity="analytic; closed: C2 at both ends of the return",
        source="Niculescu, fig. 1.9",
    ),
)
