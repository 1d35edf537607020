"""Elements of a sheet: features, dimensions and texts, in true millimetres of the part.

A *sheet* has a *paper* and a *scale*, millimetres of paper over millimetres of the part. All
positions are complex, in the part's millimetres, with the front view in the part's own frame;
heights of texts, gaps and arrow heads are in millimetres of paper. A *dimension* has a measured
value; `as_drawn` converts it to lines, arrow heads and a text, for formats without dimensions.
Text heights are those of capital letters.

Depends on drawings.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.numerals import decimal
from gearcam.numeric.arrays import Plane
from gearcam.pictures.drawings import OUTER_WALL, OUTLINE, THROUGH, Feature

Box = tuple[complex, complex]
"""Lower left and upper right corner."""

DIMENSION: Final = "DIMENSION"
TEXT: Final = "TEXT"
CENTERLINE: Final = "CENTERLINE"
HIDDEN: Final = "HIDDEN"
FRAME: Final = "FRAME"
EDGE: Final = "EDGE"
"""Layers besides those of drawings; EDGE has visible edges that are not cut."""

HEAVY: Final = (OUTLINE, OUTER_WALL, *THROUGH, EDGE)
"""Layers drawn with thick lines."""

THICK: Final = 0.5
THIN: Final = 0.25
"""Widths of lines, mm of paper."""

HEIGHT: Final = 2.5
"""Height of the numbers, mm of paper."""

GLYPH: Final = 0.9
"""Largest width of a letter over the height of a capital."""

GAP: Final = 0.8
"""Distance from a line to the text above it, mm of paper."""

ARROW: Final = 3.0
"""Length of an arrow head, mm of paper."""

TAIL: Final = 5.0
"""Length of the line behind an arrow that points inwards, mm of paper."""

LEAST_GAP: Final = 1.0
PAST: Final = 1.5
"""Gap from the part to an extension line, and its overrun past the dimension line, mm of paper."""

ARROW_ROOM: Final = 2 * ARROW + GAP
"""Length of dimension lines, mm of paper, below which arrows are outside."""


def fine(value: float) -> str:
    """Return a small length, such as a tolerance, as text with two digits and no exponent."""
    digits = max(3, 1 - math.floor(math.log10(value)))
    return decimal(value, digits)


def text_width(text: str, height: float = HEIGHT) -> float:
    """Return the width of a `text` of a `height`, both mm of paper."""
    return GLYPH * height * len(text)


@dataclass(frozen=True, eq=False, kw_only=True)
class Text(ShortRepr):
    """A line of text.

    Parameters
    ----------
    text : str
        The text.
    place : complex, mm of the part
        Position of its base line.
    height : float, mm of paper
        Height of its capitals.
    anchor : {"start", "middle"}
        Point of the base line at `place`.
    upright : bool
        Whether it reads upwards.
    """

    text: str
    place: complex
    height: float = HEIGHT
    anchor: Literal["start", "middle"] = "start"
    upright: bool = False


@dataclass(frozen=True, eq=False, kw_only=True)
class LinearDimension(ShortRepr):
    """A linear dimension: the distance of two points along x or y.

    Parameters
    ----------
    first, second : complex, mm
        The points.
    line : complex, mm
        A point of the dimension line.
    place : complex, mm
        Middle of the text.
    vertical : bool
        Whether it is measured along y.
    prefix, suffix : str
        Before and after the number.
    """

    first: complex
    second: complex
    line: complex
    place: complex
    vertical: bool = False
    prefix: str = ""
    suffix: str = ""

    @property
    def value(self) -> float:
        """What it measures, mm."""
        return abs(along(self.second - self.first, self.vertical))

    @property
    def label(self) -> str:
        """Its text."""
        return f"{self.prefix}{decimal(self.value)}{self.suffix}"


@dataclass(frozen=True, eq=False, kw_only=True)
class RoundDimension(ShortRepr):
    """A diameter or a radius.

    Parameters
    ----------
    center : complex, mm
        Centre of the circle.
    radius : float, mm
        Radius of the circle.
    angle : float, rad
        Direction from the centre to the arrow.
    diameter : bool
        Whether it is a diameter.
    knee : float or None, mm
        Distance from the centre where the leader bends into the line under the text; None for a
        diameter inside its circle, with its text at the centre.
    prefix, suffix : str
        Before and after the number.
    words : str
        Text instead of the dimension; then the leader points to a place, not to a circle.
    """

    center: complex
    radius: float
    angle: float = 0.0
    diameter: bool = True
    knee: float | None = None
    prefix: str = ""
    suffix: str = ""
    words: str = ""

    @property
    def value(self) -> float:
        """What it measures, mm."""
        return 2.0 * self.radius if self.diameter else self.radius

    @property
    def label(self) -> str:
        """Its text."""
        sign = "Ø" if self.diameter else "R"
        return self.words or f"{self.prefix}{sign}{decimal(self.value)}{self.suffix}"

    def point(self, distance: float) -> complex:
        """Return the point on the leader at a distance from the centre, mm."""
        return self.center + cmath.rect(distance, self.angle)

    @property
    def edge(self) -> complex:
        """Point of the arrow."""
        return self.point(self.radius)


Dimension = LinearDimension | RoundDimension


@dataclass(frozen=True, eq=False, kw_only=True)
class DrawnDimension(ShortRepr):
    """A drawn dimension: `lines` (2,) and arrow `heads` (3,), complex, mm, and its `text`."""

    lines: tuple[Plane, ...]
    heads: tuple[Plane, ...]
    text: Text


@dataclass(frozen=True, eq=False, kw_only=True)
class Sheet(ShortRepr):
    """A workshop drawing.

    Parameters
    ----------
    name : str
        Stem of its file, such as ``gear1``.
    title : str
        First line of the title block.
    paper : str
        Such as ``A3``, landscape.
    size : (float, float), mm of paper
        Width and height of the paper.
    scale : float
        Millimetres of paper over millimetres of the part.
    corner : complex, mm of the part
        Lower left corner of the paper.
    features : tuple of Feature
        All lines except those of dimensions.
    dimensions : tuple of LinearDimension or RoundDimension
        Dimensions.
    texts : tuple of Text
        All texts except those of dimensions.
    rows : tuple of (str, str)
        The parameter table: label and value.
    """

    name: str
    title: str
    paper: str
    size: tuple[float, float]
    scale: float
    corner: complex
    features: tuple[Feature, ...]
    dimensions: tuple[Dimension, ...]
    texts: tuple[Text, ...]
    rows: tuple[tuple[str, str], ...]

    @property
    def unit(self) -> float:
        """Millimetres of the part in a millimetre of paper."""
        return 1.0 / self.scale

    @property
    def drawn(self) -> tuple[DrawnDimension, ...]:
        """The dimensions as lines, arrow heads and texts."""
        return tuple(as_drawn(dimension, self.unit) for dimension in self.dimensions)

    def on_paper(self, points: Plane) -> Plane:
        """Return points, complex, mm of the part, as mm of paper from its lower left corner."""
        return (points - self.corner) * self.scale


def along(point: complex, vertical: bool) -> float:
    """Return a coordinate of a `point`: y if `vertical`, else x."""
    return point.imag if vertical else point.real


def text_box(text: Text, unit: float) -> Box:
    """Return the bounding box of a text.

    Parameters
    ----------
    text : Text
        A line of text.
    unit : float
        Millimetres of the part in a millimetre of paper.

    Returns
    -------
    complex, complex, mm of the part
        Its lower left and upper right corner, with descenders.
    """
    wide, tall = text_width(text.text, text.height), text.height
    start = -0.5 * wide if text.anchor == "middle" else 0.0
    low, high = complex(start, -0.25 * tall), complex(start + wide, tall)
    if text.upright:
        low, high = complex(-tall, start), complex(0.25 * tall, start + wide)
    return text.place + unit * low, text.place + unit * high


def as_drawn(dimension: Dimension, unit: float) -> DrawnDimension:
    """Return a dimension as lines, arrow heads and text.

    Parameters
    ----------
    dimension : LinearDimension or RoundDimension
        The dimension.
    unit : float
        Millimetres of the part in a millimetre of paper.

    Returns
    -------
    DrawnDimension
    """
    if isinstance(dimension, LinearDimension):
        return _linear(dimension, unit)
    return _inside(dimension, unit) if dimension.knee is None else _leader(dimension, unit)


def arrow_head(tip: complex, way: complex, unit: float) -> Plane:
    """Return an arrow head.

    Parameters
    ----------
    tip : complex, mm
        Point of the arrow.
    way : complex
        Unit vector of its direction.
    unit : float
        Millimetres of the part in a millimetre of paper.

    Returns
    -------
    (3,) complex array, mm
        Tip and back corners.
    """
    back = tip - ARROW * unit * way
    side = ARROW * unit / 6.0 * 1j * way
    return np.array([tip, back + side, back - side])


def _linear(dimension: LinearDimension, unit: float) -> DrawnDimension:
    vertical = dimension.vertical
    way = 1j if vertical else 1.0
    level = dimension.line.real if vertical else 1j * dimension.line.imag
    lines = []
    for point in (dimension.first, dimension.second):
        foot = level + along(point, vertical) * way
        length = abs(foot - point)
        if length > LEAST_GAP * unit:
            away = (foot - point) / length * unit
            lines.append(np.array([point + LEAST_GAP * away, foot + PAST * away]))
    low, high = sorted(along(point, vertical) for point in (dimension.first, dimension.second))
    inwards = dimension.value < ARROW_ROOM * unit
    tail = TAIL * unit if inwards else 0.0
    start, end, middle = low - tail, high + tail, along(dimension.place, vertical)
    if middle > high:
        end = max(end, middle + 0.5 * text_width(dimension.label) * unit)
    lines.append(level + np.array([start, end]) * way)
    turn = -1.0 if inwards else 1.0
    base = dimension.place - 0.5 * HEIGHT * unit * 1j * way
    text = Text(text=dimension.label, place=base, anchor="middle", upright=vertical)
    ends = zip((low, high), (-turn * way, turn * way), strict=True)
    heads = tuple(arrow_head(level + end * way, outwards, unit) for end, outwards in ends)
    return DrawnDimension(lines=tuple(lines), heads=heads, text=text)


def _leader(dimension: RoundDimension, unit: float) -> DrawnDimension:
    distance = dimension.knee or 0.0
    knee, edge = dimension.point(distance), dimension.edge
    wide = text_width(dimension.label) * unit
    end = knee + (-wide if knee.real <= edge.real else wide)
    way = dimension.point(1.0) - dimension.center
    way = -way if distance > dimension.radius else way
    place = 0.5 * (knee + end) + 1j * GAP * unit
    return DrawnDimension(
        lines=(np.array([edge, knee]), np.array([knee, end])),
        heads=(arrow_head(edge, way, unit),),
        text=Text(text=dimension.label, place=place, anchor="middle"),
    )


def _inside(dimension: RoundDimension, unit: float) -> DrawnDimension:
    ends = [dimension.point(-dimension.radius), dimension.edge]
    way = (ends[1] - ends[0]) / (2.0 * dimension.radius)
    place = dimension.center + 1j * GAP * unit
    return DrawnDimension(
        lines=(np.array(ends),),
        heads=(arrow_head(ends[0], -way, unit), arrow_head(ends[1], way, unit)),
        text=Text(text=dimension.label, place=place, anchor="middle"),
    )
