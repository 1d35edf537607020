"""What is refused of cylinder cams, and that the values that refusals name can be built."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from helpers_pairs import PROFILES
from helpers_sampling import few

DESIGN = gc.load(PROFILES / "cylinder_cam.toml").with_({"output.files": ["csv"]})
SWINGING = DESIGN.with_(
    {
        "motion": [
            {"type": "rise", "law": "modified-sine", "angle_deg": 150, "lift_deg": 30},
            {"type": "return", "law": "modified-sine", "angle_deg": "rest"},
        ],
        "follower": {"motion": "oscillating", "roller_radius_mm": 11, "arm_mm": 120},
    }
)


@pytest.mark.parametrize(
    ("design", "key", "value", "words"),
    [
        (DESIGN, "cam.length_mm", 80.0, "leaves the upper face"),
        (DESIGN, "cam.lowest_mm", 8.0, "leaves the lower face"),
        (DESIGN, "follower.roller_length_mm", 20.0, "deeper than the groove"),
        (SWINGING, "follower.pivot_distance_mm", 90.0, "does not stay on the middle"),
        (SWINGING, "follower.pivot_distance_mm", 140.0, "does not stay on the middle"),
    ],
)
def test_the_nearest_value_is_named_and_can_be_built(
    design: gc.Design, key: str, value: float, words: str
) -> None:
    with pytest.raises(InfeasibleError, match=words) as caught:
        _ = gc.build(design.with_({key: value})).cam
    assert caught.value.where.endswith(key)
    near = caught.value.adjustments[0].near
    assert near[key] != value
    _ = gc.build(design.with_(near)).cam


@pytest.mark.parametrize("design", [DESIGN, SWINGING], ids=["straight", "on an arm"])
@pytest.mark.parametrize(
    "more",
    [
        {},
        {"cam.roller_clearance_mm": 0.4},
        {"cam.floor_clearance_mm": 3},
        {"follower.roller_length_mm": 9, "cam.floor_clearance_mm": 0},
        {"cam.walls": "upper", "cam.roller_clearance_mm": 0},
    ],
    ids=["groove", "wide", "high floor", "short roller", "one wall"],
)
def test_a_cone_whose_tip_lies_in_the_groove(design: gc.Design, more: dict[str, Any]) -> None:
    """The wall above the roller stays above the wall below it down to the floor."""
    steep = design.with_({"follower.cone_deg": 59.0, **more})
    with pytest.raises(InfeasibleError, match="tip of the conical roller lies") as caught:
        _ = gc.build(steep).cam
    assert caught.value.where.endswith("follower.cone_deg")
    near = [dict(one.near) for one in caught.value.adjustments]
    assert near[0] == {"follower.cone_deg": caught.value.limit}
    for change in near:
        cam = gc.build(steep.with_(change)).cam
        assert cam.tool.radius_at(cam.floor) > 0.0
        assert cam.roller.radius_at(cam.inner) > 0.0
        theta = np.linspace(0.0, cam.program.period, 60)
        x = np.full((60, 1), cam.floor)
        heights = [cam.contact(theta, x, side).points[..., 2] for side in (1, -1)]
        assert np.all(heights[0] > heights[1])


def test_the_largest_angle_and_depth_of_a_cone_are_those_of_its_triangle() -> None:
    """The roller of 4 mm in a groove of 22 mm: atan(4/22), and 4/tan(18 deg)."""
    sizes = {
        "cam.outer_diameter_mm": 130, "cam.groove_depth_mm": 22, "cam.roller_clearance_mm": 0,
        "cam.floor_clearance_mm": 0, "follower.roller_radius_mm": 4, "follower.cone_deg": 18,
    }  # fmt: skip
    with pytest.raises(InfeasibleError) as caught:
        _ = gc.build(DESIGN.with_(sizes)).cam
    found: list[Any] = [next(iter(one.near.values())) for one in caught.value.adjustments]
    angle, depth = found
    assert 0.99 < angle / math.degrees(math.atan(4 / 22)) < 1.0
    assert 0.99 < depth / (4 / math.tan(math.radians(18))) < 1.0
    assert f"up to {depth:g}" in str(caught.value)
    touching = sizes | {"follower.cone_deg": math.degrees(math.atan(4 / 22))}
    with pytest.raises(InfeasibleError, match="tip of the conical roller"):
        _ = gc.build(DESIGN.with_(touching)).cam
    on_the_axis = gc.build(DESIGN.with_(sizes | {"follower.cone_deg": "apex"})).cam
    assert on_the_axis.roller.radius_at(43.0) == pytest.approx(4 * 43 / 65, rel=1e-12)


def test_a_single_wall_has_no_clearance() -> None:
    """It would stand off the roller; the follower is held on it."""
    for wall in ("upper", "lower"):
        with pytest.raises(DesignError, match=f"rests on the {wall} wall, without clearance"):
            DESIGN.with_({"cam.walls": wall, "cam.roller_clearance_mm": 0.4})


@pytest.mark.parametrize("clearance", [0.0, 0.4])
def test_a_rib_is_as_thick_as_it_is_given(clearance: float) -> None:
    rib = {"cam.walls": "rib", "cam.rib_mm": 9, "cam.roller_clearance_mm": clearance}
    cam = gc.build(DESIGN.with_(rib)).cam
    at_rest = np.array([cam.program.period - 1e-3])
    # the roller below the rib has its upper wall there
    (below,), (above,) = (
        wall.contact(at_rest, np.array([[cam.outer_radius]])).points[0, :, 2] for wall in cam.walls
    )
    assert above - below == pytest.approx(9.0, abs=1e-9)


def test_a_rib_that_its_rollers_cut_through() -> None:
    thin = {
        "cam.walls": "rib",
        "cam.rib_mm": 0.5,
        "cam.lowest_mm": 30,
        "cam.roller_clearance_mm": 0,
    }
    with pytest.raises(InfeasibleError, match="cut through the rib") as caught:
        _ = gc.build(DESIGN.with_(thin)).cam
    near = caught.value.adjustments[0].near
    least = gc.build(DESIGN.with_({**thin, **near})).cam.least_rib
    assert least is not None
    assert least.value > 0.0


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"motion": [{"type": "rise", "law": "constant-velocity", "angle_deg": 180, "lift_mm": 9},
                     {"type": "return", "law": "cycloidal", "angle_deg": "rest"}]},
         "the velocity jumps"),
        ({"cam.groove_depth_mm": 81.0}, "inside the bore"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(InfeasibleError, match=words):
        _ = gc.build(DESIGN.with_(changes)).cam


@pytest.mark.parametrize(
    ("depth", "clearance", "key", "rule"),
    [
        (30, 0.3, "groove_depth_mm", "below 29.7 mm"),
        (8, 53, "floor_clearance_mm", "below 22 mm"),
        (40, 53, "outer_diameter_mm", "above 186 mm"),
    ],
)
def test_a_groove_as_deep_as_the_cylinder_names_what_is_too_large(
    depth: float, clearance: float, key: str, rule: str
) -> None:
    sizes = {"groove_depth_mm": depth, "floor_clearance_mm": clearance, "outer_diameter_mm": 60}
    design = gc.load(PROFILES / "cylinder_cam.toml")
    with pytest.raises(gc.DesignError) as caught:
        design.with_({f"cam.{name}": value for name, value in sizes.items()})
    assert f"cam.{key}" in str(caught.value)
    assert rule in str(caught.value)


def test_a_bore_that_leaves_no_room_for_a_groove_is_named() -> None:
    wide = {"blank.bore_diameter_mm": 900.0}
    with pytest.raises(InfeasibleError, match="inside the bore") as caught:
        _ = gc.build(DESIGN.with_(wide)).cam
    assert (caught.value.limit or 0.0) > 0.0
    near = caught.value.adjustments[0].near
    assert [*near] == ["blank.bore_diameter_mm"]
    assert gc.build(DESIGN.with_({**wide, **near})).cam.walls


def test_an_arm_that_swings_too_far() -> None:
    wide = SWINGING.with_(
        {
            "motion": [
                {"type": "rise", "law": "cycloidal", "angle_deg": 180, "lift_deg": 80},
                {"type": "return", "law": "cycloidal", "angle_deg": "rest"},
            ],
            "follower.roller_radius_mm": 2,
            "cam.length_mm": 400,
            "cam.lowest_mm": 60,
        }
    )
    with pytest.raises(InfeasibleError, match="swings so far"):
        _ = gc.build(wide).cam


def test_a_misspelt_form_is_judged_as_what_was_meant() -> None:
    text = (PROFILES / "cylinder_cam.toml").read_text("utf-8").replace('"cylinder"', '"cylindr"')
    with pytest.raises(DesignError) as caught:
        gc.loads('name = "mine"\n' + text)
    (problem,) = caught.value.problems
    assert problem.key == "cam.form"
    assert "did you mean cylinder" in problem.hint


@pytest.mark.parametrize(
    ("changes", "places"),
    few(
        [
            ({}, []),
            ({"cam.roller_clearance_mm": 0}, ["between the walls"]),
            ({"cam.roller_clearance_mm": 0, "cam.walls": "lower"}, []),
            ({"cam.floor_clearance_mm": 0}, ["at the floor"]),
            ({"cam.floor_clearance_mm": 0, "follower.roller_length_mm": 11}, []),
        ]
    ),
)
def test_a_roller_without_clearance_is_noted(changes: dict[str, Any], places: list[str]) -> None:
    found = gc.build(DESIGN.with_(changes)).findings
    told = [(one.severity, one.where) for one in found if one.code == "no-clearance"]
    assert told == [("note", place) for place in places]


NAMES = ("barrel", "drum", "cylindrical", "barrel-cam", "cylinder-cam", "Barrel")


@pytest.mark.parametrize("word", NAMES)
@pytest.mark.parametrize("key", ["form", "kind"])
def test_other_names_are_answered_and_the_rest_is_read_as_meant(key: str, word: str) -> None:
    """No key of a cylinder cam is called missing, unknown or in the wrong place."""
    text = (PROFILES / "cylinder_cam.toml").read_text("utf-8")
    old = {"form": 'form = "cylinder"', "kind": 'kind = "cam"'}[key]
    assert old in text
    with pytest.raises(DesignError) as caught:
        gc.loads('name = "mine"\n' + text.replace(old, f'{key} = "{word}"', 1))
    (problem,) = caught.value.problems
    assert problem.key == {"form": "cam.form", "kind": "kind"}[key]
    meant = {"form": "cylinder", "kind": 'kind = "cam" with cam.form = "cylinder"'}[key]
    assert problem.hint == f"did you mean {meant}?"


def test_a_kind_that_names_the_form_stands_for_it() -> None:
    text = (PROFILES / "cylinder_cam.toml").read_text("utf-8").replace('form = "cylinder"\n', "")
    with pytest.raises(DesignError) as caught:
        gc.loads('name = "mine"\n' + text.replace('kind = "cam"', 'kind = "barrel-cam"', 1))
    assert [problem.key for problem in caught.value.problems] == ["kind"]


FORMS = {
    "cylinder_cam": "cylinder",
    "rotary_axis_cam": "cylinder",
    "globoidal_indexer": "globoidal",
    "groove_cam": "groove",
    "conjugate_cams": "conjugate",
    "translating_cam": "translating",
}


@pytest.mark.parametrize("line", ["", 'form = "xyz"', "form = 3"])
@pytest.mark.parametrize("name", [*FORMS])
def test_without_its_form_a_file_is_read_as_what_its_keys_mean(name: str, line: str) -> None:
    text = 'name = "mine"\n' + re.sub(
        r'(?m)^(kind = "globoidal-cam"|name = .*)$',
        "",
        (PROFILES / f"{name}.toml").read_text("utf-8"),
    )
    text, count = re.subn(r'(?m)^form = ".*?"', line, text)
    assert count == 1
    with pytest.raises(DesignError) as caught:
        gc.loads(text)
    (problem,) = caught.value.problems
    assert problem.key == "cam.form"
    assert problem.hint == f"did you mean {FORMS[name]}?"
    assert problem.allowed.count('"') == 14, "all forms"
    if not line:
        for key in problem.message.partition(" has no ")[2].split(", "):
            assert key.strip("[]") in text


def test_other_faults_of_a_file_without_its_form_are_those_of_the_form_that_is_meant() -> None:
    text = (PROFILES / "cylinder_cam.toml").read_text("utf-8").replace('form = "cylinder"\n', "")
    text = text.replace("length_mm = ", "length_mm = -")
    with pytest.raises(DesignError) as caught:
        gc.loads('name = "mine"\n' + text)
    assert [one.key for one in caught.value.problems] == ["cam.form", "cam.length_mm"]


@pytest.mark.parametrize("line", ["gap_mm = 2", "groove_depth_mm = 4", "outer_diameter_mm = 90"])
def test_one_key_of_another_form_makes_no_other_cam(line: str) -> None:
    text = (PROFILES / "plate_cam_offset_roller.toml").read_text("utf-8")
    text, count = re.subn(r'(?m)^form = "disc"', line, text)
    assert count == 1
    with pytest.raises(DesignError) as caught:
        gc.loads(text)
    (problem,) = caught.value.problems
    assert problem.key == f"cam.{line.split()[0]}"
    assert "does not apply to a disc cam" in problem.message


SWINGS, ROLLS = 'follower.motion = "oscillating"', 'follower.type = "roller"'
MISPLACED = (
    ("top", 'motion = "swinging"', "motion", SWINGS),
    ("[[motion]]", 'motion = "swinging"', "motion[0].motion", SWINGS),
    ("[[motion]]", 'follower = "rocking"', "motion[0].follower", SWINGS),
    ("[[motion]]", 'follower = "roller"', "motion[0].follower", ROLLS),
    ("[cam]", 'follower = "pivoted"', "cam.follower", SWINGS),
    ("[cam]", 'follower_motion = "oscillating"', "cam.follower_motion", SWINGS),
    ("[cam]", 'kind = "barrel"', "cam.kind", 'cam.form = "cylinder"'),
    ("[follower]", 'type = "swinging"', "follower.type", SWINGS),
    ("[follower]", 'shape = "roller-follower"', "follower.shape", ROLLS),
    ("[follower]", "swinging = true", "follower.swinging", SWINGS),
    ("[follower]", 'kind = "rocking roller"', "follower.kind", f"{SWINGS} and {ROLLS}"),
    ("whole", 'follower = "swinging"', "follower", SWINGS),
)


@pytest.mark.parametrize("profile", ["cylinder_cam", "plate_cam_offset_roller"])
@pytest.mark.parametrize(("place", "line", "key", "meant"), MISPLACED)
def test_a_word_in_another_place_is_answered_with_its_key_and_value(
    profile: str, place: str, line: str, key: str, meant: str
) -> None:
    text = (PROFILES / f"{profile}.toml").read_text("utf-8")
    text = text if "\nname = " in text else f'name = "mine"\n{text}'
    if place == "whole":
        text = f"{line}\n" + re.sub(r"(?s)\[follower\].*?(?=\n\[)", "", text)
    elif place == "top":
        text = f"{line}\n" + re.sub(r"(?s)\[\[motion\]\].*(?=\n\[follower)", "", text)
    else:
        if line.startswith("type"):
            text = re.sub(r'(?m)(?<=\[follower\]\n)type = ".*?"', "", text)
        text = text.replace(f"{place}\n", f"{place}\n{line}\n", 1)
    with pytest.raises(DesignError) as caught:
        gc.loads(text)
    hints = {problem.key: problem.hint for problem in caught.value.problems}
    assert hints[key] == f"did you mean {meant}?"


@pytest.mark.parametrize(
    ("key", "word", "meant"),
    [
        ("motion", "swinging", "oscillating"),
        ("motion", "rotating", "oscillating"),
        ("motion", "reciprocating", "translating"),
        ("type", "knife", "knife-edge"),
        ("type", "flat-faced", "flat"),
        ("type", "mushroom", "domed"),
        ("type", "roller-follower", "roller"),
    ],
)
def test_other_words_for_followers(key: str, word: str, meant: str) -> None:
    text = (PROFILES / "plate_cam_offset_roller.toml").read_text("utf-8")
    text, count = re.subn(rf'(?m)(?<=^{key} = )"(roller|translating)"', f'"{word}"', text)
    assert count == 1
    with pytest.raises(DesignError) as caught:
        gc.loads(text)
    hints = {problem.key: problem.hint for problem in caught.value.problems}
    assert hints[f"follower.{key}"] == f"did you mean {meant}?"


@pytest.mark.parametrize(
    ("word", "hint"),
    [
        ("nc", "did you mean gcode?"),
        ("g-code", "did you mean gcode?"),
        ("print", "did you mean stl or 3mf?"),
    ],
)
def test_other_names_of_files(word: str, hint: str) -> None:
    text = (PROFILES / "cylinder_cam.toml").read_text("utf-8")
    with pytest.raises(DesignError) as caught:
        gc.loads('name = "mine"\n' + re.sub(r"files = \[[^]]*\]", f'files = ["{word}"]', text))
    (problem,) = caught.value.problems
    assert (problem.key, problem.hint) == ("output.files[0]", hint)
