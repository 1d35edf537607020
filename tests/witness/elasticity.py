"""Plane elasticity in closed form: holes in plates, a cantilever, rollers; and the ISO tooth root.

Stresses are those of plane strain and plane stress alike. Points are complex.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np


def hole_in_plate(z: Any, a: float, b: float) -> Any:
    """Stress xx, yy, xy of a plate with an elliptic hole under a unit tension along y, far away.

    The hole has the semi-axes a along x and b along y. Kolosov's potentials on the plane outside
    the unit circle, z = r*(w + m/w) (Inglis 1913, Muskhelishvili 1953): for a = b that is Kirsch.
    """
    r, m, e = 0.5 * (a + b), (a - b) / (a + b), -1.0  # e = exp(2i*angle of the tension)
    root = np.sqrt((z / r) ** 2 - 4.0 * m + 0j)
    w = 0.5 * (z / r + root)
    w = np.where(np.abs(w) < 1.0 - 1e-12, 0.5 * (z / r - root), w)
    by, by_by = r * (1.0 - m / w**2), 2.0 * r * m / w**3
    p1, p2 = 0.25 * r * (1.0 - (2.0 * e - m) / w**2), 0.5 * r * (2.0 * e - m) / w**3
    c = 1.0 + m * m - m * e
    top, low = c * w**2 - e, w**3 - m * w
    q1 = -0.5 * r * (e + (2.0 * c * w * low - top * (3.0 * w**2 - m)) / low**2)
    first, second = p1 / by, (p2 * by - p1 * by_by) / by**3
    total, split = 4.0 * first.real, 2.0 * (np.conj(z) * second + q1 / by)
    return np.array([0.5 * (total - split.real), 0.5 * (total + split.real), 0.5 * split.imag])


def cantilever(z: Any, half: float, young: float, poisson: float) -> Any:
    """Stress, and displacement, of a cantilever under a unit force along -y at its end x = 0.

    Of height 2*half, in plane stress (Timoshenko and Goodier, Theory of Elasticity, section 21);
    the displacement up to a motion as a whole.
    """
    x, y = z.real, z.imag
    inertia, shear = 2.0 * half**3 / 3.0, 0.5 * young / (1.0 + poisson)
    stress = np.array([-x * y / inertia, 0.0 * x, -(half**2 - y**2) / (2.0 * inertia)])
    ei = young * inertia
    u = -(x**2) * y / (2.0 * ei) - poisson * y**3 / (6.0 * ei) + y**3 / (6.0 * inertia * shear)
    u = u - half**2 / (2.0 * inertia * shear) * y
    v = poisson * x * y**2 / (2.0 * ei) + x**3 / (6.0 * ei)
    return stress, u + 1j * v


def disc_approach(a: float, poisson: float) -> float:
    """Approach of a roller's middle to a load of half-width a, in radii, times E over the force.

    Johnson, Contact Mechanics (1985), eq. 5.57.
    """
    return (1.0 - poisson**2) / math.pi * (2.0 * math.log(4.0 / a) - 1.0)


def tooth_form(
    teeth: int, tip_radius: float, contact_radius: float, dedendum: float = 1.25
) -> tuple[float, float]:
    """Form factor YF and stress correction YS of ISO 6336-3, method B, of a spur wheel.

    The force is at a radius; lengths in modules; pressure angle 20 deg. From memory of the standard
    and held against printed values of it: no more than a band.
    """
    alpha = math.radians(20.0)

    def inv(angle: float) -> float:
        return math.tan(angle) - angle

    e = (
        math.pi / 4.0
        - dedendum * math.tan(alpha)
        - (1.0 - math.sin(alpha)) * tip_radius / math.cos(alpha)
    )
    g = tip_radius - dedendum
    h = 2.0 / teeth * (math.pi / 2.0 - e) - math.pi / 3.0
    theta = math.pi / 6.0
    for _ in range(100):
        theta = 2.0 * g / teeth * math.tan(theta) - h
    chord = teeth * math.sin(math.pi / 3.0 - theta)
    chord += math.sqrt(3.0) * (g / math.cos(theta) - tip_radius)
    radius = tip_radius + 2.0 * g**2 / (math.cos(theta) * (teeth * math.cos(theta) ** 2 - 2.0 * g))
    diameter = 2.0 * contact_radius
    at = math.acos(teeth * math.cos(alpha) / diameter)
    gamma = math.pi / (2.0 * teeth) + inv(alpha) - inv(at)
    angle = at - gamma
    arm = (math.cos(gamma) - math.sin(gamma) * math.tan(angle)) * diameter
    arm -= teeth * math.cos(math.pi / 3.0 - theta) + g / math.cos(theta) - tip_radius
    arm *= 0.5
    form = 6.0 * arm * math.cos(angle) / (chord**2 * math.cos(alpha))
    slim, notch = chord / arm, chord / (2.0 * radius)
    return form, (1.2 + 0.13 * slim) * notch ** (1.0 / (1.21 + 2.3 / slim))
