"""Design files written from nested dictionaries, and changed as a person would by their keys."""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

import gearcam


def written(document: Mapping[str, Any]) -> str:
    """The text of a design file."""
    return "\n".join(_lines(document)) + "\n"


def _lines(document: Mapping[str, Any]) -> Iterator[str]:
    for key, value in document.items():
        if not isinstance(value, Mapping) and not _tables(value):
            yield f"{key} = {json.dumps(value)}"
    for key, value in document.items():
        for table in value if _tables(value) else [value] if isinstance(value, Mapping) else []:
            yield f"[[{key}]]" if _tables(value) else f"[{key}]"
            yield from (f"{name} = {json.dumps(item)}" for name, item in table.items())


def _tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], Mapping)


def followed(document: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """A document with other values at dotted keys; a value for both wheels becomes two."""
    made = copy.deepcopy(dict(document))
    for key, value in changes.items():
        steps: list[Any] = [int(s) if s.isdigit() else s for s in re.findall(r"[^.\[\]]+", key)]
        place: Any = made
        for step, after in pairwise(steps):
            if isinstance(after, int) and not isinstance(place.get(step), list):
                place[step] = [place.get(step, 0)] * 2
            place = place.setdefault(step, {}) if isinstance(place, dict) else place[step]
        place[steps[-1]] = value
    return made


def job_of(document: Mapping[str, Any], folder: Path) -> Any:
    """The job of a design that is read from its file."""
    file = folder / "design.toml"
    file.write_text(written(document), encoding="utf-8")
    return gearcam.build(gearcam.load(file))
