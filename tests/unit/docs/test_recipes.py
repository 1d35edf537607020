"""The recipes of docs/python.md run as scripts, and print what is shown."""

from __future__ import annotations

import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

from arch import rules
from helpers_processes import ENVIRONMENT
from helpers_sampling import chosen

PAGE = (rules.ROOT / "docs" / "python.md").read_text("utf-8")
RECIPES = dict(re.findall(r"^## (.+?)\n.*?^```python\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE))


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "profiles").symlink_to(rules.ROOT / "profiles")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    return tmp_path


def apart(script: Path) -> str:
    """Run a script in a process of its own, whose module others can load, and give its output."""
    environment = {
        **ENVIRONMENT,
        "PYTHONWARNINGS": "error,default::DeprecationWarning",  # forks beside threads of numpy warn
    }
    done = subprocess.run(
        [sys.executable, script], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_there_are_twelve_recipes() -> None:
    assert [int(title.partition(".")[0]) for title in RECIPES] == list(range(1, 13))
    assert PAGE.count("```python") == 12


@pytest.mark.parametrize(
    "title", chosen(list(RECIPES), *(one for one in RECIPES if one[:2] not in ("3.", "9.")))
)
def test_a_recipe_prints_what_is_shown(
    title: str, desk: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = RECIPES[title].replace("2000", "12")  # designs of a sweep
    assert max(map(len, code.splitlines())) <= 110
    shown = re.findall(r"^ *# -> (.+)$", code, re.MULTILINE)
    assert shown
    script = desk / "recipe.py"
    script.write_text(code, "utf-8")
    if "gc.sweep" in code:
        printed = apart(script)
    else:
        runpy.run_path(str(script), run_name="__main__")
        printed = capsys.readouterr().out
    assert printed.splitlines() == shown
    files = {path.name for path in desk.rglob("*.*")} - {"recipe.py"}
    written = {
        "3": {"contact_ratio.pdf", "sweep.csv"},
        "6": {"centrodes.csv"},
        "7": {"contact.png"},
        "8": {"meshing.csv", "summary.json"},
    }
    assert written.get(title.partition(".")[0], set()) <= files


OTHERS = {
    f"{page.name} {number}": block
    for page in sorted((rules.ROOT / "docs").glob("*.md"))
    if page.name != "python.md"
    for number, block in enumerate(
        re.findall(
            r"^```python\n(import gearcam.*?)^```$",
            page.read_text("utf-8"),
            re.DOTALL | re.MULTILINE,
        ),
        1,
    )
}
"""Scripts of other pages, by page and number."""


@pytest.mark.parametrize("name", chosen(list(OTHERS), "sweeps.md 1", "gear-pairs.md 1"))
def test_scripts_of_other_pages_run(name: str, desk: Path) -> None:
    assert "assert" in OTHERS[name]
    script = desk / "script.py"
    script.write_text(OTHERS[name].replace("200", "20"), "utf-8")  # assemblies
    runpy.run_path(str(script), run_name="__main__")
