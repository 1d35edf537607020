"""Mass properties of parts: mass, centroid, unbalance and inertia of a wheel as it is made.

A non-circular wheel is eccentric by nature: its centroid is off its shaft, and the *unbalance* is
mass times that distance. Everything follows from moments of plane regions (see
`numeric.moments`), each over its height.

Depends on parts' shapes and numeric.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from gearcam.numeric.moments import Moments

if TYPE_CHECKING:
    from gearcam.parts.part import Part

_PER_MM3: Final = 1e-9
"""m^3 in a mm^3."""

_TO_GMM: Final = 1e3
"""g mm in a kg mm."""


@dataclass(frozen=True, kw_only=True)
class MassProperties:
    """What a balancing engineer asks for, about the shaft.

    Parameters
    ----------
    volume : float, mm^3
        Of the part.
    mass : float, kg
        Of the part.
    centroid : (float, float, float), mm
        In the part's frame; z = 0 is the back of the toothed plate.
    inertia : float, kg mm^2
        About the axis.
    """

    volume: float
    mass: float
    centroid: tuple[float, float, float]
    inertia: float

    @property
    def eccentricity(self) -> float:
        """Distance of the centroid from the axis, mm."""
        return math.hypot(*self.centroid[:2])

    @property
    def unbalance(self) -> float:
        """Static unbalance: mass times eccentricity, g mm."""
        return self.mass * self.eccentricity * _TO_GMM

    @property
    def direction(self) -> float:
        """Polar angle of the centroid, rad, in the part's frame."""
        return cmath.phase(complex(*self.centroid[:2]))

    def as_dict(self) -> dict[str, Any]:
        """Return the properties for JSON, in the units that the keys name."""
        return {
            "volume_mm3": self.volume,
            "mass_kg": self.mass,
            "centroid_mm": list(self.centroid),
            "unbalance_g_mm": self.unbalance,
            "unbalance_direction_deg": math.degrees(self.direction),
            "inertia_kg_mm2": self.inertia,
        }


def volume_moments(part: Part) -> tuple[Moments, float]:
    """Return the moments of a part's volume.

    Parameters
    ----------
    part : Part
        The part.

    Returns
    -------
    moments : Moments
        Those of the plane regions times their heights: volume, first moments, polar moment.
    height : float, mm^4
        Integral of z.
    """
    total, height = Moments(), 0.0
    for slab in part.slabs:
        plane, low, high = slab
        total = total + (high - low) * plane
        height += 0.5 * (high**2 - low**2) * plane.area
    return total, height


def mass_properties(part: Part, density: float) -> MassProperties:
    """Return the mass properties of a part.

    Parameters
    ----------
    part : Part
        The part, as made: with holes, hubs, marks, its clearance and its rounded edges.
    density : float, kg/m^3
        Of its material.

    Returns
    -------
    MassProperties
        As exact as the outline's dense points: better than 1e-9 of the volume.
    """
    total, height = volume_moments(part)
    kilograms = density * _PER_MM3
    center = total.first / total.area
    return MassProperties(
        volume=total.area,
        mass=kilograms * total.area,
        centroid=(center.real, center.imag, height / total.area),
        inertia=kilograms * total.polar,
    )
