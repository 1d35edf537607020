"""Biarcs: chains of circular arcs fitted to curves.

A *biarc* is a pair of arcs with a common tangent at the joint, through two points with given
tangents. A run becomes a bulge polyline (see `bulges`) of biarcs, each as long as the tolerance
allows.

Arcs are given by curvature, not radius, so that nearly straight pieces lose no digits.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.bulges import off_circle
from gearcam.numeric.contour import Run
from gearcam.numeric.fitting import (
    Checks,
    RunPoints,
    checks_of,
    largest,
    longest_pieces,
    points_to_fit,
    turns,
)

MAX_TURN = 0.5 * np.pi
"""Largest angle of one biarc, rad: its two arcs stay below a half circle, beyond which the distance
to the arc and the distance to the circle could differ."""

STRAIGHT = 1e-6
"""A piece counts as straight if its sagitta is below this share of the tolerance: far above
rounding, far below anything that a machine can follow."""

SAME_ARC = 1e-9
"""Difference of the two end angles, rad, below which a biarc is written as one arc."""

NEAR = 0.02
"""Relative tolerance of the length of the longest piece that fits."""

WIDEST = np.tan(1.0)
"""Tangent of half the largest angle of one arc."""


class _Biarcs(NamedTuple):
    """Biarcs: their joints, and the bulges of both arcs, (2, n).

    A `single` arc ends at the joint; so does a straight piece that `fails`.
    """

    joint: Plane
    bulges: Array
    single: Mask
    fails: Mask


def fit_arcs(runs: Sequence[Run], tolerance: float) -> list[tuple[Plane, Array]]:
    """Fit tangent-continuous arcs to runs, each pair as long as the tolerance allows.

    From each point the longest piece is searched whose biarc stays within the tolerance of the
    run's points. The error grows with the third power of the length, so each trial predicts the
    next one. Distances are from the run's points to the arcs; the distances from the arcs to the
    run exceed them by at most the run's own chord error, since both share ends and end tangents.

    Parameters
    ----------
    runs : sequence of Run
        Smooth pieces, mm.
    tolerance : float, mm
        Largest distance between a run's points and the arcs.

    Returns
    -------
    list of (points, bulges)
        For each run its ends and the knots between, (k,), complex, mm, and the tangents of a
        quarter of each arc's angle, (k - 1,), positive to the left, 0 for a straight piece.

    Raises
    ------
    ValueError
        If the tolerance is not positive, or a run is not finite or has fewer than two different
        points.
    """
    rows = points_to_fit(runs, tolerance)
    turned = np.append(0.0, np.cumsum(turns(rows.tangents)))
    errors = partial(_errors, rows, turned, checks_of(rows, tolerance, even=True))
    start, end = longest_pieces(errors, rows, tolerance, 3, NEAR)
    made = _biarcs(rows, start, end)
    kept = np.stack([np.ones_like(made.single), ~made.single], axis=1)
    knots = np.stack([rows.points[start], made.joint, rows.points[end]])
    rise = 0.5 * np.abs(made.bulges * np.diff(knots, axis=0))
    bulges = np.where(rise > STRAIGHT * tolerance, made.bulges, 0.0)
    behind = np.cumsum(kept.sum(axis=1))[np.searchsorted(start, rows.last) - 1]
    pieces = (np.split(one.T[kept], behind[:-1]) for one in (knots[:2], bulges))
    ends = rows.points[rows.last]
    return [(np.append(one, q), bends) for one, bends, q in zip(*pieces, ends, strict=True)]


def fit_closed(runs: Sequence[Run], tolerance: float) -> tuple[Plane, Array]:
    """Fit arcs to a closed chain of runs.

    Parameters
    ----------
    runs : sequence of Run
        In order; each begins where the one before ends.
    tolerance : float, mm
        As for `fit_arcs`.

    Returns
    -------
    points : (k,) complex array, mm
        First not repeated.
    bulges : (k,) array
        Bulge k belongs to the piece from point k to the next one.

    Raises
    ------
    ValueError
        If the runs do not join within the tolerance.
    """
    ends = np.array([run.points[[0, -1]] for run in runs])
    gap = float(np.abs(np.roll(ends[:, 0], -1) - ends[:, 1]).max())
    if gap > tolerance:
        raise ValueError(f"runs do not join: a gap of {gap:.3g} mm")
    made = fit_arcs(runs, tolerance)
    points = np.concatenate([points[:-1] for points, _ in made])
    return points, np.concatenate([bulges for _, bulges in made])


def _biarcs(rows: RunPoints, start: Ints, end: Ints) -> _Biarcs:
    """Return the biarcs between points."""
    p, q = rows.points[start], rows.points[end]
    t, u = rows.tangents[start], rows.tangents[end]
    chord = q - p
    before, after = chord * np.conj(t), u * np.conj(chord)
    apart = before * np.conj(after)
    single = np.abs(apart.imag) < SAME_ARC * apart.real
    single &= np.abs(before.imag) < WIDEST * before.real
    along = 2 * (before + after).real
    # Equal tangent lengths d on both sides of the joint (Bolton 1975): |t - u|^2*d^2 + along*d =
    # |chord|^2.
    square = np.abs(chord) ** 2
    root = along + np.sqrt(along**2 + 4 * np.abs(t - u) ** 2 * square)
    length = np.divide(2 * square, root, out=np.zeros_like(root), where=along > 0)
    joint = 0.5 * (p + q + length * (t - u))
    turned = np.array([(joint - p) * np.conj(t), u * np.conj(q - joint)])
    # each arc turns by twice these angles
    pair = ~single & (along > 0) & (np.abs(turned.imag) <= turned.real).all(axis=0)
    turned[0, single] = (before + after)[single]
    size = np.abs(turned) + turned.real
    bulges = np.divide(turned.imag, size, out=np.zeros_like(size), where=size > 0)
    bulges[:, ~pair & ~single] = bulges[1, single] = 0.0
    return _Biarcs(np.where(pair, joint, q), bulges, ~pair, ~pair & ~single)


def _errors(rows: RunPoints, turned: Array, checks: Checks, start: Ints, end: Ints) -> Array:
    """Return the largest distance of check points to the biarcs between their points.

    `turned` is the accumulated angle of the tangent at the points.
    """
    made = _biarcs(rows, start, end)
    p, t = rows.points[start], rows.tangents[start]
    begin = np.array([p, made.joint])
    chord = np.array([made.joint - p, rows.points[end] - made.joint])
    square = np.maximum(chord.real**2 + chord.imag**2, np.finfo(float).tiny)
    # the tangent at the joint is the start tangent mirrored at the chord
    back = np.array([np.conj(t), t * np.conj(chord[0]) ** 2 / square[0]])
    bend = 2 * (chord * back).imag / square

    def away(index: Ints, of: Ints) -> Array:
        points = checks.points[index]
        beyond = ((points - made.joint[of]) * back[1, of]).real >= 0
        side = (beyond & ~made.single[of]).astype(np.int64)
        return off_circle((points - begin[side, of]) * back[side, of], bend[side, of])

    fails = made.fails | (np.abs(turned[end] - turned[start]) > MAX_TURN)
    stop = np.where(fails, 0, checks.place[end])
    return np.where(fails, np.inf, largest(away, checks.place[start] + 1, stop))
