"""The kinds of design, and what an examination of one collects.

Each kind is a folder of the package `gearcam.kinds`, found there by its name; nothing outside it
names it, and only that of a file is loaded. Its modules:

- `design`: ``KIND``, a `DesignKind`: the tables of a file, their rules, the design they make;
- `build`: ``build(design, tolerances)`` returns its `gearcam.result.Result`;
- `facts`: ``facts(result, measured)`` returns what is known of it;
- `files`: ``FILES``, a `gearcam.export.shared.FileFormat` for each kind of file; where ``report``
  is among them, ``assembled(result)`` returns its solids where they stand and ``framed(result)``
  what a notebook shows;
- `charts`: ``CHARTS``, what makes each chart; `scene`: ``scene(result)`` returns what moves;
- `advice`: ``seek(search, refusal)`` leads the search for changes that help where it is refused
  or has errors, ``hopeless(result)`` tells what need not be built to its end, ``FILE_DEMANDS`` by
  kinds of files what refuses those though all parts can be made;
- `public`: in its ``__all__`` the classes that people who write Python make designs of (the
  package `gearcam.kinds` tells type checkers of them);
- `describe`: what schema, template and list of laws say of its main part, and the table of each
  of its items;
- `commands`, where it has any: ``COMMANDS`` of the command line;
- `ladder`, where it has any: ``LADDERS``, stages at rising resolution (see `gearcam.ladders`).
"""

from __future__ import annotations

import importlib
import importlib.util
import math
import pkgutil
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from types import ModuleType
from typing import Any, Final

from gearcam.designs.faults import Fault, show
from gearcam.designs.lines import Path
from gearcam.designs.slips import misspelt
from gearcam.designs.table import Key, Table
from gearcam.findings import CHECKS

_HOME: Final = "gearcam.kinds"


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
class DesignKind:
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
        Title of the part that has no keys of its own but those of a registry; empty where a kind
        has none, and then neither the next three nor the module `describe`.
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
    one_of : mapping of str to tuple
        Keys of which a table has exactly one, by its title; or words of a key instead of them.
    conditions : mapping of str to callable
        What returns more of the JSON schema of a table, by its title.
    rules : callable
        ``rules(document, found)`` yields faults between the tables.
    listed : callable
        ``listed(document, table)`` returns the keys of a table that people are told of where one is
        unknown or all are missing.
    later : callable
        ``later(document)`` returns the fault of what is not made, and only that is told, or None.
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
    processes : mapping of str to mapping
        What the example has besides for each way to make it, ``printing``, ``laser`` or ``wire``.
    """

    name: str
    doc: str
    design: type
    main: str = ""
    examine_main: Callable[[Mapping[str, Any], Examined], None] = lambda *_: None
    main_of: Callable[[Any], Any] = lambda _: None
    homes: Callable[[], Mapping[str, str]] = dict
    tables: Mapping[str, Callable[[], Table]]
    required: tuple[str, ...]
    one_of: Mapping[str, tuple[str | Mapping[str, Sequence[str]], ...]] = field(
        default_factory=dict
    )
    conditions: Mapping[str, Callable[[], dict[str, Any]]] = field(default_factory=dict)
    rules: Callable[[Mapping[str, Any], Examined], Iterable[Fault]] = lambda *_: ()
    listed: Callable[[Mapping[str, Any], Table], Iterable[str]] = lambda _, table: table.entries
    later: Callable[[Mapping[str, Any]], Fault | None] = lambda _: None
    formats: tuple[str, ...]
    rooms: tuple[str, ...] = ()
    checks: tuple[str, ...] = ()
    example: Mapping[str, Any]
    notes: Mapping[str, str] = field(default_factory=dict)
    processes: Mapping[str, Mapping[str, Mapping[str, Any]]] = field(default_factory=dict)

    @property
    def titles(self) -> tuple[str, ...]:
        """Everything that a file of this kind may have at its top."""
        main = (self.main,) if self.main else ()
        return ("kind", "name", *main, *self.tables, "limits")

    def table(self, title: str) -> Table:
        """Return a table by its title: one of `tables`, or ``limits``."""
        return self._limits() if title == "limits" else self.tables[title]()

    def room(self, name: str) -> ModuleType:
        """Return one of the modules of its folder, by `name`; ModuleNotFoundError without it."""
        return importlib.import_module(f"{_package(self.name)}.{name}")

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
                    entries[key] = Key(name, key, made_of, float, None, "", known)
        return Table("limits", None, entries)


class _Kinds(Mapping[str, DesignKind]):
    """The kinds by name, each loaded when it is asked for."""

    def __iter__(self) -> Iterator[str]:
        return iter(_names())

    def __len__(self) -> int:
        return len(_names())

    def __contains__(self, name: object) -> bool:
        return name in _names()

    def __getitem__(self, name: str) -> DesignKind:
        if name not in _names():
            raise KeyError(name)
        return importlib.import_module(f"{_package(name)}.design").KIND


KINDS: Final[Mapping[str, DesignKind]] = _Kinds()
"""The kinds of design by name."""


def find_room(kind: str, name: str) -> ModuleType | None:
    """Return the module of a `name` that a `kind` may have; its designs are not loaded."""
    home = f"{_package(kind)}.{name}"
    return importlib.import_module(home) if importlib.util.find_spec(home) else None


def rooms(name: str) -> Iterator[ModuleType]:
    """Yield the modules of a `name` that kinds have, without loading anything of their designs."""
    return (room for kind in _names() if (room := find_room(kind, name)) is not None)


def all_formats() -> tuple[str, ...]:
    """Return every kind of file that a design of some kind can give."""
    return tuple(dict.fromkeys(name for kind in KINDS.values() for name in kind.formats))


def _names() -> tuple[str, ...]:
    return _folders(tuple(importlib.import_module(_HOME).__path__))


@cache
def _folders(path: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of the kinds that have a folder on a `path` of packages."""
    found = (one.name for one in pkgutil.iter_modules(path) if one.ispkg)
    return tuple(name.replace("_", "-") for name in sorted(found))


def _package(name: str) -> str:
    return f"{_HOME}.{name.replace('-', '_')}"


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
    wrong = {path[0] for path in here} | misspelt(raw if faults else {}, known.entries)
    readable = {key: value for key, value in raw.items() if key in known.entries}
    try:
        made = make(**known.inward(readable))
        problems = [p for p in own_faults(made, known, raw, at) if p.path[depth] not in wrong]
    except (TypeError, ValueError, AttributeError, IndexError, KeyError):
        if not faults:
            raise
        return None, []
    return made, problems
