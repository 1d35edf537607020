"""Conjugate cams: keys, refusals with what is feasible, parts, files, facts, charts, follow."""

from __future__ import annotations

import io
import math
import re
from pathlib import Path as File
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.cams.conjugate import ConjugateCam
from gearcam.cams.follow import follow
from gearcam.cli import main
from gearcam.pictures.drawings import Path
from gearcam.results.advice import Search
from helpers_files import read, refused
from helpers_pairs import PROFILES
from helpers_sampling import few

PATH = PROFILES / "conjugate_cams.toml"
FILE = PATH.read_text("utf-8")
SLIDING = FILE.replace("lift_deg", "lift_mm").replace('motion = "oscillating"\n', "")
for _line in ("pivot_distance_mm = 100\n", "arm_mm = 90\n", "arm2_mm = 85\n"):
    SLIDING = SLIDING.replace(_line, "")
PRIME2 = ("prime_radius2_mm = 38", "")
ROLLERS = "preload_mm = 0.02"


@pytest.mark.parametrize(
    ("file", "change", "key", "words"),
    [
        (FILE, PRIME2, "cam.prime_radius2_mm", "missing.*follower.arms_angle_deg"),
        (SLIDING, PRIME2, "cam.prime_radius2_mm", "missing.*follower.roller_distance_mm"),
        (FILE, (ROLLERS, "arms_angle_deg = 65"), "follower.arms_angle_deg", "is given beside"),
        (
            FILE,
            (ROLLERS, "roller_distance_mm = 9"),
            "follower.roller_distance_mm",
            "to an oscillating",
        ),
        (SLIDING, (ROLLERS, "arms_angle_deg = 65"), "follower.arms_angle_deg", "not apply"),
        (SLIDING, (ROLLERS, "arm2_mm = 65"), "follower.arm2_mm", "not apply to a translating"),
        (FILE, ('"roller"\nmotion', '"point"\nmotion'), "follower.type", "drive two rollers"),
        (
            FILE,
            ('"conjugate"', '"disc"'),
            "cam.gap_mm",
            'not apply to a disc cam; with.*"conjugate"',
        ),
    ],
)
def test_what_does_not_fit_is_told_by_reading(
    file: str, change: tuple[str, str], key: str, words: str
) -> None:
    found = refused(file, change)
    assert re.search(words, found[key])


def refusal(*changes: tuple[str, str], file: str = FILE) -> tuple[Any, InfeasibleError]:
    design = read(file, *changes)
    with pytest.raises(InfeasibleError) as caught:
        _ = gearcam.build(design).cam
    return design, caught.value


BY_DISTANCE = [PRIME2, (ROLLERS, "preload_mm = 0.5\nroller_distance_mm = {}")]
BY_ANGLE = [PRIME2, (ROLLERS, "preload_mm = 0.5\narms_angle_deg = {}")]
SQUEEZE = math.degrees(0.5 / 85.0)


@pytest.mark.parametrize(
    ("file", "changes", "value", "limit", "key"),
    [
        # a centred roller stands off the shaft by its own radius
        (SLIDING, BY_DISTANCE, 67.4, 40 + 20 + 8 - 0.5, "follower.roller_distance_mm"),
        (SLIDING, [("= 38 ", "= {} ")], 7.5, 8.0, "cam.prime_radius2_mm"),
        (FILE, [("= 38 ", "= {} ")], 14.9, 15.0, "cam.prime_radius2_mm"),
        (FILE, [("= 38 ", "= {} ")], 184.0, None, "cam.prime_radius2_mm"),
        (FILE, BY_ANGLE, 43.0, None, "follower.arms_angle_deg"),
        (FILE, BY_ANGLE, 204.0, 180 + 23.5564643091 - SQUEEZE, "follower.arms_angle_deg"),
    ],
)
def test_a_second_roller_without_a_place_is_refused_with_one(
    file: str, changes: list[tuple[str, str]], value: float, limit: float | None, key: str
) -> None:
    filled = [(old, new.format(value)) for old, new in changes]
    design, error = refusal(*filled, file=file)
    assert error.where == key
    assert error.value == pytest.approx(value)
    assert error.limit is not None
    if limit is not None:
        assert error.limit == pytest.approx(limit, abs=1e-9)
    inside = error.limit + math.copysign(1e-6, error.limit - value)
    assert gearcam.build(design.with_({key: inside})).cam.facts
    outside = error.limit - math.copysign(1e-6, error.limit - value)
    with pytest.raises(InfeasibleError):
        _ = gearcam.build(design.with_({key: outside})).cam


@pytest.mark.slow
def test_a_remedy_is_found_and_works() -> None:
    design, _ = refusal(("= 38 ", "= 14 "))
    found = gearcam.remedies(gearcam.build(design), patience=20.0).found
    assert any("cam.prime_radius2_mm" in one.changes for one in found)


@pytest.mark.parametrize(("pivot", "other"), few([(200.0, 130.0), (30.0, 50.0)]))
def test_a_pivot_out_of_reach_is_moved(pivot: float, other: float) -> None:
    """Of a triangle with the arm, 90, and the prime radius, 40; the second arm asks for more."""
    result = gearcam.build(read(FILE).with_({"follower.pivot_distance_mm": pivot}))
    with pytest.raises(InfeasibleError, match="cannot reach the prime circle") as caught:
        _ = result.cam
    (_, way) = caught.value.adjustments
    assert way.near == {"follower.pivot_distance_mm": other}
    search = Search(result, None, frozenset(), 60.0)
    assert search.along(way)
    assert gearcam.build(search.found[0].design).cam.facts


def test_an_arm_that_cannot_pass_is_refused() -> None:
    _, error = refusal(("arm2_mm = 85", "arm2_mm = 85\nroller2_radius_mm = 200"))
    assert error.where == "follower.roller2_radius_mm"


def volume(result: Any, number: int) -> float:
    wall, blank = result.cam.walls[number], result.design.blank
    assert blank.bore_diameter == 25.0
    return 12.0 * (wall.size.area - math.pi * 12.5**2)


PLAIN = ("keyway_width_mm = 8\nkeyway_depth_mm = 3.3", "")


def test_both_bodies_and_where_they_stand() -> None:
    result = gearcam.build(read(FILE, PLAIN))
    assert [part.name for part in result.parts] == ["cam1", "cam2"]
    for number, mesh in enumerate(result.solids.values()):
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(volume(result, number), abs=8.0)
    import trimesh

    files = result.files("stl")
    assert set(files) == {"cam1.stl", "cam2.stl", "cams.stl"}
    both: Any = trimesh.load(io.BytesIO(files["cams.stl"]), file_type="stl")
    levels = sorted({round(float(z), 6) for z in both.vertices[:, 2]})
    assert levels == [0.0, 12.0, 14.0, 26.0]
    assert both.volume == pytest.approx(volume(result, 0) + volume(result, 1), abs=16.0)


def test_a_hub_stands_on_outer_faces_only() -> None:
    hub = "hub_diameter_mm = 40\nhub_front_mm = 6\nhub_back_mm = 4"
    one, two = gearcam.build(read(FILE, (PLAIN[0], hub))).parts
    assert one.hub is not None
    assert two.hub is not None
    assert (one.hub.front, one.hub.back) == (0.0, 4.0)
    assert (two.hub.front, two.hub.back) == (6.0, 0.0)
    one, two = gearcam.build(read(FILE, (PLAIN[0], hub.replace("hub_back_mm = 4", "")))).parts
    assert one.hub is None
    assert two.thickness == 18.0


def test_files() -> None:
    result = gearcam.build(read(FILE))
    assert set(result.files("csv")) == {"profile_1.csv", "profile_2.csv", "motion.csv"}
    assert set(result.files("dxf")) == {"cam1.dxf", "cam2.dxf"}
    assert set(result.files("tool-path")) == {
        f"tool_path_{key}.{kind}" for key in "12" for kind in ("csv", "dxf")
    }
    assert set(result.files("inspection")) == {"inspection_1.csv", "inspection_2.csv"}
    assert set(result.files("cut-svg")) == {"cam1_cut.svg", "cam2_cut.svg", "cut.svg"}
    assert result.files("svg")["cams.svg"].decode().count("<circle") >= 4
    header = result.files("csv")["motion.csv"].decode().split("\n", 1)[0]
    assert header == (
        "theta_deg,s,ds,d2s,d3s,pressure_angle_1_deg,pressure_angle_2_deg,"
        "rho_pitch_1_mm,rho_pitch_2_mm,rho_profile_1_mm,rho_profile_2_mm"
    )
    assert result.chart("pressure_angle").lines[1].label == "cam 2"
    assert result.chart("curvature").lines


def test_the_follower_goes_on_beyond_both_rollers() -> None:
    result = gearcam.build(read(SLIDING))
    shapes = [one.shape for one in result.drawing.features if one.layer == "FOLLOWER"]
    up, down = (shape.points.imag for shape in shapes if isinstance(shape, Path))
    assert up[1] > up[0] > 0.0 > down[0] > down[1]


def test_the_drawing_of_each_tells_its_own_sizes() -> None:
    files = gearcam.build(read(FILE)).files("drawing-svg")
    assert set(files) == {"cam1_drawing.svg", "cam2_drawing.svg"}
    one, two = (files[f"cam{number}_drawing.svg"].decode() for number in (1, 2))
    assert "prime radius</text>" in one
    rows = ((one, "40 mm", "90 mm", "33.557"), (two, "38 mm", "85 mm", "28.298"))
    for text, prime, arm, angle in rows:
        assert f">{prime}<" in text
        assert f">{arm}<" in text
        assert angle in text
    assert ">90 mm<" not in two


def test_step_files_hold_both() -> None:
    pytest.importorskip("OCP")
    files = gearcam.build(read(FILE)).files("step")
    assert set(files) == {"cam1.step", "cam2.step", "cams.step"}
    text = files["cams.step"].decode()
    assert text.count("MANIFOLD_SOLID_BREP(") == 2
    assert re.search(r"CARTESIAN_POINT\('',\(0\.,0\.,14\.\)\)", text)


@pytest.mark.parametrize("rotation", few(["cw", "ccw"]))
@pytest.mark.parametrize("file", [FILE, SLIDING])
def test_each_follows_its_own_file(file: str, rotation: str, tmp_path: File) -> None:
    turned = ('form = "conjugate"', f'form = "conjugate"\nrotation = "{rotation}"')
    result = gearcam.build(read(file, turned))
    written = result.write(tmp_path, files=["csv", "dxf"])
    for key in "12":
        for name in (f"profile_{key}.csv", f"cam{key}.dxf"):
            study = result.follow(written.directory / name, wall=key)
            assert np.abs(study.columns["difference"]).max() < 2.5e-3
    with pytest.raises(DesignError, match="wall"):
        result.follow(written.directory / "profile_1.csv", wall="3")


def test_the_command_follows_either(tmp_path: File, capsys: pytest.CaptureFixture[str]) -> None:
    written = gearcam.build(read(FILE)).write(tmp_path, files=["csv"])
    profile = str(written.directory / "profile_2.csv")
    assert main(["follow", str(PATH), profile, "--wall", "2", "-o", str(tmp_path)]) == 0
    assert "largest difference" in capsys.readouterr().out
    # the first roller on the second cam finds another motion
    assert main(["follow", str(PATH), profile, "-o", str(tmp_path)]) in (0, 1)


def test_the_picture_shows_two_tints_and_both_rollers_on_top() -> None:
    text = gearcam.build(read(FILE)).files("svg")["cams.svg"].decode()
    fills = [re.search(rf'class="{name}-profile" fill="(#\w+)"', text) for name in ("cam1", "cam2")]
    first, second = (found and found[1] for found in fills)
    assert None not in (first, second)
    assert first != second
    assert 'fill-opacity="0.6"' in text
    assert text.rindex('class="cam2-') < text.index('class="follower"')


def test_facts() -> None:
    result = gearcam.build(read(FILE))
    cam = result.cam
    assert isinstance(cam, ConjugateCam)
    facts = result.facts.document["cam"]
    assert facts["arms_angle_deg"] == pytest.approx(math.degrees(cam.apart))
    assert facts["preload_mm"] == 0.02
    assert facts["cam2"]["prime_radius_mm"] == pytest.approx(38.0, abs=1e-12)
    assert facts["cam2"]["base_radius_mm"] == pytest.approx(30.0, abs=1e-12)
    assert facts["cam2"]["roller_radius_mm"] == 8.0
    assert facts["cam2"]["arm_mm"] == 85.0
    assert facts["cam1"]["curvature"]["pitch_min_mm"] > 0.0
    words = [one.meaning for one in result.facts.quantities()]
    assert "smallest convex radius, profile of cam 2" in words
    assert "pressure angle, rise, profile of cam 1" in words
    parts = result.facts.document["part"]
    assert len(parts) == 2


STEEP = SLIDING.replace("angle_deg = 120", "angle_deg = 40").replace("_deg = 60", "_deg = 140")


def test_an_undercut_second_cam_is_told_as_such() -> None:
    changes = (
        ("prime_radius2_mm = 38", "prime_radius2_mm = 22"),
        ("preload_mm = 0.02", "roller2_radius_mm = 14"),
        (PLAIN[0], ""),
        ("= 25", "= 5"),
    )
    result = gearcam.build(read(STEEP, *changes))
    second = result.cam.walls[1]
    assert second.corners
    found = [one for one in result.findings if one.code == "undercut"]
    assert {one.where.partition(",")[0] for one in found} >= {"profile of cam 2"}
    # the follower itself, on the trimmed outline, misses as much as is said; it stands too high
    theta = np.linspace(0.0, 360.0, 7201)
    lift = follow(second.outline, second.follower, np.radians(theta)).lift
    high = lift - second.program.derivatives(np.radians(theta), 0)[0]
    assert high.max() == pytest.approx(second.shortfall, abs=5e-3)
    assert second.shortfall > 0.05
