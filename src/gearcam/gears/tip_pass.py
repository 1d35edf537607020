"""Tip interference (trochoid interference) of a wheel and a ring outside the mesh.

A tip corner of wheel 1, the upper end of a flank, enters a space of the ring some pitches before
its contact and leaves it some pitches after. Where it is level with a tip corner beside that space,
the arc length along the ring's centrode between the feet of both is the *tip-pass margin*, negative
where tips collide. Corners are traced over half a turn of wheel 1 in both directions, so that those
that enter the ring again elsewhere are found too. Rounded edges are taken as sharp.

On circles the margin is ``r2*(theta1*z1/z2 + inv(alpha_w) - inv(alpha_a2) - theta2)``.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gearcam.gears.corners import RadialCurve
from gearcam.gears.flank import Toothing
from gearcam.gears.flank_ends import feet
from gearcam.gears.outline import Outline
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.roots import bracketed_root

_ROLLS = 4
"""Roll positions per pitch in the search for corners, which stay in a space for several pitches."""

_ANGLE = 1e-14
"""Tolerance of a crossing, in turns of the driver: feet are no more exact."""

_DIGITS = 9
"""Digits by which margins, in pitches, are compared: of equal ones the first is reported."""

_BLOCK = 1 << 17
"""Positions of corners computed at once."""


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
    """

    margin: float
    tooth: int
    sigma: float
    phi1: float


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
    own, edge = wheel.toothing, RadialCurve(ring.toothing, ring.toothing.cutter.addendum)
    corners = _corners(wheel, ring.toothing)
    stays = _follow(own, ring.toothing, corners, edge)
    margins, angles = _margins(own, ring, corners.points, edge, stays)
    if not np.isfinite(margins).any():
        return TipPass(math.inf, 0, 0.0, 0.0)
    worst = int(np.argmin(np.round(margins / own.pitch, _DIGITS)))
    corner, phi1 = stays.corner[worst % len(stays.corner)], float(angles[worst])
    return TipPass(
        float(margins[worst]),
        int(corners.tooth[corner]),
        float(corners.sigma[corner]),
        phi1 % own.track.around if own.closed else phi1,
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


def _follow(own: Toothing, mate: Toothing, corners: _Corners, edge: RadialCurve) -> SpaceIntervals:
    """Trace corners over half a turn to both sides of the middle of their tooth.

    Corners of an open wheel are traced over its whole travel.
    """
    half = math.ceil(0.5 * own.teeth) if own.closed else own.teeth
    count, each = 2 * half * _ROLLS + 1, len(corners.points) // 2
    rolls = np.arange(count + (each - 1) * _ROLLS) / _ROLLS - half
    s = float(own.tooth_places[own.whole][0]) + own.pitch * rolls
    phi = own.track.angle(s if own.closed else np.clip(s, 0.0, own.length))
    here, there = own.frames(phi, curved=False), mate.frames(phi, curved=False)
    turn = there.t * np.conj(here.t)
    rolls = RollStates(phi, turn, there.p - turn * here.p)
    first = np.tile(_ROLLS * np.arange(each), 2)
    return find_stays(rolls, corners.points, first, count, edge)


def _margins(
    own: Toothing, ring: Outline, points: Plane, edge: RadialCurve, stays: SpaceIntervals
) -> tuple[Array, Array]:
    """Return margins, mm, and driver angles, rad, for all ends, (2n,).

    First relative to the tooth before the space, with its flank sigma = 1, then to the one after.
    """
    mate, tips = ring.toothing, ring.flanks.tips
    corner = np.tile(points[stays.corner], 2)
    deep, out = np.tile(stays.deep, 2), np.tile(stays.edge, 2)
    formed, side = len(mate.numbers), np.repeat([1.0, -1.0], len(stays.corner))

    def feet_at(phi: Array) -> tuple[Array, Array]:
        return _feet(own, mate, edge, corner, phi)

    start, low = feet_at(deep)
    space = np.round((start - mate.moved) / mate.pitch).astype(int)
    tooth = np.where(side > 0.0, space, space + 1) - mate.numbers[0]
    meets = np.full(tooth.shape, mate.closed) | ((tooth >= 0) & (tooth < formed))
    index = np.where(side > 0.0, 0, formed) + tooth % formed
    height = tips.height[index]
    low, high = low - height, feet_at(out)[1] - height
    meets &= low < 0.0
    # a corner that never leaves is evaluated where it is nearest to leaving
    crosses = meets & (high > 0.0)
    phi = bracketed_root(
        lambda x: np.where(crosses, feet_at(x)[1] - height, 0.0),
        np.where(crosses, deep, out),
        out,
        _ANGLE * mate.track.around,
        (np.where(crosses, low, 0.0), np.where(crosses, high, 0.0)),
    )
    margin = side * (feet_at(phi)[0] - mate.track.arc_length(tips.foot[index]))
    if mate.closed:
        margin = (margin + 0.5 * mate.length) % mate.length - 0.5 * mate.length
    return np.where(meets, margin, math.inf), phi


def _feet(
    own: Toothing, mate: Toothing, edge: RadialCurve, points: Plane, phi: Array
) -> tuple[Array, Array]:
    """Return arc lengths of the feet of corners on the ring's centrode, and heights, mm."""
    here, there = own.frames(phi, curved=False), mate.frames(phi, curved=False)
    path = there.p + there.t * np.conj(here.t) * (points - here.p)
    foot = feet(mate, path, *edge.feet(path))
    base = mate.frames(foot, curved=False)
    return base.s, np.real(np.conj(mate.turn * base.t) * (path - base.p))


class RollStates(NamedTuple):
    """A wheel and its ring at rolls, in order, (n,) each.

    Parameters
    ----------
    phi : array, rad
        Driver angles.
    turn, shift : complex arrays, 1 and mm
        A point p of the wheel is at ``shift + turn*p`` in the ring's frame.
    """

    phi: Array
    turn: Plane
    shift: Plane


class SpaceIntervals(NamedTuple):
    """Ends of the intervals that corners spend between the ring's teeth, one entry per end.

    `corner` is the corner's number; `deep` is a driver angle, rad, inside, and `edge` one just
    beyond the end, or nearest to an end where the corner never leaves.
    """

    corner: Ints
    deep: Array
    edge: Array


def find_stays(
    rolls: RollStates, points: Plane, first: Ints, count: int, edge: RadialCurve
) -> SpaceIntervals:
    """Return the ends of all intervals in which corners are inside the ring.

    Parameters
    ----------
    rolls : RollStates
        Possible roll positions.
    points : (n,) complex array, mm
        The corners, in the wheel's frame.
    first : (n,) int array
        First roll of each.
    count : int
        Number of rolls of each.
    edge : RadialCurve
        The ring's tips.

    Returns
    -------
    SpaceIntervals
        By corner, then in order.
    """
    stays: list[tuple[int, int, int]] = []
    size = max(1, _BLOCK // count)
    for block in range(0, len(points), size):
        some = slice(block, block + size)
        k = first[some, None] + np.arange(count)
        depth = edge.beyond(rolls.shift[k] + rolls.turn[k] * points[some, None])
        changes = np.diff(np.pad(depth > 0.0, ((0, 0), (1, 1))).astype(np.int8), axis=1)
        (row, start), (_, stop) = np.nonzero(changes > 0), np.nonzero(changes < 0)
        for corner, low, high in zip(row.tolist(), start.tolist(), stop.tolist(), strict=True):
            inside = depth[corner, low:high]
            # one roll further out, since positions are approximate
            ends = [max(low - 2, 0)] if low > 0 else []
            ends += [min(high + 1, count - 1)] if high < count else []
            ends = ends or [low + int(inside.argmin())]
            deep = low + int(inside.argmax())
            stays += [(block + corner, deep, end) for end in ends]
    corner, deep, end = np.array(stays, dtype=int).reshape(-1, 3).T
    return SpaceIntervals(corner, rolls.phi[first[corner] + deep], rolls.phi[first[corner] + end])
