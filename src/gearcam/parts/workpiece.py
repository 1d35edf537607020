"""The finished piece of a blank: names for messages, and sizes that a design leaves open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import Array
from gearcam.parts.body import Edge

FINE: Final = 4e-5
"""Chord error of openings in tests for overlap, in rims."""

GRAIN: Final = 1e-9
"""Its least value, over the reach of an edge, for thin rims."""


@dataclass(frozen=True, kw_only=True)
class Workpiece:
    """The finished piece of a blank: a wheel of a pair, or a cam.

    Parameters
    ----------
    name : str
        Its name in messages.
    rim : float, mm
        Default of the rim between lightening holes and the edge.
    travel : float or None, rad
        Travel of an open wheel; None for a closed one.
    wheel : int or None
        1 or 2; None for a single part.
    within : str
        Name of the boundary of its openings.
    """

    name: str
    rim: float
    travel: float | None = None
    wheel: int | None = None
    within: str = "the outline"

    def points(self, edge: Edge) -> Array:
        """Return points of an `edge`, (n, 2), mm, for tests of overlap."""
        return edge.points(self.sagitta(edge))

    def sagitta(self, edge: Edge) -> float:
        """Return how far the chords between those points may be from the `edge`, mm."""
        return max(FINE * self.rim, GRAIN * edge.reach)

    def key(self, name: str) -> str:
        """Return the dotted key of its value of key `name` in ``[blank]``."""
        return f"blank.{name}" if self.wheel is None else f"blank.{name}[{self.wheel - 1}]"

    def refusal(self, what: str, place: str = "[blank]", **told: Any) -> InfeasibleError:
        """Return the error `what` at `place`, in mm; `told` are arguments of `InfeasibleError`."""
        return InfeasibleError(what, where=f"{self.name}, {place}", unit="mm", **told)
