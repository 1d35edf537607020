"""What limits of cams are told: each is one, and what is told to suit does."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

import mpmath
import numpy as np
import pytest

import gearcam
from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.cams.checks import pressure_angle
from gearcam.cams.disc import make_cam
from gearcam.cams.groove import make_groove
from gearcam.laws.motion_formula import MotionFormula
from gearcam.laws.phases_of_lift import Phase, SegmentPhase
from gearcam.laws.program import Program
from helpers_cams import back, cam, dwell, follower_of, program, rise, there_and_back

BESIDE = 1e-9


def dip(lift: float, *, swings: bool) -> Program:
    """A motion down to a lift and back."""
    phases: Sequence[Phase] = [SegmentPhase(angle=math.pi, to=to) for to in (lift, 0.0)]
    return program(phases, swings=swings)


DIPPING = ["point", "roller", "roller, offset", "flat", "swinging roller", "swinging face, near"]


@pytest.mark.parametrize("kind", DIPPING)
def test_the_lowest_lift_that_is_told_is_the_lowest(kind: str) -> None:
    made, swings = follower_of(kind), kind.startswith("swinging")
    deep = -1.5 if swings else -100.0
    with pytest.raises(InfeasibleError) as refused:
        make_cam(dip(deep, swings=swings), made)
    limit = refused.value.limit
    assert limit is not None
    lowest = math.radians(limit) if swings else limit
    assert lowest < 0.0
    make_cam(dip(lowest * (1.0 - BESIDE), swings=swings), made)
    with pytest.raises(InfeasibleError):
        make_cam(dip(lowest * (1.0 + BESIDE), swings=swings), made)


def test_an_arm_that_meets_the_axis_is_told_at_which_lift() -> None:
    """By the cosine rule: an arm as long as its pivot is far would meet the axis itself."""
    made = follower_of("swinging roller", arm=100.0, roller_radius=8.0)
    touching = math.acos(1.0 - 8.0**2 / (2.0 * 100.0**2))
    with pytest.raises(InfeasibleError, match="onto the cam's axis") as refused:
        make_cam(dip(touching - made.start - 1e-6, swings=True), made)
    assert refused.value.limit == pytest.approx(math.degrees(touching - made.start), rel=1e-12)


@pytest.mark.parametrize("degrees", [20.0, 39.0, 40.0])
def test_the_share_of_a_lift_that_a_falling_face_carries(degrees: float) -> None:
    phases = [60.0, 90.0, degrees, 210.0 - degrees]
    with pytest.raises(InfeasibleError, match="faster than the cam turns") as refused:
        make_cam(
            there_and_back("cycloidal", 20.0, phases, swings=True), follower_of("swinging face")
        )
    (share,) = re.findall(r"less than ([\d.]+) % of these", str(refused.value))
    part = float(share) / 100.0
    assert len(share.replace(".", "")) <= 4
    assert degrees / 40.0 * (1.0 - 3e-4) < part < degrees / 40.0
    lift = 20.0 * part
    make_cam(there_and_back("cycloidal", lift, phases, swings=True), follower_of("swinging face"))


@pytest.mark.parametrize("second", [None, 25.0])
def test_a_groove_that_reaches_the_axis(second: float | None) -> None:
    lift, made = there_and_back("cycloidal", 10.0), follower_of("roller")
    size: dict[str, Any] = {"clearance": 48.0} if second is None else {"radius2": second}
    with pytest.raises(InfeasibleError, match="groove is so wide") as refused:
        make_groove(lift, made, **size)
    assert refused.value.limit == pytest.approx(30.0)
    assert refused.value.value == pytest.approx(30.0 if second is None else 44.0)
    least: dict[str, Any] = {"clearance": 47.9} if second is None else {"radius2": 17.9}
    make_groove(lift, made, **least)


def test_the_base_radii_of_a_face_begin_at_zero() -> None:
    with pytest.raises(InfeasibleError, match="between 0 and 100 mm"):
        follower_of("swinging face", base_radius=100.0)


# --- narrow profiles ------------------------------------------------------------------------------


def plate(way: float, tolerance: float) -> dict[str, Any]:
    return {
        "kind": "cam",
        "name": "plate",
        "motion": [
            {"type": "rise", "law": "3-4-5", "travel_mm": way, "lift_deg": 15.0},
            {"type": "dwell", "travel_mm": way},
            {"type": "return", "law": "3-4-5", "travel_mm": way},
        ],
        "follower": {
            "type": "point",
            "motion": "oscillating",
            "arm_mm": 60.0,
            "pivot_distance_mm": 70.0,
        },
        "cam": {"form": "translating", "run_in_mm": 20.0, "run_out_mm": 20.0},
        "blank": {"height_mm": 80.0},
        "output": {"chord_tolerance_mm": tolerance},
    }


def test_a_plate_with_a_spike_narrower_than_its_chords() -> None:
    with pytest.raises(InfeasibleError, match="so narrow that") as refused:
        gearcam.build(gearcam.design(plate(1e-2, 0.1))).profile  # noqa: B018
    assert refused.value.limit is not None
    finer = gearcam.build(gearcam.design(plate(1e-2, refused.value.limit))).profile
    assert finer.polygon.is_valid


@pytest.mark.parametrize("before", [0.0, 170.0])
@pytest.mark.parametrize("degrees", [1e-3, 1e-6])
def test_a_roller_passes_over_a_peak_wherever_it_stands(before: float, degrees: float) -> None:
    """Rounding of the cam angle times the speed of the contact is more than that of points."""
    lead = [dwell(before)] if before else []
    rest = dwell(360.0 - before - 3.0 * degrees)
    steps = [rise("cycloidal", degrees, 10.0), dwell(degrees), back("cycloidal", degrees), rest]
    made = make_cam(program([*lead, *steps]), follower_of("roller"))
    assert made.contour.polygon.is_valid
    assert made.shortfall == pytest.approx(10.0, abs=1e4 * math.radians(degrees))
    assert made.size.area == pytest.approx(math.pi * 24.0**2, rel=2.0 * degrees)


@pytest.mark.slow
def test_hundreds_of_undercut_places_are_refused() -> None:
    with pytest.raises(InfeasibleError, match="undercut in too many places") as refused:
        make_cam(waves("0.01*sin(600*theta)"), follower_of("roller")).contour  # noqa: B018
    assert (refused.value.value, refused.value.limit) == (600, 500)


# --- formulas -------------------------------------------------------------------------------------


def waves(lift: str) -> Program:
    return MotionFormula(lift=lift).program(DEFAULT)


@pytest.mark.slow
@pytest.mark.parametrize("count", [720, 1440])
def test_waves_are_seen_where_even_places_are_their_zeros(count: int) -> None:
    made = waves(f"1e-6*sin({count}*theta)")
    low, high = made.range
    assert (low, high) == (pytest.approx(-1e-6, rel=1e-9), pytest.approx(1e-6, rel=1e-9))
    assert len(made.phases("rise")) == count + 1  # one goes on over the end of the turn
    assert len(made.phases("return")) == count


def test_a_hundredth_power_has_derivatives_at_zero() -> None:
    """Against the closed form: ``f = sin(x)**100`` with x half the angle."""
    theta = np.array([0.0, 2.5, 3.0])
    value, slope, bend = waves("sin(theta/2)**100").derivatives(theta, 2)
    sine, cosine = np.sin(theta / 2), np.cos(theta / 2)
    np.testing.assert_allclose(value, sine**100, rtol=1e-12)
    np.testing.assert_allclose(slope, 50.0 * sine**99 * cosine, rtol=1e-12)
    np.testing.assert_allclose(bend, 25.0 * (99.0 * sine**98 * cosine**2 - sine**100), rtol=1e-11)


@pytest.mark.parametrize("lift", ["1e308*cos(theta)", "exp(exp(theta))", "exp(700*sin(theta)**2)"])
@pytest.mark.filterwarnings("error")
def test_lifts_beyond_all_numbers(lift: str) -> None:
    with pytest.raises(InfeasibleError, match="the lift is too large") as refused:
        waves(lift)
    assert refused.value.limit == 1e5
    with pytest.raises(InfeasibleError, match="limit 180 deg"):
        MotionFormula(lift=lift).program(DEFAULT, oscillating=True)


def test_what_is_too_steep_to_tell_from_a_jump() -> None:
    with pytest.raises(
        InfeasibleError, match=r"is not smooth .*a few arc seconds counts as a jump"
    ):
        waves("5*tanh(1e6*(theta - 3)) - 5*tanh(1e6*(theta - 4))")
    waves("5*tanh(1e3*(theta - 3)) - 5*tanh(1e3*(theta - 4))")


# --- continuity -----------------------------------------------------------------------------------


STEEP = (60.0, 90.0, 60.0, 150.0)
DEPTHS = np.array([-1e-3, -1e-8, 1e-8, 1e-5, 1e-3])
"""How far a size is beyond the limit of undercut, mm."""


@pytest.mark.parametrize("kind", ["roller", "flat", "swinging roller"])
def test_a_size_goes_through_the_limit_of_undercut_without_a_leap(kind: str) -> None:
    """Area by size changes at a steady rate; the documented change: stretches, and corners."""
    made = cam(kind, "cycloidal", 10.0, STEEP)
    face = made.face_radius
    pitch = made.pitch_curvature()
    limit = made.follower.start - face.low.value if face else 1.0 / pitch.high.value  # type: ignore[union-attr]
    key, sign = ("base_radius", -1.0) if face else ("roller_radius", 1.0)
    walked = [
        cam(kind, "cycloidal", 10.0, STEEP, **{key: limit + sign * depth})
        for depth in DEPTHS.tolist()
    ]
    rates = np.diff([one.size.area for one in walked]) / np.diff(DEPTHS)
    perimeter = walked[0].size.perimeter
    assert rates == pytest.approx(np.full(len(rates), -perimeter), rel=5e-3)
    for depth, one in zip(DEPTHS.tolist(), walked, strict=True):
        assert bool(one.undercut) == (depth > 0.0)
        assert bool(one.corners) == (depth > 0.0)
        assert one.shortfall <= max(depth, 0.0) ** 2 + 1e-12
        assert one.profile_radius[0] == pytest.approx(max(-depth, 0.0), abs=1e-11)


def test_a_prime_radius_goes_through_the_limit_of_pressure_angles() -> None:
    """Of steady velocity the angle is largest at the beginning, ``atan(s'/prime)``."""
    limit = 10.0 / math.radians(60.0) / math.tan(math.radians(30.0))
    for share in (-1e-6, -1e-12, 1e-12, 1e-6):
        made = cam(
            "point",
            "constant-velocity",
            10.0,
            STEEP,
            prime_radius=limit * (1.0 + share),
            offset=0.0,
        )
        found = made.pressure("rise")
        assert found is not None
        assert found.largest == pytest.approx(math.radians(30.0), rel=abs(share) + 1e-13)
        told = [one for one in pressure_angle(made, math.nan) if "rise" in one.message]
        assert [one.where for one in told] == ["rise, at 0 deg"] * (share < 0.0)


@pytest.mark.parametrize("law", ["cycloidal", "constant-velocity"])
def test_a_phase_becomes_a_step_without_a_leap(law: str) -> None:
    """The profile of ever shorter rises has a limit, from which it is off by their angle."""
    widths = np.array([1e-1, 1e-2, 1e-3, 1e-4, 1e-6])
    walked = [cam("roller", law, 10.0, (width, 90.0, 60.0, 210.0 - width)) for width in widths]
    areas = np.array([one.contour.moments.area for one in walked])
    off = np.abs(areas[:-1] - areas[-1])
    assert np.all(off <= 300.0 * np.radians(widths[:-1]) + 1e-3)
    for one, area in zip(walked, areas, strict=True):
        assert len(one.corners) == (1 if law == "cycloidal" else 2)
        assert one.contour.chord_error <= one.tolerance
        assert one.contour.area == pytest.approx(area, abs=one.tolerance * one.size.perimeter)


@pytest.mark.parametrize("kind", ["roller", "flat", "swinging roller"])
def test_a_hard_shock_of_any_size_is_an_arc_or_a_straight_piece(kind: str) -> None:
    """A roller turns about its own centre by nearly a right angle, however steep the rise is."""
    for width in (1e-2, 1e-4, 1e-6):
        made = cam(kind, "constant-velocity", 10.0, (width, 90.0, 60.0, 210.0 - width))
        assert made.size.area_error <= 1e-9 * made.size.area
        assert made.size.area == pytest.approx(made.contour.moments.area, rel=1e-9)
        assert made.contour.area == pytest.approx(
            made.size.area, abs=made.tolerance * made.size.perimeter
        )


def test_a_follower_comes_to_its_dead_centre_by_the_root_of_the_distance() -> None:
    """By the sides of a triangle that is nearly flat, as typed and so as rounded."""
    for gap in (1e-2, 1e-4, 1e-6, 1e-8):
        prime = 10.0 + gap
        with mpmath.workdps(30):
            cosine = (mpmath.mpf(100) ** 2 + 90**2 - mpmath.mpf(prime) ** 2) / (2 * 100 * 90)
            angle = float(mpmath.acos(cosine))
        made = follower_of("swinging roller", prime_radius=prime)
        assert made.start == pytest.approx(angle, rel=1e-14)
