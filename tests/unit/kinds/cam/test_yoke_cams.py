"""Yoke cams: programs of half a turn, what is refused, findings, facts, files."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.cams.disc import YokeCam
from gearcam.designs import loads
from gearcam.laws.half_turns import agreeing, miss
from gearcam.laws.phases_of_lift import fill_half
from helpers_cams import back, dwell, program, rise
from helpers_files import read, refused
from helpers_pairs import PROFILES

FILE = (PROFILES / "yoke_cam.toml").read_text("utf-8")
ROLLER = ('type = "flat"', 'type = "roller"\nroller_radius_mm = 10')
PRIME = ("base_radius_mm = 40", "prime_radius_mm = 50")
LAST = '[[motion]]\ntype = "dwell"\nangle_deg = 30\n\n[follower]'
WHOLE = """\
[[motion]]
type = "dwell"
angle_deg = 60
[[motion]]
type = "return"
law = "cycloidal"
angle_deg = 120
[[motion]]
type = "dwell"
angle_deg = 30

[follower]"""


def test_a_whole_turn_of_two_opposite_half_turns_is_the_same_cam() -> None:
    half, whole = (gearcam.build(read(FILE, *change)) for change in ((), ((LAST, WHOLE),)))
    assert isinstance(whole.cam, YokeCam)
    assert whole.cam.breadth == pytest.approx(100.0, abs=1e-12)
    theta = np.linspace(0.0, 2.0 * math.pi, 50)
    lifts = [result.motion(theta)["lift_mm"] for result in (half, whole)]
    assert lifts[0] == pytest.approx(lifts[1], abs=1e-12)


def test_rest_fills_what_the_lift_means() -> None:
    half = gearcam.build(read(FILE, (LAST, LAST.replace("angle_deg = 30", 'angle_deg = "rest"'))))
    assert half.program.stretches[2].end == pytest.approx(math.pi)
    rest = WHOLE.replace("angle_deg = 30", 'angle_deg = "rest"')
    whole = gearcam.build(read(FILE, (LAST, rest)))
    assert [one.kind for one in whole.program.stretches] == [
        "dwell", "rise", "dwell", "return", "dwell",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("angle_deg = 120", "angle_deg = 110"), r"take 170 deg; 180 deg in all.*take 40 deg"),
        (("angle_deg = 120", "angle_deg = 130"), r"take 190 deg; 180 deg in all.*take 20 deg"),
        (
            (LAST, LAST.replace('"dwell"', '"return"\nlaw = "3-4-5"\nlift_mm = 20')),
            r"ends at the lift with which it begins; another lift.*360 deg",
        ),
    ],
)
def test_phases_that_fill_neither_half_a_turn_nor_a_whole(
    change: tuple[str, str], words: str
) -> None:
    assert re.search(words, refused(FILE, change)["motion"])


def test_other_cams_want_the_whole_turn() -> None:
    with pytest.raises(DesignError, match="take 180 deg\n    allowed: 360 deg in all"):
        read(FILE, ('form = "yoke"', 'form = "disc"'))


SWING = 'type = "roller"\nroller_radius_mm = 10\nmotion = "oscillating"\narm_mm = 90\n'


def test_a_yoke_slides_on_the_axis() -> None:
    found = refused(
        FILE, ('type = "flat"', f"{SWING}pivot_distance_mm = 100"), PRIME, ("_mm = 20", "_deg = 9")
    )
    assert "a yoke is a translating follower" in found["follower.motion"]
    found = refused(FILE, (ROLLER[0], f"{ROLLER[1]}\noffset_mm = 3"), PRIME)
    assert set(found) == {"follower.offset_mm"}
    flat = refused(FILE, (ROLLER[0], 'type = "flat"\noffset_mm = 3'))  # where it moves nothing
    assert "does not apply to a yoke cam" in flat["follower.offset_mm"]


def test_half_turns_that_are_not_opposite_are_refused_with_a_half_that_is() -> None:
    """Rise 120, dwell 30, return 150, dwell 60."""
    text = FILE.replace('[[motion]]\ntype = "dwell"\nangle_deg = 30\n', "", 1)
    text = text.replace(LAST, LAST.replace("[follower]", "") + (
        '[[motion]]\ntype = "return"\nlaw = "cycloidal"\nangle_deg = 150\n'
        '[[motion]]\ntype = "dwell"\nangle_deg = 60\n\n[follower]'
    ))  # fmt: skip
    result = gearcam.build(loads(text))
    with pytest.raises(InfeasibleError, match="are not opposite") as caught:
        _ = result.cam
    error = caught.value
    # the first 30 degrees of the return are not half a turn before a rise
    theta = np.linspace(math.pi, 2.0 * math.pi, 200001)

    def lift(degrees: Any) -> Any:
        up, down = np.clip(degrees / 120, 0, 1), np.clip((degrees - 150) / 150, 0, 1)
        shape = [x - np.sin(2 * np.pi * x) / (2 * np.pi) for x in (up, down)]
        return 20 * (shape[0] - shape[1])

    at = np.degrees(theta)
    off = lift(at) + lift(at - 180) - 20
    worst = int(np.abs(off).argmax())
    assert error.value == pytest.approx(off[worst], abs=1e-8)
    assert f"at {at[worst]:.3f}"[:7] in error.where
    assert "rise 120 deg, dwell 60 deg" in error.nearest
    (way,) = error.adjustments
    built = gearcam.build(result.design.with_(way.near))
    assert built.findings[0].code == "face-width"
    (remedy, *_) = gearcam.remedies(result, patience=30.0).found
    assert remedy.changes == way.near


def test_half_turns_that_agree() -> None:
    def degrees(*phases: Any) -> list[tuple[str, float]]:
        return [
            (type(one).__name__[:-5], round(math.degrees(float(one.angle)), 9))
            for one in agreeing(phases)
        ]  # fmt: skip

    up, down = rise("3-4-5", 120, 20), back("3-4-5", 100)
    assert degrees(up, down, dwell(140)) == [("Rise", 120.0), ("Dwell", 60.0)]
    assert degrees(dwell(100), up, down, dwell(40)) == [("Dwell", 100.0), ("Rise", 80.0)]
    assert degrees(rise("3-4-5", 180, 20), back("3-4-5", 180)) == [("Rise", 180.0)]
    assert degrees(dwell(200), rise("3-4-5", 80, 5), back("3-4-5", 80)) == []
    assert degrees(rise("3-4-5", 80, 5), back("3-4-5", 80), dwell(200)) == []
    assert not fill_half([up, down, dwell(140)])


def test_tables_and_formulas_of_a_turn_need_opposite_half_turns_too() -> None:
    start = FILE.index("[[motion]]")
    rest = FILE[FILE.index("[follower]") :]
    good = f'{FILE[:start]}[motion]\nlift = "10*(1 - cos(theta)) + sin(3*theta)"\n\n{rest}'
    assert gearcam.build(loads(good)).cam.facts
    bad = good.replace("sin(3*theta)", "1e-5*sin(2*theta)")
    with pytest.raises(InfeasibleError, match="are not opposite") as caught:
        _ = gearcam.build(loads(bad)).cam
    assert abs(caught.value.value or 0.0) == pytest.approx(2e-5, rel=1e-2)
    assert caught.value.adjustments == ()
    assert gearcam.build(loads(bad.replace("1e-5", "4e-7"))).cam.facts


def test_the_largest_miss_counts_both_ways() -> None:
    made = program([rise("3-4-5", 180, 20), back("3-4-5", 180)])
    assert abs(miss(made).value) < 1e-13


def test_findings_facts_and_files() -> None:
    result = gearcam.build(read(FILE))
    (finding,) = result.findings
    assert (finding.code, finding.severity) == ("face-width", "note")
    assert finding.value == pytest.approx(2 * 19.09859317103, abs=1e-10)
    assert result.facts["cam.least_base_radius_mm"] == pytest.approx(10.66399483762, abs=1e-10)
    picture = result.files("svg")["cam.svg"].decode()
    disc = gearcam.build(read(FILE, (LAST, WHOLE), ('form = "yoke"', 'form = "disc"')))
    assert picture.count("<path") > disc.files("svg")["cam.svg"].decode().count("<path")
    rollers = gearcam.build(read(FILE, ROLLER, PRIME))
    assert rollers.findings == ()
    assert rollers.facts["cam.roller_distance_mm"] == pytest.approx(120.0, abs=1e-12)


def test_a_small_base_circle_is_undercut_on_one_side() -> None:
    bore = "bore_diameter_mm = 25\nkeyway_width_mm = 8\nkeyway_depth_mm = 3.3\n"
    just, less = (
        gearcam.build(read(FILE, (bore, ""), ("base_radius_mm = 40", f"base_radius_mm = {size}")))
        for size in (10.665, 10.0)
    )
    assert just.cam.walls[0].undercut == []
    assert less.cam.walls[0].undercut
    assert "undercut" in {one.code for one in less.findings}
