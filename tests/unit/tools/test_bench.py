"""The cases of the bench call the package by the names that it has."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

import gearcam

ROOT = Path(__file__).parents[3]


@pytest.fixture
def cases(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setattr(sys, "path", [str(ROOT / "benchmarks"), *sys.path])
    import cam_cases  # pyright: ignore[reportMissingImports]

    return cam_cases


def test_a_cam_by_subtraction_is_the_profile(cases: Any) -> None:
    """With 400 rollers of 64 sides: a scallop is 0.02 mm high at most, a side 0.04 mm deep."""
    design = gearcam.loads(cases.CAM.format(tolerance=1e-4))
    left = cases.united(gearcam.build(design), 400, 64)
    corners = shapely.points(np.asarray(left.exterior.coords))
    off = shapely.distance(corners, shapely.LinearRing(cases.profile(design)))
    assert 0.0 < off.max() < 0.06
