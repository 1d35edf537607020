"""Hermite's cubics and quintics: interpolation between points with known derivatives."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcam.numeric.arrays import Array, Ints, Plane

Numbers = NDArray[Any]
"""Real or complex numbers."""


def hermite_arms(points: Plane, tangents: Plane) -> Array:
    """Return the lengths of the end derivatives of the cubics through a curve's points.

    Parameters
    ----------
    points, tangents : (n,) complex arrays, mm and 1
        Points, and unit tangents there.

    Returns
    -------
    (n - 1,) array, mm
        The lengths of arcs that turn by the angle between the tangents: the cubics' error then
        falls with the fourth power of the step.
    """
    return _arms(np.diff(points), tangents[:-1], tangents[1:])


def _arms(chord: Plane, first: Plane, second: Plane) -> Array:
    turn = np.angle(second * np.conj(first))
    return np.abs(chord) / np.sinc(0.5 * turn / np.pi)


def hermite_cubic(
    chord: Numbers, first: Numbers, second: Numbers, share: Array
) -> tuple[Numbers, Numbers]:
    """Return values and slopes of cubics.

    Parameters
    ----------
    chord : array
        Difference from the beginning to the end.
    first, second : arrays
        Derivatives by the share at both ends.
    share : array
        Parameter, from 0 to 1.

    Returns
    -------
    way, slope : arrays
        Difference from the beginning, and its derivative by the share.
    """
    back = 1.0 - share
    first, second = first - chord, second - chord
    way = share * chord + share * back * (first * back - second * share)
    slope = chord + first * back * (1.0 - 3.0 * share) - second * share * (2.0 - 3.0 * share)
    return way, slope


def on_cubics(p: Plane, t: Plane, step: Ints, share: Array) -> tuple[Plane, Plane]:
    """Return points on the cubics between a curve's points.

    Parameters
    ----------
    p, t : (n,) complex arrays, mm and 1
        Points, and unit tangents there.
    step : (k,) int array
        Index of the curve's point before each point.
    share : (k,) array
        Parameter towards the next point, from 0 to 1.

    Returns
    -------
    points, tangents : (k,) complex arrays, mm and 1
    """
    chord, ends = p[step + 1] - p[step], (t[step], t[step + 1])
    arms = _arms(chord, *ends)
    way, slope = hermite_cubic(chord, ends[0] * arms, ends[1] * arms, share)
    return p[step] + way, np.asarray(slope / np.abs(slope), dtype=np.complex128)


def hermite_quintics(x: Array, y: Array, slopes: Array, bends: Array) -> Array:
    """Return the quintics between points with known values, slopes and second derivatives.

    Parameters
    ----------
    x : (n + 1,) array
        Rising.
    y, slopes, bends : (n + 1,) arrays
        Values, slopes and second derivatives.

    Returns
    -------
    (n, 6) array
        Coefficients of the powers of ``x - x[k]`` on interval k.
    """
    h, d0, s0 = np.diff(x), slopes[:-1], bends[:-1]
    # end conditions of the difference from the left end's parabola
    miss = np.diff(y) / h - d0 - 0.5 * s0 * h
    turn, gap = slopes[1:] - d0 - s0 * h, bends[1:] - s0
    return np.stack(
        [
            y[:-1],
            d0,
            0.5 * s0,
            (10.0 * miss - 4.0 * turn + 0.5 * gap * h) / h**2,
            (-15.0 * miss + 7.0 * turn - gap * h) / h**3,
            (6.0 * miss - 3.0 * turn + 0.5 * gap * h) / h**4,
        ],
        axis=1,
    )
