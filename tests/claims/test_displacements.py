"""Whatever moves keeps what a displacement promises, be it a ratio law or a lift program."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, partial
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from claims.laws import LAW_CLAIMS
from claims.motion import MOTION_CLAIMS
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.displacement import Displacement
from gearcam.laws.motion.base import MotionLawParameters
from gearcam.laws.motion_formula import MotionFormula
from gearcam.laws.motion_table import MotionTable
from gearcam.laws.phases_of_lift import DwellPhase, Phase, ReturnPhase, RisePhase, SegmentPhase
from gearcam.laws.program import make_program

Array = NDArray[np.float64]
TURN = 2.0 * math.pi


def program(law: MotionLawParameters) -> Displacement:
    """A rise, a return by a segment to half way and by the law, and a dwell."""
    phases: list[Phase] = [
        RisePhase(angle=1.5, law=law, lift=8.0),
        SegmentPhase(angle=1.0, to=4.0),
        ReturnPhase(angle=1.2, law=law, lift=4.0),
        DwellPhase(angle=TURN - 3.7),
    ]
    return make_program(phases, DEFAULT)


def rows(tolerance: float | None = None) -> Displacement:
    """A motion by rows that begin beside the turn's end, uneven and noisy, as measured."""
    theta = TURN * (np.arange(90) + 0.3 + 0.2 * np.sin(np.arange(90))) / 90
    lift = 4.0 * (1.0 - np.cos(theta)) ** 2 + 0.002 * np.sin(1e3 * np.arange(90))
    return MotionTable(theta=theta, lift=lift, smoothing_tolerance=tolerance).program(DEFAULT)


MOVING: dict[str, Callable[[], Displacement]] = {
    "rows": rows,
    "rows, smoothed": lambda: rows(0.01),
    "formula": lambda: MotionFormula(lift="4*(1 - cos(theta))**2").program(DEFAULT),
    **{
        f"law {name}-{number}": partial(claim.parameters.build, claim.lobes, DEFAULT)
        for name, claims in LAW_CLAIMS.items()
        for number, claim in enumerate(claims.values)
    },
    **{
        f"program {name}-{number}": partial(program, claim.parameters)
        for name, claims in MOTION_CLAIMS.items()
        for number, claim in enumerate(claims.values)
    },
}


@cache
def made(name: str) -> Displacement:
    return MOVING[name]()


@pytest.fixture(params=MOVING)
def moving(request: pytest.FixtureRequest) -> Displacement:
    return made(request.param)


def inside(moving: Displacement, shares: Array) -> Array:
    """Places between every two knots."""
    return np.array([low + (high - low) * shares for low, high in pairwise(moving.knots)])


def largest(moving: Displacement, order: int) -> Array:
    """Largest derivatives, each 1 at least."""
    places = inside(moving, np.linspace(1e-6, 1.0 - 1e-6, 101)).ravel()
    return np.fmax(1.0, np.abs(moving.derivatives(places, order)).max(axis=1))


def test_each_derivative_is_the_slope_of_the_one_below(moving: Displacement) -> None:
    """Orders 1 to 4 against differences of the fourth order, and the shape is kept."""
    for low, high in pairwise(moving.knots):
        x = low + (high - low) * np.array([[0.13, 0.37], [0.52, 0.81]])
        exact = moving.derivatives(x, 4)
        assert [values.shape for values in exact] == [x.shape] * 5
        h = 2e-4 * (high - low)
        near = [moving.derivatives(x + k * h, 3) for k in (-2, -1, 1, 2)]
        for order in range(1, 5):
            two, one, ahead, far = (values[order - 1] for values in near)
            slope = (two - 8 * one + 8 * ahead - far) / (12 * h)
            size = float(np.abs(exact[order]).max()) + float(np.abs(exact[order - 1]).max()) / h
            np.testing.assert_allclose(exact[order], slope, rtol=2e-8, atol=1e-10 * max(1.0, size))


def test_the_period_or_the_travel_closes(moving: Displacement) -> None:
    assert moving.knots[0] == 0.0
    assert moving.knots[-1] == pytest.approx(moving.period, rel=1e-15)
    assert (np.diff(moving.knots) > 0.0).all()
    before = np.nextafter(moving.period, 0.0)
    start, end = moving.derivatives([0.0, before], 0)[0]
    assert end - start == pytest.approx(moving.advance, abs=1e-12)
    x = inside(moving, np.array([0.07, 0.61])).ravel()
    once = moving.derivatives(x, 3)
    for periods in (-2, 3) if moving.closed else ():
        there = moving.derivatives(x + periods * moving.period, 3)
        there[0] = there[0] - periods * moving.advance
        for found, expected, size in zip(there, once, largest(moving, 4)[1:], strict=True):
            np.testing.assert_allclose(found, expected, atol=1e-13 * size * moving.period * 30)


def test_derivatives_jump_at_the_knots_that_are_told_and_there_only(moving: Displacement) -> None:
    """Both sides of every knot, a little away from it; the ends of a closed one are one knot."""
    told = {jump.theta: jump for jump in moving.jumps}
    assert set(told) <= set(moving.knots[:-1].tolist())
    sizes = largest(moving, 5)
    h = 1e-9 * float(np.diff(moving.knots).min())
    h = max(h, 1e-13)
    for knot in moving.knots[0 if moving.closed else 1 : -1].tolist():
        before, after = np.transpose(moving.derivatives([knot - h, knot + h], 4))
        slack = 4.0 * h * sizes[1:] + 1e-9 * sizes[:-1]
        jump = told.get(knot)
        order = 4 if jump is None else jump.order
        assert (np.abs(after - before)[:order] <= slack[:order]).all()
        if jump is not None:
            assert abs(after - before)[order] > slack[order]
            assert before[order] == pytest.approx(jump.before, abs=slack[order])
            assert after[order] == pytest.approx(jump.after, abs=slack[order])


def test_there_are_both_kinds_open_and_closed_with_and_without_jumps() -> None:
    kinds = {(type(one).__name__, one.closed, bool(one.jumps)) for one in map(made, MOVING)}
    assert kinds == {
        ("RatioLaw", True, True),
        ("RatioLaw", True, False),
        ("RatioLaw", False, True),
        ("RatioLaw", False, False),
        ("Program", True, True),
        ("Program", True, False),
    }
