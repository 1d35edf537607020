"""Design files are read strictly; everything wrong in one is told at once, each with its place."""

from __future__ import annotations

import math
import tomllib
from functools import partial
from pathlib import Path

import pytest

from gearcam.designs import KINDS, load, loads
from gearcam.designs.faults import quoted
from gearcam.designs.kind import variant_of
from gearcam.designs.template import template
from gearcam.gears.spec import Rack
from gearcam.kinds.gear_pair.design import GearPairDesign, PairOutputSpec
from gearcam.parts.blank import Blank
from helpers_files import PAIR, only, problems
from helpers_files import changed as changed_text
from helpers_pairs import PROFILES

changed = partial(changed_text, text=PAIR)


def read(text: str, file: str = "") -> GearPairDesign:
    design = loads(text, file=file)
    assert isinstance(design, GearPairDesign)
    return design


@pytest.mark.parametrize("path", sorted(PROFILES.glob("*.toml")), ids=lambda path: path.stem)
def test_every_profile_is_read(path: Path) -> None:
    design = load(path)
    assert design.name == path.stem
    assert design.source == str(path)


def test_angles_become_radians_and_lengths_stay_millimetres() -> None:
    design = read(changed('files = ["csv"]', 'files = ["csv"]\nchord_tolerance_mm = 0.002'))
    assert design.law.knots == pytest.approx((0.0, math.radians(160), 2 * math.pi), abs=0)
    assert design.law.ratios == (1.6, 0.4, 1.6)
    assert isinstance(design.pair.center_distance, float)
    assert design.pair.teeth == (36, 36)
    assert design.pair.module is None
    assert design.output.chord_tolerance == 0.002
    assert design.rack.pressure_angle == math.radians(20)


def test_what_is_left_out_takes_its_default() -> None:
    design = read(PAIR.replace('[output]\nfiles = ["csv"]\n', ""))
    assert design.output.files == PairOutputSpec().files
    assert design.rack == Rack()
    assert design.blank == Blank()
    assert design.limits == {}


def test_all_errors_are_reported_at_once_in_the_order_of_the_file() -> None:
    text = """\
kind = "gear-pairs"
name = "a/b"
[law]
type = "phases"
shape = "cosin"
knots_rad = [0, 160, 360]
ratios = [
  1.6,   # the first
  -0.4,
  true,
  "solv",
]
[pair]
module = 3
center_distance_mm = "180"
teeth = [36,
  2.5, 7]
face_width_mm = nan
[rakc]
addendum = 1
[rack]
pressure_angle_deg = 50
addendum = inf
[output]
files = ["dxf", "sld", "dxf"]
dxf_curves = "curves"
chord_tolerance_mm = 0
"""
    found = [(problem.line, problem.key) for problem in problems(text)]
    assert found == [
        (1, "kind"),
        (2, "name"),
        (5, "law.shape"),
        (6, "law.knots_rad"),
        (9, "law.ratios[1]"),
        (10, "law.ratios[2]"),
        (11, "law.ratios[3]"),
        (14, "pair.module"),
        (15, "pair.center_distance_mm"),
        (16, "pair.teeth"),
        (17, "pair.teeth[1]"),
        (18, "pair.face_width_mm"),
        (19, "rakc"),
        (22, "rack.pressure_angle_deg"),
        (23, "rack.addendum"),
        (25, "output.files[1]"),
        (25, "output.files[2]"),
        (26, "output.dxf_curves"),
        (27, "output.chord_tolerance_mm"),
    ]


def test_a_problem_carries_file_line_key_value_rule_and_hint() -> None:
    problem = only(changed("[36, 36]", "[36, 2]"))
    assert problem.file == "design.toml"
    assert problem.line == 11
    assert problem.key == "pair.teeth[1]"
    assert problem.value == 2
    assert problem.allowed == "a whole number from 3 to 3000"
    assert str(problem).startswith("design.toml:11: pair.teeth[1]: 2 is out of range")
    assert only(changed("teeth =", "colour = 1\nteeth =")).hint == ""


@pytest.mark.parametrize(
    ("old", "new", "key", "hint"),
    [
        ("knots_deg", "knots", "law.knots", "knots_deg"),
        (
            "knots_deg",
            "knots_rad",
            "law.knots_rad",
            "knots_deg? (angles are in deg: 1 rad =",
        ),
        ("knots_deg", "knot_deg", "law.knot_deg", "knots_deg?"),
        (
            "center_distance_mm",
            "center_distance",
            "pair.center_distance",
            "center_distance_mm? (len",
        ),
        (
            "center_distance_mm",
            "centre_distance_mm",
            "pair.centre_distance_mm",
            "center_distance_mm",
        ),
        ("teeth", "teht", "pair.teht", "teeth"),
        ('type = "phases"', 'type = "phase"', "law.type", "phases"),
        ('["csv"]', '["cvs"]', "output.files[0]", "csv"),
        ("[output]", "[ouput]", "ouput", "output"),
        ("ratios =", "eccentricity = 1\nratios =", "law.eccentricity", 'type "ellipse",'),
        ("ratios =", "teeth = 1\nratios =", "law.teeth", "belongs under [pair]"),
        ("[law]", "center_distance_mm = 180\n[law]", "center_distance_mm", "under [pair]"),
        (
            "[law]",
            "modul = 1\n[law]",
            "modul",
            "module_mm? (lengths are in mm, and",
        ),
        ('"gear-pair"', '"gear pair"', "kind", "gear-pair"),
        ("= 180", '= "180"', "pair.center_distance_mm", "without quotes"),
        ("[output]", "[rack]\ndedendum_mm = 1\n[output]", "rack.dedendum_mm", "mean dedendum?"),
        ("[output]", "[blank]\nbore_inch = 1\n[output]", "blank.bore_inch", ""),
        ("= 180", "= 180\nmodule_inch = 1", "pair.module_inch", "module_mm? (lengths"),
    ],
)
def test_a_slip_names_what_was_probably_meant(old: str, new: str, key: str, hint: str) -> None:
    found = {problem.key: problem for problem in problems(changed(old, new))}
    assert hint in found[key].hint


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ("= 180", "= true", "pair.center_distance_mm"),
        ("= 180", "= 0", "pair.center_distance_mm"),
        ("= 180", "= -1.0", "pair.center_distance_mm"),
        ("= 180", "= nan", "pair.center_distance_mm"),
        ("= 180", "= inf", "pair.center_distance_mm"),
        ("= 180", "= 1" + "0" * 400, "pair.center_distance_mm"),
        ("= 180", "= 2020-01-01", "pair.center_distance_mm"),
        ("= 180", "= [180]", "pair.center_distance_mm"),
        ("= 180", "= {mm = 180}", "pair.center_distance_mm"),
        ("[36, 36]", "[36.0, 36]", "pair.teeth[0]"),
        ("[36, 36]", "[true, 36]", "pair.teeth[0]"),
        ("[36, 36]", "[36]", "pair.teeth"),
        ("[36, 36]", "[36, 36, 36]", "pair.teeth"),
        ("[36, 36]", "36", "pair.teeth"),
        ("[36, 36]", "[]", "pair.teeth"),
        ("[0, 160, 360]", "[0]", "law.knots_deg"),
        ("[0, 160, 360]", "[0, 160, 361]", "law.knots_deg[2]"),
        ("[0, 160, 360]", "[0, nan, 360]", "law.knots_deg[1]"),
        ("[1.6, 0.4, 1.6]", "[1.6, nan, 1.6]", "law.ratios[1]"),
        ("[1.6, 0.4, 1.6]", "[1.6, 0, 1.6]", "law.ratios[1]"),
        ("[1.6, 0.4, 1.6]", "[1.6, [0.4], 1.6]", "law.ratios[1]"),
        ('["csv"]', '["csv"]\nchord_tolerance_mm = inf', "output.chord_tolerance_mm"),
        ('["csv"]', '["csv"]\nchord_tolerance_mm = nan', "output.chord_tolerance_mm"),
        ('"phases"', "3", "law.type"),
        ('"phases"', '["phases"]', "law.type"),
        ('["csv"]', '"csv"', "output.files"),
        ('["csv"]', '["csv", "csv"]', "output.files[1]"),
        ('["csv"]', "[1]", "output.files[0]"),
        ('name = "good"', "name = 3", "name"),
    ],
)
def test_a_wrong_value_is_refused_where_it_stands(old: str, new: str, key: str) -> None:
    problem = only(changed(old, new))
    assert problem.key == key
    assert problem.allowed
    assert problem.value is not None


@pytest.mark.parametrize(
    ("old", "new", "key", "words"),
    [
        ("[0, 160, 360]", "[0, 200, 160]", "law.knots_deg[2]", "rise"),
        ("[0, 160, 360]", "[5, 160, 360]", "law.knots_deg[0]", "not 0"),
        ("[1.6, 0.4, 1.6]", "[1.6, 0.4]", "law.ratios", "2 ratios for 3 knots"),
        ("[1.6, 0.4, 1.6]", "[1.6, 0.4, 1.7]", "law.ratios[2]", "last ratio"),
    ],
)
def test_what_a_law_finds_wrong_gets_its_place(old: str, new: str, key: str, words: str) -> None:
    problem = only(changed(old, new))
    assert problem.key == key
    assert words in problem.message
    assert problem.line == (6 if "knots" in key else 7)


def test_a_unit_where_none_belongs_is_noticed_even_on_a_short_key() -> None:
    law = PAIR[PAIR.index("type") : PAIR.index("[pair]")]
    found = problems(PAIR.replace(law, 'type = "formula"\nr1_mm = "1"\n\n'))
    assert {problem.key: problem.hint for problem in found}["law.r1_mm"] == (
        "did you mean r1? (it has no unit)"
    )


def test_a_formula_that_cannot_be_read_tells_the_column() -> None:
    law = PAIR[PAIR.index("type") : PAIR.index("[pair]")]
    problem = only(PAIR.replace(law, 'type = "formula"\nphi2 = "phi1 - sine(phi1)"\n\n'))
    assert problem.key == "law.phi2"
    assert problem.line == 6
    assert "column 8" in problem.message
    assert "sin" in str(problem)


def test_exactly_one_of_centre_distance_and_module() -> None:
    both = only(changed("center_distance_mm = 180", "center_distance_mm = 180\nmodule_mm = 5"))
    assert (both.key, both.line) == ("pair.module_mm", 11)
    none = only(changed("center_distance_mm = 180\n", ""))
    assert (none.key, none.line) == ("pair", 9)
    assert "exactly one" in none.allowed


def test_what_is_missing_names_its_table() -> None:
    problem = only(changed("teeth = [36, 36]\n", ""))
    assert (problem.key, problem.line, problem.message) == ("pair.teeth", 9, "is missing")
    problem = only(changed('type = "phases"\n', ""))
    assert (problem.key, problem.line) == ("law.type", 4)
    assert {problem.key for problem in problems('kind = "gear-pair"\nname = "x"\n')} == {
        "law",
        "pair",
    }
    assert only(changed('kind = "gear-pair"\n', "")).key == "kind"


@pytest.mark.parametrize("name", ["law", "pair", "rack", "blank", "output", "limits"])
@pytest.mark.parametrize("value", ["3", '"text"', "[[1]]", "true"])
def test_a_table_that_is_no_table_is_refused(name: str, value: str) -> None:
    document = tomllib.loads(PAIR)
    text = "\n".join(line for line in (f"{name} = {value}", *PAIR.splitlines()[:2]))
    text += "".join(
        f"\n[{key}]\n" + "\n".join(f"{k} = {v!r}" for k, v in table.items())
        for key, table in document.items()
        if isinstance(table, dict) and key != name
    )
    assert [problem.key for problem in problems(text)] == [name]


def test_only_an_open_pair_solves_a_knot() -> None:
    text = changed("[0, 160, 360]", '[0, 160, "solve"]')
    assert "driven_travel_deg" in only(text).allowed
    opened = text.replace("[pair]", "driven_travel_deg = 308.3\n[pair]")
    twice = only(opened.replace("[1.6, 0.4, 1.6]", '[1.6, "solve", 1.6]'))
    assert twice.key == "law.ratios[1]"
    assert 'one "solve"' in twice.allowed
    loads(opened)


def test_tables_of_another_kind_are_named_as_such() -> None:
    (problem,) = problems(PAIR + '\n[follower]\ntype = "roller"\n')
    assert problem.message == "unknown table"
    assert problem.hint == 'this table belongs to kind = "cam"'


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("", {"kind"}),
        ("[pair]\nteeth = [20, 20]\nmodule_mm = 2\n", {"kind", "law"}),
        ('kind = "cams"', {"kind", "motion", "follower", "cam"}),
        ("[cam]\nprime_radius_mm = 2\n", {"kind", "motion", "follower"}),
    ],
)
def test_without_a_kind_the_likeliest_one_is_judged(text: str, wrong: set[str]) -> None:
    found = problems(text)
    assert {problem.key for problem in found} == wrong
    (kind,) = [problem for problem in found if problem.key == "kind"]
    assert kind.allowed == quoted(name for name, one in KINDS.items() if not variant_of(one))


def test_splines_are_refused_in_r12_only() -> None:
    assert loads(PAIR + 'dxf_curves = "splines"\n').output.dxf_curves == "splines"
    problem = only(PAIR + 'dxf_curves = "splines"\ndxf_version = "R12"\n')
    assert problem.key == "output.dxf_version"
    assert "does not support splines" in problem.message


def test_a_tolerance_too_coarse_for_the_module_is_refused() -> None:
    by_module = changed("center_distance_mm = 180", "module_mm = 5")
    assert loads(by_module + "chord_tolerance_mm = 0.1").output.chord_tolerance == 0.1
    problem = only(by_module + "chord_tolerance_mm = 0.1001")
    assert "at most pair.module_mm/50 = 0.1 mm" in problem.allowed


@pytest.mark.parametrize(
    "name",
    ["a/b", "..", ".", "", " ", "a b", ".x", "-x", "a\\b", "CON", "nul.txt", "x.", "x" * 101],
)
def test_a_name_that_cannot_name_a_folder_is_refused(name: str) -> None:
    assert only(changed('"good"', repr(name))).key == "name"


@pytest.mark.parametrize("name", ["a", "gear-2_b.1", "räder", "齿轮", "_x"])
def test_a_name_of_letters_in_any_script_is_good(name: str) -> None:
    assert loads(changed("good", name)).name == name


def test_a_design_without_a_name_takes_that_of_its_file() -> None:
    text = changed('name = "good"\n', "")
    assert loads(text, file="dir/wheel.toml").name == "wheel"
    (problem,) = problems(text, "dir/my wheel.toml")
    assert problem.hint == 'add name = "my_wheel"'


def test_limits_are_those_of_the_checks() -> None:
    problem = only(PAIR + "\n[limits]\nno_such_limit = 1\n")
    assert problem.key == "limits.no_such_limit"


def test_the_template_reads_and_shows_every_key() -> None:
    text = template("gear-pair", "my_pair")
    assert read(text).name == "my_pair"
    for words in (
        *("phases", "ellipse", "formula", "constant", "knots_deg", "eccentricity", "phi2", "r1"),
        *("module_mm", "face_width_mm", "pressure_angle_deg", "bore_diameter_mm", "dxf_curves"),
    ):
        assert words in text
    bare = [line.removeprefix("# ") for line in text.splitlines() if " = " in line.split("#  ")[0]]
    assert len(bare) > 15
    assert not any(line != line.rstrip() for line in text.splitlines())
    for line in bare:
        tomllib.loads(line.split(" # ")[0])


def test_what_a_law_finds_is_told_beside_faults_of_single_values() -> None:
    text = changed(
        "knots_deg = [0, 160, 360]\nratios = [1.6, 0.4, 1.6]",
        "knots_deg = [0, 160, 150, 360]\nratios = [1.6, 0.4, -1, 1.6]\nshap = 'cosine'",
    )
    keys = {problem.key for problem in problems(text)}
    assert keys == {"law.knots_deg[2]", "law.ratios[2]", "law.shap"}
