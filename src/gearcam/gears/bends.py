"""Error bounds of centrode curvatures, from the errors of the ratio and its derivatives.

Depends on rolling.
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
"""Largest rounding error of a number after a few operations, in units of the last place."""

_STEP: Final = 1e-100
"""Complex step by which a curvature is differentiated: it has no cancellation."""


class Bends(NamedTuple):
    """Least convex radius and largest concave curvature of a centrode.

    Parameters
    ----------
    radius, radius_error : float, mm
        Least convex radius; infinite where no part is known to be convex.
    concave, concave_error : float, 1/mm
        Largest concave curvature; 0 for a convex centrode.
    """

    radius: float
    radius_error: float
    concave: float
    concave_error: float


def systematic_errors(law: RatioLaw, phi: Array) -> Array:
    """Return systematic errors of the ratio and its first two derivatives.

    Parameters
    ----------
    law : RatioLaw
        The ratio.
    phi : (n,) array, rad
        Driver angles in the first lobe, or in an open pair's travel.

    Returns
    -------
    (3, n) array
        Sum of the expansion error of a Python function, the rounding of knots and of the ratios
        around them (larger the closer the knots are), and the residual of a solved law. Random
        scatter is not included.
    """
    knots, order = law.knots, np.arange(3)[:, None]
    piece = np.clip(np.searchsorted(knots, phi), 1, len(knots) - 1) - 1
    width, rise = np.diff(knots)[piece], np.abs(np.diff(law.ratio(knots)))[piece]
    found = np.abs(law.ratio.derivatives(phi, 2))
    own = np.array(law.function_errors[1:])[:, None] + EPS * (found[0] + rise) / width**order
    return own + (EPS * (FEW + order * law.period / width) + law.solved_error) * found


def curvature_errors(track: Centrode) -> Array:
    """Return errors of a centrode's extremes of curvature, 1/mm.

    Scatter near them, plus the systematic error of the ratio. An extreme of a smooth stretch is
    flat: the error of its place enters squared and is below rounding. An extreme at a knot is
    evaluated at the knot itself.
    """
    rolling, number = track.rolling, track.wheel - 1
    law, (phi, kappa) = rolling.law, track.curvature_extremes

    def curvature(x: Array) -> Array:
        return rolling.curvatures_of(law.ratio.derivatives(x, 2))[number]

    found = law.scatter(phi, curvature) + rolling.size_error * np.abs(kappa)
    for order, error in enumerate(systematic_errors(law, phi)):
        ratios = [values.astype(complex) for values in law.ratio.derivatives(phi, 2)]
        ratios[order] += _STEP * 1j
        found += np.abs(rolling.curvatures_of(ratios)[number].imag) / _STEP * error
    return found


def bends_of(track: Centrode) -> Bends:
    """Return the extreme curvatures of a centrode, with their errors."""
    _, kappa = track.curvature_extremes
    errors = curvature_errors(track)
    low, high = _most_of(kappa, errors)
    radius = 1.0 / float(kappa.max()) if low > 0.0 else math.inf
    missed = max(radius - 1.0 / high, 1.0 / low - radius) if low > 0.0 else 0.0
    low, high = (max(most, 0.0) for most in _most_of(-kappa, errors))
    concave = max(-float(kappa.min()), 0.0)
    return Bends(radius, missed, concave, max(high - concave, concave - low))


def _most_of(values: Array, errors: Array) -> tuple[float, float]:
    """Return lower and upper bounds of the largest of `values`, given their `errors`."""
    return float((values - errors).max()), float((values + errors).max())
