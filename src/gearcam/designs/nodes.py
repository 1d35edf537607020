"""The tree of a design file: what may stand under a title.

A node is data. Reading a file, its schema, its template, hints on misplaced keys and the way back
from a design to a file all follow from it, so that a kind of design says once what it takes:

    [pair]                  Keys       the keys of a class
    [law]                   Choice     a table whose keys depend on the word of one of them, its tag
    [[drive]]               Many       any number of tables
    [[motion]], [motion]    Either     one of several nodes, by what is written

*Circumstances* are words such as ``oscillating`` on which the units of some keys depend
(`gearcam.base.quantities.OPPOSITES`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TypeAlias

from gearcam.base.registry import Registry
from gearcam.base.rules import Breach
from gearcam.designs.faults import Fault, quoted
from gearcam.designs.lines import Path
from gearcam.designs.table import Table, table_of

Circumstances: TypeAlias = Mapping[str, str]
"""Words, and why a key does not suit each of them."""

Wanted: TypeAlias = tuple[str, Any, tuple[type, ...]]
"""Key of a part of a design, the part, and its allowed types."""

Item: TypeAlias = tuple[int | None, str, str, str]
"""What is wrong among several tables: number of the table, field, message, what is allowed."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Keys:
    """The keys of a class.

    Parameters
    ----------
    table : Table
        The keys.
    doc : str
        What the table is, for the schema.
    also : callable
        ``also(made, circumstances)`` yields what is wrong with what is made in circumstances.
    rule : mapping
        What else the schema says.
    examples : tuple of str
        Keys that the template shows with a value where it shows the table as an alternative.
    """

    table: Table
    doc: str = ""
    also: Callable[[Any, Circumstances], Iterable[Breach]] = lambda *_: ()
    rule: Mapping[str, Any] = field(default_factory=dict)
    examples: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False)
class Choice:
    """A table whose keys depend on the word of a key, such as the law of a pair.

    Parameters
    ----------
    title : str
        Title of the table.
    tag : str
        The key.
    what : str
        Word for an entry, with its article.
    entries : mapping
        What the words mean: entries of a registry, with their ``parameters``, or classes.
    below : mapping of str to Choice
        Words with a further choice; the others have the keys of their class.
    own : Table, optional
        Keys that the table has whatever the word is.
    into : str
        Field of the class of `own` that takes what is chosen.
    doc : str
        What the table is, for the schema.
    others : str
        What the template says above the other entries.
    listing : str
        Heading of the entries in ``gearcam laws``; empty if they are not listed.
    needed : tuple of str
        Fields that must be given though their class has a default, for the schema.
    """

    title: str
    tag: str
    what: str
    entries: Mapping[str, Any]
    below: Mapping[str, Choice] = field(default_factory=dict)
    own: Table | None = None
    into: str = ""
    doc: str = ""
    others: str = ""
    listing: str = ""
    needed: tuple[str, ...] = ()

    def class_of(self, word: str) -> type:
        """Return the class that a `word` chooses."""
        entry = self.entries[word]
        return getattr(entry, "parameters", entry)

    def node(self, word: str) -> Keys | Choice:
        """Return what a `word` chooses."""
        if word in self.below:
            return self.below[word]
        return Keys(
            table=table_of(self.title, self.class_of(word)), doc=self.about(word, long=True)
        )

    def about(self, word: str, *, long: bool = False) -> str:
        """Return a line on what a `word` means; a `long` one has the continuity of a law."""
        entry = self.entries[word]
        if hasattr(entry, "continuity"):
            return f"{entry.doc} (continuity: {entry.continuity})" if long else entry.doc
        first = (self.class_of(word).__doc__ or "").partition("\n")[0].rstrip(".")
        return first[:1].lower() + first[1:]

    def word_of(self, made: object) -> str:
        """Return the word for what is chosen; empty if there is none."""
        if isinstance(self.entries, Registry):
            return self.entries.name_of(made)
        return next((word for word, owner in self.entries.items() if owner is type(made)), "")

    @property
    def classes(self) -> tuple[type, ...]:
        """All classes that may be chosen."""
        return tuple(map(self.class_of, self.entries))


_Among: TypeAlias = Callable[[Sequence[Any], Circumstances, Mapping[str, Any]], Iterable[Item]]


@dataclass(frozen=True, kw_only=True, eq=False)
class Many:
    """Any number of tables.

    Parameters
    ----------
    item : Keys or Choice
        Each of them.
    least : int
        Least number of them.
    among : callable
        ``among(made, circumstances, document)`` yields what is wrong among them; what cannot be
        read is None in ``made``.
    """

    item: Keys | Choice
    least: int = 0
    among: _Among = lambda *_: ()


class Case(NamedTuple):
    """One of the nodes of `Either`.

    Attributes
    ----------
    node : callable
        ``node()`` returns it: its class is imported when it is needed.
    makes : str
        Name of the class of which a part of a design is then an instance.
    taken : callable
        ``taken(raw)``: whether it is meant.
    schema : mapping
        The same for a schema; empty for a list, and for what is left.
    """

    node: Callable[[], Keys | Choice | Many]
    makes: str
    taken: Callable[[Any], bool]
    schema: Mapping[str, Any]


@dataclass(frozen=True, kw_only=True, eq=False)
class Either:
    """One of several nodes, by what is written.

    Parameters
    ----------
    cases : tuple of Case
        The nodes; the first is the usual one.
    refused : callable
        ``refused(raw, circumstances, home)`` returns the fault of what none of them is, or None;
        ``home("", value)`` returns a hint that says what a word in a wrong place may mean.
    rule : callable
        ``rule()`` returns what is allowed, in words.
    doc : str
        What it is, for the schema.
    others : str
        What the template says above the other nodes.
    """

    cases: tuple[Case, ...]
    refused: Callable[[Any, Circumstances, Callable[[str, Any], str]], Fault | None]
    rule: Callable[[], str]
    doc: str
    others: str

    def meant(self, raw: Any) -> Keys | Choice | Many:
        """Return the node of what is written."""
        return next(case for case in self.cases if case.taken(raw)).node()

    def made(self, part: Any) -> Keys | Choice | Many:
        """Return the node of a part of a design."""
        name = type(part).__name__  # so that no class is imported to compare with
        return next((case for case in self.cases if case.makes == name), self.cases[0]).node()


Node: TypeAlias = Keys | Choice | Many | Either


class Level(NamedTuple):
    """Keys of one class in a table, and the field that takes what those below make."""

    table: Table
    into: str


def levels_of(node: Keys | Choice, raw: Mapping[str, Any]) -> Iterator[Level]:
    """Yield the classes whose keys a table has as it is written, as far as its words are known.

    Parameters
    ----------
    node : Keys or Choice
        What the table is.
    raw : mapping
        The table in the file.
    """
    while isinstance(node, Choice):
        if node.own:
            yield Level(node.own, node.into)
        word = raw.get(node.tag)
        if not isinstance(word, str) or word not in node.entries:
            return
        node = node.node(word)
    yield Level(node.table, "")


def joined(levels: Sequence[Level], title: str) -> Table:
    """Return the keys of all `levels` as one table with a `title`."""
    if len(levels) == 1:
        return levels[0].table
    return Table(
        title, None, {key: one for level in levels for key, one in level.table.entries.items()}
    )


def tables_in(node: Node, raw: Any, at: Path) -> Iterator[tuple[Path, Table, Any]]:
    """Yield the path, the keys and the content of each table that is written under a node.

    Parameters
    ----------
    node : Node
        What may stand there.
    raw : object
        What does.
    at : tuple
        Its path.
    """
    if isinstance(node, Either):
        node = node.meant(raw)
    if isinstance(node, Many):
        for number, one in enumerate(raw if isinstance(raw, list | tuple) else ()):
            yield from tables_in(node.item, one, (*at, number))
    elif isinstance(node, Keys):
        yield at, node.table, raw
    elif isinstance(raw, Mapping):
        yield at, joined([*levels_of(node, raw)], node.title), raw


def written(node: Node, part: Any, given: Circumstances) -> Any:
    """Return what a file would hold of a part of a design.

    Parameters
    ----------
    node : Node
        What may stand there.
    part : object
        The part.
    given : mapping of str to str
        The circumstances.
    """
    if isinstance(node, Either):
        node = node.made(part)
    if isinstance(node, Many):
        return [written(node.item, one, given) for one in part]
    if isinstance(node, Keys):
        # by its own class: one that derives from that of the table may have further keys
        return table_of(node.table.title, type(part)).bound(given).document(part)
    inner = getattr(part, node.into) if node.into else part
    word = node.word_of(inner)
    own = node.own.bound(given).document(part) if node.own else {}
    if not word:
        return own
    return {node.tag: word} | own | written(node.node(word), inner, given)


def wanted(node: Node, part: Any, at: str) -> Iterator[Wanted]:
    """Yield the parts of a part of a design and the classes that they may have.

    Parameters
    ----------
    node : Node
        What may stand there.
    part : object
        The part.
    at : str
        Its dotted key.
    """
    if isinstance(node, Either):
        if (found := node.made(part)) is node.cases[0].node() and not isinstance(part, tuple):
            nodes = (case.node() for case in node.cases)
            owners = [one.table.owner for one in nodes if isinstance(one, Keys)]
            yield at, part, (tuple, *filter(None, owners))
            return
        node = found
    if isinstance(node, Many):
        if not isinstance(part, tuple):
            yield from wanted(node.item, part, at)
        for number, one in enumerate(part if isinstance(part, tuple) else ()):
            yield from wanted(node.item, one, f"{at}[{number}]")
    elif isinstance(node, Keys):
        yield at, part, (node.table.owner,) if node.table.owner else ()
    else:
        yield from _wanted_of_choice(node, part, at)


def _wanted_of_choice(node: Choice, part: Any, at: str) -> Iterator[Wanted]:
    inner = part
    if node.own and node.own.owner:
        yield at, part, (node.own.owner,)
        if not isinstance(part, node.own.owner):
            return
        inner, at = getattr(part, node.into), f"{at}.{node.into}"
    word = node.word_of(inner)
    if not word:  # all classes are imported only then
        yield at, inner, node.classes
    elif isinstance(below := node.node(word), Choice):
        yield from wanted(below, inner, at)


def choices_in(node: Node) -> Iterator[Choice]:
    """Yield the choices in a node, without loading what a registry chooses from."""
    if isinstance(node, Either):
        yield from choices_in(node.cases[0].node())
    elif isinstance(node, Many):
        yield from choices_in(node.item)
    elif isinstance(node, Choice):
        yield node
        yield from dict.fromkeys(one for below in node.below.values() for one in choices_in(below))


def homes_of(node: Node, title: str) -> dict[str, str]:
    """Return hints that say where keys belong, by key.

    Parameters
    ----------
    node : Node
        What may stand under a title.
    title : str
        The title.
    """
    if isinstance(node, Either):
        nodes = [case.node() for case in node.cases]
        found: dict[str, str] = {}
        for one in reversed(nodes):
            found |= homes_of(one, title)
        return found
    place = f"this key belongs under [{title}]"
    if isinstance(node, Keys):
        return dict.fromkeys(node.table.entries, place)
    if isinstance(node, Many):
        if isinstance(node.item, Keys):
            return homes_of(node.item, title)
        return {
            key: f"this key belongs under [[{title}]]{words}"
            for key, words in _words(node.item).items()
        }
    return {key: f"{place}{words}" for key, words in _words(node).items()}


def _words(node: Choice) -> dict[str, str]:
    """Return by key with which words a table has it: those nearest to the root."""
    words: dict[str, list[str]] = {}
    deeper: dict[str, str] = {}
    for word in node.entries:
        below = node.node(word)
        if isinstance(below, Choice):
            deeper |= _words(below)
            keys = [below.tag, *(below.own.entries if below.own else ())]
        else:
            keys = [*below.table.entries]
        for key in keys:
            words.setdefault(key, []).append(word)
    by = " of type" if node.tag == "type" else f" with {node.tag} ="
    found = {key: f"{by} {quoted(names)}" for key, names in words.items()}
    own = (node.tag, *(node.own.entries if node.own else ()))
    return deeper | found | dict.fromkeys(own, "")
