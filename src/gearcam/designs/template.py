"""A design file to start from: every key with its meaning, optional ones as comments."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any, Final, NamedTuple

from gearcam.base.errors import Problem
from gearcam.base.inches import INCH, UNITS, each, key_in, text_in
from gearcam.base.quantities import REQUIRED
from gearcam.designs.examine import name_fault
from gearcam.designs.faults import description, short, show
from gearcam.designs.kind import KINDS, DesignKind, kind_meant, named_variant
from gearcam.designs.nodes import Choice, Either, Keys, Many, Node, joined, levels_of
from gearcam.designs.slips import nearest
from gearcam.designs.table import Key, Table, table_of

_COLUMN: Final = 36
_WIDTH: Final = 96

_ROUND: Final = 25.0
"""Length, mm, that a template in inches takes for one inch: so lengths stay round."""

_OF_PITCH: Final = (
    "diametral pitch, pi*z/L with the length L of a pitch curve; a number from 0.0254 to 25400 1/in"
)

_HEADER: Final = """\
# {doc}. Build it with: gearcam build FILE
# Lengths are in mm, angles in degrees.
# Keys and tables behind a # are optional: remove the # to use one. Each shows its default, unless
# its comment begins with (example): then there is no fixed default, the value is an example."""


_MARKS: Final = ("rotation_arrow", "zero_mark")
"""What a part is marked with when it is known how it is made."""


class KeyLine(NamedTuple):
    """A key with its value, or the head of a table, and what is said beside it.

    Parameters
    ----------
    key : str
        The key, or the head.
    value : object
        The value; None of a head.
    words : str
        The comment; empty for none.
    mark : str
        ``# `` if all of it is a comment.
    """

    key: str
    value: Any
    words: str
    mark: str = ""

    def __str__(self) -> str:
        column = _COLUMN - len(self.mark)
        value = "" if self.value is None else f" = {show(short(self.value))}"
        text = f"{self.mark}{self.key}{value}"
        if not self.words:
            return text
        first, *more = textwrap.wrap(self.words, _WIDTH - _COLUMN)
        # behind a leading "# " the continuation needs its own
        rest = [f"{self.mark}{'':<{column - 1}} #   {line}" for line in more]
        return "\n".join([f"{text:<{_COLUMN - 1}} # {first}", *rest])


Lines = Iterator[KeyLine | str]


def template(kind: str, name: str = "", process: str = "", units: str = UNITS[0]) -> str:
    """Return the text of a commented design file that builds as it is.

    Parameters
    ----------
    kind : str
        The kind of design.
    name : str
        The design's name; ``my_`` and its kind if no folder can have this name.
    process : str
        How the parts will be made, one of the kind's processes; empty for the plain example.
    units : {"mm", "inch"}
        Those of the file.

    Returns
    -------
    str
        TOML.
    """
    name = "my_" + kind.replace("-", "_") if name_fault(name) else name
    lines = _lines(KINDS[kind], name, process, units)
    return "\n".join(str(one if units == "mm" else _in_inches(one)) for one in lines) + "\n"


def _in_inches(line: KeyLine | str) -> KeyLine | str:
    """Return a line in inches.

    A length that is given, or is an example, becomes a round one that is 1.6 % longer, so that all
    of them fit together as before; the pitch is a whole number. A default keeps its value.
    """
    if isinstance(line, str):
        return text_in(line)
    key, value, words = key_in(line.key), line.value, line.words
    if key == "diametral_pitch":
        words, value = "(example) " * words.startswith("(") + _OF_PITCH, round(_ROUND / value)
    elif key != line.key:
        rough = not line.mark or words.startswith("(example)")
        value = each(value, lambda one: one / (_ROUND if rough else INCH))
    elif isinstance(value, str):
        value = text_in(value)  # it may name a fact
    return line._replace(key=key, value=value, words=text_in(words))


def template_hint(word: str) -> str:
    """Return the hint for a `word` that is no kind: which template shows what it names."""
    found, named = kind_meant(word), named_variant(word)
    if found is None:
        return ""
    kind, values = found
    variants, value = kind.variants, named[1] if named else ""
    if variants and value:
        # some are kinds with templates of their own, and the default needs no word
        kind = kind.meant({variants.title: {variants.key: value}})
        values = "" if value in (variants.default, *variants.elsewhere) else values
    return f"did you mean {kind.name}{values and f', with {values} in the file'}?"


def process_problem(kind: str, process: str) -> Problem | None:
    """Return why there is no template of a `kind` for a `process`; None if there is one."""
    own = KINDS[kind].processes
    if process in own:
        return None
    every = list(dict.fromkeys(one for other in KINDS.values() for one in other.processes))
    near = nearest(process, own) or nearest(process, every)
    having = [name for name, other in KINDS.items() if near in other.processes]
    if not near:
        hint = ""
    elif near in own:
        hint = f"did you mean {near}?"
    else:
        hint = f"{near} is for {', '.join(having)}: gearcam new {having[0]} --for {near}"
    message = f"{show(process)} is not supported for {kind}"
    return Problem(message, key="--for", allowed=", ".join(own) or "leave it out", hint=hint)


def _lines(kind: DesignKind, name: str, process: str, units: str) -> Lines:
    more = _preset(kind, process) if process else {}
    yield _HEADER.format(doc=f"{kind.doc[0].upper()}{kind.doc[1:]}")
    yield f'kind = "{kind.name}"'
    if units != "mm":
        yield KeyLine("units", units, "of lengths: keys end in _in")
    yield KeyLine("name", name, "name of the output folder")
    for title in (*kind.tree, "limits"):
        note, given = kind.notes.get(title, ""), kind.example.get(title, {})
        if title in kind.nodes:
            yield from _node(kind.nodes[title], title, given, note)
            continue
        head = f"[[{title}]]" if title in kind.several else f"[{title}]"
        table = _shown(kind.table(title), kind.samples.get(title, {}))
        for one in given if isinstance(given, list) else [given]:
            yield from _table(head, table, {**one, **more.get(title, {})}, note)


def _preset(kind: DesignKind, process: str) -> Mapping[str, Mapping[str, Any]]:
    """Return the tables of a template for a `process`: those of the kind, and marks as it makes."""
    own = kind.processes[process]
    marks = [name for name in _MARKS if name in kind.table("blank").entries]
    return {
        **own,
        "blank": {**own.get("blank", {}), **dict.fromkeys(marks, True)},
        "output": {**own.get("output", {}), "process": process},
    }


def _node(node: Node, title: str, example: Any, note: str) -> Lines:
    """Yield the lines of a node: those of an `example`, then others as comments."""
    if isinstance(node, Either):
        first, *rest = (case.node() for case in node.cases)
        yield ""
        yield f"# {note}"
        yield from islice(_node(first, title, example, ""), 1, None)
        yield from ("", node.others, "#", f"# [{title}]")
        for one in rest:
            for key, entry in one.table.entries.items() if isinstance(one, Keys) else ():
                shown = isinstance(one, Keys) and key in one.examples
                yield comment_line(entry) if shown else f"#   or {key}: {entry.param.doc}"
    elif isinstance(node, Many):
        for one in example:
            yield from ("", f"[[{title}]]")
            yield from _chosen(node.item, one)
        yield from _others(node.item, example, f"[[{title}]]")
    else:
        yield from ("", KeyLine(f"[{title}]", None, note))
        yield from _chosen(node, example)
        yield from _others(node, [example], "")


def _chosen(node: Keys | Choice, given: Mapping[str, Any], mark: str = "") -> Lines:
    """Yield the lines of a table, as comments if `mark` is ``# ``; words without a value end it."""
    known = joined([*levels_of(node, given)], "")
    while isinstance(node, Choice) and node.tag in given:
        word = given[node.tag]
        yield KeyLine(node.tag, word, node.about(word), mark)
        node = node.node(word)
    yield from entry_lines(known, given)


def _others(node: Keys | Choice, examples: Sequence[Mapping[str, Any]], head: str) -> Lines:
    """Yield comments on what else could be chosen; a table that may stand again has a `head`."""
    if not isinstance(node, Choice):
        return
    used = {one.get(node.tag) for one in examples}
    if node.others:
        yield from ("", node.others)
        for word, entry in node.entries.items():
            if word not in used and hasattr(entry, "example"):
                known = table_of(node.title, node.class_of(word))
                yield from law_comment(node.tag, word, entry, known)
            elif word not in used:
                yield from ("#", f"# {head}")
                yield from _chosen(node, {node.tag: word}, "# ")
    for below in {one.others: one for one in node.below.values()}.values():
        yield from _others(below, examples, head)


def _shown(table: Table, examples: Mapping[str, Any]) -> Table:
    """Return a table with `examples` of some of its keys."""
    entries = {
        key: replace(entry, param=replace(entry.param, example=examples[key]))
        if key in examples
        else entry
        for key, entry in table.entries.items()
    }
    return Table(table.title, table.owner, entries)


def _table(head: str, table: Table, given: Mapping[str, Any], note: str) -> Lines:
    if table.entries:
        yield ""
        yield KeyLine(head, None, note) if given else f"# {head}"
        designs = {key: one for key, one in given.items() if isinstance(one, Mapping)}
        rest = {key: entry for key, entry in table.entries.items() if key not in designs}
        yield from entry_lines(Table(table.title, table.owner, rest), given)
        for key, design in designs.items():
            yield from _nested(f"{head.strip('[]')}.{key}", design, description(table.entries[key]))


def _nested(path: str, design: Mapping[str, Any], words: str = "") -> Lines:
    """Yield the lines of a nested design, without comments on its keys."""
    plain = {key: one for key, one in design.items() if not _is_table(one)}
    if plain or words:
        yield ""
        yield KeyLine(f"[{path}]", None, words)
        yield from (KeyLine(key, one, "") for key, one in plain.items())
    for key, one in design.items():
        if isinstance(one, Mapping):
            yield from _nested(f"{path}.{key}", one)
        elif _is_table(one):
            for item in one:
                yield from ("", f"[[{path}.{key}]]")
                yield from (KeyLine(name, value, "") for name, value in item.items())


def _is_table(value: Any) -> bool:
    tables = value if isinstance(value, list) else [value]
    return bool(tables) and all(isinstance(one, Mapping) for one in tables)


def entry_lines(table: Table, given: Mapping[str, Any]) -> Lines:
    """Yield a line for each key of a `table`: those `given`, and the others as comments."""
    for key, entry in table.entries.items():
        if key in given:
            yield KeyLine(key, given[key], description(entry))
        else:
            yield comment_line(entry)


def comment_line(entry: Key) -> KeyLine:
    """Return the line of an optional key: with its default, or with an example."""
    if entry.default in (None, REQUIRED):
        words = f"(example) {description(entry)}"
        return KeyLine(entry.key, entry.param.example, words, "# ")
    value = entry.outward(entry.default)
    if entry.param.both and len(set(value)) == 1:
        value = value[0]
    return KeyLine(entry.key, value, description(entry), "# ")


def law_comment(key: str, name: str, entry: Any, table: Table) -> Lines:
    """Yield comments on a law, with the values of an example: `key`, `name`, `entry`, `table`."""
    given = table.document(entry.example)
    yield "#"
    yield KeyLine(key, name, entry.doc, "# ")
    for key, item in table.entries.items():
        if key in given:
            yield KeyLine(key, given[key], description(item), "# ")
        else:
            yield f"#   or {key}: {item.param.doc}"
