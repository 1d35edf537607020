"""The command ``optimize``: what it finds, writes and refuses."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import polars as pl
import pytest

import gearcam as gc
from gearcam.cli import main
from gearcam.sweeps.pool import Processes
from gearcam.sweeps.rows import Built, measured
from helpers_pairs import PROFILES

CAM = """
kind = "cam"
[[motion]]
type = "rise"
law = "cycloidal"
angle_deg = 100
lift_mm = 20
[[motion]]
type = "return"
law = "3-4-5"
angle_deg = 80
[[motion]]
type = "dwell"
angle_deg = "rest"
[follower]
type = "roller"
roller_radius_mm = 5
[cam]
prime_radius_mm = 60
[output]
files = ["csv"]
[sweep]
cam.prime_radius_mm = "20:100"
follower.offset_mm = "-20:20"
[goal]
minimize = "cam.profile.radius_mm.max"
findings = "warning"
trials = 200
"""

PAIR = """
kind = "gear-pair"
[law]
type = "ellipse"
eccentricity = 0.3
[pair]
module_mm = 1
teeth = [24, 24]
[output]
files = ["csv"]
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("cam.toml").write_text(CAM)
    Path("pair.toml").write_text(PAIR)
    return tmp_path


def test_the_best_is_written_with_a_table_and_a_page(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["optimize", "cam.toml", "-o", "out", "--trials", "40", "--jobs", "1"]) == 0
    said = capsys.readouterr().out
    assert "scipy, since there is one goal; 40 trials" in said
    best = gc.build(gc.load("out/best.toml"))
    assert not best.findings
    size = "cam.profile.radius_mm.max"
    table = pl.read_csv("out/optimize.csv")
    assert len(table) == 40
    taken = table.filter(pl.col("refusal").is_null() & pl.col("findings").is_null())
    assert 0 < len(taken) < 40
    assert best.facts[size] == taken[size].min()
    assert {one.name for one in (folder / "out").iterdir()} >= {
        "optimize.log", "optimize.csv", "optimize.html", "best.toml",
    }  # fmt: skip


@pytest.mark.slow
def test_a_search_goes_on_from_its_log_and_is_the_same_for_two_processes(folder: Path) -> None:
    goals = ("cam.profile.radius_mm.max", "cam.pressure_angle_deg.max")
    words = ["optimize", "cam.toml", "--trials", "18", "--set", "motion[0].angle_deg=90:120:10"]
    words += [word for name in goals for word in ("--minimize", name)]
    assert main([*words, "-o", "one", "--jobs", "1"]) == 0
    assert main([*words, "-o", "two", "--jobs", "2"]) == 0
    tables = [pl.read_csv(f"{name}/optimize.csv").drop("time_s") for name in ("one", "two")]
    assert tables[0].equals(tables[1])
    log = folder / "one" / "optimize.log"
    lines = log.read_bytes().splitlines(keepends=True)
    log.write_bytes(b"".join(lines[:12]))
    assert main([*words, "-o", "one", "--jobs", "1"]) == 0
    assert log.read_bytes().splitlines(keepends=True)[:12] == lines[:12]
    assert pl.read_csv("one/optimize.csv").drop("time_s").equals(tables[0])
    # several goals: the trials that no other one surpasses, each a file that builds
    found = sorted((folder / "one").glob("best-*.toml"))
    taken = tables[0].filter(pl.col("refusal").is_null() & pl.col("findings").is_null())
    front = {
        (a, b)
        for a, b in taken.select(goals).rows()
        if not any(c <= a and d <= b and (c, d) != (a, b) for c, d in taken.select(goals).rows())
    }
    records = [gc.build(gc.load(one)).record() for one in found]
    assert {tuple(one[name] for name in goals) for one in records} == front
    assert len(front) > 1


@pytest.mark.slow
def test_the_best_of_a_design_with_a_file_builds_from_any_folder(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "given").mkdir()
    for end in ("toml", "csv"):
        shutil.copy(PROFILES / f"measured_cam.{end}", folder / "given")
    words = ["--set", "cam.prime_radius_mm=40:60", "--minimize", "cam.profile.radius_mm.max"]
    words += ["--method", "random", "--trials", "2", "--jobs", "1", "-o", "out"]
    assert main(["optimize", "given/measured_cam.toml", *words]) == 0
    best = Path("out/best.toml")
    mine = best.read_text() + "# mine\n"
    best.write_text(mine)
    assert main(["optimize", "given/measured_cam.toml", *words]) == 0
    assert Path("out/best.1.toml").read_text() == mine != best.read_text()
    least = pl.read_csv("out/optimize.csv")["cam.profile.radius_mm.max"].min()
    for place, file in (("out", "best.toml"), ("given", "../out/best.toml")):
        monkeypatch.chdir(folder / place)
        assert gc.build(gc.load(file)).facts["cam.profile.radius_mm.max"] == least


GOAL = ["--minimize", "pair.ratio.max"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "no goal is given"),
        (["--minimize", "pair.ratio.maxx"], "no fact of this design allowed: such as pair.ratio.m"),
        (["--maximize", "mesh"], 'goal.maximize: "mesh" is no fact of this design allowed: such'),
        (["--minimize", "gears.0.cutter"], 'is not a number: "rack"'),
        (["--minimize", "pair.ratio.max", "--maximize", "pair.ratio.max"], "to be least too"),
        ([*GOAL, "--maximize", "pair.ratio.min", "--method", "scipy"], "searches for one goal"),
        ([*GOAL, "--trials", "0"], "goal.trials: 0 is out of range"),
        ([*GOAL, "--set", "law.eccentricity=0.5:0.1"], "the smaller number first"),
        ([*GOAL, "--set", "law.eccentricity=0.1"], "law.eccentricity has one value"),
        ([*GOAL, "--set", "goal.seed=1,2"], "a goal is not varied"),
        ([*GOAL, "--set", "meshing.steps=12.2:12.8"], "there is no whole number in 12.2:12.8"),
        ([*GOAL, "--jobs", "0"], "--jobs: is not above 0"),
    ],
)
def test_mistakes_are_said_before_anything_runs(
    folder: Path, words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    settings = [] if "--set" in words else ["--set", "law.eccentricity=0.1:0.5"]
    assert main(["optimize", "pair.toml", "-o", "out", *settings, *words]) == 2
    assert message in " ".join(capsys.readouterr().err.split())
    assert not (folder / "out").exists()


def test_a_goal_that_nothing_changes_and_another_goal_in_the_same_folder_are_said(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["optimize", "pair.toml", "-o", "out", "--trials", "3", "--jobs", "1"]
    words += ["--set", "pair.face_width_mm=5:9"]
    assert main([*words, "--minimize", "pair.ratio.max"]) == 0
    assert "pair.ratio.max is the same in all variants" in capsys.readouterr().err
    before = (folder / "out" / "optimize.log").read_bytes()
    assert main([*words, "--maximize", "pair.ratio.max"]) == 2
    assert "another sweep (goals: least pair.ratio.max)" in capsys.readouterr().err
    assert (folder / "out" / "optimize.log").read_bytes() == before


def test_an_interruption_keeps_what_is_built(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ends = [0]

    @contextmanager
    def session(*_: Any) -> Iterator[Any]:
        def build(jobs: Sequence[Any]) -> Iterator[Built]:
            for number, values in jobs[: ends[0]]:
                yield measured(gc.load("pair.toml"), number, values)
            raise KeyboardInterrupt

        yield build

    monkeypatch.setattr(Processes, "session", session)
    words = ["optimize", "pair.toml", "--set", "law.eccentricity=0.1:0.5", "-o", "out"]
    for count in (0, 2):
        ends[0] = count
        assert main([*words, "--minimize", "pair.ratio.max"]) == 130
        said = capsys.readouterr()
        assert f"  {count} trials in" in said.out
        assert "interrupted: the same command goes on" in said.err
        assert (folder / "out" / "best.toml").exists() == (count > 0)


@pytest.mark.slow
def test_a_search_without_a_variant_that_can_be_taken_says_why(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--set", "law.eccentricity=0.9:0.99", "--minimize", "pair.ratio.max"]
    assert main(["optimize", "pair.toml", "-o", "out", *words, "--trials", "6"]) == 3
    said = capsys.readouterr().err
    assert "none of 6 variants can be taken" in said
    assert (folder / "out" / "optimize.csv").exists()


def test_sizes_that_are_solved_for_have_one_known_goal() -> None:
    text = 'name = "cam"' + CAM.replace("prime_radius_mm = 60", 'prime_radius_mm = "solve"')
    design: Any = gc.loads(text)
    assert design.goal.signs == {"cam.profile.radius_mm.max": 1.0}
    for goal, message in (
        ('minimize = "motion.peak_velocity"', "sizes are not solved for this fact"),
        (
            'minimize = ["cam.profile.radius_mm.max", "cam.pressure_angle_deg.max"]',
            "sizes are solved for one goal",
        ),
    ):
        with pytest.raises(gc.DesignError, match=message):
            gc.loads(text.replace('minimize = "cam.profile.radius_mm.max"', goal))
