"""The files that cams in space have alike."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    from gearcam.kinds.gridded import GriddedCam
    from gearcam.numeric.arrays import Array, Mask
    from gearcam.pictures.drawings import Drawing
    from gearcam.results.kind import FileMaker
    from gearcam.spatial.envelope import RollerContact
    from gearcam.spatial.walls import RollerWall

Files = dict[str, bytes]

GridPart = tuple["RollerWall", dict[str, "Array"], "RollerContact", "Mask"]
"""A wall, columns of its n cam angles, its grid of (n, k) points, and which of these count."""


def wall_columns(parts: Iterable[GridPart], hand: float) -> dict[str, Array]:
    """Return the columns of the table of walls.

    Parameters
    ----------
    parts : iterable of GridPart
        The walls.
    hand : float
        What y is multiplied by.

    Returns
    -------
    dict of str to array
        The wall, the given columns, place along the roller, points, normals into the metal, and
        pressure angle.
    """
    found = []
    for wall, given, grid, on in parts:
        points, normals = grid.points[on].T, grid.normals[on].T
        found.append(
            {
                "wall": np.full(points.shape[1], wall.key),
                **{
                    name: np.broadcast_to(one[:, None], on.shape)[on] for name, one in given.items()
                },
                "x_mm": grid.x[on],
                "X": points[0],
                "Y": hand * points[1],
                "Z": points[2],
                "nx": normals[0],
                "ny": hand * normals[1],
                "nz": normals[2],
                "pressure_angle_deg": np.degrees(grid.pressure[on]),
            }
        )
    return {name: np.concatenate([one[name] for one in found]) for name in found[0]}


def table_files(walls: Mapping[str, Any], motion: Mapping[str, Any]) -> Files:
    """Return the files of the columns of walls and motion."""
    from gearcam.export.table import table_bytes

    return {"walls.csv": table_bytes(walls), "motion.csv": table_bytes(motion)}


def picture_files(result: GriddedCam, drawing: Drawing) -> Files:
    """Return the picture of a `drawing` with the main facts of a `result`."""
    from gearcam.export.svg import svg_bytes

    notes = result.facts.headline
    return {"cam.svg": svg_bytes(drawing, title=result.design.name, notes=notes)}


def _mesh(kind: str, result: Any, _: Any) -> Files:
    from gearcam.export.mesh import mesh_bytes

    return {
        f"{name}.{kind}": mesh_bytes(kind, {name: mesh}, name)
        for name, mesh in result.meshes.items()
    }


def _mesh_files(kind: str) -> FileMaker:
    """Return what makes the meshes of a cam in space in a format."""
    maker = partial(_mesh, kind)
    maker.__doc__ = f"""Return the solid.

    Files: cam.{kind}.

    The cam as a closed solid in mm; the report states the errors of walls and volume.
    """
    return maker


MESHES: Final[Mapping[str, Callable[..., Files]]] = {
    kind: _mesh_files(kind) for kind in ("stl", "3mf", "glb")
}
"""What makes the solid, by format."""
