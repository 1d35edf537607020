"""Errors that gearcam raises on purpose, with messages that a machinist understands.

All derive from `GearcamError` and from the matching builtin:

* `DesignError`: the design file or the call contains mistakes. It lists every problem of the file
  at once, each with its place.
* `InfeasibleError`: the design is valid, but computation shows that it cannot be made. It holds the
  value, the limit it violates, and changes that may help.
* `MissingExtraError`: an optional library is not installed.
* `WriteError`: a file cannot be written.
* `NotFiniteError`: a number of a result is not finite, a bug.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

from gearcam.base.adjustments import Adjustment
from gearcam.base.numerals import SHORT, TYPED, told_apart

MOST_LISTED: Final = 100
"""Largest number of problems of a file that are listed."""


class GearcamError(Exception):
    """Base of every error that gearcam raises on purpose.

    Examples
    --------
    >>> import gearcam as gc
    >>> try:
    ...     gc.load("profiles/none.toml")
    ... except gc.GearcamError as error:
    ...     print(error)
    profiles/none.toml: there is no such file
    """


@dataclass(frozen=True)
class Problem:
    """One mistake in a design file.

    Parameters
    ----------
    message : str
        What is wrong, without its place.
    file : str
        The design file; empty for a design made in Python.
    line : int or None
        Line number in the file, from 1.
    key : str
        Dotted key path, such as ``pair.module_mm``.
    value : object
        The rejected value, as written.
    allowed : str
        The values that are allowed.
    hint : str
        A suggestion: the nearest key or value.
    """

    message: str
    file: str = ""
    line: int | None = None
    key: str = ""
    value: object = None
    allowed: str = ""
    hint: str = ""

    def __str__(self) -> str:
        line = f"{self.file}:{self.line}" if self.file else f"line {self.line}"
        place = self.file if self.line is None else line
        head = ": ".join(part for part in (place, self.key, self.message) if part)
        tail = (self.hint, self.allowed and f"allowed: {self.allowed}")
        return "\n    ".join(filter(None, (head, *tail)))


class DesignError(GearcamError, ValueError):
    """The design contains mistakes.

    Parameters
    ----------
    problems : iterable of Problem
        All problems found, in the order of the file.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.load("profiles/ellipse.toml").with_({"law.eccentricity": 2})
    Traceback (most recent call last):
        ...
    gearcam.base.errors.DesignError: profiles/ellipse.toml: law.eccentricity: 2 is out of range
        allowed: a number from 0 to below 1
    """

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))

    @classmethod
    def of(
        cls, message: str, *, key: str = "", value: object = None, allowed: str = ""
    ) -> DesignError:
        """Return the error of one mistake in no file (see `Problem`)."""
        return cls([Problem(message, key=key, value=value, allowed=allowed)])

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.problems,)


ABOVE = 1.01
"""Factor on a lower limit for the value suggested: rounded to three digits it stays above."""


class InfeasibleError(GearcamError, ValueError):
    """The design is valid but cannot be made.

    Parameters
    ----------
    what : str
        The reason, as a sentence without its full stop.
    where : str
        The place: an angle, a tooth, a wheel.
    value, limit : float or None
        The value and the limit that it violates, in `unit`.
    unit : str
        Unit of both.
    nearest : str
        What the numbers mean, or the rule. Not a tested remedy: `gearcam.remedies` finds those.
    adjustments : sequence of Adjustment
        Changes of the design that may help.
    more_teeth : float
        Factor on the number of teeth that may help, as may a smaller range of the ratio; 0 if
        neither can.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml").with_({"blank.bore_diameter_mm": 60})
    >>> try:
    ...     gc.build(design).parts
    ... except gc.InfeasibleError as error:
    ...     print(error.what, error.where, error.value, round(error.limit, 3))
    the bore reaches the root of the teeth wheels 1 and 2, blank.bore_diameter_mm 60.0 26.909
    """

    def __init__(
        self,
        what: str,
        *,
        where: str = "",
        value: float | None = None,
        limit: float | None = None,
        unit: str = "",
        nearest: str = "",
        adjustments: Sequence[Adjustment] = (),
        more_teeth: float = 0.0,
    ) -> None:
        self.what, self.where, self.nearest, self.unit = what, where, nearest, unit
        self.adjustments, self.more_teeth = tuple(adjustments), more_teeth
        self.value, self.limit = value, limit
        text, numbers = f"{what} ({where})" if where else what, self.numbers(SHORT)
        super().__init__("; ".join(part for part in (text, numbers, nearest) if part))

    def numbers(self, digits: int = TYPED) -> str:
        """Return value and limit as text, in more `digits` if they would look the same."""
        texts = told_apart(self.value, self.limit, self.unit, digits)
        pairs = zip(("value", "limit"), texts, strict=True)
        return ", ".join(f"{name} {text}" for name, text in pairs if text)

    def __reduce__(self) -> tuple[Any, ...]:
        names = ("where", "value", "limit", "unit", "nearest", "adjustments", "more_teeth")
        return partial(type(self), self.what, **{name: getattr(self, name) for name in names}), ()


_UNIT = re.compile(r"_(mm|deg)(?:\[\d+\])?$")
"""Ends of keys that are units."""


def beyond_limit(
    what: str,
    where: str,
    value: float | None,
    limit: float | None,
    note: str = "",
    *,
    near: object = None,
    far: object = None,
    adjustments: Sequence[Adjustment] = (),
    unit: str | None = None,
    more_teeth: float = 0.0,
) -> InfeasibleError:
    """Return the refusal of a value beyond its limit, with the change of its key that may help.

    Parameters
    ----------
    what : str
        The reason, as a sentence without its full stop.
    where : str
        The key of the value, after the place if there is one: ``wheel 2, ring.rim_mm``.
    value, limit : float or None
        The value and the limit that it violates.
    note : str
        What the numbers mean, or the rule.
    near, far : object
        The smallest and the largest change of the key that may help; with `far` alone the smallest
        is the limit. Without both there is none. A mapping has changes of other keys.
    adjustments : sequence of Adjustment
        Other changes that may help, tried after that of the key.
    unit : str, optional
        Unit of value and limit; by default that in which the key ends.
    more_teeth : float
        Factor on the number of teeth that may help (see `InfeasibleError`).

    Returns
    -------
    InfeasibleError
    """
    if far is not None and near is None and not isinstance(far, Mapping):
        near = limit
    if near is not None or far is not None:
        key = where.rpartition(", ")[2]
        first, last = (
            change if isinstance(change, Mapping) else {} if change is None else {key: change}
            for change in (near, far)
        )
        adjustments = (Adjustment(near=first, far=last), *adjustments)
    return InfeasibleError(
        what,
        where=where,
        value=value,
        limit=limit,
        unit=_unit_of(where) if unit is None else unit,
        nearest=note,
        adjustments=adjustments,
        more_teeth=more_teeth,
    )


def _unit_of(where: str) -> str:
    """Return the unit in which a key ends; empty without one."""
    ending = _UNIT.search(where)
    return ending[1] if ending else ""


class MissingExtraError(GearcamError, ImportError):
    """A library that only some outputs need is not installed.

    Parameters
    ----------
    what : str
        What needs it, in the plural.
    extra : str
        The extra of the package that installs it.
    packages : str
        What pip installs instead, where no extra does.

    Examples
    --------
    >>> import gearcam as gc
    >>> print(gc.MissingExtraError("charts", "plot"))
    charts need a library that is not installed: pip install "gearcam[plot]"
    """

    def __init__(self, what: str, extra: str = "", packages: str = "") -> None:
        self.what, self.extra, self.packages = what, extra, packages
        wanted = packages or f'"gearcam[{extra}]"'
        super().__init__(f"{what} need a library that is not installed: pip install {wanted}")

    @classmethod
    def unless(cls, *libraries: str, what: str, extra: str) -> None:
        """Raise the error unless some libraries are installed.

        Parameters
        ----------
        *libraries : str
            Names by which they are imported.
        what, extra : str
            See above.

        Raises
        ------
        MissingExtraError
            If one is not.
        """
        from importlib.util import find_spec  # not at every start

        if not all(map(find_spec, libraries)):
            raise cls(what, extra)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.what, self.extra, self.packages)


class WriteError(GearcamError, OSError):
    """A file or folder cannot be written.

    Examples
    --------
    >>> import gearcam as gc
    >>> result = gc.build(gc.load("profiles/ellipse.toml"))
    >>> try:
    ...     result.write("profiles/ellipse.toml")
    ... except gc.WriteError as error:
    ...     print(error)
    cannot write to profiles/ellipse.toml/ellipse: Not a directory
    """


class NotFiniteError(GearcamError, ValueError):
    """A number of a result is not finite, which is a bug: no limit can be held against it.

    Parameters
    ----------
    name : str
        The fact, finding, extreme or cell of a table that it is the value of.
    value : float
        The number.
    """

    def __init__(self, name: str, value: float) -> None:
        self.name, self.value = name, value
        super().__init__(f"{name} is not a finite number, but {value}")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.name, self.value)


def demand_finite(name: str, value: object) -> None:
    """Refuse a number that is not finite, in mappings and lists too.

    Parameters
    ----------
    name : str
        What it is the value of.
    value : object
        A value of a result; other things than numbers are let pass.

    Raises
    ------
    NotFiniteError
        With the name of the number, a dotted path.
    """
    if isinstance(value, Mapping):
        for key, item in value.items():
            demand_finite(f"{name}.{key}", item)
    elif isinstance(value, list | tuple):
        for place, item in enumerate(value):
            demand_finite(f"{name}.{place}", item)
    elif isinstance(value, float) and not math.isfinite(value):
        raise NotFiniteError(name, value)
