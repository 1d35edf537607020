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

import numpy as np
from numpy.typing import ArrayLike

from gearcam.gears.contact import FlankPairs
from gearcam.gears.track import WHEELS
from gearcam.meshing.contact import Contacts
from gearcam.meshing.placed_flanks import PlacedFlanks
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.roots import bracketed_root

_SAMPLES = 13
"""Points of a flank between which the extreme is sought: on a smooth flank there is one."""

_FOUND = 1e-14
"""Driver angle, rad, to which a point of a given height is found: rounding, so that the turns of
points compared differ by no more."""

_EXTREME = 1e-10
"""Driver angle, rad, to which an extreme is found: the turn there changes with its square."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Facing(PlacedFlanks):
    """Pairs of flanks at phases, seen from the driven wheel's guide, compared at equal heights."""

    def heights(self, points: Plane, directions: Plane) -> tuple[Array, Array]:
        """Return the heights of points, mm, and how they grow in directions."""
        guide = self.pairs.guide
        return guide.height(points), guide.rates(points, directions)[0]

    def compare(self, angle: Array) -> tuple[Array, Array]:
        """Compare flanks at points of the driver's.

        Parameters
        ----------
        angle : (n,) array, rad
            Driver angles that name the points.

        Returns
        -------
        turn, slope : (n,) arrays, rad (of a rack mm) and their change by the height
            The driven wheel's turn until it meets the points, and its derivative.
        """
        guide, (point, direction) = self.pairs.guide, self.at(1, angle, unit=True)
        height = guide.height(point)
        mate = self.find(2, self.heights, height, self.ends[1], angle, _FOUND)
        other, along = self.at(2, mate, unit=True)
        rise, turn = guide.rates(point, direction)
        mates, turned = guide.rates(other, along)
        return guide.turn(point, other), turn / rise - turned / mates


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
    turn, offset = pairs.guide.stand(pairs.guide.nominal(phi1)[step])
    every = Facing(
        pairs=pairs,
        step=step,
        pair=pair,
        turn=np.stack([np.exp(-1j * phi1[step]), turn]),
        offset=np.stack([np.full_like(offset, -pairs.distance), offset]),
    )
    # seen from the guide heights fall from root to tip of the driver's flank
    (highest, lowest), (root, tip) = (
        [pairs.guide.height(every.at(wheel, end, unit=True)[0]) for end in ends]
        for wheel, ends in zip(WHEELS, every.ends, strict=True)
    )
    highest, lowest = np.minimum(highest, tip), np.maximum(lowest, root)
    apart = np.abs(every.sf[0] - pairs.track.arc_length(phi1)[step])
    shared = (highest > lowest) & (apart < 2.0 * pairs.pitch)
    found, height = every.select(shared), np.stack([highest, lowest])[:, shared]
    low, high = (
        found.find(1, found.heights, limit, found.ends[0, ::-1], own, _FOUND)
        for limit, own in zip(height, found.ends[0], strict=True)
    )
    return found, low, high


def touches(pairs: FlankPairs, phi1: ArrayLike) -> Touches:
    """Return where the flanks of a side come nearest at phases.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.

    Returns
    -------
    Touches
        Ordered by phase, then by pair.
    """
    found, low, high = _facing(pairs, np.atleast_1d(np.asarray(phi1, dtype=float)))
    many = found.select(np.repeat(np.arange(len(low)), _SAMPLES))
    angle = np.linspace(low, high, _SAMPLES, axis=1)
    turn, slope = (values.reshape(angle.shape) for values in many.compare(angle.ravel()))
    # on the driving side the largest turn counts, on the other the smallest
    turn = -pairs.side * turn
    rows, best = np.arange(len(low)), turn.argmax(axis=1)
    # the extreme lies where the slope, taken towards the driver's tip, turns from rising to falling
    falling = pairs.side * slope
    before, after = np.maximum(best - 1, 0), np.minimum(best + 1, _SAMPLES - 1)
    left = np.where(falling[rows, best] > 0.0, best, before)
    right = np.where(falling[rows, best] > 0.0, after, best)
    inner = np.flatnonzero((falling[rows, left] > 0.0) & (falling[rows, right] <= 0.0))
    extreme, some = turn[rows, best], found.select(inner)
    at = bracketed_root(
        lambda x: some.compare(x)[1],
        angle[inner, left[inner]],
        angle[inner, right[inner]],
        _EXTREME,
    )
    extreme[inner] = -pairs.side * some.compare(at)[0]
    return Touches(
        step=found.step, pair=found.pair, turn=-pairs.side * extreme, edge=~np.isin(rows, inner)
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
    ends = np.full(len(phi1), -np.inf)
    if searched.size:
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
    guide, one = pairs.guide, pairs.toothings[0].frames(phi1, curved=False)
    pitch_point = (np.abs(one.p) - guide.place).astype(complex)
    return -guide.lever(pitch_point, one.t * np.exp(-1j * phi1))
