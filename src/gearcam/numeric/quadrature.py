"""What an integral misses, measured by a quadrature that knows nothing of how it was made."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array

_NODES: Final = 10
"""Gauss-Legendre nodes in half an interval: exact to degree 19, where expansions of degree 8 on
whole ones are at rounding, so that what is measured of coarser ones is their own."""


def missed(
    integral: Callable[[Array], Array], integrand: Callable[[Array], Array], knots: Array
) -> float:
    """Return how far an integral is from that of its integrand.

    Parameters
    ----------
    integral, integrand : callable
        Functions of arrays; the integral has any constant.
    knots : (n + 1,) array
        Ends of intervals, rising, in which the integrand is smooth and told by few nodes.

    Returns
    -------
    float
        The largest difference at the ends and in the middles of the intervals, where what an
        expansion leaves out is largest; the rounding of both is in it.
    """
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    grid = np.union1d(knots, 0.5 * (knots[:-1] + knots[1:]))
    half = 0.5 * np.diff(grid)
    x = 0.5 * (grid[:-1] + grid[1:]) + half * nodes[:, None]
    parts = half * (weights @ integrand(x.ravel()).reshape(x.shape))
    # part by part, since a sum of hundreds of them would be off by more than most integrals
    return float(np.abs(np.cumsum(np.diff(integral(grid)) - parts)).max())
