"""DXF of workshop drawings: the part in true millimetres, its sheet enlarged or reduced around it.

R2010 has dimension entities, which can be edited; in R12 they are lines, solid arrow heads and
texts. The front view has the position of the part's own drawing, and its outline is written in the
same way. The same sheet gives the same bytes.

Refused: splines in R12.

Depends on sheets, drawings and export.dxf; ezdxf only inside the functions.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

from gearcam.export import dxf
from gearcam.export.dxf import GREY, DxfStyle
from gearcam.numeric.arrays import as_pairs
from gearcam.pictures.drawings import CENTER, DASHED
from gearcam.sheets.sheet import (
    ARROW,
    CENTERLINE,
    DIMENSION,
    GAP,
    GLYPH,
    HEAVY,
    HEIGHT,
    HIDDEN,
    LEAST_GAP,
    PAST,
    TEXT,
    THICK,
    THIN,
    Dimension,
    DrawnDimension,
    LinearDimension,
    RoundDimension,
    Sheet,
    Text,
    as_drawn,
)

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document
    from ezdxf.layouts.layout import Modelspace

SHEET_COLORS: Final = {
    **dict.fromkeys((CENTER, CENTERLINE, HIDDEN, *DASHED), GREY),
    DIMENSION: 2,
}
"""Colours: dimensions yellow, lines for reference grey; all others are 7, black or white."""

LINETYPES: Final = {
    "DASHED": ([4.5, 3.0, -1.5], "__ __ __"),
    "CENTER": ([12.0, 8.0, -1.5, 1.0, -1.5], "____ _ ____ _"),
}
"""Total length of the pattern, its dashes and gaps, mm of paper."""

LINETYPE_OF: Final = {**dict.fromkeys((*DASHED, HIDDEN), "DASHED"), CENTERLINE: "CENTER"}
"""Line types by layer type; all others are continuous."""

STYLE: Final = "SHEET"
"""Name of the styles of texts and dimensions."""


def sheet_dxf(sheet: Sheet, style: DxfStyle) -> bytes:
    """Return a sheet as DXF.

    Parameters
    ----------
    sheet : Sheet
        The sheet.
    style : DxfStyle
        How outlines are written, and the version of the format.

    Returns
    -------
    bytes
        The file, UTF-8, of R12 ASCII; the same for the same sheet.
    """

    def fill(document: Document) -> None:
        _prepare(document, sheet, style)
        space = document.modelspace()
        for feature in sheet.features:
            dxf.add_shape(space, feature.shape, {"layer": feature.layer}, style)
        for dimension in sheet.dimensions:
            if style.version == "R12":
                _exploded(space, sheet, as_drawn(dimension, sheet.unit))
            else:
                _measured(space, dimension)
        for text in sheet.texts:
            _text(space, sheet, text, TEXT)

    text = dxf.document_text(style.version, fill)
    if style.version == "R12":
        # Old readers know one code page only: other letters are written as the format's escapes.
        text = "".join(char if char.isascii() else f"\\U+{ord(char):04X}" for char in text)
    return text.encode("utf-8")


def _prepare(document: Document, sheet: Sheet, style: DxfStyle) -> None:
    """Make line types, layers, and the styles of texts and dimensions."""
    unit = sheet.unit
    for name, (pattern, words) in LINETYPES.items():
        document.linetypes.add(name, [unit * length for length in pattern], description=words)
    kinds = {feature.layer: feature.kind for feature in sheet.features}
    for layer, kind in {**kinds, DIMENSION: DIMENSION, TEXT: TEXT}.items():
        color, linetype = SHEET_COLORS.get(kind, 7), LINETYPE_OF.get(kind, "Continuous")
        made = document.layers.add(layer, color=color, linetype=linetype)
        if style.version != "R12":
            made.dxf.lineweight = round(100 * (THICK if kind in HEAVY else THIN))
    document.styles.add(STYLE, font="arial.ttf", dxfattribs={"width": GLYPH})
    low, high = sheet.corner, sheet.corner + unit * complex(*sheet.size)
    document.modelspace().reset_extents((*_pair(low), 0.0), (*_pair(high), 0.0))
    if style.version == "R12":
        return
    document.header["$LWDISPLAY"] = 1
    made = document.dimstyles.new(STYLE)
    values = {
        "dimscale": unit,
        "dimtxt": HEIGHT,
        "dimasz": ARROW,
        "dimgap": GAP,
        "dimexo": LEAST_GAP,
        "dimexe": PAST,
        "dimdec": 3,
        "dimzin": 8,
        "dimdsep": ord("."),
        "dimtad": 1,
        "dimtih": 0,
        "dimtoh": 0,
        "dimtix": 0,
        "dimtofl": 0,
        "dimcen": 0.0,
        "dimtxsty": STYLE,
        "dimclrt": 7,
        "dimtmove": 1,
        "dimlunit": 2,
    }
    for name, value in values.items():
        made.set_dxf_attrib(name, value)


def _measured(space: Modelspace, dimension: Dimension) -> None:
    """Add a dimension entity."""
    words = f"{dimension.prefix}<>{dimension.suffix}"
    rest: dict[str, Any] = {"text": words, "dimstyle": STYLE, "dxfattribs": {"layer": DIMENSION}}
    if isinstance(dimension, LinearDimension):
        made = space.add_linear_dim(
            base=_pair(dimension.line),
            p1=_pair(dimension.first),
            p2=_pair(dimension.second),
            location=_pair(dimension.place),
            angle=90.0 if dimension.vertical else 0.0,
            override={"dimtmove": 2},
            **rest,
        )
    else:
        made = _round(space, dimension, rest)
    made.render()


def _round(space: Modelspace, dimension: RoundDimension, rest: dict[str, Any]) -> Any:
    rest |= {"center": _pair(dimension.center), "radius": dimension.radius}
    if dimension.knee is None:
        angle = math.degrees(dimension.angle)
        return space.add_diameter_dim(angle=angle, override={"dimtix": 1, "dimtmove": 0}, **rest)
    rest["override"] = {"dimtih": 1, "dimtoh": 1}
    rest["location"] = _pair(dimension.point(dimension.knee))
    return (space.add_diameter_dim if dimension.diameter else space.add_radius_dim)(**rest)


def _exploded(space: Modelspace, sheet: Sheet, drawn: DrawnDimension) -> None:
    """Add a dimension as lines, solid arrow heads and a text."""
    there = {"layer": DIMENSION}
    for line in drawn.lines:
        space.add_line(*as_pairs(line).tolist(), dxfattribs=there)
    for head in drawn.heads:
        space.add_solid(as_pairs(head[[0, 1, 2, 2]]).tolist(), dxfattribs=there)
    _text(space, sheet, drawn.text, DIMENSION)


def _text(space: Modelspace, sheet: Sheet, text: Text, layer: str) -> None:
    from ezdxf.enums import TextEntityAlignment

    align = TextEntityAlignment.CENTER if text.anchor == "middle" else TextEntityAlignment.LEFT
    # The format reads a caret and two percent signs as the beginning of a special character.
    words = text.text.replace("^", "^ ").replace("%%", "%%%%%%").replace("Ø", "%%c")
    made = space.add_text(
        words,
        height=text.height * sheet.unit,
        rotation=90.0 if text.upright else 0.0,
        dxfattribs={"layer": layer, "style": STYLE},
    )
    made.set_placement(_pair(text.place), align=align)


def _pair(point: complex) -> tuple[float, float]:
    return point.real, point.imag
