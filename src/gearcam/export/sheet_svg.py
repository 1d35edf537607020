"""SVG of workshop drawings: paper at full size, ready to print.

The view box is the paper in millimetres, y downwards. Points are rounded to a hundredth of a
millimetre of paper: parts are cut from the DXF of the part.

Depends on sheets and drawings.
"""

from __future__ import annotations

from typing import Final
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from gearcam.base.numerals import decimal
from gearcam.numeric.arrays import Plane, as_pairs
from gearcam.pictures.markup import svg_document
from gearcam.sheets.sheet import CAPITAL, DrawnLine, Sheet, Text

INK: Final = "#000000"


def sheet_svg(sheet: Sheet) -> bytes:
    """Return a `sheet` as SVG, UTF-8; the same sheet gives the same bytes."""
    wide, tall = (decimal(value) for value in sheet.size)
    size = f'width="{wide}mm" height="{tall}mm" viewBox="0 0 {wide} {tall}"'
    lines = [
        f'<rect width="{wide}" height="{tall}" fill="#ffffff"/>',
        f'<g fill="none" stroke="{INK}" stroke-linejoin="round">',
        *(_stroke(sheet, one) for one in sheet.drawn_lines),
        "</g>",
        f'<g fill="{INK}" stroke="none">',
        *(f'<path class="arrow" d="{_data(sheet, black)}Z"/>' for black in sheet.blacks),
        "</g>",
        f'<g font-family="Helvetica, Arial, Liberation Sans, sans-serif" fill="{INK}">',
        *(_text(sheet, text) for text in sheet.words),
        "</g>",
    ]
    return svg_document(size, sheet.title, lines)


def _stroke(sheet: Sheet, stroke: DrawnLine) -> str:
    style = f"class={quoteattr(stroke.layer.lower().replace('_', '-'))}"
    style += f' stroke-width="{stroke.width}"'
    if stroke.dashes:
        style += f' stroke-dasharray="{" ".join(map(decimal, stroke.dashes))}"'
    return f'<path {style} d="{_data(sheet, stroke.points)}{"Z" * stroke.closed}"/>'


def _data(sheet: Sheet, points: Plane) -> str:
    """Path data of a chain on paper; coincident neighbours are written once."""
    page = np.round(as_pairs(points) * [1.0, -1.0] + [0.0, sheet.size[1]], 2)
    kept = np.append(True, (np.diff(page, axis=0) != 0.0).any(axis=1))
    return "M" + " ".join(f"{decimal(x)} {decimal(y)}" for x, y in page[kept].tolist())


def _text(sheet: Sheet, text: Text) -> str:
    at = complex(sheet.on_paper(np.array([text.place]))[0])
    x, y = decimal(at.real), decimal(sheet.size[1] - at.imag)
    size = f'font-size="{decimal(text.height / CAPITAL)}" text-anchor="{text.anchor}"'
    if text.squeeze < 1.0:
        size += f' textLength="{decimal(text.width)}" lengthAdjust="spacingAndGlyphs"'
    turn = f' transform="rotate(-90 {x} {y})"' if text.upright else ""
    return f'<text x="{x}" y="{y}" {size}{turn}>{escape(text.text)}</text>'
