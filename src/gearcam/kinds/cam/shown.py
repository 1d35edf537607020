"""What is shown of a cam: its facts, and its files, one function a format."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.facts import Fact, Facts, Tree, extent
from gearcam.base.numerals import FEW, formatted
from gearcam.designs.outputs import DRAWINGS, MESHES
from gearcam.kinds.cam.motion import of_radii
from gearcam.kinds.cam.wall_facts import pressure
from gearcam.kinds.shared import peak_of
from gearcam.parts.mass import part_facts
from gearcam.report.file import report_files
from gearcam.results.parts import Files, Measured, dxf_files, part_files

if TYPE_CHECKING:
    from gearcam.cams.wall import Wall
    from gearcam.kinds.cam.result import CamResult
    from gearcam.laws.program import Program
    from gearcam.numeric.arrays import Array

_DERIVATIVES: Final = ("velocity", "acceleration", "jerk")


def facts(result: CamResult) -> Facts:
    """Return the facts of a cam, its `result`."""
    design = result.design
    tree: Tree = {
        "kerf_mm": design.output.kerf or None,
        "motion": _motion(result),
        "cam": _cam(result),
        "part": _part(result) or None,
        "solution": _solution(result),
    }
    headline = ("motion.total_lift", f"cam.{result.form.leading}")
    return Facts(tree, headline, f"{design.cam.form} cam for {design.follower.named}")


def _motion(result: CamResult) -> Tree:
    """Return lift in mm or deg and the peaks of its derivatives."""
    program, driver = result.program, result.driver
    scale, unit = result.follower.lift_unit
    low, high = program.range
    return {
        "unit": unit,
        "lift": Fact(extent(low, high, scale), "lift", unit=unit, shown=True),
        "total_lift": result.cam.motions[0].total_lift,
        "continuity": Fact(program.continuity, "continuity of the motion", unit=""),
        "deviation": _deviation(program, scale, unit),
        "measured": _measured(result),
        **{
            key: Fact(
                scale * peak,
                meaning,
                unit=f"{unit}/{driver.per}{order if order > 1 else ''}",
                shown=True,
            )
            for order, (name, peak) in enumerate(zip(_DERIVATIVES, program.peaks, strict=True), 1)
            for key, meaning in [peak_of(program, name, order)]
        },
        **_timed(result),
    }


def _solution(result: CamResult) -> Tree | None:
    """Return the sizes that were solved for, and the limits that decide on them."""
    found = result.solution
    if found is None:
        return None
    tree: Tree = {
        key.split(".")[1]: Fact(value, f"{key}, solved", shown=True)
        for key, value in found.sizes.items()
    }
    if found.deciding:
        tree["decided_by"] = Fact(", ".join(found.deciding), "decided by", shown=True)
    return tree


def _timed(result: CamResult) -> Tree:
    """Return the peaks of the derivatives by time; none without a speed."""
    program, drive = result.program, result.design.drive
    scales, tree = result.cam.motions[0].timed_scales(drive.speed), Tree()
    for order, (column, factor) in enumerate(scales.items(), 1):
        name = _DERIVATIVES[order - 1]
        (key, meaning), peak = peak_of(program, name, order), factor * program.peaks[order - 1]
        place = f"at {drive.named}"
        tree[key + column.removeprefix(name)] = Fact(peak, meaning, place=place, shown=True)
    return tree


def _measured(result: CamResult) -> Tree | None:
    """Return the distance of the profile from the radii of a motion that was measured."""
    if not of_radii(result.design.motion):
        return None
    from gearcam.kinds.cam.measured import measured_facts

    motion: Any = result.design.motion
    return measured_facts(motion.given(oscillating=False), result.cam.walls[0])


def _deviation(program: Program, scale: float, unit: str) -> Fact | None:
    """Return the largest distance of a smoothed lift from the rows of its table."""
    if program.deviation is None:
        return None
    place = f"at {formatted(math.degrees(program.deviation.theta), FEW, scale=360.0)} deg"
    value, meaning = scale * program.deviation.value, "largest distance from the given points"
    return Fact(value, meaning, place=place, unit=unit, shown=True)


def _cam(result: CamResult) -> Tree:
    design, given = result.solved, result.solved.follower
    return {
        "form": design.cam.form,
        "follower": f"{given.motion} {given.type}",
        "roller_radius_mm": given.roller_radius,
        "dome_radius_mm": given.dome_radius,
        "pivot_distance_mm": given.pivot_distance,
        "arm_mm": given.arm,
        "face_offset_mm": given.face_offset or None,
        **result.form.sizes(result.cam),
        "thickness_mm": design.cam.thickness,
        "pressure_angle_deg": pressure(result.cam.motions[0], design.limits),
        "lost_motion": _lost_motion(result),
        **result.form.facts(result.cam, result.contours),
    }


def _lost_motion(result: CamResult) -> Fact | None:
    """Return how far a follower between two walls can move while the cam stands still."""
    lost = result.cam.lost_motion
    if lost is None:
        return None
    scale, unit = result.follower.lift_unit
    place = result.driver.place(lost.theta)
    return Fact(scale * lost.value, "lost motion", place=place, unit=unit, shown=True)


def _part(result: CamResult) -> Tree | list[Tree]:
    """Return the facts of the part, or of each part, of a cam; empty if none is ordered."""
    if not result.ordered:
        return {}
    density, several = result.design.blank.density, len(result.parts) > 1
    parts = [
        part_facts(part, f"cam {number}" if several else "", tools, density)
        for number, (part, tools) in enumerate(
            zip(result.parts, result.part_subject.tools, strict=True), start=1
        )
    ]
    return parts if several else parts[0]


_STUDY: Final = (90, 180, 360, 720, 1440, 2880, 5760)
"""Points of a turn whose three-point curvature is held against the exact one."""


def _tables(result: CamResult, _: Measured) -> Files:
    """Return the profile and the motion as tables.

    Files: profile.csv; of a groove profile_inner.csv, profile_outer.csv; of a translating groove
    profile_lower.csv, profile_upper.csv; of conjugate cams profile_1.csv, profile_2.csv;
    motion.csv.

    Vertices of the profile; lift, velocity, acceleration, jerk, pressure angle and radii of
    curvature over the cam angle or travel.
    """
    from gearcam.export.table import motion_bytes, outline_bytes

    walls = zip(result.cam.walls, result.contours, strict=True)
    return {
        **{f"profile{wall.ending}.csv": outline_bytes(made.points) for wall, made in walls},
        "motion.csv": motion_bytes(result.motion()),
    }


def _inspection(result: CamResult, _: Measured) -> Files:
    """Return the points for inspection.

    Files: inspection.csv; of a groove inspection_inner.csv, inspection_outer.csv; of a translating
    groove inspection_lower.csv, inspection_upper.csv; of conjugate cams inspection_1.csv,
    inspection_2.csv.

    Points of the profile at even cam angles with their outward normals, where trimming has left
    them.
    """
    from gearcam.export.table import table_bytes

    walls = result.cam.walls
    return {f"inspection{wall.ending}.csv": table_bytes(_inspected(result, wall)) for wall in walls}


def _inspected(result: CamResult, wall: Wall) -> dict[str, Array]:
    """Return the columns of the points for inspection of a wall."""
    theta, points, normals = wall.places(result.design.output.inspection_points)
    driver, clearance = wall.carrier.driver, result.design.blank.clearance
    if clearance:
        from gearcam.parts.parallel import touches

        kept = touches(wall.contour, points, normals, -clearance)
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
    """Return the paths of a cutter.

    Files: tool_path.csv; of a groove tool_path_inner.csv, tool_path_outer.csv; of a translating
    groove tool_path_lower.csv, tool_path_upper.csv; of conjugate cams tool_path_1.csv,
    tool_path_2.csv; tool_path_relief.csv; the same names with .dxf.

    The path of the centre of a cutter of `tool_radius_mm`; in a groove along the pitch curve for a
    cutter as wide as the groove, else along each wall, and for two rollers along the relief.
    """
    from gearcam.export.table import outline_bytes
    from gearcam.pictures.drawings import TOOL, Drawing, Feature, reach

    paths = result.paths()
    tables = {f"{name}.csv": outline_bytes(reach(path)) for name, path in paths.items()}
    drawings = [
        Drawing(name=name, features=(Feature(layer=TOOL, shape=path),))
        for name, path in paths.items()
    ]
    return tables | dxf_files(result, drawings, measured)


def _curvature(result: CamResult, measured: Measured) -> Files:
    """Return the error of curvatures that are measured.

    Files: curvature.csv.

    The error of the curvature from three neighbouring points over their spacing; of conjugate cams
    of the first.
    """
    from gearcam.export.table import table_bytes
    from gearcam.kinds.cam.curvature import curvature_columns

    columns, measured["curvature"] = curvature_columns(result.cam.motions[0], _STUDY)
    return {"curvature.csv": table_bytes(columns)}


def _caliper(result: CamResult, _: Measured) -> Files:
    """Return the radius for each angle, for calipers or a dial gauge over a dividing head.

    Files: caliper.csv.

    Radius of the finished profile (of both walls of a groove, of both conjugate cams) from the axis
    at equal steps of the polar angle in the frame of the part, counter-clockwise from its x axis as
    in the DXF; of a translating cam heights above its lower edge at equal steps of x.
    """
    from gearcam.export.table import table_bytes
    from gearcam.kinds.cam.calipers import caliper_table

    return {"caliper.csv": table_bytes(caliper_table(result))}


def _grinding(result: CamResult, _: Measured) -> Files:
    """Return the lift of a grinding wheel.

    Files: grinding.csv; of a groove grinding_inner.csv, grinding_outer.csv; of conjugate cams
    grinding_1.csv, grinding_2.csv.

    Lift of a wheel of `grinding_wheel_radius_mm` that rolls on the finished profile, straight above
    the axis, over the cam angle; and its distance from the axis.
    """
    from gearcam.export.table import table_bytes
    from gearcam.kinds.cam.calipers import grinding_tables

    tables = grinding_tables(result)
    return {f"grinding{ending}.csv": table_bytes(one) for ending, one in tables.items()}


_SOLIDS: Final = """
    Files: cam.{format}; of conjugate cams cam1.{format}, cam2.{format}, cams.{format}.

    Closed solids in mm, of conjugate cams also both as they stand on the shaft."""

_SHEETS: Final = """
    Files: cam_drawing.{format}; of conjugate cams cam1_drawing.{format}, cam2_drawing.{format}.

    Workshop drawings with dimensions and a table of data."""

_OF_PARTS: Final = {
    "dxf": """
    Files: cam.dxf; of conjugate cams cam1.dxf, cam2.dxf; with `kerf_mm` also cam_reference.dxf, or
    cam1_reference.dxf, cam2_reference.dxf.

    Outlines in mm in the cam's frame: layers PROFILE, PITCH, PRIME, BORE, HOLE and CENTER; of a
    groove BLANK, OUTER and INNER, or GROOVE, instead of PROFILE. With `kerf_mm` cutting paths only,
    on layers that end in _KERF, and the part with its curves as the reference.""",
    "cut-svg": """
    Files: cam_cut.svg; of conjugate cams cam1_cut.svg, cam2_cut.svg; cut.svg.

    For laser programs, 1:1 in mm: inner edges, then outlines in red; one file for each part, and
    cut.svg with all parts side by side and labelled.""",
    "svg": """
    Files: cam.svg; of conjugate cams cams.svg.

    A picture of the cam below its follower, not for cutting.""",
    **dict.fromkeys(MESHES, _SOLIDS),
    "step": """
    Files: cam.step; of conjugate cams cam1.step, cam2.step, cams.step.

    Exact solids for CAD. Needs `pip install "gearcam[step]"`.""",
    **dict.fromkeys(DRAWINGS, _SHEETS),
    "print-pdf": """
    Files: cam_print.pdf; of conjugate cams cam1_print.pdf, cam2_print.pdf.

    Outlines at full size on A4 pages, with cross marks where these overlap, to glue on plywood.""",
}

FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "csv": _tables,
    **part_files(_OF_PARTS),
    "inspection": _inspection,
    "report": report_files,
    "tool-path": _tool_path,
    "curvature": _curvature,
    "caliper": _caliper,
    "grinding": _grinding,
}
"""What makes the files of each format: contents by name; what is measured on them is recorded."""
