"""Faults of a design file as text: the value, what is allowed, and what may be meant."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from gearcam.base.errors import Problem
from gearcam.base.numerals import formatted
from gearcam.base.quantities import Param
from gearcam.designs.lines import Path
from gearcam.designs.measures import measure_hint
from gearcam.designs.slips import did_you_mean, nearest
from gearcam.designs.table import Key
from gearcam.parts.fits import hole_problem

MISSING: Final = object()
"""Value of a fault about a missing key."""

_KINDS: Final = {float: "number", int: "whole number", str: "text", bool: "true or false"}
_SHOWN: Final = 60

TOO_DEEP: Final = "lists or tables are nested too deep"
DEEPEST: Final = 50
"""Largest depth of nested lists and tables; designs need five."""


@dataclass(frozen=True)
class Fault:
    """A mistake at a path of the document, without its file and line unless it is nested.

    Parameters
    ----------
    path : tuple
        Keys and indices.
    message, allowed, hint : str
        As in `gearcam.base.errors.Problem`.
    value : object
        The rejected value, or `MISSING`.
    file, line
        Of a mistake in the file of a nested design, to which the path belongs; else empty.
    """

    path: Path
    message: str
    value: Any = MISSING
    allowed: str = ""
    hint: str = ""
    file: str = ""
    line: int | None = None

    @property
    def of_unknown_key(self) -> bool:
        """Whether there is no key or table of this name."""
        return self.message.startswith("unknown ")

    def problem(self, file: str, line: int | None = None) -> Problem:
        """Return the problem for a `file`, at a `line` if known."""
        value = None if self.value is MISSING else self.value
        value = show(value) if functions_of(value) else value  # a problem must be picklable
        file, line = (self.file, self.line) if self.file else (file, line)
        return Problem(self.message, file, line, dotted(self.path), value, self.allowed, self.hint)


def functions_of(value: Any) -> tuple[Callable[..., Any], ...]:
    """Return the Python functions in a value: one function, or a list of functions only."""
    if callable(value):
        return (value,)
    many = value if isinstance(value, list | tuple) else ()
    return tuple(many) if all(map(callable, many)) else ()


def is_deep(document: Any) -> bool:
    """Return whether the lists and tables of a `document` are nested deeper than `DEEPEST`."""
    level = [document]
    for _ in range(DEEPEST):
        below = (
            part.values() if isinstance(part, Mapping) else part
            for part in level
            if isinstance(part, Mapping | list | tuple)
        )
        # each object once, so that a list that contains itself does not grow
        level = list({id(item): item for items in below for item in items}.values())
    return bool(level)


def dotted(path: Path) -> str:
    """Return a path as text: ``pair.teeth[1]``."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            bare = re.fullmatch(r"[A-Za-z0-9_-]+", part)
            text += ("." if text else "") + (part if bare else json.dumps(part, ensure_ascii=False))
    return text


def short(value: Any) -> Any:
    """Return a `value` with 20.0 as 20, and with six digits of numbers that have more."""
    if isinstance(value, list):
        return [short(item) for item in value]
    if isinstance(value, float):
        return int(value) if value.is_integer() else float(f"{value:.6g}")
    return value


def show(value: Any) -> str:
    """Return a value as in a design file, shortened."""
    if isinstance(value, bool):
        text = "true" if value else "false"
    elif isinstance(value, str):
        text = json.dumps(value, ensure_ascii=False)
    elif isinstance(value, list | tuple):
        text = "[" + ", ".join(show(item) for item in value[:12]) + "]"
    elif isinstance(value, Mapping):
        text = "a table"
    elif callable(value):
        text = "a Python function"
    elif isinstance(value, int) and abs(value) > 10**15:
        text = f"{value // 10**15}..." if abs(value) < 10**40 else "a very large number"
    else:
        text = str(value)
    return text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "..."


def unknown_word(word: str, what: str, known: Collection[str], key: str = "") -> Problem:
    """Return the problem that a `word` of a `key` is not `known`; `what` is the message."""
    allowed, hint = ", ".join(known), did_you_mean(word, known)
    return Problem(f"{show(word)} {what}", key=key, allowed=allowed, hint=hint)


def description(entry: Key) -> str:
    """Return the meaning and range of a key in one line."""
    return f"{entry.param.doc}; {allowed(entry)}" if entry.param.doc else allowed(entry)


def allowed(entry: Key, *, item: bool = False) -> str:
    """Return the values that an entry allows, as text.

    Parameters
    ----------
    entry : Key
        The key.
    item : bool
        Whether to describe one item of its list.
    """
    if entry.length is None or item:
        return _single(entry)
    param = entry.param
    if param.both:
        return f"{_single(entry)}, or two of them, {param.order or 'driver first'}"
    if param.alone:
        return f"{_single(entry)}, or a list of them"
    if entry.length:
        count = f"{entry.length} "
    elif param.min_length:
        count = "one or more " if param.min_length == 1 else f"at least {param.min_length} "
    else:
        count = ""
    return f"a list of {count}{_plural(entry)}"


def _single(entry: Key) -> str:
    if entry.param.nested:
        return f"the file of a design of kind {quoted(entry.param.nested)}, or a table of its own"
    if entry.param.choices:
        return quoted(entry.param.choices)
    if entry.base in (str, bool):
        return _KINDS[entry.base]
    words = ["0 or" * bool(entry.param.least), f"a {_KINDS[entry.base]}", bounds(entry)]
    text = " ".join(word for word in words if word)
    if entry.param.fit:
        return f'{text}, or with a class of ISO 286, such as "25 H7"'
    return f'{text}, or "{entry.literal}"' if entry.literal else text


def _plural(entry: Key) -> str:
    if entry.param.choices:
        return "any of " + ", ".join(f'"{word}"' for word in entry.param.choices)
    text = " ".join(word for word in (f"{_KINDS[entry.base]}s", bounds(entry)) if word)
    return f'{text}, or "{entry.literal}"' if entry.literal else text


def quoted(words: Iterable[str]) -> str:
    """Return ``"a" or "b"``, ``"a", "b" or "c"``."""
    *most, last = [f'"{word}"' for word in words]
    return f"{', '.join(most)} or {last}" if most else last


def bounds(entry: Key) -> str:
    """Return the range of a value with its unit, as text; empty without one."""
    param = entry.param
    unit = f" {param.quantity.unit}" if param.quantity.unit else ""
    least = param.least or param.ge
    low = f"from {formatted(least, 10)}" if least is not None else ""
    low = f"above {formatted(param.gt, 10)}" if param.gt is not None else low
    high = f"to {formatted(param.le, 10)}" if param.le is not None else ""
    high = f"below {formatted(param.lt, 10)}" if param.lt is not None else high
    if low and high:
        joint = " and " if param.gt is not None and param.lt is not None else " "
        return f"{low}{joint}{_upper(high, low)}{unit}"
    if not low and not high:
        return f"in{unit}" if unit else ""
    if param.ge is not None:
        low = f"of at least {formatted(param.ge, 10)}"
    if param.le is not None:
        high = f"of at most {formatted(param.le, 10)}"
    return f"{low}{high}{unit}"


def _upper(high: str, low: str) -> str:
    """Return the upper bound as it follows the lower one: "from 0 to below 1"."""
    if high.startswith("below") and low.startswith("from"):
        return f"to {high}"
    return f"up {high}" if low.startswith("above") and high.startswith("to") else high


def value_fault(path: Path, value: Any, entry: Key, *, item: bool = False) -> Fault | None:
    """Return the fault of a single value; None if its entry allows it.

    Parameters
    ----------
    path : tuple
        Path of the value.
    value : object
        The value.
    entry : Key
        Its key.
    item : bool
        Whether the value is an item of a list.
    """
    if entry.param.fit and isinstance(value, str):
        what, rule, near = hole_problem(value)
        if what:
            hint = near and f'did you mean "{near}"?'
            return Fault(path, f"{show(value)}: {what}", value, rule, hint)
    message = _objection(entry.number(value), entry)
    if not message:
        return None
    words = entry.param.choices or ((entry.literal,) if entry.literal else ())
    standing = is_of(value, float) and value == 0 and entry.param.at_zero
    hint = standing or did_you_mean(value, words) or _type_hint(value, entry)
    return Fault(path, f"{show(value)} {message}", value, allowed(entry, item=item), hint)


def list_fault(path: Path, value: Any, entry: Key) -> Fault | None:
    """Return the fault of a list, without its items; None if its entry allows it.

    Parameters
    ----------
    path, value, entry
        As for `value_fault`.
    """
    if not isinstance(value, list):
        hint = _list_hint(value, entry)
        return Fault(path, f"{show(value)} is not a list", value, allowed(entry), hint)
    if entry.takes(count := len(value)):
        return None
    message = f"{show(value)} has {count} value" + "s" * (count > 1)
    return Fault(path, message if count else "the list is empty", value, allowed(entry))


def _objection(value: Any, entry: Key) -> str:
    """Return what is wrong with a single value; empty if its entry allows it."""
    param = entry.param
    if (entry.literal and value == entry.literal) or (param.function and functions_of(value)):
        return ""
    if param.nested:
        kind = getattr(value, "kind", "")
        if isinstance(value, entry.base) and kind in param.nested:
            return ""
        return f"is of kind {show(kind)}" if kind else "is not a design"
    if isinstance(value, str) and (param.choices or entry.literal):
        return "" if value in (param.choices or ()) else "is not one of the allowed words"
    if not is_of(value, entry.base):
        kind = "one of the words allowed" if param.choices else _KINDS[entry.base]
        return f"is not {'a ' * (entry.base in (int, float))}{kind}"
    return _beyond(value, param) if entry.base in (int, float) else ""


def _beyond(value: Any, param: Param) -> str:
    """Return why a number is not within its bounds; empty if it is."""
    try:
        number = float(value)
    except OverflowError:
        return "is out of range"
    if not math.isfinite(number):
        return "is not a finite number"
    if 0.0 < number < param.least:
        return "is too small"
    within = (
        (param.gt is None or number > param.gt)
        and (param.ge is None or number >= param.ge)
        and (param.lt is None or number < param.lt)
        and (param.le is None or number <= param.le)
    )
    return "" if within else "is out of range"


def is_of(value: Any, base: type) -> bool:
    """Return whether a `value` is of a `base` type: 2 is a float here, True is not an int."""
    if isinstance(value, bool) or base is bool:
        return base is bool and isinstance(value, bool)
    return isinstance(value, (int, float) if base is float else base)


def _list_hint(value: Any, entry: Key) -> str:
    """Return how to write a list with one `value`, if its entry takes texts or a fixed number."""
    if not is_of(value, entry.base) or not (entry.length or entry.base is str):
        return ""
    if entry.base is str:
        words = [word.strip() for word in value.split(",")]
        items = [nearest(word, entry.param.choices or ()) or word for word in words]
    else:
        usual, count = entry.usual, entry.length or 1
        items = [value, *usual[1:]] if isinstance(usual, list | tuple) else [value] * count
    return f"write {entry.key} = {show(items)}"


def _type_hint(value: Any, entry: Key) -> str:
    if isinstance(value, str) and entry.base in (int, float):
        unit = entry.param.quantity.unit
        ok = lambda x: not _objection(short(x), entry)  # noqa: E731
        return measure_hint(value, unit, ok, entry.key, classes=entry.param.fit)
    return "write the text in quotes" if entry.base is str and not entry.param.choices else ""
