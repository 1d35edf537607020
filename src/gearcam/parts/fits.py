"""Fits: limits of holes and shafts by ISO 286, and sizes that have a tolerance class.

A *class* is a letter with a grade: the letter gives the *fundamental deviation*, that of the limit
nearest to the nominal size, the grade the *tolerance* between both limits. Capital letters are of
holes, small ones of shafts. Numbers are tables: those of formulas differ after rounding.

Source: ISO 286-1:2010, standard tolerances and fundamental deviations; the tables agree with the
Python packages pressfit 0.1.0 and, but for three slips of its own, isofits 1.0 (see
docs/sources.md). Of each letter only those grades are here that bores, shafts and keys use.

Depends on base only.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Mapping
from typing import Any, Final, Self

from gearcam.base.errors import DesignError
from gearcam.base.numerals import formatted
from gearcam.base.quantities import params_of, size_pattern

_SIZES: Final = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)
"""Ends of the ranges of sizes, mm: over the one before, up to and including this."""

_FINER: Final = (
    3, 6, 10, 18, 30, 50, 65, 80, 100, 120, 140, 160, 180, 200, 225, 250, 280, 315, 355, 400, 450,
    500,
)  # fmt: skip
"""The same for letters whose deviations change more often."""

_TOLERANCES: dict[int, tuple[int, ...]] = {
    4: (3, 4, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20),
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    9: (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
    10: (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250),
    11: (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400),
}
_TOLERANCES |= {grade + 5: tuple(10 * one for one in _TOLERANCES[grade]) for grade in (7, 8, 9)}
"""Standard tolerances IT by grade, um; IT4 serves others only, from IT12 on those of five grades
before are ten times as large."""

_BELOW: Final = {
    "d": (20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230),
    "e": (14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135),
    "f": (6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68),
    "g": (2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20),
    "h": (0,) * 13,
}
"""How far the upper limit of shafts is below the nominal size, um."""

_ABOVE: Final[Mapping[str, tuple[int, ...]]] = {
    "k": (0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5),
    "m": (2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23),
    "n": (4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40),
    "p": (6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68),
    "r": (
        10, 15, 19, 23, 28, 34, 41, 43, 51, 54, 63, 65, 68, 77, 80, 84, 94, 98, 108, 114, 126, 132,
    ),
    "s": (
        14, 19, 23, 28, 35, 43, 53, 59, 71, 79, 92, 100, 108, 122, 130, 140, 158, 170, 190, 208,
        232, 252,
    ),
}  # fmt: skip
"""How far the lower limit of shafts is above the nominal size, um: k to its grade 7, coarser ones
begin at it."""

GRADES: Final = {
    "D": (8, 11), "E": (7, 9), "F": (6, 9), "G": (5, 7), "H": (5, 14), "JS": (5, 14), "K": (5, 8),
    "M": (5, 9), "N": (5, 9), "P": (5, 9), "R": (5, 8), "S": (5, 8),
    "d": (8, 11), "e": (6, 9), "f": (5, 9), "g": (5, 7), "h": (5, 14), "js": (5, 14), "k": (5, 8),
    "m": (5, 8), "n": (5, 8), "p": (5, 8), "r": (5, 8), "s": (5, 8),
}  # fmt: skip
"""The first and the last grade of each letter."""

_LARGEST: Final = 500.0
_SMALLEST: Final = 1.0
"""Sizes, mm, for which there are limits."""

_SIZE: Final = re.compile(rf"\s*{size_pattern()}\s*", re.ASCII)

HOLE: Final = rf"^\s*{size_pattern('JS|[DEFGHKMNPRS]')}\s*$"
"""Pattern of the size of a hole for a schema, which does not look at its number."""


class FitSize(float):
    """A size with the tolerance class that gives its limits by ISO 286: a number, mm.

    It is equal to the number, and what is computed from it is a plain number.

    Parameters
    ----------
    text : str or FitSize
        Size, mm, and class, such as ``25 H7``: capital letters for holes, small ones for shafts.

    Raises
    ------
    DesignError
        If it is no such text, or limits of its class are not known.

    Examples
    --------
    >>> import gearcam as gc
    >>> size = gc.FitSize("25 H7")
    >>> size, size.lower, size.upper, 0.5 * size
    (FitSize('25 H7'), 0.0, 0.021, 12.5)
    """

    tolerance_class: str
    """Letter and grade, such as ``H7``."""

    lower: float
    upper: float
    """Deviations of the limits from the size, mm."""

    def __new__(cls, text: str) -> Self:
        """Return the size of a `text`."""
        found = _SIZE.fullmatch(str(text))
        if found is None:
            what = f"{text!r} is not a size with a tolerance class"
            raise DesignError.of(what, allowed='such as "25 H7"')
        made = super().__new__(cls, found[1])
        made.tolerance_class = f"{found[3]}{int(found[4])}"
        low, high = _limits(float(made), found[3], int(found[4]))
        made.lower, made.upper = low / 1000.0, high / 1000.0
        return made

    def __reduce__(self) -> tuple[type[Self], tuple[str]]:
        return type(self), (str(self),)

    def __str__(self) -> str:
        number = float.__repr__(self)
        return f"{number.removesuffix('.0')} {self.tolerance_class}"

    def __repr__(self) -> str:
        return f"{type(self).__name__}({str(self)!r})"


class Fitted:
    """Base of dataclasses: their sizes may be given as a text such as ``25 H7``."""

    def __post_init__(self) -> None:
        """Replace such texts by what they mean; wrong ones are left to those who examine them."""
        for name, one in params_of(type(self)).items():
            if one.fit:
                object.__setattr__(self, name, fitted(getattr(self, name)))


def fitted(value: Any) -> Any:
    """Return a `value`, or each of several, as the size that it is if it is the text of one."""
    if isinstance(value, list | tuple):
        return type(value)(map(fitted, value))
    try:
        return FitSize(value) if isinstance(value, str) else value
    except DesignError:
        return value


def without_class(value: Any) -> Any:
    """Return a `value`, or each of several, as a number if it is a size with a class."""
    if isinstance(value, list | tuple):
        return type(value)(map(without_class, value))
    size = fitted(value)
    return +size if isinstance(size, FitSize) else value


def in_class_of(given: Any, value: Any) -> Any:
    """Return a `value` as a size with the class of what is `given`, in the place of which it comes.

    Parameters
    ----------
    given : object
        Number, text of a size with a class, or a list of them.
    value : object
        A number, or as many as are given; one may stand for several.

    Returns
    -------
    object
        Texts; numbers where nothing with a class is given, or its limits are not known for them.
    """
    old = fitted(given)
    if isinstance(old, list) and any(isinstance(one, FitSize) for one in old):
        values = value if isinstance(value, list) else [value] * len(old)
        kept = [in_class_of(*one) for one in zip(given, values, strict=True)]
        return kept if isinstance(value, list) or kept[1:] != kept[:-1] else kept[0]
    if not isinstance(old, FitSize) or isinstance(value, str):
        return value
    text = f"{formatted(float(value), 10)} {old.tolerance_class}"
    return text if isinstance(fitted(text), FitSize) else value


def hole_problem(text: str) -> tuple[str, str, str]:
    """Return what is wrong with a `text` as the size of a hole, what is allowed, and what is near.

    All are empty if nothing is wrong; the first is if the text is not that of a size with a class.
    """
    found = _SIZE.fullmatch(text)
    if found is None:
        return "", "", ""
    letter, grade = found[3].upper(), int(found[4])
    if found[3] not in GRADES or not found[3][0].isupper():
        what = f"{found[3]} is no letter of a hole that is known"
        if found[3].islower() and letter in GRADES:
            what = f"{found[3]}{grade} is the class of a shaft, and this is a hole"
        allowed = ", ".join(one for one in GRADES if one[0].isupper())
        near = _near_class(letter, grade)
        return what, f"a letter of {allowed}", f"{found[1]} {near}"
    try:
        FitSize(text)
    except DesignError as error:
        (problem,) = error.problems
        inside = _SMALLEST <= float(found[1]) <= _LARGEST
        near = f"{found[1]} {_near_class(letter, grade)}" if inside else ""
        return problem.message, problem.allowed, near
    return "", "", ""


def _near_class(letter: str, grade: int) -> str:
    """Return the class of a hole that is nearest to a letter and a grade."""
    known = [one for one in GRADES if one[0].isupper()]
    near = min(known, key=lambda one: (one != letter, abs(ord(one[0]) - ord(letter[0]))))
    first, last = GRADES[near]
    return f"{near}{min(max(grade, first), last)}"


def _limits(size: float, letter: str, grade: int) -> tuple[float, float]:
    """Return the lower and the upper deviation of a class at a `size`, mm, in um."""
    if letter not in GRADES:
        what = f"the letter {letter} is not known"
        raise DesignError.of(what, allowed=f"a letter of {', '.join(GRADES)}")
    first, last = GRADES[letter]
    if not first <= grade <= last:
        what = f"limits of {letter}{grade} are not known"
        raise DesignError.of(what, allowed=f"{letter}{first} to {letter}{last}")
    if not _SMALLEST <= size <= _LARGEST:
        what = "limits are not known for this size"
        allowed = f"sizes from {formatted(_SMALLEST)} to {formatted(_LARGEST)} mm"
        raise DesignError.of(what, allowed=allowed)
    tolerance, shaft = _at(_TOLERANCES[grade], size), letter.lower()
    if shaft == "js":
        return -0.5 * tolerance, 0.5 * tolerance
    if shaft in _BELOW:
        away = _at(_BELOW[shaft], size)
        return (-away - tolerance, -away) if shaft == letter else (away, away + tolerance)
    if shaft == letter:
        away = 0 if shaft == "k" and grade > 7 else _at(_ABOVE[shaft], size)
        return away, away + tolerance
    upper = _upper_of_hole(size, letter, grade)
    return upper - tolerance, upper


def _at(row: tuple[int, ...], size: float) -> int:
    """Return the value of a row of a table at a `size`, mm."""
    return row[bisect_left(_SIZES if len(row) == len(_SIZES) else _FINER, size)]


def _upper_of_hole(size: float, letter: str, grade: int) -> int:
    """Return the upper deviation of a hole of K to S, um: finer ones are less far in.

    With the shaft of the same letter that is one grade finer they give the same fit as the shaft
    with the hole H of their grade.
    """
    if (letter, grade) == ("M", 6) and 250 < size <= 315:
        return -9  # as printed
    if letter == "N" and grade > 8 and size > 3:
        return 0
    upper = -_at(_ABOVE[letter.lower()], size)
    if size > 3 and grade <= (8 if letter in "KMN" else 7):
        upper += _at(_TOLERANCES[grade], size) - _at(_TOLERANCES[grade - 1], size)
    return upper
