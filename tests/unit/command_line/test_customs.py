"""The customs of shells: ``-`` for the standard input, ``--json``, ``--quiet``, streams."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import pytest

from arch import rules
from gearcam.cli import main
from gearcam.designs.reader import LARGEST

PAIR = """
kind = "gear-pair"
[law]
type = "ellipse"
eccentricity = 0.2
[pair]
teeth = [30, 30]
module_mm = 1
"""
CAM = str(rules.ROOT / "profiles" / "eccentric_cam.toml")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def typed(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Puts a text, or bytes, into the standard input."""

    def put(content: str | bytes) -> None:
        data = content.encode() if isinstance(content, str) else content
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(data), encoding="ascii"))

    return put


@pytest.mark.parametrize(
    "words",
    [
        ["build", "-", "--only", "csv"],
        ["check", "-"],
        ["mesh", "-", "--steps", "4"],
        ["compare", "-", "--set", "law.eccentricity=0.1,0.2"],
        ["sweep", "-", "--set", "law.eccentricity=0.1,0.2", "--jobs", "1"],
    ],
    ids=lambda words: words[0],
)
def test_a_dash_reads_the_design_from_the_standard_input(
    words: list[str], typed: Any, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    typed(PAIR)
    assert main(words) == 0
    assert capsys.readouterr().err == ""
    there = {"compare": "compare.html", "sweep": "sweep.csv"}.get(words[0], "stdin/summary.json")
    assert (folder / "output" / there).exists()


def test_a_table_sweep_in_the_standard_input_counts(typed: Any, folder: Path) -> None:
    typed(PAIR + '[sweep]\n"law.eccentricity" = "0.1,0.2,0.3"\n')
    assert main(["sweep", "-", "--jobs", "1"]) == 0
    assert len((folder / "output" / "sweep.csv").read_text().splitlines()) == 4


def test_a_mistake_in_the_standard_input_has_its_line(
    typed: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    typed(PAIR.replace("teeth", "teetj"))
    assert main(["check", "-"]) == 2
    err = capsys.readouterr().err
    assert err.startswith("stdin: 1 problem, nothing was checked")
    assert "stdin:7: pair.teetj" in err


def test_names_of_files_in_the_standard_input_are_those_of_the_folder(
    typed: Any, folder: Path
) -> None:
    rows = "\n".join(
        f"{angle},{1 + 0.1 * (angle in (120, 180, 240))}" for angle in range(0, 361, 60)
    )
    (folder / "law.csv").write_text(f"phi1_deg,ratio\n{rows}\n")
    typed(PAIR.replace('"ellipse"', '"table"').replace("eccentricity = 0.2", 'file = "law.csv"'))
    assert main(["check", "-"]) in (0, 1)


@pytest.mark.parametrize(
    ("content", "told"),
    [(b"\xff\xfe", "the file is UTF-16"), (b"a" * (LARGEST + 1), "longer than 2 MB")],
    ids=["bytes", "long"],
)
def test_what_is_no_design_is_refused(
    content: bytes, told: str, typed: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    typed(content)
    assert main(["check", "-"]) == 2
    assert told in capsys.readouterr().err


def test_without_a_standard_input_it_is_said(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stdin", None)
    assert main(["check", "-"]) == 2
    assert "there is no standard input" in capsys.readouterr().err


def test_the_live_view_needs_a_file(typed: Any, capsys: pytest.CaptureFixture[str]) -> None:
    typed(PAIR)
    assert main(["view", "-", "--no-browser"]) == 2
    assert "follows a file" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (["check", CAM], "eccentric_cam"),
        (["build", CAM, "--only", "csv"], "eccentric_cam"),
        (["mesh", "-", "--steps", "4"], "stdin"),
    ],
    ids=["check", "build", "study"],
)
def test_json_is_the_summary_and_all_else_goes_to_stderr(
    words: list[str], name: str, typed: Any, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    typed(PAIR)
    assert main([*words, "--json"]) == 0
    out, err = capsys.readouterr()
    summary = json.loads(out)
    assert summary == json.loads((folder / "output" / name / "summary.json").read_text("utf-8"))
    assert "written to" in err
    assert "findings" in err


def test_several_designs_are_a_line_each(typed: Any, capsys: pytest.CaptureFixture[str]) -> None:
    typed(PAIR)
    assert main(["check", "-", "none.toml", CAM, "--json"]) == 2
    out, err = capsys.readouterr()
    assert [json.loads(line)["name"] for line in out.splitlines()] == ["stdin", "eccentric_cam"]
    assert "none.toml: 1 problem" in err
    assert err.endswith("3 files: 2 checked, 1 refused\n")


def test_quiet_prints_errors_only(typed: Any, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", CAM, "-q"]) == 0
    assert capsys.readouterr() == ("", "")
    typed(PAIR)
    sweep = ["sweep", "-", "--set", "law.eccentricity=0.1,0.2", "--jobs", "1", "--quiet"]
    assert main(sweep) == 0
    assert capsys.readouterr() == ("", "")
    assert main(["check", "none.toml", "-q"]) == 2
    assert "there is no such file" in capsys.readouterr().err
    # findings are errors too
    assert main(["check", CAM.replace("eccentric_cam", "undercut_cam"), "-q"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert "checked, with errors" in err
    assert "error  undercut" in err
    assert main(["check", CAM, "-q", "--json"]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out)["name"] == "eccentric_cam"
    assert err == ""
    assert main(["laws"]) == 0  # what is quiet is one command
    assert capsys.readouterr().out
