"""Rotors: weights in two planes leave neither force nor couple; what cannot be one is refused."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.cli import main
from gearcam.designs.writing import toml_text
from helpers_linkages import agree
from helpers_machines import PAIR
from helpers_rotors import Point, acceleration, prisms, shaken

RPM = 600.0
SPEED = RPM * pi / 30.0
DENSITY = 7850
PLANES = [20.0, 220.0]
ABOUT = (13.0, -40.0, 71.0)
"""A point on no axis, about which couples are taken."""


def crank(name: str, on: str = "motor", angle: float = 0.0) -> dict[str, Any]:
    return {"name": name, "on": on, "joint": f"{name}_pin", "length_mm": 30, "angle_deg": angle}


def mass(of: str, kg: float, *at: float) -> dict[str, Any]:
    return {"of": of, "mass_kg": kg, "at_mm": [*at]}


def rotor(parts: list[str], places: list[float], **more: Any) -> dict[str, Any]:
    own = {"name": "shaft", "parts": parts, "places_mm": places, "planes_mm": PLANES}
    return own | {"radius_mm": 60} | more


MOTOR = {"name": "motor", "even": True, "speed_rpm": RPM}

THREE: dict[str, Any] = {
    "drive": [MOTOR],
    "crank": [crank("a"), crank("b"), crank("c")],
    "mass": [mass("a", 0.2, 30, 10), mass("b", 0.35, -20, 25), mass("c", 0.15, 5, -40)],
    "rotor": [rotor(["a", "b", "c"], [40, 110, 180])],
}

PLACED = {"at_mm": [30, -50], "turn_deg": 25}


def cam_drive(profile: str, rotation: str = "ccw", **more: Any) -> dict[str, Any]:
    changes = {"blank.density_kg_m3": DENSITY, "cam.rotation": rotation}
    cam = gc.load(f"profiles/{profile}.toml").with_(changes)
    return {"name": profile, "cam": cam, **more}


def behind_cams(*drives: dict[str, Any], parts: list[str], places: list[float]) -> dict[str, Any]:
    """Cams on one shaft with a crank of its own."""
    first, *others = drives
    return {
        "drive": [{**first, "speed_rpm": RPM}, *others],
        "crank": [crank("arm", f"{first['name']}.shaft", 70.0)],
        "mass": [mass("arm", 0.3, 20, -12), mass("arm", 0.1, 50, 0)],
        "rotor": [rotor(parts, places)],
    }


GROOVE = cam_drive("groove_cam", mirror=True, **PLACED)
SECOND = cam_drive("valve_lever", mirror=True, at_mm=[30, -50], turn_deg=-40)
ON_WHEEL = {"name": "pair", "pair": PAIR | {"blank": {"density_kg_m3": DENSITY}}}

ROTORS: dict[str, dict[str, Any]] = {
    "three cranks": THREE,
    "conjugate cams and a crank": behind_cams(
        cam_drive("conjugate_cams", **PLACED),
        parts=["conjugate_cams.shaft", "arm"],
        places=[60.0, 150.0],
    ),
    "conjugate cams, clockwise, mirrored": behind_cams(
        cam_drive("conjugate_cams", "cw", mirror=True, **PLACED),
        parts=["arm", "conjugate_cams.shaft"],
        places=[-30.0, 60.0],
    ),
    "a groove and a disc, mirrored": behind_cams(
        GROOVE,
        SECOND,
        parts=["groove_cam.shaft", "arm", "valve_lever.shaft"],
        places=[60.0, 150.0, 240.0],
    ),
    "a groove alone": behind_cams(GROOVE, parts=["groove_cam.shaft"], places=[45.0]),
    "a wheel that does not turn evenly": {
        "drive": [{**ON_WHEEL, "speed_rpm": RPM, "mirror": True, **PLACED}],
        "crank": [crank("arm", "pair.wheel2", 70.0)],
        "mass": [mass("arm", 0.3, 20, -12)],
        "rotor": [rotor(["arm", "pair.wheel2"], [40.0, 160.0])],
    },
}


def machine(tables: dict[str, Any], **changes: Any) -> Any:
    return gc.build(gc.design({"kind": "mechanism", "name": "m", **tables, **changes}))


def turn_of(result: Any, shaft: str) -> Any:
    """The turn of a shaft in the machine, and the axis about which it turns."""
    return lambda q: result.linkage.track(shaft, np.asarray(q), 0).c[0]


def points_of(result: Any) -> list[Point]:
    """Masses of the parts of a rotor in space, each from its table or its polygon."""
    design, found = result.design, []
    (spec,) = design.rotor
    for name, z in zip(spec.parts, spec.places, strict=True):
        if name.partition(".")[0] in {one.name for one in design.drive}:
            found += _made(result, name, z)
            continue
        own = next(one for one in design.crank if one.name == name)
        where = axis_of(result, own.on)
        for one in (one for one in design.mass if one.of == name):
            place = complex(*one.at) * np.exp(1j * (own.angle or 0.0))
            found.append(Point(one.mass, turning(result, own.on, where, place), z))
    return found


def _made(result: Any, name: str, z: float) -> list[Point]:
    """Wheel or cams of a drive: their own frames are turned, mirrored and moved by its keys."""
    owner, _, word = name.partition(".")
    number = next(k for k, one in enumerate(result.design.drive) if one.name == owner)
    drive, own = result.design.drive[number], result.drives[number].result
    side, parts = -1.0 if drive.mirror else 1.0, own.parts
    if word.startswith("wheel"):
        parts = [parts[int(word[-1]) - 1]]
    gap = drive.cam.cam.thickness + drive.cam.cam.gap if len(parts) > 1 else 0.0
    where, around = axis_of(result, name), np.exp(1j * drive.turn)
    return [
        Point(
            kg,
            turning(result, name, where, around * (np.conj(at) if drive.mirror else at)),
            z + side * (height + number * gap),
        )
        for number, part in enumerate(parts)
        for kg, at, height in prisms(part, DENSITY)
    ]


def turning(result: Any, shaft: str, axis: complex, place: complex) -> Any:
    turn = turn_of(result, shaft)
    return lambda q: axis + place * np.exp(1j * turn(q))


def axis_of(result: Any, shaft: str) -> complex:
    return complex(result.linkage.track(f"{shaft}.center", np.zeros(1), 0).c[0][0])


def weights_of(result: Any, facts: Any, swapped: bool = False) -> list[Point]:
    """The weights that the study tells, as points at their radius."""
    (spec,) = result.design.rotor
    first, found = spec.parts[0], []
    drives = {one.name: one for one in result.design.drive}
    if first.partition(".")[0] in drives:
        shaft, start = first, drives[first.partition(".")[0]].turn
    else:
        own = next(one for one in result.design.crank if one.name == first)
        shaft, start = own.on, own.angle or 0.0
    axis = axis_of(result, shaft)
    for number, z in enumerate(reversed(spec.planes) if swapped else spec.planes):
        one = f"balance.rotors.{spec.name}.weights.{number}"
        way = np.exp(1j * (np.radians(facts[f"{one}.angle_deg"]) + start))
        path = turning(result, shaft, axis, spec.radius * way)
        found.append(Point(facts[f"{one}.mass_kg"], path, z))
    return found


def sizes(points: list[Point], q: Any) -> tuple[float, float]:
    """The largest force, N, and the largest couple across the axis, N mm."""
    found = shaken(points, q, SPEED, ABOUT)
    return float(np.abs(found[:, :2]).max()), float(np.abs(found[:, 3:5]).max())


@pytest.mark.parametrize("name", ROTORS)
def test_the_weights_leave_neither_force_nor_couple(name: str) -> None:
    """By Newton's and Euler's equations of points in space, from places alone."""
    result = machine(ROTORS[name])
    facts = result.study("balance").facts
    q = np.linspace(0.1, 6.2, 41)
    own, weights = points_of(result), weights_of(result, facts)
    force, couple = sizes(own, q)
    assert force > 5.0
    assert couple > 200.0
    left = sizes([*own, *weights], q)
    # polygons are within 0.01 mm of what has a density
    near = 1e-7 if name == "three cranks" else 2e-4
    assert left[0] < near * force
    assert left[1] < near * couple
    changed = sizes([*own, *weights_of(result, facts, swapped=True)], q)
    assert changed[0] < near * force
    assert changed[1] > 0.1 * couple


@pytest.mark.parametrize("name", ROTORS)
def test_forces_of_the_weights_are_their_largest(name: str) -> None:
    result = machine(ROTORS[name])
    facts = result.study("balance").facts
    q = np.linspace(0.0, 2.0 * pi, 4001) + 1e-5
    for number, one in enumerate(weights_of(result, facts)):
        found = facts[f"balance.rotors.shaft.weights.{number}.force_n"]
        size = 1e-3 * one.mass * np.abs(acceleration(one.path, q, SPEED)).max()
        assert found == pytest.approx(size, rel=2e-5)
    assert facts["balance.rotors.shaft.frame"] == result.design.rotor[0].parts[0]


def test_facts_of_three_cranks() -> None:
    result = machine(THREE)
    facts = result.study("balance").facts["balance.rotors.shaft"]
    first, second = facts["weights"]
    for one, known in ((first, -1.7 - 5.4125j), (second, 1.95 + 0.6625j)):
        agree(one["unbalance_kg_mm"], abs(known))
        agree(one["angle_deg"], np.degrees(np.angle(known)) % 360.0)
        agree(one["mass_kg"], abs(known) / 60.0)
        agree(one["force_n"], 1e-3 * abs(known) * SPEED**2)
    assert [first["place_mm"], second["place_mm"]] == PLANES
    agree(facts["static_kg_mm"], abs(-0.25 + 4.75j))
    agree(facts["static_angle_deg"], np.degrees(np.angle(-0.25 + 4.75j)))
    couple = 100.0 * (-1.95 - 0.6625j) - 100.0 * (1.7 + 5.4125j)
    agree(facts["couple_kg_mm2"], abs(couple))
    agree(facts["couple_angle_deg"], np.degrees(np.angle(couple)) % 360.0)


def test_a_rotor_without_a_radius_has_no_masses() -> None:
    own = {k: v for k, v in THREE["rotor"][0].items() if k != "radius_mm"}
    facts = machine(THREE, rotor=[own]).study("balance").facts
    assert facts["balance.rotors.shaft.weights.0.unbalance_kg_mm"] > 5.0
    assert "balance.rotors.shaft.weights.0.mass_kg" not in facts


def test_the_frame_is_that_of_the_first_part() -> None:
    """Behind a crank 70 deg ahead all angles are 70 deg less."""
    ahead = [crank("a"), {**crank("b", angle=70.0)}, crank("c")]
    found = []
    for first in ("a", "b"):
        parts = [first, *({"a", "b", "c"} - {first})]
        places = [{"a": 40.0, "b": 110.0, "c": 180.0}[one] for one in parts]
        tables = {**THREE, "crank": ahead, "rotor": [rotor(parts, places)]}
        facts = machine(tables).study("balance").facts
        found.append(facts["balance.rotors.shaft.weights.0.angle_deg"])
    assert (found[0] - found[1]) % 360.0 == pytest.approx(70.0)


def test_what_is_balanced_needs_no_weights() -> None:
    both = {"crank": [crank("a"), crank("b", angle=180.0)], "drive": [MOTOR]}
    masses = [mass("a", 0.3, 21, 7), mass("b", 0.3, 21, 7)]
    facts = machine({**both, "mass": masses, "rotor": [rotor(["a", "b"], [70, 70])]})
    found = facts.study("balance").facts["balance.rotors.shaft"]
    assert found["static_kg_mm"] == found["couple_kg_mm2"] == 0.0
    assert [one["unbalance_kg_mm"] for one in found["weights"]] == [0.0, 0.0]
    facts = machine({**both, "mass": masses, "rotor": [rotor(["a", "b"], [70, 170])]})
    found = facts.study("balance").facts["balance.rotors.shaft"]
    assert found["static_kg_mm"] == 0.0
    agree(found["couple_kg_mm2"], 100.0 * 0.3 * abs(21 + 7j))


def test_the_shaking_force_is_without_the_weights() -> None:
    plain, whole = (machine(THREE, **own).study("balance") for own in ({"rotor": []}, {}))
    assert [*plain.columns] == [*whole.columns]
    for name, values in plain.columns.items():
        assert np.array_equal(values, whole.columns[name])
    assert "balance.rotors" not in plain.facts


def test_a_note_tells_of_rotors_that_nothing_balances() -> None:
    codes = [(one.code, one.where) for one in machine(THREE).checked]
    assert ("loads-unused", "rotor") in codes
    studied = machine(THREE, output={"studies": ["balance"]})
    assert "loads-unused" not in [one.code for one in studied.checked]


def edited(**changes: Any) -> dict[str, Any]:
    return {**THREE, "rotor": [rotor(["a", "b"], [40, 110]) | changes]}


WITH_ROCKER = {
    "joint": [{"name": "D", "at_mm": [110, 0]}],
    "dyad": [{"type": "RRR", "from": "a_pin", "to": "D", "joint": "C",
              "members": ["coupler", "rocker"], "lengths_mm": [120, 90]}],
    "guide": [{"name": "bed", "at_mm": [0, -200]}],
}  # fmt: skip

WRONG: dict[str, tuple[dict[str, Any], str, str]] = {
    "unknown": (edited(parts=["a", "bb"]), "rotor[0].parts[1]", "nothing has this name"),
    "a joint": (edited(parts=["a", "b_pin"]), "rotor[0].parts[1]", "is a joint"),
    "lengths": (edited(places_mm=[1]), "rotor[0].places_mm", "has 1 for 2 parts"),
    "planes": (edited(planes_mm=[20, 20]), "rotor[0].planes_mm", "is in the place of"),
    "near planes": (edited(planes_mm=[20, 20.0001]), "rotor[0].planes_mm", "0.001 mm apart"),
    "a part twice": (edited(parts=["a", "a"]), "rotor[0].parts", "listed twice"),
    "no name": (edited(name="my shaft"), "rotor[0].name", "is no name"),
    "names twice": (
        {**THREE, "rotor": 2 * [rotor(["a"], [40])]},
        "rotor[1].name",
        "given twice, first by rotor[0].name",
    ),
    "three planes": (edited(planes_mm=[20, 40, 60]), "rotor[0].planes_mm", "a list of 2"),
    "no parts": (edited(parts=[], places_mm=[]), "rotor[0].parts", ""),
    "no radius": (edited(radius_mm=0), "rotor[0].radius_mm", ""),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_a_file_must_not_say(name: str) -> None:
    tables, key, words = WRONG[name]
    with pytest.raises(gc.DesignError) as caught:
        machine(tables)
    assert any(str(one.key).startswith(key) for one in caught.value.problems)
    assert words in str(caught.value)


def with_rocker(parts: list[str], *more: dict[str, Any]) -> dict[str, Any]:
    masses = [*THREE["mass"], mass("rocker", 1, 20, 0), mass("coupler", 1, 20, 0)]
    own = rotor(parts, [10.0 * k for k in range(len(parts))])
    return {**THREE, **WITH_ROCKER, "mass": [*masses, *more], "rotor": [own]}


STUDIED: dict[str, tuple[dict[str, Any], int, str]] = {
    "no fixed hinge": (with_rocker(["a", "coupler"]), 1, "no member about a fixed hinge"),
    "the shaft itself": (edited(parts=["motor", "b"]), 0, "no member about a fixed hinge"),
    "a rocker": (with_rocker(["a", "rocker"]), 1, "does not turn with a about one axis"),
    "another axis": (
        {
            **edited(parts=["a", "b"]),
            "drive": [MOTOR, {"name": "beside", "even": True, "at_mm": [50, 0]}],
            "crank": [crank("a"), crank("b", "beside"), crank("c")],
        },
        1,
        "does not turn with a about one axis",
    ),
    "another turn": (
        {
            **edited(parts=["a", "b"]),
            "drive": [MOTOR, {"name": "back", "even": True, "ratio": -1}],
            "crank": [crank("a"), crank("b", "back"), crank("c")],
        },
        1,
        "does not turn with a about one axis",
    ),
    "no mass": ({**edited(), "mass": [mass("a", 1, 2, 3)]}, 1, "b has no mass"),
    "only inertia": (
        {**edited(), "mass": [mass("a", 1, 2, 3), {"of": "b", "inertia_kg_m2": 1}]},
        1,
        "b has no mass",
    ),
    "a mass elsewhere": (
        with_rocker(["a", "b"], {"of": "b", "mass_kg": 1, "center": "C"}),
        1,
        "a centre of mass of b does not turn with it",
    ),
    "a wheel without density": (
        {
            "drive": [{"name": "pair", "pair": PAIR, "speed_rpm": RPM}],
            "crank": [crank("a", "pair.wheel2")],
            "mass": [mass("a", 1, 2, 3)],
            "rotor": [rotor(["a", "pair.wheel2"], [0, 20])],
        },
        1,
        "no wheel or cam of a density",
    ),
}


@pytest.mark.parametrize("name", STUDIED)
def test_what_is_no_rotor(name: str) -> None:
    tables, place, words = STUDIED[name]
    result = machine(tables)
    with pytest.raises(gc.DesignError) as caught:
        result.study("balance")
    (problem,) = caught.value.problems
    assert problem.key == f"rotor[0].parts[{place}]"
    assert words in problem.message
    assert problem.allowed


def test_a_rocker_is_a_rotor_of_its_own() -> None:
    """Its largest force is that of swinging: across and along its arm."""
    tables = with_rocker(["rocker"])
    result = machine(tables)
    facts = result.study("balance").facts
    q = np.linspace(0.0, 2.0 * pi, 4001)
    turn = result.linkage.real_track("rocker.angle", q, 2).derivatives()
    size = 1e-3 * 20.0 * SPEED**2 * np.abs(1j * turn[2] - turn[1] ** 2).max()
    both = [facts[f"balance.rotors.shaft.weights.{k}.force_n"] for k in (0, 1)]
    assert abs(both[0] - both[1]) == pytest.approx(size, rel=1e-6)


def test_the_console_tells_both_weights(tmp_path: Any, capsys: pytest.CaptureFixture[str]) -> None:
    text = toml_text({"kind": "mechanism", "name": "m", **THREE})
    (tmp_path / "m.toml").write_text(text, "utf-8")
    assert main(["balance", str(tmp_path / "m.toml"), "-o", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    for place, size in ((20, "5.673"), (220, "2.059")):
        assert f"rotor shaft: weight at {place} mm, mass times distance" in told
        assert f"{size} kg mm" in told
    assert "deg in the frame of a" in told
