"""SVG of workshop drawings: paper at full size, ready to print.

The view box is the paper in millimetres, y downwards. Outlines and edges are thick, all other lines
thin; hidden lines and centrodes are dashed, centre lines dash-dotted. Points are rounded to a
hundredth of a millimetre of paper: parts are cut from the DXF of the wheel.

Depends on sheets and drawings.
"""

from __future__ import annotations

from typing import Final
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from gearcam.base.numerals import decimal
from gearcam.numeric.arrays import Array, Plane, as_pairs
from gearcam.pictures.drawings import CENTRODE, Circle, Feature, chains
from gearcam.pictures.markup import svg_document
from gearcam.sheets.sheet import CENTERLINE, HEAVY, HIDDEN, THICK, THIN, Sheet, Text

DASHES: Final = {HIDDEN: "3 1.5", CENTRODE: "4 1.5", CENTERLINE: "8 1.5 1 1.5"}
"""Dashes and gaps, mm."""

INK: Final = "#000000"

CAPITAL: Final = 0.72
"""Height of a capital over the font's size."""

SAGITTA: Final = 0.005
"""Chord error of arcs, mm of paper."""


def sheet_svg(sheet: Sheet) -> bytes:
    """Return a `sheet` as SVG, UTF-8; the same sheet gives the same bytes."""
    wide, tall = (decimal(value) for value in sheet.size)
    size = f'width="{wide}mm" height="{tall}mm" viewBox="0 0 {wide} {tall}"'
    drawn = sheet.drawn
    font = f'font-family="sans-serif" fill="{INK}"'
    lines = [
        f'<rect width="{wide}" height="{tall}" fill="#ffffff"/>',
        f'<g fill="none" stroke="{INK}" stroke-linejoin="round">',
        *(_feature(sheet, feature) for feature in sheet.features),
        "</g>",
        f'<g fill="none" stroke="{INK}" stroke-width="{THIN}">',
        *(f'<path class="dimension" d="{_data(sheet, *one.lines)}"/>' for one in drawn),
        "</g>",
        f'<g fill="{INK}" stroke="none">',
        *(
            f'<path class="arrow" d="{_data(sheet, head)}Z"/>'
            for one in drawn
            for head in one.heads
        ),
        "</g>",
        f"<g {font}>",
        *(_text(sheet, one.text, "dimension") for one in drawn),
        *(_text(sheet, text, "text") for text in sheet.texts),
        "</g>",
    ]
    return svg_document(size, sheet.title, lines)


def _on_page(sheet: Sheet, points: Plane) -> Array:
    """Return points in millimetres of paper, (n, 2), y downwards."""
    return as_pairs(sheet.on_paper(points)) * [1.0, -1.0] + [0.0, sheet.size[1]]


def _feature(sheet: Sheet, feature: Feature) -> str:
    kind = feature.kind
    width = THICK if kind in HEAVY else THIN
    style = f"class={quoteattr(feature.layer.lower().replace('_', '-'))}"
    style += f' stroke-width="{width}"'
    if kind in DASHES:
        style += f' stroke-dasharray="{DASHES[kind]}"'
    if isinstance(circle := feature.shape, Circle):
        ((x, y),) = _on_page(sheet, np.array([circle.center]))
        radius = decimal(0.5 * circle.diameter * sheet.scale)
        return f'<circle {style} cx="{decimal(x)}" cy="{decimal(y)}" r="{radius}"/>'
    drawn = chains(feature.shape, SAGITTA / sheet.scale)
    data = "".join(_data(sheet, points) + "Z" * closed for points, closed in drawn)
    return f'<path {style} d="{data}"/>'


def _data(sheet: Sheet, *chains_of_points: Plane) -> str:
    """Path data of open chains; coincident neighbours are written once."""
    data = ""
    for points in chains_of_points:
        page = np.round(_on_page(sheet, points), 2)
        kept = np.append(True, (np.diff(page, axis=0) != 0.0).any(axis=1))
        data += "M" + " ".join(f"{decimal(x)} {decimal(y)}" for x, y in page[kept].tolist())
    return data


def _text(sheet: Sheet, text: Text, name: str) -> str:
    ((x, y),) = _on_page(sheet, np.array([text.place]))
    place = f'x="{decimal(x)}" y="{decimal(y)}"'
    size = f'font-size="{decimal(text.height / CAPITAL)}" text-anchor="{text.anchor}"'
    turn = f' transform="rotate(-90 {decimal(x)} {decimal(y)})"' if text.upright else ""
    return f'<text class="{name}" {place} {size}{turn}>{escape(text.text)}</text>'
