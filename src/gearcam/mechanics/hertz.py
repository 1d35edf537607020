"""Pressure of a line contact, by Hertz, and that at which it yields."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gearcam.base.errors import InfeasibleError
from gearcam.base.quantities import MPA, Param
from gearcam.mechanics.material import MaterialSpec
from gearcam.numeric.arrays import Array

_DEPTHS: Final = np.linspace(0.0, 2.0, 4001)
"""Depths below a contact, in half-widths: beyond, the stress only falls."""

_WIDEST: Final = 0.5
"""Largest half width of a contact over the smaller radius: beyond, its stiffness means nothing."""

CONTACT_PRESSURE: Final = (
    "contact_pressure",
    Param(MPA, ge=0, le=1e5, doc="largest contact pressure; 0: that at which the contact yields"),
    0.0,
)
"""The limit of a study of forces; without it see `yield_pressure`."""


def first_yield(poisson: float) -> float:
    """Return the pressure at which a line contact first yields, over the yield stress.

    The largest von Mises stress is in the middle of the contact: below the surface, or on it if
    Poisson's ratio is below 0.19. For a ratio of 0.3 it is 0.5575 times the pressure.

    Parameters
    ----------
    poisson : float
        Poisson's ratio.

    Returns
    -------
    float

    Notes
    -----
    Johnson, Contact Mechanics, 1985, eq. (4.46), in plane strain.
    """
    z, root = _DEPTHS, np.sqrt(1.0 + _DEPTHS**2)
    along, down = 2.0 * z - (1.0 + 2.0 * z * z) / root, -1.0 / root
    across = poisson * (along + down)
    squares = (along - down) ** 2 + (down - across) ** 2 + (across - along) ** 2
    return 1.0 / math.sqrt(0.5 * float(squares.max()))


def yield_pressure(material: MaterialSpec) -> float:
    """Return the pressure at which either part first yields, MPa; infinite if none is given."""
    if material.yield_strength is None:
        return math.inf
    ratios = [first_yield(poisson) for _, poisson in material.elasticity]
    return min(k * own for k, own in zip(ratios, material.yield_strength, strict=True))


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


def line_stiffness(
    force: float, curvature: float, radii: tuple[float, float], width: float, material: MaterialSpec
) -> float:
    """Return the stiffness of a line contact of two solid cylinders about a force, N/mm.

    The axes approach by ``sum w/(pi*E_i)*(2*ln(4*R_i/a) - 1)`` with ``E_i = E/(1 - nu^2)``, w the
    force per width and ``a^2 = 4*w/(pi*k*E)`` the square of the half width; its derivative by w is
    ``sum 2/(pi*E_i)*(ln(4*R_i/a) - 1)``, for one material ``(ln(16*R1*R2/a^2) - 2)/(pi*E)``. It
    holds where a is small beside the radii, and falls slowly with them, so that it may be used
    for a cam of about that radius.

    Parameters
    ----------
    force : float, N
        Above 0.
    curvature : float, 1/mm
        Sum of both curvatures at the contact.
    radii : (float, float), mm
        Of both bodies: how deep they are behind the contact.
    width : float, mm
        Length of the line of contact.
    material : MaterialSpec
        Of both.

    Returns
    -------
    float, N/mm

    Raises
    ------
    InfeasibleError
        If the contact is not small beside the bodies.

    Notes
    -----
    Johnson, Contact Mechanics, 1985, section 5.6.
    """
    square = 4.0 * force / width / (np.pi * curvature * material.contact_modulus)
    half, most = math.sqrt(square), _WIDEST * min(radii)
    if half > most:
        what = "the contact is too wide beside the bodies for Hertz: half its width"
        where, near = "dynamics.contact_stiffness_n_mm", "a number, or a stiffer material"
        raise InfeasibleError(what, where=where, value=half, limit=most, unit="mm", nearest=near)
    soft = (
        2.0 * (1.0 - poisson**2) / (np.pi * young) * (math.log(4.0 * radius / half) - 1.0)
        for radius, (young, poisson) in zip(radii, material.elasticity, strict=True)
    )
    return width / sum(soft)
