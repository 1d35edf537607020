"""Programs for a rotary axis as a controller runs them: start and end, words of A, times, head."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.spatial.milling import RotaryPath
from helpers_gcode import BEGIN, TOP, Program, minutes, read, turned
from helpers_sampling import chosen

RADIUS = 39.08


@cache
def built(cam: str, tool: str, outer: str = "78.16", rise: str = "120") -> gc.SpatialCamResult:
    """A barrel cam, cut coarsely; more keys of its tables as TOML."""
    lines = f"""
        kind = "cam"
        name = "barrel"
        [[motion]]
        type = "rise"
        law = "cycloidal"
        angle_deg = {rise}
        lift_mm = 20
        [[motion]]
        type = "dwell"
        angle_deg = 60
        [[motion]]
        type = "return"
        law = "3-4-5"
        angle_deg = 120
        [[motion]]
        type = "dwell"
        angle_deg = "rest"
        [follower]
        roller_radius_mm = 5
        [cam]
        form = "cylinder"
        outer_diameter_mm = {outer}
        lowest_mm = 24
        length_mm = 70
        groove_depth_mm = 6
        {cam}
        [tool]
        {tool}
        [output]
        files = ["gcode"]
        path_tolerance_mm = 0.05
    """
    design = gc.loads("\n".join(line.strip() for line in lines.splitlines()))
    return gc.build(design)  # pyright: ignore


@cache
def text_of(cam: str = "", tool: str = "", outer: str = "78.16") -> str:
    """Its program."""
    return built(cam, tool, outer).files("gcode")["cam.nc"].decode()


CAMS = {
    "groove": "",
    "clockwise": 'rotation = "cw"',
    "lower": 'walls = "lower"',
    "upper": 'walls = "upper"\nrotation = "cw"',
    "rib": 'walls = "rib"\nrib_mm = 8',
}
SMALL = "diameter_mm = 6\nfeed_mm_min = 200\nspindle_rpm = 8000"
WRAPPED = f'{SMALL}\nrotary = "wrapped"'


def on_wrapped_axis(given: str) -> float:
    """Where A goes by "from word"."""
    at, word = given.split()
    return turned(float(at), word.removeprefix("A"), wrapped=True)


def test_the_reader_turns_a_wrapped_axis_as_linuxcnc_does() -> None:
    known = {
        "5 A350": 350, "5 A-350": -10, "365 A10": 370, "365 A-10": 10, "365 A-350": 350,
        "359.9 A5": 365, "10 A0": 360, "10 A-0": 0, "-10 A350": -10, "725 A5": 725,
        "10.00004 A10.00000": 370,
    }  # fmt: skip
    assert {key: on_wrapped_axis(key) for key in known} == pytest.approx(known)
    with pytest.raises(AssertionError, match="is no place"):
        on_wrapped_axis("0 A360")


BLOCKS = {
    (0.05, 1.0): 438.657505565,
    (0.0, 1.0): 439.834540786,
    (0.8, -2.5): 159.275933992,
}
"""Inverse times of moves along X, mm, and A, deg, at 300 mm/min on the radius."""


@pytest.mark.parametrize(("step", "rate"), BLOCKS.items())
def test_a_move_takes_the_time_of_its_length_at_the_outside(
    step: tuple[float, float], rate: float
) -> None:
    end = [step[0], 0.0, 0.0, math.radians(step[1])]
    moves, nothing = np.array([[0.0] * 4, end]), np.zeros(2, dtype=bool)
    path = RotaryPath(
        moves=moves, turn=np.zeros(2, dtype=int), rapid=nothing, layers=1, tool=(3.0, 3.0),
        radius=RADIUS, rest=0.0, chord=0.0, left=0.0, cut=0.0,
    )  # fmt: skip
    seconds = path.times(gc.MillSpec(feed=5.0))[1]
    assert 60.0 / seconds == pytest.approx(rate, rel=1e-11)
    assert minutes(np.array([step[0], 0.0, 0.0, step[1]]), rate) == pytest.approx(1.0 / rate)


def test_the_reader_has_the_floor_of_linuxcnc() -> None:
    assert minutes(np.array([1e-4, 0.0, 0.0, 1.0]), 439.834536) == pytest.approx(0.001)


def test_the_path_that_errors_are_stated_of_has_the_numbers_of_the_program() -> None:
    result = built("", SMALL, rise="119.123456789")
    places = read(result.files("gcode")["cam.nc"].decode()).places[3:-1]
    moves = result.rotary.moves * [1.0, 1.0, 1.0, math.degrees(1.0)]
    assert np.abs(moves - places).max() < 1e-9


@pytest.mark.parametrize("cam", chosen(CAMS, "groove", "rib"))
def test_only_the_tool_rises_before_it_is_at_the_top(cam: str) -> None:
    text = text_of(cam, WRAPPED)
    program = read(text, wrapped=True)
    places, high = program.places, RADIUS + 5.0
    assert places[1].tolist() == [*BEGIN[:2], TOP, BEGIN[3]]
    assert places[2, 2] == TOP
    # then straight down over the place where X, Y and A are, with a spindle that turns
    assert places[3].tolist() == [*places[2, :2], pytest.approx(high), places[2, 3]]
    assert program.spins.tolist() == [False, False] + [True] * (len(program.spins) - 2)
    assert program.rapid[:3].all()
    assert places[-2, 2] == pytest.approx(high)
    assert places[-1].tolist() == [*places[-2, :2], TOP, places[-2, 3]]
    sideways = program.rapid & np.any(np.diff(places[:, [0, 1, 3]], axis=0) != 0.0, axis=1)
    assert places[1:][sideways, 2].min() >= round(high, 9)
    lines = [line for line in text.splitlines() if not line.startswith("(")]
    assert lines[:3] == ["G21 G17 G40 G49 G54 G80 G90 G94", "G61", "G53 G0 Z0"]
    assert re.fullmatch(r"G0 X\S+ Y\S+ A0.00000 S8000 M3 G4 P3 G0 Z44.0800", " ".join(lines[3:7]))
    assert lines[-4:][1:] == ["G53 G0 Z0", "M5", "M30"]


def test_without_a_speed_the_program_stops_until_the_spindle_turns() -> None:
    text = text_of(tool="diameter_mm = 6")
    program = read(text)
    assert "M0" in program.words
    assert "M3" not in program.words
    assert not re.search(r"^S", text, re.MULTILINE)
    assert program.spins.tolist()[:3] == [False, False, True]
    assert "no speed is given" in text


@pytest.mark.parametrize("cam", chosen(CAMS, "clockwise"))
def test_a_wrapped_axis_goes_where_a_growing_one_goes(cam: str) -> None:
    growing, text = text_of(cam, SMALL), text_of(cam, WRAPPED)
    program, same = read(text, wrapped=True), read(growing)
    # the first word takes A forwards from 200 to 360
    ahead = program.places[2:] - [0.0, 0.0, 0.0, 360.0]
    assert np.abs(ahead - same.places[2:]).max() < 1e-9
    assert ahead[-1, 3] >= 720.0
    assert np.diff(ahead[:, 3]).min() >= 0.0
    for each, made in ((text, program), (growing, same)):
        told = [" A" in line for line in each.splitlines() if re.match(r"G[01] .*X", line)]
        moved = np.diff(made.places[:, 3]) != 0.0
        assert told == moved[~np.isin(np.arange(len(moved)), [0, 2, len(moved) - 1])].tolist()


@pytest.mark.parametrize("feed", [10, 20, 300])
def test_linuxcnc_takes_the_time_that_is_meant(feed: int) -> None:
    program: Program = read(text_of(tool=f"feed_mm_min = {feed}"))
    cutting = ~program.rapid
    assert program.minutes[cutting] == pytest.approx(1.0 / program.rates[cutting], rel=1e-12)
    # at the ends of the dwells X starts slowly, and is kept until it is fast enough
    steps = np.abs(np.diff(program.places, axis=0)[cutting])
    turning = steps[:, 3] > 0.0
    slow = turning & (steps[:, 0] > 0.0) & (steps[:, 0] * program.rates[cutting] < 0.11)
    assert not slow.any()


def head(cam: str = "", tool: str = SMALL, outer: str = "78.16") -> str:
    lines = text_of(cam, tool, outer).splitlines()
    assert all(len(line) <= 72 for line in lines if line.startswith("("))
    return " ".join(line.strip("()") for line in lines if line.startswith("("))


def test_the_head_says_in_sentences_what_a_machinist_needs() -> None:
    found = head()
    for words in (
        "Cylinder cam barrel, by gearcam.",
        "Tool: end mill, cutting over its end, diameter 6 mm. Roller: diameter 10 mm.",
        "X0 is the lower face of the cam, Y0 and Z0 are its axis.",
        "Its end on top of the blank is at Z39.08.",
        "Its side at the lower face is at X-3, at the upper face at X73.",
        "Its side at the side of the blank is at Y42.08 or Y-42.08.",
        "Seen from X+, A+ turns the cam clockwise.",
        "from A0 to A10 the top of the cam goes to Y+.",
        "M3 climb-mills the wall on the X- side of the tool, not that on X+.",
        "Start: home the machine. Z0 of the machine must be its top.",
        "If the machine is not homed no start is safe.",
        "Then stand the tool above X22 Y0 by hand, at Z44.08 or higher,",
        "Spindle: 8000 rpm, reached within 3 s.",
    ):
        assert words in found
    assert "the axis must be wrapped" in head(tool=WRAPPED)
    assert found.endswith(".")


def test_as_a_grows_metal_on_the_x_minus_side_is_on_the_right_of_the_tool() -> None:
    """Beside a tool that turns clockwise from above, the right is climb-milled."""
    places = read(text_of(CAMS["lower"], SMALL)).places
    assert places[-1, 3] > places[3, 3]
    # the tool goes round +X by the right hand: on top, from where it is seen, towards Y-
    way = np.cross([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    assert np.cross(way, [0.0, 0.0, 1.0]).tolist() == [-1.0, 0.0, 0.0]
    assert "The wall is on the X- side of the tool: M3 climb-mills it." in head(CAMS["lower"])
    assert "The wall is on the X+ side of the tool: M3 does not" in head(CAMS["upper"])


@pytest.mark.slow
def test_the_head_states_a_diameter_that_was_solved() -> None:
    top = re.search(r"Its end on top of the blank is at Z([\d.]+)\.", head(outer='"solve"'))
    blank = re.search(r"cylinder of ([\d.]+) mm", head(outer='"solve"'))
    assert top
    assert blank
    assert float(blank[1]) == pytest.approx(2.0 * float(top[1]), rel=1e-5)


def path_of(**tool: Any) -> RotaryPath:
    motion = gc.MotionFormula(lift="10*(1 - cos(theta))")
    given = gc.CylinderSpec(outer_diameter=78.16, length=70.0, lowest=25.0, groove_depth=6.0)
    follower = gc.SpatialFollower(roller_radius=5.0, cone=math.radians(5.0))
    output = gc.SpatialOutput(files=("gcode",), path_tolerance=0.05)
    design = gc.SpatialCamDesign(
        name="cone", motion=motion, follower=follower, cam=given, output=output,
        tool=gc.MillSpec(**tool),
    )  # fmt: skip
    return gc.build(design).rotary


def test_a_tool_of_a_little_other_angle_leaves_or_cuts_that_more() -> None:
    true, sharp, blunt = (path_of(cone=math.radians(one)) for one in (5.0, 5.3, 4.7))
    thinner = 6.0 * (math.tan(math.radians(5.3)) - math.tan(math.radians(5.0)))
    wider = 6.0 * (math.tan(math.radians(5.0)) - math.tan(math.radians(4.7)))
    assert sharp.left - true.left == pytest.approx(thinner)
    assert sharp.cut == true.cut
    assert blunt.cut - true.cut == pytest.approx(wider)
    assert blunt.left == true.left
