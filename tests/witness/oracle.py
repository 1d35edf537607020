"""The numbers of a pair of centrodes in high precision (mpmath), from the ratio law alone.

Lengths by Gauss-Legendre quadrature piece by piece, radii of curvature from the polar formula,
extremes by golden section between the points of a fine scan. Signs as everywhere: a radius is
positive where the centrode is convex.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import mpmath

from witness.laws import Derivatives, Law, Piece, from_driver

mp: Any = mpmath.MPContext()
"""A context of its own, that no other test computes in. Untyped: its functions are made at run
time."""
DIGITS = 34
mp.dps = DIGITS
Number = Any


@dataclass(frozen=True, eq=False)
class Pair:
    """Two centrodes that roll: a law and a centre distance."""

    law: Law
    distance: Number

    def _piece(self, phi: Number) -> Piece:
        for piece in self.law:
            if phi <= piece.span(mp)[1]:
                return piece
        return self.law[-1]

    def ratio(self, phi: Number) -> Derivatives:
        """i, i', i'' at phi1 (at a knot: those of the piece that ends there)."""
        return self._piece(phi).ratio(phi, mp)

    def driver_radius(self, phi: Number, piece: Piece | None = None) -> Derivatives:
        """r1 = A*i/(1 + i) and its derivatives by phi1."""
        i, di, ddi = (piece or self._piece(phi)).ratio(phi, mp)
        rest = 1 + i
        a = self.distance
        return a * i / rest, a * di / rest**2, a * (ddi / rest**2 - 2 * di * di / rest**3)

    @cached_property
    def _known(self) -> dict[tuple[str, int], Number]:
        return {}

    def _integral(self, name: str, phi: Number, speed: Callable[[Number, Piece], Number]) -> Number:
        total = mp.mpf(0)
        for k, piece in enumerate(self.law):
            start, end = piece.span(mp)
            if phi <= start:
                break
            known = self._known.get((name, k)) if phi >= end else None
            if known is None:
                stop = min(phi, end)
                edges = [start, (start + stop) / 2, stop]
                known = mp.quadgl(lambda x, p=piece: speed(x, p), edges)
                if phi >= end:
                    self._known[name, k] = known
            total += known
        return total

    def driven_angle(self, phi: Number) -> Number:
        """phi2, rad."""
        return self._integral("angle", phi, lambda x, piece: piece.ratio(x, mp)[0])

    def arc_length(self, phi: Number) -> Number:
        """Arc length s rolled at phi1, the same on both wheels."""
        return self._integral(
            "arc", phi, lambda x, piece: mp.hypot(*self.driver_radius(x, piece)[:2])
        )

    @cached_property
    def length(self) -> Number:
        """Length of either centrode over the driver's turn."""
        return self.arc_length(2 * mp.pi)

    def module(self, teeth: int) -> Number:
        """L/(pi*z)."""
        return self.length / (mp.pi * teeth)

    def curvature(self, wheel: int, phi: Number, piece: Piece | None = None) -> Number:
        """Curvature of wheel 1 or 2 at the pitch point of phi1."""
        r, dr, ddr = self.driver_radius(phi, piece)
        if wheel == 2:
            i, di, _ = (piece or self._piece(phi)).ratio(phi, mp)
            # r2 = A - r1 as a function of phi2: d/dphi2 = (1/i) d/dphi1
            r, dr, ddr = self.distance - r, -dr / i, (-ddr / i + dr * di / i**2) / i
        return (r * r + 2 * dr * dr - r * ddr) / mp.hypot(r, dr) ** 3

    def largest_curvature(self, wheel: int, sign: int = 1, points: int = 240) -> Number:
        """Largest sign*curvature over the turn: 1/rho_min convex, or how concave."""
        best = None
        for piece in self.law:
            start, end = piece.span(mp)
            grid = [start + (end - start) * k / points for k in range(points + 1)]
            values = [sign * self.curvature(wheel, x, piece) for x in grid]
            k = values.index(max(values))
            low, high = grid[max(k - 1, 0)], grid[min(k + 1, points)]
            top = _golden(lambda x, p=piece: sign * self.curvature(wheel, x, p), low, high)
            top = max(top, values[k])
            best = top if best is None else max(best, top)
        return best


def _golden(function: Callable[[Number], Number], low: Number, high: Number) -> Number:
    """Largest value of a single-humped function between two points."""
    share = (mp.sqrt(5) - 1) / 2
    for _ in range(60):
        left, right = high - share * (high - low), low + share * (high - low)
        if function(left) < function(right):
            low = left
        else:
            high = right
    return function((low + high) / 2)


def with_module(law: Law, module: Number, teeth: int) -> Pair:
    """The pair of a given module: both centrodes scale with the centre distance."""
    unit = Pair(law, mp.mpf(1)).length
    return Pair(law, module * mp.pi * teeth / unit)


def closing_distance(radius: Callable[[Any, Any], Derivatives], guess: float) -> Number:
    """Centre distance, in the scale of the driver centrode, at which a 1:1 pair closes.

    For centrodes that are symmetric about phi1 = 0: half a turn tells.
    """

    def miss(distance: Number) -> Number:
        return Pair(from_driver(radius, distance), distance).driven_angle(mp.pi) - mp.pi

    with mp.workdps(22):  # enough for 15 printed digits, and quick
        return mp.findroot(miss, (mp.mpf(guess), mp.mpf(guess) * 1.01), solver="secant", tol=1e-34)


def closing_ratio(widths: list[float], ratios: list[float | None]) -> Number:
    """The one ratio left open (None) in phases over `widths` degrees, ratios at their ends.

    A phase with zero slopes at its ends covers its width times the mean of its ratios.
    """
    total, weight = mp.mpf(0), mp.mpf(0)
    for width, ends in zip(widths, pairwise(ratios), strict=True):
        for end in ends:
            if end is None:
                weight += mp.mpf(width) / 2
            else:
                total += mp.mpf(width) / 2 * mp.mpf(repr(end))
    return (360 - total) / weight


def involute(alpha: Number) -> Number:
    """tan(alpha) - alpha."""
    return mp.tan(alpha) - alpha


def circular_flank(teeth: int, height: Number, alpha: Number) -> tuple[Number, Number]:
    """Point of the `+` flank of a circular wheel's tooth at phi = 0, in modules.

    Parameters: tooth count, contact height on the rack (in modules), pressure angle. The flank is
    the involute of the base circle z*cos(alpha)/2, half a tooth wide (angle pi/(2z)) at radius z/2.
    """
    z = mp.mpf(teeth)
    base = z / 2 * mp.cos(alpha)
    # on the line of action the contact lies height/sin(alpha) beyond the pitch point
    reach = z / 2 * mp.sin(alpha) + height / mp.sin(alpha)
    radius = mp.hypot(base, reach)
    angle = mp.pi / (2 * z) + involute(alpha) - involute(mp.acos(base / radius))
    return radius * mp.cos(angle), radius * mp.sin(angle)
