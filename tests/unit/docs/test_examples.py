"""Every name at the top of the package has an example in its docstring that does what it shows."""

from __future__ import annotations

import doctest
from pathlib import Path
from typing import Any

import pytest

import gearcam as gc
from arch import rules

NAMES = [name for name in dir(gc) if name != "__version__"]
LINES = range(2, 8)
"""How long an example may be, answers left out."""


def example_of(what: Any) -> doctest.DocTest:
    return doctest.DocTestParser().get_doctest(what.__doc__, {}, what.__name__, None, None)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An empty folder with the profiles beside it."""
    (tmp_path / "profiles").symlink_to(rules.ROOT / "profiles")
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("name", NAMES)
def test_an_example_does_what_it_shows(name: str) -> None:
    what = getattr(gc, name)
    assert "Examples\n" in what.__doc__
    example = example_of(what)
    lines = "".join(step.source for step in example.examples).splitlines()
    assert len(lines) in LINES
    assert f"gc.{name}" in "\n".join(lines) or any("gc.load" in line for line in lines)
    told: list[str] = []
    doctest.DocTestRunner().run(example, out=told.append)
    assert told == []


def test_a_wrong_answer_is_seen() -> None:
    def wrong() -> None:
        """Add.

        >>> 1 + 1
        3
        """

    told: list[str] = []
    doctest.DocTestRunner().run(example_of(wrong), out=told.append)
    assert "Expected:\n    3\nGot:\n    2\n" in "".join(told)
