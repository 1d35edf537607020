"""Chords of curves: which overlap, and where they cross. Depends on numpy."""

from __future__ import annotations

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Plane

_TOGETHER = 64
"""Number of boxes compared all with all: faster than halving so few."""


def near_chords(starts: Array, ends: Array) -> tuple[Ints, Ints]:
    """Return the pairs of chords whose bounding boxes overlap, by repeated halving.

    Parameters
    ----------
    starts, ends : (n, 2) arrays
        Ends of the chords, in order along the curve.

    Returns
    -------
    one, two : (k,) int arrays
        Numbers of the chords, ``one <= two``.
    """
    size = 1 << (len(starts) - 1).bit_length()
    rest = np.full((size - len(starts), 2), np.inf)
    low = np.concatenate([np.minimum(starts, ends), rest])
    high = np.concatenate([np.maximum(starts, ends), -rest])
    levels = [(low, high)]
    while len(low) > _TOGETHER:
        low, high = np.minimum(low[::2], low[1::2]), np.maximum(high[::2], high[1::2])
        levels.append((low, high))
    one, two = np.triu_indices(len(low))
    for number, (low, high) in enumerate(reversed(levels)):
        if number:  # both halves of each
            one = (2 * one[:, None] + [0, 0, 1, 1]).ravel()
            two = (2 * two[:, None] + [0, 1, 0, 1]).ravel()
        near = (low[one] <= high[two]).all(axis=1) & (low[two] <= high[one]).all(axis=1)
        near &= one <= two
        one, two = one[near], two[near]
    return one, two


def chord_shares(a: Plane, b: Plane, c: Plane, d: Plane) -> tuple[Array, Array]:
    """Return where the lines of chords cross.

    Parameters
    ----------
    a, b, c, d : complex arrays
        The chords a-b and c-d.

    Returns
    -------
    shares : (2, ...) array
        Position on both chords as shares; not finite for parallels.
    area : array
        Positive where c-d crosses from right to left.
    """
    area = (np.conj(b - a) * (d - c)).imag
    with np.errstate(divide="ignore", invalid="ignore"):
        first = (np.conj(c - a) * (d - c)).imag / area
        second = (np.conj(c - a) * (b - a)).imag / area
    return np.stack([first, second]), area
