"""The names in a mechanism: what each of them is, and whether all that is named exists.

A linkage of cranks, slides, points and dyads has mobility 1 if each part is solved from those
before: then nothing here is wrong.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from functools import cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from gearcam.designs.faults import Fault, dotted, show
from gearcam.designs.kind import KINDS
from gearcam.designs.slips import did_you_mean
from gearcam.kinds.mechanism.keys import NAME
from gearcam.kinds.mechanism.name_keys import (
    ANY,
    GIVES,
    GUIDE,
    JOINT,
    MEMBER,
    NEEDS,
    SHAFT,
    STANDING,
    NameKey,
    name_keys,
)
from gearcam.linkages.dyads import DYADS
from gearcam.linkages.elements import GROUND

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined
    from gearcam.designs.lines import Path
    from gearcam.kinds.mechanism.tables import DyadSpec, MachineDrive

Parts = Mapping[str, Any]
"""The tables of a mechanism by title."""


class NameUse(NamedTuple):
    """A name that a table gives or needs.

    Attributes
    ----------
    name : str
        The name.
    sort : str
        What it is, or must be: one of several, with "or" between.
    path : tuple
        Where it stands in the design.
    """

    name: str
    sort: str
    path: Path


def parts_of(design: Any) -> dict[str, Any]:
    """Return the tables of a mechanism's `design` by title."""
    return {one.name: getattr(design, one.name) for one in fields(design)}


def given(parts: Parts) -> Iterator[NameUse]:
    """Yield the names that the tables of a mechanism give.

    Parameters
    ----------
    parts : mapping of str to tables
        By title.
    """
    for title, number, one in _several(parts):
        yield from _shafts(one, number) if title == "drive" else _uses(one, GIVES, (title, number))


def needed(parts: Parts) -> Iterator[NameUse]:
    """Yield the names that the tables of a mechanism need (see `given`)."""
    for title, number, one in _several(parts):
        yield from _uses(one, NEEDS, (title, number))
        if title == "dyad":
            yield from _ends(one, number)


def _several(parts: Parts) -> Iterator[tuple[str, int, Any]]:
    """Yield the tables that may be given several times, with title and number."""
    for title, tables in parts.items():
        if isinstance(tables, tuple):
            yield from ((title, number, one) for number, one in enumerate(tables))


def _uses(table: Any, use: str, at: Path) -> Iterator[NameUse]:
    """Yield the names that the keys of a table give or need."""
    for field, key, sort in name_keys(type(table), use):
        for place, name in _placed(getattr(table, field), (*at, key)):
            if name is not None:
                yield NameUse(name, sort, place)


def _placed(value: Any, at: Path) -> list[tuple[Path, Any]]:
    """Return a value, or those of a list, with their places."""
    if isinstance(value, list | tuple):
        return [((*at, k), one) for k, one in enumerate(value)]
    return [(at, value)]


def _shafts(drive: MachineDrive, number: int) -> Iterator[NameUse]:
    path = ("drive", number, "name")
    for word, sort in drive.shafts.items():
        yield NameUse(f"{drive.name}.{word}", sort, path)
        if drive.even or drive.slide is not None:
            yield NameUse(drive.name, sort, path)


def _ends(dyad: DyadSpec, number: int) -> Iterator[NameUse]:
    guides = DYADS[dyad.formula].guides
    for name, key, guided in zip((dyad.first, dyad.last), ("from", "to"), guides, strict=True):
        yield NameUse(name, GUIDE if guided else JOINT, ("dyad", number, key))


def moves(dyad: DyadSpec) -> str:
    """Return the name of the place of a dyad's joint on a guide, if it slides on one that is given.

    Parameters
    ----------
    dyad : DyadSpec
        The table.

    Returns
    -------
    str
        Of the quantity; empty if it does not.
    """
    slides = [one for one in DYADS[dyad.formula].slides if one.startswith("guide")]
    return f"{dyad.joint}.{slides[0]}" if len(slides) == 1 else ""


def problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    """Yield names that are given twice, that nothing gives, or that are of another sort.

    Parameters
    ----------
    document : mapping
        As read: what is named by faulty tables counts as given.
    found : Examined
        The valid tables.
    """
    parts = {title: tables for title, tables in found.parts.items() if is_read(title, found)}
    faulty = list(_of_faulty(document, found))
    compared = [
        NameUse(one.name, ANY, ("compare", number, "name"))
        for number, one in enumerate(found.parts.get("compare", ()))
    ]
    names: dict[str, NameUse] = {GROUND: NameUse(GROUND, MEMBER, ())}
    faults = [*_misspelt(found, compared), *_twice(compared, {})]
    faults += _twice([*given(parts), *faulty], names)
    whole = not _unread(found) and all(one.name for one in faulty)
    for one in needed(parts):
        if one.name in names or (whole and _told_of(one.name, names)):
            faults += _unsuitable(one, names)
    yield from faults
    if not (faults or found.faults):
        yield from _unreached(parts)


def complete(found: Examined) -> bool:
    """Return whether all names of a mechanism are known, as far as its tables could be read.

    Parameters
    ----------
    found : Examined
        The valid tables.
    """
    return not _unread(found) and all(is_read(title, found) for title in _giving())


def is_read(title: str, found: Examined) -> bool:
    """Return whether the names in the tables of a title are known from the valid tables.

    Parameters
    ----------
    title : str
        The title.
    found : Examined
        The valid tables.
    """
    told = (one.path[0] for one in found.faults if one.path)
    # what a drive moves depends on several keys, which may contradict each other
    return title in found.parts and not (title == "drive" and title in told)


def _unread(found: Examined) -> bool:
    """Return whether whole tables are missing, or have unknown titles."""
    alone = {one.path[0] for one in found.faults if len(one.path) == 1}
    return not alone <= {"kind", "name"}


@cache
def _giving() -> dict[str, tuple[NameKey, ...]]:
    """Return the keys with names that tables give, by title."""
    found = {title: name_keys(owner, GIVES) for title, owner in KINDS[NAME].tables.items()}
    return {title: keys for title, keys in found.items() if keys}


def _of_faulty(document: Mapping[str, Any], found: Examined) -> Iterator[NameUse]:
    """Yield the names that tables with faults give, "" for one that cannot be read."""
    for title, keys in _giving().items():
        rows = () if is_read(title, found) else document.get(title)
        for number, row in enumerate(rows if isinstance(rows, list) else ()):
            for _, key, sort in keys:
                value = row.get(key) if isinstance(row, Mapping) else None
                for place, name in _placed(value, (title, number, key)):
                    yield NameUse(name if isinstance(name, str) else "", sort, place)


def _told_of(name: str, names: Mapping[str, NameUse]) -> bool:
    """Return whether a missing name is to be told: not if a drive with faults may give it."""
    owner = names.get(name.rpartition(".")[0])
    return owner is None or owner.sort != ANY


_NAME: Final = re.compile(r"[A-Za-z_][\w-]*", re.ASCII)


def _misspelt(found: Examined, compared: Sequence[NameUse]) -> Iterator[Fault]:
    """Yield names that cannot be parts of the names of columns and facts."""
    tables = _several(found.parts)
    uses = (use for title, k, one in tables for use in _uses(one, GIVES, (title, k)))
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
        return one.sort == SHAFT or one.path[:1] == ("joint",)
    return one.sort in sort.split(" or ")


def _unsuitable(one: NameUse, names: Mapping[str, NameUse]) -> Iterator[Fault]:
    """Yield that nothing has a name that is needed, or something of another sort."""
    other = names.get(one.name)
    if other is not None and (other.sort == ANY or _suits(other, one.sort)):
        return
    others = (item for item in names.items() if item[1].path[:2] != one.path[:2])
    fits = sorted(name for name, use in others if _suits(use, one.sort))
    allowed = f"a {one.sort}: {', '.join(fits)}" if fits else f"the name of a {one.sort}"
    if other is None:
        what, hint = ": nothing has this name", did_you_mean(one.name, fits)
    else:
        what, hint = " moves" if one.sort == STANDING else f" is a {other.sort}", ""
    yield Fault(one.path, f"{show(one.name)}{what}", one.name, allowed, hint)


def waits(parts: Parts) -> dict[Path, tuple[str, ...]]:
    """Return the paths of tables that wait for each other, and the names they wait for.

    Parameters
    ----------
    parts : mapping of str to tables
        By title; all names exist.
    """
    known, left = {GROUND}, {}
    for one in given(parts):
        left.setdefault(one.path[:2], ([], []))[0].append(one.name)
    for one in needed(parts):
        if one.path[:2] in left:  # loads, masses and springs give no names
            left[one.path[:2]][1].append(one.name)
    while ready := [path for path, (_, wanted) in left.items() if known.issuperset(wanted)]:
        for path in ready:
            known.update(left.pop(path)[0])
    return {
        path: tuple(name for name in wanted if name not in known)
        for path, (_, wanted) in left.items()
    }


def _unreached(parts: Parts) -> Iterator[Fault]:
    """Yield parts that cannot be solved in any order: the mobility is not 1."""
    for path, names in waits(parts).items():
        what = f"waits for {', '.join(names)}, which waits for it: no order solves both"
        yield Fault(path, what, allowed="a chain of dyads, each from what is known before it")
