"""From the result of a cam in space to the contents of its files: one function a format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.kinds.gridded_files import MESHES, picture_files, table_files, wall_columns
from gearcam.kinds.spatial_cam.milled import MILLED
from gearcam.report.file import report_files

if TYPE_CHECKING:
    from gearcam.kinds.spatial_cam.build import SpatialCamResult

Files = dict[str, bytes]


def _tables(result: SpatialCamResult, _: Any) -> Files:
    """Return the walls and the motion as tables.

    Files: walls.csv, motion.csv.

    Points of the walls in the cam's frame over cam angle and place along the roller: x_mm is the
    distance along the roller's axis, X, Y, Z the point in mm, nx, ny, nz the normal into the metal;
    with the pressure angle. Lift, its derivatives and pressure angles over the cam angle.
    """
    theta, count = result.wall_angles, result.design.output.wall_points
    all_of = np.ones((len(theta), count), dtype=bool)
    angles = {"theta_deg": np.degrees(theta)}
    parts = [(wall, angles, wall.grid(theta, count), all_of) for wall in result.cam.walls]
    table = result.motion()
    short = dict(zip([*table][1:5], ("s", "ds", "d2s", "d3s"), strict=True))
    motion = {short.get(name, name): values for name, values in table.items()}
    return table_files(wall_columns(parts, result.cam.hand), motion)


def _step(result: SpatialCamResult, _: Any) -> Files:
    """Return the solid for CAD.

    Files: cam.step.

    The cam as a solid for CAD and CAM: planes and cylinders are exact, walls are B-splines through
    exact points; the report states their error. Needs `pip install "gearcam[step]"`.
    """
    from gearcam.export.step import step_bytes
    from gearcam.numeric.pose import UNMOVED

    body = result.bands
    return {f"{body.name}.step": step_bytes([(body, UNMOVED)], body.name, body.error)}


def _dxf(result: SpatialCamResult, _: Any) -> Files:
    """Return the outside of the cam, unrolled, as DXF.

    Files: developed.dxf.

    The cylinder of the outer diameter, unrolled from the cam angle 0 to 360 deg, 1:1 in mm: the
    edges of the true groove on UPPER and LOWER, the centre line on PITCH, the sheet on BLANK. To
    wrap round the cylinder, as a template or to check; walls cut along it radially are not true.
    """
    from gearcam.export.dxf import DxfStyle, dxf_bytes
    from gearcam.kinds.spatial_cam.drawn import developed_drawing

    style = DxfStyle(tolerance=1e-3, curves="lines", version="R2010")
    return {"developed.dxf": dxf_bytes(developed_drawing(result), style)}


def _svg(result: SpatialCamResult, _: Any) -> Files:
    """Return a picture of the unrolled cam.

    Files: cam.svg.

    The outside of the cam, unrolled, with its roller; not for cutting.
    """
    from gearcam.kinds.spatial_cam.drawn import picture

    return picture_files(result, picture(result))


FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "csv": _tables,
    "dxf": _dxf,
    "svg": _svg,
    **MESHES,
    "step": _step,
    "report": report_files,
    **MILLED,
}
"""What makes the files of each format: contents by name."""
