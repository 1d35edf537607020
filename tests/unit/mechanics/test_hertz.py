"""The pressure at which a line contact yields, against Flamant's line loads."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from gearcam.base.errors import InfeasibleError
from gearcam.mechanics.hertz import first_yield, line_stiffness, yield_pressure
from gearcam.mechanics.material import MaterialSpec


def von_mises(depth: float, poisson: float) -> float:
    """Below the middle of a semi-ellipse of pressure, which is summed as line loads."""

    def summed(power: int) -> float:
        kernel = lambda s: np.sqrt(1.0 - s * s) * s**power / (s * s + depth * depth) ** 2  # noqa: E731
        return quad(kernel, -1.0, 1.0, points=[0.0], epsabs=1e-11)[0]

    along, down = -2.0 / np.pi * np.array([depth * summed(2), depth**3 * summed(0)])
    across = poisson * (along + down)
    apart = np.array([along - down, down - across, across - along])
    return float(np.sqrt(0.5 * (apart**2).sum()))


@pytest.mark.parametrize("poisson", [0.25, 0.3, 0.37, 0.49])
def test_it_yields_below_the_surface(poisson: float) -> None:
    found: Any = minimize_scalar(
        lambda depth: -von_mises(depth, poisson), bounds=(0.3, 1.2), method="bounded"
    )
    assert first_yield(poisson) == pytest.approx(-1.0 / found.fun, rel=1e-5)


def test_it_yields_on_the_surface_if_the_ratio_is_small() -> None:
    """There the stress is the pressure in the plane, and 2*nu times it across."""
    for poisson in (0.0, 0.1, 0.19):
        assert first_yield(poisson) == pytest.approx(1.0 / (1.0 - 2.0 * poisson), rel=1e-12)


def test_the_weaker_of_both_parts_yields_first() -> None:
    soft = MaterialSpec(name=("steel", "pom"), yield_strength=(400.0, 65.0))
    assert yield_pressure(soft) == pytest.approx(65.0 * first_yield(0.37))
    assert yield_pressure(MaterialSpec()) == np.inf


def test_the_stiffness_is_the_slope_of_the_approach() -> None:
    """Of unlike materials by differences, of one in the closed form of the field."""
    radii, width, curvature = (30.0, 8.0), 12.0, 1.0 / 30.0 + 1.0 / 8.0
    material = MaterialSpec(name=("cast-iron", "steel"))

    def approach(force: float) -> float:
        load = force / width
        half = np.sqrt(4.0 * load / (np.pi * curvature * material.contact_modulus))
        return sum(
            load * (1.0 - nu**2) / (np.pi * young) * (2.0 * np.log(4.0 * radius / half) - 1.0)
            for radius, (young, nu) in zip(radii, material.elasticity, strict=True)
        )

    slope = (approach(501.0) - approach(499.0)) / 2.0
    found = line_stiffness(500.0, curvature, radii, width, material)
    assert found == pytest.approx(1.0 / slope, rel=1e-6)

    steel = MaterialSpec()
    modulus = steel.contact_modulus
    square = 4.0 * 500.0 / width / (np.pi * curvature * modulus)
    soft = (np.log(16.0 * 30.0 * 8.0 / square) - 2.0) / (np.pi * width * modulus)
    found = line_stiffness(500.0, curvature, radii, width, steel)
    assert found == pytest.approx(1.0 / soft, rel=1e-12)


def test_a_contact_as_wide_as_its_bodies_is_refused() -> None:
    soft = MaterialSpec(young_modulus=(0.04, 0.04), poisson=(0.3, 0.3))
    with pytest.raises(InfeasibleError, match="too wide"):
        line_stiffness(500.0, 0.2, (10.0, 10.0), 10.0, soft)
