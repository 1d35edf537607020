"""Extreme cams: a right answer, or a refusal with a reason; never a wrong profile.

Right is what the boolean witness says (the follower subtracted at many angles), and what the
follower itself does on the polygon.
"""

from __future__ import annotations

import math
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
    mechanism,
    program,
    resting,
    rise,
    stiffness,
    witness_of,
)
from witness.cam_sweep import swept

STEEP = (60.0, 90.0, 60.0, 150.0)
QUARTERS = (90.0, 90.0, 90.0, 90.0)
ONE = (1.0, 1.0, 1.0, 357.0)
SIDES = 360
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


def built(case: Extreme) -> DiscCam:
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


@pytest.mark.parametrize("name", EXTREMES)
def test_an_extreme_cam_is_what_its_follower_leaves(name: str) -> None:
    case = EXTREMES[name]
    made = built(case)
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
    return made.size.perimeter * made.mechanism.radius * (math.pi / SIDES) ** 2 / 2.0


@pytest.mark.parametrize("name", EXTREMES)
def test_an_extreme_cam_moves_its_follower(name: str) -> None:
    """On the polygon; nowhere too high, and too low only at corners, by what they say."""
    made = built(EXTREMES[name])
    theta = np.sort(np.concatenate([angles(180), [loss.theta for loss in made.lost]]))
    found = follow(corners_of(made), made.mechanism, theta, smooth=False)
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
    return 20.0 * made.tolerance / (made.mechanism.pivot or 1.0)


def test_a_lift_is_lost_almost_whole_in_a_hundredth_of_a_degree() -> None:
    made = built(EXTREMES["a hundredth of a degree"])
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
    made = make_cam(program(phases), mechanism("roller", roller_radius=10.0))
    demand_contour(made)
    assert made.undercut == []
    (corner,) = made.corners
    assert (
        np.degrees([corner.before, corner.after]) == pytest.approx([0.0, 2 * b + top], abs=0.05)
        or corner.before > math.pi
    )
    steep = np.radians(np.linspace(0.0, 2 * b + top, 4001))
    theta = np.union1d(TURN * np.arange(720) / 720, steep)
    lift_there = made.program.derivatives(theta, 0)[0]
    left = swept(witness_of("roller", roller_radius=10.0), theta, lift_there, 400.0, SIDES)
    assert left.area == pytest.approx(made.size.area, rel=1e-3)
    assert left.area > made.size.area
    at = np.array([made.lost[0].theta])
    found = follow(corners_of(made), made.mechanism, at, smooth=False)
    asked = float(made.program.derivatives(at, 0)[0][0])
    assert made.shortfall == pytest.approx(asked - found.lift[0], abs=1e-9)
    assert made.shortfall > 0.9 * lift
    (one,) = undercut(made, 0.01)
    assert one.severity == "error"
    assert one.message.startswith("The profile is cut by the follower at another angle.")


# --- barely undercut ------------------------------------------------------------------------------

BARELY: dict[str, tuple[str, float, float, float]] = {
    "flat": ("base_radius", 20.0, 60.0, 10.0),
    "roller": ("roller_radius", 29.9, 10.0, 10.0),
    "swinging roller": ("roller_radius", 38.0, 5.0, 10.0),
}
"""The size that undercuts, one that does, one that does not, and the lift."""


@pytest.mark.parametrize("kind", BARELY)
def test_sizes_near_the_limit_of_undercut(kind: str) -> None:
    """A size typed with a few digits leaves loops of any smallness: they cost nothing."""
    name, under, free, lift = BARELY[kind]

    def made(size: float) -> DiscCam:
        changed: dict[str, Any] = {name: size}
        return cam(kind, "cycloidal", lift, STEEP, **changed)

    for _ in range(50):
        middle = 0.5 * (under + free)
        under, free = (middle, free) if made(middle).undercut else (under, middle)
    step = math.copysign(1.0, under - free) if under != free else -1.0
    step = -1.0 if kind == "flat" else step
    whole = made(free).size.area
    for depth in 10.0 ** np.arange(-12.0, -1.0):
        some = made(under + step * depth)
        demand_contour(some)
        assert some.shortfall < 1e-5
        assert len(some.corners) <= 2
        assert some.size.area == pytest.approx(whole, abs=300.0 * depth + 1e-6)
        for corner in some.corners:
            assert 0.0 <= (corner.after - corner.before) % TURN < 0.3


@pytest.mark.parametrize("kind", ["flat", "roller", "swinging roller", "swinging face, near"])
@pytest.mark.parametrize("size", [-1e-3, -1e-6, -1e-8, 1e-8, 1e-6, 1e-3])
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
    made = make_cam(program(phases, swings=swings), mechanism(kind, **changed))
    demand_contour(made)
    assert made.shortfall < 1e-5
    assert len(made.corners) <= 1
