"""How objects show themselves: in one line, and in a notebook as a picture with its facts.

Pictures and tables are made by `gearcam.markup`, which is loaded when a notebook asks for one.
"""

from __future__ import annotations

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence, Sized
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from gearcam.facts import Facts

WIDTH: Final = 96
"""Letters of a line that stands for an object."""

_WORD: Final = 30
"""Letters of a text within it."""

_FEW: Final = 4
"""Items of a row of numbers that are shown."""


class Brief:
    """Makes a dataclass show itself in one line: its type, and its fields but for defaults.

    Numbers and texts are shown, of arrays the shape, of other objects the type.
    """

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if "__repr__" not in vars(cls):
            cls.__repr__ = cls.__repr__  # a dataclass writes its own where a class has none

    def __repr__(self) -> str:
        fields = dataclasses.fields(self)  # pyright: ignore[reportArgumentType]
        values = ((field, getattr(self, field.name)) for field in fields if field.repr)
        told = [(one.name, word(value)) for one, value in values if not _usual(one, value)]
        told.sort(key=lambda pair: pair[1][:1].isupper())  # numbers and texts before objects
        return line(type(self).__name__, [f"{name}={text}" for name, text in told if text])


def line(name: str, words: Sequence[str]) -> str:
    """Return ``name(word, word, ...)`` of a `name` and `words`, cut to one line."""
    text, kept = f"{name}({', '.join(words)})", list(words)
    while len(text) > WIDTH and kept:
        kept.pop()
        text = f"{name}({', '.join([*kept, '...'])})"
    return text


def cut(text: str) -> str:
    """Return a `text` in angle brackets, cut to one line."""
    return text if len(text) <= WIDTH else f"{text[: WIDTH - 4]}...>"


def word(value: Any) -> str:
    """Return a `value` in a word, or nothing of what has none: functions and what is missing."""
    if isinstance(value, str):
        return repr(value if len(value) <= _WORD else f"{value[: _WORD - 3]}...")
    if isinstance(value, bool | int):
        return str(value)
    if isinstance(value, float | complex):
        return f"{value:.6g}"
    if getattr(value, "shape", None):
        return f"array{value.shape}"
    if isinstance(value, tuple | list):
        plain = len(value) <= _FEW and all(isinstance(one, int | float | str) for one in value)
        return f"({', '.join(map(word, value))})" if plain else _count(value)
    if isinstance(value, Mapping):
        return _count(value)
    return "" if value is None or callable(value) else type(value).__name__


def _count(values: Sized) -> str:
    return "1 item" if len(values) == 1 else f"{len(values)} items"


def _usual(field: dataclasses.Field[Any], value: Any) -> bool:
    """Return whether a field has its default, as far as that can be told at once."""
    return isinstance(value, bool | int | float | str | tuple) and value == field.default


class Displayed(ABC):
    """What a notebook shows as a picture with its facts below."""

    @cached_property
    @abstractmethod
    def facts(self) -> Facts:
        """What is known of it."""

    @abstractmethod
    def picture(self) -> str:
        """Return a picture, SVG; nothing of what has none."""

    def _repr_svg_(self) -> str | None:
        return self.picture() or None

    def _repr_html_(self) -> str:
        from gearcam.markup import page

        return page(self.picture(), self.facts)
