"""What is told of the largest tool's error is honest: against closed forms, and denser points."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.numeric.contour import Contour, Run
from gearcam.parts.tools import ToolLimits, tool_errors, tool_limits
from helpers_contour import arc, as_pairs, line, plate
from helpers_pairs import PROFILES

TIGHT = 100.0
WHEELS = ("ellipse", "rounded_square", "ring_uneven")
MORE = ("lobed", "limacon", "nail_machine_three_phase", "press", "measured", "stepped_ellipse")


def bowl(half: float, deep: float, steps: int) -> Contour:
    """A cut whose bottom is half an ellipse: half axes across and down, in even steps."""
    turn = -np.linspace(0.0, math.pi, steps + 1)
    slope = half * np.sin(turn) - 1j * deep * np.cos(turn)
    bottom = Run(
        points=as_pairs(10j + half * np.cos(turn) + 1j * deep * np.sin(turn)),
        tangents=as_pairs(slope / np.abs(slope)),
    )
    sides = plate([line(half + 20j, half + 10j), line(-half + 10j, -half + 20j)], half)
    runs = (*sides.runs[:4], bottom, *sides.runs[4:])
    return Contour(
        dense=lambda: runs,
        vertices=np.vstack([run.points[:-1] for run in runs]),
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


def demand_honest(told: float, true: float, size: float) -> None:
    """A turn is rounded over a step that may be as short as a ten thousandth of the radius."""
    assert true <= told <= max(TIGHT * true, 1e-8 * size)


@pytest.mark.parametrize("steps", [40, 41, 160, 161])
@pytest.mark.parametrize("deep", [5.0, 9.0])
def test_the_bottom_of_an_ellipse(deep: float, steps: int) -> None:
    """Whether a point or the middle of a step is its lowest, of the radius ``half**2/deep``."""
    found = tool_limits(bowl(4.0, deep, steps))
    demand_honest(found.inner_error, abs(found.inner_radius - 16.0 / deep), found.inner_radius)


@pytest.mark.parametrize("odd", [0, 1])
def test_the_error_falls_with_the_square_of_the_steps(odd: int) -> None:
    counts = 200 * 2 ** np.arange(5) + odd
    told = [tool_limits(bowl(4.0, 9.0, int(count))).inner_error for count in counts]
    slope = np.polyfit(np.log(counts), np.log(told), 1)[0]
    assert slope == pytest.approx(-2.0, abs=0.1)


@pytest.mark.parametrize("half", [0.4, 1.5])
@pytest.mark.parametrize("radius", [3.0, 4.1])
def test_the_narrowest_place_between_two_round_walls(half: float, radius: float) -> None:
    found = tool_limits(hourglass(half, radius, 6.0))
    assert found.diameter == found.slot
    assert abs(found.slot - 2.0 * half) <= found.slot_error == found.error < 0.02 * half


@pytest.mark.parametrize("teeth", [20, 60])
def test_fillets_of_circular_wheels(teeth: int) -> None:
    """A parallel of a trochoid: at its root ``rho + d**2/(r + d)``, d the depth of rho's centre."""
    made = gearcam.build(gearcam.design(wheel(teeth)))
    found = made.parts_subject.tools[0]
    rho, depth = 2.0 * 0.3, 2.0 * (1.25 - 0.3)
    sharpest = rho + depth**2 / (teeth + depth)
    true = abs(found.inner_radius - sharpest)
    demand_honest(found.inner_error, true, found.inner_radius)
    assert found.error == 2.0 * found.inner_error
    errors = [one.error for one in made.parts_subject.tools]
    assert made.facts["accuracy.tool_mm"] == max(errors)


def wheel(teeth: int) -> dict[str, Any]:
    return {
        "kind": "gear-pair",
        "name": "round",
        "law": {"type": "constant"},
        "pair": {"teeth": [teeth, teeth], "module_mm": 2.0},
        "rack": {"tip_radius": 0.3},
        "output": {"files": ["stl"]},
    }


@pytest.mark.parametrize(
    "name", [*WHEELS, *(pytest.param(name, marks=pytest.mark.slow) for name in MORE)]
)
def test_fillets_against_denser_points(name: str) -> None:
    """Sixteen times as many: what is left then is 250 times less."""
    design = gearcam.load(PROFILES / f"{name}.toml")
    own, dense = (
        gearcam.build(design, gearcam.Tolerances(oversampling=count)).parts_subject.tools
        for count in (8, 128)
    )
    for found, finer in zip(own, dense, strict=True):
        true = abs(found.inner_radius - finer.inner_radius)
        told = found.inner_error + finer.inner_error
        demand_honest(told, true, found.inner_radius)
        assert abs(found.slot - finer.slot) <= found.slot_error + finer.slot_error


def test_a_cam_tells_it_and_corners_do_not() -> None:
    made = gearcam.build(gearcam.load(PROFILES / "undercut_cam.toml"))
    assert made.part_subject.tools[0].diameter == 0.0 or "tool_mm" in made.facts["accuracy"]
    sharp = ToolLimits(inner_radius=0.0, inner_place=(0.0, 0.0), slot=2.0, slot_place=(0.0, 0.0))
    free = ToolLimits(inner_radius=math.inf, inner_place=None, slot=math.inf, slot_place=None)
    assert tool_errors([sharp, free]) == {}
