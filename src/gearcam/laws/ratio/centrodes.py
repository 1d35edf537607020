"""Centrodes given by one formula of the driver's radius: circles, limacons, lobed ones, spirals.

The radius is given at any scale; the centre distance over it follows from closure.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.display import Brief
from gearcam.errors import InfeasibleError, Way
from gearcam.laws.entry import LawEntry
from gearcam.laws.ratio.base import LAWS, RatioLaw, make_law
from gearcam.laws.ratio.driver import LOBES, demand_lobes, law_of_centrode
from gearcam.laws.ratio.span import (
    RING,
    Lobes,
    Travel,
    demand_below_one,
    demand_equal,
    spiral,
)
from gearcam.numeric.jets import Jet, atan, cos, sin, sqrt
from gearcam.numeric.piecewise import Piece
from gearcam.quantities import ANGLE, COUNT, NUMBER, param
from gearcam.tolerances import Tolerances


@dataclass(frozen=True, kw_only=True)
class EccentricCircle:
    """A circle of radius 1 whose shaft is `eccentricity` off its middle; far side at phi1 = 0.

    ``r1 = e*cos(phi1) + sqrt(1 - (e*sin(phi1))^2)``.
    """

    eccentricity: float = param(
        NUMBER, ge=0, lt=1, doc="distance of shaft and centre over the radius"
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
    """Pascal's limacon, ``r1 = 1 + e*cos(phi1)``: a circle rolled around by its equal."""

    eccentricity: float = param(NUMBER, ge=0, lt=1, doc="amplitude of the radius over its mean")

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
    """``r1 = 1 + e*cos(n1*phi1)`` with n1 lobes."""

    eccentricity: float = param(NUMBER, ge=0, lt=1, doc="amplitude of the radius over its mean")
    lobes: tuple[int, int] | None = param(COUNT, default=None, ge=1, le=100, doc=LOBES)

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
    # (b + w)^2 = k^2*(b^2 - e^2): the greater root, with the smaller one c is negative
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
class LogSpiral(Brief):
    """``r1 = r1(0)*exp(k*phi1)``; its mate is a spiral of the same k.

    An external wheel's grows the other way, a ring's the same way.
    With ``u = r1/A = i/(1 + w*i)`` at both ends (w = 1 for a wheel as mate, -1 for a ring), the
    driven wheel turns by ``w*ln((1 - w*u0)/(1 - w*u1))/k`` and the driver by ``ln(u1/u0)/k``, so
    that its travel gives k.
    """

    ratios: tuple[float, float] = param(
        NUMBER, ge=1e-10, le=1e10, doc="i21 at the start and at the end"
    )
    driven_travel: float = param(ANGLE, gt=0, le=360, doc="how far the driven wheel turns")

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            For unequal tooth counts or equal ratios, or ratios of a ring that are not below 1.
        """
        demand_equal(lobes)
        start, end = self.ratios
        if start == end:
            raise InfeasibleError(
                "a spiral's ratio changes from start to end",
                where="law.ratios",
                value=end,
                limit=start,
                nearest='other ratios; a constant one is the law "constant"',
            )
        w = lobes.mate
        if w == RING:
            key = f"law.ratios[{int(end > start)}]"
            ways = (Way(near={key: 1.0}, far={key: min(start, end)}),)
            demand_below_one(max(start, end), key, ways=ways)
        first, rise = start / (1.0 + w * start), end - start
        # logarithms of (1 + w*u)'s and of u's quotient, exact for nearly equal ratios too
        growth = w * math.log1p(w * rise / (1.0 + w * start)) / self.driven_travel
        travel = math.log1p(rise / (start * (1.0 + w * end))) / growth

        solved = {"growth_per_rad": growth, "driver_travel_deg": math.degrees(travel)}
        span = Travel(travel, self.driven_travel, w)
        return make_law(span, [0.0, travel], [spiral(first, growth, w)], tolerances, solved)


def _demand_one_lobe(lobes: Lobes, name: str) -> None:
    if lobes.n1 != 1:
        raise InfeasibleError(
            f"{name} has one lobe",
            where="pair.teeth",
            value=float(lobes.n1),
            limit=1.0,
            nearest="the driven wheel's teeth are the driver's or a multiple of them then",
        )


LAWS.register(
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
        doc="logarithmic spirals on an open pair, from one ratio to another",
        continuity="analytic",
        source="Niculescu, fig. 1.9",
    ),
)
