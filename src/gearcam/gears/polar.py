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

_OFF = 0.25
"""Part of a curve's least radius that ways measured by polar angles keep off the shaft."""


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
        self._closed = toothing.closed

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

    def clear(self, points: Plane, beyond: Array) -> Array:
        """Return how far points have to go at least until what is beyond the curve changes.

        On a way that keeps off the shaft it changes by the length and by the radius that is turned
        past; any other way leads through the space within the least radius.

        Parameters
        ----------
        points : (n,) complex array, mm
            In the frame of its wheel or ring.
        beyond : (n,) array, mm
            What `PolarCurve.beyond` tells of them.

        Returns
        -------
        (n,) array, mm
        """
        least = float(self._radii.min())
        steep = float(np.abs(np.diff(self._radii) / np.diff(self._polar)).max())
        clear = np.minimum(np.abs(beyond) / (1.0 + steep / (_OFF * least)), (1.0 - _OFF) * least)
        if self._closed:
            return clear
        for end in self._polar[[0, -1]]:
            aside = np.abs(np.angle(points * np.exp(-1j * end)))
            clear = np.minimum(clear, np.abs(points) * np.sin(np.minimum(aside, 0.5 * math.pi)))
        return clear
