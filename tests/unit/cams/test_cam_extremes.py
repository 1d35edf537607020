"""Extreme cams: a right answer, or a refusal with a reason; never a wrong profile.

Right is what the boolean witness says (the follower subtracted at many angles), and what the
follower itself does on the polygon.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
import shapely

from gearcam.cams.checks import undercut
from gearcam.cams.disc import DiscCam, make_cam
from gearcam.cams.follow import follow
from gearcam.numeric.contour import Contour
from helpers_cams import (
    TURN,
    angles,
    back,
    cam,
    corners_of,
    dwell,
    follower_of,
    program,
    resting,
    rise,
    sizes_of,
    stiffness,
    witness_of,
)
from helpers_sampling import chosen, few
from witness.cam_sweep import swept

STEEP = (60.0, 90.0, 60.0, 150.0)
QUARTERS = (90.0, 90.0, 90.0, 90.0)
ONE = (1.0, 1.0, 1.0, 357.0)
SIDES = 240
"""Of the witness's circles."""


class Extreme(NamedTuple):
    kind: str
    law: str
    lift: float
    degrees: tuple[float, float, float, float] = QUARTERS
    changed: dict[str, Any] = {}  # noqa: RUF012  (never changed)
    tolerance: float = 1e-3
    steps: int = 360
    """Of the witness: a cutter of radius r must pass in steps below r."""


EXTREMES: dict[str, Extreme] = {
    "steady rise of a roller": Extreme("roller, offset", "constant-velocity", 10.0),
    "steady rise of a face": Extreme("flat", "constant-velocity", 10.0),
    "steady rise of an arm": Extreme("swinging roller", "constant-velocity", 10.0),
    "steady rise of a swinging face": Extreme("swinging face", "constant-velocity", 10.0),
    "one degree, roller": Extreme("roller", "cycloidal", 1.0, ONE),
    "one degree, steady": Extreme("roller", "constant-velocity", 10.0, ONE),
    "one degree, face": Extreme("flat", "cycloidal", 1.0, ONE),
    "one degree, dome": Extreme("domed", "cycloidal", 10.0, ONE),
    "one degree, arm": Extreme("swinging roller", "cycloidal", 10.0, ONE),
    "a hundredth of a degree": Extreme("roller", "cycloidal", 1.0, (0.01, 0.01, 0.01, 359.97)),
    "lift of three prime circles": Extreme("roller, offset", "cycloidal", 90.0, steps=720),
    "lift of thirty, dome": Extreme("domed", "cycloidal", 1800.0, tolerance=1e-2, steps=720),
    "lift of thirty, face": Extreme("flat", "cycloidal", 1200.0, tolerance=1e-2, steps=720),
    "roller near its prime circle": Extreme(
        "roller", "cycloidal", 10.0, STEEP, {"roller_radius": 29.9}, steps=720
    ),
    "roller near it, offset": Extreme(
        "roller, offset", "cycloidal", 10.0, STEEP, {"roller_radius": 29.0}, steps=720
    ),
    "arm's roller larger than the curve": Extreme(
        "swinging roller", "cycloidal", 12.0, STEEP, {"roller_radius": 36.0}, steps=720
    ),
    "base of a hundredth": Extreme("flat", "cycloidal", 10.0, QUARTERS, {"base_radius": 0.01}),
    "lift of a micrometre": Extreme("roller, offset", "cycloidal", 1e-3, tolerance=1e-6),
    "a micrometre under a face": Extreme("flat", "cycloidal", 1e-3, tolerance=1e-6),
    "a small cam": Extreme(
        "roller",
        "cycloidal",
        1e-3,
        QUARTERS,
        {"prime_radius": 3e-3, "roller_radius": 6e-4},
        1e-7,
    ),
    "a large cam": Extreme(
        "roller", "cycloidal", 1e4, QUARTERS, {"prime_radius": 3e4, "roller_radius": 6e3}, 1.0
    ),
    "a large face": Extreme("flat", "cycloidal", 1e4, QUARTERS, {"base_radius": 4e4}, 1.0),
    "coarse": Extreme("roller, offset", "cycloidal", 10.0, tolerance=0.01),
    "coarse and undercut": Extreme(
        "roller, offset", "cycloidal", 10.0, STEEP, {"roller_radius": 22.0}, 0.01
    ),
    "coarse arm": Extreme("swinging roller", "constant-velocity", 10.0, tolerance=0.01),
    "arm just long enough": Extreme(
        "swinging roller", "cycloidal", 1.0, QUARTERS, {"prime_radius": 10.01, "roller_radius": 2.0}
    ),
    "arm nearly stretched": Extreme(
        "swinging roller",
        "cycloidal",
        5.0,
        QUARTERS,
        {"prime_radius": 180.0, "roller_radius": 8.0},
        steps=720,
    ),
    "offset nearly the prime radius": Extreme(
        "roller, offset", "cycloidal", 10.0, QUARTERS, {"offset": 29.9}
    ),
    "face nearly across": Extreme(
        "swinging face", "cycloidal", 0.5, QUARTERS, {"base_radius": 99.9}
    ),
    "falling as fast as may be": Extreme(
        "swinging face", "cycloidal", 20.0, (60.0, 90.0, 40.1, 169.9)
    ),
}


@cache
def built(name: str) -> DiscCam:
    case = EXTREMES[name]
    return cam(
        case.kind, case.law, case.lift, case.degrees, tolerance=case.tolerance, **case.changed
    )


def demand_contour(made: DiscCam, most: float = 1.15) -> Contour:
    """A contour that can be cut: simple, counter-clockwise, within its tolerance, few points."""
    contour = made.contour
    assert contour.polygon.is_valid
    assert contour.area > 0.0
    assert contour.chord_error <= made.tolerance
    assert contour.polygon.contains(shapely.Point(0.0, 0.0))
    assert len(contour.vertices) <= most * made.sampler.least + len(made.corners) + 4
    assert contour.moments.area == pytest.approx(made.size.area, rel=1e-7)
    return contour


@pytest.mark.parametrize("name", few(EXTREMES, 4))
def test_an_extreme_cam_is_what_its_follower_leaves(name: str) -> None:
    case = EXTREMES[name]
    made = built(name)
    contour = demand_contour(made)
    areas = []
    for steps in (case.steps, 2 * case.steps):
        theta = np.union1d(TURN * np.arange(steps) / steps, made.program.knots[:-1])
        blank = 1.2 * float(np.abs(contour.vertices).max())
        lift = made.program.derivatives(theta, 0)[0]
        left = swept(witness_of(case.kind, **case.changed), theta, lift, blank, SIDES)
        areas.append(left.area)
    # the rest falls by four; circles keep their sides
    rest = areas[0] - areas[1]
    over = areas[1] - made.size.area
    assert 0.0 < over < 0.7 * rest + chords(made)
    assert over < 5e-3 * made.size.area


def chords(made: DiscCam) -> float:
    """What the sides of inscribed circles leave, at most: a rim of their sagitta."""
    return made.size.perimeter * made.follower.radius * (math.pi / SIDES) ** 2 / 2.0


@pytest.mark.parametrize("name", few(EXTREMES))
def test_an_extreme_cam_moves_its_follower(name: str) -> None:
    """On the polygon; nowhere too high, and too low only at corners, by what they say."""
    made = built(name)
    theta = np.sort(np.concatenate([angles(180), [loss.theta for loss in made.lost]]))
    found = follow(corners_of(made), made.follower, theta)
    missing = made.program.derivatives(theta, 0)[0] - found.lift
    room = 2.0 * made.tolerance * stiffness(made, theta)
    rests = resting(made, theta)
    assert np.all(np.abs(missing[~rests]) <= room[~rests])
    assert np.all(missing[rests] >= -room[rests] - corner_room(made))
    assert missing.max() <= made.shortfall + room.max()
    if made.shortfall > room.max():
        assert missing.max() >= made.shortfall - 2.0 * corner_room(made)


def corner_room(made: DiscCam) -> float:
    """Lift that a chord error may cost at a corner, where the pressure angle is the corner's."""
    return 20.0 * made.tolerance / (sizes_of(made.follower).pivot or 1.0)


def test_a_lift_is_lost_almost_whole_in_a_hundredth_of_a_degree() -> None:
    made = built("a hundredth of a degree")
    assert made.shortfall == pytest.approx(1.0, abs=1e-4)


def test_a_head_is_cut_off_at_its_neck() -> None:
    """Nowhere undercut: the roller passes on both sides of a high narrow cam, and meets itself."""
    lift, b, top = 300.0, 15.0, 2.0
    phases = [
        rise("formula", b, lift, formula="1 - (1 - x)**6"),
        dwell(top),
        back("formula", b, formula="x**6"),
        dwell(360.0 - 2 * b - top),
    ]
    made = make_cam(program(phases), follower_of("roller", roller_radius=10.0))
    demand_contour(made)
    assert made.undercut == []
    (corner,) = made.corners
    assert (
        np.degrees([corner.before, corner.after]) == pytest.approx([0.0, 2 * b + top], abs=0.05)
        or corner.before > math.pi
    )
    steep = np.radians(np.linspace(0.0, 2 * b + top, 1501))
    theta = np.union1d(TURN * np.arange(720) / 720, steep)
    lift_there = made.program.derivatives(theta, 0)[0]
    left = swept(witness_of("roller", roller_radius=10.0), theta, lift_there, 400.0, SIDES)
    assert left.area == pytest.approx(made.size.area, rel=1e-3)
    assert left.area > made.size.area
    at = np.array([made.lost[0].theta])
    found = follow(corners_of(made), made.follower, at)
    asked = float(made.program.derivatives(at, 0)[0][0])
    assert made.shortfall == pytest.approx(asked - found.lift[0], abs=1e-9)
    assert made.shortfall > 0.9 * lift
    (one,) = undercut(made, 0.01)
    assert one.severity == "error"
    assert one.message.startswith("The profile is cut away by the follower at another angle.")


# --- barely undercut ------------------------------------------------------------------------------


def loops(kind: str, depths: list[float]) -> list[float]:
    """Sizes near the limit of undercut leave loops of any smallness; return the lift they cost.

    With the speed ``a*(t^2 - u^2)`` of the contact a loop closes at ``sqrt(3)*u`` on both sides,
    and a face loses ``3*a*u^4/4``: the square of the depth ``a*u^2``. Loops of nanometres are cut
    out where they turn back, which costs no lift.
    """
    lost = []
    whole = near_limit(kind, -1e-9).size.area
    for depth in depths:
        made = near_limit(kind, depth)
        demand_contour(made)
        assert 1 <= len(made.corners) == len(made.undercut) <= 2
        assert made.size.area == pytest.approx(whole, abs=2.0 * made.size.perimeter * depth + 1e-6)
        for corner, (low, high) in zip(made.corners, made.undercut, strict=True):
            width = (corner.after - corner.before) % TURN
            assert width <= 1.8 * (high - low)
            if depth > 5e-3:
                assert width == pytest.approx(math.sqrt(3.0) * (high - low), rel=0.1 * depth)
        lost.append(made.shortfall)
    return lost


LOOPS = ["flat", "roller", "swinging roller"]


@pytest.mark.parametrize("kind", LOOPS)
def test_sizes_near_the_limit_of_undercut(kind: str) -> None:
    none, some, more = loops(kind, [1e-8, 1e-2, 3e-2])
    assert none < 1e-13
    assert more / some == pytest.approx(9.0, rel=0.01)
    if kind == "flat":
        # a is half the second derivative of s + s'' where that is least: t at which its slope is 0
        b, k = math.radians(60.0), 2 * math.pi / math.radians(60.0)
        t = TURN / k - math.acos(1.0 / (1.0 - k * k)) / k
        a = -0.5 * 10.0 / b * k * (k * k - 1.0) * math.sin(k * t)
        assert a > 100.0
        assert more == pytest.approx(0.75 * 3e-2**2 / a, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("kind", LOOPS)
def test_any_size_near_the_limit_of_undercut(kind: str) -> None:
    depths = 10.0 ** np.arange(-13.0, -1.4, 0.2)
    lost = np.array(loops(kind, depths.tolist()))
    assert np.all(np.diff(lost[depths > 5e-3]) > 0.0)
    assert np.all(lost <= 0.03 * depths**2 + 1e-13)


ONE_SIDED = {"harmonic": math.sqrt(2.0), "constant-acceleration": 1.5, "2-3": 1.5}
"""Width of a face's loop over that of its stretch: the radius falls below zero at a knot, beyond
which it is large. With ``rho = q*t^2 - d`` on one side of it ``q*t^4/4 = d*t^2/2`` closes the loop,
with ``rho = c*t - d`` it is ``c*t^3/3 = d*t^2/2``."""


@pytest.mark.parametrize("kind", LOOPS)
@pytest.mark.parametrize("law", ONE_SIDED)
@pytest.mark.parametrize(
    "depth", [1e-11, 0.1, *(pytest.param(d, marks=pytest.mark.slow) for d in (1e-6, 1e-3, 1e-2))]
)
def test_small_loops_at_jumps_of_the_curvature(kind: str, law: str, depth: float) -> None:
    """These laws are undercut first where their acceleration jumps."""
    made = near_limit(kind, depth, law)
    demand_contour(made)
    assert 1 <= len(made.corners) == len(made.undercut) <= 2
    assert made.shortfall < 20.0 * depth**2 + 1e-13
    for corner, (low, high) in zip(made.corners, made.undercut, strict=True):
        width = (corner.after - corner.before) % TURN
        assert width <= 1.8 * (high - low)
        if kind == "flat" and depth > 0.05:
            assert width == pytest.approx(ONE_SIDED[law] * (high - low), rel=0.005)


@pytest.mark.parametrize(
    ("kind", "law", "depth"),
    [
        ("flat", "harmonic", 1e-8),
        ("roller", "harmonic", 1e-2),
        ("roller", "harmonic", 1e-8),
        ("flat", "cycloidal", 1e-2),
    ],
)
def test_a_small_loop_beside_a_large_one(kind: str, law: str, depth: float) -> None:
    """The rise is barely undercut, the steady return has a shock at its start."""
    some = near_limit(kind, depth, law)
    phases = [rise(law, 60.0, 10.0), dwell(90.0), back("constant-velocity", 60.0), dwell(150.0)]
    made = make_cam(program(phases), some.follower)
    demand_contour(made)
    small, large = made.lost
    assert small.value == pytest.approx(some.shortfall, rel=1e-3, abs=1e-12)
    assert large.value > 0.1
    assert large.theta == pytest.approx(math.radians(150.0), abs=0.2)


@pytest.mark.parametrize("depth", [1e-8, 1e-3])
def test_a_small_loop_at_a_rising_shock(depth: float) -> None:
    """The curve is sharpest just behind a jump of the velocity up, where the roller has turned."""
    phases = [
        rise("constant-velocity", 164.0, 19.68, swings=True),
        back("cycloidal", 196.0),
    ]
    size = {"pivot_distance": 102.318, "arm": 97.738, "prime_radius": 28.224}
    motion = program(phases, swings=True)
    curvature = make_cam(motion, follower_of("swinging roller", **size)).pitch_curvature()
    assert curvature is not None
    assert curvature.high.theta == pytest.approx(0.0, abs=1e-9)
    radius = 1.0 / curvature.high.value + depth
    made = make_cam(motion, follower_of("swinging roller", roller_radius=radius, **size))
    demand_contour(made)
    assert len(made.corners) == 2
    assert min(loss.value for loss in made.lost) < 1e-9


def near_limit(kind: str, depth: float, law: str = "cycloidal") -> DiscCam:
    """A cam whose size is beyond the limit of undercut by so much."""
    made = cam(kind, law, 10.0, STEEP)
    if made.face_radius is not None:
        limit = made.follower.start - made.face_radius.low.value
        return cam(kind, law, 10.0, STEEP, base_radius=limit - depth)
    curvature = made.pitch_curvature()
    assert curvature is not None
    return cam(kind, law, 10.0, STEEP, roller_radius=1.0 / curvature.high.value + depth)


@pytest.mark.parametrize("kind", ["flat", "roller", "swinging roller", "swinging face, near"])
@pytest.mark.parametrize("size", chosen([-1e-3, -1e-6, -1e-8, 1e-8, 1e-6, 1e-3], -1e-3, 1e-8, 1e-6))
def test_small_shocks_cost_nothing(kind: str, size: float) -> None:
    """A velocity that jumps by typed digits, down (a tiny loop) or up (a tiny arc)."""
    swings = kind.startswith("swinging")
    phases = [
        rise("polynomial", 90.0, 8.0, swings=swings, start=(0.0, 0.0), end=(size, 0.0)),
        dwell(90.0),
        back("3-4-5", 90.0),
        dwell(90.0),
    ]
    changed: dict[str, Any] = {} if "roller" in kind else {"base_radius": 60.0}
    made = make_cam(program(phases, swings=swings), follower_of(kind, **changed))
    demand_contour(made)
    assert made.shortfall < 1e-5
    assert len(made.corners) <= 1
