"""A variant built and measured: one row of a sweep."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.base.errors import GearcamError
from gearcam.base.findings import Finding
from gearcam.base.inches import told
from gearcam.designs.design import Design
from gearcam.kinds import build
from gearcam.results.record import Record

TOO_LARGE: Final = "it needs more memory than a variant may have"


@dataclass(frozen=True, kw_only=True)
class Built(ShortRepr):
    """What is known of one variant.

    Parameters
    ----------
    number : int
        Its place in the sweep, from 0.
    values : mapping of str to value
        Values by dotted keys.
    facts : mapping of str to float or str
        Facts by names, in their units; empty if it is refused.
    findings : tuple of str
        Codes of findings, errors first.
    errors, warnings : int
        How many of them are errors and warnings.
    excess : float
        By how much their limits are exceeded, as shares of them: the sum over errors, and over
        warnings if the design counts them (``[goal] findings``).
    refusal : str
        Why it cannot be made; empty if it can.
    fault : bool
        Whether the refusal is a fault of the program, not of the design.
    time_s : float
        Time to build and measure it.
    """

    number: int
    values: Mapping[str, Any]
    facts: Mapping[str, float | str] = field(default_factory=dict)
    findings: tuple[str, ...] = ()
    errors: int = 0
    warnings: int = 0
    excess: float = 0.0
    refusal: str = ""
    fault: bool = False
    time_s: float = 0.0

    def __post_init__(self) -> None:
        facts = Record(self.facts)
        facts.refusal = self.refusal
        object.__setattr__(self, "facts", facts)

    @property
    def made(self) -> bool:
        """Whether the variant can be made."""
        return not self.refusal


Measure = Callable[[Design, int, Mapping[str, Any]], Built]
"""Makes the row of a variant of a design, from its number and values."""


def measured(base: Design, number: int, values: Mapping[str, Any]) -> Built:
    """Return the row of a variant; a variant that fails costs only itself.

    Parameters
    ----------
    base : Design
        The design.
    number : int
        Number of the variant.
    values : mapping of str to value
        Its values, in the units of a design file.
    """
    start = time.perf_counter()

    def row(**more: Any) -> Built:
        return Built(number=number, values=values, time_s=time.perf_counter() - start, **more)

    try:
        result = build(base.with_(values))
        facts = result.record()
        findings = result.findings_without_hints
    except GearcamError as error:
        return row(refusal=" ".join(str(told(error, base.units)).split()))
    except MemoryError:
        return row(refusal=TOO_LARGE)
    except Exception as error:
        return row(refusal=f"a fault of gearcam: {type(error).__name__}: {error}", fault=True)
    codes = tuple(dict.fromkeys(one.code for one in findings))
    errors = sum(one.severity == "error" for one in findings)
    warnings = sum(one.severity == "warning" for one in findings)
    goal: Any = getattr(base, "goal", None)
    counted = ("error", "warning")[: 1 + (goal is not None and goal.findings == "warning")]
    excess = sum(_excess(one) for one in findings if one.severity in counted)
    return row(facts=facts, findings=codes, errors=errors, warnings=warnings, excess=excess)


def _excess(finding: Finding) -> float:
    """Return by how much a finding is beyond its limit, as a share of it; 1 without numbers."""
    if finding.value is None or not finding.limit:
        return 1.0
    beyond = (
        finding.value - finding.limit
        if finding.relation == "at most"
        else finding.limit - finding.value
    )
    return max(beyond / abs(finding.limit), 1e-12)
