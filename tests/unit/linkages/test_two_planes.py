"""Rotors in two planes: a value known beforehand, and what the weights must do."""

from __future__ import annotations

import numpy as np
import pytest

from gearcam.linkages.balance import two_planes
from helpers_linkages import agree

MASSES = np.array([0.20, 0.35, 0.15])
PLACES = np.array([30 + 10j, -20 + 25j, 5 - 40j])
ALONG = np.array([40.0, 110.0, 180.0])


def carried(planes: tuple[float, float]) -> tuple[complex, ...]:
    each = MASSES * PLACES
    return two_planes(complex(each.sum()), complex((each * ALONG).sum()), planes)


def test_the_value_of_three_masses() -> None:
    first, second = carried((20.0, 220.0))
    agree(np.array([first.real, first.imag]), np.array([1.7, 5.4125]))
    agree(np.array([second.real, second.imag]), np.array([-1.95, -0.6625]))
    assert carried((220.0, 20.0)) == pytest.approx((second, first), rel=1e-13)


@pytest.mark.parametrize("planes", [(20.0, 220.0), (220.0, -5.0), (60.0, 61.0)])
@pytest.mark.parametrize("about", [0.0, 77.0])
def test_both_planes_have_the_sum_and_the_moment_of_the_masses(
    planes: tuple[float, float], about: float
) -> None:
    own = np.array(carried(planes))
    each = MASSES * PLACES
    assert complex(own.sum()) == pytest.approx(complex(each.sum()), rel=1e-12)
    wanted = complex((each * (ALONG - about)).sum())
    assert complex((own * (np.array(planes) - about)).sum()) == pytest.approx(wanted, rel=1e-12)


def test_a_mass_in_a_plane_is_carried_by_it_alone() -> None:
    assert two_planes(3 + 4j, 20.0 * (3 + 4j), (20.0, 220.0)) == pytest.approx((3 + 4j, 0j))
