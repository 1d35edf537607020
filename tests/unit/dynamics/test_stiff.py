"""The stiff model against closed forms, its own energy, and the rigid machine."""

import math
import random
from collections.abc import Callable
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.dynamics.stiff import APART, COAST, DRIVE, StiffPair, StiffState
from gearcam.dynamics.tabled import Tabled
from gearcam.dynamics.trials import Trial, trials

pytest.importorskip("scipy")

TURN = 2.0 * math.pi
K, J1, J2 = 4.3e6, 0.2, 0.3
OMEGA = math.sqrt(K * (1.0 / J1 + 1.0 / J2))
W = 18.85
RTOL = 1e-6


def free(_: float, __: float) -> float:
    return 0.0


def pair(
    functions: Callable[[np.ndarray], list],
    *,
    knots=(0.0, TURN),
    inertia=(J1, J2),
    damping=0.0,
    motor=free,
    load=free,
) -> StiffPair:
    """Return a pair from i, i', K, K', b, b' over the angle."""

    def rows(x: np.ndarray) -> np.ndarray:
        return np.array([np.broadcast_to(one, x.shape) for one in functions(x)])

    table = Tabled(rows, np.asarray(knots), 1e-12, cuts=1)
    return StiffPair(table=table, inertia=inertia, damping=damping, motor=motor, load=load)


def even(play: float = 0.0, **more) -> StiffPair:
    return pair(lambda _: [1.0, 0.0, K, 0.0, play, 0.0], **more)


@pytest.mark.parametrize("method", ["auto", "radau", "lsoda", "dop853"])
def test_a_free_vibration_is_a_cosine_at_the_natural_frequency(method):
    start = 1e-4
    periods = 20 if method == "radau" else 50
    run = even().run(StiffState(0.0, W, start), W * periods * TURN / OMEGA, method=method)
    time, _, lag, _ = run.end[:4]
    assert math.isclose(OMEGA, 5986.1, rel_tol=1e-5)
    assert abs(lag - start * math.cos(OMEGA * time)) < (2e-4 if method == "lsoda" else 2e-5) * start
    assert run.residue < 100 * RTOL


def test_a_free_vibration_with_bdf_is_slow_but_right():
    run = even().run(StiffState(0.0, W, 1e-4), W * 5 * TURN / OMEGA, method="bdf")
    time, _, lag, _ = run.end[:4]
    assert abs(lag - 1e-4 * math.cos(OMEGA * time)) < 1e-3 * 1e-4


def test_natural_frequencies_are_eigenvalues_of_the_linear_machine():
    made = pair(lambda x: [1.2 + 0.3 * np.cos(x), -0.3 * np.sin(x), K, 0.0, 0.0, 0.0])
    for x in (0.0, 1.0, 4.0):
        i = 1.2 + 0.3 * math.cos(x)
        system = K * np.array([[i * i / J1, -i / J1], [-i / J2, 1.0 / J2]])
        largest = math.sqrt(np.linalg.eigvals(system).real.max())
        assert made.frequency([x])[0] == pytest.approx(largest, rel=1e-10)


PLAYED, ENTERING = 2e-4, 0.5


def in_play(time: float) -> float:
    """Return the lag of a wheel that enters its driving flanks at time 0, closed form."""
    half = math.pi / OMEGA + PLAYED / ENTERING
    passed = time % (2.0 * half)
    sign, passed = (1.0, passed) if passed < half else (-1.0, passed - half)
    if passed < math.pi / OMEGA:
        return sign * (PLAYED / 2 + ENTERING / OMEGA * math.sin(OMEGA * passed))
    return sign * (PLAYED / 2 - ENTERING * (passed - math.pi / OMEGA))


def rattling(impacts: int, **more):
    half = math.pi / OMEGA + PLAYED / ENTERING
    start = StiffState(0.0, W, PLAYED / 2, ENTERING)
    return even(PLAYED).run(start, W * (impacts * half + 0.2 * math.pi / OMEGA), **more)


@pytest.mark.parametrize("method", ["auto", "radau"])
def test_impacts_in_play_follow_the_closed_form(method):
    run = rattling(20, method=method)
    time, _, lag, _ = run.end[:4]
    assert abs(lag - in_play(time)) < 5e-6 * PLAYED
    assert run.residue < 100 * RTOL
    assert len(run.motion.switches) == 41
    names = [after for _, _, after in run.motion.switches]
    assert names[:5] == [DRIVE, APART, COAST, APART, DRIVE]
    onto_drive = [x for x, _, after in run.motion.switches if after == DRIVE]
    times = run.states(onto_drive)[0]
    period = 2.0 * (math.pi / OMEGA + PLAYED / ENTERING)
    assert np.diff(times) == pytest.approx(period, rel=1e-6)
    assert {arc.onto for arc in run.lost_contact} == {DRIVE, COAST}
    impacts = np.array([arc.impact for arc in run.lost_contact])
    assert impacts == pytest.approx(ENTERING, rel=1e-6)


def test_the_error_in_play_falls_with_the_tolerance():
    errors = []
    for rtol in (1e-5, 1e-6, 1e-7, 1e-8):
        time, _, lag, _ = rattling(20, rtol=rtol).end[:4]
        errors.append(abs(lag - in_play(time)))
    assert max(b / a for a, b in pairwise(errors)) < 0.2


def test_without_switches_the_same_integrator_is_ten_times_worse():
    from scipy.integrate import solve_ivp

    def rate(_: float, y: np.ndarray) -> list:
        bent = y[0] - min(max(y[0], -PLAYED / 2), PLAYED / 2)
        return [y[1], -(OMEGA**2) * bent]

    run = rattling(20)
    time, _, lag, _ = run.end[:4]
    atol = RTOL * np.array([PLAYED, PLAYED * OMEGA])
    start = [PLAYED / 2, ENTERING]
    found = solve_ivp(rate, (0.0, time), start, "DOP853", rtol=RTOL, atol=atol)
    assert abs(found.y[0, -1] - in_play(time)) > 10 * abs(lag - in_play(time))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("twist", [0.2, 0.5, 0.9, 1.1, 2.0])
def test_a_twisted_mesh_carries_nothing_within_its_play_and_is_linear_beyond(sign, twist):
    made = even(PLAYED)
    lag = sign * twist * PLAYED
    run = made.run(StiffState(0.0, W, lag), 1e-6)
    wanted = sign * K * max(abs(lag) - PLAYED / 2, 0.0)
    assert run.at([0.0])["mesh"][0] == pytest.approx(wanted, rel=1e-12, abs=1e-12)


def machine(play: float, **more) -> StiffPair:
    """Return a machine whose ratio and stiffness change, with damping and a load."""

    def functions(x: np.ndarray) -> list:
        return [
            1.0 + 0.4 * np.cos(x),
            -0.4 * np.sin(x),
            K * (1.0 + 0.15 * np.cos(12.0 * x)),
            -1.8 * K * np.sin(12.0 * x),
            play,
            0.0,
        ]

    given = {"inertia": (20.0, J2), "load": lambda *_: 500.0, "motor": lambda _, w: 60.0 * (W - w)}
    damping = 2.0 * 0.05 * math.sqrt(K / (1.0 / J2 + 1.0 / J1))
    return pair(functions, damping=damping, **(given | more))


def test_a_constant_play_adds_its_half_to_the_lag_of_a_pair_that_stays_in_contact():
    lags = []
    for play in (0.0, PLAYED):
        made = machine(play)
        run = made.run(made.resting(0.0, W), TURN / 6)
        lags.append(run.end[2])
    assert lags[1] - lags[0] == pytest.approx(PLAYED / 2, abs=1e-10)


def soft(*, slope=1.0, play_slope=1.0, swing=0.0) -> StiffPair:
    """Return a pair so soft that its spring stores as much as the wheels.

    `slope` and `play_slope` are factors of K' and b', 1 if these are right; `swing` is that of b.
    """
    k = 2000.0

    def functions(x: np.ndarray) -> list:
        return [
            1.0,
            0.0,
            k * (1.0 + 0.3 * np.cos(3.0 * x)),
            -0.9 * k * slope * np.sin(3.0 * x),
            0.05 + swing * np.cos(2.0 * x),
            -2.0 * swing * play_slope * np.sin(2.0 * x),
        ]

    return pair(functions)


@pytest.mark.parametrize(
    ("given", "wrong"), [({}, {"slope": 0.0}), ({"swing": 0.04}, {"play_slope": 0.0})]
)
def test_energy_balances_with_the_slopes_of_stiffness_and_play_and_not_without(given, wrong):
    start = StiffState(0.0, W, 0.15)
    assert soft(**given).run(start, TURN).residue < RTOL
    assert soft(**given, **wrong).run(start, TURN).residue > 10 * 100 * RTOL


def test_the_speed_tends_to_that_of_rigid_teeth_with_order_one():
    def error(stiffness: float) -> float:
        c = 2.0 * math.sqrt(stiffness / (1.0 / J2 + 1.0 / J1))
        made = pair(
            lambda x: [1.0 + 0.4 * np.cos(x), -0.4 * np.sin(x), stiffness, 0.0, 0.0, 0.0],
            damping=c,
            motor=lambda _, w: 20.0 - w,
        )
        x = np.array([0.5, 2.0, 4.0, TURN])
        run = made.run(made.resting(0.0, W), TURN, rtol=1e-9)
        return float(np.abs(run.states(x)[1] / rigid(x) - 1.0).max())

    def rigid(x: np.ndarray) -> np.ndarray:
        from scipy.integrate import solve_ivp

        def inertia(x: Any) -> Any:
            return J1 + J2 * (1.0 + 0.4 * np.cos(x)) ** 2

        def rate(x: float, energy: np.ndarray) -> np.ndarray:
            return 20.0 - np.sqrt(2.0 * energy / inertia(x))

        start = [0.5 * inertia(0.0) * W**2]
        found = solve_ivp(rate, (0.0, TURN), start, "DOP853", t_eval=x, rtol=1e-13, atol=1e-12)
        return np.sqrt(2.0 * found.y[0] / inertia(x))

    errors = [error(factor * 1e5) for factor in (1.0, 10.0, 100.0)]
    orders = -np.diff(np.log10(errors))
    assert orders == pytest.approx(1.0, abs=0.1)


def test_friction_takes_more_from_the_driver_and_its_work_is_lost():
    drive, coast, load = 1.1, 0.9, 200.0
    made = pair(
        lambda _: [1.0, 0.0, K, 0.0, 0.0, 0.0, drive, coast],
        damping=500.0,
        motor=lambda *_: drive * load,
        load=lambda *_: load,
    )
    run = made.run(made.resting(0.0, W, load), 2.0)
    last = run.at([2.0])
    assert last["driver"][0] == pytest.approx(drive * load, rel=1e-9)
    assert last["w1"][0] == pytest.approx(W, rel=1e-9)
    assert run.end[6] == pytest.approx((drive - 1.0) * load * 2.0, rel=1e-9)
    assert run.residue < RTOL
    held = pair(
        lambda _: [1.0, 0.0, K, 0.0, 0.0, 0.0, drive, coast],
        damping=500.0,
        motor=lambda *_: -coast * load,
        load=lambda *_: -load,
    )
    run = held.run(held.resting(0.0, W, -load), 2.0)
    assert run.at([2.0])["driver"][0] == pytest.approx(-coast * load, rel=1e-9)
    assert run.end[6] == pytest.approx((1.0 - coast) * load * 2.0, rel=1e-9)


def test_a_machine_that_is_too_weak_stalls_where_its_energy_is_spent():
    load = 50.0
    made = even(PLAYED, motor=lambda *_: 10.0, load=lambda *_: load, damping=200.0)
    run = made.run(made.resting(0.0, W), TURN)
    assert run.stalled is not None
    place, lacks = run.stalled
    assert place == pytest.approx((J1 + J2) * W**2 / 2.0 / (load - 10.0), rel=1e-4)
    assert lacks == pytest.approx(load - 10.0)
    with pytest.raises(ValueError, match="only"):
        run.at([place + 0.1])
    assert even().run(StiffState(0.0, W, 0.0), 1.0).stalled is None


def test_only_the_last_turn_is_kept_and_the_motion_is_the_same():
    made = machine(PLAYED, load=lambda x, _: 500.0 * math.cos(x))
    start = made.resting(0.0, W)
    whole = made.run(start, 2 * TURN)
    last = made.run(start, 2 * TURN, keep=TURN)
    assert whole.motion.pieces[0].low == 0.0
    assert 0.9 * TURN < last.motion.pieces[0].low <= TURN
    assert last.end == pytest.approx(whole.end, rel=1e-12)
    assert whole.difference(last) == pytest.approx((0.0, 0.0), abs=1e-9)


def test_the_difference_to_a_finer_run_is_that_of_their_tolerances():
    made = machine(PLAYED)
    start = made.resting(0.0, W)
    coarse, fine, finest = (made.run(start, 1.0, rtol=rtol) for rtol in (1e-5, 1e-6, 1e-9))
    lag, speed = coarse.difference(fine)
    true_lag, true_speed = coarse.difference(finest)
    assert lag == pytest.approx(true_lag, rel=0.3)
    assert speed == pytest.approx(true_speed, rel=0.3)


def test_loads_that_jump_are_met_at_their_knots():
    def load(x: float, _: float) -> float:
        return 300.0 if 1.0 <= x % TURN < 2.0 else 0.0

    made = machine(0.0, load=load)
    start = made.resting(0.0, W)
    with_knots = made.run(start, 3.0, knots=[1.0, 2.0])
    exact = made.run(start, 3.0, knots=[1.0, 2.0], rtol=1e-11)
    assert with_knots.difference(exact)[0] < 1e-5 * 1e-4
    places = [piece.low for piece in with_knots.motion.pieces]
    assert 1.0 in places
    assert 2.0 in places


def test_too_many_natural_periods_are_refused_and_run_times_foretold(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = even()
    start = StiffState(0.0, W, 0.0)
    with pytest.raises(InfeasibleError, match="natural periods") as error:
        made.run(start, 1e6 * TURN)
    assert error.value.limit == 1e7
    assert error.value.value == pytest.approx(OMEGA * 1e6 / W)
    # by a clock that ticks once whenever the load is asked for
    asked = [0.0]

    def load(_: float, __: float) -> float:
        asked[0] += 1.0
        return 0.0

    clock = SimpleNamespace(perf_counter=lambda: asked[0])
    monkeypatch.setattr("gearcam.dynamics.stiff.time", clock)
    made = even(load=load)
    start = StiffState(0.0, W, 1e-4)  # it vibrates all the way
    for turns in (1, 3):
        foretold, before = made.forecast(start, turns * TURN), asked[0]
        made.run(start, turns * TURN)
        assert foretold == pytest.approx(asked[0] - before, rel=0.3)


@pytest.fixture(scope="module")
def compared() -> dict[str, Trial]:
    return trials()


def test_auto_leaves_stable_steps_behind_where_nothing_vibrates(
    compared: dict[str, Trial],
) -> None:
    slow = compared["slow"]
    auto, explicit = (slow.run(method, 1e-5).motion.evaluations for method in ("auto", "dop853"))
    assert slow.pair.periods(slow.start, slow.end) > 500
    assert auto < 0.125 * explicit


def test_auto_follows_vibrations_by_explicit_steps(compared: dict[str, Trial]) -> None:
    for name in ("free", "rattle"):
        trial = compared[name]
        auto, explicit = (
            trial.run(method, 1e-5).motion.evaluations for method in ("auto", "dop853")
        )
        assert auto == explicit


def random_machine(number: int) -> tuple[StiffPair, StiffState, float, list[float], float]:
    """Return a machine, its start and end, knots, and a tolerance."""
    draw = random.Random(number)
    k, speed = 10.0 ** draw.uniform(3, 9), 10.0 ** draw.uniform(-1, 3)
    j1, j2 = 10.0 ** draw.uniform(-2, 1), 10.0 ** draw.uniform(-2, 1)
    swing, teeth = draw.uniform(0, 0.6), draw.randint(5, 60)
    varies, shakes = draw.uniform(0, 0.4), draw.uniform(0, 0.4)
    torque = 10.0 ** draw.uniform(0, 3)
    play = draw.choice([0.0, 1.0]) * 10.0 ** draw.uniform(-5, -2)
    loss = draw.choice([0.0, 0.1])
    low, high = sorted([draw.uniform(0.3, TURN - 0.1), draw.uniform(0.3, TURN - 0.1)])

    def functions(x: np.ndarray) -> list:
        i = 1.0 + swing * np.cos(x)
        rows = [
            i,
            -swing * np.sin(x),
            k * (1.0 + varies * np.cos(teeth * x)),
            -k * varies * teeth * np.sin(teeth * x),
            play * (1.0 + shakes * np.sin(x)),
            play * shakes * np.cos(x),
        ]
        return rows + ([i * (1.0 + loss), i * (1.0 - loss)] if loss else [])

    def load(x: float, w2: float) -> float:
        return torque * (1.0 if low <= x % TURN < high else -0.2) + 0.01 * torque / speed * w2

    zeta = draw.choice([0.0, 0.03, 0.1])
    made = pair(
        functions,
        inertia=(j1, j2),
        damping=2.0 * zeta * math.sqrt(k / (1.0 / j1 + 1.0 / j2)),
        motor=lambda _, w: 2.0 * torque * (1.0 - (w - speed) / speed),
        load=load,
    )
    start = made.resting(0.1, speed)
    end = 0.1 + min(2.5 * TURN, 150.0 / made.periods(start, 1.1))
    return made, start, end, [low, high], 10.0 ** draw.uniform(-8, -4)


def test_random_machines_balance_and_end():
    _balance(range(8))


@pytest.mark.slow
def test_many_random_machines_balance_and_end():
    _balance(range(8, 320))


def _balance(numbers: range) -> None:
    for number in numbers:
        made, start, end, knots, rtol = random_machine(number)
        run = made.run(start, end, knots=knots, rtol=rtol)
        assert run.residue < 100.0 * rtol, number
        assert run.stalled is not None or run.motion.place == end
        assert np.isfinite(run.end).all(), number
