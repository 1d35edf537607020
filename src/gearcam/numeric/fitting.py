"""Division of runs into the longest pieces that one curve can represent.

All runs are divided at once: each round tries one length on every run.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np

from gearcam.numeric.arrays import Array, Ints, Plane, in_groups
from gearcam.numeric.contour import Run
from gearcam.numeric.hermite import on_cubics

_AIM: Final = 0.985
"""Share of the predicted length that is tried: a little short, so that most trials succeed."""

_SPREAD: Final = np.array([1.0, 0.8, 0.92, 0.97, 1.03, 1.1, 1.3])
"""Lengths tried at once, over the predicted one."""

_FEW: Final = 8
"""Number of runs up to which that costs hardly more than one trial."""

_GROWTH: Final = 10.0
"""Largest growth of a length per trial: very small errors are useless for prediction."""


_CHECK_PART: Final = 0.02
"""Share of the tolerance by which a curve may deviate unnoticed between two check points."""

_REACH: Final = 3
"""Steps next to a bend over which a curve may continue its curvature."""

_SHARPER: Final = 2.0
"""Ratio of neighbouring curvatures above which a bend counts as uneven."""

_BLOCK: Final = 1 << 13
"""Points measured at once: their arrays stay in the processor's first cache."""

_LONE_CHECKS: Final = 16
"""Largest number of parts of a step that is longer than its neighbour: a curve that fits at the
step's ends may deviate between them."""

_MOST_CHECKS: Final = 50
"""Largest number of parts of a step: beyond, a run is too coarse for any number of check points."""


class RunPoints(NamedTuple):
    """Runs in sequence: points, mm, and unit tangents (n,), complex.

    The points of a run are those from its `first` to its `last`.
    """

    points: Plane
    tangents: Plane
    first: Ints
    last: Ints


def points_to_fit(runs: Sequence[Run], tolerance: float) -> RunPoints:
    """Return the points and tangents of runs, without repeated points.

    Parameters
    ----------
    runs : sequence of Run
        Smooth pieces, mm.
    tolerance : float, mm
        Tolerance of the fit.

    Returns
    -------
    RunPoints

    Raises
    ------
    ValueError
        If the tolerance is not positive, or a run is not finite or has fewer than two different
        points.
    """
    if not tolerance > 0:
        raise ValueError(f"the tolerance must be positive, not {tolerance}")
    points = np.concatenate([run.points for run in runs])
    tangents = np.concatenate([run.tangents for run in runs])
    if not (np.isfinite(points).all() and np.isfinite(tangents).all()):
        raise ValueError("points and tangents of a run must be finite")
    of = np.repeat(np.arange(len(runs)), [len(run.points) for run in runs])
    kept = np.append(True, (np.diff(points) != 0) | (np.diff(of) != 0))
    first = np.searchsorted(of[kept], np.arange(len(runs)))
    last = np.append(first[1:], kept.sum()) - 1
    if (last <= first).any():
        raise ValueError("a run needs at least two different points")
    return RunPoints(points[kept], tangents[kept], first, last)


class Checks(NamedTuple):
    """Check points: the points of runs, and more between them where they are sparse.

    `points`, mm, and unit `tangents` there, complex; `place` is the index among them of each point
    of the runs.
    """

    points: Plane
    tangents: Plane
    place: Ints


def turns(tangents: Plane) -> Array:
    """Return the angles between successive `tangents`, rad."""
    return np.angle(tangents[1:] * np.conj(tangents[:-1]))


def checks_of(rows: RunPoints, tolerance: float, *, even: bool) -> Checks:
    """Return the check points of a fit.

    Next to a sharp bend a fit may continue the bend's curvature over a long, flat step and deviate
    between its ends: such a step is divided as finely as the bend needs. A step longer than its
    neighbours is divided as well, or most of a curve would not be checked.

    Parameters
    ----------
    rows : RunPoints
        The runs.
    tolerance : float, mm
        Tolerance of the fit.
    even : bool
        Whether sparse steps of evenly curved parts are divided too.
    """
    points, tangents = rows.points, rows.tangents
    of = np.repeat(np.arange(len(rows.first)), rows.last - rows.first + 1)
    length = np.abs(np.diff(points))
    inside = of[1:] == of[:-1]
    bend = np.divide(np.abs(turns(tangents)), length, out=np.zeros_like(length), where=inside)
    sharpest, shortest = bend.copy(), np.full_like(length, np.inf)
    for away in range(1, _REACH + 1):
        beside = of[: -1 - away] == of[1 + away :]
        for near, far in (
            (slice(None, -away), slice(away, None)),
            (slice(away, None), slice(None, -away)),
        ):
            sharpest[near] = np.maximum(sharpest[near], np.where(beside, bend[far], 0.0))
            shortest[near] = np.minimum(shortest[near], np.where(beside, length[far], np.inf))
    if not even:
        sharpest[sharpest < _SHARPER * bend] = 0.0
    parts = np.ceil(length * np.sqrt(sharpest / (8 * _CHECK_PART * tolerance)))
    parts = np.maximum(parts, np.minimum(np.ceil(length / shortest), _LONE_CHECKS))
    parts = np.where(inside, np.clip(parts, 1, _MOST_CHECKS), 1).astype(np.int64)
    return _between(points, tangents, parts)


def _between(points: Plane, tangents: Plane, parts: Ints) -> Checks:
    """Return points with others between them, on cubics, a given number in each step."""
    place = np.append(0, np.cumsum(parts))
    index = np.repeat(np.arange(len(parts)), parts)
    number = np.arange(len(index)) - place[index]
    whole = np.append(index, len(parts))
    checks, slopes, inner = points[whole], tangents[whole], np.flatnonzero(number)
    share = number[inner] / parts[index[inner]]
    checks[inner], slopes[inner] = on_cubics(points, tangents, index[inner], share)
    return Checks(checks, slopes, place)


def largest(measure: Callable[[Ints, Ints], Array], low: Ints, high: Ints) -> Array:
    """Return the largest measure in each range.

    Parameters
    ----------
    measure : callable
        ``measure(index, of) -> (m,) array``, not negative: at indices `index` within the ranges
        `of`.
    low, high : (n,) int arrays
        The ranges: from `low` to below `high`.

    Returns
    -------
    (n,) array
        0 for an empty range.
    """
    count = np.maximum(high - low, 0)
    of, place = in_groups(count)
    found, some = np.zeros(len(low)), count > 0
    if of.size:
        index = low[of] + place
        parts = [slice(at, at + _BLOCK) for at in range(0, of.size, _BLOCK)]
        measured = np.concatenate([measure(index[part], of[part]) for part in parts])
        found[some] = np.maximum.reduceat(measured, np.flatnonzero(place == 0))
    return found


def longest_pieces(
    errors: Callable[[Ints, Ints], Array],
    rows: RunPoints,
    tolerance: float,
    order: int,
    near: float,
) -> tuple[Ints, Ints]:
    """Return runs divided into pieces, each as long as the tolerance allows.

    Parameters
    ----------
    errors : callable
        ``errors(start, end)``: errors of the fit of the pieces between points.
    rows : RunPoints
        The runs.
    tolerance : float
        Largest error; two neighbours may have more.
    order : int
        Power of a piece's length with which its error grows: each trial predicts the next one.
    near : float
        Relative tolerance of the length of the longest piece.

    Returns
    -------
    start, end : int arrays
        First and last points of the pieces, in order.
    """
    start, last = rows.first, rows.last
    pieces: list[tuple[Ints, Ints]] = []
    low, high, trial = start + 1, last, last
    while start.size:
        done = high - low <= near * (low - start)
        if done.any():
            pieces.append((start[done], low[done]))
            trial = np.where(done, 2 * low - start, trial)
            start = np.where(done, low, start)
            left = start < last
            start, last, low, high, trial = (one[left] for one in (start, last, low, high, trial))
            done = done[left]
            low, high = np.where(done, start + 1, low), np.where(done, last, high)
            continue
        # a prediction outside the bracket is useless: the middle is tried instead
        inside = (trial > low) & ((trial < high) | (high == last))
        trial = np.where(inside, np.minimum(trial, high), (low + high + 1) // 2)
        spread = _SPREAD[:, None] if start.size <= _FEW else np.ones((1, 1))
        tried = start + np.rint(spread * (trial - start)).astype(np.int64)
        tried = np.minimum(np.maximum(tried, low + 1), high)
        error = errors(np.tile(start, len(spread)), tried.ravel()).reshape(tried.shape)
        fits = error <= tolerance
        low = np.where(fits, tried, low).max(axis=0)
        high = np.where(fits | (tried < low), high, tried - 1).min(axis=0)
        # predict from the longest that fits, or else from the shortest
        best = np.where(fits, tried, -tried).argmax(axis=0), np.arange(start.size)
        error, trial = error[best], tried[best]
        growth = (tolerance / np.maximum(error, tolerance / _GROWTH**order)) ** (1 / order)
        high = np.where((trial == low) & (growth <= 1 + near), low, high)
        trial = start + np.rint(_AIM * growth * (trial - start)).astype(np.int64)
    starts, ends = (np.sort(np.concatenate(one)) for one in zip(*pieces, strict=True))
    return starts, ends
