"""Models of the tables, strict and closed, made from the parameters only when a file asks.

A model says where a table is wrong and gives the JSON schema; the words come from `wording`. Models
are core schemas of pydantic, the form to which it brings every model class: the same validator
checks them, and the time to load the machinery of classes is saved.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

from gearcam.design.locate import Path
from gearcam.design.tables import Entry, Table
from gearcam.design.wording import Fault, allowed, key_hint, show, value_fault

if TYPE_CHECKING:
    from pydantic_core import SchemaValidator

_TYPES: Final = {float: "float", int: "int", str: "str", bool: "bool"}


def faults_of(
    table: Table, raw: Any, *, home: Callable[[str], str], at: Path = ()
) -> Iterator[Fault]:
    """Yield everything that is wrong in a table by itself.

    Parameters
    ----------
    table : Table
        What is allowed.
    raw : object
        What the file holds under the table's name.
    home : callable
        Gives the words that say where a key of another place belongs.
    at : tuple
        Where the table stands; under its title if left out.

    Yields
    ------
    Fault
        In the order of keys; one for each place.
    """
    from pydantic_core import ValidationError

    at = at or (table.title,)
    if not isinstance(raw, Mapping):
        rule = f"a table [{table.title}] with {', '.join(table.entries) or 'no keys'}"
        yield Fault(at, f"{show(raw)} is not a table", raw, rule)
        return
    raw = {key: _listed(table, key, value) for key, value in raw.items()}
    try:
        _validator(table).validate_python(raw)
    except ValidationError as error:
        seen: set[Path] = set()
        for detail in error.errors(include_url=False, include_context=False, include_input=False):
            place = _place(detail["loc"])
            if isinstance(raw.get(str(place[0])), _Single):
                place = place[:1]
            if place not in seen:
                seen.add(place)
                yield _fault(table, raw, place, home, at)
    for key, entry in table.entries.items():
        value = raw.get(key)
        plain = isinstance(value, list) and not isinstance(value, _Single)
        if plain and not _count_fits(entry, len(value)):
            yield value_fault((*at, key), value, entry, item=False)


class _Single(list[Any]):
    """One value that stands for both wheels, as a list for the model."""


def _listed(table: Table, key: str, value: Any) -> Any:
    entry = table.entries.get(key)
    single = entry is not None and entry.param.both and not isinstance(value, list)
    return _Single([value]) if single else value


def _count_fits(entry: Entry, count: int) -> bool:
    if entry.length is None:
        return True
    return count == entry.length if entry.length else count >= (entry.param.min_length or 0)


def _place(loc: tuple[str | int, ...]) -> Path:
    """Return key and item number; what pydantic adds for branches of a union is cut off."""
    return loc[:2] if len(loc) > 1 and isinstance(loc[1], int) else loc[:1]


def _fault(
    table: Table, raw: Mapping[str, Any], place: Path, home: Callable[[str], str], at: Path
) -> Fault:
    key = str(place[0])
    path = (*at, *place)
    entry = table.entries.get(key)
    if entry is None:
        known = ", ".join(table.entries) or "no keys"
        hint = key_hint(key, table.entries) or home(key)
        message = f"unknown key (its value is {show(raw[key])})"
        return Fault(path, message, raw[key], known, hint)
    if key not in raw:
        return Fault(path, "is missing", allowed=allowed(entry))
    item = len(place) > 1
    if isinstance(raw[key], _Single):
        return value_fault(path, raw[key][0], entry, item=True)
    return value_fault(path, raw[key][place[1]] if item else raw[key], entry, item=item)


@lru_cache(maxsize=64)
def _validator(table: Table) -> SchemaValidator:
    from pydantic_core import SchemaValidator

    return SchemaValidator(model_of(table))


def model_of(table: Table) -> Any:
    """Return the model of a table: a pydantic core schema, strict, without other keys.

    Parameters
    ----------
    table : Table
        With the entries that become fields.

    Returns
    -------
    dict
        For pydantic's validator and for its generator of JSON schemas.
    """
    fields = {
        key: {"type": "typed-dict-field", "schema": _value(entry), "required": entry.required}
        for key, entry in table.entries.items()
    }
    return {"type": "typed-dict", "fields": fields, "extra_behavior": "forbid"}


def description(entry: Entry) -> str:
    """Return an entry's meaning and range in one line."""
    return f"{entry.param.doc}; {allowed(entry)}" if entry.param.doc else allowed(entry)


def _value(entry: Entry) -> dict[str, Any]:
    made = entry.param
    single: dict[str, Any]
    if made.choices:
        single = {"type": "literal", "expected": list(made.choices)}
    else:
        single = {"type": _TYPES[entry.base], "strict": True}
        if entry.base in (int, float):
            bounds = {name: getattr(made, name) for name in ("gt", "ge", "lt", "le")}
            single |= {name: bound for name, bound in bounds.items() if bound is not None}
        if entry.base is float:
            single["allow_inf_nan"] = False
    if entry.solve:
        choices = [single, {"type": "literal", "expected": ["solve"]}]
        single = {"type": "union", "choices": choices}
    if entry.length is None:
        return single
    # the count is not the model's business: it would hide what is wrong with the items
    return {"type": "list", "strict": True, "items_schema": single}
