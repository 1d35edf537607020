"""Random programs under random followers: a cam that does what was asked, or a refusal.

A cam's contour is simple and keeps its tolerance; the follower never rises above the lift asked for
by more than the chords explain, and gives it wherever it does not rest on a corner.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gearcam.base.errors import InfeasibleError
from gearcam.cams.disc import DiscCam, make_cam
from gearcam.cams.follow import follow
from gearcam.cams.placing import make_follower
from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.laws.phases_of_lift import Phase, SegmentPhase, levels
from helpers_cams import angles, back, corners_of, dwell, program, resting, rise, stiffness
from helpers_sampling import QUICK, rounded

LAWS = [
    "constant-velocity",
    "constant-acceleration",
    "harmonic",
    "cycloidal",
    "3-4-5",
    "4-5-6-7",
    "3-4-5-6",
    "trapezoidal-velocity",
    "modified-trapezoid",
    "modified-sine",
]
CHORD = 2e-3

Given = tuple[dict[str, Any], dict[str, Any], list[Phase]]


@st.composite
def followers(draw: st.DrawFn) -> tuple[dict[str, Any], dict[str, Any]]:
    kind, size = draw(st.sampled_from(["point", "roller", "domed", "flat"])), draw(rounded(15, 60))
    follower: dict[str, Any] = {"type": kind}
    if kind == "roller":
        follower["roller_radius"] = draw(rounded(0.05, 0.95)) * size
    if kind == "domed":
        follower["dome_radius"] = draw(rounded(0.2, 3)) * size
    based = kind in ("domed", "flat")
    prime = size + follower.get("dome_radius", 0.0)
    if draw(st.booleans()):
        follower["motion"] = "oscillating"
        follower["pivot_distance"] = draw(rounded(1.2, 4)) * prime
        if kind == "flat":
            follower["face_offset"] = draw(rounded(-0.4, 0.4)) * size
        else:
            follower["arm"] = follower["pivot_distance"] + draw(rounded(-0.9, 0.9)) * prime
    elif kind != "flat":
        follower["offset"] = draw(rounded(-0.9, 0.9)) * size
    return follower, {"base_radius" if based else "prime_radius": size}


@st.composite
def programs(draw: st.DrawFn, swings: bool) -> list[Phase]:
    """Rises, dwells, returns and segments that fill a turn and come back."""
    shares = draw(st.lists(rounded(0.02, 1), min_size=2, max_size=6))
    degrees = [360.0 * share / sum(shares) for share in shares]
    scale = draw(st.sampled_from([1.0, 5.0, 15.0] if swings else [2.0, 10.0, 40.0]))
    phases: list[Phase] = []
    for number, angle in enumerate(degrees):
        level = levels(phases)[-1] * (180.0 / math.pi if swings else 1.0)
        lift = draw(rounded(0.1, 1)) * scale
        kind = draw(st.sampled_from(["rise", "dwell", "return", "segment"]))
        law = draw(st.sampled_from(LAWS))
        if number == len(degrees) - 1:
            kind = "return" if level > 0.0 else "segment"
        if kind == "return" and level <= 0.0:
            kind = "rise"
        if kind == "rise":
            phases.append(rise(law, angle, lift, swings=swings))
        elif kind == "return":
            phases.append(back(law, angle))
        elif kind == "dwell":
            phases.append(dwell(angle))
        else:
            to = 0.0 if number == len(degrees) - 1 else lift
            phases.append(segment(angle, to, draw(rounded(-1, 1)) * scale, swings))
    if not any(levels(phases)):
        phases[0] = rise("cycloidal", degrees[0], scale, swings=swings)
        phases[-1] = back("cycloidal", degrees[-1])
    return phases


def segment(degrees: float, to: float, velocity: float, swings: bool) -> SegmentPhase:
    angle = math.radians(degrees)
    if not swings:
        return SegmentPhase(angle=angle, to=to, velocity=velocity)
    return SegmentPhase(angle=angle, to=math.radians(to), velocity=math.radians(velocity))


@st.composite
def cams(draw: st.DrawFn) -> Given:
    follower, size = draw(followers())
    return follower, size, draw(programs("motion" in follower))


def made_of(design: Given) -> DiscCam | InfeasibleError:
    """The cam with its contour, or its refusal."""
    follower, size, phases = design
    spec = FollowerSpec(**follower)
    try:
        found = make_follower(spec, CamSpec(**size))
        motion = program(phases, swings=spec.oscillating)
        made = make_cam(motion, found, tolerance=CHORD)
        assert made.contour.runs
    except InfeasibleError as error:
        return error
    return made


def demand_cam(design: Given) -> DiscCam | None:
    made = made_of(design)
    if isinstance(made, InfeasibleError):
        assert made.where
        assert made.nearest or made.limit is not None
        return None
    contour = made.contour
    assert contour.polygon.is_valid
    assert contour.area > 0.0
    assert contour.chord_error <= CHORD
    spare = 4 + len(made.corners) + len(made.program.knots)
    # chords of 0.955 of the length that the tolerance allows, of which at most 0.12 are halved
    assert len(contour.vertices) <= 1.18 * made.sampler.least + spare
    assert contour.moments.area == pytest.approx(made.size.area, rel=1e-6)
    demand_motion(made)
    return made


def demand_motion(made: DiscCam) -> None:
    theta = angles(120)
    found = follow(corners_of(made), made.follower, theta)
    missing = made.program.derivatives(theta, 0)[0] - found.lift
    # steep contacts move along the profile by more than a first order tells
    room = 1.5 * CHORD * stiffness(made, theta) + 1e-9
    near = resting(made, theta, 0.02)
    assert np.all(missing[~near] >= -room[~near])
    assert np.all(missing[~near] <= room[~near])
    lever = made.follower.lever
    assert np.all(missing >= -60.0 * CHORD / lever)
    assert missing.max() <= made.shortfall + room.max()


@QUICK
@given(cams())
def test_any_cam_moves_its_follower_or_is_refused_with_a_reason(design: Given) -> None:
    demand_cam(design)


@pytest.mark.slow
@settings(QUICK, max_examples=600)
@given(cams())
def test_many_cams_move_their_followers_or_are_refused(design: Given) -> None:
    demand_cam(design)


def test_gentle_cams_are_never_refused_or_trimmed() -> None:
    """Cycloidal rises of a fifth of the prime radius in quarters."""
    trimmed = []

    @settings(QUICK, max_examples=15)
    @given(rounded(20, 60), rounded(0.05, 0.6), rounded(-0.3, 0.3), rounded(0.05, 0.2))
    def one(prime: float, radius: float, offset: float, lift: float) -> None:
        follower = {"type": "roller", "roller_radius": radius * prime, "offset": offset * prime}
        phases = [
            rise("cycloidal", 90.0, lift * prime),
            dwell(90.0),
            back("cycloidal", 90.0),
            dwell(90.0),
        ]
        made = demand_cam((follower, {"prime_radius": prime}, phases))
        assert made is not None
        trimmed.append(bool(made.corners))

    one()
    assert len(trimmed) >= 10
    assert not any(trimmed)
