"""The kinds of design: how a design of each kind is read, and the outcome of validating one.

Each kind is a folder of the package `gearcam.kinds` (`gearcam.base.kinds`); its module `design` has
its ``KIND``. No other code names a kind, and only the kind of the design at hand is imported. What
a kind does beside reading (results, files, charts) is in `gearcam.results.kind.Kind`.
"""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from inspect import get_annotations
from types import SimpleNamespace
from typing import Any, Final, Protocol, get_args, get_type_hints

from gearcam.base.brought import brought, group_of, load_brought
from gearcam.base.display import cut
from gearcam.base.findings import CHECKS
from gearcam.base.kinds import folder_of, kind_names, kind_studies
from gearcam.base.quantities import params_of
from gearcam.base.registry import ExtensibleMapping
from gearcam.base.rules import Rule
from gearcam.designs.faults import Fault
from gearcam.designs.lines import Path
from gearcam.designs.nodes import Circumstances, Keys, Many, Node, choices_in, tables_in
from gearcam.designs.slips import cam_of, keyed, nearest
from gearcam.designs.table import Key, Table, table_of


@dataclass
class Examined:
    """The outcome of validating a design.

    Parameters
    ----------
    faults : list of Fault
        All mistakes.
    parts : dict
        Parameter objects of valid parts, by the names of the fields of a design.
    kind : str
        The kind of design that it is; empty if it is not known.
    """

    faults: list[Fault] = field(default_factory=list)
    parts: dict[str, Any] = field(default_factory=dict)
    kind: str = ""


class WithTables(Protocol):
    """What `Variants` choose from, such as a form of cams."""

    @property
    def tables(self) -> Mapping[str, type]:
        """The classes of tables, by title."""
        ...


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Variants:
    """Tables whose keys depend on the value of one key, such as the form of a cam.

    Parameters
    ----------
    title, key : str
        The table and its key that decide.
    default : str
        The value of the key where it is left out.
    entries : mapping of str to WithTables
        What the key chooses, by its values; those of the default are the bases of the others.
    called : str
        Name of an entry in messages, such as ``a {} cam``.
    elsewhere : mapping of str to str
        Further values of the key whose designs are of another kind, and that kind.
    """

    title: str
    key: str
    default: str
    entries: Mapping[str, WithTables]
    called: str
    elsewhere: Mapping[str, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.title}.{self.key}>"

    @property
    def titles(self) -> tuple[str, ...]:
        """Titles of the tables that depend on the key."""
        return tuple(self.entries[self.default].tables)

    @property
    def values(self) -> tuple[str, ...]:
        """All values of the key."""
        return (*self.entries, *self.elsewhere)

    def meant(self, document: Mapping[str, Any]) -> str:
        """Return the value of the key in a `document`; the nearest one if it is misspelt."""
        table = document.get(self.title)
        value = table.get(self.key) if isinstance(table, Mapping) else None
        near = nearest(value, self.entries) if isinstance(value, str) else ""
        return near or self.default

    def named(self, document: Mapping[str, Any]) -> bool:
        """Return whether a `document` has a value of the key, or a word for one."""
        table = document.get(self.title)
        value = table.get(self.key) if isinstance(table, Mapping) else None
        return isinstance(value, str) and bool(nearest(value, self.values))

    def of(self, design: Any) -> str:
        """Return the value of the key in a `design`."""
        value = getattr(getattr(design, self.title), self.key, self.default)
        return self.meant({self.title: {self.key: value}})

    def table(self, title: str, value: str) -> Table:
        """Return the table of a `title` for a `value` of the key."""
        table = table_of(title, self.entries[value].tables[title])
        if title != self.title:
            return table
        entry = table.entries[self.key]
        entry = replace(entry, param=replace(entry.param, choices=self.values))
        return Table(title, table.owner, {**table.entries, self.key: entry})

    def union(self, title: str) -> Table:
        """Return a table with the keys of all values, for descriptions."""
        tables = [self.table(title, value) for value in (self.default, *self.entries)]
        entries: dict[str, Key] = {}
        for key, entry in (item for table in tables for item in table.entries.items()):
            if entry.required and not all(key in table.entries for table in tables):
                entry = replace(entry, default=None)
            entries.setdefault(key, entry)
        return Table(title, None, entries)  # no class has them all

    def owners(self, title: str, key: str) -> dict[str, Key]:
        """Return a `key` in the table of a `title`, by the values for which this has it."""
        tables = {value: self.table(title, value) for value in self.entries}
        for value, name in self.elsewhere.items():
            if title in KINDS[name].tables:
                tables[value] = KINDS[name].table(title)
        found = {value: table.entries.get(key) for value, table in tables.items()}
        return {value: entry for value, entry in found.items() if entry is not None}


OF_MANY: Final = {"sweep": "what `gearcam sweep` gives to keys: values, ranges, distributions"}
"""Tables about many designs, which a build leaves out, and what they say."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class DesignKind:
    """How designs of one kind are read and described.

    Parameters
    ----------
    name : str
        Name in design files.
    doc : str
        Short description.
    also : tuple of str
        Other names that people use for it.
    design : type
        Class of its designs: a frozen dataclass with ``name``, ``source``, ``limits`` and a field
        for each table, whose type is the class of the table, or a tuple of any number of them if a
        file may give it several times, unless `nodes` has its title.
    result : callable
        ``result(design, tolerances)`` returns its `gearcam.results.result.Result`.
    nodes : mapping of str to Node
        What stands under titles where it is not the keys of a class, such as ``[law]``.
    circumstances : callable
        ``circumstances(document)`` returns what the units of its keys depend on.
    variants : Variants, optional
        What decides on the keys of some tables.
    required : tuple of str
        Titles of tables that a file must have.
    rules : tuple of Rule
        Rules between tables; those between the keys of a table belong to its class.
    problems : callable
        ``problems(document, found)`` yields contradictions between tables that are computed.
    later : callable
        ``later(document)`` returns a fault for designs that are not supported, or None. No other
        fault is reported then.
    check_modules : tuple of str
        Modules that register checks.
    check_groups : tuple of str
        Groups of those checks: what they look at.
    example : mapping
        A design that builds without a warning, by title, in the units of a file.
    samples : mapping of str to mapping
        Values that the template shows of optional keys, by title: where each kind has its own.
    notes : mapping of str to str
        Comments on tables of the example.
    processes : mapping of str to mapping
        Additions to the example for each process: ``printing``, ``laser`` or ``wire``.
    repeated : mapping of str to str
        Facts that repeat a key under another name: the keys, by the facts or what these begin with.
    brought : str
        Group of the tables that other packages bring and that a file may give several times; empty
        if they cannot. The settings of their studies are tables anyway.
    """

    name: str
    doc: str
    also: tuple[str, ...] = ()
    design: type
    result: Callable[..., Any]
    nodes: Mapping[str, Node] = field(default_factory=dict)
    circumstances: Callable[[Mapping[str, Any]], Circumstances] = lambda _: {}
    variants: Variants | None = None
    required: tuple[str, ...]
    rules: tuple[Rule, ...] = ()
    problems: Callable[[Mapping[str, Any], Examined], Iterable[Fault]] = lambda *_: ()
    later: Callable[[Mapping[str, Any]], Fault | None] = lambda _: None
    check_modules: tuple[str, ...] = ()
    check_groups: tuple[str, ...] = ()
    example: Mapping[str, Any]
    samples: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    notes: Mapping[str, str] = field(default_factory=dict)
    processes: Mapping[str, Mapping[str, Mapping[str, Any]]] = field(default_factory=dict)
    repeated: Mapping[str, str] = field(default_factory=dict)
    brought: str = ""

    def __repr__(self) -> str:
        return f'<{type(self).__name__} "{self.name}">'

    @property
    def studies(self) -> ExtensibleMapping[Any]:
        """Its studies by name; each is a command, too (see `gearcam.results.studies`)."""
        return kind_studies(self.name)

    @cached_property
    def added(self) -> dict[str, Any]:
        """Tables that other packages bring, as in `tree`; none before `take_brought`."""
        return {}

    @cached_property
    def tree(self) -> Mapping[str, Any]:
        """The titles of a file with the types of their fields, as the class of designs has them."""
        return get_annotations(self.design) | self.added

    def take_brought(self) -> None:
        """Know the tables that other packages bring, too: parts, and settings of studies.

        Raises
        ------
        DesignError
            If a package cannot be loaded.
        """
        studies = group_of(self.name, "studies")
        found = {
            title: tuple[load_brought(self.brought, title), ...] for title in brought(self.brought)
        }
        found |= {title: load_brought(studies, title).settings for title in brought(studies)}
        if new := {title: one for title, one in found.items() if title not in self.tree}:
            self.added.update(new)
            for name in ("tree", "several", "tables"):
                vars(self).pop(name, None)

    def made(self, parts: Mapping[str, Any], source: str) -> Any:
        """Return the design of valid `parts` by the names of its fields, from a file `source`."""
        added = {title: part for title, part in parts.items() if title in self.added}
        own = {name: part for name, part in parts.items() if name not in added}
        return self.design(source=source, examined=True, added=added, **own)

    def titles_with(self, given: Collection[str]) -> list[str]:
        """Return the titles of its own tables, and those of other packages that are `given`."""
        known = self.titles
        if any(title not in known for title in given):
            self.take_brought()
        return [title for title in self.tree if title not in self.added or title in given]

    @cached_property
    def several(self) -> tuple[str, ...]:
        """Titles of tables that a file gives once or more, in double brackets."""
        return tuple(
            title
            for title, hint in self.tree.items()
            if title not in self.nodes and _is_several(hint)
        )

    @cached_property
    def tables(self) -> Mapping[str, type]:
        """The classes of the tables with their keys, by title; of variants those of the default."""
        usual = self.variants.entries[self.variants.default].tables if self.variants else {}
        hints = {title: hint for title, hint in self.tree.items() if title not in self.nodes}
        return _Tables(hints, usual, vars(sys.modules[self.design.__module__]))

    @property
    def titles(self) -> tuple[str, ...]:
        """The top-level keys and tables of a file of this kind."""
        return ("kind", "name", "units", *self.tree, "limits", *OF_MANY)

    @property
    def formats(self) -> Collection[str]:
        """Kinds of files that ``output.files`` may list."""
        return params_of(self.tables["output"])["files"].choices or ()

    @property
    def study_tables(self) -> Mapping[str, str]:
        """Titles of the tables with the settings of studies, by the names of the studies."""
        own = {name: one.table for name, one in self.studies.own.items()}
        return own | {title: title for title in self.added if title not in self.several}

    def meant(self, document: Mapping[str, Any]) -> DesignKind:
        """Return the kind that a `document` of this kind is of: another one for some variants."""
        if self.variants is None:
            return self
        table = document.get(self.variants.title)
        value = table.get(self.variants.key) if isinstance(table, Mapping) else None
        word = nearest(value, self.variants.values) if isinstance(value, str) else ""
        name = self.variants.elsewhere.get(word)
        return KINDS[name] if name else self

    def table(self, title: str) -> Table:
        """Return a table by its title: one of `tables`, or ``limits``."""
        if title == "limits":
            return self._limits()
        if self.variants and title in self.variants.titles:
            return self.variants.union(title)
        return table_of(title, self.tables[title])

    def table_in(self, document: Mapping[str, Any], title: str) -> Table:
        """Return a table by its title, with the keys that it may have in a `document`."""
        if self.variants is None or title not in self.variants.titles:
            return self.table(title)
        return self.variants.table(title, self.variants.meant(document))

    def table_of(self, design: Any, title: str) -> Table:
        """Return a table by its title, with the keys that it may have in a `design`."""
        if self.variants is None or title not in self.variants.titles:
            return self.table(title)
        return self.variants.table(title, self.variants.of(design))

    def node(self, title: str, document: Mapping[str, Any] | None = None) -> Node:
        """Return what stands under a title, with the keys that it may have in a `document`."""
        if title in self.nodes:
            return self.nodes[title]
        return self._with(self.table(title) if document is None else self.table_in(document, title))

    def node_of(self, design: Any, title: str) -> Node:
        """Return what stands under a title, with the keys that it may have in a `design`."""
        return self.nodes.get(title) or self._with(self.table_of(design, title))

    def _with(self, table: Table) -> Node:
        keys = Keys(table=table)
        return Many(item=keys) if table.title in self.several else keys

    @property
    def words(self) -> dict[str, Collection[str]]:
        """The words that single values of its tables may be, by dotted key."""
        words: dict[str, Collection[str]] = {}
        for title in self.tables:
            words |= self.table(title).words
        found = variant_of(self)
        if found and (variants := found[0].variants):
            words |= found[0].table(variants.title).words
        choices = [one for node in self.nodes.values() for one in choices_in(node)]
        return words | {f"{one.title}.{one.tag}": one.entries.keys() for one in choices}

    def tables_in(self, document: Mapping[str, Any]) -> Iterator[tuple[Path, Table, Any]]:
        """Yield the path, the keys and the content of each table in a `document`."""
        for title in (*self.tree, "limits"):
            if title in document:
                yield from tables_in(self.node(title, document), document[title], (title,))

    def load_checks(self) -> None:
        """Import the modules that register checks."""
        # on demand, since a file without limits does not need them
        for module in self.check_modules:
            importlib.import_module(module)

    def _limits(self) -> Table:
        self.load_checks()
        entries = {}
        for group in self.check_groups:
            for check in CHECKS.values():
                if check.kind == group and check.limit is not None:
                    name, param, default = check.limit
                    key = param.key(name)
                    # nan: it depends on the design
                    value = None if math.isnan(default) else default
                    length = 2 if param.both else None
                    entries[key] = Key(name, key, param, float, length, "", value)
        return Table("limits", None, entries)


def _is_several(hint: Any) -> bool:
    """Return whether a field of a design has any number of tables."""
    return str(hint).startswith("tuple[")


class _Tables(Mapping[str, type]):
    """The classes of tables by title, each found when it is used: others may not be imported.

    Parameters
    ----------
    hints : mapping of str to object
        The types of the fields of a design, by title, as written.
    usual : mapping of str to type
        The classes of some of them.
    scope : dict
        The names in the module of the design.
    """

    def __init__(
        self, hints: Mapping[str, Any], usual: Mapping[str, type], scope: dict[str, Any]
    ) -> None:
        self._hints, self._scope, self._found = hints, scope, dict(usual)

    def __repr__(self) -> str:
        return cut(f"<tables {', '.join(self)}>")

    def __getitem__(self, title: str) -> type:
        if title not in self._found:
            own = SimpleNamespace(__annotations__={title: self._hints[title]})
            hint = get_type_hints(own, self._scope)[title]
            self._found[title] = get_args(hint)[0] if _is_several(self._hints[title]) else hint
        return self._found[title]

    def __iter__(self) -> Iterator[str]:
        return iter(self._hints)

    def __len__(self) -> int:
        return len(self._hints)


class _Kinds(Mapping[str, DesignKind]):
    """The kinds by name, each imported when it is used."""

    def __iter__(self) -> Iterator[str]:
        return iter(kind_names())

    def __len__(self) -> int:
        return len(kind_names())

    def __contains__(self, name: object) -> bool:
        return name in kind_names()

    def __getitem__(self, name: str) -> DesignKind:
        if name not in kind_names():
            raise KeyError(name)
        return importlib.import_module(f"{folder_of(name)}.design").KIND


KINDS: Final[Mapping[str, DesignKind]] = _Kinds()
"""The kinds of design by name."""


def variant_of(kind: DesignKind) -> tuple[DesignKind, str] | None:
    """Return the kind of which a kind is one of the variants, and the word for it; or None."""
    for one in KINDS.values():
        for value, name in one.variants.elsewhere.items() if one.variants else ():
            if name == kind.name:
                return one, value
    return None


def as_written(kind: DesignKind, value: str = "") -> str:
    """Return how a kind, or one of its variants, is written in a file.

    Parameters
    ----------
    kind : DesignKind
        The kind.
    value : str
        A value of the key that decides on its variants; empty for any.
    """
    if found := variant_of(kind):
        kind, value = found
    words = f'kind = "{kind.name}"'
    variants = kind.variants
    return (
        f'{words} with {variants.title}.{variants.key} = "{value}"' if variants and value else words
    )


def nearest_kind(word: str) -> str:
    """Return the name of the kind that a `word` names or is nearest to; empty if there is none."""
    if word in KINDS:
        return word
    also = {other: kind.name for kind in KINDS.values() for other in kind.also}
    return also.get(word.lower()) or nearest(word, KINDS)


def named_variant(word: str) -> tuple[DesignKind, str] | None:
    """Return the kind and the variant that a `word` for a kind names, as ``barrel-cam`` does."""
    plain = cam_of(word)
    if word in KINDS or (plain == word and nearest_kind(word)):
        return None
    for kind in KINDS.values():
        value = nearest(plain, kind.variants.values) if kind.variants else ""
        if value:
            return kind, value
    return None


def kind_meant(word: str) -> tuple[DesignKind, str] | None:
    """Return the kind that a `word` names, and what it says of its tables; None if there is none.

    Parameters
    ----------
    word : str
        Not the name of a kind: another name of one, a variant, or a word of its tables.

    Returns
    -------
    kind : DesignKind
        The kind; of a variant the one of which it is a variant.
    values : str
        Keys and values in words, such as ``cam.form = "groove"``; empty if none is needed.
    """
    if found := named_variant(word):
        kind, value = found
        variants = kind.variants
        return kind, f'{variants.title}.{variants.key} = "{value}"' if variants else ""
    if near := nearest_kind(word):
        return KINDS[near], ""
    for kind in KINDS.values():
        if words := keyed(word, kind.words):
            return kind, words
    return None


def all_formats() -> tuple[str, ...]:
    """Return the formats of files of all kinds of design."""
    return tuple(dict.fromkeys(name for kind in KINDS.values() for name in kind.formats))
