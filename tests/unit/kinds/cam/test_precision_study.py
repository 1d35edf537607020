"""The study of precision: facts, findings, columns and charts, and tolerances that do not apply."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.cli import main
from helpers_built import built
from helpers_files import PLATE, ROLLER, SWINGING, refused, table

_TOLERANCES = {
    "profile_tolerance_mm": 0.02, "radius_tolerance_mm": 0.01, "offset_tolerance_mm": 0.05,
    "cam_angle_tolerance_deg": 0.1,
}  # fmt: skip


def _result(settings: Mapping[str, Any], profile: str = "plate_cam_offset_roller") -> Any:
    design = gc.load(f"profiles/{profile}.toml")
    return built(design.with_({f"precision.{key}": value for key, value in settings.items()}))


def _facts(settings: Mapping[str, Any], profile: str = "plate_cam_offset_roller") -> dict[str, Any]:
    return _result(settings, profile).study("precision").to_dict()["precision"]


@pytest.mark.parametrize(
    ("combined", "key"),
    [("worst-case", "worst_case_mm"), ("root-of-squares", "root_of_squares_mm")],
)
def test_tolerances_with_equal_shares_just_keep_the_wanted_error(combined: str, key: str) -> None:
    wanted = {"lift_error_mm": 0.07, "combined": combined}
    sizes = _facts(_TOLERANCES | wanted)["sizes"]
    shared = {
        f"{size}_tolerance_{unit}": facts[f"allowed_together_{unit}"]
        for size, facts in sizes.items()
        for unit in ("mm", "deg")
        if f"allowed_together_{unit}" in facts
    }
    assert shared.keys() == _TOLERANCES.keys()
    again = _facts(shared | wanted)
    assert math.isclose(again[key], 0.07, rel_tol=1e-9)
    # equal shares: each alone makes the same deviation
    parts = [facts["deviation_mm"] for facts in again["sizes"].values() if facts["deviation_mm"]]
    assert len(parts) == 4
    assert np.allclose(parts, parts[0], rtol=1e-9)


@pytest.mark.parametrize("size", ["profile_mm", "offset_mm", "axis_deg", "cam_angle_deg"])
def test_a_tolerance_alone_just_keeps_the_wanted_error(size: str) -> None:
    name, _, unit = size.rpartition("_")
    alone = _facts({"lift_error_mm": 0.07})["sizes"][name][f"allowed_alone_{unit}"]
    found = _facts({f"{name}_tolerance_{unit}": alone})
    assert math.isclose(found["worst_case_mm"], 0.07, rel_tol=1e-9)
    assert math.isclose(found["root_of_squares_mm"], 0.07, rel_tol=1e-9)


def test_a_finding_names_the_share_of_the_tolerances_that_keeps_the_wanted_error() -> None:
    worst = _facts(_TOLERANCES)["worst_case_mm"]
    kept = _result(_TOLERANCES | {"lift_error_mm": worst * (1.0 + 1e-6)}).study("precision")
    assert not kept.study_findings
    (finding,) = (
        _result(_TOLERANCES | {"lift_error_mm": worst * (1.0 - 1e-6)})
        .study("precision")
        .study_findings
    )
    assert (finding.code, finding.severity) == ("lift-error", "warning")
    assert finding.value == pytest.approx(worst)
    assert "worst case" in finding.message
    wanted = {"lift_error_mm": 0.5 * worst}
    (finding,) = _result(_TOLERANCES | wanted).study("precision").study_findings
    share = float(finding.message.rpartition(" With ")[2].partition(" %")[0]) / 100.0
    assert share == pytest.approx(0.5, rel=1e-2)
    less = {key: share * value for key, value in _TOLERANCES.items()}
    assert not _result(less | wanted).study("precision").study_findings


def test_the_root_of_squares_is_kept_where_the_worst_case_is_not() -> None:
    found = _facts(_TOLERANCES)
    wanted = 0.5 * (found["worst_case_mm"] + found["root_of_squares_mm"])
    given = _TOLERANCES | {"lift_error_mm": wanted}
    assert _result(given).study("precision").study_findings
    rooted = _result(given | {"combined": "root-of-squares"}).study("precision")
    assert not rooted.study_findings


def test_without_tolerances_there_are_sensitivities_only() -> None:
    study = _result({}).study("precision")
    facts = study.to_dict()["precision"]
    assert "worst_case_mm" not in facts
    assert {*facts["sizes"]["offset"]} == {
        "tolerance_mm", "sensitivity_mm_per_mm", "deviation_mm",
    }  # fmt: skip
    assert {*study.charts} == {"sensitivity_mm", "sensitivity_deg"}
    assert not any("worst" in name for name in study.columns)


def test_columns_are_sums_of_sensitivities_times_tolerances() -> None:
    columns = _result(_TOLERANCES).study("precision").columns
    parts = [
        np.abs(columns[name]) * tolerance
        for name, tolerance in {
            "by_profile_mm_per_mm": 0.02, "by_radius_mm_per_mm": 0.01,
            "by_offset_mm_per_mm": 0.05, "by_cam_angle_mm_per_deg": 0.1,
        }.items()
    ]  # fmt: skip
    assert np.allclose(columns["worst_case_mm"], np.sum(parts, axis=0), rtol=1e-14)
    assert np.allclose(columns["root_of_squares_mm"], np.linalg.norm(parts, axis=0), rtol=1e-14)


def test_a_swinging_follower_has_degrees() -> None:
    result = _result({"arm_tolerance_mm": 0.1, "lift_error_deg": 0.05}, "plate_cam_oscillating")
    study = result.study("precision")
    columns, facts = study.columns, study.to_dict()["precision"]
    assert np.allclose(columns["worst_case_deg"], 0.1 * np.abs(columns["by_arm_deg_per_mm"]))
    # a turn of the cam moves it by the velocity of the lift, deg per deg
    velocity = result.motion()["velocity_deg_per_rad"]
    assert np.allclose(columns["by_cam_angle_deg_per_deg"], np.radians(velocity), atol=1e-12)
    assert facts["wanted_deg"] == pytest.approx(0.05)
    arm = facts["sizes"]["arm"]
    assert arm["allowed_alone_mm"] == pytest.approx(0.1 * 0.05 / facts["worst_case_deg"])
    assert arm["deviation_deg"] == pytest.approx(facts["worst_case_deg"])


def test_walls_have_columns_of_their_own_and_one_largest_deviation() -> None:
    study = _result(
        {"radius_tolerance_mm": 0.1, "arms_angle_tolerance_deg": 0.05}, "conjugate_cams"
    ).study("precision")
    columns, facts = study.columns, study.to_dict()["precision"]
    assert "by_arms_angle_1_deg_per_deg" not in columns
    assert np.allclose(columns["by_arms_angle_2_deg_per_deg"], 1.0)
    both = max(columns["worst_case_1_deg"].max(), columns["worst_case_2_deg"].max())
    assert both <= facts["worst_case_deg"] * (1.0 + 1e-12) <= both * 1.001


def test_cells_are_empty_where_trimming_leaves_no_contact(tmp_path: Path) -> None:
    design = gc.load("profiles/undercut_cam.toml")
    result = built(design.with_({"precision.profile_tolerance_mm": 0.1}))
    result.study("precision").write(tmp_path)
    (path,) = tmp_path.rglob("precision.csv")
    found = table(path.read_bytes())
    empty = np.isnan(found["by_profile_mm_per_mm"])
    assert 0 < empty.sum() < 0.5 * len(empty)
    assert np.array_equal(empty, np.isnan(found["worst_case_mm"]))


def test_charts_show_the_wanted_error() -> None:
    chart = _result(_TOLERANCES | {"lift_error_mm": 0.1}).study("precision").charts["precision"]
    assert [one.value for one in chart.limits] == [0.1, -0.1]
    assert [one.label for one in chart.lines] == [
        "profile", "radius", "offset", "cam angle", "worst case", "root of squares",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "key"),
    [
        (ROLLER, "arm_tolerance_mm"), (ROLLER, "pivot_distance_tolerance_mm"),
        (ROLLER, "pivot_height_tolerance_mm"), (ROLLER, "face_offset_tolerance_mm"),
        (ROLLER, "face_angle_tolerance_deg"), (ROLLER, "roller_distance_tolerance_mm"),
        (ROLLER, "arms_angle_tolerance_deg"), (ROLLER, "travel_tolerance_mm"),
        (ROLLER, "lift_error_deg"), (SWINGING, "offset_tolerance_mm"),
        (SWINGING, "axis_tolerance_deg"), (SWINGING, "lift_error_mm"),
        (SWINGING, "face_offset_tolerance_mm"), (PLATE, "cam_angle_tolerance_deg"),
    ],
)  # fmt: skip
def test_tolerances_of_what_a_mechanism_does_not_have_are_refused(text: str, key: str) -> None:
    found = refused(f"{text}\n[precision]\n{key} = 0.1\n")
    assert f"precision.{key}" in found
    assert "does not apply with" in found[f"precision.{key}"]


def test_a_point_has_no_radius() -> None:
    point = ROLLER.replace('"roller"', '"point"', 1).replace("roller_radius_mm = 6\n", "")
    found = refused(f"{point}\n[precision]\nradius_tolerance_mm = 0.1\n")
    assert "precision.radius_tolerance_mm" in found


def test_a_size_that_does_not_move_the_follower_has_no_tolerance_allowed() -> None:
    facts = _facts({"lift_error_mm": 0.1}, "flat_follower")["sizes"]
    assert "allowed_alone_mm" not in facts["offset"]
    assert "allowed_together_mm" in facts["profile"]
    facts = _facts({"lift_error_mm": 0.1, "offset_tolerance_mm": 0.1}, "flat_follower")["sizes"]
    assert "allowed_together_mm" not in facts["profile"]
    assert facts["profile"]["allowed_alone_mm"] == pytest.approx(0.1)


def test_the_command_takes_tolerances(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--arm-tolerance", "0.1", "--swing-error", "0.05", "--output", str(tmp_path)]
    assert main(["precision", "profiles/plate_cam_oscillating.toml", *options]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "largest deviation of the lift, worst case" in shown
    assert "tolerance of arm allowed, with equal shares" in shown
    assert (tmp_path / "plate_cam_oscillating" / "precision.csv").is_file()


def test_without_tolerances_the_largest_sensitivities_are_told() -> None:
    result = built("profiles/plate_cam_offset_roller.toml")
    study = result.study("precision")
    told = [one.meaning for one in study.facts.shown() if one.name.startswith("precision")]
    assert "largest sensitivity to offset" in told
    with_one = result.design.with_({"precision.offset_tolerance_mm": 0.1})
    study = gc.build(with_one).study("precision")
    told = [one.meaning for one in study.facts.shown() if one.name.startswith("precision")]
    assert "largest sensitivity to offset" not in told
