"""Intervals in which a tip corner of a wheel lies inside a tooth space of its ring.

Each corner is traced over as many rolls as the wheel has teeth, but computed only near its entry,
its exit and its deepest point: if its distance from the ring's tips at two rolls exceeds its
largest movement between them, it neither enters nor leaves in between.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gearcam.gears.flank import Toothing
from gearcam.gears.polar import PolarCurve
from gearcam.numeric.arrays import Array, Ints, Mask, Plane

_FIRST = 16
"""Intervals into which the rolls of a corner are divided at first."""


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
