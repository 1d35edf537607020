"""The crank angle for a desired motion of a slide (003 section 1.4.1).

A crank of radius 1 with a rod of length `rod` moves a slide; `s` is the distance of the slide from
its outer dead centre, 0 to 2, and ``d = 1 + rod - s`` its distance from the shaft.
The triangle of crank, rod and d gives the crank angle psi without cancellation,

    sin(psi/2)^2 = s*(2*rod - s)/(4*d),   cos(psi/2)^2 = (2 - s)*(2 + 2*rod - s)/(4*d).

At a dead centre s has a double zero, where its root changes sign: ``sqrt(s) = t*sqrt(s/t^2)``, with
s as a Taylor series in the angle t from the dead centre. This gives the series of psi used nearby.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import beyond_limit
from gearcam.laws.formula import derivative
from gearcam.laws.ratio.span import SAME, angle_text
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet, asin, atan, polynomial, slope, sqrt
from gearcam.numeric.piecewise import Piece, extremes

Function = Callable[[Jet], Jet]

_STILL = 1e-6
"""Smallest second Taylor coefficient of the slide at a dead centre, crank radii per rad^2: below it
the crank would stand still."""

NARROWEST = 0.02
"""Angle about a dead centre, rad, within which its series is needed: the closed form loses digits
there."""


@dataclass(frozen=True, kw_only=True)
class Slide(ShortRepr):
    """The desired motion of a slide over one turn, in crank radii.

    Parameters
    ----------
    position : callable
        s(phi1), 0 to 2.
    rod : float
        Length of the rod, in crank radii.
    outer, inner : float, rad
        Driver angles of the outer and the inner dead centre.
    period : float, rad
        Period of the motion.
    """

    position: Function
    rod: float
    outer: float
    inner: float
    period: float


def make_slide(shape: Function, rod: float, period: float) -> tuple[Slide, float]:
    """Scale a desired motion to a crank.

    Parameters
    ----------
    shape : callable
        Position of the slide with any scale and origin, rising towards the shaft.
    rod : float
        Length of the rod, in crank radii.
    period : float, rad
        Period of the motion.

    Returns
    -------
    slide : Slide
        Motion in crank radii.
    radius : float
        Crank radius in the unit of the slide: half the stroke.

    Raises
    ------
    InfeasibleError
        If the slide does not go forward once and back once.
    """

    def function(x: Array) -> list[Array]:
        return shape(Jet.variable(x, 1)).derivatives()

    places, values = extremes(function, [0.0, period])
    turns = _dead_centres(places, values, period, function)
    if len(turns) != 2:
        what = "the slide must go forward and back once: a crank has two dead centres"
        note = "this is the number of reversals over one lobe of the driver"
        raise beyond_limit(what, "law.slide", float(len(turns)), 2.0, note)
    (outer, low), (inner, high) = sorted(turns, key=lambda turn: turn[1])
    radius = 0.5 * (high - low)

    def position(x: Jet) -> Jet:
        return (shape(x) - low) / radius

    return Slide(position=position, rod=rod, outer=outer, inner=inner, period=period), radius


def _dead_centres(
    places: Array, values: Array, period: float, function: Callable[[Array], list[Array]]
) -> list[tuple[float, float]]:
    """Return the inner extremes, and the end of the lobe if the slope changes sign there."""
    turns = [(float(x), float(v)) for x, v in zip(places[1:-1], values[1:-1], strict=True)]
    step = 1e-6 * period
    before, after = function(np.array([period - step, step]))[1]
    if before * after < 0.0 and all(step < x < period - step for x, _ in turns):
        turns.append((0.0, float(function(np.zeros(1))[0][0])))
    return turns


def crank_angle(slide: Slide) -> tuple[Array, list[Piece], float]:
    """Return the crank angle as pieces of a law.

    Parameters
    ----------
    slide : Slide
        The desired motion.

    Returns
    -------
    knots : (n + 1,) array, rad
        From 0 to the period.
    pieces : list of n Piece
        Derivative of the crank angle by phi1, with the crank angle as integral.
    start : float, rad
        Crank angle from the outer dead centre at phi1 = 0.

    Raises
    ------
    InfeasibleError
        If the slide rests at a dead centre or bends too sharply there.
    """
    outer = (slide.outer, *_series(slide, slide.outer, 1.0), 1.0)
    inner = (slide.inner, *_series(slide, slide.inner, -1.0), -1.0)
    period = slide.period

    def angle(x: Jet, sign: Array) -> Jet:
        """Return the crank angle between dead centres, from the outer (sign 1) or the inner one."""
        s = slide.position(x)
        sine, cosine = s * (2.0 * slide.rod - s), (2.0 - s) * (2.0 + 2.0 * slide.rod - s)
        return (2.0 * sign) * atan(sqrt(sine / cosine))

    ratio = derivative(angle)
    stretches: list[tuple[float, float, Piece]] = []
    for (middle, reach, powers, sign), other in ((outer, inner), (inner, outer)):
        gap = (other[0] - middle) % period
        for turn in (-1, 0, 1):
            place = middle + turn * period
            low, high = place + reach, place + gap - other[1]
            stretches.append((place - reach, low, Piece(slope, polynomial, (place, *powers))))
            stretches.append((low, high, Piece(ratio, angle, (sign,))))
    inside = sorted(
        (
            (max(low, 0.0), min(high, period), piece)
            for low, high, piece in stretches
            if min(high, period) - max(low, 0.0) > SAME
        ),
        key=lambda stretch: stretch[0],
    )
    knots = np.array([low for low, _, _ in inside] + [period])
    knots[0] = 0.0
    pieces = [piece for _, _, piece in inside]
    first = slide.position(Jet.variable(np.zeros(1), 1)).derivatives()
    return knots, pieces, _start(slide, float(first[0][0]), float(first[1][0]))


def _start(slide: Slide, s: float, slope: float) -> float:
    sine = max(0.0, s * (2.0 * slide.rod - s))
    cosine = max(0.0, (2.0 - s) * (2.0 + 2.0 * slide.rod - s))
    angle = 2.0 * math.atan2(math.sqrt(sine), math.sqrt(cosine))
    return angle if slope >= 0.0 else 2.0 * math.pi - angle


def _series(slide: Slide, place: float, sign: float) -> tuple[float, list[float]]:
    """Return range and coefficients of the series about a dead centre; sign -1 for the inner."""
    jet = slide.position(Jet.variable(np.array([place]), 30))
    c = np.array([float(np.ravel(value)[0]) for value in jet.c]) * sign
    if not c[2] > _STILL:
        what = "the slide rests at its dead centre: the crank would stand still"
        note = "this is the second derivative of the position of the slide, in crank radii"
        raise beyond_limit(
            what, f"law.slide, {angle_text(place)}", 2.0 * float(c[2]), 2.0 * _STILL, note
        )
    over, small = Jet(c[2:].tolist()), Jet([0.0, 0.0, *c[2:-2].tolist()])
    s = small if sign > 0.0 else 2.0 - small
    factor = (2.0 * slide.rod if sign > 0.0 else 2.0 + 2.0 * slide.rod) - s
    root = sqrt(over * factor / (4.0 * (1.0 + slide.rod - s)))
    powers = np.array([float(value) for value in (2.0 * asin(Jet([0.0, *root.c]))).c])
    rates = np.arange(1, len(powers)) * powers[1:]
    # as far as each of the last six terms is below rounding
    k, sizes = np.arange(len(rates))[-6:], np.abs(rates[-6:])
    with np.errstate(divide="ignore"):
        reach = float(min(0.3, ((1e-17 * rates[0] / sizes) ** (1.0 / k)).min()))
    reach = min(reach, 0.2 * abs(((slide.inner - slide.outer) % slide.period) or math.inf))
    if reach < NARROWEST:
        what = "the motion of the slide bends too sharply at its dead centre"
        where = f"law.slide, {angle_text(place)}"
        raise beyond_limit(what, where, math.degrees(reach), math.degrees(NARROWEST), unit="deg")
    return reach, powers.tolist()
