"""DXF of workshop drawings: the part in its true size, the sheet enlarged or reduced around it.

Lengths are in the unit of the sheet's texts, mm or inches, which ``$INSUNITS`` says, in R12 a
comment.

R2010 has dimension entities, whose text is that of every other format and whose points can be
moved, and hatches; in R12 they are lines, solid arrow heads and texts. The front view has the
position of the part's own drawing, and its outline is written in the same way. Line types are those
of ISO 128-20. The same sheet gives the same bytes.

Refused: splines in R12.

Depends on sheets, drawings and export.dxf; ezdxf only inside the functions.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from gearcam.export import dxf
from gearcam.export.dxf import GREY, DxfStyle
from gearcam.numeric.arrays import Plane, as_pairs
from gearcam.pictures.drawings import CENTER
from gearcam.sheets.dimensions import ARROW, LEAST_GAP, PAST
from gearcam.sheets.sheet import (
    DIMENSION,
    GAP,
    HATCH,
    HATCHED,
    HEIGHT,
    LINE_OF,
    NARROW,
    PATTERNS,
    TEXT,
    Hatch,
    Sheet,
    SheetDimension,
    Text,
    line_width,
)

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document
    from ezdxf.layouts.base import BaseLayout

STYLE: Final = "SHEET"
"""Name of the styles of texts and dimensions."""

_SYMBOLS: Final = {"Ø": "%%c", "°": "%%d", "±": "%%p"}
"""How R12 writes letters that are not ASCII; others as the format's escapes."""

_KINDS: Final = {"linear": 0, "vertical": 0, "diameter": 3, "radius": 4}
"""Types of dimension entities."""


_ANSI31: Final = 3.175
"""Distance of the lines of this pattern, mm; drawings in inches have it in inches."""


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
    old = style.version == "R12"

    def fill(document: Document) -> None:
        _prepare(document, sheet, old)
        space = document.modelspace()
        for feature in sheet.features:
            dxf.add_shape(space, feature.shape, {"layer": feature.layer}, style)
        for hatch in sheet.hatches:
            _hatch(space, sheet, hatch, old)
        for black in sheet.fills:
            _solid(space, black)
        for dimension in sheet.dimensions:
            measured = dimension.kind in _KINDS and not old
            block = document.blocks.new_anonymous_block("D") if measured else space
            for line in dimension.lines:
                dxf.add_chain(block, line, {"layer": DIMENSION}, style)
            for head in dimension.heads:
                _solid(block, head)
            _text(block, sheet, dimension.text, DIMENSION, old)
            if measured:
                _dimension(space, sheet, dimension, block.name)  # type: ignore[attr-defined]
        for text in sheet.texts:
            _text(space, sheet, text, TEXT, old)

    return dxf.document_text(style.version, fill, sheet.units).encode("utf-8")


def _prepare(document: Document, sheet: Sheet, old: bool) -> None:
    """Make line types, layers, and the styles of texts and dimensions."""
    unit = sheet.unit
    for name, parts in PATTERNS.items():
        dashes = [length * (-1) ** number for number, length in enumerate(parts)]
        words = "ISO 128-20, " + ("dashed" if len(parts) == 2 else "long-dashed dotted")
        document.linetypes.add(name, [sum(parts), *dashes], description=words)
    document.header["$LTSCALE"] = NARROW * unit
    kinds = {feature.layer: feature.kind for feature in sheet.features}
    for layer, kind in {**kinds, DIMENSION: DIMENSION, TEXT: TEXT, HATCH: HATCH}.items():
        color = GREY if kind in LINE_OF or kind in (CENTER, HATCH) else 7
        linetype = LINE_OF.get(kind, "Continuous")
        made = document.layers.add(layer, color=color, linetype=linetype)
        if not old:
            made.dxf.lineweight = round(100 * line_width(kind))
    document.styles.add(STYLE, font="arial.ttf")
    low, high = sheet.corner, sheet.corner + unit * complex(*sheet.size)
    document.modelspace().reset_extents((low.real, low.imag, 0.0), (high.real, high.imag, 0.0))
    if old:
        return
    document.header["$LWDISPLAY"] = 1
    made, lengths = document.dimstyles.new(STYLE), sheet.units
    for name, value in {
        "dimscale": unit / lengths.size, "dimtxt": HEIGHT, "dimasz": ARROW, "dimgap": GAP,
        "dimexo": LEAST_GAP, "dimexe": PAST, "dimdec": lengths.decimals, "dimzin": 8,
        "dimdsep": ord("."), "dimtad": 1, "dimtih": 0, "dimtoh": 0, "dimcen": 0.0,
        "dimtxsty": STYLE, "dimtmove": 1, "dimlunit": 2,
    }.items():  # fmt: skip
        made.set_dxf_attrib(name, value)
        document.header[f"${name.upper()}"] = value  # some programs read them only here


def _dimension(space: Any, sheet: Sheet, one: SheetDimension, block: str) -> None:
    """Add a dimension entity that shows a block."""
    base, *rest = (_place(point) for point in one.points)
    middle = one.text.place + 0.5 * one.text.height * sheet.unit * (-1 if one.text.upright else 1j)
    made = {
        "layer": DIMENSION, "dimstyle": STYLE, "geometry": block, "text": one.label,
        "dimtype": _KINDS[one.kind] + 32 + 128, "text_midpoint": _place(middle), "defpoint": base,
        "actual_measurement": one.value / sheet.units.size,
    }  # fmt: skip
    if len(rest) == 2:
        turn = 90.0 if one.kind == "vertical" else 0.0
        made |= {"defpoint2": rest[0], "defpoint3": rest[1], "angle": turn}
    else:
        made["defpoint4"] = rest[0]
    space.new_entity("DIMENSION", made)


def _hatch(space: Any, sheet: Sheet, hatch: Hatch, old: bool) -> None:
    """Add cut metal as a hatch; in R12 as lines."""
    there, gap = {"layer": HATCH}, HATCHED * sheet.unit
    if old:
        for line in hatch.lines(gap):
            space.add_line(*as_pairs(line).tolist(), dxfattribs=there)
        return
    made = space.add_hatch(color=256, dxfattribs=there)
    # a name that programs know, with its lines as far apart as on paper
    made.set_pattern_fill("ANSI31", scale=gap / _ANSI31 * sheet.units.size)
    for loop in hatch.loops:
        made.paths.add_polyline_path(as_pairs(loop).tolist(), is_closed=True)


def _solid(space: BaseLayout, corners: Plane) -> None:
    """Add a triangle in black."""
    points = as_pairs(corners[[0, 1, 2, 2]]).tolist()
    space.add_solid(points, dxfattribs={"layer": DIMENSION})


def _text(space: BaseLayout, sheet: Sheet, text: Text, layer: str, old: bool) -> None:
    from ezdxf.enums import TextEntityAlignment

    align = TextEntityAlignment.CENTER if text.anchor == "middle" else TextEntityAlignment.LEFT
    # The format reads a caret and two percent signs as the beginning of a special character.
    words = text.text.replace("^", "^ ").replace("%%", "%%%%%%")
    if old:
        escaped = (_SYMBOLS.get(c, c if c.isascii() else f"\\U+{ord(c):04X}") for c in words)
        words = "".join(escaped)
    space.add_text(
        words,
        height=text.height * sheet.unit,
        rotation=90.0 if text.upright else 0.0,
        dxfattribs={"layer": layer, "style": STYLE, "width": text.squeeze},
    ).set_placement(_place(text.place), align=align)


def _place(point: complex) -> tuple[float, float]:
    return point.real, point.imag
