"""Files and functions stay small enough to read, and library code keeps its manners."""

from __future__ import annotations

from pathlib import Path

import pytest

from arch import rules

EVERYTHING = [rules.SOURCE, rules.ROOT / "tests", rules.ROOT / "benchmarks", rules.ROOT / "tools"]


def test_the_package_is_looked_at() -> None:
    assert len(rules.python_files(rules.SOURCE)) >= 5


def test_files_and_functions_are_short() -> None:
    faults = [
        fault for path in rules.python_files(*EVERYTHING) for fault in rules.size_faults(path)
    ]
    assert faults == []


def test_no_star_imports_asserts_or_prints() -> None:
    files = rules.python_files(rules.SOURCE)
    assert [fault for path in files for fault in rules.manner_faults(path)] == []


def test_a_long_file_is_caught(tmp_path: Path) -> None:
    sample = tmp_path / "long.py"
    sample.write_text("x = 1\n" * 399)
    assert rules.size_faults(sample) == []
    sample.write_text("x = 1\n" * 400)
    assert "400 lines" in rules.size_faults(sample)[0]


def test_a_long_function_is_caught_and_its_docstring_is_free(tmp_path: Path) -> None:
    sample = tmp_path / "function.py"
    doc = '    """Say.\n\n' + "    More.\n" * 30 + '    """\n'
    sample.write_text("def f():\n" + doc + "    x = 1\n" * 58)
    assert rules.size_faults(sample) == []
    sample.write_text("def f():\n" + doc + "    x = 1\n" * 59)
    assert "60 lines of code" in rules.size_faults(sample)[0]


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ("from numpy import *\n", "star import"),
        ("def f(x):\n    assert x > 0\n", "assert"),
        ("print('done')\n", "print()"),
        ("import sys\nsys.exit(1)\n", "sys.exit()"),
    ],
)
def test_bad_manners_are_caught(tmp_path: Path, code: str, fault: str) -> None:
    sample = tmp_path / "sample.py"
    sample.write_text(code)
    assert [found.split(maxsplit=1)[1] for found in rules.manner_faults(sample)] == [fault]


def test_a_star_for_type_checkers_passes(tmp_path: Path) -> None:
    sample = tmp_path / "sample.py"
    sample.write_text("if TYPE_CHECKING:\n    from numpy import *\n")
    assert rules.manner_faults(sample) == []


def test_the_command_line_may_print(tmp_path: Path) -> None:
    sample = tmp_path / "console.py"
    sample.write_text("print('done')\n")
    assert rules.manner_faults(sample) == []
