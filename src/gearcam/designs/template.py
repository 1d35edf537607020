"""A design file to start from: every key with its meaning, what may be left out as a comment."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from typing import Any, Final

from gearcam.designs.examine import name_fault
from gearcam.designs.faults import description, show
from gearcam.designs.kind import KINDS, DesignKind
from gearcam.designs.table import Key, Table
from gearcam.quantities import REQUIRED

_COLUMN: Final = 36
_WIDTH: Final = 96

_EXAMPLES: Final = {
    "module_mm": 2.5,
    "chord_tolerance_mm": 0.001,
    "teeth": [1, 27],
    "center_distance_mm": 120.1,
    "density_kg_m3": 7850,
    "addendum": 1,
    "dedendum": 1.25,
    "tip_radius": 0.38,
    "rim_mm": 10,
    "outer_diameter_mm": 130,
    "cutter_teeth": 30,
    "web_mm": 6,
    "angle_deg": 60,
    "lift_mm": 10,
    "lift_deg": 20,
    "to_mm": 4,
    "to_deg": 8,
    "dome_radius_mm": 60,
    "arm_mm": 90,
    "pivot_distance_mm": 100,
    "base_radius_mm": 32,
    "tool_radius_mm": 8,
}
"""Values for comments where a key has no default."""


def template(kind: str, name: str = "", process: str = "") -> str:
    """Return the text of a commented design file that builds as it is.

    Parameters
    ----------
    kind : str
        The kind of design.
    name : str
        The design's name; ``my_`` and its kind where this cannot name one.
    process : str
        How the parts will be made, one of the kind's; the example as it is where left out.

    Returns
    -------
    str
        TOML.
    """
    name = "my_" + kind.replace("-", "_") if name_fault(name) else name
    return "\n".join(_lines(KINDS[kind], name, process)) + "\n"


def _lines(kind: DesignKind, name: str, process: str) -> Iterator[str]:
    more = kind.processes[process] if process else {}
    yield f"# {kind.doc[0].upper()}{kind.doc[1:]}. Build it with: gearcam build FILE"
    yield "# Lengths are in mm and angles in degrees, as the keys say. What stands behind # is a"
    yield "# comment: keys shown so may be left out; their defaults are given."
    yield f'kind = "{kind.name}"'
    yield key_line("name", name, "names the folder of the files")
    yield ""
    if kind.main:
        yield from kind.room("describe").lines()
    for title in (*kind.tables, "limits"):
        given = {**kind.example.get(title, {}), **more.get(title, {})}
        yield from _table(title, kind.table(title), given, kind.notes.get(title, ""))


def _table(title: str, known: Table, given: Mapping[str, Any], note: str) -> Iterator[str]:
    if known.entries:
        yield ""
        head = f"[{title}]"
        yield (beside(head, note) if note else head) if given else f"# {head}"
        yield from entry_lines(known, given)


def entry_lines(known: Table, given: Mapping[str, Any]) -> Iterator[str]:
    """Yield a line for each key of a `known` table: those `given`, and the others as comments."""
    for key, entry in known.entries.items():
        if key in given:
            yield key_line(key, given[key], description(entry))
        elif known.title == "limits" and entry.default is None:  # the design decides
            yield "# " + beside(key, description(entry), _COLUMN - 2)
        else:
            yield key_line(key, _example(entry), description(entry), "# ")


def _example(entry: Key) -> Any:
    if entry.default in (None, REQUIRED):
        made = entry.param
        usual = made.choices[0] if made.choices else made.ge or made.gt or 1
        return _EXAMPLES.get(entry.key, usual)
    return entry.outward(entry.default)


def law_comment(key: str, name: str, entry: Any, known: Table) -> Iterator[str]:
    """Yield comments on a law, by its first example: its `key`, `name`, `entry`, `known` table."""
    given = known.document(entry.example)
    yield "#"
    yield key_line(key, name, entry.doc, "# ")
    for key, item in known.entries.items():
        if key in given:
            yield key_line(key, given[key], description(item), "# ")
        else:
            yield f"#   or {key}: {item.param.doc}"


def key_line(key: str, value: Any, words: str, mark: str = "") -> str:
    """Return ``key = value`` with `words` beside it, in a comment where a `mark` stands before."""
    return mark + beside(f"{key} = {show(_short(value))}", words, _COLUMN - len(mark))


def _short(value: Any) -> Any:
    """Write 20.0 as 20, and six digits where there are more."""
    if isinstance(value, list):
        return [_short(item) for item in value]
    if isinstance(value, float):
        return int(value) if value.is_integer() else float(f"{value:.6g}")
    return value


def beside(text: str, words: str, column: int = _COLUMN) -> str:
    """Return a line of `text` with `words` beside it from a `column` on, continued below it."""
    first, *more = textwrap.wrap(words, _WIDTH - _COLUMN) or [""]
    # behind a leading "# " the continuation needs its own
    start = "" if column == _COLUMN else "# "
    rest = [f"{start}{'':<{column - 1}} #   {line}" for line in more]
    return "\n".join([f"{text:<{column - 1}} # {first}", *rest])
