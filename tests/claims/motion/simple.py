"""What the motion laws of `gearcam.laws.motion.simple` must give, and random ones."""

from __future__ import annotations

import math

from claims.claim import MotionClaim, MotionClaims
from gearcam.laws.motion.simple import (
    ConstantAcceleration,
    ConstantVelocity,
    Cycloidal,
    Harmonic,
    SineTrapezoidalVelocity,
    TrapezoidalAcceleration,
    TrapezoidalVelocity,
)


def constant_velocity() -> tuple[MotionClaim, ...]:
    return (
        MotionClaim(
            parameters=ConstantVelocity(),
            values={0.0: 0.0, 0.3: 0.3, 0.75: 0.75, 1.0: 1.0},
            velocities={0.0: 1.0, 0.5: 1.0, 1.0: 1.0},
            peak_velocity=1.0,
            peak_acceleration=math.inf,
            peak_jerk=math.inf,
            continuity=0,
        ),
    )


def constant_acceleration() -> tuple[MotionClaim, ...]:
    """000 fig. 3.13; the velocity's triangle is 2 high whatever q."""
    return (
        MotionClaim(
            parameters=ConstantAcceleration(),
            values={0.25: 0.125, 0.5: 0.5, 0.75: 0.875},
            velocities={0.25: 1.0, 0.5: 2.0, 0.75: 1.0},
            peak_velocity=2.0,
            peak_acceleration=4.0,
            peak_jerk=math.inf,
            continuity=1,
        ),
        MotionClaim(
            parameters=ConstantAcceleration(q=0.8),
            values={0.4: 0.2, 0.8: 0.8, 0.9: 0.95},
            velocities={0.4: 1.0, 0.8: 2.0, 0.9: 1.0},
            peak_velocity=2.0,
            peak_acceleration=10.0,
            peak_jerk=math.inf,
            continuity=1,
        ),
    )


def harmonic() -> tuple[MotionClaim, ...]:
    return (
        MotionClaim(
            parameters=Harmonic(),
            values={1 / 3: 0.25, 0.5: 0.5, 2 / 3: 0.75},
            velocities={0.0: 0.0, 1 / 6: math.pi / 4, 0.5: math.pi / 2},
            peak_velocity=math.pi / 2,
            peak_acceleration=math.pi**2 / 2,
            peak_jerk=math.inf,
            continuity=1,
        ),
    )


def cycloidal() -> tuple[MotionClaim, ...]:
    quarter = 0.25 - 0.5 / math.pi
    return (
        MotionClaim(
            parameters=Cycloidal(),
            values={0.25: quarter, 0.5: 0.5, 0.75: 1.0 - quarter},
            velocities={0.0: 0.0, 0.25: 1.0, 0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=2 * math.pi,
            peak_jerk=4 * math.pi**2,
            continuity=2,
        ),
    )


def trapezoidal_velocity() -> tuple[MotionClaim, ...]:
    """Areas under the trapezoid; q = 1/2 is constant acceleration."""
    return (
        MotionClaim(
            parameters=TrapezoidalVelocity(),
            values={0.0625: 1 / 56, 0.125: 1 / 14, 0.5: 0.5, 0.875: 13 / 14},
            velocities={0.0625: 4 / 7, 0.125: 8 / 7, 0.6: 8 / 7},
            peak_velocity=8 / 7,
            peak_acceleration=64 / 7,
            peak_jerk=math.inf,
            continuity=1,
        ),
        MotionClaim(
            parameters=TrapezoidalVelocity(q=0.5),
            values={0.25: 0.125, 0.5: 0.5, 0.75: 0.875},
            velocities={0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=4.0,
            peak_jerk=math.inf,
            continuity=1,
        ),
    )


def sine_trapezoidal_velocity() -> tuple[MotionClaim, ...]:
    """Where S' is half way up the sine, S is that of a straight line; q = 1/2 is cycloidal."""
    quarter = 0.25 - 0.5 / math.pi
    return (
        MotionClaim(
            parameters=SineTrapezoidalVelocity(),
            values={0.125: 1 / 14, 0.5: 0.5, 0.875: 13 / 14},
            velocities={0.0625: 4 / 7, 0.125: 8 / 7, 0.9375: 4 / 7},
            peak_velocity=8 / 7,
            peak_acceleration=32 * math.pi / 7,
            peak_jerk=256 * math.pi**2 / 7,
            continuity=2,
        ),
        MotionClaim(
            parameters=SineTrapezoidalVelocity(q=0.5),
            values={0.25: quarter, 0.5: 0.5, 0.75: 1.0 - quarter},
            velocities={0.25: 1.0, 0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=2 * math.pi,
            peak_jerk=4 * math.pi**2,
            continuity=2,
        ),
    )


def trapezoidal_acceleration() -> tuple[MotionClaim, ...]:
    """000 fig. 3.22: A = 16/3, B1 = 1/3, B2 = 1/72, C1 = 5/3, C2 = 19/72; then two triangles."""
    return (
        MotionClaim(
            parameters=TrapezoidalAcceleration(),
            values={0.125: 1 / 72, 0.375: 19 / 72, 0.5: 0.5, 0.625: 53 / 72},
            velocities={0.125: 1 / 3, 0.375: 5 / 3, 0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=16 / 3,
            peak_jerk=128 / 3,
            continuity=2,
        ),
        MotionClaim(
            parameters=TrapezoidalAcceleration(q=0.25),
            values={0.25: 1 / 12, 0.5: 0.5, 0.75: 11 / 12},
            velocities={0.25: 1.0, 0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=8.0,
            peak_jerk=32.0,
            continuity=2,
        ),
    )


CLAIMS = {
    "constant-velocity": MotionClaims(values=constant_velocity()),
    "constant-acceleration": MotionClaims(values=constant_acceleration(), usual={"q": (0.02, 0.9)}),
    "harmonic": MotionClaims(values=harmonic()),
    "cycloidal": MotionClaims(values=cycloidal()),
    "trapezoidal-velocity": MotionClaims(values=trapezoidal_velocity(), usual={"q": (0.02, 0.5)}),
    "sine-trapezoidal-velocity": MotionClaims(
        values=sine_trapezoidal_velocity(), usual={"q": (0.02, 0.5)}
    ),
    "trapezoidal-acceleration": MotionClaims(
        values=trapezoidal_acceleration(), usual={"q": (0.02, 0.25)}
    ),
}
