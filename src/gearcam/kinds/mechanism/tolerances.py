"""Tolerances of a mechanism: the tables ``[precision]`` and ``[[tolerance]]``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import ANGLE, COUNT, LENGTH, TEXT, param
from gearcam.base.rules import exactly_one
from gearcam.kinds.mechanism.keys import WithNames

_LARGEST: Final = 100.0
"""Largest tolerance, mm."""


def _general(quantity: Any, *, doc: str, le: float) -> Any:
    return param(quantity, default=0.0, ge=0, le=le, doc=doc, zero_is_none=True)


@dataclass(frozen=True, kw_only=True)
class MachinePrecisionSpec(ShortRepr):
    """Tolerances of all dimensions of a mechanism, to either side, and random machines.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.MachinePrecisionSpec(length_tolerance=0.05, clearance=0.02)
    MachinePrecisionSpec(length_tolerance=0.05, clearance=0.02)
    """

    length_tolerance: float = _general(LENGTH, le=_LARGEST, doc="of every length and place")
    angle_tolerance: float = _general(ANGLE, le=10, doc="of every angle")
    clearance: float = _general(
        LENGTH, le=_LARGEST, doc="how far a pin is free in its hinge, or a slide across its guide"
    )
    trials: int = param(
        COUNT, default=0, ge=0, le=100000, doc="number of random machines within the tolerances"
    )
    seed: int = param(COUNT, default=1, ge=0, le=1000000, doc="of the random numbers")
    steps: int = param(
        COUNT, default=360, ge=12, le=100000, doc="number of even steps of the range"
    )


@dataclass(frozen=True, kw_only=True)
class ToleranceSpec(WithNames):
    """Tolerance of one dimension, instead of that of all.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.ToleranceSpec(of="rod.length", length=0.01)
    ToleranceSpec(of='rod.length', length=0.01)
    """

    of: str = param(
        TEXT, min_length=1, example="rod.length", doc="the dimension, as in the summary"
    )
    length: float | None = param(
        LENGTH, default=None, ge=0, le=_LARGEST, example=0.01, word="tolerance", doc="of a length"
    )
    angle: float | None = param(
        ANGLE, default=None, ge=0, le=10, example=0.05, word="tolerance", doc="of an angle"
    )

    rules = (exactly_one("length", "angle"),)
