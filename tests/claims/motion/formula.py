"""What the motion laws of `gearcam.laws.motion.formula` must give, and random ones."""

from __future__ import annotations

import math
from dataclasses import replace

from claims.claim import MotionClaim, MotionClaims
from claims.motion.polynomials import of_quintic
from gearcam.laws.motion.formula import FormulaRise
from random_designs.draw import Draw
from random_designs.law_draw import Law


def formula() -> tuple[MotionClaim, ...]:
    quarter = 0.25 - 0.5 / math.pi
    swing = math.tanh(2.0)
    cycloidal = MotionClaim(
        parameters=FormulaRise(formula="x - sin(2*pi*x)/(2*pi)"),
        values={0.25: quarter, 0.5: 0.5, 0.75: 1.0 - quarter},
        velocities={0.25: 1.0, 0.5: 2.0},
        peak_velocity=2.0,
        peak_acceleration=2 * math.pi,
        peak_jerk=4 * math.pi**2,
        continuity=2,
    )
    quintic = of_quintic(FormulaRise(formula="x**3*(10 - 15*x + 6*x**2)"))
    rough = MotionClaim(
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


def any_formula(d: Draw) -> Law:
    wave = f"x - {d.log(1e-3, 0.15)}*sin(2*pi*x)"
    return {"formula": d.pick([wave, "x**3*(10 - 15*x + 6*x**2)", "sin(pi*x/2)**2"])}


CLAIMS = {
    "formula": MotionClaims(values=formula(), draw=any_formula),
}
