"""What guides the driven element: a shaft, on which it turns, or a slide, on which a rack moves.

Seen from its guide a driven element has *heights* that grow from its roots to its tips: distances
from the shaft, or of a rack the way towards the driver. A turn changes no height. So two curves
are compared at equal heights, whichever guide there is, and what is found is a turn: in rad, of a
rack in mm. It grows as the nominal motion does with rising phi1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from gearcam.gears.rolling import Plane, Rolling

Array = NDArray[np.float64]


class Guide(Protocol):
    """What guides the driven element; points are seen from there, as complex numbers in mm."""

    def stand(self, phi1: Array, lead: Array | float) -> tuple[Plane, Plane]:
        """Return the turn and shift that put its points where they stand at driver angles.

        Parameters
        ----------
        phi1 : (n,) array, rad
            Phases.
        lead : (n,) array or float, rad, of a rack mm
            How far it is ahead of them.

        Returns
        -------
        turn, shift : (n,) complex arrays, 1 and mm
        """
        ...

    def height(self, points: Plane) -> Array:
        """Return the heights of points, mm."""
        ...

    def turn(self, points: Plane, others: Plane) -> Array:
        """Return the turns, rad or mm, that take `others` to `points` of the same heights."""
        ...

    def rates(self, points: Plane, directions: Plane) -> tuple[Array, Array]:
        """Return how heights grow at points in `directions`, and how turns do."""
        ...

    def lever(self, points: Plane, directions: Plane) -> Array:
        """Return how far points move in `directions`, unit vectors, over a turn of 1, mm or 1."""
        ...


@dataclass(frozen=True, kw_only=True)
class Shaft:
    """A shaft, seen as the origin; the driver is to its left, that rolls: `rolling`."""

    rolling: Rolling

    def stand(self, phi1: Array, lead: Array | float) -> tuple[Plane, Plane]:
        """See `Guide`."""
        turn = np.exp(1j * (self.rolling.law.phi2(phi1) + lead))
        return turn, np.zeros_like(turn)

    def height(self, points: Plane) -> Array:
        """See `Guide`."""
        return np.abs(points)

    def turn(self, points: Plane, others: Plane) -> Array:
        """See `Guide`."""
        return np.angle(points * np.conj(others))

    def rates(self, points: Plane, directions: Plane) -> tuple[Array, Array]:
        """See `Guide`."""
        size = np.abs(points)
        along = np.conj(points) * directions / size
        return along.real, along.imag / size

    def lever(self, points: Plane, directions: Plane) -> Array:
        """See `Guide`."""
        return np.imag(np.conj(points) * directions)


@dataclass(frozen=True, kw_only=True)
class Slideway:
    """A slide across the line of centres: seen from the rack's place at phi1 = 0 of `rolling`.

    The rack moves downwards, as the driver's pitch point does.
    """

    rolling: Rolling

    def stand(self, phi1: Array, lead: Array | float) -> tuple[Plane, Plane]:
        """See `Guide`."""
        way = self.rolling.center_distance * self.rolling.law.phi2(phi1) + lead
        return np.ones(len(way), dtype=np.complex128), np.asarray(-1j * way, dtype=np.complex128)

    def height(self, points: Plane) -> Array:
        """See `Guide`."""
        return -points.real

    def turn(self, points: Plane, others: Plane) -> Array:
        """See `Guide`."""
        return others.imag - points.imag

    def rates(self, points: Plane, directions: Plane) -> tuple[Array, Array]:  # noqa: ARG002
        """See `Guide`."""
        return -directions.real, -directions.imag

    def lever(self, points: Plane, directions: Plane) -> Array:  # noqa: ARG002
        """See `Guide`."""
        return -directions.imag


def guide_of(rolling: Rolling) -> Guide:
    """Return what guides the driven element of a pair of centrodes."""
    return Slideway(rolling=rolling) if rolling.law.feeds else Shaft(rolling=rolling)
