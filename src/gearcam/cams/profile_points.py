"""The points of a cam profile: cleaned, and bounded by blocks.

Refused: fewer than eight points, of a plate fewer than three, numbers that are not finite, a
profile that does not go around the cam's axis once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gearcam.errors import InfeasibleError
from gearcam.numeric.arrays import Array, Ints, Plane
from gearcam.numeric.bulges import as_complex
from gearcam.numeric.sampling import FEWEST

_CORNER: Final = 0.5
"""Turn between two chords of a plate, rad, that hardly a curve makes: one of its corners."""

_LEAST: Final = 3
"""Points of a plate at least: it may be straight from corner to corner."""

_BLOCK: Final = 8
"""Chords of a block at least, where there are as many."""

_ALIKE: Final = 1e-12
"""Distance over the profile's size below which neighbours are one point: rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ProfilePoints:
    """The points of a profile.

    Parameters
    ----------
    points : (n,) complex array, mm
        Counter-clockwise around the cam's axis at 0, no neighbours alike, first not repeated.
    corner : float, rad
        Turn from which on a point is a corner, whose chords are straight.
    missed : float, mm
        What any chord may miss; 0 where that is not known.
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
        """From each point to the next, mm."""
        return np.roll(self.points, -1) - self.points

    @cached_property
    def sagitta(self) -> Array:
        """Estimated height of the curve over each chord, mm: the larger of those from its ends."""
        length, turn = np.abs(self.chords), self._turns.copy()
        # all of a turn may be in the arc over one chord, but no chord misses more than it may
        bent = _bent(turn)
        arcs = 0.25 * length * np.maximum(bent, np.roll(bent, -1))
        turn[np.abs(turn) >= self.corner] = 0.0
        back = _heights(length[::-1], np.roll(turn[::-1], 1))[::-1]
        likely = np.maximum(_heights(length, turn), back)
        return np.maximum(likely, np.minimum(arcs, self.missed))

    @cached_property
    def hollow(self) -> Array:
        """The same below each chord, mm: of one that turns left at both ends what it may miss."""
        right = np.minimum(self._turns, np.roll(self._turns, -1)) < 0.0
        return np.where(right, self.sagitta, np.minimum(self.sagitta, self.missed))

    @cached_property
    def _turns(self) -> Array:
        """Turn at each point from the chord before, rad."""
        return np.angle(self.chords * np.conj(np.roll(self.chords, 1)))

    @cached_property
    def blocks(self) -> tuple[Ints, Plane, Array]:
        """Blocks of neighbouring chords, and a disc around the curve over each.

        Returns
        -------
        chords : (b, k) int array
            Their numbers; the last block begins earlier, so that it is full too.
        middle : (b,) complex array, mm
        radius : (b,) array, mm
            The estimated heights of the curve are counted twice.
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
    """Return the largest turns of curves at points, rad.

    Beside one to the other side a turn is what is left of bends to both: as large as that one.
    """
    besides = [np.roll(turn, step) for step in (-1, 1)]
    return np.max([np.abs(turn), *(-np.sign(turn) * one for one in besides)], axis=0)


def _heights(length: Array, turn: Array) -> Array:
    """Return heights of a curve over chords, mm, from the turns at their starts, rad.

    Both chords of a turn are taken to stand off the curve alike, as far as the turn before is as
    large: a long chord between short ones is straight. By what the turn is larger the chord itself
    is bent, as over a gap in the points, at most as the circle through both chords.
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
        A closed profile in order, either way around; equal neighbours are dropped.
    around : bool
        Whether it goes around the cam's axis; one that slides has none.
    missed : float, mm
        What any chord may miss; 0 where that is not known.

    Returns
    -------
    ProfilePoints

    Raises
    ------
    InfeasibleError
        If the points are no closed profile around the cam's axis.
    """
    z = in_plane(points)
    if not np.all(np.isfinite(z)):
        raise InfeasibleError(
            "the profile holds numbers that are not finite",
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
            nearest="one closed line in order, with the origin inside",
        )
    return ProfilePoints(points=z if turns > 0.0 else z[::-1].copy(), missed=missed)


def in_plane(points: Plane | Array) -> Plane:
    """Return points, complex numbers (n,) or pairs (n, 2), as complex numbers."""
    if np.iscomplexobj(points):
        return np.asarray(points, dtype=np.complex128)
    return as_complex(np.asarray(points, dtype=np.float64))
