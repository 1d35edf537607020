"""Ratio laws i(phi1) = dphi2/dphi1, written out with their first two derivatives.

Every function takes its mathematics from `lib` (numpy or mpmath.mp), so that one formula serves
arrays of floats and numbers of any precision. Angles in rad.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

Derivatives = tuple[Any, Any, Any]
"""i, i', i''."""


@dataclass(frozen=True)
class Piece:
    """A smooth piece of a law between two angles, given in degrees."""

    start: Fraction
    end: Fraction
    ratio: Callable[[Any, Any], Derivatives]

    def span(self, lib: Any) -> tuple[Any, Any]:
        """Both ends in rad, to the precision of `lib`."""
        return tuple(
            lib.pi * edge.numerator / (180 * edge.denominator) for edge in (self.start, self.end)
        )  # pyright: ignore[reportReturnType]


Law = tuple[Piece, ...]


def smooth(ratio: Callable[[Any, Any], Derivatives], pieces: int = 4) -> Law:
    """A law without knots, cut in equal pieces for the quadrature's sake."""
    edges = [Fraction(360 * k, pieces) for k in range(pieces + 1)]
    return tuple(Piece(start, end, ratio) for start, end in pairwise(edges))


def phases(knots_deg: list[float], ratios: list[float], shape: str = "cosine") -> Law:
    """Ratios at knots, joined with zero slopes by half waves of a cosine or by cubics."""
    return tuple(
        Piece(Fraction(start), Fraction(end), _phase(Fraction(start), Fraction(end), a, b, shape))
        for (start, end), (a, b) in zip(pairwise(knots_deg), pairwise(ratios), strict=True)
    )


def _phase(start: Fraction, end: Fraction, a: float, b: float, shape: str) -> Any:
    def ratio(phi: Any, lib: Any) -> Derivatives:
        low, high = Piece(start, end, ratio).span(lib)
        width = high - low
        x = (phi - low) / width
        # the ratios are short decimals: keep them exact in any precision
        first, last = _exact(a, lib), _exact(b, lib)
        rise = last - first
        if shape == "cubic":
            return (
                first + rise * x * x * (3 - 2 * x),
                rise * 6 * x * (1 - x) / width,
                rise * (6 - 12 * x) / width**2,
            )
        w = lib.pi / width
        return (
            (first + last) / 2 - rise / 2 * lib.cos(lib.pi * x),
            rise / 2 * w * lib.sin(lib.pi * x),
            rise / 2 * w * w * lib.cos(lib.pi * x),
        )

    return ratio


def _exact(value: float, lib: Any) -> Any:
    return lib.mpf(repr(value)) if hasattr(lib, "mpf") else value


def constant(ratio: float = 1.0) -> Law:
    """Circular wheels."""
    return smooth(lambda phi, lib: (_exact(ratio, lib) + 0 * phi, 0 * phi, 0 * phi))


def ellipse(eccentricity: float) -> Law:
    """Ellipses about their foci, phi1 = 0 at the near vertex."""

    def ratio(phi: Any, lib: Any) -> Derivatives:
        e = _exact(eccentricity, lib)
        top, bottom = 1 - e * e, 1 + e * e + 2 * e * lib.cos(phi)
        slope = 2 * e * lib.sin(phi) / bottom
        return (
            top / bottom,
            top / bottom * slope,
            top / bottom * (2 * e * lib.cos(phi) / bottom + 2 * slope * slope),
        )

    return smooth(ratio)


def wave(amplitude: float, lobes: int) -> Law:
    """phi2 = phi1 - amplitude*sin(lobes*phi1)."""

    def ratio(phi: Any, lib: Any) -> Derivatives:
        b = _exact(amplitude, lib) * lobes
        c, s = lib.cos(lobes * phi), lib.sin(lobes * phi)
        return 1 - b * c, b * lobes * s, b * lobes * lobes * c

    return smooth(ratio, 4 * lobes)


def from_driver(radius: Callable[[Any, Any], Derivatives], distance: Any, pieces: int = 8) -> Law:
    """The law of a given driver centrode r(phi1) at a centre distance in the same scale."""

    def ratio(phi: Any, lib: Any) -> Derivatives:
        r, r1, r2 = radius(phi, lib)
        rest = distance - r
        return (
            r / rest,
            distance * r1 / rest**2,
            distance * (r2 / rest**2 + 2 * r1 * r1 / rest**3),
        )

    return smooth(ratio, pieces)


def eccentric_circle(offset: float) -> Callable[[Any, Any], Derivatives]:
    """r of a unit circle that turns about a point `offset` from its centre, largest at 0."""

    def radius(phi: Any, lib: Any) -> Derivatives:
        e = _exact(offset, lib)
        c, s = lib.cos(phi), lib.sin(phi)
        root = lib.sqrt(1 - e * e * s * s)
        slope = -e * e * s * c / root
        return (
            e * c + root,
            -e * s + slope,
            -e * c - e * e * (c * c - s * s) / root - slope * slope / root,
        )

    return radius


def lobed(amplitude: float, lobes: int) -> Callable[[Any, Any], Derivatives]:
    """r = 1/(1 + amplitude*cos(lobes*phi))."""

    def radius(phi: Any, lib: Any) -> Derivatives:
        a = _exact(amplitude, lib)
        bottom = 1 + a * lib.cos(lobes * phi)
        slope = a * lobes * lib.sin(lobes * phi) / bottom
        curve = a * lobes * lobes * lib.cos(lobes * phi) / bottom
        return 1 / bottom, slope / bottom, (curve + 2 * slope * slope) / bottom

    return radius


NAIL_TWO = phases([0, 160, 360], [1.6, 0.4, 1.6])
NAIL_THREE = phases([0, 160, 270, 360], [1.6, 0.4, 1.06, 1.6])
"""The nail machine in two and three phases; 1.06 follows from closure (see the test of it)."""
