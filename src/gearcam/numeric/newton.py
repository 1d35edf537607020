"""Damped Newton steps for many systems of three equations at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from gearcam.numeric.arrays import Array, Ints

State = TypeVar("State")

_STEPS = 40
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
    found = x.copy()
    _, equations, slopes = evaluate(x, rows)
    share, last, before = np.ones(x.shape[1]), np.zeros_like(x), np.zeros(x.shape[1])
    for _ in range(_STEPS):
        step = -solve(slopes, equations)
        size = np.abs(step[:2]).max(axis=0) * scale[rows]
        with np.errstate(invalid="ignore", divide="ignore"):
            back = ((step[:2] * last[:2]).sum(axis=0) < 0.0) & (size > _LEFT * before)
            share = np.where(back, 0.5 * share, np.minimum(1.0, 2.0 * share))
            last, before = step * np.minimum(share, _LONGEST / size), size
        x = held(x + np.where(np.isfinite(last), last, 0.0), rows)
        found[:, rows] = x
        going = size > small
        if not going.any():
            break
        if going.mean() < _FEW:
            rows, x, share = rows[going], x[:, going], share[going]
            last, before = last[:, going], before[going]
        _, equations, slopes = evaluate(x, rows)
    return found, evaluate(found, every)[0]


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
