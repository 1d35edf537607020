"""Logarithmic spirals: open wheels whose radii grow by the same share in every equal angle."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.errors import InfeasibleError
from gearcam.laws.entry import LawEntry
from gearcam.laws.ratio.base import LAWS, RatioLaw, make_law
from gearcam.laws.ratio.span import Lobes, Travel, demand_equal, spiral
from gearcam.quantities import ANGLE, NUMBER, param
from gearcam.tolerances import Tolerances


@dataclass(frozen=True, kw_only=True)
class LogSpiral:
    """``r1 = r1(0)*exp(k*phi1)``; its mate is a spiral of the same k, growing the other way.

    With ``u = r1/A = i/(1 + i)`` at both ends, the driven wheel turns by
    ``ln((1 - u0)/(1 - u1))/k`` and the driver by ``ln(u1/u0)/k``, so that its travel gives k.
    """

    ratios: tuple[float, float] = param(NUMBER, gt=0, doc="i21 at the start and at the end")
    driven_travel: float = param(ANGLE, gt=0, le=360, doc="how far the driven wheel turns")

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            For unequal tooth counts or equal ratios.
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
        first = start / (1.0 + start)
        growth = math.log((1.0 + end) / (1.0 + start)) / self.driven_travel
        travel = math.log(end / start * (1.0 + start) / (1.0 + end)) / growth

        solved = {"growth_per_rad": growth, "driver_travel_deg": math.degrees(travel)}
        span = Travel(travel, self.driven_travel)
        return make_law(span, [0.0, travel], [spiral(first, growth)], tolerances, solved)


LAWS.register(
    LawEntry(
        name="log-spiral",
        example=LogSpiral(ratios=(0.5, 2.0), driven_travel=2.0),
        doc="logarithmic spirals on an open pair, from one ratio to another",
        continuity="analytic",
        source="003 fig. 1.9; classical",
    ),
)
