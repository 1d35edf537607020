"""Residual vibrations of motion laws against closed forms, reference values and an integration."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from gearcam.base.tolerances import Tolerances
from gearcam.dynamics.follower import ElasticFollower
from gearcam.dynamics.follower_motion import settle
from gearcam.dynamics.residual import residual
from gearcam.laws.motion import MOTION_LAWS

RATIOS = (0.5, 2 / 3, 0.75, 1.0, 1.5, 2.0, 2.5, 3.7, 5.25)

TABLE = {
    "harmonic": (
        0.7853981634, 0.6428571429, 0.5656854249, 0.3333333333, 0.0, 0.0666666667, 0.0,
        0.0109335054, 0.0064723733,
    ),
    "cycloidal": (
        0.8488263632, 0.7442940088, 0.6859552885, 0.5, 0.1697652726, 0.0, 0.0242521818,
        0.0054845933, 0.0016140124,
    ),
    "modified-sine": (
        0.8213025069, 0.6995231801, 0.6323034333, 0.4224532369, 0.0777735552, 0.0549876058,
        0.0291474407, 0.0067393332, 0.0047300139,
    ),
    "3-4-5": (
        0.8353955140, 0.7224230359, 0.6597266632, 0.4619692015, 0.1239756277, 0.0288730751,
        0.0294556876, 0.0061062880, 0.0027679287,
    ),
    "constant-acceleration": (
        0.8105694691, 0.6839179896, 0.6149905055, 0.4052847346, 0.0900632743, 0.0, 0.0324227788,
        0.0061016926, 0.0125508266,
    ),
}  # fmt: skip
"""Amplitude over height, at these ratios: computed apart from the project."""


def modified_sine(tau: float) -> float:
    q, p1 = 2.0 * math.pi * tau, 4.0 * math.pi
    p2, peak = p1 / 3.0, 4.0 * math.pi**2 / (math.pi + 4.0)
    first = (q * math.cos(0.375 * q) - p1 * math.sin(0.5 * q)) / (q * q - p1 * p1)
    return 2.0 * peak / q * abs(first - q * math.cos(0.375 * q) / (q * q - p2 * p2))


def three_four_five(tau: float) -> float:
    q = 2.0 * math.pi * tau
    s, c = math.sin(0.5 * q), math.cos(0.5 * q)
    return 120.0 * abs(12.0 * s - 6.0 * q * c - q * q * s) / q**5


FORMS: dict[str, Callable[[float], float]] = {
    "harmonic": lambda t: abs(math.cos(math.pi * t) / (1.0 - 4.0 * t * t)),
    "cycloidal": lambda t: abs(math.sin(math.pi * t) / (math.pi * t * (1.0 - t * t))),
    "constant-acceleration": lambda t: 4.0 * math.sin(0.5 * math.pi * t) ** 2 / (math.pi * t) ** 2,
    "modified-sine": modified_sine,
    "3-4-5": three_four_five,
    "constant-velocity": lambda t: abs(math.sin(math.pi * t) / (math.pi * t)),
}


def rise(law: str):
    return MOTION_LAWS[law].example.build(Tolerances()).function


@pytest.mark.parametrize("law", TABLE)
def test_the_reference_values(law: str) -> None:
    assert residual(rise(law), RATIOS) == pytest.approx(TABLE[law], abs=6e-11)


@pytest.mark.parametrize("law", FORMS)
def test_closed_forms(law: str) -> None:
    ratios = np.array([0.31, 0.77, 1.23, 2.9, 7.3, 31.7])
    assert residual(rise(law), ratios) == pytest.approx(list(map(FORMS[law], ratios)), abs=1e-12)


def test_where_closed_forms_have_no_value() -> None:
    limits = {("harmonic", 0.5): math.pi / 4.0, ("cycloidal", 1.0): 0.5, ("harmonic", 0.0): 1.0}
    limits["modified-sine", 2.0] = math.pi / (8.0 * (math.pi + 4.0))
    for (law, ratio), value in limits.items():
        assert residual(rise(law), [ratio])[0] == pytest.approx(value, abs=1e-13)


@pytest.mark.parametrize("law", ["4-5-6-7", "modified-trapezoid", "constant-acceleration"])
def test_an_integration_swings_as_far(law: str) -> None:
    """A mass on a spring, from rest, lifted in a second and at rest for ten periods."""
    function, ratio, mass = rise(law), 1.37, 2.0
    omega = 2.0 * math.pi * ratio

    def lift(x, order):
        inside = np.minimum(x, 1.0)
        found = function.derivatives(inside, max(order, 2))
        return [found[0], *(np.where(x < 1.0, one, 0.0) for one in found[1 : order + 1])]

    follower = ElasticFollower(
        masses=(mass,), stiffness=(mass * omega**2,), damping=(0.0,), speed=1.0, lift=lift,
        loads=lambda x: np.zeros((1, x.size)), held=True,
        knots=np.append(function.knots, 1.0 + 10.0 / ratio),
    )  # fmt: skip
    turn = settle(follower, np.zeros(2), turns=1, method="dop853", tolerance=1e-12)
    r, rate = turn.states([1.0 + 1e-13])[0][:2, 0]
    swing = math.hypot(r, rate / omega)
    assert swing == pytest.approx(residual(function, [ratio])[0], abs=1e-10)
