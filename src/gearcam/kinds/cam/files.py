"""From the result of a cam to the contents of its files: one function a kind of file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from gearcam.export.shared import (
    STEP_PART,
    FileFormat,
    Files,
    cut_files,
    drawn,
    dxf_style,
    mesh_files,
    sheet_files,
)
from gearcam.report.file import REPORT_DOC, report_files
from gearcam.report.file import framed as framed

if TYPE_CHECKING:
    from gearcam.cams.wall import Wall
    from gearcam.kinds.cam.build import CamResult
    from gearcam.numeric.arrays import Array
    from gearcam.numeric.contour import Contour
    from gearcam.parts.body import Part
    from gearcam.solids import Mesh

Measured = dict[str, Any]

_SHORT: Final = {"lift": "s", "velocity": "ds", "acceleration": "d2s", "jerk": "d3s"}
"""What the file calls the lift and its derivatives, by the first words of their columns."""

_STUDY: Final = (90, 180, 360, 720, 1440, 2880, 5760)
"""Points of a turn whose three-point curvature is held against the exact one."""


def _dxf(result: CamResult, measured: Measured) -> Files:
    """Return drawings of the parts; with a kerf cutting paths, and the parts for reference."""
    drawings = list(result.to_cut)
    if result.design.output.kerf:
        drawings += [
            replace(one, name=f"{one.name}_reference") for one in result.form.drawings(result)
        ]
    return drawn(drawings, _style(result), measured)


def _cut_svg(result: CamResult, _: Measured) -> Files:
    return cut_files(result.to_cut, result.design.name, result.design.output.kerf)


def _mesh(kind: str, result: CamResult, measured: Measured) -> Files:
    stem = result.form.assembly
    together = {stem: assembled(result)} if stem else {}
    return mesh_files(result.parts, result.meshes, together, kind, measured)


def assembled(result: CamResult) -> dict[str, Mesh]:
    """Return the solids where they stand on the shaft."""
    from gearcam.drawings import UNMOVED

    if not result.form.assembly:
        return result.meshes
    heights = zip(result.meshes.items(), result.form.heights(result), strict=True)
    return {name: mesh.placed(*UNMOVED, height) for (name, mesh), height in heights}


def _tables(result: CamResult, _: Measured) -> Files:
    from gearcam.export.table import outline_bytes, table_bytes

    columns = {
        _SHORT.get(name.partition("_")[0], name): values for name, values in result.motion().items()
    }
    walls = zip(result.cam.walls, result.contours, strict=True)
    return {
        **{_named("profile", wall): outline_bytes(made.vertices) for wall, made in walls},
        "motion.csv": table_bytes(columns),
    }


def _named(stem: str, wall: Wall) -> str:
    """Return the name of a table of a wall."""
    return f"{stem}_{wall.key}.csv" if wall.key else f"{stem}.csv"


def _style(result: CamResult) -> Any:
    return dxf_style(result.design.output, result.profile.tolerance)


def _picture(result: CamResult, _: Measured) -> Files:
    from gearcam.export.svg import svg_bytes

    notes, drawing = result.facts.headline, result.drawing
    return {f"{drawing.name}.svg": svg_bytes(drawing, title=result.design.name, notes=notes)}


def _step(result: CamResult, _: Measured) -> Files:
    from gearcam.drawings import UNMOVED
    from gearcam.export.step import step_bytes

    tolerance = STEP_PART * result.profile.tolerance
    made: dict[Part, Any] = {}
    files = {
        f"{part.name}.step": step_bytes([(part, UNMOVED)], part.name, tolerance, made)
        for part in result.parts
    }
    whole = result.form.assembly
    if whole:
        items = [(part, UNMOVED) for part in result.parts]
        heights = result.form.heights(result)
        files[f"{whole}.step"] = step_bytes(items, whole, tolerance, made, heights)
    return files


def _sheet(ending: str, result: CamResult, _: Measured) -> Files:
    return sheet_files(result.sheets, _style(result), ending)


def _inspection(result: CamResult, _: Measured) -> Files:
    from gearcam.export.table import table_bytes

    count = result.design.output.inspection_points
    walls = zip(result.cam.walls, result.profiles, strict=True)
    return {
        _named("inspection", wall): table_bytes(_inspected(result, wall, profile, count))
        for wall, profile in walls
    }


def _inspected(result: CamResult, wall: Wall, profile: Contour, count: int) -> dict[str, Array]:
    theta, points, normals = wall.places(count)
    driver = wall.mechanism.driver
    clearance = result.design.blank.clearance
    if clearance:
        from gearcam.parts.parallel import touches

        kept = touches(profile, points, normals, -clearance)
        theta, points, normals = theta[kept], points[kept], normals[kept]
        points = points - clearance * normals
    return {
        driver.column: driver.scale * theta,
        "x_mm": points.real,
        "y_mm": points.imag,
        "nx": normals.real,
        "ny": normals.imag,
    }


def _tool_path(result: CamResult, measured: Measured) -> Files:
    from gearcam.drawings import TOOL, Drawing, Feature, reach
    from gearcam.export.table import outline_bytes

    paths = result.form.paths(result, result.design.output.tool_radius)
    tables = {f"{name}.csv": outline_bytes(reach(path)) for name, path in paths.items()}
    drawings = [
        Drawing(name=name, features=(Feature(layer=TOOL, shape=path),))
        for name, path in paths.items()
    ]
    return tables | drawn(drawings, _style(result), measured)


def _curvature(result: CamResult, measured: Measured) -> Files:
    from gearcam.export.table import table_bytes
    from gearcam.kinds.cam.curvature import curvature_columns

    columns, measured["curvature"] = curvature_columns(result.cam.motions[0], _STUDY)
    return {"curvature.csv": table_bytes(columns)}


def _plates(ending: str, *, whole: bool = True) -> str:
    together = f", cams{ending}" if whole else ""
    return f"cam{ending}; of conjugate cams cam1{ending}, cam2{ending}{together}"


def _walls(stem: str, ending: str = ".csv") -> str:
    pairs = (("groove", "inner", "outer"), ("sliding groove", "lower", "upper"))
    names = [f"of a {form} {stem}_{a}{ending}, {stem}_{b}{ending}" for form, a, b in pairs]
    conjugate = f"of conjugate cams {stem}_1{ending}, {stem}_2{ending}"
    return "; ".join([f"{stem}{ending}", *names, conjugate])


_SOLIDS: Final = "closed solids in mm, of conjugate cams also both as they stand on the shaft"
_SHEETS: Final = "workshop drawings with dimensions and a table of data"


FILES: Final[Mapping[str, FileFormat]] = {
    "csv": FileFormat(
        _tables,
        _walls("profile") + "; motion.csv",
        "vertices of the profile; lift, velocity, acceleration, jerk, pressure angle and radii of"
        " curvature over the cam angle or travel",
    ),
    "dxf": FileFormat(
        _dxf,
        _plates(".dxf", whole=False) + "; with `kerf_mm` also the same names with _reference.dxf",
        "outlines in mm in the cam's frame: layers PROFILE, PITCH, PRIME, BORE, HOLE and CENTER; of"
        " a groove BLANK, OUTER and INNER, or GROOVE, instead of PROFILE. With `kerf_mm` cutting"
        " paths only, on layers that end in _KERF, and the part with its curves as the reference",
    ),
    "cut-svg": FileFormat(
        _cut_svg,
        _plates("_cut.svg", whole=False) + "; cut.svg",
        "for laser programs, 1:1 in mm: inner edges, then outlines in red; one file for each part,"
        " and cut.svg with all parts side by side and labelled",
    ),
    "svg": FileFormat(
        _picture,
        "cam.svg; of conjugate cams cams.svg",
        "a picture of the cam below its follower, not for cutting",
    ),
    **{
        kind: FileFormat(partial(_mesh, kind), _plates(f".{kind}"), _SOLIDS)
        for kind in ("stl", "3mf", "glb")
    },
    "step": FileFormat(
        _step, _plates(".step"), 'exact solids for CAD; needs `pip install "gearcam[step]"`'
    ),
    "drawing-dxf": FileFormat(
        partial(_sheet, "dxf"), _plates("_drawing.dxf", whole=False), _SHEETS
    ),
    "drawing-svg": FileFormat(
        partial(_sheet, "svg"), _plates("_drawing.svg", whole=False), _SHEETS
    ),
    "inspection": FileFormat(
        _inspection,
        _walls("inspection"),
        "points of the profile at even cam angles with their outward normals, where trimming has"
        " left them",
    ),
    "report": FileFormat(report_files, "report.html", REPORT_DOC),
    "tool-path": FileFormat(
        _tool_path,
        f"{_walls('tool_path')}; tool_path_relief.csv; the same names with .dxf",
        "the path of the centre of a cutter of `tool_radius_mm`; in a groove along the pitch curve"
        " for a cutter as wide as the groove, else along each wall, and for two rollers along the"
        " relief",
    ),
    "curvature": FileFormat(
        _curvature,
        "curvature.csv",
        "the error of the curvature from three neighbouring points over their spacing; of conjugate"
        " cams of the first",
    ),
}
"""What each word of ``output.files`` makes."""
