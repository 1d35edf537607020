"""From the result of a cam to the contents of its files: one function a kind of file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.errors import InfeasibleError
from gearcam.export.shared import (
    STEP_PART,
    Files,
    cut_files,
    drawn,
    dxf_style,
    mesh_bytes,
    meshes,
    sheet_bytes,
    sheet_rows,
)
from gearcam.kinds.cam.design import STEM

if TYPE_CHECKING:
    from gearcam.drawings import Drawing, Shape
    from gearcam.kinds.cam.build import CamResult

Measured = dict[str, Any]

TOOL_PATH: Final = "tool_path"
"""Stem of the files of a cutter's way."""

_ROWS: Final = (
    "cam.follower", "cam.roller_radius_mm", "cam.dome_radius_mm", "cam.pivot_distance_mm",
    "cam.arm_mm", "cam.face_offset_mm", "cam.offset_mm", "motion.total_lift",
    "cam.prime_radius_mm", "cam.base_radius_mm", "cam.rotation", "cam.pressure_angle_deg.rise_max",
    "cam.pressure_angle_deg.return_max", "cam.profile.clearance_mm", "part.density_kg_m3",
    "part.mass.mass_kg", "part.mass.centroid_mm", "part.mass.unbalance_g_mm",
)  # fmt: skip
"""Facts that stand in the table of the drawing."""

_SHORT: Final = {"lift": "s", "velocity": "ds", "acceleration": "d2s", "jerk": "d3s"}
"""What the file calls the lift and its derivatives, by the first words of their columns."""

_STUDY: Final = (90, 180, 360, 720, 1440, 2880, 5760)
"""Points of a turn whose three-point curvature is held against the exact one."""


def _dxf(result: CamResult, measured: Measured) -> Files:
    return drawn([_cut(result)], _style(result), measured)


def _cut_svg(result: CamResult, _: Measured) -> Files:
    return cut_files([_cut(result)], result.design.name, result.design.output.kerf)


def _mesh(kind: str, result: CamResult, measured: Measured) -> Files:
    return {f"{STEM}.{kind}": mesh_bytes(meshes([result.part], measured), kind, STEM)}


def _tables(result: CamResult, _: Measured) -> Files:
    from gearcam.export.table import outline_bytes, table_bytes

    columns = {
        _SHORT.get(name.partition("_")[0], name): values for name, values in result.motion().items()
    }
    return {
        "profile.csv": outline_bytes(result.contour.vertices),
        "motion.csv": table_bytes(columns),
    }


def _style(result: CamResult) -> Any:
    return dxf_style(result.design.output, result.profile.tolerance)


def _drawing(result: CamResult, *, assembled: bool = False) -> Drawing:
    from gearcam.drawings import cam_drawing

    design, cam = result.design, result.cam
    pitch = None if cam.pitch_contour is result.part.contour else cam.pitch_contour
    prime, side = cam.mechanism.least, -1.0 if design.cam.clockwise else 1.0
    if not assembled:
        return cam_drawing(result.part, pitch, prime)
    pose = design.output.pose
    return cam_drawing(result.part, pitch, prime, _follower(result, pose), angle=side * pose)


def _cut(result: CamResult) -> Drawing:
    """Return what a cutter follows: the part, or paths with the kerf."""
    from gearcam.drawings import cut_drawing

    return cut_drawing(_drawing(result), result.design.output.kerf)


def _follower(result: CamResult, theta: float) -> list[Shape]:
    """Return the follower as it stands at a cam angle."""
    from gearcam.drawings import Circle, Path

    cam, m = result.cam, result.mechanism
    side = -1.0 if result.design.cam.clockwise else 1.0
    position = m.start + float(cam.program.derivatives(theta, 0)[0])
    reach = 1.2 * float(np.hypot(*result.profile.vertices.T).max())

    def path(*points: complex) -> Path:
        return Path(points=np.array([[side * z.real, z.imag] for z in points]), closed=False)

    if m.flat and m.oscillating:
        along = np.exp(-1j * position)
        foot = m.pivot - m.face_offset * 1j * along
        return [
            path(complex(m.pivot), complex(foot), complex(foot - along * (m.pivot + 0.4 * reach)))
        ]
    if m.flat:
        found = cam.contact_place
        wide = 0.2 * reach + (found.largest if found is not None else 0.0)
        stem = complex(m.offset, position), complex(m.offset, position + 0.5 * reach)
        return [path(complex(-wide, position), complex(wide, position)), path(*stem)]
    if m.oscillating:
        center = complex(m.pivot - m.arm * np.exp(-1j * position))
        line = path(complex(m.pivot), center)
    else:
        center = complex(m.offset, position)
        line = path(center, center + 0.5j * reach)
    if m.radius == 0.0:
        return [line]
    middle = np.array([side * center.real, center.imag])
    return [Circle(center=middle, diameter=2.0 * m.radius), line]


def _picture(result: CamResult, _: Measured) -> Files:
    from gearcam.export.svg import svg_bytes

    drawing = _drawing(result, assembled=True)
    notes = result.facts.headline
    return {f"{STEM}.svg": svg_bytes(drawing, title=result.design.name, notes=notes)}


def _step(result: CamResult, _: Measured) -> Files:
    from gearcam.drawings import UNMOVED
    from gearcam.export.step import step_bytes

    tolerance = STEP_PART * result.profile.tolerance
    return {f"{STEM}.step": step_bytes([(result.part, UNMOVED)], STEM, tolerance)}


def _sheet(ending: str, result: CamResult, _: Measured) -> Files:
    from gearcam.sheets import wheel_sheet

    other = "prime" if result.mechanism.flat else "base"
    names = [name for name in _ROWS if name != f"cam.{other}_radius_mm"]
    sheet = wheel_sheet(result.part, sheet_rows(result.facts, names), result.design.name)
    return sheet_bytes(sheet, _style(result), ending)


def _inspection(result: CamResult, _: Measured) -> Files:
    from gearcam.export.table import table_bytes

    theta, points, normals = result.cam.places(result.design.output.inspection_points)
    clearance = result.design.blank.clearance
    if clearance:
        from gearcam.parts.parallel import touches

        kept = touches(result.profile, points, normals, -clearance)
        theta, points, normals = theta[kept], points[kept], normals[kept]
        points = points - clearance * normals
    columns = {
        "theta_deg": np.degrees(theta),
        "x_mm": points.real,
        "y_mm": points.imag,
        "nx": normals.real,
        "ny": normals.imag,
    }
    return {"inspection.csv": table_bytes(columns)}


def _tool_path(result: CamResult, measured: Measured) -> Files:
    from gearcam.drawings import TOOL, Drawing, Feature
    from gearcam.export.table import outline_bytes
    from gearcam.parts.parallel import moved, sized

    radius = result.design.output.tool_radius or result.mechanism.radius
    if not radius:
        raise InfeasibleError(
            "the way of a cutter needs its radius",
            where="output.tool_radius_mm",
            nearest="a round follower's own radius counts where none is given; this one has none",
        )
    contour = result.part.contour
    path = sized(
        lambda size: moved(contour, size), radius, "output.tool_radius_mm", "radius of the cutter"
    )
    drawing = Drawing(name=TOOL_PATH, features=(Feature(layer=TOOL, shape=path),))
    tables = {f"{TOOL_PATH}.csv": outline_bytes(path.vertices)}
    return tables | drawn([drawing], _style(result), measured)


def _curvature(result: CamResult, measured: Measured) -> Files:
    from gearcam.export.table import table_bytes
    from gearcam.kinds.cam.curvature import curvature_columns

    columns, measured["curvature"] = curvature_columns(result.cam, _STUDY)
    return {"curvature.csv": table_bytes(columns)}


FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "csv": _tables,
    "dxf": _dxf,
    "cut-svg": _cut_svg,
    "svg": _picture,
    **{kind: partial(_mesh, kind) for kind in ("stl", "3mf", "glb")},
    "step": _step,
    "drawing-dxf": partial(_sheet, "dxf"),
    "drawing-svg": partial(_sheet, "svg"),
    "inspection": _inspection,
    "tool-path": _tool_path,
    "curvature": _curvature,
}
"""What makes each kind of file: contents by name; what is measured on them is written down."""
