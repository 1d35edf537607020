"""Brackets on an axis, narrowed until they hold a change, or a largest value, within a tolerance.

All brackets are narrowed at once, so that a function that is costly to call is called a few times
only. Nothing is assumed of the functions: they may jump, and need not be known everywhere.

Depends on numpy only.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Ints

_PARTS: Final = 16
"""Parts of a bracket in each round."""

_PEAKS: Final = 4
"""How many of the highest peaks among samples are narrowed: others may be higher between them."""

Function = Callable[[Array, Ints], Array]
"""``function(x, rows)`` of (m, k) places, in each bracket's row, and the m numbers of brackets."""


def changes(function: Function, low: Array, high: Array, tolerance: float) -> tuple[Array, Array]:
    """Return the two sides of a change of a function's value, in each bracket.

    Parameters
    ----------
    function : callable
        See `Function`; its values are compared.
    low, high : (n,) arrays
        Places where its values differ; `low` may be the larger one.
    tolerance : float
        Largest distance of both sides.

    Returns
    -------
    (n,) array, (n,) array
        The side of `low`, and that of `high`.
    """

    def pick(values: Array) -> tuple[Ints, Ints]:
        last = np.maximum(np.argmax(values != values[:, :1], axis=1), 1)
        return last - 1, last

    low, high, _, _ = _narrowed(function, low, high, tolerance, pick)
    return low, high


def highest(values: Array, cuts: Ints) -> tuple[Ints, Ints]:
    """Return the highest peaks in each row of samples.

    Parameters
    ----------
    values : (q, n) array
        Samples; -inf where they are not known.
    cuts : (m,) int array
        Where rows are not continuous, the first and the last end included.

    Returns
    -------
    (k,) int array, (k,) int array
        Row and column of each: the largest value among its neighbours.
    """
    apart = np.insert(values, cuts, -np.inf, axis=1)
    columns = np.insert(np.arange(values.shape[1]), cuts, -1)[1:-1]
    middle = apart[:, 1:-1]
    peak = (middle > apart[:, :-2]) & (middle >= apart[:, 2:])
    heights = np.where(peak, middle, -np.inf)
    best = np.argsort(-heights, axis=1, kind="stable")[:, :_PEAKS]
    row, rank = np.nonzero(np.isfinite(np.take_along_axis(heights, best, axis=1)))
    return row, columns[best[row, rank]]


def peaks(function: Function, low: Array, high: Array, tolerance: float) -> tuple[Array, Array]:
    """Return where a function is largest in each bracket, and its value there.

    Parameters
    ----------
    function : callable
        See `Function`; -inf where it is not known.
    low, high : (n,) arrays
        Around one largest value each.
    tolerance : float
        Largest width at which a bracket counts as a place.

    Returns
    -------
    places, values : (n,) arrays
    """

    def pick(values: Array) -> tuple[Ints, Ints]:
        best = np.argmax(values, axis=1)
        return np.maximum(best - 1, 0), np.minimum(best + 1, _PARTS)

    _, _, places, values = _narrowed(function, low, high, tolerance, pick)
    best = np.arange(len(values)), np.argmax(values, axis=1)
    return places[best], values[best]


def neighbours(places: Array) -> tuple[Array, Array]:
    """Return the places before and behind each of rising `places`, (n,); at an end itself."""
    return np.append(places[:1], places[:-1]), np.append(places[1:], places[-1:])


def summits(
    functions: Callable[[Array], Array], samples: Array, low: Array, high: Array, tolerance: float
) -> tuple[Ints, Array, Array]:
    """Return where several functions of one axis are largest, between samples too.

    Parameters
    ----------
    functions : callable
        Returns q values, (q, m), at rising places, (m,); -inf where they are not known.
    samples : (q, n) array
        Their values at n places.
    low, high : (n,) arrays
        Between which places the values around each sample lie.
    tolerance : float
        Largest width at which a bracket counts as a place.

    Returns
    -------
    which, places, values : (k,) arrays
        Number of the function, and place and value of each of its highest peaks.
    """
    which, at = highest(samples, np.array([0, samples.shape[1]]))

    def function(places: Array, rows: Ints) -> Array:
        flat, index = np.unique(places, return_inverse=True)
        values = functions(flat)[:, index.reshape(places.shape)]
        return values[which[rows], np.arange(len(rows))]

    return which, *peaks(function, low[at], high[at], tolerance)


def _narrowed(
    function: Function,
    low: Array,
    high: Array,
    tolerance: float,
    pick: Callable[[Array], tuple[Ints, Ints]],
) -> tuple[Array, Array, Array, Array]:
    """Return the ends of brackets, and the last places and values in them, (n, k).

    ``pick(values)`` returns between which columns a bracket goes on.
    """
    low, high = low.astype(float), high.astype(float)
    share = np.linspace(0.0, 1.0, _PARTS + 1)
    rows = np.arange(len(low))
    places, values = np.zeros((2, len(low), _PARTS + 1))
    while rows.size:
        x = low[rows, None] * (1.0 - share) + high[rows, None] * share
        found = function(x, rows)
        places[rows], values[rows] = x, found
        first, last = pick(found)
        each = np.arange(len(rows))
        low[rows], high[rows] = x[each, first], x[each, last]
        # between neighbouring numbers there is no place left
        rows = rows[np.abs(high[rows] - low[rows]) > np.maximum(tolerance, np.spacing(high[rows]))]
    return low, high, places, values
