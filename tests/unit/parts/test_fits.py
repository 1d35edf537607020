"""Limits of ISO 286 are those of the printed tables, at both ends of their ranges of sizes."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import pytest

import gearcam as gc
from gearcam.base.errors import DesignError
from gearcam.parts import fits
from gearcam.parts.fits import GRADES, HOLE, FitSize, hole_problem, in_class_of
from gearcam.parts.shafts import KEYWAYS, SMALLEST, keyway_of

PRINTED = """
1 D11 +80 +20; 3 D8 +34 +20; 6 D9 +60 +30; 10 D10 +98 +40; 500 D11 +630 +230; 3 E7 +24 +14;
18 E8 +59 +32; 30 E9 +92 +40; 400 E7 +182 +125; 6 F7 +22 +10; 30 F8 +53 +20; 180 F6 +68 +43;
500 F8 +165 +68; 3 G7 +12 +2; 120 G7 +47 +12; 450 G5 +47 +20; 1 H5 +4 0; 25 H7 +21 0; 80 H8 +46 0;
500 H6 +40 0; 8 JS9 +18 -18; 25 JS7 +10.5 -10.5; 500 JS5 +13.5 -13.5; 3 K7 0 -10; 10 K6 +2 -7;
30 K7 +6 -15; 50 K8 +12 -27; 400 K5 +3 -22; 3 M7 -2 -12; 18 M8 +2 -25; 300 M6 -9 -41;
500 M9 -23 -178; 3 N9 -4 -29; 8 N9 0 -36; 40 N7 -8 -33; 315 N8 -5 -86; 8 P9 -15 -51; 50 P7 -17 -42;
180 P6 -36 -61; 500 P8 -68 -165; 3 d9 -20 -45; 100 d11 -120 -340; 30 e8 -40 -73; 400 e9 -125 -265;
25 f7 -20 -41; 180 f6 -43 -68; 20 g6 -7 -20; 500 g5 -20 -47; 8 js5 +3 -3; 250 js11 +145 -145;
3 k7 +10 0; 25 k6 +15 +2; 80 k8 +46 0; 30 m6 +21 +8; 50 n6 +33 +17; 120 p5 +52 +37; 66 r6 +62 +43;
200 r7 +123 +77; 141 s7 +140 +100; 500 s6 +292 +252; 36 P9 -26 -88; 28 JS9 +26 -26
"""
"""Size, class, upper and lower limit, um."""

ENDS = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)
H7 = (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63)
P6 = (6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68)
FINER = (50, 65, 80, 100, 120, 140, 160, 180, 200, 225, 250, 280, 315, 355, 400, 450, 500)
R6 = (34, 41, 43, 51, 54, 63, 65, 68, 77, 80, 84, 94, 98, 108, 114, 126, 132)


def differing() -> list[str]:
    """What is printed otherwise."""
    found = []
    for line in PRINTED.replace("\n", " ").split(";"):
        size, name, upper, lower = line.split()
        made = FitSize(f"{size} {name}")
        if (1000 * made.upper, 1000 * made.lower) != pytest.approx((float(upper), float(lower))):
            found.append(line.strip())
    return found


def test_limits_are_those_of_the_printed_tables() -> None:
    assert differing() == []


@pytest.mark.parametrize("name", ["_SIZES", "_FINER"])
def test_ranges_moved_by_one_are_seen(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    ends = getattr(fits, name)
    monkeypatch.setattr(fits, name, (*ends[1:], 1000))
    assert len(differing()) > (40 if name == "_SIZES" else 2)


def test_each_range_holds_from_over_its_lower_to_its_upper_end() -> None:
    for ends, deviations, name in ((ENDS, H7, "H7"), (ENDS, P6, "p6"), (FINER, R6, "r6")):
        for number, (end, deviation) in enumerate(zip(ends, deviations, strict=True)):
            above = f"{ends[number - 1] + 0.001} {name}" if number else f"{end} {name}"
            for size in (FitSize(f"{end} {name}"), FitSize(above)):
                found = size.upper if name == "H7" else size.lower
                assert 1000 * found == pytest.approx(deviation), (size, deviation)


def test_every_class_is_as_wide_as_its_grade_and_those_with_play_lie_on_their_side() -> None:
    for letter, (first, last) in GRADES.items():
        for grade in range(first, last + 1):
            for end in ENDS:
                size, plain = FitSize(f"{end} {letter}{grade}"), FitSize(f"{end} H{grade}")
                assert size.upper - size.lower == pytest.approx(plain.upper, abs=1e-12)
                inside = size.lower >= 0.0 if letter in "DEFGH" else size.upper <= 0.0
                assert inside or letter not in "DEFGHdefgh", size


def test_a_hole_and_the_shaft_of_its_letter_fit_as_with_a_plain_one() -> None:
    """Holes K to N up to grade 8 and P to S up to 7: their fit with h is that of H with shafts."""
    for letter, last in (("K", 8), ("M", 8), ("N", 8), ("P", 7), ("R", 7), ("S", 7)):
        for grade in range(6, last + 1):
            for end in ENDS[1:]:
                if (letter, grade, end) == ("M", 6, 315):
                    continue  # printed otherwise
                hole, shaft = f"{end} {letter}{grade}", f"{end} {letter.lower()}{grade - 1}"
                # largest play: with h one grade finer, or that shaft in H of the grade
                finer = FitSize(f"{end} h{grade - 1}").lower
                wide = FitSize(f"{end} H{grade}").upper
                play = FitSize(hole).upper - finer
                assert play == pytest.approx(wide - FitSize(shaft).lower, abs=1e-12), hole


def test_a_size_with_a_class_is_a_number() -> None:
    size = gc.FitSize(" 25H07 ")
    assert (size, size.tolerance_class, size.lower, size.upper) == (25.0, "H7", 0.0, 0.021)
    assert (str(size), repr(size)) == ("25 H7", "FitSize('25 H7')")
    assert {size} == {25.0}
    assert type(2.0 * size) is float
    for other in (pickle.loads(pickle.dumps(size)), copy.copy(size), copy.deepcopy(size)):
        assert (type(other), str(other), other.upper) == (FitSize, "25 H7", 0.021)
    assert str(FitSize(str(FitSize("6.35 h6")))) == "6.35 h6"


@pytest.mark.parametrize(
    ("text", "words", "allowed"),
    [
        ("H7", "is not a size with a tolerance class", '"25 H7"'),
        ("25", "is not a size with a tolerance class", '"25 H7"'),
        ("25,5 H7", "is not a size with a tolerance class", '"25 H7"'),
        ("25 H15", "limits of H15 are not known", "H5 to H14"),
        ("25 K9", "limits of K9 are not known", "K5 to K8"),
        ("25 ZA7", "the letter ZA is not known", "D, E, F"),
        ("0.9 H7", "not known for this size", "from 1 to 500 mm"),
        ("500.1 H7", "not known for this size", "from 1 to 500 mm"),
    ],
)
def test_what_is_not_known_is_refused_with_what_is(text: str, words: str, allowed: str) -> None:
    with pytest.raises(DesignError) as caught:
        gc.FitSize(text)
    (problem,) = caught.value.problems
    assert words in problem.message
    assert allowed in problem.allowed


@pytest.mark.parametrize(
    ("text", "near"),
    [
        ("25 h7", "25 H7"), ("25 k9", "25 K8"), ("25 H18", "25 H14"), ("25 H1", "25 H5"),
        ("25 G9", "25 G7"), ("25 B11", "25 D11"), ("25 ZA7", "25 S7"), ("600 H7", ""),
    ],
)  # fmt: skip
def test_the_nearest_class_of_a_hole_is_told(text: str, near: str) -> None:
    what, allowed, told = hole_problem(text)
    assert what
    assert allowed
    assert told == near
    if near:
        assert hole_problem(near) == ("", "", "")


def test_the_pattern_of_the_schema_is_that_of_holes() -> None:
    import re

    for letter in GRADES:
        assert bool(re.fullmatch(HOLE, f"25.5 {letter}8")) == letter.isupper()
    assert not re.fullmatch(HOLE, "25")


@pytest.mark.parametrize(
    ("given", "value", "kept"),
    [
        ("25 H7", 26.5, "26.5 H7"),
        ("25 H7", 600.0, 600.0),
        (25.0, 26.0, 26.0),
        ("none", 26.0, 26.0),
        (["25 H7", "25 H7"], 26.0, "26 H7"),
        (["25 H7", 16.0], 20.0, ["20 H7", 20.0]),
        (["25 H7", 16.0], [20.0, 0.0], ["20 H7", 0.0]),
        ([24, 24], [30, 30], [30, 30]),
        ("25 H7", "30 H8", "30 H8"),
    ],
)
def test_another_size_keeps_the_class(given: Any, value: Any, kept: Any) -> None:
    assert in_class_of(given, value) == kept


def test_keyways_are_those_of_the_standard() -> None:
    """Bores with width, height and depths in shaft and hub as printed for them."""
    printed = {
        (6, 7, 8): (2, 2, 1.2, 1), (9, 10): (3, 3, 1.8, 1.4), (11, 12): (4, 4, 2.5, 1.8),
        (13, 14, 17): (5, 5, 3, 2.3), (18, 20, 22): (6, 6, 3.5, 2.8),
        (24, 25, 28, 30): (8, 7, 4, 3.3), (32, 38): (10, 8, 5, 3.3), (40, 44): (12, 8, 5, 3.3),
        (50,): (14, 9, 5.5, 3.8), (100,): (28, 16, 10, 6.4), (230,): (50, 28, 17, 11.4),
    }  # fmt: skip
    for bores, row in printed.items():
        for bore in bores:
            assert (key := keyway_of(bore)) is not None
            assert key[1:] == row
    assert keyway_of(SMALLEST - 1e-9) is None
    assert keyway_of(230.001) is None
    for key in KEYWAYS:
        both = round(key.shaft_depth + key.hub_depth - key.height, 9)
        assert both == (0.2 if key.width <= 3 else 0.3 if key.width <= 16 else 0.4)
        above = keyway_of(key.largest + 1e-9)
        assert above is None or above.largest > key.largest
    deeper = {key.width: key.tolerance for key in KEYWAYS}
    assert (deeper[6], deeper[8], deeper[32], deeper[36]) == (0.1, 0.2, 0.2, 0.3)
    assert [1000 * keyway_of(bore).hub_width.upper for bore in (10, 12, 30, 44, 75, 130)] == (  # pyright: ignore
        pytest.approx([12.5, 15, 18, 21.5, 26, 31])
    )


@pytest.mark.parametrize(
    ("text", "upper"),
    [("3 H12", 100), ("6.6 H13", 220), ("30 H12", 210), ("400 H13", 890), ("500 H14", 1550)],
)
def test_holes_for_screws_have_coarse_grades(text: str, upper: float) -> None:
    assert (FitSize(text).lower, FitSize(text).upper) == (0.0, pytest.approx(upper / 1000))
