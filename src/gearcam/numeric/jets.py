"""Jets: truncated Taylor series, which give the exact derivatives of a formula.

A *jet* of order n holds the Taylor coefficients ``c[k] = f^(k)/k!`` of a function at every sample
point. Arithmetic on jets is that of power series, without difference quotients or symbolic algebra.
Outside a function's domain the values are nan or inf, which the caller has to check.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.numeric.arrays import Array

Value = Array | float
"""A number, or one at each sample point."""

Scalar = Any
"""What jets are added to and multiplied by: a `Value`, or complex numbers in the plane."""

_WHOLE: Final = 128
"""Largest whole power computed by multiplication, which is also valid at zero."""

_BLOCK: Final = 2048
"""Points at which harmonics are summed at once."""


class Jet:
    """Taylor coefficients of a function at sample points.

    Parameters
    ----------
    coefficients : sequence of (n,) arrays or floats
        ``f, f', f''/2!, ...`` at the points; a float where all points have the same.
    """

    __slots__ = ("c",)

    __array_ufunc__ = None
    """Makes numpy leave operations of arrays with jets to the jet."""

    def __init__(self, coefficients: Sequence[Value]) -> None:
        self.c = tuple(coefficients)

    @classmethod
    def variable(cls, x: ArrayLike, order: int) -> Jet:
        """Return the jet of the variable itself at the points `x`, up to `order`."""
        return cls([np.asarray(x, dtype=float), 1.0, *[0.0] * (order - 1)][: order + 1])

    @property
    def order(self) -> int:
        """Highest derivative held."""
        return len(self.c) - 1

    def derivatives(self) -> list[Array]:
        """Return ``[f, f', f'', ...]`` at the points."""
        shape = np.shape(self.c[0])
        scaled = [v * math.factorial(k) if k > 1 else v for k, v in enumerate(self.c)]
        return [v if isinstance(v, np.ndarray) else np.full(shape, v) for v in scaled]

    def differentiated(self) -> Jet:
        """Return the derivative, of one order less."""
        return Jet([self.c[1], *(k * value for k, value in enumerate(self.c[2:], 2))])

    def upto(self, order: int) -> Jet:
        """Return the same function, with its derivatives to an `order`."""
        return Jet(self.c[: order + 1])

    def shortened(self) -> Jet:
        """Return the same function, of one order less."""
        return Jet(self.c[:-1])

    def _constant(self, value: Scalar) -> Jet:
        return Jet([np.full_like(self.c[0], value), *[0.0] * self.order])

    def __neg__(self) -> Jet:
        return Jet([-value for value in self.c])

    def __pos__(self) -> Jet:
        return self

    def __add__(self, other: Jet | Scalar) -> Jet:
        if not isinstance(other, Jet):
            return Jet([self.c[0] + other, *self.c[1:]])
        return Jet([a + b for a, b in zip(self.c, other.c, strict=True)])

    __radd__ = __add__

    def __sub__(self, other: Jet | Scalar) -> Jet:
        if not isinstance(other, Jet):
            return Jet([self.c[0] - other, *self.c[1:]])
        return Jet([a - b for a, b in zip(self.c, other.c, strict=True)])

    def __rsub__(self, other: Scalar) -> Jet:
        return -self + other

    def __mul__(self, other: Jet | Scalar) -> Jet:
        if not isinstance(other, Jet):
            return Jet([value if _is_zero(value) else value * other for value in self.c])
        a, b = self.c, other.c
        left = [j for j, value in enumerate(a) if not _is_zero(value)]
        right = [not _is_zero(value) for value in b]
        return Jet(
            [
                _total([a[j] * b[k - j] for j in left if j <= k and right[k - j]])
                for k in range(len(a))
            ]
        )

    __rmul__ = __mul__

    def __truediv__(self, other: Jet | Scalar) -> Jet:
        if not isinstance(other, Jet):
            return Jet([value if _is_zero(value) else value / other for value in self.c])
        quotient: list[Value] = []
        for k, value in enumerate(self.c):
            rest = value
            for j in range(k):
                if not _is_zero(other.c[k - j]):
                    rest = rest - quotient[j] * other.c[k - j]
            quotient.append(rest / other.c[0])
        return Jet(quotient)

    def __rtruediv__(self, other: Scalar) -> Jet:
        return self._constant(other) / self

    def __pow__(self, exponent: Jet | Value) -> Jet:
        if isinstance(exponent, Jet):
            if all(not np.any(value) for value in exponent.c[1:]):
                values = np.ravel(exponent.c[0])
                if values.size and np.all(values == values[0]):
                    return self ** float(values[0])
            return exp(log(self) * exponent)
        if float(exponent).is_integer() and abs(exponent) <= _WHOLE:
            return self._integer_power(int(exponent))
        power: list[Value] = [self.c[0] ** exponent]
        for k in range(1, len(self.c)):
            total = sum(
                (exponent * j - (k - j)) * self.c[j] * power[k - j] for j in range(1, k + 1)
            )
            power.append(total / (k * self.c[0]))
        return Jet(power)

    def __rpow__(self, base: float) -> Jet:
        return exp(self * np.log(base))

    def _integer_power(self, exponent: int) -> Jet:
        if exponent < 0:
            return 1.0 / self._integer_power(-exponent)
        if not exponent:
            return self._constant(1.0)
        if exponent & 1:
            return self if exponent == 1 else self * self._integer_power(exponent - 1)
        half = self._integer_power(exponent // 2)
        return half * half


def _total(terms: Sequence[Value]) -> Value:
    return sum(terms[1:], start=terms[0]) if terms else 0.0


def _is_zero(value: Value) -> bool:
    """Whether a coefficient is a zero float; arrays are not examined."""
    return isinstance(value, float) and value == 0.0


def _weights(x: Jet, k: int) -> list[tuple[Value, int]]:
    """Return weights and indices for coefficient k of f(x) from f'(x): (f(x))' = f'(x)*x'."""
    return [(j * x.c[j] / k, k - j) for j in range(1, k + 1) if not _is_zero(x.c[j])]


def _chain(jet: Jet, value: Value, slope: Callable[[Jet], Jet]) -> Jet:
    """Return f(jet) from f at the points and the jet of f' (one order less is enough)."""
    if not jet.order:
        return Jet([value])
    inner, orders = slope(Jet(jet.c[:-1])), range(1, jet.order + 1)
    return Jet([value, *(_total([w * inner.c[j] for w, j in _weights(jet, k)]) for k in orders)])


def exp(x: Jet) -> Jet:
    """Exponential of a jet."""
    result: list[Value] = [np.exp(x.c[0])]
    for k in range(1, x.order + 1):
        result.append(_total([w * result[j] for w, j in _weights(x, k)]))
    return Jet(result)


def log(x: Jet) -> Jet:
    """Natural logarithm of a jet."""
    return _chain(x, np.log(x.c[0]), lambda inner: 1.0 / inner)


def sqrt(x: Jet) -> Jet:
    """Square root of a jet."""
    root: list[Value] = [np.sqrt(x.c[0])]
    for k in range(1, x.order + 1):
        rest = x.c[k] - _total([root[j] * root[k - j] for j in range(1, k)])
        root.append(rest / (2.0 * root[0]))
    return Jet(root)


def _oscillate(x: Jet, sine: bool) -> Jet:
    """Return sin or cos of a jet."""
    f: list[Value] = [np.sin(x.c[0]) if sine else np.cos(x.c[0])]
    if not x.order:
        return Jet(f)
    g: list[Value] = [np.cos(x.c[0]) if sine else -np.sin(x.c[0])]
    if all(_is_zero(value) for value in x.c[2:]):
        # a linear inner function: the derivatives are f, g, -f, -g, f, ...
        factor = x.c[1]
        for k in range(1, x.order + 1):
            factor = factor * x.c[1] / k if k > 1 else factor
            f.append((g[0] if k % 2 else f[0]) * (factor if k % 4 < 2 else -factor))
        return Jet(f)
    return _turning(x, f, g)[0]


def _turning(x: Jet, f: list[Value], g: list[Value]) -> tuple[Jet, Jet]:
    """Return f and g of a jet from their values: f' = g*x', g' = -f*x'."""
    for k in range(1, x.order + 1):
        weights = _weights(x, k)
        f.append(_total([w * g[j] for w, j in weights]))
        g.append(-_total([w * f[j] for w, j in weights]))
    return Jet(f), Jet(g)


def sin(x: Jet) -> Jet:
    """Sine of a jet."""
    return _oscillate(x, sine=True)


def cos(x: Jet) -> Jet:
    """Cosine of a jet."""
    return _oscillate(x, sine=False)


def sin_cos(x: Jet | Array) -> tuple[Any, Any]:
    """Sine and cosine of a jet, in half the time of both, or of an array."""
    if not isinstance(x, Jet):
        return np.sin(x), np.cos(x)
    return _turning(x, [np.sin(x.c[0])], [np.cos(x.c[0])])


def tan(x: Jet) -> Jet:
    """Tangent of a jet."""
    return sin(x) / cos(x)


def asin(x: Jet) -> Jet:
    """Inverse sine of a jet."""
    return _chain(x, np.arcsin(x.c[0]), lambda inner: 1.0 / sqrt(1.0 - inner * inner))


def acos(x: Jet) -> Jet:
    """Inverse cosine of a jet."""
    return _chain(x, np.arccos(x.c[0]), lambda inner: -1.0 / sqrt(1.0 - inner * inner))


def atan(x: Jet) -> Jet:
    """Inverse tangent of a jet."""
    return _chain(x, np.arctan(x.c[0]), lambda inner: 1.0 / (1.0 + inner * inner))


def sinh(x: Jet) -> Jet:
    """Hyperbolic sine of a jet."""
    return _chain(x, np.sinh(x.c[0]), cosh)


def cosh(x: Jet) -> Jet:
    """Hyperbolic cosine of a jet."""
    return _chain(x, np.cosh(x.c[0]), sinh)


def tanh(x: Jet) -> Jet:
    """Hyperbolic tangent of a jet."""
    return _chain(x, np.tanh(x.c[0]), lambda inner: 1.0 - tanh(inner) * tanh(inner))


def polynomial(x: Jet, place: Value, *coefficients: Value) -> Jet:
    """Return a polynomial of a jet, in powers of its distance from a place.

    Parameters
    ----------
    x : Jet
        Argument, with arrays of one shape.
    place : float or array
        Place of zero distance.
    *coefficients : floats, or arrays
        Coefficients of rising powers, at least one.

    Returns
    -------
    Jet

    Notes
    -----
    Horner's scheme on all derivatives over their factorials at once, then the chain rule.
    """
    t, count = x.c[0] - place, len(coefficients)
    given = np.array(coefficients)
    given = given.reshape(count, *(given.shape[1:] or (1,) * np.ndim(t)))
    rows = np.zeros((count, x.order + 1, *given.shape[1:]))
    for k, factors in enumerate(_binomials(count, min(x.order + 1, count))):
        rows[: count - k, k] = (factors * given[k:].T).T
    about = 0.0 * t + rows[-1]
    for row in rows[-2::-1]:
        about *= t
        about += row
    return composed(x, about)


def harmonics(x: Jet, cosines: Sequence[float] | Array, sines: Sequence[float] | Array) -> Jet:
    """Return ``sum(a_k*cos(k*x) + b_k*sin(k*x))`` of a jet, k from 1.

    Parameters
    ----------
    x : Jet
        Of arrays.
    cosines, sines : sequences of n floats
        a_1, a_2, ...; b_1, b_2, ...

    Returns
    -------
    Jet

    Notes
    -----
    Horner's scheme in ``exp(1j*x)`` on all derivatives over their factorials at once, in blocks
    that stay in the processor's cache.
    """
    orders, turns = np.arange(x.order + 1), 1j * np.arange(1, len(cosines) + 1)[:, None]
    factorials = np.array([float(math.factorial(k)) for k in orders])
    rows = (np.array(cosines) - 1j * np.array(sines))[:, None] * turns**orders / factorials
    waves = np.exp(1j * np.ravel(x.c[0]))
    about = np.empty((len(orders), waves.size))
    for start in range(0, waves.size, _BLOCK):
        wave = waves[start : start + _BLOCK]
        total = np.zeros((len(orders), wave.size), dtype=np.complex128)
        for row in rows[::-1]:
            total += row[:, None]
            total *= wave
        about[:, start : start + _BLOCK] = total.real
    return composed(x, about.reshape(len(orders), *np.shape(x.c[0])))


def composed(x: Jet, about: Array | Sequence[Value]) -> Jet:
    """Return f(x) of a jet x from the Taylor coefficients of f at its points.

    Parameters
    ----------
    x : Jet
        Of arrays.
    about : sequence of arrays or floats
        Row k is the k-th derivative of f over k!, up to the order of `x`.

    Returns
    -------
    Jet
    """
    if all(_is_zero(value) for value in x.c[2:]):
        return Jet([about[0], *(value * x.c[1] ** k for k, value in enumerate(about[1:], 1))])
    step, result = Jet([0.0, *x.c[1:]]), Jet([about[-1], *[0.0] * x.order])
    for value in about[-2::-1]:
        result = result * step + value
    return result


@lru_cache
def _binomials(count: int, rows: int) -> list[Array]:
    """Return factors of coefficients in the k-th derivative over k!, by row k."""
    return [np.array([math.comb(j, k) for j in range(k, count)], float) for k in range(rows)]


def primitive(x: Jet, place: Value, *coefficients: Value) -> Jet:
    """Return the integral of a polynomial from its place (see `polynomial`)."""
    areas = [value / (k + 1) for k, value in enumerate(coefficients)]
    return polynomial(x, place, 0.0 * areas[0], *areas)


def slope(x: Jet, place: Value, _: Value, *coefficients: Value) -> Jet:
    """Return the derivative of a polynomial of degree 1 at least (see `polynomial`)."""
    return polynomial(x, place, *(k * value for k, value in enumerate(coefficients, 1)))


FUNCTIONS: Final[dict[str, Callable[[Jet], Jet]]] = {
    function.__name__: function
    for function in (sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, log, sqrt)
}
"""The functions that a formula may use, by name."""
