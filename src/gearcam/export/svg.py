"""SVG: the assembled pair, or a cam with its follower, as a picture for a page.

Millimetres in the view box, y upwards turned into y downwards, strokes scaled to the picture, white
ground, and a caption below the wheels. The picture is thinned to 0.005 mm: it is for looking at,
parts are cut from the DXF.

Depends on drawings; shapely only inside the functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import partial
from typing import Final
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from gearcam import drawings
from gearcam.drawings import Circle, Cross, Drawing, Feature, Loop, Path, box, chains
from gearcam.numerals import decimal
from gearcam.numeric.arrays import Array
from gearcam.numeric.bulges import bulge_pieces, divided

THINNING: Final = 0.005
"""Largest distance, mm, by which thinning may move a line of the picture."""

PIXELS: Final = 960
"""Width of the picture where the page does not say otherwise."""

MARGIN: Final = 0.04
"""Margin, part of the drawing's width."""

FILLS: Final = ("#cfe0f2", "#f8e0c6")
INKS: Final = ("#27598c", "#a35f22")
"""Soft fill and dark stroke of wheel 1 and wheel 2."""

CENTRODE_INK: Final = "#5a5a5a"
TEXT_INK: Final = "#222222"
GROUND: Final = "#ffffff"

DECIMALS: Final = 4
"""Of the picture's numbers."""

_number: Final = partial(decimal, decimals=DECIMALS)

_ROUNDING: Final = 1e-12
"""Of an angle, rad, that is a quarter of a circle."""

GLYPH: Final = 0.6
"""Width of a letter, part of the font's size, on the safe side."""


def svg_bytes(drawing: Drawing, *, title: str, notes: Sequence[str] = ()) -> bytes:
    """Draw a drawing as SVG.

    Parameters
    ----------
    drawing : Drawing
        Usually the assembled pair.
    title : str
        First line of the caption.
    notes : sequence of str
        Second line of the caption, joined by commas.

    Returns
    -------
    bytes
        The file, UTF-8.

    Raises
    ------
    ValueError
        If the drawing has no outline.
    """
    if not drawing.contours:
        raise ValueError(f"{drawing.name}: nothing to draw")
    low, high = box(drawing.features)
    width = float(high[0] - low[0])
    margin, pixel = MARGIN * width, width / PIXELS
    lines = [line for line in (title, ", ".join(notes)) if line]
    size = min(20 * pixel, width / (GLYPH * max([1, *map(len, lines)])))
    caption = size * 1.4 * len(lines)
    left, top = float(low[0]) - margin, -float(high[1]) - margin
    whole = width + 2 * margin
    tall = float(high[1] - low[1]) + 2 * margin + caption + 0.5 * margin
    view = " ".join(_number(value) for value in (left, top, whole, tall))
    base = -float(low[1]) + margin + size
    ground = f'x="{_number(left)}" y="{_number(top)}"'
    ground += f' width="{_number(whole)}" height="{_number(tall)}" fill="{GROUND}"'
    sheet = f'viewBox="{view}" width="{PIXELS}" height="{round(PIXELS * tall / whole)}"'
    elements = [
        f"<rect {ground}/>",
        f'<g stroke-linejoin="round" stroke-width="{_number(1.2 * pixel)}">',
        *(_element(feature, pixel) for feature in drawing.features),
        "</g>",
        *_caption(lines, float(low[0]), base, size),
    ]
    return svg_document(f'{sheet} role="img"', title, elements)


def svg_document(attributes: str, title: str, elements: Iterable[str]) -> bytes:
    """Return an SVG file, UTF-8: `attributes` of its root, a `title`, and `elements` as lines."""
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>',
        f"<title>{escape(title)}</title>",
        *elements,
        "</svg>",
    ]
    return ("\n".join(lines) + "\n").encode()


def _caption(lines: Sequence[str], left: float, base: float, size: float) -> list[str]:
    made = []
    for row, line in enumerate(lines):
        place = f'x="{_number(left)}" y="{_number(base + 1.4 * size * row)}"'
        font = f'font-family="sans-serif" font-size="{_number(size)}" fill="{TEXT_INK}"'
        weight = ' font-weight="bold"' if row == 0 else ""
        made.append(f"<text {place} {font}{weight}>{escape(line)}</text>")
    return made


def _element(feature: Feature, pixel: float) -> str:
    """Return the SVG element of one feature; the class is its layer."""
    shape, name = feature.shape, quoteattr(feature.layer.lower().replace("_", "-"))
    wheel = 1 if feature.layer.startswith("GEAR2") or feature.kind == drawings.FOLLOWER else 0
    ink, fill = INKS[wheel], FILLS[wheel]
    fills = {drawings.MARK: ink, **dict.fromkeys((*drawings.OUTER, drawings.FOLLOWER), fill)}
    inside = fills.get(feature.kind, GROUND)
    line, dashed = f'stroke="{ink}"', feature.kind in drawings.DASHED
    if dashed:
        dash = f"{_number(7 * pixel)} {_number(4 * pixel)}"
        line = f'stroke="{CENTRODE_INK}" stroke-dasharray="{dash}"'
    elif isinstance(shape, Cross):
        line = f'stroke="{TEXT_INK}"'
    if dashed or isinstance(shape, Path | Cross):
        inside = "none"
    style = f'class={name} fill="{inside}" {line}'
    match shape:
        case Circle(center=center, diameter=diameter):
            place = f'cx="{_number(center[0])}" cy="{_number(-center[1])}"'
            return f'<circle {style} {place} r="{_number(0.5 * diameter)}"/>'
        case Loop():
            data = arc_data(shape.vertices, shape.bulges)
        case _:
            data = "".join(_data(points, closed) for points, closed in chains(shape, THINNING))
    return f'<path {style} d="{data}"/>'


def _data(points: Array, closed: bool) -> str:
    """Return thinned path data; y turned downwards."""
    from shapely import LineString, get_coordinates, simplify

    line = LineString(np.vstack([points, points[:1]]) if closed else points)
    kept = get_coordinates(simplify(line, THINNING, preserve_topology=False))
    kept = kept[:-1] if closed else kept
    steps = " ".join(f"{_number(x)} {_number(-y)}" for x, y in kept.tolist())
    return f"M{steps}" + ("Z" if closed else "")


def arc_data(vertices: Array, bulges: Array, decimals: int = DECIMALS) -> str:
    """Return the path data of a closed chain of straight pieces and circular arcs.

    Parameters
    ----------
    vertices : (n, 2) array, mm
        First not repeated; y upwards, and turned downwards here.
    bulges : (n,) array
        Of the pieces between them.
    decimals : int
        Of every number.

    Returns
    -------
    str
        No arc is longer than a quarter of a circle: a reader finds the centre of a half circle from
        a rounded radius with few digits.
    """
    start, chord, bends = bulge_pieces(vertices, bulges, closed=True)
    half = 2.0 * np.arctan(bends)
    parts = np.maximum(1, np.ceil(np.abs(half) / (0.25 * math.pi + _ROUNDING))).astype(np.int64)
    points, piece = divided(start, chord, bends, parts)
    with np.errstate(divide="ignore"):  # of straight pieces
        radii = (0.5 * np.abs(chord) / np.abs(np.sin(half))).tolist()

    def numbers(*values: float) -> str:
        return " ".join(decimal(value, decimals) for value in values)

    steps = []
    for k, end in zip(piece.tolist(), np.roll(points, -1).tolist(), strict=True):
        # y is turned downwards: what turns left stays so for the eye, which SVG calls 0
        arc = f"A{numbers(radii[k], radii[k])} 0 0 {int(bends[k] < 0.0)} " if bends[k] else "L"
        steps.append(arc + numbers(end.real, -end.imag))
    return f"M{numbers(start[0].real, -start[0].imag)}{''.join(steps)}Z"
