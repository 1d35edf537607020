"""Fitted curves once more: exact distances to bulge polylines, Bezier points of splines."""

from __future__ import annotations

import numpy as np

from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.bulges import bulge_pieces, off_circle
from gearcam.numeric.splines import Spline

BLOCK = 24
"""Points whose distances are computed together."""


def distances(targets: Plane, points: Plane, bulges: Array, closed: bool = True) -> Array:
    """Return the exact distance of each point to the nearest place of a bulge polyline.

    Parameters
    ----------
    targets : (n,) complex array, mm
        Any points; fast where neighbours in the array are neighbours in the plane.
    points, bulges, closed
        The polyline, as for `flatten_bulges`.

    Returns
    -------
    (n,) array, mm
        Never negative.

    Notes
    -----
    Points are taken by blocks. A disc around a block and a disc around each piece bound their
    distance from both sides; only pieces that can be the nearest are computed.
    """
    start, chord, bends = bulge_pieces(points, bulges, closed)
    real = chord != 0
    if real.any():
        start, chord, bends = start[real], chord[real], bends[real]
    middle, reach = start + 0.5 * chord, 0.5 * np.abs(chord) * np.maximum(1.0, np.abs(bends))
    result = np.empty(len(targets))
    for first in range(0, len(targets), BLOCK):
        block = targets[first : first + BLOCK]
        centre = 0.5 * (block.real.min() + block.real.max()) + 0.5j * (
            block.imag.min() + block.imag.max()
        )
        spread = np.abs(block - centre).max()
        away = np.abs(middle - centre)
        near = away - reach - spread <= (away + reach).min() + spread
        result[first : first + BLOCK] = _nearest(block, start[near], chord[near], bends[near])
    return result


def _nearest(points: Plane, start: Plane, chord: Plane, bends: Array) -> Array:
    """Return the distance of points (n,) to the nearest of the pieces (k,)."""
    half = 2 * np.arctan(bends)
    length = np.abs(chord)
    unit = np.divide(chord, length, out=np.ones_like(chord), where=length > 0)
    into, out = unit * np.exp(-1j * half), unit * np.exp(1j * half)
    bend = np.divide(2 * np.sin(half), length, out=np.zeros_like(length), where=length > 0)
    from_start = points[:, None] - start
    from_end = from_start - chord
    local = from_start * np.conj(into)
    ahead, behind = local.real >= 0, (from_end * np.conj(out)).real <= 0
    # Inside the arc's sector the circle is nearest, elsewhere one of the two ends.
    beside = np.where(np.abs(bends) <= 1, ahead & behind, ahead | behind)
    ends = np.minimum(np.abs(from_start), np.abs(from_end))
    return np.where(beside, off_circle(local, bend), ends).min(axis=1)


def cubics(spline: Spline) -> Plane:
    """Bezier points of the cubics of a spline with double knots, (k, 4), complex, mm."""
    steps = np.diff(spline.breaks)
    first, second = spline.poles[1:-1:2], spline.poles[2::2]
    share = steps[:-1] / (steps[:-1] + steps[1:])
    joints = second[:-1] + share * (first[1:] - second[:-1])
    ends = np.concatenate([spline.poles[:1], joints, spline.poles[-1:]])
    return np.stack([ends[:-1], first, second, ends[1:]], axis=1)
