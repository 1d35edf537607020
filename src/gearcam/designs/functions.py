"""Python functions in documents, where a file would have a formula."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator
from typing import Any

from gearcam.designs.lines import Path

Function = Callable[..., Any]


def functions_of(value: Any) -> tuple[Function, ...]:
    """Return the Python functions in a value: one function, or a list of functions only."""
    if callable(value):
        return (value,)
    many = value if isinstance(value, list | tuple) else ()
    return tuple(many) if all(map(callable, many)) else ()


def functions_in(part: Any, path: Path = ()) -> Iterator[tuple[Path, tuple[Function, ...]]]:
    """Yield the paths of functions in a `part` of a document at a `path`, with the functions."""
    if functions := functions_of(part):
        yield path, functions
    elif isinstance(part, dict | list):
        for key, item in part.items() if isinstance(part, dict) else enumerate(part):
            yield from functions_in(item, (*path, key))


def function_name(function: Function) -> str:
    """Return the name of a function for messages: ``Python function module.name``."""
    named = function if hasattr(function, "__qualname__") else type(function)
    return f"Python function {named.__module__}.{named.__qualname__}"


def pickles(function: Function) -> bool:
    """Return whether a function can be pickled."""
    try:
        pickle.dumps(function)
    except Exception:
        return False  # other classes may raise anything
    return True


def never(_: Function) -> bool:
    """Return False: no function is allowed."""
    return False
