"""From a job to the contents of its files: one function a kind of file."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcam.jobs.exports import STEP_PART, cut_files, drawn, dxf_style, mesh_bytes, meshes
from gearcam.jobs.sheet_files import sheet_files

if TYPE_CHECKING:
    from gearcam.drawings import Drawing, Pose
    from gearcam.export.dxf import DxfStyle
    from gearcam.jobs.gear_pair import GearPairJob

PAIR = "pair"
"""Stem of the files of the assembled pair."""


def export(job: GearPairJob, kind: str, extras: dict[str, Any]) -> dict[str, bytes]:
    """Make the files of one kind.

    Parameters
    ----------
    job : GearPairJob
        The design, computed as far as the kind needs.
    kind : str
        One of the formats of a gear pair.
    extras : dict
        What is measured on the files is written in here, for the summary.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    makers: dict[str, Callable[[], dict[str, bytes]]] = {
        "csv": lambda: _tables(job),
        "dxf": lambda: drawn([*job.to_cut, _pair_drawing(job)], _style(job), extras),
        "cut-svg": lambda: cut_files(job.to_cut, job.design.name, job.design.output.kerf),
        "svg": lambda: _picture(job),
        "step": lambda: _steps(job),
        "drawing-dxf": lambda: sheet_files(job, _pair_drawing(job), _style(job), "dxf"),
        "drawing-svg": lambda: sheet_files(job, _pair_drawing(job), _style(job), "svg"),
        "inspection": lambda: _inspection(job),
    }
    return makers[kind]() if kind in makers else _meshes(job, kind, extras)


def _tables(job: GearPairJob) -> dict[str, bytes]:
    from gearcam.export.table import outline_bytes, table_bytes

    phi1 = job.centrode_angles()
    (ratio,), phi2 = job.law.derivatives(phi1, 0), job.law.phi2(phi1)
    one, two = (track.frames(phi1) for track in job.pair.rolling.tracks)
    with np.errstate(divide="ignore"):
        rho1, rho2 = 1.0 / one.kappa, 1.0 / two.kappa
    driven = {
        "phi2_deg": np.degrees(phi2 - phi2[0]),
        "ratio": ratio,
        "r1_mm": np.abs(one.p),
        "r2_mm": np.abs(two.p),
    }
    if job.pair.on_rack:
        driven = {"way_mm": two.p.imag, "r1_mm": np.abs(one.p)}
    centrodes = {
        "phi1_deg": np.degrees(phi1),
        **driven,
        "s_mm": one.s - one.s[0],
        "rho1_mm": rho1,
        "rho2_mm": rho2,
    }
    files = {f"{gear.name}_outline.csv": outline_bytes(gear.outline) for gear in job.gears}
    return files | {"centrodes.csv": table_bytes(centrodes)}


def _pair_drawing(job: GearPairJob) -> Drawing:
    from gearcam.drawings import pair_drawing

    lobes = job.law.lobes
    ends = [lobes.n1 * lobes.period, lobes.n2 * lobes.period]
    if job.pair.on_rack:
        ends[1] = job.centrode_angles()[-1]
    centrodes = [
        gear.centrode(np.linspace(0.0, end, 721)[: -1 if gear.toothing.closed else None])
        for gear, end in zip(job.gears, ends, strict=True)
    ]
    closed = job.gear1.toothing.closed, job.gear2.toothing.closed
    return pair_drawing(
        job.parts, job.pair.shift, centrodes, name=PAIR, closed=closed, poses=poses(job)
    )


def poses(job: GearPairJob) -> tuple[Pose, Pose]:
    """Return how the wheels of a `job` stand when assembled: wheel 1 turned by -phi1."""
    phi1 = job.design.output.pose
    phi2 = float(job.law.phi2(np.array(phi1)))
    if job.pair.on_rack:
        return (-phi1, (0.0, 0.0)), (0.0, (0.0, -job.pair.center_distance * phi2))
    return (-phi1, (0.0, 0.0)), (phi2, (job.pair.shift, 0.0))


def _style(job: GearPairJob) -> DxfStyle:
    return dxf_style(job.design.output, job.gear1.profile.tolerance)


def _picture(job: GearPairJob) -> dict[str, bytes]:
    from gearcam.export.svg import pair_notes, svg_bytes

    pair = job.pair
    notes = pair_notes(pair.shift, pair.module, pair.teeth)
    return {"pair.svg": svg_bytes(_pair_drawing(job), title=job.design.name, notes=notes)}


def _inspection(job: GearPairJob) -> dict[str, bytes]:
    from gearcam.export.table import table_bytes
    from gearcam.jobs.ordered import inspection_rows

    return {"inspection.csv": table_bytes(inspection_rows(job))}


def _steps(job: GearPairJob) -> dict[str, bytes]:
    from gearcam.export.step import Placed, step_bytes

    tolerance = STEP_PART * job.gear1.profile.tolerance
    files = {
        f"{part.name}.step": step_bytes([Placed(part=part)], part.name, tolerance)
        for part in job.parts
    }
    placed = [
        Placed(part=part, angle=angle, offset=offset)
        for part, (angle, offset) in zip(job.parts, poses(job), strict=True)
    ]
    return files | {f"{PAIR}.step": step_bytes(placed, PAIR, tolerance)}


def _meshes(job: GearPairJob, kind: str, extras: dict[str, Any]) -> dict[str, bytes]:
    solids = meshes(job.parts, extras)
    files = {
        f"{name}.{kind}": mesh_bytes({name: mesh}, kind, name) for name, mesh in solids.items()
    }
    placed = {
        name: mesh.placed(*pose)
        for (name, mesh), pose in zip(solids.items(), poses(job), strict=True)
    }
    return files | {f"{PAIR}.{kind}": mesh_bytes(placed, kind, PAIR)}
