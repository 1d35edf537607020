"""Power series of four terms, so that a formula of mpmath's numbers brings three derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mpmath

mp: Any = mpmath.mp
Number = Any

_TERMS = 4


class Series:
    """Terms of rising powers of the distance from a place."""

    def __init__(self, terms: Sequence[Number]) -> None:
        self.terms = list(terms)

    @classmethod
    def variable(cls, place: Number) -> Series:
        return cls([mp.mpf(place), mp.mpf(1), mp.mpf(0), mp.mpf(0)])

    @property
    def derivatives(self) -> list[Number]:
        return [mp.factorial(k) * term for k, term in enumerate(self.terms)]

    def __add__(self, other: Any) -> Series:
        return Series([a + b for a, b in zip(self.terms, _of(other).terms, strict=True)])

    def __mul__(self, other: Any) -> Series:
        a, b = self.terms, _of(other).terms
        return Series([mp.fsum(a[j] * b[k - j] for j in range(k + 1)) for k in range(_TERMS)])

    def __truediv__(self, other: Any) -> Series:
        b = _of(other).terms
        made: list[Number] = []
        for k, term in enumerate(self.terms):
            made.append((term - mp.fsum(made[j] * b[k - j] for j in range(k))) / b[0])
        return Series(made)

    def __pow__(self, power: int) -> Series:
        made = _of(1)
        for _ in range(power):
            made = made * self
        return made

    def __neg__(self) -> Series:
        return self * -1

    def __sub__(self, other: Any) -> Series:
        return self + -_of(other)

    def __rsub__(self, other: Any) -> Series:
        return -self + other

    def __rtruediv__(self, other: Any) -> Series:
        return _of(other) / self

    __radd__, __rmul__ = __add__, __mul__


def _of(value: Any) -> Series:
    return value if isinstance(value, Series) else Series([mp.mpf(value), *[mp.mpf(0)] * 3])


def _composed(inner: Series, outer: Sequence[Number]) -> Series:
    """A function of a series from its derivatives at the place."""
    step, made = Series([mp.mpf(0), *inner.terms[1:]]), _of(0)
    for k in reversed(range(_TERMS)):
        made = made * step + outer[k] / mp.factorial(k)
    return made


def sin(x: Any) -> Any:
    if not isinstance(x, Series):
        return mp.sin(x)
    s, c = mp.sin(x.terms[0]), mp.cos(x.terms[0])
    return _composed(x, [s, c, -s, -c])


def cos(x: Any) -> Any:
    return sin(x + mp.pi / 2)


def exp(x: Any) -> Any:
    return _composed(x, [mp.exp(x.terms[0])] * 4) if isinstance(x, Series) else mp.exp(x)
