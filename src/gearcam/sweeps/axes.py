"""What is written for a key of a sweep.

==================================== ================================================
``0.1,0.2`` or ``[20,20],[24,24]``    values
``0.05:0.6:0.01``                     a range, with its end
``log(1, 100, 20)``                   20 values, evenly by their logarithm
``0.05:0.6``                          any number between; sampled
``log(1, 100)``                       any number between, evenly by its logarithm
``normal(20, 0.01)``                  a normal distribution: mean, standard deviation
``tolerance(20, 0.05)``               20 within 0.05 to either side: normal, a third of
                                      it as standard deviation, cut off at its ends
==================================== ================================================

A file has the same: texts, numbers and lists.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.base.errors import DesignError, Problem
from gearcam.base.numerals import formatted
from gearcam.designs.faults import show
from gearcam.designs.settings import listed_twice, setting_of, value_of, values_of

FORM: Final = (
    "values 0.1,0.2, a range from:to:step, from:to, log(1, 100, 20), normal(20, 0.01) or "
    "tolerance(20, 0.05)"
)
"""What may be written for a key."""

_CALL: Final = re.compile(r"(log|normal|tolerance)\((.*)\)")
_ROUNDING: Final = 1e-9
"""Share of a step by which the end of a range may be missed."""

_FEW: Final = 12
_LONG: Final = 50
"""Number of values of a list, and length of its text, up to which all are told."""

_CUT: Final = 3.0
"""Standard deviations of a tolerance."""


@dataclass(frozen=True, kw_only=True)
class Varied(ShortRepr):
    """What a sweep gives to one key.

    Parameters
    ----------
    key : str
        Dotted key of a design.
    text : str
        As written.
    values : tuple
        The values; empty if any between two is possible.
    share : callable, optional
        ``share(u)`` returns the value below which a share u of samples is; without `values`.
    whole : str
        All that tells it from others, where the text is shortened.
    """

    key: str
    text: str
    values: tuple[Any, ...] = ()
    share: Callable[[float], float] | None = None
    whole: str = ""

    @property
    def sampled(self) -> bool:
        """Whether its values can only be sampled."""
        return not self.values

    def at(self, u: float) -> Any:
        """Return the value at a share u of its range, in [0, 1)."""
        if self.share is None:
            return self.values[min(int(u * len(self.values)), len(self.values) - 1)]
        return self.share(u)


def axes_of(settings: Mapping[str, Any], key: str = "--set") -> tuple[Varied, ...]:
    """Return the axes of settings.

    Parameters
    ----------
    settings : mapping of str to value
        By dotted keys: a text as above, a value, or a list of values.
    key : str
        Where they are given, for messages.

    Raises
    ------
    DesignError
        With all that cannot be read.
    """
    found, problems = [], list[Problem]()
    for name, written in settings.items():
        try:
            found.append(_axis(name, written))
        except _UnreadableError as error:
            place = f"{key}.{name}" if key == "sweep" else key
            message = str(error) if key == "sweep" else f"{name}: {error}"
            problems.append(Problem(message, key=place, allowed=error.allowed))
    if problems:
        raise DesignError(problems)
    return tuple(found)


def settings_of(texts: Sequence[str]) -> dict[str, str]:
    """Return settings as typed, ``KEY=...``, by their keys.

    Raises
    ------
    DesignError
        If one is not of this form, or a key is given twice.
    """
    settings: dict[str, str] = {}
    for text in texts:
        key, words = setting_of(text) or ("", "")
        if not words:
            raise DesignError.of(f"{show(text)} is not KEY=...", key="--set", allowed=FORM)
        if key in settings:
            raise DesignError.of(f"{key} is set twice", key="--set", allowed="each key once")
        settings[key] = words
    return settings


class _UnreadableError(ValueError):
    def __init__(self, message: str, allowed: str = FORM) -> None:
        super().__init__(message)
        self.allowed = allowed


def _axis(key: str, written: Any) -> Varied:
    if not isinstance(written, str):
        values = written if isinstance(written, list) else [written]
        return (
            _given(key, values)
            if isinstance(written, list)
            else _listed(key, show(written), values)
        )
    text = written.strip()
    call = _CALL.fullmatch(text)
    if call:
        return _called(key, text, call[1], [_number(word, text) for word in call[2].split(",")])
    if ":" in text and not any(sign in text for sign in "[\"'"):
        return _range(key, text, text.split(":"))
    return _listed(key, text, values_of(text))


def _given(key: str, values: list[Any]) -> Varied:
    """Return an axis of a list of values, told by its ends if it is long."""
    axis = _listed(key, show(values), values)
    if len(values) <= _FEW and len(axis.text) < _LONG:
        return axis
    text = f"{len(values)} values, {show(values[0])} to {show(values[-1])}"
    return replace(axis, text=text, whole=json.dumps(values, default=str))


def _listed(key: str, text: str, values: list[Any]) -> Varied:
    if not values:
        raise _UnreadableError("has no value")
    if twice := listed_twice(values):
        raise _UnreadableError(f"{show(twice[0])} is listed twice", "each value once")
    return Varied(key=key, text=text, values=tuple(values))


def _number(word: str, text: str) -> float | int:
    value = value_of(word)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise _UnreadableError(f"{show(text)}: {show(word.strip())} is not a number")
    return value


def _range(key: str, text: str, words: list[str]) -> Varied:
    numbers = [_number(word, text) for word in words]
    if len(numbers) == 2:
        low, high = numbers
        if not low < high:
            raise _UnreadableError(
                f"{show(text)} is an empty range", "from:to, the smaller number first"
            )
        return Varied(key=key, text=text, share=lambda u: low + (high - low) * u)
    if len(numbers) != 3:
        raise _UnreadableError(
            f"{show(text)} is not a range", "from:to:step, or from:to to be sampled"
        )
    start, end, step = numbers
    if step == 0 or (end - start) / step < 0:
        near = formatted(math.copysign(abs(step) or 1.0, end - start))
        raise _UnreadableError(
            f"{show(text)}: a step of {formatted(step)} does not lead from {formatted(start)} to "
            f"{formatted(end)}",
            f"a step such as {near}",
        )
    count = math.floor((end - start) / step + _ROUNDING) + 1
    return Varied(key=key, text=text, values=tuple(_steps(start, end, step, count)))


def _steps(start: float, end: float, step: float, count: int) -> list[float]:
    """Return the values of a range in as few digits as its numbers have; its end exactly."""
    if all(isinstance(one, int) for one in (start, end, step)):
        return [start + k * step for k in range(count)]
    values = [float(f"{start + k * step:.12g}") for k in range(count)]
    if abs(values[-1] - end) <= _ROUNDING * abs(step):
        values[-1] = end
    return values


def _called(key: str, text: str, name: str, numbers: list[float | int]) -> Varied:
    if name == "log":
        return _logarithmic(key, text, numbers)
    if len(numbers) != 2 or not numbers[1] > 0:
        allowed = "normal(mean, standard deviation)"
        if name == "tolerance":
            allowed = "tolerance(value, deviation to either side)"
        raise _UnreadableError(f"{show(text)} is not two numbers, the second above 0", allowed)
    middle, width = numbers
    if name == "normal":
        normal = NormalDist(middle, width)
        return Varied(
            key=key, text=text, share=lambda u: normal.inv_cdf(min(max(u, 1e-12), 1 - 1e-12))
        )
    unit, edge = NormalDist(), NormalDist().cdf(-_CUT)

    def within(u: float) -> float:
        return middle + width / _CUT * unit.inv_cdf(edge + (1.0 - 2.0 * edge) * u)

    return Varied(key=key, text=text, share=within)


def _logarithmic(key: str, text: str, numbers: list[float | int]) -> Varied:
    low, high, *more = numbers if len(numbers) > 1 else (0, 0)
    if len(more) > 1 or not 0 < low < high or any(one != int(one) or one < 2 for one in more):
        allowed = "log(from, to) or log(from, to, number of values), with 0 < from < to"
        raise _UnreadableError(f"{show(text)} is not a range by logarithm", allowed)

    def between(u: float) -> float:
        return low * (high / low) ** u

    if not more:
        return Varied(key=key, text=text, share=between)
    last = int(more[0]) - 1
    values = [float(f"{between(k / last):.12g}") for k in range(last)]
    return Varied(key=key, text=text, values=(*values, high))
