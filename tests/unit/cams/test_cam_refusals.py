"""What cannot be is refused with its reason: programs, followers and sizes."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.cams.disc import make_cam
from gearcam.cams.placing import make_follower
from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.laws.phases_of_lift import (
    DwellPhase,
    Phase,
    RisePhase,
    SegmentPhase,
    angles_of,
    levels,
    program_problems,
)
from helpers_cams import back, cam, dwell, follower_of, law, program, rise, there_and_back
from helpers_sampling import few

# --- programs ------------------------------------------------------------------------------------


@pytest.mark.parametrize("miss", [2e-6, -2e-6, 0.1, -0.1])
def test_angles_that_miss_a_turn_by_more_are_refused(miss: float) -> None:
    """The limit is 1e-6 rad; the message says what the last phase would take."""
    phases = [
        rise("cycloidal", 90.0, 12.0),
        back("cycloidal", 90.0),
        DwellPhase(angle=math.pi + miss),
    ]
    with pytest.raises(InfeasibleError, match="the last phase would take 180 deg"):
        program(phases)
    program([*phases[:2], DwellPhase(angle=math.pi + math.copysign(0.9e-6, miss))])


def test_one_phase_takes_the_rest_of_the_turn() -> None:
    """The same program, to the last bit where the numbers leave no rounding."""
    given = [rise("cycloidal", 90.0, 12.0), dwell(45.0), back("3-4-5", 135.0), dwell(90.0)]
    theta = np.linspace(0.0, 2 * math.pi, 97)
    for number, phase in enumerate(given):
        phases = [*given[:number], replace(phase, angle="rest"), *given[number + 1 :]]
        made = program(phases)
        assert [s.end for s in made.stretches] == pytest.approx(
            np.radians([90.0, 135.0, 270.0, 360.0]), rel=1e-15
        )
        assert angles_of(phases)[number] == pytest.approx(phase.angle, rel=1e-15)
        np.testing.assert_allclose(made.lift(theta), program(given).lift(theta), atol=1e-13)


@pytest.mark.parametrize(
    ("angles", "wrong", "message"),
    [
        (("rest", 90.0, "rest", 90.0), 2, "only one phase can take the rest"),
        ((180.0, "rest", 90.0, 90.0), 1, "take 360 deg, which leaves nothing"),
        ((180.0, 90.0, 120.0, "rest"), 3, "take 390 deg, which leaves nothing"),
        (("rest", 90.0, 90.0, 180.0 - 5e-5), 0, "leaves nothing"),
    ],
)
def test_a_rest_that_is_none_is_refused(
    angles: tuple[float | str, ...], wrong: int, message: str
) -> None:
    kinds = [rise("2-3", 1.0, 5.0), dwell(1.0), back("2-3", 1.0), dwell(1.0)]
    phases = [
        replace(phase, angle=angle if isinstance(angle, str) else math.radians(angle))
        for phase, angle in zip(kinds, angles, strict=True)
    ]
    (found,) = program_problems(phases, oscillating=False)
    assert found[:2] == (wrong, "angle")
    assert message in found[2]
    with pytest.raises(InfeasibleError, match=message):
        program(phases)


def test_levels_of_phases() -> None:
    phases = [
        rise("2-3", 60.0, 5.0),
        dwell(60.0),
        SegmentPhase(angle=1.0, to=2.0),
        back("2-3", 60.0),
    ]
    assert levels([*phases, rise("2-3", 60.0, 4.0), back("2-3", 60.0, 3.0)]) == [
        0.0, 5.0, 5.0, 2.0, 0.0, 4.0, 1.0,
    ]  # fmt: skip


REFUSED: dict[str, tuple[list[Phase], str]] = {
    "open": ([rise("2-3", 180.0, 5.0), dwell(180.0)], r"ends at a lift of 5 mm"),
    "half back": ([rise("2-3", 180.0, 5.0), back("2-3", 180.0, 4.0)], r"ends at a lift of 1 mm"),
    "nothing to return": ([back("2-3", 180.0), dwell(180.0)], "nothing to return from"),
    "only dwells": ([dwell(180.0), dwell(180.0)], "never moves"),
    "no lift": (
        [
            RisePhase(angle=math.pi, law=law("2-3")),
            back("2-3", 180.0),
        ],
        "is missing",
    ),
    "no end": ([SegmentPhase(angle=math.pi), dwell(180.0)], "is missing"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_programs_that_cannot_be_are_refused(name: str) -> None:
    phases, message = REFUSED[name]
    with pytest.raises(InfeasibleError, match=message):
        program(phases)


def test_the_wrong_phase_is_named() -> None:
    phases = [dwell(90.0), replace(rise("2-3", 90.0, 5.0), lift=None), back("2-3", 180.0)]
    problems = list(program_problems(phases, oscillating=False))
    assert [problem[:2] for problem in problems] == [(1, "lift")]
    assert (
        list(program_problems([phases[0], rise("2-3", 90.0, 5.0), phases[2]], oscillating=True))
        == []
    )
    segment = SegmentPhase(angle=1.0, velocity=3.0)
    named = [problem[:2] for problem in program_problems([segment], oscillating=True)]
    assert named == [(0, "to")]
    with pytest.raises(InfeasibleError, match=r"ends at a lift of 5 deg"):
        program([rise("2-3", 180.0, 5.0, swings=True), dwell(180.0)], swings=True)


def test_a_lift_that_closes_to_rounding_is_closed() -> None:
    phases = [rise("2-3", 90.0, 0.1), rise("2-3", 90.0, 0.2), back("2-3", 180.0, 0.3)]
    made = program(phases)
    assert made.lift.on_pieces(np.array([2]), made.knots[[3]], 0)[0, 0] == 0.0
    off = [rise("2-3", 90.0, 0.1), rise("2-3", 90.0, 0.2), back("2-3", 180.0, 0.3 + 1e-8)]
    with pytest.raises(InfeasibleError, match="ends at a lift"):
        program(off)


# --- followers and sizes -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "changed", "message"),
    [
        ("roller", {"offset": 30.0}, "axis misses the prime circle"),
        ("roller", {"offset": -31.0}, "axis misses the prime circle"),
        ("swinging roller", {"prime_radius": 10.0}, "arm cannot reach .* between 10 and 190 mm"),
        ("swinging roller", {"prime_radius": 190.0}, "arm cannot reach .* between 10 and 190 mm"),
        ("swinging face", {"base_radius": 100.0}, "cannot touch the base circle"),
        ("swinging face, near", {"base_radius": 93.0}, "cannot touch the base circle"),
    ],
)
def test_followers_that_cannot_touch_are_refused(
    kind: str, changed: dict[str, Any], message: str
) -> None:
    with pytest.raises(InfeasibleError, match=message):
        follower_of(kind, **changed)
    nudged = {
        name: value + (1e-6 if value in (10.0, -31.0) else -1e-6) for name, value in changed.items()
    }
    if -31.0 not in changed.values():
        follower_of(kind, **nudged)


def test_lifts_that_bring_the_follower_to_the_axis_are_refused() -> None:
    for kind, depth in (("roller", 24.0), ("flat", 40.0), ("domed", 60.0)):
        for lift, refused in ((depth - 1e-6, False), (depth + 1e-6, True)):
            phases = [back("cycloidal", 90.0, lift), dwell(90.0), rise("cycloidal", 180.0, lift)]
            if refused:
                with pytest.raises(InfeasibleError, match="onto the cam's axis"):
                    make_cam(program(phases), follower_of(kind, offset=0.0))
            else:
                make_cam(program(phases), follower_of(kind, offset=0.0))


def test_a_follower_may_not_pass_below_the_axis() -> None:
    """Beside it there would be room: the offset is larger than the roller."""
    height = math.sqrt(30.0**2 - 8.0**2)
    for lift in (height - 0.1, height + 0.1):
        phases = [back("cycloidal", 90.0, lift), dwell(90.0), rise("cycloidal", 180.0, lift)]
        if lift < height:
            assert make_cam(program(phases), follower_of("roller, offset")).size.area > 0.0
        else:
            with pytest.raises(InfeasibleError, match="onto the cam's axis"):
                make_cam(program(phases), follower_of("roller, offset"))


def test_arms_that_swing_too_far_are_refused() -> None:
    d, arm, prime = 100.0, 90.0, 40.0
    room = 180.0 - math.degrees(math.acos((d * d + arm * arm - prime**2) / (2 * d * arm)))
    cam("swinging roller", lift=room - 1e-6)
    with pytest.raises(InfeasibleError, match="passes the line of centres"):
        cam("swinging roller", lift=room + 1e-6)
    room = 90.0 - math.degrees(math.asin(0.4))
    cam("swinging face", lift=room - 1e-6, degrees=(90.0, 30.0, 210.0, 30.0))
    with pytest.raises(InfeasibleError, match="is perpendicular to the line of centres"):
        cam("swinging face", lift=room + 1e-6, degrees=(90.0, 30.0, 210.0, 30.0))


def test_a_face_that_falls_faster_than_the_cam_turns_is_refused() -> None:
    """A cycloidal return is fastest at twice its mean speed: 20 deg in 40 deg is the limit."""
    cam("swinging face", lift=20.0, degrees=(60.0, 90.0, 40.0 * (1 + 1e-6), 170.0))
    for degrees in (40.0 * (1 - 1e-6), 30.0):
        with pytest.raises(InfeasibleError, match="faster than the cam turns"):
            cam("swinging face", lift=20.0, degrees=(60.0, 90.0, degrees, 210.0 - degrees))
    motion = there_and_back("cycloidal", 40.0, (30.0, 90.0, 120.0, 120.0), swings=True)
    make_cam(motion, follower_of("swinging face"))


WRONG: list[tuple[dict[str, Any], dict[str, Any], set[str]]] = [
    ({"type": "roller"}, {"prime_radius": 30.0}, {"roller_radius"}),
    ({"type": "flat", "roller_radius": 3.0}, {"base_radius": 30.0}, {"roller_radius"}),
    ({"type": "domed"}, {"prime_radius": 30.0}, {"dome_radius"}),
    ({"type": "point", "arm": 80.0}, {"prime_radius": 30.0}, {"arm"}),
    (
        {"type": "point", "motion": "oscillating"},
        {"prime_radius": 30.0},
        {"arm", "pivot_distance"},
    ),
    (
        {"type": "flat", "motion": "oscillating", "pivot_distance": 90.0, "arm": 80.0},
        {"base_radius": 30.0},
        {"arm"},
    ),
    (
        {
            "type": "point",
            "motion": "oscillating",
            "pivot_distance": 90.0,
            "arm": 80.0,
            "offset": 3.0,
        },
        {"prime_radius": 30.0},
        {"offset"},
    ),
    ({"type": "flat", "face_offset": 3.0}, {"base_radius": 30.0}, {"face_offset"}),
    ({"type": "flat"}, {"prime_radius": 30.0}, {"prime_radius"}),
    ({"type": "flat"}, {}, {"cam"}),
    ({"type": "point"}, {}, {"cam"}),
    ({"type": "point"}, {"prime_radius": 30.0, "base_radius": 30.0}, {"base_radius"}),
    ({"type": "roller", "roller_radius": 30.0}, {"prime_radius": 30.0}, {"prime_radius"}),
    ({"type": "roller", "roller_radius": 29.0}, {"prime_radius": 30.0}, set()),
]


@pytest.mark.parametrize(("follower", "size", "fields"), WRONG)
def test_sizes_that_do_not_belong_are_told(
    follower: dict[str, Any], size: dict[str, Any], fields: set[str]
) -> None:
    swings = follower.get("motion") == "oscillating"
    motion = gearcam.MotionFormula(lift=f"{0.05 if swings else 2}*(1 - cos(theta))")
    spec, given = FollowerSpec(**follower), CamSpec(**size)
    found = set()
    try:
        gearcam.CamDesign(name="cam", motion=motion, follower=spec, cam=given)
    except gearcam.DesignError as error:
        found = {one.key.split(".")[-1].removesuffix("_mm") for one in error.problems}
    assert found == fields


def test_a_base_radius_is_the_prime_radius_less_the_roller() -> None:
    follower = FollowerSpec(type="roller", roller_radius=6.0, offset=8.0)
    one = make_follower(follower, CamSpec(prime_radius=30.0))
    two = make_follower(follower, CamSpec(base_radius=24.0))
    assert one == two
    assert one.start == pytest.approx(math.sqrt(30.0**2 - 8.0**2), rel=1e-15)
    assert one.prime_radius == pytest.approx(30.0, rel=1e-15)


# --- tables --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "changes"),
    few(
        [
            ("tappet", {"output.motion_step_deg": 1e-6}),
            ("translating_cam", {"output.travel_step_mm": 1e-3, "cam.run_out_mm": 1200.0}),
        ]
    ),
)
def test_a_step_with_too_many_rows_is_refused_with_the_smallest(
    name: str, changes: dict[str, float]
) -> None:
    key = next(iter(changes))
    result = gearcam.build(gearcam.load(f"profiles/{name}.toml").with_(changes))
    with pytest.raises(InfeasibleError, match="1000000 rows") as refused:
        result.files("csv")
    assert refused.value.where == key
    (remedy,) = gearcam.remedies(result, refused.value).found
    assert list(remedy.changes) == [key]
    rows = len(gearcam.build(remedy.design).angles)
    assert 9.8e5 < rows <= 1e6 + 1
