"""Designs as the text of a design file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from gearcam.designs.design import Design
from gearcam.designs.kind import KINDS
from gearcam.designs.table import default_of


def design_text(design: Design, comment: str = "") -> str:
    """Return the text of a file for a design, without values that are left out by default.

    Parameters
    ----------
    design : Design
        The design.
    comment : str
        The first line.

    Raises
    ------
    DesignError
        If it contains a Python function.
    """
    document, kind = design.to_dict(), KINDS[design.kind]
    for title in kind.tables:
        if title in kind.several or title not in document:
            continue
        entries = kind.table_of(design, title).entries
        plain = {
            key: value
            for key, value in document[title].items()
            if key not in entries or value != default_of(entries[key])
        }
        document[title] = plain
    kept = {title: content for title, content in document.items() if content not in ({}, [])}
    return (f"# {comment}\n" if comment else "") + toml_text(kept)


def toml_text(document: Mapping[str, Any]) -> str:
    """Return a document as TOML: values, tables, and arrays of tables.

    Parameters
    ----------
    document : mapping
        Of values, mappings, and lists of mappings.
    """
    lines = [f"{key} = {_value(value)}" for key, value in document.items() if not _tables(value)]
    for title, content in document.items():
        head = f"[[{title}]]" if isinstance(content, list) else f"[{title}]"
        for table in _tables(content):
            lines += ["", head, *(f"{key} = {_value(value)}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


def _tables(value: Any) -> list[Mapping[str, Any]]:
    items = value if isinstance(value, list) else [value]
    return items if all(isinstance(item, Mapping) for item in items) else []


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {_value(item)}' for key, item in value.items())} }}"
    return repr(value)
