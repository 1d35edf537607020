"""Cubics through sampled curves: what lies between dense points with exact tangents.

Points and tangents are complex numbers inside this room.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gearcam.numeric.bulges import Complex

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


def hermite_arms(points: Complex, tangents: Complex) -> Array:
    """Return the length of the end derivatives of the cubics through a curve's points.

    Parameters
    ----------
    points, tangents : (n,) complex arrays, mm and 1
        Points, and unit tangents there.

    Returns
    -------
    (n - 1,) array, mm
        The lengths of arcs that turn as the tangents do: the cubics' error then falls with the
        fourth power of the step.
    """
    turn = np.angle(tangents[1:] * np.conj(tangents[:-1]))
    return np.abs(np.diff(points)) / np.sinc(0.5 * turn / np.pi)


def on_cubics(p: Complex, t: Complex, step: Ints, share: Array) -> tuple[Complex, Complex]:
    """Return places on the cubics between a curve's points.

    Parameters
    ----------
    p, t : (n,) complex arrays, mm and 1
        Points, and unit tangents there.
    step : (k,) int array
        Number of the point before each place.
    share : (k,) array
        Share of the way to the next point.

    Returns
    -------
    points, tangents : (k,) complex arrays, mm and 1
    """
    chord, arms = np.diff(p)[step], hermite_arms(p, t)[step]
    first, second = t[step] * arms - chord, t[step + 1] * arms - chord
    back = 1.0 - share
    points = p[step] + share * chord + share * back * (first * back - second * share)
    slope = chord + first * back * (1.0 - 3.0 * share) - second * share * (2.0 - 3.0 * share)
    return points, slope / np.abs(slope)
