"""How exact the curvatures of centrodes are: of what they are made, and what each part is off by.

With ``m = 1/(i*(1 + w*i))`` and ``p = m*i' = r1'/r1`` the centrodes turn against the radius by
``b = (m*i'' - (1 + 2*w*i)*p^2)/(1 + p^2)``, and bend by ``(1 - b)/v`` and ``(w*i + b)/v``.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from gearcam.gears.rolling import Centrode
from gearcam.laws.ratio.base import RatioLaw
from gearcam.numeric.arrays import Array

EPS: Final = float(np.finfo(float).eps)

FEW: Final = 8.0
"""Roundings, in units of the last place, that a number of a few operations has at most."""


class Bends(NamedTuple):
    """How a centrode bends.

    Parameters
    ----------
    radius, radius_error : float, mm
        Least convex radius; infinite where nothing is known to be convex.
    concave, concave_error : float, 1/mm
        Largest concave curvature; 0 where all is convex.
    """

    radius: float
    radius_error: float
    concave: float
    concave_error: float


def systematic_errors(law: RatioLaw, phi: Array) -> Array:
    """Return what the ratio and its first two derivatives are off by all along a piece.

    Parameters
    ----------
    law : RatioLaw
        The ratio.
    phi : (n,) array, rad
        Driver angles in the first lobe, or in an open pair's travel.

    Returns
    -------
    (3, n) array
        A Python function's own, the rounding of knots and of the ratios about them, which counts
        the more the nearer they are, and the miss of a law that was solved. What scatters from
        place to place is not in it.
    """
    knots, order = law.knots, np.arange(3)[:, None]
    piece = np.clip(np.searchsorted(knots, phi), 1, len(knots) - 1) - 1
    width, rise = np.diff(knots)[piece], np.abs(np.diff(law.ratio(knots)))[piece]
    found = np.abs(law.ratio.derivatives(phi, 2))
    own = np.array(law.function_errors[1:])[:, None] + EPS * (found[0] + rise) / width**order
    return own + (EPS * (FEW + order * law.period / width) + law.solved_error) * found


def curvature_errors(track: Centrode) -> Array:
    """Return errors of a centrode's extremes of curvature, 1/mm.

    An extreme of a smooth stretch is flat: the place at which it was found counts by its square,
    which is less than rounding. One at a knot is off as the knot is, by the slope there.
    """
    rolling, second = track.rolling, track.wheel == 2
    law, w = rolling.law, abs(rolling.mate)
    phi, kappa = track.curvature_extremes
    i, di, ddi = np.abs(law.ratio.derivatives(phi, 2))
    of_i, of_di, of_ddi = systematic_errors(law, phi)
    m = 1.0 / (i * (1.0 + rolling.mate * i))
    p, twice = m * di, np.abs(1.0 + 2.0 * rolling.mate * i)
    square = 1.0 + p * p
    speed = m * i * i * np.sqrt(square)
    terms = (m * ddi + twice * p * p) / square
    of_p = m * (of_di + twice * p * of_i)
    of_b = m * (of_ddi + (twice * m * ddi) * of_i) + 2.0 * p * (w * p * of_i)
    of_b = (of_b + 2.0 * p * (twice + terms) * of_p) / square
    of_speed = m * of_i + p * of_p / square
    top = of_b + EPS * FEW * ((w * i if second else 1.0) + terms) + (w * of_i if second else 0.0)

    def bends(x: Array) -> Array:
        return rolling.curvatures(x)[:, track.wheel - 1]

    found = law.scatter(phi, lambda x: bends(x)[0]) + EPS * law.period * np.abs(bends(phi)[1])
    found += top / (speed * rolling.center_distance)
    return found + (of_speed + rolling.size_error) * np.abs(kappa)


def bends_of(track: Centrode) -> Bends:
    """Return how a centrode bends most to both sides, as far as it is known."""
    _, kappa = track.curvature_extremes
    errors = curvature_errors(track)
    low, high = most_of(kappa, errors)
    radius = 1.0 / float(kappa.max()) if low > 0.0 else math.inf
    missed = max(radius - 1.0 / high, 1.0 / low - radius) if low > 0.0 else 0.0
    low, high = (max(most, 0.0) for most in most_of(-kappa, errors))
    concave = max(-float(kappa.min()), 0.0)
    return Bends(radius, missed, concave, max(high - concave, concave - low))


def most_of(values: Array, errors: Array) -> tuple[float, float]:
    """Return what the largest of values is at least and at most: others may come up to it."""
    return float((values - errors).max()), float((values + errors).max())
