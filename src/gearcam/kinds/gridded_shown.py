"""The facts and the files that cams in space have alike."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.facts import Fact, Tree
from gearcam.designs.outputs import DRAWINGS, MESHES
from gearcam.kinds.gridded import FINE, ORDERS
from gearcam.kinds.shared import peak_of

if TYPE_CHECKING:
    from gearcam.kinds.gridded import GriddedCam
    from gearcam.numeric.arrays import Array, Mask
    from gearcam.pictures.drawings import Drawing
    from gearcam.results.kind import FileMaker, Files
    from gearcam.spatial.envelope import RollerContact
    from gearcam.spatial.walls import RollerCam, RollerWall


def peak_facts(result: GriddedCam, scale: float, unit: str, whose: str = "") -> Tree:
    """Return continuity, and the peaks of a motion's derivatives.

    Parameters
    ----------
    result : GriddedCam
        The cam.
    scale : float
        Factor to the unit.
    unit : str
        That unit.
    whose : str
        What moves, as the end of their labels.
    """
    program, drive = result.program, result.design.drive
    tree: Tree = {"continuity": Fact(program.continuity, "continuity of the motion", unit="")}
    for name, order, power in ORDERS:
        peak, (key, what) = scale * program.peaks[order - 1], peak_of(program, name, order)
        label = what.replace(name, f"{name}{whose}")
        tree[key] = Fact(peak, label, unit=f"{unit}/rad{power}")
        if drive.speed is not None:
            value, place = peak * drive.speed**order, f"at {drive.named}"
            tree[f"{key}_{unit}_s{power}"] = Fact(value, label, place=place)
    return tree


def spread_facts(wall: RollerWall) -> Tree:
    """Return how much a `wall` spreads; nothing where none of it is on the cam."""
    spot = wall.spread
    if math.isinf(spot.value):
        return {}
    return {
        "least_spread_mm": Fact(
            spot.value, "least margin of the wall against undercut", place=spot.place
        )
    }


def largest_roller(cam: RollerCam) -> Fact | None:
    """Return the largest roller of a `cam` without undercut; None if there is no limit."""
    spot = cam.largest_roller
    if math.isinf(spot.value):
        return None
    value = spot.value - 0.5 * cam.clearance
    return Fact(value, "largest roller radius without undercut", place=spot.place)


def solid_facts(result: GriddedCam) -> Tree | None:
    """Return volume and mass of a `result`, where files or a density ask for them."""
    density = result.design.blank.density
    if not result.weighed:
        return None
    volume = result.mesh.volume
    return {
        "volume_mm3": volume,
        "triangles": len(result.mesh.triangles),
        "mass_kg": None if density is None else Fact(1e-9 * density * volume, "mass", shown=True),
    }


GridPart = tuple["RollerWall", dict[str, "Array"], "RollerContact", "Mask"]
"""A wall, columns of its n cam angles, its grid of (n, k) points, and which of these count."""


def wall_bytes(parts: Iterable[GridPart], hand: float) -> bytes:
    """Write the table of walls.

    Parameters
    ----------
    parts : iterable of GridPart
        The walls.
    hand : float
        What y is multiplied by.

    Returns
    -------
    bytes
        CSV: the wall, the given columns, place along the roller, points, normals into the
        metal, and pressure angle.
    """
    from gearcam.export.table import table_bytes

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
    columns = {name: np.concatenate([one[name] for one in found]) for name in found[0]}
    return table_bytes(columns, {axis: f"{axis}_mm" for axis in "XYZ"})


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


def _sheets(kind: str, result: GriddedCam, _: Any) -> Files:
    from gearcam.export.dxf import DxfStyle
    from gearcam.results.parts import sheet_files

    return sheet_files(kind, result.sheets, result.design.name, DxfStyle(tolerance=FINE))


def _sheet_files(kind: str) -> FileMaker:
    """Return what makes the workshop drawing of a cam in space in a format."""
    maker = partial(_sheets, kind)
    maker.__doc__ = f"""Return the workshop drawing.

    Files: cam_drawing.{kind}.

    Face, section, the outside unrolled with the middle line of the groove, dimensions and tables.
    """
    return maker


SOLIDS: Final[Mapping[str, Callable[..., Files]]] = {
    **{kind: _mesh_files(kind) for kind in MESHES},
    **{name: _sheet_files(name.removeprefix("drawing-")) for name in DRAWINGS},
}
"""What makes solid and drawing, by format."""
