"""Every public name says what it takes, gives and raises."""

from __future__ import annotations

from pathlib import Path

import pytest

from arch import rules

GOOD = '''"""A room."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Thing:
    """A thing with its size and its `weight`."""

    size: float
    weight: float
    colour: str = param(doc="its colour")

    @property
    def both(self) -> float:
        """Size times weight."""
        return self.size * self.weight

    def __len__(self) -> int:
        return 2


def one(x: float) -> float:
    """Twice x."""
    return 2 * x


def two(x: float, y: float) -> float:
    """Return the product of x and y."""
    return x * y


def deferred(a: float, b: float) -> None:
    """Make a thing (see `Thing`)."""


def both(a: float, b: float) -> float:
    """Add.

    Parameters
    ----------
    a, b : float
        What to add.

    Returns
    -------
    float
        The sum.

    Raises
    ------
    ValueError
        If a is negative.
    """
    if a < 0:
        raise ValueError(a)
    return a + b


def _private(a, b):
    raise KeyError(a)
'''


def test_public_names_are_documented() -> None:
    files = rules.python_files(rules.SOURCE)
    promised = rules.promised_methods(*files)
    assert [fault for path in files for fault in rules.docstring_faults(path, promised)] == []


def _faults(tmp_path: Path, code: str) -> list[str]:
    sample = tmp_path / "sample.py"
    sample.write_text(code)
    return [fault.removeprefix("sample.py: ") for fault in rules.docstring_faults(sample)]


def test_a_good_sample_passes(tmp_path: Path) -> None:
    assert _faults(tmp_path, GOOD) == []


@pytest.mark.parametrize(
    ("good", "bad", "fault"),
    [
        ('"""A room."""', "", "the module has no docstring"),
        ('"""A thing with its size and its `weight`."""', "", "class Thing has no docstring"),
        ("size and its `weight`", "size", "class Thing: field weight is not described"),
        ('param(doc="its colour")', '""', "class Thing: field colour is not described"),
        ('"""Size times weight."""', "", "Thing.both has no docstring"),
        ('"""Twice x."""', "", "one has no docstring"),
        ("Return the product", "Product", "two: what it returns is not described"),
        ("product of x and y", "product", "two: parameter x is not described"),
        ("(see `Thing`)", "", "deferred: parameter b is not described"),
        ("a, b : float", "a : float", "both: parameter b is not described"),
        ("Returns\n    -------", "Result\n    ------", "both: what it returns is not described"),
        ("    ValueError\n", "    KeyError\n", "both: raises ValueError, not described"),
    ],
)
def test_each_gap_is_caught(tmp_path: Path, good: str, bad: str, fault: str) -> None:
    assert GOOD.count(good) == 1
    assert fault in _faults(tmp_path, GOOD.replace(good, bad))


def test_a_promise_of_a_protocol_is_described_once(tmp_path: Path) -> None:
    sample = tmp_path / "sample.py"
    build = "    def build(self, a, b):\n        "
    sample.write_text(f'"""R."""\n\n\nclass Able(Protocol):\n    """A."""\n\n{build}...\n')
    promised = rules.promised_methods(sample)
    assert promised == {"build"}
    sample.write_text(f'"""R."""\n\n\nclass Maker:\n    """M."""\n\n{build}"""Make."""\n')
    assert len(rules.docstring_faults(sample)) == 2
    assert rules.docstring_faults(sample, promised) == []
