"""Groove cams: both walls, and what a follower loses between them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely

from gearcam.base.findings import run_checks
from gearcam.base.tolerances import DEFAULT
from gearcam.cams.carriers import ROTATING
from gearcam.cams.checks import KIND
from gearcam.cams.follow import follow
from gearcam.cams.followers import Stem
from gearcam.cams.groove import GrooveCam, make_groove
from gearcam.cams.lost_motion import Rest
from gearcam.cams.trim import resting
from gearcam.laws.motion_formula import MotionFormula
from gearcam.laws.phases_of_lift import ReturnPhase, SegmentPhase
from gearcam.numeric.jets import Jet
from helpers_cams import TURN, angles, back, follower_of, law, program, rise, there_and_back
from witness.roller_bands import band, lift

STEEP = (50.0, 130.0, 50.0, 130.0)


def groove(kind: str = "roller", **sizes: Any) -> GrooveCam:
    swings = kind.startswith("swinging")
    motion = there_and_back("cycloidal", 12.0, swings=swings)
    return make_groove(motion, follower_of(kind), **sizes)


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("kind", ["roller", "roller, offset", "swinging roller"])
def test_a_groove_has_the_area_of_its_width_along_the_pitch_curve(
    kind: str, clockwise: bool
) -> None:
    made = groove(kind, clearance=0.4, clockwise=clockwise)
    inner, outer = (wall.size for wall in made.walls)
    length = 0.5 * (inner.perimeter + outer.perimeter)
    assert made.width == pytest.approx(2.0 * made.rollers[0].radius + 0.4)
    assert outer.perimeter - inner.perimeter == pytest.approx(2.0 * math.pi * made.width)
    assert outer.area - inner.area == pytest.approx(made.width * length, rel=1e-12)


@pytest.mark.parametrize("kind", ["roller", "roller, offset", "swinging roller"])
def test_play_by_dense_points(kind: str) -> None:
    """The slope too, by differences; and by a follower on points of each wall."""
    made, theta = groove(kind, clearance=0.3, tolerance=1e-5), angles(90)
    m = made.rollers[0]
    for wall in made.walls:
        found, slope = Rest(wall=wall, roller=m).lift(theta)
        step = 1e-6
        ahead, behind = (Rest(wall=wall, roller=m).lift(theta + d)[0] for d in (step, -step))
        smooth = np.abs(theta % (0.5 * math.pi)) > 1e-3
        np.testing.assert_allclose(
            slope[smooth], ((ahead - behind) / (2.0 * step))[smooth], atol=1e-6
        )
        followed = follow(wall.outline, m, theta, side=wall.side).lift
        np.testing.assert_allclose(followed, found, atol=3e-5)
        if wall.side < 0 and isinstance(m, Stem):
            dense = np.concatenate([run.points for run in wall.contour.runs])
            dense = dense[:-1, None] + np.diff(dense)[:, None] * np.linspace(0.0, 1.0, 9)
            places = [
                lift(dense.ravel(), t, m.radius, m.offset, outwards=True) - m.start for t in theta
            ]
            np.testing.assert_allclose(found, places, atol=3e-5)


@pytest.mark.parametrize(
    ("kind", "height", "prime"), [("roller", 25.0, 30.0), ("swinging roller", 22.0, 35.0)]
)
def test_a_roller_that_rests_touches_its_wall_and_no_more(
    kind: str, height: float, prime: float
) -> None:
    """On corners too: the distance from its centre to the whole wall is its radius."""
    swings = kind.startswith("swinging")
    motion = there_and_back("3-4-5", height, STEEP, swings=swings)
    follower = follower_of(kind, roller_radius=13.6, prime_radius=prime)
    made = make_groove(motion, follower, clearance=2.0, tolerance=1e-4)
    theta = np.linspace(0.0, 2.0 * math.pi, 721)
    for wall in made.walls:
        assert wall.corners
        position = follower.start + Rest(wall=wall, roller=follower).lift(theta)[0]
        fixed = follower.pivot - follower.arm * np.exp(-1j * position) if swings else 1j * position
        center = fixed * np.exp(-1j * theta)
        places = shapely.points(center.real, center.imag)
        away = shapely.distance(places, wall.contour.polygon.boundary)
        np.testing.assert_allclose(away, 13.6, atol=2e-4)
        assert np.all(shapely.contains(wall.contour.polygon, places) == (wall.side < 0))
        wide = (
            follower.start
            + Rest(wall=wall, roller=replace(follower, radius=14.6)).lift(theta)[0]
            - follower.start
        )
        beyond = wall.side * (motion.derivatives(theta, 0)[0] - wide)
        assert beyond.max() == pytest.approx(wall.shortfall, rel=1e-2)


def test_jumps_of_velocity_round_one_wall_and_cut_the_other() -> None:
    made = make_groove(
        there_and_back("constant-velocity", 10.0), follower_of("roller"), clearance=1.0
    )
    for wall in made.walls:
        convex, concave = wall.profile_radius
        assert convex == 0.0
        assert concave == pytest.approx(6.5)
    rises = MotionFormula(lift="10*sin(theta/2)").program(DEFAULT, oscillating=False)
    assert [jump.after - jump.before for jump in rises.hard] == [pytest.approx(10.0)]
    inner, outer = make_groove(rises, follower_of("roller"), clearance=1.0).walls
    assert inner.profile_radius[0] > 1.0
    assert inner.profile_radius[1] == pytest.approx(6.5)
    assert outer.profile_radius[0] == 0.0
    assert outer.profile_radius[1] == pytest.approx(inner.profile_radius[0] + 13.0)


def test_without_clearance_only_corners_give_play() -> None:
    assert groove("roller, offset").lost_motion.value < 1e-13
    motion = there_and_back("3-4-5", 25.0, STEEP)
    made = make_groove(motion, follower_of("roller", roller_radius=9.5))
    corner = made.outer.corners[0]
    assert made.inner.corners == ()
    assert made.lost_motion.value == pytest.approx(made.outer.shortfall, rel=1e-12)
    theta = np.linspace(corner.before, corner.after, 400)
    rest = resting(made.outer.follower, ROTATING, corner.point, -1)(Jet.variable(theta, 0)).c[0]
    beyond = rest - motion.derivatives(theta, 0)[0]
    assert beyond.min() > -1e-12
    assert made.lost_motion.value == pytest.approx(beyond.max(), rel=1e-4)


@pytest.mark.parametrize("law", ["cycloidal", "constant-velocity"])
def test_the_largest_lost_motion_is_the_largest_of_many(law: str) -> None:
    made = make_groove(
        there_and_back(law, 10.0, (60.0, 20.0, 70.0, 210.0)), follower_of("roller"), clearance=0.5
    )
    theta = np.linspace(0.0, 2.0 * math.pi, 20001)
    inner, outer = (Rest(wall=wall, roller=made.rollers[0]).lift(theta)[0] for wall in made.walls)
    play = outer - inner
    assert play.min() > 0.0
    assert play.max() <= made.lost_motion.value + 1e-12
    assert play.max() == pytest.approx(made.lost_motion.value, rel=1e-4)


@pytest.mark.parametrize(("limit", "count"), [(0.0999, 1), (0.1001, 0)])
def test_lost_motion_is_told(limit: float, count: int) -> None:
    made = groove("roller")
    found = made.motion.pressure("rise")
    assert found is not None
    made = groove("roller", clearance=0.1 * math.cos(found.largest))
    told = run_checks(KIND, made, {"lost_motion": limit})
    assert [one.code for one in told].count("lost-motion") == count


@pytest.mark.parametrize("clearance", [0.0, 0.01])
def test_a_roller_that_fills_its_groove_is_noted(clearance: float) -> None:
    """But not two rollers that touch a wall each."""

    def told(cam: GrooveCam) -> list[str]:
        return [one.severity for one in run_checks(KIND, cam, {}) if one.code == "no-clearance"]

    made = groove(clearance=clearance)
    assert made.clearance == pytest.approx(clearance)
    assert told(made) == ["note"] * (not clearance)
    assert told(groove(clearance=clearance, radius2=4.0)) == []


def test_findings_name_the_wall() -> None:
    motion = there_and_back("3-4-5", 25.0, STEEP)
    made = make_groove(motion, follower_of("roller", roller_radius=9.5), clearance=0.1)
    found = [one for one in run_checks(KIND, made, {}) if one.code == "undercut"]
    assert len(found) == 2
    assert all(one.where.startswith("outer wall, at ") for one in found)
    assert all(one.message.startswith("The outer wall is undercut") for one in found)


def test_an_undercut_stretch_may_end_in_a_jump_at_the_end_of_the_turn() -> None:
    """The outer wall runs backwards before it, and the velocity rises at once there."""
    phases = [rise("constant-velocity", angle, 4.0) for angle in (22.36, 22.36, 292.92)]
    motion = program([*phases, back("constant-acceleration", 22.36, q=0.5)])
    made = make_groove(motion, follower_of("roller", prime_radius=15.0, roller_radius=0.75))
    first, last = (made.outer.undercut[k] for k in (0, -1))
    assert first == (0.0, 0.0)
    assert 6.28 < last[0] < last[1]
    assert made.outer.undercut[-1][1] == pytest.approx(2.0 * math.pi)
    region = band(made.outer.pitch_contour.vertices @ [1.0, 1.0j], 0.75)
    off = shapely.symmetric_difference(made.outer.contour.polygon, shapely.Polygon(region.exterior))
    assert off.area < 3.0 * made.outer.tolerance * region.length


def test_two_rollers_touch_a_wall_each() -> None:
    made = groove("roller", clearance=0.1, radius2=7.0)
    assert [wall.follower.radius for wall in made.walls] == pytest.approx([6.05, 7.05])
    assert made.relief is not None
    assert (made.relief.side, made.relief.follower.radius) == (1, pytest.approx(8.05))
    smaller = groove("roller", clearance=0.1, radius2=5.0)
    assert smaller.relief is not None
    assert (smaller.relief.side, smaller.relief.follower.radius) == (-1, pytest.approx(7.05))
    assert smaller.lost_motion.value == pytest.approx(
        groove("roller", clearance=0.1).lost_motion.value, rel=1e-9
    )


def test_a_roller_leaves_a_wall_that_comes_nearer_to_the_axis_than_it_can() -> None:
    """With half the clearance it would be at 6.65 mm from the axis, its guide is at 6.66 mm."""
    turn = 5.766050713996082
    up = SegmentPhase(angle=turn, to=4.0, velocity=12.2)
    motion = program([up, ReturnPhase(angle=TURN - turn, law=law("cycloidal"))])
    roller = follower_of("roller", roller_radius=0.75, offset=6.66, prime_radius=15.0)
    made = make_groove(motion, roller, clearance=1.0, tolerance=1e-4)
    lowest = roller.start + motion.range[0]
    assert math.hypot(6.66, lowest) - 0.5 < 6.66
    # free down to the height of the axis, at least
    assert made.lost_motion.value > lowest
    # and farther, as a follower on points of both walls finds
    theta = np.array([made.lost_motion.theta])
    low, high = (
        follow(wall.outline, roller, theta, side=wall.side, missed=wall.tolerance).lift[0]
        for wall in made.walls
    )
    assert high - low > lowest
