"""Yoke cams: reference values, and what is known of all of them: breadth, perimeter, both sides."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.cams.disc import YokeCam, make_cam, make_yoke
from gearcam.laws.half_turns import completed
from gearcam.laws.phases_of_lift import Phase, SegmentPhase
from gearcam.laws.program import Program, make_program
from helpers_cams import angles, dwell, follower_of, pieces_of, rise, sizes_of
from witness.cam_sweep import Follower
from witness.follower import rest

POINT = 1e-9
"""mm: profile points."""

PLAIN = ("cycloidal", "3-4-5", "modified-sine", "modified-trapezoid", "4-5-6-7")


def half(*phases: Phase) -> Program:
    return completed(make_program(phases, DEFAULT, half=True))


def reference(name: str = "cycloidal") -> Program:
    return half(dwell(30), rise(name, 120, 20), dwell(30))


def yoke(kind: str, motion: Program | None = None, **sizes: Any) -> YokeCam:
    turns = {"clockwise": sizes.pop("clockwise", False)}
    return make_yoke(make_cam(motion or reference(), follower_of(kind, **sizes), **turns))


def segmented() -> Program:
    """Two segments that pass the ends of the half turn at full speed."""
    one = SegmentPhase(angle=math.pi / 3, to=12.0, velocity=9.0)
    two = SegmentPhase(angle=2 * math.pi / 3, to=20.0, velocity=-6.0, acceleration=3.0)
    return half(one, two)


def test_the_flat_yoke_of_the_reference() -> None:
    made = yoke("flat")
    assert made.breadth == pytest.approx(100.0, abs=1e-12)
    assert made.size.perimeter == pytest.approx(314.15926535898, abs=1e-11)
    assert made.size.area == pytest.approx(7795.0873093058, abs=5e-10)
    found, place = made.face_radius, made.contact_place
    assert found is not None
    assert place is not None
    assert found.low.value == pytest.approx(29.33600516238, abs=5e-11)
    assert math.degrees(found.low.theta) == pytest.approx(117.60641, abs=5e-5)
    assert found.high.value == pytest.approx(70.66399483762, abs=5e-11)
    assert math.degrees(found.high.theta) == pytest.approx(62.393585, abs=5e-5)
    assert place.largest == pytest.approx(19.09859317103, abs=5e-12)
    assert made.face_width == 2.0 * place.largest
    assert made.least_base_radius == pytest.approx(10.66399483762, abs=5e-11)


def points(made: YokeCam, *degrees: float) -> Any:
    _, found, _ = made.places_at(np.radians(degrees))
    return np.column_stack([found.real, found.imag])


def test_points_of_the_flat_yoke() -> None:
    found = points(yoke("flat"), 45, 90, 135, 225, 315)
    assert found == pytest.approx(
        np.array(
            [
                [30.43821284793, 26.48276469109],
                [50, -19.09859317103],
                [40.27246527072, -44.22791342757],
                [-40.27246527072, -44.22791342757],
                [-30.43821284793, 26.48276469109],
            ]
        ),
        abs=POINT,
    )


def test_the_yoke_of_two_rollers() -> None:
    made = yoke("roller", roller_radius=10.0, prime_radius=50.0)
    assert made.breadth == pytest.approx(120.0, abs=1e-12)
    assert (made.face_width, made.least_base_radius) == (None, None)
    expected = [
        [28.86439185732, 28.0784421624],
        [50.47109486011, -3.033144710534],
        [41.97255356596, -42.53918111661],
        [-37.26410415073, 19.42169266],
    ]
    assert points(made, 45, 90, 135, 300) == pytest.approx(np.array(expected), abs=5 * POINT)
    bend, up, down = made.pitch_curvature(), made.pressure("rise"), made.pressure("return")
    assert bend is not None
    assert up is not None
    assert down is not None
    assert 1.0 / bend.high.value == pytest.approx(47.77414595329, abs=5e-11)
    assert math.degrees(up.high.value) == pytest.approx(17.84659183326, abs=5e-11)
    assert math.degrees(up.high.theta) == pytest.approx(85.916282, abs=5e-5)
    assert math.degrees(down.low.value) == pytest.approx(-17.84659183326, abs=5e-11)
    assert math.degrees(down.low.theta) == pytest.approx(274.08372, abs=5e-5)


@pytest.mark.parametrize("name", PLAIN)
def test_both_faces_touch_at_every_angle(name: str) -> None:
    made, theta = yoke("flat", reference(name)), angles(90)
    one, other = (made.program.derivatives(t, 0)[0] for t in (theta, theta + math.pi))
    assert np.abs(one + other - 20.0).max() < 1e-12
    # the support of the profile in two opposite directions, from its own dense points
    _, found, _ = made.places_at(theta)
    turned = [found[:45] * np.exp(1j * theta[:45]), found[45:] * np.exp(1j * theta[:45])]
    assert np.abs(turned[0].imag - turned[1].imag - 100.0).max() < 1e-12
    assert made.size.perimeter == pytest.approx(math.pi * 100.0, abs=1e-10)


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("kind", ["flat", "roller"])
def test_a_follower_rests_on_both_sides_at_the_same_lift(kind: str, clockwise: bool) -> None:
    for motion in (reference(), segmented()):
        made, theta = yoke(kind, motion, clockwise=clockwise), angles(60)
        m = sizes_of(made.follower)
        own = Follower(size=m.start, flat=m.flat, radius=m.radius)
        above, below = (rest(pieces_of(made), own, t).position for t in (theta, theta + math.pi))
        asked = made.program.derivatives(theta, 0)[0]
        assert np.abs(above - m.start - asked).max() < POINT
        assert np.abs(made.breadth - below - m.start - asked).max() < POINT


def test_a_half_turn_is_followed_by_its_opposite() -> None:
    made = segmented()
    assert made.continuity == 2
    assert [(one.kind, round(math.degrees(one.end), 9)) for one in made.stretches] == [
        ("rise", 60.0), ("rise", 180.0), ("return", 240.0), ("return", 360.0),
    ]  # fmt: skip
    theta = angles(40)
    near, far = (np.array(made.derivatives(t, 3)) for t in (theta, theta + math.pi))
    near[0] -= 20.0
    assert np.abs(near + far).max() < 1e-9


def test_a_velocity_that_does_not_join_is_told() -> None:
    made = half(rise("constant-velocity", 180, 20))
    assert [(jump.theta, jump.order) for jump in made.jumps] == [(0.0, 1), (math.pi, 1)]
    assert made.jumps[0].after == pytest.approx(20.0 / math.pi, rel=1e-15)
    assert made.jumps[0].before == -made.jumps[0].after
