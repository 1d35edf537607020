"""From a gear pair to the contents of its files: one function a format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Final

from gearcam.kinds.gear_pair.tables import POINTS
from gearcam.report.file import report_files
from gearcam.results.parts import MESHES, Files, Measured, part_files

if TYPE_CHECKING:
    from gearcam.kinds.gear_pair.result import GearPairResult


def _tables(result: GearPairResult, _: Measured) -> Files:
    """Return the outlines and the centrodes as tables.

    Files: gear1_outline.csv, gear2_outline.csv, centrodes.csv.

    Vertices of the outlines; angles, ratio, radii, arc lengths and radii of curvature of both
    centrodes.
    """
    from gearcam.export.table import outline_bytes, table_bytes

    columns = result.centrodes()
    centrodes = {name: values for name, values in columns.items() if name not in POINTS}
    files = {
        f"{gear.name}_outline.csv": outline_bytes(gear.profile.points) for gear in result.gears
    }
    return files | {"centrodes.csv": table_bytes(centrodes)}


def _inspection(result: GearPairResult, _: Measured) -> Files:
    """Return the points for inspection.

    Files: inspection.csv.

    Points on every flank with their normals, for a measuring machine.
    """
    from gearcam.export.table import table_bytes
    from gearcam.kinds.gear_pair.parts import inspection_rows

    rows = inspection_rows(result.steps, result.design.output.inspection_points)
    return {"inspection.csv": table_bytes(rows)}


_SOLIDS: Final = """
    Files: gear1.{format}, gear2.{format}, pair.{format}.

    Closed solids in mm: each wheel, and the assembled pair as two bodies, named except in STL."""

_SHEETS: Final = """
    Files: gear1_drawing.{format}, gear2_drawing.{format}, pair_drawing.{format}.

    Workshop drawings with views, dimensions and a table of data."""

_OF_PARTS: Final = {
    "dxf": """
    Files: gear1.dxf, gear2.dxf, pair.dxf; of stepped wheels gear1_step1.dxf and so on.

    Outlines in mm. A wheel lies in its own frame, on the layers OUTLINE, BORE, HOLE, SLOT and MARK;
    the assembled pair has the same layers with GEAR1_ or GEAR2_ before their names, CENTRODE and
    CENTER. With `kerf_mm` the files of the wheels hold paths of the cutter, on layers whose names
    end in _KERF.""",
    "cut-svg": """
    Files: gear1_cut.svg, gear2_cut.svg, cut.svg; of stepped wheels gear1_step1_cut.svg and so on.

    For laser programs, 1:1 in mm: marks to engrave in blue, then inner edges, then outlines in red;
    one file for each part, and cut.svg with all parts side by side and labelled.""",
    "svg": """
    Files: pair.svg.

    A picture of the assembled pair, not for cutting.""",
    **dict.fromkeys(MESHES, _SOLIDS),
    "step": """
    Files: gear1.step, gear2.step, pair.step.

    Exact solids for CAD: one spline face for each flank, fillet, land and tip, planes and cylinders
    elsewhere. Needs `pip install "gearcam[step]"`.""",
    "drawing-dxf": _SHEETS,
    "drawing-svg": _SHEETS,
}

FILES: Final[Mapping[str, Callable[..., Files]]] = {
    **part_files(_OF_PARTS),
    "csv": _tables,
    "inspection": _inspection,
    "report": report_files,
}
"""What makes the files of each format: contents by name; what is measured on them is recorded."""
