"""Groove cams as designs: parts, files, and what is refused."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.cams.groove import GrooveCam
from helpers_files import read, refused
from helpers_pairs import PROFILES
from helpers_sampling import few
from helpers_step import read_step

FILE = (PROFILES / "groove_cam.toml").read_text("utf-8")


def volume_of(gaps: Sequence[tuple[float, float]]) -> float:
    """Disc less grooves of an area and a depth, and the bore."""
    bore = 0.25 * math.pi * 16.0**2
    disc = 0.25 * math.pi * 110.0**2 - bore
    return 20.0 * disc - sum(area * depth for area, depth in gaps)


PLAIN = ("keyway_width_mm = 5\nkeyway_depth_mm = 2.3\n", "")


@pytest.mark.parametrize("side", ["front", "back"])
def test_the_solid_is_the_disc_less_its_groove(side: str) -> None:
    result = gearcam.build(read(FILE, PLAIN, ('"front"', f'"{side}"')))
    (mesh,) = result.solids.values()
    inner, outer = (wall.size.area for wall in result.cam.walls)
    expected = volume_of([(outer - inner, 12.0)])
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(expected, abs=10.0)
    assert result.part.volume == pytest.approx(expected, rel=1e-9)
    floor = 8.0 if side == "front" else 12.0
    assert np.any(np.isclose(mesh.vertices[:, 2], floor))
    assert sorted({round(z, 9) for z in mesh.vertices[:, 2]}) == [0.0, floor, 20.0]


@pytest.mark.parametrize("radius2", few([5.0, 7.0]))
def test_the_groove_of_two_rollers_has_a_step(radius2: float) -> None:
    change = ("roller_radius_mm = 6", f"roller_radius_mm = 6\nroller2_radius_mm = {radius2}")
    result = gearcam.build(read(FILE, PLAIN, change))
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


@pytest.mark.slow
@pytest.mark.parametrize("side", ["front", "back"])
def test_step_holds_the_groove(side: str) -> None:
    result = gearcam.build(read(FILE, PLAIN, ('"front"', f'"{side}"')))
    (solid,) = read_step(result.files("step")["cam.step"])
    inner, outer = (wall.size.area for wall in result.cam.walls)
    assert solid.volume == pytest.approx(volume_of([(outer - inner, 12.0)]), rel=1e-6)
    middle = result.part.volume, 20.0 * (0.25 * math.pi * (110.0**2 - 16.0**2))
    low, high = (8.0, 20.0) if side == "front" else (0.0, 12.0)
    height = (middle[1] * 10.0 - (middle[1] - middle[0]) * 0.5 * (low + high)) / middle[0]
    assert solid.center[2] == pytest.approx(height, abs=1e-5)


@pytest.mark.parametrize("rotation", few(["ccw", "cw"]))
def test_each_wall_carries_a_roller_as_wide_as_the_groove(rotation: str, tmp_path: Path) -> None:
    """From points and from the drawing; taken for the other wall it is told."""
    result = gearcam.build(FILE_DESIGN.with_({"cam.rotation": rotation}))
    file = tmp_path / "cam.dxf"
    file.write_bytes(result.files("dxf")["cam.dxf"])
    for wall, other in (("inner", "outer"), ("outer", "inner")):
        outline = next(one.outline for one in result.cam.walls if one.key == wall)
        for profile in (outline, file):
            study = result.follow(profile, wall=wall)
            np.testing.assert_allclose(study.columns["difference"], 0.0, atol=3e-3)
            assert "other-profile" not in [one.code for one in study.findings]
        missed = result.follow(outline, wall=other)
        (finding,) = [one for one in missed.findings if one.code == "other-profile"]
        assert finding.where.startswith(f"{other} wall, at ")
        assert finding.value == pytest.approx(abs(missed.facts["followed.largest_difference"]))
        assert finding.limit == pytest.approx(1.0)
        assert finding.value is not None
        assert finding.value > 12.0


def test_files_of_a_groove() -> None:
    result = gearcam.build(FILE_DESIGN)
    tables = result.files("csv")
    assert set(tables) == {"profile_inner.csv", "profile_outer.csv", "motion.csv"}
    assert set(result.files("inspection")) == {"inspection_inner.csv", "inspection_outer.csv"}
    text = result.files("dxf")["cam.dxf"].decode()
    layers = {"INNER", "OUTER", "PITCH", "BLANK", "BORE", "PRIME", "CENTER"}
    assert {name for name in layers if f"\n{name}\n" in text} == layers
    ET.fromstring(result.files("svg")["cam.svg"])


FILE_DESIGN = read(FILE)


def test_an_unknown_key_is_answered_with_those_of_the_form() -> None:
    for table, key, known, foreign in (
        ("cam", "foo", "roller_clearance_mm", "run_in_mm"),
        ("follower", "foo", "roller2_radius_mm", "pivot_height_mm"),
        ("output", "foo", "motion_step_deg", "travel_step_mm"),
    ):
        with pytest.raises(DesignError) as caught:
            FILE_DESIGN.with_({f"{table}.{key}": 1})
        (problem,) = caught.value.problems
        assert known in problem.allowed.split(", ")
        assert foreign not in problem.allowed.split(", ")


def test_the_sheet_of_a_groove_tells_its_diameter() -> None:
    data = gearcam.build(FILE_DESIGN).files("drawing-svg")["cam_drawing.svg"].decode()
    assert "Ø110" in data
    assert "R55" not in data


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
            'not apply to a disc cam.*"groove"',
        ),
        ("outer_diameter_mm = 110\n", "", "cam.outer_diameter_mm", "is missing"),
        ("groove_depth_mm = 12\n", "", "cam.groove_depth_mm", "is missing"),
        ("depth_mm = 12", "depth_mm = 20", "cam.groove_depth_mm", "no floor.*thickness_mm = 20 mm"),
        (
            "_mm = 6",
            "_mm = 6\nroller2_radius_mm = 6",
            "follower.roller2_radius_mm",
            "6: both rollers.*different",
        ),
        ('"front"', '"left"', "cam.side", '"front" or "back"'),
        ('"roller"\nroller_radius_mm = 6', '"point"', "follower.type", '"roller"'),
        ("bore_dia", "clearance_mm = 0.1\nbore_dia", "blank.clearance_mm", "roller_clearance_mm"),
        ("[output]", "[output]\nkerf_mm = 0.2", "output.kerf_mm", "for a groove, which is milled"),
        ('"stl"', '"cut-svg"', "output.files", "for a groove, which is milled"),
    ],
)
def test_what_a_groove_cannot_have_is_told_by_reading(
    old: str, new: str, key: str, words: str
) -> None:
    found = refused(FILE, (old, new))
    assert key in found
    assert re.search(words, found[key])


def test_keys_of_a_groove_are_refused_with_a_disc() -> None:
    found = refused(FILE, ('form = "groove"', 'form = "disc"'))
    assert set(found) == {
        f"cam.{key}"
        for key in ("outer_diameter_mm", "groove_depth_mm", "roller_clearance_mm", "side")
    }


def test_a_blank_that_the_groove_opens_is_refused_with_the_least() -> None:
    farthest = math.hypot(8.0, math.sqrt(836.0) + 10.0) + 6.025
    with pytest.raises(InfeasibleError, match="opens the edge") as caught:
        _ = gearcam.build(read(FILE, ("outer_diameter_mm = 110", "outer_diameter_mm = 90"))).cam
    assert caught.value.limit == pytest.approx(2.0 * farthest, rel=1e-14)
    just = 2.0 * farthest + 1e-6
    result = gearcam.build(read(FILE, ("outer_diameter_mm = 110", f"outer_diameter_mm = {just!r}")))
    thin = [one for one in result.findings if one.code == "thin-wall"]
    assert [one.value for one in thin] == [pytest.approx(0.0, abs=2e-3)]
    assert "groove and the outline" in thin[0].message


def test_a_remedy_for_a_blank_that_is_opened_works() -> None:
    result = gearcam.build(read(FILE, ("outer_diameter_mm = 110", "outer_diameter_mm = 90")))
    found = gearcam.remedies(result, patience=5.0).found
    assert any("outer_diameter_mm" in str(one.changes) for one in found)


def test_a_thin_floor_is_told() -> None:
    result = gearcam.build(read(FILE, ("depth_mm = 12", "depth_mm = 19.5")))
    thin = [one for one in result.findings if one.code == "thin-wall"]
    assert [one.value for one in thin] == [pytest.approx(0.5)]
    assert "floor" in thin[0].message


@pytest.mark.parametrize(("tool", "count"), [(12.04, 0), (12.06, 1)])
def test_a_tool_wider_than_the_groove_is_told(tool: float, count: int) -> None:
    result = gearcam.build(
        read(FILE, ("[output]", f"[limits]\ntool_diameter_mm = {tool}\n[output]"))
    )
    assert [one.code for one in result.findings].count("tool-too-large") == count


def test_a_bore_that_reaches_the_groove_is_refused() -> None:
    with pytest.raises(InfeasibleError):
        _ = gearcam.build(
            read(FILE, PLAIN, ("bore_diameter_mm = 16", "bore_diameter_mm = 60"))
        ).parts
