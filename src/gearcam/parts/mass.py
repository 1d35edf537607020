"""Mass properties of parts: mass, centroid, unbalance and inertia; and the facts of a part.

The centroid of a non-circular wheel is off its shaft; the *unbalance* is mass times that distance.
All properties follow from moments of plane regions (see `numeric.moments`) times their heights.

Depends on parts' shapes and numeric.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import singledispatch
from typing import Any, Final

import numpy as np

from gearcam.base.facts import Fact
from gearcam.base.numerals import formatted
from gearcam.numeric.contour import Contour
from gearcam.numeric.moments import Moments, area_error
from gearcam.parts.body import Body, Edge, Layer, Part, Stack
from gearcam.parts.tools import ToolLimits

_PER_MM3: Final = 1e-9
"""m^3 in a mm^3."""

_TO_GMM: Final = 1e3
"""g mm in a kg mm."""


_ROUNDING: Final = 16.0 * float(np.finfo(float).eps)
"""Moments of an area."""


@dataclass(frozen=True, kw_only=True)
class MassProperties:
    """Mass properties of a part about its shaft.

    Parameters
    ----------
    volume : float, mm^3
        Volume of the part.
    mass : float, kg
        Mass of the part.
    centroid : (float, float, float), mm
        In the part's frame; z = 0 is the back of the toothed plate.
    inertia : float, kg mm^2
        Moment of inertia about the axis.
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
        """Return the properties as JSON data, in the units of their names."""
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
    """Return the moments of a body's volume; dispatched on the type of the body.

    Parameters
    ----------
    body : Body
        A part, or another registered type.

    Returns
    -------
    moments : Moments
        Sums over plane regions times their heights: volume, first moments, polar moment.
    height : float, mm^4
        Integral of z.

    Raises
    ------
    TypeError
        If this type of body is not registered.
    """
    raise TypeError(f"the mass of a {type(body).__name__} cannot be computed")


@volume_moments.register(Part)
@volume_moments.register(Stack)
def _(body: Part | Stack) -> tuple[Moments, float]:
    total, height = Moments(), 0.0
    for layer, plane in _planes(body):
        total = total + layer.height * plane
        height += 0.5 * (layer.high**2 - layer.low**2) * plane.area
    return total, height


def _planes(body: Part | Stack) -> Iterator[tuple[Layer, Moments]]:
    """Yield the layers of a body and its pockets with their plane moments, negative of pockets."""
    for sign, layers in ((1.0, body.layers), (-1.0, body.pockets)):
        for layer in layers:
            yield layer, sign * layer.moments


def products_of_inertia(body: Part | Stack, density: float) -> complex:
    """Return the products of inertia of a body that make an unbalance act out of one plane.

    Parameters
    ----------
    body : Part or Stack
        The finished body.
    density : float, kg/m^3
        Of its material.

    Returns
    -------
    complex, kg mm^2
        Integral of z*(x + iy) over its mass: its unbalance times the height where it acts.
    """
    lever = sum(
        0.5 * (layer.high**2 - layer.low**2) * plane.first for layer, plane in _planes(body)
    )
    return density * _PER_MM3 * lever


def quadrature_error(part: Part) -> float:
    """Return the error of a part's volume, mm^3, from sampled edges (see `area_error`)."""
    return sum(bevel.uneven * bevel.height for bevel in part.bevels) + sum(
        layer.height * _missed(edge)
        for layer in (*part.layers, *part.pockets)
        for edge in layer.edges
    )


def _missed(edge: Edge) -> float:
    rounding = _ROUNDING * abs(edge.moments.area)
    if not isinstance(edge, Contour):
        return rounding
    pieces = [piece for run in edge.runs for piece in run.pieces]
    return area_error([(one.points, one.tangents) for one in pieces]) + rounding


def mass_properties(body: Body, density: float) -> MassProperties:
    """Return the mass properties of a body.

    Parameters
    ----------
    body : Body
        The finished body: with holes, hubs, marks, clearance and rounded edges.
    density : float, kg/m^3
        Density of its material.

    Returns
    -------
    MassProperties
        From cubics through the outline's dense points (see `quadrature_error`).
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


def size_fact(extents: Sequence[float], name: str) -> Fact:
    """Return the overall size of a part as a fact.

    Parameters
    ----------
    extents : sequence of 3 floats, mm
        Along x, y and z of the part's own frame.
    name : str
        Name of the part in messages, such as ``wheel 1``; empty for a single part.

    Returns
    -------
    Fact
        Shown to hundredths of a millimetre.
    """
    meaning = f"overall size of {name}" if name else "overall size"
    text = " x ".join(formatted(round(one, 2), 9) for one in extents)
    return Fact([float(one) for one in extents], meaning, text=text, shown=True)


def part_facts(part: Part, name: str, tools: ToolLimits, density: float | None) -> dict[str, Any]:
    """Return the facts of a part.

    Parameters
    ----------
    part : Part
        The finished part.
    name : str
        Its name in messages (see `size_fact`).
    tools : ToolLimits
        The largest tools for it.
    density : float or None, kg/m^3
        With a density the mass properties are included.

    Returns
    -------
    dict
        Facts that exist.
    """
    made: dict[str, Any] = {
        "size_mm": size_fact(part.size, name),
        "tool": tools.as_dict(),
        "openings": [opening.as_dict() for opening in part.openings],
    }
    if density is not None:
        made["density_kg_m3"] = density
        mass = mass_properties(part, density).as_dict()
        about = () if part.turns else ("unbalance_g_mm", "unbalance_direction_deg")
        made["mass"] = {name: value for name, value in mass.items() if name not in about}
    return {name: value for name, value in made.items() if value}
