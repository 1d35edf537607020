"""Tables of a design file: their keys, with types and ranges.

They derive from parameter dataclasses (`gearcam.base.quantities`): an *entry* is one key, a *table*
the keys of one dataclass. Values are converted here between the units of files and mm and rad.
"""

from __future__ import annotations

import dataclasses
import math
import operator
import types
import typing
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

from gearcam.base.quantities import OPPOSITES, REQUIRED, TEXT, Param, Solve, params_of
from gearcam.parts.fits import FitSize, fitted


@dataclass(frozen=True)
class Key:
    """One key of a table.

    Parameters
    ----------
    name : str
        Name of the parameter in the program.
    key : str
        The key in a file, with the suffix of its unit.
    param : Param
        Quantity, bounds, choices, meaning.
    base : type
        Type of a single value: float, int, str or bool.
    length : int or None
        Length of a list; 0: any length; None: not a list.
    literal : str
        A word allowed instead of a number, such as ``solve``; empty for none.
    default : object
        In mm or rad; `REQUIRED` if the file must have the key, None if the program finds a value.
    """

    name: str
    key: str
    param: Param
    base: type
    length: int | None
    literal: str
    default: Any

    @property
    def required(self) -> bool:
        """Whether the file must have this key, without an alternative."""
        return self.default is REQUIRED and not self.param.when

    @cached_property
    def usual(self) -> Any:
        """The default in the unit of the file, that of one wheel; None without one."""
        if self.default is REQUIRED or self.default is None:
            return None
        return self.outward(self.default)[0] if self.param.both else self.outward(self.default)

    def takes(self, count: int) -> bool:
        """Return whether its list may have `count` values."""
        return count == self.length if self.length else count >= (self.param.min_length or 0)

    def number(self, value: Any) -> Any:
        """Return a single value of a file; if it is the text of a size with a class, as a size."""
        return fitted(value) if self.param.fit and isinstance(value, str) else value

    def inward(self, value: Any) -> Any:
        """Convert a valid value from the unit of the file into mm or rad; lists become tuples."""
        if self.param.both and not isinstance(value, list | tuple):
            value = (value, value)
        if self.param.alone and not isinstance(value, list | tuple):
            value = (value,)
        if isinstance(value, list | tuple):
            return tuple(self._inward(item) for item in value)
        return self._inward(value)

    def _inward(self, value: Any) -> Any:
        value = self.number(value)
        if self.base is not float or isinstance(value, str | FitSize):
            return value
        return float(value) * self.param.quantity.factor

    def outward(self, value: Any) -> Any:
        """Convert a value in mm or rad into the unit of the file; arrays become lists."""
        if self.param.nested:  # a design, which looks for attributes in other packages
            return value._document() if hasattr(value, "_document") else value
        value = value.tolist() if hasattr(value, "tolist") else value
        if self.param.both and not isinstance(value, list | tuple):
            value = (value, value)
        if self.param.alone and isinstance(value, list | tuple) and len(value) == 1:
            value = value[0]
        if isinstance(value, list | tuple):
            return [self._outward(item) for item in value]
        return self._outward(value)

    def _outward(self, value: Any) -> Any:
        value = value.item() if hasattr(value, "item") else value
        if isinstance(value, FitSize):
            return str(value)
        factor = self.param.quantity.factor
        if factor == 1.0 or isinstance(value, bool) or not isinstance(value, int | float):
            return value
        written = value / factor
        # removes the rounding error of degrees that were converted to radians
        return float(f"{written:.13g}") if math.isfinite(written) else written


@dataclass(frozen=True, eq=False)
class Table:
    """The keys of a table in a design file.

    Parameters
    ----------
    title : str
        Its name in the file.
    owner : type or None
        The dataclass of its values; None for limits, which belong to checks.
    entries : mapping of str to Key
        The keys with their properties.
    """

    title: str
    owner: type | None
    entries: Mapping[str, Key]

    @property
    def words(self) -> dict[str, Collection[str]]:
        """The words that single values may be, by dotted key."""
        return {
            f"{self.title}.{key}": entry.param.choices
            for key, entry in self.entries.items()
            if entry.param.choices and (entry.length is None or entry.param.both)
        }

    @cached_property
    def varies(self) -> bool:
        """Whether some keys depend on circumstances."""
        return any(entry.param.when for entry in self.entries.values())

    @cached_property
    def nested(self) -> Mapping[str, Key]:
        """The keys that hold designs."""
        return {name: entry for name, entry in self.entries.items() if entry.param.nested}

    def bound(self, circumstances: Collection[str]) -> Table:
        """Return the table with the keys for some `circumstances` (see `Param.when`)."""
        if not self.varies:
            return self
        kept = {}
        for key, entry in self.entries.items():
            if not any(OPPOSITES[word] in circumstances for word in entry.param.when):
                undecided = tuple(word for word in entry.param.when if word not in circumstances)
                kept[key] = replace(entry, param=replace(entry.param, when=undecided))
        return Table(self.title, self.owner, kept)

    def inward(self, raw: Mapping[str, Any]) -> dict[str, Any]:
        """Return values in mm and rad by parameter name, for the keys given."""
        return {
            entry.name: entry.inward(raw[key]) for key, entry in self.entries.items() if key in raw
        }

    def outward(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return values in the units of a file by key, without None."""
        return {
            entry.key: entry.outward(values[entry.name])
            for entry in self.entries.values()
            if values.get(entry.name) is not None
        }

    def document(self, parameters: Any) -> dict[str, Any]:
        """Return the content of the table for an instance of the owner."""
        return self.outward(
            {item.name: getattr(parameters, item.name) for item in dataclasses.fields(parameters)}
        )


@lru_cache(maxsize=512)
def table_of(title: str, owner: type) -> Table:
    """Return the table of a parameter dataclass.

    Parameters
    ----------
    title : str
        Its name in the file.
    owner : type
        The dataclass; its fields are created by `gearcam.base.quantities.param`.

    Returns
    -------
    Table
        With an entry for each field, in order, and two where the unit depends on circumstances.
    """
    hints = typing.get_type_hints(owner)
    defaults = {field.name: field.default for field in dataclasses.fields(owner)}
    keys = (
        entry
        for name, param in params_of(owner).items()
        for entry in _entries(name, param, hints[name], defaults[name])
    )
    return Table(title, owner, {entry.key: entry for entry in keys})


def _entries(name: str, param: Param, hint: Any, default: Any) -> Iterator[Key]:
    entry = _entry(name, param, hint, default)
    yield entry
    if param.other:
        first, *rest = param.when
        other = replace(param.other, when=(OPPOSITES[first], *rest))
        yield replace(entry, key=other.key(name), param=other, literal="")


def _entry(name: str, param: Param, hint: Any, default: Any) -> Key:
    hint, literal = _split(hint)
    length: int | None = None
    if typing.get_origin(hint) is tuple:
        items = typing.get_args(hint)
        length = 0 if items[-1] is Ellipsis else len(items)
        hint, literal = _split(items[0])
    if param.solvable:
        (literal,) = typing.get_args(Solve)
    return Key(name, param.key(name), param, hint, length, literal, default)


def _split(hint: Any) -> tuple[Any, str]:
    """Return the type of a union without None and words such as "solve", and the word."""
    if typing.get_origin(hint) not in (typing.Union, types.UnionType):
        return hint, ""
    rest = [part for part in typing.get_args(hint) if part is not types.NoneType]
    plain = [part for part in rest if typing.get_origin(part) is not typing.Literal]
    words = [typing.get_args(part)[0] for part in rest if part not in plain]
    return plain[0], "".join(words)


def settled(part: Any) -> Any:
    """Return input with tuples instead of lists and arrays, Python numbers, defaults for None.

    Parameters
    ----------
    part : object
        A value, or a dataclass with values at any depth.

    Returns
    -------
    object
        The same object if nothing changes.
    """
    if hasattr(part, "tolist"):
        part = part.tolist()
    if isinstance(part, list | tuple):
        items = tuple(map(settled, part))
        same = isinstance(part, tuple) and all(map(operator.is_, items, part))
        return part if same else items
    if not dataclasses.is_dataclass(part) or isinstance(part, type):
        return part
    items = {item.name: item for item in dataclasses.fields(part)}
    given = {name: getattr(part, name) for name in items}
    values = {name: _left_out(items[name], settled(value)) for name, value in given.items()}
    changed = {name: value for name, value in values.items() if value is not given[name]}
    return replace(part, **changed) if changed else part


def _left_out(item: dataclasses.Field[Any], value: Any) -> Any:
    """Return a value with its default in place of None, and that of one of two wheels too."""
    if value is None:
        return None if item.default is REQUIRED else item.default
    one = item.metadata.get("param")
    if not (one and one.both and isinstance(value, tuple) and len(value) == 2 and None in value):
        return value
    none = "" if one.quantity is TEXT else 0.0 if one.zero_is_none else None
    usual = item.default if isinstance(item.default, tuple) else (none, none)
    return tuple(map(lambda given, usual: usual if given is None else given, value, usual))
