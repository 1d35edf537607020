"""Outlines in the entities of a DXF file: what meets is joined.

Lines, arcs, circles, ellipses, splines and polylines are taken, also those in blocks; what else a
drawing holds (texts, dimensions, hatches) is no edge. Each must lie in a plane parallel to xy.

Depends on numeric; ezdxf only inside the functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from gearcam.base.errors import GearcamError
from gearcam.base.numerals import formatted
from gearcam.numeric.arrays import Array, Plane, as_complex, bounds, distinct
from gearcam.numeric.bulges import bulge_pieces, extremes, off_circle

JOINED: Final = 0.005
"""Largest gap between ends that are joined, mm: coordinates with three decimals in mm, or with four
in inches, meet within it."""

_SAME: Final = 1e-6
"""Distance of ends that are one point, mm: these are joined first."""

_TILTED: Final = 1e-4
"""Largest tilt of a plane that is taken as parallel to xy, rad: it shortens by 5e-9."""

_RISE: Final = 0.005
"""Largest difference of heights that is taken as none, mm."""

_ON_CUBIC: Final = 16
"""Arcs that replace each cubic of a spline, each through three of its points: of gearcam's own
splines they deviate by half a percent of the spline's tolerance; 8 arcs would deviate by 3 %."""

_MOST_ARCS: Final = 512


class DxfError(GearcamError, ValueError):
    """A DXF file does not hold the expected outlines, or cannot be read."""


@dataclass(frozen=True, eq=False)
class DrawnPiece:
    """A chain of lines and arcs in a drawing.

    Parameters
    ----------
    points : (n,) complex array, mm
        If it is closed, the first is not repeated.
    bulges : (n,) or (n - 1,) array
        Of the pieces between them.
    closed : bool
        Whether it ends where it begins.
    whole_circle : bool
        Whether it is a circle, as bores and rims are drawn.
    """

    points: Plane
    bulges: Array
    closed: bool
    whole_circle: bool = False

    @property
    def reverse(self) -> DrawnPiece:
        """The same chain from its end."""
        return DrawnPiece(self.points[::-1], -self.bulges[::-1], self.closed)

    @property
    def box(self) -> tuple[complex, complex]:
        """The lower left and the upper right corner of its bounding box, mm."""
        return bounds(extremes(self.points, self.bulges, self.closed))

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, mm."""
        low, high = self.box
        return high.real - low.real, high.imag - low.imag


def entities_of(space: Iterable[Any], layer: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the entities of a drawing with their layers, those in blocks too.

    Parameters
    ----------
    space : iterable of entities
        Of the drawing, or of a block as it is placed.
    layer : str
        The layer of the block, which entities on layer 0 take.
    """
    for entity in space:
        # an entity that ezdxf does not know has no layer
        own = entity.dxf.layer if entity.dxf.is_supported("layer") else ""
        if layer and own == "0":
            own = entity.dxf.layer = layer  # of the block as it is placed, a copy
        if entity.dxftype() == "INSERT":
            for one in entity.multi_insert() if entity.mcount > 1 else (entity,):
                yield from entities_of(one.virtual_entities(), own)
        else:
            yield own, entity


def pieces_of(
    entities: Iterable[Any], *, scale: float = 1.0, within: float | None = None
) -> Iterator[DrawnPiece]:
    """Yield the lines, arcs, splines and polylines among entities.

    Parameters
    ----------
    entities : iterable
        Entities of ezdxf.
    scale : float, mm
        The unit of the drawing.
    within : float or None, mm
        Largest deviation of arcs from the splines and ellipses that they replace; None: as many
        arcs as gearcam's own splines need.

    Raises
    ------
    DxfError
        If a coordinate is not finite, or an entity does not lie in a plane parallel to xy.
    """
    missed = math.inf if within is None else within / scale
    for entity in entities:
        shape = _SHAPES.get(entity.dxftype())
        if shape is None:
            continue
        _lay_flat(entity, scale)
        found = shape(entity, missed)
        if found is not None and len(found.points) > 1:
            if not all(np.isfinite(values).all() for values in (found.points, found.bulges)):
                raise DxfError("the outline has coordinates that are not finite")
            yield DrawnPiece(scale * found.points, found.bulges, found.closed, found.whole_circle)


def _lay_flat(entity: Any, scale: float) -> None:
    """Refuse an entity that is tilted; turn one that is mirrored by its own axis."""
    kind, fault = entity.dxftype(), ""
    rise = scale * float(np.ptp(_heights(entity)))
    if rise > _RISE:
        fault = f"it rises by {formatted(rise, 3)} mm"
    if kind not in _DRAWN_IN_SPACE and not (kind == "POLYLINE" and entity.is_3d_polyline):
        from ezdxf.upright import upright

        x, y, z = entity.dxf.extrusion.normalize()
        if not math.hypot(x, y) <= _TILTED:
            drawn = ", ".join(formatted(value, 3) for value in entity.dxf.extrusion)
            fault = f"its extrusion is {drawn}"
        elif z < 0.0:
            entity.dxf.extrusion = (0.0, 0.0, -1.0)  # upright takes no other
            upright(entity)
    if fault:
        raise DxfError(
            f"the {kind} on layer {entity.dxf.layer} does not lie in a plane parallel to xy "
            f"({fault}): draw the outline in the xy-plane"
        )


def _heights(entity: Any) -> Array:
    """Return the heights z of an entity that need not be plane."""
    match entity.dxftype():
        case "LINE":
            points = [entity.dxf.start, entity.dxf.end]
        case "SPLINE":
            points = entity.control_points if len(entity.control_points) else entity.fit_points
        case "POLYLINE" if entity.is_3d_polyline:
            points = [vertex.dxf.location for vertex in entity.vertices]
        case _:
            points = []
    return np.array([point[2] for point in points] or [0.0])


def joined(pieces: Sequence[DrawnPiece], gap: float = JOINED) -> list[DrawnPiece]:
    """Return pieces joined where two of them meet.

    Parameters
    ----------
    pieces : sequence of DrawnPiece
        Of one outline or several.
    gap : float, mm
        Largest distance between ends that are joined.

    Returns
    -------
    list of DrawnPiece
        In the order of their first parts, each in the direction of its own.
    """
    for distance in (min(_SAME, gap), gap):
        pieces = _joined_at([_ended(piece, distance) for piece in pieces], distance)
    return list(pieces)


def _joined_at(pieces: list[DrawnPiece], gap: float) -> list[DrawnPiece]:
    """Return pieces joined where the ends of two, and of no third, are up to a gap apart."""
    numbered = {number: piece for number, piece in enumerate(pieces) if piece.closed}
    loose = [k for k, one in enumerate(pieces) if not one.closed and sum(one.size) > gap]
    if len(loose) < 2:
        return pieces
    from ezdxf.edgeminer import Deposit, find_all_simple_chains, make_edge

    ends = {k: [(end.real, end.imag) for end in pieces[k].points[[0, -1]]] for k in loose}
    edges = [make_edge(start, end, payload=k) for k, (start, end) in ends.items()]
    for chain in find_all_simple_chains(Deposit(edges, gap_tol=gap)):
        # the first of its parts as drawn: what is found does not depend on where a search begins
        first = min(range(len(chain)), key=lambda place: chain[place].payload)
        parts = [
            pieces[one.payload].reverse if one.is_reverse else pieces[one.payload] for one in chain
        ]
        if chain[first].is_reverse:
            parts = [part.reverse for part in reversed(parts)]
            first = len(chain) - 1 - first
        whole = abs(parts[-1].points[-1] - parts[0].points[0]) <= gap
        parts = parts[first:] + parts[:first] if whole else parts
        points = np.concatenate([part.points[:-1] for part in parts] + [parts[-1].points[-1:]])
        chained = DrawnPiece(points, np.concatenate([part.bulges for part in parts]), closed=False)
        numbered[min(one.payload for one in chain)] = _ended(chained, gap)
    return [piece for _, piece in sorted(numbered.items())]


def _ended(piece: DrawnPiece, gap: float) -> DrawnPiece:
    """Return a piece, closed if its ends meet."""
    meets = abs(piece.points[-1] - piece.points[0]) <= gap < sum(piece.size)
    if piece.closed or not meets:
        return piece
    return DrawnPiece(piece.points[:-1], piece.bulges, closed=True)


def _light_polyline(entity: Any, _: float) -> DrawnPiece:
    rows = entity.lwpoints.values
    return _polyline(rows[:, :2], rows[:, 4], bool(entity.closed))


def _heavy_polyline(entity: Any, _: float) -> DrawnPiece | None:
    if not (entity.is_2d_polyline or entity.is_3d_polyline):
        return None  # a mesh
    rows = [(*v.dxf.location.vec2, v.dxf.get("bulge", 0.0)) for v in entity.vertices]
    table = np.array(rows).reshape(-1, 3)
    return _polyline(table[:, :2], table[:, 2], bool(entity.is_closed))


def _polyline(points: Array, bulges: Array, closed: bool) -> DrawnPiece:
    return DrawnPiece(as_complex(points), bulges if closed else bulges[:-1], closed)


def _line(entity: Any, _: float) -> DrawnPiece:
    ends = [complex(end.x, end.y) for end in (entity.dxf.start, entity.dxf.end)]
    return DrawnPiece(np.array(ends), np.zeros(1), closed=False)


def _arc(entity: Any, _: float) -> DrawnPiece:
    start, end = math.radians(entity.dxf.start_angle), math.radians(entity.dxf.end_angle)
    turn = (end - start) % (2.0 * math.pi) or 2.0 * math.pi
    return _round(entity, start, turn)


def _circle(entity: Any, _: float) -> DrawnPiece:
    whole = _round(entity, 0.0, 2.0 * math.pi)
    return DrawnPiece(whole.points[:-1], whole.bulges, closed=True, whole_circle=True)


def _round(entity: Any, start: float, turn: float) -> DrawnPiece:
    """Return an arc in parts of at most a quarter of a turn."""
    count = math.ceil(turn / (0.5 * math.pi) - 1e-9)
    angles = start + turn * np.arange(count + 1) / count
    center = complex(entity.dxf.center.x, entity.dxf.center.y)
    points = center + entity.dxf.radius * np.exp(1j * angles)
    return DrawnPiece(points, np.full(count, math.tan(0.25 * turn / count)), closed=False)


def _ellipse(entity: Any, within: float) -> DrawnPiece:
    from ezdxf.math import BSpline

    return _arcs(BSpline.from_ellipse(entity.construction_tool()), within)


def _spline(entity: Any, within: float) -> DrawnPiece:
    return _arcs(entity.construction_tool(), within)


def _arcs(curve: Any, within: float) -> DrawnPiece:
    """Return arcs through points of a spline, by ezdxf's own evaluation."""
    # a periodic spline has knots beyond both ends of its domain
    domain = np.array(curve.knots())[curve.degree : curve.count + 1]
    breaks, count = distinct(domain), _ON_CUBIC
    fine = math.isfinite(within)  # points between are evaluated too
    while True:
        steps = np.linspace(0.0, 1.0, (4 if fine else 2) * count, endpoint=False)
        places = (breaks[:-1, None] + np.diff(breaks)[:, None] * steps).ravel()
        places = np.append(places, breaks[-1])
        points = np.array([complex(point.x, point.y) for point in curve.points(places.tolist())])
        used = points[::2] if fine else points
        chord = np.diff(used)
        # the turn at an inner point of an arc is half the arc's angle
        turn = np.angle(chord[1::2] * np.conj(chord[::2]))
        piece = DrawnPiece(used[::2], np.tan(0.5 * turn), closed=False)
        if not fine or count >= _MOST_ARCS or _missed(piece, points) <= within:
            return piece
        count *= 2


def _missed(piece: DrawnPiece, points: Plane) -> float:
    """Return by how much arcs, through every second point, miss the points between, mm."""
    start, chord, bends = bulge_pieces(piece.points, piece.bulges, False)
    half = 2.0 * np.arctan(bends)
    along = chord / np.abs(chord) * np.exp(-1j * half)
    bend = 2.0 * np.sin(half) / np.abs(chord)
    between = [(points[k::4] - start) / along for k in (1, 3)]
    return float(max(off_circle(local, bend).max() for local in between))


_DRAWN_IN_SPACE: Final = ("LINE", "SPLINE")
"""Types whose coordinates do not depend on their extrusion."""

_SHAPES: Final = {
    "LINE": _line,
    "ARC": _arc,
    "CIRCLE": _circle,
    "ELLIPSE": _ellipse,
    "SPLINE": _spline,
    "LWPOLYLINE": _light_polyline,
    "POLYLINE": _heavy_polyline,
}
"""What makes a piece of an entity, by the type of the entity."""
