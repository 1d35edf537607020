"""The study of dynamics of cams: reference values, the limit of slow cams, swinging, refusals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.findings import run_checks
from gearcam.dynamics.follower_checks import MOVING, MovingFollower
from gearcam.dynamics.polydyne import Train, polydyne
from gearcam.kinds.cam import moving
from helpers_built import built
from helpers_sampling import chosen

RPM = math.pi / 30.0
TRAIN = gc.load("profiles/elastic_valve_train.toml")


def studied(design: gc.Design | str, changes: dict[str, Any] | None = None) -> Any:
    found = gc.load(f"profiles/{design}.toml") if isinstance(design, str) else design
    return built(found.with_(changes or {})).study("dynamics")


def fact(study: gc.StudyResult, name: str) -> Any:
    return study.facts[f"dynamics.{name}"]


def codes(study: gc.StudyResult) -> list[str]:
    return [one.code for one in study.study_findings]


def test_the_train_of_the_reference() -> None:
    study = studied(TRAIN)
    assert fact(study, "jump_rpm.rigid") == pytest.approx(1218.964, abs=1e-3)
    assert fact(study, "jump_rpm.elastic") == pytest.approx(1131.857, abs=2e-3)
    assert fact(study, "contact_force_n.min") == pytest.approx(21.9047, abs=2e-3)
    assert fact(study, "acceleration.over_rigid") == pytest.approx(1.2318, abs=1e-4)
    frequencies = np.array(fact(study, "natural_frequency_hz")) * 2.0 * math.pi
    assert frequencies == pytest.approx([1908.90150566, 10506.0028099])
    assert codes(study) == ["near-jump"]
    assert study.columns["contact"].min() == 1
    assert fact(study, "energy_residue") < 1e-6
    assert fact(study, "error_n") < 1e-2


def test_what_the_findings_state_is_what_the_facts_do() -> None:
    """The normal force of a flat follower is along the lift; the lift is 10 mm."""
    design = TRAIN.with_({"limits.residual_vibration": 0.001})
    near, swings = studied(design).study_findings
    study = studied(TRAIN)
    theta = study.columns["theta_deg"]
    mean = np.trapezoid(study.columns["contact_n"], theta) / 360.0
    assert near.value == pytest.approx(fact(study, "contact_force_n.min") / mean, rel=1e-3)
    assert near.where == "at 197.63 deg"
    first, second = fact(study, "residual")
    assert swings.value == pytest.approx(0.1 * max(first["residual_mm"], second["residual_mm"]))
    assert study.group["residual"][0]["residual_mm"].at_most == pytest.approx(0.01 * 10.0)
    assert [one.code for one in (near, swings)] == ["near-jump", "residual-vibration"]


def test_it_says_whether_turns_repeat() -> None:
    for changes, told in (({"drive.speed_rpm": 1200}, False), ({"drive.speed_rpm": 1700}, True)):
        study = studied(TRAIN, {"dynamics.turns": 7, **changes})
        (found,) = [one for one in study.study_findings if one.code == "jump"]
        after = f"After {fact(study, 'turns')} turns it does not repeat itself yet"
        assert (after in found.message) == told
        assert fact(study, "repeats") != told


def test_beyond_its_jump_it_flies() -> None:
    study = studied(TRAIN, {"drive.speed_rpm": 1200})
    assert "jump" in codes(study)
    assert fact(study, "contact_force_n.min") == 0.0
    flights = fact(study, "lost")
    columns = study.columns
    for one in flights:
        inside = (columns["theta_deg"] > one["from_deg"]) & (columns["theta_deg"] < one["to_deg"])
        assert not columns["contact"][inside].any()
        assert not columns["contact_n"][inside].any()
        assert not columns["torque_nm"][inside].any()
        assert one["impact_mm_s"] > 0.0
    (found,) = [one for one in study.study_findings if one.code == "jump"]
    assert "up to 1131.9 rpm" in found.message
    assert found.value == pytest.approx(max(one["impact_mm_s"] for one in flights))


def test_a_flight_beyond_the_turn_has_no_impact() -> None:
    study = studied(TRAIN, {"drive.speed_rpm": 8000, "dynamics.turns": 1})
    assert "impact_mm_s" not in fact(study, "lost")[-1]
    many = studied(TRAIN, {"drive.speed_rpm": 30_000, "dynamics.turns": 1})
    (found,) = [one for one in many.study_findings if one.code == "jump"]
    assert found.value is None


def eccentric(**changes: Any) -> gc.Design:
    """A lift e*(1 - cos(theta)) of 5 mm under a spring of 10 N/mm and 40 N, 0.5 kg."""
    more = {
        "motion": {"lift": "5*(1 - cos(theta))"},
        "drive.speed_rpm": 1000,
        "mass": [{"mass_kg": 0.5}],
        "spring": [{"stiffness_n_mm": 10, "preload_n": 40}],
        **changes,
    }
    return gc.load("profiles/eccentric_cam.toml").with_(more)


def test_a_rigid_follower_jumps_as_the_forces_say() -> None:
    study = studied(eccentric())
    assert fact(study, "jump_rpm.rigid") == pytest.approx(2259.776, abs=1e-3)
    assert fact(study, "jump_rpm.rigid") * RPM == pytest.approx(236.643191324, abs=1e-8)
    assert "dynamics.jump_rpm.elastic" not in study.facts
    assert study.study_findings == ()


SLOW: dict[str, dict[str, Any]] = {
    "valve_train": {"spring": [{"stiffness_n_mm": 20, "preload_n": 300}]},
    "plate_cam_offset_roller": {
        "mass": [{"mass_kg": 0.3}],
        "spring": [{"stiffness_n_mm": 5, "preload_n": 60}],
        "friction": {"roller": 0.1, "guide": 0.1, "guide_length_mm": 60, "joint": 0.1,
                     "journal_radius_mm": [10, 3]},
    },
    "valve_lever": {
        "mass": [{"inertia_kg_m2": 0.0004, "mass_kg": 0.2, "center_mm": 20}],
        "gravity": {"direction_deg": -60},
        "spring": [{"stiffness_nm_rad": 8, "preload_nm": 4}],
        "friction": {"flank": 0.1, "joint": 0.15, "journal_radius_mm": 8},
    },
    "elastic_valve_train": {
        "gravity": {"direction_deg": -70},
        "mass": [{"mass_kg": 2}, {"of": "train", "mass_kg": 3}],
        "dynamics.contact_stiffness_n_mm": 1e9,
        "output.studies": [],
    },
}  # fmt: skip


def both(name: str, changes: dict[str, Any]) -> tuple[Any, Any]:
    """Columns of dynamics and of forces at whole degrees inside the turn."""
    design = gc.load(f"profiles/{name}.toml").with_({"forces.steps": 360, **changes})
    result = gc.build(design)
    found = []
    for study in ("dynamics", "forces"):
        columns = result.study(study).columns
        theta = np.asarray(columns["theta_deg"])
        rows = [int(np.abs(theta - one - 0.0).argmin()) for one in range(1, 360)]
        found.append({key: np.asarray(columns[key])[rows] for key in columns})
    return found[0], found[1]


@pytest.mark.parametrize("name", chosen(sorted(SLOW), "elastic_valve_train", "valve_lever"))
def test_a_slow_cam_has_the_forces_of_statics(name: str) -> None:
    """The train is so stiff that it does not shorten the way of the spring, but moves."""
    swings = name == "valve_lever"
    key = "dynamics.stiffness_nm_rad" if swings else "dynamics.stiffness_n_mm"
    changes = {"drive.speed_rpm": 1, key: 1e9, "dynamics.tolerance": 1e-9, **SLOW[name]}
    moving, still = both(name, changes)
    assert moving["contact_n"] == pytest.approx(still["normal_n"], rel=1e-6)
    scale = np.abs(still["torque_nm"]).max()
    assert moving["torque_nm"] == pytest.approx(still["torque_nm"], abs=1e-6 * scale)
    assert moving["pressure_mpa"] == pytest.approx(still["pressure_mpa"], rel=1e-6)


def test_an_elastic_train_shortens_the_way_of_the_spring() -> None:
    """Slowly the last mass makes k/(k + ks) of the lift, and the preload as much less."""
    moving, still = both("valve_train", {
        "drive.speed_rpm": 1, "dynamics.stiffness_n_mm": 2000, "dynamics.tolerance": 1e-9,
        "spring": [{"stiffness_n_mm": 20, "preload_n": 300}], "friction": {}, "load": [],
    })  # fmt: skip
    share = 2000.0 / 2020.0
    assert moving["contact_n"] == pytest.approx(share * still["normal_n"], rel=1e-5)


@pytest.mark.parametrize("study", ["forces", "dynamics"])
def test_the_damper_of_a_spring(study: str) -> None:
    """Of a rigid follower it adds c*W*s' to the load."""
    spring = {"stiffness_n_mm": 10, "preload_n": 200, "damping_n_s_mm": 0.2}
    columns = gc.build(eccentric(spring=[spring])).study(study).columns
    theta, w = np.radians(columns["theta_deg"]), 1000.0 * RPM
    load = 200.0 + 50.0 * (1.0 - np.cos(theta)) + 0.2 * w * 5.0 * np.sin(theta)
    load += 0.5e-3 * w**2 * 5.0 * np.cos(theta)
    assert columns["load_n"] == pytest.approx(load, abs=1e-9)


def test_a_damped_rigid_follower_jumps_earlier() -> None:
    """(m*W^2 - ks)^2 + (c*W)^2 = ((F0 + ks*e)/e)^2 for a harmonic lift."""
    spring = {"stiffness_n_mm": 10, "preload_n": 40, "damping_n_s_mm": 0.05}
    study = studied(eccentric(spring=[spring]))
    a, b = 0.5e-3**2, 0.05**2 - 2.0 * 0.5e-3 * 10.0
    c = 10.0**2 - (90.0 / 5.0) ** 2
    speed = math.sqrt((-b + math.sqrt(b * b - 4.0 * a * c)) / (2.0 * a))
    assert fact(study, "jump_rpm.rigid") * RPM == pytest.approx(speed, rel=1e-9)


def test_a_swinging_follower_is_one_that_slides_on_a_long_arm() -> None:
    """Moments about the pivot: inertia m*L^2, stiffness k*L^2, preload F*L, lift h/L."""
    arm, prime, lift = 2000.0, 60.0, 10.0
    phases = [
        {"type": "rise", "law": "cycloidal", "angle_deg": 90},
        {"type": "dwell", "angle_deg": 90},
        {"type": "return", "law": "cycloidal", "angle_deg": 90},
        {"type": "dwell", "angle_deg": 90},
    ]
    slides = gc.load("profiles/plate_cam_offset_roller.toml").with_({
        "motion": [{**phases[0], "lift_mm": lift}, *phases[1:]],
        "follower": {"type": "roller", "motion": "translating", "roller_radius_mm": 10},
        "cam": {"prime_radius_mm": prime, "thickness_mm": 10},
        "drive.speed_rpm": 600, "mass": [{"mass_kg": 0.5}],
        "spring": [{"stiffness_n_mm": 10, "preload_n": 200, "damping_n_s_mm": 0.02}],
        "dynamics": {"stiffness_n_mm": 2000},
    })  # fmt: skip
    meter = 1e-3 * arm
    swings = slides.with_({
        "motion": [{**phases[0], "lift_deg": math.degrees(lift / arm)}, *phases[1:]],
        "follower": {"type": "roller", "motion": "oscillating", "roller_radius_mm": 10,
                     "pivot_distance_mm": math.hypot(arm, prime), "arm_mm": arm},
        "mass": [{"inertia_kg_m2": 0.5 * meter**2}],
        "spring": [{"stiffness_nm_rad": 1e4 * meter**2, "preload_nm": 200 * meter,
                    "damping_nm_s_rad": 20 * meter**2}],
        "dynamics": {"stiffness_nm_rad": 2e6 * meter**2},
    })  # fmt: skip
    straight, turned = studied(slides), studied(swings)
    for name in ("natural_frequency_hz", "acceleration.over_rigid"):
        assert fact(turned, name) == pytest.approx(fact(straight, name), rel=1e-9)
    assert fact(turned, "jump_rpm.elastic") == pytest.approx(fact(straight, "jump_rpm.elastic"))
    for name in ("contact_force_n.min", "contact_force_n.max"):
        assert fact(turned, name) == pytest.approx(fact(straight, name), rel=0.01)
    load = np.asarray(turned.columns["load_nm"]) / meter
    assert load == pytest.approx(np.asarray(straight.columns["load_n"]), rel=1e-6)


@pytest.mark.parametrize(
    ("which", "limit", "told"),
    [
        ("preload_n", 0.1, "near-jump"),
        ("stiffness_n_mm", 0.0, "jump"),
        pytest.param("preload_n", 0.0, "jump", marks=pytest.mark.slow),
        pytest.param("stiffness_n_mm", 0.1, "near-jump", marks=pytest.mark.slow),
    ],
)
def test_a_spring_that_is_solved_for_keeps_the_follower(
    which: str, limit: float, told: str
) -> None:
    """With the contact force that the check asks for, also with the six digits that are printed."""
    spring = {"stiffness_n_mm": 10, "preload_n": 200, which: "solve"}
    changes = {"drive.speed_rpm": 1150, "limits.contact_force": limit}
    solved = studied(TRAIN, {"spring": [spring], **changes})
    value = fact(solved, f"spring.{which}")
    printed = studied(TRAIN, {"spring": [{**spring, which: float(f"{value:.6g}")}], **changes})
    for one in (solved, printed):
        assert not {"jump", "near-jump"} & set(codes(one))
    forces = printed.columns["contact_n"]
    assert forces.min() == pytest.approx(limit * forces.mean(), rel=0.02, abs=0.5)
    if not limit:
        assert fact(printed, "jump_rpm.elastic") == pytest.approx(1150.0, abs=0.1)
    weaker = {**spring, which: 0.98 * value}
    assert told in codes(studied(TRAIN, {"spring": [weaker], **changes}))


def test_a_spring_that_would_have_to_be_stiffer_than_the_train_is_refused() -> None:
    spring = {"stiffness_n_mm": "solve", "preload_n": 20}
    with pytest.raises(gc.InfeasibleError, match="no stiffness softer than the train") as error:
        studied(TRAIN, {"spring": [spring], "drive.speed_rpm": 1150})
    assert "more preload" in str(error.value)


def test_residual_vibrations_are_those_of_dwells() -> None:
    """Without loads of an inertia behind: one mass, hardly damped, a law with a closed form."""
    design = TRAIN.with_({
        "mass": [{"mass_kg": 0.5}], "drive.speed_rpm": 300, "spring": [{"preload_n": 500}],
        "dynamics": {"stiffness_n_mm": 2000, "damping_ratio": 0.02},
    })  # fmt: skip
    study = studied(design)
    tau = 0.25 / 5.0 * fact(study, "natural_frequency_hz")[0]
    swing = abs(math.sin(math.pi * tau) / (math.pi * tau * (1.0 - tau**2)))
    first, second = fact(study, "residual")
    assert (first["from_deg"], second["from_deg"]) == pytest.approx((90.0, 270.0))
    (dots,) = [one for one in study.charts["residual"].lines if one.dots]
    assert dots.y == pytest.approx([swing, swing], abs=1e-12)
    assert first["residual_mm"] == pytest.approx(second["residual_mm"], rel=0.05)
    assert first["residual_mm"] < 10.0 * (swing + 1e-3)


def test_a_load_against_the_motion_jumps_where_it_turns() -> None:
    """In the middle of a formula, too, where the lift has no knot."""
    load = [{"force_n": 20, "against": True}]
    design = eccentric(load=load, **{"dynamics.stiffness_n_mm": 2000, "drive.speed_rpm": 100})
    cam = moving.MovingCam(gc.build(design))
    assert cam.knots == pytest.approx([0.0, math.pi, 2.0 * math.pi], abs=1e-8)
    force = cam.turn.contact_force(np.array([1.0, 4.0]))
    s = 5.0 * (1.0 - np.cos([1.0, 4.0]))
    assert force == pytest.approx(40.0 + 10.0 * s + np.array([20.0, -20.0]), rel=0.02)


def test_it_begins_at_rest_where_the_periodic_motion_has_lost_contact() -> None:
    changes = {"motion": {"lift": "5*(1 + cos(theta))"}, "drive.speed_rpm": 2700}
    cam = moving.MovingCam(gc.build(eccentric(**changes, dynamics={
        "stiffness_n_mm": 2000, "turns": 1})))  # fmt: skip
    _, state = cam.turn.start
    assert state[:2] == pytest.approx([-(40.0 + 10.0 * 10.0) / 2010.0, 0.0], abs=1e-12)


def test_the_contact_of_hertz() -> None:
    """Along the lift: by the mean square of the normal's share in it."""
    study = studied("plate_cam_offset_roller", {
        "drive.speed_rpm": 200, "mass": [{"mass_kg": 0.3}],
        "spring": [{"stiffness_n_mm": 5, "preload_n": 60}],
        "dynamics": {"contact_stiffness_n_mm": 1000},
    })  # fmt: skip
    angles = np.radians(study.result.motion()["pressure_angle_deg"][:-1])
    along = fact(study, "contact_stiffness_n_mm")
    assert along == pytest.approx(1000.0 * np.mean(np.cos(angles) ** 2), rel=1e-4)
    by_hertz = studied(study.result.design, {"dynamics.contact_stiffness_n_mm": "hertz"})
    assert 1e4 < fact(by_hertz, "contact_stiffness_n_mm") < 1e6


@pytest.mark.parametrize("damping", chosen([0.0, 0.1], 0.1))
def test_a_polydyne_cam_does_not_swing_at_its_speed(damping: float) -> None:
    spring = {"stiffness_n_mm": 10, "preload_n": 300, "damping_n_s_mm": damping}
    design = gc.load("profiles/polydyne_cam.toml").with_({"spring": [spring]})
    study = studied(design)
    cam = moving.MovingCam(study.result)
    x = np.linspace(0.0, 6.28, 400)
    plain = gc.build(design.with_({"drive.polydyne": False})).program
    place = cam.result.program.derivatives(x, 0)[0] + cam.periodic.at(x)[0]
    wanted = plain.derivatives(x, 0)[0] - 300.0 / 2010.0
    assert place == pytest.approx(wanted, abs=1e-12)
    for one in fact(study, "residual"):
        assert one["residual_mm"] < 2e-4
    line = study.charts["speed"].lines[0]
    assert line.x[np.argmin(line.y)] == pytest.approx(900.0)
    assert line.y[0] > 5.0 * line.y.min()
    assert line.y[-1] > 50.0 * line.y.min()
    swinging = studied(design, {"drive.polydyne": False})
    assert fact(swinging, "residual")[0]["residual_mm"] > 5e-3


def test_a_polydyne_lift_ends_as_it_begins_however_much_the_damper_lags() -> None:
    """At 2 natural periods in a turn a bend is left of the turn before."""
    program = gc.build(
        gc.load("profiles/polydyne_cam.toml").with_({"drive.polydyne": False})
    ).program
    train = Train(mass=0.5e-3, stiffness=2000.0, damping=1.8, spring=0.0, damper=0.0, speed=1000.0)
    lift = polydyne(program, train)
    first, last = (lift.derivatives(np.array([x]), 1) for x in (0.0, 2.0 * math.pi * (1 - 1e-15)))
    assert first[0] == pytest.approx(last[0], abs=1e-9)
    s, x = program.derivatives(np.array([1.0, 3.0]), 2), np.array([1.0, 3.0])
    y = lift.derivatives(x, 1)
    v, rate = y[0] - s[0], y[1] - s[1]
    assert 1.8 * 1000.0 * rate + 2000.0 * v == pytest.approx(0.5e-3 * 1e6 * s[2], abs=1e-8)


def test_a_polydyne_lift_has_its_own_derivatives() -> None:
    program = gc.build(gc.load("profiles/polydyne_cam.toml")).program
    x, h = np.linspace(0.05, 6.2, 200), 1e-5
    found = program.derivatives(x, 4)
    for order in range(1, 5):
        high, low = (program.derivatives(x + one, order - 1)[-1] for one in (h, -h))
        scale = np.abs(found[order]).max()
        assert (high - low) / (2.0 * h) == pytest.approx(found[order], abs=1e-5 * scale)
    assert program.range[1] == pytest.approx(10.0 * 2010.0 / 2000.0, abs=1e-6)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"dynamics": {}}, "needs the stiffness"),
        ({"mass": []}, "needs the mass"),
        ({"drive": {"polydyne": True}}, "needs a speed"),
        ({"mass": [{"mass_kg": 1}, {"of": "train", "mass_kg": 1}]}, "of one mass"),
        ({"dynamics.contact_stiffness_n_mm": 9}, "stiffness of the contact"),
        ({"load": [{"formula": "s"}]}, "loads that vary"),
        ({"spring": [{"stiffness_n_mm": "solve", "preload_n": 1}]}, 'a stiffness "solve"'),
    ],
)
def test_what_a_polydyne_cam_cannot_have(changes: dict[str, Any], told: str) -> None:
    with pytest.raises(gc.DesignError, match=told):
        gc.load("profiles/polydyne_cam.toml").with_(changes)


def test_a_polydyne_cam_needs_a_smooth_jerk() -> None:
    phases = [
        {"type": "rise", "law": "cycloidal", "angle_deg": 180, "lift_mm": 5},
        {"type": "return", "law": "cycloidal", "angle_deg": 180},
    ]
    design = gc.load("profiles/polydyne_cam.toml").with_({"motion": phases})
    with pytest.raises(gc.InfeasibleError, match=r"its jerk jumps at 0 deg .*4-5-6-7"):
        _ = gc.build(design).program


def test_charts_of_the_study() -> None:
    charts = studied(TRAIN).charts
    assert list(charts) == ["contact", "acceleration", "lag", "spectrum", "residual", "speed"]
    of_rigid = studied(eccentric()).charts
    assert list(of_rigid) == ["contact", "acceleration"]
    for one in of_rigid.values():
        assert [line.label for line in one.lines] == ["rigid follower"]
    assert [one.label for one in charts["lag"].lines] == ["mass 1", "mass 2"]


def test_the_chart_of_vibrations_has_the_laws_of_the_design_down_to_a_floor() -> None:
    chart = studied("polydyne_cam").charts["residual"]
    *curves, dots = chart.lines
    assert [one.label for one in curves][-2:] == ["modified-sine", "4-5-6-7"]
    assert dots.label == "phases of this cam, not corrected"
    own = np.interp(dots.x, curves[-1].x, curves[-1].y)
    assert dots.y == pytest.approx(own, rel=0.02)
    assert min(np.nanmin(one.y) for one in curves) >= 1e-4
    quick = studied("polydyne_cam", {"drive.speed_rpm": 380}).charts["residual"].lines
    assert float(quick[-1].y[0]) < 1e-4
    assert min(np.nanmin(one.y) for one in quick[:-1]) == pytest.approx(quick[-1].y[0], rel=0.5)


def test_harmonics_are_those_of_the_accelerations() -> None:
    """A harmonic lift has one; nothing that is noise is shown."""
    design = eccentric(dynamics={"stiffness_n_mm": 2000}, spring=[{"preload_n": 400}])
    moving, rigid = studied(design).charts["spectrum"].lines
    square = (1000.0 * RPM) ** 2
    assert rigid.x.tolist() == [1.0]
    assert rigid.y == pytest.approx([5.0 * square])
    share = 2000.0 / (2000.0 - 0.5e-3 * square)
    assert moving.y == pytest.approx([5.0 * square * share], rel=1e-3)


@pytest.mark.parametrize("name", ["groove_cam", "yoke_cam", "conjugate_cams"])
def test_a_cam_that_holds_its_follower(name: str) -> None:
    swings = name == "conjugate_cams"
    mass = {"inertia_kg_m2": 0.0003} if swings else {"mass_kg": 0.3}
    key = "dynamics.stiffness_nm_rad" if swings else "dynamics.stiffness_n_mm"
    study = studied(name, {"drive.speed_rpm": 300, "mass": [mass], key: 2000})
    assert codes(study) == []
    assert "dynamics.jump_rpm" not in study.facts
    assert study.columns["contact"].min() == 1
    least, most = (
        float(one(study.columns["load_nm" if swings else "load_n"])) for one in (min, max)
    )
    assert least < 0.0 < most  # now one wall carries, now the other


REFUSED: tuple[tuple[str, dict[str, Any], str], ...] = (
    ("elastic_valve_train", {"mass": []}, "dynamics need the mass of the follower"),
    ("eccentric_cam", {"mass": [{"mass_kg": 1}]}, "drive.speed_rpm: is missing"),
    ("elastic_valve_train", {"dynamics": {}}, "dynamics.stiffness_n_mm"),
    ("elastic_valve_train", {"dynamics": {"stiffness_n_mm": 9}}, "dynamics.contact_stiffness_n_mm"),
    ("elastic_valve_train", {"dynamics.contact_stiffness_n_mm": "hertz"}, "no radius"),
    ("elastic_valve_train", {"mass": [{"of": "train", "mass_kg": 1}]}, "the mass of the follower"),
    ("translating_cam", {"drive.speed_mm_s": 10, "mass": [{"mass_kg": 1}]}, "cam.form"),
)


def test_all_that_is_missing_is_told_at_once() -> None:
    with pytest.raises(gc.DesignError) as error:
        studied(TRAIN, {"mass": [{"of": "train", "mass_kg": 1}], "dynamics": {}, "drive": {}})
    keys = [one.key for one in error.value.problems]
    assert keys == [
        "drive.speed_rpm", "mass", "dynamics.stiffness_n_mm", "dynamics.contact_stiffness_n_mm"
    ]  # fmt: skip


@pytest.mark.parametrize(("name", "changes", "told"), REFUSED)
def test_what_is_missing_is_told(name: str, changes: dict[str, Any], told: str) -> None:
    with pytest.raises(gc.DesignError, match=told):
        studied(name, changes)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"dynamics.stiffness_nm_rad": 9}, "does not suit a translating follower"),
        ({"dynamics": {"turns": 3}}, "stiffness_n_mm"),
        ({"dynamics.damping_ratio": 1.0}, "0.9"),
        ({"dynamics.method": "euler"}, "radau"),
        ({"spring": [{"damping_nm_s_rad": 1}]}, "does not suit a translating follower"),
    ],
)
def test_contradictions_are_told(changes: dict[str, Any], told: str) -> None:
    with pytest.raises(gc.DesignError, match=told):
        TRAIN.with_(changes)


def test_a_jump_of_velocity_is_refused() -> None:
    phases = [{"type": "rise", "law": "constant-velocity", "angle_deg": 180, "lift_mm": 5},
              {"type": "return", "law": "cycloidal", "angle_deg": 180}]  # fmt: skip
    with pytest.raises(gc.InfeasibleError, match="velocity jumps"):
        studied(TRAIN, {"motion": phases})


def test_without_scipy_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    with pytest.raises(gc.MissingExtraError, match=r"gearcam\[dynamics\]"):
        gc.build(TRAIN).study("dynamics")


def subject(**changes: Any) -> MovingFollower:
    plain: dict[str, Any] = {
        "flights": (), "impact": 0.0, "unit": "mm/s", "stays": "", "least": 0.5, "least_at": "at 1",
        "residual": 0.001, "residual_at": "dwell", "restless": 0, "energy_residue": 1e-6,
        "tolerance": 1e-6,
    }  # fmt: skip
    return MovingFollower(**plain | changes)


@pytest.mark.parametrize(
    ("changes", "found"),
    [
        ({}, []),
        ({"least": 0.0999}, ["near-jump"]),
        ({"least": math.nan}, []),
        ({"least": 0.0, "flights": ("a",), "impact": 2.0}, ["jump"]),
        ({"residual": 0.0101}, ["residual-vibration"]),
        ({"energy_residue": 1.01e-4}, ["energy"]),
        ({"energy_residue": 0.99e-4, "least": 0.1, "residual": 0.01}, []),
    ],
)
def test_findings_just_within_and_beyond(changes: dict[str, Any], found: list[str]) -> None:
    assert [one.code for one in run_checks(MOVING, subject(**changes), {})] == found


def test_turns_that_do_not_repeat_are_told() -> None:
    (found,) = run_checks(MOVING, subject(flights=("a", "b"), impact=1.0, restless=8), {})
    assert "After 8 turns it does not repeat itself yet" in found.message
    assert found.where == "a, and 1 more"


def test_a_spring_beside_a_damper_is_solved_for_with_it() -> None:
    """The return of a harmonic lift, closed form: the forces of statics."""
    spring = {"stiffness_n_mm": 10, "preload_n": "solve", "damping_n_s_mm": 0.2}
    speed = 2000.0
    result = gc.build(eccentric(spring=[spring], **{"drive.speed_rpm": speed}))
    w = speed * RPM
    needed = 5.0 * math.hypot(10.0 - 0.5e-3 * w**2, 0.2 * w) - 50.0
    found = result.study("forces").facts["forces.spring.preload_n"]
    assert found == pytest.approx(needed, rel=1e-9)


def test_a_damper_needs_a_speed() -> None:
    spring = {"preload_n": 10, "damping_n_s_mm": 0.2}
    design = gc.load("profiles/eccentric_cam.toml").with_({"spring": [spring]})
    with pytest.raises(gc.DesignError, match="a damper acts by the speed"):
        gc.build(design).study("forces")
