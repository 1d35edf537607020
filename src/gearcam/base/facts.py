"""Facts: the quantities of a result as one tree with names.

The console, ``summary.json``, drawings and pages use this tree. A *group* is a mapping of names to
facts and groups; a *fact* has a value and, if people see it, a meaning, a limit and a place. Names
end with their unit, as keys of design files do: ``module_mm`` is in mm. A value is a number, a
text, a list, a range ``{"min": ..., "max": ...}`` or ``{"least": ..., "mean": ...}``.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any, Final

from gearcam.base.display import ShortRepr, line, renderer
from gearcam.base.errors import demand_finite
from gearcam.base.near_names import UnknownNameError
from gearcam.base.numerals import formatted
from gearcam.base.readable import (
    ERROR_DIGITS,
    UnitScale,
    against,
    column,
    ends,
    number,
    readable,
    scale_for,
)
from gearcam.base.two_names import spellings

Tree = dict[str, Any]
"""Facts by key: plain values, `Fact`, lists and groups of them."""

_UNITS: Final = {
    "_kg_m3": "kg/m3",
    "_mm_s3": "mm/s3",
    "_mm_s2": "mm/s2",
    "_mm_s": "mm/s",
    "_deg_s3": "deg/s3",
    "_deg_s2": "deg/s2",
    "_deg_s": "deg/s",
    "_rad_s3": "rad/s3",
    "_rad_s2": "rad/s2",
    "_rad_s": "rad/s",
    "_rpm": "rpm",
    "_nmm": "N mm",
    "_nm_rad": "N m/rad",
    "_nm": "N m",
    "_n_mm": "N/mm",
    "_n": "N",
    "_mpa": "MPa",
    "_kg_mm2": "kg mm2",
    "_g_mm": "g mm",
    "_mm3": "mm3",
    "_mm2": "mm2",
    "_mm": "mm",
    **{f"_in{end}": f"in{end.replace('_', '/')}" for end in ("_s3", "_s2", "_s", "2", "3", "")},
    "_deg": "deg",
    "_rad": "rad",
    "_kg": "kg",
}
"""Units by the ends of names, longer ends first."""

_PER: Final = re.compile(r"(?:_(mm|in|deg|rad))?_per_((?:rad|mm|in)\d?)$")
"""Ends of names of derivatives by an angle or a length: ``velocity_mm_per_rad``."""

_METHODS: Final = "accuracy.how."
"""Where the names of texts begin that say how errors are estimated."""

_ERRORS: Final = "accuracy."
"""Where the names of estimated errors begin."""

_LEAVES: Final = (("min", "max"), ("least", "mean"))
"""Keys of mappings that are single values."""

_MAIN: Final = 12
"""Number of quantities that are shown first."""

_MANY: Final = 5
"""Most digits of a number that needs not more to look unlike its limit."""

_ROUNDING: Final = 1e-9
"""Difference from a limit, as a share of it, that is rounding."""


@dataclass(frozen=True)
class Fact(ShortRepr):
    """A value with its meaning, limit and place.

    Parameters
    ----------
    value : object
        Number, text, list or range, in the unit of its name.
    meaning : str
        Label in the terms of the field; default: from the name.
    at_least, at_most : float, optional
        Limit of the value, in the same unit.
    place : str
        Wheel, tooth, or angle of the value.
    unit : str, optional
        Unit, if the name has none.
    shown : bool
        Whether it is one of the few facts that are always shown.
    noise : float
        Smaller values are rounding noise and shown as 0.
    text : str
        The value as people read it, without its unit; default: see `gearcam.base.readable`.
    error : float
        Stated error of the numbers, in the same unit: no digit shown is finer; 0 if none is stated.
    """

    value: Any
    meaning: str = ""
    at_least: float | None = None
    at_most: float | None = None
    place: str = ""
    unit: str | None = None
    shown: bool = False
    noise: float = 0.0
    text: str = ""
    error: float = 0.0


@dataclass(frozen=True)
class NamedFact:
    """A fact with its name and unit, for display.

    Parameters
    ----------
    name : str
        Dotted, as in ``summary.json``: ``pair.module_mm``.
    value : object
        Value in `unit`.
    unit, meaning : str
        Unit and label.
    limit : str
        The limit as text: ``at least 1.1 mm``, in the unit of the text.
    place : str
        Wheel, tooth, or angle of the value.
    noise : float
        Smaller values are rounding noise.
    shown : bool
        Whether it is always shown.
    text : str
        The value as people read it: ``0.4 to 1.6``, ``36 : 36``, ``4.923 mm``.
    error : float
        Stated error of the numbers; 0 if none is.
    worded : bool
        Whether the fact gives its text itself.
    """

    name: str
    value: Any
    unit: str
    meaning: str
    limit: str
    place: str
    noise: float
    shown: bool
    text: str = ""
    error: float = 0.0
    worded: bool = False


def told_alike(facts: Sequence[NamedFact]) -> list[str]:
    """Return the texts of one quantity of several results, in one unit and with equal decimals.

    Parameters
    ----------
    facts : sequence of NamedFact
        At least one. Those that are no numbers, that give their text, or that need many digits to
        look unlike a limit that they break, keep their texts.

    Returns
    -------
    list of str
    """
    own = [one.text for one in facts]
    numbers = [_settled(_numbers(one.value), one.noise) for one in facts]
    many = any(sum(map(str.isdigit, text.split()[0])) > _MANY for text in own if text)
    kinds = {type(one.value) for one in facts}, {one.unit for one in facts}
    if many or any(one.worded for one in facts) or any(len(kind) > 1 for kind in kinds):
        return own
    error = max(one.error for one in facts)
    to = scale_for([number for some in numbers for number in some], facts[0].unit)
    if isinstance(facts[0].value, float):
        texts = column([to.times(some[0]) for some in numbers], to.unit, error=error * to.factor)
        return [f"{text} {to.unit}".rstrip() for text in texts]
    if isinstance(facts[0].value, Mapping):
        return [_in_unit(one.value, to, one.noise, error) for one in facts]
    return own


def text_of(value: Any, unit: str = "", *, noise: float = 0.0, error: float = 0.0) -> str:
    """Return a `value` with its unit as people read it (see `gearcam.base.readable`).

    Parameters
    ----------
    value : object
        Number, text, list or range.
    unit : str
        Its unit; it is told in another one where that is easier to read.
    noise : float
        Smaller numbers are 0.
    error : float
        Stated error of the numbers.

    Returns
    -------
    str
    """
    to = scale_for(_settled(_numbers(value), noise), unit)
    return _in_unit(value, to, noise, error)


def _in_unit(value: Any, to: UnitScale, noise: float, error: float) -> str:
    """Return a value as text in a unit."""
    return f"{_texts(value, to, noise, error)} {to.unit}".rstrip()


def _texts(value: Any, to: UnitScale, noise: float, error: float) -> str:
    """Return numbers, lists and ranges as text without their unit."""
    if isinstance(value, Mapping):
        both = [to.times(one) for one in _settled(_numbers(value), noise)]
        low, high = ends(both, to.unit, error=error * to.factor)
        if low == high:
            return low
        return f"{low} to {high}" if "max" in value else f"{low}, mean {high}"
    if isinstance(value, list | tuple):
        return " : ".join(_texts(one, to, noise, error) for one in value)
    if isinstance(value, bool | str):
        return str(value)
    (single,) = _settled([value], noise)
    return number(to.times(single), to.unit, error=error * to.factor)


def _numbers(value: Any) -> list[Any]:
    """Return all numbers of a value."""
    if isinstance(value, Mapping):
        return [one for end in value.values() for one in _numbers(end)]
    if isinstance(value, list | tuple):
        return [one for item in value for one in _numbers(item)]
    return [] if value is None or isinstance(value, bool | str) else [value]


def _settled(values: Sequence[Any], noise: float) -> list[Any]:
    """Return numbers, smaller ones than `noise` as 0."""
    return [0.0 if noise and abs(one) < noise else one for one in values]


class Facts(Mapping[str, Any]):
    """A tree of facts; a mapping from dotted names to values and groups.

    Parameters
    ----------
    tree : mapping
        Groups, lists of groups, facts, and plain values, which are not shown by default. None is
        left out. A number that is not finite is refused (`NotFiniteError`).
    headline : sequence of str
        Names of the few quantities in the first line.
    title : str
        Name of the machine, at the start of that line.
    repeated : mapping of str to str
        Keys of the design that facts repeat, by these facts: either name finds them.

    Examples
    --------
    >>> import gearcam as gc
    >>> facts = gc.build(gc.load("profiles/ellipse.toml")).facts
    >>> round(facts["pair.center_distance_mm"], 4)
    41.9607
    >>> facts["pair.teeth"]
    [41, 41]
    """

    def __init__(
        self,
        tree: Mapping[str, Any],
        headline: Sequence[str] = (),
        title: str = "",
        repeated: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        for name, leaf in _leaves(tree):
            fact = leaf if isinstance(leaf, Fact) else Fact(leaf)
            demand_finite(f"the fact {name}", fact.value)
            demand_finite(f"the limit of {name}", [fact.at_least, fact.at_most])
        self._tree = tree
        self._headline = tuple(headline)
        self._title = title
        self._repeated = repeated

    def with_groups(self, groups: Mapping[str, Any]) -> Facts:
        """Return the facts with others, `groups` by name; those of one name are united."""
        tree = _united(self._tree, {name: group for name, group in groups.items() if group})
        return Facts(tree, self._headline, self._title, self._repeated)

    def repeating(self, keys: Mapping[str, str]) -> Facts:
        """Return the facts, found also by the `keys` that they repeat, given by the facts."""
        return Facts(self._tree, self._headline, self._title, keys)

    def changed(self, tree: Callable[[Tree], Tree], name: Callable[[str], str]) -> Facts:
        """Return the facts of a changed `tree`, in which names are what `name` makes of them."""
        keys = {name(fact): name(key) for fact, key in self._repeated.items()}
        return Facts(tree(dict(self._tree)), list(map(name, self._headline)), self._title, keys)

    def __repr__(self) -> str:
        return line(type(self).__name__, [*self.headline, f"{len(self)} facts"])

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def _repr_html_(self) -> str:
        return renderer().page("", self)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

    def lines(self, group: str = "") -> Iterator[str]:
        """Yield the headline, then an aligned table of the facts that are always shown.

        Parameters
        ----------
        group : str
            Only the facts of this group; by default all.
        """
        if self.headline:
            yield ", ".join(self.headline)
        rows = [
            (one.meaning, one.text, f"({one.limit})" if one.limit else "", one.place)
            for one in self.shown()
            if one.name.startswith(group)
        ]
        yield from ("  " + row for row in lined_up(rows))

    @cached_property
    def headline(self) -> tuple[str, ...]:
        """The main quantities as phrases: ``("module 2 mm", "teeth 20 : 20")``."""
        phrases = [f"{one.meaning} {one.text}" for one in map(self.quantity, self._headline)]
        return tuple([self._title, *phrases] if self._title else phrases)

    @cached_property
    def document(self) -> dict[str, Any]:
        """The tree with plain values, for JSON."""
        return _bare(self._tree)

    def __getitem__(self, name: str) -> Any:
        others = spellings(self._repeated, name) if isinstance(name, str) else ()
        for one in (name, *others):
            with suppress(LookupError, TypeError, ValueError, StopIteration):
                return _at(self.document, one)
        raise UnknownNameError(name, self._names)

    def __iter__(self) -> Iterator[str]:
        return iter(self._named)

    def __len__(self) -> int:
        return len(self._named)

    @cached_property
    def _named(self) -> dict[str, NamedFact]:
        return {name: _quantity(name, fact) for name, fact in _leaves(self._tree)}

    @cached_property
    def _names(self) -> list[str]:
        """All names, with those of the ends of ranges and of places in lists."""
        return list(dict.fromkeys([*self, *self.record()]))

    def quantities(self) -> Iterator[NamedFact]:
        """Yield all quantities in the order of the tree."""
        return iter(self._named.values())

    def shown(self) -> Iterator[NamedFact]:
        """Yield the quantities that are always shown."""
        return (one for one in self.quantities() if one.shown)

    def leading(self) -> Iterator[NamedFact]:
        """Yield the quantities of the headline, then the others that are always shown."""
        yield from map(self.quantity, self._headline)
        yield from (one for one in self.shown() if one.name not in self._headline)

    def main(self) -> Iterator[NamedFact]:
        """Yield a dozen of the quantities that are always shown: those with limits first chosen."""
        rows = [one for one in self.shown() if one.text and one.name not in self._headline]
        chosen = sorted(rows, key=lambda one: not one.limit)[:_MAIN]
        return (one for one in rows if one in chosen)

    def quantity(self, name: str) -> NamedFact:
        """Return the quantity with a dotted `name`, or that repeats a key of this name.

        Raises
        ------
        UnknownNameError
            If there is none; a KeyError with the nearest names.
        """
        for one in (name, *spellings(self._repeated, name)):
            if one in self._named:
                return self._named[one]
        raise UnknownNameError(name, self._names)

    def record(self) -> dict[str, float | str]:
        """Return all quantities as plain numbers and texts by dotted names (`Result.record`)."""
        return {
            name: value
            for one in self.quantities()
            if not one.name.startswith(_METHODS)
            for name, value in _plain(one.name, one.value)
        }


def _plain(name: str, value: Any) -> Iterator[tuple[str, float | str]]:
    """Yield a value by name: of a range both ends, of lengths each, of other lists a text."""
    if isinstance(value, Mapping):
        yield from ((f"{name}.{end}", float(item)) for end, item in value.items())
    elif isinstance(value, list) and value and all(isinstance(one, float) for one in value):
        yield from ((f"{name}.{place}", float(item)) for place, item in enumerate(value))
    elif isinstance(value, list):
        yield name, json.dumps(value)  # as in a design file, and as a key in the table of a sweep
    else:
        yield name, float(value) if isinstance(value, float) else value


def _joined(value: Any) -> str:
    """Return an item of a list as a text for tables, with all digits that a record keeps."""
    if isinstance(value, list | tuple):
        return " : ".join(map(_joined, value))
    return str(value) if isinstance(value, bool | str) else formatted(value)


def _leaves(tree: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if _is_group(tree):
        items: Any = tree.items()
    elif isinstance(tree, list) and tree and all(map(_is_group, tree)):
        items = enumerate(tree)
    else:
        yield path, tree
        return
    for name, item in items:
        if item is not None:
            yield from _leaves(item, f"{path}.{name}" if path else str(name))


def _united(tree: Mapping[str, Any], other: Mapping[str, Any]) -> dict[str, Any]:
    """Return two trees as one: groups that both have are united."""
    both = {
        name: _united(tree[name], group)
        for name, group in other.items()
        if isinstance(group, Mapping) and isinstance(tree.get(name), Mapping)
    }
    return {**tree, **other, **both}


def _at(tree: Any, name: str) -> Any:
    """Return the value of a dotted name; a key may contain dots, as names of files do."""
    if isinstance(tree, list):
        step, _, rest = name.partition(".")
        return _at(tree[int(step)], rest) if rest else tree[int(step)]
    if name in tree:
        return tree[name]
    key = next(key for key in tree if name.startswith(f"{key}."))
    return _at(tree[key], name[len(key) + 1 :])


def _is_group(value: Any) -> bool:
    return isinstance(value, Mapping) and tuple(value) not in _LEAVES


def _quantity(name: str, leaf: Any) -> NamedFact:
    fact = leaf if isinstance(leaf, Fact) else Fact(leaf)
    group, _, last = name.rpartition(".")
    end, unit = _unit_of(last)
    if not unit and isinstance(fact.value, float):  # such as groove_width_mm.outer
        unit = _unit_of(group.rpartition(".")[2])[1]
    unit = unit if fact.unit is None else fact.unit
    unit = "" if isinstance(fact.value, str) else unit  # words instead of a number
    meaning = fact.meaning or _label(last.removesuffix(end))
    value = _bare(fact)
    if name.startswith(_ERRORS) and isinstance(value, float):
        text, limit = readable(value, unit, digits=ERROR_DIGITS), ""
    else:
        text, limit = _told(fact, value, unit)
    more = {
        "noise": fact.noise,
        "shown": fact.shown,
        "error": fact.error,
        "place": fact.place,
        "worded": bool(fact.text),
    }
    return NamedFact(name, value, unit, meaning, limit, text=text, **more)


def _told(fact: Fact, value: Any, unit: str) -> tuple[str, str]:
    """Return the text of a fact and of its limit, with one unit."""
    bounds = (("at least", 1.0, fact.at_least), ("at most", -1.0, fact.at_most))
    words, sign, bound = next((one for one in bounds if one[2] is not None), ("", 0.0, None))
    noise, error = fact.noise, fact.error
    if fact.text or bound is None:
        text = f"{fact.text} {unit}".rstrip() if fact.text else ""
        limit = "" if bound is None else f"{words} {readable(bound, unit)}"
        return text or text_of(value, unit, noise=noise, error=error), limit
    told_of = _settled(_numbers(value), noise)
    worst = min(told_of, key=lambda one: sign * one)
    kept = sign * worst >= sign * bound or math.isclose(worst, bound, rel_tol=_ROUNDING)
    to = scale_for([*told_of, bound], unit)
    bound = to.times(bound)
    told = [
        against(to.times(one), bound, to.unit, error=error * to.factor, kept=kept)
        for one in told_of
    ]
    limit = f"{words} {max((limit for _, limit in told), key=len)}"
    if kept or len(told_of) == 1:
        return (told[0][0] if len(told_of) == 1 else _in_unit(value, to, noise, error)), limit
    return ", mean ".join(text for text, _ in told), limit


def _label(name: str) -> str:
    """Return a name without its unit in words: ``smallest tip thickness``."""
    words = name.split("_")
    for short, word in (("min", "smallest"), ("max", "largest")):
        if len(words) > 1 and short in (words[0], words[-1]):
            words.remove(short)
            words.insert(0, word)
    return " ".join(words)


def _unit_of(name: str) -> tuple[str, str]:
    """Return the end of a name that is its unit, and the unit; both empty without one."""
    rate = _PER.search(name)
    if rate:
        return rate[0], f"{rate[1] or 1}/{rate[2]}"
    end = next((end for end in _UNITS if name.endswith(end)), "")
    return end, _UNITS.get(end, "")


def _bare(value: Any) -> Any:
    if isinstance(value, Fact):
        return _bare(value.value)
    if isinstance(value, Mapping):
        return {name: _bare(item) for name, item in value.items() if item is not None}
    if isinstance(value, list | tuple):
        return [_bare(item) for item in value]
    return value


def lined_up(rows: Sequence[tuple[str, ...]]) -> Iterator[str]:
    """Yield the rows of a table with aligned columns; empty columns are left out."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True) if width)
        yield "  ".join(cells).rstrip()


def extent(low: float, high: float, factor: float = 1) -> dict[str, float]:
    """Return the range from `low` to `high` as a value of a fact, both times `factor`."""
    return {"min": factor * low, "max": factor * high}
