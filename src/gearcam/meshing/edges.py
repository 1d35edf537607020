"""First touch: how far the driven wheel can turn until flanks or their ends, the edges, touch.

Where flanks share a tangent, `gearcam.gears.normals` knows it without a search. This is for the
phases in which none do, and for wheels whose teeth are not evenly spaced.

With wheel 1 held at a phase, the points of a driver's flank and those of its mate are compared at
equal heights seen from what guides the driven wheel (see `gearcam.gears.guide`): the angle
between them is what it may turn until these points meet; of a rack, the way that it may move. The
extreme over the common range of heights is the touch of the pair, where the flanks share a tangent
or at the end of one of them (an edge). The driven wheel lies between the largest of these turns on
the driving side and the smallest on the other: the first is its transmission error, the difference
its backlash. Negative backlash means that the pair cannot be assembled.

Flanks only: that an edge meets the mate's fillet is seen by the stepwise overlap.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gearcam.gears.contact import FlankPairs
from gearcam.gears.track import WHEELS, Wheel
from gearcam.meshing.contact import Contacts
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.roots import bracketed_root, newton_in_bracket

_SAMPLES = 13
"""Points of a flank between which the extreme is sought: on a smooth flank there is one."""

_FOUND = 1e-14
"""Driver angle, rad, to which a point of a given height is found: rounding, so that the turns of
points compared differ by no more."""

_EXTREME = 1e-10
"""Driver angle, rad, to which an extreme is found: the turn there changes with its square."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Facing:
    """Pairs of flanks at phases, compared at equal heights.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    step, pair : (n,) int arrays
        Number of the phase; j.
    phi1 : (n,) array, rad
        Phase.
    """

    pairs: FlankPairs
    step: Ints
    pair: Ints
    phi1: Array

    def select(self, index: Mask | Ints) -> Facing:
        """Return some of the pairs, by `index`."""
        return Facing(
            pairs=self.pairs, step=self.step[index], pair=self.pair[index], phi1=self.phi1[index]
        )

    def end(self, wheel: Wheel, tip: bool) -> Array:
        """Return the driver angles, rad, of the ends (`tip` or root) of a `wheel`'s flanks."""
        toothing = self.pairs.toothings[wheel - 1]
        sigma = self.pairs.sigma(wheel)
        reach = self.pairs.reach(wheel, self.pair)[int(tip)]
        return toothing.track.angle(self._places[wheel - 1] - sigma * reach)

    def flank(self, wheel: Wheel, angle: Array, *, moving: bool) -> tuple[Plane, Plane]:
        """Return points seen from the driven wheel's guide and directions of a wheel's flanks.

        Parameters
        ----------
        wheel : {1, 2}
            Driver or driven wheel.
        angle : (n,) array, rad
            Driver angles that name the points.
        moving : bool
            Whether the directions are derivatives by `angle` instead of unit vectors.

        Returns
        -------
        points, directions : (n,) complex arrays
            With the wheels turned to their phases, mm and 1 (or mm/rad).
        """
        toothing = self.pairs.toothings[wheel - 1]
        sigma = self.pairs.sigma(wheel)
        frames, sf = toothing.frames(angle, curved=moving), self._places[wheel - 1]
        point = toothing.flank_points(frames, sf, sigma)
        if moving:
            direction = toothing.flank_motion(frames, sf, sigma)
        else:
            direction = toothing.turn * toothing.normals(frames, sigma)
        turn, offset = self._stands[wheel - 1]
        return point * turn + offset, direction * turn

    @cached_property
    def _places(self) -> tuple[Array, Array]:
        return self.pairs.place(1, self.pair), self.pairs.place(2, self.pair)

    @cached_property
    def _stands(self) -> tuple[tuple[Plane, Plane | float], tuple[Plane, Plane]]:
        driver = np.exp(-1j * self.phi1)
        return (driver, -self.pairs.distance), self.pairs.guide.stand(self.phi1, 0.0)

    def find(self, wheel: Wheel, height: Array, low: Array, high: Array, start: Array) -> Array:
        """Return the driver angles, rad, of flank points of given heights.

        Parameters
        ----------
        wheel : {1, 2}
            Driver or driven wheel.
        height : (n,) array, mm
            Heights.
        low, high : (n,) arrays, rad
            Angles of flank points that are lower and higher.
        start : (n,) array, rad
            First guess.

        Returns
        -------
        (n,) array
            The nearer end where a height is not reached.
        """
        guide = self.pairs.guide

        def miss(angle: Array) -> tuple[Array, Array]:
            point, direction = self.flank(wheel, angle, moving=True)
            return guide.height(point) - height, guide.rates(point, direction)[0]

        start = np.clip(start, np.minimum(low, high), np.maximum(low, high))
        return newton_in_bracket(miss, low, high, start, _FOUND)

    def compare(self, angle: Array, root: Array, tip: Array) -> tuple[Array, Array]:
        """Compare flanks at points of the driver's.

        Parameters
        ----------
        angle : (n,) array, rad
            Driver angles that name the points.
        root, tip : (n,) arrays, rad
            Ends of the mates' flanks.

        Returns
        -------
        turn, slope : (n,) arrays, rad (of a rack mm) and their change by the height
            The driven wheel's turn until it meets the points, and its derivative.
        """
        point, direction = self.flank(1, angle, moving=False)
        mate = self.find(2, self.pairs.guide.height(point), root, tip, angle)
        other, along = self.flank(2, mate, moving=False)
        rise, turn = self.pairs.guide.rates(point, direction)
        mates, turned = self.pairs.guide.rates(other, along)
        return self.pairs.guide.turn(point, other), turn / rise - turned / mates


@dataclass(frozen=True, eq=False, kw_only=True)
class Touches:
    """Where the flanks of pairs come nearest at phases, one entry a pair that faces its mate.

    Parameters
    ----------
    step, pair : (n,) int arrays
        Number of the phase; j.
    turn : (n,) array, rad, of a rack mm
        The driven wheel's turn from its nominal place at which the pair touches: it must lie above
        on the driving side and below on the other.
    edge : (n,) bool array
        Whether an end of a flank touches first.
    """

    step: Ints
    pair: Ints
    turn: Array
    edge: Mask


def _facing(pairs: FlankPairs, phi1: Array) -> tuple[Facing, Array, Array]:
    """Find the pairs that share a range of heights at phases, rad.

    Returns them with the driver angles, rad, of the range's ends on the driver, root first.
    """
    step, pair = pairs.beside(phi1)
    every = Facing(pairs=pairs, step=step, pair=pair, phi1=phi1[step])
    height = pairs.guide.height
    ends = [every.end(1, tip=False), every.end(1, tip=True)]
    mates = [every.end(2, tip=True), every.end(2, tip=False)]
    own, other = (
        [height(every.flank(wheel, angle, moving=False)[0]) for angle in angles]
        for wheel, angles in zip(WHEELS, (ends, mates), strict=True)
    )
    highest, lowest = np.minimum(own[0], other[0]), np.maximum(own[1], other[1])
    apart = np.abs(pairs.place(1, pair) - pairs.track.arc_length(every.phi1))
    shared = (highest > lowest) & (apart < 2.0 * pairs.pitch)
    found = every.select(shared)
    low, high = ends[0][shared], ends[1][shared]
    return (
        found,
        found.find(1, highest[shared], high, low, low),
        found.find(1, lowest[shared], high, low, high),
    )


def touches(pairs: FlankPairs, phi1: ArrayLike) -> Touches:
    """Return where the flanks of a side come nearest at phases `phi1`, rad."""
    found, low, high = _facing(pairs, np.atleast_1d(np.asarray(phi1, dtype=float)))
    root, tip = found.end(2, tip=False), found.end(2, tip=True)
    many = found.select(np.repeat(np.arange(len(low)), _SAMPLES))
    share = np.tile(np.linspace(0.0, 1.0, _SAMPLES), len(low))
    angle = np.repeat(low, _SAMPLES) + share * np.repeat(high - low, _SAMPLES)
    turn, slope = many.compare(angle, np.repeat(root, _SAMPLES), np.repeat(tip, _SAMPLES))
    # On the driving side the largest turn counts, on the other the smallest.
    turn, slope, angle = (v.reshape(-1, _SAMPLES) for v in (-pairs.side * turn, slope, angle))
    rows, best = np.arange(len(low)), turn.argmax(axis=1)
    # heights fall from root to tip of the driver's flank: there the extreme lies where the slope,
    # taken towards the tip, turns from rising to falling.
    falling = pairs.side * slope
    before, after = np.maximum(best - 1, 0), np.minimum(best + 1, _SAMPLES - 1)
    left = np.where(falling[rows, best] > 0.0, best, before)
    right = np.where(falling[rows, best] > 0.0, after, best)
    inner = np.flatnonzero((falling[rows, left] > 0.0) & (falling[rows, right] <= 0.0))
    extreme, some = turn[rows, best], found.select(inner)
    at = bracketed_root(
        lambda x: some.compare(x, root[inner], tip[inner])[1],
        angle[inner, left[inner]],
        angle[inner, right[inner]],
        _EXTREME,
    )
    extreme[inner] = -pairs.side * some.compare(at, root[inner], tip[inner])[0]
    return Touches(
        step=found.step,
        pair=found.pair,
        turn=-pairs.side * extreme,
        edge=~np.isin(rows, inner),
    )


def first_touch(pairs: FlankPairs, phi1: Array, found: Contacts) -> tuple[Array, Mask]:
    """Return how the driven wheel stands where a side touches first, and whether by an edge.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.
    found : Contacts
        The side's contacts at them.

    Returns
    -------
    lead : (n,) array, rad
        Turn from the nominal place (of a rack mm); infinite where nothing touches.
    edge : (n,) bool array
        Whether an end of a flank decides it.

    Notes
    -----
    Evenly spaced flanks of a side are parts of curves that touch all together, so that none of
    their ends can be ahead of a tangency. Elsewhere ends are searched.
    """
    outward = of_leading_pair(pairs.side, len(phi1), found.step, found.lead)
    searched = np.flatnonzero(~np.isfinite(outward)) if pairs.even else np.arange(len(phi1))
    some = touches(pairs, phi1[searched])
    step, turn = searched[some.step[some.edge]], some.turn[some.edge]
    ends = of_leading_pair(pairs.side, len(phi1), step, turn)
    return -pairs.side * np.maximum(outward, ends), ends > outward


def of_leading_pair(side: int, count: int, step: Ints, turn: Array) -> Array:
    """Return how far the leading tooth pair of a side pushes the driven wheel at each phase.

    Parameters
    ----------
    side : {-1, +1}
        sigma of the driver's flanks.
    count : int
        Number of phases.
    step : (n,) int array
        Phase of each touch.
    turn : (n,) array, rad
        The driven wheel's turn from its nominal place at it; of a rack mm.

    Returns
    -------
    (count,) array
        ``-side`` times the turn that decides; -inf where nothing touches.
    """
    outward = np.full(count, -np.inf)
    np.maximum.at(outward, step, -side * turn)
    return outward


def to_pitch_line(pairs: FlankPairs, phi1: Array) -> Array:
    """Return what turns of the driven wheel are along the pitch curve at phases, mm/rad.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.

    Returns
    -------
    (n,) array
        The driven radius times the cosine of the pitch line's slope; of a rack the cosine alone.
    """
    one, two = (toothing.frames(phi1, curved=False) for toothing in pairs.toothings)
    return -pairs.guide.lever(-np.abs(two.p).astype(complex), one.t * np.exp(-1j * phi1))
