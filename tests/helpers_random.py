"""How designs at random are drawn, the same ones in every run, and what cams are measured by."""

from __future__ import annotations

from typing import Any

import shapely
from hypothesis import HealthCheck, Phase, settings

QUICK = settings(
    derandomize=True,
    database=None,
    deadline=None,
    max_examples=20,
    phases=[Phase.generate, Phase.shrink],
    suppress_health_check=[
        HealthCheck.too_slow,
        HealthCheck.data_too_large,
        HealthCheck.filter_too_much,
    ],
)


def close(contour: Any, region: Any, chord: float) -> None:
    """Demand that a contour encloses a region within its chords, whose tolerance is in mm."""
    off = shapely.symmetric_difference(contour.polygon, region).area
    assert off < 3.0 * chord * region.length + 1e-9
