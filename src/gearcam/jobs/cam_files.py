"""From the job of a cam to the contents of its files: one function a kind of file."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcam.errors import InfeasibleError
from gearcam.jobs.cam import NAME
from gearcam.jobs.exports import STEP_PART, cut_files, drawn, dxf_style, mesh_bytes, meshes

if TYPE_CHECKING:
    from gearcam.drawings import Drawing, Shape
    from gearcam.jobs.cam import CamJob

TOOL_PATH = "tool_path"
"""Stem of the files of a cutter's way."""

_STUDY = (90, 180, 360, 720, 1440, 2880, 5760)
"""Points of a turn whose three-point curvature is held against the exact one."""


def export(job: CamJob, kind: str, extras: dict[str, Any]) -> dict[str, bytes]:
    """Make the files of one kind.

    Parameters
    ----------
    job : CamJob
        The design, computed as far as the kind needs.
    kind : str
        One of the cam's kinds of files.
    extras : dict
        What is measured on the files is written in here, for the summary.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    makers: dict[str, Callable[[], dict[str, bytes]]] = {
        "csv": lambda: _tables(job),
        "dxf": lambda: drawn([_cut(job)], _style(job), extras),
        "cut-svg": lambda: cut_files([_cut(job)], job.design.name, job.design.output.kerf),
        "svg": lambda: _picture(job),
        "step": lambda: _step(job),
        "drawing-dxf": lambda: _sheet(job, "dxf"),
        "drawing-svg": lambda: _sheet(job, "svg"),
        "inspection": lambda: _inspection(job),
        "tool-path": lambda: _tool_path(job, extras),
        "curvature": lambda: _curvature(job, extras),
    }
    if kind in makers:
        return makers[kind]()
    return {f"{NAME}.{kind}": mesh_bytes(meshes([job.part], extras), kind, NAME)}


def cam_angles(job: CamJob) -> Any:
    """Return the cam angles of tables, (n,) rad: a turn in steps of the design, both ends."""
    step = job.design.output.motion_step
    count = math.floor(2.0 * math.pi / step + 1e-9)
    return np.arange(count + 1) * step


def _tables(job: CamJob) -> dict[str, bytes]:
    from gearcam.export.table import outline_bytes, table_bytes

    theta = cam_angles(job)
    found = job.cam.motion(theta)
    scale = math.degrees(1.0) if job.design.follower.oscillating else 1.0
    columns = {"theta_deg": np.degrees(theta)}
    columns |= {name: scale * found[name] for name in ("s", "ds", "d2s", "d3s")}
    columns |= {
        "pressure_angle_deg": np.degrees(found["pressure"]),
        "rho_pitch_mm": found["rho_pitch"],
        "rho_profile_mm": found["rho_profile"],
    }
    return {
        "profile.csv": outline_bytes(job.contour.vertices),
        "motion.csv": table_bytes(columns),
    }


def _style(job: CamJob) -> Any:
    return dxf_style(job.design.output, job.profile.tolerance)


def _drawing(job: CamJob, *, assembled: bool = False) -> Drawing:
    from gearcam.drawings import cam_drawing

    design, cam = job.design, job.cam
    pitch = None if cam.pitch_contour is job.part.contour else cam.pitch_contour
    prime, side = cam.mechanism.least, -1.0 if design.cam.clockwise else 1.0
    if not assembled:
        return cam_drawing(job.part, pitch, prime)
    pose = design.output.pose
    return cam_drawing(job.part, pitch, prime, _follower(job, pose), angle=side * pose)


def _cut(job: CamJob) -> Drawing:
    """Return what a cutter follows: the part, or paths with the kerf."""
    from gearcam.drawings import cut_drawing

    return cut_drawing(_drawing(job), job.design.output.kerf)


def _follower(job: CamJob, theta: float) -> list[Shape]:
    """Return the follower as it stands at a cam angle."""
    from gearcam.drawings import Circle, Path

    cam, m = job.cam, job.mechanism
    side = -1.0 if job.design.cam.clockwise else 1.0
    position = m.start + float(cam.program.derivatives(theta, 0)[0])
    reach = 1.2 * float(np.hypot(*job.profile.vertices.T).max())

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


def _picture(job: CamJob) -> dict[str, bytes]:
    from gearcam.export.svg import svg_bytes

    low, high = job.program.range
    swings = job.design.follower.oscillating
    lift = f"{math.degrees(high - low):.6g} deg" if swings else f"{high - low:.6g} mm"
    notes = [
        f"{job.design.follower.motion} {job.design.follower.type} follower",
        f"lift {lift}",
        f"{'base' if job.mechanism.flat else 'prime'} radius {job.mechanism.least:.6g} mm",
    ]
    drawing = _drawing(job, assembled=True)
    return {f"{NAME}.svg": svg_bytes(drawing, title=job.design.name, notes=notes)}


def _step(job: CamJob) -> dict[str, bytes]:
    from gearcam.export.step import Placed, step_bytes

    tolerance = STEP_PART * job.profile.tolerance
    return {f"{NAME}.step": step_bytes([Placed(part=job.part)], NAME, tolerance)}


def _sheet(job: CamJob, ending: str) -> dict[str, bytes]:
    from gearcam.export.sheet_dxf import sheet_dxf
    from gearcam.export.sheet_svg import sheet_svg
    from gearcam.sheets import wheel_sheet

    sheet = wheel_sheet(job.part, _facts(job), job.design.name)
    data = sheet_svg(sheet) if ending == "svg" else sheet_dxf(sheet, _style(job))
    return {f"{NAME}_drawing.{ending}": data}


def _facts(job: CamJob) -> dict[str, str]:
    """Return the rows of the table of the cam's sheet."""
    from gearcam.jobs.sheet_files import weight_facts

    design, m, cam = job.design, job.mechanism, job.cam
    low, high = job.program.range
    facts = {"follower": f"{design.follower.motion} {design.follower.type}"}
    if m.radius:
        facts["follower radius"] = f"{m.radius:.6g} mm"
    if m.oscillating:
        facts["pivot distance"] = f"{m.pivot:.6g} mm"
        facts |= {"arm": f"{m.arm:.6g} mm"} if m.arm else {}
        facts |= {"face offset": f"{m.face_offset:.6g} mm"} if m.face_offset else {}
        facts["lift"] = f"{math.degrees(high - low):.6g} deg"
    else:
        facts["offset"] = f"{m.offset:.6g} mm"
        facts["lift"] = f"{high - low:.6g} mm"
    facts["base radius" if m.flat else "prime radius"] = f"{m.least:.6g} mm"
    facts["cam turns"] = design.cam.rotation
    for kind in ("rise", "return"):
        found = cam.pressure(kind)
        if found is not None:
            facts[f"pressure, {kind}"] = f"{math.degrees(found.largest):.4g} deg"
    if design.blank.clearance:
        facts["clearance"] = f"{design.blank.clearance:.6g} mm"
    return facts | weight_facts(job.part, design.blank)


def _inspection(job: CamJob) -> dict[str, bytes]:
    from gearcam.export.table import table_bytes

    theta, points, normals = job.cam.places(job.design.output.inspection_points)
    clearance = job.design.blank.clearance
    if clearance:
        from gearcam.parts.parallel import touches

        kept = touches(job.profile, points, normals, -clearance)
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


def _tool_path(job: CamJob, extras: dict[str, Any]) -> dict[str, bytes]:
    from gearcam.drawings import TOOL, Drawing, Feature
    from gearcam.export.table import outline_bytes
    from gearcam.parts.parallel import moved, sized

    radius = job.design.output.tool_radius or job.mechanism.radius
    if not radius:
        raise InfeasibleError(
            "the way of a cutter needs its radius",
            where="output.tool_radius_mm",
            nearest="a round follower's own radius counts where none is given; this one has none",
        )
    contour = job.part.contour
    path = sized(
        lambda size: moved(contour, size), radius, "output.tool_radius_mm", "radius of the cutter"
    )
    drawing = Drawing(name=TOOL_PATH, features=(Feature(layer=TOOL, shape=path),))
    tables = {f"{TOOL_PATH}.csv": outline_bytes(path.vertices)}
    return tables | drawn([drawing], _style(job), extras)


def _curvature(job: CamJob, extras: dict[str, Any]) -> dict[str, bytes]:
    from gearcam.export.table import table_bytes
    from gearcam.jobs.curvature import curvature_columns

    columns, extras["curvature"] = curvature_columns(job.cam, _STUDY)
    return {"curvature.csv": table_bytes(columns)}
