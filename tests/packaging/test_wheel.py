"""The wheel and the sdist hold what they must, and the demo runs from the wheel alone."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import venv
import zipfile
from datetime import date
from pathlib import Path
from typing import NamedTuple

import pytest
from ezdxf import filemanagement

from arch import rules
from compare_sides import SAFE
from gearcam import __version__

ROOT = rules.ROOT
DEMO = ROOT / "profiles" / "nail_machine_two_phase.toml"
SOURCE = ROOT / "src" / "gearcam"
KEPT_OUT = ("output/", ".venv/", ".matrix/", "build/", "dist/", ".git/", ".pytest_cache/")
"""What lies in a checkout and belongs in no archive."""


class Archives(NamedTuple):
    """What was built: the folder, and the names in both archives."""

    wheel: Path
    in_wheel: frozenset[str]
    in_sdist: frozenset[str]
    """Without the sdist's top folder."""


def run(*command: str | Path, cwd: Path | None = None) -> str:
    """Run a command that must succeed, with no path to the checkout; returns what it printed."""
    env = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=cwd, env=env)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def archives(tmp_path_factory: pytest.TempPathFactory) -> Archives:
    """Build the sdist from this checkout, and the wheel from the sdist, as an index would."""
    pytest.importorskip("hatchling")
    folder = tmp_path_factory.mktemp("dist")
    hatchling = (sys.executable, "-m", "hatchling", "build", "-d", folder, "-t")
    run(*hatchling, "sdist", cwd=ROOT)
    (sdist,) = folder.glob("*.tar.gz")
    with tarfile.open(sdist) as held:
        held.extractall(folder, **SAFE)
        names = [member.name for member in held if member.isfile()]
    top = folder / f"gearcam-{__version__}"
    run(*hatchling, "wheel", cwd=top)
    (wheel,) = folder.glob("*.whl")
    inside = frozenset(name.partition("/")[2] for name in names)
    return Archives(wheel, frozenset(zipfile.ZipFile(wheel).namelist()), inside)


def beside_code() -> set[str]:
    """Files of the package other than Python: templates, scripts, styles, licences."""
    every = {path for path in SOURCE.rglob("*") if path.suffix not in ("", ".py", ".pyc")}
    return {str(path.relative_to(SOURCE.parent)) for path in every | {*SOURCE.rglob("LICENSE")}}


def test_both_hold_every_file_of_the_package(archives: Archives) -> None:
    beside = beside_code()
    wanted = ("py.typed", "report/page.html", "report/page.js", "report/uPlot/uPlot.iife.min.js")
    assert {f"gearcam/{name}" for name in wanted} < beside
    code = {str(path.relative_to(SOURCE.parent)) for path in SOURCE.rglob("*.py")}
    assert sorted((beside | code) - archives.in_wheel) == []
    assert sorted({f"src/{name}" for name in beside | code} - archives.in_sdist) == []


def test_both_hold_the_licences(archives: Archives) -> None:
    licences = ("LICENSE", "src/gearcam/report/uPlot/LICENSE")
    held = f"gearcam-{__version__}.dist-info/licenses/"
    assert {held + name for name in licences} < archives.in_wheel
    assert set(licences) < archives.in_sdist
    metadata = zipfile.ZipFile(archives.wheel).read(f"gearcam-{__version__}.dist-info/METADATA")
    assert "License-Expression: MIT" in metadata.decode("utf-8").splitlines()


def test_the_sdist_holds_what_its_makefile_needs(archives: Archives) -> None:
    needed = ("Makefile", "pyproject.toml", "requirements.lock", "README.md", "tools/lock.py")
    cited = ("CITATION.cff", "CONTRIBUTING.md", f"profiles/{DEMO.name}")
    assert {*needed, *cited} < archives.in_sdist


def test_no_output_and_no_environment_is_packed(archives: Archives) -> None:
    packed = archives.in_sdist | archives.in_wheel
    assert [name for name in packed if name.startswith(KEPT_OUT) or "__pycache__" in name] == []


@pytest.mark.slow
def test_the_demo_runs_from_the_wheel_far_from_the_checkout(
    archives: Archives, tmp_path: Path
) -> None:
    """Dependencies are those of the running environment, whose own gearcam is not seen."""
    venv.create(tmp_path / "env", symlinks=True, with_pip=False)
    scripts = tmp_path / "env" / "bin"
    pip = (sys.executable, "-m", "pip", "--python", scripts / "python", "--quiet", "install")
    run(*pip, "--no-index", "--no-deps", "--no-compile", archives.wheel)
    where = "import sysconfig; print(sysconfig.get_path('purelib'))"
    packages = Path(run(scripts / "python", "-c", where).strip())
    lines = {sysconfig.get_path(name) + "\n" for name in ("purelib", "platlib")}
    (packages / "dependencies.pth").write_text("".join(lines), "utf-8")
    place = tmp_path / "elsewhere"
    place.mkdir()
    design = tomllib.loads(DEMO.read_text("utf-8"))
    coarse = DEMO.read_text("utf-8").replace("[output]", "[output]\nchord_tolerance_mm = 0.02")
    (place / DEMO.name).write_text(coarse, "utf-8")
    home = run(scripts / "python", "-c", "import gearcam; print(gearcam.__file__)", cwd=place)
    assert Path(home.strip()).is_relative_to(packages)
    run(scripts / "gearcam", "build", DEMO.name, "-o", "made", cwd=place)
    made = place / "made" / design["name"]
    page = (made / "report.html").read_text("utf-8")
    assert "uPlot" in page
    assert "</html>" in page
    assert filemanagement.readfile(made / "gear1.dxf").modelspace().query("*[layer=='OUTLINE']")
    assert json.loads((made / "summary.json").read_text("utf-8"))["gears"][0]["teeth"] == 36


def test_the_citation_names_the_version_its_date_and_the_licence() -> None:
    lines = (ROOT / "CITATION.cff").read_text("utf-8").splitlines()
    assert {f"version: {__version__}", "license: MIT", "title: gearcam"} < set(lines)
    (dated,) = (line for line in lines if line.startswith("date-released: "))
    assert date.fromisoformat(dated.removeprefix("date-released: "))
