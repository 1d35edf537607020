"""Hermite's cubics and quintics give back the polynomials that they were taken from."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from gearcam.numeric.hermite import hermite_arms, hermite_cubic, hermite_quintics, on_cubics


def test_a_cubic_is_given_back_with_its_slope() -> None:
    exact = Polynomial([0.0, 0.7, -2.0, 1.3])
    slope = exact.deriv()
    share = np.linspace(0.0, 1.0, 11)
    ends = (np.full(11, exact(1.0)), np.full(11, slope(0.0)), np.full(11, slope(1.0)))
    way, found = hermite_cubic(*ends, share)
    np.testing.assert_allclose(way, exact(share), atol=1e-15)
    np.testing.assert_allclose(found, slope(share), atol=1e-15)


def test_quintics_are_given_back_power_by_power() -> None:
    """Uneven intervals, none of length 1, so that no power of the length can be left out."""
    exact = Polynomial([0.3, -1.1, 0.8, 2.0, -0.6, 0.9])
    x = np.array([-0.7, 0.1, 0.5, 2.2])
    found = hermite_quintics(x, exact(x), exact.deriv()(x), exact.deriv(2)(x))
    assert found.shape == (3, 6)
    for start, row in zip(x[:-1], found, strict=True):
        moved: Any = exact(Polynomial([start, 1.0]))
        np.testing.assert_allclose(row, moved.coef, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("turn", [0.2, -0.2])
def test_the_arms_of_an_arc_are_its_length_and_its_cubic_misses_it_by_h_to_the_fourth(
    turn: float,
) -> None:
    """On a circle of radius 5 about 2 + i, in either sense: ``r*(h^4*(...))`` falls 16 times."""
    worst = []
    for count in (8, 16):
        angle = np.linspace(0.3, 0.3 + 8.0 * turn, count + 1)
        away = np.exp(1j * angle).astype(np.complex128)
        points = np.asarray(2.0 + 1j + 5.0 * away, dtype=np.complex128)
        tangents = np.asarray(np.sign(turn) * 1j * away, dtype=np.complex128)
        length = 5.0 * np.abs(np.diff(angle))
        np.testing.assert_allclose(hermite_arms(points, tangents), length, rtol=1e-12)
        step = np.repeat(np.arange(count), 9)
        share = np.tile(np.linspace(0.1, 0.9, 9), count)
        found, along = on_cubics(points, tangents, step, share)
        away = (found - 2.0 - 1j) / 5.0
        worst.append(np.abs(np.abs(away) - 1.0).max())
        np.testing.assert_allclose(np.abs(along), 1.0, rtol=1e-14)
        across = np.sign(turn) * (np.conj(1j * away) * along).imag
        assert np.abs(across).max() < 1e-4
        # evenly along the arc, from the point before
        even = angle[step] + share * turn * 8 / count
        np.testing.assert_allclose(np.exp(1j * even), away, atol=2e-5)
    assert worst[0] / worst[1] == pytest.approx(16.0, rel=0.1)
