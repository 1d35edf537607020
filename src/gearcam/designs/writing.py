"""Documents of designs as text in TOML, with no more keys than needed."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from gearcam.base.errors import DesignError
from gearcam.designs.design import Design, design
from gearcam.designs.reader import find_tables


def least_document(given: Design) -> dict[str, Any]:
    """Return the document of a design without keys that say what holds without them.

    CSV files in it are named from the root, so that it may be written to any folder.

    Parameters
    ----------
    given : Design
        The design.

    Returns
    -------
    dict
        Of which `gearcam.design` makes an equal design.
    """
    document = given.to_dict()
    for title, table in list(document.items()):
        if isinstance(table, dict) or not table:
            rest = {name: value for name, value in document.items() if name != title}
            document = _if_equal(given, document, rest)
        if title in document and isinstance(table, dict):
            document = _with_least(given, document, title)
    find_tables(document, Path.cwd())
    return document


def _with_least(given: Design, document: dict[str, Any], title: str) -> dict[str, Any]:
    """Return the document with no more keys in one of its tables than needed."""
    for key in list(document[title]):
        left = {name: value for name, value in document[title].items() if name != key}
        document = _if_equal(given, document, {**document, title: left})
        pair = document[title].get(key)
        if isinstance(pair, list) and len(pair) == 2 and pair[0] == pair[1]:
            single = {**document[title], key: pair[0]}
            document = _if_equal(given, document, {**document, title: single})
    return document


def _if_equal(given: Design, document: dict[str, Any], smaller: dict[str, Any]) -> dict[str, Any]:
    """Return the smaller document if it is that of the same design."""
    try:
        return smaller if design(smaller, given.source) == given else document
    except DesignError:
        return document


def toml_text(document: Mapping[str, Any], comments: Sequence[str] = ()) -> str:
    """Return a document as text in TOML.

    Parameters
    ----------
    document : mapping
        Of a design: values, tables of values, lists of tables; mappings in them stand in line.
    comments : sequence of str
        Lines at the top, without the sign of a comment.

    Returns
    -------
    str
    """
    return "\n".join([*(f"# {line}".rstrip() for line in comments), *_lines(document), ""])


def _lines(document: Mapping[str, Any]) -> Iterator[str]:
    for key, value in document.items():
        if not _tables(value):
            yield f"{key} = {value_text(value)}"
    for key, value in document.items():
        for table in _tables(value):
            yield ""
            yield f"[{key}]" if isinstance(value, Mapping) else f"[[{key}]]"
            yield from (f"{name} = {value_text(one)}" for name, one in table.items())


def _tables(value: Any) -> Sequence[Mapping[str, Any]]:
    """Return the tables that a value is made of, none if it is none."""
    if isinstance(value, Mapping):
        return (value,)
    listed = isinstance(value, Sequence) and not isinstance(value, str)
    return value if listed and value and all(isinstance(one, Mapping) for one in value) else ()


def value_text(value: Any) -> str:
    """Return a value of a document as text in TOML."""
    if isinstance(value, Sequence) and not isinstance(value, str):
        return f"[{', '.join(map(value_text, value))}]"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {value_text(one)}' for key, one in value.items())} }}"
    if isinstance(value, float):
        return repr(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
    return json.dumps(value, ensure_ascii=False)
