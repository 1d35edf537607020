"""Design files in inches: reading, messages and writing."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import pytest

import gearcam
from gearcam.base.errors import DesignError, Problem
from gearcam.base.inches import key_mm, name_in, text_in, unit_in
from gearcam.cli import main
from gearcam.designs.design import hash_of, loads
from gearcam.designs.kind import KINDS
from gearcam.designs.schema import schema
from gearcam.designs.template import template
from gearcam.designs.writing import least_document, toml_text

PAIR = """
kind = "gear-pair"
name = "p"
units = "inch"

[law]
type = "ellipse"
eccentricity = 0.3

[pair]
teeth = [41, 41]
diametral_pitch = 12
face_width_in = 0.4

[blank]
bore_diameter_in = 0.375
"""

SAME = """
kind = "gear-pair"
name = "p"

[law]
type = "ellipse"
eccentricity = 0.3

[pair]
teeth = [41, 41]
module_mm = 2.11666666666667
face_width_mm = 10.16

[blank]
bore_diameter_mm = 9.525
"""


def read(text: str) -> Any:
    return loads(text)


def problems(text: str) -> dict[str, Problem]:
    with pytest.raises(DesignError) as caught:
        loads(text, file="p.toml")
    return {one.key: one for one in caught.value.problems}


def test_it_is_the_same_design() -> None:
    inch, mm = read(PAIR), read(SAME)
    assert inch.units == "inch"
    assert (inch.pair, inch.blank) == (mm.pair, mm.blank)
    assert inch != mm  # their files say other things
    assert inch.with_({"units": "mm"}) == mm
    assert mm.with_({"units": "inch"}) == inch
    assert hash_of(inch) != hash_of(mm)
    files = {units: hash_of(mm.with_({"output.units": units})) for units in ("mm", "inch")}
    assert files["mm"] == hash_of(mm) != files["inch"]


@pytest.mark.parametrize("inches", [0.1, 0.333333333333, 0.375, 3.1, 2.000001, 12.7, 1e-3, 39.99])
def test_a_length_is_written_as_it_was_read(inches: float) -> None:
    text = PAIR.replace("0.4", repr(inches))
    design = read(text)
    assert design.pair.face_width == pytest.approx(25.4 * inches, rel=1e-14)
    assert design.to_dict()["pair"]["face_width_in"] == inches
    assert gearcam.design(design.to_dict()) == design


@pytest.mark.parametrize("length", [10.0, 3.175, 0.1, 7.3, 33.333, 1e-3])
def test_a_length_in_mm_is_kept_to_the_last_digit(length: float) -> None:
    design = read(PAIR.replace("face_width_in = 0.4", f"face_width_mm = {length}"))
    assert design.pair.face_width == length
    assert read(toml_text(design.to_dict())).pair.face_width == length


def test_sizes_with_a_class_are_in_inches() -> None:
    design = read(PAIR.replace("0.375", '["0.5 H7", 0.25]'))
    assert str(design.blank.bore_diameter[0]) == "12.7 H7"
    assert design.to_dict()["blank"]["bore_diameter_in"] == ["0.5 H7", 0.25]
    assert gearcam.design(design.to_dict()) == design
    metric = design.with_({"blank.bore_diameter_mm": "8 H7"})
    assert str(read(toml_text(metric.to_dict())).blank.bore_diameter[0]) == "8 H7"


def test_it_stays_in_inches_where_it_is_written(tmp_path: Path) -> None:
    text = toml_text(least_document(loads(PAIR)))
    assert tomllib.loads(text)["pair"] == {
        "teeth": [41, 41], "diametral_pitch": 12, "face_width_in": 0.4
    }  # fmt: skip
    assert "_mm" not in text
    file = tmp_path / "p.toml"
    file.write_text(text, encoding="utf-8")
    assert gearcam.load(file) == loads(PAIR)


def test_changes_are_in_inches_or_in_mm() -> None:
    design = read(PAIR)
    assert design.with_({"blank.bore_diameter_in": 0.5}).blank.bore_diameter == (12.7, 12.7)
    assert design.with_({"blank.bore_diameter_mm": 8}).blank.bore_diameter == (8.0, 8.0)
    assert design.with_({"blank.bore_diameter_in[1]": 0.5}).blank.bore_diameter == (9.525, 12.7)
    assert design.with_({"pair.module_mm": 2.54}).to_dict()["pair"]["diametral_pitch"] == 10
    with pytest.raises(DesignError, match=r"blank\.bore_diameter_in: -1 is out of range"):
        design.with_({"blank.bore_diameter_in": -1})


def test_a_change_is_given_in_inches_or_in_mm() -> None:
    both = {"blank.bore_diameter_in": 0.5, "blank.bore_diameter_mm": 8}
    with pytest.raises(DesignError, match=r"_mm: is given beside blank\.bore_diameter_in"):
        read(PAIR).with_(both)


@pytest.mark.parametrize(
    ("old", "new", "key", "message", "words"),
    [
        ("bore_diameter_in", "bore_diametr_in", "blank.bore_diametr_in", "unknown key",
         "did you mean bore_diameter_in?"),
        ("0.375", "-0.375", "blank.bore_diameter_in", "-0.375 is out of range", "to 3937 in"),
        ("0.375", '"3/8"', "blank.bore_diameter_in", '"3/8" is not a number', "write 0.375"),
        ("0.375", '"9.525 mm"', "blank.bore_diameter_in", "is not a number", "write 0.375: 9.525"),
        ("0.375", '"M6"', "blank.bore_diameter_in", "is not a number", "0.2362204724, its nominal"),
        ("0.375", '"0.3/8 H7"', "blank.bore_diameter_in", "is not a number", "alone, in inches"),
        ("0.375", '"0.375 h7"', "blank.bore_diameter_in", "is the class of a shaft",
         'did you mean "0.375 H7"?'),
        ("0.375", '"9.525 mm H7"', "blank.bore_diameter_in", "is not a number", '"0.375 H7"'),
        ("0.375", "3/8", "", "there is more after the value", "write 0.375"),
        ("= 12", "= 0.01", "pair.diametral_pitch", "0.01 is out of range",
         "a number from 0.0254 to 25400 1/in"),
        ("= 12", "= 12\nmodule_mm = 2", "pair.module_mm", "is given beside diametral_pitch",
         "one of them"),
        ("= 12", "= 12\ncenter_distance_in = 3", "pair.diametral_pitch",
         "12: is given beside center_distance_in = 3", "one of center_distance_in and diametral"),
        ("0.375", "0.375\nhub_diameter_in = 0.3\nhub_front_in = 0.2", "blank.hub_diameter_in",
         "0.3: the bore is as large as the hub", "above 0.375 in"),
        ("0.375", "0.375\nkeyway_width_in = 0.1", "blank.keyway_depth_in", "is missing",
         "keyway_width_in with keyway_depth_in"),
        ('"inch"', '"in"', "units", '"in" is not a unit', 'write units = "inch"'),
        ('units = "inch"\n', "", "blank.bore_diameter_in", "unknown key (its value is 0.375)",
         'write bore_diameter_mm = 9.525, or say units = "inch" at the top'),
        ('units = "inch"\n', "", "pair.diametral_pitch", "unknown key",
         'write module_mm = 2.116666667, or say units = "inch" at the top'),
        ("diametral_pitch = 12", "dp = 12", "pair.dp", "unknown key",
         "did you mean diametral_pitch? (write diametral_pitch = 12)"),
        ("[blank]\n", '[blank]\nunits = "inch"\n', "blank.units", "unknown key",
         "belongs at the top of the file"),
    ],
)  # fmt: skip
def test_mistakes_are_told_in_the_words_of_the_file(
    old: str, new: str, key: str, message: str, words: str
) -> None:
    problem = problems(PAIR.replace(old, new, 1))[key]
    assert message in str(problem)
    assert words in str(problem)
    assert problem.line


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("2 in", "write 2: the number alone"), ("1/2", "write 0.5"),
        ("50.8 mm", "write 2: 50.8 mm is"),
        ("sollve", "did you mean solve?"),
    ],
)  # fmt: skip
def test_measures_where_a_word_may_stand(value: str, words: str) -> None:
    text = template("cam", units="inch").replace(
        "prime_radius_in = 1.68", f'prime_radius_in = "{value}"'
    )
    told = problems(text)["cam.prime_radius_in"].hint
    assert words in told
    assert " or " not in told


def test_a_formula_says_that_it_is_in_mm() -> None:
    text = re.sub(r"\s*# +", " ", template("cam", units="inch"))
    assert re.search(r"\(1 - cos\(theta\)\); in millimetres, also in files in inches", text)


def test_what_is_in_mm_in_it_keeps_its_name() -> None:
    text = PAIR.replace("bore_diameter_in = 0.375", "bore_diameter_mm = -8")
    assert problems(text).keys() == {"blank.bore_diameter_mm"}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("from 0.001 to 100000 mm", "from 3.938e-05 to 3937 in"),
        ("at least 1 mm, at most 1 mm", "at least 0.03938 in, at most 0.03937 in"),
        ("at least 25.4 mm, at most 25.4 mm", "at least 1 in, at most 1 in"),
        ("x = 25.4, y = -12.7 mm", "x = 1, y = -0.5 in"),
        ("30 x 40 mm, 5 um", "1.181 x 1.575 in, 0.0001969 in"),
        ("1 mm2 and 254 mm/s", "0.00155 in2 and 10 in/s"),
        ("a.b_mm[1] = 12.7 and c_mm = [2.54, 0]", "a.b_in[1] = 0.5 and c_in = [0.1, 0]"),
        ("pair.module_mm = 2.54", "pair.diametral_pitch = 10"),
        ("a_mm of up to 12.7 fits", "a_in of up to 0.5 fits"),
        ("prime_radius_mm 3.5 mm", "prime_radius_in 0.1378 in"),
        ("speed_mm_s, x_mm_per_rad, lengths in mm", "speed_in_s, x_in_per_rad, lengths in inches"),
        ("x_mm_per_mm, x_mm_per_mm2, x_mm_per_deg", "x_in_per_in, x_in_per_in2, x_in_per_deg"),
        ("stiffness_n_mm = 3: 12 N/mm, 3 N mm, 5 kg mm2, 1/mm", None),
    ],
)
def test_texts_in_inches(text: str, told: str | None) -> None:
    assert text_in(text) == (text if told is None else told)
    assert text_in(text_in(text)) == text_in(text)


@pytest.mark.parametrize(
    ("name", "unit", "named", "united", "factor"),
    [
        ("a_mm", "mm", "a_in", "in", 1.0 / 25.4), ("a_mm2", "mm2", "a_in2", "in2", 25.4**-2),
        ("a_mm_per_mm", "mm/mm", "a_in_per_in", "in/in", 1.0),
        ("a_mm_per_mm2", "mm/mm2", "a_in_per_in2", "in/in2", 25.4),
        ("a_mm_per_deg", "mm/deg", "a_in_per_deg", "in/deg", 1.0 / 25.4),
        ("a_mm_s2", "mm/s2", "a_in_s2", "in/s2", 1.0 / 25.4),
    ],
)  # fmt: skip
def test_both_units_of_a_quotient_are_in_inches(
    name: str, unit: str, named: str, united: str, factor: float
) -> None:
    for found, wanted in ((name_in(name), named), (unit_in(unit), united)):
        assert found == (wanted, pytest.approx(factor, rel=1e-15))
    assert name_in("a_deg_per_mm") == ("a_deg_per_in", 25.4)
    assert unit_in("1/mm") == ("1/in", 25.4)
    assert unit_in("um/mm") == ("in/in", pytest.approx(1e-3))
    assert key_mm("a_in_per_in") == "a_mm_per_mm"


def test_sizes_with_a_class_are_translated_once() -> None:
    assert text_in('a_mm = ["25.4 H7", 12.7]') == 'a_in = ["1 H7", 0.5]'
    assert set(re.findall(r'"[\d.]+ H7"', template("cam", units="inch"))) == {'"0.984252 H7"'}


@pytest.mark.parametrize("kind", list(KINDS))
def test_the_template_in_inches_is_valid_and_round(kind: str) -> None:
    text = template(kind, units="inch")
    document = tomllib.loads(text)
    jsonschema.Draft202012Validator(schema()).validate(document)
    loads(text)
    # formulas compute in mm, and say so
    assert not re.search(r"(?<!_n)(?<!_n_s)_mm\b|\d mm\b|\bin mm\b", text)
    given = [
        value
        for value in re.findall(r"^\w+_in = \[?([\d.]+)", text, re.MULTILINE)
        if len(value.replace(".", "").strip("0")) > 3
    ]
    assert not given


def test_the_template_is_written_in_inches(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "gear-pair", "p.toml", "--units", "inch"]) == 0
    assert gearcam.load("p.toml").units == "inch"
    assert main(["check", "p.toml"]) == 0
    assert "centre distance 3.2 in" in capsys.readouterr().out


def test_the_schema_has_both_spellings() -> None:
    checker = jsonschema.Draft202012Validator(schema())
    document = tomllib.loads(PAIR)
    assert checker.is_valid(document)
    assert not checker.is_valid({**document, "units": "mm"})
    for name, value, good in (
        ("bore_diameter_in", 1e6, False), ("bore_diameter_mm", 8, True), ("bore_in", 1, False)
    ):  # fmt: skip
        assert checker.is_valid({**document, "blank": {name: value}}) is good
    pair = {**document["pair"], "diametral_pitch": 30000}
    assert not checker.is_valid({**document, "pair": pair})


def test_a_nested_design_takes_the_units_of_its_file(tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text(PAIR, encoding="utf-8")
    machine = """
kind = "mechanism"
name = "m"
[[drive]]
name = "d"
pair = "p.toml"
[[crank]]
name = "crank"
joint = "pin"
on = "d.wheel2"
length_mm = 50.8
"""
    (tmp_path / "m.toml").write_text(machine, encoding="utf-8")
    design: Any = gearcam.load(tmp_path / "m.toml")
    assert design.drive[0].pair.pair.face_width == 10.16
    assert design.to_dict()["drive"][0]["pair"]["pair"]["face_width_mm"] == 10.16
    inch = design.with_({"units": "inch"})
    assert inch.to_dict()["drive"][0]["pair"]["pair"]["face_width_in"] == 0.4
    assert inch.to_dict()["crank"][0]["length_in"] == 2
    wrong = toml_text(inch.to_dict()).replace("face_width_in = 0.4", "face_width_in = -0.4")
    assert "-0.4 is out of range" in problems(wrong)["drive[0].pair.pair.face_width_in"].message
    assert gearcam.design(inch.to_dict()) == inch
