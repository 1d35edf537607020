"""The JSON schema of design files, for editors that complete and check TOML while it is typed.

It is assembled from the same models that read the files, so that both agree on keys, types and
ranges. What a schema cannot say (knots must rise, formulas must parse) the reader says.
"""

from __future__ import annotations

from typing import Any, Final

from gearcam.design.models import description, model_of
from gearcam.design.tables import KIND, TABLES, Table, law_table, table
from gearcam.laws.base import LAWS

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"

_NAME_PATTERN: Final = r"^[A-Za-z0-9_\u00aa-\uffff]([A-Za-z0-9_.\-\u00aa-\uffff]*[^.])?$"
"""What an editor can check of a name; the reader knows letters of all scripts from other signs."""


def schema() -> dict[str, Any]:
    """Return the schema of gear-pair design files.

    Returns
    -------
    dict
        JSON schema, draft 2020-12, with one branch per law.
    """
    titles = [*TABLES, "limits"]
    return {
        "$schema": DIALECT,
        "title": "gearcam design file",
        "type": "object",
        "additionalProperties": False,
        "required": ["kind", "law", "pair"],
        "properties": {
            "kind": {"const": KIND, "description": "the kind of design"},
            "name": {
                "type": "string",
                "pattern": _NAME_PATTERN,
                "maxLength": 100,
                "description": "names the folder of the files; the file's own name if left out",
            },
            "law": _law_schema(),
        }
        | {title: {"$ref": f"#/$defs/{title}"} for title in titles},
        "$defs": {title: _titled(title) for title in titles}
        | {f"law-{name}": _law_branch(name) for name in LAWS},
    }


def _law_schema() -> dict[str, Any]:
    words = "; ".join(f"{name}: {entry.doc}" for name, entry in LAWS.items())
    return {
        "type": "object",
        "description": f"the ratio of the pair. {words}",
        "required": ["type"],
        "properties": {"type": {"enum": list(LAWS), "description": "the law"}},
        "allOf": [
            {
                "if": {"properties": {"type": {"const": name}}, "required": ["type"]},
                "then": {"$ref": f"#/$defs/law-{name}"},
            }
            for name in LAWS
        ],
    }


def _law_branch(name: str) -> dict[str, Any]:
    made = _table_schema(law_table(name))
    made["description"] = f"{LAWS[name].doc} (continuity: {LAWS[name].continuity})"
    made["properties"] = {"type": {"const": name}} | made["properties"]
    made["required"] = ["type", *made.get("required", [])]
    return made


def _titled(title: str) -> dict[str, Any]:
    made = _table_schema(table(title))
    if title == "pair":
        made["oneOf"] = [{"required": ["center_distance_mm"]}, {"required": ["module_mm"]}]
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
