"""A design file to start from for each way of making the parts."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError
from gearcam.base.quantities import REQUIRED
from gearcam.cli import main
from gearcam.designs import KINDS
from gearcam.designs.template import template
from helpers_sampling import chosen

PROCESSES = [(kind, process) for kind in KINDS for process in ("", *KINDS[kind].processes)]
FILES = {"": "report", "printing": "stl", "laser": "cut-svg", "wire": "dxf", "milling": "gcode"}
"""What each process cannot do without."""


def test_every_kind_can_be_begun_for_each_process() -> None:
    flat = [kind for kind in KINDS if "cut-svg" in KINDS[kind].formats]
    assert len(flat) >= 2
    for kind in KINDS:
        cut = {"laser", "wire"} if kind in flat else set()
        printed = {"printing"} if "stl" in KINDS[kind].formats else set()
        milled = {"milling"} if "gcode" in KINDS[kind].formats else set()
        assert set(KINDS[kind].processes) == printed | cut | milled


LONG = {
    *(("spatial-cam", ""), ("globoidal-cam", ""), ("globoidal-cam", "printing")),
    *(("gear-pair", ""), ("gear-pair", "wire"), ("cam", "wire"), ("spatial-cam", "milling")),
}
"""Solids of cams in space are made for printing a cylinder cam, kerfs for the laser."""


@pytest.mark.parametrize(
    ("kind", "process"), chosen(PROCESSES, *(one for one in PROCESSES if one not in LONG))
)
def test_it_builds_without_warnings_at_a_size_that_people_make(
    kind: str, process: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", kind, "mine.toml", *(["--for", process] if process else [])]) == 0
    document = tomllib.loads(Path("mine.toml").read_text("utf-8"))
    assert main(["build", "mine.toml"]) == 0
    found = json.loads(Path("output/mine/summary.json").read_text("utf-8"))
    # a pair without backlash is noted, where no process asks for some, and that a cylinder slips
    plain = [("note", "no-backlash")] if kind == "gear-pair" and not process else []
    noted = [("note", "roller-slip")] if kind == "spatial-cam" else plain
    assert [(one["severity"], one["code"]) for one in found["findings"]] == noted
    output = document["output"]
    assert {FILES[process], "report"} <= set(output["files"])
    assert found.get("kerf_mm", 0.0) == output.get("kerf_mm", 0.0)
    assert (found.get("kerf_mm", 0.0) > 0.0) == (process in ("laser", "wire"))
    # a chord error disappears in the kerf, and fine cuts are drawn finely
    assert output.get("chord_tolerance_mm", 0.0) <= 0.15 * output.get("kerf_mm", 0.1)
    result = gc.build(gc.load("mine.toml"))
    if "gcode" in output["files"]:  # with an end mill that is sold
        assert "conical" not in Path("output/mine/cam.nc").read_text("ascii")
    # a mechanism has no solids of its own
    meshes = result.meshes if "stl" in result.kind.formats else {}
    for mesh in meshes.values():
        across = np.ptp(mesh.vertices[:, :2], axis=0)
        assert (across > 70.0).all()
        assert (across < 110.0).all()


@pytest.mark.parametrize(("kind", "process"), PROCESSES)
def test_optional_keys_show_their_default_or_say_that_they_show_an_example(
    kind: str, process: str
) -> None:
    text, known = template(kind, "mine", process), KINDS[kind]
    shown = {key for key, _ in re.findall(r"^# (\w+) = (.*?) +# \(example\)", text, re.MULTILINE)}
    for title in (*known.tables, "limits"):
        _, *parts = re.split(rf"(?m)^(?:# )?\[+{title}\]+$", text)
        part = "".join(part.partition("\n\n")[0] for part in parts)
        lines = re.findall(r"^# (\w+) = (.*?) +# (\(example\))?", part, re.MULTILINE)
        for key, value, example in lines:
            entry = known.table(title).entries[key]
            if example:
                assert entry.default in (None, REQUIRED), key
                assert (value, entry.param.example) != ("None", None), key
            else:
                default = entry.inward(tomllib.loads(f"x = {value}")["x"])
                assert default == pytest.approx(entry.default), key
    assert shown & {"module_mm", "base_radius_mm", "arm_mm", "length_mm"}


QUICK = [("cam", ""), ("gear-pair", ""), ("mechanism", "")]


@pytest.mark.parametrize(("kind", "process"), chosen(PROCESSES, *QUICK))
def test_the_goals_that_are_shown_are_facts_and_others_are_refused(
    kind: str, process: str, tmp_path: Path
) -> None:
    """Of every kind, as the file shows them: behind # of the optional table ``[goal]``."""
    before, title, after = template(kind, "mine", process).partition("# [goal]\n")
    table, end, rest = after.partition("\n\n")
    text = before + title[2:] + re.sub(r"(?m)^# (?=minimize|maximize)", "", table) + end + rest
    result = gc.build(gc.loads(text))
    goal = result.design.goal
    assert len(goal.signs) == 2
    numbers = {name for name, value in result.record().items() if isinstance(value, float)}
    assert goal.signs.keys() <= numbers
    # a letter too many: the nearest name is the right one
    (first, *_) = goal.signs
    wrong = gc.build(result.design.with_({"goal.minimize": f"{first}x"}))
    for write in (wrong.check, wrong.write):
        with pytest.raises(DesignError) as caught:
            write(tmp_path)
        (problem,) = caught.value.problems
        assert problem.key == "goal.minimize"
        assert problem.message == f'"{first}x" is no fact of this design'
        assert problem.allowed.startswith(f"such as {first}")
    assert not [*tmp_path.iterdir()]


def test_a_cam_is_described_in_words_of_cams() -> None:
    assert not re.search(r"teeth|tooth|roots|(?<!grinding.)wheel", template("cam", "mine", "laser"))


def read(process: str) -> dict[str, Any]:
    return tomllib.loads(template("gear-pair", "mine", process))


def test_what_a_process_needs() -> None:
    plain, printed, laser, wire = map(read, ("", "printing", "laser", "wire"))
    assert "backlash_mm" not in plain["pair"]
    assert printed["pair"]["backlash_mm"] >= laser["pair"]["backlash_mm"]
    assert laser["pair"]["backlash_mm"] > wire["pair"]["backlash_mm"] > 0.0
    assert printed["blank"]["clearance_mm"] > 0.0
    assert "cut-svg" in laser["output"]["files"]


@pytest.mark.parametrize(
    ("word", "hint"),
    [
        ("barrel", "spatial-cam"),
        ("cylinder-cam", "spatial-cam"),
        ("drum cam", "spatial-cam"),
        ("globoid", "globoidal-cam"),
        ("disc", "cam"),
        ("groove-cam", 'cam, with cam.form = "groove" in the file'),
        ("rack", 'gear-pair, with law.type = "rack" in the file'),
        ("gears", "gear-pair"),
        ("linkage", "mechanism"),
        ("swinging", 'cam, with follower.motion = "oscillating" in the file'),
    ],
)
def test_other_names_are_answered_with_the_file_that_shows_them(
    word: str, hint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["new", word]) == 2
    assert f"\n    did you mean {hint}?\n" in capsys.readouterr().err


@pytest.mark.parametrize("word", ["milling", "mill"])
@pytest.mark.parametrize("kind", ["cam", "globoidal-cam", "mechanism"])
def test_a_process_of_another_kind_names_it(
    kind: str, word: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["new", kind, "--for", word]) == 2
    err = capsys.readouterr().err
    assert f'--for: "{word}" is not supported for {kind}\n' in err
    command = "gearcam new spatial-cam --for milling"
    assert f"milling is for spatial-cam: {command}\n" in err
    assert main(command.split()[1:]) == 0


def test_another_process_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "cam", "--for", "lasre"]) == 2
    err = capsys.readouterr().err
    assert "did you mean laser?" in err
    assert "printing, laser, wire" in err
