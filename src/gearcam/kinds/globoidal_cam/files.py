"""From the result of a globoidal cam to the contents of its files: one function a format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.kinds.gridded_files import MESHES, picture_files, table_files, wall_columns
from gearcam.laws.phases_of_lift import TURN
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
    from gearcam.spatial.globoidal_surface import rib_angles

    cam, parts = result.cam, []
    for k, wall in enumerate(cam.walls):
        theta = rib_angles(cam, result.steps) + TURN * k
        grid = wall.grid(theta, result.design.output.wall_points)
        turns = np.floor(theta / TURN)
        angles = {"roller": turns.astype(int), "theta_deg": np.degrees(theta - TURN * turns)}
        parts.append((wall, angles, grid, cam.between_faces(grid.points)))
    return table_files(wall_columns(parts, cam.hand), result.motion())


def _svg(result: GloboidalCamResult, _: Any) -> Files:
    """Return a picture of the unrolled cam.

    Files: cam.svg.

    The globoid through the middle of the rollers, unrolled, with the rollers; not for cutting.
    """
    from gearcam.kinds.globoidal_cam.drawn import picture

    return picture_files(result, picture(result))


FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "csv": _tables,
    "svg": _svg,
    **MESHES,
    "report": report_files,
}
"""What makes the files of each format: contents by name."""
