"""Gauss' rule over cells: exact for polynomials of its degree; integrals against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from gearcam.numeric.gauss import gauss_cells, integral


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
