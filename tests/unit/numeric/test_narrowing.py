"""Brackets are narrowed to a change, or to a largest value, of functions that may jump."""

from __future__ import annotations

import numpy as np
import pytest

from gearcam.numeric.narrowing import changes, peaks

PLACES = np.array([0.3, 1.0 / 7.0, np.pi / 4.0])


def test_both_sides_of_a_change() -> None:
    for low, high in ((np.zeros(3), np.ones(3)), (np.ones(3), np.zeros(3))):
        before, after = changes(
            lambda x, rows: np.where(x < PLACES[rows, None], 1.0, 3.0), low, high, 1e-12
        )
        assert (np.minimum(before, after) < PLACES).all()
        assert (np.maximum(before, after) >= PLACES).all()
        assert np.abs(after - before).max() <= 1e-12


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_a_peak_is_found_where_one_side_is_unknown(power: float) -> None:
    def function(x: np.ndarray, rows: np.ndarray) -> np.ndarray:
        values = 2.0 - np.abs(x - PLACES[rows, None]) ** power
        return np.where(x > PLACES[rows, None], -np.inf, values)

    found, values = peaks(function, np.zeros(3), np.ones(3), 1e-12)
    assert found == pytest.approx(PLACES, abs=1e-7)
    assert values == pytest.approx(2.0, abs=1e-12)


def test_no_brackets() -> None:
    nothing = np.zeros(0)
    assert all(one.size == 0 for one in changes(lambda x, _: x, nothing, nothing, 1e-12))
    assert all(one.size == 0 for one in peaks(lambda x, _: x, nothing, nothing, 1e-12))
