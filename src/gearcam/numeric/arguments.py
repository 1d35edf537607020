"""Validation of the arguments of public functions; errors name the parameter."""

from __future__ import annotations

import operator
from collections.abc import Collection
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.errors import DesignError
from gearcam.base.numerals import formatted
from gearcam.numeric.arrays import Array

_SHOWN = 60
"""Largest number of characters of a wrong value that are shown."""

T = TypeVar("T")


def refused(message: str, name: str, value: object, allowed: str) -> DesignError:
    """Return the error for a wrong argument.

    Parameters
    ----------
    message : str
        What is wrong.
    name : str
        Name of the parameter.
    value : object
        Given value.
    allowed : str
        What is allowed there.

    Returns
    -------
    DesignError
    """
    return DesignError.of(message, key=name, value=value, allowed=allowed)


def instance(name: str, value: object, types: type[T] | tuple[type[T], ...], allowed: str) -> T:
    """Return the value if it is of an allowed type.

    Parameters
    ----------
    name : str
        Name of the parameter.
    value : object
        Given value.
    types : type or tuple of type
        Allowed types.
    allowed : str
        The same in words.

    Returns
    -------
    object

    Raises
    ------
    DesignError
        If it is of another type.
    """
    if not isinstance(value, types):
        raise refused(f"is a {type(value).__name__}", name, value, allowed)
    return value


def angles(
    name: str,
    values: ArrayLike,
    low: float = -np.inf,
    high: float = np.inf,
    slack: float = 0.0,
    unit: str = "rad",
) -> Array:
    """Return angles, or travels, as an array within a range.

    Parameters
    ----------
    name : str
        Name of the parameter.
    values : float or (n,) array, rad
        Given values.
    low, high : float, rad
        Range.
    slack : float, rad
        Rounding by which values may exceed the range; they are clipped.
    unit : str
        Another unit of all these.

    Returns
    -------
    (n,) array, rad
        Of length 1 for a single number.

    Raises
    ------
    DesignError
        If the values are not finite, not a number or a one-dimensional array, or out of range.
    """
    rule = f"a number or a one-dimensional array of numbers, {unit}"
    if np.isfinite(high - low):
        rule += f", from {formatted(low)} to {formatted(high)}"
    try:
        found = np.atleast_1d(np.asarray(values, dtype=np.float64))
    except (TypeError, ValueError):
        raise refused(f"{_text(values)} is not a number", name, values, rule) from None
    if found.ndim > 1:
        raise refused(f"has the shape {found.shape}", name, values, rule)
    wrong = found[~((found >= low - slack) & (found <= high + slack) & np.isfinite(found))]
    if wrong.size:
        raise refused(f"{formatted(wrong[0])} is out of range", name, values, rule)
    return np.clip(found, low, high)


def points(name: str, values: ArrayLike) -> Array:
    """Return the points of a closed outline as an array.

    Parameters
    ----------
    name : str
        Name of the parameter.
    values : (n, 2) array, mm
        Given points.

    Returns
    -------
    (n, 2) array, mm

    Raises
    ------
    DesignError
        If they are not three or more finite points.
    """
    rule = "an array (n, 2) of three points or more, mm"
    try:
        found = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise refused(f"{_text(values)} is not an array of numbers", name, values, rule) from None
    if found.ndim != 2 or found.shape[1] != 2 or len(found) < 3:
        raise refused(f"has the shape {found.shape}", name, values, rule)
    if not np.isfinite(found).all():
        raise refused("contains values that are not finite", name, values, rule)
    return found


def whole(name: str, value: object, least: int) -> int:
    """Return the value as a whole number.

    Parameters
    ----------
    name : str
        Name of the parameter.
    value : object
        Given value.
    least : int
        Least allowed number.

    Returns
    -------
    int

    Raises
    ------
    DesignError
        If it is not a whole number, or less than `least`.
    """
    rule = f"a whole number, {least} or more"
    try:
        found = operator.index(value)  # pyright: ignore[reportArgumentType]
    except TypeError:
        raise refused(f"{_text(value)} is not a whole number", name, value, rule) from None
    if found < least:
        raise refused(f"{_text(value)} is out of range", name, value, rule)
    return found


def one_of(name: str, value: object, known: Collection[str]) -> str:
    """Return the value if it is one of some words.

    Parameters
    ----------
    name : str
        Name of the parameter.
    value : object
        Given value.
    known : collection of str
        Allowed words.

    Returns
    -------
    str

    Raises
    ------
    DesignError
        If it is not one of them.
    """
    if not isinstance(value, str) or value not in known:
        rule = ", ".join(f'"{word}"' for word in known if word) or "leave it out"
        raise refused(f"{_text(value)} is not known here", name, value, rule)
    return value


def _text(value: object) -> str:
    text = repr(value)
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."
