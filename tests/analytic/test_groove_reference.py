"""Groove cams give numbers that were found without the program, to the printed digits."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gearcam.cams.groove import GrooveCam, make_groove
from gearcam.cams.lost_motion import Rest
from helpers_cams import follower_of, there_and_back

CLEARANCE = 0.1

POINTS = {
    0.0: (6.386666666667, 23.0827422307, 9.613333333333, 34.7445869485, 30.0),
    20.0: (15.04573416893, 19.57913489838, 20.21540432975, 30.51917650837, 208.02825),
    45.0: (25.9917261023, 13.49555065888, 33.28314680907, 23.15190525452, 32.56860435),
    70.0: (32.8692856577, 3.90981448867, 44.50608437017, 7.225672707194, 23.35489691),
    130.0: (20.91077473818, -26.39910393396, 28.42381654735, -35.88405004733, 39.72748786),
    200.0: (-16.78587650344, -28.52138784598, -24.41977455758, -37.90933759547, 24.8762499),
    225.0: (-23.75611432583, -16.90508423649, -35.51875858554, -19.74237167692, 34.05850301),
    250.0: (-24.48737932371, -3.033840149425, -36.55557666947, -2.157134484099, 89.93652456),
}
"""Points of both walls, mm, and the pitch curve's radius of curvature, by cam angle, deg."""


@pytest.fixture(scope="module")
def reference() -> GrooveCam:
    return make_groove(
        there_and_back("cycloidal", 10.0), follower_of("roller, offset"), clearance=CLEARANCE
    )


def steep(**sizes: Any) -> GrooveCam:
    """A groove whose outer wall is the first to be undercut."""
    motion = there_and_back("3-4-5", 25.0, (50.0, 130.0, 50.0, 130.0))
    radius = sizes.pop("radius")
    return make_groove(motion, follower_of("roller", roller_radius=radius), **sizes)


@pytest.mark.parametrize("degrees", POINTS)
def test_points_of_both_walls(reference: GrooveCam, degrees: float) -> None:
    x, y, u, v, rho = POINTS[degrees]
    theta = np.radians([degrees])
    (inner,), (outer,) = (wall.places_at(theta)[1] for wall in reference.walls)
    assert abs(inner - complex(x, y)) < 1e-9
    assert abs(outer - complex(u, v)) < 1e-9
    assert reference.motion.motion(theta)["rho_pitch"][0] == pytest.approx(rho, rel=1e-8)


def test_sizes_of_the_groove(reference: GrooveCam) -> None:
    inner, outer = (wall.size for wall in reference.walls)
    assert inner.perimeter == pytest.approx(183.5756023988, abs=5e-11)
    assert outer.perimeter == pytest.approx(259.60214461567, abs=5e-12)
    assert outer.area - inner.area == pytest.approx(2681.2253694375, abs=5e-11)


@pytest.mark.parametrize(
    ("kind", "most", "at_most", "least", "at_least"),
    [
        ("rise", 0.04411034516122, 64.162011, 0.004540032663897, 21.758743),
        ("return", 0.04040544651286, 202.51415, 0.01104650897936, 251.08132),
    ],
)
def test_curvature_of_the_pitch_curve(
    reference: GrooveCam, kind: str, most: float, at_most: float, least: float, at_least: float
) -> None:
    found = reference.motion.pitch_curvature(kind)
    assert found is not None
    assert found.high.value == pytest.approx(most, rel=1e-12)
    assert found.low.value == pytest.approx(least, rel=1e-12)
    assert math.degrees(found.high.theta) == pytest.approx(at_most, abs=1e-4)
    assert math.degrees(found.low.theta) == pytest.approx(at_least, abs=1e-4)


def test_each_wall_is_undercut_by_its_own_curvature() -> None:
    found = steep(radius=6.0).motion.pitch_curvature()
    assert found is not None
    assert -1.0 / found.low.value == pytest.approx(8.734725049864, abs=1e-11)
    assert 1.0 / found.high.value == pytest.approx(13.58132387939, abs=1e-11)
    rise = steep(radius=6.0).motion.pitch_curvature("rise")
    assert rise is not None
    assert math.degrees(rise.low.theta) == pytest.approx(6.01469868, abs=1e-6)
    assert math.degrees(rise.high.theta) == pytest.approx(41.5965845, abs=1e-6)
    for radius, inner, outer in ((8.7, 0, 0), (8.77, 0, 2), (13.5, 0, 2), (13.7, 2, 2)):
        walls = steep(radius=radius).walls
        assert [len(wall.undercut) for wall in walls] == [inner, outer]


def test_a_convex_place_of_one_wall_is_a_concave_place_of_the_other() -> None:
    inner, outer = (wall.profile_radius for wall in steep(radius=6.0).walls)
    assert inner == pytest.approx((13.58132387939 - 6.0, 8.734725049864 + 6.0), abs=1e-10)
    assert outer == pytest.approx((8.734725049864 - 6.0, 13.58132387939 + 6.0), abs=1e-10)


def test_radii_of_the_outer_wall_are_those_of_its_metal(reference: GrooveCam) -> None:
    theta = np.radians(list(POINTS))
    rho = reference.motion.motion(theta)["rho_pitch"]
    np.testing.assert_allclose(reference.inner.radii(theta), rho - 6.05, rtol=1e-12)
    np.testing.assert_allclose(reference.outer.radii(theta), -(rho + 6.05), rtol=1e-12)


def test_the_play_where_the_follower_rests_is_that_of_two_circles(reference: GrooveCam) -> None:
    """A dwell's walls are circles: the centre stands half the clearance within and beyond."""
    theta = np.radians([135.0, 300.0])
    up, down = (
        Rest(wall=wall, roller=reference.rollers[0]).lift(theta)[0] for wall in reference.walls
    )
    radii = np.array([abs(8.0 + 1j * (math.sqrt(836.0) + 10.0)), 30.0])
    expected = [np.sqrt((radii + half) ** 2 - 64.0) for half in (-0.05, 0.05)]
    np.testing.assert_allclose(up, expected[0] - math.sqrt(836.0), atol=1e-12)
    np.testing.assert_allclose(down, expected[1] - math.sqrt(836.0), atol=1e-12)


def test_the_largest_lost_motion_is_the_clearance_over_the_cosine_to_first_order() -> None:
    alpha = math.radians(31.810726241518)
    for clearance in (1e-2, 1e-3, 1e-4):
        made = make_groove(
            there_and_back("cycloidal", 10.0), follower_of("roller, offset"), clearance=clearance
        )
        play = made.lost_motion.value
        assert play / clearance == pytest.approx(1.0 / math.cos(alpha), rel=0.1 * clearance)
