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

from gearcam.numeric.contour import Contour
from gearcam.numeric.moments import Moments, curve_errors
from gearcam.parts.body import Body, Edge, Part

_PER_MM3: Final = 1e-9
"""m^3 in a mm^3."""

_TO_GMM: Final = 1e3
"""g mm in a kg mm."""


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


def quadrature_error(part: Part) -> Moments:
    """Return the errors of a part's moments (see `numeric.moments.curve_errors`)."""
    return sum(
        (
            layer.height * _missed(edge)
            for layer in (*part.layers, *part.pockets)
            for edge in layer.edges
        ),
        start=Moments(),
    )


def _missed(edge: Edge) -> Moments:
    rounding = _ROUNDING * error_of(edge.moments)
    if not isinstance(edge, Contour):
        return rounding
    pieces = [piece for run in edge.runs for piece in run.pieces]
    return curve_errors([(one.points, one.tangents) for one in pieces]) + rounding


def error_of(difference: Moments) -> Moments:
    """Return what moments are off by, from a difference: no part of it below zero."""
    return Moments(
        area=abs(difference.area),
        first=complex(abs(difference.first)),
        polar=abs(difference.polar),
    )


def mass_errors(part: Part, missed: Moments, density: float) -> dict[str, float]:
    """Return the errors of a part's mass properties.

    Parameters
    ----------
    part : Part
        As made.
    missed : Moments
        What the moments of its volume are off by, none below zero; in its steps alike.
    density : float, kg/m^3
        Of its material.

    Returns
    -------
    dict
        Of volume, centroid and inertia, named as `MassProperties.as_dict` names them; the mass is
        off by the share of the volume.
    """
    made = mass_properties(part, density)
    middles = [0.5 * (step.low + step.high) for step in part.steps]
    off = max(abs(middle - made.centroid[2]) for middle in middles)
    tilt = math.hypot(missed.first.real + made.eccentricity * missed.area, off * missed.area)
    return {
        "volume_mm3": missed.area,
        "centroid_mm": tilt / made.volume,
        "inertia_kg_mm2": density * _PER_MM3 * missed.polar,
    }


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
        As exact as cubics through the outline's dense points (see `quadrature_error`).
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
