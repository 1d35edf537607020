"""Design files are read strictly; everything wrong in one is told at once, each with its place."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gearcam.design import GearPairDesign, OutputSpec, document_of, load, loads
from gearcam.design.locate import line_at, lines_of
from gearcam.design.template import template
from gearcam.errors import DesignError, Problem
from gearcam.gears.spec import PairSpec, Rack
from gearcam.laws.ellipse import Ellipse
from gearcam.laws.phases import Phases
from gearcam.parts import Blank

PROFILES = sorted((Path(__file__).parents[2] / "profiles").glob("*.toml"))

GOOD = """\
kind = "gear-pair"
name = "good"

[law]
type = "phases"
knots_deg = [0, 160, 360]
ratios = [1.6, 0.4, 1.6]

[pair]
center_distance_mm = 180
teeth = [36, 36]

[output]
files = ["csv"]
"""


def problems(text: str, file: str = "design.toml") -> list[Problem]:
    with pytest.raises(DesignError) as caught:
        loads(text, file=file)
    return list(caught.value.problems)


def only(text: str) -> Problem:
    found = problems(text)
    assert len(found) == 1, "\n".join(map(str, found))
    return found[0]


def changed(old: str, new: str) -> str:
    assert old in GOOD
    return GOOD.replace(old, new)


@pytest.mark.parametrize("path", PROFILES, ids=lambda path: path.stem)
def test_every_profile_is_read(path: Path) -> None:
    design = load(path)
    assert design.name == path.stem
    assert design.source == str(path)


def test_angles_become_radians_and_lengths_stay_millimetres() -> None:
    design = loads(changed('files = ["csv"]', 'files = ["csv"]\nchord_tolerance_mm = 0.002'))
    assert design.law.knots == pytest.approx((0.0, math.radians(160), 2 * math.pi), abs=0)
    assert design.law.ratios == (1.6, 0.4, 1.6)
    assert isinstance(design.pair.center_distance, float)
    assert design.pair.teeth == (36, 36)
    assert design.pair.module is None
    assert design.output.chord_tolerance == 0.002
    assert design.rack.pressure_angle == math.radians(20)


def test_what_is_left_out_takes_its_default() -> None:
    design = loads(GOOD.replace('[output]\nfiles = ["csv"]\n', ""))
    assert design.output.files == OutputSpec().files
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
dxf_curves = "splines"
chord_tolerance_mm = 0
"""
    found = [(problem.line, problem.key) for problem in problems(text)]
    assert found == [
        (1, "kind"),
        (2, "name"),
        (3, "law.knots_deg"),
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
    assert problem.allowed == "a whole number from 3 to 10000"
    assert str(problem).startswith("design.toml:11: pair.teeth[1]: 2 is out of range")
    assert only(changed("teeth =", "shaft = 1\nteeth =")).hint == ""


@pytest.mark.parametrize(
    ("old", "new", "key", "hint"),
    [
        ("knots_deg", "knots", "law.knots", "knots_deg"),
        ("knots_deg", "knots_rad", "law.knots_rad", "knots_deg? (angles are given in deg"),
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
        ("ratios =", "eccentricity = 1\nratios =", "law.eccentricity", '[law] of type "ellipse"'),
        ("ratios =", "teeth = 1\nratios =", "law.teeth", "belongs under [pair]"),
        ("[law]", "center_distance_mm = 180\n[law]", "center_distance_mm", "under [pair]"),
        ("[law]", "modul = 1\n[law]", "modul", "module_mm? (lengths are given in mm"),
        ('"gear-pair"', '"gear pair"', "kind", "gear-pair"),
        ("= 180", '= "180"', "pair.center_distance_mm", "without quotes"),
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


def test_a_formula_that_cannot_be_read_tells_the_column() -> None:
    law = GOOD[GOOD.index("type") : GOOD.index("[pair]")]
    problem = only(GOOD.replace(law, 'type = "formula"\nphi2 = "phi1 - sine(phi1)"\n\n'))
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
    assert {problem.key for problem in problems("")} == {"kind", "law", "pair"}
    assert only(changed('kind = "gear-pair"\n', "")).key == "kind"


@pytest.mark.parametrize("name", ["law", "pair", "rack", "blank", "output", "limits"])
@pytest.mark.parametrize("value", ["3", '"text"', "[[1]]", "true"])
def test_a_table_that_is_no_table_is_refused(name: str, value: str) -> None:
    document = tomllib.loads(GOOD)
    text = "\n".join(line for line in (f"{name} = {value}", *GOOD.splitlines()[:2]))
    text += "".join(
        f"\n[{key}]\n" + "\n".join(f"{k} = {v!r}" for k, v in table.items())
        for key, table in document.items()
        if isinstance(table, dict) and key != name
    )
    assert [problem.key for problem in problems(text)] == [name]


def test_open_pairs_wait_for_a_later_version() -> None:
    text = changed("[0, 160, 360]", '[0, 160, "solve"]')
    assert "not built by this version yet" in only(text).hint
    problem = only(text.replace("[pair]", "driven_travel_deg = 308.3\n[pair]"))
    assert problem.key == "law.driven_travel_deg"
    assert "open pairs" in problem.message


def test_cams_wait_for_a_later_version_and_nothing_else_is_said() -> None:
    problem = only('kind = "cam"\n[follower]\ntype = "roller"\n')
    assert "cams are not built by this version yet" in problem.message


def test_splines_wait_for_a_later_version() -> None:
    problem = only(GOOD + 'dxf_curves = "splines"\n')
    assert "later" in problem.message
    assert problem.allowed == '"arcs" or "lines"'


def test_a_tolerance_too_coarse_for_the_module_is_refused() -> None:
    by_module = changed("center_distance_mm = 180", "module_mm = 5")
    assert loads(by_module + "chord_tolerance_mm = 0.1").output.chord_tolerance == 0.1
    problem = only(by_module + "chord_tolerance_mm = 0.1001")
    assert "module/50 = 0.1 mm" in problem.allowed


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


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("kind = \n", 1, "column 8"),
        ("a = 1\nb 2\n", 2, "="),
        ("a = 1\na = 2\n", 2, "twice"),
        ("a = [1, 2\nb = 3\n", 2, "not closed"),
        ('a = "x\nb = 1\n', 1, "quote"),
        ("a = 1 2\n", 1, "follows"),
        ("[a\nb = 1\n", 1, "]"),
        ("a = [1,\n", 1, "file ends"),
    ],
)
def test_a_slip_of_syntax_is_told_by_line_in_plain_words(text: str, line: int, words: str) -> None:
    problem = only(text)
    assert problem.line == line
    assert words in problem.message


@pytest.mark.parametrize("text", ["a = " + "[" * 5000, "a = " + "9" * 5000, "a = 2020-13-45\n"])
def test_hostile_toml_is_refused_without_a_crash(text: str) -> None:
    only(text)


def test_files_that_cannot_be_read_are_told_plainly(tmp_path: Path) -> None:
    def message(path: Path) -> str:
        with pytest.raises(DesignError) as caught:
            load(path)
        return str(caught.value)

    assert "no such file" in message(tmp_path / "none.toml")
    assert "folder" in message(tmp_path)
    (tmp_path / "latin.toml").write_bytes(b'kind = "gear-pair"\nname = "r\xe4der"\n')
    assert ":2: the byte 0xe4 is not UTF-8" in message(tmp_path / "latin.toml")
    assert "cannot be read" in message(tmp_path / "nul\0.toml")


def test_byte_order_mark_and_windows_line_ends_do_not_matter(tmp_path: Path) -> None:
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert load(path).name == "good"
    path.write_bytes(GOOD.replace("\n", "\r\n").replace("180", "-180").encode())
    with pytest.raises(DesignError) as caught:
        load(path)
    assert caught.value.problems[0].line == 10


def test_a_design_made_in_python_equals_the_one_read() -> None:
    read = loads(GOOD)
    made = GearPairDesign(
        name="good",
        law_type="phases",
        law=Phases(knots=(0.0, math.radians(160), 2 * math.pi), ratios=(1.6, 0.4, 1.6)),
        pair=PairSpec(center_distance=180.0, teeth=(36, 36)),
        output=OutputSpec(files=("csv",)),
    )
    assert (made.law, made.pair, made.rack, made.output) == (
        read.law,
        read.pair,
        read.rack,
        read.output,
    )
    assert made.source == ""
    assert document_of(made) == document_of(read)


def test_a_design_made_in_python_meets_the_same_rules() -> None:
    good = {"name": "e", "law_type": "ellipse", "law": Ellipse(eccentricity=0.3)}
    pair = PairSpec(module=1.0, teeth=(41, 41))
    with pytest.raises(DesignError, match="exactly one") as caught:
        GearPairDesign(**good, pair=PairSpec(module=1.0, center_distance=1.0, teeth=(41, 41)))
    assert caught.value.problems[0].line is None
    with pytest.raises(DesignError, match="out of range"):
        GearPairDesign(**(good | {"law": Ellipse(eccentricity=1.0)}), pair=pair)
    with pytest.raises(DesignError, match="not a law"):
        GearPairDesign(**(good | {"law_type": "elipse"}), pair=pair)
    with pytest.raises(DesignError, match="instance of Phases"):
        GearPairDesign(**(good | {"law_type": "phases"}), pair=pair)
    with pytest.raises(DesignError, match="instance of PairSpec"):
        GearPairDesign(**good, pair=3)  # pyright: ignore[reportArgumentType]
    with pytest.raises(DesignError, match=r"limits\.no_such"):
        GearPairDesign(**good, pair=pair, limits={"no_such": 1.0})


def test_numbers_from_numpy_serve_in_python() -> None:
    knots = tuple(np.radians([0.0, 160.0, 360.0]))
    design = GearPairDesign(
        name="n",
        law_type="phases",
        law=Phases(knots=knots, ratios=tuple(np.array([1.6, 0.4, 1.6]))),
        pair=PairSpec(center_distance=np.float64(180), teeth=tuple(np.array([36, 36]))),  # pyright: ignore
    )
    assert document_of(design)["law"]["knots_deg"] == [0.0, 160.0, 360.0]


@given(st.floats(min_value=5, max_value=35))
def test_degrees_keep_their_range_through_radians(angle: float) -> None:
    rack = f"\n[rack]\npressure_angle_deg = {angle!r}\n"
    design = loads(changed("[output]", rack + "[output]"))
    assert document_of(design)["rack"]["pressure_angle_deg"] == pytest.approx(angle, rel=1e-12)


def test_limits_are_those_of_the_checks() -> None:
    problem = only(GOOD + "\n[limits]\nno_such_limit = 1\n")
    assert problem.key == "limits.no_such_limit"


TOML_VALUES = st.recursive(
    st.integers(-9, 9) | st.booleans() | st.sampled_from(["x", "a # b", "]", "}", "=", "\n"]),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from("abc"), inner, max_size=2)
    ),
    max_leaves=6,
)


def _toml(value: object, breaks: bool) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return (
            f'"""{value}"""'
            if breaks and "\\" not in value
            else '"' + value.replace("\n", "\\n") + '"'
        )
    if isinstance(value, list):
        gap = "\n  # note ]\n" if breaks else " "
        return "[" + "".join(f"{gap}{_toml(item, breaks)}," for item in value) + gap + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_toml(item, False)}" for key, item in value.items()) + "}"
    return str(value)


def _paths(value: object, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    found = [path]
    if isinstance(value, dict):
        found += [place for key, item in value.items() for place in _paths(item, (*path, key))]
    elif isinstance(value, list):
        found += [place for k, item in enumerate(value) for place in _paths(item, (*path, k))]
    return found


@given(st.lists(st.tuples(TOML_VALUES, st.booleans()), min_size=1, max_size=4))
def test_every_place_of_a_document_has_its_line(values: list[tuple[object, bool]]) -> None:
    text = "".join(
        f"[t{k}]\n'k k'.\"q\\u0041\" = {_toml(value, breaks)} # end\n[[many]]\nx = {k}\n"
        for k, (value, breaks) in enumerate(values)
    )
    document, lines = tomllib.loads(text), lines_of(text)
    rows = text.split("\n")
    for path in _paths(document):
        assert path in lines
    for k in range(len(values)):
        assert rows[lines[f"t{k}",] - 1] == f"[t{k}]"
        assert rows[lines["many", k, "x"] - 1] == f"x = {k}"
        assert lines["many", k] == lines["many", k, "x"] - 1
        assert lines[f"t{k}", "k k", "qA"] == lines[f"t{k}",] + 1


def test_a_place_that_is_not_there_falls_back_to_its_parent() -> None:
    lines = lines_of(GOOD)
    assert line_at(lines, ("pair", "module_mm")) == 9
    assert line_at(lines, ("nowhere", "x")) == 1


def test_the_template_reads_and_shows_every_key() -> None:
    text = template("my_pair")
    assert loads(text).name == "my_pair"
    for words in (
        *("phases", "ellipse", "formula", "constant", "knots_deg", "eccentricity", "phi2", "r1"),
        *("module_mm", "face_width_mm", "pressure_angle_deg", "bore_diameter_mm", "dxf_curves"),
    ):
        assert words in text
    bare = [line.removeprefix("# ") for line in text.splitlines() if " = " in line.split("#  ")[0]]
    assert len(bare) > 15
    for line in bare:
        tomllib.loads(line.split(" # ")[0])
