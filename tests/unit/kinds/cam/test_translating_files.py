"""Files of translating cams, and profiles that are followed."""

from __future__ import annotations

import json
import math
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.numeric.arrays import as_pairs
from gearcam.pictures.drawings import cut_drawing, reach
from helpers_files import DEEP, EDGE, PLATE, built, sliding_of
from helpers_sheets import sheet_of


def test_files_of_a_groove(tmp_path: Path) -> None:
    result = built(PLATE)
    assert set(result.files("csv")) == {"profile_lower.csv", "profile_upper.csv", "motion.csv"}
    assert set(result.files("inspection")) == {"inspection_lower.csv", "inspection_upper.csv"}
    text = result.files("dxf")["cam.dxf"].decode()
    layers = {"GROOVE", "PITCH", "BLANK", "HOLE", "CENTER"}
    assert {name for name in layers if f"\n{name}\n" in text} == layers
    for name in ("cam.svg", "cam_drawing.svg"):
        kind = "svg" if name == "cam.svg" else "drawing-svg"
        ET.fromstring(result.files(kind)[name])
    file = tmp_path / "lower.csv"
    file.write_bytes(result.files("csv")["profile_lower.csv"])
    for profile, wall in ((file, None), (result.cam.walls[1].outline, "upper")):
        study = result.follow(profile, wall=wall)
        np.testing.assert_allclose(study.columns["difference"], 0.0, atol=1.2e-3)
        assert study.columns["error"].max() < 2e-3  # a dwell's long chord is straight
    codes = [one.code for one in result.follow(result.cam.walls[1].outline).findings]
    assert "other-profile" in codes
    drawing = tmp_path / "cam.dxf"
    drawing.write_bytes(result.files("dxf")["cam.dxf"])
    with pytest.raises(DesignError, match="one closed outline"):
        result.follow(drawing)


SWUNG = (
    ('motion = "translating"', 'motion = "oscillating"\narm_mm = 60\npivot_distance_mm = 50'),
    ("radius_mm = 6", "radius_mm = 6\npivot_height_mm = 3"),
    ("lift_mm = 15", "lift_deg = 15"),
)


@pytest.mark.parametrize(
    "changes",
    [(("radius_mm = 6", "radius_mm = 6\naxis_deg = 12"),), SWUNG],
    ids=["leans", "swings"],
)
def test_both_walls_are_followed(changes: tuple[tuple[str, str], ...]) -> None:
    result = built(PLATE, *changes)
    assert len(result.cam.walls) == 2
    for wall in result.cam.walls:
        study = result.follow(wall.outline, wall=wall.key)
        lever = math.radians(60.0) if changes is SWUNG else 1.0
        assert np.abs(study.columns["difference"]).max() * lever < 1.5e-3


def test_a_profile_is_followed() -> None:
    result = built(EDGE, ("height_mm = 40", "height_mm = 40\n[output]\nchord_tolerance_mm = 1e-4"))
    study = result.follow(sliding_of(result).edge.vertices)
    difference = study.columns["difference"]
    assert np.abs(difference).max() < 2e-4
    assert study.columns["error"].max() < 0.02  # the plate's corners are no curve
    assert "travel_mm" in study.columns


def test_the_kerf_of_a_groove_that_goes_through() -> None:
    result = built(PLATE, (DEEP, ""), ("[output]", "[output]\nkerf_mm = 0.4"))
    (drawing,) = result.plates
    paths = {one.layer: one.shape for one in cut_drawing(drawing, 0.4).features}
    cam = sliding_of(result)
    assert cam.groove is not None
    groove = shapely.Polygon(as_pairs(reach(paths["GROOVE_KERF"])))
    assert groove.area == pytest.approx(cam.groove.polygon.buffer(-0.2).area, rel=1e-4)
    blank = shapely.Polygon(as_pairs(reach(paths["BLANK_KERF"])))
    assert blank.area == pytest.approx(shapely.box(0, 0, 194.1, 60).buffer(0.2).area, rel=1e-4)
    assert set(result.files("dxf")) == {"cam.dxf", "cam_reference.dxf"}


def test_the_sheet_shows_the_origin_of_its_bolts() -> None:
    """A cross, and its distances from the nearer side and from the lower edge."""
    (sheet,) = (sheet_of(part) for part in built(PLATE).parts)
    told = sorted(one.value for one in sheet.dimensions if one.kind in ("linear", "vertical"))
    assert told == pytest.approx([8.0, 12.0, 12.05, 22.5, 60.0, 194.1])
    assert any("X, Y from the cross" in text.text for text in sheet.texts)
    bolts = "bolts = 2\nbolt_diameter_mm = 6.6\nbolt_spacing_mm = 160\nbolt_height_mm = 8\n"
    bare = built(PLATE, (bolts, ""))
    assert len(sheet_of(bare.part).dimensions) == 5


def test_three_points_tell_the_curvature_of_an_open_pitch_curve() -> None:
    """The error falls: with its sign and all, the exact curvature is that of the points."""
    rows = built(EDGE).files("curvature")["curvature.csv"].decode().splitlines()
    table = dict(zip(rows[0].split(","), np.loadtxt(rows[1:], delimiter=",").T, strict=True))
    # second order but at knots, where the slope of the curvature jumps: there the first
    order = np.polyfit(np.log(table["spacing_mm"]), np.log(table["rms_error_per_mm"]), 1)[0]
    assert 1.3 < order < 2.1
    assert table["largest_error_per_mm"][-1] < 2e-5
    assert np.all(np.diff(table["spacing_mm"]) < 0.0)


def straight(follower: dict[str, Any], cam: dict[str, Any], **motion: float) -> Any:
    """A plate whose profile is straight from corner to corner."""
    rise = {"type": "rise", "law": "constant-velocity"} | motion
    document = {"kind": "cam", "name": "straight", "motion": [rise], "follower": follower}
    return gearcam.build(
        gearcam.design(
            document | {"cam": {"form": "translating"} | cam, "blank": {"height_mm": 90}}
        )
    )


def test_a_plate_of_a_few_points_is_followed() -> None:
    arm = {"type": "point", "motion": "oscillating", "arm_mm": 50, "pivot_distance_mm": 50}
    result = straight(arm, {}, lift_deg=0.09, travel_mm=60)
    outline = result.cam.walls[0].outline
    assert len(outline) < 8
    study = result.follow(outline)
    np.testing.assert_allclose(study.columns["difference"], 0.0, atol=1.1e-3)


def test_a_straight_pitch_curve_has_no_radius() -> None:
    roller = {"type": "roller", "roller_radius_mm": 7.5}
    result = straight(roller, {"thickness_mm": 5, "walls": "both"}, lift_mm=3, travel_mm=300)
    json.dumps(result.facts.document, allow_nan=False)
    assert [part.outline.shape[1] for part in result.parts] == [2]


def test_the_way_of_a_tool() -> None:
    result = built(PLATE)
    rows = result.files("tool-path")["tool_path.csv"].decode().splitlines()
    points = np.loadtxt(rows, delimiter=",", skiprows=1)
    np.testing.assert_allclose(points, as_pairs(sliding_of(result).lower.pitch_line), atol=1e-6)
    design = replace(result.design, output=replace(result.design.output, tool_radius=4.0))
    rows = gearcam.build(design).files("tool-path")["tool_path.csv"].decode().splitlines()
    path = shapely.LinearRing(np.loadtxt(rows, delimiter=",", skiprows=1))
    middle = shapely.LineString(as_pairs(sliding_of(result).lower.pitch_line))
    away = shapely.distance(shapely.points(path.coords), middle)
    np.testing.assert_allclose(away, 2.025, atol=2e-3)
    design = replace(result.design, output=replace(result.design.output, tool_radius=6.1))
    with pytest.raises(InfeasibleError):
        gearcam.build(design).files("tool-path")


def test_the_picture_stands_where_it_is_asked() -> None:
    result = built(PLATE)
    with pytest.raises(InfeasibleError, match="beyond the travel of the cam") as caught:
        built(PLATE, ("travel_mm = 80", "travel_mm = 171")).files("svg")
    assert caught.value.limit == pytest.approx(170.0)
    drawing = result.drawing
    x = reach(drawing.features[0].shape).real
    assert (x.min(), x.max()) == pytest.approx((80.0 - 182.05, 80.0 + 12.05))
