"""Pressure of a line contact, by Hertz."""

from __future__ import annotations

import numpy as np

from gearcam.mechanics.material import MaterialSpec
from gearcam.numeric.arrays import Array

FIRST_YIELD = 1.79
"""Pressure over the yield stress at which a line contact first yields, below its surface: the
largest equivalent stress is 0.5575 times the pressure (Poisson's ratio 0.3)."""


def line_pressure(force: Array, curvature: Array, material: MaterialSpec) -> Array:
    """Return the largest pressure between two cylinders, MPa.

    ``p = sqrt(w*E*k/pi)``, for a force w per length, the relative curvature k and
    ``1/E = (1 - nu1^2)/E1 + (1 - nu2^2)/E2``.

    Parameters
    ----------
    force : (n,) array, N/mm
        Force per length, not negative.
    curvature : (n,) array, 1/mm
        Sum of both curvatures, infinite of an edge; where it is not positive there is no line
        contact.
    material : MaterialSpec
        Of both.

    Returns
    -------
    (n,) array, MPa
        nan where there is no line contact; infinite on an edge under load.
    """
    with np.errstate(invalid="ignore"):  # an edge without load
        product = force * np.where(curvature > 0.0, curvature, np.nan) * material.contact_modulus
    return np.sqrt(product / np.pi)


def half_width(force: Array, curvature: Array, material: MaterialSpec) -> Array:
    """Return half the width of the contact, mm (see `line_pressure`)."""
    curvature = np.where(curvature > 0.0, curvature, np.nan)
    return np.sqrt(4.0 * force / (np.pi * curvature * material.contact_modulus))
