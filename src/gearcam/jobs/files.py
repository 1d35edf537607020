"""From a job to the contents of its files: one function a kind of file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from gearcam.drawings import Drawing
    from gearcam.jobs.gear_pair import GearPairJob


def export(job: GearPairJob, kind: str, extras: dict[str, Any]) -> dict[str, bytes]:
    """Make the files of one kind.

    Parameters
    ----------
    job : GearPairJob
        The design, computed as far as the kind needs.
    kind : str
        ``csv``, ``dxf``, ``svg``, ``stl``, ``3mf`` or ``glb``.
    extras : dict
        What is measured on the files is written in here, for the summary.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    if kind == "csv":
        return _tables(job)
    if kind == "dxf":
        return _drawings(job, extras)
    if kind == "svg":
        return _picture(job)
    return _meshes(job, kind, extras)


def _tables(job: GearPairJob) -> dict[str, bytes]:
    from gearcam.export.table import outline_bytes, table_bytes

    phi1 = job.centrode_angles()
    rolling = job.pair.rolling
    (ratio,), phi2 = job.law.derivatives(phi1, 0), job.law.phi2(phi1)
    one, two = rolling.frames(1, phi1), rolling.frames(2, phi1)
    with np.errstate(divide="ignore"):
        rho1, rho2 = 1.0 / one.kappa, 1.0 / two.kappa
    driven = {
        "phi2_deg": np.degrees(phi2 - phi2[0]),
        "ratio": ratio,
        "r1_mm": np.abs(one.p),
        "r2_mm": np.abs(two.p),
    }
    if job.law.feeds:
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
    if job.law.feeds:
        ends[1] = job.centrode_angles()[-1]
    centrodes = [
        gear.centrode(np.linspace(0.0, end, 721)[: -1 if gear.toothing.closed else None])
        for gear, end in zip(job.gears, ends, strict=True)
    ]
    closed = job.gear1.toothing.closed, job.gear2.toothing.closed
    return pair_drawing(job.parts, job.pair.shift, centrodes, closed=closed)


def _drawings(job: GearPairJob, extras: dict[str, Any]) -> dict[str, bytes]:
    from gearcam.drawings import wheel_drawing
    from gearcam.export.dxf import dxf_bytes, measure_dxf

    files: dict[str, bytes] = {}
    errors: dict[str, float] = {}
    drawings = {f"{part.name}.dxf": wheel_drawing(part) for part in job.parts}
    for name, drawing in {**drawings, "pair.dxf": _pair_drawing(job)}.items():
        tolerance = job.gear1.profile.tolerance
        files[name] = dxf_bytes(drawing, tolerance, job.design.output.dxf_curves)
        errors[name] = measure_dxf(files[name], drawing.contours)
    extras["dxf"] = {"curves": job.design.output.dxf_curves, "error_mm": errors}
    return files


def _picture(job: GearPairJob) -> dict[str, bytes]:
    from gearcam.export.svg import pair_notes, svg_bytes

    pair = job.pair
    notes = pair_notes(pair.shift, pair.module, pair.teeth)
    return {"pair.svg": svg_bytes(_pair_drawing(job), title=job.design.name, notes=notes)}


def _meshes(job: GearPairJob, kind: str, extras: dict[str, Any]) -> dict[str, bytes]:
    from gearcam.export.mesh import glb_bytes, stl_bytes, threemf_bytes
    from gearcam.solids import solid, volume_error

    write = {"stl": stl_bytes, "3mf": threemf_bytes, "glb": glb_bytes}[kind]
    solids = extras.setdefault("_solids", {})
    files: dict[str, bytes] = {}
    for part in job.parts:
        if part.name not in solids:
            solids[part.name] = solid(part)
            extras.setdefault("solids", {})[part.name] = {
                "volume_mm3": solids[part.name].volume,
                "volume_error_mm3": volume_error(part),
                "triangles": len(solids[part.name].triangles),
            }
        files[f"{part.name}.{kind}"] = write(solids[part.name], part.name)
    return files
