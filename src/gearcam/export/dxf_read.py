"""DXF files read back: their outlines, and the error of these against the true curves.

Refused: files that are damaged, that the audit of ezdxf would repair, that are in no unit of
length that is read, or whose outlines are not those expected.

Depends on drawings and numeric; ezdxf only inside the functions.
"""

from __future__ import annotations

import io
from collections import Counter
from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.inches import file_unit
from gearcam.base.numerals import formatted
from gearcam.base.units import factor
from gearcam.export.dxf_pieces import JOINED, DrawnPiece, DxfError, entities_of, joined, pieces_of
from gearcam.numeric.arrays import Array, Plane, bounds
from gearcam.numeric.bulges import deviation
from gearcam.numeric.contour import Contour
from gearcam.pictures.drawings import CLOSED, INNER, KERF, OUTER_WALL, OUTLINE, PROFILE

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document


_SHOWN: Final = 80
"""Characters of messages of ezdxf that are printed: they may quote a whole file."""

_R12: Final = "AC1009"
"""The version without units and light polylines."""

_FINE: Final = 1e-5
"""Largest deviation of arcs from the splines and ellipses of other programs, mm."""

_LISTED: Final = 6
"""Outlines, or types of entities, that a message lists."""

_ROUNDING: Final = 1e-9
"""Largest difference of coordinates, mm, and bulges of one outline in two poses: rounding, far
below the errors that are measured."""

Known = dict[Contour, tuple[Plane, Array, float]]
"""Outlines as read in their own frames: points, bulges, and the measured error, mm."""


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
        If the file is damaged, is not in the unit of files, or holds another number of closed
        outlines.
    """
    document, unit = read_dxf(data), file_unit()
    if document.dxfversion != _R12 and document.header.get("$INSUNITS") != unit.dxf:
        raise DxfError(f"the DXF file is not in {unit.name}")
    drawn = [own for layer, own in entities_of(document.modelspace()) if layer.endswith(CLOSED)]
    every = joined(list(pieces_of(drawn, scale=unit.size)), _ROUNDING)
    # a pitch curve may be open; rims are circles, which are exact
    outlines = [outline for outline in every if outline.closed and not outline.whole_circle]
    if len(outlines) != len(contours):
        raise DxfError(
            f"the DXF file should hold {len(contours)} closed outlines, but holds {len(outlines)}"
        )
    known = {} if known is None else known
    return max(
        _error(outline.points, outline.bulges, contour, known)
        for outline, contour in zip(outlines, contours, strict=True)
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


def read_outline(data: bytes, *, outer: bool = False) -> tuple[Plane, Array]:
    """Return the closed outline of a DXF file.

    Parameters
    ----------
    data : bytes
        The file, in the unit of its $INSUNITS; without one in mm. If it holds several outlines, the
        one on layer PROFILE, OUTLINE or INNER is taken. Layers that are off or frozen are left
        out, unless there are no others. Lines, arcs, splines and open polylines are joined where
        two of them meet. A circle within the box around the other edges on its layer is a bore,
        and so is each circle if only circles close and there are other edges.
    outer : bool
        Whether to take the wall of a groove on layer OUTER.

    Returns
    -------
    points : (n,) complex array, mm
        First not repeated.
    bulges : (n,) array
        Of the pieces between them; splines and ellipses become arcs through their points.

    Raises
    ------
    DxfError
        If the file is damaged, is in a unit that nobody cuts in, holds paths of a cutter, or does
        not hold one closed outline of finite numbers, in a plane parallel to xy.
    """
    document = read_dxf(data)
    scale = _unit(document)
    by_layer = _by_layer(document)
    paths = [layer for layer in by_layer if layer.upper().endswith(KERF)]
    if paths:
        raise DxfError(
            f"the layer {paths[0]} holds the path of a cutter, not an edge: "
            "take one written without a kerf, or the _reference.dxf of a cam"
        )

    @cache
    def outlines(*layers: str) -> list[DrawnPiece]:
        drawn = (entity for layer in layers for entity in by_layer[layer])
        return joined(list(pieces_of(drawn, scale=scale, within=_FINE)))

    for wanted in (PROFILE, OUTLINE, OUTER_WALL if outer else INNER, ""):
        layers = [layer for layer in by_layer if layer.upper().endswith(wanted)]
        closed = [(layer, one) for layer in layers for one in _closed(outlines(layer))]
        if all(one.whole_circle for _, one in closed):
            edges = [one for one in outlines(*layers) if not one.whole_circle]
            # some draw lines and arcs on layers of their own
            across = [("", one) for one in edges if one.closed]
            # edges that do not close may be the outline whose bores the circles are
            closed = [] if edges and not across else closed + across
        if len(closed) == 1:
            return closed[0][1].points, closed[0][1].bulges
    if closed:
        raise DxfError(_several(closed))
    types = Counter(one.dxftype() for layer in by_layer.values() for one in layer)
    raise DxfError(_open(types, [one for one in outlines(*by_layer) if not one.closed]))


def _by_layer(document: Document) -> dict[str, list[Any]]:
    """Return the entities of a drawing by layer: of those that are shown, if there are any."""
    by_layer: dict[str, list[Any]] = {}
    for layer, entity in entities_of(document.modelspace()):
        by_layer.setdefault(layer, []).append(entity)
    hidden = {one.dxf.name.lower() for one in document.layers if one.is_off() or one.is_frozen()}
    return {name: by_layer[name] for name in by_layer if name.lower() not in hidden} or by_layer


def _closed(pieces: Sequence[DrawnPiece]) -> list[DrawnPiece]:
    """Return the closed outlines of a layer, without circles in the box around its other edges."""
    corners = [corner for one in pieces if not one.whole_circle for corner in one.box]
    if not corners:
        return list(pieces)  # nothing but circles
    box = bounds(np.array(corners))

    def bore(one: DrawnPiece) -> bool:
        return one.whole_circle and bounds(np.array([*box, *one.box])) == box

    return [one for one in pieces if one.closed and not bore(one)]


def _unit(document: Document) -> float:
    """Return the unit of a drawing, mm; that of one without a unit is 1 mm."""
    code = document.header.get("$INSUNITS", 0)
    if code == 0:
        return 1.0
    from ezdxf.units import decode, unit_name

    try:
        scale, name = factor(decode(code) or "", "mm"), unit_name(code).lower()
    except (IndexError, ValueError):
        scale, name = None, f"an unknown unit, $INSUNITS = {code}"
    if scale is None:
        raise DxfError(f"the DXF file is in {name}: save it in millimetres or inches")
    return scale


def _several(closed: Sequence[tuple[str, DrawnPiece]]) -> str:
    """Return the message on several closed outlines: what they are, and how to choose."""
    sizes = [(f"layer {layer}, " * bool(layer), *one.size) for layer, one in closed]
    listed = "; ".join(
        f"{layer}{formatted(width, 5)} x {formatted(height, 5)} mm"
        for layer, width, height in sizes[:_LISTED]
    )
    more = f"; and {len(sizes) - _LISTED} more" if len(sizes) > _LISTED else ""
    return (
        f"the DXF file should hold one closed outline, but it holds {len(sizes)}: {listed}{more}. "
        f"Put the one meant on a layer named {PROFILE}"
    )


def _open(types: Counter[str], pieces: Sequence[DrawnPiece]) -> str:
    """Return the message on a drawing without a closed outline: what there is, and the gap."""
    listed = ", ".join(f"{count} {name}" for name, count in types.most_common(_LISTED))
    found = f"the DXF file holds no closed outline (it holds {listed or 'nothing'})"
    if not pieces:
        rule = "a closed polyline, or lines and arcs that meet"
        return f"{found}: draw it as {rule}; a circle alone, on a layer named {PROFILE}"
    longest = max(pieces, key=lambda piece: sum(piece.size))
    end = longest.points[-1]
    others = [piece.points[k] for piece in pieces for k in (0, -1)]
    gaps = np.sort(np.abs(np.array(others) - end))[1:]  # without the end itself
    at = f"x = {formatted(end.real)}, y = {formatted(end.imag)} mm"
    if np.count_nonzero(gaps <= JOINED) > 1:
        return f"{found}: more than two lines meet at {at}; leave only those of the outline"
    return (
        f"{found}: its longest part ends at {at}, {formatted(gaps[0], 3)} mm from the next end; "
        f"ends up to {formatted(JOINED)} mm apart are joined"
    )


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
