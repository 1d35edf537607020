"""Values for keys of a design as typed on the command line: ``KEY=VALUE,...``."""

from __future__ import annotations

import tomllib
from typing import Any

from gearcam.designs.design import path_of


def setting_of(text: str) -> tuple[str, str] | None:
    """Return key and words of a setting ``KEY=...``; None if it is not of this form."""
    key, equals, words = (part.strip() for part in text.partition("="))
    return (key, words) if path_of(key) and equals else None


def values_of(words: str) -> list[Any]:
    """Return values, separated by commas, as in a design file; words may be without quotes."""
    try:
        return tomllib.loads(f"values = [{words}]")["values"]
    except (ValueError, RecursionError):
        return [value_of(word) for word in words.split(",")]


def value_of(word: str) -> Any:
    """Return one value as in a design file; a word may be without quotes."""
    try:
        return tomllib.loads(f"value = {word}")["value"]
    except (ValueError, RecursionError):
        return word.strip()


def listed_twice(values: list[Any]) -> list[Any]:
    """Return the values that are in a list before."""
    if all(isinstance(one, float | int | str) for one in values) and len({*values}) == len(values):
        return []  # at once, however many
    return [one for k, one in enumerate(values) if one in values[:k]]
