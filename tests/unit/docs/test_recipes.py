"""The recipes of docs/python.md run as scripts, and print what is shown."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from arch import rules

PAGE = (rules.ROOT / "docs" / "python.md").read_text("utf-8")
RECIPES = dict(re.findall(r"^## (.+?)\n.*?^```python\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE))
ENVIRONMENT = {
    **os.environ,
    "MPLBACKEND": "Agg",
    "PYTHONPATH": str(rules.SOURCE.parent),
    "PYTHONWARNINGS": "error,default::DeprecationWarning",  # forks beside threads of numpy warn
}


def run(code: str, folder: Path) -> str:
    (folder / "profiles").symlink_to(rules.ROOT / "profiles")
    (folder / "recipe.py").write_text(code, "utf-8")
    done = subprocess.run(
        [sys.executable, "recipe.py"],
        cwd=folder,
        env=ENVIRONMENT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_there_are_twelve_recipes() -> None:
    assert [int(title.partition(".")[0]) for title in RECIPES] == list(range(1, 13))
    assert PAGE.count("```python") == 12


@pytest.mark.parametrize("title", RECIPES)
def test_a_recipe_prints_what_is_shown(title: str, tmp_path: Path) -> None:
    code = RECIPES[title]
    assert max(map(len, code.splitlines())) <= 110
    shown = re.findall(r"^# -> (.+)$", code, re.MULTILINE)
    assert shown
    assert run(code, tmp_path).splitlines() == shown
    files = {path.name for path in tmp_path.rglob("*.*")} - {"recipe.py"}
    written = {"6": {"centrodes.csv"}, "7": {"contact.png"}, "8": {"meshing.csv", "summary.json"}}
    assert written.get(title.partition(".")[0], set()) <= files
