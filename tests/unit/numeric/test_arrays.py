"""Values with even steps between them, against those of each gap; distinct ones against numpy's."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gearcam.numeric.arrays import distinct, divided


def test_values_divided_into_even_steps() -> None:
    points: Any = np.array([0.0, 3 + 1j, 3 + 1j, -2j])
    counts = np.array([3, 1, 4])
    gaps = [
        np.linspace(a, b, n, endpoint=False)
        for a, b, n in zip(points[:-1], points[1:], counts, strict=True)
    ]
    wanted: Any = np.append(np.concatenate(gaps), points[-1])
    np.testing.assert_allclose(divided(points, counts), wanted, atol=1e-15)
    real = divided(points.real, counts)
    np.testing.assert_allclose(real, wanted.real, atol=1e-15)
    assert real.dtype == np.float64


def test_distinct_values_are_those_of_numpy() -> None:
    random = np.random.default_rng(3)
    for count in (0, 1, 2, 50):
        one, other = random.integers(-9, 9, (2, count)) / 8.0
        np.testing.assert_array_equal(distinct(one), np.unique(one))
        np.testing.assert_array_equal(distinct(one, other), np.union1d(one, other))
        np.testing.assert_array_equal(
            distinct(one.reshape(-1, 1), [1.0], 2.0), distinct(one, [1, 2])
        )
    assert distinct(np.array([2, 1, 2])).dtype == np.int64
    assert distinct(np.array([1.0, np.nextafter(1.0, 2.0)])).size == 2


@pytest.mark.parametrize("empty", [np.empty(0), np.empty((0, 3))])
def test_of_nothing_nothing_is_distinct(empty: Any) -> None:
    assert distinct(empty, []).shape == (0,)


def test_distinct_values_leave_what_they_are_given() -> None:
    given = np.array([3.0, 1.0, 1.0])
    assert distinct(given).tolist() == [1.0, 3.0]
    assert given.tolist() == [3.0, 1.0, 1.0]
