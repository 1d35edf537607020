"""Rules between the values of a design: each is declared once and gives message and schema.

A parameter class lists the rules between its fields in its class attribute ``rules``; a kind of
design lists those between its tables, with dotted names such as ``pair.type``. What must be
computed from valid values is no rule: parameters find it in their method ``problems``.

A value is *given* if it is written and differs from its default; 0 counts only where it does not
mean that there is none. Values that are wrong by themselves are neither given nor missing.

Knows nothing of tables and files: each rule gets its values, or its keys, by their names.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from gearcam.base.numerals import formatted
from gearcam.base.quantities import NONE

Breach = tuple[str, int | None, str, str]
"""A broken rule: field (empty for the table), index of an item, message, what is allowed."""

Schema = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Value:
    """A value of a design as in its file.

    Parameters
    ----------
    key : str
        Its key: ``module_mm``, or ``pair.module_mm`` among those of all tables.
    shown : callable
        ``shown()`` returns key and value as in a file: ``module_mm = 2``.
    unit : str
        Its unit; empty without one.
    content : object
        What is written; None if it is left out.
    default : object
        Its default; None without one.
    zero_is_none : bool
        Whether 0, or the word for it, means that there is none.
    wrong : bool
        Whether it is wrong by itself, or its key misspelt.
    contents : tuple
        Of a key that has a value for each of two wheels: both of them; empty where they are the
        same, or one is written for both.
    """

    key: str
    shown: Callable[[], str]
    unit: str
    content: Any
    default: Any
    zero_is_none: bool
    wrong: bool
    contents: tuple[Any, ...] = ()

    @property
    def text(self) -> str:
        """Key and value as in a file."""
        return self.shown()

    @property
    def right(self) -> Any:
        """The value or its default; None if there is none, or a wrong one."""
        value = self.default if self.content is None else self.content
        return None if self.wrong else value

    @property
    def given(self) -> bool:
        """Whether a right value is given."""
        return not self._is_none(self.right) and self.right != self.default

    @property
    def written(self) -> bool:
        """Whether it is written, right or wrong, and not as 0 for none."""
        return not self._is_none(self.content)

    @property
    def missing(self) -> bool:
        """Whether it is left out, or is 0 and this means that there is none."""
        return not self.wrong and self._is_none(self.right)

    @property
    def missing_on_both(self) -> bool:
        """Whether neither of two wheels has it."""
        return self.missing and all(self._is_none(one) for one in self.contents)

    def _is_none(self, value: Any) -> bool:
        if not self.zero_is_none:
            return value is None
        return value is None or value == NONE or (_is_number(value) and value == 0)


@dataclass(frozen=True, kw_only=True)
class Field:
    """A key for the schema of the table, or of the design, that it belongs to.

    Parameters
    ----------
    path : tuple of str
        The key, after the title of its table if the schema is that of a design.
    default : object
        Its default in a file; None without one.
    none : tuple
        Values that mean that there is none.
    both : bool
        Whether it has a value for each of two wheels.
    """

    path: tuple[str, ...]
    default: Any
    none: tuple[Any, ...]
    both: bool

    @property
    def given(self) -> Schema:
        """The schema of what gives it a value."""
        return self._differs([self.default, *self.none])

    @property
    def written(self) -> Schema:
        """The schema of what does not leave it out."""
        return self._differs(self.none)

    def is_one_of(self, words: Iterable[Any]) -> Schema:
        """Return the schema of what gives it one of some `words`, or its default if this is one."""
        values = list(words)
        return self.obeys({"enum": values}, required=self.default not in values)

    def obeys(self, schema: Schema, *, required: bool = False) -> Schema:
        """Return the schema of what gives it a value of a `schema`, or none if not `required`."""
        # of one table, or of a table in a design
        for key in reversed(self.path):
            schema = {"properties": {key: schema}} | ({"required": [key]} if required else {})
        return schema

    def _differs(self, values: Iterable[Any]) -> Schema:
        single = [value for value in values if value is not None]
        pairs = [[value, value] for value in single if self.both]
        return self.obeys({"not": {"enum": [*single, *pairs]}} if single else {}, required=True)


Values = Mapping[str, Value]
Fields = Mapping[str, Field]
"""Values and keys by the names of fields: of one table, or of all with dotted names."""


def _without(_: Fields) -> Schema:
    return {}


@dataclass(frozen=True, eq=False, repr=False)
class Rule:
    """A rule between values.

    Parameters
    ----------
    breaches : callable
        Yields what is wrong with some values.
    schema : callable
        Returns its JSON schema for some keys; empty if a schema cannot say it.
    """

    breaches: Callable[[Values], Iterator[Breach]]
    schema: Callable[[Fields], Schema] = _without

    def __repr__(self) -> str:
        return f"<Rule {self.breaches.__qualname__.partition('.')[0]}>"


def exactly_one(*names: str, note: str = "", both: tuple[str, str] | None = None) -> Rule:
    """Return the rule that exactly one of some fields is given; a `note` follows what is allowed.

    Parameters
    ----------
    *names : str
        The fields.
    note : str
        Text after what is allowed.
    both : (str, str), optional
        Two of them that may be given together.
    """

    def breaches(values: Values) -> Iterator[Breach]:
        allowed = f"exactly one of {_listed(_keys(values, *names))}{note and f'; {note}'}"
        written = [name for name in names if values[name].written]
        if all(values[name].missing for name in names):
            keys = " nor ".join(_keys(values, *names))
            yield "", None, f"neither {keys} is given", allowed
        for name in () if tuple(written) == both else written[1:]:
            yield name, None, f"is given beside {values[written[0]].text}", allowed

    def schema(keys: Any) -> Any:
        alone = {name: keys[name].written for name in names}
        if both is not None:
            first, second = both
            alone[second] = {"allOf": [alone[second], {"not": alone[first]}]}
        return {"oneOf": [*alone.values()]}

    return Rule(breaches, schema)


def needs(
    name: str, *others: str, one: bool = False, serves: bool = False, allowed: str = ""
) -> Rule:
    """Return the rule that a field is given only with all of `others`, or at least with `one`.

    Parameters
    ----------
    name : str
        The field.
    *others : str
        What it needs.
    one : bool
        Whether one of them is enough.
    serves : bool
        Whether it says more of them, as the circle of bolts does: one value for two wheels then
        holds for those that have them, if one has.
    allowed : str
        What is allowed, in place of ``NAME with OTHERS``.
    """

    def breaches(values: Values) -> Iterator[Breach]:
        either = serves and not values[name].contents
        missing = [
            other
            for other in others
            if (values[other].missing_on_both if either else values[other].missing)
        ]
        if not values[name].given or (one and len(missing) < len(others)):
            return
        rule = f"{values[name].key} with {_listed(_keys(values, *others), one=one)}"
        for other in missing[:1] if one else missing:
            yield other, None, f"is missing beside {values[name].key}", allowed or rule

    def schema(keys: Fields) -> Schema:
        wanted = {"anyOf" if one else "allOf": [keys[other].written for other in others]}
        return {"if": keys[name].given, "then": wanted}

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
        beside = [other for other in others if values[other].given]
        if values[name].given and beside:
            rule = allowed or _listed(_keys(values, name, *others), one=True)
            rule = _for_other_wheel(values[name], values[beside[0]]) + rule
            yield name, None, f"is given beside {values[beside[0]].text}", rule

    def schema(keys: Fields) -> Schema:
        if any(keys[one].both for one in (name, *others)):
            return {}  # they may be those of different wheels
        beside = {"anyOf": [keys[other].given for other in others]}
        return {"if": keys[name].given, "then": {"not": beside}}

    return Rule(breaches, schema)


def _for_other_wheel(one: Value, other: Value) -> str:
    """Return how only the wheel without `one` is given `other`; empty if both have `one`."""
    lacks = [one._is_none(value) for value in one.contents]
    if other.contents or not any(lacks):
        return ""
    none = f'"{NONE}"' if isinstance(other.default, str) else "0"
    value = other.text.partition(" = ")[2]
    pair = ", ".join(value if lack else none for lack in lacks)
    return f"{other.key} = [{pair}] for the wheel without {one.key}; else "


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
        value = values[key].right
        if value is None or value in words:
            return
        message = why.format(value) or f"does not apply with {values[key].text}"
        for name in names:
            if values[name].given:
                yield name, None, message, f"with {values[key].key} = {_quoted(words)}"

    def schema(keys: Fields) -> Schema:
        foreign = {"anyOf": [keys[name].given for name in names]}
        return {"if": foreign, "then": keys[key].is_one_of(words)}

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
        value = values[key].right
        message = why.format(value) or f"is missing with {key} = {_quoted([value])}"
        for name in names:
            if value in words and values[name].missing:
                yield name, None, message, f"needed with {values[key].key} = {_quoted(words)}"

    def schema(keys: Fields) -> Schema:
        needed = {"allOf": [keys[name].written for name in names]}
        return {"if": keys[key].is_one_of(words), "then": needed}

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
        if all(values[key].right == one for key, one in wrong.items()):
            yield name, None, why, allowed

    def schema(keys: Fields) -> Schema:
        return {"not": {"allOf": [keys[key].is_one_of([one]) for key, one in wrong.items()]}}

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
        given = values[name].right
        items = given if isinstance(given, list) else []
        for index, value in enumerate(items):
            if value in items[:index]:
                yield name, index, "is listed twice", f"each {item} once"

    return Rule(breaches, lambda keys: keys[name].obeys({"uniqueItems": True}))


_COMPARED: Final[dict[str, Callable[[float, float], bool]]] = {
    "above": lambda value, limit: value > limit,
    "below": lambda value, limit: value < limit,
    "at most": lambda value, limit: value <= limit,
}


def _compared(how: str, name: str, other: str, why: str, part: float = 1.0) -> Rule:
    def breaches(values: Values) -> Iterator[Breach]:
        value, limit = values[name].right, values[other].right
        if not _is_number(value) or not _is_number(limit):
            return
        if (
            values[name].given
            and not values[other].missing
            and not _COMPARED[how](value, part * limit)
        ):
            share = (
                f"{values[other].key}/{formatted(1.0 / part)}" if part != 1.0 else values[other].key
            )
            size = f"{formatted(part * limit)} {values[other].unit}".rstrip()
            message = why.format(values[other].text)
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


def _keys(values: Values, *names: str) -> list[str]:
    return [values[name].key for name in names]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _listed(words: Iterable[str], *, one: bool = False) -> str:
    """Return ``a, b and c``, or ``a, b or c`` if `one` of them is meant."""
    *most, last = words
    return f"{', '.join(most)} {'or' if one else 'and'} {last}" if most else last


def _quoted(words: Iterable[Any]) -> str:
    return _listed((json.dumps(word, ensure_ascii=False) for word in words), one=True)
