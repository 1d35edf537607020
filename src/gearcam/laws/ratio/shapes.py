"""Centrodes in pieces: closed B-splines of the radius, and polygons with rounded corners."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import beyond_limit
from gearcam.base.quantities import COUNT, NUMBER, Row, param
from gearcam.base.tolerances import Tolerances
from gearcam.laws.entry import LawEntry
from gearcam.laws.ratio.base import RatioLaw, make_law
from gearcam.laws.ratio.driver import law_of_centrode
from gearcam.laws.ratio.span import WHEEL, Lobes
from gearcam.numeric.chebyshev import NotSmoothError, expand
from gearcam.numeric.jets import Jet, Value, cos, polynomial, sin, sqrt
from gearcam.numeric.piecewise import Piece, piecewise
from gearcam.numeric.roots import bracketed_root


@dataclass(frozen=True, kw_only=True)
class BSplineLaw(ShortRepr):
    """The radius as a closed uniform cubic B-spline of control values over phi1.

    Control value k belongs to the angle ``k/n`` of a lobe; the curve stays within neighbouring
    control values, each of which changes the centrode only near its angle.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.BSplineLaw(radii=(2.0, 2.1, 2.3, 2.1))
    >>> pair = gc.PairSpec(teeth=(30, 30), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="spline", law=law, pair=pair))
    >>> result.motion([0.0, 1.0])["ratio"].round(4)
    array([0.9154, 0.9471])
    """

    radii: Row = param(
        NUMBER, gt=0, min_length=4, doc="control radii at equal angles over a lobe, at any scale"
    )

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`."""
        count = len(self.radii)
        knots = np.linspace(0.0, lobes.period, count + 1)
        control = np.array(self.radii)
        # powers of the distance from the knot before (rows) of four control values (columns)
        basis = np.array([[1, 4, 1, 0], [-3, 0, 3, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) / 6.0
        scale = (count / lobes.period) ** np.arange(4)

        def segment(k: int) -> Piece:
            powers = scale * (basis @ control[np.arange(k - 1, k + 3) % count])
            return Piece(polynomial, parameters=(float(knots[k]), *powers.tolist()))

        return law_of_centrode([segment(k) for k in range(count)], knots, lobes, tolerances)


@dataclass(frozen=True, kw_only=True)
class RoundedPolygon(ShortRepr):
    """A regular polygon whose corners are arcs; phi1 = 0 at the middle of a side.

    With the corner radius c and the distance h of a side from the shaft, both over the centre
    distance, the sides are ``h/cos(phi1)`` and the corners circles of radius c about a point at
    ``d = (h - c)/cos(pi/n)``. Closure gives h.

    Examples
    --------
    >>> import gearcam as gc
    >>> law = gc.laws.RoundedPolygon(corners=4, corner_radius=0.2)
    >>> pair = gc.PairSpec(teeth=(40, 40), module=2.0)
    >>> result = gc.build(gc.GearPairDesign(name="square", law=law, pair=pair))
    >>> result.motion([0.0, 1.0])["ratio"].round(4)
    array([0.8229, 1.1391])
    """

    corners: int = param(COUNT, ge=3, le=100, doc="corners of the driver, a multiple of its lobes")
    corner_radius: float = param(NUMBER, gt=0, le=100, doc="corner radius over the centre distance")

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If the corners do not fit the lobes of the tooth counts, or are too round.
        """
        if self.corners % lobes.n1:
            what = "the corners do not fit the tooth counts"
            note = f"the tooth counts need a multiple of {lobes.n1}"
            near = max(1, round(self.corners / lobes.n1)) * lobes.n1
            raise beyond_limit(
                what, "law.corners", float(self.corners), float(lobes.n1), note, near=near
            )
        largest = lobes.n1 / (lobes.n2 + lobes.mate * lobes.n1)
        if not self.corner_radius < largest:
            what = "the corner radius is larger than that of a circular wheel"
            note = "the limit is the radius of a circular wheel over the centre distance"
            raise beyond_limit(
                what, "law.corner_radius", self.corner_radius, largest, note, far=0.2 * largest
            )
        height = self._side(lobes, largest)
        knots, pieces = self._pieces(height, lobes.mate)
        repeats = self.corners // lobes.n1
        sector = 2.0 * math.pi / self.corners
        grid = np.concatenate([knots[:-1] + k * sector for k in range(repeats)])
        moved = [
            replace(piece, parameters=(piece.parameters[0] + k * sector,))
            for k in range(repeats)
            for piece in pieces
        ]
        solved = {"side_distance_over_center_distance": height}
        return make_law(lobes, np.append(grid, lobes.period), moved, tolerances, solved)

    def _pieces(self, h: float, mate: int) -> tuple[np.ndarray, list[Piece]]:
        """Return knots and ratios of one sector, from the middle of a side to that of the next.

        The parameter of a piece is its angle of symmetry.
        """
        half = math.pi / self.corners
        c, d = self.corner_radius, (h - self.corner_radius) / math.cos(half)
        turn = math.atan2((h - c) * math.tan(half), h)

        def side(x: Jet, middle: Value) -> Jet:
            return h / (cos(x - middle) - mate * h)

        def corner(x: Jet, middle: Value) -> Jet:
            across = d * sin(x - middle)
            radius = d * cos(x - middle) + sqrt(c * c - across * across)
            return radius / (1.0 - mate * radius)

        knots = np.array([0.0, turn, 2.0 * half - turn, 2.0 * half])
        shapes = ((side, 0.0), (corner, half), (side, 2.0 * half))
        return knots, [Piece(shape, parameters=(middle,)) for shape, middle in shapes]

    def _side(self, lobes: Lobes, largest: float) -> float:
        """Return h that closes the driven wheel; the driven angle grows with h.

        In a ring any h is possible up to `largest`, that of a circular wheel.
        """
        highest = largest
        if lobes.mate == WHEEL:  # at the limit the corner reaches the other shaft: d + c = 1
            half = math.pi / self.corners
            highest = self.corner_radius + (1.0 - self.corner_radius) * math.cos(half)

        def excess(heights: np.ndarray) -> np.ndarray:
            knots, pieces = self._pieces(float(heights), lobes.mate)
            try:
                driven = expand(piecewise(knots, pieces), knots, 0.0).antiderivative().last
            except NotSmoothError:
                driven = math.inf  # a corner too close to the other shaft
            return np.array(driven - 2.0 * math.pi / self.corners * lobes.n1 / lobes.n2)

        # not a circle, which has no sides, nor a corner that meets the other shaft
        low = np.array(self.corner_radius * (1.0 + 1e-12))
        high = np.array(highest - 1e-6 * (highest - self.corner_radius))
        return float(bracketed_root(excess, low, high, 1e-16))


ENTRIES: Final = (
    LawEntry(
        name="bspline",
        example=BSplineLaw(radii=(2.0, 2.0, 2.0, 2.0)),
        doc="the driver's radius as a closed cubic B-spline of control values",
        continuity="C2",
        source="Niculescu, section 1.2; de Boor",
    ),
    LawEntry(
        name="rounded-polygon",
        example=RoundedPolygon(corners=4, corner_radius=1 / 6),
        doc="a regular polygon with rounded corners; phi1 = 0 at the middle of a side",
        continuity="C1: the curvature jumps from sides to corners",
        source="Niculescu, fig. 1.7 (square wheels)",
    ),
)
