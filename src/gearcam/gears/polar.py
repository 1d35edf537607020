"""Centrodes and their parallels in polar coordinates, approximate: to sort points of ring pairs."""

from __future__ import annotations

import math

import numpy as np

from gearcam.gears.flank import Toothing
from gearcam.numeric.arrays import Array, Plane

_PLACES = 8
"""Points per pitch; between them a curve is taken as straight."""

_FEET = 2.0
"""Pitches to either side of a first guess by polar angle within which a foot lies."""

_OFF = 0.25
"""Share of a curve's least radius by which paths measured by polar angle stay off the shaft."""


class PolarCurve:
    """A parallel of a centrode in polar coordinates; its angle rises with the driver angle.

    Parameters
    ----------
    toothing : Toothing
        A driver or a ring.
    height : float, mm
        Its distance from the centrode, towards the tips.
    """

    def __init__(self, toothing: Toothing, height: float) -> None:
        more = 0 if toothing.closed else 1  # pitches added at each end for the outer half teeth
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
        """Return bounds and guesses of the feet of points near it, driver angles, rad."""
        places = self._places(points)
        low, high, guess = (np.interp(places, self._polar, phi) for phi in self._phi)
        return low, high, guess

    def beyond(self, points: Plane) -> Array:
        """Return radii of points less those of the curve, mm; -inf beyond the last angle."""
        return np.abs(points) - np.interp(
            self._places(points), self._polar, self._radii, right=math.inf
        )

    def clear(self, points: Plane, beyond: Array) -> Array:
        """Return lower bounds of the distance from points to the curve, mm.

        Along a path off the shaft `beyond` changes by at most the length, plus the change of radius
        over the angle passed; any other path leads through the circle of the least radius.

        Parameters
        ----------
        points : (n,) complex array, mm
            In the frame of its wheel or ring.
        beyond : (n,) array, mm
            `PolarCurve.beyond` of them.

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
