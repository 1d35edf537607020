"""Dense points of curves: the smooth runs through them, and what cubics through them miss.

Depends on contour and moments; numpy only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gearcam.display import Brief
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.bulges import as_pairs
from gearcam.numeric.contour import Run
from gearcam.numeric.moments import halving

_SAFE = 3.0
"""Over the change by one halving. All further ones are a fifteenth more where steps are small, and
once more as much on a step that bends in a small part of itself."""

_BACK = 0.5
"""Angle, rad, to the reverse of a chord below which both tangents tell that it is run backwards."""


@dataclass(frozen=True, eq=False)
class Dense(Brief):
    """Points of curves in order, and which of them end runs.

    Parameters
    ----------
    places : (n,) array
        Where they lie, as the sampler counts (its J).
    points, tangents : (n,) complex arrays, mm and 1
        At a corner those after it.
    rank : (n,) array of int
        0 of corners and both ends, 1 of joints (see `Run`), more of other points.
    ends : (points, tangents)
        Where runs end, (runs,) complex arrays: before the corner.
    """

    places: Array
    points: Plane
    tangents: Plane
    rank: Ints
    ends: tuple[Plane, Plane]

    def told_apart(self, grain: float, sag: float) -> Dense:
        """Return points of which no two are nearer than a grain; roundings within it are corners.

        Parameters
        ----------
        grain : float, mm
            Least distance; corners all stay.
        sag : float, mm
            How far a curve along the chord beside a rounding may go astray by its turn.

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
        # where nothing is left out before a corner it is known from that side
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
        """Return the smooth runs between corners, in `reverse` the other way."""
        made = []
        for steps, points, tangents in self._stretches():
            joints = np.flatnonzero(self.rank[steps] == 1).tolist()
            made.append(
                Run(points=as_pairs(points), tangents=as_pairs(tangents), joints=tuple(joints))
            )
        return tuple(run.reversed for run in made[::-1]) if reverse else tuple(made)

    def missed(self, at: Callable[[Array], tuple[Plane, Plane]]) -> float:
        """Return the area between the curves and the cubics through the points, mm^2, at most.

        Parameters
        ----------
        at : callable
            The sampler's points and tangents at places.

        Returns
        -------
        float
            From what halving changes of every step. Steps of a steep curve are of any lengths, so
            that leaving out every second point would say nothing of the longest.
        """
        points, tangents = at(0.5 * (self.places[:-1] + self.places[1:]))
        return _SAFE * sum(
            halving(own, ends, points[steps], tangents[steps])
            for steps, own, ends in self._stretches()
        )


def _told_apart(points: Plane, rank: Ints, grain: float) -> Mask:
    """Choose points in order so that no two are nearer than a grain; the lowest rank stays.

    Parameters
    ----------
    points : (n,) complex array, mm
        In order.
    rank : (n,) array of int
        Points of rank 0, the corners, all stay.
    grain : float, mm
        Least distance.

    Returns
    -------
    (n,) array of bool
        Which are kept.
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
    """Return the first and the last of the points that each kept one stands for.

    Itself, and of what is left out beside it that to which it is the nearer one.
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
    """Return how far curves leave the chords between dense points, about.

    Parameters
    ----------
    points, tangents : (n,) complex arrays, mm and 1
        At a corner those after it.
    rank : (n,) array of int
        As of `Dense`: before a corner only the tangent where the chord begins counts.

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
