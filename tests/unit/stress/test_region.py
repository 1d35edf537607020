"""Boundaries are the true curves, and a part's region is held where it is said to be."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
import shapely

from gearcam.base.errors import InfeasibleError
from gearcam.numeric.arrays import as_pairs
from gearcam.parts.blank import WheelBlank
from gearcam.parts.make import make_part
from gearcam.parts.openings import Workpiece, bore
from gearcam.parts.shapes import Circle, Loop
from gearcam.stress.region import (
    BoundaryCurve,
    BoundaryRun,
    Region,
    arc_run,
    curve_of,
    region_of,
    tooth_spans,
)
from gearcam.stress.sector import sector
from helpers_contour import disc_contour
from helpers_pairs import profile

KEYED = bore(WheelBlank(bore_diameter=20.0, keyway_width=6.0, keyway_depth=2.8))
HALF, FULL = 5.0, 3.0
"""Half axes of an ellipse, mm."""


@cache
def ellipse(count: int) -> BoundaryCurve:
    """An ellipse of cubics through so many points."""
    angle = np.linspace(0.0, 2.0 * np.pi, count + 1)
    points = HALF * np.cos(angle) + 1j * FULL * np.sin(angle)
    tangents = -HALF * np.sin(angle) + 1j * FULL * np.cos(angle)
    return BoundaryCurve(runs=(BoundaryRun(points=points, tangents=tangents / np.abs(tangents)),))


def polygon(curve: BoundaryCurve) -> shapely.Polygon:
    return shapely.Polygon(as_pairs(curve.at(curve.places)[0]))


@cache
def region(name: str, wheel: int, held: float | None = None) -> Region:
    return region_of(profile(name).parts[wheel - 1], held)


@pytest.mark.parametrize("hole", [False, True])
def test_a_circle_is_exact(hole: bool) -> None:
    sign = -1.0 if hole else 1.0
    curve = curve_of(Circle(center=2.0 + 1j, diameter=6.0), hole=hole)
    assert curve.length == pytest.approx(6.0 * np.pi, rel=1e-15)
    assert curve.area == pytest.approx(sign * 9.0 * np.pi, rel=1e-14)
    assert len(curve.corners) == 0
    s = np.linspace(-7.0, 30.0, 40)
    points, tangents = curve.at(s)
    spokes = np.exp(1j * sign * s / 3.0)
    np.testing.assert_allclose(points, 2.0 + 1j + 3.0 * spokes, atol=1e-14)
    np.testing.assert_allclose(tangents, sign * 1j * spokes, atol=1e-14)
    np.testing.assert_allclose(curve.curvature(s), sign / 3.0, rtol=1e-14)


def test_a_bore_with_a_keyway_has_four_corners_and_its_exact_area() -> None:
    assert isinstance(KEYED, Loop)
    curve = curve_of(KEYED, hole=True, held=True)
    assert curve.area == pytest.approx(-KEYED.moments.area, rel=1e-14)
    assert curve.length == pytest.approx(KEYED.length, rel=1e-14)
    foot = math.sqrt(91.0)
    corners = curve.at(curve.corners)[0]
    wanted = np.array([foot - 3j, foot + 3j, 12.8 - 3j, 12.8 + 3j])
    np.testing.assert_allclose(np.sort_complex(corners), wanted, atol=1e-13)
    assert curve.held(np.linspace(0.0, curve.length, 9)).all()


def test_an_ellipse_of_cubics_is_true_to_the_fourth_order() -> None:
    errors = []
    for count in (64, 128):
        curve = ellipse(count)
        points, tangents = curve.at(np.linspace(0.0, curve.length, 1001))
        x, y = points.real / HALF, points.imag / FULL
        across = (np.conj(tangents) * (x / HALF + 1j * y / FULL)).real
        bend = ((x / HALF) ** 2 + (y / FULL) ** 2) ** -1.5 / (HALF * FULL) ** 2
        found = curve.curvature(np.linspace(0.0, curve.length, 1001))
        inside = slice(10, -10)  # at the ends of a run the curvature is that of its first step
        errors.append(
            [
                np.abs(np.hypot(x, y) - 1.0).max(),
                np.abs(across).max(),
                np.abs(found / bend - 1.0)[inside].max(),
                abs(curve.area / (np.pi * HALF * FULL) - 1.0),
            ]
        )
    falls = np.array(errors[0]) / errors[1]
    assert errors[1][0] < 2e-7
    assert falls[0] == pytest.approx(16.0, rel=0.2)
    assert falls[1] > 7.0  # of third order
    assert falls[2] == pytest.approx(4.0, rel=0.3)
    assert falls[3] > 15.0


def test_the_nearest_place_has_the_point_on_its_normal() -> None:
    curve = ellipse(256)
    s = np.linspace(0.0, curve.length, 200, endpoint=False)
    points, tangents = curve.at(s)
    for off in (-2.0, 0.0, 0.5, 1.0):  # the smallest radius is 1.8 mm
        found = curve.nearest(points + off * 1j * tangents)
        ways = np.abs((found - s + 1.0) % curve.length - 1.0)
        assert ways.max() < 1e-6, off


def test_the_nearest_place_of_a_corner_is_the_corner() -> None:
    square = curve_of(Loop(points=np.array([0j, 4.0, 4.0 + 4j, 4j]), bulges=np.zeros(4)))
    found = square.nearest(np.array([5.0 - 1j, 4.3 + 1j, 2.0 + 5j, -1.0 - 1j]))
    np.testing.assert_allclose(found, [4.0, 5.0, 10.0, 0.0], atol=1e-12)


@pytest.mark.parametrize(
    "run", [arc_run(1.0 + 0j, 1j, math.tan(math.pi / 8.0)), ellipse(200).runs[0]]
)
def test_a_part_of_a_run_lies_on_it(run: BoundaryRun) -> None:
    curve = BoundaryCurve(runs=(run,))
    low, high = 0.21 * run.length, 0.83 * run.length
    piece = run.part(low, high)
    points, tangents = curve.at(np.array([low, high]))
    np.testing.assert_allclose(piece.points[[0, -1]], points, atol=1e-13)
    np.testing.assert_allclose(piece.tangents[[0, -1]], tangents, atol=1e-13)
    assert piece.length == pytest.approx(high - low, rel=1e-5)
    np.testing.assert_allclose(piece.reversed.points, piece.points[::-1])
    assert piece.reversed.swept == pytest.approx(-piece.swept, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "wheel", "holes"),
    [
        ("nail_machine_two_phase", 1, 1),
        ("shop_order", 1, 6),
        ("ring_ellipse", 2, 7),
        ("feeder", 2, 0),
    ],
)
def test_the_region_of_a_part_has_its_area(name: str, wheel: int, holes: int) -> None:
    part, made = profile(name).parts[wheel - 1], region(name, wheel)
    assert made.area == pytest.approx(part.steps[0].moments.area, rel=1e-12)
    assert len(made.holes) == holes
    assert made.outer.area > 0.0
    assert all(hole.area < 0.0 for hole in made.holes)


def test_a_wheel_is_held_on_its_bore_a_ring_on_its_outside_a_rack_on_its_back() -> None:
    def held(made: Region) -> list[float]:
        return [sum(run.length for run in one.runs if run.held) for one in made.curves]

    nail = region("nail_machine_two_phase", 1)
    assert held(nail) == [0.0, nail.holes[0].length]
    ring = region("ring_ellipse", 2)
    assert held(ring) == [ring.outer.length, *([0.0] * 7)]
    assert np.abs(ring.teeth.at(np.zeros(1))[0]) < np.abs(ring.outer.at(np.zeros(1))[0])
    rack = region("feeder", 2)
    (length,) = held(rack)
    points = rack.outer.at(rack.outer.places)[0]
    back = points[rack.outer.held(rack.outer.places)]
    assert length == pytest.approx(np.ptp(points.imag), rel=1e-9)
    assert np.abs(back.real - points.real.max()).max() < 1e-9


def test_without_a_bore_the_held_circle_is_half_as_large_as_the_roots() -> None:
    made = region("ellipse", 1)
    roots = np.abs(made.outer.at(made.outer.places)[0]).min()
    (hole,) = made.holes
    assert hole.length == pytest.approx(np.pi * roots, rel=1e-6)
    assert all(run.held for run in hole.runs)


def holed(**sizes: float) -> Region:
    blank = WheelBlank(timing_marks=False, bolts=4, bolt_diameter=4.0, bolt_circle=30.0)
    work = Workpiece(name="wheel 1", wheel=1, rim=1.0)
    part = make_part("g", [disc_contour(30.0, 1e-3)], 10.0, blank, work)
    return region_of(part, sizes.get("held"))


def test_openings_within_the_held_circle_are_left_out() -> None:
    assert len(holed(held=40.0).holes) == 1
    assert len(holed(held=20.0).holes) == 5
    default = holed()  # half the roots cuts the bolt holes, from 26 to 34 mm
    assert len(default.holes) == 5
    assert default.holes[0].length == pytest.approx(26.0 * np.pi / 1.01, rel=1e-6)


def test_a_held_circle_that_cannot_be_is_refused_with_its_limit() -> None:
    with pytest.raises(InfeasibleError, match=r"cuts an opening.*bolt hole 1") as refused:
        holed(held=30.0)
    assert refused.value.limit == pytest.approx(34.0 * 1.01)
    with pytest.raises(InfeasibleError, match="reaches the roots") as refused:
        holed(held=59.9)
    assert refused.value.limit == pytest.approx(60.0 / 1.01)
    with pytest.raises(InfeasibleError, match="go round the bore") as refused:
        region("nail_machine_two_phase", 1, 30.0)
    assert refused.value.limit == pytest.approx(40.0 * 1.01)
    with pytest.raises(InfeasibleError, match="no metal around its shaft"):
        region("ring_ellipse", 2, 30.0)


@pytest.mark.parametrize(
    ("name", "wheel"), [("nail_machine_two_phase", 2), ("ring_ellipse", 2), ("feeder", 2)]
)
def test_each_tooth_has_its_span(name: str, wheel: int) -> None:
    result, made = profile(name), region(name, wheel)
    gear = (result.gear1, result.gear2)[wheel - 1]
    numbers, spans = tooth_spans(made, gear)
    assert sorted(numbers) == list(gear.profile.teeth[0])
    if gear.pair.closed:
        assert (spans[:, 1] - spans[:, 0]).sum() == pytest.approx(made.teeth.length, rel=1e-12)
        np.testing.assert_allclose(spans[1:, 0], spans[:-1, 1], rtol=1e-12)
    flanks = gear.flanks
    places = made.teeth.nearest(flanks["x_mm"] + 1j * flanks["y_mm"])
    for number, (low, high) in zip(numbers, spans, strict=True):
        here = (places[flanks["tooth"] == number] - low) % made.teeth.length
        assert (here < high - low).all(), number


def test_a_sector_of_an_even_wheel_is_its_share_of_a_ring() -> None:
    """Five teeth of 35, five modules below the roots: area by the whole wheel's."""
    result, made = profile("circular"), region("circular", 2)
    numbers, spans = tooth_spans(made, result.gear2)
    module = result.pair.module
    roots = np.abs(made.teeth.at(spans[0, :1])[0])[0]
    part = sector(made, spans[33, 0], spans[2, 1], 5.0 * module)
    inner = roots - 5.0 * module
    share = 5.0 / len(numbers)
    assert part.area == pytest.approx(share * (made.outer.area - np.pi * inner**2), rel=1e-9)
    held = sum(run.length for run in part.outer.runs if run.held)
    assert held == pytest.approx(10.0 * module + share * 2.0 * np.pi * inner, rel=1e-9)
    assert part.holes == ()
    corners = part.outer.at(part.outer.corners)[0]
    assert (np.abs(np.abs(corners) - inner) < 1e-9).sum() == 2


def test_a_sector_of_a_ring_ends_at_its_outside() -> None:
    result, made = profile("ring_uneven"), region("ring_uneven", 2)
    _, spans = tooth_spans(made, result.gear2)
    part = sector(made, spans[8, 0], spans[12, 1], 20.0 * result.pair.module)
    ring, cut = (polygon(one.outer) for one in (made, part))
    assert ring.contains(cut)
    assert ring.exterior.distance(cut) < 0.3 * result.pair.module
    assert part.area == pytest.approx(cut.area, rel=1e-4)


def test_a_sector_above_an_opening_is_refused() -> None:
    result, made = profile("shop_order"), region("shop_order", 1)
    _, spans = tooth_spans(made, result.gear1)
    with pytest.raises(ValueError, match="too near to the teeth"):
        sector(made, spans[1, 0], spans[5, 1], 5.0 * result.pair.module)
