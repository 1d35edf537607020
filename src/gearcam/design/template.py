"""A design file to start from: every key with its meaning, what may be left out as a comment."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

from gearcam.design.examine import name_fault
from gearcam.design.gear_pair import law_table
from gearcam.design.kinds import KINDS, Kind
from gearcam.design.models import description
from gearcam.design.motion import phase_table, rise_table, summary
from gearcam.design.tables import Entry, Table
from gearcam.design.wording import show
from gearcam.laws.phases_of_lift import PHASES
from gearcam.laws.ratio.base import LAWS
from gearcam.laws.rises.base import RISES

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


def template(kind: str, name: str = "") -> str:
    """Return the text of a commented design file that builds as it is.

    Parameters
    ----------
    kind : str
        The kind of design.
    name : str
        The design's name; ``my_`` and its kind where this cannot name one.

    Returns
    -------
    str
        TOML.
    """
    name = "my_" + kind.replace("-", "_") if name_fault(name) else name
    return "\n".join(_lines(KINDS[kind], name)) + "\n"


def _lines(kind: Kind, name: str) -> Iterator[str]:
    yield f"# {kind.doc[0].upper()}{kind.doc[1:]}. Build it with: gearcam build FILE"
    yield "# Lengths are in mm and angles in degrees, as the keys say. What stands behind # is a"
    yield "# comment: keys shown so may be left out; their defaults are given."
    yield f'kind = "{kind.name}"'
    yield _line("name", name, "names the folder of the files")
    yield ""
    yield from _MAIN[kind.main](kind)
    for title in (*kind.tables, "limits"):
        given = kind.example.get(title, {})
        yield from _table(title, kind.table(title), given, kind.notes.get(title, ""))


def _law_lines(kind: Kind) -> Iterator[str]:
    example = kind.example["law"]
    yield _beside("[law]", kind.notes["law"])
    yield _line("type", example["type"], LAWS[example["type"]].doc)
    yield from _entries(law_table(example["type"]), example)
    yield ""
    yield "# Other laws, to stand in place of the table above:"
    for name, entry in LAWS.items():
        if name != example["type"]:
            yield from _law_comment("type", name, entry, law_table(name))


def _motion_lines(kind: Kind) -> Iterator[str]:
    example = kind.example["motion"]
    yield f"# {kind.notes['motion']}"
    for phase in example:
        yield from _phase(phase)
        yield ""
    yield "# Other phases, to stand among those above:"
    for name in PHASES:
        if name not in (phase["type"] for phase in example):
            yield "#"
            yield from _phase({"type": name}, "# ")
    yield ""
    yield "# Other laws of rises and returns:"
    used = {phase["law"] for phase in example if "law" in phase}
    for name, entry in RISES.items():
        if name not in used:
            yield from _law_comment("law", name, entry, rise_table(name))


def _phase(given: Mapping[str, Any], mark: str = "") -> Iterator[str]:
    """Show a phase, or tell of one in comments where a mark stands before its lines."""
    law = given.get("law", "")
    column = _COLUMN - len(mark)
    yield f"{mark}[[motion]]"
    yield mark + _line("type", given["type"], summary(PHASES[given["type"]]), column)
    if law:
        yield mark + _line("law", law, RISES[law].doc, column)
    yield from _entries(phase_table(given["type"], law), given)


_MAIN: Final[Mapping[str, Callable[[Kind], Iterator[str]]]] = {
    "law": _law_lines,
    "motion": _motion_lines,
}


def _table(title: str, known: Table, given: Mapping[str, Any], note: str) -> Iterator[str]:
    if known.entries:
        yield ""
        head = f"[{title}]"
        yield (_beside(head, note) if note else head) if given else f"# {head}"
        yield from _entries(known, given)


def _entries(known: Table, given: Mapping[str, Any]) -> Iterator[str]:
    for key, entry in known.entries.items():
        if key in given:
            yield _line(key, given[key], description(entry))
        elif known.title == "limits" and entry.default is None:  # the design decides
            yield "# " + _beside(key, description(entry), _COLUMN - 2)
        else:
            yield "# " + _line(key, _example(entry), description(entry), _COLUMN - 2)


def _example(entry: Entry) -> Any:
    if entry.required or entry.default is None:
        made = entry.param
        usual = made.choices[0] if made.choices else made.ge or made.gt or 1
        return _EXAMPLES.get(entry.key, usual)
    return entry.outward(entry.default)


def _law_comment(key: str, name: str, entry: Any, known: Table) -> Iterator[str]:
    """Show a law of a registry by its example."""
    given = known.document(entry.example)
    yield "#"
    yield "# " + _line(key, name, entry.doc, _COLUMN - 2)
    for key, item in known.entries.items():
        if key in given:
            yield "# " + _line(key, given[key], description(item), _COLUMN - 2)
        else:
            yield f"#   or {key}: {item.param.doc}"


def _line(key: str, value: Any, words: str, column: int = _COLUMN) -> str:
    return _beside(f"{key} = {show(_short(value))}", words, column)


def _short(value: Any) -> Any:
    """Write 20.0 as 20, and six digits where there are more."""
    if isinstance(value, list):
        return [_short(item) for item in value]
    if isinstance(value, float):
        return int(value) if value.is_integer() else float(f"{value:.6g}")
    return value


def _beside(text: str, words: str, column: int = _COLUMN) -> str:
    """Write a comment beside a line, continued below itself where it is long."""
    first, *more = textwrap.wrap(words, _WIDTH - _COLUMN) or [""]
    # behind a leading "# " the continuation needs its own
    start = "" if column == _COLUMN else "# "
    rest = [f"{start}{'':<{column - 1}} #   {line}" for line in more]
    return "\n".join([f"{text:<{column - 1}} # {first}", *rest])
