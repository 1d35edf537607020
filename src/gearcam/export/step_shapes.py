"""Parts as the solids of a CAD kernel (OCCT), for STEP files.

Each piece of an outline that has a length becomes one face: straight pieces planes, all others
B-splines within the tolerance. Openings, hubs and marks are exact: their arcs become cylinders.
Faces are made one by one from their curves, with shared corners; hubs are fused to the plate, marks
and openings through a hub are cut out. Nothing is merged or simplified afterwards, so no flank's
face is lost.

Chamfers are those of smooth edges: the kernel fails at many of the corners of teeth, which stay
sharp (see `Part.smooth_bevels`).

Refused: parts whose solid is empty, in pieces, invalid or has a wrong volume.

Depends on parts, numeric and solids; on OCP, the kernel's binding, only through `occt`, which loads
it on first use. The binding has no types: its objects are `Any` here. Lengths in millimetres.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from typing import Any, Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.bulges import arc_centers, bulge_pieces
from gearcam.numeric.contour import Contour, Run
from gearcam.numeric.polygons import nearest
from gearcam.numeric.splines import DEGREE, Spline, fit_splines
from gearcam.parts.body import Bevel, Edge, Layer, Opening, Part, ScrewHole
from gearcam.parts.shapes import Circle, Loop
from gearcam.parts.solids import OVERSHOOT, SolidError, demand_volume

COLLECTIONS: Final = ("Array1", "Array2", "IndexedMap", "List", "Sequence")
"""Prefixes of names that are in one module of the binding; all others begin with their module."""

_NEAR: Final = 1e-2
"""Distance, mm, of an edge of the kernel from the outline that it belongs to."""

RESOLUTION: Final = 1e-7
"""The kernel's own tolerance, mm: closer points are equal."""

CLEARANCE: Final = 1.0
"""Overshoot of a bore's solid at both ends, mm: faces must not coincide."""

VOLUME_PRECISION: Final = 1e-9
"""Relative tolerance of the kernel's adaptive integration over a face."""

VOLUME_ERROR: Final = 1e-6
"""Allowed relative error of the volume, besides that explained by the tolerance."""


class Kernel:
    """The kernel: each of its classes by name, imported on first use."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        room = name.partition("_")[0]
        module = import_module(f"OCP.{'collections' if room in COLLECTIONS else room}")
        setattr(self, name, getattr(module, name))
        return getattr(module, name)


occt: Final = Kernel()


@dataclass(frozen=True, eq=False, kw_only=True)
class _Piece:
    """A curve of the kernel at z = 0, its parameters `first` to `last`, and its start."""

    curve: Any
    first: float
    last: float
    start: complex


def solids_of(part: Part, tolerance: float) -> list[Any]:
    """Return the solids of a part, one for each step, from the lowest up.

    Parameters
    ----------
    part : Part
        The part.
    tolerance : float, mm
        Largest distance of the B-splines from the outlines' dense points.

    Returns
    -------
    list of TopoDS_Solid

    Raises
    ------
    SolidError
        If one is empty, in pieces or invalid, or their volume is not that of the part.
    """
    steps = range(len(part.steps))
    made = valid_solids(part.name, lambda: [_step(part, step, tolerance) for step in steps])
    part = replace(part, bevels=part.smooth_bevels)
    volume = sum(properties(solid).Mass() for solid in made)
    demand_volume(part, volume, VOLUME_ERROR * part.volume + _explained(part, tolerance))
    return made


def valid_solids(name: str, make: Callable[[], list[Any]]) -> list[Any]:
    """Return the solids of the kernel that a function makes.

    Parameters
    ----------
    name : str
        Of the body, for messages.
    make : callable
        Returns them.

    Raises
    ------
    SolidError
        If they cannot be made, or one is invalid.
    """
    try:
        made = make()
    except SolidError as error:
        raise SolidError(f"{name}: {error}") from error
    except Exception as error:
        # the only common base of the kernel's errors
        if not type(error).__module__.startswith("OCP"):
            raise
        raise SolidError(f"{name}: the solid could not be made: {error}") from error
    if not all(occt.BRepCheck_Analyzer(solid).IsValid() for solid in made):
        raise SolidError(f"{name}: the solid is invalid")
    return made


def properties(shape: Any) -> Any:
    """Volume and centre of mass of a shape of the kernel."""
    volume = occt.GProp_GProps()
    occt.BRepGProp.VolumeProperties_s(shape, volume, VOLUME_PRECISION, True, False)
    return volume


def subshapes(shape: Any, kind: str) -> list[Any]:
    """Return the parts of a shape that are of a given type.

    Parameters
    ----------
    shape : TopoDS_Shape
        Any shape of the kernel.
    kind : {"SOLID", "FACE"}
        The type.

    Returns
    -------
    list of TopoDS_Shape
        Each once, in the shape's order.
    """
    shapes = occt.IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher()
    occt.TopExp.MapShapes_s(shape, getattr(occt.TopAbs_ShapeEnum, f"TopAbs_{kind}"), shapes)
    return [shapes.FindKey(number) for number in range(1, shapes.Extent() + 1)]


def _explained(part: Part, tolerance: float) -> float:
    """Return the volume between the true outlines and curves within the tolerance, mm^3."""
    # the kernel's chamfers have mitres where parallels have arcs
    corners = sum(one.height**3 for one in part.bevels if isinstance(one.edge, Loop))
    return corners + sum(
        edge.length * tolerance * layer.height
        for layer in (*part.steps, *part.recesses)
        for edge in layer.edges
        if isinstance(edge, Contour)
    )


def _step(part: Part, number: int, tolerance: float) -> Any:
    """Return the solid of a step: its plate, with the hub on it."""
    step = part.steps[number]
    lowest, topmost = number == 0, number == len(part.steps) - 1
    bosses = [boss for boss in part.bosses if (lowest if boss.low < 0.0 else topmost)]
    # openings through a hub are cut last: their face must not end where the plate does
    late = bosses[0].openings if bosses else ()
    through = tuple(opening for opening in step.openings if opening not in late)
    # swept surfaces are cut five times as fast as B-splines
    prism = _swept if part.recesses else _prism
    body = prism(replace(step, openings=through), tolerance)
    hubs = [prism(replace(boss, openings=()), tolerance) for boss in bosses]
    cutters = [*_through(part, late), *(part.cutters(OVERSHOOT) if topmost else ())]
    tools = [prism(cutter, tolerance) for cutter in cutters]
    if part.screw is not None and (topmost if part.screw.middle > 0.0 else lowest):
        tools.append(_drilled(part.screw))
    made = _worked(body, hubs, tools)
    made = _converted(made) if part.recesses else made
    ends = [one for one in part.smooth_bevels if (topmost if one.up else lowest)]
    return _chamfered(made, ends, tolerance)


def with_fittings(body: Any, core: Part, tolerance: float) -> Any:
    """Return a solid with what a part in its core has: openings, hubs, marks, chamfers.

    Parameters
    ----------
    body : TopoDS_Solid
        Without openings.
    core : Part
        A round part within it, with the same faces.
    tolerance : float, mm
        Of curves that are not exact.

    Returns
    -------
    TopoDS_Solid
    """
    hubs = [_prism(replace(boss, openings=()), tolerance) for boss in core.bosses]
    cutters = (*_through(core, core.openings), *core.cutters(OVERSHOOT))
    tools = [_prism(one, tolerance) for one in cutters]
    tools += [] if core.screw is None else [_drilled(core.screw)]
    return _chamfered(_worked(body, hubs, tools), core.bevels, core.tolerance)


def _through(part: Part, openings: Iterable[Opening]) -> list[Layer]:
    """Return openings as layers that go beyond both ends of a part."""
    low, high = part.ends[0] - CLEARANCE, part.ends[1] + CLEARANCE
    return [Layer(edge=one.shape, low=low, high=high) for one in openings]


def _worked(body: Any, hubs: Sequence[Any], tools: Sequence[Any]) -> Any:
    """Return a solid with its hubs, less tools."""
    body = _combined(occt.BRepAlgoAPI_Fuse(), body, hubs) if hubs else body
    return _combined(occt.BRepAlgoAPI_Cut(), body, tools) if tools else body


def _drilled(screw: ScrewHole) -> Any:
    """Return the hole of a set screw as a cylinder, from the axis to outside of the hub."""
    way = occt.gp_Dir(math.cos(screw.angle), math.sin(screw.angle), 0.0)
    axes = occt.gp_Ax2(_point(0j, screw.middle), way)
    length = CLEARANCE + screw.edge.reach
    return occt.BRepPrimAPI_MakeCylinder(axes, 0.5 * screw.drill, length).Shape()


def _chamfered(body: Any, bevels: Sequence[Bevel], tolerance: float) -> Any:
    """Return a solid whose edges in faces have chamfers."""
    if not bevels:
        return body
    maker = occt.BRepFilletAPI_MakeChamfer(body)
    rings = [(one, one.edge.polyline(tolerance)) for one in bevels]
    for edge in subshapes(body, "EDGE"):
        curve = occt.BRepAdaptor_Curve(occt.TopoDS.Edge(edge))
        places = np.linspace(curve.FirstParameter(), curve.LastParameter(), 5)[1:-1]
        points = [curve.Value(float(place)) for place in places]
        for bevel, ring in rings:
            level = bevel.high if bevel.up else bevel.low
            if any(abs(one.Z() - level) > RESOLUTION for one in points):
                continue
            away = [nearest(ring, complex(one.X(), one.Y())) for one in points]
            if max(away) < _NEAR:
                maker.Add(bevel.height, occt.TopoDS.Edge(edge))
                break
    maker.Build()
    solids = subshapes(maker.Shape(), "SOLID") if maker.IsDone() else []
    if len(solids) != 1:
        size = bevels[0].height
        what = "the kernel of the STEP files makes no solid with this chamfer"
        rule = "a smaller chamfer, or no STEP file: meshes and drawings have it"
        raise InfeasibleError(what, where="blank.chamfer_mm", value=size, unit="mm", nearest=rule)
    return solids[0]


def _combined(operation: Any, body: Any, tools: Sequence[Any]) -> Any:
    """Return a body with tools fused to it or cut from it."""
    left, right = occt.List_TopoDS_Shape(), occt.List_TopoDS_Shape()
    left.Append(body)
    for tool in tools:
        right.Append(tool)
    operation.SetArguments(left)
    operation.SetTools(right)
    operation.SetRunParallel(False)  # the order of faces must not depend on threads
    operation.SetNonDestructive(True)
    operation.SetToFillHistory(False)
    operation.Build()
    solids = subshapes(operation.Shape(), "SOLID") if operation.IsDone() else []
    if len(solids) != 1:
        raise SolidError(f"the solid consists of {len(solids)} pieces")
    return solids[0]


def _prism(layer: Layer, tolerance: float) -> Any:
    """Return a layer as a solid, one side face for each piece; all counter-clockwise."""
    return _converted(_swept(layer, tolerance))


def _converted(prism: Any) -> Any:
    """Return a solid whose swept curves are B-spline surfaces, which more programs read."""
    # planes and cylinders stay
    solids = subshapes(
        occt.ShapeCustom.ConvertToBSpline_s(prism, True, False, False, False), "SOLID"
    )
    if len(solids) != 1:
        raise SolidError("the solid is empty")
    return occt.TopoDS.Solid(solids[0])


def _swept(layer: Layer, tolerance: float) -> Any:
    """Return the same with swept surfaces."""
    floor = occt.gp_Pln(_point(0j, layer.low), occt.gp_Dir(0.0, 0.0, 1.0))
    edge, *holes = (_wire(_pieces(edge, tolerance), layer.low) for edge in layer.edges)
    face = occt.BRepBuilderAPI_MakeFace(floor, edge, False)
    for hole in holes:
        face.Add(occt.TopoDS.Wire(hole.Reversed()))
    if not face.IsDone():
        raise SolidError("an outline does not enclose a face")
    return occt.BRepPrimAPI_MakePrism(face.Face(), occt.gp_Vec(0.0, 0.0, layer.height)).Shape()


def _wire(pieces: Sequence[_Piece], height: float) -> Any:
    """Return the closed chain of pieces at a height, with one corner between neighbours."""
    corners = [occt.BRepBuilderAPI_MakeVertex(_point(p.start, height)).Vertex() for p in pieces]
    builder, wire, lift = occt.BRep_Builder(), occt.TopoDS_Wire(), occt.gp_Vec(0.0, 0.0, height)
    builder.MakeWire(wire)
    for piece, start, end in zip(pieces, corners, [*corners[1:], corners[0]], strict=True):
        curve = piece.curve.Translated(lift)
        edge = occt.BRepBuilderAPI_MakeEdge(curve, start, end, piece.first, piece.last)
        if not edge.IsDone():
            raise SolidError(f"a piece of an outline cannot be made an edge ({edge.Error().name})")
        builder.Add(wire, edge.Edge())
    wire.Closed(True)
    return wire


def _point(place: complex, height: float = 0.0) -> Any:
    return occt.gp_Pnt(place.real, place.imag, height)


def _outline(contour: Contour, tolerance: float) -> list[_Piece]:
    """Return a curve for each piece of a contour; each ends exactly where the next begins."""
    # a piece between two curves that meet has no length
    pieces = (piece for run in contour.runs for piece in run.pieces)
    runs = [one for one in pieces if np.abs(np.diff(one.points)).sum() > RESOLUTION]
    starts = [complex(run.points[0]) for run in runs]
    straight = [_is_straight(run, min(RESOLUTION, tolerance)) for run in runs]
    bent = [run for run, flat in zip(runs, straight, strict=True) if not flat]
    splines = iter(fit_splines(bent, tolerance) if bent else ())
    return [
        _line(start, end) if flat else _curve(next(splines), start, end)
        for flat, start, end in zip(straight, starts, [*starts[1:], starts[0]], strict=True)
    ]


def _is_straight(run: Run, allowed: float) -> bool:
    """Whether a run and its tangents are within `allowed`, mm, of its chord."""
    points = run.points
    chord = points[-1] - points[0]
    if abs(chord) <= allowed:
        return False  # closed
    unit = chord / abs(chord)
    across = ((points - points[0]) * unit.conjugate()).imag
    turned = run.tangents * unit.conjugate()
    return bool(
        np.abs(across).max() <= allowed
        and np.abs(turned.imag).max() * abs(chord) <= allowed
        and turned.real.min() > 0.0
    )


def _curve(spline: Spline, start: complex, end: complex) -> _Piece:
    places = [start, *spline.poles[1:-1].tolist(), end]
    breaks = spline.breaks.tolist()
    poles, knots = occt.Array1_gp_Pnt(1, len(places)), occt.Array1_double(1, len(breaks))
    repeats = occt.Array1_int(1, len(breaks))
    for number, place in enumerate(places, start=1):
        poles.SetValue(number, _point(place))
    for number, knot in enumerate(breaks, start=1):
        knots.SetValue(number, knot)
        repeats.SetValue(number, DEGREE + 1 if number in (1, len(breaks)) else DEGREE - 1)
    curve = occt.Geom_BSplineCurve(poles, knots, repeats, DEGREE)
    return _Piece(curve=curve, first=breaks[0], last=breaks[-1], start=start)


def _line(start: complex, end: complex) -> _Piece:
    vector = end - start
    curve = occt.Geom_Line(_point(start), occt.gp_Dir(vector.real, vector.imag, 0.0))
    return _Piece(curve=curve, first=0.0, last=abs(vector), start=start)


def _pieces(edge: Edge, tolerance: float) -> list[_Piece]:
    """Return the curves of an edge: exact ones, or those of a contour within the tolerance."""
    match edge:
        case Circle(center=center, diameter=diameter):
            return [_circle(center, center + 0.5 * diameter, 2.0 * math.pi)]
        case Loop():
            return list(_loop(edge))
        case Contour():
            return _outline(edge, tolerance)


def _loop(shape: Loop) -> Iterator[_Piece]:
    start, chord, bends = bulge_pieces(shape.points, shape.bulges, closed=True)
    for k in np.flatnonzero(np.abs(chord) > RESOLUTION):
        if bends[k] == 0.0:
            yield _line(complex(start[k]), complex(start[k] + chord[k]))
        else:
            centre = arc_centers(start[k], chord[k], bends[k])
            yield _circle(complex(centre), complex(start[k]), 4.0 * math.atan(bends[k]))


def _circle(centre: complex, start: complex, sweep: float) -> _Piece:
    """Return an arc about a centre, to the right where the sweep, rad, is negative."""
    spoke = cmath.exp(1j * cmath.phase(start - centre))
    axes = occt.gp_Ax2(
        _point(centre),
        occt.gp_Dir(0.0, 0.0, math.copysign(1.0, sweep)),
        occt.gp_Dir(spoke.real, spoke.imag, 0.0),
    )
    curve = occt.Geom_Circle(axes, abs(start - centre))
    return _Piece(curve=curve, first=0.0, last=abs(sweep), start=start)
