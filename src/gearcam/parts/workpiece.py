"""What a blank is made into, for messages and for sizes that a design leaves open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from gearcam.errors import InfeasibleError
from gearcam.numeric.arrays import Array
from gearcam.parts.body import Edge

FINE: Final = 4e-5
"""Sagitta of chords that stand for openings when it is asked what they meet, in rims."""

GRAIN: Final = 1e-9
"""The least of it, over how far an edge reaches, however thin a rim is."""


@dataclass(frozen=True, kw_only=True)
class Workpiece:
    """What a blank is made into: a wheel of a pair, or a cam.

    Parameters
    ----------
    name : str
        What a person calls it.
    rim : float, mm
        What lightening holes leave below the edge where the design gives none.
    travel : float or None, rad
        How far an open wheel turns; None for a closed one.
    wheel : int or None
        1 or 2; None of what stands alone.
    within : str
        What its openings keep within, in words.
    """

    name: str
    rim: float
    travel: float | None = None
    wheel: int | None = None
    within: str = "the outline"

    def points(self, edge: Edge) -> Array:
        """Return points of an `edge`, (n, 2), mm, that stand for it when it is asked what meets."""
        return edge.points(max(FINE * self.rim, GRAIN * edge.reach))

    def key(self, name: str) -> str:
        """Return the dotted key of its value of ``[blank]``, `name` being the table's key."""
        return f"blank.{name}" if self.wheel is None else f"blank.{name}[{self.wheel - 1}]"

    def refusal(self, what: str, place: str = "[blank]", **told: Any) -> InfeasibleError:
        """Return a refusal of `what` at a `place` in mm; `told` goes to `InfeasibleError`."""
        return InfeasibleError(what, where=f"{self.name}, {place}", unit="mm", **told)
