"""Numbers with their units as people read them: on the console and on pages.

A number has four significant digits, five where it begins with 1; lengths in mm and angles in deg
have five down to 0.001 mm and 0.01 deg. None is finer than the error that is stated with the value.
A decimal of at most five digits, as people write it in a file, is written as it is. Units are
chosen so that numbers lie between 0.1 and 10 000: ``123.46 m/s2``, not ``123456 mm/s2``.

Files for machines keep the unit of their key and all digits; what is typed into a design file is
written by `gearcam.base.numerals`. ``report/numbers.js`` does for a page what this module does.

Depends on nothing but numerals.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_HALF_EVEN, Decimal
from typing import Any, Final

from gearcam.base.numerals import exact

LEAST: Final = 0.1
MOST: Final = 1e4
"""Between these a number is read at a glance: its unit is kept."""

ERROR_DIGITS: Final = 2
"""Significant digits of an error."""

_DIGITS: Final = 4
"""Significant digits of a number, one more where it begins with 1."""

_FINEST: Final[Mapping[str, int]] = {"mm": 3, "in": 4, "deg": 2}
"""Decimals of what is made and set, within `_DIGITS` and one more digit."""

_WRITTEN: Final = 5
"""Largest number of digits of a decimal that is written as it is."""

_SHORT: Final = 2
"""Largest number of digits of a small decimal that keeps the unit in which it was written."""

_SHORTEST: Final = 1e-3
"""Least of such decimals."""

_HOPELESS: Final = 2.0
"""Decades out of reach in every unit, from which the own one is kept."""

_ROUNDING: Final = 1e-10
"""Distance from a decimal, as a share of it, that is rounding."""

_SMALL, _LARGE = 1e-4, 1e7
"""Numbers outside of these have an exponent, where no unit makes them readable."""

_FAINT: Final = 2
"""Least number of digits of a small number beside a large one in a column."""

_NOISE: Final = 1e-6
"""Share of the largest number of a column up to which others may be rounded to 0."""

_APART: Final = 17
"""Significant digits that tell any two doubles apart."""

_DEG: Final = math.pi / 180.0

_LADDERS: Final[tuple[Mapping[str, float], ...]] = (
    {"um": 1e-3, "mm": 1.0, "m": 1e3, "km": 1e6},
    {"um2": 1e-6, "mm2": 1.0, "cm2": 1e2, "m2": 1e6},
    {"mm3": 1.0, "cm3": 1e3, "dm3": 1e6, "m3": 1e9},
    {"1/m": 1e-3, "1/mm": 1.0},
    {"urad": 1e-6, "mrad": 1e-3, "rad": 1.0, "krad": 1e3, "Mrad": 1e6},
    {"mN": 1e-3, "N": 1.0, "kN": 1e3, "MN": 1e6},
    {"N mm": 1e-3, "N m": 1.0, "kN m": 1e3},
    {"kPa": 1e-3, "MPa": 1.0, "GPa": 1e3},
    {"mJ": 1e-3, "J": 1.0, "kJ": 1e3},
    {"mW": 1e-3, "W": 1.0, "kW": 1e3},
    {"us": 1e-6, "ms": 1e-3, "s": 1.0},
    {"Hz": 1.0, "kHz": 1e3},
    {"mg": 1e-6, "g": 1e-3, "kg": 1.0, "t": 1e3},
    {"g mm": 1.0, "kg mm": 1e3},
    {"g mm2": 1e-9, "kg mm2": 1e-6, "kg cm2": 1e-4, "kg m2": 1.0},
)
"""Units of one quantity with their sizes, the smallest first; the first word before a ``/``."""

_KEPT: Final = ("kg/m3", "N s/mm", "g", "t", "s", "rad/rad")
"""Units that are not changed although they begin like one of a ladder."""

_UPWARD: Final = ("km", "krad", "Mrad")
"""Units that only rates have: accelerations and jerks are large, places and angles are not."""

_TURNING: Final = ("deg/s", "deg/s2", "deg/s3")
"""Rates that are told in rad where they are large in deg."""


@dataclass(frozen=True)
class UnitScale:
    """A unit for numbers: what was in another unit is multiplied by the factor.

    Parameters
    ----------
    unit : str
        Name.
    factor : float
        Of values in the unit before.
    """

    unit: str
    factor: float = 1.0

    def times(self, value: float) -> float:
        """Return a value in the unit; that of a decimal and a power of ten is a decimal too."""
        if self.factor == 1.0:
            return value
        power = round(math.log10(self.factor))
        if not math.isclose(self.factor, 10.0**power, rel_tol=1e-12):
            return self.factor * value
        return float(Decimal(repr(float(value))).scaleb(power))


def scale_of(size: float, unit: str) -> UnitScale:
    """Return the unit in which numbers up to a size are read at a glance.

    Parameters
    ----------
    size : float
        The largest magnitude of all numbers that share the unit.
    unit : str
        Their unit.

    Returns
    -------
    UnitScale
        The same unit if the size is 0, from `LEAST` to below `MOST`, or if no other unit is better;
        else the next one in which it is.

    Examples
    --------
    >>> scale_of(123456.0, "mm/s2")
    UnitScale(unit='m/s2', factor=0.001)
    >>> scale_of(0.02, "N m").unit, scale_of(40.0, "mm").unit
    ('N mm', 'mm')
    """
    size = abs(size)
    if size == 0.0 or LEAST <= size < MOST:
        return UnitScale(unit)
    choices = [UnitScale(unit), *_others(unit)]
    best = min(choices, key=lambda one: (_beyond(size * one.factor), abs(math.log(one.factor))))
    return best if _beyond(size * best.factor) < _HOPELESS else choices[0]


def _beyond(size: float) -> float:
    """Return by how many decades a size is out of reach."""
    return max(0.0, math.log10(LEAST / size) - 1e-12, math.log10(size / MOST) + 1e-12)


def _others(unit: str) -> Iterator[UnitScale]:
    """Yield the other units of what a unit measures."""
    if unit in _KEPT:
        return
    if unit in _TURNING:
        rest = unit.removeprefix("deg")
        yield from (
            UnitScale(f"{name}{rest}", _DEG / size) for name, size in _ladder("rad").items()
        )
        return
    head, slash, tail = ("", "", "") if _ladder(unit) else unit.partition("/")
    ladder = _ladder(head or unit)
    for name, size in ladder.items():
        if name != (head or unit) and (slash or name not in _UPWARD):
            yield UnitScale(f"{name}{slash}{tail}", ladder[head or unit] / size)


def _ladder(unit: str) -> Mapping[str, float]:
    return next((one for one in _LADDERS if unit in one), {})


def scale_for(values: Sequence[float], unit: str) -> UnitScale:
    """Return the unit in which numbers are read at a glance (see `scale_of`).

    Short decimals that somebody wrote, as a tolerance of 0.05 mm, keep their unit.

    Parameters
    ----------
    values : sequence of float
        The numbers, which share a unit; whole numbers are counts.
    unit : str
        Their unit.

    Returns
    -------
    UnitScale
    """
    sizes = [abs(float(one)) for one in values]
    size = max(sizes, default=0.0)
    kept = size < LEAST and all(one == 0.0 or _short(one) for one in sizes)
    return UnitScale(unit) if kept or not math.isfinite(size) else scale_of(size, unit)


def _short(value: float) -> bool:
    given = _written(value)
    return given is not None and value >= _SHORTEST and len(given.as_tuple().digits) <= _SHORT


def number(value: float, unit: str = "", *, error: float = 0.0, digits: int = 0) -> str:
    """Return a number as people read it, in its unit and without that.

    Parameters
    ----------
    value : float
        The number; a whole number is a count and written in full.
    unit : str
        Its unit, on which the digits depend.
    error : float
        Its stated error: no digit is finer; 0 if none is.
    digits : int
        Number of significant digits; 0: the usual one.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If the value is not finite.

    Examples
    --------
    >>> number(41.96071, "mm"), number(2376.34, "MPa"), number(1.857142)
    ('41.961', '2376', '1.8571')
    >>> number(2376.34, "MPa", error=47.0), number(0.05, "mm"), number(1.3e-12)
    ('2400', '0.05', '1.3000e-12')
    """
    if isinstance(value, int):
        return str(value)
    value = _finite(value)
    given = _written(value)
    most = digits or _WRITTEN
    if given and -_exponent(given) <= _finest(error) and len(given.as_tuple().digits) <= most:
        return _plain(given)
    return _rounded(value, _decimals(value, unit, error, digits))


def column(values: Sequence[float], unit: str = "", *, error: float = 0.0) -> tuple[str, ...]:
    """Return numbers of one quantity with the same number of decimals, so that they line up.

    Parameters
    ----------
    values : sequence of float
        The numbers, in the same unit; counts are written in full.
    unit : str
        Their unit.
    error : float
        Their stated error.

    Returns
    -------
    tuple of str
        A number much smaller than the largest has decimals of its own, 0 as many as the others.

    Examples
    --------
    >>> column([9.5, 10.25, 0.0]), column([41.96071, 45.0], "mm")
    (('9.50', '10.25', '0.00'), ('41.961', '45.000'))
    """
    if all(isinstance(one, int) for one in values):
        return tuple(map(str, values))
    numbers = [_finite(one) for one in values]
    own = [_written(one) for one in numbers]
    given = [None if one is None or -_exponent(one) > _finest(error) else one for one in own]
    if None in given:
        decimals = _decimals(max(numbers, key=abs), unit, error, 0)
    else:
        decimals = max(-_exponent(one) for one in given if one is not None)
    noise = _NOISE * max(map(abs, numbers))
    needed = (_least(one, as_is, error, noise) for one, as_is in zip(numbers, given, strict=True))
    return tuple(
        _rounded(one, max(decimals, least)) for one, least in zip(numbers, needed, strict=True)
    )


def ends(values: Sequence[float], unit: str = "", *, error: float = 0.0) -> tuple[str, ...]:
    """Return the ends of a range: as somebody wrote them, or with the same number of decimals.

    Parameters
    ----------
    values, unit, error
        As of `column`; 0, and noise beside the other end, is ``0``.
    """
    alone = [number(one, unit, error=error) for one in values]
    if all(_written(_finite(one)) is not None for one in values):
        return tuple(alone)
    return tuple(text if float(text) else "0" for text in column(values, unit, error=error))


def _least(value: float, given: Decimal | None, error: float, noise: float) -> float:
    """Return the decimals that a small number needs, as far as it is known and no noise."""
    if abs(value) <= noise:
        return -math.inf
    least = _decimals(value, "", error, _FAINT)
    return least if given is None else min(least, -_exponent(given))


def readable(value: float, unit: str = "", *, error: float = 0.0, digits: int = 0) -> str:
    """Return a number with its unit as people read it (see `number`, `scale_for`).

    Parameters
    ----------
    value : float
        The number.
    unit : str
        Its unit; it is told in another one where that is easier to read.
    error : float
        Its stated error, in the same unit.
    digits : int
        Number of significant digits; 0: the usual one.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If the value is not finite.

    Examples
    --------
    >>> readable(123456.0, "mm/s2"), readable(0.0546934, "mm"), readable(8, "teeth")
    ('123.46 m/s2', '54.69 um', '8 teeth')
    """
    if isinstance(value, int):
        return f"{value} {unit}".rstrip()
    to = scale_for([value], unit)
    text = number(to.times(value), to.unit, error=error * to.factor, digits=digits)
    return f"{text} {to.unit}".rstrip()


def against(
    value: float | None, limit: float | None, unit: str = "", *, error: float = 0.0, kept: bool
) -> tuple[str, str]:
    """Return a value and its limit with one unit; they look different where the limit is broken.

    Parameters
    ----------
    value, limit : float or None
        The numbers; the text of None is empty.
    unit : str
        Unit of both.
    error : float
        Stated error of the value.
    kept : bool
        Whether the value keeps the limit: then both may look alike.

    Returns
    -------
    str, str
    """
    to = scale_for([one for one in (value, limit) if one is not None], unit)
    pair = [None if one is None else to.times(one) for one in (value, limit)]
    errors = (error * to.factor, 0.0)
    texts = [
        "" if one is None else number(one, to.unit, error=off)
        for one, off in zip(pair, errors, strict=True)
    ]
    if value is not None and limit is not None and value != limit and not kept:
        digits = _DIGITS
        while float(texts[0]) == float(texts[1]) and digits < _APART:
            digits += 1
            texts = [bare(number(one, digits=digits)) for one in pair if one is not None]
    first, second = (f"{text} {to.unit}".rstrip() if text else "" for text in texts)
    return first, second


def bare(text: str) -> str:
    """Return a number as text without the zeros at the end of its decimals."""
    mantissa, power, rest = text.partition("e")
    return (mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa) + power + rest


def labelled(label: str) -> tuple[str, str]:
    """Return the words and the unit of the label of an axis: ``("velocity", "mm/s")``."""
    words, comma, unit = label.rpartition(", ")
    return (words, unit) if comma else (label, "")


def _finite(value: Any) -> float:
    value = float(value)
    if not math.isfinite(value):
        raise ValueError(f"{value} is no number that can be shown")
    return value


def _written(value: float) -> Decimal | None:
    """Return a value as the decimal that somebody wrote; None if it is no such one."""
    near = float(f"{exact(value):.{_WRITTEN}g}")
    if abs(near - value) > _ROUNDING * abs(value):
        return None
    given = Decimal(repr(near)).normalize()
    return given if value == 0.0 or _SMALL <= abs(value) < _LARGE else None


def _exponent(given: Decimal) -> int:
    """Return the power of ten of the last digit of a decimal."""
    return min(0, int(given.as_tuple().exponent))


def _finest(error: float) -> float:
    """Return the largest number of decimals that an error allows; infinity without one."""
    return math.floor(-math.log10(error) + 1e-9) if error > 0.0 else math.inf


def _decimals(value: float, unit: str, error: float, digits: int) -> int:
    """Return the number of decimals of a value; below 0 it is rounded to tens and more."""
    if value == 0.0:
        return int(min(0, _finest(error)))
    lead = _lead(value)
    if not digits and unit in _FINEST:
        digits = max(_DIGITS, min(_DIGITS + 1, lead + 1 + _FINEST[unit]))
    elif not digits:
        digits = _DIGITS + (f"{abs(value):e}"[0] == "1")
    return int(min(digits - 1 - lead, _finest(error)))


def _lead(value: float) -> int:
    """Return the power of ten of the first digit."""
    return int(f"{abs(value):e}".partition("e")[2])


def _rounded(value: float, decimals: float) -> str:
    """Return a value with a number of decimals."""
    step = Decimal(1).scaleb(-int(decimals))
    rounded = Decimal(repr(value)).quantize(step, rounding=ROUND_HALF_EVEN)
    return _plain(rounded)


def _plain(rounded: Decimal) -> str:
    """Return a decimal without ``-0``; with an exponent where it has many zeros."""
    size = abs(rounded)
    if size and (size < Decimal(str(_SMALL)) or size >= Decimal(str(_LARGE))):
        mantissa, _, power = f"{rounded:e}".partition("e")
        return f"{mantissa}e{int(power)}"
    text = format(rounded, "f")
    return text if size else text.removeprefix("-")
