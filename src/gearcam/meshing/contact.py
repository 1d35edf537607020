"""Exact contact: which flanks touch at a phase, where, and how they slide and roll.

Nothing is searched: at roll s a flank that crosses the pitch curve at `sf` touches its mate in the
foot of the perpendicular from the pitch point, if its reach ``w = sigma*(sf - s)`` lies on both
flanks. A *side* is the `sigma` of the driver's flank: -1 drives (the driver turns by ``-phi1``),
+1 holds back. The pairs of a side are numbered by j, the driver's tooth counted from 0 over all
turns, without end where both wheels go all around. Positions are those of the assembled pair: O1
at 0, O2 at (A, 0), as complex numbers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcam.gears.flank import Toothing
from gearcam.gears.rolling import Plane, Wheel

if TYPE_CHECKING:  # what cuts wheels needs more than numpy
    from gearcam.gears.outline import Flanks
    from gearcam.gears.pair import Gear

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

DRIVE, COAST = -1, 1
"""Sides of the driver's teeth: the one that drives, and the one that holds back."""


@dataclass(frozen=True, eq=False, kw_only=True)
class FlankPairs:
    """The pairs of flanks of one side, numbered by j.

    Parameters
    ----------
    toothings : (Toothing, Toothing)
        Driver and driven wheel.
    flanks : (Flanks, Flanks)
        Their flanks as cut.
    side : {-1, +1}
        sigma of the driver's flanks.
    """

    toothings: tuple[Toothing, Toothing]
    flanks: tuple[Flanks, Flanks]
    side: int

    def tooth(self, wheel: Wheel, j: Ints) -> Ints:
        """Return tooth numbers, from 1, of a wheel in pairs `j` (see `FlankPairs`)."""
        toothing, count = self.toothings[wheel - 1], self._count(wheel, j)
        return (count % toothing.teeth if toothing.closed else count) + 1

    @cached_property
    def last(self) -> int | None:
        """The last pair, where a wheel has ends; the first one is 0 then."""
        return next((t.teeth for t in self.toothings if not t.closed), None)

    def holds(self, j: Ints) -> NDArray[np.bool_]:
        """Return which of the pairs `j` are there: none beyond the ends of open wheels."""
        return np.full(j.shape, True) if self.last is None else (j >= 0) & (j <= self.last)

    def _count(self, wheel: Wheel, j: Ints) -> Ints:
        # sf = (j + side/4) pitches is (k + 1/2 - side/4) pitches on wheel 2.
        return j if wheel == 1 or self.side > 0 else j - 1

    def _flank(self, wheel: Wheel, j: Ints) -> Ints:
        toothing, sigma = self.toothings[wheel - 1], self.side if wheel == 1 else -self.side
        z = len(toothing.numbers)
        count = self._count(wheel, j) + 1 - toothing.numbers[0]
        count = count % z if toothing.closed else np.clip(count, 0, z - 1)
        return count + (0 if sigma > 0 else z)

    def place(self, wheel: Wheel, j: Ints) -> Array:
        """Return sf, mm, of the flank of a wheel in pairs `j` (see `FlankPairs`)."""
        toothing = self.toothings[wheel - 1]
        turns = self._count(wheel, j) // toothing.teeth if toothing.closed else 0
        return self.flanks[wheel - 1].sf[self._flank(wheel, j)] + turns * (
            toothing.pitch * toothing.teeth
        )

    def reach(self, wheel: Wheel, j: Ints) -> tuple[Array, Array]:
        """Return the reach w, mm, at root and tip of a wheel's flank (see `FlankPairs`).

        Of pairs that are not there it is infinite, the root above the tip.
        """
        flanks, number, there = self.flanks[wheel - 1], self._flank(wheel, j), self.holds(j)
        low, high = flanks.lowest[number], flanks.highest[number]
        return np.where(there, low, np.inf), np.where(there, high, -np.inf)

    def active(self, j: Ints) -> tuple[Array, Array]:
        """Return the reach w, mm, of the driver's flanks between which pairs `j` touch."""
        (low1, high1), (low2, high2) = self.reach(1, j), self.reach(2, j)
        return np.maximum(low1, -high2), np.minimum(high1, -low2)

    @property
    def pitch(self) -> float:
        """Pitch, mm."""
        return self.toothings[0].pitch

    def near(self, s: Array) -> Ints:
        """Return the pairs that may touch at rolls `s`, mm: (len(s), m)."""
        longest = max(
            float(np.abs(end).max()) for f in self.flanks for end in (f.lowest, f.highest)
        )
        width = math.ceil(longest / self.pitch + 0.5)
        along = (s - self.toothings[0].moved) / self.pitch
        middle = np.rint(along - 0.25 * self.side).astype(np.int64)
        return middle[:, None] + np.arange(-width, width + 1)

    @cached_property
    def arcs(self) -> tuple[Array, Array]:
        """Roll s, mm, between which each flank of the driver's first turn is in contact.

        Of open wheels and racks: each pair from the first to the last.
        """
        j = np.arange(self.toothings[0].teeth if self.last is None else self.last + 1)
        low, high = self.active(j)
        ends = self.place(1, j) - self.side * np.stack([low, high])
        return (ends[1], ends[0]) if self.side > 0 else (ends[0], ends[1])

    @property
    def travel(self) -> float:
        """Length, mm, of a turn of the driver, or of what open wheels and racks roll through."""
        return next((t.length for t in self.toothings if not t.closed), self.toothings[0].length)

    @property
    def contact_ratios(self) -> Array:
        """Contact ratio of each flank of the driver: arc of contact over the pitch."""
        start, end = self.arcs
        return np.maximum(end - start, 0.0) / self.pitch


def flank_pairs(gears: tuple[Gear, Gear], side: int) -> FlankPairs:
    """Return the pairs of flanks of one side.

    Parameters
    ----------
    gears : (Gear, Gear)
        Driver and driven wheel.
    side : {-1, +1}
        `DRIVE` or `COAST`.

    Returns
    -------
    FlankPairs
    """
    first, second = gears
    return FlankPairs(
        toothings=(first.toothing, second.toothing),
        flanks=(first.profile.flanks, second.profile.flanks),
        side=side,
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class Contacts:
    """Points of contact, one entry each.

    Parameters
    ----------
    step : (n,) int array
        Index of the phase.
    pair : (n,) int array
        j.
    reach : (n,) array, mm
        w on the driver's flank; on the driven one it is ``-w``.
    point, force : (n,) complex arrays, mm and 1
        The point, and the unit direction in which the driver presses.
    pressure_angle : (n,) array, rad
        Between the force and the perpendicular to the line of centres; positive pushes them apart.
    sliding : (n,) array, mm/rad
        Sliding speed along the driver's flank, tip outward, per rad of the driver: driver's arc
        less the driven one's.
    specific : (2, n) array
        Specific sliding of both wheels: the difference of the arcs over the wheel's own
        (000, eqs. 4.84, 4.85).
    curvature : (n,) array, 1/mm
        Relative curvature of the flanks.
    lever : (2, n) array, mm
        Distance of the line of the force from both axes.
    """

    step: Ints
    pair: Ints
    reach: Array
    point: Plane
    force: Plane
    pressure_angle: Array
    sliding: Array
    specific: Array
    curvature: Array
    lever: Array


def contacts(pairs: FlankPairs, phi1: ArrayLike) -> Contacts:
    """Return every point of contact of a side at phases.

    Parameters
    ----------
    pairs : FlankPairs
        The side.
    phi1 : (n,) array, rad
        Phases.

    Returns
    -------
    Contacts
        Ordered by phase, then by pair.

    Notes
    -----
    Along the flanks the contact moves by ``dS1 = -g1*ds`` and ``dS2 = g2*ds`` (design formula
    ``g = sigma*sin(alpha) + u*kappa*cos(alpha)``, each with its wheel's sigma and kappa), so that
    ``dS1 - dS2 = -u*cos(alpha)*(kappa1 + kappa2)*ds``: the pitch point's distance times the
    relative turn.
    """
    phi1 = np.atleast_1d(np.asarray(phi1, dtype=float))
    one, two = (t.frames(phi1) for t in pairs.toothings)
    alpha, side = pairs.toothings[0].cutter.alpha, pairs.side
    candidates = pairs.near(one.s)
    reach = side * (pairs.place(1, candidates) - one.s[:, None])
    low, high = pairs.active(candidates)
    step, column = np.nonzero((reach >= low) & (reach <= high))
    w = reach[step, column]
    turned = np.exp(-1j * phi1[step])
    tangent = one.t[step] * turned
    normal = tangent * (np.cos(alpha) + side * np.sin(alpha) * pairs.toothings[0].turn)
    roll = side * w * np.cos(alpha)
    point = one.p[step] * turned + roll * normal
    force = side * normal
    g1 = side * np.sin(alpha) + roll * one.kappa[step]
    g2 = -side * np.sin(alpha) + roll * two.kappa[step]
    distance = pairs.toothings[0].rolling.center_distance
    levers = [np.abs(np.imag(np.conj(point - axis) * force)) for axis in (0.0, distance)]
    with np.errstate(divide="ignore"):
        specific = np.stack([(g1 + g2) / g1, (g1 + g2) / g2])
        curvature = side * (one.kappa[step] / g1 - two.kappa[step] / g2)
    return Contacts(
        step=step,
        pair=candidates[step, column],
        reach=w,
        point=point,
        force=force,
        pressure_angle=np.arctan2(force.real, side * force.imag),
        sliding=-(g1 + g2) * one.speed[step],
        specific=specific,
        curvature=curvature,
        lever=np.stack(levers),
    )


def count(pairs: FlankPairs, phi1: ArrayLike) -> Ints:
    """Return how many pairs of a side carry at phases (see `contacts`)."""
    phi1 = np.atleast_1d(np.asarray(phi1, dtype=float))
    s = pairs.toothings[0].rolling.arc_length(phi1)
    candidates = pairs.near(s)
    reach = pairs.side * (pairs.place(1, candidates) - s[:, None])
    low, high = pairs.active(candidates)
    return np.count_nonzero((reach >= low) & (reach <= high), axis=1)


def stretches(pairs: FlankPairs) -> tuple[Array, Array, Ints]:
    """Return the stretches of a turn of the driver on which the number of pairs is constant.

    Of open wheels and racks it is their travel.

    Parameters
    ----------
    pairs : FlankPairs
        The side.

    Returns
    -------
    start, end : (m,) arrays, rad
        Driver angles.
    carrying : (m,) int array
        Pairs that carry there: 1 on single-pair arcs, 2 on double-pair arcs, 0 where none drives.
    """
    rolling = pairs.toothings[0].rolling
    turn = pairs.travel
    start, end = pairs.arcs
    alive = end > start
    edges = np.concatenate([start[alive], end[alive]])
    edges = np.mod(edges, turn) if pairs.last is None else np.clip(edges, 0.0, turn)
    edges = np.unique(np.concatenate([[0.0], edges, [turn]]))
    edges = edges[np.append(np.diff(edges) > 1e-12 * turn, True)]
    angles = rolling.angle(edges)
    carrying = count(pairs, rolling.angle(0.5 * (edges[:-1] + edges[1:])))
    return angles[:-1], angles[1:], carrying
