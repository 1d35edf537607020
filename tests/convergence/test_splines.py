"""Splines stay within their tolerance, and need pieces as the fourth root of it says.

The splines are evaluated by de Boor's recursion from poles and full knots, as a program that reads
the file would do, and compared with closed forms at places that the fit has not seen.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from gearcam.numeric.contour import Run
from gearcam.numeric.splines import DEGREE, Spline, fit_splines
from helpers_contour import Curve, arc
from helpers_curves import cubics

FINE = np.linspace(0.0, 1.0, 60001)


def ellipse_piece(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Most of an ellipse of 30 x 18 mm, with its ends at no axis."""
    t = 0.3 + 5.0 * u
    return 30 * np.cos(t) + 18j * np.sin(t), 5 * (-30 * np.sin(t) + 18j * np.cos(t))


def wave(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A cubic graph: its curvature passes through 0, as a clothoid's does."""
    x = 40 * (u - 0.4)
    return x + 1e-3j * x**3, 40 * (1 + 3e-3j * x**2)


def flank(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """An involute of a circle of 20 mm."""
    roll = 0.25 + 0.85 * u
    spoke = 20.0 * np.exp(1j * (0.4 + roll))
    return spoke * (1 - 1j * roll), spoke * roll * 0.85


CURVES: dict[str, Curve] = {"ellipse": ellipse_piece, "wave": wave, "involute": flank}


def run_of(curve: Curve, count: int = 4000) -> Run:
    """Dense points of a curve with exact tangents."""
    points, slopes = curve(np.linspace(0.0, 1.0, count + 1))
    return Run(points=points, tangents=np.exp(1j * np.angle(slopes)))


def de_boor(poles: np.ndarray, knots: np.ndarray, places: np.ndarray) -> np.ndarray:
    """A cubic B-spline at some places, from its definition only."""
    last = len(poles) - 1
    k = np.clip(np.searchsorted(knots, places, side="right") - 1, DEGREE, last)
    d = [poles[k - DEGREE + j] for j in range(DEGREE + 1)]
    for r in range(1, DEGREE + 1):
        for j in range(DEGREE, r - 1, -1):
            low, high = knots[k - DEGREE + j], knots[k + 1 + j - r]
            share = (places - low) / (high - low)
            d[j] = (1 - share) * d[j - 1] + share * d[j]
    return d[DEGREE]


def drawn(spline: Spline, each: int = 60) -> np.ndarray:
    """Complex points on a spline, `each` on every cubic."""
    share = np.arange(each) / each
    places = (spline.breaks[:-1, None] + np.diff(spline.breaks)[:, None] * share).ravel()
    places = np.append(places, spline.breaks[-1])
    return de_boor(spline.poles, spline.knots, places)


def miss(points: np.ndarray, curve: Curve) -> float:
    """Largest distance of points from a curve: the nearest of fine places, then the foot there."""
    places = FINE[::40]
    fine, _ = curve(places)
    blocks = np.array_split(points, 1 + len(points) // 40)
    u = np.concatenate([places[np.abs(b[:, None] - fine).argmin(axis=1)] for b in blocks])
    for _ in range(8):
        at, slope = curve(u)
        u = np.clip(u + np.real((points - at) * np.conj(slope)) / np.abs(slope) ** 2, 0.0, 1.0)
    return float(np.abs(points - curve(u)[0]).max())


@pytest.mark.parametrize("tolerance", [3e-2, 1e-3, 1e-5])
@pytest.mark.parametrize("name", CURVES)
def test_the_error_is_below_the_tolerance_and_near_it(name: str, tolerance: float) -> None:
    spline = fit_splines([run_of(CURVES[name])], tolerance)[0]
    error = miss(drawn(spline), CURVES[name])
    assert error <= tolerance
    if len(spline.breaks) > 3:
        assert error > 0.5 * tolerance, "cubics are shorter than they need to be"


@pytest.mark.parametrize("name", CURVES)
def test_it_reaches_both_ends_with_their_tangents(name: str) -> None:
    run = run_of(CURVES[name])
    spline = fit_splines([run], 1e-3)[0]
    assert spline.poles[[0, -1]].tolist() == run.points[[0, -1]].tolist()
    for arm, unit in ((spline.poles[:2], run.tangents[0]), (spline.poles[-2:], run.tangents[-1])):
        way = arm[1] - arm[0]
        assert way / abs(way) == pytest.approx(unit, abs=1e-11)


@pytest.mark.parametrize("name", CURVES)
def test_knots_are_double_and_tangents_pass_through_them(name: str) -> None:
    spline = fit_splines([run_of(CURVES[name])], 1e-4)[0]
    cubics = len(spline.breaks) - 1
    assert cubics > 3
    assert len(spline.poles) == 2 * cubics + 2
    assert len(spline.knots) == len(spline.poles) + DEGREE + 1
    values, counts = np.unique(spline.knots, return_counts=True)
    assert counts.tolist() == [4, *[2] * (cubics - 1), 4]
    assert values.tolist() == spline.breaks.tolist()
    poles, step = spline.poles, 1e-5
    knot = spline.breaks[1:-1]
    before, at, after = (de_boor(poles, spline.knots, knot + d) for d in (-step, 0.0, step))
    fine, slopes = CURVES[name](FINE)
    nearest = np.abs(at[:, None] - fine[None, ::10]).argmin(axis=1)
    assert np.abs(np.angle((after - at) / (at - before))).max() < 2e-5
    assert np.abs(np.angle((after - before) / slopes[::10][nearest])).max() < 2e-3
    # parametrised by the arc length, about: what a machine's feed follows
    assert np.abs(after - before) == pytest.approx(2 * step, rel=1e-3)


@pytest.mark.parametrize("name", CURVES)
def test_its_cubics_are_the_spline(name: str) -> None:
    spline = fit_splines([run_of(CURVES[name])], 1e-4)[0]
    u = np.linspace(0.0, 1.0, 11)
    for (low, high), bezier in zip(pairwise(spline.breaks), cubics(spline), strict=True):
        a, b, c, d = bezier
        v = 1 - u
        curve = v**3 * a + 3 * u * v**2 * b + 3 * u**2 * v * c + u**3 * d
        inside = low + (high - low) * np.clip(u, 1e-12, 1 - 1e-12)
        other = de_boor(spline.poles, spline.knots, inside)
        assert np.abs(curve - other).max() < 1e-9


@pytest.mark.parametrize("radius", [500.0, 1500.0, 5000.0])
@pytest.mark.parametrize("length", [60.0, 400.0])
def test_it_stays_near_a_long_step_beside_a_bend(radius: float, length: float) -> None:
    """A gentle bend, densely drawn, runs into a straight piece that has its two ends only."""
    tolerance = 3e-3
    for count in (20, 60, 200):
        angle = np.linspace(-160.0 / radius, 0.0, count)
        points = np.append(radius * (np.exp(1j * (angle - np.pi / 2)) + 1j), length)
        tangents = np.append(np.exp(1j * angle), 1.0)
        run = Run(points=points, tangents=tangents)
        made: Any = drawn(fit_splines([run], tolerance)[0])
        straight = made.real > 0.0
        assert np.abs(made[straight].imag).max() <= tolerance


def test_pieces_follow_the_fourth_root_of_the_tolerance() -> None:
    tolerances = 10.0 ** np.arange(-2, -9, -1.0)
    run = run_of(ellipse_piece, 20000)
    counts = [len(fit_splines([run], tolerance)[0].breaks) - 1 for tolerance in tolerances]
    slope = np.polyfit(np.log(tolerances[2:]), np.log(counts[2:]), 1)[0]
    assert slope == pytest.approx(-0.25, abs=0.025)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6])
def test_a_circle_needs_as_many_as_theory_says(tolerance: float) -> None:
    """With arms of the arc's length the middle of a cubic misses by ``r*(h/r)**4/384``."""
    radius, sweep = 10.0, 5.0
    run = run_of(arc(0j, radius, 0.0, sweep), 20000)
    longest = (384 * tolerance / radius) ** 0.25
    count = len(fit_splines([run], tolerance)[0].breaks) - 1
    assert sweep / longest <= count * 1.01
    assert count <= math.ceil(1.06 * sweep / longest) + 1


def test_a_straight_piece_is_one_cubic() -> None:
    ends = np.array([1 + 2j, 31 + 42j])
    run = Run(points=ends, tangents=np.full(2, 0.6 + 0.8j))
    spline = fit_splines([run], 1e-6)[0]
    assert len(spline.breaks) == 2
    assert spline.poles == pytest.approx(np.array([1 + 2j, 11 + 46j / 3, 21 + 86j / 3, 31 + 42j]))
    assert spline.breaks == pytest.approx([0.0, 50.0])


def test_points_given_twice_do_no_harm() -> None:
    run = run_of(flank)
    twice = Run(points=np.repeat(run.points, 2), tangents=np.repeat(run.tangents, 2))
    doubled, plain = fit_splines([twice, run], 1e-4)
    assert doubled.poles == pytest.approx(plain.poles, abs=1e-12)


@pytest.mark.parametrize("pole", [1, 4, 5, -2])
def test_a_moved_pole_is_found(pole: int) -> None:
    """The control: the largest share of an inner pole in its cubic is 4/9."""
    tolerance = 1e-3
    spline = fit_splines([run_of(ellipse_piece)], tolerance)[0]
    poles = spline.poles.copy()
    way = poles[pole + 1] - poles[pole - 1] if pole > 0 else poles[-1] - poles[-3]
    poles[pole] += 6 * tolerance * 1j * way / abs(way)
    assert miss(drawn(Spline(poles=poles, breaks=spline.breaks)), ellipse_piece) > tolerance


@pytest.mark.parametrize("tolerance", [0.0, -1e-3, math.nan])
def test_tolerances_that_are_not_positive_are_refused(tolerance: float) -> None:
    with pytest.raises(ValueError, match="tolerance must be positive"):
        fit_splines([run_of(flank, 50)], tolerance)


def test_a_single_point_is_refused() -> None:
    point, unit = np.array([1 + 2j]), np.array([1 + 0j])
    for count in (1, 3):
        run = Run(points=np.repeat(point, count), tangents=np.repeat(unit, count))
        with pytest.raises(ValueError, match="two different points"):
            fit_splines([run], 1e-3)
