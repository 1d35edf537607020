"""The study of torque: printed machines, identities, columns, facts, and what it refuses."""

from __future__ import annotations

import csv
import json
import re
from functools import cache
from math import pi, radians
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from helpers_linkages import agree, column, rows
from helpers_machines import LEVER, MACHINES, PAIR, TAPPET
from helpers_sampling import few

MASSES = [
    {"of": "crank", "mass_kg": 60, "at_mm": [50, 0], "inertia_kg_m2": 0.55},
    {"of": "rod", "mass_kg": 45, "at_mm": [260, 0], "inertia_kg_m2": 2.8},
    {"of": "ram", "mass_kg": 180},
]
FORGING = {"on": "slide", "force_n": -35435, "travel_mm": 4, "before": "outer"}
DOWN = {"direction_deg": -90}


def study(name: str, /, **changes: Any) -> Any:
    return gc.build(gc.load(f"profiles/{name}.toml").with_(changes)).study("torque")


def four_bar(**changes: Any) -> Any:
    """A four-bar with a slide that its rocker pushes."""
    tables = MACHINES["four-bar"]
    slide = {
        "type": "RRT", "from": "C", "to": "bed", "joint": "S", "members": ["link", "ram"],
        "lengths_mm": [200, 0],
    }  # fmt: skip
    changes = {
        "drive": [{"name": "motor", "even": True, "speed_rpm": 90}],
        "guide": [{"name": "bed", "at_mm": [40, -30]}],
        "dyad": [*tables["dyad"], slide],
        "output": {"files": ["csv"]},
        **changes,
    }
    return gc.build(gc.design({"kind": "mechanism", "name": "mine", **tables, **changes}))


def torque(**changes: Any) -> Any:
    return four_bar(**changes).study("torque")


def moved(name: str, found: Any) -> tuple[Any, Any]:
    """An output of a result and its derivative, where the study is."""
    q = np.radians(found.columns["theta_deg"])
    place, slope = found.result.linkage.real_track(name, q, 1).derivatives()
    return place, slope


def codes(found: Any) -> list[str]:
    return [one.code for one in found.study_findings]


class TestNailMachine:
    def test_forging_over_the_last_bit_of_travel(self) -> None:
        found = study("nail_machine_slide", load=[FORGING], compare=[])
        agree(found.facts["torque.work_j"], 141.74, relative=1e-9)
        agree(found.facts["torque.mean_power_w"], 141.74 * 3.0, relative=1e-9)
        acts = found.columns["phi1_deg"][found.columns["torque_nm"] != 0.0]
        # both sides of its ends are in the table; at a dead centre nothing is left to do
        agree(acts[0], 179.27916844)
        assert acts[-1] == pytest.approx(204.644514019, abs=0.01)

    def test_masses(self) -> None:
        load = {"on": "slide", "force_n": -35435, "from_deg": 150, "to_deg": 170}
        found = study("nail_machine_slide", load=[load], mass=MASSES, gravity=DOWN, compare=[])
        table = rows("nail_masses")
        at = np.searchsorted(found.columns["phi1_deg"], column(table, "phi1_deg") - 1e-9)
        agree(found.columns["torque_nm"][at], column(table, "wheel1_nm"), relative=1e-10)
        agree(found.columns["wheel2_torque_nm"][at], column(table, "wheel2_nm"), relative=1e-10)
        assert found.facts["torque.error"] < 1e-12
        assert "gravity" in found.facts["torque.assumptions"]
        assert "crank, rod, ram" in found.facts["torque.assumptions"]

    def test_other_drives_stand_beside_it(self) -> None:
        found = study("nail_machine_slide", load=[FORGING], mass=MASSES, gravity=DOWN)
        assert codes(found) == ["drive-torque", "drive-torque"]
        peak = max(np.abs(found.columns["torque_nm"]))
        others = [
            found.facts[f"torque.compared.{one}.torque_nm.max"] for one in found.result.compared
        ]
        assert all(other < peak for other in others)
        assert "2.2 times" in found.study_findings[1].message
        assert len(found.charts["torque"].lines) == 3

    def test_a_pair_is_compared_with_an_even_shaft_unasked(self) -> None:
        found = study("nail_machine_slide", mass=MASSES, compare=[])
        assert codes(found) == ["drive-torque"]
        assert "even_shaft" in found.study_findings[0].message
        assert (found.study_findings[0].severity, found.study_findings[0].limit) == ("note", None)

    def test_no_note_where_the_pair_needs_less(self) -> None:
        """The forging force alone: the pair slows the slide there."""
        assert codes(study("nail_machine_slide", load=[FORGING])) == []


class TestFurnaceDoor:
    def door(self, **changes: Any) -> Any:
        mass = {"of": "door", "mass_kg": 1000, "at_mm": [867.650131097465, 0]}
        return study("furnace_door_hinged", mass=[mass], gravity=DOWN, **changes)

    def test_the_pair_costs_moment(self) -> None:
        found = self.door()
        assert codes(found) == ["drive-torque"]
        assert re.search("2 times the 78[67]", found.study_findings[0].message)
        assert "ratio 2" in found.study_findings[0].message
        ends = [line.x[-1] for line in found.charts["torque"].lines]
        assert ends == pytest.approx([171.65, 308.3])


class TestLoads:
    """Each is the sum of force times derivative, here with the table's own forces."""

    def test_force_on_a_slide(self) -> None:
        found = torque(load=[{"on": "S", "force_n": -80}])
        agree(found.columns["torque_nm"], 0.08 * moved("S.guide2", found)[1])

    def test_force_on_a_point(self) -> None:
        found = torque(load=[{"on": "P", "force_n": [30, -200]}])
        slope = moved("P", found)[1]
        agree(found.columns["torque_nm"], -1e-3 * (30.0 * slope.real - 200.0 * slope.imag))

    def test_force_in_a_direction(self) -> None:
        angled = torque(load=[{"on": "P", "force_n": 50, "direction_deg": 30}])
        both = [50.0 * np.cos(radians(30.0)), 25.0]
        vector = torque(load=[{"on": "P", "force_n": both}])
        agree(angled.columns["torque_nm"], vector.columns["torque_nm"])

    def test_torque_on_a_member_and_a_shaft(self) -> None:
        found = torque(load=[{"on": "rocker", "torque_nm": -5}])
        agree(found.columns["torque_nm"], 5.0 * moved("rocker.angle", found)[1])
        shaft = torque(load=[{"on": "motor", "torque_nm": -5}])
        agree(shaft.columns["torque_nm"], 5.0 * np.ones(len(shaft.columns["torque_nm"])))

    def test_formulas(self) -> None:
        found = torque(load=[{"on": "S", "formula": "2*x - 5"}])
        place, slope = moved("S.guide2", found)
        agree(found.columns["torque_nm"], -1e-3 * (2.0 * place - 5.0) * slope)
        found = torque(load=[{"on": "S", "formula": "-3*v"}])
        speed = 90.0 * pi / 30.0
        agree(found.columns["torque_nm"], 3e-3 * speed * moved("S.guide2", found)[1] ** 2)
        found = torque(load=[{"on": "rocker", "formula": "sin(q)"}])
        slope = moved("rocker.angle", found)[1]
        agree(found.columns["torque_nm"], -np.sin(np.radians(found.columns["theta_deg"])) * slope)

    def test_rows_over_the_turn(self) -> None:
        table = {"table": [0, -90, 30, 0], "at_deg": [0, 100, 100, 360]}
        found = torque(load=[{"on": "S", **table}])
        theta = found.columns["theta_deg"]
        force = np.where(theta < 100.0, -0.9 * theta, 30.0 * (360.0 - theta) / 260.0)
        agree(
            found.columns["torque_nm"], -1e-3 * force * moved("S.guide2", found)[1], relative=1e-9
        )

    def test_rows_over_the_way(self) -> None:
        found = torque(load=[{"on": "S", "table": [100, -40, -40], "at_mm": [200, 240, 250]}])
        place, slope = moved("S.guide2", found)
        assert place.min() < 200.0 < 240.0 < place.max()
        force = np.interp(place, [200.0, 240.0], [100.0, -40.0])
        agree(found.columns["torque_nm"], -1e-3 * force * slope)

    def test_rows_have_both_sides_of_jumps_and_bends(self) -> None:
        table = {"table": [0, -90, 30, 0], "at_deg": [0, 100.3, 100.3, 360]}
        found = torque(load=[{"on": "S", **table}])
        jump = np.flatnonzero(np.abs(found.columns["theta_deg"] - 100.3) < 1e-9)
        sides = found.columns["torque_nm"][jump] / moved("S.guide2", found)[1][jump]
        agree(sides, np.array([0.09, -0.03]), relative=1e-9)
        bent = torque(load=[{"on": "S", "table": [0, 40, 0], "at_mm": [200, 220, 240]}])
        place, _ = moved("S.guide2", bent)
        for wanted in (200.0, 220.0, 240.0):
            assert np.count_nonzero(np.abs(place - wanted) < 1e-9) >= 2

    def test_rows_that_begin_before_the_zero(self) -> None:
        found = torque(load=[{"on": "S", "table": [40, 0, 40], "at_deg": [-90, 0, 270]}])
        theta = found.columns["theta_deg"]
        force = np.where(theta < 270.0, 40.0 * theta / 270.0, 40.0 * (360.0 - theta) / 90.0)
        slope = moved("S.guide2", found)[1]
        agree(found.columns["torque_nm"], -1e-3 * force * slope, relative=1e-9)

    def test_up_to_the_end_of_the_turn(self) -> None:
        found = torque(load=[{"on": "S", "force_n": 80, "from_deg": 300, "to_deg": 360}])
        first, last = found.columns["torque_nm"][[0, -1]]
        assert first == 0.0
        assert last == pytest.approx(-0.08 * moved("S.guide2", found)[1][0])

    def test_a_slide_that_begins_its_dyad(self) -> None:
        """The guide comes first: TRR."""
        slide = {
            "type": "TRR", "from": "bed", "to": "C", "joint": "S", "members": ["ram", "link"],
            "lengths_mm": [0, 200],
        }  # fmt: skip
        dyads = [*MACHINES["four-bar"]["dyad"], slide]
        found = torque(load=[{"on": "S", "force_n": -80}], dyad=dyads)
        agree(found.columns["torque_nm"], 0.08 * moved("S.guide1", found)[1])

    def test_against_the_motion(self) -> None:
        found = torque(load=[{"on": "S", "force_n": 80, "against": True}])
        place, slope = moved("S.guide2", found)
        agree(found.columns["torque_nm"], 0.08 * np.abs(slope))
        work = found.facts["torque.work_j"]
        assert work == pytest.approx(2.0 * 0.08 * np.ptp(place), rel=1e-6)

    def test_a_range_over_the_end_of_the_turn(self) -> None:
        found = torque(load=[{"on": "S", "force_n": 80, "from_deg": 300, "to_deg": 400}])
        theta = found.columns["theta_deg"]
        acts = (theta >= 300.0) | (theta < 40.0)
        inside = np.abs(theta - 40.0) > 1e-9
        wanted = np.where(acts, -0.08 * moved("S.guide2", found)[1], 0.0)
        agree(found.columns["torque_nm"][inside], wanted[inside])

    @pytest.mark.parametrize(
        "load",
        few(
            [
                {"force_n": 80, "from_deg": 300, "to_deg": 400},
                {"force_n": 80, "from_deg": 30, "to_deg": 70},
                {"force_n": 80, "from_deg": -20, "to_deg": 70},
                {"force_n": 80, "from_deg": 400, "to_deg": 500},
                {"table": [40, 0, 40], "at_deg": [-90, 0, 270]},
                {"table": [0, -90, 30, 0], "at_deg": [0, 100, 100, 360]},
                {"force_n": 80, "travel_mm": 10, "before": "inner"},
            ],
            3,
        ),
    )
    def test_each_turn_of_a_cycle_has_its_load(self, load: dict[str, Any]) -> None:
        """A slide of no weight, which is back after two turns, changes nothing."""
        motor = {"name": "motor", "even": True, "speed_rpm": 90}
        slow = {"name": "slow", "slide": "20*sin(q/2)"}
        once = torque(load=[{"on": "S", **load}])
        twice = torque(load=[{"on": "S", **load}], drive=[motor, slow])
        assert twice.result.linkage.span[1] == pytest.approx(4.0 * pi)
        work = once.facts["torque.work_j"]
        assert twice.facts["torque.work_j"] == pytest.approx(2.0 * work, rel=1e-9, abs=1e-12)
        theta = np.arange(0.25, 360.0, 0.5)
        single, both = (
            np.interp(at, one.columns["theta_deg"], one.columns["torque_nm"])
            for one, at in ((once, theta), (twice, np.concatenate([theta, theta + 360.0])))
        )
        np.testing.assert_allclose(both.reshape(2, -1), [single, single], atol=2e-2)

    def test_before_the_inner_dead_center(self) -> None:
        load = {"on": "S", "force_n": 80, "travel_mm": 10, "before": "inner"}
        found = torque(load=[load])
        acts = found.columns["torque_nm"] != 0.0
        place, slope = moved("S.guide2", found)
        low, high = place.min(), place[acts].max()
        assert (slope[acts] < 0.0).all()
        assert high - low == pytest.approx(10.0, abs=1e-6)
        assert found.facts["torque.work_j"] == pytest.approx(0.8, rel=1e-9)


class TestSprings:
    def test_between_joints(self) -> None:
        spring = {"between": ["P", "D"], "stiffness_n_mm": 3, "preload_n": 20, "free_length_mm": 50}
        found = torque(spring=[spring])
        place, slope = moved("P", found)
        way = place - 110.0
        pull = 20.0 + 3.0 * (np.abs(way) - 50.0)
        agree(found.columns["torque_nm"], 1e-3 * pull * np.real(way.conj() * slope) / np.abs(way))
        assert found.facts["torque.error"] < 1e-12

    def test_on_a_slide_from_the_zero(self) -> None:
        found = torque(spring=[{"on": "S", "stiffness_n_mm": 2, "preload_n": 7}])
        place, slope = moved("S.guide2", found)
        agree(found.columns["torque_nm"], 1e-3 * (7.0 + 2.0 * (place - place[0])) * slope)

    def test_between_members(self) -> None:
        spring = {"between": ["coupler", "rocker"], "stiffness_nm_rad": 0.5, "preload_nm": 2}
        found = torque(spring=[spring])
        (first, rate), (second, slope) = moved("coupler.angle", found), moved("rocker.angle", found)
        angle = second - first
        agree(found.columns["torque_nm"], (2.0 + 0.5 * (angle - angle[0])) * (slope - rate), 1.0)

    def test_dampers(self) -> None:
        found = torque(spring=[{"on": "S", "damping_n_s_mm": 0.02}])
        speed = 90.0 * pi / 30.0
        agree(found.columns["torque_nm"], 2e-5 * speed * moved("S.guide2", found)[1] ** 2)
        assert "torque.error" not in found.facts
        swing = torque(spring=[{"between": ["ground", "rocker"], "damping_nm_s_rad": 0.3}])
        agree(swing.columns["torque_nm"], 0.3 * speed * moved("rocker.angle", swing)[1] ** 2)


class TestMasses:
    def test_gravity_on_a_point_of_a_member(self) -> None:
        mass = {"of": "coupler", "mass_kg": 3, "center": "P"}
        found = torque(mass=[mass], gravity=DOWN, drive=[{"name": "motor", "even": True}])
        agree(found.columns["torque_nm"], 3e-3 * 9.80665 * moved("P", found)[1].imag)
        assert "at rest" in found.facts["torque.assumptions"]
        mass = {"of": "coupler", "mass_kg": 3, "at_mm": [50, 35]}
        same = torque(mass=[mass], gravity=DOWN, drive=[{"name": "motor", "even": True}])
        agree(same.columns["torque_nm"], found.columns["torque_nm"])

    def test_a_member_on_a_guide_has_its_mass_in_the_joint(self) -> None:
        found = torque(mass=[{"of": "ram", "mass_kg": 3}])
        speed = 90.0 * pi / 30.0
        q = np.radians(found.columns["theta_deg"])
        _, slope, second = found.result.linkage.track("S.guide2", q, 2).derivatives()
        agree(found.columns["torque_nm"], 3e-6 * speed**2 * slope * second)

    def test_inertia_of_a_wheel(self) -> None:
        drive = {"name": "pair", "pair": PAIR, "speed_rpm": 100}
        found = behind_a_pair(drive=[drive], mass=[{"of": "pair.wheel2", "inertia_kg_m2": 0.5}])
        q = np.radians(found.columns["phi1_deg"])
        _, ratio, slope = found.result.linkage.track("pair.wheel2", q, 2).derivatives()
        agree(found.columns["wheel2_torque_nm"], 0.5 * (100.0 * pi / 30.0) ** 2 * slope)
        agree(found.columns["torque_nm"], found.columns["wheel2_torque_nm"] * ratio)

    @pytest.mark.parametrize("placed", [{}, {"mirror": True, "turn_deg": 20}])
    def test_wheels_of_a_density(self, placed: dict[str, Any]) -> None:
        """Each turns about its shaft, its centre of mass is beside it."""
        pair = gc.load("profiles/nail_machine_two_phase.toml").with_({"blank.density_kg_m3": 7850})
        facts = gc.build(pair).facts
        drive = {"name": "pair", "pair": pair, "speed_rpm": 30, **placed}
        load = [{"on": "C", "force_n": 0}]
        found = behind_a_pair(drive=[drive], load=load, gravity={"direction_deg": -70})
        q = np.radians(found.columns["phi1_deg"])
        place, ratio, slope = found.result.linkage.track("pair.wheel2", q, 2).derivatives()
        side = -1.0 if placed else 1.0

        def weight(wheel: int, turn: Any, rate: Any) -> Any:
            mass = facts[f"gears.{wheel}.mass.mass_kg"]
            x, y, _ = facts[f"gears.{wheel}.mass.centroid_mm"]
            own = (x + 1j * side * y) * np.exp(1j * (turn + radians(placed.get("turn_deg", 0.0))))
            pull = 9.80665 * np.exp(1j * radians(-70.0))
            return -1e-3 * mass * np.real(np.conj(pull) * 1j * own) * rate

        inertia = 1e-6 * facts["gears.1.mass.inertia_kg_mm2"] * pi**2 * ratio * slope
        second = weight(1, place, ratio) + inertia
        agree(found.columns["wheel1_torque_nm"], second)
        first = weight(0, -side * q, -side)
        agree(found.columns["torque_nm"], first + second)
        assert "pair.wheel1, pair.wheel2" in found.facts["torque.assumptions"]

    def test_a_rack_of_a_density(self) -> None:
        pair = gc.load("profiles/feeder.toml").with_({"blank.density_kg_m3": 7850})
        drive = {"name": "pair", "pair": pair, "speed_rpm": 10}
        load = [{"on": "pair.rack", "force_n": 0}]
        tables = {"drive": [drive], "load": load, "gravity": DOWN, "output": {"files": ["csv"]}}
        made = gc.build(gc.design({"kind": "mechanism", "name": "mine", **tables}))
        found = made.study("torque").columns
        q = np.radians(found["phi1_deg"])
        _, _, second = made.linkage.track("pair.rack", q, 2).derivatives()
        mass = made.drives[0].result.facts["gears.1.mass.mass_kg"]
        # it goes down by its own weight
        agree(found["rack_force_n"], -mass * (9.80665 + 1e-3 * (pi / 3.0) ** 2 * second))


def behind_a_pair(**changes: Any) -> Any:
    tables = {"kind": "mechanism", "name": "mine", **MACHINES["slide behind a pair"], **changes}
    tables["output"] = {"files": ["csv"]}
    return gc.build(gc.design(tables)).study("torque")


CAMS = {
    "lever": (LEVER, {}),
    "lever, mirrored": (LEVER, {"mirror": True, "turn_deg": 25}),
    "tappet": (TAPPET, {"turn_deg": -40}),
    "tappet, mirrored": (TAPPET, {"mirror": True}),
}


@cache
def behind_a_cam(name: str, rotation: str = "ccw") -> Any:
    file, placed = CAMS[name]
    cam = gc.load(file).with_({"cam.rotation": rotation})
    tables: dict[str, Any] = {
        "drive": [{"name": "cam", "cam": cam, "speed_rpm": 60, **placed}],
    }
    arm = {"name": "arm", "on": "cam.follower", "joint": "B"}
    if "lever" in name:
        tables["crank"] = [{**arm, "length_mm": 80, "arm_angle_deg": 60}]
    else:
        tables["slide"] = [arm]
    return gc.build(
        gc.design(
            {
                "kind": "mechanism",
                "name": "mine",
                **tables,
                "load": [{"on": "B", "force_n": [-30, -70]}],
                "mass": [{"of": "arm", "mass_kg": 2, "center": "B"}],
                "output": {"files": ["csv"]},
            }
        )
    ).study("torque")


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
@pytest.mark.parametrize("name", CAMS)
def test_the_follower_exerts_in_its_lift(name: str, rotation: str) -> None:
    found = behind_a_cam(name, rotation)
    effort = "follower_torque_nm" if "lever" in name else "follower_force_n"
    per = 1.0 if "lever" in name else 1e-3
    theta = np.radians(found.columns["theta_deg"])
    program = found.result.drives[0].result.program
    # a knot's own row has the values after it, the last row those before the end
    slope = program.derivatives(theta, 1)[1]
    agree(found.columns["torque_nm"], per * found.columns[effort] * slope, relative=1e-8)
    assert np.abs(found.columns[effort][slope == 0.0]).max() > 1.0


@pytest.mark.parametrize("name", ["lever", "tappet"])
def test_a_cam_takes_the_load_of_its_mechanism(name: str) -> None:
    """Rows of torque.csv as the load of the cam's own design: the same torque without friction."""
    found = behind_a_cam(name)
    effort = "follower_torque_nm" if name == "lever" else "follower_force_n"
    theta = np.minimum(found.columns["theta_deg"], 360.0)
    theta[-1] = 360.0
    load = {"table": found.columns[effort].tolist(), "at_deg": theta.tolist()}
    cam = gc.load(CAMS[name][0]).with_({"load": [load], "friction": {}, "mass": [], "spring": []})
    own = gc.build(cam).study("forces").columns
    wanted = np.interp(own["theta_deg"], theta, found.columns["torque_nm"])
    held = np.isfinite(own["torque_nm"]) & (own["normal_n"] > 0.0)
    assert held.sum() > 300
    scale = np.abs(wanted).max()
    np.testing.assert_allclose(own["torque_nm"][held], wanted[held], atol=2e-3 * scale)


@pytest.mark.parametrize(
    ("file", "force", "pulled"),
    [
        ("plate_cam_offset_roller", 30.0, 30.0),
        ("plate_cam_offset_roller", -30.0, None),
        ("groove_cam", 30.0, None),
    ],
)
def test_a_follower_that_is_pulled_off_its_cam(
    file: str, force: float, pulled: float | None
) -> None:
    cam: Any = gc.load(f"profiles/{file}.toml")
    tables = {
        "drive": [{"name": "cam", "cam": cam, "turn_deg": 40}],
        "slide": [{"name": "arm", "on": "cam.follower", "joint": "B"}],
        "load": [{"on": "arm", "force_n": force}],
        "output": {"files": ["csv"]},
    }
    found = gc.build(gc.design({"kind": "mechanism", "name": "mine", **tables})).study("torque")
    told = [one for one in found.study_findings if one.code == "lift-off"]
    assert [(one.value, one.unit) for one in told] == [
        (pytest.approx(size), "N") for size in (pulled,) if size is not None
    ]
    assert all(one.where.startswith("drive[0].cam, theta = ") for one in told)


def test_each_of_two_cams_has_its_share() -> None:
    load = [{"on": "table", "force_n": [12, -7]}]
    found = study("two_cam_table", load=load)
    theta = np.radians(found.columns["theta_deg"])
    total = 0.0
    for drive in found.result.drives:
        slope = drive.result.program.derivatives(theta, 1)[1]
        total = total + 1e-3 * found.columns[f"{drive.spec.name}_follower_force_n"] * slope
    agree(found.columns["torque_nm"], total, relative=1e-8)
    for drive in found.result.drives:
        fact = found.facts.quantity(f"torque.{drive.spec.name}_follower_force_n")
        assert fact.meaning == f"{drive.spec.name}: force of the follower in its lift"


def test_a_hoist_lifts_its_weight() -> None:
    mass = [{"of": "door", "mass_kg": 1000}]
    slow = {"drive[0].speed_rpm": 1e-6}
    found = study("furnace_door_lift", mass=mass, gravity=DOWN, **slow)
    q = np.radians(found.columns["phi1_deg"])
    ratio = found.result.linkage.track("pair.wheel2", q, 1).derivatives()[1]
    agree(found.columns["torque_nm"], 9806.65 * 0.1 * ratio)
    agree(found.columns["wheel2_torque_nm"], np.full(q.shape, 980.665))


def test_a_geneva_wheel() -> None:
    tables = {
        "drive": [{"name": "motor", "even": True, "speed_rpm": 60}],
        "geneva": [{"name": "wheel", "on": "motor", "slots": 4, "length_mm": 60}],
        "load": [{"on": "wheel", "torque_nm": -3}],
        "mass": [{"of": "wheel", "inertia_kg_m2": 0.02}],
        "output": {"files": ["csv"]},
    }
    made = gc.build(gc.design({"kind": "mechanism", "name": "mine", **tables}))
    found = made.study("torque").columns
    # 000, 2.4.6.1, from the line of centres
    crank = np.radians(found["theta_deg"])
    crank = np.where(crank > pi, crank - 2.0 * pi, crank)
    engaged = np.abs(crank) < pi / 4 - 1e-9
    share = np.sqrt(0.5)
    below = 1.0 - 2.0 * share * np.cos(crank) + share**2
    ratio = np.abs(share * (np.cos(crank) - share) / below)
    bend = -share * (1.0 - share**2) * np.sin(crank) / below**2
    # the wheel turns clockwise, with its load
    whole = -3.0 * ratio + 0.02 * (2.0 * pi) ** 2 * ratio * bend
    first = (found["theta_deg"] <= 360.0) & engaged
    agree(found["torque_nm"][first], whole[first], relative=1e-8)
    resting = (np.abs(crank) > pi / 4 + 1e-9) & (found["theta_deg"] <= 360.0)
    assert not found["torque_nm"][resting].any()


def test_a_rack() -> None:
    pair: Any = gc.load("profiles/feeder.toml")
    tables = {
        "drive": [{"name": "pair", "pair": pair, "speed_rpm": 10, "turn_deg": 30}],
        "slide": [{"name": "table", "on": "pair.rack", "joint": "T"}],
        "load": [{"on": "table", "force_n": 250}],
        "output": {"files": ["csv"]},
    }
    made = gc.build(gc.design({"kind": "mechanism", "name": "mine", **tables}))
    found = made.study("torque").columns
    # the rack goes back along its y axis, the load pulls forward
    agree(found["rack_force_n"], 250.0 * np.ones(len(found["phi1_deg"])))
    agree(found["torque_nm"], found["wheel1_torque_nm"])
    wheel, rack = pair.pair.teeth  # the wheel turns as far as the rack has teeth
    travel = rack / wheel * made.drives[0].result.facts["pair.travel_per_turn_mm"]
    agree(made.study("torque").facts["torque.work_j"], 0.25 * travel)


def test_it_is_a_part_of_a_build(tmp_path: Path) -> None:
    result = four_bar(
        load=[{"on": "S", "force_n": -80}], output={"files": ["csv"], "studies": ["torque"]}
    )
    result.write(tmp_path)
    (table,) = tmp_path.rglob("torque.csv")
    with table.open() as file:
        read = list(csv.DictReader(file))
    columns = result.study("torque").columns
    assert list(read[0]) == list(columns) == ["theta_deg", "torque_nm", "loads_nm", "power_w"]
    assert float(read[40]["torque_nm"]) == pytest.approx(columns["torque_nm"][40], rel=1e-14)
    (summary,) = tmp_path.rglob("summary.json")
    assert json.loads(summary.read_text())["torque"]["work_j"] == pytest.approx(0.0, abs=1e-9)


def test_parts_add_up() -> None:
    found = torque(
        load=[{"on": "S", "force_n": -80}],
        mass=[{"of": "ram", "mass_kg": 3}],
        gravity={"direction_deg": 0},
        spring=[{"on": "S", "stiffness_n_mm": 2}],
    )
    parts = [found.columns[f"{one}_nm"] for one in ("loads", "inertia", "gravity", "springs")]
    agree(sum(parts), found.columns["torque_nm"])
    assert [line.label for line in found.charts["torque_parts"].lines] == [
        "loads", "inertia", "gravity", "springs",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("part", "acts"),
    [
        ("loads", {"load": [{"on": "S", "force_n": -80}]}),
        ("inertia", {"mass": [{"of": "ram", "mass_kg": 3}]}),
        ("springs", {"spring": [{"on": "S", "stiffness_n_mm": 2}]}),
    ],
)
def test_the_only_part_has_its_column_too(part: str, acts: dict[str, Any]) -> None:
    found = torque(**acts)
    agree(found.columns[f"{part}_nm"], found.columns["torque_nm"])
    assert "torque_parts" not in found.charts  # it would be the same line again


def test_a_drive_that_is_too_weak() -> None:
    load = [{"on": "S", "force_n": -80}]
    found = torque(load=load, limits={"drive_torque_nm": 2})
    (one,) = found.study_findings
    assert (one.code, one.severity, one.limit) == ("drive-torque", "warning", 2.0)
    assert one.value == pytest.approx(np.abs(found.columns["torque_nm"]).max(), rel=1e-4)
    assert found.charts["torque"].limits[0].value == 2.0
    assert codes(torque(load=load, limits={"drive_torque_nm": 50})) == []


def test_extremes_are_those_of_a_dense_table() -> None:
    settings = {"steps": 100000}
    found = torque(load=[{"on": "P", "force_n": [30, -200]}], torque=settings)
    values = found.columns["torque_nm"]
    assert found.facts["torque.torque_nm.max"] == pytest.approx(values.max(), rel=1e-8)
    assert found.facts["torque.torque_nm.min"] == pytest.approx(values.min(), rel=1e-8)
    assert found.facts["torque.mean_nm"] == pytest.approx(0.0, abs=1e-9)


REFUSED = {
    "nothing acts": ({}, "nothing acts"),
    "a mass at rest": ({"mass": [{"of": "ram", "mass_kg": 3}]}, "speed_rpm.*inertia"),
    "a damper at rest": ({"spring": [{"on": "S", "damping_n_s_mm": 1}]}, "speed_rpm.*damper"),
    "a velocity at rest": ({"load": [{"on": "S", "formula": "v"}]}, "speed_rpm.*velocity"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_without_what_it_needs(case: str) -> None:
    changes, words = REFUSED[case]
    with pytest.raises(DesignError) as caught:
        torque(drive=[{"name": "motor", "even": True}], **changes)
    assert re.search(words, str(caught.value).replace("\n", " "))


def test_more_travel_than_there_is() -> None:
    load = {"on": "S", "force_n": 80, "travel_mm": 500, "before": "inner"}
    with pytest.raises(InfeasibleError, match=r"not so much travel") as caught:
        torque(load=[load])
    assert caught.value.where == "load[0].travel_mm"
    assert caught.value.limit is not None
    assert 20.0 < caught.value.limit < 200.0


def test_a_load_over_more_than_a_turn() -> None:
    load = {"on": "S", "force_n": 80, "from_deg": 10, "to_deg": 371}
    with pytest.raises(InfeasibleError, match=r"more than a turn of the master") as caught:
        torque(load=[load])
    assert (caught.value.where, caught.value.limit) == ("load[0].to_deg", pytest.approx(370.0))
    whole = torque(load=[{**load, "to_deg": 370}])
    assert whole.facts["torque.torque_nm.max"] == pytest.approx(
        torque(load=[{"on": "S", "force_n": 80}]).facts["torque.torque_nm.max"]
    )
    # a master that does not turn on has no turns with which a load repeats
    part = [{"name": "motor", "even": True, "speed_rpm": 90, "range_deg": [0, 400]}]
    assert torque(load=[load], drive=part).columns["torque_nm"].any()


def test_no_travel_before_the_dead_center() -> None:
    """The door begins at the bottom: it does not arrive there."""
    load = {"on": "door", "force_n": 80, "travel_mm": 5, "before": "inner"}
    with pytest.raises(InfeasibleError, match=r"before its inner dead centre") as caught:
        study("furnace_door_lift", load=[load])
    assert "other dead centre" in str(caught.value)


def test_a_spring_between_joints_that_meet() -> None:
    with pytest.raises(InfeasibleError, match=r"in one place") as caught:
        study("quick_return", spring=[{"between": ["block_pin", "pin"], "stiffness_n_mm": 1}])
    assert caught.value.where == "spring[0].between"


def test_a_spring_that_is_wound_up_keeps_its_work() -> None:
    found = torque(spring=[{"between": ["ground", "crank"], "stiffness_nm_rad": 2}])
    agree(found.facts["torque.work_j"], 4.0 * pi**2)
    assert "torque.error" not in found.facts


def test_against_an_even_shaft() -> None:
    found = torque(load=[{"on": "motor", "torque_nm": 3, "against": True}])
    agree(found.columns["torque_nm"], np.full(len(found.columns["torque_nm"]), 3.0))


@pytest.mark.parametrize("steps", [36, 720])
def test_peaks_of_shafts_are_between_the_rows_too(steps: int) -> None:
    load = [{"on": "slide", "formula": "-0.4*v"}]
    found = study("nail_machine_slide", load=load, torque={"steps": steps}).facts
    fine = study("nail_machine_slide", load=load, torque={"steps": 50000}).columns
    for end, choose in (("min", np.min), ("max", np.max)):
        # all that it works against is behind the pair
        whole = found[f"torque.torque_nm.{end}"]
        assert found[f"torque.wheel1_torque_nm.{end}"] == pytest.approx(whole, rel=1e-8, abs=1e-9)
        value = choose(fine["wheel2_torque_nm"])
        assert found[f"torque.wheel2_torque_nm.{end}"] == pytest.approx(value, rel=1e-7, abs=1e-9)


def test_what_does_not_change_has_no_place() -> None:
    found = torque(load=[{"on": "motor", "torque_nm": -3}])
    assert found.facts.quantity("torque.torque_nm").place == ""


def test_what_rounding_leaves_of_work_is_shown_as_0() -> None:
    found = torque(spring=[{"between": ["P", "D"], "stiffness_n_mm": 3, "preload_n": 50}])
    for name, text in (("mean_nm", "0 N m"), ("work_j", "0 J"), ("mean_power_w", "0 W")):
        assert found.facts.quantity(f"torque.{name}").text == text


def test_what_rounding_leaves_on_a_wheel_is_shown_as_0() -> None:
    load = [{"on": "slide", "force_n": -800, "against": True}]
    found = study("nail_machine_slide", load=load, mass=[], spring=[])
    assert found.columns["wheel2_torque_nm"].min() < 1e-9
    assert found.facts.quantity("torque.wheel2_torque_nm").text.startswith("0 to ")


def test_forces_that_do_no_work() -> None:
    found = torque(spring=[{"between": ["C", "D"], "stiffness_n_mm": 3}])
    assert np.abs(found.columns["torque_nm"]).max() < 1e-12
    assert "torque.error" not in found.facts


def test_a_table_that_ends_too_early() -> None:
    load = {"on": "S", "table": [0, 1], "at_deg": [0, 300]}
    with pytest.raises(InfeasibleError, match=r"does not reach") as caught:
        torque(load=[load])
    assert caught.value.where == "load[0].at_deg[1]"
    assert caught.value.limit == pytest.approx(360.0)


def test_a_load_need_not_be_finite_where_it_does_not_act() -> None:
    load = {"on": "S", "formula": "sqrt(2 - q)", "from_deg": 0, "to_deg": 90}
    found = torque(load=[load])
    q = np.radians(found.columns["theta_deg"])
    acts = q < pi / 2 - 1e-9
    wanted = -1e-3 * np.sqrt(2.0 - q[acts]) * moved("S.guide2", found)[1][acts]
    agree(found.columns["torque_nm"][acts], wanted)
    assert not found.columns["torque_nm"][q > pi / 2 + 1e-9].any()


def test_a_load_that_is_not_finite() -> None:
    with pytest.raises(InfeasibleError, match=r"not finite at theta = "):
        torque(load=[{"on": "S", "formula": "log(x - 200)"}])
