"""The command ``sweep``: what it says, writes and refuses."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import polars as pl
import pytest

import gearcam as gc
from gearcam.cli import main
from gearcam.sweeps.rows import measured
from helpers_processes import ENVIRONMENT

TEXT = """
kind = "gear-pair"
[law]
type = "ellipse"
eccentricity = 0.3
[pair]
module_mm = 1
teeth = [20, 20]
[output]
files = ["csv"]
"""


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    Path("pair.toml").write_text(TEXT)
    return "pair.toml"


def table(folder: str = "out") -> pl.DataFrame:
    return pl.read_csv(f"{folder}/sweep.csv").drop("time_s")


def test_a_sweep_has_every_fact_of_every_variant(
    file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--set", "law.eccentricity=0.1:0.3:0.1", "--set", "pair.teeth=[20,20],[24,24]"]
    assert main(["sweep", file, *words, "-o", "out", "--jobs", "1"]) == 0
    said = capsys.readouterr().out
    assert "6 variants; 1 process" in said
    assert "6 built" in said
    found = table()
    assert found["law.eccentricity"].to_list() == [0.1, 0.1, 0.2, 0.2, 0.3, 0.3]
    design = gc.load(file).with_({"law.eccentricity": 0.2, "pair.teeth": [24, 24]})
    record = gc.build(design).record()
    row = found.row(3, named=True)
    assert {name: row[name] for name in record} == {
        name: None if value == "" else value for name, value in record.items()
    } | {"pair.teeth": "[24, 24]"}
    assert main(["sweep", file, *words, "-o", "out", "--jobs", "2"]) == 0  # nothing left to do
    assert "6 are there" in capsys.readouterr().out


def test_the_table_of_the_file_is_swept_and_settings_come_first(file: str) -> None:
    more = '[sweep]\nlaw.eccentricity = "0.1:0.4"\npair.module_mm = [1, 2]\nlatin = 4\n'
    Path(file).write_text(TEXT + more)
    assert main(["sweep", file, "-o", "out", "--jobs", "1", "--set", "pair.module_mm=3"]) == 0
    assert table()["pair.module_mm"].to_list() == [3] * 4
    assert len(set(table()["law.eccentricity"].to_list())) == 4


def test_refused_variants_have_their_reason(file: str) -> None:
    words = ["--set", "law.eccentricity=0.2,0.99", "-o", "out", "--jobs", "1"]
    assert main(["sweep", file, *words]) == 0
    good, bad = table()["refusal"].to_list()
    assert good is None
    assert bad
    words[1:4] = ["law.eccentricity=0.98,0.99", "-o", "bad"]
    assert main(["sweep", file, *words]) == 3


def test_studies_named_by_the_output_are_in_the_table(file: str) -> None:
    words = ["--set", 'output.studies=["mesh"]', "--set", "meshing.steps=12", "-o", "out"]
    assert main(["sweep", file, *words, "--jobs", "1"]) == 0
    assert any(name.startswith("meshing.") for name in table().columns)


def test_findings_are_counted_once_with_a_study_too() -> None:
    design = gc.load("profiles/nail_machine_two_phase.toml")
    studied = design.with_({"output.studies": ["mesh"], "meshing.steps": 12})
    row = measured(studied, 0, {})
    findings = gc.build(studied).findings
    assert row.warnings == sum(one.severity == "warning" for one in findings) == 1
    assert set(row.findings) == {one.code for one in findings}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "nothing is to be varied"),
        (["--set", "law.excentricity=0.1,0.2"], "did you mean eccentricity"),
        (["--set", "law.eccentricity=0.1:0.5"], "has no step"),
        (["--set", "law.eccentricity=0.1:0.5:-1"], "a step of -1 does not lead"),
        (["--set", "law.eccentricity=0.1:0.5:3e-7"], "1333334 variants"),
        (["--set", "law.eccentricity=0.1,0.2", "--random", "0"], "is not a number of samples"),
        (["--set", "law.eccentricity=0.1:0.2", "--random", "3", "--latin", "3"], "one of them"),
        (["--set", "law.eccentricity=0.1,0.2", "--jobs", "0"], "above 0"),
        (["--set", "law.eccentricity=0.1,0.2", "--limit", "-3"], "above 0"),
    ],
)
def test_mistakes_are_said_before_anything_runs(
    file: str, words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["sweep", file, "-o", "out", *words]) == 2
    assert message in capsys.readouterr().err
    assert not Path("out").exists()


def test_the_folder_of_another_sweep_is_left_alone(
    file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["sweep", file, "--set", "pair.module_mm=1,2", "-o", "out", "--jobs", "1"]) == 0
    before = Path("out/sweep.csv").read_bytes()
    assert main(["sweep", file, "--set", "pair.module_mm=1,3", "-o", "out"]) == 2
    assert "another sweep (varied: pair.module_mm=1,2)" in capsys.readouterr().err
    assert Path("out/sweep.csv").read_bytes() == before


RANGE = ["--set", "law.eccentricity=0.1:0.4:0.0125"]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> pl.DataFrame:
    """The table of a sweep that nothing ended."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "pair.toml").write_text(TEXT)
    words = ["sweep", str(folder / "pair.toml"), *RANGE, "--jobs", "1"]
    assert main([*words, "-o", str(folder / "out")]) == 0
    return table(str(folder / "out"))


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_a_sweep_that_was_ended_goes_on(file: str, number: int, whole: pl.DataFrame) -> None:
    command = [sys.executable, "-m", "gearcam", "sweep", file, "-o", "out", "--jobs", "1", *RANGE]
    running = subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=-1)
    log = Path("out/sweep.log")
    end = time.monotonic() + 20.0
    while time.monotonic() < end and (not log.exists() or log.read_bytes().count(b"\n") < 6):
        time.sleep(0.02)
    os.kill(running.pid, number)
    _, errors = running.communicate(timeout=20)
    if number == signal.SIGINT:
        assert running.returncode == 130
        assert b"the same command goes on" in errors
        assert Path("out/sweep.csv").exists()
    lines = log.read_bytes().count(b"\n") - 1
    assert 4 < lines < len(whole)
    assert main([*command[3:]]) == 0
    assert log.read_bytes().count(b"\n") == 1 + len(whole)
    assert table().equals(whole)
