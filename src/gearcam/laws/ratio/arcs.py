"""Arcs of the ratio between two knots.

An arc from `start` to `end` over ``[low, low + width]`` has slope zero at both ends, except the
sine, which starts with a slope. Its mean is ``(1 - share)*start + share*end``, so that closure is
linear in ratios and knots.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from gearcam.numeric.jets import Jet, Value, cos, polynomial, primitive, sin
from gearcam.numeric.piecewise import Piece


@dataclass(frozen=True, kw_only=True)
class Arc:
    """A shape of arcs.

    Parameters
    ----------
    piece : callable
        ``piece(start, end, low, width)`` returns the arc.
    share : float
        Weight of the end value in the mean of the arc.
    """

    piece: Callable[[float, float, float, float], Piece]
    share: float = 0.5


def _cosine(start: float, end: float, low: float, width: float) -> Piece:
    """003 eqs. (2.1), (2.17) with Tables 2.2, 2.4."""
    mean, half, speed = 0.5 * (start + end), 0.5 * (start - end), math.pi / width
    return Piece(_cosine_ratio, _cosine_integral, (mean, half, speed, low))


def _cosine_ratio(x: Jet, mean: Value, half: Value, speed: Value, low: Value) -> Jet:
    return half * cos(speed * (x - low)) + mean


def _cosine_integral(x: Jet, mean: Value, half: Value, speed: Value, low: Value) -> Jet:
    return mean * x + (half / speed) * sin(speed * (x - low))


def _curve(*powers: float) -> Callable[[float, float, float, float], Piece]:
    """Return arcs shaped as a polynomial that rises from 0 to 1 over the unit interval."""

    def ratio(x: Jet, start: Value, rise: Value, low: Value, width: Value) -> Jet:
        return rise * polynomial((x - low) / width, 0.0, *powers) + start

    def integral(x: Jet, start: Value, rise: Value, low: Value, width: Value) -> Jet:
        t = (x - low) / width
        return width * (start * t + rise * primitive(t, 0.0, *powers))

    return lambda start, end, low, width: Piece(ratio, integral, (start, end - start, low, width))


def _sine(start: float, end: float, low: float, width: float) -> Piece:
    """Return a quarter of a sine, 003 eqs. (3.1), (3.10), (3.11), with a slope at the start."""
    return Piece(_sine_ratio, _sine_integral, (start, end - start, 0.5 * math.pi / width, low))


def _sine_ratio(x: Jet, start: Value, rise: Value, speed: Value, low: Value) -> Jet:
    return rise * sin(speed * (x - low)) + start


def _sine_integral(x: Jet, start: Value, rise: Value, speed: Value, low: Value) -> Jet:
    return start * x - (rise / speed) * cos(speed * (x - low))


ARCS: Final[dict[str, Arc]] = {
    "cosine": Arc(piece=_cosine),
    # 003 eq. (2.13) with Table 2.3, written on the unit interval
    "cubic": Arc(piece=_curve(0.0, 0.0, 3.0, -2.0)),
    # also the second derivative of the ratio is zero at both ends
    "quintic": Arc(piece=_curve(0.0, 0.0, 0.0, 10.0, -15.0, 6.0)),
    "sine": Arc(piece=_sine, share=2.0 / math.pi),
}
"""Shapes by their names in design files."""

SMOOTH: Final = ("cosine", "cubic", "quintic")
"""Shapes with slope zero at both ends."""
