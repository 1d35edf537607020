"""Gauss' rule over cells: exact for polynomials of its degree; integrals against closed forms."""

from __future__ import annotations

from fractions import Fraction

import mpmath
import numpy as np
import pytest

from gearcam.numeric.gauss import gauss_cells, integral, legendre_rule

COUNTS = [1, 2, 3, 4, 7, 10, 16, 24, 33, 64]


@pytest.mark.parametrize("count", COUNTS)
def test_the_rule_is_that_of_numpy(count: int) -> None:
    places, weights = legendre_rule(count)
    own_places, own_weights = np.polynomial.legendre.leggauss(count)
    np.testing.assert_allclose(places, own_places, rtol=0.0, atol=2e-16)
    np.testing.assert_allclose(weights, own_weights, rtol=3e-12)  # those of numpy are off by 1e-12


@pytest.mark.parametrize("count", COUNTS)
def test_places_are_zeros_and_weights_those_of_the_formula(count: int) -> None:
    with mpmath.workdps(40):
        for place, weight in zip(*legendre_rule(count), strict=True):
            x, (p, before) = (
                mpmath.mpf(place),
                (mpmath.legendre(n, place) for n in (count, count - 1)),
            )
            slope = count * (before - x * p) / (1 - x**2)
            root = x - p / slope
            assert abs(root - x) < 2e-16
            # of the polynomial before at the zero itself; x^2 is 1 to a few digits near the ends
            wanted = 2 * (1 - root**2) / (count * mpmath.legendre(count - 1, root)) ** 2
            assert abs(weight / wanted - 1) < 2e-13


@pytest.mark.parametrize("count", COUNTS)
def test_monomials_are_exact(count: int) -> None:
    """Sums of fractions: what is left is the rounding of places and weights."""
    places, weights = (list(map(Fraction, one.tolist())) for one in legendre_rule(count))

    def found(degree: int) -> Fraction:
        return sum((w * x**degree for x, w in zip(places, weights, strict=True)), Fraction(0))

    for degree in range(0, 2 * count, max(1, count // 4)):
        wanted = Fraction(2, degree + 1) if degree % 2 == 0 else 0
        assert abs(found(degree) - wanted) < 1e-15
    assert found(2 * count - 1) == 0  # by symmetry
    # the error of the next degree, Abramowitz & Stegun 25.4.29
    error = mpmath.mpf(2) ** (2 * count + 1) * mpmath.factorial(count) ** 4
    error /= (2 * count + 1) * mpmath.factorial(2 * count) ** 2
    off = Fraction(2, 2 * count + 1) - found(2 * count)
    assert float(off) == pytest.approx(float(error), abs=1e-15)


@pytest.mark.parametrize("count", [1, 2, 5, 9])
def test_it_is_exact_up_to_its_degree(count: int) -> None:
    edges = np.array([-1.0, 0.3, 1.1])
    places, weights = gauss_cells(edges[:-1], edges[1:], count)
    for degree in (2 * count - 1, 2 * count):
        wanted = np.diff(edges ** (degree + 1)) / (degree + 1)
        error = np.abs((places**degree * weights).sum(axis=1) - wanted).max()
        assert (error < 1e-14) == (degree < 2 * count)


def test_integrals_are_halved_until_they_agree() -> None:
    edges = np.array([0.0, 0.5, 3.0])
    found = integral(lambda x: 1.0 / (1e-4 + x * x), edges, 0.0)  # a narrow peak
    assert found.value == pytest.approx(100.0 * np.arctan(300.0), rel=1e-14)
    assert 0.0 <= found.error < 1e-10
    root = integral(np.sqrt, edges, 0.0)
    assert root.value == pytest.approx(2.0 * np.sqrt(3.0), rel=1e-13)


def test_an_integral_that_does_not_settle_tells_its_error() -> None:
    found = integral(lambda x: np.where(x < 1.0 / 3.0, 0.0, 1.0), np.array([0.0, 1.0]), 0.0)
    assert found.value == pytest.approx(2.0 / 3.0, abs=1e-11)
    rough = integral(lambda x: np.sin(1e9 * x), np.array([0.0, 1.0]), 0.2)
    assert rough.error > 1e-3
