"""The numbers of a design file: what each means, how far its slider goes, and how to replace it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

from gearcam.designs.design import path_of
from gearcam.designs.faults import dotted
from gearcam.designs.kind import KINDS
from gearcam.designs.lines import Path, spans_of
from gearcam.designs.reader import document_in
from gearcam.designs.table import Key

Values = Mapping[str, float]
"""Numbers by dotted key, in the units of the file."""

_WIDE: Final = 20.0
"""A range of more than so many times the value is too wide for a slider."""

_ROOM: Final[Mapping[str, float]] = {"deg": 10.0, "mm": 1.0}
"""How far a slider goes to both sides of 0, by unit; of what has none half of 1."""

_STEPS: Final = 1000.0
"""Steps of a slider at least, of numbers that are not whole."""

_FEWER: Final = (1.0, 0.5, 0.25, 0.1, 0.03)
"""Parts of a slider's way that are tried until one reads as a design."""

_GRAIN: Final = 1e-6
"""Part of a step by which the end of a slider may miss one: rounding errors are far smaller."""

_DIGITS: Final = 10
"""Digits of a number that is computed for a file: more are what arithmetic leaves."""


def numbers(text: str) -> dict[str, float]:
    """Return the numbers in the text of a good design file by dotted key, in its order."""
    document = document_in(text, "")
    return {
        dotted(path): value
        for path, value in _leaves(document)
        if isinstance(value, int | float) and not isinstance(value, bool)
    }


def sliders(text: str, reads: Callable[[str], bool]) -> list[dict[str, Any]]:
    """Return what sliders of a design file can change.

    Parameters
    ----------
    text : str
        TOML, a good design.
    reads : callable
        ``reads(text)`` returns whether another text reads as a design.

    Returns
    -------
    list of dict
        For each number that can change, alone or with its `equals`: ``key``, ``doc``, ``unit``,
        ``value``, ``low``, ``high``, ``step``, ``integer``.
    """
    document, found = document_in(text, ""), numbers(text)
    made = []
    for key, value in found.items():
        entry = _entry(document, path_of(key))
        if entry is None:
            continue
        low, high, step = span(entry, value)

        def fits(end: float, key: str = key) -> bool:
            alone = {key: end}
            return any(
                reads(replaced(text, alone | more)) for more in ({}, equals(found, key, end))
            )

        low, high = (_within(value, end, step, entry, fits) for end in (low, high))
        if low < high:
            made.append(
                {
                    "key": key,
                    "doc": entry.param.doc,
                    "unit": entry.param.quantity.unit,
                    "value": value,
                    "low": low,
                    "high": high,
                    "step": step,
                    "integer": entry.base is int,
                }
            )
    return made


def span(entry: Key, value: float) -> tuple[float, float, float]:
    """Return the ends and the step of a slider.

    Parameters
    ----------
    entry : Key
        What is allowed.
    value : float
        In the file.

    Returns
    -------
    low, high, step : float
        All that is allowed, or from half to twice the value where that is too wide.
    """
    made, whole = entry.param, entry.base is int
    low = max((one for one in (made.ge, made.gt) if one is not None), default=-math.inf)
    high = min((one for one in (made.le, made.lt) if one is not None), default=math.inf)
    room = _ROOM.get(made.quantity.unit, 0.5)
    if high - low > _WIDE * abs(value):
        ends = sorted((0.5 * value, 2.0 * value)) if value else (-room, room)
        near = (value - 2.0, value + 2.0) if whole else ends
        low, high = max(low, min(ends[0], near[0])), min(high, max(ends[1], near[1]))
    step = 1.0 if whole else 10.0 ** math.floor(math.log10((high - low) / _STEPS or 1.0))
    low = low + step if low == made.gt else low
    high = high - step if high == made.lt else high
    low = step * math.ceil(low / step - _GRAIN)
    high = step * math.floor(high / step + _GRAIN)
    return min(tidy(low), value), max(tidy(high), value), tidy(step)


def equals(found: Values, key: str, value: float) -> dict[str, float]:
    """Return the same value for what is equal to a number and stands in one list with it.

    A list that begins and ends alike, or two equal wheels: one may not change without the others.

    Parameters
    ----------
    found : mapping of str to float
        Numbers of the file.
    key : str
        One of them.
    value : float
        What it shall be.

    Returns
    -------
    dict of str to float
        Empty where there is none.
    """
    path = path_of(key)
    if not isinstance(path[-1], int):
        return {}
    return {
        other: value
        for other, there in found.items()
        if other != key and path_of(other)[:-1] == path[:-1] and there == found[key]
    }


def replaced(text: str, values: Values) -> str:
    """Return the text of a good design file with other numbers at some keys; all else stays.

    Parameters
    ----------
    text : str
        TOML.
    values : mapping of str to float
        By dotted keys of numbers that stand in it.

    Returns
    -------
    str

    Raises
    ------
    KeyError
        If a key does not stand in it.
    """
    spans = spans_of(text)
    places = [(*spans[path_of(key)], value) for key, value in values.items()]
    for start, end, value in sorted(places, reverse=True):
        text = text[:start] + _written(value, text[start:end]) + text[end:]
    return text


def _written(value: float, before: str) -> str:
    """Return a number as a file holds it: whole where the one `before` was and this one is."""
    plain = before.lstrip("+-").replace("_", "").isdigit()
    return str(int(value)) if plain and float(value).is_integer() else repr(float(value))


def _entry(document: Mapping[str, Any], path: Path) -> Key | None:
    """Return the key of a number; None where its table does not know it."""
    kind, (title, *rest) = KINDS[document["kind"]], path
    if title == kind.main:
        raw = document[kind.main]
        if rest and isinstance(rest[0], int):
            raw, rest = raw[rest[0]], rest[1:]
        known = kind.room("describe").known(raw)
    elif title in (*kind.tables, "limits"):
        known = kind.table(str(title))
    else:
        return None
    return known.entries.get(str(rest[0])) if rest else None


def _within(
    value: float, end: float, step: float, entry: Key, fits: Callable[[float], bool]
) -> float:
    """Return the end of a slider, or a nearer one that reads as a design; the value without one."""
    for part in _FEWER:
        way = part * (end - value)
        nearer = value + (round(way) if entry.base is int else step * round(way / step))
        if nearer != value and fits(tidy(nearer)):
            return tidy(nearer)
    return value


def _leaves(part: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    if isinstance(part, dict | list):
        for key, item in part.items() if isinstance(part, dict) else enumerate(part):
            yield from _leaves(item, (*path, key))
    else:
        yield path, part


def tidy(value: float) -> float:
    """Return a computed value with so few digits as people write."""
    return float(f"{value:.{_DIGITS}g}") + 0.0
