"""Elliptical wheels turning about a focus: two equal ellipses roll on each other."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.errors import InfeasibleError
from gearcam.laws.base import Claim, LawEntry, Lobes, RatioLaw, make_law, register
from gearcam.numeric.jets import Jet, atan, cos, sin
from gearcam.numeric.piecewise import Piece
from gearcam.quantities import NUMBER, param
from gearcam.tolerances import Tolerances


@dataclass(frozen=True, kw_only=True)
class Ellipse:
    """The driver's near vertex lies at phi1 = 0; the centre distance is the major axis 2a.

    With ``r1 = a*(1 - e^2)/(1 + e*cos(phi1))`` and ``r2 = 2*a - r1`` the ratio is
    ``(1 - e^2)/(1 + e^2 + 2*e*cos(phi1))``, and ``tan(phi2/2) = (1-e)/(1+e)*tan(phi1/2)``, here in
    the equal form without a pole, ``phi2 = phi1 - 2*atan(e*sin(phi1)/(1 + e*cos(phi1)))``.
    """

    eccentricity: float = param(NUMBER, ge=0, lt=1, doc="eccentricity of the ellipse")

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            For unequal tooth counts: an ellipse about its focus rolls on its like only.
        """
        if lobes != Lobes(1, 1):
            raise InfeasibleError(
                "an ellipse about its focus rolls on an equal ellipse only",
                where="pair.teeth",
                value=lobes.n1 / lobes.n2,
                limit=1.0,
                nearest="give equal tooth counts",
            )
        e = self.eccentricity

        def ratio(x: Jet) -> Jet:
            return (1.0 - e * e) / (2.0 * e * cos(x) + (1.0 + e * e))

        def motion(x: Jet) -> Jet:
            return x - 2.0 * atan(e * sin(x) / (1.0 + e * cos(x)))

        return make_law(lobes, [0.0, lobes.period], [Piece(ratio, motion)], tolerances)


def _claims() -> tuple[Claim, ...]:
    half = 2.0 * math.atan(0.25 / 1.75 * math.tan(0.5))
    return (
        Claim(
            parameters=Ellipse(eccentricity=0.5),
            ratio={0.0: 1 / 3, math.pi: 3.0, math.pi / 2: 0.6},
            motion={math.pi: math.pi, math.pi / 2: 2 * math.atan(1 / 3), 2 * math.pi: 2 * math.pi},
            continuity=3,
        ),
        Claim(
            parameters=Ellipse(eccentricity=0.75),
            ratio={0.0: 1 / 7, math.pi: 7.0},
            motion={1.0: half, 2 * math.pi + 1.0: 2 * math.pi + half},
            continuity=3,
        ),
    )


register(
    LawEntry(
        name="ellipse",
        parameters=Ellipse,
        doc="equal ellipses about their foci, phi1 = 0 at the driver's near vertex",
        continuity="analytic",
        source="classical; polar equation of the ellipse about its focus",
        claims=_claims,
    )
)
