"""A machine in motion against closed forms, and its regime and flywheel against a second method."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from gearcam.base.errors import InfeasibleError
from gearcam.dynamics.machine import PairMachine, ReducedMachine
from gearcam.dynamics.motors import (
    AsynchronousMotor,
    ConstantMotor,
    LinearMotor,
    SpringMotor,
    TableMotor,
    motor_of,
)
from gearcam.dynamics.regime import even_torque, flywheel, regime
from gearcam.dynamics.rigid import RigidMotion, RigidRun
from gearcam.dynamics.tabled import Tabled
from gearcam.mechanics.motor import MotorSpec

TURN = 2.0 * math.pi


def reduced(inertia, slope, load, knots=(0.0, TURN)):
    """Return a machine by functions of arrays."""

    def rows(x):
        return np.array([one(x) + 0.0 * x for one in (inertia, slope, load)])

    tabled = Tabled(rows, knots, 1e-13)
    return ReducedMachine(rows=tabled, knots=np.array(knots, dtype=float))


def constant(value):
    return lambda x: value + 0.0 * x


def ellipses(driver=1.0, driven=1.0, load=0.0, rubs=()):
    """Return elliptical wheels of eccentricity 0.5, and their ratio."""
    e = 0.5

    def ratio(x):
        return (1 - e * e) / (1 + e * e - 2 * e * np.cos(x))

    def slope(x):
        return -(1 - e * e) * 2 * e * np.sin(x) / (1 + e * e - 2 * e * np.cos(x)) ** 2

    columns = (ratio, slope, *map(constant, rubs), constant(load))
    rows = Tabled(lambda x: np.array([one(x) for one in columns]), [0.0, TURN], 1e-13)
    knots = np.array([0.0, TURN])
    machine = PairMachine(rows=rows, knots=knots, driver=driver, driven=driven, rubs=bool(rubs))
    return machine, ratio, slope


def test_a_start_from_rest_is_that_of_the_closed_form():
    # 000, (5.22) to (5.25): J = 2, M = 100 - 5*omega, load 30
    machine = reduced(constant(2.0), constant(0.0), constant(30.0))
    run = RigidRun(machine=machine, motor=LinearMotor(100.0, 20.0), scale=20.0, rtol=1e-10)
    motion = run.from_rest(6.0)
    phi: Any = brentq(lambda p: motion.time(np.array([p]))[0] - 3.0, 1.0, 37.0, xtol=1e-13)
    assert abs(motion.speed(np.array([phi]))[0] - 14.0 * (1.0 - math.exp(-7.5))) < 3e-10
    assert abs(phi - (42.0 + 5.6 * (math.exp(-7.5) - 1.0))) < 1e-8
    nearly: Any = brentq(
        lambda p: motion.speed(np.array([p]))[0] - 0.99 * 14.0, 1.0, 37.0, xtol=1e-13
    )
    assert abs(motion.time(np.array([nearly]))[0] - 1.842068074) < 1e-8


def test_wheels_without_torque_keep_their_energy():
    machine, ratio, _ = ellipses()
    run = RigidRun(machine=machine, motor=ConstantMotor(), scale=10.0)
    motion = run.from_speed(10.0)
    assert abs(motion.lasts - 0.298995991681) < 1e-10
    x = np.linspace(0.0, TURN, 41)
    inertia = 1.0 + ratio(x) ** 2
    assert np.allclose(motion.speed(x), 10.0 * np.sqrt(inertia[0] / inertia), rtol=1e-11)


def test_equal_torques_move_energy_by_the_difference_of_the_angles():
    torque, start = 1031.26, 2000.0
    machine, ratio, _ = ellipses(load=torque)
    run = RigidRun(machine=machine, motor=ConstantMotor(torque), scale=40.0, rtol=1e-11)
    omega = math.sqrt(2.0 * start / (1.0 + ratio(0.0) ** 2))
    motion: Any = run.from_speed(omega)
    energy = float(motion.motion.at([2.0])[0, 0])
    assert abs(energy - 1257.602813995) < 1e-7  # E0 + T*(phi1 - phi2)
    assert motion.residue < 1e-11


@pytest.mark.parametrize(
    ("inertia", "irregularity"), [(1.0, 0.254033307585), (5.0, 0.050031289124)]
)
def test_irregularity_is_that_of_exact_extremes(inertia, irregularity):
    machine = reduced(constant(inertia), constant(0.0), lambda x: 50.0 * (1.0 - np.cos(x)))
    motion = RigidRun(machine=machine, motor=ConstantMotor(50.0), scale=20.0).from_speed(20.0)
    assert abs(motion.irregularity - irregularity) < 1e-9
    assert np.allclose([motion.speeds[0][0], motion.speeds[1][0]], [1.5 * math.pi, 0.5 * math.pi])


def uneven(load=400.0):
    """Return a machine whose inertia and load vary, by smooth functions."""
    return reduced(
        lambda x: 2.0 + np.cos(x),
        lambda x: -np.sin(x),
        lambda x: load * np.exp(3.0 * (np.cos(x - 2.0) - 1.0)),
    )


def in_time(machine, motor, omega):
    """Return the speed after a turn, by the equation of motion (5.13) in time, with dJ/dphi."""

    def rate(_, y):
        phi, speed = y
        row = machine.rows(phi)
        torque = motor.torque(phi, speed) - machine.load(row, speed)
        return [speed, (torque - 0.5 * row[1] * speed**2) / row[0]]

    def turned(_, y):
        return y[0] - TURN

    turned.terminal = True
    start = [0.0, omega]
    found = solve_ivp(rate, (0, 100), start, "DOP853", events=turned, rtol=1e-12, atol=1e-13)
    return found.y_events[0][0, 1]


def test_the_regime_is_the_fixed_point_of_the_turn_in_time():
    machine, motor = uneven(), LinearMotor(600.0, 30.0)
    motion = regime(RigidRun(machine=machine, motor=motor, scale=30.0))
    first, last = motion.speed(motion.knots[[0, -1]])
    assert abs(last - first) < 1e-9 * first
    assert abs(in_time(machine, motor, first) - first) < 1e-8
    assert motion.residue < 1e-9
    # the mean torque of the motor is that of the load
    work, load, lost = motion.works
    assert work == pytest.approx(load, rel=1e-9)
    assert lost == 0.0


def test_a_weak_motor_is_refused_with_a_load_that_has_a_regime():
    machine, motor = uneven(4000.0), LinearMotor(600.0, 30.0)
    run = RigidRun(machine=machine, motor=motor, scale=30.0)
    with pytest.raises(InfeasibleError, match="does not turn this load") as caught:
        regime(run)
    share = float(caught.value.nearest.split("up to ")[1].split()[0])
    assert 0.0 < share < 1.0
    assert "weights and springs" in caught.value.nearest  # of a mechanism, all of them
    assert regime(replace(run, machine=replace(machine, share=share))).residue < 1e-8
    with pytest.raises(InfeasibleError):
        regime(replace(run, machine=replace(machine, share=1.1 * share)))


def test_a_weak_motor_is_refused_after_few_turns(monkeypatch):
    counted, own = [], RigidRun.speed_after_turn

    def after_turn(run, omega):
        counted.append(omega)
        return own(run, omega)

    monkeypatch.setattr(RigidRun, "speed_after_turn", after_turn)
    run = RigidRun(machine=uneven(4000.0), motor=LinearMotor(600.0, 30.0), scale=30.0)
    with pytest.raises(InfeasibleError, match="does not turn this load"):
        regime(run)
    assert len(counted) < 80  # of 12 loads and a flywheel


def test_an_even_torque_is_the_mean_of_the_load_and_keeps_the_mean_speed():
    machine = uneven()
    motion: Any = even_torque(RigidRun(machine=machine, motor=ConstantMotor(), scale=20.0), 20.0)
    even = RigidMotion(machine=machine, motor=None, knots=machine.knots, even=20.0)
    assert motion.mean_speed == pytest.approx(20.0, rel=1e-9)
    assert motion.motor.size == pytest.approx(even.works[1] / TURN, rel=1e-9)
    assert motion.speed(motion.knots[-1:])[0] == pytest.approx(motion.speed(motion.knots[:1])[0])


def test_the_least_flywheel_makes_the_wanted_irregularity_and_a_lighter_one_misses_it():
    motor = LinearMotor(600.0, 30.0)

    def with_(inertia):
        return regime(RigidRun(machine=uneven().with_flywheel(inertia), motor=motor, scale=30.0))

    least, motion = flywheel(with_, 0.03, 1.0)
    assert motion.irregularity == pytest.approx(0.03, rel=1e-8)
    assert with_(0.99 * least).irregularity > 0.03
    assert flywheel(with_, 0.9, 1.0)[0] == 0.0


@pytest.mark.parametrize("part", [0.8, 0.95, 1.3])
def test_the_irregularity_falls_as_the_flywheel_grows_also_where_inertia_balances_the_load(part):
    # at 20 rad/s a part of the load is that which the change of the inertia takes
    machine = reduced(
        lambda x: 2.0 + 1.8 * np.cos(x),
        lambda x: -1.8 * np.sin(x),
        lambda x: 100.0 + 360.0 * part * np.sin(x) + 30.0 * np.cos(2.0 * x),
    )
    motor, found = LinearMotor(300.0, 30.0), []
    for size in (0.5, 1.0, 4.0, 16.0):
        run = RigidRun(machine=machine.with_flywheel(size), motor=motor, scale=30.0, rtol=1e-7)
        found.append(regime(run).irregularity)
    assert found == sorted(found, reverse=True)


def test_a_flywheel_neglects_only_a_square_of_the_irregularity():
    # omega_max^2 - omega_min^2 = 2*delta*omega_m^2, so that J*delta*omega_m^2 is the largest work
    machine = reduced(constant(3.0), constant(0.0), lambda x: 50.0 * (1.0 - np.cos(x)))
    motion = RigidRun(machine=machine, motor=ConstantMotor(50.0), scale=20.0).from_speed(20.0)
    assert 3.0 * motion.irregularity * motion.mean_speed**2 == pytest.approx(100.0, rel=2e-9)


def test_friction_of_teeth_takes_what_the_equations_of_both_wheels_say():
    rubs = (0.05, -0.03)  # kappa - i where teeth drive, and where they are driven
    machine, ratio, slope = ellipses(1.25, 3.0, load=40.0, rubs=rubs)
    machine = machine.with_flywheel(0.75)
    motor = LinearMotor(300.0, 25.0)
    motion = RigidRun(machine=machine, motor=motor, scale=25.0, rtol=1e-11).from_speed(12.0)

    def rate(_, y):
        phi, speed, _ = y
        i, change = ratio(phi), slope(phi)
        driving = motor.torque(phi, speed)
        for kappa, sign in ((i + rubs[0], 1.0), (i + rubs[1], -1.0)):
            # J1*a = M - kappa*Q and Q = M2 + J2*(i*a + i'*speed^2)
            a, torque = np.linalg.solve(
                [[2.0, kappa], [-3.0 * i, 1.0]], [driving, 40.0 + 3.0 * change * speed**2]
            )
            if sign * torque >= 0.0:
                return [speed, a, (kappa - i) * torque * speed]
        raise AssertionError

    def turned(_, y):
        return y[0] - TURN

    turned.terminal = True
    found = solve_ivp(
        rate, (0.0, 100.0), [0.0, 12.0, 0.0], "DOP853", events=turned, rtol=1e-11, atol=1e-12
    )
    assert motion.speed(motion.knots[-1:])[0] == pytest.approx(found.y_events[0][0, 1], rel=1e-8)
    assert motion.works[2] == pytest.approx(found.y_events[0][0, 2], rel=1e-6)
    sampled = motion.speed(np.linspace(0.0, TURN, 100_001))
    extremes = [sampled.min(), sampled.max()]
    assert [one for _, one in motion.speeds] == pytest.approx(extremes, rel=1e-8)
    x = np.linspace(0.0, 6.0, 400)
    carried = machine.mesh_torque(motion.rows(x), motion.speed(x), motor.torque(x, motion.speed(x)))
    assert carried[0].min() < 0.0 < carried[0].max()  # both flanks carry


def test_a_machine_that_cannot_start_stands_and_one_that_lacks_torque_stops():
    machine = reduced(constant(2.0), constant(0.0), constant(30.0))
    weak = RigidRun(machine=machine, motor=ConstantMotor(29.0), scale=5.0)
    assert weak.from_rest(1.0).stopped == 0.0
    # from 5 rad/s a lack of 1 N m stops 25 J after 25 rad
    assert weak.from_speed(5.0, 10.0).stopped == pytest.approx(25.0, rel=1e-9)
    assert weak.from_speed(5.0, 3.0).stopped is None


def test_a_spring_runs_down_and_leaves_its_energy():
    machine = reduced(constant(0.5), constant(0.0), constant(0.0))
    motion = RigidRun(machine=machine, motor=SpringMotor(8.0, 0.5), scale=20.0).from_rest(5.0)
    # unwound after 16 rad: 64 J
    assert motion.speed(np.array([16.0, 30.0])) == pytest.approx([16.0, 16.0], rel=1e-7)


def test_a_machine_that_only_a_flywheel_carries_through_its_load_gets_the_least_one():
    machine, motor = uneven(1800.0), LinearMotor(600.0, 30.0)

    def with_(inertia):
        return regime(RigidRun(machine=machine.with_flywheel(inertia), motor=motor, scale=30.0))

    with pytest.raises(InfeasibleError, match="does not turn this load") as caught:
        with_(0.0)
    told = float(caught.value.nearest.split("flywheel of ")[1].split()[0])
    assert with_(told).residue < 1e-7
    least, motion = flywheel(with_, 0.2, 2.0)
    assert motion.irregularity == pytest.approx(0.2, rel=1e-8)
    assert with_(0.98 * least).irregularity > 0.2


def test_an_induction_motor_has_the_torque_of_its_formula_and_holds_its_stable_speed():
    # 2*Mk/(s/sk + sk/s) = M has the smaller root s = sk*(k - sqrt(k^2 - 1)), k = Mk/M
    motor = AsynchronousMotor(50.0, 0.02, 30.0)
    for load in (45.0, 10.0, -45.0):  # also one that drives
        k = 50.0 / abs(load)
        slip = math.copysign(0.02 * (k - math.sqrt(k * k - 1.0)), load)
        assert motor.torque(0.0, 30.0 * (1.0 - slip)) == pytest.approx(load, rel=1e-12)
        machine = reduced(constant(0.05), constant(0.0), constant(load))
        motion = regime(RigidRun(machine=machine, motor=motor, scale=30.0))
        assert motion.mean_speed == pytest.approx(30.0 * (1.0 - slip), rel=1e-8)


def test_a_motor_by_a_table_holds_the_speed_at_which_it_has_the_torque_of_the_load():
    motor = TableMotor((0.0, 28.0, 29.0, 30.0), (5.0, 8.0, 60.0, 0.0))
    assert motor.torque(0.0, np.array([0.0, 28.0, 29.0, 30.0])) == pytest.approx([5, 8, 60, 0])
    assert motor.torque(0.0, 31.0) == pytest.approx(-60.0)
    # below its first speed it keeps the torque there
    above = TableMotor((10.0, 20.0, 30.0), (5.0, 8.0, 0.0))
    assert above.torque(0.0, 2.0) == 5.0
    assert above.torque(0.0, np.array([0.0, 9.0, 10.0, 40.0])) == pytest.approx([5, 5, 5, -8])
    machine = reduced(constant(0.05), constant(0.0), constant(50.0))
    motion = regime(RigidRun(machine=machine, motor=motor, scale=30.0))
    assert motor.torque(0.0, motion.mean_speed) == pytest.approx(50.0, rel=1e-6)
    assert motion.mean_speed > 29.0


def test_a_load_that_drives_more_than_the_motor_brakes_is_refused():
    machine = reduced(constant(0.05), constant(0.0), constant(-60.0))
    run = RigidRun(machine=machine, motor=AsynchronousMotor(50.0, 0.02, 30.0), scale=30.0)
    with pytest.raises(InfeasibleError, match="ever faster"):
        regime(run)


@pytest.mark.parametrize(
    ("mean", "shape"), [(20.0, np.cos), (11.8, np.sin), (30.0, lambda x: -np.sin(x))]
)
def test_an_even_torque_is_found_from_whatever_speed_the_turn_begins_at(mean, shape):
    # without a net load: E = E0 - integral of 50*shape; the mean speed is half of both extremes
    machine = reduced(constant(1.0), constant(0.0), lambda x: 50.0 * shape(x))
    motion: Any = even_torque(RigidRun(machine=machine, motor=ConstantMotor(), scale=mean), mean)
    assert motion.mean_speed == pytest.approx(mean, rel=1e-9)
    assert abs(motion.motor.size) < 1e-6
    # omega_max^2 - omega_min^2 = 2*delta*mean^2 = 2*100/J
    assert motion.irregularity == pytest.approx(100.0 / mean**2, rel=1e-7)


def test_an_even_torque_may_drive_or_brake_a_load_that_depends_on_the_speed():
    rows = Tabled(
        lambda x: np.array([1.0 + 0.0 * x, 0.0 * x, -30.0 + 20.0 * np.cos(x), 0.5 + 0.0 * x]),
        [0.0, TURN],
        1e-13,
    )
    machine = ReducedMachine(rows=rows, knots=np.array([0.0, TURN]))
    motion: Any = even_torque(RigidRun(machine=machine, motor=ConstantMotor(), scale=20.0), 20.0)
    assert motion.mean_speed == pytest.approx(20.0, rel=1e-9)
    assert abs(motion.gained) < 1e-7
    # its work is that of the load, whose mean speed over the angle is a little another
    assert motion.motor.size == pytest.approx(-30.0 + 0.5 * 20.0, rel=1e-2)


def test_an_even_torque_that_would_stop_the_machine_is_refused_after_few_turns(monkeypatch):
    counted, own = [], RigidRun.from_speed

    def from_speed(run, omega):
        counted.append(omega)
        return own(run, omega)

    monkeypatch.setattr(RigidRun, "from_speed", from_speed)
    machine = reduced(constant(1.0), constant(0.0), lambda x: 50.0 * np.sin(x))
    run = RigidRun(machine=machine, motor=ConstantMotor(), scale=6.0)
    with pytest.raises(InfeasibleError, match="stops"):  # least possible: half of sqrt(200)
        even_torque(run, 6.9)
    assert len(counted) < 50
    assert even_torque(run, 7.2).mean_speed == pytest.approx(7.2, rel=1e-9)


def test_a_flywheel_is_found_for_a_machine_that_stops_without_one():
    # a short load needs more energy than the machine has
    knots = (0.0, 3.0, 3.5, TURN)
    motor = LinearMotor(100.0, 12.0)

    def with_(inertia):
        machine = reduced(
            constant(0.05), constant(0.0), lambda x: 300.0 * ((x >= 3.0) & (x < 3.5)), knots
        )
        return regime(
            RigidRun(machine=machine.with_flywheel(inertia), motor=motor, scale=12.0, rtol=1e-9)
        )

    with pytest.raises(InfeasibleError):
        with_(0.0)
    least, motion = flywheel(with_, 0.2, 0.05)
    assert motion.irregularity == pytest.approx(0.2, rel=1e-8)
    assert with_(0.99 * least).irregularity > 0.2


def test_energies_that_only_go_to_and_fro_balance_too():
    machine = reduced(constant(2.0), constant(0.0), lambda x: 3.0 * np.cos(x))
    motion = RigidRun(machine=machine, motor=ConstantMotor(), scale=5.0).from_speed(5.0)
    assert motion.residue < 1e-10
    assert abs(motion.works[1]) < 1e-10


def test_a_start_from_rest_holds_from_the_first_angle_on():
    machine = reduced(constant(2.0), constant(0.0), constant(0.0))
    motion = RigidRun(machine=machine, motor=ConstantMotor(4.0), scale=5.0).from_rest(1.0)
    assert motion.ends[0] == 0.0
    assert motion.speeds[0][1] < 1e-6
    x = np.array([0.0, 1e-12, 1e-6, 1.0, TURN])  # phi = t^2
    assert motion.time(x) == pytest.approx(np.sqrt(x), rel=1e-7)
    assert motion.speed(x) == pytest.approx(2.0 * np.sqrt(x), rel=1e-7)
    assert motion.lasts == pytest.approx(math.sqrt(TURN), rel=1e-8)


def test_the_moment_of_inertia_has_its_exact_ends():
    machine = uneven().with_flywheel(0.5)
    assert machine.inertia_ends[0] == pytest.approx((math.pi, 1.5), abs=1e-9)
    assert machine.inertia_ends[1][1] == pytest.approx(3.5, abs=1e-9)


@pytest.mark.parametrize(
    ("spec", "phi", "omega", "torque"),
    [
        (MotorSpec(type="spring", torque=(8e3,), stiffness=500.0), 6.0, 3.0, 5.0),
        (MotorSpec(type="linear", start_torque=8e3, idle=20.0), 6.0, 5.0, 6.0),
        (MotorSpec(type="constant", torque=(8e3,)), 6.0, 5.0, 8.0),
        (MotorSpec(type="table", torque=(8e3, 0.0), rpm=(0.0, 60.0)), 1.0, math.pi, 4.0),
        (
            MotorSpec(
                type="asynchronous", breakdown_torque=8e3, breakdown_slip=0.25, synchronous=20.0
            ),
            1.0,
            15.0,
            8.0,
        ),
    ],
)
def test_motors_have_the_torques_of_their_tables_in_n_m(spec, phi, omega, torque):
    # inside, torques are N mm and those of springs N mm/rad; rows of speeds are rpm
    motor: Any = motor_of(spec)
    assert motor.torque(phi, omega) == pytest.approx(torque, rel=1e-12)


def test_the_slope_of_the_inertia_of_a_pair_is_its_derivative():
    machine, _, _ = ellipses(2.0, 3.0)
    x, step = np.linspace(0.1, 6.0, 50), 1e-5
    ends = [machine.inertia(machine.rows.at(x + one)) for one in (-step, step)]
    slope = machine.inertia_slope(machine.rows.at(x))
    assert slope == pytest.approx((ends[1] - ends[0]) / (2.0 * step), abs=1e-7)


def test_a_table_that_begins_elsewhere_repeats_from_there():
    table = Tabled(lambda x: np.array([x - 1.0]), [1.0, 1.0 + TURN], 1e-13)
    x = np.array([0.5, 1.5, 1.0 + TURN + 0.25])
    away = [TURN - 0.5, 0.5, 0.25]
    assert table.at(x)[0] == pytest.approx(away, abs=1e-12)
    assert [table(one)[0] for one in x.tolist()] == pytest.approx(away, abs=1e-12)
