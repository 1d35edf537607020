"""Ratio laws and what follows from them in 30 digits, from their definitions alone.

A law is a list of pieces, each a function of `Slope` numbers (a value with its derivative by phi1),
either of the ratio or of the driver's radius at any scale, whose centre distance is then solved.
Integrals by Gauss-Legendre panels that are halved until two orders of them agree.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import mpmath

mp: Any = mpmath.MPContext()
"""A context of its own. Untyped: its functions are made at run time."""
mp.dps = 30
Number = Any
_AGREE = mp.mpf(10) ** -21
_DEEPEST = 40


class Slope:
    """A value with its derivative."""

    __slots__ = ("d", "v")

    def __init__(self, v: Number, d: Number = 0) -> None:
        self.v, self.d = v, d

    def __add__(self, other: Any) -> Slope:
        if isinstance(other, Slope):
            return Slope(self.v + other.v, self.d + other.d)
        return Slope(self.v + other, self.d)

    __radd__ = __add__

    def __neg__(self) -> Slope:
        return Slope(-self.v, -self.d)

    def __sub__(self, other: Any) -> Slope:
        return self + (-other)

    def __rsub__(self, other: Any) -> Slope:
        return -self + other

    def __mul__(self, other: Any) -> Slope:
        if isinstance(other, Slope):
            return Slope(self.v * other.v, self.d * other.v + self.v * other.d)
        return Slope(self.v * other, self.d * other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Slope:
        if isinstance(other, Slope):
            quotient = self.v / other.v
            return Slope(quotient, (self.d - quotient * other.d) / other.v)
        return Slope(self.v / other, self.d / other)

    def __rtruediv__(self, other: Any) -> Slope:
        quotient = other / self.v
        return Slope(quotient, -quotient * self.d / self.v)

    def __pow__(self, exponent: int) -> Slope:
        power = self.v ** (exponent - 1)
        return Slope(power * self.v, exponent * power * self.d)


def sin(x: Any) -> Any:
    return Slope(mp.sin(x.v), mp.cos(x.v) * x.d) if isinstance(x, Slope) else mp.sin(x)


def cos(x: Any) -> Any:
    return Slope(mp.cos(x.v), -mp.sin(x.v) * x.d) if isinstance(x, Slope) else mp.cos(x)


def exp(x: Any) -> Any:
    value = mp.exp(x.v if isinstance(x, Slope) else x)
    return Slope(value, value * x.d) if isinstance(x, Slope) else value


def sqrt(x: Any) -> Any:
    root = mp.sqrt(x.v if isinstance(x, Slope) else x)
    return Slope(root, x.d / (2 * root)) if isinstance(x, Slope) else root


def tanh(x: Any) -> Any:
    value = mp.tanh(x.v if isinstance(x, Slope) else x)
    return Slope(value, (1 - value * value) * x.d) if isinstance(x, Slope) else value


pi = mp.pi
"""For formulas that are written once for numpy and for 30 digits."""

Function = Callable[[Slope], Slope]
Piece = tuple[Number, Number, Function]


def _gauss(count: int) -> list[tuple[Number, Number]]:
    """Places and weights on [0, 1]: roots of a Legendre polynomial by Newton's method."""
    found = []
    for k in range(count):
        x, rise = mp.cos(mp.pi * (k + mp.mpf(3) / 4) / (count + mp.mpf(1) / 2)), mp.mpf(0)
        for _ in range(8):
            before, value = mp.mpf(1), x
            for n in range(2, count + 1):
                before, value = value, ((2 * n - 1) * x * value - (n - 1) * before) / n
            rise = count * (x * value - before) / (x * x - 1)
            x -= value / rise
        found.append(((1 - x) / 2, 1 / ((1 - x * x) * rise * rise)))
    return found


_MANY = _gauss(18)
_FEW = _gauss(13)


class Integral:
    """Integrals of several functions at once over pieces, known at the edges of panels.

    Parameters
    ----------
    pieces : sequence of (low, high, function)
        ``function(x)`` returns a tuple of numbers.
    """

    def __init__(self, pieces: Sequence[tuple[Number, Number, Callable[[Number], Any]]]) -> None:
        self.edges: list[Number] = [pieces[0][0]]
        self.functions: list[Callable[[Number], Any]] = []
        self.totals: list[Any] = []
        for low, high, function in pieces:
            self._panel(low, high, function, 0)
        sums = [tuple(mp.mpf(0) for _ in self.totals[0])]
        for total in self.totals:
            sums.append(tuple(a + b for a, b in zip(sums[-1], total, strict=True)))
        self.sums = sums

    @staticmethod
    def _over(low: Number, high: Number, function: Any, nodes: Any) -> Any:
        width = high - low
        found = [(weight, function(low + width * place)) for place, weight in nodes]
        return tuple(
            width * mp.fsum(weight * values[k] for weight, values in found)
            for k in range(len(found[0][1]))
        )

    def _panel(self, low: Number, high: Number, function: Any, depth: int) -> None:
        many, few = (self._over(low, high, function, nodes) for nodes in (_MANY, _FEW))
        # the higher order is far better than their difference
        if all(abs(a - b) <= mp.sqrt(_AGREE) / 10**4 for a, b in zip(many, few, strict=True)):
            self.edges.append(high)
            self.functions.append(function)
            self.totals.append(many)
            return
        assert depth < _DEEPEST
        middle = (low + high) / 2
        self._panel(low, middle, function, depth + 1)
        self._panel(middle, high, function, depth + 1)

    def __call__(self, x: Number) -> Any:
        """Return the integrals from the first edge to `x`."""
        k = min(max(bisect_right(self.edges, x) - 1, 0), len(self.totals) - 1)
        if x == self.edges[k]:
            return self.sums[k]
        part = self._over(self.edges[k], x, self.functions[k], _MANY)
        return tuple(a + b for a, b in zip(self.sums[k], part, strict=True))


@dataclass(frozen=True, eq=False)
class Exact:
    """A law and its centrodes.

    Parameters
    ----------
    pieces : sequence of Piece
        The ratio over one lobe or an open pair's travel; of a rack the radius.
    mate : {1, 0, -1}
        An external wheel, a rack, a ring.
    """

    pieces: Sequence[Piece]
    mate: int = 1

    @property
    def period(self) -> Number:
        return self.pieces[-1][1]

    def ratio(self, x: Number) -> Slope:
        for _, high, function in self.pieces:
            if x <= high:
                return function(Slope(x, mp.mpf(1)))
        return self.pieces[-1][2](Slope(x, mp.mpf(1)))

    def radius(self, i: Slope) -> Slope:
        """r1 for unit centre distance."""
        return i / (1 + self.mate * i)

    def bends(self, function: Function, x: Number) -> tuple[Number, Number]:
        """Curvatures of both centrodes for unit distance by one of the pieces, by its directions.

        The second derivative by a step into the complex plane, where nothing cancels.
        """
        step = mp.mpf(10) ** -20
        i = function(Slope(mp.mpc(x, step), mp.mpf(1)))
        r = self.radius(i)
        moved = mp.mpc(mp.re(r.d), mp.re(r.v))
        turn = mp.im(mp.mpc(mp.im(r.d), mp.im(r.v)) / step / moved)
        return (1 + turn) / abs(moved), (self.mate * mp.re(i.v) - turn) / abs(moved)

    @cached_property
    def integral(self) -> Integral:
        """phi2, and the arc length for unit centre distance."""

        def both(function: Function) -> Callable[[Number], Any]:
            def values(x: Number) -> Any:
                i = function(Slope(x, mp.mpf(1)))
                r = self.radius(i)
                return i.v, mp.sqrt(r.v * r.v + r.d * r.d)

            return values

        return Integral([(low, high, both(function)) for low, high, function in self.pieces])

    def frame(self, wheel: int, phi: Number) -> tuple[Number, Number, Number, Number]:
        """Point, unit tangent, outward unit normal and arc length for unit centre distance."""
        turns = mp.floor(phi / self.period)
        x = phi - turns * self.period
        r = self.radius(self.ratio(x))
        (phi2, arc), (advance, length) = self.integral(x), self.integral(self.period)
        phi2, arc = phi2 + turns * advance, arc + turns * length
        speed, moved = mp.sqrt(r.v * r.v + r.d * r.d), mp.mpc(r.d, r.v)
        if wheel == 1:
            pole = mp.exp(1j * phi)
            point, turn = r.v * pole, mp.mpc(0, -1)
        elif self.mate == 0:
            pole = mp.mpc(1)
            point, turn = mp.mpc(r.v, phi2), mp.mpc(0, 1)
        else:
            pole = mp.exp(-1j * self.mate * phi2)
            point, turn = (r.v - self.mate) * pole, mp.mpc(0, 1)
        tangent = moved / speed * pole
        return point, tangent, turn * tangent, arc

    def flank_point(
        self, wheel: int, phi: Number, size: Number, sf: Number, sigma: int, alpha: Number
    ) -> Number:
        """Point of the flank that crosses the pitch curve at the arc length `sf`, mm, at roll phi.

        The foot of the perpendicular from the pitch point on the rack's flank.
        """
        point, tangent, outward, arc = self.frame(wheel, phi)
        normal = mp.cos(alpha) * tangent + sigma * mp.sin(alpha) * outward
        return size * point + (sf - size * arc) * mp.cos(alpha) * normal

    def tip_point(self, wheel: int, phi: Number, size: Number, height: Number) -> Number:
        """Point of the parallel of the pitch curve at a height, mm."""
        point, _, outward, _ = self.frame(wheel, phi)
        return size * point + height * outward


def of_radius(
    shapes: Sequence[Piece], advance: Number, mate: int, near: float
) -> tuple[Exact, Any]:
    """Return the law of a driver's centrode and its centre distance, which makes it close.

    Parameters
    ----------
    shapes : sequence of Piece
        The radius at any scale.
    advance : number, rad
        What the driven wheel must turn.
    mate : {1, -1}
        An external wheel or a ring.
    near : float
        Near the centre distance: Newton's method starts there.
    """
    c = mp.mpf(near)

    def both(function: Function) -> Callable[[Number], Any]:
        def values(x: Number) -> Any:
            r = function(Slope(x, mp.mpf(1))).v
            rest = c - mate * r
            return r / rest, r / rest**2

        return values

    for _ in range(3):
        integral = Integral([(low, high, both(shape)) for low, high, shape in shapes])
        driven, slope = integral.sums[-1]
        step = (driven - advance) / slope
        c += step
        if abs(step) < mp.mpf(10) ** -18 * c:
            break

    def ratio(shape: Function) -> Function:
        return lambda x: (lambda r: r / (c - mate * r))(shape(x))

    return Exact([(low, high, ratio(shape)) for low, high, shape in shapes], mate), c


def turn_of(count: int) -> Number:
    """The angle of a lobe of a wheel with so many."""
    return 2 * mp.pi / count


def of(value: Any) -> Number:
    """A double as it is."""
    return mp.mpf(float(value))


def whole(function: Function, period: Number, parts: int = 4) -> list[Piece]:
    """One function over a period."""
    edges = [period * k / parts for k in range(parts + 1)]
    return [(low, high, function) for low, high in pairwise(edges)]


def closed_by(function: Function, period: Number, advance: Number, mate: int) -> Exact:
    """Scale a ratio so that it closes."""
    mean = Exact(whole(function, period), 0).integral.sums[-1][0]
    return Exact(whole(lambda x: function(x) * (advance / mean), period), mate)


def by_radius(pieces: Sequence[Piece], advance: Number, mate: int) -> Callable[[Any], Exact]:
    """Return what makes the law of a driver's centrode from a law in doubles, which is near."""

    def make(law: Any) -> Exact:
        # the ratio at any place tells the centre distance
        x = of(0.3) * pieces[-1][1]
        shape = next(shape for _, high, shape in pieces if x <= high)
        r, i = shape(Slope(x, mp.mpf(1))).v, of(law.ratio(float(x)))
        return of_radius(pieces, advance, mate, float(r / i + mate * r))[0]

    return make
