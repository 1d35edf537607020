"""Cubic B-splines through points in order, and surfaces through grids of them.

The knots are the places of the points but for the second and the last but one (*not-a-knot*), so
that a cubic is met exactly and the error falls with the fourth power of the step. A surface is
interpolated one way after the other: its edges are the B-splines through the edges of the grid.

Source: de Boor, A Practical Guide to Splines, chapters IV and XIII. Depends on numpy only.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array
from gearcam.numeric.splines import DEGREE

LEAST = DEGREE + 1
"""Least number of points in a row."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SplineNet(ShortRepr):
    """A surface of cubic B-splines in both directions, through a grid of points.

    Parameters
    ----------
    points : (n, m, 3) array, mm
        The grid.
    along : (n,) array
        Parameters of its rows, rising.
    across : (m,) array
        Parameters of its columns, rising.
    """

    points: Array
    along: Array
    across: Array

    @cached_property
    def poles(self) -> Array:
        """Control points, (n, m, 3), mm."""
        rows = spline_poles(self.along, self.points)
        return spline_poles(self.across, rows.swapaxes(0, 1)).swapaxes(0, 1)

    def at(self, along: Array, across: Array) -> Array:
        """Return the points at all pairs of parameters.

        Parameters
        ----------
        along, across : (k,) and (l,) arrays
            Parameters.

        Returns
        -------
        (k, l, 3) array, mm
        """
        first, second = basis(self.along, along), basis(self.across, across)
        return np.einsum("ki,lj,ijc->klc", first, second, self.poles, optimize=True)


def spline_breaks(places: Array) -> Array:
    """Return the distinct knots of the cubic through points at `places`, (n,): n - 2 of them."""
    return np.concatenate([places[:1], places[2:-2], places[-1:]])


def spline_poles(places: Array, points: Array) -> Array:
    """Return the control points of the cubic B-spline through points.

    Parameters
    ----------
    places : (n,) array
        Parameters of the points, rising; at least four.
    points : (n, ...) array
        The points.

    Returns
    -------
    (n, ...) array

    Raises
    ------
    ValueError
        If there are fewer than four points, or places do not rise.
    """
    if len(places) < LEAST or not (np.diff(places) > 0.0).all():
        raise ValueError("a cubic needs four points or more, at rising places")
    flat = np.linalg.solve(basis(places, places), points.reshape(len(points), -1))
    poles = np.array(flat, dtype=np.float64).reshape(points.shape)
    poles[0], poles[-1] = points[0], points[-1]  # free of rounding: neighbours share them
    return poles


def basis(places: Array, at: Array) -> Array:
    """Return the values of all B-splines of the cubic through points at `places`.

    Parameters
    ----------
    places : (n,) array
        Parameters of the points.
    at : (k,) array
        Where the values are wanted, within the first and the last of them.

    Returns
    -------
    (k, n) array
    """
    ends = [places[0]] * DEGREE, [places[-1]] * DEGREE
    knots = np.concatenate([ends[0], spline_breaks(places), ends[1]])
    count = len(places)
    cell = np.clip(np.searchsorted(knots, at, side="right") - 1, DEGREE, count - 1)
    values = np.zeros((len(at), len(knots) - 1))
    values[np.arange(len(at)), cell] = 1.0
    for degree in range(1, DEGREE + 1):
        span = knots[degree:] - knots[:-degree]
        scale = np.divide(1.0, span, out=np.zeros_like(span), where=span > 0.0)
        rising = (at[:, None] - knots[: -degree - 1]) * scale[:-1]
        falling = (knots[degree + 1 :] - at[:, None]) * scale[1:]
        values = rising * values[:, :-1] + falling * values[:, 1:]
    return values
