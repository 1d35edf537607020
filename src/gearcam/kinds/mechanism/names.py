"""The names in a mechanism: what each is, whether all that is named exists, and what moves by it.

A linkage of cranks, slides, points and dyads has mobility 1 if each part is solved from those
before: then nothing here is wrong.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any, Final

from gearcam.designs.faults import Fault, dotted, show
from gearcam.designs.kind import KINDS
from gearcam.designs.slips import did_you_mean, nearest
from gearcam.kinds.mechanism.asked import Amount, Output, coordinates
from gearcam.kinds.mechanism.drives import is_read
from gearcam.kinds.mechanism.keys import (
    GIVES,
    STANDING,
    NameUse,
    Sort,
    WithNames,
    name_keys,
    placed,
)
from gearcam.kinds.mechanism.parts import PARTS
from gearcam.kinds.mechanism.parts.action import MachineAction
from gearcam.kinds.mechanism.parts.part import MachinePart
from gearcam.linkages.known import GROUND

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined
    from gearcam.designs.lines import Path
    from gearcam.kinds.mechanism.parts.acted import Acted

Tables = Mapping[str, Any]
"""The tables of a mechanism by title."""


def tables_of(design: Any) -> dict[str, Any]:
    """Return the tables of a mechanism's `design` by title."""
    return {one.name: getattr(design, one.name) for one in fields(design)} | design.added


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
    """Yield the parts in the order of the register `PARTS`, then others (see `parts_of`)."""
    titles = dict.fromkeys((*PARTS, *tables))
    yield from parts_of({title: tables[title] for title in titles if title in tables})


def standing_places(tables: Tables) -> dict[str, complex]:
    """Return where the joints are that stand still, by name, mm."""
    found = (part.standing() for *_, part in parts_of(tables))
    return {name: at for one in found for name, at in one.items()}


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
    asked = [
        [
            NameUse(one.name, Sort.ANY, (title, number, "name"))
            for number, one in enumerate(found.parts.get(title, ()))
        ]
        for title in ("compare", "rotor")
    ]
    names: dict[str, NameUse] = {GROUND: NameUse(GROUND, Sort.MEMBER, ())}
    faults = [*_misspelt(found, [*chain(*asked)])]
    faults += [fault for uses in asked for fault in _twice(uses, {})]
    faults += _twice([*given(tables), *faulty], names)
    whole = not _unread(found) and all(one.name for one in faulty)
    missing = {f"{one.name}.shaft": one.shaftless for one in tables.get("drive", ())}
    for one in needed(tables):
        if one.name in names or (whole and _told_of(one.name, names)):
            faults += _unsuitable(one, names, missing.get(one.name, ""))
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
    return not _unread(found) and not _unread_giving(found)


def _unread(found: Examined) -> bool:
    """Return whether whole tables are missing, or have unknown titles."""
    alone = {one.path[0] for one in found.faults if len(one.path) == 1}
    return not alone <= {"kind", "name"}


def _unread_giving(found: Examined) -> dict[str, list[NameUse]]:
    """Return the keys with names that tables give whose names are not known, by title."""
    tables = KINDS[found.kind].tables
    unread = [title for title in tables if not is_read(title, found)]
    keys = {title: [use for _, use in name_keys(tables[title], GIVES)] for title in unread}
    return {title: uses for title, uses in keys.items() if uses}


def _of_faulty(document: Mapping[str, Any], found: Examined) -> Iterator[NameUse]:
    """Yield the names that tables with faults give, "" for one that cannot be read."""
    for title, keys in _unread_giving(found).items():
        rows = document.get(title)
        for number, row in enumerate(rows if isinstance(rows, list) else ()):
            for use in keys:
                value = row.get(use.path[0]) if isinstance(row, Mapping) else None
                for place, name in placed(value, (title, number, *use.path)):
                    known = name if isinstance(name, str) else ""
                    yield use._replace(name=known, path=place)


def _told_of(name: str, names: Mapping[str, NameUse]) -> bool:
    """Return whether a missing name is to be told: not if a drive with faults may give it."""
    owner = names.get(name.rpartition(".")[0])
    return owner is None or owner.sort != Sort.ANY


_NAME: Final = re.compile(r"[A-Za-z_][\w-]*", re.ASCII)


def _misspelt(found: Examined, asked: Sequence[NameUse]) -> Iterator[Fault]:
    """Yield names that cannot be parts of the names of columns and facts."""
    uses = [
        use.at(title, number)
        for title, number, table in several(found.parts)
        for use in table.written(GIVES)
    ]
    for one in (*uses, *asked):
        if not _NAME.fullmatch(one.name):
            allowed = "letters, digits, _ and -, the first a letter"
            yield Fault(one.path[:3], f"{show(one.name)} is no name", one.name, allowed)


def _twice(uses: Sequence[NameUse], names: dict[str, NameUse]) -> Iterator[Fault]:
    """Yield names that are given twice, and collect all of them."""
    told = set[tuple[str | int, ...]]()
    for use in (one for one in uses if one.name):
        first = names.setdefault(use.name, use)
        if first is use or use.path in told:
            continue
        told.add(use.path)
        name = use.name.partition(".")[0]
        where = f"first by {dotted(first.path)}" if first.path else "first to the frame"
        what = f"the name {show(name)} is given twice, {where}"
        yield Fault(use.path, what, name, "a name for one thing")


def _suits(one: NameUse, sort: str) -> bool:
    """Return whether what is given has a sort that is needed."""
    if sort == STANDING:
        return one.sort == Sort.SHAFT or one.still
    return one.sort in sort.split(" or ")


def _unsuitable(one: NameUse, names: Mapping[str, NameUse], why: str) -> Iterator[Fault]:
    """Yield that nothing has a name that is needed, and `why`, or something of another sort."""
    other = names.get(one.name)
    if other is not None and (other.sort == Sort.ANY or _suits(other, one.sort)):
        return
    others = (item for item in names.items() if item[1].path[:2] != one.path[:2])
    fits = sorted(name for name, use in others if _suits(use, one.sort))
    allowed = f"a {one.sort}: {', '.join(fits)}" if fits else f"the name of a {one.sort}"
    if other is None:
        what, hint = f": {why or 'nothing has this name'}", did_you_mean(one.name, fits)
    else:
        what, hint = " moves" if one.sort == STANDING else f" is a {other.sort}", ""
    yield Fault(one.path, f"{show(one.name)}{what}", one.name, allowed, hint)


def _unreached(tables: Tables) -> Iterator[Fault]:
    """Yield parts that cannot be solved in any order: the mobility is not 1."""
    known, left = {GROUND}, {}
    for one in given(tables):
        left.setdefault(one.path[:2], ([], []))[0].append(one.name)
    for one in needed(tables):
        if one.path[:2] in left:  # loads, masses and springs give no names
            left[one.path[:2]][1].append(one.name)
    while ready := [path for path, (_, wanted) in left.items() if known.issuperset(wanted)]:
        for path in ready:
            known.update(left.pop(path)[0])
    for path, (_, wanted) in left.items():
        names = ", ".join(name for name in wanted if name not in known)
        what = f"waits for {names}, which waits for it: no order solves both"
        yield Fault(path, what, allowed="a chain of dyads, each from what is known before it")


# --- what loads act on ---------------------------------------------------------------------------


def acted_on(tables: Tables) -> Acted:
    """Return what loads may act on in the `tables` of a mechanism."""
    from gearcam.kinds.mechanism.parts.acted import Acted  # motion needs none of what acts

    uses = list(given(tables))
    ways, unturned = {}, {}
    for *_, part in parts_of(tables):
        ways |= part.ways()
        unturned |= part.unturned()
    return Acted(
        sorts={GROUND: Sort.MEMBER}
        | {one.name: one.sort for one in uses}
        | dict.fromkeys(ways, Sort.WAY),
        ways=ways,
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
    every = list(acting(found.parts))
    if not every:
        return
    acted, vain = acted_on(found.parts), []
    for path, one in every:
        if one.moved and (name := getattr(one, one.moved)) in acted.still:
            what = f"{show(name)} stands still: what acts on it does no work"
            vain.append(Fault((*path, one.moved), what, name, "the name of what moves"))
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


# --- what may be asked ---------------------------------------------------------------------------

Known = dict[str, tuple[Output, ...]]


class OutputNames:
    """What may be asked of a mechanism, by name.

    Parameters
    ----------
    tables : mapping of str to tables
        By title.
    """

    def __init__(self, tables: Tables) -> None:
        self.tables = tables
        self.parts = [part for *_, part in told_parts(tables)]

    @cached_property
    def known(self) -> Known:
        """All that may be asked for: a point has two coordinates, each of which has two names."""
        found = dict(self.whole)
        for joint in self.joints:
            for one in coordinates(joint):
                alone = (one._replace(name=one.quantity),)
                found.setdefault(one.quantity, alone)
                found.setdefault(one.stem, alone)
        return found

    @cached_property
    def whole(self) -> Known:
        """What may be asked for, but for single coordinates."""
        outputs: Known = {}
        for part in self.parts:
            outputs |= part.outputs()
        for joint in self.joints:
            outputs.setdefault(joint, coordinates(joint))
        for one in (use for part in self.parts for use in part.given() if use.turns):
            name = f"{one.name}.angle"
            outputs[name] = (Output(name, one.name, name, True),)
        for drive in self.tables.get("drive", ()):
            for word, sort in drive.shafts.items():
                name = f"{drive.name}.{word}"
                outputs[name] = (Output(name, name.replace(".", "_"), name, sort == Sort.SHAFT),)
        return outputs

    @cached_property
    def joints(self) -> list[str]:
        """The joints that move."""
        uses = given(self.tables)
        return [one.name for one in uses if one.sort == Sort.JOINT and not one.still]

    @property
    def usual(self) -> list[str]:
        """What is given where a design does not say: slides and points, else a direction."""
        last = {type(part): part for part in self.parts}
        found = [one for part in self.parts for one in part.usual(last=part is last[type(part)])]
        first = min((rank for rank, _ in found), default=0)
        master = self.tables.get("drive", ())[:1]
        return [name for rank, name in found if rank == first] or [
            f"{one.name}.{word}" for one in master for word in [*one.shafts][-1:]
        ]

    def asked(self, asked: Sequence[str] | None) -> tuple[Output, ...]:
        """Return what is asked for, each once.

        Parameters
        ----------
        asked : sequence of str or None
            Names of outputs; None for the usual ones.
        """
        found = dict[tuple[str, str], Output]()
        for name in self.usual if asked is None else asked:
            for one in self.known[name]:
                # a coordinate that is also asked for with the whole point belongs to its path
                key = one.stem, one.quantity
                if key not in found or one.quantity != one.name:
                    found[key] = one
        return tuple(found.values())

    def unknown(self, path: Path, name: str) -> Fault:
        """Return that nothing moves by a name, what does, and what may be meant.

        Parameters
        ----------
        path : tuple
            Where the name stands.
        name : str
            The name.
        """
        more = "; of a joint also NAME.x and NAME.y" if self.joints else ""
        allowed = f"{', '.join(self.whole)}{more}"
        message = f"{show(name)}: nothing moves by this name"
        return Fault(path, message, name, allowed, self._hint(name))

    def _hint(self, name: str) -> str:
        """Return what may be meant by a name that is no output."""
        owner = name.rpartition(".")[0]
        if owner in self.joints:
            gives = (
                "its place on its guide" if len(self.whole[owner]) == 1 else "its two coordinates"
            )
            return f"{owner} is a joint, which has no direction: write {owner}, for {gives}"
        if any(name in part.standing() for part in self.parts):
            return f"{name} stands still"
        owners = [one.rpartition(".")[0] for one in self.whole if "." in one]
        hint = "" if name in owners else did_you_mean(name, self.whole)
        meant = nearest(name, owners)
        below = [one for one in self.whole if one.startswith(f"{meant}.") and meant]
        return hint or (f"did you mean {' or '.join(below)}?" if below else "")


def unasked(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    """Yield outputs that do not move, and what is asked of outputs that cannot have it.

    Parameters
    ----------
    document : mapping
        As read.
    found : Examined
        The valid tables; nothing is said if they do not tell all
    """
    if not complete(found):
        return
    outputs = OutputNames(found.parts)
    for title, number, one in several(found.parts):
        if isinstance(one, Amount) and one.on not in outputs.known:
            yield outputs.unknown((title, number, "on"), one.on)
        elif isinstance(one, Amount):
            yield from _of_amount(one, outputs.known[one.on], (title, number), document)
    if "output" not in found.parts:
        return
    asked = found.parts["output"].outputs
    unknown = [
        outputs.unknown(("output", "outputs", number), name)
        for number, name in enumerate(asked or ())
        if name not in outputs.known
    ]
    yield from unknown or _of_stretches(outputs, asked)


def _of_amount(
    one: Amount, known: Sequence[Output], path: tuple[str, int], document: Mapping[str, Any]
) -> Iterator[Fault]:
    """Yield what is wrong in a table about one output, which gives an amount of it."""
    if len(known) > 1:
        what = f"{show(one.on)} is a point, with two coordinates"
        yield Fault((*path, "on"), what, one.on, " or ".join(one.quantity for one in known))
    elif (getattr(one, one.word) is None) != known[0].angle:
        wrong, right = ("mm", "deg") if known[0].angle else ("deg", "mm")
        what = f"{one.on} is {'an angle' if known[0].angle else 'a length'}"
        key = f"{one.word}_{wrong}"
        yield Fault((*path, key), what, document[path[0]][path[1]].get(key), f"{one.word}_{right}")


def _of_stretches(outputs: OutputNames, asked: Sequence[str] | None) -> Iterator[Fault]:
    """Yield stretches of what is no point that is asked for."""
    points = paths_asked(outputs.asked(asked))
    for number, one in enumerate(outputs.tables.get("stretch", ())):
        if one.on not in points:
            allowed = f"a point of the outputs: {', '.join(points)}"
            hint = "add it to output.outputs" if one.on in outputs.joints else ""
            hint = hint or did_you_mean(one.on, points)
            what = f"{show(one.on)} is not a point that is asked for"
            yield Fault(("stretch", number, "on"), what, one.on, allowed, hint)


def paths_asked(outputs: Sequence[Output]) -> list[str]:
    """Return the points of which both coordinates are asked for, by name.

    Parameters
    ----------
    outputs : sequence of Output
        What is asked for.
    """
    return list(dict.fromkeys(one.name for one in outputs if one.quantity == f"{one.name}.x"))
