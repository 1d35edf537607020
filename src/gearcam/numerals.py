"""Numerals: how a number is shown to people, and how it stands in files of numbers.

People are shown few digits, and never ``-0`` or an idle zero. Files keep doubles to the last bit,
but for one thing: an angle that was given as 60 degrees, kept in radians and turned into degrees
again, is 59.99999999999999. So a double that is at most `ULPS` units in its last place away from a
decimal of `SHORT` digits is written as this decimal; of doubles at random one in 50 000 is, and
moves by no more than that. Rounding noise can be told from a small number only where the scale is
known that it is held against; then it is 0.

Depends on nothing.
"""

from __future__ import annotations

import math
from typing import Any, Final

ULPS: Final = 2
"""Units in the last place that a way to radians and back may take."""

SHORT: Final = 10
"""Significant digits of a decimal that somebody may have meant."""

NOISE: Final = 1e-12
"""Relative to the scale: what is smaller is rounding."""

_WHOLE: Final = 15
"""Characters of a double's shortest text up to which it has no such neighbour."""


def shown(value: float, digits: int = 6, scale: float = 0.0) -> str:
    """Return a number in significant digits, as people are shown it.

    Parameters
    ----------
    value : float
        Any; infinite ones are ``inf``.
    digits : int
        At most so many; idle zeros are left out.
    scale : float
        What it is held against, in its unit; 0 if unknown. Rounding noise against it is 0.

    Returns
    -------
    str
    """
    return f"{settled(float(value), scale) + 0.0:.{digits}g}"


def with_unit(value: float | None, unit: str) -> str:
    """Return a `value` as people are shown it, with its `unit`; nothing where there is none."""
    return "" if value is None else f"{shown(value)} {unit}".rstrip()


def size_of(count: int) -> str:
    """Return a `count` of bytes as people read it: ``812 B``, ``3.4 kB``, ``1.2 MB``."""
    if count < 1000:
        return f"{count} B"
    return f"{decimal(count / 1e3, 1)} kB" if count < 1e6 else f"{decimal(count / 1e6, 1)} MB"


def decimal(value: float, decimals: int = 3) -> str:
    """Return a `value` with up to as many `decimals`: no exponent, no idle zeros, no ``-0``."""
    text = f"{value:.{decimals}f}".rstrip("0").rstrip(".") if decimals else f"{value:.0f}"
    return "0" if text == "-0" else text


def settled(value: float, scale: float) -> float:
    """Return the `value`, or 0 where it is rounding noise against a `scale` in its unit."""
    return 0.0 if abs(value) < NOISE * abs(scale) else value


def exact(value: float) -> float:
    """Return the decimal of few digits that a double stands beside, else the double itself.

    Parameters
    ----------
    value : float
        As computed.

    Returns
    -------
    float
        At most `ULPS` units in the last place away.
    """
    if len(repr(value)) <= _WHOLE or not math.isfinite(value):
        return value
    near = float(f"{value:.{SHORT}g}")
    return near if abs(near - value) <= ULPS * math.ulp(value) else value


def tree(made: Any) -> Any:
    """Return what is `made` of dicts, lists and numbers with each double as `exact` gives it."""
    if isinstance(made, dict):
        return {key: tree(value) for key, value in made.items()}
    if isinstance(made, list | tuple):
        return [tree(value) for value in made]
    return exact(made) if isinstance(made, float) else made


def rounded_down(value: float, digits: int = 6) -> str:
    """Return a positive `value` in few `digits`, never above it: who takes it keeps the limit."""
    step = 10.0 ** (math.floor(math.log10(value)) + 1 - digits)
    return shown(math.floor(value / step * (1.0 + NOISE)) * step, digits)
