"""Translating cams give numbers that were found without the program, to the printed digits."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.cams.follow import follow
from gearcam.cams.lost_motion import Rest
from gearcam.cams.measures import over_the_end
from gearcam.cams.placing import make_follower_over_plate
from gearcam.cams.spec import PlateFollower
from gearcam.cams.translating import TranslatingCam, make_translating
from gearcam.laws.phases_of_lift import DwellPhase, ReturnPhase, RisePhase
from gearcam.laws.program import make_program
from helpers_cams import law, there_and_back
from helpers_sampling import few

mp: Any = mpmath.mp

POINTS = {
    10.0: (0.5324074074074, 8.232200670623, -10.85911103823, -5.40576808882, -9.140888961773,
           6.470582903635, -44.563409652),
    45.0: (13.447265625, 14.77110093851, -46.5297484526, 7.645552975122, -43.4702515474,
           19.24897827488, 47.192590893),
    100.0: (13.63732414638, -20.55604521958, -97.89325935047, 8.019349080964, -102.1067406495,
            19.25529921179, 20.680602371),
    110.0: (7.5, -36.86989764584, -106.4, 2.7, -113.6, 12.3, math.inf),
    125.0: (0.1869069072054, -6.267955110755, -124.3449297038, -5.777226131806, -125.6550702962,
            6.151039946216, -24.444189213),
}  # fmt: skip
"""Lift, pressure angle, points of both walls and radius of the pitch curve, by way; mm, deg."""

FOLLOWERS: dict[str, dict[str, Any]] = {
    "upright": {},
    "leaning": {"axis": math.radians(25.0)},
    "leaning back": {"axis": math.radians(-15.0)},
    "arm": {"motion": "oscillating", "arm": 80.0, "pivot_distance": 70.0, "pivot_height": 20.0},
    "level arm": {"motion": "oscillating", "arm": 50.0, "pivot_distance": 50.0},
}
RUN = 10.0


LENGTHS = ("arm", "pivot_distance", "pivot_height")


def made(
    name: str = "upright", radius: float = 6.0, run: float = 0.0, scale: float = 1.0, **sizes: Any
) -> TranslatingCam:
    given = {
        key: scale ** (key in LENGTHS) * x if key != "motion" else x
        for key, x in FOLLOWERS[name].items()
    }
    spec = PlateFollower(type="roller", roller_radius=scale * radius, **given)
    lift = 0.2 if spec.oscillating else 15.0 * scale
    still = [DwellPhase(angle=scale * run)] if run else []
    phases = [
        *still,
        RisePhase(angle=60.0 * scale, law=law("3-4-5"), lift=lift),
        DwellPhase(angle=30.0 * scale),
        ReturnPhase(angle=40.0 * scale, law=law("cycloidal")),
        *still,
    ]
    program = make_program(phases, DEFAULT, oscillating=spec.oscillating, closed=False)
    follower = make_follower_over_plate(spec)
    sizes = {"height": 60.0, "tolerance": 1e-3} | sizes
    lengths = {key: value if key == "groove" else scale * value for key, value in sizes.items()}
    return make_translating(program, follower, **{"groove": True} | lengths)


@pytest.mark.parametrize("way", POINTS)
def test_points_of_both_walls(way: float) -> None:
    cam = made()
    s, alpha, x, y, u, v, rho = POINTS[way]
    theta = np.array([way])
    (lower,), (upper,) = (wall.places_at(theta)[1] for wall in cam.walls)
    assert abs(lower - complex(x, y)) < 1e-9
    assert abs(upper - complex(u, v)) < 1e-9
    found = cam.motion.motion(theta)
    assert found["s"][0] == pytest.approx(s, abs=1e-11)
    assert math.degrees(found["pressure"][0]) == pytest.approx(alpha, abs=1e-11)
    assert 1.0 / found["rho_pitch"][0] == pytest.approx(1.0 / rho, abs=1e-12)


@pytest.mark.parametrize(
    ("kind", "steepest", "valley", "at_valley", "at_crest"),
    [
        ("rise", 25.11483488614, 43.91871165615, 11.48328882, 48.51671118),
        ("return", 36.86989764584, 19.64980578843, 121.7207137978, 98.27928620258),
    ],
)
def test_extremes(
    kind: str, steepest: float, valley: float, at_valley: float, at_crest: float
) -> None:
    motion = made().motion
    pressure, bend = motion.pressure(kind), motion.pitch_curvature(kind)
    assert pressure is not None
    assert bend is not None
    assert math.degrees(pressure.largest) == pytest.approx(steepest, abs=1e-10)
    for end, sign, at in ((bend.low, -1.0, at_valley), (bend.high, 1.0, at_crest)):
        assert sign / end.value == pytest.approx(valley, abs=1e-10)
        assert end.theta == pytest.approx(at, abs=1e-6)


def geometry(name: str) -> Callable[[Any], Any]:
    """The roller's centre in the cam's frame by the way after the run, without the program."""
    given = FOLLOWERS[name]

    def lift(u: Any) -> Any:
        if u < 60:
            x = u / 60
            return x**3 * (10 - 15 * x + 6 * x * x)
        if u < 90:
            return mp.mpf(1)
        x = (u - 90) / 40
        return 1 - x + mp.sin(2 * mp.pi * x) / (2 * mp.pi)

    def center(u: Any) -> Any:
        if "arm" not in given:
            lean = mp.mpf(given.get("axis", 0.0))
            return 15 * lift(u) * mp.mpc(mp.sin(lean), mp.cos(lean)) - u - RUN
        arm, height = mp.mpf(given["arm"]), mp.mpf(given.get("pivot_height", 0.0))
        swing = mp.mpf(0.2) * lift(u) - mp.asin(height / arm)
        pivot = mp.mpc(given["pivot_distance"], height)
        return pivot - arm * mp.exp(mp.mpc(0, -swing)) - u - RUN

    return center


@pytest.mark.parametrize("name", FOLLOWERS)
@pytest.mark.parametrize("way", [7.0, 22.0, 51.0, 75.0, 97.0, 118.0])
def test_walls_and_angles_by_differences(name: str, way: float) -> None:
    """The tangent by differences in high precision, the angle to the way of the follower."""
    cam, center = made(name, run=RUN), geometry(name)
    with mp.workdps(40):
        first, second = (mp.diff(center, mp.mpf(way), order) for order in (1, 2))
        place, tangent = center(mp.mpf(way)), first / abs(first)
        # at a standstill of the cam only the lift moves the centre: along an arm's tangent
        if "arm" in FOLLOWERS[name]:
            pivot = mp.mpc(FOLLOWERS[name]["pivot_distance"] - way - RUN,
                           FOLLOWERS[name].get("pivot_height", 0.0))  # fmt: skip
            up = mp.mpc(0, -1) * (place - pivot) / abs(place - pivot)
        else:
            lean = mp.mpf(FOLLOWERS[name].get("axis", 0.0))
            up = mp.mpc(mp.sin(lean), mp.cos(lean))
        below = mp.mpc(0, 1) * tangent  # the cam is drawn from right to left
        pressure = mp.arg(up / -below)
        bend = (mp.conj(first) * second).imag / abs(first) ** 3
    theta = np.array([way + RUN])
    for wall, side in zip(cam.walls, (1.0, -1.0), strict=True):
        (point,), (normal,) = wall.places_at(theta)[1:]
        assert abs(point - complex(place + side * 6.0 * below)) < 1e-9
        assert abs(normal + side * complex(below)) < 1e-12
    found = cam.motion.motion(theta)
    assert abs(found["pressure"][0]) == pytest.approx(abs(float(pressure)), abs=1e-12)
    assert 1.0 / found["rho_pitch"][0] == pytest.approx(float(bend), abs=1e-13)


@pytest.mark.parametrize("name", FOLLOWERS)
def test_a_roller_on_the_lower_wall_has_the_lift_asked_for(name: str) -> None:
    cam = made(name, run=RUN, groove=False, tolerance=1e-5, height=80.0)
    theta = cam.travel * np.linspace(0.003, 0.997, 301)
    dense = np.concatenate([run.points for run in cam.edge.runs])
    found = follow(dense, cam.roller, theta, carrier=cam.motion.carrier)
    asked = cam.motion.program.derivatives(theta, 0)[0]
    np.testing.assert_allclose(found.lift, asked, atol=1e-6)
    for wall in made(name, run=RUN).walls:
        lift, slope = Rest(wall=wall, roller=cam.roller).lift(theta)
        np.testing.assert_allclose(lift, asked, atol=1e-11)
        np.testing.assert_allclose(slope, cam.motion.program.derivatives(theta, 1)[1], atol=1e-10)


@pytest.mark.parametrize("name", FOLLOWERS)
def test_a_groove_has_the_area_of_a_roller_along_its_pitch_curve(name: str) -> None:
    cam = made(name, run=RUN, clearance=0.4, tolerance=1e-4)
    assert cam.groove is not None
    length = 0.5 * sum(wall.size.perimeter for wall in cam.walls)
    area = cam.width * length + 0.25 * math.pi * cam.width**2
    assert cam.width == pytest.approx(12.4)
    assert cam.groove.moments.area == pytest.approx(area, rel=1e-10)
    metal = sum(wall.contour.moments.area for wall in cam.walls)
    ends = cam.groove.moments.area + cam.edge.moments.area
    assert metal < ends
    assert cam.walls[0].size.perimeter == pytest.approx(cam.walls[1].size.perimeter, rel=1e-12)


def test_lost_motion_is_the_clearance_over_the_cosine_to_first_order() -> None:
    for clearance in (1e-2, 1e-3):
        found = made(run=RUN, clearance=clearance).lost_motion
        assert found is not None
        alpha = math.radians(36.86989764584)
        assert found.value / clearance == pytest.approx(1.0 / math.cos(alpha), rel=clearance)


@pytest.mark.parametrize("name", FOLLOWERS)
def test_lost_lift_is_what_a_roller_on_the_trimmed_wall_lacks(name: str) -> None:
    cam = made(name, radius=40.0, run=60.0, groove=False, tolerance=1e-4, height=150.0)
    wall, program = cam.lower, cam.motion.program
    assert wall.corners
    assert wall.shortfall > 1e-3
    theta = cam.travel * np.linspace(0.008, 0.987, 2001)
    found = follow(cam.edge.points, cam.roller, theta, carrier=cam.motion.carrier)
    lost = program.derivatives(theta, 0)[0] - found.lift
    assert lost.max() == pytest.approx(wall.shortfall, rel=1e-2)
    low, high = wall.corners[0].before, wall.corners[-1].after
    outside = (theta < low - 0.4) | (theta > high + 0.4)
    assert np.abs(lost[outside]).max() < 1e-3


@pytest.mark.parametrize("radius", [19.6, 19.66, 19.75, 21.0])
def test_a_small_loop_of_an_open_wall_is_closed(radius: float) -> None:
    """The sharpest crest has 19.64980578843 mm: below it nothing is cut."""
    walls = made(radius=radius, run=40.0, height=150.0).walls
    for wall in walls:
        assert len(wall.corners) == (1 if radius > 19.65 else 0)
        assert len(wall.undercut) == len(wall.corners)
        x = wall.line.real
        assert np.all(np.diff(x) < 0.0)
        assert abs(wall.line[0].real) < 1e-12
        assert x[-1] == pytest.approx(-210.0)


def test_places_are_even_along_the_way_with_both_ends() -> None:
    cam = made(run=RUN)
    theta, points, _ = cam.lower.places(16)
    np.testing.assert_allclose(np.diff(theta), 10.0)
    assert points[[0, -1]] == pytest.approx([-6j, -150.0 - 6j])


def test_stretches_at_both_ends_of_a_way_are_two() -> None:
    stretches = [(0.0, 1.0), (6.0, 2.0 * math.pi)]
    turning = there_and_back("cycloidal", 10.0)
    assert len(over_the_end(stretches, turning)) == 1
    stretches = [(0.0, 1.0), (100.0, 130.0)]
    assert over_the_end(stretches, made().motion.program) == [[one] for one in stretches]


@pytest.mark.parametrize("scale", few([1e-3, 1e3]))
@pytest.mark.parametrize("name", FOLLOWERS)
@pytest.mark.parametrize("radius", few([6.0, 40.0]))
def test_a_plate_of_another_size_is_the_same_plate(name: str, radius: float, scale: float) -> None:
    """Walls, undercut, lost lift and lost motion, also of a roller that undercuts both walls."""
    sizes = {"radius": radius, "run": 60.0, "clearance": 0.2, "height": 160.0}
    one, other = made(name, **sizes), made(name, scale=scale, **sizes)
    of_lift = 1.0 if "arm" in FOLLOWERS[name] else scale
    for wall, scaled in zip(one.walls, other.walls, strict=True):
        np.testing.assert_allclose(scaled.line, scale * wall.line, rtol=1e-9, atol=1e-9 * scale)
        ends = np.ravel(wall.undercut)
        assert len(ends) == len(np.ravel(scaled.undercut))
        np.testing.assert_allclose(np.ravel(scaled.undercut), scale * ends, rtol=1e-10)
        assert bool(wall.corners) == (radius > 20.0)
        assert scaled.shortfall == pytest.approx(of_lift * wall.shortfall, rel=1e-9)
    assert one.lost_motion is not None
    assert other.lost_motion is not None
    assert other.lost_motion.value == pytest.approx(of_lift * one.lost_motion.value, rel=1e-9)
    if radius < 20.0:  # with corners two places may have equal values
        assert other.lost_motion.theta == pytest.approx(scale * one.lost_motion.theta, rel=1e-6)
