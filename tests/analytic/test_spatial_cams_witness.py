"""Random cams in space have the walls that a search finds which knows no envelope.

Undercut ones are held against a roller that has stood at thousands of cam angles: what it leaves,
and how far a thin slice of it goes towards that until it rests.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fuzz.cross_checks_spatial as checks
import gearcam as gc
from gearcam.base.errors import GearcamError
from gearcam.kinds.spatial_cam.result import SpatialCamResult
from gearcam.spatial.cam import SpatialWall
from gearcam.spatial.guides import SwingArm
from gearcam.spatial.trimmed import LostLift, TrimmedWall, lost_lift
from helpers_spatial import slice_way, swept, undercut_cams
from random_designs.designs import design
from witness.roller_in_space import Mechanism, Swept


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


@pytest.mark.parametrize("number", [8, pytest.param(300, marks=pytest.mark.slow)])
def test_walls_are_where_the_search_finds_them(tmp_path: Path, number: int) -> None:
    """Undercut walls too: there the search is beyond them, by the depth that is taken off."""
    found = cams(tmp_path, number, 46)
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


_CLOSE = 1e-4
"""Allowed difference of depths and lost lifts from those of the swept roller, mm."""


def errors(wall: SpatialWall, left: Swept, theta: float, x: float) -> tuple[float, float]:
    """Differences of depth and lost lift at one place from those of the swept roller, mm."""
    trimmed, at, place = TrimmedWall(wall=wall), np.array([theta]), np.array([[x]])
    depth, lost = (float(of(at, place)[0, 0]) for of in (trimmed.depth, trimmed.lost))
    px, py, pz = wall.contact(at, place).points[0, 0].tolist()
    c, s = math.cos(theta), math.sin(theta)
    deep = wall.side * (left.left(theta, c * px - s * py, np.array([s * px + c * py]))[0] - pz)
    scale = wall.cam.guide.length if isinstance(wall.cam.guide, SwingArm) else 1.0
    return depth - deep, scale * (lost - slice_way(wall, left, theta, x))


def beside(wall: SpatialWall, loss: LostLift, number: int) -> list[tuple[float, float]]:
    """Places beside that of the largest lost lift, at which less is lost."""
    d, spot = np.random.default_rng(5), loss.way
    theta = spot.theta + 0.08 * d.standard_normal(number)
    x = spot.x + (wall.cam.outer_radius - spot.x) * d.uniform(0.0, 0.3, number)
    lost = TrimmedWall(wall=wall).lost(theta, x[:, None])[:, 0]
    assert lost.max() <= spot.value + 1e-6
    return list(zip(theta[lost > 0.0].tolist(), x[lost > 0.0].tolist(), strict=True))


@pytest.mark.parametrize(
    ("number", "every"), [(20, 10), pytest.param(200, 1, marks=pytest.mark.slow)]
)
def test_undercut_walls_are_those_that_a_swept_roller_leaves(number: int, every: int) -> None:
    """Translating and swinging followers, cylinders and cones, grooves and single walls."""
    shapes = set()
    for k, cam in enumerate(undercut_cams(number)):
        shapes.add((isinstance(cam.guide, SwingArm), cam.roller.half_angle > 0.0, len(cam.walls)))
        walls = [wall for wall in cam.walls if wall.undercut]
        for wall in walls if every == 1 else walls[-1:]:
            places = [(wall.spread.theta, wall.spread.x)]
            if k % every == 0:
                loss = lost_lift(wall)
                places += [(spot.theta, spot.x) for spot in (loss.depth, loss.way)]
                places += beside(wall, loss, 2 if every == 1 else 1)
            left = swept(wall)
            off = [error for place in places for error in errors(wall, left, *place)]
            assert max(map(abs, off)) < _CLOSE, (k, wall.key, off)
    assert len(shapes) == 8


@pytest.mark.parametrize("wrong", ["untrimmed", "a wall off by 5 um"])
def test_a_swept_roller_finds_what_is_trimmed_wrongly(
    monkeypatch: pytest.MonkeyPatch, wrong: str
) -> None:
    (cam,) = undercut_cams(1)
    wall = next(wall for wall in cam.walls if wall.undercut)
    left, spot = swept(wall), wall.spread
    assert max(map(abs, errors(wall, left, spot.theta, spot.x))) < _CLOSE
    if wrong == "untrimmed":
        monkeypatch.setattr(TrimmedWall, "depth", lambda *given: np.zeros(given[2].shape))
    else:
        left = replace(left, roller=replace(left.roller, radius=left.roller.radius + 5e-3))
    assert max(map(abs, errors(wall, left, spot.theta, spot.x))) > 4e-3
