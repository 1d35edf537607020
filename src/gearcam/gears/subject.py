"""What the checks of a gear pair look at."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from gearcam.gears.pair import ContactArcs, Gear, GearPair, contact_arcs

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

    @cached_property
    def arcs(self) -> tuple[ContactArcs, ContactArcs]:
        """Contact arcs of both sides."""
        return contact_arcs(*self.gears, 1), contact_arcs(*self.gears, -1)

    @property
    def contact_ratio(self) -> float:
        """Smallest contact ratio of any flank, both sides."""
        return min(float(arcs.ratios.min()) for arcs in self.arcs)
