"""Openings of a wheel: bore with keyway or flat, bolt holes, lightening holes, stop slot.

All are exact chains of arcs and straight pieces. Round lightening holes lie in equal sectors; each
is the largest circle that leaves the rim below the roots and the web to everything else. The slot
of an open wheel is an arc about the shaft: a pin in the housing, on the line of centres, meets its
ends at the ends of travel.

Openings that meet each other, the hub's edge or the outline are refused, and holes for which rim
and web leave no space, with the largest size that fits.

Depends on parts' shapes and numeric; shapely inside the functions.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.adjustments import Adjustment
from gearcam.base.display import ShortRepr
from gearcam.base.errors import InfeasibleError, beyond_limit
from gearcam.base.quantities import params_of
from gearcam.numeric.arrays import Array, Plane, as_pairs
from gearcam.numeric.contour import Contour
from gearcam.numeric.polygons import room_around
from gearcam.parts.blank import RowBlank, ShaftBlank, serving
from gearcam.parts.body import Edge, Opening
from gearcam.parts.fits import FitSize
from gearcam.parts.shapes import Circle, Loop

if TYPE_CHECKING:
    from shapely import Polygon


_FINE: Final = 4e-5
"""Chord error of openings in tests for overlap, in rims."""

_SEARCH: Final = 1e-3
"""Tolerance of the largest circle, in rims; the hole is made smaller by it."""

_RIMS: Final = 32
"""Chords per quarter circle around the outline's corners."""

_RADII: Final = 128
_RAYS: Final = 91
"""Numbers of radii and directions in the search for the best place of a stop slot."""

_QUARTER: Final = 64
"""Chords per quarter circle of the clear zone around core and openings."""

_SMALLER: Final = (
    ("bolt", "bolt_diameter_mm", 0.1),
    ("hub", "hub_diameter_mm", 0.1),
    ("bore", "bore_diameter_mm", 0.1),
)
"""Text of a refusal, and the keys to reduce, with their least values, mm."""

_STOP: Final = "blank.stop_pin_mm"
"""The key of a stop pin, in messages."""

_FARTHER: Final = 2.0
_NEARER: Final = 0.05
"""Factors by which bolt positions are moved in remedies."""


@dataclass(frozen=True, kw_only=True)
class Workpiece:
    """The finished piece of a blank: a wheel of a pair, or a cam.

    Parameters
    ----------
    name : str
        Its name in messages.
    rim : float, mm
        Default of the rim between lightening holes and the edge.
    travel : float or None, rad
        Travel of an open wheel; None for a closed one.
    wheel : int or None
        1 or 2; None for a single part.
    within : str
        Name of the boundary of its openings.
    process : str
        How it is made, which decides how wide and deep its marks are.
    bar : bool
        Whether it is a rack, whose holes are those of its bar.
    """

    name: str
    rim: float
    travel: float | None = None
    wheel: int | None = None
    within: str = "the outline"
    process: str = "milling"
    bar: bool = False

    def points(self, edge: Edge) -> Array:
        """Return points of an `edge`, (n, 2), mm, for tests of overlap."""
        return as_pairs(edge.polyline(self.sagitta))

    @property
    def sagitta(self) -> float:
        """Largest distance of the chords between those points from the edge, mm."""
        return _FINE * self.rim

    def key(self, name: str) -> str:
        """Return the dotted key of its value of key `name` in ``[blank]``, or of its bar."""
        if self.bar and name.startswith(("bolt", "height")):
            return f"bar.{name}"
        return f"blank.{name}" if self.wheel is None else f"blank.{name}[{self.wheel - 1}]"

    def without(self, blank: ShaftBlank, name: str) -> dict[str, object]:
        """Return the change of a `blank` that leaves out `name`, with all that serves it."""
        params = params_of(type(blank))
        names = [one for one in (name, *sorted(serving((name,)))) if getattr(blank, one)]
        return {self.key(params[one].key(one)): 0 for one in names}

    def refusal(
        self,
        what: str,
        value: float | None,
        limit: float | None,
        note: str,
        adjustments: Sequence[Adjustment],
        place: str = "",
    ) -> InfeasibleError:
        """Return the refusal of a value, mm, beyond its limit (see `beyond_limit`)."""
        where = f"{self.name}, {place or ('[bar]' if self.bar else '[blank]')}"
        return beyond_limit(what, where, value, limit, note, adjustments=adjustments, unit="mm")


@dataclass(frozen=True, eq=False, kw_only=True)
class Stock(ShortRepr):
    """What openings go through: the region common to all steps of a wheel or a ring.

    Parameters
    ----------
    contours : sequence of Contour or Circle
        The outlines of the steps.
    work : Workpiece
        The wheel.
    inner : sequence of Contour
        For a ring: the inner edges of the steps.
    """

    contours: Sequence[Edge]
    work: Workpiece
    inner: Sequence[Edge] = ()

    @cached_property
    def region(self) -> Polygon:
        """The region, without openings."""
        from shapely import Polygon, intersection_all

        outlines, holes = self._edges
        regions = [
            Polygon(as_pairs(edge), [as_pairs(hole) for hole in at])
            for edge, at in zip(
                outlines, [[hole] for hole in holes] or [[]] * len(outlines), strict=True
            )
        ]
        made: Any = intersection_all(regions)
        return made

    def room(self, place: complex) -> float:
        """Return the distance of a place, mm, from the region's boundary, 0 outside."""
        return room_around(place, *self._edges)

    @cached_property
    def _edges(self) -> tuple[list[Plane], list[Plane]]:
        """Points of the outlines, and those of the inner edges."""
        outlines, holes = (
            [one.polyline(self.work.sagitta) for one in edges]
            for edges in (self.contours, self.inner)
        )
        return outlines, holes


def bore(blank: ShaftBlank) -> Circle | Loop:
    """Return the bore with its keyway or flats.

    Parameters
    ----------
    blank : ShaftBlank
        With the sizes of its bore; the direction of keyway and flats is the same. Two flats are a
        loop of four points: the ends of the first, then those of the second.

    Returns
    -------
    Circle or Loop
        Around the axis.
    """
    blank = blank.sized
    radius = 0.5 * blank.bore
    turn = cmath.exp(1j * blank.keyway_angle)
    if blank.keyway_width:
        half, floor = 0.5 * blank.keyway_width, radius + blank.keyway_depth
        foot = math.sqrt(radius**2 - half**2)
        corners = [foot + 1j * half, foot - 1j * half, floor - 1j * half, floor + 1j * half]
        return _with_arc(corners, 2.0 * (math.pi - math.asin(half / radius)), turn)
    if blank.bore_flat:
        away = blank.bore_flat - radius
        half = math.sqrt(radius**2 - away**2)
        angle = 2.0 * (math.pi - math.acos(away / radius))
        return _with_arc([away + 1j * half, away - 1j * half], angle, turn)
    if blank.bore_across_flats:
        away = 0.5 * blank.bore_across_flats
        corner = complex(away, math.sqrt(radius**2 - away**2))
        ends = np.array([corner.conjugate(), corner, -corner.conjugate(), -corner])
        bend = math.tan(0.5 * math.asin(away / radius))
        return Loop(points=ends * turn, bulges=np.array([0.0, bend, 0.0, bend]))
    return Circle(center=0j, diameter=blank.bore)


def _with_arc(corners: list[complex], angle: float, turn: complex) -> Loop:
    """Return the loop of corners: an arc about the origin to the second, then straight lines."""
    middle = corners[0] * cmath.exp(0.5j * angle)
    points = np.array([corners[0], middle, *corners[1:]]) * turn
    bulges = np.zeros(len(points))
    bulges[:2] = math.tan(0.125 * angle)
    return Loop(points=points, bulges=bulges)


def _bolts(blank: ShaftBlank) -> Iterator[Opening]:
    for number in range(blank.bolts):
        angle = blank.bolt_angle + 2.0 * math.pi * number / blank.bolts
        yield _hole(number, cmath.rect(0.5 * blank.bolt_circle, angle), blank.bolt_diameter)


def _hole(number: int, center: complex, diameter: float) -> Opening:
    """Return the hole of a bolt; its `number` counts from 0."""
    shape, fits = Circle(center=center, diameter=diameter), fits_of(diameter=diameter)
    return Opening(kind="HOLE", shape=shape, name=f"bolt hole {number + 1}", fits=fits)


def fits_of(**sizes: float | None) -> dict[str, FitSize]:
    """Return those of some sizes that have tolerance classes, by their names."""
    return {name: size for name, size in sizes.items() if isinstance(size, FitSize)}


def row_of_holes(row: RowBlank, foot: complex, along: complex, up: complex) -> Iterator[Opening]:
    """Yield the mounting holes of what slides.

    Parameters
    ----------
    row : RowBlank
        Their sizes.
    foot : complex, mm
        The middle of the back, from which the height of the row counts.
    along, up : complex
        Directions of the row, and from the back to it: unit vectors.
    """
    for number in range(row.bolts):
        aside = (number - 0.5 * (row.bolts - 1)) * (row.bolt_spacing or 0.0)
        center = foot + aside * along + (row.bolt_height or 0.0) * up
        yield _hole(number, center, row.bolt_diameter)


def openings(
    blank: ShaftBlank, contours: Sequence[Edge], work: Workpiece, inner: Sequence[Edge] = ()
) -> tuple[Opening, ...]:
    """Return all openings of a wheel.

    Parameters
    ----------
    blank : ShaftBlank
        Settings of the blank.
    contours : sequence of Contour or Circle
        The outlines of its steps.
    work : Workpiece
        The wheel.
    inner : sequence of Contour
        For a ring: the inner edges of its steps.

    Returns
    -------
    tuple of Opening
        Bore, bolt holes, stop slot, lightening holes, as far as requested, with finished sizes.

    Raises
    ------
    InfeasibleError
        If they meet each other, the hub's edge or the outline, or have no space.
    """
    stock = Stock(contours=contours, work=work, inner=inner)
    wide = blank.widened
    made, own = [], blank.sized
    if blank.bore:
        fits = fits_of(diameter=own.bore_diameter, keyway=own.keyway_width)
        made = [Opening(kind="BORE", shape=bore(wide), name="bore", fits=fits)]
    made += _bolts(wide)
    if blank.stop_pin:
        chord = max((one.tolerance for one in contours if isinstance(one, Contour)), default=0.0)
        made.append(_slot(blank, stock.region, work, chord))
    bolts = {"bolt_circle_mm": blank.bolt_circle}
    demand_apart(made, stock, bolts, hub=blank.hub_diameter, widening=blank.widening)
    if blank.lightening_holes:
        made += _lightening(wide, stock.region, made, work)
    return tuple(made)


def demand_apart(
    found: Sequence[Opening],
    stock: Stock,
    places: Mapping[str, float],
    *,
    hub: float = 0.0,
    widening: float = 0.0,
) -> None:
    """Refuse openings that meet each other, the hub's edge or the outline.

    Parameters
    ----------
    found : sequence of Opening
        The openings.
    stock : Stock
        What they go through.
    places : mapping of str to float
        Keys of ``[blank]`` that position the bolts, with their values, mm.
    hub : float, mm
        Diameter of the hub; 0 without one.
    widening : float, mm
        By how much openings are wider than given.

    Raises
    ------
    InfeasibleError
        If any two meet.
    """
    # chords of openings that touch each other may be apart by this
    gap = 2.0 * stock.work.sagitta
    if _plainly_apart(found, stock, 2.0 * gap, hub):
        return
    from shapely import Polygon

    edges = [stock.work.points(opening.shape) for opening in found]
    regions = [Polygon(edge) for edge in edges]
    solid = stock.region
    for number, (opening, edge, region) in enumerate(zip(found, edges, regions, strict=True)):
        if not solid.contains(region) or solid.boundary.dwithin(region, gap):
            raise _no_room(opening, stock, stock.work.within, widening, places)
        away = np.hypot(*edge.T)
        if hub and away.min() <= 0.5 * hub <= away.max():
            raise _no_room(opening, stock, "the edge of the hub", widening, places)
        for other, second in zip(found[:number], regions[:number], strict=True):
            if region.dwithin(second, gap):
                raise _no_room(opening, stock, f"the {other.name}", widening, places)


def _plainly_apart(found: Sequence[Opening], stock: Stock, gap: float, hub: float) -> bool:
    """Return whether all openings are round, and farther than `gap`, mm, from all they may meet."""
    round_ones: list[Circle] = []
    for opening in found:
        one = opening.shape
        if not isinstance(one, Circle):
            return False
        radius = 0.5 * one.diameter
        rooms = [stock.room(one.center)]
        rooms += [abs(other.center - one.center) - 0.5 * other.diameter for other in round_ones]
        if hub:
            rooms.append(abs(abs(one.center) - 0.5 * hub))
        if min(rooms) <= radius + gap:
            return False
        round_ones.append(one)
    return True


def _no_room(
    opening: Opening,
    stock: Stock,
    what: str,
    widening: float,
    places: Mapping[str, float],
) -> InfeasibleError:
    """Return the refusal of an opening that meets something; diameters as given in the design."""
    work, shape, value, limit = stock.work, opening.shape, None, None
    note = "they must not overlap"
    if isinstance(shape, Circle) and what == work.within:
        room = stock.room(shape.center)
        value = shape.diameter - widening
        limit = 2.0 * room - widening if room else None
        note = f"its centre lies outside {what}"
        if limit:
            note = "the limit is the free space around its centre"
    crossing = f"{opening.name} {what}"
    adjustments = [
        Adjustment(far={work.key(key): small}) for word, key, small in _SMALLER if word in crossing
    ]
    if "bolt" in crossing:
        if work.wheel is not None and not work.bar:  # the other wheel keeps its own
            adjustments.insert(0, Adjustment(near={work.key("bolts"): 0}))
        adjustments += [
            Adjustment(far={work.key(key): times * place})
            for key, place in places.items()
            for times in (_NEARER, _FARTHER)
        ]
    return work.refusal(f"the {opening.name} meets {what}", value, limit, note, adjustments)


def _slot(blank: ShaftBlank, solid: Polygon, work: Workpiece, chord: float) -> Opening:
    """Return the slot for the stop pin of an open wheel.

    Wheel 1 turns by -phi1 and wheel 2 by phi2: in the wheel's frame the pin, on the line of
    centres, moves from the polar angle 0 to the travel, or from pi back by the travel. Chords of
    its inner edge come nearer to the shaft than the edge, by `chord`, mm.
    """
    key = work.key("stop_pin_mm")
    if work.travel is None:
        what = "a closed wheel turns all around: it has no stop"
        note = "only wheels of an open law (driven_travel_deg) have a stop"
        without = (Adjustment(near={key: 0.0}),)
        raise work.refusal(what, blank.stop_pin, None, note, without, _STOP)
    start = 0.0 if work.wheel == 1 else math.pi - work.travel
    wide = blank.widened
    inner = max(wide.bore_reach, 0.5 * blank.hub_diameter)
    radius, room = _roomiest(solid, start, work.travel, inner)
    room -= blank.widening + 2.0 * chord
    if blank.stop_pin >= room:
        what = "no room for the slot of the stop pin between shaft and roots"
        note = "the limit is the widest slot that fits"
        smaller = (Adjustment(near={key: room}, far={key: 0.1 * room}),)
        raise work.refusal(what, blank.stop_pin, room, note, smaller, _STOP)
    shape = _arc_slot(radius, start, work.travel, wide.stop_pin)
    return Opening(kind="SLOT", shape=shape, name="stop slot")


def _roomiest(solid: Polygon, start: float, travel: float, inner: float) -> tuple[float, float]:
    """Return the radius of the arc with the most space around it, and the width of slot it allows.

    The round ends of the slot must clear the end faces of the sector as well.
    """
    from shapely import STRtree, get_coordinates, linestrings, points

    ring = get_coordinates(solid.boundary)
    segments: Any = linestrings(np.stack([ring[:-1], ring[1:]], axis=1))
    radii = inner + (np.hypot(*ring.T).max() - inner) * np.arange(1, _RADII) / _RADII
    rays = np.exp(1j * (start + travel * np.linspace(0.0, 1.0, _RAYS)))
    places = (radii[:, None] * rays).ravel()
    made: Any = points(places.real, places.imag)
    _, away = STRtree(segments).query_nearest(made, return_distance=True, all_matches=False)
    free = np.where(np.asarray(solid.contains(made)), away, 0.0)
    # past half a turn the two ends of the slot approach each other
    apart = radii * math.sin(0.5 * travel) if travel > math.pi else np.inf
    room = np.minimum(np.minimum(free.reshape(len(radii), _RAYS).min(axis=1), radii - inner), apart)
    best = int(room.argmax())
    return float(radii[best]), 2.0 * float(room[best])


def _arc_slot(radius: float, start: float, sweep: float, width: float) -> Loop:
    """Return a slot of constant width along an arc about the origin, with half-round ends."""
    parts = max(1, math.ceil(sweep / (0.9 * math.pi)))
    outwards = start + sweep * np.linspace(0.0, 1.0, parts + 1)
    outer = (radius + 0.5 * width) * np.exp(1j * outwards)
    inner = (radius - 0.5 * width) * np.exp(1j * outwards[::-1])
    points = np.asarray(np.concatenate([outer, inner]), dtype=np.complex128)
    bend = math.tan(0.25 * sweep / parts)
    bulges = [*[bend] * parts, 1.0, *[-bend] * parts, 1.0]
    return Loop(points=points, bulges=np.array(bulges))


def _lightening(
    blank: ShaftBlank, solid: Polygon, others: Sequence[Opening], work: Workpiece
) -> Iterator[Opening]:
    """Yield the largest circle in each sector that leaves rim and web."""
    from shapely import Point, Polygon, maximum_inscribed_circle, union_all

    rim = blank.rim or work.rim
    web = blank.web or rim
    count = blank.lightening_holes
    core = max(blank.bore_reach, 0.5 * blank.hub_diameter)
    far = 2.0 * float(np.abs(solid.bounds).max())
    fine = _SEARCH * rim
    outside = 1.0 / math.cos(math.pi / (4 * _QUARTER))  # chords outside the arcs, not inside
    taken = [Point(0.0, 0.0).buffer((core + web) * outside, quad_segs=_QUARTER)]
    taken += [
        Polygon(as_pairs(other.shape.polyline(fine))).buffer(web * outside, quad_segs=_QUARTER)
        for other in others
        if other.kind != "BORE"
    ]
    free: Any = solid.buffer(-rim, quad_segs=_RIMS).difference(union_all(taken))
    for number in range(count):
        middle = 2.0 * math.pi * (number + 0.5) / count
        room = free if count == 1 else free.intersection(_sector(middle, math.pi / count, far, web))
        size, center = 0.0, None
        for piece in getattr(room, "geoms", (room,)):
            if not piece.is_empty and piece.geom_type == "Polygon":
                spoke = maximum_inscribed_circle(piece, tolerance=fine)
                if spoke.length > size:
                    size, center = float(spoke.length), complex(*spoke.coords[0])
        size -= fine
        if center is None or size <= 0.0:
            raise _no_lightening(number + 1, solid, core, rim, blank, work)
        name = f"lightening hole {number + 1}"
        yield Opening(kind="HOLE", shape=Circle(center=center, diameter=2.0 * size), name=name)


def _sector(middle: float, half: float, far: float, web: float) -> Polygon:
    """Return the sector between two spokes of width `web`."""
    from shapely import Polygon

    apex = 0.5 * web / math.sin(half) * cmath.exp(1j * middle)
    rays = [apex + far * cmath.exp(1j * (middle + side * half)) for side in (-1.0, 0.0, 1.0)]
    rays[1] = apex + 2.0 * far * cmath.exp(1j * middle)
    return Polygon([(point.real, point.imag) for point in (apex, *rays)])


def _no_lightening(
    number: int, solid: Polygon, core: float, rim: float, blank: ShaftBlank, work: Workpiece
) -> InfeasibleError:
    from shapely import Point

    least = solid.boundary.distance(Point(0.0, 0.0))
    what = f"lightening hole {number} has no room between hub and rim"
    note = "the value is the distance between hub or bore and the nearest root"
    adjustments = (
        Adjustment(near={"blank.rim_mm": 0.5 * rim}),
        Adjustment(far={work.key("lightening_holes"): 1}),
        Adjustment(far={work.key("hub_diameter_mm"): 0.0}),
        Adjustment(near=work.without(blank, "lightening_holes")),
    )
    return work.refusal(what, least - core, None, note, adjustments)
