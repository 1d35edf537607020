"""Rises with straight parts: trapezoids of velocity and of acceleration."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.laws.entry import LawEntry
from gearcam.laws.rises.base import NARROWEST, RISES, ClosedForm
from gearcam.laws.rises.pieces import from_half, lag
from gearcam.numeric.jets import Jet
from gearcam.numeric.piecewise import Piecewise
from gearcam.quantities import NUMBER, param


@dataclass(frozen=True, kw_only=True)
class TrapezoidalVelocity(ClosedForm):
    """Constant velocity ``1/(1 - q)`` between two sectors of constant acceleration, q wide each."""

    q: float = param(
        NUMBER, default=0.125, ge=NARROWEST, le=0.5, doc="part of the angle to reach full speed"
    )

    def function(self) -> Piecewise:
        """``S = phi^2/(2*q*(1 - q))``, then ``S = (phi - q/2)/(1 - q)``."""
        q, speed = self.q, 1.0 / (1.0 - self.q)
        return from_half(
            [
                (q, lambda x: (0.5 * speed / q) * (x * x)),
                (0.5 - q, lambda x: speed * (x - 0.5 * q)),
            ]
        )


@dataclass(frozen=True, kw_only=True)
class SineTrapezoidalVelocity(ClosedForm):
    """Constant velocity ``1/(1 - q)`` between two sectors of a half sine of acceleration."""

    q: float = param(
        NUMBER, default=0.125, ge=NARROWEST, le=0.5, doc="part of the angle to reach full speed"
    )

    def function(self) -> Piecewise:
        """``S = (phi - (q/pi)*sin(pi*phi/q))/(2*(1 - q))``, then ``S = (phi - q/2)/(1 - q)``."""
        q, speed = self.q, 1.0 / (1.0 - self.q)
        return from_half(
            [
                (q, lambda x: (0.5 * speed * q / math.pi) * lag((math.pi / q) * x)),
                (0.5 - q, lambda x: speed * (x - 0.5 * q)),
            ]
        )


@dataclass(frozen=True, kw_only=True)
class TrapezoidalAcceleration(ClosedForm):
    """Two trapezoids of acceleration, ``A = 4/(1 - 2*q)`` high, with flanks q wide."""

    q: float = param(
        NUMBER,
        default=0.125,
        ge=NARROWEST,
        le=0.25,
        doc="part of the angle in which the acceleration builds up",
    )

    def function(self) -> Piecewise:
        """S of the three sectors in which S'' rises, stays at A, and falls through zero."""
        q, top = self.q, 4.0 / (1.0 - 2.0 * self.q)
        flat = 0.5 - 2.0 * q
        v1, s1 = 0.5 * top * q, top * q * q / 6.0
        v2, s2 = v1 + top * flat, s1 + flat * (v1 + 0.5 * top * flat)

        def constant(x: Jet) -> Jet:
            t = x - q
            return t * (0.5 * top * t + v1) + s1

        def falling(x: Jet) -> Jet:
            t = x - (0.5 - q)
            return t * (t * ((-top / (6.0 * q)) * t + 0.5 * top) + v2) + s2

        rising = (q, lambda x: (top / (6.0 * q)) * (x * x * x))
        return from_half([rising, (flat, constant), (q, falling)])


RISES.register(
    LawEntry(
        name="trapezoidal-velocity",
        example=TrapezoidalVelocity(),
        doc="even speed over most of the way without a blow: feeds and winding, slow to medium",
        continuity="C1: the acceleration jumps at both ends and where the speed becomes even",
        source="000 section 3.3.3.3, fig. 3.20",
    ),
    LawEntry(
        name="sine-trapezoidal-velocity",
        example=SineTrapezoidalVelocity(),
        doc="even speed over most of the way, smooth to start and stop: faster cams, cut with care",
        continuity="C2: the jerk jumps at both ends and where the speed becomes even",
        source="000 section 3.3.3.3, fig. 3.21 (S' of its third sector is to read with a plus)",
    ),
    LawEntry(
        name="trapezoidal-acceleration",
        example=TrapezoidalAcceleration(),
        doc="low peak acceleration without a jump: all speeds, easier to cut than cycloidal",
        continuity="C2: the jerk jumps at the ends of the sectors",
        source="000 section 3.3.3.3, fig. 3.22; Neklutin",
    ),
)
