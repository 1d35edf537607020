"""The keys that `coarse-rows` names lift the warning with the values that it names."""

from __future__ import annotations

import math
import re
from itertools import product
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.kinds.cam.result import CamResult
from helpers_sampling import chosen

NAMED = re.compile(r"With ([\w.]+) = ([\d.e-]+) ")


def design(rows: int, noise: float, *, swings: bool) -> Any:
    """A cam by rows of a cycloidal lift and return, with noise in parts of the lift."""
    theta = np.linspace(0.0, 360.0, rows, endpoint=False)
    up = np.clip(theta / 120.0, 0.0, 1.0) - np.clip((theta - 180.0) / 120.0, 0.0, 1.0)
    lift = up - np.sin(2 * math.pi * up) / (2 * math.pi)
    lift += noise * np.random.default_rng(rows).standard_normal(rows)
    follower: dict[str, Any] = {"type": "roller", "roller_radius_mm": 8}
    if swings:
        follower |= {"motion": "oscillating", "arm_mm": 80, "pivot_distance_mm": 90}
    return gearcam.design(
        {
            "kind": "cam",
            "name": "rows",
            "motion": {"theta_deg": theta, "lift_deg" if swings else "lift_mm": 10.0 * lift},
            "follower": follower,
            "cam": {"prime_radius_mm": 45},
            "output": {"files": ["csv"]},
        }
    )


def warning(result: CamResult) -> Any:
    return next((one for one in result.findings if one.code == "coarse-rows"), None)


@pytest.mark.parametrize(
    "swings",
    [False, pytest.param(True, marks=pytest.mark.slow)],
    ids=["translating", "oscillating"],
)
@pytest.mark.parametrize(
    ("rows", "noise", "scattered"),
    [
        (30, 0.0, False),
        (90, 1e-3, True),
        pytest.param(180, 4e-4, True, marks=pytest.mark.slow),
        pytest.param(360, 5e-3, True, marks=pytest.mark.slow),
        pytest.param(720, 1e-3, True, marks=pytest.mark.slow),
    ],
)
def test_the_values_that_are_named_lift_the_warning(
    rows: int, noise: float, scattered: bool, swings: bool
) -> None:
    asked = design(rows, noise, swings=swings)
    named = dict(NAMED.findall(warning(gearcam.build(asked)).message))
    smooth = f"motion.smoothing_tolerance_{'deg' if swings else 'mm'}"
    keys = [*([smooth] if scattered else []), "output.chord_tolerance_mm"]
    assert list(named) == keys
    for key, value in named.items():
        assert warning(gearcam.build(asked.with_({key: float(value)}))) is None
    # the chord tolerance is the least of two digits
    finer = 0.9 * float(named["output.chord_tolerance_mm"])
    assert warning(gearcam.build(asked.with_({"output.chord_tolerance_mm": finer}))) is not None


@pytest.mark.parametrize(
    ("rows", "noise"),
    chosen(product((90, 180, 360), (4e-4, 1e-3, 5e-3)), (90, 5e-3), (180, 1e-3)),
)
def test_the_smoothing_that_is_named_brings_the_lift_nearer(rows: int, noise: float) -> None:
    """It is about as large as the scatter: a larger one would cut off more than the scatter."""
    asked, exact = (gearcam.build(design(rows, part, swings=False)) for part in (noise, 0.0))
    value = float(dict(NAMED.findall(warning(asked).message))["motion.smoothing_tolerance_mm"])
    smooth = gearcam.build(asked.design.with_({"motion.smoothing_tolerance_mm": value}))
    theta = np.linspace(0.0, 2.0 * math.pi, 2001)
    true, rough, found = (one.program.derivatives(theta, 0)[0] for one in (exact, asked, smooth))
    at = np.radians(np.linspace(0.0, 360.0, rows, endpoint=False))
    scatter = np.abs([one.program.derivatives(at, 0)[0] for one in (asked, exact)])
    assert value < 1.5 * np.abs(scatter[0] - scatter[1]).max()
    assert np.abs(found - true).max() < np.abs(rough - true).max()


def test_a_value_that_would_not_help_is_not_named() -> None:
    """Twelve rows are too few whatever their smoothing; the error is larger than any tolerance."""
    found = warning(gearcam.build(design(12, 0.0, swings=False)))
    assert found.value > 1.0
    assert NAMED.findall(found.message) == []
