"""A summary never tells sizes that the files beside it do not have: it names what is stale."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam import build
from gearcam.base.errors import InfeasibleError
from gearcam.cli import main
from gearcam.designs import hash_of, loads
from gearcam.kinds.gear_pair.design import GearPairDesign
from helpers_interrupts import CAM
from helpers_pairs import PROFILES

PAIR = """
kind = "gear-pair"
name = "sample"

[law]
type = "ellipse"
eccentricity = 0.2

[pair]
module_mm = 2
teeth = [22, 22]

[rack]
pressure_angle_deg = 20

[meshing]
steps = 12

[limits]
tool_diameter_mm = 1

[output]
files = ["csv", "svg"]
chord_tolerance_mm = 0.01
"""


def changed(text: str, old: str, new: str) -> str:
    assert text.count(old) == 1
    return text.replace(old, new)


def design_hash(text: str) -> str:
    return hash_of(loads(text))


MEANS_THE_SAME = {
    "comment": ("[rack]", "# the rack\n[rack]   # of it"),
    "number written otherwise": ("module_mm = 2\n", "module_mm = 2.0e0\n"),
    "order of keys": ("module_mm = 2\nteeth = [22, 22]", "teeth = [22, 22]\nmodule_mm = 2"),
    "default written out": ("module_mm = 2\n", "module_mm = 2\nx = 0\n"),
    "default left out": ("[rack]\npressure_angle_deg = 20\n", ""),
    "which files": ('["csv", "svg"]', '["stl"]'),
    "meshing": ("steps = 12", "steps = 90\noverclosure_deg = 0.01"),
    "limits": ("tool_diameter_mm = 1", "tool_diameter_mm = 3"),
}
MEANS_ANOTHER = {
    "law": ("eccentricity = 0.2", "eccentricity = 0.2000000001"),
    "teeth": ("[22, 22]", "[23, 23]"),
    "module": ("module_mm = 2\n", "module_mm = 2.0000000000000004\n"),
    "rack": ("pressure_angle_deg = 20", "pressure_angle_deg = 20.00000001"),
    "blank": ("[rack]", "[blank]\nbore_diameter_mm = [0, 8]\n[rack]"),
    "steps": ("[rack]", "[steps]\ncount = 2\n[rack]"),
    "tolerance": ("chord_tolerance_mm = 0.01", "chord_tolerance_mm = 0.02"),
    "curves": ("chord_tolerance_mm = 0.01", 'dxf_curves = "lines"'),
}


@pytest.mark.parametrize(("old", "new"), MEANS_THE_SAME.values(), ids=MEANS_THE_SAME)
def test_what_means_the_same_has_the_same_hash(old: str, new: str) -> None:
    assert design_hash(changed(PAIR, old, new)) == design_hash(PAIR)


@pytest.mark.parametrize(("old", "new"), MEANS_ANOTHER.values(), ids=MEANS_ANOTHER)
def test_what_means_another_thing_has_another_hash(old: str, new: str) -> None:
    assert design_hash(changed(PAIR, old, new)) != design_hash(PAIR)


def test_one_value_for_both_wheels_is_two() -> None:
    one, two = (
        changed(PAIR, "[rack]", f"[blank]\nbore_diameter_mm = {bore}\n[rack]")
        for bore in ("8", "[8.0, 8]")
    )
    assert design_hash(one) == design_hash(two) != design_hash(PAIR)


def test_a_cam_has_a_hash_of_its_motion() -> None:
    first, later = CAM, changed(CAM, "roller_radius_mm = 6", "roller_radius_mm = 7")
    assert design_hash(first) == design_hash(first + "motion_step_deg = 1\n")
    assert design_hash(first) != design_hash(later)
    assert design_hash(first) != design_hash(first.replace("lift_mm = 5", "lift_mm = 5.5"))
    assert design_hash(first) != design_hash(first.replace('law = "cycloidal"', 'law = "harmonic"'))


TABLE = "phi1_deg,ratio\n" + "".join(
    f"{k * 30},{1 + 0.1 * (k % 12 in (1, 2, 3, 4, 5))}\n" for k in range(13)
)
"""Thirteen points of a ratio that rises and falls."""


def with_table(folder: Path, table: str) -> GearPairDesign:
    folder.mkdir(exist_ok=True)
    (folder / "points.csv").write_text(table, encoding="utf-8")
    text = changed(
        PAIR, 'type = "ellipse"\neccentricity = 0.2', 'type = "table"\nfile = "points.csv"'
    )
    (folder / "sample.toml").write_text(text, encoding="utf-8")
    design = gearcam.load(folder / "sample.toml")
    assert isinstance(design, GearPairDesign)
    return design


def test_a_table_counts_by_its_rows_not_by_its_place(tmp_path: Path) -> None:
    here = hash_of(with_table(tmp_path / "here", TABLE))
    same = "# measured\n" + TABLE.replace(",", " , ")
    assert hash_of(with_table(tmp_path / "there", same)) == here
    assert hash_of(with_table(tmp_path / "here", TABLE.replace("1.1", "1.2"))) != here


def test_files_are_told_by_the_table_that_their_law_has_read(tmp_path: Path) -> None:
    design = with_table(tmp_path, TABLE)
    before = hash_of(design)
    job = build(design)
    assert job.law is not None  # type: ignore[union-attr]
    (tmp_path / "points.csv").write_text(TABLE.replace("1.1", "1.2"), encoding="utf-8")
    assert job.write(tmp_path, files=["csv"]).summary["hash"] == before
    again = gearcam.load(tmp_path / "sample.toml")
    assert set(build(again).check(tmp_path).summary["outdated"].values()) == {before}


def test_a_cam_is_told_by_the_points_that_its_rise_has_read(tmp_path: Path) -> None:
    points = "x,y\n0,0\n0.2,0.1\n0.4,0.35\n0.6,0.65\n0.8,0.9\n1,1\n"
    table = 'type = "rise"\nlaw = "table"\nfile = "rise.csv"'
    file = tmp_path / "cam.toml"
    file.write_text(changed(CAM, 'type = "rise"\nlaw = "cycloidal"', table), encoding="utf-8")
    (tmp_path / "rise.csv").write_text(points, encoding="utf-8")
    design = gearcam.load(file)
    before = hash_of(design)
    job = build(design)
    assert job.program is not None  # type: ignore[union-attr]
    (tmp_path / "rise.csv").write_text(points.replace("0.35", "0.36"), encoding="utf-8")
    assert job.check(tmp_path).summary["hash"] == before != hash_of(gearcam.load(file))


def test_a_table_that_is_gone_is_named(tmp_path: Path) -> None:
    design = with_table(tmp_path, TABLE)
    before = hash_of(design)
    unread = replace(design, law=replace(design.law))
    (tmp_path / "points.csv").unlink()
    assert hash_of(design) == before
    design = unread
    with pytest.raises(InfeasibleError, match=r"cannot be read.*points\.csv"):
        hash_of(design)


class Desk:
    """A design file and the folder of its files."""

    def __init__(self, place: Path, text: str) -> None:
        self.file, self.out = place / "design.toml", place / "out"
        self.folder = self.out / str(loads(text).name)
        self.put(text)

    def put(self, text: str) -> None:
        self.text = text
        self.file.write_text(text, encoding="utf-8")

    def edit(self, old: str, new: str) -> None:
        self.put(changed(self.text, old, new))

    def run(self, command: str, *options: str) -> dict[str, Any]:
        assert main([command, str(self.file), *options, "-o", str(self.out)]) == 0
        found = json.loads((self.folder / "summary.json").read_text("utf-8"))
        assert found["hash"] == design_hash(self.text)
        there = {place.name for place in self.folder.iterdir()} - {"summary.json", "mine.txt"}
        assert {*found["files"], *found.get("outdated", {})} == there
        return found


OUTLINES = {"gear1_outline.csv", "gear2_outline.csv", "centrodes.csv"}


def test_files_of_the_design_as_it_is_are_not_stale(tmp_path: Path) -> None:
    desk = Desk(tmp_path, PAIR)
    now = design_hash(PAIR)
    assert desk.run("build")["files"] == dict.fromkeys({*OUTLINES, "pair.svg"}, now)
    desk.edit("steps = 12", "steps = 24")
    for found in (desk.run("check"), desk.run("mesh"), desk.run("check")):
        assert "outdated" not in found
        assert set(found["files"].values()) == {now}
    assert "meshing.csv" in found["files"]


def test_a_check_names_the_files_of_another_state(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    desk = Desk(tmp_path, PAIR)
    built = desk.run("build", "--only", "csv")
    assert "outdated" not in capsys.readouterr().out
    desk.edit("[22, 22]", "[24, 24]")
    checked = desk.run("check")
    assert (checked["files"], checked["outdated"]) == ({}, built["files"])
    told = " ".join(capsys.readouterr().out.split())
    names = ", ".join(built["files"])
    assert f"outdated: {names}: made from another version of the design; build again" in told
    desk.edit("[24, 24]", "[22, 22]")
    assert desk.run("check")["files"] == built["files"]
    assert "outdated" not in capsys.readouterr().out


@pytest.mark.slow
def test_a_study_is_new_and_the_build_stale_and_later_the_study_too(tmp_path: Path) -> None:
    desk = Desk(tmp_path, PAIR)
    first = desk.run("build", "--only", "csv")["hash"]
    desk.edit("eccentricity = 0.2", "eccentricity = 0.21")
    meshed = desk.run("mesh")
    assert meshed["files"] == {"meshing.csv": meshed["hash"]}
    assert meshed["outdated"] == dict.fromkeys(OUTLINES, first)
    desk.edit("eccentricity = 0.21", "eccentricity = 0.22")
    stale = {**dict.fromkeys(OUTLINES, first), "meshing.csv": meshed["hash"]}
    assert desk.run("check")["outdated"] == stale
    again = desk.run("mesh")
    assert again["files"] == {"meshing.csv": again["hash"]}
    assert again["outdated"] == dict.fromkeys(OUTLINES, first)
    built = desk.run("build", "--only", "csv")
    assert "outdated" not in built
    assert set(built["files"]) == {*OUTLINES, "meshing.csv"}
    desk.edit("eccentricity = 0.22", "eccentricity = 0.23")
    assert set(desk.run("build", "--only", "csv")["files"]) == OUTLINES


def test_a_followed_profile_is_new_and_the_cam_stale(tmp_path: Path) -> None:
    desk = Desk(tmp_path, CAM)
    first = desk.run("build")
    profile = tmp_path / "profile.csv"
    profile.write_bytes((desk.folder / "profile.csv").read_bytes())
    desk.edit("prime_radius_mm = 40", "prime_radius_mm = 41")
    followed = desk.run("follow", str(profile))
    assert followed["files"] == {"followed.csv": followed["hash"]}
    assert followed["outdated"] == first["files"]


def test_a_file_that_was_deleted_is_not_listed(tmp_path: Path) -> None:
    desk = Desk(tmp_path, PAIR)
    desk.run("build")
    (desk.folder / "pair.svg").unlink()
    assert set(desk.run("check")["files"]) == OUTLINES


@pytest.mark.parametrize(
    ("study", "file"),
    [
        ("forces", "forces.csv"),
        pytest.param("accuracy", "accuracy.csv", marks=pytest.mark.slow),
    ],
)
def test_what_a_study_wrote_stays_with_its_design(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], study: str, file: str
) -> None:
    """In each order of building and studying; a build of another design removes it."""
    desk = Desk(tmp_path, CAM)
    for command in (study, "build", study, "check", "build"):
        found = desk.run(command)
        assert file in found["files"]
        assert "outdated" not in found
    told = capsys.readouterr().out
    assert "removed" not in told
    assert "outdated" not in told
    desk.edit("prime_radius_mm = 40", "prime_radius_mm = 41")
    assert file not in desk.run("build")["files"]


@pytest.mark.slow
def test_a_design_file_is_neither_removed_nor_written_over(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, folder = tmp_path / "out", tmp_path / "out" / str(loads(CAM).name)
    design, rows = tmp_path / "design.toml", tmp_path / "rows.csv"
    design.write_text(CAM, encoding="utf-8")
    motion = build(loads(CAM)).motion(np.radians(np.arange(0.0, 360.0, 5.0)))  # type: ignore[attr-defined]
    pairs = zip(motion["theta_deg"], motion["lift_mm"], strict=True)
    rows.write_text("theta_deg,lift_mm\n" + "".join(f"{a},{s:.9f}\n" for a, s in pairs))

    def run(*words: str) -> dict[str, Any]:
        assert main([words[0], str(design), *words[1:], "-o", str(out)]) == 0
        found = json.loads((folder / "summary.json").read_text("utf-8"))
        assert "outdated" not in found
        return dict(found["files"])

    fit, fitted = ("follow", str(rows), "--fit"), folder / "fitted.toml"
    run("build")
    both = run(*fit)  # files of one version: that of the given design
    assert set(both.values()) == {design_hash(CAM)}
    assert {"fitted.toml", "followed.csv", "profile.csv"} <= both.keys()
    fresh = fitted.read_bytes()
    mine = fresh + b"# mine"
    fitted.write_bytes(mine)
    assert "followed.csv" in run("build")
    assert fitted.read_bytes() == mine
    assert "before" not in capsys.readouterr().out
    run(*fit)
    assert fitted.read_bytes() == fresh
    assert "fitted.1.toml  kept: what fitted.toml was before" in capsys.readouterr().out
    design.write_text(changed(CAM, "prime_radius_mm = 40", "prime_radius_mm = 41"))
    run("build")
    assert fitted.read_bytes() == fresh
    assert (folder / "fitted.1.toml").read_bytes() == mine


def test_a_file_that_the_user_has_edited_is_neither_removed_nor_written_over(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A program whose head the machinist has edited, and a table of a format that is dropped."""
    text = (PROFILES / "rotary_axis_cam.toml").read_text("utf-8")
    given = 'files = ["csv", "stl", "dxf", "svg", "tool-path", "gcode"]'
    text = changed(text, given, 'files = ["csv", "gcode"]')
    text = changed(text, "depth_mm = 1.5", "depth_mm = 5")
    text = changed(text, "[output]", "[output]\npath_tolerance_mm = 0.1")
    design, out = tmp_path / "cam.toml", tmp_path / "out"
    folder = out / "cam"

    def run(command: str, *options: str) -> tuple[set[str], str]:
        design.write_text(text, encoding="utf-8")
        assert main([command, str(design), *options, "-o", str(out)]) == 0
        listed = json.loads((folder / "summary.json").read_text("utf-8"))
        return {*listed["files"], *listed.get("outdated", {})}, capsys.readouterr().out

    first, told = run("build")
    assert "kept" not in told
    tables = first - {"cam.nc"}
    assert len(tables) > 1
    program, table = folder / "cam.nc", folder / min(tables)
    head = b"(G54 is set at the tailstock)\n"
    for place in (program, table):
        place.write_bytes(head + place.read_bytes())
    mine, rows = program.read_bytes(), table.read_bytes()
    text = changed(text, "feed_mm_min = 400", "feed_mm_min = 300")
    assert run("check")[0] == first
    listed, told = run("build", "--only", "gcode")
    assert listed == {"cam.nc"}
    told = re.sub(" +", " ", told)
    assert "cam.1.nc kept: what cam.nc was before" in told
    assert f"{table.name} kept: no longer part of this build, but you may have edited it" in told
    assert told.count("removed: no longer part of this build") == len(tables) - 1
    assert (folder / "cam.1.nc").read_bytes() == mine
    assert table.read_bytes() == rows
    assert head not in program.read_bytes()
