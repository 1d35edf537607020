"""Sizes with a tolerance class pass through the whole chain of a design and back."""

from __future__ import annotations

import copy
import dataclasses
import pickle
from typing import Any

import jsonschema
import pytest

import gearcam as gc
from gearcam.designs.schema import schema
from gearcam.designs.writing import least_document, toml_text
from gearcam.parts.blank import WheelBlank
from gearcam.view.numbers import numbers, replaced
from helpers_files import problems
from helpers_pairs import PROFILES

GOOD = """\
kind = "gear-pair"
name = "25H7"
[law]
type = "constant"
[pair]
module_mm = 2
teeth = [40, 40]
[output]
files = ["csv"]
[blank]
"""
KEYED = 'bore_diameter_mm = "25 H7"\nkeyway_width_mm = "8JS9"\nkeyway_depth_mm = 3.3\n'
BOLTS = 'bolts = 3\nbolt_circle_mm = 50\nbolt_diameter_mm = "6.6 H8"\n'


def cam_with(bore: Any) -> Any:
    cam = gc.load(PROFILES / "plate_cam_offset_roller.toml")
    return cam.with_({"blank.bore_diameter_mm": bore, "output.files": ["csv"]})


def test_a_file_may_give_a_class_and_gets_it_back() -> None:
    design: Any = gc.loads(GOOD + KEYED + BOLTS)
    one = design.blank.wheel(1)
    assert [str(one.bore_diameter), str(one.keyway_width), str(one.bolt_diameter)] == [
        "25 H7",
        "8 JS9",
        "6.6 H8",
    ]
    assert (one.bore, one.bore.upper, one.keyway_width.lower) == (25.0, 0.021, -0.018)
    document = design.to_dict()
    assert document["blank"]["bore_diameter_mm"] == ["25 H7", "25 H7"]
    assert document["blank"]["keyway_width_mm"] == ["8 JS9", "8 JS9"]
    text = toml_text(least_document(design))
    assert 'bore_diameter_mm = "25 H7"' in text
    assert 'bolt_diameter_mm = "6.6 H8"' in text
    copies = copy.deepcopy(design), pickle.loads(pickle.dumps(design))
    spelt = gc.loads(GOOD + KEYED.replace("25 H7", " 25H07 ") + BOLTS)
    for again in (*copies, gc.design(document), gc.loads(text), spelt):
        assert again == design
    plain = gc.loads(GOOD + KEYED.replace('"25 H7"', "25") + BOLTS)
    assert plain != design
    assert hash(plain) != hash(design)


def test_each_wheel_may_have_its_own() -> None:
    design: Any = gc.loads(GOOD + 'bore_diameter_mm = ["25 H7", 16]')
    assert [str(design.blank.wheel(k).bore) for k in (1, 2)] == ["25 H7", "16.0"]
    assert design.to_dict()["blank"]["bore_diameter_mm"] == ["25 H7", 16.0]


@pytest.mark.parametrize("given", ["25 H7", gc.FitSize("25 H7")])
def test_python_takes_texts_and_sizes(given: Any) -> None:
    for blank in (
        WheelBlank(bore_diameter=given),
        gc.Blank(bore_diameter=(given, 16.0)).wheel(1),
    ):
        assert repr(blank) == "WheelBlank(bore_diameter='25 H7')"
        assert (blank.bore_reach, str(blank.bore)) == (12.5, "25 H7")
    cam = cam_with(given)
    assert str(cam.blank.bore) == "25 H7"
    assert cam.to_dict()["blank"]["bore_diameter_mm"] == "25 H7"
    cylinder: Any = gc.load(PROFILES / "cylinder_cam.toml")
    own = dataclasses.replace(cylinder, blank=gc.CylinderBlank(bore_diameter=given))
    assert str(own.blank.bore_diameter) == "25 H7"


@pytest.mark.parametrize(
    ("text", "key", "words", "hint"),
    [
        ('bore_diameter_mm = "25 h7"', "bore_diameter_mm", "class of a shaft", "25 H7"),
        ('bore_diameter_mm = "25 H15"', "bore_diameter_mm", "H15 are not known", "25 H14"),
        ('bore_diameter_mm = [16, "25 Z7"]', "bore_diameter_mm[1]", "Z is no letter", "25 S7"),
        ('bore_diameter_mm = "600 H7"', "bore_diameter_mm", "not known for this size", ""),
        ('bore_diameter_mm = "\u00d825 H7"', "bore_diameter_mm", "not a number", 'write "25 H7"'),
        ('bore_diameter_mm = "25 H7/g6"', "bore_diameter_mm", "not a number", 'write "25 H7"'),
        ('bore_diameter_mm = "25,5 h7"', "bore_diameter_mm", "not a number", 'write "25.5 H7"'),
        ('bore_diameter_mm = "25"', "bore_diameter_mm", "not a number", "write 25 without quotes"),
        ("bore_diameter_mm = 25 H7", "", "there is more", 'write "25 H7"'),
        ('bore_mm = "25 H7"', "bore_mm", "unknown key", "did you mean bore_diameter_mm?"),
        (KEYED.replace("8JS9", "26 JS9"), "keyway_width_mm", "as wide as the bore", ""),
        (
            'bore_diameter_mm = 25\nhub_front_mm = 3\nhub_diameter_mm = "40 h6"',
            "hub_diameter_mm",
            "not a number",
            "the fit h6 has no key",
        ),
        (
            KEYED + "clearance_mm = 0.1\nclearance_bores = true",
            "clearance_bores",
            'would widen bore_diameter_mm = "25 H7"',
            "",
        ),
    ],
)
def test_what_cannot_be_is_told_with_what_can(text: str, key: str, words: str, hint: str) -> None:
    (problem,) = problems(GOOD + text)
    assert problem.key == (f"blank.{key}" if key else "")
    assert words in problem.message
    assert hint in problem.hint


def test_the_schema_takes_what_the_reader_takes() -> None:
    own = jsonschema.Draft202012Validator(schema())
    document: dict[str, Any] = gc.loads(GOOD + KEYED + BOLTS).to_dict()
    assert own.is_valid(document)
    for value, good in (("25 H7", True), (["25H7", 16], True), ("25 h7", False), ("H7", False)):
        document["blank"]["bore_diameter_mm"] = value
        assert own.is_valid(document) == good, value
    document["blank"] |= {"bore_diameter_mm": "25 H7", "clearance_mm": "25 H7"}
    assert not own.is_valid(document)


def test_sliders_move_the_size_and_keep_the_class() -> None:
    text = GOOD + 'bore_diameter_mm = ["25 H7", 16]\n' + BOLTS.replace('"', "'")
    values = numbers(text)
    assert (values["blank.bore_diameter_mm[0]"], values["blank.bolt_diameter_mm"]) == (25.0, 6.6)
    assert "name" not in values
    moved = replaced(text, {"blank.bore_diameter_mm[0]": 26.5, "blank.bolt_diameter_mm": 7.0})
    assert 'bore_diameter_mm = ["26.5 H7", 16]' in moved
    assert 'bolt_diameter_mm = "7 H8"' in moved
    assert "bolt_diameter_mm = 0.5" in replaced(text, {"blank.bolt_diameter_mm": 0.5})


def test_a_remedy_keeps_the_class() -> None:
    design = gc.loads(GOOD + 'bore_diameter_mm = "76 H7"')
    (remedy,) = gc.remedies(gc.build(design)).found
    assert remedy.text.startswith('blank.bore_diameter_mm = "6')
    assert remedy.text.endswith(' H7"')
    changed: Any = remedy.design
    assert str(changed.blank.wheel(2).bore).endswith("H7")


def test_a_class_where_there_is_none_is_refused() -> None:
    size = gc.FitSize("40 H7")
    blank = {"blank.bore_diameter_mm": 20, "blank.hub_front_mm": 3, "blank.hub_diameter_mm": size}
    with pytest.raises(gc.DesignError, match="the fit H7 has no key"):
        cam_with(20).with_(blank)
    with pytest.raises(gc.DesignError, match="the fit H7 has no key"):
        dataclasses.replace(
            cam_with(20), blank=gc.CamBlank(bore_diameter=20, hub_diameter=size, hub_front=3)
        )


def test_plates_have_them_too() -> None:
    blank = gc.PlateBlank(height=60.0, bolts=1, bolt_diameter="6 H8", bolt_height=9.0)  # pyright: ignore
    given: Any = gc.load(PROFILES / "translating_cam.toml")
    plate = dataclasses.replace(given, blank=blank)
    assert str(plate.blank.bolt_diameter) == "6 H8"
    assert plate.to_dict()["blank"]["bolt_diameter_mm"] == "6 H8"


def test_parts_have_the_nominal_size() -> None:
    plain, fitted = (gc.build(cam_with(size)).parts[0] for size in (20, "20 F8"))
    assert fitted.volume == plain.volume
