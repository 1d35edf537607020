"""Piecewise Chebyshev expansions: values and integrals of smooth functions to rounding.

The axis is divided into intervals until an expansion of fixed degree represents the function on
each. Nothing is fitted across a corner: the caller gives corners as breaks. If the division does
not converge inside an interval the function is refused as not smooth, with the place. The error of
an integral is measured by an independent quadrature.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.base.errors import GearcamError
from gearcam.numeric.arrays import Array, distinct, divided
from gearcam.numeric.gauss import legendre_rule

_DEGREE = 8

FIRST_CUTS = 128
"""First number of intervals, so that no bump of a degree lies between the samples."""

_NOISE = 1e-11
"""Allowed rounding of a function, relative to its largest value."""

_FINEST = 2**18
"""Largest number of intervals: below 5 arc seconds a function counts as not smooth."""


class NotSmoothError(GearcamError, ValueError):
    """A function is not smooth at a place, or not finite there.

    Parameters
    ----------
    place : float
        Place on the function's axis.
    finite : bool
        Whether the function is finite there.
    """

    def __init__(self, place: float, finite: bool) -> None:
        self.place, self.finite = place, finite
        super().__init__(f"{'not smooth' if finite else 'not finite'} at {place:.6g}")


@dataclass(frozen=True, eq=False, kw_only=True)
class Expansion(ShortRepr):
    """A function given by Chebyshev coefficients on consecutive intervals.

    Parameters
    ----------
    knots : (n + 1,) array
        Ends of the intervals, rising.
    coefficients : (m, n) array
        Coefficients of T_0, T_1, ... on each interval.
    """

    knots: Array
    coefficients: Array

    def __call__(self, x: ArrayLike) -> Array:
        """Return the values at `x`; beyond the ends the end intervals are extrapolated."""
        x = np.asarray(x, dtype=float)
        index = self.knots[1:-1].searchsorted(x, side="right")
        center, scale, powers = self.powers
        t = (x - center.take(index, mode="clip")) * scale.take(index, mode="clip")
        columns = powers.take(index, 1, mode="clip")
        value = columns[-1]
        for column in columns[-2::-1]:
            value *= t
            value += column
        return value

    @cached_property
    def powers(self) -> tuple[Array, Array, Array]:
        """Middles and inverse half widths of the intervals, and power coefficients.

        At this degree, and with coefficients that decrease to rounding, powers are as accurate and
        take half the time.
        """
        powers = _powers_of_chebyshev(len(self.coefficients)).T @ self.coefficients
        return 0.5 * (self.knots[:-1] + self.knots[1:]), 2.0 / np.diff(self.knots), powers

    def shifted(self, constant: float) -> Expansion:
        """Return the function with a constant added."""
        moved = self.coefficients.copy()
        moved[0] += constant
        return replace(self, coefficients=moved)

    def antiderivative(self) -> Expansion:
        """Return the integral from the first knot."""
        c = self.coefficients * (0.5 * np.diff(self.knots))
        c = np.vstack([c, np.zeros((2, c.shape[1]))])
        k = np.arange(1, len(c) - 1)[:, None]
        previous = c[:-2].copy()
        previous[0] *= 2.0
        integral = np.vstack([np.zeros((1, c.shape[1])), (previous - c[2:]) / (2.0 * k)])
        signs = (-1.0) ** np.arange(len(integral))
        starts = np.concatenate([[0.0], np.cumsum(integral.sum(axis=0) - signs @ integral)])
        integral[0] = starts[:-1] - signs @ integral
        return Expansion(knots=self.knots, coefficients=integral)

    def derivative(self) -> Expansion:
        """Return the derivative; it is least accurate at the ends of an interval."""
        slopes = np.polynomial.chebyshev.chebder(self.coefficients) * (2.0 / np.diff(self.knots))
        return replace(self, coefficients=slopes)

    @property
    def last(self) -> float:
        """Value at the last knot."""
        return float(self.coefficients[:, -1].sum())


@lru_cache
def _powers_of_chebyshev(count: int) -> Array:
    """Row k holds the power coefficients of T_k, from ``T_(k+1) = 2*t*T_k - T_(k-1)``."""
    rows = np.eye(count)
    for k in range(2, count):
        rows[k] = 2.0 * np.roll(rows[k - 1], 1) - rows[k - 2]
    return rows


@lru_cache
def _basis(degree: int) -> tuple[Array, Array]:
    """Nodes on [-1, 1], and the matrix from values there to coefficients."""
    angles = np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1)
    to_coefficients = np.cos(np.outer(np.arange(degree + 1), angles)) * 2.0 / (degree + 1)
    to_coefficients[0] *= 0.5
    return np.cos(angles), to_coefficients


def expand(
    function: Callable[[Array], Array],
    breaks: ArrayLike,
    tolerance: float,
    *,
    degree: int = _DEGREE,
    cuts: int = FIRST_CUTS,
) -> Expansion:
    """Return the expansion of a piecewise smooth function to a tolerance.

    Parameters
    ----------
    function : callable
        ``function(x) -> values``, vectorised.
    breaks : (n,) array
        Rising; the first and last are the ends, the others are possible corners.
    tolerance : float
        Truncation error, relative to the largest value, allowed on an interval as wide as the
        whole; narrower ones may have more, since they contribute less to the integral.
    degree : int
        Degree on each interval.
    cuts : int
        First number of intervals, a power of 2.

    Returns
    -------
    Expansion
        Of fixed degree on as many intervals as needed.

    Raises
    ------
    NotSmoothError
        If the function is not finite or not smooth between the breaks.
    """

    def one(x: Array) -> Array:
        return np.broadcast_to(function(x), x.size)[None]

    return expand_all(one, breaks, tolerance, degree=degree, cuts=cuts)[0]


def expand_all(
    functions: Callable[[Array], Array],
    breaks: ArrayLike,
    tolerance: float,
    *,
    degree: int = _DEGREE,
    cuts: int = FIRST_CUTS,
    sizes: ArrayLike = 0.0,
) -> list[Expansion]:
    """Return the expansions of several functions on the same intervals (see `expand`).

    Parameters
    ----------
    functions : callable
        ``functions(x) -> (m, n) array`` at n places.
    breaks, tolerance, degree, cuts
        As for `expand`; the tolerance is relative to the largest value of each function.
    sizes : float or (m,) array
        Or relative to these, where a function is smaller: it may be nothing but rounding.

    Returns
    -------
    list of m Expansion

    Raises
    ------
    NotSmoothError
        If a function is not finite or not smooth between the breaks.
    """
    grid = np.asarray(breaks, dtype=float)
    span = grid[-1] - grid[0]
    nodes, to_coefficients = _basis(degree)
    halvings = (_FINEST // cuts).bit_length() - 1
    parts = np.ceil(cuts * np.diff(grid) / span).astype(int)
    edges = divided(grid, parts)
    low, high = edges[:-1], edges[1:]
    done: list[tuple[Array, Array, Array]] = []
    scale = np.asarray(sizes, dtype=float)
    before = np.full(low.shape, np.inf)
    for halving in range(halvings + 1):
        x = 0.5 * (low + high) + 0.5 * (high - low) * nodes[:, None]
        values = functions(x.ravel()).reshape(-1, *x.shape)
        bad = ~np.isfinite(values).all(axis=0)
        if bad.any():
            raise NotSmoothError(float(x[bad][0]), finite=False)
        scale = np.maximum(scale, np.abs(values).max(axis=(1, 2)))
        coefficients = to_coefficients @ values
        last = np.abs(coefficients[:, -2:]).max(axis=1)
        allowed = max(tolerance, 4.0 * np.finfo(float).eps) * np.sqrt(span / (high - low))
        # halving reduces the error at a corner, but not the function's own rounding
        noise = (last <= _NOISE * scale[:, None]) & (last >= 0.75 * before)
        good = ((last <= allowed * scale[:, None]) | noise).all(axis=0)
        if good.any():
            done.append((low[good], high[good], coefficients[..., good]))
        if good.all():
            break
        if halving == halvings:
            # the first of several corners alike: which is worst is decided by rounding
            rough = np.where(
                good, 0.0, (last / np.where(scale > 0.0, scale, 1.0)[:, None]).max(axis=0)
            )
            middles = (0.5 * (low + high))[rough >= 0.5 * rough.max()]
            raise NotSmoothError(float(middles.min()), finite=True)
        low, high, before = low[~good], high[~good], np.tile(last[:, ~good], 2)
        middle = 0.5 * (low + high)
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    lows, highs, columns = (np.concatenate(part, axis=-1) for part in zip(*done, strict=True))
    order = np.argsort(lows)
    knots = np.append(lows[order], highs[order[-1]])
    return [Expansion(knots=knots, coefficients=one) for one in columns[..., order]]


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
    nodes, weights = legendre_rule(_NODES)
    grid = distinct(knots, 0.5 * (knots[:-1] + knots[1:]))
    half = 0.5 * np.diff(grid)
    x = 0.5 * (grid[:-1] + grid[1:]) + half * nodes[:, None]
    parts = half * (weights @ integrand(x.ravel()).reshape(x.shape))
    # interval by interval, since the rounding of a sum of hundreds would exceed most errors
    return float(np.abs(np.cumsum(np.diff(integral(grid)) - parts)).max())
