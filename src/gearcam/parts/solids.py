"""Solids: a body as a closed mesh of triangles; bodies of layers are made with manifold3d.

This is the only module that uses manifold3d. A *mesh* is plain arrays: the library's own objects
cannot be pickled and its interface changes.

Refused: parts whose solid is empty, open, or lacks a part of its volume. (The library returns
nothing for clockwise contours; parts refuse them.)

Depends on parts; manifold3d only inside the functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property, singledispatch
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np

from gearcam.base.errors import GearcamError, MissingExtraError
from gearcam.base.numerals import formatted
from gearcam.numeric.arrays import Array, Ints, Plane, as_pairs
from gearcam.numeric.contour import Contour
from gearcam.numeric.mesh import Mesh
from gearcam.parts.body import Bevel, Body, Layer, Opening, Part
from gearcam.parts.shapes import Circle, circle_segments

if TYPE_CHECKING:
    from manifold3d import Manifold

OVERSHOOT: Final = 1.0
"""Overshoot of a pocket's solid beyond the face, in its depths: faces must not coincide."""

_FILLED: Final = 18
"""Largest power of 2 by which flat outlines are scaled for the library: it rounds them to a grid of
1e-8, independent of their size, in 64-bit integers."""

ROUNDING: Final = 1e-8 * 2.0 ** (1 - _FILLED)
"""Largest size of that grid, over the reach of an outline."""

_JOINED: Final = 4.0
"""Error of the triangles of a chamfer, over the chord tolerance."""

LIBRARIES: Final = '"manifold3d>=3.5,<3.6" "trimesh>=5,<6" networkx lxml'
"""Libraries that only solids need, as arguments of pip."""


class SolidError(GearcamError, RuntimeError):
    """A solid is empty, open, or has a wrong volume."""


@contextmanager
def libraries() -> Iterator[None]:
    """Yield once; name the command that installs a library if importing it fails. Also a decorator.

    Yields
    ------
    None

    Raises
    ------
    MissingExtraError
        If an import in the block fails.
    """
    try:
        yield
    except ImportError as error:
        raise MissingExtraError("solids", packages=LIBRARIES) from error


@singledispatch
def solid(body: Body) -> Mesh:
    """Return the mesh of a body; dispatched on the type of the body.

    Parameters
    ----------
    body : Body
        A part, of which contours keep their polygons and all other curves its tolerance; or another
        registered type.

    Returns
    -------
    Mesh

    Raises
    ------
    MissingExtraError
        If manifold3d is not installed.
    SolidError
        If the solid is empty or open, or lacks a part of its volume.
    TypeError
        If this type of body is not registered.
    """
    raise TypeError(f"a {type(body).__name__} makes no solid")


@solid.register
@libraries()
def _(part: Part) -> Mesh:
    import manifold3d

    bevels = [one for one in part.bevels if not one.hollow]
    slabs = [_slab(manifold3d, layer, part.tolerance, bevels) for layer in part.layers]
    made = slabs[0]
    if len(slabs) > 1:
        made = manifold3d.Manifold.batch_boolean(slabs, manifold3d.OpType.Add)
    for cutter in _cutters(manifold3d, part):
        made = made - cutter
    mesh = _closed(made, f"{part.name}: the solid")
    demand_volume(part, mesh.volume, volume_error(part))
    return mesh


@libraries()
def fitted(body: Mesh, core: Part, height: float) -> Mesh:
    """Return a body with what a part in its core has: openings, hubs, marks, chamfers.

    Parameters
    ----------
    body : Mesh
        Closed, without openings.
    core : Part
        A round part within it, with the same faces.
    height : float, mm
        Where z = 0 of the part is in the frame of the body.

    Returns
    -------
    Mesh

    Raises
    ------
    MissingExtraError
        If manifold3d is not installed.
    SolidError
        If the result is open.
    """
    import manifold3d

    made = _manifold(manifold3d, body).translate((0.0, 0.0, -height))
    bevels = [one for one in core.bevels if not one.hollow]
    for bevel in bevels:
        if not any(bevel.on(layer) for layer in core.layers):
            made = made - _wedge(manifold3d, bevel, core.tolerance)
    for boss in core.bosses:
        made = made + _slab(manifold3d, replace(boss, openings=()), core.tolerance, bevels)
    holes = _holes(manifold3d, core.openings, core.ends, core.tolerance)
    for cutter in (*holes, *_cutters(manifold3d, core)):
        made = made - cutter
    return _closed(made.translate((0.0, 0.0, height)), f"{core.name}: the solid")


def _holes(
    manifold3d: Any, openings: Iterable[Opening], ends: tuple[float, float], tolerance: float
) -> Iterator[Manifold]:
    """Yield openings as solids that go beyond both `ends` of a layer, mm."""
    low, high = ends[0] - OVERSHOOT, ends[1] + OVERSHOOT
    for opening in openings:
        yield _slab(manifold3d, Layer(edge=opening.shape, low=low, high=high), tolerance)


def _wedge(manifold3d: Any, bevel: Bevel, tolerance: float) -> Manifold:
    """Return what the chamfer of a round outer edge takes, a little larger."""
    radius, size = bevel.edge.reach, bevel.height
    over, side = 0.1 * size, 1.0 if bevel.up else -1.0
    level = bevel.high if bevel.up else bevel.low
    corners = [
        (radius + over, level - side * (size + over)),
        (radius + over, level + side * over),
        (radius - size - over, level + side * over),
    ]
    section = manifold3d.CrossSection([corners[:: 1 if bevel.up else -1]])
    return manifold3d.Manifold.revolve(section, circle_segments(2.0 * radius, tolerance))


def _cutters(manifold3d: Any, part: Part) -> Iterator[Manifold]:
    """Yield what is cut from the layers of a part."""
    for cutter in part.cutters(OVERSHOOT):
        yield _slab(manifold3d, cutter, part.tolerance)
    for bevel in part.bevels:
        if bevel.hollow:
            edge, face = (one.polyline(part.tolerance) for one in (bevel.edge, bevel.face))
            sections = [(edge, bevel.low), (face, bevel.high), (face, bevel.high + bevel.height)]
            if not bevel.up:
                sections = [(p, bevel.low + bevel.high - z) for p, z in reversed(sections)]
            yield _loft(manifold3d, sections)
    if part.screw is not None:
        screw = part.screw
        length = OVERSHOOT + 0.5 * cast("Circle", screw.edge).diameter
        segments = circle_segments(screw.drill, part.tolerance)
        hole = manifold3d.Manifold.cylinder(length, 0.5 * screw.drill, -1.0, segments)
        turned = hole.rotate((0.0, 90.0, math.degrees(screw.angle)))
        yield turned.translate((0.0, 0.0, screw.middle))


def demand_volume(part: Part, volume: float, allowed: float) -> None:
    """Check the volume of a solid against that of its part.

    Parameters
    ----------
    part : Part
        The part.
    volume : float, mm^3
        Volume of the solid.
    allowed : float, mm^3
        Largest difference.

    Raises
    ------
    SolidError
        If the difference is larger.
    """
    missed = abs(volume - part.volume)
    if missed > allowed:
        raise SolidError(
            f"{part.name}: the solid's volume is {formatted(missed, 3)} mm3 off,"
            f" the tolerance explains {formatted(allowed, 3)} mm3"
        )


def _slab(
    manifold3d: Any, layer: Layer, tolerance: float, bevels: Sequence[Bevel] = ()
) -> Manifold:
    """Return a layer: its edge extruded along z, less its openings, which run clockwise.

    Those of the bevels that are of its edge are left out.
    """
    own = {one.up: one for one in bevels if one.on(layer)}
    if own:
        return _bevelled(manifold3d, layer, tolerance, own)
    holes = [opening.shape.polyline(tolerance)[::-1] for opening in layer.openings]
    loops = [as_pairs(loop) for loop in (layer.edge.polyline(tolerance), *holes)]
    times = math.ldexp(1.0, _FILLED - math.frexp(layer.edge.reach)[1])
    section = manifold3d.CrossSection([times * loop for loop in loops])
    slab = manifold3d.Manifold.extrude(section, layer.height).scale((1.0 / times, 1.0 / times, 1.0))
    return slab.translate((0.0, 0.0, layer.low))


def _bevelled(
    manifold3d: Any, layer: Layer, tolerance: float, bevels: Mapping[bool, Bevel]
) -> Manifold:
    """Return a layer whose edge has bevels in its lower face (False) or its upper one (True)."""
    edge = layer.edge.polyline(tolerance)
    low, high = bevels.get(False), bevels.get(True)
    sections = [(edge, layer.low), (edge, layer.high)]
    if low:
        sections = [(low.face.polyline(tolerance), layer.low), (edge, low.high), *sections[1:]]
    if high:
        sections = [*sections[:-1], (edge, high.low), (high.face.polyline(tolerance), layer.high)]
    made = _loft(manifold3d, sections)
    for hole in _holes(manifold3d, layer.openings, (layer.low, layer.high), tolerance):
        made = made - hole
    return made


def _loft(manifold3d: Any, sections: Sequence[tuple[Plane, float]]) -> Manifold:
    """Return the solid through polygons at rising heights: the same, or one inside the other."""
    starts = np.cumsum([0, *(len(points) for points, _ in sections)])
    bottom, top = (
        np.asarray(manifold3d.triangulate([as_pairs(points)]), dtype=np.int64)
        for points in (sections[0][0], sections[-1][0])
    )
    faces = [bottom[:, ::-1], top + starts[-2]]
    for k, ((one, _), (two, _)) in enumerate(pairwise(sections)):
        here, there = starts[k] + np.arange(len(one)), starts[k + 1] + np.arange(len(two))
        if one is two:
            after, beyond = np.roll(here, -1), np.roll(there, -1)
            faces += [np.stack([here, after, beyond], 1), np.stack([here, beyond, there], 1)]
        else:
            faces.append(_between(one, two, starts[k]))
    points = [np.column_stack([as_pairs(one), np.full(len(one), z)]) for one, z in sections]
    mesh = Mesh(vertices=np.concatenate(points), triangles=np.concatenate(faces))
    return _manifold(manifold3d, mesh)


def _between(lower: Plane, upper: Plane, start: int) -> Ints:
    """Return triangles from a polygon to one above it, one of them inside the other.

    Points of the lower one are counted from `start`, those of the upper one follow.
    """
    from shapely import Polygon, constrained_delaunay_triangles, get_coordinates

    points = np.concatenate([lower, upper])
    loops = [as_pairs(lower), as_pairs(upper)]
    rising = Polygon(loops[0]).area > Polygon(loops[1]).area  # the surface is seen from above
    outer, inner = loops if rising else loops[::-1]
    made = get_coordinates(constrained_delaunay_triangles(Polygon(outer, [inner])))
    corners = made[:, 0] + 1j * made[:, 1]
    order = np.argsort(points)
    found = order[np.searchsorted(points[order], corners)].reshape(-1, 4)[:, :3]
    if (
        len(found) != len(points)
        or (points[found.ravel()] != corners.reshape(-1, 4)[:, :3].ravel()).any()
    ):
        raise SolidError("the chamfer leaves no simple edge")
    a, b, c = points[found.T]
    turned = (((b - a).conjugate() * (c - a)).imag > 0.0) != rising
    found[turned] = found[turned, ::-1]
    return start + found


def _closed(body: Manifold, what: str) -> Mesh:
    """Return the mesh of a body; refuse one that is not closed."""
    mesh = _mesh(body)
    if not mesh.watertight:
        raise SolidError(f"{what} is empty or open")
    return mesh


def _mesh(body: Manifold) -> Mesh:
    raw = body.to_mesh64()
    vertices = np.array(raw.vert_properties[:, :3], dtype=np.float64)
    return Mesh(vertices=vertices, triangles=np.array(raw.tri_verts, dtype=np.int64))


@libraries()
def carved(blank: Mesh, tools: Iterable[Array]) -> Mesh:
    """Return a mesh less the convex hulls of points.

    Parameters
    ----------
    blank : Mesh
        Closed.
    tools : iterable of (n, 3) array, mm
        The corners of each hull.

    Returns
    -------
    Mesh

    Raises
    ------
    MissingExtraError
        If manifold3d is not installed.
    SolidError
        If nothing is left, or the result is open.
    """
    import manifold3d

    whole = _manifold(manifold3d, blank)
    hulls = [manifold3d.Manifold.hull_points(corners) for corners in tools]
    made = manifold3d.Manifold.batch_boolean([whole, *hulls], manifold3d.OpType.Subtract)
    return _closed(made, "the carved solid")


@libraries()
def ribbed(core: Mesh, rib: Mesh, blank: Mesh) -> Mesh:
    """Return what is in a blank and in a core or a rib.

    Parameters
    ----------
    core, rib, blank : Mesh
        Closed.

    Returns
    -------
    Mesh

    Raises
    ------
    MissingExtraError
        If manifold3d is not installed.
    SolidError
        If nothing is left, or the result is open.
    """
    import manifold3d

    body, strip, limits = (_manifold(manifold3d, one) for one in (core, rib, blank))
    return _closed((body + strip) ^ limits, "the solid with its rib")


def _manifold(manifold3d: Any, mesh: Mesh) -> Manifold:
    raw = manifold3d.Mesh64(mesh.vertices, mesh.triangles.astype(np.uint64))
    return manifold3d.Manifold(raw)


@dataclass(frozen=True, eq=False)
class Prisms:
    """Prisms of two sets of outlines, made when they are first used.

    Parameters
    ----------
    first, second : sequence of (n,) complex arrays, mm
        Outlines, counter-clockwise.
    low, high : float, mm
        Heights of their faces.
    """

    first: Sequence[Plane]
    second: Sequence[Plane]
    low: float
    high: float

    def overlap(self, one: int, two: int, motion: Array) -> tuple[float, Array]:
        """Return the overlap of two prisms.

        Parameters
        ----------
        one, two : int
            Indices in `first` and `second`.
        motion : (3, 4) array, mm
            Rotation and shift of the first of them.

        Returns
        -------
        volume : float, mm^3
        vertices : (n, 3) array, mm
            None without overlap.

        Raises
        ------
        MissingExtraError
            If manifold3d is not installed.
        """
        first, second = self.solid("first", one), self.solid("second", two)
        shared = first.transform(motion) ^ second
        volume = float(shared.volume())
        return volume, _mesh(shared).vertices if volume > 0.0 else np.empty((0, 3))

    def solid(self, of: str, number: int) -> Manifold:
        """Return a prism; the same object each time.

        Parameters
        ----------
        of : {"first", "second"}
            The set of outlines.
        number : int
            Index in it.

        Returns
        -------
        manifold3d.Manifold
        """
        prisms = self._prisms
        if (of, number) not in prisms:
            prisms[of, number] = _prism(getattr(self, of)[number], self.low, self.high)
        return prisms[of, number]

    @cached_property
    def _prisms(self) -> dict[tuple[str, int], Manifold]:
        return {}


@libraries()
def _prism(outline: Plane, low: float, high: float) -> Manifold:
    """Return an outline as a prism with exactly its vertices, which a `CrossSection` would round.

    Its thin overlaps then have the area of those of the outlines, to rounding, times the height.
    """
    import manifold3d

    return _loft(manifold3d, [(outline, low), (outline, high)])


@singledispatch
def volume_error(body: Body) -> float:
    """Return a bound of the volume between a body's mesh and its true shape.

    Parameters
    ----------
    body : Body
        A part, or another registered type.

    Returns
    -------
    float, mm^3
        Chord error and grid times length, for every edge over its height: every chord lies within
        its error of the curve, so the area between them is at most that.

    Raises
    ------
    TypeError
        If this type of body is not registered.
    """
    raise TypeError(f"a {type(body).__name__} makes no solid")


@volume_error.register
def _(part: Part) -> float:
    # triangles of a chamfer join chords of its edge to those of the edge's parallel
    total = sum(
        (_JOINED * part.tolerance * bevel.edge.length + bevel.uneven) * bevel.height
        for bevel in part.bevels
    )
    for layer in (*part.layers, *part.pockets):
        for edge in layer.edges:
            error = edge.chord_error if isinstance(edge, Contour) else part.tolerance
            error += ROUNDING * edge.reach
            total += edge.length * error * layer.height
    return total
