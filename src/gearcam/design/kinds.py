"""The kinds of design, and what an examination of one collects.

A kind is one entry of the registry: its tables, its formats, its checks, its own rules and the
design that comes of them. `gear_pair` and `cam` register theirs; nothing else names a kind, and
only that of a file is loaded.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from gearcam.design.locate import Path
from gearcam.design.tables import Entry, Table
from gearcam.design.wording import Fault, show
from gearcam.findings import CHECKS
from gearcam.registry import Registry


@dataclass
class Examined:
    """What an examination has found.

    Parameters
    ----------
    faults : list of Fault
        All that is wrong.
    parts : dict
        Parameter objects of what is right, by the names of a design's fields.
    """

    faults: list[Fault] = field(default_factory=list)
    parts: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False, kw_only=True)
class Kind:
    """A kind of design.

    Parameters
    ----------
    name : str
        As in a file.
    doc : str
        What it is, for people.
    design : type
        What comes of a file: a frozen dataclass with a field for each table, ``name``, ``source``,
        ``limits``, and what `examine_main` finds.
    main : str
        Title of the part that has no keys of its own but those of a registry.
    examine_main : callable
        ``examine_main(document, found)`` examines that part.
    main_of : callable
        ``main_of(design)`` returns that part as a file would hold it.
    homes : callable
        Returns where keys of that part belong, in words, by key.
    tables : mapping of str to callable
        What gives the tables with fixed keys, by title; each makes the design's field of that name.
    required : tuple of str
        Titles that a file must give.
    one_of : mapping of str to tuple of str
        Keys of which a table has exactly one, by its title.
    rules : callable
        ``rules(document, found)`` yields faults between the tables.
    later : callable
        ``later(document)`` returns the fault of what is planned, or None.
    formats : tuple of str
        What ``output.files`` may list.
    rooms : tuple of str
        Modules whose checks register themselves.
    checks : tuple of str
        Kinds of those checks.
    example : mapping
        A design that builds without a warning, by title, in the units of a file.
    notes : mapping of str to str
        Comments on tables of the example.
    """

    name: str
    doc: str
    design: type
    main: str
    examine_main: Callable[[Mapping[str, Any], Examined], None]
    main_of: Callable[[Any], Any]
    homes: Callable[[], Mapping[str, str]]
    tables: Mapping[str, Callable[[], Table]]
    required: tuple[str, ...]
    one_of: Mapping[str, tuple[str, ...]]
    rules: Callable[[Mapping[str, Any], Examined], Iterator[Fault]]
    later: Callable[[Mapping[str, Any]], Fault | None] = lambda _: None
    formats: tuple[str, ...]
    rooms: tuple[str, ...]
    checks: tuple[str, ...]
    example: Mapping[str, Any]
    notes: Mapping[str, str]

    @property
    def titles(self) -> tuple[str, ...]:
        """Everything that a file of this kind may have at its top."""
        return ("kind", "name", self.main, *self.tables, "limits")

    def table(self, title: str) -> Table:
        """Return a table by its title: one of `tables`, or ``limits``."""
        return self._limits() if title == "limits" else self.tables[title]()

    def load_checks(self) -> None:
        """Load the rooms whose checks register themselves."""
        # only here, as a file without limits does not need them
        for room in self.rooms:
            importlib.import_module(room)

    def _limits(self) -> Table:
        self.load_checks()
        entries = {}
        for room in self.checks:
            for check in CHECKS.values():
                if check.kind == room and check.limit is not None:
                    name, made_of, default = check.limit
                    key = made_of.key(name)
                    # nan: the design decides
                    known = None if math.isnan(default) else default
                    entries[key] = Entry(name, key, made_of, float, None, False, known)
        return Table("limits", None, entries)


KINDS: Final[Registry[Kind]] = Registry(
    "kind", {"gearcam.design.gear_pair": ("gear-pair",), "gearcam.design.cam": ("cam",)}
)
"""The kinds of design by name."""


Told = Iterable[tuple[str, int | None, str, str]]
"""What parameters find wrong: field, number of an item, what is wrong, what is allowed."""


def told_faults(told: Told, known: Table, raw: Mapping[str, Any], at: Path) -> Iterator[Fault]:
    """Yield the faults of what parameters have told, with their keys and values.

    Parameters
    ----------
    told : iterable of tuple
        See `Told`.
    known : Table
        The table of the parameters.
    raw : mapping
        As in the file.
    at : tuple
        Where it stands.
    """
    keys = {entry.name: entry.key for entry in known.entries.values()}
    seen: set[Path] = set()
    for name, index, message, rule in told:
        key = keys[name]
        value, path = raw.get(key), (*at, key)
        if index is not None and (isinstance(value, list) or not known.entries[key].param.both):
            path = (*at, key, index)
            if isinstance(value, list) and index < len(value):
                value = value[index]
        if path not in seen:  # one value for both wheels is wrong once
            seen.add(path)
            shown = f"{show(value)}: {message}" if value is not None else message
            yield Fault(path, shown, value, rule)


def own_faults(made: Any, known: Table, raw: Mapping[str, Any], at: Path) -> Iterator[Fault]:
    """Yield what parameters themselves find wrong by reading (their optional ``problems``).

    Parameters
    ----------
    made : object
        The parameters.
    known, raw, at
        As of `told_faults`.
    """
    yield from told_faults(getattr(made, "problems", tuple)(), known, raw, at)


def made_of(
    known: Table,
    make: Callable[..., Any],
    raw: Mapping[str, Any],
    faults: Sequence[Fault],
    at: Path,
) -> tuple[Any, list[Fault]]:
    """Make parameters as far as they can be read, and ask them what they find wrong.

    What they find is said beside the faults of single values.

    Parameters
    ----------
    known : Table
        Their table.
    make : callable
        Makes them from inner values by name.
    raw : mapping
        As in the file; keys that the table does not know do not count.
    faults : sequence of Fault
        Of single values there.
    at : tuple
        Where it stands.

    Returns
    -------
    made : object
        None where they cannot be read.
    problems : list of Fault
        What they find.
    """
    depth = len(at)
    here = [fault.path[depth:] for fault in faults]
    if any(len(path) == 1 and path[0] in known.entries for path in here):
        return None, []
    wrong = {path[0] for path in here}
    readable = {key: value for key, value in raw.items() if key in known.entries}
    try:
        made = make(**known.inward(readable))
        problems = [p for p in own_faults(made, known, raw, at) if p.path[depth] not in wrong]
    except (TypeError, ValueError, AttributeError, IndexError, KeyError):
        if not faults:
            raise
        return None, []
    return made, problems
