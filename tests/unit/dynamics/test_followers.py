"""Followers on springs: closed forms, reference values, a Fourier series, two methods."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from gearcam.base.errors import InfeasibleError
from gearcam.dynamics.follower import CONTACT, FLIGHT, RELAXED, ElasticFollower
from gearcam.dynamics.follower_motion import Turn, chosen, settle
from gearcam.dynamics.integrate import Integrator
from gearcam.dynamics.periodic import Periodic, elastic_jump, keeping_stiffness

TURN = 2.0 * math.pi
RPM = math.pi / 30.0


def acting(*loads: float):
    """Constant loads on each mass."""
    return lambda x: np.array(loads)[:, None] + np.zeros(x.shape)


def cycloids(x, order):
    """Rise, dwell, return and dwell of a quarter turn each, by 10 mm."""
    t = x % TURN * (2.0 / math.pi)
    side, part = np.where(t < 2.0, 1.0, -1.0), t % 2.0
    moving, s, w = part < 1.0, np.minimum(part, 1.0), 2.0 / math.pi
    rise = [
        s - np.sin(TURN * s) / TURN,
        w * (1.0 - np.cos(TURN * s)),
        w**2 * TURN * np.sin(TURN * s),
    ]
    lift = 10.0 * np.where(side > 0.0, rise[0], 1.0 - rise[0])
    return [lift, *(10.0 * side * np.where(moving, one, 0.0) for one in rise[1 : order + 1])]


def eccentric(e: float, shift: float = 0.0):
    """Lift e*(1 - cos(x - shift))."""
    signs = (lambda x: 1.0 - np.cos(x), np.sin, np.cos)
    return lambda x, order: [e * one(x - shift) for one in signs[: order + 1]]


QUARTERS = np.linspace(0.0, TURN, 5)
TRAIN = ElasticFollower(
    masses=(0.2e-3, 0.5e-3), stiffness=(20000.0, 2000.0), damping=(0.4, 0.1), spring=10.0,
    speed=900.0 * RPM, lift=cycloids, loads=acting(0.0, 200.0), knots=QUARTERS,
)  # fmt: skip
ONE = ElasticFollower(
    masses=(0.5e-3,), stiffness=(2000.0,), damping=(0.1,), spring=10.0, damper=0.02,
    speed=500.0 * RPM, lift=eccentric(5.0), loads=acting(90.0), knots=np.array([0.0, TURN]),
)  # fmt: skip


def harmonic(follower: ElasticFollower, e: float) -> complex:
    """Amplitude of the lag under the lift ``e*exp(1j*x)``: x'' and so on by hand."""
    (m,), (k,), (c,), w = follower.masses, follower.stiffness, follower.damping, follower.speed
    ks, cs = follower.spring, follower.damper
    place = e * (k + 1j * c * w) / (k + ks - m * w**2 + 1j * (c + cs) * w)
    return place - e


def least_force(speed: float, spring: float = 10.0) -> float:
    """Smallest contact force of ONE in closed form."""
    follower = replace(ONE, speed=speed, spring=spring)
    size = abs(-(2000.0 + 0.1j * speed) * harmonic(follower, 5.0))
    return (90.0 + 5.0 * spring) * 2000.0 / (2000.0 + spring) - size


def fourier(follower: ElasticFollower, x, count: int = 4096):
    """Lags of both masses by a Fourier series of the forces that the lift makes."""
    even = TURN * np.arange(count) / count
    y = np.fft.rfft(follower.lift(even, 0)[0]) / count
    n = np.arange(len(y))
    n, y = n[:600], y[:600]
    (m1, m2), (k1, k2), (c1, c2) = follower.masses, follower.stiffness, follower.damping
    w = 1j * n * follower.speed
    a = k1 + c1 * w + k2 + c2 * w + m1 * w**2
    b = k2 + c2 * w
    d = b + follower.spring + follower.damper * w + m2 * w**2
    load = np.where(n == 0, follower.loads(np.zeros(1))[1, 0], 0.0)
    force = (k1 + c1 * w) * y
    det = a * d - b * b
    places = (d * force - b * load) / det, (b * force - a * load) / det
    phase = np.exp(1j * np.outer(n, x)) * np.where(n == 0, 1.0, 2.0)[:, None]
    return [(one @ phase).real for one in places]


def test_natural_frequencies_of_two_masses() -> None:
    assert TRAIN.frequencies == pytest.approx([1908.90150566, 10506.0028099], abs=1e-6)


def test_loss_and_return_of_contact() -> None:
    """The cam drops with 200 m/s2 for 3 ms, then turns up as fast: lost at arctan(1/2)/1000 s."""
    a, end = 2e5, 0.003

    def lift(x, order):
        t = np.where(x < end, -1.0, 1.0)
        down = np.minimum(x, end)
        up = x - down
        found = [
            a * (-0.5 * down**2 - end * up + 0.5 * up**2), a * (up - down), a * t
        ]  # fmt: skip
        return found[: order + 1]

    follower = ElasticFollower(
        masses=(0.5e-3,), stiffness=(2000.0,), damping=(0.0,), speed=1.0, lift=lift,
        loads=acting(40.0), knots=np.array([0.0, end, 0.008]),
    )  # fmt: skip
    for method, off in (("radau", 2e-10), ("dop853", 2e-10)):
        turn = settle(follower, np.array([-0.02, 0.0]), turns=1, method=method, tolerance=1e-8)
        (flight,) = turn.flights
        assert flight.start == pytest.approx(math.atan(0.5) / 1000.0, abs=off)
        assert flight.end == pytest.approx(0.0068406663185377, abs=off)
        assert flight.impact == pytest.approx(691.02428227, abs=1e-5)
        assert turn.energy_residue < 1e-6


TABLE = {300: (198.070, 271.4, 1.0227), 600: (191.428, 272.7, 1.0824),
         900: (120.995, 209.3, 1.0580), 1100: (21.907, 197.7, 1.2318)}  # fmt: skip
"""Smallest contact force, where, and peak acceleration over the rigid one, by rpm; of samples."""


@pytest.mark.parametrize("rpm", TABLE)
def test_the_reference_values(rpm: int) -> None:
    force, place, over = TABLE[rpm]
    follower = replace(TRAIN, speed=rpm * RPM)
    periodic, x = Periodic(follower), TURN * np.arange(4096) / 4096
    states = periodic.at(x)
    sampled = follower.contact_force(states)
    assert sampled.min() == pytest.approx(force, abs=1e-3)
    assert math.degrees(x[sampled.argmin()]) == pytest.approx(place, abs=0.1)
    peak = np.abs(follower.accelerations(x, states, np.ones(x.shape, dtype=bool))[1]).max()
    assert peak / (10.0 * TURN * (2.0 / math.pi) ** 2) == pytest.approx(over, abs=1e-4)
    least, where = periodic.least()
    assert sampled.min() - 5e-3 < least <= sampled.min()
    assert follower.contact_force(periodic.at([where])) == pytest.approx(least)


def test_a_fourier_series_tells_the_same() -> None:
    x = np.linspace(0.01, 6.2, 300)
    places = fourier(TRAIN, x)
    states = Periodic(TRAIN).at(x)
    y = TRAIN.lift(x, 0)[0]
    assert y + states[2] == pytest.approx(places[1], abs=1e-10)
    assert y + states[0] == pytest.approx(places[0], abs=3e-9)


@pytest.mark.parametrize("method", [pytest.param("radau", marks=pytest.mark.slow), "dop853"])
def test_the_integration_keeps_to_the_periodic_motion(method: str) -> None:
    follower = replace(TRAIN, speed=1000.0 * RPM)
    periodic = Periodic(follower)
    turn = settle(follower, periodic.start, method=method, tolerance=1e-9)
    assert turn.turns == 1
    x = np.linspace(0.0, 6.28, 500)
    assert turn.states(x)[0][2] == pytest.approx(periodic.at(x)[2], abs=1.4e-10)
    assert turn.error[1] < 1.4e-10


def test_from_rest_it_comes_to_the_periodic_motion() -> None:
    follower = replace(ONE, damping=(0.6,))
    periodic = Periodic(follower)
    start = np.array([follower.rest(np.zeros(1))[0, 0], 0.0])
    assert np.abs(periodic.start - start).max() > 1e-3
    turn = settle(follower, start, tolerance=1e-8)
    assert 1 < turn.turns < 20
    x = np.linspace(0.0, 6.28, 100)
    assert turn.states(x)[0][0] == pytest.approx(periodic.at(x)[0], abs=1e-6)


@pytest.mark.parametrize("rpm", [1.0, 30.0, 500.0, 1500.0])
def test_a_harmonic_lift_in_closed_form(rpm: float) -> None:
    """Also with a damper beside the spring, and where only the slow motion is followed."""
    follower = replace(ONE, speed=rpm * RPM)
    periodic = Periodic(follower)
    x = np.linspace(0.0, 6.28, 50)
    constant = -(90.0 + 10.0 * 5.0) / 2010.0
    swing = harmonic(follower, 5.0)
    lag = constant - (swing * np.exp(1j * x)).real
    assert periodic.at(x)[0] == pytest.approx(lag, abs=1e-12)
    rate = -(1j * swing * np.exp(1j * x)).real
    assert periodic.at(x)[1] == pytest.approx(rate, abs=1e-11)
    assert (len(periodic.edges) > 16 * follower.periods) == (rpm > 100.0)


@pytest.mark.parametrize("rpm", [2.0, 40.0])
def test_a_load_that_jumps_overshoots(rpm: float) -> None:
    """On a cam that stands, nearly: a damped vibration about the new place behind the jump."""

    def loads(x):
        return np.where(x < 3.0, 100.0, 40.0)[None]

    still = eccentric(0.0)
    follower = replace(
        ONE, speed=rpm * RPM, damper=0.0, lift=still, loads=loads, knots=np.array([0.0, 3.0, TURN])
    )
    periodic = Periodic(follower)
    (m,), (c,), w = follower.masses, follower.damping, follower.speed
    omega = math.sqrt(2010.0 / m)
    ratio = c / (2.0 * m * omega)
    damped = omega * math.sqrt(1.0 - ratio**2)
    t = np.append(np.linspace(0.0, 3e-3, 40), np.linspace(0.01, 0.07, 61))
    fading = np.exp(-ratio * omega * t)
    swing = fading * (np.cos(damped * t) + ratio * omega / damped * np.sin(damped * t))
    expected = -(40.0 + 60.0 * swing) / 2010.0
    assert periodic.at(3.0 + w * t)[0] == pytest.approx(expected, abs=1e-11)
    least = periodic.least()[0]
    assert least < 40.0 * 2000.0 / 2010.0 - 20.0


def test_the_rise_of_constant_acceleration_is_exact_between_knots() -> None:
    """Undamped, from rest: the lag is that of a constant force, then of its opposite."""
    half, a, k = 0.5, 40.0, 2000.0

    def lift(x, order):
        back = np.minimum(x - half, 0.0) + half
        over = x - back
        found = [
            0.5 * a * back**2 + a * half * over - 0.5 * a * over**2, a * (back - over),
            np.where(x < half, a, -a),
        ]  # fmt: skip
        return found[: order + 1]

    follower = ElasticFollower(
        masses=(1.0,), stiffness=(k,), damping=(0.0,), speed=1.0, lift=lift, held=True,
        loads=acting(0.0), knots=np.array([0.0, half, 1.0]),
    )  # fmt: skip
    omega = math.sqrt(k)

    def closed(x):
        behind = np.where(x > half, 1.0 - np.cos(omega * (x - half)), 0.0)
        return -a / k * (1.0 - np.cos(omega * x) - 2.0 * behind)

    x = np.linspace(0.0, 0.999, 200)
    turn = settle(follower, np.zeros(2), turns=1, method="dop853", tolerance=1e-12)
    assert turn.states(x)[0][0] == pytest.approx(closed(x), abs=1e-10)

    integrate = Integrator(method="dop853", rtol=1e-6, atol=(2e-8, 1e-6, 1.0, 1.0))
    start = CONTACT, np.zeros(4)
    with_knots = integrate(follower.modes(0.0), start, [0.0, half, 1.0])
    without = integrate(follower.modes(0.0), start, [0.0, 1.0])
    off, worse = (np.abs(one.at(x)[0] - closed(x)).max() for one in (with_knots, without))
    assert worse > 2.0 * off
    assert without.evaluations > 1.5 * with_knots.evaluations


def test_the_energies_balance() -> None:
    for method in ("radau", "dop853"):
        loaded = replace(TRAIN, loads=acting(50.0, 200.0))
        for follower in (TRAIN, loaded, ONE, replace(TRAIN, speed=1300.0 * RPM)):
            start = Periodic(follower).start
            turn = settle(follower, start, turns=2, method=method, tolerance=1e-6)
            assert turn.energy_residue < 1e-5


def test_a_work_left_out_is_seen() -> None:
    follower = replace(ONE, damping=(1.0,))
    turn = settle(follower, Periodic(follower).start, method="dop853", tolerance=1e-9)
    undamped = replace(follower, damper=0.0)
    lossless = replace(turn, follower=replace(follower, masses=(0.6e-3,)))
    assert turn.energy_residue < 1e-7
    assert lossless.energy_residue > 1e-3
    with_other = settle(undamped, Periodic(undamped).start, method="dop853", tolerance=1e-9)
    assert with_other.energy_residue < 1e-7


def test_the_jump_of_the_elastic_train() -> None:
    """1131.858 rpm by samples in the reference; a little below where the least is found between."""
    found = elastic_jump(TRAIN)
    assert found is not None
    assert found / RPM == pytest.approx(1131.858, abs=2e-3)
    assert Periodic(replace(TRAIN, speed=found)).least()[0] == pytest.approx(0.0, abs=1e-5)
    x = TURN * np.arange(4096) / 4096

    def sampled(speed: float) -> float:
        follower = replace(TRAIN, speed=speed)
        return follower.contact_force(Periodic(follower).at(x)).min()

    reference: Any = brentq(sampled, 1100.0 * RPM, 1150.0 * RPM, xtol=1e-6)
    assert reference / RPM == pytest.approx(1131.858, abs=6e-4)


def test_no_lower_speed_jumps() -> None:
    """At resonances the force falls and rises again: a fine comb of speeds finds none below."""
    follower = replace(TRAIN, damping=(0.08, 0.03), loads=acting(0.0, 30.0))
    found = elastic_jump(follower)
    assert found is not None
    combed = [Periodic(replace(follower, speed=one)).least()[0]
              for one in np.linspace(0.5, 0.9999, 40) * found]  # fmt: skip
    assert min(combed) > 0.0
    assert np.diff(combed).max() > 0.0  # no monotone function
    assert Periodic(replace(follower, speed=1.001 * found)).least()[0] < 0.0


def test_a_resonance_that_jumps_is_not_missed() -> None:
    """Hardly damped, the fourteenth harmonic takes the load off in a narrow range of speeds."""
    one = replace(TRAIN, masses=(0.5e-3,), stiffness=(2000.0,), damping=(0.01,), spring=0.0)
    follower = replace(one, loads=acting(409.0))
    found = elastic_jump(follower)
    assert found is not None
    assert 116.6 < found < 118.6
    assert Periodic(replace(follower, speed=1.04 * found)).least()[0] > 0.0


def test_loads_that_jump_in_step_with_the_vibration() -> None:
    """Far below the speed at which the inertia of this lift could do anything."""
    follower = replace(
        ONE, lift=eccentric(1e-3), loads=lambda x: np.where(x < 3.0, 100.0, 60.0)[None],
        spring=0.0, knots=np.array([0.0, 3.0, TURN]),
    )  # fmt: skip
    found = elastic_jump(follower)
    assert found is not None
    assert 100.0 < found < 1500.0
    assert Periodic(replace(follower, speed=found)).least()[0] == pytest.approx(0.0, abs=1e-5)
    slower = np.linspace(0.5, 0.99, 30) * found
    assert min(Periodic(replace(follower, speed=one)).least()[0] for one in slower) > 0.0


def test_a_harmonic_jump_in_closed_form() -> None:
    assert elastic_jump(ONE) == pytest.approx(brentq(least_force, 50.0, 400.0), rel=1e-9)


def test_where_the_load_pulls_it_jumps_at_all_speeds() -> None:
    assert elastic_jump(replace(ONE, loads=acting(-1.0))) == 0.0
    jumping = replace(
        ONE, loads=lambda x: np.where(x < 3.0, 100.0, 10.0)[None], spring=0.0,
        knots=np.array([0.0, 3.0, TURN]),
    )  # fmt: skip
    assert elastic_jump(jumping) == 0.0  # it overshoots below 0 however slow the cam is


def test_the_least_stiffness_keeps_contact() -> None:
    follower = replace(ONE, speed=230.0)
    found = keeping_stiffness(follower, 0.0, 0.5)
    assert found == pytest.approx(brentq(lambda ks: least_force(230.0, ks) - 0.5, 1.0, 50.0))
    assert Periodic(replace(follower, spring=found)).least()[0] == pytest.approx(0.5, abs=1e-6)
    assert keeping_stiffness(replace(follower, loads=acting(1e4)), 0.0, 0.5) == 0.0


def test_the_least_stiffness_leaves_a_share_of_the_mean_force() -> None:
    """The mean is that at rest: of a harmonic lift the inertia has none."""
    found = keeping_stiffness(replace(ONE, speed=230.0), 0.1, 0.5)

    def spare(ks: float) -> float:
        mean = (90.0 + 5.0 * ks) * 2000.0 / (2000.0 + ks)
        return least_force(230.0, ks) - 0.1 * mean - 0.5

    assert found == pytest.approx(brentq(spare, 1.0, 50.0), rel=1e-6)


def test_the_least_of_the_stiffnesses_that_leave_a_share() -> None:
    """One that is far too stiff leaves less again of a mean force that grows with it."""
    follower = replace(TRAIN, loads=acting(0.0, 30.0), speed=700.0 * RPM)
    found = keeping_stiffness(follower, 0.1, 0.0)

    def spare(ks: float) -> float:
        return Periodic(replace(follower, spring=ks)).spare(0.1)

    assert [spare(share * found) > 0.0 for share in (0.5, 0.999, 1.001, 2.0, 4.0)] == [
        False, False, True, True, False
    ]  # fmt: skip
    assert keeping_stiffness(replace(follower, loads=acting(0.0, 10.0)), 0.1, 0.0) == math.inf


def test_no_spring_is_stiffer_than_the_train() -> None:
    """The speed at which just that of the train would do, and one beyond it."""
    speed: Any = brentq(lambda w: least_force(w, 2000.0), 300.0, 3000.0)
    slower, faster = replace(ONE, speed=0.99 * speed), replace(ONE, speed=1.01 * speed)
    assert 1000.0 < keeping_stiffness(slower, 0.0, 0.0) < 2000.0
    assert keeping_stiffness(faster, 0.0, 0.0) == math.inf


@pytest.mark.parametrize("shift", [0.0, math.pi, 2.0])
def test_flights_that_repeat(shift: float) -> None:
    """Wherever the turn begins, also in flight."""
    speed = 1.1 * (elastic_jump(ONE) or 0.0)
    follower = replace(ONE, damping=(1.0,), lift=eccentric(5.0, shift), speed=speed)
    start = np.array([follower.rest(np.zeros(1))[0, 0], 0.0])
    turn = settle(follower, start, turns=40, tolerance=1e-8)
    assert turn.repeats
    assert (turn.start[0] == CONTACT) == (shift == 0.0)
    first = turn.flights[0]
    width = (first.end - first.start) % TURN
    assert 0.1 < width < 3.0
    middle = (first.start + 0.5 * width - shift) % TURN
    assert abs(middle - math.pi) < 1.5  # behind the highest lift
    assert turn.contact_force([(first.start + 0.5 * width) % TURN]) == 0.0
    assert first.impact > 100.0
    before = turn.contact_force([(first.start - 1e-4) % TURN])
    assert 0.0 < before < 1.0


class Landed(Turn):
    """A turn whose impacts are the places of the landings."""

    def _impact(self, x: float, mode: str | None) -> float:
        assert mode == RELAXED
        return x


def test_an_arc_over_the_end_of_the_turn_is_one() -> None:
    switches = [
        (0.5, RELAXED, CONTACT), (2.0, CONTACT, FLIGHT), (2.1, FLIGHT, RELAXED),
        (3.0, RELAXED, CONTACT), (5.0, CONTACT, FLIGHT), (5.1, FLIGHT, RELAXED),
    ]  # fmt: skip
    motion: Any = SimpleNamespace(switches=switches, mode=RELAXED)
    turn = Landed(
        follower=ONE, motion=motion, start=(RELAXED, np.zeros(4)), method="radau", tolerance=1e-6,
        turns=1, repeats=True,
    )  # fmt: skip
    arcs = [(one.start, one.end, one.impact) for one in turn.flights]
    assert arcs == [(5.0, 0.5, 0.5), (2.0, 3.0, 3.0)]


def test_impact_speed_is_that_of_both() -> None:
    follower = replace(ONE, speed=1.1 * (elastic_jump(ONE) or 0.0), damping=(0.0,))
    start = np.array([follower.rest(np.zeros(1))[0, 0], 0.0])
    turn = settle(follower, start, turns=1, tolerance=1e-10)
    first = turn.flights[0]
    state = turn.states([first.end])[0][:, 0]
    # without damping the end of the spring follows the mass: both approach as the lag changes
    assert first.impact == pytest.approx(-state[1] * follower.speed, rel=1e-9)
    assert state[0] == pytest.approx(0.0, abs=1e-9)


def test_a_cam_that_holds_its_follower_never_loses_it() -> None:
    follower = replace(TRAIN, speed=1300.0 * RPM, held=True)
    periodic = Periodic(follower)
    turn = settle(follower, periodic.start)
    assert turn.flights == ()
    assert turn.contact_force(np.linspace(0.0, 6.28, 2000)).min() == pytest.approx(-88.4, abs=0.2)


def test_pressed_from_above() -> None:
    """The mirror image: lift, loads and forces change their signs."""
    above = replace(
        TRAIN, lift=lambda x, order: [-one for one in cycloids(x, order)],
        loads=acting(0.0, -200.0), side=-1.0,
    )  # fmt: skip
    assert Periodic(above).least()[0] == pytest.approx(Periodic(TRAIN).least()[0])
    assert elastic_jump(above) == pytest.approx(elastic_jump(TRAIN))


def test_the_method_by_natural_periods() -> None:
    """TRAIN has 334.4 of them in a turn at 300 rpm."""
    assert chosen(replace(TRAIN, speed=334.0 * RPM), "auto") == "radau"
    assert chosen(replace(TRAIN, speed=335.0 * RPM), "auto") == "dop853"
    assert chosen(TRAIN, "lsoda") == "lsoda"


def test_too_many_vibrations_to_follow_are_refused() -> None:
    slow = replace(TRAIN, speed=1e-3)
    with pytest.raises(InfeasibleError, match="natural vibrations take dop853 about"):
        settle(slow, np.zeros(4), method="dop853")


def test_the_error_is_that_of_the_periodic_motion() -> None:
    follower = replace(TRAIN, speed=1000.0 * RPM)
    turn = settle(follower, Periodic(follower).start, tolerance=1e-5)
    x = np.linspace(0.0, TURN, 721)[:-1]
    off = np.abs(turn.contact_force(x) - follower.contact_force(Periodic(follower).at(x))).max()
    assert turn.error[0] == pytest.approx(off, rel=0.5)


def test_a_turn_is_quick() -> None:
    """The spec's 0.3 s for one turn, on a machine that others use too."""
    assert isinstance(settle(TRAIN, Periodic(TRAIN).start, turns=1), Turn)


FLYING = replace(TRAIN, damping=(0.04, 0.01), speed=1300.0 * RPM)


def test_the_end_of_a_flying_spring_relaxes_and_costs_no_more() -> None:
    """Its rate is 25 natural frequencies: dop853 would be bound to it, and radau is not."""
    start = np.array([-0.05, 0.0, -0.1, 0.0])
    turn = settle(FLYING, start, turns=1, method="dop853", tolerance=1e-6)
    exact = settle(FLYING, start, turns=1, method="radau", tolerance=1e-9)
    assert {before for _, before, _ in turn.motion.switches} == {CONTACT, FLIGHT, RELAXED}
    assert turn.motion.evaluations < 20_000
    x = np.linspace(0.0, 1.5, 300)
    assert turn.states(x)[0][2] == pytest.approx(exact.states(x)[0][2], abs=2e-5)
    assert turn.flights[0].impact == pytest.approx(exact.flights[0].impact, rel=1e-5)
    assert turn.energy_residue < 1e-4


def test_what_does_not_repeat_is_given_up() -> None:
    turn = settle(FLYING, Periodic(FLYING).start, turns=100)
    assert not turn.repeats
    assert 6 <= turn.turns < 40
    assert settle(FLYING, Periodic(FLYING).start, turns=3).turns == 3
