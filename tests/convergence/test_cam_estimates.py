"""What a coarser stage of a cam tells of its error grows with the order of its method."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.cams.follow import follow
from gearcam.cams.measures import size_of
from gearcam.laws.motion_table import MotionTable
from gearcam.parts.body import Part
from gearcam.parts.mass import quadrature_error
from helpers_cams import angles, cam

TOLERANCES = (4e-3, 1e-3, 2.5e-4)


def slope(counts: Sequence[float], errors: Sequence[float]) -> float:
    return float(np.polyfit(np.log(counts), np.log(errors), 1)[0])


@pytest.mark.parametrize("kind", ["roller, offset", "swinging roller"])
def test_sizes_by_gauss(kind: str) -> None:
    """As many nodes in a cell are good for twice the order; the estimate is never too small."""
    nodes, cells = 2, (32, 64, 128)
    drawn = cam(kind, "4-5-6-7").drawn
    exact = size_of(drawn)
    found = [size_of(drawn, nodes=nodes, most=most) for most in cells]
    told = [one.area_error for one in found]
    true = [abs(one.area - exact.area) for one in found]
    assert slope(cells, told) == pytest.approx(-2 * nodes, abs=0.1)
    assert all(a < b < 100.0 * a for a, b in zip(true, told, strict=True))


@pytest.mark.parametrize("kind", ["roller, offset", "swinging face"])
def test_chords_and_the_lift_that_they_give(kind: str) -> None:
    made = [cam(kind, "4-5-6-7", 4.0, tolerance=tolerance) for tolerance in TOLERANCES]
    counts = [len(one.outline) for one in made]
    assert slope(counts, [one.contour.chord_error for one in made]) == pytest.approx(-2.0, abs=0.1)
    theta, told = angles(200), []
    for one in made:
        found = follow(one.outline, one.follower, theta)
        off = np.abs(found.lift - one.program.derivatives(theta, 0)[0])
        told.append(float(found.error.max()))
        assert off.max() < told[-1] < 100.0 * off.max()
    assert slope(counts, told) == pytest.approx(-2.0, abs=0.1)


def test_rows_of_a_lift_and_its_derivatives() -> None:
    """Sixth order, and one less for each derivative."""
    counts = (36, 72, 144)
    told = []
    for count in counts:
        theta = 2.0 * math.pi * np.arange(count) / count
        table = MotionTable(theta=theta, lift=5.0 - 5.0 * np.cos(theta))
        told.append(table.program(DEFAULT).errors)
    for order, errors in enumerate(np.transpose(told)):
        assert slope(counts, errors.tolist()) == pytest.approx(order - 6, abs=0.1)


def test_volumes_by_cubics() -> None:
    """Of an outline's points the fourth order: a long ladder, as single points matter."""
    ladder = np.geomspace(4e-3, 4e-4, 9).tolist()
    made = [cam("roller, offset", "4-5-6-7", tolerance=tolerance) for tolerance in ladder]
    parts = [Part(name="cam", contours=(one.contour,), width=7.0) for one in made]
    told = [quadrature_error(part) for part in parts]
    counts = [len(one.outline) for one in made]
    assert slope(counts, told) == pytest.approx(-4.0, abs=0.1)
    for one, part, error in zip(made, parts, told, strict=True):
        off = abs(7.0 * (part.layers[0].moments.area - one.size.area))
        assert off < error < 100.0 * off
