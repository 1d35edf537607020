"""Lines and circles nearest to paths against printed values and searches by other means."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from scipy.optimize import linprog, minimize

from gearcam.linkages.elements import Law
from gearcam.linkages.nearest_circle import moved_center, nearest_center
from gearcam.linkages.path_fits import best_circle, best_line, distances_from
from gearcam.linkages.paths import PointPath
from gearcam.linkages.plane import towards
from gearcam.numeric.arrays import Array
from gearcam.numeric.jets import Jet
from helpers_measured import (
    TURN,
    drawn_straight,
    known_four_bar,
    six_bar_with_dwell,
)
from helpers_sampling import few

BEGIN, END = np.radians([100.0, 260.0]).tolist()


def _even_points(path: PointPath, begin: float, end: float, count: int = 20001) -> Array:
    return path.at(np.linspace(begin, end, count), 0).derivatives()[0]


@pytest.fixture(scope="module")
def round_path() -> PointPath:
    return PointPath(partial(six_bar_with_dwell().track, "E"), TURN)


def test_distances_from_the_center_of_the_source(round_path: PointPath) -> None:
    least, largest = distances_from(round_path, 300.0 + 826.7j, BEGIN, END)
    assert least.value == pytest.approx(378.728715219, abs=1e-9)
    assert largest.value == pytest.approx(379.63797181, abs=1e-8)
    for one in (least, largest):
        point = round_path.at(np.array([one.place]), 0).c[0]
        assert np.abs(point - (300.0 + 826.7j)) == pytest.approx(one.value, rel=1e-14)


def test_the_nearest_circle_against_a_search(round_path: PointPath) -> None:
    found = best_circle(round_path, BEGIN, END)
    points = _even_points(round_path, BEGIN, END)

    def deviation(center: Array) -> float:
        return 0.5 * float(np.ptp(np.abs(points - complex(*center))))

    start = np.array([300.0, 826.7])
    best = minimize(
        deviation,
        start,
        method="Nelder-Mead",
        options={"xatol": 1e-9, "fatol": 1e-12, "maxiter": 4000},
    )
    assert found.deviation < 0.45
    assert found.deviation == pytest.approx(best.fun, rel=1e-7)
    assert found.center == pytest.approx(complex(*best.x), abs=1e-4)
    distances = np.abs(points - found.center)
    assert distances.max() == pytest.approx(found.radius + found.deviation, abs=1e-7)
    assert distances.min() == pytest.approx(found.radius - found.deviation, abs=1e-7)
    assert found.angle == pytest.approx(
        np.angle((points[-1] - found.center) / (points[0] - found.center)), rel=1e-12
    )


@pytest.mark.parametrize("seed", few(range(10), 4))
def test_circles_nearest_to_waves(seed: int) -> None:
    random = np.random.default_rng(seed)
    ways, turns = random.normal(size=5) * 0.05, random.uniform(0.0, 6.0, 5)

    def wavy(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order)
        total = towards(x) * 10.0
        for number, (way, turn) in enumerate(zip(ways, turns, strict=True), start=2):
            total = total + towards(x * float(number) + turn) * way
        return total

    end = float(random.uniform(1.5, 6.5))
    path = PointPath(wavy, TURN)
    found = best_circle(path, 0.4, end)
    points = _even_points(path, 0.4, end, 5001)
    # the smallest largest deviation as a linear program round the centre found
    away = points - found.center
    distance = np.abs(away)
    rows = np.stack([-away.real / distance, -away.imag / distance, -np.ones(away.size)], axis=1)
    above = np.concatenate([np.c_[rows, -np.ones(away.size)], np.c_[-rows, -np.ones(away.size)]])
    limit = np.concatenate([found.radius - distance, distance - found.radius])
    best = linprog([0, 0, 0, 1], A_ub=above, b_ub=limit, bounds=[(-1, 1)] * 3 + [(0, None)])
    assert found.deviation == pytest.approx(best.fun, rel=1e-5)


@pytest.mark.parametrize("seed", few([0, 1, 2, 3, 4, 5, 9], 3))
def test_circles_nearest_to_stretches_that_are_not_round(seed: int) -> None:
    random = np.random.default_rng(seed)
    ways = (random.normal(size=(4, 2)) @ np.array([1.0, 1j])) * [10.0, 6.0, 3.0, 1.0]

    def wild(q: Array, order: int) -> Jet:  # turns back, bends both ways, crosses itself
        x = Jet.variable(q, order)
        total = Jet.variable(q * 0.0, order) * 0.0
        for times, way in zip((1.0, -1.0, 2.0, -2.0), ways, strict=True):
            total = total + towards(x * times) * way
        return total

    end = float(random.uniform(1.0, 6.6))
    path = PointPath(wild, TURN)
    found = best_circle(path, 0.4, end)
    points = _even_points(path, 0.4, end, 2001)

    def deviation(center: Array) -> float:
        return 0.5 * float(np.ptp(np.abs(points - complex(*center))))

    middle, size = points.mean(), np.abs(points - points.mean()).max()
    starts = [found.center, *(middle + size * random.normal(size=(8, 2)) @ [1.0, 1j])]
    tries = [
        minimize(deviation, [one.real, one.imag], method="Nelder-Mead", options={"maxiter": 2000})
        for one in starts
    ]
    assert found.deviation <= min(one.fun for one in tries) * (1.0 + 1e-4)
    assert found.deviation == pytest.approx(
        deviation(np.array([found.center.real, found.center.imag])), rel=1e-4
    )


@pytest.mark.parametrize(
    ("coupler", "base", "angle", "straight", "over"),
    [
        (250.0, 200.0, 0.0, 0.975373308636, 362.651605874),
        (217.0, 283.0, 0.5 * np.pi, 5.24623862348, 270.301544993),
    ],
    ids=["2.106 b", "2.106 c"],
)
def test_straight_lines_of_the_source(
    coupler: float, base: float, angle: float, straight: float, over: float
) -> None:
    path = PointPath(partial(drawn_straight(coupler, base, angle).track, "P"), TURN)
    found = best_line(path, BEGIN, END)
    assert 2.0 * found.deviation == pytest.approx(straight, abs=1e-10)
    assert found.length == pytest.approx(over, abs=1e-8)
    points = _even_points(path, BEGIN, END)
    off = ((points - found.point) * np.exp(-1j * found.direction)).imag
    assert [off.min(), off.max()] == pytest.approx([-found.deviation, found.deviation], abs=1e-6)
    along = ((points - found.point) * np.exp(-1j * found.direction)).real
    assert [along.min(), along.max()] == pytest.approx([-0.5 * over, 0.5 * over], abs=1e-6)


@pytest.mark.parametrize("begin", [0.3, 2.0, 4.4, 6.0])
def test_the_narrowest_strip_against_a_search(begin: float) -> None:
    path = PointPath(partial(known_four_bar().track, "P"), TURN)
    end = begin + 1.5  # over the end of a turn too
    found = best_line(path, begin, end)
    points = _even_points(path, begin, end, 4001)
    turned = np.linspace(found.direction - 0.2, found.direction + 0.2, 4001)
    widths = [np.ptp((points * np.exp(-1j * one)).imag) for one in turned]
    assert 2.0 * found.deviation == pytest.approx(min(widths), rel=1e-3)
    assert 2.0 * found.deviation <= min(widths) + 1e-6
    every = np.linspace(0.0, np.pi, 361)
    assert (
        2.0 * found.deviation
        <= min(np.ptp((points * np.exp(-1j * one)).imag) for one in every) + 1e-6
    )


def _of(function: Law) -> PointPath:
    return PointPath(function, TURN)


@pytest.mark.parametrize("direction", [0.7, -1.2, 0.5 * np.pi - 0.001])
def test_what_is_straight_is_straight(direction: float) -> None:
    def cardan(q: Array, order: int) -> Jet:  # a point of a circle that rolls in one twice as large
        x = Jet.variable(q, order)
        return (towards(x) + towards(-x)) * (3.0 * np.exp(1j * direction)) + 10j

    found = best_line(_of(cardan), 0.1, 3.0)
    assert found.deviation < 1e-14
    assert found.direction == pytest.approx(direction, abs=1e-14)
    assert found.length == pytest.approx(6.0 * (np.cos(0.1) - np.cos(3.0)), rel=1e-14)
    with pytest.raises(ValueError, match="the stretch is straight"):
        best_circle(_of(cardan), 0.1, 3.0)


def test_what_is_round_is_round() -> None:
    def circle(q: Array, order: int) -> Jet:
        return towards(-Jet.variable(q, order)) * 25.0 + (100.0 - 40j)

    for end in (0.5, 2.0 * np.pi + 0.2):
        found = best_circle(_of(circle), 0.2, end)
        assert found.center == pytest.approx(100.0 - 40j, abs=1e-10)
        assert found.radius == pytest.approx(25.0, abs=1e-10)
        assert found.deviation < 1e-12
        assert found.angle == pytest.approx(0.2 - end, rel=1e-12)


def test_the_circle_nearest_to_an_ellipse() -> None:
    def ellipse(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order)
        return towards(x) * 8.0 + towards(-x) * 2.0

    found = best_circle(_of(ellipse), 0.0, 2.0 * np.pi)
    assert found.center == pytest.approx(0.0, abs=1e-12)
    assert (found.radius, found.deviation) == pytest.approx((8.0, 2.0), rel=1e-13)


def test_of_what_bends_both_ways_the_nearest_circle_is_nearly_a_line() -> None:
    def bent(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order) - 1.0
        return x * 10.0 + x * x * x * 1j

    path = PointPath(bent, np.array([0.0, 2.0]), closed=False)
    circle, line = best_circle(path, 0.0, 2.0), best_line(path, 0.0, 2.0)
    assert circle.radius > 1e4
    assert circle.deviation == pytest.approx(line.deviation, rel=1e-3)


@pytest.mark.parametrize("seed", [2, 6, 9, 11])
def test_the_narrowest_of_strips_that_are_nearly_as_narrow(seed: int) -> None:
    """A triangle with round sides has three, which 256 points do not tell apart."""
    random = np.random.default_rng(seed)
    ways = (random.normal(size=2) + 1j * random.normal(size=2)) * 2e-3

    def triangle(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order)
        round_ = towards(x) * 10.0 + towards(x * -2.0)
        return round_ + towards(x * 3.0) * ways[0] + towards(x * -3.0) * ways[1]

    found = best_line(_of(triangle), 0.0, 2.0 * np.pi)
    points = _even_points(_of(triangle), 0.0, 2.0 * np.pi, 2001)
    turned = np.exp(-1j * np.linspace(0.0, np.pi, 4001))
    widths = np.array([np.ptp((points * one).imag) for one in turned])
    assert 2.0 * found.deviation == pytest.approx(widths.min(), rel=2e-6)


def test_a_center_may_be_a_point() -> None:
    x = np.linspace(0.0, 2.0 * np.pi, 256, endpoint=False)
    eight = np.sin(x) + 1j * np.sin(2.0 * x)
    center, deviation = moved_center(eight, complex(eight[20]))
    assert deviation == pytest.approx(0.5 * np.ptp(np.abs(eight - center)), rel=1e-14)
    assert deviation == pytest.approx(0.5 * np.ptp(np.abs(eight - nearest_center(eight))))


def test_a_distance_may_be_0() -> None:
    def circle(q: Array, order: int) -> Jet:
        return towards(Jet.variable(q, order))

    least, largest = distances_from(_of(circle), 1.0 + 0j, 3.0, 7.0)
    assert least == pytest.approx((0.0, 2.0 * np.pi), abs=1e-7)
    assert largest == pytest.approx((2.0, np.pi), abs=1e-12)


def test_corners_inside_a_stretch_are_seen() -> None:
    def corner(q: Array, order: int) -> Jet:
        x = Jet.variable(q, order) - 1.0
        return x * np.where(q < 1.0, 1.0 + 1.0j, 1.0 - 1.0j)

    path = PointPath(corner, np.array([0.0, 1.0, 2.0]), closed=False)
    found = best_line(path, 0.25, 1.75)
    assert found.deviation == pytest.approx(0.375, rel=1e-14)
    assert found.direction == pytest.approx(0.0, abs=1e-14)
    with pytest.raises(ValueError, match=r"stretch 0\.5 to 2\.5 rad: must be within 0 and 2 rad"):
        best_line(path, 0.5, 2.5)
    with pytest.raises(ValueError, match=r"stretch 1 to 1 rad: its end must be behind its begin"):
        best_circle(path, 1.0, 1.0)
