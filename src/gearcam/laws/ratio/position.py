"""Laws given by the position of the driven element or of a slide that it moves."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.base.quantities import NUMBER, TEXT, param
from gearcam.base.rules import Breach, exactly_one, excludes, needs
from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import Axis, LawEntry
from gearcam.laws.formula import Given, formula_problems, function_of, values_of
from gearcam.laws.ratio.base import RatioLaw, make_law
from gearcam.laws.ratio.formula import axis_of, from_phi2
from gearcam.laws.ratio.slider import NARROWEST, crank_angle, make_slide
from gearcam.laws.ratio.span import OPEN, Lobes, Span, open_travel, span_of

_TWO_WAYS: Final = "y with x_from and x_to, or slide with rod"


@dataclass(frozen=True, kw_only=True)
class MotionLaw(ShortRepr):
    """The position y(x) of the driven element, or of a slide that the driven crank moves.

    With y the driver turns in proportion to x and the driven wheel in proportion to y: ``phi1 =
    k1*(x - x_from)``, ``phi2 = k2*(y - y(x_from))``, so that ``i21 = k2*y'/k1``. Both scales follow
    from `driver_travel` and `driven_travel`, or from closure. With slide(phi1) the driven wheel
    turns with the crank. In Python y and slide may be functions, or tuples of a function and its
    first derivatives.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.MotionLaw(
    ...     y="x + x**2/10", x_from=0.0, x_to=2.0, driver_travel=3.0, driven_travel=3.0
    ... )
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="position", law=law, pair=pair))
    >>> result.motion([0.0, 1.0])["ratio"].round(4)
    array([0.8333, 0.9444])
    """

    y: Given | None = param(
        TEXT, default=None, function=True, doc="y of the driven element over x, at any scale"
    )
    x_from: float | None = param(NUMBER, default=None, doc="x at the start")
    x_to: float | None = param(NUMBER, default=None, doc="x at the end")
    slide: Given | None = param(
        TEXT,
        default=None,
        function=True,
        doc="instead of y: position of a slide over phi1, towards the crank, at any scale",
    )
    rod: float | None = param(
        NUMBER, default=None, gt=1, le=1e6, doc="length of the slide's rod, in crank radii"
    )
    driver_travel: float | None = open_travel("driver")
    driven_travel: float | None = open_travel("driven wheel")

    rules = (
        exactly_one("y", "slide"),
        needs("y", "x_from", "x_to"),
        needs("slide", "rod"),
        *(excludes(name, "slide", allowed=_TWO_WAYS) for name in ("x_from", "x_to")),
        excludes("rod", "y", allowed=_TWO_WAYS),
        excludes("driven_travel", "slide", allowed="a travel with y: a crank makes full turns"),
        *OPEN,
    )

    def problems(self) -> Iterator[Breach]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        yield from formula_problems("y", self.y, "x")
        yield from formula_problems("slide", self.slide)
        if self.x_from is not None and self.x_from == self.x_to:
            yield "x_to", None, "is x_from", "another x"

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If y or the slide is not finite, smooth, monotonic or periodic.
        """
        if self.slide is not None:
            return self._from_slide(lobes, tolerances)
        span = span_of(lobes, self.driver_travel, self.driven_travel)
        return self._from_y(span, tolerances)

    def _from_y(self, span: Span, tolerances: Tolerances) -> RatioLaw:
        start, end = float(self.x_from or 0.0), float(self.x_to or 0.0)
        per_angle = (end - start) / span.period
        axis = Axis(
            name="y",
            low=min(start, end),
            high=max(start, end),
            place=lambda x: f"x = {formatted(x, 10)}",
            variable="x",
        )
        shape = function_of(self.y or "", axis, tolerances.expansion)
        ends = values_of(shape)(np.array([start, end]))
        rise = float(ends[1] - ends[0])
        if not math.isfinite(rise) or rise == 0.0:
            what = "y is not finite" if rise else "y is the same at both ends"
            raise InfeasibleError(what, where="law.y", value=rise)
        scale = span.advance / rise
        solved = {
            "k1_deg_per_x": math.degrees(1.0 / per_angle),
            "k2_deg_per_y": math.degrees(scale),
        }
        law = from_phi2(lambda x: scale * shape(start + per_angle * x), span, tolerances, solved)
        errors = tuple(
            abs(scale) * abs(per_angle) ** k * each for k, each in enumerate(shape.errors)
        )
        return replace(law, function_errors=errors)

    def _from_slide(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        if lobes.n2 != 1:
            what = "a crank turns once for each motion of its slide"
            note = (
                "the driver needs the tooth count of the driven wheel or a multiple "
                "of it, and the pair is external"
            )
            raise beyond_limit(what, "pair.teeth", float(lobes.n2), 1.0, note)
        axis = replace(axis_of("slide", lobes.period), series=True)
        shape = function_of(self.slide or "", axis, tolerances.expansion)
        slide, radius = make_slide(shape, float(self.rod or 0.0), lobes.period)
        knots, pieces, start = crank_angle(slide)
        solved = {
            "crank_radius_over_slide_unit": radius,
            "crank_angle_at_start_deg": math.degrees(start),
        }
        law = make_law(lobes, knots, pieces, tolerances, solved)
        errors = tuple(each / (radius * NARROWEST) for each in shape.errors)
        return replace(law, function_errors=errors)


ENTRIES: Final = (
    LawEntry(
        name="motion",
        example=MotionLaw(
            y="x + x**2/10", x_from=0.0, x_to=2.0, driver_travel=math.pi, driven_travel=math.pi
        ),
        doc="position y(x) of the driven element, or of a slide that the driven crank moves",
        continuity="analytic if the formula is",
        source="Niculescu, Table 1.1, second hypothesis; section 1.4.1",
    ),
)
