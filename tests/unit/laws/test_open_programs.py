"""Lift programs of arms, and of cams that slide: open, their phases parts of a way."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.phases_of_lift import ReturnPhase, RisePhase, SegmentPhase, program_problems
from gearcam.laws.program import make_program
from helpers_cams import there_and_back


def test_an_open_program_ends_where_its_way_does() -> None:
    """Its phases take parts of a way, it may end anywhere, and nothing joins its ends."""
    up = RisePhase(angle=30.0, law=MOTION_LAWS["constant-velocity"].parameters(), lift=6.0)
    down = ReturnPhase(angle=10.0, law=MOTION_LAWS["cycloidal"].parameters(), lift=2.0)
    made = make_program([up, down], DEFAULT, closed=False)
    assert not made.closed
    assert made.period == 40.0
    np.testing.assert_allclose(made.knots, [0.0, 30.0, 40.0])
    lift, velocity = made.derivatives(np.array([0.0, 30.0 - 1e-8, 40.0]), 1)
    np.testing.assert_allclose(lift, [0.0, 6.0, 4.0], atol=1e-8)
    assert velocity[0] == pytest.approx(0.2)
    (jump,) = made.hard
    assert jump.theta == pytest.approx(30.0)
    turn = 2.0 * math.pi
    with pytest.raises(InfeasibleError, match="ends at a lift"):
        make_program([replace(up, angle=0.75 * turn), replace(down, angle=0.25 * turn)], DEFAULT)
    told = list(program_problems([replace(up, angle="rest")], oscillating=False, closed=False))
    assert [one[:2] for one in told] == [(0, "angle")]


def test_every_way_that_is_wrong_is_told() -> None:
    angles = ("rest", 20.0, 1e-6, "rest", 1e-4)
    law = MOTION_LAWS["constant-velocity"].parameters()
    phases = [RisePhase(angle=angle, law=law, lift=1.0) for angle in angles]
    told = list(program_problems(phases, oscillating=False, closed=False))
    jump, rest = (
        "the phase is too short: it would be a jump",
        "a cam that slides has no whole turn, and so no rest of it",
    )
    assert [(number, words) for number, _, words, _ in told] == [(0, rest), (3, rest), (2, jump)]
    assert told[-1][-1] == "at least 2.00001e-05 mm of 20.0001 mm"


def test_an_open_program_begins_at_rest_before_a_segment() -> None:
    end = ReturnPhase(angle=1.0, law=MOTION_LAWS["constant-velocity"].parameters())
    made = make_program([SegmentPhase(angle=1.0, to=5.0), end], DEFAULT, closed=False)
    assert made.derivatives(np.array([0.0]), 2)[1][0] == pytest.approx(0.0, abs=1e-12)


def test_degrees_of_an_arm_become_radians() -> None:
    made = there_and_back("cycloidal", 20.0, (80.0, 70.0, 110.0, 100.0), swings=True)
    assert made.range[1] == pytest.approx(math.radians(20.0), rel=1e-14)
    assert made.peaks[0] == pytest.approx(2 * math.radians(20.0) / math.radians(80.0), rel=1e-12)
