"""Moments of plane regions: area, first moments and polar moment, from their boundaries.

For a homogeneous function f of degree k, ``integral of f dA = 1/(k + 2) * integral of f*(x dy - y
dx)`` around the boundary (Green). Curves are integrated piece by piece: arcs by Gauss-Legendre
points that are exact to rounding, sampled curves by the cubics through their points and tangents.

Points are complex numbers inside this room.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.display import Brief
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.bulges import as_complex, bulge_pieces, on_arcs
from gearcam.numeric.hermite import hermite_arms, hermite_cubic

_ON_ARC: Final = 16
"""Gauss points of an arc up to a half circle: rounding."""

_ON_CUBIC: Final = 3
"""Gauss points of a sampled curve's step: far below the chord error of its points."""


@dataclass(frozen=True, kw_only=True)
class Moments(Brief):
    """Integrals over a region, about the origin; regions add and subtract.

    Parameters
    ----------
    area : float, mm^2
        Integral of 1.
    first : complex, mm^3
        Integral of x + iy.
    polar : float, mm^4
        Integral of x^2 + y^2.
    """

    area: float = 0.0
    first: complex = 0j
    polar: float = 0.0

    def __add__(self, other: Moments) -> Moments:
        return Moments(
            area=self.area + other.area,
            first=self.first + other.first,
            polar=self.polar + other.polar,
        )

    def __sub__(self, other: Moments) -> Moments:
        return self + -1.0 * other

    def __rmul__(self, factor: float) -> Moments:
        return Moments(
            area=factor * self.area, first=factor * self.first, polar=factor * self.polar
        )


def arc_moments(vertices: Array, bulges: Array) -> Moments:
    """Return the moments inside a closed bulge polyline.

    Parameters
    ----------
    vertices : (k, 2) array, mm
        Counter-clockwise, first not repeated; no arc beyond a half circle.
    bulges : (k,) array
        Bulges (see `numeric.bulges`).

    Returns
    -------
    Moments
        Exact to rounding.
    """
    start, chord, bends = bulge_pieces(vertices, bulges, closed=True)
    place, weight = _gauss(_ON_ARC)
    way, speed = on_arcs(chord, bends, place[:, None])
    return _integrate(start + way, speed, weight)


def curve_moments(points: Array, tangents: Array) -> Moments:
    """Return what an open curve adds to the moments of the region that it bounds.

    Parameters
    ----------
    points : (n, 2) array, mm
        Dense points of a smooth curve, forward along the boundary.
    tangents : (n, 2) array
        Unit tangents.

    Returns
    -------
    Moments
        Only the sum over a closed chain has a meaning.
    """
    p, u = as_complex(points), as_complex(tangents)
    chord = np.diff(p)
    place, weight = _gauss(_ON_CUBIC)
    arms = hermite_arms(p, u)
    way, slope = hermite_cubic(chord, u[:-1] * arms, u[1:] * arms, place[:, None])
    return _integrate(p[:-1] + way, slope, weight)


def _gauss(count: int) -> tuple[Array, Array]:
    """Places and weights on [0, 1]."""
    place, weight = np.polynomial.legendre.leggauss(count)
    return 0.5 * (place + 1.0), 0.5 * weight


def _integrate(points: Plane, speed: Plane, weight: Array) -> Moments:
    swept = weight[:, None] * (np.conj(points) * speed).imag
    square = points.real**2 + points.imag**2
    return Moments(
        area=0.5 * float(swept.sum()),
        first=complex((points * swept).sum()) / 3.0,
        polar=0.25 * float((square * swept).sum()),
    )
