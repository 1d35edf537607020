"""Each mistake in a name of a mechanism is reported once, with its place and the likely name."""

from __future__ import annotations

import cmath
import csv
import io
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError, Problem
from gearcam.spatial.extremes import Spot
from helpers_built import built as shared
from helpers_machines import MACHINES, MOTOR, PAIR

Document = dict[str, Any]


def problems(machine: Mapping[str, Any]) -> list[Problem]:
    with pytest.raises(DesignError) as caught:
        gc.design({"kind": "mechanism", "name": "mine", **machine})
    return list(caught.value.problems)


def changed(name: str, title: str, /, **keys: Any) -> Document:
    """Return a machine with other keys in the first of some tables; None leaves one out."""
    machine = dict(MACHINES[name])
    rows = [dict(row) for row in machine[title]]
    rows[0] = {key: value for key, value in (rows[0] | keys).items() if value is not None}
    return machine | {title: rows}


def told(machine: Mapping[str, Any]) -> dict[str, str]:
    return {one.key: one.message for one in problems(machine)}


@pytest.mark.parametrize(
    ("machine", "title", "keys", "key"),
    [
        ("four-bar", "crank", {"length_mm": None, "lenght_mm": 40}, "crank[0].lenght_mm"),
        ("four-bar", "crank", {"length_mm": -40}, "crank[0].length_mm"),
        ("four-bar", "crank", {"joint": None, "jiont": "B"}, "crank[0].jiont"),
        ("four-bar", "drive", {"even": False}, "drive[0].even"),
        ("four-bar", "dyad", {"lengths_mm": [120, -90]}, "dyad[0].lengths_mm[1]"),
        ("four-bar", "dyad", {"members": ["coupler"]}, "dyad[0].members"),
        ("slide behind a pair", "drive", {"pair": "no.toml"}, "drive[0].pair"),
        ("slide behind a pair", "guide", {"name": 7}, "guide[0].name"),
        ("table on two cams", "drive", {"cam": "no.toml"}, "drive[0].cam"),
    ],
)
def test_names_of_faulty_tables_count_as_given(
    machine: str, title: str, keys: Document, key: str
) -> None:
    assert list(told(changed(machine, title, **keys))) == [key]


def test_names_of_a_chain_without_a_range_count_as_given() -> None:
    door = changed("door", "chain", range_deg=None)
    door["point"] = [{"name": "P", "on": "leaf", "at_mm": [1, 2]}]
    door["mass"] = [{"of": "leaf", "mass_kg": 9, "center": "P"}]
    door["load"] = [{"on": "P", "force_n": [1, 2]}]
    door["spring"] = [{"between": ["P", "B"], "stiffness_n_mm": 1}]
    assert list(told(door)) == ["chain[0].range_deg"]


def test_a_comparison_without_a_drive_is_told_once() -> None:
    machine = MACHINES["slide behind a pair"] | {"compare": [{"name": "other"}]}
    assert list(told(machine)) == ["compare[0]"]


def test_names_of_unknown_tables_count_as_given() -> None:
    machine = dict(MACHINES["four-bar"])
    machine["cranks"] = machine.pop("crank")
    assert list(told(machine)) == ["cranks"]


def test_other_names_are_told_beside_a_faulty_table() -> None:
    machine = changed("four-bar", "crank", length_mm=-40)
    machine["point"] = [{"name": "P", "on": "couppler", "at_mm": [1, 2]}]
    assert list(told(machine)) == ["crank[0].length_mm", "point[0].on"]


def output(*names: str, machine: str = "four-bar", **tables: Any) -> Document:
    return MACHINES[machine] | {"output": {"files": ["csv"], "outputs": list(names)}} | tables


def test_all_outputs_that_do_not_move_are_told() -> None:
    found = problems(output("rocker", "P", "coupler.angel", "D", "C.angle", "rockr"))
    assert [one.key for one in found] == [f"output.outputs[{k}]" for k in (0, 2, 3, 4, 5)]
    assert found[0].message == '"rocker": nothing moves by this name'
    assert [one.hint for one in found] == [
        "did you mean rocker.angle?",
        "did you mean coupler.angle?",
        "D stands still",
        "C is a joint, which has no direction: write C, for its two coordinates",
        "did you mean rocker.angle?",
    ]
    assert "of a joint also NAME.x and NAME.y" in found[0].allowed
    (found,) = problems(output("C.angle", machine="slide behind a pair"))
    assert found.hint.endswith("write C, for its place on its guide")
    (found,) = problems(output("pair", machine="slide behind a pair"))
    assert found.hint == "did you mean pair.wheel1 or pair.wheel2?"


def test_outputs_have_lines(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        """\
kind = "mechanism"
[[drive]]
name = "motor"
even = true
[[crank]]
name = "crank"
on = "motor"
joint = "B"
length_mm = 40
[[interval]]
on = "A"
travel_mm = 4
[[dwell]]
on = "B"
within_mm = 1
[output]
outputs = ["B", "A"]
"""
    )
    with pytest.raises(DesignError) as caught:
        gc.load(file)
    assert [(one.key, one.line) for one in caught.value.problems] == [
        ("interval[0].on", 11), ("dwell[0].on", 14), ("output.outputs[1]", 17),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("title", "keys", "key", "allowed"),
    [
        ("interval", {"on": "rocker.angle", "travel_mm": 4}, "travel_mm", "travel_deg"),
        ("interval", {"on": "P.x", "travel_deg": 4}, "travel_deg", "travel_mm"),
        ("dwell", {"on": "rocker.angle", "within_mm": 4}, "within_mm", "within_deg"),
        ("dwell", {"on": "P", "within_mm": 4}, "on", "P.x or P.y"),
    ],
)
def test_the_right_amount_of_an_output_is_named(
    title: str, keys: Document, key: str, allowed: str
) -> None:
    (found,) = problems({**MACHINES["four-bar"], title: [keys]})
    assert (found.key, found.allowed) == (f"{title}[0].{key}", allowed)


def test_stretches_are_of_points_that_are_asked_for() -> None:
    stretch = [{"on": "B", "from_deg": 0, "to_deg": 10, "shape": "line"}]
    (found,) = problems(output("P", "C", stretch=stretch))
    assert found.key == "stretch[0].on"
    assert found.allowed == "a point of the outputs: P, C"
    assert found.hint == "add it to output.outputs"


def built(machine: Document) -> Any:
    return gc.build(gc.design({"kind": "mechanism", "name": "mine", **machine}))


def test_single_coordinates_are_outputs() -> None:
    whole, parts = built(output("C")), built(output("C.y", "C_x", "C", "P_y"))
    columns = parts.motion()
    assert [one.stem for one in parts.outputs] == ["C_y", "C_x", "P_y"]
    for key, values in whole.motion().items():
        assert (columns[key] == values).all()
    assert list(parts.paths) == ["C"]
    assert (parts.output("P.y")["P_y_mm"] == columns["P_y_mm"]).all()
    assert list(parts.output("P_y"))[1] == "P_y_mm"
    assert list(built(output("C.x")).paths) == []


def test_intervals_and_dwells_of_coordinates() -> None:
    asked: Document = {
        "interval": [{"on": "C_x", "travel_mm": 1}],
        "dwell": [{"on": "C.x", "within_mm": 1, "least_deg": 1}],
    }
    result = built(output("C", **asked))
    found = result.intervals[0]
    low, high = result.output("C.x", [found.begin, found.end])["C_x_mm"]
    assert high - low == pytest.approx(1.0, abs=1e-9)
    assert high == pytest.approx(result.facts["outputs.C_x.largest_mm"], abs=1e-9)
    assert result.dwells[0].length > found.length


def test_all_outputs_of_each_machine_are_those_of_its_linkage() -> None:
    for name, machine in MACHINES.items():
        result = built(machine)
        for one in (one for many in result.output_names.known.values() for one in many):
            values = result.track(one)(result.linkage.knots[:1], 1).derivatives()
            assert len(values) == 2, (name, one)


def test_a_drive_with_a_pair_gives_its_wheels() -> None:
    machine = output("pair.wheel3", machine="slide behind a pair")
    machine["drive"] = [{"name": "pair", "pair": PAIR}]
    (found,) = problems(machine)
    assert found.hint in ("did you mean pair.wheel1?", "did you mean pair.wheel2?")


@pytest.mark.parametrize(
    ("keys", "key", "message"),
    [
        ({"lengths_mm": None}, "lengths_mm", "dyad C has no lengths"),
        ({"lengths_mm": [120, 0]}, "lengths_mm[1]", "the length of rocker in dyad C is 0"),
    ],
)
def test_missing_lengths_are_told_by_their_members(keys: Document, key: str, message: str) -> None:
    (found,) = problems(changed("four-bar", "dyad", **keys))
    assert found.key == f"dyad[0].{key}"
    assert found.message.endswith(message)


@pytest.mark.parametrize(("written", "meant"), [("RRP", "RRT"), ("rpr", "RTR"), ("PRP", "TRT")])
def test_slides_written_as_p_are_t(written: str, meant: str) -> None:
    found = problems(changed("four-bar", "dyad", type=written))
    assert [one.hint for one in found] == [f"did you mean {meant}? (T is a slide)"]
    (found,) = problems(changed("four-bar", "dyad", type="RRTT"))
    assert found.hint == "did you mean RTT?"


def refused(machine: Document) -> InfeasibleError:
    with pytest.raises(InfeasibleError) as caught:
        _ = built(machine).linkage
    return caught.value


def test_a_lever_at_the_limit_of_its_range_is_offered_one_that_builds() -> None:
    for side, machine in enumerate(
        (
            changed("door", "drive", range_deg=[-50, 100]),
            changed("door", "chain", range_deg=[-90, -30]),
        )
    ):
        told = refused(machine)
        limit = (-90, -30)[side]
        assert told.where == f"chain[0].range_deg[{side}]"
        assert told.value == pytest.approx(limit)
        assert f"the lever reaches chain[0].range_deg[{side}] = {limit}" in str(told)
        (way,) = told.adjustments
        design = gc.design({"kind": "mechanism", "name": "mine", **machine})
        wide = gc.build(design.with_(way.near))
        ends = wide.output("leaf.angle", wide.linkage.span)["leaf_deg"]
        assert abs(ends[side] - told.limit) < 0.02
    assert "from 0 to 100 deg" in str(refused(changed("door", "drive", range_deg=[-50, 100])))


def test_a_chain_that_turns_back_is_not_helped_by_a_wider_range() -> None:
    told = refused(
        changed("door", "drive", range_deg=[-300, 100])
        | {"chain": changed("door", "chain", range_deg=[-300, 5])["chain"]}
    )
    assert "its chain turns back" in str(told)
    # the free length is largest where lever and chain are in line
    place = float(str(told).split("; at ")[1].split(" deg")[0])
    joint = 700 * cmath.exp(1j * math.radians(place))
    way = joint - (600 + 300j)
    across = abs((way.conjugate() * joint).imag) / 700  # of the wheel's centre from the lever
    assert across == pytest.approx(100, abs=1e-3)


def test_a_joint_inside_its_wheel_is_refused() -> None:
    (found,) = problems(changed("door", "chain", range_deg=[-90, 20]))
    assert found.key == "chain[0].range_deg[1]"
    limit = float(found.allowed.removeprefix("below "))
    assert abs(700 * cmath.exp(1j * math.radians(limit)) - (600 + 300j)) == pytest.approx(100)
    (found,) = problems(changed("door", "chain", range_deg=[20, 90], start_deg=80))
    assert found.key == "chain[0].range_deg[0]"
    limit = float(found.allowed.removeprefix("above "))
    assert abs(700 * cmath.exp(1j * math.radians(limit)) - (600 + 300j)) == pytest.approx(100)
    (found,) = problems(changed("door", "chain", range_deg=[0, 90], start_deg=30))
    assert found.key == "chain[0].start_deg"


def finding(machine: Document, code: str) -> str:
    (message,) = (one.message for one in built(machine).checked if one.code == code)
    return message


def test_limits_of_transmission_angles_are_told_as_such() -> None:
    told = finding(MACHINES["four-bar"], "pressure-angle")
    assert "Usual are 45 deg and more, and never less than 30 deg." in told


def test_change_points_say_what_the_machine_does() -> None:
    flat = output("rocker.angle", joint=[{"name": "D", "at_mm": [120, 0]}])
    flat["crank"] = [MACHINES["four-bar"]["crank"][0] | {"length_mm": 50}]
    flat["dyad"] = [MACHINES["four-bar"]["dyad"][0] | {"lengths_mm": [120, 50]}]
    told = finding(flat, "change-point")
    assert 'It keeps its branch; with change = "motion" it goes on into the other one.' in told
    flat["dyad"] = [flat["dyad"][0] | {"change": "motion"}]
    told = finding(flat, "change-point")
    assert 'It goes on into the other branch; with change = "branch" it keeps its own.' in told


def test_loads_without_their_study_are_told() -> None:
    load = {"on": "P", "force_n": [1, 2]}
    told = finding(output("P", load=[load]), "loads-unused")
    assert "gearcam torque" in told
    asked = {"files": ["csv"], "outputs": ["P"], "studies": ["torque"]}
    for machine in (MACHINES["four-bar"], MACHINES["four-bar"] | {"load": [load], "output": asked}):
        assert "loads-unused" not in {one.code for one in built(machine).checked}


def test_places_of_peaks_are_numbers() -> None:
    speed: Document = {"drive": [MOTOR | {"speed_rpm": 60}]}
    interval: list[Document] = [
        {"on": "C.x", "travel_mm": 5, "before": "inner"},
        {"on": "rocker.angle", "travel_deg": 5},
    ]
    result = built(output("C", "rocker.angle", interval=interval, **speed))
    facts = result.facts
    for stem, name, angle in (("C_x", "C.x", False), ("rocker", "rocker.angle", True)):
        group, rate = facts[f"outputs.{stem}"], "rad" if angle else "mm"
        columns = {
            f"least_{'deg' if angle else 'mm'}": f"{stem}_{'deg' if angle else 'mm'}",
            f"largest_{'deg' if angle else 'mm'}": f"{stem}_{'deg' if angle else 'mm'}",
            f"velocity_{rate}_per_rad": f"{stem}_{rate}_per_rad",
            f"acceleration_{rate}_per_rad2": f"{stem}_{rate}_per_rad2",
            f"jerk_{rate}_per_rad3": f"{stem}_{rate}_per_rad3",
        }
        for key, column in columns.items():
            place = math.radians(group[f"{key.split('_')[0]}_at_deg"])
            assert result.output(name, [place])[column][0] == pytest.approx(group[key], rel=1e-9)
    dyad = facts["machine.dyads.C"]
    place = math.radians(dyad["pressure_angle_at_deg"])
    rods = [result.output(f"{name}.angle", [place]) for name in ("coupler", "rocker")]
    between = rods[0]["coupler_deg"][0] - rods[1]["rocker_deg"][0]
    across = abs(90.0 - abs(math.remainder(between, 180.0)))
    assert across == pytest.approx(dyad["pressure_angle_deg"])


def test_intervals_have_their_velocities() -> None:
    interval: list[Document] = [
        {"on": "C.x", "travel_mm": 5, "before": "inner"},
        {"on": "rocker.angle", "travel_deg": 5},
    ]
    speed: Document = {"drive": [MOTOR | {"speed_rpm": 60}]}
    result = built(output("C", "rocker.angle", interval=interval, **speed))
    first, second = result.facts["intervals"]
    for row, name, stem, unit in (
        (first, "C.x", "C_x", "mm"), (second, "rocker.angle", "rocker", "rad")
    ):  # fmt: skip
        columns = result.output(name, [math.radians(row["from_deg"])])
        for kind in (f"{unit}_per_rad", f"{unit}_s"):
            assert row[f"velocity_{kind}"] == pytest.approx(columns[f"{stem}_{kind}"][0])
    still = built(output("C", "rocker.angle", interval=interval)).facts["intervals"]
    assert "velocity_mm_per_rad" in still[0]
    assert not {"time_s", "velocity_mm_s"} & set(still[0])


def test_a_few_facts_are_always_shown() -> None:
    shown = [one.meaning for one in built(output("P", "C", "rocker.angle")).facts.shown()]
    assert shown == [
        "largest pressure angle of C",
        "stroke of P_x",
        "forward over return time of P_x",
        "largest velocity of P_x",
        "stroke of P_y",
        "stroke of C_x",
        "stroke of C_y",
    ]
    fast = built(output("P", drive=[MOTOR | {"speed_rpm": 60}])).facts
    assert "outputs.P_x.velocity_mm_s" in [one.name for one in fast.shown()]
    (velocity,) = (one for one in fast.shown() if one.meaning == "largest velocity of P_x")
    assert velocity.place.startswith("at ")


def test_the_study_of_loads_does_not_repeat_that_it_is_to_be_asked_for() -> None:
    result = built(output("P", load=[{"on": "P", "force_n": [1, 2]}]))
    codes = {one.code for one in result.study("torque").findings}
    assert "loads-unused" in {one.code for one in result.findings} - codes


def test_places_of_the_largest_moment_are_numbers() -> None:
    load = [{"on": "P", "force_n": [10, 20]}]
    result = built(output("P", load=load))
    found = result.study("torque")
    place, size = found.facts["torque.torque_at_deg"], found.facts["torque.torque_nm"]
    for end in ("min", "max"):
        at = [math.radians(place[end])]
        rates = [result.output("P", at)[f"P_{x}_mm_per_rad"][0] for x in "xy"]
        # the driver's power is that which the load takes
        assert -1e-3 * (10 * rates[0] + 20 * rates[1]) == pytest.approx(size[end], rel=1e-9)


def test_a_length_that_is_off_is_told_by_its_member() -> None:
    told = refused(changed("four-bar", "dyad", lengths_mm=[120, 45]))
    assert "length of rocker" in str(told)
    both = str(refused(changed("four-bar", "dyad", lengths_mm=[10, 20])))
    assert re.search(r"lengths_mm\[0\] = [\d.]+ \(coupler\) and .* \(rocker\)", both)


def test_no_table_is_offered_its_own_names() -> None:
    (found,) = problems(changed("four-bar", "dyad", **{"from": "b"}))
    assert (found.hint, found.allowed) == ("did you mean B?", "a joint: B, D, P")


def test_what_is_asked_for_is_answered_on_the_console() -> None:
    asked = {
        "output": {"files": ["csv"], "outputs": ["rocker.angle", "P"]},
        "dwell": [{"on": "rocker.angle", "within_deg": 0.5}, {"on": "P.x", "within_mm": 2}],
        "interval": [{"on": "rocker.angle", "travel_deg": 5, "before": "inner"}],
        "stretch": [{"on": "P", "from_deg": 300, "to_deg": 400, "shape": "line"}],
    }
    document = {"kind": "mechanism", "name": "mine", **MACHINES["four-bar"], **asked}
    result = gc.build(gc.design(document))
    shown = {one.meaning: (one.value, one.unit, one.place) for one in result.facts.shown()}
    deg = math.degrees(1.0)
    for meaning, found in (
        ("longest dwell of rocker.angle within 0.5 deg", result.dwells[0]),
        ("longest dwell of P.x within 2 mm", result.dwells[1]),
        ("last 5 deg of rocker.angle before its inner dead centre", result.intervals[0]),
    ):
        value, unit, place = shown[meaning]
        assert (value, unit) == (pytest.approx(deg * found.length), "deg")
        ends = [float(one) for one in place.removesuffix(" deg").split(" to ")]
        assert ends == pytest.approx([deg * found.begin, deg * found.end], rel=5e-5)
    line = shown["deviation of P from the line"]
    assert line == (result.stretches[0].deviation, "mm", "300 to 400 deg")


@pytest.mark.parametrize(
    ("key", "allowed", "hint"),
    [
        ("crank[crank].length_mm", "[0]", "crank is number 0"),
        ("dyad[C].lengths_mm[0]", "[0]", "C is number 0"),
        ("point[Q].at_mm[0]", "[0]", ""),
        ("drive.even", "[0]", ""),
    ],
)
def test_tables_are_changed_by_their_numbers(key: str, allowed: str, hint: str) -> None:
    design = gc.design({"kind": "mechanism", "name": "mine", **MACHINES["four-bar"]})
    with pytest.raises(DesignError) as caught:
        design.with_({key: 30})
    (problem,) = caught.value.problems
    assert (problem.allowed, problem.hint) == (allowed, hint)


@pytest.mark.parametrize(
    ("profile", "called"),
    [
        ("two_cam_table", "table between slides driven by 2 cams"),
        ("oscillating_cylinder", "cylinder driven by an even shaft and a slide"),
        ("geneva", "linkage driven by an even shaft"),
        ("lathe_levers", "coupler and rocker + rod and slide driven by a cam"),
    ],
)
def test_all_drives_are_named(profile: str, called: str) -> None:
    result = shared(f"profiles/{profile}.toml")
    assert result.facts.headline[0] == called


def pushed(*compare: Document) -> Any:
    """Return a machine whose slide a cam pushes straight up, with a dwell over the turn's end."""
    motion = [
        {"type": "rise", "law": "cycloidal", "angle_deg": 120, "lift_mm": 10},
        {"type": "return", "law": "cycloidal", "angle_deg": 180},
        {"type": "dwell", "angle_deg": 60},
    ]
    plate = {
        "kind": "cam", "name": "plate", "motion": motion,
        "follower": {"type": "roller", "roller_radius_mm": 6},
        "cam": {"prime_radius_mm": 30, "thickness_mm": 12},
    }  # fmt: skip
    return built(
        {
            "drive": [{"name": "k", "cam": plate, "speed_rpm": 100}],
            "slide": [{"name": "st", "on": "k.follower", "joint": "A"}],
            "compare": [{**one, "cam": plate} for one in compare],
            "output": {"files": ["csv"], "outputs": ["A"]},
        }
    )


def test_dead_centers_are_within_the_range() -> None:
    facts = pushed().facts
    assert facts["outputs.A_y.dead_centers_deg"] == [120.0, 300.0]


def test_an_output_that_does_not_move_has_no_places() -> None:
    facts = pushed().facts
    still, moves = facts["outputs.A_x"], facts["outputs.A_y"]
    assert {value for key, value in still.items() if not key.endswith("_deg")} == {0.0}
    assert not [key for key in still if key.endswith("_deg")]
    assert {"velocity_at_deg", "least_at_deg"} <= set(moves)
    (velocity,) = (one for one in facts.shown() if one.meaning == "largest velocity of A_x")
    assert (velocity.value, velocity.place) == (0.0, "")


def test_a_comparison_has_no_places_of_what_stands_still() -> None:
    result = pushed({"name": "again"})
    head, *rows = csv.reader(io.StringIO(result.files("csv")["comparison.csv"].decode()))
    places = [number for number, name in enumerate(head) if name.endswith("_at_deg")]
    assert len(places) == 3
    for row in rows:
        still = row[head.index("output")] == "A_x"
        assert [not row[number] for number in places] == [still] * 3
    table = result.comparison()
    assert np.isnan(table["velocity_at_deg"]).tolist() == [one == "A_x" for one in table["output"]]


@pytest.mark.parametrize(("before", "text"), [(1e-9, "0"), (3e-6, "0"), (1e-4, "359.99")])
def test_a_place_just_before_the_end_of_a_turn_is_said_in_one_way(before: float, text: str) -> None:
    result, place = pushed(), math.tau - before
    assert result.degrees(place) == text
    plate = result.drives[0].result
    assert plate.driver.place(place) == f"at {text} deg"
    assert plate.driver.text(math.tau) == "360 deg"
    spot = Spot(theta=place, x=1.0, value=1.0)
    assert spot.place.startswith(f"at {float(text):.5g} deg")


def test_a_kite_too_near_its_change_point_is_told_what_is_resolved() -> None:
    def kite(base: float) -> Document:
        dyad = {
            "type": "RRR", "from": "B", "to": "D", "joint": "C", "members": ["coupler", "rocker"],
            "lengths_mm": [90, 90],
        }  # fmt: skip
        ground = [{"name": "D", "at_mm": [base, 0]}]
        return output("rocker.angle") | {"joint": ground, "dyad": [dyad], "point": []}

    error = refused(kite(40.000000001))
    assert error.what == "C is nearly singular at 0 deg: B and D meet there but for 1e-09 mm"
    (least,) = re.findall(r"resolved from ([0-9.e-]+) mm on", error.nearest)
    found = built(kite(40.0 + float(least))).facts["outputs.rocker"]
    assert found["velocity_rad_per_rad"] == pytest.approx(-40.0 / float(least), rel=1e-6)
    assert refused(kite(40.0)).what == "C is singular at 0 deg: B and D meet there"
