"""Python functions in documents, where a file would have a formula as text."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator
from typing import Any

from gearcam.designs.lines import Path

Function = Callable[..., Any]


def functions_of(value: Any) -> tuple[Function, ...]:
    """Return the Python functions that stand for one text: a function, or a list of functions."""
    if callable(value):
        return (value,)
    many = value if isinstance(value, list | tuple) else ()
    return tuple(many) if all(map(callable, many)) else ()


def functions_in(part: Any, path: Path = ()) -> Iterator[tuple[Path, tuple[Function, ...]]]:
    """Yield where functions stand in a `part` of a document at a `path`, and these."""
    if functions := functions_of(part):
        yield path, functions
    elif isinstance(part, dict | list):
        for key, item in part.items() if isinstance(part, dict) else enumerate(part):
            yield from functions_in(item, (*path, key))


def function_name(function: Function) -> str:
    """Return a function in words: ``Python function module.name``."""
    named = function if hasattr(function, "__qualname__") else type(function)
    return f"Python function {named.__module__}.{named.__qualname__}"


def pickles(function: Function) -> bool:
    """Return whether a function can be pickled."""
    try:
        pickle.dumps(function)
    except Exception:
        return False  # classes of other people raise what they like
    return True


def never(_: Function) -> bool:
    """Return False."""
    return False
