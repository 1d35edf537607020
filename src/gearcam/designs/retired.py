"""Keys that design files had once, and what they have become.

Each is an entry of `RETIRED`: a file that has one is refused with what to write instead, and
`gearcam.designs.migrate` writes it where that is the same for every reader.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from gearcam.designs.faults import Fault, show


@dataclass(frozen=True, kw_only=True)
class Instead:
    """What stands for a retired key.

    Parameters
    ----------
    here : mapping of str to value
        Keys of the same table.
    there : mapping of (str, str) to value
        Keys of other tables, by title and key.
    by_hand : str
        What to do where no keys stand for it alone; empty where they do.
    """

    here: Mapping[str, Any] = field(default_factory=dict)
    there: Mapping[tuple[str, str], Any] = field(default_factory=dict)
    by_hand: str = ""

    @property
    def words(self) -> str:
        """The keys with their values."""
        keys = [assigned(key, value) for key, value in self.here.items()]
        keys += [
            f"{assigned(key, value)} under [{title}]" for (title, key), value in self.there.items()
        ]
        return self.by_hand or " with ".join(keys) or "nothing: leave it out"


@dataclass(frozen=True, kw_only=True)
class Retired:
    """A key that is no longer known.

    Parameters
    ----------
    title, key : str
        Table and name.
    doc : str
        What it is now.
    turn : callable
        ``turn(value)`` returns what stands for it.
    where : mapping of str to value
        What other keys of the table must be for it to have been one.
    """

    title: str
    key: str
    doc: str
    turn: Callable[[Any], Instead]
    where: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Found:
    """A retired key in a document.

    Parameters
    ----------
    path : (str, str)
        Title and key.
    instead : Instead
        What stands for it there.
    fault : Fault
        What is said of it.
    """

    path: tuple[str, str]
    instead: Instead
    fault: Fault


def assigned(key: str, value: Any) -> str:
    """Return ``key = value`` as in a file, of a `key` and its `value`."""
    return f"{key} = {show(value)}"


def without_retired(document: Mapping[str, Any]) -> tuple[list[Found], Mapping[str, Any]]:
    """Look for retired keys.

    Parameters
    ----------
    document : mapping
        As read from TOML.

    Returns
    -------
    found : list of Found
        Those that it has.
    rest : mapping
        The document without them, with the keys that stand for them.
    """
    found, rest = [], dict(document)
    for entry in RETIRED:
        table = rest.get(entry.title)
        if (
            isinstance(table, Mapping)
            and entry.key in table
            and all(table.get(key) == value for key, value in entry.where.items())
        ):
            found.append(_found(entry, table[entry.key], document))
            kept = {key: value for key, value in table.items() if key != entry.key}
            rest[entry.title] = kept | found[-1].instead.here
            for (title, key), value in found[-1].instead.there.items():
                there = rest.get(title, {})
                rest[title] = {key: value, **there} if isinstance(there, Mapping) else there
            if found[-1].instead.there and not rest[entry.title]:
                del rest[entry.title]
    return found, rest


def _found(entry: Retired, value: Any, document: Mapping[str, Any]) -> Found:
    instead, path = entry.turn(value), (entry.title, entry.key)
    wanted = [*((entry.title, key) for key in instead.here), *instead.there]
    taken = [".".join(place) for place in wanted if _given(document, *place)]
    if taken:
        words = f"{instead.words}; but {' and '.join(taken)} stands there already: keep one of both"
        instead = Instead(by_hand=words)
    hint = "" if instead.by_hand else "the command migrate writes it so"
    message = f"is now {entry.doc} (its value is {show(value)})"
    fault = Fault(path, message, value, instead.words, hint)
    return Found(path=path, instead=instead, fault=fault)


def _given(document: Mapping[str, Any], title: str, key: str) -> bool:
    table = document.get(title)
    return isinstance(table, Mapping) and key in table


def _offset(value: Any) -> Instead:
    """Turn the offset of all edges: below 0 it was clearance, above half a kerf."""
    values = value if isinstance(value, list) else [value, value]
    known = all(type(one) in (int, float) and math.isfinite(one) for one in values)
    if not known or len(values) != 2:
        return Instead(by_hand="clearance_mm of 0 or more, or kerf_mm of 0 or more under [output]")
    first, second = values
    if max(values) <= 0:
        taken = [abs(one) for one in values]
        if not any(taken):
            return Instead()
        return Instead(
            here={
                "clearance_mm": taken if isinstance(value, list) else taken[0],
                "clearance_bores": True,
            }
        )
    if first == second:
        return Instead(there={("output", "kerf_mm"): 2 * first})
    return Instead(by_hand=_by_hand(first, second))


def _by_hand(first: float, second: float) -> str:
    """Say what to write where the wheels differ in more than their clearance."""
    kerfs = [
        f"{assigned('kerf_mm', 2 * one)} under [output] for wheel {number}"
        for number, one in enumerate((first, second), start=1)
        if one > 0
    ]
    words = f"{' and '.join(kerfs)}: kerf_mm is one value, so build once for each wheel"
    if min(first, second) >= 0:
        return words
    taken = [max(0, -one) for one in (first, second)]
    return f"{assigned('clearance_mm', taken)} with clearance_bores = true, and {words}"


def _renamed(title: str, key: str, new: str, table: str = "") -> Retired:
    """Return the entry of a key that has another name, in the same table or in another one."""

    def turn(value: Any) -> Instead:
        return Instead(there={(table, new): value}) if table else Instead(here={new: value})

    return Retired(title=title, key=key, doc=f"{table}.{new}" if table else new, turn=turn)


RETIRED: Final = (
    Retired(
        title="blank",
        key="offset_mm",
        doc="clearance_mm (what is taken off the part) or output.kerf_mm (what the cutter burns "
        "away, twice what the offset was)",
        turn=_offset,
    ),
    _renamed("helix", "steps", "count", "steps"),
    _renamed("helix", "offset_mm", "offset_mm", "steps"),
    _renamed("meshing", "helix_step", "step"),
    _renamed("meshing", "advance_deg", "overclosure_deg"),
    Retired(
        title="law",
        key="way",
        doc="travel: that of the rack",
        turn=lambda value: Instead(here={"travel": value}),
        where={"type": "rack"},
    ),
)
"""All of them; a new one is one more entry."""
