"""Dense points of curves: the smooth runs through them, and the error of cubics through them.

Depends on contour and moments; numpy only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gearcam.base.display import Brief
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.bulges import as_pairs
from gearcam.numeric.contour import Run
from gearcam.numeric.moments import halving

_SAFE = 3.0
"""Error over the change by one halving. All further halvings add a fifteenth where steps are small,
and as much again on a step whose curvature is concentrated in a small part."""

_BACK = 0.5
"""Angle, rad, between both tangents and the reversed chord below which it is run backwards."""


@dataclass(frozen=True, eq=False)
class Dense(Brief):
    """Points of curves in order, with the ends of runs.

    Parameters
    ----------
    places : (n,) array
        Their positions, as the sampler's J.
    points, tangents : (n,) complex arrays, mm and 1
        At a corner those after it.
    rank : (n,) array of int
        0 for corners and both ends, 1 for joints (see `Run`), more for other points.
    ends : (points, tangents)
        Ends of runs, (runs,) complex arrays: before the corner.
    """

    places: Array
    points: Plane
    tangents: Plane
    rank: Ints
    ends: tuple[Plane, Plane]

    def told_apart(self, grain: float, sag: float) -> Dense:
        """Return points no nearer to each other than a grain; smaller roundings become corners.

        Parameters
        ----------
        grain : float, mm
            Least distance; all corners are kept.
        sag : float, mm
            Allowed deviation of a curve from the chord next to a rounding.

        Returns
        -------
        Dense
        """
        kept = _told_apart(self.points, self.rank, grain)
        points, tangents, rank = self.points[kept], self.tangents[kept], self.rank[kept]
        first, last = _clusters(self.points, kept)
        some = np.flatnonzero(first < last)
        turned = np.angle(self.tangents[last[some]] * np.conj(self.tangents[first[some]]))
        chords = np.abs(np.diff(points, prepend=points[0], append=points[-1]))
        longest = np.maximum(chords[some], chords[some + 1])
        sharp = some[0.25 * longest * np.abs(turned) > sag]
        before, made = tangents.copy(), rank.copy()
        before[sharp], tangents[sharp] = self.tangents[first[sharp]], self.tangents[last[sharp]]
        made[sharp] = 0
        ends = np.stack([points, before])
        # where no point before a corner is left out, its tangent on that side is known
        known = rank == 0
        known[sharp] &= kept[first[sharp]]
        ends[:, np.flatnonzero(known)[1:]] = np.stack(self.ends)[:, known[rank == 0][1:]]
        corners = np.flatnonzero(made == 0)[1:]
        return Dense(self.places[kept], points, tangents, made, tuple(ends[:, corners]))

    def _stretches(self) -> Iterator[tuple[slice, Plane, Plane]]:
        """Yield the numbers of each run's steps, and its points and tangents."""
        cuts = np.flatnonzero(self.rank == 0)
        for (start, end), point, tangent in zip(pairwise(cuts.tolist()), *self.ends, strict=True):
            steps = slice(start, end)
            yield (
                steps,
                np.append(self.points[steps], point),
                np.append(self.tangents[steps], tangent),
            )

    def runs(self, reverse: bool = False) -> tuple[Run, ...]:
        """Return the smooth runs between corners, with `reverse` in the opposite sense."""
        made = []
        for steps, points, tangents in self._stretches():
            joints = np.flatnonzero(self.rank[steps] == 1).tolist()
            made.append(
                Run(points=as_pairs(points), tangents=as_pairs(tangents), joints=tuple(joints))
            )
        return tuple(run.reversed for run in made[::-1]) if reverse else tuple(made)

    def missed(self, at: Callable[[Array], tuple[Plane, Plane]]) -> float:
        """Return a bound of the area between the curves and the cubics through the points, mm^2.

        Parameters
        ----------
        at : callable
            The sampler's points and tangents at places.

        Returns
        -------
        float
            From the change when every step is halved. Steps of a steep curve have very different
            lengths, so that leaving out every second point would not give the error of the longest.
        """
        points, tangents = at(0.5 * (self.places[:-1] + self.places[1:]))
        return _SAFE * sum(
            halving(own, ends, points[steps], tangents[steps])
            for steps, own, ends in self._stretches()
        )


def _told_apart(points: Plane, rank: Ints, grain: float) -> Mask:
    """Return a choice of points no nearer to each other than a grain; lowest ranks are kept.

    Parameters
    ----------
    points : (n,) complex array, mm
        In order.
    rank : (n,) array of int
        Points of rank 0, the corners, are all kept.
    grain : float, mm
        Least distance.

    Returns
    -------
    (n,) array of bool
        Mask of the points kept.
    """
    kept = np.ones(len(points), dtype=bool)
    while True:
        index = np.flatnonzero(kept)
        near = np.flatnonzero(np.abs(np.diff(points[index])) <= grain)
        one, two = index[near], index[near + 1]
        drop = np.where(rank[one] > rank[two], one, two)
        drop = drop[rank[drop] > 0]
        if drop.size == 0:
            return kept
        kept[drop] = False


def _clusters(points: Plane, kept: Mask) -> tuple[Ints, Ints]:
    """Return the first and the last of the points that each kept one represents.

    These are itself, and the omitted points next to it to which it is the nearer one.
    """
    index, gone = np.flatnonzero(kept), np.flatnonzero(~kept)
    high = np.searchsorted(index, gone)
    before, after = (np.abs(points[gone] - points[index[side]]) for side in (high - 1, high))
    owner = np.where(after < before, high, high - 1)
    first, last = index.copy(), index.copy()
    np.minimum.at(first, owner, gone)
    np.maximum.at(last, owner, gone)
    return first, last


def sags(points: Plane, tangents: Plane, rank: Ints) -> Array:
    """Return approximate distances of curves from the chords between dense points.

    Parameters
    ----------
    points, tangents : (n,) complex arrays, mm and 1
        At a corner those after it.
    rank : (n,) array of int
        As in `Dense`: before a corner only the tangent at the start of the chord counts.

    Returns
    -------
    (n - 1,) array, mm
    """
    chord = np.diff(points)
    before = np.abs(np.angle(chord * np.conj(tangents[:-1])))
    after = np.abs(np.angle(tangents[1:] * np.conj(chord)))
    bow: Array = np.maximum(before, np.where(rank[1:] == 0, 0.0, after))
    back = np.pi - np.minimum(before, after)  # undercut stretches run against their tangents
    return 0.25 * np.abs(chord) * np.where(back < _BACK, back, bow)
