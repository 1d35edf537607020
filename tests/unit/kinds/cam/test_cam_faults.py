"""What is wrong in the design file of a cam is told at once, each fault with its place."""

from __future__ import annotations

import re

import pytest

from gearcam.base.errors import DesignError
from gearcam.designs import design, document_of
from helpers_files import FLAT, RISE, ROLLER, SWINGING, changed, only, problems, read


@pytest.mark.parametrize(
    ("old", "new", "line", "key", "words"),
    [
        ('"rise"', '"raise"', 5, "motion[0].type", "raise.* is not a phase.*\n.*mean rise"),
        ('type = "rise"\n', "", 4, "motion[0].type", "is missing.*\n.*\n.*rise"),
        ('"cycloidal"', '"cycloid"', 6, "motion[0].law", "not a law.*\n.*mean cycloidal"),
        ('law = "cycloidal"\n', "", 4, "motion[0].law", "is missing.*\n.*\n.*cycloidal"),
        ('law = "cycloidal"', "law = 3", 6, "motion[0].law", "3 is not a law"),
        ("lift_mm = 10", "lift_mm = 10\nq = 0.5", 9, "motion[0].q", "with law = .constant-acc"),
        (
            "angle_deg = 90\n[",
            "angle_deg = 90\nlaw = 1\n[",
            12,
            "motion[1].law",
            "of type .rise. o",
        ),
        ("angle_deg = 90\n[", "angle_deg = 90\nlift_mm = 1\n[", 12, "motion[1].lift_mm", "of type"),
        ("angle_deg = 90\n", "", 4, "motion[0].angle_deg", "is missing"),
        ("angle_deg = 90", "angle_deg = 0", 7, "motion[0].angle_deg", "out of range"),
        ("angle_deg = 90", 'angle_deg = "90"', 7, "motion[0].angle_deg", "without quotes"),
        ("angle_deg = 90", 'angle_deg = "rset"', 7, "motion[0].angle_deg", "mean rest"),
        ("angle_deg = 90", 'angle_deg = "all"', 7, "motion[0].angle_deg", '360 deg, or "rest"'),
        ("lift_mm = 10\n", "", 4, "motion[0].lift_mm", "is missing"),
        ("angle_deg = 90", "angle_deg = 80", 4, "motion", "take 350 deg.*\n.*would take 100 deg"),
        (
            RISE,
            'type = "dwell"\nangle_deg = 90\n',
            10,
            "motion[2].lift_mm",
            "nothing to return from",
        ),
        ("roller_radius_mm = 6\n", "", 20, "follower.roller_radius_mm", "missing for a roller"),
        (
            "_mm = 6",
            "_mm = 6\narm_mm = 9",
            24,
            "follower.arm_mm",
            "does not apply to a translating",
        ),
        (
            "_mm = 6",
            "_mm = 6\ndome_radius_mm = 9",
            24,
            "follower.dome_radius_mm",
            "does not apply to a roller fol",
        ),
        ("offset_mm", "ofset_mm", 24, "follower.ofset_mm", "mean offset_mm"),
        (
            "[cam]",
            "[cam]\nbase_radius_mm = 24",
            27,
            "cam.base_radius_mm",
            "is given beside prime_radius_mm",
        ),
        ("prime_radius_mm = 30", "", 26, "cam", "neither prime_radius_mm nor base_radius_mm"),
        (
            "prime_radius_mm = 30",
            "prime_radius_mm = 6",
            28,
            "cam.prime_radius_mm",
            "not larger than the follower",
        ),
        ('"disc"', '"disk"', 27, "cam.form", "mean disc"),
        ('"stl"', '"dxf"', 32, "output.files[1]", "listed twice"),
        ('"stl"', '"sld"', 32, "output.files[1]", "mean stl"),
        ("[output]", "[blank]\nbolts = 2\n[output]", 31, "blank.bolt_circle_mm", "missing beside"),
        ("[output]", "[blank]\nbolts = [2, 2]\n[output]", 32, "blank.bolts", "not a whole number"),
        ("[output]", "[blank]\nstop_pin_mm = 2\n[output]", 32, "blank.stop_pin_mm", "unknown key"),
        ("[output]", "[output]\nchord_tolerance_mm = 2", 32, "output.chord_tolerance_mm", "range"),
        ("[output]", "[output]\nphi1_deg = 2", 32, "output.phi1_deg", "unknown key"),
        ("[output]", "[limits]\nend_gap_deg = 2\n[output]", 32, "limits.end_gap_deg", "unknown"),
        ("[output]", "[rack]\n[output]", 31, "rack", "unknown table.*\n.*kind = .gear-pair"),
        ("[cam]", "[cam]\nlift_mm = 2", 27, "cam.lift_mm", r"under \[\[motion\]\] of type .rise"),
        ('"cam"', '"cams"', 1, "kind", "mean kind = .cam."),
        ("[follower]", "[folower]", 20, "folower", "mean follower"),
    ],
)
def test_what_is_wrong_is_told_where_it_stands(
    old: str, new: str, line: int, key: str, words: str
) -> None:
    found = {problem.key: problem for problem in problems(changed(old, new))}
    assert key in found, list(found)
    assert found[key].line == line
    assert re.search(words, str(found[key])), str(found[key])


def test_the_rest_of_the_turn_in_a_file() -> None:
    rest = changed("angle_deg = 90", 'angle_deg = "rest"')
    assert document_of(read(rest))["motion"][0]["angle_deg"] == "rest"
    twice = only(changed("angle_deg = 90", 'angle_deg = "rest"', rest))
    assert (twice.key, twice.line, twice.value) == ("motion[1].angle_deg", 11, "rest")
    assert twice.allowed == "an angle: motion[0] already takes the rest"
    full = only(rest.replace("angle_deg = 90", "angle_deg = 120"))
    assert (full.key, full.line) == ("motion[0].angle_deg", 7)
    assert "take 360 deg, which leaves nothing" in full.message
    short = only(changed("angle_deg = 90", "angle_deg = 80"))
    assert 'or "rest" for one of them' in short.allowed


def test_lifts_are_of_the_followers_kind() -> None:
    found = problems(changed("lift_mm = 10", "lift_deg = 10"))
    assert [(one.line, one.key) for one in found] == [(8, "motion[0].lift_deg")]
    assert "10: wrong unit for the lift of a translating follower" in found[0].message
    assert (found[0].value, found[0].allowed) == (10, "lift_mm")
    found = problems(changed("lift_deg", "lift_mm", SWINGING))
    assert "wrong unit for the lift of an oscillating follower" in found[-1].message


def test_of_an_unknown_kind_no_lift_is_wrong() -> None:
    for text, motion in ((ROLLER, "translating"), (SWINGING, "oscillating")):
        assert only(changed(f'"{motion}"', '"sliding"', text)).key == "follower.motion"


def test_a_program_that_ends_elsewhere_is_refused() -> None:
    text = changed('"cycloidal"\nangle_deg = 90\n[', '"cycloidal"\nangle_deg = 90\nlift_mm = 9\n[')
    problem = only(text)
    assert (problem.key, problem.line) == ("motion", 4)
    assert "ends at a lift of 1 mm" in problem.message
    assert only(SWINGING.replace("return", "dwell").replace('law = "3-4-5"\n', "")).key == "motion"


@pytest.mark.parametrize(
    ("motion", "words"),
    [
        ("", "is missing"),
        ("motion = []", "the list is empty"),
        ("motion = 3", "3 is not a list of tables"),
        ("[motion]\ntype = 'dwell'", "single table"),
        ("motion = [3]", "3 is not a table"),
    ],
)
def test_motion_is_an_array_of_tables(motion: str, words: str) -> None:
    rest = ROLLER[ROLLER.index("[follower]") :]
    problem = only(f'kind = "cam"\nname = "x"\n{motion}\n{rest}')
    assert words in problem.message
    assert problem.key.startswith("motion")
    assert "rise" in problem.allowed


def test_what_a_law_finds_wrong_gets_its_place() -> None:
    problem = only(changed('law = "cycloidal"', 'law = "scca"\nb = 0.2\nc = 0.5\nd = 0.4'))
    assert problem.key.startswith("motion[0].")
    assert problem.line in (7, 8, 9)
    text = changed('law = "cycloidal"', 'law = "formula"\nformula = "sine(x)"')
    assert (only(text).key, only(text).line) == ("motion[0].formula", 7)


def test_parameters_of_an_unknown_law_are_not_blamed() -> None:
    text = changed('law = "cycloidal"', 'law = "polynomail"\nstart = [0]\nend = [0]')
    assert only(text).hint == "did you mean polynomial?"
    found = {problem.key for problem in problems(text.replace("start", "sides"))}
    assert found == {"motion[0].law", "motion[0].sides"}


def test_flat_followers_have_a_base_radius_and_give_no_tool_radius() -> None:
    assert read(FLAT).cam.base_radius == 30.0
    assert "no centre" in only(changed("base_radius", "prime_radius", FLAT)).message
    text = changed("offset_mm", "roller_radius_mm = 6\noffset_mm", ROLLER.replace("roller_r", "#"))
    found = only(text.replace('"roller"', '"flat"').replace("prime_radius", "base_radius"))
    assert (found.key, found.line) == ("follower.roller_radius_mm", 24)
    for kind in ("flat", "point"):
        text = changed('"stl"', '"tool-path"', FLAT).replace('"flat"', f'"{kind}"')
        problem = only(text)
        assert (problem.key, problem.line) == ("output.tool_radius_mm", 29)
        assert f"a {kind} follower has no radius" in problem.message
        assert read(text + "tool_radius_mm = 4\n").output.tool_radius == 4.0
    assert "tool-path" in read(changed('"stl"', '"tool-path"')).output.files


def test_all_errors_are_told_at_once_in_the_order_of_the_file() -> None:
    text = """\
kind = "cam"
name = "a/b"
[[motion]]
type = "rise"
law = "cycloid"
angle_deg = 400
lift_deg = 10
[[motion]]
type = "dwel"
[[motion]]
type = "return"
law = "polynomial"
angel_deg = 90
start = [0, "x"]
[follower]
type = "ball"
offset = 2
[cam]
prime_radius_mm = -3
thickness_mm = nan
[blank]
bolts = [1, 2]
keyways = 2
[output]
files = ["dxf", "dfx"]
dxf_curves = "splines"
dxf_version = "R12"
[limits]
pressure_angle_deg = "x"
[law]
"""
    assert [(problem.line, problem.key) for problem in problems(text)] == [
        (2, "name"),
        (5, "motion[0].law"),
        (6, "motion[0].angle_deg"),
        (7, "motion[0].lift_deg"),
        (9, "motion[1].type"),
        (13, "motion[2].angel_deg"),
        (14, "motion[2].start[1]"),
        (16, "follower.type"),
        (17, "follower.offset"),
        (19, "cam.prime_radius_mm"),
        (20, "cam.thickness_mm"),
        (22, "blank.bolts"),
        (23, "blank.keyways"),
        (25, "output.files[1]"),
        (27, "output.dxf_version"),
        (29, "limits.pressure_angle_deg"),
        (30, "law"),
    ]


def test_phases_that_can_be_read_are_judged_beside_those_that_cannot() -> None:
    found = {problem.key for problem in problems(changed("angle_deg = 90\nlift", "lift"))}
    assert found == {"motion[0].angle_deg"}
    mixed = changed('"dwell"', '"dwel"').replace("lift_mm", "lift_deg")
    assert {problem.key for problem in problems(mixed)} == {
        "motion[0].lift_deg",
        "motion[1].type",
    }


def test_a_form_of_another_kind_is_judged_as_such() -> None:
    found = problems(changed('"disc"', '"cylinder"'))
    assert "cam.outer_diameter_mm" in {one.key for one in found}
    (text,) = {str(one) for one in found if one.key == "cam.thickness_mm"}
    assert "does not apply to a cylinder cam" in text
    assert 'with cam.form = "disc"' in text


def test_keys_of_other_forms_are_reported_in_the_order_in_which_they_are_given() -> None:
    foreign = {"side": "front", "groove_depth_mm": 3, "run_in_mm": 2, "gap_mm": 1, "walls": "both"}
    document = document_of(read(ROLLER))
    document["cam"] |= foreign
    with pytest.raises(DesignError) as caught:
        design(document)
    assert [one.key for one in caught.value.problems] == [f"cam.{key}" for key in foreign]
