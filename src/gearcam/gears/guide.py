"""The guide of the driven element: a shaft on which it turns, or a slide on which a rack moves.

Relative to its guide a driven element has *heights* that grow from its roots to its tips: distances
from the shaft, or for a rack the distance towards the driver. Its motion, here called a *turn*,
changes no height. So two curves are compared at equal heights with either guide, and the result is
a turn in rad, for a rack in mm; positive as the nominal motion with rising phi1.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.laws.ratio.base import RatioLaw
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.pose import Pose


@dataclass(frozen=True, kw_only=True)
class Guide(ShortRepr, ABC):
    """Guide of the driven element; points relative to it are complex numbers in mm.

    Parameters
    ----------
    law : RatioLaw
        Its motion.
    place : float, mm
        Position of its frame in that of the driver at phi1 = 0, along x: the centre distance,
        0 for a rack, negative for a ring.
    scale : float
        Factor from the law's motion to a turn: 1, for a rack a length in mm.
    """

    law: RatioLaw
    place: float
    scale: float
    unit: ClassVar[str]
    """Unit of turns."""
    turns: ClassVar[float]
    """Rotation of directions per turn of 1: 1 rad, for a rack 0, for a ring -1 rad."""

    def nominal(self, phi1: Array) -> Array:
        """Return the nominal turns at driver angles, rad: in rad, for a rack in mm."""
        return self.scale * self.law.phi2(phi1)

    def motion(self, phi1: Array) -> Array:
        """Return the nominal turns at driver angles, rad, and their derivatives, (2, n)."""
        return self.scale * np.stack(self.law.derivatives(phi1, 1))

    @abstractmethod
    def pose(self, moved: Array) -> Pose:
        """Return the poses of the driven element, relative to its guide.

        Parameters
        ----------
        moved : (n,) array, rad, of a rack mm
            Turn from phi1 = 0: `nominal` plus any lead.
        """

    @abstractmethod
    def carried(self, points: Plane) -> Plane:
        """Return the velocity of points per turn: mm, for a rack 1."""

    @abstractmethod
    def height(self, points: Plane) -> Array:
        """Return the heights of points, mm."""

    @abstractmethod
    def turn(self, points: Plane, others: Plane) -> Array:
        """Return the turns, rad or mm, that move `others` to `points` of equal heights."""

    def rates(self, points: Plane, directions: Plane) -> tuple[Array, Array]:
        """Return derivatives of heights and of turns at points in `directions`."""
        moved = self.carried(points)
        size = np.abs(moved)
        along = np.conj(moved) * directions / size
        return -along.imag, along.real / size

    def lever(self, points: Plane, directions: Plane) -> Array:
        """Return the velocity of points per turn along unit vectors `directions`, mm or 1."""
        return np.real(np.conj(self.carried(points)) * directions)


class Shaft(Guide):
    """A shaft as the origin; the driver is to its left and turns the other way."""

    unit = "rad"
    turns = 1.0

    def pose(self, moved: Array) -> Pose:
        """Return the poses of the driven element (see `Guide.pose`)."""
        return Pose(self.turns * moved, np.zeros(moved.shape, dtype=np.complex128))

    def carried(self, points: Plane) -> Plane:
        """Return the velocity of points per turn (see `Guide.carried`)."""
        return 1j * self.turns * points

    def height(self, points: Plane) -> Array:
        """Return the heights of points, mm (see `Guide.height`)."""
        return self.turns * np.abs(points)

    def turn(self, points: Plane, others: Plane) -> Array:
        """Return the turns that move `others` to `points` (see `Guide.turn`)."""
        return self.turns * np.angle(points * np.conj(others))


class RingShaft(Shaft):
    """The shaft of a ring: the driver is to its right, within the ring, and turns as it does.

    The tips of a ring point to the shaft: its heights are negative distances from it.
    """

    turns = -1.0


class Slideway(Guide):
    """A slide across the line of centres; the origin is the rack's position at phi1 = 0.

    The rack moves downwards, as the driver's pitch point does.
    """

    unit = "mm"
    turns = 0.0

    def pose(self, moved: Array) -> Pose:
        """Return the poses of the driven element (see `Guide.pose`)."""
        return Pose(np.zeros(moved.shape), -1j * moved)

    def carried(self, points: Plane) -> Plane:
        """Return the velocity of points per turn (see `Guide.carried`)."""
        return np.full(np.shape(points), -1j)

    def height(self, points: Plane) -> Array:
        """Return the heights of points, mm (see `Guide.height`)."""
        return -points.real

    def turn(self, points: Plane, others: Plane) -> Array:
        """Return the turns that move `others` to `points` (see `Guide.turn`)."""
        return others.imag - points.imag
