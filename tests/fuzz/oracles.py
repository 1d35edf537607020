"""Checks that every result must pass: simple polygons, closed solids, files that others can read.

Shapely checks polygons, trimesh solids, and ezdxf, XML and JSON readers files: libraries that the
computation of a design does not use.
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

from fuzz.outcome import Failure
from gearcam.base.errors import GearcamError, InfeasibleError
from gearcam.designs.outputs import MESHES
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import Contour
from gearcam.parts.body import Layer, Part
from gearcam.results.written import BuildOutput

_ROUNDING: Final = 1e-9
"""Largest rounding of coordinates in files, relative to the size of the part."""

_JOINED: Final = 0.1
"""Largest gap between the curves of an edge, in tolerances: on a steep profile the rounding of an
angle moves their ends."""


def look_at(result: Any, written: BuildOutput) -> Iterator[Failure]:
    """Yield the failures of a result and its files.

    Parameters
    ----------
    result : Result
        The result to check.
    written : BuildOutput
        Its files.
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
    """Return the parts made of layers; none if they cannot be made, and no file needs them."""
    try:
        return tuple(getattr(result, "parts", ()))
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
    """Yield edges with gaps between their smooth curves."""
    for layer in (*part.layers, *part.pockets):
        for edge in (one for one in layer.edges if isinstance(one, Contour)):
            ends = np.array([run.points[[0, -1]] for run in edge.runs])
            gap = float(np.abs(np.roll(ends[:, 0], -1) - ends[:, 1]).max())
            if not gap <= _ROUNDING * edge.reach + _JOINED * part.tolerance:
                words = f"{part.name}: curves of an edge end {gap} mm from the next"
                yield Failure(kind="polygon", words=words, place="torn")


def _rings(layer: Layer, tolerance: float) -> tuple[Any, list[Any]]:
    outer, *inner = (as_pairs(edge.polyline(tolerance)) for edge in layer.edges)
    return outer, inner


def _drawing_errors(parts: Iterable[Part], written: BuildOutput) -> Iterator[Failure]:
    """Yield a failure if DXF curves read back deviate from the true ones by more than allowed."""
    read = written.summary.get("accuracy", {}).get("dxf_mm")
    if not read:
        return
    worst = max(read.values())
    reach = max(abs(part.outline).max() for part in parts)
    allowed = max(part.tolerance for part in parts) + _ROUNDING * float(reach)
    if not worst <= allowed:
        words = f"DXF read back deviates by {worst} mm, {allowed} mm are allowed"
        yield Failure(kind="file", words=words, place="dxf error")


def _unread(path: Path) -> Iterator[str]:
    """Yield the error that another reader finds in a file."""
    try:
        words = _READERS.get(path.suffix, _nothing)(path)
    except (GearcamError, ValueError, ET.ParseError) as error:
        words = f"{type(error).__name__}: {error}"
    if words:
        yield words


def _nothing(path: Path) -> str:
    return "" if path.stat().st_size else "empty"


def _solids(path: Path) -> str:
    """Read solids with trimesh: each is closed and has a positive volume."""
    from trimesh import Scene, load

    found = load(io.BytesIO(path.read_bytes()), file_type=path.suffix[1:])
    bodies = found.geometry.values() if isinstance(found, Scene) else [found]
    if path.suffix == ".stl":  # one unordered list of the triangles of all bodies
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
    """Read a table: rows as long as the header, no NaN in outlines."""
    head, *rows = csv.reader(io.StringIO(path.read_text(encoding="utf-8")))
    for number, row in enumerate(rows, start=2):
        if len(row) != len(head):
            return f"line {number} has {len(row)} values for {len(head)} columns"
        if "nan" in row and path.stem.endswith("outline"):
            return f"line {number} holds nan"
    return "" if rows else "no rows"


def _summary(path: Path) -> str:
    def no_number(word: str) -> float:
        raise ValueError(f"{word} is not a JSON number")

    found = json.loads(path.read_text(encoding="utf-8"), parse_constant=no_number)
    return "" if math.isfinite(found["format"]) else "no format"


_READERS: Final[dict[str, Callable[[Path], str]]] = {
    **dict.fromkeys((f".{kind}" for kind in MESHES), _solids),
    ".dxf": _drawing,
    ".svg": _markup,
    ".csv": _table,
    ".json": _summary,
}
"""Readers by file extension; they return an error or an empty text. Other files: not empty."""
