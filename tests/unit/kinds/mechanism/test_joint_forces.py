"""The study of forces in joints: its table, facts, findings, charts, and what it refuses."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.kinds.mechanism.forces import JointForces
from gearcam.linkages.reactions import Structure
from helpers_machines import MACHINES

LOAD = [{"on": "C", "force_n": [40, -90]}]
RUBBING = {"joint": 0.1, "journal_radius_mm": 6}


def built(machine: str = "four-bar", **changes: Any) -> Any:
    tables = {**MACHINES[machine], "load": LOAD, **changes}
    return gc.build(gc.design({"kind": "mechanism", "name": "mine", **tables}))


@cache
def study() -> Any:
    return built(friction=RUBBING).study("forces")


def test_rows_have_forces_and_the_driver_with_and_without_friction() -> None:
    table = study().columns
    for name in (one.removesuffix("_x_n") for one in table if one.endswith("_x_n")):
        size = np.hypot(table[f"{name}_x_n"], table[f"{name}_y_n"])
        assert table[f"{name}_n"] == pytest.approx(size)
    lost = table["driver_torque_nm"] - table["driver_torque_without_friction_nm"]
    assert table["lost_nm"] == pytest.approx(lost, abs=1e-12)
    assert (lost > 0.0).all()
    driven = table["driver_torque_without_friction_nm"] > 0.0
    both = table["driver_torque_without_friction_nm"] / table["driver_torque_nm"]
    assert table["efficiency"][driven] == pytest.approx(both[driven])


def test_facts_are_the_extremes_of_all_angles() -> None:
    facts, dense = study().facts, built(friction=RUBBING, forces={"steps": 5000}).study("forces")
    for name in facts["forces.joints"]:
        most = np.nanmax(dense.columns[f"{name}_n"])
        assert facts[f"forces.joints.{name}.largest_n"] == pytest.approx(most, rel=1e-9)
    assert facts["forces.torque_nm.max"] == pytest.approx(np.max(dense.columns["driver_torque_nm"]))
    assert facts["forces.error"] < 1e-10
    assert not facts["forces.locked"]


def test_the_work_without_friction_over_that_with_it_is_the_efficiency() -> None:
    machine = gc.load("profiles/quick_return.toml").with_({
        "load": [{"on": "ram", "force_n": 1500, "against": True}],
        "friction": {"joint": 0.1, "journal_radius_mm": 10, "guide": 0.1},
        "forces.steps": 4000,
    })  # fmt: skip
    made = gc.build(machine).study("forces")
    q = np.radians(made.columns["theta_deg"])
    works = [
        np.trapezoid(made.columns[name], q)
        for name in ("driver_torque_without_friction_nm", "driver_torque_nm")
    ]
    assert made.facts["forces.efficiency"] == pytest.approx(works[0] / works[1], rel=1e-5)


def test_without_friction_nothing_is_said_of_it() -> None:
    made = built().study("forces")
    assert "driver_torque_without_friction_nm" not in made.columns
    assert "forces.efficiency" not in made.facts
    assert "no friction" in made.facts["forces.assumptions"]
    torque = built().study("torque")
    assert made.facts["forces.torque_nm.max"] == pytest.approx(torque.facts["torque.torque_nm.max"])


def test_arrows_of_the_moving_picture_are_the_rows_of_the_table_at_the_joints() -> None:
    made = built(friction=RUBBING, forces={"steps": 24}, output={"studies": ["forces"]})
    scene, table = made.scene(24), made.study("forces").columns
    angles = next(iter(table.values()))
    rows = np.abs(angles - scene.places[:-1, None]).argmin(axis=1)
    assert angles[rows] == pytest.approx(scene.places[:-1], abs=1e-9)
    found = {one.name: one for one in scene.forces}
    assert set(found) == {name.removesuffix("_x_n") for name in table if name.endswith("_x_n")}
    for name, one in found.items():
        force = table[f"{name}_x_n"] + 1j * table[f"{name}_y_n"]
        assert one.force[:-1] == pytest.approx(force[rows], rel=1e-12)
        assert one.force[-1] == pytest.approx(one.force[0], rel=1e-9)
    crank = MACHINES["four-bar"]["crank"][0]["length_mm"]
    pin = crank * np.exp(1j * np.radians(scene.places))
    assert found["B"].point == pytest.approx(pin)
    assert built().scene(24).forces == ()


def test_charts_have_every_joint_and_hodographs() -> None:
    charts = study().charts
    hinges = [name for name in charts if name.startswith("hodograph_")]
    assert len(hinges) == 4
    assert len(charts["joints"].lines) == 4
    for name in hinges:  # of the same size in every frame
        sizes = [np.hypot(line.x, line.y) for line in charts[name].lines]
        for own in sizes[1:]:
            assert own == pytest.approx(sizes[0])
    assert {len(charts[name].lines) for name in hinges} == {2, 3}  # not on the frame again
    assert {*charts} >= {"joints", "torque_friction"}


def test_a_limit_of_forces_and_slides_that_tip_are_told() -> None:
    machine = gc.load("profiles/quick_return.toml").with_({
        "load": [{"on": "ram", "force_n": 1500, "against": True}],
        "friction": {"guide": 0.1, "guide_length_mm": 5},
        "mass": [{"of": "slider", "mass_kg": 20, "at_mm": [0, 60]}],
        "limits.joint_force_n": 1000,
    })  # fmt: skip
    found = gc.build(machine).study("forces").study_findings
    codes = [one.code for one in found]
    assert "edge-contact" in codes
    forces = [one for one in found if one.code == "joint-force"]
    assert forces
    assert all(one.value is not None and one.value > 1000.0 for one in forces)


def steep(guide: float, **drive: Any) -> Any:
    """A slider-crank whose rod stands steep on the guide."""
    return gc.build(gc.design({
        "kind": "mechanism", "name": "steep",
        "drive": [{"name": "motor", "even": True, **drive}],
        "guide": [{"name": "bed", "at_mm": [0, 20]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 100}],
        "dyad": [{"type": "RRT", "from": "B", "to": "bed", "joint": "C",
                  "members": ["rod", "slide"], "lengths_mm": [125, 0]}],
        "load": [{"on": "C", "force_n": 1000, "against": True}],
        "friction": {"guide": guide},
    })).study("forces")  # fmt: skip


def test_where_it_is_locked_there_are_no_forces() -> None:
    made = steep(0.4)
    (one,) = (one for one in made.study_findings if one.code == "self-locking")
    assert one.severity == "error"
    assert made.facts["forces.locked"]
    assert np.isnan(made.columns["driver_torque_nm"]).any()
    assert "forces.efficiency" not in made.facts
    share = float(one.message.split(" times")[0].split()[-1])
    assert not steep(0.4 * share).facts["forces.locked"]
    assert steep(0.4 * 1.01 * share).facts["forces.locked"]


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "nothing acts": ({"load": []}, "nothing acts on the mechanism"),
    "a bearing at a point": (
        {"bearing": [{"on": "P", "coefficient": 0.1, "radius_mm": 5}]}, "no members that meet",
    ),
    "no radius of a hinge": (
        {"bearing": [{"on": "C", "coefficient": 0.1}]}, "its radius_mm is missing",
    ),
    "twice": (
        {"bearing": [{"on": "C", "coefficient": 0.1, "radius_mm": 5}] * 2}, "has a bearing before",
    ),
    "a length of a hinge": (
        {"bearing": [{"on": "C", "coefficient": 0.1, "length_mm": 5}]}, "C is a hinge",
    ),
    "both": (
        {"bearing": [{"on": "C", "coefficient": 0.1, "length_mm": 5, "radius_mm": 5}]},
        "is given beside radius_mm",
    ),
    "no such name": ({"bearing": [{"on": "X", "coefficient": 0.1}]}, "nothing has this name"),
    "no radius": ({"friction": {"joint": 0.1}}, "journal_radius_mm"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_refused(name: str) -> None:
    changes, words = REFUSED[name]
    with pytest.raises(DesignError, match=words):
        built(**changes).study("forces")


@pytest.mark.parametrize("machine", MACHINES)
def test_every_machine_has_forces(machine: str) -> None:
    """Weights of all members, at an even speed or at rest: virtual work finds the same moment."""
    tables = MACHINES[machine]
    drives = [{**one} for one in tables["drive"]]
    drives[0]["speed_rpm"] = 60
    result = gc.build(gc.design({"kind": "mechanism", "name": "mine", **tables, "drive": drives}))
    members = dict.fromkeys(one.on for one in Structure.of(result.linkage).bonds)
    masses = [
        {"of": name, "mass_kg": 2, "at_mm": [7, 5], "inertia_kg_m2": 0.01} for name in members
    ]
    more = {**tables, "drive": drives, "mass": masses, "gravity": {"direction_deg": -90}}
    made = gc.build(gc.design({"kind": "mechanism", "name": "mine", **more})).study("forces")
    assert made.facts["forces.error"] < 1e-9
    assert all(np.isfinite(one).all() for one in made.columns.values())


def test_the_contact_force_of_a_cam_is_that_of_its_pressure_angle() -> None:
    load = [{"on": "table", "force_n": [300, -500]}]
    result = gc.build(gc.load("profiles/two_cam_table.toml").with_({"load": load}))
    made = result.study("forces")
    q = np.radians(made.columns["theta_deg"])
    for drive, force in zip(result.drives, (-300.0, 500.0), strict=True):
        turned = drive.own(q) % (2.0 * np.pi)
        angle = np.radians(drive.result.motion(turned)["pressure_angle_deg"])
        known = made.columns[f"{drive.spec.name}_contact_n"]
        assert known == pytest.approx(force / np.cos(angle), rel=1e-9)
    (note,) = (one for one in made.study_findings if one.code == "contact-reverses")
    assert note.where.startswith("cam_x, ")
    assert note.value == pytest.approx(-made.facts["forces.cams.cam_x.contact_n.min"])


@pytest.mark.parametrize(("studies", "told"), [([], 2), (["torque"], 1), (["forces"], 0)])
def test_friction_that_nothing_uses_is_told(studies: list[str], told: int) -> None:
    found = built(friction=RUBBING, output={"studies": studies}).checked
    assert [one.code for one in found].count("loads-unused") == told


def test_a_bearing_takes_what_it_lacks_from_the_others() -> None:
    own = [{"on": "C", "radius_mm": 12}, {"on": "D", "coefficient": 0.3}]
    made = JointForces(built(friction=RUBBING, bearing=own))
    found: dict[str, Any] = {bond.name: one for bond, one in made.friction.items()}
    assert (found["C"].coefficient, found["C"].radius) == (0.1, 12.0)
    assert (found["D"].coefficient, found["D"].radius) == (0.3, 6.0)


def test_where_all_is_locked_it_is_said_once() -> None:
    made = steep(1.0, range_deg=[262, 278])
    (one,) = (one for one in made.study_findings if one.code == "self-locking")
    assert one.where == "everywhere"
    assert made.facts["forces.torque_nm"] == "none"


def test_what_tips_everywhere_is_said_so() -> None:
    machine = gc.load("profiles/quick_return.toml").with_({
        "load": [{"on": "ram", "force_n": 1500}],
        "friction": {"guide": 0.1, "guide_length_mm": 5},
        "mass": [{"of": "slider", "mass_kg": 20, "at_mm": [90, 0]}],
        "gravity": {"direction_deg": -90},
    })  # fmt: skip
    found = gc.build(machine).study("forces").study_findings
    assert [one.where for one in found if one.code == "edge-contact"] == ["bed, everywhere"]


def test_guides_that_carry_nothing_have_no_friction_and_do_not_tip() -> None:
    """A slide that a drive pushes is loaded along its way."""
    push = gc.build(gc.design({
        "kind": "mechanism", "name": "push",
        "drive": [{"name": "motor", "even": True}, {"name": "ram", "slide": "20*sin(q)"}],
        "slide": [{"name": "tool", "on": "ram", "joint": "T"}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 40}],
        "load": [{"on": "tool", "force_n": 100}],
        "friction": {"guide": 0.2, "guide_length_mm": 40},
    })).study("forces")  # fmt: skip
    assert not push.study_findings
    assert np.abs(push.columns["lost_nm"]).max() == 0.0


def test_a_crank_on_a_member_is_held_by_the_frame() -> None:
    """Its angle is that in the machine: the moment by reactions is that by virtual work."""
    arms = gc.build(gc.design({
        "kind": "mechanism", "name": "arms",
        "drive": [{"name": "m", "even": True}, {"name": "n", "even": True, "ratio": 2}],
        "crank": [{"name": "carrier", "on": "m", "joint": "B", "length_mm": 40},
                  {"name": "arm", "on": "n", "at": "B", "joint": "P", "length_mm": 20}],
        "load": [{"on": "P", "force_n": [10, 0]}],
    })).study("forces")  # fmt: skip
    assert arms.facts["forces.error"] < 1e-12
    q = np.radians(arms.columns["theta_deg"])
    known = 1e-3 * 10.0 * (40.0 * np.sin(q) + 2.0 * 20.0 * np.sin(2.0 * q))
    assert arms.columns["driver_torque_nm"] == pytest.approx(known, abs=1e-9)


def test_a_load_on_a_yoke_presses_its_pin() -> None:
    """It is on what slides in the guide, not on the block."""
    yoke = gc.build(gc.design({
        "kind": "mechanism", "name": "yoke",
        "drive": [{"name": "motor", "even": True}],
        "guide": [{"name": "way"}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 40}],
        "dyad": [{"type": "RTT", "from": "B", "to": "way", "joint": "S",
                  "members": ["block", "yoke"], "gammas_deg": [0, 90], "beta_deg": 90}],
        "load": [{"on": "S", "force_n": -100}],
    })).study("forces")  # fmt: skip
    assert yoke.facts["forces.joints.S.largest_n"] == pytest.approx(100.0)
    assert yoke.facts["forces.error"] < 1e-12


def test_change_points_are_refused() -> None:
    folding = {"joint": [{"name": "D", "at_mm": [100, 0]}], "change": "motion"}
    dyad = [{"type": "RRR", "from": "B", "to": "D", "joint": "C", "members": ["coupler", "rocker"],
             "lengths_mm": [100, 40], "change": "motion", "near_mm": [140, 0]}]  # fmt: skip
    crank = [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 40}]
    tables = {"drive": [{"name": "motor", "even": True}], "joint": folding["joint"], "dyad": dyad,
              "crank": crank, "load": [{"on": "rocker", "torque_nm": -5}]}  # fmt: skip
    made = gc.build(gc.design({"kind": "mechanism", "name": "para", **tables}))
    for name in ("forces", "precision"):
        with pytest.raises(InfeasibleError, match="not determined at a change point of C, at 0"):
            made.study(name)


def test_a_drive_with_too_little_torque_is_told_with_friction() -> None:
    limits = {"drive_torque_nm": 1e-3}
    made = built(friction=RUBBING, limits=limits).study("forces")
    (one,) = (one for one in made.study_findings if one.code == "drive-torque")
    assert one.value == pytest.approx(np.abs(made.columns["driver_torque_nm"]).max())


def test_a_pair_takes_the_moment_of_its_machine_with_friction(tmp_path: Any) -> None:
    machine = gc.load("profiles/nail_machine_slide.toml").with_({
        "friction": {"guide": 0.1, "joint": 0.05, "journal_radius_mm": 30},
    })  # fmt: skip
    made = gc.build(machine).study("forces")
    (tmp_path / "forces.csv").write_bytes(made.files["forces.csv"])
    pair = gc.load("profiles/nail_machine_two_phase.toml").with_(
        {"load": [{"on": "wheel2", "file": str(tmp_path / "forces.csv")}]}
    )
    loaded = gc.build(pair).study("forces")
    own = np.max(made.columns["wheel2_torque_nm"])
    assert loaded.facts["forces.load_nm.max"] == pytest.approx(own, rel=1e-3)
    assert own > np.max(gc.build(machine).study("torque").columns["wheel2_torque_nm"])


@pytest.mark.parametrize(("cam", "said"), [("valve_train", True), ("tappet", False), ("", False)])
def test_what_acts_in_the_own_design_of_a_cam_is_left_out(cam: str, said: bool) -> None:
    own = gc.load(f"profiles/{cam}.toml").to_dict() if cam else MACHINES["table on two cams"]
    drive = {"name": "cam", "cam": own if cam else own["drive"][0]["cam"]}
    out = {"name": "out", "on": "cam.follower", "joint": "P"}
    made = gc.build(gc.design({
        "kind": "mechanism", "name": "m", "drive": [drive], "slide": [out],
        "load": [{"on": "out", "force_n": -100}], "friction": {"guide": 0.1},
    })).study("forces").facts["forces.assumptions"]  # fmt: skip
    assert ("no loads, springs and masses of the cams' own designs" in made) == said
    assert "no friction of cams" in made


def test_teeth_are_without_friction() -> None:
    tables = {**MACHINES["slide behind a pair"], "load": [{"on": "C", "force_n": [-100, 0]}]}
    words = [
        gc.build(gc.design({"kind": "mechanism", "name": "m", **tables, **friction}))
        .study("forces")
        .facts["forces.assumptions"]
        for friction in ({}, {"friction": {"guide": 0.1, "joint": 0.1, "journal_radius_mm": 5}})
    ]
    assert words == [
        "no friction, at rest, without inertia, no masses, no gravity",
        "at rest, without inertia, no masses, no gravity, no friction of teeth",
    ]


@pytest.mark.parametrize("friction", [{}, {"friction": {"guide": 0.1}}])
def test_a_contact_that_has_no_force_is_not_taken_for_a_lock(friction: Any) -> None:
    """A cam that presses across its lift would have to press without end."""
    tables = {**MACHINES["table on two cams"], "load": [{"on": "T", "force_n": [-90, -50]}]}
    made = JointForces(
        gc.build(gc.design({"kind": "mechanism", "name": "m", **tables, **friction}))
    )
    (first, *others), q = made.pressing, np.array([0.4, 0.5])

    def endless(places: Any) -> Any:
        return tuple(one._replace(force=one.force / (places != 0.4)) for one in first.lines(places))

    made.pressing = (replace(first, lines=endless), *others)
    with np.errstate(divide="ignore", invalid="ignore"):
        found = made.at(q)
    assert not found.locked.any()
    assert np.isfinite(found.values).all(axis=1).tolist() == [False, True]
