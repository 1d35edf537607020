"""Conjugate cams: reference values, and a follower that finds the same lift on both."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gearcam.cams.conjugate import ConjugateCam, SecondRoller, make_conjugate
from gearcam.cams.follow import follow
from gearcam.cams.placing import make_round_follower
from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.cams.wall import Wall
from gearcam.laws.program import Program
from helpers_cams import TURN, angles, back, dwell, program, rise, sizes_of
from witness.cam_sweep import Follower
from witness.follower import rest

POINT = 2e-9
"""mm: profile points, printed with 13 digits at most, and lifts."""


def motion(*, swings: bool = False) -> Program:
    law = "cycloidal" if swings else "3-4-5"
    return program(
        [
            rise("cycloidal", 120, 20, swings=swings),
            dwell(60),
            back(law, 120),
            dwell(60),
        ],
        swings=swings,
    )


def sliding(offset: float = 0.0, *, clockwise: bool = False, **second: Any) -> ConjugateCam:
    follower = FollowerSpec(type="roller", roller_radius=10.0, offset=offset)
    roller = SecondRoller(**({"radius": 8.0, "prime": 40.0} | second))
    found = make_round_follower(follower, CamSpec(prime_radius=40.0))
    return make_conjugate(motion(), found, roller, clockwise=clockwise)


def swinging(*, clockwise: bool = False, **second: Any) -> ConjugateCam:
    follower = FollowerSpec(
        type="roller", motion="oscillating", roller_radius=8.0, arm=90.0, pivot_distance=100.0
    )
    roller = SecondRoller(**({"radius": 8.0, "arm": 85.0, "prime": 38.0} | second))
    found = make_round_follower(follower, CamSpec(prime_radius=40.0))
    return make_conjugate(motion(swings=True), found, roller, clockwise=clockwise)


SLIDING = {
    0.0: [
        [17.96195478828, 26.65844497768, -24.02228034576, -44.19913944477],
        [36.9952503304, 17.23893605617, -35.40183941709, -23.73548686192],
        [48.56501923584, -9.376594919726, -32.29810406777, 4.745697014441],
        [-22.55533901087, -42.49275864199, 18.75809167229, 28.76486705691],
        [-33.61739450893, -9.023200840438, 47.65923019943, 6.407306335147],
    ],
    6.0: [
        [21.63700712188, 23.76656436463, -19.25150928843, -46.32642476765],
        [38.81464390529, 12.53020882946, -32.18890921433, -27.87346506808],
        [47.22308606578, -14.20831415997, -32.63924677911, -0.08941434073015],
        [-26.78732264329, -39.78274317942, 14.37711825019, 31.1380268111],
        [-34.45087562537, -4.229832907864, 46.53901570979, 11.52010408162],
    ],
}
SWINGING = [
    [14, 28.77498913988, 32.31915761016, -49.97048080311, 40, 67.51114937],
    [30.70324452991, 17.6279077684, 4.194834346084, -56.88453855327, 245.1891152, 40.83400439],
    [48.65475016793, -0.7759690091583, -18.26438647067, -42.05289177423, 49.74798848, 46.10705862],
    [47.80920354484, -39.89620941238, -27.83009653507, -13.6717203868, 46.86121341, 1171.237381],
    [-50.81960543775, -32.91752641107, 0.7454240218979, 33.12618292919, 39.75061537, 158.6812498],
    [-38.44988371139, 7.258664526304, 41.93685339425, 34.46843515776, 114.9470351, 38.95213134],
]


def points(made: ConjugateCam, *degrees: float) -> Any:
    """x and y of both profiles at cam angles."""
    found = [wall.places_at(np.radians(degrees))[1] for wall in made.walls]
    return np.column_stack([part for z in found for part in (z.real, z.imag)])


@pytest.mark.parametrize(("offset", "apart"), [(0.0, 100.0), (6.0, 99.0948797331408)])
def test_points_of_translating_cams(offset: float, apart: float) -> None:
    made = sliding(offset)
    assert made.apart == pytest.approx(apart, abs=1e-12)
    assert made.prime2 == pytest.approx(40.0, abs=1e-12)
    found = points(made, 30, 60, 100, 210, 260)
    assert found == pytest.approx(np.array(SLIDING[offset]), abs=POINT)


def test_points_and_radii_of_oscillating_cams() -> None:
    made, degrees = swinging(), (0, 30, 60, 100, 210, 260)
    assert math.degrees(made.apart) == pytest.approx(65.386022742032, abs=1e-11)
    assert math.degrees(made.first.follower.start) == pytest.approx(23.5564643091, abs=1e-10)
    top = -math.degrees(made.second.follower.start) - 20.0
    assert top == pytest.approx(21.82955843293, abs=1e-10)
    expected = np.array(SWINGING)
    assert points(made, *degrees) == pytest.approx(expected[:, :4], abs=POINT)
    radii = [wall.motion(np.radians(degrees))["rho_pitch"] for wall in made.walls]
    assert np.column_stack(radii) == pytest.approx(expected[:, 4:], rel=1e-9)


def ends(wall: Wall, kind: str) -> list[tuple[float, float]]:
    """Smallest and largest pressure angle with their cam angles, deg."""
    found = wall.pressure(kind)
    assert found is not None
    return [(math.degrees(one.value), math.degrees(one.theta)) for one in (found.low, found.high)]


def test_pressure_angles_of_translating_cams() -> None:
    made = sliding()
    expected = [
        (made.first, "rise", 1, 21.2230262012, 55.082884),
        (made.second, "rise", 0, -21.2230262012, 64.917116),
        (made.first, "return", 0, -20.0305535602, 245.67548),
        (made.second, "return", 1, 20.0305535602, 234.32452),
    ]
    for wall, kind, end, angle, place in expected:
        assert ends(wall, kind)[end] == (
            pytest.approx(angle, abs=5e-11),
            pytest.approx(place, abs=5e-6),
        )
        bend = wall.pitch_curvature("rise")
        assert bend is not None
        assert 1.0 / bend.high.value == pytest.approx(38.85675067583, abs=5e-11)


def test_pressure_angles_with_an_offset() -> None:
    made = sliding(6.0)
    one, two = ([end for end, _ in ends(wall, "rise")] for wall in made.walls)
    assert one == pytest.approx([-8.62692655868, 14.9716770655], abs=5e-11)
    assert two == pytest.approx([-14.9716770655, 8.62692655868], abs=5e-11)
    one, two = ([end for end, _ in ends(wall, "return")] for wall in made.walls)
    assert one == pytest.approx([-26.3082343083, -5.75370350227], abs=5e-11)
    assert two == pytest.approx([5.75370350227, 26.3082343083], abs=5e-11)
    for wall in made.walls:
        bend = wall.pitch_curvature("rise")
        assert bend is not None
        assert 1.0 / bend.high.value == pytest.approx(37.95527798323, abs=5e-11)


def test_pressure_angles_of_oscillating_cams() -> None:
    """Those of the second are told with the other sign than in its own mirror."""
    made = swinging()
    one, two = ([end for end, _ in ends(wall, "rise")] for wall in made.walls)
    assert one == pytest.approx([-2.38801546327, 33.5573097724], abs=5e-11)
    assert two == pytest.approx([-28.2980327262, 11.8902196569], abs=5e-11)
    one, two = ([end for end, _ in ends(wall, "return")] for wall in made.walls)
    assert one == pytest.approx([-25.8704170022, 14.2736724161], abs=5e-11)
    assert two == pytest.approx([-8.93618394375, 31.8045503326], abs=5e-11)
    places = [ends(made.first, "rise")[1][1], ends(made.second, "rise")[0][1]]
    places += [ends(made.first, "return")[0][1], ends(made.second, "return")[1][1]]
    assert places == pytest.approx([59.999722, 58.837674, 252.47995, 225.60529], abs=5e-6)


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("kind", ["centred", "offset", "swinging"])
def test_a_follower_finds_the_same_lift_on_both(kind: str, *, clockwise: bool) -> None:
    """The second cam is put upside down, or in a mirror, under a witness that knows one roller."""
    made = (
        swinging(clockwise=clockwise)
        if kind == "swinging"
        else sliding(6.0 * (kind == "offset"), clockwise=clockwise)
    )
    theta, found = angles(60), []
    for wall in made.walls:
        # seen as if the cam turned counter-clockwise; below the axis, in a mirror, the other way
        runs = [run.points for whole in wall.contour.runs for run in whole.pieces]
        if clockwise:
            runs = [-np.conj(one) for one in runs]
        m, sign = sizes_of(wall.follower), -1.0 if wall.follower.below else 1.0
        if wall.follower.below:
            runs = [np.conj(one) for one in runs]
        own = Follower(
            size=wall.follower.prime_radius, swings=m.oscillating, radius=m.radius,
            offset=m.offset, arm=m.arm, pivot=m.pivot,
        )  # fmt: skip
        found.append(sign * rest(runs, own, sign * theta).position - m.start)
    lever = made.first.follower.lever
    assert np.abs(found[0] - found[1]).max() * lever < 1e-9
    assert np.abs(found[0] - made.first.program.derivatives(theta, 0)[0]).max() * lever < 1e-9


@pytest.mark.parametrize("made", [sliding(), sliding(-6.0), swinging()], ids=["0", "-6", "swings"])
def test_follow_finds_it_within_the_chords(made: ConjugateCam) -> None:
    theta = np.linspace(0.0, TURN, 91)
    lever = made.first.follower.lever
    for wall in made.walls:
        found = follow(wall.outline, wall.follower, theta)
        off = (found.lift - wall.program.derivatives(theta, 0)[0]) * lever
        assert np.abs(off).max() < 1.5 * wall.tolerance
        # it falls towards the axis between points
        assert (off.min() if wall is made.first else -off.max()) < -0.5 * wall.tolerance
        assert np.array_equal(found.theta, theta)
        turned = found.contact * np.exp(1j * theta)
        assert np.all((turned.imag > 0.0) == (wall is made.first)) or lever > 1.0


def test_the_second_roller_by_its_distance_or_angle() -> None:
    for made, given in ((sliding(6.0), sliding), (swinging(), swinging)):
        extra: dict[str, Any] = {"offset": 6.0} if given is sliding else {}
        again = given(**extra, prime=None, apart=made.apart)
        assert again.prime2 == pytest.approx(made.prime2, abs=1e-12)
        assert again.second.outline == pytest.approx(made.second.outline, abs=1e-10)


def test_preload_brings_the_rollers_together_not_the_cams() -> None:
    made, loose = sliding(preload=0.05), sliding()
    assert made.apart == pytest.approx(loose.apart - 0.05, abs=1e-12)
    assert np.array_equal(made.second.outline, loose.second.outline)
    given = sliding(prime=None, apart=99.95, preload=0.05)
    assert given.apart == pytest.approx(99.95, abs=1e-12)
    assert given.second.outline == pytest.approx(loose.second.outline, abs=1e-10)
    arms = swinging(preload=0.05).apart - swinging().apart
    assert arms * 85.0 == pytest.approx(-0.05, abs=1e-12)


@pytest.mark.parametrize("name", ["constant-velocity", "constant-acceleration"])
def test_a_centred_pair_is_symmetric(name: str) -> None:
    """With equal sizes and a return that is its rise, cam 2 is cam 1 turned by half a turn and
    the dwells exchanged: here they are equal.
    """
    there = program([rise(name, 120, 8), dwell(60), back(name, 120), dwell(60)])
    found = make_round_follower(
        FollowerSpec(type="roller", roller_radius=5.0), CamSpec(prime_radius=40)
    )
    made = make_conjugate(there, found, SecondRoller(radius=5.0, prime=40.0))
    one, two = made.walls
    assert two.size.area == pytest.approx(one.size.area, rel=1e-12)
    assert two.size.perimeter == pytest.approx(one.size.perimeter, rel=1e-12)
    assert two.shortfall == pytest.approx(one.shortfall, abs=1e-9)
    assert bool(two.corners) == bool(one.corners)
    assert two.profile_radius == pytest.approx(one.profile_radius, rel=1e-9)
    turned = replace(two, key="")
    theta = angles(12)
    places = [wall.places_at(at) for wall, at in ((one, theta), (turned, theta + math.pi))]
    assert len(places[0][0]) == len(places[1][0])
    assert places[0][1] == pytest.approx(places[1][1], abs=1e-9)
