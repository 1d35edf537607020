"""Representations of objects: one line of text, and a picture with facts in a notebook.

The module that writes pictures and tables (`renderer`) is named here and imported when a notebook
needs it, so that whatever is shown depends on no other package.
"""

from __future__ import annotations

import copy
import dataclasses
import importlib
import os
from abc import abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, Final, Self

from gearcam.base.pickling import pickled
from gearcam.base.user_names import ForUsers

WIDTH: Final = 96
"""Length of the one-line representation, characters."""

_WORD: Final = 30
"""Length of a text within it, characters."""

_FEW: Final = 4
"""Number of items up to which all are shown."""

RENDERER: Final = "gearcam.pictures.markup"
"""The module that writes pictures and tables as SVG and HTML."""


def renderer() -> Any:
    """Return the module that writes pictures and tables, with ``outlines`` and ``page``."""
    return importlib.import_module(RENDERER)


class ShortRepr:
    """Base of dataclasses with a one-line representation: type, and fields without defaults.

    It shows numbers and texts, the shapes of arrays, and the types of other objects. They can be
    pickled with the local functions that they hold (see `gearcam.base.pickling`).
    """

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if "__repr__" not in vars(cls):
            cls.__repr__ = cls.__repr__  # else the dataclass generates its own

    def __getstate__(self) -> Any:
        return pickled(vars(self))

    def __copy__(self) -> Self:
        return self._with(vars(self))

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self._with(copy.deepcopy(vars(self), memo))

    def _with(self, state: Mapping[str, Any]) -> Self:
        made = object.__new__(type(self))
        vars(made).update(state)
        return made

    def __repr__(self) -> str:
        fields = dataclasses.fields(self)  # pyright: ignore[reportArgumentType]
        values = ((field, getattr(self, field.name)) for field in fields if field.repr)
        texts = [(one.name, word(value)) for one, value in values if not _usual(one, value)]
        texts.sort(key=lambda pair: pair[1][:1].isupper())  # numbers and texts before objects
        return line(type(self).__name__, [f"{name}={text}" for name, text in texts if text])


def line(name: str, words: Sequence[str]) -> str:
    """Return ``name(word, word, ...)`` of a `name` and `words`, cut to one line."""
    text, kept = f"{name}({', '.join(words)})", list(words)
    while len(text) > WIDTH and kept:
        kept.pop()
        text = f"{name}({', '.join([*kept, '...'])})"
    return text


def cut(text: str) -> str:
    """Return a `text` that is in angle brackets, cut to one line."""
    return text if len(text) <= WIDTH else f"{text[: WIDTH - 4]}...>"


def word(value: Any) -> str:
    """Return a `value` as a short text, empty for functions and None."""
    value = os.fspath(value) if isinstance(value, os.PathLike) else value
    if isinstance(value, str):
        return repr(value if len(value) <= _WORD else f"{value[: _WORD - 3]}...")
    if isinstance(value, bool | int):
        return str(value)
    if isinstance(value, float | complex):
        return repr(str(value)) if hasattr(value, "tolerance_class") else f"{value:.6g}"
    if getattr(value, "shape", None):
        return f"array{value.shape}"
    if isinstance(value, tuple | list | Mapping):
        return _items(value)
    return "" if value is None or callable(value) else type(value).__name__


def _items(values: Sequence[Any] | Mapping[str, Any]) -> str:
    """Return a few short items as text, else their number."""
    named = isinstance(values, Mapping)
    rows = list(values.values() if isinstance(values, Mapping) else values)
    texts = [word(one) for one in rows] if len(rows) <= _FEW else []
    if all(texts) and len(texts) == len(rows):
        if named:
            texts = [f"{key}: {text}" for key, text in zip(values, texts, strict=True)]
        text = ", ".join(texts) + "," * (len(texts) == 1 and not named)
        if len(text) <= WIDTH // 2:
            return f"{{{text}}}" if named else f"({text})"
    return "1 item" if len(rows) == 1 else f"{len(rows)} items"


def _usual(field: dataclasses.Field[Any], value: Any) -> bool:
    """Return whether a field has its default; only simple values are compared."""
    return isinstance(value, bool | int | float | str | tuple) and value == field.default


class NotebookView(ForUsers):
    """Base of objects that a notebook shows as a picture with facts below."""

    @cached_property
    @abstractmethod
    def facts(self) -> Mapping[str, Any]:
        """The quantities shown."""

    @abstractmethod
    def picture(self) -> str:
        """Return the picture as SVG text; empty if there is none."""

    def _repr_svg_(self) -> str | None:
        return self.picture() or None

    def _repr_html_(self) -> str:
        return renderer().page(self.picture(), self.facts)
