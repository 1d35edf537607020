"""What the checks of a gear pair look at."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gearcam.gears.pair import ContactArcs, Gear, GearPair, contact_arcs
from gearcam.numeric.piecewise import extremes

Array = NDArray[np.float64]

KIND = "gear-pair"


@dataclass(frozen=True, eq=False, kw_only=True)
class Subject:
    """A pair as built, for checks.

    Parameters
    ----------
    pair : GearPair
        Centrodes and cutters.
    gears : (Gear, Gear)
        Both wheels.
    bores : (float or None, float or None), mm
        Bore diameters.
    backlash : float, mm
        Backlash along the pitch curve.
    """

    pair: GearPair
    gears: tuple[Gear, Gear]
    bores: tuple[float | None, float | None]
    backlash: float

    def with_teeth(self, factor: float) -> str:
        """Return in words with how many teeth, in the same ratio, all is `factor` times as wide."""
        common = math.gcd(*self.pair.teeth)
        each = math.ceil(common * factor * (1.0 + 1e-9))
        counts = ", ".join(str(count // common * each) for count in self.pair.teeth)
        return f"With pair.teeth = [{counts}] or more"

    @cached_property
    def slopes(self) -> tuple[Array, Array]:
        """Extremes of the centrodes' slope psi, ``tan(psi) = r1'/r1``: phi1, rad, and psi, rad."""
        law = self.pair.law

        def slope(phi: Array) -> tuple[Array, Array]:
            i, di, ddi = law.ratio.derivatives(phi, 2)
            factor = 1.0 if law.feeds else 1.0 / (1.0 + i)
            tangent = di / i * factor  # r1'/r1
            bend = ddi / i * factor - tangent * tangent
            if not law.feeds:
                bend = bend - 2.0 * di * di / i * factor * factor
            return np.arctan(tangent)[None], (bend / (1.0 + tangent * tangent))[None]

        ((places, values),) = extremes(slope, law.knots)
        return places, values

    @cached_property
    def accelerations(self) -> tuple[Array, Array]:
        """Extremes of ``d(i21)/dphi1``: phi1, rad, and values; of a rack over its mean speed."""
        law = self.pair.law
        scale = law.lobes.period / law.lobes.advance if law.feeds else 1.0

        def change(phi: Array) -> tuple[Array, Array]:
            _, di, ddi = law.ratio.derivatives(phi, 2)
            return scale * di[None], scale * ddi[None]

        ((places, values),) = extremes(change, law.knots)
        return places, values

    @cached_property
    def arcs(self) -> tuple[ContactArcs, ContactArcs]:
        """Contact arcs of both sides."""
        return contact_arcs(*self.gears, 1), contact_arcs(*self.gears, -1)

    @property
    def contact_ratio(self) -> float:
        """Smallest contact ratio of any flank, both sides."""
        return min(float(arcs.ratios.min()) for arcs in self.arcs)
