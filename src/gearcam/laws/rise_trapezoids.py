"""Rises with straight parts: trapezoids of velocity and of acceleration."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcam.laws.rise_pieces import from_half, lag
from gearcam.laws.rises import NARROWEST, RISES, ClosedForm, RiseClaim, RiseEntry
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


def _claims_velocity() -> tuple[RiseClaim, ...]:
    """Areas under the trapezoid; q = 1/2 is constant acceleration."""
    return (
        RiseClaim(
            parameters=TrapezoidalVelocity(),
            values={0.0625: 1 / 56, 0.125: 1 / 14, 0.5: 0.5, 0.875: 13 / 14},
            velocities={0.0625: 4 / 7, 0.125: 8 / 7, 0.6: 8 / 7},
            peak_velocity=8 / 7,
            peak_acceleration=64 / 7,
            peak_jerk=math.inf,
            continuity=1,
        ),
        RiseClaim(
            parameters=TrapezoidalVelocity(q=0.5),
            values={0.25: 0.125, 0.5: 0.5, 0.75: 0.875},
            velocities={0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=4.0,
            peak_jerk=math.inf,
            continuity=1,
        ),
    )


def _claims_sine_velocity() -> tuple[RiseClaim, ...]:
    """Where S' is half way up the sine, S is that of a straight line; q = 1/2 is cycloidal."""
    quarter = 0.25 - 0.5 / math.pi
    return (
        RiseClaim(
            parameters=SineTrapezoidalVelocity(),
            values={0.125: 1 / 14, 0.5: 0.5, 0.875: 13 / 14},
            velocities={0.0625: 4 / 7, 0.125: 8 / 7, 0.9375: 4 / 7},
            peak_velocity=8 / 7,
            peak_acceleration=32 * math.pi / 7,
            peak_jerk=256 * math.pi**2 / 7,
            continuity=2,
        ),
        RiseClaim(
            parameters=SineTrapezoidalVelocity(q=0.5),
            values={0.25: quarter, 0.5: 0.5, 0.75: 1.0 - quarter},
            velocities={0.25: 1.0, 0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=2 * math.pi,
            peak_jerk=4 * math.pi**2,
            continuity=2,
        ),
    )


def _claims_acceleration() -> tuple[RiseClaim, ...]:
    """000 fig. 3.22: A = 16/3, B1 = 1/3, B2 = 1/72, C1 = 5/3, C2 = 19/72; then two triangles."""
    return (
        RiseClaim(
            parameters=TrapezoidalAcceleration(),
            values={0.125: 1 / 72, 0.375: 19 / 72, 0.5: 0.5, 0.625: 53 / 72},
            velocities={0.125: 1 / 3, 0.375: 5 / 3, 0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=16 / 3,
            peak_jerk=128 / 3,
            continuity=2,
        ),
        RiseClaim(
            parameters=TrapezoidalAcceleration(q=0.25),
            values={0.25: 1 / 12, 0.5: 0.5, 0.75: 11 / 12},
            velocities={0.25: 1.0, 0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=8.0,
            peak_jerk=32.0,
            continuity=2,
        ),
    )


RISES.hang(
    RiseEntry(
        name="trapezoidal-velocity",
        parameters=TrapezoidalVelocity,
        doc="even speed over most of the way without a blow: feeds and winding, slow to medium",
        continuity="C1: the acceleration jumps at both ends and where the speed becomes even",
        source="000 section 3.3.3.3, fig. 3.20",
        claims=_claims_velocity,
    )
)
RISES.hang(
    RiseEntry(
        name="sine-trapezoidal-velocity",
        parameters=SineTrapezoidalVelocity,
        doc="even speed over most of the way, smooth to start and stop: faster cams, cut with care",
        continuity="C2: the jerk jumps at both ends and where the speed becomes even",
        source="000 section 3.3.3.3, fig. 3.21 (S' of its third sector is to read with a plus)",
        claims=_claims_sine_velocity,
    )
)
RISES.hang(
    RiseEntry(
        name="trapezoidal-acceleration",
        parameters=TrapezoidalAcceleration,
        doc="low peak acceleration without a jump: all speeds, easier to cut than cycloidal",
        continuity="C2: the jerk jumps at the ends of the sectors",
        source="000 section 3.3.3.3, fig. 3.22; Neklutin",
        claims=_claims_acceleration,
    )
)
