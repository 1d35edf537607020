"""Curves through points: they pass through, join with two derivatives, keep shape, and converge."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from gearcam.numeric.shape_keeping import quintics

Array = NDArray[np.float64]


def values(x: Array, powers: Array, at: Array, order: int = 0) -> Array:
    """The curve, or a derivative, at places."""
    k = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(powers) - 1)
    rows = powers
    for _ in range(order):
        rows = rows[:, 1:] * np.arange(1, rows.shape[1])
    return sum(rows[k, n] * (at - x[k]) ** n for n in range(rows.shape[1]))  # type: ignore[return-value]


@pytest.mark.parametrize("rise", [None, 0.0])
def test_it_passes_through_the_points_with_two_derivatives(rise: float | None) -> None:
    x = np.append(np.sort(np.random.default_rng(3).uniform(0.0, 6.0, 20)), 6.3)
    x[0] = 0.0
    y = np.sin(x) * 0.3
    y[-1] = y[0] if rise is not None else y[-1]
    powers = quintics(x, y, rise)
    h = np.diff(x)
    n = np.arange(6)
    ends = np.sum(powers * h[:, None] ** n, axis=1)
    slopes = np.sum((n * powers)[:, 1:] * h[:, None] ** (n[1:] - 1), axis=1)
    bends = np.sum((n * (n - 1) * powers)[:, 2:] * h[:, None] ** (n[2:] - 2), axis=1)
    np.testing.assert_allclose(ends, y[1:], atol=1e-13)
    np.testing.assert_allclose(slopes[:-1], powers[1:, 1], atol=1e-12)
    np.testing.assert_allclose(bends[:-1], 2 * powers[1:, 2], atol=1e-9)
    if rise is not None:
        assert slopes[-1] == pytest.approx(powers[0, 1], abs=1e-12)
        assert bends[-1] == pytest.approx(2 * powers[0, 2], abs=1e-9)


@settings(max_examples=60, derandomize=True, database=None, deadline=None)
@given(st.lists(st.floats(0.01, 10.0), min_size=6, max_size=20), st.data())
def test_it_rises_where_the_points_rise(steps: list[float], data: st.DataObject) -> None:
    widths = data.draw(st.lists(st.floats(0.1, 3.0), min_size=len(steps), max_size=len(steps)))
    x = np.concatenate([[0.0], np.cumsum(widths)])
    y = np.concatenate([[0.0], np.cumsum(steps)])
    for rise in (None, float(y[-1])):
        powers = quintics(x, y, rise)
        slope = values(x, powers, np.linspace(0.0, x[-1], 2001), 1)
        assert slope.min() >= -1e-9 * float((np.diff(y) / np.diff(x)).max())


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 6.4e-6])
@pytest.mark.parametrize("step", [1e-3, 0.1])
def test_two_points_close_to_each_other_do_not_throw_the_curve_off(gap: float, step: float) -> None:
    """Beside an extreme a curvature that suits the narrow interval is none for its neighbours."""
    x = np.linspace(0.0, 2.0 * math.pi, 37)
    y = 1.0 + 0.2 * np.cos(x)
    x, y = np.insert(x, 6, x[5] + gap), np.insert(y, 6, y[5] + step)
    found = values(x, quintics(x, y, 0.0), np.linspace(0.0, x[-1], 20001))
    assert found.min() >= y.min() - 0.5 * step
    assert found.max() <= y.max() + 0.5 * step


def test_points_at_a_step_do_not_overshoot() -> None:
    x = np.arange(12.0)
    y = np.array([0.0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1])
    curve = values(x, quintics(x, y, None), np.linspace(0.0, 11.0, 5001))
    assert curve.min() >= -1e-12
    assert curve.max() <= 1.0 + 1e-12


def test_it_converges_with_the_fifth_order() -> None:
    """phi + 0.3*sin(phi), rising throughout: slopes of quartics are off by the fourth power."""
    errors = []
    fine = np.linspace(0.0, 2 * math.pi, 20001)
    counts = (16, 32, 64, 128)
    for count in counts:
        x = np.linspace(0.0, 2 * math.pi, count + 1)
        powers = quintics(x, x + 0.3 * np.sin(x), 2 * math.pi)
        errors.append(np.abs(values(x, powers, fine, 0) - fine - 0.3 * np.sin(fine)).max())
    order = -np.polyfit(np.log(counts[1:]), np.log(errors[1:]), 1)[0]
    assert order == pytest.approx(5.0, abs=0.1)
