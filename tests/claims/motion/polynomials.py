"""What the motion laws of `gearcam.laws.motion.polynomials` must give, and random ones."""

from __future__ import annotations

import math
from dataclasses import replace

from claims.claim import MotionClaim, MotionClaims
from gearcam.laws.motion.base import MotionLawParameters
from gearcam.laws.motion.polynomials import (
    Polynomial,
    Polynomial23,
    Polynomial345,
    Polynomial3456,
    Polynomial4567,
    Polynomial56789,
)
from random_designs.draw import Draw
from random_designs.law_draw import Law


def _claim(
    parameters: MotionLawParameters,
    powers: dict[int, float],
    peaks: tuple[float, float, float],
    order: int,
) -> MotionClaim:
    """Return the claim of a polynomial with the coefficients of its `powers`."""
    places = (0.0, 0.125, 0.25, 0.5, 0.75, 1.0)
    return MotionClaim(
        parameters=parameters,
        values={x: sum(c * x**k for k, c in powers.items()) for x in places},
        velocities={x: sum(k * c * x ** (k - 1) for k, c in powers.items()) for x in places},
        peak_velocity=peaks[0],
        peak_acceleration=peaks[1],
        peak_jerk=peaks[2],
        continuity=order,
    )


def two_three() -> tuple[MotionClaim, ...]:
    return (_claim(Polynomial23(), {2: 3, 3: -2}, (1.5, 6.0, math.inf), 1),)


def three_four_five() -> tuple[MotionClaim, ...]:
    powers = {3: 10.0, 4: -15.0, 5: 6.0}
    return (_claim(Polynomial345(), powers, (1.875, 10 / math.sqrt(3), 60.0), 2),)


def four_to_seven() -> tuple[MotionClaim, ...]:
    powers = {4: 35.0, 5: -84.0, 6: 70.0, 7: -20.0}
    return (_claim(Polynomial4567(), powers, (2.1875, 84 * math.sqrt(5) / 25, 52.5), 3),)


def five_to_nine() -> tuple[MotionClaim, ...]:
    """``S'' = 2520*(phi*(1 - phi))^3*(1 - 2*phi)`` is largest where ``(phi - 1/2)^2 = 1/28``."""
    powers = {5: 126.0, 6: -420.0, 7: 540.0, 8: -315.0, 9: 70.0}
    peaks = (630 / 256, 2520 * (3 / 14) ** 3 / math.sqrt(7), 78.75)
    return (_claim(Polynomial56789(), powers, peaks, 3),)


def three_to_six() -> tuple[MotionClaim, ...]:
    """``S' = 6*w*(1 - w^2)^2`` with ``w = 1 - phi`` is largest where ``w^2 = 1/5``."""
    powers = {3: 8.0, 4: -12.0, 5: 6.0, 6: -1.0}
    claim = _claim(Polynomial3456(), powers, (96 * math.sqrt(5) / 125, 6.0, math.inf), 1)
    return (replace(claim, mirrored=True),)


def polynomial() -> tuple[MotionClaim, ...]:
    """No condition: a line. A dwell, then leaving at speed 2: ``4*phi^3 - 3*phi^4`` by hand."""
    line = _claim(Polynomial(start=(), end=()), {1: 1.0}, (1.0, math.inf, math.inf), 0)
    # S(1) = 1, S'(1) = 2 of a*phi^3 + b*phi^4: a = 2, b = -1; S'' = 12*phi*(1 - phi)
    leaving = _claim(
        Polynomial(start=(0.0, 0.0), end=(2.0,)), {3: 2.0, 4: -1.0}, (2.0, math.inf, math.inf), 0
    )
    smooth = {4: 35.0, 5: -84.0, 6: 70.0, 7: -20.0}
    dwells = Polynomial(start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 0.0))
    return (line, leaving, _claim(dwells, smooth, (2.1875, 84 * math.sqrt(5) / 25, 52.5), 3))


def of_quintic(parameters: MotionLawParameters) -> MotionClaim:
    """Return what is claimed of ``10*x^3 - 15*x^4 + 6*x^5``, whatever makes it."""
    return MotionClaim(
        parameters=parameters,
        values={0.25: 53 / 512, 0.5: 0.5, 0.75: 459 / 512},
        velocities={0.25: 270 / 256, 0.5: 1.875},
        peak_velocity=1.875,
        peak_acceleration=10 / math.sqrt(3),
        peak_jerk=60.0,
        continuity=2,
    )


def any_polynomial(d: Draw) -> Law:
    ends = [[0.0] * d.whole(1, 4), [0.0] * d.whole(1, 4)]
    if d.chance(0.3):
        ends[d.pick([0, 1])][0] = d.even(0, 2)
    return {"start": ends[0], "end": ends[1]}


CLAIMS = {
    "2-3": MotionClaims(values=two_three()),
    "3-4-5": MotionClaims(values=three_four_five()),
    "4-5-6-7": MotionClaims(values=four_to_seven()),
    "5-6-7-8-9": MotionClaims(values=five_to_nine()),
    "3-4-5-6": MotionClaims(values=three_to_six()),
    "polynomial": MotionClaims(values=polynomial(), draw=any_polynomial),
}
