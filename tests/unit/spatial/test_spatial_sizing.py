"""The least outer diameter of a cylinder cam."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import pytest

import gearcam as gc
from gearcam.base.errors import InfeasibleError
from helpers_pairs import PROFILES
from helpers_sampling import chosen

TAN30 = math.tan(math.radians(30.0))
DESIGN = gc.load(PROFILES / "cylinder_cam.toml")


def solved(**changes: Any) -> Any:
    keys = {"cam.outer_diameter_mm": "solve", "output.files": ["csv"], "output.studies": []}
    return gc.build(DESIGN.with_(keys | changes))


def test_it_is_the_slope_over_the_tangent_and_the_depth() -> None:
    """For a cylindrical roller: the peak of the modified sine on the return, 140 deg."""
    result = solved(**{"follower.cone_deg": 0})
    speed = 60.0 / math.radians(140.0) * 4.0 * math.pi / (4.0 + math.pi)
    wanted = 2.0 * (speed / TAN30 + 18.0)
    assert result.solution.diameter == pytest.approx(wanted, rel=1e-5)
    assert result.solution.diameter >= wanted
    assert result.solution.decided_by == "pressure-angle"
    assert [one.code for one in result.findings if one.severity != "note"] == []


@cache
def of_the_profile() -> Any:
    """The result with the cone of the profile, to the apex."""
    return solved()


@pytest.mark.parametrize("cone", chosen([0, 5, "apex"], "apex"))
def test_one_that_is_smaller_does_not_keep_the_limit(cone: Any) -> None:
    whole = of_the_profile() if cone == "apex" else solved(**{"follower.cone_deg": cone})
    found = whole.solution.diameter
    smaller = solved(**{"follower.cone_deg": cone, "cam.outer_diameter_mm": found - 0.01})
    assert "pressure-angle" in {one.code for one in smaller.findings}


@pytest.mark.slow
def test_undercut_decides_for_a_large_roller() -> None:
    limits = {"limits.pressure_angle_deg": 80, "follower.cone_deg": 0}
    wide = {"follower.roller_radius_mm": 40, "cam.length_mm": 300, "cam.lowest_mm": 100}
    result = solved(**limits, **wide)
    assert result.solution.decided_by == "undercut"
    largest = result.cam.largest_roller.value
    assert largest == pytest.approx(40.025, rel=1e-4)
    assert largest >= 40.025


def test_a_cam_that_hardly_moves_needs_its_walls() -> None:
    low = {"motion": [{"type": "rise", "law": "cycloidal", "angle_deg": 180, "lift_mm": 1},
                      {"type": "return", "law": "cycloidal", "angle_deg": "rest"}]}  # fmt: skip
    result = solved(**low)
    assert result.solution.decided_by == "thin-wall"
    # bore 40 mm, a wall of 2 mm, depth 18 mm and the floor's clearance
    assert result.solution.diameter == pytest.approx(40.0 + 2 * (2.0 + 18.0 + 0.5))


@pytest.mark.slow
def test_the_solved_design_is_a_file_that_builds_the_same() -> None:
    result = of_the_profile()
    text = result.more_files["solved.toml"].decode()
    again = gc.build(gc.loads(text))
    assert again.design.cam.outer_diameter == result.solution.diameter
    assert again.facts["cam.pressure_angle_deg.max"] == result.facts["cam.pressure_angle_deg.max"]


def test_without_any_it_is_refused() -> None:
    with pytest.raises(InfeasibleError, match="no outer diameter"):
        _ = solved(**{"limits.pressure_angle_deg": 0.01}).cam
