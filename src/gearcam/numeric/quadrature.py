"""Error of an integral, measured by an independent quadrature."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array

_NODES: Final = 10
"""Gauss-Legendre nodes per half interval: exact to degree 19, where expansions of degree 8 on whole
intervals are at rounding, so that the error measured for coarser ones is their own."""


def missed(
    integral: Callable[[Array], Array], integrand: Callable[[Array], Array], knots: Array
) -> float:
    """Return the largest error of an integral function.

    Parameters
    ----------
    integral, integrand : callable
        Functions of arrays; the integral has any constant.
    knots : (n + 1,) array
        Ends of intervals, rising, in which the integrand is smooth and resolved by few nodes.

    Returns
    -------
    float
        The largest difference at the ends and in the middles of the intervals, where the truncation
        error of an expansion is largest; includes the rounding of both.
    """
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    grid = np.union1d(knots, 0.5 * (knots[:-1] + knots[1:]))
    half = 0.5 * np.diff(grid)
    x = 0.5 * (grid[:-1] + grid[1:]) + half * nodes[:, None]
    parts = half * (weights @ integrand(x.ravel()).reshape(x.shape))
    # interval by interval, since the rounding of a sum of hundreds would exceed most errors
    return float(np.abs(np.cumsum(np.diff(integral(grid)) - parts)).max())
