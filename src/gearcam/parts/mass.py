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
from functools import singledispatch
from typing import Any, Final

import numpy as np

from gearcam.numeric.contour import Contour, Run
from gearcam.numeric.moments import Moments, curve_moments
from gearcam.parts.body import Body, Edge, Part

_PER_MM3: Final = 1e-9
"""m^3 in a mm^3."""

_TO_GMM: Final = 1e3
"""g mm in a kg mm."""


_FALL: Final = 8.0
"""By what the error of an area falls at least where twice as many points carry it: half of what the
fourth order gives."""

_ENDS: Final = 2
"""Points of one step."""

_ROUNDING: Final = 16.0 * float(np.finfo(float).eps)
"""Of an area."""


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


@singledispatch
def volume_moments(body: Body) -> tuple[Moments, float]:
    """Return the moments of a body's volume; each kind of body registers how.

    Parameters
    ----------
    body : Body
        A part, or another kind that is registered.

    Returns
    -------
    moments : Moments
        Those of the plane regions times their heights: volume, first moments, polar moment.
    height : float, mm^4
        Integral of z.

    Raises
    ------
    TypeError
        If this kind of body is not registered.
    """
    raise TypeError(f"the mass of a {type(body).__name__} is not known")


@volume_moments.register
def _(part: Part) -> tuple[Moments, float]:
    total, height = Moments(), 0.0
    for sign, layers in ((1.0, part.layers), (-1.0, part.pockets)):
        for layer in layers:
            plane = sign * layer.moments
            total = total + layer.height * plane
            height += 0.5 * (layer.high**2 - layer.low**2) * plane.area
    return total, height


def quadrature_error(part: Part) -> float:
    """Return the error of a part's volume, mm^3.

    Cubics through fewer points, by their order. A piece of one step has none fewer: what its cubic
    bows from the chord counts whole, since all its turning may lie at one end.
    """
    return sum(
        layer.height * _area_error(edge)
        for layer in (*part.layers, *part.pockets)
        for edge in (layer.edge, *(opening.shape for opening in layer.openings))
    )


def _area_error(edge: Edge) -> float:
    rounding = _ROUNDING * edge.moments.area
    if not isinstance(edge, Contour):
        return rounding
    pieces = [piece for run in edge.runs for piece in run.pieces]
    fewer = (
        np.vstack([np.vstack([rows[:-1:2], rows[-1:]]) for rows in kept])
        for kept in ([one.points for one in pieces], [one.tangents for one in pieces])
    )
    coarser = abs(curve_moments(*fewer).area - edge.moments.area) / _FALL
    return coarser + sum(_bow(one) for one in pieces if len(one.points) == _ENDS) + rounding


def _bow(step: Run) -> float:
    """Return the area between the cubic of a run of one step and its chord."""
    chord = np.diff(step.points, axis=0)
    straight = np.repeat(chord / np.hypot(*chord.T), _ENDS, axis=0)
    cubic, flat = (curve_moments(step.points, one).area for one in (step.tangents, straight))
    return abs(cubic - flat)


def mass_properties(body: Body, density: float) -> MassProperties:
    """Return the mass properties of a body.

    Parameters
    ----------
    body : Body
        As made: with holes, hubs, marks, its clearance and its rounded edges.
    density : float, kg/m^3
        Of its material.

    Returns
    -------
    MassProperties
        As exact as cubics through the outline's dense points: 1e-9 of the volume, where no corner
        was shortened by a search (see `gears.corners`).
    """
    total, height = volume_moments(body)
    kilograms = density * _PER_MM3
    center = total.first / total.area
    return MassProperties(
        volume=total.area,
        mass=kilograms * total.area,
        centroid=(center.real, center.imag, height / total.area),
        inertia=kilograms * total.polar,
    )
