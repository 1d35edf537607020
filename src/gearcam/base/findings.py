"""Findings, and the registry of checks.

A *check* examines one aspect of a built design and yields *findings*. A design that cannot be built
at all raises an error instead. Checks are defined next to the code they examine and registered with
`check`; their limits are the keys of the table ``[limits]`` of a design file. Severities: ``note``
(good to know), ``warning`` (look before you cut), ``error`` (do not cut).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import wraps
from typing import Any, Final, Literal, NamedTuple

from gearcam.base.display import ShortRepr
from gearcam.base.errors import demand_finite
from gearcam.base.numerals import settled
from gearcam.base.quantities import NUMBER, Param
from gearcam.base.readable import against

Severity = Literal["note", "warning", "error"]

Relation = Literal["at most", "at least", "about"]
"""How a value keeps its limit."""


@dataclass(frozen=True, kw_only=True)
class Finding(ShortRepr):
    """The result of a check that the user should know.

    Parameters
    ----------
    code : str
        The check's code, such as ``undercut``.
    severity : {"note", "warning", "error"}
        How bad it is.
    message : str
        One or two plain sentences.
    value, limit : float or None
        The value found and its limit, in `unit`; a value that is rounding noise relative to the
        limit becomes 0.
    relation : {"at most", "at least", "about"}, optional
        How a value keeps this limit; ``about``: it is at least about this. A finding may be about a
        value that does.
    unit : str
        Unit of both.
    where : str
        The place: wheel, tooth, angle.

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
    relation: Relation | None = None
    unit: str = ""
    where: str = ""

    def __post_init__(self) -> None:
        demand_finite(f"the finding {self.code}", {"value": self.value, "limit": self.limit})
        if self.value is not None and self.limit is not None:
            object.__setattr__(self, "value", settled(self.value, self.limit))

    @property
    def text(self) -> str:
        """The value with its unit as people read it, unlike the limit if that is broken."""
        return self._told[0]

    @property
    def limit_text(self) -> str:
        """The limit as text: ``at most 30 deg``."""
        if self.limit is None:
            return ""
        return f"{self.relation or ''} {self._told[1]}".lstrip()

    @property
    def _told(self) -> tuple[str, str]:
        """Value and limit as text, with one unit."""
        sign = {"at most": -1.0, "at least": 1.0}.get(self.relation or "", 0.0)
        value, limit = self.value, self.limit
        kept = value is not None and limit is not None and sign * value >= sign * limit != 0.0
        return against(value, limit, self.unit, kept=kept)

    def as_dict(self) -> dict[str, Any]:
        """Return the finding as a dict for JSON, without empty entries."""
        fields = ("code", "severity", "message", "value", "limit", "relation", "unit", "where")
        return {
            name: getattr(self, name) for name in fields if getattr(self, name) not in (None, "")
        }


class Remark(NamedTuple):
    """What a check yields: a finding without the fields given when the check is registered.

    Parameters
    ----------
    message, where, value
        As in a `Finding`.
    severity, unit, relation : str
        If they differ from those of the check.
    limit : float
        In `unit`, if it differs from that of the check; infinite: no limit.
    """

    message: str
    where: str = ""
    value: float | None = None
    severity: Severity | None = None
    unit: str = ""
    limit: float = math.nan
    relation: Relation | None = None


Limits = Mapping[str, float | tuple[float, ...]]
"""Limits by name, in mm and rad; a pair where a limit may have two values."""

Look = Callable[[Any, Any], Iterable[Remark]]
"""The function of a check: ``look(subject, limit)``, the limit in mm or rad, nan without one."""

Run = Callable[[Any, Any], Iterator[Finding]]
"""The same, yielding findings."""


@dataclass(frozen=True, kw_only=True)
class Check:
    """An entry of the registry.

    Parameters
    ----------
    code : str
        Its name in findings.
    kind : str
        The kind of subject that it examines.
    limit : tuple of (str, Param, float) or None
        Name in ``[limits]``, quantity with its range, and default in internal units (mm, rad).
    relation : {"at most", "at least"} or None
        How a value keeps the limit, that of the table or of a finding; None without limits.
    severities : tuple of str
        Severities that its findings may have, the usual one first.
    run : callable
        ``run(subject, limit)`` yields findings; `limit` in internal units, nan without one.
    """

    code: str
    kind: str
    limit: tuple[str, Param, float] | None
    relation: Relation | None
    severities: tuple[Severity, ...]
    run: Run

    @property
    def doc(self) -> str:
        """What it does, then ``Looks at: ...``: the docstring of its function in one line."""
        return " ".join((self.run.__doc__ or "").split())


ROUNDING: Final = 1e-9
"""Relative tolerance of limits: a value typed in as a finding prints it keeps the limit."""

CHECKS: Final[dict[tuple[str, str], Check]] = {}
"""The checks by kind and code."""


def check(
    code: str,
    *,
    kind: str | tuple[str, ...],
    limit: tuple[str, Param, float] | None = None,
    relation: Relation | None = None,
    severity: Severity | tuple[Severity, ...] = "warning",
    unit: str = "",
) -> Callable[[Look], Run]:
    """Return a decorator that makes a function a check of one or more kinds (see `Check`).

    Parameters
    ----------
    code, kind, limit, relation
        As in a `Check`.
    severity : {"note", "warning", "error"} or tuple of them
        Severities that its findings may have; the first is the default.
    unit : str
        Default unit of its values; if empty, that of the limit.

    Raises
    ------
    ValueError
        If the code is already registered for a kind, or a limit has no relation.
    """
    quantity = limit[1].quantity if limit else NUMBER
    unit = unit or quantity.unit
    severities = (severity,) if isinstance(severity, str) else severity
    if limit and relation is None:
        raise ValueError(f"check {code!r} does not say how a value keeps its limit")

    def finding(remark: Remark, limit: Any) -> Finding:
        bound = limit / quantity.factor if math.isnan(remark.limit) else remark.limit
        limited = remark.value is not None and math.isfinite(bound)
        if limited and relation is None:
            raise ValueError(f"check {code!r} does not say how a value keeps its limit")
        return Finding(
            code=code,
            severity=remark.severity or severities[0],
            message=remark.message,
            value=remark.value,
            limit=bound if limited else None,
            relation=(remark.relation or relation) if limited else None,
            unit="" if remark.value is None else remark.unit or unit,
            where=remark.where,
        )

    def register(look: Look) -> Run:
        @wraps(look)
        def run(subject: Any, value: Any) -> Iterator[Finding]:
            return (finding(remark, value) for remark in look(subject, value))

        for one in (kind,) if isinstance(kind, str) else kind:
            if (one, code) in CHECKS:
                raise ValueError(f"check {code!r} is registered twice")
            CHECKS[one, code] = Check(
                code=code,
                kind=one,
                limit=limit,
                relation=relation,
                severities=severities,
                run=run,
            )
        return run

    return register


def limit_of(kind: str, code: str, limits: Limits) -> Any:
    """Return the limit of a check: a number, or a pair where it may have two values.

    Parameters
    ----------
    kind, code : str
        Kind of subject and code of the check.
    limits : mapping of str to float or tuple of float
        Limits set by the design, by name, in internal units.

    Returns
    -------
    float or tuple of float
        The limit set by the design, else the default, in internal units; nan without a limit.
    """
    limit = CHECKS[kind, code].limit
    return float("nan") if limit is None else limits.get(limit[0], limit[2])


def run_checks(kind: str, subject: Any, limits: Limits) -> tuple[Finding, ...]:
    """Run every check of a kind of design on a built subject.

    Parameters
    ----------
    kind : str
        Kind of subject, such as ``gear-pair``.
    subject : object
        What the checks examine.
    limits : mapping of str to float or tuple of float
        Limits set by the design, by name, in internal units; others keep their defaults.

    Returns
    -------
    tuple of Finding
        Errors first, then warnings, then notes.

    Raises
    ------
    LookupError
        If there are none: the module of the checks was not imported.
    """
    entries = [entry for entry in CHECKS.values() if entry.kind == kind]
    if not entries:
        raise LookupError(f"no checks of {kind} are registered: import their module")
    findings: list[Finding] = []
    for entry in entries:
        findings += entry.run(subject, limit_of(kind, entry.code, limits))
    return in_order(findings)


def in_order(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return findings with errors first, then warnings, then notes."""
    order = ("error", "warning", "note")
    return tuple(sorted(findings, key=lambda finding: order.index(finding.severity)))
