"""Validation of designs: finds all mistakes that need no computation.

A *document* is the content of a design file as nested dictionaries. A design made in Python is
converted into one, so that both obey the same rules. Valid parts become parameter objects in mm and
rad.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path as FilePath
from typing import Any, Final

from gearcam.base.errors import DesignError
from gearcam.base.inches import UNITS, metric
from gearcam.base.quantities import REQUIRED
from gearcam.base.reading import UnreadableError, read
from gearcam.designs.faults import MISSING, TOO_DEEP, Fault, dotted, is_deep, quoted, show
from gearcam.designs.in_inches import as_in_file
from gearcam.designs.kind import (
    KINDS,
    OF_MANY,
    DesignKind,
    Examined,
    Variants,
    as_written,
    kind_meant,
    named_variant,
    nearest_kind,
    variant_of,
)
from gearcam.designs.lines import Path, line_at, lines_of
from gearcam.designs.nodes import Choice, Either, Many, Node, homes_of
from gearcam.designs.parts import Reading, of_nothing
from gearcam.designs.reader import LARGEST, decoded, document_in, find_tables
from gearcam.designs.slips import STRONG, SURE, did_you_mean, hinted, key_hint, keyed
from gearcam.designs.table import Key, Table
from gearcam.designs.validate import document_faults

_NAME = re.compile(r"\w[\w.-]*")
_NAME_RULE: Final = (
    "letters, digits, _, - and ., first a letter or digit (it names the output folder)"
)
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_LONGEST_NAME: Final = 100
_LONGEST_ENCODED: Final = 200
"""Largest length of a name in UTF-8, bytes; file systems allow 255."""

_AT_TOP: Final = "this key belongs at the top of the file, above all tables"

MOST_NESTED: Final = 4
"""Largest number of files of which each nests the next."""


@dataclass(frozen=True, kw_only=True)
class Place:
    """Where a document comes from.

    Parameters
    ----------
    file : str
        Name of its file, or of the file around it, for messages; empty without one.
    folder : str
        Folder to which the names of nested files are relative.
    outer : tuple of str
        Real paths of the file and of those that nest it.
    """

    file: str = ""
    folder: str = ""
    outer: tuple[str, ...] = ()


def examine(document: Mapping[str, Any], *, stem: str = "", place: Place | None = None) -> Examined:
    """Validate a document, and the designs that are nested in it.

    Parameters
    ----------
    document : mapping
        As read from TOML.
    stem : str
        Name of the file without its extension: the default name of the design.
    place : Place, optional
        Where the document comes from.

    Returns
    -------
    Examined
        Faults, and the fields of the design for valid parts.
    """
    outcome = Examined()
    if is_deep(document):
        outcome.faults.append(Fault((), TOO_DEEP))
        return outcome
    units = document.get("units", UNITS[0])
    if units not in UNITS:
        rule, hint = quoted(UNITS), "" if str(units)[:2] != "in" else 'write units = "inch"'
        outcome.faults.append(Fault(("units",), f"{show(units)} is not a unit", units, rule, hint))
    if units == UNITS[0]:
        outcome = _of_metric(document, stem, place)
    elif not outcome.faults:
        in_mm, twice = metric(document)
        outcome = _of_metric(in_mm, stem, place)
        outcome.faults = [
            *(Fault(at, f"is given beside {key}", allowed="one of them") for at, key in twice),
            *(as_in_file(one, document) for one in outcome.faults),
        ]
    outcome.parts["units"] = units
    return outcome


def _of_metric(document: Mapping[str, Any], stem: str, place: Place | None) -> Examined:
    """Return the outcome of a document in mm (see `examine`)."""
    outcome = Examined()
    unknown = list(_kind_faults(document))
    kind, meant = _as_meant(document)
    if kind is None:
        outcome.faults += unknown
        return outcome
    outcome = _examined(kind, meant, stem, place)
    if not outcome.kind:
        return outcome
    if kind.variants and outcome.faults:
        outcome = _likeliest(kind, kind.variants, meant, outcome, stem, place)
    elif outcome.faults and document.get("kind") != kind.name:
        outcome.faults = list(map(partial(_of_family, variant_of(kind)), outcome.faults))
    outcome.faults = unknown + outcome.faults
    return outcome


def _of_family(found: tuple[DesignKind, str] | None, fault: Fault) -> Fault:
    """Return a fault of a variant; about the key that names it, with all variants allowed."""
    variants = found[0].variants if found else None
    if variants is None or fault.path != (variants.title, variants.key):
        return fault
    return replace(fault, allowed=quoted(variants.values))


def _likeliest(
    kind: DesignKind,
    variants: Variants,
    document: Mapping[str, Any],
    outcome: Examined,
    stem: str,
    place: Place | None,
) -> Examined:
    """Return the outcome of a document without its variant: as the one with the fewest faults.

    Parameters
    ----------
    kind : DesignKind
        Its kind.
    variants : Variants
        Those of the kind.
    document : mapping
        As read from TOML.
    outcome : Examined
        Its outcome as the default.
    stem, place
        As for `examine`.

    Returns
    -------
    Examined
        That of the likeliest, with a fault that names it. The given one if the document names a
        variant, has no key of others, or would not have fewer faults as one of them.
    """
    table, at = document.get(variants.title), (variants.title, variants.key)
    if not isinstance(table, Mapping) or variants.named(document):
        return outcome
    known = kind.table_in(document, variants.title).entries
    foreign = not known.keys() >= table.keys() or any(one not in kind.titles for one in document)
    read: dict[str, Examined] = {}
    for value in variants.values if foreign else ():
        other = {**document, variants.title: {**table, variants.key: value}}
        read[value] = _examined(kind.meant(other), other, stem, place)
    counts = {value: len(one.faults) for value, one in read.items() if one.kind}
    least = min(counts.values(), default=len(outcome.faults))
    if least + 1 >= len(outcome.faults):
        return outcome
    near = [value for value, count in counts.items() if count == least]
    likeliest = read[near[0]]
    theirs = KINDS[likeliest.kind]
    more = [f"[{one}]" for one in theirs.titles if one in document and one not in kind.titles]
    more += [
        one for one in theirs.table(variants.title).entries if one in table and one not in known
    ]
    default = variants.called.format(variants.default)
    fault = Fault(at, f"is missing: {default} has no {', '.join(more)}")
    fault = next((one for one in outcome.faults if one.path == at), fault)
    hint = f"did you mean {' or '.join(near)}?"
    likeliest.faults.append(replace(fault, allowed=quoted(variants.values), hint=hint))
    return likeliest


def _examined(
    kind: DesignKind, document: Mapping[str, Any], stem: str, place: Place | None
) -> Examined:
    """Return the outcome of a document of a `kind`; its own ``kind`` is not looked at.

    Parameters
    ----------
    kind : DesignKind
        The kind as which it is read.
    document, stem, place
        As for `examine`.

    Returns
    -------
    Examined
        Without a kind if such designs are not supported.
    """
    outcome = Examined()
    later = kind.later(document)
    if later is not None:
        outcome.faults.append(later)
        return outcome
    outcome.kind = kind.name
    titles = kind.titles_with(document)
    outcome.faults += _top_faults(document, kind)
    _examine_name(document, stem, outcome)
    reading = _reading(kind, document, outcome, place or Place())
    outcome.parts["limits"] = {}
    # the table of limits loads the checks
    for title in (*titles, *(("limits",) if "limits" in document else ())):
        _examine_title(document, kind, title, reading, outcome)
    if kind.rules:
        tables = {title: kind.table_in(document, title) for title in kind.tables}
        outcome.faults += list(document_faults(tables, kind.rules, document, outcome.faults))
    outcome.faults += kind.problems(document, outcome)
    return outcome


def examine_file(document: dict[str, Any], file: str, outer: tuple[str, ...] = ()) -> Examined:
    """Validate the document of a file; the files that it names are relative to its folder.

    Parameters
    ----------
    document : dict
        As read; names of CSV files in it are changed in place.
    file : str
        Name of the file; its stem is the default name of the design. Empty without one.
    outer : tuple of str
        Real paths of the files that nest it.

    Returns
    -------
    Examined
    """
    folder = FilePath(file).parent
    find_tables(document, folder)
    here = (os.path.realpath(file),) if file else ()
    place = Place(file=file, folder=os.fspath(folder), outer=(*outer, *here))
    return examine(document, stem=FilePath(file).stem, place=place)


def _as_meant(document: Mapping[str, Any]) -> tuple[DesignKind | None, Mapping[str, Any]]:
    """Return the likeliest kind of a document, or None, and the document as one of this kind.

    Where its kind is a name of a variant, as ``barrel-cam`` is, it is one of this variant.
    """
    name = document.get("kind")
    found = named_variant(name) if isinstance(name, str) else None
    if found is None:
        return _meant_kind(document), document
    kind, value = found
    variants = kind.variants
    if variants is None:
        return kind, document
    given = document.get(variants.title)
    named = {variants.title: {variants.key: value, **(given if isinstance(given, Mapping) else {})}}
    return kind.meant(named), {**document, **named} if isinstance(given, Mapping) else document


def _meant_kind(document: Mapping[str, Any]) -> DesignKind | None:
    """Return the kind of a document; if it is missing or misspelt the likeliest one, or None."""
    name = document.get("kind")
    if isinstance(name, str) and (near := nearest_kind(name)):
        return KINDS[near].meant(document)
    likely = {
        name: sum(title in document for title in kind.tables)
        for name, kind in KINDS.items()
        if not variant_of(kind)
    }
    most = max(likely.values())
    best = [name for name, count in likely.items() if count == most > 0]
    return KINDS[best[0]].meant(document) if len(best) == 1 else None


def home_of(kind: DesignKind, key: str, value: Any) -> str:
    """Return a hint that says where a misplaced key belongs in this kind; else an empty text.

    Parameters
    ----------
    kind : DesignKind
        The kind.
    key : str
        The key; empty for a value without one.
    value : object
        Its value. What this says comes first: a word such as "swinging", or true for a key that is
        such a word.
    """
    if key == "units":
        return _AT_TOP
    if words := keyed(key if value is True else value, kind.words):
        return f"did you mean {words}?"
    if key in ("kind", "name"):
        return _AT_TOP
    # the first of several tables is the likeliest; those whose keys a word chooses load all laws
    homes = (homes_of(kind.node(title), title) for title in (*kind.tables, *kind.nodes))
    return next((found[key] for found in homes if key in found), "")


def _owners(what: str, kind: DesignKind, has: Callable[[DesignKind], bool]) -> str:
    """Return a hint that says where else than in a kind of design a key or table belongs.

    Parameters
    ----------
    what : str
        ``key`` or ``table``.
    kind : DesignKind
        The kind of the design.
    has : callable
        Whether another kind has it.
    """
    found, owners = (
        variant_of(kind),
        [one for one in KINDS.values() if one is not kind and has(one)],
    )
    family = found[0] if found else kind
    variants = family.variants
    if variants:
        names = {one.name for one in owners}
        values = [*variants.entries] if family in owners else []
        values += [value for value, name in variants.elsewhere.items() if name in names]
        if values:
            place = f"{variants.title}.{variants.key}"
            known = f"{place} = {quoted(values)}" if what == "table" else f"another {place}"
            return f"this {what} belongs to {known}"
    apart = [one for one in owners if (of := variant_of(one)) is None or of[0] not in owners]
    return f"this {what} belongs to {' or '.join(map(as_written, apart))}" if apart else ""


def _other_home(kind: DesignKind, key: str) -> str:
    def has(other: DesignKind) -> bool:
        return any(key in other.table(title).entries for title in other.tables)

    return _owners("key", kind, has)


def _near_home(kind: DesignKind, key: str, least: float) -> str:
    for title in kind.tables:
        hint = key_hint(key, kind.table(title).entries, least)
        if hint:
            return f"{hint} (under [{title}])"
    return ""


def _kind_faults(document: Mapping[str, Any]) -> Iterator[Fault]:
    kind = document.get("kind")
    if isinstance(kind, str) and kind in KINDS:
        return
    rule = quoted(name for name, one in KINDS.items() if not variant_of(one))
    if "kind" not in document:
        yield Fault(("kind",), "is missing", allowed=rule)
    else:
        hint = _meant_words(kind) if isinstance(kind, str) else ""
        yield Fault(("kind",), f"{show(kind)} is not a kind of design", kind, rule, hint)


def _meant_words(word: str) -> str:
    """Return the hint that says how the kind that a `word` may mean is written."""
    kind, values = kind_meant(word) or (None, "")
    if kind is None:
        return ""
    return f"did you mean {as_written(kind)}{values and f' with {values}'}?"


def _top_faults(document: Mapping[str, Any], kind: DesignKind) -> Iterator[Fault]:
    titles, rule = kind.titles, ", ".join(kind.titles)
    unknown = (key for key in document if key not in titles)

    def hint_of(key: str) -> str:
        hint = did_you_mean(key, ("kind", "name", "units")) or home_of(kind, key, document[key])
        hint = hint or _owners("table", kind, lambda other: key in other.titles)
        return hint or key_hint(key, titles) or _near_home(kind, key, STRONG)

    for key, hint in hinted(unknown, hint_of):
        value = document[key]
        items = value if isinstance(value, list) and value else [value]
        tables = all(isinstance(item, Mapping) for item in items)
        what = "table" if tables else f"key (its value is {show(value)})"
        yield Fault((key,), f"unknown {what}", value, rule, hint)
    for title in OF_MANY:
        if not isinstance(value := document.get(title, {}), Mapping):
            yield Fault((title,), f"{show(value)} is not a table", value, f"[{title}]")


def _examine_name(document: Mapping[str, Any], stem: str, outcome: Examined) -> None:
    name = document.get("name", stem)
    fault = name_fault(name)
    if not fault:
        outcome.parts["name"] = name
    elif "name" in document:
        hint = _free_name(name) if isinstance(name, str) else ""
        outcome.faults.append(Fault(("name",), f"{show(name)} {fault}", name, _NAME_RULE, hint))
    else:
        message = (
            "is missing" if not stem else f"is missing, and the file name {show(stem)} {fault}"
        )
        hint = _free_name(stem)
        hint = f"add {hint}" if hint else ""
        outcome.faults.append(Fault(("name",), message, allowed=_NAME_RULE, hint=hint))


def _free_name(name: str) -> str:
    """Return a line with a similar valid name, or an empty text."""
    free = re.sub(r"[^\w-]+", "_", name).strip("_-")
    return "" if name_fault(free) else f'name = "{free}"'


def name_fault(name: Any) -> str:
    """Return why a name cannot be the name of a folder; empty if it can."""
    if not isinstance(name, str):
        return "is not text"
    if len(name) > _LONGEST_NAME:
        return f"has {len(name)} characters, more than {_LONGEST_NAME}"
    if len(name.encode("utf-8", "replace")) > _LONGEST_ENCODED:
        return f"has more than {_LONGEST_ENCODED} bytes in UTF-8, too many for a folder"
    if not _NAME.fullmatch(name) or name.endswith("."):
        return "cannot be a folder's name"
    return "is reserved on some systems" if _RESERVED.fullmatch(name) else ""


def _reading(
    kind: DesignKind, document: Mapping[str, Any], outcome: Examined, place: Place
) -> Reading:
    def home(key: str, value: Any) -> str:
        return home_of(kind, key, value) or _near_home(kind, key, SURE)

    def filled(table: Table, raw: Any, at: Path) -> tuple[Any, list[Fault]]:
        content, foreign = _without_foreign(kind, document, table, raw)
        content, below = _with_designs(table, content, at, place)
        return content, [*foreign, *below]

    return Reading(
        document=document,
        given=kind.circumstances(document),
        words=lambda: kind.words,
        home=home,
        far=partial(_other_home, kind),
        filled=filled,
        faults=outcome.faults,
    )


def _examine_title(
    document: Mapping[str, Any], kind: DesignKind, title: str, reading: Reading, outcome: Examined
) -> None:
    """Examine what is written under a title of a document."""
    missing = title not in document
    if missing and title in kind.several and title not in kind.required:
        outcome.parts[title] = ()  # their class need not be imported
        return
    if missing and title not in (*kind.required, *kind.nodes):
        given = tuple(reading.given.items())
        if (part := of_nothing(kind.table_in(document, title), given)) is not None:
            outcome.parts[title] = part
            return
    node = kind.node(title, document)
    if missing and title in kind.required:
        outcome.faults.append(_missing(node, title))
        return
    empty: Any = [] if isinstance(node, Many) else {}
    made = reading.read(node, document.get(title, empty), (title,))
    if made.clean:
        outcome.parts[title] = made.part


def _missing(node: Node, title: str) -> Fault:
    """Return the fault of a part that a document must have."""
    if isinstance(node, Either):
        return Fault((title,), "is missing", allowed=node.rule())
    item = node.item if isinstance(node, Many) else node
    if isinstance(item, Choice):
        own = item.own.entries if item.own else ()
        rule = ", ".join((f"{item.tag} = {quoted(item.entries)}", *own))
    else:
        rule = ", ".join(item.table.entries)
    brackets = f"[[{title}]]" if isinstance(node, Many) else f"[{title}]"
    return Fault((title,), f"the table {brackets} is missing", allowed=rule)


def _without_foreign(
    kind: DesignKind, document: Mapping[str, Any], table: Table, raw: Any
) -> tuple[Any, list[Fault]]:
    """Return a table without keys that other variants have, and the faults of those keys.

    Where such a key has its default value it changes nothing: it is no fault. The class of the
    table may say in ``without`` why it does not have them.
    """
    title, faults = table.title, list[Fault]()
    unknown = [key for key in raw if key not in table.entries] if isinstance(raw, Mapping) else []
    family, value = (variant_of(kind) if unknown else None) or (kind, "")
    variants = family.variants
    if not unknown or variants is None or title not in variants.titles:
        return raw, faults
    kept, called = dict(raw), variants.called.format(value or variants.meant(document))
    for key in unknown:
        owners = variants.owners(title, key)
        if owners:
            entry, given = next(iter(owners.values())), kept.pop(key)
            if entry.default in (None, REQUIRED) or given != entry.outward(entry.default):
                why = getattr(table.owner, "without", "")
                message = f"{show(given)}: does not apply to {called}{why and f': {why}'}"
                rule = f"with {variants.title}.{variants.key} = {quoted(owners)}"
                rule = f"{', '.join(table.entries)}; this one {rule}" if why else rule
                faults.append(Fault((title, key), message, given, rule))
    return kept, faults


def _with_designs(table: Table, raw: Any, at: Path, place: Place) -> tuple[Any, list[Fault]]:
    """Return a table with its nested designs in place of documents and files, and their faults."""
    filled, faults = raw, list[Fault]()
    for name, key in table.nested.items():
        value = raw.get(name) if isinstance(raw, Mapping) else None
        if isinstance(value, str):
            design, more = _from_file(key, value, (*at, name), place)
        elif isinstance(value, Mapping):
            design, more = _in_place(key, value, (*at, name), place)
        else:
            continue
        faults += more
        if not more:
            filled = {**filled, name: design}
    return filled, faults


def _in_place(
    key: Key, value: Mapping[str, Any], at: Path, place: Place
) -> tuple[Any, list[Fault]]:
    """Return the design that is written in a table at a path, and its faults."""
    kinds, name = key.param.nested, value.get("kind", MISSING)
    if name is MISSING and len({_spoken(one) for one in kinds}) == 1:
        name = _spoken(kinds[0])
    if name not in kinds:
        message = "is missing" if name is MISSING else f"{show(name)} does not belong here"
        return None, [Fault((*at, "kind"), message, name, quoted(kinds), did_you_mean(name, kinds))]
    if (unfit := _unfit(key, KINDS[name], value)) is not None:
        path, word, allowed = unfit
        return None, [Fault((*at, *path), f"{show(word)} does not belong here", word, allowed)]
    outcome = examine({"kind": name, **value}, stem=str(at[-1]), place=place)
    if outcome.faults:
        return None, [_outward(fault, at, KINDS[name].titles) for fault in outcome.faults]
    return KINDS[outcome.kind].made(outcome.parts, place.file), []


def _spoken(kind: str) -> str:
    """Return the kind that stands in files for a `kind`: that of which it is a variant, or it."""
    found = variant_of(KINDS[kind])
    return found[0].name if found else kind


def _unfit(key: Key, kind: DesignKind, document: Mapping[str, Any]) -> tuple[Path, str, str] | None:
    """Return the path of a variant whose designs do not belong here, its word, and those that do.

    None if there is no such variant.
    """
    variants = kind.variants
    if variants is None or kind.meant(document).name in key.param.nested:
        return None
    path = variants.title, variants.key
    return path, document[variants.title][variants.key], quoted(tuple(variants.entries))


def _outward(fault: Fault, at: Path, titles: tuple[str, ...]) -> Fault:
    """Return a fault of a design that is written at a path as one of the design around it."""
    if fault.file:
        return fault
    brackets = re.compile(rf"\[({'|'.join(titles)})\]")
    words = {
        name: brackets.sub(rf"[{dotted(at)}.\1]", getattr(fault, name))
        for name in ("message", "allowed", "hint")
    }
    return replace(fault, path=(*at, *fault.path), **words)


def _from_file(key: Key, value: str, at: Path, place: Place) -> tuple[Any, list[Fault]]:
    """Return the design in a file that is named at a path, and its faults."""
    file = os.fspath(FilePath(place.folder) / value)
    rule = f"a file of kind {quoted(key.param.nested)}"

    def refused(message: str) -> tuple[None, list[Fault]]:
        return None, [Fault(at, f"{show(value)}: {message}", value, rule)]

    try:
        content = read(file if value else "", LARGEST)
    except UnreadableError as error:
        return refused(str(error))
    real = os.path.realpath(file)
    if real in place.outer:
        return refused("this file would contain itself")
    if len(place.outer) > MOST_NESTED:
        return refused(f"more than {MOST_NESTED} files are nested in each other")
    try:
        text = decoded(content, file)
        document = document_in(text, file)
    except DesignError as error:
        return None, [
            Fault((), p.message, MISSING, p.allowed, p.hint, file, p.line) for p in error.problems
        ]
    name = document.get("kind")
    if isinstance(name, str) and name in KINDS and name not in key.param.nested:
        return refused(f"its design is of kind {show(name)}")
    kind = KINDS.get(name) if isinstance(name, str) else None
    if kind is not None and (unfit := _unfit(key, kind, document)) is not None:
        path, word, allowed = unfit
        rule = f"{rule} with {dotted(path)} = {allowed}"
        return refused(f"its {dotted(path)} is {show(word)}")
    outcome = examine_file(document, file, place.outer)
    if outcome.faults:
        lines = lines_of(text)
        return None, [
            fault if fault.file else replace(fault, file=file, line=line_at(lines, fault.path))
            for fault in outcome.faults
        ]
    return KINDS[outcome.kind].made(outcome.parts, file), []


def nested_in(document: Mapping[str, Any]) -> Iterator[tuple[Path, Key, Any]]:
    """Yield the path, the key and the value of each nested design in a `document`, as written."""
    kind = _meant_kind(document)
    for at, table, raw in kind.tables_in(document) if kind else ():
        for name, key in table.entries.items():
            if key.param.nested and isinstance(raw, Mapping) and name in raw:
                yield (*at, name), key, raw[name]
