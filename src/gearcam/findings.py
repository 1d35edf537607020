"""Findings, and the registry of checks.

A *check* looks at one aspect of a built design and yields *findings*: poor but buildable. What
cannot be built raises instead. Checks live beside what they check and register themselves with
`check`; their limits are the keys of the design file's ``[limits]`` table. Severities: ``note``
(good to know), ``warning`` (look before you cut), ``error`` (do not cut).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import wraps
from typing import Any, Final, Literal, NamedTuple

from gearcam.display import Brief
from gearcam.numerals import settled, with_unit
from gearcam.quantities import NUMBER, Param

Severity = Literal["note", "warning", "error"]


@dataclass(frozen=True, kw_only=True)
class Finding(Brief):
    """One thing a person should know about a built design.

    Parameters
    ----------
    code : str
        The check's code, such as ``undercut``.
    severity : {"note", "warning", "error"}
        How bad it is.
    message : str
        One or two plain sentences.
    value, limit : float or None
        The number found and the limit it is held against, in `unit`; rounding noise against the
        limit is 0.
    unit : str
        Unit of both.
    where : str
        Wheel, tooth, angle.

    Examples
    --------
    >>> import gearcam as gc
    >>> found = gc.build(gc.load("profiles/ellipse.toml")).findings
    >>> [(one.severity, one.code) for one in found]
    [('note', 'no-backlash')]
    """

    code: str
    severity: Severity
    message: str
    value: float | None = None
    limit: float | None = None
    unit: str = ""
    where: str = ""

    def __post_init__(self) -> None:
        if self.value is not None and self.limit is not None:
            object.__setattr__(self, "value", settled(self.value, self.limit))

    @property
    def told(self) -> str:
        """The number found with its unit, in words."""
        return with_unit(self.value, self.unit)

    @property
    def held(self) -> str:
        """The limit in words: what was found is on its wrong side."""
        if self.value is None or self.limit is None:
            return ""
        words = "at most" if self.value > self.limit else "at least"
        return f"{words} {with_unit(self.limit, self.unit)}"

    def as_dict(self) -> dict[str, Any]:
        """Return the finding for JSON: what does not exist is left out."""
        fields = ("code", "severity", "message", "value", "limit", "unit", "where")
        return {
            name: getattr(self, name) for name in fields if getattr(self, name) not in (None, "")
        }


class Remark(NamedTuple):
    """What a check yields: a finding without what its registration says of all of them.

    Parameters
    ----------
    message, where, value
        As of a `Finding`.
    severity, unit : str
        Where they are not those of the check.
    limit : float
        In `unit`, where it is not that of the check; infinite where there is none.
    """

    message: str
    where: str = ""
    value: float | None = None
    severity: Severity | None = None
    unit: str = ""
    limit: float = math.nan


Look = Callable[[Any, float], Iterable[Remark]]
"""What looks at a subject, given the limit in inner units (nan where there is none)."""

Run = Callable[[Any, float], Iterator[Finding]]
"""The same with findings made of the remarks."""


@dataclass(frozen=True, kw_only=True)
class Check:
    """An entry of the registry.

    Parameters
    ----------
    code : str
        Its name in findings.
    kind : str
        The kind of subject that it looks at.
    limit : tuple of (str, Param, float) or None
        Name in ``[limits]``, quantity with range, and default in inner units.
    run : callable
        ``run(subject, limit)`` yields findings; `limit` in inner units, or nan where there is none.
    """

    code: str
    kind: str
    limit: tuple[str, Param, float] | None
    run: Run


ROUNDING: Final = 1e-9
"""Share of a limit that is rounding: what a finding names, typed in as printed, keeps the limit."""

CHECKS: Final[dict[tuple[str, str], Check]] = {}
"""The checks by kind and code."""


def check(
    code: str,
    *,
    kind: str | tuple[str, ...],
    limit: tuple[str, Param, float] | None = None,
    severity: Severity = "warning",
    unit: str = "",
) -> Callable[[Look], Run]:
    """Return a decorator that makes a function a check of one or more kinds (see `Check`).

    Parameters
    ----------
    code, kind, limit
        As of a `Check`.
    severity : {"note", "warning", "error"}
        Of findings that do not say another.
    unit : str
        Of values that do not say another; that of the limit if left out.

    Raises
    ------
    ValueError
        If a kind has the code already.
    """
    quantity = limit[1].quantity if limit else NUMBER
    unit = unit or quantity.unit

    def finding(found: Remark, own: float) -> Finding:
        bound = own / quantity.factor if math.isnan(found.limit) else found.limit
        return Finding(
            code=code,
            severity=found.severity or severity,
            message=found.message,
            value=found.value,
            limit=bound if found.value is not None and math.isfinite(bound) else None,
            unit="" if found.value is None else found.unit or unit,
            where=found.where,
        )

    def register(look: Look) -> Run:
        @wraps(look)
        def run(subject: Any, own: float) -> Iterator[Finding]:
            return (finding(found, own) for found in look(subject, own))

        for one in (kind,) if isinstance(kind, str) else kind:
            if (one, code) in CHECKS:
                raise ValueError(f"check {code!r} is registered twice")
            CHECKS[one, code] = Check(code=code, kind=one, limit=limit, run=run)
        return run

    return register


def limit_of(kind: str, code: str, limits: Mapping[str, float]) -> float:
    """Return the limit of a check.

    Parameters
    ----------
    kind, code : str
        Which check.
    limits : mapping of str to float
        Limits that the design sets, by name, inner units.

    Returns
    -------
    float
        The design's or the default one, in inner units; nan where the check has none.
    """
    known = CHECKS[kind, code].limit
    return float("nan") if known is None else limits.get(known[0], known[2])


def run_checks(kind: str, subject: Any, limits: Mapping[str, float]) -> tuple[Finding, ...]:
    """Run every check of a kind of design on a built subject.

    Parameters
    ----------
    kind : str
        Such as ``gear-pair``: which checks.
    subject : object
        What the checks look at.
    limits : mapping of str to float
        Limits that the design sets, by name, inner units; the others keep their defaults.

    Returns
    -------
    tuple of Finding
        Errors first, then warnings, then notes.
    """
    found: list[Finding] = []
    for entry in CHECKS.values():
        if entry.kind == kind:
            found += entry.run(subject, limit_of(kind, entry.code, limits))
    return in_order(found)


def in_order(found: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return findings with errors first, then warnings, then notes."""
    order = ("error", "warning", "note")
    return tuple(sorted(found, key=lambda finding: order.index(finding.severity)))
