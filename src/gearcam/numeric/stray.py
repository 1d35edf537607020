"""Single rows of a table that are out of line: a slip of the decimal point, two digits exchanged.

Each row is compared with the cubic through the two rows before and the two behind. A row is *stray*
if it misses that by far more than all rows around do once it has the cubic's value. Corners, dwells
and jumps of a table are not: at a corner between straight parts the ratio is 6 at equal steps.

Depends on arrays only.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Ints

_REACH: Final = 6
"""Rows to either side whose distances from their own cubics are compared."""

_CLEAR: Final = 15.0
"""Least ratio of the distances: twice that of any row of the motion laws, however coarse."""

_LARGE: Final = 0.02
"""Least distance from the cubic and from the chord, as a share of the range of the other rows."""

_ALONE: Final = 1e-3
"""Least range of the other rows over the distance: a row that moves alone is no slip."""


_EVEN: Final = 2.5
"""Largest ratio of the steps of the rows beside a row, for a cubic through them to mean anything:
a row may be left out, but where steps differ more its neighbours do not tell a row."""


def stray_rows(x: Array, y: Array, period: float) -> tuple[Ints, Array]:
    """Return the stray rows of a table that repeats.

    Parameters
    ----------
    x : (n,) array
        Rising, over less than the period.
    y : (n,) array
        Values.
    period : float
        After which the values repeat, in the unit of `x`.

    Returns
    -------
    rows : (k,) int array
        Their numbers, from 0.
    suggested : (k,) array
        The values that the rows around them suggest.
    """
    count = len(x)
    if count <= 2 * _REACH:
        return np.zeros(0, dtype=np.int64), np.zeros(0)
    around = np.arange(count)[:, None] + np.arange(-_REACH, _REACH + 1)
    places, values = x[around % count] + period * (around // count), y[around % count]
    missed = _missed(places, values, _REACH)
    values[:, _REACH] -= missed
    others = [place for place in range(2, 2 * _REACH - 1) if place != _REACH]
    rough = np.max([np.abs(_missed(places, values, place)) for place in others], axis=0)
    before, here, behind = (places[:, _REACH + k] for k in (-1, 0, 1))
    low, high = values[:, _REACH - 1], values[:, _REACH + 1]
    chord = low + (high - low) * (here - before) / (behind - before)
    size = np.minimum(np.abs(missed), np.abs(y - chord))
    # a rise and return within three rows is a motion of its own
    extent = np.array([np.ptp(np.roll(y, 1 - row)[3:]) for row in range(count)])
    steps = np.diff(places[:, _REACH - 3 : _REACH + 4], axis=1)
    even = steps.max(axis=1) <= _EVEN * steps.min(axis=1)
    stray = even & (size > _CLEAR * rough) & (size > _LARGE * extent) & (extent > _ALONE * size)
    rows = np.flatnonzero(stray)
    return rows, values[rows, _REACH]


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
