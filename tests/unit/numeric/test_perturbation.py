"""Errors by perturbation, where the largest change is known in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from gearcam.numeric.arrays import Array
from gearcam.numeric.perturbation import Perturb, largest_changes, perturbed_sizes

PLACES = np.linspace(1.0, 2.0, 64)


def test_a_power_is_off_by_its_exponent_times_as_much() -> None:
    (change,) = largest_changes(lambda perturb: [perturb(PLACES, 1e-9 * PLACES) ** 3])
    np.testing.assert_allclose(change, 3e-9 * PLACES**3, rtol=1e-6)


def test_inputs_that_are_off_independently_add_up_somewhere() -> None:
    (change,) = largest_changes(
        lambda perturb: [perturb(PLACES, 1e-6) - perturb(np.ones(64), 3e-6)]
    )
    assert change.max() == pytest.approx(4e-6)
    assert change.min() >= 2e-6 * (1.0 - 1e-9)


def test_a_cancelling_difference_shows_what_it_lost() -> None:
    """(1 + x) - 1 of a tiny x: the rounding of 1 + x is all of it."""
    tiny, eps = np.array([1e-16]), 2.0**-52
    (change,) = largest_changes(lambda perturb: [(perturb(1.0 + tiny, eps) - 1.0) / tiny])
    assert change[0] == pytest.approx(eps / 1e-16)


def test_complex_results_and_several_at_once() -> None:
    def compute(perturb: Perturb) -> list[np.ndarray]:
        turned = np.exp(1j * perturb(PLACES, 1e-7))
        return [5.0 * turned, np.real(turned) * 0.0]

    far, nothing = largest_changes(compute)
    np.testing.assert_allclose(far, 5e-7, rtol=1e-6)
    assert not nothing.any()


def test_where_there_is_no_value_there_is_no_change() -> None:
    """At 0 only some trials have one; what is off by less than nothing has none."""
    (change,) = largest_changes(lambda perturb: [np.sqrt(perturb(np.array([0.0, 4.0]), 4e-6))])
    np.testing.assert_allclose(change, [2e-3, 1e-6], rtol=1e-5)


def test_they_are_the_same_in_every_run() -> None:
    def compute(perturb: Perturb) -> list[Array]:
        return [perturb(PLACES, 1e-3) * perturb(PLACES[::-1], 1e-3)]

    np.testing.assert_array_equal(largest_changes(compute)[0], largest_changes(compute)[0])


@dataclass(frozen=True)
class Sizes:
    radius: float
    far: float
    pivot: complex
    count: int
    flat: bool


PIVOT = 2.0 - 6.0j


def test_only_finite_numbers_of_a_dataclass_are_perturbed() -> None:
    sizes = Sizes(radius=2.0, far=float("inf"), pivot=PIVOT, count=3, flat=True)
    moved = perturbed_sizes(sizes, lambda value, off: np.asarray(value) + off, 0.5)
    assert moved == Sizes(radius=3.0, far=float("inf"), pivot=1.5 * PIVOT, count=3, flat=True)
