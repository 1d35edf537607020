"""From a gear pair to the contents of its files: one function a kind of file."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.export.shared import (
    STEP_PART,
    FileFormat,
    Files,
    cut_files,
    drawn,
    dxf_style,
    mesh_files,
    sheet_files,
)
from gearcam.kinds.gear_pair.columns import POINTS
from gearcam.report.file import REPORT_DOC, report_files
from gearcam.report.file import framed as framed

if TYPE_CHECKING:
    from gearcam.drawings import Placement
    from gearcam.export.dxf import DxfStyle
    from gearcam.kinds.gear_pair.build import GearPairResult
    from gearcam.kinds.gear_pair.stages import PairStages
    from gearcam.parts.body import Part
    from gearcam.solids import Mesh

Measured = dict[str, Any]

PAIR: Final = "pair"
"""Stem of the files of the assembled pair."""


def _tables(result: GearPairResult, _: Measured) -> Files:
    from gearcam.export.table import outline_bytes, table_bytes

    found = result.centrodes()
    centrodes = {name: values for name, values in found.items() if name not in POINTS}
    files = {f"{gear.name}_outline.csv": outline_bytes(gear.outline) for gear in result.gears}
    return files | {"centrodes.csv": table_bytes(centrodes)}


def placements(result: PairStages) -> tuple[Placement, Placement]:
    """Return how the wheels of a `result` stand when assembled: wheel 1 turned by -phi1."""
    phi1, guide = result.design.output.pose, result.pair.rolling.guide
    moved = float(guide.nominal(np.array(phi1)))
    if result.pair.on_rack:
        return (-phi1, (0.0, 0.0)), (0.0, (0.0, -moved))
    return (-phi1, (0.0, 0.0)), (guide.turns * moved, (guide.place, 0.0))


def _style(result: GearPairResult) -> DxfStyle:
    return dxf_style(result.design.output, result.gear1.profile.tolerance)


def _dxf(result: GearPairResult, measured: Measured) -> Files:
    return drawn([*result.to_cut, result.drawing], _style(result), measured)


def _cut(result: GearPairResult, _: Measured) -> Files:
    return cut_files(result.to_cut, result.design.name, result.design.output.kerf)


def _picture(result: GearPairResult, _: Measured) -> Files:
    from gearcam.export.svg import svg_bytes

    notes = result.facts.headline
    return {"pair.svg": svg_bytes(result.drawing, title=result.design.name, notes=notes)}


def _inspection(result: GearPairResult, _: Measured) -> Files:
    from gearcam.export.table import table_bytes
    from gearcam.kinds.gear_pair.ordered import inspection_rows

    rows = inspection_rows(result.steps, result.design.output.inspection_points)
    return {"inspection.csv": table_bytes(rows)}


def _steps(result: GearPairResult, _: Measured) -> Files:
    from gearcam.drawings import UNMOVED
    from gearcam.export.step import step_bytes

    tolerance = STEP_PART * result.gear1.profile.tolerance
    made: dict[Part, Any] = {}
    files = {
        f"{part.name}.step": step_bytes([(part, UNMOVED)], part.name, tolerance, made)
        for part in result.parts
    }
    placed = list(zip(result.parts, placements(result), strict=True))
    return files | {f"{PAIR}.step": step_bytes(placed, PAIR, tolerance, made)}


def _meshes(kind: str, result: GearPairResult, measured: Measured) -> Files:
    return mesh_files(result.parts, result.meshes, {PAIR: assembled(result)}, kind, measured)


def assembled(result: GearPairResult) -> dict[str, Mesh]:
    """Return the solids of both wheels where they stand."""
    placed = zip(result.meshes.items(), placements(result), strict=True)
    return {name: mesh.placed(*pose) for (name, mesh), pose in placed}


def _sheets(ending: str, result: GearPairResult, _: Measured) -> Files:
    return sheet_files(result.sheets, _style(result), ending)


_SOLIDS: Final = "closed solids in mm: each wheel, and the assembled pair as two named bodies"
_SHEETS: Final = "workshop drawings with views, dimensions and a table of data"


def _each(ending: str) -> str:
    return f"gear1{ending}, gear2{ending}, pair{ending}"


FILES: Final[Mapping[str, FileFormat]] = {
    "dxf": FileFormat(
        _dxf,
        _each(".dxf") + "; of stepped wheels gear1_step1.dxf and so on",
        "outlines in mm. A wheel lies in its own frame, on the layers OUTLINE, BORE, HOLE, SLOT and"
        " MARK; the assembled pair has the same layers with GEAR1_ or GEAR2_ before their names,"
        " CENTRODE and CENTER. With `kerf_mm` the files of the wheels hold paths of the cutter, on"
        " layers whose names end in _KERF",
    ),
    "cut-svg": FileFormat(
        _cut,
        "gear1_cut.svg, gear2_cut.svg, cut.svg; of stepped wheels gear1_step1_cut.svg and so on",
        "for laser programs, 1:1 in mm: marks to engrave in blue, then inner edges, then outlines"
        " in red; one file for each part, and cut.svg with all parts side by side and labelled",
    ),
    "svg": FileFormat(_picture, "pair.svg", "a picture of the assembled pair, not for cutting"),
    **{
        kind: FileFormat(partial(_meshes, kind), _each(f".{kind}"), _SOLIDS)
        for kind in ("stl", "3mf", "glb")
    },
    "step": FileFormat(
        _steps,
        _each(".step"),
        "exact solids for CAD: one spline face for each flank, fillet, land and tip, planes and"
        ' cylinders elsewhere; needs `pip install "gearcam[step]"`',
    ),
    "csv": FileFormat(
        _tables,
        "gear1_outline.csv, gear2_outline.csv, centrodes.csv",
        "vertices of the outlines; angles, ratio, radii, arc lengths and radii of curvature of both"
        " centrodes",
    ),
    "drawing-dxf": FileFormat(partial(_sheets, "dxf"), _each("_drawing.dxf"), _SHEETS),
    "drawing-svg": FileFormat(partial(_sheets, "svg"), _each("_drawing.svg"), _SHEETS),
    "inspection": FileFormat(
        _inspection,
        "inspection.csv",
        "points on every flank with their normals, for a measuring machine",
    ),
    "report": FileFormat(report_files, "report.html", REPORT_DOC),
}
"""What each word of ``output.files`` makes."""
