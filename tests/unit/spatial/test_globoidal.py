"""Globoidal cams: walls, undercut and hold against values from elsewhere and a search."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcam.numeric.arrays import Array
from gearcam.spatial.envelope import Roller
from gearcam.spatial.globoidal import GloboidalCam
from helpers_globoidal import INDEX, indexer, reference
from helpers_sampling import few
from witness.roller_of_turret import Wheel

RIGHT = math.radians(1.0)

VALUES = {
    (40, 30): (26.99799582, (36.6460938688, -15.9157613031, -7.4057389183),
               (38.1290237295, -27.255672971, -23.8132775025)),
    (40, 60): (41.34137321, (25.7204786937, -31.3382962377, 7.50787351298),
               (14.2795213063, -37.9437360651, -7.50787351298)),
    (50, 60): (55.7071125, (22.154826856, -21.8499209022, 5.63423495674),
               (7.84517314401, -30.1116033248, -5.63423495674)),
    (52, 80): (51.3619381, (13.2374698848, -30.0913289714, 20.797479811),
               (-2.76501189025, -29.3009316597, 8.82685538578)),
    (45, 100): (20.59857328, (-4.23886749671, -44.3002228593, 29.0283686188),
                (-9.67154407021, -34.5896413636, 12.4093845264)),
}  # fmt: skip
"""Pressure angle, and points of the upper and the lower wall, by place, mm, and cam angle, deg."""


@pytest.mark.parametrize(("x", "angle"), VALUES)
def test_walls_are_those_of_the_tables(x: int, angle: int) -> None:
    pressure, *points = VALUES[x, angle]
    theta, at = np.array([angle * RIGHT]), np.array([[float(x)]])
    for wall, expected in zip(reference().walls, points, strict=True):
        found = wall.contact(theta, at)
        assert np.degrees(found.pressure[0, 0]) == pytest.approx(pressure, abs=1e-8)
        assert found.points[0, 0] == pytest.approx(expected, abs=1e-9)


def test_in_a_dwell_the_walls_are_cones() -> None:
    """The contact is in the plane of both axes, at a roller's radius from its axis."""
    cam, theta = indexer(clearance=0.2), np.radians([130.0, 250.0, 355.0])
    x = np.array([45.0, 50.0, 57.0]) * np.ones((3, 1))
    psi = math.pi / 8  # half a pitch above the middle
    for wall, sign in zip(cam.walls, (1.0, -1.0), strict=True):
        points = wall.contact(theta, x).points
        radius = 100.0 - x * math.cos(psi) + sign * 8.1 * math.sin(psi)
        expected = [
            radius * np.cos(theta)[:, None],
            -radius * np.sin(theta)[:, None],
            x * math.sin(psi) + sign * 8.1 * math.cos(psi),
        ]
        assert points == pytest.approx(np.stack(expected, axis=-1), abs=1e-11)


@pytest.mark.parametrize("law", ["modified-sine", "cycloidal", "4-5-6-7"])
def test_with_a_symmetric_law_the_rib_is_symmetric(law: str) -> None:
    """Turned over about the middle of the index, each wall becomes the other one."""
    cam = indexer(law)
    theta, x = np.radians(np.linspace(-100.0, 220.0, 41)), np.full((41, 1), 50.0)
    upper, lower = cam.walls
    one = upper.contact(theta, x).points[:, 0]
    other = lower.contact(INDEX - theta, x).points[:, 0]
    c, s = math.cos(INDEX), math.sin(INDEX)
    over = np.stack(
        [c * other[:, 0] - s * other[:, 1], -s * other[:, 0] - c * other[:, 1], -other[:, 2]],
        axis=1,
    )
    assert one == pytest.approx(over, abs=1e-9)


def test_the_next_roller_is_the_same_a_turn_later() -> None:
    cam, theta = indexer(), np.radians([10.0, 70.0, 200.0])
    assert cam.angle(theta + 2.0 * math.pi) == pytest.approx(cam.angle(theta) + cam.pitch)
    assert cam.program.derivatives(np.array([0.0]), 1)[1] == pytest.approx([0.0])
    assert [round(math.degrees(one.theta), 9) for one in indexer("harmonic").program.jumps] == [
        0.0, 120.0,
    ]  # fmt: skip


def test_the_largest_pressure_angle_is_that_on_the_line_of_centres() -> None:
    cam = indexer()
    rate = 0.375 * 4.0 * math.pi / (4.0 + math.pi)
    assert math.tan(cam.pressure.value) == pytest.approx(58.0 * rate / 42.0, rel=1e-9)
    assert cam.pressure.x == pytest.approx(58.0)
    assert math.degrees(cam.pressure.theta) == pytest.approx(60.0, abs=1e-6)


def nearest(cam: GloboidalCam, point: Array) -> float:
    """How near the axis of a roller comes to a point, mm, by search."""
    wheel = Wheel(cam.distance, cam.places[1], lambda at: float(cam.angle(np.array([at]))[0]))
    x, y, z = point.tolist()
    return wheel.nearest((x, y, z), *cam.span)


def test_walls_spread_by_as_much_as_differences_say() -> None:
    cam, step = indexer(), 1e-5
    theta, x = np.radians([5.0, 40.0, 70.0, 111.0, 200.0]), np.full((5, 1), 52.0)
    for wall in cam.walls:
        by_x, by_theta = (
            (wall.contact(theta + b, x + a).points - wall.contact(theta - b, x - a).points)
            / (2.0 * step)
            for a, b in ((step, 0.0), (0.0, step))
        )
        area = np.linalg.norm(np.cross(by_x, by_theta), axis=-1)
        assert np.abs(wall.contact(theta, x).spread) == pytest.approx(area, rel=1e-6)


def test_rollers_beyond_the_largest_cut_the_wall() -> None:
    """Just below it a roller only touches the wall where it is critical; just above it cuts it."""
    cam = indexer(distance=74.0, length=40.0)
    for wall in cam.walls:
        assert wall.undercut
        spot = wall.largest_roller
        assert 4.0 < spot.value < 8.0
        for factor, cut in ((0.97, False), (1.1, True)):
            other = replace(cam, roller=Roller(radius=factor * spot.value))
            same = other.walls[cam.walls.index(wall)]
            point = same.contact(np.array([spot.theta]), np.array([[spot.x]])).points[0, 0]
            gap = nearest(other, point) - factor * spot.value
            assert (gap < -1e-5) == cut
            assert cut or abs(gap) < 1e-9


def farthest(cam: GloboidalCam, theta: Array, sign: float) -> tuple[Array, Array]:
    """How far from the middle the nearest roller is held wholly and at a point, by one wall."""
    x = np.linspace(cam.top, cam.reach, 15)[:, None]
    whole, touch = [], []
    for k in range(-2, 3):
        psi = cam.angle(theta) + k * cam.pitch
        eta = np.arctan2(x * cam.program.derivatives(theta, 1)[1], cam.distance - x * np.cos(psi))
        z = np.abs(x * np.sin(psi) + sign * cam.tool.radius * np.cos(eta) * np.cos(psi))
        behind = np.where(np.abs(psi) > 0.5 * math.pi, math.inf, 0.0)
        whole.append(z.max(axis=0) + behind)
        touch.append(z.min(axis=0) + behind)
    return np.min(whole, axis=0), np.min(touch, axis=0)


def held(cam: GloboidalCam) -> list[float]:
    """The least length with whole and with any contact, from the formulas for radial rollers."""
    found = []
    for which in (0, 1):
        worst = 0.0
        for sign in (1.0, -1.0):
            theta, far = np.linspace(0.0, 2.0 * math.pi, 2001), np.zeros(1)
            for _ in range(3):  # the worst place is a corner, where another roller takes over
                far = farthest(cam, theta, sign)[which]
                k = int(far.argmax())
                theta = np.linspace(theta[max(0, k - 1)], theta[min(len(far) - 1, k + 1)], 2001)
            worst = max(worst, float(far.max()))
        found.append(2.0 * worst)
    return found


@pytest.mark.parametrize("stops", few([5, 8, 6, 12]))
def test_the_least_length_that_holds_the_turret(stops: int) -> None:
    cam = indexer(stops=stops, roller=Roller(radius=5.0))
    whole, touch = held(cam)
    assert cam.least_length == pytest.approx(whole, rel=1e-6)
    assert cam.grip == pytest.approx(0.5 * (cam.length - touch), abs=1e-2)
    assert touch < whole
