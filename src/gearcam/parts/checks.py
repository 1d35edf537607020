"""The checks of parts: thin walls, wide kerfs and tools that are too large.

Importing this module registers them. A check takes a `CheckedParts` and yields findings.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.findings import ROUNDING, Remark, check
from gearcam.base.numerals import decimal, formatted
from gearcam.base.quantities import LENGTH, Param
from gearcam.base.readable import readable
from gearcam.numeric.arrays import Plane, as_pairs
from gearcam.numeric.polygons import nearest
from gearcam.parts.blank import KIND
from gearcam.parts.body import Edge, Part
from gearcam.parts.shapes import Circle
from gearcam.parts.tools import UNLIMITED, ToolLimits, tool_limits

if TYPE_CHECKING:
    from shapely import LinearRing

_FINE = 0.01
"""Sagitta, in tolerances, of the chords of round outsides from which walls are measured."""

_ON_HUB = 1024
"""Number of chords of a hub's edge."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CheckedParts(ShortRepr):
    """The parts of a pair, or a cam, for checks.

    Parameters
    ----------
    parts : tuple of Part
        As made.
    names : tuple of str
        Names for messages.
    kerf : float, mm
        Width of the cut; 0 if the design gives none.
    uncut : tuple of bool
        Whether a cutter of this kerf leaves metal on flanks, for each part.
    sought : bool
        Whether the largest tools are looked for; a draft does without.
    edge : str
        What the outer edge is called.
    step : bool
        Whether STEP files are written.
    """

    parts: tuple[Part, ...]
    names: tuple[str, ...] = ("wheel 1", "wheel 2")
    kerf: float = 0.0
    uncut: tuple[bool, ...] = (False, False)
    sought: bool = True
    edge: str = "outline"
    step: bool = False

    @cached_property
    def tools(self) -> tuple[ToolLimits, ...]:
        """The largest tools for outlines (of stepped wheels the lowest step) and recesses."""
        if not self.sought:
            return (UNLIMITED,) * len(self.parts)
        return tuple(_tools(part) for part in self.parts)


def _tools(part: Part) -> ToolLimits:
    found = [tool_limits(part.contour, hollow=bool(part.inner))]
    for one in part.recesses:
        width, place = one.width, one.place
        found.append(ToolLimits(inner_radius=inf, inner_place=None, slot=width, slot_place=place))
    return min(found, key=lambda limits: limits.diameter)


@check(
    "thin-wall",
    kind=KIND,
    limit=("wall", Param(LENGTH, ge=0, doc="least wall"), 1.0),
    relation="at least",
)
def thin_wall(subject: CheckedParts, limit: float) -> Iterator[Remark]:
    """Warn of thin walls.

    Looks at: walls between openings, between openings and the outline or the edge of the hub,
    between a groove and the outline, and below the floor of a groove.
    """
    for name, part in zip(subject.names, subject.parts, strict=True):
        walls = list(_walls(part, subject.edge))
        if not walls:
            continue
        width, what = min(walls)
        if width < limit * (1.0 - ROUNDING):
            yield Remark(
                f"The wall between the {what} is {readable(width, 'mm')} thick.", name, width
            )


class _Chorded:
    """The chords of an edge, from which walls are measured.

    Parameters
    ----------
    points : (n,) complex array, mm
    """

    def __init__(self, points: Plane) -> None:
        self.points = points

    @cached_property
    def ring(self) -> LinearRing:
        """The chords, prepared for distances."""
        from shapely import LinearRing, prepare

        made = LinearRing(as_pairs(self.points))
        prepare(made)
        return made

    def to(self, other: _Chorded | Circle) -> float:
        """Return the distance of another edge, or of a circle inside or outside this one, mm."""
        if isinstance(other, Circle):
            return nearest(self.points, other.center) - 0.5 * other.diameter
        from shapely import length, shortest_line  # by a spatial index

        return float(length(shortest_line(other.ring, self.ring)))


def _walls(part: Part, outline: str) -> Iterator[tuple[float, str]]:
    """Yield thickness and place of every wall; the outer edge is called `outline`."""

    def edge_of(edge: Edge) -> _Chorded:
        return _Chorded(edge.polyline(part.tolerance))

    shapes = [
        one.shape if isinstance(one.shape, Circle) else edge_of(one.shape) for one in part.openings
    ]
    edges = [
        (_Chorded(edge.polyline(_FINE * part.tolerance)), what)
        for what, ones in ((outline, part.contours), ("roots", part.inner))
        for edge in ones
    ]
    if part.hub is not None:
        turned: Plane = np.exp(2j * np.pi * np.arange(_ON_HUB) / _ON_HUB)
        edges.append((_Chorded(0.5 * part.hub.diameter * turned), "hub's edge"))
    for number, (opening, shape) in enumerate(zip(part.openings, shapes, strict=True)):
        for other, named in zip(shapes[:number], part.openings[:number], strict=True):
            yield max(_between(shape, other), 0.0), f"{opening.name} and the {named.name}"
        for edge, what in edges:
            yield max(edge.to(shape), 0.0), f"{opening.name} and the {what}"
    for recess in part.recesses:
        rim = edge_of(recess.edge)
        yield rim.to(edges[0][0]), f"groove and the {outline}"
        floor = recess.low if recess.front else part.width - recess.high
        yield floor, "groove's floor and the other face"
        islands = [edge_of(one.shape) for one in recess.openings] or [rim]
        for opening, shape in zip(part.openings, shapes, strict=True):
            for island in islands:
                yield max(island.to(shape), 0.0), f"{opening.name} and the groove"


def _between(one: _Chorded | Circle, other: _Chorded | Circle) -> float:
    """Return the distance of two openings, mm."""
    if isinstance(one, _Chorded):
        return one.to(other)
    if isinstance(other, _Chorded):
        return other.to(one)
    return abs(one.center - other.center) - 0.5 * (one.diameter + other.diameter)


@check("wide-kerf", kind=KIND, relation="at most", severity=("warning", "error"), unit="mm")
def wide_kerf(subject: CheckedParts, _: float) -> Iterator[Remark]:
    """Warn of a kerf that is too wide for an inner corner or a slot, so that metal is left.

    An error if metal is left on flanks of teeth.

    Looks at: the largest tool that reaches all of an outline, compared with `output.kerf_mm`.
    """
    rows = zip(subject.names, subject.tools, subject.uncut, strict=True)
    for name, tools, uncut in rows:
        if tools.diameter >= subject.kerf:
            continue
        left = "leaves metal there, also on flanks" if uncut else "leaves metal there"
        yield Remark(
            f"A kerf of {formatted(subject.kerf, 4)} mm is too wide for {_tightest(tools)}, which "
            f"has room for {readable(tools.diameter, 'mm')}: the cutter {left}.",
            name,
            subject.kerf,
            severity="error" if uncut else "warning",
            limit=tools.diameter,
        )


@check(
    "tool-too-large",
    kind=KIND,
    limit=("tool_diameter", Param(LENGTH, ge=0, doc="diameter of the tool at hand"), 0.3),
    relation="at least",
    severity="note",
)
def tool_too_large(subject: CheckedParts, limit: float) -> Iterator[Remark]:
    """Note a tool or wire that is too large to reach all of an outline.

    The default limit is a wire of 0.25 mm with its spark gap.

    Looks at: the diameter of the largest round tool that reaches all of an outline.
    """
    for name, tools in zip(subject.names, subject.tools, strict=True):
        if tools.diameter >= limit:
            continue
        yield Remark(
            f"{_largest(tools.diameter)}, because of {_tightest(tools)}.",
            name,
            tools.diameter,
        )


def _largest(diameter: float) -> str:
    """Return how large a round tool may be, mm."""
    if not diameter:
        return "No round tool reaches all of the outline"
    return (
        f"A round tool of up to {readable(diameter, 'mm')} in diameter reaches all of the outline"
    )


def _tightest(tools: ToolLimits) -> str:
    """Return what limits a tool, and where."""
    narrow = tools.slot < 2.0 * tools.inner_radius
    place = tools.slot_place if narrow else tools.inner_place
    what = "a slot" if narrow else "an inner corner or radius"
    if place is None:
        return what
    return f"{what} at x = {decimal(place.real, 4)}, y = {decimal(place.imag, 4)} mm"


@check("sharp-in-step", kind=KIND, severity="note")
def sharp_in_step(subject: CheckedParts, _: float) -> Iterator[Remark]:
    """Note edges whose chamfer is not in the STEP file.

    Looks at: chamfers of toothed edges, at whose corners the kernel fails; meshes and drawings have
    them.
    """
    for name, part in zip(subject.names, subject.parts, strict=True):
        if subject.step and len(part.smooth_bevels) < len(part.bevels):
            yield Remark(
                "The STEP file has the toothed edges sharp: their chamfer is in meshes, and is "
                "stated on the drawing.",
                name,
            )
