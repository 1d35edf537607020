"""From a gear pair to the contents of its files: one function a kind of file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.export.files import (
    Files,
    cut_files,
    drawn,
    dxf_style,
    mesh_files,
    sheet_files,
    step_files,
)
from gearcam.kinds.gear_pair.columns import POINTS
from gearcam.report.file import report_files

if TYPE_CHECKING:
    from gearcam.export.dxf import DxfStyle
    from gearcam.kinds.gear_pair.build import GearPairResult
    from gearcam.kinds.gear_pair.stages import PairStages
    from gearcam.parts.solids import Mesh
    from gearcam.pictures.drawings import Placement

Measured = dict[str, Any]

PAIR: Final = "pair"
"""Stem of the files of the assembled pair."""


def _tables(result: GearPairResult, _: Measured) -> Files:
    """Return the outlines and the centrodes as tables.

    Files: gear1_outline.csv, gear2_outline.csv, centrodes.csv.

    Vertices of the outlines; angles, ratio, radii, arc lengths and radii of curvature of both
    centrodes.
    """
    from gearcam.export.table import outline_bytes, table_bytes

    found = result.centrodes()
    centrodes = {name: values for name, values in found.items() if name not in POINTS}
    files = {f"{gear.name}_outline.csv": outline_bytes(gear.outline) for gear in result.gears}
    return files | {"centrodes.csv": table_bytes(centrodes)}


def placements(result: PairStages) -> tuple[Placement, Placement]:
    """Return the placements of the assembled wheels of a `result`: wheel 1 turned by -phi1."""
    phi1, guide = result.design.output.pose, result.pair.rolling.guide
    moved = float(guide.nominal(np.array(phi1)))
    if result.pair.on_rack:
        return (-phi1, (0.0, 0.0)), (0.0, (0.0, -moved))
    return (-phi1, (0.0, 0.0)), (guide.turns * moved, (guide.place, 0.0))


def _style(result: GearPairResult) -> DxfStyle:
    return dxf_style(result.design.output, result.gear1.profile.tolerance)


def _dxf(result: GearPairResult, measured: Measured) -> Files:
    """Return the outlines as DXF.

    Files: gear1.dxf, gear2.dxf, pair.dxf; of stepped wheels gear1_step1.dxf and so on.

    Outlines in mm. A wheel lies in its own frame, on the layers OUTLINE, BORE, HOLE, SLOT and MARK;
    the assembled pair has the same layers with GEAR1_ or GEAR2_ before their names, CENTRODE and
    CENTER. With `kerf_mm` the files of the wheels hold paths of the cutter, on layers whose names
    end in _KERF.
    """
    return drawn([*result.to_cut, result.drawing], _style(result), measured)


def _cut(result: GearPairResult, _: Measured) -> Files:
    """Return the outlines for laser programs.

    Files: gear1_cut.svg, gear2_cut.svg, cut.svg; of stepped wheels gear1_step1_cut.svg and so on.

    For laser programs, 1:1 in mm: marks to engrave in blue, then inner edges, then outlines in red;
    one file for each part, and cut.svg with all parts side by side and labelled.
    """
    return cut_files(result.to_cut, result.design.name, result.design.output.kerf)


def _picture(result: GearPairResult, _: Measured) -> Files:
    """Return the picture of the pair.

    Files: pair.svg.

    A picture of the assembled pair, not for cutting.
    """
    from gearcam.export.svg import svg_bytes

    notes = result.facts.headline
    return {"pair.svg": svg_bytes(result.drawing, title=result.design.name, notes=notes)}


def _inspection(result: GearPairResult, _: Measured) -> Files:
    """Return the points for inspection.

    Files: inspection.csv.

    Points on every flank with their normals, for a measuring machine.
    """
    from gearcam.export.table import table_bytes
    from gearcam.kinds.gear_pair.ordered import inspection_rows

    rows = inspection_rows(result.steps, result.design.output.inspection_points)
    return {"inspection.csv": table_bytes(rows)}


def _steps(result: GearPairResult, _: Measured) -> Files:
    """Return the solids as STEP.

    Files: gear1.step, gear2.step, pair.step.

    Exact solids for CAD: one spline face for each flank, fillet, land and tip, planes and cylinders
    elsewhere. Needs `pip install "gearcam[step]"`.
    """
    parts, tolerance = result.parts, result.gear1.profile.tolerance
    return step_files(parts, tolerance, PAIR, placements(result))


def _meshes(kind: str, result: GearPairResult, measured: Measured) -> Files:
    """Return the solids in one of the formats of meshes.

    Files: gear1.{format}, gear2.{format}, pair.{format}.

    Closed solids in mm: each wheel, and the assembled pair as two bodies, named except in STL.
    """
    return mesh_files(result.parts, result.meshes, {PAIR: assembled(result)}, kind, measured)


def assembled(result: GearPairResult) -> dict[str, Mesh]:
    """Return the solids of both wheels in the assembly."""
    placed = zip(result.meshes.items(), placements(result), strict=True)
    return {name: mesh.placed(*pose) for (name, mesh), pose in placed}


def _sheets(ending: str, result: GearPairResult, _: Measured) -> Files:
    """Return the workshop drawings.

    Files: gear1_drawing.{format}, gear2_drawing.{format}, pair_drawing.{format}.

    Workshop drawings with views, dimensions and a table of data.
    """
    return sheet_files(result.sheets, _style(result), ending)


FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "dxf": _dxf,
    "cut-svg": _cut,
    "svg": _picture,
    **{kind: partial(_meshes, kind) for kind in ("stl", "3mf", "glb")},
    "step": _steps,
    "csv": _tables,
    "drawing-dxf": partial(_sheets, "dxf"),
    "drawing-svg": partial(_sheets, "svg"),
    "inspection": _inspection,
    "report": report_files,
}
"""What makes each kind of file: contents by name; what is measured on them is written down."""
