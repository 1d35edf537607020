"""Which flanks of a pair are in contact, when and where: as designed, and as mounted.

A *side* is the `sigma` of the driver's flanks: -1 drives (the driver turns by ``-phi1``), +1 holds
back. The pairs of flanks of a side are numbered by j, the driver's tooth counted from 0 over all
turns; an open pair has only those that lie in both blanks.

Two flanks touch at a common normal, with zero distance along it. A flank's normal at roll s passes
through the pitch point of that roll, for any position `sf`: the flanks of one side are parallel
curves, involutes of one base curve. At a phase of the driver three equations (equal directions of
the normals, and two coordinates) give the rolls of both wheels at which a pair touches, and the
*lead* of the driven wheel, the angle by which it is ahead of its nominal position. As designed the
rolls are equal and the lead is 0. The lead is the same for all pairs of evenly spaced flanks: they
touch together at any centre distance.

Positions are those of the mounted pair, as complex numbers: O1 at 0, O2 at the centre distance
along x, for a ring at the opposite side. A rack has no O2; its lead is a travel in mm.

A `Mounting` moves shafts and teeth of real wheels: those of an eccentric wheel are moved against
its shaft, and turn with it; an error of pitch moves a tooth along the pitch curve.

Nothing is refused: flanks that cannot touch form no pair. Depends on flanks and tracks.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcam.base.display import ShortRepr
from gearcam.gears.flank import Toothing
from gearcam.gears.rolling import Guide
from gearcam.gears.track import WHEELS, Frames, Track, Wheel
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.roots import damped_newton, solve

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

_SMALL = 1e-7
"""Step, in pitches, after which the next one is below rounding."""

_MISS = 1e-9
"""Largest residual of the equations, in pitches and rad."""

_FAR = 3.0
"""Largest distance, in pitches, of a roll from the nominal one in a pair of teeth that mesh."""

_FREE = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3]])
"""Indices of the unknowns of phase, both rolls and lead, by which of the first three is known."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Mounting(ShortRepr):
    """How two wheels are mounted and made; without errors the wheels are those of the design.

    Parameters
    ----------
    distance : complex, mm
        Position of the driven frame: the centre distance along x, negative for a ring; for a rack
        the offset from its design position. Across the line of centres along y.
    eccentric : (complex, complex), mm
        Offset of the teeth of driver and driven wheel from their shafts, in the wheel's frame.
    pitch : (dict of int to float, dict of int to float), mm
        Errors of teeth along the pitch curve, by number, of driver and driven wheel.
    """

    distance: complex
    eccentric: tuple[complex, complex] = (0j, 0j)
    pitch: tuple[Mapping[int, float], Mapping[int, float]] = field(default_factory=lambda: ({}, {}))

    @property
    def turns_differ(self) -> bool:
        """Whether wheel 2's teeth differ: wheel 1's are the same after each turn of the driver."""
        return self.eccentric[1] != 0.0 or any(self.pitch[1].values())


@dataclass(frozen=True, eq=False, kw_only=True)
class FlankPairs(ShortRepr):
    """The pairs of flanks of one side of two mounted wheels, numbered by j.

    Parameters
    ----------
    toothings : (Toothing, Toothing)
        Driver and driven wheel.
    guide : Guide
        Guide of the driven wheel.
    side : {-1, +1}
        sigma of the driver's flanks.
    distance : complex, mm
        Mounted position of the driven frame (see `Mounting`).
    flanks : (Flanks, Flanks)
        The finished flanks of both wheels, with their errors of pitch.
    eccentric : (complex, complex), mm
        Offset of the teeth of both wheels from their shafts, in the wheel's frame.
    turns : int
        Turns of a closed driver after which both wheels are as before: 1 where all turns are alike.
    """

    toothings: tuple[Toothing, Toothing]
    guide: Guide
    side: int
    distance: complex
    flanks: tuple[Flanks, Flanks]
    eccentric: tuple[complex, complex] = (0j, 0j)
    turns: int = 1

    @property
    def track(self) -> Track:
        """The driver's track; the driven one shares its parameter and arc length."""
        return self.toothings[0].track

    @property
    def pitch(self) -> float:
        """Pitch, mm."""
        return self.toothings[0].pitch

    def sigma(self, wheel: Wheel) -> int:
        """Return sigma of a wheel's flanks."""
        return self.side if wheel == 1 else -self.side

    @property
    def closed(self) -> bool:
        """Whether both wheels are closed (toothed all around)."""
        return all(toothing.closed for toothing in self.toothings)

    @cached_property
    def travel(self) -> float:
        """Driver angle of its `turns`, or of the travel of an open pair or a rack, rad."""
        if self.toothings[0].closed == self.closed:
            return self.track.around * self.turns
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
        if any(self.eccentric):
            return False
        found = self.separation(self.numbers)
        return found.size == 0 or bool(np.ptp(found) <= _EVEN * self.pitch)

    @cached_property
    def numbers(self) -> Ints:
        """Numbers j of the pairs in the `turns` of the driver, or in the travel of an open pair."""
        if self.closed:
            return np.arange(self.toothings[0].teeth * self.turns)
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
        """Intervals of the driver's `travel` by pairs in contact.

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


def flank_pairs(
    gears: tuple[Gear, Gear], side: int, mounting: Mounting | complex | None = None
) -> FlankPairs:
    """Return the pairs of flanks of one side.

    Parameters
    ----------
    gears : (Gear, Gear)
        Driver and driven wheel.
    side : {-1, +1}
        `DRIVE` or `COAST`.
    mounting : Mounting or complex, mm, optional
        How they are mounted, or the mounted distance alone; by default as designed.

    Returns
    -------
    FlankPairs
    """
    first, second = gears
    if not isinstance(mounting, Mounting):
        mounting = Mounting(distance=first.pair.shift if mounting is None else mounting)
    one, two = (
        _with_errors(gear, errors) for gear, errors in zip(gears, mounting.pitch, strict=True)
    )
    return FlankPairs(
        toothings=(first.toothing, second.toothing),
        guide=first.pair.rolling.guide,
        flanks=(one, two),
        side=side,
        distance=mounting.distance,
        eccentric=mounting.eccentric,
        turns=turns_of_cycle(gears) if mounting.turns_differ else 1,
    )


def _with_errors(gear: Gear, errors: Mapping[int, float]) -> Flanks:
    """Return the flanks of a wheel whose teeth are moved along its pitch curve, mm by number."""
    flanks, numbers = gear.profile.flanks, gear.toothing.numbers
    if not errors:
        return flanks
    moved = np.array([errors.get(number, 0.0) for number in numbers])
    return replace(flanks, sf=flanks.sf + np.tile(moved, 2))


def turns_of_cycle(gears: Sequence[Gear]) -> int:
    """Return the turns of a driver after which all its teeth meet the same ones again.

    Parameters
    ----------
    gears : sequence of Gear
        The wheels.

    Returns
    -------
    int
        1 if one of them is open.
    """
    one, two = (gear.toothing for gear in gears)
    if not (one.closed and two.closed):
        return 1
    return two.teeth // math.gcd(one.teeth, two.teeth)


class FlankPositions(NamedTuple):
    """Positions of pairs of flanks: arrays of one shape.

    Parameters
    ----------
    phi1 : array, rad
        Phase of the driver.
    one, two : arrays, rad
        Rolls of driver and driven wheel, as driver angles.
    lead : array, rad
        Angle by which the driven wheel is ahead of its nominal position; for a rack mm of travel.
    """

    phi1: Array
    one: Array
    two: Array
    lead: Array

    def take(self, index: Ints | Mask) -> FlankPositions:
        """Return some of them, by `index`."""
        return FlankPositions(*(values[index] for values in self))


@dataclass(frozen=True, eq=False, kw_only=True)
class Normals(ShortRepr):
    """Normals of n driver's flanks and of n driven flanks, in the mounted pair.

    Parameters
    ----------
    frames : (Frames, Frames)
        At the rolls of driver and driven wheel.
    foot : (2, n) complex array, mm
        Pitch points of these rolls.
    normal : (2, n) complex array
        Unit normals of the flanks.
    equations : (3, n) array, rad and mm
        Angle between the normals; distance of the flanks along the driver's, and across it.
    slopes : (3, 4, n) array
        Their derivatives by phase, roll of the driver, roll of the driven wheel (as driver
        angles) and lead.
    """

    frames: tuple[Frames, Frames]
    foot: Plane
    normal: Plane
    equations: Array
    slopes: Array

    def take(self, index: Ints | Mask) -> Normals:
        """Return some of them, by `index`."""
        first, second = self.frames
        return Normals(
            frames=(first.some(index), second.some(index)),
            foot=self.foot[:, index],
            normal=self.normal[:, index],
            equations=self.equations[:, index],
            slopes=self.slopes[..., index],
        )

    @property
    def rates(self) -> Array:
        """Derivatives of both rolls (as driver angles) and the lead by the phase, (3, n)."""
        return -solve(self.slopes[:, _FREE[0]], self.slopes[:, 0])


def normals(
    pairs: FlankPairs, positions: FlankPositions, separation: Array, motion: Array | None = None
) -> Normals:
    """Return normals of both wheels' flanks, and the residuals of the equations of contact.

    Parameters
    ----------
    pairs : FlankPairs
        The wheels and the side.
    positions : FlankPositions
        Positions of n pairs.
    separation : (n,) array, mm
        sf2 - sf1.
    motion : (2, n) array, optional
        `Guide.motion` at the phases, if already computed.

    Returns
    -------
    Normals

    Notes
    -----
    With n the driver's unit normal and P the pitch points, flanks touch where the normals are
    parallel and ``conj(n)*(P2 - P1) + (s1 - s2 + sf2 - sf1)*cos(alpha) = 0``. Derivatives by s
    from ``dn/ds = +-1j*kappa*n`` (+ on wheel 1) and ``dP/ds = T``.
    """
    phi1, one, two, lead = positions
    first, second = (
        toothing.frames(angle) for toothing, angle in zip(pairs.toothings, (one, two), strict=True)
    )
    guide, alpha = pairs.guide, pairs.toothings[0].cutter.alpha
    cosine, turned = math.cos(alpha), np.exp(-1j * phi1)
    n1, n2 = (
        toothing.normals(frames, pairs.sigma(toothing.wheel))
        for toothing, frames in zip(pairs.toothings, (first, second), strict=True)
    )
    nominal, ratio = guide.motion(phi1) if motion is None else motion
    stand = guide.pose(nominal + lead)
    back = stand.rotation
    one_at, two_at = pairs.eccentric
    foot1, n1 = (first.p + one_at) * turned, n1 * turned
    foot2, n2, tangent2 = (second.p + two_at) * back + stand.shift, n2 * back, second.t * back
    carried, turns = guide.carried(foot2), guide.turns
    foot2 = foot2 + pairs.distance
    across = np.conj(n1) * (foot2 - foot1)
    aligned = np.conj(n2) * n1
    distance = across.real + (first.s - second.s + separation) * cosine
    by_lead = np.conj(n1) * carried
    by_one = -1j * (first.kappa * across + pairs.side * math.sin(alpha))
    by_two = np.conj(n1) * tangent2 - cosine
    # the driver turns by -phi1, the driven wheel as by the lead
    by_phase = 1j * np.conj(n1) * foot2 + ratio * by_lead
    angle = [
        -aligned.real * (1.0 + turns * ratio),
        aligned.real * first.kappa * first.speed,
        aligned.real * second.kappa * second.speed,
        -aligned.real * turns,
    ]
    moves = [by_phase, by_one * first.speed, by_two * second.speed, by_lead]
    return Normals(
        frames=(first, second),
        foot=np.stack([foot1, foot2]),
        normal=np.stack([n1, n2]),
        equations=np.stack([aligned.imag, distance, across.imag]),
        slopes=np.stack([np.stack(angle), np.real(moves), np.imag(moves)]),
    )


def touch(
    pairs: FlankPairs,
    start: Array,
    separation: Array,
    known: Ints | int = 0,
    limits: tuple[Array, Array] | None = None,
) -> tuple[FlankPositions, Normals, Mask]:
    """Find where flanks touch.

    Parameters
    ----------
    pairs : FlankPairs
        The wheels and the side.
    start : (n,) array, rad
        The known one: the phase, or the roll of a wheel as driver angle. The search begins with
        all three equal, as designed.
    separation : (n,) array, mm
        sf2 - sf1.
    known : int or (n,) int array
        Which one is known: 0 the phase, 1 the driver's roll, 2 the driven wheel's.
    limits : ((n,) array, (n,) array), optional
        If the phase is known: driver angles, rad, that bound both rolls.

    Returns
    -------
    positions : FlankPositions
        Solutions by Newton's method, with steps of half a pitch at most.
    at : Normals
        The normals there.
    found : (n,) bool array
        Whether it converged to a contact within `_FAR` pitches of the nominal roll.
    """
    every = np.stack([start, start, start, np.zeros(start.shape)])
    free, rows = _FREE[np.broadcast_to(known, start.shape)].T, np.arange(start.size)
    scale = pairs.track.frames(start, curved=False).speed / pairs.pitch
    motion = None if np.any(known) else pairs.guide.motion(start)

    def evaluate(x: Array, some: Ints) -> tuple[Normals, Array, Array]:
        every[free[:, some], some] = x
        given = motion if motion is None else motion[:, some]
        at = normals(pairs, FlankPositions(*every[:, some]), separation[some], given)
        return at, at.equations, at.slopes[:, free[:, some], np.arange(some.size)]

    _, at = damped_newton(evaluate, every[free, rows], scale, _SMALL, limits)
    found = np.abs(at.equations[0]) <= _MISS
    found &= np.abs(at.equations[1:]).max(axis=0) <= _MISS * pairs.pitch
    found &= np.abs(every[:3] - start).max(axis=0) * scale <= _FAR
    return FlankPositions(*every), at, found
