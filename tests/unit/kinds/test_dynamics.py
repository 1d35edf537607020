"""The studies of machines in motion: the nail machine, pairs, and what they refuse."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.findings import run_checks
from gearcam.dynamics.checks import VibratingTeeth
from gearcam.dynamics.settings import VIBRATION
from helpers_built import built

RPM = math.pi / 30.0


def study(name: str, changes: Any = None, /) -> Any:
    design = gc.load(f"profiles/{name}.toml").with_(changes or {})
    return built(design).study("dynamics")


@cache
def nail(flywheel: Any) -> Any:
    """Return the study of the nail machine with a flywheel."""
    return study("nail_machine_flywheel", {"motor.flywheel_kg_m2": flywheel})


@pytest.mark.parametrize(
    ("flywheel", "least", "largest", "irregularity", "turn"),
    [
        (0, 18.138, 21.755, 0.1813, 0.32382),
        (5, 18.219, 21.310, 0.1564, 0.32365),
        (60, 18.920, 19.819, 0.0464, 0.32308),
    ],
)
def test_the_nail_machine_runs_as_in_a_trial(flywheel, least, largest, irregularity, turn):
    # with the ratio by single points and another integrator, of flywheels in kg m2
    facts = nail(flywheel).facts
    assert facts["dynamics.speed_rpm.min"] * RPM == pytest.approx(least, abs=1e-3)
    assert facts["dynamics.speed_rpm.max"] * RPM == pytest.approx(largest, abs=1e-3)
    assert facts["dynamics.irregularity"] == pytest.approx(irregularity, abs=1e-4)
    assert facts["dynamics.turn_s"] == pytest.approx(turn, abs=1e-5)
    assert facts["dynamics.energy_residue"] < 1e-7


def test_the_least_flywheel_of_the_nail_machine_is_that_of_the_trial():
    assert nail("solve").facts["dynamics.flywheel_kg_m2"] == pytest.approx(19.807, abs=1e-3)
    assert nail("solve").facts["dynamics.irregularity"] == pytest.approx(0.1, rel=1e-8)
    assert "irregularity" not in [one.code for one in nail("solve").study_findings]
    found = {one.code: one for one in nail(5).study_findings}
    assert found["irregularity"].limit == 0.1


def test_at_an_even_speed_a_mechanism_needs_the_moment_of_its_study_of_torque():
    changes = {"motor": {"type": "speed"}, "output.studies": []}
    result = gc.build(gc.load("profiles/nail_machine_flywheel.toml").with_(changes))
    dynamics, torque = result.study("dynamics"), result.study("torque")
    found = dynamics.columns
    mine, other = (one.columns["phi1_deg"] for one in (dynamics, torque))
    _, a, b = np.intersect1d(mine, other, return_indices=True)
    apart = np.abs(found["torque_motor_nm"][a] - torque.columns["torque_nm"][b])
    assert np.sort(apart)[:-4].max() < 1e-8 * np.abs(found["torque_motor_nm"]).max()  # but at jumps
    assert len(a) > 300
    work = dynamics.facts["dynamics.works_j.motor"]
    assert work == pytest.approx(torque.facts["torque.work_j"], rel=1e-9)


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("loaded_nail_machine", {}),
        ("loaded_nail_machine", {"friction.rolling_mm": 0.02, "pair.backlash_mm": 0.0}),
        ("ellipse", {"load": [{"on": "wheel2", "formula": "8 - 9*cos(phi1)"}]}),
        pytest.param(
            "stepped_ellipse",
            {"load": [{"on": "wheel2", "torque_nm": 12}], "friction.flank": 0.1},
            marks=pytest.mark.slow,
        ),
        ("ring_uneven", {"load": [{"on": "wheel2", "formula": "0.5*omega2"}]}),
    ],
)
def test_at_1_rpm_contact_forces_are_those_of_the_study_of_forces(name, changes):
    own = {"dynamics.inertia_kg_m2": [1e-5, 1e-5], "drive.speed_rpm": 1, "output.studies": []}
    result = gc.build(gc.load(f"profiles/{name}.toml").with_({**own, **changes}))
    dynamics, forces = (result.study(one) for one in ("dynamics", "forces"))
    for key in ("normal_n.min", "normal_n.max", "bearing_n.max", "pressure_mpa.max"):
        mine, other = dynamics.facts[f"dynamics.{key}"], forces.facts[f"forces.{key}"]
        largest = forces.facts[f"forces.{key.split('.')[0]}.max"]
        assert abs(mine - other) < 1e-6 * largest, key
    # works are those of the torques of the driver there
    lost, work = (dynamics.facts[f"dynamics.works_j.{one}"] for one in ("lost", "load"))
    efficiency = forces.facts.get("forces.efficiency.overall")
    if efficiency is not None and not result.design.pair.backlash:
        assert work / (work + lost) == pytest.approx(efficiency, abs=1e-3)


def test_inertia_of_a_fast_pair_loads_its_teeth():
    changes = {"dynamics.inertia_kg_m2": [0.0, 0.2], "drive.speed_rpm": 600, "blank": {}}
    result = gc.build(gc.load("profiles/ellipse.toml").with_(changes))
    found = result.study("dynamics")
    columns = found.columns
    # without a load the teeth carry J2*alpha2, the derivative of the driven speed
    alpha = np.gradient(columns["omega2_rad_s"], columns["t_s"])[2:-2]
    assert (
        np.abs(columns["torque_mesh_nm"][2:-2] - 0.2 * alpha).max()
        < 0.02 * np.abs(0.2 * alpha).max()
    )
    assert "torque-reversal" in [one.code for one in found.study_findings]


def test_wheels_have_their_own_inertia_where_they_have_a_density():
    changes = {"blank.density_kg_m3": 7850, "drive.speed_rpm": 100}
    result = gc.build(gc.load("profiles/ellipse.toml").with_(changes))
    low = result.study("dynamics").facts["dynamics.inertia_kg_m2.min"]
    own = [1e-6 * one["mass"]["inertia_kg_mm2"] for one in result.facts["gears"]]
    ratio = result.study("dynamics").columns
    least = (ratio["omega2_rad_s"] / ratio["omega1_rad_s"]).min()
    assert low == pytest.approx(own[0] + own[1] * least**2, rel=1e-6)


def test_a_travel_is_made_from_rest_without_loss():
    motor = {"type": "constant", "torque_nm": 3}
    changes = {"motor": motor, "dynamics": {"run": "start", "inertia_kg_m2": [0.01, 0.02]}}
    found = study("log_spiral", changes)
    columns = found.columns
    energy = 0.5 * (0.01 * columns["omega1_rad_s"] ** 2 + 0.02 * columns["omega2_rad_s"] ** 2)
    assert energy == pytest.approx(3.0 * np.radians(columns["phi1_deg"]), rel=1e-6)
    # of an even torque, E = M*phi, the time by a substitution without the root at the start
    x = np.linspace(0.0, math.sqrt(math.radians(columns["phi1_deg"][-1])), 20001)
    ratio = columns["omega2_rad_s"][1:] / columns["omega1_rad_s"][1:]  # the first is at rest
    inertia = 0.01 + 0.02 * np.interp(np.degrees(x**2), columns["phi1_deg"][1:], ratio) ** 2
    lasts = np.trapezoid(2.0 * np.sqrt(0.5 * inertia / 3.0), x)
    assert found.facts["dynamics.run_s"] == pytest.approx(lasts, rel=1e-4)


def test_a_turn_that_repeats_or_a_whole_travel_has_a_pace():
    found = nail(0)
    place, time = found.pace.T
    assert (place[0], place[-1]) == pytest.approx((0.0, 360.0))
    assert time[-1] - time[0] == pytest.approx(found.facts["dynamics.turn_s"], rel=1e-12)
    omega = np.interp(place, found.columns["phi1_deg"], found.columns["omega_rad_s"])
    mean = np.radians(np.diff(place)) / np.diff(time)
    assert mean == pytest.approx(0.5 * (omega[1:] + omega[:-1]), rel=5e-3)  # force jumps
    motor = {"type": "linear", "start_torque_nm": 3, "idle_rpm": 60}
    run = {"run": "start", "inertia_kg_m2": [0.01, 0.01]}
    assert study("log_spiral", {"motor": motor, "dynamics": run}).pace is not None
    assert study("ellipse", {"motor": motor, "dynamics": run}).pace is None
    against = {"load": [{"on": "wheel2", "formula": "20*phi1"}]}
    assert study("log_spiral", {"motor": motor, "dynamics": run, **against}).pace is None


def test_a_motor_that_does_not_turn_the_load_at_rest_stands():
    motor = {"type": "linear", "start_torque_nm": 3, "idle_rpm": 60}
    changes = {
        "motor": motor,
        "dynamics": {"run": "start", "inertia_kg_m2": [0.01, 0.01]},
        "load": [{"on": "wheel2", "torque_nm": 100}],
    }
    found = study("log_spiral", changes)
    assert [one.code for one in found.study_findings if one.severity == "error"] == ["stalls"]
    assert found.facts["dynamics.speed_rpm.max"] == 0.0


MACHINE = """kind = "mechanism"
name = "shaft"
drive = [{ name = "motor", even = true, speed_rpm = 100 }]
crank = [{ name = "crank", on = "motor", joint = "pin", length_mm = 50, angle_deg = 33 }]
guide = [{ name = "bed" }]
load = [{ on = "motor", torque_nm = -20 }]
mass = [%s]
motor = { type = "constant", torque_nm = 30 }
dynamics = { run = "start", turns = 2 }

[[dyad]]
type = "RRT"
from = "pin"
to = "bed"
joint = "end"
members = ["rod", "ram"]
lengths_mm = [170, 0]
"""


def test_an_even_inertia_has_no_slope(tmp_path):
    """That of a crank that turns about its axis is rounding, however it is drawn."""
    (tmp_path / "shaft.toml").write_text(
        MACHINE % '{ of = "crank", mass_kg = 7.3, at_mm = [13.6, 10.1], inertia_kg_m2 = 0.02 }'
    )
    found = gc.build(gc.load(tmp_path / "shaft.toml")).study("dynamics")
    inertia = 0.02 + 7.3e-6 * (13.6**2 + 10.1**2)
    assert found.columns["inertia_kg_m2"] == pytest.approx(inertia, rel=1e-9)
    speed = np.sqrt(2.0 * 10.0 * np.radians(found.columns["theta_deg"]) / inertia)
    assert found.columns["omega_rad_s"] == pytest.approx(speed, rel=1e-6)


def test_a_machine_without_inertia_at_some_place_is_refused_by_it(tmp_path):
    (tmp_path / "ram.toml").write_text(MACHINE % '{ of = "ram", mass_kg = 10 }')
    with pytest.raises(InfeasibleError, match="nothing that has inertia moves here"):
        gc.build(gc.load(tmp_path / "ram.toml")).study("dynamics")


def test_a_machine_that_repeats_after_two_turns_says_so(tmp_path):
    one = '{ name = "motor", even = true, speed_rpm = 100 }'
    text = MACHINE % '{ of = "crank", mass_kg = 7.3, at_mm = [13.6, 10.1] }'
    text = text.replace(one, one + ', { name = "slow", even = true, ratio = 0.5 }')
    text = text.replace('on = "motor", joint', 'on = "slow", joint').replace("= -20", "= -2")
    motor = 'motor = { type = "linear", start_torque_nm = 300, idle_rpm = 120 }\n'
    old = 'motor = { type = "constant", torque_nm = 30 }\n'
    (tmp_path / "two.toml").write_text(text.replace(old, motor))
    found = gc.build(gc.load(tmp_path / "two.toml")).study("dynamics")
    assert found.columns["theta_deg"][-1] == pytest.approx(720.0)  # it turns twice, not four times
    text = text.replace('run = "start", turns = 2', "steps = 50").replace(old, motor)
    (tmp_path / "two.toml").write_text(text)
    found = gc.build(gc.load(tmp_path / "two.toml")).study("dynamics")
    facts = found.facts
    assert facts["dynamics.period_s"] * facts["dynamics.speed_rpm.over_time"] / 60.0 == (
        pytest.approx(2.0, rel=1e-9)
    )
    assert "dynamics.turn_s" not in facts
    assert any("2 turns that repeat" in line for line in facts.lines("dynamics."))
    steps = np.arange(101) * 7.2
    assert np.isclose(found.columns["theta_deg"][:, None], steps, atol=1e-9).any(axis=0).all()


def test_a_load_that_does_no_work_is_none(tmp_path):
    text = MACHINE % '{ of = "crank", mass_kg = 7.3, at_mm = [13.6, 10.1] }'
    text = text.replace('{ name = "bed" }', '{ name = "bed", direction_deg = 33.3 }')
    across = f"{-123.4 * math.sin(math.radians(33.3))!r}, {123.4 * math.cos(math.radians(33.3))!r}"
    text = text.replace('on = "motor", torque_nm = -20', f'on = "end", force_n = [{across}]')
    (tmp_path / "across.toml").write_text(text)
    found = gc.build(gc.load(tmp_path / "across.toml")).study("dynamics")
    assert found.facts["dynamics.works_j.motor"] == pytest.approx(30.0 * 4.0 * math.pi)
    assert abs(found.facts["dynamics.works_j.load"]) < 1e-9


PAIR = {"dynamics.inertia_kg_m2": 0.2}
LINEAR = {"type": "linear", "start_torque_nm": 20000, "idle_rpm": 190}


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"drive": {}}, "drive.speed_rpm", "speed of the driver"),
        ({"dynamics": {}, "motor": LINEAR}, "dynamics.inertia_kg_m2", "density"),
        ({"motor.type": "none"}, "motor.type", "no regime"),
        ({"motor": {"type": "constant", "torque_nm": 5}}, "motor.torque_nm", "no regime"),
        ({"motor.type": "linear"}, "motor.start_torque_nm", "missing"),
        ({"motor": {**LINEAR, "breakdown_slip": 0.1}}, "motor.breakdown_slip", "does not apply"),
        ({"motor": {**LINEAR, "flywheel_kg_m2": "solve"}}, "motor.irregularity", "missing"),
        ({"dynamics.run": "start"}, "dynamics.run", "does not start"),
        ({"load[0].on": "wheel1"}, "load[0].on", "motor"),
        (
            {"motor": {"type": "table", "torque_nm": [50, 50], "rpm": [0, 300]}},
            "motor.torque_nm",
            "does not fall",
        ),
        (
            {"motor": {**LINEAR, "irregularity": 0.1}, "dynamics.run": "start"},
            "motor.irregularity",
            "regime",
        ),
        ({"dynamics.turns": 4}, "dynamics.turns", "no effect"),
        ({"dynamics": {"stiffness_n_mm_um": 14}}, "dynamics.inertia_kg_m2", "density"),
    ],
)
def test_what_cannot_run_is_refused_by_its_key(changes, key, words):
    with pytest.raises(DesignError) as caught:
        study("loaded_nail_machine", {**PAIR, **changes})
    assert caught.value.problems[0].key == key
    assert words in str(caught.value)


def test_a_travel_has_no_regime_but_starts_and_runs_once():
    open_pair = {"dynamics.inertia_kg_m2": 0.2, "motor": LINEAR}
    with pytest.raises(DesignError, match="travel has none"):
        study("log_spiral", open_pair)
    with pytest.raises(DesignError, match="no turns"):
        study("log_spiral", {**open_pair, "dynamics.run": "start", "dynamics.turns": 2})
    found = study("log_spiral", {**open_pair, "dynamics.run": "start"})
    assert found.columns["phi1_deg"][-1] == pytest.approx(
        math.degrees(found.result.turn(1)[-1]), rel=1e-9
    )


def test_a_table_that_ends_below_the_speed_is_refused_with_both_speeds():
    motor = {"type": "table", "torque_nm": [9000, 3000, 2900], "rpm": [0, 50, 60]}
    with pytest.raises(InfeasibleError, match="does not reach") as caught:
        study("loaded_nail_machine", {**PAIR, "friction": {}, "motor": motor})
    assert caught.value.limit == 60.0
    assert (caught.value.value or 0.0) > 200.0
    rows = {"torque_nm": [9000, 3000, 100, -900], "rpm": [0, 50, 300, 400]}
    changes = {**PAIR, "friction": {}, "motor": {**motor, **rows}}
    assert study("loaded_nail_machine", changes).complete
    rows = {"torque_nm": [9000, 100, -900], "rpm": [20, 300, 400]}
    start = {"dynamics.run": "start", "dynamics.turns": 1, "motor": {**motor, **rows}}
    with pytest.raises(InfeasibleError, match="does not reach") as caught:
        study("circular", {**PAIR, **start})
    assert (caught.value.value, caught.value.limit) == (0.0, pytest.approx(20.0))


def test_coasting_ends_where_the_energy_does():
    changes = {"dynamics.run": "coast", "dynamics.turns": 1000, "load": [], "friction": {}}
    load = [{"on": "wheel2", "torque_nm": 2.0}]
    found = study("loaded_nail_machine", {**PAIR, **changes, "load": load, "drive.speed_rpm": 60})
    result = found.result
    energy = 0.1 * (60 * RPM) ** 2 * (1.0 + result.law.ratio(np.zeros(1))[0] ** 2)
    stopped = math.radians(found.facts["dynamics.stopped_deg"])
    assert 2.0 * result.law.phi2(np.array([stopped]))[0] == pytest.approx(energy, rel=1e-6)
    assert [one.severity for one in found.study_findings if one.code == "stalls"] == ["note"]


def test_a_driver_that_turns_evenly_turns_as_often_as_it_is_told():
    own = {"dynamics.run": "turns", "dynamics.turns": 4, "output.studies": []}
    found = study("loaded_nail_machine", {**PAIR, **own})
    assert found.columns["phi1_deg"][-1] == pytest.approx(1440.0)
    assert found.facts["dynamics.run_s"] == pytest.approx(4.0 / 3.0)
    once = study("loaded_nail_machine", PAIR)
    assert found.facts["dynamics.works_j.load"] == pytest.approx(
        4.0 * once.facts["dynamics.works_j.load"], rel=1e-9
    )


LIGHT = {"dynamics.inertia_kg_m2": [0.02, 0.03], "dynamics.run": "start", "dynamics.turns": 1}


def test_a_weak_motor_starts_a_turn_or_is_told_what_it_lacks():
    load = [{"on": "wheel2", "torque_nm": 40}]
    motor = {"type": "linear", "start_torque_nm": 200, "idle_rpm": 120}
    found = study("ellipse", {**LIGHT, "load": load, "motor": motor})
    assert found.columns["phi1_deg"][[0, -1]] == pytest.approx([0.0, 360.0], abs=1e-9)
    assert found.columns["t_s"][-1] == pytest.approx(found.facts["dynamics.run_s"], rel=1e-12)
    standing = study("ellipse", {**LIGHT, "load": load, "motor": {**motor, "start_torque_nm": 20}})
    (stalls,) = (one for one in standing.study_findings if one.code == "stalls")
    ratio = standing.result.law.ratio(np.zeros(1))[0]
    assert stalls.value == pytest.approx(40.0 * ratio - 20.0, rel=1e-9)
    assert standing.facts["dynamics.stopped_deg"] == 0.0


def test_a_load_over_the_driven_angle_repeats_with_the_turn_or_is_refused():
    load = [{"on": "wheel2", "formula": "40 + 10*cos(phi2)"}]
    changes = {"dynamics.inertia_kg_m2": 0.2, "motor": LINEAR, "load": load}
    with pytest.raises(InfeasibleError, match="does not repeat"):
        study("circular", {**changes, "pair.teeth": [20, 40]})
    assert study("circular", {**changes, "pair.teeth": [40, 20]}).complete


def test_a_mechanism_that_has_no_inertia_at_a_dead_centre_is_refused_there(tmp_path):
    text = (
        'kind = "mechanism"\n[[drive]]\nname = "motor"\neven = true\n[[crank]]\nname = "crank"\n'
        'on = "motor.shaft"\njoint = "pin"\nlength_mm = 100\nangle_deg = 40\n[[guide]]\n'
        'name = "bed"\nthrough = "motor.shaft"\n[[dyad]]\ntype = "RRT"\nfrom = "pin"\nto = "bed"\n'
        'joint = "slide"\nmembers = ["rod", "ram"]\nlengths_mm = [400, 0]\nbranch = "ahead"\n'
        '[[mass]]\nof = "ram"\nmass_kg = 10\n[output]\noutputs = ["slide"]\n'
        '[motor]\ntype = "linear"\nstart_torque_nm = 100\nidle_rpm = 80\n'
    )
    path = tmp_path / "ram.toml"
    path.write_text(text)
    with pytest.raises(InfeasibleError, match="nothing that has inertia moves here"):
        gc.build(gc.load(path)).study("dynamics")
    path.write_text(text + "flywheel_kg_m2 = 1\n")
    found = gc.build(gc.load(path)).study("dynamics")
    # without a load the motor idles: net works are nothing, but the energies balance
    assert found.facts["dynamics.energy_residue"] < 1e-8
    assert found.study_findings == ()


def test_the_mean_power_is_the_work_over_the_time():
    found = nail(5)
    power, t = found.columns["power_w"], found.columns["t_s"]
    assert found.facts["dynamics.power_w.mean"] == pytest.approx(
        np.trapezoid(power, t) / t[-1], rel=1e-3
    )


def test_friction_takes_power_also_where_teeth_are_driven():
    changes = {"load": [{"on": "wheel2", "formula": "8 - 9*cos(phi1)"}], "friction.flank": 0.1}
    own = {"dynamics.inertia_kg_m2": [1e-4, 1e-4], "drive.speed_rpm": 10, "output.studies": []}
    columns = study("ellipse", {**own, **changes}).columns
    assert columns["torque_mesh_nm"].min() < -0.5
    assert columns["torque_lost_nm"].min() > -1e-9
    assert columns["torque_lost_nm"][columns["torque_mesh_nm"] < -0.5].max() > 1e-3


SMALL = {"dynamics.inertia_kg_m2": [0.02, 0.03], "motor": {"type": "linear"}}
SMALL["motor"] |= {"start_torque_nm": 200, "idle_rpm": 120}


def test_the_largest_power_is_that_between_rows():
    run = {"dynamics.run": "start", "dynamics.steps": 12}
    found = study("circular", {**SMALL, **run})
    # of a linear motor that runs up: at half of its speed without load
    most = 0.25 * 200.0 * 120.0 * RPM
    assert found.facts["dynamics.power_w.peak"] == pytest.approx(most, rel=1e-9)
    assert found.columns["power_w"].max() < 0.99 * most
    # and of a load that is narrower than a step
    load = [{"on": "wheel2", "formula": "20 + 40*exp(5000*(cos(phi1 - 2) - 1))"}]
    changes = {"dynamics.inertia_kg_m2": 0.1, "dynamics.steps": 12, "drive.speed_rpm": 100}
    facts = study("circular", {**changes, "load": load}).facts
    assert facts["dynamics.torque_motor_nm.max"] == pytest.approx(60.0 * 14.0 / 35.0, rel=1e-9)
    assert facts["dynamics.torque_motor_nm.min"] == pytest.approx(20.0 * 14.0 / 35.0, rel=1e-9)


def test_a_resonance_is_told_with_the_speed_that_makes_it():
    places, ratio = np.array([0.0, 1.0, 2.0]), np.array([0.4, 0.48, 1.04])
    teeth = VibratingTeeth(lost=[], phi1=places, ratio=ratio, speed=100.0 * RPM, place=str)
    found = [one.message for one in run_checks(VIBRATION, teeth, {})]
    assert [one.split("exactly so at ")[1].split(":")[0] for one in found] == [
        "a mean speed of 96.15 rpm",
        "a mean speed of 104.2 rpm",
    ]


@pytest.mark.parametrize(("formula", "jump"), [("40*cos(phi1/2)", -80), ("40*cos(phi1)", 0)])
def test_a_formula_that_does_not_repeat_is_noted_with_its_jump(formula, jump):
    found = study("circular", {**SMALL, "load": [{"on": "wheel2", "formula": formula}]})
    ratio = 14.0 / 35.0
    notes = [one.value for one in found.study_findings if one.code == "load-jumps"]
    assert notes == ([pytest.approx(ratio * jump, rel=1e-6)] if jump else [])


@pytest.mark.parametrize("torque", [-20.0, 20.0])
def test_loads_that_drive_are_noted_with_their_work(torque):
    found = study("circular", {**SMALL, "load": [{"on": "wheel2", "torque_nm": torque}]})
    notes = [one.value for one in found.study_findings if one.code == "load-drives"]
    work = 2.0 * math.pi * torque * 14.0 / 35.0
    assert notes == ([pytest.approx(work, rel=1e-9)] if torque < 0.0 else [])


def test_a_load_that_no_polynomial_has_is_refused_with_what_is_allowed():
    load = [{"on": "wheel2", "formula": "100/omega2"}]
    with pytest.raises(InfeasibleError, match="a load is no polynomial of the speed") as caught:
        study("circular", {**SMALL, "load": load})
    assert "omega2" in caught.value.nearest


def test_a_table_with_fewer_rows_than_steps_says_so(monkeypatch):
    assert "dynamics.rows" not in study("circular", SMALL).facts
    monkeypatch.setattr("gearcam.kinds.machine_motion._ROWS", 100)
    found = study("circular", {**SMALL, "dynamics.run": "start", "dynamics.turns": 4})
    assert found.facts["dynamics.rows"] == len(found.columns["t_s"]) < 400
    (line,) = (one for one in found.facts.lines("dynamics.") if "rows of dynamics.csv" in one)
    assert "25 steps of a turn, not 360" in line


def test_a_start_has_run_up_when_a_turn_has_nearly_the_speed_of_the_regime():
    inertia = {"dynamics.inertia_kg_m2": [2.0, 12.5], "dynamics.run": "start"}
    changes = {**SMALL, **inertia, "dynamics.turns": 12}
    found = study("circular", changes)
    # J = 2 + 0.16*12.5 = 4: omega = idle*(1 - exp(-t/tau)), tau = J*idle/start
    idle = 120.0 * RPM
    tau, turn = 4.0 * idle / 200.0, 2.0 * math.pi / idle

    def angle(t: float) -> float:
        return idle * (t - tau * (1.0 - math.exp(-t / tau)))

    low, high = turn / 0.99, 20.0
    while high - low > 1e-12:
        middle = 0.5 * (low + high)
        short = angle(middle) - angle(middle - turn / 0.99) < 2.0 * math.pi
        low, high = (middle, high) if short else (low, middle)
    assert found.facts["dynamics.runup_s"] == pytest.approx(low, rel=1e-7)
    (speed,) = found.charts["run_up"].lines
    assert speed.y == pytest.approx(120.0 * (1.0 - np.exp(-speed.x / tau)), abs=1e-4)
    assert "dynamics.runup_s" not in study("circular", {**changes, "dynamics.turns": 1}).facts
    assert "run_up" not in study("circular", SMALL).charts
