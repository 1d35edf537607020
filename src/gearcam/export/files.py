"""Files that all types of design have in common: their names, options and measured errors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gearcam.export.dxf import DxfStyle
    from gearcam.parts.body import Part
    from gearcam.parts.solids import Mesh
    from gearcam.pictures.drawings import Drawing, Placement
    from gearcam.sheets.sheet import Sheet

Files = dict[str, bytes]
"""Contents by file name."""

STEP_PART = 2e-3
"""Tolerance of STEP surfaces over that of the outlines: their volumes are then good to 1e-6."""


CHORD_HOW = (
    "largest distance of the curve from a chord: measured at 13 places, or, "
    "where the curvature hardly changes, from the tangents at its ends"
)
"""Method of a sampler's chord error."""


def accuracy(
    rows: Mapping[str, tuple[float, str]], chord: float, kerf: float, measured: Mapping[str, Any]
) -> dict[str, Any]:
    """Return error estimates, each with its method.

    Parameters
    ----------
    rows : mapping of str to (float, str)
        Errors and methods of the type of design, by name.
    chord : float, mm
        Chord error of the outlines.
    kerf : float, mm
        Width of the cut, by half of which cutting paths are offset.
    measured : mapping
        Measurements of exporters: ``dxf``.

    Returns
    -------
    dict
        Facts, with ``how`` for each.
    """
    rows = {**rows, "chord_mm": (chord, CHORD_HOW)}
    made: dict[str, Any] = {name: float(value) for name, (value, _) in rows.items()}
    how = {name: words for name, (_, words) in rows.items()}
    dxf = measured.get("dxf")
    if dxf is not None:
        made["dxf_mm"] = dxf["error_mm"]
        what = "the edge, or its parallel at half the kerf" if kerf else "the curve"
        how["dxf_mm"] = f"files read back ({dxf['curves']}), against {what}, both ways"
    return {**made, "how": how}


def sheet_files(sheets: Sequence[Sheet], style: DxfStyle, ending: str) -> Files:
    """Return workshop drawings as files.

    Parameters
    ----------
    sheets : sequence of Sheet
        The drawings.
    style : DxfStyle
        Options of DXF.
    ending : {"svg", "dxf"}
        File type.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    from gearcam.export.sheet_dxf import sheet_dxf
    from gearcam.export.sheet_svg import sheet_svg

    return {
        f"{one.name}_drawing.{ending}": sheet_svg(one) if ending == "svg" else sheet_dxf(one, style)
        for one in sheets
    }


def dxf_style(output: Any, tolerance: float) -> DxfStyle:
    """Return the options of DXF.

    Parameters
    ----------
    output : OutputSpec
        Output settings of the design.
    tolerance : float, mm
        Tolerance of the outlines.

    Returns
    -------
    DxfStyle
    """
    from gearcam.export.dxf import DxfStyle

    version = output.dxf_version or ("R12" if output.dxf_curves == "lines" else "R2010")
    return DxfStyle(tolerance=tolerance, curves=output.dxf_curves, version=version)


def drawn(drawings: Sequence[Drawing], style: DxfStyle, measured: dict[str, Any]) -> Files:
    """Return drawings as DXF files, each read back and measured.

    Parameters
    ----------
    drawings : sequence of Drawing
        Each becomes a file of its name.
    style : DxfStyle
        Options of DXF.
    measured : dict
        Receives the measured errors.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    from gearcam.export.dxf import dxf_bytes
    from gearcam.export.dxf_read import Known, measure_dxf

    files: Files = {}
    outlines: Known = {}
    known = measured.setdefault(
        "dxf", {"curves": style.curves, "version": style.version, "error_mm": {}}
    )
    for drawing in drawings:
        name = f"{drawing.name}.dxf"
        files[name] = dxf_bytes(drawing, style)
        if drawing.contours:
            known["error_mm"][name] = measure_dxf(files[name], drawing.contours, outlines)
    return files


def cut_files(drawings: Sequence[Drawing], title: str, kerf: float) -> Files:
    """Return files for a laser: one for each part, and a sheet with all of them, labelled.

    Parameters
    ----------
    drawings : sequence of Drawing
        Drawings to cut.
    title : str
        The design's name.
    kerf : float, mm
        Width of the cut, by half of which their paths have been offset.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    from gearcam.export.cut_svg import cut_svg
    from gearcam.export.lettering import labelled
    from gearcam.export.nest import nested

    files = {
        f"{one.name}_cut.svg": cut_svg([one], f"{title}, {one.name}", kerf) for one in drawings
    }
    sheet = nested([labelled(one) for one in drawings])
    return files | {"cut.svg": cut_svg(sheet, title, kerf)}


def mesh_files(
    parts: Sequence[Part],
    solids: Mapping[str, Mesh],
    together: Mapping[str, dict[str, Mesh]],
    kind: str,
    measured: dict[str, Any],
) -> Files:
    """Return solids as files: one for each part, and one for each assembly.

    Parameters
    ----------
    parts : sequence of Part
        The finished parts.
    solids : mapping of str to Mesh
        Meshes by the parts' names.
    together : mapping of str to dict
        Placed solids of assemblies, by the stems of their files.
    kind : {"stl", "3mf", "glb"}
        The format.
    measured : dict
        Receives the measurements of the solids.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    from gearcam.export.mesh import glb_bytes, stl_bytes, threemf_bytes
    from gearcam.parts.solids import volume_error

    measured["solids"] = {
        part.name: {
            "volume_mm3": solids[part.name].volume,
            "volume_error_mm3": volume_error(part),
            "triangles": len(solids[part.name].triangles),
        }
        for part in parts
    }
    to_bytes = {"stl": stl_bytes, "3mf": threemf_bytes, "glb": glb_bytes}[kind]
    scenes = {**{name: {name: mesh} for name, mesh in solids.items()}, **together}
    return {f"{stem}.{kind}": to_bytes(scene, stem) for stem, scene in scenes.items()}


def step_files(
    parts: Sequence[Part],
    tolerance: float,
    assembly: str = "",
    placements: Sequence[Placement] = (),
    heights: Sequence[float] = (),
) -> Files:
    """Return parts as STEP files: one for each, and one for their assembly.

    Parameters
    ----------
    parts : sequence of Part
        The finished parts.
    tolerance : float, mm
        Tolerance of the outlines.
    assembly : str
        Stem of the assembly's file; empty without one.
    placements : sequence of Placement
        Of the parts in the assembly; by default they are not moved.
    heights : sequence of float, mm
        Of the parts in the assembly; 0 by default.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    from gearcam.export.step import step_bytes
    from gearcam.pictures.drawings import UNMOVED

    close = STEP_PART * tolerance
    made: dict[Part, Any] = {}
    files = {
        f"{part.name}.step": step_bytes([(part, UNMOVED)], part.name, close, made) for part in parts
    }
    if assembly:
        placed = list(zip(parts, placements or [UNMOVED] * len(parts), strict=True))
        files[f"{assembly}.step"] = step_bytes(placed, assembly, close, made, heights)
    return files
