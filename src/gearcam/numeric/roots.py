"""Root searches, vectorised: in brackets, and damped Newton steps for systems of three equations.

A search in a bracket keeps an interval that contains its root. Newton steps are taken while they
stay inside it and are replaced by bisection otherwise, so that no start value can lead out of it;
where they converge slowly, bisection takes over.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from gearcam.numeric.arrays import Array, Ints

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


State = TypeVar("State")

_DAMPED = 40
"""Largest number of Newton steps: five suffice where a root exists."""

_LONGEST = 0.5
"""Longest step, in units of the scale: half the distance of neighbouring roots."""

_FEW = 0.25
"""Share of unfinished systems below which only these are evaluated."""

_LEFT = 0.5
"""Share of the last step above which a reversed step counts as oscillation."""


def damped_newton(
    evaluate: Callable[[Array, Ints], tuple[State, Array, Array]],
    x: Array,
    scale: Array,
    small: float,
    limits: tuple[Array, Array] | None = None,
) -> tuple[Array, State]:
    """Solve n systems of three equations by Newton steps, limited in two of the unknowns.

    Where slopes jump, steps may oscillate across a root. Of a step that goes back almost as far as
    the last one, half is taken, of the next such step a quarter.

    Parameters
    ----------
    evaluate : callable
        ``evaluate(x, rows)`` returns for systems `rows` (m,) any state, the residuals (3, m) and
        their derivatives (3, 3, m), by equation and unknown.
    x : (3, n) array
        First guess.
    scale : (n,) array
        Unit of the first two unknowns: half a unit is the longest step.
    small : float
        Step, in these units, at which the iteration ends.
    limits : (low, high), optional
        (n,) arrays, bounds of the first two unknowns.

    Returns
    -------
    x : (3, n) array
        Not a root where there is none near: the caller has to check the residuals.
    state : State
        State that `evaluate` returns there.
    """

    def held(x: Array, rows: Ints) -> Array:
        if limits is None:
            return x
        low, high = (limit[rows] for limit in limits)
        return np.concatenate([np.clip(x[:2], low, high), x[2:]])

    every = rows = np.arange(x.shape[1])
    x = held(x, rows)
    roots = x.copy()
    _, equations, slopes = evaluate(x, rows)
    share, last, before = np.ones(x.shape[1]), np.zeros_like(x), np.zeros(x.shape[1])
    for _ in range(_DAMPED):
        step = -solve(slopes, equations)
        size = np.abs(step[:2]).max(axis=0) * scale[rows]
        with np.errstate(invalid="ignore", divide="ignore"):
            back = ((step[:2] * last[:2]).sum(axis=0) < 0.0) & (size > _LEFT * before)
            share = np.where(back, 0.5 * share, np.minimum(1.0, 2.0 * share))
            last, before = step * np.minimum(share, _LONGEST / size), size
        x = held(x + np.where(np.isfinite(last), last, 0.0), rows)
        roots[:, rows] = x
        going = size > small
        if not going.any():
            break
        if going.mean() < _FEW:
            rows, x, share = rows[going], x[:, going], share[going]
            last, before = last[:, going], before[going]
        _, equations, slopes = evaluate(x, rows)
    return roots, evaluate(roots, every)[0]


def solve(matrix: Array, right: Array) -> Array:
    """Return the solutions of linear systems, by determinants.

    Parameters
    ----------
    matrix : (3, 3, n) array
        By row and column.
    right : (3, n) array
        Right sides.

    Returns
    -------
    (3, n) array
        Not finite where a matrix is singular.
    """
    a, b, c = matrix[:, 0], matrix[:, 1], matrix[:, 2]

    def triple(p: Array, q: Array, r: Array) -> Array:
        return (
            p[0] * (q[1] * r[2] - q[2] * r[1])
            + p[1] * (q[2] * r[0] - q[0] * r[2])
            + p[2] * (q[0] * r[1] - q[1] * r[0])
        )

    with np.errstate(divide="ignore", invalid="ignore"):
        return np.stack([triple(right, b, c), triple(a, right, c), triple(a, b, right)]) / triple(
            a, b, c
        )
