"""Bodies: solids made in one piece. A part is a body built from layers.

A *body* has a name, a chord tolerance, a solid and moments of its volume; it need not be a prism
(see `solids.solid`). A *layer* is a prism: the plane inside one edge, less openings, between two
heights. Outlines, openings or both may be toothed.

A *part* is a body of layers, in its wheel's frame: its toothed plate from z = 0 to its width, hubs
beyond. A *stepped* part has several outlines, one above the other, all of the same height.
*Openings* go right through, also through the hub; each step may have an *inner* edge, such as the
teeth of a ring. *Pockets* are cut into its surface: *marks*, shallow round ones, and an *arrow* are
engraved in the upper face, a *recess* is milled into either face, a *bevel* is what the chamfer of
an edge takes.

Depends on numeric; shapely only inside `Part.region`.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Literal, Protocol, cast

import numpy as np

from gearcam.base.display import NotebookView, ShortRepr, renderer
from gearcam.base.facts import Facts
from gearcam.numeric.arrays import Array, as_pairs, bounds
from gearcam.numeric.contour import Contour
from gearcam.numeric.moments import Moments
from gearcam.parts.shapes import Circle, Loop, true_points

if TYPE_CHECKING:
    from shapely import Polygon


Kind = Literal["BORE", "HOLE", "SLOT", "INNER", "GROOVE"]
"""Purpose of an opening: shaft, bolts or lightening, stop pin, inner teeth, roller."""

_FINE: Final = 1e-8
"""Chord error of a bore where a set screw meets it, over the radius of its hole."""

_CORNERS: Final = 12
"""Most corners of a profile that is not toothed."""

_CHORDS: Final = 2048
"""Chords of the hole of a set screw at which its depth is taken."""

Edge = Contour | Circle | Loop
"""A closed plane curve, counter-clockwise, with moments, length, reach and points."""


class Body(Protocol):
    """A solid made in one piece, prism or not."""

    @property
    def name(self) -> str:
        """Name, such as ``gear1``: the stem of its files."""
        ...

    @property
    def tolerance(self) -> float:
        """Chord tolerance of all its curves, mm."""
        ...


@dataclass(frozen=True, eq=False, kw_only=True)
class Opening(ShortRepr):
    """An opening right through a part.

    Parameters
    ----------
    kind : {"BORE", "HOLE", "SLOT", "INNER", "GROOVE"}
        Purpose, and layer in drawings.
    shape : Contour or Circle or Loop
        Its edge, in the part's frame.
    name : str
        Its name in messages, such as ``bolt hole 2``.
    fits : mapping of str to float, mm
        Its sizes that have tolerance classes, each a `gearcam.parts.fits.FitSize`: ``diameter``,
        ``keyway``.
    """

    kind: Kind
    shape: Edge
    name: str
    fits: Mapping[str, float] = field(default_factory=dict)

    def as_dict(self) -> dict[str, Any]:
        """Return the opening as JSON data: kind and name, for a circle also centre and diameter."""
        made: dict[str, Any] = {"kind": self.kind.lower(), "name": self.name}
        if isinstance(self.shape, Circle):
            center = self.shape.center
            made |= {"center_mm": [center.real, center.imag], "diameter_mm": self.shape.diameter}
        return made | {"area_mm2": self.shape.moments.area}


@dataclass(frozen=True, eq=False, kw_only=True)
class Layer(ShortRepr):
    """A prism: the region within `edge` less `openings`, from z = `low` to `high`, mm."""

    edge: Edge
    low: float
    high: float
    openings: tuple[Opening, ...] = ()

    @property
    def height(self) -> float:
        """Height from its lower to its upper face, mm."""
        return self.high - self.low

    @property
    def edges(self) -> tuple[Edge, ...]:
        """Its edge, and the edges of its openings."""
        return self.edge, *(opening.shape for opening in self.openings)

    @property
    def moments(self) -> Moments:
        """Moments of the plane region."""
        through = (opening.shape.moments for opening in self.openings)
        return self.edge.moments - sum(through, start=Moments())


@dataclass(frozen=True, eq=False, kw_only=True)
class Recess(Layer):
    """A pocket milled into a face, such as a groove: the prism within its edge less islands.

    Parameters
    ----------
    width : float, mm
        Diameter of the largest round tool that can mill it.
    place : complex, mm
        A point where no larger tool fits.
    front : bool
        Whether it is open to the upper face; if not, to the lower one.
    """

    width: float
    place: complex
    front: bool = True


@dataclass(frozen=True, eq=False, kw_only=True)
class Bevel(Layer):
    """What a chamfer at 45 deg takes from an edge in a face.

    Parameters
    ----------
    edge : Contour or Circle or Loop
        The edge.
    middle, face : Contour or Circle
        Its parallels at half the depth and in the face.
    up : bool
        Whether the face is an upper one.
    hollow : bool
        Whether the metal is outside the edge, as of a bore.
    """

    middle: Contour | Circle
    face: Contour | Circle
    up: bool
    hollow: bool

    def on(self, layer: Layer) -> bool:
        """Return whether it is of the edge of a `layer`, in its face on this side."""
        level = self.high == layer.high if self.up else self.low == layer.low
        return level and not self.hollow and self.cuts(layer.edge)

    def cuts(self, edge: Edge) -> bool:
        """Return whether it is of an `edge`, or of an equal circle."""
        alike = False
        if isinstance(self.edge, Circle) and isinstance(edge, Circle):
            alike = (self.edge.center, self.edge.diameter) == (edge.center, edge.diameter)
        return alike or self.edge is edge

    @property
    def edges(self) -> tuple[Edge, ...]:
        """Its edge in the face."""
        return (self.face,)

    @property
    def uneven(self) -> float:
        """How far the area half-way is from that of parallels which lose no detail, mm^2."""
        way = 1.0 if self.hollow else -1.0
        edge, middle, face = (one.moments.area for one in (self.edge, self.middle, self.face))
        return abs(middle - 0.25 * (face + 3.0 * edge + way * self.height * self.edge.length))

    @property
    def moments(self) -> Moments:
        """Moments of the plane region, on the average over its height."""
        # areas between parallels are quadratic in the distance, for which this is exact
        inside = self.edge.moments + 4.0 * self.middle.moments + self.face.moments
        taken = self.edge.moments - (1.0 / 6.0) * inside
        return -1.0 * taken if self.hollow else taken


@dataclass(frozen=True, eq=False, kw_only=True)
class ScrewHole(Layer):
    """The tapping hole of a set screw, from the bore through a hub.

    Parameters
    ----------
    edge : Circle
        The hub.
    openings : tuple of Opening
        The bore.
    size : str
        Its thread, such as ``M4``.
    angle : float, rad
        Its direction.
    """

    size: str
    angle: float

    @property
    def drill(self) -> float:
        """Its diameter, mm."""
        return self.height

    @property
    def middle(self) -> float:
        """Height of its axis, mm."""
        return 0.5 * (self.low + self.high)

    @property
    def moments(self) -> Moments:
        """Moments of its plane region, on the average over its height."""
        (bore,), radius = (one.shape for one in self.openings), 0.5 * self.drill
        edge = bore.polyline(_FINE * radius) * np.exp(-1j * self.angle)
        edge = edge[edge.real > 0.0]
        level = np.round(edge.imag, 9)
        # the walls of a keyway are at one height: its floor is within them
        edge = edge[np.lexsort((np.where(level < 0.0, edge.real, -edge.real), level))]
        steps = np.arange(1, _CHORDS + 1) * math.pi / (_CHORDS + 1)
        # Gauss points for the width of the hole over its height as the weight
        aside, weights = radius * np.cos(steps), np.sin(steps) ** 2
        inner = np.interp(aside, edge.imag, edge.real)
        outer = np.sqrt((0.5 * cast("Circle", self.edge).diameter) ** 2 - aside**2)
        weights *= math.pi / (_CHORDS + 1) * radius
        first = complex((weights * 0.5 * (outer**2 - inner**2)).sum())
        polar = (weights * ((outer**3 - inner**3) / 3.0 + aside**2 * (outer - inner))).sum()
        return Moments(
            area=float((weights * (outer - inner)).sum()),
            first=first * cmath.exp(1j * self.angle),
            polar=float(polar),
        )


@dataclass(frozen=True, kw_only=True)
class Hub:
    """A round boss around the axis: `diameter`, and projection in `front` and at the `back`, mm."""

    diameter: float
    front: float = 0.0
    back: float = 0.0


@dataclass(frozen=True, eq=False, kw_only=True)
class Mark(ShortRepr):
    """A round dimple in the upper face.

    Parameters
    ----------
    center : complex, mm
        In the part's frame.
    diameter, depth : float, mm
        Of the cylinder that is removed.
    """

    center: complex
    diameter: float
    depth: float

    @property
    def edge(self) -> Circle:
        """Its edge."""
        return Circle(center=self.center, diameter=self.diameter)


@dataclass(frozen=True, eq=False, kw_only=True)
class Arrow(ShortRepr):
    """An arrow engraved in the upper face, which shows how a part moves.

    Parameters
    ----------
    edge : Loop
        Its outline, in the part's frame.
    depth : float, mm
        Its depth.
    """

    edge: Loop
    depth: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Part(ShortRepr, NotebookView):
    """A body built from layers: a plate, stepped or not, with a hub.

    Parameters
    ----------
    name : str
        Name, such as ``gear1``: the stem of its files.
    contours : tuple of Contour
        Outlines in the part's frame, counter-clockwise: one, or those of the steps from z = 0 up.
        For a ring they may be circles.
    width : float, mm
        From z = 0 to z = width, divided equally between the steps.
    openings : tuple of Opening
        Openings right through; none meets another or an outline.
    inner : tuple of Contour
        Toothed inner edges of a ring, one for each outline; none for wheels.
    hub : Hub or None
        Hub within the roots.
    marks : tuple of Mark
        Marks engraved in the face z = width.
    recesses : tuple of Recess
        Pockets milled into either face; they do not overlap in depth.
    arrow : Arrow or None
        How it moves, engraved in the face z = width.
    screw : ScrewHole or None
        Set screw in a hub.
    bevels : tuple of Bevel
        Chamfers of edges in faces.
    turns : bool
        Whether it turns about the origin, if that lies within its outline.

    Raises
    ------
    ValueError
        If a contour runs clockwise, the width is not positive, or inner edges do not match the
        outlines.
    """

    name: str
    contours: tuple[Contour | Circle, ...]
    width: float
    openings: tuple[Opening, ...] = ()
    inner: tuple[Contour, ...] = ()
    hub: Hub | None = None
    marks: tuple[Mark, ...] = ()
    recesses: tuple[Recess, ...] = ()
    arrow: Arrow | None = None
    screw: ScrewHole | None = None
    bevels: tuple[Bevel, ...] = ()
    turns: bool = True

    def __post_init__(self) -> None:
        edges = (*self.contours, *self.inner)
        if not all(edge.area > 0 for edge in edges if isinstance(edge, Contour)):
            raise ValueError(f"{self.name}: the contour must run counter-clockwise")
        if not self.width > 0:
            raise ValueError(f"{self.name}: the width must be positive, not {self.width} mm")
        if len(self.inner) not in (0, len(self.contours)):
            raise ValueError(f"{self.name}: give an inner edge for each outline, or for none")

    @property
    def contour(self) -> Contour:
        """The outline, or for a ring the inner edge; for a stepped part the lowest."""
        return cast("Contour", (self.inner or self.contours)[0])

    @cached_property
    def facts(self) -> Facts:
        """Facts of the part; the facts of its result contain more."""
        tree = {
            "width_mm": self.width,
            "size_mm": list(self.size),
            "area_mm2": self.steps[0].moments.area,
            "volume_mm3": self.volume,
            "steps": len(self.contours) if len(self.contours) > 1 else None,
            "openings": [opening.as_dict() for opening in self.openings] or None,
            "outline": {
                "vertices": len(self.outline),
                "length_mm": self.contour.length,
                "area_mm2": self.contour.area,
                "chord_error_mm": self.contour.chord_error,
            },
        }
        return Facts(tree, ("width_mm",), self.name)

    def picture(self) -> str:
        """Return a drawing of the (lowest) outline with its openings, SVG, in the part's frame."""
        step = self.steps[0]
        edges = [step.edge, *(opening.shape for opening in step.openings)]
        for pocket in (*self._engravings, *self.recesses):
            edges += [pocket.edge, *(island.shape for island in pocket.openings)]
        return renderer().outlines(
            self.facts.headline, [edge.polyline(self.tolerance) for edge in edges]
        )

    @property
    def outline(self) -> Array:
        """Vertices of the finished outline, (n, 2), mm, counter-clockwise, in the part's frame."""
        return self.contour.vertices

    @property
    def tolerance(self) -> float:
        """Chord tolerance of all its curves, mm."""
        return self.contour.tolerance

    @cached_property
    def steps(self) -> tuple[Layer, ...]:
        """The plate, or its steps from the lowest up."""
        height = self.width / len(self.contours)
        inner = [Opening(kind="INNER", shape=edge, name="inner edge") for edge in self.inner]
        return tuple(
            Layer(
                edge=contour,
                low=number * height,
                high=(number + 1) * height,
                openings=(*inner[number : number + 1], *self.openings),
            )
            for number, contour in enumerate(self.contours)
        )

    @cached_property
    def bosses(self) -> tuple[Layer, ...]:
        """The hub at the back and in front, if any, with the openings through it."""
        if self.hub is None:
            return ()
        disc = Circle(center=0j, diameter=self.hub.diameter)
        within = tuple(o for o in self.openings if o.shape.reach < 0.5 * self.hub.diameter)
        ends = ((-self.hub.back, 0.0), (self.width, self.width + self.hub.front))
        return tuple(
            Layer(edge=disc, low=low, high=high, openings=within)
            for low, high in ends
            if high > low
        )

    @property
    def layers(self) -> tuple[Layer, ...]:
        """All layers of the part."""
        return self.steps + self.bosses

    @property
    def engraved(self) -> tuple[Mark | Arrow, ...]:
        """What is engraved in the upper face: marks and the arrow."""
        return (*self.marks, *(() if self.arrow is None else (self.arrow,)))

    @cached_property
    def _engravings(self) -> tuple[Layer, ...]:
        return tuple(
            Layer(edge=one.edge, low=self.width - one.depth, high=self.width)
            for one in self.engraved
        )

    @cached_property
    def pockets(self) -> tuple[Layer, ...]:
        """What is cut into its surface: engravings, recesses, chamfers, the hole of a screw."""
        screw = () if self.screw is None else (self.screw,)
        return (*self._engravings, *self.recesses, *self.bevels, *screw)

    def cutters(self, overshoot: float) -> tuple[Layer, ...]:
        """Return engravings and recesses as solids to subtract.

        They go beyond their face by `overshoot`, over their depth.
        """
        front = (*self._engravings, *(one for one in self.recesses if one.front))
        back = (one for one in self.recesses if not one.front)
        return (
            *(replace(one, high=self.width + overshoot * one.height) for one in front),
            *(replace(one, low=-overshoot * one.height) for one in back),
        )

    @property
    def bore(self) -> Opening | None:
        """The bore."""
        return next((one for one in self.openings if one.kind == "BORE"), None)

    @property
    def smooth_bevels(self) -> tuple[Bevel, ...]:
        """The chamfers of round edges, bores and profiles, not those of teeth."""
        return tuple(
            one
            for one in self.bevels
            if not isinstance(one.edge, Contour) or len(one.edge.runs) <= _CORNERS
        )

    @property
    def chamfer(self) -> float:
        """The chamfer of its edges, mm; 0 without one."""
        return self.bevels[0].height if self.bevels else 0.0

    @cached_property
    def volume(self) -> float:
        """Volume of the true shape, mm^3."""
        whole = sum(layer.height * layer.moments.area for layer in self.layers)
        return whole - sum(pocket.height * pocket.moments.area for pocket in self.pockets)

    @cached_property
    def region(self) -> Polygon:
        """The (lowest) outline with its openings, chords within the tolerance."""
        from shapely import Polygon

        step = self.steps[0]
        holes = [as_pairs(one.shape.polyline(self.tolerance)) for one in step.openings]
        return Polygon(as_pairs(step.edge.polyline(self.tolerance)), holes)

    @property
    def size(self) -> tuple[float, float, float]:
        """Extents along x, y and z of its frame, mm, hub included: those of the true edges."""
        edges = (one.edge for one in self.layers if not isinstance(one.edge, Loop))
        low, high = bounds(true_points(edges))
        return (high - low).real, (high - low).imag, self.thickness

    @property
    def ends(self) -> tuple[float, float]:
        """Heights of the lowest and the highest face, mm."""
        return min(one.low for one in self.layers), max(one.high for one in self.layers)

    @property
    def thickness(self) -> float:
        """Height from the lowest to the highest face, mm."""
        return self.ends[1] - self.ends[0]


@dataclass(frozen=True, eq=False, kw_only=True)
class Stack(ShortRepr):
    """Parts that are fixed to one shaft, as conjugate cams are: a body of all their layers.

    Parameters
    ----------
    name : str
        See `Body`.
    parts : tuple of Part
        The parts, whose frames differ by their heights only.
    heights : tuple of float, mm
        Where z = 0 of each is.
    """

    name: str
    parts: tuple[Part, ...]
    heights: tuple[float, ...] = (0.0,)

    @property
    def tolerance(self) -> float:
        """Largest chord tolerance of the parts, mm."""
        return max(part.tolerance for part in self.parts)

    @property
    def layers(self) -> tuple[Layer, ...]:
        """All layers of the parts."""
        return self._raised([part.layers for part in self.parts])

    @property
    def pockets(self) -> tuple[Layer, ...]:
        """All marks and recesses of the parts."""
        return self._raised([part.pockets for part in self.parts])

    def _raised(self, several: Sequence[Sequence[Layer]]) -> tuple[Layer, ...]:
        return tuple(
            replace(one, low=one.low + height, high=one.high + height)
            for layers, height in zip(several, self.heights, strict=True)
            for one in layers
        )
