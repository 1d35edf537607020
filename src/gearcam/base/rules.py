"""Rules between the values of a design: each is declared once and gives message and schema.

A parameter class lists the rules between its fields in its class attribute ``rules``; a kind of
design lists those between its tables, with dotted names such as ``pair.type``. What must be
computed from valid values is no rule: parameters find it in their method ``problems``.

A value is *given* if it is written and differs from its default; 0 counts only where it does not
mean that there is none. Values that are wrong by themselves are neither given nor missing.

Knows nothing of tables and files: `Values` and `Keys` do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final, Protocol

from gearcam.base.numerals import formatted

Breach = tuple[str, int | None, str, str]
"""A broken rule: field (empty for the table), index of an item, message, what is allowed."""

Schema = dict[str, Any]


class Values(Protocol):
    """The values of a table, or of all tables by dotted names, as in a file."""

    def get(self, name: str) -> Any:
        """Return a value or its default; None if there is none, or a wrong one."""

    def given(self, name: str) -> bool:
        """Return whether a right value is given."""

    def written(self, name: str) -> bool:
        """Return whether a value is written, right or wrong, and not as 0 for none."""

    def missing(self, name: str) -> bool:
        """Return whether a value is left out, or is 0 and this means that there is none."""

    def key(self, name: str) -> str:
        """Return the key of a field: ``module_mm``, or ``pair.module_mm`` for a dotted name."""

    def unit(self, name: str) -> str:
        """Return the unit of a field; empty without one."""

    def text(self, name: str) -> str:
        """Return key and value as in a file: ``module_mm = 2``."""


class Keys(Protocol):
    """The keys of a table, or of all tables by dotted names, for the schema."""

    def given(self, name: str) -> Schema:
        """Return the schema of tables in which a value is given."""

    def written(self, name: str) -> Schema:
        """Return the schema of tables in which a value is not missing."""

    def value(self, name: str, schema: Schema, *, required: bool = False) -> Schema:
        """Return the schema of tables whose value, if there is one, obeys a `schema`."""

    def is_one_of(self, name: str, words: Iterable[Any]) -> Schema:
        """Return the schema of tables in which a value or its default is one of some `words`."""

    def both(self, name: str) -> bool:
        """Return whether a field has a value for each of two wheels."""


def _without(_: Keys) -> Schema:
    return {}


@dataclass(frozen=True, eq=False, repr=False)
class Rule:
    """A rule between values.

    Parameters
    ----------
    breaches : callable
        Yields what is wrong with some `Values`.
    schema : callable
        Returns its JSON schema for some `Keys`; empty if a schema cannot say it.
    """

    breaches: Callable[[Values], Iterator[Breach]]
    schema: Callable[[Keys], Schema] = _without

    def __repr__(self) -> str:
        return f"<Rule {self.breaches.__qualname__.partition('.')[0]}>"


def exactly_one(*names: str, note: str = "") -> Rule:
    """Return the rule that exactly one of some fields is given; a `note` follows what is allowed.

    Parameters
    ----------
    *names : str
        The fields.
    note : str
        Text after what is allowed.
    """

    def breaches(values: Values) -> Iterator[Breach]:
        allowed = f"exactly one of {_listed(map(values.key, names))}{note and f'; {note}'}"
        written = [name for name in names if values.written(name)]
        if all(map(values.missing, names)):
            keys = " nor ".join(map(values.key, names))
            yield "", None, f"neither {keys} is given", allowed
        for name in written[1:]:
            yield name, None, f"is given beside {values.text(written[0])}", allowed

    return Rule(breaches, lambda keys: {"oneOf": [keys.written(name) for name in names]})


def needs(name: str, *others: str, one: bool = False, allowed: str = "") -> Rule:
    """Return the rule that a field is given only with all of `others`, or at least with `one`.

    Parameters
    ----------
    name : str
        The field.
    *others : str
        What it needs.
    one : bool
        Whether one of them is enough.
    allowed : str
        What is allowed, in place of ``NAME with OTHERS``.
    """

    def breaches(values: Values) -> Iterator[Breach]:
        missing = [other for other in others if values.missing(other)]
        if not values.given(name) or (one and len(missing) < len(others)):
            return
        rule = f"{values.key(name)} with {_listed(map(values.key, others), one=one)}"
        for other in missing[:1] if one else missing:
            yield other, None, f"is missing beside {values.key(name)}", allowed or rule

    def schema(keys: Keys) -> Schema:
        wanted = {"anyOf" if one else "allOf": [keys.written(other) for other in others]}
        return {"if": keys.given(name), "then": wanted}

    return Rule(breaches, schema)


def together(*names: str, allowed: str = "") -> Iterator[Rule]:
    """Yield the rules that some fields are given together, or none of them.

    Parameters
    ----------
    *names : str
        The fields.
    allowed : str
        As for `needs`.
    """
    for name in names:
        yield needs(name, *(other for other in names if other != name), allowed=allowed)


def excludes(name: str, *others: str, allowed: str = "") -> Rule:
    """Return the rule that a field is not given beside any of `others`.

    Parameters
    ----------
    name : str
        The field that is refused.
    *others : str
        What it must not stand beside.
    allowed : str
        What is allowed, in place of ``NAME or OTHERS``.
    """

    def breaches(values: Values) -> Iterator[Breach]:
        beside = [other for other in others if values.given(other)]
        if values.given(name) and beside:
            rule = _listed(map(values.key, (name, *others)), one=True)
            yield name, None, f"is given beside {values.text(beside[0])}", allowed or rule

    def schema(keys: Keys) -> Schema:
        if any(map(keys.both, (name, *others))):
            return {}  # they may be those of different wheels
        beside = {"anyOf": [keys.given(other) for other in others]}
        return {"if": keys.given(name), "then": {"not": beside}}

    return Rule(breaches, schema)


def only_with(names: Iterable[str], key: str, *words: Any, why: str = "") -> Rule:
    """Return the rule that some fields are given only if another has one of some values.

    Parameters
    ----------
    names : iterable of str
        The fields.
    key : str
        The other field.
    *words : object
        Its values.
    why : str
        The message; ``{}`` stands for its value.
    """
    names = tuple(names)

    def breaches(values: Values) -> Iterator[Breach]:
        value = values.get(key)
        if value is None or value in words:
            return
        message = why.format(value) or f"does not apply with {values.text(key)}"
        for name in names:
            if values.given(name):
                yield name, None, message, f"with {values.key(key)} = {_quoted(words)}"

    def schema(keys: Keys) -> Schema:
        foreign = {"anyOf": [keys.given(name) for name in names]}
        return {"if": foreign, "then": keys.is_one_of(key, words)}

    return Rule(breaches, schema)


def needed_with(names: Iterable[str], key: str, *words: Any, why: str = "") -> Rule:
    """Return the rule that some fields are given if another has one of some values.

    Parameters
    ----------
    names : iterable of str
        The fields.
    key : str
        The other field.
    *words : object
        Its values.
    why : str
        The message; ``{}`` stands for its value.
    """
    names = tuple(names)

    def breaches(values: Values) -> Iterator[Breach]:
        value = values.get(key)
        message = why.format(value) or f"is missing with {key} = {_quoted([value])}"
        for name in names:
            if value in words and values.missing(name):
                yield name, None, message, f"needed with {values.key(key)} = {_quoted(words)}"

    def schema(keys: Keys) -> Schema:
        needed = {"allOf": [keys.written(name) for name in names]}
        return {"if": keys.is_one_of(key, words), "then": needed}

    return Rule(breaches, schema)


def excluded(name: str, value: Any, *, why: str, allowed: str, **beside: Any) -> Rule:
    """Return the rule that a field does not have a value, or not beside values of other fields.

    Parameters
    ----------
    name : str
        The field that is refused.
    value : object
        Its value, in the unit of the file.
    why, allowed : str
        Message, and what is allowed.
    **beside : object
        Values of other fields by name.
    """
    wrong = {name: value, **beside}

    def breaches(values: Values) -> Iterator[Breach]:
        if all(values.get(key) == one for key, one in wrong.items()):
            yield name, None, why, allowed

    def schema(keys: Keys) -> Schema:
        return {"not": {"allOf": [keys.is_one_of(key, (one,)) for key, one in wrong.items()]}}

    return Rule(breaches, schema)


def distinct(name: str, item: str) -> Rule:
    """Return the rule that a list has every value once.

    Parameters
    ----------
    name : str
        The field.
    item : str
        The word for a value.
    """

    def breaches(values: Values) -> Iterator[Breach]:
        given = values.get(name)
        items = given if isinstance(given, list) else []
        for index, value in enumerate(items):
            if value in items[:index]:
                yield name, index, "is listed twice", f"each {item} once"

    return Rule(breaches, lambda keys: keys.value(name, {"uniqueItems": True}))


_COMPARED: Final[dict[str, Callable[[float, float], bool]]] = {
    "above": lambda value, limit: value > limit,
    "below": lambda value, limit: value < limit,
    "at most": lambda value, limit: value <= limit,
}


def _compared(how: str, name: str, other: str, why: str, part: float = 1.0) -> Rule:
    def breaches(values: Values) -> Iterator[Breach]:
        value, limit = values.get(name), values.get(other)
        if not _is_number(value) or not _is_number(limit):
            return
        if (
            values.given(name)
            and not values.missing(other)
            and not _COMPARED[how](value, part * limit)
        ):
            share = (
                f"{values.key(other)}/{formatted(1.0 / part)}" if part != 1.0 else values.key(other)
            )
            size = f"{formatted(part * limit)} {values.unit(other)}".rstrip()
            message = why.format(values.text(other))
            yield name, None, message, f"{how} {share} = {size}"

    return Rule(breaches)


def above(name: str, other: str, *, why: str = "is not above {}") -> Rule:
    """Return the rule that a given value is above that of another field.

    Parameters
    ----------
    name, other : str
        The fields.
    why : str
        The message; ``{}`` stands for the other key with its value.
    """
    return _compared("above", name, other, why)


def below(name: str, other: str, *, why: str = "is not below {}") -> Rule:
    """Return the rule that a given value is below that of another field.

    Parameters
    ----------
    name, other : str
        The fields.
    why : str
        The message; ``{}`` stands for the other key with its value.
    """
    return _compared("below", name, other, why)


def at_most(name: str, other: str, *, why: str = "is above {}", part: float = 1.0) -> Rule:
    """Return the rule that a given value is at most a `part` of that of another field.

    Parameters
    ----------
    name, other : str
        The fields.
    why : str
        The message; ``{}`` stands for the other key with its value.
    part : float
        Factor of the other value.
    """
    return _compared("at most", name, other, why, part)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _listed(words: Iterable[str], *, one: bool = False) -> str:
    """Return ``a, b and c``, or ``a, b or c`` if `one` of them is meant."""
    *most, last = words
    return f"{', '.join(most)} {'or' if one else 'and'} {last}" if most else last


def _quoted(words: Iterable[Any]) -> str:
    return _listed(
        (f'"{word}"' if isinstance(word, str) else f"{word}" for word in words), one=True
    )
