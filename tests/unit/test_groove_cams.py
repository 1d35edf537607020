"""Groove cams: free tests of both walls, play, parts, files, refusals."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

import gearcam
from gearcam.cams.checks import KIND
from gearcam.cams.follow import follow
from gearcam.cams.groove import GrooveCam, make_groove
from gearcam.cams.lost import resting
from gearcam.cams.lost_motion import Rest
from gearcam.designs import loads
from gearcam.errors import DesignError, InfeasibleError
from gearcam.findings import run_checks
from gearcam.kinds.cam.design import CamDesign
from gearcam.laws.motion_formula import MotionFormula
from gearcam.numeric.jets import Jet
from gearcam.tolerances import DEFAULT
from helpers_cams import angles, back, mechanism, program, rise, there_and_back
from helpers_pairs import PROFILES
from helpers_step_read import read_step
from witness.roller_bands import band, lift

STEEP = (50.0, 130.0, 50.0, 130.0)
FILE = (PROFILES / "groove_cam.toml").read_text("utf-8")


def read(*changes: tuple[str, str]) -> CamDesign:
    text = FILE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    made = loads(text)
    assert isinstance(made, CamDesign)
    return made


def refused(*changes: tuple[str, str]) -> dict[str, str]:
    with pytest.raises(DesignError) as caught:
        read(*changes)
    return {one.key: f"{one.message}; {one.allowed}" for one in caught.value.problems}


def groove(kind: str = "roller", **sizes: Any) -> GrooveCam:
    swings = kind.startswith("swinging")
    motion = there_and_back("cycloidal", 12.0, swings=swings)
    return make_groove(motion, mechanism(kind), **sizes)


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("kind", ["roller", "roller, offset", "swinging roller"])
def test_a_groove_has_the_area_of_its_width_along_the_pitch_curve(
    kind: str, clockwise: bool
) -> None:
    made = groove(kind, clearance=0.4, clockwise=clockwise)
    inner, outer = (wall.size for wall in made.walls)
    length = 0.5 * (inner.perimeter + outer.perimeter)
    assert made.width == pytest.approx(2.0 * made.motion.mechanism.radius + 0.4)
    assert outer.perimeter - inner.perimeter == pytest.approx(2.0 * math.pi * made.width)
    assert outer.area - inner.area == pytest.approx(made.width * length, rel=1e-12)


@pytest.mark.parametrize("kind", ["roller", "roller, offset", "swinging roller"])
def test_play_by_dense_points(kind: str) -> None:
    """The slope too, by differences; a swinging follower's own search knows the inner wall."""
    made, theta = groove(kind, clearance=0.3, tolerance=1e-5), angles(90)
    m = made.motion.mechanism
    for wall in made.walls:
        found, slope = Rest(wall=wall, radius=m.radius).lift(theta)
        step = 1e-6
        ahead, behind = (Rest(wall=wall, radius=m.radius).lift(theta + d)[0] for d in (step, -step))
        smooth = np.abs(theta % (0.5 * math.pi)) > 1e-3
        np.testing.assert_allclose(
            slope[smooth], ((ahead - behind) / (2.0 * step))[smooth], atol=1e-6
        )
        if wall.side > 0:
            np.testing.assert_allclose(follow(wall.outline, m, theta).lift, found, atol=3e-5)
        elif not m.oscillating:
            dense = np.concatenate([run.points for run in wall.contour.runs]) @ [1.0, 1.0j]
            dense = dense[:-1, None] + np.diff(dense)[:, None] * np.linspace(0.0, 1.0, 9)
            places = [
                lift(dense.ravel(), t, m.radius, m.offset, outwards=True) - m.start for t in theta
            ]
            np.testing.assert_allclose(found, places, atol=3e-5)


@pytest.mark.parametrize(
    ("kind", "height", "prime"), [("roller", 25.0, 30.0), ("swinging roller", 22.0, 35.0)]
)
def test_a_roller_that_rests_touches_its_wall_and_no_more(
    kind: str, height: float, prime: float
) -> None:
    """On corners too: the distance from its centre to the whole wall is its radius."""
    swings = kind.startswith("swinging")
    motion = there_and_back("3-4-5", height, STEEP, swings=swings)
    follower = mechanism(kind, roller_radius=13.6, prime_radius=prime)
    made = make_groove(motion, follower, clearance=2.0, tolerance=1e-4)
    theta = np.linspace(0.0, 2.0 * math.pi, 721)
    for wall in made.walls:
        assert wall.corners
        position = follower.start + Rest(wall=wall, radius=13.6).lift(theta)[0]
        fixed = follower.pivot - follower.arm * np.exp(-1j * position) if swings else 1j * position
        center = fixed * np.exp(-1j * theta)
        places = shapely.points(center.real, center.imag)
        away = shapely.distance(places, wall.contour.polygon.boundary)
        np.testing.assert_allclose(away, 13.6, atol=2e-4)
        assert np.all(shapely.contains(wall.contour.polygon, places) == (wall.side < 0))
        wide = follower.start + Rest(wall=wall, radius=14.6).lift(theta)[0] - follower.start
        beyond = wall.side * (motion.derivatives(theta, 0)[0] - wide)
        assert beyond.max() == pytest.approx(wall.shortfall, rel=1e-2)


def test_jumps_of_velocity_round_one_wall_and_cut_the_other() -> None:
    made = make_groove(
        there_and_back("constant-velocity", 10.0), mechanism("roller"), clearance=1.0
    )
    for wall in made.walls:
        convex, concave = wall.profile_radius
        assert convex == 0.0
        assert concave == pytest.approx(6.5)
    rises = MotionFormula(lift="10*sin(theta/2)").program(DEFAULT, oscillating=False)
    assert [jump.after - jump.before for jump in rises.hard] == [pytest.approx(10.0)]
    inner, outer = make_groove(rises, mechanism("roller"), clearance=1.0).walls
    assert inner.profile_radius[0] > 1.0
    assert inner.profile_radius[1] == pytest.approx(6.5)
    assert outer.profile_radius[0] == 0.0
    assert outer.profile_radius[1] == pytest.approx(inner.profile_radius[0] + 13.0)


def test_without_clearance_only_corners_give_play() -> None:
    assert groove("roller, offset").lost_motion.value < 1e-13
    motion = there_and_back("3-4-5", 25.0, STEEP)
    made = make_groove(motion, mechanism("roller", roller_radius=9.5))
    corner = made.outer.corners[0]
    assert made.inner.corners == ()
    assert made.lost_motion.value == pytest.approx(made.outer.shortfall, rel=1e-12)
    theta = np.linspace(corner.before, corner.after, 400)
    rest = resting(made.outer.mechanism, corner.point, -1)(Jet.variable(theta, 0)).c[0]
    beyond = rest - motion.derivatives(theta, 0)[0]
    assert beyond.min() > -1e-12
    assert made.lost_motion.value == pytest.approx(beyond.max(), rel=1e-4)


@pytest.mark.parametrize("law", ["cycloidal", "constant-velocity"])
def test_the_largest_lost_motion_is_the_largest_of_many(law: str) -> None:
    made = make_groove(
        there_and_back(law, 10.0, (60.0, 20.0, 70.0, 210.0)), mechanism("roller"), clearance=0.5
    )
    theta = np.linspace(0.0, 2.0 * math.pi, 20001)
    inner, outer = (Rest(wall=wall, radius=6.0).lift(theta)[0] for wall in made.walls)
    play = outer - inner
    assert play.min() > 0.0
    assert play.max() <= made.lost_motion.value + 1e-12
    assert play.max() == pytest.approx(made.lost_motion.value, rel=1e-4)


@pytest.mark.parametrize(("limit", "count"), [(0.0999, 1), (0.1001, 0)])
def test_lost_motion_is_told(limit: float, count: int) -> None:
    made = groove("roller")
    found = made.motion.pressure("rise")
    assert found is not None
    made = groove("roller", clearance=0.1 * math.cos(found.largest))
    told = run_checks(KIND, made, {"lost_motion": limit})
    assert [one.code for one in told].count("lost-motion") == count


def test_findings_name_the_wall() -> None:
    motion = there_and_back("3-4-5", 25.0, STEEP)
    made = make_groove(motion, mechanism("roller", roller_radius=9.5), clearance=0.1)
    found = [one for one in run_checks(KIND, made, {}) if one.code == "undercut"]
    assert len(found) == 2
    assert all(one.where.startswith("outer wall, at ") for one in found)
    assert all(one.message.startswith("The outer wall is undercut") for one in found)


def test_an_undercut_stretch_may_end_in_a_jump_at_the_end_of_the_turn() -> None:
    """The outer wall runs backwards before it, and the velocity rises at once there."""
    phases = [rise("constant-velocity", angle, 4.0) for angle in (22.36, 22.36, 292.92)]
    motion = program([*phases, back("constant-acceleration", 22.36, q=0.5)])
    made = make_groove(motion, mechanism("roller", prime_radius=15.0, roller_radius=0.75))
    first, last = (made.outer.undercut[k] for k in (0, -1))
    assert first == (0.0, 0.0)
    assert 6.28 < last[0] < last[1]
    assert made.outer.undercut[-1][1] == pytest.approx(2.0 * math.pi)
    region = band(made.outer.pitch_contour.vertices @ [1.0, 1.0j], 0.75)
    off = shapely.symmetric_difference(made.outer.contour.polygon, shapely.Polygon(region.exterior))
    assert off.area < 3.0 * made.outer.tolerance * region.length


def test_two_rollers_touch_a_wall_each() -> None:
    made = groove("roller", clearance=0.1, radius2=7.0)
    assert [wall.mechanism.radius for wall in made.walls] == pytest.approx([6.05, 7.05])
    assert made.relief is not None
    assert (made.relief.side, made.relief.mechanism.radius) == (1, pytest.approx(8.05))
    smaller = groove("roller", clearance=0.1, radius2=5.0)
    assert smaller.relief is not None
    assert (smaller.relief.side, smaller.relief.mechanism.radius) == (-1, pytest.approx(7.05))
    assert smaller.lost_motion.value == pytest.approx(
        groove("roller", clearance=0.1).lost_motion.value, rel=1e-9
    )


def volume_of(gaps: Sequence[tuple[float, float]]) -> float:
    """Disc less grooves of an area and a depth, and the bore."""
    bore = 0.25 * math.pi * 16.0**2
    disc = 0.25 * math.pi * 110.0**2 - bore
    return 20.0 * disc - sum(area * depth for area, depth in gaps)


PLAIN = ("keyway_width_mm = 5\nkeyway_depth_mm = 2.3\n", "")


@pytest.mark.parametrize("side", ["front", "back"])
def test_the_solid_is_the_disc_less_its_groove(side: str) -> None:
    result = gearcam.build(read(PLAIN, ('"front"', f'"{side}"')))
    (mesh,) = result.solids.values()
    inner, outer = (wall.size.area for wall in result.cam.walls)
    expected = volume_of([(outer - inner, 12.0)])
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(expected, abs=10.0)
    assert result.part.volume == pytest.approx(expected, rel=1e-9)
    floor = 8.0 if side == "front" else 12.0
    assert np.any(np.isclose(mesh.vertices[:, 2], floor))
    assert sorted({round(z, 9) for z in mesh.vertices[:, 2]}) == [0.0, floor, 20.0]


@pytest.mark.parametrize("radius2", [5.0, 7.0])
def test_the_groove_of_two_rollers_has_a_step(radius2: float) -> None:
    change = ("roller_radius_mm = 6", f"roller_radius_mm = 6\nroller2_radius_mm = {radius2}")
    result = gearcam.build(read(PLAIN, change))
    (mesh,) = result.solids.values()
    cam = result.cam
    assert isinstance(cam, GrooveCam)
    assert cam.relief is not None
    inner, outer, wide = (wall.size.area for wall in (*cam.walls, cam.relief))
    upper = outer - wide if radius2 > 6.0 else wide - inner
    expected = volume_of([(outer - inner, 6.0), (upper, 6.0)])
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(expected, abs=12.0)
    assert result.part.volume == pytest.approx(expected, rel=1e-9)
    assert set(result.files("tool-path")) >= {"tool_path_relief.csv", "tool_path_inner.dxf"}


@pytest.mark.parametrize("side", ["front", "back"])
def test_step_holds_the_groove(side: str) -> None:
    result = gearcam.build(read(PLAIN, ('"front"', f'"{side}"')))
    (solid,) = read_step(result.files("step")["cam.step"])
    inner, outer = (wall.size.area for wall in result.cam.walls)
    assert solid.volume == pytest.approx(volume_of([(outer - inner, 12.0)]), rel=1e-6)
    middle = result.part.volume, 20.0 * (0.25 * math.pi * (110.0**2 - 16.0**2))
    low, high = (8.0, 20.0) if side == "front" else (0.0, 12.0)
    height = (middle[1] * 10.0 - (middle[1] - middle[0]) * 0.5 * (low + high)) / middle[0]
    assert solid.center[2] == pytest.approx(height, abs=1e-5)


def test_the_inner_wall_carries_the_follower(tmp_path: Path) -> None:
    """From points and from the drawing: lower than asked by no more than the half width's rest."""
    result = gearcam.build(FILE_DESIGN)
    cam = result.cam
    assert isinstance(cam, GrooveCam)
    file = tmp_path / "cam.dxf"
    file.write_bytes(result.files("dxf")["cam.dxf"])
    expected = Rest(wall=cam.inner, radius=6.0).lift(result.angles)[0]
    for profile in (cam.outline, file):
        found = result.follow(profile).columns["s"]
        np.testing.assert_allclose(found, expected, atol=3e-3)


def test_files_of_a_groove() -> None:
    result = gearcam.build(FILE_DESIGN)
    tables = result.files("csv")
    assert set(tables) == {"profile_inner.csv", "profile_outer.csv", "motion.csv"}
    assert set(result.files("inspection")) == {"inspection_inner.csv", "inspection_outer.csv"}
    text = result.files("dxf")["cam.dxf"].decode()
    layers = {"INNER", "OUTER", "PITCH", "BLANK", "BORE", "PRIME", "CENTER"}
    assert {name for name in layers if f"\n{name}\n" in text} == layers
    ET.fromstring(result.files("svg")["cam.svg"])


FILE_DESIGN = read()


def test_contact_of_each_wall() -> None:
    result = gearcam.build(FILE_DESIGN)
    inner, outer = result.contact(), result.contact(wall="outer")
    a, b = (found["x_mm"] + 1j * found["y_mm"] for found in (inner, outer))
    n, m = (found["nx"] + 1j * found["ny"] for found in (inner, outer))
    np.testing.assert_allclose(abs(a - b), 12.05, atol=1e-12)
    np.testing.assert_allclose(m, -n, atol=1e-12)  # both metals face each other
    np.testing.assert_allclose(a + 12.05 * n, b, atol=1e-12)
    with pytest.raises(DesignError, match="inner"):
        result.contact(wall="left")


def test_the_way_of_a_tool() -> None:
    result = gearcam.build(FILE_DESIGN)
    assert set(result.files("tool-path")) == {"tool_path.csv", "tool_path.dxf"}
    smaller = gearcam.build(
        replace(FILE_DESIGN, output=replace(FILE_DESIGN.output, tool_radius=5.0))
    )
    assert set(smaller.files("tool-path")) == {
        f"tool_path_{key}.{end}" for key in ("inner", "outer") for end in ("csv", "dxf")
    }
    wide = replace(FILE_DESIGN, output=replace(FILE_DESIGN.output, tool_radius=6.1))
    with pytest.raises(InfeasibleError, match="wider than the groove") as caught:
        gearcam.build(wide).files("tool-path")
    assert caught.value.limit == pytest.approx(6.025)


def test_the_paths_of_a_smaller_tool_keep_to_the_walls() -> None:
    result = gearcam.build(
        replace(FILE_DESIGN, output=replace(FILE_DESIGN.output, tool_radius=5.0))
    )
    rows = {
        key: np.loadtxt(
            result.files("tool-path")[f"tool_path_{key}.csv"].decode().splitlines(),
            delimiter=",",
            skiprows=1,
        )
        for key in ("inner", "outer")
    }
    middle = result.cam.walls[0].pitch_contour.polygon.boundary
    for points in rows.values():
        away = shapely.distance(shapely.points(points), middle)
        np.testing.assert_allclose(away, 1.025, atol=2e-3)


@pytest.mark.parametrize(
    ("old", "new", "key", "words"),
    [
        (
            'form = "groove"',
            'form = "disc"',
            "cam.outer_diameter_mm",
            'disc cam has none.*"groove"',
        ),
        ("outer_diameter_mm = 110\n", "", "cam.outer_diameter_mm", "is missing for a groove cam"),
        ("groove_depth_mm = 12\n", "", "cam.groove_depth_mm", "is missing for a groove cam"),
        ("depth_mm = 12", "depth_mm = 20", "cam.groove_depth_mm", "no floor.*thickness of 20 mm"),
        ("_mm = 6", "_mm = 6\nroller2_radius_mm = 6", "follower.roller2_radius_mm", "another rad"),
        ('"front"', '"left"', "cam.side", '"front" or "back"'),
        ('"roller"\nroller_radius_mm = 6', '"point"', "follower.type", '"roller"'),
        ("bore_dia", "clearance_mm = 0.1\nbore_dia", "blank.clearance_mm", "roller_clearance_mm"),
        ("[output]", "[output]\nkerf_mm = 0.2", "output.kerf_mm", "milled, not cut through"),
        ('"stl"', '"cut-svg"', "output.files", "milled, not cut through"),
    ],
)
def test_what_a_groove_cannot_have_is_told_by_reading(
    old: str, new: str, key: str, words: str
) -> None:
    found = refused((old, new))
    assert key in found
    assert re.search(words, found[key])


def test_keys_of_a_groove_are_refused_with_a_disc() -> None:
    found = refused(('form = "groove"', 'form = "disc"'))
    assert set(found) == {
        f"cam.{key}"
        for key in ("outer_diameter_mm", "groove_depth_mm", "roller_clearance_mm", "side")
    }


def test_a_blank_that_the_groove_opens_is_refused_with_the_least() -> None:
    farthest = math.hypot(8.0, math.sqrt(836.0) + 10.0) + 6.025
    with pytest.raises(InfeasibleError, match="opens the edge") as caught:
        _ = gearcam.build(read(("outer_diameter_mm = 110", "outer_diameter_mm = 90"))).cam
    assert caught.value.limit == pytest.approx(2.0 * farthest, rel=1e-14)
    just = 2.0 * farthest + 1e-6
    result = gearcam.build(read(("outer_diameter_mm = 110", f"outer_diameter_mm = {just!r}")))
    thin = [one for one in result.findings if one.code == "thin-wall"]
    assert [one.value for one in thin] == [pytest.approx(0.0, abs=2e-3)]
    assert "groove and the outline" in thin[0].message


def test_a_remedy_for_a_blank_that_is_opened_works() -> None:
    result = gearcam.build(read(("outer_diameter_mm = 110", "outer_diameter_mm = 90")))
    found = gearcam.remedies(result, patience=5.0).found
    assert any("outer_diameter_mm" in str(one.changes) for one in found)


def test_a_thin_floor_is_told() -> None:
    result = gearcam.build(read(("depth_mm = 12", "depth_mm = 19.5")))
    thin = [one for one in result.findings if one.code == "thin-wall"]
    assert [one.value for one in thin] == [pytest.approx(0.5)]
    assert "floor" in thin[0].message


@pytest.mark.parametrize(("tool", "count"), [(12.04, 0), (12.06, 1)])
def test_a_tool_wider_than_the_groove_is_told(tool: float, count: int) -> None:
    result = gearcam.build(read(("[output]", f"[limits]\ntool_diameter_mm = {tool}\n[output]")))
    assert [one.code for one in result.findings].count("large-tool") == count


def test_a_bore_that_reaches_the_groove_is_refused() -> None:
    with pytest.raises(InfeasibleError):
        _ = gearcam.build(read(PLAIN, ("bore_diameter_mm = 16", "bore_diameter_mm = 60"))).parts
