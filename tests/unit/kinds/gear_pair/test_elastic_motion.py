"""Pairs with elastic teeth in motion: stiffness, lag, backlash, resonance, and what they refuse."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.quantities import ARCSEC
from gearcam.kinds.gear_pair.dynamics import motion_of
from gearcam.kinds.gear_pair.pair_motion import MovingPair
from gearcam.results.study import silent

ELASTIC = {"inertia_kg_m2": [0.02, 0.03], "stiffness_n_mm_um": 14}
LOAD = [{"on": "wheel2", "torque_nm": 40}]


def design(profile: str, **changes: Any) -> Any:
    given = {"load": LOAD, "drive.speed_rpm": 20, "output.studies": [], "dynamics": ELASTIC}
    return gc.load(f"profiles/{profile}.toml").with_({**given, **changes})


@cache
def slow(profile: str, backlash: float) -> Any:
    """Return the motion of a turn, at 20 rpm if the ratio changes."""
    own = {**ELASTIC, "turns": 1}
    rpm = 80 if profile == "circular" else 20
    changes = {"pair.backlash_mm": backlash, "dynamics": own, "drive.speed_rpm": rpm}
    return gc.build(design(profile, **changes)).study("dynamics")


def test_a_slow_pair_lags_by_its_load_over_its_stiffness():
    found = slow("ellipse", 0.0)
    lag, phi1 = found.columns["lag_rad"], np.radians(found.columns["phi1_deg"])
    # pairs of teeth in contact, each with its stiffness, at levers about the driven shaft
    from gearcam.meshing.contact import contacts

    touching = contacts(found.result.subject.sides[1], phi1)
    width = found.result.design.pair.face_width
    own = np.bincount(touching.step, 14e3 * width * touching.lever[1] ** 2, len(phi1)) / 1e3
    # where pairs come and go those about to touch carry too, and the samples are joined smoothly
    apart = np.abs(lag * own / 40.0 - 1.0)
    assert np.median(apart) < 5e-3
    assert found.facts["dynamics.energy_residue"] < 1e-4


def test_backlash_adds_its_half_to_the_lag():
    without, with_ = slow("circular", 0.0), slow("circular", 0.1)
    radius = with_.result.pair.module * with_.result.pair.teeth[1] / 2.0
    added = with_.columns["lag_rad"].mean() - without.columns["lag_rad"].mean()
    assert added == pytest.approx(0.05 / radius, rel=2e-2)


@pytest.mark.slow
def test_by_finite_elements_a_slow_pair_lags_as_in_the_study_of_stress():
    changes = {"dynamics": {"inertia_kg_m2": [0.02, 0.03], "finite_elements": True, "turns": 1}}
    result = gc.build(design("circular", **changes))
    lag = result.study("dynamics").facts["dynamics.lag_arcsec.max"]
    stress = result.study("stress").facts["stress.lag_arcsec.max"]
    assert lag == pytest.approx(stress, rel=0.02)
    assert "E 206000" in str(result.study("dynamics").facts["dynamics.material"])


@pytest.mark.slow
def test_stiff_teeth_move_as_rigid_ones():
    motor = {"type": "linear", "start_torque_nm": 3000, "idle_rpm": 120}
    own = {
        "dynamics.stiffness_n_mm_um": 1000,
        "dynamics.inertia_kg_m2": [0.5, 0.5],
        "dynamics.damping_ratio": 0.2,
        "motor": motor,
        "dynamics.turns": 1,
    }
    elastic = gc.build(design("ellipse", **own)).study("dynamics")
    rigid = gc.build(design("ellipse", **own, **{"dynamics.rigid": True})).study("dynamics")
    for key in ("speed_rpm.min", "speed_rpm.max", "turn_s"):
        assert elastic.facts[f"dynamics.{key}"] == pytest.approx(
            rigid.facts[f"dynamics.{key}"], rel=1e-3
        )
    assert "dynamics.lag_arcsec.max" not in rigid.facts


def test_an_even_motor_has_the_torque_that_keeps_the_mean_speed():
    motor = {"type": "constant", "flywheel_kg_m2": 50}
    changes = {"motor": motor, "dynamics.turns": 1, "drive.speed_rpm": 80}
    found = gc.build(design("ellipse", **changes)).study("dynamics")
    # wheels of equal teeth without friction: the torque of the load
    assert found.columns["torque_motor_nm"] == pytest.approx(40.0, rel=1e-6)
    works = found.facts["dynamics.works_j"]
    assert works["motor"] == pytest.approx(works["load"] + works["lost"], rel=1e-3)


@pytest.mark.parametrize("changes", [{}, {"dynamics.rigid": True, "dynamics.run": "turns"}])
def test_the_largest_force_is_found_between_the_rows(changes):
    changes = changes | {"dynamics.turns": 2, "dynamics.steps": 180, "drive.speed_rpm": 186}
    run = motion_of(gc.build(gc.load("profiles/rattling_pair.toml").with_(changes)), silent)
    fine = run.motion.ends[0] + np.radians(np.linspace(140.0, 200.0, 1501))
    pressure = MovingPair(run.result, run.mesh_torque).loaded(fine).pressure
    assert np.nanmax(run.loaded.pressure) >= 0.999 * np.nanmax(pressure)


def test_the_last_turn_is_stated_with_its_own_angles_and_time():
    columns = slow("circular", 0.1).columns
    assert columns["phi1_deg"][[0, -1]] == pytest.approx([0.0, 360.0], abs=1e-9)
    assert columns["t_s"][[0, -1]] == pytest.approx([0.0, 0.75], rel=1e-6)
    assert np.diff(columns["phi1_deg"]).min() > 0.0
    three = gc.build(design("circular", **{"drive.speed_rpm": 100})).study("dynamics").columns
    assert three["phi1_deg"][-1] == pytest.approx(360.0)
    assert three["t_s"][-1] == pytest.approx(0.6, rel=1e-6)


def test_teeth_that_part_hit_and_are_told():
    found = gc.build(gc.load("profiles/rattling_pair.toml")).study("dynamics")
    codes = {one.code: one for one in found.study_findings}
    assert codes["contact-lost"].value == pytest.approx(found.facts["dynamics.impact_rad_s"])
    contact = found.columns["contact"]
    assert {-1, 0, 1} == set(contact.tolist())
    # apart, within the backlash, nothing is carried
    assert np.abs(found.columns["torque_mesh_nm"][contact == 0]).max() < 1e-9
    assert {"lag", "spectrum", "impacts"} <= set(found.charts)
    assert found.facts["dynamics.error.lag_arcsec"] < 1e-2
    quiet = slow("circular", 0.1)
    assert "contact-lost" not in [one.code for one in quiet.study_findings]


def test_a_resonance_is_told_at_the_speed_that_makes_it_and_not_far_from_it():
    slowly = slow("circular", 0.0)
    low, high = (slowly.facts[f"dynamics.natural_frequency_hz.{end}"] for end in ("min", "max"))
    teeth = slowly.result.pair.teeth[0]

    def codes(hz: float) -> list[str]:
        changes = {"drive.speed_rpm": 60.0 * hz / teeth, "dynamics.turns": 1}
        made = gc.build(design("circular", **changes)).study("dynamics")
        return [one.code for one in made.study_findings]

    assert "resonance" in codes(low)
    assert "resonance" in codes(0.5 * high)
    assert "resonance" not in codes(0.2 * low)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"dynamics.finite_elements": True}, "beside finite_elements"),
        ({"dynamics.inertia_kg_m2": [0.1, 0.0]}, "no inertia"),
        (
            {
                "dynamics.run": "start",
                "motor": {"type": "linear", "start_torque_nm": 500, "idle_rpm": 90},
            },
            "begin at a speed",
        ),
        ({"dynamics.damping_ratio": 1.0}, "out of range"),
        ({"steps.count": 2}, "stepped"),
    ],
)
def test_what_elastic_teeth_cannot_do_is_refused(changes, words):
    with pytest.raises(DesignError, match=words):
        gc.build(design("circular").with_(changes)).study("dynamics")


def test_teeth_without_a_load_have_no_stiffness():
    with pytest.raises(InfeasibleError, match="carry nothing"):
        gc.build(design("circular", load=[])).study("dynamics")


def test_units_of_the_lag():
    found = slow("circular", 0.0)
    most = found.columns["lag_rad"].max() / ARCSEC.factor
    assert found.facts["dynamics.lag_arcsec.max"] == pytest.approx(most, rel=0.02)


def test_elastic_teeth_that_coast_stop_where_rigid_ones_do():
    own = {"dynamics.run": "coast", "drive.speed_rpm": 200}
    elastic = gc.build(design("ellipse", **own)).study("dynamics")
    rigid = gc.build(design("ellipse", **own, **{"dynamics.rigid": True})).study("dynamics")
    stop = rigid.facts["dynamics.stopped_deg"]
    assert elastic.facts["dynamics.stopped_deg"] % 360.0 == pytest.approx(stop % 360.0, abs=1.0)
    assert elastic.facts["dynamics.speed_rpm.last"] == 0.0


def test_a_pair_that_stops_in_an_early_turn_is_stated_up_to_there():
    own = {**ELASTIC, "run": "coast", "turns": 3}
    found = gc.build(design("circular", **{"dynamics": own, "drive.speed_rpm": 60})).study(
        "dynamics"
    )
    ratio = found.result.law.ratio(np.zeros(1))[0]
    energy = 0.5 * (0.02 + 0.03 * ratio**2) * (2.0 * np.pi) ** 2
    stopped = np.radians(found.facts["dynamics.stopped_deg"])
    assert 40.0 * ratio * stopped == pytest.approx(energy, rel=0.1)  # teeth give a little
    assert "stalls" in [one.code for one in found.study_findings]


def test_angles_and_loads_of_the_driven_wheel_are_those_of_its_own_motion():
    load = [{"on": "wheel2", "formula": "15*omega2"}]
    changes = {"load": load, "dynamics": {**ELASTIC, "turns": 1}, "drive.speed_rpm": 80}
    made = gc.build(design("circular", **changes))
    columns, ratio = made.study("dynamics").columns, made.law.ratio(np.zeros(1))[0]
    w1, w2 = columns["omega1_rad_s"], columns["omega2_rad_s"]
    assert abs(ratio - 1.0) > 0.1
    assert w2 == pytest.approx(ratio * w1, rel=2e-2)
    # at the driver; the teeth carry it
    assert columns["torque_load_nm"] == pytest.approx(15.0 * w2 * w2 / w1, rel=1e-9)
    assert columns["torque_mesh_nm"].mean() == pytest.approx(15.0 * w2.mean(), rel=1e-3)
    nominal = ratio * columns["phi1_deg"]
    assert nominal - columns["phi2_deg"] == pytest.approx(np.degrees(columns["lag_rad"]), abs=1e-9)


def test_a_flywheel_turns_with_the_driver_of_elastic_teeth():
    motor = {"type": "linear", "start_torque_nm": 500, "idle_rpm": 90}

    def natural(driver: float, flywheel: float) -> float:
        own = {**ELASTIC, "inertia_kg_m2": [driver, 3.0], "turns": 1}
        changes = {"dynamics": own, "motor": {**motor, "flywheel_kg_m2": flywheel}}
        run: Any = motion_of(gc.build(design("circular", **changes)), silent)
        return float(run.pair.frequency(0.0))

    assert natural(0.0, 2.0) == pytest.approx(natural(2.0, 0.0), rel=1e-6)
    assert natural(0.5, 0.0) > 1.01 * natural(2.0, 0.0)
    with pytest.raises(DesignError, match="above 0 for both shafts"):
        gc.build(design("circular", **{"dynamics.inertia_kg_m2": [0, 0.03], "motor": motor})).study(
            "dynamics"
        )


def test_the_frequency_of_the_teeth_is_their_number_times_the_speed():
    slowly = slow("circular", 0.0)
    low, teeth = slowly.facts["dynamics.natural_frequency_hz.min"], slowly.result.pair.teeth[0]
    changes = {"drive.speed_rpm": 0.95 * 60.0 * low / teeth, "dynamics.turns": 1}
    made = gc.build(design("circular", **changes)).study("dynamics")
    (told,) = (one for one in made.study_findings if one.code == "resonance")
    assert told.value == pytest.approx(0.95, abs=0.015)
    told_rpm = float(told.message.split("a mean speed of ")[1].split(" rpm")[0])
    assert told_rpm * told.value == pytest.approx(changes["drive.speed_rpm"], rel=1e-3)
