"""Drawing at random: numbers, choices, and values over the ranges that the program documents.

The ranges are read from the schema that the program prints, so that they are those of the tree at
hand. Draws of one seed are the same on every machine.
"""

from __future__ import annotations

import math
import os
import random
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from json import loads
from pathlib import Path
from typing import Any, Final, TypeVar

ROOT: Final = Path(__file__).resolve().parents[1]
T = TypeVar("T")

DIGITS: Final = 6
"""Digits of a drawn number: people type no more."""

_NARROWEST, _WIDEST = 1e-9, 1e6
"""Where a documented range is open, the least of its upper end and the most that is drawn."""

_AFFORDABLE: Final = {
    "teeth": (3, 300),
    "steps": (1, 100),
    "inspection_points": (2, 2000),
    "motion_step_deg": (0.05, 90.0),
    "chord_tolerance_mm": (1e-4, 1.0),
    "bolts": (0, 30),
}
"""Ranges drawn from where the documented one would take minutes or gigabytes."""


@cache
def schema(tree: Path = ROOT) -> dict[str, Any]:
    """Return the schema of design files that a tree's program prints."""
    command = [sys.executable, "-m", "gearcam", "schema"]
    env = {**os.environ, "PYTHONPATH": str(tree / "src")}
    return loads(subprocess.run(command, env=env, capture_output=True, check=True).stdout)


def known_keys(node: Mapping[str, Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keys that the schema knows at a node for what is given there, with their schemas.

    Parameters
    ----------
    node : mapping
        A part of the schema of this tree.
    given : mapping
        The table of a design: which branches hold follows from its values.
    """
    found: dict[str, Any] = {}
    if "$ref" in node:
        found |= known_keys(schema()["$defs"][node["$ref"].rpartition("/")[2]], given)
    found |= node.get("properties", {})
    for branch in node.get("allOf", ()):
        asked = branch.get("if", {}).get("properties", {})
        if all(given.get(key) == what.get("const") for key, what in asked.items()):
            found |= known_keys(branch.get("then", branch), given)
    return {key: _resolved(one) for key, one in found.items()}


def _resolved(node: Mapping[str, Any]) -> Mapping[str, Any]:
    while "$ref" in node and len(node) == 1:
        node = schema()["$defs"][node["$ref"].rpartition("/")[2]]
    return node


def places(document: Mapping[str, Any]) -> Iterator[tuple[dict[str, Any], str, Mapping[str, Any]]]:
    """Yield every key that the tables of a design know: the table, the key, its schema.

    Parameters
    ----------
    document : mapping
        A design; tables that it does not have are not offered.
    """
    for title, node in known_keys(schema(), document).items():
        tables = document.get(title)
        if isinstance(tables, dict) and "items" in node:
            continue  # one table in place of a list is another thing
        for table in tables if isinstance(tables, list) else [tables]:
            if isinstance(table, dict):
                inner = node.get("items", node)
                yield from ((table, key, one) for key, one in known_keys(inner, table).items())


class Draw:
    """Draws of one seed.

    Parameters
    ----------
    seed : str
        Whatever tells one design from another.
    """

    def __init__(self, seed: str) -> None:
        self.random = random.Random(seed)

    def chance(self, share: float) -> bool:
        """Return True in this share of draws."""
        return self.random.random() < share

    def pick(self, items: Sequence[T]) -> T:
        """Return one of these."""
        return items[int(self.random.random() * len(items))]

    def even(self, low: float, high: float) -> float:
        """Return a number from `low` to `high`, each as likely."""
        return short(low + (high - low) * self.random.random())

    def log(self, low: float, high: float) -> float:
        """Return a number from `low` to `high`, both above 0, each power of ten as likely."""
        return short(math.exp(self.random.uniform(math.log(low), math.log(high))))

    def sign(self) -> int:
        """Return 1 or -1."""
        return 1 if self.chance(0.5) else -1

    def whole(self, low: int, high: int) -> int:
        """Return a whole number from `low` to `high`, small ones as likely as all large ones."""
        return min(high, int(self.log(max(low, 0.7), high + 0.999))) if high > low else low

    def shares(self, count: int, least: float = 0.3) -> list[float]:
        """Return numbers that are 1 in all, none below `least` times another."""
        drawn = [self.random.uniform(least, 1.0) for _ in range(count)]
        return [one / sum(drawn) for one in drawn]

    def value(self, key: str, node: Mapping[str, Any]) -> Any:
        """Return a value anywhere in a documented range: log-uniform where it is of numbers.

        Parameters
        ----------
        key : str
            Its key in design files.
        node : mapping
            Its schema.
        """
        node = node["anyOf"][0] if "anyOf" in node else node
        if "const" in node:
            return node["const"]
        if "enum" in node:
            return self.pick(node["enum"])
        kind = node.get("type")
        if kind == "array":
            fewest = node.get("minItems", 1)
            count = self.whole(fewest, node.get("maxItems", fewest + 3))
            drawn = [self.value(key, node["items"]) for _ in range(count)]
            return list(dict.fromkeys(drawn)) if node.get("uniqueItems") else drawn
        if kind == "boolean":
            return self.chance(0.5)
        if kind not in ("number", "integer"):
            return "x"
        drawn = self._number(key, node)
        return round(drawn) if kind == "integer" else drawn

    def _number(self, key: str, node: Mapping[str, Any]) -> float:
        low = node.get("minimum", node.get("exclusiveMinimum", -_WIDEST))
        high = node.get("maximum", node.get("exclusiveMaximum", _WIDEST))
        low, high = _AFFORDABLE.get(key, (low, high))
        if low < 0.0 < high and self.chance(0.5):
            return -self.log(-low * _NARROWEST, -low)
        drawn = self.log(low if low > 0.0 else high * _NARROWEST, high)
        return drawn if low < drawn < high or "exclusiveMaximum" not in node else 0.5 * (low + high)


def short(value: float) -> float:
    """Return a number with few digits."""
    return float(f"{value:.{DIGITS}g}")


def toml(document: Mapping[str, Any]) -> str:
    """Return a design as the text of its file: values, tables, and lists of tables."""
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
        return f'"{value}"'
    if isinstance(value, list):
        return f"[{', '.join(map(_told, value))}]"
    return repr(value)
