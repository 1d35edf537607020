"""Pickles of objects that hold local functions: pieces of laws, tracks, laws of drives.

Python pickles a function by its name, which a function made inside another does not have. Such a
function of this package is pickled by its code, its defaults and what it has taken from around it,
so that whatever was computed comes back as it was. Its code is that of one version: a pickle is
read by the version that wrote it, on the same version of Python. The pickle of a result or a design
holds no functions, and is read by others.

Depends on nothing.
"""

from __future__ import annotations

import marshal
import sys
from functools import partial
from importlib import import_module
from types import CellType, FunctionType, MappingProxyType
from typing import Any, Final

from gearcam.version import __version__

_OURS: Final = __name__.partition(".")[0]

_VERSION: Final = f"gearcam {__version__} on Python {sys.version_info[0]}.{sys.version_info[1]}"

_STAND_IN: Final = "pickled_as"
"""Attribute of a local function: what is pickled in its place, so that it is pickled once."""


class _Local:
    """What is pickled in the place of a local function."""

    def __init__(self, function: FunctionType) -> None:
        self.function = function

    def __reduce__(self) -> tuple[Any, ...]:
        own = self.function
        cells = [pickled(cell.cell_contents) for cell in own.__closure__ or ()]
        state = cells, pickled(own.__defaults__), pickled(own.__kwdefaults__)
        code = marshal.dumps(own.__code__)
        # the state comes last, since it may hold the function itself
        return _function, (_VERSION, own.__module__, code, len(cells)), state, None, None, _complete


class _Rebuilt:
    """What is pickled in the place of an object that is made by a call."""

    def __init__(self, function: Any, *values: Any) -> None:
        self.made_by = function, values

    def __reduce__(self) -> tuple[Any, ...]:
        return self.made_by


def pickled(value: Any) -> Any:
    """Return what is pickled in the place of a value: the same, without local functions."""
    if isinstance(value, FunctionType):
        if "<" not in value.__qualname__ or value.__module__.partition(".")[0] != _OURS:
            return value
        return vars(value).setdefault(_STAND_IN, _Local(value))
    if isinstance(value, partial):
        return _Rebuilt(_partial, *map(pickled, (value.func, value.args, value.keywords)))
    if isinstance(value, MappingProxyType):
        return _Rebuilt(MappingProxyType, pickled(dict(value)))
    if isinstance(value, dict):
        items = {key: pickled(item) for key, item in value.items()}
        return items if type(value) is dict and _differ(items.values(), value.values()) else value
    if type(value) is list or isinstance(value, tuple):
        items = [pickled(item) for item in value]
        if not _differ(items, value):
            return value
        return _Rebuilt(_sequence, type(value), items)
    return value


def _differ(items: Any, others: Any) -> bool:
    return any(one is not other for one, other in zip(items, others, strict=True))


def _function(version: str, module: str, code: bytes, cells: int) -> FunctionType:
    if version != _VERSION:
        raise TypeError(
            f"this was pickled by {version} and cannot be read by {_VERSION}: pickle the design or "
            "the result, which any version reads"
        )
    empty = tuple(CellType() for _ in range(cells))
    return FunctionType(marshal.loads(code), vars(import_module(module)), closure=empty)


def _complete(function: FunctionType, state: tuple[Any, ...]) -> None:
    cells, function.__defaults__, function.__kwdefaults__ = state
    for cell, content in zip(function.__closure__ or (), cells, strict=True):
        cell.cell_contents = content


def _partial(function: Any, values: Any, keywords: Any) -> Any:
    return partial(function, *values, **keywords)


def _sequence(kind: Any, items: Any) -> Any:
    return kind._make(items) if hasattr(kind, "_make") else kind(items)
