"""Measures of cams in space: pressure angle, largest roller, the error of the developed plane."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.developed import developed, largest_in_plane
from gearcam.spatial.envelope import Roller
from helpers_sampling import few
from helpers_spatial import reference, swinging

deg = math.radians


@pytest.mark.parametrize(
    ("x", "angle"), [(28.0, 45.65527119077), (34.0, 40.11698578996), (40.0, 35.610133954)]
)
def test_the_pressure_angle_along_the_roller(x: float, angle: float) -> None:
    """Against atan(s'/x) at the peak velocity, 60 deg."""
    found = reference().pressure(x, "rise")
    assert found is not None
    assert math.degrees(found.value) == pytest.approx(angle, abs=1e-9)
    assert math.degrees(found.theta) == pytest.approx(60.0, abs=1e-5)


def test_the_pressure_angle_is_worst_at_the_inner_end() -> None:
    worst = reference().pressure()
    assert worst is not None
    assert (worst.x, math.degrees(worst.value)) == (28.0, pytest.approx(45.65527119077, abs=1e-9))
    assert reference(program=reference().program).pressure(kind="segment") is None


@pytest.mark.parametrize(
    ("x", "in_space", "in_plane"),
    few(
        [
            (28.0, 21.5502758410191, 22.774033472),
            (34.0, 29.9643605376437, 31.956334046),
            (40.0, 39.7178824227032, 42.689588146),
        ],
        3,
    ),
)
def test_the_largest_roller_is_smaller_than_the_developed_plane_allows(
    x: float, in_space: float, in_plane: float
) -> None:
    """In space: roots of w^4 - r*x*s''*w - r^2*s'^2, w^2 = x^2 + s'^2, in 30 digits."""
    cam = reference()
    found = min(wall.least(lambda one: one.vanishing, (x, x)).value for wall in cam.walls)
    assert found == pytest.approx(in_space, abs=1e-10)
    assert largest_in_plane(cam, x) == pytest.approx(in_plane, abs=1e-8)


@pytest.mark.parametrize("half_angle", [0.0, 0.15])
def test_at_the_largest_roller_the_least_spread_is_zero(half_angle: float) -> None:
    cam = reference(half_angle)
    largest = cam.largest_roller
    wider, narrower = (
        reference(half_angle, roller=Roller(radius=r, at=40.0, half_angle=half_angle))
        for r in (largest.value + 1e-6, largest.value - 1e-6)
    )
    assert min(wall.spread.value for wall in wider.walls) < 0.0
    assert min(wall.spread.value for wall in narrower.walls) > 0.0


def second_difference(cam: SpatialCam, theta: float, x: float, radius: float) -> float:
    """Second derivative over the cam angle of the distance of a wall point from the roller."""
    other = replace(cam, roller=Roller(radius=radius, at=40.0))
    point = other.contact(np.array([theta]), np.array([[x]]), 1).points[0, 0]

    def distance(at: float) -> float:
        c, s = math.cos(at), math.sin(at)
        y, z = s * point[0] + c * point[1], point[2]
        lift = float(cam.program.derivatives(np.array([at]), 0)[0][0])
        return math.hypot(y, z - lift)

    h = 1e-4
    return (distance(theta + h) - 2.0 * distance(theta) + distance(theta - h)) / h**2


def test_beyond_it_the_roller_cuts_the_wall_away() -> None:
    """The distance of the wall from the roller's axis has a minimum at its own angle, or not."""
    cam, theta = reference(), deg(24.0)
    assert second_difference(cam, theta, 28.0, 21.5) == pytest.approx(0.101, abs=2e-3)
    assert second_difference(cam, theta, 28.0, 21.6) == pytest.approx(-0.0997, abs=2e-3)


ERRORS = [  # azimuth; at the outside, plane less truth of z, upper and lower wall
    (-20, 0.079341527, -0.033103649),
    (-40, 0.50798652, -0.26969418),
    (-95, 0.069022562, -0.173088),
]


@pytest.mark.parametrize(("azimuth", "upper", "lower"), few(ERRORS, 3))
def test_the_error_of_the_developed_plane(azimuth: float, upper: float, lower: float) -> None:
    """Against differences of z, times the slope of the normal: to first order in the error."""
    for wall, dz in zip(reference().walls, (upper, lower), strict=True):
        theta = np.linspace(-deg(azimuth) - 0.5, -deg(azimuth) + 0.5, 4001)
        found = developed(wall, theta, 2)
        k = int(np.argmin(np.abs(found.azimuth[:, 1] - deg(azimuth))))
        speed = float(wall.cam.program.derivatives(theta[k : k + 1], 1)[1][0])
        wanted = wall.side * dz * 40.0 / math.hypot(40.0, speed)
        assert found.error[k, 1] == pytest.approx(wanted, rel=0.06, abs=2e-4)


def test_the_developed_plane_gives_play_outside_and_jams_at_the_floor() -> None:
    theta = np.linspace(0.0, 2.0 * math.pi, 721)
    for wall in reference().walls:
        error = developed(wall, theta, 9).error
        assert error[:, -1].max() == pytest.approx(0.4974, abs=1e-4)
        assert error[:, 0].min() == pytest.approx(-0.7099, abs=1e-4)


def test_a_dwell_has_no_error_in_the_developed_plane() -> None:
    for wall in (*reference().walls, *swinging().walls):
        assert np.abs(developed(wall, np.array([deg(330.0)]), 5).error).max() < 0.04
    (upper, _) = reference().walls
    assert np.abs(developed(upper, np.array([deg(330.0)]), 5).error).max() < 1e-12
