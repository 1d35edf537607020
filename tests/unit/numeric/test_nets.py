"""B-splines through points: cubics exactly, order four, and the same as another program's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from gearcam.numeric.nets import SplineNet, basis, spline_breaks, spline_poles


def test_they_are_those_of_scipy() -> None:
    places = np.array([0.0, 0.4, 1.0, 1.1, 2.0, 2.5, 4.0])
    points = np.stack([np.sin(places), np.exp(places)], axis=1)
    other = make_interp_spline(places, points, k=3)
    assert spline_poles(places, points) == pytest.approx(other.c, rel=1e-12)
    assert spline_breaks(places) == pytest.approx(np.unique(other.t))
    fine = np.linspace(0.0, 4.0, 101)
    assert basis(places, fine) @ other.c == pytest.approx(other(fine), rel=1e-12)


def net(count: int, function: object) -> SplineNet:
    along, across = np.linspace(0.0, 1.5, count), np.linspace(0.0, 1.0, 5)
    x, y = np.meshgrid(along, across, indexing="ij")
    points = np.stack([x, y, function(x, y)], axis=2)  # type: ignore[operator]
    return SplineNet(points=points, along=along, across=across)


def test_a_cubic_is_met_everywhere() -> None:
    def cubic(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return x**3 * y**3 - 2.0 * x * y**2

    x, y = np.linspace(0.0, 1.5, 7), np.linspace(0.0, 1.0, 9)
    found = net(6, cubic).at(x, y)[..., 2]
    assert found == pytest.approx(cubic(x[:, None], y[None, :]), abs=1e-13)


def test_the_error_is_of_fourth_order() -> None:
    x = np.linspace(0.0, 1.5, 301)
    errors = [
        np.abs(net(count, lambda u, v: np.sin(3.0 * u) + v).at(x, np.zeros(1))[:, 0, 2]
               - np.sin(3.0 * x)).max()
        for count in (17, 33, 65)
    ]  # fmt: skip
    assert np.abs(np.diff(np.log2(errors)) + 4.0).max() < 0.1


def test_edges_are_the_splines_through_the_edges() -> None:
    made = net(9, lambda x, y: np.cos(x + y))
    assert made.poles[:, 0] == pytest.approx(spline_poles(made.along, made.points[:, 0]), rel=1e-13)
    assert made.poles[-1] == pytest.approx(spline_poles(made.across, made.points[-1]), rel=1e-13)


@pytest.mark.parametrize("places", [[0.0, 1.0, 2.0], [0.0, 1.0, 1.0, 2.0]])
def test_too_few_or_equal_places_are_refused(places: list[float]) -> None:
    with pytest.raises(ValueError, match="four points"):
        spline_poles(np.array(places), np.zeros(len(places)))
