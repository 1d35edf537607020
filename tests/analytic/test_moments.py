"""Moments of plane regions agree with closed forms, about the origin, wherever the region lies."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from gearcam.cams.carriers import unit
from gearcam.numeric.hermite import hermite_arms
from gearcam.numeric.moments import Moments, arc_moments, curve_moments
from gearcam.parts.shapes import Circle, Loop
from helpers_contour import Curve, arc, disc_contour, line, square_contour

EXACT = 1e-12
"""Relative error of closed forms: rounding."""


def agree(made: Moments, area: float, centre: complex, polar: float, within: float) -> None:
    """Compare with area, centroid and polar moment about the origin."""
    size = math.sqrt(abs(area)) + abs(centre)
    assert made.area == pytest.approx(area, rel=within)
    assert abs(made.first - area * centre) <= within * abs(area) * size
    assert made.polar == pytest.approx(polar, rel=within)


def shifted(area: float, centre: complex, own_polar: float) -> float:
    """Polar moment about the origin (Steiner)."""
    return own_polar + area * abs(centre) ** 2


def segment(radius: float, angle: float) -> tuple[float, float, float]:
    """Area, centroid's distance and polar moment about the circle's centre of a segment.

    The segment is cut off by a chord that is seen from the centre under `angle`, up to pi.
    """
    area = 0.5 * radius**2 * (angle - math.sin(angle))
    away = 4 * radius * math.sin(angle / 2) ** 3 / (3 * (angle - math.sin(angle)))
    chord, height = 2 * radius * math.sin(angle / 2), radius * math.cos(angle / 2)
    # polar moment of the sector less that of the triangle about its apex
    triangle = 0.5 * chord * height * (height**2 / 2 + chord**2 / 24)
    return area, away, radius**4 * angle / 4 - triangle


@pytest.mark.parametrize("centre", [0j, 3 - 2j, -40 + 90j])
@pytest.mark.parametrize("count", [2, 3, 7])
def test_a_disc_off_the_centre(centre: complex, count: int) -> None:
    radius = 4.0
    spokes: Any = centre + radius * np.exp(2j * np.pi * np.arange(count) / count + 0.3j)
    bulges = np.full(count, math.tan(0.5 * math.pi / count))
    area = math.pi * radius**2
    polar = shifted(area, centre, 0.5 * area * radius**2)
    agree(arc_moments(spokes, bulges), area, centre, polar, EXACT)
    circle = Circle(center=complex(centre.real, centre.imag), diameter=2 * radius)
    agree(circle.moments, area, centre, polar, EXACT)


@pytest.mark.parametrize("angle", [1e-3, 0.5, 2.0, math.pi])
@pytest.mark.parametrize("turn", [0.0, 2.2])
def test_a_circular_segment(angle: float, turn: float) -> None:
    """Half a disc is the segment of the angle pi; a thin one shows that no digits are lost."""
    radius, centre = 5.0, 2 + 1j
    ends: Any = centre + radius * np.exp(1j * (turn + np.array([-0.5, 0.5]) * angle))
    made = arc_moments(ends, np.array([math.tan(angle / 4), 0.0]))
    area, away, polar = segment(radius, angle)
    place = centre + away * np.exp(1j * turn)
    # the thin segment's closed form itself is a difference of nearly equal numbers
    within = EXACT if angle > 0.1 else 1e-7
    own = polar - area * away**2
    agree(made, area, place, shifted(area, place, own), within)


def test_a_concave_arc_takes_its_segment_away() -> None:
    """A square with a half disc cut out of its right side."""
    vertices = np.array([-2 - 2j, 2 - 2j, 2 - 1j, 2 + 1j, 2 + 2j, -2 + 2j])
    made = arc_moments(vertices, np.array([0.0, 0.0, -1.0, 0.0, 0.0, 0.0]))
    area, away, polar = segment(1.0, math.pi)
    place = 2.0 - away
    left = 16.0 - area
    first = -area * place
    whole = 16.0 * 4.0**2 / 6 - shifted(area, place, polar - area * away**2)
    agree(made, left, first / left, whole, EXACT)


def test_an_annular_slot() -> None:
    """A ring's sector with round ends about the origin: sectors by Pappus, ends as half discs."""
    mean, half, sweep = 20.0, 1.5, 2.4
    outwards = np.exp(1j * np.array([0.0, sweep]))
    points: Any = np.concatenate([(mean + half) * outwards, (mean - half) * outwards[::-1]])
    bend = math.tan(sweep / 4)
    made = arc_moments(points, np.array([bend, 1.0, -bend, 1.0]))
    outer, inner = mean + half, mean - half
    area = sweep / 2 * (outer**2 - inner**2) + math.pi * half**2
    polar = sweep / 4 * (outer**4 - inner**4)
    first = (outer**3 - inner**3) / 3 * (np.exp(1j * sweep) - 1) / 1j
    piece, away, about = segment(half, math.pi)
    for end, out in ((1.0, -1j), (np.exp(1j * sweep), 1j * np.exp(1j * sweep))):
        place = mean * end + away * out
        first += piece * place
        polar += shifted(piece, place, about - piece * away**2)
    agree(made, area, first / area, polar, EXACT)


def test_regions_add_and_subtract() -> None:
    big, hole = (
        Circle(center=complex(x, 0.0), diameter=d).moments for x, d in ((0.0, 20.0), (4.0, 6.0))
    )
    left = big - hole
    agree(left, math.pi * 91, -4 * 9 / 91, math.pi / 2 * (10**4 - 3**4) - 144 * math.pi, EXACT)
    agree(left + hole, math.pi * 100, 0j, math.pi / 2 * 10**4, EXACT)


def test_a_loop_keeps_its_length_and_reach() -> None:
    loop = Loop(
        points=np.array([3 - 2j, 3 + 2j, -3 + 2j, -3 - 2j]),
        bulges=np.array([1.0, 0.0, 1.0, 0.0]),
    )
    assert loop.length == pytest.approx(4 * math.pi + 12, rel=EXACT)
    assert 5.0 <= loop.reach <= 5.0 + 2e-4 * 6
    assert loop.moments.area == pytest.approx(24 + 4 * math.pi, rel=EXACT)


def test_clockwise_loops_are_refused() -> None:
    square = np.array([1 + 1j, -1 + 1j, -1 - 1j, 1 - 1j])
    assert Loop(points=square, bulges=np.zeros(4)).moments.area == pytest.approx(4.0, rel=EXACT)
    with pytest.raises(ValueError, match="counter-clockwise"):
        Loop(points=square[::-1], bulges=np.zeros(4))


def ellipse(a: float, b: float, centre: complex) -> Curve:
    """An ellipse over u in [0, 1], with its exact derivative."""

    def curve(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        t = 2 * np.pi * u
        return (
            centre + a * np.cos(t) + 1j * b * np.sin(t),
            2 * np.pi * (-a * np.sin(t) + 1j * b * np.cos(t)),
        )

    return curve


def sampled(curve: Curve, count: int) -> Moments:
    """Moments from `count` steps, points and unit tangents exact."""
    points, slopes = curve(np.linspace(0.0, 1.0, count + 1))
    return curve_moments(points, unit(np.angle(slopes)))


def test_an_ellipse_by_points_and_tangents() -> None:
    a, b, centre = 7.0, 4.0, 1 - 3j
    area = math.pi * a * b
    polar = shifted(area, centre, area * (a**2 + b**2) / 4)
    agree(sampled(ellipse(a, b, centre), 1200), area, centre, polar, 1e-9)


def test_wrong_tangents_are_found() -> None:
    """The control: between chord and cubic lies chord x (D0 - D1)/10 + D0 x D1/60 and no more.

    Turned end derivatives change the first term only: it is 6/5 of the bows, and loses 1 - cos.
    """
    radius, count, turn = 5.0, 200, 0.1
    points, slopes = arc(0j, radius, 0.0, 2 * math.pi)(np.linspace(0.0, 1.0, count + 1))
    turned = (unit(np.angle(slopes) + by) for by in (0.0, turn))
    right, wrong = (curve_moments(points, tangents).area for tangents in turned)
    bows = math.pi * radius**2 - count * radius**2 / 2 * math.sin(2 * math.pi / count)
    assert right - wrong == pytest.approx(1.2 * bows * (1 - math.cos(turn)), rel=0.01)
    assert right - wrong > 100 * abs(right - math.pi * radius**2)


@pytest.mark.parametrize("radius", [1.0, 6.0])
@pytest.mark.parametrize("count", [12, 24, 48])
def test_the_area_error_of_a_circle_is_the_theory_s(radius: float, count: int) -> None:
    """Hermite's remainder in the arc length: h**4/24*t**2*(1 - t)**2 times the fourth derivative.

    On a circle that derivative points outwards with 1/r**3; the integral of t**2*(1 - t)**2 is
    1/30, so that the area falls short by the part ``2*(h/r)**4/720``.
    """
    made = sampled(arc(0j, radius, 0.0, 2 * math.pi), count)
    share = 1 - made.area / (math.pi * radius**2)
    angle = 2 * math.pi / count
    assert share == pytest.approx(2 * angle**4 / 720, rel=0.15 * angle)


def test_the_area_error_falls_with_the_fourth_power() -> None:
    """On an ellipse it is the integral of ``(k'' - k**3)*h**4/720`` over the arc length."""
    a, b = 7.0, 4.0
    counts = np.array([40, 80, 160, 320])
    errors = np.array([sampled(ellipse(a, b, 0j), int(n)).area for n in counts]) - math.pi * a * b
    slopes = np.diff(np.log(np.abs(errors))) / np.diff(np.log(counts))
    assert slopes[-2:] == pytest.approx([-4.0, -4.0], abs=0.1)
    n = 200001
    t = np.linspace(0.0, 2 * math.pi, n)[:-1]
    speed = np.hypot(a * np.sin(t), b * np.cos(t))
    bend = a * b / speed**3
    wave = 1j * np.fft.fftfreq(n - 1, 1 / (n - 1))
    once = np.fft.ifft(wave * np.fft.fft(bend)).real / speed
    twice = np.fft.ifft(wave * np.fft.fft(once)).real / speed
    lead = float(((twice - bend**3) * speed**5).mean()) * 2 * math.pi / 720
    assert errors[-1] * (counts[-1] / (2 * math.pi)) ** 4 == pytest.approx(lead, rel=0.02)


def test_arms_are_as_long_as_the_arc() -> None:
    points, slopes = arc(3j, 5.0, 0.2, 2.2)(np.linspace(0.0, 1.0, 9))
    assert hermite_arms(
        points, np.asarray(slopes / np.abs(slopes), dtype=complex)
    ) == pytest.approx(np.full(8, 1.25), rel=1e-13)
    points, slopes = line(1j, 4 + 5j)(np.linspace(0.0, 1.0, 5))
    assert hermite_arms(
        points, np.asarray(slopes / np.abs(slopes), dtype=complex)
    ) == pytest.approx(np.full(4, math.sqrt(2)), rel=1e-13)


@pytest.mark.parametrize("cut", [0.1, 0.37])
def test_only_the_chain_has_a_meaning(cut: float) -> None:
    """A disc off the origin, cut into two runs anywhere, sums to the same."""
    centre, radius = 10 + 4j, 3.0
    total = Moments()
    for low, high in pairwise([0.0, cut, 1.0]):
        piece = arc(centre, radius, 2 * math.pi * low, 2 * math.pi * high)
        total = total + sampled(piece, 700)
    area = math.pi * radius**2
    agree(total, area, centre, shifted(area, centre, 0.5 * area * radius**2), 1e-9)


def test_contours_know_their_moments() -> None:
    agree(disc_contour(10.0).moments, math.pi * 100, 0j, math.pi / 2 * 10**4, 1e-9)
    agree(square_contour(6.0).moments, 36.0, 0j, 36 * 36 / 6, EXACT)
