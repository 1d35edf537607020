"""A design file to start from for each way of making the parts."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest

from gearcam.cli import main
from gearcam.designs import KINDS
from gearcam.designs.template import template

PROCESSES = [(kind, process) for kind in KINDS for process in KINDS[kind].processes]


def test_every_kind_can_be_begun_for_each_process() -> None:
    for kind in KINDS:
        assert set(KINDS[kind].processes) == {"printing", "laser", "wire"}


@pytest.mark.parametrize(("kind", "process"), PROCESSES)
def test_it_builds_with_nothing_to_find(
    kind: str, process: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", kind, "mine.toml", "--for", process]) == 0
    document = tomllib.loads(Path("mine.toml").read_text("utf-8"))
    assert main(["build", "mine.toml"]) == 0
    found = json.loads(Path("output/mine/summary.json").read_text("utf-8"))
    assert found["findings"] == []
    assert found.get("kerf_mm", 0.0) == document["output"].get("kerf_mm", 0.0)
    assert (found.get("kerf_mm", 0.0) > 0.0) == (process != "printing")


def read(process: str) -> dict[str, Any]:
    return tomllib.loads(template("gear-pair", "mine", process))


def test_what_a_process_needs() -> None:
    plain, printed, laser, wire = map(read, ("", "printing", "laser", "wire"))
    assert "backlash_mm" not in plain["pair"]
    assert printed["pair"]["backlash_mm"] >= laser["pair"]["backlash_mm"]
    assert laser["pair"]["backlash_mm"] > wire["pair"]["backlash_mm"] > 0.0
    assert printed["blank"]["clearance_mm"] > 0.0
    assert "cut-svg" in laser["output"]["files"]


def test_another_process_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "cam", "--for", "lasre"]) == 2
    err = capsys.readouterr().err
    assert "did you mean laser?" in err
    assert "printing, laser, wire" in err
