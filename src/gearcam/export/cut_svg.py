"""SVG for laser cutters: 1:1, its size in the unit of files, its view box in millimetres.

Laser programs go by colour and order: cuts are red hairlines, engraving is blue; first comes what
is engraved, then inner edges, then outlines, so that no part comes loose before it is finished.
Everything is a path of arcs and straight pieces: outlines within the chord tolerance, openings and
marks exact.

Some drivers cut only lines up to 0.02 mm wide, and a browser hardly shows these. The width in mm
therefore stays in the file, and a style that only browsers apply, and only on a screen, draws lines
1 pixel wide: `@supports` around `@media`, as parsers of CSS 2 may apply the rules in `@media` to
any output, but skip a rule that they do not know. Tried with Chromium (1 pixel on a screen, the
hairline in print), resvg, CairoSVG and svglib (the hairline).

Refused: drawings without an outline.

Depends on drawings and numeric.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Final
from xml.sax.saxutils import quoteattr

import numpy as np

from gearcam.base.inches import file_unit
from gearcam.base.numerals import decimal, formatted
from gearcam.export.dxf import CURVE_PART
from gearcam.export.svg import arc_data
from gearcam.numeric.arcs import fit_closed
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import Contour
from gearcam.parts.shapes import Circle, Loop
from gearcam.pictures.drawings import ENGRAVED, OUTER, THROUGH, Drawing, Feature, Path, box
from gearcam.pictures.markup import svg_document

RED: Final = "#ff0000"
BLUE: Final = "#0000ff"
"""Colours of cuts and of engraving."""

HAIRLINE: Final = 0.01
"""Width of every line, mm."""

_ON_SCREEN: Final = (
    "<style>@supports (vector-effect: non-scaling-stroke) { @media screen { "
    "path { stroke-width: 1px; vector-effect: non-scaling-stroke } } }</style>"
)

MARGIN: Final = 1.0
"""Margin of the sheet, mm."""

GROUPS: Final = (
    ("engrave", ENGRAVED, BLUE),
    ("cut-inner", THROUGH, RED),
    ("cut-outer", OUTER, RED),
)
"""Groups in drawing order: name, kinds, colour."""

_FINER: Final = 1e-3
"""Rounding of numbers over the tolerance."""


def cut_svg(drawings: Sequence[Drawing], title: str, kerf: float = 0.0) -> bytes:
    """Write drawings of parts for a laser cutter.

    Parameters
    ----------
    drawings : sequence of Drawing
        Each of one part, at its place on the sheet.
    title : str
        Of the file.
    kerf : float, mm
        The paths were moved by half of it before; it is only stated in the file.

    Returns
    -------
    bytes
        The file, UTF-8; the same for the same drawings.

    Raises
    ------
    ValueError
        If there is nothing to cut.
    """
    features = [feature for drawing in drawings for feature in drawing.features]
    kept = [one for one in features if any(one.kind in kinds for _, kinds, _ in GROUPS)]
    if not any(one.kind in OUTER for one in kept):
        raise ValueError(f"{title}: nothing to cut")
    tolerance = min(one.tolerance for drawing in drawings for one in drawing.contours)
    decimals = max(4, math.ceil(-math.log10(_FINER * tolerance)))
    low, high = box(kept)
    low, high = low - complex(MARGIN, MARGIN), high + complex(MARGIN, MARGIN)
    sizes = (high - low).real, (high - low).imag
    wide, tall = (math.ceil(size * 1e4) / 1e4 for size in sizes)
    ends = f'width="{_size(wide, 4)}" height="{_size(tall, 4)}"'
    size = f'{ends} viewBox="0 0 {decimal(wide, 4)} {decimal(tall, 4)}"'
    remark = f"; paths are moved by half the kerf of {formatted(kerf)} mm" if kerf else ""
    # y = 0 of the paths is the upper edge of the sheet
    shift = -complex(low.real, high.imag)
    words = f"1:1 in mm; first engrave blue lines, then cut red lines{remark}"
    words = f"<desc>{file_unit().told(words)}</desc>"
    return svg_document(size, title, [words, _ON_SCREEN, *_groups(kept, shift, decimals)])


def _size(size: float, decimals: int) -> str:
    """Return a size in the unit of files, in one of inches with two more decimals."""
    unit = file_unit()
    return decimal(size / unit.size, decimals + 2 * (unit.size != 1.0)) + unit.name


def _groups(kept: Sequence[Feature], shift: complex, decimals: int) -> Iterator[str]:
    for name, kinds, colour in GROUPS:
        inside = [one for one in kept if one.kind in kinds]
        if inside:
            yield f'<g id="{name}" fill="none" stroke="{colour}" stroke-width="{HAIRLINE}">'
            for one in inside:
                data = _data(one, shift, decimals)
                yield f'<path class={quoteattr(one.layer.lower())} d="{data}"/>'
            yield "</g>"


def _data(feature: Feature, shift: complex, decimals: int) -> str:
    """Return the path data of a shifted feature."""
    match feature.shape:
        case Contour() as contour:
            points, bulges = contour.fitted(fit_closed, CURVE_PART * contour.tolerance)
            return arc_data(contour.pose.apply(points) + shift, bulges, decimals)
        case Circle(center=center, diameter=diameter):
            sides = np.array([center + 0.5 * diameter, center - 0.5 * diameter])
            return arc_data(sides + shift, np.ones(2), decimals)
        case Loop(points=points, bulges=bulges):
            return arc_data(points + shift, bulges, decimals)
        case Path(points=points):
            pairs = as_pairs(points + shift).tolist()
            return (
                f"M{'L'.join(f'{decimal(x, decimals)} {decimal(-y, decimals)}' for x, y in pairs)}"
            )
        case shape:
            raise ValueError(f"{feature.layer}: a {type(shape).__name__} cannot be cut")
