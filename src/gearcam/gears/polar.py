"""Centrodes and their parallels by polar angles, roughly: to sort points of an internal pair."""

from __future__ import annotations

import math

import numpy as np

from gearcam.gears.flank import Toothing
from gearcam.numeric.arrays import Array, Plane

_PLACES = 8
"""Places in a pitch between which a curve is taken as straight."""

_FEET = 2.0
"""Pitches to either side within which feet lie, where polar angles have told them roughly."""


class PolarCurve:
    """A parallel of a centrode whose polar angle rises with the driver angle, in polar coordinates.

    Parameters
    ----------
    toothing : Toothing
        A driver or a ring.
    height : float, mm
        Its distance from the centrode, towards the tips.
    """

    def __init__(self, toothing: Toothing, height: float) -> None:
        more = 0 if toothing.closed else 1  # pitches at each end, for the outer half teeth
        count = _PLACES * (toothing.teeth + 2 * more)
        s = toothing.pitch * (np.arange(count + 1) / _PLACES - more)
        reach = _FEET * toothing.pitch
        self._phi = toothing.track.angle(np.stack([s - reach, s + reach, s]))
        base = toothing.frames(self._phi[2], curved=False)
        points = base.p + height * toothing.turn * base.t
        self._polar, self._radii = np.unwrap(np.angle(points)), np.abs(points)

    def _places(self, points: Plane) -> Array:
        first = self._polar[0]
        return first + (np.angle(points) - first) % (2.0 * math.pi)

    def feet(self, points: Plane) -> tuple[Array, Array, Array]:
        """Return between which driver angles feet of points near it lie, and guesses, rad."""
        places = self._places(points)
        low, high, guess = (np.interp(places, self._polar, phi) for phi in self._phi)
        return low, high, guess

    def beyond(self, points: Plane) -> Array:
        """Return how much farther from the shaft points are than it, mm; what is open ends."""
        return np.abs(points) - np.interp(
            self._places(points), self._polar, self._radii, right=math.inf
        )
