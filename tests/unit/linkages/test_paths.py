"""Lengths, areas, cusps and crossings against printed values and closed forms."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from scipy.special import ellipe

from gearcam.linkages.elements import Law
from gearcam.linkages.paths import PointPath
from gearcam.linkages.plane import towards
from gearcam.numeric import jets
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from helpers_measured import TURN, four_bar, known_four_bar


def _two_cranks(first: float, second: float, speed: int = 2) -> Law:
    """Return the end of a crank on a crank that turns `speed` times as fast: a trochoid."""

    def track(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order)
        return towards(x) * first + towards(x * float(speed)) * second

    return track


def _waves(across: float, along: float, times: int = 1) -> Law:
    def track(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order)
        return jets.cos(x) * across + jets.sin(x * float(times)) * (along * 1j)

    return track


def test_the_coupler_curve() -> None:
    path = PointPath(partial(known_four_bar().track, "P"), TURN)
    assert path.length.value == pytest.approx(235.975413454, abs=1e-9)
    assert path.area is not None
    assert path.area.value == pytest.approx(3765.63405109, abs=1e-8)
    assert path.length.error < 1e-10 * path.length.value
    assert path.cusps == path.crossings == ()


def test_a_circle_and_a_wavy_one_far_away() -> None:
    def waves(height: float, center: complex) -> Law:
        def track(q: Array, order: int) -> Jet:
            x = Jet.variable(q, order)
            return towards(x) * (7.0 + jets.cos(x * 60.0) * height) + center

        return track

    path = PointPath(waves(0.0, 0j), TURN)
    assert path.length.value == pytest.approx(14.0 * np.pi, rel=1e-14)
    assert path.area is not None
    assert path.area.value == pytest.approx(49.0 * np.pi, rel=1e-14)
    # far away the points are rounded to 1e-8 mm
    away = PointPath(waves(0.2, 1e8 - 1e8j), TURN)
    assert away.area is not None
    assert away.area.value == pytest.approx(49.02 * np.pi, rel=1e-8)


@pytest.mark.parametrize("along", [0.5, 0.01, 1e-5])
def test_an_ellipse_however_flat(along: float) -> None:
    path = PointPath(_waves(1.0, -along), TURN)
    assert path.length.value == pytest.approx(4.0 * ellipe(1.0 - along**2), rel=1e-12)
    assert path.area is not None
    assert path.area.value == pytest.approx(-np.pi * along, rel=1e-12)
    assert path.cusps == path.crossings == ()


def test_a_cardioid_has_a_cusp() -> None:
    path = PointPath(_two_cranks(2.0, -1.0), TURN)
    assert path.length.value == pytest.approx(16.0, rel=1e-13)
    assert path.area is not None
    assert path.area.value == pytest.approx(6.0 * np.pi, rel=1e-13)
    (cusp,) = path.cusps
    assert cusp.place == pytest.approx(0.0, abs=1e-12)
    assert cusp.point == pytest.approx(1.0, abs=1e-12)
    assert path.crossings == ()


def test_a_deltoid_has_three() -> None:
    path = PointPath(_two_cranks(2.0, 1.0, -2), TURN)
    assert path.length.value == pytest.approx(16.0, rel=1e-13)
    assert path.length.error < 1e-13  # each panel ends at a cusp
    places = [one.place for one in path.cusps]
    assert places == pytest.approx(np.arange(3) * 2.0 * np.pi / 3.0, abs=1e-12)


def test_a_point_of_the_moving_centrode_makes_a_cusp() -> None:
    linkage = known_four_bar()
    crank = np.radians(70.0)
    known = linkage.at(np.array([crank]), 0)
    b, c, d = (complex(np.asarray(known.jet(name).c[0])[0]) for name in ("B", "C", "D"))
    # the coupler turns about the crossing of crank and rocker
    across = ((d - 0.0).conjugate() * (c - d)).imag / (b.conjugate() * (c - d)).imag
    pole = b * across
    beside = (pole - b) * abs(c - b) / (c - b)
    path = PointPath(partial(four_bar(110.0, (40.0, 120.0, 90.0), beside).track, "P"), TURN)
    (cusp,) = path.cusps
    assert cusp.place == pytest.approx(crank, abs=1e-12)
    assert cusp.point == pytest.approx(pole, abs=1e-10)
    near = PointPath(partial(four_bar(110.0, (40.0, 120.0, 90.0), beside + 0.01).track, "P"), TURN)
    assert near.cusps == ()


def test_a_rocker_goes_back_without_a_cusp() -> None:
    linkage = known_four_bar()
    path = PointPath(partial(linkage.track, "C"), TURN)
    assert path.cusps == path.crossings == ()
    assert path.length.value == pytest.approx(2.0 * 90.0 * np.radians(60.0110052852), rel=1e-11)
    assert path.area is not None
    assert path.area.value == pytest.approx(0.0, abs=1e-9)


def test_a_figure_8_crosses_itself_once() -> None:
    (crossing,) = PointPath(_waves(3.0, 1.0, 2), TURN).crossings
    assert crossing[:2] == pytest.approx((np.pi / 2, 3 * np.pi / 2), abs=1e-14)
    assert crossing.point == pytest.approx(0.0, abs=1e-14)


def test_a_limacon_with_a_loop() -> None:
    path = PointPath(_two_cranks(2.0, 1.5), TURN)
    (crossing,) = path.crossings
    half = np.arccos(-2.0 / 3.0)
    assert crossing[:2] == pytest.approx((half, 2.0 * np.pi - half), abs=1e-13)
    assert crossing.point == pytest.approx(2.0 * np.cos(half) + 1.5 * np.cos(2 * half), abs=1e-13)


def test_a_rosette_crosses_itself_in_every_pair_of_leaves() -> None:
    path = PointPath(_two_cranks(1.0, 0.6, 6), TURN)
    found = path.crossings
    points = path.at(np.array([one[:2] for one in found]).ravel(), 0).derivatives()[0]
    points = points.reshape(-1, 2)
    assert np.abs(points[:, 0] - points[:, 1]).max() < 1e-14
    # by symmetry in fives
    assert len(found) == 5
    turned = sorted(np.angle([one.point * np.exp(1j) for one in found]))
    assert np.diff(turned) == pytest.approx(np.full(4, 2.0 * np.pi / 5.0), abs=1e-12)


def test_an_open_path() -> None:
    path = PointPath(_waves(3.0, 1.0, 2), np.array([1.0, 5.0]), closed=False)
    assert path.area is None
    (crossing,) = path.crossings
    assert crossing[:2] == pytest.approx((np.pi / 2, 3 * np.pi / 2), abs=1e-14)
    half = PointPath(_waves(2.0, 2.0), np.array([0.0, np.pi]), closed=False)
    assert half.length.value == pytest.approx(2.0 * np.pi, rel=1e-14)


def _cycloid(x: Jet) -> Jet:
    return x - jets.sin(x * (2.0 * np.pi)) / (2.0 * np.pi)


def _parallelogram(q: Array, order: int) -> Jet:
    """Return the table of two cams: 30 mm along x, 20 mm at 75 deg to it, in turn."""
    x = Jet.variable(q, order) * (2.0 / np.pi)
    ways = [_cycloid(x - float(k)) for k in range(4)]
    side = 20.0 * np.exp(1j * np.radians(75.0))
    parts = [30.0 * ways[0], 30.0 + side * ways[1], 30.0 * (1.0 - ways[2]) + side]
    parts.append(side * (1.0 - ways[3]))
    which = np.clip(np.floor(q * (2.0 / np.pi)), 0, 3).astype(int)
    coefficients = [
        np.choose(which, [np.broadcast_to(one.c[k], q.shape) for one in parts])
        for k in range(order + 1)
    ]
    return Jet(coefficients)


def test_a_table_traces_a_parallelogram() -> None:
    path = PointPath(_parallelogram, np.linspace(0.0, 2.0 * np.pi, 5))
    assert path.length.value == pytest.approx(100.0, rel=1e-12)
    assert path.area is not None
    assert path.area.value == pytest.approx(579.555495773, rel=1e-12)
    assert path.cusps == path.crossings == ()


def test_corners_are_no_crossings() -> None:
    corners = np.array([0.0, 10.0, 10.0 + 8.0j, 0.0])

    def triangle(q: Array, order: int) -> Jet:
        which = np.clip(np.floor(q), 0, 2).astype(int)
        x = Jet.variable(q, order) - which
        return x * (corners[which + 1] - corners[which]) + corners[which]

    path = PointPath(triangle, np.arange(4.0))
    assert path.crossings == path.cusps == ()
    assert path.length.value == pytest.approx(18.0 + np.sqrt(164.0), rel=1e-14)
    assert path.area is not None
    assert path.area.value == pytest.approx(40.0, rel=1e-14)
