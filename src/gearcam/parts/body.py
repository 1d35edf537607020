"""Bodies: what is made as one piece. Parts are those that are stacks of layers.

A *body* has a name, a chord tolerance, a solid and moments of its volume; it need not be a prism
(see `solids.solid`). A *layer* is a prism: the plane inside one edge, less openings, between two
heights. Any edge may be toothed: an outline, an opening, or both.

A *part* is a body of layers, in its wheel's frame: its toothed plate from z = 0 to its width, hubs
beyond. A *stepped* part has several outlines, one above the other, each of the same height.
*Openings* go right through, those within the hub through it too; each step may have an *inner*
edge of its own, such as the teeth of a ring. *Pockets* are taken out of one face: a *mark* is a
shallow round one, engraved in the upper face, a *recess* is milled out of either face.

Refused: a contour that is not counter-clockwise, a width that is not positive.

Depends on numeric; shapely only inside `Part.region`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, Protocol, cast

import numpy as np

from gearcam.display import Brief, Displayed
from gearcam.facts import Fact, Facts
from gearcam.numeric.arrays import Array
from gearcam.numeric.contour import Contour
from gearcam.numeric.moments import Moments
from gearcam.parts.shapes import Circle, Loop, frozen

if TYPE_CHECKING:
    from shapely import Polygon


Kind = Literal["BORE", "HOLE", "SLOT", "INNER", "GROOVE"]
"""What an opening is for: the shaft, bolts and lightness, a stop pin, inner teeth, a roller."""

Edge = Contour | Circle | Loop
"""A closed plane curve, counter-clockwise, with moments, length, reach and points."""


class Body(Protocol):
    """What is made as one piece, prism or not."""

    @property
    def name(self) -> str:
        """Such as ``gear1``: the stem of its files."""
        ...

    @property
    def tolerance(self) -> float:
        """Chord tolerance of everything on it, mm."""
        ...


@dataclass(frozen=True, eq=False, kw_only=True)
class Opening(Brief):
    """Something that goes right through a part.

    Parameters
    ----------
    kind : {"BORE", "HOLE", "SLOT", "INNER", "GROOVE"}
        What it is for, and its layer in drawings.
    shape : Contour or Circle or Loop
        The edge within which nothing is left, in the part's frame.
    name : str
        What a person calls it, such as ``bolt hole 2``.
    """

    kind: Kind
    shape: Edge
    name: str

    def as_dict(self) -> dict[str, Any]:
        """Return the opening for JSON: of a circle its place and diameter."""
        made: dict[str, Any] = {"kind": self.kind.lower(), "name": self.name}
        if isinstance(self.shape, Circle):
            made |= {"center_mm": self.shape.center.tolist(), "diameter_mm": self.shape.diameter}
        return made | {"area_mm2": self.shape.moments.area}


@dataclass(frozen=True, eq=False, kw_only=True)
class Layer(Brief):
    """A prism: what lies within an `edge` less `openings`, from z = `low` to `high`, mm."""

    edge: Edge
    low: float
    high: float
    openings: tuple[Opening, ...] = ()

    @property
    def height(self) -> float:
        """From its lower to its upper face, mm."""
        return self.high - self.low

    @property
    def edges(self) -> tuple[Edge, ...]:
        """Its edge, and those of its openings."""
        return self.edge, *(opening.shape for opening in self.openings)

    @property
    def moments(self) -> Moments:
        """Moments of the plane region."""
        through = (opening.shape.moments for opening in self.openings)
        return self.edge.moments - sum(through, start=Moments())


@dataclass(frozen=True, eq=False, kw_only=True)
class Recess(Layer):
    """What is milled out of a face, such as a groove: the prism within its edge but for islands.

    Parameters
    ----------
    width : float, mm
        Diameter of the largest round tool that reaches every place.
    place : (float, float), mm
        A place where no larger one goes.
    front : bool
        Whether it is open to the upper face, or to the lower one.
    """

    width: float
    place: tuple[float, float]
    front: bool = True


@dataclass(frozen=True, kw_only=True)
class Hub:
    """A round boss about the axis: its `diameter`, how far it stands out in `front` and `back`."""

    diameter: float
    front: float = 0.0
    back: float = 0.0


@dataclass(frozen=True, eq=False, kw_only=True)
class Mark(Brief):
    """A round dimple in the upper face.

    Parameters
    ----------
    center : (2,) array, mm
        In the part's frame.
    diameter, depth : float, mm
        Of the cylinder that is taken away.
    """

    center: Array
    diameter: float
    depth: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "center", frozen(self.center))

    @property
    def circle(self) -> Circle:
        """Its edge."""
        return Circle(center=self.center, diameter=self.diameter)


@dataclass(frozen=True, eq=False, kw_only=True)
class Part(Brief, Displayed):
    """A body of layers: a plate, stepped or not, with a hub.

    Parameters
    ----------
    name : str
        Such as ``gear1``: the stem of its files.
    contours : tuple of Contour
        Outlines in the part's frame, counter-clockwise: one, or those of the steps from z = 0 up.
        Of a ring they may be circles.
    width : float, mm
        From z = 0 to z = width, shared evenly by the steps.
    openings : tuple of Opening
        Right through; none meets another or an outline.
    inner : tuple of Contour
        Toothed edges of the opening of a ring, one for each outline; none for wheels.
    hub : Hub or None
        Within the roots.
    marks : tuple of Mark
        Engraved in the face z = width.
    recesses : tuple of Recess
        Milled out of either face; those below one another do not overlap.
    turns : bool
        Whether it turns about the origin where that lies within its outline.

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
    turns: bool = True

    def __post_init__(self) -> None:
        edges = (*self.contours, *self.inner)
        if not all(edge.area > 0 for edge in edges if isinstance(edge, Contour)):
            raise ValueError(f"{self.name}: the contour must run counter-clockwise")
        if not self.width > 0:
            raise ValueError(f"{self.name}: the width must be positive, not {self.width} mm")
        if len(self.inner) not in (0, len(self.contours)):
            raise ValueError(f"{self.name}: each outline has its inner edge, or none has")

    @property
    def contour(self) -> Contour:
        """The outline, of a ring its inner edge; of a stepped part the lowest."""
        return cast("Contour", (self.inner or self.contours)[0])

    @cached_property
    def facts(self) -> Facts:
        """What the part knows of itself; the facts of its result tell more."""
        tree = {
            "width_mm": self.width,
            "thickness_mm": Fact(self.thickness, "from face to face"),
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
        """Return a picture of the (lowest) outline with its openings, SVG, in the part's frame."""
        from gearcam.markup import outlines

        step = self.steps[0]
        edges = [step.edge, *(opening.shape for opening in step.openings)]
        for pocket in self.pockets:
            edges += [pocket.edge, *(island.shape for island in pocket.openings)]
        return outlines(self.facts.headline, [edge.points(self.tolerance) for edge in edges])

    @property
    def outline(self) -> Array:
        """Vertices of that outline as made, (n, 2), mm, counter-clockwise, in the part's frame."""
        return self.contour.vertices

    @property
    def tolerance(self) -> float:
        """Chord tolerance of everything on it, mm."""
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
        """The hub at the back and in front, where there is one, with what goes through it too."""
        if self.hub is None:
            return ()
        disc = Circle(center=np.zeros(2), diameter=self.hub.diameter)
        within = tuple(o for o in self.openings if o.shape.reach < 0.5 * self.hub.diameter)
        ends = ((-self.hub.back, 0.0), (self.width, self.width + self.hub.front))
        return tuple(
            Layer(edge=disc, low=low, high=high, openings=within)
            for low, high in ends
            if high > low
        )

    @property
    def layers(self) -> tuple[Layer, ...]:
        """All that the part is made of."""
        return self.steps + self.bosses

    @cached_property
    def pockets(self) -> tuple[Layer, ...]:
        """What is taken out of layers, from one of their faces."""
        marks = (
            Layer(edge=mark.circle, low=self.width - mark.depth, high=self.width)
            for mark in self.marks
        )
        return (*marks, *self.recesses)

    def cutters(self, overshoot: float) -> tuple[Layer, ...]:
        """Return the recesses as they are cut: beyond their face by `overshoot`, in heights."""
        return tuple(
            replace(one, high=self.width + overshoot * one.height)
            if one.front
            else replace(one, low=-overshoot * one.height)
            for one in self.recesses
        )

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
        holes = [opening.shape.points(self.tolerance) for opening in step.openings]
        return Polygon(step.edge.points(self.tolerance), holes)

    @property
    def thickness(self) -> float:
        """Height from the lowest to the highest face, mm."""
        return max(layer.high for layer in self.layers) - min(layer.low for layer in self.layers)
