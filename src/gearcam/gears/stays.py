"""Where corners of a wheel stand between the teeth of its ring, while both roll.

Each corner is followed over as many rolls as the wheel has teeth, but looked at only where it comes
in or out, and where it is deepest: how far it moves between two rolls is known, and how far it is
from the tips of the ring at both. Where that is more, it neither comes in nor out between them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gearcam.gears.flank import Toothing
from gearcam.gears.polar import PolarCurve
from gearcam.numeric.arrays import Array, Ints, Mask, Plane

_FIRST = 16
"""Stretches of the rolls of a corner that are looked at first."""


class Rolls(NamedTuple):
    """A wheel and its ring at rolls, in order, (n,) each.

    Parameters
    ----------
    phi : array, rad
        Driver angles.
    pitch_point : complex array, mm
        In the wheel's frame.
    turn, shift : complex arrays, 1 and mm
        A point p of the wheel stands at ``shift + turn*p`` in the ring's frame.
    turned : array, rad
        How far the wheel has turned in the ring's frame, to and fro.
    way : array, mm
        How far the pitch point has gone.
    """

    phi: Array
    pitch_point: Plane
    turn: Plane
    shift: Plane
    turned: Array
    way: Array


class Stays(NamedTuple):
    """Stays of corners between the ring's teeth, and the ends that are seen of them.

    `corner` tells whose; `deep` is the driver angle, rad, in the middle, and `edge` one beyond the
    end; where a corner never gets out it is the nearest to that.
    """

    corner: Ints
    deep: Array
    edge: Array


class _Seen(NamedTuple):
    """Corners where they were looked at, by corner and roll, (n,) each.

    `roll` is counted from the corner's first; `depth` tells how far it is in the ring, mm, and
    `clear` how far it has to go at least to come in or out.
    """

    corner: Ints
    roll: Ints
    depth: Array
    clear: Array

    def before(self, index: Ints, more: _Seen) -> _Seen:
        """Return these with `more`, one before each of numbers `index`."""
        return _Seen(
            np.insert(self.corner, index, more.corner),
            np.insert(self.roll, index, more.roll),
            np.insert(self.depth, index, more.depth),
            np.insert(self.clear, index, more.clear),
        )


def rolls_of(own: Toothing, mate: Toothing, phi: Array) -> Rolls:
    """Return a wheel `own` and its `mate` at driver angles `phi`, rad, that do not fall."""
    here, there = own.frames(phi, curved=False), mate.frames(phi, curved=False)
    turn = there.t * np.conj(here.t)
    steps = np.abs(np.angle(turn[1:] * np.conj(turn[:-1])))
    turned = np.concatenate([[0.0], np.cumsum(steps)])
    return Rolls(phi, here.p, turn, there.p - turn * here.p, turned, here.s)


def find_stays(rolls: Rolls, points: Plane, first: Ints, count: int, edge: PolarCurve) -> Stays:
    """Find the stays of corners in the ring, and both ends of each that are seen.

    Parameters
    ----------
    rolls : Rolls
        Where corners may be looked at.
    points : (n,) complex array, mm
        The corners, in the wheel's frame.
    first : (n,) int array
        The roll from which each is followed.
    count : int
        Over how many rolls.
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
    """Tell in which stretches more is to be seen.

    Those in which a corner may come in or out, which moves by `moved` at most, and those beside
    which it is deepest, or least deep without coming out.
    """
    depth, same = seen.depth, np.diff(seen.corner) == 0
    inside, rises = depth > 0.0, depth[1:] > depth[:-1]
    on, up = np.pad(same, 1), np.pad(rises, 1)
    turns = inside & ~(on[1:] & on[:-1] & (up[1:] == up[:-1]))
    sure = (inside[1:] == inside[:-1]) & (moved < seen.clear[1:] + seen.clear[:-1])
    return same & (np.diff(seen.roll) > 1) & (~sure | turns[1:] | turns[:-1])


def _ends(seen: _Seen, last: int) -> tuple[Ints, Ints, Ints]:
    """Return corners, and their rolls in the middle and beyond the end, of all ends of stays."""
    inside, other = seen.depth > 0.0, np.pad(np.diff(seen.corner) != 0, 1, constant_values=True)
    before, after = np.pad(inside, 1)[:-2], np.pad(inside, 1)[2:]
    starts = np.flatnonzero(inside & (other[:-1] | ~before))
    stops = np.flatnonzero(inside & (other[1:] | ~after))
    found: list[tuple[int, int, int]] = []
    for start, stop in zip(starts.tolist(), stops.tolist(), strict=True):
        depth, roll = seen.depth[start : stop + 1], seen.roll[start : stop + 1]
        # one roll further out, since the places are rough
        ends = [max(int(roll[0]) - 2, 0)] if roll[0] > 0 else []
        ends += [min(int(roll[-1]) + 2, last)] if roll[-1] < last else []
        deep = int(roll[np.argmax(depth)])
        ends = ends or [int(roll[np.argmin(depth)])]
        found += [(int(seen.corner[start]), deep, end) for end in ends]
    corner, deep, edge = np.array(found, dtype=int).reshape(-1, 3).T
    return corner, deep, edge
