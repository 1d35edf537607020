"""What is true of every result: polygons are simple, solids closed, files read by other readers.

Shapely says what a polygon is, trimesh what is closed, ezdxf, the XML and the JSON reader what is
in a file; none of them is asked when designs are built, or only by what writes files.
"""

from __future__ import annotations

import csv
import io
import json
import math
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

from gearcam.errors import GearcamError, InfeasibleError
from gearcam.fuzz.outcome import Failure
from gearcam.numeric.contour import Contour
from gearcam.parts.body import Layer, Part
from gearcam.written import Written

_ROUNDING: Final = 1e-9
"""Part of a part's reach that coordinates in files are rounded by, at most."""

_JOINED: Final = 0.1
"""Gap between the curves of an edge, in tolerances: where a profile is fast the rounding of an
angle moves their ends; more is refused."""


def look_at(result: Any, written: Written) -> Iterator[Failure]:
    """Yield what is wrong with a result and its files.

    Parameters
    ----------
    result : Result
        What was built.
    written : Written
        What was written of it.
    """
    parts = _parts(result)
    for part in parts:
        yield from _polygons(part)
        yield from _torn(part)
    for name in written.files:
        path = written.directory / name
        for words in _unread(path):
            yield Failure(kind="file", words=f"{name}: {words}", place=path.suffix)
    yield from _drawing_errors(parts, written)


def _parts(result: Any) -> tuple[Part, ...]:
    """Return what can be cut; nothing where that is refused, and no file asks for it."""
    try:
        return tuple(result.parts)
    except InfeasibleError:
        return ()


def _polygons(part: Part) -> Iterator[Failure]:
    from shapely import Polygon, is_valid_reason

    for layer in (*part.layers, *part.pockets):
        region = Polygon(*_rings(layer, part.tolerance))
        if not region.is_valid or region.area <= 0.0:
            words = f"{part.name}: {is_valid_reason(region)}, area {region.area} mm2"
            yield Failure(kind="polygon", words=words, place=part.name.rstrip("0123456789"))


def _torn(part: Part) -> Iterator[Failure]:
    """Yield edges whose smooth curves do not begin where the ones before end."""
    for layer in (*part.layers, *part.pockets):
        for edge in (one for one in layer.edges if isinstance(one, Contour)):
            ends = np.array([run.points[[0, -1]] for run in edge.runs])
            gap = float(np.abs(np.roll(ends[:, 0], -1, axis=0) - ends[:, 1]).max())
            if not gap <= _ROUNDING * edge.reach + _JOINED * part.tolerance:
                words = f"{part.name}: curves of an edge end {gap} mm from the next"
                yield Failure(kind="polygon", words=words, place="torn")


def _rings(layer: Layer, tolerance: float) -> tuple[Any, list[Any]]:
    return layer.edge.points(tolerance), [one.shape.points(tolerance) for one in layer.openings]


def _drawing_errors(parts: Iterable[Part], written: Written) -> Iterator[Failure]:
    """Yield files of curves that, read back, are farther from the true ones than allowed."""
    read = written.summary.get("accuracy", {}).get("dxf_mm")
    if not read:
        return
    worst = max(read.values())
    reach = max(abs(part.outline).max() for part in parts)
    allowed = max(part.tolerance for part in parts) + _ROUNDING * float(reach)
    if not worst <= allowed:
        words = f"DXF read back is {worst} mm off, {allowed} mm are allowed"
        yield Failure(kind="file", words=words, place="dxf error")


def _unread(path: Path) -> Iterator[str]:
    """Yield why another reader finds a file at fault."""
    try:
        words = _READERS.get(path.suffix, _nothing)(path)
    except (GearcamError, ValueError, ET.ParseError) as error:
        words = f"{type(error).__name__}: {error}"
    if words:
        yield words


def _nothing(path: Path) -> str:
    return "" if path.stat().st_size else "empty"


def _solids(path: Path) -> str:
    """Read solids with trimesh: each is closed and encloses something."""
    from trimesh import Scene, load

    found = load(io.BytesIO(path.read_bytes()), file_type=path.suffix[1:])
    bodies = found.geometry.values() if isinstance(found, Scene) else [found]
    if path.suffix == ".stl":  # which holds triangles of all bodies in one heap
        bodies = [one for body in bodies for one in body.split(only_watertight=False, repair=False)]
    open_ones = sum(not body.is_watertight for body in bodies)
    if not bodies or open_ones:
        return f"{open_ones} of {len(bodies)} solids are not watertight"
    least = min(float(body.volume) for body in bodies)
    return "" if least > 0.0 else f"a solid of volume {least} mm3"


def _drawing(path: Path) -> str:
    from gearcam.export.dxf_read import read_dxf

    read_dxf(path.read_bytes())
    return ""


def _markup(path: Path) -> str:
    ET.fromstring(path.read_bytes())
    return ""


def _table(path: Path) -> str:
    """Read a table: rows as long as the head, numbers that are numbers."""
    head, *rows = csv.reader(io.StringIO(path.read_text(encoding="utf-8")))
    for number, row in enumerate(rows, start=2):
        if len(row) != len(head):
            return f"line {number} has {len(row)} values for {len(head)} columns"
        if "nan" in row and path.stem.endswith("outline"):
            return f"line {number} holds nan"
    return "" if rows else "no rows"


def _summary(path: Path) -> str:
    def no_number(word: str) -> float:
        raise ValueError(f"{word} is no number of JSON")

    found = json.loads(path.read_text(encoding="utf-8"), parse_constant=no_number)
    return "" if math.isfinite(found["format"]) else "no format"


_READERS: Final[dict[str, Callable[[Path], str]]] = {
    ".stl": _solids,
    ".3mf": _solids,
    ".glb": _solids,
    ".dxf": _drawing,
    ".svg": _markup,
    ".csv": _table,
    ".json": _summary,
}
"""What reads a file by its ending and returns what is wrong; others are only not empty."""
