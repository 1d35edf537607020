"""From a gear pair to the contents of its files: one function a kind of file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

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
from gearcam.kinds.gear_pair.columns import POINTS
from gearcam.numerals import shown
from gearcam.report.file import framed as framed
from gearcam.report.file import report_files

if TYPE_CHECKING:
    from gearcam.drawings import Drawing, Path, Placement
    from gearcam.export.dxf import DxfStyle
    from gearcam.kinds.gear_pair.build import GearPairResult
    from gearcam.parts.body import Part
    from gearcam.solids import Mesh

Measured = dict[str, Any]

PAIR: Final = "pair"
"""Stem of the files of the assembled pair."""

_PAIR_ROWS: Final = ("pair.module_mm", "pair.teeth", "pair.ratio", "pair.travel_per_turn_mm")
_RACK_ROWS: Final = (
    "pair.rack.pressure_angle_deg", "pair.rack.addendum", "pair.rack.dedendum",
    "pair.backlash_mm", "pair.face_width_mm", "steps.count",
)  # fmt: skip
_GEAR_ROWS: Final = (
    "profile_shift", "centrode.length_mm", "cutter", "clearance_mm", "tip_rounding_mm",
    "density_kg_m3", "mass.mass_kg", "mass.centroid_mm", "mass.unbalance_g_mm",
)  # fmt: skip
"""Facts that stand in the tables of drawings."""


def _tables(result: GearPairResult, _: Measured) -> Files:
    from gearcam.export.table import outline_bytes, table_bytes

    found = result.centrodes()
    centrodes = {name: values for name, values in found.items() if name not in POINTS}
    files = {f"{gear.name}_outline.csv": outline_bytes(gear.outline) for gear in result.gears}
    return files | {"centrodes.csv": table_bytes(centrodes)}


def centrode_paths(result: GearPairResult) -> list[Path]:
    """Return the centrodes of a `result` as chains, each in its wheel's own frame, driver first."""
    from gearcam.drawings import Path

    lobes = result.law.lobes
    ends = [lobes.n1 * lobes.period, lobes.n2 * lobes.period]
    if result.pair.on_rack:
        ends[1] = result.centrode_angles()[-1]
    paths = []
    for gear, end in zip(result.gears, ends, strict=True):
        closed = gear.toothing.closed
        turn = np.linspace(0.0, end, 721)[: -1 if closed else None]
        paths.append(Path(points=gear.centrode(turn), closed=closed))
    return paths


def _pair_drawing(result: GearPairResult) -> Drawing:
    from gearcam.drawings import pair_drawing

    paths = centrode_paths(result)
    return pair_drawing(result.parts, result.pair.shift, paths, placements=placements(result))


def placements(result: GearPairResult) -> tuple[Placement, Placement]:
    """Return how the wheels of a `result` stand when assembled: wheel 1 turned by -phi1."""
    phi1, guide = result.design.output.pose, result.pair.rolling.guide
    moved = float(guide.nominal(np.array(phi1)))
    if result.pair.on_rack:
        return (-phi1, (0.0, 0.0)), (0.0, (0.0, -moved))
    return (-phi1, (0.0, 0.0)), (guide.turns * moved, (guide.place, 0.0))


def _style(result: GearPairResult) -> DxfStyle:
    return dxf_style(result.design.output, result.gear1.profile.tolerance)


def _dxf(result: GearPairResult, measured: Measured) -> Files:
    return drawn([*result.to_cut, _pair_drawing(result)], _style(result), measured)


def _cut(result: GearPairResult, _: Measured) -> Files:
    return cut_files(result.to_cut, result.design.name, result.design.output.kerf)


def _picture(result: GearPairResult, _: Measured) -> Files:
    from gearcam.export.svg import svg_bytes

    notes = result.facts.headline
    return {"pair.svg": svg_bytes(_pair_drawing(result), title=result.design.name, notes=notes)}


def _inspection(result: GearPairResult, _: Measured) -> Files:
    from gearcam.export.table import table_bytes
    from gearcam.kinds.gear_pair.ordered import inspection_rows

    rows = inspection_rows(result.steps, result.design.output.inspection_points)
    return {"inspection.csv": table_bytes(rows)}


def _steps(result: GearPairResult, _: Measured) -> Files:
    from gearcam.drawings import UNMOVED
    from gearcam.export.step import step_bytes

    tolerance = STEP_PART * result.gear1.profile.tolerance
    made: dict[Part, Any] = {}
    files = {
        f"{part.name}.step": step_bytes([(part, UNMOVED)], part.name, tolerance, made)
        for part in result.parts
    }
    placed = list(zip(result.parts, placements(result), strict=True))
    return files | {f"{PAIR}.step": step_bytes(placed, PAIR, tolerance, made)}


def _meshes(kind: str, result: GearPairResult, measured: Measured) -> Files:
    solids = meshes(result.parts, measured)
    files = {
        f"{name}.{kind}": mesh_bytes({name: mesh}, kind, name) for name, mesh in solids.items()
    }
    return files | {f"{PAIR}.{kind}": mesh_bytes(assembled(result, measured), kind, PAIR)}


def assembled(result: GearPairResult, measured: Measured) -> dict[str, Mesh]:
    """Return the solids of both wheels where they stand (see `gearcam.export.shared.meshes`)."""
    solids = meshes(result.parts, measured).items()
    places = placements(result)
    return {name: mesh.placed(*pose) for (name, mesh), pose in zip(solids, places, strict=True)}


def _sheets(ending: str, result: GearPairResult, _: Measured) -> Files:
    """Return the workshop drawings of both wheels and of the pair."""
    from gearcam.sheets import pair_sheet, wheel_sheet

    facts, title, pose = result.facts, result.design.name, result.design.output.pose
    radius = float(abs(result.pair.rolling.tracks[0].frames(np.array([pose])).p[0]))
    sheets = []
    for number, part in enumerate(result.parts):
        own = [f"gears.{number}.{name}" for name in _GEAR_ROWS]
        names = (f"gears.{number}.teeth", "pair.module_mm", *_RACK_ROWS, *own)
        sheets.append(wheel_sheet(part, sheet_rows(facts, names), title))
    rows = {"law": result.design.law_type} | sheet_rows(facts, (*_PAIR_ROWS, *_RACK_ROWS))
    rows["drawn at phi1"] = f"{shown(np.degrees(pose))} deg"
    pair = _pair_drawing(result)
    sheets.append(pair_sheet(pair, result.pair.shift, rows, title, pitch_radius=radius))
    style = _style(result)
    made = [sheet_bytes(sheet, style, ending) for sheet in sheets]
    return {name: data for files in made for name, data in files.items()}


FILES: Final[Mapping[str, Callable[..., Files]]] = {
    "dxf": _dxf,
    "cut-svg": _cut,
    "svg": _picture,
    **{kind: partial(_meshes, kind) for kind in ("stl", "3mf", "glb")},
    "step": _steps,
    "csv": _tables,
    "drawing-dxf": partial(_sheets, "dxf"),
    "drawing-svg": partial(_sheets, "svg"),
    "inspection": _inspection,
    "report": report_files,
}
"""What makes each kind of file: contents by name; what is measured on them is written down."""
