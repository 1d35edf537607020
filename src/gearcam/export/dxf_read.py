"""DXF files read back: their outlines, and the error of these against the true curves.

Refused: files that are damaged, that the audit of ezdxf would repair, that are not in millimetres,
or whose outlines are not those expected.

Depends on drawings and numeric; ezdxf only inside the functions.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.errors import GearcamError
from gearcam.export.dxf import MILLIMETRES
from gearcam.numeric.arrays import Array, Plane, as_complex
from gearcam.numeric.bulges import deviation
from gearcam.numeric.contour import Contour
from gearcam.pictures.drawings import CLOSED, INNER, KERF, OUTER_WALL, OUTLINE, PROFILE

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document


_Outline = tuple[Plane, Array, bool]
"""Points, bulges, and whether it is closed."""

_SHOWN: Final = 80
"""Characters of messages of ezdxf that are printed: they may quote a whole file."""

_R12: Final = "AC1009"
"""The version without units and light polylines."""

_ON_CUBIC: Final = 16
"""Arcs that replace each cubic of a spline, each through three of its points: they deviate by half
a percent of the spline's own tolerance; 8 arcs would deviate by 3 %."""


_ROUNDING: Final = 1e-9
"""Largest difference of coordinates, mm, and bulges of one outline in two poses: rounding, far
below the errors that are measured."""

Known = dict[Contour, tuple[Plane, Array, float]]
"""Outlines as read in their own frames: points, bulges, and the measured error, mm."""


class DxfError(GearcamError, ValueError):
    """A DXF file does not hold the expected outlines, or cannot be read."""


def measure_dxf(data: bytes, contours: Sequence[Contour], known: Known | None = None) -> float:
    """Measure a DXF file, as read back, against the true outlines.

    Parameters
    ----------
    data : bytes
        The file.
    contours : sequence of Contour
        The true outlines (and a cam's pitch curve), placed as in the drawing, in its order.
    known : dict, optional
        Measured errors are kept here, so that an outline is measured in one pose only.

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
    every = _outlines(document, lambda layer: layer.endswith(CLOSED))
    outlines = [outline for outline in every if outline[2]]  # a pitch curve may be open
    if len(outlines) != len(contours):
        raise DxfError(
            f"the DXF file should hold {len(contours)} closed outlines, but holds {len(outlines)}"
        )
    known = {} if known is None else known
    return max(
        _error(points, bulges, contour, known)
        for (points, bulges, _), contour in zip(outlines, contours, strict=True)
    )


def _error(points: Plane, bulges: Array, contour: Contour, known: Known) -> float:
    """Return the error of an outline, measured now or in another pose."""
    if contour.own in known:
        own, bends, error = known[contour.own]
        if len(own) == len(points):
            missed = np.abs(points - contour.pose.apply(own)).max(), np.abs(bulges - bends).max()
            if max(missed) <= _ROUNDING:
                return error
    # the first point of each run is the last of the one before
    dense = np.concatenate([run.points[:-1] for run in contour.runs])
    error = deviation(points, bulges, dense)
    if contour.own is contour:
        known[contour] = points, bulges, error
    return error


def _outlines(document: Document, wanted: Callable[[str], bool]) -> Iterator[_Outline]:
    """Yield polylines, and splines chained until one ends where the first begins."""
    from ezdxf.entities.lwpolyline import LWPolyline
    from ezdxf.entities.polyline import Polyline
    from ezdxf.entities.spline import Spline

    chain: list[tuple[Plane, Array]] = []
    for entity in document.modelspace():
        if not wanted(_layer(entity)):
            continue
        if isinstance(entity, LWPolyline):
            rows = entity.lwpoints.values
            yield as_complex(rows[:, :2]), rows[:, 4], bool(entity.closed)
        elif isinstance(entity, Polyline):
            rows = np.array(
                [(*v.dxf.location.vec2, v.dxf.get("bulge", 0.0)) for v in entity.vertices]
            )
            yield as_complex(rows[:, :2]), rows[:, 2], bool(entity.is_closed)
        elif isinstance(entity, Spline):
            chain.append(_arcs(entity))
            if chain[-1][0][-1] == chain[0][0][0]:
                yield _joined(chain)
                chain = []
    if chain:
        yield _joined(chain)


def _layer(entity: Any) -> str:
    """Return the layer of an entity; empty if ezdxf does not know its type."""
    return entity.dxf.layer if entity.dxf.is_supported("layer") else ""


def _joined(chain: Sequence[tuple[Plane, Array]]) -> _Outline:
    """Join splines; they are closed if each begins where the one before ends."""
    following = [*chain[1:], chain[0]]
    closed = all(a[-1] == b[0] for (a, _), (b, _) in zip(chain, following, strict=True))
    points = np.concatenate([points[:-1] for points, _ in chain])
    return points, np.concatenate([bulges for _, bulges in chain]), closed


def read_outline(data: bytes, *, outer: bool = False) -> tuple[Plane, Array]:
    """Return the closed outline of a DXF file.

    Parameters
    ----------
    data : bytes
        The file. If it holds several outlines, the one on layer PROFILE, OUTLINE or INNER is
        taken.
    outer : bool
        Whether to take the wall of a groove on layer OUTER.

    Returns
    -------
    points : (n,) complex array, mm
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
            "take one written without a kerf, or the _reference.dxf of a cam"
        )
    for wanted in (PROFILE, OUTLINE, OUTER_WALL if outer else INNER, ""):
        candidates = [
            (points, bulges)
            for layer in layers
            if layer.upper().endswith(wanted)
            for points, bulges, closed in _outlines(document, layer.__eq__)
            if closed
        ]
        if len(candidates) == 1:
            if not all(np.isfinite(values).all() for values in candidates[0]):
                raise DxfError("the outline has coordinates that are not finite")
            return candidates[0]
    raise DxfError(f"the DXF file should hold one closed outline, but it holds {len(candidates)}")


def _arcs(entity: Any) -> tuple[Plane, Array]:
    """Points and bulges of arcs through points of a spline, by ezdxf's own evaluation."""
    curve = entity.construction_tool()
    breaks = np.unique(np.array(curve.knots()))
    steps = np.linspace(0.0, 1.0, 2 * _ON_CUBIC, endpoint=False)
    places = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * steps).ravel(), breaks[-1])
    points = np.array([complex(point.x, point.y) for point in curve.points(places.tolist())])
    ends = [curve.control_points[k] for k in (0, -1)]
    points[[0, -1]] = [complex(end.x, end.y) for end in ends]
    chord = np.diff(points)
    # the turn at an inner point of an arc is half the arc's angle
    turn = np.angle(chord[1::2] * np.conj(chord[::2]))
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
        raise DxfError("the DXF file is binary: save it as text (ASCII)")
    # older files are not in UTF-8, and on Windows lines end in two characters
    text = data.decode("utf-8-sig", errors="surrogateescape")
    try:
        document = read(io.StringIO(text, newline=None))
        audit = document.audit()
    except Exception as error:  # of any type: ezdxf looks up what a damaged file names
        reason = " ".join(str(error).split())[:_SHOWN]
        raise DxfError(f"the DXF file cannot be read: {reason}") from error
    faults = [*audit.errors, *audit.fixes]
    if faults:
        raise DxfError(f"the DXF file has errors ({len(faults)}); the first: {faults[0].message}")
    return document
