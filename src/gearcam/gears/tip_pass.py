"""Tip interference (trochoid interference) of a wheel and a ring outside the mesh.

A tip corner of wheel 1, the upper end of a flank, enters a space of the ring some pitches before
its contact and leaves it some pitches after. Where it is level with a tip corner beside that space,
the arc length along the ring's centrode between the feet of both is the *tip-pass margin*, negative
where tips collide. Corners are traced over half a turn of wheel 1 in both directions, so that those
that enter the ring again elsewhere are found too. Rounded edges are taken as sharp.

A corner is computed only near its entry, its exit and its deepest point: if its distance from the
ring's tips at two rolls exceeds its largest movement between them, it neither enters nor leaves in
between.

On circles the margin is ``r2*(theta1*z1/z2 + inv(alpha_w) - inv(alpha_a2) - theta2)``.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gearcam.gears.flank import Toothing
from gearcam.gears.outline import Outline
from gearcam.gears.polar import PolarCurve
from gearcam.gears.tips import feet
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.roots import bracketed_root

_ROLLS = 4
"""Roll positions per pitch in the search for corners, which stay in a space for several pitches."""

_ANGLE = 1e-14
"""Tolerance of a crossing, in turns of the driver: feet are no more exact."""

_NEAR = 1e-6
"""Part of a turn over which a corner's path is taken as straight where it crosses a height."""

_DIGITS = 9
"""Digits by which margins, in pitches, are compared: of equal ones the first is reported."""

_FIRST = 16
"""Intervals into which the rolls of a corner are divided at first."""


class TipPass(NamedTuple):
    """The closest passage of a corner of wheel 1 and a tip corner of the ring.

    Parameters
    ----------
    margin : float, mm
        Along the ring's centrode; negative where tips collide, infinite where none come near.
    tooth : int
        Number of the tooth of wheel 1.
    sigma : float
        Its side: 1 where s is larger, else -1.
    phi1 : float, rad
        Driver angle.
    slope : float
        Movement of the corner along the centrode per unit of movement away from it; 0 for a
        passage at a fixed angle.
    """

    margin: float
    tooth: int
    sigma: float
    phi1: float
    slope: float = 0.0


class _Corners(NamedTuple):
    """Corners to trace: points, mm, tooth numbers, sides; (n,) each."""

    points: Plane
    tooth: Ints
    sigma: Array


def tip_pass(wheel: Outline, ring: Outline) -> TipPass:
    """Return the least tip-pass margin of a wheel in a ring.

    Parameters
    ----------
    wheel, ring : Outline
        Both outlines, with the ends of their flanks.

    Returns
    -------
    TipPass
        For closed wheels the first of those that repeat with the lobes.
    """
    own, edge = wheel.toothing, PolarCurve(ring.toothing, ring.toothing.cutter.addendum)
    corners = _corners(wheel, ring.toothing)
    stays = _follow(own, ring.toothing, corners, edge)
    margins, angles, crosses = _margins(own, ring, corners.points, edge, stays)
    if not np.isfinite(margins).any():
        return TipPass(math.inf, 0, 0.0, 0.0)
    worst = int(np.argmin(np.round(margins / own.pitch, _DIGITS)))
    corner, phi1 = stays.corner[worst % len(stays.corner)], float(angles[worst])
    slope = 0.0
    if crosses[worst]:
        beside = phi1 + _NEAR * own.track.around * np.array([-1.0, 1.0])
        along, height = _feet(own, ring.toothing, edge, corners.points[corner], beside)
        slope = abs(float(np.diff(along)[0] / np.diff(height)[0]))
    return TipPass(
        float(margins[worst]),
        int(corners.tooth[corner]),
        float(corners.sigma[corner]),
        phi1 % own.track.around if own.closed else phi1,
        slope,
    )


def _corners(wheel: Outline, mate: Toothing) -> _Corners:
    """Return the corners of whole teeth; for closed wheels those of one lobe."""
    own, tips = wheel.toothing, wheel.flanks.tips
    points = own.flank_points(own.frames(tips.phi, curved=False), *own.flanks)
    numbers = np.array(own.numbers)[own.whole]
    count = math.gcd(own.teeth, mate.teeth) if own.closed else len(numbers)
    return _Corners(
        own.of_teeth(points)[:, :count].ravel(),
        np.tile(numbers[:count], 2),
        np.repeat([1.0, -1.0], count),
    )


def _follow(own: Toothing, mate: Toothing, corners: _Corners, edge: PolarCurve) -> Stays:
    """Trace corners over half a turn to both sides of the middle of their tooth.

    Corners of an open wheel are traced over its whole travel.
    """
    half = math.ceil(0.5 * own.teeth) if own.closed else own.teeth
    count, each = 2 * half * _ROLLS + 1, len(corners.points) // 2
    rolls = np.arange(count + (each - 1) * _ROLLS) / _ROLLS - half
    s = float(own.tooth_places[own.whole][0]) + own.pitch * rolls
    phi = own.track.angle(s if own.closed else np.clip(s, 0.0, own.length))
    first = np.tile(_ROLLS * np.arange(each), 2)
    return find_stays(rolls_of(own, mate, phi), corners.points, first, count, edge)


def _margins(
    own: Toothing, ring: Outline, points: Plane, edge: PolarCurve, stays: Stays
) -> tuple[Array, Array, Mask]:
    """Return margins, mm, driver angles, rad, and a mask of height crossings, for all ends, (2n,).

    First relative to the tooth before the space, with its flank sigma = 1, then to the one after.
    """
    mate, tips = ring.toothing, ring.flanks.tips
    corner = np.tile(points[stays.corner], 2)
    deep, out = np.tile(stays.deep, 2), np.tile(stays.edge, 2)
    formed, side = len(mate.numbers), np.repeat([1.0, -1.0], len(stays.corner))

    def seen(phi: Array) -> tuple[Array, Array]:
        return _feet(own, mate, edge, corner, phi)

    start, low = seen(deep)
    space = np.round((start - mate.moved) / mate.pitch).astype(int)
    tooth = np.where(side > 0.0, space, space + 1) - mate.numbers[0]
    meets = np.full(tooth.shape, mate.closed) | ((tooth >= 0) & (tooth < formed))
    index = np.where(side > 0.0, 0, formed) + tooth % formed
    height = tips.height[index]
    low, high = low - height, seen(out)[1] - height
    meets &= low < 0.0
    # a corner that never leaves is evaluated where it is nearest to leaving
    crosses = meets & (high > 0.0)
    phi = bracketed_root(
        lambda x: np.where(crosses, seen(x)[1] - height, 0.0),
        np.where(crosses, deep, out),
        out,
        _ANGLE * mate.track.around,
        (np.where(crosses, low, 0.0), np.where(crosses, high, 0.0)),
    )
    margin = side * (seen(phi)[0] - mate.track.arc_length(tips.foot[index]))
    if mate.closed:
        margin = (margin + 0.5 * mate.length) % mate.length - 0.5 * mate.length
    return np.where(meets, margin, math.inf), phi, crosses


def _feet(
    own: Toothing, mate: Toothing, edge: PolarCurve, points: Plane | complex, phi: Array
) -> tuple[Array, Array]:
    """Return arc lengths of the feet of corners on the ring's centrode, and heights, mm."""
    here, there = own.frames(phi, curved=False), mate.frames(phi, curved=False)
    path = there.p + there.t * np.conj(here.t) * (points - here.p)
    foot = feet(mate, path, *edge.feet(path))
    base = mate.frames(foot, curved=False)
    return base.s, np.real(np.conj(mate.turn * base.t) * (path - base.p))


class Rolls(NamedTuple):
    """A wheel and its ring at rolls, in order, (n,) each.

    Parameters
    ----------
    phi : array, rad
        Driver angles.
    pitch_point : complex array, mm
        In the wheel's frame.
    turn, shift : complex arrays, 1 and mm
        A point p of the wheel is at ``shift + turn*p`` in the ring's frame.
    turned : array, rad
        Total angle of the wheel in the ring's frame, reversals added.
    way : array, mm
        Path length of the pitch point.
    """

    phi: Array
    pitch_point: Plane
    turn: Plane
    shift: Plane
    turned: Array
    way: Array


class Stays(NamedTuple):
    """Ends of the intervals that corners spend between the ring's teeth, one entry per end.

    `corner` is the corner's number; `deep` is a driver angle, rad, inside, and `edge` one just
    beyond the end, or nearest to an end where the corner never leaves.
    """

    corner: Ints
    deep: Array
    edge: Array


class _Seen(NamedTuple):
    """Computed states of corners, by corner and roll, (n,) each.

    `roll` is counted from the corner's first; `depth` is its depth inside the ring, mm, and
    `clear` the least distance that it must move to enter or leave.
    """

    corner: Ints
    roll: Ints
    depth: Array
    clear: Array

    def before(self, index: Ints, more: _Seen) -> _Seen:
        """Return these with `more`, inserted before the entries `index`."""
        return _Seen(
            np.insert(self.corner, index, more.corner),
            np.insert(self.roll, index, more.roll),
            np.insert(self.depth, index, more.depth),
            np.insert(self.clear, index, more.clear),
        )


def rolls_of(own: Toothing, mate: Toothing, phi: Array) -> Rolls:
    """Return the rolls of a wheel `own` and its `mate` at rising driver angles `phi`, rad."""
    here, there = own.frames(phi, curved=False), mate.frames(phi, curved=False)
    turn = there.t * np.conj(here.t)
    steps = np.abs(np.angle(turn[1:] * np.conj(turn[:-1])))
    turned = np.concatenate([[0.0], np.cumsum(steps)])
    return Rolls(phi, here.p, turn, there.p - turn * here.p, turned, here.s)


def find_stays(rolls: Rolls, points: Plane, first: Ints, count: int, edge: PolarCurve) -> Stays:
    """Return the ends of all intervals in which corners are inside the ring.

    Parameters
    ----------
    rolls : Rolls
        Possible roll positions.
    points : (n,) complex array, mm
        The corners, in the wheel's frame.
    first : (n,) int array
        First roll of each.
    count : int
        Number of rolls of each.
    edge : PolarCurve
        The ring's tips.

    Returns
    -------
    Stays
        By corner, then in order.
    """

    def look(corner: Ints, roll: Ints) -> _Seen:
        k = first[corner] + roll
        at = rolls.shift[k] + rolls.turn[k] * points[corner]
        depth = edge.beyond(at)
        return _Seen(corner, roll, depth, edge.clear(at, depth))

    start = np.unique(np.linspace(0, count - 1, _FIRST + 1).astype(int))
    seen = look(np.arange(len(points)).repeat(len(start)), np.tile(start, len(points)))
    while True:
        one, two = (first[seen.corner] + seen.roll)[:-1], (first[seen.corner] + seen.roll)[1:]
        reach = np.abs(points[seen.corner[:-1]] - rolls.pitch_point[one])
        moved = (rolls.turned[two] - rolls.turned[one]) * (reach + rolls.way[two] - rolls.way[one])
        k = np.flatnonzero(_open(seen, moved))
        if not k.size:
            corner, deep, end = _ends(seen, count - 1)
            return Stays(corner, rolls.phi[first[corner] + deep], rolls.phi[first[corner] + end])
        seen = seen.before(k + 1, look(seen.corner[k], (seen.roll[k] + seen.roll[k + 1]) // 2))


def _open(seen: _Seen, moved: Array) -> Mask:
    """Return which intervals need to be divided.

    Those in which a corner, which moves by `moved` at most, may enter or leave, and those next to
    a largest depth, or to a smallest depth inside.
    """
    depth, same = seen.depth, np.diff(seen.corner) == 0
    inside, rises = depth > 0.0, depth[1:] > depth[:-1]
    on, up = np.pad(same, 1), np.pad(rises, 1)
    turns = inside & ~(on[1:] & on[:-1] & (up[1:] == up[:-1]))
    sure = (inside[1:] == inside[:-1]) & (moved < seen.clear[1:] + seen.clear[:-1])
    return same & (np.diff(seen.roll) > 1) & (~sure | turns[1:] | turns[:-1])


def _ends(seen: _Seen, last: int) -> tuple[Ints, Ints, Ints]:
    """Return the corner, the deepest roll and the roll beyond the end, for all ends."""
    inside, other = seen.depth > 0.0, np.pad(np.diff(seen.corner) != 0, 1, constant_values=True)
    before, after = np.pad(inside, 1)[:-2], np.pad(inside, 1)[2:]
    starts = np.flatnonzero(inside & (other[:-1] | ~before))
    stops = np.flatnonzero(inside & (other[1:] | ~after))
    found: list[tuple[int, int, int]] = []
    for start, stop in zip(starts.tolist(), stops.tolist(), strict=True):
        depth, roll = seen.depth[start : stop + 1], seen.roll[start : stop + 1]
        # one roll further out, since positions are approximate
        ends = [max(int(roll[0]) - 2, 0)] if roll[0] > 0 else []
        ends += [min(int(roll[-1]) + 2, last)] if roll[-1] < last else []
        deep = int(roll[np.argmax(depth)])
        ends = ends or [int(roll[np.argmin(depth)])]
        found += [(int(seen.corner[start]), deep, end) for end in ends]
    corner, deep, edge = np.array(found, dtype=int).reshape(-1, 3).T
    return corner, deep, edge
