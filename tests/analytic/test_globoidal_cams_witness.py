"""Random globoidal cams have walls that the rollers just touch, by a search without envelopes."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import pytest

import fuzz.cross_checks_globoidal as checks
import gearcam as gc
from gearcam.base.errors import GearcamError
from gearcam.kinds.globoidal_cam.result import GloboidalCamResult
from random_designs.designs import design
from witness.roller_of_turret import Wheel


def cams(folder: Path, number: int, seed: int = 44) -> list[GloboidalCamResult]:
    """The first random globoidal cams that can be made, so many."""
    found: list[GloboidalCamResult] = []
    for index in count():
        if len(found) == number:
            return found
        drawn = design("globoidal-cam", seed, index)
        try:
            result = gc.build(gc.load(drawn.write(folder / str(index))))
            assert isinstance(result, GloboidalCamResult)
            assert result.cam.walls
            found.append(result)
        except GearcamError:
            continue
    raise AssertionError


@pytest.mark.parametrize("number", [1, pytest.param(60, marks=pytest.mark.slow)])
def test_walls_are_where_the_search_finds_them(tmp_path: Path, number: int) -> None:
    found = cams(tmp_path, number)
    assert [(one.design.name, words) for one in found for words in checks.doubts(one)] == []
    assert len({one.design.turret.stops for one in found}) >= min(4, number)
    assert {one.cam.clockwise for one in found} == {True, False} or number < 60


@pytest.mark.parametrize(("off", "words"), [(1e-4, "touches"), (-1e-4, "cuts it")])
def test_a_wall_that_is_off_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, off: float, words: str
) -> None:
    """A turret that is a little nearer or farther."""

    def other(*given: Any) -> Wheel:
        made = Wheel(*given)
        return replace(made, distance=made.distance * (1.0 + off))

    (one,) = cams(tmp_path, 1)
    assert not one.cam.undercut
    monkeypatch.setattr(checks, "Wheel", other)
    assert any(words in text for _, text in checks.doubts(one))
