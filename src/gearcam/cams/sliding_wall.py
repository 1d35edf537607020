"""Open walls of a plate that slides, and the contours that they form with its edges.

A *stretch* is a part of a contour: runs, and the vertices of its polygon. Beyond its ends a wall
follows the roller until it is level, and continues level to the plate's end.

Refused: walls that are narrower than their chord error.

Depends on wall, trim and numeric.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.cams.trim import crossing_chords
from gearcam.cams.wall import OVERSAMPLING, Wall
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.bulges import as_pairs
from gearcam.numeric.contour import Contour, Run

_DENSE = 1 / 40
"""Chord error of dense points over the tolerance."""

_FEWEST = 8
"""Fewest chords of an arc."""

_ALIKE = 1e-11
"""Distance of corners, in sizes of the plate, below which they are merged: rounding."""

Stretch = tuple[tuple[Run, ...], Array]
"""Runs of a part of a contour, and its vertices, (n, 2), mm, without the last."""


@dataclass(frozen=True, kw_only=True)
class Plate(ShortRepr):
    """The plate from which a translating cam is cut, mm, in the cam's frame.

    Parameters
    ----------
    left, right : float
        Its ends.
    low, high : float
        Its lower and upper edge; a cam with one wall has no upper edge.
    """

    left: float
    right: float
    low: float
    high: float


@dataclass(frozen=True, eq=False, kw_only=True)
class SlidingWall(Wall):
    """An open wall; its contour is that of the metal behind it.

    Parameters
    ----------
    plate : Plate
        The plate from which it is cut.
    """

    plate: Plate

    @cached_property
    def line(self) -> Array:
        """Vertices of the wall, (n, 2), mm, from the beginning of the travel to its end."""
        return as_pairs(self.sampler.chords[1])

    @cached_property
    def pitch_line(self) -> Array:
        """Vertices of the pitch curve, (n, 2), mm, from the beginning of the travel to its end."""
        return as_pairs(self._pitch_sampler.chords[1])

    def stretch(self, *, reverse: bool = False) -> Stretch:
        """Return the wall as a part of a contour, from right to left, or in `reverse`."""
        runs = self.sampler.dense(OVERSAMPLING).runs(reverse)
        return runs, (self.line[::-1] if reverse else self.line)[:-1]

    @cached_property
    def contour(self) -> Contour:
        """Outline of the metal behind the wall, counter-clockwise, verified to be simple."""
        ways = np.diff(self.line[:, 0])
        seen_whole = bool(np.all(ways > 0.0) or np.all(ways < 0.0))
        if not seen_whole and not self._metal.polygon.is_valid:
            raise crossing_chords(
                self.called,
                self.sampler,
                lambda finer: replace(self, tolerance=finer.tolerance)._metal,
            )
        return self._metal

    @cached_property
    def _metal(self) -> Contour:
        plate = self.plate
        edge = plate.low if self.side > 0 else plate.high
        left, last = self._level(-1, plate.left)
        right, first = self._level(0, plate.right)
        corners = np.array([
            last, (plate.left, last[1]), (plate.left, edge),
            (plate.right, edge), (plate.right, first[1]), first,
        ])  # fmt: skip
        if self.side > 0:
            around = [self.stretch(), *left, straight(corners), *_turned(right)]
        else:  # the metal lies above, the wall runs from left to right
            back = straight(corners[::-1])
            around = [self.stretch(reverse=True), *right, back, *_turned(left)]
        return joined(around, self)

    def _level(self, which: int, limit: float) -> tuple[list[Stretch], Array]:
        """Return the continuation from an end of the wall, and the point where it is level.

        It follows the roller's circle where that reaches farther than the wall, up to a limit.
        """
        center, start = (complex(*line[which]) for line in (self.pitch_line, self.line))
        outwards = -1.0 if which else 1.0
        far = outwards * min(outwards * center.real, outwards * limit)
        if not outwards * (far - start.real) > _ALIKE * (self.plate.right - self.plate.left):
            return [], self.line[which]
        aside = far - center.real
        deep = math.sqrt((self.follower.radius - aside) * (self.follower.radius + aside))
        end = complex(far, center.imag - self.side * deep)
        turn = float(np.angle((end - center) / (start - center)))
        return [arc(self, center, start, turn)], np.array([end.real, end.imag])


def _turned(stretches: Sequence[Stretch]) -> list[Stretch]:
    """Return stretches in the opposite sense."""
    made = []
    for runs, vertices in stretches:
        back = tuple(run.reversed for run in reversed(runs))
        made.append((back, np.vstack([back[0].points[:1], vertices[:0:-1]])))
    return made


def straight(corners: Array) -> Stretch:
    """Return straight runs.

    Parameters
    ----------
    corners : (n, 2) array, mm
        Corners in order; there is no run between merged ones.

    Returns
    -------
    Stretch
    """
    made, alike = [], _ALIKE * float(np.ptp(corners, axis=0).max())
    for one, two in pairwise(corners):
        length = float(np.hypot(*(two - one)))
        if length > alike:
            slope = (two - one) / length
            made.append(Run(points=np.array([one, two]), tangents=np.array([slope, slope])))
    return tuple(made), np.array([run.points[0] for run in made])


def arc(wall: Wall, center: complex, start: complex, turn: float) -> Stretch:
    """Return an arc.

    Parameters
    ----------
    wall : Wall
        With the tolerance.
    center, start : complex, mm
        Its centre and its beginning.
    turn : float, rad
        Angle from there to its end, counter-clockwise positive.

    Returns
    -------
    Stretch
    """
    spoke = start - center

    def points(sagitta: float) -> Plane:
        chord = 2.0 * math.acos(max(0.0, 1.0 - sagitta / abs(spoke)))
        count = max(_FEWEST, math.ceil(abs(turn) / chord))
        return spoke * np.exp(1j * turn * np.linspace(0.0, 1.0, count + 1))

    dense = points(_DENSE * wall.tolerance)
    tangents = math.copysign(1.0, turn) * 1j * dense / abs(spoke)
    run = Run(points=as_pairs(center + dense), tangents=as_pairs(tangents))
    return (run,), as_pairs(center + points(wall.tolerance))[:-1]


def joined(stretches: Sequence[Stretch], wall: Wall) -> Contour:
    """Return the contour of stretches.

    Parameters
    ----------
    stretches : sequence of Stretch
        In order, counter-clockwise, each beginning where the one before it ends.
    wall : Wall
        With the tolerance, and the largest chord error.

    Returns
    -------
    Contour
    """
    return Contour(
        dense=lambda: tuple(run for runs, _ in stretches for run in runs),
        vertices=np.vstack([vertices for _, vertices in stretches]),
        tolerance=wall.tolerance,
        chord_error=wall.sampler.chords[2],
    )
