"""Curvature from three points: its error falls with the square of the spacing, where it may."""

from __future__ import annotations

import math
from collections.abc import Callable

import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray

from gearcam.base.errors import InfeasibleError
from gearcam.cams.three_points import CurvatureStudy, curvature_study, three_point_curvature

Array = NDArray[np.float64]
Plane = NDArray[np.complex128]

COUNTS = (500, 1000, 2000, 4000, 8000)
A, B = 50.0, 30.0
BASE, TIP, APART = 30.0, 8.0, 35.0


def ellipse(u: Array) -> Plane:
    return A * np.cos(u) + 1j * B * np.sin(u)


def ellipse_curvature(u: Array) -> Array:
    return A * B / ((A * np.sin(u)) ** 2 + (B * np.cos(u)) ** 2) ** 1.5


def slope(study: CurvatureStudy, errors: Array) -> float:
    return float(np.polyfit(np.log(study.spacing), np.log(errors), 1)[0])


def nose() -> tuple[Array, Callable[[Array], Plane], Callable[[Array], Array]]:
    """A cam of two arcs and two straight flanks by its arc length: knots, points, curvature."""
    beta = math.acos((BASE - TIP) / APART)
    flank = APART * math.sin(beta)
    ends = np.cumsum([0.0, TIP * beta, flank, 2.0 * BASE * (math.pi - beta), flank, TIP * beta])

    def place(s: Array) -> Plane:
        s = np.mod(s, ends[-1])
        normal = np.exp(1j * np.array([beta, -beta]))
        pieces = [
            APART + TIP * np.exp(1j * (s / TIP)),
            APART + normal[0] * (TIP + 1j * (s - ends[1])),
            BASE * np.exp(1j * (beta + (s - ends[2]) / BASE)),
            normal[1] * (BASE + 1j * (s - ends[3])),
            APART + TIP * np.exp(1j * (s - ends[5]) / TIP),
        ]
        return np.asarray(np.select([s < end for end in ends[1:]], pieces), dtype=np.complex128)

    def curvature(s: Array) -> Array:
        inside = [s < end for end in ends[1:]]
        return np.select(inside, [1.0 / TIP, 0.0, 1.0 / BASE, 0.0, 1.0 / TIP])

    return ends, place, curvature


def test_the_error_falls_with_the_square_on_an_ellipse() -> None:
    study = curvature_study(ellipse, ellipse_curvature, COUNTS)
    assert slope(study, study.largest) == pytest.approx(2.0, abs=0.1)
    assert slope(study, study.rms) == pytest.approx(2.0, abs=0.1)
    assert np.all(study.rms < study.largest)
    assert study.largest[-1] < 1e-7
    assert list(study.count) == list(COUNTS)
    assert study.spacing == pytest.approx(2.0 * math.pi * A / study.count, rel=1e-3)


def test_a_curvature_that_is_off_is_seen() -> None:
    """The control: against a curvature wrong by a thousandth the error stops falling."""
    study = curvature_study(ellipse, lambda u: 1.001 * ellipse_curvature(u), COUNTS)
    assert slope(study, study.largest) < 0.5


def test_at_a_jump_the_largest_error_stays() -> None:
    """Three points across a jump see a mean of both sides; all others are as good as ever.

    The mean is weighted by a triangle, so that the two points beside a jump, f and 1 - f steps
    away, are off by (1 - f)^2/2 and f^2/2 of the jump: the larger is an eighth to a half of it.
    """
    ends, place, curvature = nose()
    study = curvature_study(place, curvature, COUNTS, period=ends[-1])
    jump, other = 1.0 / TIP, 1.0 / BASE
    assert np.all(study.largest > 0.124 * jump)
    assert np.all(study.largest < 0.501 * jump)
    # two points at each jump: the mean square falls with the number of points
    scaled = study.rms * np.sqrt(study.count)
    assert np.all(scaled > 0.249 * jump)
    assert np.all(scaled < 0.708 * math.hypot(jump, other))
    for count, spacing in zip(study.count, study.spacing, strict=True):
        s = np.arange(count) * (ends[-1] / count)
        error = np.abs(three_point_curvature(place(s)) - curvature(s))
        off = error > 1e-6
        assert 2 <= np.count_nonzero(off) <= 8
        assert np.abs(s[off, None] - ends).min(axis=1).max() < spacing


def test_uneven_points_lose_an_order() -> None:
    """The circle's curvature is that of the mean of the three places: off by k'*(h2 - h1)/3."""
    errors, steps = [], []
    for count in COUNTS:
        even = np.arange(count) * (2.0 * math.pi / count)
        u = even + 0.25 * (even[1] - even[0]) * (-1.0) ** np.arange(count)
        points = ellipse(u)
        errors.append(np.abs(three_point_curvature(points) - ellipse_curvature(u)).max())
        steps.append(np.abs(np.diff(points)).max())
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("uneven", [False, True])
def test_a_circle_is_exact_and_signed(uneven: bool) -> None:
    u = np.sort(np.random.default_rng(2).uniform(0.0, 6.0, 60)) if uneven else np.linspace(0, 6, 60)
    points = np.asarray(3.0 + 12.0 * np.exp(1j * u), dtype=np.complex128)
    assert three_point_curvature(points) == pytest.approx(np.full(60, 1.0 / 12.0), rel=1e-10)
    assert three_point_curvature(points[::-1]) == pytest.approx(np.full(60, -1.0 / 12.0), rel=1e-10)
    assert three_point_curvature(np.conj(points), closed=False) == pytest.approx(
        np.full(58, -1.0 / 12.0), rel=1e-10
    )


def test_a_straight_line_has_none() -> None:
    line = np.arange(9.0)
    aslant = np.asarray(line * (0.3 + 0.7j), dtype=np.complex128)
    assert np.abs(three_point_curvature(aslant, closed=False)).max() < 1e-14
    assert np.all(three_point_curvature(line.astype(np.complex128), closed=False) == 0.0)


def test_close_points_lose_nothing_but_their_own_rounding() -> None:
    """The points as they are, by mpmath: a turn of 1e-8 from chord to chord."""
    for aim in np.linspace(0.1, 6.0, 50):
        chord = 0.7 * np.exp(1j * aim)
        points = np.array([-chord, 0.0, chord * np.exp(1e-8j)])
        with mpmath.workdps(60):
            before, after = mpmath.mpc(-points[0]), mpmath.mpc(points[2])
            cross = mpmath.im(mpmath.conj(before) * after)
            exact = 2 * cross / (abs(before) * abs(after) * abs(before + after))
        assert three_point_curvature(points, closed=False)[0] == pytest.approx(
            float(exact), rel=4e-15, abs=0.0
        )


@pytest.mark.parametrize(
    ("points", "closed", "words"),
    [
        (np.array([0.0, 1j]), True, "too few points for a circle; value 2 points, limit 3"),
        (np.array([0.0, 1j, 1j, 2.0]), True, "not three different points (point 1)"),
        (np.array([0.0, 1.0, 1j, 1.0]), False, "not three different points (point 2)"),
        (np.array([0.0, 1.0, 1j, 0.0]), True, "not three different points (point 0)"),
    ],
)
def test_no_circle_is_refused(points: Plane, closed: bool, words: str) -> None:
    with pytest.raises(InfeasibleError) as caught:
        three_point_curvature(points, closed=closed)
    assert words in str(caught.value)
