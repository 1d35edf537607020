"""What each output computes and imports is as benchmarks/results/performance.md says."""

from __future__ import annotations

import tomllib
from importlib.util import find_spec
from itertools import accumulate
from pathlib import Path

import pytest

import needs

TABLE = needs.table(needs.PAGE.read_text(encoding="utf-8"))
SLOW = (
    *("mesh", "accuracy", "compare", "report"),
    *("step", "glb", "3mf", "drawing-dxf", "drawing-svg", "cut-svg"),
)
"""Outputs that take longer than the fast tests may, or need what others need."""

QUICK = {kind: [one for one in needs.outputs(kind) if one not in SLOW] for kind in needs.DESIGNS}


def told(kind: str, output: str) -> tuple[str, set[str], set[str]]:
    """Stages, packages and rooms of a row; rooms those beyond a build of csv."""
    stages, packages, rooms = TABLE[kind, output]
    listed = [{name for name in one.split(", ") if name} for one in (packages, rooms)]
    return stages, listed[0], listed[1]


def test_every_output_stands_in_the_table() -> None:
    rows = [(kind, output) for kind in needs.DESIGNS for output in needs.outputs(kind)]
    assert list(TABLE) == rows


def test_the_packages_are_those_that_are_allowed() -> None:
    text = Path(needs.ROOT, "pyproject.toml").read_text(encoding="utf-8")
    project = tomllib.loads(text)["project"]
    extras = [one for extra in project["optional-dependencies"].values() for one in extra]
    allowed = [*project["dependencies"], *extras]
    names = {one.partition(">")[0].partition("=")[0] for one in allowed}
    # trimesh loads scipy too, where it is there
    names -= {"cadquery-ocp-novtk", "scikit-fem", "scipy"}
    assert names | {"OCP", "skfem"} == set(needs.PACKAGES)


@pytest.mark.slow
@pytest.mark.parametrize("kind", list(needs.DESIGNS))
def test_one_after_the_other_no_output_needs_more_than_is_told(kind: str) -> None:
    """In one process, so that what is loaded is what all rows so far tell of."""
    outputs = QUICK[kind]
    rows = [told(kind, output) for output in outputs]
    packages = list(accumulate((row[1] for row in rows), set.union))
    rooms = list(accumulate((row[2] for row in rows), set.union))
    found = list(needs.needs(kind, outputs))
    usual = found[0].rooms
    assert [", ".join(one.stages) for one in found] == [row[0] for row in rows]
    assert [one.packages for one in found] == packages
    assert [one.rooms - usual for one in found] == rooms


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "output"), TABLE)
def test_each_row_is_true(kind: str, output: str) -> None:
    if output == "step" and find_spec("OCP") is None:
        pytest.skip("needs the extra `step`")
    usual = next(needs.needs(kind, ["csv"])).rooms
    found = next(needs.needs(kind, [output]))
    assert needs.texts(found, usual) == TABLE[kind, output]
