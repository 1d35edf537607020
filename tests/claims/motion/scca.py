"""What the motion laws of `gearcam.laws.motion.scca` must give, and random ones."""

from __future__ import annotations

import math

from claims.claim import MotionClaim, MotionClaims
from gearcam.laws.motion.scca import ModifiedSine, ModifiedTrapezoid, Scca
from random_designs.draw import Draw, short
from random_designs.law_draw import Law


def scca() -> tuple[MotionClaim, ...]:
    """Norton's Ca, Cv, Cj, from another elimination than the code's; and a member of each kind."""
    pi = math.pi
    claims = []
    for b, c, d in ((0.2, 0.5, 0.3), (0.3, 0.6, 0.1), (0.6, 0.0, 0.4)):
        bottom = (pi**2 - 8) * (b * b - d * d) - 2 * pi * (pi - 2) * b + pi**2
        peak = 4 * pi**2 / bottom
        claims.append(
            MotionClaim(
                parameters=Scca(b=b, c=c, d=d),
                values={b / 2: peak * (b / pi) ** 2 * (pi / 2 - 1), 0.5: 0.5},
                velocities={b / 2: peak * b / pi, (b + c) / 2: peak * (b / pi + c / 2)},
                peak_velocity=peak * ((b + d) / pi + c / 2),
                peak_acceleration=peak,
                peak_jerk=peak * pi / min(b, d),
                continuity=2,
            )
        )
    parabolas = MotionClaim(
        parameters=Scca(b=0.0, c=1.0, d=0.0),
        values={0.25: 0.125, 0.5: 0.5, 0.75: 0.875},
        velocities={0.25: 1.0, 0.5: 2.0},
        peak_velocity=2.0,
        peak_acceleration=4.0,
        peak_jerk=math.inf,
        continuity=1,
    )
    # all sine: two cycloidal halves that meet with a jump of the acceleration
    sines = MotionClaim(
        parameters=Scca(b=1.0, c=0.0, d=0.0),
        values={0.5: 0.5},
        velocities={0.5: pi / (pi - 2)},
        peak_velocity=pi / (pi - 2),
        peak_acceleration=pi**2 / (pi - 2),
        peak_jerk=math.inf,
        continuity=1,
    )
    return (*claims, parabolas, sines)


def modified_trapezoid() -> tuple[MotionClaim, ...]:
    pi = math.pi
    eighth = (pi - 2) / (4 * pi * (pi + 2))
    return (
        MotionClaim(
            parameters=ModifiedTrapezoid(),
            values={0.125: eighth, 0.375: eighth + 0.25, 0.5: 0.5, 0.625: 0.75 - eighth},
            velocities={0.125: 2 / (pi + 2), 0.375: 2 * (pi + 1) / (pi + 2), 0.5: 2.0},
            peak_velocity=2.0,
            peak_acceleration=8 * pi / (pi + 2),
            peak_jerk=32 * pi**2 / (pi + 2),
            continuity=2,
        ),
    )


def modified_sine() -> tuple[MotionClaim, ...]:
    """``S = (2 + pi*phi - (9/4)*sin((4*phi + 1)*pi/3))/(pi + 4)`` from 1/8 to 7/8."""
    pi = math.pi
    quarter = (2 + pi / 4 - 9 * math.sqrt(3) / 8) / (pi + 4)
    return (
        MotionClaim(
            parameters=ModifiedSine(),
            values={0.125: (pi - 2) / (8 * (pi + 4)), 0.25: quarter, 0.5: 0.5, 0.75: 1 - quarter},
            velocities={0.125: pi / (pi + 4), 0.25: 2.5 * pi / (pi + 4), 0.5: 4 * pi / (pi + 4)},
            peak_velocity=4 * pi / (pi + 4),
            peak_acceleration=4 * pi**2 / (pi + 4),
            peak_jerk=16 * pi**3 / (pi + 4),
            continuity=2,
        ),
    )


def any_scca(d: Draw) -> Law:
    b, c, _ = d.shares(3, 0.05)
    b, c = short(b), short(c)
    return {"b": b, "c": c, "d": 1.0 - b - c}


CLAIMS = {
    "scca": MotionClaims(values=scca(), draw=any_scca),
    "modified-trapezoid": MotionClaims(values=modified_trapezoid()),
    "modified-sine": MotionClaims(values=modified_sine()),
}
