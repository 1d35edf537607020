"""Cams in space: their solids against rollers subtracted one by one, and whole builds."""

from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import gearcam
from gearcam.kinds.spatial_cam.result import SpatialCamResult
from gearcam.parts.solids import carved
from gearcam.spatial import globoidal_carving, globoidal_surface
from gearcam.spatial.surface import chord_error, surface
from measuring import ROOT, Result, Timing, commands, in_turns, measure, show, table

REFERENCE = """
kind = "cam"
name = "reference"
follower = { roller_radius_mm = 8 }
output = { files = ["stl"] }

[cam]
form = "cylinder"
outer_diameter_mm = 80
length_mm = 60
lowest_mm = 15
groove_depth_mm = 12

[[motion]]
type = "rise"
law = "cycloidal"
angle_deg = 120
lift_mm = 30
[[motion]]
type = "dwell"
angle_deg = 60
[[motion]]
type = "return"
law = "cycloidal"
angle_deg = 120
[[motion]]
type = "dwell"
angle_deg = "rest"
"""
FINE = 1080, 19
"""Cam angles and places along the roller at which chords are below 1 um."""

ROLLERS = 360
SIDES = 256
"""Positions of the roller that are subtracted, and sides of its prism."""

GLOBOIDAL = ROOT / "profiles" / "globoidal_indexer.toml"
USUAL = 720, 13
"""Cam angles in a turn and places along the roller of a solid, if a design does not say."""

POSITIONS = 120
"""Positions of the rollers in a turn that cut the rib of an undercut globoidal cam."""

EXACT = math.pi * 40.0**2 * 60.0 - 44298.298
"""Volume of the cam, mm^3, by two quadratures."""

_NOTE = """\
Lift 30 mm in 120 deg, roller 8 mm, cylinder 80 mm, groove 12 mm. The chord error of the surface is
{chord:.2f} um, its volume is {own:.2f} mm3 off; {rollers} rollers that manifold3d subtracts leave
it {other:.1f} mm3 off, so that the same volume error would take more of them."""

_RIB_NOTE = """\
The profile globoidal_indexer. Of the rib that rollers cut at {positions} angles in a turn scallops
are up to {scallop:.0f} um high: as undercut cams are made. The whole solid is what is in the blank
and in core or rib, by manifold3d: {solid}."""


def of_cylinder_cams() -> list[Result]:
    """(x), (y) The solid of a cylinder cam; a whole build."""
    return [_against_rollers(), _whole()]


def _against_rollers() -> Result:
    """(x) The surface at chords of 1 um against rollers subtracted by manifold3d."""
    result: Any = gearcam.build(gearcam.loads(REFERENCE))
    cam, blank = result.cam, result.blank
    (mine,) = in_turns({"surface at 1 um": lambda: surface(cam, blank, *FINE)}, 7)
    volumes: list[float] = []
    other = measure(
        f"{ROLLERS} rollers", lambda: volumes.append(_subtracted(result)), 1, warm=False
    )
    missed = abs(volumes[0] - EXACT)
    chord = 1e3 * chord_error(cam, *FINE)
    ratio = other.median / mine.median
    off = abs(result.mesh_of(*FINE).volume - EXACT)
    return Result(
        title="(x) The solid of a cylinder cam against rollers subtracted one by one",
        asked="chords at most 1 um; at least 100 times faster, at a smaller volume error",
        found=f"{chord:.2f} um, {show(mine.median)}; {ratio:.0f} times faster",
        passed=chord <= 1.0 and ratio >= 100.0 and off < missed,
        body=[
            *table([mine, other]),
            "",
            _NOTE.format(chord=chord, own=off, rollers=ROLLERS, other=missed),
        ],
    )


def _subtracted(result: SpatialCamResult) -> float:
    """Return the volume of the cylinder less rollers at many cam angles, mm^3."""
    import manifold3d

    cam, length = result.cam, result.blank.length
    body = manifold3d.Manifold.cylinder(length, cam.outer_radius, cam.outer_radius, ROLLERS)
    depth = cam.outer_radius - cam.floor + 5.0
    tool = manifold3d.Manifold.cylinder(depth, cam.tool.radius, cam.tool.radius, SIDES)
    tool = tool.rotate((0.0, 90.0, 0.0))
    angles = np.linspace(0.0, 2.0 * math.pi, ROLLERS, endpoint=False)
    lift = cam.program.derivatives(angles, 0)[0] + result.design.cam.lowest
    rollers = [
        tool.translate((cam.floor, 0.0, float(z))).rotate((0.0, 0.0, -math.degrees(theta)))
        for theta, z in zip(angles.tolist(), lift, strict=True)
    ]
    swept = manifold3d.Manifold.batch_boolean(rollers, manifold3d.OpType.Add)
    return float((body - swept).volume())


def _whole() -> Result:
    """(y) The command that builds the reference cam with its solid."""
    found = _builds({"gearcam build, stl": REFERENCE}, 7)
    return Result(
        title="(y) A cylinder cam with its solid, as a whole process",
        asked="at most 1 s",
        found=show(found[0].median),
        passed=found[0].median <= 1.0,
        body=table(found),
    )


def _builds(designs: dict[str, str], count: int) -> list[Timing]:
    """Time the command that builds designs, by what they are called."""
    with tempfile.TemporaryDirectory() as folder:
        cases = {}
        for number, (name, text) in enumerate(designs.items()):
            path = Path(folder) / f"design{number}.toml"
            path.write_text(text, encoding="utf-8")
            cases[name] = [sys.executable, "-m", "gearcam", "build", str(path), "-o", folder]
        return commands(cases, count)


def of_globoidal_cams() -> list[Result]:
    """(zd), (ze) The solid of a globoidal cam; a whole build."""
    return [_against_positions(), _beside_cylinder()]


def _against_positions() -> Result:
    """(zd) The surface of the rib against rollers subtracted at many angles."""
    result: Any = gearcam.build(gearcam.load(GLOBOIDAL))
    cam = result.cam
    rib, whole = in_turns(
        {
            "rib": lambda: globoidal_surface.rib_surface(cam, *USUAL),
            "solid": lambda: result.mesh_of(*USUAL),
        },
        5,
    )
    cut = measure(f"{POSITIONS} positions", lambda: _carved_rib(cam), 1, warm=False)
    chord = 1e3 * globoidal_surface.chord_error(cam, *USUAL)
    scallop = 1e3 * globoidal_carving.scallop(cam, POSITIONS, USUAL[1])
    ratio = cut.median / rib.median
    return Result(
        title="(zd) The solid of a globoidal cam against rollers subtracted one by one",
        asked="chords at most 5 um; its rib at least 10 times faster",
        found=f"{chord:.2f} um, {show(rib.median)}; {ratio:.0f} times faster",
        passed=chord <= 5.0 < scallop and ratio >= 10.0,
        body=[
            *table([rib, whole, cut]),
            "",
            _RIB_NOTE.format(positions=POSITIONS, scallop=scallop, solid=show(whole.median)),
        ],
    )


def _carved_rib(cam: Any) -> None:
    """Cut the rib out of a little more than the cam."""
    uncut = globoidal_carving.uncut_surface(cam, POSITIONS)
    carved(uncut, globoidal_carving.roller_corners(cam, POSITIONS, USUAL[1]))


def _beside_cylinder() -> Result:
    """(ze) The commands that build both kinds of cams in space with their solids."""
    text = GLOBOIDAL.read_text("utf-8").partition("[output]")[0]
    designs = {"globoidal": f'{text}[output]\nfiles = ["stl"]\n', "cylinder": REFERENCE}
    found = _builds(designs, 5)
    ratio = found[0].over(found[1])
    return Result(
        title="(ze) A globoidal cam with its solid, as a whole process",
        asked="at most 6 times a cylinder cam",
        found=f"{show(found[0].median)}, {ratio:.2f} times",
        passed=ratio <= 6.0,
        body=table(found),
    )
