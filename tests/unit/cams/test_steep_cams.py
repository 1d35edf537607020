"""Cams with phases so short that they are steps: their sizes, and what is felt of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from shapely import Polygon

from gearcam.cams.disc import DiscCam, make_cam
from gearcam.cams.follow import follow
from gearcam.cams.placing import make_follower
from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.cams.wall import OVERSAMPLING
from gearcam.kinds.cam.given_profile import followed
from gearcam.kinds.cam.result import error_rows
from gearcam.numeric.moments import curve_moments
from gearcam.parts.body import Part
from gearcam.parts.mass import quadrature_error
from helpers_cams import back, corners_of, dwell, follower_of, program, rise
from helpers_files import built
from helpers_sampling import few

TOP, FALL, LIFT = 150.0, 90.0, 10.0


def stepped(kind: str, rise_law: str, width: float, after: float) -> DiscCam:
    """A cam whose rise, of a width in degrees, begins after a dwell."""
    made = follower_of(kind)
    swings = made.angular
    walk = [
        rise(rise_law, width, LIFT, swings=swings),
        dwell(TOP),
        back("cycloidal", FALL),
        dwell(360.0 - TOP - FALL - width - after),
    ]
    return make_cam(program([dwell(after), *walk] if after else walk, swings=swings), made)


def rolled_step() -> float:
    """The area for a roller of 6 mm by shapely: what its disc leaves inside the pitch curve."""
    top, fall, low = (
        np.radians(np.linspace(*ends, 40001))
        for ends in ((0.0, TOP), (TOP, TOP + FALL), (TOP + FALL, 360.0))
    )
    share = (fall - fall[0]) / (fall[-1] - fall[0])
    falling = LIFT * (1.0 - share + np.sin(2.0 * math.pi * share) / (2.0 * math.pi))
    lift = np.concatenate([np.full_like(top, LIFT), falling, np.zeros_like(low)])
    around = np.concatenate([top, fall, low])
    pitch = (30.0 + lift)[:, None] * np.column_stack([np.sin(around), np.cos(around)])
    return float(Polygon(pitch).buffer(-6.0, quad_segs=2000).area)


def demand_a_step(made: DiscCam, area: float, width: float) -> None:
    """Its area by quadrature, by its polygon and by cubics, each within what is told of it."""
    size, contour = made.size, made.contour
    sector = 0.5 * contour.reach**2 * math.radians(width)  # of the rise itself
    assert abs(size.area - area) <= sector + size.area_error
    assert contour.area == pytest.approx(
        size.area, abs=contour.chord_error * size.perimeter + size.area_error
    )
    off = abs(contour.moments.area - size.area)
    part = Part(name="cam", contours=(contour,), width=1.0)
    told = quadrature_error(part) + made.walls[0].cubics_missed
    assert off <= told + size.area_error


LAWS = ["constant-acceleration", "cycloidal", "4-5-6-7"]


@pytest.mark.parametrize("kind", few(["swinging roller", "roller"]))
@pytest.mark.parametrize("rise_law", LAWS)
def test_a_steep_rise_has_the_area_of_a_step(rise_law: str, kind: str) -> None:
    """The roller swings about the foot of the step within a tiny part of the rise."""
    area = stepped(kind, "constant-velocity", 1e-9, 0.0).size.area
    for width in (1e-3, 1e-5, 1e-7):
        made = stepped(kind, rise_law, width, 0.0)
        assert made.size.area_error <= 1e-13 * area
        demand_a_step(made, area, width)


FAR = {
    "constant-velocity": 1e-8,
    "constant-acceleration": 1e-5,
    "cycloidal": 1e-7,
    "4-5-6-7": 1e-7,
}
"""The narrowest rise of each law, in degrees."""


@pytest.mark.parametrize("rise_law", few(FAR))
def test_a_steep_rise_far_from_zero_knows_how_little_is_known(rise_law: str) -> None:
    """There angles are rounded to a part of the swing."""
    area = stepped("roller", "constant-velocity", 1e-9, 0.0).size.area
    assert area == pytest.approx(rolled_step(), 1e-5)  # shapely takes points away
    for width in (1e-3, FAR[rise_law]):
        made = stepped("roller", rise_law, width, 100.0)
        assert made.size.area_error <= 1e-3 * area
        demand_a_step(made, area, width)


SWINGING = """
kind = "cam"
name = "swinging"
[[motion]]
type = "rise"
law = "{laws[0]}"
lift_deg = {lift}
angle_deg = {angles[0]}
[[motion]]
type = "dwell"
angle_deg = 140
[[motion]]
type = "return"
law = "{laws[1]}"
angle_deg = {angles[1]}
[[motion]]
type = "dwell"
angle_deg = "rest"
[follower]
type = "roller"
motion = "oscillating"
roller_radius_mm = {radius}
arm_mm = {arm}
pivot_distance_mm = {pivot}
[cam]
prime_radius_mm = {prime}
thickness_mm = 1
[blank]
density_kg_m3 = 7850
[output]
chord_tolerance_mm = {tolerance}
"""


@pytest.mark.parametrize(
    ("laws", "lift", "angles", "sizes", "tolerance"),
    [
        (("modified-trapezoid", "constant-velocity"), 15, (0.021, 75), (30, 6, 43, 52), 1e-3),
        (("modified-trapezoid", "modified-sine"), 5, (0.01, 36), (30, 3, 69, 71), 1e-3),
        (("modified-trapezoid", "modified-trapezoid"), 25, (0.01, 0.86), (40, 8, 68, 84), 1e-2),
    ],
)
def test_the_volume_of_a_steep_swinging_cam_is_as_exact_as_told(
    laws: tuple[str, str],
    lift: float,
    angles: tuple[float, float],
    sizes: tuple[float, float, float, float],
    tolerance: float,
) -> None:
    """Dense points stand unevenly where a lift is steep; the truth has sixteen times as many."""
    prime, radius, arm, pivot = sizes
    made = built(
        SWINGING.format(
            laws=laws, lift=lift, angles=angles, tolerance=tolerance,
            prime=prime, radius=radius, arm=arm, pivot=pivot,
        )
    )  # fmt: skip
    runs = made.cam.walls[0].sampler.dense(16 * OVERSAMPLING).runs()
    points, tangents = (
        np.concatenate([getattr(run, n) for run in runs]) for n in ("points", "tangents")
    )
    off = abs(made.parts[0].volume - abs(curve_moments(points, tangents).area))
    told = error_rows(made)["volume_mm3"][0]
    assert off <= told <= 100.0 * off


KNIFE = """
kind = "cam"
name = "knife"
[[motion]]
type = "rise"
law = "{law}"
lift_mm = {lift}
travel_mm = {way}
[[motion]]
type = "dwell"
travel_mm = 20
[[motion]]
type = "return"
law = "{law}"
travel_mm = {way}
[follower]
type = "point"
[cam]
form = "translating"
run_in_mm = 5
run_out_mm = 20
thickness_mm = 5
[blank]
height_mm = 160
[output]
chord_tolerance_mm = {tolerance}
"""


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
@pytest.mark.parametrize(("lift", "way"), [(10, 20), (10, 1), (100, 1)])
@pytest.mark.parametrize("rise_law", ["cycloidal", "3-4-5", "harmonic", "constant-acceleration"])
def test_a_knife_edge_feels_no_more_of_the_chords_than_is_told(
    rise_law: str, lift: int, way: int, tolerance: float
) -> None:
    """A steep plate multiplies a chord's error, and turns of few chords tell little of it."""
    made = built(KNIFE.format(law=rise_law, lift=lift, way=way, tolerance=tolerance))
    study = made.follow(made.profiles[0].vertices)
    off = np.abs(study.columns["difference"])
    assert np.all(off <= study.columns["error"] + 1e-9)


@pytest.mark.parametrize(
    ("rise_law", "lift", "way"),
    [
        ("harmonic", 1.65, 0.0037),
        ("cycloidal", 4.1, 0.003),
        ("constant-acceleration", 13.3, 0.0086),
    ],
)
def test_slopes_of_a_thousand_multiply_the_chords_by_what_is_told(
    rise_law: str, lift: float, way: float
) -> None:
    """A chord is narrower than its own error there: its neighbours are felt too."""
    made = built(KNIFE.format(law=rise_law, lift=lift, way=way, tolerance=1e-3))
    wall, points = made.cam.walls[0], made.profiles[0].points
    theta = np.linspace(wall.program.knots[:-1], wall.program.knots[1:], 400, axis=1).ravel()
    columns, _, _ = followed(wall, points, np.zeros(len(points)), theta, made.design.limits)
    assert np.all(np.abs(columns["difference"]) <= columns["error"] + 1e-9)


LAWS = ("constant-velocity", "constant-acceleration", "harmonic", "cycloidal", "modified-sine")


def demand_told(follower: dict[str, Any], prime: float, walk: list[Any], tolerance: float) -> bool:
    """Whether a swinging cam is whole; then its chords are felt no more than is told."""
    spec = FollowerSpec(motion="oscillating", **follower)
    touched = make_follower(spec, CamSpec(prime_radius=prime))
    made = make_cam(program(walk, swings=True), touched, tolerance=tolerance)
    if made.corners:
        return False
    knots = made.program.knots
    theta = np.linspace(knots[:-1], knots[1:], 400, axis=1).ravel()
    found = follow(corners_of(made), touched, theta, missed=tolerance)
    off = np.abs(found.lift - made.program.derivatives(theta, 0)[0])
    assert np.all(off <= found.error + 1e-12)
    assert found.error.max() < math.inf
    return True


def steep(seed: int, radius: float) -> tuple[dict[str, Any], float, list[Any], float]:
    """An arm, a prime radius, a program with a short phase and a tolerance, at random."""
    random = np.random.default_rng(seed)
    prime, tolerance = random.uniform(20.0, 60.0), 10.0 ** random.uniform(-3.5, -1.5)
    pivot = random.uniform(1.5, 4.0) * prime
    arm = {"pivot_distance": pivot, "arm": pivot + random.uniform(-0.8, 0.8) * prime}
    tip = {"type": "roller", "roller_radius": radius} if radius else {"type": "point"}
    short, long = random.uniform(1.0, 15.0), random.uniform(40.0, 200.0)
    up, down = (short, long) if random.random() < 0.5 else (long, short)
    walk = [
        rise(str(random.choice(LAWS)), up, random.uniform(3.0, 25.0), swings=True),
        dwell(60.0),
        back(str(random.choice(LAWS)), down),
        dwell(300.0 - up - down),
    ]
    return {**tip, **arm}, prime, walk, tolerance


@pytest.mark.parametrize("radius", [0.0, 1e-3, 0.05])
@pytest.mark.parametrize(
    "seeds",
    [
        pytest.param((28, 53, 112), id="few"),
        pytest.param(range(400), id="many", marks=pytest.mark.slow),
    ],
)
def test_a_small_face_on_an_arm_feels_no_more_of_the_chords_than_is_told(
    seeds: Sequence[int], radius: float
) -> None:
    """Both adjustments: where the curve is below steep chords the arm comes down farther than "
    "up."""
    assert sum(demand_told(*steep(seed, radius)) for seed in seeds) >= len(seeds) // 3


def test_turns_between_bends_of_both_signs_tell_little_of_chords() -> None:
    """One chord is hollow where this rise begins: what turns tell is what is left of two bends."""
    arm = {"type": "point", "pivot_distance": 102.0, "arm": 142.3}
    walk = [
        rise("constant-acceleration", 55.356, 12.7674, swings=True),
        dwell(60.0),
        back("harmonic", 4.2655),
        dwell(360.0 - 55.356 - 60.0 - 4.2655),
    ]
    assert demand_told(arm, 59.38, walk, 0.00381)
