"""The ratio law of a universal joint, and the double harmonic motion law."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.base.quantities import ANGLE, param
from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import LawEntry
from gearcam.laws.motion.base import ClosedForm
from gearcam.laws.ratio.base import RatioLaw, make_law
from gearcam.laws.ratio.span import Lobes
from gearcam.numeric.jets import Jet, cos, sin
from gearcam.numeric.piecewise import Piece, Piecewise, piecewise


@dataclass(frozen=True, kw_only=True)
class UniversalJoint:
    """The ratio of a universal (Hooke's) joint: ``tan(phi2) = cos(b)*tan(phi1)``."""

    shaft_angle: float = param(ANGLE, ge=0, le=80, constant_at=0, doc="angle between the shafts")

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`."""
        c, n1, share = math.cos(self.shaft_angle), lobes.n1, lobes.n1 / lobes.n2

        def ratio(x: Jet) -> Jet:
            even, odd = cos(n1 * x), sin(n1 * x)
            return share * c / (even * even + c * c * odd * odd)

        return make_law(lobes, [0.0, lobes.period], [Piece(ratio)], tolerances)


JOINT = LawEntry(
    name="universal-joint",
    example=UniversalJoint(shaft_angle=math.radians(30)),
    doc="the ratio of a universal joint whose shafts meet at an angle",
    continuity="analytic",
    source="classical; closed form of the driven angle",
)


@dataclass(frozen=True, kw_only=True)
class DoubleHarmonic(ClosedForm):
    """Two harmonics: a rise from a dwell, whose return follows without a dwell."""

    mirrored = True

    def function(self) -> Piecewise:
        """``S = sin(pi*phi/2)^4``."""

        def rise(x: Jet) -> Jet:
            wave = sin((0.5 * math.pi) * x)
            square = wave * wave
            return square * square

        return piecewise([0.0, 1.0], [Piece(rise)])


DOUBLE = LawEntry(
    name="double-harmonic",
    example=DoubleHarmonic(),
    doc="rise and return without a dwell at the top; a return of the same law must follow",
    continuity="C2 if its return follows",
    source="Norton",
)
