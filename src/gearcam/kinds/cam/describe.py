"""The motion of a cam for the JSON schema, the template and ``gearcam laws``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

from gearcam.designs.listing import Listed, listed
from gearcam.designs.schema import chosen, table_schema, with_meanings
from gearcam.designs.table import Table
from gearcam.designs.template import comment_line, entry_lines, key_line, law_comment
from gearcam.kinds.cam.motion import (
    LIFT,
    SPAN,
    WITH_LAW,
    phase_table,
    rise_table,
    summary,
    turn_tables,
)
from gearcam.laws.motion.base import MOTION_LAWS
from gearcam.laws.phases_of_lift import PHASES

_ROWS: Final = "motion-table"
_FORMULA: Final = "motion-formula"
"""Names of the definitions of motions of the whole turn."""

_SHOWN: Final = ("file", "smoothing_tolerance_mm")
"""Keys of tables that have a value in the template."""


def schema() -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the schema of the motion and its definitions."""
    words = with_meanings((name, entry.doc) for name, entry in MOTION_LAWS.items())
    phases = chosen("type", PHASES, "the phase", lambda name: name)
    made: dict[str, Any] = {}
    for name in PHASES:
        if name in WITH_LAW:
            made[name] = chosen("law", MOTION_LAWS, words, f"{name}-{{}}".format)
            made |= {f"{name}-{law}": _phase_schema(name, law) for law in MOTION_LAWS}
        else:
            made[name] = _phase_schema(name)
    made |= {
        _ROWS: _rows_schema(),
        _FORMULA: table_schema(turn_tables()[1], "the lift over the turn as a formula"),
    }
    main = {
        "description": "the lift over a turn of the cam, by phases, rows or a formula",
        "minItems": 1,
        "items": {"type": "object", **phases},
        "if": {"type": "array"},
        "else": {
            "if": {"required": ["lift"]},
            "then": {"$ref": f"#/$defs/{_FORMULA}"},
            "else": {"$ref": f"#/$defs/{_ROWS}"},
        },
    }
    return main, made


def _variants(known: Table) -> dict[str, list[str]]:
    """Return the keys of each field that has one of two units."""
    keys: dict[str, list[str]] = {}
    for key, entry in known.entries.items():
        if entry.param.when:
            keys.setdefault(entry.name, []).append(key)
    return keys


def _rows_schema() -> dict[str, Any]:
    known, _ = turn_tables()
    made = table_schema(known, "rows of cam angle and lift over the turn")
    inline = [{"required": ["theta_deg", key]} for key in _variants(known)["lift"]]
    return made | {"oneOf": [{"required": ["file"]}, *inline]}


def _phase_schema(name: str, law: str = "") -> dict[str, Any]:
    known = phase_table(name, law)
    words = {"type": name, "law": law} if law else {"type": name}
    made = table_schema(known, summary(PHASES[name]), **words)
    either = [
        {"oneOf": [{"required": [key]} for key in keys]}
        if word in (LIFT.get(name), SPAN)
        else {"not": {"required": keys}}
        for word, keys in _variants(known).items()
    ]
    return made | {"allOf": either} if either else made


def known(raw: Mapping[str, Any]) -> Table:
    """Return the table of the phase, or of the motion of the whole turn, in a file."""
    if "type" in raw:
        return phase_table(raw["type"], raw.get("law", ""))
    rows, formula = turn_tables()
    return formula if "lift" in raw else rows


def lines(example: Sequence[Mapping[str, Any]], note: str) -> Iterator[str]:
    """Yield lines of the template: a `note`, the phases of an `example`, others as comments."""
    yield f"# {note}"
    for phase in example:
        yield from _phase(phase)
        yield ""
    yield "# Other phases that can be used above:"
    for name in PHASES:
        if name not in (phase["type"] for phase in example):
            yield "#"
            yield from _phase({"type": name}, "# ")
    yield ""
    yield "# Instead of phases, the whole turn as rows of angle and lift, or as a formula:"
    yield "#"
    yield "# [motion]"
    for key, entry in (item for known in turn_tables() for item in known.entries.items()):
        if key in _SHOWN:
            yield comment_line(entry)
        else:
            yield f"#   or {key}: {entry.param.doc}"
    yield ""
    yield "# Other laws of rises and returns, with example values:"
    used = {phase["law"] for phase in example if "law" in phase}
    for name, entry in MOTION_LAWS.items():
        if name not in used:
            yield from law_comment("law", name, entry, rise_table(name))


def _phase(given: Mapping[str, Any], mark: str = "") -> Iterator[str]:
    """Yield the lines of a phase, as comments if `mark` is ``# ``."""
    law = given.get("law", "")
    yield f"{mark}[[motion]]"
    yield key_line("type", given["type"], summary(PHASES[given["type"]]), mark)
    if law:
        yield key_line("law", law, MOTION_LAWS[law].doc, mark)
    yield from entry_lines(phase_table(given["type"], law), given)


def laws() -> tuple[str, list[Listed]]:
    """Return a heading and the motion laws of cams."""
    found = [
        listed(entry, f'law = "{name}"', rise_table(name)) for name, entry in MOTION_LAWS.items()
    ]
    return "Motion laws of cams: rises and returns, in the tables [[motion]]", found
