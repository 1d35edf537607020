"""Parts of the pages of docs/reference: fixed words, tables, keys of design files."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Final

from gearcam.base.quantities import REQUIRED
from gearcam.designs.faults import allowed, show
from gearcam.designs.table import Key, Table
from gearcam.designs.template import short

NONE: Final = "-"
"""Text of an empty cell."""

KEY_HEADS: Final = ("key", "value", "default", "meaning")
"""Headings of the columns of keys."""

TITLES: Final = {
    "gear-pair": "Gear pairs",
    "cam": "Cams",
    "spatial-cam": "Cams in space",
    "globoidal-cam": "Globoidal indexing cams",
    "mechanism": "Mechanisms",
}
GROUPS: Final = {
    "teeth": "Law, centrodes and teeth",
    "meshing": "Meshing study (`gearcam mesh`)",
    "errors": "Errors of mounting and making (`gearcam errors`)",
    "random assemblies of a pair": "Random assemblies (`gearcam errors`)",
    "forces of a pair": "Forces (`gearcam forces`)",
    "stress of a pair": "Stress (`gearcam stress`)",
    "dynamics of a machine": "Motion under a motor (`gearcam dynamics`)",
    "vibration of teeth": "Elastic teeth in motion (`gearcam dynamics`)",
    "forces of a pair in motion": "Forces of teeth in motion (`gearcam dynamics`)",
    "parts": "Parts",
    "cams": "Motion and profile",
    "cams in space": "Walls",
    "mechanisms": "Motion",
    "tables of mechanisms": "What is asked for, loads, and chains",
    "torque of a mechanism": "Torque (`gearcam torque`)",
    "forces of a mechanism": "Forces in joints (`gearcam forces`)",
    "precision of a mechanism": "Precision of mechanisms (`gearcam precision`)",
    "globoidal cams": "Walls and hold",
    "rows of tables": "Tables of laws and motions",
    "solids of globoidal cams": "Solids",
    "solids of cams in space": "Solids",
    "forces": "Forces (`gearcam forces`)",
    "followers in motion": "Dynamics (`gearcam dynamics`)",
    "followed profiles": "Followed profile (`gearcam follow`)",
    "precision of cams": "Precision (`gearcam precision`)",
    "fitted lifts": "Fitted lift (`gearcam follow --fit`)",
}
"""Headings of groups of checks, by what they examine."""

KEYS_INTRO: Final = """\
A design file is TOML in UTF-8. Unknown keys, values of the wrong type and values out of range are
refused. A number may be written as 2 or 2.0. A dash under "default" means that there is no fixed
default: the meaning says what holds without the key, or the key is optional, or another key takes
its place.
"""

COMMANDS_INTRO: Final = """\
Files are written to `DIR/NAME/`, where `DIR` is `output` or the folder given with `--output`, and
`NAME` is the name of the design. Most commands accept several design files. See
[exit-codes.md](exit-codes.md) for the exit codes.
"""

STUDIES_INTRO: Final = """\
A *study* is a further computation on a result. It runs by its command (`gearcam errors FILE`), as
part of a build (`studies = ["errors"]` in `[output]`), and from Python: `result.study("errors")`.
Its outcome has `columns`, the rows of its CSV file as arrays; `tables`, further ones; `facts`,
which are in `summary.json` too; `findings`; `charts`; and `write(directory)`. `help(result.study)`
says the same of the studies of a result. Other settings make another design:
`result.design.with_({"errors.trials": 500})`."""

CODES_OUTRO: Final = """\
Given several files, a command works on all of them and returns the largest code. However a
command ends, the files of a design are either all old or all new.
"""

CHECKS_INTRO: Final = """\
A check examines a design that has been built. A note is good to know; a warning means that you
should look before you cut; an error means that you should not cut. The table `[limits]` of a design
sets limits. Designs that cannot be made at all are refused instead.
"""

FILES_INTRO: Final = """\
`files` in the table `[output]` lists the files to write in addition to `summary.json`.
`gearcam build --only A,B` writes other files once. Which file to send to whom, and what each one
contains, is explained in [files.md](../files.md).
"""


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(map(_cell, line))} |" for line in lines)


def _cell(text: str) -> str:
    return plain(" ".join(text.split())).replace("|", "\\|")


def plain(text: str) -> str:
    """Return text with stars escaped outside code, where Markdown would interpret them."""
    parts = text.split("`")
    return "`".join(
        part.replace("*", "\\*") if k % 2 == 0 else part for k, part in enumerate(parts)
    )


def sentence(doc: str) -> str:
    """Return words as a sentence; a symbol at the beginning is not capitalised."""
    first = doc[0].upper() if doc.partition(" ")[0].isalpha() else doc[0]
    return f"{first}{plain(doc[1:])}."


def code(word: object) -> str:
    """Return a word as code."""
    return f"`{word}`"


def listed(words: Iterable[object]) -> str:
    """Return words separated by commas, or a dash."""
    return ", ".join(map(code, words)) or NONE


def default(entry: Key) -> str:
    """Return the default of a key as in a file."""
    if entry.default is REQUIRED:
        return "required" if entry.required else "one of the two"
    if entry.default is None:
        return NONE
    value = short(entry.outward(entry.default))
    if entry.param.both and len(set(value)) == 1:
        value = value[0]
    return code(show(value))


def key_rows(entries: Mapping[str, Key]) -> Iterator[tuple[str, ...]]:
    """Yield the row of each key."""
    for key, entry in entries.items():
        yield code(key), allowed(entry).removeprefix("a "), default(entry), entry.param.doc


def keys_of(known: Table) -> str:
    """Return the table of keys, or the text that there are none."""
    return table(KEY_HEADS, key_rows(known.entries)) if known.entries else "It has no keys."


def toml(title: str, values: Mapping[str, Any]) -> str:
    """Return an example of a table of a design file."""
    lines = [f"{key} = {json.dumps(short(value))}" for key, value in values.items()]
    return "\n".join(["```toml", title, *lines, "```"])
