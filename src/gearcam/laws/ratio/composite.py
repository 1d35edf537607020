"""Constant ratios with transitions, three polynomial phases, and Fourier series."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import beyond_limit
from gearcam.base.numerals import formatted
from gearcam.base.quantities import (
    ANGLE,
    NARROWEST,
    NARROWEST_DEG,
    NUMBER,
    TEXT,
    Row,
    RowOfSome,
    Solve,
    param,
)
from gearcam.base.rules import Breach
from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import LawEntry
from gearcam.laws.formula import derivative
from gearcam.laws.ratio.base import RatioLaw, make_law
from gearcam.laws.ratio.phases import (
    ARCS,
    SMOOTH,
    arcs_law,
    knot_problems,
    one_lobe,
    open_span,
    solved_places,
)
from gearcam.laws.ratio.span import NO_DWELL, SAME, Lobes, Span, angle_text, open_travel
from gearcam.numeric.jets import Jet, harmonics, polynomial, primitive
from gearcam.numeric.piecewise import Piece, piecewise


@dataclass(frozen=True, kw_only=True)
class Multispeed(ShortRepr):
    """Constant ratios, each over an angle of the driver, joined by smooth transitions.

    A closed law ends with a transition to its first ratio; an open one (with `driven_travel`) ends
    with its last constant ratio.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.Multispeed(
    ...     ratios=(0.8, "solve"), angles=(2.1, 2.183185307179586), transition=1.0
    ... )
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="two_speeds", law=law, pair=pair))
    >>> result.motion([0.0, 3.5])["ratio"].round(4)
    array([0.8   , 1.1948])
    """

    ratios: RowOfSome = param(
        NUMBER,
        gt=0,
        min_length=2,
        at_zero=NO_DWELL,
        constant_at="mean",
        doc='the constant ratios in turn; one may be "solve"',
    )
    angles: Row = param(
        ANGLE, ge=0, le=360, min_length=2, doc="driver angle over which each ratio holds"
    )
    transition: float = param(
        ANGLE,
        ge=NARROWEST_DEG,
        le=360,
        doc="driver angle of each transition; a closed law ends with one",
    )
    shape: str = param(TEXT, default="quintic", choices=SMOOTH, doc="shape of the transitions")
    driven_travel: float | Solve | None = open_travel("driven wheel", "the ratios")

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        if len(self.angles) != len(self.ratios):
            message = f"{len(self.angles)} angles for {len(self.ratios)} ratios"
            yield "angles", None, message, "one angle for each ratio"
        for index, angle in enumerate(self.angles):
            if 0.0 < angle < NARROWEST:
                rule = f"0, or at least {formatted(NARROWEST_DEG)} deg"
                yield "angles", index, "this phase is too short", rule
        for place in solved_places(self, "ratios", "driven_travel")[1:2]:
            yield *place, 'more than one "solve"', 'one "solve"'

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If angles and transitions span neither a turn nor a lobe, or the law cannot close.
        """
        steps = [
            (width, place)
            for place, angle in enumerate(self.angles)
            for width in (self.transition, angle)
            if width  # a phase of 0 is left out
        ]
        steps[0] = (0.0, 0)  # no transition leads to it
        if self.driven_travel is None:
            steps.append((self.transition, 0))
        knots, places = np.cumsum([width for width, _ in steps]), [place for _, place in steps]
        values: list[float | Solve] = [self.ratios[place] for place in places]
        arc = ARCS[self.shape]
        if self.driven_travel is None:
            span: Span = lobes
            knots, values = one_lobe(knots, values, lobes, "law.angles_deg with transitions")
        else:
            span = open_span(arc, knots, values, lobes, self.driven_travel, tolerances)
        return arcs_law(arc, knots, values, span, tolerances, places=places)


@dataclass(frozen=True, kw_only=True)
class ThreePhasePolynomial(ShortRepr):
    """A cubic down to the lowest ratio, then two parabolas up again, 003 Table 2.6.

    The ratio starts at b with slope zero, is `lowest` = a at the second knot with slope zero, and
    rises by two parabolas that meet at the third knot with a common slope p. Closure gives p
    and with it the ratio there, ``i_i = a + p*(k2 - k1)/2``, and ``b = a + p*(k3 - k1)/2``.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.ThreePhasePolynomial(knots=(0.0, 2.8, 4.7, 6.283185307179586), lowest=0.4)
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="polynomial", law=law, pair=pair))
    >>> result.motion([0.0, 2.8])["ratio"].round(4)
    array([1.6205, 0.4   ])
    """

    knots: tuple[float, float, float, float] = param(
        ANGLE, ge=0, le=360, doc="driver angles of the knots, from 0 to a turn or one lobe"
    )
    lowest: float = param(
        NUMBER, gt=0, at_zero=NO_DWELL, doc="i21 at the second knot, below the mean ratio"
    )

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        yield from knot_problems(self.knots)

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If the knots do not span a lobe, or the lowest ratio is not below the mean.
        """
        if abs(self.knots[3] - lobes.period) > SAME:
            what = f"the knots must span {formatted(360 / lobes.n1)} deg for these tooth counts"
            value = math.degrees(self.knots[3])
            note = "the limit is one lobe"
            raise beyond_limit(
                what, "law.knots_deg[3]", value, 360 / lobes.n1, note, near=360.0 / lobes.n1
            )
        first, second, third = (float(width) for width in np.diff(self.knots))
        a, mean = self.lowest, lobes.advance / lobes.period
        # integral of (ratio - a)/p: the cubic's mean is half its rise
        rise = 0.5 * (second + third)
        weight = 0.5 * rise * first + second**2 / 6.0 + rise * third - third**2 / 6.0
        p = (lobes.advance - a * lobes.period) / weight
        if not p > 0.0:
            what = "the lowest ratio is not below the mean ratio"
            raise beyond_limit(
                what, "law.lowest", a, mean, "the limit is the mean ratio", far=0.5 * mean
            )
        b = a + p * rise

        pieces = [
            ARCS["cubic"].piece(b, a, 0.0, first),
            Piece(polynomial, primitive, (self.knots[1], a, 0.0, 0.5 * p / second)),
            Piece(polynomial, primitive, (lobes.period, b, 0.0, -0.5 * p / third)),
        ]
        solved = {"p": p, "ratios[0]": b, "ratios[2]": a + 0.5 * p * second}
        return make_law(lobes, self.knots, pieces, tolerances, solved)


@dataclass(frozen=True, kw_only=True)
class Fourier(ShortRepr):
    """Harmonics of a lobe: ``f = 1 + sum(a_k*cos(k*n1*phi1) + b_k*sin(k*n1*phi1))``.

    For the ratio ``i21 = (n1/n2)*f``. For phi2 the driven angle over the mean ratio is ``phi1``
    plus the sums, in degrees, minus their value at phi1 = 0. Both always close.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.Fourier(cosines=(0.2, 0.1))
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="fourier", law=law, pair=pair))
    >>> result.motion([0.0, 3.141592653589793])["ratio"].round(4)
    array([1.3, 0.9])
    """

    of: str = param(
        TEXT, default="ratio", choices=("ratio", "phi2"), doc="what the coefficients belong to"
    )
    cosines: Row = param(
        NUMBER,
        default=(),
        constant_at=0,
        doc="cosine coefficients of the harmonics 1, 2, ... of a lobe: shares of the mean ratio, "
        "or degrees of phi2 at mean ratio 1",
    )
    sines: Row = param(
        NUMBER, default=(), constant_at=0, doc="sine coefficients, in the same units"
    )

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If the ratio is not positive everywhere.
        """
        n, mean = lobes.n1, lobes.advance / lobes.period
        given = enumerate(zip_longest(self.cosines, self.sines, fillvalue=0.0), start=1)
        if self.of == "ratio":  # the integrals are harmonics of phi2
            waves = [(-b / (k * n), a / (k * n)) for k, (a, b) in given]
        else:
            waves = [(math.radians(a), math.radians(b)) for _, (a, b) in given]

        def phi2(x: Jet) -> Jet:
            return mean * (x + harmonics(n * x, *np.reshape(waves, (-1, 2)).T))

        knots, pieces = [0.0, lobes.period], [Piece(derivative(phi2), phi2)]
        (place, smallest), _ = piecewise(knots, pieces).extremes
        if not smallest > 0.0:
            share = mean / (mean - smallest)
            what = "the ratio must stay positive: the driven wheel would stand still or turn back"
            note = f"with all coefficients times {formatted(share)} it would just be 0; {NO_DWELL}"
            far = {"law.cosines": 0.0, "law.sines": 0.0}
            raise beyond_limit(what, angle_text(place), smallest, 0.0, note, far=far)
        return make_law(lobes, knots, pieces, tolerances)


ENTRIES: Final = (
    LawEntry(
        name="multispeed",
        example=Multispeed(
            ratios=(0.8, "solve"), angles=(5 * math.pi / 6, 5 * math.pi / 6), transition=math.pi / 6
        ),
        doc="constant ratios over given angles, joined by smooth transitions; closed or open",
        continuity="C2 for quintic transitions, else C1",
        source="Niculescu, section 1.1.3, fig. 1.6",
    ),
    LawEntry(
        name="three-phase-polynomial",
        example=ThreePhasePolynomial(
            knots=(0.0, math.radians(160), 1.5 * math.pi, 2 * math.pi), lowest=0.4
        ),
        doc="a cubic down, then two parabolas up; closure gives the highest ratio",
        continuity="C1 at the knots",
        source="Niculescu, section 2.2.2.4, eq. (2.25), Table 2.6",
    ),
    LawEntry(
        name="fourier",
        example=Fourier(cosines=(0.2, 0.1), sines=(0.05,)),
        doc="Fourier series of the ratio or of phi2 over a lobe",
        continuity="analytic",
        source="Niculescu, figs. 1.11, 1.17 (centrodes by Fourier series)",
    ),
)
