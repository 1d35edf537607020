"""Arguments of public functions: numbers that are what they have to be, or refused by name."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from gearcam.errors import DesignError, Problem
from gearcam.numerals import shown
from gearcam.numeric.arrays import Array

_SHOWN = 60
"""Letters of a wrong value that are shown."""

T = TypeVar("T")


def refused(message: str, name: str, value: object, allowed: str) -> DesignError:
    """Return the refusal of an argument.

    Parameters
    ----------
    message : str
        What is wrong.
    name : str
        Of the parameter.
    value : object
        What was given.
    allowed : str
        What is allowed there.

    Returns
    -------
    DesignError
    """
    return DesignError([Problem(message, key=name, value=value, allowed=allowed)])


def instance(name: str, value: object, types: type[T] | tuple[type[T], ...], allowed: str) -> T:
    """Return an object that a caller gives.

    Parameters
    ----------
    name : str
        Of the parameter.
    value : object
        What was given.
    types : type or tuple of type
        Of which it may be.
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
    """Return angles, or ways, that a caller gives.

    Parameters
    ----------
    name : str
        Of the parameter.
    values : float or (n,) array, rad
        What was given.
    low, high : float, rad
        Between which they may lie.
    slack : float, rad
        By which they may lie beyond: rounding. They are moved back then.
    unit : str
        Of all these, if it is another.

    Returns
    -------
    (n,) array, rad
        One for a single number.

    Raises
    ------
    DesignError
        If they are no finite numbers in one row, or lie beyond.
    """
    rule = f"a number or a row of numbers, {unit}"
    if np.isfinite(high - low):
        rule += f", from {shown(low)} to {shown(high)}"
    try:
        found = np.atleast_1d(np.asarray(values, dtype=np.float64))
    except (TypeError, ValueError):
        raise refused(f"{_text(values)} is no number", name, values, rule) from None
    if found.ndim > 1:
        raise refused(f"has the shape {found.shape}", name, values, rule)
    wrong = found[~((found >= low - slack) & (found <= high + slack) & np.isfinite(found))]
    if wrong.size:
        raise refused(f"{shown(wrong[0])} is out of range", name, values, rule)
    return np.clip(found, low, high)


def points(name: str, values: ArrayLike) -> Array:
    """Return points of a closed outline that a caller gives.

    Parameters
    ----------
    name : str
        Of the parameter.
    values : (n, 2) array, mm
        What was given.

    Returns
    -------
    (n, 2) array, mm

    Raises
    ------
    DesignError
        If they are no three finite points or more.
    """
    rule = "an array (n, 2) of three points or more, mm"
    try:
        found = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise refused(f"{_text(values)} is no array of numbers", name, values, rule) from None
    if found.ndim != 2 or found.shape[1] != 2 or len(found) < 3:
        raise refused(f"has the shape {found.shape}", name, values, rule)
    if not np.isfinite(found).all():
        raise refused("holds what is no finite number", name, values, rule)
    return found


def whole(name: str, value: object, least: int) -> int:
    """Return a whole number that a caller gives.

    Parameters
    ----------
    name : str
        Of the parameter.
    value : object
        What was given.
    least : int
        The least that it may be.

    Returns
    -------
    int

    Raises
    ------
    DesignError
        If it is no whole number, or less.
    """
    rule = f"a whole number, {least} or more"
    try:
        found = operator.index(value)  # pyright: ignore[reportArgumentType]
    except TypeError:
        raise refused(f"{_text(value)} is no whole number", name, value, rule) from None
    if found < least:
        raise refused(f"{_text(value)} is out of range", name, value, rule)
    return found


def one_of(name: str, value: object, known: Sequence[str]) -> str:
    """Return a word that a caller gives.

    Parameters
    ----------
    name : str
        Of the parameter.
    value : object
        What was given.
    known : sequence of str
        The words.

    Returns
    -------
    str

    Raises
    ------
    DesignError
        If it is none of them.
    """
    if not isinstance(value, str) or value not in known:
        rule = ", ".join(f'"{word}"' for word in known if word) or "leave it out"
        raise refused(f"{_text(value)} is not known here", name, value, rule)
    return value


def _text(value: object) -> str:
    text = repr(value)
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."
