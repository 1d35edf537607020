"""Unit tests lie where the module that they test lies in the package."""

from __future__ import annotations

import re
from pathlib import Path

from arch import rules

BESIDE = {"command_line", "docs", "tools"}
"""Folders of tests of what is no folder of the package."""


def misplaced(tests: Path, rooms: set[str]) -> list[str]:
    """Return the files of tests that are in no folder that is named as a room."""
    files = [path.relative_to(tests) for path in sorted(tests.rglob("test_*.py"))]
    return [path.as_posix() for path in files if path.parent.as_posix() not in rooms]


def test_unit_tests_mirror_the_package() -> None:
    modules = rules.python_files(rules.SOURCE)
    rooms = {path.parent.relative_to(rules.SOURCE).as_posix() for path in modules}
    assert misplaced(rules.ROOT / "tests" / "unit", rooms - {"."} | BESIDE) == []


def test_a_loose_file_is_seen(tmp_path: Path) -> None:
    for name in ("test_loose.py", "gears/test_good.py", "nowhere/test_lost.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    assert misplaced(tmp_path, {"gears"}) == ["nowhere/test_lost.py", "test_loose.py"]


def unnamed(tests: Path, guide: str) -> list[str]:
    """Return the files with slow cases, beside unit tests, that the guide names for no change."""
    named = re.findall(r"`(tests/[\w/.]+)`", guide)
    slow = (one for one in tests.rglob("test_*.py") if _SLOW.search(one.read_text("utf-8")))
    places = (f"tests/{one.relative_to(tests).as_posix()}" for one in slow)
    return sorted(one for one in places if not one.startswith(("tests/unit/", *named)))


_SLOW = re.compile(r"\bmark\.slow\b|\b(?:few|chosen)\(")


def test_the_guide_names_the_slow_cases_of_each_change() -> None:
    guide = (rules.ROOT / "docs" / "contributing.md").read_text("utf-8")
    _, _, table = guide.partition("| changed in | slow cases |")
    assert unnamed(rules.ROOT / "tests", table) == []


def test_a_slow_case_that_is_not_named_is_seen(tmp_path: Path) -> None:
    for name, text in (("a/test_one", "@pytest.mark.slow"), ("b/test_two", 'few("ab")')):
        (tmp_path / name).parent.mkdir()
        (tmp_path / f"{name}.py").write_text(text)
    assert unnamed(tmp_path, "| x | `tests/a` |") == ["tests/b/test_two.py"]
