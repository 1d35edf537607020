"""Which flanks of a pair are in contact, and when: as designed, and as mounted.

A *side* is the `sigma` of the driver's flanks: -1 drives (the driver turns by ``-phi1``), +1 holds
back. The pairs of flanks of a side are numbered by j, the driver's tooth counted from 0 over all
turns; an open pair has only those that lie in both blanks. `gearcam.gears.normals` has the
equations of contact.

Nothing is refused: flanks that cannot touch form no pair. Depends on flanks and tracks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from gearcam.gears.normals import Mounting, touch
from gearcam.gears.track import WHEELS, Wheel
from gearcam.numeric.arrays import Array, Ints, Mask

if TYPE_CHECKING:  # generating wheels needs more than numpy
    from gearcam.gears.outline import Flanks
    from gearcam.gears.pair import Gear


DRIVE, COAST = -1, 1
"""Sides of the driver's teeth: the driving side and the coast side."""

_EVEN = 1e-12
"""Rounding of flank positions, in pitches."""

_ONE = 1e-12
"""Ends of arcs closer than this, in travels, are the same: rounding."""

_ALIKE = 1e-9
"""Contact ratios closer than this are equal: rounding separates what symmetry makes equal."""


@dataclass(frozen=True, eq=False, kw_only=True)
class FlankPairs(Mounting):
    """The pairs of flanks of one side, numbered by j.

    Parameters
    ----------
    flanks : (Flanks, Flanks)
        The finished flanks of both wheels.
    """

    flanks: tuple[Flanks, Flanks]

    @property
    def closed(self) -> bool:
        """Whether both wheels are closed (toothed all around)."""
        return all(toothing.closed for toothing in self.toothings)

    @cached_property
    def travel(self) -> float:
        """Driver angle of a turn, or of the travel of an open pair or a rack, rad."""
        if self.toothings[0].closed == self.closed:
            return self.track.around
        return float(self.track.angle(self.toothings[1].length))

    def tooth(self, wheel: Wheel, j: Ints) -> Ints:
        """Return tooth numbers of a wheel in pairs `j` (see `FlankPairs`)."""
        toothing, count = self.toothings[wheel - 1], self._count(wheel, j)
        return count % toothing.teeth + 1 if toothing.closed else count + 1

    def _count(self, wheel: Wheel, j: Ints) -> Ints:
        # sf = (j + side/4) pitches is (k + 1/2 - side/4) pitches on wheel 2.
        return j if wheel == 1 or self.side > 0 else j - 1

    def _flank(self, wheel: Wheel, j: Ints) -> Ints:
        """Return the indices of flanks in the wheel's arrays; the nearest for flanks it lacks."""
        toothing = self.toothings[wheel - 1]
        size, tooth = len(toothing.numbers), self._count(wheel, j)
        index = tooth % size if toothing.closed else tooth + 1 - toothing.numbers[0]
        return np.clip(index, 0, size - 1) + (0 if self.sigma(wheel) > 0 else size)

    def real(self, j: Ints) -> Mask:
        """Return whether the flanks of pairs `j` exist on both wheels (see `FlankPairs`)."""
        result = np.ones(np.shape(j), dtype=bool)
        for wheel, toothing in zip(WHEELS, self.toothings, strict=True):
            if not toothing.closed:
                number, (low, high) = self.tooth(wheel, j), toothing.ends
                place = self.place(wheel, j)
                result &= (number >= toothing.numbers[0]) & (number <= toothing.numbers[-1])
                result &= (place > low) & (place < high)
        return result

    def place(self, wheel: Wheel, j: Ints) -> Array:
        """Return sf, mm, of the flank of a wheel in pairs `j` (see `FlankPairs`)."""
        toothing = self.toothings[wheel - 1]
        places = self.flanks[wheel - 1].sf[self._flank(wheel, j)]
        if not toothing.closed:
            return places
        return places + self._count(wheel, j) // toothing.teeth * (toothing.pitch * toothing.teeth)

    def reach(self, wheel: Wheel, j: Ints) -> tuple[Array, Array]:
        """Return the reach w, mm, of a wheel's flank at root and tip (see `FlankPairs`)."""
        flanks, number = self.flanks[wheel - 1], self._flank(wheel, j)
        return flanks.lowest[number], flanks.highest[number]

    def separation(self, j: Ints) -> Array:
        """Return the separation sf2 - sf1 of the flanks of pairs `j`, mm."""
        return self.place(2, j) - self.place(1, j)

    @cached_property
    def even(self) -> bool:
        """Whether flanks are evenly spaced: pairs then touch together at any centre distance."""
        found = self.separation(self.numbers)
        return found.size == 0 or bool(np.ptp(found) <= _EVEN * self.pitch)

    @cached_property
    def numbers(self) -> Ints:
        """Numbers j of the pairs in one turn of the driver, or in the travel of an open pair."""
        if self.closed:
            return np.arange(self.toothings[0].teeth)
        open_one = next(toothing for toothing in self.toothings if not toothing.closed)
        j = np.arange(-3, open_one.teeth + 4)
        return j[self.real(j)]

    def candidates(self, s: Array) -> Ints:
        """Return the pairs that may touch at nominal rolls `s`, mm: (len(s), m)."""
        longest = max(
            float(np.abs(end).max()) for f in self.flanks for end in (f.lowest, f.highest)
        )
        width = math.ceil(longest / self.pitch + 0.5)
        along = (s - self.toothings[0].moved) / self.pitch
        middle = np.rint(along - 0.25 * self.side).astype(np.int64)
        return middle[:, None] + np.arange(-width, width + 1)

    def beside(self, phi1: Array) -> tuple[Ints, Ints]:
        """Return the pairs that may touch at phases `phi1`, rad: indices of the phases, and j."""
        candidates = self.candidates(self.track.arc_length(phi1))
        step, column = np.nonzero(self.real(candidates))
        return step, candidates[step, column]

    @cached_property
    def _lobe(self) -> int:
        """Number of pairs after which the contacts repeat."""
        one, two = self.toothings
        return math.gcd(one.teeth, two.teeth) if self.closed and self.even else len(self.numbers)

    @cached_property
    def arcs(self) -> tuple[Array, Array]:
        """Driver angles, rad, at start and end of contact of each pair; start >= end if none."""
        j, track = self.numbers[: self._lobe], self.track
        if j.size == 0:
            return np.empty(0), np.empty(0)
        known, places = [], []
        for wheel in WHEELS:
            for reach in self.reach(wheel, j):
                places.append(track.angle(self.place(wheel, j) - self.sigma(wheel) * reach))
                known.append(np.full(j.shape, wheel))
        start = np.concatenate(places)
        ends, _, found = touch(self, start, np.tile(self.separation(j), 4), np.concatenate(known))
        low1, high1, low2, high2 = ends.phi1.reshape(4, -1)
        first, last = np.maximum(low1, high2), np.minimum(high1, low2)
        if self.side == COAST:
            first, last = np.maximum(high1, low2), np.minimum(low1, high2)
        # where no end is found these teeth do not mesh
        lost = ~found.reshape(4, -1).all(axis=0)
        first[lost] = last[lost] = track.angle(self.place(1, j[lost]))
        again: Array = np.arange(len(self.numbers) // self._lobe, dtype=float)[:, None]
        lobes = track.arc.period * again
        return (first + lobes).ravel(), (last + lobes).ravel()

    @cached_property
    def contact_ratios(self) -> Array:
        """Contact ratio of each of the pairs `numbers`: arc of contact over pitch.

        The driver's arc between the ends of tangency, along its pitch curve.
        """
        start, end = (self.track.arc_length(edge) for edge in self.arcs)
        return np.maximum(end - start, 0.0) / self.pitch

    @property
    def weakest(self) -> int:
        """Index of the smallest contact ratio; the first of those equal but for rounding."""
        ratios = self.contact_ratios
        return int(np.argmax(ratios <= ratios.min() + _ALIKE))

    @cached_property
    def stretches(self) -> tuple[Array, Array, Ints]:
        """Intervals of one turn of the driver, or of an open pair's travel, by pairs in contact.

        Driver angles of start and end, rad, and the number of pairs in contact: 1 on single-pair
        arcs, 2 on double-pair arcs, 0 where no flanks touch.
        """
        turn = self.travel
        start, end = (edge[self.arcs[1] > self.arcs[0]] for edge in self.arcs)
        turns = np.arange(-1, 2)[:, None] if self.closed else np.zeros((1, 1))
        start, end = ((edge + turn * turns).ravel() for edge in (start, end))
        edges = np.clip(np.concatenate([start, end]), 0.0, turn)
        edges = np.sort(np.concatenate([[0.0], edges, [turn]]))
        edges = edges[np.append(np.diff(edges) > _ONE * turn, True)]
        edges[0] = 0.0
        middle = 0.5 * (edges[:-1] + edges[1:])
        carrying = np.searchsorted(np.sort(start), middle, side="right")
        carrying -= np.searchsorted(np.sort(end), middle, side="left")
        first = np.flatnonzero(np.append(True, np.diff(carrying) != 0))
        return edges[first], np.append(edges[first[1:]], turn), carrying[first]

    def carrying(self, phi1: ArrayLike) -> Ints:
        """Return the number of pairs in contact at phases `phi1`, rad."""
        phi1 = np.atleast_1d(np.asarray(phi1, dtype=float))
        start, end, pairs = self.stretches
        x = np.mod(phi1, end[-1]) if self.closed else phi1
        return pairs[np.clip(np.searchsorted(start, x, side="right") - 1, 0, len(pairs) - 1)]


def flank_pairs(gears: tuple[Gear, Gear], side: int, distance: float | None = None) -> FlankPairs:
    """Return the pairs of flanks of one side.

    Parameters
    ----------
    gears : (Gear, Gear)
        Driver and driven wheel.
    side : {-1, +1}
        `DRIVE` or `COAST`.
    distance : float, mm, optional
        Mounted distance (see `Mounting`); by default the design distance.

    Returns
    -------
    FlankPairs
    """
    first, second = gears
    return FlankPairs(
        toothings=(first.toothing, second.toothing),
        guide=first.pair.rolling.guide,
        flanks=(first.profile.flanks, second.profile.flanks),
        side=side,
        distance=first.pair.shift if distance is None else distance,
    )
