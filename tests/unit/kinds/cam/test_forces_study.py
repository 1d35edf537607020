"""The study of forces: its columns, facts, findings and what it refuses."""

from __future__ import annotations

import csv
import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.cli import main

LOAD = {"load": [{"force_n": 100}]}
SPEED = {"drive": {"speed_rpm": 600}}
MASS = {"mass": [{"mass_kg": 0.4}]}


def study(name: str = "eccentric_cam", /, **changes: Any) -> Any:
    return gc.build(gc.load(f"profiles/{name}.toml").with_(changes)).study("forces")


def codes(found: Any) -> list[str]:
    return [one.code for one in found.study_findings]


def test_contact_pressure_of_a_circle_by_hertz() -> None:
    """An eccentric disc below a flat face has one radius everywhere."""
    found = study(**LOAD, material={"name": ["steel"]})
    design = found.result.design
    modulus = 206000.0 / (2 * (1 - 0.3**2))
    outline = found.result.cam.outline
    radius = 0.5 * float(np.ptp(outline[:, 0]))
    end = design.follower.radius
    bent = 1.0 / radius + (1.0 / end if end else 0.0)
    expected = math.sqrt(100.0 / design.cam.thickness * modulus * bent / math.pi)
    if not design.follower.roller_radius:
        assert found.columns["pressure_mpa"] == pytest.approx(expected, rel=1e-4)
    assert found.facts["forces.pressure_mpa"] >= 0.99 * expected


def test_the_command_writes_what_python_has(tmp_path: Path) -> None:
    assert main(["forces", "profiles/valve_train.toml", "-o", str(tmp_path)]) == 0
    folder = tmp_path / "valve_train"
    with (folder / "forces.csv").open() as file:
        rows = list(csv.DictReader(file))
    columns = study("valve_train").columns
    assert list(rows[0]) == list(columns)
    assert float(rows[40]["normal_n"]) == pytest.approx(columns["normal_n"][40], rel=1e-14)
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["forces"]["spring"]["preload_n"] > 0.0
    assert summary["forces"]["efficiency"]["overall"] < 1.0


def test_power_and_losses_need_a_speed() -> None:
    assert "power_w" not in study(**LOAD).columns
    columns = study(**LOAD, **SPEED).columns
    omega = 600 * math.pi / 30
    assert columns["power_w"] == pytest.approx(omega * columns["torque_nm"], nan_ok=True)


def test_charts_along_driver_and_profile() -> None:
    found = study(**LOAD)
    assert {"normal", "torque", "pressure", "profile_pressure"} <= set(found.charts)
    arc = found.charts["profile_pressure"].lines[0].x
    assert arc[-1] == pytest.approx(found.result.cam.size.perimeter, rel=1e-3)


def test_self_locking_is_an_error() -> None:
    free = {"guide": 0.1, "guide_length_mm": 60, "guide_at_mm": 100}
    assert "self-locking" not in codes(study("plate_cam_offset_roller", **LOAD, friction=free))
    found = study("plate_cam_offset_roller", **LOAD, friction=free | {"guide_length_mm": 2})
    assert codes(found) == ["self-locking"]
    (finding,) = found.study_findings
    assert finding.severity == "error"
    assert "theta" in finding.where
    assert found.facts["forces.locked"]


def test_a_follower_that_lifts_off_is_told_with_the_speed_that_holds() -> None:
    spring = {"spring": [{"stiffness_n_mm": 2, "preload_n": 20}]}
    slow = study(**MASS, **spring, **SPEED)
    release = slow.facts["forces.release_speed_rpm"]
    for factor, expected in ((0.999, []), (1.001, ["lift-off"])):
        speed = {"drive": {"speed_rpm": factor * release}}
        assert codes(study(**MASS, **spring, **speed)) == expected


def test_a_follower_that_lifts_off_is_told_with_the_preload_that_holds() -> None:
    spring = {"stiffness_n_mm": 2, "preload_n": 20}
    slow = study(**MASS, **SPEED, spring=[spring])
    fast = {"drive": {"speed_rpm": 1.4 * slow.facts["forces.release_speed_rpm"]}}
    found = study(**MASS, **fast, spring=[spring])
    (finding,) = found.study_findings
    least = float(
        re.findall(r"With spring\[0\].preload_n = ([0-9.]+) it stays", finding.message)[0]
    )
    assert found.facts["forces.normal_n"]["min"] == 0.0
    for preload, expected in ((least, []), (0.998 * least, ["lift-off"])):
        held = [spring | {"preload_n": preload}]
        assert codes(study(**MASS, **fast, spring=held)) == expected
    solved = [spring | {"preload_n": "solve"}]
    closed = study(**MASS, **fast, spring=solved)
    assert least == pytest.approx(closed.facts["forces.spring.preload_n"], rel=1e-2)


@pytest.mark.parametrize("law", ["modified-trapezoid", "3-4-5"])
def test_the_least_preload_leaves_no_force_somewhere(law: str) -> None:
    """And the largest force is that of the closed form, of a roller without friction."""
    motion = [
        {"type": "rise", "angle_deg": 61.3, "lift_mm": 9, "law": law},
        {"type": "return", "angle_deg": 58.9, "law": law},
        {"type": "dwell", "angle_deg": "rest"},
    ]
    spring = [{"stiffness_n_mm": 12, "preload_n": "solve"}]
    fast = {"drive": {"speed_rpm": 1800}}
    found = study(motion=motion, cam={"prime_radius_mm": 36}, **MASS, spring=spring, **fast,
                  follower={"type": "roller", "roller_radius_mm": 8})  # fmt: skip
    theta = np.linspace(0.0, 2.0 * math.pi, 400_001)
    s, ds, d2s = found.result.program.derivatives(theta, 2)
    load = 12.0 * s + 0.4e-3 * (1800 * math.pi / 30) ** 2 * d2s
    load -= load.min()
    force = load * np.hypot(1.0, ds / (36.0 + s))
    facts = found.facts
    assert facts["forces.normal_n.max"] == pytest.approx(force.max(), rel=1e-6)
    assert facts["forces.normal_n.min"] == pytest.approx(0.0, abs=1e-6 * force.max())
    torque = 1e-3 * load * ds
    for end, value in (("min", torque.min()), ("max", torque.max())):
        assert facts[f"forces.torque_nm.{end}"] == pytest.approx(value, rel=1e-6)


def test_what_cannot_be_mixed_is_told() -> None:
    with pytest.raises(DesignError, match="s and theta cannot be mixed"):
        study(load=[{"formula": "50 + 4*s + 30*sin(theta)"}])


def test_a_missing_length_of_a_guide_is_one_fault() -> None:
    with pytest.raises(DesignError) as caught:
        study(**LOAD, friction={"guide": 0.1})
    (problem,) = caught.value.problems
    assert problem.key == "friction.guide_length_mm"


def test_limits_of_pressure_and_torque() -> None:
    found = study(**LOAD)
    pressure, torque = found.facts["forces.pressure_mpa"], found.facts["forces.torque_nm.max"]
    own = ("limits.contact_pressure_mpa", "limits.drive_torque_nm")
    for factor, expected in ((1.001, []), (0.999, ["contact-pressure", "drive-torque"])):
        limits = dict(zip(own, (factor * pressure, factor * torque), strict=True))
        assert sorted(codes(study(**LOAD, **limits))) == expected
    # without a limit of its own the pressure is held against that at which it yields
    for factor, expected in ((1.001, []), (0.999, ["contact-pressure"])):
        weak = {"material.yield_mpa": factor * pressure / 1.7936}
        assert codes(study(**LOAD, **weak)) == expected


def test_a_load_between_two_angles_and_against_the_motion() -> None:
    load = {"force_n": 50, "from_deg": 300, "to_deg": 40}
    columns = study(load=[load]).columns
    theta = columns["theta_deg"]
    inside = (theta >= 300) | (theta <= 40)
    ends = np.min(np.abs(theta - np.array([[300.0], [40.0]])), axis=0) < 1e-9
    assert (columns["load_n"] == np.where(inside, 50.0, 0.0))[~ends].all()
    for end in (300.0, 40.0):  # both sides of a jump are rows
        assert set(columns["load_n"][np.abs(theta - end) < 1e-9]) == {0.0, 50.0}
    columns = study(load=[{"force_n": 50, "against": True}]).columns
    assert set(columns["load_n"].round(9)) == {-50.0, 0.0, 50.0} or set(
        columns["load_n"].round(9)
    ) == {-50.0, 50.0}


def test_a_table_is_joined_by_straight_lines() -> None:
    columns = study(load=[{"table": [10, 40, 10], "at_deg": [0, 90, 360]}]).columns
    expected = np.interp(columns["theta_deg"], [0, 90, 360], [10, 40, 10])
    assert columns["load_n"] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"load": [{"torque_nm": 3}]}, "force_n along its axis"),
        ({"load": [{"force_n": 3, "formula": "s"}]}, "load"),
        ({"load": [{"table": [1, 2], "at_deg": [0, 270]}]}, "360 deg as the last"),
        ({"load": [{"table": [1, 2, 3], "at_deg": [0, 360]}]}, "one for each value"),
        ({"load": [{"table": [1, 2, 3], "at_deg": [0, 90, 60]}]}, "rising values"),
        ({"load": [{"formula": "3*y"}]}, "unknown name 'y'\n    allowed: theta or the lift s, pi"),
        (
            {"load": [{"formula": "3*s + u"}]},
            "name 'u' (did you mean s?)\n    allowed: theta or the lift s",
        ),
        ({"load": [{"formula": "3*s +"}]}, "the formula ends too early"),
        ({"spring": [{"stiffness_n_mm": -1}]}, "0 to"),
        ({"spring": [{"on": "follower"}]}, "a stiffness, a preload, or both"),
        ({"spring": [{"stiffness_nm_rad": 1}]}, "preload_n and damping_n_s_mm"),
        ({"spring": [{"stiffness_n_mm": "solve", "preload_n": "solve"}]}, "one of them"),
        ({"spring": [{"preload_n": "solve"}, {"preload_n": "solve"}]}, "all springs but one"),
        ({"mass": [{"of": "follower"}]}, "mass_kg"),
        ({"mass": [{"mass_kg": 1, "inertia_kg_m2": 1}]}, "mass_kg alone"),
        ({"friction": {"guide": 0.1}}, "guide_length_mm"),
        ({"friction": {"joint": 0.1}}, "journal_radius_mm"),
    ],
)
def test_mistakes_are_told_with_what_works(changes: dict[str, Any], told: str) -> None:
    with pytest.raises(DesignError) as caught:
        gc.load("profiles/eccentric_cam.toml").with_(changes)
    assert told in str(caught.value)


def test_inertia_needs_a_speed() -> None:
    with pytest.raises(DesignError, match=r"drive\.speed_rpm: is missing"):
        study(**MASS)
    with pytest.raises(DesignError, match="a spring is solved for a speed"):
        study(**MASS, spring=[{"preload_n": "solve"}])
    assert study(**MASS, gravity={"direction_deg": -90}).columns["load_n"] == pytest.approx(
        0.4 * 9.80665
    )


def test_no_stiffness_helps_at_zero_lift() -> None:
    spring = [{"stiffness_n_mm": "solve", "preload_n": 5}]
    with pytest.raises(InfeasibleError, match="only a preload does") as caught:
        study(load=[{"force_n": -30}], spring=spring)
    assert "30 N" in str(caught.value)
    spring[0]["preload_n"] = 30.001
    assert study(load=[{"force_n": -30}], spring=spring).facts["forces.spring.stiffness_n_mm"] == 0
