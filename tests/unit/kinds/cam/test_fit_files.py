"""Fitted designs: files, sizes, findings, refusals."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.cli import main
from gearcam.designs.writing import least_document, toml_text
from gearcam.kinds.cam.design import CamDesign
from helpers_files import table
from helpers_pairs import PROFILES
from helpers_sampling import few

ANGLES = np.arange(0.0, 360.0, 2.0)
PLATE = PROFILES / "plate_cam_offset_roller.toml"


def cycloid(x: np.ndarray) -> np.ndarray:
    return x - np.sin(2.0 * math.pi * x) / (2.0 * math.pi)


def double_dwell(lift: float, noise: float = 0.002) -> np.ndarray:
    """Up in 100 deg, 50 deg of rest, down in 80 deg."""
    up = cycloid(np.clip(ANGLES / 100.0, 0.0, 1.0))
    down = cycloid(np.clip((ANGLES - 150.0) / 80.0, 0.0, 1.0))
    return lift * (up - down) + np.random.default_rng(3).normal(0.0, noise, len(ANGLES))


def written(path: Path, lift: np.ndarray, head: str = "theta_deg,lift_mm") -> Path:
    rows = [f"{a:g},{s:.6f}" for a, s in zip(ANGLES, lift, strict=True)]
    path.write_text("\n".join([head, *rows]) + "\n", encoding="ascii")
    return path


def loaded(text: str) -> CamDesign:
    design = gearcam.loads(text)
    assert isinstance(design, CamDesign)
    return design


def test_a_lift_in_inches_is_round_in_inches(tmp_path: Path) -> None:
    file = written(tmp_path / "lift.csv", double_dwell(0.3125, 8e-5), "theta_deg,lift_in")
    result = gearcam.build(gearcam.load(PLATE).with_({"units": "inch"}))
    fitted = loaded(result.follow(file, fit=True).files["fitted.toml"].decode())
    assert fitted.to_dict()["motion"][0]["lift_in"] == pytest.approx(0.3125, rel=1e-14)


def test_a_radius_in_inches_is_round_in_inches() -> None:
    result = gearcam.build(gearcam.load(PLATE).with_({"units": "inch"}))
    larger = gearcam.build(result.design.with_({"cam.prime_radius_in": 1.53}))
    points = larger.cam.outline[::10]
    made = result.follow(points, fit=True).files["fitted.toml"].decode()
    (size,) = re.findall(r"prime_radius_in = ([\d.]+)", made)
    assert len(size) <= 8


@pytest.mark.parametrize("head", few(["theta_deg,lift_mm", "angle_deg,lift_mm"]))
def test_a_lift_becomes_a_design_that_builds(head: str, tmp_path: Path) -> None:
    file = written(tmp_path / "lift.csv", double_dwell(8.0), head)
    output = tmp_path / "output"
    assert main(["follow", str(PLATE), str(file), "--fit", "-o", str(output)]) == 0
    folder = output / "plate_cam_offset_roller"
    design = loaded((folder / "fitted.toml").read_text(encoding="utf-8"))
    assert design.name == "plate_cam_offset_roller_fitted"
    assert design.to_dict()["motion"] == [
        {"type": "rise", "law": "cycloidal", "angle_deg": 100.0, "lift_mm": 8.0},
        {"type": "dwell", "angle_deg": 50.0},
        {"type": "return", "law": "cycloidal", "angle_deg": 80.0},
        {"type": "dwell", "angle_deg": "rest"},
    ]
    given = loaded(PLATE.read_text(encoding="utf-8"))
    assert (design.follower, design.cam) == (given.follower, given.cam)
    rows = table((folder / "followed.csv").read_bytes())
    exact = double_dwell(8.0, 0.0)
    np.testing.assert_allclose(rows["s_fitted"], exact, atol=1e-9)
    np.testing.assert_allclose(rows["missed"], rows["s"] - rows["s_fitted"], atol=1e-12)
    lift = gearcam.build(design).motion(np.radians(ANGLES))["lift_mm"]
    np.testing.assert_allclose(lift, exact, atol=1e-9)


def test_the_size_follows_from_a_profile() -> None:
    given = loaded(PLATE.read_text(encoding="utf-8"))
    other = gearcam.build(given.with_({"cam.prime_radius_mm": 30.25}))
    study = gearcam.build(given).follow(other.cam.outline, fit=True)
    assert study.facts["followed.fit.lowest"] > 0.2
    text = study.files["fitted.toml"].decode()
    fitted = loaded(text)
    # the chord error of 1 um, at the normal of a cam that pushes at 16 deg
    assert fitted.cam.prime_radius == pytest.approx(30.25, abs=2e-3)
    assert fitted.motion == given.with_({"motion.3.angle_deg": "rest"}).motion
    assert {"fitted_lift", "fitted_residual"} == set(study.charts)


def test_what_noise_hides_is_said(tmp_path: Path) -> None:
    file = written(tmp_path / "lift.csv", double_dwell(8.0, 0.08))
    study = gearcam.build(gearcam.load(PLATE)).follow(file, fit=True)
    notes = [one for one in study.findings if one.code == "laws-alike"]
    assert len(notes) == 2
    assert all({"cycloidal", "3-4-5"} <= set(one.message.replace(",", "").replace(".", "").split())
               for one in notes)  # fmt: skip
    assert notes[0].severity == "note"
    assert "cannot be distinguished from" in study.files["fitted.toml"].decode()


@pytest.mark.slow
def test_a_motion_without_a_law_is_said(tmp_path: Path) -> None:
    wave = 4.0 * np.exp(2.0 * (np.cos(np.radians(ANGLES)) - 1.0))
    study = gearcam.build(gearcam.load(PLATE)).follow(
        written(tmp_path / "lift.csv", wave), fit=True
    )
    warnings = [one for one in study.findings if one.code == "unknown-law"]
    assert warnings
    assert "smoothing_tolerance_mm" in warnings[0].message
    assert warnings[0].value is not None
    assert warnings[0].value > warnings[0].limit
    assert "pivot" not in warnings[0].message  # the rows are the lift itself


@pytest.mark.slow
def test_the_sizes_of_the_follower_are_in_doubt_if_a_profile_moves_by_no_law() -> None:
    given = gearcam.load(PLATE)
    wave = "8*exp(3*(cos(theta) - 1))"
    other = gearcam.build(given.with_({"motion": {"lift": wave}}))
    study = gearcam.build(given).follow(other.cam.outline, fit=True)
    warnings = [one for one in study.findings if one.code == "unknown-law"]
    assert warnings
    assert "Offset, roller, arm and pivot are taken from the design" in warnings[0].message


def test_a_build_tells_the_fitted_design_and_errors_in_two_digits(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    written(tmp_path / "lift.csv", double_dwell(8.0, 0.01))
    table = {"file": str(tmp_path / "lift.csv"), "fit": True}
    changes = {"motion.0.lift_mm": 3, "output.studies": ["follow"], "output.files": ["csv"]}
    placeholder = gearcam.load(PLATE).with_(changes | {"follow": table})
    file = tmp_path / "plate.toml"
    file.write_text(toml_text(least_document(placeholder)), encoding="utf-8")
    assert main(["build", str(file), "-o", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert re.search(r"fitted design +lift 8 mm, prime radius 30 mm\n", said)
    errors = re.findall(r"(?:error of its|residual|noise of the rows).*?  +([0-9.e-]+) ", said)
    assert len(errors) == 7
    assert [one for one in errors if f"{float(one):.2g}" != one] == []
    assert (
        main(["follow", str(file), str(tmp_path / "lift.csv"), "--fit", "-o", str(tmp_path)]) == 0
    )
    head = capsys.readouterr().out.splitlines()[1]
    assert (
        head.strip() == "disc cam for a translating roller follower, lift 8 mm, prime radius 30 mm"
    )


REFUSED = {
    "half a turn": (ANGLES < 180.0, "theta_deg,lift_mm", "over the whole turn"),
    "another unit": (ANGLES >= 0.0, "theta_deg,lift_deg", "not a lift: line 1: the columns are"),
    "no angles": (ANGLES >= 0.0, "time,lift_mm", "not a lift: line 1: the columns are"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_wrong_rows_are_refused(case: str, tmp_path: Path) -> None:
    kept, head, message = REFUSED[case]
    lift = double_dwell(8.0)
    rows = [f"{a:g},{s:.6f}" for a, s in zip(ANGLES[kept], lift[kept], strict=True)]
    file = tmp_path / "lift.csv"
    file.write_text("\n".join([head, *rows]) + "\n", encoding="ascii")
    with pytest.raises(DesignError, match=message) as caught:
        gearcam.build(gearcam.load(PLATE)).follow(file, fit=True)
    assert "lift.csv" in str(caught.value)


def test_lifts_without_phases_are_refused(tmp_path: Path) -> None:
    result = gearcam.build(gearcam.load(PLATE))
    noise = np.random.default_rng(4).normal(0.0, 0.1, len(ANGLES))
    with pytest.raises(InfeasibleError, match="lost in its noise"):
        result.follow(written(tmp_path / "lift.csv", noise), fit=True)
    with pytest.raises(DesignError, match="never moves"):
        result.follow(written(tmp_path / "lift.csv", 0.0 * noise), fit=True)
    snail = ANGLES / 36.0  # and down at once
    with pytest.raises(InfeasibleError, match=r"return takes too few rows.*0 rows, limit 3 rows"):
        result.follow(written(tmp_path / "lift.csv", snail), fit=True)
    few = tmp_path / "few.csv"
    rows = [f"{a:g},{5 - 5 * math.cos(math.radians(a)):.6f}" for a in range(0, 360, 12)]
    few.write_text("\n".join(["theta_deg,lift_mm", *rows]), encoding="ascii")
    with pytest.raises(InfeasibleError, match=r"too few rows.*36"):
        result.follow(few, fit=True)


def test_a_missing_file_is_no_profile_either(tmp_path: Path) -> None:
    with pytest.raises(DesignError, match=r"(?s)not a profile.*no such file.*--fit"):
        gearcam.build(gearcam.load(PLATE)).follow(tmp_path / "none.csv", fit=True)


@pytest.mark.parametrize("name", ["yoke_cam", "translating_cam"])
def test_forms_whose_phases_fill_no_turn_are_refused(name: str) -> None:
    result = gearcam.build(gearcam.load(PROFILES / f"{name}.toml"))
    with pytest.raises(DesignError, match="do not fill a turn"):
        result.follow("lift.csv", fit=True)


def test_a_lift_without_fit_is_no_profile(tmp_path: Path) -> None:
    file = written(tmp_path / "lift.csv", double_dwell(8.0))
    with pytest.raises(DesignError, match=r"(?s)not a profile.*--fit"):
        gearcam.build(gearcam.load(PLATE)).follow(file)


@pytest.mark.parametrize("digits", few([8, 2]))
def test_rows_without_scatter_have_the_noise_of_their_digits(digits: int, tmp_path: Path) -> None:
    lift = double_dwell(8.0, noise=0.0)
    rows = [f"{a:g},{s:.{digits}f}" for a, s in zip(ANGLES, lift, strict=True)]
    file = tmp_path / "lift.csv"
    file.write_text("\n".join(["theta_deg,lift_mm", *rows]) + "\n", encoding="ascii")
    result = gearcam.build(gearcam.load(PLATE))
    study = result.follow(file, fit=True)
    assert not [one for one in study.study_findings if one.severity == "warning"]
    assert study.facts["followed.fit.noise"] >= 10.0**-digits / math.sqrt(12.0) * (1.0 - 1e-9)
    motion = loaded(study.files["fitted.toml"].decode()).to_dict()["motion"]
    assert [one.get("law") for one in motion] == ["cycloidal", None, "cycloidal", None]
    assert [one["angle_deg"] for one in motion[:3]] == [100.0, 50.0, 80.0]


def test_a_fit_tells_of_the_design_that_was_found(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = written(tmp_path / "lift.csv", double_dwell(8.0))
    assert main(["follow", str(PLATE), str(file), "--fit", "-o", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "lift 8 mm" in said
    assert "error of its start, rise" in said
    assert "difference from the lift of the design" not in said
