"""Pydantic models of the tables, strict and closed, made from the parameters only when a file asks.

A model says where a table is wrong and gives the JSON schema; the words come from `wording`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Any, Literal

from gearcam.design.locate import Path
from gearcam.design.tables import Entry, Table
from gearcam.design.wording import Fault, allowed, key_hint, show, value_fault

if TYPE_CHECKING:
    from pydantic import BaseModel


def faults_of(table: Table, raw: Any, *, home: Callable[[str], str]) -> Iterator[Fault]:
    """Yield everything that is wrong in a table by itself.

    Parameters
    ----------
    table : Table
        What is allowed.
    raw : object
        What the file holds under the table's name.
    home : callable
        Gives the words that say where a key of another place belongs.

    Yields
    ------
    Fault
        In the order of keys; one for each place.
    """
    from pydantic import ValidationError

    if not isinstance(raw, Mapping):
        rule = f"a table [{table.title}] with {', '.join(table.entries) or 'no keys'}"
        yield Fault((table.title,), f"{show(raw)} is not a table", raw, rule)
        return
    try:
        model_of(table).model_validate(dict(raw))
    except ValidationError as error:
        seen: set[Path] = set()
        for detail in error.errors(include_url=False, include_context=False, include_input=False):
            place = _place(detail["loc"])
            if place not in seen:
                seen.add(place)
                yield _fault(table, raw, place, home)
    for key, entry in table.entries.items():
        value = raw.get(key)
        if isinstance(value, list) and not _count_fits(entry, len(value)):
            yield value_fault((table.title, key), value, entry, item=False)


def _count_fits(entry: Entry, count: int) -> bool:
    if entry.length is None:
        return True
    return count == entry.length if entry.length else count >= (entry.param.min_length or 0)


def _place(loc: tuple[str | int, ...]) -> Path:
    """Return key and item number; what pydantic adds for branches of a union is cut off."""
    return loc[:2] if len(loc) > 1 and isinstance(loc[1], int) else loc[:1]


def _fault(table: Table, raw: Mapping[str, Any], place: Path, home: Callable[[str], str]) -> Fault:
    key = str(place[0])
    path = (table.title, *place)
    entry = table.entries.get(key)
    if entry is None:
        known = ", ".join(table.entries) or "no keys"
        hint = key_hint(key, table.entries) or home(key)
        message = f"unknown key (its value is {show(raw[key])})"
        return Fault(path, message, raw[key], known, hint)
    if key not in raw:
        return Fault(path, "is missing", allowed=allowed(entry))
    item = len(place) > 1
    return value_fault(path, raw[key][place[1]] if item else raw[key], entry, item=item)


@lru_cache(maxsize=64)
def model_of(table: Table) -> type[BaseModel]:
    """Return the pydantic model of a table."""
    from pydantic import ConfigDict, Field, create_model

    fields: dict[str, Any] = {}
    for key, entry in table.entries.items():
        default = ... if entry.required else entry.outward(entry.default)
        fields[key] = (_annotation(entry), Field(default, description=description(entry)))
    # title: the schema needs none, its tables are named by their keys
    config = ConfigDict(strict=True, extra="forbid", title=table.title)
    return create_model(f"{table.title.capitalize()}Table", __config__=config, **fields)


def description(entry: Entry) -> str:
    """Return an entry's meaning and range in one line."""
    return f"{entry.param.doc}; {allowed(entry)}" if entry.param.doc else allowed(entry)


def _annotation(entry: Entry) -> Any:
    from pydantic import Field

    made = entry.param
    single: Any
    if made.choices:
        single = Literal[made.choices]
    elif entry.base in (int, float):
        names = ("gt", "ge", "lt", "le")
        limits: dict[str, Any] = {
            name: getattr(made, name) for name in names if getattr(made, name) is not None
        }
        if entry.base is float:
            limits["allow_inf_nan"] = False
        single = Annotated[entry.base, Field(**limits)]
    else:
        single = entry.base
    if entry.solve:
        single = single | Literal["solve"]
    if entry.length is None:
        return single
    # the count is no constraint of the model: it would hide what is wrong with the items
    extra = {"minItems": entry.length or made.min_length, "maxItems": entry.length}
    shown: dict[str, Any] = {name: count for name, count in extra.items() if count}
    return Annotated[list[single], Field(json_schema_extra=shown)]
