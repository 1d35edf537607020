"""From the result of a globoidal cam to the contents of its files: one function a format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.kinds.shared import mesh_files
from gearcam.report.file import report_files

if TYPE_CHECKING:
    from gearcam.kinds.globoidal_cam.build import GloboidalCamResult

Files = dict[str, bytes]


def _tables(result: GloboidalCamResult, _: Any) -> Files:
    """Return the walls and the motion as tables.

    Files: walls.csv, motion.csv.

    Points of the rib's walls between its faces, in the cam's frame, over cam angle and place along
    the roller: `roller` counts upwards from the one that is half a stop below the middle at
    theta_deg = 0, x_mm is the distance from the turret's axis, X, Y, Z the point in mm, nx, ny, nz
    the normal into the metal; with the pressure angle. The turret's angle, its derivatives and
    pressure angles over the cam angle: also the path of a mill as wide as the groove, whose axis is
    that of a roller.
    """
    from gearcam.export.table import table_bytes
    from gearcam.spatial.globoidal_surface import rib_angles

    cam, count = result.cam, result.design.output.wall_points
    theta, turn = rib_angles(cam, result.steps), 2.0 * np.pi
    rows: dict[str, list[Any]] = {}
    for k, wall in enumerate(cam.walls):
        over = theta + turn * k
        grid = wall.grid(over, count)
        on = cam.between_faces(grid.points)
        turns = np.floor(over / turn)
        points, normals = grid.points[on].T, grid.normals[on].T
        columns = {
            "wall": np.full(points.shape[1], wall.key),
            "roller": np.broadcast_to(turns[:, None], on.shape)[on].astype(int),
            "theta_deg": np.broadcast_to(np.degrees(over - turn * turns)[:, None], on.shape)[on],
            "x_mm": grid.x[on],
            "X": points[0],
            "Y": cam.hand * points[1],
            "Z": points[2],
            "nx": normals[0],
            "ny": cam.hand * normals[1],
            "nz": normals[2],
            "pressure_angle_deg": np.degrees(grid.pressure[on]),
        }
        for name, values in columns.items():
            rows.setdefault(name, []).append(values)
    walls = {name: np.concatenate(values) for name, values in rows.items()}
    return {"walls.csv": table_bytes(walls), "motion.csv": table_bytes({**result.motion()})}


def _svg(result: GloboidalCamResult, _: Any) -> Files:
    """Return a picture of the unrolled cam.

    Files: cam.svg.

    The globoid through the middle of the rollers, unrolled, with the rollers; not for cutting.
    """
    from gearcam.export.svg import svg_bytes
    from gearcam.kinds.globoidal_cam.drawn import picture

    notes = result.facts.headline
    return {"cam.svg": svg_bytes(picture(result), title=result.design.name, notes=notes)}


FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "csv": _tables,
    "svg": _svg,
    **{kind: mesh_files(kind) for kind in ("stl", "3mf", "glb")},
    "report": report_files,
}
"""What makes the files of each format: contents by name."""
