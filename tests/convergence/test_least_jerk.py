"""Curves of least jerk: they converge, nothing has less jerk, and smoothing keeps waves as told."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from gearcam.numeric.hermite import hermite_quintics
from gearcam.numeric.least_jerk import chain_slopes, coefficients, ring_slopes, smoothed_ring

Array = NDArray[np.float64]
TURN = 2.0 * math.pi
FINE = np.linspace(0.0, TURN, 5000, endpoint=False)
GAUSS = np.polynomial.legendre.leggauss(4)


def places(count: int, uneven: float) -> Array:
    even = TURN * np.arange(count) / count
    return even + 0.1 + uneven * np.sin(even) + 0.2 * uneven * np.sin(5 * even)


def wave(x: Array, order: int = 0) -> Array:
    """A motion without end: exp(sin(x)) and two harmonics, and derivatives by the chain rule."""
    sin, cos = np.sin(x), np.cos(x)
    first = [np.exp(sin), cos * np.exp(sin), (cos**2 - sin) * np.exp(sin),
             (cos**3 - 3 * sin * cos - cos) * np.exp(sin)][order]  # fmt: skip
    return first + 0.2 * 3**order * np.cos(3 * x + order * math.pi / 2)


def ring(x: Array, y: Array) -> tuple[Array, Array, Array]:
    """Knots, and coefficients from the left and from the right."""
    slopes = ring_slopes(x, y, TURN)
    knots, slopes = np.append(x, x[0] + TURN), np.concatenate([slopes, slopes[:1]])
    return knots, *coefficients(knots, np.append(y, y[0]), slopes, ring=True)


def on_ring(x: Array, y: Array, at: Array, order: int) -> Array:
    knots, left, _ = ring(x, y)
    at = x[0] + (at - x[0]) % TURN
    index = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, len(x) - 1)
    return derivative(left[index], at - knots[index], order)


def derivative(powers: Array, distance: Array, order: int) -> Array:
    for _ in range(order):
        powers = powers[:, 1:] * np.arange(1, powers.shape[1])
    return (powers * distance[:, None] ** np.arange(powers.shape[1])).sum(axis=1)


def squared_jerk(knots: Array, left: Array) -> float:
    """By Gauss' quadrature, exact for the square of a quadratic."""
    nodes, weights = GAUSS
    total = 0.0
    for node, weight in zip(nodes, weights, strict=True):
        distance = 0.5 * (node + 1.0) * np.diff(knots)
        total += float((0.5 * weight * np.diff(knots) * derivative(left, distance, 3) ** 2).sum())
    return total


@pytest.mark.parametrize("uneven", [0.0, 0.4])
@pytest.mark.parametrize(("order", "power"), [(0, 6.0), (1, 5.0), (2, 4.0), (3, 3.0)])
def test_errors_of_a_ring_fall_with_the_power_of_the_step(
    order: int, power: float, uneven: float
) -> None:
    counts = (40, 80, 160, 320)
    errors = []
    for count in counts:
        x = places(count, uneven)
        errors.append(np.abs(on_ring(x, wave(x), FINE, order) - wave(FINE, order)).max())
    slope = -np.polyfit(np.log(counts[1:]), np.log(errors[1:]), 1)[0]
    assert slope == pytest.approx(power, abs=0.15)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 6, 7, 9, 16, 33])
def test_a_ring_passes_through_its_points_and_goes_on_four_times(count: int) -> None:
    x = places(count, 0.3) if count > 1 else np.array([0.5])
    y = np.random.default_rng(count).normal(size=count)
    knots, left, right = ring(x, y)
    h = np.diff(knots)
    scale = np.abs(left).max(axis=0)
    for order in range(5):
        fact = math.factorial(order)
        ends = derivative(left, h, order)
        starts = np.roll(derivative(left, 0.0 * h, order), -1)
        bound = 1e-9 * fact * max(scale[order], 1.0)
        np.testing.assert_allclose(ends, starts, atol=bound)
        np.testing.assert_allclose(right[:, order] * fact, ends, atol=bound)
    np.testing.assert_array_equal(left[:, 0], y)
    np.testing.assert_array_equal(left[:, 3], np.roll(right[:, 3], 1))


@pytest.mark.parametrize("count", [3, 4, 8, 21])
def test_no_other_curve_through_the_points_has_less_jerk(count: int) -> None:
    """Slopes and bends moved either way: more jerk, by the same amount."""
    rng = np.random.default_rng(count)
    x, y = places(count, 0.3), rng.normal(size=count)
    knots, values = np.append(x, x[0] + TURN), np.append(y, y[0])
    best = ring_slopes(x, y, TURN)

    def jerk(slopes: Array) -> float:
        slopes = np.concatenate([slopes, slopes[:1]])
        return squared_jerk(knots, hermite_quintics(knots, values, *slopes.T))

    least = jerk(best)
    for _ in range(5):
        way = rng.normal(size=best.shape) * np.abs(best).max(axis=0)
        more, other = jerk(best + 1e-3 * way) - least, jerk(best - 1e-3 * way) - least
        assert more > 0.0
        assert more == pytest.approx(other, rel=1e-6)


def test_a_chain_of_the_same_points_is_the_ring() -> None:
    """Cut at a point, with the slopes that the ring has there, it is the same curve."""
    x = places(23, 0.3)
    y = wave(x)
    found = ring_slopes(x, y, TURN)
    start = (float(found[0, 0]), float(found[0, 1]))
    chain = chain_slopes(np.append(x, x[0] + TURN), np.append(y, y[0]), start, start)
    np.testing.assert_allclose(chain[:-1], found, atol=1e-10)


def kept(number: int, count: int, cutoff: float) -> float:
    """Part of a wave that smoothing keeps on an even grid, with what it is mistaken for there."""
    beyond = sum((number / abs(number + m * count)) ** 6 for m in range(-2000, 2001))
    return 1.0 / (1.0 + (number / cutoff) ** 6 / beyond)


@pytest.mark.parametrize("count", [24, 25, 360])
@pytest.mark.parametrize(("number", "cutoff"), [(1, 2.0), (3, 3.0), (5, 9.0), (11, 8.0)])
def test_smoothing_keeps_waves_by_their_number(count: int, number: int, cutoff: float) -> None:
    x = TURN * np.arange(count) / count
    found = smoothed_ring(x, 7.0 + np.cos(number * x), TURN, cutoff)
    expected = 7.0 + kept(number, count, cutoff) * np.cos(number * x)
    rounding = 1e-17 * (count / cutoff) ** 6
    np.testing.assert_allclose(found, expected, atol=max(rounding, 1e-12))
    assert np.abs(found - 7.0 - np.cos(number * x)).max() > 1e-3


def test_smoothing_has_the_least_sum_of_jerk_and_distances() -> None:
    """Uneven points, noise: values moved in any way raise the sum by a square of the step."""
    rng = np.random.default_rng(5)
    x = places(60, 0.3)
    y = wave(x) + rng.normal(scale=0.01, size=x.size)
    cutoff = 9.0
    best = smoothed_ring(x, y, TURN, cutoff)

    def total(values: Array) -> float:
        knots, left, _ = ring(x, values)
        weight = cutoff**6 * TURN / len(x)
        return squared_jerk(knots, left) + weight * float(((values - y) ** 2).sum())

    least = total(best)
    for _ in range(5):
        way = np.cos(rng.integers(1, 12) * x + rng.uniform(0.0, 6.0))
        more, other = total(best + 1e-3 * way) - least, total(best - 1e-3 * way) - least
        assert more > 0.0
        assert more == pytest.approx(other, rel=1e-4)
