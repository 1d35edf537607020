"""Gauss' rule over cells: exact for polynomials of its degree, and of no higher one."""

from __future__ import annotations

import numpy as np
import pytest

from gearcam.numeric.gauss import gauss_cells


@pytest.mark.parametrize("count", [1, 2, 5, 9])
def test_it_is_exact_up_to_its_degree(count: int) -> None:
    edges = np.array([-1.0, 0.3, 1.1])
    places, weights = gauss_cells(edges[:-1], edges[1:], count)
    for degree in (2 * count - 1, 2 * count):
        wanted = np.diff(edges ** (degree + 1)) / (degree + 1)
        error = np.abs((places**degree * weights).sum(axis=1) - wanted).max()
        assert (error < 1e-14) == (degree < 2 * count)
