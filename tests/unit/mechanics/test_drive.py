"""A speed of the driver turns derivatives by its position into derivatives by time."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError

OMEGA = 300.0 * math.pi / 30.0


def with_speed(name: str, **changes: Any) -> Any:
    return gc.build(gc.load(f"profiles/{name}.toml").with_(changes))


def test_a_cycloidal_rise_by_its_closed_forms() -> None:
    text = """
kind = "cam"
name = "plate"
motion = [
    { type = "rise", angle_deg = 120, law = "cycloidal", lift_mm = 10 },
    { type = "dwell", angle_deg = 60 },
    { type = "return", angle_deg = 120, law = "cycloidal" },
    { type = "dwell", angle_deg = "rest" },
]
follower = { type = "roller", roller_radius_mm = 8 }
cam = { prime_radius_mm = 42, thickness_mm = 10 }
drive = { speed_rpm = 300 }
"""
    facts = gc.build(gc.loads(text)).facts
    time = (2 * math.pi / 3) / OMEGA
    assert facts["motion.peak_velocity_mm_s"] == pytest.approx(2 * 10 / time, rel=1e-12)
    assert facts["motion.peak_acceleration_mm_s2"] == pytest.approx(2 * math.pi * 10 / time**2)
    assert facts["motion.peak_jerk_mm_s3"] == pytest.approx(4 * math.pi**2 * 10 / time**3)


@pytest.mark.parametrize(
    ("name", "key", "unit", "per"),
    [
        ("plate_cam_oscillating", "speed_rpm", "deg", "rad"),
        ("translating_cam", "speed_mm_s", "mm", "mm"),
        ("groove_cam", "speed_rpm", "mm", "rad"),
    ],
)
def test_columns_and_charts_in_time_stand_beside_the_others(
    name: str, key: str, unit: str, per: str
) -> None:
    result = with_speed(name, **{f"drive.{key}": 300.0})
    speed = OMEGA if key == "speed_rpm" else 300.0
    table = result.motion()
    for what, power in (("velocity", ""), ("acceleration", "2"), ("jerk", "3")):
        by_place = next(one for one in table if one.startswith(f"{what}_{unit}_per_{per}"))
        in_time = table[f"{what}_{unit}_s{power}"]
        assert in_time == pytest.approx(table[by_place] * speed ** int(power or 1), rel=1e-13)
        chart = result.chart(f"{what}_in_time")
        assert chart.y == f"{what}, {unit}/s{power}"
        assert chart.lines[0].y.max() >= in_time.max()
    assert not any("_in_time" in one for one in with_speed(name).charts)


def test_the_driven_wheel_has_the_slope_of_its_angle_over_time() -> None:
    result = with_speed("ellipse", **{"drive.speed_rpm": 300.0})
    phi1 = np.linspace(0.0, 2.0 * math.pi, 1000)
    step = 1e-5
    (before, after), here = (
        (result.motion(phi1 + one) for one in (-step, step)),
        result.motion(phi1),
    )
    for value, rate, factor in (
        ("phi2_deg", "speed_rpm", math.radians(1.0) * 30.0 / math.pi),
        ("speed_rpm", "acceleration_rad_s2", math.pi / 30.0),
        ("acceleration_rad_s2", "jerk_rad_s3", 1.0),
    ):
        slope = factor * (after[value] - before[value]) * OMEGA / (2.0 * step)
        assert slope == pytest.approx(here[rate], rel=1e-5, abs=1e-5 * abs(here[rate]).max())
    facts = result.facts
    assert facts["pair.driven_speed_rpm.max"] == pytest.approx(300.0 * facts["pair.ratio.max"])
    most = facts["pair.driven_acceleration_max_rad_s2"]
    assert most == pytest.approx(abs(here["acceleration_rad_s2"]).max(), rel=1e-4)


def test_a_rack_moves_in_mm_per_s() -> None:
    facts = with_speed("feeder", **{"drive.speed_rpm": 300.0}).facts
    assert facts["pair.rack_velocity_mm_s.max"] == pytest.approx(
        OMEGA * facts["pair.radius_mm.max"]
    )


@pytest.mark.parametrize("key", ["speed_deg_s", "speed"])
def test_another_unit_is_refused_with_the_key_that_works(key: str) -> None:
    with pytest.raises(DesignError, match="speed_rpm"):
        gc.load("profiles/eccentric_cam.toml").with_({f"drive.{key}": 100.0})


@pytest.mark.parametrize("speed", [0.0, -1.0, math.nan, 1e7])
def test_a_speed_beyond_its_range_is_refused(speed: float) -> None:
    with pytest.raises(DesignError):
        gc.load("profiles/eccentric_cam.toml").with_({"drive.speed_rpm": speed})
