"""Parts: what is cut. Outlines with openings, a width, a hub and engraved marks.

A part lies in its wheel's frame: its toothed plate from z = 0 to its width, hubs beyond. A
*stepped* part has several outlines, one above the other, each of the same height. *Openings* go
right through, those within the hub through it too; a *mark* is a shallow round dimple, engraved
(blind) in the upper face.

Refused: a contour that is not counter-clockwise, a width that is not positive.

Depends on numeric; shapely only inside `Part.region`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from gearcam.numeric.contour import Contour
from gearcam.numeric.moments import Moments
from gearcam.parts.shapes import Circle, Loop, frozen

if TYPE_CHECKING:
    from shapely import Polygon

Array = NDArray[np.float64]

Kind = Literal["BORE", "HOLE", "SLOT"]
"""What an opening is for: the shaft, bolts and lightness, a stop pin."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Opening:
    """Something that goes right through a part.

    Parameters
    ----------
    kind : {"BORE", "HOLE", "SLOT"}
        What it is for, and its layer in drawings.
    shape : Circle or Loop
        Where nothing is left, in the part's frame.
    name : str
        What a person calls it, such as ``bolt hole 2``.
    """

    kind: Kind
    shape: Circle | Loop
    name: str

    def as_dict(self) -> dict[str, Any]:
        """Return the opening for JSON: of a circle its place and diameter."""
        made: dict[str, Any] = {"kind": self.kind.lower(), "name": self.name}
        if isinstance(self.shape, Circle):
            made |= {"center_mm": self.shape.center.tolist(), "diameter_mm": self.shape.diameter}
        return made | {"area_mm2": self.shape.moments.area}


@dataclass(frozen=True, kw_only=True)
class Hub:
    """A round boss about the axis: its `diameter`, how far it stands out in `front` and `back`."""

    diameter: float
    front: float = 0.0
    back: float = 0.0


@dataclass(frozen=True, eq=False, kw_only=True)
class Mark:
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
class Part:
    """A flat part, stepped or not.

    Parameters
    ----------
    name : str
        Such as ``gear1``: the stem of its files.
    contours : tuple of Contour
        Outlines in the part's frame, counter-clockwise: one, or those of the steps from z = 0 up.
    width : float, mm
        From z = 0 to z = width, shared evenly by the steps.
    openings : tuple of Opening
        Right through; none meets another or an outline.
    hub : Hub or None
        Within the roots.
    marks : tuple of Mark
        Engraved in the face z = width.

    Raises
    ------
    ValueError
        If a contour runs clockwise, or the width is not positive.
    """

    name: str
    contours: tuple[Contour, ...]
    width: float
    openings: tuple[Opening, ...] = ()
    hub: Hub | None = None
    marks: tuple[Mark, ...] = ()

    def __post_init__(self) -> None:
        if not all(contour.area > 0 for contour in self.contours):
            raise ValueError(f"{self.name}: the contour must run counter-clockwise")
        if not self.width > 0:
            raise ValueError(f"{self.name}: the width must be positive, not {self.width} mm")

    @property
    def contour(self) -> Contour:
        """The outline, of a stepped part the lowest."""
        return self.contours[0]

    @property
    def tolerance(self) -> float:
        """Chord tolerance of everything on it, mm."""
        return self.contour.tolerance

    @property
    def plates(self) -> Iterator[tuple[Contour, float, float]]:
        """The outline, bottom and top of each step, mm."""
        height = self.width / len(self.contours)
        for number, contour in enumerate(self.contours):
            yield contour, number * height, (number + 1) * height

    @property
    def bosses(self) -> Iterator[tuple[float, float]]:
        """Bottom and top of the hub in front and at the back, mm, where there is one."""
        if self.hub is not None and self.hub.back > 0.0:
            yield -self.hub.back, 0.0
        if self.hub is not None and self.hub.front > 0.0:
            yield self.width, self.width + self.hub.front

    @property
    def slabs(self) -> Iterator[tuple[Moments, float, float]]:
        """Plane moments, bottom and top, mm, of all that the part is made of; marks count down."""
        holes = [opening.shape.moments for opening in self.openings]
        through = sum(holes, start=Moments())
        for contour, low, high in self.plates:
            yield contour.moments - through, low, high
        if self.hub is not None:
            bores = [opening.shape.moments for opening in self.in_hub]
            disc = Circle(center=np.zeros(2), diameter=self.hub.diameter).moments
            for low, high in self.bosses:
                yield disc - sum(bores, start=Moments()), low, high
        for mark in self.marks:
            yield -1.0 * mark.circle.moments, self.width - mark.depth, self.width

    @property
    def in_hub(self) -> tuple[Opening, ...]:
        """The openings that go through the hub too: those within its circle."""
        if self.hub is None:
            return ()
        radius = 0.5 * self.hub.diameter
        return tuple(opening for opening in self.openings if opening.shape.reach < radius)

    @cached_property
    def area(self) -> float:
        """Outline (of a stepped part the lowest) less openings, mm^2."""
        return self.contour.moments.area - sum(o.shape.moments.area for o in self.openings)

    @cached_property
    def volume(self) -> float:
        """Volume of the true shape, mm^3."""
        return sum((high - low) * plane.area for plane, low, high in self.slabs)

    @cached_property
    def region(self) -> Polygon:
        """The (lowest) outline with its openings, chords within the tolerance."""
        from shapely import Polygon

        holes = [opening.shape.points(self.tolerance) for opening in self.openings]
        return Polygon(self.contour.vertices, holes)

    @property
    def thickness(self) -> float:
        """Height from the lowest to the highest face, mm."""
        hub = self.hub or Hub(diameter=math.inf)
        return hub.back + self.width + hub.front
