"""Contours from curves: as few points as the tolerance allows, with measured chord error.

The error of a chord of length l on a curve of curvature kappa is ``kappa*l^2/8``. The points are
therefore spread evenly over ``J = integral of sqrt(kappa/(8*tolerance)) ds``, which is the least
number of chords, rounded up for each stretch between corners. Where the curvature jumps inside a
chord the error is measured, and the chord is halved if the error is too large.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple, Protocol

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.errors import ABOVE, beyond_limit
from gearcam.base.numerals import formatted
from gearcam.numeric.arrays import Array, Ints, Mask, Plane, divided
from gearcam.numeric.contour import Run
from gearcam.numeric.moments import halving

_PROBES = 24
"""Intervals per curve for the density of points."""

_MEASURED = 2.0
"""Largest factor by which measured errors may increase the number of chords."""

MOST = 1e6
"""Largest number of chords of a polygon: with many more, files do not fit into memory."""

FEWEST = 8
"""Least number of chords of a closed polygon, for any tolerance."""

_EIGHTHS = np.arange(1, 8) / 8.0
_QUARTERS = _EIGHTHS[1::2]
_AROUND = np.array([-3, -2, -1, 1, 2, 3]) / 32.0
"""Points inside a chord at which its error is measured: at a sharp bend the largest distance is a
peak."""

_FILL = 0.955
"""Share of the allowed chord length that is used: the density is known to a few percent only."""

_UNEVEN = 0.05
"""Relative change of curvature along a chord above which its error is measured."""

MARGIN = 0.97
"""Allowed measured error, as a share of the tolerance: between the points it may be larger."""

_FEW = 0.12
"""Share of chords that may be halved; beyond it all vertices are spread anew."""

_GRAIN = 1e-3
"""Distance, in tolerances, below which two points of a dense run are merged."""

_DENSE = 2.0
"""Largest chord error of dense points, in tolerances over the square of their number per chord:
with 8 a 32nd."""

_STRAIGHT = 16.0 * np.finfo(float).eps
"""Rounding of the angle between tangents, rad."""

_RISING = 1e-9
"""Number of chords assigned to a straight piece, so that J rises everywhere."""

_ROUNDS = 12
"""Halvings of a chord whose error is too large; each reduces it 4 times, or 2 times at a jump."""

_SAFE = 3.0
"""Error over the change by one halving. All further halvings add a fifteenth where steps are small,
and as much again on a step whose curvature is concentrated in a small part."""

_BACK = 0.5
"""Angle, rad, between both tangents and the reversed chord below which it is run backwards."""


class Curves(Protocol):
    """Curves in order, each beginning where the one before it ends."""

    @property
    def start(self) -> Array:
        """Parameter at the beginning of each curve, (n,)."""
        ...

    @property
    def end(self) -> Array:
        """Parameter at the end of each curve, (n,); it may be less than at the beginning."""
        ...

    @property
    def corner(self) -> Mask:
        """Whether each curve begins at a corner, (n,); if not it continues smoothly.

        The first one always does: on a smooth closed curve the only run begins and ends there.
        """
        ...

    @property
    def breaks(self) -> tuple[Ints, Array]:
        """Jumps of curvature inside curves: numbers of curves and parameters, (k,) each."""
        ...

    def at(self, index: Ints, parameter: Array) -> tuple[Plane, Plane]:
        """Return points, mm, and forward unit tangents of curves at parameters, all (k,)."""
        ...


class _Chords(NamedTuple):
    """Chords of a polygon.

    `counts` between corners, `vertices` by their J and their `points` (start and end), `errors`,
    the mask `rough` of uneven chords, and the share `bad` of chords with too large an error.
    """

    counts: Ints
    vertices: Array
    points: Plane
    errors: Array
    rough: Mask
    bad: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Sampler(ShortRepr):
    """Curves with the density of points that a tolerance needs.

    Parameters
    ----------
    curves : Curves
        In order.
    tolerance : float, mm
        Largest chord error.
    closed : bool
        Whether the last curve ends where the first begins.
    most : float
        Largest number of chords; more are refused.
    """

    curves: Curves
    tolerance: float
    closed: bool = True
    most: float = MOST

    @cached_property
    def probes(self) -> tuple[Plane, Plane]:
        """Points and tangents at even positions of every curve and at its ends, a row per curve."""
        count = len(self.curves.start)
        shares = np.tile(np.linspace(0.0, 1.0, _PROBES + 1), count)
        points, tangents = self._along(np.arange(count).repeat(_PROBES + 1), shares)
        return points.reshape(count, -1), tangents.reshape(count, -1)

    @cached_property
    def density(self) -> Array:
        """J from the start at ``_PROBES`` points per curve, rising; one more for the end."""
        points, tangents = self.probes
        turning = np.abs(np.angle(tangents[:, 1:] * np.conj(tangents[:, :-1])))
        turning[turning <= _STRAIGHT] = 0.0  # the square root of rounding would not be small
        chords = np.abs(np.diff(points, axis=1))
        steps = np.sqrt(turning * chords / (8.0 * self.tolerance)).ravel()
        steps += _RISING * max(1.0, float(steps.max()))
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def least(self) -> float:
        """The number of chords that the curvature needs: integral of sqrt(kappa/(8 tol)) ds."""
        return float(self.density[-1])

    def _along(self, index: Ints, share: Array) -> tuple[Plane, Plane]:
        start, end = self.curves.start[index], self.curves.end[index]
        return self.curves.at(index, start + share * (end - start))

    def _places(self, j: Array) -> tuple[Ints, Array]:
        """Return numbers of curves and positions on them, from 0 to 1, at given J."""
        place = np.interp(j, self.density, np.arange(len(self.density)) / _PROBES)
        index = np.minimum(place.astype(np.int64), len(self.curves.start) - 1)
        return index, place - index

    def curve_of(self, j: Array) -> Ints:
        """Return the numbers of the curves at given J (after a joint)."""
        return self._places(j)[0]

    def at(self, j: Array) -> tuple[Plane, Plane]:
        """Return points and forward unit tangents at given J (after a corner)."""
        return self._along(*self._places(j))

    @property
    def joints(self) -> Array:
        """J at the beginning of each curve, and at the end."""
        return self.density[::_PROBES]

    @cached_property
    def corners(self) -> Array:
        """J at the corners; the first is the start."""
        return self.joints[:-1][self.curves.corner]

    @cached_property
    def chords(self) -> tuple[Array, Plane, float]:
        """Vertices of the polygon: their J (start and end), points, and the measured error."""
        self._demand_few(self.least)
        made = self._spread(np.append(self.corners, self.least), self.density, self.density)
        for _ in range(_ROUNDS):
            if made.bad <= _FEW:
                break
            # the measured error of a chord, not the one predicted by J, sets its length
            steps = np.sqrt(made.errors / self.tolerance) + _RISING
            effort = np.concatenate([[0.0], np.cumsum(steps)])
            self._demand_few(float(effort[-1]) / _MEASURED)
            at_corners = np.interp(np.append(self.corners, self.least), made.vertices, effort)
            anew = self._spread(at_corners, effort, made.vertices, made.counts)
            if anew.bad >= made.bad:
                break
            made = anew
        vertices, points, errors, rough = made.vertices, made.points, made.errors, made.rough
        for _ in range(_ROUNDS):
            bad = errors > MARGIN * self.tolerance
            if not bad.any():
                break
            self._demand_few((len(errors) + int(bad.sum())) / _MEASURED)
            middles = 0.5 * (vertices[:-1] + vertices[1:])[bad]
            old = np.arange(len(errors)).repeat(1 + bad)
            new = np.flatnonzero(old[1:] == old[:-1]) + 1
            ends_of = np.append(old, len(errors))
            vertices, points = vertices[ends_of], points[ends_of]
            vertices[new] = middles
            errors, rough = errors[old], rough[old]
            halves = np.concatenate([new - 1, new])
            errors[halves] = self._measure(vertices, points, halves, rough[halves], new)
        return vertices, points[:-1] if self.closed else points, float(errors.max())

    def _demand_few(self, count: float) -> None:
        """Refuse tolerances that need too many chords."""
        if count > self.most:
            limit = self.tolerance * (count / self.most) ** 2
            key = "output.chord_tolerance_mm"
            what = f"the curve would need {formatted(count, 2)} chords"
            note = f"at the limit there are about {self.most:.0f}"
            raise beyond_limit(what, key, self.tolerance, limit, note, near=ABOVE * limit)

    def _spread(
        self, ends: Array, effort: Array, places: Array, least: Ints | None = None
    ) -> _Chords:
        """Return vertices spread evenly over `effort` (given at `places`) between `ends`.

        At `least` so many chords between corners: with fewer than before the iteration might
        oscillate.
        """
        counts = np.maximum(
            np.ceil(np.diff(ends) / _FILL).astype(int), 1 if least is None else least
        )
        if self.closed:
            counts *= math.ceil(FEWEST / counts.sum())
        vertices = np.interp(divided(ends, counts), effort, places)
        vertices[np.cumsum(counts)[:-1]] = self.corners[1:]
        at = self._ends(vertices)
        errors, rough = self._errors(vertices, at)
        bad = float(np.mean(errors > MARGIN * self.tolerance))
        return _Chords(counts, vertices, at[0], errors, rough, bad)

    def _ends(self, vertices: Array) -> Plane:
        """Points and tangents, (2, n), at the vertices; a closed polygon repeats the first."""
        if not self.closed:
            return np.stack(self.at(vertices))
        ends = np.stack(self.at(vertices[:-1]))
        return np.append(ends, ends[:, :1], axis=1)

    def _errors(self, vertices: Array, ends: Plane) -> tuple[Array, Mask]:
        """Distance of the curve from all chords, and which of them are rough.

        Where the curvature hardly changes it is the sagitta of the cubic with the end tangents.
        Elsewhere, and across the ends of curves and breaks, it is measured.
        """
        chord = np.diff(ends[0])
        rise, fall = chord * np.conj(ends[1, :-1]), ends[1, 1:] * np.conj(chord)
        length, some = np.abs(chord), chord != 0.0  # unknown for chords without length
        rise, fall = (np.divide(x.imag, x.real, where=some, out=0.0 * length) for x in (rise, fall))
        bend = rise + fall
        errors = length * np.abs(bend) / 8.0
        # compare the angles at both ends of a chord, and the curvatures of neighbouring chords
        rough = self._rough(vertices) | (np.abs(rise - fall) > _UNEVEN * np.abs(bend)) | ~some
        curvature = np.divide(bend, length, where=some, out=0.0 * length)
        jump = np.abs(np.diff(curvature)) > 2.0 * _UNEVEN * np.abs(curvature[1:])
        unsure = rough | np.append(jump, False) | np.append(False, jump)
        errors[unsure] = self._measure(vertices, ends[0], np.flatnonzero(unsure), rough[unsure])
        return errors, rough

    def _measure(
        self, vertices: Array, points: Plane, chords: Ints, rough: Mask, new: Ints | None = None
    ) -> Array:
        """Distance of the curve from some chords, measured at quarters, `rough` ones more finely.

        Those are measured at eighths and around the largest. A chord that only has uneven
        neighbours is smooth: its distance is flat near its largest. Also stores the `points` of the
        vertices `new`.
        """

        def places(number: Ints, share: Array) -> Array:
            k = chords[number]
            return vertices[k] + (vertices[k + 1] - vertices[k]) * share

        def off(number: Ints, seen: Plane) -> Array:
            away = seen - points[chords[number]]
            return np.abs(np.imag(np.conj(direction[number]) * away))

        new = np.empty(0, dtype=np.int64) if new is None else new
        care, plain = np.flatnonzero(rough), np.flatnonzero(~rough)
        number = np.concatenate([care.repeat(len(_EIGHTHS)), plain.repeat(len(_QUARTERS))])
        shares = [np.tile(_EIGHTHS, care.size), np.tile(_QUARTERS, plain.size)]
        wanted = np.concatenate([vertices[new], places(number, np.concatenate(shares))])
        points[new], seen = np.split(self.at(wanted)[0], [new.size])
        direction = points[chords + 1] - points[chords]
        direction /= np.maximum(np.abs(direction), np.finfo(float).tiny)
        eighths, quarters = np.split(off(number, seen), [shares[0].size])
        largest = np.empty(len(chords))
        largest[plain] = quarters.reshape(-1, len(_QUARTERS)).max(axis=1)
        if care.size:
            eighths = eighths.reshape(-1, len(_EIGHTHS))
            share = _EIGHTHS[eighths.argmax(axis=1)][:, None] + _AROUND
            number = care.repeat(len(_AROUND))
            around = off(number, self.at(places(number, share.ravel()))[0]).reshape(share.shape)
            largest[care] = np.maximum(eighths.max(axis=1), around.max(axis=1))
        return largest

    def _rough(self, vertices: Array) -> Mask:
        """Whether the curvature may jump inside chords: at ends of curves, and at breaks."""
        jumps = np.append(self.joints, self._breaks)
        chord = np.searchsorted(vertices, jumps, side="right") - 1
        inside = (chord < len(vertices) - 1) & (jumps > vertices[chord])
        rough = np.zeros(len(vertices) - 1, dtype=bool)
        rough[chord[inside]] = True
        return rough

    @cached_property
    def _breaks(self) -> Array:
        """J at the breaks inside curves."""
        index, parameter = self.curves.breaks
        start, end = self.curves.start[index], self.curves.end[index]
        share = (parameter - start) / (end - start)
        steps = np.arange(len(self.density)) / _PROBES
        return np.interp(index + share, steps, self.density)

    def dense(self, oversampling: int) -> Dense:
        """Return dense points.

        Parameters
        ----------
        oversampling : int
            Points per chord of the polygon.

        Returns
        -------
        Dense
            They include the vertices of the polygon, the ends of the curves, their joints, and the
            breaks: between two points the curvature is smooth.
        """
        vertices, least = self.chords[0], _DENSE / oversampling**2 * self.tolerance
        steps = np.arange(oversampling) / oversampling
        j = (vertices[:-1, None] + np.diff(vertices)[:, None] * steps).ravel()
        smooth = self.joints[:-1][~self.curves.corner]
        fixed = np.append(self.corners, self.least)
        groups = (fixed, smooth, self._breaks, j)
        rank = np.repeat(range(len(groups)), [len(group) for group in groups])
        j = np.concatenate(groups)
        order = np.lexsort((rank, j))
        j, rank = j[order], rank[order]
        points, tangents = self.at(j)
        for _ in range(_ROUNDS):
            long = np.flatnonzero(sags(points, tangents, rank) > least)
            if not long.size:
                break
            j = np.insert(j, long + 1, 0.5 * (j[long] + j[long + 1]))
            rank = np.insert(rank, long + 1, len(groups))
            new = long + 1 + np.arange(long.size)
            points, tangents = np.insert([points, tangents], long + 1, self.at(j[new]), axis=1)
        # before each corner the end of the curve there
        curve = np.searchsorted(self.joints, j[rank == 0][1:]) - 1
        ends = self.curves.at(curve, self.curves.end[curve])
        return Dense(j, points, tangents, rank, ends).merged(_GRAIN * self.tolerance)


@dataclass(frozen=True, eq=False)
class Dense(ShortRepr):
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

    def merged(self, grain: float) -> Dense:
        """Return points no nearer to each other than a `grain`, mm; all corners are kept."""
        kept = _merged(self.points, self.rank, grain)
        return replace(
            self,
            places=self.places[kept],
            points=self.points[kept],
            tangents=self.tangents[kept],
            rank=self.rank[kept],
        )

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
            made.append(Run(points=points, tangents=tangents, joints=tuple(joints)))
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


def _merged(points: Plane, rank: Ints, grain: float) -> Mask:
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
