"""Bracketed root searches, vectorised: every search keeps an interval that contains its root.

Newton steps are taken while they stay inside the bracket and are replaced by bisection otherwise,
so that no start value can lead out of it; where they converge slowly, bisection takes over.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from gearcam.numeric.arrays import Array

_STEPS = 80
"""Largest number of steps: bisection alone reaches rounding in 60, mixed steps in 80."""

_NEWTON = 30
"""Largest number of Newton steps: more than ten are rare."""


def newton_in_bracket(
    function: Callable[[Array], tuple[Array, Array]],
    low: ArrayLike,
    high: ArrayLike,
    start: ArrayLike,
    tolerance: float,
    noise: float = 0.0,
) -> Array:
    """Find the root of a function between `low` and `high`, element by element.

    Parameters
    ----------
    function : callable
        ``function(x) -> (value, slope)``. Its value must rise through zero from `low` to `high`
        (`low` may be the larger of the two: then it falls along the axis).
    low, high : array
        Ends of the bracket: value below zero at `low`, above at `high`.
    start : array
        First guess, inside the bracket.
    tolerance : float
        The search stops when every step is smaller than this, in units of x.
    noise : float
        The search also stops when the value is smaller than this: rounding of 0.

    Returns
    -------
    array
        The roots; where the function does not change sign, the end nearer to zero.
    """
    a, b, x = (np.array(v, dtype=float) for v in np.broadcast_arrays(low, high, start))
    if x.size == 0:
        return x
    last = np.full(x.shape, np.inf)
    for number in range(_STEPS):
        value, slope = function(x)
        below = value < 0.0
        a, b = np.where(below, x, a), np.where(below, b, x)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = x - value / slope
        inside = (step - a) * (step - b) <= 0.0
        # where the slope jumps, steps may oscillate between the ends of the bracket
        size = np.abs(step - x)
        inside &= (size <= 0.5 * np.maximum(np.abs(b - a), last)) & (number < _NEWTON)
        # if the first step leads out, try the end: it may be the root
        other = 0.5 * (a + b) if number else np.where((step - a) * (b - a) > 0.0, b, a)
        new = np.where(np.abs(value) <= noise, x, np.where(inside, step, other))
        last = np.abs(new - x)
        x = new
        if np.all(last <= tolerance):
            break
    return x


def bracketed_root(
    function: Callable[[Array], Array],
    low: ArrayLike,
    high: ArrayLike,
    tolerance: float,
    ends: tuple[Array, Array] | None = None,
) -> Array:
    """Find where a function changes sign between `low` and `high`, including jumps.

    Chandrupatla's method: inverse quadratic steps where the last three points allow them, otherwise
    bisection.

    Parameters
    ----------
    function : callable
        ``function(x) -> value``, vectorised.
    low, high : array
        Brackets with opposite signs at their ends.
    tolerance : float
        Width at which a bracket counts as a point, in units of x.
    ends : (array, array), optional
        The function's values at `low` and `high`, if already computed.

    Returns
    -------
    array
        The roots: the end of the last bracket with the value nearer to zero.
    """
    a, b = (np.array(v, dtype=float) for v in np.broadcast_arrays(low, high))
    if a.size == 0:
        return a
    fa, fb = ends or (function(a), function(b))
    c, fc, t = a.copy(), fa.copy(), np.full_like(a, 0.5)
    for _ in range(_STEPS):
        x = a + t * (b - a)
        fx = function(x)
        same = np.sign(fx) == np.sign(fa)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = x, fx
        width = np.abs(b - a)
        if np.all((width <= tolerance) | (fa == 0.0)):
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            xi, ph = (a - b) / (c - b), (fa - fb) / (fc - fb)
            fits = (ph**2 < xi) & ((1.0 - ph) ** 2 < 1.0 - xi)
            quadratic = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * (
                fb / (fc - fb)
            )
        inset = 0.5 * tolerance / np.maximum(width, tolerance)
        t = np.clip(np.where(fits & np.isfinite(quadratic), quadratic, 0.5), inset, 1.0 - inset)
        t = np.where(fa == 0.0, 0.0, t)
    return np.where(np.abs(fa) <= np.abs(fb), a, b)


def largest_fitting(fits: Callable[[float], bool], high: float, halvings: int) -> float:
    """Return the largest number below `high` that fits, to ``high/2**halvings``.

    Parameters
    ----------
    fits : callable
        Returns whether a number fits: true up to a limit.
    high : float
        A number that does not fit.
    halvings : int
        Number of bisections.

    Returns
    -------
    float
        0 if none fits.
    """
    low = 0.0
    for _ in range(halvings):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low
