"""Moments of plane regions: area, first moments and polar moment, from their boundaries.

For a homogeneous function f of degree k, ``integral of f dA = 1/(k + 2) * integral of f*(x dy - y
dx)`` around the boundary (Green). Curves are integrated piece by piece: arcs by Gauss-Legendre
points that are exact to rounding, sampled curves by the cubics through their points and tangents.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.bulges import bulge_pieces, on_arcs
from gearcam.numeric.gauss import gauss_rule
from gearcam.numeric.hermite import hermite_arms, hermite_cubic

_ON_ARC: Final = 16
"""Gauss points of an arc up to a half circle: exact to rounding."""

_ON_CUBIC: Final = 3
"""Gauss points of a sampled curve's step: error far below the chord error."""

_LEAST_FALL, _FALL = 4.0, 16.0
"""Least and largest factor by which twice as many points reduce the error of a sampled curve: of
second order at sharp bends, of fourth order otherwise."""

_BLOCK: Final = 1 << 12
"""Steps integrated at once: they stay in the processor's first cache."""

_SAFE: Final = 1.5
"""Error over the change by one more doubling: all further ones add up to a third."""


@dataclass(frozen=True, kw_only=True)
class Moments(ShortRepr):
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


def arc_moments(points: Plane, bulges: Array) -> Moments:
    """Return the moments inside a closed bulge polyline.

    Parameters
    ----------
    points : (k,) complex array, mm
        Counter-clockwise, first not repeated; no arc beyond a half circle.
    bulges : (k,) array
        Bulges (see `numeric.bulges`).

    Returns
    -------
    Moments
        Exact to rounding.
    """
    start, chord, bends = bulge_pieces(points, bulges, closed=True)
    place, weight = gauss_rule(_ON_ARC)
    way, speed = on_arcs(chord, bends, place[:, None])
    return _moments(_swept(start + way, speed, weight).sum(axis=1))


def curve_moments(points: Plane, tangents: Plane) -> Moments:
    """Return the contribution of an open curve to the moments of the region that it bounds.

    Parameters
    ----------
    points : (n,) complex array, mm
        Dense points of a smooth curve, forward along the boundary.
    tangents : (n,) complex array
        Unit tangents.

    Returns
    -------
    Moments
        Only the sum over a closed chain is meaningful.
    """
    return _moments(_on_cubics(points, tangents).sum(axis=1))


def halving(points: Plane, tangents: Plane, middles: Plane, between: Plane) -> float:
    """Return the change of the area at a sampled curve if its steps are halved, mm^2.

    Parameters
    ----------
    points, tangents : (n,) complex arrays, mm and 1
        Of a smooth curve, with unit tangents.
    middles, between : (n - 1,) complex arrays, mm and 1
        The same inside each step.

    Returns
    -------
    float
        Sum of absolute changes of the steps.
    """
    p, t = (
        np.append(np.column_stack([one[:-1], inside]).ravel(), one[-1])
        for one, inside in ((points, middles), (tangents, between))
    )
    whole, parts = (_on_cubics(*one)[0].real for one in ((points, tangents), (p, t)))
    return float(np.abs(parts.reshape(-1, 2).sum(axis=1) - whole).sum())


def area_error(curves: Sequence[tuple[Plane, Plane]]) -> float:
    """Return the error of the area at sampled curves, mm^2.

    Parameters
    ----------
    curves : sequence of (points, tangents)
        Smooth curves, each as for `curve_moments`. Curves of a single step are ignored.

    Returns
    -------
    float
        Sum over curves of the absolute change from every second point to all points, extrapolated
        by the decrease from every fourth to every second.
    """
    all_of, half, quarter = (_by_curve(curves, every) for every in (1, 2, 4))
    change = np.abs(half - all_of)
    before = np.abs(quarter - half)
    fall = np.clip(before / np.where(change > 0.0, change, 1.0), _LEAST_FALL, _FALL)
    return float((_SAFE * change / fall).sum())


def _by_curve(curves: Sequence[tuple[Plane, Plane]], every: int) -> Array:
    """Return the area at each curve from some of its points."""
    kept = [np.append(np.arange(0, len(points) - 1, every), -1) for points, _ in curves]
    some = [(points[k], tangents[k]) for (points, tangents), k in zip(curves, kept, strict=True)]
    found = _on_cubics(*(np.concatenate(one) for one in zip(*some, strict=True)))[0].real
    starts = np.cumsum([0, *(len(k) for k in kept)])
    found[starts[1:-1] - 1] = 0.0  # from one curve to the next
    return np.asarray(np.add.reduceat(found, starts[:-1]))


def _on_cubics(p: Plane, u: Plane) -> Plane:
    """Return area, first and polar moment of each step of a sampled curve, (3, n - 1)."""
    place, weight = gauss_rule(_ON_CUBIC)
    found = np.empty((3, len(p) - 1), dtype=np.complex128)
    for begin in range(0, len(p) - 1, _BLOCK):
        q, t = (one[begin : begin + _BLOCK + 1] for one in (p, u))
        arms = hermite_arms(q, t)
        way, slope = hermite_cubic(np.diff(q), t[:-1] * arms, t[1:] * arms, place[:, None])
        found[:, begin : begin + _BLOCK] = _swept(q[:-1] + way, slope, weight)
    return found


def _swept(points: Plane, speed: Plane, weight: Array) -> Plane:
    """Return area, first and polar moment of each piece of a boundary, (3, n)."""
    swept = weight[:, None] * (np.conj(points) * speed).imag
    square = points.real**2 + points.imag**2
    return np.stack(
        [
            0.5 * swept.sum(axis=0) + 0j,
            (points * swept).sum(axis=0) / 3.0,
            0.25 * (square * swept).sum(axis=0) + 0j,
        ]
    )


def _moments(sums: Plane) -> Moments:
    area, first, polar = sums
    return Moments(area=float(area.real), first=complex(first), polar=float(polar.real))
