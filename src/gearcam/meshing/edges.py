"""First contact: how far the driven wheel can turn until flanks or their ends, the edges, touch.

Where flanks share a tangent, `gearcam.gears.contact` solves for it directly. This module is for
phases in which none do, and for wheels whose teeth are not evenly spaced.

With wheel 1 held at a phase, points of a driver's flank and of its mate are compared at equal
heights relative to the guide of the driven wheel (see `gearcam.gears.rolling`): the angle between
them is the turn that brings these points together; for a rack, the travel. The extreme over the
common range of heights is the first contact of the pair, where the flanks share a tangent or at the
end of one of them (an edge). The driven wheel lies between the largest of these turns on the
driving side and the smallest on the other: the first is its transmission error, the difference its
backlash. Negative backlash means that the pair cannot be assembled.

Flanks only: contact of an edge with the mate's fillet is found by the stepwise overlap.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcam.gears.contact import FlankPairs, touch
from gearcam.gears.track import WHEELS, Wheel
from gearcam.meshing.contact import Contacts
from gearcam.meshing.placed_flanks import PlacedFlanks
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.roots import bracketed_root

_SAMPLES = 13
"""Points of a flank that bracket the extreme: a smooth flank has one."""

_FOUND = 1e-14
"""Tolerance, rad, of the driver angle of a point of given height: rounding, so that compared turns
differ by no more."""

_EXTREME = 1e-10
"""Tolerance, rad, of the driver angle of an extreme: the turn changes with its square."""

_ROUNDING = 1e-12
"""Rounding of the driver angle at the end of a lobe, as a share of it."""

_ROUNDINGS = 8.0
"""Rounding of a lead over that of one operation: four times the most found in any design."""

_LEAST_LEVER = 1e-3
"""Least lever arm of a normal over that of the pitch line, where the rounding is estimated."""

_TIP = 1
"""Place of the tip among the ends of a flank."""

_BETWEEN = np.linspace(0.02, 0.98, 9)
"""Positions in a stretch, as shares of it, at which edge contact is tested."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Facing(PlacedFlanks):
    """Pairs of flanks at phases, compared at equal heights relative to the driven wheel's guide."""

    def heights(self, points: Plane, directions: Plane) -> tuple[Array, Array]:
        """Return the heights of points, mm, and their derivatives along directions."""
        guide = self.pairs.guide
        return guide.height(points), guide.rates(points, directions)[0]

    def level(self, wheel: Wheel, height: Array, start: Array) -> Array:
        """Return points of a wheel's flanks at heights: their driver angles, rad.

        Parameters
        ----------
        wheel : {1, 2}
            Driver or driven wheel.
        height : (n,) array, mm
            The heights.
        start : (n,) array, rad
            First guess.

        Returns
        -------
        (n,) array
            The nearer end where a flank does not reach the height.
        """
        # they rise from root to tip of the driven flank, and fall on the driver's
        rising = self.ends[1] if wheel == 2 else self.ends[0, ::-1]
        return self.find(wheel, self.heights, height, rising, start, _FOUND)

    def compare(self, angle: Array) -> tuple[Array, Array]:
        """Return the turn between flanks at points of the driver's.

        Parameters
        ----------
        angle : (n,) array, rad
            Driver angles of the points.

        Returns
        -------
        turn, slope : (n,) arrays, rad (for a rack mm) and the same per mm of height
            The driven wheel's turn until it meets the points, and its derivative by height.
        """
        guide, (point, direction) = self.pairs.guide, self.at(1, angle, unit=True)
        height = guide.height(point)
        mate = self.level(2, height, angle)
        other, along = self.at(2, mate, unit=True)
        rise, turn = guide.rates(point, direction)
        mates, turned = guide.rates(other, along)
        return guide.turn(point, other), turn / rise - turned / mates


@dataclass(frozen=True, eq=False, kw_only=True)
class Touches:
    """First contacts of pairs of flanks at phases, one entry per pair with common heights.

    Parameters
    ----------
    step, pair : (n,) int arrays
        Number of the phase; j.
    turn : (n,) array, rad, for a rack mm
        The driven wheel's turn from its nominal position at which the pair touches: a lower bound
        of its position on the driving side, an upper bound on the other.
    edge : (n,) bool array
        Whether an end of a flank touches first.
    """

    step: Ints
    pair: Ints
    turn: Array
    edge: Mask


def facing(pairs: FlankPairs, phi1: Array) -> tuple[Facing, Array]:
    """Return the pairs that share a range of heights at phases, the driven wheel at its nominal.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.

    Returns
    -------
    found : Facing
        k pairs, ordered by phase, then by pair.
    heights : (2, 2, k) array, mm
        Heights of root and tip of both flanks.
    """
    step, pair = pairs.beside(phi1)
    every = placed(pairs, phi1, step, pair)
    heights = heights_of(every)
    apart = np.abs(every.sf[0] - pairs.track.arc_length(phi1)[step])
    shared = common(heights) & (apart < 2.0 * pairs.pitch)
    return every.select(shared), heights[..., shared]


def placed(pairs: FlankPairs, phi1: Array, step: Ints, pair: Ints) -> Facing:
    """Return pairs at phases, the driven wheel at its nominal position.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.
    step, pair : (k,) int arrays
        Numbers of phases; j.

    Returns
    -------
    Facing
    """
    pose = pairs.guide.pose(pairs.guide.nominal(phi1)[step])
    return Facing(
        pairs=pairs,
        step=step,
        pair=pair,
        turn=np.stack([np.exp(-1j * phi1[step]), pose.rotation]),
        offset=np.stack([np.full_like(pose.shift, -pairs.distance), pose.shift]),
    )


def heights_of(faced: Facing) -> Array:
    """Return the heights of root and tip of both flanks of n pairs, (2, 2, n) mm."""
    return np.stack(
        [
            [faced.pairs.guide.height(faced.at(wheel, end, unit=True)[0]) for end in ends]
            for wheel, ends in zip(WHEELS, faced.ends, strict=True)
        ]
    )


def common(heights: Array) -> Mask:
    """Return which pairs share a range of `heights`, (2, 2, n) mm."""
    (highest, lowest), (root, tip) = heights
    return np.minimum(highest, tip) > np.maximum(lowest, root)


def touches(pairs: FlankPairs, phi1: ArrayLike) -> Touches:
    """Return the first contacts of a side's pairs at phases.

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
    faced, ((highest, lowest), (root, tip)) = facing(
        pairs, np.atleast_1d(np.asarray(phi1, dtype=float))
    )
    # driver angles of the ends of the common heights, root of the driver first
    low, high = (
        faced.level(1, limit, own)
        for limit, own in zip(
            (np.minimum(highest, tip), np.maximum(lowest, root)), faced.ends[0], strict=True
        )
    )
    many = faced.select(np.repeat(np.arange(len(low)), _SAMPLES))
    angle = np.linspace(low, high, _SAMPLES, axis=1)
    turn, slope = (values.reshape(angle.shape) for values in many.compare(angle.ravel()))
    # on the driving side the largest turn counts, on the other the smallest
    turn = -pairs.side * turn
    rows, best = np.arange(len(low)), turn.argmax(axis=1)
    # at the extreme the slope towards the driver's tip changes from positive to negative
    falling = pairs.side * slope
    before, after = np.maximum(best - 1, 0), np.minimum(best + 1, _SAMPLES - 1)
    left = np.where(falling[rows, best] > 0.0, best, before)
    right = np.where(falling[rows, best] > 0.0, after, best)
    inner = np.flatnonzero((falling[rows, left] > 0.0) & (falling[rows, right] <= 0.0))
    extreme, some = turn[rows, best], faced.select(inner)
    at = bracketed_root(
        lambda x: some.compare(x)[1],
        angle[inner, left[inner]],
        angle[inner, right[inner]],
        _EXTREME,
    )
    extreme[inner] = -pairs.side * some.compare(at)[0]
    return Touches(
        step=faced.step, pair=faced.pair, turn=-pairs.side * extreme, edge=~np.isin(rows, inner)
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class EndsMeeting:
    """Ends of flanks at the heights of the mate's flank, one entry each.

    Parameters
    ----------
    faced : Facing
        The pairs: n entries, some pairs more than once.
    edge_of : (n,) int array
        The wheel of the end.
    tip : (n,) bool array
        Whether the end is the tip.
    angles : (2, n) array, rad
        Driver angles of the points that meet, on driver and driven wheel.
    points, directions : (2, n) complex arrays, mm and 1
        These points, and unit vectors along the flanks, at the nominal position of the driven
        wheel, relative to its guide.
    """

    faced: Facing
    edge_of: Ints
    tip: Mask
    angles: Array
    points: Plane
    directions: Plane

    @cached_property
    def turn(self) -> Array:
        """The driven wheel's turn from its nominal position until they meet, (n,), rad or mm."""
        return self.faced.pairs.guide.turn(*self.points)


def ends_meeting(pairs: FlankPairs, phi1: Array) -> EndsMeeting:
    """Return where the ends of a side's flanks meet the mate's flank.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.

    Returns
    -------
    EndsMeeting
        Of each pair with common heights both ends of these.
    """
    return ends_of(*facing(pairs, phi1))


def ends_of(faced: Facing, heights: Array, upper: Mask | None = None) -> EndsMeeting:
    """Return where the ends of pairs of flanks meet the mate's flank.

    Parameters
    ----------
    faced : Facing
        n pairs.
    heights : (2, 2, n) array, mm
        Heights of root and tip of both flanks.
    upper : (n,) bool array, optional
        Which end of the common heights is asked for; both by default.

    Returns
    -------
    EndsMeeting
    """
    ends = [_ends(faced, heights, wheel, upper) for wheel in WHEELS]
    row, edge_of, tip, angles = (np.concatenate(each, axis=-1) for each in zip(*ends, strict=True))
    some = faced.select(row)
    (one, along), (two, other) = (
        some.at(wheel, angle, unit=True) for wheel, angle in zip(WHEELS, angles, strict=True)
    )
    return EndsMeeting(
        faced=some,
        edge_of=edge_of,
        tip=tip,
        angles=angles,
        points=np.stack([one, two]),
        directions=np.stack([along, other]),
    )


def _ends(
    faced: Facing, heights: Array, wheel: Wheel, upper: Mask | None
) -> tuple[Ints, Ints, Mask, Array]:
    """Return the ends of a wheel's flanks at heights of the mate's flank.

    Parameters
    ----------
    faced : Facing
        Pairs.
    heights : (2, 2, n) array, mm
        Heights of root and tip of both flanks.
    wheel : {1, 2}
        The wheel.
    upper : (n,) bool array, optional
        See `ends_of`.

    Returns
    -------
    row : (k,) int array
        Numbers of the pairs.
    edge_of : (k,) int array
        The wheel.
    tip : (k,) bool array
        Whether the end is the tip.
    angles : (2, k) array, rad
        Driver angles of the points that meet, on driver and driven wheel.
    """
    own, mate = heights[wheel - 1], heights[2 - wheel]
    there = (own >= mate.min(axis=0)) & (own <= mate.max(axis=0))
    if upper is not None:  # the driver's tips are low, the driven wheel's high
        there &= np.stack([upper, ~upper] if wheel == 1 else [~upper, upper])
    end, row = np.nonzero(there)
    angle, some = faced.ends[wheel - 1, end, row], faced.select(row)
    met = some.level(2 if wheel == 1 else 1, own[end, row], angle)
    angles = np.stack([angle, met] if wheel == 1 else [met, angle])
    return row, np.full(len(row), wheel), end == _TIP, angles


def first_touch(pairs: FlankPairs, phi1: Array, found: Contacts) -> tuple[Array, Mask]:
    """Return the driven wheel's lead at first contact of a side, and whether an edge touches.

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
        Turn from the nominal position (for a rack mm); infinite where nothing touches, 0 where it
        is less than what it is known to.
    edge : (n,) bool array
        Whether an end of a flank touches first.

    Notes
    -----
    Evenly spaced flanks of a side lie on curves that all touch together, so that no edge can be
    ahead of a tangency. Otherwise both ends of the common heights of each pair are tried: no flank
    can lie behind them, and one of them touches first if the pair has no common normal. Where the
    curvature jumps an end may be ahead of a common normal.
    """
    outward = of_leading_pair(pairs.side, len(phi1), found.step, found.lead)
    searched = np.flatnonzero(~np.isfinite(outward)) if pairs.even else np.arange(len(phi1))
    ends = np.full(len(phi1), -np.inf)
    if searched.size:
        met = ends_meeting(pairs, phi1[searched])
        ends = of_leading_pair(pairs.side, len(phi1), searched[met.faced.step], met.turn)
    lead = -pairs.side * np.maximum(outward, ends)
    return np.where(np.abs(lead) <= known_to(pairs, phi1), 0.0, lead), ends > outward


def of_leading_pair(side: int, count: int, step: Ints, turn: Array) -> Array:
    """Return the turn to which the leading tooth pair of a side pushes the driven wheel.

    Parameters
    ----------
    side : {-1, +1}
        sigma of the driver's flanks.
    count : int
        Number of phases.
    step : (n,) int array
        Phase of each touch.
    turn : (n,) array, rad
        The driven wheel's turn from its nominal position at the touch; for a rack mm.

    Returns
    -------
    (count,) array
        ``-side`` times the turn of the leading pair, by phase; -inf where nothing touches.
    """
    outward = np.full(count, -np.inf)
    np.maximum.at(outward, step, -side * turn)
    return outward


def to_pitch_line(pairs: FlankPairs, phi1: Array) -> Array:
    """Return arcs along the pitch curve per turn of the driven wheel at phases, mm/rad.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.

    Returns
    -------
    (n,) array
        The driven radius times the cosine of the pitch line's slope; for a rack the cosine alone.
    """
    guide, one = pairs.guide, pairs.wheels[0].toothing.frames(phi1, curved=False)
    pitch_point = (np.abs(one.p) - guide.place).astype(complex)
    return -guide.lever(pitch_point, one.t * np.exp(-1j * phi1))


def known_to(pairs: FlankPairs, phi1: Array) -> Array:
    """Return to how much the driven wheel's lead is known at phases: the rounding of its flanks.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.

    Returns
    -------
    (n,) array, rad (for a rack mm)
        Flanks are exact but for rounding: that of their coordinates, as large as the driver's
        centrode is long and the shafts are apart, and that of driver angles. It moves a flank along
        its normal, and so turns the driven wheel by as much over the lever arm of the normal.
    """
    return rounding_at(pairs, phi1).of(pairs)


class Rounding(NamedTuple):
    """To how much leads are known at phases (see `known_to`).

    Parameters
    ----------
    turned : (n,) array, mm
        Size of what the rounding of driver angles moves.
    share : (n,) array, rad/mm (for a rack 1)
        Lead per mm of size.
    """

    turned: Array
    share: Array

    def of(self, pairs: FlankPairs) -> Array:
        """Return to how much the lead is known of `pairs` of these wheels, as mounted."""
        return self.share * (pairs.track.length + abs(pairs.distance) + self.turned)


def rounding_at(pairs: FlankPairs, phi1: Array) -> Rounding:
    """Return to how much leads are known at phases, of any mounting of a side's wheels.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.
    """
    guide, frames = pairs.guide, pairs.wheels[0].toothing.frames(phi1, curved=False)
    foot, normal = pitch_points(pairs, phi1)
    lever = np.abs(guide.lever(foot, normal))
    # at a pressure angle of 90 deg the lever is 0
    least = _LEAST_LEVER * np.abs(guide.lever(foot, frames.t * np.exp(-1j * phi1)))
    turn = np.maximum(np.abs(phi1), 2.0 * np.pi)
    eps = _ROUNDINGS * np.finfo(float).eps
    return Rounding(turned=turn * frames.speed, share=eps / np.maximum(lever, least))


def pitch_points(pairs: FlankPairs, phi1: Array) -> tuple[Plane, Plane]:
    """Return the pitch points at phases, and the common normals of flanks as designed.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.

    Returns
    -------
    points, normals : (n,) complex arrays, mm and 1
        Relative to the guide of the driven wheel.
    """
    one = pairs.wheels[0].toothing
    frames = one.frames(phi1, curved=False)
    tangent = frames.t * np.exp(-1j * phi1)
    points = (np.abs(frames.p) - pairs.guide.place).astype(complex)
    return points, tangent * np.exp(-1j * pairs.side * one.cutter.alpha)


@dataclass(frozen=True, kw_only=True)
class NonContact:
    """A range of driver angles in which no flanks share a tangent.

    Parameters
    ----------
    start, end : float, rad
        Driver angles.
    edges : bool
        Whether ends of flanks touch, and so drive, all along it.
    apart : float, mm
        Largest deviation of the driven wheel, along its pitch curve, from its position with
        unlimited flanks.
    """

    start: float
    end: float
    edges: bool
    apart: float


def non_contact(pairs: FlankPairs) -> list[NonContact]:
    """Return the stretches of a lobe, or of an open pair's travel, in which no flanks touch.

    Parameters
    ----------
    pairs : FlankPairs
        The side.

    Returns
    -------
    list of NonContact
        In order.
    """
    start, end, carrying = pairs.arcs.stretches
    lobe = pairs.track.arc.period if pairs.closed and pairs.even else pairs.travel
    at = np.flatnonzero((carrying == 0) & (start < lobe * (1.0 - _ROUNDING)))
    phi1 = (start[at, None] + (end - start)[at, None] * _BETWEEN).ravel()
    if not phi1.size:
        return []
    found = touches(pairs, phi1)
    lead = -pairs.side * of_leading_pair(pairs.side, len(phi1), found.step, found.turn)
    any_pair = pairs.candidates(pairs.track.arc_length(phi1))[:, 0]
    free = touch(pairs, phi1, pairs.separation(any_pair))[0].lead
    apart = np.abs((lead - free) * to_pitch_line(pairs, phi1)).reshape(len(at), -1).max(axis=1)
    return [
        NonContact(start=low, end=high, edges=bool(np.isfinite(most)), apart=most)
        for low, high, most in zip(
            start[at].tolist(), end[at].tolist(), apart.tolist(), strict=True
        )
    ]
