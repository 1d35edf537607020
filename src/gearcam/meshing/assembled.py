"""First contact of many assemblies of a pair at the same phases.

Assemblies of a pair differ little. What is the same for all of them is computed once:

- which pairs of flanks may touch at a phase;
- how far an end of a flank stays from touching first in the pair as designed. In an assembly only
  those ends are looked at that its errors could bring forward.

All flanks of a side of a wheel are parallel curves, also of an eccentric wheel. So at a phase they
share one common normal, and errors of pitch change it a little from pair to pair. Nothing else is
assumed: flanks are brought into contact where the errors have put them, as by
`gearcam.meshing.edges.first_touch`, which is asked where this is not enough: near jumps of the
curvature, where no flanks touch, and with errors as large as teeth.

Inputs and outputs are those of `first_touch`: driver angles in rad; leads of the driven wheel in
rad, of a rack in mm. Nothing is refused.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.gears.contact import FlankPairs, FlankPositions, Mounting, flank_pairs, normals, touch
from gearcam.meshing.assembly import Gears
from gearcam.meshing.contact import contacts
from gearcam.meshing.edges import (
    Rounding,
    common,
    ends_meeting,
    ends_of,
    first_touch,
    heights_of,
    of_leading_pair,
    pitch_points,
    placed,
    rounding_at,
    to_pitch_line,
)
from gearcam.numeric.arrays import Array, Ints, Mask
from gearcam.numeric.roots import solve

_LARGE: Final = 0.25
"""Displacement, in modules, from which an assembly is searched in full."""

_SAFE: Final = 4.0
"""Factor of the distance to which errors can bring an end forward, to first order."""

_BESIDE: Final = 0.02
"""Distance from the ends of a flank, in pitches, to which a common normal is found exactly."""

_JUMP: Final = 0.5
"""Distance from a jump of the curvature, in pitches, in which flanks may touch twice."""

_FARTHER: Final = 20.0
"""The same, in displacements."""

_SMALL: Final = 1e-7
"""Step, in pitches, after which the next one is below rounding."""

_STEPS: Final = 6
"""Largest number of Newton steps from the normal without errors of pitch: two suffice."""

_FREE: Final = slice(1, 4)
"""The unknowns at a phase: both rolls and the lead."""


@dataclass(frozen=True, eq=False, kw_only=True)
class _Ends(ShortRepr):
    """Ends of flanks in the pair as designed, one entry each.

    Parameters
    ----------
    step, pair : (n,) int arrays
        Number of the phase; j.
    upper : (n,) bool array
        Which end of the common heights it is.
    gap : (n,) array, rad, of a rack mm
        The driven wheel's turn until it touches, from where the first flanks touch.
    nearer : (n,) array, rad/mm
        By how much a displacement of a wheel can change that, at most.
    each : (n,) array, rad/mm
        By how much an error of pitch can.
    """

    step: Ints
    pair: Ints
    upper: Mask
    gap: Array
    nearer: Array
    each: Array

    def within(self, moved: float, error: float, module: float) -> Mask:
        """Return which of them may touch first in an assembly.

        Parameters
        ----------
        moved : float, mm
            Displacements of both wheels together.
        error : float, mm
            Errors of pitch of both wheels together.
        module : float, mm
            The module.
        """
        change = moved * self.nearer + (error + moved * moved / module) * self.each
        return self.gap <= _SAFE * change


@dataclass(frozen=True, eq=False, kw_only=True)
class _Touching(ShortRepr):
    """Common normals of flanks, one entry each.

    Parameters
    ----------
    step : (n,) int array
        Number of the phase.
    lead : (n,) array, rad, of a rack mm
        Turn of the driven wheel.
    within : (n,) bool array
        Whether it meets both flanks.
    lost : (n,) bool array
        Whether it was not found.
    """

    step: Ints
    lead: Array
    within: Mask
    lost: Mask


@dataclass(frozen=True, eq=False, kw_only=True)
class AssembledSide(ShortRepr):
    """A side of a pair at phases of the driver, and what is the same for its assemblies.

    Parameters
    ----------
    gears : (Gear, Gear)
        The wheels.
    side : {-1, +1}
        `DRIVE` or `COAST`.
    phi1 : (n,) array, rad
        The phases.
    """

    gears: Gears
    side: int
    phi1: Array

    @cached_property
    def designed(self) -> FlankPairs:
        """The side of the pair as designed."""
        return flank_pairs(self.gears, self.side)

    @cached_property
    def along(self) -> Array:
        """Arcs along the pitch curve per turn of the driven wheel, (n,) mm/rad."""
        return to_pitch_line(self.designed, self.phi1)

    @cached_property
    def rounding(self) -> Rounding:
        """To how much leads are known."""
        return rounding_at(self.designed, self.phi1)

    def leads(self, mounting: Mounting) -> Array:
        """Return the driven wheel's leads at first contact of an assembly.

        Parameters
        ----------
        mounting : Mounting
            How it is mounted and made.

        Returns
        -------
        (n,) array, rad, of a rack mm
            As of `gearcam.meshing.edges.first_touch`.
        """
        pairs, module = flank_pairs(self.gears, self.side, mounting), self.gears[0].pair.module
        moved = abs(mounting.distance - self.designed.distance) + sum(map(abs, mounting.eccentric))
        error = sum(max(map(abs, one.values()), default=0.0) for one in mounting.pitch)
        if not self.designed.numbers.size or moved + error > _LARGE * module:
            return self._in_full(pairs, self.phi1)
        found = self._touching(pairs)
        outward = of_leading_pair(
            self.side, len(self.phi1), found.step[found.within], found.lead[found.within]
        )
        left = ~np.isfinite(outward) | (self._to_jump <= _FARTHER * (moved + error))
        left[found.step[found.lost]] = True
        if not pairs.even:
            ends = self._ends.within(moved, error, module) & ~left[self._ends.step]
            outward = np.maximum(outward, self._brought_forward(pairs, ends))
        lead = -self.side * outward
        lead[np.abs(lead) <= self.rounding.of(pairs)] = 0.0
        if left.any():
            lead[left] = self._in_full(pairs, self.phi1[left])
        return lead

    @staticmethod
    def _in_full(pairs: FlankPairs, phi1: Array) -> Array:
        return first_touch(pairs, phi1, contacts(pairs, phi1))[0]

    def _touching(self, pairs: FlankPairs) -> _Touching:
        """Return the common normals of pairs that may touch, from that of each phase."""
        base, at, found = touch(pairs, self.phi1, np.full(self.phi1.shape, self._separation))
        step, pair = self._beside
        apart = pairs.separation(pair) - self._separation
        rates = np.array([[0.0], [math.cos(self.gears[0].toothing.cutter.alpha)], [0.0]])
        rates = -solve(at.slopes[:, _FREE], np.broadcast_to(rates, (3, len(self.phi1))))
        rolls = np.stack([base.one, base.two, base.lead])[:, step] + rates[:, step] * apart
        arcs = [
            frames.s[step] + frames.speed[step] * rate[step] * apart
            for frames, rate in zip(at.frames, rates, strict=False)
        ]
        some = np.flatnonzero(self._reached(pairs, pair, arcs, _BESIDE * pairs.pitch) & found[step])
        lost = np.flatnonzero(~found)
        step, pair, apart, rolls = step[some], pair[some], apart[some], rolls[:, some]
        arcs = [one[some] for one in arcs]
        missed = np.zeros(len(some), dtype=bool)
        if apart.any():
            arcs, missed = self._refined(pairs, step, apart, rolls)
        return _Touching(
            step=np.concatenate([step, lost]),
            lead=np.concatenate([rolls[2], np.zeros(len(lost))]),
            within=np.concatenate([self._reached(pairs, pair, arcs, 0.0), lost < 0]),
            lost=np.concatenate([missed, lost >= 0]),
        )

    def _refined(
        self, pairs: FlankPairs, step: Ints, apart: Array, rolls: Array
    ) -> tuple[list[Array], Mask]:
        """Bring `rolls`, (3, n), to the common normals of pairs `apart` by errors of pitch.

        Returns
        -------
        arcs : list of two (n,) arrays, mm
            Arc lengths of both rolls.
        missed : (n,) bool array
            Whether it was not found.
        """
        arcs, rows = np.empty((2, len(step))), np.arange(len(step))
        for _ in range(_STEPS):
            positions = FlankPositions(self.phi1[step[rows]], *rolls[:, rows])
            motion = self._motion[:, step[rows]]
            at = normals(pairs, positions, self._separation + apart[rows], motion)
            change = -solve(at.slopes[:, _FREE], at.equations)
            rolls[:, rows] += change
            size = np.zeros(len(rows))
            for frames, arc, by in zip(at.frames, arcs, change, strict=False):
                arc[rows] = frames.s + frames.speed * by
                size = np.maximum(size, np.abs(frames.speed * by))
            rows = rows[~(size <= _SMALL * pairs.pitch)]
            if not rows.size:
                break
        return [*arcs], np.isin(np.arange(len(step)), rows)

    def _reached(self, pairs: FlankPairs, pair: Ints, arcs: Sequence[Array], beside: float) -> Mask:
        """Return whether rolls at `arcs`, mm, meet both flanks of each pair, or pass them by less.

        `beside` is the largest distance, mm, by which they may pass.
        """
        inside = np.ones(len(pair), dtype=bool)
        for wheel, arc in zip(pairs.wheels, arcs, strict=True):
            low, high = wheel.reach(pair)
            along = wheel.sigma * (wheel.place(pair) - arc)
            inside &= (along >= low - beside) & (along <= high + beside)
        return inside

    def _brought_forward(self, pairs: FlankPairs, some: Mask) -> Array:
        """Return to which turn `some` of the ends push the driven wheel, (n,); -inf without any."""
        ends = self._ends
        every = placed(pairs, self.phi1, ends.step[some], ends.pair[some])
        heights = heights_of(every)
        shared = common(heights)
        met = ends_of(every.select(shared), heights[..., shared], ends.upper[some][shared])
        return of_leading_pair(self.side, len(self.phi1), met.faced.step, met.turn)

    @cached_property
    def _motion(self) -> Array:
        return self.designed.guide.motion(self.phi1)

    @cached_property
    def _beside(self) -> tuple[Ints, Ints]:
        return self.designed.beside(self.phi1)

    @cached_property
    def _separation(self) -> float:
        """The separation sf2 - sf1 of pairs without errors of pitch, mm."""
        return float(self.designed.separation(self.designed.numbers[:1])[0])

    @cached_property
    def _to_jump(self) -> Array:
        """Distance of phases to a jump of the curvature, (n,) mm: infinite where none is near."""
        pairs, track = self.designed, self.designed.track
        speed = track.frames(self.phi1, curved=False).speed
        reach = _JUMP * pairs.pitch / speed
        near, knot = track.jumps_between(self.phi1 - reach, self.phi1 + reach, pairs.pitch)
        away = np.full(self.phi1.shape, np.inf)
        np.minimum.at(away, near, np.abs(knot - self.phi1[near]) * speed[near])
        return away

    @cached_property
    def _ends(self) -> _Ends:
        pairs = self.designed
        met = ends_meeting(pairs, self.phi1)
        first = -self.side * self._in_full(pairs, self.phi1)
        foot, normal = pitch_points(pairs, self.phi1)
        mate = 1j * np.where(met.edge_of == 1, met.directions[1], met.directions[0])
        with np.errstate(divide="ignore", invalid="ignore"):
            end = mate / pairs.guide.lever(met.points[0], mate)
            touching = (normal / pairs.guide.lever(foot, normal))[met.faced.step]
        return _Ends(
            step=met.faced.step,
            pair=met.faced.pair,
            upper=met.tip == (met.edge_of == 2),
            gap=np.where(np.isfinite(first), first, 0.0)[met.faced.step] + self.side * met.turn,
            nearer=np.nan_to_num(np.abs(end - touching), nan=np.inf),
            each=np.nan_to_num(np.abs(end) + np.abs(touching), nan=np.inf),
        )
