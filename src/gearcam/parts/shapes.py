"""Exact closed shapes of straight lines and arcs, as drilled, broached or milled.

A *circle* is kept as a circle; a *loop* is a closed bulge polyline. Both have moments in closed
form, and chords within a tolerance.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.bulges import arc_centers, arc_chords, bulge_pieces, flatten_bulges, on_arcs
from gearcam.numeric.contour import Contour, Run
from gearcam.numeric.hermite import on_cubics
from gearcam.numeric.moments import Moments, arc_moments

FEWEST: Final = 12
"""Fewest chords of a circle."""

_BETWEEN: Final = 129
"""Points on the cubic between two dense points, near extremes."""

_DENSE: Final = 1 / 40
"""Chord error of dense points over the tolerance."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Circle(ShortRepr):
    """A full circle.

    Parameters
    ----------
    center : complex, mm
        Its centre.
    diameter : float, mm
        Above 0.

    Raises
    ------
    ValueError
        If the diameter is not positive.
    """

    center: complex
    diameter: float

    def __post_init__(self) -> None:
        if not self.diameter > 0.0:
            raise ValueError(f"the diameter must be positive, not {self.diameter} mm")

    @property
    def moments(self) -> Moments:
        """Moments about the origin."""
        area = 0.25 * math.pi * self.diameter**2
        square = abs(self.center) ** 2 + 0.125 * self.diameter**2
        return Moments(area=area, first=area * self.center, polar=area * square)

    @property
    def reach(self) -> float:
        """Largest distance from the origin, mm."""
        return abs(self.center) + 0.5 * self.diameter

    @property
    def length(self) -> float:
        """Circumference, mm."""
        return math.pi * self.diameter

    def polyline(self, sagitta: float) -> Plane:
        """Return points, complex, mm, counter-clockwise, with chords of at most `sagitta`, mm."""
        count = circle_segments(self.diameter, sagitta)
        angle = 2 * math.pi * np.arange(count) / count
        spokes = np.cos(angle) + 1j * np.sin(angle)
        return np.asarray(self.center + 0.5 * self.diameter * spokes, dtype=np.complex128)

    def contour(self, tolerance: float) -> Contour:
        """Return the circle as a contour of four runs, within a `tolerance`, mm."""
        radius = 0.5 * self.diameter
        points = np.array([self.center + way * radius for way in (1.0, 1j, -1.0, -1j)])
        quarter = np.full(4, math.tan(math.pi / 8.0))
        return Loop(points=points, bulges=quarter).contour(tolerance)


@dataclass(frozen=True, eq=False, kw_only=True)
class Loop(ShortRepr):
    """A closed chain of straight lines and arcs, counter-clockwise.

    Parameters
    ----------
    points : (k,) complex array, mm
        The first is not repeated.
    bulges : (k,) array
        Tangent of a quarter of the angle of each arc, 0 for straight pieces.

    Raises
    ------
    ValueError
        If the loop runs clockwise.
    """

    points: Plane
    bulges: Array

    def __post_init__(self) -> None:
        if not self.moments.area > 0.0:
            raise ValueError("a loop must run counter-clockwise")

    @cached_property
    def moments(self) -> Moments:
        """Moments about the origin."""
        return arc_moments(self.points, self.bulges)

    @property
    def reach(self) -> float:
        """Largest distance from the origin, mm: of an end, or of an arc's farthest point."""
        start, chord, bends = bulge_pieces(self.points, self.bulges, closed=True)
        bent = bends != 0.0
        start, chord, bends = start[bent], chord[bent], bends[bent]
        center = arc_centers(start, chord, bends)
        away, radius = np.abs(center), np.abs(center - start)
        toward = np.divide(center, away, out=np.ones_like(center), where=away > 0.0)
        # an arc that turns left lies to the right of its chord
        side = (np.conj(chord) * (center + radius * toward - start)).imag * bends
        arcs = np.where(side < 0.0, away + radius, 0.0)
        return float(max(np.abs(self.points).max(), arcs.max(initial=0.0)))

    @property
    def length(self) -> float:
        """Length of the boundary, mm."""
        chords = np.abs(np.roll(self.points, -1) - self.points)
        half = 2.0 * np.arctan(self.bulges)
        return float((chords / np.sinc(half / np.pi)).sum())

    def polyline(self, sagitta: float) -> Plane:
        """Return points on the loop, complex, mm, with chords of at most `sagitta`, mm."""
        return flatten_bulges(self.points, self.bulges, sagitta)

    def contour(self, tolerance: float) -> Contour:
        """Return the loop as a contour within a `tolerance`, mm, with a run for each piece."""
        return Contour(
            dense=lambda: tuple(self._runs(_DENSE * tolerance)),
            points=self.polyline(tolerance),
            tolerance=tolerance,
            chord_error=tolerance,
        )

    def _runs(self, sagitta: float) -> Iterator[Run]:
        pieces = bulge_pieces(self.points, self.bulges, closed=True)
        counts = arc_chords(*pieces[1:], sagitta)
        for start, chord, bend, count in zip(*pieces, counts, strict=True):
            way, slope = on_arcs(chord, bend, np.linspace(0.0, 1.0, count + 1))
            way[-1] = chord
            yield Run(points=start + way, tangents=slope / np.abs(slope))


def circle_segments(diameter: float, sagitta: float) -> int:
    """Return the number of chords that a circle needs.

    Parameters
    ----------
    diameter : float, mm
        Diameter of the circle.
    sagitta : float, mm
        Largest distance of a chord from the circle.

    Returns
    -------
    int
        Even, at least 12.
    """
    ratio = min(sagitta / diameter, 0.5)
    # Sagitta of n chords: (d/2)*(1 - cos(pi/n)) = d*sin(pi/(2n))^2.
    return max(FEWEST, 2 * math.ceil(math.pi / (4 * math.asin(math.sqrt(ratio)))))


def true_points(edges: Iterable[Contour | Circle]) -> Plane:
    """Return points on true edges, complex, mm: dense, and much denser at extreme points.

    Extremes along x and y and of the distance from the origin are exact to 1e-8 mm: between dense
    points the curve is a cubic with the tangents at its ends. For circles only the extremes along x
    and y are returned.
    """
    return np.concatenate([_points(edge) for edge in edges])


def _points(edge: Contour | Circle) -> Plane:
    if isinstance(edge, Circle):
        radius = 0.5 * edge.diameter
        return np.array([edge.center + way * radius for way in (1.0, 1j, -1.0, -1j)])
    runs = edge.runs
    points = np.concatenate([run.points for run in runs])
    tangents = np.concatenate([run.tangents for run in runs])
    extremes = {
        int(pick(values))
        for values in (points.real, points.imag, np.abs(points))
        for pick in (np.argmin, np.argmax)
    }
    starts = np.cumsum([0, *(len(run.points) for run in runs)])
    # no curve between the last point of a run and the first of the next
    firsts = [
        first
        for place in sorted(extremes)
        for first in (place - 1, place)
        if first >= 0 and first + 1 not in starts
    ]
    share = np.tile(np.linspace(0.0, 1.0, _BETWEEN), len(firsts))
    between, _ = on_cubics(points, tangents, np.repeat(firsts, _BETWEEN), share)
    return np.concatenate([points, between])


def extremes(points: Plane) -> tuple[complex, complex, complex, complex]:
    """Return the leftmost, lowest, rightmost and highest of some points, complex, mm."""
    x, y = points.real, points.imag
    left, low, right, high = points[[x.argmin(), y.argmin(), x.argmax(), y.argmax()]].tolist()
    return left, low, right, high
