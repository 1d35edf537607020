"""Random cams in space have the walls that a search finds which knows no envelope."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import pytest

import fuzz.cross_checks_spatial as checks
import gearcam as gc
from gearcam.base.errors import GearcamError
from gearcam.kinds.spatial_cam.build import SpatialCamResult
from random_designs.designs import design
from witness.roller_in_space import Mechanism


def cams(folder: Path, number: int, seed: int = 44) -> list[SpatialCamResult]:
    """The first random cams in space that can be made, so many."""
    found: list[SpatialCamResult] = []
    for index in count():
        if len(found) == number:
            return found
        drawn = design("spatial-cam", seed, index)
        try:
            result = gc.build(gc.load(drawn.write(folder / str(index))))
            assert isinstance(result, SpatialCamResult)
            assert result.cam.walls
            found.append(result)
        except GearcamError:
            continue
    raise AssertionError


@pytest.mark.parametrize("number", [12, pytest.param(300, marks=pytest.mark.slow)])
def test_walls_are_where_the_search_finds_them(tmp_path: Path, number: int) -> None:
    """Undercut walls too: there the search is beyond them, by the depth that is taken off."""
    found = cams(tmp_path, number)
    assert [(one.design.name, words) for one in found for words in checks.doubts(one)] == []
    shapes = {(one.design.follower.oscillating, bool(one.cam.roller.half_angle)) for one in found}
    assert len(shapes) == 4
    assert number < 300 or any(one.carved for one in found)


@pytest.mark.parametrize(
    ("factor", "words"), [(1.0 + 1e-5, "is whole, but"), (1.0 - 1e-5, "is beyond the search")]
)
def test_a_wall_that_is_off_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, factor: float, words: str
) -> None:
    def other(*given: Any) -> Mechanism:
        made = Mechanism(*given)
        return replace(made, radius=factor * made.radius)

    (one,) = cams(tmp_path, 1)
    assert not one.carved
    monkeypatch.setattr(checks, "Mechanism", other)
    told = [text for _, text in checks.doubts(one)]
    assert len(told) >= 14
    assert all(words in text for text in told if "trimmed" not in text)
