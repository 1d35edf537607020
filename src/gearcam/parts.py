"""Parts: what is cut. A contour with a bore, a width, and engraved marks.

A *blank* is what a design says beyond the teeth. A *mark* is a shallow round dimple, engraved
(blind) in the +z face: a pair of *timing marks* faces each other on the line of centres at phi1 =
0, so that the wheels go together in one phase only.

Refused: a contour that is not counter-clockwise, a width that is not positive, a mark for which
the rim between bore and root leaves no room.

Depends on numeric; shapely only inside `Part.region`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from gearcam.errors import InfeasibleError
from gearcam.numeric.contour import Contour
from gearcam.quantities import LENGTH, param

if TYPE_CHECKING:
    from shapely import Polygon

Array = NDArray[np.float64]

MARK_DIAMETER: Final = 0.4
"""Diameter of a timing mark, modules: seen by eye, smaller than any rim that carries teeth."""

MARK_GAP: Final = 0.2
"""Least distance of a timing mark from the root line, modules."""

MARK_DEPTH: Final = 0.5
"""Depth of a mark, mm, in wheels that are wide enough: a laser's or a drill point's touch."""

MARK_DEPTH_PART: Final = 0.1
"""Largest part of the width that a mark may take."""

RIM_PART: Final = 1 / 3
"""Largest part of the rim between bore and root that a mark may take, and its gap with it."""


@dataclass(frozen=True, kw_only=True)
class Blank:
    """What a design says of the wheels beyond their teeth."""

    bore_diameter: tuple[float, float] | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=1e6,
        doc="bores of both wheels, driver first; none if left out",
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class Mark:
    """A round dimple in the +z face.

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
        object.__setattr__(self, "center", _frozen(self.center))

    @property
    def volume(self) -> float:
        """What the mark takes away, mm^3."""
        return 0.25 * math.pi * self.diameter**2 * self.depth


@dataclass(frozen=True, eq=False, kw_only=True)
class Part:
    """A flat part: an outline, a bore, a width and marks.

    Parameters
    ----------
    name : str
        Such as ``gear1``: the stem of its files.
    contour : Contour
        The outline in the part's frame, counter-clockwise.
    bore_diameter : float or None, mm
        Bore about the frame's origin.
    width : float, mm
        From z = 0 to z = width.
    marks : tuple of Mark
        Engraved in the face z = width.

    Raises
    ------
    ValueError
        If the contour runs clockwise, or the width or bore is not positive.
    """

    name: str
    contour: Contour
    bore_diameter: float | None
    width: float
    marks: tuple[Mark, ...] = ()

    def __post_init__(self) -> None:
        if not self.contour.area > 0:
            raise ValueError(f"{self.name}: the contour must run counter-clockwise")
        if not self.width > 0:
            raise ValueError(f"{self.name}: the width must be positive, not {self.width} mm")
        if self.bore_diameter is not None and not self.bore_diameter > 0:
            raise ValueError(f"{self.name}: the bore must be positive, not {self.bore_diameter} mm")

    @cached_property
    def area(self) -> float:
        """Outline less bore, mm^2."""
        return self.contour.area - 0.25 * math.pi * (self.bore_diameter or 0.0) ** 2

    @cached_property
    def volume(self) -> float:
        """Area times width less the marks, mm^3."""
        return self.area * self.width - sum(mark.volume for mark in self.marks)

    @cached_property
    def region(self) -> Polygon:
        """The outline with its bore as a shapely region; the bore's chords within the tolerance."""
        from shapely import Polygon

        if self.bore_diameter is None:
            return Polygon(self.contour.vertices)
        hole = circle_points((0.0, 0.0), self.bore_diameter, self.contour.tolerance)
        return Polygon(self.contour.vertices, [hole])


def _frozen(values: object) -> Array:
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


def circle_segments(diameter: float, sagitta: float) -> int:
    """Return how many chords a circle needs.

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
    return max(12, 2 * math.ceil(math.pi / (4 * math.asin(math.sqrt(ratio)))))


def circle_points(center: tuple[float, float] | Array, diameter: float, sagitta: float) -> Array:
    """Return points on a circle, counter-clockwise, first not repeated.

    Parameters
    ----------
    center : (2,) array, mm
        Centre.
    diameter : float, mm
        Diameter.
    sagitta : float, mm
        Largest distance of a chord from the circle.

    Returns
    -------
    (n, 2) array, mm
    """
    count = circle_segments(diameter, sagitta)
    angle = 2 * math.pi * np.arange(count) / count
    spokes = np.column_stack([np.cos(angle), np.sin(angle)])
    return np.asarray(center, dtype=np.float64) + 0.5 * diameter * spokes


def timing_mark(
    pitch_radius: float,
    direction: float,
    module: float,
    dedendum_mm: float,
    width: float,
    *,
    bore_diameter: float | None = None,
    tilt: float = 0.0,
) -> Mark:
    """Place a wheel's timing mark just inside the root, on a given direction.

    Wheel 1 takes the direction 0 and wheel 2 the direction pi: at phi1 = 0 both lie on the line of
    centres and face each other across the pitch point.

    Parameters
    ----------
    pitch_radius : float, mm
        Radius of the centrode in that direction.
    direction : float, rad
        Polar angle in the wheel's frame.
    module : float, mm
        Sets the mark's size: 0.4 modules.
    dedendum_mm : float, mm
        Distance of the root from the centrode, along the centrode's normal.
    width : float, mm
        Width of the wheel; the depth is the lesser of 0.5 mm and a tenth of it.
    bore_diameter : float or None, mm
        The mark stays clear of the bore; it shrinks where the rim is thin.
    tilt : float, rad
        Angle between the radius and the centrode's normal, 0 where the centrode crosses the line of
        centres squarely.

    Returns
    -------
    Mark

    Raises
    ------
    InfeasibleError
        If bore and root leave no rim.
    """
    lean = math.cos(tilt)
    inner = 0.5 * (bore_diameter or 0.0)
    rim = (pitch_radius - inner) * lean - dedendum_mm
    if rim <= 0:
        root = pitch_radius - dedendum_mm / lean
        raise InfeasibleError(
            "no room for a timing mark between bore and root",
            where=f"direction {math.degrees(direction):.6g} deg",
            value=2 * inner,
            limit=2 * root,
            unit="mm",
            nearest=f"a bore below {2 * root:.6g} mm leaves a rim there",
        )
    diameter = min(MARK_DIAMETER * module, RIM_PART * rim)
    gap = min(MARK_GAP * module, RIM_PART * rim)
    radius = pitch_radius - (dedendum_mm + gap + 0.5 * diameter) / lean
    center = radius * np.array([math.cos(direction), math.sin(direction)])
    depth = min(MARK_DEPTH, MARK_DEPTH_PART * width)
    return Mark(center=center, diameter=diameter, depth=depth)
