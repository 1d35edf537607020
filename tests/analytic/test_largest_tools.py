"""The largest tool against closed forms: ellipses, round walls, fillets of circular wheels."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.numeric.contour import Contour, Run
from gearcam.parts.tools import tool_limits
from helpers_contour import arc, line, plate


def bowl(half: float, deep: float, steps: int) -> Contour:
    """A cut whose bottom is half an ellipse: half axes across and down, in even steps."""
    turn = -np.linspace(0.0, math.pi, steps + 1)
    slope = half * np.sin(turn) - 1j * deep * np.cos(turn)
    bottom = Run(
        points=10j + half * np.cos(turn) + 1j * deep * np.sin(turn),
        tangents=slope / np.abs(slope),
    )
    sides = plate([line(half + 20j, half + 10j), line(-half + 10j, -half + 20j)], half)
    runs = (*sides.runs[:4], bottom, *sides.runs[4:])
    return Contour(
        dense=lambda: runs,
        points=np.concatenate([run.points[:-1] for run in runs]),
        tolerance=1e-3,
        chord_error=1e-3,
    )


def hourglass(half: float, radius: float, chamber: float) -> Contour:
    """A way between two round walls into a round chamber: narrowest between their sides."""
    middle = complex(half + radius, 20.0 - radius)
    end = middle + radius * cmath.exp(1.25j * math.pi)
    foot = complex(0.0, end.imag - math.sqrt(chamber**2 - end.real**2))
    opening = cmath.phase(end - foot)
    return plate(
        [
            arc(middle, radius, 0.5 * math.pi, 1.25 * math.pi),
            arc(foot, chamber, opening, -math.pi - opening),
            arc(complex(-middle.real, middle.imag), radius, -0.25 * math.pi, 0.5 * math.pi),
        ],
        middle.real,
    )


@pytest.mark.parametrize("odd", [0, 1])
@pytest.mark.parametrize("deep", [5.0, 9.0])
def test_the_bottom_of_an_ellipse(deep: float, odd: int) -> None:
    """Whether a point or the middle of a step is its lowest, of the radius ``half**2/deep``."""
    counts, true = 40 * 2 ** np.arange(5) + odd, 16.0 / deep
    off = [abs(tool_limits(bowl(4.0, deep, int(n))).inner_radius / true - 1.0) for n in counts]
    assert off[0] < 0.02
    slope = np.polyfit(np.log(counts), np.log(off), 1)[0]
    assert slope == pytest.approx(-2.0, abs=0.1)


@pytest.mark.parametrize("half", [0.4, 1.5])
@pytest.mark.parametrize("radius", [3.0, 4.1])
def test_the_narrowest_place_between_two_round_walls(half: float, radius: float) -> None:
    found = tool_limits(hourglass(half, radius, 6.0))
    assert found.diameter == found.slot
    assert found.slot == pytest.approx(2.0 * half, rel=1e-6)


@pytest.mark.parametrize("teeth", [20, 60])
def test_fillets_of_circular_wheels(teeth: int) -> None:
    """A parallel of a trochoid: at its root ``rho + d**2/(r + d)``, d the depth of rho's centre."""
    made = gearcam.build(gearcam.design(wheel(teeth)))
    found = made.parts_subject.tools[0]
    rho, depth = 2.0 * 0.3, 2.0 * (1.25 - 0.3)
    sharpest = rho + depth**2 / (teeth + depth)
    assert found.inner_radius == pytest.approx(sharpest, rel=2e-6)


def wheel(teeth: int) -> dict[str, Any]:
    return {
        "kind": "gear-pair",
        "name": "round",
        "law": {"type": "constant"},
        "pair": {"teeth": [teeth, teeth], "module_mm": 2.0},
        "rack": {"tip_radius": 0.3},
        "output": {"files": ["stl"]},
    }
