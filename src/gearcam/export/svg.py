"""SVG pictures of the assembled pair, or of a cam with its follower.

The view box is in millimetres with y downwards, strokes are scaled to the picture, the background
is white, and a caption is below the wheels. Lines are thinned to 0.005 mm: the picture is not for
cutting.

Depends on drawings; shapely only inside the functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from gearcam.base.inches import file_unit
from gearcam.base.numerals import decimal
from gearcam.numeric.arrays import Array, Plane, as_pairs, bounds
from gearcam.numeric.bulges import bulge_pieces, divided
from gearcam.pictures import drawings
from gearcam.pictures.drawings import Circle, Cross, Drawing, Feature, Loop, Path, box, chains
from gearcam.pictures.markup import CENTRODE_INK, FILLS, GROUND, INKS, TEXT_INK, picture

if TYPE_CHECKING:
    from gearcam.pictures.labels import Label

THINNING: Final = 0.005
"""Largest distance, mm, by which thinning may move a line of the picture."""

DECIMALS: Final = 4
"""Decimals of the picture's numbers."""

_number: Final = partial(decimal, decimals=DECIMALS)

_INKS: Final = {
    **dict.fromkeys(drawings.DASHED, CENTRODE_INK),
    drawings.GROUND: TEXT_INK,
    drawings.GHOST: "#b4bcc6",
}
"""Strokes of types that have their own."""

_CLEAR: Final = (*drawings.OUTER, drawings.MEMBER)
"""Types that may be above others, which are visible through them."""

_ROUNDING: Final = 1e-12
"""Rounding of a quarter circle, rad."""


def svg_bytes(
    drawing: Drawing,
    *,
    title: str,
    notes: Sequence[str] = (),
    labels: Sequence[Label] = (),
    legend: str = "",
) -> bytes:
    """Return a drawing as SVG.

    Parameters
    ----------
    drawing : Drawing
        Usually the assembled pair.
    title : str
        First line of the caption.
    notes : sequence of str
        Second line of the caption, joined by commas.
    labels : sequence of Label
        Names in the picture.
    legend : str
        Last line of the caption: what lines mean.

    Returns
    -------
    bytes
        The file, UTF-8.

    Raises
    ------
    ValueError
        If the drawing is empty.
    """
    if not drawing.features:
        raise ValueError(f"{drawing.name}: nothing to draw")

    def elements(pixel: float) -> Iterator[str]:
        yield from (_element(feature, pixel) for feature in drawing.features)
        yield from map(_label, labels)

    lines = [title, *filter(None, map(file_unit().told, (", ".join(notes), legend)))]
    shown = [*box(drawing.features), *(corner for one in labels for corner in one.corners)]
    return picture(lines, bounds(np.array(shown)), elements).encode()


def _label(label: Label) -> str:
    """Return the text of a label, twice: below it is an edge that parts it from lines.

    Not one text painted stroke first: few programs but browsers know ``paint-order``.
    """
    x, y = label.center.real, -label.center.imag + 0.35 * label.size
    place = f'x="{_number(x)}" y="{_number(y)}" text-anchor="middle"'
    font = f'font-family="sans-serif" font-size="{_number(label.size)}"'
    edge = f'fill="none" stroke="{GROUND}" stroke-width="{_number(0.25 * label.size)}"'
    return "".join(
        f'<text class="{name}" {place} {font} {ink}>{escape(label.text)}</text>'
        for name, ink in (("halo", edge), ("name", f'fill="{TEXT_INK}"'))
    )


def _element(feature: Feature, pixel: float) -> str:
    """Return the SVG element of one feature; the class is its layer."""
    shape, name = feature.shape, quoteattr(feature.layer.lower().replace("_", "-"))
    style = f"class={name} {_style(feature, pixel)}"
    match shape:
        case Circle(center=center, diameter=diameter):
            place = f'cx="{_number(center.real)}" cy="{_number(-center.imag)}"'
            return f'<circle {style} {place} r="{_number(0.5 * diameter)}"/>'
        case Loop():
            data = arc_data(shape.points, shape.bulges)
        case _:
            data = "".join(_data(points, closed) for points, closed in chains(shape, THINNING))
    return f'<path {style} d="{data}"/>'


def _style(feature: Feature, pixel: float) -> str:
    """Return fill and stroke of a feature."""
    tone = _tone(feature)
    ink, fill = INKS[tone], FILLS[tone]
    dashed, bare = feature.kind in drawings.DASHED, not _has_area(feature)
    fills = {drawings.MARK: ink, **dict.fromkeys(drawings.FILLED, fill)}
    inside = (
        "none" if dashed or bare else fill if feature.metal else fills.get(feature.kind, GROUND)
    )
    line = f'stroke="{_INKS.get(feature.kind, ink)}"'
    if dashed:
        line += f' stroke-dasharray="{_number(7 * pixel)} {_number(4 * pixel)}"'
    elif isinstance(feature.shape, Cross):
        line = f'stroke="{TEXT_INK}"'
    # the first of two cams is visible through the second, wheels through members
    clear = ' fill-opacity="0.6"' if tone == 2 and feature.kind in _CLEAR else ""
    return f'fill="{inside}"{clear} {line}'


def _tone(feature: Feature) -> int:
    """Return the number of the colours of a feature."""
    if feature.layer.startswith(("CAM2", drawings.MEMBER)):
        return 2
    return int(feature.layer.startswith("GEAR2") or feature.kind == drawings.FOLLOWER)


def _has_area(feature: Feature) -> bool:
    """Return whether a feature is drawn with an area: a path only if it is an edge."""
    shape, kind = feature.shape, feature.kind
    if isinstance(shape, Path):
        return shape.closed and kind in (*drawings.FILLED, *drawings.THROUGH)
    return not isinstance(shape, Cross) and kind != drawings.GHOST


def _data(points: Plane, closed: bool) -> str:
    """Return thinned path data, y downwards."""
    from shapely import LineString, get_coordinates, simplify

    line = LineString(as_pairs(np.append(points, points[:1]) if closed else points))
    kept = get_coordinates(simplify(line, THINNING, preserve_topology=False))
    kept = kept[:-1] if closed else kept
    steps = " ".join(f"{_number(x)} {_number(-y)}" for x, y in kept.tolist())
    return f"M{steps}" + ("Z" if closed else "")


def arc_data(points: Plane, bulges: Array, decimals: int = DECIMALS) -> str:
    """Return the path data of a closed chain of straight lines and circular arcs.

    Parameters
    ----------
    points : (n,) complex array, mm
        First not repeated; y upwards.
    bulges : (n,) array
        Bulges of the pieces between them.
    decimals : int
        Decimals of every number.

    Returns
    -------
    str
        With y downwards. No arc exceeds a quarter of a circle: the centre of a half circle would be
        inaccurate from a rounded radius.
    """
    start, chord, bends = bulge_pieces(points, bulges, closed=True)
    half = 2.0 * np.arctan(bends)
    parts = np.maximum(1, np.ceil(np.abs(half) / (0.25 * math.pi + _ROUNDING))).astype(np.int64)
    ends, piece = divided(start, chord, bends, parts)
    with np.errstate(divide="ignore"):  # of straight lines
        radii = (0.5 * np.abs(chord) / np.abs(np.sin(half))).tolist()

    def numbers(*values: float) -> str:
        return " ".join(decimal(value, decimals) for value in values)

    steps = []
    for k, end in zip(piece.tolist(), np.roll(ends, -1).tolist(), strict=True):
        # y is downwards: a visual left turn has the sweep flag 0 in SVG
        arc = f"A{numbers(radii[k], radii[k])} 0 0 {int(bends[k] < 0.0)} " if bends[k] else "L"
        steps.append(arc + numbers(end.real, -end.imag))
    return f"M{numbers(start[0].real, -start[0].imag)}{''.join(steps)}Z"
