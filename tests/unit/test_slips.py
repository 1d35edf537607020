"""What people mistype in a design file is told once, with what they probably meant."""

from __future__ import annotations

import pytest

from helpers_cam_files import ROLLER as CAM
from helpers_cam_files import problems

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
                   "mean center_distance_mm? (lengths are given in mm"),
    "no unit": (PAIR, "knots_deg", "knots", "law.knots", "mean knots_deg? (angles"),
    "of the rack": (PAIR, "[pair]", "[pair]\npressure_angle = 25", "pair.pressure_angle",
                    "and the key says so) (under [rack])"),
    "of a cam": (PAIR, "[pair]", "[pair]\nroller_radius_mm = 6", "pair.roller_radius_mm",
                 'belongs to kind = "cam"'),
    "comma": (PAIR, "[0, 160,", "[0 160,", "", "column 16: a comma is missing here"),
    "unit behind": (PAIR, "180", "180mm", "", "the number alone, without its unit"),
    "unit in quotes": (PAIR, "180", '"180 mm"', "pair.center_distance_mm",
                       "the number alone, without its unit and without quotes"),
    "decimal comma": (PAIR, "180", "180,5", "", "use a decimal point: 180.5"),
    "slash": (PAIR, '"slip"', '"a/slip"', "name", 'name = "a_slip"'),
    "key and table": (PAIR, "[law]", 'law = "phases"\n[law]', "", "the name law is given twice"),
    "lift": (CAM, "lift_mm", "lift", "motion[0].lift", "mean lift_mm?"),
    "diameter": (CAM, "roller_radius_mm", "roller_diameter_mm", "follower.roller_diameter_mm",
                 "mean roller_radius_mm? (half the diameter)"),
    "bore's radius": (CAM, "[output]", "[blank]\nbore_radius_mm = 5\n[output]",
                      "blank.bore_radius_mm", "mean bore_diameter_mm? (twice the radius)"),
    "which radius": (CAM, "offset_mm", "radius_mm", "follower.radius_mm",
                     "mean roller_radius_mm or dome_radius_mm?"),
    "brackets": (CAM, "[follower]", "[[follower]]", "follower", "once: [follower]"),
    "one phase": (CAM, "[[motion]]", "[motion]", "", "tables is written [[motion]]"),
    "a form to come": (CAM, '"disc"', '"cylinder"', "cam.form",
                       '"disc", "groove", "conjugate", "yoke" or "translating"'),
}  # fmt: skip


@pytest.mark.parametrize("name", SLIPS)
def test_a_slip_is_told_with_what_was_meant(name: str) -> None:
    text, old, new, key, words = SLIPS[name]
    assert old in text
    found = problems(text.replace(old, new, 1))
    assert [problem.key or "" for problem in found if problem.message != "is missing"] == [key]
    (slip,) = (problem for problem in found if problem.message != "is missing")
    assert words in f"{slip.message} {slip.allowed} {slip.hint}"


@pytest.mark.parametrize("name", ["British", "other unit", "no unit"])
def test_what_is_misspelt_is_not_missing_too(name: str) -> None:
    text, old, new, _, _ = SLIPS[name]
    assert len(problems(text.replace(old, new, 1))) == 1
    assert len(problems(text.replace(old, "zzz_of_all", 1))) == 2  # where no key is like it it is


def test_all_tables_of_one_name_in_single_brackets() -> None:
    (problem,) = problems(CAM.replace("[[motion]]", "[motion]"))
    assert problem.message.endswith("the table [motion] is given twice")
    assert problem.hint == "each of several tables is written [[motion]]"


def test_where_the_kind_is_missing_and_any_is_likely_only_that_is_told() -> None:
    (problem,) = problems("[blank]\ntip_rounding_mm = 0.3\n")
    assert (problem.key, problem.message) == ("kind", "is missing")
