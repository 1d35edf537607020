"""Designs as TOML text."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any


def toml(document: Mapping[str, Any]) -> str:
    """Return a design as TOML text: values, tables, and arrays of tables."""
    lines = [f"{key} = {_told(value)}" for key, value in document.items() if not _tables(value)]
    for title, content in document.items():
        head = f"[[{title}]]" if isinstance(content, list) else f"[{title}]"
        for table in _tables(content):
            lines += ["", head, *(f"{key} = {_told(value)}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


def _tables(value: Any) -> list[Mapping[str, Any]]:
    items = value if isinstance(value, list) else [value]
    return items if all(isinstance(item, Mapping) for item in items) else []


def _told(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return f"[{', '.join(map(_told, value))}]"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {_told(item)}' for key, item in value.items())} }}"
    return repr(value)
