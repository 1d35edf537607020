"""The numbers of a design file: their sliders, and replacing them in its text."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any, Final

from gearcam.base.inches import spellings_in
from gearcam.designs.design import path_of
from gearcam.designs.examine import nested_in
from gearcam.designs.faults import dotted
from gearcam.designs.in_inches import entry_in
from gearcam.designs.kind import KINDS
from gearcam.designs.lines import Path, spans_of
from gearcam.designs.reader import document_in
from gearcam.designs.table import Key
from gearcam.parts.fits import in_class_of
from gearcam.view.names import label_of, title_of

Values = Mapping[str, float]
"""Numbers by dotted key, in the units of the file."""

_WIDE: Final = 20.0
"""Largest range of a slider relative to the value."""

_ROOM: Final[Mapping[str, float]] = {"deg": 10.0, "mm": 1.0, "in": 0.05}
"""Range of a slider to both sides of 0, by unit; half of that of a plain number is 0.5."""

_STEPS: Final = 1000.0
"""Smallest number of steps of a slider, except for whole numbers."""

_FEWER: Final = (1.0, 0.5, 0.25, 0.1, 0.03)
"""Shares of a slider's range that are tried until its end is a valid design."""

_NUDGE: Final = 0.01
"""Share of a slider's range by which a number is moved to see whether it can be."""

_NUDGES: Final = 6
"""Number of such moves to either side: tooth counts need not be made one by one."""

_GRAIN: Final = 1e-6
"""Rounding error of the end of a slider, at most, relative to its step."""

_DIGITS: Final = 10
"""Significant digits of a number that is computed for a file; more would be rounding noise."""


def numbers(text: str) -> dict[str, float]:
    """Return the numbers in the text of a valid design file by dotted key, in its order.

    Of a size with a tolerance class it is the size.
    """
    document = document_in(text, "")
    found = ((path, _number(document, path, value)) for path, value in leaves(document))
    return {
        dotted(path): value
        for path, value in found
        if isinstance(value, int | float) and not isinstance(value, bool)
    }


def _number(document: Mapping[str, Any], path: Path, value: Any) -> Any:
    """Return the size of a text that is one with a class, else the value."""
    entry = _entry(document, path) if isinstance(value, str) else None
    value = entry.number(value) if entry else value
    return float(value) if isinstance(value, float) else value


def sliders(
    text: str,
    reads: Callable[[str], bool],
    moves: Callable[[str, float], Collection[str] | None],
) -> list[dict[str, Any]]:
    """Return the sliders of a design file.

    Parameters
    ----------
    text : str
        TOML, a valid design.
    reads : callable
        ``reads(text)`` returns whether another text is a valid design.
    moves : callable
        ``moves(key, value)`` returns which numbers have to change with one if a design with its new
        value is to be made; None if none can be made.

    Returns
    -------
    list of dict
        For each number that can be changed, alone or with what has to follow it: ``key``,
        ``group``, ``label``, ``doc``, ``unit``, ``value``, ``low``, ``high``, ``step``,
        ``integer``; ``least`` and ``most``, all that its key allows, or null; ``same``, the keys of
        numbers that are always equal to it. These have no slider of their own: its label tells of
        them.
    """
    document, values = document_in(text, ""), numbers(text)
    sliders: list[dict[str, Any]] = []
    told: set[str] = set()
    for key, value in values.items():
        path = path_of(key)
        entry = _entry(document, path)
        if entry is None or key in told:
            continue
        low, high, step = span(entry, value)

        def fits(end: float, key: str = key) -> bool:
            alone = {key: end}
            return any(
                reads(replaced(text, alone | more)) for more in ({}, equals(values, key, end))
            )

        low, high = (_within(value, end, step, entry, fits) for end in (low, high))
        tries = _near(value, low, high, step) if low < high else ()
        more = next((one for to in tries if (one := moves(key, to)) is not None), None)
        if more is not None:
            same = [path_of(other) for other in equals(values, key, value) if other in more]
            told.update(map(dotted, same))
            table = path[: max(k for k, step in enumerate(path) if isinstance(step, str))]
            sliders.append(
                {
                    "key": key,
                    "group": title_of(document, table),
                    "label": label_of(document, path, entry, same),
                    "doc": entry.param.doc,
                    "unit": entry.param.quantity.unit,
                    "value": value,
                    "low": low,
                    "high": high,
                    "step": step,
                    **_bounds(entry, step),
                    "integer": entry.base is int,
                    "same": [dotted(one) for one in same],
                }
            )
    return sliders


def _bounds(entry: Key, step: float) -> dict[str, float | None]:
    """Return the least and the most that a key allows; None without such."""
    param = entry.param
    least = param.ge if param.gt is None else param.gt + step
    most = param.le if param.lt is None else param.lt - step
    return {"least": least, "most": most}


def span(entry: Key, value: float) -> tuple[float, float, float]:
    """Return the ends and the step of a slider.

    Parameters
    ----------
    entry : Key
        The key, with its allowed values.
    value : float
        Value in the file.

    Returns
    -------
    low, high, step : float
        The allowed range, or from half to twice the value if that is too wide.
    """
    param, whole = entry.param, entry.base is int
    low = max((one for one in (param.ge, param.gt) if one is not None), default=-math.inf)
    high = min((one for one in (param.le, param.lt) if one is not None), default=math.inf)
    room = _ROOM.get(param.quantity.unit, 0.5)
    if high - low > _WIDE * abs(value):
        ends = sorted((0.5 * value, 2.0 * value)) if value else (-room, room)
        near = (value - 2.0, value + 2.0) if whole else ends
        low, high = max(low, min(ends[0], near[0])), min(high, max(ends[1], near[1]))
    step = 1.0 if whole else 10.0 ** math.floor(math.log10((high - low) / _STEPS or 1.0))
    low = low + step if low == param.gt else low
    high = high - step if high == param.lt else high
    low = step * math.ceil(low / step - _GRAIN)
    high = step * math.floor(high / step + _GRAIN)
    return min(tidy(low), value), max(tidy(high), value), tidy(step)


def _near(value: float, low: float, high: float, step: float) -> Iterator[float]:
    """Yield some values of a slider near its `value`: whole numbers one after the other."""
    least = step * max(1.0, round(_NUDGE * (high - low) / step))
    for count in range(1, _NUDGES + 1):
        for way in (count * least, -count * least):
            if low <= value + way <= high:
                yield tidy(value + way)


def equals(values: Values, key: str, new: float) -> dict[str, float]:
    """Return the `new` value for the numbers that are equal to `key` in the same list.

    Such as the first and last ratio of a closed law, or the teeth of two equal wheels: one must not
    change without the other.

    Parameters
    ----------
    values : mapping of str to float
        Numbers of the file.
    key : str
        One of them.
    new : float
        New value of `key`.

    Returns
    -------
    dict of str to float
        By key; may be empty.
    """
    path = path_of(key)
    if not isinstance(path[-1], int):
        return {}
    return {
        other: new
        for other, there in values.items()
        if other != key and path_of(other)[:-1] == path[:-1] and there == values[key]
    }


def replaced(text: str, values: Values) -> str:
    """Return the text of a valid design file with some numbers replaced.

    Parameters
    ----------
    text : str
        TOML.
    values : mapping of str to float
        New values by dotted keys of numbers in the text.

    Returns
    -------
    str

    Raises
    ------
    KeyError
        If a key is not in the text.
    """
    spans = spans_of(text)
    places = [(*spans[path_of(key)], value) for key, value in values.items()]
    for start, end, value in sorted(places, reverse=True):
        text = text[:start] + _written(value, text[start:end]) + text[end:]
    return text


def _written(value: float, before: str) -> str:
    """Return a number as text, without decimals if it is whole and the one `before` had none.

    It keeps the class of a size that had one.
    """
    kept = in_class_of(before.strip("\"'"), value)
    if isinstance(kept, str):
        return f'"{kept}"'
    plain = before.lstrip("+-").replace("_", "").isdigit()
    return str(int(value)) if plain and float(value).is_integer() else repr(float(value))


def _entry(document: Mapping[str, Any], path: Path) -> Key | None:
    """Return the key of a number; None if its table has no such key."""
    for at, key, inner in nested_in(document):
        if path[: len(at)] == at and isinstance(inner, Mapping):
            return _entry({"kind": key.param.nested[0], **inner}, path[len(at) :])
    kind = KINDS[document["kind"]].meant(document)
    for at, table, _ in kind.tables_in(document):
        if path[: len(at)] == at and path[len(at) :]:
            key, known = str(path[len(at)]), table.entries
            own = next((one for one in known if key in spellings_in(one) and one != key), "")
            return entry_in(known[own], key) if own else known.get(key)
    return None


def _within(
    value: float, end: float, step: float, entry: Key, fits: Callable[[float], bool]
) -> float:
    """Return the end of a slider, or the nearest one tried that is valid; else the value."""
    for part in _FEWER:
        way = part * (end - value)
        nearer = value + (round(way) if entry.base is int else step * round(way / step))
        if nearer != value and fits(tidy(nearer)):
            return tidy(nearer)
    return value


def leaves(part: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    """Yield the path and the value of each single value in a `part` of a document at a `path`."""
    if isinstance(part, dict | list):
        for key, item in part.items() if isinstance(part, dict) else enumerate(part):
            yield from leaves(item, (*path, key))
    else:
        yield path, part


def tidy(value: float) -> float:
    """Return a computed value, rounded to `_DIGITS`."""
    return float(f"{value:.{_DIGITS}g}") + 0.0
