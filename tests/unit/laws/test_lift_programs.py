"""Lift programs: phases follow each other, shocks are named where they are, and turns close."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
import pytest

from gearcam.laws.motion.base import ClosedForm
from gearcam.laws.phases_of_lift import (
    PHASES,
    Phase,
    ReturnPhase,
    RisePhase,
    SegmentPhase,
)
from gearcam.laws.program import Program
from gearcam.numeric.piecewise import Piece, Piecewise, piecewise
from helpers_cams import TURN, back, dwell, program, rise, there_and_back

LIFT = 12.0
DEGREES = (80.0, 70.0, 110.0, 100.0)
UP, TOP, DOWN, BOTTOM = (math.radians(angle) for angle in DEGREES)
mp: Any = mpmath.mp


def segment(
    degrees: float, to: float, velocity: float = 0.0, acceleration: float = 0.0
) -> SegmentPhase:
    return SegmentPhase(
        angle=math.radians(degrees),
        to=to,
        velocity=velocity,
        acceleration=acceleration,
    )


def state(made: Program, theta: float, side: int) -> np.ndarray:
    """s, s', s'', s''' on one side of a knot, by the piece on that side."""
    knots = made.knots
    number = int(np.argmin(np.abs(knots - theta)))
    assert abs(knots[number] - theta) < 1e-12
    last = len(knots) - 1
    piece = (number if side > 0 else number - 1) % last
    knot = knots[piece if side > 0 else piece + 1]
    return made.lift.on_pieces(np.array([piece]), np.array([knot]), 3)[:, 0]


# --- closure and places ---------------------------------------------------------------------------


def test_a_program_fills_the_turn_exactly() -> None:
    made = there_and_back("cycloidal", LIFT, DEGREES)
    assert made.knots[0] == 0.0
    assert made.knots[-1] == TURN
    assert [stretch.kind for stretch in made.stretches] == ["rise", "dwell", "return", "dwell"]
    ends = np.cumsum([UP, TOP, DOWN, BOTTOM])
    assert [stretch.end for stretch in made.stretches] == pytest.approx(ends, abs=1e-14)
    assert made.stretches[0].start == 0.0
    assert state(made, TURN, -1)[0] == 0.0
    assert made.range == pytest.approx((0.0, LIFT), abs=1e-12)


def test_a_program_repeats_every_turn() -> None:
    made = there_and_back("3-4-5", LIFT, DEGREES)
    theta = np.linspace(0.01, 6.2, 50)
    once = made.derivatives(theta, 3)
    for turns in (-2, -1, 1, 5):
        again = made.derivatives(theta + turns * TURN, 3)
        for one, two in zip(once, again, strict=True):
            np.testing.assert_allclose(one, two, atol=1e-10)
    assert made.derivatives([0.0, TURN, -TURN], 0)[0].tolist() == [0.0, 0.0, 0.0]


def test_angles_that_miss_a_turn_by_typed_digits_are_spread() -> None:
    """Seven phases of 51.428571 deg are 3e-6 deg short."""
    phases: list[Phase] = [rise("cycloidal", 51.428571, LIFT), *[dwell(51.428571)] * 5]
    phases.append(back("cycloidal", 51.428571))
    made = program(phases)
    assert made.knots[-1] == TURN
    ends = np.array([stretch.end for stretch in made.stretches])
    np.testing.assert_allclose(ends, TURN * np.arange(1, 8) / 7, rtol=1e-15)


@pytest.mark.parametrize("degrees", [1.0, 1e-2, 1e-4])
def test_tiny_angles_keep_their_laws(degrees: float) -> None:
    made = there_and_back("cycloidal", LIFT, (degrees, degrees, degrees, 360.0 - 3 * degrees))
    b = math.radians(degrees)
    assert np.all(np.diff(made.knots) > 0.0)
    assert made.peaks == pytest.approx(
        (2 * LIFT / b, TURN * LIFT / b**2, TURN**2 * LIFT / b**3), rel=1e-9
    )
    assert made.continuity == 2
    assert made.derivatives([0.25 * b, 0.5 * b, 1.5 * b, 2.5 * b], 0)[0] == pytest.approx(
        [LIFT * (0.25 - 0.5 / math.pi), 0.5 * LIFT, LIFT, 0.5 * LIFT], rel=1e-9
    )


# --- laws in their phases -------------------------------------------------------------------------

ASYMMETRIC = {
    "constant-acceleration": {"q": 0.3},
    "polynomial": {"start": (0.0, 0.0, 0.0), "end": (0.0, 0.0)},
    "formula": {"formula": "x**4*(5 - 4*x)"},
}


@pytest.mark.parametrize("name", ASYMMETRIC)
def test_a_return_is_one_less_the_rise(name: str) -> None:
    """000 (3.5): S_c(phi) = 1 - S_r(phi), in the same direction of phi."""
    more = ASYMMETRIC[name]
    phases = [
        rise(name, DEGREES[0], LIFT, **more),
        dwell(DEGREES[1]),
        back(name, DEGREES[2], **more),
        dwell(DEGREES[3]),
    ]
    made = program(phases)
    phi = np.linspace(0.01, 0.99, 33)
    up = made.derivatives(UP * phi, 3)
    down = made.derivatives(UP + TOP + DOWN * phi, 3)
    for order, (one, two) in enumerate(zip(up, down, strict=True)):
        unit = one * UP**order / LIFT
        returned = two * DOWN**order / LIFT
        np.testing.assert_allclose(returned, (1.0 if order == 0 else 0.0) - unit, atol=2e-11)
    assert abs(up[0][16] / LIFT - 0.5) > 0.01
    exact = 1.0 - {
        "constant-acceleration": lambda x: x * x / 0.3 if x < 0.3 else 1 - (1 - x) ** 2 / 0.7,
        "polynomial": lambda x: x**4 * (15 - 24 * x + 10 * x * x),
        "formula": lambda x: x**4 * (5 - 4 * x),
    }[name](0.25)
    at = float(made.derivatives(UP + TOP + 0.25 * DOWN, 0)[0])
    assert at == pytest.approx(LIFT * exact, rel=1e-12)


def test_the_rise_and_return_in_one_formula() -> None:
    """3-4-5-6: S = phi^3*(2 - phi)^3 on the whole, from 0 to 2, all derivatives over the top."""
    degrees = 75.0
    b = math.radians(degrees)
    phases = [rise("3-4-5-6", degrees, LIFT), back("3-4-5-6", degrees), dwell(360.0 - 2 * degrees)]
    made = program(phases)
    phi = np.linspace(0.0, 2.0, 81)[1:-1]
    found = made.derivatives(b * phi, 3)
    w = phi - 1.0
    exact = [
        (1 - w**2) ** 3,
        -6 * w * (1 - w**2) ** 2,
        -6 * (1 - w**2) * (1 - 5 * w**2),
        24 * w * (3 - 5 * w**2),
    ]
    for order, (values, of) in enumerate(zip(found, exact, strict=True)):
        np.testing.assert_allclose(values, LIFT / b**order * of, atol=1e-11 / b**order)
    assert [(round(jump.theta / b, 9), jump.order) for jump in made.jumps] == [(0.0, 3), (2.0, 3)]
    assert made.continuity == 2
    assert made.jumps[0].after == pytest.approx(48 * LIFT / b**3, rel=1e-12)
    peak = 96 * math.sqrt(5) / 125 * LIFT / b
    assert made.peaks[:2] == pytest.approx((peak, 6 * LIFT / b**2), rel=1e-12)


def test_a_mirrored_law_may_fall_before_it_rises() -> None:
    """From 0 down and up again: minus the same curve, the parts in the other order."""
    b = math.radians(75.0)
    made = program([back("3-4-5-6", 75.0, LIFT), rise("3-4-5-6", 75.0, LIFT), dwell(210.0)])
    phi = np.array([0.2, 0.7])
    # the return runs the rise backwards from its top, which is the acceleration of -6
    down = made.derivatives(b * phi, 2)
    np.testing.assert_allclose(down[0], LIFT * ((1 - phi**2) ** 3 - 1.0), rtol=1e-12)
    assert state(made, 0.0, 1)[2] == pytest.approx(-6 * LIFT / b**2, rel=1e-12)
    up = made.derivatives(b * (1 + phi), 0)[0]
    np.testing.assert_allclose(up, LIFT * ((1 - (1 - phi) ** 2) ** 3 - 1.0), rtol=1e-12)
    assert made.range == pytest.approx((-LIFT, 0.0), abs=1e-12)


def test_several_rises_and_returns_stand_on_each_other() -> None:
    made = program(
        [
            rise("cycloidal", 60.0, 5.0),
            rise("3-4-5", 60.0, 7.0),
            back("cycloidal", 60.0, 3.0),
            back("harmonic", 60.0),
            dwell(120.0),
        ]
    )
    at = np.radians([30.0, 60.0, 90.0, 120.0, 150.0, 180.0, 210.0, 240.0, 300.0])
    lifts = [2.5, 5.0, 8.5, 12.0, 10.5, 9.0, 4.5, 0.0, 0.0]
    assert made.derivatives(at, 0)[0] == pytest.approx(lifts, abs=1e-12)


# --- segments -------------------------------------------------------------------------------------

JOINED: list[Phase] = [
    rise("constant-velocity", 60.0, 4.0),
    segment(50.0, 9.0, 2.0, -3.0),
    segment(70.0, 5.0, -6.0, 1.5),
    back("constant-velocity", 30.0, 1.0),
    segment(90.0, -1.0, 0.5, 0.25),
    segment(60.0, 0.0, 4.0 / math.radians(60.0), 0.0),
]


def test_segments_join_without_jumps() -> None:
    """They begin with the state of the phase before, and end with the state that is given."""
    made = program(JOINED)
    steady = (4.0, 4.0 / math.radians(60.0), 0.0)
    falling = (4.0, -1.0 / math.radians(30.0), 0.0)
    ends = np.cumsum([math.degrees(float(phase.angle)) for phase in JOINED])
    states = [steady, (9.0, 2.0, -3.0), (5.0, -6.0, 1.5), falling, (-1.0, 0.5, 0.25)]
    states.append((0.0, 4.0 / math.radians(60.0), 0.0))
    for degrees, exact in zip(ends, states, strict=True):
        at = math.radians(degrees)
        np.testing.assert_allclose(state(made, at, -1)[:3], exact, rtol=0.0, atol=1e-11)
        if degrees != 180.0:  # there a law begins, which is as it is
            np.testing.assert_allclose(state(made, at, 1)[:3], exact, rtol=0.0, atol=1e-11)
    lowest = {round(math.degrees(jump.theta), 6): jump.order for jump in made.jumps}
    assert lowest == {0.0: 3, 60.0: 3, 110.0: 3, 180.0: 1, 210.0: 3, 300.0: 3}
    assert made.continuity == 0


def test_segments_are_the_quintics_of_their_ends() -> None:
    """The six conditions solved in high precision, compared inside."""
    made = program(JOINED)
    with mp.workdps(30):
        for number, (before, after) in {
            1: ((4, mp.mpf(4) / mp.radians(60), 0), (9, 2, -3)),
            2: ((9, 2, -3), (5, -6, mp.mpf("1.5"))),
            5: ((-1, mp.mpf("0.5"), mp.mpf("0.25")), (0, mp.mpf(4) / mp.radians(60), 0)),
        }.items():
            stretch = made.stretches[number]
            width = mp.mpf(stretch.end) - mp.mpf(stretch.start)
            powers = hermite(before, after, width)
            for part in (0.125, 0.5, 0.8125):
                x = part * width
                exact = [
                    sum(
                        c * mp.ff(k, order) * x ** (k - order)
                        for k, c in enumerate(powers)
                        if k >= order
                    )
                    for order in range(4)
                ]
                found = made.derivatives(stretch.start + part * float(width), 3)
                for value, of in zip(found, exact, strict=True):
                    assert float(value) == pytest.approx(float(of), rel=1e-12, abs=1e-12)


def hermite(before: Sequence[Any], after: Sequence[Any], width: Any) -> Any:
    """Coefficients of the polynomial of degree 5 with s, s', s'' at 0 and at the width."""
    matrix, right = mp.zeros(6), mp.zeros(6, 1)
    for order in range(3):
        matrix[order, order] = mp.factorial(order)
        right[order] = before[order]
        right[3 + order] = after[order]
        for k in range(order, 6):
            matrix[3 + order, k] = mp.ff(k, order) * width ** (k - order)
    return mp.lu_solve(matrix, right)


@pytest.mark.parametrize(
    ("first", "speed", "acceleration"),
    [
        (dwell(60.0), 0.0, 0.0),
        (rise("harmonic", 60.0, 3.0), 0.0, -0.5 * math.pi**2 * 3.0),
        (rise("constant-velocity", 60.0, 3.0), 3.0, 0.0),
        (rise("constant-acceleration", 60.0, 3.0), 0.0, -4.0 * 3.0),
        (rise("3-4-5-6", 60.0, 3.0), 0.0, -6.0 * 3.0),
    ],
)
def test_a_segment_begins_as_any_law_ends(first: Phase, speed: float, acceleration: float) -> None:
    b = math.radians(60.0)
    made = program([first, segment(200.0, 1.0), segment(100.0, 0.0)])
    begins = state(made, b, 1)
    assert begins[1] == pytest.approx(speed / b, abs=1e-12)
    assert begins[2] == pytest.approx(acceleration / b**2, abs=1e-11)
    assert min((j.order for j in made.jumps if abs(j.theta - b) < 1e-9), default=4) >= 3


def test_a_segment_begins_as_a_return_ends() -> None:
    """A return that runs the mirrored law backwards ends as the law begins."""
    b = math.radians(60.0)
    for name, acceleration in (("harmonic", 0.5 * math.pi**2), ("3-4-5-6", 0.0)):
        made = program([rise(name, 60.0, 3.0), back(name, 60.0, 2.0), segment(240.0, 0.0)])
        assert state(made, 2 * b, 1)[:3] == pytest.approx(
            [1.0, 0.0, 2.0 * acceleration / b**2], abs=1e-11
        )


@dataclass(frozen=True)
class Lopsided(ClosedForm):
    """A mirrored law that starts with speed 1/2 and acceleration 1, and ends with 3/2 and 1."""

    mirrored = True

    def function(self) -> Piecewise:
        return piecewise([0.0, 1.0], [Piece(lambda x: 0.5 * (x + x * x))])


def test_a_segment_goes_on_from_a_return_that_runs_backwards() -> None:
    """``S(1 - phi)`` ends with minus the starting speed and the starting acceleration."""
    b, law_given = math.radians(60.0), Lopsided()
    up = RisePhase(angle=b, law=law_given, lift=3.0)
    down = ReturnPhase(angle=b, law=law_given, lift=2.0)
    made = program([up, down, segment(240.0, 0.0)])
    assert state(made, b, -1)[:3] == pytest.approx([3.0, 4.5 / b, 3.0 / b**2], rel=1e-12)
    assert state(made, b, 1)[:3] == pytest.approx([3.0, -3.0 / b, 2.0 / b**2], rel=1e-12)
    assert state(made, 2 * b, 1)[:3] == pytest.approx([1.0, -1.0 / b, 2.0 / b**2], rel=1e-12)


def test_the_first_segment_begins_as_the_last_phase_ends() -> None:
    made = program([segment(100.0, 6.0), back("constant-velocity", 160.0), dwell(100.0)])
    assert state(made, 0.0, 1)[:3] == pytest.approx([0.0, 0.0, 0.0], abs=1e-13)
    made = program([segment(100.0, 6.0), back("constant-velocity", 260.0)])
    fall = -6.0 / math.radians(260.0)
    assert state(made, 0.0, 1)[:3] == pytest.approx([0.0, fall, 0.0], abs=1e-13)
    assert [(j.theta, j.order) for j in made.jumps if j.theta == 0.0] == [(0.0, 3)]


def test_segments_count_as_rises_or_returns() -> None:
    kinds = [stretch.kind for stretch in program(JOINED).stretches]
    assert kinds == ["rise", "rise", "return", "return", "return", "rise"]


# --- jumps ----------------------------------------------------------------------------------------

JUMPS = {
    "constant-velocity": (1, 1.0, 1.0),
    "constant-acceleration": (2, 4.0, -4.0),
    "harmonic": (2, 0.5 * math.pi**2, -0.5 * math.pi**2),
    "2-3": (2, 6.0, -6.0),
    "cycloidal": (3, 4 * math.pi**2, 4 * math.pi**2),
    "3-4-5": (3, 60.0, 60.0),
}
"""Order, and the derivative at the beginning and at the end of the law."""


@pytest.mark.parametrize("name", JUMPS)
def test_jumps_are_named_at_their_knots(name: str) -> None:
    """Beside dwells the laws' own end values, the end of the turn included, as theta = 0."""
    order, first, last = JUMPS[name]
    made = there_and_back(name, LIFT, DEGREES[:3] + DEGREES[3:])
    up, down = LIFT / UP**order, -LIFT / DOWN**order
    exact = [
        (0.0, 0.0, first * up),
        (UP, last * up, 0.0),
        (UP + TOP, 0.0, first * down),
        (UP + TOP + DOWN, last * down, 0.0),
    ]
    found = [jump for jump in made.jumps if jump.theta not in inner(name)]
    assert [jump.order for jump in found] == [order] * 4
    for jump, (theta, before, after) in zip(found, exact, strict=True):
        assert jump.theta == pytest.approx(theta, abs=1e-14)
        assert (jump.before, jump.after) == pytest.approx((before, after), rel=1e-9, abs=1e-9)
    assert made.continuity == order - 1


def inner(name: str) -> set[float]:
    """Knots inside the phases."""
    if name != "constant-acceleration":
        return set()
    made = there_and_back(name, LIFT, DEGREES)
    ends = {stretch.end for stretch in made.stretches} | {0.0}
    inside = {float(knot) for knot in made.knots} - ends
    assert len(inside) == 2
    for jump in (jump for jump in made.jumps if jump.theta in inside):
        assert jump.order == 2
        assert jump.before == pytest.approx(-jump.after, rel=1e-12)
    return inside


def test_no_jumps_without_dwells_of_a_harmonic_motion() -> None:
    assert program([rise("harmonic", 180.0, LIFT), back("harmonic", 180.0)]).jumps == ()
    made = program([rise("harmonic", 150.0, LIFT), back("harmonic", 210.0)])
    assert [(jump.theta, jump.order) for jump in made.jumps] == [
        (0.0, 2),
        (pytest.approx(math.radians(150.0)), 2),
    ]
    top, bottom = made.jumps[1], made.jumps[0]
    short, long = ((0.5 * math.pi**2) * LIFT / math.radians(b) ** 2 for b in (150.0, 210.0))
    assert (top.before, top.after) == pytest.approx((-short, -long), rel=1e-12)
    assert (bottom.before, bottom.after) == pytest.approx((long, short), rel=1e-12)


def test_a_smooth_law_has_no_jumps() -> None:
    made = there_and_back("4-5-6-7", LIFT, DEGREES)
    assert made.jumps == ()
    assert made.continuity == 3


def test_every_phase_of_files_is_tried() -> None:
    assert set(PHASES) == {"rise", "dwell", "return", "segment"}
