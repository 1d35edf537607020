"""Single rows of a table that are out of line: a slip of the decimal point, two digits exchanged.

Each row is compared with the cubic through the two rows before and the two behind. A row is *stray*
if it misses that by far more than all rows around do once it has the cubic's value. Corners, dwells
and jumps of a table are not: at a corner between straight parts the ratio is 6 at equal steps.
Of a row only as many decimals are known as are written, so half a unit of the last is no miss.

Depends on arrays only.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Mask

_REACH: Final = 8
"""Rows to either side that are looked at; of all but the last two the distances from their own
cubics are compared."""

_FEWEST: Final = 13
"""Fewest rows of a table in which a stray one can be found."""

_CLEAR: Final = 15.0
"""Least ratio of the distances: twice that of any row of the laws, however coarse or noisy."""

_LARGE: Final = 0.002
"""Least distance from the cubic and from the chord, as a share of the range of the other rows, from
which what a table rises in all is taken off."""

_ALONE: Final = 1e-3
"""Least range of the other rows over the distance: a row that moves alone is no slip."""

_EVEN: Final = 2.5
"""Largest ratio of the steps of the rows beside a row, for a cubic through them to mean anything:
a row may be left out, but where steps differ more its neighbours do not tell a row."""

_DECIMALS: Final = 9
"""Most decimals that a table may be rounded to."""


def stray_rows(x: Array, y: Array, period: float | None, rise: float = 0.0) -> tuple[Ints, Array]:
    """Return the stray rows of a table.

    Parameters
    ----------
    x : (n,) array
        Rising, over less than the period.
    y : (n,) array
        Values, in the unit in which they are written.
    period : float or None
        After which the values repeat, in the unit of `x`. None if the table has ends: the three
        rows at each have too few beside them to be compared.
    rise : float
        What the values rise in a period.

    Returns
    -------
    rows : (k,) int array
        Their numbers, from 0.
    suggested : (k,) array
        The values that the rows around them suggest.
    """
    count = len(x)
    if count < _FEWEST:
        return np.zeros(0, dtype=np.int64), np.zeros(0)
    around = np.arange(count)[:, None] + np.arange(-_REACH, _REACH + 1)
    turns, own = around // count, around % count
    slope = rise / period if period else (y[-1] - y[0]) / (x[-1] - x[0])
    places, values = x[own] + (period or 0.0) * turns, y[own] + rise * turns
    if period is None:
        values[turns != 0] = np.nan  # beyond the ends: no distance there is compared
    missed = _missed(places, values, _REACH)
    values[:, _REACH] -= missed
    others = [place for place in range(2, 2 * _REACH - 1) if place != _REACH]
    rough = np.fmax.reduce([np.abs(_missed(places, values, place)) for place in others])
    before, here, behind = (places[:, _REACH + k] for k in (-1, 0, 1))
    low, high = values[:, _REACH - 1], values[:, _REACH + 1]
    chord = low + (high - low) * (here - before) / (behind - before)
    size = np.minimum(np.abs(missed), np.abs(y - chord))
    clear = (size > _CLEAR * (rough + _half_unit(y))) & _even(places)
    level = y - slope * x
    rows = np.array(
        [row for row in np.flatnonzero(clear).tolist() if _among(size[row], row, y, level)],
        dtype=np.int64,
    )
    return rows, values[rows, _REACH]


def _among(size: float, row: int, y: Array, level: Array) -> bool:
    """Return whether a distance is large, and yet of a row among others that move too."""
    # a rise and return within three rows is a motion of its own
    extent, swing = (float(np.ptp(np.roll(one, 1 - row)[3:])) for one in (y, level))
    return size > _LARGE * swing and extent > _ALONE * size


def _even(places: Array) -> Mask:
    """Return whether the steps beside the middle row of each row of places are about alike."""
    steps = np.abs(np.diff(places[:, _REACH - 3 : _REACH + 4], axis=1))
    return np.asarray(steps.max(axis=1) <= _EVEN * steps.min(axis=1))


def _half_unit(values: Array) -> float:
    """Return half a unit of the last decimal in which values are written; 0 if not rounded."""
    for decimals in range(_DECIMALS + 1):
        if np.allclose(values, np.round(values, decimals), rtol=1e-13, atol=1e-12):
            return float(0.5 * 10.0**-decimals)
    return 0.0


def _missed(places: Array, values: Array, at: int) -> Array:
    """Return by how much one column of values is above the cubic through the four beside it."""
    near = [at - 2, at - 1, at + 1, at + 2]
    cubic = np.zeros(len(values))
    for one in near:
        weight = np.ones(len(values))
        for other in near:
            if other != one:
                weight *= (places[:, at] - places[:, other]) / (places[:, one] - places[:, other])
        cubic += weight * values[:, one]
    return values[:, at] - cubic
