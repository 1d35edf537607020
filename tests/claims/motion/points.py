"""What the motion laws of `gearcam.laws.motion.points` must give, and random ones."""

from __future__ import annotations

import math

from claims.claim import MotionClaim, MotionClaims
from claims.motion.polynomials import of_quintic
from gearcam.laws.motion.points import BSplineRise, TableRise
from random_designs.draw import Draw, short
from random_designs.law_draw import Law


def b_spline() -> tuple[MotionClaim, ...]:
    """One span is the 3-4-5; two spans of degree 4 have ``S = 8*phi^3*(1 - phi)`` up to 1/2."""
    one = of_quintic(BSplineRise(control=(0.0, 0.0, 0.0, 1.0, 1.0, 1.0), degree=5))
    # velocity 24*phi^2 - 32*phi^3, acceleration 48*phi*(1 - 2*phi), jerk 48 - 192*phi
    two = MotionClaim(
        parameters=BSplineRise(control=(0.0, 0.0, 0.0, 1.0, 1.0, 1.0)),
        values={0.25: 3 / 32, 0.5: 0.5, 0.75: 29 / 32},
        velocities={0.25: 1.0, 0.5: 2.0, 0.75: 1.0},
        peak_velocity=2.0,
        peak_acceleration=6.0,
        peak_jerk=48.0,
        continuity=2,
    )
    return one, two


def table() -> tuple[MotionClaim, ...]:
    """Return splines that reproduce their curve: a quintic, and a line with its slopes."""
    places = (0.0, 0.1, 0.3, 0.35, 0.7, 1.0)
    quintic = of_quintic(
        TableRise(x=places, y=tuple(x**3 * (10 - 15 * x + 6 * x * x) for x in places))
    )
    line = MotionClaim(
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


def any_b_spline(d: Draw) -> Law:
    degree, flat = d.whole(3, 5), d.whole(1, 3)
    inner = sorted(d.even(0, 1) for _ in range(d.whole(2, 6)))
    control = [0.0] * flat + inner + [1.0] * flat
    return {"degree": min(degree, len(control) - 1), "control": control}


def any_table(d: Draw) -> Law:
    grid = [0.0]
    for share in d.shares(d.whole(4, 16), 0.5):
        grid.append(short(grid[-1] + share))
    grid[-1] = 1.0
    values = [short(x - math.sin(2 * math.pi * x) / (2 * math.pi)) for x in grid]
    law: Law = {"x": grid, "y": [*values[:-1], 1.0]}
    if d.chance(0.3):
        law["start"] = [d.even(0, 0.5), d.even(-1, 1)]
    return law


CLAIMS = {
    "b-spline": MotionClaims(values=b_spline(), draw=any_b_spline),
    "table": MotionClaims(values=table(), draw=any_table),
}
