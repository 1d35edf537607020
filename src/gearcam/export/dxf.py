"""DXF: drawings for cutters, and their error measured on the file as read back.

R2010, millimetres, one layer per feature; each outline is one closed LWPOLYLINE, of arcs
(*bulges*) or of straight pieces; bores and marks are circles. The same drawing gives the same
bytes.

Refused: curves of another kind than ``arcs`` and ``lines``; splines are not available yet.

Depends on drawings and numeric; ezdxf only inside the functions.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
from numpy.typing import NDArray

from gearcam.drawings import (
    BORE,
    CENTER,
    CENTRODE,
    MARK,
    OUTLINE,
    Circle,
    Cross,
    Drawing,
    Path,
    Shape,
)
from gearcam.errors import DesignError, GearcamError, Problem
from gearcam.numeric.arcs import fit_closed
from gearcam.numeric.bulges import deviation
from gearcam.numeric.contour import Contour

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document
    from ezdxf.layouts.layout import Modelspace

Array = NDArray[np.float64]

CURVES: Final = ("arcs", "lines")
"""How curves may be written."""

ARCS_PART: Final = 0.96
"""Part of the tolerance that the arcs may take; the rest covers the chord error of the dense
points that they are fitted to and measured against (at most 1/32 of the tolerance)."""

COLORS: Final = {OUTLINE: 7, BORE: 5, MARK: 1, CENTRODE: 3, CENTER: 8}
"""Colour numbers: black or white, blue, red, green, grey."""

DASHED: Final = (CENTRODE,)
"""Kinds that are drawn dashed."""

MILLIMETRES: Final = 4
"""$INSUNITS."""


class DxfError(GearcamError, ValueError):
    """A DXF file does not hold what it should."""


def dxf_bytes(drawing: Drawing, tolerance: float, curves: str = "arcs") -> bytes:
    """Write a drawing as DXF.

    Parameters
    ----------
    drawing : Drawing
        What to write.
    tolerance : float, mm
        Largest distance between an outline's true curve and its arcs.
    curves : {"arcs", "lines"}
        Arcs within the tolerance, or the contour's adaptive polygon.

    Returns
    -------
    bytes
        The file, UTF-8; the same for the same drawing.

    Raises
    ------
    DesignError
        If `curves` is of another kind.
    """
    if curves not in CURVES:
        late = "splines are not available yet" if curves == "splines" else "unknown kind of curves"
        allowed = ", ".join(f'"{kind}"' for kind in CURVES)
        raise DesignError(
            [
                Problem(
                    late, key="output.dxf_curves", value=curves, allowed=allowed, hint='take "arcs"'
                )
            ]
        )
    from ezdxf.filemanagement import new

    with _fixed_dates():
        document = new("R2010", units=MILLIMETRES)
        document.linetypes.add("DASHED", [3.0, 2.0, -1.0], description="_ _ _ _ _")
        _fill(document, drawing, tolerance, curves)
        # The library would register these classes in the order of a set, which changes from run to
        # run.
        for kind in sorted(document.entitydb.dxf_types_in_use()):
            document.classes.add_class(kind)
        stream = io.StringIO()
        document.write(stream)
    return stream.getvalue().encode("utf-8")


def _fill(document: Document, drawing: Drawing, tolerance: float, curves: str) -> None:
    """Make the layers and put each feature on its own."""
    for feature in drawing.features:
        if feature.layer not in document.layers:
            dashed = "DASHED" if feature.kind in DASHED else "Continuous"
            document.layers.add(feature.layer, color=COLORS.get(feature.kind, 7), linetype=dashed)
    space = document.modelspace()
    low, high = _bounds(drawing)
    space.reset_extents((*low, 0.0), (*high, 0.0))
    for feature in drawing.features:
        _add(space, feature.shape, {"layer": feature.layer}, tolerance, curves)


def _add(
    space: Modelspace, shape: Shape, attributes: dict[str, Any], tolerance: float, curves: str
) -> None:
    match shape:
        case Contour():
            vertices, bulges = _outline(shape, tolerance, curves)
            rows = np.column_stack([vertices, bulges]).tolist()
            space.add_lwpolyline(rows, format="xyb", close=True, dxfattribs=attributes)
        case Path():
            space.add_lwpolyline(
                shape.points.tolist(), format="xy", close=shape.closed, dxfattribs=attributes
            )
        case Circle():
            space.add_circle(shape.center.tolist(), 0.5 * shape.diameter, dxfattribs=attributes)
        case Cross():
            (x, y), arm = shape.center.tolist(), 0.5 * shape.size
            space.add_line((x - arm, y), (x + arm, y), dxfattribs=attributes)
            space.add_line((x, y - arm), (x, y + arm), dxfattribs=attributes)


def _outline(contour: Contour, tolerance: float, curves: str) -> tuple[Array, Array]:
    """Return vertices and bulges of a contour."""
    if curves == "arcs":
        return fit_closed(contour.runs, ARCS_PART * tolerance)
    return contour.vertices, np.zeros(len(contour.vertices))


def _bounds(drawing: Drawing) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the lower left and upper right corner of a drawing, for viewers."""
    corners = []
    for feature in drawing.features:
        match feature.shape:
            case Contour(vertices=points) | Path(points=points):
                corners += [points.min(axis=0), points.max(axis=0)]
            case Circle(center=center, diameter=size) | Cross(center=center, size=size):
                corners += [center - 0.5 * size, center + 0.5 * size]
    low, high = np.min(corners, axis=0).tolist(), np.max(corners, axis=0).tolist()
    return (low[0], low[1]), (high[0], high[1])


@contextmanager
def _fixed_dates() -> Iterator[None]:
    """Keep dates and random identifiers out of the file; the library's option is process-wide."""
    import ezdxf

    options = cast(Any, ezdxf).options
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before


def measure_dxf(data: bytes, contours: Sequence[Contour]) -> float:
    """Measure a DXF file, as read back, against the true outlines.

    Parameters
    ----------
    data : bytes
        The file.
    contours : sequence of Contour
        The true outlines, placed as in the drawing, in its order.

    Returns
    -------
    float, mm
        The largest distance between the dense points of an outline's true curve and the file's
        curve, and between places inside the file's arcs and the dense points' polygon.

    Raises
    ------
    DxfError
        If the file is damaged, is not in millimetres, or holds another number of closed outlines.
    """
    from ezdxf.entities.lwpolyline import LWPolyline

    document = read_dxf(data)
    if document.header.get("$INSUNITS") != MILLIMETRES:
        raise DxfError("the DXF file is not in millimetres")
    outlines = [
        entity
        for entity in document.modelspace()
        if isinstance(entity, LWPolyline) and entity.dxf.layer.endswith(OUTLINE)
    ]
    if len(outlines) != len(contours) or not all(entity.closed for entity in outlines):
        raise DxfError(
            f"the DXF file should hold {len(contours)} closed outlines, it holds {len(outlines)}"
        )
    worst = 0.0
    for entity, contour in zip(outlines, contours, strict=True):
        rows = np.array(entity.get_points(format="xyb"), dtype=np.float64)
        worst = max(worst, deviation(rows[:, :2], rows[:, 2], dense_points(contour)))
    return worst


def read_dxf(data: bytes) -> Document:
    """Return the document in the bytes of a DXF file.

    Raises
    ------
    DxfError
        If the file is damaged, or ezdxf's audit finds anything to report or to mend.
    """
    from ezdxf.filemanagement import read
    from ezdxf.lldxf.const import DXFError

    try:
        document = read(io.StringIO(data.decode("utf-8")))
    except (DXFError, UnicodeDecodeError) as error:
        raise DxfError(f"the DXF file cannot be read: {error}") from error
    audit = document.audit()
    faults = [*audit.errors, *audit.fixes]
    if faults:
        raise DxfError(f"the DXF file has faults ({len(faults)}), the first: {faults[0].message}")
    return document


def dense_points(contour: Contour) -> Array:
    """Return the dense points of a contour's runs, in order, (n, 2), mm, first not repeated."""
    return np.vstack([run.points[:-1] for run in contour.runs])
