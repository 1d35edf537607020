"""What guides the driven element: a shaft, on which it turns, or a slide, on which a rack moves.

Seen from its guide a driven element has *heights* that grow from its roots to its tips: distances
from the shaft, or of a rack the distance towards the driver. A turn changes no height. So two
curves are compared at equal heights, whichever guide there is, and what is found is a turn: in rad,
of a rack in mm. It grows as the nominal motion does with rising phi1.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gearcam.display import Brief
from gearcam.laws.ratio.base import RatioLaw
from gearcam.numeric.arrays import Array, Plane


@dataclass(frozen=True, kw_only=True)
class Guide(Brief, ABC):
    """What guides the driven element; points are seen from there, as complex numbers in mm.

    Parameters
    ----------
    law : RatioLaw
        What moves it.
    place : float, mm
        Where its frame is in that of the driver at phi1 = 0, along x: the distance of the shafts,
        0 for a rack, less than 0 for a ring.
    scale : float
        What the law's motion is multiplied by to be a turn: 1, of a rack mm.
    """

    law: RatioLaw
    place: float
    scale: float
    unit: ClassVar[str]
    """Unit of turns."""
    turns: ClassVar[float]
    """By how much a direction turns over a turn of 1, rad: 1, of a rack 0, of a ring -1."""

    def nominal(self, phi1: Array) -> Array:
        """Return the nominal turns at driver angles, rad: rad, of a rack mm."""
        return self.scale * self.law.phi2(phi1)

    def motion(self, phi1: Array) -> Array:
        """Return the nominal turns at driver angles, rad, and their derivative by them, (2, n)."""
        return self.scale * np.stack(self.law.derivatives(phi1, 1))

    @abstractmethod
    def stand(self, moved: Array) -> tuple[Plane, Plane]:
        """Return the turn and shift that put its points where they stand.

        Parameters
        ----------
        moved : (n,) array, rad, of a rack mm
            How far it has turned: as `nominal` tells, and ahead of that.

        Returns
        -------
        turn, shift : (n,) complex arrays, 1 and mm
        """

    @abstractmethod
    def carried(self, points: Plane) -> Plane:
        """Return how points move over a turn of 1: mm, of a rack 1."""

    @abstractmethod
    def height(self, points: Plane) -> Array:
        """Return the heights of points, mm."""

    @abstractmethod
    def turn(self, points: Plane, others: Plane) -> Array:
        """Return the turns, rad or mm, that take `others` to `points` of the same heights."""

    def rates(self, points: Plane, directions: Plane) -> tuple[Array, Array]:
        """Return how heights grow at points in `directions`, and how turns do."""
        moved = self.carried(points)
        size = np.abs(moved)
        along = np.conj(moved) * directions / size
        return -along.imag, along.real / size

    def lever(self, points: Plane, directions: Plane) -> Array:
        """Return how far points move in `directions`, unit vectors, over a turn of 1, mm or 1."""
        return np.real(np.conj(self.carried(points)) * directions)


class Shaft(Guide):
    """A shaft, seen as the origin; the driver is to its left and turns the other way."""

    unit = "rad"
    turns = 1.0

    def stand(self, moved: Array) -> tuple[Plane, Plane]:
        """Return what is promised (see `Guide`)."""
        turn = np.exp(1j * self.turns * moved)
        return turn, np.zeros_like(turn)

    def carried(self, points: Plane) -> Plane:
        """Return what is promised (see `Guide`)."""
        return 1j * self.turns * points

    def height(self, points: Plane) -> Array:
        """Return what is promised (see `Guide`)."""
        return self.turns * np.abs(points)

    def turn(self, points: Plane, others: Plane) -> Array:
        """Return what is promised (see `Guide`)."""
        return self.turns * np.angle(points * np.conj(others))


class RingShaft(Shaft):
    """The shaft of a ring: the driver is to its right, within the ring, and turns as it does.

    The tips of a ring point to the shaft, so that its heights are distances from it less than 0.
    """

    turns = -1.0


class Slideway(Guide):
    """A slide across the line of centres: seen from the rack's place at phi1 = 0.

    The rack moves downwards, as the driver's pitch point does.
    """

    unit = "mm"
    turns = 0.0

    def stand(self, moved: Array) -> tuple[Plane, Plane]:
        """Return what is promised (see `Guide`)."""
        shift = np.asarray(-1j * moved, dtype=np.complex128)
        return np.ones(shift.shape, dtype=np.complex128), shift

    def carried(self, points: Plane) -> Plane:
        """Return what is promised (see `Guide`)."""
        return np.full(np.shape(points), -1j)

    def height(self, points: Plane) -> Array:
        """Return what is promised (see `Guide`)."""
        return -points.real

    def turn(self, points: Plane, others: Plane) -> Array:
        """Return what is promised (see `Guide`)."""
        return others.imag - points.imag
