"""How runs are cut into the longest pieces that one curve can stand for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeVar

import numpy as np

from gearcam.numeric.arrays import Plane
from gearcam.numeric.bulges import as_complex
from gearcam.numeric.contour import Run

Fitted = TypeVar("Fitted")

_AIM: Final = 0.97
"""Part of the predicted length that the search tries: a little short, so that most succeed."""

_GROWTH: Final = 10.0
"""Growth of a length from one trial to the next at most: very small errors predict nothing."""


def points_to_fit(run: Run, tolerance: float) -> tuple[Plane, Plane]:
    """Return a run's points and tangents, without repeated points.

    Parameters
    ----------
    run : Run
        A smooth piece, mm.
    tolerance : float, mm
        Of the fit.

    Returns
    -------
    points, tangents : (n,) complex arrays, mm and 1

    Raises
    ------
    ValueError
        If the tolerance is not positive, or the run is not finite or has fewer than two different
        points.
    """
    if not tolerance > 0:
        raise ValueError(f"the tolerance must be positive, not {tolerance}")
    points, tangents = as_complex(run.points), as_complex(run.tangents)
    if not (np.isfinite(points).all() and np.isfinite(tangents).all()):
        raise ValueError("points and tangents of a run must be finite")
    kept = np.append(True, np.diff(points) != 0)
    if kept.sum() < 2:
        raise ValueError("a run needs at least two different points")
    return points[kept], tangents[kept]


def longest_pieces(
    fit: Callable[[int, int], tuple[float, Fitted]],
    furthest: Callable[[int], int],
    last: int,
    tolerance: float,
    order: int,
    near: float,
) -> list[tuple[int, Fitted]]:
    """Cut a row of points into pieces, each as long as the tolerance allows.

    Parameters
    ----------
    fit : callable
        ``fit(start, end) -> (error, fitted)`` between two points.
    furthest : callable
        ``furthest(start) -> end``: where a piece must end, whatever its error.
    last : int
        Number of the last point.
    tolerance : float
        Largest error; two neighbours may have more.
    order : int
        Power of a piece's length with which its error grows: each trial predicts the next one.
    near : float
        The search stops where the longest piece is known to this part of its length.

    Returns
    -------
    list of (int, fitted)
        End of each piece, and what was fitted to it.
    """
    found: list[tuple[int, Fitted]] = []
    start, guess = 0, last
    while start < last:
        low, high, best = start + 1, furthest(start), fit(start, start + 1)[1]
        trial, rounds = start + guess, 0
        while high - low > near * (low - start):
            rounds += 1
            trial = min(max(trial, low + 1), high)
            error, fitted = fit(start, trial)
            if error <= tolerance:
                low, best = trial, fitted
            else:
                high = trial - 1
            growth = _AIM * (tolerance / max(error, tolerance / _GROWTH**order)) ** (1 / order)
            trial = start + round(growth * (trial - start)) if rounds % 3 else (low + high + 1) // 2
        found.append((low, best))
        start, guess = low, low - start
    return found
