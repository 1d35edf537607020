"""Numerals: numbers as text for people and in data files.

People see few digits, without ``-0`` and trailing zeros. Files keep doubles to the last bit, with
one exception: an angle of 60 degrees, converted to radians and back, is 59.99999999999999. So a
double within `ULPS` units in the last place of a decimal with `SHORT` digits is written as that
decimal; this concerns one in 50 000 random doubles. Rounding noise can be distinguished from a
small number only relative to a known scale; then it becomes 0.

Depends on nothing.
"""

from __future__ import annotations

import math
from typing import Any, Final

ULPS: Final = 2
"""Largest error of a conversion to radians and back, in units in the last place."""

SHORT: Final = 10
"""Significant digits of a decimal that may have been the input."""

NOISE: Final = 1e-12
"""Rounding noise relative to the scale."""

FEW: Final = 5
"""Significant digits of numbers that are read: places, and values in messages."""

TYPED: Final = 6
"""Significant digits of numbers that may be typed into a file, such as limits."""

_PLAIN: Final = 1e7
"""Larger numbers have an exponent."""

DIGITS: Final = 4
"""Digits of values that are named as remedies."""

_EVERY: Final = 17
"""Significant digits that tell any two doubles apart."""

_AGREE: Final = 5
"""Least number of significant digits in which a number and its rounded value must agree."""

_WHOLE: Final = 15
"""Length of the shortest text of a double up to which it needs no correction, characters."""


def formatted(value: float, digits: int = TYPED, scale: float = 0.0) -> str:
    """Return a number as text with few significant digits.

    Parameters
    ----------
    value : float
        Any number; infinity is ``inf``.
    digits : int
        Largest number of significant digits; trailing zeros are left out.
    scale : float
        Magnitude relative to which rounding noise is 0, in the unit of `value`; 0 if unknown.

    Returns
    -------
    str
    """
    value = settled(float(value), scale) + 0.0
    text = f"{value:.{digits}g}"
    plain = "e" in text and 1.0 <= abs(value) < _PLAIN
    return f"{float(text):.0f}" if plain else text


def in_range(value: float, low: float, high: float, digits: int = FEW, scale: float = 0.0) -> str:
    """Return a place in a range that repeats as text: what reads as its end is its begin.

    Parameters
    ----------
    value : float
        The place.
    low, high : float
        The range.
    digits, scale
        As of `formatted`.

    Returns
    -------
    str
    """
    text = formatted(value, digits, scale)
    return formatted(low, digits, scale) if text == formatted(high, digits, scale) else text


def told_apart(
    value: float | None, other: float | None, unit: str = "", digits: int = TYPED
) -> tuple[str, str]:
    """Return two numbers with their unit as text, so that numbers that differ look different.

    Parameters
    ----------
    value, other : float or None
        The numbers; the text of None is empty.
    unit : str
        Unit of both.
    digits : int
        Largest number of significant digits, unless it takes more.

    Returns
    -------
    str, str
    """

    def texts(count: int) -> tuple[str, str]:
        one, two = (
            "" if number is None else f"{formatted(number, count)} {unit}".rstrip()
            for number in (value, other)
        )
        return one, two

    while len({*texts(digits)}) == 1 and value != other and digits < _EVERY:
        digits += 1
    return texts(digits)


def rounds_to(value: float, written: float) -> bool:
    """Return whether a number as somebody wrote it is a `value`, rounded.

    Parameters
    ----------
    value : float
        A computed number.
    written : float
        As given; the zeros at its end are not known.
    """
    from decimal import Decimal

    number = Decimal(repr(exact(written))).normalize()
    count = max(_AGREE, len(number.as_tuple().digits))
    return abs(value - written) <= 0.5 * 10.0 ** (number.adjusted() + 1 - count)


def size_of(count: int) -> str:
    """Return a number of bytes as text: ``812 B``, ``3.4 kB``, ``1.2 MB``."""
    if count < 1000:
        return f"{count} B"
    return f"{decimal(count / 1e3, 1)} kB" if count < 1e6 else f"{decimal(count / 1e6, 1)} MB"


def decimal(value: float, decimals: int = 3) -> str:
    """Return a `value` with at most `decimals` decimals: no exponent, trailing zeros or ``-0``."""
    text = f"{value:.{decimals}f}".rstrip("0").rstrip(".") if decimals else f"{value:.0f}"
    return "0" if text == "-0" else text


def settled(value: float, scale: float) -> float:
    """Return the `value`, or 0 if it is rounding noise relative to `scale` in the same unit."""
    return 0.0 if abs(value) < NOISE * abs(scale) else value


def exact(value: float) -> float:
    """Return the short decimal nearest to a double if it is within `ULPS`, else the double.

    Parameters
    ----------
    value : float
        A computed number.

    Returns
    -------
    float
        At most `ULPS` units in the last place from `value`.
    """
    if len(repr(value)) <= _WHOLE or not math.isfinite(value):
        return value
    near = float(f"{value:.{SHORT}g}")
    return near if abs(near - value) <= ULPS * math.ulp(value) else value


def tree(value: Any) -> Any:
    """Return nested dicts and lists, a `value`, with each double replaced by `exact` of it."""
    if isinstance(value, dict):
        return {key: tree(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [tree(item) for item in value]
    return exact(value) if isinstance(value, float) else value


def shortened(value: float, side: float, digits: int = DIGITS) -> float:
    """Return a `value` in `digits`, its size rounded up where `side` is above 0, else down."""
    step = 10.0 ** (math.floor(math.log10(abs(value))) + 1 - digits)
    size = (math.ceil if side > 0.0 else math.floor)(abs(value) / step) * step
    return math.copysign(float(f"{size:.10g}"), value)


def rounded_down(value: float, digits: int = 6) -> str:
    """Return a positive `value` rounded down to `digits`, so that it keeps an upper limit."""
    step = 10.0 ** (math.floor(math.log10(value)) + 1 - digits)
    return formatted(math.floor(value / step * (1.0 + NOISE)) * step, digits)
