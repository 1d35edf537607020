"""Inches: designs, messages and files in inches around a program that computes in mm.

A design file with ``units = "inch"`` has its lengths, and speeds of lengths, under keys that end
in ``_in`` where others end in ``_mm``: ``face_width_in``, ``speed_in_s``, ``feed_in_min``. The
module of a pair is its ``diametral_pitch``, 25.4 over the module in mm. A key that ends in ``_mm``
is allowed beside them, but not twice for one length. All else keeps its unit: forces are in N,
stiffnesses in N/mm, masses in kg. The table ``[sweep]`` names keys, whose values are in their
units.

This layer is around all others: `metric` makes of such a document one in mm when it is read, and
`customary` one in inches when it is written; `told` converts texts, refusals, adjustments, findings
and facts for their readers. Writers of files ask for the `FileUnit` of a build.

An inch is 25.4 mm exactly. A length that is read is rounded to 15 digits, so that 3 in is 76.2 mm,
and what was written in 13 digits is written again as it was.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from typing import Any, Final, TypeVar

from gearcam.base.adjustments import Adjustment
from gearcam.base.errors import InfeasibleError
from gearcam.base.facts import Fact, Facts
from gearcam.base.findings import Finding
from gearcam.base.numerals import FEW, formatted, shortened
from gearcam.base.quantities import size_pattern

UNITS: Final = ("mm", "inch")
"""What ``units`` may be."""

INCH: Final = 25.4

_MODULE, _PITCH = "module_mm", "diametral_pitch"

_READ: Final = 15
_WRITTEN: Final = 13
"""Significant digits of lengths in mm that are read, and in inches that are written."""

_MM: Final = re.compile(
    r"(?<!_n)(?<!_n_s)(?<!_kg)(?<!_g)(?<!_per)_mm(?P<power>[23]?)"
    r"(?=(?:_s\d?|_min|_per_(?:rad|deg|mm)\d?)?(?!\w))"
)
"""The unit at the end of a name that is a length, an area, a volume, or one of them per time."""

_PER: Final = re.compile(r"_per_mm(?P<power>\d?)(?!\w)")
"""The unit at the end of the name of what is per length."""

_IN: Final = re.compile(r"(?<!\bmodule)_in(?=(?:_s|_min|_per_(?:rad|deg|in)\d?)?(?!\w))")

_NUMBER: Final = r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
_SET: Final = re.compile(
    r"(?P<key>[\w.\[\]]*_mm\w*(?:\[\d+\])?)(?P<sign> = | (?:of |may be )?(?:up to )?)"
    rf"(?P<value>(?>{_NUMBER}(?: \+ {_NUMBER})?)(?! [mu]m)|\[[^\]]*\])"
)
"""A key and its value in a message."""

_UP: Final = ("from", "above", "least", "more than")
_SIDES: Final = "|".join((*_UP, "to", "below", "most", "less than"))
_WORD: Final = rf"(?:(?P<word>{_SIDES}) )?"
_MEASURE: Final = re.compile(
    rf"(?P<numbers>(?:(?:{_SIDES}) )?{_NUMBER}"
    r"(?:(?: to below | up to | and below (?:the \w+'s )?| to | and | or | x | by |, (?:[xyz] = )?)"
    rf"{_NUMBER})*)"
    r" (?P<unit>[mu]m[23]?(?:/(?:s|min|rad|deg)\d?)?)(?![\w/])"
)
"""Numbers with a unit of length behind them."""

_UNIT: Final = re.compile(r"(mm|um|1(?=/mm))([23]?)(?:/mm(\d?)|((?:/.*)?))")
_ENDS: Final = re.compile(rf"from ({_NUMBER}) to ({_NUMBER}) mm")

_T = TypeVar("_T")


def key_in(key: str) -> str:
    """Return a name as it is in inches: ``blank.rim_in`` for ``blank.rim_mm``."""
    key = re.sub(rf"\b{_MODULE}\b", _PITCH, key)
    return _PER.sub(r"_per_in\g<power>", _MM.sub(r"_in\g<power>", key))


def spellings_in(key: str) -> list[str]:
    """Return the keys for what is in mm that a file in inches may have, the usual one first."""
    return list(dict.fromkeys((key_in(key), key)))


def key_mm(key: str) -> str:
    """Return the key of a document in mm."""
    return _IN.sub("_mm", re.sub(rf"\b{_PITCH}\b", _MODULE, key))


def _inward(value: float) -> float:
    return float(f"{INCH * value:.{_READ}g}")


def _outward(value: float) -> float:
    short = float(f"{value / INCH:.{_WRITTEN}g}")
    return short if _inward(short) == value else value / INCH


def _inverse(value: float) -> float:
    """Return the module of a pitch; what is none stays as it is."""
    return float(f"{INCH / value:.{_READ}g}") if value > 0.0 else value


def _pitch(value: float) -> float:
    short = float(f"{INCH / value:.{_WRITTEN}g}") if value > 0.0 else value
    return short if _inverse(short) == value else INCH / value


def each(value: Any, change: Callable[[float], float]) -> Any:
    """Return a value with its numbers changed, also those in lists and in sizes with a fit.

    Parameters
    ----------
    value : object
        Of a design file; what is neither stays as it is.
    change : callable
        ``change(number)`` returns another number.
    """
    if isinstance(value, list | tuple):
        return [each(one, change) for one in value]
    if hasattr(value, "tolerance_class"):
        value = str(value)
    if isinstance(value, str) and (fit := re.fullmatch(size_pattern(), value.strip())):
        return repr(change(float(fit[1]))).removesuffix(".0") + fit[2]
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    try:
        return change(float(value))
    except OverflowError:  # the reader says that it is out of range
        return value


def metric(document: Mapping[str, Any]) -> tuple[dict[str, Any], list[tuple[Any, str]]]:
    """Return a document in inches as one in mm.

    Parameters
    ----------
    document : mapping
        With keys in inches, and in mm.

    Returns
    -------
    document : dict
        The same in mm, its keys in the same order.
    twice : list of (path, str)
        Keys of lengths that are given already, and the key that has them.
    """
    twice: list[tuple[Any, str]] = []

    def made(part: Any, at: tuple[Any, ...]) -> Any:
        if isinstance(part, list):
            return [made(one, (*at, number)) for number, one in enumerate(part)]
        if not isinstance(part, Mapping) or at == ("sweep",):
            return key_mm(part) if at[:1] == ("goal",) and isinstance(part, str) else part
        found: dict[str, Any] = {}
        spelt: dict[str, str] = {}
        for key, value in part.items():
            name = key_mm(key)
            if name in found:
                twice.append(((*at, key), spelt[name]))
                continue
            spelt[name] = key
            found[name] = made(value, (*at, key)) if name == key else value_mm(key, value)
        return found

    return made(document, ()), twice


def customary(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return a document in mm as one in inches."""

    def made(part: Any, at: tuple[Any, ...]) -> Any:
        if isinstance(part, list):
            return [made(one, at) for one in part]
        if not isinstance(part, Mapping):
            return key_in(part) if at[:1] == ("goal",) and isinstance(part, str) else part
        found: dict[str, Any] = {}
        for key, value in part.items():
            name = key_in(key)
            found[name] = made(value, (*at, key)) if name == key else value_in(key, value)
        return found

    return made(document, ())


def value_in(key: str, value: Any) -> Any:
    """Return the value of a key in mm as that of the key in inches."""
    return each(value, _pitch if _MODULE in key else _outward) if key_in(key) != key else value


def value_mm(key: str, value: Any) -> Any:
    """Return the value of a key in inches as that of the key in mm."""
    return each(value, _inverse if _PITCH in key else _inward) if key_mm(key) != key else value


def changes_in(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return values by dotted keys as in a file in inches; those of keys in inches are kept."""
    return {key_in(key): value_in(key, value) for key, value in changes.items()}


def changes_mm(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return values by dotted keys as in a file in mm."""
    return {key_mm(key): value_mm(key, value) for key, value in changes.items()}


def of_pitch(allowed: str) -> str:
    """Return the range of modules as that of pitches."""
    return _ENDS.sub(
        lambda ends: f"from {_few(INCH / float(ends[2]))} to {_few(INCH / float(ends[1]))} 1/in",
        allowed,
    )


_IN_INCHES: Final = ', or say units = "inch" at the top of the file'


def both_ways(key: str, value: Any, known: Collection[str]) -> str:
    """Return how to give what stands in inches in a file in mm; empty if it does not.

    Parameters
    ----------
    key : str
        An unknown key.
    value : object
        Its value.
    known : collection of str
        The keys that are known.
    """
    key = _PITCH if key.lower() == "dp" else key
    name = key_mm(key)
    if key == name or name not in known:
        return ""
    written = value_mm(key, value)
    words = f"write {name} = {_few(written)}" if isinstance(written, float) else "in mm"
    return f"did you mean {name}? ({words}{_IN_INCHES})"


def _few(value: float) -> str:
    return formatted(value, 10)


def told(thing: _T, units: str) -> _T:
    """Return texts, refusals, adjustments, findings or facts in the `units` of a design.

    Parameters
    ----------
    thing : str, InfeasibleError, Adjustment, Finding, Facts, or list or tuple of them
        As the program has it, in mm.
    units : {"mm", "inch"}
        Those of the design.

    Returns
    -------
    The same in these units.
    """
    if units != "inch":
        return thing
    way = next((way for kind, way in _WAYS.items() if isinstance(thing, kind)), None)
    return way(thing) if way else thing  # type: ignore[return-value]


@contextmanager
def telling(units: str) -> Iterator[None]:
    """Return a context whose refusals have the units of a design."""
    try:
        yield
    except InfeasibleError as error:
        raise told(error, units) from error


def text_in(text: str) -> str:
    """Return a text with its keys and lengths in inches; limits stay on their side."""
    text = text.replace(_IN_INCHES, "")
    text = re.sub(
        f'"{size_pattern()}"', lambda size: f'"{formatted(float(size[1]) / INCH)}{size[2]}"', text
    )
    text = _SET.sub(_set_in, text)
    text = _MEASURE.sub(_measured_in, text)
    return re.sub(r"\bin mm\b", "in inches", key_in(text))


def _set_in(found: re.Match[str]) -> str:
    key, value = found["key"], found["value"]
    if key_in(key) == key:
        return found[0]
    change = (lambda mm: INCH / mm) if _MODULE in key else (lambda mm: mm / INCH)
    told = re.sub(
        f'(?<!"){_NUMBER}',  # sizes with classes are in inches already
        lambda one: formatted(change(float(one[0])), min(max(_digits(one[0]) + 3, 6), 8)),
        value,
    )
    return key_in(key) + found["sign"] + told


def _measured_in(found: re.Match[str]) -> str:
    unit, factor = unit_in(found["unit"])

    def number(one: re.Match[str]) -> str:
        value, digits = factor * float(one[2]), max(_digits(one[2]) + 1, 4)
        side = 0 if not one[1] else 1 if one[1] in _UP else -1
        near = shortened(value, side, digits) if side and value else value
        # what is exact in few digits is not rounded
        near = value if math.isclose(float(f"{value:.{digits}g}"), value, rel_tol=1e-12) else near
        return f"{one[1]} " * bool(one[1]) + formatted(near, digits)

    return f"{re.sub(f'{_WORD}({_NUMBER})', number, found['numbers'])} {unit}"


def _digits(number: str) -> int:
    plain = re.sub(r"e.*|[-+]", "", number)
    return len((plain if "." in plain else plain.rstrip("0")).replace(".", "").lstrip("0"))


def unit_in(unit: str) -> tuple[str, float]:
    """Return a unit in inches and the factor to it; the same and 1 if it is no length."""
    found = _UNIT.fullmatch(unit)
    if found is None:
        return unit, 1.0
    power = 0 if found[1] == "1" else int(found[2] or 1)
    below = 0 if found[3] is None else int(found[3] or 1)
    factor = (1e-3 if found[1] == "um" else 1.0) ** power * INCH ** (below - power)
    above = f"in{found[2]}" if power else "1"
    return above + (f"/in{found[3]}" if below else found[4]), factor


def name_in(name: str) -> tuple[str, float]:
    """Return the name of a fact or a column in inches, and what its numbers are times."""
    above, below = (
        int(one["power"] or 1) if one else 0 for one in (_MM.search(name), _PER.search(name))
    )
    return key_in(name), INCH ** (below - above)


def _times(value: Any, factor: float) -> Any:
    """Return a value with its numbers times a factor; whole numbers that are none stay so."""
    return each(value, lambda one: one * factor) if factor != 1.0 else value


def _adjustment_in(one: Adjustment) -> Adjustment:
    steps = [changes_in(step) for step in one.steps]
    return replace(one, near=changes_in(one.near), far=changes_in(one.far), steps=steps)


def _refusal_in(error: InfeasibleError) -> InfeasibleError:
    (unit, factor), numbers = unit_in(error.unit), (error.value, error.limit)
    if error.where.endswith(_MODULE):
        unit, value, limit = "1/in", *(one and INCH / one for one in numbers)
    else:
        value, limit = (None if one is None else factor * one for one in numbers)
    return InfeasibleError(
        text_in(error.what),
        where=text_in(error.where),
        value=value,
        limit=limit,
        unit=unit,
        nearest=text_in(error.nearest),
        adjustments=[_adjustment_in(one) for one in error.adjustments],
        more_teeth=error.more_teeth,
    )


def _finding_in(one: Finding) -> Finding:
    unit, factor = unit_in(one.unit)
    value, limit = (None if x is None else factor * x for x in (one.value, one.limit))
    words = {"message": text_in(one.message), "where": text_in(one.where)}
    return replace(one, value=value, limit=limit, unit=unit, **words)


def _tree_in(tree: Any, factor: float = 1.0) -> Any:
    """Return facts in inches; those under a name in mm are times its factor."""
    if isinstance(tree, Fact):
        return _fact_in(tree, factor)
    if isinstance(tree, Mapping):
        return dict(_entry_in(key, item, factor) for key, item in tree.items())
    if isinstance(tree, list | tuple):
        return [_tree_in(one, factor) for one in tree]
    if isinstance(tree, str):  # it may be a unit, or a size with a tolerance class
        tree = unit_in(tree)[0] if _UNIT.fullmatch(tree) else text_in(tree)
    return _times(tree, factor)


def _entry_in(key: str, item: Any, factor: float) -> tuple[str, Any]:
    if key == _MODULE:
        one = item if isinstance(item, Fact) else Fact(item)
        words = {"meaning": "diametral pitch", "unit": ""}
        return _PITCH, replace(one, value=_pitch(one.value), **words)
    name, own = name_in(key)
    return name, _tree_in(item, factor if name == key else own)


def _fact_in(one: Fact, factor: float) -> Fact:
    unit, text = one.unit, one.text
    if unit is not None:
        unit, factor = unit_in(unit)
    if text and factor != 1.0:
        # the numbers of the value are not rounded as those of its text
        known = one.value if isinstance(one.value, list | tuple) else ()
        numbers = iter(known if len(known) == len(re.findall(_NUMBER, text)) else ())
        text = re.sub(
            _NUMBER, lambda this: formatted(factor * float(next(numbers, this[0])), FEW), text
        )
    return replace(
        one,
        value=_tree_in(one.value, factor),
        meaning=text_in(one.meaning),
        at_least=_times(one.at_least, factor),
        at_most=_times(one.at_most, factor),
        noise=one.noise * factor,
        error=one.error * factor,
        place=text_in(one.place),
        text=text,
        unit=unit,
    )


_WAYS: Final[Mapping[type, Callable[[Any], Any]]] = {
    str: text_in,
    Adjustment: _adjustment_in,
    InfeasibleError: _refusal_in,
    Finding: _finding_in,
    Facts: lambda facts: facts.changed(_tree_in, key_in),
    tuple: lambda things: tuple(told(one, "inch") for one in things),
    list: lambda things: [told(one, "inch") for one in things],
}


@dataclass(frozen=True)
class FileUnit:
    """The unit of lengths in files.

    Parameters
    ----------
    name : str
        As files say it.
    size : float, mm
        Its size.
    dxf : int
        Its ``$INSUNITS`` in DXF.
    decimals : int
        Decimals of sizes on drawings, at most: micrometres, or ten-thousandths of an inch.
    """

    name: str
    size: float
    dxf: int
    decimals: int

    @property
    def units(self) -> str:
        """Its name in a design."""
        return UNITS[self.size != 1.0]

    def column(self, name: str) -> tuple[str, float]:
        """Return the name of a column of lengths in the unit, and what its numbers are times."""
        return name_in(name) if self.size != 1.0 else (name, 1.0)

    def told(self, thing: _T) -> _T:
        """Return a text, or facts, with lengths in the unit (see `told`)."""
        return told(thing, self.units)


MILLIMETRES: Final = FileUnit("mm", 1.0, 4, 3)

_FILES: Final = {"mm": MILLIMETRES, "inch": FileUnit("in", INCH, 1, 4)}
_now: Final = ContextVar("unit of files", default=MILLIMETRES)


def file_unit() -> FileUnit:
    """Return the unit of files that are being written."""
    return _now.get()


@contextmanager
def files_in(units: str) -> Iterator[None]:
    """Return a context in which files are written in some `units`."""
    before = _now.set(_FILES[units])
    try:
        yield
    finally:
        _now.reset(before)
