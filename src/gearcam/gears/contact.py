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

from gearcam.base.display import ShortRepr
from gearcam.gears.contact_arcs import ContactArcs
from gearcam.gears.flank import Toothing
from gearcam.gears.rolling import Guide
from gearcam.gears.track import Frames, Track
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.numeric.roots import damped_newton, solve

if TYPE_CHECKING:  # generating wheels needs more than numpy
    from gearcam.gears.outline import Flanks
    from gearcam.gears.pair import Gear


DRIVE, COAST = -1, 1
"""Sides of the driver's teeth: the driving side and the coast side."""

_EVEN = 1e-12
"""Rounding of flank positions, in pitches."""

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
class WheelFlanks(ShortRepr):
    """The flanks on one side of a wheel's teeth, by the number j of their pair (see `FlankPairs`).

    Parameters
    ----------
    toothing : Toothing
        The wheel.
    sigma : {-1, +1}
        Side of its teeth.
    flanks : Flanks
        The finished flanks of both sides, with their errors of pitch.
    eccentric : complex, mm
        Offset of its teeth from its shaft, in the wheel's frame.
    behind : {0, 1}
        The count of its tooth in pair j is j less this.
    """

    toothing: Toothing
    sigma: int
    flanks: Flanks
    eccentric: complex
    behind: int

    def number(self, j: Ints) -> Ints:
        """Return the numbers of its teeth in pairs `j`."""
        count = j - self.behind
        return (count % self.toothing.teeth if self.toothing.closed else count) + 1

    def _row(self, j: Ints) -> Ints:
        """Return the indices of its flanks in `flanks`; the nearest for those that it lacks."""
        formed = self.toothing.numbers
        row = np.clip(self.number(j) - formed[0], 0, len(formed) - 1)
        return row + (0 if self.sigma > 0 else len(formed))

    def real(self, j: Ints) -> Mask:
        """Return whether its flanks in pairs `j` exist: formed, and within its blank."""
        if self.toothing.closed:
            return np.ones(np.shape(j), dtype=bool)
        number, place = self.number(j), self.place(j)
        formed, (low, high) = self.toothing.numbers, self.toothing.ends
        return (number >= formed[0]) & (number <= formed[-1]) & (place > low) & (place < high)

    def place(self, j: Ints) -> Array:
        """Return sf, mm, of its flanks in pairs `j`, counted on over all turns."""
        places, toothing = self.flanks.sf[self._row(j)], self.toothing
        if not toothing.closed:
            return places
        return places + (j - self.behind) // toothing.teeth * toothing.length

    def reach(self, j: Ints) -> tuple[Array, Array]:
        """Return the reach w, mm, of its flanks in pairs `j` at root and tip."""
        row = self._row(j)
        return self.flanks.lowest[row], self.flanks.highest[row]


@dataclass(frozen=True, eq=False, kw_only=True)
class FlankPairs(ShortRepr):
    """The pairs of flanks of one side of two mounted wheels, numbered by j.

    Along the pitch curves the teeth of one wheel fill the spaces of the other. The teeth of both
    are counted from 0 over all turns, and j is the count of the driver's::

        driven wheel   tooth -1 |           |  tooth 0  |           |  tooth 1
        driver                  |  tooth 0  |           |  tooth 1  |
        s in pitches          -1/4         1/4         3/4         5/4
        j of DRIVE              0                       1
        j of COAST                          0                       1

    Parameters
    ----------
    wheels : (WheelFlanks, WheelFlanks)
        The flanks of driver and driven wheel.
    guide : Guide
        Guide of the driven wheel.
    distance : complex, mm
        Mounted position of the driven frame (see `Mounting`).
    turns : int
        Turns of a closed driver after which both wheels are as before: 1 where all turns are alike.
    """

    wheels: tuple[WheelFlanks, WheelFlanks]
    guide: Guide
    distance: complex
    turns: int = 1

    @property
    def side(self) -> int:
        """`DRIVE` or `COAST`: sigma of the driver's flanks."""
        return self.wheels[0].sigma

    @property
    def track(self) -> Track:
        """The driver's track; the driven one shares its parameter and arc length."""
        return self.wheels[0].toothing.track

    @property
    def pitch(self) -> float:
        """Pitch, mm."""
        return self.wheels[0].toothing.pitch

    @property
    def closed(self) -> bool:
        """Whether both wheels are closed (toothed all around)."""
        return all(wheel.toothing.closed for wheel in self.wheels)

    @cached_property
    def travel(self) -> float:
        """Driver angle of its `turns`, or of the travel of an open pair or a rack, rad."""
        driver, driven = (wheel.toothing for wheel in self.wheels)
        if driver.closed == self.closed:
            return self.track.around * self.turns
        return float(self.track.angle(driven.length))

    def real(self, j: Ints) -> Mask:
        """Return whether the flanks of pairs `j` exist on both wheels."""
        driver, driven = self.wheels
        return driver.real(j) & driven.real(j)

    def frames(self, phi1: Array, place: Array) -> tuple[Plane, Plane]:
        """Return the wheels' own frames.

        Parameters
        ----------
        phi1, place : (k,) arrays
            Driver angles, rad, and the turn of the driven wheel (see `Guide.pose`).

        Returns
        -------
        origins, turns : (2, k) complex arrays, mm and 1
            A point p has the coordinates ``(p - origins)*turns`` in those of each wheel.
        """
        pose = self.guide.pose(place)
        origins = np.stack([np.zeros_like(pose.rotation), self.distance + pose.shift])
        return origins, np.stack([np.exp(1j * phi1), np.conj(pose.rotation)])

    def separation(self, j: Ints) -> Array:
        """Return the separation sf2 - sf1 of the flanks of pairs `j`, mm."""
        driver, driven = self.wheels
        return driven.place(j) - driver.place(j)

    @cached_property
    def even(self) -> bool:
        """Whether flanks are evenly spaced: pairs then touch together at any centre distance."""
        if any(wheel.eccentric for wheel in self.wheels):
            return False
        apart = self.separation(self.numbers)
        return apart.size == 0 or bool(np.ptp(apart) <= _EVEN * self.pitch)

    @cached_property
    def numbers(self) -> Ints:
        """Numbers j of the pairs in the `turns` of the driver, or in the travel of an open pair."""
        if self.closed:
            return np.arange(self.wheels[0].toothing.teeth * self.turns)
        open_one = next(wheel.toothing for wheel in self.wheels if not wheel.toothing.closed)
        j = np.arange(-3, open_one.teeth + 4)
        return j[self.real(j)]

    def candidates(self, s: Array) -> Ints:
        """Return the pairs that may touch at nominal rolls `s`, mm: (len(s), m)."""
        longest = max(
            float(np.abs(end).max())
            for flanks in (wheel.flanks for wheel in self.wheels)
            for end in (flanks.lowest, flanks.highest)
        )
        width = math.ceil(longest / self.pitch + 0.5)
        along = (s - self.wheels[0].toothing.moved) / self.pitch
        nearest = np.rint(along - 0.25 * self.side).astype(np.int64)
        return nearest[:, None] + np.arange(-width, width + 1)

    def beside(self, phi1: Array) -> tuple[Ints, Ints]:
        """Return the pairs that may touch at phases `phi1`, rad: indices of the phases, and j."""
        candidates = self.candidates(self.track.arc_length(phi1))
        step, column = np.nonzero(self.real(candidates))
        return step, candidates[step, column]

    @cached_property
    def arcs(self) -> ContactArcs:
        """When each of the pairs `numbers` is in contact."""
        # evenly spaced flanks do the same in each lobe
        teeth = [wheel.toothing.teeth for wheel in self.wheels]
        repeat = math.gcd(*teeth) if self.closed and self.even else len(self.numbers)
        first, last = self._exact._ends(self.numbers[:repeat]) if repeat else np.empty((2, 0))
        lobes = self.track.arc.period * np.arange(len(self.numbers) // max(repeat, 1))[:, None]
        return ContactArcs(
            start=(first + lobes).ravel(),
            end=(last + lobes).ravel(),
            track=self.track,
            pitch=self.pitch,
            travel=self.travel,
            closed=self.closed,
        )

    @property
    def _exact(self) -> FlankPairs:
        """The same on exact centrodes: what a table is off the normals turn, times a radius."""
        driver, driven = (
            replace(one, toothing=replace(one.toothing, track=one.toothing.track.exact))
            for one in self.wheels
        )
        return replace(self, wheels=(driver, driven))

    def _ends(self, j: Ints) -> tuple[Array, Array]:
        """Return the driver angles, rad, at start and end of contact of pairs `j`."""
        rolls = [
            self.track.angle(wheel.place(j) - wheel.sigma * reach)
            for wheel in self.wheels
            for reach in wheel.reach(j)
        ]
        known = np.repeat([1, 1, 2, 2], j.size)
        apart = np.tile(self.separation(j), 4)
        ends, _, touching = touch(self, np.concatenate(rolls), apart, known)
        low1, high1, low2, high2 = ends.phi1.reshape(4, -1)
        first, last = np.maximum(low1, high2), np.minimum(high1, low2)
        if self.side == COAST:
            first, last = np.maximum(high1, low2), np.minimum(low1, high2)
        # where no end is found these teeth do not mesh
        lost = ~touching.reshape(4, -1).all(axis=0)
        first[lost] = last[lost] = self.track.angle(self.wheels[0].place(j[lost]))
        return first, last


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
    if not isinstance(mounting, Mounting):
        mounting = Mounting(distance=gears[0].pair.shift if mounting is None else mounting)
    driver, driven = (
        WheelFlanks(
            toothing=gear.toothing,
            sigma=sigma,
            flanks=_with_errors(gear, errors),
            eccentric=eccentric,
            # sf = (j + side/4) pitches is (count + 1/2 - side/4) pitches on the driven wheel
            behind=int(gear.wheel == 2 and side < 0),
        )
        for gear, sigma, errors, eccentric in zip(
            gears, (side, -side), mounting.pitch, mounting.eccentric, strict=True
        )
    )
    return FlankPairs(
        wheels=(driver, driven),
        guide=gears[0].pair.rolling.guide,
        distance=mounting.distance,
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
    driver, driven = (wheel.toothing for wheel in pairs.wheels)
    first, second = driver.frames(one), driven.frames(two)
    guide, alpha = pairs.guide, driver.cutter.alpha
    cosine, turned = math.cos(alpha), np.exp(-1j * phi1)
    nominal, ratio = guide.motion(phi1) if motion is None else motion
    stand = guide.pose(nominal + lead)
    back = stand.rotation
    eccentric1, eccentric2 = (wheel.eccentric for wheel in pairs.wheels)
    n1 = driver.normals(first, pairs.side) * turned
    n2 = driven.normals(second, -pairs.side) * back
    foot1 = (first.p + eccentric1) * turned
    foot2, tangent2 = (second.p + eccentric2) * back + stand.shift, second.t * back
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
