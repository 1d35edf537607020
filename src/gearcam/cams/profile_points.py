"""The points of a cam profile: cleaned, and bounded by blocks.

Refused: fewer than eight points, for a plate fewer than three, numbers that are not finite, a
profile that does not go around the cam's axis once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.bulges import as_complex
from gearcam.numeric.sampling import FEWEST

_CORNER: Final = 0.5
"""Angle between two chords of a plate, rad, too large for a curve: a corner."""

_LEAST: Final = 3
"""Least number of points of a plate: it may be straight between corners."""

_BLOCK: Final = 8
"""Least number of chords of a block, if there are as many."""

_ALIKE: Final = 1e-12
"""Distance over the profile's size below which neighbours are one point: rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ProfilePoints:
    """The points of a profile.

    Parameters
    ----------
    points : (n,) complex array, mm
        Counter-clockwise around the cam's axis at 0, no equal neighbours, first not repeated.
    corner : float, rad
        Angle from which on a point is a corner, whose chords are straight.
    missed : float, mm
        Chord error of the points; 0 if unknown.
    """

    points: Plane
    corner: float = math.inf
    missed: float = 0.0

    @cached_property
    def size(self) -> float:
        """Largest distance from the axis, mm."""
        return float(np.abs(self.points).max())

    @cached_property
    def chords(self) -> Plane:
        """Vectors from each point to the next, mm."""
        return np.roll(self.points, -1) - self.points

    @cached_property
    def sagitta(self) -> Array:
        """Estimated height of the curve over each chord, mm: the larger of those from both ends."""
        length, turn = np.abs(self.chords), self._turns.copy()
        # the arc over one chord may contain all of the angle, limited by the given chord error
        bent = _bent(turn)
        arcs = 0.25 * length * np.maximum(bent, np.roll(bent, -1))
        turn[np.abs(turn) >= self.corner] = 0.0
        back = _heights(length[::-1], np.roll(turn[::-1], 1))[::-1]
        likely = np.maximum(_heights(length, turn), back)
        return np.maximum(likely, np.minimum(arcs, self.missed))

    @cached_property
    def hollow(self) -> Array:
        """The same below each chord, mm; the chord error if the curve turns left at both ends."""
        right = np.minimum(self._turns, np.roll(self._turns, -1)) < 0.0
        return np.where(right, self.sagitta, np.minimum(self.sagitta, self.missed))

    @cached_property
    def _turns(self) -> Array:
        """Angle at each point from the chord before, rad."""
        return np.angle(self.chords * np.conj(np.roll(self.chords, 1)))

    @cached_property
    def blocks(self) -> tuple[Ints, Plane, Array]:
        """Blocks of neighbouring chords, and a disc around the curve over each.

        Returns
        -------
        chords : (b, k) int array
            Their numbers; the last block overlaps the one before, so that it is full too.
        middle : (b,) complex array, mm
        radius : (b,) array, mm
            With twice the estimated heights of the curve.
        """
        count = len(self.points)
        width = min(count, max(_BLOCK, math.isqrt(count) // 2))
        first = np.minimum(np.arange(0, count, width), count - width)
        index = first[:, None] + np.arange(width)
        reach = self.points[(first[:, None] + np.arange(width + 1)) % count]
        middle = 0.5 * (reach[:, 0] + reach[:, -1])
        radius = np.abs(reach - middle[:, None]).max(axis=1)
        return index, middle, radius + 2.0 * self.sagitta[index].max(axis=1)


def _bent(turn: Array) -> Array:
    """Return the largest angles of curves at points, rad.

    Next to an angle of opposite sign both may be differences of larger bends: at least as large as
    their neighbour.
    """
    besides = [np.roll(turn, step) for step in (-1, 1)]
    return np.max([np.abs(turn), *(-np.sign(turn) * one for one in besides)], axis=0)


def _heights(length: Array, turn: Array) -> Array:
    """Return heights of a curve over chords, mm, from the angles at their starts, rad.

    Up to the size of the angle before, both chords at an angle have equal heights: a long chord
    between short ones is straight. Any excess of the angle is a bend of the chord itself, as over a
    gap in the points, at most that of the circle through both chords.
    """
    before = np.roll(length, 1)
    bend = 0.25 * np.abs(turn) * length / (length + before)
    more = 0.25 * length * (np.abs(turn) - np.sign(turn) * np.roll(turn, 1))
    return np.minimum(bend * length, bend * before + np.maximum(more, 0.0))


def profile_points(
    points: Plane | Array, around: bool = True, missed: float = 0.0
) -> ProfilePoints:
    """Return the points of a profile, cleaned.

    Parameters
    ----------
    points : (n,) complex array or (n, 2) array, mm
        A closed profile in order, in either sense; equal neighbours are dropped.
    around : bool
        Whether it goes around the cam's axis, as for a cam that turns.
    missed : float, mm
        Chord error of the points; 0 if unknown.

    Returns
    -------
    ProfilePoints

    Raises
    ------
    InfeasibleError
        If the points are not a closed profile around the cam's axis.
    """
    z = in_plane(points)
    if not np.all(np.isfinite(z)):
        raise InfeasibleError(
            "the profile contains numbers that are not finite",
            where=f"point {int(np.argmin(np.isfinite(z)))}",
        )
    z = z[np.abs(z - np.roll(z, 1)) > _ALIKE * np.abs(z).max(initial=0.0)]
    least = FEWEST if around else _LEAST
    if len(z) < least:
        raise InfeasibleError(
            "the profile has too few points", value=len(z), limit=least, unit="points"
        )
    if not around:
        turned = float((np.conj(z) * np.roll(z, -1)).imag.sum())
        points = z if turned > 0.0 else z[::-1].copy()
        return ProfilePoints(points=points, corner=_CORNER, missed=missed)
    turns = float(np.angle(np.roll(z, -1) * np.conj(z)).sum()) / (2.0 * math.pi)
    if abs(abs(turns) - 1.0) > 0.25 or not np.all(z):
        raise InfeasibleError(
            "the profile does not go around the cam's axis once",
            value=turns,
            limit=1.0,
            unit="turns",
            nearest="give one closed line in order, with the origin inside",
        )
    return ProfilePoints(points=z if turns > 0.0 else z[::-1].copy(), missed=missed)


def in_plane(points: Plane | Array) -> Plane:
    """Return points, complex numbers (n,) or pairs (n, 2), as complex numbers."""
    if np.iscomplexobj(points):
        return np.asarray(points, dtype=np.complex128)
    return as_complex(np.asarray(points, dtype=np.float64))
