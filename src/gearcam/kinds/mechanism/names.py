"""The names in a mechanism: what each of them is, and whether all that is named exists.

A linkage of cranks, slides, points and dyads has mobility 1 if each part is solved from those
before: then nothing here is wrong.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from gearcam.designs.faults import Fault, dotted, show
from gearcam.designs.kind import KINDS
from gearcam.designs.slips import did_you_mean
from gearcam.kinds.mechanism.drives import is_read
from gearcam.kinds.mechanism.keys import (
    GIVES,
    STANDING,
    NameKey,
    NameUse,
    Sort,
    WithNames,
    name_keys,
    placed,
)
from gearcam.kinds.mechanism.parts import PARTS
from gearcam.kinds.mechanism.parts.action import Acted, MachineAction
from gearcam.kinds.mechanism.parts.part import MachinePart
from gearcam.linkages.elements import GROUND

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined
    from gearcam.designs.lines import Path

Tables = Mapping[str, Any]
"""The tables of a mechanism by title."""


def tables_of(design: Any) -> dict[str, Any]:
    """Return the tables of a mechanism's `design` by title."""
    return {one.name: getattr(design, one.name) for one in fields(design)}


def several(tables: Tables) -> Iterator[tuple[str, int, WithNames]]:
    """Yield those of the `tables` that may be given several times, with title and number."""
    for title, found in tables.items():
        if isinstance(found, tuple):
            yield from ((title, number, one) for number, one in enumerate(found))


def parts_of(tables: Tables) -> Iterator[tuple[str, int, MachinePart]]:
    """Yield the parts of a mechanism with title and number, in the order of the file."""
    for title, number, one in several(tables):
        if isinstance(one, MachinePart):
            yield title, number, one


def told_parts(tables: Tables) -> Iterator[tuple[str, int, MachinePart]]:
    """Yield the parts in the order in which a mechanism tells of them (see `parts_of`)."""
    yield from parts_of({title: tables[title] for title in PARTS if title in tables})


def given(tables: Tables) -> Iterator[NameUse]:
    """Yield the names that the `tables` of a mechanism give."""
    for title, number, one in several(tables):
        yield from (use.at(title, number) for use in one.given())


def needed(tables: Tables) -> Iterator[NameUse]:
    """Yield the names that the `tables` of a mechanism need (see `given`)."""
    for title, number, one in several(tables):
        yield from (use.at(title, number) for use in one.needed())


def problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    """Yield names that are given twice, that nothing gives, or that are of another sort.

    Parameters
    ----------
    document : mapping
        As read: what is named by faulty tables counts as given.
    found : Examined
        The valid tables.
    """
    tables = {title: one for title, one in found.parts.items() if is_read(title, found)}
    faulty = list(_of_faulty(document, found))
    compared = [
        NameUse(one.name, Sort.ANY, ("compare", number, "name"))
        for number, one in enumerate(found.parts.get("compare", ()))
    ]
    names: dict[str, NameUse] = {GROUND: NameUse(GROUND, Sort.MEMBER, ())}
    faults = [*_misspelt(found, compared), *_twice(compared, {})]
    faults += _twice([*given(tables), *faulty], names)
    whole = not _unread(found) and all(one.name for one in faulty)
    for one in needed(tables):
        if one.name in names or (whole and _told_of(one.name, names)):
            faults += _unsuitable(one, names)
    yield from faults
    if not (faults or found.faults):
        yield from _unreached(tables)


def complete(found: Examined) -> bool:
    """Return whether all names of a mechanism are known, as far as its tables could be read.

    Parameters
    ----------
    found : Examined
        The valid tables.
    """
    return not _unread(found) and all(is_read(title, found) for title in _giving(found.kind))


def _unread(found: Examined) -> bool:
    """Return whether whole tables are missing, or have unknown titles."""
    alone = {one.path[0] for one in found.faults if len(one.path) == 1}
    return not alone <= {"kind", "name"}


@cache
def _giving(kind: str) -> dict[str, tuple[NameKey, ...]]:
    """Return the keys with names that tables give, by title."""
    found = {title: name_keys(owner, GIVES) for title, owner in KINDS[kind].tables.items()}
    return {title: keys for title, keys in found.items() if keys}


def _of_faulty(document: Mapping[str, Any], found: Examined) -> Iterator[NameUse]:
    """Yield the names that tables with faults give, "" for one that cannot be read."""
    for title, keys in _giving(found.kind).items():
        rows = () if is_read(title, found) else document.get(title)
        for number, row in enumerate(rows if isinstance(rows, list) else ()):
            for _, use in keys:
                value = row.get(use.path[0]) if isinstance(row, Mapping) else None
                for place, name in placed(value, (title, number, *use.path)):
                    known = name if isinstance(name, str) else ""
                    yield use._replace(name=known, path=place)


def _told_of(name: str, names: Mapping[str, NameUse]) -> bool:
    """Return whether a missing name is to be told: not if a drive with faults may give it."""
    owner = names.get(name.rpartition(".")[0])
    return owner is None or owner.sort != Sort.ANY


_NAME: Final = re.compile(r"[A-Za-z_][\w-]*", re.ASCII)


def _misspelt(found: Examined, compared: Sequence[NameUse]) -> Iterator[Fault]:
    """Yield names that cannot be parts of the names of columns and facts."""
    uses = [
        use.at(title, number)
        for title, number, table in several(found.parts)
        for use in table.written(GIVES)
    ]
    for one in (*uses, *compared):
        if not _NAME.fullmatch(one.name):
            allowed = "letters, digits, _ and -, the first a letter"
            yield Fault(one.path[:3], f"{show(one.name)} is no name", one.name, allowed)


def _twice(uses: Sequence[NameUse], names: dict[str, NameUse]) -> Iterator[Fault]:
    """Yield names that are given twice, and collect all of them."""
    told = set[tuple[str | int, ...]]()
    for one in (one for one in uses if one.name):
        first = names.setdefault(one.name, one)
        if first is one or one.path in told:
            continue
        told.add(one.path)
        name = one.name.partition(".")[0]
        where = f"first by {dotted(first.path)}" if first.path else "first to the frame"
        what = f"the name {show(name)} is given twice, {where}"
        yield Fault(one.path, what, name, "a name for one thing")


def _suits(one: NameUse, sort: str) -> bool:
    """Return whether what is given has a sort that is needed."""
    if sort == STANDING:
        return one.sort == Sort.SHAFT or one.still
    return one.sort in sort.split(" or ")


def _unsuitable(one: NameUse, names: Mapping[str, NameUse]) -> Iterator[Fault]:
    """Yield that nothing has a name that is needed, or something of another sort."""
    other = names.get(one.name)
    if other is not None and (other.sort == Sort.ANY or _suits(other, one.sort)):
        return
    others = (item for item in names.items() if item[1].path[:2] != one.path[:2])
    fits = sorted(name for name, use in others if _suits(use, one.sort))
    allowed = f"a {one.sort}: {', '.join(fits)}" if fits else f"the name of a {one.sort}"
    if other is None:
        what, hint = ": nothing has this name", did_you_mean(one.name, fits)
    else:
        what, hint = " moves" if one.sort == STANDING else f" is a {other.sort}", ""
    yield Fault(one.path, f"{show(one.name)}{what}", one.name, allowed, hint)


def waits(tables: Tables) -> dict[Path, tuple[str, ...]]:
    """Return the paths of tables that wait for each other, and the names they wait for.

    Parameters
    ----------
    tables : mapping
        By title; all names exist.
    """
    known, left = {GROUND}, {}
    for one in given(tables):
        left.setdefault(one.path[:2], ([], []))[0].append(one.name)
    for one in needed(tables):
        if one.path[:2] in left:  # loads, masses and springs give no names
            left[one.path[:2]][1].append(one.name)
    while ready := [path for path, (_, wanted) in left.items() if known.issuperset(wanted)]:
        for path in ready:
            known.update(left.pop(path)[0])
    return {
        path: tuple(name for name in wanted if name not in known)
        for path, (_, wanted) in left.items()
    }


def _unreached(tables: Tables) -> Iterator[Fault]:
    """Yield parts that cannot be solved in any order: the mobility is not 1."""
    for path, names in waits(tables).items():
        what = f"waits for {', '.join(names)}, which waits for it: no order solves both"
        yield Fault(path, what, allowed="a chain of dyads, each from what is known before it")


# --- what loads act on ---------------------------------------------------------------------------


def acted_on(tables: Tables) -> Acted:
    """Return what loads may act on in the `tables` of a mechanism."""
    uses = list(given(tables))
    ways, unturned = {}, {}
    for _, _, part in parts_of(tables):
        ways |= part.ways
        unturned |= part.unturned
    return Acted(
        sorts={GROUND: Sort.MEMBER}
        | {one.name: one.sort for one in uses}
        | dict.fromkeys(ways, Sort.WAY),
        ways=ways,
        driven=frozenset(one.name for one in uses if one.sort == Sort.WAY),
        unturned=unturned,
        still=frozenset({GROUND, *(one.name for one in uses if one.still)}),
    )


def unfit(found: Examined, told: Iterable[Fault]) -> Iterator[Fault]:
    """Yield keys of loads, masses and springs that do not suit what they act on.

    Parameters
    ----------
    found : Examined
        The valid tables.
    told : iterable of Fault
        Of names: nothing more is said of their tables.
    """
    acted, every = acted_on(found.parts), list(acting(found.parts))
    vain = [fault for path, one in every for fault in _in_vain(path, one, acted)]
    yield from vain
    wrong = {one.path[:2] for one in (*found.faults, *told, *vain)}
    wrong |= {one.path[:2] for one in needed(found.parts) if one.name not in acted.sorts}
    for path, one in every:
        if path not in wrong:
            for fault in one.unfit(acted):
                yield replace(fault, path=(*path, *fault.path))


def acting(tables: Tables) -> Iterator[tuple[tuple[str, int], MachineAction]]:
    """Yield what acts on a mechanism, by its `tables`, with title and number."""
    for title, number, one in several(tables):
        if isinstance(one, MachineAction):
            yield (title, number), one


def _in_vain(path: tuple[str, int], one: MachineAction, acted: Acted) -> Iterator[Fault]:
    """Yield that what acts on something that stands still does no work."""
    name = getattr(one, one.moved) if one.moved else None
    if name in acted.still:
        what = f"{show(name)} stands still: what acts on it does no work"
        yield Fault((*path, one.moved), what, name, "the name of what moves")
