"""Lift programs of cams that slide: open, over a way."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcam.errors import InfeasibleError
from gearcam.laws.phases_of_lift import ReturnPhase, RisePhase, SegmentPhase, program_problems
from gearcam.laws.program import make_program
from gearcam.laws.rises.base import RISES
from gearcam.tolerances import DEFAULT


def test_an_open_program_ends_where_its_way_does() -> None:
    """Its phases take parts of a way, it may end anywhere, and nothing joins its ends."""
    up = RisePhase(angle=30.0, law=RISES["constant-velocity"].parameters(), lift=6.0)
    down = ReturnPhase(angle=10.0, law=RISES["cycloidal"].parameters(), lift=2.0)
    made = make_program([up, down], DEFAULT, closed=False)
    turn = 2.0 * math.pi
    assert not made.closed
    np.testing.assert_allclose(made.knots, [0.0, 0.75 * turn, turn])
    lift, velocity = made.derivatives(np.array([0.0, 0.75 * turn - 1e-9, turn]), 1)
    np.testing.assert_allclose(lift, [0.0, 6.0, 4.0], atol=1e-8)
    assert velocity[0] == pytest.approx(6.0 / (0.75 * turn))
    (jump,) = made.hard
    assert jump.theta == pytest.approx(0.75 * turn)
    with pytest.raises(InfeasibleError, match="ends at a lift"):
        make_program([replace(up, angle=0.75 * turn), replace(down, angle=0.25 * turn)], DEFAULT)
    told = list(program_problems([replace(up, angle="rest")], oscillating=False, closed=False))
    assert [one[:2] for one in told] == [(0, "angle")]


def test_an_open_program_begins_at_rest_before_a_segment() -> None:
    end = ReturnPhase(angle=1.0, law=RISES["constant-velocity"].parameters())
    made = make_program([SegmentPhase(angle=1.0, to=5.0), end], DEFAULT, closed=False)
    assert made.derivatives(np.array([0.0]), 2)[1][0] == pytest.approx(0.0, abs=1e-12)
