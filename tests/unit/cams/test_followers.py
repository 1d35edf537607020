"""Every follower over every carrier, against the moving plane written out in fifty digits."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import mpmath
import numpy as np
import pytest

from gearcam.cams.carriers import Carrier, Rotating, Sliding
from gearcam.cams.followers import Arm, Face, FlatArm, FlatStem, Follower, Round, Stem
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from witness.cam_numbers import Touch

mp: Any = mpmath.mp


@dataclass(frozen=True)
class Case:
    """A follower, its carrier, the witness of both, and the size of its lift."""

    follower: Follower
    carrier: Carrier
    touch: Touch
    lift: float


def turning(follower: Follower, lift: float, **sizes: Any) -> Case:
    return Case(follower, Rotating(), Touch(start=follower.start, **sizes), lift)


CASES = {
    "stem": turning(Stem(start=35.0, offset=8.0, radius=6.0), 10.0, offset=8.0, radius=6.0),
    "stem below the axis": turning(
        Stem(start=-60.0, offset=8.0, radius=6.0), 10.0, offset=8.0, radius=6.0
    ),
    "arm": turning(
        Arm(start=0.55, arm=70.0, pivot=80.0 + 0j, radius=6.0),
        0.3,
        swings=True,
        arm=70.0,
        pivot=80.0,
        radius=6.0,
    ),
    "arm below the axis": turning(
        Arm(start=-0.9, arm=60.0, pivot=80.0 + 0j, radius=6.0),
        0.3,
        swings=True,
        arm=60.0,
        pivot=80.0,
        radius=6.0,
    ),
    "face": turning(FlatStem(start=30.0, offset=3.0), 10.0, flat=True, offset=3.0),
    "swinging face": turning(
        FlatArm(start=0.5, pivot=80.0, offset=7.0),
        0.2,
        flat=True,
        swings=True,
        pivot=80.0,
        face=7.0,
    ),
    "stem over a plate": Case(
        Stem(start=0.0, tilt=0.3, radius=6.0),
        Sliding(7.0),
        Touch(radius=6.0, slide=1, tilt=0.3),
        10.0,
    ),
    "arm over a plate": Case(
        Arm(start=-0.1, arm=60.0, pivot=-70.0 + 6.0j, hand=-1, radius=6.0),
        Sliding(7.0),
        Touch(start=-0.1, swings=True, arm=60.0, pivot=70.0, height=6.0, radius=6.0, slide=1),
        0.2,
    ),
}

PLACES = np.linspace(0.1, 6.1, 7)


@pytest.fixture(params=CASES.values(), ids=list(CASES))
def case(request: pytest.FixtureRequest) -> Case:
    return request.param


def lifts(case: Case) -> list[Array]:
    """Return a cosine lift at the places, and three derivatives."""
    wave = [-np.cos(PLACES), np.sin(PLACES), np.cos(PLACES), -np.sin(PLACES)]
    return [0.5 * case.lift * (part + (k == 0)) for k, part in enumerate(wave)]


def jets(case: Case) -> tuple[Jet, Jet]:
    s, ds, d2s, d3s = lifts(case)
    return Jet([case.follower.start + s, ds, 0.5 * d2s]), Jet([ds, d2s, 0.5 * d3s])


def true(case: Case, function: Callable[[Any, list[Any]], Any]) -> list[complex]:
    with mpmath.workdps(50):
        return [
            complex(function(mp.mpf(x), [mp.mpf(float(part)) for part in found]))
            for x, *found in zip(PLACES, *lifts(case), strict=True)
        ]


def radius(case: Case) -> float:
    return float(case.touch.radius)


def test_points_are_those_of_the_moving_plane(case: Case) -> None:
    s, ds, *_ = lifts(case)
    points, tangents = case.follower.trace(
        case.carrier, PLACES, case.follower.start + s, ds, radius(case)
    )
    assert points == pytest.approx(np.array(true(case, case.touch.contact)), abs=1e-13)
    assert np.abs(tangents) == pytest.approx(1.0, abs=1e-15)


def test_pressure_angle_and_its_slope(case: Case) -> None:
    found = case.follower.contact(case.carrier, *jets(case), radius(case)).pressure.derivatives()
    exact = np.real(true(case, lambda _, state: case.touch.pressure(state)))
    assert found[0] == pytest.approx(exact, abs=1e-15)

    def at(x: Any) -> Any:
        half = mp.mpf(case.lift) / 2
        state = [half * (1 - mp.cos(x)), half * mp.sin(x), half * mp.cos(x), -half * mp.sin(x)]
        return case.touch.pressure(state)

    with mpmath.workdps(50):
        slopes = [float(mp.diff(at, mp.mpf(float(x)))) for x in PLACES]
    assert found[1] == pytest.approx(slopes, abs=1e-14)


def test_speed_and_turning_are_derivatives_of_the_points(case: Case) -> None:
    """The speed is along the tangent, which turns clockwise."""
    contact = case.follower.contact(case.carrier, *jets(case), radius(case))

    def point(x: Any) -> Any:
        half = mp.mpf(case.lift) / 2
        state = [half * (1 - mp.cos(x)), half * mp.sin(x), half * mp.cos(x), -half * mp.sin(x)]
        return case.touch.contact(x, state)

    s, ds, *_ = lifts(case)
    _, tangents = case.follower.trace(
        case.carrier, PLACES, case.follower.start + s, ds, radius(case)
    )
    with mpmath.workdps(50):
        moves = [[complex(mp.diff(point, float(x), n)) for n in (1, 2)] for x in PLACES]
    first, second = np.array(moves).T
    assert np.conj(tangents) * first == pytest.approx(contact.speed.c[0] + 0j, abs=1e-12)
    turned = -contact.turning.c[0] * contact.speed.c[0]
    assert (np.conj(tangents) * second).imag == pytest.approx(turned, abs=1e-11)
    assert (np.conj(tangents) * second).real == pytest.approx(contact.speed.c[1], abs=1e-11)


def test_a_jump_is_even_in_its_parameter(case: Case) -> None:
    """Velocities come back from their parameter, which rises; its curve moves at the speed."""
    carrier, follower = case.carrier, case.follower
    p = np.full(5, follower.start + 0.3 * case.lift)
    speeds = np.linspace(-0.9, 0.9, 5) * case.lift
    places = follower.jump(carrier, p, speeds)
    assert np.all(np.diff(places) > 0.0)
    assert follower.velocity(carrier, p, places) == pytest.approx(speeds, abs=1e-13 * case.lift)
    step = 1e-5
    ends = [
        follower.trace(
            carrier, 0.0 * p, p, follower.velocity(carrier, p, places + off), radius(case)
        )
        for off in (-step, 0.0, step)
    ]
    moved = (ends[2][0] - ends[0][0]) / (2.0 * step) * np.conj(ends[1][1])
    speed = follower.jump_speed(carrier, p, radius(case))
    assert moved == pytest.approx(speed + 0j, abs=1e-6)


@pytest.mark.parametrize("off", [1e-6, -1e-6])
def test_an_arm_over_the_axis_knows_its_side(off: float) -> None:
    """The first velocity is ``d*sin(p)`` to all digits, though the centre has only some."""
    arm = Arm(start=0.0, arm=80.0, pivot=80.0 + 0j)
    found = arm.contact(Rotating(), Jet([np.array([off]), 0.0]), Jet([np.array([0.0]), 0.0]), 0.0)
    assert found.along.c[0] == pytest.approx(80.0 * math.sin(off), rel=1e-15)


@pytest.mark.parametrize("side", [1, -1])
def test_a_follower_rests_on_a_point(case: Case, side: int) -> None:
    """At a point of its own end, and at the lift that the witness finds there."""
    if side < 0 and isinstance(case.follower, Face):
        pytest.skip("a face rests on one side")
    s, _, *_ = lifts(case)
    touch = replace(case.touch, radius=side * case.touch.radius)
    if touch.away != side:
        pytest.skip("the witness sees this one from the other side")
    end, _ = case.follower.trace(case.carrier, PLACES, case.follower.start + s, 0.0 * s, 5.0 * side)
    for x, z in zip(PLACES, end, strict=True):
        where = case.carrier.placed(Jet.variable(x, 1), complex(z))
        position, room = case.follower.rest(*where, side=side)
        with mpmath.workdps(50):
            exact, slope = (
                float(mp.diff(lambda t, z=z: touch.rested(t, mp.mpc(complex(z))), mp.mpf(x), n))
                for n in (0, 1)
            )
        assert room > 0.0
        assert position.c[0] - case.follower.start == pytest.approx(exact, abs=3e-14)
        assert position.c[1] == pytest.approx(slope, abs=1e-11)


def test_a_centre_stands_where_it_came_from(case: Case) -> None:
    """The pose of the cam brings a point of the pitch curve there; velocities are its changes."""
    follower, carrier = case.follower, case.carrier
    if not isinstance(follower, Round) or follower.start < -0.5:
        pytest.skip("no centre, or below the axis")
    p = follower.start + lifts(case)[0]
    z = carrier.under(PLACES, follower.centre(p))
    x, found, centre = carrier.stand(follower, z, PLACES + 0.3)
    assert centre == pytest.approx(follower.centre(p), abs=1e-13)
    assert x == pytest.approx(PLACES, abs=1e-13)
    assert found == pytest.approx(p, abs=1e-13)
    turn, shift = carrier.frame(PLACES)
    assert turn * z + shift == pytest.approx(follower.centre(p), abs=1e-13)
    ends = [carrier.frame(PLACES + step) for step in (-1e-6, 1e-6)]
    before, after = (turned * z + moved for turned, moved in ends)
    speed = (after - before) / 2e-6
    assert carrier.passing(turn * z + shift) == pytest.approx(speed, abs=1e-7)


def test_discs_out_of_reach_have_no_room() -> None:
    """A disc aside of a roller, and one around the whole arm: it always overlaps."""
    here = Jet([np.array([50.0, 0.0])]), Jet([np.array([0.0, 0.0])])
    assert (CASES["stem"].follower.rest(*here)[1] > 0.0).tolist() == [False, False]
    assert (CASES["stem"].follower.rest(*here, grow=np.array([0.0, 3.0]))[1] > 0.0).tolist() == [
        False,
        True,
    ]
    position, _ = CASES["arm"].follower.rest(*here, grow=np.array([0.0, 150.0]))
    assert np.isinf(position.c[0]).tolist() == [False, True]


def resting_place(case: Case) -> complex:
    """Return a point below a follower's end, off its middle."""
    p = np.array([case.follower.start + 0.5 * case.lift])
    touched, _ = case.follower.trace(case.carrier, 0.0 * p, p, 0.0 * p, radius(case))
    return complex(touched[0])


def test_the_mirror_image_rests_where_the_follower_is_pressed_from_below(case: Case) -> None:
    point = resting_place(case)
    x, y = Jet([np.array([point.real])]), Jet([np.array([point.imag])])
    below = case.follower.rest(x, y, side=-1)[0].c[0]
    other = case.follower.mirrored()
    assert other.rest(x, -y)[0].c[0] == pytest.approx(-below, abs=1e-13)
    assert other.mirrored() == case.follower


@pytest.mark.parametrize("angle", [-2.9, 2.5, math.pi])
def test_a_round_follower_rests_highest_on_a_chord_at_its_own_place(
    case: Case, angle: float
) -> None:
    """Positions on points of a chord, metal to its left, are lower on both sides of that place."""
    if isinstance(case.follower, Face):
        pytest.skip("a face rests on the ends of chords")
    chord = np.array([3.0 * np.exp(1j * angle)], dtype=np.complex128)
    z = np.asarray([resting_place(case)], dtype=np.complex128) - 0.4 * chord
    share = case.follower.on_chord(z, chord, 0.5)
    places = z + (share + np.array([-1e-3, 0.0, 1e-3])) * chord
    rests, room = case.follower.rest(Jet([places.real]), Jet([places.imag]), 0.5)
    assert np.all(room > 0.0)
    before, at, after = np.asarray(rests.c[0])
    assert at > max(before, after)
    assert before == pytest.approx(after, abs=1e-8 * case.lift)


def test_a_follower_moves_as_a_rigid_body(case: Case) -> None:
    """Lines and centre of its symbol at one position are those at another, moved."""
    follower, rise = case.follower, 0.4 * case.lift
    (turn,), (shift,) = follower.moved(np.array([rise]))
    here, there = (follower.symbol(follower.start + s, 50.0, 9.0) for s in (0.0, rise))
    shapes = ([*lines, *([centre] for centre, _ in discs)] for lines, discs in (here, there))
    for before, after in zip(*shapes, strict=True):
        moved = np.array(before) * np.exp(1j * turn) + shift
        assert moved == pytest.approx(np.array(after), abs=1e-13)
    p = np.array([follower.start, follower.start + rise])
    touched, _ = follower.trace(case.carrier, 0.0 * p, p, 0.0 * p, 0.0)
    lines = [np.array(line) for line in there[0]]
    # the centre, or the point touched, is on its lines
    ways = [(one[-1] - one[-2]) / abs(one[-1] - one[-2]) for one in lines]
    off = [
        (np.conj(way) * (touched[1] - one[-1])).imag for way, one in zip(ways, lines, strict=True)
    ]
    assert np.abs(off).min() < 1e-12


@pytest.mark.parametrize("off", [0.0, 1e-9, 0.3])
def test_the_distance_from_the_axis_keeps_its_digits(off: float) -> None:
    """Of an arm as long as the pivot distance it goes to zero with the position."""
    arm = Arm(start=0.5, arm=80.0, pivot=80.0 + 0j)
    assert arm.distance(off) == pytest.approx(160.0 * math.sin(0.5 * off), rel=1e-15)


def test_the_distance_from_the_axis_is_that_of_the_curve(case: Case) -> None:
    if not case.carrier.around:
        pytest.skip("a plate has no axis")
    p = np.array([case.follower.start + 0.2 * case.lift])
    point, tangent = case.follower.trace(case.carrier, 0.0 * p, p, 0.0 * p, 0.0)
    far = (np.conj(tangent) * point).imag if isinstance(case.follower, Face) else np.abs(point)
    assert case.follower.distance(float(p[0])) == pytest.approx(float(far[0]), rel=1e-14)
