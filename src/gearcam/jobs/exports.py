"""Files that every kind of design has: how DXF is written, and meshes of parts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gearcam.drawings import Drawing
    from gearcam.export.dxf import DxfStyle
    from gearcam.parts.body import Part
    from gearcam.solids import Mesh

STEP_PART = 2e-3
"""Tolerance of STEP surfaces over that of the outlines: their volumes are then good to 1e-6."""


def dxf_style(output: Any, tolerance: float) -> DxfStyle:
    """Return how DXF is written.

    Parameters
    ----------
    output : OutputSpec or CamOutputSpec
        What a design says of its files.
    tolerance : float, mm
        Of the outlines.

    Returns
    -------
    DxfStyle
    """
    from gearcam.export.dxf import DxfStyle

    version = output.dxf_version or ("R12" if output.dxf_curves == "lines" else "R2010")
    return DxfStyle(tolerance=tolerance, curves=output.dxf_curves, version=version)


def drawn(drawings: Sequence[Drawing], style: DxfStyle, extras: dict[str, Any]) -> dict[str, bytes]:
    """Return drawings as DXF files, each read back and measured.

    Parameters
    ----------
    drawings : sequence of Drawing
        Each a file of its name.
    style : DxfStyle
        How.
    extras : dict
        The measured errors are written in here.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    from gearcam.export.dxf import dxf_bytes
    from gearcam.export.dxf_read import measure_dxf

    files: dict[str, bytes] = {}
    known = extras.setdefault(
        "dxf", {"curves": style.curves, "version": style.version, "error_mm": {}}
    )
    for drawing in drawings:
        name = f"{drawing.name}.dxf"
        files[name] = dxf_bytes(drawing, style)
        known["error_mm"][name] = measure_dxf(files[name], drawing.contours)
    return files


def cut_files(drawings: Sequence[Drawing], title: str, kerf: float) -> dict[str, bytes]:
    """Return the files of a laser: one for each part, and a sheet with all of them, labelled.

    Parameters
    ----------
    drawings : sequence of Drawing
        What is cut.
    title : str
        The design's name.
    kerf : float, mm
        By half of which their paths have been moved.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    from gearcam.export.cut_svg import cut_svg
    from gearcam.export.nest import labelled, nested

    files = {
        f"{one.name}_cut.svg": cut_svg([one], f"{title}, {one.name}", kerf) for one in drawings
    }
    sheet = nested([labelled(one) for one in drawings])
    return files | {"cut.svg": cut_svg(sheet, title, kerf)}


def meshes(parts: Sequence[Part], extras: dict[str, Any]) -> dict[str, Mesh]:
    """Return the solids of parts, made once for all kinds of files.

    Parameters
    ----------
    parts : sequence of Part
        As made.
    extras : dict
        Keeps them, and what was measured on them.

    Returns
    -------
    dict of str to Mesh
        By the parts' names.
    """
    from gearcam.solids import solid, volume_error

    solids = extras.setdefault("_solids", {})
    for part in parts:
        if part.name not in solids:
            solids[part.name] = solid(part)
            extras.setdefault("solids", {})[part.name] = {
                "volume_mm3": solids[part.name].volume,
                "volume_error_mm3": volume_error(part),
                "triangles": len(solids[part.name].triangles),
            }
    return solids


def mesh_bytes(named: dict[str, Mesh], kind: str, title: str) -> bytes:
    """Return meshes as a file.

    Parameters
    ----------
    named : dict of str to Mesh
        By name.
    kind : {"stl", "3mf", "glb"}
        The format.
    title : str
        Of the scene.

    Returns
    -------
    bytes
    """
    from gearcam.export.mesh import glb_bytes, stl_bytes, threemf_bytes

    return {"stl": stl_bytes, "3mf": threemf_bytes, "glb": glb_bytes}[kind](named, title)
