"""Random designs in inches: the same parameters as in mm, the same mistakes, told in inches."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gearcam.base.errors import DesignError
from gearcam.base.inches import customary, spellings_in
from gearcam.designs.design import document_of, load
from gearcam.designs.reader import document_in
from gearcam.designs.writing import toml_text
from helpers_sampling import QUICK
from random_designs.designs import MAKERS, design

RELATIVE = 1e-12
"""Largest difference of a number that was in inches between, relative."""

HERE = settings(QUICK, max_examples=120)


def alike(one: Any, other: Any) -> bool:
    """Whether documents are the same but for the rounding of numbers."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(alike(one[key], other[key]) for key in one)
    if isinstance(one, list):
        return len(one) == len(other) and all(map(alike, one, other))
    if isinstance(one, float):
        return math.isclose(one, other, rel_tol=RELATIVE, abs_tol=1e-300)
    return one == other


def outcome(file: Path) -> tuple[Any, list[Any]]:
    """The document of a design, or what is wrong in its file."""
    try:
        return document_of(load(file)), []
    except DesignError as error:
        return None, list(error.problems)


@HERE
@given(kind=st.sampled_from(sorted(MAKERS)), number=st.integers(0, 400))
def test_a_design_in_inches_is_the_one_in_mm(
    kind: str, number: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("inches")
    file = design(kind, 7, number).write(folder)
    text = file.read_text("utf-8")
    try:
        document = document_in(text, "")
    except DesignError:
        return  # no TOML
    inch = folder / "inch.toml"
    inch.write_text(toml_text(customary({**document, "units": "inch", "name": "n"})), "utf-8")
    file.write_text(toml_text({**document, "name": "n"}), "utf-8")
    (here, wrong), (there, found) = outcome(file), outcome(inch)
    if here is not None:
        assert not found, found
        assert there.pop("units") == "inch"
        assert alike(here, there)
    assert len(wrong) == len(found), (wrong, found)
    for one, other in zip(wrong, found, strict=True):
        if other.file == str(inch):
            assert other.key in (one.key, *spellings_in(one.key)), (one, other)
            assert not re.search(r"(?<![\w/])(?<!N )mm\b|(?<!_n)(?<!_n_s)_mm\b", str(other)), other
