"""Splines through points of a rise come nearer with the sixth power of the step."""

from __future__ import annotations

import math

import numpy as np
import pytest

from claims.shown_rise import ShownRise, shown
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.motion.points import TableRise
from gearcam.laws.motion.simple import Cycloidal

COUNTS = (8, 16, 32, 64)
FINE = np.linspace(0.0, 1.0, 4001)
EXACT = Cycloidal().build(DEFAULT).function.derivatives(FINE, 3)


def through(count: int, *, uneven: float = 0.0) -> ShownRise:
    even = np.linspace(0.0, 1.0, count + 1)
    x = even + uneven * np.sin(math.pi * even) / math.pi
    x[-1] = 1.0
    y = Cycloidal().build(DEFAULT).function(x)
    return shown(TableRise(x=tuple(x.tolist()), y=tuple(y.tolist())))


@pytest.mark.parametrize("uneven", [0.0, 0.3])
@pytest.mark.parametrize(("order", "power"), [(0, 6.0), (1, 5.0), (2, 4.0), (3, 3.0)])
def test_errors_fall_with_the_power_of_the_step(order: int, power: float, uneven: float) -> None:
    errors = [
        np.abs(through(n, uneven=uneven).function.derivatives(FINE, 3)[order] - EXACT[order]).max()
        for n in COUNTS
    ]
    slope = -np.polyfit(np.log(COUNTS[1:]), np.log(errors[1:]), 1)[0]
    assert slope == pytest.approx(power, abs=0.15)


def test_many_points_are_no_worse_than_their_digits() -> None:
    """The points' rounding of 1e-16 is a jerk of 1e-16/h^3: still continuous, and right to 1e-6."""
    rise = through(600)
    assert rise.continuity == 2
    assert min(rise.function.continuity[:-1]) == 3
    assert np.abs(rise.function(FINE) - EXACT[0]).max() < 1e-14
    assert rise.peak_jerk == pytest.approx(4 * math.pi**2, rel=1e-6)
