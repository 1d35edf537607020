"""The table [blank]: one value for both wheels or two, and what contradicts itself is refused."""

from __future__ import annotations

import math
from typing import Any

import pytest

from gearcam.base.errors import DesignError
from gearcam.base.quantities import LENGTH
from gearcam.designs import loads
from gearcam.kinds.gear_pair.design import GearPairDesign
from helpers_files import problems

GOOD = """\
kind = "gear-pair"
name = "good"
[law]
type = "constant"
[pair]
module_mm = 2
teeth = [40, 40]
[output]
files = ["csv"]
[blank]
"""


def read(blank: str) -> GearPairDesign:
    design = loads(GOOD + blank)
    assert isinstance(design, GearPairDesign)
    return design


def test_one_value_holds_for_both_wheels() -> None:
    keyway = "keyway_angle_deg = 90\nkeyway_depth_mm = 2\nkeyway_width_mm = 5\n"
    bolts = "bolts = 3\nbolt_circle_mm = 40\nbolt_diameter_mm = 5\n"
    one = read("bore_diameter_mm = 20\n" + keyway + bolts).blank
    assert one.bore_diameter == (20.0, 20.0)
    assert one.keyway_angle == pytest.approx((math.pi / 2, math.pi / 2))
    assert one.bolts == (3, 3)
    two = read("bore_diameter_mm = [20, 0]\ndensity_kg_m3 = [7850, 1200]").blank
    assert two.wheel(1).bore == 20.0
    assert two.wheel(2).bore == 0.0
    assert two.wheel(2).density == 1200.0


@pytest.mark.parametrize(
    ("text", "key", "words"),
    [
        ('bore_diameter_mm = "20"', "blank.bore_diameter_mm", "not a number"),
        ("bore_diameter_mm = -1", "blank.bore_diameter_mm", "out of range"),
        ("bore_diameter_mm = [20, -1]", "blank.bore_diameter_mm[1]", "out of range"),
        ("bore_diameter_mm = [20]", "blank.bore_diameter_mm", "has 1 value"),
        ("bore_diameter_mm = [1, 2, 3]", "blank.bore_diameter_mm", "has 3 values"),
        ("bore_diameter_mm = []", "blank.bore_diameter_mm", "empty"),
        ("bolts = 2.5", "blank.bolts", "not a whole number"),
        ("bores_mm = 2", "blank.bores_mm", "unknown key"),
        ("timing_marks = 1", "blank.timing_marks", "not true or false"),
    ],
)
def test_wrong_values_are_named(text: str, key: str, words: str) -> None:
    (problem,) = problems(GOOD + text)
    assert problem.key == key
    assert words in problem.message
    assert problem.allowed
    assert problem.line == 11


KEYED = "bore_diameter_mm = 20\nkeyway_width_mm = {}\nkeyway_depth_mm = {}\n"


@pytest.mark.parametrize(
    ("text", "key", "words"),
    [
        ("keyway_width_mm = 5\nkeyway_depth_mm = 2", "blank.bore_diameter_mm", "missing beside"),
        ("bore_flat_mm = 5", "blank.bore_diameter_mm", "missing beside bore_flat_mm"),
        ("bore_diameter_mm = 20\nkeyway_width_mm = 5", "blank.keyway_depth_mm", "missing beside"),
        ("bore_diameter_mm = 20\nkeyway_depth_mm = 2", "blank.keyway_width_mm", "missing beside"),
        (KEYED.format(20, 2), "blank.keyway_width_mm", "as wide as the bore"),
        (KEYED.format(1e-300, 2), "blank.keyway_width_mm", "is too small"),
        (KEYED.format(5, 0.99 * LENGTH.least), "blank.keyway_depth_mm", "is too small"),
        (f"bore_diameter_mm = {0.99 * LENGTH.least}", "blank.bore_diameter_mm", "is too small"),
        ("tip_rounding_mm = 1e-300", "blank.tip_rounding_mm", "is too small"),
        (
            KEYED.format(5, 2) + "bore_flat_mm = 18",
            "blank.bore_flat_mm",
            "given beside keyway_width_mm = 5",
        ),
        ("bore_diameter_mm = 20\nbore_flat_mm = 10", "blank.bore_flat_mm", "not within the bore"),
        ("bore_diameter_mm = 20\nbore_flat_mm = 20", "blank.bore_flat_mm", "not within the bore"),
        ("bolts = 4\nbolt_diameter_mm = 5", "blank.bolt_circle_mm", "missing beside bolts"),
        ("bolts = 4\nbolt_circle_mm = 40", "blank.bolt_diameter_mm", "missing beside bolts"),
        ("hub_front_mm = 5", "blank.hub_diameter_mm", "missing beside"),
        ("bolt_circle_mm = 20\nbolt_diameter_mm = 3.2", "blank.bolts", "beside bolt_circle_mm"),
        ("bolt_angle_deg = 20", "blank.bolts", "missing beside bolt_angle_deg"),
        ("bolts = 0\nbolt_circle_mm = 20", "blank.bolts", "missing beside bolt_circle_mm"),
        ("rim_mm = 5", "blank.lightening_holes", "missing beside rim_mm"),
        ("web_mm = 5", "blank.lightening_holes", "missing beside web_mm"),
        ("bore_diameter_mm = 9\nkeyway_angle_deg = 5", "blank.keyway_width_mm", "missing beside"),
        ("timing_marks = false\nmark_diameter_mm = 1", "blank.mark_diameter_mm", "timing_marks"),
        ("bore_diameter_mm = 9\nclearance_bores = true", "blank.clearance_mm", "missing beside"),
        ("clearance_mm = 0.1\nclearance_bores = true", "blank.bore_diameter_mm", "beside"),
        ("hub_diameter_mm = 30", "blank.hub_front_mm", "missing beside hub_diameter_mm"),
        (
            "bore_diameter_mm = 20\nhub_diameter_mm = 20\nhub_back_mm = 5",
            "blank.hub_diameter_mm",
            "as large as the hub",
        ),
        ('keyway = "DIN 6885"', "blank.bore_diameter_mm", "missing beside keyway"),
        ('bore_diameter_mm = 5.9\nkeyway = "DIN 6885"', "blank.keyway", "bore of 5.9 mm"),
        ('bore_diameter_mm = 231\nkeyway = "DIN 6885"', "blank.keyway", "bore of 231 mm"),
        (KEYED.format(5, 2) + 'keyway = "DIN 6885"', "blank.keyway", "beside keyway_width_mm = 5"),
        (
            'bore_diameter_mm = 20\nkeyway = "DIN 6885"\nbore_flat_mm = 18',
            "blank.bore_flat_mm",
            'given beside keyway = "DIN 6885"',
        ),
        ('shaft = "TT"\nbore_diameter_mm = 6', "blank.shaft", "beside bore_diameter_mm = 6"),
        ('shaft = "servo"', "blank.shaft", "not one of the allowed words"),
        ('shaft = ["TT", "n20"]', "blank.shaft[1]", "not one of the allowed words"),
        ("shaft = 5", "blank.shaft", "not one of the words allowed"),
        ("bore_across_flats_mm = 3", "blank.bore_diameter_mm", "missing beside"),
        (
            "bore_diameter_mm = 5\nbore_across_flats_mm = 5",
            "blank.bore_across_flats_mm",
            "as wide as the bore",
        ),
        (
            "bore_diameter_mm = 5\nbore_across_flats_mm = 4\nbore_flat_mm = 4",
            "blank.bore_across_flats_mm",
            "given beside bore_flat_mm = 4",
        ),
        (
            'shaft = "NEMA 23"\nhub_diameter_mm = 6\nhub_front_mm = 3',
            "blank.hub_diameter_mm",
            "as large as the hub",
        ),
        (
            'bore_diameter_mm = 25\nkeyway = "DIN 6885"\nhub_diameter_mm = 31\nhub_back_mm = 3',
            "blank.hub_diameter_mm",
            "as large as the hub",
        ),
    ],
)
def test_contradictions_are_refused_by_reading(text: str, key: str, words: str) -> None:
    (problem,) = problems(GOOD + text)
    assert problem.key == key
    assert words in problem.message
    assert problem.allowed


def test_screws_that_fit_are_named() -> None:
    text = 'shaft = "N20"\nset_screw = "M5"\nhub_diameter_mm = 9\nhub_front_mm = 9'
    (problem,) = problems(GOOD + text)
    assert problem.allowed == '"M2", "M2.5", "M3", "#4-40", "#6-32"'


def test_a_shaft_is_a_bore_for_what_belongs_to_one() -> None:
    wide = "clearance_mm = 0.1\nclearance_bores = true\n"
    blank = read('shaft = ["28BYJ-48", "none"]\nkeyway_angle_deg = 30\n' + wide).blank
    assert [blank.wheel(k).bore for k in (1, 2)] == [5.0, 0.0]
    assert (
        read('bore_diameter_mm = [20, 0]\nkeyway = ["DIN 6885", "none"]').blank.wheel(2).bore == 0
    )
    (problem,) = problems(GOOD + 'shaft = "none"\n' + wide)
    assert "missing beside clearance_bores" in problem.message


def test_two_values_are_judged_one_by_one() -> None:
    (problem,) = problems(GOOD + "bore_diameter_mm = [20, 10]\nbore_flat_mm = [18, 18]\n")
    assert problem.key == "blank.bore_flat_mm[1]"
    assert problem.value == 18
    assert "above 5 and below the bore's 10 mm" in problem.allowed


@pytest.mark.parametrize(
    ("change", "good"),
    [
        ({"bore_diameter": (20.0, 20.0), "bore_flat": (18.0, 0.0)}, True),
        ({"bore_diameter": 20.0}, True),
        ({"bore_diameter": (20.0, 20.0), "bore_flat": (21.0, 0.0)}, False),
    ],
)
def test_a_blank_made_in_python_meets_the_same_rules(change: dict[str, Any], good: bool) -> None:
    from dataclasses import replace

    from gearcam.parts.blank import Blank

    design = read("")
    if good:
        made = replace(design, blank=Blank(**change))
        assert made.blank.wheel(2).bore == 20.0
    else:
        with pytest.raises(DesignError, match="not within the bore"):
            replace(design, blank=Blank(**change))


@pytest.mark.parametrize(
    ("both", "one", "size"),
    [
        ("bore_diameter_mm = 8", 'shaft = ["TT", "none"]', "[0, 8]"),
        ('bore_diameter_mm = "8 H7"', 'shaft = ["none", "TT"]', '["8 H7", 0]'),
        ('bore_diameter_mm = 12\nkeyway = "DIN 6885"', "bore_flat_mm = [0, 11]",
         '["DIN 6885", "none"]'),
    ],
)  # fmt: skip
def test_what_one_wheel_excludes_is_left_to_the_other_as_the_message_says(
    both: str, one: str, size: str
) -> None:
    (problem,) = problems(GOOD + f"{one}\n{both}")
    remedy, _, rest = problem.allowed.partition(" for the wheel without ")
    assert remedy == f"{both.splitlines()[-1].partition(' =')[0]} = {size}"
    assert rest.startswith(one.partition(" =")[0])
    read(f"{one}\n{both.replace(both.splitlines()[-1], remedy)}")


def test_a_wheel_that_has_both_gets_no_such_remedy() -> None:
    (problem,) = problems(GOOD + 'shaft = "TT"\nbore_diameter_mm = 8')
    assert "[" not in problem.allowed
