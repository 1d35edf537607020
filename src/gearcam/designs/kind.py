"""The kinds of design, and the outcome of validating a design.

Each kind is a folder of the package `gearcam.kinds`, found by its name. No other code names a kind,
and only the kind of the design at hand is imported. The modules of a kind:

- `design`: ``KIND``, a `DesignKind`: the tables of a file, their rules, and the design class;
- `build`: ``build(design, tolerances)`` returns its `gearcam.results.result.Result`;
- `facts`: ``facts(result, measured)`` returns its facts;
- `files`: ``FILES``, the function that makes each kind of file; paragraphs of its docstring list
  the names of the files (``Files: ...``) and what they hold. With ``report`` also
  ``assembled(result)``, the solids in their places, and ``framed(result)``, the HTML for notebooks;
- `charts`: ``CHARTS``, functions that return charts; `scene`: ``scene(result)`` returns the scene;
- `advice`: ``seek(search, refusal)`` searches for remedies of a refused design or one with errors,
  ``hopeless(result)`` tells which designs need not be built completely, ``moves(design, other)``
  which ones change the motion, ``FILE_DEMANDS`` has
  functions by kind of file that refuse a file although all parts can be made;
- `public`: ``__all__`` lists the classes for designs written in Python (the package
  `gearcam.kinds` declares them for type checkers);
- `describe`: the main part in the schema, the template and the list of laws;
- `commands`, optional: ``COMMANDS`` for the command line;
- `ladder`, optional: ``LADDERS``, stages at increasing resolution (see `gearcam.results.ladders`).
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

from gearcam.base.findings import CHECKS
from gearcam.designs.faults import Fault
from gearcam.designs.table import Key, Table

_HOME: Final = "gearcam.kinds"


@dataclass
class Examined:
    """The outcome of validating a design.

    Parameters
    ----------
    faults : list of Fault
        All mistakes.
    parts : dict
        Parameter objects of valid parts, by the names of the fields of a design.
    """

    faults: list[Fault] = field(default_factory=list)
    parts: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False, kw_only=True)
class DesignKind:
    """A kind of design.

    Parameters
    ----------
    name : str
        Name in design files.
    doc : str
        Short description.
    design : type
        Class of its designs: a frozen dataclass with ``name``, ``source``, ``limits``, the result
        of `examine_main` and a field for each table.
    main : str
        Title of the part whose keys depend on a registry; empty if there is none, and then neither
        the next three nor the module `describe` are needed.
    examine_main : callable
        ``examine_main(document, found)`` validates that part.
    main_of : callable
        ``main_of(design)`` returns that part as in a design file.
    homes : callable
        Returns hints by key that say where a key of that part belongs.
    tables : mapping of str to callable
        Functions that return the tables with fixed keys, by title, which is also the field name.
    required : tuple of str
        Titles of tables that a file must have.
    one_of : mapping of str to tuple
        Alternatives of which a table has exactly one, by its title: keys, or values of a key.
    conditions : mapping of str to callable
        Functions that return additions to the JSON schema of a table, by its title.
    rules : callable
        ``rules(document, found)`` yields contradictions between tables.
    listed : callable
        ``listed(document, table)`` returns the keys of a table for messages about unknown keys and
        missing tables.
    later : callable
        ``later(document)`` returns a fault for designs that are not supported, or None. No other
        fault is reported then.
    formats : tuple of str
        Kinds of files that ``output.files`` may list.
    rooms : tuple of str
        Modules that register checks.
    checks : tuple of str
        Kinds of subject of those checks.
    studies : tuple of str
        Titles of tables with settings of studies, on which no file of a build depends.
    example : mapping
        A design that builds without a warning, by title, in the units of a file.
    notes : mapping of str to str
        Comments on tables of the example.
    processes : mapping of str to mapping
        Additions to the example for each process: ``printing``, ``laser`` or ``wire``.
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
    studies: tuple[str, ...] = ()
    example: Mapping[str, Any]
    notes: Mapping[str, str] = field(default_factory=dict)
    processes: Mapping[str, Mapping[str, Mapping[str, Any]]] = field(default_factory=dict)

    @property
    def titles(self) -> tuple[str, ...]:
        """The top-level keys and tables of a file of this kind."""
        main = (self.main,) if self.main else ()
        return ("kind", "name", *main, *self.tables, "limits")

    def table(self, title: str) -> Table:
        """Return a table by its title: one of `tables`, or ``limits``."""
        return self._limits() if title == "limits" else self.tables[title]()

    def room(self, name: str) -> ModuleType:
        """Import and return a module of its folder by `name`."""
        return importlib.import_module(f"{_package(self.name)}.{name}")

    def load_checks(self) -> None:
        """Import the modules that register checks."""
        # on demand, since a file without limits does not need them
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
                    # nan: it depends on the design
                    known = None if math.isnan(default) else default
                    entries[key] = Key(name, key, made_of, float, None, "", known)
        return Table("limits", None, entries)


class _Kinds(Mapping[str, DesignKind]):
    """The kinds by name, each imported when it is used."""

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
    """Return an optional module of a `kind` by `name`, or None; its designs are not imported."""
    home = f"{_package(kind)}.{name}"
    return importlib.import_module(home) if importlib.util.find_spec(home) else None


def rooms(name: str) -> Iterator[ModuleType]:
    """Yield the modules called `name` of all kinds, without importing their designs."""
    return (room for kind in _names() if (room := find_room(kind, name)) is not None)


def all_formats() -> tuple[str, ...]:
    """Return the kinds of files of all kinds of design."""
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
