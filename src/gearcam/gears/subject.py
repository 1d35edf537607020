"""The input of a gear pair's checks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.base.findings import ROUNDING, check
from gearcam.base.quantities import NUMBER, Param
from gearcam.gears.contact import COAST, DRIVE, FlankPairs, flank_pairs
from gearcam.gears.pair import Gear, GearPair
from gearcam.gears.tip_pass import TipPass, tip_pass
from gearcam.numeric.arrays import Array
from gearcam.numeric.piecewise import extremes

KIND = "teeth"
"""Registered checks of a pair's teeth and centrodes."""

pair_check = partial(check, kind=KIND)
"""Decorator that registers a check (see `gearcam.base.findings.check`)."""

CONTACT_RATIO = ("contact_ratio", Param(NUMBER, ge=1, le=3, doc="least contact ratio"), 1.1)
"""Limit of the contact ratio, shared by several checks."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CheckedPair(ShortRepr):
    """A built pair, with what its checks need.

    Parameters
    ----------
    pair : GearPair
        Centrodes and cutters.
    gears : (Gear, Gear)
        Both wheels.
    bores : (float or None, float or None), mm
        Bore diameters.
    rim : float or None, mm
        Least metal outside the roots of a ring.
    across : bool
        Whether the design gives the diameter of its outside, not the metal.
    pins : two float or None, optional, mm
        Pins with which both wheels are measured, if they are: None for the recommended one.
    """

    pair: GearPair
    gears: tuple[Gear, Gear]
    bores: tuple[float | None, float | None]
    rim: float | None = None
    across: bool = False
    pins: tuple[float | None, float | None] | None = None

    @property
    def rims(self) -> list[tuple[float, Gear]]:
        """Metal between bore and root, or outside a ring's roots, mm, each with its wheel."""
        found = [
            (gear.least_radius - 0.5 * bore, gear)
            for gear, bore in zip(self.gears, self.bores, strict=True)
            if bore is not None
        ]
        return found + ([(self.rim, self.gears[1])] if self.rim is not None else [])

    def teeth(self, factor: float) -> list[int]:
        """Return the tooth counts, in the same ratio, that are `factor` times as large."""
        common = math.gcd(*self.pair.teeth)
        each = math.ceil(common * factor * (1.0 + ROUNDING))
        return [count // common * each for count in self.pair.teeth]

    @cached_property
    def slopes(self) -> tuple[Array, Array]:
        """Extremes of the centrodes' slope psi, ``tan(psi) = r1'/r1``: phi1, rad, and psi, rad."""

        def slope(phi: Array) -> tuple[Array, Array]:
            r, dr, ddr = self.pair.rolling.radii(phi, 2)
            bend = (ddr * r - dr * dr) / (r * r + dr * dr)
            return np.arctan(dr / r), bend

        return extremes(slope, self.pair.rolling.cells(self.pair.law.knots), cells=True)

    def pressure_at(self, slope: ArrayLike) -> dict[str, Any]:
        """Return the pressure angles of both directions where the centrode has a `slope` psi, rad.

        The rack's angle and the slope add up: on the flanks that drive forward the angle is
        ``alpha - psi``, on the others ``alpha + psi``, ``tan(psi) = r1'/r1``.
        """
        alpha = self.pair.rack.pressure_angle
        return {"forward": alpha - np.asarray(slope), "backward": alpha + np.asarray(slope)}

    @cached_property
    def pressure_angles(self) -> dict[str, tuple[float, float]]:
        """Largest pressure angle of the flanks by direction of driving: phi1 and angle, rad."""
        places, slopes = self.slopes
        return {
            direction: (float(places[found.argmax()]), float(found.max()))
            for direction, found in self.pressure_at(slopes).items()
        }

    @cached_property
    def accelerations(self) -> tuple[Array, Array]:
        """Extremes of ``d(i21)/dphi1``: phi1, rad, and values; for a rack over its mean speed."""
        law = self.pair.law
        scale = 1.0 / self.pair.rolling.mean_radius

        def change(phi: Array) -> tuple[Array, Array]:
            _, di, ddi = law.ratio.derivatives(phi, 2)
            return scale * di, scale * ddi

        return extremes(change, self.pair.rolling.cells(law.knots), cells=True)

    @cached_property
    def sides(self) -> tuple[FlankPairs, FlankPairs]:
        """Pairs of flanks on the coast and driving sides, at the design centre distance."""
        return flank_pairs(self.gears, COAST), flank_pairs(self.gears, DRIVE)

    @property
    def contact_ratio(self) -> float:
        """Smallest contact ratio of any flank, on both sides."""
        return min(float(pairs.arcs.ratios.min()) for pairs in self.sides)

    @property
    def driven(self) -> bool:
        """Whether flanks touch in every phase, on both sides."""
        return all(bool(pairs.arcs.stretches[2].all()) for pairs in self.sides)

    @cached_property
    def tip_pass(self) -> TipPass | None:
        """Least distance of tips outside the mesh of an internal pair."""
        if not self.pair.internal:
            return None
        wheel, ring = self.gears
        found = tip_pass(wheel.profile, ring.profile)
        return found if found.margin < math.inf else None

    @property
    def backlash(self) -> float:
        """Backlash along the pitch curve with the clearances of both wheels, mm."""
        one, two = (toothing.cutter for toothing in self.pair.toothings)
        return 2.0 * (one.half_space + two.half_space) - one.pitch
