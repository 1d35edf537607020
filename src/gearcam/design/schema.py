"""The JSON schema of design files, for editors that complete and check TOML while it is typed.

It is assembled from the same models that read the files, so that both agree on keys, types and
ranges. What a schema cannot say (knots must rise, formulas must parse) the reader says.
"""

from __future__ import annotations

from typing import Any, Final

from gearcam.design.gear_pair import law_table
from gearcam.design.kinds import KINDS, Kind
from gearcam.design.models import description, model_of
from gearcam.design.motion import LIFT, WITH_LAW, phase_table, summary, twins
from gearcam.design.tables import Table
from gearcam.laws.phases_of_lift import PHASES
from gearcam.laws.ratio.base import LAWS
from gearcam.laws.rises.base import RISES

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"

_NAME_PATTERN: Final = r"^[A-Za-z0-9_\u00aa-\uffff]([A-Za-z0-9_.\-\u00aa-\uffff]*[^.])?$"
"""What an editor can check of a name; the reader knows letters of all scripts from other signs."""


def schema() -> dict[str, Any]:
    """Return the schema of design files.

    Returns
    -------
    dict
        JSON schema, draft 2020-12, with one branch per kind of design, law and phase.
    """
    definitions: dict[str, Any] = {}
    for kind in KINDS.values():
        definitions[kind.name] = _branch(kind)
        for title in (*kind.tables, "limits"):
            definitions[f"{kind.name}-{title}"] = _titled(kind, title)
    definitions |= {f"law-{name}": _law_branch(name) for name in LAWS}
    for name in PHASES:
        laws = {f"{name}-{law}": law for law in RISES} if name in WITH_LAW else {name: ""}
        definitions |= {title: _phase_branch(name, law) for title, law in laws.items()}
    return {
        "$schema": DIALECT,
        "title": "gearcam design file",
        "type": "object",
        "required": ["kind"],
        "properties": {"kind": {"enum": list(KINDS), "description": "the kind of design"}},
        "allOf": [_when("kind", name, {"$ref": f"#/$defs/{name}"}) for name in KINDS],
        "$defs": definitions,
    }


def _when(key: str, value: str, then: dict[str, Any]) -> dict[str, Any]:
    """Return what holds where a key has a value."""
    return {"if": {"properties": {key: {"const": value}}, "required": [key]}, "then": then}


def _branch(kind: Kind) -> dict[str, Any]:
    return {
        "type": "object",
        "description": kind.doc,
        "additionalProperties": False,
        "required": ["kind", kind.main, *kind.required],
        "properties": {
            "kind": {"const": kind.name, "description": kind.doc},
            "name": {
                "type": "string",
                "pattern": _NAME_PATTERN,
                "maxLength": 100,
                "description": "names the folder of the files; the file's own name if left out",
            },
            kind.main: _MAIN[kind.main](),
        }
        | {title: {"$ref": f"#/$defs/{kind.name}-{title}"} for title in (*kind.tables, "limits")},
    }


def _law_schema() -> dict[str, Any]:
    words = "; ".join(f"{name}: {entry.doc}" for name, entry in LAWS.items())
    return {
        "type": "object",
        "description": f"the ratio of the pair. {words}",
        "required": ["type"],
        "properties": {"type": {"enum": list(LAWS), "description": "the law"}},
        "allOf": [_when("type", name, {"$ref": f"#/$defs/law-{name}"}) for name in LAWS],
    }


def _law_branch(name: str) -> dict[str, Any]:
    made = _table_schema(law_table(name))
    made["description"] = f"{LAWS[name].doc} (continuity: {LAWS[name].continuity})"
    made["properties"] = {"type": {"const": name}} | made["properties"]
    made["required"] = ["type", *made.get("required", [])]
    return made


def _motion_schema() -> dict[str, Any]:
    return {
        "type": "array",
        "minItems": 1,
        "description": "the lift over a turn of the cam, phase by phase",
        "items": {
            "type": "object",
            "required": ["type"],
            "properties": {"type": {"enum": list(PHASES), "description": "the phase"}},
            "allOf": [
                _when("type", name, _laws_of_phase(name))
                if name in WITH_LAW
                else _when("type", name, {"$ref": f"#/$defs/{name}"})
                for name in PHASES
            ],
        },
    }


def _laws_of_phase(name: str) -> dict[str, Any]:
    words = "; ".join(f"{law}: {entry.doc}" for law, entry in RISES.items())
    return {
        "required": ["law"],
        "properties": {"law": {"enum": list(RISES), "description": words}},
        "allOf": [_when("law", law, {"$ref": f"#/$defs/{name}-{law}"}) for law in RISES],
    }


def _phase_branch(name: str, law: str) -> dict[str, Any]:
    known = phase_table(name, law)
    made = _table_schema(known)
    made["description"] = summary(PHASES[name])
    words = {"type": name, "law": law} if law else {"type": name}
    made["properties"] = {key: {"const": word} for key, word in words.items()} | made["properties"]
    made["required"] = [*words, *made.get("required", [])]
    either = [
        {"oneOf": [{"required": [key]} for key in keys]}
        if word == LIFT.get(name)
        else {"not": {"required": list(keys)}}
        for word, keys in twins(known).items()
    ]
    return made | {"allOf": either} if either else made


_MAIN: Final = {"law": _law_schema, "motion": _motion_schema}


def _titled(kind: Kind, title: str) -> dict[str, Any]:
    made = _table_schema(kind.table(title))
    if title in kind.one_of:
        made["oneOf"] = [{"required": [key]} for key in kind.one_of[title]]
    if title == "output":
        made["properties"]["files"]["uniqueItems"] = True
    return made


def _table_schema(known: Table) -> dict[str, Any]:
    from pydantic.json_schema import GenerateJsonSchema

    made = GenerateJsonSchema().generate(model_of(known))
    properties = made.setdefault("properties", {})
    for key, entry in known.entries.items():
        rule = properties[key]
        rule.pop("title", None)
        rule["description"] = description(entry)
        if not entry.required and entry.default is not None:
            rule["default"] = entry.outward(entry.default)
        counts = {"minItems": entry.length or entry.param.min_length, "maxItems": entry.length}
        rule |= {name: count for name, count in counts.items() if count}
        if entry.param.both:
            words = {name: rule.pop(name) for name in ("description", "default") if name in rule}
            properties[key] = words | {"anyOf": [dict(rule["items"]), dict(rule)]}
    return made
