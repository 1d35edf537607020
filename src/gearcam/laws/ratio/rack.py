"""A wheel that drives a rack: rotation becomes translation."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gearcam.errors import InfeasibleError
from gearcam.laws.entry import LawEntry
from gearcam.laws.formula import compiled, derivative, formula_problems, values_of
from gearcam.laws.ratio.base import LAWS, RatioLaw, make_law
from gearcam.laws.ratio.span import PLACES, Lobes, RackTravel, angle_text, demand_smooth
from gearcam.numeric.piecewise import Piece, integrate
from gearcam.quantities import TEXT, param
from gearcam.tolerances import Tolerances


@dataclass(frozen=True, kw_only=True)
class RackLaw:
    """The driver's centrode, or the rack's travel over a turn; either at any scale.

    The rack moves by ``dy = r1*dphi1``, so that ``r1 = y'``; its own centrode is the curve ``(r1,
    y)``, which is straight for a circular wheel only. The law's ratio is r1, its phi2 is y.
    """

    r1: str | None = param(TEXT, default=None, doc="driver centrode's radius over phi1")
    travel: str | None = param(TEXT, default=None, doc="travel of the rack over phi1")

    def problems(self) -> Iterator[tuple[str, int | None, str, str]]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        if (self.r1 is None) == (self.travel is None):
            state = "neither r1 nor travel is given" if self.r1 is None else "both are given"
            yield "r1", None, state, "exactly one of r1, travel"
            return
        name = "r1" if self.travel is None else "travel"
        yield from formula_problems(name, getattr(self, name))

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:  # noqa: ARG002
        """Return the law to `tolerances`; the rack may have any number of teeth.

        Raises
        ------
        InfeasibleError
            Where the radius is not finite, smooth, positive or periodic.
        """
        turn = 2.0 * math.pi
        if self.travel is not None:
            travel = compiled(self.travel)
            piece = Piece(derivative(travel), travel)
        else:
            piece = Piece(compiled(self.r1 or "1"))
        places = np.linspace(0.0, turn, PLACES)
        values = values_of(piece.function)(places)
        for bad in np.flatnonzero(~np.isfinite(values))[:1]:
            raise InfeasibleError("r1 is not finite", where=angle_text(float(places[bad])))
        with demand_smooth("r1"):
            advance = integrate([0.0, turn], [piece], tolerances.expansion).last
        return make_law(RackTravel(turn, advance), [0.0, turn], [piece], tolerances)


LAWS.register(
    LawEntry(
        name="rack",
        example=RackLaw(r1="1 + 0.2*cos(phi1)"),
        doc="a wheel that drives a rack, by its centrode or by the rack's travel",
        continuity="analytic where the formula is",
        source="003 fig. 1.8; rolling on a translated body",
    ),
)
