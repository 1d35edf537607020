"""DXF: drawings for cutters.

R2010 or R12, in the unit of files, one layer per feature. Each outline is one closed polyline, of
arcs (*bulges*) or of straight pieces, or a chain of cubic splines, one from corner to corner;
openings and marks are circles, or polylines of exact arcs. R12, for old machines, has no splines
and no units. The same drawing gives the same bytes.

Refused: splines in R12.

Depends on drawings and numeric; ezdxf only inside the functions.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np

from gearcam.base.inches import MILLIMETRES, FileUnit, file_unit
from gearcam.base.numerals import formatted
from gearcam.numeric.arcs import fit_closed
from gearcam.numeric.arrays import Array, Plane, as_pairs
from gearcam.numeric.contour import Contour
from gearcam.numeric.splines import DEGREE, fit_splines
from gearcam.pictures import drawings
from gearcam.pictures.drawings import Circle, Cross, Drawing, Loop, Path, Shape, box, chains

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document
    from ezdxf.layouts.base import BaseLayout
    from ezdxf.layouts.layout import Modelspace


CURVES: Final = ("arcs", "splines", "lines")
"""How curves may be written."""

VERSIONS: Final = ("R2010", "R12")
"""Versions of the format."""

CURVE_PART: Final = 0.96
"""Part of the tolerance that arcs and splines may take; the rest covers the chord error of the
dense points that they are fitted to and measured against (at most 1/32 of the tolerance)."""

RED: Final = 1
BLUE: Final = 5
GREY: Final = 8
"""Colour numbers: as in the SVG for cutting, what is cut is red and what is engraved is blue."""

COLORS: Final = {
    **dict.fromkeys((*drawings.OUTER, *drawings.THROUGH, drawings.OUTER_WALL, drawings.TOOL), RED),
    **dict.fromkeys(drawings.ENGRAVED, BLUE),
}
"""Colours by layer type; all others, and drawings that are for reference, are grey."""


@dataclass(frozen=True, kw_only=True)
class DxfStyle:
    """How a drawing is written.

    Parameters
    ----------
    tolerance : float, mm
        Largest distance between an outline's true curve and the curve in the file.
    curves : {"arcs", "splines", "lines"}
        Arcs or cubic splines within the tolerance, or the contour's adaptive polygon.
    version : {"R2010", "R12"}
        Of the format.

    Raises
    ------
    ValueError
        For unknown words, or splines in R12.
    """

    tolerance: float
    curves: str = "arcs"
    version: str = "R2010"

    def __post_init__(self) -> None:
        if self.curves not in CURVES or self.version not in VERSIONS:
            raise ValueError(f"unknown curves or version: {self.curves}, {self.version}")
        if self.curves == "splines" and self.version == "R12":
            raise ValueError("DXF R12 does not support splines")


def dxf_bytes(drawing: Drawing, style: DxfStyle) -> bytes:
    """Write a drawing as DXF.

    Parameters
    ----------
    drawing : Drawing
        The drawing.
    style : DxfStyle
        How.

    Returns
    -------
    bytes
        The file, UTF-8; the same for the same drawing.
    """
    text = document_text(style.version, lambda new: _fill(new, drawing, style), file_unit())
    return text.encode("utf-8")


def document_text(
    version: str, fill: Callable[[Document], None], unit: FileUnit = MILLIMETRES
) -> str:
    """Return the text of a DXF file.

    Parameters
    ----------
    version : {"R2010", "R12"}
        Of the format.
    fill : callable
        Fills the new document, in mm.
    unit : FileUnit
        That of the file.

    Returns
    -------
    str
        Without dates: the same for the same content.
    """
    from ezdxf.filemanagement import new

    with _fixed_dates():
        document = new(version, units=unit.dxf)
        fill(document)
        if unit.size != 1.0:
            _scale(document, 1.0 / unit.size)
        # the library would register these classes in the random order of a set
        for kind in sorted(document.entitydb.dxf_types_in_use()):
            document.classes.add_class(kind)
        stream = io.StringIO()
        document.write(stream)
    inches = version == "R12" and unit.size != 1.0  # it has no unit, but comments
    return f"999\n{unit.told('lengths are in mm')}\n" * inches + stream.getvalue()


def _scale(document: Document, factor: float) -> None:
    """Scale a drawing with its extents and the pattern of its dashes."""
    from ezdxf.math import Matrix44

    space = document.modelspace()
    for entity in space:
        entity.transform(Matrix44.scale(factor))  # type: ignore[union-attr]
    space.reset_extents(*(factor * space.dxf.get(end) for end in ("extmin", "extmax")))
    document.header["$LTSCALE"] *= factor


def _fill(document: Document, drawing: Drawing, style: DxfStyle) -> None:
    """Make the layers and add each feature to its layer."""
    document.linetypes.add("DASHED", [3.0, 2.0, -1.0], description="_ _ _ _ _")
    for feature in drawing.features:
        if feature.layer not in document.layers:
            dashed = "DASHED" if feature.kind in drawings.DASHED else "Continuous"
            color = COLORS.get(feature.kind, GREY) if drawing.cut else GREY
            document.layers.add(feature.layer, color=color, linetype=dashed)
    space = document.modelspace()
    low, high = box(drawing.features)
    space.reset_extents((low.real, low.imag, 0.0), (high.real, high.imag, 0.0))
    for feature in drawing.features:
        add_shape(space, feature.shape, {"layer": feature.layer}, style)


def add_shape(space: Modelspace, shape: Shape, attributes: dict[str, Any], style: DxfStyle) -> None:
    """Add a shape to a model space.

    Parameters
    ----------
    space : Modelspace
        Of ezdxf.
    shape : Contour or Circle or Loop or Path or Cross
        What to add.
    attributes : dict
        Of its entities, such as the layer.
    style : DxfStyle
        How curves are written.

    Raises
    ------
    ValueError
        If the runs of a contour do not join.
    """
    match shape:
        case Contour() if style.curves == "splines":
            for poles, knots in _splines(shape, style):
                space.add_open_spline(
                    poles.tolist(), degree=DEGREE, knots=knots.tolist(), dxfattribs=attributes
                )
        case Contour() if style.curves == "arcs":
            points, bulges = shape.fitted(fit_closed, CURVE_PART * style.tolerance)
            _polyline(space, shape.pose.apply(points), bulges, attributes, style)
        case Contour(points=points):
            _polyline(space, points, 0.0, attributes, style)
        case Loop(points=points, bulges=bulges):
            _polyline(space, points, bulges, attributes, style)
        case Path(points=points, closed=closed):
            _polyline(space, points, 0.0, attributes, style, closed=closed)
        case Circle(center=center, diameter=diameter):
            space.add_circle((center.real, center.imag), 0.5 * diameter, dxfattribs=attributes)
        case Cross():
            for line, _ in chains(shape, style.tolerance):
                space.add_line(*as_pairs(line).tolist(), dxfattribs=attributes)


def add_chain(
    space: BaseLayout, points: Plane, attributes: dict[str, Any], style: DxfStyle
) -> None:
    """Add an open chain of straight lines (see `add_shape`)."""
    _polyline(space, points, 0.0, attributes, style, closed=False)


def _polyline(
    space: BaseLayout,
    points: Plane,
    bulges: Array | float,
    attributes: dict[str, Any],
    style: DxfStyle,
    *,
    closed: bool = True,
) -> None:
    """Add a polyline of the type that the version supports."""
    bends, pairs = np.broadcast_to(bulges, len(points)), as_pairs(points)
    if style.version == "R12":
        rows = np.column_stack([pairs, bends]).tolist()
        space.add_polyline2d(rows, format="xyb", close=closed, dxfattribs=attributes)
        return
    line = space.add_lwpolyline((), close=closed, dxfattribs=attributes)
    # all at once: the library would add them one by one
    line.lwpoints.extend(np.column_stack([pairs, np.zeros_like(pairs), bends]))


def _splines(contour: Contour, style: DxfStyle) -> Iterator[tuple[Array, Array]]:
    """Yield poles and knots of the spline of each run; each begins where the last one ends."""
    splines = contour.fitted(fit_splines, CURVE_PART * style.tolerance)
    for spline, following in zip(splines, [*splines[1:], splines[0]], strict=True):
        gap = float(abs(spline.poles[-1] - following.poles[0]))
        if gap > style.tolerance:
            raise ValueError(
                f"smooth pieces of an outline do not join: a gap of {formatted(gap, 3)} mm"
            )
        poles = contour.pose.apply(np.append(spline.poles[:-1], following.poles[:1]))
        yield as_pairs(poles), spline.knots


@contextmanager
def _fixed_dates() -> Iterator[None]:
    """Keep dates and random identifiers out of the file: an option for the whole process."""
    import ezdxf

    options = cast(Any, ezdxf).options
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before
