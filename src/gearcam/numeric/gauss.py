"""Gauss' rule over cells, and integrals by it to rounding.

The places of a rule of n are the zeros of the Legendre polynomial P_n. They are the eigenvalues of
a tridiagonal matrix of its recurrence (Golub & Welsch, Math. Comp. 23, 1969), off by a few
roundings, which a step of Newton takes away; the weights are 2/((1 - x^2)*P_n'(x)^2) (Abramowitz &
Stegun 25.4.29).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from gearcam.numeric.arrays import Array

NODES: Final = 16
"""Usual number of places in each cell of an integral."""

_ACCURATE: Final = 1e-13
"""Difference of a cell's integral and that of its parts at which it is taken, of the whole."""

_LEVELS: Final = 40
"""Largest number of times a cell is halved."""


def _legendre(x: Array, degree: int) -> tuple[Array, Array]:
    """Return the Legendre polynomial of a degree of 1 or more, and its slope, within -1 to 1."""
    before, value = np.ones_like(x), x
    for k in range(1, degree):
        before, value = value, ((2 * k + 1) * x * value - k * before) / (k + 1)
    return value, degree * (before - x * value) / (1.0 - x * x)


@lru_cache
def legendre_rule(count: int) -> tuple[Array, Array]:
    """Return places and weights of Gauss' rule from -1 to 1.

    That of numpy is part of `numpy.polynomial`, which takes longer to load.

    Parameters
    ----------
    count : int
        Their number: exact for polynomials of degree ``2*count - 1``.

    Returns
    -------
    places, weights : (count,) arrays
        The places rise; of a pair at -x and x both are the same to the last digit.
    """
    k = np.arange(1, count)
    beside = np.diag(k / np.sqrt(4.0 * k * k - 1.0), -1)
    x = np.linalg.eigvalsh(beside, UPLO="L").astype(np.float64)
    value, slope = _legendre(x, count)
    x = x - value / slope
    x = 0.5 * (x - x[::-1])
    weights = 2.0 / ((1.0 - x * x) * _legendre(x, count)[1] ** 2)
    weights *= 2.0 / weights.sum()  # the integral of 1
    return x, weights


@lru_cache
def gauss_rule(count: int) -> tuple[Array, Array]:
    """Return places and weights of Gauss' rule from 0 to 1 (see `legendre_rule`)."""
    places, weights = legendre_rule(count)
    return 0.5 * (places + 1.0), 0.5 * weights


def gauss_cells(low: Array, high: Array, count: int = NODES) -> tuple[Array, Array]:
    """Return places and weights of Gauss' rule in cells.

    Parameters
    ----------
    low, high : (n,) arrays
        Their ends.
    count : int
        Places in each (see `gauss_rule`).

    Returns
    -------
    places, weights : (n, count) arrays
    """
    places, weights = gauss_rule(count)
    width = (high - low)[:, None]
    return low[:, None] + width * places, width * weights


class Integral(NamedTuple):
    """An integral.

    Attributes
    ----------
    value : float
        The integral.
    error : float
        How much it changed when the cells were halved.
    """

    value: float
    error: float


def integral(function: Callable[[Array], Array], edges: Array, rounding: float) -> Integral:
    """Return an integral by Gauss' rule, in cells that are halved until both results agree.

    Parameters
    ----------
    function : callable
        ``function(x)`` at places (n,).
    edges : (k,) array
        Ends of the first cells.
    rounding : float
        Difference of both results that is always taken.

    Returns
    -------
    Integral
    """

    def parts_of(low: Array, high: Array) -> Array:
        x, weights = gauss_cells(low.ravel(), high.ravel())
        return (function(x.ravel()).reshape(x.shape) * weights).sum(axis=1).reshape(low.shape)

    low, high = edges[:-1], edges[1:]
    whole = parts_of(low, high)
    least = max(_ACCURATE * float(np.abs(whole).sum()), rounding)
    value = error = 0.0
    for _ in range(_LEVELS):
        middle = 0.5 * (low + high)
        ends = np.stack([low, middle]), np.stack([middle, high])
        parts = parts_of(*ends)
        both = parts.sum(axis=0)
        change = np.abs(both - whole)
        done = change <= least
        value, error = value + float(both[done].sum()), error + float(change[done].sum())
        low, high, whole = (one[:, ~done].ravel() for one in (*ends, parts))
        if not whole.size:
            break
    return Integral(value + float(whole.sum()), error + float(np.abs(whole).sum()))
