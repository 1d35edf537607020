"""Library code has no star imports, no asserts and no printing."""

from __future__ import annotations

from pathlib import Path

import pytest

from arch import rules


def test_the_package_is_looked_at() -> None:
    assert len(rules.python_files(rules.SOURCE)) >= 5


def test_no_star_imports_asserts_or_prints() -> None:
    files = rules.python_files(rules.SOURCE)
    assert [fault for path in files for fault in rules.manner_faults(path)] == []


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
