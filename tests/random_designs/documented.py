"""Random values from the documented ranges of keys.

The ranges come from the schema of design files, so that they agree with the program.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any, Final

from gearcam.designs import schema as schemas
from random_designs.draw import Draw

_NARROWEST, _WIDEST = 1e-9, 1e6
"""For ranges without an end: the smallest value relative to the largest, and the largest."""

_AFFORDABLE: Final = {
    "teeth": (3, 300),
    "steps": (1, 100),
    "inspection_points": (2, 2000),
    "motion_step_deg": (0.05, 90.0),
    "chord_tolerance_mm": (1e-4, 1.0),
    "bolts": (0, 30),
}
"""Ranges to use instead of documented ones that would take minutes or gigabytes."""


@cache
def schema() -> schemas.Schema:
    """Return the schema of design files, cached."""
    return schemas.schema()


def known_keys(node: Mapping[str, Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keys that the schema allows in a table, with their schemas.

    Parameters
    ----------
    node : mapping
        The part of the schema for the table.
    given : mapping
        The table of a design; its values select the branches of the schema.
    """
    found: dict[str, Any] = {}
    if "$ref" in node:
        found |= known_keys(schema()["$defs"][node["$ref"].rpartition("/")[2]], given)
    found |= node.get("properties", {})
    for branch in node.get("allOf", ()):
        chosen = _chosen(branch, given)
        # others are rules between keys, which have no keys of their own
        if "$ref" in chosen:
            found |= known_keys(chosen, given)
    return {key: _resolved(one) for key, one in found.items()}


def _chosen(branch: Mapping[str, Any], given: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return what a branch of the schema leads to, for a table."""
    while "if" in branch:
        branch = branch.get("then" if _holds(branch["if"], given) else "else", {})
    return branch


def _holds(condition: Mapping[str, Any], given: Any) -> bool:
    """Return whether keys have the values that a condition names."""
    if not isinstance(given, Mapping):
        return False
    return all(
        given.get(key) == what["const"] if "const" in what else _holds(what, given.get(key))
        for key, what in condition.get("properties", {}).items()
    )


def _resolved(node: Mapping[str, Any]) -> Mapping[str, Any]:
    while "$ref" in node and len(node) == 1:
        node = schema()["$defs"][node["$ref"].rpartition("/")[2]]
    return node


def places(document: Mapping[str, Any]) -> Iterator[tuple[dict[str, Any], str, Mapping[str, Any]]]:
    """Yield every key allowed in the tables of a design: the table, the key, its schema.

    Parameters
    ----------
    document : mapping
        A design; only the tables that it has are considered.
    """
    for title, node in known_keys(schema(), document).items():
        tables = document.get(title)
        if isinstance(tables, dict) and "items" in node:
            continue  # the schema describes a list of tables
        for table in tables if isinstance(tables, list) else [tables]:
            if isinstance(table, dict):
                inner = node.get("items", node)
                yield from ((table, key, one) for key, one in known_keys(inner, table).items())


def is_text(node: Mapping[str, Any]) -> bool:
    """Return whether a key takes any text, or texts, a name or a file for example."""
    node = node["anyOf"][0] if "anyOf" in node else node
    node = node["items"] if node.get("type") == "array" else node
    return node.get("type") == "string" and "enum" not in node


def value(d: Draw, key: str, node: Mapping[str, Any]) -> Any:
    """Return a random value from a documented range; numbers are log-uniform.

    Parameters
    ----------
    d : Draw
        Random numbers.
    key : str
        The key in design files.
    node : mapping
        The schema of the key.
    """
    while "anyOf" in node:
        node = node["anyOf"][0]
    if "const" in node:
        return node["const"]
    if "enum" in node:
        return d.pick(node["enum"])
    kind = node.get("type")
    if kind == "array":
        fewest = node.get("minItems", 1)
        count = d.whole(fewest, node.get("maxItems", fewest + 3))
        drawn = [value(d, key, node["items"]) for _ in range(count)]
        return list(dict.fromkeys(drawn)) if node.get("uniqueItems") else drawn
    if kind == "boolean":
        return d.chance(0.5)
    if kind not in ("number", "integer"):
        return "x"
    drawn = _number(d, key, node)
    return round(drawn) if kind == "integer" else drawn


def _number(d: Draw, key: str, node: Mapping[str, Any]) -> float:
    low = node.get("minimum", node.get("exclusiveMinimum", -_WIDEST))
    high = node.get("maximum", node.get("exclusiveMaximum", _WIDEST))
    low, high = _AFFORDABLE.get(key, (low, high))
    if low < 0.0 < high and d.chance(0.5):
        return -d.log(-low * _NARROWEST, -low)
    drawn = d.log(low if low > 0.0 else high * _NARROWEST, high)
    return drawn if low < drawn < high or "exclusiveMaximum" not in node else 0.5 * (low + high)
