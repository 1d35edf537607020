"""What rises must give; those of one polynomial stand in `claims.of_polynomials`."""

from __future__ import annotations

import math
from dataclasses import replace

from claims.claim import RiseClaim
from claims.of_polynomials import POLYNOMIALS
from gearcam.laws.rises.base import RiseParameters
from gearcam.laws.rises.formula import FormulaRise
from gearcam.laws.rises.points import BSplineRise, TableRise
from gearcam.laws.rises.scca import ModifiedSine, ModifiedTrapezoid, Scca
from gearcam.laws.rises.simple import (
    ConstantAcceleration,
    ConstantVelocity,
    Cycloidal,
    Harmonic,
    SineTrapezoidalVelocity,
    TrapezoidalAcceleration,
    TrapezoidalVelocity,
)


def _quintic(parameters: RiseParameters) -> RiseClaim:
    """Return what is claimed of ``10*x^3 - 15*x^4 + 6*x^5``, whatever makes it."""
    return RiseClaim(
        parameters=parameters,
        values={0.25: 53 / 512, 0.5: 0.5, 0.75: 459 / 512},
        velocities={0.25: 270 / 256, 0.5: 1.875},
        peak_velocity=1.875,
        peak_acceleration=10 / math.sqrt(3),
        peak_jerk=60.0,
        continuity=2,
    )


def formula() -> tuple[RiseClaim, ...]:
    quarter = 0.25 - 0.5 / math.pi
    swing = math.tanh(2.0)
    cycloidal = RiseClaim(
        parameters=FormulaRise(formula="x - sin(2*pi*x)/(2*pi)"),
        values={0.25: quarter, 0.5: 0.5, 0.75: 1.0 - quarter},
        velocities={0.25: 1.0, 0.5: 2.0},
        peak_velocity=2.0,
        peak_acceleration=2 * math.pi,
        peak_jerk=4 * math.pi**2,
        continuity=2,
    )
    quintic = _quintic(FormulaRise(formula="x**3*(10 - 15*x + 6*x**2)"))
    rough = RiseClaim(
        parameters=FormulaRise(formula="(1 + tanh(4*x - 2)/tanh(2))/2"),
        values={0.5: 0.5, 0.75: 0.5 + math.tanh(1.0) / (2 * swing)},
        velocities={0.5: 2.0 / swing, 0.75: 2.0 / (swing * math.cosh(1.0) ** 2)},
        peak_velocity=2.0 / swing,
        peak_acceleration=math.inf,
        peak_jerk=math.inf,
        continuity=0,
    )
    sine = FormulaRise(formula=lambda x: x - math.sin(2 * math.pi * x) / (2 * math.pi))
    powers = FormulaRise(formula=lambda x: x**3 * (10 - 15 * x + 6 * x**2))
    same = replace(cycloidal, parameters=sine), replace(quintic, parameters=powers)
    return (cycloidal, quintic, rough, *same)


def b_spline() -> tuple[RiseClaim, ...]:
    """One span is the 3-4-5; two spans of degree 4 have ``S = 8*phi^3*(1 - phi)`` up to 1/2."""
    one = _quintic(BSplineRise(control=(0.0, 0.0, 0.0, 1.0, 1.0, 1.0), degree=5))
    # velocity 24*phi^2 - 32*phi^3, acceleration 48*phi*(1 - 2*phi), jerk 48 - 192*phi
    two = RiseClaim(
        parameters=BSplineRise(control=(0.0, 0.0, 0.0, 1.0, 1.0, 1.0)),
        values={0.25: 3 / 32, 0.5: 0.5, 0.75: 29 / 32},
        velocities={0.25: 1.0, 0.5: 2.0, 0.75: 1.0},
        peak_velocity=2.0,
        peak_acceleration=6.0,
        peak_jerk=48.0,
        continuity=2,
    )
    return one, two


def table() -> tuple[RiseClaim, ...]:
    """Return splines that reproduce their curve: a quintic, and a line with its slopes."""
    places = (0.0, 0.1, 0.3, 0.35, 0.7, 1.0)
    quintic = _quintic(
        TableRise(x=places, y=tuple(x**3 * (10 - 15 * x + 6 * x * x) for x in places))
    )
    line = RiseClaim(
        parameters=TableRise(
            x=(0.0, 0.4, 1.0), y=(0.0, 0.4, 1.0), start=(1.0, 0.0), end=(1.0, 0.0)
        ),
        values={0.2: 0.2, 0.7: 0.7},
        velocities={0.2: 1.0, 0.7: 1.0},
        peak_velocity=1.0,
        peak_acceleration=math.inf,
        peak_jerk=math.inf,
        continuity=0,
    )
    return quintic, line


def scca() -> tuple[RiseClaim, ...]:
    """Norton's Ca, Cv, Cj, from another elimination than the code's; and a member of each kind."""
    pi = math.pi
    claims = []
    for b, c, d in ((0.2, 0.5, 0.3), (0.3, 0.6, 0.1), (0.6, 0.0, 0.4)):
        bottom = (pi**2 - 8) * (b * b - d * d) - 2 * pi * (pi - 2) * b + pi**2
        peak = 4 * pi**2 / bottom
        claims.append(
            RiseClaim(
                parameters=Scca(b=b, c=c, d=d),
                values={b / 2: peak * (b / pi) ** 2 * (pi / 2 - 1), 0.5: 0.5},
                velocities={b / 2: peak * b / pi, (b + c) / 2: peak * (b / pi + c / 2)},
                peak_velocity=peak * ((b + d) / pi + c / 2),
                peak_acceleration=peak,
                peak_jerk=peak * pi / min(b, d),
                continuity=2,
            )
        )
    parabolas = RiseClaim(
        parameters=Scca(b=0.0, c=1.0, d=0.0),
        values={0.25: 0.125, 0.5: 0.5, 0.75: 0.875},
        velocities={0.25: 1.0, 0.5: 2.0},
        peak_velocity=2.0,
        peak_acceleration=4.0,
        peak_jerk=math.inf,
        continuity=1,
    )
    # all sine: two cycloidal halves that meet with a jump of the acceleration
    sines = RiseClaim(
        parameters=Scca(b=1.0, c=0.0, d=0.0),
        values={0.5: 0.5},
        velocities={0.5: pi / (pi - 2)},
        peak_velocity=pi / (pi - 2),
        peak_acceleration=pi**2 / (pi - 2),
        peak_jerk=math.inf,
        continuity=1,
    )
    return (*claims, parabolas, sines)


def modified_trapezoid() -> tuple[RiseClaim, ...]:
    pi = math.pi
    eighth = (pi - 2) / (4 * pi * (pi + 2))
    return (
        RiseClaim(
            parameters=ModifiedTrapezoid(),
            values={0.125: eighth, 0.375: eighth + 0.25, 0.5: 0.5, 0.625: 0.75 - eighth},
            velocities={0.125: 2 / (pi + 2), 0.375: 2 * (pi + 1) / (pi + 2), 0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=8 * pi / (pi + 2),
            peak_jerk=32 * pi**2 / (pi + 2),
            continuity=2,
        ),
    )


def modified_sine() -> tuple[RiseClaim, ...]:
    """``S = (2 + pi*phi - (9/4)*sin((4*phi + 1)*pi/3))/(pi + 4)`` from 1/8 to 7/8."""
    pi = math.pi
    quarter = (2 + pi / 4 - 9 * math.sqrt(3) / 8) / (pi + 4)
    return (
        RiseClaim(
            parameters=ModifiedSine(),
            values={0.125: (pi - 2) / (8 * (pi + 4)), 0.25: quarter, 0.5: 0.5, 0.75: 1 - quarter},
            velocities={0.125: pi / (pi + 4), 0.25: 2.5 * pi / (pi + 4), 0.5: 4 * pi / (pi + 4)},
            peak_velocity=4 * pi / (pi + 4),
            peak_acceleration=4 * pi**2 / (pi + 4),
            peak_jerk=16 * pi**3 / (pi + 4),
            continuity=2,
        ),
    )


def constant_velocity() -> tuple[RiseClaim, ...]:
    return (
        RiseClaim(
            parameters=ConstantVelocity(),
            values={0.0: 0.0, 0.3: 0.3, 0.75: 0.75, 1.0: 1.0},
            velocities={0.0: 1.0, 0.5: 1.0, 1.0: 1.0},
            peak_velocity=1.0,
            peak_acceleration=math.inf,
            peak_jerk=math.inf,
            continuity=0,
        ),
    )


def constant_acceleration() -> tuple[RiseClaim, ...]:
    """000 fig. 3.13; the velocity's triangle is 2 high whatever q."""
    return (
        RiseClaim(
            parameters=ConstantAcceleration(),
            values={0.25: 0.125, 0.5: 0.5, 0.75: 0.875},
            velocities={0.25: 1.0, 0.5: 2.0, 0.75: 1.0},
            peak_velocity=2.0,
            peak_acceleration=4.0,
            peak_jerk=math.inf,
            continuity=1,
        ),
        RiseClaim(
            parameters=ConstantAcceleration(q=0.8),
            values={0.4: 0.2, 0.8: 0.8, 0.9: 0.95},
            velocities={0.4: 1.0, 0.8: 2.0, 0.9: 1.0},
            peak_velocity=2.0,
            peak_acceleration=10.0,
            peak_jerk=math.inf,
            continuity=1,
        ),
    )


def harmonic() -> tuple[RiseClaim, ...]:
    return (
        RiseClaim(
            parameters=Harmonic(),
            values={1 / 3: 0.25, 0.5: 0.5, 2 / 3: 0.75},
            velocities={0.0: 0.0, 1 / 6: math.pi / 4, 0.5: math.pi / 2},
            peak_velocity=math.pi / 2,
            peak_acceleration=math.pi**2 / 2,
            peak_jerk=math.inf,
            continuity=1,
        ),
    )


def cycloidal() -> tuple[RiseClaim, ...]:
    quarter = 0.25 - 0.5 / math.pi
    return (
        RiseClaim(
            parameters=Cycloidal(),
            values={0.25: quarter, 0.5: 0.5, 0.75: 1.0 - quarter},
            velocities={0.0: 0.0, 0.25: 1.0, 0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=2 * math.pi,
            peak_jerk=4 * math.pi**2,
            continuity=2,
        ),
    )


def trapezoidal_velocity() -> tuple[RiseClaim, ...]:
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


def sine_trapezoidal_velocity() -> tuple[RiseClaim, ...]:
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


def trapezoidal_acceleration() -> tuple[RiseClaim, ...]:
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


RISE_CLAIMS: dict[str, tuple[RiseClaim, ...]] = {
    **POLYNOMIALS,
    "formula": formula(),
    "b-spline": b_spline(),
    "table": table(),
    "scca": scca(),
    "modified-trapezoid": modified_trapezoid(),
    "modified-sine": modified_sine(),
    "constant-velocity": constant_velocity(),
    "constant-acceleration": constant_acceleration(),
    "harmonic": harmonic(),
    "cycloidal": cycloidal(),
    "trapezoidal-velocity": trapezoidal_velocity(),
    "sine-trapezoidal-velocity": sine_trapezoidal_velocity(),
    "trapezoidal-acceleration": trapezoidal_acceleration(),
}
