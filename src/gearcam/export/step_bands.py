"""Solids that bands enclose (`gearcam.parts.bands`) as solids of the CAD kernel.

Planes and cylinders are exact; B-splines keep their control points. Faces share their edges: those
between B-splines are edges of both surfaces, those on cylinders B-splines within the body's error.
A cylinder has one face in each sector, a plane one face. Where a ramp vanishes, its face ends in a
point. Every face runs along its first ring, to its second one, and back along that; an edge is so
used once in each direction, and the shell is closed by its making.

Refused: solids that are invalid or have a wrong volume. Depends on bands, numeric and
`step_shapes`; lengths in millimetres.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from gearcam.base.numerals import formatted
from gearcam.export.step_shapes import (
    RESOLUTION,
    occt,
    properties,
    valid_solids,
    with_fittings,
)
from gearcam.numeric.arrays import Array
from gearcam.numeric.nets import SplineNet, spline_breaks, spline_poles
from gearcam.numeric.splines import DEGREE
from gearcam.parts.bands import Band, BandedBody, FlatBand, RoundBand, SplineBand
from gearcam.parts.solids import SolidError

_SAMPLES: Final = 17
"""Points of an edge on a cylinder that is neither a circle nor a straight line."""

_COINCIDENT: Final = 1e-6
"""Distance, mm, within which points are one vertex."""

_SPARE: Final = 0.3
"""Angle, rad, by which the parameter of a cylinder begins before its face."""

_TOLERANCE: Final = 2.0
"""Tolerance of edges on cylinders, over the error of the B-splines."""


@dataclass(frozen=True, eq=False)
class _Edge:
    """An edge: the kernel's, some points of it at parameters, and its ends."""

    edge: Any
    places: Array
    points: Array
    start: Any
    end: Any
    even: bool = False
    """Whether it is a straight line over the parameters of a cylinder, passed at unit speed."""


_Use = tuple[Any, bool, Any]
"""An edge of a face, whether it is passed forwards, and its curve in the surface's parameters."""


def banded_solid(body: BandedBody) -> Any:
    """Return the solid that bands enclose.

    Parameters
    ----------
    body : BandedBody
        The bands.

    Returns
    -------
    TopoDS_Solid

    Raises
    ------
    SolidError
        If it is invalid, or its volume is not that of the body.
    """
    (solid,) = valid_solids(body.name, lambda: [_fitted(body)])
    off = abs(properties(solid).Mass() - body.volume)
    if off > body.volume_error:
        raise SolidError(
            f"{body.name}: the solid's volume is {formatted(off, 3)} mm3 off,"
            f" that of the mesh explains {formatted(body.volume_error, 3)} mm3"
        )
    return solid


def _fitted(body: BandedBody) -> Any:
    made = _Maker(body).solid()
    return made if body.core is None else with_fittings(made, body.core, RESOLUTION)


class _Maker:
    """What makes a solid: with the vertices made so far."""

    def __init__(self, body: BandedBody) -> None:
        self.bands = body.bands
        self.builder = occt.BRep_Builder()
        self.way = 1.0 if body.rising else -1.0
        self.tolerance = max(RESOLUTION, _TOLERANCE * body.error)
        self.vertices: list[tuple[Array, Any]] = []

    def solid(self) -> Any:
        """Return the solid, its faces outwards."""
        shell, solid = occt.TopoDS_Shell(), occt.TopoDS_Solid()
        self.builder.MakeShell(shell)
        rings = self.rings()
        for band, first, second in zip(self.bands, rings, [*rings[1:], rings[0]], strict=True):
            for face in self.faces(band, first, second):
                # where azimuths fall, the way along a band, to the next and back turns left
                self.builder.Add(shell, face.Reversed() if self.way > 0.0 else face)
        shell.Closed(True)
        self.builder.MakeSolid(solid)
        self.builder.Add(solid, shell)
        return solid

    def faces(self, band: Band, first: list[_Edge], second: list[_Edge]) -> Iterator[Any]:
        """Yield the faces of a band between two rings."""
        match band:
            case FlatBand(height=height):
                yield self.flat(height, first, second)
            case RoundBand(radius=radius):
                yield from self.cylinder(radius, first, second)
            case SplineBand(sectors=nets):
                yield from self.splines(nets, first, second)

    def rings(self) -> list[list[_Edge]]:
        """Return the edges of the ring at the start of each band; none between two discs."""
        count = len(self.bands)
        curved = [self.curves(number) for number in range(count)]
        rings = [self.shared(curved, number) for number in range(count)]
        for number in range(count):
            pair = self.bands[number - 1], self.bands[number]
            heights = [one.height for one in pair if isinstance(one, FlatBand)]
            radii = [one.radius for one in pair if isinstance(one, RoundBand)]
            if heights and radii:
                after = isinstance(pair[1], RoundBand)
                other = rings[(number + 1) % count if after else number - 1]
                rings[number] = self.circle(radii[0], heights[0], other)
        return rings

    def curves(self, number: int) -> list[_Edge | None]:
        """Return the edges of a ring that B-splines end at; None where they have no net."""
        before, after = self.bands[number - 1], self.bands[number]
        sides = [
            [None if net is None else (net.along, net.points[:, column]) for net in band.sectors]
            for band, column in ((after, 0), (before, -1))
            if isinstance(band, SplineBand)
        ]
        rows = [next((row for row in both if row), None) for both in zip(*sides, strict=True)]
        return [None if row is None else self.spline(*row) for row in rows]

    def shared(self, curved: list[list[_Edge | None]], number: int) -> list[_Edge]:
        """Return a ring whose missing edges are those on the other side of the band."""
        after = isinstance(self.bands[number], SplineBand)
        other = curved[(number + 1) % len(curved) if after else number - 1]
        return [edge or other[k] for k, edge in enumerate(curved[number])]  # pyright: ignore

    def vertex(self, point: Array) -> Any:
        """Return the vertex at a point, the same one within the tolerance."""
        for place, vertex in self.vertices:
            if np.abs(place - point).max() < _COINCIDENT:
                return vertex
        vertex = occt.TopoDS_Vertex()
        self.builder.MakeVertex(vertex, occt.gp_Pnt(*point.tolist()), self.tolerance + _COINCIDENT)
        self.vertices.append((point, vertex))
        return vertex

    def edge(self, curve: Any, places: Array, points: Array, *, even: bool = False) -> _Edge:
        """Return an edge on a curve through points at parameters."""
        made, tolerance = occt.TopoDS_Edge(), RESOLUTION if even else self.tolerance
        self.builder.MakeEdge(made, curve, tolerance)
        start, end = self.vertex(points[0]), self.vertex(points[-1])
        self.builder.Add(made, start.Oriented(occt.TopAbs_Orientation.TopAbs_FORWARD))
        self.builder.Add(made, end.Oriented(occt.TopAbs_Orientation.TopAbs_REVERSED))
        self.builder.Range(made, float(places[0]), float(places[-1]))
        return _Edge(made, places, points, start, end, even)

    def spline(self, places: Array, points: Array) -> _Edge:
        """Return the B-spline through points."""
        poles = _filled(occt.Array1_gp_Pnt, occt.gp_Pnt, spline_poles(places, points))
        curve = occt.Geom_BSplineCurve(poles, *_knots(places), DEGREE)
        return self.edge(curve, places, points)

    def line(self, start: Array, end: Array) -> _Edge:
        """Return a straight line."""
        way = end - start
        length = float(np.linalg.norm(way))
        curve = occt.Geom_Line(occt.gp_Pnt(*start.tolist()), occt.gp_Dir(*way.tolist()))
        return self.edge(curve, np.array([0.0, length]), np.array([start, end]), even=True)

    def circle(self, radius: float, height: float, other: list[_Edge]) -> list[_Edge]:
        """Return a circle in arcs, from azimuth to azimuth of the other ring of its cylinder."""
        spokes = [complex(*edge.points[0, :2].tolist()) for edge in other] or [1.0 + 0j, -1.0 + 0j]
        return [
            self.arc(radius, height, one, following)
            for one, following in zip(spokes, [*spokes[1:], spokes[0]], strict=True)
        ]

    def arc(self, radius: float, height: float, start: complex, end: complex) -> _Edge:
        """Return the arc between two spokes, in the direction of the sectors."""
        sweep = (self.way * cmath.phase(end / start)) % (2.0 * math.pi)
        axes = occt.gp_Ax2(
            occt.gp_Pnt(0.0, 0.0, height),
            occt.gp_Dir(0.0, 0.0, self.way),
            occt.gp_Dir(start.real, start.imag, 0.0),
        )
        ends = [radius * spoke / abs(spoke) for spoke in (start, end)]
        points = np.array([[place.real, place.imag, height] for place in ends])
        curve = occt.Geom_Circle(axes, radius)
        return self.edge(curve, np.array([0.0, sweep]), points, even=True)

    def flat(self, height: float, first: list[_Edge], second: list[_Edge]) -> Any:
        """Return a plane between two rings, of which one may be missing."""
        plane = occt.Geom_Plane(occt.gp_Pnt(0.0, 0.0, height), occt.gp_Dir(0.0, 0.0, 1.0))
        outwards = not first or (bool(second) and _reach(second) > _reach(first))
        loops = [
            [(edge.edge, forward, None) for edge in ring]
            for ring, forward in ((first, True), (second, False))
            if ring
        ]
        # seen from above, azimuths rise to the left
        return self.face(plane, loops, same=outwards == (self.way < 0.0))

    def cylinder(self, radius: float, first: list[_Edge], second: list[_Edge]) -> Iterator[Any]:
        """Yield the faces on a cylinder between two rings."""
        sides = [
            self.side(radius, one.points[0], other.points[0])
            for one, other in zip(first, second, strict=True)
        ]
        for k, (one, other) in enumerate(zip(first, second, strict=True)):
            spoke = complex(*one.points[0, :2].tolist()) * cmath.exp(-1j * self.way * _SPARE)
            frame = occt.gp_Ax3(
                occt.gp_Pnt(0.0, 0.0, 0.0),
                occt.gp_Dir(0.0, 0.0, self.way),
                occt.gp_Dir(spoke.real, spoke.imag, 0.0),
            )
            around = (one, True), (sides[(k + 1) % len(sides)], True), (other, False)
            loop = [
                (edge.edge, forward, self.unrolled(edge, spoke))
                for edge, forward in (*around, (sides[k], False))
            ]
            upwards = other.points[0, 2] > one.points[0, 2]
            surface = occt.Geom_CylindricalSurface(frame, radius)
            yield self.face(surface, [loop], same=upwards == (self.way > 0.0))

    def side(self, radius: float, start: Array, end: Array) -> _Edge:
        """Return the edge on a cylinder between two points: a straight line, or a helix."""
        first, second = complex(*start[:2].tolist()), complex(*end[:2].tolist())
        turn = cmath.phase(second / first)
        if abs(turn) * radius < RESOLUTION:
            return self.line(start, end)
        places = np.linspace(0.0, 1.0, _SAMPLES)
        flat = radius * first / abs(first) * np.exp(1j * turn * places)
        heights = start[2] + places * (end[2] - start[2])
        return self.spline(places, np.stack([flat.real, flat.imag, heights], axis=1))

    def unrolled(self, edge: _Edge, spoke: complex) -> Any:
        """Return an edge over azimuth and height of a cylinder that begins at a spoke."""
        flat = edge.points[:, 0] + 1j * edge.points[:, 1]
        turned = np.mod(self.way * np.angle(flat / spoke), 2.0 * math.pi)
        places = np.stack([turned, self.way * edge.points[:, 2]], axis=1)
        if edge.even:
            way = places[-1] - places[0]
            return occt.Geom2d_Line(
                occt.gp_Pnt2d(*places[0].tolist()), occt.gp_Dir2d(*way.tolist())
            )
        poles = _filled(occt.Array1_gp_Pnt2d, occt.gp_Pnt2d, spline_poles(edge.places, places))
        return occt.Geom2d_BSplineCurve(poles, *_knots(edge.places), DEGREE)

    def splines(
        self, nets: Sequence[SplineNet | None], first: list[_Edge], second: list[_Edge]
    ) -> Iterator[Any]:
        """Yield the faces of B-splines between two rings."""
        count = len(nets)
        sides = [self.across(nets[k], nets[k - 1]) for k in range(count)]
        for k, net in enumerate(nets):
            if net is None:
                continue
            start, end = net.along[0], net.along[-1]
            loop = [
                (first[k].edge, True, _straight((0.0, 0.0), (1.0, 0.0))),
                self.closing(sides[(k + 1) % count], first[(k + 1) % count], True, end),
                (second[k].edge, False, _straight((0.0, 1.0), (1.0, 0.0))),
                self.closing(sides[k], first[k], False, start),
            ]
            yield self.face(_surface(net), [loop], same=True)

    def across(self, net: SplineNet | None, before: SplineNet | None) -> _Edge | None:
        """Return the edge at the start of a sector; None if it is a point."""
        if net is not None:
            points, places = net.points[0], net.across
        elif before is not None:
            points, places = before.points[-1], before.across
        else:
            return None
        if np.abs(points - points[0]).max() < _COINCIDENT:
            return None
        return self.spline(places, points)

    def closing(self, side: _Edge | None, ring: _Edge, forward: bool, place: float) -> _Use:
        """Return how a face uses the edge at an end of its sector; of a point, its own edge."""
        curve = _straight((float(place), 0.0), (0.0, 1.0))
        if side is not None:
            return side.edge, forward, curve
        edge = occt.TopoDS_Edge()
        self.builder.MakeEdge(edge)
        self.builder.Add(edge, ring.start.Oriented(occt.TopAbs_Orientation.TopAbs_FORWARD))
        self.builder.Add(edge, ring.start.Oriented(occt.TopAbs_Orientation.TopAbs_REVERSED))
        self.builder.Degenerated(edge, True)
        return edge, forward, curve

    def face(self, surface: Any, loops: Sequence[Sequence[_Use]], *, same: bool) -> Any:
        """Return a face; `same`: its loops turn left about the normal of the surface."""
        face = occt.TopoDS_Face()
        self.builder.MakeFace(face, surface, RESOLUTION)
        for loop in loops:
            wire = occt.TopoDS_Wire()
            self.builder.MakeWire(wire)
            for edge, forward, curve in loop if same else reversed(loop):
                if curve is not None:
                    self.builder.UpdateEdge(edge, curve, face, self.tolerance)
                if occt.BRep_Tool.Degenerated_s(edge):
                    self.builder.Range(edge, face, 0.0, 1.0)
                self.builder.Add(wire, edge if forward == same else edge.Reversed())
            wire.Closed(True)
            self.builder.Add(face, wire)
        return face if same else face.Reversed()


def _reach(ring: list[_Edge]) -> float:
    """Return the radius of a circle."""
    return math.hypot(*ring[0].points[0, :2].tolist())


def _straight(start: tuple[float, float], way: tuple[float, float]) -> Any:
    return occt.Geom2d_Line(occt.gp_Pnt2d(*start), occt.gp_Dir2d(*way))


def _filled(array: Any, kind: Any, rows: Array) -> Any:
    """Return points of the kernel in its array."""
    made = array(1, len(rows))
    for number, row in enumerate(rows.tolist(), start=1):
        made.SetValue(number, kind(*row))
    return made


def _knots(places: Array) -> tuple[Any, Any]:
    """Return the knots of the cubic through points at `places`, and how often each counts."""
    breaks = spline_breaks(places).tolist()
    knots, repeats = occt.Array1_double(1, len(breaks)), occt.Array1_int(1, len(breaks))
    for number, knot in enumerate(breaks, start=1):
        knots.SetValue(number, knot)
        repeats.SetValue(number, DEGREE + 1 if number in (1, len(breaks)) else 1)
    return knots, repeats


def _surface(net: SplineNet) -> Any:
    rows, columns, _ = net.points.shape
    poles = occt.Array2_gp_Pnt(1, rows, 1, columns)
    for k, row in enumerate(net.poles.tolist(), start=1):
        for j, pole in enumerate(row, start=1):
            poles.SetValue(k, j, occt.gp_Pnt(*pole))
    (first, often), (second, times) = _knots(net.along), _knots(net.across)
    return occt.Geom_BSplineSurface(poles, first, second, often, times, DEGREE, DEGREE)
