"""DXF files read back: what a written file holds, and its error against the true curves.

Refused: files that are damaged, that the audit of ezdxf would mend, that are not in millimetres, or
that hold other outlines than they should.

Depends on drawings and numeric; ezdxf only inside the functions.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.drawings import CLOSED, INNER, KERF, OUTER_WALL, OUTLINE, PROFILE
from gearcam.errors import GearcamError
from gearcam.export.dxf import MILLIMETRES
from gearcam.numeric.arrays import Array
from gearcam.numeric.bulges import as_complex, deviation
from gearcam.numeric.contour import Contour

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document


_Outline = tuple[Array, Array, bool]
"""Vertices, bulges, and whether it is closed."""

_SHOWN: Final = 80
"""Characters of what ezdxf complains of: it may quote a whole file."""

_R12: Final = "AC1009"
"""The version that knows no units and no light polylines."""

_ON_CUBIC: Final = 16
"""Arcs that stand for each cubic of a spline, each through three of its points: they leave it
by half a percent of what it may be off itself, 8 of them by 3 %."""


_ROUNDING: Final = 1e-9
"""What coordinates, mm, and bulges of an outline may differ by from those of the one that it is,
placed: rounding, far below what is measured."""

Known = dict[Contour, tuple[Array, Array, float]]
"""Outlines as read in their own frames, vertices and bulges, and what was measured on them, mm."""


class DxfError(GearcamError, ValueError):
    """A DXF file does not hold what it should."""


def measure_dxf(data: bytes, contours: Sequence[Contour], known: Known | None = None) -> float:
    """Measure a DXF file, as read back, against the true outlines.

    Parameters
    ----------
    data : bytes
        The file.
    contours : sequence of Contour
        The true outlines (and a cam's pitch curve), placed as in the drawing, in its order.
    known : dict, optional
        What is measured is kept in here: an outline that is one of these, placed, has its error.

    Returns
    -------
    float, mm
        The largest distance between the dense points of an outline's true curve and the file's
        curve, and between places inside the file's curve and the dense points' polygon.

    Raises
    ------
    DxfError
        If the file is damaged, is not in millimetres, or holds another number of closed outlines.
    """
    document = read_dxf(data)
    if document.dxfversion != _R12 and document.header.get("$INSUNITS") != MILLIMETRES:
        raise DxfError("the DXF file is not in millimetres")
    found = _outlines(document, lambda layer: layer.endswith(CLOSED))
    outlines = [outline for outline in found if outline[2]]  # a pitch curve may be open
    if len(outlines) != len(contours):
        raise DxfError(
            f"the DXF file should hold {len(contours)} closed outlines, it holds {len(outlines)}"
        )
    known = {} if known is None else known
    return max(
        _error(vertices, bulges, contour, known)
        for (vertices, bulges, _), contour in zip(outlines, contours, strict=True)
    )


def _error(vertices: Array, bulges: Array, contour: Contour, known: Known) -> float:
    """Return the error of an outline, measured, or that of the one that it is, placed."""
    if contour.own in known:
        own, bends, error = known[contour.own]
        if len(own) == len(vertices):
            missed = np.abs(vertices - contour.moved(own)).max(), np.abs(bulges - bends).max()
            if max(missed) <= _ROUNDING:
                return error
    # the first point of each run is the last of the one before
    dense = np.vstack([run.points[:-1] for run in contour.runs])
    error = deviation(vertices, bulges, dense)
    if contour.own is contour:
        known[contour] = vertices, bulges, error
    return error


def _outlines(document: Document, wanted: Callable[[str], bool]) -> Iterator[_Outline]:
    """Yield polylines, and splines chained until one ends where the first begins."""
    from ezdxf.entities.lwpolyline import LWPolyline
    from ezdxf.entities.polyline import Polyline
    from ezdxf.entities.spline import Spline

    chain: list[tuple[Array, Array]] = []
    for entity in document.modelspace():
        if not wanted(_layer(entity)):
            continue
        if isinstance(entity, LWPolyline):
            rows = entity.lwpoints.values
            yield rows[:, :2], rows[:, 4], bool(entity.closed)
        elif isinstance(entity, Polyline):
            rows = np.array(
                [(*v.dxf.location.vec2, v.dxf.get("bulge", 0.0)) for v in entity.vertices]
            )
            yield rows[:, :2], rows[:, 2], bool(entity.is_closed)
        elif isinstance(entity, Spline):
            chain.append(_arcs(entity))
            if (chain[-1][0][-1] == chain[0][0][0]).all():
                yield _joined(chain)
                chain = []
    if chain:
        yield _joined(chain)


def _layer(entity: Any) -> str:
    """Return the layer of an entity; nothing of one that ezdxf does not know."""
    return entity.dxf.layer if entity.dxf.is_supported("layer") else ""


def _joined(chain: Sequence[tuple[Array, Array]]) -> _Outline:
    """Join splines, each of which begins where the one before ends if they are closed."""
    following = [*chain[1:], chain[0]]
    closed = all((a[-1] == b[0]).all() for (a, _), (b, _) in zip(chain, following, strict=True))
    vertices = np.vstack([points[:-1] for points, _ in chain])
    return vertices, np.concatenate([bulges for _, bulges in chain]), closed


def read_outline(data: bytes, *, outer: bool = False) -> tuple[Array, Array]:
    """Return the one closed outline of a DXF file.

    Parameters
    ----------
    data : bytes
        The file. Where it holds several outlines, that on the layer PROFILE, OUTLINE
        or INNER counts.
    outer : bool
        Whether of a groove's walls that on the layer OUTER is meant.

    Returns
    -------
    vertices : (n, 2) array, mm
        First not repeated.
    bulges : (n,) array
        Of the pieces between them; splines become arcs through their points.

    Raises
    ------
    DxfError
        If the file is damaged, holds paths of a cutter, or does not hold one closed outline of
        finite numbers.
    """
    document = read_dxf(data)
    layers = dict.fromkeys(_layer(entity) for entity in document.modelspace())
    paths = [layer for layer in layers if layer.upper().endswith(KERF)]
    if paths:
        raise DxfError(
            f"the layer {paths[0]} holds the path of a cutter, not an edge: "
            "take the file that ends in _reference.dxf, or one written without a kerf"
        )
    for wanted in (PROFILE, OUTLINE, OUTER_WALL if outer else INNER, ""):
        found = [
            (vertices, bulges)
            for layer in layers
            if layer.upper().endswith(wanted)
            for vertices, bulges, closed in _outlines(document, layer.__eq__)
            if closed
        ]
        if len(found) == 1:
            if not np.isfinite(np.column_stack(found[0])).all():
                raise DxfError("its outline has numbers that are not finite")
            return found[0]
    raise DxfError(f"it should hold one closed outline, and holds {len(found)}")


def _arcs(entity: Any) -> tuple[Array, Array]:
    """Vertices and bulges of arcs through points of a spline, by ezdxf's own evaluation."""
    curve = entity.construction_tool()
    breaks = np.unique(np.array(curve.knots()))
    steps = np.linspace(0.0, 1.0, 2 * _ON_CUBIC, endpoint=False)
    places = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * steps).ravel(), breaks[-1])
    points = np.array([(point.x, point.y) for point in curve.points(places.tolist())])
    points[[0, -1]] = [tuple(curve.control_points[k])[:2] for k in (0, -1)]
    way = np.diff(as_complex(points))
    # the turn at an inner point of an arc is half the arc's angle
    turn = np.angle(way[1::2] * np.conj(way[::2]))
    return points[::2], np.tan(0.5 * turn)


def read_dxf(data: bytes) -> Document:
    """Return the document in the bytes of a DXF file.

    Raises
    ------
    DxfError
        If the file is damaged, or ezdxf's audit finds anything to report or to mend.
    """
    from ezdxf.filemanagement import read

    if data.startswith(b"AutoCAD Binary DXF"):
        raise DxfError("the DXF file is binary: save it as text")
    # older files are in another encoding than UTF-8, and lines end in two characters on Windows
    text = data.decode("utf-8-sig", errors="surrogateescape")
    try:
        document = read(io.StringIO(text, newline=None))
        audit = document.audit()
    except Exception as error:  # of any type: ezdxf looks up what a damaged file names
        told = " ".join(str(error).split())[:_SHOWN]
        raise DxfError(f"the DXF file cannot be read: {told}") from error
    faults = [*audit.errors, *audit.fixes]
    if faults:
        raise DxfError(f"the DXF file has faults ({len(faults)}), the first: {faults[0].message}")
    return document
