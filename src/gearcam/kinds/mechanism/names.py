"""The names in a mechanism: what each of them is, and whether all that is named exists.

A linkage of cranks, slides, points and dyads has mobility 1 if each part is solved from those
before: then nothing here is wrong.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from gearcam.designs.faults import Fault, dotted, show
from gearcam.designs.slips import did_you_mean
from gearcam.kinds.mechanism.tables import MachineDrive
from gearcam.linkages.dyads import DYADS
from gearcam.linkages.elements import GROUND

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined
    from gearcam.kinds.mechanism.tables import DyadSpec

SHAFT, WAY, JOINT, MEMBER, GUIDE = "shaft", "slide", "joint", "member", "guide"
STANDING: Final = "joint that stands still, or shaft"
"""What a name can be."""

ANY: Final = ""
"""What the name of a drive with faults is: it may turn or slide."""

PARTS: Final = (
    "drive", "joint", "crank", "slide", "guide", "dyad", "point", "chain", "hoist", "geneva",
    "load", "mass", "spring",
)  # fmt: skip
"""Titles of the tables that give or need names."""


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
    path: tuple[str | int, ...]


def given(parts: Mapping[str, Sequence[Any]]) -> Iterator[NameUse]:
    """Yield the names that the tables of a mechanism give.

    Parameters
    ----------
    parts : mapping of str to sequence of tables
        By title.
    """
    for title, number, one in _tables(parts):
        for key, sort in _GIVES.get(title, ()):
            yield NameUse(getattr(one, key), sort, (title, number, key))
        if title == "drive":
            yield from _shafts(one, number)
        if title == "dyad":
            for place, name in enumerate(one.members):
                yield NameUse(name, MEMBER, (title, number, "members", place))


def needed(parts: Mapping[str, Sequence[Any]]) -> Iterator[NameUse]:
    """Yield the names that the tables of a mechanism need (see `given`)."""
    for title, number, one in _tables(parts):
        for key, written, sort in _NEEDS.get(title, ()):
            if getattr(one, key) is not None:
                yield NameUse(getattr(one, key), sort, (title, number, written))
        if title == "dyad":
            ends = zip(("first", "last"), ("from", "to"), DYADS[one.formula].guides, strict=True)
            for key, written, guided in ends:
                yield NameUse(
                    getattr(one, key), GUIDE if guided else JOINT, (title, number, written)
                )
        if title == "spring":
            for place, name in enumerate(one.between or ()):
                yield NameUse(name, f"{JOINT} or {MEMBER}", (title, number, "between", place))


_GIVES: Final = {
    "joint": (("name", JOINT),),
    "crank": (("name", MEMBER), ("joint", JOINT)),
    "slide": (("name", MEMBER), ("joint", JOINT)),
    "guide": (("name", GUIDE),),
    "dyad": (("joint", JOINT),),
    "point": (("name", JOINT),),
    "chain": (("lever", MEMBER), ("joint", JOINT)),
    "hoist": (("name", MEMBER), ("joint", JOINT)),
    "geneva": (("name", MEMBER),),
}

_NEEDS: Final = {
    "crank": (("on", "on", SHAFT), ("at", "at", JOINT)),
    "slide": (("on", "on", WAY),),
    "guide": (("on", "on", MEMBER), ("through", "through", STANDING)),
    "dyad": (("driven", "driven", WAY),),
    "point": (("on", "on", MEMBER),),
    "chain": (("on", "on", SHAFT),),
    "hoist": (("on", "on", SHAFT),),
    "load": (("on", "on", f"{JOINT} or {MEMBER} or {SHAFT} or {WAY}"),),
    "mass": (("of", "of", f"{MEMBER} or {SHAFT}"), ("center", "center", JOINT)),
    "spring": (("on", "on", f"{JOINT} or {MEMBER} or {SHAFT} or {WAY}"),),
    "geneva": (("on", "on", SHAFT), ("at", "at", JOINT)),
}


def _tables(parts: Mapping[str, Sequence[Any]]) -> Iterator[tuple[str, int, Any]]:
    for title in PARTS:
        for number, one in enumerate(parts.get(title, ())):
            yield title, number, one


def _shafts(drive: Any, number: int) -> Iterator[NameUse]:
    for word in drive.shafts:
        yield NameUse(f"{drive.name}.{word}", sort_of(drive, word), ("drive", number, "name"))
    if drive.even or drive.slide is not None:
        yield NameUse(drive.name, SHAFT if drive.even else WAY, ("drive", number, "name"))


def sort_of(drive: Any, word: str) -> str:
    """Return whether what a drive moves turns or slides.

    Parameters
    ----------
    drive : MachineDrive
        Its table.
    word : str
        One of `MachineDrive.shafts`.

    Returns
    -------
    str
        `SHAFT` or `WAY`.
    """
    if word == "follower":
        follower = getattr(drive.cam, "follower", None)
        return SHAFT if getattr(follower, "motion", "") == "oscillating" else WAY
    return WAY if word in ("rack", "slide") else SHAFT


def problems(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    """Yield names that are given twice, that nothing gives, or that are of another sort.

    Parameters
    ----------
    document : mapping
        As read: what is named by faulty tables counts as given.
    found : Examined
        The valid tables.
    """
    parts = {title: found.parts[title] if _is_read(title, found) else () for title in PARTS}
    faulty = list(_of_faulty(document, found))
    names: dict[str, NameUse] = {GROUND: NameUse(GROUND, MEMBER, ())}
    faults = [*_misspelt(found), *_unfit_drives(found), *_compared_twice(found)]
    faults += [*_not_comparable(found), *_twice([*given(parts), *faulty], names)]
    standing = [one.path for one in names.values() if one.path[:1] == ("joint",)]
    whole = not _unread(found) and all(one.name for one in faulty)
    for one in needed(parts):
        if one.name not in names and not (whole and _told_of(one.name, names)):
            continue
        if one.sort == STANDING:
            faults += _not_standing(one, names, standing)
        else:
            faults += _missing(one, names)
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
    return not _unread(found) and all(_is_read(title, found) for title in ("drive", *_GIVES))


def _is_read(title: str, found: Examined) -> bool:
    """Return whether the names in the tables of a title are known from the valid tables."""
    told = (one.path[0] for one in found.faults if one.path)
    # what a drive moves depends on several keys, which may contradict each other
    return title in found.parts and not (title == "drive" and title in told)


def _unread(found: Examined) -> bool:
    """Return whether whole tables are missing, or have unknown titles."""
    alone = {one.path[0] for one in found.faults if len(one.path) == 1}
    return not alone <= {"kind", "name"}


def _of_faulty(document: Mapping[str, Any], found: Examined) -> Iterator[NameUse]:
    """Yield the names that tables with faults give, "" for one that cannot be read."""
    for title in ("drive", *_GIVES):
        rows = () if _is_read(title, found) else document.get(title)
        for number, row in enumerate(rows if isinstance(rows, list) else ()):
            row = row if isinstance(row, Mapping) else {}
            for key, sort in _GIVES.get(title, (("name", ANY),)):
                yield NameUse(_text(row.get(key)), sort, (title, number, key))
            if title == "dyad":
                members = row.get("members")
                for place, name in enumerate(members if isinstance(members, list) else [""]):
                    yield NameUse(_text(name), MEMBER, (title, number, "members", place))


def _text(value: Any) -> str:
    return value if isinstance(value, str) else ""


def _told_of(name: str, names: Mapping[str, NameUse]) -> bool:
    """Return whether a missing name is to be told: not if a drive with faults may give it."""
    owner = names.get(name.rpartition(".")[0])
    return owner is None or owner.sort != ANY


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


def _not_comparable(found: Examined) -> Iterator[Fault]:
    """Yield drives to compare that do not have the shafts of the first drive."""
    drives = found.parts["drive"] if _is_read("drive", found) else ()
    if not drives:
        return
    master = drives[0]
    for number, one in enumerate(found.parts.get("compare", ())):
        if one.even is False:
            continue
        if one.even:
            if master.pair is None:
                what = "cannot replace the first drive, which is not a pair"
                yield Fault(("compare", number, "even"), what, True, "where a pair is the master")
            continue
        key = "pair" if one.pair is not None else "cam"
        own = MachineDrive(name=master.name, pair=one.pair, cam=one.cam)
        sorts = [{word: sort_of(drive, word) for word in drive.shafts} for drive in (own, master)]
        if sorts[0] != sorts[1]:
            what = f"does not have the shafts of {master.name}: {', '.join(master.shafts)}"
            allowed = (
                "a drive of the same sort; an even shaft stands beside a pair with even = true"
            )
            yield Fault(("compare", number, key), what, allowed=allowed)


def _compared_twice(found: Examined) -> Iterator[Fault]:
    """Yield names of comparisons that are given twice."""
    names = [one.name for one in found.parts.get("compare", ())]
    for number, name in enumerate(names):
        if name in names[:number]:
            first = f"compare[{names.index(name)}].name"
            what = f"the name {show(name)} is given twice, first by {first}"
            yield Fault(("compare", number, "name"), what, name, "a name for one thing")


def _unfit_drives(found: Examined) -> Iterator[Fault]:
    """Yield drives without an angle over which motion could be given."""
    for title in ("drive", "compare"):
        for number, one in enumerate(found.parts.get(title, ())):
            if getattr(getattr(one.cam, "cam", None), "form", "") == "translating":
                what = f"the cam {show(one.cam.name)} slides: it has no shaft"
                yield Fault((title, number, "cam"), what, None, "a cam that turns")
    for number, one in enumerate(found.parts.get("drive", ())):
        yield from _without_effect(number, one)
    for one in found.parts.get("drive", ())[:1]:
        if one.slide is not None:
            what = f"{show(one.slide)} has no angle over which the motion could be given"
            allowed = "a first drive with pair, cam or even = true, and the slide behind it"
            yield Fault(("drive", 0, "slide"), what, one.slide, allowed)


def _without_effect(number: int, one: MachineDrive) -> Iterator[Fault]:
    """Yield keys that a drive is given in vain."""
    if not number or one.slide is not None:
        why = "the first drive is the master" if not number else "its formula is in the master's q"
        for key, value, usual in (("ratio", one.ratio, 1), ("phase_deg", one.phase, 0.0)):
            if value != usual:
                yield Fault(("drive", number, key), f"has no effect: {why}", value, f"{usual:g}")
    if number and one.speed is not None:
        what = "has no effect: the speed is that of the first drive"
        yield Fault(("drive", number, "speed_rpm"), what, None, "the key in the first drive")


_NAME: Final = re.compile(r"[A-Za-z_][\w-]*", re.ASCII)


def _misspelt(found: Examined) -> Iterator[Fault]:
    """Yield names that cannot be parts of the names of columns and facts."""
    for title, keys in _NAMING.items():
        for number, one in enumerate(found.parts.get(title, ())):
            for key in keys:
                given_ = getattr(one, key)
                for name in given_ if isinstance(given_, tuple) else (given_,):
                    if not _NAME.fullmatch(name):
                        what = f"{show(name)} is no name"
                        allowed = "letters, digits, _ and -, the first a letter"
                        yield Fault((title, number, key), what, name, allowed)


_NAMING: Final = {
    "drive": ("name",), "compare": ("name",), "joint": ("name",), "crank": ("name", "joint"),
    "slide": ("name", "joint"), "guide": ("name",), "dyad": ("joint", "members"),
    "point": ("name",), "chain": ("lever", "joint"), "hoist": ("name", "joint"),
    "geneva": ("name",),
}  # fmt: skip
"""The keys that give names, by title."""


def _not_standing(
    one: NameUse, names: Mapping[str, NameUse], standing: Sequence[tuple[str | int, ...]]
) -> Iterator[Fault]:
    other = names.get(one.name)
    if other is None or not (other.sort in (SHAFT, ANY) or other.path in standing):
        fits = [key for key, is_ in names.items() if is_.sort == SHAFT or is_.path in standing]
        allowed = f"a {STANDING}: {', '.join(fits)}"
        if other is None:
            yield _nothing(one, fits, allowed)
        else:
            yield Fault(one.path, f"{show(one.name)} moves", one.name, allowed)


def _missing(one: NameUse, names: Mapping[str, NameUse]) -> Iterator[Fault]:
    other, sorts = names.get(one.name), one.sort.split(" or ")
    others = (item for item in names.items() if item[1].path[:2] != one.path[:2])
    fits = sorted(name for name, is_ in others if is_.sort in sorts)
    allowed = f"a {one.sort}: {', '.join(fits)}" if fits else f"the name of a {one.sort}"
    if other is None:
        yield _nothing(one, fits, allowed)
    elif other.sort not in (*sorts, ANY):
        yield Fault(one.path, f"{show(one.name)} is a {other.sort}", one.name, allowed)


def _nothing(one: NameUse, fits: Sequence[str], allowed: str) -> Fault:
    """Return that nothing has a name, with the nearest one that would do."""
    what = f"{show(one.name)}: nothing has this name"
    return Fault(one.path, what, one.name, allowed, did_you_mean(one.name, fits))


def waits(parts: Mapping[str, Sequence[Any]]) -> dict[tuple[str | int, ...], tuple[str, ...]]:
    """Return the paths of tables that wait for each other, and the names they wait for.

    Parameters
    ----------
    parts : mapping of str to sequence of tables
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


def _unreached(parts: Mapping[str, Sequence[Any]]) -> Iterator[Fault]:
    """Yield parts that cannot be solved in any order: the mobility is not 1."""
    stuck = waits(parts)
    for path, names in stuck.items():
        what = f"waits for {', '.join(names)}, which waits for it: no order solves both"
        yield Fault(path, what, allowed="a chain of dyads, each from what is known before it")


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
