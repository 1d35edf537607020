"""The command mesh: settings from file and command line, files, codes, interruption."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import pytest

import gearcam
from gearcam.base.errors import DesignError
from gearcam.cli import main
from gearcam.designs import loads
from gearcam.gears.contact import FlankPairs
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.meshing import study as room
from gearcam.meshing.contact import Contacts
from gearcam.numeric.arrays import Array
from gearcam.results.kind import KINDS
from gearcam.study_commands import studied

TEXT = """
kind = "gear-pair"
name = "pair"
law = { type = "ellipse", eccentricity = 0.2 }
pair = { module_mm = 2, teeth = [20, 20] }
output = { files = ["csv"], chord_tolerance_mm = 0.01 }
meshing = { steps = 12, to_deg = 36 }
"""


@pytest.fixture
def design(tmp_path: Path) -> str:
    path = tmp_path / "pair.toml"
    path.write_text(TEXT, encoding="utf-8")
    return str(path)


def run(design: str, *options: str) -> tuple[int, Path]:
    folder = Path(design).parent / "out"
    return main(["mesh", design, "-o", str(folder), *options]), folder / "pair"


def summary(folder: Path) -> dict[str, object]:
    return json.loads((folder / "summary.json").read_text("utf-8"))


def test_rows_and_numbers_are_written(design: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, folder = run(design)
    assert code == 0
    told = capsys.readouterr().out
    assert "phases studied" in told
    assert "centre distance as mounted" in told
    assert "meshing.csv" in told
    found = summary(folder)["meshing"]
    assert isinstance(found, dict)
    assert found["steps"] == found["steps_done"] == 12
    assert found["complete"] is True
    with (folder / "meshing.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    seen = sorted({float(row["phi1_deg"]) for row in rows})
    assert seen == pytest.approx([3.0 * k for k in range(12)])
    carrying = [row for row in rows if row["carries"] == "1.0"]
    assert all(row["pressure_angle_deg"] and float(row["area_mm2"]) > 0.0 for row in carrying)
    idle = [row for row in rows if row["carries"] == "0.0"]
    assert all(row["pressure_angle_deg"] == "" for row in idle)


def test_options_stand_before_the_file(design: str) -> None:
    code, folder = run(
        design, "--steps", "5", "--from", "-3", "--to", "7", "--overclosure", "-0.01"
    )
    found = summary(folder)["meshing"]
    assert code == 0
    assert isinstance(found, dict)
    assert (found["steps"], found["overclosure_deg"]) == (5, pytest.approx(-0.01))


def test_contact_ratio_is_told_for_the_mounting_only(design: str) -> None:
    """Below a limit as designed, above it a little nearer: what holds as designed is not told."""
    path = Path(design)
    path.write_text(TEXT + "[limits]\ncontact_ratio = 1.6\n", encoding="utf-8")
    loaded = gearcam.load(design)
    assert isinstance(loaded, GearPairDesign)
    made = gearcam.build(loaded)
    assert "contact-ratio" in {found.code for found in made.findings}
    distance = made.pair.center_distance
    for more, told in ((0.0, True), (-0.2, False)):
        _, folder = run(design, "--center", str(distance + more))
        findings = summary(folder)["findings"]
        assert isinstance(findings, list)
        assert ("contact-ratio" in {found["code"] for found in findings}) == told


def test_a_close_mounting_ends_with_an_error(design: str) -> None:
    loaded = gearcam.load(design)
    assert isinstance(loaded, GearPairDesign)
    pair = gearcam.build(loaded).pair
    code, folder = run(design, "--center", f"{pair.center_distance - 0.05}")
    assert code == 1
    findings = summary(folder)["findings"]
    assert isinstance(findings, list)
    assert findings[0]["code"] == "interference"
    assert findings[0]["severity"] == "error"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--steps", "0"], "meshing.steps"),
        (["--overclosure", "0"], "no flanks overlap"),
        (["--overclosure", "nan"], "meshing.overclosure_deg"),
        (["--from", "40"], "before it begins"),
        (["--teeth", "21"], "21: the driver has no such tooth"),
        (["--teeth", "2,2"], "listed twice"),
        (["--teeth", "two"], "is not a list such as"),
        (["--center", "-1"], "meshing.center_distance_mm"),
    ],
)
def test_a_wrong_setting_is_refused(
    design: str, options: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, folder = run(design, *options)
    assert code == 2
    assert words in capsys.readouterr().err
    assert not folder.exists()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--center", "500"], "do not mesh"),
        (["--teeth", "12"], "use more steps or another range"),
        (["--overclosure", "1e-9"], "is enough"),
    ],
)
def test_an_impossible_setting_says_what_is_possible(
    design: str, options: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, folder = run(design, *options)
    assert code == 3
    assert words in " ".join(capsys.readouterr().err.split())
    assert not folder.exists()


def test_files_of_builds_and_studies_stay_until_the_design_changes(design: str) -> None:
    out = str(Path(design).parent / "out")
    assert main(["build", design, "-o", out]) == 0
    _, folder = run(design)
    assert (folder / "gear1_outline.csv").exists()
    listed = summary(folder)["files"]
    assert isinstance(listed, dict)
    assert {"gear1_outline.csv", "meshing.csv"} <= set(listed)
    assert main(["check", design, "-o", out]) == 0
    assert (folder / "meshing.csv").exists()
    assert main(["build", design, "-o", out]) == 0
    assert (folder / "meshing.csv").exists()
    path = Path(design)
    text = path.read_text("utf-8")
    path.write_text(text.replace("chord_tolerance_mm = 0.01", "chord_tolerance_mm = 0.02"))
    assert main(["build", design, "-o", out]) == 0
    assert not (folder / "meshing.csv").exists()


def test_an_interruption_keeps_the_steps_done(
    design: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    natural = room.contacts

    def stop(pairs: FlankPairs, phi1: Array) -> Contacts:
        if phi1[0] > 0.0:  # of the second block
            raise KeyboardInterrupt
        return natural(pairs, phi1)

    monkeypatch.setattr(room, "contacts", stop)
    monkeypatch.setattr(room, "BLOCK", 5)
    code, folder = run(design)
    assert code == 130
    assert "5 of 12 steps were written" in capsys.readouterr().err
    found = summary(folder)["meshing"]
    assert isinstance(found, dict)
    assert (found["complete"], found["steps_done"]) == (False, 5)
    last = (folder / "meshing.csv").read_text("ascii").splitlines()[-1]
    assert float(last.split(",")[1]) == pytest.approx(12.0)


def test_an_interruption_before_the_first_step_writes_nothing(
    design: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(room, "first_touch", stop)
    code, folder = run(design)
    assert code == 130
    assert not folder.exists()


def test_settings_from_python_meet_the_same_rules() -> None:
    mesh = KINDS["gear-pair"].studies["mesh"]
    design = studied(mesh, loads(TEXT), {"overclosure_deg": -0.5, "teeth": [3, 4]})
    assert design.meshing.overclosure == pytest.approx(math.radians(-0.5))
    assert design.meshing.teeth == (3, 4)
    assert design.meshing.steps == 12
    with pytest.raises(DesignError, match=r"meshing\.overclosure_deg"):
        studied(mesh, design, {"overclosure_deg": 2})


def test_a_study_without_a_beginning_begins_at_zero() -> None:
    """Ends just above 0 are taken, an end at 0 is not."""
    design = loads(TEXT.replace("36", "0.5"))
    assert isinstance(design, GearPairDesign)
    assert design.meshing.end == pytest.approx(math.radians(0.5))
    with pytest.raises(DesignError, match="would end before it begins, at from_deg = 0"):
        loads(TEXT.replace("36", "0"))


def test_progress_is_told(design: str) -> None:
    calls: list[tuple[str, int, int]] = []
    job = GearPairResult(gearcam.load(design))
    job.mesh(progress=lambda *call: calls.append(call))
    assert calls[0] == ("meshing", 0, 12)
