"""Elliptical wheels turning about a focus, and such wheels of higher order, with more lobes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from gearcam.base.quantities import COUNT, NUMBER, WHEELS, param
from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import LawEntry
from gearcam.laws.ratio.base import RatioLaw, make_law
from gearcam.laws.ratio.span import LOBES, Lobes, demand_lobes
from gearcam.numeric.jets import Jet, atan, cos, sin
from gearcam.numeric.piecewise import Piece


@dataclass(frozen=True, kw_only=True)
class Ellipse:
    """``r1 = p/(1 + e*cos(n1*phi1))``: the near vertex of the driver is at phi1 = 0.

    With the semi-latus rectum p = 1 and the centre distance A the ratio is ``1/(b +
    A*e*cos(n1*phi1))``, ``b = A - w`` (w = 1 for a wheel as mate, -1 for a ring), and its integral
    over a lobe is the driven wheel's where ``b^2 - (A*e)^2 = (n2/n1)^2``. For one lobe each,
    ``A = 2*a``: two equal ellipses.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.Ellipse(eccentricity=0.3)
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="ellipse", law=law, pair=pair))
    >>> result.motion([0.0, 3.141592653589793])["ratio"].round(4)
    array([0.5385, 1.8571])
    """

    eccentricity: float = param(
        NUMBER, ge=0, lt=1, constant_at=0, doc="eccentricity of the ellipse"
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
        count, e = demand_lobes(self.lobes, lobes), self.eccentricity
        k, w = lobes.n2 / lobes.n1, lobes.mate
        # A^2*(1 - e^2) - 2*w*A + 1 - k^2 = 0: the positive root
        flat = (1.0 - e) * (1.0 + e)
        distance = (w + math.sqrt(e * e + flat * k * k)) / flat
        b, swing = distance - w, distance * e
        least = k * k / (b + swing)  # b - swing, which are nearly equal in long ellipses

        def ratio(x: Jet) -> Jet:
            half = cos((0.5 * count) * x)
            return 1.0 / (2.0 * swing * half * half + least)

        def phi2(x: Jet) -> Jet:
            # tan(n2*phi2/2) = sqrt((b - A*e)/(b + A*e))*tan(n1*phi1/2) without its poles
            turn = 2.0 * atan(swing * sin(count * x) / (swing * cos(count * x) + (b + k)))
            return (x - turn / count) / k

        solved = {"center_distance_over_semi_latus_rectum": distance}
        piece = Piece(ratio, phi2)
        return make_law(lobes, [0.0, lobes.period], [piece], tolerances, solved)


ENTRIES: Final = (
    LawEntry(
        name="ellipse",
        example=Ellipse(eccentricity=0.5),
        doc="ellipses about a focus, or wheels of more lobes; phi1 = 0 at the nearest point",
        continuity="analytic",
        source="Litvin, Fuentes, chapter 12; centre distance in closed form",
    ),
)
