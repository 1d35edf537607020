"""The lift of a follower on a measured profile: from a cam to its radii, and back to its lift."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from gearcam.base.errors import InfeasibleError
from gearcam.cams.caliper import caliper, wheel
from gearcam.cams.carriers import unit
from gearcam.cams.disc import DiscCam, make_cam
from gearcam.cams.follow import follow
from gearcam.cams.followers import Stem
from gearcam.cams.measured import MeasuredProfile, demand_reached
from gearcam.cams.three_points import three_point_curvature
from gearcam.laws.motion_table import program_of_rows
from gearcam.laws.program import Program
from helpers_cams import KINDS, cam, lever
from helpers_sampling import few

Array = NDArray[np.float64]

THETA = np.linspace(0.0, 2.0 * math.pi, 1501)


def measured(made: DiscCam, step: float, off: Any = 0.0, tolerance: float = 0.0) -> MeasuredProfile:
    """A cam by its radii every so many degrees, each of them `off` by a little."""
    angles = np.radians(np.arange(0.0, 360.0, step))
    radii = caliper(made, angles) + off
    curve = program_of_rows(angles, radii, np.zeros(len(angles)), tolerance)
    return MeasuredProfile(
        curve=curve, count=len(angles), follower=made.follower, clockwise=made.clockwise
    )


def missed(made: DiscCam, program: Program) -> Array:
    """How far lift and three derivatives are from those of the cam, at most."""
    pairs = zip(made.program.derivatives(THETA, 3), program.derivatives(THETA, 3), strict=True)
    return np.array([np.abs(one - other).max() for one, other in pairs])


@pytest.mark.parametrize("kind", few(KINDS))
def test_the_lift_comes_back_from_the_radii_within_the_stated_error(kind: str) -> None:
    """The jerk jumps: of half the steps the error is an eighth, more or less; of cams cw too."""
    errors = []
    for clockwise, step in ((False, 2.5), (True, 1.25), (False, 0.625)):
        made = cam(kind, "cycloidal", 6.0, clockwise=clockwise)
        program = measured(made, step).program
        off = missed(made, program)
        assert np.all(off < 1.5 * np.array(program.errors))
        errors.append(lever(made) * off)
    assert errors[0][0] < 5e-4
    assert np.all(errors[2][:2] < errors[0][:2] / (16.0, 4.0))


def test_a_smooth_profile_comes_back_to_nine_digits() -> None:
    """An eccentric disc below a flat face: 72 radii, lift 12 mm, all derivatives 6 mm at most."""
    made = make_cam(_sine(), cam("flat", base_radius=25.0).follower)
    program = measured(made, 5.0).program
    assert np.all(missed(made, program) < [2e-9, 1e-7, 2e-5, 2e-3])
    assert {one.kind for one in measured(made, 5.0).standing(0.0).stretches} == {"rise", "return"}


def _sine() -> Program:
    theta = np.radians(np.arange(0.0, 360.0, 1.0))
    return program_of_rows(theta, 6.0 - 6.0 * np.cos(theta), np.zeros(360), 0.0)


@pytest.mark.parametrize("kind", KINDS)
def test_each_lift_is_where_the_follower_rests_on_a_fine_polygon(kind: str) -> None:
    """The follower comes down on 100000 chords, without a derivative."""
    profile = measured(cam(kind, "3-4-5", 6.0), 3.0)
    phi = np.linspace(0.0, 2.0 * math.pi, 100_000, endpoint=False)
    points = profile.radius(phi)[0] * np.exp(1j * phi)
    found = follow(points, profile.follower, profile.theta[::20])
    off = lever(cam(kind, "3-4-5", 6.0)) * (profile.lift[::20] - found.lift)
    assert np.abs(off).max() < 2e-7


def test_the_radii_of_another_follower_give_another_lift() -> None:
    made = cam("roller", "3-4-5", 6.0)
    other = replace(measured(made, 2.0), follower=replace(made.follower, start=29.0, radius=5.0))
    assert missed(made, other.program)[0] > 0.01
    assert missed(made, replace(measured(made, 2.0), clockwise=True).program)[0] > 1.0


def test_rounded_radii_come_back_within_their_tolerance() -> None:
    """Hundredths of a millimetre, degree by degree: the jerk through them is their scatter."""
    made = cam("roller", "3-4-5", 6.0, clockwise=True)
    angles = np.radians(np.arange(0.0, 360.0, 1.0))
    radii = caliper(made, angles)
    rounding = np.round(radii, 2) - radii
    jerk = np.abs(made.program.derivatives(THETA, 3)[3]).max()
    assert missed(made, measured(made, 1.0, rounding).program)[3] > 50 * jerk
    smooth = measured(made, 1.0, rounding, tolerance=0.01)
    off = missed(made, smooth.program)
    assert off[0] < 0.012
    assert off[3] < jerk
    kinds = [one.kind for one in smooth.standing(0.01).stretches]
    assert kinds.count("dwell") >= 2
    assert len(kinds) < 8


def test_a_hollow_that_the_follower_does_not_reach_is_refused_at_its_bottom() -> None:
    """A dent of 0.6 mm around 135 deg: r^3/(r*r'' - r^2) with r'' = 4*0.6*4.5^2."""
    made = cam("roller", "3-4-5", 6.0)
    angles = np.arange(0.0, 360.0, 2.0) - 135.0
    dent = np.where(np.abs(angles) < 20.0, 0.6 * np.cos(np.radians(4.5 * angles)) ** 4, 0.0)
    profile = measured(made, 2.0, -dent)
    reach = 23.4**2 / (4 * 0.6 * 4.5**2 - 23.4)
    assert profile.hollow == pytest.approx(reach, rel=0.03)

    def below(radius: float) -> MeasuredProfile:
        return replace(profile, follower=Stem(start=24.0 + radius, radius=radius))

    height, angle = below(1.5 * reach).highest
    assert height > 0.005
    assert math.degrees(angle) % 360.0 == pytest.approx(135.0, abs=1.5)
    with pytest.raises(InfeasibleError, match="does not reach the measured profile") as told:
        demand_reached(below(1.5 * reach), lambda _: "line 7", "follower.roller_radius_mm", 0.0)
    assert told.value.where == "motion.file, line 7"
    assert below(0.99 * profile.hollow).highest[0] < 1e-4
    demand_reached(below(0.99 * profile.hollow), lambda _: "", "", 0.0)
    turned = replace(below(1.5 * reach), clockwise=True).highest
    assert turned[0] == pytest.approx(height, rel=0.2)
    assert math.degrees(turned[1]) % 360.0 == pytest.approx(135.0, abs=1.5)


def test_the_tightest_hollow_is_that_of_three_points_of_the_curve() -> None:
    profile = measured(cam("roller", "3-4-5", 16.0), 2.0)
    phi = np.linspace(0.0, 2.0 * math.pi, 20_000, endpoint=False)
    bent = three_point_curvature(profile.radius(phi)[0] * unit(phi))
    assert profile.hollow == pytest.approx(-1.0 / bent.min(), rel=5e-3)
    assert profile.hollow < 400.0


def test_the_lift_of_a_wheel_makes_the_ground_profile() -> None:
    """A roller as large as the wheel, lifted as the table says, envelops the same cam."""
    made = cam("swinging face", "3-4-5", 6.0)
    theta = np.radians(np.arange(0.0, 360.0, 1.0))
    far = wheel(made, 0.5 * math.pi - theta, 20.0)
    program = program_of_rows(theta, far - far[0], np.zeros(360), 0.0)
    ground = make_cam(program, Stem(start=float(far[0]), radius=20.0))
    angles = np.radians(np.arange(0.0, 360.0, 3.7))
    assert np.abs(caliper(ground, angles) - caliper(made, angles)).max() < 2e-5
