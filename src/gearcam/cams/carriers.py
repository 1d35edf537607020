"""What a cam does beneath its follower: it turns, or it slides.

The follower stands in the fixed frame, the cam's frame moves. A cam that turns does so
counter-clockwise about the origin, and a point of the fixed frame moves ``exp(-i*x)`` times within
the cam's frame; one that slides moves along ``-x``, so that a fixed point moves along ``+x`` in it.
(Output of a sliding cam is the mirror image.)

Depends on numeric; numpy only.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from gearcam.base.display import Brief
from gearcam.numeric.arrays import Array, Plane
from gearcam.numeric.jets import Jet

Pair = tuple[Jet | float, Jet | float]
"""Real and imaginary part of a vector."""


def unit(angle: Array) -> Plane:
    """Return unit vectors at angles (n,), rad."""
    result = np.empty(np.shape(angle), dtype=np.complex128)
    result.real, result.imag = np.cos(angle), np.sin(angle)
    return result


class Carrier(ABC, Brief):
    """The motion of a cam, by a driver position x: rad of a turn, or a share of a travel."""

    rate: float
    """Rotating of the fixed frame seen from the cam's, backwards, rad per unit of x."""

    @abstractmethod
    def seen(self, ahead: Pair, at: Pair) -> Pair:
        """Return the velocity of a follower's centre at rest, seen from the cam.

        Parameters
        ----------
        ahead, at : pairs
            ``i*conj(t)`` and ``conj(t)*C`` for the centre C and the follower's direction t.

        Returns
        -------
        pair, mm per unit of x
            In axes of the follower: across its direction, and against it.
        """

    @abstractmethod
    def under(self, x: Array, z: Plane) -> Plane:
        """Return points z, mm, of the fixed frame in the cam's frame at driver positions x."""


@dataclass(frozen=True)
class Rotating(Carrier):
    """A cam that turns counter-clockwise about the origin."""

    rate = 1.0

    def seen(self, ahead: Pair, at: Pair) -> Pair:  # noqa: ARG002
        """Return ``conj(t)*C``, as ``U = -i*C`` (see `Carrier.seen`)."""
        return at

    def under(self, x: Array, z: Plane) -> Plane:
        """Return the points turned back (see `Carrier.under`)."""
        return z * unit(-x)


@dataclass(frozen=True)
class Sliding(Carrier):
    """A cam that slides along ``-x``.

    Parameters
    ----------
    scale : float, mm
        Travel per unit of the driver position.
    """

    scale: float

    rate = 0.0

    def seen(self, ahead: Pair, at: Pair) -> Pair:  # noqa: ARG002
        """Return ``k*i*conj(t)``, as ``U = k`` everywhere (see `Carrier.seen`)."""
        return self.scale * ahead[0], self.scale * ahead[1]

    def under(self, x: Array, z: Plane) -> Plane:
        """Return the points moved on (see `Carrier.under`)."""
        return z + self.scale * x
