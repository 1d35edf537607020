"""What results give as columns, against closed forms: ellipses, involutes, cycloids."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.kinds.cam.result import CamResult
from gearcam.kinds.gear_pair.result import GearPairResult, Side
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.numeric.columns import Columns
from helpers_files import ROLLER, SWINGING
from helpers_pairs import PROFILES, job, profile

E, MODULE, ALPHA = 0.3, 2.0, math.radians(20.0)


@pytest.fixture(scope="module")
def ellipses() -> GearPairResult:
    return job(Ellipse(eccentricity=E), (20, 20), module=MODULE, tolerance=0.01)


@pytest.fixture(scope="module")
def circles() -> GearPairResult:
    return job(Constant(), (20, 30), module=MODULE, tolerance=0.01)


def test_centrodes_are_the_ellipses(ellipses: GearPairResult) -> None:
    found, twice = ellipses.centrodes(50), ellipses.pair.center_distance
    assert {len(values) for values in found.values()} == {50}
    a = 0.5 * twice
    for x, y, r, rho, side in (
        (found["x1_mm"], found["y1_mm"], found["r1_mm"], found["rho1_mm"], -1.0),
        (found["x2_mm"], found["y2_mm"], found["r2_mm"], found["rho2_mm"], -1.0),
    ):
        np.testing.assert_allclose(np.hypot(x, y), r, rtol=1e-12)
        other = np.hypot(x - side * 2.0 * a * E, y)
        np.testing.assert_allclose(r + other, twice, rtol=1e-12)
        bend = (r * (twice - r)) ** 1.5 / (a * a * math.sqrt(1.0 - E * E))
        np.testing.assert_allclose(rho, bend, rtol=1e-10)
    np.testing.assert_allclose(found["r1_mm"] + found["r2_mm"], twice, rtol=1e-12)
    # lengths of fine chords
    fine = ellipses.centrodes(2001)
    speed = np.hypot(np.gradient(fine["x1_mm"]), np.gradient(fine["y1_mm"]))
    assert fine["s_mm"][-1] == pytest.approx(speed.sum() - speed[0], rel=1e-4)


def test_motion_is_the_ellipses_in_closed_form(ellipses: GearPairResult) -> None:
    phi = np.array([0.0, 0.3, 1.0, 2.5, 3.1, 4.0, 6.0, 2.0 * math.pi + 1.0])
    found = ellipses.motion(phi)
    d = 1.0 + E * E + 2.0 * E * np.cos(phi)
    k = 1.0 - E * E
    half = 0.5 * phi
    driven = 2.0 * np.arctan2((1.0 - E) * np.sin(half), (1.0 + E) * np.cos(half))
    np.testing.assert_allclose(found["phi1_deg"], np.degrees(phi))
    np.testing.assert_allclose(np.radians(found["phi2_deg"]) % (2 * np.pi), driven % (2 * np.pi))
    assert found["phi2_deg"][-1] > 360.0
    np.testing.assert_allclose(found["ratio"], k / d, rtol=1e-12)
    slope = 2.0 * E * k * np.sin(phi) / d**2
    np.testing.assert_allclose(found["acceleration_per_rad"], slope, atol=1e-12)
    bend = 2.0 * E * k * (np.cos(phi) / d**2 + 4.0 * E * np.sin(phi) ** 2 / d**3)
    np.testing.assert_allclose(found["jerk_per_rad2"], bend, rtol=1e-9, atol=1e-11)


def test_a_rack_moves_by_the_pitch_radius() -> None:
    result = profile("feeder")
    found, centrodes = result.motion(), result.centrodes()
    np.testing.assert_allclose(found["velocity_mm_per_rad"], centrodes["r1_mm"], rtol=1e-12)
    np.testing.assert_allclose(found["travel_mm"], centrodes["travel_mm"], atol=1e-9)
    step = 1e-4
    around = result.motion(np.array([1.0 - step, 1.0, 1.0 + step]))
    for name, slope in (
        ("travel_mm", "velocity_mm_per_rad"),
        ("velocity_mm_per_rad", "acceleration_mm_per_rad2"),
        ("acceleration_mm_per_rad2", "jerk_mm_per_rad3"),
    ):
        low, _, high = around[name]
        assert around[slope][1] == pytest.approx((high - low) / (2.0 * step), rel=1e-6)


def test_circular_wheels_touch_on_the_line_of_action(circles: GearPairResult) -> None:
    r1, r2 = 10.0 * MODULE, 15.0 * MODULE
    tip1, tip2 = (
        math.sqrt((r + MODULE) ** 2 - (r * math.cos(ALPHA)) ** 2) - r * math.sin(ALPHA)
        for r in (r1, r2)
    )
    ratio = (tip1 + tip2) / (math.pi * MODULE * math.cos(ALPHA))
    assert circles.contact_ratio == pytest.approx(ratio, rel=1e-12)
    ratios = circles.contact_ratios
    np.testing.assert_allclose(ratios["contact_ratio"], ratio, rtol=1e-12)
    arcs = np.radians(ratios["to_deg"] - ratios["from_deg"]) * r1 / (math.pi * MODULE)
    np.testing.assert_allclose(arcs, ratio, rtol=1e-9)
    assert list(ratios["side"]) == [-1] * 20 + [1] * 20
    sides: tuple[tuple[Side, int], ...] = (("drive", -1), ("coast", 1))
    for side, sigma in sides:
        found = circles.contact(np.linspace(0.0, 1.0, 40), side)
        assert set(found["side"]) == {sigma}
        force = found["force_x"] + 1j * found["force_y"]
        way = (found["x_mm"] + 1j * found["y_mm"] - r1) * np.conj(force)
        np.testing.assert_allclose(way.imag, 0.0, atol=1e-10)
        assert way.real.min() > -tip2 - 1e-9
        assert way.real.max() < tip1 + 1e-9
        np.testing.assert_allclose(found["pressure_angle_deg"], 20.0, rtol=1e-12)
        np.testing.assert_allclose(
            np.abs(found["sliding_mm_per_rad"]), np.abs(way.real) * (1.0 + r1 / r2), atol=1e-10
        )
        middle = found["x_mm"] + 1j * found["y_mm"]
        np.testing.assert_allclose(found["contact_radius1_mm"], np.abs(middle), rtol=1e-12)
        np.testing.assert_allclose(found["contact_radius2_mm"], np.abs(middle - r1 - r2))
        np.testing.assert_allclose(found["lag_rad"], 0.0, atol=1e-14)
        assert set(found["pairs"]) == {1, 2}
        for phase in np.unique(found["phi1_deg"]):
            rows = found["phi1_deg"] == phase
            assert set(found["pairs"][rows]) == {rows.sum()}


@pytest.mark.parametrize("wheel", [1, 2])
def test_flanks_of_circular_wheels_are_involutes(circles: GearPairResult, wheel: int) -> None:
    found = circles.gears[wheel - 1].flank_points(9)
    base = (10.0, 15.0)[wheel - 1] * MODULE * math.cos(ALPHA)
    points, normals = found.points, found.normals
    assert points.shape == normals.shape == (2 * (20, 30)[wheel - 1] * 9, 2)
    np.testing.assert_allclose(np.hypot(*normals.T), 1.0, rtol=1e-12)
    # the normal of an involute touches the base circle, and points out of the metal
    moment = points[:, 0] * normals[:, 1] - points[:, 1] * normals[:, 0]
    np.testing.assert_allclose(np.abs(moment), base, rtol=1e-12)
    along = np.sqrt((points**2).sum(axis=1) - base * base)
    np.testing.assert_allclose(found["curvature_per_mm"], 1.0 / along, rtol=1e-9)
    # sigma = +1 where s is larger: counter-clockwise on wheel 1, clockwise on wheel 2
    assert (np.sign(moment) == found["side"] * (1 if wheel == 1 else -1)).all()
    assert (found["tooth"] == np.repeat(np.arange(1, (20, 30)[wheel - 1] + 1), 18)).all()
    assert (found["point"] == np.tile(np.arange(1, 10), len(points) // 9)).all()
    assert (found["side"] == np.tile(np.repeat([1, -1], 9), len(points) // 18)).all()
    for rising in (found["reach_mm"], np.hypot(*points.T)):
        assert (np.diff(rising.reshape(-1, 9), axis=1) > 0.0).all()


@pytest.mark.parametrize("name", ["two_speeds", "feeder", "log_spiral"])
def test_flanks_touch_where_contacts_are(name: str) -> None:
    """Both wheels' points, turned to the phase that they name, are the contact of that phase."""
    result = profile(name)
    for gear in result.gears:
        rows = gear.flank_points(3)
        inner = (rows["point"] == 2) & (rows["side"] == (-1 if gear.wheel == 1 else 1))
        phi1 = np.radians(rows["phi1_deg"][inner])
        inside = (phi1 > 0.0) & (phi1 < result.centrode_angles()[-1])
        phi1, tooth = phi1[inside], rows["tooth"][inner][inside]
        point = (rows["x_mm"] + 1j * rows["y_mm"])[inner][inside]
        found = result.contact(phi1)
        if gear.wheel == 1:
            stands = point * np.exp(-1j * phi1)
        elif result.pair.on_rack:
            stands = point - 1j * result.motion(phi1)["travel_mm"]
        else:
            turn = np.exp(1j * np.radians(result.motion(phi1)["phi2_deg"]))
            stands = point * turn + result.pair.center_distance
        met = 0
        for k, angle in enumerate(np.degrees(phi1)):
            same = (found["phi1_deg"] == angle) & (found[f"tooth{gear.wheel}"] == tooth[k])
            met += same.sum()
            where = (found["x_mm"] + 1j * found["y_mm"])[same]
            np.testing.assert_allclose(where, stands[k], atol=1e-9)
        assert met > 0.8 * len(phi1)


def cam(text: str) -> CamResult:
    return gearcam.build(gearcam.loads(text))


def test_the_motion_of_a_cam_is_its_law() -> None:
    theta = np.radians([10.0, 45.0, 80.0, 120.0])
    found = cam(ROLLER).motion(theta)
    beta, lift = 0.5 * math.pi, 10.0
    x = np.minimum(theta / beta, 1.0)
    w = 2.0 * math.pi
    expected: dict[str, Any] = {
        "lift_mm": lift * (x - np.sin(w * x) / w),
        "velocity_mm_per_rad": lift / beta * (1.0 - np.cos(w * x)),
        "acceleration_mm_per_rad2": lift / beta**2 * w * np.sin(w * x),
        "jerk_mm_per_rad3": lift / beta**3 * w * w * np.cos(w * x) * (x < 1.0),
    }
    for name, values in expected.items():
        np.testing.assert_allclose(found[name], values, rtol=1e-12, atol=1e-12)
    s0 = math.sqrt(30.0**2 - 8.0**2)
    angle = np.arctan2(found["velocity_mm_per_rad"] - 8.0, s0 + found["lift_mm"])
    np.testing.assert_allclose(found["pressure_angle_deg"], np.degrees(angle), rtol=1e-12)
    # on the dwell at the top both curves are circles about the axis
    top = math.hypot(8.0, s0 + 10.0)
    np.testing.assert_allclose(found["rho_pitch_mm"][-1], top, rtol=1e-12)
    np.testing.assert_allclose(found["rho_profile_mm"][-1], top - 6.0, rtol=1e-12)


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
def test_a_roller_touches_where_its_circle_does(rotation: str) -> None:
    made = gearcam.build(gearcam.loads(ROLLER).with_({"cam.rotation": rotation}))
    theta = np.radians([0.0, 20.0, 45.0, 100.0, 200.0, 300.0, 405.0])
    found = made.contact(theta)
    side = 1.0 if rotation == "ccw" else -1.0
    height = math.sqrt(30.0**2 - 8.0**2) + made.motion(theta)["lift_mm"]
    away = side * 8.0 + 1j * height - (found["fixed_x_mm"] + 1j * found["fixed_y_mm"])
    np.testing.assert_allclose(np.abs(away), 6.0, rtol=1e-12)
    pressed = np.degrees(np.arctan2(-side * away.real, away.imag))
    np.testing.assert_allclose(pressed, made.motion(theta)["pressure_angle_deg"], atol=1e-10)
    turn = np.exp(-1j * side * theta)
    np.testing.assert_allclose(found["nx"] + 1j * found["ny"], away * turn / 6.0, atol=1e-12)
    place = (found["fixed_x_mm"] + 1j * found["fixed_y_mm"]) * turn
    points = found.points @ np.array([1.0, 1j])
    np.testing.assert_allclose(points, place, atol=1e-12)
    np.testing.assert_allclose(points[2], points[-1], atol=1e-12)


def test_where_the_follower_rests_on_a_corner_there_is_no_contact() -> None:
    result = gearcam.build(gearcam.load(PROFILES / "undercut_cam.toml"))
    middles = np.array([0.5 * (one.before + one.after) for one in result.cam.corners])
    assert len(middles) > 0
    assert len(result.contact(middles)["theta_deg"]) == 0
    beside = np.array([one.after + 1e-6 for one in result.cam.corners])
    assert len(result.contact(np.append(middles, beside))["theta_deg"]) == len(beside)


def test_an_oscillating_follower_is_told_in_degrees() -> None:
    found = cam(SWINGING).motion([math.radians(150.0), math.radians(240.0)])
    # dwell at 20 deg; half of a 3-4-5 return: 15/8 of the mean velocity
    np.testing.assert_allclose(found["lift_deg"], [20.0, 10.0], rtol=1e-12)
    mean = 20.0 / math.radians(120.0)
    np.testing.assert_allclose(found["velocity_deg_per_rad"], [0.0, -1.875 * mean], atol=1e-12)
    assert isinstance(found, Columns)
