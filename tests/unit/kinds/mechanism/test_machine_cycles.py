"""After which turns a machine repeats, how far open drives turn, the side of knots."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from helpers_built import built
from helpers_pairs import PROFILES

FOUR_BAR: Any = gc.load(PROFILES / "four_bar.toml")
LIFT: Any = gc.load(PROFILES / "furnace_door_lift.toml")
DOOR: Any = gc.load(PROFILES / "furnace_door.toml")


def test_a_machine_with_one_change_point_repeats_after_two_turns() -> None:
    folding = {
        "crank[0].length_mm": 30, "joint[0].at_mm": [100, 0], "dyad[0].lengths_mm": [60, 70],
        "dyad[0].change": "motion", "output.outputs": ["C"],
    }  # fmt: skip
    result = gc.build(FOUR_BAR.with_(folding))
    assert result.linkage.span == pytest.approx((0.0, 4.0 * math.pi))
    table = result.motion(np.array([0.0, 2.0 * math.pi, 4.0 * math.pi]))
    # after one turn in the mirror image, after two back
    assert table["C_y_mm"] == pytest.approx([1, -1, 1] * table["C_y_mm"][:1])
    assert not {"velocity-jump", "acceleration-jump"} & {one.code for one in result.checked}
    kept = gc.build(FOUR_BAR.with_(folding | {"dyad[0].change": "branch"}))
    assert kept.linkage.span == pytest.approx((0.0, 2.0 * math.pi))


def test_a_slide_that_goes_through_its_change_point_has_both_strokes() -> None:
    # crank 30, rod 50, guide 20 above the shaft: 30 + 20 = 50 at one angle
    rod = {"type": "RRT", "from": "B", "to": "bed", "joint": "S", "members": ["rod", "ram"],
           "lengths_mm": [50, 0], "change": "motion"}  # fmt: skip
    design = FOUR_BAR.with_(
        {"crank[0].length_mm": 30, "guide": [{"name": "bed", "at_mm": [0, 20]}], "joint": [],
         "point": [], "dyad": [rod], "output.outputs": ["S"]}
    )  # fmt: skip
    farthest = math.sqrt(80.0**2 - 20.0**2)  # crank and rod in line, on either side
    assert gc.build(design).facts["outputs.S.stroke_mm"] == pytest.approx(2.0 * farthest)


def test_a_second_open_pair_does_not_turn_beyond_its_ends() -> None:
    two = [{"name": "pair", "pair": DOOR.to_dict()}, {"name": "two", "pair": DOOR.to_dict()}]
    assert gc.build(LIFT.with_({"drive": two, "compare": []})).linkage
    for changes, told in (
        ({"phase_deg": 40}, "from 40 to 211.65 deg"),
        ({"ratio": -1}, "from -171.65 to 0 deg"),
    ):
        late = LIFT.with_({"drive": [two[0], two[1] | changes], "compare": []})
        with pytest.raises(InfeasibleError, match=told):
            _ = gc.build(late).linkage


def test_an_even_shaft_goes_as_far_as_the_open_pair_in_whose_place_it_is() -> None:
    slow = DOOR.with_({"law.ratios": [0.5, 0.5, 1, 1], "law.driven_travel_deg": 150})
    result = gc.build(LIFT.with_({"drive[0].pair": slow.to_dict()}))
    (even,) = result.compared.values()
    assert even.linkage.span == pytest.approx((0.0, math.radians(150)))
    strokes = [one.facts["outputs.door.stroke_mm"] for one in (result, even)]
    assert strokes == pytest.approx([100.0 * math.radians(150)] * 2)


@pytest.mark.parametrize(("key", "value"), [("drive[0].ratio", 2), ("drive[0].phase_deg", 90)])
def test_what_has_no_effect_is_refused(key: str, value: float) -> None:
    with pytest.raises(DesignError, match="has no effect: the first drive is the master"):
        FOUR_BAR.with_({key: value})


def carrier(ratio: float) -> Any:
    """An arm of 60 mm on a carrier of 100 mm."""
    return gc.design({
        "kind": "mechanism", "name": "arms",
        "drive": [{"name": "m", "even": True}, {"name": "n", "even": True, "ratio": ratio}],
        "crank": [{"name": "carrier", "on": "m", "joint": "B", "length_mm": 100},
                  {"name": "arm", "on": "n", "at": "B", "joint": "P", "length_mm": 60}],
        "output": {"outputs": ["P"]},
    })  # fmt: skip


@pytest.mark.parametrize(("ratio", "turns"), [(-2.5, 2), (0.333333, 3), (1.75, 4), (-3.0, 1)])
def test_a_cycle_ends_after_the_denominator_of_a_ratio(ratio: float, turns: int) -> None:
    result = gc.build(carrier(ratio))
    assert result.linkage.span == pytest.approx((0.0, 2.0 * math.pi * turns))
    q = np.linspace(0.0, 2.0 * math.pi * turns, 50)
    exact = round(ratio * turns) / turns
    place = 100.0 * np.exp(1j * q) + 60.0 * np.exp(1j * exact * q)
    found = result.motion(q)
    assert found["P_x_mm"] == pytest.approx(place.real, abs=1e-9)
    assert found["P_y_mm"] == pytest.approx(place.imag, abs=1e-9)


def test_the_fraction_of_a_ratio_is_the_nearest_in_lowest_terms() -> None:
    exact = {Fraction(k, n) for n in range(1, 13) for k in range(-3 * n, 3 * n + 1) if k}
    for one in exact:
        made = gc.MachineDrive(name="m", even=True, ratio=float(one) + 3e-7)
        assert made.fraction == (one.numerator, one.denominator)
        assert made.rate == float(one)


def test_a_ratio_that_is_no_fraction_is_refused_with_one_that_is() -> None:
    with pytest.raises(DesignError, match="which is 7/3"):
        carrier(2.3456)


def test_the_length_of_a_guide_is_not_ignored() -> None:
    """An offset guide is the block's length, at a right angle."""
    tables = {"kind": "mechanism", "name": "m", "drive": [{"name": "motor", "even": True}],
              "joint": [{"name": "O", "at_mm": [100, 0]}],
              "crank": [{"name": "c", "on": "motor", "joint": "B", "length_mm": 40}]}  # fmt: skip
    block = {"type": "RTR", "from": "O", "to": "B", "joint": "A", "members": ["lever", "shoe"],
             "lengths_mm": [0, 15], "beta_deg": 90}  # fmt: skip
    made = gc.build(gc.design({**tables, "dyad": [block]}))
    known = made.linkage.at(np.array([0.3, 2.0]), 0)
    # the pin runs on a line 15 mm beside the hinge
    way = known.place("B") - 100.0
    across = np.imag(way * np.conj(known.direction("lever")))
    assert np.abs(across) == pytest.approx(15.0)
    with pytest.raises(DesignError, match="lever is the guide: its length has no effect"):
        gc.design({**tables, "dyad": [block | {"lengths_mm": [30, 15]}]})


def test_a_slide_and_a_later_drive_take_no_keys_in_vain() -> None:
    drives = [{"name": "motor", "even": True}, {"name": "push", "slide": "sin(q)", "ratio": 2}]
    with pytest.raises(DesignError, match="its formula is in the master's q"):
        FOUR_BAR.with_({"drive": drives})
    drives[1] = {"name": "other", "even": True, "speed_rpm": 5}
    with pytest.raises(DesignError, match="the speed is that of the first drive"):
        FOUR_BAR.with_({"drive": drives})


def test_motion_is_not_given_beyond_an_open_range() -> None:
    door = built(PROFILES / "furnace_door_hinged.toml")
    assert len(door.output("door.angle", [0.0, math.radians(171.65)])) > 1
    with pytest.raises(DesignError, match="beyond the master's range"):
        door.output("door.angle", [3.0])


@pytest.mark.parametrize(("ratio", "expected"), [(1, [20, 0, -20, 0]), (-1, [0, 20, 0, -20])])
def test_at_a_knot_the_values_after_it_are_given(ratio: int, expected: list[float]) -> None:
    """A harmonic rise of h in a quarter turn begins with h*pi^2/(2*beta^2) and ends with -that."""
    h = 20.0 * 2.0 / math.pi**2 * (0.5 * math.pi) ** 2
    motion = [
        {"type": "rise", "law": "harmonic", "angle_deg": 90, "lift_mm": h},
        {"type": "dwell", "angle_deg": 90},
        {"type": "return", "law": "harmonic", "angle_deg": 90},
        {"type": "dwell", "angle_deg": 90},
    ]
    cam = {
        "kind": "cam", "motion": motion, "follower": {"type": "roller", "roller_radius_mm": 8},
        "cam": {"prime_radius_mm": 60, "thickness_mm": 10},
    }  # fmt: skip
    design = FOUR_BAR.with_(
        {"drive": [{"name": "motor", "even": True}, {"name": "cam", "cam": cam, "ratio": ratio}],
         "slide": [{"name": "tool", "on": "cam.follower", "joint": "T"}],
         "output.outputs": ["tool"]}
    )  # fmt: skip
    found = gc.build(design).motion(np.radians([0.0, 90.0, 180.0, 270.0]))
    assert found["tool_mm_per_rad2"] == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("beside", [1e-4, 1e-2, 1.0])
def test_a_guide_that_turns_fast_beside_its_pivot_is_seen(beside: float) -> None:
    """A pin at 60 mm, the pivot a little outside its circle: asin(60/(60 + e)) to both sides."""
    block = {"type": "RTR", "from": "D", "to": "B", "joint": "C", "members": ["rocker", "block"]}
    design = FOUR_BAR.with_(
        {"crank[0].length_mm": 60, "joint[0].at_mm": [0, -60 - beside], "dyad": [block],
         "point": [], "output.outputs": ["rocker.angle"]}
    )  # fmt: skip
    facts = gc.build(design).facts
    swing = 2.0 * math.degrees(math.asin(60.0 / (60.0 + beside)))
    assert facts["outputs.rocker.stroke_deg"] == pytest.approx(swing, rel=1e-9)
    # r/(d - r) at the nearest place
    assert facts["outputs.rocker.velocity_rad_per_rad"] == pytest.approx(-60.0 / beside, rel=1e-6)
