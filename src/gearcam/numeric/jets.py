"""Jets: truncated Taylor series, so that a formula written once also gives its exact derivatives.

A *jet* of order n holds the Taylor coefficients ``c[k] = f^(k)/k!`` of a function at every sample
point. Arithmetic on jets is the arithmetic of power series; no difference quotient, no symbolic
algebra. Outside a function's domain the values are nan or inf, for the caller to find and name.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class Jet:
    """Taylor coefficients of a function at sample points.

    Parameters
    ----------
    coefficients : sequence of (n,) arrays or floats
        ``f, f', f''/2!, ...`` at the points; a float where all points have the same.
    """

    __slots__ = ("c",)

    def __init__(self, coefficients: Sequence[Array | float]) -> None:
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

    def _lift(self, other: Jet | float) -> Jet:
        if isinstance(other, Jet):
            return other
        return Jet([np.full_like(self.c[0], other), *[0.0] * self.order])

    def __neg__(self) -> Jet:
        return Jet([-value for value in self.c])

    def __pos__(self) -> Jet:
        return self

    def __add__(self, other: Jet | float) -> Jet:
        if not isinstance(other, Jet):
            return Jet([self.c[0] + other, *self.c[1:]])
        return Jet([a + b for a, b in zip(self.c, other.c, strict=True)])

    __radd__ = __add__

    def __sub__(self, other: Jet | float) -> Jet:
        return self + (-other)

    def __rsub__(self, other: float) -> Jet:
        return -self + other

    def __mul__(self, other: Jet | float) -> Jet:
        if not isinstance(other, Jet):
            return Jet([value * other for value in self.c])
        a, b = self.c, other.c
        return Jet([_convolve(a, b, k) for k in range(len(a))])

    __rmul__ = __mul__

    def __truediv__(self, other: Jet | float) -> Jet:
        if not isinstance(other, Jet):
            return Jet([value / other for value in self.c])
        quotient: list[Array | float] = []
        for k, value in enumerate(self.c):
            rest = value
            for j in range(k):
                rest = rest - quotient[j] * other.c[k - j]
            quotient.append(rest / other.c[0])
        return Jet(quotient)

    def __rtruediv__(self, other: float) -> Jet:
        return self._lift(other) / self

    def __pow__(self, exponent: Jet | float) -> Jet:
        if isinstance(exponent, Jet):
            if all(not np.any(value) for value in exponent.c[1:]):
                values = np.unique(exponent.c[0])
                if values.size == 1:
                    return self ** float(values[0])
            return exp(log(self) * exponent)
        if float(exponent).is_integer() and abs(exponent) <= 64:
            return self._integer_power(int(exponent))
        power: list[Array | float] = [self.c[0] ** exponent]
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
        result, square = self._lift(1.0), self
        while exponent:
            if exponent & 1:
                result = result * square
            exponent >>= 1
            if exponent:
                square = square * square
        return result


def _convolve(a: Sequence[Array | float], b: Sequence[Array | float], k: int) -> Array | float:
    return _total(
        a[j] * b[k - j] for j in range(k + 1) if not (_is_zero(a[j]) or _is_zero(b[k - j]))
    )


def _total(terms: Iterable[Array | float]) -> Array | float:
    total: Array | float = 0.0
    for term in terms:
        total = term if _is_zero(total) else total + term
    return total


def _is_zero(value: Array | float) -> bool:
    """Whether a coefficient is zero at all points, without looking at arrays."""
    return isinstance(value, float) and value == 0.0


def _chain(jet: Jet, value: Array | float, slope: Callable[[Jet], Jet]) -> Jet:
    """Return f(jet) from f at the points and the jet of f' (one order less is enough)."""
    result = [value]
    if jet.order:
        inner = slope(Jet(jet.c[:-1]))
        for k in range(1, jet.order + 1):
            terms = (
                j * jet.c[j] * inner.c[k - j] for j in range(1, k + 1) if not _is_zero(jet.c[j])
            )
            result.append(_total(terms) / k)
    return Jet(result)


def exp(x: Jet) -> Jet:
    """Exponential of a jet."""
    return _chain(x, np.exp(x.c[0]), exp)


def log(x: Jet) -> Jet:
    """Natural logarithm of a jet."""
    return _chain(x, np.log(x.c[0]), lambda inner: 1.0 / inner)


def sqrt(x: Jet) -> Jet:
    """Square root of a jet."""
    return _chain(x, np.sqrt(x.c[0]), lambda inner: 0.5 / sqrt(inner))


def _oscillate(x: Jet, sine: bool) -> Jet:
    """Return sin or cos of a jet, with its derivative g beside it: f' = g*x', g' = -f*x'."""
    f: list[Array | float] = [np.sin(x.c[0]) if sine else np.cos(x.c[0])]
    if not x.order:
        return Jet(f)
    g: list[Array | float] = [np.cos(x.c[0]) if sine else -np.sin(x.c[0])]
    if all(_is_zero(value) for value in x.c[2:]):
        # A straight inner function: the derivatives are f, g, -f, -g, f, ...
        factor: Array | float = 1.0
        for k in range(1, x.order + 1):
            factor = factor * x.c[1] / k
            f.append((g[0] if k % 2 else f[0]) * (factor if k % 4 < 2 else -factor))
        return Jet(f)
    for k in range(1, x.order + 1):
        weights = [(j * x.c[j] / k, k - j) for j in range(1, k + 1) if not _is_zero(x.c[j])]
        f.append(_total(w * g[j] for w, j in weights))
        g.append(-_total(w * f[j] for w, j in weights))
    return Jet(f)


def sin(x: Jet) -> Jet:
    """Sine of a jet."""
    return _oscillate(x, sine=True)


def cos(x: Jet) -> Jet:
    """Cosine of a jet."""
    return _oscillate(x, sine=False)


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


def polynomial(coefficients: ArrayLike) -> Callable[[Jet], Jet]:
    """Return the polynomial of jets with `coefficients` of rising powers, at least one."""
    *rest, last = (float(value) for value in np.asarray(coefficients, dtype=float))

    def function(t: Jet) -> Jet:
        total = 0.0 * t + last
        for value in reversed(rest):
            total = total * t + value
        return total

    return function


FUNCTIONS: Final[dict[str, Callable[[Jet], Jet]]] = {
    function.__name__: function
    for function in (sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, log, sqrt)
}
"""The functions that a formula may use, by name."""
