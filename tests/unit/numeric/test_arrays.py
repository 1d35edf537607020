"""Values with even steps between them, against those of each gap."""

from __future__ import annotations

from typing import Any

import numpy as np

from gearcam.numeric.arrays import divided


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
