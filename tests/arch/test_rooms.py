"""Unit tests lie where the module that they test lies in the package."""

from __future__ import annotations

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
