"""The tables to measure and to grind a cam by, as files and for its sheet."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.cams.caliper import caliper
from gearcam.kinds.cam.calipers import sheet_table
from gearcam.kinds.cam.result import CamResult
from gearcam.kinds.spatial_cam.drawn import edge
from helpers_files import FLAT, PLATE, ROLLER, only, read, table
from helpers_pairs import PROFILES


def profile(name: str, **output: Any) -> Any:
    design: Any = gearcam.load(PROFILES / f"{name}.toml")
    return gearcam.build(replace(design, output=replace(design.output, **output)))


def rows(result: Any, kind: str, file: str) -> dict[str, Any]:
    return table(result.files(kind)[file])


def test_a_disc_has_a_radius_for_each_whole_degree() -> None:
    result = profile("eccentric_cam")
    found = rows(result, "caliper", "caliper.csv")
    assert [*found] == ["angle_deg", "radius_mm"]
    np.testing.assert_array_equal(found["angle_deg"], np.arange(360.0))
    angles = np.radians(found["angle_deg"])
    np.testing.assert_allclose(found["radius_mm"], caliper(result.cam.walls[0], angles), atol=1e-9)
    assert found["radius_mm"][[90, 270]].tolist() == [25.0, 37.0]
    assert not profile("eccentric_cam", files=("caliper", "grinding")).ordered


@pytest.mark.parametrize(("step", "count"), [(15.0, 24), (0.5, 720), (7.0, 52)])
def test_the_step_is_that_of_the_design(step: float, count: int) -> None:
    result = profile("eccentric_cam", caliper_step=math.radians(step))
    angles = rows(result, "caliper", "caliper.csv")["angle_deg"]
    np.testing.assert_allclose(angles, step * np.arange(count), rtol=1e-12)
    assert angles[-1] < 360.0


def test_grooves_and_conjugate_cams_have_a_column_for_each_wall() -> None:
    groove = rows(profile("groove_cam"), "caliper", "caliper.csv")
    assert [*groove] == ["angle_deg", "radius_inner_mm", "radius_outer_mm"]
    wide = groove["radius_outer_mm"] - groove["radius_inner_mm"]
    assert wide.min() > 12.05 - 1e-9  # two rollers and the clearance, across a slope more
    pair = rows(profile("conjugate_cams"), "caliper", "caliper.csv")
    assert [*pair] == ["angle_deg", "radius_1_mm", "radius_2_mm"]


def test_clearance_is_taken_off_as_on_the_finished_part() -> None:
    text = ROLLER.replace("[output]", "[blank]\nclearance_mm = 0.2\n[output]")
    loose, tight = (rows(CamResult(read(one)), "caliper", "caliper.csv") for one in (text, ROLLER))
    off = tight["radius_mm"] - loose["radius_mm"]
    assert off.min() > 0.199
    assert off[100] == pytest.approx(0.2, abs=1e-9)  # on the base circle


def test_a_plate_has_its_heights_above_its_lower_edge() -> None:
    result: Any = CamResult(read(PLATE))
    found = rows(result, "caliper", "caliper.csv")
    assert [*found] == ["x_mm", "height_lower_mm", "height_upper_mm"]
    assert np.all(np.diff(found["x_mm"]) == 1.0)
    low = result.cam.walls[0].plate.low
    for wall, name in zip(result.cam.walls, ("height_lower_mm", "height_upper_mm"), strict=True):
        line = wall.line[np.argsort(wall.line.real)]
        there = np.interp(found["x_mm"], line.real, line.imag, math.nan, math.nan) - low
        np.testing.assert_allclose(found[name], there, atol=2.1e-3)
    halves = rows(CamResult(read(PLATE + "caliper_step_mm = 0.5\n")), "caliper", "caliper.csv")
    np.testing.assert_allclose(halves["height_lower_mm"][::2], found["height_lower_mm"], atol=1e-9)


def test_a_cylinder_cam_has_the_heights_of_its_edges() -> None:
    for name in ("cylinder_cam", "rotary_axis_cam"):
        for rotation in ("ccw", "cw"):
            design: Any = gearcam.load(PROFILES / f"{name}.toml").with_({"cam.rotation": rotation})
            result: Any = gearcam.build(design)
            found = rows(result, "caliper", "caliper.csv")
            for wall in result.cam.walls:
                sheet = edge(result, wall, 20_000)
                x, z = np.degrees(sheet.real / result.cam.outer_radius), sheet.imag
                off = found[f"height_{wall.key}_mm"] - np.interp(found["angle_deg"], x, z)
                assert np.abs(off).max() < 2e-6


def test_the_table_of_a_sheet_is_short_and_of_its_own_part() -> None:
    pair = profile("conjugate_cams")
    first, second = (sheet_table(pair, number) for number in (0, 1))
    assert [*first] == ["angle_deg", "radius_1_mm"]
    assert [*second] == ["angle_deg", "radius_2_mm"]
    assert len(first["angle_deg"]) == 36
    whole = rows(pair, "caliper", "caliper.csv")
    np.testing.assert_allclose(second["radius_2_mm"], whole["radius_2_mm"][::10], atol=1e-9)
    assert [*sheet_table(profile("groove_cam"), 0)] == [
        "angle_deg", "radius_inner_mm", "radius_outer_mm"
    ]  # fmt: skip
    plate = sheet_table(CamResult(read(PLATE)), 0)
    assert 8 < len(plate["x_mm"]) <= 38


@pytest.mark.parametrize(("step", "shown"), [(12.0, 12.0), (4.0, 12.0), (0.5, 10.0), (30.0, 30.0)])
def test_the_table_of_a_sheet_has_steps_of_the_design(step: float, shown: float) -> None:
    result = profile("tappet", caliper_step=math.radians(step), files=("caliper", "drawing-svg"))
    rows = result.values(0).rows
    assert [float(row[0]) for row in rows] == np.arange(0.0, 360.0, shown).tolist()
    assert "Radii: caliper.csv." in [text.text for text in result.sheets[0].texts]


def test_the_lift_of_a_wheel_begins_at_its_lowest_place() -> None:
    """Below a flat face at rest on the base circle of 30 mm; a wheel of 50 mm is 80 mm away."""
    for radius, files in ((None, 30.0), ("flat", 30.0), (50.0, 80.0)):
        design = read(FLAT)
        output = replace(design.output, grinding_wheel_radius=radius)
        found = rows(CamResult(replace(design, output=output)), "grinding", "grinding.csv")
        assert [*found] == ["theta_deg", "lift_mm", "wheel_mm"]
        assert len(found["theta_deg"]) == 360
        assert found["wheel_mm"][0] == files
        assert found["lift_mm"].min() == 0.0
    # the lift of a flat wheel is that of the flat follower
    asked = CamResult(read(FLAT)).motion(np.radians(np.arange(360.0)))["lift_mm"]
    flat = rows(CamResult(read(FLAT)), "grinding", "grinding.csv")["lift_mm"]
    np.testing.assert_allclose(flat, asked, atol=2e-9)
    turned = CamResult(read(FLAT.replace("thickness_mm", 'rotation = "cw"\nthickness_mm')))
    np.testing.assert_allclose(
        rows(turned, "grinding", "grinding.csv")["lift_mm"], asked, atol=2e-9
    )


def test_a_groove_has_the_lift_of_a_wheel_in_each_wall() -> None:
    result = profile("groove_cam")
    files = result.files("grinding")
    assert set(files) == {"grinding_inner.csv", "grinding_outer.csv"}
    # as wide as the groove it runs along the pitch curve, on either wall
    inner, outer = (table(files[f"grinding_{wall}.csv"])["wheel_mm"] for wall in ("inner", "outer"))
    np.testing.assert_allclose(inner, outer, atol=2e-9)


def test_what_has_no_wheel_is_refused() -> None:
    pointed = ROLLER.replace('"roller"', '"point"').replace("roller_radius_mm = 6\n", "")
    problem = only(pointed.replace('"stl"', '"grinding"'))
    assert problem.key == "output.grinding_wheel_radius_mm"
    assert "no radius that a wheel could have" in problem.message
    read(pointed.replace('"stl"', '"grinding"') + "grinding_wheel_radius_mm = 9\n")
    with pytest.raises(InfeasibleError, match="above a cam that turns"):
        CamResult(read(PLATE)).files("grinding")
    problem = only(ROLLER + 'grinding_wheel_radius_mm = "flap"\n')
    assert 'or "flat"' in problem.allowed
