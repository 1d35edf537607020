"""What is made where a library is not installed, and that a refusal names the command for it."""

from __future__ import annotations

import shlex
import sys
import tomllib
from pathlib import Path

import pytest

import gearcam as gc
from arch import rules
from gearcam.cli import main
from gearcam.commands import GOOD, WRONG
from gearcam.parts.solids import LIBRARIES
from helpers_sampling import few

ROOT = rules.ROOT
PROFILE = ROOT / "profiles" / "ellipse.toml"
PROFILES = {
    "gear-pair": PROFILE,
    "cam": ROOT / "profiles" / "plate_cam_offset_roller.toml",
}
COMMAND = f"pip install {LIBRARIES}"
OF_SOLIDS = ("manifold3d", "trimesh", "networkx", "lxml")


def block(monkeypatch: pytest.MonkeyPatch, *libraries: str) -> None:
    """Make libraries look as if they were not installed, whatever was loaded of them before."""
    loaded = [name for name in sys.modules if name.partition(".")[0] in libraries]
    for name in {*libraries, *loaded}:
        monkeypatch.setitem(sys.modules, name, None)


def test_the_extra_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    block(monkeypatch, "OCP")
    assert main(["build", str(PROFILE), "--only", "step", "-o", str(tmp_path / "out")]) == WRONG
    told = capsys.readouterr().err
    assert 'pip install "gearcam[step]"' in told
    assert "fault of gearcam" not in told
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("kind", few(reversed(PROFILES)))
def test_outlines_and_the_report_need_no_library_of_solids(
    kind: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The page says which command brings the solids, and is otherwise as it always is."""
    design = gc.load(PROFILES[kind])
    files = ["dxf", "csv", "svg", "report", "drawing-svg", "inspection"]
    whole = gc.build(design).write(tmp_path / "whole", files=files)
    block(monkeypatch, *OF_SOLIDS)
    made = gc.build(design).write(tmp_path / "made", files=files)
    assert made.files == whole.files
    for name in set(made.files) - {"report.html", "summary.json"}:
        assert (made.directory / name).read_bytes() == (whole.directory / name).read_bytes(), name
    page = (made.directory / "report.html").read_text("utf-8")
    assert COMMAND.replace('"', "&#34;").replace("<", "&lt;").replace(">", "&gt;") in page
    assert COMMAND.split()[-1] not in (whole.directory / "report.html").read_text("utf-8")
    assert len(page) < len((whole.directory / "report.html").read_text("utf-8"))


def test_the_command_line_builds_them_too(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    block(monkeypatch, *OF_SOLIDS)
    words = ["build", str(PROFILE), "-o", str(tmp_path)]
    assert main([*words, "--only", "dxf,csv,svg,report"]) == GOOD
    assert (tmp_path / "ellipse" / "report.html").stat().st_size > 100_000
    capsys.readouterr()


@pytest.mark.parametrize(
    ("missing", "asked"),
    [
        ("manifold3d", "stl"), ("manifold3d", "3mf"), ("manifold3d", "glb"),
        ("trimesh", "3mf"), ("trimesh", "glb"), ("networkx", "3mf"),
    ],
)  # fmt: skip
def test_files_of_solids_name_the_command_in_one_line(
    missing: str, asked: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    block(monkeypatch, missing)
    words = ["build", str(PROFILE), "-o", str(tmp_path / "out"), "--only", asked]
    assert main(words) == WRONG
    (line,) = capsys.readouterr().err.splitlines()
    assert line == f"{PROFILE}: solids need a library that is not installed: {COMMAND}"
    assert not (tmp_path / "out").exists()


def test_stl_needs_no_trimesh(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    block(monkeypatch, "trimesh", "networkx", "lxml")
    assert main(["build", str(PROFILE), "-o", str(tmp_path), "--only", "stl"]) == GOOD


def test_solids_in_python_name_it(monkeypatch: pytest.MonkeyPatch) -> None:
    result = gc.build(gc.load(PROFILE))
    block(monkeypatch, "trimesh")
    with pytest.raises(gc.MissingExtraError, match="solids need a library"):
        _ = result.solids


def test_the_command_asks_for_the_versions_of_the_project() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    names = [one.partition(">")[0] for one in shlex.split(LIBRARIES)]
    assert tuple(names) == OF_SOLIDS
    of = {one.partition(">")[0]: one for one in project["dependencies"]}
    assert [of[name] for name in names[:2]] == shlex.split(LIBRARIES)[:2]
