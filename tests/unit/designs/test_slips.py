"""What people mistype in a design file is told once, with what they probably meant."""

from __future__ import annotations

import pytest

from helpers_files import ROLLER as CAM
from helpers_files import problems

PAIR = """\
kind = "gear-pair"
name = "slip"
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

SLIPS: dict[str, tuple[str, str, str, str, str]] = {
    "British": (PAIR, "center_", "centre_", "pair.centre_distance_mm", "mean center_distance_mm?"),
    "other unit": (PAIR, "center_distance_mm", "center_distance_cm", "pair.center_distance_cm",
                   "mean center_distance_mm? (lengths are in mm: 1 cm = 10 mm)"),
    "no unit": (PAIR, "knots_deg", "knots", "law.knots", "mean knots_deg? (angles"),
    "of the rack": (PAIR, "[pair]", "[pair]\npressure_angle = 25", "pair.pressure_angle",
                    "and their keys end in _deg) (under [rack])"),
    "of a cam": (PAIR, "[pair]", "[pair]\nroller_radius_mm = 6", "pair.roller_radius_mm",
                 'belongs to kind = "cam"'),
    "comma": (PAIR, "[0, 160,", "[0 160,", "", "column 16: a comma or the closing ]"),
    "unit behind": (PAIR, "180", "180mm", "", "the number alone, without its unit"),
    "unit in quotes": (PAIR, "180", '"180 mm"', "pair.center_distance_mm",
                       "write 180: the number alone, without its unit"),
    "inches in quotes": (PAIR, "180", '"0.5 in"', "pair.center_distance_mm", "write 12.7: "),
    "a fraction of an inch": (PAIR, "180", "'1/4\"'", "pair.center_distance_mm", "write 6.35: "),
    "a mixed fraction": (PAIR, "180", '"1 1/4in"', "pair.center_distance_mm", "write 31.75: "),
    "a fraction alone": (PAIR, "180", '"1/4"', "pair.center_distance_mm",
                         "write 0.25, or 6.35 if it is in inches"),
    "a fraction without quotes": (PAIR, "180", "1/4in", "", "write 6.35: 1/4in is 6.35 mm"),
    "centimetres": (PAIR, "180", '"2 cm"', "pair.center_distance_mm", "2 cm is 20 mm"),
    "radians": (PAIR, "[output]", "[rack]\npressure_angle_deg = '0.35 rad'\n[output]",
                "rack.pressure_angle_deg", "write 20.05352283: 0.35 rad is"),
    "beyond the range": (PAIR, "180", '"1000 ft"', "pair.center_distance_mm",
                         "1000 ft is 304800 mm"),
    "no unit of length": (PAIR, "180", '"18 apples"', "pair.center_distance_mm",
                          "apples is no unit that is known: write the number alone, in mm"),
    "a screw": (PAIR, "[output]", '[blank]\nbore_diameter_mm = "M3"\n[output]',
                "blank.bore_diameter_mm",
                "write 3.4, the hole for M3 (ISO 273, medium), or 3, its nominal diameter"),
    "a screw without quotes": (PAIR, "[output]", "[blank]\nbore_diameter_mm = M12\n[output]",
                               "", "write 13.5, the hole for M12 (ISO 273, medium), or 12"),
    "curly quotes": (PAIR, '"gear-pair"', "\u201cgear-pair\u201d", "",
                     "\u201c is a typographic character, left double quotation mark (U+201C)"),
    "a curly end": (PAIR, '"gear-pair"', '"gear-pair\u201d', "", 'write " in its place'),
    "a minus sign": (PAIR, "180", "\u2212180", "", "minus sign (U+2212)  write - in its place"),
    "a space that does not break": (PAIR, "= 180", "=\u00a0180", "", "write a plain space"),
    "no width": (PAIR, "180", "180\u200b", "", "zero width space (U+200B)  leave it out"),
    "a dash in a key": (PAIR, "center_", "center\u2013", "", "en dash (U+2013)  write -"),
    "a dwell of a pair": (PAIR, "0.4", "0", "law.ratios[1]", "cannot stand still"),
    "decimal comma": (PAIR, "180", "180,5", "", "write 180.5, with a decimal point"),
    "slash": (PAIR, '"slip"', '"a/slip"', "name", 'name = "a_slip"'),
    "key and table": (PAIR, "[law]", 'law = "phases"\n[law]', "", "the name law is given twice"),
    "lift": (CAM, "lift_mm", "lift", "motion[0].lift", "mean lift_mm?"),
    "diameter": (CAM, "roller_radius_mm", "roller_diameter_mm", "follower.roller_diameter_mm",
                 "mean roller_radius_mm? (half the diameter)"),
    "bore's radius": (CAM, "[output]", "[blank]\nbore_radius_mm = 5\n[output]",
                      "blank.bore_radius_mm", "mean bore_diameter_mm? (twice the radius)"),
    "which radius": (CAM, "offset_mm", "radius_mm", "follower.radius_mm",
                     "mean roller_radius_mm or dome_radius_mm?"),
    "diameter or radius of two": (CAM, "offset_mm", "diameter_mm", "follower.diameter_mm",
                                  "mean roller_radius_mm or dome_radius_mm? (half the diameter)"),
    "diameter in inches": (CAM, "roller_radius_mm", "roller_dia_in", "follower.roller_dia_in",
                           "(lengths are in mm: 1 in = 25.4 mm) (half the diameter)"),
    "circle's radius": (PAIR, "[output]", "[blank]\nbolt_circle_radius_mm = 5\n[output]",
                        "blank.bolt_circle_radius_mm", "mean bolt_circle_mm? (twice the radius)"),
    "one of two": (PAIR, "[36, 36]", "36", "pair.teeth",
                   "from 3 to 3000 write teeth = [36, 36]"),
    "the first of two": (PAIR, "[output]", "[errors]\ntilt_deg = 0.1\n[output]", "errors.tilt_deg",
                         "write tilt_deg = [0.1, 0"),
    "one of any": (PAIR, '["csv"]', '"csv, dfx"', "output.files",
                   'write files = ["csv", "dxf"]'),
    "no quotes": (PAIR, '"gear-pair"', "gear-pair", "", 'write kind = "gear-pair"'),
    "Python's word": (PAIR, '"gear-pair"', "True  # yes", "", "write kind = true"),
    "fall": (CAM, '"return"', '"fall"', "motion[2].type", "did you mean return?"),
    "hold": (CAM, '"dwell"', '"hold"', "motion[1].type", "did you mean dwell?"),
    "brackets": (CAM, "[follower]", "[[follower]]", "follower", "in single brackets: [follower]"),
    "one phase": (CAM, "[[motion]]", "[motion]", "", "of these tables write [[motion]]"),
    "a form": (CAM, '"disc"', '"disk"', "cam.form",
               '"disc", "groove", "conjugate", "yoke", "translating", "cylinder" or "globoidal"'),
}  # fmt: skip


MEASURES = [
    # key, what is written in or without quotes, the hint
    ("offset_mm", "36,5", "write 36.5, with a decimal point"),
    ("offset_mm", ".5", "write 0.5"),
    ("offset_mm", "1.5 rad", "rad is a unit of angle: write a length in mm"),
    ("offset_mm", "12 \N{DEGREE SIGN}", "\N{DEGREE SIGN} is a unit of angle: write a length in mm"),
    ("offset_mm", "2 thou", "write 0.0508: 2 thou is 0.0508 mm"),
    ("offset_mm", "2 mil", "write 0.0508: 2 mil is 0.0508 mm"),
    ("offset_mm", "1'", "write 304.8: 1' is 304.8 mm"),
    ("offset_mm", '3/8"', 'write 9.525: 3/8" is 9.525 mm'),
    ("offset_mm", "3/8\u2033", 'write 9.525: 3/8" is 9.525 mm'),
    ("offset_mm", "\N{VULGAR FRACTION ONE HALF}in", "write 12.7: 1/2in is 12.7 mm"),
    ("offset_mm", "3\N{VULGAR FRACTION THREE EIGHTHS} in", "write 85.725: 3 3/8 in is 85.725 mm"),
    ("offset_mm", "1 1/2 in", "write 38.1: 1 1/2 in is 38.1 mm"),
    ("offset_mm", "-1/2", "write -0.5, or -12.7 if it is in inches"),
    ("offset_mm", "1e3 um", "write 1: 1e3 um is 1 mm"),
    ("offset_mm", "1/4-20", ("1/4-20: write 6.35, its major diameter in mm (0.25 in; 20 is its "
     "threads per inch)")),
    ("offset_mm", "1-1/8-7 UNC", ("1-1/8-7 UNC: write 28.575, its major diameter in mm (1.125 in; "
     "7 is its threads per inch)")),
    ("offset_mm", "#8", "#8: write 4.1656, its major diameter in mm (0.060 + 0.013 x 8 in)"),
    ("roller_radius_mm", "#10-32", ("#10-32: write 2.413, half of its major diameter in mm (0.060 "
     "+ 0.013 x 10 in; 32 is its threads per inch)")),
    ("roller_radius_mm", "M6x1", ("M6: write 3.3, half of the hole for M6 (ISO 273, medium), or 3, "
     "half of its nominal diameter")),
    ("offset_mm", "6H7", "write 6: the fit H7 has no key"),
    ("offset_mm", "12 mm js6", ("write 12: the number alone, without its unit; the fit js6 has no "
     "key")),
    ("offset_mm", "12\u00b10.1", "write the number alone, in mm"),
    ("roller_radius_mm", "\u00d850", "write 25: half the diameter"),
    ("roller_radius_mm", "\u00f850 H7", "write 25: half the diameter; the fit H7 has no key"),
    ("roller_radius_mm", "\u23001/2 in", "write 6.35: 1/2 in is 12.7 mm; half the diameter"),
    ("roller_radius_mm", "D50", "write 25: half the diameter"),
    ("roller_radius_mm", "R12.5", "write 12.5: the radius"),
    ("offset_mm", "R12.5", "write 12.5, the radius, or 25, the diameter"),
    ("pressure_angle_deg", "20,5", "write 20.5, with a decimal point"),
    ("pressure_angle_deg", "0.35 radians", "write 20.05352283: 0.35 radians is 20.05352283 deg"),
    ("pressure_angle_deg", "5 mm", "mm is a unit of length: write an angle in deg"),
    ("pressure_angle_deg", "900'", "write 15: 900' is 15 deg"),
]  # fmt: skip


@pytest.mark.parametrize("quote", ["", "'''", "\u201c"])
@pytest.mark.parametrize(("key", "written", "hint"), MEASURES)
def test_a_measure_is_answered_with_the_number_to_write(
    key: str, written: str, hint: str, quote: str
) -> None:
    value = f"{quote}{written}{quote.replace(chr(0x201C), chr(0x201D))}"
    if key == "pressure_angle_deg":
        text = PAIR.replace("[output]", f"[rack]\n{key} = {value}\n[output]")
    else:
        head = {"offset_mm": "offset_mm = 8", "roller_radius_mm": "roller_radius_mm = 6"}[key]
        assert head in CAM
        text = CAM.replace(head, f"{key} = {value}")
    assert [one.hint for one in problems(text)] == [hint]


@pytest.mark.parametrize(
    ("written", "hint"),
    [
        ("36.5", "write 36.5 without quotes"),
        ("1e3", "write 1000"),
        ("inf", ""),
        ("nan", ""),
        ("1e9", ""),
        ("10-12", "write the number alone, in mm"),
        ("-R5", ""),
    ],
)
def test_a_number_in_quotes_is_proposed_only_if_it_can_be_written(written: str, hint: str) -> None:
    assert [one.hint for one in problems(CAM.replace("= 8", f'= "{written}"'))] == [hint]


@pytest.mark.parametrize("name", SLIPS)
def test_a_slip_is_told_with_what_was_meant(name: str) -> None:
    text, old, new, key, words = SLIPS[name]
    assert old in text
    found = problems(text.replace(old, new, 1))
    assert [problem.key or "" for problem in found if problem.message != "is missing"] == [key]
    (slip,) = (problem for problem in found if problem.message != "is missing")
    assert words in f"{slip.message} {slip.allowed} {slip.hint}"


MISTAKES = [
    # table, key as a first user may write it, the keys that are offered
    (PAIR, "blank", "bore_mm", "bore_diameter_mm"),
    (PAIR, "blank", "bore", "bore_diameter_mm"),
    (PAIR, "blank", "bore_dia_mm", "bore_diameter_mm"),
    (PAIR, "blank", "bore_diameter_in", "bore_diameter_mm"),
    (PAIR, "blank", "bore_size_mm", "bore_diameter_mm"),
    (PAIR, "blank", "hub_mm", "hub_diameter_mm"),
    (PAIR, "blank", "hub_dia", "hub_diameter_mm"),
    (PAIR, "blank", "keyway_mm", "keyway_width_mm"),
    (PAIR, "blank", "bolt_mm", "bolt_diameter_mm"),
    (PAIR, "blank", "number_of_bolts", "bolts"),
    (PAIR, "blank", "bolt_circle_diameter_mm", "bolt_circle_mm"),
    (PAIR, "blank", "density", "density_kg_m3"),
    (PAIR, "blank", "clearence_mm", "clearance_mm"),
    (PAIR, "pair", "teeth_count", "teeth"),
    (PAIR, "pair", "number_of_teeth", "teeth"),
    (PAIR, "pair", "tooth", "teeth"),
    (PAIR, "pair", "centre_distance_mm", "center_distance_mm"),
    (PAIR, "pair", "centre_distance", "center_distance_mm"),
    (PAIR, "pair", "distance_mm", "center_distance_mm"),
    (PAIR, "pair", "centerdistance_mm", "center_distance_mm"),
    (PAIR, "pair", "center_distance_in", "center_distance_mm"),
    (PAIR, "pair", "width_mm", "face_width_mm"),
    (PAIR, "pair", "thickness_mm", "face_width_mm"),
    (PAIR, "blank", "thickness_mm", "face_width_mm"),
    (PAIR, "pair", "z", "teeth"),
    (PAIR, "pair", "profile_shift", "x"),
    (PAIR, "blank", "shaft_diameter_mm", "bore_diameter_mm"),
    (PAIR, "pair", "module", "module_mm"),
    (PAIR, "rack", "pressure_angle_rad", "pressure_angle_deg"),
    (PAIR, "rack", "angle_deg", "pressure_angle_deg"),
    (PAIR, "rack", "addendum_mm", "addendum"),
    (PAIR, "law", "knot_deg", "knots_deg"),
    (PAIR, "law", "knots_rad", "knots_deg"),
    (PAIR, "law", "ratio", "ratios"),
    (PAIR, "output", "tolerance_mm", "chord_tolerance_mm"),
    (PAIR, "output", "kerf", "kerf_mm"),
    (PAIR, "output", "kerf_width_mm", "kerf_mm"),
    (PAIR, "output", "file", "files"),
    (CAM, "cam", "radius_mm", "prime_radius_mm or base_radius_mm"),
    (CAM, "cam", "base_diameter_mm", "base_radius_mm"),
    (CAM, "cam", "base_circle_radius_mm", "base_radius_mm"),
    (CAM, "cam", "prime_radius_in", "prime_radius_mm"),
    (CAM, "cam", "thick_mm", "thickness_mm"),
    (CAM, "cam", "width_mm", "thickness_mm"),
    (CAM, "cam", "direction", "rotation"),
    (CAM, "follower", "roller_mm", "roller_radius_mm"),
    (CAM, "follower", "roller_diameter_mm", "roller_radius_mm"),
    (CAM, "follower", "radius_mm", "roller_radius_mm or dome_radius_mm"),
    (CAM, "follower", "arm_length_mm", "arm_mm"),
    (CAM, "follower", "ofset_mm", "offset_mm"),
    (CAM, "blank", "bore_mm", "bore_diameter_mm"),
    (CAM, "blank", "bore_rad", "bore_diameter_mm"),
    (CAM, "blank", "thickness_mm", ""),  # which is no width of a keyway
    (PAIR, "pair", "dp", "module_mm"),
    (PAIR, "blank", "holes", "bolts or lightening_holes"),
    (PAIR, "blank", "hole_diameter_mm", "bolt_diameter_mm"),
    (PAIR, "blank", "pcd_mm", "bolt_circle_mm"),
    (PAIR, "blank", "bore_fit", "bore_diameter_mm"),
    (PAIR, "blank", "marks", "timing_marks"),
    (CAM, "blank", "marks", "zero_mark"),
    (CAM, "blank", "bevel_mm", "chamfer_mm"),
    (PAIR, "bar", "holes", "bolts"),
    (PAIR, "bar", "hole_spacing_mm", "bolt_spacing_mm"),
    (PAIR, "drawing", "hardness", "heat_treatment"),
    (PAIR, "drawing", "surface_roughness", "surface"),
    (PAIR, "drawing", "finish", "surface"),
    (PAIR, "drawing", "tolerance", "general_tolerances"),
    (PAIR, "drawing", "tolerances", "general_tolerances"),
    (PAIR, "drawing", "title", "part_number"),
    (PAIR, "drawing", "name", "part_number"),
    (PAIR, "drawing", "number", "part_number"),
    (PAIR, "drawing", "checked_by", "approved_by"),
    (PAIR, "drawing", "drawn_by", "author"),
    (PAIR, "drawing", "company", "owner"),
]


@pytest.mark.parametrize(("text", "title", "key", "meant"), MISTAKES)
def test_a_likely_mistake_is_answered_with_the_key_that_was_meant(
    text: str, title: str, key: str, meant: str
) -> None:
    head = f"[{title}]"
    text = text.replace(head, f"{head}\n{key} = 1") if head in text else f"{text}{head}\n{key} = 1"
    (hint,) = (one.hint for one in problems(text) if one.key == f"{title}.{key}")
    assert hint.startswith(f"did you mean {meant}?") if meant else "did you" not in hint


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("[rackbar]\nheight_mm = 9", "bar?"),
        ("[rack_bar]\nheight_mm = 9", "bar?"),
        ("[title_block]\nauthor = 'A'", "drawing?"),
        ("[output]\nfiles = ['pdf']", "drawing-pdf or print-pdf?"),
        ("[output]\nfiles = ['drawing']", "drawing-pdf?"),
        ("[output]\nprocess = 'edm'", "wire?"),
        ("[blank]\nset_screw = 'M3x5'", "M3?"),
        ("[blank]\nmotor = 'TT'", 'blank.shaft = "TT"?'),
        ("[blank]\ntolerance = 'H7'", 'bore_diameter_mm? (size and class: "25 H7")'),
    ],
)
def test_what_makers_call_tables_and_words_is_answered(text: str, hint: str) -> None:
    title = text.split("\n")[0]
    (problem,) = problems(f"{PAIR.split(title)[0]}\n{text}\n")
    assert problem.hint == f"did you mean {hint}"


@pytest.mark.parametrize(("unit", "size"), [("ft", "304.8"), ("thou", "0.0254")])
def test_a_key_of_another_unit_is_answered_with_the_factor(unit: str, size: str) -> None:
    text = PAIR.replace("center_distance_mm", f"center_distance_{unit}")
    (problem,) = problems(text)
    hint = f"did you mean center_distance_mm? (lengths are in mm: 1 {unit} = {size} mm)"
    assert problem.hint == hint


@pytest.mark.parametrize("name", ["British", "other unit", "no unit"])
def test_what_is_misspelt_is_not_missing_too(name: str) -> None:
    text, old, new, _, _ = SLIPS[name]
    assert len(problems(text.replace(old, new, 1))) == 1
    assert len(problems(text.replace(old, "zzz_of_all", 1))) == 2  # where no key is like it it is


def test_all_tables_of_one_name_in_single_brackets() -> None:
    (problem,) = problems(CAM.replace("[[motion]]", "[motion]"))
    assert problem.message.endswith("the table [motion] is given twice")
    assert problem.hint == "for several of these tables write [[motion]]"


def test_where_the_kind_is_missing_and_any_is_likely_only_that_is_told() -> None:
    (problem,) = problems("[blank]\ntip_rounding_mm = 0.3\n")
    assert (problem.key, problem.message) == ("kind", "is missing")


@pytest.mark.parametrize(
    ("text", "word", "meant"),
    [
        (CAM, "plate-cam", 'kind = "cam" with cam.form = "disc"'),
        (CAM, "disk cam", 'kind = "cam" with cam.form = "disc"'),
        (CAM, "cams", 'kind = "cam"'),
        (PAIR, "gears", 'kind = "gear-pair"'),
        (PAIR, "gearpair", 'kind = "gear-pair"'),
    ],
)
def test_another_name_of_a_kind_is_answered_alone(text: str, word: str, meant: str) -> None:
    kind = 'kind = "gear-pair"' if text is PAIR else 'kind = "cam"'
    (problem,) = problems(text.replace(kind, f'kind = "{word}"', 1))
    assert (problem.key, problem.hint) == ("kind", f"did you mean {meant}?")
    assert "spatial" not in problem.allowed, "how cylinder cams are called inside"


@pytest.mark.parametrize(
    ("table", "hint"),
    [
        ("[tool]\ndepth_mm = 1", 'belongs to cam.form = "cylinder"'),
        ("[turret]\nstops = 8", 'belongs to cam.form = "globoidal"'),
        ("[pair]\nmodule_mm = 1", 'belongs to kind = "gear-pair"'),
    ],
)
def test_a_table_of_another_form_or_kind_is_told_as_it_is_written(table: str, hint: str) -> None:
    (problem,) = problems(f"{CAM}\n{table}\n")
    assert problem.hint.endswith(hint)


def hints_of(text: str) -> dict[str, str]:
    return {problem.key: problem.hint for problem in problems(text)}


def test_a_misspelt_type_does_not_hide_the_other_keys_of_its_table() -> None:
    law = PAIR.replace('"phases"', '"phase"').replace("knots_deg", "knot_deg")
    assert hints_of(law) == {
        "law.type": "did you mean phases?", "law.knot_deg": "did you mean knots_deg?"
    }  # fmt: skip
    cam = CAM.replace('"rise"', '"rize"').replace("lift_mm", "lift").replace('"disc"', '"disk"')
    assert {key: hint[:21] for key, hint in hints_of(cam).items()} == {
        "motion[0].type": "did you mean rise?",
        "motion[0].lift": "did you mean lift_mm?",
        "cam.form": "did you mean disc?",
    }
    curve = CAM.replace("cycloidal", "cycloidel", 1).replace("lift_mm", "lft_mm")
    assert hints_of(curve) == {
        "motion[0].law": "did you mean cycloidal?", "motion[0].lft_mm": "did you mean lift_mm?"
    }  # fmt: skip
    groove = CAM.replace('"disc"', '"grove"').replace("[cam]", "[cam]\ngroove_dept_mm = 4")
    assert hints_of(groove)["cam.groove_dept_mm"] == "did you mean groove_depth_mm?"


def test_where_no_type_is_like_it_the_hint_says_that_the_other_keys_wait() -> None:
    waits = "the other keys of this table are checked once its type is known"
    assert hints_of(PAIR.replace('"phases"', '"zzz"')) == {"law.type": waits}
    assert hints_of(PAIR.replace('type = "phases"\n', "")) == {"law.type": waits}
    assert hints_of(CAM.replace('"rise"', '"zzz"'))["motion[0].type"] == waits
    assert "known" not in hints_of('kind = "gear-pair"\nname = "a"\n[law]\n')["law.type"]
