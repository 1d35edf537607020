"""Gauss' rule over cells."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from gearcam.numeric.arrays import Array


def gauss_cells(low: Array, high: Array, count: int) -> tuple[Array, Array]:
    """Return places and weights of Gauss' rule in cells.

    Parameters
    ----------
    low, high : (n,) arrays
        Their ends.
    count : int
        Places in each: exact for polynomials of degree ``2*count - 1``.

    Returns
    -------
    places, weights : (n, count) arrays
    """
    nodes, weights = _rule(count)
    half = 0.5 * (high - low)[:, None]
    return low[:, None] + half * (1.0 + nodes), half * weights


@lru_cache
def _rule(count: int) -> tuple[Array, Array]:
    return np.polynomial.legendre.leggauss(count)
