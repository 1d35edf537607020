"""From what is written under a title to the part of a design: one walk for values and faults."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any, NamedTuple

from gearcam.base.quantities import OPPOSITES
from gearcam.designs.faults import MISSING, Fault, quoted, show
from gearcam.designs.lines import Path
from gearcam.designs.nodes import (
    Choice,
    Circumstances,
    Either,
    Keys,
    Level,
    Many,
    Node,
    joined,
    levels_of,
)
from gearcam.designs.slips import keyed, misspelt, nearest
from gearcam.designs.table import Table
from gearcam.designs.validate import faults_of, parameters_of, placed_faults


class Made(NamedTuple):
    """What is made of a table, None if its values cannot be read, and whether all are right."""

    part: Any
    clean: bool


@dataclass(frozen=True, kw_only=True)
class Reading:
    """What the reading of a part needs to know of its document.

    Parameters
    ----------
    document : mapping
        As read from TOML.
    given : mapping of str to str
        Its circumstances.
    words : callable
        ``words()`` returns the words that its keys may have, by dotted key.
    home : callable
        ``home(key, value)`` returns a hint that says where a misplaced key, or its value, belongs.
    far : callable
        ``far(key)`` returns the same for other kinds of design.
    filled : callable
        ``filled(table, raw, at)`` returns a table with its nested designs in place of files and
        tables and without keys of other variants, and what is wrong with these.
    faults : list of Fault
        Gets the mistakes.
    """

    document: Mapping[str, Any]
    given: Circumstances
    words: Callable[[], Mapping[str, Any]]
    home: Callable[[str, Any], str]
    far: Callable[[str], str]
    filled: Callable[[Table, Any, Path], tuple[Any, list[Fault]]]
    faults: list[Fault]

    def read(self, node: Node, raw: Any, at: Path) -> Made:
        """Return what is made of what is written.

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
            if (fault := node.refused(raw, self.given, self.home)) is not None:
                self.faults.append(fault)
                return Made(None, False)
            node = node.meant(raw)
        return self._many(node, raw, at) if isinstance(node, Many) else self._table(node, raw, at)

    def _many(self, node: Many, raw: Any, at: Path) -> Made:
        if not isinstance(raw, list):
            title = at[-1]
            hint = self.home("", raw) or f"write it in double brackets, once for each: [[{title}]]"
            self.faults.append(Fault(at, f"{show(raw)} is not a list of tables", raw, "", hint))
            return Made(None, False)
        made = [self.read(node.item, one, (*at, number)) for number, one in enumerate(raw)]
        parts, before = [one.part for one in made], len(self.faults)
        for number, name, message, rule in node.among(parts, self.given, self.document):
            if number is None:
                self.faults.append(Fault(at, message, allowed=rule))
            elif parts[number] is not None:
                self._among(node.item, (name, message, rule), raw[number], (*at, number))
        clean = all(one.clean for one in made) and len(self.faults) == before
        return Made(tuple(parts) if clean else None, clean)

    def _among(self, item: Keys | Choice, wrong: tuple[str, str, str], raw: Any, at: Path) -> None:
        """Add what is wrong with one of several tables: field, message, what is allowed."""
        name, message, rule = wrong
        known = joined([*levels_of(item, raw)], str(at[0])).bound(self.given)
        meant = misspelt(raw, known.entries)  # the unknown key is reported instead
        faults = placed_faults([(name, None, message, rule)], known, raw, at)
        self.faults.extend(one for one in faults if one.path[len(at)] not in meant)

    def _table(self, node: Keys | Choice, raw: Any, at: Path) -> Made:
        if isinstance(node, Choice) and not isinstance(raw, Mapping):
            self.faults.append(self._no_table(node, raw, at))
            return Made(None, False)
        chosen = self._chosen(node, raw, at) if isinstance(node, Choice) else None
        meant, tags, sure = chosen or (raw, [], True)
        levels = [*levels_of(node, meant if isinstance(meant, Mapping) else {})]
        if not levels:
            return Made(None, False)
        known = joined(levels, str(at[0]))
        content = {key: one for key, one in meant.items() if key not in tags} if tags else meant
        if not sure:
            content = _without_asked(node, meant, content, known)
        content, faults = self.filled(known, content, at)
        wrong = [*_wrong_units(known, content, at, self.given)]
        content = _without(content, wrong)
        bound = known.bound(self.given)
        replaced = {one.allowed for one in wrong}  # these are not missing besides
        faults += [
            one
            for one in faults_of(
                bound, content, home=self.home, far=self.far, at=at, listed=[*tags, *bound.entries]
            )
            if one.path[-1] not in replaced
        ]
        part, problems = None, list[Fault]()
        if isinstance(content, Mapping) and not wrong:
            part, problems = self._made(levels, content, faults, at)
            if not (faults or problems) and sure and isinstance(node, Keys):
                problems = [*placed_faults(node.also(part, self.given), bound, content, at)]
        if isinstance(node, Choice) and raw.get(node.tag) != meant.get(node.tag):
            part = None  # of what is only likely nothing follows
        every = [*faults, *problems, *wrong]
        # what is missing is reported once the words are known
        self.faults.extend(one for one in every if sure or one.path[len(at)] in raw)
        return Made(part, part is not None and sure and not faults and not wrong)

    def _no_table(self, node: Choice, raw: Any, at: Path) -> Fault:
        rule = f"{node.tag} = {quoted(node.entries)}"
        where = "a table with" if len(at) > 1 else f"a table [{node.title}] with"
        return Fault(at, f"{show(raw)} is not a table", raw, f"{where} {rule}", self.home("", raw))

    def _chosen(
        self, node: Keys | Choice, raw: Mapping[str, Any], at: Path
    ) -> tuple[dict[str, Any], list[str], bool]:
        """Return a table with its words as they are meant, their keys, whether all are right."""
        meant, tags, sure = dict(raw), list[str](), True
        while isinstance(node, Choice):
            tags.append(node.tag)
            word = meant.get(node.tag)
            if word is None and (slip := _slip(node, raw)):
                word = meant[node.tag] = meant.pop(slip)
                self.faults.append(_misspelt(node, raw, slip, at))
            if not isinstance(word, str) or word not in node.entries:
                near = nearest(word, node.entries) if isinstance(word, str) else ""
                self.faults.append(self._no_word(node, raw, near, at))
                meant.pop(node.tag, None)
                sure = False
                if not near:
                    break
                meant[node.tag] = word = near
            node = node.node(word)
        return meant, tags, sure

    def _no_word(self, node: Choice, raw: Mapping[str, Any], near: str, at: Path) -> Fault:
        """Return the fault of a word that is no entry; `near` is the one that may be meant."""
        word = raw.get(node.tag, MISSING)
        message = "is missing" if word is MISSING else f"{show(word)} is not {node.what}"
        words = near or keyed(word, self.words())
        hint = f"did you mean {words}?" if words else ""
        if not words and len(raw) > 1:
            hint = f"the other keys of this table are checked once its {node.tag} is known"
        return Fault((*at, node.tag), message, word, quoted(node.entries), hint)

    def _made(
        self, levels: Sequence[Level], raw: Mapping[str, Any], faults: list[Fault], at: Path
    ) -> tuple[Any, list[Fault]]:
        """Return what the classes of a table make, from the innermost outwards, and its faults."""
        known = {key for level in levels for key in level.table.entries}
        part, problems = None, list[Fault]()
        for level in reversed(levels):
            make: Any = level.table.owner or dict
            make = partial(make, **{level.into: part}) if level.into else make
            own = level.table.entries.keys() | (raw.keys() - known)
            written = {key: value for key, value in raw.items() if key in own}
            table = level.table.bound(self.given)
            part, more = parameters_of(table, make, written, faults, at)
            problems += more
        return part, problems


@lru_cache(maxsize=512)
def of_nothing(table: Table, given: tuple[tuple[str, str], ...]) -> Any:
    """Return what a table makes that is left out.

    Parameters
    ----------
    table : Table
        The table.
    given : tuple of (str, str)
        The circumstances.

    Returns
    -------
    object
        The part of the design; None if the table must not be left out.
    """
    reading = Reading(
        document={},
        given=dict(given),
        words=dict[str, Any],
        home=lambda *_: "",
        far=lambda _: "",
        filled=lambda _, raw, __: (raw, []),
        faults=[],
    )
    made = reading.read(Keys(table=table), {}, (table.title,))
    return made.part if made.clean else None


def _slip(node: Choice, raw: Mapping[str, Any]) -> str:
    """Return the key that is a misspelt tag, as its value is a word of it; empty if none is."""
    words = (key for key, one in raw.items() if isinstance(one, str) and one in node.entries)
    return next((key for key in words if nearest(key, [node.tag])), "")


def _misspelt(node: Choice, raw: Mapping[str, Any], key: str, at: Path) -> Fault:
    message = f"unknown key (its value is {show(raw[key])})"
    return Fault((*at, key), message, raw[key], node.tag, f"did you mean {node.tag}?")


def _without_asked(
    node: Keys | Choice, raw: Mapping[str, Any], content: Mapping[str, Any], known: Table
) -> dict[str, Any]:
    """Return a table without keys that it may have once a word in it is known."""
    while isinstance(node, Choice) and raw.get(node.tag) in node.entries:
        node = node.node(raw[node.tag])
    if isinstance(node, Keys):
        return dict(content)
    asked = {
        key
        for word in node.entries
        for level in levels_of(node.node(word), {})
        for key in level.table.entries
    }
    return {key: one for key, one in content.items() if key in known.entries or key not in asked}


def _wrong_units(known: Table, raw: Any, at: Path, given: Circumstances) -> Iterator[Fault]:
    """Yield the faults of keys for other circumstances, each with the right key."""
    if not known.varies or not isinstance(raw, Mapping):
        return
    right = {entry.name: key for key, entry in known.bound(given).entries.items()}
    for key, entry in known.entries.items():
        against = [OPPOSITES[one] for one in entry.param.when if OPPOSITES[one] in given]
        if key in raw and against:
            rule = right.get(entry.name, "leave it out")
            yield Fault((*at, key), f"{show(raw[key])}: {given[against[0]]}", raw[key], rule)


def _without(raw: Any, faults: Sequence[Fault]) -> Any:
    wrong = {one.path[-1] for one in faults}
    return {key: one for key, one in raw.items() if key not in wrong} if wrong else raw
