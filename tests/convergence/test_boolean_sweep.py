"""Convex wheels against a boolean sweep of the rack: the difference falls as the step squared.

The sweep leaves ridges between its positions, so that its error is known to fall as 1/N^2. If the
closed form were off, the difference would stop falling. Flanks, fillets and root lands, the
undercut teeth of the nail machine's driven wheels included.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gearcam.numeric.arrays import as_pairs
from helpers_sampling import few
from helpers_witnessed import cut_points, kinematics, outline
from witness import sweep

STEPS = np.array([1000, 2000, 4000, 8000])
WHEELS = [
    ("ellipse", 1, (13,)),
    ("ellipse", 2, (7,)),
    ("two phases", 2, (3, 16, 17)),
    ("three phases", 2, (15, 30)),
]


def differences(name: str, wheel: Any, spaces: tuple[int, ...]) -> list[float]:
    """Largest difference over some spaces, mm, for each number of steps."""
    rolling, basic = kinematics(name)
    points = [sweep.inside(cut_points(name, wheel), rolling, wheel, k, basic) for k in spaces]
    assert min(len(part) for part in points) > 150
    return [
        max(
            sweep.farthest(part, sweep.cut_space(rolling, wheel, k, basic, int(steps)))
            for k, part in zip(spaces, points, strict=True)
        )
        for steps in STEPS
    ]


def slope(errors: list[float]) -> float:
    return -float(np.polyfit(np.log(STEPS), np.log(errors), 1)[0])


@pytest.mark.parametrize(("name", "wheel", "spaces"), few(WHEELS, 4))
def test_difference_falls_with_the_square_of_the_step(
    name: str, wheel: Any, spaces: tuple[int, ...]
) -> None:
    errors = differences(name, wheel, spaces)
    assert slope(errors) == pytest.approx(2, abs=0.1)
    assert errors[-1] < 1e-4


def test_undercut_teeth_are_among_them() -> None:
    assert {15, 17, 18} <= set(outline("two phases", 2).undercut_teeth)
    assert {15, 16, 17, 18} <= set(outline("three phases", 2).undercut_teeth)


def test_a_difference_that_does_not_fall_is_seen() -> None:
    """The control: the same wheel, its flanks off by 0.2 micrometres."""
    rolling, basic = kinematics("ellipse")
    points = sweep.inside(cut_points("ellipse", 1), rolling, 1, 13, basic)
    moved = points + np.array([2e-4, 0.0])
    errors = [sweep.farthest(moved, sweep.cut_space(rolling, 1, 13, basic, int(n))) for n in STEPS]
    assert slope(errors) < 1.5


def test_the_tip_is_the_offset_of_the_centrode() -> None:
    """Over the tips, points lie at the addendum from the centrode, within the chord error."""
    rolling, basic = kinematics("ellipse")
    points = as_pairs(outline("ellipse", 1).points)
    for k in (1, 13):
        material = sweep.swept(rolling, 1, k, basic, 8000)
        mine = sweep.inside(points, rolling, 1, k, basic)
        assert sweep.farthest(mine, material) < 2e-5
