"""From the result of a cam in space to the contents of its files: one function a format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.kinds.shared import mesh_files
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
    from gearcam.export.table import table_bytes

    theta, count = result.wall_angles, result.design.output.wall_points
    side = result.cam.hand
    rows: dict[str, list[Any]] = {}
    for wall in result.cam.walls:
        grid = wall.grid(theta, count)
        points, normals = grid.points.reshape(-1, 3).T, grid.normals.reshape(-1, 3).T
        columns = {
            "wall": np.full(points.shape[1], wall.key),
            "theta_deg": np.degrees(np.repeat(theta, count)),
            "x_mm": grid.x.ravel(),
            "X": points[0],
            "Y": side * points[1],
            "Z": points[2],
            "nx": normals[0],
            "ny": side * normals[1],
            "nz": normals[2],
            "pressure_angle_deg": np.degrees(grid.pressure.ravel()),
        }
        for name, values in columns.items():
            rows.setdefault(name, []).append(values)
    walls = {name: np.concatenate(values) for name, values in rows.items()}
    table = result.motion()
    short = dict(zip([*table][1:5], ("s", "ds", "d2s", "d3s"), strict=True))
    motion = {short.get(name, name): values for name, values in table.items()}
    return {"walls.csv": table_bytes(walls), "motion.csv": table_bytes(motion)}


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
    from gearcam.export.svg import svg_bytes
    from gearcam.kinds.spatial_cam.drawn import picture

    notes = result.facts.headline
    return {"cam.svg": svg_bytes(picture(result), title=result.design.name, notes=notes)}


FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "csv": _tables,
    "dxf": _dxf,
    "svg": _svg,
    **{kind: mesh_files(kind) for kind in ("stl", "3mf", "glb")},
    "step": _step,
    "report": report_files,
    **MILLED,
}
"""What makes the files of each format: contents by name."""
