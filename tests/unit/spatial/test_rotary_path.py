"""Programs for a rotary axis: read back, the tool swept through the blank, held against the walls.

The walls are those that a search finds which knows no envelope; the reader knows of the program
only its words and of the machine only its frame.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise, product
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from helpers_built import built
from helpers_gcode import Program, read
from helpers_sampling import chosen, few
from witness.roller_in_space import Mechanism, cycloidal

LOWEST = 25.0
TOLERANCE = 0.002

ROUNDED = 1e-4
"""What rounding to four decimals of a mm, five of a degree, may do, mm."""

BESIDE = 1.2e-4
"""How much farther the nearest of the places is than the tool on its way, mm: 0.1 degrees."""


def nearness(
    points: np.ndarray, places: np.ndarray, radius: float, taper: float = 0.0
) -> np.ndarray:
    """Least distance of points of the cam from the tool in all its places; negative: cut away.

    The point (x, y, z) of the cam is at (X, Y, Z) = (z, -y, x) on the machine while A is 0; the
    tool is at the azimuth A on the cam. `radius` is that of the tool at its end.
    """
    angle = np.radians(places[:, 3])
    c, s = np.cos(angle), np.sin(angle)
    least = np.empty(len(points))
    for k, (x, y, z) in enumerate(points):
        beside, up = -x * s + y * c, x * c + y * s
        height = up - places[:, 2]
        across = np.hypot(z - places[:, 0], -beside - places[:, 1])
        distance = (across - radius - height * taper) / math.hypot(1.0, taper)
        least[k] = distance[height >= -1e-9].min()
    return least


Center = Callable[[Any], tuple[Any, Any]]


def straight(theta: Any) -> tuple[Any, Any]:
    """The roller of the reference cam."""
    third, sixth = math.radians(120.0), math.radians(60.0)
    return 0.0, LOWEST + cycloidal(np.asarray(theta), 30.0, (third, sixth, third, sixth))


def arm(theta: Any) -> tuple[Any, Any]:
    """A roller on an arm of 60 mm that swings by 30 degrees, the pivot at -58.978 mm."""
    third, sixth = math.radians(120.0), math.radians(60.0)
    lift = cycloidal(np.asarray(theta), math.radians(30.0), (third, sixth, third, sixth))
    angle = lift - math.radians(15.0)
    height = LOWEST + 60.0 * math.sin(math.radians(15.0))
    return 60.0 * np.cos(angle) - 58.97777478867, height + 60.0 * np.sin(angle)


@cache
def walls(
    center: Center, half_angle: float, clearance: float, sides: tuple[int, ...], apart: float
) -> np.ndarray:
    """Points of walls by search: all round the cam, from near the floor to the outside."""
    roller = Mechanism(center, 8.0 + 0.5 * clearance, 40.0, half_angle, inner=28.0)
    points = []
    for azimuth in np.radians(np.arange(0.0, 360.0, 9.7)):
        for radius in (28.85, 31.3, 34.0, 37.0, 39.97):
            for side in sides:
                height = roller.wall(radius, azimuth, side) - 0.5 * side * apart
                points.append([radius * math.cos(azimuth), radius * math.sin(azimuth), height])
    return np.array(points)


def design(**more: dict[str, Any]) -> gc.SpatialCamDesign:
    """The reference cam as a design, with other values by table."""
    phases = [
        {"type": "rise", "angle_deg": 120, "law": "cycloidal", "lift_mm": 30},
        {"type": "dwell", "angle_deg": 60},
        {"type": "return", "angle_deg": 120, "law": "cycloidal"},
        {"type": "dwell", "angle_deg": "rest"},
    ]
    if more.get("follower", {}).get("motion") == "oscillating":
        phases[0]["lift_deg"] = phases[0].pop("lift_mm")
    table: dict[str, Any] = {
        "follower": {"roller_radius_mm": 8},
        "cam": {
            "form": "cylinder",
            "outer_diameter_mm": 80,
            "length_mm": 90,
            "lowest_mm": LOWEST,
            "groove_depth_mm": 12,
        },
        "tool": {"depth_mm": 4},
        "output": {"files": ["gcode", "tool-path"], "path_tolerance_mm": TOLERANCE},
    }
    tables = {key: values | more.get(key, {}) for key, values in table.items()}
    return gc.design({"kind": "cam", "name": "drum", "motion": phases, **tables})  # pyright: ignore


def program_of(result: gc.SpatialCamResult) -> Program:
    return read(result.files("gcode")["cam.nc"].decode())


@dataclass(frozen=True)
class Case:
    """A design, and the roller that makes its walls."""

    given: dict[str, dict[str, Any]]
    axes: str
    center: Center = straight
    half_angle: float = 0.0
    clearance: float = 0.0
    sides: tuple[int, ...] = (1, -1)
    apart: float = 0.0

    @property
    def points(self) -> np.ndarray:
        """Points of the walls, mirrored if the cam turns clockwise."""
        side = -1.0 if "rotation" in self.given.get("cam", {}) else 1.0
        found = walls(self.center, self.half_angle, self.clearance, self.sides, self.apart)
        return found * [1.0, side, 1.0]


ARM = {"motion": "oscillating", "arm_mm": 60}
APEX = {"cone_deg": "apex"}
TIP = math.atan(0.2)
CASES = {
    "as wide as the groove": Case({}, "X Z A"),
    "clockwise": Case({"cam": {"rotation": "cw"}, "tool": {"diameter_mm": 10}}, "X Y Z A"),
    "a little smaller": Case(
        {"cam": {"roller_clearance_mm": 0.05}, "tool": {"diameter_mm": 16}},
        "X Y Z A",
        clearance=0.05,
    ),
    "half as wide": Case({"tool": {"diameter_mm": 8}}, "X Y Z A"),
    "slowly": Case({"tool": {"feed_mm_min": 10}}, "X Z A"),
    "a quarter as wide": Case({"tool": {"diameter_mm": 4}}, "X Y Z A"),
    "an arm": Case({"follower": ARM}, "X Y Z A", arm),
    "an arm, half as wide": Case({"follower": ARM, "tool": {"diameter_mm": 9}}, "X Y Z A", arm),
    "a cone": Case({"follower": APEX}, "X Z A", half_angle=TIP),
    "a smaller cone": Case(
        {"follower": APEX, "tool": {"diameter_mm": 11}}, "X Y Z A", half_angle=TIP
    ),
    "a cone on an arm": Case(
        {"follower": ARM | APEX, "tool": {"diameter_mm": 12}}, "X Y Z A", arm, half_angle=TIP
    ),
    "the upper wall": Case(
        {"cam": {"walls": "upper"}, "tool": {"diameter_mm": 10}}, "X Y Z A", sides=(1,)
    ),
    "the lower wall": Case({"cam": {"walls": "lower"}}, "X Z A", sides=(-1,)),
    "a rib": Case(
        {
            "cam": {"walls": "rib", "rib_mm": 12, "lowest_mm": LOWEST},
            "tool": {"diameter_mm": 10},
        },
        "X Y Z A",
        apart=28.0,
    ),
}


OFTEN = ("clockwise", "an arm")
"""Each sort of follower."""


@pytest.mark.parametrize("case", chosen(CASES, *OFTEN))
def test_the_tool_cuts_no_wall_and_leaves_what_is_stated(case: Case) -> None:
    result = built(design(**case.given))
    path, program = result.rotary, program_of(result)
    found = nearness(case.points, program.densely(0.1), path.tool[0], math.tan(case.half_angle))
    assert bool(np.any(program.places[2:, 1])) is path.crosswise is ("Y" in case.axes)
    assert 0.45 * path.cut < -found.min() <= path.cut
    assert 0.45 * path.left < found.max() <= path.left + BESIDE
    assert path.rest <= TOLERANCE
    assert path.chord <= TOLERANCE


def test_the_path_is_told() -> None:
    result = built(design(**CASES["clockwise"].given))
    path, told = result.rotary, result.to_dict()["tool_path"]
    assert told["axes"] == "X Y Z A"
    assert told["tool_diameter_mm"] == {"end": 10.0, "outside": 10.0}
    assert (told["cut_mm"], told["left_mm"]) == (path.cut, path.left)
    assert (told["rest_mm"], told["chord_mm"]) == (path.rest, path.chord)
    minutes = program_of(result).minutes.sum()
    assert told["cutting_time_s"] == pytest.approx(60 * minutes, rel=1e-4)


NAMES = ("as wide as the groove", "half as wide", "a smaller cone")


@pytest.mark.parametrize(
    ("name", "axis"),
    chosen(
        product(NAMES, range(4)),
        *((NAMES[0], axis) for axis in range(4)),
    ),
)
def test_a_path_that_is_10_um_off_is_found(name: str, axis: int) -> None:
    """Along the cam and around it; 10 um deeper a cylinder cuts no wall, but a cone does."""
    case = CASES[name]
    result = built(design(**case.given))
    off = np.zeros(4)
    off[axis] = math.degrees(0.010 / 30.0) if axis == 3 else -0.010 * (5.0 if axis == 2 else 1.0)
    places = program_of(result).densely() + off
    found = nearness(case.points, places, result.rotary.tool[0], math.tan(case.half_angle))
    assert bool(-found.min() > result.rotary.cut) is (axis != 2 or bool(case.half_angle))


@pytest.mark.parametrize(
    ("diameter", "cut"),
    few(
        [
            (11.0, {"walls": "lower"}),
            (4.0, {}),
            (6.0, {"walls": "upper"}),
            (11.0, {}),
            (9.0, {"walls": "rib", "rib_mm": 14.0}),
            (6.0, {}),
            (8.0, {}),
        ],
        7,
    ),
)
def test_the_whole_way_of_the_roller_is_cut(diameter: float, cut: dict[str, Any]) -> None:
    more = {"tool": {"diameter_mm": diameter}, "output": {"path_tolerance_mm": 0.02}, "cam": cut}
    places = program_of(gc.build(design(**more))).densely(0.5)
    theta = np.radians(np.arange(0.0, 360.0, 3.3))
    _, z = straight(theta)
    # of the rollers of a rib the lower one, which makes the upper wall
    z = z - 0.5 * (16.0 + cut.get("rib_mm", -16.0))
    for x, across in ((29.0, 0.0), (35.0, 7.5), (35.0, -7.5), (31.0, -4.0), (39.0, 4.0)):
        up = z + across * math.cos(math.radians(38.0))
        beside = across * math.sin(math.radians(38.0))
        c, s = np.cos(theta), np.sin(theta)
        points = np.stack([x * c + beside * s, -x * s + beside * c, up], axis=1)
        assert nearness(points, places, 0.5 * diameter).max() < 0.0


TOOL = {"diameter_mm": 10, "spindle_rpm": 12000, "feed_mm_min": 240}


def test_the_program_has_words_that_free_controllers_run() -> None:
    result = built(design(tool=TOOL))
    text = result.files("gcode")["cam.nc"].decode()
    program = read(text)
    allowed = "G0 G1 G4 G17 G21 G40 G49 G53 G54 G61 G80 G90 G93 G94 M3 M5 M30"
    assert set(program.words) == set(allowed.split())
    assert [line for line in text.splitlines() if line.startswith("G9")] == ["G93", "G94"]
    assert text.endswith("\nG94\nG0 X22.0000 Y0.0000 Z45.0000\nG53 G0 Z0\nM5\nM30\n")
    assert "S12000 M3\nG4 P3\n" in text
    for words in ("10 mm", "cylinder of 80 mm, length 90 mm", "X0 is the lower face"):
        assert words in text
    turned = np.diff(program.places[2:, 3])
    assert turned.min() >= 0.0
    assert turned.max() <= 15.0 + 1e-9
    assert program.places[-1, 3] == 2880.0
    assert program.places[1:][program.rapid, 2].min() == 45.0


def test_each_move_takes_its_time_at_the_outside_of_the_cam() -> None:
    result = built(design(tool=TOOL))
    program = program_of(result)
    steps = np.diff(program.places, axis=0) * [1.0, 1.0, 1.0, math.radians(40.0)]
    cutting = ~program.rapid
    feeds = (np.linalg.norm(steps, axis=1)[cutting]) * program.rates[cutting]
    plunging = steps[cutting, 2] < 0.0
    assert np.abs(feeds[plunging] / 80.0 - 1.0).max() < 1e-3
    assert np.abs(feeds[~plunging] / 240.0 - 1.0).max() < 1e-4


def test_the_table_is_the_program() -> None:
    result = built(design(tool=TOOL))
    lines = result.files("tool-path")["rotary_path.csv"].decode().splitlines()
    assert lines[0] == "turn,X_mm,Y_mm,Z_mm,A_deg,inverse_time_per_min"
    table = np.array([[float(one) for one in line.split(",")] for line in lines[1:]])
    places = program_of(result).places[3:-1]  # before and behind it the tool is raised
    assert np.abs(table[:, 1:5] - places).max() < 1e-12 * 2880.0
    assert set(table[:, 0]) == set(range(9))
    assert np.diff(table[:, 4]).min() >= 0.0


@pytest.mark.parametrize("coarsest", chosen([6.0, 3.0, 1.0], 6.0))
def test_the_rest_falls_with_the_square_of_the_passes(coarsest: float) -> None:
    def rest(depth: float) -> float:
        given = {"tool": {"diameter_mm": 8, "depth_mm": depth}, "output": {"path_tolerance_mm": 1}}
        return gc.build(design(**given)).rotary.rest

    rests = [rest(depth) for depth in (coarsest, coarsest / 2, coarsest / 4)]
    slopes = [math.log2(one / other) for one, other in pairwise(rests)]
    assert slopes == [pytest.approx(2.0, abs=0.15)] * 2


def test_a_pass_leaves_no_more_than_stated_at_its_worse_end() -> None:
    """Walls of the rise in closed form at the angles of the moves, where these are on the path."""
    given = {"tool": {"diameter_mm": 8, "depth_mm": 12}, "output": {"path_tolerance_mm": 1}}
    result = gc.build(design(**given))
    places = program_of(result).places[3:-1]
    stated = result.rotary.rest
    left = []
    for angle in np.unique(places[:, 3] % 360.0):
        theta = math.radians(360.0 - angle)
        if 0.0 < theta < math.radians(120.0):
            speed = 45.0 / math.pi * (1.0 - math.cos(3.0 * theta))
            lift = 45.0 / math.pi * (theta - math.sin(3.0 * theta) / 3.0)
            for x in (28.0, 34.0, 40.0):
                for side in (1, -1):
                    eta = math.atan(speed / x)
                    y, z = 8.0 * side * math.sin(eta), 8.0 * side * math.cos(eta)
                    c, s = math.cos(theta), math.sin(theta)
                    point = [x * c + y * s, y * c - x * s, LOWEST + lift + z]
                    left.append(nearness(np.array([point]), places, 4.0)[0])
    assert max(left) == pytest.approx(stated, rel=0.1)
    assert max(left) < stated + ROUNDED
    assert min(left) > -ROUNDED


def test_more_passes_are_taken_until_the_rest_is_small() -> None:
    given = {"tool": {"diameter_mm": 8, "depth_mm": 12}}
    tight = gc.build(design(**given, output={"path_tolerance_mm": 0.01})).rotary
    assert tight.layers > 1
    assert tight.rest <= 0.01
    loose = gc.build(design(**given, output={"path_tolerance_mm": 0.2})).rotary
    assert loose.layers == 1
    assert 0.01 < loose.rest <= 0.2


@pytest.mark.parametrize(
    ("given", "words", "near"),
    [
        ({"tool": {"diameter_mm": 16.01}}, "the tool is wider than the groove", 16.0),
        ({"tool": {"cone_deg": 3}}, "an end mill of another angle than the roller", 0.0),
        ({"follower": APEX, "tool": {"cone_deg": 0}}, "of another angle", math.degrees(TIP)),
        ({"follower": APEX, "tool": {"diameter_mm": 4}}, "comes to its tip above the", 4.848),
        ({"follower": {"roller_radius_mm": 22}}, "wall is undercut at", None),
        (
            {"tool": {"diameter_mm": 0.1}, "output": {"path_tolerance_mm": 0.0005}},
            "more than 1000 turns round the cam",
            None,
        ),
    ],
)
def test_tools_that_cannot_cut_true_walls_are_refused(
    given: dict[str, Any], words: str, near: float | None
) -> None:
    if "roller_radius_mm" in given.get("follower", {}):
        given = given | {"cam": {"lowest_mm": 25}}
    with pytest.raises(gc.InfeasibleError, match=words) as caught:
        _ = gc.build(design(**given)).rotary
    if near is not None:
        assert [*caught.value.adjustments[0].near.values()] == [pytest.approx(near, rel=1e-12)]


def test_a_cone_that_differs_by_less_than_the_tolerance_is_taken() -> None:
    gc.build(design(follower=APEX, tool={"cone_deg": 11.31})).rotary  # noqa: B018
