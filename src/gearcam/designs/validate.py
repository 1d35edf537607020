"""Validation of a single table of a design file: its values, and the parameters made of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import islice
from typing import Any

from gearcam.base.errors import MOST_LISTED
from gearcam.base.inches import both_ways
from gearcam.base.rules import Breach, Rule, Value
from gearcam.designs.faults import Fault, allowed, list_fault, short, show, value_fault
from gearcam.designs.lines import Path
from gearcam.designs.slips import (
    STRONG,
    hinted,
    key_hint,
    keyed,
    meant_by,
    misspelt,
    same_unit,
)
from gearcam.designs.table import Key, Table


def faults_of(
    table: Table,
    raw: Any,
    *,
    home: Callable[[str, Any], str],
    far: Callable[[str], str] = lambda _: "",
    at: Path = (),
    listed: Iterable[str] | None = None,
) -> Iterator[Fault]:
    """Yield all mistakes in a single table.

    Parameters
    ----------
    table : Table
        The table.
    raw : object
        Its content in the file.
    home : callable
        ``home(key, value)`` returns a hint that says where a misplaced key, or its value,
        belongs.
    far : callable
        The same for other kinds of design; asked last.
    at : tuple
        Path of the table; its title by default.
    listed : iterable of str, optional
        The keys named in messages about unknown keys; all by default.

    Yields
    ------
    Fault
        At most one for each path, in the order of keys.
    """
    at = at or (table.title,)
    names = list(table.entries if listed is None else listed)
    keys = ", ".join(names) or "no keys"
    entries = {name: table.entries[name] for name in names if name in table.entries}
    if not isinstance(raw, Mapping):
        rule, many = f"a table [{table.title}] with {keys}", isinstance(raw, list)
        hint = f"write it once, in single brackets: [{table.title}]" if many else home("", raw)
        yield Fault(at, f"{show(raw)} is not a table", raw, rule, hint)
        return
    missing = [name for name, key in table.entries.items() if key.required and name not in raw]
    meant = misspelt(raw, entries) if missing else ()
    for name, key in table.entries.items():
        if name in raw:
            yield from (
                _with_home(fault, table) for fault in _of_value(key, raw[name], (*at, name))
            )
        elif name in missing and name not in meant:
            yield Fault((*at, name), "is missing", allowed=allowed(key))
    unknown = (name for name in raw if name not in table.entries)

    def hint_of(name: str) -> str:
        near = both_ways(name, raw[name], entries) or key_hint(name, entries, STRONG)
        return near or home(name, raw[name]) or key_hint(name, entries) or far(name)

    for name, hint in hinted(unknown, hint_of):
        message = f"unknown key (its value is {show(raw[name])})"
        yield Fault((*at, name), message, raw[name], keys, hint)


def _with_home(fault: Fault, table: Table) -> Fault:
    """Return the fault of a value; if it is a word of another key of its table it says so."""
    if fault.hint or not (words := keyed(fault.value, table.words)):
        return fault
    return replace(fault, hint=f"did you mean {words}?")


def _of_value(key: Key, value: Any, path: Path) -> Iterator[Fault]:
    if key.param.nested and isinstance(value, Mapping | str):
        return  # it is no design: its faults have been found
    faults: list[Fault | None] = []
    alone = key.param.both or key.param.alone
    if key.length is None or (alone and not isinstance(value, list)):
        faults = [value_fault(path, value, key, item=key.length is not None)]
    else:
        items = enumerate(value if isinstance(value, list) else ())
        faults = [value_fault((*path, number), item, key, item=True) for number, item in items]
        faults.append(list_fault(path, value, key))
    yield from (fault for fault in faults if fault)


def _values(
    table: Table, raw: Any, faults: Iterable[Fault], at: Path, wheel: int = 0, title: str = ""
) -> dict[str, Value]:
    """Return the values of a table, in which there are `faults`, by the names of their fields."""
    wrong = {fault.path[len(at) :] for fault in faults if fault.path[: len(at)] == at}
    written = raw if isinstance(raw, Mapping) else {}
    if wrong:
        wrong |= {(key,) for key in misspelt(written, table.entries)}
    values: dict[str, Value] = {}
    for key, entry in table.entries.items():
        if entry.name in values and key not in written:
            continue  # of two keys of a field the one that is written
        content, default = written.get(key), entry.usual
        path: Path = (key,)
        contents: tuple[Any, ...] = ()
        if entry.param.both and isinstance(content, list):
            contents = tuple(content) if content[1:] != content[:-1] else ()
            content, path = content[wheel] if wheel < len(content) else None, (key, wheel)
        shown = partial(_line, title + key, content, default)
        values[title + entry.name] = Value(
            key=title + key,
            shown=shown,
            unit=entry.param.quantity.unit,
            content=entry.number(content),
            default=default,
            zero_is_none=entry.param.zero_is_none,
            wrong=bool(wrong) and not wrong.isdisjoint([(), (key,), path]),
            contents=contents,
        )
    return values


def _line(key: str, content: Any, default: Any) -> str:
    """Return a key and its value, or its default, as in a file; only messages need it."""
    return f"{key} = {show(short(default) if content is None else content)}"


def rule_faults(table: Table, raw: Any, faults: Iterable[Fault], at: Path) -> Iterator[Fault]:
    """Yield the faults of broken rules between the keys of a table.

    Parameters
    ----------
    table, raw, at
        As for `placed_faults`.
    faults : iterable of Fault
        Faults of single values in the table.
    """
    rules: Sequence[Rule] = getattr(table.owner, "rules", ())
    if not rules or not isinstance(raw, Mapping):
        return
    pairs = {entry.name for entry in table.entries.values() if entry.param.both}
    breaches = (
        (name, wheel if name in pairs and index is None else index, message, allowed)
        for wheel in range(1 + bool(pairs))
        for values in [_values(table, raw, faults, at, wheel)]
        for rule in rules
        for name, index, message, allowed in rule.breaches(values)
    )
    yield from placed_faults(breaches, table, raw, at)


def document_faults(
    tables: Mapping[str, Table],
    rules: Iterable[Rule],
    document: Mapping[str, Any],
    faults: Iterable[Fault],
) -> Iterator[Fault]:
    """Yield the faults of broken rules between the tables of a document.

    Parameters
    ----------
    tables : mapping of str to Table
        The tables by their titles.
    rules : iterable of Rule
        Rules between fields with dotted names: ``pair.module``.
    document : mapping
        As read from TOML.
    faults : iterable of Fault
        Faults found before.
    """
    values: dict[str, Value] = {}
    for title, table in tables.items():
        values |= _values(table, document.get(title), faults, (title,), title=f"{title}.")
    for rule in rules:
        for name, index, message, words in rule.breaches(values):
            title, _, field = name.partition(".")
            breach = field, index, message, words
            yield from placed_faults([breach], tables[title], document[title], (title,))


def placed_faults(
    breaches: Iterable[Breach], table: Table, raw: Mapping[str, Any], at: Path
) -> Iterator[Fault]:
    """Yield the faults for broken rules and for problems of parameters, with keys and values.

    Parameters
    ----------
    breaches : iterable of tuple
        See `gearcam.base.rules.Breach`.
    table : Table
        The table of the parameters.
    raw : mapping
        The table as in the file.
    at : tuple
        Path of the table.
    """
    keys = {entry.name: entry.key for entry in table.entries.values()}
    places: set[Path] = set()
    for name, index, message, rule in breaches:
        key = keys.get(name, "")
        value, path = raw.get(key), (*at, key) if key else at
        single = not isinstance(value, list) and key and table.entries[key].param.both
        if index is not None and not single:
            path = (*at, key, index)
            if isinstance(value, list) and index < len(value):
                value = value[index]
        if path not in places:  # report one value for both wheels once
            places.add(path)
            text = f"{show(value)}: {message}" if value is not None else message
            yield Fault(path, text, value, rule)


def _as_meant(table: Table, raw: Mapping[str, Any], at: Path) -> tuple[dict[str, Any], bool]:
    """Return a table with misspelt keys as they are meant, and whether the meaning is sure."""
    found, sure = dict(raw), True
    for key in islice((key for key in raw if key not in table.entries), MOST_LISTED):
        meant = [one for one in meant_by(key, table.entries) if one.key not in raw]
        sound = len(meant) == 1 and same_unit(key, meant[0])
        if sound and not any(_of_value(meant[0], raw[key], at)):
            found[meant[0].key] = raw[key]
        elif meant:
            sure = False
    return found, sure


def parameters_of(
    table: Table,
    make: Callable[..., Any],
    raw: Mapping[str, Any],
    faults: Sequence[Fault],
    at: Path,
) -> tuple[Any, list[Fault]]:
    """Create parameters if their values can be read; collect broken rules and what they find.

    These are reported in addition to faults of single values.

    Parameters
    ----------
    table : Table
        Their table.
    make : callable
        Creates them from internal values by name.
    raw : mapping
        The table as in the file; unknown keys are ignored.
    faults : sequence of Fault
        Faults of single values in the table.
    at : tuple
        Path of the table.

    Returns
    -------
    parameters : object
        The parameters; None if their values cannot be read.
    problems : list of Fault
        Mistakes that they find.
    """
    depth = len(at)
    broken = list(rule_faults(table, raw, faults, at))
    here = [fault.path[depth:] for fault in faults if len(fault.path) > depth]
    if any(len(path) == 1 and path[0] in table.entries for path in here):
        return None, broken
    here += [fault.path[depth:] for fault in broken if fault.path != at]
    wrong = {path[0] for path in here}
    readable, sure = _as_meant(table, raw, at) if faults else (raw, True)
    readable = {key: value for key, value in readable.items() if key in table.entries}
    try:
        parameters = make(**table.inward(readable))
        # what is computed without a misspelt key may be untrue
        problems = getattr(parameters, "problems", tuple)() if sure else ()
        found = [p for p in placed_faults(problems, table, raw, at) if p.path[depth] not in wrong]
    except (TypeError, ValueError, AttributeError, IndexError, KeyError):
        if not faults and not broken:
            raise
        return None, broken
    return parameters, [*broken, *found]
