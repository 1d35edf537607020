"""Elements of a sheet: features, hatches, dimensions and texts, in true millimetres of the part.

A *sheet* has a *paper* and a *scale*, millimetres of paper over millimetres of the part. All
positions are complex, in the part's millimetres, with the front view in the part's own frame;
heights of texts, gaps and arrow heads are in millimetres of paper. A *dimension* has what it
measures, and what is drawn of it: every format shows these lines and this text. Lines are those of
ISO 128-20, texts have the heights of ISO 3098-1 and the widths of Helvetica.

Depends on drawings.
"""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Final, Literal

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.inches import FileUnit, file_unit
from gearcam.base.numerals import decimal
from gearcam.numeric.arrays import Plane
from gearcam.pictures import drawings
from gearcam.pictures.drawings import Feature, chains

Box = tuple[complex, complex]
"""Lower left and upper right corner."""

DIMENSION: Final = "DIMENSION"
TEXT: Final = "TEXT"
CENTERLINE: Final = "CENTERLINE"
HIDDEN: Final = "HIDDEN"
FRAME: Final = "FRAME"
RULE: Final = "RULE"
EDGE: Final = "EDGE"
CUT: Final = "CUT"
HATCH: Final = "HATCH"
"""Layers besides those of drawings: EDGE has visible edges that are not cut, CUT the ends of the
line of a section, RULE the lines of tables."""

WIDE: Final = 0.5
NARROW: Final = 0.25
"""Widths of lines, mm of paper: line group 0.5."""

HEAVY: Final = (
    drawings.OUTLINE, drawings.PROFILE, drawings.BLANK, drawings.OUTER_WALL, *drawings.THROUGH,
    drawings.MARK, EDGE, CUT, FRAME,
)  # fmt: skip
"""Layers drawn with wide lines."""

PATTERNS: Final = {"ACAD_ISO02W100": (12.0, 3.0), "ACAD_ISO04W100": (24.0, 3.0, 0.5, 3.0)}
"""Dashed and long-dashed dotted lines: dashes and gaps, in widths of the line."""

_DASHED, _CHAIN = PATTERNS
LINE_OF: Final = {
    HIDDEN: _DASHED,
    **dict.fromkeys((CENTERLINE, drawings.PITCH, drawings.PRIME, drawings.CENTRODE), _CHAIN),
}
"""Line types by layer type; all others are continuous."""

SERIES: Final = (1.8, 2.5, 3.5, 5.0, 7.0, 10.0)
"""Heights of texts, mm of paper."""

HEIGHT: Final = 2.5
"""Height of the numbers, mm of paper."""

CAPITAL: Final = 0.718
"""Height of a capital over the size of the font."""

GAP: Final = 1.0
"""Distance from a line to the text above it, mm of paper."""

_WIDTHS: Final = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, *10 * [556],
    278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556,
    833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,
    333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333,
    500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
]  # fmt: skip
"""Widths of the characters from the blank on, thousandths of the size of Helvetica."""

_OTHERS: Final = {"Ø": 778, "ø": 611, "°": 400, "±": 584}

SAGITTA: Final = 0.005
"""Chord error of arcs in formats without them, mm of paper."""


def length_text(value: float) -> str:
    """Return a length, mm, as text in the unit of the files that are written."""
    unit = file_unit()
    return decimal(value / unit.size, unit.decimals)


def fine(value: float) -> str:
    """Return a small length, such as a tolerance, as `length_text`, with at least two digits."""
    unit = file_unit()
    size = value / unit.size
    digits = 1 - math.floor(math.log10(abs(size))) if size else 0
    return decimal(size, max(unit.decimals, digits))


def column(unit: str) -> tuple[str, Callable[[float], str]]:
    """Return the unit in which a table tells numbers of a `unit`, and how these become text."""
    return (file_unit().name, length_text) if unit == "mm" else (unit, decimal)


def text_width(text: str, height: float = HEIGHT) -> float:
    """Return the width of a `text` of a `height`, both mm of paper."""
    plain = (unicodedata.normalize("NFD", char)[0] for char in text)
    wide = (
        _WIDTHS[ord(char) - 32] if " " <= char <= "~" else _OTHERS.get(char, 1000) for char in plain
    )
    return 1e-3 * sum(wide) * height / CAPITAL


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
    squeeze : float
        Width of its letters over their usual width.
    """

    text: str
    place: complex
    height: float = HEIGHT
    anchor: Literal["start", "middle"] = "start"
    upright: bool = False
    squeeze: float = 1.0

    @property
    def width(self) -> float:
        """Its width, mm of paper."""
        return self.squeeze * text_width(self.text, self.height)

    def box(self, unit: float) -> Box:
        """Return its bounding box with descenders.

        Parameters
        ----------
        unit : float
            Millimetres of the part in a millimetre of paper.

        Returns
        -------
        complex, complex, mm of the part
            Lower left and upper right corner.
        """
        wide, tall = self.width, self.height
        start = -0.5 * wide if self.anchor == "middle" else 0.0
        low, high = complex(start, -0.3 * tall), complex(start + wide, tall)
        if self.upright:
            low, high = complex(-tall, start), complex(0.3 * tall, start + wide)
        return self.place + unit * low, self.place + unit * high


@dataclass(frozen=True, eq=False, kw_only=True)
class SheetDimension(ShortRepr):
    """A dimension, or a text with a leader.

    Parameters
    ----------
    kind : {"linear", "vertical", "diameter", "radius", "label"}
        What is measured: along x or y, of a circle, or nothing.
    value : float, mm
        What it measures.
    points : tuple of complex, mm
        A point of the dimension line and both measured points; both ends of a diameter; or centre
        and end of a radius.
    lines : tuple of (n,) complex array, mm
        What is drawn of it.
    heads : tuple of (3,) complex array, mm
        Its arrow heads, point first.
    text : Text
        Its text.
    """

    kind: str
    value: float
    points: tuple[complex, ...]
    lines: tuple[Plane, ...]
    heads: tuple[Plane, ...]
    text: Text

    @property
    def label(self) -> str:
        """Its text."""
        return self.text.text


@dataclass(frozen=True, eq=False, kw_only=True)
class Hatch(ShortRepr):
    """Cut metal: the plane within an odd number of closed `loops`, complex, mm."""

    loops: tuple[Plane, ...]

    def lines(self, gap: float) -> Iterator[Plane]:
        """Yield its lines, which rise at 45 deg and are a `gap` apart, both in mm."""
        turn = np.exp(-0.25j * np.pi)
        starts = np.concatenate(self.loops) * turn
        ends = np.concatenate([np.roll(loop, -1) for loop in self.loops]) * turn
        low, high = starts.imag.min(), starts.imag.max()
        for level in gap * np.arange(math.ceil(low / gap), math.floor(high / gap) + 1):
            over = (starts.imag > level) != (ends.imag > level)
            first, last = starts[over], ends[over]
            share = (level - first.imag) / (last.imag - first.imag)
            places = np.sort(first.real + share * (last.real - first.real)) + 1j * level
            yield from places.reshape(-1, 2) / turn


@dataclass(frozen=True, eq=False, kw_only=True)
class DrawnLine(ShortRepr):
    """A chain of `points`, complex, mm of paper, on a `layer`; `closed` if it is."""

    layer: str
    points: Plane
    closed: bool = False

    @property
    def kind(self) -> str:
        """Type of the layer, without wheel."""
        return self.layer.rpartition("_")[2]

    @property
    def width(self) -> float:
        """Width of its line, mm."""
        return line_width(self.kind)

    @property
    def dashes(self) -> list[float]:
        """Dashes and gaps, mm; none if it is continuous."""
        return [self.width * part for part in PATTERNS.get(LINE_OF.get(self.kind, ""), ())]


def line_width(kind: str) -> float:
    """Return the width of the lines of a `kind` of layer, mm of paper."""
    return WIDE if kind in HEAVY else NARROW


@dataclass(frozen=True, eq=False, kw_only=True)
class Sheet(ShortRepr):
    """A workshop drawing.

    Parameters
    ----------
    name : str
        Stem of its file, such as ``gear1``.
    title : str
        Title in the title block.
    paper : str
        Such as ``A3``, landscape.
    size : (float, float), mm of paper
        Width and height of the paper.
    scale : float
        Millimetres of paper over millimetres of the part.
    corner : complex, mm of the part
        Lower left corner of the paper.
    features : list of Feature
        All lines except those of dimensions and hatches.
    hatches : list of Hatch
        Cut metal.
    fills : list of (n,) complex array, mm
        Black areas, such as those of symbols.
    dimensions : list of SheetDimension
        Dimensions and texts with leaders.
    texts : list of Text
        All other texts.
    rows : list of (str, str)
        The table of data: label and value.
    units : FileUnit
        That of its texts, and of DXF: lengths are in it there, and mm here.
    """

    name: str
    title: str
    paper: str
    size: tuple[float, float]
    scale: float
    corner: complex
    features: list[Feature] = field(default_factory=list)
    hatches: list[Hatch] = field(default_factory=list)
    fills: list[Plane] = field(default_factory=list)
    dimensions: list[SheetDimension] = field(default_factory=list)
    texts: list[Text] = field(default_factory=list)
    rows: list[tuple[str, str]] = field(default_factory=list)
    units: FileUnit = field(default_factory=file_unit)

    @property
    def unit(self) -> float:
        """Millimetres of the part in a millimetre of paper."""
        return 1.0 / self.scale

    def on_paper(self, points: Plane) -> Plane:
        """Return points, complex, mm of the part, as mm of paper from its lower left corner."""
        return (points - self.corner) * self.scale

    @property
    def drawn_lines(self) -> Iterator[DrawnLine]:
        """All its lines, on paper."""
        unit = self.unit
        every = [(f.layer, *one) for f in self.features for one in chains(f.shape, SAGITTA * unit)]
        cut = (line for hatch in self.hatches for line in hatch.lines(HATCHED * unit))
        every += [(HATCH, line, False) for line in cut]
        every += [(DIMENSION, line, False) for one in self.dimensions for line in one.lines]
        for layer, points, closed in every:
            yield DrawnLine(layer=layer, points=self.on_paper(points), closed=closed)

    @property
    def blacks(self) -> Iterator[Plane]:
        """Arrow heads and other black areas, on paper."""
        heads = [head for one in self.dimensions for head in one.heads]
        return map(self.on_paper, heads + self.fills)

    @property
    def words(self) -> tuple[Text, ...]:
        """All its texts, those of dimensions first."""
        return (*(one.text for one in self.dimensions), *self.texts)


HATCHED: Final = 2.0
"""Distance of the lines of a hatch, mm of paper."""
