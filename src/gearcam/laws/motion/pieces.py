"""Building blocks of motion laws: symmetric sectors, and polynomials exact at both ends.

Most laws are symmetric about the middle of the square, ``S(phi) = 1 - S(1 - phi)``. They are
written for the first half, where small lifts keep all their digits, and turned for the second.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from math import comb, factorial
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from gearcam.numeric.jets import Jet, Value, polynomial, sin
from gearcam.numeric.piecewise import Piece, Piecewise, piecewise

Shape = Callable[[Jet], Jet]

_NOTHING: Final = 1e-12
"""Width below which a sector is left out: the rounding of widths."""

_POWERS: Final = tuple((-1) ** k / factorial(2 * k + 3) for k in range(10, -1, -1))
"""Coefficients of the series of ``x - sin(x)`` over ``x^3``, of falling powers of ``x^2``; the next
term is below 1e-18 of the sum."""


def lag(x: Jet) -> Jet:
    """Return ``x - sin(x)`` with all digits for small x."""
    wave, value, half = sin(x), x.c[0], np.sin(0.5 * x.c[0])
    square = value * value
    series = _POWERS[0] * square + _POWERS[1]
    for power in _POWERS[2:]:
        series *= square
        series += power
    # above this the difference loses a digit at most
    exact = np.where(np.abs(value) < 1.5, series * square * value, value - wave.c[0])
    slope = [2.0 * half * half * rate for rate in x.c[1:2]]
    return Jet([exact, *slope, *(a - b for a, b in zip(x.c[2:], wave.c[2:], strict=True))])


def reflected(shape: Shape) -> Shape:
    """Return a function turned about the middle of the square: ``1 - S(1 - phi)``."""
    return lambda x: 1.0 - shape(1.0 - x)


def turned(shape: Shape) -> Shape:
    """Return a symmetric function, computed from the nearer end of the square.

    Parameters
    ----------
    shape : callable
        ``shape(jet) -> jet``, exact up to the middle.

    Returns
    -------
    callable
    """

    def function(x: Jet) -> Jet:
        second = np.where(x.c[0] <= 0.5, 0.0, 1.0)
        scale = 1.0 - 2.0 * second
        return shape(x * scale + second) * scale + second

    return function


def from_half(sectors: Iterable[tuple[float, Shape]]) -> Piecewise:
    """Return the symmetric law whose first half is given.

    Parameters
    ----------
    sectors : iterable of (width, shape)
        Sectors of the first half, with total width 1/2; sectors of width zero are left out. The
        last is smooth across the middle.

    Returns
    -------
    Piecewise
        S over phi.
    """
    *lower, middle = sectors
    kept = [(width, shape) for width, shape in lower if width > _NOTHING]
    ends = np.cumsum([width for width, _ in kept])
    shapes = [shape for _, shape in kept]
    inner: list[Shape] = []
    if middle[0] > _NOTHING:
        inner = [turned(middle[1])]
        knots = np.concatenate([[0.0], ends, 1.0 - ends[::-1], [1.0]])
    else:
        knots = np.concatenate([[0.0], ends[:-1], [0.5], 1.0 - ends[-2::-1], [1.0]])
    pieces = shapes + inner + [reflected(shape) for shape in reversed(shapes)]
    return piecewise(knots, [Piece(shape) for shape in pieces])


def about(powers: Sequence[Fraction], by: int) -> list[Fraction]:
    """Return a polynomial of t as one of ``t - by``: its exact coefficients.

    Parameters
    ----------
    powers : sequence of Fraction
        Coefficients of rising powers.
    by : int
        Shift of the variable.

    Returns
    -------
    list of Fraction
    """
    return [
        sum((powers[j] * comb(j, k) * by ** (j - k) for j in range(k, len(powers))), Fraction(0))
        for k in range(len(powers))
    ]


def from_both_ends(
    left: Sequence[Fraction | float], right: Sequence[Fraction | float], low: float, high: float
) -> Piece:
    """Return a polynomial that is computed from the nearer end of an interval.

    Parameters
    ----------
    left, right : sequences of numbers
        Coefficients of the powers of ``phi - low`` and of ``phi - high``, equally many.
    low, high : float
        The interval.

    Returns
    -------
    Piece
        Its derivatives at both ends follow exactly from the coefficients.
    """
    return Piece(_from_nearer, parameters=(low, high, *map(float, left), *map(float, right)))


def _from_nearer(x: Jet, low: Value, high: Value, *both: Value) -> Jet:
    first, count = x.c[0] <= 0.5 * (low + high), len(both) // 2
    nearer = [np.where(first, *pair) for pair in zip(both[:count], both[count:], strict=True)]
    return polynomial(x, np.where(first, low, high), *nearer)


def spline(knots: ArrayLike, left: ArrayLike, right: ArrayLike) -> Piecewise:
    """Return the polynomials between knots, given by their coefficients at both ends.

    Parameters
    ----------
    knots : (n + 1,) array
        Rising.
    left, right : (n, m) arrays
        Coefficients of rising powers of the distance from the knots before and behind; both
        describe the same polynomials.

    Returns
    -------
    Piecewise
        Each computed from the nearer end.
    """
    places = np.asarray(knots, dtype=float).tolist()
    rows = np.asarray(left).tolist(), np.asarray(right).tolist()
    ends = zip(*rows, places[:-1], places[1:], strict=True)
    return piecewise(places, [from_both_ends(*each) for each in ends])
